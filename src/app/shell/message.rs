//! What a workspace asks of the shell.

use super::notice::Notice;

/// What a workspace asks of the shell.
#[derive(Clone, Debug)]
pub enum Message {
    /// Show a notice.
    Notify(Notice),
    /// Put this on the clipboard.
    CopyText(String),
}
