use nalgebra::Point3;

use super::*;
use crate::clutter::Clutter;
use crate::object::ObjectKind;
use crate::part::Side;
use crate::sensor::SensorNoise;
use crate::stand::Stand;

fn full_cell(kind: PartKind, seed: u64) -> CellSetup {
    CellSetup {
        stand: Stand::Post,
        clutter: Clutter::OnFloor,
        ..CellSetup::with_part(kind, Side::Left, seed % 3, seed)
    }
}

/// Distance of a point to the nearest triangle, over all of them.
fn distance_to(mesh: &TriangleMesh, p: &Point3<f64>) -> f64 {
    let mut nearest = f64::INFINITY;
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|i| mesh.vertices[i as usize].cast::<f64>());
        let normal = (b - a).cross(&(c - a)).normalize();
        let foot = p - normal * normal.dot(&(p - a));
        let sides = [(a, b), (b, c), (c, a)];
        let is_over = sides
            .iter()
            .all(|(s, e)| normal.dot(&(e - s).cross(&(foot - s))) >= 0.0);
        let to_edge = |(s, e): &(Point3<f64>, Point3<f64>)| {
            let t = ((p - s).dot(&(e - s)) / (e - s).norm_squared()).clamp(0.0, 1.0);
            (p - (s + (e - s) * t)).norm()
        };
        let distance = if is_over {
            (p - foot).norm()
        } else {
            sides.iter().map(to_edge).fold(f64::INFINITY, f64::min)
        };
        nearest = nearest.min(distance);
    }
    nearest
}

#[test]
fn noise_free_part_pixels_lie_on_the_part() {
    for (seed, kind) in PartKind::ALL.into_iter().enumerate() {
        let setup = CellSetup {
            noise: SensorNoise::none(),
            ..full_cell(kind, seed as u64)
        };
        let mesh = setup.subject.mesh();
        let SimulatedFrame { frame, truth } = frame_of_mesh(&setup, &mesh);
        let part_from_camera = truth.camera_from_part.inverse();
        let part_pixels: Vec<usize> = (0..truth.labels.len())
            .filter(|&i| truth.labels[i] == SurfaceLabel::Part)
            .collect();
        assert!(part_pixels.len() > 8_000, "{kind}: {}", part_pixels.len());
        for &pixel in part_pixels.iter().step_by(part_pixels.len() / 25) {
            let (u, v) = (
                pixel % frame.intrinsics.width,
                pixel / frame.intrinsics.width,
            );
            let z = f64::from(frame.depth[pixel]) * frame.metres_per_unit;
            let point = part_from_camera * frame.intrinsics.point_at(u as f64, v as f64, z);
            let off = distance_to(&mesh, &point);
            assert!(off < 0.001, "{kind}: {off} m off at ({u}, {v})");
        }
    }
}

#[test]
fn the_same_setup_gives_the_same_bits_and_another_seed_other_ones() {
    let setup = full_cell(PartKind::Fender, 4);
    let first = frame(&setup);
    assert_eq!(first, frame(&setup));
    let again = CellSetup {
        noise: SensorNoise::kinect(99),
        ..setup
    };
    let again = frame(&again);
    assert_eq!(first.truth, again.truth);
    assert_ne!(first.frame.depth, again.frame.depth);
    let elsewhere = frame(&CellSetup { seed: 5, ..setup });
    assert_ne!(
        first.truth.camera_from_part,
        elsewhere.truth.camera_from_part
    );
}

/// Bench results are compared from version to version, so the frame of a seed must not change.
#[test]
fn the_plain_cell_gives_the_frames_it_always_gave() {
    let sums = [
        (PartKind::Fender, 4),
        (PartKind::Grille, 2),
        (PartKind::FrontDoor, 9),
    ]
    .map(|(kind, seed)| {
        let depth = frame(&full_cell(kind, seed)).frame.depth;
        depth.iter().map(|&units| u64::from(units)).sum::<u64>()
    });
    assert_eq!(sums, [3_035_843_436, 3_401_088_652, 3_096_570_384]);
}

#[test]
fn every_surface_of_the_cell_is_seen_and_labelled() {
    let labels = frame(&full_cell(PartKind::Grille, 2)).truth.labels;
    for label in [
        SurfaceLabel::Wall,
        SurfaceLabel::Floor,
        SurfaceLabel::Part,
        SurfaceLabel::Stand,
        SurfaceLabel::Clutter,
    ] {
        assert!(labels.contains(&label), "{label:?}");
    }
    assert!(!labels.contains(&SurfaceLabel::Background));
}

#[test]
fn a_plank_hides_a_tenth_to_a_quarter_of_the_part() {
    for (seed, kind) in PartKind::ALL.into_iter().cycle().take(24).enumerate() {
        let tidy = CellSetup::with_part(kind, Side::Right, 1, seed as u64);
        let open = frame(&tidy).truth.visible_share;
        assert!(open > 0.999, "{kind}: {open}");
        let setup = CellSetup {
            clutter: Clutter::InFront,
            ..tidy
        };
        let share = frame(&setup).truth.visible_share;
        assert!((0.74..0.91).contains(&share), "{kind} seed {seed}: {share}");
    }
}

#[test]
fn a_part_cut_off_by_the_frame_says_so() {
    let mut pose = RigidTransform::translation(0.0, 0.0, 1.2);
    let setup = |pose| CellSetup {
        pose: crate::cell::PartPose::Fixed(pose),
        ..CellSetup::with_part(PartKind::TrunkLid, Side::Left, 0, 1)
    };
    assert!(frame(&setup(pose)).truth.fully_visible);
    // Put the middle of the lid on the edge of the frame.
    pose.translation.x = 320.0 / 525.0 * 1.2;
    let truth = frame(&setup(pose)).truth;
    assert!(!truth.fully_visible);
    assert!(
        (0.4..0.6).contains(&truth.visible_share),
        "{}",
        truth.visible_share
    );
}

#[test]
fn the_truth_survives_json_but_for_its_labels() {
    let setup = CellSetup::new(SimulatedObject::Object(ObjectKind::Hood), 8);
    let mut truth = frame(&setup).truth;
    let json = serde_json::to_value(&truth).unwrap();
    assert_eq!(json["camera_from_model"].as_array().unwrap().len(), 16);
    let back: FrameTruth = serde_json::from_value(json.clone()).unwrap();
    truth.labels.clear();
    assert!(
        (back.camera_from_part.to_homogeneous() - truth.camera_from_part.to_homogeneous()).norm()
            < 1e-12
    );
    assert_eq!((back.subject, back.part()), (truth.subject, None));
    let mut skewed = json;
    skewed["camera_from_model"][0] = 7.0.into();
    assert!(serde_json::from_value::<FrameTruth>(skewed).is_err());
}
