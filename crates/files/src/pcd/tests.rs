use std::fmt::Write as _;
use std::path::Path;

use nalgebra::{Point3, Vector3};
use proptest::prelude::*;

use super::*;
use geometry::cloud::Grid;

fn source(bytes: &[u8]) -> Source<'_> {
    Source {
        path: Path::new("test.pcd"),
        bytes,
    }
}

fn read_bytes(bytes: &[u8]) -> Result<PointCloud, FileError> {
    assert!(is_pcd(source(bytes)), "not recognised");
    read(source(bytes))
}

/// A header with `fields` as `name:TYPE:SIZE:COUNT`.
fn header(fields: &str, width: &str, height: &str, storage: &str) -> String {
    let column = |i: usize| -> String {
        let words = fields
            .split(' ')
            .map(|field| field.split(':').nth(i).unwrap());
        words.collect::<Vec<_>>().join(" ")
    };
    format!(
        "# .PCD v0.7\nVERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\nCOUNT {}\nWIDTH {width}\nHEIGHT {height}\n\
         VIEWPOINT 1 2 3 0 1 0 0\nDATA {storage}\n",
        column(0),
        column(2),
        column(1),
        column(3),
    )
}

/// Packs without references: only literal bytes.
fn pack(bytes: &[u8]) -> Vec<u8> {
    let mut packed = Vec::new();
    for run in bytes.chunks(32) {
        packed.push(run.len() as u8 - 1);
        packed.extend_from_slice(run);
    }
    let mut block = (packed.len() as u32).to_le_bytes().to_vec();
    block.extend((bytes.len() as u32).to_le_bytes());
    block.extend(packed);
    block
}

const FIELDS: &str = "label:U:2:1 x:F:4:1 _:U:1:3 y:F:8:1 z:F:4:1 rgb:F:4:1";

/// Two points with the same fields in each of the three storages.
pub(crate) fn same_points_stored_three_ways() -> [Vec<u8>; 3] {
    let points = [
        (7_u16, 1.5_f32, -2.25_f64, 3.0_f32, 0x00FF_8001_u32),
        (65_535, 4.0, 5.0, 6.0, 0x0001_0203),
    ];
    let mut rows = Vec::new();
    let mut columns: [Vec<u8>; 6] = Default::default();
    let mut text = String::new();
    for (label, x, y, z, rgb) in points {
        let cells: [Vec<u8>; 6] = [
            label.to_le_bytes().into(),
            x.to_le_bytes().into(),
            vec![9; 3],
            y.to_le_bytes().into(),
            z.to_le_bytes().into(),
            rgb.to_le_bytes().into(),
        ];
        for (column, cell) in columns.iter_mut().zip(&cells) {
            column.extend(cell);
            rows.extend(cell);
        }
        writeln!(text, "{label} {x} 9 9 9 {y} {z} {:e}", f32::from_bits(rgb)).unwrap();
    }
    let header = |storage| header(FIELDS, "2", "1", storage).into_bytes();
    [
        [header("ascii"), text.into_bytes()].concat(),
        [header("binary"), rows].concat(),
        [header("binary_compressed"), pack(&columns.concat())].concat(),
    ]
}

#[test]
fn the_three_storages_hold_the_same_cloud() {
    let expected = PointCloud {
        points: vec![Point3::new(1.5, -2.25, 3.0), Point3::new(4.0, 5.0, 6.0)],
        normals: None,
        colours: Some(vec![[255, 128, 1], [1, 2, 3]]),
        labels: Some(vec![7, 65_535]),
        ..PointCloud::default()
    };
    for bytes in same_points_stored_three_ways() {
        assert_eq!(read_bytes(&bytes).unwrap(), expected);
    }
}

#[test]
fn a_file_cut_anywhere_is_an_error_and_never_a_panic() {
    for bytes in same_points_stored_three_ways() {
        for length in 0..bytes.len() {
            // Cut text may still end in a shorter number; the other storages need their last byte.
            let is_text = bytes.ends_with(b"\n") && length > bytes.len() - 13;
            assert!(
                read(source(&bytes[..length])).is_err() || is_text,
                "{length} of {}",
                bytes.len()
            );
        }
    }
}

#[test]
fn cells_without_a_reading_stay_in_the_grid_and_leave_a_list() {
    let rows = "1 2 3\nnan nan nan\n0 0 0\n4 5 inf\n-nan(ind) 1 1\n1e38 0 0\n";
    let organised = header("x:F:4:1 y:F:4:1 z:F:4:1", "3", "2", "ascii") + rows;
    let cloud = read_bytes(organised.as_bytes()).unwrap();
    assert_eq!(
        cloud.grid,
        Some(Grid {
            width: 3,
            height: 2
        })
    );
    assert_eq!(cloud.points[0], Point3::new(1.0, 2.0, 3.0));
    assert!(
        cloud.points[1..]
            .iter()
            .all(|p| p.iter().all(|c| c.is_nan())),
        "{:?}",
        cloud.points
    );

    let list = header("x:F:4:1 y:F:4:1 z:F:4:1", "6", "1", "ascii") + rows;
    let cloud = read_bytes(list.as_bytes()).unwrap();
    assert_eq!(cloud.points, [Point3::new(1.0, 2.0, 3.0)]);
}

