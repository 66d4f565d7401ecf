//! The texts of results, refusals, enrolment, the history and robots in the window's language.

pub mod enrolment;
pub mod history;
pub mod results;
pub mod robot;
