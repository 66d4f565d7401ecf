//! A carried path as a file for a robot, with the meaning of every number.

use std::{fmt::Write as _, io::Read as _, path::Path};

use jiff::Timestamp;
use serde::Serialize;

use super::{BandStatus, CarriedPath, MOST_TILT};
use crate::{Convention, FrameName, RobotFrame, RobotPose, RobotValue};
use files::{FileError, csv_comment, disk, open_regular, write_text};
use stages::stand_off::StandOffParams;

/// Version of both file formats.
const SCHEMA: u32 = 1;

/// The content of a file with a carried path.
#[derive(Clone, Debug)]
pub struct SprayExport<'a> {
    /// The path.
    pub path: &'a CarriedPath,
    /// Name of the part.
    pub part: &'a str,
    /// Name of the capture.
    pub scene: &'a str,
    /// The robot's frame.
    pub frame: &'a RobotFrame,
    /// Convention of the poses.
    pub convention: Convention,
    /// The band with which it was compared.
    pub params: &'a StandOffParams,
    /// True for the part's stored path, false for the default point of a part without one.
    pub is_stored: bool,
    /// True if the part was accepted.
    pub is_accepted: bool,
    /// True if the scene, or the enrolled part, was simulated.
    pub is_simulated: bool,
    /// Reasons against moving a robot by the poses.
    pub doubts: &'a [String],
    /// What was not checked.
    pub unchecked: &'a [String],
    /// When the file was made.
    pub at: Timestamp,
}

/// Beginnings by which each kind of file is recognised.
const BEGINNINGS: [&str; 2] = ["# Partsight spray path", "{\n  \"schema\": 1,\n  \"part\""];

/// Removes an earlier export of this name, so that nobody takes it for that of the next part. Returns true if there was
/// one. Other files of this name stay.
pub fn remove_previous_export(path: &Path) -> Result<bool, FileError> {
    let mut beginning = [0; 64];
    let read = open_regular(path).and_then(|mut file| file.read(&mut beginning));
    // If it cannot be read, writing the next export will report the error.
    let Ok(num_read) = read else {
        return Ok(false);
    };
    let beginning = String::from_utf8_lossy(&beginning[..num_read]);
    if !BEGINNINGS.iter().any(|ours| beginning.starts_with(ours)) {
        return Ok(false);
    }
    disk::remove_file(path).map_err(|source| FileError::writing(path, source))?;
    Ok(true)
}

#[derive(Serialize)]
struct Json<'a> {
    schema: u32,
    part: &'a str,
    scene: &'a str,
    at: Timestamp,
    simulated: bool,
    stored_path: bool,
    accepted: bool,
    doubts: &'a [String],
    not_checked: &'a [String],
    frame: &'static str,
    tool: &'static str,
    calibration: &'a FrameName,
    robot_from_camera: [f64; 16],
    convention: Convention,
    meaning: String,
    band_mm: [f64; 2],
    most_tilt_deg: f64,
    num_points: usize,
    num_inside: usize,
    points: Vec<JsonPoint>,
}

#[derive(Serialize)]
struct JsonPoint {
    index: usize,
    robot_from_nozzle: RobotPose,
    stand_off_mm: Option<f64>,
    tilt_deg: Option<f64>,
    band: BandStatus,
    gun_on: bool,
    speed_mm_s: Option<f64>,
}

const FRAME: &str = "the robot's base frame";
const TOOL: &str = "origin at the nozzle's mouth, z in the direction in which it points (towards the part), x along the fan's long side or, for a round jet, nearest to the part's x axis, y = z × x";

