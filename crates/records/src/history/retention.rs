//! Retention of frames. Rows are kept forever: a hundred thousand of them take about as much space as a minute of
//! frames.
//!
//! The oldest frames are removed first, by age and then by size; the oldest are those written first, since the clock may
//! have been wrong. A frame whose inspection has a remark or a true label has been looked at by a person: no rule removes
//! it, but it counts towards the size. A wrong acceptance is often noticed only a few parts later, so the frames of the
//! newest accepted inspections are kept too; they never displace others.

use std::{collections::BTreeSet, ops::RangeInclusive};

use jiff::Timestamp;
use rusqlite::{OptionalExtension as _, TransactionBehavior};

use super::{
    error::HistoryError,
    frames::{self, FrameRecord},
    store::History,
};
use texts::{Described, Message};

/// Number of the newest accepted inspections whose frames are kept by [`KeepFrames::NotAccepted`]. Frames of a Kinect take
/// less than 100 MB together.
pub const ACCEPTED_KEPT: usize = 200;

/// Which frames are kept, and for how long.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct Retention {
    /// The inspections whose frames are kept.
    pub keep: KeepFrames,
    /// Maximum age of a frame, days, 1..3650. A pause between two inspections counts at most a tenth of it.
    pub max_days: u32,
    /// Maximum total size, gigabytes (10⁹ bytes), 0.1..10 000; beyond it the oldest frames are removed.
    pub max_gigabytes: f64,
}

impl Default for Retention {
    fn default() -> Self {
        Self {
            keep: KeepFrames::default(),
            max_days: 90,
            max_gigabytes: 10.0,
        }
    }
}

impl Retention {
    /// Valid ages of a frame, days.
    pub const DAYS: RangeInclusive<u32> = 1..=3650;
    /// Valid total sizes, gigabytes.
    pub const GIGABYTES: RangeInclusive<f64> = 0.1..=10_000.0;

    /// Returns the rule with its values clamped to their ranges.
    #[must_use]
    pub fn clamped(self) -> Self {
        let gigabytes = if self.max_gigabytes.is_finite() {
            self.max_gigabytes
        } else {
            Self::default().max_gigabytes
        };
        Self {
            keep: self.keep,
            max_days: self.max_days.clamp(*Self::DAYS.start(), *Self::DAYS.end()),
            max_gigabytes: gigabytes.clamp(*Self::GIGABYTES.start(), *Self::GIGABYTES.end()),
        }
    }
}

/// The inspections whose frames are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum KeepFrames {
    /// All inspections.
    All,
    /// Those not accepted, which are the ones that people ask about, and the newest [`ACCEPTED_KEPT`] accepted ones.
    #[default]
    NotAccepted,
    /// No inspection.
    None,
}

impl KeepFrames {
    /// All rules.
    pub const ALL: [Self; 3] = [Self::All, Self::NotAccepted, Self::None];
}

impl Described for KeepFrames {
    fn message(&self) -> Message {
        Message::new(match self {
            Self::All => "keep-all",
            Self::NotAccepted => "keep-not-accepted",
            Self::None => "keep-none",
        })
    }
}

texts::display!(KeepFrames);

/// Disk usage of the kept frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Usage {
    /// Number of frames.
    pub num_frames: usize,
    /// Total size, bytes.
    pub num_bytes: u64,
    /// Size of the frames whose inspections have a remark or a true label, bytes.
    pub num_bytes_marked: u64,
}

/// Frames removed by a sweep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PruneResult {
    /// Number of frames.
    pub num_frames: usize,
    /// Total size, bytes.
    pub num_bytes: u64,
}

/// A clock that is wrong once makes no frame older than this part of the maximum age.
const AGE_PARTS: i64 = 10;
const MICROSECONDS_PER_DAY: i64 = 86_400_000_000;

struct PrunableFrame {
    number: i64,
    bytes: u64,
    is_only_recent: bool,
}

/// Name under which the file stores the rule, so that window and commands apply the same.
const SETTING: &str = "retention";

impl History {
    /// Reads the retention rule.
    pub fn retention(&self) -> Result<Retention, HistoryError> {
        let asked = "SELECT json FROM setting WHERE name = ?";
        let found = self
            .file
            .query_row(asked, [SETTING], |row| row.get::<_, String>(0));
        let found = found.optional().map_err(|error| self.error(error))?;
        let rule = found.and_then(|json| serde_json::from_str::<Retention>(&json).ok());
        Ok(rule.unwrap_or_default().clamped())
    }

