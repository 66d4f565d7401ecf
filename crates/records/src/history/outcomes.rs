//! Outcomes of parts for statistics: one per part, without the data for opening an inspection.

use std::{cmp::Reverse, collections::BTreeMap};

use jiff::Timestamp;
use rusqlite::{params_from_iter, types::Value};

use super::{
    entry::{Record, StoredVerdict, is_judged, is_ok},
    error::HistoryError,
    filter::Filter,
    store::History,
};
use inspection::{library::Truth, pipeline::RefusalKind};

/// Outcome of one part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartOutcome {
    /// Time of the inspection.
    pub at: Timestamp,
    /// The verdict.
    pub verdict: StoredVerdict,
    /// True if the part counts as OK, see [`Summary::is_ok`](super::Summary::is_ok).
    pub is_ok: bool,
    /// Name of the part found, accepted or not; `None` if it is unknown or there is none.
    pub part: Option<String>,
    /// Why it was not accepted.
    pub reason: Option<RefusalKind>,
    /// Name of the rack in which it hung, if it has one.
    pub rack: Option<String>,
}

impl PartOutcome {
    /// True unless it left before enough of its frames were inspected, see [`Summary::is_judged`](super::Summary::is_judged).
    pub fn is_judged(&self) -> bool {
        is_judged(self.reason.as_ref())
    }
}

/// Names of the accepted parts and how often each was accepted, the most frequent first.
pub fn accepted_parts(outcomes: &[PartOutcome]) -> Vec<(String, usize)> {
    let accepted = outcomes
        .iter()
        .filter(|outcome| outcome.verdict == StoredVerdict::Accepted);
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for part in accepted.filter_map(|outcome| outcome.part.as_deref()) {
        *counts.entry(part).or_default() += 1;
    }
    let counts = counts.into_iter();
    let mut parts: Vec<(String, usize)> =
        counts.map(|(part, num)| (part.to_owned(), num)).collect();
    parts.sort_by_key(|(_, num)| Reverse(*num));
    parts
}

impl From<&Record> for PartOutcome {
    fn from(record: &Record) -> Self {
        let summary = &record.summary;
        Self {
            at: summary.at,
            verdict: summary.verdict,
            is_ok: summary.is_ok(),
            part: summary.part.clone(),
            reason: summary.reason.clone(),
            rack: summary.rack.clone(),
        }
    }
}

/// Returns the query. The index has all columns but the kind, so only the rows of refusals themselves are read.
pub(super) fn outcomes_query(filter: &Filter) -> (String, Vec<Value>) {
    let (condition, values) = filter.condition();
    let asked = format!(
        "SELECT number, at, verdict, part, CASE WHEN verdict <> 'accepted' THEN reason_kind END, rack
            FROM inspection WHERE {condition} ORDER BY at, number"
    );
    (asked, values)
}

impl History {
    /// Returns the outcomes of all matching rows, the oldest first.
    pub fn outcomes(&self, filter: &Filter) -> Result<Vec<PartOutcome>, HistoryError> {
        self.read_outcomes(filter)
            .map_err(|error| self.error(error))
    }

    fn read_outcomes(&self, filter: &Filter) -> rusqlite::Result<Vec<PartOutcome>> {
        let labels = self.labels(filter)?;
        let (asked, values) = outcomes_query(filter);
        let mut asked = self.file.prepare(&asked)?;
        let mut rows = asked.query(params_from_iter(values))?;
        let mut outcomes = Vec::new();
        while let Some(row) = rows.next()? {
            let number: i64 = row.get(0)?;
            let at = Timestamp::from_microsecond(row.get(1)?);
            let verdict: String = row.get(2)?;
            let verdict = StoredVerdict::named(&verdict).unwrap_or(StoredVerdict::Rejected);
            let reason: Option<String> = row.get(4)?;
            let part: Option<String> = row.get(3)?;
            outcomes.push(PartOutcome {
                at: at.unwrap_or(Timestamp::UNIX_EPOCH),
                verdict,
                is_ok: is_ok(verdict, part.as_deref(), labels.get(&number)),
                part,
                reason: reason.map(RefusalKind::named),
                rack: row.get(5)?,
            });
        }
        Ok(outcomes)
    }

    /// Returns the true labels of the matching rows that have one, by number. Few have one, and it is not in the index.
    fn labels(&self, filter: &Filter) -> rusqlite::Result<BTreeMap<i64, Truth>> {
        let (condition, values) = filter.condition();
        let asked =
            format!("SELECT number, label FROM inspection WHERE label IS NOT NULL AND {condition}");
        let mut asked = self.file.prepare(&asked)?;
        let mut rows = asked.query(params_from_iter(values))?;
        let mut labels = BTreeMap::new();
        while let Some(row) = rows.next()? {
            let label: String = row.get(1)?;
            if let Ok(label) = serde_json::from_str(&label) {
                labels.insert(row.get(0)?, label);
            }
        }
        Ok(labels)
    }
}
