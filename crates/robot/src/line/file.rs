//! A calibrated line as a text file.

use std::path::{Path, PathBuf};

use jiff::Timestamp;
use nalgebra::{Unit, Vector3};
use serde::{Deserialize, Serialize};

use super::{Counter, LineCalibration, delay::MAX_DELAY_S};
use files::{FileError, crc32, parse_toml, read_text, toml_problem, write_text};
use geometry::{
    error::Advice,
    units::{Metres, Radians},
};

/// Version of the file that this program writes. It reads this one and older ones.
const SCHEMA_VERSION: u32 = 1;
/// Largest file that is read, bytes.
const MAX_BYTES: u64 = 1 << 20;

const HEAD: &str = "\
# Partsight: how a line moves past the camera, and how its encoder counts. Written by partsight calibrate line.
#
# slip_percent: greatest share of the way that the encoder loses or gains. exposure_ms: time in which the camera exposes a
# frame; if you do not know it, one frame period. delay_ms: time from the exposure of a frame to its arrival; delay_bound_ms: by
# how much it may differ. These four may be edited; for all others, calibrate again.
";

/// Content of the file.
#[derive(Debug, Serialize, Deserialize)]
struct Text {
    schema_version: u32,
    made_at: Timestamp,
    part: String,
    num_poses: usize,
    way_mm: f64,
    residual_mm: f64,
    #[serde(flatten)]
    numbers: Numbers,
    checksum: String,
    slip_percent: f64,
    exposure_ms: f64,
    #[serde(default)]
    delay_ms: f64,
    #[serde(default)]
    delay_bound_ms: f64,
}

/// The numbers by which poses are carried.
#[derive(Debug, Serialize, Deserialize)]
struct Numbers {
    /// While the count rises, camera space.
    direction: [f64; 3],
    direction_bound_degrees: f64,
    mm_per_count: f64,
    scale_bound_percent: f64,
    counter_bits: u32,
}

impl Numbers {
    fn checksum(&self) -> String {
        let text = toml::to_string(self).expect("numbers have a TOML form");
        format!("{:08x}", crc32(text.as_bytes()))
    }
}

/// Why the file of a line cannot be read or written.
#[derive(Debug, thiserror::Error, Advice)]
pub enum LineFileError {
    /// The file cannot be read or written.
    #[error(transparent)]
    #[advice(match _0 {
        FileError::NotFound { .. } => "Check the path, or calibrate the line: partsight calibrate line".into(),
        FileError::Newer { .. } => "Update Partsight, or calibrate the line again with this version".into(),
        other => other.advice(),
    })]
    File(#[from] FileError),
    /// The file has unexpected content.
    #[error("{}: not the file of a line: {found}", path.display())]
    #[advice = "Correct slip_percent, exposure_ms, delay_ms or delay_bound_ms in a text editor, or calibrate the line again: partsight calibrate line"]
    Bad {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        found: String,
    },
    /// The numbers are not those that the program wrote.
    #[error("{}: the numbers were changed after the calibration: its checksum does not match", path.display())]
    #[advice = "Calibrate the line again: partsight calibrate line. Only slip_percent, exposure_ms, delay_ms and delay_bound_ms may be edited"]
    Edited {
        /// The file.
        path: PathBuf,
    },
}

impl LineCalibration {
    /// Reads the file of a line.
    pub fn load(path: &Path) -> Result<Self, LineFileError> {
        let text = read_text(path, MAX_BYTES)?;
        let bad = |found: String| LineFileError::Bad {
            path: path.to_owned(),
            found,
        };
        let no_toml = |error: toml::de::Error| bad(toml_problem(&text, &error));
        let read: Text = parse_toml(path, &text, SCHEMA_VERSION, no_toml)?;
        let numbers = &read.numbers;
        if numbers.checksum() != read.checksum {
            return Err(LineFileError::Edited {
                path: path.to_owned(),
            });
        }
        let within = |name: &str, value: f64, low: f64, high: f64| {
            if (low..=high).contains(&value) {
                Ok(value)
            } else {
                Err(bad(format!("{name} is {value}, expected {low} to {high}")))
            }
        };
        let direction = Unit::try_new(Vector3::from(numbers.direction), 0.5)
            .ok_or_else(|| bad("direction has no length".into()))?;
        let counter = Counter::of_bits(numbers.counter_bits)
            .ok_or_else(|| bad("counter_bits is neither 16 nor 32".into()))?;
        let per_count = within("mm_per_count", numbers.mm_per_count, 1e-6, 1000.0)?;
        let scale_bound = within(
            "scale_bound_percent",
            numbers.scale_bound_percent,
            0.0,
            50.0,
        )?;
        let turn = within(
            "direction_bound_degrees",
            numbers.direction_bound_degrees,
            0.0,
            45.0,
        )?;
        let most_delay = 1000.0 * MAX_DELAY_S;
        Ok(Self {
            direction,
            direction_bound: Radians::from_degrees(turn),
            way_per_count: Metres::from_mm(per_count),
            scale_bound: scale_bound / 100.0,
            counter,
            residual: Metres::from_mm(read.residual_mm),
            num_poses: read.num_poses,
            way: Metres::from_mm(read.way_mm),
            part: read.part,
            made_at: read.made_at,
            slip: within("slip_percent", read.slip_percent, 0.0, 10.0)? / 100.0,
            exposure: within("exposure_ms", read.exposure_ms, 0.0, 1000.0)? / 1000.0,
            delay: within("delay_ms", read.delay_ms, 0.0, most_delay)? / 1000.0,
            delay_bound: within("delay_bound_ms", read.delay_bound_ms, 0.0, most_delay)? / 1000.0,
        })
    }

