//! `partsight history export`: inspections as a table, or as cases.

use super::ExportArgs;
use crate::{
    cases::{CaseFolder, PastCases, TruthFrom},
    cli::{
        Outcome,
        console::{Advised as _, Console, advised_error},
    },
    files::write_atomically,
    history::{History, write_head, write_row},
};

pub(super) fn run(
    history: &History,
    asked: &ExportArgs,
    console: &Console,
) -> anyhow::Result<Outcome> {
    let filter = asked.filter.filter();
    if let Some(path) = &asked.csv {
        let mut num = 0;
        let mut listed = Ok(());
        write_atomically(path, |writer| {
            write_head(writer)?;
            let mut written = Ok(());
            listed = history.each(&filter, |record| {
                num += 1;
                // The first failure is the one to tell; what follows is not written.
                if written.is_ok() {
                    written = write_row(writer, &record);
                }
                Ok(())
            });
            written
        })
        .advised()?;
        listed.advised()?;
        console.note(&format_args!(
            "{num} inspections written to {}",
            path.display()
        ));
    }
    if let Some(path) = &asked.cases {
        let truth = if asked.accepted_as_truth {
            TruthFrom::LabelOrVerdict
        } else {
            TruthFrom::Label
        };
        let folder = CaseFolder::at(path);
        let mut cases = PastCases::new(&folder, history.frames_folder(), truth);
        let mut failed = None;
        let listed = history.each(&filter, |record| {
            if failed.is_none() {
                failed = cases.take(&record).err();
            }
            Ok(())
        });
        listed.advised()?;
        if let Some(error) = failed {
            return Err(error).advised();
        }
        for problem in &cases.problems {
            console.warn(problem, problem);
        }
        console.note(&format_args!("{} in {}", cases.in_words(), path.display()));
        if cases.num_kept == 0 {
            return Err(advised_error(
                "no inspection could be kept as a case",
                "Label some first (partsight history label NUMBER PART), or add --accepted-as-truth",
            ));
        }
    }
    Ok(Outcome::Accepted)
}
