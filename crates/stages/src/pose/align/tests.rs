use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::*;
use crate::pose::PoseWarning;
use geometry::{
    fixtures::moved,
    rigid::{from_euler_zyx, pose_error},
};

/// A bent sheet with a notch: nothing about it is symmetric, and its points lie on no lattice that could slide
/// onto itself.
fn sheet() -> PointCloud {
    let mut rng = Pcg64::seed_from_u64(7);
    let points: Vec<Point3<f32>> = (0..5000)
        .map(|_| (rng.random::<f32>(), 0.8 * rng.random::<f32>()))
        .filter(|(u, v)| !(*u > 0.6 && *v > 0.5))
        .map(|(u, v)| Point3::new(u, v, 0.3 * u * u + 0.1 * (5.0 * v).sin() * u))
        .collect();
    PointCloud::from_points(points)
}

#[test]
fn a_displaced_copy_is_found_from_anywhere_both_ways_round() {
    let target = sheet();
    for start in [
        [1.57, 0.0, 0.0, 0.8, 0.0, 0.5],
        [3.1, 1.2, -2.0, -0.4, 0.7, 0.1],
        [0.2, -1.4, 2.9, 0.1, -0.6, 2.0],
    ] {
        let truth = from_euler_zyx(start);
        for truth in [truth, truth.inverse()] {
            let source = moved(&target, &truth.inverse());
            let found = align(&source, &target, PoseMethod::Global, None).expect("a pose");
            let centre = truth.inverse() * Point3::new(0.5, 0.3, 0.1);
            let error = pose_error(&found.target_from_source, &truth, &centre);
            assert!(
                error.rotation.degrees() < 0.01 && error.shift.mm() < 0.1,
                "{error:?} from {start:?}"
            );
            assert!(!found.is_ambiguous());
        }
    }
}

#[test]
fn the_same_clouds_give_the_same_bits() {
    let target = sheet();
    let source = moved(&target, &from_euler_zyx([0.4, 0.3, -1.0, 0.1, 0.2, 0.3]));
    let run = || align(&source, &target, PoseMethod::Global, None).expect("a pose");
    assert_eq!(run(), run());
}

#[test]
fn clouds_far_from_the_origin_are_aligned_as_long_as_their_coordinates_resolve_them() {
    let target = sheet();
    for far in [1e3, 5e3, -5e3] {
        let truth = from_euler_zyx([0.4, 0.3, -1.0, far, 0.2, 0.3]);
        let far_off = moved(&target, &truth);
        for (source, target, truth) in [
            (&target, &far_off, truth),
            (&far_off, &target, truth.inverse()),
        ] {
            let found = align(source, target, PoseMethod::Global, None).expect("a pose");
            let centre = Point3::from(source.points[0].coords.cast::<f64>());
            let error = pose_error(&found.target_from_source, &truth, &centre);
            assert!(
                error.rotation.degrees() < 0.1 && error.shift.mm() < 2.0,
                "{error:?} at {far}"
            );
        }
    }
    let lost = moved(&target, &RigidTransform::translation(1e6, 0.0, 0.0));
    for method in [PoseMethod::Global, PoseMethod::Icp, PoseMethod::IcpGa] {
        let found = align(&target, &lost, method, None);
        assert!(
            matches!(
                found,
                Err(PoseError::TooFarOut {
                    which: CloudRole::Target,
                    ..
                })
            ),
            "{found:?}"
        );
    }
}

#[test]
fn millimetres_against_metres_are_named() {
    let target = sheet();
    let in_mm = PointCloud::from_points(target.points.iter().map(|p| p * 1000.0));
    for (a, b) in [(&target, &in_mm), (&in_mm, &target)] {
        assert!(matches!(
            align(a, b, PoseMethod::Global, None),
            Err(PoseError::SizesDiffer { .. })
        ));
    }
}

#[test]
fn a_poor_fit_raises_a_doubt_and_a_good_one_none() {
    let target = sheet();
    let source = moved(&target, &from_euler_zyx([0.4, 0.3, -1.0, 0.1, 0.2, 0.3]));
    let good = align(&source, &target, PoseMethod::Global, None).expect("a pose");
    assert_eq!(good.doubt(), None);
    let mut rng = Pcg64::seed_from_u64(3);
    let cube = PointCloud::from_points(
        (0..5000).map(|_| Point3::from([(); 3].map(|()| rng.random::<f32>()))),
    );
    let poor = align(&cube, &target, PoseMethod::Global, None).expect("a pose");
    assert!(poor.doubt().is_some(), "{:?}", poor.fit);
}

