//! A part's spray path: where the nozzle stands and which way it points, in the part's own frame.
//!
//! It is stored in the part's folder and goes with it. A file of it is a table with a heading that names columns and
//! units; a line is a place of the nozzle, in one of two ways:
//!
//! ```text
//! nozzle_x_mm, nozzle_y_mm, nozzle_z_mm, direction_x, direction_y, direction_z
//! 12.0, -40.5, 1141.0, 0, 0, 1                 the nozzle, and the way it points: towards the part
//!
//! x_mm, y_mm, z_mm, normal_x, normal_y, normal_z, stand_off_mm
//! 12.0, -40.5, 1291.0, 0, 0, -1, 150           a place of the surface, its normal towards the nozzle, the distance
//! ```
//!
//! Lengths are in `_mm` or `_m`; the last column may be missing, and is 150 mm then. Two more columns may follow, each
//! for the way from its point to the next: `gun_on` (1 or 0; 1 where there is no such column) and `speed_mm_s` or
//! `speed_m_s`. `fan_x`, `fan_y` and `fan_z` point along the long side of a flat jet. Further columns are read over. The
//! part's frame is that of its reference cloud: the camera's at the moment of enrolling (x right, y down, z forward).

mod error;
#[cfg(test)]
mod tests;

use std::{fmt::Write as _, path::Path};

use nalgebra::{Point3, Unit, Vector3};

use crate::{
    files::{Row, read_text, table_rows},
    units::Metres,
};

pub use self::error::{PathLineProblem, SprayPathError};

/// A nozzle at one point of a path, part space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Where the nozzle's mouth is, metres.
    pub nozzle: Point3<f64>,
    /// The way it points, towards the part.
    pub direction: Unit<Vector3<f64>>,
    /// How far the surface was when the path was taught, where that is known.
    pub stand_off: Option<Metres>,
    /// True if the gun sprays on the way from this point to the next.
    pub is_gun_on: bool,
    /// Speed on the way from this point to the next, m/s, above 0 and at most [`MAX_SPEED`]; where the path sets one.
    pub speed: Option<f64>,
    /// Along the long side of the fan, at right angles to `direction`; none for a round jet.
    pub fan: Option<Unit<Vector3<f64>>>,
}

/// A path of the nozzle, in its order; never empty.
#[derive(Clone, Debug, PartialEq)]
pub struct SprayPath {
    points: Vec<PathPoint>,
}

/// More points than any path over one part.
pub const MAX_PATH_POINTS: usize = 20_000;
/// A larger file is no path.
pub(super) const MAX_BYTES: u64 = 8 << 20;
/// Where nothing else is said, a path was taught at the middle of the band.
const TAUGHT: f64 = 0.15;
/// No part and no arm reaches farther: the numbers are in another unit.
const FARTHEST: f64 = 20.0;
/// Faster than any robot moves a gun, m/s: the numbers are in another unit.
pub const MAX_SPEED: f64 = 5.0;

/// What a column holds.
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
    /// A path of these points; `None` without any.
    pub fn new(points: Vec<PathPoint>) -> Option<Self> {
        (!points.is_empty()).then_some(Self { points })
    }

    /// The points, in the path's order.
    pub fn points(&self) -> &[PathPoint] {
        &self.points
    }

    /// True if a table of this path reads as the other: places to a micrometre, directions to a millionth.
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

    /// Strokes: the ways with the gun on without a break, each by its first and last point.
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

    /// The path in a text; errors name it as this file.
    pub(super) fn parse(text: &str, path: &Path) -> Result<Self, SprayPathError> {
        let mut lines = table_rows(text, path)?.into_iter();
        let no_heading = || SprayPathError::NoHeading {
            path: path.to_owned(),
        };
        let (_, heading) = lines.next().ok_or_else(no_heading)?;
        if heading.cells().any(|cell| heading.number(cell).is_some()) {
            return Err(no_heading());
        }
        let columns = Columns::of(heading, path)?;
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
        Self::new(points).ok_or_else(|| SprayPathError::NoPoints {
            path: path.to_owned(),
        })
    }

    /// The table that is stored; it reads back to the same path, to a micrometre.
    pub fn to_text(&self) -> String {
        let mut text = String::from(
            "# Partsight spray path, in the frame of the part's reference cloud: nozzle positions, and the way it points.\n\
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

/// Where each number of a point stands in a line, and in which unit.
struct Columns {
    /// What each column of the heading is, and its factor to metres.
    known: Vec<Option<(Column, f64)>>,
    is_surface: bool,
}

impl Columns {
    fn of(heading: Row<'_>, path: &Path) -> Result<Self, SprayPathError> {
        let known: Vec<Option<(Column, f64)>> = heading.cells().map(column).collect();
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
        if at.coords.norm() > FARTHEST {
            return Err(PathLineProblem::FarAway {
                distance: Metres(at.coords.norm()),
            });
        }
        if let Some(distance) = stand_off.filter(|d| !(0.0..=1.0).contains(d)) {
            return Err(PathLineProblem::StandOff {
                distance: Metres(distance),
            });
        }
        if let Some(speed) = speed.filter(|speed| !(*speed > 0.0 && *speed <= MAX_SPEED)) {
            return Err(PathLineProblem::Speed { speed });
        }
        let along = Vector3::new(u, v, w);
        let unit = Unit::try_new(along, 1e-6).ok_or(PathLineProblem::NoDirection)?;
        let fan = match fan {
            [Some(x), Some(y), Some(z)] => {
                let beside = Vector3::new(x, y, z);
                let across = beside - unit.into_inner() * unit.dot(&beside);
                // A fan along the jet says nothing; rounded numbers are squared up.
                let is_across = across.norm() > 0.9 * beside.norm();
                let fan = Unit::try_new(across, 1e-6).filter(|_| is_across);
                Some(fan.ok_or(PathLineProblem::Fan)?)
            }
            _ => None,
        };
        Ok(if self.is_surface {
            let distance = stand_off.unwrap_or(TAUGHT);
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

/// What the heading calls a column, and the factor to metres.
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
