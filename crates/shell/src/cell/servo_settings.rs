//! What the window servos: the part, its target, the robot, and limits. Arm, nozzle and obstacles are those of
//! [`ProgramSetup`](super::program_setup::ProgramSetup).

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use geometry::{oriented_box::OrientedBox, units::Metres};
use records::history::ServoTargetKind;
use servo::{ServoError, ServoParams, simulated::StreamProtocol};

/// Settings for visual servoing; kept with the settings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ServoSettings {
    /// Name of the part; `None`: the first of the library.
    pub part: Option<String>,
    /// What is to be reached; a simulated robot is always brought to the standard position.
    pub target: ServoTargetKind,
    /// Frames of the part, taken where the camera should stand, for a recorded camera pose.
    pub seen_as: Vec<PathBuf>,
    /// Protocol of the robot; `None`: a simulated one.
    pub robot: Option<StreamProtocol>,
    /// Its address, as typed: `IP:PORT` of this computer, or `IP` of Universal Robots.
    pub address: String,
    /// Greatest speed, mm/s.
    pub speed: f64,
    /// Greatest error at the end with its bounds, mm.
    pub tolerance: f64,
    /// Least distance from part and obstacles, mm.
    pub clearance: f64,
    /// Box of the base frame that flange, camera and nozzle never leave.
    pub volume: Option<OrientedBox>,
    /// True if each step waits until it is allowed.
    pub in_steps: bool,
}

impl Default for ServoSettings {
    fn default() -> Self {
        let params = ServoParams::default();
        Self {
            part: None,
            target: ServoTargetKind::StandardPosition,
            seen_as: Vec::new(),
            robot: None,
            address: String::new(),
            speed: 1000.0 * params.limits.speed,
            tolerance: params.tolerance.shift.mm(),
            clearance: params.clearance.mm(),
            volume: None,
            in_steps: false,
        }
    }
}

impl ServoSettings {
    /// The parameters with these limits.
    pub fn params(&self) -> Result<ServoParams, ServoError> {
        let [tolerance, clearance] = [self.tolerance, self.clearance].map(Metres::from_mm);
        ServoParams::limited(self.speed, tolerance, clearance)
    }

    /// Replaces each number out of its range, as a file may contain, by its default; returns the keys of the replaced ones.
    pub(crate) fn replace_unusable(&mut self) -> Vec<&'static str> {
        let default = Self::default();
        let mut replaced = Vec::new();
        for (key, value, range, usual) in [
            (
                "speed",
                &mut self.speed,
                ServoParams::SPEEDS_MM_S,
                default.speed,
            ),
            (
                "tolerance",
                &mut self.tolerance,
                ServoParams::TOLERANCES_MM,
                default.tolerance,
            ),
            (
                "clearance",
                &mut self.clearance,
                ServoParams::CLEARANCES_MM,
                default.clearance,
            ),
        ] {
            if !range.contains(&*value) {
                *value = usual;
                replaced.push(key);
            }
        }
        if self.volume.is_some_and(|volume| !volume.is_sound()) {
            self.volume = None;
            replaced.push("volume");
        }
        replaced
    }
}
