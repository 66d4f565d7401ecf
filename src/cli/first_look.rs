//! `partsight` alone without a display: inspects a frame of the simulated cell, so that a first call shows something.

use std::sync::Arc;

use super::{
    LibraryChoice, Outcome,
    console::{Console, Table},
    verdict::show_card,
};
use inspection::pipeline::{self, NamedRecipe, Unwatched};
use simulate::{CellSetup, PartKind, PartPose, PoseRange, Side, frame};
use stages::{reference::ReferenceParams, scene::scene_from_frame};
use station::{Inspected, Subject};

/// Seed of the frame.
const SEED: u64 = 1;

pub(super) fn run(library: &LibraryChoice, console: &mut Console) -> anyhow::Result<Outcome> {
    let load = library.load_some(&ReferenceParams::default(), console)?;
    let mut setup = CellSetup::with_part(PartKind::FrontDoor, Side::Left, 0, SEED);
    setup.pose = PartPose::Drawn(PoseRange::facing());
    let scene = Arc::new(scene_from_frame(&frame(&setup).frame));
    let recipe = NamedRecipe::default();
    let inspection = pipeline::run(&scene, &load.library, &recipe, &Unwatched)?;
    let name = "simulated cell";
    let inspected = Inspected {
        subject: &Subject::of_scene(name.into(), name.into(), true),
        scene: &scene,
        inspection: &inspection,
        recipe: &recipe,
        robot: None,
        is_forced: false,
        on_line: None,
    };
    console.line(&"Simulated: no camera was read. A front door hangs in the simulated cell; this is what was found.");
    console.line(&"");
    show_card(name, &inspected, &load.library, console);
    console.line(&"");
    console.line(&"Next:");
    let mut table = Table::default();
    for (command, what) in [
        (
            "partsight inspect FILE...",
            "recognise the part in your own captures",
        ),
        (
            "partsight enrol FILE --name NAME",
            "enrol a part of your own",
        ),
        ("partsight library list", "see what is enrolled"),
        (
            "partsight simulate --part fender --out fender.pcd",
            "make a capture to try",
        ),
        ("partsight help", "everything else"),
    ] {
        table.row([format!("  {command}"), what.to_owned()]);
    }
    console.table(&table);
    // This is only a demonstration: whatever the verdict, it succeeded.
    Ok(Outcome::Accepted)
}
