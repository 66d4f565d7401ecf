//! Runs of visual servoing: what was moved to where, how it ended, and its curve. They have tables of their own, so that
//! nothing that counts inspections counts them.

use std::{io::Write as _, path::Path};

use jiff::Timestamp;
use rusqlite::{
    OptionalExtension as _, Row, TransactionBehavior, params, params_from_iter,
    types::{Type, Value},
};
use serde::{Deserialize, Serialize, de::DeserializeOwned};

use super::{
    entry::StoredVerdict,
    error::HistoryError,
    filter::{Filter, VerdictFilter},
    rows::json,
    store::{History, Page},
};
use files::{FileError, csv_text, write_atomically};
use servo::{ServoState, StopReason};

/// What a run was to reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ServoTargetKind {
    /// The part's standard position.
    StandardPosition,
    /// A recorded camera pose.
    CameraPose,
    /// The first point of the spray path.
    PathStart,
}

impl ServoTargetKind {
    /// Every target.
    pub const ALL: [Self; 3] = [Self::StandardPosition, Self::CameraPose, Self::PathStart];

    /// Returns the name in the file.
    pub fn name(self) -> &'static str {
        match self {
            Self::StandardPosition => "standard_position",
            Self::CameraPose => "camera_pose",
            Self::PathStart => "path_start",
        }
    }
}

/// A run of servoing as a row of a list.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ServoRun {
    /// Counts from 1 and is never reused; negative while the run is not written yet.
    pub number: i64,
    /// When the robot first reported.
    pub at: Timestamp,
    /// The part.
    pub part: String,
    /// Title that the part had then.
    pub title: String,
    /// What was to be reached.
    pub target: ServoTargetKind,
    /// Protocol and address of the robot.
    pub robot: String,
    /// The camera.
    pub source: String,
    /// True if robot and camera were simulated.
    #[serde(rename = "simulated")]
    pub is_simulated: bool,
    /// Why it stopped; `None` if the target was reached.
    pub stopped: Option<StopReason>,
    /// Shift that was left, as far as known.
    pub error_m: Option<f64>,
    /// Angle that was left, as far as known.
    pub error_rad: Option<f64>,
    /// Bound of the shift at the target, 95 %.
    pub bounds_m: Option<f64>,
    /// Bound of the angle at the target, 95 %.
    pub bounds_rad: Option<f64>,
    /// True if by its shape the part may be another model.
    #[serde(rename = "approximate")]
    pub is_approximate: bool,
    /// Time from the robot's first report to the end.
    pub took_s: f64,
    /// Number of frames that were inspected.
    pub num_looks: usize,
    /// Limit of the speed; `None` if the robot chose it itself.
    pub speed_m_s: Option<f64>,
    /// Tolerance of the shift.
    pub tolerance_m: f64,
    /// Tolerance of the angle.
    pub tolerance_rad: f64,
    /// Version of the program.
    pub program: String,
}

/// A run at one of its frames.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ServoSample {
    /// When the frame was taken, from the robot's first report on.
    pub at_s: f64,
    /// Shift that was left; `None` until enough frames agreed.
    pub error_m: Option<f64>,
    /// Angle that was left.
    pub error_rad: Option<f64>,
    /// What the run was doing.
    pub state: ServoState,
    /// Kind of the reason for which the robot was held.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub held: Option<String>,
}

/// A run in full.
#[derive(Clone, Debug, PartialEq)]
pub struct ServoRecord {
    /// The row.
    pub run: ServoRun,
    /// Its curve, from the start on.
    pub curve: Vec<ServoSample>,
}

/// The columns of a row, in the order in which they are written.
const COLUMNS: &str = "at, part, title, target, robot, source, simulated, stopped, error_m, error_rad, bounds_m, bounds_rad, \
    approximate, took_s, num_looks, speed_m_s, tolerance_m, tolerance_rad, program";

impl ServoRun {
    /// Returns the lower-case text in which a filter looks for its words.
    fn search(&self) -> String {
        let kind = self.stopped.as_ref().map_or("", StopReason::kind);
        let mut text = format!(
            "{}\n{}\n{}\n{}\n{kind}",
            self.title, self.part, self.robot, self.source
        );
        if self.is_simulated {
            text.push_str("\n=simulated");
        }
        text.to_lowercase()
    }
}

