//! The coats that come with the program.

use std::path::Path;

use super::Coat;
use crate::pipeline::RecipeFile;

/// Names and files of the program's own coats.
const FILES: [(&str, &str); 3] = [
    ("primer", include_str!("../../../assets/coats/primer.toml")),
    (
        "base_coat",
        include_str!("../../../assets/coats/base_coat.toml"),
    ),
    (
        "clear_coat",
        include_str!("../../../assets/coats/clear_coat.toml"),
    ),
];

/// Names of the program's own coats, in the order they are sprayed.
pub const BUILT_IN_COATS: [&str; 3] = [FILES[0].0, FILES[1].0, FILES[2].0];

/// The program's own coat of this name.
pub(super) fn built_in(name: &str) -> Option<RecipeFile<Coat>> {
    let (_, text) = FILES.iter().find(|(own, _)| *own == name)?;
    Some(RecipeFile::parse(Path::new(name), text).expect("a test reads every built-in coat"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_coat_is_read_under_its_name_and_nearly_reaches_its_target() {
        for name in BUILT_IN_COATS {
            let coat = built_in(name).expect("built in");
            assert_eq!(coat.name.as_str(), name);
            assert!(coat.notes.len() > 20);
            let film = coat.recipe.flat_thickness() / coat.recipe.target;
            assert!((film - 1.0).abs() < 0.1, "{name}: {film}");
        }
    }
}