/// A surface: a point for every two numbers from 0 to 1.
type Shape = fn(f32, f32) -> [f32; 3];

/// Points drawn anew over a surface.
fn surface(seed: u64, at: Shape) -> PointCloud {
    let mut rng = Pcg64::seed_from_u64(seed);
    let points = (0..4000).map(|_| Point3::from(at(rng.random(), rng.random())));
    PointCloud::from_points(points)
}

#[test]
fn what_fits_in_many_places_is_doubted_and_never_sure() {
    use std::f32::consts::TAU;
    let plate: Shape = |u, v| [u, 0.6 * v, 0.0];
    let square: Shape = |u, v| [u, v, 0.0];
    let disc: Shape = |u, v| [v.sqrt() * (TAU * u).cos(), v.sqrt() * (TAU * u).sin(), 0.0];
    let tube: Shape = |u, v| [2.0 * v, 0.3 * (TAU * u).cos(), 0.3 * (TAU * u).sin()];
    let ball: Shape = |u, v| {
        let (z, turn) = (2.0 * v - 1.0, TAU * u);
        let r = (1.0 - z * z).sqrt();
        [r * turn.cos(), r * turn.sin(), z]
    };
    let shapes = [
        ("plate", plate),
        ("square", square),
        ("disc", disc),
        ("tube", tube),
        ("ball", ball),
    ];
    let displaced = from_euler_zyx([0.4, 0.3, -1.0, 0.1, 0.2, 0.3]);
    for (name, shape) in shapes {
        let (target, source) = (surface(1, shape), moved(&surface(2, shape), &displaced));
        for method in [PoseMethod::Global, PoseMethod::Icp, PoseMethod::IcpGa] {
            let pose = align(&source, &target, method, None).expect("a pose");
            let doubt = pose.doubt();
            assert!(doubt.is_some(), "{name} by {method:?}: {pose:?}");
            if method == PoseMethod::Global {
                let fits = matches!(
                    doubt,
                    Some(PoseWarning::Ambiguous { .. } | PoseWarning::Loose { .. })
                );
                assert!(fits, "{name}: {doubt:?}");
            }
        }
    }
}

#[test]
fn a_flat_plate_is_held_by_its_borders_alone() {
    let mut rng = Pcg64::seed_from_u64(11);
    let mut plate = |num: usize| {
        let mut noise = || 0.004 * (rng.random::<f32>() - 0.5);
        let noises: Vec<[f32; 3]> = (0..num).map(|_| [(); 3].map(|()| noise())).collect();
        let places = (0..num).map(|_| (1.2 * rng.random::<f32>(), 0.7 * rng.random::<f32>()));
        let points = places
            .zip(noises)
            .filter(|((x, y), _)| !(*x > 0.8 && *y > 0.4));
        PointCloud::from_points(points.map(|((x, y), [a, b, c])| Point3::new(x + a, y + b, c)))
    };
    let target = plate(12_000);
    for start in [
        [1.57, 0.0, 0.0, 0.8, 0.0, 0.5],
        [3.1, 1.2, -2.0, -0.4, 0.7, 0.1],
        [0.2, -1.4, 2.9, 0.1, -0.6, 2.0],
    ] {
        let truth = from_euler_zyx(start);
        let source = moved(&plate(6_000), &truth.inverse());
        let found = align(&source, &target, PoseMethod::Global, None).expect("a pose");
        let middle = truth.inverse() * Point3::new(0.6, 0.3, 0.0);
        let error = pose_error(&found.target_from_source, &truth, &middle);
        assert!(
            error.rotation.degrees() < 0.5 && error.shift.mm() < 3.0,
            "{error:?} from {start:?}"
        );
    }
}

