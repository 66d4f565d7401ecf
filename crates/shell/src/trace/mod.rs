//! Traceability: serial number, production order and operator, typed or scanned; and which parts are expected for them.

pub mod current_trace;
pub mod entry;
pub mod expecting;
pub mod orders;
