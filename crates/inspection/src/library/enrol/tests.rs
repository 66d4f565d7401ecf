use nalgebra::Vector3;

use super::*;
use crate::pipeline::{self, Recipe, Unwatched, Verdict};
use simulate::{CellSetup, PartKind, PartModel, Side};
use stages::{fixtures::scene_of, segment::PointLabel};

fn about(name: &str) -> PartDescription {
    PartDescription {
        name: PartName::new(name).expect("a name"),
        title: String::new(),
        notes: String::new(),
        from: "a test".into(),
        at: Timestamp::UNIX_EPOCH,
        simulated: true,
    }
}

fn captured(seed: u64) -> SceneCloud {
    let setup = CellSetup::with_part(PartKind::Fender, Side::Left, 0, seed);
    scene_of(&setup)
}

fn unit_ball(num_points: usize) -> Vec<Vector3<f32>> {
    (0..num_points)
        .map(|i| {
            let z = 1.0 - (2 * i + 1) as f32 / num_points as f32;
            let turn = i as f32 * 2.399_963;
            let r = (1.0 - z * z).sqrt();
            Vector3::new(r * turn.cos(), r * turn.sin(), z)
        })
        .collect()
}

#[test]
fn a_captured_part_is_recognised_in_the_scene_it_came_from() {
    let scene = captured(3);
    let enrolled =
        enrol_captured(&scene, &about("fender"), &EnrolParams::default()).expect("a part");
    let cloud = &enrolled.part.cloud;
    assert!(cloud.points.len() > 500 && cloud.points.len() <= 16_000);
    let normals = cloud.normals.as_ref().expect("normals");
    for (p, n) in cloud.points.iter().zip(normals) {
        assert!((n.norm() - 1.0).abs() < 1e-4 && n.dot(&p.coords) <= 0.0);
    }
    assert_eq!(enrolled.part.meta.coverage, Coverage::OneSide);
    let library = crate::library::Library {
        references: vec![enrolled.reference],
        ..crate::library::Library::default()
    };
    let inspection = pipeline::run(&scene, &library, &Recipe::default(), &Unwatched).expect("run");
    assert!(
        matches!(&inspection.verdict, Verdict::Part { part, score, .. } if part == "fender" && *score > 0.9),
        "{:?}",
        inspection.verdict
    );
}

#[test]
fn the_cubes_grow_until_the_cloud_is_small_enough() {
    let scene = captured(3);
    let params = EnrolParams {
        max_points: 700,
        ..EnrolParams::default()
    };
    let enrolled = enrol_captured(&scene, &about("fender"), &params).expect("a part");
    assert!(enrolled.part.cloud.points.len() <= 700);
    assert!(enrolled.part.meta.enrolled.voxel_mm > Some(8.0));
}

#[test]
fn a_mesh_is_enrolled_from_all_around() {
    let model = PartModel::new(PartKind::Grille, Side::Left, 0);
    let enrolled =
        enrol_mesh(model.mesh(), &about("grille"), &EnrolParams::default()).expect("a part");
    assert_eq!(enrolled.part.meta.coverage, Coverage::AllAround);
    let num_points = enrolled.part.cloud.points.len();
    assert!((15_500..=16_000).contains(&num_points), "{num_points}");
    let is_open = |finding: &EnrolFinding| matches!(finding, EnrolFinding::OpenSurface { percent } if *percent > 30);
    assert!(
        enrolled.findings.iter().any(is_open),
        "{:?}",
        enrolled.findings
    );
    let nothing = enrol_mesh(
        &TriangleMesh::default(),
        &about("x"),
        &EnrolParams::default(),
    );
    assert!(matches!(
        nothing,
        Err(EnrolError::NoArea { num_triangles: 0 })
    ));
}

