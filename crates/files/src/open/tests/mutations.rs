//! Small valid files of every format, changed at random: the result is valid content or a named error, never a panic.

use std::{mem::discriminant, path::Path};

use nalgebra::Point3;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::*;
use crate::{MAX_POINTS, gltf, pcd, ply, read_depths, table_rows, write_pcd, write_ply, write_xyz};
use geometry::cloud::Grid;
use geometry::depth_frame::DepthFrame;
use geometry::fixtures::small_frame;

/// Changed files in total; they take about a second in a test build.
const NUM_FILES: usize = 120_000;

/// Words that a damaged header or table may hold.
const WORDS: [&[u8]; 18] = [
    b"0",
    b"-1",
    b"4294967295",
    b"18446744073709551615",
    b"1e308",
    b"1e-42",
    b"nan",
    b"-inf",
    b"POINTS",
    b"COUNT 1000000",
    b"element vertex 99999999",
    b"property list uchar int vertex_indices",
    b"f 1 2 3 -1",
    b"\"byteStride\":1",
    b"\n",
    b";",
    b"\0",
    b"\xff\xfe",
];

/// Every format. [`seeds_of`] does not compile without a new one; add it here, too.
const FORMATS: [Format; 7] = [
    Format::Pcd,
    Format::Ply,
    Format::Xyz,
    Format::Stl,
    Format::Obj,
    Format::Gltf,
    Format::DepthPng,
];

