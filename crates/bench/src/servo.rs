//! Simulated runs of visual servoing: where they end, how long they take, why they stop, and whether limits are kept.
//!
//! Each run has a part, a start, a calibration error, a delay and a seed of its own, by its number alone: several processes can
//! share the runs. The figures are compared with the truth of the simulation, which the servo does not know.

use std::{ops::Range, sync::Arc, time::Duration};

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

use geometry::{
    error::Advice,
    mesh::TriangleMesh,
    parallel::{map_each, num_cores},
    rigid::PoseDelta,
    units::{Metres, Radians},
};
use inspection::library::{
    EnrolError, EnrolParams, Library, PartDescription, PartName, enrol_captured,
    enrol_standard_parts,
};
use servo::{
    ServoParams, Step,
    simulated::{
        ArmDynamics, CellPart, CellSetup, Disturbance, HandEyeError, RunResult, ScannedPart,
        SimulatedCell, SimulatedTarget, run, run_in_single_moves,
    },
};
use simulate::PartKind;
use stages::{scene::SceneCloud, segment::SegmentedPart};

/// The parts that are servoed to, and the library with all of them.
pub struct ServoParts {
    library: Library,
    parts: Vec<CellPart>,
}

/// Why a capture cannot be hung in the simulated cell.
#[derive(Debug, thiserror::Error, Advice)]
pub enum ServoPartError {
    /// Nothing in it can be enrolled.
    #[error(transparent)]
    #[advice(transparent)]
    Enrol(#[from] EnrolError),
    /// It has no rows and columns, so that its surface is not known.
    #[error("a cloud without rows and columns")]
    #[advice = "Give a depth image, or an organised cloud"]
    NotOrganised,
}

/// Neighbouring readings belong to one surface up to this difference in depth, metres.
const MAX_STEP_M: f32 = 0.02;

impl ServoParts {
    /// The eight simulated parts.
    pub fn standard() -> Result<Self, EnrolError> {
        Ok(Self {
            library: enrol_standard_parts(&EnrolParams::default())?,
            parts: PartKind::ALL.map(CellPart::Simulated).to_vec(),
        })
    }

    /// Adds the part of a real capture: it is enrolled under this name, and the simulated camera sees the surface that the capture
    /// shows.
    pub fn add_captured(
        &mut self,
        scene: &SceneCloud,
        name: PartName,
    ) -> Result<(), ServoPartError> {
        let reference = name.as_str().to_owned();
        let about = PartDescription {
            name,
            title: String::new(),
            notes: String::new(),
            from: "capture".to_owned(),
            at: jiff::Timestamp::UNIX_EPOCH,
            simulated: false,
        };
        let enrolled = enrol_captured(scene, &about, &EnrolParams::default())?;
        let seen = enrolled.seen.as_ref();
        let surface = seen.and_then(|seen| surface_of(scene, seen));
        let part = surface.and_then(|surface| ScannedPart::new(reference, surface));
        let part = part.ok_or(ServoPartError::NotOrganised)?;
        self.library.references.push(enrolled.reference);
        self.parts.push(CellPart::Scanned(Arc::new(part)));
        Ok(())
    }
}

/// The surface through the readings of a part; `None` if the capture has no rows and columns.
fn surface_of(scene: &SceneCloud, seen: &SegmentedPart) -> Option<TriangleMesh> {
    let width = scene.cloud.grid?.width;
    let mut vertex_at = vec![None; scene.cloud.points.len()];
    for (vertex, index) in (0_u32..).zip(&seen.indices) {
        vertex_at[*index as usize] = Some(vertex);
    }
    let vertices = seen.cloud.points.clone();
    let mut triangles = Vec::new();
    for index in seen.indices.iter().map(|index| *index as usize) {
        if (index + 1).is_multiple_of(width) {
            continue;
        }
        let at = |index: usize| vertex_at.get(index).copied().flatten();
        let corners = [index, index + width, index + 1, index + width + 1].map(at);
        for [a, b, c] in [[0, 1, 2], [2, 1, 3]] {
            let (Some(a), Some(b), Some(c)) = (corners[a], corners[b], corners[c]) else {
                continue;
            };
            let depths = [a, b, c].map(|vertex| vertices[vertex as usize].z);
            let [least, most] =
                [f32::min, f32::max].map(|of| depths.into_iter().fold(depths[0], of));
            if most - least <= MAX_STEP_M {
                triangles.push([a, b, c]);
            }
        }
    }
    Some(TriangleMesh {
        vertices,
        triangles,
    })
}

/// What a set of runs shares.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ServoSuite {
    /// To the standard position or a recorded camera pose, noise once and three times a Kinect's, the calibration wrong by up
    /// to 20 mm and 2°.
    Camera,
    /// The same, and something goes wrong on the way.
    Disturbed,
    /// The nozzle to the start of a path, the calibration wrong by up to 1 mm and 0.1°.
    PathStart,
    /// The first runs of the first suite, in single moves.
    SingleMoves,
    /// The first runs of the second suite, in single moves.
    DisturbedSingleMoves,
}

