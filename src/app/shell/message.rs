//! What a workspace asks of the shell.

use std::sync::Arc;

use super::notice::Notice;
use crate::{app::inspect::work::InspectRequest, pipeline::Recipe};

/// What a workspace asks of the shell.
#[derive(Clone, Debug)]
pub enum Message {
    /// Show a notice.
    Notify(Notice),
    /// Take this notice away, if it is still shown.
    Retract(Notice),
    /// Put this on the clipboard.
    CopyText(String),
    /// Inspect scenes with this recipe from now on.
    UseRecipe(Arc<Recipe>),
    /// Inspect this, and show the result.
    Inspect {
        /// What is being done, for a person.
        title: &'static str,
        /// What to inspect.
        request: InspectRequest,
    },
}
