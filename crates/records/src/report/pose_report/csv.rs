//! Pose reports as rows of a growing CSV file, one per inspection.
//!
//! A row is written in one go under a lock, and is on the disk before the call returns. A program killed meanwhile
//! leaves at most one incomplete row, which the next call moves to a separate file.

use std::{
    fs::File,
    io::{self, Read as _, Seek as _, SeekFrom},
    path::{Path, PathBuf},
};

use super::{PoseReport, TransformBlock};
use files::{advice_on, csv_text, disk, folder_of, sync_folder, words_of};
use geometry::error::Advice;
use robot::Convention;

/// Why a row could not be appended.
#[derive(Debug, thiserror::Error, Advice)]
pub enum CsvError {
    /// The file has other columns, or is not a table of pose reports.
    #[error("{}: its columns are not those of a pose report in {}", path.display(), convention.title())]
    #[advice = "Append to another file: each convention and version of the report has its own"]
    OtherColumns {
        /// The file.
        path: PathBuf,
        /// Convention of the row.
        convention: Convention,
    },
    /// The file cannot be written.
    #[error("{}: cannot append a row: {}", path.display(), words_of(source))]
    #[advice(advice_on(source))]
    Io {
        /// The file.
        path: PathBuf,
        /// The underlying error.
        source: io::Error,
    },
}

/// Appends the report to the file. A missing or empty file is created with a line of column names. If the last row was
/// incomplete, moves it to another file first, and returns that file.
pub fn append_csv(path: &Path, report: &PoseReport) -> Result<Option<PathBuf>, CsvError> {
    let failed = |source| CsvError::Io {
        path: path.to_owned(),
        source,
    };
    let columns = columns(report);
    let line = |cells: Vec<&str>| cells.join(",") + "\n";
    let header = line(columns.iter().map(|(name, _)| name.as_str()).collect());
    let row = line(columns.iter().map(|(_, value)| value.as_str()).collect());

    // One writer at a time, from any program.
    let mut options = File::options();
    options.read(true).write(true).create(true).truncate(false);
    let mut file = disk::open(&options, path).map_err(failed)?;
    // On a disk without locks, only a single program at a time can append safely.
    let _ = file.lock();
    let mut length = file.metadata().map_err(failed)?.len();
    let mut begin = vec![
        0;
        header
            .len()
            .min(usize::try_from(length).unwrap_or(usize::MAX))
    ];
    file.seek(SeekFrom::Start(0))
        .and_then(|_| file.read_exact(&mut begin))
        .map_err(failed)?;
    if !header.as_bytes().starts_with(&begin) {
        return Err(CsvError::OtherColumns {
            path: path.to_owned(),
            convention: report.robot.convention,
        });
    }
    let mut aside = None;
    let text = if begin.len() < header.len() {
        // A program was killed before the first line was complete.
        disk::set_len(&file, 0).map_err(failed)?;
        length = 0;
        header + &row
    } else {
        let end = end_of_last_row(&mut file, length).map_err(failed)?;
        if end < length {
            aside = Some(set_aside(path, &mut file, end).map_err(failed)?);
            length = end;
        }
        row
    };
    let written = file
        .seek(SeekFrom::Start(length))
        .and_then(|_| disk::write_all(&mut file, text.as_bytes()))
        .and_then(|()| disk::sync_data(&file));
    if let Err(error) = written {
        // Remove a partial row; if this fails too, the next call sets it aside.
        let _ = disk::set_len(&file, length);
        return Err(failed(error));
    }
    if length == 0 {
        // The file itself may be new.
        sync_folder(folder_of(path)).map_err(failed)?;
    }
    Ok(aside)
}

/// Returns where the last complete row ends.
fn end_of_last_row(file: &mut File, length: u64) -> io::Result<u64> {
    const BLOCK: u64 = 4096;
    let mut end = length;
    while end > 0 {
        let begin = end.saturating_sub(BLOCK);
        let mut block = vec![0; (end - begin) as usize];
        file.seek(SeekFrom::Start(begin))?;
        file.read_exact(&mut block)?;
        if let Some(last) = block.iter().rposition(|byte| *byte == b'\n') {
            return Ok(begin + last as u64 + 1);
        }
        end = begin;
    }
    Ok(0)
}

/// Moves everything after `end` into a separate file next to it.
fn set_aside(path: &Path, file: &mut File, end: u64) -> io::Result<PathBuf> {
    let mut tail = Vec::new();
    file.seek(SeekFrom::Start(end))?;
    file.read_to_end(&mut tail)?;
    tail.push(b'\n');
    let mut name = path.as_os_str().to_owned();
    name.push(".unfinished");
    let aside = PathBuf::from(name);
    let mut kept = disk::open(File::options().append(true).create(true), &aside)?;
    disk::write_all(&mut kept, &tail)?;
    disk::sync_data(&kept)?;
    disk::set_len(file, end)?;
    Ok(aside)
}

