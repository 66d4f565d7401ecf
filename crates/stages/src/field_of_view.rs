//! The field of view: the region of a picture in which the camera delivers readings.
//!
//! Depth that is registered to a colour camera ends inside the picture, along a border that is not quite a rectangle:
//! trapezoidal, rounded or rotated. The border is convex, so the field of view is the convex hull of the readings (A.
//! M. Andrew, "Another efficient algorithm for convex hulls in two dimensions", Information Processing Letters 9(5),
//! 1979), and a pixel inside without a reading is a hole.
//!
//! The two lenses are some distance apart, so near surfaces end some pixels further inside than far ones, leaving a
//! band without readings along the border. A surface ends at the border if it is the outermost reading of its row
//! or column within that band.
//!
//! Known limits: if the readings cover less than 45 % of the picture or leave gaps along their hull, as with a part in
//! front of nothing, the whole picture is taken as the field of view. A border without readings over its whole length
//! is found too far inside. The capture of an empty cell avoids this, and so do other frames of the same camera: Live,
//! scans and the window's camera remember the field of view.

use std::sync::Arc;

use geometry::cloud::Grid;

/// The pixels of a picture in which the camera delivers readings.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldOfView {
    grid: Grid,
    /// First and last column inside, per row; first > last where the whole row is outside.
    rows: Vec<[u32; 2]>,
    /// Outermost readings within [`BAND`] of the border, per row and per column; the border itself where there are none.
    ends: [Vec<[u32; 2]>; 2],
    is_inner: bool,
}

/// Minimum length of a run of readings; shorter runs are specks.
const RUN: usize = 4;
/// Distance from the border within which the outermost reading of a row or column is searched for, pixels: twice the
/// offset of near surfaces observed at 640 columns.
const BAND: u32 = 40;
/// Minimum extent of the readings, as a share of the picture's width and height.
const LEAST_EXTENT: f64 = 0.6;
/// Minimum area of the readings' hull, as a share of the picture's area.
const LEAST_AREA: f64 = 0.45;
/// Minimum share of row ends that have a reading close to them.
const LEAST_BORDER: f64 = 0.7;
/// A reading this close to the hull is at its border, pixels: the border of registered depth is ragged.
const CLOSE: u32 = 12;
/// A hull that leaves out less than this share of the picture's width and height counts as the whole picture.
const NEGLIGIBLE: f64 = 0.02;

impl FieldOfView {
    /// Determines the field of view from a frame: the convex hull of the readings if they fill it up to its border,
    /// else the whole picture. `known` is the field of view found in another frame of the same camera.
    pub fn from_readings(
        grid: Grid,
        is_reading: impl Fn(usize) -> bool,
        known: Option<&Self>,
    ) -> Self {
        let hull = hull_of_readings(grid, &is_reading);
        let is_inner =
            |rows: &Vec<[u32; 2]>| is_plausible(rows, grid) && !is_nearly_all(rows, grid);
        let is_full =
            |rows: &Vec<[u32; 2]>| reaches_the_border(rows, &ends_of(grid, &is_reading, rows)[0]);
        let rows = match known.filter(|known| known.grid == grid) {
            Some(known) if known.is_inner => hull.map(|hull| joined(&known.rows, &hull)),
            Some(_) => None,
            None => hull.filter(is_inner).filter(is_full),
        };
        let is_inner = rows.is_some();
        let Grid { width, height } = grid;
        let rows = rows.unwrap_or_else(|| vec![[0, width.saturating_sub(1) as u32]; height]);
        Self {
            grid,
            ends: ends_of(grid, &is_reading, &rows),
            rows,
            is_inner,
        }
    }

    /// Joins the known field of view with that of a new frame; `None` while it is the whole picture.
    pub fn remembered(known: Option<Arc<Self>>, seen: Option<&Self>) -> Option<Arc<Self>> {
        match (known, seen.filter(|view| view.is_inner)) {
            (Some(known), Some(view)) if known.grid == view.grid => {
                let rows = joined(&known.rows, &view.rows);
                Some(Arc::new(Self {
                    rows,
                    ..view.clone()
                }))
            }
            (_, Some(view)) => Some(Arc::new(view.clone())),
            (known, None) => known,
        }
    }

