//! Speeds of joints between two points.

use super::*;
use crate::arm::way::{WayEnd, way_between, way_problem};

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
