//! Queries of the history for what the window shows, and what of it is written to where a person chose.

use std::{
    collections::BTreeMap,
    ops::Range,
    path::{Path, PathBuf},
    sync::Arc,
};

use image::{DynamicImage, RgbImage};

use crate::workspaces::history::{HistoryFile, filter::ListFilter};
use inspection::library::Library;
use records::{
    cases::{CaseFolder, PastCases, TruthFrom},
    history::{
        DriftWarning, Filter, HistoryBuffer, HistoryError, LEAST_FOR_TREND, MAX_POSES, Page,
        PartDrift, PartOutcome, Record, Retention, ServoRecord, ServoRun, StoredVerdict, Summary,
        Usage, write_servo_table, write_table,
    },
};
use ui::{language::text, user_error::UserError};

/// A query.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HistoryQuery {
    /// The filter of the inspections.
    pub filter: ListFilter,
    /// The rows wanted, counted from the newest.
    pub rows: Range<usize>,
    /// Number of the selected inspection.
    pub selected: Option<i64>,
    /// True if the parts of the whole history are wanted, for which every row is read.
    pub with_parts: bool,
}

/// Result of a query.
#[derive(Clone, Debug)]
pub struct HistoryResult {
    /// The query.
    pub asked: HistoryQuery,
    /// The rows found.
    pub page: Page,
    /// The selected inspection, if it exists.
    pub record: Option<Arc<OpenedInspection>>,
    /// False if the filter hides the selected inspection.
    pub is_listed: bool,
    /// Number of the selected row and its index in the list, if it is listed but not among the rows found.
    pub far_row: Option<(i64, usize)>,
    /// The retention rule, and the space that kept frames take.
    pub kept: (Retention, Usage),
    /// The folder of the kept frames.
    pub frames: Option<PathBuf>,
    /// Names and titles of the parts in the history, if wanted.
    pub parts: Option<BTreeMap<String, String>>,
    /// Number of all runs of servoing.
    pub num_servo_runs: usize,
}

/// An inspection with its picture.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenedInspection {
    /// The full record.
    pub record: Record,
    /// Its small picture.
    pub picture: Option<RgbImage>,
    /// All inspections of the same part, the one that stands for it first, then the others from the oldest on; empty if
    /// there is only one.
    pub part: Vec<Record>,
}

/// Runs a query.
pub(super) fn look(
    request: &HistoryQuery,
    history: &HistoryBuffer,
) -> Result<HistoryResult, HistoryError> {
    let filter = request.filter.at(&geometry::clock::zoned_now());
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
    let head = record.as_ref().map(|record| {
        let of_part = record.part.first().unwrap_or(&record.record);
        &of_part.summary
    });
    let is_listed = head.is_none_or(|head| filter.passes(head));
    let is_found = |head: &Summary| page.rows.iter().any(|row| row.number == head.number);
    let far_row = match head.filter(|head| is_listed && !is_found(head)) {
        Some(head) => {
            // The list is in the order of time.
            let down_to_it = Filter {
                since: Some(head.at),
                ..filter
            };
            let num = history.page(&down_to_it, 0, 0)?.num_matching;
            Some((head.number, num.saturating_sub(1)))
        }
        None => None,
    };
    Ok(HistoryResult {
        asked: request.clone(),
        page,
        far_row,
        record,
        is_listed,
        kept: history.kept()?,
        frames: history.frames_folder(),
        num_servo_runs: history.servo_runs(&Filter::default(), 0, 0)?.num_all,
        parts: if request.with_parts {
            Some(parts(history)?)
        } else {
            None
        },
    })
}

