//! Accelerations of joints and rail.

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::*;
use crate::arm::acceleration::check_accelerations;

/// The module's window before and behind a point, seconds.
const WINDOW: f64 = 0.05;

/// An arm that works ahead of itself: reaching over its own back would turn joint 1 to its limit.
fn facing(name: &str) -> PlacedArm {
    let mut placed = with_gun(name);
    placed.arm.limits[0] = [-1.0, 1.0];
    placed
}

/// Points ahead of the arm, from corner to corner in its y-z plane at constant speed, every `step` metres and at each
/// corner.
fn polygon(arm: &PlacedArm, corners: &[[f64; 2]], step: f64, speed: f64) -> Vec<ArmPoint> {
    let point = ArmPoint {
        speed,
        ..row(arm, 1, 0.0)[0]
    };
    let at = |[y, z]: [f64; 2]| ArmPoint {
        robot_from_nozzle: Translation3::new(0.0, y, z) * point.robot_from_nozzle,
        ..point
    };
    let mut points = vec![at(corners[0])];
    for ends in corners.windows(2) {
        let [from, to] = [ends[0], ends[1]];
        let num = ((to[0] - from[0]).hypot(to[1] - from[1]) / step).round();
        points.extend((1..=num as usize).map(|k| {
            let share = k as f64 / num;
            at([0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * share))
        }));
    }
    points
}

/// Across, then up.
const CORNER: [[f64; 2]; 3] = [[-0.2, 0.0], [0.0, 0.0], [0.0, 0.2]];

/// Change of each joint's speed in the corner at 0.3 m/s, rad/s.
fn change_in_corner(arm: &PlacedArm) -> Joints {
    // 2.5 mm before and behind the corner.
    let points = polygon(arm, &CORNER, 0.0025, 0.3);
    let middle = points.len() / 2;
    let found = check(arm, &points);
    let joints = |i: usize| found.points[i].joints.expect("reached");
    let [before, here, behind] = [joints(middle - 1), joints(middle), joints(middle + 1)];
    let time = 0.0025 / 0.3;
    std::array::from_fn(|i| (behind[i] - 2.0 * here[i] + before[i]).abs() / time)
}

fn accelerations(found: &PathCheck) -> Vec<(usize, f64)> {
    let problems = found.points.iter().map(|point| match point.problem {
        Some(PointProblem::JointAcceleration {
            joint,
            acceleration,
            ..
        }) => Some((joint, acceleration)),
        None => None,
        ref other => panic!("{other:?}"),
    });
    problems.flatten().collect()
}

#[test]
fn a_corner_is_too_hard_for_a_joint_however_far_apart_the_points_are() {
    let mut placed = facing("irb2600");
    let wanted = change_in_corner(&placed).map(|change| change / WINDOW);
    let worst = (0..6)
        .max_by(|a, b| wanted[*a].total_cmp(&wanted[*b]))
        .expect("six");
    assert!(wanted[worst] > 1.0, "{wanted:?}");
    // Points 2 to 330 ms apart.
    for step in [0.0005, 0.002, 0.007, 0.014, 0.016, 0.025, 0.1] {
        let points = polygon(&placed, &CORNER, step, 0.3);
        let checked = |share: f64, points: &[ArmPoint]| {
            let mut arm = placed.clone();
            arm.arm.accelerations = Some([share * wanted[worst]; 6]);
            check(&arm, points)
        };
        let none = accelerations(&checked(1.25, &points));
        assert!(none.is_empty(), "{step}: {none:?}");
        let found = checked(0.8, &points);
        let corner = &found.points[points.len() / 2].problem;
        let Some(PointProblem::JointAcceleration {
            joint,
            acceleration,
            limit,
        }) = corner
        else {
            panic!("{step}: {corner:?}");
        };
        assert_eq!(*joint, worst + 1, "{step}");
        assert!((acceleration / wanted[worst] - 1.0).abs() < 0.15, "{step}");
        assert!((limit / wanted[worst] - 0.8).abs() < 1e-9, "{step}");
        // The problem is only around the corner.
        for (checked, point) in found.points.iter().zip(&points) {
            let at = point.robot_from_nozzle.translation.vector
                - points[0].robot_from_nozzle.translation.vector;
            let way = at.y + at.z;
            let is_near = (way - 0.2).abs() < WINDOW * 0.3;
            assert!(is_near || checked.problem.is_none(), "{step}: {way}");
        }
        // The advice helps: a lower speed has no problem.
        let slower = polygon(&placed, &CORNER, step, 0.15);
        let none = accelerations(&checked(0.8, &slower));
        assert!(none.is_empty(), "{step}: {none:?}");
    }
    // So does a round corner.
    let round = (0..=18).map(|k| f64::from(k) * FRAC_PI_2 / 18.0);
    let round = round.map(|angle| [-0.1 + 0.1 * angle.sin(), 0.1 - 0.1 * angle.cos()]);
    let corners: Vec<[f64; 2]> = std::iter::once(CORNER[0])
        .chain(round)
        .chain([CORNER[2]])
        .collect();
    let points = polygon(&placed, &corners, 0.009, 0.3);
    placed.arm.accelerations = Some([0.8 * wanted[worst]; 6]);
    let none = accelerations(&check(&placed, &points));
    assert!(none.is_empty(), "{none:?}");
}