#[test]
fn the_skins_of_a_sheet_stay_apart_in_a_thinned_cloud() {
    let step = |i: u16| f32::from(i) * 0.002;
    let flat = (0..200).flat_map(|i| (0..150).map(move |j| [step(i), step(j)]));
    let both = flat.flat_map(|[x, y]| {
        let skin = |z: f32| Point3::new(x, y, z);
        [(skin(0.0), -Vector3::z()), (skin(0.001), Vector3::z())]
    });
    let (points, normals): (Vec<_>, Vec<_>) = both.unzip();
    let cloud = PointCloud {
        normals: Some(normals),
        ..PointCloud::from_points(points)
    };
    let (thin, _) = thinned(&cloud, &EnrolParams::default());
    let normals = thin.normals.expect("normals");
    assert!(thin.points.len() > 3500, "{}", thin.points.len());
    for (p, n) in thin.points.iter().zip(&normals) {
        let expected = if p.z < 0.0005 { -1.0 } else { 1.0 };
        assert!((n.z - expected).abs() < 1e-6, "{p} {n}");
    }
}

#[test]
fn a_whole_cloud_around_the_origin_gets_normals_that_look_outwards() {
    let ball = unit_ball(6000);
    let cloud = PointCloud::from_points(ball.iter().map(|d| Point3::from(d * 0.3)));
    let enrolled = enrol_whole(&cloud, &about("ball"), &EnrolParams::default()).expect("a part");
    assert_eq!(enrolled.part.meta.coverage, Coverage::AllAround);
    let normals = enrolled.part.cloud.normals.expect("normals");
    for (p, n) in enrolled.part.cloud.points.iter().zip(normals) {
        assert!(n.dot(&p.coords.normalize()) > 0.95);
    }
}

#[test]
fn a_whole_cloud_before_the_camera_is_one_capture_unless_its_normals_say_otherwise() {
    let centre = Vector3::new(0.0, 0.0, 1.5);
    let ball = unit_ball(6000);
    let mut cloud = PointCloud::from_points(ball.iter().map(|d| Point3::from(centre + d * 0.3)));
    let coverage = |cloud: &PointCloud| {
        let enrolled = enrol_whole(cloud, &about("ball"), &EnrolParams::default());
        enrolled.expect("a part").part.meta.coverage
    };
    assert_eq!(coverage(&cloud), Coverage::OneSide);
    cloud.normals = Some(ball);
    assert_eq!(coverage(&cloud), Coverage::AllAround);
}

#[test]
fn stray_points_change_neither_the_coverage_nor_the_size_of_a_whole_cloud() {
    let clean = sheet(|x, y| x.abs() < 0.4 && y.abs() < 0.25 && (x < 0.1 || y < 0.0));
    let enrolled = |cloud: &PointCloud| {
        let enrolled = enrol_whole(cloud, &about("sheet"), &EnrolParams::default());
        enrolled.expect("a part").part
    };
    let (expected_low, expected_high) = enrolled(&clean).cloud.bounds().expect("points");
    for stray in [[0.0; 3], [0.0, 0.0, -1.0], [0.0, 0.0, 5.0], [3.0, 0.0, 1.3]] {
        let mut cloud = clean.clone();
        // Several at one place become one point of the thinned cloud.
        cloud.points.extend([Point3::from(stray); 5]);
        let part = enrolled(&cloud);
        assert_eq!(part.meta.coverage, Coverage::OneSide, "{stray:?}");
        // The cubes begin at the stray point, so their means move by up to a cube.
        let (low, high) = part.cloud.bounds().expect("points");
        let off = (low - expected_low)
            .amax()
            .max((high - expected_high).amax());
        assert!(off < 0.01, "{stray:?}: {low} to {high}");
    }
}

