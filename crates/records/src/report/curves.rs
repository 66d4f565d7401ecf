//! Plots of measurements against size, on logarithmic axes.

use image::{Rgb, RgbImage, imageops::replace};

use super::{
    canvas::Canvas,
    chart::{Axis, Chart, Division, LETTERS},
    lettering::Anchor,
    pictures::{DARK, DIM, LIGHT},
};

/// A measurement for several sizes.
#[derive(Clone, Debug, PartialEq)]
pub struct SizeCurve {
    /// Name in the legend.
    pub name: String,
    /// Size and measured value, both above zero, by ascending size.
    pub points: Vec<[f64; 2]>,
}

/// Colours and dashes, distinct without colour; the first is the serial one.
const LOOKS: [(Rgb<u8>, &[f64]); 4] = [
    (Rgb([244, 246, 250]), &[]),
    (Rgb([255, 196, 61]), &[14.0, 6.0]),
    (Rgb([96, 176, 255]), &[6.0, 4.0]),
    (Rgb([178, 110, 200]), &[2.0, 4.0]),
];

/// Draws the curves with these axis titles; a vertical line marks one size.
pub fn curves_picture(
    title: &str,
    [across, up]: [&str; 2],
    curves: &[SizeCurve],
    mark: Option<(f64, &str)>,
) -> RgbImage {
    let points = || curves.iter().flat_map(|curve| curve.points.iter());
    let range = |axis: usize| {
        let values = || {
            points()
                .map(|p| p[axis])
                .filter(|v| v.is_finite() && *v > 0.0)
        };
        let (low, high) = (
            values().fold(f64::INFINITY, f64::min),
            values().fold(0.0, f64::max),
        );
        if low < high { [low, high] } else { [1.0, 10.0] }
    };
    let [low, high] = range(1);
    let chart = Chart {
        corners: [[110.0, 60.0], [830.0, 500.0]],
        across: Axis {
            title: across,
            range: range(0),
            division: Division::ByFactors,
            ticks: decades(range(0)),
        },
        up: Axis {
            title: up,
            range: [low / 1.3, high * 1.3],
            division: Division::ByFactors,
            ticks: decades([low / 1.3, high * 1.3]),
        },
    };
    let mut canvas = Canvas::new(1040, 570, DARK);
    canvas.write(title, 20.0, [110.0, 36.0], Anchor::Left, LIGHT);
    chart.draw_axes(&mut canvas);
    if let Some((size, words)) = mark {
        let [x, top] = chart.place([size, chart.up.range[1]]);
        canvas.line([x, top], [x, chart.corners[1][1]], DIM);
        // Curves rise from left to right, so the upper left and the lower right are free.
        let bottom = chart.corners[1][1];
        let (at, anchor) = if x < f64::midpoint(chart.corners[0][0], chart.corners[1][0]) {
            ([x + 6.0, top + 16.0], Anchor::Left)
        } else {
            ([x - 6.0, bottom - 10.0], Anchor::Right)
        };
        canvas.write(words, LETTERS, at, anchor, LIGHT);
    }
    for (index, curve) in curves.iter().enumerate() {
        let (colour, pattern) = LOOKS[index % LOOKS.len()];
        let corners = curve.points.iter().map(|p| chart.place(*p));
        canvas.polyline(corners, (2.0, pattern), colour);
        for point in &curve.points {
            canvas.dot(chart.place(*point), 3.0, colour);
        }
        let row = 80.0 + 24.0 * index as f64;
        let sample = [[850.0, row - 5.0], [890.0, row - 5.0]];
        canvas.polyline(sample, (2.0, pattern), colour);
        canvas.write(&curve.name, LETTERS, [898.0, row], Anchor::Left, LIGHT);
    }
    canvas.finish()
}

/// Stacks pictures vertically.
pub fn stacked(pictures: &[RgbImage]) -> RgbImage {
    let width = pictures.iter().map(RgbImage::width).max().unwrap_or(1);
    let height = pictures.iter().map(RgbImage::height).sum::<u32>().max(1);
    let mut all = RgbImage::from_pixel(width, height, DARK);
    let mut top = 0;
    for picture in pictures {
        replace(&mut all, picture, 0, i64::from(top));
        top += picture.height();
    }
    all
}

/// Returns the powers of ten within a range, with labels.
fn decades([low, high]: [f64; 2]) -> Vec<(f64, String)> {
    (-6..=9)
        .map(|power| 10.0_f64.powi(power))
        .filter(|value| (low..=high).contains(value))
        .map(|value| (value, value.to_string()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_curve_is_drawn_and_nonsense_is_survived() {
        let curve = |times: [f64; 3]| SizeCurve {
            name: "a worker".into(),
            points: vec![[8.0, times[0]], [64.0, times[1]], [512.0, times[2]]],
        };
        let image = curves_picture(
            "Ranking",
            ["references", "ms"],
            &[curve([0.1, 1.0, 9.0]), curve([0.3, 0.8, 5.0])],
            Some((32.0, "32")),
        );
        for (colour, _) in &LOOKS[..2] {
            let num = image.pixels().filter(|p| *p == colour).count();
            assert!(num > 300, "{num}");
        }
        curves_picture("", ["", ""], &[curve([f64::NAN, 0.0, -1.0])], None);
        curves_picture("", ["", ""], &[], None);
    }
}
