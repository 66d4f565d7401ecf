//! Measures whether pose errors stay within the bounds that the inspection reports, on parts with exact ground truth.
//!
//! Each part is enrolled, rendered in simulated frames, and inspected. The pose error is taken where the bounds hold:
//! at the centroid of the visible points. Good bounds contain 95 of 100 errors without being many times larger than
//! them.

mod sheet;
mod subject;

use nalgebra::Point3;
use serde::Serialize;

pub(super) use self::subject::hung;
pub use self::{
    sheet::{SheetForm, THICKNESSES},
    subject::{BoundsLibrary, BoundsPart},
};
use super::suites::{middle_of_seen, pushed_out_of_the_picture};
use geometry::{
    rigid::{PoseDelta, RigidTransform, pose_error},
    units::{Metres, Radians},
};
use inspection::pipeline::{Recipe, Unwatched, run};
use simulate::{
    self, CellSetup, Clutter, PartPose, PoseRange, SimulatedFrame, frame_of_mesh, stereo_frame,
    time_of_flight_frame,
};
use stages::{
    pose::{PoseEstimate, PoseWarning, Uncertainty},
    scene::scene_from_frame,
};

/// The camera and its noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Condition {
    /// A Kinect's noise.
    Kinect,
    /// Twice that noise.
    KinectTwice,
    /// Three times that noise.
    KinectThreefold,
    /// A stereo camera.
    Stereo,
    /// A time-of-flight camera.
    TimeOfFlight,
    /// A Kinect in a paint booth, its depth registered to the colour picture, and the part on a stand; most parts are cut.
    Booth,
}

impl Condition {
    /// All conditions.
    pub const ALL: [Self; 6] = [
        Self::Kinect,
        Self::KinectTwice,
        Self::KinectThreefold,
        Self::Stereo,
        Self::TimeOfFlight,
        Self::Booth,
    ];

    /// Returns the name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kinect => "Kinect",
            Self::KinectTwice => "Kinect, noise × 2",
            Self::KinectThreefold => "Kinect, noise × 3",
            Self::Stereo => "stereo",
            Self::TimeOfFlight => "time of flight",
            Self::Booth => "booth",
        }
    }

    /// The views that a part is shown in.
    pub fn views(self) -> &'static [View] {
        match self {
            Self::Booth => &[View::Whole],
            _ => &View::ALL,
        }
    }
}

/// Visible portion of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum View {
    /// The whole part: ±30° to the camera, any roll, 1 to 2 m away.
    Whole,
    /// The same, with 20 to 50 % of the part beyond an edge of the picture.
    Cut,
    /// The same as whole, behind a plank.
    Hidden,
}

impl View {
    /// All views.
    pub const ALL: [Self; 3] = [Self::Whole, Self::Cut, Self::Hidden];

    /// Returns the name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Whole => "whole",
            Self::Cut => "cut",
            Self::Hidden => "hidden",
        }
    }
}

/// Result of one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct BoundsCase {
    /// Name of the part in the frame.
    pub part: String,
    /// The camera.
    pub condition: Condition,
    /// Visible portion of the part.
    pub view: View,
    /// Seed of the frame.
    pub seed: u64,
    /// True if the part was named correctly.
    pub is_named: bool,
    /// True if the verdict was accepted.
    pub is_accepted: bool,
    /// Why it was not accepted.
    pub refused: Option<String>,
    /// The pose found, if the part was named correctly, with the error's shift at the centroid of the visible points.
    pub found: Option<PoseAgainstTruth>,
}

/// A pose compared with the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseAgainstTruth {
    /// Pose error.
    pub error: PoseDelta,
    /// Reported bounds of the error.
    pub bounds: Option<Uncertainty>,
    /// Warning against relying on the pose.
    pub doubt: Option<PoseWarning>,
}

impl PoseAgainstTruth {
    /// Compares a pose with the true one; the error's shift is that of `middle`, a point of the source.
    pub(super) fn of(
        pose: &PoseEstimate,
        target_from_source: &RigidTransform,
        middle: &Point3<f64>,
    ) -> Self {
        Self {
            error: pose_error(&pose.target_from_source, target_from_source, middle),
            bounds: pose.uncertainty,
            doubt: pose.doubt(),
        }
    }

    /// Returns whether the error is at most 5° and 40 mm, so that this is not another pose altogether.
    pub fn is_near(&self) -> bool {
        self.error.rotation.degrees() <= 5.0 && self.error.shift.mm() <= 40.0
    }

    /// Returns whether the error is at most 2° and 10 mm.
    pub fn is_right(&self) -> bool {
        self.error.rotation.degrees() <= 2.0 && self.error.shift.mm() <= 10.0
    }

    /// Returns the bounds, unless the pose is unconstrained.
    pub fn held(&self) -> Option<Uncertainty> {
        self.bounds.filter(Uncertainty::is_held)
    }
}

