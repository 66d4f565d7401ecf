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
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let num_steps = dx.abs().max(dy.abs()).ceil().clamp(1.0, 1e5);
        for step in 0..=num_steps as usize {
            let t = step as f64 / num_steps;
            let (u, v) = (from[0] + t * dx, from[1] + t * dy);
            self.set(u.round() as i64, v.round() as i64, colour);
        }
    }

    pub(super) fn polyline(&mut self, corners: impl Iterator<Item = [f64; 2]>, colour: Rgb<u8>) {
        let mut previous = None;
        for corner in corners {
            if let Some(previous) = previous {
                self.line(previous, corner, colour);
            }
            previous = Some(corner);
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