impl Filter {
    /// As [`Self::condition`], for runs of servoing: those that reached their target count as accepted.
    fn servo_condition(&self) -> (String, Vec<Value>) {
        let (mut parts, values) = self.common_conditions();
        parts.extend(self.verdict.map(|verdict| {
            let condition = match verdict {
                VerdictFilter::Only(StoredVerdict::Accepted) => "stopped IS NULL",
                VerdictFilter::NotAccepted => "stopped IS NOT NULL",
                VerdictFilter::Only(_) => "0",
            };
            condition.to_owned()
        }));
        if parts.is_empty() {
            parts.push("1".into());
        }
        (parts.join(" AND "), values)
    }

    /// Returns whether a run matches the filter.
    pub(super) fn passes_servo(&self, run: &ServoRun) -> bool {
        let search = run.search();
        self.since.is_none_or(|since| run.at >= since)
            && self.until.is_none_or(|until| run.at < until)
            && self.part.as_ref().is_none_or(|part| *part == run.part)
            && self.verdict.is_none_or(|verdict| match verdict {
                VerdictFilter::Only(StoredVerdict::Accepted) => run.stopped.is_none(),
                VerdictFilter::NotAccepted => run.stopped.is_some(),
                VerdictFilter::Only(_) => false,
            })
            && self.is_simulated.is_none_or(|is| run.is_simulated == is)
            && self
                .source
                .as_ref()
                .is_none_or(|source| run.source == *source)
            && self.has_words_of(&search)
    }
}

impl History {
    /// Writes a run with its curve, completely or not at all. Returns its number.
    pub fn add_servo_run(&mut self, record: &ServoRecord) -> Result<i64, HistoryError> {
        let ServoRecord { run, curve } = record;
        let mut write = || -> rusqlite::Result<i64> {
            let file = self
                .file
                .transaction_with_behavior(TransactionBehavior::Immediate)?;
            file.execute(
                &format!(
                    "INSERT INTO servo_run ({COLUMNS}, search)
                    VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"
                ),
                params![
                    run.at.as_microsecond(),
                    run.part,
                    run.title,
                    run.target.name(),
                    run.robot,
                    run.source,
                    run.is_simulated,
                    run.stopped.as_ref().and_then(json),
                    run.error_m,
                    run.error_rad,
                    run.bounds_m,
                    run.bounds_rad,
                    run.is_approximate,
                    run.took_s,
                    run.num_looks as i64,
                    run.speed_m_s,
                    run.tolerance_m,
                    run.tolerance_rad,
                    run.program,
                    run.search(),
                ],
            )?;
            let number = file.last_insert_rowid();
            file.execute(
                "INSERT INTO servo_curve (number, json) VALUES (?, ?)",
                params![number, json(curve)],
            )?;
            file.commit()?;
            Ok(number)
        };
        write().map_err(|error| HistoryError::of(&self.path, error))
    }

    /// Returns up to `most` matching runs from this offset on, newest first, and the totals.
    pub fn servo_runs(
        &self,
        filter: &Filter,
        offset: usize,
        most: usize,
    ) -> Result<Page<ServoRun>, HistoryError> {
        let (condition, values) = filter.servo_condition();
        let count = |condition: &str| {
            let asked = format!("SELECT count(*) FROM servo_run WHERE {condition}");
            let values: &[Value] = if condition == "1" { &[] } else { &values[..] };
            self.file
                .query_row(&asked, params_from_iter(values), |row| row.get::<_, i64>(0))
        };
        let found = || -> rusqlite::Result<Page<ServoRun>> {
            let asked = format!(
                "SELECT number, {COLUMNS} FROM servo_run WHERE {condition}
                ORDER BY at DESC, number DESC LIMIT {most} OFFSET {offset}"
            );
            let mut asked = self.file.prepare(&asked)?;
            let rows = asked.query_map(params_from_iter(&values), run_of)?;
            Ok(Page {
                rows: rows.collect::<rusqlite::Result<_>>()?,
                num_matching: count(&condition)? as usize,
                num_all: count("1")? as usize,
            })
        };
        found().map_err(|error| self.error(error))
    }

