//! Test fixtures of all crates, for the tests of the program: scenes, frames, clouds, libraries, entries of a history.

#![allow(
    unused_imports,
    dead_code,
    reason = "every test program uses some of it"
)]

pub(crate) use capture::fixtures::*;
pub(crate) use files::fixtures::*;
pub(crate) use geometry::fixtures::*;
pub(crate) use inspection::fixtures::*;
pub(crate) use records::fixtures::*;
pub(crate) use simulate::fixtures::*;
pub(crate) use stages::fixtures::*;
