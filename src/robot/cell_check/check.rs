//! What a check found.

use std::io::{self, Write};

use jiff::Timestamp;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use crate::{
    error::Advice,
    units::{Metres, Radians},
};

/// What a check found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CellCheck {
    /// When.
    pub at: Timestamp,
    /// When its baseline was taken.
    pub baseline: Timestamp,
    /// Frames that were compared.
    pub num_frames: usize,
    /// True if a frame or the baseline was simulated.
    pub is_simulated: bool,
    /// What it comes to.
    pub finding: CellFinding,
    /// How far the part's middle moved, along x, y and z of the camera, metres.
    pub shift_m: [f64; 3],
    /// By how much the part turned, radians.
    pub turn_rad: f64,
    /// How far wall and floor moved where they are seen, at most, metres; none if neither was found again.
    pub background_shift_m: Option<f64>,
    /// How well the part lies on the baseline, root mean square, metres.
    pub rms_m: f64,
    /// Noise of the camera at 1 m over that of the baseline.
    pub noise_ratio: f64,
}

/// What a check comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CellFinding {
    /// Everything is where it was.
    InPlace,
    /// The part is elsewhere; wall and floor are not.
    PartMoved,
    /// Wall and floor are elsewhere: the camera moved, and perhaps the part as well.
    CameraMoved,
    /// The part is elsewhere; wall and floor do not show whether the camera moved.
    PartOrCameraMoved,
    /// Nothing moved, but the readings scatter more.
    Noisier,
}

impl CellCheck {
    /// How far the part's middle moved.
    pub fn shift(&self) -> Metres {
        Metres(Vector3::from(self.shift_m).norm())
    }

    /// By how much the part turned.
    pub fn turn(&self) -> Radians {
        Radians(self.turn_rad)
    }
}

impl CellFinding {
    /// True if part or camera are elsewhere.
    pub fn has_moved(self) -> bool {
        match self {
            Self::PartMoved | Self::CameraMoved | Self::PartOrCameraMoved => true,
            Self::InPlace | Self::Noisier => false,
        }
    }

    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            Self::InPlace => "in_place",
            Self::PartMoved => "part_moved",
            Self::CameraMoved => "camera_moved",
            Self::PartOrCameraMoved => "part_or_camera_moved",
            Self::Noisier => "noisier",
        }
    }

    /// For people.
    pub fn describe(self) -> &'static str {
        match self {
            Self::InPlace => "camera and part are in place",
            Self::PartMoved => "the part moved; the camera did not",
            Self::CameraMoved => "the camera moved",
            Self::PartOrCameraMoved => "the part or the camera moved",
            Self::Noisier => "camera and part are in place, but the readings are noisier",
        }
    }
}

impl Advice for CellFinding {
    fn advice(&self) -> String {
        match self {
            Self::InPlace => "Nothing needs to be done",
            Self::PartMoved => {
                "Hang the part as it was, or check what holds it, and check again; if it is to stay, take a new baseline"
            }
            Self::CameraMoved => {
                "Fix the camera, calibrate it again, then take a new baseline"
            }
            Self::PartOrCameraMoved => {
                "Hang the part as it was and check again; if that does not help, the camera moved: calibrate it and take a new baseline"
            }
            Self::Noisier => {
                "Clean the camera's window, look for stray light or mist in front of it, and check again"
            }
        }
        .into()
    }
}

/// Writes checks as a table: a line for each, below one that names the columns.
pub fn write_csv(writer: &mut dyn Write, checks: &[CellCheck]) -> io::Result<()> {
    writeln!(
        writer,
        "at,finding,frames,simulated,shift_x_m,shift_y_m,shift_z_m,turn_rad,background_shift_m,rms_m,noise_ratio,baseline"
    )?;
    for check in checks {
        let [x, y, z] = check.shift_m;
        let background = check.background_shift_m.map(|shift| shift.to_string());
        writeln!(
            writer,
            "{},{},{},{},{x},{y},{z},{},{},{},{},{}",
            check.at,
            check.finding.name(),
            check.num_frames,
            check.is_simulated,
            check.turn_rad,
            background.unwrap_or_default(),
            check.rms_m,
            check.noise_ratio,
            check.baseline
        )?;
    }
    Ok(())
}
