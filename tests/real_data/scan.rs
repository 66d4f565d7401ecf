//! Scans of a real fender and a real door, taken by a camera on a spray robot's flange.

use std::{
    path::Path,
    sync::{Arc, OnceLock},
};

use nalgebra::{Point3, Translation3, Vector3};
use partsight::{
    files::{FileContent, open},
    geometry::{nearest::KdTree, rigid::RigidTransform},
    robot::frame_poses::{FramePose, read_frame_poses},
    scan::{
        Excluded, Scan, ScanError, ScanParams, Shot, ShotSurface, Unwatched, assemble, surface::Use,
    },
    stages::scene::scene_from_frame,
};

use crate::data_folder;

fn shots(folder: &Path, series: &str, num: usize) -> Vec<Shot> {
    let names: Vec<String> = (0..num).map(|k| format!("{series}_{k:02}.png")).collect();
    shots_named(folder, &folder.join("truth.json"), &names)
}

fn shots_named(folder: &Path, poses: &Path, names: &[String]) -> Vec<Shot> {
    let poses = read_frame_poses(poses, names).expect("poses");
    let shot = |(name, pose): (&String, FramePose)| {
        let Ok(FileContent::Depth(frame)) = open(&folder.join(name)) else {
            panic!("{name}: no depth image");
        };
        let FramePose::Camera(base_from_camera) = pose else {
            panic!("{name}: no pose of the camera");
        };
        Shot {
            name: name.clone(),
            scene: Arc::new(scene_from_frame(&frame)),
            base_from_camera,
        }
    };
    names.iter().zip(poses).map(shot).collect()
}

/// The scan of the fender with the robot's own poses.
fn fender_scan(data: &Path) -> &'static Scan {
    static SCAN: OnceLock<Scan> = OnceLock::new();
    SCAN.get_or_init(|| {
        let shots = shots(&data.join("booth"), "left2", 8);
        assemble(&shots, &ScanParams::default(), &Unwatched).expect("a scan")
    })
}

/// Part and stand are nearer to the camera than this, metres; floor and walls are not.
const NEAR: f32 = 1.5;

/// Points of a shot's near surfaces, base frame, with normals, without those at depth discontinuities.
fn near_surface(
    surface: &ShotSurface,
    pose: &RigidTransform,
) -> (Vec<Point3<f32>>, Vec<Vector3<f32>>) {
    let is_near = |i: &usize| surface.uses[*i] == Use::Surface && surface.points()[*i].z < NEAR;
    let near = (0..surface.points().len()).filter(is_near).step_by(5);
    let pose = pose.cast::<f32>();
    let posed = near.map(|i| (pose * surface.points()[i], pose * surface.normal(i)));
    posed.unzip()
}

/// Root mean square distance along the normal of mutual nearest points within 15 mm, over all pairs of frames, and
/// their number. Independent of the correspondences that the scan finds.
fn disagreement(scan: &Scan, pose: impl Fn(usize) -> RigidTransform) -> (f64, usize) {
    let clouds: Vec<_> = scan
        .shots
        .iter()
        .enumerate()
        .map(|(k, shot)| near_surface(&shot.surface, &pose(k)))
        .collect();
    let trees: Vec<KdTree> = clouds.iter().map(|cloud| KdTree::new(&cloud.0)).collect();
    let (mut sum_sq, mut num) = (0.0, 0_usize);
    for (a, (points, _)) in clouds.iter().enumerate() {
        for (b, (others, normals)) in clouds.iter().enumerate().filter(|(b, _)| *b != a) {
            for (i, point) in points.iter().enumerate().step_by(3) {
                let Some(near) = trees[b].nearest(point, 0.015 * 0.015) else {
                    continue;
                };
                let back = trees[a].nearest(&others[near.index], f32::INFINITY);
                if back.is_some_and(|back| back.index == i) {
                    let off = normals[near.index].dot(&(others[near.index] - point));
                    sum_sq += f64::from(off * off);
                    num += 1;
                }
            }
        }
    }
    ((sum_sq / num.max(1) as f64).sqrt(), num)
}

#[test]
fn the_frames_of_a_fender_and_of_a_door_agree_after_refinement() {
    let Some(data) = data_folder() else { return };
    let door = shots(&data.join("booth"), "right2", 7);
    let door = assemble(&door, &ScanParams::default(), &Unwatched).expect("a scan");
    for (series, num_shots, scan) in [("left2", 8, fender_scan(&data)), ("right2", 7, &door)] {
        assert_eq!(scan.used().count(), num_shots, "{series}");
        assert_eq!(scan.doubt, None, "{series}");
        for shot in &scan.shots {
            // The robot's poses are off by a few millimetres and some tenths of a degree.
            let moved = &shot.moved;
            assert!(
                moved.shift.mm() < 15.0 && moved.rotation.degrees() < 0.6,
                "{} moved by {} and {}",
                shot.name,
                moved.shift,
                moved.rotation
            );
        }
        let (before, _) = disagreement(scan, |k| scan.shots[k].given);
        let (after, num_pairs) = disagreement(scan, |k| scan.shots[k].base_from_camera);
        assert!(num_pairs > 5_000, "{series}: {num_pairs} pairs");
        assert!(
            after < 0.0025,
            "{series}: {} mm, before {} mm",
            after * 1e3,
            before * 1e3
        );
        assert!(
            after < before,
            "{series}: {} mm, before {} mm",
            after * 1e3,
            before * 1e3
        );
    }
}

