mod doubtful;

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use rand::{Rng, RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::*;
use geometry::rigid::from_euler_zyx;

/// Most pairs here are of a marker.
fn solve(pairs: &[PosePair], mount: Mount) -> Result<HandEye, HandEyeError> {
    super::solve(pairs, mount, Target::Marker)
}

/// Standard deviations of the camera's error per axis, metres and radians.
#[derive(Clone, Copy)]
struct Noise {
    shift: f64,
    turn: f64,
}

const EXACT: Noise = Noise {
    shift: 0.0,
    turn: 0.0,
};

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

fn with_noise(pose: &RigidTransform, noise: Noise, random: &mut impl Rng) -> RigidTransform {
    let turn = UnitQuaternion::from_scaled_axis(normals(random, noise.turn));
    let shift = Translation3::from(pose.translation.vector + normals(random, noise.shift));
    Isometry3::from_parts(shift, turn * pose.rotation)
}

/// A cell and its true transforms.
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

    /// The pair for a target pose seen by the camera.
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

    /// Pairs with the target about 1.2 m in front of the camera, turned by up to `most` about any axis.
    fn pairs(&self, num: usize, most: f64, noise: Noise, random: &mut impl Rng) -> Vec<PosePair> {
        (1..=num)
            .map(|number| {
                let x = random.random_range(-0.35..0.35);
                let y = random.random_range(-0.25..0.25);
                let z = random.random_range(0.9..1.5);
                let seen =
                    Isometry3::from_parts(Translation3::new(x, y, z), any_rotation(random, most));
                let mut pair = self.pair(number, seen);
                pair.camera_from_target = with_noise(&seen, noise, random);
                pair
            })
            .collect()
    }

    /// Error of X at a point 1.2 m in front of the camera.
    fn off(&self, found: &HandEye) -> PoseDelta {
        let at = Point3::new(0.0, 0.0, 1.2);
        pose_error(&found.mount_from_camera, &self.mount_from_camera, &at)
    }
}

const MOUNTS: [Mount; 2] = [Mount::EyeToHand, Mount::EyeInHand];

/// Runs `check` over `num` random cells for each mount.
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
            assert!(
                off.shift.0 < 1e-7 && off.rotation.0 < 1e-7,
                "{num}: {off:?}"
            );
            let target = pose_error(
                &found.anchor_from_target,
                &cell.anchor_from_target,
                &Point3::origin(),
            );
            assert!(
                target.shift.0 < 1e-7 && target.rotation.0 < 1e-7,
                "{target:?}"
            );
            assert!(found.residuals.rms.shift.0 < 1e-9);
            // Three poses drawn at random may turn about nearly one axis.
            assert!(num == 3 || found.is_usable(), "{:?}", found.doubts);
        }
    });
}

/// Root mean square and worst error over cells.
fn accuracy(num_pairs: usize, noise: Noise) -> [PoseDelta; 2] {
    let mut all: Vec<PoseDelta> = Vec::new();
    over_cells(100, |cell, random| {
        let pairs = cell.pairs(num_pairs, 0.7, noise, random);
        let found = solve(&pairs, cell.mount).expect("solved");
        assert!(found.is_usable(), "{:?}", found.doubts);
        all.push(cell.off(&found));
    });
    let worst = |figure: fn(&PoseDelta) -> f64| all.iter().map(figure).fold(0.0, f64::max);
    let worst = PoseDelta {
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
        assert!(
            rms.shift.mm() < rms_mm && rms.rotation.degrees() < rms_degrees,
            "{text}"
        );
        assert!(
            worst.shift.mm() < worst_mm && worst.rotation.degrees() < worst_degrees,
            "{text}"
        );
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
        // 95 of 100, less two standard deviations for 300 cells.
        assert!(
            shares.iter().all(|share| *share > 0.925),
            "{num_pairs} pairs: {shares:?}"
        );
        // Bounds must not hold merely by being far too wide.
        assert!(looseness < 12.0, "{num_pairs} pairs: {looseness}");
    }
}

/// Pairs of a part whose outline moves with the view by this many metres for a whole unit.
fn pairs_of_part(cell: &TrueCell, outline: f64, random: &mut Pcg64) -> Vec<PosePair> {
    let mut pairs = cell.pairs(12, 0.6, EXACT, random);
    for pair in &mut pairs {
        let seen = pair.camera_from_target;
        let (normal, ray) = (
            seen.rotation * Vector3::z(),
            seen.translation.vector.normalize(),
        );
        let (along, across) = (normals(random, 0.7e-3), self::normal(random) * 0.15e-3);
        let shift = (normal - ray * normal.dot(&ray)) * outline + along
            - normal * (normal.dot(&along) - across);
        let turn = UnitQuaternion::from_scaled_axis(normals(random, 1e-3));
        pair.camera_from_target = Isometry3::from_parts(
            Translation3::from(seen.translation.vector + shift),
            turn * seen.rotation,
        );
    }
    pairs
}

#[test]
fn an_outline_that_moves_with_the_view_is_in_the_bounds() {
    let part = Target::Part {
        normal: Vector3::z_axis(),
    };
    for outline in [0.0, 0.001, 0.002] {
        let (mut num, mut held) = (0, [0, 0]);
        over_cells(100, |cell, random| {
            let pairs = pairs_of_part(&cell, outline, random);
            let found = super::solve(&pairs, cell.mount, part).expect("solved");
            let off = cell.off(&found);
            num += 1;
            held[0] += usize::from(off.shift <= found.bounds.shift);
            held[1] += usize::from(off.rotation <= found.bounds.turn);
            assert!(found.bounds.shift.mm() < 8.0, "{:?}", found.bounds);
        });
        println!("{outline}: {held:?} of {num} held");
        // 95 of 100, less two standard deviations for 200 cells.
        assert!(held.iter().all(|held| *held >= 184), "{outline}: {held:?}");
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
        closed.push(pose_error(
            &start.mount_from_camera,
            &cell.mount_from_camera,
            &at,
        ));
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
            pair.camera_from_target =
                with_noise(&pair.camera_from_target, noise(0.2, 0.05), random);
            pair
        })
        .collect();
        let found = solve(&pairs, cell.mount).expect("solved");
        let off = cell.off(&found);
        assert!(
            off.shift.mm() < 2.5 && off.rotation.degrees() < 0.2,
            "{off:?}"
        );
    });
}
