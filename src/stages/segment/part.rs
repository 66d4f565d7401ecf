//! Which of the connected surfaces is the part, and the part's points alone.

use super::{
    BackgroundPlane, Cluster, MIN_POINTS, NoPart, PointLabel, SegmentParams, Segmentation,
    clusters, label_readings, stand::take_stand_off,
};
use crate::{
    geometry::cloud::{Grid, PointCloud, is_finite},
    stages::scene::SceneCloud,
    units::Metres,
};

/// The points of the part alone.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmentedPart {
    /// The part's points, metres, camera space, unorganised, in the scene's order.
    pub cloud: PointCloud,
    /// For each of them its index in the scene, ascending.
    pub indices: Vec<u32>,
    /// The places in the scene, ascending, of what touches the part and was taken for a stand's; not among the points.
    pub stand: Vec<u32>,
    /// Standard deviation of a point's depth at 1 m; it grows with depth².
    pub noise_at_1m: Metres,
    /// True if the part reaches the edge of the picture, so that some of it may be missing.
    pub touches_edge: bool,
}

impl SegmentedPart {
    /// A cloud that holds nothing but the part.
    pub fn whole(cloud: &PointCloud) -> Self {
        let indices: Vec<u32> = cloud.finite().map(|(i, _)| i as u32).collect();
        Self::of(cloud, indices, SegmentParams::default().noise_at_1m, false)
    }

    /// The readings of a scene at these places, ascending.
    pub fn selected(scene: &SceneCloud, indices: &[u32], noise_at_1m: Metres) -> Self {
        let is_reading = |i: &u32| {
            let point = scene.cloud.points.get(*i as usize);
            point.is_some_and(is_finite)
        };
        let indices: Vec<u32> = indices.iter().copied().filter(is_reading).collect();
        let touches_edge = clusters::touches_edge(scene, &indices);
        Self::of(&scene.cloud, indices, noise_at_1m, touches_edge)
    }

    /// The same part in the mirrored scene.
    #[must_use]
    pub fn mirrored(&self, mirrored_scene: &SceneCloud) -> Self {
        let mut indices = self.indices.clone();
        if let Some(Grid { width, .. }) = mirrored_scene.cloud.grid {
            for i in &mut indices {
                let (row, column) = (*i as usize / width, *i as usize % width);
                *i = (row * width + width - 1 - column) as u32;
            }
            indices.sort_unstable();
        }
        Self::of(
            &mirrored_scene.cloud,
            indices,
            self.noise_at_1m,
            self.touches_edge,
        )
    }

    fn of(scene: &PointCloud, indices: Vec<u32>, noise_at_1m: Metres, touches_edge: bool) -> Self {
        let pick = |i: &u32| *i as usize;
        Self {
            cloud: PointCloud {
                points: indices.iter().map(|i| scene.points[pick(i)]).collect(),
                normals: scene
                    .normals
                    .as_ref()
                    .map(|all| indices.iter().map(|i| all[pick(i)]).collect()),
                colours: scene
                    .colours
                    .as_ref()
                    .map(|all| indices.iter().map(|i| all[pick(i)]).collect()),
                labels: None,
                grid: None,
                is_simulated: scene.is_simulated,
            },
            indices,
            stand: Vec::new(),
            noise_at_1m,
            touches_edge,
        }
    }

    /// A connected surface without the stand that touches it.
    fn of_surface(scene: &SceneCloud, surface: Vec<u32>, noise_at_1m: Metres) -> Self {
        let (indices, stand) = take_stand_off(scene, surface);
        let touches_edge = clusters::touches_edge(scene, &indices);
        Self {
            stand,
            ..Self::of(&scene.cloud, indices, noise_at_1m, touches_edge)
        }
    }

    /// The first of its points, or of its stand's: the first of the connected surface that it is of.
    fn first_of_surface(&self) -> Option<&u32> {
        self.indices
            .first()
            .into_iter()
            .chain(self.stand.first())
            .min()
    }
}

