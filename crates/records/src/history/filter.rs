//! Filters for lists of inspections.

use jiff::Timestamp;
use rusqlite::types::Value;

use super::entry::{StoredVerdict, Summary};

/// Selects the inspections of a list; the default matches all parts.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Filter {
    /// Inspected at or after this time.
    pub since: Option<Timestamp>,
    /// Inspected before this time.
    pub until: Option<Timestamp>,
    /// Recognised as this part, accepted or not.
    pub part: Option<String>,
    /// With these verdicts.
    pub verdict: Option<VerdictFilter>,
    /// Simulated or not.
    pub is_simulated: Option<bool>,
    /// Only from this source.
    pub source: Option<String>,
    /// Only in a rack of this name.
    pub rack: Option<String>,
    /// Only of this order.
    pub order: Option<String>,
    /// Only with this serial number.
    pub serial: Option<String>,
    /// Includes the re-inspections; otherwise the list has one row per part.
    pub with_below: bool,
    /// Words that must each occur in the title, in the name of part, scene, source or rack, in the remark, the true label or
    /// the traceability; case is ignored.
    pub text: String,
    /// Texts that a list shows, in lower case, each with what the search text has for it: a verdict, a kind of refusal,
    /// `simulated`, `simulated_frame ` or `shots `, after `=`. A word of the former also matches the latter.
    pub shown: Vec<[String; 2]>,
}

/// The verdicts of the inspections in a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VerdictFilter {
    /// Exactly this verdict.
    Only(StoredVerdict),
    /// Not accepted for whatever reason: unknown parts and scenes without a part are not accepted either.
    NotAccepted,
}

impl From<StoredVerdict> for VerdictFilter {
    fn from(verdict: StoredVerdict) -> Self {
        Self::Only(verdict)
    }
}

impl Filter {
    /// Returns whether the filter contains words.
    pub(super) fn has_words(&self) -> bool {
        self.words().next().is_some()
    }

    /// The words of the text; commas are those of a title that was typed or copied.
    fn words(&self) -> impl Iterator<Item = String> {
        let words = self.text.split_whitespace();
        let words = words.map(|word| word.trim_matches(','));
        words.filter(|word| !word.is_empty()).map(str::to_lowercase)
    }

    /// Returns the texts of which any one matches the word.
    fn found_by(&self, word: String) -> Vec<String> {
        let shown = self.shown.iter();
        let shown = shown.filter(|[shown, _]| shown.contains(&word));
        let mut texts: Vec<String> = shown.map(|[_, stored]| stored.clone()).collect();
        texts.push(word);
        texts
    }

    /// Returns the SQL condition, `1` if there is none, and its values.
    pub fn condition(&self) -> (String, Vec<Value>) {
        let (mut parts, mut values) = self.common_conditions();
        if let Some(verdict) = self.verdict {
            let (condition, verdict) = match verdict {
                VerdictFilter::Only(verdict) => ("verdict = ?", verdict),
                VerdictFilter::NotAccepted => ("verdict <> ?", StoredVerdict::Accepted),
            };
            parts.push(condition.to_owned());
            values.push(verdict.name().to_owned().into());
        }
        if let Some(rack) = &self.rack {
            parts.push("rack = ?".into());
            values.push(rack.clone().into());
        }
        for (column, wanted) in [("job_order", &self.order), ("serial", &self.serial)] {
            if let Some(wanted) = wanted {
                // The index has the search text alone, which leaves few rows to read.
                parts.push(format!("instr(search, ?) AND {column} = ?"));
                values.extend([wanted.to_lowercase(), wanted.clone()].map(Value::from));
            }
        }
        if !self.with_below {
            parts.push("parent IS NULL".into());
        }
        if parts.is_empty() {
            parts.push("1".into());
        }
        (parts.join(" AND "), values)
    }

    /// Returns the SQL conditions on columns that inspections and runs of servoing have in common, and their values.
    pub(super) fn common_conditions(&self) -> (Vec<String>, Vec<Value>) {
        let mut parts: Vec<String> = Vec::new();
        let mut values = Vec::new();
        let mut add = |part: &str, value: Value| {
            parts.push(part.to_owned());
            values.push(value);
        };
        if let Some(since) = self.since {
            add("at >= ?", since.as_microsecond().into());
        }
        if let Some(until) = self.until {
            add("at < ?", until.as_microsecond().into());
        }
        if let Some(part) = &self.part {
            add("part = ?", part.clone().into());
        }
        if let Some(is_simulated) = self.is_simulated {
            add("simulated = ?", is_simulated.into());
        }
        if let Some(source) = &self.source {
            add("source = ?", source.clone().into());
        }
        for word in self.words() {
            let texts = self.found_by(word);
            let any = vec!["instr(search, ?)"; texts.len()].join(" OR ");
            parts.push(format!("({any})"));
            values.extend(texts.into_iter().map(Value::from));
        }
        (parts, values)
    }

    /// Returns whether each word of the filter is found in this text.
    pub(super) fn has_words_of(&self, search: &str) -> bool {
        self.words().all(|word| {
            let mut texts = self.found_by(word).into_iter();
            texts.any(|text| search.contains(&text))
        })
    }

    /// Returns whether an inspection matches the filter.
    pub fn passes(&self, row: &Summary) -> bool {
        let search = row.search();
        (self.with_below || row.parent.is_none())
            && self.since.is_none_or(|since| row.at >= since)
            && self.until.is_none_or(|until| row.at < until)
            && (self.part.is_none() || self.part == row.part)
            && self.verdict.is_none_or(|verdict| match verdict {
                VerdictFilter::Only(verdict) => row.verdict == verdict,
                VerdictFilter::NotAccepted => row.verdict != StoredVerdict::Accepted,
            })
            && self.is_simulated.is_none_or(|is| row.is_simulated == is)
            && self
                .source
                .as_ref()
                .is_none_or(|source| row.source == *source)
            && (self.rack.is_none() || self.rack == row.rack)
            && (self.order.as_ref()).is_none_or(|order| row.trace.order == *order)
            && (self.serial.as_ref()).is_none_or(|serial| row.trace.serial == *serial)
            && self.has_words_of(&search)
    }
}
