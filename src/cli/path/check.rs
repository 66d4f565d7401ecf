//! `partsight path check`: checks that an arm reaches a part's path in its standard position.

use clap::Args;
use serde_json::json;

use crate::{
    cli::{
        LibraryChoice, Outcome,
        calibrate::CalibrationChoice,
        console::{Advised as _, Console, advised_error},
        input::parse_robot_pose,
        program::CellChoice,
    },
    geometry::rigid::RigidTransform,
    library::PartName,
    robot::{
        WrittenPose,
        arm::{
            Arm, CheckParams, PathCheck, PlaceSuggestion, PlacedArm, PointProblem, suggest_base,
            suggest_rail,
        },
        program::{ProgramSettings, arm_points, check_reach},
        spray::carry,
    },
    stages::{reference::ReferenceParams, stand_off::StandOffParams},
};

/// Check that an arm reaches the stored path of a part in its standard position without collisions
#[derive(Debug, Args)]
pub(super) struct CheckArgs {
    /// Name of the part
    part: PartName,
    /// The arm: kr6-r900, m-20ia, irb2600, irb4600, gp25, or a TOML file
    #[arg(long, value_name = "ARM")]
    arm: String,
    /// Pose of the nozzle on the flange, with z the way it points: `kuka X Y Z A B C`, or the 16 numbers of a matrix
    #[arg(long, value_name = "POSE", value_parser = parse_robot_pose, allow_hyphen_values = true)]
    nozzle: WrittenPose,
    /// Pose of the arm's base in the calibration's frame; default: the two frames are the same
    #[arg(long, value_name = "POSE", value_parser = parse_robot_pose, allow_hyphen_values = true)]
    base: Option<WrittenPose>,
    #[command(flatten)]
    cell: CellChoice,
    /// Speed of the nozzle where the path sets none, mm/s
    #[arg(long, value_name = "MM/S", default_value_t = 250.0)]
    speed: f64,
    /// Write one line of JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    calibration: CalibrationChoice,
}

pub(super) fn run(
    choice: &LibraryChoice,
    args: &CheckArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let name = &args.part;
    let arm = Arm::named(&args.arm).advised()?;
    let Some(frame) = args.calibration.frame(console)? else {
        return Err(advised_error(
            "the check needs to know where the camera sits in the robot's cell",
            "Name a calibration with --calibration, or make one: partsight calibrate",
        ));
    };
    let place = choice.open(console)?;
    let Some(path) = place.spray_path(name.as_str()).advised()? else {
        return Err(advised_error(
            format!("{name} has no spray path"),
            format!("Store one: partsight library path {name} path.csv"),
        ));
    };
    let part = place.read(name.as_str(), &ReferenceParams::default());
    let reference = part.advised()?.advised()?.reference;
    let standard = RigidTransform::identity();
    let carried = carry(
        &path,
        &standard,
        &reference.cloud,
        &StandOffParams::default(),
    );
    let settings = ProgramSettings {
        speed: args.speed / 1000.0,
        ..ProgramSettings::default()
    };
    let points = arm_points(&carried, &frame, settings.speed);
    let robot_from_base = args.base.as_ref().map_or(standard, |base| base.pose);
    let placed = args
        .cell
        .place(arm, robot_from_base, args.nozzle.pose)?
        .with_part(&reference.cloud.points, &frame.robot_from_part(&standard));
    let params = CheckParams::default();
    let found = check_reach(&placed, &carried, &frame, &settings).advised()?;
    let (num, all) = (found.num_reached(), points.len());
    let (mut base, mut rail) = (None, None);
    if num < all {
        // No progress display: the console shows that the command is working, and Ctrl-C ends it.
        let (progress, is_cancelled) = (|_, _| {}, || false);
        rail = suggest_rail(&placed, &points, &params, num, &progress, &is_cancelled).advised()?;
        base = suggest_base(&placed, &points, &params, num, &progress, &is_cancelled).advised()?;
    }
    if args.json {
        let moving = placed.arm.moving_rail();
        let range = moving.map(|_| found.rail_range().map(|at| 1000.0 * at));
        let listed = found.points.iter().enumerate().map(|(i, point)| {
            let joints = point.joints.map(|joints| joints.map(f64::to_degrees));
            json!({
                "index": i + 1,
                "joints_deg": joints,
                "turn_deg": point.turn.to_degrees(),
                "rail_mm": moving.map(|_| 1000.0 * point.rail),
                "problem": point.problem.as_ref().map(PointProblem::describe),
                "problem_kind": point.problem.as_ref().map(PointProblem::kind),
            })
        });
        let line = json!({
            "part": name.as_str(),
            "arm": placed.arm.name,
            "num_points": all,
            "num_reached": num,
            "num_collisions": found.num_collisions(),
            "unchecked_accelerations": placed.arm.unchecked_accelerations(),
            "base_shift_mm": base.map(|place| place.shift.map(|x| 1000.0 * x)),
            "rail_mm": rail.map(|place| 1000.0 * place.shift[0]),
            "rail_range_mm": range,
            "points": listed.collect::<Vec<_>>(),
        });
        console.line(&line);
    } else {
        show(&placed, &found, [base, rail], console);
    }
    Ok(if num == all {
        Outcome::Accepted
    } else {
        Outcome::NotAccepted
    })
}

/// Shows the result in words, and the better positions of base and rail.
fn show(
    placed: &PlacedArm,
    found: &PathCheck,
    [base, rail]: [Option<PlaceSuggestion>; 2],
    console: &mut Console,
) {
    let (num, all) = (found.num_reached(), found.points.len());
    console.line(&format_args!(
        "{} reaches {num} of {all} points",
        placed.arm.name
    ));
    if placed.arm.moving_rail().is_some() {
        let [low, high] = found.rail_range().map(|at| 1000.0 * at);
        console.line(&format_args!(
            "  its rail is between {low:.0} and {high:.0} mm"
        ));
    }
    if let Some(what) = placed.arm.unchecked_accelerations() {
        console.line(&format_args!(
            "  not checked: the acceleration of its {what}, whose limits are not known"
        ));
    }
    for (i, point) in found.points.iter().enumerate() {
        if let Some(problem) = &point.problem {
            console.line(&format_args!("  point {}: {}", i + 1, problem.describe()));
        }
    }
    let mut problems = found
        .points
        .iter()
        .filter_map(|point| point.problem.as_ref());
    if problems.any(PointProblem::is_acceleration) {
        console.line(
            &"  to do: lower the speed where it accelerates too slowly, or round the corners in a larger radius",
        );
    }
    if let Some(place) = base {
        let [x, y, z] = place.shift.map(|x| 1000.0 * x);
        let num = place.num_reached;
        console.line(&format_args!(
            "  with its base moved by {x:.0} {y:.0} {z:.0} mm it would reach {num}"
        ));
    }
    if let Some(place) = rail {
        let (at, num) = (1000.0 * place.shift[0], place.num_reached);
        console.line(&format_args!(
            "  at {at:.0} mm on its rail it would reach {num}"
        ));
    }
}
