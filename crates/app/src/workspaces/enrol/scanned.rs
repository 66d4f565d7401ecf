//! A scan as the input of enrolling: the part by the vote of the shots, and its surroundings.

use std::{borrow::Cow, sync::Arc};

use nalgebra::Point3;

use geometry::cloud::PointCloud;
use shell::inspection::scan::FusedShots;
use stages::scan::{FusedCloud, Scan};

/// A scan, and the points of it that can be kept.
#[derive(Debug)]
pub struct ScannedMatter {
    /// The fused shots.
    pub fused: Arc<FusedShots>,
    /// The part and its surroundings, in the camera frame of the first shot used.
    pub cloud: PointCloud,
    /// Index of each of these points in the scan's cloud.
    indices: Vec<u32>,
}

/// Points further than this from the part's bounding box are left out, metres.
const NEAR: f32 = 0.25;

impl ScannedMatter {
    pub(super) fn of(fused: Arc<FusedShots>) -> Self {
        let figure = &fused.figure;
        let points = || figure.positions.iter().map(|at| Point3::from(*at));
        let is_part = &fused.scan.cloud.is_part;
        let of_part = points().zip(is_part).filter(|(_, is)| **is);
        let part = PointCloud::from_points(of_part.map(|(point, _)| point));
        let bounds = part.bounds();
        // Without a part, keep everything, so that a person can select by hand.
        let is_near = |point: &Point3<f32>| match &bounds {
            Some((low, high)) => {
                (0..3).all(|axis| (low[axis] - NEAR..=high[axis] + NEAR).contains(&point[axis]))
            }
            None => true,
        };
        let near = points().enumerate().filter(|(_, point)| is_near(point));
        let (indices, points): (Vec<u32>, Vec<Point3<f32>>) =
            near.map(|(index, point)| (index as u32, point)).unzip();
        Self {
            cloud: PointCloud {
                is_simulated: fused.scan.cloud.cloud.is_simulated,
                ..PointCloud::from_points(points)
            },
            indices,
            fused,
        }
    }

    /// Indices of the points that the shots voted to be the part, or of the others.
    pub(super) fn voted(&self, is_part: bool) -> Vec<u32> {
        let all = &self.fused.scan.cloud.is_part;
        let of = self.indices.iter().enumerate();
        of.filter(|(_, index)| all[**index as usize] == is_part)
            .map(|(index, _)| index as u32)
            .collect()
    }

    /// Returns the scan with the kept points as its part.
    pub(super) fn with_part(&self, kept: &[u32]) -> Cow<'_, Scan> {
        let scan = &self.fused.scan;
        let mut is_part = vec![false; scan.cloud.is_part.len()];
        for index in kept {
            is_part[self.indices[*index as usize] as usize] = true;
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