#[test]
fn a_corner_in_which_the_arm_stops_needs_no_acceleration() {
    let mut placed = facing("irb2600");
    let worst = change_in_corner(&placed).into_iter().fold(0.0, f64::max) / WINDOW;
    placed.arm.accelerations = Some([0.8 * worst; 6]);
    // Points 7, 83 and 330 ms apart.
    for step in [0.002, 0.025, 0.1] {
        let mut points = polygon(&placed, &CORNER, step, 0.3);
        let corner = points.len() / 2;
        assert!(
            !accelerations(&check(&placed, &points)).is_empty(),
            "{step}"
        );
        points[corner].is_stop = true;
        let none = accelerations(&check(&placed, &points));
        assert!(none.is_empty(), "{step}: {none:?}");
        points[corner].is_stop = false;
        // A stop more than a window before it or behind it changes nothing.
        let away = (0.02_f64 / step).ceil() as usize;
        for stop in [corner - away, corner + away] {
            let mut points = points.clone();
            points[stop].is_stop = true;
            let found = check(&placed, &points);
            assert!(found.points[corner].problem.is_some(), "{step} {stop}");
            assert_eq!(found.points[stop].problem, None, "{step} {stop}");
        }
    }
}

#[test]
fn between_two_rows_the_arm_slows_down_for_the_corners_and_along_the_rows_it_does_not() {
    let mut placed = facing("irb2600");
    let worst = change_in_corner(&placed).into_iter().fold(0.0, f64::max) / WINDOW;
    placed.arm.accelerations = Some([0.4 * worst; 6]);
    let rows = [[-0.2, 0.0], [0.05, 0.0], [0.05, 0.07], [-0.2, 0.07]];
    // Points 33 and 83 ms apart.
    for step in [0.01, 0.025] {
        let mut points = polygon(&placed, &rows, step, 0.3);
        assert!(check(&placed, &points).num_reached() < points.len());
        let origin = points[0].robot_from_nozzle.translation.vector;
        for point in &mut points {
            // Leads of 50 mm.
            let at = point.robot_from_nozzle.translation.vector - origin;
            point.is_gun_on = at.y < 0.199;
        }
        let found = check(&placed, &points);
        let none = accelerations(&found);
        assert!(none.is_empty(), "{step}: {none:?}");
        assert!(found.changed_moves()[0] >= 2, "{:?}", found.changed_moves());
        for (pair, point) in found.points.windows(2).zip(&points) {
            let Way::Slower(speed) = pair[1].way else {
                continue;
            };
            assert!(!point.is_gun_on && (0.02..0.3).contains(&speed), "{speed}");
        }
    }
}

/// A path around a corner with the gun on up to point `end`; joints have this share of the acceleration that the corner
/// needs, and the film of each way lies at two points of its own and at one of both neighbours.
fn sprayed_corner(share: f64, end: usize) -> (PlacedArm, Vec<ArmPoint>, Films) {
    let mut placed = facing("irb2600");
    let worst = change_in_corner(&placed).into_iter().fold(0.0, f64::max) / WINDOW;
    placed.arm.accelerations = Some([share * worst; 6]);
    let mut points = polygon(&placed, &CORNER, 0.025, 0.3);
    for (i, point) in points.iter_mut().enumerate() {
        point.is_gun_on = i < end;
    }
    let ways = (0..points.len() as u32 - 1).map(|way| (2 * way..2 * way + 3).map(|i| (i, 1e-5)));
    let ways = ways.map(Iterator::collect).collect();
    (placed, points, ways)
}

