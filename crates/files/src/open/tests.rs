mod mutations;

use std::fs;
use std::path::PathBuf;

use nalgebra::{Point3, Vector3};
use tempfile::TempDir;

use super::*;
use crate::import::LengthUnit;
use crate::{Expected, FileWarning, read_text};
use geometry::error::Advice as _;
use geometry::fixtures::small_frame;
use geometry::units::Metres;

/// A folder that holds one file with these bytes.
fn file(name: &str, bytes: &[u8]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    (folder, path)
}

fn binary_stl() -> Vec<u8> {
    let mut bytes = b"solid in name only".to_vec();
    bytes.resize(80, b' ');
    bytes.extend(1_u32.to_le_bytes());
    for number in [
        0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0, 0.0_f32,
    ] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend([0, 0]);
    bytes
}

const PCD: &str = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nDATA ascii\n1 2 3\n";
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n";
const STL: &str = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n";
const OBJ: &str = "# made by hand\n\no part\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn a_format_is_known_by_its_content_whatever_the_name() {
    for name in ["file.ply", "file.pcd", "file.stl", "file.txt", "file"] {
        for text in [PCD, PLY, "1 2 3\n", "x;y;z\n1;2;3\n"] {
            let (_folder, path) = file(name, text.as_bytes());
            let expected = PointCloud::from_points([Point3::new(1.0, 2.0, 3.0)]);
            assert_eq!(
                open(&path).unwrap(),
                FileContent::Cloud(expected),
                "{name}: {text}"
            );
        }
        for bytes in [STL.as_bytes(), OBJ.as_bytes(), &binary_stl()] {
            let (_folder, path) = file(name, bytes);
            assert!(
                matches!(open(&path), Ok(FileContent::Mesh(mesh)) if mesh.triangles == [[0, 1, 2]]),
                "{name}"
            );
        }
    }
}

#[test]
fn the_meshes_of_a_file_are_listed_with_the_paths_that_open_them() {
    let two = "o Left door\nv 0 0 0\nv 1000 0 0\nv 0 500 0\nv 0 0 200\nf 1 2 3\nf 1 2 4\no Hood\nf 1 3 4\n";
    let (_folder, path) = file("car.obj", two.as_bytes());
    let with = |words: &str| PathBuf::from(format!("{}{words}", path.display()));
    let OpenedFile::Several(listed) = open_each(&with("#up=z")).unwrap() else {
        panic!("several");
    };
    assert!(listed.opens_whole);
    let door = &listed.meshes[0];
    assert_eq!((door.name.as_str(), door.num_triangles()), ("Left door", 2));
    // Width, height and depth as the camera has them, in the unit of the file.
    assert_eq!(door.size(), Some(Vector3::new(1000.0, 200.0, 500.0)));
    let ways = [
        (
            Some("Left door"),
            LengthUnit::Millimetres,
            "#Left door#units=mm#up=z",
        ),
        (None, LengthUnit::Metres, "#up=z"),
    ];
    for (named, unit, words) in ways {
        let opened = listed.path_of(named, unit);
        assert_eq!(opened, with(words));
        let FileContent::Mesh(mesh) = open(&opened).unwrap() else {
            panic!("{opened:?}");
        };
        assert_eq!(mesh.triangles.len(), if named.is_some() { 2 } else { 3 });
        let (low, high) = mesh.bounds().expect("some");
        assert!(((high - low).x - 1000.0 * unit.metres()).abs() < 1e-3);
    }
    let is_one = |path: &Path| {
        let opened = open_each(path).unwrap();
        matches!(opened, OpenedFile::One(content) if content == open(path).unwrap())
    };
    assert!(is_one(&with("#Hood")));
    for other in [OBJ.as_bytes(), STL.as_bytes(), PCD.as_bytes()] {
        let (_folder, path) = file("one", other);
        assert!(is_one(&path));
    }
    let (_folder, broken) = file("car.obj", two.replace("f 1 3 4", "f 1 3 9").as_bytes());
    let [each, whole] = [open_each(&broken).unwrap_err(), open(&broken).unwrap_err()];
    assert_eq!(each.to_string(), whole.to_string());
}

