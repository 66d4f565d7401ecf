//! Spray path of a part: positions and directions of the nozzle in part space.
//!
//! It is stored in the part's folder. The file is a table with a heading that names columns and units; each line is a
//! position of the nozzle, in one of two forms:
//!
//! ```text
//! nozzle_x_mm, nozzle_y_mm, nozzle_z_mm, direction_x, direction_y, direction_z
//! 12.0, -40.5, 1141.0, 0, 0, 1                 the nozzle, and its direction: towards the part
//!
//! x_mm, y_mm, z_mm, normal_x, normal_y, normal_z, stand_off_mm
//! 12.0, -40.5, 1291.0, 0, 0, -1, 150           a point of the surface, its normal towards the nozzle, the stand-off
//! ```
//!
//! Lengths are in `_mm` or `_m`; without the last column the stand-off is 150 mm. Two more columns may follow, both for
//! the segment from this point to the next: `gun_on` (1 or 0; 1 without such a column) and `speed_mm_s` or `speed_m_s`.
//! `fan_x`, `fan_y` and `fan_z` point along the long side of a flat jet. Other columns are ignored. Part space is that
//! of the reference cloud: the camera frame at enrolment (x right, y down, z forward). A line `# part: NAME` says which
//! part the path is for, and a line `# coat: {…}` has the coat of a planned path as JSON.

mod error;
#[cfg(test)]
mod tests;

use std::{fmt::Write as _, path::Path};

use nalgebra::{Point3, Unit, Vector3};

use crate::library::PartName;
use files::{Row, read_text, table_rows};
use geometry::units::Metres;

pub use self::error::{PathLineProblem, SprayPathError};

/// A nozzle pose on a path, in part space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Position of the nozzle tip, metres.
    pub nozzle: Point3<f64>,
    /// Spray direction, towards the part.
    pub direction: Unit<Vector3<f64>>,
    /// Stand-off when the path was taught, if known.
    pub stand_off: Option<Metres>,
    /// True if the gun sprays from this point to the next.
    pub is_gun_on: bool,
    /// Speed from this point to the next, m/s, above 0 and at most [`MAX_SPEED_M_S`]; `None` if the path sets none.
    pub speed: Option<f64>,
    /// Direction of the fan's long side, perpendicular to `direction`; `None` for a round jet.
    pub fan: Option<Unit<Vector3<f64>>>,
}

/// An ordered, non-empty path of the nozzle.
#[derive(Clone, Debug, PartialEq)]
pub struct SprayPath {
    points: Vec<PathPoint>,
    /// The coat that it was planned with, as JSON.
    coat: Option<String>,
}

/// Maximum number of points, more than any path over one part has.
pub const MAX_PATH_POINTS: usize = 20_000;
/// Maximum size of a file, bytes.
pub(super) const MAX_BYTES: u64 = 8 << 20;
/// Default stand-off of a taught path, metres: the middle of the band.
const DEFAULT_STAND_OFF_M: f64 = 0.15;
/// Minimum stand-off, metres. Nobody sprays from nearer: such a number is in another unit.
const MIN_STAND_OFF_M: f64 = 0.02;
/// Maximum distance from the origin, metres. Larger than any part or arm: such numbers are in another unit.
const MAX_DISTANCE_M: f64 = 20.0;
/// Maximum speed, m/s. Faster than any robot moves a gun: such numbers are in another unit.
pub const MAX_SPEED_M_S: f64 = 5.0;

/// Begins the line that names the part of a path.
const PART_LINE: &str = "# part: ";
/// Begins the line with the coat of a path.
const COAT_LINE: &str = "# coat: ";

/// Content of a column.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Column {
    Nozzle(usize),
    Direction(usize),
    Surface(usize),
    Normal(usize),
    StandOff,
    GunOn,
    Speed,
    Fan(usize),
}

impl SprayPath {
    /// Creates a path of these points; `None` if there are none.
    pub fn new(points: Vec<PathPoint>) -> Option<Self> {
        (!points.is_empty()).then_some(Self { points, coat: None })
    }

