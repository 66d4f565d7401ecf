//! Gun and arm against boxes of the cell.

use std::fmt::Write as _;

use nalgebra::Point3;

use super::*;

/// The same arm among boxes, each given by name, middle and edge in metres.
pub(super) fn among(placed: &PlacedArm, boxes: &[(&str, Point3<f64>, f64)]) -> PlacedArm {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("boxes.toml");
    let mut text = String::new();
    for (name, at, edge) in boxes {
        let [x, y, z] = [at.x, at.y, at.z].map(|x| 1000.0 * x);
        let edge = 1000.0 * edge;
        writeln!(text, "[[box]]\nname = \"{name}\"").expect("written");
        writeln!(text, "centre_mm = [{x:.6}, {y:.6}, {z:.6}]").expect("written");
        writeln!(text, "size_mm = [{edge:.3}, {edge:.3}, {edge:.3}]").expect("written");
    }
    std::fs::write(&path, text).expect("written");
    PlacedArm {
        obstacles: Obstacles::read(&path).expect("boxes"),
        ..placed.clone()
    }
}

/// End of the gun's axis with these joints; it is farther from the wrist than the gun is wide.
fn end_of_gun(placed: &PlacedArm, joints: &Joints) -> Point3<f64> {
    let [gun, ..] = Solver::new(placed, 0.0).bodies(joints);
    gun.axis.to
}

/// Position of the elbow with these joints.
pub(super) fn elbow(placed: &PlacedArm, joints: &Joints) -> Point3<f64> {
    let [.., upper_arm] = Solver::new(placed, 0.0).bodies(joints);
    upper_arm.axis.to
}

fn gun_at(name: &str) -> PointProblem {
    PointProblem::Collision {
        body: Body::Gun,
        obstacle: Obstacle::Box(name.into()),
    }
}

#[test]
fn a_box_beside_the_gun_is_run_into_as_far_as_gun_and_clearance_reach() {
    let placed = with_gun("irb2600");
    let points = row(&placed, 60, 0.3);
    let free = check_unturned(&placed, &points);
    assert_eq!(free.num_collisions(), 0);
    // Beside the point, so that none is exactly at the clearance.
    let end = end_of_gun(&placed, &free.points[30].joints.expect("reached"));
    let end = end + Vector3::new(0.0, 0.002, 0.0);
    let blocked = among(&placed, &[("post", end, 0.02)]);
    let found = check_unturned(&blocked, &points);
    for (checked, point) in found.points.iter().zip(&points) {
        // The gun's own 50 mm, 20 of clearance and half the box.
        let aside = (point.robot_from_nozzle.translation.vector.y - end.y).abs();
        if (aside - 0.08).abs() < 1e-3 {
            continue;
        }
        let wanted = (aside < 0.08).then(|| gun_at("post"));
        assert_eq!(checked.problem, wanted, "{aside}");
    }
    assert_eq!(found.num_reached() + found.num_collisions(), 60);
    let doubt = found.missed("arm").expect("collides").to_string();
    assert!(doubt.contains(&format!(
        "{} of them because it would collide",
        found.num_collisions()
    )));
    let problem = gun_at("post");
    assert_eq!(problem.to_string(), "gun too near to the box post");
    assert_eq!(problem.kind(), "collision");
    // A wider clearance finds more.
    let mut wider = blocked.clone();
    wider.obstacles.clearance = 0.06;
    assert!(check_unturned(&wider, &points).num_collisions() > found.num_collisions() + 10);
    // The order of the boxes changes nothing.
    let twin = ("twin", end, 0.02);
    let post = ("post", end, 0.02);
    assert_eq!(
        check_unturned(&among(&placed, &[post, twin]), &points),
        check_unturned(&among(&placed, &[twin, post]), &points)
    );
}

