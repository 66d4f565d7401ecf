use std::collections::VecDeque;

use super::*;
use crate::{
    Target, Tool,
    task::tests::{World, worlds},
};
use geometry::{
    oriented_box::OrientedBox,
    units::{Metres, Radians},
};
use inspection::pipeline::{Refusal, Rejection};

const PERIOD: Duration = Duration::from_millis(12);
const BOUNDS: PoseDelta = PoseDelta {
    shift: Metres(0.002),
    rotation: Radians(0.003),
};

fn millis(millis: u64) -> Duration {
    Duration::from_millis(millis)
}

/// An arm that follows at once and a camera without noise, whose frames arrive late.
struct Rig {
    world: World,
    servo: Servo,
    now: Duration,
    flange: RigidTransform,
    delay: Duration,
    next_frame: Duration,
    arriving: VecDeque<(Duration, Look)>,
}

impl Rig {
    fn new(world: World, start: RigidTransform, fence: Fence) -> Self {
        let servo = Servo::new(world.task.clone(), ServoParams::default(), fence);
        Self {
            servo: servo.expect("sound parameters"),
            world,
            now: Duration::ZERO,
            flange: start,
            delay: millis(120),
            next_frame: Duration::ZERO,
            arriving: VecDeque::new(),
        }
    }

    /// One with the camera on the flange that has begun to move.
    fn moving() -> Self {
        let (world, start) = worlds(0.0, 0.0, 3).remove(0);
        let mut rig = Self::new(world, start, Fence::none());
        rig.run(millis(900), Some);
        let before = rig.flange;
        rig.run(PERIOD, Some);
        assert!((before.translation.vector - rig.flange.translation.vector).norm() > 1e-3);
        rig
    }

    /// Runs for this long or until it ends; `change` may change or drop looks.
    fn run(&mut self, time: Duration, change: impl Fn(Look) -> Option<Look>) -> Option<Step> {
        let until = self.now + time;
        while self.now < until {
            self.now += PERIOD;
            if self.now >= self.next_frame {
                self.next_frame += millis(100);
                let seen = SeenPart {
                    camera_from_part: self.world.camera_from_part(&self.flange),
                    bounds: BOUNDS,
                    is_approximate: false,
                };
                let look = Look {
                    taken_at: self.now,
                    seen: Ok(seen),
                };
                let look = change(look).map(|look| (self.now + self.delay, look));
                self.arriving.extend(look);
            }
            let look = self.arriving.pop_front_if(|(at, _)| *at <= self.now);
            match self.step(look.map(|(_, look)| look).as_ref()) {
                Step::Command(pose) => self.flange = pose,
                end => return Some(end),
            }
        }
        None
    }

    fn step(&mut self, look: Option<&Look>) -> Step {
        let arm = ArmState {
            at: self.now,
            robot_from_flange: self.flange,
            joints: None,
        };
        self.servo.step(look, &arm)
    }

    /// Runs with such looks until it stops; checks that the robot brakes at once when the first of them arrives, and
    /// returns the reason.
    fn stopped(&mut self, change: impl Fn(Look) -> Option<Look>) -> StopReason {
        let mut lengths = Vec::new();
        loop {
            let before = self.flange;
            let end = self.run(PERIOD, &change);
            lengths.push((self.flange.translation.vector - before.translation.vector).norm());
            match end {
                None => {}
                Some(Step::Stop(reason)) => {
                    // The last step before the rest is one of braking.
                    let slowest = lengths.iter().rev().find(|length| **length > 0.0);
                    assert!(slowest.is_none_or(|length| *length < 2e-4), "{reason:?}");
                    assert_eq!(self.step(None), Step::Stop(reason.clone()), "for good");
                    return reason;
                }
                Some(other) => panic!("{other:?}"),
            }
            assert!(lengths.len() < 2000, "it runs on");
        }
    }
}

#[test]
fn every_task_ends_where_it_should_whatever_the_delay() {
    for delay in [30, 200] {
        for (number, (world, start)) in worlds(0.0, 0.0, 7).into_iter().enumerate() {
            let mut rig = Rig::new(world, start, Fence::none());
            rig.delay = millis(delay);
            let Some(Step::Done(arrival)) = rig.run(millis(20_000), Some) else {
                panic!("task {number} with {delay} ms: {:?}", rig.servo.held());
            };
            let left = rig.world.error(&rig.flange);
            assert!(
                left.shift.mm() < 0.51 && left.rotation.degrees() < 0.051,
                "{left:?}"
            );
            assert!((arrival.error.shift.0 - left.shift.0).abs() < 1e-6);
            assert_eq!(arrival.num_frames, ServoParams::default().num_final);
            assert!(arrival.bounds.shift >= BOUNDS.shift);
        }
    }
}

