//! A box or a lasso that a person drew, and which points it encloses.
//!
//! A point is enclosed where the outline goes around the place at which it is seen, however often and either way round
//! (non-zero winding rule): a lasso may cross itself, and its ends may overlap. How deep the point lies does not matter:
//! what is hidden behind others is enclosed as well.

use std::sync::Arc;

use glam::{Mat4, Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::subject::EnrolInput;
use crate::app::ui::viewport::seen_at;

/// A box or a lasso that a person drew.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(into = "StoredOutline", try_from = "StoredOutline")]
pub struct DrawnOutline {
    /// In shares of width and height of what it was drawn over, from the top left; the last is joined to the first.
    pub corners: Arc<[Vec2]>,
    /// Over what it was drawn.
    pub over: DrawnOver,
}

/// What an outline was drawn over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DrawnOver {
    /// The picture of what is enrolled. A point is seen in the middle of its pixel.
    Picture,
    /// The 3-D view.
    View {
        /// As the camera of the view stood.
        clip_from_world: Mat4,
    },
}

/// The same in a file.
#[derive(Serialize, Deserialize)]
struct StoredOutline {
    corners: Vec<[f32; 2]>,
    /// Column after column; `None` of one that was drawn over the picture.
    clip_from_world: Option<[f32; 16]>,
}

impl From<DrawnOutline> for StoredOutline {
    fn from(outline: DrawnOutline) -> Self {
        Self {
            corners: outline.corners.iter().map(|at| [at.x, at.y]).collect(),
            clip_from_world: match outline.over {
                DrawnOver::Picture => None,
                DrawnOver::View { clip_from_world } => Some(clip_from_world.to_cols_array()),
            },
        }
    }
}

impl TryFrom<StoredOutline> for DrawnOutline {
    type Error = &'static str;

    fn try_from(stored: StoredOutline) -> Result<Self, Self::Error> {
        let StoredOutline {
            corners,
            clip_from_world,
        } = stored;
        let mut numbers = corners
            .iter()
            .flatten()
            .chain(clip_from_world.iter().flatten());
        if !numbers.all(|number| number.is_finite()) {
            return Err("a corner is no place");
        }
        Ok(Self {
            corners: corners.into_iter().map(Vec2::from).collect(),
            over: match clip_from_world {
                None => DrawnOver::Picture,
                Some(columns) => DrawnOver::View {
                    clip_from_world: Mat4::from_cols_array(&columns),
                },
            },
        })
    }
}

impl DrawnOutline {
    /// For each point of a subject whether it is enclosed; what lies behind the eye or has no coordinates is not.
    pub(super) fn encloses(&self, subject: &EnrolInput) -> Vec<bool> {
        let edges = Edges::of(&self.corners);
        let points = subject.cloud().points.iter();
        match &self.over {
            DrawnOver::Picture => {
                let [width, height] = subject.picture.size().map(|side| side as f32);
                let pixels = points.enumerate();
                let pixels = pixels.map(|(place, point)| subject.picture.pixel(place, point));
                let middles = pixels.map(|[column, row]| {
                    Vec2::new((column as f32 + 0.5) / width, (row as f32 + 0.5) / height)
                });
                middles.map(|at| edges.go_around(at)).collect()
            }
            DrawnOver::View { clip_from_world } => points
                .map(|point| Vec3::new(point.x, point.y, point.z))
                .map(|point| seen_at(clip_from_world, point))
                .map(|seen| seen.is_some_and(|at| edges.go_around(at)))
                .collect(),
        }
    }
}

/// The edges of a polygon by the rows they cross, so that a place meets a few of a thousand.
struct Edges {
    low: Vec2,
    high: Vec2,
    rows_per_share: f32,
    rows: Vec<Vec<Edge>>,
}

/// From its upper end to its lower one, whichever way the outline runs: there and back it is the same line to the bit.
#[derive(Clone, Copy)]
struct Edge {
    upper: Vec2,
    /// Where its lower end lies.
    lower_y: f32,
    /// How far it goes to the right on its way down; never asked for where it is level.
    right_per_down: f32,
    /// 1 where the outline runs down, −1 where it runs up.
    turns: i32,
}

/// More rows than this hold no fewer edges each.
const MAX_ROWS: usize = 256;

impl Edges {
    fn of(corners: &[Vec2]) -> Self {
        let start = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        let (low, high) = corners.iter().fold(start, |(low, high), corner| {
            (low.min(*corner), high.max(*corner))
        });
        let num_rows = corners.len().clamp(1, MAX_ROWS);
        let mut edges = Self {
            low,
            high,
            rows_per_share: num_rows as f32 / (high.y - low.y),
            rows: vec![Vec::new(); num_rows],
        };
        for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
            let (upper, lower, turns) = if a.y <= b.y {
                (*a, *b, 1)
            } else {
                (*b, *a, -1)
            };
            let edge = Edge {
                upper,
                lower_y: lower.y,
                right_per_down: (lower.x - upper.x) / (lower.y - upper.y),
                turns,
            };
            let crossed = edges.row(upper.y)..=edges.row(lower.y);
            for row in &mut edges.rows[crossed] {
                row.push(edge);
            }
        }
        edges
    }

    /// Grows with `y`: the rows of an edge are those of all places between its ends.
    fn row(&self, y: f32) -> usize {
        let row = (y - self.low.y) * self.rows_per_share;
        (row as usize).min(self.rows.len() - 1)
    }

    /// True where they go around. Of two outlines with an edge in common a place on it is in one.
    fn go_around(&self, at: Vec2) -> bool {
        // False for NaN as well.
        let is_near = self.low.cmple(at).all() && at.cmplt(self.high).all();
        if !is_near {
            return false;
        }
        let mut turns = 0;
        for edge in &self.rows[self.row(at.y)] {
            let is_beside = edge.upper.y <= at.y && at.y < edge.lower_y;
            let x = edge.upper.x + (at.y - edge.upper.y) * edge.right_per_down;
            turns += if is_beside && at.x < x { edge.turns } else { 0 };
        }
        turns != 0
    }
}

#[cfg(test)]
mod tests;
