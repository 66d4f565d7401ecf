//! Which matcher and which way to the pose, as options.

use clap::{Args, ValueEnum};

use crate::{
    pipeline::{PoseChoice, Recipe},
    stages::{pose::PoseMethod, rank::Matcher},
};

/// The parts of a recipe that the command line can change.
#[derive(Clone, Copy, Debug, Args)]
pub(super) struct RecipeChoice {
    /// What ranks the enrolled parts
    #[arg(long, value_enum, default_value_t = MatcherChoice::Default)]
    matcher: MatcherChoice,
    /// What finds the pose
    #[arg(long, value_enum, default_value_t = PoseArg::Global)]
    pose: PoseArg,
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
    /// The recipe: the default but for the two.
    pub(super) fn recipe(self) -> Recipe {
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
        recipe
    }

    /// Matcher and pose, as they are given.
    pub(super) fn names(self) -> [&'static str; 2] {
        let matcher = match self.matcher {
            MatcherChoice::Default => "default",
            MatcherChoice::Paper => "paper",
        };
        let pose = match self.pose {
            PoseArg::Global => "global",
            PoseArg::Icp => "icp",
            PoseArg::IcpGa => "icp-ga",
            PoseArg::None => "none",
        };
        [matcher, pose]
    }
}
