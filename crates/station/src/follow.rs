//! The parts that hang before a followed camera, side by side or one after the other: one inspection of each is recorded and
//! published.

use std::{mem, sync::Arc, time::Duration};

use jiff::Timestamp;
use nalgebra::Point3;

use inspection::pipeline::{
    Inspection, Recipe, Verdict,
    live::{
        FrameRole, HungFrame, InspectionRate, LiveParams, LiveTracker, LiveVerdict, MotionState,
        SceneMotion, SteadyParams, nothing_there, refuse_moving, refuse_unless_again,
    },
};
use records::history::{HungId, HungSpots, NewEntry};
use stages::scene::SceneCloud;

/// Follows one camera whose every frame is shown with its own verdicts. `E` is what is recorded of a part.
pub struct PartFollower<E = NewEntry> {
    tracker: LiveTracker,
    spots: HungSpots<E>,
    at: Duration,
    /// Number of the last frame.
    number: u64,
    /// The verdicts of the last frame by itself.
    own: Vec<Verdict>,
    /// The entries held for parts that may leave before their verdicts count.
    held: Vec<HeldFrame>,
}

/// An inspected frame of a followed camera.
#[derive(Clone, Copy)]
pub struct SeenFrame<'a> {
    /// The scene that was inspected.
    pub scene: &'a SceneCloud,
    /// The camera's time, from any origin.
    pub at: Duration,
    /// Its number, counted by the source.
    pub number: u64,
    /// Identifies the recipe and the library.
    pub inputs: &'a str,
}

/// What a frame shows at a spot.
pub struct SeenPart {
    /// The inspection, with the verdict of all frames.
    pub inspection: Inspection,
    /// Middle of the named part, part space, metres.
    pub middle: Option<Point3<f64>>,
    /// Where it is; `None` of an independent capture, and for what is no part of its own.
    pub spot: Option<usize>,
    /// The verdict so far.
    pub verdict: LiveVerdict,
    /// What the frame is to the part.
    pub role: FrameRole,
}

impl SeenPart {
    /// A part of an independent capture, or one that is not judged yet.
    pub fn alone(inspection: Inspection, middle: Option<Point3<f64>>) -> Self {
        Self {
            inspection,
            middle,
            spot: None,
            verdict: LiveVerdict::Open,
            role: FrameRole::Nothing,
        }
    }

    /// True if it is a part whose verdict does not count yet.
    fn is_waiting(&self) -> bool {
        let shows_part = matches!(self.inspection.verdict, Verdict::Part { .. });
        shows_part && self.spot.is_some() && self.verdict.counted().is_none()
    }

    /// Of a part that hangs still, but of which too few frames were inspected, says that the computer is too slow: what single
    /// frames say is no verdict, good or bad.
    fn refuse_as_too_slow(&mut self, rate: InspectionRate) {
        let is_still = matches!(self.verdict, LiveVerdict::Gathering { .. });
        if !is_still || self.inspection.verdict.is_unknown() {
            return;
        }
        if let Verdict::Part { part, rejected, .. } = &mut self.inspection.verdict {
            *rejected = Some(rate.refusal(part.clone()));
        }
    }
}

