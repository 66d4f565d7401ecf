//! The surface of a simulated part with and without a dent.

use nalgebra::{Unit, UnitQuaternion};
use simulate::{
    CellSetup, Dent, PartKind, PartModel, PartPose, SensorNoise, Side, SimulatedObject,
    frame_of_mesh,
};

use super::{
    regions::{AveragedField, factor_of},
    *,
};
use crate::{
    reference::{Coverage, ReferenceParams},
    scene::scene_from_frame,
};
use geometry::mesh::TriangleMesh;

/// The trunk lid as a reference, and its mesh.
fn trunk_lid() -> (Reference, TriangleMesh) {
    let mesh = PartModel::new(PartKind::TrunkLid, Side::Left, 0).into_mesh();
    let cloud = mesh.sample_evenly(16_000, 1).expect("a surface");
    let params = ReferenceParams::default();
    let reference = Reference::prepare("trunk_lid", cloud, Coverage::AllAround, &params);
    (reference.expect("an outline"), mesh)
}

/// Four frames of a mesh that faces the camera at 1.2 m, by its own pose.
fn frames_of(mesh: &TriangleMesh, camera_from_part: RigidTransform) -> Vec<SceneCloud> {
    let mut setup = CellSetup::new(SimulatedObject::Nothing, 3);
    setup.pose = PartPose::Fixed(camera_from_part);
    let frame = |seed| {
        setup.noise = SensorNoise::kinect(seed);
        scene_from_frame(&frame_of_mesh(&setup, mesh).frame)
    };
    (1..=4).map(frame).collect()
}

/// Measures the part of these frames as if its pose were off by some millimetres and tenths of a degree.
fn measured(
    reference: &Reference,
    frames: &[SceneCloud],
    camera_from_part: RigidTransform,
) -> Result<Deviation, DeviationError> {
    let off = UnitQuaternion::from_euler_angles(0.003, -0.004, 0.002);
    let off = RigidTransform::from_parts([0.002, -0.001, 0.004].into(), off);
    let frames: Vec<&SceneCloud> = frames.iter().collect();
    // Nothing else is as near.
    let points = &frames[0].cloud.points;
    let is_near = |i: &u32| points[*i as usize].z < 1.7;
    let indices: Vec<u32> = (0..points.len() as u32).filter(is_near).collect();
    let part = StandingPart {
        frames: &frames,
        indices: &indices,
        part_from_camera: off * camera_from_part.inverse(),
        noise_at_1m: Metres(0.0015),
    };
    measure_deviation(&part, reference, &DeviationParams::default())
}

/// The patch around which the surface turns least within 5 cm, of those that the surface surrounds.
fn smoothest(patches: &[PatchDeviation]) -> PatchDeviation {
    let around = patches.iter().map(|one| {
        let near = patches
            .iter()
            .filter(|near| (near.at - one.at).norm() < 0.05);
        let cosines = near.map(|near| near.normal.dot(&one.normal));
        cosines.fold((0, 1.0_f32), |(num, least), cosine| {
            (num + 1, least.min(cosine))
        })
    });
    let around: Vec<(usize, f32)> = around.collect();
    let most = around.iter().map(|(num, _)| *num).max().expect("patches");
    let inside = patches.iter().zip(&around);
    let inside = inside.filter(|(_, (num, _))| 10 * num >= 9 * most);
    let smoothest = inside.max_by(|a, b| a.1.1.total_cmp(&b.1.1));
    *smoothest.expect("a patch in the middle of the part").0
}

/// The trunk lid, its mesh, its pose and its deviation without a dent.
fn good_trunk_lid() -> (Reference, TriangleMesh, RigidTransform, Deviation) {
    let (reference, mesh) = trunk_lid();
    let camera_from_part = RigidTransform::translation(0.0, 0.0, 1.2);
    let frames = frames_of(&mesh, camera_from_part);
    let good = measured(&reference, &frames, camera_from_part).expect("measured");
    (reference, mesh, camera_from_part, good)
}