fn placement() -> PoseRange {
    PoseRange {
        yaw: Radians::from_degrees(30.0),
        pitch: Radians::from_degrees(30.0),
        nearest: Metres(1.0),
        farthest: Metres(2.0),
        ..PoseRange::placed()
    }
}

/// Share of the part outside the picture in a cut view.
const CUT: std::ops::Range<f64> = 0.2..0.5;

/// Inspects every part of a library under a condition in `num_poses` frames of each of these views, and calls `after_each`
/// after every case.
pub fn bounds_cases(
    library: &BoundsLibrary,
    condition: Condition,
    views: &[View],
    num_poses: u64,
    first_seed: u64,
    after_each: impl Fn(),
) -> Vec<BoundsCase> {
    let mut cases = Vec::new();
    let mut seeds = first_seed..;
    for subject in &library.subjects {
        for view in views {
            for seed in seeds.by_ref().take(num_poses as usize) {
                cases.push(inspected(subject, library, condition, *view, seed));
                after_each();
            }
        }
    }
    cases
}

fn shot(subject: &BoundsPart, condition: Condition, view: View, seed: u64) -> SimulatedFrame {
    let nothing = simulate::SimulatedObject::Nothing;
    if condition == Condition::Booth {
        return frame_of_mesh(&CellSetup::booth(nothing, seed), &subject.mesh);
    }
    let mut setup = CellSetup::new(nothing, seed);
    setup.pose = PartPose::Drawn(placement());
    match view {
        View::Whole => {}
        View::Cut => {
            let placed = placement().draw(&subject.mesh, &setup.intrinsics, seed);
            let pushed =
                pushed_out_of_the_picture(&subject.mesh, &placed, &setup.intrinsics, CUT, seed);
            setup.pose = PartPose::Fixed(pushed);
        }
        View::Hidden => setup.clutter = Clutter::InFront,
    }
    setup.noise.multiplier = match condition {
        Condition::Kinect | Condition::Booth => 1.0,
        Condition::KinectTwice => 2.0,
        Condition::KinectThreefold => 3.0,
        Condition::Stereo | Condition::TimeOfFlight => 0.0,
    };
    let mut shot = frame_of_mesh(&setup, &subject.mesh);
    match condition {
        Condition::Stereo => shot.frame = stereo_frame(&shot.frame, seed),
        Condition::TimeOfFlight => shot.frame = time_of_flight_frame(&shot.frame, seed),
        _ => {}
    }
    shot
}

fn inspected(
    subject: &BoundsPart,
    library: &BoundsLibrary,
    condition: Condition,
    view: View,
    seed: u64,
) -> BoundsCase {
    let shot = shot(subject, condition, view, seed);
    let scene = scene_from_frame(&shot.frame);
    let recipe = Recipe::default();
    let inspection = run(&scene, &library.library, &recipe, &Unwatched).expect("not cancelled");
    let first = inspection.ranking.entries.first();
    let is_named = first.is_some_and(|entry| entry.part == subject.name);
    let part_from_camera = (shot.truth.camera_from_part * subject.mesh_from_part).inverse();
    let pose = inspection.found_pose().filter(|_| is_named);
    let found = pose
        .zip(middle_of_seen(&inspection))
        .map(|(pose, middle)| PoseAgainstTruth::of(pose, &part_from_camera, &middle));
    BoundsCase {
        part: subject.name.clone(),
        condition,
        view,
        seed,
        is_named,
        is_accepted: inspection.verdict.is_accepted(),
        refused: inspection.verdict.complaint().map(|[why, _]| why),
        found,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use simulate::PartKind;

    #[test]
    fn parts_of_another_car_are_found_within_their_bounds_mostly() {
        let mut library = BoundsLibrary::captured(3_000_007).expect("parts can be enrolled");
        let kinds = [PartKind::FrontDoor, PartKind::Fender];
        library
            .subjects
            .retain(|subject| kinds.iter().any(|kind| kind.name() == subject.name));
        let cases = bounds_cases(
            &library,
            Condition::Kinect,
            &[View::Whole, View::Cut],
            4,
            3_000_000,
            || (),
        );
        assert_eq!(cases.len(), 16);
        let found = cases.iter().filter(|case| case.is_accepted);
        let found: Vec<PoseAgainstTruth> = found.filter_map(|case| case.found).collect();
        assert!(found.len() >= 6, "{} accepted", found.len());
        let held: Vec<(PoseAgainstTruth, Uncertainty)> = found
            .iter()
            .filter_map(|found| Some((*found, found.held()?)))
            .collect();
        assert!(held.len() + 1 >= found.len(), "{found:?}");
        let within = |(found, bounds): &&(PoseAgainstTruth, Uncertainty)| {
            found.error.shift.0 <= bounds.shift.0 && found.error.rotation.0 <= bounds.turn.0
        };
        assert!(
            held.iter().filter(within).count() + 2 >= held.len(),
            "{held:?}"
        );
    }
}
