use std::path::Path;

use nalgebra::{Point3, Vector3};
use proptest::prelude::*;

use super::*;
use geometry::mesh::TriangleMesh;

fn source(bytes: &[u8]) -> Source<'_> {
    Source {
        path: Path::new("test.ply"),
        bytes,
    }
}

fn read_bytes(bytes: &[u8]) -> Result<FileContent, FileError> {
    assert!(is_ply(bytes), "not recognised");
    read(source(bytes))
}

fn cloud_in(bytes: &[u8]) -> PointCloud {
    match read_bytes(bytes) {
        Ok(FileContent::Cloud(cloud)) => cloud,
        other => panic!("expected a cloud, got {other:?}"),
    }
}

fn mesh_in(bytes: &[u8]) -> TriangleMesh {
    match read_bytes(bytes) {
        Ok(FileContent::Mesh(mesh)) => mesh,
        other => panic!("expected a mesh, got {other:?}"),
    }
}

const ELEMENTS: &str = "comment caf\u{e9}\nobj_info none\nelement camera 1\nproperty list uchar short size\n\
    element vertex 4\nproperty double x\nproperty float y\nproperty list uchar int extra\nproperty float z\n\
    property float scalar_distance[<1]\nelement face 2\nproperty uchar flags\nproperty list uchar uint vertex_indices\n\
    element range_grid 3\nproperty list uchar int vertex_indices\nend_header\n";

/// A square as a triangle and a polygon that repeats a corner, in each of the three storages.
pub(crate) fn same_mesh_stored_three_ways() -> [Vec<u8>; 3] {
    let header = |format: &str| format!("ply\nformat {format} 1.0\n{ELEMENTS}").into_bytes();
    let text = "2 640 480\n0 0 0 0 nan\n1 0 1 9 0 .5\n1 1 2 8 7 0 5.\n0 1 0 0 1e-3\n1 3 0 1 2\n0 4 0 2 3 0\n0\n1 1\n0\n";
    let binary = |swap: bool| {
        let mut out = Vec::new();
        let mut put = |bytes: &[u8]| {
            if swap {
                out.extend(bytes.iter().rev());
            } else {
                out.extend_from_slice(bytes);
            }
        };
        put(&[2]);
        put(&640_i16.to_le_bytes());
        put(&480_i16.to_le_bytes());
        for (x, y, extra) in [
            (0.0_f64, 0.0_f32, vec![]),
            (1.0, 0.0, vec![9_i32]),
            (1.0, 1.0, vec![8, 7]),
            (0.0, 1.0, vec![]),
        ] {
            put(&x.to_le_bytes());
            put(&y.to_le_bytes());
            put(&[extra.len() as u8]);
            for item in extra {
                put(&item.to_le_bytes());
            }
            put(&0_f32.to_le_bytes());
            put(&f32::NAN.to_le_bytes());
        }
        for polygon in [vec![0_u32, 1, 2], vec![0, 2, 3, 0]] {
            put(&[1]);
            put(&[polygon.len() as u8]);
            for corner in polygon {
                put(&corner.to_le_bytes());
            }
        }
        out
    };
    [
        [header("ascii"), text.into()].concat(),
        [header("binary_little_endian"), binary(false)].concat(),
        [header("binary_big_endian"), binary(true)].concat(),
    ]
}

#[test]
fn the_three_storages_hold_the_same_mesh() {
    for bytes in same_mesh_stored_three_ways() {
        let mesh = mesh_in(&bytes);
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        assert_eq!(mesh.vertices, corners.map(|(x, y)| Point3::new(x, y, 0.0)));
        assert_eq!(mesh.triangles[0], [0, 1, 2]);
        assert_eq!(mesh.triangles.len(), 2);
        assert!((mesh.area() - 1.0).abs() < 1e-9);
    }
}

#[test]
fn a_file_cut_anywhere_is_an_error_or_whole_and_never_a_panic() {
    for bytes in same_mesh_stored_three_ways() {
        let whole = mesh_in(&bytes);
        for length in 0..bytes.len() {
            match read(source(&bytes[..length])) {
                // Bytes behind the faces are not needed.
                Ok(FileContent::Mesh(mesh)) => assert_eq!(mesh, whole),
                Ok(other) => panic!("{other:?}"),
                Err(_) => {}
            }
        }
    }
}

#[test]
fn normals_colours_and_labels_are_read_in_any_type() {
    let text = "ply\r\nformat ascii 1.0\r\nelement vertex 2\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\n\
        property float nx\r\nproperty float ny\r\nproperty float nz\r\nproperty float red\r\nproperty float green\r\n\
        property float blue\r\nproperty int label\r\nend_header\r\n1 2 3 0 0 2 1.0 0.5 0 3\r\n4 5 6 0 1 0 0 0 1 4\r\n";
    let cloud = cloud_in(text.as_bytes());
    assert_eq!(cloud.normals, Some(vec![Vector3::z(), Vector3::y()]));
    assert_eq!(cloud.colours, Some(vec![[255, 128, 0], [0, 0, 255]]));
    assert_eq!(cloud.labels, Some(vec![3, 4]));
}