#[test]
fn what_lies_between_two_points_is_run_into_on_the_way() {
    let placed = with_gun("irb2600");
    // Half a metre to the left.
    let points = row(&placed, 2, 1.0);
    let free = check(&placed, &points);
    assert_eq!(free.num_reached(), 2, "{free:?}");
    let begins = end_of_gun(&placed, &free.points[0].joints.expect("reached"));
    let half_way = begins + Vector3::new(0.0, 0.25, 0.0);
    let found = check(&among(&placed, &[("post", half_way, 0.02)]), &points);
    assert_eq!(found.points[0].problem, None);
    assert_eq!(found.points[1].problem, Some(gun_at("post")));
    // A box behind both points is not hit.
    let aside = begins - Vector3::new(0.0, 0.25, 0.0);
    let found = check(&among(&placed, &[("post", aside, 0.02)]), &points);
    assert_eq!(found.num_reached(), 2, "{found:?}");
}

#[test]
fn a_free_configuration_is_preferred_to_one_that_collides() {
    let mut placed = with_gun("irb2600");
    // All eight configurations are within the limits.
    placed.arm.limits = [[-4.0, 4.0]; 6];
    let points = row(&placed, 60, 0.3);
    let free = check(&placed, &points);
    assert_eq!(free.num_reached(), 60, "{free:?}");
    let former = free.points[30].joints.expect("reached");
    let blocked = among(&placed, &[("lamp", elbow(&placed, &former), 0.1)]);
    let solver = Solver::new(&blocked, 0.0);
    assert!(free.points.iter().all(|point| {
        let joints = point.joints.expect("reached");
        solver.collides(&joints)
    }));
    let found = check(&blocked, &points);
    assert_eq!(found.num_reached(), 60, "{found:?}");
    let joints = found.points[30].joints.expect("reached");
    let folds = |joints: &Joints| blocked.arm.configuration(joints);
    assert_ne!(folds(&joints), folds(&former));

    // If none is left, the point is reached, but with a collision.
    let mut bound = with_gun("irb2600");
    bound.arm.limits[0] = [-1.0, 1.0];
    let only = check(&bound, &points).points[30].joints.expect("reached");
    let bound = among(&bound, &[("lamp", elbow(&bound, &only), 0.1)]);
    let found = check(&bound, &points);
    assert_eq!(found.num_collisions(), 60, "{found:?}");
    assert!(found.points.iter().all(|point| point.joints.is_some()));
}

#[test]
fn the_gun_collides_alike_with_all_joints_that_hold_the_nozzle_in_one_pose() {
    for name in ARM_NAMES {
        let placed = with_gun(name);
        let points = row(&placed, 12, 0.3);
        let free = check(&placed, &points);
        let end = end_of_gun(&placed, &free.points[6].joints.expect("reached"));
        let blocked = among(&placed, &[("post", end, 0.02)]);
        let solver = Solver::new(&blocked, 0.0);
        let mut num_colliding = 0;
        for point in &points {
            let collides = solver.gun_collides(&point.robot_from_nozzle);
            num_colliding += usize::from(collides);
            for joints in solver.solutions(&point.robot_from_nozzle, None) {
                let gun_and_wrist = &solver.bodies(&joints)[..2];
                let is_hit = blocked.obstacles.are_hit_by(gun_and_wrist);
                assert_eq!(is_hit, collides, "{name}");
                let is_any = collides || solver.arm_collides(&joints);
                assert_eq!(solver.collides(&joints), is_any, "{name}");
            }
        }
        assert!((1..12).contains(&num_colliding), "{name}: {num_colliding}");
    }
}

#[test]
fn where_every_tilt_collides_the_nozzle_is_not_tilted_and_no_place_is_examined() {
    let placed = with_gun("irb2600");
    let mut points = row(&placed, 60, 0.3);
    for point in &mut points {
        point.is_turn_free = true;
    }
    let blocked = among(&placed, &[("hall", Point3::origin(), 20.0)]);
    let may_tilt = CheckParams {
        max_tilt: 0.17,
        ..CheckParams::default()
    };
    let found = check_path(&blocked, &points, &may_tilt).expect("checked");
    assert_eq!(found.num_collisions(), 60);
    assert_eq!(found, check(&blocked, &points));
    let examined = |_, _| panic!("no place helps");
    let found = suggest_base(&blocked, &points, &may_tilt, 0, &examined, &|| false);
    assert_eq!(found.expect("searched"), None);
}