/// A file and its name for a person.
type Seed = (&'static str, Vec<u8>);

/// A file of every format in every storage.
fn seeds() -> Vec<Seed> {
    let mut seeds = Vec::new();
    for format in FORMATS {
        for (name, bytes) in seeds_of(&format) {
            let path = Path::new(name);
            let found = recognise(Source {
                path,
                bytes: &bytes,
            });
            let is_found = found.is_ok_and(|found| discriminant(&found) == discriminant(&format));
            assert!(is_found, "{name} is taken for another format");
            seeds.push((name, bytes));
        }
    }
    let camera = crate::DepthCamera::from_frame(&depth_frame());
    seeds.push(("camera", serde_json::to_vec(&camera).unwrap()));
    seeds
}

fn seeds_of(format: &Format) -> Vec<Seed> {
    match format {
        Format::Pcd => {
            let [ascii, binary, packed] = pcd::tests::same_points_stored_three_ways();
            vec![
                ("PCD, ascii", ascii),
                ("PCD, binary", binary),
                ("PCD, packed", packed),
                ("PCD, as written", written(write_pcd)),
            ]
        }
        Format::Ply => {
            let [ascii, little, big] = ply::tests::same_mesh_stored_three_ways();
            vec![
                ("PLY, ascii", ascii),
                ("PLY, little endian", little),
                ("PLY, big endian", big),
                ("PLY, as written", written(write_ply)),
            ]
        }
        Format::Xyz => vec![
            ("XYZ", written(write_xyz)),
            (
                "CSV",
                b"\"X [m]\";\"Y [m]\";\"Z [m]\"\n0,1;0,2;1,5\n0,3;0,4;1,6\n".into(),
            ),
        ],
        Format::Stl => vec![
            ("STL, ascii", super::STL.into()),
            ("STL, binary", super::binary_stl()),
        ],
        Format::Obj => vec![("OBJ", super::OBJ.into())],
        Format::Gltf => vec![
            ("glTF", gltf::tests::embedded().into()),
            ("GLB", gltf::tests::glb()),
        ],
        Format::DepthPng => {
            let mut png = Vec::new();
            depth_png::write_depths(&mut png, &depth_frame()).unwrap();
            vec![("depth PNG", png)]
        }
    }
}

/// A cloud as its writer writes it.
fn written(write: fn(&mut dyn std::io::Write, &PointCloud) -> std::io::Result<()>) -> Vec<u8> {
    let cloud = PointCloud {
        points: (0..24)
            .map(|i| Point3::new((i % 6) as f32 * 0.1, (i / 6) as f32 * 0.1, 1.0))
            .collect(),
        colours: Some(vec![[1, 2, 3]; 24]),
        labels: Some((0..24).collect()),
        grid: Some(Grid {
            width: 6,
            height: 4,
        }),
        ..PointCloud::default()
    };
    let mut bytes = Vec::new();
    write(&mut bytes, &cloud).unwrap();
    bytes
}

fn depth_frame() -> DepthFrame {
    small_frame(6, 900..924)
}

/// Makes one change, such as copying, editing and failing disks cause.
fn change(bytes: &mut Vec<u8>, other: &[u8], random: &mut Pcg64) {
    let len = bytes.len();
    let at = random.random_range(0..=len);
    let run = random.random_range(0..=64.min(len - at));
    match random.random_range(0..8) {
        0 if at < len => bytes[at] ^= 1 << random.random_range(0..8),
        1 if at < len => bytes[at] = random.random(),
        2 => bytes.truncate(at),
        3 => drop(bytes.drain(at..at + run)),
        4 => {
            let copy = bytes[at..at + run].to_vec();
            bytes.splice(at..at, copy);
        }
        5 => {
            let word = WORDS[random.random_range(0..WORDS.len())];
            bytes.splice(at..at + run.min(word.len()), word.iter().copied());
        }
        6 => {
            let from = random.random_range(0..=other.len());
            let end = (from + run).min(other.len());
            bytes.splice(at..at, other[from..end].iter().copied());
        }
        _ => {
            // Four bytes that may be a count or a coordinate.
            let value = [0, 1, u32::MAX, 1 << 31, f32::NAN.to_bits(), 0x7f7f_ffff]
                [random.random_range(0..6)];
            let end = (at + 4).min(len);
            bytes.splice(at..end, value.to_le_bytes());
        }
    }
}

#[test]
fn files_changed_at_random_open_or_fail_by_name() {
    let seeds = seeds();
    let path = Path::new("changed");
    let (mut num_opened, mut num_clouds) = (vec![0; seeds.len()], 0);
    for number in 0..NUM_FILES {
        let mut random = Pcg64::seed_from_u64(number as u64);
        let index = number % seeds.len();
        let (name, seed) = &seeds[index];
        let mut bytes = seed.clone();
        let other = &seeds[random.random_range(0..seeds.len())].1;
        for _ in 0..random.random_range(1..=4) {
            change(&mut bytes, other, &mut random);
        }
        let opened = open_bytes(path, &bytes);
        let images = read_depths(path, &bytes);
        for error in [opened.as_ref().err(), images.as_ref().err()] {
            let is_fault = matches!(error, Some(FileError::Fault { .. }));
            assert!(!is_fault, "{name}, number {number}: {error:?}");
        }
        if let Ok(text) = str::from_utf8(&bytes) {
            let _ = table_rows(text, path);
        }
        num_opened[index] += usize::from(opened.is_ok() || images.is_ok());
        match opened {
            Ok(FileContent::Cloud(cloud)) => {
                assert!(cloud.points.len() <= MAX_POINTS);
                let cells = cloud.grid.map_or(cloud.points.len(), Grid::num_cells);
                assert_eq!(cells, cloud.points.len(), "{name}, number {number}");
                num_clouds += 1;
            }
            Ok(FileContent::Mesh(mesh)) => {
                let num = mesh.vertices.len();
                let mut corners = mesh.triangles.iter().flatten();
                assert!(
                    corners.all(|&corner| (corner as usize) < num),
                    "{name}, number {number}"
                );
            }
            Ok(FileContent::Depth(_)) | Err(_) => {}
        }
    }
    let names = seeds.iter().map(|(name, _)| *name);
    let each: Vec<String> = names
        .zip(&num_opened)
        .map(|(name, num)| format!("{name} {num}"))
        .collect();
    eprintln!(
        "{NUM_FILES} changed files, {} opened ({}), {num_clouds} clouds",
        num_opened.iter().sum::<usize>(),
        each.join(", ")
    );
    assert!(num_clouds > NUM_FILES / 100, "the changes are too coarse");
}
