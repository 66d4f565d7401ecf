//! Traceability: data of the plant about a part, besides those of the camera.

use serde::{Deserialize, Serialize};

/// Which part an inspection is of, for which order, and who made it. What is not known is empty.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(default)]
pub struct Traceability {
    /// Serial number or content of the barcode; of this part alone.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub serial: String,
    /// The production order.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub order: String,
    /// Name of the operator.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub operator: String,
}

/// A change of a part's traceability after its verdict.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TraceChange {
    /// Fill these entries where they are empty.
    Fill(Traceability),
    /// Set these entries, except the empty ones: they are known better now.
    Set(Traceability),
    /// Clear the serial number, if it is this one: it is of another part.
    ClearSerial(String),
}

impl Traceability {
    /// Maximum length of an entry, characters.
    pub const MAX_LETTERS: usize = 64;

    /// Returns an entry as it is stored: without control characters and surrounding blanks, and truncated.
    pub fn cleaned(text: &str) -> String {
        let letters = text.trim().chars().filter(|c| !c.is_control());
        letters.take(Self::MAX_LETTERS).collect()
    }

    /// Returns the entries that are known, each with its name.
    pub fn known(&self) -> impl Iterator<Item = (&'static str, &str)> {
        [
            ("serial", self.serial.as_str()),
            ("order", self.order.as_str()),
            ("operator", self.operator.as_str()),
        ]
        .into_iter()
        .filter(|(_, text)| !text.is_empty())
    }

    /// Returns these entries, with empty ones taken from `other`.
    #[must_use]
    pub fn or(self, other: &Self) -> Self {
        let or = |own: String, other: &String| if own.is_empty() { other.clone() } else { own };
        Self {
            serial: or(self.serial, &other.serial),
            order: or(self.order, &other.order),
            operator: or(self.operator, &other.operator),
        }
    }

    /// Returns these entries after a change.
    #[must_use]
    pub fn changed(mut self, change: &TraceChange) -> Self {
        match change {
            TraceChange::Fill(known) => return self.or(known),
            TraceChange::Set(known) => return known.clone().or(&self),
            TraceChange::ClearSerial(serial) if self.serial == *serial => self.serial.clear(),
            TraceChange::ClearSerial(_) => {}
        }
        self
    }
}
