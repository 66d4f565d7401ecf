//! Writing and querying inspections.

use std::{
    io,
    path::{Path, PathBuf},
};

use rusqlite::{
    Connection, OptionalExtension as _, Transaction, TransactionBehavior, params, params_from_iter,
    types::Value,
};

use super::{
    entry::{NewEntry, Record, StoredVerdict, Summary},
    error::HistoryError,
    filter::Filter,
    frames::{self, FrameError, FrameLoss, FrameRecord},
    hung::HungId,
    open::{FILE, FRAMES, file_identity, with_ending},
    retention::{KeepFrames, Retention},
    rows::{COLUMNS, DETAIL_SELECTED, head_of, insert, json, record_of, summary_of, trace_part},
    shots,
    traceability::TraceChange,
};
use files::FileLock;
use inspection::library::Truth;
use stages::{scan::Shot, scene::SceneCloud};

/// The history: a database of inspections and a folder of frames.
#[derive(Debug)]
pub struct History {
    pub(super) file: Connection,
    pub(super) path: PathBuf,
    pub(super) frames: PathBuf,
    lock: Option<FileLock>,
    /// Identity of the file at opening; `None` if unknown.
    pub(super) identity: Option<[u64; 2]>,
    /// Identity of its log at opening.
    pub(super) log: Option<[u64; 2]>,
}

/// Some rows of a list, with totals.
#[derive(Clone, Debug, PartialEq)]
pub struct Page<R = Summary> {
    /// The rows, newest first.
    pub rows: Vec<R>,
    /// Number of matching rows; they are parts, unless the filter includes re-inspections.
    pub num_matching: usize,
    /// Number of all parts.
    pub num_all: usize,
}

impl<R> Default for Page<R> {
    fn default() -> Self {
        Self {
            rows: Vec::new(),
            num_matching: 0,
            num_all: 0,
        }
    }
}

impl History {
    pub(super) fn new(file: Connection, folder: &Path) -> Self {
        let path = folder.join(FILE);
        Self {
            identity: file_identity(&path).ok(),
            log: file_identity(&with_ending(&path, "-wal")).ok(),
            file,
            path,
            frames: folder.join(FRAMES),
            lock: None,
        }
    }

    pub(super) fn hold(&mut self, lock: FileLock) {
        self.lock = Some(lock);
    }

    pub(super) fn error(&self, source: rusqlite::Error) -> HistoryError {
        HistoryError::of(&self.path, source)
    }

    /// Writes an inspection completely or not at all, and its frame if the rule keeps it and it can be written: otherwise the
    /// row says why it is not kept. Returns its number.
    pub fn add(&mut self, entry: &NewEntry, retention: &Retention) -> Result<i64, HistoryError> {
        let (number, _) = self.write(entry, retention)?;
        Ok(number)
    }

    /// As [`add`](Self::add); also returns whether the frame is kept, or why it could not be written.
    ///
    /// The frame is written before the row: a kill in between leaves a stray, which the next opening removes.
    pub(super) fn write(
        &mut self,
        entry: &NewEntry,
        retention: &Retention,
    ) -> Result<(i64, Result<bool, HistoryError>), HistoryError> {
        if retention.keep == KeepFrames::None {
            return Ok((self.write_row(entry, None, None)?, Ok(false)));
        }
        let (frame, mut error) = match self.write_frame(entry, retention) {
            Ok(frame) => (frame, None),
            Err(error) => (None, Some(error)),
        };
        let is_kept = frame.is_some();
        let lost = |error: Option<&FrameError>| {
            let known = entry.record.detail.frame_loss;
            error.map(FrameError::loss).or(known)
        };
        let number = match self.write_row(entry, frame.as_ref(), lost(error.as_ref())) {
            // The frame may have taken the room of its row, which is worth more.
            Err(HistoryError::DiskFull { .. }) if is_kept => {
                remove_frame(&self.frames, frame.as_ref());
                let full = FrameError::io(&self.frames, io::ErrorKind::StorageFull.into());
                error = Some(full);
                self.write_row(entry, None, lost(error.as_ref()))?
            }
            written => written?,
        };
        let frame = match error {
            Some(source) => Err(HistoryError::FramesNotKept { source }),
            None => Ok(is_kept),
        };
        Ok((number, frame))
    }