impl<'a> SeenFrame<'a> {
    /// What the frame shows of a part, for [`HungSpots::see`].
    pub fn of(&self, part: &'a SeenPart) -> HungFrame<'a> {
        HungFrame {
            scene: self.scene,
            at: self.at,
            inspection: &part.inspection,
            verdict: &part.verdict,
            middle: part.middle,
            inputs: self.inputs,
        }
    }

    /// Judges what the frame shows at every spot, by the frames so far. `found` is what
    /// [`run_all`](inspection::pipeline::run_all) found, with the frame's own verdicts. Returns it in that order, and the spots
    /// at which the frame shows nothing. Pass each that has a spot to [`HungSpots::see`] then.
    pub fn judge<E>(
        &self,
        found: Vec<Inspection>,
        tracker: &mut LiveTracker,
        spots: &mut HungSpots<E>,
        recipe: &Recipe,
        middle: impl Fn(&Inspection) -> Option<Point3<f64>>,
    ) -> (Vec<SeenPart>, Vec<SeenPart>) {
        let at_spots = spots.of_frame(&found, self.scene, tracker.stillness(), recipe);
        let new = |inspection| {
            let middle = middle(&inspection);
            SeenPart::alone(inspection, middle)
        };
        let mut parts: Vec<SeenPart> = found.into_iter().map(new).collect();
        let mut absent = Vec::new();
        for (spot, index) in at_spots.into_iter().enumerate() {
            let part = if let Some(index) = index {
                &mut parts[index]
            } else {
                absent.push(new(nothing_there()));
                absent.last_mut().expect("just added")
            };
            part.spot = Some(spot);
            part.verdict = tracker.judge(spot, &mut part.inspection, part.middle, &recipe.accept);
            part.role = spots.role_of(spot, &self.of(part));
        }
        // What moves is not held up by the computer.
        let is_moving = tracker.stillness() == MotionState::Moving;
        let waits = !is_moving && parts.iter().any(SeenPart::is_waiting);
        tracker.judged(self.number, waits);
        if let Some(rate) = tracker.slow() {
            for part in &mut parts {
                part.refuse_as_too_slow(rate);
            }
        }
        (parts, absent)
    }
}

/// The frame whose entry is held for the part at a spot.
struct HeldFrame {
    spot: usize,
    /// Its time, and the index of the part in it.
    shows: (Duration, usize),
}

impl<E> Default for PartFollower<E> {
    fn default() -> Self {
        Self {
            tracker: LiveTracker::new(&LiveParams::default()),
            spots: HungSpots::default(),
            at: Duration::ZERO,
            number: 0,
            own: Vec::new(),
            held: Vec::new(),
        }
    }
}

impl<E> PartFollower<E> {
    /// Takes in a frame, and returns the scene to inspect. `number` is counted by the source. `watched` is what a
    /// [`MotionWatch`](super::MotionWatch) knows after it; without one, call this for every frame.
    pub fn look(
        &mut self,
        scene: Arc<SceneCloud>,
        taken_at: Timestamp,
        number: u64,
        watched: Option<SceneMotion>,
    ) -> Arc<SceneCloud> {
        self.at = Duration::try_from(taken_at.as_duration()).unwrap_or_default();
        self.number = number;
        self.own.clear();
        self.tracker.look(scene, self.at, watched)
    }

    /// The rate, if a verdict has waited two seconds or longer because fewer than half of the camera's frames are inspected.
    pub fn held_up_by(&self) -> Option<InspectionRate> {
        self.tracker.held_up_by()
    }

    /// Refuses the parts of the frame's own inspection, in the order of [`run_all`](inspection::pipeline::run_all), if they move.
    pub fn refuse_if_moving(&mut self, found: &mut [Inspection]) {
        self.own = found.iter().map(|part| part.verdict.clone()).collect();
        for part in found {
            self.refuse(part);
        }
    }

    fn refuse(&self, inspection: &mut Inspection) {
        if self.tracker.stillness() == MotionState::Moving {
            refuse_moving(inspection);
        }
    }

    /// Time of the last frame, by the camera.
    pub fn at(&self) -> Duration {
        self.at
    }

    /// Decides about an accepted part of a frame taken `at`, this one or an earlier one, and refuses it unless it hung
    /// still. Returns false if that is not known yet: while the source has just begun, it takes a frame as long after that one
    /// as [`SteadyParams::settle`]. `last` are the inspections of the last frame by itself, at least one, `middle` the middle of
    /// the part, part space, metres.
    pub fn settle(
        &self,
        inspection: &mut Inspection,
        at: Duration,
        last: &[Inspection],
        middle: Option<Point3<f64>>,
    ) -> bool {
        match self.tracker.stillness() {
            MotionState::Steady { since, .. } if since <= at => {}
            MotionState::Steady { .. } | MotionState::Moving => refuse_moving(inspection),
            MotionState::Watching if self.at < at + SteadyParams::default().settle => return false,
            MotionState::Watching => refuse_unless_again(inspection, last, middle),
        }
        true
    }