#[test]
fn a_wrong_calibration_does_not_change_where_a_camera_target_ends() {
    for seed in 0..5 {
        for (world, start) in worlds(0.02, 0.035, seed).into_iter().take(2) {
            let mut rig = Rig::new(world, start, Fence::none());
            let end = rig.run(millis(30_000), Some);
            assert!(matches!(end, Some(Step::Done(_))), "{end:?}");
            let left = rig.world.error(&rig.flange);
            assert!(
                left.shift.mm() < 0.6 && left.rotation.degrees() < 0.06,
                "{left:?}"
            );
        }
    }
}

#[test]
fn with_a_right_calibration_a_delayed_frame_is_no_error_and_nothing_overshoots() {
    let (world, start) = worlds(0.0, 0.0, 2).remove(0);
    let mut rig = Rig::new(world, start, Fence::none());
    rig.delay = millis(200);
    let mut last = f64::INFINITY;
    while rig.run(PERIOD, Some).is_none() {
        let error = rig.world.error(&rig.flange).shift.0;
        assert!(error < last + 1e-9, "{error} after {last}");
        last = error;
    }
}

#[test]
fn looks_to_move_by_no_longer_stop_it_with_their_reason() {
    let unseen = |reason: &StopReason| {
        let reason = reason.clone();
        move |look: Look| {
            Some(Look {
                seen: Err(reason.clone()),
                ..look
            })
        }
    };
    let refused = StopReason::NotAccepted {
        why: Refusal::Rejected(Rejection::HardlySeen {
            part: "door".into(),
            score: 0.4,
        }),
    };
    let other = StopReason::AnotherPart {
        part: "door".into(),
        other: "grille".into(),
    };
    for reason in [refused, other] {
        assert_eq!(Rig::moving().stopped(unseen(&reason)), reason);
    }
    assert!(matches!(
        Rig::moving().stopped(|_| None),
        StopReason::Lost { .. }
    ));
    let later = |by: u64| {
        move |look: Look| {
            Some(Look {
                taken_at: look.taken_at + millis(by),
                ..look
            })
        }
    };
    assert!(matches!(
        Rig::moving().stopped(later(500)),
        StopReason::FrameTimes { .. }
    ));
    let same = |look: Look| {
        Some(Look {
            taken_at: millis(700),
            ..look
        })
    };
    assert!(matches!(
        Rig::moving().stopped(same),
        StopReason::FrameTimes { .. } | StopReason::Stale { .. }
    ));
    let mut late = Rig::moving();
    late.delay = millis(700);
    assert!(matches!(
        late.stopped(Some),
        StopReason::Stale { .. } | StopReason::Lost { .. }
    ));
}

#[test]
fn a_single_frame_that_is_refused_only_delays_it() {
    let mut rig = Rig::moving();
    let refuse = |look: Look| {
        Some(Look {
            seen: Err(StopReason::Ambiguous {
                part: "door".into(),
            }),
            ..look
        })
    };
    rig.run(millis(100), refuse);
    rig.run(millis(120), Some);
    assert!(rig.servo.held().is_some());
    let end = rig.run(millis(20_000), Some);
    assert!(matches!(end, Some(Step::Done(_))), "{end:?}");
}

#[test]
fn a_part_that_is_pushed_holds_the_robot_until_it_stands_still_again() {
    let mut rig = Rig::moving();
    let pushed = RigidTransform::translation(0.0, 0.05, 0.0);
    rig.world.part_in_place = pushed * rig.world.part_in_place;
    rig.run(millis(330), Some);
    assert!(matches!(rig.servo.held(), Some(StopReason::Moved { .. })));
    let end = rig.run(millis(20_000), Some);
    assert!(matches!(end, Some(Step::Done(_))), "{end:?}");
    assert!(rig.world.error(&rig.flange).shift.mm() < 0.6);

    // One that jumps to and fro is never trusted.
    let mut rig = Rig::moving();
    let home = rig.world.part_in_place;
    let mut steps = 0;
    let reason = loop {
        steps += 1;
        let by = if steps % 2 == 0 { 0.05 } else { 0.0 };
        rig.world.part_in_place = RigidTransform::translation(0.0, by, 0.0) * home;
        match rig.run(millis(100), Some) {
            Some(Step::Stop(reason)) => break reason,
            other => assert!(other.is_none() && steps < 100, "{other:?}"),
        }
    };
    assert!(matches!(reason, StopReason::Moved { .. }), "{reason:?}");
}

