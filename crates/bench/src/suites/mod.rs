//! Sets of simulated frames that recognition is measured on, with the expected result of each frame.
//!
//! A frame depends on its seed only. Parameters are tuned on frames from [`TUNING_SEED`] on and on the car models that
//! go with them; results are measured on frames from [`MEASURING_SEED`] on, which influenced no parameter.

mod case;
mod closest;
mod cut;
mod expectation;
mod figures;
mod libraries;
mod rack;
mod run;

use serde::Serialize;

pub(super) use self::{case::middle_of_seen, cut::pushed_out_of_the_picture};
pub use self::{
    case::{PoseBounds, ReferenceCase, SuiteCase, Surplus},
    closest::NearestMistake,
    expectation::{Expectation, ExpectationFigures, add_expected_racks},
    figures::SuiteFigures,
    libraries::SuiteLibraries,
    rack::RackFigures,
    run::{ConfusionEntry, InspectedFrame, SuiteResult, run_suite},
};
use geometry::{depth_frame::DepthFrame, rigid::RigidTransform};
pub use inspection::library::{enrol_part, enrolled_name, enrolment_pose};
use simulate::{
    CellSetup, Clutter, FIRST_OTHER_MAKE, FrameTruth, ObjectKind, PartKind, PartPose, PoseRange,
    RackKind, RackSetup, SensorNoise, Side, SimulatedObject, Stand, SurfaceLabel, frame,
    rack_frame,
};

/// First seed of the frames for tuning parameters.
pub const TUNING_SEED: u64 = 3_000_000;
/// First seed of the frames for measuring only.
pub const MEASURING_SEED: u64 = 9_000_000;
/// Share of the part beyond the picture in every second frame of [`Suite::Hard`].
const PUSHED_OUT: std::ops::Range<f64> = 0.10..0.25;
/// Seeds reserved per suite: more than any run needs.
const SEEDS_PER_SUITE: u64 = 100_000;
/// Numbers of places of racks, one after the other.
const NUM_PLACES: [usize; 4] = [2, 3, 4, 5];

/// A set of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Suite {
    /// Enrolled parts, carefully hung: ±10°, 1.0 to 1.4 m.
    Standard,
    /// Enrolled parts, roughly placed: ±30° yaw, ±20° pitch, any roll, 0.9 to 1.8 m.
    Placed,
    /// The same parts of other car models, placed.
    OtherModels,
    /// Enrolled parts turned by up to 45°, with objects on the floor and three times the noise; every second pair of
    /// poses on a stand, and 10 to 25 % of the part behind a plank or outside the picture.
    Hard,
    /// Objects that are not enrolled, placed, and empty cells.
    Unknown,
    /// Right-hand parts where only the left-hand ones are enrolled, placed.
    Mirrored,
    /// Parts of both sides, placed, with both enrolled.
    BothSides,
    /// Enrolled parts standing on the floor: ±30° yaw, leaning by up to 20°, alternately on another edge.
    Floor,
    /// Enrolled parts on a stand in a paint booth, seen from the robot's flange: ±30°, any roll, 0.8 to 1.5 m, most of
    /// them cut by the picture, down to a quarter.
    Booth,
    /// Objects on a stand in the booth that are not enrolled, and stands without a part.
    BoothUnknown,
    /// The same parts of other makes, placed: 6 to 12 % off in every dimension, and curved differently.
    OtherMakes,
    /// The same with three times the noise.
    NoisyMakes,
    /// Racks of 2 to 5 places with different enrolled parts, [apart](RackKind::Apart).
    RackApart,
    /// Such racks under a bar, every part on hooks.
    RackOnBar,
    /// Racks of [touching](RackKind::Touching) parts.
    RackTouching,
    /// Racks of [overlapping](RackKind::Overlapping) parts.
    RackOverlapping,
    /// Racks with two [equal](RackKind::Equal) parts.
    RackEqual,
    /// Racks with left and right of one kind, [of which](RackKind::Mirrored) only the left one is enrolled.
    RackMirrored,
    /// Racks with an object that is not enrolled ([foreign](RackKind::Foreign)).
    RackForeign,
    /// Racks with an [empty](RackKind::Empty) place.
    RackEmpty,
}

impl Suite {
    /// All suites.
    pub const ALL: [Self; 20] = [
        Self::Standard,
        Self::Placed,
        Self::OtherModels,
        Self::Hard,
        Self::Unknown,
        Self::Mirrored,
        Self::BothSides,
        Self::Floor,
        Self::Booth,
        Self::BoothUnknown,
        Self::OtherMakes,
        Self::NoisyMakes,
        Self::RackApart,
        Self::RackOnBar,
        Self::RackTouching,
        Self::RackOverlapping,
        Self::RackEqual,
        Self::RackMirrored,
        Self::RackForeign,
        Self::RackEmpty,
    ];