    /// Returns what to record now, after [`Self::refuse_if_moving`] for the same frame and [`Self::settle`] for those before
    /// it. The verdict that counts is formed from several frames; for a part that leaves before, the frame that shows it best
    /// is recorded with its own verdict, see [`Self::settled`]. `middle` gives the middle of the named part, part space, metres.
    /// `entry` also gets whether the part is known to have hung still.
    pub fn take(
        &mut self,
        scene: &SceneCloud,
        mut found: Vec<Inspection>,
        middle: impl Fn(&Inspection) -> Option<Point3<f64>>,
        recipe: &Recipe,
        entry: impl Fn(&Inspection, HungId, bool) -> E,
    ) -> Vec<E> {
        // Frames are counted by their own verdicts.
        let own = mem::take(&mut self.own);
        for (part, own) in found.iter_mut().zip(&own) {
            part.verdict.clone_from(own);
        }
        let frame = SeenFrame {
            scene,
            at: self.at,
            number: self.number,
            // Recipe and library do not change between frames.
            inputs: "",
        };
        let (parts, absent) =
            frame.judge(found, &mut self.tracker, &mut self.spots, recipe, middle);
        let of_frame = parts
            .into_iter()
            .enumerate()
            .map(|(index, part)| (Some(index), part));
        let mut parts: Vec<_> = of_frame
            .chain(absent.into_iter().map(|part| (None, part)))
            .collect();
        parts.sort_by_key(|(_, part)| part.spot);
        let mut recorded = Vec::new();
        for (index, mut part) in parts {
            let Some(spot) = part.spot else { continue };
            let (left, role) = self.spots.see(spot, &frame.of(&part));
            recorded.extend(left);
            let id = self.spots.at(spot).id().clone();
            match (role, index) {
                (FrameRole::Nothing, _) | (FrameRole::Best, None) => {}
                (FrameRole::Best, Some(index)) => {
                    self.held.retain(|held| held.spot != spot);
                    // Of a part that hangs still, too few frames were inspected so far, and its verdict says so.
                    let is_still = matches!(part.verdict, LiveVerdict::Gathering { .. });
                    if !is_still {
                        part.inspection.verdict.clone_from(&own[index]);
                        self.refuse(&mut part.inspection);
                        let shows = (self.at, index);
                        self.held.push(HeldFrame { spot, shows });
                    }
                    let entry = entry(&part.inspection, id, is_still);
                    self.spots.at(spot).hold(entry);
                }
                (FrameRole::First | FrameRole::Again, _) => {
                    recorded.push(entry(&part.inspection, id, true));
                }
            }
        }
        recorded
    }

    /// The verdicts of the frame of this time are settled: if that frame is recorded, should one of its parts leave before a
    /// verdict counts, it is recorded with that verdict. `entry` gets the index of the part in the frame.
    pub fn settled(&mut self, at: Duration, entry: impl Fn(usize, HungId) -> E) {
        for HeldFrame { spot, shows } in &self.held {
            let rows = self.spots.at(*spot);
            if shows.0 == at && rows.is_holding() {
                rows.hold(entry(shows.1, rows.id().clone()));
            }
        }
    }

    /// Ends the source. Returns what is still to be recorded.
    pub fn end(mut self) -> Vec<E> {
        self.spots.end()
    }
}

#[cfg(test)]
mod tests {
    use std::{f64::consts::TAU, slice};

    use jiff::SignedDuration;

    use super::*;
    use capture::{CellScene, SimulatedCell, SimulatedSpec};
    use geometry::rigid::RigidTransform;
    use inspection::{
        fixtures::shipped_library,
        pipeline::{Rejection, Unwatched, live::MotionDetector, run, run_all},
    };
    use simulate::{
        PartKind, RackKind, RackSetup, SensorNoise, StandingRack, fixtures::HangingPart,
    };
    use stages::scene::{scene_from_frame, scene_from_image};

