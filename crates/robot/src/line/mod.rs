//! A line that carries parts past a camera fixed beside it: in which direction, and how far for each count of its encoder.
//!
//! Both are fitted once, from poses of a part that passed and the counts at which it was seen. From then on, a pose at one
//! count gives the pose at any other, with bounds that grow with the way between them.

mod delay;
mod file;
mod fit;

use jiff::Timestamp;
use nalgebra::{Translation3, Unit, Vector3};
use serde::Serialize;

use geometry::{
    rigid::RigidTransform,
    units::{Metres, Radians},
};
use stages::pose::Uncertainty;

pub use self::{
    delay::MIN_STOPPED,
    file::LineFileError,
    fit::{CountedPose, LineFitError, MIN_POSES, fit},
};

/// How a line moves, and how its encoder counts.
#[derive(Clone, Debug, PartialEq)]
pub struct LineCalibration {
    /// Direction in which the line moves while the count rises, camera space.
    pub direction: Unit<Vector3<f64>>,
    /// 95 % bound of the direction's error.
    pub direction_bound: Radians,
    /// Way of the line for each count.
    pub way_per_count: Metres,
    /// 95 % bound of its error, as a share.
    pub scale_bound: f64,
    /// How the encoder's counter begins again.
    pub counter: Counter,
    /// Root mean square distance of the poses from the fitted line.
    pub residual: Metres,
    /// Number of poses.
    pub num_poses: usize,
    /// Way between the first and the last of them.
    pub way: Metres,
    /// Name of the part that passed.
    pub part: String,
    /// When it was fitted.
    pub made_at: Timestamp,
    /// Greatest share of the way that the encoder may lose or gain by slipping.
    pub slip: f64,
    /// Time in which a frame is exposed, from the first light of its first row to the last of its last, seconds.
    pub exposure: f64,
    /// Time from the exposure of a frame to the time that the camera gives it, seconds.
    pub delay: f64,
    /// 95 % bound of that time, seconds.
    pub delay_bound: f64,
}

/// A part on a line where it has its pose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct OnLine {
    /// Number of the part on the line, from 1; 0 while it has no pose.
    pub number: u32,
    /// What the encoder shows there; null if it is not known.
    pub count: Option<u32>,
    /// When it is there, by the camera's clock.
    #[cfg_attr(feature = "cli", schemars(with = "String"))]
    pub at: Timestamp,
    /// 95 % bound of the pose's error at the part's middle, millimetres.
    pub bound_mm: f64,
    /// Speed of the line, mm/s; negative while the count falls.
    pub speed_mm_s: f64,
}

/// Share of the way that an encoder may lose or gain, unless the file says otherwise.
pub const DEFAULT_SLIP: f64 = 0.005;
/// Time in which a frame is exposed, unless the file says otherwise, seconds: a frame period of a Kinect.
pub const DEFAULT_EXPOSURE_S: f64 = 1.0 / 30.0;

/// Width of an encoder's counter, which begins again at 0 beyond its greatest count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Counter {
    /// 16 bits.
    Bits16,
    /// 32 bits.
    #[default]
    Bits32,
}

impl Counter {
    /// Number of bits.
    pub fn bits(self) -> u32 {
        match self {
            Self::Bits16 => 16,
            Self::Bits32 => 32,
        }
    }

    /// The counter of this width.
    pub fn of_bits(bits: u32) -> Option<Self> {
        [Self::Bits16, Self::Bits32]
            .into_iter()
            .find(|counter| counter.bits() == bits)
    }

    /// The count without beginning again: of all counts that look like `count`, the nearest to `last`. Signed counters and
    /// unsigned ones are read alike.
    pub fn continued(self, last: i64, count: i64) -> i64 {
        let range = 1_i64 << self.bits();
        let forward = (count - last).rem_euclid(range);
        if forward < range / 2 {
            last + forward
        } else {
            last + forward - range
        }
    }

    /// What the counter shows of a count that does not begin again.
    pub fn shown(self, count: i64) -> u32 {
        count.rem_euclid(1_i64 << self.bits()) as u32
    }
}

impl LineCalibration {
    /// Carries a pose along the line by this way, metres; negative: back.
    pub fn carried(&self, camera_from_part: &RigidTransform, way: f64) -> RigidTransform {
        Translation3::from(self.direction.into_inner() * way) * camera_from_part
    }

    /// The bounds of a pose that was carried along the line by this way. `way_bound` is that of the way itself, metres, beyond
    /// the errors of direction and scale.
    pub fn widened(&self, bounds: Uncertainty, way: f64, way_bound: f64) -> Uncertainty {
        let across = way * self.direction_bound.0;
        Uncertainty {
            shift: Metres(bounds.shift.0.hypot(across).hypot(way_bound)),
            ..bounds
        }
    }

    /// The pose at another count, with its bounds. `slip` is the greatest share of the way between the counts that the
    /// encoder may have lost or gained.
    pub fn pose_at(
        &self,
        (camera_from_part, bounds): (&RigidTransform, Uncertainty),
        counts: f64,
        slip: f64,
    ) -> (RigidTransform, Uncertainty) {
        let way = counts * self.way_per_count.0;
        let way_bound = way * self.scale_bound.hypot(slip);
        (
            self.carried(camera_from_part, way),
            self.widened(bounds, way, way_bound),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_counter_that_begins_again_goes_on() {
        let [short, long] = [Counter::Bits16, Counter::Bits32];
        assert_eq!(short.continued(65_530, 4), 65_540);
        assert_eq!(short.continued(65_540, 65_530), 65_530);
        assert_eq!(short.continued(-3, 65_535), -1);
        assert_eq!(long.continued(4_294_967_290, 5), 4_294_967_301);
        // A signed counter.
        assert_eq!(long.continued(2_147_483_640, -2_147_483_640), 2_147_483_656);
        assert_eq!(short.shown(65_540), 4);
        assert_eq!(long.shown(-1), u32::MAX);
        assert_eq!(Counter::of_bits(16), Some(short));
        assert_eq!(Counter::of_bits(24), None);
    }
}