/// The places in the scene of the points of every connected surface, ascending; in the order of
/// [`Segmentation::clusters`].
pub fn surfaces(
    scene: &SceneCloud,
    segmentation: &Segmentation,
    params: &SegmentParams,
) -> Vec<Vec<u32>> {
    let before = |label: &PointLabel| match label {
        PointLabel::Part => PointLabel::Rest,
        label => *label,
    };
    let labels: Vec<PointLabel> = segmentation.labels.iter().map(before).collect();
    connected(scene, &labels, segmentation.noise_at_1m, params)
}

/// The places of the points of every connected surface of a scene that is all part, largest first.
pub fn pieces(scene: &SceneCloud, params: &SegmentParams) -> Vec<Vec<u32>> {
    let labels = label_readings(&scene.cloud.points);
    connected(scene, &labels, params.noise_at_1m, params)
}

/// A surface smaller than this share of the largest one is not looked at as a part.
const LEAST_SHARE: f64 = 0.1;

/// The surfaces beside the one that was taken for the part, the likeliest first, at most `limit`.
pub fn other_parts(
    scene: &SceneCloud,
    segmentation: &Segmentation,
    params: &SegmentParams,
    limit: usize,
) -> Vec<SegmentedPart> {
    let largest = segmentation.clusters.first().map_or(0.0, |c| c.area);
    let least = params.min_part_area.max(LEAST_SHARE * largest);
    let is_candidate =
        |cluster: &Cluster| cluster.area >= least && cluster.num_points >= MIN_POINTS;
    if segmentation
        .clusters
        .iter()
        .filter(|c| is_candidate(c))
        .count()
        < 2
    {
        return Vec::new();
    }
    let part = segmentation.part.as_ref().ok();
    let taken = part.and_then(SegmentedPart::first_of_surface);
    let mut others: Vec<(f64, Vec<u32>)> = surfaces(scene, segmentation, params)
        .into_iter()
        .zip(&segmentation.clusters)
        .filter(|(indices, cluster)| is_candidate(cluster) && indices.first() != taken)
        .map(|(indices, cluster)| (likelihood(cluster), indices))
        .collect();
    others.sort_by(|a, b| b.0.total_cmp(&a.0));
    others
        .into_iter()
        .take(limit)
        .map(|(_, surface)| SegmentedPart::of_surface(scene, surface, segmentation.noise_at_1m))
        .collect()
}

/// A surface that is the nearer one along less than this share of its border lies behind others.
const IN_FRONT: f64 = 0.5;

/// How likely a surface is the part: the more of the view it fills, the more, since the camera looks at the part. But what
/// runs out of the view is more often a strip of floor or a neighbour, and what lies behind others is a wall.
fn likelihood(cluster: &Cluster) -> f64 {
    let in_front = (cluster.in_front / IN_FRONT).min(1.0).powi(2);
    cluster.num_points as f64 * in_front * if cluster.touches_edge { 0.4 } else { 1.0 }
}

pub(super) fn take_part(
    scene: &SceneCloud,
    clusters: &[clusters::Members],
    labels: &mut [PointLabel],
    planes: &[BackgroundPlane],
    noise_at_1m: Metres,
    params: &SegmentParams,
) -> Result<SegmentedPart, NoPart> {
    let largest = clusters
        .iter()
        .max_by(|a, b| likelihood(&a.cluster).total_cmp(&likelihood(&b.cluster)));
    match largest {
        Some(largest)
            if largest.cluster.area >= params.min_part_area
                && largest.indices.len() >= MIN_POINTS =>
        {
            let part = SegmentedPart::of_surface(scene, largest.indices.clone(), noise_at_1m);
            for &i in &part.indices {
                labels[i as usize] = PointLabel::Part;
            }
            Ok(part)
        }
        _ => Err(NoPart::OnlyBackground {
            knows_cell: scene.empty_cell.is_some(),
            planes: planes.len(),
            found: largest.map_or(0.0, |l| l.cluster.area),
            needed: params.min_part_area,
        }),
    }
}

fn connected(
    scene: &SceneCloud,
    labels: &[PointLabel],
    noise_at_1m: Metres,
    params: &SegmentParams,
) -> Vec<Vec<u32>> {
    let found = clusters::connect(scene, labels, noise_at_1m, params);
    found.into_iter().map(|members| members.indices).collect()
}
