//! Segmentation: takes the background planes away and keeps the one connected surface that is the part.
//!
//! Planes are found by RANSAC (Fischler and Bolles, Communications of the ACM 24(6), 1981) with the number of
//! samples from the paper's eq. 1, then fitted by least squares. We depart from the paper in three ways, because a
//! large flat part would otherwise be taken for a third wall, and because a depth camera's noise grows with depth²:
//! - a plane is background only if (nearly) everything else lies in front of it and it runs out of the picture;
//! - a point belongs to a plane within a distance that follows the noise, which is measured on the largest plane;
//! - of what is left, one connected surface is the part, not all of it: the largest, those inside the picture first.
//!
//! The noise is measured on the picture before a plane is known, so that a wall is found at any noise. A capture of the
//! [`EmptyCell`] fixes wall, floor and whatever else always stands there.
//!
//! Known limits: whatever touches the part and was not there in the empty cell, such as a hanger, joins it.

mod clusters;
mod empty_cell;
mod noise;
mod planes;
mod subset;

use nalgebra::Point3;

pub use self::{
    clusters::Cluster,
    empty_cell::{EmptyCell, EmptyCellError},
    noise::noise_of_picture,
    planes::BackgroundPlane,
};
use crate::{error::Advice, geometry::cloud::PointCloud, stages::scene::SceneCloud, units::Metres};

/// Parameters of [`segment`]. The defaults work untouched for a Kinect-like camera.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct SegmentParams {
    /// The paper's `d_t`: a point closer than this (plus the noise) to a background plane belongs to it, 1..50 mm.
    /// Raising it eats what is near the wall.
    pub plane_distance: Metres,
    /// Least standard deviation of the depth at 1 m to reckon with, 0..20 mm; it grows with depth². Used until the
    /// picture and then a plane show the real one.
    pub noise_at_1m: Metres,
    /// How many standard deviations of noise still belong to a plane, 2..6. Raising it eats what is near the wall,
    /// lowering it leaves specks of the wall.
    pub noise_factor: f64,
    /// The paper's p in eq. 1: the probability that at least one sample is good, 0.9..0.9999. Raising it costs time.
    pub good_sample_probability: f64,
    /// Most planes to take away, 0..4: wall, floor and one more.
    pub max_planes: usize,
    /// Neighbouring points further apart than this (plus the noise) are not connected, 5..100 mm. Raising it joins
    /// what hangs close to the part, lowering it tears the part.
    pub link_distance: Metres,
    /// Less surface than this, seen from the camera, is no part, square metres, 0.001..1.
    pub min_part_area: f64,
    /// Seed of the random samples.
    pub seed: u64,
}

impl Default for SegmentParams {
    fn default() -> Self {
        Self {
            plane_distance: Metres::from_mm(8.0),
            noise_at_1m: Metres::from_mm(1.5),
            noise_factor: 4.0,
            good_sample_probability: 0.99,
            max_planes: 3,
            link_distance: Metres::from_mm(20.0),
            min_part_area: 0.02,
            seed: 1,
        }
    }
}

/// What a point of the scene was taken for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointLabel {
    /// The camera had no reading here.
    NoReading,
    /// On (or behind) the background plane of this number; one more than the last of them: what stood in the empty cell.
    Background(u8),
    /// Neither background nor part.
    Rest,
    /// The part.
    Part,
}

/// Everything that segmentation found.
#[derive(Clone, Debug, PartialEq)]
pub struct Segmentation {
    /// One label per point of the scene.
    pub labels: Vec<PointLabel>,
    /// The planes taken away, in the order found.
    pub planes: Vec<BackgroundPlane>,
    /// The connected surfaces left, largest first. The part is the largest that lies inside the picture, or one more
    /// than twice as large that does not.
    pub clusters: Vec<Cluster>,
    /// Standard deviation of the depth at 1 m, measured on the largest plane, else as given in the parameters.
    pub noise_at_1m: Metres,
    /// The part, or why there is none.
    pub part: Result<SegmentedPart, NoPart>,
}

/// The points of the part alone.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmentedPart {
    /// The part's points, metres, camera space, unorganised, in the scene's order.
    pub cloud: PointCloud,
    /// For each of them its index in the scene.
    pub indices: Vec<u32>,
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
            point.is_some_and(crate::geometry::cloud::is_finite)
        };
        let indices: Vec<u32> = indices.iter().copied().filter(is_reading).collect();
        let touches_edge = clusters::touches_edge(scene, &indices);
        Self::of(&scene.cloud, indices, noise_at_1m, touches_edge)
    }

    /// The same part in the mirrored scene.
    #[must_use]
    pub fn mirrored(&self, mirrored_scene: &SceneCloud) -> Self {
        let mut indices = self.indices.clone();
        if let Some(crate::geometry::cloud::Grid { width, .. }) = mirrored_scene.cloud.grid {
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
            noise_at_1m,
            touches_edge,
        }
    }
}

/// Why no part was found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoPart {
    /// The scene holds too few points for anything.
    #[error("the scene has {found} readings, at least {needed} are needed")]
    TooFewPoints {
        /// Finite points of the scene.
        found: usize,
        /// Least number of points.
        needed: usize,
    },
    /// Far larger than any cell.
    #[error("the scene spans {extent:.0} m and holds nothing the size of a part")]
    TooWide {
        /// Largest extent, metres.
        extent: f64,
    },
    /// Nothing of a part's size is left once the background is gone.
    #[error(
        "nothing the size of a part stands before the background ({planes} planes removed, largest rest {found:.3} m², needed {needed:.3} m²)"
    )]
    OnlyBackground {
        /// Planes taken away.
        planes: usize,
        /// Largest connected surface left, square metres.
        found: f64,
        /// Least surface of a part, square metres.
        needed: f64,
    },
}

