//! Check of the cell: whether the camera has moved, found by comparing the same part, hung in the same place, with an
//! earlier [`CellBaseline`].
//!
//! The part's points are aligned with those of the baseline, and wall and floor are compared too. If the camera moved,
//! everything in the picture moved with it; if only the part hangs elsewhere, wall and floor stay where they were.
//! Nothing needs to be enrolled: any rigid object with edges will do.

mod check;
mod file;
#[cfg(test)]
mod tests;
mod view;

use std::ops::RangeInclusive;

use jiff::Timestamp;
use nalgebra::{Point3, Vector3};
use serde::{Deserialize, Serialize};

use self::view::PlanePatch;
pub use self::{
    check::{CellCheck, CellFinding, write_csv},
    file::{CellCheckError, CellCheckFolder},
    view::{CellView, CellViews},
};
use geometry::{
    cloud::PointCloud,
    plane::Plane,
    rigid::{PoseDelta, RigidTransform, pose_error},
    statistics::lower_median,
    units::{Metres, Radians},
    voxel::downsample,
};
use stages::pose::{PoseError, PoseEstimate, PoseMethod, PreparedTarget, align_to};
use texts::{Described, Message};

/// Most frames in one check; more do not improve it.
pub const MAX_FRAMES: usize = 16;
/// Frames captured from a camera unless a person asks for another number.
pub const USUAL_FRAMES: usize = 5;
/// Spacing of the baseline's points; the frames are averaged within it.
const BASELINE_SPACING: Metres = Metres(0.003);
/// Below this overlap it is another part, or the part is partly hidden.
const MIN_OVERLAP: f64 = 0.9;
/// Planes farther apart than this are different planes.
const SAME_PLANE_MAX_DIFFERENCE: (Metres, Radians) = (Metres(0.3), Radians(0.25));
/// A noise ratio above this is reported.
const MAX_NOISE_RATIO: f64 = 1.5;

/// The largest movement that still counts as in place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CellLimits {
    /// Movement of the part's middle, and of wall and floor where they are seen.
    pub shift: Metres,
    /// Rotation of the part.
    pub turn: Radians,
}

impl Default for CellLimits {
    /// 5 mm and 0.5°: frames of a part at rest, with a Kinect's noise, differed by at most 3.1 mm and 0.4°.
    fn default() -> Self {
        Self {
            shift: Metres::from_mm(5.0),
            turn: Radians::from_degrees(0.5),
        }
    }
}

impl CellLimits {
    /// Shifts that may be set as the limit, millimetres.
    pub const SHIFT_MM: RangeInclusive<f64> = 0.5..=100.0;
    /// Turns that may be set as the limit, degrees.
    pub const TURN_DEGREES: RangeInclusive<f64> = 0.05..=10.0;

    fn allow(&self, moved: &PoseDelta) -> bool {
        moved.shift <= self.shift && moved.rotation <= self.turn
    }
}

/// What the camera saw while the cell was right.
#[derive(Clone, Debug)]
pub struct CellBaseline {
    /// When it was taken.
    pub made_at: Timestamp,
    /// Number of frames that it was taken from.
    pub num_frames: usize,
    /// True if a frame was simulated.
    pub is_simulated: bool,
    /// The largest movement that still counts as in place.
    pub limits: CellLimits,
    view: CellView,
}

/// Why frames cannot be a baseline, or cannot be compared with one.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CellViewError {
    /// No frame was given.
    NoFrame,
    /// Part or camera moved between the frames.
    Moving {
        /// Number of the frame, from 1.
        frame: usize,
        /// How far it moved from the first frame.
        moved: PoseDelta,
    },
    /// Too little of what is seen lies on the baseline's part.
    OtherPart {
        /// Number of the frame, from 1.
        frame: usize,
        /// Share of the view that lies on the baseline's part, 0..1.
        overlap: f64,
    },
    /// The part cannot be aligned.
    Pose {
        /// Number of the frame, from 1.
        frame: usize,
        /// The underlying error.
        error: PoseError,
    },
}

