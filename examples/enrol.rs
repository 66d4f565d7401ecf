//! Enrols a part from one capture, and recognises it in another.
#![expect(clippy::print_stdout, reason = "it shows what it finds")]
#![expect(
    clippy::disallowed_methods,
    reason = "a wrong clock may end an example"
)]

use std::error::Error;

use jiff::Timestamp;
use partsight::{
    CellSetup, EnrolParams, Image, LibraryFolder, PartDescription, PartKind, PartName, Recipe,
    ReferenceParams, SceneCloud, Side, Unwatched, enrol_captured, run, scene_from_image,
    simulated_frame,
};

/// A right front door at a pose drawn from a seed.
fn capture(seed: u64) -> SceneCloud {
    let setup = CellSetup::with_part(PartKind::FrontDoor, Side::Right, 0, seed);
    scene_from_image(Image::Depth(simulated_frame(&setup).frame))
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let library = LibraryFolder::open_or_create(folder.path())?;
    let about = PartDescription {
        name: PartName::new("door_right")?,
        title: "Front door, right".into(),
        notes: String::new(),
        from: "simulated frame 1".into(),
        at: Timestamp::now(),
        simulated: true,
    };
    let enrolled = enrol_captured(&capture(1), &about, &EnrolParams::default())?;
    for warning in &enrolled.warnings {
        println!("note: {warning}");
    }
    library.save(&enrolled.part)?;

    let loaded = library.load(&ReferenceParams::default())?;
    let found = run(&capture(2), &loaded.library, &Recipe::default(), &Unwatched)?;
    println!("{:?}", found.verdict);
    Ok(())
}
