//! Connected surfaces: neighbours that lie close together belong to the same one.
//!
//! On an organised cloud neighbours are pixels, runs of them are joined row by row with a union-find, and a few
//! pixels without a reading are bridged. An unorganised cloud is cut into voxels, and voxels that touch are joined.

use std::collections::HashMap;

use nalgebra::Point3;

use super::{PointLabel, SegmentParams};
use crate::{
    geometry::cloud::{Grid, is_finite},
    stages::scene::SceneCloud,
    units::Metres,
};

/// One connected surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cluster {
    /// Points in it.
    pub num_points: usize,
    /// Its surface as seen from the camera, square metres.
    pub area: f64,
    /// True if it reaches the border of the field of view.
    pub touches_edge: bool,
    /// Share of its border to other surfaces along which it is the nearer one, 0..1: all of a part that nothing hides,
    /// hardly any of a wall. 1 if it borders on none, or without a picture.
    pub in_front: f64,
    /// Sides of the view on which it is cut off, 0..4; 0 without a picture.
    pub sides_cut: usize,
}

pub(super) struct Members {
    pub(super) cluster: Cluster,
    /// Indices of its points in the scene, ascending.
    pub(super) indices: Vec<u32>,
}

/// Pixels without a reading that a surface is followed across: dropouts are rarely wider.
const BRIDGED_PIXELS: usize = 4;
/// Clusters below this many points are specks and are not listed.
const MIN_CLUSTER_POINTS: usize = 50;

/// The connected surfaces among the points labelled `Rest`, largest area first.
pub(super) fn connect(
    scene: &SceneCloud,
    labels: &[PointLabel],
    noise_at_1m: Metres,
    params: &SegmentParams,
) -> Vec<Members> {
    let link = Link::new(scene, noise_at_1m, params);
    let groups = match scene.cloud.grid {
        Some(grid) => connect_pixels(&scene.cloud.points, labels, grid, link),
        None => connect_voxels(&scene.cloud.points, labels),
    };
    let groups: Vec<Vec<u32>> = groups
        .into_iter()
        .filter(|indices| indices.len() >= MIN_CLUSTER_POINTS)
        .collect();
    let group_of = groups_of_points(labels, &groups);
    let borders = borders_of(scene, &group_of, groups.len() + 1, link);
    let mut members: Vec<Members> = groups
        .into_iter()
        .zip(borders)
        .map(|(indices, border)| Members {
            cluster: describe(scene, &indices, border),
            indices,
        })
        .collect();
    members.sort_by(|a, b| b.cluster.area.total_cmp(&a.cluster.area));
    members
}

#[derive(Clone, Copy)]
struct Link {
    base: f32,
    /// Side of a pixel at 1 m.
    pixel: f32,
    noise: f32,
}

impl Link {
    fn new(scene: &SceneCloud, noise_at_1m: Metres, params: &SegmentParams) -> Self {
        Self {
            base: params.link_distance.0 as f32,
            pixel: scene
                .intrinsics
                .map_or(0.0, |camera| 1.0 / camera.fx as f32),
            // The difference of two noisy depths has √2 of their deviation; four deviations hold all but strays.
            noise: (4.0 * std::f64::consts::SQRT_2 * noise_at_1m.0) as f32,
        }
    }

    fn joins(self, a: &Point3<f32>, b: &Point3<f32>) -> bool {
        let reach = self.base + (self.pixel + self.noise * a.z) * a.z;
        (a - b).norm_squared() < reach * reach
    }
}

/// Union-find over runs of pixels.
struct UnionFind {
    parents: Vec<u32>,
}

impl UnionFind {
    fn add(&mut self) -> u32 {
        let id = self.parents.len() as u32;
        self.parents.push(id);
        id
    }

    fn root(&mut self, mut id: u32) -> u32 {
        while self.parents[id as usize] != id {
            let grandparent = self.parents[self.parents[id as usize] as usize];
            self.parents[id as usize] = grandparent;
            id = grandparent;
        }
        id
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        // The lower id stays the root, so the result does not depend on the order of joins.
        self.parents[a.max(b) as usize] = a.min(b);
    }
}

const NO_RUN: u32 = u32::MAX;

