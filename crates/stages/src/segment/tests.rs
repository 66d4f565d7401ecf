use nalgebra::{Isometry3, UnitQuaternion, Vector3};

use super::*;
use crate::scene::{scene_from_cloud, scene_from_frame};
use geometry::{cloud::PointCloud, voxel::downsample};
use simulate::{
    CellSetup, ObjectKind, PartKind, PartPose, PoseRange, Side, SimulatedFrame, SimulatedObject,
    SurfaceLabel, frame,
};

fn segmented(frame: &SimulatedFrame) -> Segmentation {
    segment(&scene_from_frame(&frame.frame), &SegmentParams::default())
}

/// Returns the share of the visible part that was kept, and the share of the kept points that belong to the part.
fn recall_and_precision(frame: &SimulatedFrame, found: &Segmentation) -> (f64, f64) {
    let (mut kept, mut seen, mut both) = (0.0_f64, 0.0_f64, 0.0_f64);
    for (label, truth) in found.labels.iter().zip(&frame.truth.labels) {
        let is_part = *truth == SurfaceLabel::Part && *label != PointLabel::NoReading;
        let is_kept = *label == PointLabel::Part;
        seen += f64::from(u8::from(is_part));
        kept += f64::from(u8::from(is_kept));
        both += f64::from(u8::from(is_part && is_kept));
    }
    (both / seen.max(1.0), both / kept.max(1.0))
}

#[test]
fn every_part_is_kept_whole_and_nothing_else() {
    for (i, kind) in PartKind::ALL.into_iter().enumerate() {
        for seed in 0..3 {
            let frame = frame(&CellSetup::with_part(
                kind,
                Side::Left,
                0,
                40 + seed * 8 + i as u64,
            ));
            let (recall, precision) = recall_and_precision(&frame, &segmented(&frame));
            assert!(
                recall > 0.95 && precision > 0.97,
                "{kind}, seed {seed}: {recall:.3} {precision:.3}"
            );
        }
    }
}

#[test]
fn an_empty_cell_holds_no_part() {
    let mut setups: Vec<CellSetup> = (0..10)
        .map(|seed| {
            let mut setup = CellSetup::new(SimulatedObject::Nothing, seed);
            setup.floor = Metres(0.6 + 0.05 * seed as f64);
            setup
        })
        .collect();
    // These show a strip of floor too narrow for a plane.
    setups.extend([6, 11].map(|seed| CellSetup::new(SimulatedObject::Nothing, seed)));
    for setup in setups {
        let found = segmented(&frame(&setup));
        assert!(
            matches!(found.part, Err(NoPart::OnlyBackground { .. })),
            "{setup:?}: {:?}",
            found.clusters
        );
    }
}

#[test]
fn a_thin_part_along_the_lower_end_of_the_view_stays_a_part() {
    // Seen nearly edge-on and cut off by the view.
    let pose = Isometry3::from_parts(
        Vector3::new(0.0, 0.457 * 1.8, 1.8).into(),
        UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 85_f64.to_radians()),
    );
    for kind in [
        PartKind::BackBumper,
        PartKind::FrontBumper,
        PartKind::TrunkLid,
    ] {
        let mut setup = CellSetup::with_part(kind, Side::Left, 0, 5);
        setup.pose = PartPose::Fixed(pose);
        let frame = frame(&setup);
        let found = segmented(&frame);
        let (_, precision) = recall_and_precision(&frame, &found);
        assert!(
            found.part.is_ok() && precision > 0.9,
            "{kind}: {precision:.3} {:?}",
            found.clusters
        );
    }
}

#[test]
fn a_flat_board_before_the_wall_is_not_taken_for_another_wall() {
    for seed in 0..5 {
        let frame = frame(&CellSetup::new(
            SimulatedObject::Object(ObjectKind::Board),
            seed,
        ));
        let (recall, _) = recall_and_precision(&frame, &segmented(&frame));
        assert!(recall > 0.9, "seed {seed}: {recall:.3} of the board kept");
    }
}

