//! Export of past inspections as cases: their kept frames with their true labels.

use std::path::Path;

use super::{
    error::CaseError,
    judge::Truth,
    meta::CaseDescription,
    store::{CaseFolder, KeptCase},
};
use crate::history::{FrameError, Record, StoredVerdict, Summary, read_frame};

/// The source of the true label of an exported inspection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TruthFrom {
    /// Its true label; inspections without one are left out.
    Label,
    /// Its true label, else the accepted part. Such cases show what changed, not what is right.
    LabelOrVerdict,
}

impl TruthFrom {
    fn truth_of(self, record: &Record) -> Option<Truth> {
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

/// Writes past inspections as cases, and counts those that cannot become cases. An inspection whose case is in the folder
/// already gets no other one: its true label replaces that of the case.
#[derive(Debug)]
pub struct PastCases<'a> {
    folder: &'a CaseFolder,
    frames: &'a Path,
    truth: TruthFrom,
    /// The cases that were in the folder before the export, without those whose inspection was found.
    before: Vec<KeptCase>,
    /// Number of new cases.
    pub num_new: usize,
    /// Number of cases with another true label than before.
    pub num_updated: usize,
    /// Number of cases that stay as they were.
    pub num_unchanged: usize,
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
    pub fn new(
        folder: &'a CaseFolder,
        frames: &'a Path,
        truth: TruthFrom,
    ) -> Result<Self, CaseError> {
        Ok(Self {
            folder,
            frames,
            truth,
            before: folder.list()?.cases,
            num_new: 0,
            num_updated: 0,
            num_unchanged: 0,
            num_without_truth: 0,
            num_without_frame: 0,
            num_scans: 0,
            problems: Vec::new(),
        })
    }

    /// Returns the number of inspections that are cases now.
    pub fn num_kept(&self) -> usize {
        self.num_new + self.num_updated + self.num_unchanged
    }

    /// Writes an inspection as a case if it has a true label and one kept frame.
    pub fn take(&mut self, record: &Record) -> Result<(), CaseError> {
        let Some(truth) = self.truth.truth_of(record) else {
            self.num_without_truth += 1;
            return Ok(());
        };
        if let Some(case) = self.take_case_of(record) {
            return self.update(&case, &record.summary);
        }
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
        let about = CaseDescription {
            origin: origin_of(&record.summary),
            ..CaseDescription::of(record, truth)
        };
        self.folder.keep(&scene, about)?;
        self.num_new += 1;
        Ok(())
    }

    /// Takes the case of an inspection out of those before: an earlier export of it, else one of its scene that was kept
    /// without an export.
    fn take_case_of(&mut self, record: &Record) -> Option<KeptCase> {
        let summary = &record.summary;
        // The number alone may be that of another history.
        let is_export = |case: &KeptCase| {
            let about = &case.meta.about;
            about.origin == origin_of(summary) && about.kept_at == summary.at
        };
        let is_same_scene = |case: &KeptCase| {
            let scene = &case.meta.scene;
            let frame = record.detail.frame.as_ref();
            case.meta.about.origin == summary.scene.to_string()
                && frame.is_some_and(|of| (of.bytes, of.crc32) == (scene.bytes, scene.crc32))
        };
        let before = || self.before.iter();
        let index = before()
            .position(is_export)
            .or_else(|| before().position(is_same_scene))?;
        Some(self.before.remove(index))
    }

    /// Gives a case the true label of its inspection. Without one the truth of the case stays: a person may have entered it
    /// in the case alone.
    fn update(&mut self, case: &KeptCase, summary: &Summary) -> Result<(), CaseError> {
        match &summary.label {
            Some(label) if *label != case.meta.about.truth => {
                self.folder.set_truth(&case.name, label.clone())?;
                self.num_updated += 1;
            }
            _ => self.num_unchanged += 1,
        }
        Ok(())
    }

    /// Summarises in English what was written to the folder of this name, and what was not.
    pub fn in_words(&self, folder: &str) -> String {
        let written = format!(
            "cases in {folder}: {} new, {} updated, {} unchanged",
            self.num_new, self.num_updated, self.num_unchanged
        );
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

/// Origin of the case of an inspection: many scenes of a camera have the same name.
fn origin_of(summary: &Summary) -> String {
    format!("inspection {} {}", summary.number, summary.scene)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::{
        cases::CaseAnswer,
        fixtures::{history_entry, low_score, new_history},
        history::{Filter, History, Retention},
    };

    /// Exports, and returns the numbers of new, updated and unchanged cases.
    fn exported(history: &History, folder: &CaseFolder, truth: TruthFrom) -> [usize; 3] {
        let past = PastCases::new(folder, history.frames_folder(), truth);
        let mut past = past.expect("listed");
        let taken = history.each(&Filter::default(), |record| past.take(&record));
        taken.expect("kept");
        [past.num_new, past.num_updated, past.num_unchanged]
    }

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
        let counts = exported(&history, &folder, TruthFrom::Label);
        assert_eq!(counts, [1, 0, 0]);
        let list = folder.list().expect("listed");
        let about = &list.cases[0].meta.about;
        assert_eq!(about.origin, "inspection 1 frame 1");
        assert_eq!((&about.truth, about.remark.as_str()), (&truth, "bent"));
        assert_eq!(about.found.part.as_deref(), Some("grille"));
        assert_eq!(about.found.score, Some(0.97));
        assert_eq!(about.found.answered(), CaseAnswer::NotAccepted);
        let why = refusal.to_string();
        assert_eq!(about.found.reason, Some(why));
    }

    #[test]
    fn an_inspection_that_is_a_case_already_gets_no_other_one() {
        let (home, mut history) = new_history();
        for seconds in 1..=3 {
            let entry = history_entry(seconds, StoredVerdict::Accepted, "grille");
            history.add(&entry, &Retention::default()).expect("written");
        }
        let folder = CaseFolder::at(home.path().join("cases"));
        let kept = history.known(3).expect("written");
        let scene = history.scene(&kept).expect("read").expect("kept");
        // As Compare keeps it.
        let about = CaseDescription {
            kept_at: jiff::Timestamp::UNIX_EPOCH,
            remark: "bent".into(),
            difficulty: Some("hard".into()),
            ..CaseDescription::of(&kept, Truth::NotEnrolled)
        };
        folder.keep(&scene, about).expect("kept");
        let all = TruthFrom::LabelOrVerdict;
        // The verdict does not replace the label of a person.
        assert_eq!(exported(&history, &folder, all), [2, 0, 1]);
        assert_eq!(exported(&history, &folder, all), [0, 0, 3]);

        for number in [1, 3] {
            let labelled = history.set_label(number, Some(&Truth::Nothing));
            labelled.expect("labelled");
        }
        assert_eq!(exported(&history, &folder, all), [0, 2, 1]);
        assert_eq!(exported(&history, &folder, all), [0, 0, 3]);
        let list = folder.list().expect("listed");
        assert!(list.problems.is_empty(), "{:?}", list.problems);
        let found = list.cases.iter().map(|case| {
            folder.read_scene(case).expect("read");
            let about = &case.meta.about;
            let difficulty = about.difficulty.as_deref();
            (about.truth.name(), about.remark.as_str(), difficulty)
        });
        let mut found: Vec<_> = found.collect();
        found.sort_unstable();
        let expected = [
            ("grille", "", None),
            ("nothing", "", None),
            ("nothing", "bent", Some("hard")),
        ];
        assert_eq!(found, expected);
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
        let folder = CaseFolder::at(&path);
        let past = PastCases::new(&folder, history.frames_folder(), TruthFrom::Label);
        let mut past = past.expect("listed");
        fs::write(&path, "not a folder").expect("written");
        let mut num = 0;
        let taken = history.each(&Filter::default(), |record| {
            num += 1;
            past.take(&record)
        });
        assert!(matches!(taken, Err(CaseError::Unwritable { .. })));
        assert_eq!(num, 1);
    }
}
