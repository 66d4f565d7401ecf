//! Picture of a film: thickness over the part, seen from the painted side, and its histogram.

use image::{Rgb, RgbImage};

use super::{
    canvas::Canvas,
    chart::{Axis, Chart, Division, LETTERS},
    lettering::Anchor,
    pictures::{DARK, DIM, LIGHT},
};

/// Colours by thickness over target, thinnest first; the target is green.
const COLOURS: [(f64, [f64; 3]); 6] = [
    (0.0, [30.0, 24.0, 70.0]),
    (0.5, [40.0, 90.0, 200.0]),
    (0.8, [60.0, 190.0, 190.0]),
    (1.0, [80.0, 200.0, 90.0]),
    (1.2, [240.0, 200.0, 60.0]),
    (2.0, [220.0, 50.0, 40.0]),
];
/// Colour of points that are not paintable.
const NOT_PAINTABLE: Rgb<u8> = Rgb([90, 90, 96]);
/// Upper left and lower right corner of the part, of the histogram and of the scale, pixels.
const PART: [[f64; 2]; 2] = [[30.0, 60.0], [770.0, 540.0]];
const BARS: [[f64; 2]; 2] = [[900.0, 90.0], [1270.0, 420.0]];
const SCALE: [[f64; 2]; 2] = [[900.0, 500.0], [1270.0, 518.0]];

/// A film to draw.
#[derive(Clone, Copy, Debug)]
pub struct FilmPicture<'a> {
    /// Title above the picture.
    pub title: &'a str,
    /// Positions of the points, to the right and up, metres.
    pub places: &'a [[f64; 2]],
    /// Thickness at each point, relative to the target.
    pub shares: &'a [f64],
    /// True for paintable points.
    pub is_paintable: &'a [bool],
    /// Point spacing, metres.
    pub spacing: f64,
    /// Share of the points per bin of thickness, a tenth of the target each; the last bin is open.
    pub histogram: &'a [f64],
}

fn colour(share: f64) -> Rgb<u8> {
    let next = COLOURS
        .iter()
        .position(|(end, _)| share < *end)
        .unwrap_or(COLOURS.len() - 1)
        .max(1);
    let ((low, from), (high, to)) = (COLOURS[next - 1], COLOURS[next]);
    let part = ((share - low) / (high - low)).clamp(0.0, 1.0);
    Rgb([0, 1, 2].map(|i| (from[i] + part * (to[i] - from[i])) as u8))
}

/// Draws a film.
pub fn film_picture(film: &FilmPicture<'_>) -> RgbImage {
    let mut canvas = Canvas::new(1300, 580, DARK);
    canvas.write(film.title, 18.0, [30.0, 34.0], Anchor::Left, LIGHT);
    draw_part(&mut canvas, film);
    draw_histogram(&mut canvas, film.histogram);
    draw_scale(&mut canvas);
    canvas.finish()
}

fn draw_part(canvas: &mut Canvas, film: &FilmPicture<'_>) {
    let bound = |axis: usize, pick: fn(f64, f64) -> f64| {
        film.places
            .iter()
            .map(|p| p[axis])
            .reduce(pick)
            .unwrap_or(0.0)
    };
    let (low, high) = (
        [0, 1].map(|axis| bound(axis, f64::min)),
        [0, 1].map(|axis| bound(axis, f64::max)),
    );
    let [[left, top], [right, bottom]] = PART;
    let room = [
        (right - left) / (high[0] - low[0]),
        (bottom - top) / (high[1] - low[1]),
    ];
    // Limits the scale for a degenerate part.
    let scale = room
        .into_iter()
        .filter(|s| s.is_finite())
        .fold(5000.0, f64::min);
    let middle = [f64::midpoint(left, right), f64::midpoint(top, bottom)];
    let half = (0.5 * scale * film.spacing).max(1.0) + 0.5;
    for ((place, share), is_paintable) in film.places.iter().zip(film.shares).zip(film.is_paintable)
    {
        let x = middle[0] + scale * (place[0] - f64::midpoint(low[0], high[0]));
        let y = middle[1] - scale * (place[1] - f64::midpoint(low[1], high[1]));
        let shown = if *is_paintable {
            colour(*share)
        } else {
            NOT_PAINTABLE
        };
        canvas.block([x - half, y - half], [x + half, y + half], shown);
    }
    let length = [1.0, 0.5, 0.2, 0.1, 0.05]
        .into_iter()
        .find(|m| m * scale < 300.0)
        .unwrap_or(0.05);
    canvas.line([left, 562.0], [left + length * scale, 562.0], LIGHT);
    let words = format!("{:.0} mm", 1000.0 * length);
    canvas.write(
        &words,
        LETTERS,
        [left + length * scale + 8.0, 567.0],
        Anchor::Left,
        LIGHT,
    );
}

