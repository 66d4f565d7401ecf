//! Programs for a robot's controller, as written by `inspect --program` and `path export`.

use std::path::{Path, PathBuf};

use clap::Args;
use jiff::Timestamp;

use super::{
    Outcome,
    console::{Advised as _, Console, advised_error},
    input::{parse_nozzle_pose, parse_robot_pose, within},
};
use crate::{
    error::Advice as _,
    geometry::rigid::RigidTransform,
    library::{PartName, SprayPath},
    paint::{Coat, WrittenFilm},
    robot::{
        RobotFrame, WrittenPose,
        arm::{Arm, ArmError, Obstacles, PathCheck, PlacedArm, Rail},
        program::{
            ClockAhead, Program, ProgramFormat, ProgramSettings, check_reach, clock_ahead_of_file,
            program_points,
        },
        spray::{BandStatus, CarriedPath, MOST_TILT, OffThePart, off_the_part},
    },
    stages::reference::{Coverage, Reference},
    units::{Metres, Radians, counted},
};

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
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(0..=9999), allow_negative_numbers = true, requires = "program")]
    gun_output: u16,
    /// Speed where the path sets none, 1 to 5000 mm/s
    #[arg(long, value_name = "MM/S", default_value_t = 250.0, value_parser = parse_speed, allow_negative_numbers = true, requires = "program")]
    speed: f64,
    /// Distance of the approach points from the path's first and last point, 10 to 1000 mm
    #[arg(long, value_name = "MM", default_value_t = 100.0, value_parser = parse_approach, allow_negative_numbers = true, requires = "program")]
    approach: f64,
    /// Radius within which the robot may cut corners, 0 to 100 mm
    #[arg(long, value_name = "MM", default_value_t = 5.0, value_parser = |text: &str| within(text, &(0.0..=100.0)), allow_negative_numbers = true, requires = "program")]
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
    #[arg(long, value_name = "MM", default_value_t = 20.0, value_parser = |text: &str| within(text, &(0.0..=1000.0)), allow_negative_numbers = true, requires = "arm")]
    clearance: f64,
    /// Radius of the gun around the line from the flange to the nozzle's mouth, from 1 mm to half the gun's length
    #[arg(long, value_name = "MM", default_value_t = 50.0, value_parser = |text: &str| within(text, &(1.0..=1000.0)), allow_negative_numbers = true, requires = "arm")]
    gun_radius: f64,
    /// Maximum tilt of the nozzle about the point that it aims at, 0 to 30 degrees; used only where the arm cannot
    /// otherwise follow the path
    #[arg(long, value_name = "DEG", default_value_t = 10.0, value_parser = |text: &str| within(text, &(0.0..=30.0)), allow_negative_numbers = true, requires = "arm")]
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
    within(text, &(1.0..=5000.0))
}

