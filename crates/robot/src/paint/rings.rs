//! Rings of the contour pattern: level lines of the distance from the outline, along the surface.
//!
//! Inside, the distance of a painted cell is the shortest way over the map to a cell that is not painted (Dijkstra, 32
//! neighbours, lengths in space), so wide openings and keep-outs count as outlines too. Outside, it is the distance in
//! the plane. Levels are evenly spaced, from the outermost, beyond the edge, to half a spacing before the middle of the
//! widest place, so that rings from both sides keep their distance there. Level lines are closed (marching squares).
//!
//! Rings run from the outside in: the next is the nearest of those whose outer neighbour is done, and begins where it
//! is nearest to the end of the last one. The gun is on once around; before and after that it runs along the ring by
//! the lead.
//!
//! Known limits: where a part narrows, rings end before its middle, and opposite ones are nearer or farther apart than
//! others; there the film is uneven. Shortest ways over 32 neighbours are up to 1.3 % too long.

use std::{cmp::Reverse, collections::BinaryHeap};

use super::{coat::Coat, height_map::HeightMap, region::KeepOuts, rows::RowPlace};

/// Greatest distance of the outermost ring beyond the edge, in spacings: the film at the edge lacks 1 %.
const MAX_SPACINGS_BEYOND: f64 = 1.0;
/// Shorter rings, in cells, are left out.
const MIN_RING_CELLS: f64 = 6.0;
/// Smoothing passes of a ring, which otherwise follows the cells.
const NUM_SMOOTHINGS: usize = 3;

/// A closed line on the map; the last place is joined to the first.
#[derive(Debug)]
struct Ring {
    /// Index of its level, from the outside.
    level: usize,
    places: Vec<[f64; 2]>,
}

/// Lays rings in order, each once around from its start, with its leads; rings that never spray are left out.
pub(super) fn lay_rings(
    map: &HeightMap,
    keep_outs: &KeepOuts<'_>,
    coat: &Coat,
) -> Vec<Vec<RowPlace>> {
    let depth = depths(map);
    let widest = depth.iter().copied().fold(0.0, f64::max);
    let mut rings = Vec::new();
    for (level, at) in levels(widest, coat).into_iter().enumerate() {
        for line in level_lines(map, &depth, at) {
            let places = smoothed(line);
            if circumference(&places) >= MIN_RING_CELLS * map.cell {
                rings.push(Ring { level, places });
            }
        }
    }
    let laid = in_order(rings)
        .into_iter()
        .map(|ring| with_leads(map, &ring, keep_outs, coat));
    laid.filter(|row| row.iter().any(|place| place.is_gun_on))
        .collect()
}

/// The distances of all levels from the outline, from the outermost inwards; below 0 beyond the edge.
fn levels(widest: f64, coat: &Coat) -> Vec<f64> {
    let beyond = coat.overrun.min(MAX_SPACINGS_BEYOND * coat.spacing);
    let room = widest + beyond;
    let num_gaps = (room / coat.spacing - 0.5).round().max(0.0);
    let spacing = room / (num_gaps + 0.5);
    (0..=num_gaps as usize)
        .map(|k| k as f64 * spacing - beyond)
        .collect()
}

/// Distance of every cell from the outline along the surface, above 0 inside.
fn depths(map: &HeightMap) -> Vec<f64> {
    /// An eighth of the steps to 32 neighbours; the others by rotation and reflection.
    const STEPS: [[i32; 2]; 5] = [[1, 0], [1, 1], [2, 1], [3, 1], [3, 2]];
    let mut steps: Vec<[i32; 2]> = Vec::new();
    for [a, b] in STEPS {
        for [x, y] in [[a, b], [b, a]] {
            steps.extend([[x, y], [-x, y], [x, -y], [-x, -y]]);
        }
    }
    steps.sort_unstable();
    steps.dedup();
    let [width, height] = map.size;
    let mut depth: Vec<f64> = map.outside.iter().map(|outside| -outside).collect();
    // Ordered by distance: the bits of non-negative floats sort like their values.
    let mut open = BinaryHeap::new();
    let mut shortest = vec![f64::INFINITY; depth.len()];
    for (i, is_painted) in map.is_painted.iter().enumerate() {
        if !is_painted {
            shortest[i] = 0.0;
            open.push(Reverse((0_u64, i)));
        }
    }
    while let Some(Reverse((bits, i))) = open.pop() {
        let here = f64::from_bits(bits);
        if here > shortest[i] {
            continue;
        }
        let [column, row] = [(i % width) as i32, (i / width) as i32];
        for [dx, dy] in &steps {
            let (x, y) = (column + dx, row + dy);
            if x < 0 || y < 0 || x >= width as i32 || y >= height as i32 {
                continue;
            }
            let other = map.index(x as usize, y as usize);
            if !map.is_painted[other] {
                continue;
            }
            let flat = map.cell * f64::from(*dx).hypot(f64::from(*dy));
            let way = here + flat.hypot(map.height[other] - map.height[i]);
            if way < shortest[other] {
                shortest[other] = way;
                open.push(Reverse((way.to_bits(), other)));
            }
        }
    }
    for (i, depth) in depth.iter_mut().enumerate() {
        if map.is_painted[i] {
            // The edge is half a cell before the middle of the first cell outside.
            *depth = (shortest[i] - 0.5 * map.cell).max(0.0);
        }
    }
    depth
}

