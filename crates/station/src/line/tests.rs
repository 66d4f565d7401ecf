use std::{sync::Arc, time::Instant};

use capture::{Captured, SourceSpec};
use geometry::{rigid::pose_error, units::Radians};
use inspection::{
    fixtures::shipped_library,
    library::{Library, enrolment_pose},
    pipeline::{NamedRecipe, Recipe, Unwatched, run},
};
use nalgebra::{Translation3, Unit, UnitQuaternion};
use records::history::Traceability;
use robot::line::{Counter, DEFAULT_EXPOSURE_S, OnLine};
use serde_json::Value;
use serve::{Asked, AskedOrder, ExpectedNumbers, PoseKind, VerdictCode};
use simulate::{
    CellSetup, LineSetup, PartKind, PartPose, PoseRange, RackKind, RackSetup, SensorNoise, Side,
    SimulatedLine, SimulatedObject, StandingRack,
};
use stages::{
    pose::PoseEstimate,
    reference::Reference,
    scene::{SceneCloud, scene_from_frame, scene_from_image},
};

use super::*;
use crate::{Answering, Camera, NumberedPart, PartFinder, Subject};

const PER_COUNT_M: f64 = 0.0001;

fn line(change: impl FnOnce(&mut LineCalibration)) -> LineCalibration {
    let mut line = LineCalibration {
        direction: Unit::new_normalize(Vector3::new(-1.0, 0.02, 0.1)),
        direction_bound: Radians(0.002),
        way_per_count: Metres(PER_COUNT_M),
        scale_bound: 0.002,
        counter: Counter::Bits32,
        residual: Metres(0.001),
        num_poses: 12,
        way: Metres(0.6),
        part: "fender".into(),
        made_at: jiff::Timestamp::UNIX_EPOCH,
        slip: 0.005,
        exposure: 0.01,
        delay: 0.0,
        delay_bound: 0.0,
    };
    change(&mut line);
    line
}

/// A frame by itself accepts the part of this inspection, at another place each time.
struct Seen {
    scene: Arc<SceneCloud>,
    inspection: Inspection,
    middle: Point3<f64>,
}

impl Seen {
    fn new() -> Self {
        let library = shipped_library();
        let mut setup = CellSetup::with_part(PartKind::Fender, Side::Left, 0, 3);
        setup.pose = PartPose::Drawn(PoseRange::facing());
        let frame = simulate::frame(&setup).frame;
        let scene = scene_from_frame(&frame);
        let inspection = run(&scene, &library, &Recipe::default(), &Unwatched).expect("run");
        assert!(inspection.verdict.is_accepted() && !inspection.touches_edge());
        let middle = inspection.middle(&library);
        Self {
            scene: Arc::new(scene),
            inspection,
            middle: middle.expect("points"),
        }
    }

    fn pose(&self) -> RigidTransform {
        self.inspection
            .found_pose()
            .expect("accepted")
            .camera_from_part()
    }

    /// The inspection of a frame with the part moved so.
    fn at(&self, moved: RigidTransform) -> Inspection {
        let mut inspection = self.inspection.clone();
        let pose = moved * self.pose();
        if let Some(Ok(found)) = &mut inspection.pose {
            found.target_from_source = pose.inverse();
        }
        inspection
    }
}

fn moment(seconds: f64, count: Option<f64>) -> Moment {
    Moment {
        at: Duration::from_secs_f64(seconds),
        count,
    }
}

/// The frames at `rate` a second of parts that start at these ways, in metres, and of a line of this speed; `off` moves a part beside
/// its place on the line, and `lost` is the share of the way that the encoder loses, if there is one.
struct Run<'a> {
    line: LineCalibration,
    starts: &'a [f64],
    speed: f64,
    rate: f64,
    lost: Option<f64>,
    off: &'a dyn Fn(f64) -> RigidTransform,
}

/// What was recorded: the time, the number, and why it was refused.
type Row = (f64, Option<u32>, Option<Rejection>);

