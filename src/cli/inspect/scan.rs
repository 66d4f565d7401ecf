//! `partsight inspect --scan`: one verdict from several frames.

use super::InspectArgs;
use crate::cli::{
    Outcome,
    console::{Advised as _, Console},
    recipe::show_recipe,
    record::{HistoryRecorder, SceneOrigin},
    scan::open_scan,
    verdict::{show_card, show_in_robot},
};
use geometry::rigid::row_major;
use inspection::pipeline::{
    Unwatched,
    scan::{ScanInspection, run_scan},
};
use records::{
    history::HungId,
    report::{InspectionLine, ScanLine},
};
use robot::RobotFrame;
use stages::scan::part::require_two_to_show_part;

pub(super) fn inspect(args: &InspectArgs, console: &mut Console) -> anyhow::Result<Outcome> {
    let recipe = args.recipe.recipe()?;
    let trace = args.trace.of_parts(Some(1))?;
    #[cfg(feature = "plant")]
    let database = args.history_to.chosen(console)?;
    let load = (args.library).load_some(&recipe.reference_params(), console)?;
    let scan = open_scan(&args.scan, &args.poses, &recipe.segment, console)?;
    require_two_to_show_part(&scan).advised()?;
    let recording = (!args.no_history)
        .then(|| HistoryRecorder::start(&args.history, &load, &recipe, &trace, console))
        .flatten();
    #[cfg(feature = "plant")]
    let recording = recording
        .map(|recording| recording.sent_to(database))
        .transpose()?;
    let ScanInspection {
        inspection,
        first,
        base_from_part,
        ..
    } = run_scan(&scan, &load.library, &recipe, &Unwatched)?;
    let first = &scan.shots[first];
    let (frames, used) = (scan.shots.len(), scan.used().count());
    // The poses of the scan contain the pose of that camera.
    let robot = RobotFrame {
        robot_from_camera: first.base_from_camera,
        name: "the poses of the scan".into(),
    };
    let scene = match args.scan.as_slice() {
        [one] => one.display().to_string(),
        _ => format!("{frames} frames from {}", first.name),
    };
    let is_accepted = inspection.verdict.is_accepted();
    let line = InspectionLine::of(&scene, &inspection)
        .by(&recipe)
        .traced(&trace)
        .in_robot(Some(&robot), &inspection);
    let line = line.of_scan(ScanLine {
        frames,
        used,
        reference_frame: &first.name,
        base_from_part: base_from_part
            .filter(|_| is_accepted)
            .map(|pose| row_major(&pose)),
    });
    let line = line.to_json();
    if args.json {
        console.line(&line);
    } else {
        let title = format!(
            "{scene}, {used} of {frames} frames, as seen from {}",
            first.name
        );
        show_card(&title, &inspection, &load.library, console);
        show_recipe(&recipe, console);
        show_in_robot(&robot, &inspection, &load.library, console);
    }
    // Last, so that the verdict does not wait for it.
    if let Some(mut recording) = recording {
        let taken = SceneOrigin {
            scene: &scene,
            source: "scan",
            is_simulated: scan.cloud.cloud.is_simulated,
        };
        let entry = recording.entry(taken, &first.scene, &inspection, &line, HungId::new());
        recording.add(entry.of_scan(scan.given()), console);
        recording.finish(console);
    }
    Ok(Outcome::accepted_if(is_accepted))
}
