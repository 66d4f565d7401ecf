//! `partsight inspect --program`: the part's spray path as a program for the robot's controller.

use std::{
    path::{Path, PathBuf},
    time::{Duration, SystemTime},
};

use clap::Args;
use jiff::Timestamp;

use super::spray::{SprayResult, check_placed_part, names_of};
use crate::{
    cli::{
        Outcome,
        console::{Advised as _, Console, advised_error},
        input::parse_robot_pose,
    },
    geometry::rigid::RigidTransform,
    library::{LibraryLoad, LibraryPlace, PartName},
    robot::{
        RobotFrame, WrittenPose,
        arm::{Arm, ArmPoint, CheckParams, PlacedArm, check_path},
        program::{Program, ProgramFormat, ProgramPoint, ProgramSettings, remove_previous_program},
        spray::{CarriedPath, carry},
    },
    units::Metres,
};

/// After this long the part may hang elsewhere.
const STALE: Duration = Duration::from_mins(10);

/// Whether and how a program is written.
#[derive(Debug, Args)]
pub(super) struct ProgramChoice {
    /// Write the part's stored spray path as a program for the robot's controller, called as the file: .src, .ls, .mod,
    /// .script, .jbi or .drl. Needs a calibration and one file. Nothing is written of a part that is not accepted, of a
    /// capture older than 10 minutes, or if --arm does not reach every point
    #[arg(long, value_name = "FILE", conflicts_with = "spray")]
    program: Option<PathBuf>,
    /// Its language, where the file's ending does not say it: krl, ls, rapid, urscript, jbi or drl
    #[arg(long, value_name = "FORMAT", value_parser = parse_format, requires = "program")]
    robot_program_format: Option<ProgramFormat>,
    /// The tool on the controller: a number for KUKA, FANUC and Yaskawa, a name for ABB and Doosan
    #[arg(long, value_name = "TOOL", requires = "program")]
    tool: Option<String>,
    /// Where the nozzle is on the flange, z the way it points: `kuka X Y Z A B C`, or 16 numbers of a matrix
    #[arg(long, value_name = "POSE", value_parser = parse_robot_pose, allow_hyphen_values = true, requires = "program")]
    nozzle: Option<WrittenPose>,
    /// Number of the digital output that opens the gun
    #[arg(long, value_name = "N", default_value_t = 1, requires = "program")]
    gun_output: u16,
    /// Speed where the path sets none, mm/s
    #[arg(
        long,
        value_name = "MM/S",
        default_value_t = 250.0,
        requires = "program"
    )]
    speed: f64,
    /// How far before the first and behind the last point the program begins and ends, mm
    #[arg(long, value_name = "MM", default_value_t = 100.0, requires = "program")]
    approach: f64,
    /// Radius within which the robot may cut corners, mm
    #[arg(long, value_name = "MM", default_value_t = 5.0, requires = "program")]
    blend: f64,
    /// Check that this arm reaches the path: a name, or a TOML file; needs --nozzle
    #[arg(long, value_name = "ARM", requires_all = ["program", "nozzle"])]
    arm: Option<String>,
    /// Write the program in spite of a doubt about part, capture or reach; the program says which
    #[arg(long, requires = "program")]
    force: bool,
}

fn parse_format(name: &str) -> Result<ProgramFormat, String> {
    let mut all = ProgramFormat::ALL.into_iter();
    all.find(|format| format.name() == name).ok_or_else(|| {
        let names = ProgramFormat::ALL.map(ProgramFormat::name);
        format!("expected one of {}", names.join(", "))
    })
}

/// A program that is to be written.
pub(super) struct ProgramFile {
    file: PathBuf,
    format: ProgramFormat,
    settings: ProgramSettings,
    arm: Option<PlacedArm>,
    is_forced: bool,
    place: LibraryPlace,
    /// Name and whether it is simulated, in the order of the library's references.
    parts: Vec<(PartName, bool)>,
}

impl ProgramChoice {
    /// True if a program is asked for.
    pub(super) fn is_wanted(&self) -> bool {
        self.program.is_some()
    }

    /// What is to be written, if that can be.
    pub(super) fn start(
        &self,
        files: &[PathBuf],
        frame: Option<&RobotFrame>,
        place: LibraryPlace,
        load: &LibraryLoad,
    ) -> anyhow::Result<Option<ProgramFile>> {
        let Some(file) = &self.program else {
            return Ok(None);
        };
        // Whatever comes of this capture, no robot may run an earlier program for it.
        remove_previous_program(file).advised()?;
        check_placed_part("--program", files, frame)?;
        let format = match self.robot_program_format {
            Some(format) => format,
            None => ProgramFormat::of(file).advised()?,
        };
        let nozzle = self.nozzle.as_ref().map(|written| written.pose);
        let arm = self.arm.as_deref().map(Arm::named).transpose().advised()?;
        let arm = arm.zip(nozzle).map(|(arm, flange_from_nozzle)| PlacedArm {
            arm,
            robot_from_base: RigidTransform::identity(),
            flange_from_nozzle,
        });
        Ok(Some(ProgramFile {
            file: file.clone(),
            format,
            settings: ProgramSettings {
                tool: self.tool.clone(),
                flange_from_nozzle: nozzle,
                gun_output: self.gun_output,
                speed: self.speed / 1000.0,
                approach: Metres::from_mm(self.approach),
                blend: Metres::from_mm(self.blend),
            },
            arm,
            is_forced: self.force,
            place,
            parts: names_of(load),
        }))
    }
}

