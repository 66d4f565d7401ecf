//! References from meshes as others make them: skins a millimetre apart, solids inside out, open sheets, polygons.

use std::path::Path;

use nalgebra::{Isometry3, Point3, Vector3};
use partsight::{
    files::{FileContent, FileWarning, open},
    geometry::{mesh::TriangleMesh, rigid::pose_error},
    library::{EnrolFinding, Enrolled, Library},
    pipeline::{Recipe, Unwatched, Verdict, run},
    stages::scene::scene_from_frame,
};

use crate::{data_folder, mesh_side::enrolled};

/// Inspects a frame, expects the part in it to be accepted, and its pose to be the true one within its bounds.
fn assert_found(enrolled: &Enrolled, frame: &Path) {
    let Ok(FileContent::Depth(depth)) = open(frame) else {
        panic!("{}: no depth image", frame.display());
    };
    let truth = std::fs::read_to_string(frame.with_extension("truth.json")).expect("the truth");
    let truth: serde_json::Value = serde_json::from_str(&truth).expect("JSON");
    let rows: Vec<f64> =
        serde_json::from_value(truth["camera_from_part"].clone()).expect("numbers");
    let truth: Isometry3<f64> =
        nalgebra::try_convert(nalgebra::Matrix4::from_row_slice(&rows)).expect("a pose");
    let library = Library {
        references: vec![enrolled.reference.clone()],
        ..Library::default()
    };
    let scene = scene_from_frame(&depth);
    let inspection = run(&scene, &library, &Recipe::default(), &Unwatched).expect("run");
    let name = frame.display();
    assert!(
        matches!(inspection.verdict, Verdict::Part { .. }),
        "{name}: {:?}",
        inspection.verdict
    );
    let pose = inspection.pose.expect("a pose").expect("found");
    let seen = &inspection
        .segmentation
        .part
        .as_ref()
        .expect("a part")
        .cloud
        .points;
    let sum: Vector3<f64> = seen.iter().map(|p| p.coords.cast::<f64>()).sum();
    let middle = Point3::from(sum / seen.len() as f64);
    let bounds = pose.uncertainty.expect("bounds");
    let off = pose_error(&pose.target_from_source, &truth.inverse(), &middle);
    assert!(
        off.shift <= bounds.shift && off.rotation <= bounds.turn,
        "{name}: {off:?} {bounds:?}"
    );
}

#[test]
fn a_thin_panel_is_found_like_a_thick_one_and_one_inside_out_where_it_is() {
    let Some(data) = data_folder() else { return };
    let reported = data.join("reported");
    for (folder, mesh, frame) in [
        ("thin_solid_mesh", "plate_20mm", "scene_20mm"),
        ("thin_solid_mesh", "plate_2mm", "scene_2mm"),
        ("thin_solid_mesh", "sheet_both_sides", "scene_2mm"),
        ("inside_out_mesh", "plate_15mm", "scene"),
        ("inside_out_mesh", "plate_15mm_inside_out", "scene"),
        ("open_sheet_from_behind", "sheet", "front"),
        ("open_sheet_from_behind", "sheet", "behind"),
        (
            "open_sheet_from_behind",
            "sheet_wound_the_other_way",
            "front",
        ),
        (
            "open_sheet_from_behind",
            "sheet_wound_the_other_way",
            "behind",
        ),
    ] {
        let folder = reported.join(folder);
        let enrolled = enrolled(&folder.join(format!("{mesh}.obj")), "");
        assert_found(&enrolled, &folder.join(format!("{frame}.png")));
    }
}

#[test]
fn enrolling_says_what_a_mesh_is() {
    let Some(data) = data_folder() else { return };
    let findings = |file: &str| enrolled(&data.join("reported").join(file), "").findings;
    let thickness = |findings: &[EnrolFinding]| match findings {
        [EnrolFinding::ClosedSheet { thickness_m }, ..] => thickness_m.mm(),
        _ => panic!("{findings:?}"),
    };
    let thin = findings("thin_solid_mesh/plate_2mm.obj");
    assert!(
        (thickness(&thin) - 2.0).abs() < 0.1 && thin.len() == 1,
        "{thin:?}"
    );
    let turned = findings("inside_out_mesh/plate_15mm_inside_out.obj");
    assert!((thickness(&turned) - 15.0).abs() < 1.5, "{turned:?}");
    assert_eq!(turned[1..], [EnrolFinding::Turned { percent: 100 }]);
    let open = findings("open_sheet_from_behind/sheet.obj");
    assert_eq!(open, [EnrolFinding::OpenSurface { percent: 100 }]);
}

#[test]
fn polygons_and_numbers_in_other_forms_make_the_same_mesh() {
    let Some(data) = data_folder() else { return };
    let mesh = |file: &str| -> TriangleMesh {
        match open(&data.join("reported").join(file)) {
            Ok(FileContent::Mesh(mesh)) => mesh,
            other => panic!("{file}: {other:?}"),
        }
    };
    let is_in_the_notch = |mesh: &TriangleMesh| {
        let cloud = mesh.sample_evenly(4000, 1).expect("an area");
        cloud.points.iter().any(|p| p.x > -0.045 && p.y > -0.045)
    };
    for file in [
        "angle_a.obj",
        "angle_b.obj",
        "angle_a.ply",
        "angle_b.ply",
        "angle_triangles.obj",
    ] {
        let mesh = mesh(&format!("concave_polygon/{file}"));
        assert!((mesh.area() - 0.43).abs() < 0.01, "{file}: {}", mesh.area());
        assert!(!is_in_the_notch(&mesh), "{file}");
    }
    let plain = mesh("gltf_core_features/plain.gltf");
    for file in ["sparse.gltf", "quantized.gltf"] {
        let mesh = mesh(&format!("gltf_core_features/{file}"));
        assert_eq!(mesh.triangles, plain.triangles, "{file}");
        for (found, expected) in mesh.vertices.iter().zip(&plain.vertices) {
            assert!(
                (found - expected).norm() < 1e-4,
                "{file}: {found} {expected}"
            );
        }
    }
}

#[test]
fn a_capture_saved_with_faces_is_a_capture_and_pixels_are_no_metres() {
    let Some(data) = data_folder() else { return };
    let reported = data.join("reported");
    let cloud = |file: &str| match open(&reported.join(file)) {
        Ok(FileContent::Cloud(cloud)) => cloud.points,
        other => panic!("{file}: {other:?}"),
    };
    let points = cloud("camera_mesh_ply/points_only.ply#up=y");
    assert_eq!(cloud("camera_mesh_ply/with_faces.ply#up=y"), points);
    let unturned = open(&reported.join("camera_mesh_ply/with_faces.ply")).expect("a mesh");
    assert_eq!(unturned.warnings(), [FileWarning::CaptureWithFaces]);
    let metres = cloud("pixel_and_metre_columns/cloud_metres_only.csv");
    assert_eq!(cloud("pixel_and_metre_columns/cloud.csv"), metres);
}