    /// Sets the retention rule; frames that it does not keep are removed by the next sweep.
    pub fn set_retention(&mut self, retention: &Retention) -> Result<(), HistoryError> {
        let json = serde_json::to_string(&retention.clamped()).unwrap_or_default();
        let written = self.file.execute(
            "INSERT INTO setting (name, json) VALUES (?, ?)
            ON CONFLICT (name) DO UPDATE SET json = excluded.json",
            [SETTING, &json],
        );
        written.map(|_| ()).map_err(|error| self.error(error))
    }

    /// Returns the disk usage of the kept frames.
    pub fn usage(&self) -> Result<Usage, HistoryError> {
        let asked = "SELECT count(*), total(frame_bytes), total(frame_bytes) FILTER (WHERE remark <> '' OR label IS NOT NULL)
            FROM inspection WHERE frame_bytes IS NOT NULL";
        let read = self.file.query_row(asked, [], |row| {
            let (num, bytes, marked): (i64, f64, f64) = (row.get(0)?, row.get(1)?, row.get(2)?);
            Ok(Usage {
                num_frames: num as usize,
                num_bytes: bytes as u64,
                num_bytes_marked: marked as u64,
            })
        });
        read.map_err(|error| self.error(error))
    }

    /// Removes the frames that the rule no longer keeps. Their rows stay.
    ///
    /// The references in the rows are deleted first, then the files: a kill in between leaves strays.
    pub fn sweep(
        &mut self,
        retention: &Retention,
        now: Timestamp,
    ) -> Result<PruneResult, HistoryError> {
        let Retention {
            keep,
            max_days,
            max_gigabytes,
        } = retention.clamped();
        let first_young = self.first_young(max_days, now);
        let first_young = first_young.map_err(|error| self.error(error))?;
        let candidates = self.candidates().map_err(|error| self.error(error))?;
        let (recent, others): (Vec<_>, Vec<_>) =
            (candidates.into_iter()).partition(|frame: &PrunableFrame| frame.is_only_recent);
        let num_over = match keep {
            KeepFrames::NotAccepted => recent.len().saturating_sub(ACCEPTED_KEPT),
            KeepFrames::All | KeepFrames::None => 0,
        };
        let mut left = self.usage()?.num_bytes;
        let most = (max_gigabytes * 1e9) as u64;
        // The oldest come first, and those that are only recent before all others.
        let leaving = recent
            .into_iter()
            .chain(others)
            .enumerate()
            .filter(|(place, frame)| {
                let goes = *place < num_over || frame.number < first_young || left > most;
                if goes {
                    left = left.saturating_sub(frame.bytes);
                }
                goes
            });
        let leaving: Vec<PrunableFrame> = leaving.map(|(_, frame)| frame).collect();
        if leaving.is_empty() {
            return Ok(PruneResult::default());
        }
        let numbers: Vec<i64> = leaving.iter().map(|candidate| candidate.number).collect();
        let files = self.forget(&numbers).map_err(|error| self.error(error))?;
        self.remove_files(&files)?;
        Ok(PruneResult {
            num_frames: leaving.len(),
            num_bytes: leaving.iter().map(|candidate| candidate.bytes).sum(),
        })
    }

    /// Returns the number of the oldest inspection whose frame is not too old. Numbers are in the order of writing.
    ///
    /// The clock may be wrong now, or may have been at earlier inspections, so the age is the sum of the times between the
    /// inspections written since. Each counts at most a tenth of the maximum age. Inspections at which the clock was off
    /// count nothing if it came back afterwards.
    fn first_young(&self, max_days: u32, now: Timestamp) -> rusqlite::Result<i64> {
        let max_age = i64::from(max_days) * MICROSECONDS_PER_DAY;
        let longest = max_age / AGE_PARTS;
        let mut asked =
            (self.file).prepare("SELECT number, at FROM inspection ORDER BY number DESC")?;
        let mut rows = asked.query([])?;
        let mut first = i64::MAX;
        let (mut time, mut age) = (now.as_microsecond(), 0);
        // Time and age before the last jump of the clock.
        let mut before_jump = None;
        while let Some(row) = rows.next()? {
            let (number, at): (i64, i64) = (row.get(0)?, row.get(1)?);
            let is_near = |time: i64| time.abs_diff(at) <= longest.unsigned_abs();
            if !is_near(time) {
                match before_jump {
                    Some((former, its_age)) if is_near(former) => {
                        (time, age) = (former, its_age);
                        before_jump = None;
                    }
                    _ => before_jump = Some((time, age)),
                }
            }
            let step = time.saturating_sub(at);
            age += step.clamp(0, longest);
            if age > max_age {
                break;
            }
            // Two programs write slightly out of order: such a step back is not counted twice.
            if step > 0 || !is_near(time) {
                time = at;
            }
            first = number;
        }
        Ok(first)
    }