#[test]
fn a_spraying_gun_slows_down_for_a_corner_as_far_as_its_film_has_room() {
    for share in [0.9, 0.7, 0.5] {
        let (placed, points, ways) = sprayed_corner(share, 16);
        let corner = points.len() / 2;
        let num_points = 2 * points.len();
        let checked = |room: f64| {
            let film = FilmRoom::new(ways.clone(), vec![room; num_points]);
            let params = CheckParams {
                film: Some(&film),
                ..CheckParams::default()
            };
            check_path(&placed, &points, &params).expect("checked")
        };
        let speeds = |found: &PathCheck| -> Vec<f64> {
            let slower = found.points.iter().filter_map(|point| match point.way {
                Way::SlowerSpraying(speed) => Some(speed),
                _ => None,
            });
            slower.collect()
        };
        let found = checked(1.0);
        assert!(accelerations(&found).is_empty(), "{share}: {found:?}");
        let slower = speeds(&found);
        assert!((1..=4).contains(&slower.len()), "{share}: {slower:?}");
        for speed in &slower {
            let wanted = 0.3 * share;
            assert!((0.8 * wanted..0.3).contains(speed), "{share}: {speed}");
        }
        assert_eq!(found.changed_moves(), [0, 0, slower.len()]);
        // Without room no move is slower, and a little room is not used in vain.
        for room in [0.0, 1e-7] {
            let found = checked(room);
            assert_eq!(speeds(&found), Vec::<f64>::new(), "{share} {room}");
            assert_eq!(found.points, check(&placed, &points).points);
            let problem = found.points[corner].problem.as_ref();
            assert!(problem.is_some_and(PointProblem::is_acceleration));
        }
    }
}

#[test]
fn the_ways_to_the_path_and_from_it_are_none_of_its_film() {
    let (placed, mut points, ways) = sprayed_corner(0.8, 16);
    let corner = points.len() / 2;
    // As in a program.
    for end in [0, 16] {
        points[end].is_stop = true;
    }
    // Only the ways before and behind the corner have room.
    let has_room = 2 * corner - 2..=2 * corner + 2;
    let room = (0..2 * points.len()).map(|i| f64::from(u8::from(has_room.contains(&i))));
    let film = FilmRoom::new(ways, room.collect());
    for approach in [None, Some(0.05)] {
        let params = CheckParams {
            film: Some(&film),
            approach,
            ..CheckParams::default()
        };
        let found = check_path(&placed, &points, &params).expect("checked");
        assert!(accelerations(&found).is_empty(), "{approach:?}: {found:?}");
        for (i, point) in found.points.iter().enumerate() {
            let is_next = i == corner || i == corner + 1;
            assert!(is_next || point.way == Way::Planned, "{approach:?} {i}");
        }
    }
}

#[test]
fn where_the_gun_is_switched_in_a_corner_the_move_without_paint_slows_down_alone() {
    // It closes in the corner.
    let (placed, points, _) = sprayed_corner(0.8, 8);
    assert!(points[7].is_gun_on && !points[8].is_gun_on && points.len() == 17);
    let found = check(&placed, &points);
    assert!(accelerations(&found).is_empty(), "{found:?}");
    let [slower, _, spraying] = found.changed_moves();
    assert!(slower >= 1 && spraying == 0);
    assert!(matches!(found.points[9].way, Way::Slower(speed) if speed < 0.3));
}

#[test]
fn points_that_are_close_together_or_at_one_place_are_no_jerk() {
    let mut placed = facing("gp25");
    // Every joint turns evenly over tenths of a second.
    placed.arm.accelerations = Some([1.5; 6]);
    let mut points = polygon(&placed, &[[-0.05, 0.0], [0.05, 0.0]], 0.0002, 0.25);
    // An error of 0.01 mm, which differences of neighbouring points would turn into 60 rad/s².
    let mut random = Pcg64::seed_from_u64(7);
    for point in &mut points {
        let at = &mut point.robot_from_nozzle.translation.vector;
        *at = at.map(|x| x + random.random_range(-1e-5..1e-5));
    }
    // The gun is switched on the spot.
    points.insert(250, points[250]);
    points.insert(120, points[120]);
    let none = accelerations(&check(&placed, &points));
    assert!(none.is_empty(), "{none:?}");
}

#[test]
fn the_arm_takes_its_time_for_a_turn_on_the_spot() {
    let mut placed = facing("irb2600");
    placed.arm.accelerations = Some([2.0; 6]);
    let mut points = polygon(&placed, &[[-0.2, 0.0], [0.2, 0.0]], 0.01, 0.2);
    let middle = points.len() / 2;
    points.insert(middle, points[middle]);
    for point in &mut points[middle + 1..] {
        point.robot_from_nozzle *= UnitQuaternion::from_euler_angles(0.0, 0.0, 0.5);
    }
    let found = check(&placed, &points);
    let joints = [middle, middle + 1].map(|i| found.points[i].joints.expect("reached"));
    let turned = joints[0].iter().zip(&joints[1]);
    assert!(turned.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) > 0.3);
    let none = accelerations(&found);
    assert!(none.is_empty(), "{none:?}");
}

