//! Inspections waiting in memory, and how they are listed.

use std::collections::{BTreeMap, VecDeque};

use super::{
    entry::{NewEntry, Summary},
    error::HistoryError,
    frames::FrameLoss,
    hung::HungId,
    store::History,
};

/// Maximum number of waiting inspections; beyond it the oldest are dropped.
pub(super) const MAX_WAITING: usize = 2000;
/// Number of the newest of them that keep their scenes, 4 MB each.
const MAX_SCENES: usize = 4;

/// Adds a waiting inspection under this number. Returns how many were lost for it. An old one gives its scenes up, which is
/// this loss, if any was to be written.
pub(super) fn wait(
    waiting: &mut VecDeque<NewEntry>,
    mut entry: NewEntry,
    number: i64,
    loss: Option<FrameLoss>,
) -> usize {
    entry.record.summary.number = number;
    waiting.push_back(entry);
    let num_lost = waiting.len().saturating_sub(MAX_WAITING);
    waiting.drain(..num_lost);
    let old = waiting.len().saturating_sub(MAX_SCENES);
    if let Some(entry) = old.checked_sub(1).and_then(|i| waiting.get_mut(i)) {
        entry.drop_frames(loss);
    }
    num_lost
}

/// Returns the waiting rows, oldest first, each with the inspection that stands for its part: as they will be once
/// written, except for parts whose refusal is already written.
pub(super) fn waiting_rows(
    waiting: &VecDeque<NewEntry>,
    history: Option<&History>,
) -> Result<Vec<Summary>, HistoryError> {
    let mut rows: Vec<Summary> = Vec::new();
    let mut heads: BTreeMap<HungId, usize> = BTreeMap::new();
    for (place, entry) in waiting.iter().enumerate() {
        let mut row = entry.record.summary.clone();
        match heads.get(&row.hung).copied() {
            Some(head) if entry.takes_over_from(&rows[head]) => {
                row.trace = row.trace.or(&rows[head].trace);
                row.source.clone_from(&rows[head].source);
                for other in &mut rows {
                    if other.hung == row.hung {
                        other.parent = Some(row.number);
                        other.num_below = 0;
                        row.num_below += 1;
                    }
                }
                heads.insert(row.hung.clone(), place);
            }
            Some(head) => {
                rows[head].trace = rows[head].trace.clone().or(&row.trace);
                row.trace = row.trace.or(&rows[head].trace);
                row.parent = Some(rows[head].number);
                rows[head].num_below += 1;
            }
            None => {
                let written = history.map(|history| history.head_of(&row.hung));
                row.parent = written.transpose()?.flatten().map(|head| head.number);
                if row.parent.is_none() {
                    heads.insert(row.hung.clone(), place);
                }
            }
        }
        rows.push(row);
    }
    Ok(rows)
}
