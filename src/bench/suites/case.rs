//! What one frame of a suite came to.

use nalgebra::Point3;
use serde::Serialize;

use super::{SuiteFrame, libraries::enrolment_pose};
use crate::{
    geometry::rigid::pose_error,
    pipeline::{Inspection, Timings, Verdict},
    simulate::Truth,
    stages::{confirm::Evidence, rank::MatchEntry},
};

/// What one frame came to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SuiteCase {
    /// What hung there.
    pub subject: String,
    /// The name that is right; `None` if nothing may be accepted.
    pub expected: Option<String>,
    /// The frame's seed.
    pub seed: u64,
    /// The best guess; `None` if nothing was recognised.
    pub found: Option<String>,
    /// Its score.
    pub score: f64,
    /// Its lead.
    pub margin: f64,
    /// Whether it was accepted.
    pub accepted: bool,
    /// Whether it was called unknown, or the mirror image of what is enrolled.
    pub is_unknown: bool,
    /// Why not.
    pub reason: Option<String>,
    /// Whether it was named as another model of what is enrolled, at a pose that is only about right.
    pub is_approximate: bool,
    /// Time of the whole inspection, milliseconds.
    pub total_ms: f64,
    /// The same by stage.
    #[serde(skip)]
    pub timings: Timings,
    /// The first few of the ranking that were put in their place.
    pub contenders: Vec<Contender>,
}

/// One reference at the pose that was found for it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contender {
    /// Its name.
    pub part: String,
    /// Its score.
    pub score: f64,
    /// What the score is made of.
    pub evidence: Evidence,
    /// For the part that hangs there: how far the pose is off, degrees and millimetres at the part's middle.
    pub pose_off: Option<[f64; 2]>,
}

/// Contenders written per frame.
const NUM_CONTENDERS: usize = 3;

impl SuiteCase {
    pub(super) fn of(frame: &SuiteFrame, truth: &Truth, inspection: &Inspection) -> Self {
        let (found, score, margin, reason) = match &inspection.verdict {
            Verdict::Part {
                part,
                score,
                margin,
                rejected,
                ..
            } => (
                Some(part.clone()),
                *score,
                *margin,
                rejected.as_ref().map(ToString::to_string),
            ),
            Verdict::NoPart(reason) => (None, 0.0, 0.0, Some(reason.to_string())),
        };
        Self {
            subject: frame.subject(),
            expected: frame.expected.clone(),
            seed: frame.setup.seed,
            found,
            score,
            margin,
            accepted: reason.is_none(),
            is_unknown: inspection.verdict.is_unknown(),
            reason,
            is_approximate: inspection.verdict.is_approximate(),
            timings: inspection.timings,
            total_ms: inspection.timings.total.as_secs_f64() * 1e3,
            contenders: inspection
                .ranking
                .entries
                .iter()
                .take(NUM_CONTENDERS)
                .filter_map(|entry| contender(frame, truth, entry))
                .collect(),
        }
    }

    /// The right name; or, where there is none, not accepted.
    pub fn is_right(&self) -> bool {
        match &self.expected {
            Some(name) => self.found.as_ref() == Some(name),
            None => !self.accepted,
        }
    }

    /// Accepted as something that it is not: the robot would move.
    pub fn is_wrong_accepted(&self) -> bool {
        self.accepted && self.found != self.expected
    }

    /// How far the pose of a part that was named rightly is off, degrees and millimetres at the part's middle.
    pub fn pose_off(&self) -> Option<[f64; 2]> {
        let first = self.contenders.first()?;
        first.pose_off.filter(|_| self.found == self.expected)
    }

    /// True when that is within 2° and 10 mm.
    pub fn is_well_placed(&self) -> bool {
        self.pose_off()
            .is_some_and(|off| off[0] <= 2.0 && off[1] <= 10.0)
    }
}

fn contender(frame: &SuiteFrame, truth: &Truth, entry: &MatchEntry) -> Option<Contender> {
    let is_there = frame.expected.as_ref() == Some(&entry.part);
    let pose_off = entry.pose.as_ref().filter(|_| is_there).map(|pose| {
        // The reference's space is the camera's when the part was enrolled.
        let camera_from_part = truth.camera_from_part * enrolment_pose().inverse();
        let middle = enrolment_pose() * Point3::origin();
        let off = pose_error(&pose.camera_from_part(), &camera_from_part, &middle);
        [off.rotation.degrees(), off.shift.mm()]
    });
    Some(Contender {
        part: entry.part.clone(),
        score: entry.score,
        evidence: entry.evidence?,
        pose_off,
    })
}