#[test]
fn points_without_a_reading_are_dropped_with_what_belongs_to_them() {
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n\
        1 2 3 1 1 1\nnan 0 0 2 2 2\n4 5 6 3 3 3\n";
    let cloud = cloud_in(text.as_bytes());
    assert_eq!(cloud.points.len(), 2);
    assert_eq!(cloud.colours, Some(vec![[1; 3], [3; 3]]));
    let none = text
        .replace("1 2 3 1", "inf 2 3 1")
        .replace("4 5 6", "4 nan 6");
    assert!(matches!(
        read_bytes(none.as_bytes()),
        Err(FileError::NoPoints { found: 3, .. })
    ));
}

#[test]
fn counts_beyond_the_bytes_take_no_memory() {
    for count in ["4000000000", "40000000", "18446744073709551615"] {
        for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
            for elements in [
                format!(
                    "element vertex {count}\nproperty float x\nproperty float y\nproperty float z\n"
                ),
                format!("element vertex {count}\n"),
                format!("element other {count}\n element vertex 1\nproperty float x\n"),
                format!(
                    "element other {count}\nproperty list uchar int a\nelement vertex 1\nproperty float x\n"
                ),
                format!("element vertex {count}\nproperty list double int a\n"),
            ] {
                let bytes = format!(
                    "ply\nformat {format} 1.0\n{elements}end_header\n1 2 3 4 5 6 7 8 9 10 11 12\n"
                );
                assert!(read_bytes(bytes.as_bytes()).is_err(), "{bytes}");
            }
        }
    }
    // A list that claims more items than there are bytes.
    let list = "ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list uint int vertex_indices\nend_header\n";
    let bytes = [list.as_bytes(), &[0xFF; 40]].concat();
    assert!(matches!(
        read_bytes(&bytes),
        Err(FileError::Truncated { .. })
    ));
}

#[test]
fn corners_that_do_not_exist_are_refused() {
    let [text, ..] = same_mesh_stored_three_ways();
    let text = String::from_utf8(text).unwrap();
    for corner in ["4", "-1", "4294967295", "4294967296"] {
        let bad = text.replace("1 3 0 1 2\n", &format!("1 3 0 1 {corner}\n"));
        assert_ne!(bad, text);
        assert!(read_bytes(bad.as_bytes()).is_err(), "{corner}");
    }
}

#[test]
fn a_bad_number_and_a_bad_header_are_named() {
    let [text, ..] = same_mesh_stored_three_ways();
    let text = String::from_utf8(text).unwrap();
    let bad = text.replace("1 0 1 9 0 .5", "1 O 1 9 0 .5");
    assert!(matches!(
        read_bytes(bad.as_bytes()),
        Err(FileError::Malformed { line: 21, .. })
    ));
    for (from, to) in [
        ("format ascii 1.0", "format packed 1.0"),
        ("format ascii 1.0\n", ""),
        ("property double x", "property quadruple x"),
        ("property double x", "property double w"),
        ("property double x", "property double"),
        ("property double x", "property double x\nproperty double x"),
        ("element vertex 4", "element vertex four"),
        ("element vertex 4", "element vertices 4"),
        ("element camera 1\n", ""),
    ] {
        let bad = text.replacen(from, to, 1);
        assert_ne!(bad, text);
        assert!(
            matches!(read_bytes(bad.as_bytes()), Err(FileError::BadHeader { .. })),
            "{to}"
        );
    }
    let strips = text.replace("element face 2", "element tristrips 2");
    assert!(matches!(
        read_bytes(strips.as_bytes()),
        Err(FileError::Unsupported { .. })
    ));
}

proptest! {
    #[test]
    fn a_cloud_survives_being_written_and_read(cloud in super::super::pcd::tests::any_cloud()) {
        let mut bytes = Vec::new();
        write_ply(&mut bytes, &cloud).unwrap();
        let back = cloud_in(&bytes);
        let kept: Vec<usize> = cloud.finite().map(|(i, _)| i).collect();
        prop_assert_eq!(back.points, kept.iter().map(|&i| cloud.points[i]).collect::<Vec<_>>());
        prop_assert_eq!(back.normals, cloud.normals.map(|all| kept.iter().map(|&i| all[i]).collect::<Vec<_>>()));
        prop_assert_eq!(back.colours, cloud.colours.map(|all| kept.iter().map(|&i| all[i]).collect::<Vec<_>>()));
        prop_assert_eq!(back.labels, cloud.labels.map(|all| kept.iter().map(|&i| all[i]).collect::<Vec<_>>()));
        prop_assert_eq!(back.grid, None);
    }
}

#[test]
fn bytes_behind_the_last_vertex_are_counted() {
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n\
                  property float z\nend_header\n";
    for (tail, expected) in [(&b""[..], 0), (b"\n", 0), (b"more", 4)] {
        let mut bytes = header.as_bytes().to_vec();
        bytes.extend([1.0_f32, 2.0, 3.0].iter().flat_map(|x| x.to_le_bytes()));
        bytes.extend(tail);
        let source = Source {
            path: std::path::Path::new("test.ply"),
            bytes: &bytes,
        };
        let FileContent::Cloud(cloud) = read(source).unwrap() else {
            panic!("a cloud");
        };
        assert_eq!(cloud.surplus_bytes, expected);
    }
}
