//! The recipe, as command line options.

use std::sync::Arc;

use clap::Args;

use super::{
    console::{Advised as _, Console, advised_error, with_advice},
    input::{Choice, choice},
};
use inspection::pipeline::{
    BUILT_IN, NamedRecipe, PoseChoice, Recipe, RecipeFile, RecipeFolder, RecipeLabel,
    built_in_recipe, open_recipe,
    parameters::{Parameters, Setting},
};
use stages::{pose::PoseMethod, rank::Matcher};

/// The recipe of an inspection.
#[derive(Clone, Debug, Args)]
pub(super) struct RecipeChoice {
    #[command(flatten)]
    from: RecipeSource,
    /// How the enrolled parts are ranked; default: as in the recipe
    #[arg(long, value_parser = choice(&MATCHERS))]
    matcher: Option<Matcher>,
    /// How the pose is found; default: as in the recipe
    #[arg(long, value_parser = choice(&POSES))]
    pose: Option<PoseChoice>,
}

#[rustfmt::skip]
const MATCHERS: [Choice<Matcher>; 2] = [
    ("default", "Circular correlation of the outlines in metres, overlap, and the fit of the pose", Matcher::Default),
    ("paper", "The paper's Algorithm 2, literally", Matcher::Paper),
];

#[rustfmt::skip]
const POSES: [Choice<PoseChoice>; 4] = [
    ("global", "From any start; also confirms which part it is", PoseChoice::By(PoseMethod::Global)),
    ("icp", "The paper's iterative closest point, from the standard position", PoseChoice::By(PoseMethod::Icp)),
    ("icp-ga", "The paper's ICP-GA: ICP and a genetic algorithm in turns, from the standard position", PoseChoice::By(PoseMethod::IcpGa)),
    ("none", "No pose: the verdict rests on the outline alone", PoseChoice::Skip),
];

impl RecipeChoice {
    /// Returns the recipe with the requested changes.
    pub(super) fn recipe(&self) -> anyhow::Result<NamedRecipe> {
        Ok(self.changed(&self.from.file()?))
    }

    /// Returns the recipe's file, and the recipe with the requested changes.
    pub(super) fn file(&self) -> anyhow::Result<(RecipeFile, NamedRecipe)> {
        let file = self.from.file()?;
        let recipe = self.changed(&file);
        Ok((file, recipe))
    }

    fn changed(&self, file: &RecipeFile) -> NamedRecipe {
        self.from.changed(file, |recipe| {
            recipe.rank.matcher = self.matcher.unwrap_or(recipe.rank.matcher);
            recipe.pose = self.pose.unwrap_or(recipe.pose);
        })
    }
}

/// A recipe, and parameters that are given another value.
#[derive(Clone, Debug, Default, Args)]
pub struct RecipeSource {
    /// Recipe, by name (partsight recipe list) or as a file; default: your default recipe
    #[arg(long, value_name = "NAME|FILE")]
    recipe: Option<String>,
    #[arg(long, value_name = "NAME=VALUE", value_parser = parse_setting::<Recipe>, help = SET_HELP)]
    set: Vec<Setting>,
}

const SET_HELP: &str = "Set a parameter, in its own unit, such as segment.plane_distance=12; may be given \
    several times. docs/guide/parameters.md lists names, units and ranges";

impl RecipeSource {
    /// Returns the recipe; by default the user's default one.
    pub(super) fn recipe(&self) -> anyhow::Result<NamedRecipe> {
        Ok(self.changed(&self.file()?, |_| ()))
    }

    /// Returns the recipe; by default the built-in one, even if the user has another default.
    pub fn recipe_or_built_in(&self) -> anyhow::Result<NamedRecipe> {
        let file = open_named(Some(self.recipe.as_deref().unwrap_or(BUILT_IN)))?;
        Ok(self.changed(&file, |_| ()))
    }

    fn file(&self) -> anyhow::Result<RecipeFile> {
        open_named(self.recipe.as_deref())
    }

    /// Applies `change`, and then the values of `--set` in the given order.
    fn changed(&self, file: &RecipeFile, change: impl FnOnce(&mut Recipe)) -> NamedRecipe {
        let mut recipe = file.recipe.clone();
        change(&mut recipe);
        for setting in &self.set {
            setting.apply(&mut recipe);
        }
        NamedRecipe {
            label: RecipeLabel {
                name: file.name.to_string(),
                is_changed: recipe != file.recipe,
            },
            parameters: Arc::new(recipe),
        }
    }
}

/// Opens a recipe by its name or as a file; without either, the user's default.
pub(super) fn open_named(given: Option<&str>) -> anyhow::Result<RecipeFile> {
    let file = open_recipe(RecipeFolder::of_user(), given).advised()?;
    // Its results would pass for those of the program's own recipe.
    if built_in_recipe(file.name.as_str()).is_some_and(|own| own != file.recipe) {
        return Err(advised_error(
            format!(
                "{}: {} is the name of the program's own recipe, which has other parameters",
                given.unwrap_or_default(),
                file.name
            ),
            "Give the recipe another name in the file, for example name = \"glossy\"",
        ));
    }
    Ok(file)
}

/// Shows the name of the recipe, unless it is the built-in one.
pub fn show_recipe(recipe: &NamedRecipe, console: &mut Console) {
    if recipe.label != RecipeLabel::default() {
        let text = format!("{}, {}", recipe.label, recipe.identity());
        console.entry("recipe", &text);
    }
}

pub(super) fn parse_setting<R: Parameters>(text: &str) -> Result<Setting<R>, String> {
    let setting = text.parse::<Setting<R>>();
    setting.map_err(|error| with_advice(&error))
}
