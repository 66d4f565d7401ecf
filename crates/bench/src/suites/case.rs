//! Result of one frame of a suite, or of one thing on a rack.

use nalgebra::{Point3, Vector3};
use serde::Serialize;

use super::{SuiteShot, SuiteThing, enrolment_pose};
use geometry::rigid::pose_error;
use inspection::pipeline::{Inspection, Timings, Verdict};
use stages::{
    confirm::{ConfirmedMatch, Evidence},
    segment::{PointLabel, Segmentation},
};

/// Result of one frame. Of a rack, everything that hangs there is a case, and so is every [surplus](Surplus) inspection.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SuiteCase {
    /// Name of what hung in the cell.
    pub subject: String,
    /// The right name; `None` if nothing may be accepted.
    pub expected: Option<String>,
    /// Seed of the frame.
    pub seed: u64,
    /// The best guess; `None` if nothing was recognised.
    pub found: Option<String>,
    /// Of a rack, why the inspection is one too many.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surplus: Option<Surplus>,
    /// Score of the best guess.
    pub score: f64,
    /// Margin of the best guess.
    pub margin: f64,
    /// True if the verdict was accepted.
    pub accepted: bool,
    /// True if the verdict was unknown, or the mirror image of an enrolled part.
    pub is_unknown: bool,
    /// Why it was not accepted.
    pub reason: Option<String>,
    /// True if it was named as another model of an enrolled part, at a pose that is only about right.
    pub is_approximate: bool,
    /// Visible share of the part's camera-facing surface; 0 if nothing hangs there.
    pub visible_share: f64,
    /// Intersection over union of the readings that show the part and those segmented as the part; `None` if no reading
    /// shows the part.
    pub part_iou: Option<f64>,
    /// Bounds of the pose, if the part was named correctly and its pose has any.
    pub bounds: Option<PoseBounds>,
    /// Time of the whole inspection, milliseconds; `None` for something on a rack that was not inspected.
    pub total_ms: Option<f64>,
    /// Time of each stage.
    #[serde(skip)]
    pub timings: Option<Timings>,
    /// The best few examined references of the ranking.
    pub contenders: Vec<ReferenceCase>,
}

/// Why an inspection is one more than hangs on a rack. It must not be accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Surplus {
    /// It is of something of which another one is too.
    Again,
    /// It is of nothing that hangs there.
    Nothing,
}

/// Bounds of a pose and its true error, both at the centroid of the visible points of the part.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PoseBounds {
    /// Rotation bound, degrees.
    pub turn_bound: f64,
    /// Shift bound, millimetres.
    pub shift_bound: f64,
    /// Rotation error, degrees.
    pub turn_off: f64,
    /// Shift error, millimetres.
    pub shift_off: f64,
}

impl PoseBounds {
    /// Returns whether the error is within both bounds.
    pub fn hold(&self) -> bool {
        self.turn_off <= self.turn_bound && self.shift_off <= self.shift_bound
    }
}

/// One reference at its pose.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReferenceCase {
    /// Name of the part.
    pub part: String,
    /// Score of the reference.
    pub score: f64,
    /// The evidence that the score is computed from.
    pub evidence: Evidence,
    /// Pose error for the part that hangs there: degrees, and millimetres at the part's middle.
    pub pose_off: Option<[f64; 2]>,
}

/// Number of contenders kept per frame.
const NUM_CONTENDERS: usize = 3;

impl SuiteCase {
    /// Creates the case of a thing; without an inspection if it was not inspected.
    pub(super) fn of(
        shot: &SuiteShot,
        thing: &SuiteThing,
        inspection: Option<&Inspection>,
    ) -> Self {
        let verdict = inspection.map(|inspection| &inspection.verdict);
        let [score, margin] = verdict.and_then(Verdict::score).unwrap_or_default();
        let timings = inspection.map(|inspection| inspection.timings);
        let entries = inspection.map_or(&[][..], |inspection| &inspection.ranking.entries);
        Self {
            subject: thing.name.clone(),
            expected: thing.expected.clone(),
            seed: shot.seed,
            found: verdict.and_then(Verdict::guess).map(str::to_owned),
            surplus: None,
            score,
            margin,
            accepted: verdict.is_some_and(Verdict::is_accepted),
            is_unknown: verdict.is_some_and(Verdict::is_unknown),
            reason: verdict.and_then(Verdict::complaint).map(|[why, _]| why),
            is_approximate: verdict.is_some_and(Verdict::is_approximate),
            visible_share: thing.truth.as_ref().map_or(0.0, |t| t.visible_share),
            part_iou: inspection.and_then(|i| part_iou(shot, thing, &i.segmentation)),
            bounds: inspection.and_then(|i| bounds(thing, i)),
            timings,
            total_ms: timings.map(|timings| timings.total.as_secs_f64() * 1e3),
            contenders: entries
                .iter()
                .take(NUM_CONTENDERS)
                .filter_map(|entry| contender(thing, entry))
                .collect(),
        }
    }

