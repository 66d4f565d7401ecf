//! Connected surfaces: groups of neighbouring points that lie close together.
//!
//! On an organised cloud, neighbours are pixels; runs of them are joined row by row with a union-find, bridging a few
//! pixels without a reading. An unorganised cloud is divided into voxels, and adjacent voxels are joined.

use std::collections::HashMap;

use nalgebra::Point3;

use super::{PointLabel, SegmentParams};
use crate::scene::SceneCloud;
use geometry::{
    cloud::{Grid, is_finite},
    units::Metres,
};

/// A connected surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cluster {
    /// Number of points.
    pub num_points: usize,
    /// Area as seen from the camera, square metres.
    pub area: f64,
    /// True if it reaches the border of the field of view.
    pub touches_edge: bool,
    /// Share of its border to other surfaces along which it is the nearer one, 0..1: near 1 for an unoccluded part,
    /// near 0 for a wall. 1 if it borders on none, or without a picture.
    pub in_front: f64,
    /// Number of sides of the view that cut it off, 0..4; 0 without a picture.
    pub sides_cut: usize,
}

pub(super) struct Members {
    pub(super) cluster: Cluster,
    /// Indices of its points in the scene, ascending.
    pub(super) indices: Vec<u32>,
}

/// Maximum number of pixels without a reading that a surface may span: dropouts are rarely wider.
pub(crate) const BRIDGED_PIXELS: usize = 4;
/// Smaller clusters are specks and are not listed, points.
const MIN_CLUSTER_POINTS: usize = 50;

/// Returns the connected surfaces among the points labelled `Rest`, largest area first.
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
    members_of(scene, labels, groups, link)
}

