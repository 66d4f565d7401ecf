//! Speeds of joints between two points.

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::*;
use crate::arm::{
    chain::nozzle_at,
    way::{WayEnd, way_between, way_problem},
};

/// Two ends of a short move on which the wrist passes its singularity at 3.4°: joint 4 hurries in the middle.
fn beside_singularity(placed: &PlacedArm) -> [WayEnd; 2] {
    let solver = Solver::new(placed, 0.0);
    [-1.0, 1.0].map(|side| {
        let joints = [0.0125 * side, 0.2, 0.3, 1.19 * side, 0.1615, -1.17 * side];
        WayEnd {
            nozzle: solver.forward(&joints).expect("finite"),
            joints,
            rail: 0.0,
        }
    })
}

#[test]
fn a_joint_that_hurries_between_two_points_is_found_with_its_greatest_speed() {
    let placed = placed("irb2600");
    let [start, end] = beside_singularity(&placed);
    let num = 2000;
    let (mut at, mut peak) = (start.joints, 0.0_f64);
    for k in 1..=num {
        let share = f64::from(k) / f64::from(num);
        let next = start.joints_towards(&end, share, &placed, &at);
        let next = next.expect("reached");
        peak = peak.max((next[3] - at[3]).abs() * f64::from(num));
        at = next;
    }
    let mean = (end.joints[3] - start.joints[3]).abs();
    assert!(peak > 1.8 * mean, "{peak} {mean}");
    let way = end.nozzle.translation.vector - start.nozzle.translation.vector;
    let top = placed.arm.speeds[3];
    // The speed of the nozzle at which joint 4 is this much faster than it can be.
    let speed = |share: f64| way.norm() * share * top / peak;
    for share in [0.3, 0.97] {
        assert_eq!(way_problem(&placed, &start, &end, speed(share)), None);
    }
    for share in [1.03, 1.5, 1.9] {
        let problem = way_problem(&placed, &start, &end, speed(share));
        let Some(PointProblem::TooFast { joint: 4, speed }) = problem else {
            panic!("{share}: {problem:?}");
        };
        assert!(
            (speed / (share * top) - 1.0).abs() < 0.06,
            "{share}: {speed}"
        );
    }
    for is_gun_on in [true, false] {
        let point = |end: &WayEnd| ArmPoint {
            robot_from_nozzle: end.nozzle,
            speed: speed(1.5),
            aim: 0.15,
            is_turn_free: false,
            is_gun_on,
            is_stop: false,
        };
        let points = [point(&start), point(&end)];
        let (way, problem) = way_between(&placed, &start, &end, [&points[0], &points[1]]);
        assert_eq!(problem.is_some(), is_gun_on);
        assert_eq!(matches!(way, Way::Slower(_)), !is_gun_on, "{way:?}");
    }
}

/// The greatest speed of a joint during a move that takes a second, as a share of its top speed, from many short steps;
/// `None` if the move is not reached in one configuration within the limits.
fn peak_share(placed: &PlacedArm, start: &WayEnd, end: &mut WayEnd) -> Option<f64> {
    const NUM: u32 = 100;
    let solver = Solver::new(placed, 0.0);
    let (mut at, mut peak) = (start.joints, 0.0_f64);
    for k in 1..=NUM {
        let share = f64::from(k) / f64::from(NUM);
        let next = start.joints_towards(end, share, placed, &at)?;
        let turned = next.iter().zip(at).zip(placed.arm.speeds);
        let shares = turned.map(|((next, at), top)| (next - at).abs() * f64::from(NUM) / top);
        peak = shares.fold(peak, f64::max);
        at = next;
        if solver.beyond_limit(&at).is_some() || solver.singularity(&at).is_some() {
            return None;
        }
    }
    end.joints = at;
    let is_kept = placed.arm.configuration(&at) == placed.arm.configuration(&start.joints);
    is_kept.then_some(peak)
}

