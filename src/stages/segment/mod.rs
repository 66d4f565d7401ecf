//! Segmentation: takes the background planes away and keeps the one connected surface that is the part.
//!
//! Planes are found by RANSAC (Fischler and Bolles, Communications of the ACM 24(6), 1981) with the number of
//! samples from the paper's eq. 1, then fitted by least squares. We depart from the paper in three ways, because a
//! large flat part would otherwise be taken for a third wall, and because a depth camera's noise grows with depth²:
//! - a plane is background only if (nearly) everything else lies in front of it and it runs out of the picture;
//! - a point belongs to a plane within a distance that follows the noise, which is measured on the largest plane;
//! - of what is left, one connected surface is the part, not all of it: the one that fills most of the view, those first
//!   that lie inside it and in front of others. Bars of a stand that touch it are taken off it.
//!
//! The noise is measured on the picture before a plane is known, so that a wall is found at any noise. A capture of the
//! [`EmptyCell`](super::scene::EmptyCell) fixes wall, floor and whatever else always stands there.
//!
//! Known limits: whatever touches the part, was not there in the empty cell and is no bar joins it.

mod clusters;
mod empty_cell;
mod noise;
mod part;
mod planes;
mod stand;
mod subset;

use nalgebra::Point3;

pub use self::{
    clusters::Cluster,
    noise::noise_of_picture,
    part::{BackgroundSign, SegmentedPart, other_segments, pieces, surfaces, without_bars},
    planes::BackgroundPlane,
    stand::Bars,
};
use crate::{error::Advice, stages::scene::SceneCloud, units::Metres};

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
    /// Neighbouring points further apart than this (plus a pixel and the noise) are not connected, 5..100 mm. Raising it joins
    /// what hangs or stands close to the part, lowering it tears a part that is seen at a flat angle.
    pub link_distance: Metres,
    /// Less surface than this, seen from the camera, is no part, square metres, 0.001..1.
    pub min_part_area: f64,
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
    /// The connected surfaces left, largest first, each with the stand that touches it.
    pub clusters: Vec<Cluster>,
    /// Standard deviation of the depth at 1 m, measured on the largest plane, else as given in the parameters.
    pub noise_at_1m: Metres,
    /// The part, or why there is none.
    pub part: Result<SegmentedPart, NoPart>,
}

/// Why no part was found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error, serde::Serialize, serde::Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
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
        #[serde(rename = "extent_m")]
        extent: f64,
    },
    /// Nothing of a part's size is left once the background is gone.
    #[error(
        "nothing the size of a part stands in front of the background ({planes} planes removed, largest rest {found:.3} m², needed {needed:.3} m²)"
    )]
    OnlyBackground {
        /// Planes taken away.
        planes: usize,
        /// Largest connected surface left, square metres.
        #[serde(rename = "found_m2")]
        found: f64,
        /// Least surface of a part, square metres.
        #[serde(rename = "needed_m2")]
        needed: f64,
        /// True if what stood in the empty cell is background too.
        knows_cell: bool,
    },
}

impl Advice for NoPart {
    fn advice(&self) -> String {
        match self {
            Self::TooFewPoints { .. } => {
                "Check that the camera is connected, uncovered and 0.6 to 3 m from the part, then capture again".into()
            }
            Self::TooWide { .. } => "Read it as millimetres (--units mm), or export it in metres".into(),
            Self::OnlyBackground {
                knows_cell: true, ..
            } => {
                "Hang the part in front of the camera, at least 10 cm away from the wall, and capture again; if it hung there \
                 when the empty cell was captured, capture that anew without it"
                    .into()
            }
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
    let part = part::select_part(scene, &clusters, &mut labels, &planes, noise_at_1m, params)
        .map_err(|no_part| too_wide(scene).unwrap_or(no_part));
    Segmentation {
        labels,
        planes,
        clusters: clusters.into_iter().map(|c| c.cluster).collect(),
        noise_at_1m,
        part,
    }
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

#[cfg(test)]
mod tests;