    /// Sets the coat that it was planned with: JSON in one line.
    #[must_use]
    pub fn with_coat(self, coat: Option<String>) -> Self {
        Self { coat, ..self }
    }

    /// Returns the coat that it was planned with, as JSON.
    pub fn coat(&self) -> Option<&str> {
        self.coat.as_deref()
    }

    /// Returns the points in order.
    pub fn points(&self) -> &[PathPoint] {
        &self.points
    }

    /// Returns whether both paths are the same as a written table: positions to about a micrometre, directions to a
    /// millionth.
    pub fn is_as_written(&self, other: &Self) -> bool {
        let is_near = |a: &PathPoint, b: &PathPoint| {
            let speeds = [a, b].map(|point| point.speed.unwrap_or(0.0));
            (a.nozzle - b.nozzle).norm() < 2e-6
                && (a.direction.into_inner() - b.direction.into_inner()).norm() < 1e-6
                && a.is_gun_on == b.is_gun_on
                && (speeds[0] - speeds[1]).abs() < 2e-6
        };
        let mut pairs = self.points.iter().zip(&other.points);
        self.points.len() == other.points.len() && pairs.all(|(a, b)| is_near(a, b))
    }

    /// Returns the strokes, each as the indices of its first and last point.
    pub fn strokes(&self) -> Vec<[usize; 2]> {
        let mut strokes: Vec<[usize; 2]> = Vec::new();
        let sprays = self.points[..self.points.len() - 1].iter().enumerate();
        for (i, _) in sprays.filter(|(_, point)| point.is_gun_on) {
            match strokes.last_mut() {
                Some([_, last]) if *last == i => *last = i + 1,
                _ => strokes.push([i, i + 1]),
            }
        }
        strokes
    }

    /// Reads a path from a table.
    pub fn read(path: &Path) -> Result<Self, SprayPathError> {
        Self::parse(&read_text(path, MAX_BYTES)?, path)
    }

    /// Reads a path of this part from a table; refuses one whose table names another part.
    pub fn read_for(path: &Path, part: &PartName) -> Result<Self, SprayPathError> {
        let text = read_text(path, MAX_BYTES)?;
        let named = text.lines().find_map(|line| {
            // A spreadsheet adds quotes and separators.
            let line = line.trim_matches(|c: char| c.is_whitespace() || "\",;".contains(c));
            line.strip_prefix(PART_LINE)
        });
        if let Some(named) = named.filter(|named| *named != part.as_str()) {
            return Err(SprayPathError::OtherPart {
                path: path.to_owned(),
                named: named.to_owned(),
                part: part.clone(),
            });
        }
        Self::parse(&text, path)
    }

    /// Parses a path; errors name `path` as the file.
    pub(super) fn parse(text: &str, path: &Path) -> Result<Self, SprayPathError> {
        let mut lines = table_rows(text, path)?.into_iter();
        let no_heading = || SprayPathError::NoHeading {
            path: path.to_owned(),
        };
        let (_, heading) = lines.next().ok_or_else(no_heading)?;
        if heading.cells().any(|cell| heading.number(cell).is_some()) {
            return Err(no_heading());
        }
        let columns = Columns::parse(heading, path)?;
        let mut points = Vec::new();
        for (line, content) in lines {
            let point = columns
                .point(content)
                .map_err(|problem| SprayPathError::Line {
                    path: path.to_owned(),
                    line,
                    problem,
                })?;
            if points.len() == MAX_PATH_POINTS {
                return Err(SprayPathError::TooMany {
                    path: path.to_owned(),
                });
            }
            points.push(point);
        }
        let coat = text.lines().find_map(|line| line.strip_prefix(COAT_LINE));
        let read = Self::new(points).ok_or_else(|| SprayPathError::NoPoints {
            path: path.to_owned(),
        })?;
        Ok(read.with_coat(coat.map(|coat| coat.trim_end().to_owned())))
    }

