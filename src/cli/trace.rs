//! Traceability (serial number, order and operator), as command line options.

use clap::Args;

use super::console::advised_error;
use records::history::Traceability;

/// What an inspection is traced by.
#[derive(Clone, Debug, Default, Args)]
pub(super) struct TraceChoice {
    /// Serial number or barcode of the part, for history and reports
    #[arg(long, value_name = "TEXT")]
    serial: Option<String>,
    /// Production order, for history and reports
    #[arg(long, value_name = "TEXT")]
    order: Option<String>,
    /// Name of the operator, for history and reports
    #[arg(long, value_name = "NAME")]
    operator: Option<String>,
}

impl TraceChoice {
    /// Returns the given entries; `num_parts` is `None` if the number of parts is unknown.
    pub(super) fn of_parts(&self, num_parts: Option<usize>) -> anyhow::Result<Traceability> {
        let text = |given: &Option<String>| {
            let given = given.as_deref().unwrap_or_default();
            Traceability::cleaned(given)
        };
        let trace = Traceability {
            serial: text(&self.serial),
            order: text(&self.order),
            operator: text(&self.operator),
        };
        if !trace.serial.is_empty() && num_parts != Some(1) {
            return Err(advised_error(
                "--serial names one part, but several are inspected",
                "Inspect one file at a time, or leave --serial out",
            ));
        }
        Ok(trace)
    }
}
