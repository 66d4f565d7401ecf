//! Pose and fit of accepted parts over time, which show how the cell drifts.

use jiff::Timestamp;
use rusqlite::params_from_iter;
use serde::Deserialize;

use super::{
    entry::{Record, StoredVerdict},
    error::HistoryError,
    filter::Filter,
    store::History,
};
use geometry::rigid::{RigidTransform, from_row_major};

/// Maximum number of poses read; each requires parsing the JSON line of its inspection.
pub const MAX_POSES: usize = 2000;

/// Pose and fit of an accepted part.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseRecord {
    /// Time of the inspection.
    pub at: Timestamp,
    /// Score, 0..1.
    pub score: f64,
    /// Name of the reference that the pose refers to.
    pub reference: String,
    /// Pose of the part.
    pub camera_from_part: RigidTransform,
    /// Root mean square distance of the part from the reference, metres.
    pub rms_m: f64,
}

/// The fields read from the line that `inspect --json` writes.
#[derive(Deserialize)]
struct Line {
    pose: Option<Pose>,
}

#[derive(Deserialize)]
struct Pose {
    reference: Option<String>,
    camera_from_part: [f64; 16],
    rms_m: f64,
}

impl PoseRecord {
    /// Parses a line; `None` without a pose, or if another version of the program wrote it in another form.
    fn of_line(at: Timestamp, score: f64, line: &str) -> Option<Self> {
        let pose = serde_json::from_str::<Line>(line).ok()?.pose?;
        Some(Self {
            at,
            score,
            reference: pose.reference?,
            camera_from_part: from_row_major(&pose.camera_from_part, 1e-6)?,
            rms_m: pose.rms_m,
        })
    }

    /// Reads an inspection that is not in the file yet.
    pub(super) fn of_record(record: &Record) -> Option<Self> {
        let Record { summary, detail } = record;
        let [score, _] = summary.score?;
        let is_accepted = summary.verdict == StoredVerdict::Accepted;
        Self::of_line(summary.at, score, &detail.line).filter(|_| is_accepted)
    }
}

impl History {
    /// Returns the poses of the newest [`MAX_POSES`] accepted parts that match the filter, the oldest first.
    pub fn poses(&self, filter: &Filter) -> Result<Vec<PoseRecord>, HistoryError> {
        let (condition, values) = filter.condition();
        let asked = format!(
            "SELECT at, score, line FROM inspection JOIN detail USING (number)
                WHERE {condition} AND verdict = 'accepted' AND score IS NOT NULL
                ORDER BY at DESC, number DESC LIMIT {MAX_POSES}"
        );
        let read = || -> rusqlite::Result<Vec<PoseRecord>> {
            let mut asked = self.file.prepare(&asked)?;
            let rows = asked.query_map(params_from_iter(values), |row| {
                let at = Timestamp::from_microsecond(row.get(0)?).unwrap_or(Timestamp::UNIX_EPOCH);
                let line: String = row.get(2)?;
                Ok(PoseRecord::of_line(at, row.get(1)?, &line))
            })?;
            let mut poses = rows
                .filter_map(Result::transpose)
                .collect::<rusqlite::Result<Vec<_>>>()?;
            poses.reverse();
            Ok(poses)
        };
        read().map_err(|error| self.error(error))
    }
}