#[test]
fn zeros_in_a_list_are_dropped_unless_they_have_a_normal() {
    let fields = "x:F:4:1 y:F:4:1 z:F:4:1 normal_x:F:4:1 normal_y:F:4:1 normal_z:F:4:1";
    let rows = "1 2 3 0 0 1\n0 0 0 0 0 0\n0 0 0 nan nan nan\n0 0 0 0 0 1\n";
    let cloud = read_bytes((header(fields, "4", "1", "ascii") + rows).as_bytes()).unwrap();
    assert_eq!(cloud.points, [Point3::new(1.0, 2.0, 3.0), Point3::origin()]);
    assert_eq!(cloud.normals, Some(vec![Vector3::z(); 2]));
}

#[test]
fn normals_are_made_unit_and_kept_only_if_every_reading_has_one() {
    let fields = "x:F:4:1 y:F:4:1 z:F:4:1 normal_x:F:4:1 normal_y:F:4:1 normal_z:F:4:1";
    let read_rows =
        |rows: &str| read_bytes((header(fields, "2", "1", "ascii") + rows).as_bytes()).unwrap();
    let cloud = read_rows("1 2 3 0 0 -2\n4 5 6 3 0 4\n");
    assert_eq!(
        cloud.normals,
        Some(vec![
            Vector3::new(0.0, 0.0, -1.0),
            Vector3::new(0.6, 0.0, 0.8)
        ])
    );
    assert_eq!(read_rows("1 2 3 0 0 1\n4 5 6 0 0 0\n").normals, None);
    assert_eq!(read_rows("1 2 3 0 0 1\n4 5 6 nan nan nan\n").normals, None);
    assert_eq!(
        read_rows("1 2 3 0 0 1\nnan 5 6 0 0 0\n").normals,
        Some(vec![Vector3::z()])
    );
}

#[test]
fn a_header_that_claims_more_than_the_file_has_takes_no_memory() {
    const XYZ: &str = "x:F:4:1 y:F:4:1 z:F:4:1";
    let huge = "18446744073709551615";
    for storage in ["ascii", "binary", "binary_compressed"] {
        let mut block = vec![0xFF; 8];
        block.extend(b"1 2 3\n");
        for (fields, width, height) in [
            (XYZ, "4000000000", "1"),
            (XYZ, "40000000", "1"),
            (XYZ, huge, huge),
            (XYZ, huge, "1"),
            ("x:F:8:18446744073709551615 y:F:4:1 z:F:4:1", "1", "1"),
            ("x:F:8:2000000000000000000 y:F:4:1 z:F:4:1", "40000000", "1"),
        ] {
            let bytes = [
                header(fields, width, height, storage).into_bytes(),
                block.clone(),
            ]
            .concat();
            let error = read_bytes(&bytes).unwrap_err();
            assert!(
                matches!(
                    error,
                    FileError::TooLarge { .. }
                        | FileError::Truncated { .. }
                        | FileError::BadHeader { .. }
                        | FileError::Malformed { .. }
                ),
                "{error}"
            );
        }
    }
    // A block that claims to unpack to more than it can.
    let mut bytes = header(XYZ, "20000000", "1", "binary_compressed").into_bytes();
    bytes.extend(6_u32.to_le_bytes());
    bytes.extend(240_000_000_u32.to_le_bytes());
    bytes.extend([0xE0, 255, 0, 0xE0, 255, 0]);
    assert!(matches!(
        read_bytes(&bytes),
        Err(FileError::Truncated { .. })
    ));
}

#[test]
fn points_that_unpack_to_more_than_a_gigabyte_take_no_memory() {
    for (fields, width) in [
        // 7 MB packed.
        ("x:F:4:1 y:F:4:1 z:F:4:1", "50000000"),
        ("x:F:4:1 y:F:4:1 z:F:4:1 _:U:1:1000", "4000000"),
    ] {
        for storage in ["ascii", "binary_compressed"] {
            let bytes = [header(fields, width, "1", storage).into_bytes(), vec![1; 8]].concat();
            let error = read_bytes(&bytes).unwrap_err();
            assert!(
                matches!(
                    error,
                    FileError::TooLarge {
                        limit: crate::MAX_UNPACKED_BYTES,
                        ..
                    }
                ),
                "{error}"
            );
        }
    }
}

