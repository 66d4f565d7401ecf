//! Export of past inspections as cases: their kept frames with their true labels.

use std::path::Path;

use super::{error::CaseError, judge::Truth, meta::CaseDescription, store::CaseFolder};
use crate::history::{FrameError, Record, StoredVerdict, read_frame};

/// The source of the true label of an exported inspection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TruthFrom {
    /// Its true label; inspections without one are left out.
    Label,
    /// Its true label, else the accepted part. Such cases show what changed, not what is right.
    LabelOrVerdict,
}

impl TruthFrom {
    fn of(self, record: &Record) -> Option<Truth> {
        let summary = &record.summary;
        let accepted = summary.part.as_ref();
        let accepted = accepted
            .filter(|_| self == Self::LabelOrVerdict && summary.verdict == StoredVerdict::Accepted);
        summary
            .label
            .clone()
            .or_else(|| accepted.map(|part| Truth::Part(part.clone())))
    }
}

/// Writes past inspections as cases, and counts those that cannot become cases.
#[derive(Debug)]
pub struct PastCases<'a> {
    folder: &'a CaseFolder,
    frames: &'a Path,
    truth: TruthFrom,
    /// Number of cases written.
    pub num_kept: usize,
    /// Number of inspections without a known true label.
    pub num_without_truth: usize,
    /// Number of inspections whose frame is not kept.
    pub num_without_frame: usize,
    /// Number of scans left out: a case has one frame.
    pub num_scans: usize,
    /// Errors of frames that cannot be read.
    pub problems: Vec<FrameError>,
}

impl<'a> PastCases<'a> {
    /// Exports from this folder of kept frames into this folder of cases.
    pub fn new(folder: &'a CaseFolder, frames: &'a Path, truth: TruthFrom) -> Self {
        Self {
            folder,
            frames,
            truth,
            num_kept: 0,
            num_without_truth: 0,
            num_without_frame: 0,
            num_scans: 0,
            problems: Vec::new(),
        }
    }

    /// Writes an inspection as a case if it has a true label and one kept frame.
    pub fn take(&mut self, record: &Record) -> Result<(), CaseError> {
        let Some(truth) = self.truth.of(record) else {
            self.num_without_truth += 1;
            return Ok(());
        };
        let Some(frame) = &record.detail.frame else {
            self.num_without_frame += 1;
            return Ok(());
        };
        if !frame.shots.is_empty() {
            self.num_scans += 1;
            return Ok(());
        }
        let scene = match read_frame(self.frames, frame) {
            Ok(scene) => scene,
            Err(problem) => {
                self.problems.push(problem);
                return Ok(());
            }
        };
        let mut about = CaseDescription::of(record, truth);
        // Many scenes of a camera have the same name.
        about.origin = format!("inspection {} {}", record.summary.number, about.origin);
        self.folder.keep(&scene, about)?;
        self.num_kept += 1;
        Ok(())
    }

    /// Summarises in English what was written to the folder of this name, and what was not.
    pub fn in_words(&self, folder: &str) -> String {
        let cases = if self.num_kept == 1 { "case" } else { "cases" };
        let written = format!("{} {cases} written to {folder}", self.num_kept);
        let left_out = [
            (self.num_without_truth, "without a true label"),
            (self.num_without_frame, "without a kept frame"),
            (self.num_scans, "of a scan"),
            (self.problems.len(), "with an unreadable frame"),
        ];
        let left_out = left_out.into_iter().filter(|(num, _)| *num > 0);
        let left_out: Vec<String> = left_out.map(|(num, why)| format!("{num} {why}")).collect();
        if left_out.is_empty() {
            written
        } else {
            format!("{written}; left out: {}", left_out.join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::{
        cases::CaseAnswer,
        history::{Filter, Retention},
        kit::{history_entry, low_score, new_history},
    };

    #[test]
    fn a_case_says_what_was_found_and_what_a_person_said_of_it() {
        let (home, mut history) = new_history();
        let mut entry = history_entry(1, StoredVerdict::Rejected, "grille");
        let refusal = low_score("grille", 0.81);
        entry.record.detail.refusal = Some(refusal.clone());
        history.add(&entry, &Retention::default()).expect("written");
        let truth = Truth::Part("fender".into());
        history.set_label(1, Some(&truth)).expect("labelled");
        history.set_remark(1, "bent").expect("written");
        let folder = CaseFolder::at(home.path().join("cases"));
        let mut past = PastCases::new(&folder, history.frames_folder(), TruthFrom::Label);
        let taken = history.each(&Filter::default(), |record| past.take(&record));
        taken.expect("kept");
        let list = folder.list().expect("listed");
        let about = &list.cases[0].meta.about;
        assert_eq!(about.origin, "inspection 1 frame 1");
        assert_eq!((&about.truth, about.remark.as_str()), (&truth, "bent"));
        assert_eq!(about.found.part.as_deref(), Some("grille"));
        assert_eq!(about.found.score, Some(0.97));
        assert_eq!(about.found.answered(), CaseAnswer::NotAccepted);
        let why = refusal.why.expect("with figures").to_string();
        assert_eq!(about.found.reason, Some(why));
    }

    #[test]
    fn the_first_case_that_cannot_be_written_ends_the_export() {
        let (home, mut history) = new_history();
        for (number, seconds) in (1..).zip(1..=2) {
            let entry = history_entry(seconds, StoredVerdict::Rejected, "grille");
            history.add(&entry, &Retention::default()).expect("written");
            let labelled = history.set_label(number, Some(&Truth::Nothing));
            labelled.expect("labelled");
        }
        let path = home.path().join("cases");
        fs::write(&path, "not a folder").expect("written");
        let folder = CaseFolder::at(&path);
        let mut past = PastCases::new(&folder, history.frames_folder(), TruthFrom::Label);
        let mut num = 0;
        let taken = history.each(&Filter::default(), |record| {
            num += 1;
            past.take(&record)
        });
        assert!(matches!(taken, Err(CaseError::Unwritable { .. })));
        assert_eq!(num, 1);
    }
}