    #[test]
    fn a_frame_of_a_part_that_swings_in_is_refused_and_one_of_a_part_at_rest_is_not() {
        let mut cell = SimulatedCell::new(SimulatedSpec {
            scene: CellScene::Line { every: 6.0 },
            frames_per_second: 15.0,
            ..SimulatedSpec::default()
        });
        let mut scene_at = |number: u64| Arc::new(scene_from_image(cell.frame(number).0));
        let recipe = Recipe::default();
        let seen = run(&scene_at(46), &shipped_library(), &recipe, &Unwatched);
        let seen = seen.expect("not cancelled");
        assert!(seen.verdict.is_accepted());
        let mut followed = PartFollower::default();
        let mut kept = Vec::new();
        for number in 1..=73_u64 {
            let scene = scene_at(number);
            let seconds = (number - 1) as f64 / 15.0;
            let taken_at = Timestamp::UNIX_EPOCH + SignedDuration::from_secs_f64(seconds);
            let scene = followed.look(scene, taken_at, number, None);
            // As if every frame by itself were accepted.
            let mut inspection = seen.clone();
            followed.refuse_if_moving(slice::from_mut(&mut inspection));
            let is_accepted = inspection.verdict.is_accepted();
            match seconds {
                // It comes in, and then swings by less and less.
                0.4..2.0 => assert!(!is_accepted, "after {seconds} s"),
                4.4.. => assert!(is_accepted, "after {seconds} s"),
                _ => {}
            }
            let entry =
                |inspection: &Inspection, _, is_still| (inspection.verdict.is_accepted(), is_still);
            let entries = followed.take(&scene, vec![inspection], |_| None, &recipe, entry);
            kept.extend(entries.into_iter().map(|entry| (seconds, entry)));
        }
        // One verdict that counts, formed at rest from frames by their own verdicts.
        let [(seconds, entry)] = kept[..] else {
            panic!("{kept:?}");
        };
        assert!(seconds > 2.0 && entry == (true, true), "{kept:?}");
    }

    #[test]
    fn a_part_that_leaves_before_its_verdict_counts_is_recorded_with_the_verdict_of_its_frame() {
        let mut cell = SimulatedCell::new(SimulatedSpec {
            scene: CellScene::Part(PartKind::Fender),
            frames_per_second: 10.0,
            ..SimulatedSpec::default()
        });
        let recipe = Recipe::default();
        let library = shipped_library();
        let mut followed = PartFollower::default();
        let entry =
            |inspection: &Inspection, _, is_still| (inspection.verdict.is_accepted(), is_still);
        let mut frames = Vec::new();
        for number in 1..=3_u64 {
            let scene = Arc::new(scene_from_image(cell.frame(number).0));
            let seconds = number as f64 / 10.0;
            let taken_at = Timestamp::UNIX_EPOCH + SignedDuration::from_secs_f64(seconds);
            let scene = followed.look(scene, taken_at, number, None);
            let mut inspection = run(&scene, &library, &recipe, &Unwatched).expect("run");
            followed.refuse_if_moving(slice::from_mut(&mut inspection));
            assert!(inspection.verdict.is_accepted());
            let taken = followed.take(&scene, vec![inspection.clone()], |_| None, &recipe, entry);
            assert_eq!(taken, [], "too early to tell");
            frames.push((followed.at(), inspection));
        }
        // The source ends here: whoever shows the frames refuses them, and one of them is recorded.
        for (at, mut inspection) in frames {
            refuse_moving(&mut inspection);
            followed.settled(at, |_, hung| entry(&inspection, hung, false));
        }
        assert_eq!(followed.end(), [(false, false)]);
    }

    /// What is recorded of a part, and after how many seconds.
    type Row = (f64, String, bool, HungId);

    /// Follows frames at ten a second, of which one in `step` is inspected.
    fn rows_of(
        max_parts: usize,
        step: u64,
        num: u64,
        frame: impl FnMut(u64) -> Arc<SceneCloud>,
    ) -> Vec<Row> {
        rows_at(10.0, max_parts, step, num, frame)
    }

