//! What should hang there, as command line options.

use clap::{Args, builder::NonEmptyStringValueParser};

use super::console::Advised as _;
use inspection::{library::Library, pipeline::Expected};

/// What should hang there.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct ExpectChoice {
    /// The parts that should hang there, by name, such as fender,grille; a name that is given twice stands for two such
    /// parts. Another part is refused, and what is missing is said
    #[arg(long, value_name = "PART,...", value_delimiter = ',', value_parser = NonEmptyStringValueParser::new())]
    expect: Vec<String>,
}

impl ExpectChoice {
    /// Returns what is expected of these enrolled parts.
    pub(super) fn of(&self, library: &Library) -> anyhow::Result<Expected> {
        Expected::new(self.expect.clone(), library).advised()
    }
}