impl SprayExport<'_> {
    /// Writes the file, whole or not at all: JSON if its name ends in `.json`, else CSV.
    pub fn save(&self, path: &Path) -> Result<(), FileError> {
        let is_json = path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("json"));
        let text = if is_json { self.json() } else { self.csv() };
        write_text(path, &text)
    }

    fn poses(&self) -> impl Iterator<Item = RobotPose> {
        self.path.points.iter().map(|point| {
            let robot_from_nozzle = self.frame.robot_from_camera * point.camera_from_nozzle;
            self.convention.write(&robot_from_nozzle)
        })
    }

    /// Returns the table below a header that explains it.
    pub fn csv(&self) -> String {
        let params = self.params;
        let kind = if self.is_stored {
            "the part's stored spray path"
        } else {
            "one start before the part's middle: no path is stored"
        };
        let seen = if self.is_simulated {
            ", SIMULATED: no camera saw this scene, or none saw the part when it was enrolled"
        } else {
            ""
        };
        let accepted = if self.is_accepted {
            "accepted"
        } else {
            "not accepted"
        };
        let marked = |mark: &str, texts: &[String]| {
            let lines = texts.iter();
            let lines = lines.map(|text| format!("# {mark}: {}\n", csv_comment(text)));
            lines.collect::<String>()
        };
        let notes = marked("DOUBT", self.doubts) + &marked("NOT CHECKED", self.unchecked);
        let mut text = format!(
            "# Partsight spray path, version {SCHEMA}\n\
             # part: {}, {kind}\n\
             # scene: {}, {accepted}{seen}\n\
             {notes}\
             # made: {}\n\
             # frame: {FRAME}, by the calibration {}\n\
             # each line: robot_from_nozzle; tool: {TOOL}\n\
             # convention: {}: {}\n\
             # band: stand-off {:.0} to {:.0} mm and at most {:.0} degrees from square on, against the part as it was seen; {} of {} inside\n",
            self.part,
            csv_comment(self.scene),
            self.at,
            csv_comment(&self.frame.name.to_string()),
            self.convention.name(),
            self.convention.meaning(),
            params.nearest.mm(),
            params.farthest.mm(),
            MOST_TILT.degrees(),
            self.path.num_inside(),
            self.path.points.len(),
        );
        for (i, (point, pose)) in self.path.points.iter().zip(self.poses()).enumerate() {
            if i == 0 {
                let names: Vec<String> = pose
                    .values
                    .iter()
                    .map(|value| match value.unit.symbol() {
                        "" => value.name.to_owned(),
                        unit => format!("{}_{unit}", value.name),
                    })
                    .collect();
                // Writing to memory does not fail.
                let _ = writeln!(
                    text,
                    "index,{},stand_off_mm,tilt_deg,band,gun_on,speed_mm_s",
                    names.join(",")
                );
            }
            let numbers: Vec<String> = pose.values.iter().map(RobotValue::rounded).collect();
            let (distance, tilt) = point.meets.map_or_else(Default::default, |met| {
                let (distance, tilt) = (met.distance.mm(), met.tilt.degrees());
                (format!("{distance:.1}"), format!("{tilt:.1}"))
            });
            let speed = point.speed.map(|v| format!("{:.1}", v * 1000.0));
            let speed = speed.unwrap_or_default();
            let _ = writeln!(
                text,
                "{},{},{distance},{tilt},{},{},{speed}",
                i + 1,
                numbers.join(","),
                point.band.name(),
                u8::from(point.is_gun_on),
            );
        }
        text
    }

    /// Returns the same content as JSON.
    pub fn json(&self) -> String {
        let params = self.params;
        let points = self.path.points.iter().zip(self.poses()).enumerate();
        let points = points.map(|(i, (point, pose))| JsonPoint {
            index: i + 1,
            robot_from_nozzle: pose,
            stand_off_mm: point.meets.map(|met| met.distance.mm()),
            tilt_deg: point.meets.map(|met| met.tilt.degrees()),
            band: point.band,
            gun_on: point.is_gun_on,
            speed_mm_s: point.speed.map(|speed| speed * 1000.0),
        });
        let json = Json {
            schema: SCHEMA,
            part: self.part,
            scene: self.scene,
            at: self.at,
            simulated: self.is_simulated,
            stored_path: self.is_stored,
            accepted: self.is_accepted,
            doubts: self.doubts,
            not_checked: self.unchecked,
            frame: FRAME,
            tool: TOOL,
            calibration: &self.frame.name,
            robot_from_camera: geometry::rigid::row_major(&self.frame.robot_from_camera),
            convention: self.convention,
            meaning: self.convention.meaning(),
            band_mm: [params.nearest.mm(), params.farthest.mm()],
            most_tilt_deg: MOST_TILT.degrees(),
            num_points: self.path.points.len(),
            num_inside: self.path.num_inside(),
            points: points.collect(),
        };
        let mut text =
            serde_json::to_string_pretty(&json).expect("numbers and text have a JSON form");
        text.push('\n');
        text
    }
}