#[test]
fn it_does_not_begin_before_several_frames_agree() {
    let (world, start) = worlds(0.0, 0.0, 3).remove(0);
    let mut rig = Rig::new(world, start, Fence::none());
    // Frames at 12, 108 and 204 ms arrive 120 ms later.
    rig.run(millis(310), Some);
    assert_eq!(rig.flange, start);
    assert_eq!(rig.servo.error(), None);
    rig.run(millis(60), Some);
    assert_ne!(rig.flange, start);
}

#[test]
fn an_arm_that_is_silent_or_elsewhere_or_a_person_stop_it() {
    let mut rig = Rig::moving();
    rig.now += millis(150);
    let end = rig.run(millis(1000), Some);
    assert!(
        matches!(end, Some(Step::Stop(StopReason::ArmTimes { gap_s })) if (gap_s - 0.162).abs() < 1e-9),
        "{end:?}"
    );
    let mut rig = Rig::moving();
    rig.flange = RigidTransform::translation(0.0, 0.0, 0.2) * rig.flange;
    rig.now += PERIOD;
    let step = rig.step(None);
    assert!(matches!(step, Step::Command(_)));
    assert!(matches!(
        rig.servo.held(),
        Some(StopReason::ArmAstray { shift_m, .. }) if (shift_m - 0.2).abs() < 0.01
    ));
    // It does not move at all.
    let mut rig = Rig::moving();
    let stuck = rig.flange;
    let step = loop {
        rig.run(PERIOD, Some);
        rig.flange = stuck;
        if rig.servo.held().is_some() {
            break rig.servo.error().expect("a goal");
        }
    };
    let left = rig.world.error(&stuck).shift.0;
    assert!(left - step.size().shift.0 < 0.15, "sent on by {left} m");
    assert!(matches!(
        rig.servo.held(),
        Some(StopReason::ArmAstray { .. })
    ));
    let mut rig = Rig::moving();
    rig.servo.stop(StopReason::ByPerson);
    assert_eq!(rig.stopped(Some), StopReason::ByPerson);
}

#[test]
fn it_never_leaves_the_fence() {
    let (world, start) = worlds(0.0, 0.0, 3).remove(0);
    let goal = world
        .task
        .goal(&start, &world.camera_from_part(&start))
        .robot_from_flange;
    let volume = |centre: &RigidTransform, side: f64| OrientedBox {
        centre_m: centre.translation.vector.into(),
        size_m: [side; 3],
        angles_rad: [0.0; 3],
    };
    // The goal lies outside: it does not even begin.
    let mut fence = Fence::none();
    fence.volume = Some(volume(&start, 0.05));
    let mut rig = Rig::new(world, start, fence);
    assert!(matches!(
        rig.stopped(Some),
        StopReason::OutsideVolume { .. }
    ));
    assert_eq!(rig.flange, start);

    // A tool that starts and ends inside, and leaves it between, where it turns about the part.
    let (world, _) = worlds(0.0, 0.0, 3).remove(0);
    let control = world
        .task
        .goal(&goal, &world.camera_from_part(&goal))
        .flange_from_control;
    let turn = |angle: f64| {
        let turn = RigidTransform::rotation(nalgebra::Vector3::y() * angle);
        goal * control * turn * control.inverse()
    };
    let start = turn(0.6);
    let mut fence = Fence::none();
    // Behind the flange, so that it is farthest from the part.
    fence.tools.push(Tool {
        end: Point3::from(control.translation.vector.normalize() * -0.1),
        radius: 0.01,
    });
    let ends = [start, goal].map(|flange| flange * fence.tools[0].end);
    let [middle, half] = [
        nalgebra::center(&ends[0], &ends[1]),
        turn(0.3) * fence.tools[0].end,
    ];
    let out = (half - middle).norm();
    // The plane beyond which the arc's middle lies, as a large box.
    let up = (half - middle).normalize();
    let axis = nalgebra::UnitQuaternion::rotation_between(&nalgebra::Vector3::z(), &up)
        .expect("no half turn");
    let (roll, pitch, yaw) = axis.euler_angles();
    fence.volume = Some(OrientedBox {
        centre_m: (middle + up * (0.5 * out - 2.0)).coords.into(),
        size_m: [4.0; 3],
        angles_rad: [roll, pitch, yaw],
    });
    let volume = fence.volume.expect("set");
    let tool = fence.tools[0].end;
    let mut rig = Rig::new(world, start, fence);
    let mut farthest = 0.0_f64;
    let end = loop {
        if let Some(end) = rig.run(PERIOD, Some) {
            break end;
        }
        farthest = farthest.max(volume.distance(&(rig.flange * tool)));
    };
    assert!(
        matches!(end, Step::Stop(StopReason::OutsideVolume { .. })),
        "{end:?}"
    );
    assert!(farthest < 1e-12, "{farthest}");
    assert_ne!(rig.flange, start);
}

