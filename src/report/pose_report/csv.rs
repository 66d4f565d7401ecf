//! Pose reports as rows of one file, one inspection each, which grows from call to call.
//!
//! A row goes out in one write behind a lock, and is on the disk before the call returns. A program that was killed in
//! the middle leaves a row without its end at most: it is set aside beside the file when the next one comes.

use std::{
    fs::{File, OpenOptions},
    io::{self, Read as _, Seek as _, SeekFrom, Write as _},
    path::{Path, PathBuf},
};

use super::{PoseReport, TransformBlock};
use crate::{
    error::Advice,
    files::{advice_on, words_of},
    robot::Convention,
};

/// Why a row could not be appended.
#[derive(Debug, thiserror::Error)]
pub enum CsvError {
    /// The file has other columns, or is something else.
    #[error("{}: its columns are not those of a pose report in {}", path.display(), convention.title())]
    OtherColumns {
        /// The file.
        path: PathBuf,
        /// The convention that the row is in.
        convention: Convention,
    },
    /// The system refused.
    #[error("{}: cannot append a row: {}", path.display(), words_of(source))]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

impl Advice for CsvError {
    fn advice(&self) -> String {
        match self {
            Self::OtherColumns { .. } => {
                "Append to another file: each convention and version of the report has its own"
                    .into()
            }
            Self::Io { source, .. } => advice_on(source).into(),
        }
    }
}

/// What else appending came to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CsvAppended {
    /// The row alone.
    Row,
    /// The last row had no end, and was set aside in this file before.
    SetAside(PathBuf),
}

/// Appends the report to the file, which is made with a line of column names where it is missing or empty.
pub fn append_csv(path: &Path, report: &PoseReport) -> Result<CsvAppended, CsvError> {
    let failed = |source| CsvError::Io {
        path: path.to_owned(),
        source,
    };
    let columns = columns(report);
    let line = |cells: Vec<&str>| cells.join(",") + "\n";
    let header = line(columns.iter().map(|(name, _)| name.as_str()).collect());
    let row = line(columns.iter().map(|(_, value)| value.as_str()).collect());

    // Only one at a time, from whichever program.
    let mut file = OpenOptions::new()
        .read(true)
        .append(true)
        .create(true)
        .open(path)
        .map_err(failed)?;
    file.lock().map_err(failed)?;
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
    let mut appended = CsvAppended::Row;
    let text = if begin.len() < header.len() {
        // Killed before the first line was whole.
        file.set_len(0).map_err(failed)?;
        length = 0;
        header + &row
    } else {
        let end = end_of_last_row(&mut file, length).map_err(failed)?;
        if end < length {
            appended = CsvAppended::SetAside(set_aside(path, &mut file, end).map_err(failed)?);
            length = end;
        }
        row
    };
    let written = file
        .write_all(text.as_bytes())
        .and_then(|()| file.sync_data());
    if let Err(error) = written {
        // Half a row helps nobody; where this fails too, the next call sets it aside.
        let _ = file.set_len(length);
        return Err(failed(error));
    }
    Ok(appended)
}

/// Where the last whole row ends.
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

/// Moves what stands behind `end` into a file of its own beside it.
fn set_aside(path: &Path, file: &mut File, end: u64) -> io::Result<PathBuf> {
    let mut tail = Vec::new();
    file.seek(SeekFrom::Start(end))?;
    file.read_to_end(&mut tail)?;
    tail.push(b'\n');
    let mut name = path.as_os_str().to_owned();
    name.push(".unfinished");
    let aside = PathBuf::from(name);
    let mut kept = OpenOptions::new().append(true).create(true).open(&aside)?;
    kept.write_all(&tail)?;
    kept.sync_data()?;
    file.set_len(end)?;
    Ok(aside)
}

/// The names of the columns and this report's values, as they stand in the file.
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
    // Nothing of a pose that was not accepted: in a table nobody looks at another column first.
    let pose = report.pose.as_ref();
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
    add("robot_unavailable", word(robot.unavailable));
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
    columns
}

/// As JSON writes it.
fn snake(value: &impl serde::Serialize) -> String {
    let json = serde_json::to_value(value).ok();
    json.as_ref()
        .and_then(serde_json::Value::as_str)
        .unwrap_or_default()
        .to_owned()
}