    /// Writes the file, whole or not at all.
    pub fn save(&self, path: &Path) -> Result<(), LineFileError> {
        let numbers = Numbers {
            direction: self.direction.into_inner().into(),
            direction_bound_degrees: self.direction_bound.degrees(),
            mm_per_count: self.way_per_count.mm(),
            scale_bound_percent: 100.0 * self.scale_bound,
            counter_bits: self.counter.bits(),
        };
        let text = Text {
            schema_version: SCHEMA_VERSION,
            made_at: self.made_at,
            part: self.part.clone(),
            num_poses: self.num_poses,
            way_mm: self.way.mm(),
            residual_mm: self.residual.mm(),
            checksum: numbers.checksum(),
            numbers,
            slip_percent: 100.0 * self.slip,
            exposure_ms: 1000.0 * self.exposure,
            delay_ms: 1000.0 * self.delay,
            delay_bound_ms: 1000.0 * self.delay_bound,
        };
        let text = toml::to_string(&text).expect("numbers and text have a TOML form");
        write_text(path, &format!("{HEAD}\n{text}"))?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_read_as_it_was_written_and_edited_numbers_are_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("line.toml");
        let line = LineCalibration {
            direction: Unit::new_normalize(Vector3::new(-1.0, 0.03, 0.1)),
            direction_bound: Radians(0.0013),
            way_per_count: Metres(0.000_123_4),
            scale_bound: 0.0021,
            counter: Counter::Bits16,
            residual: Metres(0.0011),
            num_poses: 12,
            way: Metres(0.61),
            part: "fender".into(),
            made_at: "2026-03-01T08:00:00Z".parse().expect("a time"),
            slip: 0.01,
            exposure: 0.008,
            delay: 0.12,
            delay_bound: 0.015,
        };
        line.save(&path).expect("written");
        let again = LineCalibration::load(&path).expect("read");
        assert!((again.direction.into_inner() - line.direction.into_inner()).norm() < 1e-12);
        assert!((again.way_per_count.0 - line.way_per_count.0).abs() < 1e-15);
        assert_eq!(
            (again.counter, &*again.part, again.num_poses),
            (Counter::Bits16, "fender", 12)
        );
        assert!((again.slip - 0.01).abs() < 1e-12 && (again.exposure - 0.008).abs() < 1e-12);
        let text = std::fs::read_to_string(&path).expect("text");
        let with = |from: &str, to: &str| {
            assert!(text.contains(from), "{from} in {text}");
            std::fs::write(&path, text.replace(from, to)).expect("written");
            LineCalibration::load(&path)
        };
        let edited = with("counter_bits = 16", "counter_bits = 32");
        assert!(matches!(edited, Err(LineFileError::Edited { .. })));
        let slower = with("exposure_ms = 8.0", "exposure_ms = 20.0").expect("may be edited");
        assert!((slower.exposure - 0.02).abs() < 1e-12 && (slower.delay - 0.12).abs() < 1e-12);
        assert!((again.delay_bound - 0.015).abs() < 1e-12);
        let prompt = with("delay_ms = 120.0", "").expect("may be left out");
        assert!(prompt.delay == 0.0);
        let exact = with("delay_bound_ms = 15.0", "").expect("may be left out");
        assert!(exact.delay_bound == 0.0 && exact.delay > 0.0);
        let negative = with("delay_bound_ms = 15.0", "delay_bound_ms = -1.0");
        let negative = negative.expect_err("out of range");
        assert!(
            negative.to_string().contains("delay_bound_ms is -1"),
            "{negative}"
        );
        let negative = with("exposure_ms = 8.0", "exposure_ms = -1.0").expect_err("out of range");
        assert!(negative.to_string().contains("exposure_ms"), "{negative}");
        let missing = LineCalibration::load(&folder.path().join("none.toml")).expect_err("none");
        assert!(missing.advice().contains("calibrate line"));
    }
}
