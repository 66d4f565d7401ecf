//! Contour: follows the borders of the binary image to find the part's outline and its openings.
//!
//! Border following after S. Suzuki and K. Abe, "Topological structural analysis of digitized binary images by border
//! following", Computer Vision, Graphics, and Image Processing 30(1), 1985, algorithm 1, for 8-connected shapes. The
//! paper keeps the largest border; we also keep the openings inside it, and fix the directions: the outline runs
//! counter-clockwise in plane space (x right, y up), openings clockwise.

use nalgebra::{Point2, Point3, Vector3};

use crate::project::PlaneImage;
use geometry::{polygon, raster::BinaryImage};

/// Parameters of [`find_contour`].
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct ContourParams {
    /// Openings smaller than this are ignored as sensor dropouts, square metres, 0..0.1.
    pub min_opening_area: f64,
}

impl Default for ContourParams {
    fn default() -> Self {
        Self {
            min_opening_area: 0.002,
        }
    }
}

/// Whether a border surrounds set pixels or a hole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BorderKind {
    /// Around a connected shape.
    Outer,
    /// Around a hole within a shape.
    Hole,
}

/// A border found by border following.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TracedBorder {
    /// Whether it surrounds a shape or a hole.
    pub kind: BorderKind,
    /// Index of the border around this one; `None` for the frame of the image.
    pub parent: Option<usize>,
    /// Column and row of its set pixels in the order followed, closed, the first not repeated. A pixel on a spur
    /// occurs twice.
    pub pixels: Vec<[u32; 2]>,
}

/// Outline and openings of the part in plane space, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct Contour {
    /// The outline, counter-clockwise, closed, first point not repeated.
    pub outline: Vec<Point2<f64>>,
    /// The openings, largest first, each clockwise.
    pub openings: Vec<Vec<Point2<f64>>>,
    /// The outline's pixels (column, row) in the order followed, not re-oriented: the paper's contour.
    pub outline_pixels: Vec<[u32; 2]>,
    /// Height of the surface at each point of the outline, then of each opening, metres above the plane; `None` where no
    /// reading is within two pixels.
    pub heights: Vec<Vec<Option<f32>>>,
    /// Area of the outline minus its openings, square metres.
    pub area: f64,
}

/// Reason why no contour was found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error, serde::Serialize, serde::Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum ContourError {
    /// No shape in the image encloses an area.
    NoShape {
        /// Number of set pixels.
        num_set: usize,
    },
}

texts::described!(ContourError: "refusal" by "kind");

/// Finds the part's outline (the border that encloses the largest area) and its openings.
pub fn find_contour(plane: &PlaneImage, params: &ContourParams) -> Result<Contour, ContourError> {
    let borders = follow_borders(&plane.image);
    let to_plane = |border: &TracedBorder| -> Vec<Point2<f64>> {
        border
            .pixels
            .iter()
            .map(|&[column, row]| plane.plane_point(f64::from(column), f64::from(row)))
            .collect()
    };
    let largest = borders
        .iter()
        .enumerate()
        .filter(|(_, b)| b.kind == BorderKind::Outer)
        .map(|(i, b)| (i, polygon::signed_area(&to_plane(b)).abs()))
        .filter(|(_, area)| *area > 0.0)
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let Some((index, outline_area)) = largest else {
        return Err(ContourError::NoShape {
            num_set: plane.image.num_set(),
        });
    };
    let mut openings: Vec<(f64, Vec<Point2<f64>>)> = borders
        .iter()
        .filter(|b| b.kind == BorderKind::Hole && b.parent == Some(index))
        .map(|b| oriented(to_plane(b), -1.0))
        .map(|opening| (polygon::signed_area(&opening).abs(), opening))
        .filter(|(area, _)| *area >= params.min_opening_area)
        .collect();
    openings.sort_by(|a, b| b.0.total_cmp(&a.0));
    let area = outline_area - openings.iter().map(|o| o.0).sum::<f64>();
    let outline = oriented(to_plane(&borders[index]), 1.0);
    let openings: Vec<Vec<Point2<f64>>> = openings.into_iter().map(|o| o.1).collect();
    let heights =
        |border: &Vec<Point2<f64>>| border.iter().map(|p| height_near(plane, p)).collect();
    Ok(Contour {
        heights: std::iter::once(&outline)
            .chain(&openings)
            .map(heights)
            .collect(),
        outline,
        openings,
        outline_pixels: borders[index].pixels.clone(),
        area,
    })
}

