//! A calibration as a text file that a person can read and correct.

use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
};

use jiff::Timestamp;
use serde::Deserialize;

use super::{CalibrationError, CameraPlace, CellCalibration, Origin, numbers_text};
use crate::{MAX_POSE_DISTANCE_M, hand_eye::Mount};
use files::{
    FileError, crc32, disk, folder_of, parse_toml, read_text, toml_problem, user_data, write_text,
};
use geometry::{
    rigid::{from_row_major, row_major},
    units::Metres,
};

/// Version of the file that this program writes. It reads this one and older ones.
pub const SCHEMA_VERSION: u32 = 1;

/// Largest file that is read, bytes.
const MAX_BYTES: u64 = 1 << 20;

/// Tolerance for a rotation: people enter numbers with four digits.
const ROTATION_TOLERANCE: f64 = 1e-3;

/// A calibration read from a file, to be shown.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadCalibration {
    /// The calibration.
    pub calibration: CellCalibration,
    /// True if the file's numbers are not those that the program wrote. They are not used until a person confirms them: a
    /// changed digit moves every pose that a robot gets.
    pub is_edited: bool,
}

/// Content of the file.
#[derive(Debug, Deserialize)]
struct Text {
    #[serde(rename = "schema_version")]
    _schema_version: u32,
    #[serde(default)]
    name: String,
    #[serde(default)]
    notes: String,
    mount: Mount,
    made_at: Timestamp,
    #[serde(default)]
    checksum: Option<String>,
    robot_from_camera: Option<Matrix>,
    flange_from_camera: Option<Matrix>,
    /// At every capture.
    robot_from_flange: Option<Matrix>,
    origin: Origin,
}

type Matrix = [[f64; 4]; 4];

/// Tolerance for numbers read back, relative above 1: a nanometre in a metre.
const READ_BACK_TOLERANCE: f64 = 1e-9;

const HEAD: &str = "\
# Partsight: where the camera of a robot cell sits.
#
# b_from_a takes a point of frame a to frame b. Frames: camera (x right, y down, z forward), robot (the base of the
# robot), flange (as the robot's controller shows it without a tool). Each is a 4x4 matrix, row after row: a rotation
# without unit, and in the last column the shift in metres.
";

impl CellCalibration {
    /// Reads a calibration file to be used. Refuses edited numbers that were not confirmed.
    pub fn load(path: &Path) -> Result<Self, CalibrationError> {
        let read = Self::read(path)?;
        if read.is_edited {
            return Err(CalibrationError::Edited {
                path: path.to_owned(),
            });
        }
        Ok(read.calibration)
    }

    /// Reads a calibration file to be shown, edited or not.
    pub fn read(path: &Path) -> Result<ReadCalibration, CalibrationError> {
        let text = read_text(path, MAX_BYTES)?;
        parse(&text, path)
    }

    /// Confirms the edited numbers of a calibration file, which then count as entered by hand: writes their checksum, and
    /// copies the former file beside it. Returns the path of the copy; `None` if there was nothing to confirm.
    pub fn confirm(path: &Path) -> Result<Option<PathBuf>, CalibrationError> {
        let read = Self::read(path)?;
        if !read.is_edited {
            return Ok(None);
        }
        read.calibration.save_keeping_former(path)
    }

    /// As [`Self::load`]; `None` if the file does not exist.
    pub fn load_if_there(path: &Path) -> Result<Option<Self>, CalibrationError> {
        match Self::load(path) {
            Err(CalibrationError::File(FileError::NotFound { .. })) => Ok(None),
            loaded => loaded.map(Some),
        }
    }

    /// Writes a calibration, whole or not at all. Creates the folder if it is missing.
    pub fn save(&self, path: &Path) -> Result<(), CalibrationError> {
        disk::create_dir_all(folder_of(path)).map_err(|source| FileError::writing(path, source))?;
        let text = self.checked_text(path)?;
        write_text(path, &text)?;
        Ok(())
    }

    /// Returns the file's text after reading it back: numbers that would change are not written.
    fn checked_text(&self, path: &Path) -> Result<String, CalibrationError> {
        let text = self.to_text();
        let again = parse(&text, path)?.calibration;
        let numbers = |calibration: &Self| {
            let matrices = calibration.matrices().into_iter();
            matrices.flat_map(|(_, matrix)| row_major(matrix)).collect()
        };
        let (meant, read): (Vec<f64>, Vec<f64>) = (numbers(self), numbers(&again));
        let is_same =
            |(a, b): (&f64, &f64)| (a - b).abs() <= READ_BACK_TOLERANCE * a.abs().max(1.0);
        if meant.len() == read.len() && meant.iter().zip(&read).all(is_same) {
            Ok(text)
        } else {
            Err(CalibrationError::NotKept {
                path: path.to_owned(),
            })
        }
    }