/// Outcomes of the matching parts, and the number of those left out: as in the count of the shift, only parts count that hung
/// in front of this source. Without any, all real parts count, and simulated ones only where there is nothing else. The filter
/// leaves out the others.
pub(super) fn outcomes(
    filter: &mut Filter,
    source: Option<String>,
    history: &HistoryBuffer,
) -> Result<(Vec<PartOutcome>, usize), HistoryError> {
    let num_all = history.page(filter, 0, 0)?.num_matching;
    let of_source = source.map(|source| (Some(source), None));
    for (source, is_simulated) in of_source.into_iter().chain([(None, Some(false))]) {
        (filter.source, filter.is_simulated) = (source, is_simulated);
        let outcomes = history.outcomes(filter)?;
        if !outcomes.is_empty() {
            let num_left_out = num_all.saturating_sub(outcomes.len());
            return Ok((outcomes, num_left_out));
        }
    }
    filter.is_simulated = None;
    Ok((history.outcomes(filter)?, 0))
}

/// Names and titles of the parts in the history.
fn parts(history: &HistoryBuffer) -> Result<BTreeMap<String, String>, HistoryError> {
    let mut parts = BTreeMap::new();
    for part in history.outcomes(&Filter::default())? {
        if let Some(name) = part.part {
            let entry = parts.entry(name);
            entry.or_insert_with_key(|name| former_title(history, name));
        }
    }
    Ok(parts)
}

/// The title under which a part was last accepted, else its name.
pub(super) fn former_title(history: &HistoryBuffer, name: &str) -> String {
    let accepted = Filter {
        part: Some(name.to_owned()),
        verdict: Some(StoredVerdict::Accepted.into()),
        ..Filter::default()
    };
    let page = history.page(&accepted, 0, 1).ok();
    let row = page.and_then(|page| page.rows.into_iter().next());
    row.map_or_else(|| name.to_owned(), |row| row.title)
}

/// Parts that are looked after, those accepted most often.
const MAX_WATCHED: usize = 50;

/// Which of these parts, named with how often they were accepted, a trend will refuse, by the inspections that match the filter.
pub(super) fn drift_warnings(
    accepted: &[(String, usize)],
    filter: &Filter,
    history: &HistoryBuffer,
) -> Result<Vec<(String, DriftWarning)>, HistoryError> {
    let mut warnings = Vec::new();
    // To find few inspections of a part takes longest.
    let frequent = accepted
        .iter()
        .take_while(|(_, num)| *num >= LEAST_FOR_TREND);
    for (part, _) in frequent.take(MAX_WATCHED) {
        let of_part = Filter {
            part: Some(part.clone()),
            ..filter.clone()
        };
        let warning = history.drift_warning(&of_part)?;
        warnings.extend(warning.map(|warning| (part.clone(), warning)));
    }
    Ok(warnings)
}

/// The drift of a part over the inspections that match the filter; `None` if they are too few.
pub(super) fn drift(
    part: &str,
    filter: Filter,
    history: &HistoryBuffer,
    library: &Library,
) -> Result<Option<PartDrift>, HistoryError> {
    let of_part = Filter {
        part: Some(part.to_owned()),
        ..filter
    };
    let poses = history.poses(&of_part, MAX_POSES)?;
    Ok(PartDrift::of(&poses, |name| library.middle_of(name)))
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

/// The newest runs that are listed; the filter finds older ones.
const MAX_LISTED: usize = 500;

/// The runs that are shown.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunsView {
    /// The rows, newest first.
    pub page: Page<ServoRun>,
    /// The selected run.
    pub selected: Option<ServoRecord>,
}

impl RunsView {
    /// Fetches the runs that match the filter, and the wanted one, else the newest.
    pub(super) fn find(
        filter: &Filter,
        wanted: Option<i64>,
        history: &HistoryBuffer,
    ) -> Result<Self, HistoryError> {
        let page = history.servo_runs(filter, 0, MAX_LISTED)?;
        let is_listed = |number: &i64| page.rows.iter().any(|run| run.number == *number);
        let number = wanted.filter(is_listed);
        let number = number.or_else(|| page.rows.first().map(|run| run.number));
        Ok(Self {
            selected: number.map(|number| history.servo_run(number)).transpose()?,
            page,
        })
    }

    pub(super) fn selected_number(&self) -> Option<i64> {
        Some(self.selected.as_ref()?.run.number)
    }
}

