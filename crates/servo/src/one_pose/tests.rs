use std::time::Duration;

use super::*;
use crate::task::tests::{World, worlds};
use geometry::units::{Metres, Radians};

const MAX_MOVE: PoseDelta = PoseDelta {
    shift: Metres(0.1),
    rotation: Radians(0.2),
};

fn look(world: &World, flange: &RigidTransform, at: u64) -> Look {
    Look {
        taken_at: Duration::from_millis(at),
        seen: Ok(SeenPart {
            camera_from_part: world.camera_from_part(flange),
            bounds: PoseDelta {
                shift: Metres(0.002),
                rotation: Radians(0.003),
            },
            is_approximate: false,
        }),
    }
}

fn state(flange: &RigidTransform, at: u64) -> ArmState {
    ArmState {
        at: Duration::from_millis(at),
        robot_from_flange: *flange,
        joints: None,
    }
}

fn ask(run: &mut OnePose, world: &World, flange: &RigidTransform, at: u64) -> OnePoseAnswer {
    let looks = [20, 60, 90].map(|after| look(world, flange, at + after));
    run.answer(&looks, [&state(flange, at), &state(flange, at + 100)])
}

fn new(world: &World) -> OnePose {
    let run = OnePose::new(
        world.task.clone(),
        ServoParams::default(),
        MAX_MOVE,
        Fence::none(),
    );
    run.expect("sound parameters")
}

#[test]
fn in_a_few_moves_it_is_there_although_the_calibration_is_wrong() {
    for seed in 0..10 {
        for (number, (world, start)) in worlds(0.02, 0.035, seed).into_iter().enumerate() {
            let mut run = new(&world);
            let (mut flange, mut num_moves) = (start, 0);
            let arrival = loop {
                match ask(&mut run, &world, &flange, 1000 * num_moves) {
                    OnePoseAnswer::Move {
                        robot_from_flange, ..
                    } => {
                        let by = pose_error(&flange, &robot_from_flange, &Point3::origin());
                        assert!(
                            is_within(
                                &by,
                                &PoseDelta {
                                    shift: Metres(0.1001),
                                    rotation: Radians(0.2001)
                                }
                            ),
                            "{by:?}"
                        );
                        flange = robot_from_flange;
                        num_moves += 1;
                        assert!(num_moves < 15);
                    }
                    OnePoseAnswer::Done(arrival) => break arrival,
                    OnePoseAnswer::Stay(reason) => panic!("{reason:?}"),
                }
            };
            assert_eq!(arrival.num_frames, 3);
            let left = world.error(&flange);
            if number < 2 {
                assert!(
                    left.shift.mm() < 0.7 && left.rotation.degrees() < 0.06,
                    "{left:?}"
                );
            } else {
                assert!(left.rotation.degrees() > 1.5, "the nozzle is not seen");
            }
        }
    }
}

#[test]
fn it_stays_if_the_arm_moved_the_frame_is_not_from_then_or_nothing_is_seen() {
    let (world, start) = worlds(0.0, 0.0, 1).remove(0);
    let moved = RigidTransform::translation(0.002, 0.0, 0.0) * start;
    let looks = [look(&world, &start, 50)];
    let mut run = new(&world);
    let mut answer = |looks: &[Look], before: &ArmState, after: &ArmState| match run
        .answer(looks, [before, after])
    {
        OnePoseAnswer::Stay(reason) => reason.kind(),
        _ => "moves",
    };
    let (before, after) = (state(&start, 0), state(&start, 100));
    assert_eq!(answer(&looks, &before, &after), "moves");
    assert_eq!(answer(&looks, &before, &state(&moved, 100)), "arm_astray");
    assert_eq!(answer(&[], &before, &after), "lost");
    assert_eq!(answer(&looks, &state(&start, 60), &after), "frame_times");
    assert_eq!(answer(&looks, &before, &state(&start, 40)), "frame_times");
    let refused = Look {
        seen: Err(StopReason::Ambiguous {
            part: "door".into(),
        }),
        ..looks[0].clone()
    };
    assert_eq!(
        answer(&[looks[0].clone(), refused], &before, &after),
        "ambiguous"
    );
}

#[test]
fn a_part_that_was_pushed_between_two_requests_is_said_once_and_then_followed() {
    let (mut world, start) = worlds(0.0, 0.0, 1).remove(0);
    let mut run = new(&world);
    assert!(matches!(
        ask(&mut run, &world, &start, 0),
        OnePoseAnswer::Move { .. }
    ));
    world.part_in_place = RigidTransform::translation(0.0, 0.05, 0.0) * world.part_in_place;
    assert!(matches!(
        ask(&mut run, &world, &start, 1000),
        OnePoseAnswer::Stay(StopReason::Moved { shift_m, .. }) if (shift_m - 0.05).abs() < 1e-9
    ));
    assert!(matches!(
        ask(&mut run, &world, &start, 2000),
        OnePoseAnswer::Move { .. }
    ));
}

#[test]
fn corrections_that_lead_nowhere_end() {
    let (world, start) = worlds(0.0, 0.0, 1).remove(1);
    let near = world
        .task
        .goal(&start, &world.camera_from_part(&start))
        .robot_from_flange;
    let stuck = RigidTransform::translation(0.01, 0.0, 0.0) * near;
    let mut run = new(&world);
    let mut num = 0;
    // The arm never goes where it is sent.
    let reason = loop {
        match ask(&mut run, &world, &stuck, 1000 * num) {
            OnePoseAnswer::Move { .. } => num += 1,
            OnePoseAnswer::Stay(reason) => break reason,
            OnePoseAnswer::Done(_) => panic!("it is not there"),
        }
        assert!(num < 50);
    };
    assert!(
        matches!(reason, StopReason::NotSettling { .. }),
        "{reason:?}"
    );
}
