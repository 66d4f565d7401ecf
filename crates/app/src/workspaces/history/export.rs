//! Writes inspections of the history to where a person chose.

use std::path::Path;

use super::HistoryFile;
use records::{
    cases::{CaseFolder, PastCases, TruthFrom},
    history::{Filter, HistoryBuffer, write_servo_table, write_table},
};
use ui::{language::text, user_error::UserError};

/// Writes the inspections that match the filter; describes what was written.
pub(super) fn write(
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
