//! What a simulated robot is tried with: the cell is the same for a robot that is driven and for one that asks.

use std::{ops::RangeInclusive, time::Duration};

use super::{ServoRunError, reference_of};
use geometry::units::{Metres, Radians};
use inspection::library::Library;
use servo::simulated::{
    ArmDynamics, CellPart, CellSetup, Disturbance, HandEyeError, SimulatedCell, SimulatedTarget,
};
use simulate::PartKind;

/// What a simulated robot is tried with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimulatedTrial {
    /// Seed of the start, and of everything else that is drawn.
    pub seed: u64,
    /// How much later a frame counts than it was taken, at least.
    pub delay: Duration,
    /// How wrong the calibration is at most.
    pub hand_eye: HandEyeError,
    /// Play of each joint.
    pub play: Radians,
    /// Time between two reports of the arm.
    pub cycle: Duration,
}

/// Time between two frames of the simulated camera.
const FRAME_PERIOD: Duration = Duration::from_millis(100);

impl Default for SimulatedTrial {
    fn default() -> Self {
        Self {
            seed: 1,
            delay: Duration::ZERO,
            hand_eye: HandEyeError {
                shift: Metres(0.02),
                turn: Radians::from_degrees(2.0),
            },
            play: Radians(2.0 * ArmDynamics::default().backlash),
            cycle: ArmDynamics::default().period,
        }
    }
}

impl SimulatedTrial {
    /// Valid delays, ms.
    pub const DELAYS_MS: RangeInclusive<f64> = 0.0..=1000.0;
    /// Valid plays of a joint, degrees.
    pub const PLAYS_DEG: RangeInclusive<f64> = 0.0..=0.5;
    /// Valid times between two reports, ms: those of controllers.
    pub const CYCLES_MS: RangeInclusive<f64> = 2.0..=50.0;
    /// Valid errors of the calibration, mm.
    pub const SHIFTS_MM: RangeInclusive<f64> = 0.0..=100.0;
    /// Valid errors of the calibration, degrees.
    pub const TURNS_DEG: RangeInclusive<f64> = 0.0..=20.0;

    /// Arranges the cell around a part.
    pub fn arrange<'a>(
        &self,
        part: &str,
        library: &'a Library,
    ) -> Result<SimulatedCell<'a>, ServoRunError> {
        reference_of(library, part)?;
        let kind = kind_of(part)?;
        let setup = CellSetup {
            part: CellPart::Simulated(kind),
            target: SimulatedTarget::Standard,
            noise: 1.0,
            start: (Metres(0.25), Radians::from_degrees(25.0)),
            hand_eye: self.hand_eye,
            frame_period: FRAME_PERIOD,
            delay: self.delay,
            dynamics: ArmDynamics {
                period: self.cycle,
                backlash: 0.5 * self.play.0,
                ..ArmDynamics::default()
            },
            disturbance: Disturbance::None,
            seed: self.seed,
        };
        Ok(SimulatedCell::arrange(setup, library)?)
    }
}

/// The simulated part of this name.
pub(super) fn kind_of(part: &str) -> Result<PartKind, ServoRunError> {
    PartKind::from_name(part).ok_or_else(|| ServoRunError::NotSimulated {
        part: part.to_owned(),
    })
}
