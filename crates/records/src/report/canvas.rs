//! A drawing canvas for lines, dots, rectangles and text, rendered by `vello_cpu`.

use image::{Rgb, RgbImage};
use vello_cpu::{
    Pixmap, RenderContext, Resources,
    color::{AlphaColor, Srgb},
    kurbo::{Affine, BezPath, Circle, Point, Rect, Shape as _, Stroke},
};

use super::lettering::{Anchor, Lettering, REGULAR};

/// A picture to draw on; anything outside its edges is clipped.
pub(super) struct Canvas {
    context: RenderContext,
    letters: Lettering,
}

impl Canvas {
    pub(super) fn new(width: usize, height: usize, background: Rgb<u8>) -> Self {
        let [columns, rows] = [width, height].map(|side| side.clamp(1, usize::from(u16::MAX)));
        let mut canvas = Self {
            context: RenderContext::new(columns as u16, rows as u16),
            letters: Lettering::of(REGULAR),
        };
        canvas.block([0.0, 0.0], [columns as f64, rows as f64], background);
        canvas
    }

    /// Renders the picture.
    pub(super) fn finish(mut self) -> RgbImage {
        let (width, height) = (self.context.width(), self.context.height());
        let mut drawn = Pixmap::new(width, height);
        self.context.flush();
        self.context.render(&mut drawn, &mut Resources::new());
        let pixels = drawn.data_as_u8_slice().chunks_exact(4);
        let colours = pixels.flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]);
        RgbImage::from_raw(width.into(), height.into(), colours.collect())
            .expect("as many colours as pixels")
    }

    fn paint(&mut self, Rgb([red, green, blue]): Rgb<u8>) {
        self.context
            .set_paint(AlphaColor::<Srgb>::from_rgb8(red, green, blue));
    }

    pub(super) fn dot(&mut self, at: [f64; 2], radius: f64, colour: Rgb<u8>) {
        self.paint(colour);
        let dot = Circle::new(middle_of(at), radius);
        self.context.fill_path(&dot.to_path(0.1));
    }

    /// Draws a thin line between two pixels.
    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2], colour: Rgb<u8>) {
        let ends = [from, to].map(|end| end.map(f64::round));
        self.polyline(ends, (1.0, &[]), colour);
    }

    /// Draws a line of this width through pixels. A non-empty pattern gives the lengths of dashes and gaps in pixels.
    pub(super) fn polyline(
        &mut self,
        corners: impl IntoIterator<Item = [f64; 2]>,
        (width, pattern): (f64, &[f64]),
        colour: Rgb<u8>,
    ) {
        let mut path = BezPath::new();
        let drawable = |corner: &[f64; 2]| corner.iter().all(|x| x.is_finite());
        for corner in corners.into_iter().filter(drawable) {
            if path.elements().is_empty() {
                path.move_to(middle_of(corner));
            } else {
                path.line_to(middle_of(corner));
            }
        }
        self.paint(colour);
        let stroke = Stroke::new(width).with_dashes(0.0, pattern.iter().copied());
        self.context.set_stroke(stroke);
        self.context.stroke_path(&path);
    }

    /// Fills a rectangle between two corners.
    pub(super) fn block(&mut self, from: [f64; 2], to: [f64; 2], colour: Rgb<u8>) {
        self.paint(colour);
        let [from, to] = [from, to].map(|[x, y]| Point::new(x.round(), y.round()));
        self.context.fill_rect(&Rect::from_points(from, to));
    }

    /// Writes a text of this size; `at` is on its baseline.
    pub(super) fn write(
        &mut self,
        text: &str,
        size: f32,
        at: [f64; 2],
        anchor: Anchor,
        colour: Rgb<u8>,
    ) {
        self.letters((text, size), 0.0, at, anchor, colour);
    }

    /// Writes a text from bottom to top; `at` is on its baseline.
    pub(super) fn write_upwards(
        &mut self,
        text: &str,
        size: f32,
        at: [f64; 2],
        anchor: Anchor,
        colour: Rgb<u8>,
    ) {
        let upwards = -std::f64::consts::FRAC_PI_2;
        self.letters((text, size), upwards, at, anchor, colour);
    }

    fn letters(
        &mut self,
        (text, size): (&str, f32),
        turned: f64,
        at: [f64; 2],
        anchor: Anchor,
        colour: Rgb<u8>,
    ) {
        self.paint(colour);
        let start = anchor.offset(self.letters.width(text, size)).round();
        let start = Affine::translate((f64::from(start), 0.0));
        let place = Affine::translate((at[0].round(), at[1].round())) * Affine::rotate(turned);
        let outline = self.letters.outline(text, size);
        self.context.fill_path(&(place * start * outline));
    }
}

