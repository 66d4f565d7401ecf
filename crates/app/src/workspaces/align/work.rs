//! Jobs of the workspace: prepare a pair, run the methods one after the other, compute and write Table I.

use std::{path::Path, sync::Arc, time::Instant};

use super::{
    pair::{Pair, PairSource},
    start::Start,
    state::AlignResult,
    table::{TableCell, TableRow},
    track::MethodRun,
};
use files::write_text;
use inspection::pipeline::ProgressObserver as _;
use shell::inspection::library_cache::LibraryCache;
use stages::pose::PoseMethod;
use ui::{
    language::text,
    task::{TaskContext, TaskError},
    user_error::UserError,
};

/// Aligns a pair by every method.
pub(super) fn pair(
    source: &PairSource,
    library_cache: &LibraryCache,
    context: &TaskContext<AlignResult>,
) -> Result<AlignResult, TaskError> {
    let pair = Arc::new(Pair::load(source, library_cache)?);
    context.partial(AlignResult::Prepared(Arc::clone(&pair)));
    for (index, method) in PoseMethod::ALL.into_iter().enumerate() {
        context.progress(index, PoseMethod::ALL.len());
        context.check()?;
        let run = MethodRun::run(method, &pair, &|| context.is_cancelled());
        context.check()?;
        context.partial(AlignResult::Ran(Arc::new(run)));
    }
    Ok(AlignResult::Finished)
}

/// Computes the rows of Table I that are not in `done`, a list of part names and starts.
pub(super) fn table(
    done: &[(String, usize)],
    library_cache: &LibraryCache,
    context: &TaskContext<AlignResult>,
) -> Result<AlignResult, TaskError> {
    let loaded = library_cache.get();
    let references = &loaded.library.references;
    let total = references.len() * Start::NUM_PAPER;
    let clock = Instant::now();
    let mut num_done = done.len();
    context.progress(num_done, total);
    for (index, reference) in references.iter().enumerate() {
        let title = loaded.shown.title(index);
        for start in 0..Start::NUM_PAPER {
            let is_done = |(part, of): &(String, usize)| *part == reference.name && *of == start;
            if done.iter().any(is_done) {
                continue;
            }
            let pair = Pair::moved_copy(reference, title, Start::Paper(start));
            let mut cells = Vec::new();
            for method in PoseMethod::ALL {
                context.check()?;
                cells.push(TableCell::run(method, &pair, &|| context.is_cancelled()));
            }
            context.check()?;
            let row = TableRow {
                part: reference.name.clone(),
                title: title.to_owned(),
                start,
                cells,
            };
            num_done += 1;
            let (row, elapsed) = (Arc::new(row), clock.elapsed());
            context.partial(AlignResult::Row { row, elapsed });
            context.progress(num_done, total);
        }
    }
    Ok(AlignResult::Finished)
}

/// Writes a text file atomically; describes what was written.
pub(super) fn write(path: &Path, text: &str) -> Result<String, UserError> {
    write_text(path, text).map_err(|error| UserError::of(&error))?;
    Ok(text!("shell-wrote", path = path.display().to_string()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_written_whole_and_a_missing_folder_is_said_in_words() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("table.csv");
        let text = "part,e_m2\nfender,1e-7\n";
        let wrote = format!("Wrote {}", path.display());
        assert_eq!(write(&path, text), Ok(wrote));
        assert_eq!(std::fs::read_to_string(&path).expect("read"), text);
        let path = folder.path().join("missing").join("table.csv");
        let error = write(&path, text).expect_err("refused");
        assert!(!error.what.is_empty() && !error.advice.is_empty());
    }
}
