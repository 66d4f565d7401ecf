use std::path::Path;

use super::*;
use crate::{library::LibraryFolder, stages::reference::ReferenceParams};

#[test]
fn the_shipped_parts_are_painted_within_tolerance() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference_parts");
    let folder = LibraryFolder::open(&folder).expect("opened");
    let load = folder.load(&ReferenceParams::default()).expect("loaded");
    assert_eq!(load.parts.len(), 8);
    let mut num_good = 0;
    for (reference, part) in load.library.references.iter().zip(&load.parts) {
        let surface = PaintSurface::of(reference, part.coverage).expect("a surface");
        let found = propose(&surface, &Coat::default(), &[]).expect(&reference.name);
        let film = &found.film.figures;
        assert!(film.within >= 0.9, "{}: {film:?}", reference.name);
        num_good += usize::from(film.within >= 0.95);
    }
    // Ribs of the grille and the radiator support have flanks that the smoothed gun does not face.
    assert_eq!(num_good, 6);
}
