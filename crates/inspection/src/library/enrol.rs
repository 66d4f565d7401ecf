//! Enrolling: makes a part from a captured scene, a whole cloud or a mesh.
//!
//! The cloud is thinned to one point per voxel, which evens it out, averages the sensor's noise and keeps the file
//! small; normals are estimated on the thinned cloud. Part space is the input's coordinates.

mod cloud;
mod kept;
mod mesh;
mod own_pose;
mod problem;
mod scan;

use jiff::Timestamp;
use nalgebra::{Point3, Vector3};

use self::{
    cloud::{
        face_one_way, finite_only, is_one_capture, normals_towards, spacing, thinned,
        without_isolated,
    },
    kept::{share_apart, share_on_background},
    mesh::{MeshSurface, with_shown_sides},
    own_pose::pose_warning,
};
pub use self::{
    problem::{EnrolError, EnrolFinding, EnrolWarning},
    scan::enrol_scan,
};
use super::{
    name::PartName,
    part::{
        EnrolMethod, Enrolment, FileCheck, PLAIN_VERSION, Part, PartMeta, SCANNED_VERSION,
        StoredSignature,
    },
    side::outer_side,
    thumbnail,
};
use geometry::{cloud::PointCloud, mesh::TriangleMesh, units::Metres};
use stages::{
    reference::{Coverage, Reference, ReferenceError, ReferenceParams, ViewCut},
    scene::SceneCloud,
    segment::{NoPart, SegmentParams, SegmentedPart, other_segments, segment},
};

/// Parameters of enrolling.
#[derive(Clone, Debug, PartialEq)]
pub struct EnrolParams {
    /// Edge of the voxels for thinning the cloud, 2..20 mm. Larger voxels blur the part, smaller ones make files large
    /// and inspections slow.
    pub voxel: Metres,
    /// Maximum number of points; the voxels grow until it holds. Also the number sampled from a mesh.
    pub max_points: usize,
    /// Parameters for segmenting a captured scene.
    pub segment: SegmentParams,
    /// Parameters of the stages that make the signature; the same are used on scenes.
    pub reference: ReferenceParams,
}

impl Default for EnrolParams {
    fn default() -> Self {
        Self {
            voxel: Metres::from_mm(8.0),
            max_points: 16_000,
            segment: SegmentParams::default(),
            reference: ReferenceParams::default(),
        }
    }
}

/// Description of a part by the person who enrols it.
#[derive(Clone, Debug, PartialEq)]
pub struct PartDescription {
    /// Name of the part.
    pub name: PartName,
    /// Title for people; may be empty.
    pub title: String,
    /// Notes; may be empty.
    pub notes: String,
    /// Name of the file or source that it is enrolled from.
    pub from: String,
    /// Time of enrolment.
    pub at: Timestamp,
    /// True if the data do not come from a real camera.
    pub simulated: bool,
}

/// A part ready to be saved.
#[derive(Clone, Debug)]
pub struct Enrolled {
    /// The part.
    pub part: Part,
    /// The part as a reference, prepared for ranking and pose.
    pub reference: Reference,
    /// The part in the captured scene that it was cut out of; `None` if it was not cut out of one.
    pub seen: Option<SegmentedPart>,
    /// What a mesh was found to be.
    pub findings: Vec<EnrolFinding>,
    /// Warnings about the part.
    pub warnings: Vec<EnrolWarning>,
}

/// Minimum number of points of a cloud: fewer show no shape.
const MIN_POINTS: usize = 100;

/// Enrols the part found in a captured scene: from one side, in the camera frame. Refuses what looks like background.
pub fn enrol_captured(
    scene: &SceneCloud,
    about: &PartDescription,
    params: &EnrolParams,
) -> Result<Enrolled, EnrolError> {
    let found = segment(scene, &params.segment).part?;
    if let Some(sign) = found.background_sign() {
        return Err(EnrolError::Background(sign));
    }
    enrol_one_side(&found, scene, about, params)
}

/// Maximum number of surfaces offered for choice.
const MAX_SURFACES: usize = 8;

/// Returns the surfaces of a captured scene that may be the part, most likely first.
pub fn surfaces_to_enrol(
    scene: &SceneCloud,
    params: &EnrolParams,
) -> Result<Vec<SegmentedPart>, NoPart> {
    let found = segment(scene, &params.segment);
    let others = other_segments(scene, &found, &params.segment, MAX_SURFACES - 1);
    Ok(std::iter::once(found.part?).chain(others).collect())
}

