//! Follows a source of captures and inspects three of them: `cargo run --release --example follow -- watch:incoming`.
#![expect(clippy::print_stdout, reason = "it shows what it finds")]

use std::{error::Error, path::Path, time::Duration};

use partsight::{
    LibraryFolder, NextCapture, Recipe, ReferenceParams, SourceSpec, Unwatched, open_source, run,
    scene_from_image,
};

fn main() -> Result<(), Box<dyn Error>> {
    let spec: SourceSpec = std::env::args()
        .nth(1)
        .unwrap_or_else(|| "simulated:fender".into())
        .parse()?;
    let folder = LibraryFolder::open(Path::new("reference_parts"))?;
    let library = folder.load(&ReferenceParams::default())?.library;
    let mut source = open_source(&spec)?;
    let mut num_inspected = 0;
    while num_inspected < 3 {
        match source.next(Duration::from_secs(1))? {
            NextCapture::Captured(captured) => {
                let scene = scene_from_image(captured.image);
                let found = run(&scene, &library, &Recipe::default(), &Unwatched)?;
                println!("{}: {:?}", captured.name, found.verdict);
                num_inspected += 1;
            }
            NextCapture::Skipped(skipped) => println!("{skipped:?}"),
            NextCapture::NotYet => {}
            NextCapture::End => break,
        }
    }
    Ok(())
}