/// Returns the centre of a pixel.
fn middle_of([x, y]: [f64; 2]) -> Point {
    Point::new(x + 0.5, y + 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: Rgb<u8> = Rgb([255; 3]);

    fn drawn([width, height]: [usize; 2], draw: impl FnOnce(&mut Canvas)) -> RgbImage {
        let mut canvas = Canvas::new(width, height, Rgb([0; 3]));
        draw(&mut canvas);
        canvas.finish()
    }

    fn ink(image: &RgbImage) -> f64 {
        image.pixels().map(|p| f64::from(p[0]) / 255.0).sum()
    }

    fn written(text: &str) -> RgbImage {
        drawn([120, 30], |canvas| {
            canvas.write(text, 16.0, [10.0, 20.0], Anchor::Left, WHITE);
        })
    }

    #[test]
    fn dashes_go_round_corners_and_leave_out_their_share() {
        let corners = [[10.0, 10.0], [110.0, 10.0], [110.0, 70.0]];
        let ink = |pattern: &[f64]| {
            ink(&drawn([160, 90], |canvas| {
                canvas.polyline(corners, (1.0, pattern), WHITE);
            }))
        };
        assert!((ink(&[]) - 160.0).abs() < 2.0, "{}", ink(&[]));
        let half = ink(&[8.0, 8.0]);
        assert!((75.0..=87.0).contains(&half), "{half}");
        assert!(ink(&[2.0, 6.0]) < 50.0);
    }

    #[test]
    fn a_full_stop_covers_as_much_as_its_square_and_a_letter_is_no_blot() {
        // An em dash is a bar, so its ink is its area at any position.
        let dash = ink(&written("—"));
        assert!((10.0..40.0).contains(&dash), "{dash}");
        let letters = written("Fender 8");
        assert!((60.0..260.0).contains(&ink(&letters)), "{}", ink(&letters));
        // Nothing leaks out of a glyph to the right, as it would with an unclosed outline.
        assert!(
            letters
                .rows()
                .all(|mut row| row.nth(110).expect("wide")[0] == 0)
        );
        assert!(ink(&written("")) < 0.5);
    }

    #[test]
    fn what_is_beyond_the_picture_or_nowhere_is_left_out() {
        let image = drawn([20, 20], |canvas| {
            for at in [[-500.0, 10.0], [10.0, -90.0], [1e6, 1e6]] {
                canvas.write("door", 14.0, at, Anchor::Middle, WHITE);
                canvas.write_upwards("door", 14.0, at, Anchor::Right, WHITE);
                canvas.dot(at, 2.0, WHITE);
            }
            canvas.polyline([[-1e5, -5.0], [1e5, -5.0]], (2.0, &[4.0, 4.0]), WHITE);
            canvas.polyline([[f64::NAN, 3.0], [4.0, f64::INFINITY]], (1.0, &[]), WHITE);
        });
        assert!(ink(&image) < 0.5);
    }

    #[test]
    fn a_text_upwards_has_the_ink_of_the_same_text_across() {
        let image = drawn([30, 120], |canvas| {
            canvas.write_upwards("Fender", 16.0, [20.0, 110.0], Anchor::Left, WHITE);
        });
        let across = ink(&written("Fender"));
        assert!((ink(&image) - across).abs() < 0.02 * across);
    }
}