    /// Returns whether the name is right or, where no name is, nothing was accepted.
    pub fn is_right(&self) -> bool {
        match &self.expected {
            Some(name) => self.found.as_ref() == Some(name),
            None => !self.accepted,
        }
    }

    /// Returns whether it was accepted as something else, so that the robot would move.
    pub fn is_wrong_accepted(&self) -> bool {
        self.accepted && self.found != self.expected
    }

    /// Returns the pose error of a correctly named part: degrees, and millimetres at the part's middle.
    pub fn pose_off(&self) -> Option<[f64; 2]> {
        let first = self.contenders.first()?;
        first.pose_off.filter(|_| self.found == self.expected)
    }

    /// Returns whether the pose error is at most 2° and 10 mm.
    pub fn is_well_placed(&self) -> bool {
        self.pose_off()
            .is_some_and(|off| off[0] <= 2.0 && off[1] <= 10.0)
    }
}

fn part_iou(shot: &SuiteShot, thing: &SuiteThing, segmentation: &Segmentation) -> Option<f64> {
    thing.truth.as_ref()?;
    let (mut num_both, mut num_true, mut num_taken) = (0_usize, 0_usize, 0_usize);
    for (is, taken_for) in shot.labels.iter().zip(&segmentation.labels) {
        let is_part = *is == thing.label && *taken_for != PointLabel::NoReading;
        let is_taken = *taken_for == PointLabel::Part;
        num_true += usize::from(is_part);
        num_taken += usize::from(is_taken);
        num_both += usize::from(is_part && is_taken);
    }
    let num_either = num_true + num_taken - num_both;
    (num_true > 0).then(|| num_both as f64 / num_either as f64)
}

fn bounds(thing: &SuiteThing, inspection: &Inspection) -> Option<PoseBounds> {
    let first = inspection.ranking.entries.first()?;
    let pose = inspection.found_pose()?;
    let found = pose.bounds()?;
    let middle = middle_of_seen(inspection)?;
    if thing.expected.as_ref() != Some(&first.part) {
        return None;
    }
    let camera_from_reference = thing.camera_from_reference()?;
    let off = pose_error(
        &pose.target_from_source,
        &camera_from_reference.inverse(),
        &middle,
    );
    Some(PoseBounds {
        turn_bound: found.turn.degrees(),
        shift_bound: found.shift.mm(),
        turn_off: off.rotation.degrees(),
        shift_off: off.shift.mm(),
    })
}

/// Returns the centroid of the part's visible points.
pub(crate) fn middle_of_seen(inspection: &Inspection) -> Option<Point3<f64>> {
    let seen = &inspection.segmentation.part.as_ref().ok()?.cloud.points;
    let sum: Vector3<f64> = seen.iter().map(|p| p.coords.cast::<f64>()).sum();
    Some(Point3::from(sum / seen.len().max(1) as f64))
}

fn contender(thing: &SuiteThing, entry: &ConfirmedMatch) -> Option<ReferenceCase> {
    let is_there = thing.expected.as_ref() == Some(&entry.part);
    let pose = entry.pose.as_ref().filter(|_| is_there);
    let pose_off = pose
        .zip(thing.camera_from_reference())
        .map(|(pose, truth)| {
            let middle = enrolment_pose() * Point3::origin();
            let off = pose_error(&pose.camera_from_part(), &truth, &middle);
            [off.rotation.degrees(), off.shift.mm()]
        });
    Some(ReferenceCase {
        part: entry.part.clone(),
        score: entry.score,
        evidence: entry.evidence?,
        pose_off,
    })
}