#[test]
fn bytes_behind_the_last_point_are_counted_and_padding_is_not() {
    for bytes in same_points_stored_three_ways() {
        let surplus = |tail: &[u8]| {
            let cloud = read_bytes(&[bytes.as_slice(), tail].concat()).unwrap();
            assert_eq!(cloud.points.len(), 2);
            cloud.surplus_bytes
        };
        assert_eq!(surplus(b""), 0);
        assert_eq!(surplus(b"\n \n"), 0);
        assert_eq!(surplus(b"7 8 9 9 9 1 2"), 13);
        if !bytes.ends_with(b"\n") {
            assert_eq!(surplus(&[0; 500]), 0);
        }
    }
}

#[test]
fn a_header_that_makes_no_sense_is_quoted() {
    let good = header("x:F:4:1 y:F:4:1 z:F:4:1", "1", "1", "ascii") + "1 2 3\n";
    for (from, to) in [
        ("FIELDS x y z", "FIELDS x y w"),
        ("SIZE 4 4 4", "SIZE 4 4"),
        ("SIZE 4 4 4", "SIZE 4 4 3"),
        ("TYPE F F F", "TYPE F F X"),
        ("COUNT 1 1 1", "COUNT 1 1 -1"),
        ("COUNT 1 1 1", "COUNT 0 1 1"),
        ("WIDTH 1", "WIDTH one"),
        ("HEIGHT 1", "HEIGHT 1\nPOINTS 2"),
        ("DATA ascii", "DATA zipped"),
    ] {
        let bad = good.replace(from, to);
        assert!(
            matches!(read_bytes(bad.as_bytes()), Err(FileError::BadHeader { .. })),
            "{to}"
        );
    }
    let twice = header("x:F:4:1 y:F:4:1 z:F:4:1 x:F:4:1", "1", "1", "ascii") + "1 2 3 4\n";
    let error = read_bytes(twice.as_bytes()).unwrap_err().to_string();
    assert!(error.contains("one column each"), "{error}");
    let none = good.replace("WIDTH 1", "WIDTH 0");
    assert!(matches!(
        read_bytes(none.as_bytes()),
        Err(FileError::NoPoints { found: 0, .. })
    ));
}

#[test]
fn a_bad_row_is_named_by_its_line() {
    let text = header("x:F:4:1 y:F:4:1 z:F:4:1", "2", "1", "ascii") + "1 2 3\n\n4 five 6\n";
    assert!(matches!(
        read_bytes(text.as_bytes()),
        Err(FileError::Malformed { line: 13, .. })
    ));
}

#[test]
fn the_oldest_headers_are_read() {
    let text = "COLUMNS x y z\r\nSIZE 4 4 4\r\nTYPE F F F\r\nPOINTS 1\r\nDATA ascii\r\n1 2 3\r\n";
    assert_eq!(
        read_bytes(text.as_bytes()).unwrap().points,
        [Point3::new(1.0, 2.0, 3.0)]
    );
}

proptest! {
    #[test]
    fn a_cloud_survives_being_written_and_read(cloud in any_cloud()) {
        let mut bytes = Vec::new();
        write_pcd(&mut bytes, &cloud).unwrap();
        let back = read_bytes(&bytes).unwrap();
        // NaN differs from itself, but its text does not.
        prop_assert_eq!(format!("{back:?}"), format!("{cloud:?}"));
    }
}

/// Clouds of every kind, with the properties that the reader guarantees.
pub(crate) fn any_cloud() -> impl Strategy<Value = PointCloud> {
    let point = prop::array::uniform3(-1e6_f32..1e6).prop_map(Point3::from);
    let rows = prop::collection::vec(
        (
            point,
            0.01_f32..3.0,
            any::<[u8; 3]>(),
            any::<u32>(),
            any::<bool>(),
        ),
        1..60,
    );
    (rows, any::<[bool; 4]>()).prop_map(
        |(rows, [has_normals, has_colours, has_labels, is_organised])| {
            let width = if is_organised {
                rows.len()
            } else {
                rows.len() * 2
            };
            let nowhere = Point3::new(f32::NAN, f32::NAN, f32::NAN);
            // An organised cloud gets a second row, some of it without a reading.
            let second = rows.iter().map(|row| {
                (
                    if row.4 { nowhere } else { row.0 },
                    row.1,
                    row.2,
                    row.3,
                    row.4,
                )
            });
            let rows: Vec<_> = if is_organised {
                rows.iter().copied().chain(second).collect()
            } else {
                rows
            };
            let normal = |point: &Point3<f32>, angle: f32| {
                if point.x.is_nan() {
                    Vector3::repeat(f32::NAN)
                } else {
                    Vector3::new(angle.cos(), angle.sin(), 0.0)
                }
            };
            PointCloud {
                points: rows.iter().map(|row| row.0).collect(),
                normals: has_normals
                    .then(|| rows.iter().map(|row| normal(&row.0, row.1)).collect()),
                colours: has_colours.then(|| rows.iter().map(|row| row.2).collect()),
                labels: has_labels.then(|| rows.iter().map(|row| row.3).collect()),
                grid: is_organised.then_some(Grid { width, height: 2 }),
                is_simulated: has_labels,
                surplus_bytes: 0,
            }
        },
    )
}
