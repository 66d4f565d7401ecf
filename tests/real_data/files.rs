//! Files from other sources, compared with the results of independent readers.
//!
//! The expected numbers are those of pypcd4 1.5.1 (PCD), plyfile 1.1.5 (PLY) and trimesh 5.2.0 (glTF), with numpy
//! 2.4.6. Extents are compared to a hundredth of a millimetre. The counts of the two lidar scans are without their 5107
//! and 5032 exact zeros, which are no readings.

use std::path::Path;

use nalgebra::Point3;
use partsight::files::{FileContent, open, save_cloud, write_pcd};
use partsight::geometry::cloud::{Grid, PointCloud};
use partsight::robot::calibration::{CalibrationError, CellCalibration};

use crate::data_folder;

const KINECT: Option<Grid> = Some(Grid {
    width: 640,
    height: 480,
});

/// Figures of a cloud from an independent reader.
struct ExpectedCloud {
    file: &'static str,
    num_points: usize,
    num_finite: usize,
    grid: Option<Grid>,
    low: [f32; 3],
    high: [f32; 3],
    /// Sums of red, green and blue over the finite points.
    colour_sums: Option<[u64; 3]>,
    /// Number of finite points of each label.
    labels: &'static [(u32, usize)],
}

const PLAIN: ExpectedCloud = ExpectedCloud {
    file: "",
    num_points: 0,
    num_finite: 0,
    grid: None,
    low: [0.0; 3],
    high: [0.0; 3],
    colour_sums: None,
    labels: &[],
};

#[rustfmt::skip]
const CLOUDS: [ExpectedCloud; 12] = [
    ExpectedCloud { file: "frames/five_people.pcd", num_points: 307_200, num_finite: 239_075, grid: KINECT,
        low: [-1.931_119_2, -3.874_923_2, 1.759], high: [2.988_514_4, 1.140_605_7, 9.757_001],
        colour_sums: Some([25_348_041, 25_268_048, 25_137_963]), ..PLAIN },
    ExpectedCloud { file: "frames/milk_cartoon_all_small_clorox.pcd", num_points: 307_200, num_finite: 241_407, grid: KINECT,
        low: [-1.060_8, -0.869_233_4, 0.501], high: [1.152_494, 0.219_668_6, 2.063],
        colour_sums: Some([18_193_150, 16_419_160, 14_847_059]), ..PLAIN },
    ExpectedCloud { file: "frames/milk_color.pcd", num_points: 13_704, num_finite: 13_704,
        low: [-0.140_082_9, -0.263_78, 0.714], high: [0.013_806_67, -0.011_728_57, 0.891],
        colour_sums: Some([1_253_588, 1_270_390, 1_299_452]), ..PLAIN },
    ExpectedCloud { file: "frames/region_growing_rgb_tutorial.pcd", num_points: 307_200, num_finite: 259_847, grid: KINECT,
        low: [-1.072_057, -1.580_64, 0.843], high: [1.810_153, 0.408_091_5, 3.821],
        colour_sums: Some([41_468_041, 36_508_734, 34_265_005]), ..PLAIN },
    ExpectedCloud { file: "frames/sac_plane_test.pcd", num_points: 3_283, num_finite: 3_283,
        low: [0.666_55, -0.578_68, -0.342_5], high: [1.451_5, 0.446_56, 0.302_6], ..PLAIN },
    ExpectedCloud { file: "frames_labelled/learn0.pcd", num_points: 307_200, num_finite: 182_292, grid: KINECT,
        low: [-0.749_931_4, -0.205_536_2, 0.578], high: [0.633_204_8, 0.293_922_9, 1.301],
        colour_sums: Some([39_617_722, 35_916_236, 34_827_014]),
        labels: &[(1, 153_323), (20, 20_792), (30, 8_177)] },
    ExpectedCloud { file: "frames_labelled/learn16.pcd", num_points: 307_200, num_finite: 202_203, grid: KINECT,
        low: [-0.537_390_5, -0.366_488_6, 0.583], high: [0.438_4, 0.270_521, 1.287],
        colour_sums: Some([39_205_992, 35_493_802, 35_981_688]),
        labels: &[(1, 180_090), (20, 7_338), (30, 10_224), (40, 4_551)] },
    ExpectedCloud { file: "frames_labelled/learn40.pcd", num_points: 307_200, num_finite: 172_285, grid: KINECT,
        low: [-0.599_430_5, -0.416_176_2, 0.629], high: [0.338_404_8, 0.292_874_3, 1.657],
        colour_sums: Some([28_669_465, 26_398_339, 25_936_177]),
        labels: &[(1, 137_147), (20, 14_953), (30, 3_452), (40, 513), (41, 15_676), (42, 544)] },
    ExpectedCloud { file: "registration/bun000.ply", num_points: 40_256, num_finite: 40_256,
        low: [-0.094_75, 0.035_736_3, -0.058_698_2], high: [0.061, 0.187_94, 0.058_722_8], ..PLAIN },
    ExpectedCloud { file: "registration/bun045.ply", num_points: 40_097, num_finite: 40_097,
        low: [-0.063_25, 0.034_209_1, -0.045_165_3], high: [0.084, 0.187_639, 0.093_523_3], ..PLAIN },
    ExpectedCloud { file: "registration/gicp_source.ply", num_points: 64_685, num_finite: 64_685,
        low: [-23.759_02, -52.001_14, -3.021_289_8], high: [18.479_933, 6.507_869, 9.172_805], ..PLAIN },
    ExpectedCloud { file: "registration/gicp_target.ply", num_points: 64_056, num_finite: 64_056,
        low: [-23.337_479, -74.681_61, -2.957_336], high: [19.024_696, 8.919_51, 10.795_936], ..PLAIN },
];