#[test]
fn an_arm_without_limits_is_checked_as_before() {
    let placed = facing("irb2600");
    let points = polygon(&placed, &CORNER, 0.01, 0.3);
    let found = check(&placed, &points);
    let mut limited = placed.clone();
    limited.arm.accelerations = Some([1e3; 6]);
    assert_eq!(check(&limited, &points), found);
    assert_eq!(found.num_reached(), points.len());
}

/// Problems of a rail that stands still and then moves at 0.3 m/s, with points `step` seconds apart.
fn of_rail(limit: f64, step: f64, rail_at: impl Fn(f64) -> f64) -> Vec<Option<PointProblem>> {
    let mut placed = with_gun("irb2600");
    placed.arm.rail = Some(Rail {
        direction: Vector3::y_axis(),
        range: [-1.0, 1.0],
        speed: Some(1.0),
        acceleration: Some(limit),
    });
    let num = (1.0 / step).round() as usize;
    let points = polygon(&placed, &[[0.0, 0.0], [0.3, 0.0]], 0.3 * step, 0.3);
    assert_eq!(points.len(), num + 1);
    let checked = (0..=num).map(|i| PointCheck {
        joints: Some([0.1; 6]),
        rail: rail_at(i as f64 * step),
        ..PointCheck::default()
    });
    let mut checked: Vec<PointCheck> = checked.collect();
    check_accelerations(&placed, &points, &mut checked);
    checked.into_iter().map(|point| point.problem).collect()
}

#[test]
fn a_rail_that_starts_at_once_needs_more_than_one_that_speeds_up() {
    let at_once = |time: f64| 0.3 * (time - 0.5).max(0.0);
    // 0.3 m/s within half the time between the points around it, which is 0.1 s.
    let needs = of_rail(2.9, 0.1, at_once);
    let Some(PointProblem::RailAcceleration {
        acceleration,
        limit,
    }) = needs[5]
    else {
        panic!("{needs:?}");
    };
    assert!((acceleration - 3.0).abs() < 1e-9 && (limit - 2.9).abs() < 1e-12);
    let others = needs.iter().enumerate().filter(|(i, _)| *i != 5);
    assert!(others.map(|(_, problem)| problem).all(Option::is_none));
    assert!(of_rail(3.1, 0.1, at_once).iter().all(Option::is_none));
    let problem = PointProblem::RailAcceleration {
        acceleration: 3.0,
        limit: 2.5,
    };
    assert_eq!(
        problem.to_string(),
        "the rail would need 3000 mm/s² and has 2500"
    );
    assert_eq!(problem.kind(), "rail_acceleration");
    // Half a second from standstill, at 0.6 m/s².
    let ramped = |time: f64| {
        let time = (time - 0.3).max(0.0);
        let ramp = time.min(0.5);
        0.3 * ramp * ramp + 0.3 * (time - ramp)
    };
    for step in [0.01, 0.1] {
        assert!(of_rail(0.61, step, ramped).iter().all(Option::is_none));
        assert!(of_rail(0.59, step, ramped).iter().any(Option::is_some));
    }
}

#[test]
fn a_rail_that_moves_between_two_points_only_has_to_start_and_stop_there() {
    for (way, wanted) in [
        // It accelerates, then slows down, from a window before the first point to a window behind the second.
        (0.1, 4.0 * 0.1 / (0.35 * 0.35)),
        // At its top speed of 1 m/s it takes 0.24 s of the 0.35 s.
        (0.24, 1.0 / (0.35 - 0.24)),
    ] {
        let jump = |time: f64| if time < 0.3 { 0.0 } else { way };
        let found = of_rail(0.99 * wanted, 0.25, jump);
        let Some(PointProblem::RailAcceleration { acceleration, .. }) = found[2] else {
            panic!("{found:?}");
        };
        assert!((acceleration - wanted).abs() < 1e-6, "{acceleration}");
        let others = found.iter().enumerate().filter(|(i, _)| *i != 2);
        assert!(others.map(|(_, problem)| problem).all(Option::is_none));
        let slower = of_rail(1.01 * wanted, 0.25, jump);
        assert!(slower.iter().all(Option::is_none), "{slower:?}");
    }
}

#[test]
fn a_joint_that_cannot_accelerate_is_named_with_its_limit() {
    let problem = PointProblem::JointAcceleration {
        joint: 3,
        acceleration: 20.0_f64.to_radians(),
        limit: 10.0_f64.to_radians(),
    };
    assert_eq!(problem.to_string(), "joint 3 would need 20°/s² and has 10");
    assert_eq!(problem.kind(), "joint_acceleration");
    assert!(problem.is_acceleration() && !PointProblem::OutOfReach.is_acceleration());
}
