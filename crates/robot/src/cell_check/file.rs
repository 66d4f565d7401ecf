//! The folder with the baseline and the result of every check.
//!
//! `baseline.toml` names the file of the points, `part-CHECKSUM.pcd`, which is written before it: a power cut leaves
//! the old baseline or the new one. `checks.jsonl` has a line per check, the newest last.

use std::path::{Path, PathBuf};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::{CellBaseline, CellCheck, CellLimits, CellView, view::PlanePatch};
use files::{
    FileContent, FileError, FileLock, crc32, disk, open, parse_toml, read_text, toml_problem,
    user_data, write_atomically, write_pcd, write_text,
};
use geometry::{
    cloud::is_finite,
    error::Advice,
    units::{Metres, Radians},
};

/// Version of the baseline file that this program writes, and the newest that it reads.
const SCHEMA_VERSION: u32 = 1;
const BASELINE: &str = "baseline.toml";
const CHECKS: &str = "checks.jsonl";
const LOCK: &str = ".lock";
/// Largest baseline file that is read, bytes.
const MAX_BASELINE_BYTES: u64 = 1 << 16;
/// Limit for coordinates in the file; NaN fails the comparison too.
const MAX_COORDINATE_M: f64 = 1000.0;
/// Largest file of checks, bytes: some 100 000 checks.
const MAX_CHECK_BYTES: u64 = 1 << 26;

/// The folder of a cell's baseline and checks; it need not exist before the first baseline.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CellCheckFolder {
    path: PathBuf,
}

/// Why a baseline or the checks cannot be read or written.
#[derive(Debug, thiserror::Error, Advice)]
pub enum CellCheckError {
    /// A file cannot be read or written.
    #[error(transparent)]
    #[advice(match _0 {
        FileError::Newer { .. } => "Update Partsight, or take a new baseline with this version".into(),
        other => other.advice(),
    })]
    File(#[from] FileError),
    /// There is no baseline yet.
    #[error("{}: there is no baseline to compare with", path.display())]
    #[advice = "Take one while the cell is right: partsight cell baseline FILE, or --source kinect"]
    NoBaseline {
        /// The folder.
        path: PathBuf,
    },
    /// A file has unexpected content.
    #[error("{}: {found}", path.display())]
    #[advice(if path.ends_with(CHECKS) {
        "Move the file away: the next check begins a new one"
    } else {
        "Take a new baseline"
    })]
    Bad {
        /// The file.
        path: PathBuf,
        /// The first error in it.
        found: String,
    },
}

/// Content of the baseline file.
#[derive(Debug, Serialize, Deserialize)]
struct Text {
    schema_version: u32,
    made_at: Timestamp,
    num_frames: usize,
    simulated: bool,
    /// File name of the points, in the same folder.
    part: String,
    noise_at_1m_m: f64,
    max_shift_m: f64,
    max_turn_rad: f64,
    /// For each plane, the ends of the two axes of its visible patch, camera space, metres.
    #[serde(default)]
    background: Vec<[[f64; 3]; 4]>,
}