impl Run<'_> {
    /// Runs for this time. Also returns the last pose of the first part that counts, with its true one then.
    fn rows(self, seen: &Seen, seconds: f64) -> (Vec<Row>, Option<(LinePose, RigidTransform)>) {
        let mut tracker = LineTracker::new(self.line.clone());
        let (mut rows, mut last) = (Vec::new(), None);
        for k in 0..(self.rate * seconds) as u32 {
            let now = f64::from(k) / self.rate;
            let way = self.speed * now;
            let count = self
                .lost
                .map(|lost| (way * (1.0 - lost) / PER_COUNT_M).floor());
            let place = |start: &f64| {
                let along = Translation3::from(self.line.direction.into_inner() * (start + way));
                along * (self.off)(now)
            };
            // The camera sees a metre of the line.
            let in_view = self
                .starts
                .iter()
                .filter(|start| (-0.5..0.5).contains(&(**start + way)));
            let places: Vec<RigidTransform> = in_view.map(place).collect();
            let mut found: Vec<Inspection> = places.iter().map(|at| seen.at(*at)).collect();
            let entry = |_, one: &Inspection, on_line: Option<OnLine>| {
                let number = on_line.map(|here| here.number);
                (now, number, one.verdict.rejected().cloned())
            };
            let (followed, recorded) =
                tracker.see(moment(now, count), &mut found, |_| Some(seen.middle), entry);
            for (inspection, followed) in found.iter().zip(&followed) {
                let is_accepted = inspection.verdict.is_accepted();
                assert_eq!(is_accepted, followed.pose.is_some());
            }
            if let (Some(followed), Some(place)) = (followed.first(), places.first()) {
                let pose = followed.pose.filter(|_| followed.number == Some(1));
                last = pose.map(|pose| (pose, place * seen.pose())).or(last);
            }
            rows.extend(recorded);
        }
        rows.extend(tracker.end());
        (rows, last)
    }
}

fn still(_: f64) -> RigidTransform {
    RigidTransform::identity()
}

#[test]
fn parts_that_a_line_carries_are_recorded_once_each_and_have_a_pose_at_every_count() {
    let seen = Seen::new();
    for (lost, slip) in [(Some(0.0), 0.005), (Some(0.01), 0.01), (None, 0.005)] {
        let run = Run {
            line: line(|line| line.slip = slip),
            starts: &[-0.45, -1.0, -1.5],
            speed: 0.1,
            rate: 5.0,
            lost,
            off: &still,
        };
        let carrier = run.line.clone();
        let (rows, last) = run.rows(&seen, 40.0);
        let numbers: Vec<Option<u32>> = rows.iter().map(|row| row.1).collect();
        assert_eq!(numbers, [Some(1), Some(2), Some(3)], "{lost:?}: {rows:?}");
        // Within three seconds of coming in: at 0, 5 and 10 s.
        for ((at, ..), came_in) in rows.iter().zip([0.0, 5.0, 10.0]) {
            assert!((0.5..=2.0).contains(&(at - came_in)), "{lost:?}: {rows:?}");
        }
        let (pose, truth) = last.expect("it counted");
        assert!((pose.speed - 0.1).abs() < 0.002, "{pose:?}");
        let way = 0.4;
        let then = carrier.carried(&truth, way);
        let (found, bounds) = match pose.moment.count {
            Some(count) => {
                let count = count + way * (1.0 - lost.unwrap_or(0.0)) / PER_COUNT_M;
                pose.at_count(count, &carrier).expect("counted")
            }
            None => pose.after(way / 0.1, &carrier),
        };
        let off = pose_error(&found, &then, &seen.middle).shift;
        assert!(
            off <= bounds.shift,
            "{lost:?}: {off} beyond {}",
            bounds.shift
        );
        assert!(off.mm() < 5.0, "{lost:?}: {off}");
    }
}

#[test]
fn a_part_that_swings_is_moving_and_recorded_once_without_a_number() {
    let seen = Seen::new();
    for lost in [Some(0.0), None] {
        for phase in 0..4 {
            let swing = |seconds: f64| {
                let angle = std::f64::consts::TAU * seconds / 1.9 + f64::from(phase) * 0.8;
                let hook = seen.pose() * seen.middle - Vector3::y() * 0.8;
                Translation3::from(hook.coords)
                    * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.05 * angle.sin())
                    * Translation3::from(-hook.coords)
            };
            let run = Run {
                line: line(|_| ()),
                starts: &[-0.45],
                speed: 0.1,
                rate: 5.0,
                lost,
                off: &swing,
            };
            let (rows, last) = run.rows(&seen, 12.0);
            let [(_, None, Some(Rejection::NotSteady { .. }))] = &rows[..] else {
                panic!("{lost:?} at phase {phase}: {rows:?}");
            };
            assert_eq!(last, None);
        }
    }
}

