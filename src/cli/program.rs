//! Programs for a robot's controller, as written by `inspect --program` and `path export`.

use std::path::{Path, PathBuf};

use clap::Args;

use super::{
    Outcome,
    console::{Advised as _, Console, advised_error},
    input::{parse_nozzle_pose, parse_robot_pose, within},
    robot_file,
};
use geometry::{
    rigid::RigidTransform,
    units::{Metres, Radians},
};
use inspection::library::{PartName, Side, SprayPath};
use robot::{
    RobotFrame, WrittenPose,
    arm::{Arm, Obstacles, PlacedArm, Rail},
    program::{ProgramFormat, ProgramSettings, ranges},
    spray::{CarriedPath, off_the_part},
};
use stages::reference::{Coverage, Reference};
use station::robot_file::{CapturedPart, RobotFile, RobotFileContent};

/// Tool, gun and arm of a program; the command names its file `program`.
#[derive(Debug, Args)]
pub(super) struct ProgramOptions {
    /// The tool on the controller: a number for KUKA, FANUC and Yaskawa, a name for Doosan and, without --nozzle, for ABB
    #[arg(long, value_name = "TOOL", requires = "program")]
    tool: Option<String>,
    /// Pose of the nozzle on the flange, with z in its direction: `kuka X Y Z A B C`, or the 16 numbers of a matrix
    #[arg(long, value_name = "POSE", value_parser = parse_nozzle_pose, allow_hyphen_values = true, requires = "program")]
    nozzle: Option<WrittenPose>,
    /// Number of the digital output that opens the gun
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(0..=i64::from(ranges::MAX_GUN_OUTPUT)), allow_negative_numbers = true, requires = "program")]
    gun_output: u16,
    /// Speed where the path sets none, 1 to 5000 mm/s
    #[arg(long, value_name = "MM/S", default_value_t = 250.0, value_parser = parse_speed, allow_negative_numbers = true, requires = "program")]
    speed: f64,
    /// Distance of the approach points from the path's first and last point, 10 to 1000 mm
    #[arg(long, value_name = "MM", default_value_t = 100.0, value_parser = parse_approach, allow_negative_numbers = true, requires = "program")]
    approach: f64,
    /// Radius within which the robot may cut corners, 0 to 100 mm
    #[arg(long, value_name = "MM", default_value_t = 5.0, value_parser = |text: &str| within(text, &ranges::BLEND_MM), allow_negative_numbers = true, requires = "program")]
    blend: f64,
    /// Check that this arm reaches the path: a name, or a TOML file; needs --nozzle
    #[arg(long, value_name = "ARM", requires_all = ["program", "nozzle"])]
    arm: Option<String>,
    #[command(flatten)]
    cell: CellChoice,
    /// Write the file despite doubts about part, path, capture or reach; it names them
    #[arg(long, requires = "robot_file")]
    pub(super) force: bool,
}

/// Where an arm stands, and the obstacles besides the part.
#[derive(Debug, Args)]
pub(super) struct CellChoice {
    /// Pose of the arm's base in the calibration's frame; default: the two frames are the same
    #[arg(long, value_name = "POSE", value_parser = parse_robot_pose, allow_hyphen_values = true, requires = "arm")]
    pub(super) base: Option<WrittenPose>,
    /// Rail that the arm stands on: its axis in the calibration's frame (x, y, z, -x, -y or -z), its start and end in
    /// mm from where the cell was calibrated and, if the arm moves along it on the path, its maximum speed in mm/s and
    /// acceleration in mm/s², as in y,-2000,2000,1000,2000. Overrides the rail in the arm's file
    #[arg(
        long,
        value_name = "AXIS,FROM,TO[,SPEED[,ACCELERATION]]",
        allow_hyphen_values = true,
        requires = "arm"
    )]
    rail: Option<String>,
    /// TOML file with the boxes and floor of the cell that gun and arm must not run into. The part is checked in any
    /// case
    #[arg(long, value_name = "FILE", requires = "arm")]
    obstacles: Option<PathBuf>,
    /// Minimum distance of gun and arm from part, boxes and floor, 0 to 1000 mm
    #[arg(long, value_name = "MM", default_value_t = 20.0, value_parser = |text: &str| within(text, &ranges::CLEARANCE_MM), allow_negative_numbers = true, requires = "arm")]
    clearance: f64,
    /// Radius of the gun around the line from the flange to the nozzle's mouth, from 1 mm to half the gun's length
    #[arg(long, value_name = "MM", default_value_t = 50.0, value_parser = |text: &str| within(text, &ranges::GUN_RADIUS_MM), allow_negative_numbers = true, requires = "arm")]
    gun_radius: f64,
    /// Maximum tilt of the nozzle about the point that it aims at, 0 to 30 degrees; used only where the arm cannot
    /// otherwise follow the path
    #[arg(long, value_name = "DEG", default_value_t = 10.0, value_parser = |text: &str| within(text, &ranges::MAX_TILT_DEG), allow_negative_numbers = true, requires = "arm")]
    max_tilt: f64,
}

impl CellChoice {
    pub(super) fn max_tilt(&self) -> Radians {
        Radians::from_degrees(self.max_tilt)
    }