#[test]
fn it_keeps_its_distance_from_the_part() {
    let (world, start) = worlds(0.0, 0.0, 3).remove(2);
    let target = world.task.target;
    let Target::Nozzle {
        flange_from_nozzle,
        part_from_nozzle,
        ..
    } = target
    else {
        panic!("a nozzle");
    };
    let tool = Tool {
        end: Point3::from(flange_from_nozzle.translation.vector),
        radius: 0.02,
    };
    // It starts 200 mm behind the goal.
    let seen = world.camera_from_part(&start);
    let goal = world.task.goal(&start, &seen).robot_from_flange;
    let back = RigidTransform::translation(0.0, 0.0, -0.2);
    let start = goal * flange_from_nozzle * back * flange_from_nozzle.inverse();
    for (away, is_near) in [(0.04, true), (0.15, false)] {
        let mut fence = Fence::none();
        fence.tools.push(tool);
        // A patch of surface in front of the nozzle at its goal.
        let spot = |x: f64, y: f64| (part_from_nozzle * Point3::new(x, y, away)).cast();
        fence.part = (-5..=5)
            .flat_map(|x| (-5..=5).map(move |y| (0.01 * f64::from(x), 0.01 * f64::from(y))))
            .map(|(x, y)| spot(x, y))
            .collect();
        let (world, _) = worlds(0.0, 0.0, 3).remove(2);
        let mut rig = Rig::new(world, start, fence);
        let end = rig.run(millis(20_000), Some);
        match end {
            Some(Step::Stop(StopReason::TooNear { obstacle, .. })) if obstacle == "part" => {
                assert!(is_near);
            }
            Some(Step::Done(_)) => assert!(!is_near),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn in_steps_it_moves_only_as_far_as_each_is_allowed_and_the_time_between_does_not_count() {
    let longest = PoseDelta {
        shift: Metres(0.05),
        rotation: Radians(0.09),
    };
    // It brakes once it is too long.
    let about = PoseDelta {
        shift: Metres(1.1 * longest.shift.0),
        rotation: Radians(1.1 * longest.rotation.0),
    };
    for (world, start) in worlds(0.0, 0.0, 3) {
        let mut rig = Rig::new(world, start, Fence::none());
        rig.servo.move_in_steps(longest);
        let state = |rig: &Rig| rig.servo.standing().expect("begun").state;
        let mut num_steps = 0;
        let end = loop {
            let before = rig.flange;
            // Far longer than all of it may take.
            assert_eq!(rig.run(millis(40_000), Some), None);
            let moved = pose_error(&before, &rig.flange, &Point3::origin());
            assert!(moved.shift.0 == 0.0 && state(&rig) == ServoState::Waiting);
            rig.servo.allow_step();
            num_steps += 1;
            let end = rig.run(millis(8_000), Some);
            let moved = pose_error(&before, &rig.flange, &Point3::origin());
            assert!(
                moved.shift.0 > 0.0 && is_within(&moved, &about),
                "{moved:?}"
            );
            if let Some(end) = end {
                break end;
            }
        };
        let Step::Done(arrival) = end else {
            panic!("{end:?}");
        };
        assert!(num_steps > 1, "{num_steps}");
        assert!(arrival.took < millis(8_000) * num_steps, "{arrival:?}");
    }
}

#[test]
fn an_end_that_is_less_certain_than_the_tolerance_is_refused() {
    let (world, start) = worlds(0.0, 0.0, 3).remove(0);
    let mut rig = Rig::new(world, start, Fence::none());
    let reason = loop {
        let end = rig.run(PERIOD, |look| {
            let seen = look.seen.map(|seen| SeenPart {
                bounds: PoseDelta {
                    shift: Metres(0.0079),
                    ..BOUNDS
                },
                ..seen
            });
            Some(Look { seen, ..look })
        });
        if let Some(end) = end {
            break end;
        }
    };
    assert!(
        matches!(reason, Step::Stop(StopReason::Uncertain { shift_m, .. }) if shift_m > 0.008),
        "{reason:?}"
    );
}