impl ServoSuite {
    /// All suites.
    pub const ALL: [Self; 5] = [
        Self::Camera,
        Self::Disturbed,
        Self::PathStart,
        Self::SingleMoves,
        Self::DisturbedSingleMoves,
    ];

    /// True for runs in single moves.
    pub fn is_single(self) -> bool {
        matches!(self, Self::SingleMoves | Self::DisturbedSingleMoves)
    }

    /// The suite of the same runs in which poses are streamed.
    fn streamed(self) -> Self {
        match self {
            Self::SingleMoves => Self::Camera,
            Self::DisturbedSingleMoves => Self::Disturbed,
            suite => suite,
        }
    }

    /// Numbers of the runs of this suite that belong to these of the first. What is split stays whole.
    pub fn numbers(self, first: &Range<u64>) -> Range<u64> {
        let share = match self {
            Self::Camera => 1,
            Self::Disturbed | Self::SingleMoves => 2,
            Self::DisturbedSingleMoves => 4,
            Self::PathStart => 8,
        };
        first.start.div_ceil(share)..first.end.div_ceil(share)
    }
}

/// A run and its result.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ServoCase {
    /// The suite.
    pub suite: ServoSuite,
    /// Name of the part.
    pub part: String,
    /// The target.
    pub target: SimulatedTarget,
    /// The noise; 1 is a Kinect's.
    pub noise: f64,
    /// Delay of the verdicts, milliseconds.
    pub delay_ms: u64,
    /// What went wrong.
    pub disturbance: Disturbance,
    /// Seed of the run.
    pub seed: u64,
    /// The run; none if the arm reaches no start from which the camera sees the whole part.
    pub run: Option<ServoRun>,
}

/// The result of a run.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ServoRun {
    /// True if the servo says that the target is reached.
    pub is_done: bool,
    /// Why it stopped; none if the target is reached.
    pub stopped: Option<String>,
    /// The reason in words.
    pub why: Option<String>,
    /// True error at the start, millimetres and degrees.
    pub start: [f64; 2],
    /// True error at the end, millimetres and degrees.
    pub end: [f64; 2],
    /// The bounds that the servo gives, millimetres and degrees.
    pub bounds: Option<[f64; 2]>,
    /// Time from the first state of the arm to the end, seconds.
    pub took_s: f64,
    /// Number of frames.
    pub num_frames: usize,
    /// Number of single moves; 0 of a run that streams poses.
    pub num_moves: usize,
    /// True if what hung there at the end was the part.
    pub hangs: bool,
    /// The greatest speed, acceleration, angular speed and angular acceleration of the commanded poses, as shares of their
    /// limits.
    pub shares: [f64; 4],
    /// Farthest that a commanded pose left the work volume, metres.
    pub outside_m: f64,
    /// Least distance of tools from the part's surface, metres.
    pub least_distance_m: f64,
    /// By how much the true error exceeded that of the start, at most, millimetres.
    pub most_away_mm: f64,
    /// Number of steps at which the robot became faster although the last frame was none to move by.
    pub num_blind: usize,
    /// Number of commands that the arm could not follow.
    pub num_unreachable: usize,
}

impl ServoCase {
    /// True if the servo says that the target is reached.
    pub fn is_done(&self) -> bool {
        self.run.as_ref().is_some_and(|run| run.is_done)
    }
}

/// A true error beyond that of the start by which a run has diverged, millimetres.
const DIVERGED_MM: f64 = 100.0;
/// The longest single move.
const LONGEST_MOVE: PoseDelta = PoseDelta {
    shift: Metres(0.1),
    rotation: Radians(10.0 * std::f64::consts::PI / 180.0),
};
/// Rounding of differences between poses.
const ROUNDING: f64 = 1e-6;

impl ServoRun {
    /// True if the servo says that it is there, and it is not: by more than its tolerance, or because the part is gone.
    pub fn is_wrong(&self, params: &ServoParams) -> bool {
        let tolerance = &params.tolerance;
        let is_off =
            self.end[0] > tolerance.shift.mm() || self.end[1] > tolerance.rotation.degrees();
        self.is_done && (is_off || !self.hangs)
    }

    /// True if a limit was exceeded: of speed, acceleration or volume.
    pub fn is_beyond(&self) -> bool {
        self.shares.iter().any(|share| *share > 1.0 + ROUNDING) || self.outside_m > ROUNDING
    }

