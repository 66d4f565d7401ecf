//! Texts about visual servoing in the language of the window.

use crate::inspection::unit_system::UnitSystem;
use records::history::{ServoRun, ServoTargetKind};
use servo::ServoState;
use ui::{language::text, widgets::Mark};

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
