//! `partsight history export`: writes inspections as a table or as cases.

use super::ExportArgs;
use crate::cli::{
    Outcome,
    console::{Advised as _, Console, advised_error},
    input::open_case_folder,
};
use records::{
    cases::{PastCases, TruthFrom},
    history::{History, write_table},
};

pub(super) fn run(
    history: &History,
    asked: &ExportArgs,
    console: &Console,
) -> anyhow::Result<Outcome> {
    let filter = asked.filter.filter();
    if let Some(path) = &asked.csv {
        let num = write_table(path, |row| history.each(&filter, row)).advised()?;
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
        let folder = open_case_folder(path)?;
        let cases = PastCases::new(&folder, history.frames_folder(), truth);
        let mut cases = cases.advised()?;
        let exported = history.each(&filter, |record| cases.take(&record));
        exported.advised()?;
        for problem in &cases.problems {
            console.warn(problem, problem);
        }
        let written = cases.in_words(&path.display().to_string());
        console.note(&written);
        if cases.num_kept() == 0 {
            return Err(advised_error(
                "no inspection could be kept as a case",
                "Label some first (partsight history label NUMBER PART), or add --accepted-as-truth",
            ));
        }
    }
    Ok(Outcome::Accepted)
}
