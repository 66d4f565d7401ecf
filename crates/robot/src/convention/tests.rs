use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Quaternion, Translation3, UnitQuaternion};
use proptest::prelude::*;

use super::*;
use crate::{ConventionError, GimbalLock};
use geometry::rigid::RigidTransform;

/// A 3×3 matrix by rows; this reference code shares nothing with the code under test.
type Rows = [[f64; 3]; 3];

fn product(a: Rows, b: Rows) -> Rows {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn about_x(angle: f64) -> Rows {
    let (s, c) = angle.sin_cos();
    [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]
}

fn about_y(angle: f64) -> Rows {
    let (s, c) = angle.sin_cos();
    [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]
}

fn about_z(angle: f64) -> Rows {
    let (s, c) = angle.sin_cos();
    [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]
}

fn of_quaternion([x, y, z, w]: [f64; 4]) -> Rows {
    [
        [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
        ],
        [
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - w * x),
        ],
        [
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        ],
    ]
}

/// The exponential of the cross product's matrix, by its power series (Rodrigues).
fn of_rotation_vector([x, y, z]: [f64; 3]) -> Rows {
    let cross = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    let mut term = about_x(0.0);
    let mut sum = term;
    for n in 1..40 {
        term = product(term, cross).map(|row| row.map(|x| x / f64::from(n)));
        sum = std::array::from_fn(|i| std::array::from_fn(|j| sum[i][j] + term[i][j]));
    }
    sum
}

/// The rotation and the shift in metres that a controller understands by the numbers.
fn understood(convention: Convention, n: &[f64]) -> (Rows, [f64; 3]) {
    let deg = |i: usize| n[i] / 180.0 * PI;
    let mm = || [n[0] / 1000.0, n[1] / 1000.0, n[2] / 1000.0];
    let m = || [n[0], n[1], n[2]];
    match convention {
        Convention::Matrix => {
            assert_eq!(n[12..], [0.0, 0.0, 0.0, 1.0]);
            let rows = [[n[0], n[1], n[2]], [n[4], n[5], n[6]], [n[8], n[9], n[10]]];
            (rows, [n[3], n[7], n[11]])
        }
        Convention::QuaternionXyzw => (of_quaternion([n[3], n[4], n[5], n[6]]), m()),
        Convention::Abb => (of_quaternion([n[4], n[5], n[6], n[3]]), mm()),
        Convention::RotationVector | Convention::UniversalRobots => {
            (of_rotation_vector([n[3], n[4], n[5]]), m())
        }
        // Intrinsic: each turn is about the axes left by the previous turns, so it is further to the right.
        Convention::Kuka => (
            product(product(about_z(deg(3)), about_y(deg(4))), about_x(deg(5))),
            mm(),
        ),
        Convention::Staubli => (
            product(product(about_x(deg(3)), about_y(deg(4))), about_z(deg(5))),
            mm(),
        ),
        Convention::Doosan => (
            product(product(about_z(deg(3)), about_y(deg(4))), about_z(deg(5))),
            mm(),
        ),
        // Extrinsic: each turn is about the fixed axes, so it is further to the left.
        Convention::Fanuc | Convention::Yaskawa => (
            product(about_z(deg(5)), product(about_y(deg(4)), about_x(deg(3)))),
            mm(),
        ),
    }
}

fn pose(q: [f64; 4], [x, y, z]: [f64; 3]) -> RigidTransform {
    let [i, j, k, w] = q;
    let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k));
    RigidTransform::from_parts(Translation3::new(x, y, z), rotation)
}

fn normalised(q: [f64; 4]) -> [f64; 4] {
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    q.map(|x| x / length)
}

fn difference(a: Rows, b: Rows) -> f64 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Writes a rotation in every convention, checks the numbers and reads them back.
fn says_and_reads(q: [f64; 4], shift: [f64; 3]) -> Result<(), TestCaseError> {
    let q = normalised(q);
    let pose = pose(q, shift);
    let expected = of_quaternion(q);
    for convention in Convention::ALL {
        let written = convention.write(&pose);
        let numbers = written.numbers();
        let (rows, at) = understood(convention, &numbers);
        let off = difference(rows, expected);
        prop_assert!(off < 1e-9, "{convention:?}: {numbers:?} is off by {off:e}");
        for (found, expected) in at.iter().zip(shift) {
            prop_assert!(
                (found - expected).abs() < 1e-12,
                "{convention:?}: {numbers:?}"
            );
        }
        let read = convention.read(&numbers).expect("its own numbers");
        let off = (read.to_homogeneous() - pose.to_homogeneous()).amax();
        prop_assert!(off < 1e-9, "{convention:?}: read back off by {off:e}");
        is_in_range(convention, &numbers)?;
    }
    Ok(())
}