#[test]
fn a_part_counts_as_soon_however_fast_its_frames_are_inspected() {
    let seen = Seen::new();
    for lost in [Some(0.0), None] {
        let run = Run {
            line: line(|_| ()),
            starts: &[-0.45],
            speed: 0.1,
            rate: 30.0,
            lost,
            off: &still,
        };
        let (rows, _) = run.rows(&seen, 4.0);
        let [(at, Some(1), None)] = &rows[..] else {
            panic!("{lost:?}: {rows:?}");
        };
        assert!((0.5..1.2).contains(at), "{lost:?}: {rows:?}");
    }
}

#[test]
fn a_line_that_stands_carries_its_parts_nowhere_and_one_too_fast_for_the_exposure_smears_them() {
    let seen = Seen::new();
    let run = |speed: f64, exposure: f64| {
        let run = Run {
            line: line(|line| line.exposure = exposure),
            starts: &[-0.45],
            speed,
            rate: 5.0,
            lost: Some(0.0),
            off: &still,
        };
        run.rows(&seen, 4.0).0
    };
    let standing = run(0.0, DEFAULT_EXPOSURE_S);
    assert!(matches!(standing[..], [(_, Some(1), None)]), "{standing:?}");
    let fast = run(0.25, 0.01);
    assert!(matches!(fast[..], [(_, Some(1), None)]), "{fast:?}");
    let smeared = run(0.25, 0.06);
    let [(_, None, Some(Rejection::Smeared { smear, .. }))] = &smeared[..] else {
        panic!("{smeared:?}");
    };
    assert!((smear.mm() - 15.0).abs() < 0.5, "{smear}");
}

#[test]
fn parts_side_by_side_have_a_number_each_and_one_that_is_missed_for_a_while_keeps_its_own() {
    let seen = Seen::new();
    let carrier = line(|_| ());
    let mut tracker = LineTracker::new(carrier.clone());
    let mut numbers = Vec::new();
    for k in 0..40 {
        let now = f64::from(k) / 5.0;
        let way = 0.1 * now - 0.4;
        // Both hidden for two seconds, then found in the other order.
        let starts: &[f64] = match k {
            15..25 => &[],
            25.. => &[way - 0.3, way],
            _ => &[way, way - 0.3],
        };
        let place = |way: &f64| Translation3::from(carrier.direction.into_inner() * *way).into();
        let places: Vec<RigidTransform> = starts.iter().map(place).collect();
        let mut found: Vec<Inspection> = places.into_iter().map(|at| seen.at(at)).collect();
        let count = Some(0.1 * now / PER_COUNT_M);
        let (followed, recorded) = tracker.see(
            moment(now, count),
            &mut found,
            |_| Some(seen.middle),
            |_, _, on_line| on_line.map(|here| here.number),
        );
        numbers.extend(recorded);
        if k >= 25 {
            let after: Vec<Option<u32>> = followed.iter().map(|one| one.number).collect();
            assert_eq!(after, [Some(2), Some(1)], "frame {k}");
        }
    }
    assert_eq!(numbers, [Some(1), Some(2)]);
    assert_eq!(tracker.end(), []);
}

#[test]
fn a_pose_at_a_count_is_as_uncertain_as_the_delay_of_the_camera() {
    let bounds = Uncertainty {
        shift: Metres(0.003),
        turn: Radians(0.01),
        freedom: None,
    };
    let pose = |count: Option<f64>| LinePose {
        moment: moment(10.0, count),
        camera_from_part: RigidTransform::identity(),
        bounds,
        speed: -0.2,
        speed_bound: 0.002,
        rate: 1.0,
    };
    let (exact, vague) = (line(|_| ()), line(|line| line.delay_bound = 0.02));
    let counted = pose(Some(5000.0));
    let bound = |line| counted.at_count(5000.0, line).expect("counted").1.shift;
    assert_eq!(bound(&exact), bounds.shift);
    // In that time the line moves by 4 mm.
    assert!((bound(&vague).mm() - 5.0).abs() < 1e-9);
    let answered_mm = |pose: LinePose, line| pose.on_line(1, line).bound_mm;
    assert_eq!(
        answered_mm(counted, &exact).to_bits(),
        bounds.shift.mm().to_bits()
    );
    assert!((answered_mm(counted, &vague) - 5.0).abs() < 1e-9);
    let uncounted = answered_mm(pose(None), &vague);
    assert_eq!(uncounted.to_bits(), bounds.shift.mm().to_bits());
}