    /// Returns the field of view of the picture with its rows reversed.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let width = self.grid.width as u32;
        let turned = |rows: &[[u32; 2]]| -> Vec<[u32; 2]> {
            let turned = |&[first, last]: &[u32; 2]| {
                if first > last {
                    OUTSIDE
                } else {
                    [width - 1 - last, width - 1 - first]
                }
            };
            rows.iter().map(turned).collect()
        };
        let [across, down] = &self.ends;
        Self {
            grid: self.grid,
            rows: turned(&self.rows),
            ends: [turned(across), down.iter().rev().copied().collect()],
            is_inner: self.is_inner,
        }
    }

    /// Returns true if it is smaller than the picture.
    pub fn is_inner(&self) -> bool {
        self.is_inner
    }

    /// Returns true if the camera can deliver a reading at this column and row.
    pub fn contains(&self, u: i64, v: i64) -> bool {
        let row = usize::try_from(v).ok().and_then(|v| self.rows.get(v));
        row.is_some_and(|&[first, last]| u >= i64::from(first) && u <= i64::from(last))
    }

    /// Returns the columns at which the readings of a row end: the outermost readings close to the border of the
    /// view, else the border.
    pub fn row_ends(&self, v: usize) -> Option<[u32; 2]> {
        self.ends[0].get(v).copied()
    }

    /// Returns the rows at which the readings of a column end, likewise.
    pub fn column_ends(&self, u: usize) -> Option<[u32; 2]> {
        self.ends[1].get(u).copied()
    }

    /// Returns true if a reading at this column and row is within `margin` pixels of the end of the view.
    pub fn ends_at(&self, u: usize, v: usize, margin: u32) -> bool {
        let is_end = |along: &[[u32; 2]], line: usize, at: usize| {
            along.get(line).is_some_and(|&[first, last]| {
                at as u32 <= first + margin || at as u32 + margin >= last
            })
        };
        is_end(&self.ends[0], v, u) || is_end(&self.ends[1], u, v)
    }
}

fn length([first, last]: [u32; 2]) -> f64 {
    if first > last {
        0.0
    } else {
        f64::from(last - first + 1)
    }
}

fn area(rows: &[[u32; 2]]) -> f64 {
    rows.iter().map(|row| length(*row)).sum()
}

/// A row with no pixel inside.
const OUTSIDE: [u32; 2] = [1, 0];

/// Returns the columns within the convex hull of the readings, per row; `None` without readings.
fn hull_of_readings(grid: Grid, is_reading: impl Fn(usize) -> bool) -> Option<Vec<[u32; 2]>> {
    let Grid { width, height } = grid;
    let extents = (0..height).map(|v| {
        let is_run = |u: &usize| (0..RUN).all(|i| is_reading(v * width + u + i));
        let mut starts = 0..(width + 1).saturating_sub(RUN);
        let first = starts.find(is_run)?;
        let last = starts.rev().find(is_run).unwrap_or(first);
        Some([first as u32, (last + RUN - 1) as u32])
    });
    convex(extents.map(|extent| extent.unwrap_or(OUTSIDE)))
}

/// Returns the convex hull of two fields of view.
fn joined(one: &[[u32; 2]], other: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let both = one
        .iter()
        .zip(other)
        .map(|(a, b)| match (a[0] <= a[1], b[0] <= b[1]) {
            (true, true) => [a[0].min(b[0]), a[1].max(b[1])],
            (true, false) => *a,
            _ => *b,
        });
    convex(both).unwrap_or_else(|| one.to_vec())
}

/// Returns the convex hull of the spans between the first and last column of each row; `None` if all are empty.
fn convex(rows: impl ExactSizeIterator<Item = [u32; 2]>) -> Option<Vec<[u32; 2]>> {
    let height = rows.len();
    let (mut left, mut right): (Vec<[f64; 2]>, Vec<[f64; 2]>) = (Vec::new(), Vec::new());
    for (v, [first, last]) in rows.enumerate().filter(|(_, row)| row[0] <= row[1]) {
        keep_convex(&mut left, [v as f64, f64::from(first)], 1.0);
        keep_convex(&mut right, [v as f64, f64::from(last)], -1.0);
    }
    let (&[top, _], &[bottom, _]) = (left.first()?, left.last()?);
    let mut rows = vec![OUTSIDE; height];
    let (mut at_left, mut at_right) = (0, 0);
    for (v, row) in rows.iter_mut().enumerate() {
        let v = v as f64;
        if v >= top && v <= bottom {
            let first = column_at(&left, &mut at_left, v).ceil();
            let last = column_at(&right, &mut at_right, v).floor();
            *row = [first as u32, last as u32];
        }
    }
    Some(rows)
}

/// Adds a corner below all others to one side of a hull and removes corners that are no longer on the hull. `inwards`
/// is the sign of the column direction from that side into the hull.
fn keep_convex(side: &mut Vec<[f64; 2]>, corner: [f64; 2], inwards: f64) {
    while let [.., a, b] = side[..] {
        let turn = (b[0] - a[0]) * (corner[1] - a[1]) - (corner[0] - a[0]) * (b[1] - a[1]);
        if turn * inwards > 0.0 {
            break;
        }
        side.pop();
    }
    side.push(corner);
}