/// Returns the names of the columns and this report's values, as written to the file.
fn columns(report: &PoseReport) -> Vec<(String, String)> {
    let mut columns = Vec::new();
    let mut add = |name: &str, value: String| columns.push((name.to_owned(), quoted(&value)));
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    let word = |value: Option<&str>| value.unwrap_or_default().to_owned();

    add("schema", report.schema.to_string());
    add("inspected_at", report.inspected_at.to_string());
    add("program", report.program.clone());
    add("scene", report.scene.clone());
    add("source", word(report.source.as_deref()));
    add("seen_by", snake(&report.seen_by));
    let verdict = &report.verdict;
    add("status", verdict.status.to_owned());
    add("part", word(verdict.part.as_deref()));
    add("nearest", word(verdict.nearest.as_deref()));
    add("accepted", verdict.accepted.to_string());
    add("score", number(verdict.score));
    add("margin", number(verdict.margin));
    add("reason", word(verdict.reason.as_deref()));
    add("approximate", verdict.approximate.to_string());
    add("touches_edge", verdict.touches_edge.to_string());
    // Leave the pose empty unless it was accepted: readers of a table do not check another column first.
    let pose = report.pose.as_ref();
    let reference = pose.and_then(|pose| pose.reference.as_deref());
    add("reference", word(reference));
    add(
        "ambiguous",
        pose.map_or_else(String::new, |pose| pose.fit.ambiguous.to_string()),
    );
    let mut transform = |name: &str, convention: Convention, values: Option<Vec<f64>>| {
        for (i, (value_name, unit)) in convention.named_units().enumerate() {
            let unit = if unit.symbol().is_empty() {
                String::new()
            } else {
                format!("_{}", unit.symbol())
            };
            let value = values.as_ref().and_then(|values| values.get(i)).copied();
            add(&format!("{name}_{value_name}{unit}"), number(value));
        }
    };
    let plain = Convention::QuaternionXyzw;
    transform(
        "camera_from_part",
        plain,
        pose.map(|pose| pose.camera_from_part.quaternion.values.clone()),
    );
    let robot = &report.robot;
    let named = |name: &str| format!("{name}_{}", robot.convention.name());
    let values =
        |block: &Option<TransformBlock>| block.as_ref().map(|block| block.in_convention.numbers());
    transform(
        &named("robot_from_part"),
        robot.convention,
        values(&robot.robot_from_part),
    );
    transform(
        &named("robot_offset"),
        robot.convention,
        values(&robot.robot_offset),
    );
    add("calibration", word(robot.calibration.as_deref()));
    add("robot_unavailable", word(robot.unavailable.as_deref()));
    add("rms_m", number(pose.map(|pose| pose.fit.rms_m)));
    add("overlap", number(pose.map(|pose| pose.fit.overlap)));
    let bounds = pose.and_then(|pose| pose.bounds.as_ref());
    add("shift_bound_m", number(bounds.map(|bounds| bounds.shift_m)));
    add(
        "turn_bound_deg",
        number(bounds.map(|bounds| bounds.turn_deg)),
    );
    let stand_off = report.stand_off.as_ref();
    add(
        "stand_off_mean_m",
        number(stand_off.map(|found| found.mean_m)),
    );
    add(
        "stand_off_worst_m",
        number(stand_off.map(|found| found.worst_m)),
    );
    add(
        "stand_off_in_band",
        number(stand_off.map(|found| found.in_band)),
    );
    add("total_ms", number(Some(report.timings_ms.total)));
    add("recipe", report.recipe.identity.clone());
    add("library", report.library.identity.clone());
    let trace = &report.traceability;
    add("serial", trace.serial.clone());
    add("order", trace.order.clone());
    add("operator", trace.operator.clone());
    add("reported_as", word(verdict.reported_as.as_deref()));
    add(
        "off_scale",
        number(pose.and_then(|pose| pose.fit.off_scale)),
    );
    let doubts: Vec<&str> = robot.doubts.iter().map(|doubt| doubt.kind).collect();
    add("robot_doubts", doubts.join(" "));
    columns
}

/// Returns a value as JSON writes it.
fn snake(value: &impl serde::Serialize) -> String {
    let json = serde_json::to_value(value).ok();
    json.as_ref()
        .and_then(serde_json::Value::as_str)
        .unwrap_or_default()
        .to_owned()
}

/// Quotes a cell and removes line breaks.
fn quoted(value: &str) -> String {
    let line: String = value
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    csv_text(&line).into_owned()
}

#[cfg(test)]
mod tests;