    /// As [`Self::save`], but first copies a different file at that path beside it, and returns the path of the copy.
    pub fn save_keeping_former(&self, path: &Path) -> Result<Option<PathBuf>, CalibrationError> {
        self.checked_text(path)?;
        let former = match read_text(path, MAX_BYTES) {
            Ok(text) if text != self.to_text() => Some(text),
            Ok(_) | Err(FileError::NotFound { .. }) => None,
            Err(error) => return Err(error.into()),
        };
        let kept = former.map(|text| {
            let kept = path.with_extension("former.toml");
            write_text(&kept, &text)?;
            Ok::<_, FileError>(kept)
        });
        let kept = kept.transpose()?;
        self.save(path)?;
        Ok(kept)
    }

    /// The content of the file.
    pub fn to_text(&self) -> String {
        let quoted = |text: &str| toml::Value::from(text).to_string();
        let mount = match self.camera.mount() {
            Mount::EyeToHand => "eye_to_hand",
            Mount::EyeInHand => "eye_in_hand",
        };
        let mut text = format!(
            "{HEAD}\nschema_version = {SCHEMA_VERSION}\nname = {}\nnotes = {}\nmade_at = {}\n\n# {}\nmount = {}\n",
            quoted(&self.name),
            quoted(&self.notes),
            quoted(&self.made_at.to_string()),
            self.camera.mount().describe(),
            quoted(mount),
        );
        let mut checked = String::new();
        for (name, transform) in self.matrices() {
            let numbers = row_major(transform);
            // Writing to memory does not fail.
            let _ = writeln!(text, "{name} = [");
            for row in numbers.chunks(4) {
                let row: Vec<String> = row.iter().map(|x| written(*x)).collect();
                let _ = writeln!(text, "  [{}],", row.join(", "));
            }
            text += "]\n";
            checked += &numbers_text(name, &numbers, DECIMALS);
        }
        let _ = write!(
            text,
            "# Of the numbers above. After editing them, confirm them: partsight calibrate confirm\nchecksum = {}\n\n[origin]\n{}",
            quoted(&format!("{:08x}", crc32(checked.as_bytes()))),
            toml::to_string(&self.origin).expect("numbers and text have a TOML form")
        );
        text
    }
}

/// Decimals: a picometre, so that reading back changes nothing noticeable.
const DECIMALS: usize = 12;

/// Writes a number of a matrix; adding 0 turns -0 into 0.
fn written(number: f64) -> String {
    let rounded = (number * 1e12).round() / 1e12 + 0.0;
    format!("{rounded:15.DECIMALS$}")
}

fn parse(text: &str, path: &Path) -> Result<ReadCalibration, CalibrationError> {
    let bad = |found: String| CalibrationError::Bad {
        path: path.to_owned(),
        found,
    };
    let no_toml = |error: toml::de::Error| bad(toml_problem(text, &error));
    let read: Text = parse_toml(path, text, SCHEMA_VERSION, no_toml)?;
    let numbers_of = |rows: &Matrix| -> [f64; 16] { std::array::from_fn(|i| rows[i / 4][i % 4]) };
    let rigid = |key: &'static str, rows: &Matrix| {
        let numbers = numbers_of(rows);
        let transform = from_row_major(&numbers, ROTATION_TOLERANCE).ok_or_else(|| {
            CalibrationError::NotRigid {
                path: path.to_owned(),
                key,
            }
        })?;
        let distance = Metres(transform.translation.vector.norm());
        if distance.0 > MAX_POSE_DISTANCE_M {
            return Err(CalibrationError::TooFar {
                path: path.to_owned(),
                key,
                distance,
            });
        }
        Ok(transform)
    };
    let needed = |key: &'static str, rows: &Option<Matrix>| match rows {
        Some(rows) => rigid(key, rows),
        None => Err(bad(format!("{key} is missing"))),
    };
    let camera = match read.mount {
        Mount::EyeToHand => CameraPlace::Fixed {
            robot_from_camera: needed("robot_from_camera", &read.robot_from_camera)?,
        },
        Mount::EyeInHand => CameraPlace::OnFlange {
            flange_from_camera: needed("flange_from_camera", &read.flange_from_camera)?,
            capture_pose: (read.robot_from_flange.as_ref())
                .map(|rows| rigid("robot_from_flange", rows))
                .transpose()?,
        },
    };
    let mut calibration = CellCalibration {
        name: read.name,
        notes: read.notes,
        camera,
        origin: read.origin,
        made_at: read.made_at,
    };
    let checked: String = [
        ("robot_from_camera", &read.robot_from_camera),
        ("flange_from_camera", &read.flange_from_camera),
        ("robot_from_flange", &read.robot_from_flange),
    ]
    .into_iter()
    .filter_map(|(name, rows)| Some(numbers_text(name, &numbers_of(rows.as_ref()?), DECIMALS)))
    .collect();
    let is_calculated = matches!(calibration.origin, Origin::HandEye(_));
    let is_edited = match &read.checksum {
        Some(written) => *written != format!("{:08x}", crc32(checked.as_bytes())),
        None => is_calculated,
    };
    if is_edited {
        // The residuals belong to other numbers.
        calibration.origin = Origin::ByHand;
    }
    Ok(ReadCalibration {
        calibration,
        is_edited,
    })
}

/// The path of the cell's calibration if none is named: `cell.toml` in the folder for user data.
pub fn default_path() -> Result<PathBuf, CalibrationError> {
    let folder = user_data()?;
    Ok(folder.join("cell.toml"))
}
