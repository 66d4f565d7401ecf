//! Inspects a file, or a simulated frame if none is given: `cargo run --release --example inspect -- FILE`.
#![expect(clippy::print_stdout, reason = "it shows what it finds")]

use std::{error::Error, path::Path};

use partsight::{
    CellSetup, Image, LibraryFolder, PartKind, Recipe, ReferenceParams, Side, Unwatched, Verdict,
    read_image, run, scene_from_image, simulated_frame,
};

fn main() -> Result<(), Box<dyn Error>> {
    let image = if let Some(path) = std::env::args().nth(1) {
        let (image, warnings) = read_image(Path::new(&path))?;
        for warning in &warnings {
            println!("note: {warning}");
        }
        image
    } else {
        let setup = CellSetup::with_part(PartKind::Fender, Side::Left, 0, 1);
        Image::Depth(simulated_frame(&setup).frame)
    };
    let scene = scene_from_image(image);
    let folder = LibraryFolder::open(Path::new("reference_parts"))?;
    let library = folder.load(&ReferenceParams::default())?.library;
    let inspection = run(&scene, &library, &Recipe::default(), &Unwatched)?;
    match &inspection.verdict {
        Verdict::Part {
            part,
            score,
            rejected,
            ..
        } => {
            println!("{part}, score {score:.2}");
            match rejected {
                None => println!("accepted"),
                Some(reason) => println!("not accepted: {reason}"),
            }
        }
        Verdict::NoPart(reason) => println!("no part: {reason}"),
    }
    if let Some(Ok(pose)) = &inspection.pose {
        println!(
            "camera_from_part:{}",
            pose.camera_from_part().to_homogeneous()
        );
    }
    Ok(())
}
