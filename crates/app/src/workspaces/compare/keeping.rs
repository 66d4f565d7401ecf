//! Keeping the scene in front: its truth labels the part's row in the history, and the scene becomes a case.

use std::sync::Arc;

use super::{state::CompareState, work::CaseEdit};
use records::{
    cases::{CaseDescription, CaseError, CaseFolder, KeptCase},
    history::{HistoryBuffer, HistoryError},
};
use shell::{
    action::Action,
    inspection::inspected::Inspected,
    notice::{Notice, NoticeTopic},
    workspace::ShellContext,
};
use ui::language::text;

impl CompareState {
    /// Keeps the scene in front, or says why not.
    pub(super) fn keep(&mut self, cx: &mut ShellContext<'_>) {
        let look =
            |what: String, advice: String| Notice::look(what, advice).about(NoticeTopic::Case);
        let study = self.study.as_ref().filter(|_| !self.is_study_old());
        let Some(study) = study else {
            return cx.notify(look(
                text!("compare-nothing-to-keep"),
                text!("compare-nothing-to-keep-advice"),
            ));
        };
        let Some(inspected) = &study.inspected else {
            return cx.notify(look(
                text!("compare-kept-already"),
                text!("compare-kept-already-advice"),
            ));
        };
        let Some(truth) = self.truth.clone() else {
            return cx.notify(look(
                text!("compare-no-truth"),
                text!("compare-keep-case-first"),
            ));
        };
        cx.send(Action::RemoveNotices(NoticeTopic::Case));
        let about = CaseDescription {
            kept_at: geometry::clock::now(),
            remark: self.remark.trim().to_owned(),
            // Found by the recipe on trial, which may not be that of the inspection.
            found: study.found.clone(),
            ..CaseDescription::of(&inspected.entry.record, truth)
        };
        let change = CaseEdit::Keep {
            inspected: Arc::clone(inspected),
            about: Box::new(about),
        };
        self.change_cases(change, None);
    }
}

/// Labels the part in the history, then keeps the scene of this inspection as a case, also where the part has no row there
/// or the history cannot be written. Without a remark of its own the case gets that of the row.
pub(super) fn keep_case(
    folder: &CaseFolder,
    inspected: &Inspected,
    mut about: CaseDescription,
    history: &HistoryBuffer,
) -> Result<(KeptCase, Option<HistoryError>), CaseError> {
    let labelled = history.label_part(inspected.hung(), &about.truth, &about.remark);
    let (row, problem) = match labelled {
        Ok(row) => (row, None),
        Err(error) => (None, Some(error)),
    };
    if let Some(row) = row.filter(|_| about.remark.is_empty()) {
        about.remark = row.remark;
    }
    let kept = folder.keep(&inspected.scene, about)?;
    Ok((kept, problem))
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;
    use inspection::library::Truth;
    use records::history::FILE;
    use shell::inspection::{inspected::inspected_cell, source::CellChoice};

    fn inspected() -> Inspected {
        inspected_cell(CellChoice::Empty, 1)
    }

    fn about(inspected: &Inspected, remark: &str) -> CaseDescription {
        CaseDescription {
            remark: remark.into(),
            ..CaseDescription::of(&inspected.entry.record, Truth::Nothing)
        }
    }

    #[test]
    fn a_case_labels_its_part_and_shares_a_remark_with_it() {
        let home = tempfile::tempdir().expect("a folder");
        let folder = CaseFolder::at(home.path().join("cases"));
        let history = HistoryBuffer::new(Some(home.path().join("history")));
        let inspected = inspected();
        history.add(1, inspected.entry.clone(), Instant::now());
        let keep = |remark: &str| {
            let about = about(&inspected, remark);
            let (kept, problem) = keep_case(&folder, &inspected, about, &history).expect("kept");
            assert!(problem.is_none(), "{problem:?}");
            let row = history.row(1).expect("asked").expect("there").summary;
            assert_eq!(row.label, Some(Truth::Nothing));
            (kept.meta.about.remark, row.remark)
        };
        let both = |case: &str, row: &str| (case.to_owned(), row.to_owned());
        assert_eq!(keep(""), both("", ""));
        assert_eq!(keep("swept"), both("swept", "swept"));
        // A remark in the history is not overwritten.
        assert_eq!(keep("dark"), both("dark", "swept"));
        assert_eq!(keep(""), both("swept", "swept"));
    }

    #[test]
    fn what_the_history_does_not_have_or_cannot_take_is_kept_all_the_same() {
        let home = tempfile::tempdir().expect("a folder");
        let folder = CaseFolder::at(home.path().join("cases"));
        let inspected = inspected();
        let keep = |history: &HistoryBuffer| {
            keep_case(&folder, &inspected, about(&inspected, "dark"), history).expect("kept")
        };
        let (kept, problem) = keep(&HistoryBuffer::default());
        assert!(problem.is_none(), "{problem:?}");
        assert_eq!(kept.meta.about.remark, "dark");

        let place = home.path().join("history");
        let history = HistoryBuffer::new(Some(place.clone()));
        history.add(1, inspected.entry.clone(), Instant::now());
        let file = rusqlite::Connection::open(place.join(FILE)).expect("opened");
        let broken = file.execute_batch("ALTER TABLE inspection RENAME TO gone");
        broken.expect("renamed");
        let (kept, problem) = keep(&history);
        assert!(problem.is_some());
        assert_eq!(kept.name, "simulated_frame_1_2");
    }
}
