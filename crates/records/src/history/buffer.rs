//! The history as a program uses it: inspections that cannot be written wait in memory until writing works again.
//!
//! An inspection never waits for any of this: [`Writer`](super::Writer) does it on its own thread. Readers use the same
//! [`HistoryBuffer`], and see the waiting inspections above the written ones.

mod read;

use std::{
    collections::VecDeque,
    path::{Path, PathBuf},
    sync::{
        Mutex, MutexGuard,
        atomic::{AtomicU64, Ordering},
    },
    time::{Duration, Instant},
};

use super::{
    entry::{NewEntry, Summary},
    error::HistoryError,
    event::HistoryEvent,
    frames::FrameLoss,
    hung::HungId,
    open::{FILE, OpenedHistory},
    retention::{PruneResult, Retention, Usage},
    servo_run::ServoRecord,
    store::History,
    traceability::TraceChange,
    waiting::wait,
};
use geometry::error::{Advice as _, lock};
use inspection::library::Truth;

/// Delay before a failed write is retried.
const PAUSE: Duration = Duration::from_secs(20);
/// Most runs of servoing that wait in memory; beyond it the oldest are dropped.
const MAX_SERVO_RUNS: usize = 100;
/// Number of inspections between two sweeps of frames; opening sweeps too.
const SWEEP_EVERY: u32 = 25;

/// The history of one program, shared by writers and readers. The default has no folder and stays in memory.
#[derive(Debug, Default)]
pub struct HistoryBuffer {
    place: Option<PathBuf>,
    inner: Mutex<Inner>,
    /// Separate from the rest, so that reading events never waits for the disk.
    news: Mutex<Vec<HistoryEvent>>,
    num_events: AtomicU64,
}

#[derive(Debug, Default)]
struct Inner {
    history: Option<History>,
    /// True while the history can only be read.
    is_only_read: bool,
    retention: Retention,
    /// Oldest first.
    waiting: VecDeque<NewEntry>,
    /// Changes of traceability that arrived after the rows of their part were written, oldest first.
    untraced: VecDeque<(HungId, TraceChange)>,
    /// Runs of servoing that are not written yet, oldest first.
    servo_runs: VecDeque<ServoRecord>,
    /// Number of runs of servoing that have waited: a waiting one is listed with its negative.
    num_servo_runs: i64,
    /// Highest number of a row, written or waiting; a waiting one is listed with its negative.
    last: i64,
    num_lost: usize,
    /// After a failure, when to try again.
    next_try: Option<Instant>,
    num_unswept: u32,
    /// True while frames that the rule keeps cannot be written.
    loses_frames: bool,
}

impl HistoryBuffer {
    /// Creates a buffer for the history in this folder; `None` keeps it in memory only. Opens nothing yet.
    pub fn new(place: Option<PathBuf>) -> Self {
        Self {
            place,
            ..Self::default()
        }
    }

    /// Returns the folder; `None` in memory only.
    pub fn folder(&self) -> Option<&Path> {
        self.place.as_deref()
    }

    /// Reports that another program may have written to the history.
    pub fn files_changed(&self) {
        self.tell(HistoryEvent::FilesChanged);
    }

    /// Returns the number of inspections that are not written yet.
    pub fn num_waiting(&self) -> usize {
        self.lock().waiting.len()
    }

    /// Returns the number of inspections lost since writing last worked, because too many waited.
    pub fn num_lost(&self) -> usize {
        self.lock().num_lost
    }

    /// Returns the events since the last call. Never waits for the disk.
    pub fn take_news(&self) -> Vec<HistoryEvent> {
        let mut news = lock(&self.news);
        std::mem::take(&mut *news)
    }

    /// Returns the number of events so far; data read at a smaller number may be outdated. Never waits for the disk.
    pub fn num_events(&self) -> u64 {
        self.num_events.load(Ordering::Acquire)
    }

    fn tell(&self, news: HistoryEvent) {
        // Count before adding the event: whoever takes the event also sees the new number.
        self.num_events.fetch_add(1, Ordering::Release);
        let mut all = lock(&self.news);
        all.push(news);
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        // A panic while writing leaves at most an uncommitted transaction.
        lock(&self.inner)
    }

    /// Opens the history unless it is open already, and sweeps frames that are no longer kept.
    pub fn open(&self, now: Instant) {
        let mut inner = self.lock();
        if let Err(error) = self.ensure(&mut inner) {
            self.failed(&mut inner, &error, now);
        }
    }

