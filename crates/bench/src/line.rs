//! Simulated lines: parts that pass the camera, an encoder that slips or not, and the poses at later counts.
//!
//! Each line is calibrated from frames of its first part, as `partsight calibrate line` does, and then followed as `serve`
//! does: with whatever frames the computer finds the time for. The truth of the simulation is compared with what the tracker
//! says at a count that comes later; the tracker does not know it.

use std::time::Duration;

use nalgebra::Point3;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use serde::Serialize;

use geometry::{
    parallel::{map_each, num_cores},
    rigid::{RigidTransform, pose_error},
    units::Metres,
};
use inspection::{
    library::{Library, enrolment_pose},
    pipeline::{Inspection, Recipe, Unwatched, run_all},
};
use robot::line::{CountedPose, Counter, LineCalibration, LineFitError, OnLine, fit};
use simulate::{LineEncoder, LineSetup, PartKind, SensorNoise, SimulatedLine};
use stages::scene::scene_from_frame;
use station::{CountLog, LinePose, LineTracker};

/// A line and what became of its parts.
#[derive(Clone, Debug, Serialize)]
pub struct LineCase {
    /// The line.
    pub setup: LineSetup,
    /// Frames per second of the camera.
    pub frames_per_second: f64,
    /// True if the tracker got counts.
    pub is_counted: bool,
    /// Why the line could not be calibrated.
    pub not_calibrated: Option<String>,
    /// The angle between the calibrated direction and the true one, degrees.
    pub direction_off: f64,
    /// The error of the calibrated scale, as a share.
    pub scale_off: f64,
    /// The parts.
    pub parts: Vec<LinePartCase>,
    /// Numbers that were given to no part of the line.
    pub num_surplus: usize,
    /// Number of frames that were inspected.
    pub num_inspected: usize,
}

/// A part that passed.
#[derive(Clone, Debug, Default, Serialize)]
pub struct LinePartCase {
    /// Its name.
    pub part: String,
    /// True if it swung.
    pub swings: bool,
    /// How often it was given a number.
    pub num_numbers: usize,
    /// How often it was recorded without one, as it left.
    pub num_refused: usize,
    /// True if it was given another part's name.
    pub is_misnamed: bool,
    /// Time from the first frame that shows all of it until it had its number, seconds.
    pub took_s: Option<f64>,
    /// The pose at later counts.
    pub later: Vec<LaterPose>,
}

/// The pose of a part at a count that came later than the frame.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct LaterPose {
    /// How much later, seconds.
    pub seconds: f64,
    /// Error of the part's middle and its bound, millimetres.
    pub off_mm: f64,
    /// 95 % bound of it, millimetres.
    pub bound_mm: f64,
    /// Error of the rotation, degrees.
    pub turn_off: f64,
    /// 95 % bound of it, degrees.
    pub turn_bound: f64,
}

impl LaterPose {
    /// True if it is no farther off than its bound.
    pub fn holds(&self) -> bool {
        self.off_mm <= self.bound_mm
    }
}

/// Speeds of the lines, m/s.
pub const SPEEDS: [f64; 5] = [0.1, 0.3, 0.2, 0.05, 0.02];
/// How much later than its number the pose of a part is asked for, seconds.
pub const LATER_S: [f64; 2] = [1.0, 3.0];
/// Parts of each line.
pub const PARTS_PER_LINE: usize = 10;
/// Frames to calibrate a line by.
const NUM_CALIBRATION_FRAMES: usize = 14;
/// Least and greatest time from one inspection to the next: what a small computer needs for three parts, and a slow line.
const PERIODS_S: (f64, f64) = (0.3, 0.8);
/// Way of the line from one inspection to the next, metres, between those times.
const WAY_PER_INSPECTION_M: f64 = 0.03;
/// Time from one count that the controller sends to the next, seconds.
const COUNT_PERIOD_S: f64 = 0.25;
/// What an encoder that slips may lose, as a share of the way.
const SLIP: f64 = 0.01;

/// The setup of line number `number`: speeds, frame rates, encoders and noise in turn.
fn setup(number: u64, seed: u64) -> (LineSetup, f64, bool) {
    let mut random = Pcg64::seed_from_u64(seed);
    let speed = SPEEDS[number as usize % SPEEDS.len()];
    let turn = number / SPEEDS.len() as u64;
    let setup = LineSetup {
        speed,
        variation: random.random_range(0.0..0.1),
        swinging_every: 5,
        encoder: LineEncoder {
            way_per_count: Metres(random.random_range(0.00005..0.0003)),
            slip: if turn % 2 == 1 { SLIP } else { 0.0 },
        },
        seed,
        ..LineSetup::default()
    };
    (setup, random.random_range(10.0..=30.0), turn % 4 != 3)
}