/// Numbers the parts of a library from 1.
fn finder(library: &Library) -> PartFinder {
    let parts = (1..).zip(&library.references);
    let parts = parts.map(|(number, _)| NumberedPart {
        number,
        ..NumberedPart::default()
    });
    PartFinder {
        parts: parts.collect(),
        robot: robot::RobotFrame {
            robot_from_camera: RigidTransform::translation(1.0, 2.0, 3.0),
            name: "cell 1".into(),
        },
        kind: PoseKind::RobotFromPart,
    }
}

/// What a line of JSON says of the part on the line.
fn on_line_of(line: &str) -> Value {
    let line: Value = serde_json::from_str(line).expect("JSON");
    line["on_line"].clone()
}

#[test]
fn an_answer_has_the_pose_that_the_part_had_at_the_count_that_was_sent() {
    let (seen, library, recipe) = (Seen::new(), shipped_library(), NamedRecipe::default());
    let source: SourceSpec = "simulated:fender".parse().expect("a source");
    let camera = Camera::start(&source).expect("started");
    let finder = finder(&library);
    let answering = Answering {
        camera: &camera,
        finder: &finder,
        library: &library,
        recipe: &recipe,
        expected: ExpectedNumbers::default(),
        at_most: Duration::from_secs(1),
        is_ending: &|| false,
    };
    let follower: LineFollower<()> = LineFollower::new(line(|_| ()));
    let bounds = seen.inspection.found_pose().and_then(PoseEstimate::bounds);
    // The frame was taken 0.2 s after the trigger, at count 5000; its line moves at 0.1 m/s, 1000 counts a second.
    let captured_at = Instant::now();
    let before = captured_at
        .checked_sub(Duration::from_millis(200))
        .expect("up longer");
    let frame = |count: Option<f64>| {
        let followed = Followed {
            number: Some(7),
            is_new: false,
            pose: Some(LinePose {
                moment: moment(10.0, count),
                camera_from_part: seen.pose(),
                bounds: bounds.expect("bounds"),
                speed: 0.1,
                speed_bound: 0.002,
                rate: 1.0,
            }),
        };
        let image = capture::Image::Cloud(seen.scene.cloud.clone());
        let captured = capture::Captured::now(1, "frame".into(), image);
        let subject = Subject::of_capture(&captured, &source, 0);
        FollowedFrame::of(
            subject,
            Arc::clone(&seen.scene),
            seen.inspection.clone(),
            followed,
            captured_at,
        )
    };
    let answered = |sent: Option<u32>, count: Option<f64>| {
        let asked = Asked {
            at: before,
            count: sent,
            ..Asked::now()
        };
        answering.answered_at(
            &asked,
            &moment(9.8, sent.map(f64::from)),
            frame(count),
            &follower,
            &Traceability::default(),
        )
    };
    let calibration = follower.line();
    for (count, way) in [(Some(4800), -0.02), (None, 0.0)] {
        for known in [Some(5000.0), None] {
            let answered = answered(count, known);
            let found = &answered.found.first;
            assert_eq!(found.verdict, VerdictCode::Accepted, "{:?}", found.problem);
            let there = calibration.carried(&seen.pose(), way);
            let pose = found.pose.expect("accepted");
            let off = pose_error(&pose, &finder.robot.robot_from_part(&there), &seen.middle);
            assert!(off.shift.0 < 1e-9, "{count:?}, {known:?}: {}", off.shift);
            let on_line = found.on_line.expect("on a line");
            assert_eq!((on_line.number, on_line.count), (7, count));
            let (at, since) = match count {
                Some(_) => (9800, before),
                None => (10_000, captured_at),
            };
            assert_eq!(on_line.at.as_millisecond(), at);
            assert_eq!(found.on_line_since, Some(since));
            let expected = serde_json::to_value(on_line).expect("JSON");
            assert_eq!(on_line_of(&found.report), expected);
            assert!((on_line.speed_mm_s - 100.0).abs() < 1e-9);
            let least = bounds.expect("bounds").shift.mm();
            assert!((least..least + 1.0).contains(&on_line.bound_mm));
            // What the camera saw of the part comes along.
            let moved = answered.inspections[0].readings().expect("points")[0]
                - seen.inspection.readings().expect("points")[0];
            assert!(
                (f64::from(moved.norm()) - way.abs()).abs() < 1e-4,
                "{moved}"
            );
        }
    }
    let mut refused = frame(Some(5000.0));
    refused.refuse_first();
    let asked = Asked::now();
    let sent = moment(9.8, None);
    let answered =
        answering.answered_at(&asked, &sent, refused, &follower, &Traceability::default());
    let found = answered.found.first;
    assert_eq!((found.verdict, found.pose), (VerdictCode::Refused, None));
    assert_eq!(found.problem.reason, "moving");
    assert_eq!(found.on_line, Some(OnLine::default()));
    assert_eq!(on_line_of(&found.report), Value::Null);
}

