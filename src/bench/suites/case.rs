//! What one frame of a suite came to.

use nalgebra::{Point3, Vector3};
use serde::Serialize;

use super::{SuiteFrame, libraries::enrolment_pose};
use crate::{
    geometry::rigid::pose_error,
    pipeline::{Inspection, Timings},
    simulate::{FrameTruth, SurfaceLabel},
    stages::{
        confirm::{ConfirmedMatch, Evidence},
        pose::Uncertainty,
        segment::{PointLabel, Segmentation},
    },
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
    /// Share of the part's camera-facing surface that is in sight; 0 if nothing hangs there.
    pub visible_share: f64,
    /// Readings that show the part and were taken for it, as a share of those that do either (intersection over
    /// union); `None` if no reading shows the part.
    pub part_iou: Option<f64>,
    /// The bounds of the pose of a part that was named rightly, if it has any.
    pub bounds: Option<PoseBounds>,
    /// Time of the whole inspection, milliseconds.
    pub total_ms: f64,
    /// The same by stage.
    #[serde(skip)]
    pub timings: Timings,
    /// The first few of the ranking that were put in their place.
    pub contenders: Vec<ReferenceCase>,
}

/// Bounds of a pose beside its true error, both about the middle of what was seen of the part.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PoseBounds {
    /// Degrees.
    pub turn_bound: f64,
    /// Millimetres.
    pub shift_bound: f64,
    /// Degrees.
    pub turn_off: f64,
    /// Millimetres.
    pub shift_off: f64,
}

impl PoseBounds {
    /// Whether the pose is within both.
    pub fn hold(&self) -> bool {
        self.turn_off <= self.turn_bound && self.shift_off <= self.shift_bound
    }
}

/// One reference at the pose that was found for it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReferenceCase {
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
    pub(super) fn of(frame: &SuiteFrame, truth: &FrameTruth, inspection: &Inspection) -> Self {
        let verdict = &inspection.verdict;
        let [score, margin] = verdict.score().unwrap_or_default();
        Self {
            subject: frame.subject(),
            expected: frame.expected.clone(),
            seed: frame.setup.seed,
            found: verdict.guess().map(str::to_owned),
            score,
            margin,
            accepted: verdict.is_accepted(),
            is_unknown: verdict.is_unknown(),
            reason: verdict.complaint().map(|[why, _]| why),
            is_approximate: verdict.is_approximate(),
            visible_share: truth.visible_share,
            part_iou: part_iou(truth, &inspection.segmentation),
            bounds: bounds(frame, truth, inspection),
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

fn part_iou(truth: &FrameTruth, segmentation: &Segmentation) -> Option<f64> {
    let (mut num_both, mut num_true, mut num_taken) = (0_usize, 0_usize, 0_usize);
    for (is, taken_for) in truth.labels.iter().zip(&segmentation.labels) {
        let is_part = *is == SurfaceLabel::Part && *taken_for != PointLabel::NoReading;
        let is_taken = *taken_for == PointLabel::Part;
        num_true += usize::from(is_part);
        num_taken += usize::from(is_taken);
        num_both += usize::from(is_part && is_taken);
    }
    let num_either = num_true + num_taken - num_both;
    (num_true > 0).then(|| num_both as f64 / num_either as f64)
}

fn bounds(frame: &SuiteFrame, truth: &FrameTruth, inspection: &Inspection) -> Option<PoseBounds> {
    let first = inspection.ranking.entries.first()?;
    let pose = inspection.pose.as_ref()?.as_ref().ok()?;
    let found = pose.uncertainty.filter(Uncertainty::is_held)?;
    let seen = &inspection.segmentation.part.as_ref().ok()?.cloud.points;
    if frame.expected.as_ref() != Some(&first.part) {
        return None;
    }
    let sum: Vector3<f64> = seen.iter().map(|p| p.coords.cast::<f64>()).sum();
    let middle = Point3::from(sum / seen.len().max(1) as f64);
    let reference_from_camera = (truth.camera_from_part * enrolment_pose().inverse()).inverse();
    let off = pose_error(&pose.target_from_source, &reference_from_camera, &middle);
    Some(PoseBounds {
        turn_bound: found.turn.degrees(),
        shift_bound: found.shift.mm(),
        turn_off: off.rotation.degrees(),
        shift_off: off.shift.mm(),
    })
}

fn contender(
    frame: &SuiteFrame,
    truth: &FrameTruth,
    entry: &ConfirmedMatch,
) -> Option<ReferenceCase> {
    let is_there = frame.expected.as_ref() == Some(&entry.part);
    let pose_off = entry.pose.as_ref().filter(|_| is_there).map(|pose| {
        // The reference's space is the camera's when the part was enrolled.
        let camera_from_part = truth.camera_from_part * enrolment_pose().inverse();
        let middle = enrolment_pose() * Point3::origin();
        let off = pose_error(&pose.camera_from_part(), &camera_from_part, &middle);
        [off.rotation.degrees(), off.shift.mm()]
    });
    Some(ReferenceCase {
        part: entry.part.clone(),
        score: entry.score,
        evidence: entry.evidence?,
        pose_off,
    })
}
