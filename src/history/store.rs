//! Writing inspections into the file and asking for them.

use std::path::{Path, PathBuf};

use rusqlite::{
    Connection, OptionalExtension as _, Transaction, TransactionBehavior, params, params_from_iter,
    types::Value,
};

use super::{
    entry::{NewEntry, Record, Summary},
    error::HistoryError,
    filter::Filter,
    frames::{self, FrameRecord},
    hung::HungId,
    open::{FILE, FRAMES, Lock},
    retention::Retention,
    rows::{columns, detail_columns, head_of, insert, json, record_of, summary_of},
    shots,
};
use crate::{library::Truth, scan::Shot, stages::scene::SceneCloud};

/// The history: a file of inspections, and a folder of frames beside it.
#[derive(Debug)]
pub struct History {
    pub(super) file: Connection,
    path: PathBuf,
    pub(super) frames: PathBuf,
    lock: Option<Lock>,
}

/// Some rows of a list, and how many there are in all.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// The rows, the newest first.
    pub rows: Vec<Summary>,
    /// Rows that the filter lets through: parts, unless it asks for what lies below them too.
    pub num_matching: usize,
    /// Parts there are.
    pub num_all: usize,
}

impl History {
    pub(super) fn new(file: Connection, folder: &Path) -> Self {
        Self {
            file,
            path: folder.join(FILE),
            frames: folder.join(FRAMES),
            lock: None,
        }
    }

    pub(super) fn hold(&mut self, lock: Lock) {
        self.lock = Some(lock);
    }

    pub(super) fn error(&self, source: rusqlite::Error) -> HistoryError {
        HistoryError::of(&self.path, source)
    }

    /// Writes an inspection, with its frame if the rule keeps it: all of it or nothing. Answers with its number.
    ///
    /// The frame is there before the row: what is killed between the two leaves a stray, which the next opening removes.
    pub fn add(&mut self, entry: &NewEntry, retention: &Retention) -> Result<i64, HistoryError> {
        let summary = &entry.record.summary;
        let scene = entry.scene.as_ref();
        let frame = match scene.filter(|_| retention.keep.keeps(summary.verdict)) {
            Some(scene) if entry.shots.is_empty() => {
                frames::write(&self.frames, scene, summary.at)?
            }
            Some(scene) => shots::write_shots(&self.frames, scene, &entry.shots, summary.at)?,
            None => None,
        };
        let written = match begin(&mut self.file, entry, frame.as_ref()) {
            // Where this fails, the row may be in the log all the same and come back with the next opening, which
            // removes the frame if it does not.
            Ok((file, number)) => file.commit().map(|()| number),
            Err(error) => {
                for path in frame.iter().flat_map(|frame| frame.paths(&self.frames)) {
                    let _ = frames::remove(&path);
                }
                Err(error)
            }
        };
        written.map_err(|error| self.error(error))
    }

    /// Writes many inspections at once, without their frames: all or none.
    pub fn add_all(
        &mut self,
        entries: impl IntoIterator<Item = NewEntry>,
    ) -> Result<(), HistoryError> {
        let written = || -> rusqlite::Result<()> {
            let file = self
                .file
                .transaction_with_behavior(TransactionBehavior::Immediate)?;
            for entry in entries {
                insert(&file, &entry, None)?;
            }
            file.commit()
        };
        written().map_err(|error| HistoryError::of(&self.path, error))
    }

