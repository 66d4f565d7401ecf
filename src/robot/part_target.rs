//! An enrolled part as the target of a hand-eye calibration: what a shop without a checkerboard has.
//!
//! Its pose comes from the inspection of a capture. The target's origin is put into the middle of the part: the part's own
//! origin is where the camera was at its enrolment, over a metre away, where a tenth of a degree is two millimetres.

use nalgebra::Translation3;

use crate::{
    error::Advice,
    geometry::rigid::RigidTransform,
    library::Library,
    pipeline::{Inspection, Verdict},
};

/// The part that a capture shows, as a target.
#[derive(Clone, Debug, PartialEq)]
pub struct ObservedTarget {
    /// Its name.
    pub part: String,
    /// Which of the library's references it was found by: each has a frame of its own.
    pub reference: usize,
    /// The middle of the part before the camera, turned as the part is.
    pub camera_from_target: RigidTransform,
}

/// Why a capture shows no target.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoTarget {
    /// The inspection was not accepted, for this reason.
    #[error("not accepted: {reason}")]
    NotAccepted {
        /// Why.
        reason: String,
    },
    /// Accepted, but without a pose, or with one of several.
    #[error("its pose is not certain")]
    NoPose,
}

impl Advice for NoTarget {
    fn advice(&self) -> String {
        "Show the camera all of the part from nearly in front, and capture again".into()
    }
}

/// The part of an inspection as a target.
pub fn seen_part(inspection: &Inspection, library: &Library) -> Result<ObservedTarget, NoTarget> {
    let part = match &inspection.verdict {
        Verdict::Part {
            part,
            rejected: None,
            is_approximate: false,
            ..
        } => part,
        Verdict::Part {
            rejected: Some(why),
            ..
        } => {
            return Err(NoTarget::NotAccepted {
                reason: why.to_string(),
            });
        }
        Verdict::Part { .. } => return Err(NoTarget::NoPose),
        Verdict::NoPart(why) => {
            return Err(NoTarget::NotAccepted {
                reason: why.to_string(),
            });
        }
    };
    let pose = inspection.pose.as_ref().and_then(|pose| pose.as_ref().ok());
    let pose = pose.filter(|pose| !pose.is_ambiguous());
    let first = inspection.ranking.entries.first();
    let (pose, first) = pose.zip(first).ok_or(NoTarget::NoPose)?;
    let reference = library.references.get(first.reference);
    let bounds = reference.and_then(|reference| reference.cloud.bounds());
    let (low, high) = bounds.ok_or(NoTarget::NoPose)?;
    let middle = nalgebra::center(&low, &high).cast::<f64>();
    Ok(ObservedTarget {
        part: part.clone(),
        reference: first.reference,
        camera_from_target: pose.camera_from_part() * Translation3::from(middle.coords),
    })
}
