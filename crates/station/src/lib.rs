//! Whether a robot may act on a result.
//!
//! Every front end asks here, so that operator, engineer, robot and files never disagree: [`doubts`] lists the reasons
//! against a result, and a robot may act on it only if there are none.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests change files"))]

mod doubt;
pub mod robot_file;

pub use self::doubt::{ClockAhead, Currency, Doubt, doubts};