    /// Returns when to retry a failed write.
    pub fn next_try(&self) -> Option<Instant> {
        self.lock().next_try
    }

    /// Retries a failed write if it is time.
    pub fn retry(&self, now: Instant) {
        let mut inner = self.lock();
        if inner.next_try.is_some_and(|at| at <= now) {
            self.write_waiting(&mut inner, now);
        }
    }

    /// Retries a failed write without waiting until it is time: at the end of the program there is no later attempt.
    pub fn retry_now(&self) {
        let mut inner = self.lock();
        if inner.next_try.is_some() {
            self.write_waiting(&mut inner, Instant::now());
        }
    }

    /// Adds an inspection, to the file or to the waiting ones.
    pub fn add(&self, ticket: u64, entry: NewEntry, now: Instant) {
        let mut inner = self.lock();
        inner.last += 1;
        let mut number = -inner.last;
        let loss = self.place.is_some().then_some(FrameLoss::NotWritable);
        inner.num_lost += wait(&mut inner.waiting, entry, number, loss);
        if self.place.is_some() && inner.next_try.is_none_or(|at| at <= now) {
            let mut numbers = self.write_waiting(&mut inner, now).into_iter();
            let written = numbers.find(|(waited, _)| *waited == number);
            number = written.map_or(number, |(_, written)| written);
        }
        self.tell(HistoryEvent::Added { ticket, number });
    }

    /// Adds a run of servoing, to the file or to the waiting ones.
    pub fn add_servo_run(&self, mut record: ServoRecord, now: Instant) {
        let mut inner = self.lock();
        inner.num_servo_runs += 1;
        record.run.number = -inner.num_servo_runs;
        inner.servo_runs.push_back(record);
        let num_lost = inner.servo_runs.len().saturating_sub(MAX_SERVO_RUNS);
        inner.servo_runs.drain(..num_lost);
        if self.place.is_some() && inner.next_try.is_none_or(|at| at <= now) {
            self.write_waiting(&mut inner, now);
        }
        self.tell(HistoryEvent::FilesChanged);
    }

    /// Returns the number of runs of servoing that are not written yet.
    pub fn num_servo_runs_waiting(&self) -> usize {
        self.lock().servo_runs.len()
    }

    /// Changes the traceability of all inspections of a part after its verdict, written or waiting.
    pub fn trace_part(&self, hung: &HungId, change: &TraceChange, now: Instant) {
        let mut inner = self.lock();
        for entry in &mut inner.waiting {
            let summary = &mut entry.record.summary;
            if summary.hung == *hung {
                summary.trace = std::mem::take(&mut summary.trace).changed(change);
            }
        }
        if self.place.is_some() {
            inner.untraced.push_back((hung.clone(), change.clone()));
            if inner.next_try.is_none_or(|at| at <= now) {
                self.write_waiting(&mut inner, now);
            }
        }
        self.tell(HistoryEvent::FilesChanged);
    }

    /// Sets the remark on an inspection.
    pub fn set_remark(&self, number: i64, remark: &str) {
        let mut inner = self.lock();
        if let Some(row) = inner.waiting_mut(number) {
            remark.trim().clone_into(&mut row.record.summary.remark);
            return self.tell(HistoryEvent::Changed { number });
        }
        let changed = self.change(&mut inner, number, |history| {
            history.set_remark(number, remark)
        });
        self.queue_change_event(number, changed);
    }

    /// Sets the true label of an inspection; `None` clears it.
    pub fn set_label(&self, number: i64, label: Option<&Truth>) {
        let mut inner = self.lock();
        if let Some(row) = inner.waiting_mut(number) {
            row.record.summary.label = label.cloned();
            return self.tell(HistoryEvent::Changed { number });
        }
        let changed = self.change(&mut inner, number, |history| {
            history.set_label(number, label)
        });
        self.queue_change_event(number, changed);
    }

    /// As [`set_label`](Self::set_label), on the row that stands for a part.
    pub fn set_part_label(&self, hung: &HungId, label: Option<&Truth>) {
        match self.part(hung) {
            Ok(Some(row)) => self.set_label(row.number, label),
            Ok(None) => self.not_changed(&self.no_such_part()),
            Err(error) => self.not_changed(&error),
        }
    }

