//! Parts of the simulated car, enrolled from simulated captures.

use geometry::rigid::RigidTransform;
use simulate::{CellSetup, PartKind, PartPose, Side, frame};
use stages::{reference::Reference, scene::scene_from_frame};

use super::{EnrolError, EnrolParams, Library, PartDescription, PartName, enrol_captured};

/// Returns the name under which a standard part is enrolled.
pub fn enrolled_name(kind: PartKind, side: Side) -> String {
    match side {
        Side::Right if kind.is_sided() => format!("{kind}_right"),
        Side::Left | Side::Right => kind.name().to_owned(),
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
        ..Library::default()
    })
}

/// Returns the pose of the standard parts at enrolment: frontal, 1.3 m in front of the camera.
pub fn enrolment_pose() -> RigidTransform {
    RigidTransform::translation(0.0, 0.0, 1.3)
}

/// Enrols a part of a car model from one capture; model 0 is the standard one.
pub fn enrol_part(
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

#[cfg(test)]
mod tests {
    use crate::fixtures::standard_library;

    #[test]
    fn no_simulated_part_looks_the_same_after_a_turn() {
        for reference in &standard_library().references {
            assert_eq!(reference.own_turn(), None, "{}", reference.name);
        }
    }
}