    /// Returns a run in full; it is an error if it does not exist.
    pub fn servo_run(&self, number: i64) -> Result<ServoRecord, HistoryError> {
        let found = || -> rusqlite::Result<Option<ServoRecord>> {
            let asked = format!(
                "SELECT number, {COLUMNS}, json FROM servo_run JOIN servo_curve USING (number) WHERE number = ?"
            );
            let record = self.file.query_row(&asked, [number], |row| {
                let curve: String = row.get("json")?;
                Ok(ServoRecord {
                    run: run_of(row)?,
                    curve: read(&curve)?,
                })
            });
            record.optional()
        };
        let record = found().map_err(|error| self.error(error))?;
        record.ok_or(HistoryError::NoSuchServoRun { number })
    }
}

/// Reads a value that is stored as JSON. One that cannot be read is an error: a run must not look as if it had arrived.
fn read<T: DeserializeOwned>(stored: &str) -> rusqlite::Result<T> {
    serde_json::from_str(stored)
        .map_err(|error| rusqlite::Error::FromSqlConversionFailure(0, Type::Text, error.into()))
}

fn run_of(row: &Row<'_>) -> rusqlite::Result<ServoRun> {
    let at = Timestamp::from_microsecond(row.get("at")?);
    let target: String = row.get("target")?;
    let stopped: Option<String> = row.get("stopped")?;
    Ok(ServoRun {
        number: row.get("number")?,
        at: at.unwrap_or(Timestamp::UNIX_EPOCH),
        part: row.get("part")?,
        title: row.get("title")?,
        target: read(&format!("{target:?}"))?,
        robot: row.get("robot")?,
        source: row.get("source")?,
        is_simulated: row.get("simulated")?,
        stopped: stopped.map(|stopped| read(&stopped)).transpose()?,
        error_m: row.get("error_m")?,
        error_rad: row.get("error_rad")?,
        bounds_m: row.get("bounds_m")?,
        bounds_rad: row.get("bounds_rad")?,
        is_approximate: row.get("approximate")?,
        took_s: row.get("took_s")?,
        num_looks: row.get::<_, i64>("num_looks")? as usize,
        speed_m_s: row.get("speed_m_s")?,
        tolerance_m: row.get("tolerance_m")?,
        tolerance_rad: row.get("tolerance_rad")?,
        program: row.get("program")?,
    })
}

/// Header line of the table.
const HEAD: &str = "number,time,part,title,target,robot,source,simulated,arrived,stopped,reason,error_m,error_rad,\
    bounds_m,bounds_rad,approximate,took_s,looks,speed_m_s,tolerance_m,tolerance_rad,program";

/// Writes runs as comma-separated values. Times are UTC; lengths are in metres, angles in radians.
pub fn write_servo_table<'r>(
    path: &Path,
    runs: impl IntoIterator<Item = &'r ServoRun>,
) -> Result<usize, HistoryError> {
    let mut text = format!("{HEAD}\n").into_bytes();
    let mut num = 0;
    for run in runs {
        let number = |value: Option<f64>| value.map_or_else(String::new, |x| format!("{x:.6}"));
        let reason = run.stopped.as_ref().map(ToString::to_string);
        let written = writeln!(
            text,
            "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{:.3},{},{},{},{},{}",
            run.number,
            run.at,
            csv_text(&run.part),
            csv_text(&run.title),
            run.target.name(),
            csv_text(&run.robot),
            csv_text(&run.source),
            run.is_simulated,
            run.stopped.is_none(),
            run.stopped.as_ref().map_or("", StopReason::kind),
            csv_text(&reason.unwrap_or_default()),
            number(run.error_m),
            number(run.error_rad),
            number(run.bounds_m),
            number(run.bounds_rad),
            run.is_approximate,
            run.took_s,
            run.num_looks,
            run.speed_m_s
                .map_or_else(String::new, |speed| speed.to_string()),
            run.tolerance_m,
            run.tolerance_rad,
            run.program,
        );
        written.map_err(|error| FileError::writing(path, error))?;
        num += 1;
    }
    write_atomically(path, |writer| writer.write_all(&text))?;
    Ok(num)
}

#[cfg(test)]
mod tests;
