//! Several references of one part: listing them, and updating them when the part is renamed.

use std::io;

use super::{
    entry::{Entry, rewrite_meta},
    error::LibraryError,
    name::PartName,
    part::PartMeta,
    store::LibraryFolder,
    stored_part::meta_of,
};

impl LibraryFolder {
    /// Returns the part that a verdict names for the entry `name`: itself, or the part that it is a reference of.
    pub fn part_of(&self, name: &PartName) -> Result<PartName, LibraryError> {
        let (_, meta) = self.entry_with_meta(name.as_str())?;
        Ok(meta.part_name().clone())
    }

    /// Returns the names of a part's additional references, in order; unreadable entries are skipped.
    pub fn references_of(&self, part: &PartName) -> Result<Vec<PartName>, LibraryError> {
        let references = self.reference_entries(part)?.into_iter();
        Ok(references.map(|(_, meta)| meta.name).collect())
    }

    /// Returns the folders and descriptions of a part's additional references.
    fn reference_entries(&self, part: &PartName) -> Result<Vec<(Entry, PartMeta)>, LibraryError> {
        let entries = self.entries()?.into_iter();
        let readable = entries.filter_map(|entry| meta_of(&entry).ok().map(|meta| (entry, meta)));
        Ok(readable
            .filter(|(_, meta)| meta.name != *part && meta.part.as_ref() == Some(part))
            .collect())
    }

    /// Makes every additional reference of `from` one of `to`, and returns their number.
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