    /// True if the error grew instead of falling.
    pub fn has_diverged(&self) -> bool {
        self.most_away_mm > DIVERGED_MM
    }

    /// True if a tool touched the part.
    pub fn touches(&self) -> bool {
        self.least_distance_m <= 0.0
    }

    fn of(result: &RunResult, cell: &SimulatedCell<'_>, params: &ServoParams) -> Option<Self> {
        let [start, end] = result.errors()?;
        let figures = |error: &PoseDelta| [error.shift.mm(), error.rotation.degrees()];
        let (arrival, reason) = match &result.end {
            Step::Done(arrival) => (Some(arrival), None),
            Step::Stop(reason) => (None, Some(reason)),
            Step::Command(_) => (None, None),
        };
        let limits = &params.limits;
        let [speed, acceleration, turn_speed, turn_acceleration] = result.most();
        let volume = cell.fence.volume;
        let outside = result.samples.iter().flat_map(|sample| {
            let points = result.watched.iter();
            points.map(|point| {
                let point = sample.robot_from_flange * point;
                volume.map_or(0.0, |volume| volume.distance(&point))
            })
        });
        Some(Self {
            is_done: arrival.is_some(),
            stopped: reason.map(|reason| reason.kind().to_owned()),
            why: reason.map(ToString::to_string),
            start: figures(&start),
            end: figures(&end),
            bounds: arrival.map(|arrival| figures(&arrival.bounds)),
            took_s: result.samples.last()?.at.as_secs_f64(),
            num_frames: result.num_frames,
            num_moves: result.num_moves,
            hangs: result.hangs,
            shares: [
                speed / limits.speed,
                acceleration / limits.acceleration,
                turn_speed / limits.turn_speed,
                turn_acceleration / limits.turn_acceleration,
            ],
            outside_m: outside.fold(0.0, f64::max),
            least_distance_m: result.least_distance,
            most_away_mm: result.most_away().shift.mm(),
            num_blind: result.num_moved_blindly(),
            num_unreachable: result.num_unreachable,
        })
    }
}

/// Parameters of all runs: the defaults, with room for the way to a path.
pub fn servo_params() -> ServoParams {
    let mut params = ServoParams::default();
    params.max_error.shift = Metres(1.2);
    params
}

/// Makes the runs of a suite with these numbers, and calls `after_each` after every run. Runs share the processor's cores.
pub fn servo_cases(
    suite: ServoSuite,
    mut numbers: Range<u64>,
    first_seed: u64,
    parts: &ServoParts,
    after_each: impl Fn(),
) -> Vec<ServoCase> {
    let num_workers = num_cores();
    let mut cases = Vec::new();
    while !numbers.is_empty() {
        let first = numbers.start;
        let num = (numbers.end - first).min(4 * num_workers as u64) as usize;
        cases.extend(map_each(num, num_workers, |k| {
            case(suite, first + k as u64, first_seed, parts)
        }));
        for _ in 0..num {
            after_each();
        }
        numbers.start += num as u64;
    }
    cases
}

fn case(suite: ServoSuite, number: u64, first_seed: u64, parts: &ServoParts) -> ServoCase {
    let seed = first_seed + 100_000 * suite.streamed() as u64 + number;
    let setup = setup(suite.streamed(), number, seed, &parts.parts);
    let params = servo_params();
    let arranged = SimulatedCell::arrange(setup.clone(), &parts.library).ok();
    let done = arranged.and_then(|cell| {
        let result = if suite.is_single() {
            run_in_single_moves(&cell, &params, LONGEST_MOVE)
        } else {
            run(&cell, &params)
        };
        let result = result.ok()?;
        ServoRun::of(&result, &cell, &params)
    });
    ServoCase {
        suite,
        part: setup.part.name(),
        target: setup.target,
        noise: setup.noise,
        delay_ms: setup.delay.as_millis() as u64,
        disturbance: setup.disturbance,
        seed,
        run: done,
    }
}

