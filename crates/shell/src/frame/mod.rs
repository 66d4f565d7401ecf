//! What is drawn around the workspaces: bars, rail, notices, the list of keys, and the question before the window closes.

pub mod dialogs;
pub mod keys;
pub mod notices;
pub mod operator_bars;
pub mod rail;
pub mod top_bar;
