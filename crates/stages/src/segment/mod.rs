//! Segmentation: removes the background planes and selects the connected surface that is the part.
//!
//! Planes are found by RANSAC (Fischler and Bolles, Communications of the ACM 24(6), 1981) with the number of samples
//! from the paper's eq. 1, then fitted by least squares. We deviate from the paper in three ways, because a large flat
//! part would otherwise be taken for a third wall, and because a depth camera's noise grows with depth²:
//! - a plane is background only if (nearly) everything else lies in front of it and it extends beyond the picture;
//! - the distance within which a point belongs to a plane follows the noise, which is measured on the largest plane;
//! - of the rest, one connected surface is the part, not all of it: the one that fills most of the view, preferring
//!   surfaces that lie inside it and in front of others. Bars of a stand that touch it are removed.
//!
//! Before a plane is known the noise is estimated from the picture, so that a wall is found at any noise. A capture of
//! the [`EmptyCell`](super::scene::EmptyCell) defines wall, floor and everything else that is always there.
//!
//! Known limits: an object that touches the part, was not in the empty cell and is not a bar becomes part of it.

mod clusters;
mod empty_cell;
mod necks;
mod noise;
mod part;
mod planes;
mod stand;
mod strip;
mod subset;

use nalgebra::Point3;

pub(crate) use self::clusters::BRIDGED_PIXELS;
pub use self::{
    clusters::Cluster,
    noise::noise_of_picture,
    part::{BackgroundSign, SegmentedPart, other_segments, pieces, split, without_bars},
};
use crate::{rack::Rack, scene::SceneCloud};
use geometry::{plane::Plane, units::Metres};

/// Maximum number of parts in a frame: of more, too little is in the picture.
pub const MAX_PARTS: usize = 8;

/// Parameters of [`segment`]. The defaults suit a Kinect-like camera.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct SegmentParams {
    /// The paper's `d_t`: a point closer than this (plus the noise) to a background plane belongs to it, 1..50 mm.
    /// Raising it removes points of objects near the wall.
    pub plane_distance: Metres,
    /// Minimum standard deviation of the depth at 1 m, 0..20 mm; it grows with depth². The picture may raise it, and
    /// the first background plane replaces it by the measured value.
    pub noise_at_1m: Metres,
    /// Number of standard deviations of noise within which a point belongs to a plane, 2..6. Raising it removes points
    /// of objects near the wall, lowering it leaves specks of the wall.
    pub noise_factor: f64,
    /// The paper's p in eq. 1: the probability that at least one sample is good, 0.9..0.9999. Raising it costs time.
    pub good_sample_probability: f64,
    /// Maximum number of planes to remove, 0..4: wall, floor and one more by default.
    pub max_planes: usize,
    /// Neighbouring points farther apart than this (plus a pixel and the noise) are not connected, 5..100 mm. Raising
    /// it joins nearby objects to the part, lowering it splits a part that is seen at a flat angle.
    pub link_distance: Metres,
    /// Minimum area of a part as seen from the camera, square metres, 0.001..1.
    pub min_part_area: f64,
    /// Maximum number of parts that are accepted in a frame, 1..=[`MAX_PARTS`].
    pub max_parts: usize,
    /// Seed of the random samples, 0..999 999.
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
            link_distance: Metres::from_mm(6.0),
            min_part_area: 0.02,
            max_parts: 1,
            seed: 1,
        }
    }
}

/// Classification of a point of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointLabel {
    /// No reading here.
    NoReading,
    /// On or behind the background plane of this index; the number of planes stands for the empty cell, and for what lies
    /// outside the work volume.
    Background(u8),
    /// Neither background nor part.
    Rest,
    /// The part.
    Part,
}

/// Result of the segmentation.
#[derive(Clone, Debug, PartialEq)]
pub struct Segmentation {
    /// One label per point of the scene.
    pub labels: Vec<PointLabel>,
    /// The removed planes in camera space, in the order found; their normals point to the camera.
    pub planes: Vec<Plane>,
    /// The remaining connected surfaces, largest first, including a stand that touches them.
    pub clusters: Vec<Cluster>,
    /// Indices of the points of each of them in the scene, ascending.
    pub surfaces: Vec<Vec<u32>>,
    /// Standard deviation of the depth at 1 m, measured on the first background plane; without one, the larger of
    /// the picture's and the parameter's.
    pub noise_at_1m: Metres,
    /// The part, or the reason why there is none.
    pub part: Result<SegmentedPart, NoPart>,
}