/// Enrols one of [`surfaces_to_enrol`], by its number from 1.
pub fn enrol_surface(
    scene: &SceneCloud,
    number: usize,
    about: &PartDescription,
    params: &EnrolParams,
) -> Result<Enrolled, EnrolError> {
    let all = surfaces_to_enrol(scene, params)?;
    let chosen = number.checked_sub(1).and_then(|index| all.get(index));
    let chosen = chosen.ok_or(EnrolError::NoSuchSurface {
        wanted: number,
        found: all.len(),
    })?;
    enrol_chosen(chosen, scene, about, params)
}

/// Enrols a surface chosen by a person: signs of background are only warnings.
fn enrol_chosen(
    found: &SegmentedPart,
    scene: &SceneCloud,
    about: &PartDescription,
    params: &EnrolParams,
) -> Result<Enrolled, EnrolError> {
    let mut enrolled = enrol_one_side(found, scene, about, params)?;
    let sign = found.background_sign();
    enrolled.warnings.extend(sign.map(EnrolWarning::Background));
    Ok(enrolled)
}

/// Enrols the points of a captured scene that a person selected, by their indices.
pub fn enrol_selected(
    scene: &SceneCloud,
    indices: &[u32],
    about: &PartDescription,
    params: &EnrolParams,
) -> Result<Enrolled, EnrolError> {
    let found = SegmentedPart::selected(scene, indices, &params.segment);
    let num_points = found.cloud.points.len();
    if num_points < MIN_POINTS {
        return Err(EnrolError::TooFewKept {
            found: num_points,
            needed: MIN_POINTS,
        });
    }
    let mut enrolled = enrol_chosen(&found, scene, about, params)?;
    let warnings = &mut enrolled.warnings;
    let in_percent = |share: f64| (share * 100.0).round() as u8;
    let percent = in_percent(share_on_background(scene, &found.indices, &params.segment));
    if percent > 0 {
        warnings.push(EnrolWarning::OnBackground { percent });
    }
    let percent = in_percent(share_apart(&found.cloud.points));
    if percent > 0 {
        warnings.push(EnrolWarning::Apart { percent });
    }
    Ok(enrolled)
}

/// Enrols a surface found in a scene, as seen by a camera at the origin.
fn enrol_one_side(
    found: &SegmentedPart,
    scene: &SceneCloud,
    about: &PartDescription,
    params: &EnrolParams,
) -> Result<Enrolled, EnrolError> {
    let (mut cloud, voxel) = thinned(&found.cloud, params);
    cloud.normals = Some(normals_towards(&cloud, voxel, &Point3::origin()));
    let source = ReferenceOrigin {
        coverage: Coverage::OneSide,
        how: EnrolMethod::Segmented,
        num_points: found.cloud.points.len(),
        num_shots: None,
        voxel: Some(voxel),
        cut: ViewCut::of(found, scene),
        one_layer: None,
    };
    let mut enrolled = assemble(cloud, &source, about, params)?;
    enrolled.seen = Some(found.clone());
    if found.touches_edge {
        enrolled.warnings.push(EnrolWarning::TouchesEdge);
    }
    Ok(enrolled)
}

/// Enrols all points of a cloud.
///
/// A few isolated points are dropped. A cloud that lies in front of the camera, with normals (if any) that face it, counts
/// as one capture. Of any other, missing normals are estimated, and turned to where a camera could see the point from; where it could
/// from both sides, it gets both. If the normals face one way, it counts as seen from several sides, else from all
/// around.
pub fn enrol_whole(
    cloud: &PointCloud,
    about: &PartDescription,
    params: &EnrolParams,
) -> Result<Enrolled, EnrolError> {
    let finite = finite_only(cloud);
    let num_points = finite.points.len();
    if num_points < MIN_POINTS {
        return Err(EnrolError::TooFewPoints {
            found: num_points,
            needed: MIN_POINTS,
        });
    }
    let is_one_capture = is_one_capture(&finite);
    let (thin, voxel) = thinned(&finite, params);
    let mut thin = without_isolated(thin, voxel);
    if thin.normals.is_none() {
        let normals = normals_towards(&thin, voxel, &Point3::origin());
        thin = if is_one_capture {
            PointCloud {
                normals: Some(normals),
                ..thin
            }
        } else {
            with_shown_sides(&thin, normals, Metres(voxel.0.max(spacing(&thin.points))))
        };
    }
    let coverage = if is_one_capture {
        Coverage::OneSide
    } else if thin.normals.as_deref().is_some_and(face_one_way) {
        Coverage::SeveralSides
    } else {
        Coverage::AllAround
    };
    let source = ReferenceOrigin {
        coverage,
        how: EnrolMethod::WholeCloud,
        num_points,
        num_shots: None,
        voxel: Some(voxel),
        cut: ViewCut::default(),
        one_layer: None,
    };
    assemble(thin, &source, about, params)
}