/// How a camera stamps its frames, and how late they arrive: the times of its frames are this much later than their exposure,
/// and they arrive later still by these times in turn.
struct LateCamera {
    delay: f64,
    arrive_later: [f64; 3],
}

#[test]
fn triggers_are_answered_at_their_counts_though_frames_are_delayed_and_arrive_late() {
    let (library, recipe) = (shipped_library(), NamedRecipe::default());
    let source: SourceSpec = "simulated:fender".parse().expect("a source");
    let camera = Camera::start(&source).expect("started");
    let finder = finder(&library);
    let answering = Answering {
        camera: &camera,
        finder: &finder,
        library: &library,
        recipe: &recipe,
        expected: ExpectedNumbers::default(),
        at_most: Duration::ZERO,
        is_ending: &|| false,
    };
    let setup = LineSetup::default();
    let simulated = SimulatedLine::arrange(&setup);
    let is_clear = |seconds: &f64| simulated.parts(*seconds)[0].fully_visible;
    let mut times = (0..).map(|k| 0.1 * f64::from(k));
    let start = times.find(is_clear).expect("it comes in");
    let begin = (Instant::now(), geometry::clock::now());
    let late = LateCamera {
        delay: 0.0,
        arrive_later: [0.0, 0.7, 0.2],
    };
    let delayed = LateCamera {
        delay: 0.3,
        arrive_later: [0.0; 3],
    };
    for LateCamera {
        delay,
        arrive_later,
    } in [late, delayed]
    {
        let mut follower = LineFollower::new(line(|line| {
            line.direction = simulated.direction();
            line.way_per_count = setup.encoder.way_per_count;
            line.exposure = setup.readout;
            line.delay = delay;
        }));
        let mut rows = Vec::new();
        for (k, later) in arrive_later.iter().cycle().enumerate().take(7) {
            let asked_at = start + 0.4 * k as f64;
            let exposed = asked_at + 0.1;
            // Some come a little after their counts were read.
            let count_age = Duration::from_millis(40 * (k as u64 % 3));
            let came_at = Duration::from_secs_f64(asked_at) + count_age;
            let asked = Asked {
                at: begin.0 + came_at,
                by_clock: begin.1 + came_at,
                count: Some(Counter::Bits32.shown(simulated.count(asked_at))),
                order: AskedOrder {
                    order: ["4711", "4711", "4711", "", "4712", "4713", ""][k].into(),
                    ..AskedOrder::default()
                },
                count_age,
                ..Asked::now()
            };
            let stamped = Duration::from_secs_f64(exposed + delay);
            let next = || {
                let frame = simulated.frame(exposed, &SensorNoise::kinect(k as u64));
                let captured = Captured {
                    taken_at: begin.1 + stamped,
                    arrived: begin.0 + stamped + Duration::from_secs_f64(*later),
                    ..Captured::now(k as u64, "frame".into(), capture::Image::Depth(frame))
                };
                let subject = Subject::of_capture(&captured, &source, 0);
                Ok((captured, subject))
            };
            let (answered, recorded, named) = answering.answer_on_line(
                &asked,
                &mut follower,
                &Traceability::default(),
                next,
                |captured| Arc::new(scene_from_image(captured.image)),
                |_, hung| hung,
            );
            // It is recorded once it counts, and of the order that the first trigger names from then on.
            rows.extend(recorded);
            assert_eq!(rows.len(), usize::from(k >= 3));
            let of_order = if k == 4 { rows.first() } else { None };
            assert_eq!(named.as_ref(), of_order, "{k}");
            let found = answered.expect("a frame").found.first;
            // The count of the first frame is not known yet.
            if k < 3 {
                assert_eq!(found.problem.reason, "passing", "{:?}", found.problem);
                continue;
            }
            assert_eq!(found.verdict, VerdictCode::Accepted, "{:?}", found.problem);
            let here = found.on_line.expect("on a line");
            assert_eq!((here.number, here.count), (1, asked.count));
            assert_eq!(found.on_line_since, Some(asked.counted_at()));
            let counted_at = asked.by_clock - count_age;
            assert_eq!(here.at.as_millisecond(), counted_at.as_millisecond());
            let truth = simulated.pose_of(0, asked_at) * enrolment_pose().inverse();
            let reference = library.references.iter().find(|one| one.name == found.part);
            let middle = reference.and_then(Reference::middle).expect("points");
            let pose = found.pose.expect("accepted");
            let off = pose_error(&pose, &finder.robot.robot_from_part(&truth), &middle).shift;
            let bound_mm = here.bound_mm;
            assert!(off.mm() <= bound_mm, "{k}: {off} off, {bound_mm} mm");
        }
    }
}