/// Name, vertices, triangles, lowest and highest corner in the scene, area.
type ExpectedMesh = (&'static str, usize, usize, [f32; 3], [f32; 3], f64);

#[rustfmt::skip]
const MESHES: [ExpectedMesh; 62] = [
    ("Body", 6525, 8988, [-1.89678, 0.25305, -0.80884], [1.91033, 1.29360, 0.80884], 21.10779),
    ("BrakeRotor_BL", 256, 252, [-1.26966, 0.20635, -0.67955], [-1.02152, 0.45449, -0.63604], 0.11815),
    ("BrakeRotor_BR", 256, 252, [-1.26966, 0.20635, 0.63604], [-1.02152, 0.45449, 0.67955], 0.11815),
    ("BrakeRotor_FL", 256, 252, [1.13034, 0.20635, -0.67955], [1.37848, 0.45449, -0.63604], 0.11815),
    ("BrakeRotor_FR", 256, 252, [1.13034, 0.20635, 0.63604], [1.37848, 0.45449, 0.67955], 0.11815),
    ("Brake_BL", 1452, 1944, [-1.07093, 0.24835, -0.66505], [-1.00087, 0.41249, -0.61602], 0.06275),
    ("Brake_BR", 1454, 1944, [-1.07093, 0.24835, 0.63449], [-1.00087, 0.41249, 0.68351], 0.06275),
    ("Brake_FL", 1453, 1944, [1.10968, 0.24835, -0.66505], [1.17974, 0.41249, -0.61602], 0.06275),
    ("Brake_FR", 1452, 1944, [1.10968, 0.24835, 0.61602], [1.17974, 0.41249, 0.66505], 0.06275),
    ("Center_Mirror", 565, 660, [0.29037, 1.17363, -0.10139], [0.35393, 1.23257, 0.09344], 0.02601),
    ("Center_Mirror_Mount", 227, 290, [0.30406, 1.19801, -0.03266], [0.35118, 1.28480, 0.03266], 0.00504),
    ("Door_FL", 360, 500, [-0.33704, 0.30402, -0.80132], [0.67528, 0.90452, -0.65716], 1.28270),
    ("Door_FR", 360, 500, [-0.33704, 0.30402, 0.65716], [0.67528, 0.90452, 0.80132], 1.28270),
    ("FrontSeat_Backrest_L", 466, 668, [-0.26249, 0.44214, -0.60289], [-0.04120, 0.91547, -0.06046], 0.58731),
    ("FrontSeat_Backrest_R", 465, 668, [-0.26249, 0.44214, 0.06046], [-0.04120, 0.91547, 0.60289], 0.58731),
    ("FrontSeat_Seating_L", 909, 1240, [-0.08980, 0.30262, -0.61771], [0.40440, 0.56068, -0.04563], 0.77342),
    ("FrontSeat_Seating_R", 908, 1240, [-0.08980, 0.30262, 0.04563], [0.40440, 0.56068, 0.61771], 0.77342),
    ("Indicator_Lens_BL", 200, 276, [-1.89238, 0.61930, -0.67648], [-1.87483, 0.67142, -0.62436], 0.00509),
    ("Indicator_Lens_BR", 200, 276, [-1.89238, 0.61930, 0.62436], [-1.87483, 0.67142, 0.67648], 0.00509),
    ("Indicator_Lens_FL", 200, 276, [1.79519, 0.45343, -0.66091], [1.81274, 0.50555, -0.60879], 0.00509),
    ("Indicator_Lens_FR", 200, 276, [1.79519, 0.45343, 0.60879], [1.81274, 0.50555, 0.66091], 0.00509),
    ("Indicator_Reflector_BL", 320, 338, [-1.87832, 0.61567, -0.68011], [-1.85386, 0.67504, -0.62073], 0.00462),
    ("Indicator_Reflector_BR", 320, 338, [-1.87832, 0.61567, 0.62074], [-1.85386, 0.67504, 0.68011], 0.00462),
    ("Indicator_Reflector_FL", 320, 338, [1.77422, 0.44980, -0.66454], [1.79868, 0.50918, -0.60516], 0.00462),
    ("Indicator_Reflector_FR", 320, 338, [1.77422, 0.44980, 0.60516], [1.79868, 0.50918, 0.66454], 0.00462),
    ("License_Plate_F", 24, 12, [1.91728, 0.49494, -0.26000], [1.92728, 0.60494, 0.26000], 0.12700),
    ("License_Plate_R", 24, 12, [-1.92728, 0.49494, -0.26000], [-1.91728, 0.60494, 0.26000], 0.12700),
    ("Light_Brake_Lens_BL", 200, 276, [-1.89238, 0.50056, -0.67648], [-1.87483, 0.55268, -0.62436], 0.00509),
    ("Light_Brake_Lens_BR", 200, 276, [-1.89238, 0.50056, 0.62436], [-1.87483, 0.55268, 0.67648], 0.00509),
    ("Light_Brake_Reflector_BL", 320, 338, [-1.87832, 0.49694, -0.68011], [-1.85386, 0.55631, -0.62073], 0.00462),
    ("Light_Brake_Reflector_BR", 320, 338, [-1.87832, 0.49694, 0.62074], [-1.85386, 0.55631, 0.68011], 0.00462),
    ("Light_Low_Beam_Lens_FL", 448, 700, [1.83132, 0.57230, -0.72344], [1.86188, 0.74630, -0.54944], 0.05127),
    ("Light_Low_Beam_Lens_FR", 450, 700, [1.83132, 0.57230, 0.54943], [1.86188, 0.74630, 0.72343], 0.05127),
    ("Light_Low_Beam_Reflector_FL", 610, 636, [1.76064, 0.56558, -0.73016], [1.83901, 0.75302, -0.54271], 0.07781),
    ("Light_Low_Beam_Reflector_FR", 610, 636, [1.76064, 0.56558, 0.54271], [1.83901, 0.75302, 0.73016], 0.07781),
    ("Light_Tail_Lens_BL", 200, 276, [-1.89238, 0.55993, -0.67648], [-1.87483, 0.61205, -0.62436], 0.00509),
    ("Light_Tail_Lens_BR", 200, 276, [-1.89238, 0.55993, 0.62436], [-1.87483, 0.61205, 0.67648], 0.00509),
    ("Light_Tail_Reflector_BL", 320, 338, [-1.87832, 0.55630, -0.68011], [-1.85386, 0.61568, -0.62073], 0.00462),
    ("Light_Tail_Reflector_BR", 320, 338, [-1.87832, 0.55630, 0.62074], [-1.85386, 0.61568, 0.68011], 0.00462),
    ("RearSeat_Backrest", 762, 1520, [-0.83393, 0.50527, -0.51910], [-0.71221, 0.91558, 0.51910], 0.95546),
    ("RearSeat_Seating", 803, 1392, [-0.72291, 0.44640, -0.51488], [-0.34212, 0.52875, 0.51488], 0.88756),
    ("Rim_BL", 1717, 1682, [-1.33311, 0.14290, -0.73694], [-0.95808, 0.51794, -0.58065], 0.60318),
    ("Rim_BR", 1717, 1682, [-1.33311, 0.14290, 0.58065], [-0.95808, 0.51794, 0.73694], 0.60318),
    ("Rim_FL", 1717, 1682, [1.06689, 0.14290, -0.73694], [1.44192, 0.51794, -0.58065], 0.60318),
    ("Rim_FR", 1717, 1682, [1.06689, 0.14290, 0.58065], [1.44192, 0.51794, 0.73694], 0.60318),
    ("Roof", 1499, 2150, [-1.06433, 0.90447, -0.69862], [0.31652, 1.29637, 0.69862], 3.01279),
    ("Side_Mirror_L", 407, 608, [0.41167, 0.88951, -0.80170], [0.46665, 0.97637, -0.71870], 0.01535),
    ("Side_Mirror_Mount_L", 303, 490, [0.42050, 0.85942, -0.78736], [0.50230, 0.94597, -0.68559], 0.01343),
    ("Side_Mirror_Mount_R", 303, 490, [0.42050, 0.85942, 0.68559], [0.50230, 0.94597, 0.78736], 0.01343),
    ("Side_Mirror_R", 407, 608, [0.40676, 0.88800, 0.71593], [0.46743, 0.97523, 0.79213], 0.01535),
    ("Steering_Column", 165, 128, [0.50109, 0.60928, -0.35067], [1.03540, 0.84854, -0.31267], 0.06131),
    ("Steering_Wheel_Hub", 680, 848, [0.32686, 0.77086, -0.51667], [0.52033, 0.90357, -0.14667], 0.06294),
    ("Steering_Wheel_Rim", 637, 1144, [0.28133, 0.70154, -0.53167], [0.43914, 1.07536, -0.13167], 0.07399),
    ("Tire_BL", 914, 512, [-1.47601, 0.00000, -0.73352], [-0.81517, 0.66084, -0.58400], 0.91219),
    ("Tire_BR", 915, 512, [-1.47601, 0.00000, 0.58400], [-0.81517, 0.66084, 0.73352], 0.91219),
    ("Tire_FL", 601, 512, [0.92399, 0.00000, -0.73352], [1.58483, 0.66084, -0.58400], 0.91219),
    ("Tire_FR", 915, 512, [0.92399, 0.00000, 0.58400], [1.58483, 0.66084, 0.73352], 0.91219),
    ("Trunk_Lid", 806, 1316, [-1.91255, 0.41123, -0.50373], [-1.35260, 0.91309, 0.50373], 1.75772),
    ("Window_F", 44, 42, [0.29286, 0.91789, -0.63801], [0.72434, 1.26734, 0.63801], 0.58606),
    ("Window_FL", 30, 28, [-0.35254, 0.90502, -0.69084], [0.51296, 1.20440, -0.58802], 0.21094),
    ("Window_FR", 30, 28, [-0.35254, 0.90502, 0.58802], [0.51296, 1.20440, 0.69084], 0.21094),
    ("Window_R", 46, 46, [-1.02193, 0.96269, -0.58589], [-0.63283, 1.20180, 0.58589], 0.45000),
];

fn cloud_at(path: &Path) -> PointCloud {
    match open(path) {
        Ok(FileContent::Cloud(cloud)) => cloud,
        other => panic!("{}: expected a cloud, got {other:?}", path.display()),
    }
}

fn is_near(found: Point3<f32>, expected: [f32; 3]) -> bool {
    (found - Point3::from(expected)).amax() < 1e-5
}

#[test]
fn every_cloud_is_what_an_independent_reader_finds() {
    let Some(folder) = data_folder() else {
        return;
    };
    for expected in CLOUDS {
        let ExpectedCloud {
            file,
            num_points,
            num_finite,
            grid,
            low,
            high,
            colour_sums,
            labels,
        } = expected;
        let path = folder.join(file);
        let cloud = cloud_at(&path);
        assert_eq!(
            (cloud.points.len(), cloud.num_finite(), cloud.grid),
            (num_points, num_finite, grid),
            "{file}"
        );
        let (found_low, found_high) = cloud.bounds().expect("finite points");
        assert!(
            is_near(found_low, low) && is_near(found_high, high),
            "{file}: {found_low} to {found_high}"
        );
        // Only the plane has normals, but 15 of them are NaN, so none are kept.
        assert_eq!(cloud.normals, None, "{file}");

        let sums = cloud.colours.as_ref().map(|colours| {
            let finite = cloud.finite().map(|(i, _)| colours[i].map(u64::from));
            finite.fold([0; 3], |[r, g, b], [red, green, blue]| {
                [r + red, g + green, b + blue]
            })
        });
        assert_eq!(sums, colour_sums, "{file}");
        assert_eq!(cloud.labels.is_some(), !labels.is_empty(), "{file}");
        for &(label, count) in labels {
            let all = cloud.labels.as_ref().expect("labels");
            assert_eq!(
                cloud.finite().filter(|&(i, _)| all[i] == label).count(),
                count,
                "{file}: label {label}"
            );
        }
    }
}

#[test]
fn every_mesh_of_the_car_is_where_an_independent_reader_puts_it() {
    let Some(folder) = data_folder() else {
        return;
    };
    for (name, num_vertices, num_triangles, low, high, area) in MESHES {
        let path = folder.join(format!("car/vehicle_example.gltf#{name}"));
        let Ok(FileContent::Mesh(mesh)) = open(&path) else {
            panic!("{}: expected a mesh", path.display());
        };
        assert_eq!(
            (mesh.vertices.len(), mesh.triangles.len()),
            (num_vertices, num_triangles),
            "{name}"
        );
        let (found_low, found_high) = mesh.bounds().expect("vertices");
        assert!(
            is_near(found_low, low) && is_near(found_high, high),
            "{name}: {found_low} to {found_high}"
        );
        assert!(
            (mesh.area() - area).abs() < 2e-5 * area.max(1.0),
            "{name}: {} m²",
            mesh.area()
        );
    }
}

#[test]
fn a_real_frame_survives_being_saved_in_every_format() {
    let Some(folder) = data_folder() else {
        return;
    };
    let frame = cloud_at(&folder.join("frames_labelled/learn0.pcd"));
    let target = tempfile::tempdir().expect("a temporary folder");
    for ending in ["pcd", "ply", "xyz"] {
        let path = target.path().join(format!("frame.{ending}"));
        save_cloud(&path, &frame).expect("saved");
        let back = cloud_at(&path);
        let readings = |cloud: &PointCloud| cloud.finite().map(|(_, p)| *p).collect::<Vec<_>>();
        assert_eq!(readings(&back), readings(&frame), "{ending}");
        assert_eq!(back.labels.is_some(), ending != "xyz");
        assert_eq!(back.grid, frame.grid.filter(|_| ending == "pcd"));
    }
    let (mut once, mut twice) = (Vec::new(), Vec::new());
    write_pcd(&mut once, &frame).expect("written");
    write_pcd(&mut twice, &cloud_at(&target.path().join("frame.pcd"))).expect("written");
    assert!(once == twice, "a PCD read and written again differs");
}

#[test]
fn a_hand_eye_calibration_with_a_changed_digit_is_refused_until_it_is_confirmed() {
    let Some(folder) = data_folder() else {
        return;
    };
    let target = tempfile::tempdir().expect("a temporary folder");
    let path = target.path().join("cell.toml");
    std::fs::copy(folder.join("reported/cell_digit/cell.toml"), &path).expect("copied");
    let error = CellCalibration::load(&path).expect_err("7.2 m instead of 1.2 m");
    assert!(matches!(error, CalibrationError::Edited { .. }), "{error}");
    assert!(CellCalibration::confirm(&path).expect("written").is_some());
    let confirmed = CellCalibration::load(&path).expect("confirmed");
    let shift = confirmed.camera.mount_from_camera().translation.vector;
    assert!((shift.x - 7.2).abs() < 1e-6, "{shift}");
}
