//! Tilts that change evenly where joints cannot follow.

use inspection::library::{PathPoint, SprayPath};
use nalgebra::Unit;

use super::*;
use crate::{
    arm::chain::nozzle_at,
    paint::{Coat, PaintSurface, simulate},
};
use stages::reference::Coverage;

const MAX_TILT: f64 = 10.0 * PI / 180.0;

/// 80 points, 5 mm and 17 ms apart, of which those from 40 on lean by 5°. Joints accelerate by this much at most, rad/s².
fn bend(acceleration: f64) -> (PlacedArm, Vec<ArmPoint>) {
    let mut placed = with_gun("irb2600");
    placed.arm.limits[0] = [-1.0, 1.0];
    placed.arm.accelerations = Some([acceleration; 6]);
    let mut points = row(&placed, 80, 0.4);
    for point in &mut points[40..] {
        point.robot_from_nozzle = nozzle_at(point, [0.5 * MAX_TILT, 0.0], 0.0);
    }
    (placed, points)
}

fn check_tilted(placed: &PlacedArm, points: &[ArmPoint], max_tilt: f64) -> PathCheck {
    let params = CheckParams {
        max_tilt,
        ..CheckParams::default()
    };
    check_path(placed, points, &params).expect("checked")
}

/// Indices of the points that are missed.
fn missed(found: &PathCheck) -> Vec<usize> {
    let all = found.points.iter().enumerate();
    let missed = all.filter(|(_, point)| point.problem.is_some());
    missed.map(|(i, _)| i).collect()
}

#[test]
fn a_bend_that_joints_cannot_follow_is_spread_over_the_points_around_it() {
    let (placed, points) = bend(5.0);
    let upright = check_tilted(&placed, &points, 0.0);
    let bad = missed(&upright);
    assert!(
        !bad.is_empty() && bad.iter().all(|i| (36..44).contains(i)),
        "{bad:?}"
    );
    for max_tilt in [MAX_TILT, 0.5 * MAX_TILT] {
        let found = check_tilted(&placed, &points, max_tilt);
        assert_eq!(missed(&found), [0; 0], "{max_tilt}");
        let (num, most) = found.tilted().expect("tilted");
        assert!((4..=24).contains(&num), "{num}");
        assert!(most <= max_tilt + 1e-9, "{most}");
        let aim = Translation3::new(0.0, 0.0, points[0].aim);
        for (pair, wanted) in found.points.windows(2).zip(&points) {
            // The candidates' tilts are at least 2.5° apart.
            let turn = pair[0].robot_from_nozzle.rotation;
            let turn = turn.angle_to(&pair[1].robot_from_nozzle.rotation);
            assert!(turn < 2.4_f64.to_radians(), "{turn}");
            // The jet stays where it is.
            let aims = [pair[0].robot_from_nozzle, wanted.robot_from_nozzle];
            let aims = aims.map(|nozzle| (nozzle * aim).translation.vector);
            assert!((aims[0] - aims[1]).norm() < 1e-9);
        }
        // Points farther away stay as they are.
        assert_eq!(found.points[..28], upright.points[..28]);
        assert_eq!(found.points[52..], upright.points[52..]);
        assert_eq!(check_tilted(&placed, &points, max_tilt), found);
    }
}

#[test]
fn no_point_is_given_up_for_another_and_a_bend_that_needs_more_keeps_what_helps() {
    let mut num_less = 0;
    for acceleration in [0.5, 1.0, 2.0, 4.0, 8.0] {
        let (placed, points) = bend(acceleration);
        let upright = missed(&check_tilted(&placed, &points, 0.0));
        for max_tilt in [0.01, 0.03, MAX_TILT] {
            let found = check_tilted(&placed, &points, max_tilt);
            let most = found.tilted().map_or(0.0, |(_, most)| most);
            assert!(most <= max_tilt + 1e-9, "{acceleration} {max_tilt}: {most}");
            let bad = missed(&found);
            assert!(
                bad.iter().all(|i| upright.contains(i)),
                "{acceleration} {max_tilt}"
            );
            num_less += usize::from(bad.len() < upright.len());
        }
    }
    assert!(num_less >= 3, "{num_less}");
}

#[test]
fn where_no_tilt_helps_the_nozzle_stays_upright() {
    // Even along the row joints accelerate more.
    let (placed, points) = bend(1e-4);
    let upright = check_tilted(&placed, &points, 0.0);
    assert!(missed(&upright).len() > 60);
    assert_eq!(check_tilted(&placed, &points, MAX_TILT), upright);
}

#[test]
fn the_film_of_a_path_with_smoothed_tilts_stays_within_the_tolerance() {
    let (placed, points) = bend(5.0);
    let coat = Coat::default();
    // A plate where the nozzle aims.
    let first = points[0].robot_from_nozzle * Point3::new(0.0, 0.0, points[0].aim);
    let place = |i: usize| 0.01 * i as f64;
    let plate: Vec<Point3<f64>> = (0..60 * 40)
        .map(|i| first + Vector3::new(0.0, place(i % 60) - 0.1, place(i / 60) - 0.2))
        .collect();
    let normals = vec![-Vector3::x(); plate.len()];
    let surface = PaintSurface::new(&plate, &normals, Coverage::OneSide, None).expect("a plate");
    let film = |found: &PathCheck| {
        let each = found.points.iter().zip(&points).map(|(found, point)| {
            let nozzle = found.robot_from_nozzle;
            PathPoint {
                nozzle: Point3::from(nozzle.translation.vector),
                direction: Unit::new_normalize(nozzle * Vector3::z()),
                stand_off: None,
                is_gun_on: true,
                fan: Some(Unit::new_normalize(nozzle * Vector3::x())),
                speed: Some(point.speed),
            }
        });
        let path = SprayPath::new(each.collect()).expect("points");
        simulate(&surface, &path, &coat, &[])
            .expect("simulated")
            .thickness
    };
    let [upright, tilted] = [0.0, MAX_TILT].map(|tilt| film(&check_tilted(&placed, &points, tilt)));
    let most = upright.iter().copied().fold(0.0, f64::max);
    assert!(most > 0.3 * coat.target, "{most}");
    let change = upright.iter().zip(&tilted).map(|(a, b)| (a - b).abs());
    let change = change.fold(0.0, f64::max);
    assert!(
        change > 0.0 && change < coat.tolerance * most,
        "{change} of {most}"
    );
}
