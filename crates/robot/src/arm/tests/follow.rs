//! Poses one after the other.

use super::*;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

#[test]
fn the_joints_of_a_pose_nearby_are_nearby_and_reach_it() {
    let arm = with_gun("irb4600");
    let mut random = Pcg64::seed_from_u64(4);
    let mut num = 0;
    for _ in 0..200 {
        let mut draw = |size: f64| size * (2.0 * random.random::<f64>() - 1.0);
        let joints = [0.0, 0.3, 0.1, 0.0, -1.0, 0.0].map(|angle| angle + draw(0.4));
        let Some(pose) = arm.nozzle_pose(&joints) else {
            panic!("finite");
        };
        let near = joints.map(|angle| angle + draw(0.05));
        let Ok(found) = arm.joints_near(&pose, &near) else {
            continue;
        };
        num += 1;
        for (found, joint) in found.iter().zip(joints) {
            assert!((found - joint).abs() < 1e-6, "{found} {joint}");
        }
    }
    assert!(num > 150, "{num}");
}

#[test]
fn a_pose_that_the_arm_must_not_take_is_refused_for_its_reason() {
    let arm = with_gun("irb4600");
    let near = [0.0, 0.3, 0.1, 0.0, -1.0, 0.0];
    let far = RigidTransform::translation(5.0, 0.0, 0.0);
    assert_eq!(arm.joints_near(&far, &near), Err(PointProblem::OutOfReach));
    let straight = [0.1, 0.3, 0.1, 0.2, 0.01, 0.3];
    let pose = arm.nozzle_pose(&straight).expect("finite");
    assert!(matches!(
        arm.joints_near(&pose, &straight),
        Err(PointProblem::NearSingularity {
            singularity: Singularity::Wrist
        })
    ));
    let flipped = [0.0, 0.3, 0.1, 0.0, 1.0, 0.0];
    let pose = arm.nozzle_pose(&flipped).expect("finite");
    let mut bent = arm.clone();
    // No solution keeps the configuration of the wrist.
    bent.arm.limits[4] = [0.1, 2.0];
    let refused = bent.joints_near(&pose, &near);
    assert_eq!(refused, Err(PointProblem::ConfigurationChange));
    let mut narrow = arm.clone();
    narrow.arm.limits[1] = [-0.1, 0.1];
    let pose = arm.nozzle_pose(&near).expect("finite");
    assert!(arm.joints_near(&pose, &near).is_ok());
    let refused = narrow.joints_near(&pose, &near);
    assert!(
        matches!(refused, Err(PointProblem::JointLimit { joint: 2, .. })),
        "{refused:?}"
    );
    let wall: Vec<_> = (-20..=20)
        .flat_map(|y| (-20..=20).map(move |z| Point3::new(0.01, 0.02 * y as f32, 0.02 * z as f32)))
        .collect();
    let blocked = arm.clone().with_part(&wall, &pose);
    assert!(matches!(
        blocked.joints_near(&pose, &near),
        Err(PointProblem::Collision { .. })
    ));
    let tool = geometry::segment::Segment {
        from: pose * Point3::new(0.2, 0.0, 0.0),
        to: pose * Point3::new(0.1, 0.0, 0.0),
    };
    let nearest = |radius| blocked.obstacles.nearest_to_tool(&tool, radius);
    assert_eq!((nearest(0.02), nearest(0.07)), (None, Some(Obstacle::Part)));
}
