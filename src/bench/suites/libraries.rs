//! The libraries that the suites are inspected against: simulated parts, each enrolled from one capture.

use super::{Suite, enrolled_name};
use crate::{
    geometry::rigid::RigidTransform,
    library::{EnrolError, EnrolParams, Library, PartDescription, PartName, enrol_captured},
    simulate::{CellSetup, PartKind, PartPose, Side, frame},
    stages::{reference::Reference, scene::scene_from_frame},
};

/// The libraries that the suites are inspected against: standard parts, each enrolled from one frontal capture.
#[derive(Clone, Debug)]
pub struct SuiteLibraries {
    /// The eight parts, the left one where there are two sides.
    pub left: Library,
    /// The same and their right-hand counterparts.
    pub both_sides: Library,
}

impl SuiteLibraries {
    /// Enrols the parts.
    pub fn enrol(params: &EnrolParams) -> Result<Self, EnrolError> {
        let left = enrol_standard_parts(params)?;
        let mut both_sides = left.clone();
        for kind in PartKind::ALL.into_iter().filter(|kind| kind.is_sided()) {
            let right = enrol_part(kind, Side::Right, 0, params)?;
            both_sides.references.push(right);
        }
        Ok(Self { left, both_sides })
    }

    /// Returns the library that a suite is inspected against.
    pub fn of(&self, suite: Suite) -> &Library {
        match suite {
            Suite::BothSides => &self.both_sides,
            _ => &self.left,
        }
    }
}

/// Enrols the eight parts of the standard car, left where there are sides, each from one frontal capture.
pub fn enrol_standard_parts(params: &EnrolParams) -> Result<Library, EnrolError> {
    let enrol = |kind| enrol_part(kind, Side::Left, 0, params);
    Ok(Library {
        references: PartKind::ALL
            .into_iter()
            .map(enrol)
            .collect::<Result<_, _>>()?,
    })
}

/// Returns the pose of the standard parts at enrolment: frontal, 1.3 m in front of the camera.
pub fn enrolment_pose() -> RigidTransform {
    RigidTransform::translation(0.0, 0.0, 1.3)
}

/// Enrols a part of a car model from one capture; model 0 is the standard one.
pub(in crate::bench) fn enrol_part(
    kind: PartKind,
    side: Side,
    model_seed: u64,
    params: &EnrolParams,
) -> Result<Reference, EnrolError> {
    let mut setup = CellSetup::with_part(kind, side, model_seed, 1);
    setup.pose = PartPose::Fixed(enrolment_pose());
    let shot = frame(&setup);
    let about = PartDescription {
        name: PartName::new(&enrolled_name(kind, side)).expect("our own names are valid"),
        title: kind.title().to_owned(),
        notes: String::new(),
        from: "simulated cell".to_owned(),
        at: jiff::Timestamp::UNIX_EPOCH,
        simulated: true,
    };
    let enrolled = enrol_captured(&scene_from_frame(&shot.frame), &about, params)?;
    enrolled.reference.prefetch();
    Ok(enrolled.reference)
}
