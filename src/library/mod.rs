//! The library of enrolled parts.

use crate::stages::reference::Reference;

/// The enrolled parts, prepared for ranking and pose.
#[derive(Clone, Debug, Default)]
pub struct Library {
    /// The references in the order of their names.
    pub references: Vec<Reference>,
}