/// Runs so many lines, and calls `after_each` after every one. They share the processor's cores.
pub fn line_cases(
    num_lines: usize,
    first_seed: u64,
    library: &Library,
    after_each: impl Fn(),
) -> Vec<LineCase> {
    let num_workers = num_cores();
    let mut cases = Vec::with_capacity(num_lines);
    while cases.len() < num_lines {
        let first = cases.len();
        let num = (num_lines - first).min(num_workers);
        cases.extend(map_each(num, num_workers, |k| {
            let number = (first + k) as u64;
            let (setup, frames_per_second, is_counted) = setup(number, first_seed + number);
            line_case(
                setup,
                PARTS_PER_LINE,
                frames_per_second,
                is_counted,
                library,
            )
        }));
        for _ in 0..num {
            after_each();
        }
    }
    cases
}

/// A line that is watched.
struct Watched<'a> {
    line: SimulatedLine,
    setup: LineSetup,
    library: &'a Library,
    recipe: Recipe,
}

impl Watched<'_> {
    fn inspected(&self, seconds: f64) -> Vec<Inspection> {
        let noise = SensorNoise::kinect(self.setup.seed ^ seconds.to_bits());
        let frame = self.line.frame(seconds, &noise);
        run_all(
            &scene_from_frame(&frame),
            self.library,
            &self.recipe,
            &Unwatched,
        )
        .expect("not cancelled")
    }

    /// Calibrates the line by frames of its first part.
    fn calibrated(&self) -> Result<LineCalibration, LineFitError> {
        let clear = self.clear_way(0);
        let mut poses = Vec::new();
        let mut middle = Point3::origin();
        for k in 0..NUM_CALIBRATION_FRAMES {
            let share = (k as f64 + 0.5) / NUM_CALIBRATION_FRAMES as f64;
            let seconds = self.line.seconds_at(clear.0 + share * (clear.1 - clear.0));
            let kind = self.kind_of(0);
            let found = self.inspected(seconds);
            let seen = found
                .iter()
                .find(|one| one.verdict.is_accepted() && one.verdict.guess() == Some(kind.name()));
            let Some((seen, pose)) = seen.and_then(|seen| Some((seen, seen.found_pose()?))) else {
                continue;
            };
            middle = seen.middle(self.library).unwrap_or(middle);
            poses.push(CountedPose {
                name: format!("frame at {seconds:.2} s"),
                count: self.line.count(seconds),
                camera_from_part: pose.camera_from_part(),
                bound: pose.bounds().map(|bounds| bounds.shift),
            });
        }
        let mut line = fit(&poses, &middle, Counter::Bits32)?;
        line.exposure = self.setup.readout;
        line.slip = line.slip.max(self.setup.encoder.slip);
        Ok(line)
    }

    fn kind_of(&self, number: u64) -> PartKind {
        self.line.kind_of(number)
    }

    /// The ways of the line at which a part has just come in whole, and is about to leave, metres.
    fn clear_way(&self, number: u64) -> (f64, f64) {
        let start = self.line.way_to(number);
        let is_clear = |way: f64| {
            let parts = self.line.parts(self.line.seconds_at(way));
            let part = parts.iter().find(|part| part.number == number);
            part.is_some_and(|part| part.fully_visible)
        };
        let steps = |sign: f64| {
            let ways = (0..300).map(|k| start + sign * 0.01 * f64::from(k));
            ways.take_while(|way| is_clear(*way))
                .last()
                .unwrap_or(start)
        };
        (steps(-1.0), steps(1.0))
    }
}

fn line_case(
    setup: LineSetup,
    num_parts: usize,
    frames_per_second: f64,
    is_counted: bool,
    library: &Library,
) -> LineCase {
    let mut recipe = Recipe::default();
    recipe.segment.max_parts = 3;
    let watched = Watched {
        line: SimulatedLine::arrange(&setup),
        setup,
        library,
        recipe,
    };
    let mut case = LineCase {
        setup,
        frames_per_second,
        is_counted,
        not_calibrated: None,
        direction_off: 0.0,
        scale_off: 0.0,
        parts: Vec::new(),
        num_surplus: 0,
        num_inspected: 0,
    };
    match watched.calibrated() {
        Ok(line) => {
            let direction = watched.line.direction();
            case.direction_off = line.direction.angle(&direction).to_degrees();
            case.scale_off = line.way_per_count.0 / setup.encoder.way_per_count.0 - 1.0;
            case.follow(&watched, line, num_parts);
        }
        Err(why) => case.not_calibrated = Some(why.to_string()),
    }
    case
}

