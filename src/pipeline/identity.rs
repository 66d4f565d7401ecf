//! The identity of a recipe: a checksum of its parameters.

use super::Recipe;
use crate::files::crc32;

impl Recipe {
    /// Returns eight hexadecimal digits that depend on all parameters: the CRC-32 of the recipe as JSON, in the order
    /// of its fields. Collisions are unlikely, but nothing prevents forgery. A version of the program that adds a
    /// parameter gives another identity.
    pub fn identity(&self) -> String {
        let json = serde_json::to_vec(self).expect("numbers and names have a JSON form");
        format!("{:08x}", crc32(&json))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{pipeline::PoseChoice, units::Metres};

    #[test]
    fn the_same_recipe_has_the_same_identity_and_another_another() {
        let recipe = Recipe::default();
        assert_eq!(recipe.identity(), Recipe::default().identity());
        assert!(
            recipe.identity().len() == 8
                && recipe.identity().bytes().all(|c| c.is_ascii_hexdigit())
        );
        let mut others: Vec<Recipe> = vec![Recipe::default(); 4];
        others[0].accept.min_score += 1e-15;
        others[1].stand_off.taught = Metres(0.151);
        others[2].pose = PoseChoice::Skip;
        others[3].icp_ga.seed += 1;
        let mut all: Vec<String> = others.iter().map(Recipe::identity).collect();
        all.push(recipe.identity());
        all.sort();
        all.dedup();
        assert_eq!(all.len(), 5);
    }

    #[test]
    fn a_recipe_that_was_saved_and_read_again_keeps_its_identity() {
        let recipe = Recipe::default();
        let json = serde_json::to_string(&recipe).expect("JSON");
        let read: Recipe = serde_json::from_str(&json).expect("a recipe");
        assert_eq!(read.identity(), recipe.identity());
    }
}