/// Enrols a mesh: what cameras can see of it from all around, whichever way its triangles are wound.
pub fn enrol_mesh(
    mesh: &TriangleMesh,
    about: &PartDescription,
    params: &EnrolParams,
) -> Result<Enrolled, EnrolError> {
    let surface = MeshSurface::of(mesh, params.max_points).ok_or(EnrolError::NoArea {
        num_triangles: mesh.triangles.len(),
    })?;
    let source = ReferenceOrigin {
        coverage: Coverage::AllAround,
        how: EnrolMethod::Mesh,
        num_points: surface.cloud.points.len(),
        num_shots: None,
        voxel: None,
        cut: ViewCut::default(),
        one_layer: Some(surface.one_layer),
    };
    let mut enrolled = assemble(surface.cloud, &source, about, params)?;
    enrolled.findings = surface.findings;
    Ok(enrolled)
}

/// Facts about the origin of a reference's cloud.
struct ReferenceOrigin {
    coverage: Coverage,
    how: EnrolMethod,
    num_points: usize,
    num_shots: Option<usize>,
    voxel: Option<Metres>,
    cut: ViewCut,
    /// The surface once, where the cloud has both sides of it.
    one_layer: Option<PointCloud>,
}

fn assemble(
    mut cloud: PointCloud,
    source: &ReferenceOrigin,
    about: &PartDescription,
    params: &EnrolParams,
) -> Result<Enrolled, EnrolError> {
    // Colours are unused, so the library does not store them.
    cloud.colours = None;
    let reference = Reference::prepare(
        about.name.as_str(),
        cloud.clone(),
        source.coverage,
        &params.reference,
    )?
    .with_cut(source.cut);
    let signature =
        StoredSignature::of(&reference, &params.reference).ok_or(ReferenceError::NoOutline {
            num_points: reference.cloud.points.len(),
        })?;
    let mut warnings: Vec<EnrolWarning> = pose_warning(&reference, source.coverage)
        .into_iter()
        .collect();
    let mut side = None;
    if source.coverage == Coverage::AllAround {
        let PointCloud {
            points, normals, ..
        } = source.one_layer.as_ref().unwrap_or(&cloud);
        let points: Vec<Point3<f64>> = points.iter().map(|p| p.cast()).collect();
        let normals: Vec<Vector3<f64>> = normals.iter().flatten().map(|n| n.cast()).collect();
        match outer_side(&points, &normals) {
            Ok(outer) => side = Some(outer),
            Err(sides) => warnings.push(EnrolWarning::SideUnclear { sides }),
        }
    }
    let part = Part {
        meta: PartMeta {
            schema_version: match source.coverage {
                Coverage::SeveralSides => SCANNED_VERSION,
                Coverage::OneSide | Coverage::AllAround => PLAIN_VERSION,
            },
            name: about.name.clone(),
            part: None,
            title: about.title.clone(),
            notes: about.notes.clone(),
            coverage: source.coverage,
            simulated: about.simulated,
            cloud: FileCheck::of_cloud(&cloud),
            cut: source.cut,
            enrolled: Enrolment {
                at: about.at,
                from: about.from.clone(),
                how: source.how,
                num_points: source.num_points,
                num_shots: source.num_shots,
                voxel_mm: source.voxel.map(|v| (v.mm() * 100.0).round() / 100.0),
                size_mm: reference.size().map(|side| side.map(|s| s.mm().round())),
            },
            side,
            spray: None,
            surface: None,
        },
        thumbnail: thumbnail::render(&reference, source.coverage),
        signature,
        cloud,
    };
    Ok(Enrolled {
        part,
        findings: Vec::new(),
        warnings,
        reference,
        seen: None,
    })
}

#[cfg(test)]
mod tests;
