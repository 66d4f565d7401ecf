//! The whole inspection of a small cloud.

#![no_main]

use std::sync::OnceLock;

use libfuzzer_sys::fuzz_target;
use nalgebra::Point3;
use partsight::{
    Grid, Library, LibraryFolder, PointCloud, Recipe, Unwatched, Verdict, pipeline::Unrecognisable,
    run, scene_from_cloud,
};

static LIBRARY: OnceLock<Library> = OnceLock::new();

/// Run from the repository, where the shipped parts are.
fn library() -> Library {
    let folder = LibraryFolder::open("reference_parts".as_ref()).expect("the shipped parts");
    folder.load(&Default::default()).expect("loaded").library
}

fuzz_target!(|bytes: &[u8]| {
    let Some((&width, coordinates)) = bytes.split_first() else {
        return;
    };
    let metres = |cell: &[u8]| f32::from(i16::from_le_bytes([cell[0], cell[1]])) / 10_000.0;
    let mut points: Vec<Point3<f32>> = coordinates
        .chunks_exact(6)
        .map(|row| Point3::new(metres(row), metres(&row[2..]), metres(&row[4..])))
        .collect();
    let width = usize::from(width);
    let grid = (width > 1).then(|| Grid {
        width,
        height: points.len() / width,
    });
    if let Some(grid) = grid {
        points.truncate(grid.num_cells());
    }
    let cloud = PointCloud {
        points,
        grid: grid.filter(|grid| grid.height > 1),
        ..PointCloud::default()
    };
    let scene = scene_from_cloud(cloud);
    let library = LIBRARY.get_or_init(library);
    let inspection = run(&scene, library, &Recipe::default(), &Unwatched).expect("not cancelled");
    if let Verdict::NoPart(Unrecognisable::Fault(fault)) = inspection.verdict {
        panic!("{fault}");
    }
});