    /// Returns the frames that a rule may remove, the oldest first.
    fn candidates(&self) -> rusqlite::Result<Vec<PrunableFrame>> {
        let mut asked = self.file.prepare(
            "SELECT number, frame_bytes,
                CASE WHEN json_valid(frame) THEN coalesce(json_extract(frame, '$.is_only_recent'), 0) ELSE 0 END
            FROM inspection JOIN detail USING (number)
            WHERE frame_bytes IS NOT NULL AND remark = '' AND label IS NULL ORDER BY number",
        )?;
        let rows = asked.query_map([], |row| {
            let bytes: i64 = row.get(1)?;
            Ok(PrunableFrame {
                number: row.get(0)?,
                bytes: bytes as u64,
                is_only_recent: row.get(2)?,
            })
        })?;
        rows.collect()
    }

    /// Deletes the references to these frames, and returns their records.
    fn forget(&mut self, numbers: &[i64]) -> rusqlite::Result<Vec<FrameRecord>> {
        let file = self
            .file
            .transaction_with_behavior(TransactionBehavior::Immediate)?;
        let mut files = Vec::new();
        for number in numbers {
            let asked = "SELECT frame FROM detail WHERE number = ?";
            let frame: Option<String> = file.query_row(asked, [number], |row| row.get(0))?;
            let frame = frame.and_then(|frame| serde_json::from_str::<FrameRecord>(&frame).ok());
            files.extend(frame);
            file.execute("UPDATE detail SET frame = NULL WHERE number = ?", [number])?;
            file.execute(
                "UPDATE inspection SET frame_bytes = NULL WHERE number = ?",
                [number],
            )?;
        }
        file.commit()?;
        Ok(files)
    }

    fn remove_files(&self, leaving: &[FrameRecord]) -> Result<(), HistoryError> {
        for path in leaving.iter().flat_map(|frame| frame.paths(&self.frames)) {
            frames::remove(&path).map_err(|error| HistoryError::io(&path, error))?;
        }
        Ok(())
    }

    /// Makes rows and frames consistent: removes frames that no row refers to, and references to missing frames. Call
    /// it only while nobody else has the history open.
    pub(super) fn tidy(mut self) -> Result<(), HistoryError> {
        let kept = self.kept_frames().map_err(|error| self.error(error))?;
        let gone: Vec<i64> = kept
            .iter()
            .filter(|(_, frame)| frame.files().any(|file| !self.frames.join(file).is_file()))
            .map(|(number, _)| *number)
            .collect();
        if !gone.is_empty() {
            self.forget(&gone).map_err(|error| self.error(error))?;
        }
        let frames = kept.iter().map(|(_, frame)| frame);
        let names: BTreeSet<&str> = frames
            .flat_map(|frame| frame.files().chain(frame.empty_cell.as_deref()))
            .collect();
        let removed = frames::remove_strays(&self.frames, &|name| names.contains(name));
        removed.map_err(|error| HistoryError::io(&self.frames, error))?;
        Ok(())
    }

    fn kept_frames(&self) -> rusqlite::Result<Vec<(i64, FrameRecord)>> {
        let mut asked = self.file.prepare(
            "SELECT number, frame FROM detail JOIN inspection USING (number) WHERE frame_bytes IS NOT NULL",
        )?;
        let rows = asked.query_map([], |row| {
            let (number, frame): (i64, Option<String>) = (row.get(0)?, row.get(1)?);
            Ok(frame
                .and_then(|frame| serde_json::from_str(&frame).ok())
                .map(|frame| (number, frame)))
        })?;
        rows.filter_map(Result::transpose).collect()
    }
}
