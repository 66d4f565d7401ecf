//! Detection of motion in frames of the simulated cell: still parts with noise, and moving ones.

use std::f64::consts::TAU;

use nalgebra::{Translation3, UnitQuaternion, Vector3};

use super::*;
use geometry::rigid::RigidTransform;
use simulate::{Clutter, PartKind, SensorNoise, fixtures::HangingPart};
use stages::scene::scene_from_frame;

const FRAME: Duration = Duration::from_micros(33_333);

struct Hanging(HangingPart);

impl Hanging {
    fn new(kind: PartKind, noise: f64, seed: u64) -> Self {
        let mut part = HangingPart::new(kind, seed);
        part.setup.noise.multiplier = noise;
        Self(part)
    }

    /// The frame of this number, with the part moved by this from its rest position.
    fn frame(&self, number: u64, moved: &RigidTransform) -> SceneCloud {
        let setup = &self.0.setup;
        let noise = SensorNoise {
            seed: setup.seed * 10_000 + number,
            ..setup.noise
        };
        scene_from_frame(&self.0.frame(noise, moved))
    }

    /// The state after every frame.
    fn watched(&self, num_frames: u64, moved: impl Fn(f64) -> RigidTransform) -> Vec<MotionState> {
        self.watched_every(FRAME, num_frames, moved)
    }

    /// The same, with this time between frames.
    fn watched_every(
        &self,
        apart: Duration,
        num_frames: u64,
        moved: impl Fn(f64) -> RigidTransform,
    ) -> Vec<MotionState> {
        let mut watch = MotionDetector::new(SteadyParams::default());
        (0..num_frames)
            .map(|number| {
                let at = apart * number as u32;
                watch.see(&self.frame(number, &moved(at.as_secs_f64())), at)
            })
            .collect()
    }
}

/// Displacement of a part from its rest position after a time in seconds.
type Motion = Box<dyn Fn(f64) -> RigidTransform>;

fn shifted(x: f64, y: f64, z: f64) -> RigidTransform {
    RigidTransform::translation(x, y, z)
}

#[test]
fn noise_alone_is_steady_from_the_first_frame_on() {
    for (kind, noise, clutter, seed) in [
        (PartKind::FrontDoor, 1.0, Clutter::None, 1),
        (PartKind::Grille, 1.0, Clutter::InFront, 2),
        (PartKind::FrontBumper, 3.0, Clutter::OnFloor, 3),
    ] {
        let mut hanging = Hanging::new(kind, noise, seed);
        hanging.0.setup.clutter = clutter;
        let states = hanging.watched(45, |_| RigidTransform::identity());
        assert!(
            states[..20].iter().all(|s| *s == MotionState::Watching),
            "{states:?}"
        );
        assert!(
            states[32..].iter().all(|s| s.is_steady()),
            "{kind} at {noise}: {states:?}"
        );
        let Some(MotionState::Steady { since, lasting }) = states.last() else {
            panic!("{states:?}");
        };
        assert_eq!((*since, *lasting), (Duration::ZERO, FRAME * 44));
    }
}

#[test]
fn a_slow_camera_is_steady_too_after_more_time() {
    let hanging = Hanging::new(PartKind::Grille, 1.0, 4);
    let apart = Duration::from_millis(125);
    let states = hanging.watched_every(apart, 30, |_| RigidTransform::identity());
    assert!(states[18..].iter().all(|s| s.is_steady()), "{states:?}");
}

#[test]
fn what_drifts_swings_or_turns_slowly_is_never_steady() {
    let turned = |angle: f64| {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), angle);
        RigidTransform::from_parts(Translation3::identity(), turn)
    };
    let swing =
        |phase: f64| move |t: f64| shifted(0.004 * (TAU * (t / 1.6 + phase)).sin(), 0.0, 0.0);
    let cases: [(&str, PartKind, f64, Motion); 7] = [
        (
            "right",
            PartKind::Grille,
            1.0,
            Box::new(|t| shifted(0.01 * t, 0.0, 0.0)),
        ),
        (
            "right",
            PartKind::FrontDoor,
            3.0,
            Box::new(|t| shifted(0.01 * t, 0.0, 0.0)),
        ),
        (
            "down",
            PartKind::FrontDoor,
            1.0,
            Box::new(|t| shifted(0.0, 0.01 * t, 0.0)),
        ),
        (
            "away",
            PartKind::Grille,
            1.0,
            Box::new(|t| shifted(0.0, 0.0, 0.01 * t)),
        ),
        ("swing", PartKind::FrontDoor, 1.0, Box::new(swing(0.0))),
        ("swing", PartKind::FrontBumper, 1.0, Box::new(swing(0.2))),
        (
            "turn",
            PartKind::FrontDoor,
            1.0,
            Box::new(move |t| turned(0.5_f64.to_radians() * t)),
        ),
    ];
    for (name, kind, noise, moved) in cases {
        let states = Hanging::new(kind, noise, 5).watched(40, moved);
        let steady = states.iter().filter(|s| s.is_steady()).count();
        assert_eq!(steady, 0, "{name} of {kind} at noise {noise}: {states:?}");
    }
}

