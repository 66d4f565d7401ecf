//! Drawing on a picture: lines, polylines and curves.

use image::{Rgb, RgbImage};

/// A picture that can be drawn on beyond its edges; what lies outside is left out.
pub(super) struct Canvas {
    pub(super) image: RgbImage,
}

impl Canvas {
    pub(super) fn new(width: usize, height: usize, background: Rgb<u8>) -> Self {
        Self {
            image: RgbImage::from_pixel(width as u32, height as u32, background),
        }
    }

    pub(super) fn dot(&mut self, at: [f64; 2], radius: f64, colour: Rgb<u8>) {
        let reach = radius.ceil() as i64;
        let (u, v) = (at[0].round() as i64, at[1].round() as i64);
        for dv in -reach..=reach {
            for du in -reach..=reach {
                if (du * du + dv * dv) as f64 <= radius * radius {
                    self.set(u + du, v + dv, colour);
                }
            }
        }
    }

    /// A line from pixel to pixel, ends included.
    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2], colour: Rgb<u8>) {
        self.dashes([from, to].into_iter(), &[], colour);
    }

    pub(super) fn polyline(&mut self, corners: impl Iterator<Item = [f64; 2]>, colour: Rgb<u8>) {
        self.dashes(corners, &[], colour);
    }

    /// A polyline in dashes: drawn and left out by turns over so many pixels each; an empty pattern leaves nothing out.
    pub(super) fn dashes(
        &mut self,
        corners: impl Iterator<Item = [f64; 2]>,
        pattern: &[f64],
        colour: Rgb<u8>,
    ) {
        let mut walked = 0.0;
        let mut previous: Option<[f64; 2]> = None;
        for corner in corners {
            let Some(from) = previous.replace(corner) else {
                continue;
            };
            let (dx, dy) = (corner[0] - from[0], corner[1] - from[1]);
            let num_steps = dx.abs().max(dy.abs()).ceil().clamp(1.0, 1e5);
            for step in 0..=num_steps as usize {
                let t = step as f64 / num_steps;
                if is_drawn(pattern, walked + t * dx.hypot(dy)) {
                    let (u, v) = (from[0] + t * dx, from[1] + t * dy);
                    self.set(u.round() as i64, v.round() as i64, colour);
                }
            }
            walked += dx.hypot(dy);
        }
    }

    /// A filled rectangle, from corner to corner.
    pub(super) fn block(&mut self, from: [f64; 2], to: [f64; 2], colour: Rgb<u8>) {
        let pixel = |x: f64| x.round() as i64;
        for v in pixel(from[1])..pixel(to[1]) {
            for u in pixel(from[0])..pixel(to[0]) {
                self.set(u, v, colour);
            }
        }
    }

    fn set(&mut self, u: i64, v: i64, colour: Rgb<u8>) {
        if let (Ok(u), Ok(v)) = (u32::try_from(u), u32::try_from(v))
            && u < self.image.width()
            && v < self.image.height()
        {
            self.image.put_pixel(u, v, colour);
        }
    }
}

/// True if a line of this pattern is drawn so many pixels from its beginning.
fn is_drawn(pattern: &[f64], at: f64) -> bool {
    let whole: f64 = pattern.iter().sum();
    if whole <= 0.0 {
        return true;
    }
    let mut rest = at.rem_euclid(whole);
    let piece = pattern.iter().position(|length| {
        rest -= length;
        rest < 0.0
    });
    piece.is_none_or(|piece| piece % 2 == 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dashes_go_round_corners_and_leave_out_their_share() {
        let (dark, light) = (Rgb([0; 3]), Rgb([255; 3]));
        let corners = [[10.0, 10.0], [110.0, 10.0], [110.0, 70.0]];
        let num = |pattern: &[f64]| {
            let mut canvas = Canvas::new(160, 90, dark);
            canvas.dashes(corners.into_iter(), pattern, light);
            canvas.image.pixels().filter(|p| **p == light).count()
        };
        assert_eq!(num(&[]), 161);
        assert!(
            (75..=87).contains(&num(&[8.0, 8.0])),
            "{}",
            num(&[8.0, 8.0])
        );
        assert!(num(&[2.0, 6.0]) < 50);
    }
}
