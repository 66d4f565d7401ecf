//! Which inspections a list shows.

use jiff::Timestamp;
use rusqlite::types::Value;

use super::entry::{StoredVerdict, Summary};

/// Which inspections a list shows; the default lets every one through.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Filter {
    /// Not before this moment.
    pub since: Option<Timestamp>,
    /// Before this moment.
    pub until: Option<Timestamp>,
    /// Recognised as this part, accepted or not.
    pub part: Option<String>,
    /// With this verdict.
    pub verdict: Option<StoredVerdict>,
    /// Simulated, or not.
    pub is_simulated: Option<bool>,
    /// Also the inspections that lie below the one which stands for their part: by itself a list is one of parts.
    pub with_below: bool,
    /// Each of these words is in the name of part, scene or source, in the remark or in the true label; case does not
    /// matter.
    pub text: String,
}

impl Filter {
    /// True if it asks for words.
    pub(super) fn has_words(&self) -> bool {
        self.words().next().is_some()
    }

    fn words(&self) -> impl Iterator<Item = String> {
        self.text.split_whitespace().map(str::to_lowercase)
    }

    /// The condition in SQL, `1` where there is none, and its values.
    pub(super) fn condition(&self) -> (String, Vec<Value>) {
        let mut parts: Vec<&str> = Vec::new();
        let mut values = Vec::new();
        let mut add = |part, value: Value| {
            parts.push(part);
            values.push(value);
        };
        if let Some(since) = self.since {
            add("at >= ?", since.as_microsecond().into());
        }
        if let Some(until) = self.until {
            add("at < ?", until.as_microsecond().into());
        }
        if let Some(verdict) = self.verdict {
            add("verdict = ?", verdict.name().to_owned().into());
        }
        if let Some(part) = &self.part {
            add("part = ?", part.clone().into());
        }
        if let Some(is_simulated) = self.is_simulated {
            add("simulated = ?", is_simulated.into());
        }
        for word in self.words() {
            add("instr(search, ?)", word.into());
        }
        if !self.with_below {
            parts.push("parent IS NULL");
        }
        if parts.is_empty() {
            parts.push("1");
        }
        (parts.join(" AND "), values)
    }

    /// The same of an inspection that is not in the file yet.
    pub(super) fn passes(&self, row: &Summary) -> bool {
        let search = row.search();
        (self.with_below || row.parent.is_none())
            && self.since.is_none_or(|since| row.at >= since)
            && self.until.is_none_or(|until| row.at < until)
            && (self.part.is_none() || self.part == row.part)
            && self.verdict.is_none_or(|verdict| row.verdict == verdict)
            && self.is_simulated.is_none_or(|is| row.is_simulated == is)
            && self.words().all(|word| search.contains(&word))
    }
}