    /// Writes the frame of an inspection, or those of its scan; returns `None` if there is none.
    fn write_frame(
        &self,
        entry: &NewEntry,
        retention: &Retention,
    ) -> Result<Option<FrameRecord>, FrameError> {
        let summary = &entry.record.summary;
        let frame = match &entry.scene {
            Some(scene) if entry.shots.is_empty() => {
                frames::write(&self.frames, scene, summary.at)?
            }
            Some(scene) => shots::write_shots(&self.frames, scene, &entry.shots, summary.at)?,
            None => None,
        };
        let is_only_recent =
            retention.keep == KeepFrames::NotAccepted && summary.verdict == StoredVerdict::Accepted;
        Ok(frame.map(|frame| FrameRecord {
            is_only_recent,
            ..frame
        }))
    }

    /// Writes the rows of an inspection, and returns its number.
    fn write_row(
        &mut self,
        entry: &NewEntry,
        frame: Option<&FrameRecord>,
        lost: Option<FrameLoss>,
    ) -> Result<i64, HistoryError> {
        let written = match begin(&mut self.file, entry, frame, lost) {
            // If the commit fails, the row may still be in the log and reappear with the next opening; otherwise that
            // opening removes the frame.
            Ok((file, number)) => file.commit().map(|()| number),
            Err(error) => {
                remove_frame(&self.frames, frame);
                Err(error)
            }
        };
        written.map_err(|error| self.error(error))
    }

    /// Writes many inspections at once, without frames: all or none.
    pub fn add_all(
        &mut self,
        entries: impl IntoIterator<Item = NewEntry>,
    ) -> Result<(), HistoryError> {
        let written = || -> rusqlite::Result<()> {
            let file = self
                .file
                .transaction_with_behavior(TransactionBehavior::Immediate)?;
            for entry in entries {
                insert(&file, &entry, None, None)?;
            }
            file.commit()
        };
        written().map_err(|error| HistoryError::of(&self.path, error))
    }

    /// Returns up to `most` matching rows from this offset on, newest first, and the totals.
    pub fn page(&self, filter: &Filter, offset: usize, most: usize) -> Result<Page, HistoryError> {
        let read = || -> rusqlite::Result<Page> {
            let num_all = self.count_all()?;
            let (numbers, num_matching) = if filter.has_words() {
                // Words require a scan of every row, so do it once for rows and count.
                self.numbers_and_count(filter, offset, most)?
            } else if *filter == Filter::default() {
                (self.numbers(filter, offset, most)?, num_all)
            } else {
                (self.numbers(filter, offset, most)?, self.count(filter)?)
            };
            Ok(Page {
                rows: self.rows(&numbers)?,
                num_matching,
                num_all,
            })
        };
        read().map_err(|error| self.error(error))
    }

    /// Returns up to `most` matching rows, newest first, without counting the others.
    pub fn newest(&self, filter: &Filter, most: usize) -> Result<Vec<Summary>, HistoryError> {
        let numbers = self.numbers(filter, 0, most);
        let rows = numbers.and_then(|numbers| self.rows(&numbers));
        rows.map_err(|error| self.error(error))
    }

    fn count_all(&self) -> rusqlite::Result<usize> {
        let asked = "SELECT count(*) FROM inspection WHERE parent IS NULL";
        let num: i64 = self.file.query_row(asked, [], |row| row.get(0))?;
        Ok(num as usize)
    }

    fn count(&self, filter: &Filter) -> rusqlite::Result<usize> {
        let (condition, values) = filter.condition();
        let asked = format!("SELECT count(*) FROM {LISTED} WHERE {condition}");
        let mut asked = self.file.prepare(&asked)?;
        let num: i64 = asked.query_row(params_from_iter(values), |row| row.get(0))?;
        Ok(num as usize)
    }

