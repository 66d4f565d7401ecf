//! An enrolled part as the target of a hand-eye calibration, for shops without a checkerboard.
//!
//! Its pose comes from the inspection of a capture. The target's origin is in the middle of the part: the part's own
//! origin is where the camera was at its enrolment, over a metre away, where a tenth of a degree moves it by two
//! millimetres.

use nalgebra::Translation3;

use crate::{
    error::Advice,
    geometry::rigid::RigidTransform,
    library::Library,
    pipeline::{Inspection, Verdict},
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
}

/// Why a capture shows no target.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoTarget {
    /// The inspection was not accepted.
    #[error("not accepted: {reason}")]
    NotAccepted {
        /// The reason given by the inspection.
        reason: String,
    },
    /// Accepted, but without a pose, or with an ambiguous or approximate one.
    #[error("its pose is not certain")]
    NoPose,
}

impl Advice for NoTarget {
    fn advice(&self) -> String {
        "Show the camera all of the part from nearly in front, and capture again".into()
    }
}

/// Returns the part of an accepted inspection as a target.
pub fn seen_part(inspection: &Inspection, library: &Library) -> Result<ObservedTarget, NoTarget> {
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
