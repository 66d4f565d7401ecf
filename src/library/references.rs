//! Several references of one part: which they are, and how they follow it to another name.

use std::io;

use super::{
    entry::{Entry, rewrite_meta},
    error::LibraryError,
    load::meta_of,
    name::PartName,
    part::PartMeta,
    store::LibraryFolder,
};

impl LibraryFolder {
    /// The part that a verdict names for what is enrolled under `name`: itself, or the one that it is a reference of.
    pub fn part_of(&self, name: &PartName) -> Result<PartName, LibraryError> {
        let meta = meta_of(&self.entry(name.as_str())?);
        meta.map(|meta| meta.part_name().clone())
            .map_err(|problem| LibraryError::Damaged(Box::new(problem)))
    }

    /// What is enrolled as one more reference of a part, in order; what cannot be read is none.
    pub fn references_of(&self, part: &PartName) -> Result<Vec<PartName>, LibraryError> {
        let references = self.reference_entries(part)?.into_iter();
        Ok(references.map(|(_, meta)| meta.name).collect())
    }

    /// The folders and descriptions of those.
    fn reference_entries(&self, part: &PartName) -> Result<Vec<(Entry, PartMeta)>, LibraryError> {
        let entries = self.entries()?.into_iter();
        let readable = entries.filter_map(|entry| meta_of(&entry).ok().map(|meta| (entry, meta)));
        Ok(readable
            .filter(|(_, meta)| meta.name != *part && meta.part.as_ref() == Some(part))
            .collect())
    }

    /// Lets every reference of the part `from` be one of `to`, and says how many those are.
    pub(super) fn carry_references(&self, from: &PartName, to: &PartName) -> io::Result<usize> {
        let references = self.reference_entries(from).map_err(io::Error::other)?;
        let num_references = references.len();
        for (entry, meta) in references {
            let part = Some(to.clone());
            rewrite_meta(&entry.path, &PartMeta { part, ..meta })?;
        }
        Ok(num_references)
    }
}