#[test]
fn a_trigger_names_the_order_of_the_part_that_its_answer_begins_with_and_of_none_behind_it() {
    let library = shipped_library();
    let mut recipe = Recipe::default();
    recipe.segment.max_parts = 2;
    let recipe = NamedRecipe::from(recipe);
    let source: SourceSpec = "simulated:fender".parse().expect("a source");
    let camera = Camera::start(&source).expect("started");
    let answering = Answering {
        camera: &camera,
        finder: &finder(&library),
        library: &library,
        recipe: &recipe,
        expected: ExpectedNumbers::default(),
        at_most: Duration::ZERO,
        is_ending: &|| false,
    };
    // Two parts on their way.
    let mut follower = LineFollower::new(line(|line| line.direction = Vector3::x_axis()));
    let setup = RackSetup::drawn(RackKind::Apart, 2, 0, 2).expect("two places");
    let rack = StandingRack::arrange(&setup).expect("two places");
    let begin = (Instant::now(), geometry::clock::now());
    let mut rows = Vec::new();
    let mut ahead = String::new();
    for (k, order) in ["", "", "", "", "4711", "4712", "4712"]
        .into_iter()
        .enumerate()
    {
        let seconds = 0.4 * k as f64;
        let at = Duration::from_secs_f64(seconds);
        let moved = RigidTransform::translation(0.01 * seconds - 0.012, 0.0, 0.0);
        // The one that was first has left by the last frame.
        let is_ahead = |object: &SimulatedObject| matches!(object, SimulatedObject::Part { kind, .. } if kind.name() == ahead);
        let frame = rack.frame(
            |number| (k < 6 || !is_ahead(&setup.places[number])).then_some(moved),
            &SensorNoise::kinect(k as u64),
        );
        let asked = Asked {
            at: begin.0 + at,
            by_clock: begin.1 + at,
            order: AskedOrder {
                order: order.into(),
                serial: String::new(),
            },
            ..Asked::now()
        };
        let next = || {
            let captured = Captured {
                taken_at: begin.1 + at,
                arrived: begin.0 + at,
                ..Captured::now(
                    k as u64,
                    "frame".into(),
                    capture::Image::Depth(frame.clone()),
                )
            };
            let subject = Subject::of_capture(&captured, &source, 0);
            Ok((captured, subject))
        };
        let (answered, recorded, named) = answering.answer_on_line(
            &asked,
            &mut follower,
            &Traceability::default(),
            next,
            |captured| Arc::new(scene_from_image(captured.image)),
            |part, hung| (part.inspection.verdict.guess().map(str::to_owned), hung),
        );
        rows.extend(recorded);
        let found = answered.expect("a frame").found.first;
        assert_eq!(rows.len(), if k < 3 { 0 } else { 2 }, "{k}: {rows:?}");
        if k < 3 {
            continue;
        }
        assert_eq!(found.verdict, VerdictCode::Accepted, "{:?}", found.problem);
        let first = rows.iter().find(|row| row.0.as_ref() == Some(&found.part));
        let first = first.map(|row| row.1.clone());
        assert!(first.is_some(), "{found:?}: {rows:?}");
        match k {
            4 => {
                assert_eq!(named, first);
                ahead = found.part;
            }
            // The one behind has a trigger of its own once it comes first.
            6 => {
                assert_eq!(named, first);
                assert_ne!(found.part, ahead);
            }
            _ => assert_eq!(named, None, "{k}"),
        }
    }
}