    /// Like [`Self::to_text`], for a file of its own: names the part.
    pub fn to_text_of(&self, part: &PartName) -> String {
        format!("{PART_LINE}{part}\n{}", self.to_text())
    }

    /// Writes the table that is stored; reading it gives the same path, to a micrometre.
    pub fn to_text(&self) -> String {
        let coat = self.coat.as_ref();
        let mut text = coat.map_or_else(String::new, |coat| format!("{COAT_LINE}{coat}\n"));
        text.push_str(
            "# Partsight spray path, in the frame of the part's reference cloud: positions of the nozzle, and the direction in which it points.\n\
             nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z,stand_off_mm,gun_on,speed_mm_s,fan_x,fan_y,fan_z\n",
        );
        for PathPoint {
            nozzle,
            direction,
            stand_off,
            is_gun_on,
            speed,
            fan,
        } in &self.points
        {
            let mm = nozzle.coords * 1000.0;
            // Writing to memory does not fail.
            let _ = writeln!(
                text,
                "{:.3},{:.3},{:.3},{:.8},{:.8},{:.8},{},{},{},{}",
                mm.x,
                mm.y,
                mm.z,
                direction.x,
                direction.y,
                direction.z,
                stand_off.map_or(String::new(), |d| format!("{:.3}", d.mm())),
                u8::from(*is_gun_on),
                speed.map_or(String::new(), |v| format!("{:.3}", v * 1000.0)),
                fan.map_or(",,".into(), |f| format!("{:.8},{:.8},{:.8}", f.x, f.y, f.z))
            );
        }
        text
    }
}

/// Column and unit of each number in a line.
struct Columns {
    /// For each column of the heading its content and factor to metres.
    known: Vec<Option<(Column, f64)>>,
    is_surface: bool,
}

impl Columns {
    fn parse(heading: Row<'_>, path: &Path) -> Result<Self, SprayPathError> {
        let known: Vec<Option<(Column, f64)>> = heading.cells().map(column).collect();
        let contents: Vec<Option<Column>> = known
            .iter()
            .map(|known| known.map(|(column, _)| column))
            .collect();
        for (i, cell) in heading.cells().enumerate() {
            if contents[i].is_some() && contents[..i].contains(&contents[i]) {
                return Err(SprayPathError::TwoColumns {
                    path: path.to_owned(),
                    column: cell.to_owned(),
                });
            }
        }
        let has = |wanted: Column| known.iter().flatten().any(|(column, _)| *column == wanted);
        let all = |kind: fn(usize) -> Column| (0..3).all(|axis| has(kind(axis)));
        let is_nozzle = all(Column::Nozzle) && all(Column::Direction);
        let is_surface = all(Column::Surface) && all(Column::Normal);
        if is_nozzle || is_surface {
            return Ok(Self {
                known,
                is_surface: !is_nozzle,
            });
        }
        Err(SprayPathError::MissingColumns {
            path: path.to_owned(),
            found: heading.text().chars().take(100).collect(),
        })
    }