    /// The same at this many frames a second.
    fn rows_at(
        rate: f64,
        max_parts: usize,
        step: u64,
        num: u64,
        frame: impl FnMut(u64) -> Arc<SceneCloud>,
    ) -> Vec<Row> {
        let entry = |seconds: f64, inspection: &Inspection, hung, is_still| {
            let verdict = &inspection.verdict;
            let name = verdict.guess().unwrap_or_default().to_owned();
            (seconds, name, is_still && verdict.is_accepted(), hung)
        };
        let rows = followed_at(rate, max_parts, step, num, frame, entry);
        let mut ids: Vec<&HungId> = rows.iter().map(|(.., hung)| hung).collect();
        ids.sort();
        ids.dedup();
        assert_eq!(ids.len(), rows.len(), "each is another part: {rows:?}");
        rows
    }

    /// What is recorded, as `entry` of the seconds gives it. All frames are watched for motion.
    fn followed_at<E>(
        rate: f64,
        max_parts: usize,
        step: u64,
        num: u64,
        mut frame: impl FnMut(u64) -> Arc<SceneCloud>,
        entry: impl Fn(f64, &Inspection, HungId, bool) -> E,
    ) -> Vec<E> {
        let (library, mut recipe) = (shipped_library(), Recipe::default());
        recipe.segment.max_parts = max_parts;
        let mut followed = PartFollower::default();
        let mut detector = MotionDetector::new(SteadyParams::default());
        let mut rows = Vec::new();
        for number in 0..num {
            let seconds = number as f64 / rate;
            let scene = frame(number);
            detector.see(&scene, Duration::from_secs_f64(seconds));
            if number % step != 0 {
                continue;
            }
            let taken_at = Timestamp::UNIX_EPOCH + SignedDuration::from_secs_f64(seconds);
            let scene = followed.look(scene, taken_at, number, Some(detector.motion()));
            let mut found = run_all(&scene, &library, &recipe, &Unwatched).expect("run");
            followed.refuse_if_moving(&mut found);
            let entry = |inspection: &Inspection, hung, is_still| {
                entry(seconds, inspection, hung, is_still)
            };
            let middle = |one: &Inspection| one.middle(&library);
            rows.extend(followed.take(&scene, found, middle, &recipe, entry));
        }
        rows.extend(followed.end());
        rows
    }

    /// The accepted names, sorted, that were recorded within these seconds.
    fn accepted(rows: &[Row], within: std::ops::Range<f64>) -> Vec<&str> {
        let counted = rows.iter().filter(|row| within.contains(&row.0));
        let mut names: Vec<&str> = counted
            .map(|(_, name, is_accepted, _)| {
                assert!(is_accepted, "{name} is refused: {rows:?}");
                name.as_str()
            })
            .collect();
        names.sort_unstable();
        names
    }

    /// The first frames of a line, to be looked at several times.
    fn line(scene: CellScene, num: u64) -> impl Fn(u64) -> Arc<SceneCloud> {
        let mut cell = SimulatedCell::new(SimulatedSpec {
            scene,
            frames_per_second: 10.0,
            ..SimulatedSpec::default()
        });
        let frames: Vec<_> = (1..=num).map(|number| cell.frame(number).0).collect();
        move |number| Arc::new(scene_from_image(frames[number as usize].clone()))
    }

    /// Frames at 30 a second of a part that is moved by this after a time in seconds.
    fn hanging(
        (kind, seed): (PartKind, u64),
        moved: impl Fn(f64) -> RigidTransform,
    ) -> impl FnMut(u64) -> Arc<SceneCloud> {
        let part = HangingPart::new(kind, seed);
        move |number| {
            let moved = moved(number as f64 / 30.0);
            let frame = part.frame(SensorNoise::kinect(number), &moved);
            Arc::new(scene_from_frame(&frame))
        }
    }

    fn at_rest(_: f64) -> RigidTransform {
        RigidTransform::identity()
    }

