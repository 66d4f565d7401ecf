//! Traceability: serial number, production order and operator, typed or scanned.

pub mod current_trace;
pub mod entry;
pub mod scanner;
