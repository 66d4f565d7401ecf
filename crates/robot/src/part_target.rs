//! An enrolled part as the target of a hand-eye calibration, for shops without a checkerboard.
//!
//! Its pose comes from the inspection of a capture. The target's origin is in the middle of the part: the part's own
//! origin is where the camera was at its enrolment, over a metre away, where a tenth of a degree moves it by two
//! millimetres.
//!
//! Its pose is refined once more, by the edges whose side is out of sight: the whole outline moves with the view, which
//! several captures together would take for an error of the depth.

use nalgebra::{Translation3, Unit, Vector3};

use geometry::{error::Advice, principal::principal_axes, rigid::RigidTransform};
use inspection::{
    library::Library,
    pipeline::{Inspection, Verdict},
};
use stages::{
    confirm::{ConfirmParams, Scene, by_hidden_sides},
    pose::OffScale,
    rack::Rack,
    rank::Query,
    scene::SceneCloud,
};

/// The part in a capture, as a target.
#[derive(Clone, Debug, PartialEq)]
pub struct ObservedTarget {
    /// Name of the part.
    pub part: String,
    /// Index of the library reference that was found; each reference has its own frame.
    pub reference: usize,
    /// From the target frame to the camera frame. Its origin is the middle of the reference, its axes are the part's.
    pub camera_from_target: RigidTransform,
    /// Mean normal of the part's surface, target frame; its sign is arbitrary.
    pub normal: Unit<Vector3<f64>>,
}

/// Why a capture shows no target.
#[derive(Clone, Debug, PartialEq, thiserror::Error, Advice)]
pub enum NoTarget {
    /// The inspection was not accepted.
    #[error("not accepted: {reason}")]
    #[advice(SHOW_PART)]
    NotAccepted {
        /// The reason given by the inspection.
        reason: String,
    },
    /// Accepted, but without a pose, or with an ambiguous or approximate one.
    #[error("its pose is not certain")]
    #[advice(SHOW_PART)]
    NoPose,
    /// It is larger or smaller than its reference, so the camera's numbers are wrong.
    #[error(transparent)]
    #[advice(transparent)]
    OffScale(OffScale),
}

const SHOW_PART: &str = "Show the camera all of the part from nearly in front, and capture again";

/// Returns the part of an accepted inspection of this scene as a target.
pub fn seen_part(
    inspection: &Inspection,
    scene: &SceneCloud,
    library: &Library,
) -> Result<ObservedTarget, NoTarget> {
    if let Some(why) = inspection.verdict.refusal() {
        let reason = why.to_string();
        return Err(NoTarget::NotAccepted { reason });
    }
    let Verdict::Part {
        part,
        is_approximate: false,
        ..
    } = &inspection.verdict
    else {
        return Err(NoTarget::NoPose);
    };
    let pose = inspection.found_pose();
    let pose = pose.filter(|pose| !pose.is_ambiguous());
    let first = inspection.ranking.entries.first();
    let (pose, first) = pose.zip(first).ok_or(NoTarget::NoPose)?;
    if let Some(off) = pose.off_scale() {
        return Err(NoTarget::OffScale(off));
    }
    let reference = library.references.get(first.reference);
    let reference = reference.ok_or(NoTarget::NoPose)?;
    let (low, high) = reference.cloud.bounds().ok_or(NoTarget::NoPose)?;
    let points = reference.cloud.points.iter().map(|p| (p.cast(), 1.0));
    let normal = principal_axes(points).ok_or(NoTarget::NoPose)?.axes;
    let middle = nalgebra::center(&low, &high).cast::<f64>();
    let part_from_camera = surface_of(inspection, scene)
        .and_then(|surface| {
            let seed = ConfirmParams::default().seed;
            by_hidden_sides(&surface, reference, &pose.target_from_source, seed)
        })
        .unwrap_or(pose.target_from_source);
    Ok(ObservedTarget {
        part: part.clone(),
        reference: first.reference,
        camera_from_target: part_from_camera.inverse() * Translation3::from(middle.coords),
        normal: Unit::new_normalize(normal.column(2).into_owned()),
    })
}

/// The surface that was recognised.
fn surface_of<'a>(inspection: &'a Inspection, scene: &'a SceneCloud) -> Option<Scene<'a>> {
    Some(Scene {
        scene,
        part: inspection.segmentation.part.as_ref().ok()?,
        query: Query {
            plane: inspection.plane.as_ref()?,
            contour: inspection.contour.as_ref()?,
            signature: inspection.signature.as_ref()?,
        },
        rack: Rack::ANYWHERE,
        expected: &[],
    })
}