#[test]
fn a_part_alone_in_space_is_kept() {
    let frame = frame(&CellSetup::with_part(PartKind::TrunkLid, Side::Left, 0, 3));
    let mut scene = scene_from_frame(&frame.frame);
    for (p, truth) in scene.cloud.points.iter_mut().zip(&frame.truth.labels) {
        if *truth != SurfaceLabel::Part {
            *p = Point3::new(f32::NAN, f32::NAN, f32::NAN);
        }
    }
    let found = segment(&scene, &SegmentParams::default());
    assert!(found.planes.is_empty(), "{:?}", found.planes);
    assert!(recall_and_precision(&frame, &found).0 > 0.95);
}

#[test]
fn an_unorganised_cloud_is_segmented_too() {
    let mut setup = CellSetup::with_part(PartKind::FrontDoor, Side::Left, 0, 9);
    setup.pose = PartPose::Drawn(PoseRange::facing());
    let frame = frame(&setup);
    let thinned = downsample(&scene_from_frame(&frame.frame).cloud, Metres::from_mm(10.0));
    let found = segment(&scene_from_cloud(thinned), &SegmentParams::default());
    let part = found.part.expect("the door");
    // The door hangs at 1.0 to 1.4 m, the wall at 2.4 m.
    assert!(part.cloud.points.iter().all(|p| p.z < 2.0));
    let (low, high) = part.cloud.bounds().expect("points");
    assert!((high.x - low.x) > 0.8 && (high.y - low.y) > 0.8);
}

#[test]
fn turning_the_camera_upright_changes_nothing_that_matters() {
    let mut setup = CellSetup::with_part(PartKind::Grille, Side::Left, 0, 4);
    setup.pose = PartPose::Fixed(Isometry3::from_parts(
        Vector3::new(0.0, 0.0, 1.3).into(),
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 1.2),
    ));
    let frame = frame(&setup);
    let (recall, precision) = recall_and_precision(&frame, &segmented(&frame));
    assert!(
        recall > 0.95 && precision > 0.97,
        "{recall:.3} {precision:.3}"
    );
}

#[test]
fn points_are_selected_in_any_order_and_each_once() {
    let frame = frame(&CellSetup::with_part(PartKind::Grille, Side::Left, 0, 3));
    let scene = scene_from_frame(&frame.frame);
    let params = SegmentParams::default();
    let part = segment(&scene, &params).part.expect("a part");
    let kept = SegmentedPart::selected(&scene, &part.indices, &params);
    let mut anyhow: Vec<u32> = part.indices.iter().rev().copied().collect();
    anyhow.extend(&part.indices[..100]);
    assert_eq!(SegmentedPart::selected(&scene, &anyhow, &params), kept);
    assert_eq!(kept.indices, part.indices);
}

#[test]
fn the_same_scene_gives_the_same_segmentation() {
    let frame = frame(&CellSetup::with_part(PartKind::Fender, Side::Left, 0, 5));
    assert_eq!(segmented(&frame), segmented(&frame));
}

#[test]
fn poison_gives_a_named_reason_and_no_panic() {
    let points = |f: &dyn Fn(usize) -> Point3<f32>| PointCloud::from_points((0..5000).map(f));
    let nan = PointCloud {
        points: vec![Point3::new(f32::NAN, f32::NAN, f32::NAN); 640 * 480],
        grid: Some(geometry::cloud::Grid {
            width: 640,
            height: 480,
        }),
        ..PointCloud::default()
    };
    for (what, cloud) in [
        ("nothing", PointCloud::default()),
        ("all NaN", nan),
        (
            "one point",
            PointCloud::from_points([Point3::new(0.0, 0.0, 1.0)]),
        ),
        ("a spot", points(&|_| Point3::new(0.1, 0.2, 1.0))),
    ] {
        let found = segment(&scene_from_cloud(cloud), &SegmentParams::default());
        assert!(found.part.is_err(), "{what}: {:?}", found.clusters);
    }
    // A plane with no picture around it may be a flat part, so it is kept.
    let plane = points(&|i| Point3::new((i % 70) as f32 * 0.01, (i / 70) as f32 * 0.01, 1.0));
    assert!(
        segment(&scene_from_cloud(plane), &SegmentParams::default())
            .part
            .is_ok()
    );
    // Huge coordinates, far away.
    let huge = points(&|i| Point3::new(i as f32 * 1e6, -1e9, 1e12));
    let _ = segment(&scene_from_cloud(huge), &SegmentParams::default());
}
