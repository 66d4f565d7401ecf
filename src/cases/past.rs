//! Inspections of the history as cases: their kept frames with what was truly there.

use std::path::Path;

use super::{
    error::CaseError,
    judge::{FoundVerdict, Truth},
    meta::CaseDescription,
    store::CaseFolder,
};
use crate::history::{FrameError, Record, StoredVerdict, read_frame};

/// What is taken for the truth of a past inspection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TruthFrom {
    /// The true label that a person gave, and nothing else.
    Label,
    /// Where nobody gave one, the part that was accepted: such cases show what changed, not what is right.
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

/// Keeps inspections as cases, and counts those that cannot be.
#[derive(Debug)]
pub struct PastCases<'a> {
    folder: &'a CaseFolder,
    frames: &'a Path,
    truth: TruthFrom,
    /// Cases that were kept.
    pub num_kept: usize,
    /// Inspections of which nobody knows what was there.
    pub num_without_truth: usize,
    /// Inspections whose frame is not kept any more, or never was.
    pub num_without_frame: usize,
    /// Inspections of several frames together: a case has one.
    pub num_scans: usize,
    /// Frames that cannot be read.
    pub problems: Vec<FrameError>,
}

impl<'a> PastCases<'a> {
    /// Into this folder of cases, from this folder of kept frames.
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

    /// Keeps an inspection as a case, if it can be one.
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
        let Record { summary, detail } = record;
        let about = CaseDescription {
            origin: format!("inspection {} {}", summary.number, summary.scene),
            simulated: summary.is_simulated,
            kept_at: summary.at,
            remark: summary.remark.clone(),
            difficulty: None,
            truth,
            found: FoundVerdict {
                part: detail.nearest.clone(),
                score: summary.score.map(|[score, _]| score),
                margin: summary.score.map(|[_, margin]| margin),
                accepted: summary.verdict == StoredVerdict::Accepted,
                reason: detail
                    .refusal
                    .as_ref()
                    .map(|refusal| refusal.reason.clone()),
            },
            pose: None,
        };
        self.folder.keep(&scene, about)?;
        self.num_kept += 1;
        Ok(())
    }

    /// What was kept and what was not, in words.
    pub fn in_words(&self) -> String {
        let mut words = format!("{} kept as cases", self.num_kept);
        for (num, why) in [
            (self.num_without_truth, "without a true label"),
            (self.num_without_frame, "whose frame is not kept"),
            (self.num_scans, "that are scans"),
            (self.problems.len(), "whose frame cannot be read"),
        ] {
            if num > 0 {
                words = format!("{words}, {num} {why}");
            }
        }
        words
    }
}
