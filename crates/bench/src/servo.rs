//! Simulated runs of visual servoing: where they end, how long they take, why they stop, and whether limits are kept.
//!
//! Each run has a part, a start, a calibration error, a delay and a seed of its own. The figures are compared with the truth of
//! the simulation, which the servo does not know.

use std::time::Duration;

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use serde::Serialize;

use geometry::{
    parallel::{map_each, num_cores},
    rigid::PoseDelta,
    units::{Metres, Radians},
};
use inspection::library::Library;
use servo::{
    ServoParams, Step,
    simulated::{
        ArmDynamics, CellSetup, Disturbance, HandEyeError, RunResult, SimulatedCell,
        SimulatedTarget, run, run_in_single_moves,
    },
};
use simulate::PartKind;

/// What a set of runs shares.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
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

    /// Number of runs of this suite for this number of runs of the first.
    pub fn num_runs(self, num_runs: usize) -> usize {
        match self {
            Self::Camera => num_runs,
            Self::Disturbed | Self::SingleMoves => num_runs.div_ceil(2),
            Self::DisturbedSingleMoves => num_runs.div_ceil(4),
            Self::PathStart => num_runs.div_ceil(8),
        }
    }
}

/// A run and its result.
#[derive(Clone, Debug, Serialize)]
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
#[derive(Clone, Debug, Serialize)]
pub struct ServoRun {
    /// True if the servo says that the target is reached.
    pub is_done: bool,
    /// Why it stopped; none if the target is reached.
    pub stopped: Option<&'static str>,
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
            stopped: reason.map(servo::StopReason::kind),
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

/// Runs a suite, and calls `after_each` after every run. Runs share the processor's cores.
pub fn servo_cases(
    suite: ServoSuite,
    num_runs: usize,
    first_seed: u64,
    library: &Library,
    after_each: impl Fn(),
) -> Vec<ServoCase> {
    let num_workers = num_cores();
    let mut cases = Vec::with_capacity(num_runs);
    while cases.len() < num_runs {
        let first = cases.len();
        let num = (num_runs - first).min(4 * num_workers);
        cases.extend(map_each(num, num_workers, |k| {
            case(suite, (first + k) as u64, first_seed, library)
        }));
        (0..num).for_each(|_| after_each());
    }
    cases
}

fn case(suite: ServoSuite, number: u64, first_seed: u64, library: &Library) -> ServoCase {
    let seed = first_seed + 100_000 * suite.streamed() as u64 + number;
    let setup = setup(suite.streamed(), number, seed);
    let params = servo_params();
    let arranged = SimulatedCell::arrange(setup, library).ok();
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
        part: setup.kind.name().to_owned(),
        target: setup.target,
        noise: setup.noise,
        delay_ms: setup.delay.as_millis() as u64,
        disturbance: setup.disturbance,
        seed,
        run: done,
    }
}

fn setup(suite: ServoSuite, number: u64, seed: u64) -> CellSetup {
    let mut random = Pcg64::seed_from_u64(seed);
    let kinds = PartKind::ALL;
    let turn = number / kinds.len() as u64;
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
        kind: kinds[number as usize % kinds.len()],
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

    #[test]
    fn runs_end_near_their_targets_within_the_limits_and_are_the_same_again() {
        let library = standard_library();
        let some = |num| servo_cases(ServoSuite::Camera, num, 3_000_000, &library, || ());
        let cases = some(4);
        let runs: Vec<&ServoRun> = cases.iter().filter_map(|case| case.run.as_ref()).collect();
        assert_eq!(runs.len(), 4);
        for run in &runs {
            assert!(run.is_done, "{run:?}");
            assert!(run.end[0] < 2.5 && run.end[1] < 0.25, "{run:?}");
            assert!(!run.is_beyond() && !run.has_diverged() && !run.touches());
            assert_eq!((run.num_blind, run.num_unreachable), (0, 0));
        }
        let of = |cases: &[ServoCase]| format!("{cases:?}");
        assert_eq!(of(&some(1)), of(&cases[..1]));
    }

    #[test]
    fn in_single_moves_they_end_there_too() {
        let library = standard_library();
        let cases = servo_cases(ServoSuite::SingleMoves, 2, 3_000_000, &library, || ());
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
        let library = standard_library();
        // In single moves, without what only happens to the frames.
        let both = [
            (ServoSuite::Disturbed, Disturbance::ALL.len()),
            (ServoSuite::DisturbedSingleMoves, 5),
        ];
        let cases = both.map(|(suite, num)| servo_cases(suite, num, 3_000_000, &library, || ()));
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
}