impl ProgramFile {
    /// Carries the path and writes the program, unless something speaks against it.
    pub(super) fn write(
        &self,
        seen: &SprayResult<'_>,
        is_scene_simulated: bool,
        frame: &RobotFrame,
        console: &mut Console,
    ) -> anyhow::Result<Outcome> {
        let inspection = seen.inspection;
        let pose = inspection.pose.as_ref().and_then(|pose| pose.as_ref().ok());
        let first = inspection.ranking.entries.first();
        let part = inspection.segmentation.part.as_ref().ok();
        let (Some((pose, first)), Some(part)) = (pose.zip(first), part) else {
            console.note(&"no program was written, since no part was found with a pose");
            return Ok(Outcome::NotAccepted);
        };
        let (name, is_simulated) = &self.parts[first.reference];
        let Some(path) = self.place.spray_path(name.as_str()).advised()? else {
            return Err(advised_error(
                format!("{name} has no spray path, so there is nothing to write a program of"),
                format!("Store one: partsight library path {name} path.csv"),
            ));
        };
        let camera_from_part = pose.camera_from_part();
        let carried = carry(&path, &camera_from_part, &part.cloud, seen.params);
        let mut points = points_of(&carried, frame);
        let are_round: Vec<bool> = carried.points.iter().map(|point| point.is_round).collect();
        let mut doubts = Vec::new();
        if !inspection.verdict.is_accepted() {
            doubts.push("the part was not accepted".to_owned());
        }
        if is_stale(Path::new(seen.scene)) {
            doubts.push("the capture is more than 10 minutes old".to_owned());
        }
        doubts.extend(self.unreached(&mut points, &are_round)?);
        if let (false, Some(doubt)) = (self.is_forced, doubts.first()) {
            console.note(&format_args!("no program was written: {doubt}"));
            console.note(
                &"  to do: Capture again, or move part or arm; --force writes it all the same",
            );
            return Ok(Outcome::NotAccepted);
        }
        let program = Program {
            points: &points,
            settings: &self.settings,
            part: name.as_str(),
            scene: Some(seen.scene),
            robot_from_part: frame.robot_from_part(&camera_from_part),
            calibration: &frame.name,
            is_simulated: *is_simulated || is_scene_simulated,
            doubts: &doubts,
            at: Timestamp::now(),
        };
        program.save(&self.file, self.format).advised()?;
        console.note(&format_args!(
            "{}: {} points as {}, {} of them within the band",
            self.file.display(),
            points.len(),
            self.format.title(),
            carried.num_inside()
        ));
        for doubt in &doubts {
            console.note(&format_args!("warning: written by --force: {doubt}"));
        }
        Ok(Outcome::Accepted)
    }

    /// Turns each nozzle of a round jet about its axis as the arm reaches it, and says how many points it does not reach.
    fn unreached(
        &self,
        points: &mut [ProgramPoint],
        are_round: &[bool],
    ) -> anyhow::Result<Option<String>> {
        let Some(arm) = &self.arm else {
            return Ok(None);
        };
        let wanted = points
            .iter()
            .zip(are_round)
            .map(|(point, is_round)| ArmPoint {
                robot_from_nozzle: point.robot_from_nozzle,
                speed: point.speed.unwrap_or(self.settings.speed),
                is_turn_free: *is_round,
            });
        let wanted: Vec<ArmPoint> = wanted.collect();
        let found = check_path(arm, &wanted, &CheckParams::default()).advised()?;
        for (point, checked) in points.iter_mut().zip(&found.points) {
            let turn = nalgebra::UnitQuaternion::from_euler_angles(0.0, 0.0, checked.turn);
            point.robot_from_nozzle *= turn;
        }
        let (num, all) = (found.num_reached(), points.len());
        Ok((num < all).then(|| format!("{} reaches {num} of {all} points", arm.arm.name)))
    }
}

fn points_of(carried: &CarriedPath, frame: &RobotFrame) -> Vec<ProgramPoint> {
    let points = carried.points.iter().map(|point| ProgramPoint {
        robot_from_nozzle: frame.robot_from_camera * point.camera_from_nozzle,
        is_gun_on: point.is_gun_on,
        speed: point.speed,
    });
    points.collect()
}

/// True of a file that was not written lately.
fn is_stale(scene: &Path) -> bool {
    let changed = scene.metadata().and_then(|meta| meta.modified());
    changed.is_ok_and(|at| {
        SystemTime::now()
            .duration_since(at)
            .is_ok_and(|age| age > STALE)
    })
}