impl Described for CellViewError {
    fn message(&self) -> Message {
        match self {
            Self::NoFrame => Message::new("cell-no-frame"),
            Self::Moving { frame, moved } => Message::new("cell-moving")
                .with("frame", *frame as f64)
                .with("shift_m", moved.shift.0)
                .with("turn_rad", moved.rotation.0),
            Self::OtherPart { frame, overlap } => Message::new("cell-other-part")
                .with("frame", *frame as f64)
                .with("overlap", *overlap),
            Self::Pose { frame, error } => Message::new("cell-pose")
                .with("frame", *frame as f64)
                .caused_by(error.message()),
        }
    }
}

texts::display!(CellViewError);

impl CellBaseline {
    /// Makes a baseline from frames in which part and camera stand still.
    pub fn new(
        views: &[CellView],
        limits: CellLimits,
        is_simulated: bool,
        made_at: Timestamp,
    ) -> Result<Self, CellViewError> {
        let [first, others @ ..] = views else {
            return Err(CellViewError::NoFrame);
        };
        let alone = Self {
            made_at,
            num_frames: views.len(),
            is_simulated,
            limits,
            view: first.clone(),
        };
        let target = alone.prepared()?;
        for (i, view) in others.iter().enumerate() {
            let (moved, _) = Self::moved(view, &target, i + 2)?;
            let moved = pose_error(&moved, &RigidTransform::identity(), &alone.middle());
            if !limits.allow(&moved) {
                return Err(CellViewError::Moving {
                    frame: i + 2,
                    moved,
                });
            }
        }
        let all = views.iter().flat_map(|view| view.part.points.iter());
        let all = PointCloud::from_points(all.copied());
        Ok(Self {
            view: CellView {
                part: downsample(&all, BASELINE_SPACING),
                noise_at_1m: Metres(median_noise(views)),
                ..alone.view
            },
            ..alone
        })
    }

    /// Number of background planes (wall, floor) in it.
    pub fn num_planes(&self) -> usize {
        self.view.background.len()
    }

    /// Middle of the part's bounding box, camera space.
    fn middle(&self) -> Point3<f64> {
        let bounds = self.view.part.bounds();
        bounds.map_or_else(Point3::origin, |(low, high)| {
            nalgebra::center(&low, &high).cast()
        })
    }

    fn prepared(&self) -> Result<PreparedTarget, CellViewError> {
        PreparedTarget::new(&self.view.part)
            .map_err(|error| CellViewError::Pose { frame: 1, error })
    }

    /// Returns the motion of the part from the baseline to a view, and the root mean square distance there, metres.
    fn moved(
        view: &CellView,
        target: &PreparedTarget,
        frame: usize,
    ) -> Result<(RigidTransform, f64), CellViewError> {
        let align = |method: PoseMethod, start| {
            align_to(&view.part, target, &method.into(), Some(start), &|| false)
        };
        let overlap = |pose: &PoseEstimate| pose.fit.overlap;
        let still = RigidTransform::identity();
        let mut found = align(PoseMethod::Global, still);
        if !found
            .as_ref()
            .is_ok_and(|found| overlap(found) >= MIN_OVERLAP)
        {
            // For a grid that moved by several centimetres, plain ICP comes near and the global search continues from
            // there.
            let again = align(PoseMethod::Icp, still)
                .and_then(|near| align(PoseMethod::Global, near.target_from_source));
            let least = found.as_ref().map_or(0.0, overlap);
            if again.as_ref().is_ok_and(|again| overlap(again) > least) {
                found = again;
            }
        }
        let found = found.map_err(|error| match error {
            PoseError::NoOverlap { .. } | PoseError::SizesDiffer { .. } => {
                CellViewError::OtherPart {
                    frame,
                    overlap: 0.0,
                }
            }
            error => CellViewError::Pose { frame, error },
        })?;
        let overlap = overlap(&found);
        if overlap < MIN_OVERLAP {
            return Err(CellViewError::OtherPart { frame, overlap });
        }
        Ok((found.target_from_source.inverse(), found.fit.rms_m))
    }

