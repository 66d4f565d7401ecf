//! Reading the history while some inspections wait to be written: the waiting ones are the newest.

use super::{HistoryBuffer, Inner};
use crate::history::{
    drift::{DriftWarning, POSES_FOR_WARNING, PartDrift, PoseRecord},
    entry::{Record, Summary, png_of},
    error::HistoryError,
    filter::Filter,
    hung::HungId,
    outcomes::PartOutcome,
    servo_run::{ServoRecord, ServoRun},
    store::{History, Page},
    waiting::waiting_rows,
};

impl HistoryBuffer {
    /// Returns rows of the list, waiting ones above written ones.
    pub fn page(&self, filter: &Filter, offset: usize, most: usize) -> Result<Page, HistoryError> {
        let mut inner = self.lock();
        self.look(&mut inner);
        let mut matching = waiting_rows(&inner.waiting, inner.history.as_ref())?;
        let num_waiting = matching.iter().filter(|row| row.parent.is_none()).count();
        matching.retain(|row| filter.passes(row));
        let num_above = matching.len();
        let above = matching.into_iter().rev().skip(offset).take(most);
        let mut rows: Vec<Summary> = above.collect();
        let below = match &inner.history {
            Some(history) => {
                let offset = offset.saturating_sub(num_above);
                history.page(filter, offset, most - rows.len())?
            }
            None => Page::default(),
        };
        rows.extend(below.rows);
        Ok(Page {
            rows,
            num_matching: num_above + below.num_matching,
            num_all: num_waiting + below.num_all,
        })
    }

    /// As [`History::newest`], including inspections that are not written yet.
    pub fn newest(&self, filter: &Filter, most: usize) -> Result<Vec<Summary>, HistoryError> {
        let mut inner = self.lock();
        self.look(&mut inner);
        let waiting = waiting_rows(&inner.waiting, inner.history.as_ref())?;
        let waiting = waiting.into_iter().rev().filter(|row| filter.passes(row));
        let mut rows: Vec<Summary> = waiting.take(most).collect();
        if let Some(history) = &inner.history {
            rows.extend(history.newest(filter, most - rows.len())?);
        }
        Ok(rows)
    }

    /// Returns runs of servoing, waiting ones above written ones.
    pub fn servo_runs(
        &self,
        filter: &Filter,
        offset: usize,
        most: usize,
    ) -> Result<Page<ServoRun>, HistoryError> {
        let mut inner = self.lock();
        self.look(&mut inner);
        let waiting = inner.servo_runs.iter().rev().map(|record| &record.run);
        let matching: Vec<&ServoRun> = waiting.filter(|run| filter.passes_servo(run)).collect();
        let num_above = matching.len();
        let above = matching.into_iter().skip(offset).take(most);
        let mut rows: Vec<ServoRun> = above.cloned().collect();
        let below = match &inner.history {
            Some(history) => {
                let offset = offset.saturating_sub(num_above);
                history.servo_runs(filter, offset, most - rows.len())?
            }
            None => Page::default(),
        };
        rows.extend(below.rows);
        Ok(Page {
            rows,
            num_matching: num_above + below.num_matching,
            num_all: inner.servo_runs.len() + below.num_all,
        })
    }

    /// Returns a run of servoing in full; it is an error if it does not exist.
    pub fn servo_run(&self, number: i64) -> Result<ServoRecord, HistoryError> {
        let mut inner = self.lock();
        self.look(&mut inner);
        let mut waiting = inner.servo_runs.iter();
        match (
            waiting.find(|record| record.run.number == number),
            &inner.history,
        ) {
            (Some(record), _) => Ok(record.clone()),
            (None, Some(history)) => history.servo_run(number),
            (None, None) => Err(HistoryError::NoSuchServoRun { number }),
        }
    }

    /// Returns an inspection in full.
    pub fn row(&self, number: i64) -> Result<Option<Record>, HistoryError> {
        let mut inner = self.lock();
        self.look(&mut inner);
        let rows = waiting_rows(&inner.waiting, inner.history.as_ref())?
            .into_iter()
            .zip(&inner.waiting);
        if let Some((summary, entry)) = rows.into_iter().find(|(row, _)| row.number == number) {
            let mut detail = entry.record.detail.clone();
            detail.thumbnail = entry.picture.as_ref().map_or_else(Vec::new, png_of);
            return Ok(Some(Record { summary, detail }));
        }
        match &inner.history {
            Some(history) => history.row(number),
            None => Ok(None),
        }
    }