    /// Returns the name used in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Standard => "standard",
            Self::Placed => "placed",
            Self::OtherModels => "other_models",
            Self::Hard => "hard",
            Self::Unknown => "unknown",
            Self::Mirrored => "mirrored",
            Self::BothSides => "both_sides",
            Self::Floor => "floor",
            Self::Booth => "booth",
            Self::BoothUnknown => "booth_unknown",
            Self::OtherMakes => "other_makes",
            Self::NoisyMakes => "noisy_makes",
            Self::RackApart => "rack_apart",
            Self::RackOnBar => "rack_on_bar",
            Self::RackTouching => "rack_touching",
            Self::RackOverlapping => "rack_overlapping",
            Self::RackEqual => "rack_equal",
            Self::RackMirrored => "rack_mirrored",
            Self::RackForeign => "rack_foreign",
            Self::RackEmpty => "rack_empty",
        }
    }

    /// Returns whether every frame shows (nearly) all of one of the eight enrolled parts, or of its counterpart from
    /// another model, so that a system that compares whole shapes and cannot refuse can be right.
    pub fn is_for_all_systems(self) -> bool {
        matches!(
            self,
            Self::Standard | Self::Placed | Self::OtherModels | Self::Hard | Self::Floor
        )
    }

    /// Returns the kind of the racks and what they hang on; `None` if a frame shows one part.
    pub fn rack(self) -> Option<(RackKind, Stand)> {
        let kind = match self {
            Self::RackApart => RackKind::Apart,
            Self::RackOnBar => return Some((RackKind::Apart, Stand::Post)),
            Self::RackTouching => RackKind::Touching,
            Self::RackOverlapping => RackKind::Overlapping,
            Self::RackEqual => RackKind::Equal,
            Self::RackMirrored => RackKind::Mirrored,
            Self::RackForeign => RackKind::Foreign,
            Self::RackEmpty => RackKind::Empty,
            _ => return None,
        };
        Some((kind, Stand::None))
    }

    /// Returns the frames: `num_poses` per subject, or as many racks.
    pub fn frames(self, num_poses: u64, first_seed: u64) -> Vec<SuiteFrame> {
        let first_seed = first_seed + self as u64 * SEEDS_PER_SUITE;
        if let Some((kind, stand)) = self.rack() {
            let numbers = NUM_PLACES.into_iter().cycle().zip(first_seed..);
            let racks = numbers.take(num_poses as usize).map(|(num_places, seed)| {
                let mut rack = RackSetup::drawn(kind, num_places, 0, seed).expect("2 to 5 places");
                rack.cell.stand = stand;
                SuiteFrame::Rack(rack)
            });
            return racks.collect();
        }
        let subjects = self.subjects();
        (0..num_poses)
            .flat_map(|pose| {
                let first = first_seed + pose * subjects.len() as u64;
                subjects
                    .iter()
                    .zip(first..)
                    .map(move |(subject, seed)| (pose, *subject, seed))
            })
            .map(|(pose, subject, seed)| SuiteFrame::Cell(self.setup(subject, pose, seed)))
            .collect()
    }

    fn subjects(self) -> Vec<SimulatedObject> {
        let part = |kind, side| SimulatedObject::Part {
            kind,
            side,
            model_seed: 0,
        };
        let sided = || PartKind::ALL.into_iter().filter(|kind| kind.is_sided());
        match self {
            Self::Standard
            | Self::Placed
            | Self::OtherModels
            | Self::Hard
            | Self::Floor
            | Self::Booth
            | Self::OtherMakes
            | Self::NoisyMakes => PartKind::ALL.map(|kind| part(kind, Side::Left)).to_vec(),
            Self::Unknown | Self::BoothUnknown => ObjectKind::ALL
                .into_iter()
                .map(SimulatedObject::Object)
                .chain([SimulatedObject::Nothing])
                .collect(),
            Self::Mirrored => sided().map(|kind| part(kind, Side::Right)).collect(),
            Self::BothSides => sided()
                .flat_map(|kind| Side::ALL.map(|side| part(kind, side)))
                .collect(),
            Self::RackApart
            | Self::RackOnBar
            | Self::RackTouching
            | Self::RackOverlapping
            | Self::RackEqual
            | Self::RackMirrored
            | Self::RackForeign
            | Self::RackEmpty => Vec::new(),
        }
    }

    fn setup(self, subject: SimulatedObject, pose: u64, seed: u64) -> CellSetup {
        let mut setup = CellSetup::new(subject, seed);
        match self {
            Self::Booth | Self::BoothUnknown => setup = CellSetup::booth(subject, seed),
            Self::Standard => setup.pose = PartPose::Drawn(PoseRange::facing()),
            Self::Floor => {
                setup.stand = Stand::Floor;
                let roll = match pose % 2 {
                    0 => PoseRange::facing().roll,
                    _ => PoseRange::placed().roll,
                };
                setup.pose = PartPose::Drawn(PoseRange {
                    roll,
                    ..PoseRange::placed()
                });
            }
            Self::OtherModels | Self::OtherMakes | Self::NoisyMakes => {
                if let SimulatedObject::Part { model_seed, .. } = &mut setup.subject {
                    // Never 0, and different models for tuning and measuring.
                    *model_seed = seed / 10_000 + pose;
                    if self != Self::OtherModels {
                        *model_seed += FIRST_OTHER_MAKE;
                    }
                }
                if self == Self::NoisyMakes {
                    setup.noise.multiplier = 3.0;
                }
            }
            Self::Hard => {
                setup.noise = SensorNoise {
                    multiplier: 3.0,
                    ..SensorNoise::kinect(seed)
                };
                let mesh = setup.subject.mesh();
                let placed = PoseRange::hard().draw(&mesh, &setup.intrinsics, seed);
                (setup.clutter, setup.pose) = if pose.is_multiple_of(2) {
                    (Clutter::InFront, PartPose::Fixed(placed.camera_from_part))
                } else {
                    let pushed = pushed_out_of_the_picture(
                        &mesh,
                        &placed,
                        &setup.intrinsics,
                        PUSHED_OUT,
                        seed,
                    );
                    (Clutter::OnFloor, PartPose::Fixed(pushed))
                };
                if pose / 2 % 2 == 1 {
                    setup.stand = Stand::Post;
                }
            }
            _ => {}
        }
        setup
    }

    /// Returns the enrolled name of what hangs there; `None` if it may not be accepted.
    fn expected(self, subject: SimulatedObject) -> Option<String> {
        let is_enrolled = match subject {
            SimulatedObject::Part { kind, side, .. } => {
                side == Side::Left || !kind.is_sided() || self == Self::BothSides
            }
            SimulatedObject::Object(_) | SimulatedObject::Nothing => false,
        };
        is_enrolled.then(|| name_of(subject))
    }
}

