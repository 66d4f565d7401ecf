//! Partsight's command line.
fn main() {}