#[test]
fn two_frames_of_which_one_pose_is_10_cm_off_are_refused_and_right_ones_get_no_warning() {
    let Some(data) = data_folder() else { return };
    let shots = shots(&data.join("booth"), "left2", 8);
    let put_together = |shots: &[Shot]| assemble(shots, &ScanParams::default(), &Unwatched);
    for pair in shots.windows(2) {
        let scan = put_together(pair).expect("a scan");
        assert_eq!(scan.doubt, None);
    }
    let mut pair = shots[1..3].to_vec();
    pair[1].base_from_camera.translation.vector.x += 0.1;
    let refused = put_together(&pair).expect_err("either may be wrong");
    let ScanError::Contradiction { names, apart, .. } = refused else {
        panic!("{refused}");
    };
    assert_eq!(names, ["left2_01.png", "left2_02.png"]);
    let apart = apart.expect("a better pose").mm();
    assert!((70.0..130.0).contains(&apart), "{apart} mm");
}

#[test]
fn half_of_the_poses_30_mm_off_are_refused_and_the_right_ones_accepted() {
    let Some(data) = data_folder() else { return };
    let case = data.join("reported/scan_tie");
    let names: Vec<String> = (1..=4).map(|k| format!("frame-{k:02}.png")).collect();
    let put_together = |poses: &str| {
        let shots = shots_named(&case.join("s"), &case.join(poses), &names);
        assemble(&shots, &ScanParams::default(), &Unwatched)
    };
    let right = put_together("s/poses.json").expect("a scan");
    assert_eq!((right.used().count(), right.doubt), (4, None));
    let refused = put_together("poses_every_second_30mm.json").expect_err("a tie");
    let ScanError::NoMajority { agree, others } = refused else {
        panic!("{refused}");
    };
    assert_eq!(agree, ["frame-02.png", "frame-04.png"]);
    assert_eq!(others, ["frame-01.png", "frame-03.png"]);
}

#[test]
fn a_frame_of_a_door_slid_along_it_is_left_out() {
    let Some(data) = data_folder() else { return };
    let all = shots(&data.join("booth"), "right2", 7);
    let mut shots = [1, 4, 5].map(|k| all[k].clone());
    shots[0].base_from_camera *= Translation3::new(0.15, 0.0, 0.0);
    let scan = assemble(&shots, &ScanParams::default(), &Unwatched).expect("a scan");
    let Some(Excluded::WrongPose { moved }) = scan.shots[0].excluded else {
        panic!("{:?}", scan.shots[0].excluded);
    };
    assert!((120.0..180.0).contains(&moved.shift.mm()), "{moved:?}");
    assert_eq!(scan.used().count(), 2);
}

#[test]
fn the_pillar_that_a_frame_takes_for_the_fender_is_not_the_part() {
    let Some(data) = data_folder() else { return };
    let all = shots(&data.join("booth"), "left2", 8);
    let tree = KdTree::new(&fender_scan(&data).cloud.part().cloud.points);
    for other in [0, 1, 2, 3, 4, 6, 7] {
        let pair = [other, 5].map(|k| all[k].clone());
        let scan = assemble(&pair, &ScanParams::default(), &Unwatched).expect("a scan");
        assert!(scan.shots[0].finds_part && !scan.shots[1].finds_part);
        let part = scan.cloud.part();
        let is_near = |p: &&Point3<f32>| tree.nearest(p, 0.02 * 0.02).is_some();
        let num_near = part.cloud.points.iter().filter(is_near).count();
        assert!(
            num_near as f64 > 0.9 * part.cloud.points.len() as f64,
            "{other}"
        );
    }
}

#[test]
fn frames_with_inverted_poses_are_refused() {
    let Some(data) = data_folder() else { return };
    let mut shots = shots(&data.join("booth"), "left2", 8)[1..3].to_vec();
    for shot in &mut shots {
        shot.base_from_camera = shot.base_from_camera.inverse();
    }
    let refused = assemble(&shots, &ScanParams::default(), &Unwatched).expect_err("inverted");
    assert_eq!(refused, ScanError::PosesInverted);
}

#[test]
fn a_frame_whose_pose_is_5_cm_off_is_left_out() {
    let Some(data) = data_folder() else { return };
    let mut shots = shots(&data.join("booth"), "left2", 8);
    shots[6].base_from_camera.translation.vector += Vector3::new(0.03, 0.0, 0.04);
    let scan = assemble(&shots, &ScanParams::default(), &Unwatched).expect("a scan");
    let excluded: Vec<usize> = (0..8)
        .filter(|&k| scan.shots[k].excluded.is_some())
        .collect();
    assert_eq!(excluded, [6]);
}
