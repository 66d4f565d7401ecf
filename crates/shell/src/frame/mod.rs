//! What is drawn around the workspaces: bars, rail, status bar, notices, and the question before the window closes; and the keys.

pub mod bars;
pub mod keys;
pub mod notices;
pub mod rail;
pub mod status_bar;