/// Closed lines on which the depth is `level`, with the deeper side on their left.
fn level_lines(map: &HeightMap, depth: &[f64], level: f64) -> Vec<Vec<[f64; 2]>> {
    let [width, height] = map.size;
    // A crossing is identified by the lower cell of its edge and the axis along which the edge runs.
    let mut next: Vec<Option<usize>> = vec![None; 2 * width * height];
    let above = |column: usize, row: usize| depth[map.index(column, row)] > level;
    for row in 0..height - 1 {
        for column in 0..width - 1 {
            // Corners counter-clockwise, and the edge from each to the next.
            let corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| [column + a, row + b]);
            let is_above = corners.map(|[a, b]| above(a, b));
            let edges = [
                2 * map.index(column, row),
                2 * map.index(column + 1, row) + 1,
                2 * map.index(column, row + 1),
                2 * map.index(column, row) + 1,
            ];
            // With the deeper side on the left, a line enters where the corners change from deeper to less deep.
            let enters: Vec<usize> = (0..4)
                .filter(|i| is_above[*i] && !is_above[(*i + 1) % 4])
                .collect();
            let leaves: Vec<usize> = (0..4)
                .filter(|i| !is_above[*i] && is_above[(*i + 1) % 4])
                .collect();
            for from in &enters {
                // If two lines cross a cell, each cuts off one corner that is less deep.
                let to = (1..4)
                    .map(|k| (from + k) % 4)
                    .find(|to| leaves.contains(to));
                if let Some(to) = to {
                    next[edges[to]] = Some(edges[*from]);
                }
            }
        }
    }
    let place = |edge: usize| {
        let (i, is_up) = (edge / 2, edge % 2 == 1);
        let other = if is_up { i + width } else { i + 1 };
        let share = (level - depth[i]) / (depth[other] - depth[i]);
        let [x, y] = map.place(i % width, i / width);
        let way = share.clamp(0.0, 1.0) * map.cell;
        if is_up { [x, y + way] } else { [x + way, y] }
    };
    let mut lines = Vec::new();
    for start in 0..next.len() {
        let (mut line, mut at) = (Vec::new(), start);
        while let Some(to) = next[at].take() {
            line.push(place(at));
            at = to;
        }
        // Only a line that leaves the map would be open, and the map's rim is farther outside than any level.
        if at == start && line.len() > 2 {
            lines.push(line);
        }
    }
    lines
}

fn smoothed(mut places: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    for _ in 0..NUM_SMOOTHINGS {
        let num = places.len();
        let mean = |i: usize| {
            let around = [
                places[(i + num - 1) % num],
                places[i],
                places[(i + 1) % num],
            ];
            [0, 1].map(|axis| 0.25 * (around[0][axis] + around[2][axis]) + 0.5 * around[1][axis])
        };
        places = (0..num).map(mean).collect();
    }
    places
}

fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn circumference(places: &[[f64; 2]]) -> f64 {
    let ways = (0..places.len()).map(|i| apart(places[i], places[(i + 1) % places.len()]));
    ways.sum()
}

/// Index of the place nearest to `from`, and its distance.
fn nearest_place(ring: &Ring, from: [f64; 2]) -> (usize, f64) {
    let each = ring
        .places
        .iter()
        .map(|place| apart(*place, from))
        .enumerate();
    each.min_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap_or((0, f64::INFINITY))
}

/// Sorts rings from the outside in with short ways between them; each begins where it is nearest to the one before.
fn in_order(rings: Vec<Ring>) -> Vec<Ring> {
    // For each ring, the nearest one of the previous level.
    let outer: Vec<Option<usize>> = rings
        .iter()
        .map(|ring| {
            let before = rings.iter().enumerate();
            let before = before.filter(|(_, other)| other.level + 1 == ring.level);
            let gap = |other: &Ring| {
                let ways = other
                    .places
                    .iter()
                    .map(|place| nearest_place(ring, *place).1);
                ways.fold(f64::INFINITY, f64::min)
            };
            let gaps = before.map(|(i, other)| (i, gap(other)));
            gaps.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
        })
        .collect();
    let mut left: Vec<Option<Ring>> = rings.into_iter().map(Some).collect();
    let mut ordered: Vec<Ring> = Vec::new();
    loop {
        let end = ordered.last().map(|ring: &Ring| ring.places[0]);
        let open = left.iter().enumerate().filter_map(|(i, ring)| {
            let is_open = outer[i].is_none_or(|outer| left[outer].is_none());
            ring.as_ref().filter(|_| is_open).map(|ring| (i, ring))
        });
        let choices = open.map(|(i, ring)| {
            let (start, way) = end.map_or((0, ring.level as f64), |end| nearest_place(ring, end));
            (i, start, way)
        });
        let Some((i, start, _)) = choices.min_by(|a, b| a.2.total_cmp(&b.2)) else {
            return ordered;
        };
        if let Some(mut ring) = left[i].take() {
            ring.places.rotate_left(start);
            ordered.push(ring);
        }
    }
}