fn oriented(mut corners: Vec<Point2<f64>>, sign: f64) -> Vec<Point2<f64>> {
    if polygon::signed_area(&corners) * sign < 0.0 {
        corners.reverse();
    }
    corners
}

impl Contour {
    /// Iterates over the outline and then the openings, each with the heights of its points.
    pub fn borders(&self) -> impl Iterator<Item = Border<'_>> {
        let all = std::iter::once(&self.outline).chain(&self.openings);
        all.zip(&self.heights)
            .map(|(points, heights)| Border { points, heights })
    }
}

/// A closed border of a contour.
#[derive(Clone, Copy, Debug)]
pub struct Border<'a> {
    /// Its points in plane space, metres.
    pub points: &'a [Point2<f64>],
    /// Height of the surface at each of them, metres above the plane.
    pub heights: &'a [Option<f32>],
}

/// Returns the points of one border on the surface: plane space, with the height of the nearest reading. Points
/// without a reading nearby are left out.
pub fn lift_border(border: Border<'_>) -> Vec<Point3<f64>> {
    let points = border.points.iter().zip(border.heights);
    let lifted = |(p, z): (&Point2<f64>, &Option<f32>)| z.map(|z| Point3::new(p.x, p.y, z.into()));
    points.filter_map(lifted).collect()
}

/// Number of points on either side that determine a border's direction: about 4 cm.
const TANGENT: usize = 9;

/// Returns the points of one closed border on the surface, each with the unit vector along it: plane space. `None`
/// where there is no reading nearby.
pub fn lift_oriented(border: Border<'_>) -> Vec<Option<(Point3<f64>, Vector3<f64>)>> {
    let Border { points, heights } = border;
    let n = points.len().min(heights.len());
    let oriented = |i: usize| {
        let height = heights[i]?;
        let at = |i: usize| points[i].coords.push(heights[i].unwrap_or(height).into());
        let (before, after) = ((i + n - TANGENT % n) % n, (i + TANGENT) % n);
        let along = (at(after) - at(before)).try_normalize(1e-9)?;
        Some((Point3::from(at(i)), along))
    };
    (0..n).map(oriented).collect()
}

/// Returns the height of the reading nearest to a plane point, at most two pixels away along each axis.
fn height_near(plane: &PlaneImage, point: &Point2<f64>) -> Option<f32> {
    let (column, row) = plane.pixel_of(point);
    let (column, row) = (column.round() as i64, row.round() as i64);
    let reading = |du: i64, dv: i64| {
        let (u, v) = (column + du, row + dv);
        let height = plane
            .image
            .is_set(u, v)
            .then(|| plane.heights[v as usize * plane.image.width + u as usize])?;
        height.is_finite().then_some(height)
    };
    NEAREST.into_iter().find_map(|(du, dv)| reading(du, dv))
}

/// The pixels at most two away along each axis, nearest first.
#[rustfmt::skip]
const NEAREST: [(i64, i64); 25] = [
    (0, 0),
    (0, -1), (-1, 0), (1, 0), (0, 1),
    (-1, -1), (1, -1), (-1, 1), (1, 1),
    (0, -2), (-2, 0), (2, 0), (0, 2),
    (-1, -2), (1, -2), (-2, -1), (2, -1), (-2, 1), (2, 1), (-1, 2), (1, 2),
    (-2, -2), (2, -2), (-2, 2), (2, 2),
];

/// The eight neighbours in clockwise order as displayed (row grows downwards), starting to the right.
const CLOCKWISE: [(i64, i64); 8] = [
    (1, 0),
    (1, 1),
    (0, 1),
    (-1, 1),
    (-1, 0),
    (-1, -1),
    (0, -1),
    (1, -1),
];