fn connect_pixels(
    points: &[Point3<f32>],
    labels: &[PointLabel],
    grid: Grid,
    link: Link,
) -> Vec<Vec<u32>> {
    /// Rows of pixels whose runs can still meet those of a new row, and that row.
    const ROWS: usize = BRIDGED_PIXELS + 2;
    let Grid { width, height } = grid;
    // A row comes again ROWS rows later: that little stays in the processor's nearest memory.
    let mut run_of = vec![NO_RUN; ROWS * width];
    let mut forest = UnionFind {
        parents: Vec::new(),
    };
    // Enough for all pixels, of which only what is written costs time: growing copies it again and again.
    let mut rest: Vec<u32> = Vec::with_capacity(labels.len());
    let mut runs: Vec<u32> = Vec::with_capacity(labels.len());
    for row in 0..height {
        let start = row * width;
        // Where this row and those above it begin among the runs.
        let begins: [usize; ROWS] = std::array::from_fn(|up| (row + ROWS - up) % ROWS * width);
        let num_above = (BRIDGED_PIXELS + 1).min(row);
        run_of[begins[0]..][..width].fill(NO_RUN);
        let mut previous: Option<usize> = None;
        let mut last_meeting = (NO_RUN, NO_RUN);
        let first = rest.len();
        let is_rest = |(_, label): &(u32, &PointLabel)| **label == PointLabel::Rest;
        let in_row = (start as u32..).zip(&labels[start..start + width]);
        rest.extend(in_row.filter(is_rest).map(|(i, _)| i));
        for i in rest[first..].iter().map(|i| *i as usize) {
            let run = previous
                .filter(|&p| i - p <= BRIDGED_PIXELS + 1 && link.joins(&points[p], &points[i]))
                .map(|p| run_of[begins[0] + p - start]);
            let run = run.unwrap_or_else(|| forest.add());
            run_of[begins[0] + i - start] = run;
            runs.push(run);
            previous = Some(i);
            // The nearest reading above, bridging lost rows.
            let above = (1..=num_above)
                .map(|rows| (i - rows * width, run_of[begins[rows] + i - start]))
                .find(|(_, above)| *above != NO_RUN);
            if let Some((pixel, above)) = above {
                // Along a surface the same two runs meet pixel after pixel: one meeting is enough.
                let meeting = (above, run);
                if meeting != last_meeting
                    && meeting.0 != run
                    && link.joins(&points[pixel], &points[i])
                {
                    forest.join(meeting.0, run);
                    last_meeting = meeting;
                }
            }
        }
    }
    let mut group_of_root = vec![NO_RUN; forest.parents.len()];
    let mut groups: Vec<Vec<u32>> = Vec::new();
    for (i, run) in rest.into_iter().zip(runs) {
        let root = forest.root(run) as usize;
        if group_of_root[root] == NO_RUN {
            group_of_root[root] = groups.len() as u32;
            groups.push(Vec::new());
        }
        groups[group_of_root[root] as usize].push(i);
    }
    groups
}

/// Side of a voxel, metres: an unorganised cloud may be far sparser than a picture.
const VOXEL: f32 = 0.04;

fn connect_voxels(points: &[Point3<f32>], labels: &[PointLabel]) -> Vec<Vec<u32>> {
    let voxel_of = |p: &Point3<f32>| [p.x, p.y, p.z].map(|x| (x / VOXEL).floor() as i64);
    let mut forest = UnionFind {
        parents: Vec::new(),
    };
    let mut id_of: HashMap<[i64; 3], u32> = HashMap::new();
    let mut members: Vec<Vec<u32>> = Vec::new();
    for (i, p) in points
        .iter()
        .enumerate()
        .filter(|(i, _)| labels[*i] == PointLabel::Rest)
    {
        let id = *id_of.entry(voxel_of(p)).or_insert_with(|| {
            members.push(Vec::new());
            forest.add()
        });
        members[id as usize].push(i as u32);
    }
    // Through `members`, whose order is that of the points: the map's order must not matter.
    for (id, group) in members.iter().enumerate() {
        let [x, y, z] = voxel_of(&points[group[0] as usize]);
        for step in 0..27 {
            let neighbour = [x + step % 3 - 1, y + step / 3 % 3 - 1, z + step / 9 - 1];
            if let Some(&other) = id_of.get(&neighbour) {
                forest.join(id as u32, other);
            }
        }
    }
    let mut groups: Vec<Vec<u32>> = vec![Vec::new(); members.len()];
    for (id, group) in members.into_iter().enumerate() {
        groups[forest.root(id as u32) as usize].extend(group);
    }
    groups.retain(|g| !g.is_empty());
    for group in &mut groups {
        group.sort_unstable();
    }
    groups
}

fn describe(scene: &SceneCloud, indices: &[u32], border: Border) -> Cluster {
    let points = &scene.cloud.points;
    let area = if let Some(camera) = scene.intrinsics {
        // A pixel at depth z covers z²/(fx fy).
        let depths = indices.iter().map(|&i| f64::from(points[i as usize].z));
        depths.map(|z| z * z).sum::<f64>() / (camera.fx * camera.fy)
    } else {
        // Without a camera: as many squares as the cluster fills voxels.
        let mut voxels: Vec<[i64; 3]> = indices
            .iter()
            .map(|&i| points[i as usize])
            .map(|p| [p.x, p.y, p.z].map(|x| (x / VOXEL).floor() as i64))
            .collect();
        voxels.sort_unstable();
        voxels.dedup();
        voxels.len() as f64 * f64::from(VOXEL).powi(2)
    };
    Cluster {
        num_points: indices.len(),
        area,
        touches_edge: touches_edge(scene, indices),
        in_front: border.in_front,
        sides_cut: border.sides_cut,
    }
}