/// Checks the ranges that the meaning promises.
fn is_in_range(convention: Convention, n: &[f64]) -> Result<(), TestCaseError> {
    let range = |i: usize, low: f64, high: f64| {
        prop_assert!(
            (low - 1e-9..=high + 1e-9).contains(&n[i]),
            "{convention:?}: {n:?}"
        );
        Ok(())
    };
    match convention {
        Convention::Matrix => Ok(()),
        Convention::QuaternionXyzw => range(6, 0.0, 1.0),
        Convention::Abb => range(3, 0.0, 1.0),
        Convention::RotationVector | Convention::UniversalRobots => {
            let angle = (n[3] * n[3] + n[4] * n[4] + n[5] * n[5]).sqrt();
            prop_assert!(angle <= PI + 1e-12);
            Ok(())
        }
        Convention::Doosan => {
            range(3, -180.0, 180.0)?;
            range(4, 0.0, 180.0)?;
            range(5, -180.0, 180.0)
        }
        Convention::Kuka | Convention::Fanuc | Convention::Yaskawa | Convention::Staubli => {
            range(3, -180.0, 180.0)?;
            range(4, -90.0, 90.0)?;
            range(5, -180.0, 180.0)
        }
    }
}

/// The quaternion of three turns about axes 0..3, by explicit products.
fn turned(turns: [(usize, f64); 3]) -> [f64; 4] {
    turns
        .into_iter()
        .fold([0.0, 0.0, 0.0, 1.0], |[x, y, z, w], (axis, angle)| {
            let mut turn = [0.0; 3];
            turn[axis] = (angle / 2.0).sin();
            let ([a, b, c], d) = (turn, (angle / 2.0).cos());
            [
                w * a + x * d + y * c - z * b,
                w * b - x * c + y * d + z * a,
                w * c + x * b - y * a + z * d,
                w * d - x * a - y * b - z * c,
            ]
        })
}