fn draw_histogram(canvas: &mut Canvas, histogram: &[f64]) {
    let most = histogram.iter().copied().fold(0.05, f64::max);
    let last = 0.1 * histogram.len() as f64;
    let chart = Chart {
        corners: BARS,
        across: Axis {
            title: "thickness over target",
            range: [0.0, last],
            division: Division::Even,
            ticks: (0..=4)
                .map(|i| 0.25 * last * f64::from(i))
                .map(|v| (v, format!("{v:.1}")))
                .collect(),
        },
        up: Axis {
            title: "share of the paintable area, %",
            range: [0.0, 1.05 * most],
            division: Division::Even,
            ticks: (0..=4)
                .map(|i| 0.25 * most * f64::from(i))
                .map(|v| (v, format!("{:.0}", 100.0 * v)))
                .collect(),
        },
    };
    chart.draw_axes(canvas);
    for (i, share) in histogram.iter().enumerate() {
        let (from, to) = (0.1 * i as f64 + 0.01, 0.1 * i as f64 + 0.09);
        canvas.block(
            chart.place([from, *share]),
            chart.place([to, 0.0]),
            colour(0.1 * i as f64 + 0.05),
        );
    }
}

fn draw_scale(canvas: &mut Canvas) {
    let [[left, top], [right, bottom]] = SCALE;
    let num = 200;
    for i in 0..num {
        let at = |i: i32| left + (right - left) * f64::from(i) / f64::from(num);
        canvas.block(
            [at(i), top],
            [at(i + 1), bottom],
            colour(2.0 * (f64::from(i) + 0.5) / f64::from(num)),
        );
    }
    for (share, words) in [
        (0.0, "0"),
        (0.8, "0.8"),
        (1.0, "1"),
        (1.2, "1.2"),
        (2.0, "2"),
    ] {
        let x = left + (right - left) * share / 2.0;
        canvas.line([x, bottom], [x, bottom + 5.0], DIM);
        canvas.write(words, LETTERS, [x, bottom + 22.0], Anchor::Middle, LIGHT);
    }
    canvas.block([left, 550.0], [left + 14.0, 564.0], NOT_PAINTABLE);
    canvas.write(
        "not paintable",
        LETTERS,
        [left + 22.0, 563.0],
        Anchor::Left,
        LIGHT,
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thin_is_blue_right_is_green_and_thick_is_red() {
        let strongest = |share: f64| {
            let Rgb(all) = colour(share);
            (0..3).max_by_key(|i| all[*i])
        };
        assert_eq!([0.3, 1.0, 2.5].map(strongest), [Some(2), Some(1), Some(0)]);
    }

    #[test]
    fn a_film_of_one_point_and_of_none_is_drawn() {
        let mut film = FilmPicture {
            title: "",
            places: &[[0.0, 0.0]],
            shares: &[1.0],
            is_paintable: &[true],
            spacing: 0.01,
            histogram: &[1.0],
        };
        let middle = film_picture(&film).get_pixel(400, 300).0;
        assert_eq!(middle, colour(1.0).0);
        film = FilmPicture {
            places: &[],
            shares: &[],
            is_paintable: &[],
            ..film
        };
        assert_eq!(film_picture(&film).get_pixel(400, 300).0, DARK.0);
    }
}
