//! The texts of results, the history and robots in the window's language.

pub mod results;
pub mod robot;