impl CellCheckFolder {
    /// The folder at this path.
    pub fn at(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into() }
    }

    /// The user's own folder, beside the calibration in the system's folder for user data.
    pub fn of_user() -> Result<Self, CellCheckError> {
        let folder = user_data()?;
        Ok(Self::at(folder.join("cell-check")))
    }

    /// Path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Saves a baseline in place of the former one.
    pub fn save(&self, baseline: &CellBaseline) -> Result<(), CellCheckError> {
        let CellView {
            part,
            background,
            noise_at_1m,
        } = &baseline.view;
        let mut points = Vec::new();
        // Writing to memory does not fail.
        let _ = write_pcd(&mut points, part);
        let name = format!("part-{:08x}.pcd", crc32(&points));
        let text = Text {
            schema_version: SCHEMA_VERSION,
            made_at: baseline.made_at,
            num_frames: baseline.num_frames,
            simulated: baseline.is_simulated,
            part: name.clone(),
            noise_at_1m_m: noise_at_1m.0,
            max_shift_m: baseline.limits.shift.0,
            max_turn_rad: baseline.limits.turn.0,
            background: background
                .iter()
                .map(|patch| patch.ends.map(Into::into))
                .collect(),
        };
        let text = toml::to_string(&text).expect("numbers and text have a TOML form");
        self.writing(|| {
            write_atomically(&self.path.join(&name), |writer| writer.write_all(&points))?;
            write_text(&self.path.join(BASELINE), &text)?;
            self.remove_points_but(&name);
            Ok(())
        })
    }

    /// Removes the points of former baselines; one that cannot be removed does no harm.
    fn remove_points_but(&self, name: &str) {
        for entry in std::fs::read_dir(&self.path)
            .into_iter()
            .flatten()
            .flatten()
        {
            let file = entry.file_name();
            let file = file.to_string_lossy();
            let is_points = file.starts_with("part-") && file.ends_with(".pcd");
            if is_points && file != name {
                let _ = disk::remove_file(entry.path());
            }
        }
    }

    /// Reads the baseline.
    pub fn baseline(&self) -> Result<CellBaseline, CellCheckError> {
        let path = self.path.join(BASELINE);
        let bad = |found: String| CellCheckError::Bad {
            path: path.clone(),
            found,
        };
        let text = match read_text(&path, MAX_BASELINE_BYTES) {
            Err(FileError::NotFound { .. }) => {
                return Err(CellCheckError::NoBaseline {
                    path: self.path.clone(),
                });
            }
            text => text?,
        };
        let read: Text = parse_toml(&path, &text, SCHEMA_VERSION, |error| {
            bad(toml_problem(&text, &error))
        })?;
        if Path::new(&read.part).file_name() != Some(read.part.as_ref()) {
            return Err(bad("the file of the points beside it is missing".into()));
        }
        let limits = CellLimits {
            shift: Metres(read.max_shift_m),
            turn: Radians(read.max_turn_rad),
        };
        let is_positive = |x: f64| x.is_finite() && x > 0.0;
        if ![read.max_shift_m, read.max_turn_rad, read.noise_at_1m_m]
            .into_iter()
            .all(is_positive)
        {
            return Err(bad("a limit or the noise is not above 0".into()));
        }
        let background = read.background.iter().map(|ends| {
            let is_near = ends.iter().flatten().all(|x| x.abs() < MAX_COORDINATE_M);
            PlanePatch::through(ends.map(Into::into)).filter(|_| is_near)
        });
        let background: Option<Vec<PlanePatch>> = background.collect();
        let background = background.ok_or_else(|| bad("wall or floor is not a plane".into()))?;
        let points = self.path.join(&read.part);
        let part = match open(&points)? {
            FileContent::Cloud(cloud) if cloud.points.iter().all(is_finite) => cloud,
            _ => {
                return Err(CellCheckError::Bad {
                    path: points,
                    found: "not the points of a baseline".into(),
                });
            }
        };
        Ok(CellBaseline {
            made_at: read.made_at,
            num_frames: read.num_frames,
            is_simulated: read.simulated,
            limits,
            view: CellView {
                part,
                background,
                noise_at_1m: Metres(read.noise_at_1m_m),
            },
        })
    }

    /// Appends a check.
    pub fn add(&self, check: &CellCheck) -> Result<(), CellCheckError> {
        let path = self.path.join(CHECKS);
        let line = serde_json::to_string(check).expect("numbers and text have a JSON form");
        self.writing(|| {
            let mut text = match read_text(&path, MAX_CHECK_BYTES) {
                Err(FileError::NotFound { .. } | FileError::Empty { .. }) => String::new(),
                text => text?,
            };
            if !text.is_empty() && !text.ends_with('\n') {
                text.push('\n');
            }
            text += &line;
            text.push('\n');
            write_text(&path, &text)?;
            Ok(())
        })
    }

    /// Reads all checks, the oldest first.
    pub fn checks(&self) -> Result<Vec<CellCheck>, CellCheckError> {
        let path = self.path.join(CHECKS);
        let text = match read_text(&path, MAX_CHECK_BYTES) {
            Err(FileError::NotFound { .. } | FileError::Empty { .. }) => return Ok(Vec::new()),
            text => text?,
        };
        let lines = text
            .lines()
            .enumerate()
            .filter(|(_, line)| !line.trim().is_empty());
        lines
            .map(|(i, line)| {
                serde_json::from_str(line).map_err(|error| CellCheckError::Bad {
                    path: path.clone(),
                    found: format!("line {}: no check: {error}", i + 1),
                })
            })
            .collect()
    }

    /// Runs a change under the folder's exclusive lock. Creates the folder if it is missing.
    fn writing<T>(
        &self,
        change: impl FnOnce() -> Result<T, CellCheckError>,
    ) -> Result<T, CellCheckError> {
        let failed = |source| FileError::writing(&self.path, source);
        disk::create_dir_all(&self.path).map_err(failed)?;
        let _lock = FileLock::exclusive(&self.path.join(LOCK)).map_err(failed)?;
        change()
    }
}