/// Writes the inspections that match the filter; describes what was written.
pub(super) fn write_inspections(
    filter: &Filter,
    file: HistoryFile,
    path: &Path,
    history: &HistoryBuffer,
) -> Result<String, UserError> {
    match file {
        HistoryFile::Csv => {
            let num = write_table(path, |row| history.each(filter, row))
                .map_err(|error| UserError::of(&error))?;
            let path = path.display().to_string();
            Ok(text!("history-wrote", count = num, path = path))
        }
        HistoryFile::Cases => write_cases(filter, path, history),
    }
}

/// Writes the runs of servoing that match the filter, the oldest first; describes what was written.
pub(super) fn write_runs(
    filter: &Filter,
    path: &Path,
    history: &HistoryBuffer,
) -> Result<String, UserError> {
    let page = history.servo_runs(filter, 0, i64::MAX as usize);
    let page = page.map_err(|error| UserError::of(&error))?;
    let num = write_servo_table(path, page.rows.iter().rev());
    let num = num.map_err(|error| UserError::of(&error))?;
    let path = path.display().to_string();
    Ok(text!("servoing-wrote", count = num, path = path))
}

/// As `partsight history export --cases` does.
fn write_cases(
    filter: &Filter,
    folder: &Path,
    history: &HistoryBuffer,
) -> Result<String, UserError> {
    let cases = CaseFolder::at(folder);
    let frames = history.frames_folder().unwrap_or_default();
    let kept = PastCases::new(&cases, &frames, TruthFrom::Label);
    let mut kept = kept.map_err(|error| UserError::of(&error))?;
    let exported = history.each(filter, |record| kept.take(&record));
    exported.map_err(|error| UserError::of(&error))?;
    if kept.num_kept() == 0 {
        return Err(UserError {
            what: text!("history-no-cases", what = in_words(&kept)),
            advice: text!("history-no-cases-advice"),
        });
    }
    let path = folder.display().to_string();
    Ok(text!(
        "history-wrote-cases",
        what = in_words(&kept),
        path = path
    ))
}

/// Describes what was kept and what was not.
fn in_words(kept: &PastCases<'_>) -> String {
    let num = kept.num_without_truth;
    let without_truth = (num > 0).then(|| text!("history-cases-without-truth", count = num));
    let num = kept.num_without_frame;
    let without_frame = (num > 0).then(|| text!("history-cases-without-frame", count = num));
    let num = kept.num_scans;
    let scans = (num > 0).then(|| text!("history-cases-scans", count = num));
    let num = kept.problems.len();
    let unreadable = (num > 0).then(|| text!("history-cases-unreadable", count = num));
    let mut words = vec![text!(
        "history-cases-kept",
        new = kept.num_new,
        updated = kept.num_updated,
        unchanged = kept.num_unchanged
    )];
    words.extend(
        [without_truth, without_frame, scans, unreadable]
            .into_iter()
            .flatten(),
    );
    words.join(", ")
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;
    use records::fixtures::history_entry;

    #[test]
    fn simulated_frames_are_counted_only_where_there_is_nothing_else() {
        let history = HistoryBuffer::new(None);
        let add = |seconds, part, is_simulated| {
            let mut entry = history_entry(seconds, StoredVerdict::Accepted, part);
            entry.record.summary.is_simulated = is_simulated;
            history.add(seconds as u64, entry, Instant::now());
        };
        let num = |part: &str| {
            let mut filter = Filter {
                part: Some(part.to_owned()),
                ..Filter::default()
            };
            let counted = outcomes(&mut filter, Some("kinect".into()), &history);
            let (outcomes, num_left_out) = counted.expect("asked");
            (outcomes.len(), num_left_out, filter.is_simulated)
        };
        add(1, "fender", true);
        add(2, "fender", true);
        assert_eq!(num("fender"), (2, 0, None));
        add(3, "fender", false);
        add(4, "grille", true);
        assert_eq!(num("fender"), (1, 2, Some(false)));
        assert_eq!(num("grille"), (1, 0, None));
    }
}
