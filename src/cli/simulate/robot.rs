//! `partsight simulate --robot PROTOCOL=ADDRESS`: an arm with a camera and its controller, for another program to servo.

use std::{net::TcpListener, path::Path};

use serde_json::json;

use super::{SimulateArgs, check_outputs_differ};
use crate::cli::{
    LibraryChoice, Outcome,
    console::{Advised as _, Console, advised_error},
    interrupt::Interrupt,
    write_json,
};
use capture::SourceSpec;
use geometry::{error::Advice as _, oriented_box::OrientedBox, rigid::RigidTransform};
use robot::{
    Convention, RobotValue,
    calibration::{CellCalibration, Origin},
};
use servo::simulated::SimulatedCell;
use simulate::SimulatedObject;
use stages::reference::ReferenceParams;
use station::servoing::{RobotAddress, SimulatedRobot, serve_robot};

pub(super) fn run(
    robot: &RobotAddress,
    calibration: &Path,
    args: &SimulateArgs,
    console: &mut Console,
) -> anyhow::Result<Outcome> {
    let subjects = args.subjects();
    let [SimulatedObject::Part { kind, .. }] = subjects[..] else {
        return Err(advised_error(
            "a robot's camera looks at one part",
            "Give one, for example --part fender",
        ));
    };
    check_outputs_differ(args, calibration)?;
    let library = LibraryChoice { library: None };
    let load = library.load_some(&ReferenceParams::default(), console)?;
    let trial = args.arm.trial(args.seed);
    let cell = trial.arrange(kind.name(), &load.library).advised()?;
    calibration_of(&cell).save(calibration).advised()?;
    let interrupt = Interrupt::listen()?;
    let camera = TcpListener::bind(args.camera).map_err(|error| {
        advised_error(
            format!("the camera cannot listen at {}: {error}", args.camera),
            "End the program that listens there, or give another port with --camera",
        )
    })?;
    let source = SourceSpec::SimulatedRobot(camera.local_addr()?);
    let controller = cell.controller(robot.protocol());
    let (arm, robot) = SimulatedRobot::start_at(controller, robot).advised()?;
    args.arm.announce(console);
    console.line(&format_args!(
        "partsight servo {} --source {source} --robot {robot} --calibration {} {}",
        kind.name(),
        quoted(&calibration.display().to_string()),
        options(&cell),
    ));
    let outcome = serve_robot(arm, &cell, &camera, || interrupt.came())?;
    let left = &outcome.true_error;
    let end = outcome.end.transpose();
    let why = end.as_ref().err().map(ToString::to_string);
    let has_arrived = matches!(end, Ok(Some(())));
    if let Some(path) = &args.truth {
        write_json(
            path,
            &json!({
                "simulated": true,
                "arrived": has_arrived,
                "reason": why,
                "error_m": left.shift.0,
                "error_rad": left.rotation.0,
            }),
        )?;
    }
    match &end {
        Ok(Some(())) => console.line(&"The robot's program has ended at its target"),
        Ok(None) => console.line(&"Ended before the robot's program"),
        Err(end) => {
            console.line(end);
            console.entry("to do", &end.advice());
        }
    }
    console.note(&format_args!(
        "True error at the end: {:.2} mm, {:.3}°",
        left.shift.mm(),
        left.rotation.degrees()
    ));
    Ok(Outcome::accepted_if(has_arrived))
}

/// The calibration as the other program knows it, which is wrong.
fn calibration_of(cell: &SimulatedCell<'_>) -> CellCalibration {
    CellCalibration {
        name: String::new(),
        notes: "Of the camera of a simulated robot; wrong by as much as was asked for".to_owned(),
        camera: cell.task.camera,
        origin: Origin::ByHand,
        made_at: geometry::clock::now(),
    }
}

/// Arm, nozzle and work volume, as options of `servo`.
fn options(cell: &SimulatedCell<'_>) -> String {
    let pose = |pose: &RigidTransform| {
        let written = Convention::Kuka.write(pose);
        let numbers: Vec<String> = written.values.iter().map(RobotValue::rounded).collect();
        quoted(&format!(
            "{} {}",
            Convention::Kuka.name(),
            numbers.join(" ")
        ))
    };
    let placed = cell.placed_arm();
    let volume = cell.fence.volume.map(|volume| {
        let OrientedBox {
            centre_m, size_m, ..
        } = volume;
        let corner = |side: f64| {
            [0, 1, 2].map(|i| format!("{:.1}", 1000.0 * (centre_m[i] + side * 0.5 * size_m[i])))
        };
        let corners = [corner(-1.0), corner(1.0)].concat().join(",");
        format!(" --volume {corners}")
    });
    format!(
        "--arm {} --base {} --nozzle {}{}",
        servo::simulated::ARM,
        pose(&placed.robot_from_base),
        pose(&placed.flange_from_nozzle),
        volume.unwrap_or_default(),
    )
}

/// A text as one word of a command line.
fn quoted(text: &str) -> String {
    if text.contains(' ') {
        format!("\"{text}\"")
    } else {
        text.to_owned()
    }
}