    /// Places an arm in this cell.
    pub(super) fn place(
        &self,
        mut arm: Arm,
        flange_from_nozzle: RigidTransform,
    ) -> anyhow::Result<PlacedArm> {
        if let Some(rail) = &self.rail {
            arm.rail = Some(rail.parse::<Rail>().advised()?);
        }
        let read = self.obstacles.as_deref().map(Obstacles::read);
        let mut obstacles = read.transpose().advised()?.unwrap_or_default();
        obstacles.clearance = self.clearance / 1000.0;
        let base = self.base.as_ref();
        Ok(PlacedArm {
            arm,
            robot_from_base: base.map_or_else(RigidTransform::identity, |base| base.pose),
            flange_from_nozzle,
            gun_radius: self.gun_radius / 1000.0,
            obstacles,
        })
    }
}

pub(super) fn parse_format(name: &str) -> Result<ProgramFormat, String> {
    let mut all = ProgramFormat::ALL.into_iter();
    all.find(|format| format.name() == name).ok_or_else(|| {
        let names = ProgramFormat::ALL.map(ProgramFormat::name);
        format!("expected one of {}", names.join(", "))
    })
}

/// Parses `--speed`, mm/s. Most controllers' own limits are lower.
pub(super) fn parse_speed(text: &str) -> Result<f64, String> {
    within(text, &ranges::SPEED_MM_S)
}

/// Parses `--approach`, mm.
pub(super) fn parse_approach(text: &str) -> Result<f64, String> {
    within(text, &ranges::APPROACH_MM)
}

/// A program to write.
pub(super) struct ProgramFile {
    file: PathBuf,
    format: ProgramFormat,
    settings: ProgramSettings,
    arm: Option<PlacedArm>,
    is_forced: bool,
}

/// The part and capture that a program is for.
pub(super) struct ProgramSubject<'a> {
    pub(super) part: &'a PartName,
    pub(super) reference: &'a Reference,
    pub(super) coverage: Coverage,
    /// The side that it is painted from; `None` for its own.
    pub(super) side: Option<Side>,
    /// The stored path, in part space.
    pub(super) path: &'a SprayPath,
    /// The capture; `None` for the standard position.
    pub(super) capture: Option<CapturedPart<'a>>,
    pub(super) camera_from_part: RigidTransform,
    pub(super) is_simulated: bool,
}

impl ProgramOptions {
    /// Prepares a program file in this format, or in that of the file's ending. The ending must not be that of another
    /// language.
    pub(super) fn open(
        &self,
        file: &Path,
        format: Option<ProgramFormat>,
    ) -> anyhow::Result<ProgramFile> {
        let format = match (format, ProgramFormat::of(file)) {
            (Some(format), Ok(other)) if format != other => {
                return Err(advised_error(
                    format!(
                        "{} was requested as {}, but its ending is that of {}",
                        file.display(),
                        format.title(),
                        other.title()
                    ),
                    format!(
                        "End the file's name in .{}, or choose the language {}",
                        format.ending(),
                        other.name()
                    ),
                ));
            }
            (Some(format), _) => format,
            (None, of_file) => of_file.advised()?,
        };
        let nozzle = self.nozzle.as_ref().map(|written| written.pose);
        let arm = self.arm.as_deref().map(Arm::named).transpose().advised()?;
        let arm = arm.zip(nozzle);
        let arm = arm.map(|(arm, flange_from_nozzle)| self.cell.place(arm, flange_from_nozzle));
        let arm = arm.transpose()?;
        Ok(ProgramFile {
            file: file.to_owned(),
            format,
            settings: ProgramSettings {
                tool: self.tool.clone(),
                flange_from_nozzle: nozzle,
                gun_output: self.gun_output,
                speed: self.speed / 1000.0,
                approach: Metres::from_mm(self.approach),
                max_tilt: self.cell.max_tilt(),
                blend: Metres::from_mm(self.blend),
            },
            arm,
            is_forced: self.force,
        })
    }
}

impl ProgramFile {
    /// Writes the program of a carried path, unless there are doubts and `--force` is not set.
    pub(super) fn write(
        &self,
        carried: &CarriedPath,
        subject: &ProgramSubject<'_>,
        frame: &RobotFrame,
        console: &Console,
    ) -> anyhow::Result<Outcome> {
        let file = RobotFile {
            file: &self.file,
            content: RobotFileContent::Program {
                format: self.format,
                settings: &self.settings,
                arm: self.arm.as_ref(),
            },
            carried,
            frame,
            part: subject.part.as_str(),
            part_cloud: &subject.reference.cloud,
            coverage: subject.coverage,
            side: subject.side,
            path: Some(subject.path),
            off: off_the_part(subject.path, subject.reference),
            capture: subject.capture,
            camera_from_part: subject.camera_from_part,
            is_stored: true,
            is_simulated: subject.is_simulated,
            is_forced: self.is_forced,
        };
        if robot_file::write(&file, console)?.is_none() {
            return Ok(Outcome::NotAccepted);
        }
        let base = self.arm.as_ref().map(|arm| arm.robot_from_base);
        if base.is_some_and(|base| base != RigidTransform::identity()) {
            console.note(&"  its poses are in the frame of the calibration; --base only affects the check. If the controller's frame moves with the base, calibrate the cell again and leave --base out");
        }
        Ok(Outcome::Accepted)
    }
}