/// Returns the column of a hull's side at a row; must be called with ascending rows.
fn column_at(side: &[[f64; 2]], at: &mut usize, row: f64) -> f64 {
    while *at + 1 < side.len() && side[*at + 1][0] < row {
        *at += 1;
    }
    let from = side[*at];
    match side.get(*at + 1) {
        Some(to) if to[0] > from[0] => {
            from[1] + (to[1] - from[1]) * (row - from[0]) / (to[0] - from[0])
        }
        _ => from[1],
    }
}

fn is_plausible(rows: &[[u32; 2]], grid: Grid) -> bool {
    let num_rows = rows.iter().filter(|row| row[0] <= row[1]).count() as f64;
    let widest = rows.iter().map(|row| length(*row)).fold(0.0, f64::max);
    num_rows >= LEAST_EXTENT * grid.height as f64
        && widest >= LEAST_EXTENT * grid.width as f64
        && area(rows) >= LEAST_AREA * grid.num_cells() as f64
}

/// Returns true if the view covers nearly the whole picture.
fn is_nearly_all(rows: &[[u32; 2]], grid: Grid) -> bool {
    area(rows) >= (1.0 - NEGLIGIBLE) * (1.0 - NEGLIGIBLE) * grid.num_cells() as f64
}

/// Returns true if most row ends have a reading close to them.
fn reaches_the_border(rows: &[[u32; 2]], ends: &[[u32; 2]]) -> bool {
    let inside = rows.iter().zip(ends).filter(|(row, _)| row[0] <= row[1]);
    let (mut num, mut close) = (0.0_f64, 0.0);
    for (row, end) in inside {
        num += 2.0;
        close += f64::from(u8::from(end[0] <= row[0] + CLOSE));
        close += f64::from(u8::from(end[1] + CLOSE >= row[1]));
    }
    close >= LEAST_BORDER * num
}

/// Returns the outermost readings of rows and columns within the band along the border, or the border itself where
/// there are none.
fn ends_of(
    grid: Grid,
    is_reading: impl Fn(usize) -> bool,
    rows: &[[u32; 2]],
) -> [Vec<[u32; 2]>; 2] {
    let width = grid.width;
    let mut across = rows.to_vec();
    // By themselves, so that the processor updates several columns at once.
    let (mut top, mut bottom) = (vec![u32::MAX; width], vec![0; width]);
    for (v, end) in across
        .iter_mut()
        .enumerate()
        .filter(|(_, end)| end[0] <= end[1])
    {
        let columns = end[0] as usize..=end[1] as usize;
        for top in &mut top[columns.clone()] {
            *top = (*top).min(v as u32);
        }
        bottom[columns].fill(v as u32);
        *end = outermost(*end, |u| is_reading(v * width + u));
    }
    let ends = |(u, (top, bottom))| {
        if top > bottom {
            OUTSIDE
        } else {
            outermost([top, bottom], |v| is_reading(v * width + u))
        }
    };
    let down = top.into_iter().zip(bottom).enumerate().map(ends).collect();
    [across, down]
}