    #[test]
    fn of_two_in_thirty_frames_a_part_at_rest_counts_once_and_one_that_swings_never() {
        let rows = rows_at(30.0, 1, 15, 90, hanging((PartKind::Fender, 3), at_rest));
        let [(seconds, name, true, _)] = &rows[..] else {
            panic!("{rows:?}");
        };
        assert!(*seconds <= 1.5 && name == "fender", "{rows:?}");
        let swings = |t: f64| RigidTransform::translation(0.004 * (TAU * t / 1.6).sin(), 0.0, 0.0);
        let rows = rows_at(30.0, 1, 15, 90, hanging((PartKind::FrontDoor, 5), swings));
        assert!(rows.iter().all(|(_, _, is_ok, _)| !is_ok), "{rows:?}");
        // Without a look at the frames in between, they are too few to tell for 7 s.
        let mut frame = hanging((PartKind::Fender, 3), at_rest);
        let rows = rows_at(2.0, 1, 1, 13, |number| frame(15 * number));
        assert!(rows.iter().all(|(_, _, is_ok, _)| !is_ok), "{rows:?}");
    }

    #[test]
    fn of_two_in_thirty_frames_the_pose_is_that_of_the_part_at_rest_not_of_one_coming_to_rest() {
        let follow = |moved: fn(f64) -> RigidTransform| {
            let frame = hanging((PartKind::Fender, 3), moved);
            let entry = |seconds, inspection: &Inspection, _, _| {
                let pose = inspection.found_pose().expect("a pose");
                let place = pose.camera_from_part().translation.vector;
                (seconds, inspection.verdict.is_accepted(), place)
            };
            followed_at(30.0, 1, 15, 60, frame, entry)
        };
        // It comes to rest over the first three frames, and the first of them is inspected.
        let comes = |t: f64| RigidTransform::translation(0.0, 0.0, 0.05 * (0.1 - t).max(0.0));
        let (rests, comes) = (follow(at_rest), follow(comes));
        let ([(at, true, place)], [(later, true, found)]) = (&rests[..], &comes[..]) else {
            panic!("{rests:?}, {comes:?}");
        };
        assert!((at - later).abs() < 1e-9, "nothing seen to move");
        assert!((place - found).norm() < 3e-4, "{rests:?}, {comes:?}");
    }

    #[test]
    fn of_two_frames_a_second_two_parts_one_after_the_other_are_two() {
        let rows = rows_of(1, 5, 116, line(CellScene::Line { every: 6.0 }, 116));
        let [first, second] = [accepted(&rows, 0.0..6.0), accepted(&rows, 6.0..12.0)];
        assert_eq!((first.len(), second.len()), (1, 1), "{rows:?}");
        assert_ne!(first, second);
    }

    #[test]
    fn only_a_part_that_is_known_to_hang_still_is_refused_for_a_slow_computer() {
        let rate = InspectionRate {
            num_inspected: 1,
            num_frames: 50,
        };
        let is_refused = |verdict| {
            let mut seen = SeenPart::alone(nothing_there(), None);
            let part = String::from("door");
            seen.inspection.verdict = Verdict::Part {
                part: part.clone(),
                score: 0.99,
                margin: 0.9,
                rejected: Some(Rejection::NotSteady { part }),
                is_approximate: false,
            };
            (seen.spot, seen.verdict) = (Some(0), verdict);
            seen.refuse_as_too_slow(rate);
            let rejected = seen.inspection.verdict.rejected();
            matches!(rejected, Some(Rejection::TooSlow { .. }))
        };
        let (num_frames, needed) = (1, 5);
        assert!(is_refused(LiveVerdict::Gathering { num_frames, needed }));
        assert!(!is_refused(LiveVerdict::Open));
    }