    /// Compares frames with the baseline. Of several frames the median counts: a single one may be off by some
    /// millimetres.
    pub fn check(
        &self,
        views: &[CellView],
        is_simulated: bool,
        at: Timestamp,
    ) -> Result<CellCheck, CellViewError> {
        if views.is_empty() {
            return Err(CellViewError::NoFrame);
        }
        let middle = self.middle();
        let target = self.prepared()?;
        let mut found: Vec<(f64, RigidTransform, f64)> = Vec::with_capacity(views.len());
        for (i, view) in views.iter().enumerate() {
            let (moved, rms_m) = Self::moved(view, &target, i + 1)?;
            let off = pose_error(&moved, &RigidTransform::identity(), &middle);
            found.push((self.share_of_limits(&off), moved, rms_m));
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        // The median; the lower of the two middle values if their number is even.
        let (_, moved, rms_m) = found[(found.len() - 1) / 2];
        let off = pose_error(&moved, &RigidTransform::identity(), &middle);
        let shift: Vector3<f64> = moved * middle - middle;
        let background = self.background_shift(views);
        let noise_ratio = median_noise(views) / self.view.noise_at_1m.0;
        let stays = background.map(|shift| shift <= self.limits.shift);
        let together = self.moved_together(views, &moved);
        let finding = match (self.limits.allow(&off), stays, together) {
            (true, ..) if noise_ratio > MAX_NOISE_RATIO => CellFinding::Noisier,
            (true, ..) => CellFinding::InPlace,
            (false, Some(true), false) => CellFinding::PartMoved,
            // Whether the part moved as well does not matter: the camera must be calibrated again anyway.
            (false, Some(false), _) | (false, None, true) => CellFinding::CameraMoved,
            (false, Some(true), true) | (false, None, false) => CellFinding::PartOrCameraMoved,
        };
        Ok(CellCheck {
            at,
            baseline: self.made_at,
            num_frames: views.len(),
            is_simulated: is_simulated || self.is_simulated,
            finding,
            shift_m: shift.into(),
            turn_rad: off.rotation.0,
            background_shift_m: background.map(|shift| shift.0),
            rms_m,
            noise_ratio,
        })
    }

    fn share_of_limits(&self, off: &PoseDelta) -> f64 {
        (off.shift.0 / self.limits.shift.0).max(off.rotation.0 / self.limits.turn.0)
    }

    /// Pairs wall and floor, where they would be after this motion, with the planes that the view shows there. Planes
    /// that it does not show are left out.
    fn background(&self, view: &CellView, moved: &RigidTransform) -> Vec<(PlanePatch, Plane)> {
        let pairs = self.view.background.iter().filter_map(|before| {
            let expected = before.carried(moved);
            let planes = view.background.iter().map(|now| now.plane);
            let off = |plane: &Plane| expected.distance_to(plane).0;
            let nearest = planes.min_by(|a, b| off(a).total_cmp(&off(b)))?;
            let is_same = expected.distance_to(&nearest) < SAME_PLANE_MAX_DIFFERENCE.0
                && expected.plane.normal.angle(&nearest.normal) < SAME_PLANE_MAX_DIFFERENCE.1.0;
            is_same.then_some((expected, nearest))
        });
        pairs.collect()
    }

    /// Returns how far wall and floor moved where they are seen, as the median over the views; `None` if neither was
    /// found again.
    fn background_shift(&self, views: &[CellView]) -> Option<Metres> {
        let still = RigidTransform::identity();
        let shifts = views.iter().filter_map(|view| {
            let pairs = self.background(view, &still).into_iter();
            let shifts = pairs.map(|(expected, now)| expected.distance_to(&now).0);
            shifts.max_by(f64::total_cmp)
        });
        lower_median(shifts).map(Metres)
    }

    /// Returns true if wall and floor of most views can have moved with the part. The part's motion is known to within
    /// the limits: at the part a plane may be off by that much, and farther away by what the turn adds there.
    fn moved_together(&self, views: &[CellView], moved: &RigidTransform) -> bool {
        let at = moved * self.middle();
        let with_part = |(expected, now): &(PlanePatch, Plane)| {
            let there = expected.plane.signed_distance(&at) - now.signed_distance(&at);
            let turn = Radians(expected.plane.normal.angle(&now.normal));
            let off = PoseDelta {
                shift: Metres(there.abs()),
                rotation: turn,
            };
            self.limits.allow(&off) || expected.distance_to(now) <= self.limits.shift
        };
        let together = |view: &&CellView| {
            let pairs = self.background(view, moved);
            !pairs.is_empty() && pairs.iter().all(with_part)
        };
        2 * views.iter().filter(together).count() > views.len()
    }
}

/// Median noise of the views' depth at 1 m; zero without views.
fn median_noise(views: &[CellView]) -> f64 {
    lower_median(views.iter().map(|view| view.noise_at_1m.0)).unwrap_or(0.0)
}