fn outermost([first, last]: [u32; 2], is_reading: impl Fn(usize) -> bool) -> [u32; 2] {
    let band = BAND.min((last - first) / 2);
    let low = (first..=first + band).find(|&i| is_reading(i as usize));
    let high = (last - band..=last).rev().find(|&i| is_reading(i as usize));
    [low.unwrap_or(first), high.unwrap_or(last)]
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::scene::SceneCloud;
    use geometry::cloud::PointCloud;

    const GRID: Grid = Grid {
        width: 160,
        height: 120,
    };

    /// True inside a rounded, rotated rectangle with a ragged border.
    fn is_inside(i: usize) -> bool {
        let (u, v) = (
            (i % GRID.width) as f64 - 82.0,
            (i / GRID.width) as f64 - 58.0,
        );
        let (x, y) = (u * 0.99 + v * 0.1, v * 0.99 - u * 0.1);
        let ragged = (i / GRID.width % 3) as f64;
        x.abs() < 62.0 - ragged && y.abs() < 46.0 - ragged && x.abs() + y.abs() < 98.0
    }

    #[test]
    fn readings_that_end_inside_the_picture_show_where_the_view_ends() {
        // A hole inside, and the shadow of a near surface at the left border.
        let is_hole = |i: usize| {
            let (u, v) = (i % GRID.width, i / GRID.width);
            (70..90).contains(&u) && (50..60).contains(&v) || u < 34 && (40..80).contains(&v)
        };
        let view = FieldOfView::from_readings(GRID, |i| is_inside(i) && !is_hole(i), None);
        assert!(view.is_inner());
        let truth = (0..GRID.num_cells()).filter(|&i| is_inside(i));
        // The shadow hides the bulge of the border there.
        let is_missed = |i: &usize| !view.contains((i % 160) as i64, (i / 160) as i64);
        let num_missed = truth.clone().filter(is_missed).count();
        assert!(num_missed < 10, "{num_missed} pixels");
        let num = area(&view.rows);
        assert!(num < 1.06 * truth.count() as f64, "{num} pixels");
        // The surface beside the shadow is the outermost there; the one beside the hole is not.
        assert!(view.ends_at(34, 60, 3) && !view.ends_at(69, 55, 3));
        assert!(!view.contains(-1, 60) && !view.contains(82, 119));
    }

    #[test]
    fn a_picture_with_readings_up_to_its_edges_is_all_view() {
        let is_reading = |i: usize| i % 160 > 1 && !(40..60).contains(&(i / 160));
        let view = FieldOfView::from_readings(GRID, is_reading, None);
        assert!(!view.is_inner() && view.contains(0, 0) && view.contains(159, 119));
        assert!(view.ends_at(3, 20, 3) && !view.ends_at(8, 20, 3));
    }

    #[test]
    fn a_part_alone_before_nothing_is_no_field_of_view() {
        let small = |i: usize| (50..110).contains(&(i % 160)) && (40..80).contains(&(i / 160));
        let cross = |i: usize| {
            let (u, v) = (i % 160, i / 160);
            (10..150).contains(&u) && (50..70).contains(&v)
                || (70..90).contains(&u) && (5..115).contains(&v)
        };
        assert!(!FieldOfView::from_readings(GRID, small, None).is_inner());
        assert!(!FieldOfView::from_readings(GRID, cross, None).is_inner());
        assert!(!FieldOfView::from_readings(GRID, |_| false, None).is_inner());
    }

    #[test]
    fn what_an_empty_cell_showed_is_known_of_a_frame_with_a_dark_side() {
        let empty = FieldOfView::from_readings(GRID, is_inside, None);
        let dark = |i: usize| is_inside(i) && i % GRID.width > 60;
        let alone = FieldOfView::from_readings(GRID, dark, None);
        let known = FieldOfView::from_readings(GRID, dark, Some(&empty));
        assert!(known.is_inner() && known.contains(30, 60) && !known.contains(10, 60));
        assert!(!alone.is_inner());
    }

    #[test]
    fn a_mirrored_view_is_that_of_the_mirrored_picture_and_keeps_what_is_known() {
        let turned = |i: usize| i / GRID.width * GRID.width + GRID.width - 1 - i % GRID.width;
        let view = FieldOfView::from_readings(GRID, is_inside, None);
        let of_mirrored = FieldOfView::from_readings(GRID, |i| is_inside(turned(i)), None);
        assert!(view != of_mirrored && view.is_inner());
        assert_eq!(view.mirrored(), of_mirrored);
        let mut dark = scene(|i| is_inside(i) && i % GRID.width > 60);
        dark.set_known_view(Some(Arc::new(view)));
        let mirrored = dark.mirrored();
        let seen = mirrored.field_of_view().expect("a picture");
        assert!(seen.is_inner() && seen.contains(129, 60) && !seen.contains(149, 60));
    }

    fn scene(is_reading: impl Fn(usize) -> bool) -> SceneCloud {
        let point = |i: usize| {
            let z = if is_reading(i) { 1.0 } else { f32::NAN };
            Point3::new(z, z, z)
        };
        let cloud = PointCloud {
            points: (0..GRID.num_cells()).map(point).collect(),
            grid: Some(GRID),
            ..PointCloud::default()
        };
        SceneCloud::new(cloud, None)
    }

    #[test]
    fn what_other_frames_of_the_camera_showed_is_remembered() {
        let part = |i: usize| (60..100).contains(&(i % 160)) && (45..75).contains(&(i / 160));
        let is_half = |i: usize| is_inside(i) && i % GRID.width > 44;
        let frames = [scene(is_half), scene(part), scene(is_inside)];
        let views = frames.iter().map(SceneCloud::field_of_view);
        let remembered = views.fold(None, FieldOfView::remembered);
        let mut alone = scene(part);
        assert!(alone.field_of_view().is_some_and(|view| !view.is_inner()));
        alone.set_known_view(remembered);
        let view = alone.field_of_view().expect("a picture");
        assert!(view.is_inner() && view.contains(30, 60) && !view.contains(10, 60));
        // A camera that fills its picture leaves nothing to remember.
        let full = scene(|_| true);
        assert!(FieldOfView::remembered(None, full.field_of_view()).is_none());
    }
}
