//! Whether the file that the window starts with shows a part that was inspected before.

use std::fs;

use super::{inspected::Inspected, source::Origin};
use files::file_of;
use geometry::clock;
use records::history::{Filter, HistoryBuffer, HungId, Summary};

/// Maximum number of history rows of one file to check, newest first.
const MAX_ROWS: usize = 20;

/// Finds the past inspection of the same file, if the file has not been written since and the verdict is the same. Starting
/// the window again does not mean that another part was hung. `taken` are the parts that others of the frame are.
pub(crate) fn seen_before(
    inspected: &Inspected,
    taken: &[HungId],
    history: &HistoryBuffer,
) -> Option<Summary> {
    let Origin::File { path, .. } = &inspected.origin else {
        return None;
    };
    let written = fs::metadata(file_of(path))
        .and_then(|file| file.modified())
        .ok()?;
    let written = clock::timestamp(written);
    let now = &inspected.entry.record.summary;
    let filter = Filter {
        since: Some(written),
        verdict: Some(now.verdict.into()),
        text: now.source.clone(),
        ..Filter::default()
    };
    let is_same = |row: &Summary| {
        row.source == now.source && row.title == now.title && !taken.contains(&row.hung)
    };
    // The History workspace reports why the history cannot be read.
    let page = history.page(&filter, 0, MAX_ROWS).ok()?;
    page.rows.into_iter().find(is_same)
}
