//! The result of a check.

use std::io::{self, Write};

use jiff::Timestamp;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use geometry::units::{Metres, Radians};
use texts::{Described, Message};

/// The result of a check.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CellCheck {
    /// Time of the check.
    pub at: Timestamp,
    /// Time at which its baseline was taken.
    pub baseline: Timestamp,
    /// Number of frames that were compared.
    pub num_frames: usize,
    /// True if a frame or the baseline was simulated.
    pub is_simulated: bool,
    /// The conclusion.
    pub finding: CellFinding,
    /// Shift of the part's middle along x, y and z of the camera, metres.
    pub shift_m: [f64; 3],
    /// Angle by which the part turned, radians.
    pub turn_rad: f64,
    /// Largest shift of wall and floor where they are seen, metres; none if neither was found again.
    pub background_shift_m: Option<f64>,
    /// Root mean square distance of the part to the baseline, metres.
    pub rms_m: f64,
    /// The camera's noise at 1 m, divided by the baseline's.
    pub noise_ratio: f64,
}

/// The conclusion of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CellFinding {
    /// Nothing moved.
    InPlace,
    /// The part moved; wall and floor did not.
    PartMoved,
    /// Wall and floor moved: the camera moved, and perhaps the part as well.
    CameraMoved,
    /// The part moved; wall and floor do not show whether the camera moved.
    PartOrCameraMoved,
    /// Nothing moved, but the readings scatter more.
    Noisier,
}

impl CellCheck {
    /// Distance by which the part's middle moved.
    pub fn shift(&self) -> Metres {
        Metres(Vector3::from(self.shift_m).norm())
    }

    /// Angle by which the part turned.
    pub fn turn(&self) -> Radians {
        Radians(self.turn_rad)
    }
}

impl CellFinding {
    /// Returns true if part or camera moved.
    pub fn has_moved(self) -> bool {
        match self {
            Self::PartMoved | Self::CameraMoved | Self::PartOrCameraMoved => true,
            Self::InPlace | Self::Noisier => false,
        }
    }

    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::InPlace => "in_place",
            Self::PartMoved => "part_moved",
            Self::CameraMoved => "camera_moved",
            Self::PartOrCameraMoved => "part_or_camera_moved",
            Self::Noisier => "noisier",
        }
    }
}

impl Described for CellFinding {
    fn message(&self) -> Message {
        Message::new(format!("cell-{}", self.name().replace('_', "-")))
    }
}

texts::display!(CellFinding);

/// Writes checks as CSV: a line with the column names, then a line per check.
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