    /// The rows from this place on that the filter lets through, the newest first, and how many there are in all.
    pub fn page(&self, filter: &Filter, offset: usize, most: usize) -> Result<Page, HistoryError> {
        let read = || -> rusqlite::Result<Page> {
            let num_all = self.count_all()?;
            let (numbers, num_matching) = if filter.has_words() {
                // Words are looked for in every row: once for both.
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

    /// Which rows a page shows.
    fn numbers(&self, filter: &Filter, offset: usize, most: usize) -> rusqlite::Result<Vec<i64>> {
        let (asked, mut values) = listed_query(filter);
        values.extend([Value::from(most as i64), Value::from(offset as i64)]);
        let mut asked = self.file.prepare(&format!("{asked} LIMIT ? OFFSET ?"))?;
        asked
            .query_map(params_from_iter(values), |row| row.get(0))?
            .collect()
    }

    /// The same, and how many there are in all.
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

    /// These rows, in their order.
    fn rows(&self, numbers: &[i64]) -> rusqlite::Result<Vec<Summary>> {
        let columns = columns(&self.file)?;
        let asked = format!("SELECT {columns} FROM inspection WHERE number = ?");
        let mut asked = self.file.prepare(&asked)?;
        // One that somebody else removed meanwhile is none.
        let rows = numbers.iter();
        let rows = rows.map(|number| asked.query_row([number], summary_of).optional());
        rows.filter_map(Result::transpose).collect()
    }

    /// Goes through all rows that the filter lets through, the oldest first, up to the first error.
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
            // One that somebody else removed meanwhile is none.
            if let Some(record) = self.row(number)? {
                each(record)?;
            }
        }
        Ok(())
    }

    /// An inspection in full.
    pub fn row(&self, number: i64) -> Result<Option<Record>, HistoryError> {
        let read = || -> rusqlite::Result<Option<Record>> {
            let (columns, detail) = (columns(&self.file)?, detail_columns(&self.file)?);
            let asked = format!(
                "SELECT {columns}, {detail}
                FROM inspection JOIN detail USING (number) JOIN recipe ON recipe.identity = detail.recipe
                WHERE number = ?"
            );
            self.file.query_row(&asked, [number], record_of).optional()
        };
        read().map_err(|error| self.error(error))
    }

    /// The same; one that is not there is an error.
    pub fn known(&self, number: i64) -> Result<Record, HistoryError> {
        self.row(number)?
            .ok_or(HistoryError::NoSuchInspection { number })
    }

    /// The scene of an inspection whose frame is kept, as it was inspected; `None` if it is not.
    pub fn scene(&self, record: &Record) -> Result<Option<SceneCloud>, HistoryError> {
        let frame = record.detail.frame.as_ref();
        frame
            .map(|frame| Ok(frames::read(&self.frames, frame)?))
            .transpose()
    }

    /// The shots of a scan whose frames are kept, as they were put together; `None` if they are not, or it was no scan.
    pub fn shots(&self, record: &Record) -> Result<Option<Vec<Shot>>, HistoryError> {
        let frame = record.detail.frame.as_ref();
        let frame = frame.filter(|frame| !frame.shots.is_empty());
        frame
            .map(|frame| Ok(shots::read_shots(&self.frames, frame)?))
            .transpose()
    }

    /// The inspections that lie below the one of this number, the oldest first.
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

    /// The inspection that stands for a part.
    pub(super) fn head_of(&self, hung: &HungId) -> Result<Option<Summary>, HistoryError> {
        head_of(&self.file, hung).map_err(|error| self.error(error))
    }

    /// The folder of the kept frames.
    pub fn frames_folder(&self) -> &Path {
        &self.frames
    }

    /// Writes down what a person remarks.
    pub fn set_remark(&mut self, number: i64, remark: &str) -> Result<(), HistoryError> {
        self.change(number, |row| remark.trim().clone_into(&mut row.remark))
    }

    /// Writes down what it truly is, or that nobody knows.
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
            let columns = columns(&file)?;
            let asked = format!("SELECT {columns} FROM inspection WHERE number = ?");
            let row = |number| file.query_row(&asked, [number], summary_of).optional();
            // What is said of a part is said with the inspection that stands for it.
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

/// The rows by the index that holds all that a filter asks for.
const LISTED: &str = "inspection INDEXED BY listed";

/// The row of an inspection, written but not yet there, and its number.
fn begin<'a>(
    file: &'a mut Connection,
    entry: &NewEntry,
    frame: Option<&FrameRecord>,
) -> rusqlite::Result<(Transaction<'a>, i64)> {
    let begun = file.transaction_with_behavior(TransactionBehavior::Immediate)?;
    let number = insert(&begun, entry, frame)?;
    Ok((begun, number))
}

/// Which rows the filter lets through, the newest first: the index alone tells.
pub(super) fn listed_query(filter: &Filter) -> (String, Vec<Value>) {
    let (condition, values) = filter.condition();
    let asked =
        format!("SELECT number FROM {LISTED} WHERE {condition} ORDER BY at DESC, number DESC");
    (asked, values)
}
