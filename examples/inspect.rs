//! Inspects a file, or a simulated frame if none is given: `cargo run --release --example inspect -- FILE`.
#![expect(clippy::print_stdout, reason = "it shows what it finds")]

use std::{error::Error, path::Path};

use partsight::{
    CellSetup, FileContent, LibraryFolder, PartKind, Recipe, ReferenceParams, SceneCloud, Side,
    Unwatched, Verdict, open_file, run, scene_from_cloud, scene_from_frame, simulated_frame,
};

fn scene_of(path: &str) -> Result<SceneCloud, Box<dyn Error>> {
    match open_file(Path::new(path))? {
        FileContent::Depth(frame) => Ok(scene_from_frame(&frame)),
        FileContent::Cloud(cloud) => Ok(scene_from_cloud(cloud)),
        FileContent::Mesh(_) => Err("a mesh is not a capture".into()),
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let scene = if let Some(path) = std::env::args().nth(1) {
        scene_of(&path)?
    } else {
        let setup = CellSetup::with_part(PartKind::Fender, Side::Left, 0, 1);
        scene_from_frame(&simulated_frame(&setup).frame)
    };
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