/// Every so many rows and columns are looked along for borders between surfaces.
const LINE_STEP: usize = 4;
/// Pixels without a reading across which two surfaces border on each other: the shadow of one on the other.
const SHADOW: usize = 40;
/// Marks readings that are of no surface: pixels that mix the depths of two.
const NO_GROUP: u32 = u32::MAX;

/// A reading this close to the end of the view is at it, pixels.
const MARGIN: u32 = 2;

/// Lines that end with the view from which on a surface is cut off on that side: some 20 pixels.
const LEAST_CUT: f64 = 5.0;

/// What the border of a surface is like.
#[derive(Clone, Copy)]
struct Border {
    /// See [`Cluster::in_front`].
    in_front: f64,
    /// See [`Cluster::sides_cut`].
    sides_cut: usize,
}

impl Border {
    const UNKNOWN: Self = Self {
        in_front: 1.0,
        sides_cut: 0,
    };
}

/// What borders on what in a scene's picture: `group_of` gives the surface of each point, below `num_groups`.
fn borders_of(scene: &SceneCloud, group_of: &[u32], num_groups: usize, link: Link) -> Vec<Border> {
    let Some(Grid { width, height }) = scene.cloud.grid else {
        return vec![Border::UNKNOWN; num_groups];
    };
    let points = &scene.cloud.points;
    let view = scene.field_of_view();
    // Of each group how much of its border is nearer and farther, and how much ends with the view on the left, on the
    // right, at the top and at the bottom.
    let mut all = vec![[0.0_f64; 6]; num_groups];
    let mut walk = |sides: [usize; 2], pixels: &mut dyn Iterator<Item = usize>| {
        let mut before: Option<(usize, usize)> = None;
        let end_at = |all: &mut Vec<[f64; 6]>, side: usize, i: usize| {
            if view.is_some_and(|view| view.ends_at(i % width, i / width, MARGIN)) {
                all[group_of[i] as usize][side] += 1.0;
            }
        };
        for (step, i) in pixels.enumerate().filter(|(_, i)| group_of[*i] != NO_GROUP) {
            match before {
                None => end_at(&mut all, sides[0], i),
                Some((last_step, j)) => {
                    let is_border = group_of[i] != group_of[j]
                        && step - last_step <= SHADOW
                        && !link.joins(&points[i], &points[j]);
                    if is_border {
                        let is_nearer = points[i].z < points[j].z;
                        let (near, far) = if is_nearer { (i, j) } else { (j, i) };
                        all[group_of[near] as usize][0] += 1.0;
                        all[group_of[far] as usize][1] += 1.0;
                    }
                }
            }
            before = Some((step, i));
        }
        if let Some((_, i)) = before {
            end_at(&mut all, sides[1], i);
        }
    };
    for row in (0..height).step_by(LINE_STEP) {
        walk([2, 3], &mut (row * width..(row + 1) * width));
    }
    for column in (0..width).step_by(LINE_STEP) {
        walk([4, 5], &mut (0..height).map(|row| row * width + column));
    }
    all.iter()
        .map(|&[near, far, ref ends @ ..]| Border {
            in_front: if near + far > 0.0 {
                near / (near + far)
            } else {
                1.0
            },
            sides_cut: ends.iter().filter(|num| **num >= LEAST_CUT).count(),
        })
        .collect()
}

/// The surface of each point: its place in `groups`, the number of those for the background.
fn groups_of_points(labels: &[PointLabel], groups: &[Vec<u32>]) -> Vec<u32> {
    let of_label = |label: &PointLabel| match label {
        PointLabel::Background(_) => groups.len() as u32,
        _ => NO_GROUP,
    };
    let mut group_of: Vec<u32> = labels.iter().map(of_label).collect();
    for (group, indices) in groups.iter().enumerate() {
        for &i in indices {
            group_of[i as usize] = group as u32;
        }
    }
    group_of
}

/// The figures of some points of a scene, all others taken for other surfaces.
pub(super) fn figures_of(
    scene: &SceneCloud,
    indices: &[u32],
    noise_at_1m: Metres,
    params: &SegmentParams,
) -> Cluster {
    let is_other = |p: &Point3<f32>| if is_finite(p) { 1 } else { NO_GROUP };
    let mut group_of: Vec<u32> = scene.cloud.points.iter().map(is_other).collect();
    for &i in indices {
        group_of[i as usize] = 0;
    }
    let border = borders_of(scene, &group_of, 2, Link::new(scene, noise_at_1m, params))[0];
    describe(scene, indices, border)
}

/// True if these points reach the border of the field of view.
pub(super) fn touches_edge(scene: &SceneCloud, indices: &[u32]) -> bool {
    // A handful of stray pixels at the edge does not count.
    const LEAST: usize = 10;
    let view = scene.cloud.grid.zip(scene.field_of_view());
    view.is_some_and(|(Grid { width, .. }, view)| {
        let is_at_edge =
            |i: &&u32| view.ends_at(**i as usize % width, **i as usize / width, MARGIN);
        indices.iter().filter(is_at_edge).nth(LEAST - 1).is_some()
    })
}
