//! Recognises strips of background: a floor or a second wall of which the view shows too little to be found as a plane.
//!
//! Such a strip lies along one side of the view and continues a background plane: where it ends inwards, the readings
//! beside it, although within the plane's tolerance, are already off the plane. Those beside a part in front of a wall
//! lie on the wall, however thin the part looks.
//!
//! Known limits: a strip of background stays a surface if something else touches it, if the plane it continues was fitted
//! across the corner of wall and floor, if the picture is so coarse that the strip leaves the plane's tolerance within one
//! pixel, or without a picture. An edge of a flat part that reaches both the wall's tolerance and the side of the view, and
//! that is seen nearly edge-on, is taken for a strip.

use nalgebra::Point3;

use super::{
    PointLabel, SegmentParams,
    clusters::{BRIDGED_PIXELS, MARGIN, Members},
    part::is_flat,
    planes::PlaneTolerance,
};
use crate::scene::SceneCloud;
use geometry::{cloud::Grid, plane::Plane, principal::principal_axes, units::Metres};

/// Maximum mean width of a strip, as a divisor of the picture's extent: twice the widest that was not found as a plane.
const WIDEST: usize = 16;
/// Minimum number of a strip's lines per pixel of its mean width.
const LONG: f64 = 8.0;
/// Minimum share of a strip's lines that end with the view: at grazing angles, the outermost readings are often missing.
const LEAST_AT_EDGE: f64 = 0.7;
/// Minimum share of a strip's lines beside which the background continues it: 0.97 to 1 in simulated empty cells, at most
/// 0.2 for narrow surfaces in real frames of parts.
const LEAST_CONTINUED: f64 = 0.9;
/// Minimum distance of a reading from its plane to continue a strip, as a share of the plane's tolerance.
const LIFTED: f64 = 0.3;
/// Maximum cosine of the angle between a strip and the plane that it continues: the rim of a sheet that was taken for a
/// wall is bent less.
const UPRIGHT_MAX_COSINE: f64 = 0.7;

/// The readings on one line of the picture.
#[derive(Clone, Copy)]
struct Span {
    first: usize,
    last: usize,
}

/// Returns true if a surface is a strip of background.
pub(super) fn is_strip(
    scene: &SceneCloud,
    surface: &Members,
    labels: &[PointLabel],
    planes: &[Plane],
    noise_at_1m: Metres,
    params: &SegmentParams,
) -> bool {
    let Some((grid, view)) = scene.cloud.grid.zip(scene.field_of_view()) else {
        return false;
    };
    let longest = grid.width.max(grid.height);
    if !surface.cluster.touches_edge || surface.indices.len() > longest * longest / WIDEST {
        return false;
    }
    let points = &scene.cloud.points;
    let tolerance = PlaneTolerance::new(noise_at_1m, params);
    let continued_at = |pixel: usize| match labels[pixel] {
        PointLabel::Background(number) => {
            let plane = *planes.get(usize::from(number))?;
            let p = points[pixel].cast::<f64>();
            let along_normal = plane.normal.dot(&p.coords) as f32;
            let tolerance = f64::from(tolerance.at(p.z as f32, along_normal));
            Some((plane.signed_distance(&p) > LIFTED * tolerance, plane))
        }
        _ => None,
    };
    [false, true].into_iter().any(|by_column| {
        let (num_lines, length) = if by_column {
            (grid.width, grid.height)
        } else {
            (grid.height, grid.width)
        };
        let spans = spans_of(&surface.indices, grid, by_column, num_lines);
        let num = spans.iter().flatten().count() as f64;
        let widths = spans
            .iter()
            .flatten()
            .map(|span| span.last + 1 - span.first);
        let width = widths.sum::<usize>() as f64 / num;
        if width * WIDEST as f64 > length as f64 || num < LONG * width {
            return false;
        }
        [false, true].into_iter().any(|at_end| {
            let (mut num_at_edge, mut num_continued) = (0_usize, 0_usize);
            let mut continues = None;
            for (line, span) in spans.iter().enumerate() {
                let Some(Span { first, last }) = *span else {
                    continue;
                };
                let ends = if by_column {
                    view.column_ends(line)
                } else {
                    view.row_ends(line)
                };
                let is_at_edge = ends.is_some_and(|[start, end]| {
                    if at_end {
                        last + MARGIN as usize >= end as usize
                    } else {
                        first <= (start + MARGIN) as usize
                    }
                });
                num_at_edge += usize::from(is_at_edge);
                let pixel_at = |at: usize| {
                    if by_column {
                        at * grid.width + line
                    } else {
                        line * grid.width + at
                    }
                };
                let beside = (1..=BRIDGED_PIXELS + 1).map_while(|step| {
                    if at_end {
                        first.checked_sub(step)
                    } else {
                        Some(last + step).filter(|at| *at < length)
                    }
                });
                if let Some((true, plane)) = beside.map(pixel_at).find_map(continued_at) {
                    num_continued += 1;
                    continues = Some(plane);
                }
            }
            num_at_edge as f64 >= LEAST_AT_EDGE * num
                && num_continued as f64 >= LEAST_CONTINUED * num
                && continues.is_some_and(|plane| {
                    let own = surface.indices.iter().map(|i| points[*i as usize]);
                    let own = own.map(|p: Point3<f32>| (p.cast(), 1.0));
                    principal_axes(own.clone()).is_some_and(|axes| {
                        axes.axes.column(2).dot(&plane.normal).abs() < UPRIGHT_MAX_COSINE
                    }) && is_flat(own.map(|p| p.0), noise_at_1m)
                })
        })
    })
}

/// Returns the extent of a surface on each row, or on each column.
fn spans_of(indices: &[u32], grid: Grid, by_column: bool, num_lines: usize) -> Vec<Option<Span>> {
    let mut spans: Vec<Option<Span>> = vec![None; num_lines];
    for &i in indices {
        let (row, column) = (i as usize / grid.width, i as usize % grid.width);
        let (line, at) = if by_column {
            (column, row)
        } else {
            (row, column)
        };
        let span = spans[line].get_or_insert(Span {
            first: at,
            last: at,
        });
        span.first = span.first.min(at);
        span.last = span.last.max(at);
    }
    spans
}