#[test]
fn a_few_isolated_points_are_dropped_and_many_are_kept() {
    let voxel = Metres::from_mm(8.0);
    let fine = sheet(|x, y| x.abs() < 0.1 && y.abs() < 0.1);
    assert_eq!(without_isolated(fine.clone(), voxel), fine);
    let mut stray = fine.clone();
    stray.points.insert(700, Point3::new(0.3, 0.0, 1.3));
    assert_eq!(without_isolated(stray, voxel), fine);
    // Coarse around a fine middle, as the corners of a mesh are.
    let mut uneven = fine;
    let steps = || (-4..=4).map(|step| step as f32 * 0.1);
    let coarse = steps().flat_map(|y| steps().map(move |x| Point3::new(x, y, 1.3)));
    uneven.points.extend(coarse);
    assert_eq!(without_isolated(uneven.clone(), voxel), uneven);
}

#[test]
fn too_few_points_and_lines_are_refused_by_name() {
    let few = PointCloud::from_points([Point3::origin(); 5]);
    let params = EnrolParams::default();
    assert!(matches!(
        enrol_whole(&few, &about("x"), &params),
        Err(EnrolError::TooFewPoints { found: 5, .. })
    ));
    let line = PointCloud::from_points((0..500).map(|i| Point3::new(i as f32 * 0.01, 0.0, 1.0)));
    assert!(matches!(
        enrol_whole(&line, &about("x"), &params),
        Err(EnrolError::Reference(_))
    ));
    assert!(matches!(
        enrol_captured(&SceneCloud::default(), &about("x"), &params),
        Err(EnrolError::NoPart(
            stages::segment::NoPart::TooFewPoints { .. }
        ))
    ));
}

#[test]
fn a_part_from_all_that_segmentation_found_is_the_captured_one_and_less_makes_it_smaller() {
    let scene = captured(3);
    let params = EnrolParams::default();
    let found = segment(&scene, &params.segment).part.expect("a part");
    let whole = enrol_captured(&scene, &about("fender"), &params).expect("a part");
    let same = enrol_selected(&scene, &found.indices, &about("fender"), &params).expect("a part");
    assert_eq!(same.part, whole.part);
    assert_eq!(same.warnings, whole.warnings);

    let half: Vec<u32> = found.indices[..found.indices.len() / 2].to_vec();
    let half = enrol_selected(&scene, &half, &about("fender"), &params).expect("a part");
    assert_eq!(half.part.meta.enrolled.how, EnrolMethod::Segmented);
    assert!(half.part.signature.area_m2 < 0.8 * whole.part.signature.area_m2);
    let few = enrol_selected(&scene, &found.indices[..20], &about("x"), &params);
    assert!(matches!(few, Err(EnrolError::TooFewKept { found: 20, .. })));
}

#[test]
fn background_that_was_added_and_pieces_that_lie_apart_are_warned_of() {
    let scene = captured(3);
    let params = EnrolParams::default();
    let found = segment(&scene, &params.segment);
    let part = found.part.expect("a part");
    let warnings = |indices: &[u32]| {
        let enrolled = enrol_selected(&scene, indices, &about("fender"), &params);
        enrolled.expect("enough points").warnings
    };
    let is_wall = |i: &u32| found.labels[*i as usize] == PointLabel::Background(0);
    let wall = (0..found.labels.len() as u32).filter(is_wall);
    let mut with_wall: Vec<u32> = part.indices.iter().copied().chain(wall).collect();
    with_wall.sort_unstable();
    let share = 1.0 - part.indices.len() as f64 / with_wall.len() as f64;
    let percent = (share * 100.0).round() as u8;
    let warnings_of_scene = warnings(&with_wall);
    assert!(
        warnings_of_scene.contains(&EnrolWarning::OnBackground { percent }),
        "{warnings_of_scene:?}"
    );

    // Without the middle third of its width: two pieces of about the same size.
    let column = |i: &u32| scene.cloud.points[*i as usize].x;
    let (low, high) = part.cloud.bounds().expect("points");
    let width = high.x - low.x;
    let is_outer = |i: &u32| (column(i) - low.x - width / 2.0).abs() > width / 6.0;
    let outer: Vec<u32> = part.indices.iter().copied().filter(is_outer).collect();
    let apart = warnings(&outer);
    let is_apart =
        |warning: &EnrolWarning| matches!(warning, EnrolWarning::Apart { percent: 10..=50 });
    assert!(apart.iter().any(is_apart), "{apart:?}");
    assert!(
        !apart
            .iter()
            .any(|w| matches!(w, EnrolWarning::OnBackground { .. }))
    );
}

