//! A part described by one of the three local descriptors: its surface, its keypoints, a row for each.

use nalgebra::Point3;

use super::{
    Descriptors,
    fpfh::{FpfhParams, describe_fpfh},
    shot::{ShotParams, describe_shot},
    spin_image::{SpinImageParams, describe_spin_images},
    surface::{SurfaceError, SurfaceParams, keypoints, take_surface},
};
use crate::{geometry::cloud::PointCloud, units::Metres};

/// Which local descriptor, with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LocalDescriptor {
    /// Fast point feature histograms.
    Fpfh(FpfhParams),
    /// Signatures of histograms of orientations.
    Shot(ShotParams),
    /// Spin images.
    SpinImages(SpinImageParams),
}

/// Parameters of [`describe_locally`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalParams {
    /// Which descriptor.
    pub descriptor: LocalDescriptor,
    /// The surface; the same for scenes and references.
    pub surface: SurfaceParams,
    /// Distance between keypoints, 20..200 mm. Halving it makes four times as many rows, to describe and to match.
    pub keypoint_spacing: Metres,
}

impl LocalParams {
    /// Fast point feature histograms.
    pub fn fpfh() -> Self {
        Self::of(LocalDescriptor::Fpfh(FpfhParams::default()))
    }

    /// Signatures of histograms of orientations.
    pub fn shot() -> Self {
        Self::of(LocalDescriptor::Shot(ShotParams::default()))
    }

    /// Spin images.
    pub fn spin_images() -> Self {
        Self::of(LocalDescriptor::SpinImages(SpinImageParams::default()))
    }

    fn of(descriptor: LocalDescriptor) -> Self {
        Self {
            descriptor,
            surface: SurfaceParams::default(),
            keypoint_spacing: Metres::from_mm(80.0),
        }
    }
}

/// A part's rows, and what they were taken from.
#[derive(Clone, Debug)]
pub struct LocalDescription {
    /// Points of the thinned surface.
    pub num_points: usize,
    /// The rows.
    pub rows: Descriptors,
}

/// Describes a part as a camera at `viewpoint` saw it.
pub fn describe_locally(
    cloud: &PointCloud,
    viewpoint: &Point3<f64>,
    params: &LocalParams,
) -> Result<LocalDescription, SurfaceError> {
    let surface = take_surface(cloud, viewpoint, &params.surface)?;
    let keypoints = keypoints(&surface, params.keypoint_spacing);
    let rows = match &params.descriptor {
        LocalDescriptor::Fpfh(params) => describe_fpfh(&surface, &keypoints, params),
        LocalDescriptor::Shot(params) => describe_shot(&surface, &keypoints, params),
        LocalDescriptor::SpinImages(params) => describe_spin_images(&surface, &keypoints, params),
    };
    Ok(LocalDescription {
        num_points: surface.points.len(),
        rows,
    })
}
