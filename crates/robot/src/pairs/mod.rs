//! Files of pairs for a hand-eye calibration: a table from a spreadsheet, or JSON.
//!
//! A table has one line per pair: the robot's pose `robot_from_flange`, then the camera's `camera_from_target`, each in
//! the numbers of a named convention. A first cell may hold a name. A line `# robot: kuka` (or `# convention: kuka`)
//! names the convention of the robot's poses, `# camera: matrix` that of the camera's; the default for the camera is
//! `matrix`. Cells are separated by commas, semicolons (then commas may be decimal), tabs or spaces; a heading and
//! comments (`#`) are skipped.
//!
//! ```text
//! # robot: kuka          X Y Z mm, A B C degrees
//! # camera: rotation-vector
//! front;  1450.2; -310.0; 890.5; 12.01; -45.2; 178.8;  0.1021; -0.0310; 1.2044; 0.31; -2.10; 0.02
//! ```
//!
//! ```json
//! {"robot": "kuka", "camera": "matrix", "pairs": [{"name": "front", "robot": [6 numbers], "camera": [16 numbers]}]}
//! ```
//!
//! A table of counts of an encoder has one line per frame, with its name and its count.
//!
//! A file of robot poses alone, for captures in which Partsight finds the camera's pose itself, has the same lines
//! without the camera's numbers; the name is then that of the capture.

mod error;
#[cfg(test)]
mod tests;

use std::path::Path;

use serde::Deserialize;

use super::{Convention, hand_eye::PosePair};
use files::{read_text, table_rows};
use geometry::rigid::RigidTransform;

pub use self::error::{LineProblem, PairsError};

/// Conventions given by the caller; `None` uses the one that the file names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PairConventions {
    /// Of the robot's poses.
    pub robot: Option<Convention>,
    /// Of the camera's poses.
    pub camera: Option<Convention>,
}

impl PairConventions {
    /// The conventions of the robot's and the camera's poses, given those that the file names.
    fn or(
        self,
        [robot, camera]: [Option<Convention>; 2],
        path: &Path,
    ) -> Result<(Convention, Convention), PairsError> {
        let robot = self.robot.or(robot);
        let robot = robot.ok_or_else(|| PairsError::NoConvention {
            path: path.to_owned(),
        })?;
        let camera = self.camera.or(camera).unwrap_or(Convention::Matrix);
        Ok((robot, camera))
    }
}

/// A file of pairs.
#[derive(Clone, Debug, PartialEq)]
pub struct Pairs {
    /// The pairs, in the file's order.
    pub pairs: Vec<PosePair>,
    /// Convention of the robot's poses in the file.
    pub robot: Convention,
    /// Convention of the camera's poses in the file.
    pub camera: Convention,
}

/// A pose of the arm.
#[derive(Clone, Debug, PartialEq)]
pub struct ArmPose {
    /// Name of its capture, if the file gives one.
    pub capture: Option<String>,
    /// Name and line in the file, for messages.
    pub place: String,
    /// Pose of the flange in the robot's base frame.
    pub robot_from_flange: RigidTransform,
}

/// Largest file that is read, bytes.
const MAX_BYTES: u64 = 4 << 20;

/// Reads a file of pairs.
pub fn read_pairs(path: &Path, given: PairConventions) -> Result<Pairs, PairsError> {
    let text = read_text(path, MAX_BYTES)?;
    if text.trim_start().starts_with('{') {
        return json_pairs(&text, path, given);
    }
    let (robot, camera) = conventions(&text, path, given)?;
    let rows = rows(
        &text,
        path,
        robot.names().len() + camera.names().len(),
        || {
            format!(
                "{} of the robot's pose ({}), then {} of the camera's ({})",
                robot.names().len(),
                robot.names().join(" "),
                camera.names().len(),
                camera.names().join(" ")
            )
        },
    )?;
    let pairs = rows.into_iter().map(|row| {
        let (arm, seen) = row.numbers.split_at(robot.names().len());
        let pose = |convention: Convention, numbers: &[f64]| {
            convention
                .read(numbers)
                .map_err(|error| row.problem(path, LineProblem::Pose(error)))
        };
        Ok(PosePair {
            name: row.name(),
            robot_from_flange: pose(robot, arm)?,
            camera_from_target: pose(camera, seen)?,
        })
    });
    Ok(Pairs {
        pairs: pairs.collect::<Result<_, PairsError>>()?,
        robot,
        camera,
    })
}

#[derive(Deserialize)]
struct JsonFile {
    robot: Option<Convention>,
    camera: Option<Convention>,
    pairs: Vec<JsonPair>,
}

#[derive(Deserialize)]
struct JsonPair {
    name: Option<String>,
    robot: Vec<f64>,
    camera: Vec<f64>,
}

fn json_pairs(text: &str, path: &Path, given: PairConventions) -> Result<Pairs, PairsError> {
    let file: JsonFile = serde_json::from_str(text).map_err(|error| PairsError::BadJson {
        path: path.to_owned(),
        found: error.to_string(),
    })?;
    let (robot, camera) = given.or([file.robot, file.camera], path)?;
    if file.pairs.is_empty() {
        return Err(PairsError::NoPoses {
            path: path.to_owned(),
        });
    }
    let pairs = file.pairs.into_iter().enumerate().map(|(i, pair)| {
        let place = format!("pair {}", i + 1);
        let pose = |convention: Convention, numbers: &[f64]| {
            convention.read(numbers).map_err(|error| PairsError::Line {
                path: path.to_owned(),
                place: place.clone(),
                problem: LineProblem::Pose(error),
            })
        };
        Ok(PosePair {
            robot_from_flange: pose(robot, &pair.robot)?,
            camera_from_target: pose(camera, &pair.camera)?,
            name: match pair.name {
                Some(name) => format!("{name} ({place})"),
                None => place,
            },
        })
    });
    Ok(Pairs {
        pairs: pairs.collect::<Result<_, PairsError>>()?,
        robot,
        camera,
    })
}