#[test]
fn a_dent_is_found_where_it_is_and_nothing_on_a_good_part() {
    let (reference, mesh, camera_from_part, good) = good_trunk_lid();
    assert!(good.regions.is_empty(), "{:?}", good.regions);
    assert!(good.seen > 0.6, "{}", good.seen);
    assert!((0.0001..0.0015).contains(&good.noise.0), "{:?}", good.noise);
    let place = smoothest(&good.patches);
    for height in [-0.004, 0.004] {
        let dent = Dent {
            centre: place.at.cast(),
            outwards: Unit::new_normalize(place.normal.cast()),
            width: Metres(0.06),
            height: Metres(height),
        };
        let frames = frames_of(&dent.pressed_into(&mesh), camera_from_part);
        let found = measured(&reference, &frames, camera_from_part).expect("measured");
        let [region] = &found.regions[..] else {
            panic!("{:?}", found.regions);
        };
        let kind = if height < 0.0 {
            RegionKind::Dent
        } else {
            RegionKind::Bump
        };
        assert_eq!(region.kind, kind);
        let distance = (region.centre - dent.centre).norm();
        assert!(distance < 0.015, "{distance} m away");
        let off = region.off.expect("a depth").0;
        assert!((off / height - 0.9).abs() < 0.3, "{off} m");
        // Where it is at least half as deep, it is 30 mm wide, and up to 60 mm in an average.
        assert!(
            (3e-4..3.5e-3).contains(&region.area_m2),
            "{} m²",
            region.area_m2
        );
        // The dent does not move the part.
        let shift = (found.part_from_camera * camera_from_part * dent.centre - dent.centre)
            .dot(&dent.outwards);
        assert!(shift.abs() < 0.0015, "{shift} m");
    }
}

#[test]
fn a_hole_is_missing_surface() {
    let (reference, mesh, camera_from_part, good) = good_trunk_lid();
    let place = smoothest(&good.patches).at;
    let dent = Dent {
        centre: place.cast(),
        outwards: -Vector3::z_axis(),
        width: Metres(0.12),
        height: Metres(0.0),
    };
    // Split into small triangles, of which those near are left out, of both skins of the sheet.
    let fine = dent.pressed_into(&mesh);
    let is_kept = |corners: &[u32; 3]| {
        let middle = corners.iter().map(|i| fine.vertices[*i as usize].coords);
        (middle.sum::<Vector3<f32>>() / 3.0 - place.coords).norm() > 0.04
    };
    let triangles = fine.triangles.iter().copied().filter(is_kept).collect();
    let holed = TriangleMesh::new(fine.vertices.clone(), triangles).expect("a mesh");
    let found = measured(
        &reference,
        &frames_of(&holed, camera_from_part),
        camera_from_part,
    );
    let found = found.expect("measured");
    let missing = found
        .regions
        .iter()
        .filter(|region| region.kind == RegionKind::Missing);
    let missing: Vec<_> = missing.collect();
    assert_eq!(missing.len(), 1, "{:?}", found.regions);
    assert!((missing[0].centre - place.cast::<f64>()).norm() < 0.02);
    // The part's shadow hides about half of what is seen through a hole.
    assert!(
        (1e-3..7e-3).contains(&missing[0].area_m2),
        "{}",
        missing[0].area_m2
    );
}

#[test]
fn what_cannot_be_measured_is_named() {
    let (reference, mesh) = trunk_lid();
    let camera_from_part = RigidTransform::translation(0.0, 0.0, 1.2);
    let mut frames = frames_of(&mesh, camera_from_part);
    frames[1].intrinsics = None;
    let differ = measured(&reference, &frames, camera_from_part);
    assert_eq!(differ.err(), Some(DeviationError::FramesDiffer));
    frames[0].cloud.grid = None;
    let loose = measured(&reference, &frames, camera_from_part);
    assert_eq!(loose.err(), Some(DeviationError::NoPicture));
    // The part is elsewhere.
    let frames = frames_of(&mesh, camera_from_part);
    let elsewhere = RigidTransform::translation(0.0, 0.9, 1.2);
    let little = measured(&reference, &frames, elsewhere);
    assert!(
        matches!(little, Err(DeviationError::LittleSeen { .. })),
        "{little:?}"
    );
}

#[test]
fn averages_and_limits_are_those_of_the_formulas() {
    // Of a dent of the patch's own size, ∫cos⁴ over ∫cos²; of a much wider one all is left.
    let pi = std::f64::consts::PI;
    let own = (3.0 / 16.0 - 1.0 / (pi * pi)) / (0.25 - 1.0 / (pi * pi));
    assert!((share_in_average(0.04, 0.02) - own).abs() < 1e-3, "{own}");
    assert!(share_in_average(1.0, 0.02) > 0.99);
    assert!(share_in_average(0.02, 0.04) < 0.3);
    // The mean number of places beyond the limit is the one asked for: of a field that is taken everywhere by its slopes, of
    // a few averages by their probabilities (0.001 beyond 3.29 standard deviations to either side).
    let field = |slopes, num_averages| AveragedField {
        slopes,
        num_averages,
    };
    for slopes in [5_000.0, 50_000.0] {
        let k = factor_of(&[field(slopes, 1e9)], 0.05);
        let expected = 2.0 * slopes / (2.0 * pi).powf(1.5) * k * (-k * k / 2.0).exp();
        assert!((expected / 0.05 - 1.0).abs() < 1e-3, "{k}: {expected}");
    }
    let k = factor_of(&[field(1e9, 100.0)], 0.1);
    assert!((k - 3.29).abs() < 0.03, "{k}");
}