/// Once around the ring, with the lead along it at both ends.
fn with_leads(
    map: &HeightMap,
    ring: &Ring,
    keep_outs: &KeepOuts<'_>,
    coat: &Coat,
) -> Vec<RowPlace> {
    let num = ring.places.len();
    // A lead is at most half of a short ring.
    let most = (num / 2).max(1);
    let lead = |step: usize| {
        let mut way = 0.0;
        let ways = (1..most).take_while(|k| {
            let (a, b) = ((k - 1) * step % num, k * step % num);
            way += apart(ring.places[a], ring.places[b]);
            way <= coat.lead
        });
        ways.count()
    };
    let (before, behind) = (lead(num - 1), lead(1));
    let on = |at: [f64; 2]| keep_outs.distance(&map.spot(at).at, at) >= coat.margin;
    let place = |k: usize| {
        let at = ring.places[k % num];
        let is_around = k >= num && k <= 2 * num;
        RowPlace {
            at,
            is_gun_on: is_around && on(at),
        }
    };
    (num - before..=2 * num + behind).map(place).collect()
}

#[cfg(test)]
mod tests {
    use crate::paint::{
        Coat, Film, PaintSurface, Pattern, plan, simulate,
        surface::tests::{grid, plate},
    };
    use nalgebra::{Point3, Vector3};
    use stages::reference::Coverage;

    fn coat(pattern: Pattern) -> Coat {
        let coat = Coat {
            pattern,
            flank_lean: 0.0,
            ..Coat::default()
        };
        Coat {
            target: coat.flat_thickness(),
            ..coat
        }
    }

    fn film(surface: &PaintSurface, pattern: Pattern) -> Film {
        let coat = coat(pattern);
        let path = plan(surface, &coat, &[]).expect("planned");
        simulate(surface, &path, &coat, &[]).expect("simulated")
    }

    #[test]
    fn rings_around_a_plate_are_even_closed_and_from_the_outside_in() {
        let surface = plate(1.0, 0.6);
        let path = plan(&surface, &coat(Pattern::Contour), &[]).expect("planned");
        // Where rings cross the line from the middle to the nearer edge.
        let mut crossings = Vec::new();
        for pair in path.points().windows(2).filter(|pair| pair[0].is_gun_on) {
            let (a, b) = (pair[0].nozzle, pair[1].nozzle);
            if (a.x > 0.0) != (b.x > 0.0) && a.y > 0.0 {
                crossings.push(a.y + (b.y - a.y) * a.x / (a.x - b.x));
            }
        }
        assert!(crossings.is_sorted_by(|a, b| a > b), "{crossings:?}");
        let gap = crossings[0] - crossings[1];
        assert!((gap / 0.07 - 1.0).abs() < 0.2, "{gap}");
        for pair in crossings.windows(2) {
            assert!((pair[0] - pair[1] - gap).abs() < 0.003, "{crossings:?}");
        }
        // Rings from both sides keep the same distance in the middle.
        let last = crossings.last().expect("rings");
        assert!((2.0 * last - gap).abs() < 0.015, "{crossings:?}");
        // A ring ends where it began.
        let on: Vec<usize> = (0..path.points().len())
            .filter(|i| path.points()[*i].is_gun_on)
            .collect();
        let mut starts = vec![on[0]];
        for pair in on.windows(2).filter(|pair| pair[1] > pair[0] + 1) {
            let (start, end) = (starts[starts.len() - 1], pair[0] + 1);
            let gap = path.points()[start].nozzle - path.points()[end].nozzle;
            assert!(gap.norm() < 1e-6, "{gap}");
            // The way to the next ring is short.
            let next = path.points()[end].nozzle - path.points()[pair[1]].nozzle;
            assert!(next.norm() < 0.2, "{next}");
            starts.push(pair[1]);
        }
        assert_eq!(starts.len(), crossings.len());
    }

    #[test]
    fn contours_paint_a_plate_and_a_plate_with_an_opening_as_rows_do() {
        let holed = grid(101, 81, Coverage::OneSide, |i, j| {
            let p = Vector3::new(i - 0.5, 0.8 * j - 0.4, 0.0);
            let out = p.norm().max(1e-9);
            // Points of the opening are moved to its edge.
            let p = if out < 0.15 { p * (0.15 / out) } else { p };
            (Point3::from(p), Vector3::z())
        });
        for (surface, least) in [(plate(1.0, 0.6), 0.9), (holed, 0.85)] {
            let rows = film(&surface, Pattern::Raster).figures;
            let rings = film(&surface, Pattern::Contour).figures;
            assert!(rings.within > least, "{} of {}", rings.within, rows.within);
            assert!((rings.mean / rows.mean - 1.0).abs() < 0.1, "{rings:?}");
            assert!(rings.missed < 0.005, "{rings:?}");
        }
    }
}
