//! `partsight` alone without a display: inspects a frame of the simulated cell, so that a first call shows something.

use super::{
    LibraryChoice, Outcome,
    console::{Console, Table},
    verdict::show_card,
};
use inspection::pipeline::{self, Recipe, Unwatched};
use simulate::{CellSetup, PartKind, PartPose, PoseRange, Side, frame};
use stages::{reference::ReferenceParams, scene::scene_from_frame};

/// Seed of the frame.
const SEED: u64 = 1;

pub(super) fn run(library: &LibraryChoice, console: &mut Console) -> anyhow::Result<Outcome> {
    let load = library.load_some(&ReferenceParams::default(), console)?;
    let mut setup = CellSetup::with_part(PartKind::FrontDoor, Side::Left, 0, SEED);
    setup.pose = PartPose::Drawn(PoseRange::facing());
    let scene = scene_from_frame(&frame(&setup).frame);
    let inspection = pipeline::run(&scene, &load.library, &Recipe::default(), &Unwatched)?;
    console.line(&"Simulated: no camera was read. A front door hangs in the simulated cell; this is what was found.");
    console.line(&"");
    show_card("simulated cell", &inspection, &load.library, console);
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
