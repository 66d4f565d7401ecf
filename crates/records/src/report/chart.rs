//! Charts: axes with ticks and titles, and the mapping from values to pixels.

use image::Rgb;

use super::{
    canvas::Canvas,
    lettering::Anchor,
    pictures::{DIM, FAINT, LIGHT},
};

/// Text size of charts, pixels.
pub(super) const LETTERS: f32 = 15.0;

/// Scale of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Division {
    /// Linear.
    Even,
    /// Logarithmic; values are above zero.
    ByFactors,
}

/// An axis.
pub(super) struct Axis<'a> {
    pub(super) title: &'a str,
    pub(super) range: [f64; 2],
    pub(super) division: Division,
    /// Values with a grid line, and their labels.
    pub(super) ticks: Vec<(f64, String)>,
}

impl Axis<'_> {
    /// Returns the position on the axis: 0 at the lower end, 1 at the upper one.
    fn share(&self, value: f64) -> f64 {
        let of = |value: f64| match self.division {
            Division::Even => value,
            Division::ByFactors => value.max(f64::MIN_POSITIVE).ln(),
        };
        let [low, high] = self.range.map(of);
        (of(value) - low) / (high - low)
    }
}

/// The area between two axes.
pub(super) struct Chart<'a> {
    /// Upper left and lower right corner, pixels.
    pub(super) corners: [[f64; 2]; 2],
    pub(super) across: Axis<'a>,
    pub(super) up: Axis<'a>,
}

impl Chart<'_> {
    /// Returns the pixel of a pair of values.
    pub(super) fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [[left, top], [right, bottom]] = self.corners;
        [
            left + (right - left) * self.across.share(x),
            bottom - (bottom - top) * self.up.share(y),
        ]
    }

    /// Draws grid lines, tick labels and titles.
    pub(super) fn draw_axes(&self, canvas: &mut Canvas) {
        let [[left, top], [right, bottom]] = self.corners;
        for (value, text) in &self.across.ticks {
            let x = self.place([*value, self.up.range[0]])[0];
            canvas.line([x, top], [x, bottom], FAINT);
            let at = [x, bottom + 20.0];
            canvas.write(text, LETTERS, at, Anchor::Middle, DIM_TEXT);
        }
        for (value, text) in &self.up.ticks {
            let y = self.place([self.across.range[0], *value])[1];
            canvas.line([left, y], [right, y], FAINT);
            let at = [left - 8.0, y + 5.0];
            canvas.write(text, LETTERS, at, Anchor::Right, DIM_TEXT);
        }
        let corners = [[left, top], [left, bottom], [right, bottom]];
        canvas.polyline(corners, (1.0, &[]), DIM);
        let at = [f64::midpoint(left, right), bottom + 44.0];
        canvas.write(self.across.title, LETTERS, at, Anchor::Middle, LIGHT);
        let at = [left - 56.0, f64::midpoint(top, bottom)];
        canvas.write_upwards(self.up.title, LETTERS, at, Anchor::Middle, LIGHT);
    }
}

/// Text colour of tick labels.
pub(super) const DIM_TEXT: Rgb<u8> = Rgb([164, 172, 184]);
