//! Test fixtures: scenes, frames, clouds, libraries, inspections of a history.
//!
//! Each crate has those of what it holds.

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
