use nalgebra::{Translation3, UnitQuaternion, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::*;
use geometry::rigid::{from_euler_zyx, pose_error};
use inspection::library::PathPoint;

/// A world in which everything is known, for tests of servoing without pictures.
#[derive(Clone)]
pub(crate) struct World {
    pub(crate) task: Task,
    /// True place of the camera: on the flange, or in the base frame.
    pub(crate) mount_from_camera: RigidTransform,
    /// Where the part is: in the base frame, or on the flange if the arm holds it.
    pub(crate) part_in_place: RigidTransform,
}

impl World {
    /// What the camera really sees with the flange here.
    pub(crate) fn camera_from_part(&self, flange: &RigidTransform) -> RigidTransform {
        let robot_from_camera = match self.task.camera {
            CameraPlace::Fixed { .. } => self.mount_from_camera,
            CameraPlace::OnFlange { .. } => flange * self.mount_from_camera,
        };
        let robot_from_part = if self.task.is_part_held() {
            flange * self.part_in_place
        } else {
            self.part_in_place
        };
        robot_from_camera.inverse() * robot_from_part
    }

    /// The true error: of the part in the camera at its middle, or of the nozzle at its mouth.
    pub(crate) fn error(&self, flange: &RigidTransform) -> PoseDelta {
        match self.task.target {
            Target::SeenAt { camera_from_part } => {
                let seen = self.camera_from_part(flange);
                pose_error(&seen, &camera_from_part, &self.task.middle)
            }
            Target::Nozzle {
                part_from_nozzle,
                flange_from_nozzle,
                ..
            } => {
                let nozzle = self.part_in_place.inverse() * flange * flange_from_nozzle;
                pose_error(&nozzle, &part_from_nozzle, &Point3::origin())
            }
        }
    }
}

/// A transform with a shift and a turn of these lengths, in directions of the seed.
fn off_by(shift: f64, turn: f64, random: &mut Pcg64) -> RigidTransform {
    let mut direction = || {
        let mut draw = || 2.0 * random.random::<f64>() - 1.0;
        Vector3::new(draw(), draw(), draw()).normalize()
    };
    RigidTransform::from_parts(
        Translation3::from(direction() * shift),
        UnitQuaternion::from_scaled_axis(direction() * turn),
    )
}

/// The four kinds of task, with a calibration that is wrong by this shift and turn, and the flange somewhere near the
/// target.
pub(crate) fn worlds(shift: f64, turn: f64, seed: u64) -> Vec<(World, RigidTransform)> {
    let mut random = Pcg64::seed_from_u64(seed);
    let flange = from_euler_zyx([0.3, 1.1, -0.4, 0.9, 0.2, 1.2]);
    let flange_from_camera = from_euler_zyx([0.1, -0.4, 1.5, 0.1, 0.05, 0.12]);
    let robot_from_camera = from_euler_zyx([-1.9, 0.1, -1.4, -0.4, 0.3, 1.5]);
    let camera_from_part = from_euler_zyx([0.1, -0.05, 0.2, 0.03, -0.04, 0.1]);
    let middle = Point3::new(0.05, -0.02, 1.3);
    let calibration = PoseDelta {
        shift: Metres(0.001),
        rotation: Radians(0.001),
    };
    let seen_at = Target::SeenAt { camera_from_part };
    let nozzle = Target::Nozzle {
        part_from_nozzle: from_euler_zyx([0.1, 0.2, -0.3, 0.05, 0.0, 1.15]),
        flange_from_nozzle: from_euler_zyx([0.0, 0.5, 0.1, 0.1, 0.0, 0.35]),
        calibration,
    };
    let mut all = Vec::new();
    for target in [seen_at, nozzle] {
        for on_flange in [true, false] {
            let wrong = off_by(shift, turn, &mut random);
            let (mount_from_camera, camera) = if on_flange {
                let camera = CameraPlace::OnFlange {
                    flange_from_camera: flange_from_camera * wrong,
                    capture_pose: None,
                };
                (flange_from_camera, camera)
            } else {
                let camera = CameraPlace::Fixed {
                    robot_from_camera: robot_from_camera * wrong,
                };
                (robot_from_camera, camera)
            };
            let mut world = World {
                task: Task {
                    part: "door".into(),
                    reference: "door".into(),
                    middle,
                    camera,
                    target,
                },
                mount_from_camera,
                part_in_place: RigidTransform::identity(),
            };
            // The part is where the target is reached with the flange here.
            let robot_from_camera = if on_flange {
                flange * mount_from_camera
            } else {
                mount_from_camera
            };
            let robot_from_part = match target {
                Target::SeenAt { camera_from_part } => robot_from_camera * camera_from_part,
                Target::Nozzle {
                    part_from_nozzle,
                    flange_from_nozzle,
                    ..
                } => flange * flange_from_nozzle * part_from_nozzle.inverse(),
            };
            world.part_in_place = if world.task.is_part_held() {
                flange.inverse() * robot_from_part
            } else {
                robot_from_part
            };
            let start = off_by(0.2, 0.0, &mut random) * flange * off_by(0.05, 0.25, &mut random);
            all.push((world, start));
        }
    }
    all
}

#[test]
fn with_a_right_calibration_one_look_tells_where_the_flange_must_go() {
    for seed in 0..20 {
        for (world, start) in worlds(0.0, 0.0, seed) {
            assert!(world.error(&start).shift.mm() > 20.0);
            let seen = world.camera_from_part(&start);
            let goal = world.task.goal(&start, &seen);
            let left = world.error(&goal.robot_from_flange);
            assert!(left.shift.0 < 1e-9 && left.rotation.0 < 1e-7, "{left:?}");
            let there = world.camera_from_part(&goal.robot_from_flange);
            let error = world
                .task
                .goal(&goal.robot_from_flange, &there)
                .error
                .size();
            assert!(error.shift.0 < 1e-9 && error.rotation.0 < 1e-7);
        }
    }
}

#[test]
fn the_error_is_the_distance_of_the_middle_or_mouth_and_the_angle_whatever_the_calibration() {
    for seed in 0..20 {
        for (number, (world, start)) in worlds(0.02, 0.035, seed).into_iter().enumerate() {
            let seen = world.camera_from_part(&start);
            let error = world.task.goal(&start, &seen).error.size();
            let expected = world.error(&start);
            let off = [
                (error.shift.0 - expected.shift.0).abs(),
                (error.rotation.0 - expected.rotation.0).abs(),
            ];
            // The first two see their target; the nozzle is known by the calibration only.
            if number < 2 {
                assert!(off[0] < 1e-9 && off[1] < 1e-7, "{off:?}");
            } else {
                assert!(off[0] > 1e-5, "{off:?}");
            }
        }
    }
}

#[test]
fn the_control_point_is_fixed_to_the_flange_and_meets_its_goal() {
    for (world, start) in worlds(0.0, 0.0, 5) {
        let seen = world.camera_from_part(&start);
        let goal = world.task.goal(&start, &seen);
        // A short step by the control law, as the twist of the control frame.
        let step = goal.error.scaled(0.1).transform();
        let control = start * goal.flange_from_control;
        let next = control * step * goal.flange_from_control.inverse();
        let (before, after) = (goal.error.size(), world.error(&next));
        assert!((after.shift.0 - 0.9 * before.shift.0).abs() < 1e-3 * before.shift.0 + 1e-9);
        assert!((after.rotation.0 - 0.9 * before.rotation.0).abs() < 1e-9);
    }
}

#[test]
fn by_looking_again_a_wrong_calibration_is_overcome_where_the_camera_sees_the_target() {
    for seed in 0..20 {
        for (number, (world, start)) in worlds(0.02, 0.035, seed).into_iter().enumerate() {
            let mut flange = start;
            for _ in 0..12 {
                let seen = world.camera_from_part(&flange);
                flange = world.task.goal(&flange, &seen).robot_from_flange;
            }
            let left = world.error(&flange);
            if number < 2 {
                assert!(left.shift.0 < 1e-6 && left.rotation.0 < 1e-6, "{left:?}");
            } else {
                // 35 mrad, or 20 mm and 35 mrad over the distance of the part.
                assert!((left.rotation.0 - 0.035).abs() < 1e-6, "{left:?}");
                assert!((0.0005..0.12).contains(&left.shift.0), "{left:?}");
            }
        }
    }
}

#[test]
fn a_recorded_target_is_the_mean_of_the_looks_that_agree_and_needs_half_of_them() {
    let middle = Point3::new(0.0, 0.0, 1.3);
    let seen = |x_mm: f64| Look {
        taken_at: std::time::Duration::ZERO,
        seen: Ok(crate::SeenPart {
            camera_from_part: RigidTransform::translation(0.001 * x_mm, 0.0, 0.1),
            bounds: PoseDelta {
                shift: Metres(0.002),
                rotation: Radians(0.003),
            },
            is_approximate: false,
        }),
    };
    let unseen = Look {
        seen: Err(crate::StopReason::Ambiguous {
            part: "door".into(),
        }),
        ..seen(0.0)
    };
    let looks = [seen(1.0), seen(3.0), seen(40.0), unseen.clone()];
    let Some(Target::SeenAt { camera_from_part }) = Target::recorded(&looks, &middle) else {
        panic!("two of four agree");
    };
    assert!((camera_from_part.translation.x - 0.002).abs() < 1e-9);
    let few = [seen(1.0), seen(40.0), unseen.clone(), unseen];
    assert_eq!(Target::recorded(&few, &middle), None);
    assert_eq!(Target::recorded(&[], &middle), None);
}

#[test]
fn a_path_that_starts_outside_of_the_band_is_refused() {
    let path = |stand_off: f64| {
        SprayPath::new(vec![PathPoint {
            nozzle: Point3::new(0.0, 0.0, 1.0),
            direction: Vector3::z_axis(),
            stand_off: Some(Metres(stand_off)),
            is_gun_on: true,
            speed: None,
            fan: None,
        }])
        .expect("a point")
    };
    let calibration = PoseDelta {
        shift: Metres(0.001),
        rotation: Radians(0.001),
    };
    let target = |stand_off| {
        let nozzle = RigidTransform::identity();
        Target::path_start(
            &path(stand_off),
            nozzle,
            calibration,
            &StandOffParams::default(),
        )
    };
    let Ok(Target::Nozzle {
        part_from_nozzle, ..
    }) = target(0.15)
    else {
        panic!("refused");
    };
    assert!((part_from_nozzle.translation.z - 1.0).abs() < 1e-12);
    assert!(((part_from_nozzle * Vector3::z()) - Vector3::z()).norm() < 1e-12);
    for stand_off in [0.09, 0.21] {
        assert!(matches!(target(stand_off), Err(TaskError::StandOff { .. })));
    }
}

#[test]
fn a_task_with_a_pose_that_is_not_finite_is_refused() {
    let (world, _) = worlds(0.0, 0.0, 1).remove(0);
    let mut task = world.task;
    assert!(task.clone().checked().is_ok());
    task.middle.x = f64::NAN;
    assert_eq!(
        task.checked(),
        Err(TaskError::NotFinite {
            what: "the middle of the part"
        })
    );
}