/// Returns all borders of an image with their nesting, in scan order.
pub fn follow_borders(image: &BinaryImage) -> Vec<TracedBorder> {
    // Add a frame of unset pixels, so that no neighbour is ever outside.
    let stride = image.width + 2;
    let mut labels = vec![0_i32; stride * (image.height + 2)];
    let rows = labels.chunks_exact_mut(stride).skip(1);
    for (labels, pixels) in rows.zip(image.pixels.chunks_exact(image.width.max(1))) {
        for (label, set) in labels[1..].iter_mut().zip(pixels) {
            *label = i32::from(*set != 0);
        }
    }
    let steps = CLOCKWISE.map(|(du, dv)| dv as isize * stride as isize + du as isize);
    let mut borders: Vec<TracedBorder> = Vec::new();
    for row in 1..=image.height {
        // Label of the last border met on this row; 1 is the frame of the image.
        let mut last_met = 1;
        for column in 1..=image.width {
            let at = row * stride + column;
            let label = labels[at];
            if label == 0 {
                continue;
            }
            // Step (1): determine whether a border starts here, and of which kind.
            let start = if label == 1 && labels[at - 1] == 0 {
                Some((BorderKind::Outer, 4))
            } else if label >= 1 && labels[at + 1] == 0 {
                if label > 1 {
                    last_met = label;
                }
                Some((BorderKind::Hole, 0))
            } else {
                None
            };
            if let Some((kind, from)) = start {
                let parent = parent_of(kind, last_met, &borders);
                // Labels 0 and 1 are background and unvisited, so border k carries label k + 2.
                let label = borders.len() as i32 + 2;
                let pixels = follow(&mut labels, &steps, stride, at, from, label);
                borders.push(TracedBorder {
                    kind,
                    parent,
                    pixels,
                });
            }
            // Step (4).
            if labels[at] != 1 {
                last_met = labels[at].abs();
            }
        }
    }
    borders
}

/// Table 1 of the article: determines the parent from the new border's kind and the border met last.
fn parent_of(kind: BorderKind, last_met: i32, borders: &[TracedBorder]) -> Option<usize> {
    let last = (last_met >= 2).then(|| last_met as usize - 2)?;
    if borders[last].kind == kind {
        borders[last].parent
    } else {
        Some(last)
    }
}