fn setup(suite: ServoSuite, number: u64, seed: u64, parts: &[CellPart]) -> CellSetup {
    let mut random = Pcg64::seed_from_u64(seed);
    let num_parts = parts.len() as u64;
    let turn = number / num_parts;
    let disturbances = Disturbance::ALL;
    let (target, disturbance) = match suite {
        ServoSuite::PathStart => (SimulatedTarget::PathStart, Disturbance::None),
        ServoSuite::Disturbed => (
            SimulatedTarget::Standard,
            disturbances[number as usize % disturbances.len()],
        ),
        _ if (turn / 2).is_multiple_of(2) => (SimulatedTarget::Standard, Disturbance::None),
        _ => (SimulatedTarget::Recorded, Disturbance::None),
    };
    let hand_eye = match suite {
        ServoSuite::PathStart => HandEyeError {
            shift: Metres::from_mm(1.0),
            turn: Radians::from_degrees(0.1),
        },
        _ => HandEyeError {
            shift: Metres::from_mm(20.0),
            turn: Radians::from_degrees(2.0),
        },
    };
    CellSetup {
        part: parts[(number % num_parts) as usize].clone(),
        target,
        noise: if turn.is_multiple_of(2) { 1.0 } else { 3.0 },
        start: (Metres(0.25), Radians::from_degrees(25.0)),
        hand_eye,
        frame_period: Duration::from_millis(100),
        delay: Duration::from_millis(random.random_range(30..=200)),
        dynamics: ArmDynamics {
            delay: Duration::from_millis(random.random_range(12..=60)),
            ..ArmDynamics::default()
        },
        disturbance,
        seed,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inspection::fixtures::standard_library;
    use simulate::Side;
    use stages::fixtures::facing_part;

    const SEED: u64 = 3_000_000;

    fn standard() -> ServoParts {
        ServoParts {
            library: standard_library(),
            parts: PartKind::ALL.map(CellPart::Simulated).to_vec(),
        }
    }

    #[test]
    fn runs_end_near_their_targets_within_the_limits_and_are_the_same_again() {
        let parts = standard();
        let some = |numbers| servo_cases(ServoSuite::Camera, numbers, SEED, &parts, || ());
        let cases = some(0..4);
        let runs: Vec<&ServoRun> = cases.iter().filter_map(|case| case.run.as_ref()).collect();
        assert_eq!(runs.len(), 4);
        for run in &runs {
            assert!(run.is_done, "{run:?}");
            assert!(run.end[0] < 2.5 && run.end[1] < 0.25, "{run:?}");
            assert!(!run.is_beyond() && !run.has_diverged() && !run.touches());
            assert_eq!((run.num_blind, run.num_unreachable), (0, 0));
        }
        // Also by a process that makes no other.
        let of = |cases: &[ServoCase]| format!("{cases:?}");
        assert_eq!(of(&some(3..4)), of(&cases[3..4]));
    }

    #[test]
    fn what_several_processes_share_is_what_one_would_run() {
        for suite in ServoSuite::ALL {
            let whole = suite.numbers(&(0..100));
            let split = [0..33, 33..34, 34..100].map(|part| suite.numbers(&part));
            assert_eq!(
                split.into_iter().flatten().collect::<Vec<_>>(),
                whole.collect::<Vec<_>>()
            );
        }
    }

    #[test]
    fn in_single_moves_they_end_there_too() {
        let cases = servo_cases(ServoSuite::SingleMoves, 0..2, SEED, &standard(), || ());
        for case in &cases {
            let run = case.run.as_ref().expect("a start");
            assert!(run.is_done, "{case:?}");
            assert!(run.end[0] < 2.5 && run.end[1] < 0.25, "{case:?}");
            assert!((2..15).contains(&run.num_moves), "{case:?}");
            assert!(!run.is_beyond() && !run.has_diverged() && !run.touches());
            assert_eq!(run.num_unreachable, 0, "{case:?}");
        }
    }

    #[test]
    fn a_part_that_is_gone_or_another_stops_the_robot() {
        let parts = standard();
        // In single moves, without what only happens to the frames.
        let both = [
            (ServoSuite::Disturbed, Disturbance::ALL.len() as u64),
            (ServoSuite::DisturbedSingleMoves, 5),
        ];
        let cases = both.map(|(suite, num)| servo_cases(suite, 0..num, SEED, &parts, || ()));
        let params = servo_params();
        for case in cases.iter().flatten() {
            let run = case.run.as_ref().expect("a start");
            assert!(!run.is_wrong(&params), "{case:?}");
            assert!(!run.is_beyond(), "{case:?}");
            assert_eq!(run.num_blind, 0, "{case:?}");
            if !run.hangs || case.disturbance == Disturbance::Covered {
                assert!(run.stopped.is_some(), "{case:?}");
            }
        }
    }

    #[test]
    fn a_captured_part_hangs_in_the_cell_as_it_was_captured() {
        let mut parts = ServoParts {
            library: Library::default(),
            parts: Vec::new(),
        };
        let name = PartName::new("seen").expect("a name");
        let scene = facing_part(PartKind::Fender, Side::Left, 5);
        parts.add_captured(&scene, name).expect("a part");
        let cases = servo_cases(ServoSuite::Camera, 0..1, SEED, &parts, || ());
        let run = cases[0].run.as_ref().expect("a start");
        assert!(run.is_done && cases[0].part == "seen", "{cases:?}");
        assert!(run.end[0] < 2.5 && run.end[1] < 0.25, "{run:?}");
    }
}
