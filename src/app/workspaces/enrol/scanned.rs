//! A scan as what a part is enrolled from: the part that the shots voted for, and what lies about it.

use std::{borrow::Cow, sync::Arc};

use nalgebra::Point3;

use crate::{
    app::inspection::fuse::FusedShots,
    geometry::cloud::PointCloud,
    scan::{FusedCloud, Scan},
};

/// A scan, and those of its points that can be kept.
#[derive(Debug)]
pub struct ScannedMatter {
    /// The shots, put together.
    pub fused: Arc<FusedShots>,
    /// The part and what lies near it, in the camera's space of the first shot used.
    pub cloud: PointCloud,
    /// The place of each of these points in the scan's cloud.
    places: Vec<u32>,
}

/// What lies further from the part than this is not shown, metres.
const NEAR: f32 = 0.25;

impl ScannedMatter {
    pub(super) fn of(fused: Arc<FusedShots>) -> Self {
        let figure = &fused.figure;
        let points = || figure.positions.iter().map(|at| Point3::from(*at));
        let is_part = &fused.scan.cloud.is_part;
        let of_part = points().zip(is_part).filter(|(_, is)| **is);
        let part = PointCloud::from_points(of_part.map(|(point, _)| point));
        let bounds = part.bounds();
        // Without a part everything is shown: there may be something to be taken by hand.
        let is_near = |point: &Point3<f32>| match &bounds {
            Some((low, high)) => {
                (0..3).all(|axis| (low[axis] - NEAR..=high[axis] + NEAR).contains(&point[axis]))
            }
            None => true,
        };
        let near = points().enumerate().filter(|(_, point)| is_near(point));
        let (places, points): (Vec<u32>, Vec<Point3<f32>>) =
            near.map(|(place, point)| (place as u32, point)).unzip();
        Self {
            cloud: PointCloud {
                is_simulated: fused.scan.cloud.cloud.is_simulated,
                ..PointCloud::from_points(points)
            },
            places,
            fused,
        }
    }

    /// Places of the points that are the part by the shots' vote, or of the others.
    pub(super) fn voted(&self, is_part: bool) -> Vec<u32> {
        let all = &self.fused.scan.cloud.is_part;
        let of = self.places.iter().enumerate();
        of.filter(|(_, place)| all[**place as usize] == is_part)
            .map(|(index, _)| index as u32)
            .collect()
    }

    /// The scan with these points as its part.
    pub(super) fn with_part(&self, kept: &[u32]) -> Cow<'_, Scan> {
        let scan = &self.fused.scan;
        let mut is_part = vec![false; scan.cloud.is_part.len()];
        for index in kept {
            is_part[self.places[*index as usize] as usize] = true;
        }
        if is_part == scan.cloud.is_part {
            return Cow::Borrowed(scan);
        }
        Cow::Owned(Scan {
            cloud: FusedCloud {
                is_part,
                ..scan.cloud.clone()
            },
            ..scan.clone()
        })
    }
}
