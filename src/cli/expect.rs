//! What should hang there, as command line options.

use std::path::PathBuf;

use clap::{Args, builder::NonEmptyStringValueParser};

use super::console::Advised as _;
use inspection::{library::Library, pipeline::Expected};
use records::{history::Traceability, orders::Orders};

/// What should hang there: parts by name, or those of an order.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct ExpectChoice {
    /// The parts that should hang there, by name, such as fender,grille; a name that is given twice stands for two such
    /// parts. Another part is refused, and what is missing is said
    #[arg(long, value_name = "PART,...", value_delimiter = ',', value_parser = NonEmptyStringValueParser::new(), conflicts_with = "orders")]
    expect: Vec<String>,
    #[command(flatten)]
    orders: OrdersChoice,
}

impl ExpectChoice {
    /// Returns what is expected of these enrolled parts.
    pub(super) fn of(&self, library: &Library, trace: &Traceability) -> anyhow::Result<Expected> {
        if self.expect.is_empty() {
            return self.orders.of(library, trace);
        }
        Expected::new(self.expect.clone(), |name| library.has_part(name)).advised()
    }
}

/// The table that says what should hang there for an order.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct OrdersChoice {
    /// Expect the parts of --order, or of --serial if the table has a row for it. The table is a CSV file with the columns
    /// order, serial (may be empty) and parts, such as fender|grille
    #[arg(long, value_name = "FILE")]
    orders: Option<PathBuf>,
}

impl OrdersChoice {
    /// Returns what is expected of these enrolled parts for an order and a serial number; nothing without a table.
    pub(super) fn of(&self, library: &Library, trace: &Traceability) -> anyhow::Result<Expected> {
        let Some(path) = &self.orders else {
            return Ok(Expected::default());
        };
        let orders = Orders::read(path).advised()?;
        let expected = orders.expected(trace, |name| library.has_part(name));
        expected.advised()
    }
}
