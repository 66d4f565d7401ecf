//! Pairs of scans with published poses, aligned without an initial pose.

use nalgebra::{Isometry3, Matrix3, Point3, Quaternion, Rotation3, Translation3, UnitQuaternion};
use partsight::{
    files::{FileContent, open},
    geometry::{
        cloud::PointCloud,
        rigid::{PoseDelta, RigidTransform, pose_error},
    },
    stages::pose::{PoseEstimate, PoseMethod, align},
};

use crate::data_folder;

fn aligned(source: &str, target: &str) -> Option<PoseEstimate> {
    let folder = data_folder()?.join("registration");
    let cloud = |name: &str| -> PointCloud {
        match open(&folder.join(name)) {
            Ok(FileContent::Cloud(cloud)) => cloud,
            other => panic!("{name}: expected a cloud, got {other:?}"),
        }
    };
    Some(align(&cloud(source), &cloud(target), PoseMethod::Global, None).expect("a pose"))
}

#[expect(clippy::print_stderr, reason = "the figures are worth reading")]
fn report(what: &str, estimate: &PoseEstimate, error: &PoseDelta) {
    eprintln!(
        "{what} by {}: off by {} and {}",
        estimate.method.name(),
        error.rotation,
        error.shift
    );
}

#[test]
fn two_scans_of_the_bunny_meet_within_two_degrees_and_two_millimetres() {
    // bun.conf: bun000 is the world, bun045 has this translation and quaternion (x y z w). The program that wrote the
    // file rotates points by the inverse of the quaternion.
    let turn = Quaternion::new(0.955_586, 0.005_484_49, -0.294_635, -0.003_855_5).conjugate();
    let world_from_045 = Isometry3::from_parts(
        Translation3::new(-0.052_021_1, -0.000_383_981, -0.010_922_3),
        UnitQuaternion::from_quaternion(turn),
    );
    let centre = Point3::new(-0.02, 0.1, 0.03);
    let Some(estimate) = aligned("bun000.ply", "bun045.ply") else {
        return;
    };
    let error = pose_error(
        &estimate.target_from_source,
        &world_from_045.inverse(),
        &centre,
    );
    report("bunny", &estimate, &error);
    assert!(
        error.rotation.degrees() < 2.0 && error.shift.mm() < 2.0,
        "{error:?}"
    );
}

#[test]
fn two_lidar_scans_meet_within_half_a_degree_and_ten_centimetres() {
    let truth: RigidTransform = Isometry3::from_parts(
        Translation3::new(0.488_882, 0.121_214, -0.025_334_2),
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix(&Matrix3::new(
            0.999_925,
            0.012_148_3,
            -0.001_770_09, //
            -0.012_152_3,
            0.999_924,
            -0.002_286_57, //
            0.001_742_18,
            0.002_307_91,
            0.999_996,
        ))),
    );
    let Some(estimate) = aligned("gicp_source.ply", "gicp_target.ply") else {
        return;
    };
    let error = pose_error(&estimate.target_from_source, &truth, &Point3::origin());
    report("lidar", &estimate, &error);
    assert!(
        error.rotation.degrees() < 0.5 && error.shift.0 < 0.1,
        "{error:?}"
    );
}