/// In quotes where it needs them (RFC 4180), and on one line.
fn quoted(value: &str) -> String {
    let line: String = value
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    if line.contains([',', '"']) {
        format!("\"{}\"", line.replace('"', "\"\""))
    } else {
        line
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::{
        super::tests::{door, empty, refused, robot},
        *,
    };

    fn rows(path: &Path) -> Vec<Vec<String>> {
        let text = fs::read_to_string(path).expect("a file");
        assert!(text.ends_with('\n'));
        text.lines().map(cells).collect()
    }

    /// The cells of a line, read as RFC 4180 has it.
    fn cells(line: &str) -> Vec<String> {
        let mut cells = vec![String::new()];
        let mut is_quoted = false;
        let mut letters = line.chars().peekable();
        while let Some(letter) = letters.next() {
            let last = cells.len() - 1;
            match letter {
                '"' if is_quoted && letters.peek() == Some(&'"') => {
                    letters.next();
                    cells[last].push('"');
                }
                '"' => is_quoted = !is_quoted,
                ',' if !is_quoted => cells.push(String::new()),
                letter => cells[last].push(letter),
            }
        }
        cells
    }

    fn folder() -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("poses.csv");
        (folder, path)
    }

    #[test]
    fn rows_share_one_line_of_names_and_numbers_come_back() {
        let (_folder, path) = folder();
        let robot = robot();
        let report = door().report(Some(&robot), Convention::UniversalRobots);
        append_csv(&path, &report).expect("appended");
        append_csv(
            &path,
            &refused().report(Some(&robot), Convention::UniversalRobots),
        )
        .expect("appended");
        append_csv(&path, &empty().report(None, Convention::UniversalRobots)).expect("appended");
        let rows = rows(&path);
        assert_eq!(rows.len(), 4);
        assert!(rows.iter().all(|row| row.len() == rows[0].len()));
        let cell = |row: usize, name: &str| {
            let column = rows[0].iter().position(|column| column == name);
            rows[row][column.unwrap_or_else(|| panic!("no column {name}"))].as_str()
        };
        assert_eq!(cell(1, "scene"), "shift 2/door, left.pcd");
        assert_eq!(cell(1, "part"), "front_door");
        assert_eq!(cell(1, "seen_by"), "simulation");
        let block = report.robot.robot_offset.as_ref().expect("an offset");
        for value in &block.in_convention.values {
            let name = format!(
                "robot_offset_universal-robots_{}_{}",
                value.name,
                value.unit.symbol()
            );
            let read: f64 = cell(1, &name).parse().expect("a number");
            assert_eq!(read.to_bits(), value.value.to_bits(), "{name}");
        }
        // Of what is refused there is no number at all.
        assert_eq!(cell(2, "accepted"), "false");
        for row in [2, 3] {
            for (column, value) in rows[0].iter().zip(&rows[row]) {
                let is_pose = ["camera_from_part", "robot_from_part", "robot_offset_"]
                    .iter()
                    .any(|name| column.starts_with(name));
                assert!(!is_pose || value.is_empty(), "{column}: {value}");
            }
        }
        assert!(cell(2, "robot_unavailable").contains("not accepted"));
    }

    #[test]
    fn wherever_a_row_was_cut_off_every_whole_row_stays_and_the_next_one_fits() {
        let (_folder, path) = folder();
        let report = door().report(None, Convention::Kuka);
        append_csv(&path, &report).expect("appended");
        let header = fs::read(&path)
            .expect("a file")
            .iter()
            .position(|byte| *byte == b'\n')
            .expect("a line")
            + 1;
        append_csv(&path, &report).expect("appended");
        let whole = fs::read(&path).expect("a file");
        let row = (whole.len() - header) / 2;
        let aside = path.with_extension("csv.unfinished");
        for length in 0..=whole.len() {
            fs::write(&path, &whole[..length]).expect("cut");
            let appended = append_csv(&path, &report).expect("appended");
            let num_whole = length.saturating_sub(header) / row;
            let expected = &whole[..header + num_whole * row];
            let now = fs::read(&path).expect("a file");
            assert_eq!(&now[..expected.len()], expected, "cut at {length}");
            assert_eq!(now.len(), expected.len() + row, "cut at {length}");
            let cut = length.saturating_sub(header + num_whole * row);
            if length > header && cut > 0 {
                assert_eq!(
                    appended,
                    CsvAppended::SetAside(aside.clone()),
                    "cut at {length}"
                );
                let kept = fs::read(&aside).expect("set aside");
                assert_eq!(&kept[..cut], &whole[header + num_whole * row..length]);
                fs::remove_file(&aside).expect("removed");
            } else {
                assert_eq!(appended, CsvAppended::Row, "cut at {length}");
            }
        }
    }

    #[test]
    fn another_table_is_refused_and_left_as_it_is() {
        let (_folder, path) = folder();
        append_csv(&path, &door().report(None, Convention::Kuka)).expect("appended");
        let before = fs::read(&path).expect("a file");
        let refused =
            append_csv(&path, &door().report(None, Convention::Abb)).expect_err("refused");
        assert!(
            refused
                .to_string()
                .ends_with("its columns are not those of a pose report in ABB q1 q2 q3 q4")
        );
        assert!(refused.advice().contains("another file"));
        assert_eq!(fs::read(&path).expect("a file"), before);
        fs::write(&path, "my own notes").expect("written");
        append_csv(&path, &door().report(None, Convention::Abb)).expect_err("refused");
        assert_eq!(fs::read(&path).expect("a file"), b"my own notes");
        let missing = path.with_file_name("missing").join("poses.csv");
        let error =
            append_csv(&missing, &door().report(None, Convention::Abb)).expect_err("no folder");
        assert!(
            error.to_string().contains("the folder does not exist"),
            "{error}"
        );
    }

    #[test]
    fn many_at_once_leave_whole_rows() {
        let (_folder, path) = folder();
        let report = door().report(None, Convention::Kuka);
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    for _ in 0..10 {
                        append_csv(&path, &report).expect("appended");
                    }
                });
            }
        });
        let rows = rows(&path);
        assert_eq!(rows.len(), 81);
        assert!(rows[1..].iter().all(|row| *row == rows[1]));
    }
}