/// Reason why no part was found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error, serde::Serialize, serde::Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum NoPart {
    /// The scene has too few points.
    TooFewPoints {
        /// Number of finite points in the scene.
        found: usize,
        /// Minimum number of points.
        needed: usize,
    },
    /// The scene is far larger than any cell.
    TooWide {
        /// Largest extent, metres.
        #[serde(rename = "extent_m")]
        extent: f64,
    },
    /// Nothing of a part's size remains without the background.
    OnlyBackground {
        /// Number of planes removed.
        planes: usize,
        /// Area of the likeliest remaining surface, square metres.
        #[serde(rename = "found_m2")]
        found: f64,
        /// Minimum area of a part, square metres.
        #[serde(rename = "needed_m2")]
        needed: f64,
        /// True if there is a capture of the empty cell.
        knows_cell: bool,
    },
}

texts::described!(NoPart: "refusal" by "kind");

/// Minimum number of readings: a hand-sized patch at 2 m already gives more.
const MIN_POINTS: usize = 200;

/// Finds the background planes and the part in front of them.
pub fn segment(scene: &SceneCloud, params: &SegmentParams) -> Segmentation {
    segment_in(scene, Rack::ANYWHERE, params)
}

/// As [`segment`], of what lies in the work volume of a rack.
pub fn segment_in(scene: &SceneCloud, rack: &Rack, params: &SegmentParams) -> Segmentation {
    // Counting to the minimum is enough.
    let found = scene.cloud.finite().take(MIN_POINTS).count();
    if found < MIN_POINTS {
        return Segmentation {
            labels: label_readings(&scene.cloud.points),
            planes: Vec::new(),
            clusters: Vec::new(),
            surfaces: Vec::new(),
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
    let empty_cell = scene.fitting_empty_cell().unwrap_or_default();
    if let Some(cell) = empty_cell {
        planes.retain(|plane| cell.knows(plane, scene, noise_at_1m, params));
    }
    let points = &scene.cloud.points;
    let mut labels = planes::label_background(points, &planes, noise_at_1m, params);
    if let Some(cell) = empty_cell {
        let label = PointLabel::Background(planes.len() as u8);
        cell.mark(points, &mut labels, label, noise_at_1m, params);
    }
    if !rack.volume.is_empty() {
        let is_inside = rack.volume_test();
        for (point, label) in points.iter().zip(&mut labels) {
            if *label == PointLabel::Rest && !is_inside(point) {
                *label = PointLabel::Background(planes.len() as u8);
            }
        }
    }
    let found = clusters::connect(scene, &labels, noise_at_1m, params);
    let part = part::select_part(scene, &found, &mut labels, &planes, noise_at_1m, params)
        .map_err(|no_part| too_wide(scene).unwrap_or(no_part));
    let (clusters, surfaces) = found.into_iter().map(|c| (c.cluster, c.indices)).unzip();
    Segmentation {
        labels,
        planes,
        clusters,
        surfaces,
        noise_at_1m,
        part,
    }
}

impl Segmentation {
    /// Replaces the part by another surface.
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

/// Maximum extent of a scene, metres; a file in millimetres appears a thousand times as large.
const MAX_SCENE_EXTENT_M: f64 = 200.0;

fn too_wide(scene: &SceneCloud) -> Option<NoPart> {
    let (low, high) = scene.cloud.bounds()?;
    let extent = f64::from((high - low).amax());
    (extent > MAX_SCENE_EXTENT_M).then_some(NoPart::TooWide { extent })
}

fn label_readings(points: &[Point3<f32>]) -> Vec<PointLabel> {
    let label = |p: &Point3<f32>| {
        if geometry::cloud::is_finite(p) {
            PointLabel::Rest
        } else {
            PointLabel::NoReading
        }
    };
    points.iter().map(label).collect()
}

#[cfg(test)]
mod tests;