    fn point(&self, line: Row<'_>) -> Result<PathPoint, PathLineProblem> {
        let (mut at, mut along, mut fan) = ([None; 3], [None; 3], [None; 3]);
        let (mut stand_off, mut speed) = (None, None);
        let mut is_gun_on = true;
        for (i, cell) in line.cells().enumerate() {
            let Some(Some((column, factor))) = self.known.get(i) else {
                continue;
            };
            let is_optional = matches!(
                column,
                Column::StandOff | Column::GunOn | Column::Speed | Column::Fan(_)
            );
            if cell.is_empty() && is_optional {
                continue;
            }
            let number = line.number(cell).filter(|number| number.is_finite());
            let number = number.ok_or_else(|| PathLineProblem::NoNumber {
                column: i + 1,
                cell: cell.to_owned(),
            })? * factor;
            match (*column, self.is_surface) {
                (Column::Nozzle(axis), false) | (Column::Surface(axis), true) => {
                    at[axis] = Some(number);
                }
                (Column::Direction(axis), false) | (Column::Normal(axis), true) => {
                    along[axis] = Some(number);
                }
                (Column::StandOff, _) => stand_off = Some(number),
                (Column::Fan(axis), _) => fan[axis] = Some(number),
                (Column::Speed, _) => speed = Some(number),
                (Column::GunOn, _) if number.abs() < f64::EPSILON => is_gun_on = false,
                (Column::GunOn, _) if (number - 1.0).abs() < f64::EPSILON => is_gun_on = true,
                (Column::GunOn, _) => {
                    return Err(PathLineProblem::GunOn {
                        cell: cell.to_owned(),
                    });
                }
                _ => {}
            }
        }
        let ([Some(x), Some(y), Some(z)], [Some(u), Some(v), Some(w)]) = (at, along) else {
            return Err(PathLineProblem::TooShort);
        };
        let at = Point3::new(x, y, z);
        if at.coords.norm() > MAX_DISTANCE_M {
            return Err(PathLineProblem::FarAway {
                distance: Metres(at.coords.norm()),
            });
        }
        if let Some(distance) = stand_off.filter(|d| !(MIN_STAND_OFF_M..=1.0).contains(d)) {
            return Err(PathLineProblem::StandOff {
                distance: Metres(distance),
            });
        }
        if let Some(speed) = speed.filter(|speed| !(*speed > 0.0 && *speed <= MAX_SPEED_M_S)) {
            return Err(PathLineProblem::Speed { speed });
        }
        let along = Vector3::new(u, v, w);
        let unit = Unit::try_new(along, 1e-6).ok_or(PathLineProblem::NoDirection)?;
        let fan = match fan {
            [Some(x), Some(y), Some(z)] => {
                let beside = Vector3::new(x, y, z);
                let across = beside - unit.into_inner() * unit.dot(&beside);
                // A fan along the jet is invalid; a rounded one is made perpendicular again.
                let is_across = across.norm() > 0.9 * beside.norm();
                let fan = Unit::try_new(across, 1e-6).filter(|_| is_across);
                Some(fan.ok_or(PathLineProblem::Fan)?)
            }
            _ => None,
        };
        Ok(if self.is_surface {
            let distance = stand_off.unwrap_or(DEFAULT_STAND_OFF_M);
            PathPoint {
                nozzle: at + unit.into_inner() * distance,
                direction: -unit,
                stand_off: Some(Metres(distance)),
                is_gun_on,
                speed,
                fan,
            }
        } else {
            PathPoint {
                nozzle: at,
                direction: unit,
                stand_off: stand_off.map(Metres),
                is_gun_on,
                speed,
                fan,
            }
        })
    }
}

/// Parses a column name into its content and factor to metres.
fn column(cell: &str) -> Option<(Column, f64)> {
    let name = cell.trim_matches(['"', '\'']).trim().to_lowercase();
    match name.as_str() {
        "gun_on" => return Some((Column::GunOn, 1.0)),
        "speed_mm_s" => return Some((Column::Speed, 0.001)),
        "speed_m_s" => return Some((Column::Speed, 1.0)),
        _ => {}
    }
    let axis_of = |name: &str| ["x", "y", "z"].iter().position(|axis| *axis == name);
    let length = [("_mm", 0.001), ("_m", 1.0)]
        .into_iter()
        .find_map(|(unit, factor)| Some((name.strip_suffix(unit)?, factor)));
    if let Some((name, factor)) = length {
        let column = match name.strip_prefix("nozzle_") {
            Some(axis) => Column::Nozzle(axis_of(axis)?),
            None if name == "stand_off" => Column::StandOff,
            None => Column::Surface(axis_of(name)?),
        };
        return Some((column, factor));
    }
    let direction = name.strip_prefix("direction_").and_then(axis_of);
    let normal = name.strip_prefix("normal_").and_then(axis_of);
    let fan = name.strip_prefix("fan_").and_then(axis_of);
    let column = direction
        .map(Column::Direction)
        .or(normal.map(Column::Normal))
        .or(fan.map(Column::Fan));
    Some((column?, 1.0))
}
