//! What should hang there, as command line options.

use std::path::PathBuf;

use clap::{Args, builder::NonEmptyStringValueParser};

use super::console::{Advised as _, advised_error};
use geometry::error::Advice as _;
use inspection::{
    library::Library,
    pipeline::{Expected, NamedRecipe},
    rack::Rack,
};
use records::{
    history::Traceability,
    orders::{Orders, OrdersFile},
};

/// What should hang there: parts by name, or those of an order.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct ExpectChoice {
    /// The parts that should hang there, by name, such as fender,grille, or each at its place of the rack, such as
    /// "left hook=fender,right hook=grille"; a part that is given twice stands for two such parts. Another part is refused,
    /// and what is missing is said
    #[arg(long, value_name = "[PLACE=]PART,...", value_delimiter = ',', value_parser = NonEmptyStringValueParser::new(), conflicts_with = "orders")]
    expect: Vec<String>,
    /// Expect the parts of --order, or of --serial if the table has a row for it; with serve, also those of a trigger that
    /// names its order or serial number (TRIGGER ORDER=4711 SERIAL=TL-0042). The table is a CSV file with the columns order,
    /// serial (may be empty) and parts, such as fender|grille or left hook=fender|right hook=grille
    #[arg(long, value_name = "FILE")]
    orders: Option<PathBuf>,
}

impl ExpectChoice {
    /// Returns the recipe that expects these enrolled parts in this rack or wherever they hang, with a table for an order and a
    /// serial number; without any, the parts that the recipe expects itself.
    pub(super) fn applied(
        &self,
        recipe: &NamedRecipe,
        library: &Library,
        rack: Option<&Rack>,
        trace: &Traceability,
    ) -> anyhow::Result<NamedRecipe> {
        let is_enrolled = |name: &str| library.has_part(name);
        let given = self.given(rack, trace, is_enrolled)?;
        match recipe.expected_or_own(given, rack, is_enrolled) {
            Ok(expected) => Ok(recipe.expecting(expected)),
            Err(error) => Err(advised_error(
                error.of_recipe(&recipe.label.name).to_string(),
                error.advice(),
            )),
        }
    }

    /// The table of orders, if there is one, which can be read.
    pub(super) fn orders(&self) -> anyhow::Result<Option<OrdersFile>> {
        let mut file = self.orders.as_ref().map(OrdersFile::at);
        if let Some(Err(error)) = file.as_mut().map(OrdersFile::table) {
            return Err(advised_error(error.to_string(), error.advice()));
        }
        Ok(file)
    }

    fn given(
        &self,
        rack: Option<&Rack>,
        trace: &Traceability,
        is_enrolled: impl Fn(&str) -> bool,
    ) -> anyhow::Result<Expected> {
        if let Some(path) = &self.orders {
            let orders = Orders::read(path).advised()?;
            return orders.expected(trace, rack, is_enrolled).advised();
        }
        let parts = self.expect.iter().map(|text| text.as_str().into());
        Expected::new(parts.collect(), rack, is_enrolled).advised()
    }
}