#[test]
fn no_joint_that_is_too_fast_anywhere_on_a_move_is_missed_however_short_the_move_is() {
    let mut random = Pcg64::seed_from_u64(14);
    let mut num_checked = 0;
    for name in ["irb2600", "gp25"] {
        let placed = with_gun(name);
        let solver = Solver::new(&placed, 0.0);
        for _ in 0..400 {
            let joints = placed
                .arm
                .limits
                .map(|[low, high]| random.random_range(low.max(-2.5)..high.min(2.5)));
            let mut direction = || random.random_range(-1.0..1.0);
            let (shift, turn) = (
                Vector3::from_fn(|_, _| direction()),
                Vector3::from_fn(|_, _| direction()),
            );
            let length = random.random_range(0.005..0.05);
            let angle = random.random_range(0.0..0.1);
            let nozzle = solver.forward(&joints).expect("finite");
            let start = WayEnd {
                nozzle,
                joints,
                rail: 0.0,
            };
            let mut end = WayEnd {
                nozzle: Isometry3::from_parts(
                    (nozzle.translation.vector + shift.normalize() * length).into(),
                    UnitQuaternion::from_scaled_axis(turn.normalize() * angle) * nozzle.rotation,
                ),
                joints,
                rail: 0.0,
            };
            let Some(peak) = peak_share(&placed, &start, &mut end) else {
                continue;
            };
            let problem = way_problem(&placed, &start, &end, 1.06 * length / peak);
            assert!(problem.is_some(), "{name} {joints:?} {peak}");
            num_checked += 1;
        }
    }
    assert!(num_checked > 500, "{num_checked}");
}

/// A row in whose middle the nozzle leans by 5°, so that joints are too fast on one way; with the film of each way.
fn too_fast(share: f64) -> (PlacedArm, Vec<ArmPoint>, Films) {
    let mut placed = with_gun("irb2600");
    placed.arm.limits[0] = [-1.0, 1.0];
    let mut points = row(&placed, 40, 0.4);
    for point in &mut points[20..] {
        point.robot_from_nozzle = nozzle_at(point, [0.09, 0.0], 0.0);
    }
    placed.arm.speeds = [50.0; 6];
    let found = check(&placed, &points);
    let [from, to] = [19, 20].map(|i| &found.points[i]);
    let joints = [from, to].map(|point| point.joints.expect("reached"));
    let shift = to.robot_from_nozzle.translation.vector - from.robot_from_nozzle.translation.vector;
    let turns = (0..6).map(|i| (joints[1][i] - joints[0][i]).abs());
    let fastest = turns.fold(0.0, f64::max) / (shift.norm() / points[19].speed);
    placed.arm.speeds = [fastest / share; 6];
    let ways = (0..points.len() as u32 - 1).map(|way| (2 * way..2 * way + 3).map(|i| (i, 1e-5)));
    (placed, points, ways.map(Iterator::collect).collect())
}

#[test]
fn a_spraying_gun_too_fast_for_a_joint_slows_down_as_far_as_its_film_has_room() {
    // Twice or four times too fast; the gun slows down to a third at most.
    for (share, is_reached) in [(1.2, true), (2.0, true), (4.0, false)] {
        let (placed, points, ways) = too_fast(share);
        let checked = |room: f64| {
            let film = FilmRoom::new(ways.clone(), vec![room; 2 * points.len()]);
            let params = CheckParams {
                film: Some(&film),
                ..CheckParams::default()
            };
            check_path(&placed, &points, &params).expect("checked")
        };
        let unslowed = check(&placed, &points);
        let problem = &unslowed.points[20].problem;
        assert!(
            matches!(problem, Some(PointProblem::TooFast { .. })),
            "{problem:?}"
        );
        // Without room it keeps its speed, and a little room is not used in vain.
        for room in [0.0, 1e-7] {
            assert_eq!(checked(room), unslowed, "{share} {room}");
        }
        let found = checked(1.0);
        if !is_reached {
            assert_eq!(found, unslowed, "{share}");
            continue;
        }
        assert_eq!(found.points[20].problem, None, "{share}");
        let Way::SlowerSpraying(speed) = found.points[20].way else {
            panic!("{share}: {:?}", found.points[20]);
        };
        let wanted = points[19].speed / share;
        assert!(
            (0.9 * wanted..=wanted * (1.0 + 1e-6)).contains(&speed),
            "{share}: {speed}"
        );
        let others = found.points.iter().enumerate().filter(|(i, _)| *i != 20);
        assert!(
            others
                .map(|(_, point)| point.way)
                .all(|way| way == Way::Planned)
        );
    }
}
