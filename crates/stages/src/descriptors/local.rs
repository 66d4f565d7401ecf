//! Describes a part by one of the three local descriptors: its surface, its keypoints, and a row for each.

use nalgebra::Point3;

use super::{
    Descriptors,
    fpfh::{FpfhParams, describe_fpfh},
    shot::{ShotParams, describe_shot},
    spin_image::{SpinImageParams, describe_spin_images},
    surface::{SurfaceError, SurfaceParams, keypoints, prepare_surface},
};
use geometry::{cloud::PointCloud, units::Metres};

/// A local descriptor with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LocalDescriptor {
    /// Fast point feature histograms.
    Fpfh(FpfhParams),
    /// Signatures of histograms of orientations.
    Shot(ShotParams),
    /// Spin images.
    SpinImages(SpinImageParams),
}

/// Parameters of [`describe_scene`] and [`describe_reference`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalParams {
    /// The descriptor.
    pub descriptor: LocalDescriptor,
    /// Parameters of the surface; must be the same for scenes and references.
    pub surface: SurfaceParams,
    /// Distance between a scene's keypoints, 40..200 mm. Halving it quadruples the number of rows to describe and to match.
    pub scene_spacing: Metres,
    /// Distance between a reference's keypoints, 30..200 mm: shorter, so that one lies near each of the scene's.
    /// Halving it quadruples the number of rows to match.
    pub reference_spacing: Metres,
}

impl LocalParams {
    /// Returns the parameters for fast point feature histograms.
    pub fn fpfh() -> Self {
        Self {
            // Denser, because the angles between normals blur sooner than the quantities of the other descriptors.
            surface: SurfaceParams {
                spacing: Metres::from_mm(16.0),
                normal_radius: Metres::from_mm(48.0),
            },
            ..Self::of(LocalDescriptor::Fpfh(FpfhParams::default()))
        }
    }

    /// Returns the parameters for signatures of histograms of orientations.
    pub fn shot() -> Self {
        Self::of(LocalDescriptor::Shot(ShotParams::default()))
    }

    /// Returns the parameters for spin images.
    pub fn spin_images() -> Self {
        Self::of(LocalDescriptor::SpinImages(SpinImageParams::default()))
    }

    fn of(descriptor: LocalDescriptor) -> Self {
        Self {
            descriptor,
            surface: SurfaceParams::default(),
            scene_spacing: Metres::from_mm(100.0),
            reference_spacing: Metres::from_mm(60.0),
        }
    }
}

/// The rows of a part.
#[derive(Clone, Debug)]
pub struct LocalDescription {
    /// Number of points of the thinned surface.
    pub num_points: usize,
    /// One row per described keypoint.
    pub rows: Descriptors,
}

/// Describes a scene's part, seen by a camera at the origin.
pub fn describe_scene(
    cloud: &PointCloud,
    params: &LocalParams,
) -> Result<LocalDescription, SurfaceError> {
    describe_locally(cloud, params.scene_spacing, params)
}

/// Describes a reference's cloud; if it has no normals, it is taken as seen by a camera at the origin.
pub fn describe_reference(
    cloud: &PointCloud,
    params: &LocalParams,
) -> Result<LocalDescription, SurfaceError> {
    describe_locally(cloud, params.reference_spacing, params)
}

fn describe_locally(
    cloud: &PointCloud,
    spacing: Metres,
    params: &LocalParams,
) -> Result<LocalDescription, SurfaceError> {
    let surface = prepare_surface(cloud, &Point3::origin(), &params.surface)?;
    let keypoints = keypoints(&surface, spacing);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::descriptors::{
        matching::{DescriptorBank, rank_by_rows},
        surface::tests::bent_sheet,
    };

    #[test]
    fn each_descriptor_knows_a_sheet_again_from_aside() {
        let bent = bent_sheet();
        let flat = bent
            .iter()
            .map(|p| Point3::new(p.x, p.y, 1.2))
            .collect::<Vec<_>>();
        let [bent, flat] = [bent, flat].map(PointCloud::from_points);
        let turned = nalgebra::Isometry3::rotation(nalgebra::Vector3::new(0.1, 0.35, 0.6));
        let seen = PointCloud::from_points(bent.points.iter().map(|p| turned * p));
        for params in [
            LocalParams::fpfh(),
            LocalParams::shot(),
            LocalParams::spin_images(),
        ] {
            let describe = |cloud| describe_reference(cloud, &params).expect("a surface").rows;
            let bank = DescriptorBank::new(&[describe(&flat), describe(&bent)]);
            let scene = describe_scene(&seen, &params).expect("a surface");
            assert!(scene.num_points > 100 && scene.rows.len() > 10);
            let ranked = rank_by_rows(&scene.rows, &bank);
            assert_eq!(ranked[0].reference, 1, "{:?}", params.descriptor);
        }
    }

    #[test]
    fn a_cloud_without_a_surface_is_refused() {
        let nothing = PointCloud::default();
        assert!(describe_scene(&nothing, &LocalParams::shot()).is_err());
        assert!(describe_reference(&nothing, &LocalParams::fpfh()).is_err());
    }
}