#[test]
fn every_small_file_cut_anywhere_opens_or_fails_by_name() {
    let folder = tempfile::tempdir().unwrap();
    // All before any is opened: opening waits until a file is old enough for any later change to show in its time.
    let cuts = |bytes: &[u8], ending: &str| -> Vec<_> {
        let cut = |length: usize| {
            let path = folder.path().join(format!("cut{length}{ending}"));
            fs::write(&path, &bytes[..length]).unwrap();
            path
        };
        (0..bytes.len()).map(cut).collect()
    };
    for bytes in [
        PCD.as_bytes(),
        PLY.as_bytes(),
        STL.as_bytes(),
        OBJ.as_bytes(),
        b"x,y,z\n1,2,3\n",
        &binary_stl(),
    ] {
        for path in cuts(bytes, "") {
            if let Err(error) = open(&path) {
                assert!(error.to_string().contains("cut") && !error.advice().is_empty());
            }
        }
    }
    let frame = small_frame(2, [0, 1, 2, 3]);
    let whole = folder.path().join("whole.png");
    super::super::write_depth_png(&whole, &frame).unwrap();
    let bytes = fs::read(&whole).unwrap();
    for (length, path) in cuts(&bytes, ".png").into_iter().enumerate() {
        match open(&path) {
            // The last chunk holds nothing.
            Ok(opened) => assert_eq!(
                opened,
                FileContent::Depth(frame.clone()),
                "{length} of {}",
                bytes.len()
            ),
            Err(error) => assert!(!error.advice().is_empty()),
        }
    }
}

#[test]
fn a_hash_sign_may_belong_to_the_file_or_begin_a_mesh_name() {
    let (_folder, path) = file("scan#2.pcd", PCD.as_bytes());
    assert!(matches!(open(&path), Ok(FileContent::Cloud(_))));
    let named = path.with_file_name("scan#2.pcd#Door#L");
    let error = open(&named).unwrap_err();
    assert!(
        matches!(&error, FileError::NoSuchMesh { path: of, wanted, available }
            if *of == path && wanted == "Door#L" && available.is_empty()),
        "{error}"
    );
    assert!(error.advice().contains("without a name"));
    let missing = path.with_file_name("scan#3.pcd");
    assert!(matches!(open(&missing), Err(FileError::NotFound { path }) if path == missing));
}

#[test]
fn what_is_no_readable_file_is_named() {
    let (folder, empty) = file("empty.pcd", b"");
    assert!(matches!(open(&empty), Err(FileError::Empty { .. })));
    let error = open(folder.path()).unwrap_err();
    assert!(matches!(error, FileError::FolderOfCaptures { .. }));
    assert!(error.advice().contains("*.png"), "{}", error.advice());
    let error = read_text(folder.path(), 100).unwrap_err();
    assert!(error.to_string().contains("a folder, expected a file"));
    assert!(!error.advice().contains("captures"), "{}", error.advice());
    assert!(matches!(
        open(&folder.path().join("none.pcd")),
        Err(FileError::NotFound { .. })
    ));
}

#[test]
fn content_of_no_known_format_is_described() {
    for (bytes, word) in [
        (b"\xff\xd8\xff\xe0\0\0".as_slice(), "JPEG"),
        (b"PK\x03\x04\0\0", "ZIP"),
        (b"\x01\x02\x03\0", "01 02 03 00"),
        (b"Dear customer,\nthank you\n", "Dear customer,"),
        (b"{\"width\": 640}", "width"),
        (b" \n \n", "\"\""),
    ] {
        let (_folder, path) = file("file.bin", bytes);
        let error = open(&path).unwrap_err();
        assert!(
            matches!(&error, FileError::UnknownFormat { found, .. } if found.contains(word)),
            "{error}"
        );
    }
    // The content of a cut binary STL cannot be recognised.
    let (_folder, path) = file("cut.stl", &binary_stl()[..100]);
    assert!(matches!(
        open(&path),
        Err(FileError::Truncated {
            expected: Expected::Bytes(134),
            ..
        })
    ));
}