    /// Returns the numbers of the rows on a page.
    fn numbers(&self, filter: &Filter, offset: usize, most: usize) -> rusqlite::Result<Vec<i64>> {
        let (asked, mut values) = listed_query(filter);
        values.extend([Value::from(most as i64), Value::from(offset as i64)]);
        let mut asked = self.file.prepare(&format!("{asked} LIMIT ? OFFSET ?"))?;
        asked
            .query_map(params_from_iter(values), |row| row.get(0))?
            .collect()
    }

    /// As [`numbers`](Self::numbers), with the number of all matching rows.
    fn numbers_and_count(
        &self,
        filter: &Filter,
        offset: usize,
        most: usize,
    ) -> rusqlite::Result<(Vec<i64>, usize)> {
        let (asked, values) = listed_query(filter);
        let mut asked = self.file.prepare(&asked)?;
        let mut found = asked.query(params_from_iter(values))?;
        let (mut numbers, mut num) = (Vec::new(), 0);
        while let Some(row) = found.next()? {
            if num >= offset && numbers.len() < most {
                numbers.push(row.get(0)?);
            }
            num += 1;
        }
        Ok((numbers, num))
    }

    /// Reads these rows in this order.
    fn rows(&self, numbers: &[i64]) -> rusqlite::Result<Vec<Summary>> {
        let asked = format!("SELECT {COLUMNS} FROM inspection WHERE number = ?");
        let mut asked = self.file.prepare(&asked)?;
        // Skip rows that another program has deleted meanwhile.
        let rows = numbers.iter();
        let rows = rows.map(|number| asked.query_row([number], summary_of).optional());
        rows.filter_map(Result::transpose).collect()
    }

    /// Calls `each` with all matching inspections, oldest first, up to the first error.
    pub fn each<E: From<HistoryError>>(
        &self,
        filter: &Filter,
        mut each: impl FnMut(Record) -> Result<(), E>,
    ) -> Result<(), E> {
        let (condition, values) = filter.condition();
        let asked = format!("SELECT number FROM inspection WHERE {condition} ORDER BY at, number");
        let numbers = || -> rusqlite::Result<Vec<i64>> {
            let mut asked = self.file.prepare(&asked)?;
            let numbers = asked.query_map(params_from_iter(values), |row| row.get(0))?;
            numbers.collect()
        };
        for number in numbers().map_err(|error| self.error(error))? {
            // Skip rows that another program has deleted meanwhile.
            if let Some(record) = self.row(number)? {
                each(record)?;
            }
        }
        Ok(())
    }

    /// Returns an inspection in full; `None` if it does not exist.
    pub fn row(&self, number: i64) -> Result<Option<Record>, HistoryError> {
        let read = || -> rusqlite::Result<Option<Record>> {
            let asked = format!(
                "SELECT {COLUMNS}, {DETAIL_SELECTED}
                FROM inspection JOIN detail USING (number) JOIN recipe ON recipe.identity = detail.recipe
                WHERE number = ?"
            );
            self.file.query_row(&asked, [number], record_of).optional()
        };
        read().map_err(|error| self.error(error))
    }

    /// Returns an inspection in full; it is an error if it does not exist.
    pub fn known(&self, number: i64) -> Result<Record, HistoryError> {
        self.row(number)?
            .ok_or(HistoryError::NoSuchInspection { number })
    }

    /// Reads the scene of an inspection as it was inspected; `None` if its frame is not kept.
    pub fn scene(&self, record: &Record) -> Result<Option<SceneCloud>, HistoryError> {
        let frame = record.detail.frame.as_ref();
        frame
            .map(|frame| Ok(frames::read(&self.frames, frame)?))
            .transpose()
    }

    /// Reads the shots of a scan as they were inspected; `None` if they are not kept, or it was not a scan.
    pub fn shots(&self, record: &Record) -> Result<Option<Vec<Shot>>, HistoryError> {
        let frame = record.detail.frame.as_ref();
        let frame = frame.filter(|frame| !frame.shots.is_empty());
        frame
            .map(|frame| Ok(shots::read_shots(&self.frames, frame)?))
            .transpose()
    }

