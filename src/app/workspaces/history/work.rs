//! Looks into the history for what the window shows.

use std::{ops::Range, path::PathBuf, sync::Arc};

use image::{DynamicImage, RgbImage};
use jiff::Zoned;

use super::filter::ListFilter;
use crate::{
    app::user_error::UserError,
    history::{HistoryBuffer, HistoryError, Page, Record, Retention, Usage},
};

/// What the window wants to see.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HistoryQuery {
    /// Which inspections.
    pub filter: ListFilter,
    /// Which of their rows, counted from the newest.
    pub rows: Range<usize>,
    /// The inspection that is looked at.
    pub selected: Option<i64>,
}

/// What is there.
#[derive(Clone, Debug)]
pub struct HistoryResult {
    /// What was asked.
    pub asked: HistoryQuery,
    /// The rows.
    pub page: Page,
    /// The inspection that is looked at, if it is there.
    pub record: Option<Arc<OpenedInspection>>,
    /// The rule by which frames are kept, and how much is.
    pub kept: (Retention, Usage),
    /// The folder of the kept frames.
    pub frames: Option<PathBuf>,
}

/// An inspection with its picture.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenedInspection {
    /// All of it.
    pub record: Record,
    /// Its small picture.
    pub picture: Option<RgbImage>,
    /// All inspections of the same part, the one that stands for it first, then the others from the oldest on; empty if
    /// there is no other.
    pub part: Vec<Record>,
}

/// Looks.
pub(super) fn look(
    request: &HistoryQuery,
    history: &HistoryBuffer,
) -> Result<HistoryResult, UserError> {
    looked(request, history).map_err(|error| UserError::of(&error))
}

fn looked(request: &HistoryQuery, history: &HistoryBuffer) -> Result<HistoryResult, HistoryError> {
    let filter = request.filter.at(&Zoned::now());
    let rows = &request.rows;
    let page = history.page(&filter, rows.start, rows.len())?;
    let record = match request.selected {
        Some(number) => history.row(number)?,
        None => None,
    };
    let record = match record {
        Some(record) => Some(Arc::new(opened(record, history)?)),
        None => None,
    };
    Ok(HistoryResult {
        asked: request.clone(),
        page,
        record,
        kept: history.kept()?,
        frames: history.frames_folder(),
    })
}

fn opened(record: Record, history: &HistoryBuffer) -> Result<OpenedInspection, HistoryError> {
    let head = match record.summary.parent {
        Some(parent) => history.row(parent)?,
        None => Some(record.clone()),
    };
    let mut part = Vec::new();
    if let Some(head) = head {
        part = history.below(head.summary.number)?;
        if !part.is_empty() {
            part.insert(0, head);
        }
    }
    let picture = image::load_from_memory(&record.detail.thumbnail).ok();
    Ok(OpenedInspection {
        picture: picture.map(DynamicImage::into_rgb8),
        record,
        part,
    })
}