    /// Returns the row that stands for a part; `None` if the part has no row.
    pub fn part(&self, hung: &HungId) -> Result<Option<Summary>, HistoryError> {
        let mut inner = self.lock();
        self.look(&mut inner);
        inner.part(hung)
    }

    /// Returns the re-inspections below this inspection, the oldest first.
    pub fn below(&self, number: i64) -> Result<Vec<Record>, HistoryError> {
        let mut inner = self.lock();
        self.look(&mut inner);
        let mut below = match &inner.history {
            Some(history) => history.below(number)?,
            None => Vec::new(),
        };
        let rows = waiting_rows(&inner.waiting, inner.history.as_ref())?;
        for (summary, entry) in rows.into_iter().zip(&inner.waiting) {
            if summary.parent == Some(number) {
                below.push(Record {
                    summary,
                    detail: entry.record.detail.clone(),
                });
            }
        }
        Ok(below)
    }

    /// Calls `each` with all matching rows, the oldest first: the written ones, then the waiting ones.
    pub fn each<E: From<HistoryError>>(
        &self,
        filter: &Filter,
        mut each: impl FnMut(Record) -> Result<(), E>,
    ) -> Result<(), E> {
        let inner = self.lock();
        if let Some(history) = &inner.history {
            history.each::<E>(filter, &mut each)?;
        }
        let rows = waiting_rows(&inner.waiting, inner.history.as_ref())?;
        for (summary, entry) in rows.into_iter().zip(&inner.waiting) {
            if filter.passes(&summary) {
                let detail = entry.record.detail.clone();
                each(Record { summary, detail })?;
            }
        }
        Ok(())
    }

    /// Returns the outcomes of all matching parts, the oldest first.
    pub fn outcomes(&self, filter: &Filter) -> Result<Vec<PartOutcome>, HistoryError> {
        let of_record = |record: &Record| Some(PartOutcome::from(record));
        self.with_waiting(filter, |history| history.outcomes(filter), of_record)
    }

    /// As [`History::poses`], including inspections that are not written yet.
    pub fn poses(&self, filter: &Filter, most: usize) -> Result<Vec<PoseRecord>, HistoryError> {
        let written = |history: &History| history.poses(filter, most);
        let mut poses = self.with_waiting(filter, written, PoseRecord::of_record)?;
        poses.drain(..poses.len().saturating_sub(most));
        Ok(poses)
    }

    /// The trend that will refuse the part of this filter, going by its newest inspections; `None` if none will.
    pub fn drift_warning(&self, of_part: &Filter) -> Result<Option<DriftWarning>, HistoryError> {
        let poses = self.poses(of_part, POSES_FOR_WARNING)?;
        // No limit is about the position.
        Ok(PartDrift::of(&poses, |_| None).and_then(|drift| drift.warning()))
    }

    /// Returns the written items, then those of the waiting inspections that match the filter.
    fn with_waiting<T>(
        &self,
        filter: &Filter,
        written: impl FnOnce(&History) -> Result<Vec<T>, HistoryError>,
        of_record: impl Fn(&Record) -> Option<T>,
    ) -> Result<Vec<T>, HistoryError> {
        let mut inner = self.lock();
        self.look(&mut inner);
        let mut found = match &inner.history {
            Some(history) => written(history)?,
            None => Vec::new(),
        };
        let rows = waiting_rows(&inner.waiting, inner.history.as_ref())?;
        let waiting = rows.iter().zip(&inner.waiting);
        let waiting = waiting.filter(|(row, _)| filter.passes(row));
        found.extend(waiting.filter_map(|(_, entry)| of_record(&entry.record)));
        Ok(found)
    }
}

impl Inner {
    pub(super) fn part(&self, hung: &HungId) -> Result<Option<Summary>, HistoryError> {
        let history = self.history.as_ref();
        let mut waiting = waiting_rows(&self.waiting, history)?.into_iter();
        let waits = waiting.find(|row| row.hung == *hung && row.parent.is_none());
        match (waits, history) {
            (None, Some(history)) => history.head_of(hung),
            (waits, _) => Ok(waits),
        }
    }
}