#[test]
fn numbers_that_look_like_millimetres_are_warned_about_and_kept() {
    let (_folder, path) = file("door.xyz", b"0 0 600\n1100 0 650\n0 800 620\n");
    let opened = open(&path).unwrap();
    let warnings = opened.warnings();
    assert_eq!(
        warnings,
        [FileWarning::TooWideForMetres {
            extent: Metres(1100.0)
        }]
    );
    assert!(warnings[0].to_string().contains("1100 m") && !warnings[0].advice().is_empty());
    // The window has a button for it, and no options.
    assert!(!warnings[0].advice().contains("--"));
    assert!(
        matches!(opened, FileContent::Cloud(cloud) if cloud.points[1] == Point3::new(1100.0, 0.0, 650.0))
    );
    let (_folder, path) = file("door.xyz", b"0 0 0.6\n1.1 0 0.65\n");
    assert_eq!(open(&path).unwrap().warnings(), []);
}

#[test]
fn numbers_that_are_not_metres_may_be_in_several_units() {
    // A capture of a cell in centimetres, and in millimetres.
    for (scale, wanted) in [
        (100, "may be in millimetres, centimetres or inches"),
        (1000, "may be in millimetres"),
    ] {
        let text = format!("0 0 {scale}\n{} 0 {scale}\n", 3 * scale);
        let (_folder, path) = file("cell.xyz", text.as_bytes());
        let warnings = open(&path).unwrap().warnings();
        let [warning] = warnings[..] else {
            panic!("{warnings:?}");
        };
        assert!(warning.to_string().ends_with(wanted), "{warning}");
        assert_eq!(warning.advice().contains("own unit"), scale == 100);
    }
}

#[test]
fn a_capture_behind_the_camera_is_warned_about_with_or_without_rows() {
    let lines = |num_behind: usize| {
        let z = |i| if i < num_behind { -1.2 } else { 1.2 };
        let points = (0..2000).map(|i| format!("{} {} {}\n", i % 50, i / 50, z(i)));
        points.collect::<Vec<_>>().concat()
    };
    for (num_behind, expected) in [(0, None), (2, None), (3, Some(0.0015)), (2000, Some(1.0))] {
        let (_folder, path) = file("scene.xyz", lines(num_behind).as_bytes());
        let opened = open(&path).unwrap();
        // A cloud to be enrolled may be in any frame.
        assert_eq!(opened.warnings(), [], "{num_behind}");
        let behind = expected.map(|share| FileWarning::BehindCamera { share });
        assert_eq!(opened.warnings_as_capture(), Vec::from_iter(behind));
    }
}

#[test]
fn metres_that_were_read_as_millimetres_are_warned_about() {
    let points = (0..2500).map(|i| {
        format!(
            "{} {} 1.4\n",
            0.02 * f64::from(i % 50),
            0.02 * f64::from(i / 50)
        )
    });
    let (_folder, path) = file("door.xyz", points.collect::<String>().as_bytes());
    assert_eq!(open(&path).unwrap().warnings(), []);
    let in_millimetres = PathBuf::from(format!("{}#units=mm", path.display()));
    let warnings = open(&in_millimetres).unwrap().warnings();
    assert!(
        matches!(warnings[..], [FileWarning::TooSmall { .. }]),
        "{warnings:?}"
    );
    assert!(
        warnings[0].to_string().contains("only 1.0 mm"),
        "{warnings:?}"
    );
    assert!(!warnings[0].advice().contains("--"));
}
