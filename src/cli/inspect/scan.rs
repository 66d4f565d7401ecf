//! `partsight inspect --scan`: one verdict from several frames.

use std::slice;

use super::InspectArgs;
use crate::cli::{
    Outcome,
    console::{Advised as _, Console},
    output::OutputFormat,
    scan::open_scan,
};
use inspection::pipeline::{
    Unwatched,
    scan::{ScanInspection, run_scan},
};
use records::history::HungId;
use robot::{FrameName, RobotFrame};
use stages::scan::part::require_two_to_show_part;
use station::{Inspected, Subject};

pub(super) fn inspect(args: &InspectArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let recipe = args.recipe.recipe()?;
    let trace = args.trace.of_parts(Some(1))?;
    let database = args.recording.database(console)?;
    let load = (args.library).load_some(&recipe.reference_params(), console)?;
    let recipe = (args.expect).applied(&recipe, &load.library, None, &trace)?;
    let (scan, captured_at) = open_scan(&args.scan, &args.poses, &recipe.segment, console)?;
    require_two_to_show_part(&scan).advised()?;
    let recording = (args.recording).start(&load, &trace, database, console)?;
    let ScanInspection {
        inspection,
        first: place,
        ..
    } = run_scan(&scan, &load.library, &recipe, &Unwatched)?;
    let first = &scan.shots[place];
    let (frames, used) = (scan.shots.len(), scan.used().count());
    // The poses of the scan contain the pose of that camera.
    let robot = RobotFrame {
        robot_from_camera: first.base_from_camera,
        name: FrameName::OfScan,
    };
    let scene = match args.scan.as_slice() {
        [one] => one.display().to_string(),
        _ => format!("{frames} frames from {}", first.name),
    };
    let is_simulated = scan.cloud.cloud.is_simulated;
    let subject = Subject::of_scene(scene, "scan".into(), is_simulated)
        .captured_at(captured_at)
        .with_scan(&scan, place);
    let inspected = Inspected {
        subject: &subject,
        scene: &first.scene,
        inspection: &inspection,
        recipe: &recipe,
        robot: Some(&robot),
        is_forced: args.carried.is_forced(),
        on_line: None,
    };
    let title = format!(
        "{}, {used} of {frames} frames, as seen from {}",
        subject.scene, first.name
    );
    let format = if args.json {
        OutputFormat::Json
    } else {
        OutputFormat::Card
    };
    let line = Inspected::line_of_all(&[inspected], &trace);
    format.inspected(&title, &line, &[inspected], &load.library, console);
    // Last, so that the verdict does not wait for it.
    if let Some(mut recording) = recording {
        recording.add(recording.entry(&inspected, HungId::new()), console);
        recording.finish(console);
    }
    Ok(Outcome::accepted_if(
        recipe.is_met(slice::from_ref(&inspection)),
    ))
}