/// Parses `--approach`, mm.
pub(super) fn parse_approach(text: &str) -> Result<f64, String> {
    within(text, &(10.0..=1000.0))
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
    /// The stored path, in part space.
    pub(super) path: &'a SprayPath,
    /// Name of the capture; `None` for the standard position.
    pub(super) scene: Option<&'a str>,
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

/// Advice against the first doubt about a path of this part, if another capture or place of the arm does not help.
pub(super) fn advice_on_path(
    off: Option<&OffThePart>,
    ahead: Option<&ClockAhead>,
    part: &PartName,
) -> Option<String> {
    let off = off.map(|off| {
        format!(
            "{} (partsight library path {part} shows it), or plan a new one",
            off.advice()
        )
    });
    off.or_else(|| ahead.map(ClockAhead::advice))
}

impl ProgramFile {
    /// Writes the program of a carried path, unless there are doubts and `--force` is not set.
    pub(super) fn write(
        &self,
        carried: &CarriedPath,
        subject: &ProgramSubject<'_>,
        frame: &RobotFrame,
        mut doubts: Vec<String>,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        let robot_from_part = frame.robot_from_part(&subject.camera_from_part);
        let reach = self.arm.as_ref().map(|arm| {
            let arm = arm
                .clone()
                .with_part(&subject.reference.cloud.points, &robot_from_part);
            let reach = check_reach(&arm, carried, frame, &self.settings)?;
            Ok((arm, reach))
        });
        let reach: Result<_, ArmError> = reach.transpose();
        let reach = reach.advised()?;
        let doubt = |(arm, reach): &(PlacedArm, PathCheck)| reach.doubt(&arm.arm.name);
        doubts.extend(reach.as_ref().and_then(doubt));
        let ahead = subject
            .scene
            .and_then(|scene| clock_ahead_of_file(Path::new(scene)));
        if let Some(ahead) = &ahead {
            doubts.insert(0, ahead.to_string());
        }
        // Neither another capture nor another place of the arm helps against this one.
        let off = off_the_part(subject.path, subject.reference);
        if let Some(off) = &off {
            doubts.insert(0, off.to_string());
        }
        let points = program_points(carried, frame, reach.as_ref().map(|(_, reach)| reach));
        let program = Program {
            points: &points,
            settings: &self.settings,
            acceleration: Coat::acceleration_of(subject.path),
            film: None,
            reach: reach.as_ref(),
            part: subject.part.as_str(),
            scene: subject.scene,
            robot_from_part,
            calibration: &frame.name,
            is_simulated: subject.is_simulated,
            doubts: &[],
            at: Timestamp::now(),
        };
        let (path, enrolled) = (subject.path, &subject.reference.cloud);
        let film = WrittenFilm::of(&program, self.format, path, enrolled, subject.coverage);
        let off_plan = film.as_ref().and_then(WrittenFilm::doubt);
        let of_film = off_plan.filter(|_| doubts.is_empty());
        doubts.extend(off_plan.map(|off_plan| off_plan.to_string()));
        if let (false, Some(doubt)) = (self.is_forced, doubts.first()) {
            console.note(&format_args!("no program was written: {doubt}"));
            let advice = advice_on_path(off.as_ref(), ahead.as_ref(), subject.part);
            let advice = advice.unwrap_or_else(|| {
                if let Some(off_plan) = of_film {
                    return off_plan.advice();
                }
                if subject.scene.is_some() {
                    return "Capture all of the part again, or move part or arm".to_owned();
                }
                format!(
                    "Run partsight path check {} with the same options to see why, and whether another --base reaches more, or change the path",
                    subject.part
                )
            });
            console.note(&format_args!("  to do: {advice}; --force writes it anyway"));
            return Ok(Outcome::NotAccepted);
        }
        let film = film.as_ref().map(WrittenFilm::line);
        let program = Program {
            doubts: &doubts,
            film: film.as_deref(),
            ..program
        };
        let num_parts = program.save(&self.file, self.format).advised()?;
        console.note(&format_args!(
            "{}: {} as {}; {}",
            self.file.display(),
            counted(points.len(), "point", "points"),
            self.format.title(),
            against_seen(carried)
        ));
        console.note(&format_args!(
            "  film: {}",
            film.as_deref()
                .unwrap_or("not computed, because the path names no coat; plan it again to know")
        ));
        if num_parts > 0 {
            console.note(&format_args!(
                "  it calls {num_parts} programs that lie beside it; the controller needs all of them"
            ));
        }
        let base = reach.as_ref().map(|(arm, _)| arm.robot_from_base);
        if base.is_some_and(|base| base != RigidTransform::identity()) {
            console.note(&"  its poses are in the frame of the calibration; --base only affects the check. If the controller's frame moves with the base, calibrate the cell again and leave --base out");
        }
        for doubt in &doubts {
            console.note(&format_args!("warning: written by --force: {doubt}"));
        }
        Ok(Outcome::Accepted)
    }
}

/// Describes how many points of a carried path are within the band, of those that could be checked against the capture.
/// Adds the number of unchecked points if there are more of them than the moves beside a part that is seen whole.
pub(super) fn against_seen(carried: &CarriedPath) -> String {
    let num = carried.points.len();
    let num_seen = carried.num_seen();
    let verb = |num: usize, one: &'static str, many| if num == 1 { one } else { many };
    let num_inside = carried.num_inside();
    let mut words = format!(
        "of {num_seen} that {} at what was seen of the part, {num_inside} {} within the band",
        verb(num_seen, "aims", "aim"),
        verb(num_inside, "is", "are")
    );
    let num_flat = carried.count(BandStatus::TooFlat);
    if num_flat > 0 {
        words = format!(
            "{words}, {num_flat} {} it at more than {:.0}°, as strokes that lean towards flanks may",
            verb(num_flat, "meets", "meet"),
            MOST_TILT.degrees()
        );
    }
    if 4 * num_seen < num {
        let rest = num - num_seen;
        words = format!("{words}. Not checked against what was seen: the other {rest}");
    }
    words
}