    /// Returns the re-inspections below the inspection of this number, oldest first.
    pub fn below(&self, number: i64) -> Result<Vec<Record>, HistoryError> {
        let numbers = || -> rusqlite::Result<Vec<i64>> {
            let asked = "SELECT number FROM inspection WHERE parent = ? ORDER BY at, number";
            let mut asked = self.file.prepare(asked)?;
            let numbers = asked.query_map([number], |row| row.get(0))?;
            numbers.collect()
        };
        let mut below = Vec::new();
        for number in numbers().map_err(|error| self.error(error))? {
            below.extend(self.row(number)?);
        }
        Ok(below)
    }

    /// Returns the inspection that stands for a part.
    pub(super) fn head_of(&self, hung: &HungId) -> Result<Option<Summary>, HistoryError> {
        head_of(&self.file, hung).map_err(|error| self.error(error))
    }

    /// Returns the folder of the kept frames.
    pub fn frames_folder(&self) -> &Path {
        &self.frames
    }

    /// Sets the remark on an inspection.
    pub fn set_remark(&mut self, number: i64, remark: &str) -> Result<(), HistoryError> {
        self.change(number, |row| remark.trim().clone_into(&mut row.remark))
    }

    /// Changes the traceability of all inspections of a part after its verdict.
    pub fn trace_part(&mut self, hung: &HungId, change: &TraceChange) -> Result<(), HistoryError> {
        trace_part(&mut self.file, hung, change).map_err(|error| self.error(error))
    }

    /// Sets the true label of an inspection; `None` clears it.
    pub fn set_label(&mut self, number: i64, label: Option<&Truth>) -> Result<(), HistoryError> {
        self.change(number, |row| row.label = label.cloned())
    }

    pub(super) fn change(
        &mut self,
        number: i64,
        change: impl FnOnce(&mut Summary),
    ) -> Result<(), HistoryError> {
        let changed = || -> rusqlite::Result<bool> {
            let file = self
                .file
                .transaction_with_behavior(TransactionBehavior::Immediate)?;
            let asked = format!("SELECT {COLUMNS} FROM inspection WHERE number = ?");
            let row = |number| file.query_row(&asked, [number], summary_of).optional();
            // Remark and label belong to the inspection that stands for the part.
            let row = match row(number)? {
                Some(below) => below.parent.map_or_else(|| Ok(Some(below.clone())), row)?,
                None => None,
            };
            let Some(mut row) = row else {
                return Ok(false);
            };
            change(&mut row);
            file.execute(
                "UPDATE inspection SET remark = ?, label = ?, search = ? WHERE number = ?",
                params![
                    row.remark,
                    row.label.as_ref().and_then(json),
                    row.search(),
                    row.number
                ],
            )?;
            file.commit()?;
            Ok(true)
        };
        match changed() {
            Ok(true) => Ok(()),
            Ok(false) => Err(HistoryError::NoSuchInspection { number }),
            Err(error) => Err(HistoryError::of(&self.path, error)),
        }
    }
}

/// The table with the index that holds all columns of the filters.
const LISTED: &str = "inspection INDEXED BY listed";

/// Inserts an inspection without committing; returns the transaction and the number.
fn begin<'a>(
    file: &'a mut Connection,
    entry: &NewEntry,
    frame: Option<&FrameRecord>,
    lost: Option<FrameLoss>,
) -> rusqlite::Result<(Transaction<'a>, i64)> {
    let begun = file.transaction_with_behavior(TransactionBehavior::Immediate)?;
    let number = insert(&begun, entry, frame, lost)?;
    Ok((begun, number))
}

/// Removes the files of a frame that no row refers to; what stays goes with the next opening.
fn remove_frame(folder: &Path, frame: Option<&FrameRecord>) {
    for path in frame.iter().flat_map(|frame| frame.paths(folder)) {
        let _ = frames::remove(&path);
    }
}

/// Returns the query for the matching rows, newest first; the index alone answers it.
pub(super) fn listed_query(filter: &Filter) -> (String, Vec<Value>) {
    let (condition, values) = filter.condition();
    let asked =
        format!("SELECT number FROM {LISTED} WHERE {condition} ORDER BY at DESC, number DESC");
    (asked, values)
}
