//! Signs that selected points do not all belong to the part.

use std::collections::BTreeMap;

use nalgebra::Point3;

use geometry::voxel::connected_pieces;
use stages::{
    scene::SceneCloud,
    segment::{PointLabel, SegmentParams, segment},
};

/// Returns the share of the points with these indices that segmentation labels as background.
pub(super) fn share_on_background(
    scene: &SceneCloud,
    indices: &[u32],
    params: &SegmentParams,
) -> f64 {
    let labels = segment(scene, params).labels;
    let is_background = |i: &&u32| matches!(labels[**i as usize], PointLabel::Background(_));
    indices.iter().filter(is_background).count() as f64 / indices.len().max(1) as f64
}

/// Edge of the cubes that connect points, metres. Pieces that are separated by a bar of a stand or the edge of an
/// opening stay connected; a gap of two cubes separates them.
const CUBE_EDGE_M: f32 = 0.06;

/// Returns the share of the points outside the largest piece. Points belong to one piece if their cubes are connected.
pub(super) fn share_apart(points: &[Point3<f32>]) -> f64 {
    let cube_of = |p: &Point3<f32>| [p.x, p.y, p.z].map(|x| (x / CUBE_EDGE_M).floor() as i32);
    let mut cubes: BTreeMap<[i32; 3], usize> = BTreeMap::new();
    for point in points {
        *cubes.entry(cube_of(point)).or_default() += 1;
    }
    let pieces = connected_pieces(cubes).into_iter();
    let largest = pieces.map(|piece| piece.into_iter().sum::<usize>()).max();
    let largest = largest.unwrap_or(0);
    1.0 - largest as f64 / points.len().max(1) as f64
}
