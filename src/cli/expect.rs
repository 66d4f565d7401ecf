//! What should hang there, as command line options.

use clap::Args;

use super::console::advised_error;
use inspection::{library::Library, pipeline::Expected};
use stages::segment::MAX_PARTS;

/// What should hang there.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct ExpectChoice {
    /// The parts that should hang there, by name, such as fender,grille; a name that is given twice stands for two such
    /// parts. Another part is refused, and what is missing is said
    #[arg(long, value_name = "PART,...", value_delimiter = ',')]
    expect: Vec<String>,
}

impl ExpectChoice {
    /// Returns what is expected of these enrolled parts.
    pub(super) fn of(&self, library: &Library) -> anyhow::Result<Expected> {
        if self.expect.len() > MAX_PARTS {
            return Err(advised_error(
                format!("{} parts are expected", self.expect.len()),
                format!("Expect up to {MAX_PARTS} parts in a frame"),
            ));
        }
        for name in &self.expect {
            if !library.references.iter().any(|part| part.name == *name) {
                return Err(advised_error(
                    format!("{name} is expected, but not enrolled"),
                    "Give names that partsight library list shows, separated by commas",
                ));
            }
        }
        Ok(Expected::new(self.expect.clone()))
    }
}
