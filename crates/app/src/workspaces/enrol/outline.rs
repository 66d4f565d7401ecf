//! A box or lasso drawn by a person, and the points that it encloses.
//!
//! A point is enclosed if the outline winds around the place where it is seen, any number of times in either direction
//! (non-zero winding rule), so a lasso may cross itself and its ends may overlap. Depth does not matter: hidden points
//! are enclosed as well.

use std::sync::Arc;

use glam::{Mat4, Vec2, Vec3};
use serde::{Deserialize, Serialize};

use super::subject::EnrolInput;
use ui::viewport::seen_at;

/// A box or lasso drawn by a person.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(into = "StoredOutline", try_from = "StoredOutline")]
pub struct DrawnOutline {
    /// Corners as fractions of the width and height of what it was drawn over, from the top left; the last joins the
    /// first.
    pub corners: Arc<[Vec2]>,
    /// What it was drawn over.
    pub over: DrawnOver,
}

/// What an outline was drawn over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DrawnOver {
    /// The picture of the input. A point is seen at the centre of its pixel.
    Picture,
    /// The 3-D view.
    View {
        /// Projection of the view when the outline was drawn.
        clip_from_world: Mat4,
    },
}

/// A drawn outline as stored in a file.
#[derive(Serialize, Deserialize)]
struct StoredOutline {
    corners: Vec<[f32; 2]>,
    /// Projection, column by column; `None` if drawn over the picture.
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
    /// Returns for each point whether it is enclosed; points behind the eye or without coordinates are not.
    pub(super) fn encloses(&self, subject: &EnrolInput) -> Vec<bool> {
        let edges = Edges::of(&self.corners);
        let points = subject.cloud().points.iter();
        match &self.over {
            DrawnOver::Picture => {
                let [width, height] = subject.picture.size().map(|side| side as f32);
                let pixels = points.enumerate();
                let pixels = pixels.map(|(index, point)| subject.picture.pixel(index, point));
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

/// The edges of a polygon, binned by rows so that a query tests only a few of a thousand.
struct Edges {
    low: Vec2,
    high: Vec2,
    rows_per_share: f32,
    rows: Vec<Vec<Edge>>,
}

/// An edge from its upper to its lower end, whichever way the outline runs, so that both directions give identical
/// bits.
#[derive(Clone, Copy)]
struct Edge {
    upper: Vec2,
    /// y of the lower end.
    lower_y: f32,
    /// Slope dx/dy; not used for level edges.
    right_per_down: f32,
    /// 1 if the outline runs down, −1 if it runs up.
    turns: i32,
}

/// Limit of rows; more would not reduce the edges per row.
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

    /// Row of a height; monotonic in `y`, so the rows of an edge lie between those of its ends.
    fn row(&self, y: f32) -> usize {
        let row = (y - self.low.y) * self.rows_per_share;
        (row as usize).min(self.rows.len() - 1)
    }

    /// True if the edges wind around the place. A place on an edge shared by two outlines is in exactly one of them.
    fn go_around(&self, at: Vec2) -> bool {
        // Also false for NaN.
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
