//! Rows of a raster: level lines of the arc length across the rows.
//!
//! On every line of the map across the rows, the arc length of the smoothed surface is summed from the middle of the
//! map; row k is where it is k spacings. So rows keep their distance along a curved surface, whatever their distance in
//! the plane.
//!
//! Known limits: the arc length is measured across the rows in the plane of the map. Where a row deviates from its
//! direction by an angle α, its neighbours are closer by the factor cos α.

use super::{coat::Coat, height_map::HeightMap, region::KeepOuts};

/// A place of a row on the map.
#[derive(Clone, Copy, Debug)]
pub(super) struct RowPlace {
    /// Map coordinates.
    pub(super) at: [f64; 2],
    pub(super) is_gun_on: bool,
}

/// Lays rows in order, each from low to high u, in steps of about a cell; rows that never spray are left out.
pub(super) fn lay_rows(
    map: &HeightMap,
    keep_outs: &KeepOuts<'_>,
    coat: &Coat,
) -> Vec<Vec<RowPlace>> {
    let arc = arc_lengths(map);
    let Some([low, high]) = painted_range(map, &arc) else {
        return Vec::new();
    };
    // The first and the last row are equally far out, within the overrun.
    let room = high - low + 2.0 * coat.overrun;
    let num_gaps = (room / coat.spacing).floor();
    let first = 0.5 * (low + high) - 0.5 * num_gaps * coat.spacing;
    let rows = (0..=num_gaps as usize).map(|k| {
        let level = first + k as f64 * coat.spacing;
        row(map, &arc, level, keep_outs, coat)
    });
    rows.filter(|row| !row.is_empty()).collect()
}

/// Arc length of each cell from the middle row of cells, along its column.
fn arc_lengths(map: &HeightMap) -> Vec<f64> {
    let [width, height] = map.size;
    let mut arc = vec![0.0; width * height];
    let middle = height / 2;
    for column in 0..width {
        let step = |a: usize, b: usize| {
            let rise = map.height[map.index(column, a)] - map.height[map.index(column, b)];
            map.cell.hypot(rise)
        };
        for row in middle + 1..height {
            arc[map.index(column, row)] = arc[map.index(column, row - 1)] + step(row, row - 1);
        }
        for row in (0..middle).rev() {
            arc[map.index(column, row)] = arc[map.index(column, row + 1)] - step(row, row + 1);
        }
    }
    arc
}

/// Least and greatest arc length of painted cells.
fn painted_range(map: &HeightMap, arc: &[f64]) -> Option<[f64; 2]> {
    let painted = || {
        arc.iter()
            .zip(&map.is_painted)
            .filter(|(_, is)| **is)
            .map(|(arc, _)| *arc)
    };
    Some([painted().reduce(f64::min)?, painted().reduce(f64::max)?])
}

/// The row at a level of the arc length, with its leads; empty if the gun is never on.
fn row(
    map: &HeightMap,
    arc: &[f64],
    level: f64,
    keep_outs: &KeepOuts<'_>,
    coat: &Coat,
) -> Vec<RowPlace> {
    let places: Vec<RowPlace> = (0..map.size[0])
        .filter_map(|column| {
            let at = [
                map.place(column, 0)[0],
                level_in_column(map, arc, column, level)?,
            ];
            let is_near = map.outside_at(at) <= coat.overrun;
            let is_gun_on = is_near && keep_outs.distance(&map.spot(at).at, at) >= coat.margin;
            Some(RowPlace { at, is_gun_on })
        })
        .collect();
    let Some(first) = places.iter().position(|place| place.is_gun_on) else {
        return Vec::new();
    };
    let last = places
        .iter()
        .rposition(|place| place.is_gun_on)
        .unwrap_or(first);
    let lead = (coat.lead / map.cell).ceil() as usize;
    let end = (last + lead + 1).min(places.len());
    let row = &places[first.saturating_sub(lead)..end];
    // A single place has no direction.
    if row.len() < 2 {
        Vec::new()
    } else {
        row.to_vec()
    }
}

/// The coordinate at which a column has this arc length; `None` beyond the map.
fn level_in_column(map: &HeightMap, arc: &[f64], column: usize, level: f64) -> Option<f64> {
    let at = |row: usize| arc[map.index(column, row)];
    let (mut low, mut high) = (0, map.size[1] - 1);
    if level < at(low) || level > at(high) {
        return None;
    }
    while high - low > 1 {
        let middle = usize::midpoint(low, high);
        if at(middle) <= level {
            low = middle;
        } else {
            high = middle;
        }
    }
    let share = (level - at(low)) / (at(high) - at(low));
    Some(map.place(column, low)[1] + share * map.cell)
}
