//! Duplicate titles: people could not tell the verdicts of two such parts apart.

use super::{name::PartName, part::PartMeta};
use texts::{Described, Message};

/// Another part of the library has the same title.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct SharedTitle {
    /// The shared title.
    pub title: String,
    /// Name of the other part.
    pub other: PartName,
}

impl Described for SharedTitle {
    fn message(&self) -> Message {
        Message::new("shared-title")
            .with("other", self.other.as_str())
            .with("title", &*self.title)
    }
}

texts::display!(SharedTitle);

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