/// Reads a file of arm poses. Also returns the convention that was used.
pub fn read_arm_poses(
    path: &Path,
    given: Option<Convention>,
) -> Result<(Vec<ArmPose>, Convention), PairsError> {
    let text = read_text(path, MAX_BYTES)?;
    let given = PairConventions {
        robot: given,
        camera: None,
    };
    let (robot, _) = conventions(&text, path, given)?;
    let needed = robot.names().len();
    let rows = rows(&text, path, needed, || {
        format!("{needed} of the robot's pose ({})", robot.names().join(" "))
    })?;
    let poses = rows.into_iter().map(|row| {
        let pose = robot.read(&row.numbers);
        Ok(ArmPose {
            robot_from_flange: pose.map_err(|error| row.problem(path, LineProblem::Pose(error)))?,
            place: row.name(),
            capture: row.given_name,
        })
    });
    Ok((poses.collect::<Result<_, PairsError>>()?, robot))
}

/// A count of an encoder.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameCount {
    /// Name of its frame, if the file gives one.
    pub frame: Option<String>,
    /// The count, as the counter showed it.
    pub count: i64,
}

/// Reads a table of counts: the name of each frame, which may be left out, and its count.
pub fn read_counts(path: &Path) -> Result<Vec<FrameCount>, PairsError> {
    /// Greatest count: of a 32-bit counter without a sign.
    const MAX_COUNT: f64 = u32::MAX as f64;
    let text = read_text(path, MAX_BYTES)?;
    let rows = rows(&text, path, 1, || "the count of the encoder".to_owned());
    let rows = rows.map_err(|error| match error {
        PairsError::NoPoses { path } => PairsError::NoCounts { path },
        error => error,
    })?;
    let counts = rows.into_iter().map(|row| {
        let found = row.numbers[0];
        if found.fract() != 0.0 || found.abs() > MAX_COUNT {
            return Err(row.problem(path, LineProblem::NotWhole { found }));
        }
        Ok(FrameCount {
            frame: row.given_name,
            count: found as i64,
        })
    });
    counts.collect()
}

/// Finds the conventions of the robot's and the camera's poses.
fn conventions(
    text: &str,
    path: &Path,
    given: PairConventions,
) -> Result<(Convention, Convention), PairsError> {
    let (mut robot, mut camera) = (None, None);
    for (i, line) in text.lines().enumerate() {
        let Some((key, rest)) = line
            .trim()
            .strip_prefix('#')
            .and_then(|c| c.split_once(':'))
        else {
            continue;
        };
        let slot = match key.trim().to_lowercase().as_str() {
            "robot" | "convention" | "robot convention" => &mut robot,
            "camera" | "camera convention" => &mut camera,
            _ => continue,
        };
        let name = rest.split_whitespace().next().unwrap_or_default();
        let named = Convention::by_name(&name.to_lowercase());
        *slot = Some(named.ok_or_else(|| PairsError::Line {
            path: path.to_owned(),
            place: format!("line {}", i + 1),
            problem: LineProblem::NoSuchConvention {
                name: name.to_owned(),
            },
        })?);
    }
    given.or([robot, camera], path)
}

/// One line of a table.
struct Row {
    line: usize,
    given_name: Option<String>,
    numbers: Vec<f64>,
}

impl Row {
    fn name(&self) -> String {
        match &self.given_name {
            Some(name) => format!("{name} (line {})", self.line),
            None => format!("line {}", self.line),
        }
    }

    fn problem(&self, path: &Path, problem: LineProblem) -> PairsError {
        PairsError::Line {
            path: path.to_owned(),
            place: format!("line {}", self.line),
            problem,
        }
    }
}

/// Reads the lines, each `needed` numbers after an optional name.
fn rows(
    text: &str,
    path: &Path,
    needed: usize,
    expected: impl Fn() -> String,
) -> Result<Vec<Row>, PairsError> {
    let mut rows = Vec::new();
    for (i, (line, content)) in table_rows(text, path)?.into_iter().enumerate() {
        let mut cells: Vec<&str> = content.cells().collect();
        // Spreadsheets pad lines with empty cells.
        while cells.len() > needed && cells.last().is_some_and(|cell| cell.is_empty()) {
            cells.pop();
        }
        let is_heading = cells.iter().all(|cell| content.number(cell).is_none());
        if i == 0 && is_heading {
            continue;
        }
        let has_name = content.number(cells[0]).is_none();
        let given_name = has_name.then(|| cells[0].trim_matches('"').to_owned());
        let mut row = Row {
            line,
            given_name: given_name.filter(|name| !name.is_empty()),
            numbers: Vec::new(),
        };
        for (column, cell) in cells.iter().enumerate().skip(usize::from(has_name)) {
            let number = content.number(cell).ok_or_else(|| {
                let cell = (*cell).to_owned();
                row.problem(
                    path,
                    LineProblem::NoNumber {
                        column: column + 1,
                        cell,
                    },
                )
            })?;
            row.numbers.push(number);
        }
        if row.numbers.len() != needed {
            let found = row.numbers.len();
            let expected = expected();
            return Err(row.problem(
                path,
                LineProblem::Count {
                    found,
                    needed,
                    expected,
                },
            ));
        }
        rows.push(row);
    }
    if rows.is_empty() {
        return Err(PairsError::NoPoses {
            path: path.to_owned(),
        });
    }
    Ok(rows)
}
