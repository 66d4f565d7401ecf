//! The recipe, as options.

use clap::{Args, ValueEnum};

use crate::{
    error::Advice as _,
    pipeline::{
        PoseChoice, Recipe,
        parameters::{Kind, Parameter, Setting, changed},
    },
    stages::{pose::PoseMethod, rank::Matcher},
};

/// The parts of a recipe that the command line can change.
#[derive(Clone, Debug, Args)]
pub(super) struct RecipeChoice {
    /// What ranks the enrolled parts
    #[arg(long, value_enum, default_value_t = MatcherChoice::Default)]
    matcher: MatcherChoice,
    /// What finds the pose
    #[arg(long, value_enum, default_value_t = PoseArg::Global)]
    pose: PoseArg,
    #[command(flatten)]
    set: Settings,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum MatcherChoice {
    /// Circular correlation of the outlines in metres, overlap, and the fit of the pose
    Default,
    /// The paper's Algorithm 2, literally
    Paper,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum PoseArg {
    /// From any start; also confirms which part it is
    Global,
    /// The paper's iterative closest point, from the standard position
    Icp,
    /// The paper's ICP-GA: ICP and a genetic algorithm in turns, from the standard position
    IcpGa,
    /// No pose: the verdict rests on the outline alone
    None,
}

impl RecipeChoice {
    /// The default recipe with what is asked for.
    pub(super) fn recipe(&self) -> Recipe {
        let mut recipe = Recipe::default();
        recipe.rank.matcher = match self.matcher {
            MatcherChoice::Default => Matcher::Default,
            MatcherChoice::Paper => Matcher::Paper,
        };
        recipe.pose = match self.pose {
            PoseArg::Global => PoseChoice::By(PoseMethod::Global),
            PoseArg::Icp => PoseChoice::By(PoseMethod::Icp),
            PoseArg::IcpGa => PoseChoice::By(PoseMethod::IcpGa),
            PoseArg::None => PoseChoice::Skip,
        };
        self.set.apply(&mut recipe);
        recipe
    }
}

/// Parameters that are given another value than the default.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct Settings {
    #[arg(long, value_name = "NAME=VALUE", value_parser = parse_setting, help = SET_HELP)]
    set: Vec<Setting>,
}

const SET_HELP: &str = "Give a parameter another value, in its own unit, such as segment.plane_distance=12; may be given \
    several times. docs/guide/parameters.md lists names, units and ranges";

impl Settings {
    /// True if all parameters keep their values.
    pub(super) fn is_empty(&self) -> bool {
        self.set.is_empty()
    }

    /// Changes the recipe, in the order given.
    pub(super) fn apply(&self, recipe: &mut Recipe) {
        for setting in &self.set {
            setting.apply(recipe);
        }
    }
}

fn parse_setting(text: &str) -> Result<Setting, String> {
    let setting = text.parse::<Setting>();
    setting.map_err(|error| format!("{error}\n  to do: {}", error.advice()))
}

/// The parameters that differ from the default, but for these, as `--set` takes them.
pub(super) fn changed_parameters(recipe: &Recipe, left_out: &[&str]) -> Vec<String> {
    let listed = changed(recipe).filter(|parameter| !left_out.contains(&parameter.key));
    listed
        .map(|parameter| match &parameter.kind {
            // All digits, so that it can be set again.
            Kind::Number(number) => {
                let value = parameter.value(recipe);
                format!("{}={value}{}", parameter.key, number.unit.sign())
            }
            Kind::Choice(_) => format!("{}={}", parameter.key, parameter.text(recipe)),
        })
        .collect()
}

/// Matcher and pose, as `--matcher` and `--pose` take them.
pub(super) fn matcher_and_pose(recipe: &Recipe) -> [String; 2] {
    NAMED.map(|key| {
        let parameter = Parameter::of_key(key).expect("a parameter of the recipe");
        parameter.text(recipe).to_lowercase()
    })
}

/// Parameters with an option of their own.
pub(super) const NAMED: [&str; 2] = ["rank.matcher", "pose"];