impl Advice for NoPart {
    fn advice(&self) -> String {
        match self {
            Self::TooFewPoints { .. } => {
                "Check that the camera is connected, uncovered and 0.6 to 3 m from the part, then capture again".into()
            }
            Self::TooWide { .. } => "Export the scene in metres: it looks like millimetres".into(),
            Self::OnlyBackground { .. } => {
                "Hang the part in front of the camera, at least 10 cm away from the wall, and capture again".into()
            }
        }
    }
}

/// Fewer readings than this cannot show a part: a hand-sized patch at 2 m already gives more.
const MIN_POINTS: usize = 200;

/// Finds the background planes and the part before them.
pub fn segment(scene: &SceneCloud, params: &SegmentParams) -> Segmentation {
    // The rest need not be counted.
    let found = scene.cloud.finite().take(MIN_POINTS).count();
    if found < MIN_POINTS {
        return Segmentation {
            labels: label_readings(&scene.cloud.points),
            planes: Vec::new(),
            clusters: Vec::new(),
            noise_at_1m: params.noise_at_1m,
            part: Err(NoPart::TooFewPoints {
                found,
                needed: MIN_POINTS,
            }),
        };
    }
    let planes::Background {
        mut planes,
        noise_at_1m,
    } = planes::find_background(scene, params);
    let empty_cell = scene.empty_cell.as_ref().filter(|cell| cell.fits(scene));
    if let Some(cell) = empty_cell {
        planes.retain(|found| cell.knows(&found.plane, scene, noise_at_1m, params));
    }
    let points = &scene.cloud.points;
    let mut labels = planes::label_background(points, &planes, noise_at_1m, params);
    if let Some(cell) = empty_cell {
        let label = PointLabel::Background(planes.len() as u8);
        cell.mark(points, &mut labels, label, noise_at_1m, params);
    }
    let clusters = clusters::connect(scene, &labels, noise_at_1m, params);
    let part = take_part(scene, &clusters, &mut labels, &planes, noise_at_1m, params)
        .map_err(|no_part| too_wide(scene).unwrap_or(no_part));
    Segmentation {
        labels,
        planes,
        clusters: clusters.into_iter().map(|c| c.cluster).collect(),
        noise_at_1m,
        part,
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
    let taken = segmentation
        .part
        .as_ref()
        .ok()
        .and_then(|p| p.indices.first());
    let mut others: Vec<(f64, bool, Vec<u32>)> = surfaces(scene, segmentation, params)
        .into_iter()
        .zip(&segmentation.clusters)
        .filter(|(indices, cluster)| is_candidate(cluster) && indices.first() != taken)
        .map(|(indices, cluster)| (likelihood(cluster), cluster.touches_edge, indices))
        .collect();
    others.sort_by(|a, b| b.0.total_cmp(&a.0));
    others
        .into_iter()
        .take(limit)
        .map(|(_, touches_edge, indices)| {
            SegmentedPart::of(
                &scene.cloud,
                indices,
                segmentation.noise_at_1m,
                touches_edge,
            )
        })
        .collect()
}

impl Segmentation {
    /// Takes another surface for the part.
    pub fn take(&mut self, part: SegmentedPart) {
        for label in &mut self.labels {
            if *label == PointLabel::Part {
                *label = PointLabel::Rest;
            }
        }
        for &i in &part.indices {
            if let Some(label) = self.labels.get_mut(i as usize) {
                *label = PointLabel::Part;
            }
        }
        self.part = Ok(part);
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

/// A scene wider than this is no cell: a file in millimetres reads as a thousand times as wide, metres.
const WIDEST_SCENE: f64 = 200.0;

fn too_wide(scene: &SceneCloud) -> Option<NoPart> {
    let (low, high) = scene.cloud.bounds()?;
    let extent = f64::from((high - low).amax());
    (extent > WIDEST_SCENE).then_some(NoPart::TooWide { extent })
}

fn label_readings(points: &[Point3<f32>]) -> Vec<PointLabel> {
    let label = |p: &Point3<f32>| {
        if crate::geometry::cloud::is_finite(p) {
            PointLabel::Rest
        } else {
            PointLabel::NoReading
        }
    };
    points.iter().map(label).collect()
}

/// How likely a surface is the part: the larger the more, but what runs out of the picture is more often a strip of
/// floor or a neighbour than the part.
fn likelihood(cluster: &Cluster) -> f64 {
    cluster.area * if cluster.touches_edge { 0.4 } else { 1.0 }
}

fn take_part(
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
            for &i in &largest.indices {
                labels[i as usize] = PointLabel::Part;
            }
            Ok(SegmentedPart::of(
                &scene.cloud,
                largest.indices.clone(),
                noise_at_1m,
                largest.cluster.touches_edge,
            ))
        }
        _ => Err(NoPart::OnlyBackground {
            planes: planes.len(),
            found: largest.map_or(0.0, |l| l.cluster.area),
            needed: params.min_part_area,
        }),
    }
}

#[cfg(test)]
mod tests;
