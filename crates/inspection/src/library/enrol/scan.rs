//! Enrolling the part of a scan.

use super::{
    EnrolError, EnrolParams, EnrolWarning, Enrolled, MIN_POINTS, PartDescription, ReferenceOrigin,
    assemble, thinned,
};
use crate::library::part::EnrolMethod;
use geometry::cloud::PointCloud;
use stages::{
    reference::{Coverage, ViewCut},
    scan::{Scan, unseen::unseen_share},
};

/// Enrols the scanned part, in the camera frame of the first shot used.
pub fn enrol_scan(
    scan: &Scan,
    about: &PartDescription,
    params: &EnrolParams,
) -> Result<Enrolled, EnrolError> {
    let part = scan.cloud.part();
    let num_points = part.cloud.points.len();
    let num_shots = scan.used().count();
    let first = scan.used().next().filter(|_| num_points >= MIN_POINTS);
    let Some((_, first)) = first else {
        return Err(EnrolError::NoPartInScan {
            num_frames: num_shots,
        });
    };
    let camera_from_base = first.base_from_camera.inverse().cast::<f32>();
    let in_part_space = PointCloud {
        points: part
            .cloud
            .points
            .iter()
            .map(|p| camera_from_base * p)
            .collect(),
        normals: part.cloud.normals.as_ref().map(|normals| {
            let turned = normals.iter().map(|n| camera_from_base * n);
            turned.collect()
        }),
        ..PointCloud::default()
    };
    let (cloud, voxel) = thinned(&in_part_space, params);
    let source = ReferenceOrigin {
        coverage: Coverage::SeveralSides,
        // What one frame's view cuts off is visible in another.
        cut: ViewCut::default(),
        one_layer: None,
        how: EnrolMethod::Scan,
        num_points,
        num_shots: Some(num_shots),
        voxel: Some(voxel),
    };
    let mut enrolled = assemble(cloud, &source, about, params)?;
    let percent = (100.0 * unseen_share(scan)).round() as u8;
    if percent >= WARNING_MIN_PERCENT {
        let warning = EnrolWarning::GoesOnUnseen { percent };
        enrolled.warnings.push(warning);
    }
    Ok(enrolled)
}

/// Smallest share worth a warning, per cent: shadows next to the part leave a few per cent of any outline unseen.
const WARNING_MIN_PERCENT: u8 = 10;