#[test]
fn a_piece_of_a_cloud_of_few_points_is_put_back() {
    let target = PointCloud::from_points(sheet().points.into_iter().step_by(12));
    for start in [
        [3.1, 1.2, -2.0, -0.4, 0.7, 0.1],
        [0.2, -1.4, 2.9, 0.1, -0.6, 2.0],
    ] {
        let truth = from_euler_zyx(start);
        let mut source = moved(&target, &truth.inverse());
        // Without the end of the sheet.
        let keep = |p: &Point3<f32>| (truth * p.cast::<f64>()).x < 0.75;
        source.points.retain(keep);
        let found = align(&source, &target, PoseMethod::Global, None).expect("a pose");
        let centre = truth.inverse() * Point3::new(0.4, 0.3, 0.1);
        let error = pose_error(&found.target_from_source, &truth, &centre);
        assert!(
            error.rotation.degrees() < 0.1 && error.shift.mm() < 1.0,
            "{error:?} {:?}",
            found.doubt()
        );
    }
}

#[test]
fn clouds_that_do_not_meet_have_no_pose() {
    let target = sheet();
    let far = RigidTransform::translation(40.0, 0.0, 0.0);
    let found = align(&target, &target, PoseMethod::Global, Some(far));
    assert!(
        matches!(found, Err(PoseError::NoOverlap { .. })),
        "{found:?}"
    );
}

#[test]
fn a_prepared_target_gives_the_same_bits() {
    let target = sheet();
    let source = moved(&target, &from_euler_zyx([0.4, 0.3, -1.0, 0.1, 0.2, 0.3]));
    let prepared = PreparedTarget::new(&target).expect("spans");
    for method in PoseMethod::ALL {
        let again = align_to(&source, &prepared, &method.into(), None, &|| false);
        assert_eq!(again, align(&source, &target, method, None));
    }
}

#[test]
fn bounds_hold_the_truth_and_follow_the_noise() {
    let mut rng = Pcg64::seed_from_u64(5);
    let mut noisy = |noise: f32| {
        let mut cloud = sheet();
        for p in &mut cloud.points {
            p.z += noise * (rng.random::<f32>() + rng.random::<f32>() - 1.0);
        }
        cloud
    };
    let truth = from_euler_zyx([0.4, 0.3, -1.0, 0.1, 0.2, 0.3]);
    let mut bound = |noise: f32| {
        let target = noisy(noise);
        let source = moved(&noisy(noise), &truth.inverse());
        let pose = align(&source, &target, PoseMethod::Global, None).expect("a pose");
        let middle = truth.inverse() * Point3::new(0.5, 0.3, 0.1);
        let error = pose_error(&pose.target_from_source, &truth, &middle);
        let bounds = pose.uncertainty.expect("refined to the end");
        // The bounds hold in 95 of 100 cases: twice as far is as good as never.
        assert!(error.shift.0 < 2.0 * bounds.shift.0, "{error:?} {bounds:?}");
        assert!(
            error.rotation.0 < 2.0 * bounds.turn.0,
            "{error:?} {bounds:?}"
        );
        bounds.shift.0
    };
    // The borders are never better known than their points are apart, however quiet those are.
    let (quiet, loud) = (bound(0.001), bound(0.008));
    assert!((2.0..30.0).contains(&(loud / quiet)), "{quiet} {loud}");
}

#[test]
fn clouds_that_fix_no_pose_get_a_named_error() {
    let sheet = sheet();
    let line = PointCloud::from_points((0..100).map(|i| Point3::new(i as f32, 0.0, 0.0)));
    let spot = PointCloud::from_points((0..100).map(|_| Point3::new(1.0, 2.0, 3.0)));
    let few = PointCloud::from_points((0..3).map(|i| Point3::new(i as f32, (i * i) as f32, 0.0)));
    let empty = PointCloud::default();
    for method in [PoseMethod::Global, PoseMethod::Icp, PoseMethod::IcpGa] {
        for bad in [&line, &spot] {
            assert!(matches!(
                align(bad, &sheet, method, None),
                Err(PoseError::Degenerate {
                    which: CloudRole::Source,
                    ..
                })
            ));
            assert!(matches!(
                align(&sheet, bad, method, None),
                Err(PoseError::Degenerate {
                    which: CloudRole::Target,
                    ..
                })
            ));
        }
        for bad in [&few, &empty] {
            assert!(matches!(
                align(bad, &sheet, method, None),
                Err(PoseError::TooFewPoints {
                    which: CloudRole::Source,
                    ..
                })
            ));
            assert!(matches!(
                align(&sheet, bad, method, None),
                Err(PoseError::TooFewPoints {
                    which: CloudRole::Target,
                    ..
                })
            ));
        }
    }
}
