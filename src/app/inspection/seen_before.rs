//! Whether a file that the window starts with shows a part that was inspected before.

use std::fs;

use jiff::Timestamp;

use super::{inspected::Inspected, source::Origin};
use crate::{
    files::file_of,
    history::{Filter, HistoryBuffer, Summary},
};

/// Rows of one file that are looked through, the newest first.
const MAX_ROWS: usize = 20;

/// The part that the same file showed: it has not been written since, and has the same verdict as then. A person who
/// starts the window again has hung no other part.
pub(in crate::app) fn seen_before(
    inspected: &Inspected,
    history: &HistoryBuffer,
) -> Option<Summary> {
    let Origin::File { path, .. } = &inspected.origin else {
        return None;
    };
    let written = fs::metadata(file_of(path))
        .and_then(|file| file.modified())
        .ok()?;
    let written = Timestamp::try_from(written).ok()?;
    let now = &inspected.entry.record.summary;
    let filter = Filter {
        since: Some(written),
        verdict: Some(now.verdict),
        text: now.source.clone(),
        ..Filter::default()
    };
    let is_same = |row: &Summary| row.source == now.source && row.title == now.title;
    // Why the history cannot be read is reported by the History workspace.
    let page = history.page(&filter, 0, MAX_ROWS).ok()?;
    page.rows.into_iter().find(is_same)
}
