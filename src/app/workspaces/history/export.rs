//! Inspections of the history written to where a person chose.

use std::path::{Path, PathBuf};

use super::apply::inspections;
use crate::{
    app::user_error::UserError,
    cases::{CaseFolder, PastCases, TruthFrom},
    files::write_atomically,
    history::{Filter, HistoryBuffer, HistoryError, write_head, write_row},
};

/// Where inspections of the history are written to.
#[derive(Clone, Debug)]
pub(super) enum PastExport {
    /// A table.
    Csv(PathBuf),
    /// A folder of cases: those with a kept frame and a true label.
    Cases(PathBuf),
}

/// Writes what the filter lets through; answers what was written, in words.
pub(super) fn write(
    filter: &Filter,
    to: &PastExport,
    history: &HistoryBuffer,
) -> Result<String, UserError> {
    match to {
        PastExport::Csv(path) => write_table(filter, path, history),
        PastExport::Cases(folder) => write_cases(filter, folder, history),
    }
}

/// As `partsight history export --csv` does.
fn write_table(filter: &Filter, path: &Path, history: &HistoryBuffer) -> Result<String, UserError> {
    let mut table = Vec::new();
    let mut num = 0;
    let in_memory = |error| HistoryError::Unwritable {
        path: path.to_owned(),
        source: error,
    };
    let listed = write_head(&mut table).map_err(in_memory).and_then(|()| {
        history.each(filter, |record| {
            num += 1;
            write_row(&mut table, &record).map_err(in_memory)
        })
    });
    listed.map_err(|error| UserError::of(&error))?;
    write_atomically(path, |writer| writer.write_all(&table))
        .map_err(|error| UserError::of(&error))?;
    Ok(format!("Wrote {} to {}", inspections(num), path.display()))
}

/// As `partsight history export --cases` does.
fn write_cases(
    filter: &Filter,
    folder: &Path,
    history: &HistoryBuffer,
) -> Result<String, UserError> {
    let cases = CaseFolder::at(folder);
    let frames = history.frames_folder().unwrap_or_default();
    let mut kept = PastCases::new(&cases, &frames, TruthFrom::Label);
    let mut failed = None;
    let listed = history.each(filter, |record| {
        if failed.is_none() {
            failed = kept.take(&record).err();
        }
        Ok(())
    });
    listed.map_err(|error| UserError::of(&error))?;
    if let Some(error) = failed {
        return Err(UserError::of(&error));
    }
    if kept.num_kept == 0 {
        return Err(UserError {
            what: format!("No inspection became a case: {}", kept.in_words()),
            advice: "Set the actual part of some inspections, and keep their frames".into(),
        });
    }
    Ok(format!("{} in {}", kept.in_words(), folder.display()))
}
