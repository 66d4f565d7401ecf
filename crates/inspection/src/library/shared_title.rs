//! Duplicate titles: people could not tell the verdicts of two such parts apart.

use super::{name::PartName, part::PartMeta};
use geometry::error::Advice;

/// Another part of the library has the same title.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{other} has the title \"{title}\" too")]
pub struct SharedTitle {
    /// The shared title.
    pub title: String,
    /// Name of the other part.
    pub other: PartName,
}

impl Advice for SharedTitle {
    fn advice(&self) -> String {
        "Choose another title: verdicts and lists tell parts apart by it".into()
    }
}

impl SharedTitle {
    /// Finds an entry that has the same `title` as the reference `name` of `part`. Case does not matter, references of
    /// one part may share a title, and an empty title is never shared.
    pub fn among<'a>(
        title: &str,
        name: &str,
        part: &str,
        library: impl IntoIterator<Item = &'a PartMeta>,
    ) -> Option<Self> {
        let title = title.trim();
        let folded = title.to_lowercase();
        let mut others = library.into_iter().filter(|other| {
            other.name.as_str() != name
                && other.part_name().as_str() != part
                && other.shown_title().to_lowercase() == folded
        });
        let other = others.next().filter(|_| !title.is_empty())?;
        Some(Self {
            title: title.to_owned(),
            other: other.name.clone(),
        })
    }
}
