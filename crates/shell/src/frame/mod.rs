//! What is drawn around the workspaces: bars, rail, status bar, notices, the list of keys, and the question before the window closes.

pub mod bars;
pub mod keys;
pub mod notices;
pub mod rail;
pub mod status_bar;