/// A flat sheet 1.3 m in front of the camera, with a point every 5 mm.
fn sheet(is_inside: impl Fn(f32, f32) -> bool) -> PointCloud {
    let steps = || (-100..=100).map(|step| step as f32 * 0.005);
    let all = steps().flat_map(|y| steps().map(move |x| (x, y)));
    PointCloud {
        points: all
            .filter(|(x, y)| is_inside(*x, *y))
            .map(|(x, y)| Point3::new(x, y, 1.3))
            .collect(),
        ..PointCloud::default()
    }
}

#[test]
fn a_shape_that_does_not_fix_the_pose_is_warned_of() {
    let warnings = |cloud: &PointCloud| {
        let enrolled = enrol_whole(cloud, &about("sheet"), &EnrolParams::default());
        enrolled.expect("enough points").warnings
    };
    let oblong = warnings(&sheet(|x, y| x.abs() < 0.4 && y.abs() < 0.25));
    assert_eq!(oblong, [EnrolWarning::Symmetric { degrees: 180 }]);
    // Any rotation fits; which one is named does not matter.
    let disc = warnings(&sheet(|x, y| x.hypot(y) < 0.3));
    assert!(
        matches!(
            disc[..],
            [EnrolWarning::Unconstrained(_) | EnrolWarning::Symmetric { .. }]
        ),
        "{disc:?}"
    );
    let corner = warnings(&sheet(|x, y| {
        x.abs() < 0.4 && y.abs() < 0.25 && (x < 0.1 || y < 0.0)
    }));
    assert_eq!(corner, []);
}

#[test]
fn the_shape_of_every_simulated_part_fixes_its_pose() {
    for kind in PartKind::ALL {
        let setup = CellSetup::with_part(kind, Side::Left, 0, 3);
        let scene = scene_of(&setup);
        let enrolled = enrol_captured(&scene, &about("part"), &EnrolParams::default());
        assert_eq!(enrolled.expect("a part").warnings, [], "{kind:?}");
    }
}

#[test]
fn a_part_too_small_to_be_recognised_is_warned_of() {
    let small = sheet(|x, y| x.abs() < 0.1 && y.abs() < 0.08);
    let enrolled = enrol_whole(&small, &about("sheet"), &EnrolParams::default());
    let warnings = enrolled.expect("enough points").warnings;
    assert!(
        matches!(warnings[..], [EnrolWarning::TooLittle { score, .. }] if score < 0.5),
        "{warnings:?}"
    );
}

#[test]
fn a_cloud_that_faces_one_way_is_shown_from_there() {
    // As `scan --part-only` writes it: in the frame of a robot, with normals towards the cameras.
    let mut cloud = sheet(|x, y| x.abs() < 0.4 && y.abs() < 0.25 && (x < 0.1 || y < 0.0));
    for point in &mut cloud.points {
        point.z = 0.0;
    }
    for towards in [Vector3::z(), -Vector3::z()] {
        cloud.normals = Some(vec![towards; cloud.points.len()]);
        let enrolled = enrol_whole(&cloud, &about("sheet"), &EnrolParams::default());
        let part = enrolled.expect("enough points").part;
        assert_eq!(part.meta.coverage, Coverage::SeveralSides);
        assert_eq!(part.meta.schema_version, SCANNED_VERSION);
        let area = part.signature.area_m2;
        assert!((area - 0.325).abs() < 0.02, "{area}");
    }
}
