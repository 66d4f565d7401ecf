use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use rand::{Rng, RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::*;
use crate::geometry::rigid::from_euler_zyx;

/// How the camera errs, standard deviations per axis: metres and radians.
#[derive(Clone, Copy)]
struct Noise {
    shift: f64,
    turn: f64,
}

const EXACT: Noise = Noise { shift: 0.0, turn: 0.0 };

fn noise(mm: f64, degrees: f64) -> Noise {
    Noise {
        shift: mm / 1000.0,
        turn: degrees.to_radians(),
    }
}

/// A standard normal number, by G. E. P. Box and M. E. Muller.
fn normal(random: &mut impl Rng) -> f64 {
    let u: f64 = random.random_range(f64::MIN_POSITIVE..1.0);
    (-2.0 * u.ln()).sqrt() * (random.random_range(0.0..std::f64::consts::TAU)).cos()
}

fn normals(random: &mut impl Rng, deviation: f64) -> Vector3<f64> {
    Vector3::from_fn(|_, _| normal(random) * deviation)
}

fn any_rotation(random: &mut impl Rng, most: f64) -> UnitQuaternion<f64> {
    let axis = nalgebra::Unit::new_normalize(normals(random, 1.0));
    UnitQuaternion::from_axis_angle(&axis, random.random_range(-most..most))
}

fn disturbed(pose: &RigidTransform, noise: Noise, random: &mut impl Rng) -> RigidTransform {
    let turn = UnitQuaternion::from_scaled_axis(normals(random, noise.turn));
    let shift = Translation3::from(pose.translation.vector + normals(random, noise.shift));
    Isometry3::from_parts(shift, turn * pose.rotation)
}

/// A cell with its truth.
struct TrueCell {
    mount: Mount,
    mount_from_camera: RigidTransform,
    anchor_from_target: RigidTransform,
}

impl TrueCell {
    fn any(mount: Mount, random: &mut impl Rng) -> Self {
        let reach = match mount {
            Mount::EyeToHand => 2.5,
            Mount::EyeInHand => 0.15,
        };
        let mut pose = |reach: f64| {
            let shift = Vector3::from_fn(|_, _| random.random_range(-reach..reach));
            Isometry3::from_parts(Translation3::from(shift), any_rotation(random, 3.1))
        };
        Self {
            mount,
            mount_from_camera: pose(reach),
            anchor_from_target: pose(if mount == Mount::EyeToHand { 0.2 } else { 1.5 }),
        }
    }

    /// The pair that belongs to what the camera sees.
    fn pair(&self, number: usize, camera_from_target: RigidTransform) -> PosePair {
        let carrier =
            self.anchor_from_target * (self.mount_from_camera * camera_from_target).inverse();
        let pair = PosePair {
            name: format!("pair {number}"),
            robot_from_flange: match self.mount {
                Mount::EyeToHand => carrier.inverse(),
                Mount::EyeInHand => carrier,
            },
            camera_from_target,
        };
        let closed = self.mount.carrier(&pair.robot_from_flange)
            * self.mount_from_camera
            * pair.camera_from_target;
        assert!((closed.to_homogeneous() - self.anchor_from_target.to_homogeneous()).norm() < 1e-9);
        pair
    }

    /// Pairs with the target about 1.2 m before the camera, turned by up to `most` about any axis.
    fn pairs(&self, num: usize, most: f64, noise: Noise, random: &mut impl Rng) -> Vec<PosePair> {
        (1..=num)
            .map(|number| {
                let x = random.random_range(-0.35..0.35);
                let y = random.random_range(-0.25..0.25);
                let z = random.random_range(0.9..1.5);
                let seen =
                    Isometry3::from_parts(Translation3::new(x, y, z), any_rotation(random, most));
                let mut pair = self.pair(number, seen);
                pair.camera_from_target = disturbed(&seen, noise, random);
                pair
            })
            .collect()
    }

    /// How far X is off, at a point 1.2 m before the camera.
    fn off(&self, found: &HandEye) -> PoseError {
        let at = Point3::new(0.0, 0.0, 1.2);
        pose_error(&found.mount_from_camera, &self.mount_from_camera, &at)
    }
}

const MOUNTS: [Mount; 2] = [Mount::EyeToHand, Mount::EyeInHand];

/// Runs `check` over so many random cells of both mounts.
fn over_cells(num: u64, mut check: impl FnMut(TrueCell, &mut Pcg64)) {
    for mount in MOUNTS {
        for seed in 0..num {
            let mut random = Pcg64::seed_from_u64(seed);
            check(TrueCell::any(mount, &mut random), &mut random);
        }
    }
}

#[test]
fn exact_pairs_give_the_exact_calibration() {
    over_cells(50, |cell, random| {
        for num in [3, 4, 12] {
            let pairs = cell.pairs(num, 0.9, EXACT, random);
            let found = solve(&pairs, cell.mount).expect("solved");
            let off = cell.off(&found);
            assert!(off.shift.0 < 1e-7 && off.rotation.0 < 1e-7, "{num}: {off:?}");
            let target = pose_error(
                &found.anchor_from_target,
                &cell.anchor_from_target,
                &Point3::origin(),
            );
            assert!(target.shift.0 < 1e-7 && target.rotation.0 < 1e-7, "{target:?}");
            assert!(found.residuals.rms.shift.0 < 1e-9);
            // Three poses drawn at random may turn about nearly one axis.
            assert!(num == 3 || found.is_usable(), "{:?}", found.doubts);
        }
    });
}

/// Root mean square and worst over cells.
fn accuracy(num_pairs: usize, noise: Noise) -> [PoseError; 2] {
    let mut all: Vec<PoseError> = Vec::new();
    over_cells(100, |cell, random| {
        let pairs = cell.pairs(num_pairs, 0.7, noise, random);
        let found = solve(&pairs, cell.mount).expect("solved");
        assert!(found.is_usable(), "{:?}", found.doubts);
        all.push(cell.off(&found));
    });
    let worst = |figure: fn(&PoseError) -> f64| all.iter().map(figure).fold(0.0, f64::max);
    let worst = PoseError {
        rotation: Radians(worst(|off| off.rotation.0)),
        shift: Metres(worst(|off| off.shift.0)),
    };
    [rms(&all), worst]
}

#[test]
fn noisy_pairs_give_a_calibration_that_is_better_than_one_pair() {
    for (mm, degrees, rms_mm, rms_degrees, worst_mm, worst_degrees) in [
        (0.5, 0.1, 1.2, 0.08, 3.0, 0.25),
        (2.0, 0.5, 4.5, 0.35, 12.0, 1.1),
    ] {
        let [rms, worst] = accuracy(12, noise(mm, degrees));
        let text = format!("{mm} mm {degrees}°: rms {rms:?}, worst {worst:?}");
        println!("{text}");
        assert!(rms.shift.mm() < rms_mm && rms.rotation.degrees() < rms_degrees, "{text}");
        assert!(worst.shift.mm() < worst_mm && worst.rotation.degrees() < worst_degrees, "{text}");
    }
}

#[test]
fn bounds_hold_in_at_least_95_of_100_cells() {
    for num_pairs in [4, 8, 20] {
        let (mut num, mut held, mut looseness) = (0, [0, 0], 0.0);
        over_cells(150, |cell, random| {
            let pairs = cell.pairs(num_pairs, 0.7, noise(0.8, 0.15), random);
            let found = solve(&pairs, cell.mount).expect("solved");
            let off = cell.off(&found);
            num += 1;
            held[0] += usize::from(off.shift <= found.bounds.shift);
            held[1] += usize::from(off.rotation <= found.bounds.turn);
            looseness += found.bounds.shift.0 / off.shift.0.max(1e-6) / 300.0;
        });
        let shares = held.map(|held| held as f64 / f64::from(num));
        println!("{num_pairs} pairs: {shares:.3?} held, {looseness:.1} times wider on average");
        // Of 300 cells, 95 in 100 less two standard deviations.
        assert!(shares.iter().all(|share| *share > 0.925), "{num_pairs} pairs: {shares:?}");
        // Bounds that hold because they are absurd would be no bounds.
        assert!(looseness < 12.0, "{num_pairs} pairs: {looseness}");
    }
}

#[test]
fn refining_beats_the_closed_form() {
    let (mut closed, mut refined) = (Vec::new(), Vec::new());
    over_cells(60, |cell, random| {
        let pairs = cell.pairs(10, 0.7, noise(0.5, 0.3), random);
        let equations: Vec<Equation> = pairs
            .iter()
            .map(|pair| Equation {
                anchor_from_mount: cell.mount.carrier(&pair.robot_from_flange),
                camera_from_target: pair.camera_from_target,
            })
            .collect();
        let start = closed_form::solve(&equations).expect("solved").unknowns;
        let at = Point3::new(0.0, 0.0, 1.2);
        closed.push(pose_error(&start.mount_from_camera, &cell.mount_from_camera, &at));
        refined.push(cell.off(&solve(&pairs, cell.mount).expect("solved")));
    });
    let (closed, refined) = (rms(&closed), rms(&refined));
    println!("closed {closed:?}, refined {refined:?}");
    assert!(refined.rotation.0 < closed.rotation.0);
    assert!(refined.shift.0 < 0.9 * closed.shift.0);
}

#[test]
fn half_turns_are_turns_like_any_other() {
    over_cells(20, |cell, random| {
        let half = std::f64::consts::PI;
        let pairs: Vec<PosePair> = [
            [0.0, 0.0, 0.0, 0.0, 0.0, 1.2],
            [half, 0.0, 0.0, 0.1, 0.0, 1.1],
            [0.0, half, 0.0, 0.0, 0.1, 1.3],
            [0.0, 0.0, half, -0.1, 0.0, 1.2],
            [half, 0.3, half / 2.0, 0.0, -0.1, 1.2],
        ]
        .into_iter()
        .enumerate()
        .map(|(i, numbers)| {
            let mut pair = cell.pair(i, from_euler_zyx(numbers));
            pair.camera_from_target = disturbed(&pair.camera_from_target, noise(0.2, 0.05), random);
            pair
        })
        .collect();
        let found = solve(&pairs, cell.mount).expect("solved");
        let off = cell.off(&found);
        assert!(off.shift.mm() < 2.5 && off.rotation.degrees() < 0.2, "{off:?}");
    });
}

#[test]
fn half_turns_about_axes_at_right_angles_alone_have_several_answers() {
    over_cells(10, |cell, random| {
        let half = std::f64::consts::PI;
        let turns = [[0.0, 0.0], [half, 0.0], [0.0, half], [half, half]];
        let pairs: Vec<PosePair> = (0..8)
            .map(|i| {
                let [rx, ry] = turns[i % 4];
                let seen = from_euler_zyx([rx, ry, 0.0, 0.03 * i as f64, 0.1, 1.2]);
                let mut pair = cell.pair(i, seen);
                pair.camera_from_target = disturbed(&seen, noise(0.2, 0.05), random);
                pair
            })
            .collect();
        // Which of the answers comes out is chance, and may be none at all.
        match solve(&pairs, cell.mount) {
            Ok(found) => {
                assert_eq!(found.doubts.first(), Some(&HandEyeDoubt::SeveralAnswers));
            }
            Err(error) => assert_eq!(error, HandEyeError::Unsolvable),
        }
    });
}

/// Pairs that turn about one axis of the flange only.
fn about_one_axis(cell: &TrueCell, axis: Vector3<f64>, num: usize) -> Vec<PosePair> {
    (0..num)
        .map(|i| {
            let angle = 0.25 * i as f64;
            let turn = UnitQuaternion::from_scaled_axis(axis * angle);
            let base = cell.pair(i, from_euler_zyx([0.1, 0.2, 0.3, 0.1 * i as f64, 0.0, 1.2]));
            let flange = Isometry3::from_parts(
                base.robot_from_flange.translation,
                UnitQuaternion::from_euler_angles(0.5, 0.1, -0.8) * turn,
            );
            let carrier = cell.mount.carrier(&flange);
            PosePair {
                robot_from_flange: flange,
                camera_from_target: (carrier * cell.mount_from_camera)
                    .inv_mul(&cell.anchor_from_target),
                ..base
            }
        })
        .collect()
}

#[test]
fn turns_about_one_axis_are_told_with_the_axis() {
    over_cells(10, |cell, _| {
        let found = solve(&about_one_axis(&cell, Vector3::z(), 8), cell.mount).expect("a result");
        let doubt = found.doubts.first().expect("a doubt");
        assert!(matches!(doubt, HandEyeDoubt::OneAxis { .. }), "{doubt}");
        assert!(doubt.to_string().contains("the flange's z axis"), "{doubt}");
        assert!(doubt.advice().contains("another axis"), "{}", doubt.advice());
        assert!(!found.is_usable());
    });
}

#[test]
fn poses_that_hardly_differ_are_told() {
    over_cells(10, |cell, random| {
        let pairs = cell.pairs(8, 0.05, EXACT, random);
        let found = solve(&pairs, cell.mount).expect("a result");
        let is_small = |doubt: &HandEyeDoubt| matches!(doubt, HandEyeDoubt::SmallTurns { .. });
        assert!(found.doubts.iter().any(is_small), "{:?}", found.doubts);
        assert!(!found.is_usable());
    });
    let cell = TrueCell::any(Mount::EyeInHand, &mut Pcg64::seed_from_u64(1));
    let same = vec![cell.pair(1, from_euler_zyx([0.0, 0.0, 0.0, 0.0, 0.0, 1.2])); 5];
    if let Ok(found) = solve(&same, cell.mount) {
        assert!(!found.is_usable());
        assert!(found.bounds.shift.0.is_infinite() || found.bounds.shift.0 < 1e-6);
    }
}

#[test]
fn too_little_travel_and_too_few_pairs_are_told_and_do_not_stop_anything() {
    let mut random = Pcg64::seed_from_u64(3);
    let cell = TrueCell::any(Mount::EyeToHand, &mut random);
    let pairs: Vec<PosePair> = (0..4)
        .map(|i| {
            let turn = any_rotation(&mut random, 0.9);
            cell.pair(i, Isometry3::from_parts(Translation3::new(0.0, 0.0, 1.2), turn))
        })
        .collect();
    let found = solve(&pairs, cell.mount).expect("solved");
    assert!(found.is_usable(), "{:?}", found.doubts);
    let has = |is: fn(&HandEyeDoubt) -> bool| found.doubts.iter().any(is);
    assert!(has(|d| matches!(d, HandEyeDoubt::LittleTravel { .. })));
    assert!(has(|d| matches!(d, HandEyeDoubt::FewPairs { found: 4 })));
    assert_eq!(
        solve(&pairs[..2], cell.mount),
        Err(HandEyeError::TooFewPairs { found: 2 })
    );
}

#[test]
fn a_gross_outlier_is_named_and_nothing_else() {
    over_cells(60, |cell, random| {
        let mut pairs = cell.pairs(10, 0.7, noise(0.5, 0.1), random);
        let wrong = random.random_range(0..10);
        // Another capture's pose of the arm, or a slip of some centimetres.
        let slip = Translation3::new(0.03, -0.02, 0.01);
        pairs[wrong].robot_from_flange = if wrong % 2 == 0 {
            slip * pairs[wrong].robot_from_flange
        } else {
            pairs[wrong].robot_from_flange * any_rotation(random, 0.3)
        };
        if wrong % 2 == 1 {
            pairs[wrong].robot_from_flange = slip * pairs[wrong].robot_from_flange;
        }
        let found = solve(&pairs, cell.mount).expect("solved");
        let named: Vec<&str> = found
            .doubts
            .iter()
            .filter_map(|doubt| match doubt {
                HandEyeDoubt::Suspect { pair, .. } => Some(pair.as_str()),
                _ => None,
            })
            .collect();
        assert_eq!(named, [pairs[wrong].name.as_str()], "{:?}", found.doubts);
        pairs.remove(wrong);
        let without = solve(&pairs, cell.mount).expect("solved");
        assert!(cell.off(&without).shift.mm() < 6.0, "{:?}", cell.off(&without));
        assert!(without.doubts.is_empty(), "{:?}", without.doubts);
    });
}

#[test]
fn sound_pairs_are_not_suspected() {
    let mut suspected = 0;
    over_cells(150, |cell, random| {
        let found = solve(&cell.pairs(12, 0.7, noise(1.0, 0.2), random), cell.mount);
        let found = found.expect("solved");
        let is_suspect = |doubt: &HandEyeDoubt| matches!(doubt, HandEyeDoubt::Suspect { .. });
        suspected += usize::from(found.doubts.iter().any(is_suspect));
        assert!(found.is_usable(), "{:?}", found.doubts);
    });
    assert!(suspected <= 3, "{suspected} of 300");
}

#[test]
fn poses_the_wrong_way_round_are_told() {
    over_cells(20, |cell, random| {
        let sound = cell.pairs(10, 0.7, noise(0.5, 0.1), random);
        let told = |pairs: &[PosePair]| match solve(pairs, cell.mount) {
            Ok(found) => found.doubts.first().cloned(),
            Err(error) => panic!("{error}"),
        };
        for (wrong, expected) in [
            ([true, false], Mistake::RobotInverted),
            ([false, true], Mistake::CameraInverted),
        ] {
            let mut pairs = sound.clone();
            for pair in &mut pairs {
                if wrong[0] {
                    pair.robot_from_flange.inverse_mut();
                }
                if wrong[1] {
                    pair.camera_from_target.inverse_mut();
                }
            }
            let doubt = told(&pairs);
            assert!(
                matches!(doubt, Some(HandEyeDoubt::Mistaken { mistake, .. }) if mistake == expected),
                "{expected:?}: {doubt:?}"
            );
        }
    });
}

#[test]
fn both_poses_the_wrong_way_round_put_something_far_from_the_flange() {
    over_cells(20, |mut cell, random| {
        let far = from_euler_zyx([0.4, 0.2, -1.0, 1.4, -0.6, 0.9]);
        match cell.mount {
            Mount::EyeToHand => cell.mount_from_camera = far,
            Mount::EyeInHand => cell.anchor_from_target = far,
        }
        let mut pairs = cell.pairs(10, 0.7, noise(0.5, 0.1), random);
        assert!(solve(&pairs, cell.mount).expect("solved").is_usable());
        for pair in &mut pairs {
            pair.robot_from_flange.inverse_mut();
            pair.camera_from_target.inverse_mut();
        }
        let found = solve(&pairs, cell.mount).expect("solved");
        assert!(
            matches!(found.doubts.first(), Some(HandEyeDoubt::FarFromFlange { .. })),
            "{:?}",
            found.doubts
        );
    });
}

#[test]
fn lengths_in_another_unit_are_told() {
    over_cells(20, |cell, random| {
        let sound = cell.pairs(10, 0.7, noise(0.5, 0.1), random);
        let scaled = |factor: f64| -> Vec<PosePair> {
            let scale = |pair: &PosePair| {
                let mut pair = pair.clone();
                pair.camera_from_target.translation.vector *= factor;
                pair
            };
            sound.iter().map(scale).collect()
        };
        let first = |pairs: &[PosePair]| solve(pairs, cell.mount).expect("solved").doubts.remove(0);
        let doubt = first(&scaled(0.001));
        assert!(
            matches!(doubt, HandEyeDoubt::Mistaken { mistake: Mistake::CameraInMetres, .. }),
            "{doubt}"
        );
        assert!(matches!(first(&scaled(1000.0)), HandEyeDoubt::FarAway { .. }));
    });
}

#[test]
fn poses_that_do_not_belong_together_are_told() {
    over_cells(20, |cell, random| {
        let mut pairs = cell.pairs(10, 0.7, noise(0.5, 0.1), random);
        // Every robot pose one line too late.
        let first = pairs[0].robot_from_flange;
        for i in 0..9 {
            pairs[i].robot_from_flange = pairs[i + 1].robot_from_flange;
        }
        pairs[9].robot_from_flange = first;
        let found = solve(&pairs, cell.mount).expect("a result");
        assert!(
            matches!(found.doubts.first(), Some(HandEyeDoubt::TurnsDisagree { .. })),
            "{:?}",
            found.doubts
        );
    });
}

#[test]
fn a_number_that_is_not_finite_is_named() {
    let mut random = Pcg64::seed_from_u64(3);
    let cell = TrueCell::any(Mount::EyeToHand, &mut random);
    let mut pairs = cell.pairs(4, 0.7, EXACT, &mut random);
    pairs[2].camera_from_target.translation.vector.x = f64::NAN;
    let pair = pairs[2].name.clone();
    assert_eq!(solve(&pairs, cell.mount), Err(HandEyeError::NotFinite { pair }));
}
