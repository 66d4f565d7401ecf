//! On frames of the simulated cell: what stands still, what swings, and nothing but noise between them.

use std::f64::consts::TAU;

use nalgebra::{Translation3, UnitQuaternion, Vector3};

use super::*;
use crate::{
    capture::frame::Intrinsics,
    geometry::{mesh::TriangleMesh, rigid::RigidTransform},
    simulate::{
        CellSetup, Clutter, PartKind, PartPose, Placement, SensorNoise, Side, frame_of_mesh,
    },
    stages::scene::scene_from_frame,
};

const FRAME: Duration = Duration::from_micros(33_333);

/// A part before the camera, at rest where its seed puts it.
struct Hanging {
    setup: CellSetup,
    mesh: TriangleMesh,
    at_rest: RigidTransform,
}

impl Hanging {
    fn new(kind: PartKind, noise: f64, seed: u64) -> Self {
        let mut setup = CellSetup::with_part(kind, Side::Left, 0, seed);
        setup.noise.multiplier = noise;
        let mesh = setup.subject.mesh();
        let at_rest = Placement::facing()
            .draw(&mesh, &Intrinsics::KINECT, seed)
            .camera_from_part;
        Self {
            setup,
            mesh,
            at_rest,
        }
    }

    /// The frame of this number, the part moved by this from its rest.
    fn frame(&self, number: u64, moved: &RigidTransform) -> SceneCloud {
        let mut setup = self.setup;
        setup.pose = PartPose::Fixed(moved * self.at_rest);
        setup.noise = SensorNoise {
            seed: setup.seed * 10_000 + number,
            ..setup.noise
        };
        scene_from_frame(&frame_of_mesh(&setup, &self.mesh).frame)
    }

    /// What is said of every frame.
    fn watched(&self, num_frames: u64, moved: impl Fn(f64) -> RigidTransform) -> Vec<Stillness> {
        let mut watch = SteadyWatch::new(SteadyParams::default());
        (0..num_frames)
            .map(|number| {
                let at = FRAME * number as u32;
                watch.see(&self.frame(number, &moved(at.as_secs_f64())), at)
            })
            .collect()
    }
}

fn shifted(x: f64, y: f64, z: f64) -> RigidTransform {
    RigidTransform::from_parts(Translation3::new(x, y, z), UnitQuaternion::identity())
}

#[test]
fn noise_alone_is_steady_from_the_first_frame_on() {
    for (kind, noise, clutter, seed) in [
        (PartKind::FrontDoor, 1.0, Clutter::None, 1),
        (PartKind::Grille, 1.0, Clutter::InFront, 2),
        (PartKind::FrontBumper, 3.0, Clutter::OnFloor, 3),
    ] {
        let mut hanging = Hanging::new(kind, noise, seed);
        hanging.setup.clutter = clutter;
        let said = hanging.watched(45, |_| RigidTransform::identity());
        assert!(
            said[..20].iter().all(|s| *s == Stillness::Watching),
            "{said:?}"
        );
        assert!(
            said[32..].iter().all(|s| s.is_steady()),
            "{kind} at {noise}: {said:?}"
        );
        let Some(Stillness::Steady { since, lasting }) = said.last() else {
            panic!("{said:?}");
        };
        assert_eq!((*since, *lasting), (Duration::ZERO, FRAME * 44));
    }
}

/// Prints what the thresholds are chosen by.
#[test]
#[ignore = "a table for whoever chooses the thresholds"]
fn table() {
    let cases: [(&str, Box<dyn Fn(f64) -> RigidTransform>); 7] = [
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
                let mut watch = SteadyWatch::new(SteadyParams {
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
                        restless = restless.max(watch.restless_share(new));
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