    #[test]
    fn a_part_that_leaves_before_enough_of_its_frames_were_inspected_is_not_judged() {
        // It is there from 0.2 to 2 s.
        let away = RigidTransform::translation(9.0, 0.0, 0.0);
        let mut frame = hanging((PartKind::Fender, 3), |seconds| {
            if (0.2..2.0).contains(&seconds) {
                RigidTransform::identity()
            } else {
                away
            }
        });
        let (library, recipe) = (shipped_library(), Recipe::default());
        let mut followed = PartFollower::default();
        let mut detector = MotionDetector::new(SteadyParams::default());
        let mut recorded = Vec::new();
        for number in 0..=150 {
            let scene = frame(number);
            let at = Duration::from_secs(number) / 30;
            detector.see(&scene, at);
            if number % 50 != 0 {
                continue;
            }
            let since = SignedDuration::try_from(at).expect("in range");
            let taken_at = Timestamp::UNIX_EPOCH + since;
            let scene = followed.look(scene, taken_at, number, Some(detector.motion()));
            let mut found = run_all(&scene, &library, &recipe, &Unwatched).expect("run");
            followed.refuse_if_moving(&mut found);
            let entry = |inspection: &Inspection, _, is_still| {
                (inspection.verdict.rejected().cloned(), is_still)
            };
            recorded.extend(followed.take(&scene, found, |_| None, &recipe, entry));
        }
        let too_slow = Rejection::TooSlow {
            part: "fender".into(),
            num_inspected: 1,
            num_frames: 50,
        };
        assert_eq!(recorded, [(Some(too_slow), true)]);
    }

    #[test]
    fn of_racks_that_come_in_and_leave_every_part_is_recorded_once() {
        let frame = line(CellScene::Rack { every: 8.0 }, 160);
        for step in [1, 3] {
            let rows = rows_of(3, step, 160, &frame);
            let [first, second] = [accepted(&rows, 0.0..8.5), accepted(&rows, 8.5..16.0)];
            assert_eq!(
                (first.len(), second.len(), rows.len()),
                (3, 3, 6),
                "{rows:?}"
            );
            assert_ne!(first, second);
        }
    }

    #[test]
    fn parts_one_after_the_other_have_the_same_rows_where_several_may_hang() {
        let frame = line(CellScene::Line { every: 6.0 }, 116);
        let [alone, several] = [1, 3].map(|max_parts| rows_of(max_parts, 3, 116, &frame));
        let what = |rows: &[Row]| -> Vec<_> {
            let rows = rows.iter();
            rows.map(|(at, name, is_accepted, _)| (*at, name.clone(), *is_accepted))
                .collect()
        };
        assert_eq!(what(&alone), what(&several));
        assert!(alone.len() >= 2, "{alone:?}");
    }

    #[test]
    fn a_part_taken_off_and_two_hung_beside_parts_that_stay_are_each_recorded_once() {
        let setup = RackSetup::drawn(RackKind::Apart, 4, 0, 5).expect("in range");
        let rack = StandingRack::arrange(&setup).expect("in range");
        // Part 1 is taken off to the front, hangs there again, and part 3 is hung beside it.
        let rows = rows_of(4, 3, 130, |number| {
            let seconds = number as f64 / 10.0;
            let away = |share: f64| {
                let shift = RigidTransform::translation(0.0, 1.5 * share, -0.3 * share);
                (share < 1.0).then_some(shift)
            };
            let coming = |at: f64| away((at + 1.0 - seconds).clamp(0.0, 1.0));
            let moved = |part| match part {
                1 if seconds < 7.0 => away((seconds - 4.5).clamp(0.0, 1.0)),
                1 => coming(8.0),
                3 => coming(8.5),
                _ => Some(RigidTransform::identity()),
            };
            let noise = SensorNoise::kinect(number);
            let frame = rack.frame(moved, &noise);
            Arc::new(scene_from_image(capture::Image::Depth(frame)))
        });
        let [first, then] = [accepted(&rows, 0.0..7.0), accepted(&rows, 7.0..13.0)];
        assert_eq!((first.len(), then.len(), rows.len()), (3, 2, 5), "{rows:?}");
        let again = then.iter().filter(|name| first.contains(*name));
        assert_eq!(again.count(), 1, "{rows:?}");
    }
}