/// Returns the name of what hangs there.
fn name_of(subject: SimulatedObject) -> String {
    match subject {
        SimulatedObject::Part { kind, side, .. } => enrolled_name(kind, side),
        SimulatedObject::Object(kind) => kind.name().to_owned(),
        SimulatedObject::Nothing => "nothing".to_owned(),
    }
}

/// One frame of a suite, as the setup of its simulated cell.
#[derive(Clone, Debug, PartialEq)]
pub enum SuiteFrame {
    /// One part or object, or none.
    Cell(CellSetup),
    /// Several side by side.
    Rack(RackSetup),
}

impl SuiteFrame {
    /// Returns the cell; that of a rack has no subject.
    pub fn cell(&self) -> &CellSetup {
        match self {
            Self::Cell(cell) => cell,
            Self::Rack(rack) => &rack.cell,
        }
    }

    /// Takes the frame.
    fn shot(&self, suite: Suite) -> SuiteShot {
        let (frame, truths, labels) = match self {
            Self::Cell(cell) => {
                let mut shot = frame(cell);
                let labels = std::mem::take(&mut shot.truth.labels);
                (shot.frame, vec![shot.truth], labels)
            }
            Self::Rack(rack) => {
                let shot = rack_frame(rack).expect("a rack that can be drawn");
                (shot.frame, shot.truth.parts, shot.truth.labels)
            }
        };
        let things = (0..).zip(truths).map(|(number, truth)| SuiteThing {
            name: name_of(truth.subject),
            expected: suite.expected(truth.subject),
            label: match self {
                Self::Cell(_) => SurfaceLabel::Part,
                Self::Rack(_) => SurfaceLabel::RackPart(number),
            },
            truth: Some(truth),
        });
        SuiteShot {
            frame,
            seed: self.cell().seed,
            things: things.collect(),
            labels,
        }
    }
}

/// A frame with its truth.
struct SuiteShot {
    frame: DepthFrame,
    seed: u64,
    /// What hangs there, from left to right; one thing of the name `nothing` in an empty cell.
    things: Vec<SuiteThing>,
    /// The surface that each pixel shows.
    labels: Vec<SurfaceLabel>,
}

/// What a case is about.
struct SuiteThing {
    name: String,
    /// The enrolled name; `None` if nothing may be accepted.
    expected: Option<String>,
    /// The label of the pixels that show it.
    label: SurfaceLabel,
    /// `None` if there is no such thing.
    truth: Option<FrameTruth>,
}

impl SuiteThing {
    /// Returns the true pose of its reference, whose coordinates are those of the camera at enrolment.
    fn camera_from_reference(&self) -> Option<RigidTransform> {
        let truth = self.truth.as_ref()?;
        Some(truth.camera_from_part * enrolment_pose().inverse())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_frames_share_a_seed_and_tuning_is_kept_apart_from_measuring() {
        let mut seeds: Vec<u64> = [TUNING_SEED, MEASURING_SEED]
            .into_iter()
            .flat_map(|first| Suite::ALL.map(|suite| suite.frames(5, first)))
            .flatten()
            .map(|frame| frame.cell().seed)
            .collect();
        let num = seeds.len();
        seeds.sort_unstable();
        seeds.dedup();
        assert_eq!(seeds.len(), num);
    }

    #[test]
    fn another_model_is_never_the_enrolled_one() {
        let of = |suite: Suite| suite.frames(3, TUNING_SEED);
        for frame in of(Suite::OtherModels)
            .into_iter()
            .chain(of(Suite::OtherMakes))
            .chain(of(Suite::NoisyMakes))
        {
            let SimulatedObject::Part { model_seed, .. } = frame.cell().subject else {
                panic!("a part");
            };
            assert_ne!(model_seed, 0);
        }
    }
}
