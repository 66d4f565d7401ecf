//! How parts ended, as statistics need it: a line a part, without what an inspection can be opened with.

use jiff::Timestamp;
use rusqlite::params_from_iter;

use super::{
    entry::{Record, StoredVerdict},
    error::HistoryError,
    filter::Filter,
    store::History,
};

/// How a part ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartOutcome {
    /// When it was inspected.
    pub at: Timestamp,
    /// How.
    pub verdict: StoredVerdict,
    /// The best guess's name, accepted or not.
    pub nearest: Option<String>,
    /// Why it was not accepted, for people.
    pub reason: Option<String>,
}

impl From<&Record> for PartOutcome {
    fn from(record: &Record) -> Self {
        let Record { summary, detail } = record;
        Self {
            at: summary.at,
            verdict: summary.verdict,
            nearest: detail.nearest.clone(),
            reason: detail.complaint.as_ref().map(|[reason, _]| reason.clone()),
        }
    }
}

impl History {
    /// Of all rows that the filter lets through, the oldest first.
    pub fn outcomes(&self, filter: &Filter) -> Result<Vec<PartOutcome>, HistoryError> {
        let (condition, values) = filter.condition();
        let asked = format!(
            "SELECT at, verdict, nearest, reason FROM inspection JOIN detail USING (number)
                WHERE {condition} ORDER BY at, number"
        );
        let read = || -> rusqlite::Result<Vec<PartOutcome>> {
            let mut asked = self.file.prepare(&asked)?;
            let outcomes = asked.query_map(params_from_iter(values), |row| {
                let at = Timestamp::from_microsecond(row.get(0)?);
                let verdict: String = row.get(1)?;
                Ok(PartOutcome {
                    at: at.unwrap_or(Timestamp::UNIX_EPOCH),
                    verdict: StoredVerdict::named(&verdict).unwrap_or(StoredVerdict::NotAccepted),
                    nearest: row.get(2)?,
                    reason: row.get(3)?,
                })
            })?;
            outcomes.collect()
        };
        read().map_err(|error| self.error(error))
    }
}