/// Step (3): follows one border from `start`, entered from its neighbour number `from`, and labels it.
fn follow(
    labels: &mut [i32],
    steps: &[isize; 8],
    stride: usize,
    start: usize,
    from: usize,
    label: i32,
) -> Vec<[u32; 2]> {
    let neighbour = |at: usize, direction: usize| at.wrapping_add_signed(steps[direction % 8]);
    let position = |at: usize| [(at % stride - 1) as u32, (at / stride - 1) as u32];
    // (3.1) clockwise from the unset neighbour to the first set one.
    let first = (1..8)
        .map(|turn| (from + turn) % 8)
        .find(|&d| labels[neighbour(start, d)] != 0);
    let Some(first) = first else {
        labels[start] = -label;
        return vec![position(start)];
    };
    let last_pixel = neighbour(start, first);
    let mut pixels = Vec::new();
    let (mut at, mut came_from) = (start, first);
    loop {
        pixels.push(position(at));
        // (3.3) counter-clockwise from the previous pixel to the next set one.
        let mut right_is_unset = false;
        let mut next = came_from;
        for turn in 1..=8 {
            next = (came_from + 8 - turn) % 8;
            if labels[neighbour(at, next)] != 0 {
                break;
            }
            right_is_unset |= next == 0;
        }
        // (3.4)
        if right_is_unset {
            labels[at] = -label;
        } else if labels[at] == 1 {
            labels[at] = label;
        }
        let next_pixel = neighbour(at, next);
        // (3.5) back at the start and about to leave it as at first.
        if next_pixel == start && at == last_pixel {
            return pixels;
        }
        at = next_pixel;
        came_from = (next + 4) % 8;
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use geometry::units::Metres;

    fn image(rows: &[&str]) -> BinaryImage {
        let pixels = rows
            .iter()
            .flat_map(|r| r.bytes().map(|b| u8::from(b == b'#')))
            .collect();
        BinaryImage {
            width: rows[0].len(),
            height: rows.len(),
            pixels,
        }
    }

    /// Labels 4- or 8-connected regions of pixels equal to `value` by flood fill, with a frame of unset pixels.
    fn flood(
        image: &BinaryImage,
        value: bool,
        neighbours: &[(i64, i64)],
    ) -> (Vec<Vec<usize>>, usize) {
        let (w, h) = (image.width + 2, image.height + 2);
        let mut region = vec![vec![usize::MAX; w]; h];
        let mut count = 0;
        let set = |u: i64, v: i64| image.is_set(u - 1, v - 1);
        for v in 0..h as i64 {
            for u in 0..w as i64 {
                if set(u, v) != value || region[v as usize][u as usize] != usize::MAX {
                    continue;
                }
                let mut open = vec![(u, v)];
                while let Some((u, v)) = open.pop() {
                    let inside = u >= 0 && v >= 0 && u < w as i64 && v < h as i64;
                    if !inside || set(u, v) != value || region[v as usize][u as usize] != usize::MAX
                    {
                        continue;
                    }
                    region[v as usize][u as usize] = count;
                    open.extend(neighbours.iter().map(|(du, dv)| (u + du, v + dv)));
                }
                count += 1;
            }
        }
        (region, count)
    }

    const FOUR: [(i64, i64); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

    proptest! {
        /// By definition, a border is the set of pixels of one 8-connected shape that have a 4-neighbour in one
        /// 4-connected region of the background.
        #[test]
        fn borders_are_the_pixels_between_a_shape_and_a_background_region(
            width in 1_usize..14,
            height in 1_usize..14,
            seed in prop::collection::vec(0_u8..3, 196),
        ) {
            let pixels = seed[..width * height].iter().map(|&s| u8::from(s > 0)).collect();
            let image = BinaryImage { width, height, pixels };
            let (shape, _) = flood(&image, true, &CLOCKWISE);
            let (ground, _) = flood(&image, false, &FOUR);
            let mut expected = std::collections::BTreeMap::<(usize, usize), std::collections::BTreeSet<[u32; 2]>>::new();
            for v in 1..=height {
                for u in 1..=width {
                    for (du, dv) in FOUR {
                        let other = ground[(v as i64 + dv) as usize][(u as i64 + du) as usize];
                        if shape[v][u] != usize::MAX && other != usize::MAX {
                            expected.entry((shape[v][u], other)).or_default().insert([u as u32 - 1, v as u32 - 1]);
                        }
                    }
                }
            }
            let borders = follow_borders(&image);
            let mut found: Vec<std::collections::BTreeSet<[u32; 2]>> =
                borders.iter().map(|b| b.pixels.iter().copied().collect()).collect();
            let mut expected: Vec<_> = expected.into_values().collect();
            found.sort();
            expected.sort();
            prop_assert_eq!(found, expected);
            for border in &borders {
                // Neighbours in the list are neighbours in the image, also from the last to the first.
                for (a, b) in border.pixels.iter().zip(border.pixels.iter().cycle().skip(1)) {
                    prop_assert!(a[0].abs_diff(b[0]) <= 1 && a[1].abs_diff(b[1]) <= 1);
                }
                // A hole lies in a shape, a shape in a hole or the frame.
                if let Some(parent) = border.parent {
                    prop_assert_ne!(borders[parent].kind, border.kind);
                } else {
                    prop_assert_eq!(border.kind, BorderKind::Outer);
                }
            }
        }
    }

    #[test]
    fn nested_shapes_know_what_surrounds_them() {
        let borders = follow_borders(&image(&[
            ".........",
            ".#######.",
            ".#.....#.",
            ".#.###.#.",
            ".#.#.#.#.",
            ".#.###.#.",
            ".#.....#.",
            ".#######.",
            ".........",
        ]));
        let kinds: Vec<_> = borders.iter().map(|b| (b.kind, b.parent)).collect();
        assert_eq!(
            kinds,
            [
                (BorderKind::Outer, None),
                (BorderKind::Hole, Some(0)),
                (BorderKind::Outer, Some(1)),
                (BorderKind::Hole, Some(2)),
            ]
        );
    }

    #[test]
    fn the_outline_runs_counter_clockwise_and_its_openings_clockwise() {
        let plane = PlaneImage::from_image(
            image(&[
                "........", ".######.", ".#....#.", ".#....#.", ".######.", "......#.",
            ]),
            Metres(0.1),
        );
        let contour = find_contour(&plane, &ContourParams::default()).expect("a shape");
        assert!(polygon::signed_area(&contour.outline) > 0.0);
        assert_eq!(contour.openings.len(), 1);
        assert!(polygon::signed_area(&contour.openings[0]) < 0.0);
        assert!(contour.area > 0.0);
    }

    #[test]
    fn an_empty_image_and_a_single_pixel_have_no_contour() {
        for rows in [["...", "...", "..."], ["...", ".#.", "..."]] {
            let plane = PlaneImage::from_image(image(&rows), Metres(0.01));
            assert!(matches!(
                find_contour(&plane, &ContourParams::default()),
                Err(ContourError::NoShape { .. })
            ));
        }
    }
}