    /// Sets the true label of a part on the row that stands for it, and the remark if that row has none. Returns the
    /// changed row; `None` in memory only, if the part has no row.
    pub fn label_part(
        &self,
        hung: &HungId,
        label: &Truth,
        remark: &str,
    ) -> Result<Option<Summary>, HistoryError> {
        let mut inner = self.lock();
        self.look(&mut inner);
        let Some(mut row) = inner.part(hung)? else {
            if self.place.is_none() {
                return Ok(None);
            }
            return Err(self.no_such_part());
        };
        let number = row.number;
        let set = |row: &mut Summary| {
            row.label = Some(label.clone());
            if row.remark.is_empty() {
                remark.trim().clone_into(&mut row.remark);
            }
        };
        match inner.waiting_mut(number) {
            Some(entry) => set(&mut entry.record.summary),
            None => self.change(&mut inner, number, |history| history.change(number, set))?,
        }
        set(&mut row);
        self.tell(HistoryEvent::FilesChanged);
        Ok(Some(row))
    }

    fn no_such_part(&self) -> HistoryError {
        HistoryError::NoSuchPart {
            path: self.place.clone().unwrap_or_default().join(FILE),
        }
    }

    fn change(
        &self,
        inner: &mut Inner,
        number: i64,
        change: impl FnOnce(&mut History) -> Result<(), HistoryError>,
    ) -> Result<(), HistoryError> {
        if self.close_replaced(inner) {
            // The number is one of the former file.
            return Err(HistoryError::NoSuchInspection { number });
        }
        self.ensure(inner)?;
        match &mut inner.history {
            Some(history) => change(history),
            None => Err(HistoryError::NoSuchInspection { number }),
        }
    }

    fn queue_change_event(&self, number: i64, changed: Result<(), HistoryError>) {
        match changed {
            Ok(()) => self.tell(HistoryEvent::Changed { number }),
            Err(error) => self.not_changed(&error),
        }
    }

    fn not_changed(&self, error: &HistoryError) {
        self.tell(HistoryEvent::NotChanged {
            what: error.to_string(),
            advice: error.advice(),
        });
    }

    /// Sets the retention rule, and removes at once the frames that it does not keep.
    pub fn set_retention(&self, retention: Retention) {
        let mut inner = self.lock();
        self.look(&mut inner);
        inner.retention = retention.clamped();
        if let Some(history) = &mut inner.history
            && let Err(error) = history.set_retention(&retention)
        {
            return self.not_changed(&error);
        }
        self.sweep(&mut inner);
        self.tell(HistoryEvent::RuleChanged);
    }

    /// Returns the retention rule and the disk usage of the kept frames.
    pub fn kept(&self) -> Result<(Retention, Usage), HistoryError> {
        let inner = self.lock();
        let history = inner.history.as_ref();
        let usage = history.map_or_else(|| Ok(Usage::default()), History::usage)?;
        Ok((inner.retention, usage))
    }

    /// Returns the folder of the kept frames, if there is one.
    pub fn frames_folder(&self) -> Option<PathBuf> {
        let inner = self.lock();
        let history = inner.history.as_ref();
        history.map(|history| history.frames_folder().to_owned())
    }

    /// Opens the history for reading, unless it is open already or a retry is pending.
    fn look(&self, inner: &mut Inner) {
        if inner.next_try.is_none()
            && let Err(error) = self.ensure(inner)
        {
            self.failed(inner, &error, Instant::now());
        }
    }

    /// Closes a history whose file was moved, deleted or replaced, and reports it. Returns whether it did.
    fn close_replaced(&self, inner: &mut Inner) -> bool {
        let replaced = inner.history.take_if(|history| history.is_replaced());
        let Some(replaced) = replaced else {
            return false;
        };
        self.not_changed(&replaced.close_replaced());
        true
    }

    /// Opens the history for writing, anew if its file was replaced. If that fails, reads it as far as possible until
    /// writing works.
    fn ensure(&self, inner: &mut Inner) -> Result<(), HistoryError> {
        let Some(place) = &self.place else {
            return Ok(());
        };
        self.close_replaced(inner);
        if inner.history.is_some() && !inner.is_only_read {
            return Ok(());
        }
        // Opening checks the file, and no connection of this process may have it open then.
        inner.history = None;
        let opened = History::open(place);
        inner.is_only_read = opened.is_err();
        if let Err(error) = &opened {
            inner.history = History::only_read(place, error).map(|(history, _)| history);
        }
        let OpenedHistory {
            history, set_aside, ..
        } = opened?;
        if let Some(set_aside) = set_aside {
            self.tell(HistoryEvent::SetAside(set_aside));
        }
        inner.retention = history.retention()?;
        inner.history = Some(history);
        self.sweep(inner);
        Ok(())
    }

