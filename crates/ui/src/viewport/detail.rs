//! How much is drawn while the camera moves: everything on a device that keeps up, a share of the points and pixels on one
//! that does not.
//!
//! While the view moves, every frame requests the next one at once, so the time from a picture to the next frame is the cost
//! of that picture, however long it is; a pause of the hand is not taken for a slow device. A view at rest is always drawn in
//! full.

use super::points::NUM_SAMPLES;

/// Frame time, seconds, above which motion is not fluid and less is drawn.
const REDRAW_MAX_COST_S: f32 = 1.0 / 22.0;
/// Frame time, seconds, below which more can be drawn.
const DETAIL_MAX_COST_S: f32 = 1.0 / 40.0;
/// A view that has not moved for this long, seconds, is at rest.
const REST_TIME_S: f64 = 0.2;

/// Side of a pixel of the picture, in pixels of the window: 2 while points are left out, because a picture with a quarter of
/// the pixels is cheaper on a slow device.
pub(super) fn pixel_side(num_samples: usize) -> u32 {
    if num_samples < NUM_SAMPLES { 2 } else { 1 }
}

/// When the next frame is needed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum NextRepaint {
    /// At once: the view moves, and the start of the next frame shows what this one cost.
    AtOnce,
    /// In this many seconds, when the view will be at rest unless it moves again.
    Within(f64),
    /// On the next event.
    Whenever,
}

/// Adapts the detail of one view to the speed of the device.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingDetail {
    /// Samples drawn while moving, 1..=[`NUM_SAMPLES`].
    num_samples: usize,
    /// When the view last moved, seconds of egui's clock.
    last_move: Option<f64>,
    /// When the last frame drew a picture of the moving view, if it did.
    drawn: Option<f64>,
    /// Samples drawn in the last frame.
    shown: usize,
    /// Consecutive quick frames.
    num_quick: u32,
}

impl Default for MovingDetail {
    fn default() -> Self {
        Self {
            num_samples: NUM_SAMPLES,
            last_move: None,
            drawn: None,
            shown: NUM_SAMPLES,
            num_quick: 0,
        }
    }
}

impl MovingDetail {
    /// Returns the samples to draw in a frame at `now`, and when the next frame is needed.
    pub(super) fn frame(&mut self, has_moved: bool, now: f64) -> (usize, NextRepaint) {
        if let Some(drawn) = self.drawn.take() {
            self.learn((now - drawn) as f32);
        }
        if has_moved {
            self.last_move = Some(now);
            self.drawn = Some(now);
        }
        let since = self.last_move.map_or(f64::INFINITY, |last| now - last);
        let next = if has_moved {
            NextRepaint::AtOnce
        } else if since >= REST_TIME_S || self.num_samples == NUM_SAMPLES {
            self.last_move = None;
            NextRepaint::Whenever
        } else {
            NextRepaint::Within(REST_TIME_S - since)
        };
        self.shown = match next {
            NextRepaint::Whenever => NUM_SAMPLES,
            NextRepaint::AtOnce | NextRepaint::Within(_) => self.num_samples,
        };
        (self.shown, next)
    }

    /// Share of the points drawn in the last frame, 0..1.
    pub(super) fn share(&self) -> f32 {
        self.shown as f32 / NUM_SAMPLES as f32
    }

    fn learn(&mut self, seconds: f32) {
        if seconds > REDRAW_MAX_COST_S {
            self.num_samples = (self.num_samples * 2 / 3).max(1);
            self.num_quick = 0;
        } else if seconds < DETAIL_MAX_COST_S {
            self.num_quick += 1;
            // Increase slowly, decrease fast: no flicker between two shares.
            if self.num_quick >= 20 {
                self.num_samples = (self.num_samples + 1).min(NUM_SAMPLES);
                self.num_quick = 0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_device_draws_less_while_moving_and_all_at_rest() {
        // A frame that takes longer than a pause of the hand still counts as slow.
        for seconds in [0.1, 0.265, 1.0] {
            let mut detail = MovingDetail::default();
            let mut now = 0.0;
            let mut drawn = NUM_SAMPLES;
            for _ in 0..6 {
                now += seconds;
                let next;
                (drawn, next) = detail.frame(true, now);
                assert_eq!(next, NextRepaint::AtOnce);
            }
            assert!(drawn < NUM_SAMPLES / 2, "{seconds}: {drawn}");
            let (still, next) = detail.frame(false, now + 0.05);
            assert!(still <= drawn && still < NUM_SAMPLES, "not yet at rest");
            assert!(
                matches!(next, NextRepaint::Within(seconds) if (0.1..=REST_TIME_S).contains(&seconds))
            );
            assert_eq!(
                detail.frame(false, now + 0.3),
                (NUM_SAMPLES, NextRepaint::Whenever)
            );
            assert!((detail.share() - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn a_quick_device_always_draws_everything() {
        let mut detail = MovingDetail::default();
        for i in 0..100 {
            assert_eq!(detail.frame(true, f64::from(i) / 60.0).0, NUM_SAMPLES);
        }
    }

    #[test]
    fn a_hand_that_pauses_is_no_slow_device() {
        let mut detail = MovingDetail::default();
        for i in 0..30 {
            let now = f64::from(i) * 0.15;
            assert_eq!(detail.frame(true, now).0, NUM_SAMPLES);
            // A frame requested at once comes at once.
            detail.frame(false, now + 0.016);
        }
    }
}