/// Returns groups of points, each given by ascending indices, as surfaces, largest area first.
pub(super) fn members_of(
    scene: &SceneCloud,
    labels: &[PointLabel],
    groups: Vec<Vec<u32>>,
    link: Link,
) -> Vec<Members> {
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
pub(super) struct Link {
    base: f32,
    /// Side of a pixel at 1 m.
    pixel: f32,
    noise: f32,
}

impl Link {
    pub(super) fn new(scene: &SceneCloud, noise_at_1m: Metres, params: &SegmentParams) -> Self {
        Self {
            base: params.link_distance.0 as f32,
            pixel: scene
                .intrinsics
                .map_or(0.0, |camera| 1.0 / camera.fx as f32),
            // The difference of two noisy depths has √2 times their deviation; four deviations include all but outliers.
            noise: (4.0 * std::f64::consts::SQRT_2 * noise_at_1m.0) as f32,
        }
    }

    pub(super) fn joins(self, a: &Point3<f32>, b: &Point3<f32>) -> bool {
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

/// Pixels of a run that follow each other.
struct Span {
    first: u32,
    end: u32,
    run: u32,
}

fn connect_pixels(
    points: &[Point3<f32>],
    labels: &[PointLabel],
    grid: Grid,
    link: Link,
) -> Vec<Vec<u32>> {
    let Grid { width, height } = grid;
    let reach = (BRIDGED_PIXELS + 1) * width;
    let mut forest = UnionFind {
        parents: Vec::new(),
    };
    let mut spans: Vec<Span> = Vec::new();
    // The last pixel of each column so far, and its run.
    let mut lowest = vec![(0, NO_RUN); width];
    for row in 0..height {
        let start = row * width;
        let mut previous: Option<(usize, Point3<f32>)> = None;
        let mut span = Span {
            first: 0,
            end: 0,
            run: NO_RUN,
        };
        let mut last_meeting = (NO_RUN, NO_RUN);
        let in_row = points[start..start + width].iter().zip(&mut lowest);
        for (i, (label, (point, lowest))) in
            (start..).zip(labels[start..start + width].iter().zip(in_row))
        {
            if *label != PointLabel::Rest {
                continue;
            }
            let is_joined = previous
                .is_some_and(|(p, at)| i - p <= BRIDGED_PIXELS + 1 && link.joins(&at, point));
            previous = Some((i, *point));
            if is_joined && span.end as usize == i {
                span.end += 1;
            } else {
                let run = if is_joined { span.run } else { forest.add() };
                if span.end > span.first {
                    spans.push(span);
                }
                span = Span {
                    first: i as u32,
                    end: i as u32 + 1,
                    run,
                };
            }
            // The nearest reading above, bridging rows without one.
            let (above, run_above) = std::mem::replace(lowest, (i, span.run));
            // Along a surface the same two runs meet at pixel after pixel; joining them once is enough.
            let meeting = (run_above, span.run);
            if run_above != NO_RUN
                && meeting != last_meeting
                && i - above <= reach
                && link.joins(&points[above], point)
            {
                forest.join(run_above, span.run);
                last_meeting = meeting;
            }
        }
        if span.end > span.first {
            spans.push(span);
        }
    }
    let mut num_of_root = vec![0; forest.parents.len()];
    for span in &mut spans {
        span.run = forest.root(span.run);
        num_of_root[span.run as usize] += (span.end - span.first) as usize;
    }
    let mut group_of_root = vec![NO_RUN; forest.parents.len()];
    let mut groups: Vec<Vec<u32>> = Vec::new();
    for Span { first, end, run } in spans {
        let (group, num) = (&mut group_of_root[run as usize], num_of_root[run as usize]);
        if num < MIN_CLUSTER_POINTS {
            continue;
        }
        if *group == NO_RUN {
            *group = groups.len() as u32;
            groups.push(Vec::with_capacity(num));
        }
        groups[*group as usize].extend(first..end);
    }
    groups
}

/// Side of a voxel, metres: an unorganised cloud may be far sparser than a picture.
const VOXEL_M: f32 = 0.04;

fn connect_voxels(points: &[Point3<f32>], labels: &[PointLabel]) -> Vec<Vec<u32>> {
    let voxel_of = |p: &Point3<f32>| [p.x, p.y, p.z].map(|x| (x / VOXEL_M).floor() as i64);
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
    // Iterate over `members`, which is in the order of the points: the map's order must not matter.
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
        // Without a camera: one square per occupied voxel.
        let mut voxels: Vec<[i64; 3]> = indices
            .iter()
            .map(|&i| points[i as usize])
            .map(|p| [p.x, p.y, p.z].map(|x| (x / VOXEL_M).floor() as i64))
            .collect();
        voxels.sort_unstable();
        voxels.dedup();
        voxels.len() as f64 * f64::from(VOXEL_M).powi(2)
    };
    Cluster {
        num_points: indices.len(),
        area,
        touches_edge: touches_edge(scene, indices),
        in_front: border.in_front,
        sides_cut: border.sides_cut,
    }
}

/// Step between the rows and columns that are searched for borders between surfaces, pixels.
const LINE_STEP: usize = 4;
/// Maximum number of pixels without a reading between two surfaces that border on each other: the shadow of one on the other.
const SHADOW: usize = 40;
/// Marks readings that belong to no surface: pixels that mix the depths of two.
const NO_GROUP: u32 = u32::MAX;

/// Distance to the end of the view up to which a reading counts as being at it, pixels.
pub(super) const MARGIN: u32 = 2;

/// Minimum number of searched lines that end with the view for a surface to be cut off on that side: about 20 pixels.
const LEAST_CUT: f64 = 5.0;

/// Properties of a surface's border.
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

/// Examines the borders in a scene's picture; `group_of` gives the surface of each point, below `num_groups`.
fn borders_of(scene: &SceneCloud, group_of: &[u32], num_groups: usize, link: Link) -> Vec<Border> {
    let Some(Grid { width, height }) = scene.cloud.grid else {
        return vec![Border::UNKNOWN; num_groups];
    };
    let points = &scene.cloud.points;
    let view = scene.field_of_view();
    // Per group: the border length where it is nearer and where it is farther, and the number of lines that end with
    // the view on the left, on the right, at the top and at the bottom.
    let mut all = vec![[0.0_f64; 6]; num_groups];
    let mut walk = |sides: [usize; 2], first: usize, stride: usize, num: usize| {
        let mut before: Option<(usize, usize)> = None;
        let end_at = |all: &mut Vec<[f64; 6]>, side: usize, i: usize| {
            if view.is_some_and(|view| view.ends_at(i % width, i / width, MARGIN)) {
                all[group_of[i] as usize][side] += 1.0;
            }
        };
        for step in 0..num {
            let i = first + step * stride;
            if group_of[i] == NO_GROUP {
                continue;
            }
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
        walk([2, 3], row * width, 1, width);
    }
    for column in (0..width).step_by(LINE_STEP) {
        walk([4, 5], column, width, height);
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

/// Returns the surface of each point as an index into `groups`; `groups.len()` stands for the background.
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

/// Returns the figures of some points of a scene; all others count as one other surface.
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

/// Returns true if the points reach the border of the field of view.
pub(super) fn touches_edge(scene: &SceneCloud, indices: &[u32]) -> bool {
    // A few stray pixels at the edge do not count.
    const LEAST: usize = 10;
    let view = scene.cloud.grid.zip(scene.field_of_view());
    view.is_some_and(|(grid, view)| {
        let mut num = 0;
        grid.by_row(indices).any(|(row, start, of_row)| {
            let columns = of_row.iter().map(|i| *i as usize - start);
            num += columns
                .filter(|column| view.ends_at(*column, row, MARGIN))
                .count();
            num >= LEAST
        })
    })
}
