//! What is drawn around the workspaces: bars, rail, notices, and the question before the window closes; and the keys.

pub mod bars;
pub mod keys;
pub mod notices;
pub mod rail;