    fn sweep(&self, inner: &mut Inner) {
        inner.num_unswept = 0;
        let retention = inner.retention;
        let Some(history) = &mut inner.history else {
            return;
        };
        // A failed sweep is tried again later; it must not stop the writing.
        if let Ok(swept) = history.sweep(&retention, geometry::clock::now())
            && swept != PruneResult::default()
        {
            self.tell(HistoryEvent::Swept(swept));
        }
    }

    /// Writes all waiting inspections, the oldest first, then the late traceability of written ones and the runs of servoing.
    /// Returns the number of each inspection before and after.
    fn write_waiting(&self, inner: &mut Inner, now: Instant) -> Vec<(i64, i64)> {
        let has_failed = inner.next_try.is_some();
        let mut numbers = Vec::new();
        if let Err(error) = self.ensure(inner) {
            self.failed(inner, &error, now);
            return numbers;
        }
        while let Some(entry) = inner.waiting.pop_front() {
            match self.write(inner, &entry) {
                Ok(Some(number)) => {
                    numbers.push((entry.record.summary.number, number));
                    // A file that was begun anew counts from 1: no two waiting ones may get the same number.
                    inner.last = inner.last.max(number);
                }
                Ok(None) => {
                    inner.waiting.push_front(entry);
                    break;
                }
                Err(error) => {
                    inner.waiting.push_front(entry);
                    self.failed(inner, &error, now);
                    break;
                }
            }
        }
        while inner.waiting.is_empty()
            && let Some((hung, change)) = inner.untraced.pop_front()
        {
            let history = inner.history.as_mut();
            let traced = history.map(|history| history.trace_part(&hung, &change));
            if let Err(error) = traced.transpose() {
                inner.untraced.push_front((hung, change));
                self.failed(inner, &error, now);
                return numbers;
            }
        }
        while let Some(history) = inner.history.as_mut()
            && let Some(record) = inner.servo_runs.front()
        {
            if let Err(error) = history.add_servo_run(record) {
                self.failed(inner, &error, now);
                return numbers;
            }
            inner.servo_runs.pop_front();
        }
        if has_failed && inner.waiting.is_empty() {
            inner.next_try = None;
            self.tell(HistoryEvent::Works {
                numbers: numbers.clone(),
                num_lost: std::mem::take(&mut inner.num_lost),
            });
        }
        numbers
    }

    /// Writes an inspection and returns its number; `None` in memory only.
    fn write(&self, inner: &mut Inner, entry: &NewEntry) -> Result<Option<i64>, HistoryError> {
        let mut is_reopened = false;
        loop {
            self.ensure(inner)?;
            let retention = inner.retention;
            let Some(history) = &mut inner.history else {
                return Ok(None);
            };
            match history.write(entry, &retention) {
                // Reopening checks the file, and sets it aside if the check finds damage too.
                Err(HistoryError::Damaged { .. }) if !is_reopened => {
                    inner.history = None;
                    is_reopened = true;
                }
                written => {
                    inner.num_unswept += 1;
                    if inner.num_unswept >= SWEEP_EVERY {
                        self.sweep(inner);
                    }
                    let (number, frame) = written?;
                    self.report_frame(inner, frame);
                    return Ok(Some(number));
                }
            }
        }
    }

    /// Reports the first frame that could not be kept, and the first that was kept after it.
    fn report_frame(&self, inner: &mut Inner, frame: Result<bool, HistoryError>) {
        match frame {
            Ok(true) => {
                if std::mem::take(&mut inner.loses_frames) {
                    self.tell(HistoryEvent::FramesKept);
                }
            }
            Ok(false) => {}
            Err(error) => {
                if !std::mem::replace(&mut inner.loses_frames, true) {
                    self.tell(HistoryEvent::FramesNotKept {
                        what: error.to_string(),
                        advice: error.advice(),
                    });
                }
            }
        }
    }

    /// Schedules a retry, and reports the failure if it is the first since writing last worked.
    fn failed(&self, inner: &mut Inner, error: &HistoryError, now: Instant) {
        if inner.next_try.is_none() {
            self.tell(HistoryEvent::Failed {
                what: error.to_string(),
                advice: error.advice(),
            });
        }
        inner.next_try = Some(now + PAUSE);
    }
}

impl Inner {
    fn waiting_mut(&mut self, number: i64) -> Option<&mut NewEntry> {
        let mut waiting = self.waiting.iter_mut();
        waiting.find(|entry| entry.record.summary.number == number)
    }
}

#[cfg(test)]
mod tests;