impl LineCase {
    fn follow(&mut self, watched: &Watched<'_>, line: LineCalibration, num_parts: usize) {
        let clear: Vec<(f64, f64)> = (0..num_parts as u64)
            .map(|number| watched.clear_way(number))
            .collect();
        self.parts = (0..num_parts as u64)
            .map(|number| LinePartCase {
                part: watched.kind_of(number).name().to_owned(),
                swings: watched.line.swings(number),
                ..LinePartCase::default()
            })
            .collect();
        let mut counts = CountLog::new(line.counter);
        let mut tracker = LineTracker::new(line);
        let speed = self.setup.speed;
        let period = (WAY_PER_INSPECTION_M / speed).clamp(PERIODS_S.0, PERIODS_S.1);
        // Whole frames of the camera.
        let period = (period * self.frames_per_second).ceil() / self.frames_per_second;
        let start = watched.line.seconds_at(clear[0].0 - 0.3);
        let end = watched.line.seconds_at(clear[num_parts - 1].1 + 0.2);
        let mut sent = start;
        let mut now = start;
        while now < end {
            while self.is_counted && sent <= now {
                counts.read(Duration::from_secs_f64(sent), watched.line.count(sent));
                sent += COUNT_PERIOD_S;
            }
            let mut found = watched.inspected(now);
            self.num_inspected += 1;
            let moment = counts.moment(Duration::from_secs_f64(now), None);
            let middle_of = |one: &Inspection| one.middle(watched.library);
            let places: Vec<Option<u64>> = (found.iter())
                .map(|one| number_of(watched, one, now))
                .collect();
            let (followed, recorded) =
                tracker.see(moment, &mut found, middle_of, |index, _, on_line| {
                    (places[index], on_line)
                });
            self.record(&recorded);
            for (index, followed) in followed.iter().enumerate() {
                let Some((pose, number)) = followed.pose.as_ref().zip(places[index]) else {
                    continue;
                };
                let part = self.parts.get_mut(number as usize);
                let Some(part) = part.filter(|_| followed.is_new) else {
                    continue;
                };
                part.is_misnamed = found[index].verdict.guess() != Some(part.part.as_str());
                let came_in = watched.line.seconds_at(clear[number as usize].0);
                // The inspection itself takes up to a period.
                part.took_s = Some(now + PERIODS_S.0 - came_in.max(start));
                let middle = found[index].middle(watched.library);
                let middle = middle.unwrap_or_else(Point3::origin);
                part.later = LATER_S
                    .into_iter()
                    .map(|seconds| later(watched, pose, number, seconds, &middle, tracker.line()))
                    .collect();
            }
            now += period;
        }
        let left = tracker.end();
        self.record(&left);
    }

    /// Counts what was recorded of each part.
    fn record(&mut self, recorded: &[(Option<u64>, Option<OnLine>)]) {
        for (at, on_line) in recorded {
            let part = at.and_then(|at| self.parts.get_mut(at as usize));
            match (part, at) {
                (Some(part), _) if on_line.is_some() => part.num_numbers += 1,
                (Some(part), _) => part.num_refused += 1,
                // A part beyond those that count.
                (None, Some(_)) => {}
                (None, None) => self.num_surplus += 1,
            }
        }
    }
}

/// The number of the part that an inspection is of, by its true place.
fn number_of(watched: &Watched<'_>, inspection: &Inspection, seconds: f64) -> Option<u64> {
    let readings = inspection
        .readings()
        .filter(|readings| !readings.is_empty())?;
    let sum: nalgebra::Vector3<f64> = readings.iter().map(|p| p.coords.cast::<f64>()).sum();
    let middle = sum / readings.len() as f64;
    let parts = watched.line.parts(seconds);
    let distance = |pose: &RigidTransform| (pose.translation.vector - middle).norm();
    let near = parts
        .iter()
        .map(|part| (distance(&part.camera_from_part), part.number));
    let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (nearest.0 < 0.5).then_some(nearest.1)
}

/// The pose at a count that comes later, beside the truth.
fn later(
    watched: &Watched<'_>,
    pose: &LinePose,
    number: u64,
    seconds: f64,
    middle: &Point3<f64>,
    line: &LineCalibration,
) -> LaterPose {
    let then = pose.moment.at.as_secs_f64() + seconds;
    let count = watched.line.count(then) as f64;
    let (found, bounds) = pose
        .at_count(count, line)
        .unwrap_or_else(|| pose.after(seconds, line));
    let truth = watched.line.pose_of(number, then) * enrolment_pose().inverse();
    let off = pose_error(&found, &truth, middle);
    LaterPose {
        seconds,
        off_mm: off.shift.mm(),
        bound_mm: bounds.shift.mm(),
        turn_off: off.rotation.degrees(),
        turn_bound: bounds.turn.degrees(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inspection::fixtures::standard_library;

    #[test]
    fn every_part_of_a_line_has_one_number_and_its_pose_later_is_within_its_bound() {
        let library = standard_library();
        let setup = LineSetup {
            speed: 0.2,
            swinging_every: 5,
            seed: 3_000_007,
            ..LineSetup::default()
        };
        // The last of them swings.
        let num_parts = setup.swinging_every as usize;
        let case = line_case(setup, num_parts, 15.0, true, &library);
        assert_eq!(case.not_calibrated, None);
        assert_eq!(case.parts.iter().filter(|part| part.swings).count(), 1);
        // A refused row of something that is no part, such as a piece of one at the edge.
        assert!(case.num_surplus <= 1, "{case:?}");
        let mut num_off = 0;
        for part in &case.parts {
            if part.swings {
                assert_eq!((part.num_numbers, part.num_refused), (0, 1), "{part:?}");
            } else {
                assert_eq!((part.num_numbers, part.num_refused), (1, 0), "{part:?}");
                num_off += part.later.iter().filter(|later| !later.holds()).count();
            }
            assert!(!part.is_misnamed, "{part:?}");
        }
        assert!(num_off <= 1, "{case:?}");
    }
}
