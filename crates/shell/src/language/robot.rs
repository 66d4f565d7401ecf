//! Texts about the poses of a robot and about visual servoing in the language of the window.

use crate::inspection::unit_system::UnitSystem;
use records::history::{ServoRun, ServoTargetKind};
use robot::Convention;
use servo::ServoState;
use station::robot_file::Unchecked;
use ui::{
    language::{Message, attribute, described, text},
    widgets::{Mark, sentence},
};

/// Describes order, axes and units of a convention's numbers.
pub fn convention_meaning(convention: Convention) -> String {
    attribute(&convention, "meaning")
}

/// Lists what was not checked; `None` if everything was.
pub fn not_checked(unchecked: &[Unchecked]) -> Option<String> {
    let words: Vec<String> = unchecked.iter().map(described).collect();
    let what = words.join("; ");
    let message = Message::new("not-checked").with("what", &*what);
    (!what.is_empty()).then(|| sentence(&described(&message)))
}

/// Names what a run was to reach.
pub fn target_title(target: ServoTargetKind) -> String {
    match target {
        ServoTargetKind::StandardPosition => text!("servoing-standard-position"),
        ServoTargetKind::CameraPose => text!("servoing-camera-pose"),
        ServoTargetKind::PathStart => text!("servoing-path-start"),
    }
}

/// Says what a run is doing.
pub fn state_title(state: ServoState) -> String {
    match state {
        ServoState::Looking => text!("servoing-looking"),
        ServoState::Moving => text!("servoing-moving"),
        ServoState::Waiting => text!("servoing-waiting"),
        ServoState::Holding => text!("servoing-holding"),
        ServoState::Checking => text!("servoing-checking"),
    }
}

/// Says how a run ended, with its mark.
pub fn end_title(run: &ServoRun) -> (Mark, String) {
    match &run.stopped {
        None if run.is_approximate => (Mark::Look, text!("servoing-arrived-approximately")),
        None => (Mark::Good, text!("servoing-arrived")),
        Some(_) => (Mark::Bad, text!("servoing-stopped")),
    }
}

/// Writes a shift and an angle; `None` if they are not known.
pub fn shift_and_turn(
    shift_m: Option<f64>,
    turn_rad: Option<f64>,
    units: UnitSystem,
) -> Option<String> {
    Some(format!(
        "{} · {}",
        units.length(shift_m?),
        units.angle(turn_rad?)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_not_checked_is_listed() {
        assert_eq!(not_checked(&[]), None);
        let both = [Unchecked::Arm, Unchecked::Accelerations("rail")];
        let expected = "Not checked: reach and collisions; acceleration of the rail";
        assert_eq!(not_checked(&both).as_deref(), Some(expected));
    }
}