fn shifts() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-5.0..5.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn every_convention_says_any_pose(
        q in prop::array::uniform4(-1.0..1.0).prop_filter("a rotation", |q: &[f64; 4]| q.iter().map(|x| x * x).sum::<f64>() > 0.01),
        shift in shifts(),
    ) {
        says_and_reads(q, shift)?;
    }

    #[test]
    fn near_gimbal_lock_the_numbers_still_say_the_rotation(
        order in 0..3_usize,
        first in -PI..PI,
        last in -PI..PI,
        side in 0..4_usize,
        exponent in 3.0..12.0_f64,
        shift in shifts(),
    ) {
        // As near as 1e-11, and exactly in gimbal lock at the end of the range.
        let off = if exponent > 11.0 { 0.0 } else { 10_f64.powf(-exponent) };
        let off = if side % 2 == 0 { off } else { -off };
        let (axes, middle) = match (order, side < 2) {
            (0, up) => ([2, 1, 0], if up { FRAC_PI_2 } else { -FRAC_PI_2 }),
            (1, up) => ([0, 1, 2], if up { FRAC_PI_2 } else { -FRAC_PI_2 }),
            (_, up) => ([2, 1, 2], if up { PI } else { 0.0 }),
        };
        let q = turned([(axes[0], first), (axes[1], middle + off), (axes[2], last)]);
        says_and_reads(q, shift)?;
    }

    #[test]
    fn a_half_turn_is_said_about_any_axis(
        axis in prop::array::uniform3(-1.0..1.0).prop_filter("an axis", |a: &[f64; 3]| a.iter().map(|x| x * x).sum::<f64>() > 0.01),
        short in prop::sample::select(vec![0.0, 1e-15, -1e-12, 1e-9, -1e-6]),
        shift in shifts(),
    ) {
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (s, c) = (FRAC_PI_2 + short / 2.0).sin_cos();
        let [x, y, z] = axis.map(|a| a / length * s);
        says_and_reads([x, y, z, c], shift)?;
    }

    #[test]
    fn a_small_turn_does_not_vanish(
        axis in prop::array::uniform3(-1.0..1.0).prop_filter("an axis", |a: &[f64; 3]| a.iter().map(|x| x * x).sum::<f64>() > 0.01),
        exponent in -14.0..-2.0_f64,
    ) {
        let vector = axis.map(|a| a * 10_f64.powf(exponent));
        let pose = Convention::RotationVector.read(&[0.0, 0.0, 0.0, vector[0], vector[1], vector[2]]).expect("a pose");
        let again = Convention::UniversalRobots.write(&pose).numbers();
        for (a, b) in again[3..].iter().zip(vector) {
            prop_assert!((a - b).abs() <= 1e-12 * b.abs() + 1e-17, "{again:?} {vector:?}");
        }
    }

    #[test]
    fn angles_of_any_size_are_read(angles in prop::array::uniform3(-720.0..720.0), shift in shifts()) {
        for convention in [Convention::Kuka, Convention::Fanuc, Convention::Yaskawa, Convention::Staubli, Convention::Doosan] {
            let numbers = [shift[0], shift[1], shift[2], angles[0], angles[1], angles[2]];
            let read = convention.read(&numbers).expect("a pose");
            let (rows, at) = understood(convention, &numbers);
            let matrix = read.to_homogeneous();
            for i in 0..3 {
                for j in 0..3 {
                    prop_assert!((matrix[(i, j)] - rows[i][j]).abs() < 1e-12, "{convention:?}");
                }
                prop_assert!((matrix[(i, 3)] - at[i]).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn gimbal_lock_is_said_and_names_the_angle_set_to_zero() {
    let locked = pose(turned([(2, 0.4), (1, FRAC_PI_2), (0, 0.1)]), [0.0; 3]);
    for (convention, zeroed, index) in [
        (Convention::Kuka, "C", 5),
        (Convention::Fanuc, "W", 3),
        (Convention::Yaskawa, "Rx", 3),
    ] {
        let written = convention.write(&locked);
        assert_eq!(written.gimbal_lock, GimbalLock::Locked, "{convention:?}");
        assert!(written.values[index].value.abs() < 1e-300, "{written:?}");
        let note = written.gimbal_note.expect("a note");
        assert!(
            note.contains(&format!("so {zeroed} was set to 0")),
            "{note}"
        );
    }
    // Doosan's gimbal lock is at the identity.
    let standing = Convention::Doosan.write(&RigidTransform::identity());
    assert_eq!(standing.gimbal_lock, GimbalLock::Locked);
    assert!(
        standing
            .gimbal_note
            .expect("a note")
            .contains("so C was set to 0")
    );
    let near = pose(
        turned([(0, 0.4), (1, FRAC_PI_2 - 0.005), (2, 0.1)]),
        [0.0; 3],
    );
    let near = Convention::Staubli.write(&near);
    assert_eq!(near.gimbal_lock, GimbalLock::Near);
    assert!(near.gimbal_note.expect("a note").contains("rx and rz"));
    for convention in [
        Convention::Matrix,
        Convention::QuaternionXyzw,
        Convention::Abb,
        Convention::UniversalRobots,
    ] {
        assert_eq!(convention.write(&locked).gimbal_lock, GimbalLock::Clear);
    }
    assert_eq!(
        Convention::Staubli.write(&locked).gimbal_lock,
        GimbalLock::Clear
    );
}

#[test]
fn wrong_numbers_are_refused_in_words() {
    let error =
        |convention: Convention, numbers: &[f64]| convention.read(numbers).expect_err("refused");
    let few = error(Convention::Fanuc, &[1.0, 2.0, 3.0]);
    assert_eq!(
        few.to_string(),
        "FANUC W P R has 6 numbers (X Y Z W P R), 3 are given"
    );
    let nan = error(Convention::Kuka, &[0.0, 0.0, 0.0, 0.0, f64::NAN, 0.0]);
    assert!(matches!(nan, ConventionError::NotFinite { name: "B", .. }));
    let long = error(Convention::Abb, &[0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0]);
    assert!(matches!(long, ConventionError::NotUnit { .. }));
    let mut mirrored = [0.0; 16];
    for i in 0..4 {
        mirrored[5 * i] = if i == 2 { -1.0 } else { 1.0 };
    }
    assert_eq!(
        error(Convention::Matrix, &mirrored),
        ConventionError::NotRigid
    );
    let mut projective = mirrored;
    (projective[10], projective[12]) = (1.0, 0.5);
    assert_eq!(
        error(Convention::Matrix, &projective),
        ConventionError::NotRigid
    );
    // Four decimals, as people copy them.
    let copied = Convention::QuaternionXyzw.read(&[0.0, 0.0, 0.0, 0.1, 0.5, -0.7001, 0.5]);
    assert!((copied.expect("a pose").rotation.norm() - 1.0).abs() < 1e-12);
}

#[test]
fn names_are_those_of_the_files() {
    for convention in Convention::ALL {
        assert_eq!(Convention::by_name(convention.name()), Some(convention));
        let json = serde_json::to_string(&convention).expect("JSON");
        assert_eq!(json, format!("\"{}\"", convention.name()));
        assert_eq!(convention.units().len(), convention.names().len());
    }
    assert_eq!(Convention::by_name("KUKA"), None);
}

#[test]
fn a_person_reads_no_minus_before_zero() {
    let nearly = pose([0.0, 0.0, -1e-12, 1.0], [-1e-9, 0.0, 0.0]);
    let line = Convention::Kuka.write(&nearly).line();
    assert_eq!(
        line,
        "X 0.000 mm, Y 0.000 mm, Z 0.000 mm, A 0.0000 deg, B 0.0000 deg, C 0.0000 deg"
    );
}

/// The pose of the table in `assets/conventions.md`.
fn documented() -> RigidTransform {
    pose([0.1, 0.5, -0.7, 0.5], [0.8124, -0.3465, 1.2071])
}

#[test]
fn the_documents_table_is_what_is_written() {
    let document = include_str!("../../../../assets/conventions.md");
    for convention in Convention::ALL {
        let written = convention.write(&documented());
        for line in [
            format!("| `{}` | {} |", convention.name(), written.line()),
            format!(
                "| `{}` | {} | {} |",
                convention.name(),
                convention.title(),
                convention.meaning()
            ),
        ] {
            assert!(
                document.contains(&line),
                "missing in assets/conventions.md:\n{line}"
            );
        }
    }
}