#[test]
fn motion_after_a_rest_is_said_at_once_and_creeping_within_seconds() {
    let hanging = Hanging::new(PartKind::Fender, 1.0, 6);
    // Pushed at 30 cm/s after 36 frames.
    let pushed = |t: f64| shifted(0.3 * (t - 36.0 / 30.0).max(0.0), 0.0, 0.0);
    let states = hanging.watched(40, pushed);
    assert!(states[35].is_steady());
    assert_eq!(states[38], MotionState::Moving, "{states:?}");
    let creeping = |t: f64| shifted(0.001 * t, 0.0, 0.0);
    let states = hanging.watched_every(Duration::from_millis(100), 70, creeping);
    assert!(states.contains(&MotionState::Moving), "{states:?}");
}

#[test]
fn a_gap_in_time_and_another_picture_begin_anew_and_a_cloud_without_rows_is_never_steady() {
    let hanging = Hanging::new(PartKind::Fender, 1.0, 7);
    let scene = hanging.frame(0, &RigidTransform::identity());
    let mut watch = MotionDetector::new(SteadyParams::default());
    let seconds = Duration::from_secs_f64;
    for number in 0..40 {
        watch.see(&scene, seconds(0.04 * f64::from(number)));
    }
    assert!(watch.stillness().is_steady());
    let run = watch.run();
    assert_eq!(watch.see(&scene, seconds(60.0)), MotionState::Watching);
    assert!(watch.run() > run);
    // A clock that was set back.
    for number in 0..40 {
        watch.see(&scene, seconds(61.0 + 0.04 * f64::from(number)));
    }
    assert!(watch.stillness().is_steady());
    assert_eq!(watch.see(&scene, seconds(1.0)), MotionState::Watching);
    let mut bare = scene;
    bare.cloud.grid = None;
    for number in 0..40 {
        let states = watch.see(&bare, seconds(1.0 + 0.04 * f64::from(number)));
        assert_eq!(states, MotionState::Watching);
    }
}

/// Prints the figures from which the thresholds are chosen.
#[test]
#[ignore = "a table for whoever chooses the thresholds"]
fn table() {
    let cases: [(&str, Motion); 7] = [
        ("still", Box::new(|_| RigidTransform::identity())),
        ("right 10 mm/s", Box::new(|t| shifted(0.01 * t, 0.0, 0.0))),
        ("right 5 mm/s", Box::new(|t| shifted(0.005 * t, 0.0, 0.0))),
        ("down 10 mm/s", Box::new(|t| shifted(0.0, 0.01 * t, 0.0))),
        ("away 10 mm/s", Box::new(|t| shifted(0.0, 0.0, 0.01 * t))),
        (
            "swing 4 mm 1.6 s",
            Box::new(|t| shifted(0.004 * (TAU * t / 1.6).sin(), 0.0, 0.0)),
        ),
        (
            "turn 0.5°/s",
            Box::new(|t| {
                RigidTransform::from_parts(
                    Translation3::identity(),
                    UnitQuaternion::from_axis_angle(&Vector3::y_axis(), 0.5_f64.to_radians() * t),
                )
            }),
        ),
    ];
    for kind in [PartKind::FrontDoor, PartKind::Grille, PartKind::FrontBumper] {
        for noise in [0.0, 1.0, 3.0] {
            let hanging = Hanging::new(kind, noise, 5);
            for (name, moved) in &cases {
                let mut watch = MotionDetector::new(SteadyParams {
                    max_changed: 1.0,
                    ..SteadyParams::default()
                });
                let mut shares = Vec::new();
                let mut at_once = 0.0_f64;
                let mut restless = 0.0_f64;
                for number in 0..34_u64 {
                    let at = FRAME * number as u32;
                    let scene = hanging.frame(number, &moved(at.as_secs_f64()));
                    if let (Some(spell), Some(grid)) = (watch.spells.back(), scene.cloud.grid) {
                        at_once = at_once.max(watch.off_share(spell, &samples(&scene, grid)));
                    }
                    let before = watch.spells.len();
                    watch.see(&scene, at);
                    if watch.spells.len() != before {
                        let Some(new) = watch.spells.back() else {
                            shares.push(1.0);
                            continue;
                        };
                        restless = restless.max(watch.moving_share(new));
                        for old in watch.spells.iter().rev().skip(1) {
                            shares.push((watch.changed_share(old, new) * 1e5).round() / 1e5);
                        }
                    }
                }
                println!(
                    "{kind:<18} {noise} {name:<18} noise {:.4} at once {at_once:.5} restless {restless:.4} changed {shares:?}",
                    watch.noise
                );
            }
        }
    }
}
