//! How much of a cloud is drawn while the eye moves: all of it on a device that keeps up, a share on one that does not.
//!
//! The time between two frames of a moving view tells whether the device keeps up. The picture of a view at rest is
//! always drawn in full.

use super::points::NUM_SAMPLES;

/// Frames further apart than this, seconds, are not fluent any more: less is drawn.
const SLOW: f32 = 1.0 / 22.0;
/// Frames closer than this leave room for more.
const QUICK: f32 = 1.0 / 40.0;
/// A view that has not moved for this long, seconds, is at rest.
const REST: f64 = 0.2;

/// Watches one view.
#[derive(Clone, Copy, Debug)]
pub(super) struct MovingDetail {
    /// Samples drawn while moving, 1..=[`NUM_SAMPLES`].
    num_samples: usize,
    /// When the view last moved, seconds of egui's clock.
    last_move: Option<f64>,
    /// Quick frames in a row.
    num_quick: u32,
}

impl Default for MovingDetail {
    fn default() -> Self {
        Self {
            num_samples: NUM_SAMPLES,
            last_move: None,
            num_quick: 0,
        }
    }
}

impl MovingDetail {
    /// The samples to draw in a frame at `now`, and for how long, seconds, the view stays in motion if nothing more
    /// happens: `None` if it is at rest.
    pub(super) fn frame(&mut self, has_moved: bool, now: f64) -> (usize, Option<f64>) {
        if has_moved {
            if let Some(last) = self.last_move {
                self.learn((now - last) as f32);
            }
            self.last_move = Some(now);
        }
        let since = self.last_move.map_or(f64::INFINITY, |last| now - last);
        if since >= REST {
            self.last_move = None;
            return (NUM_SAMPLES, None);
        }
        if self.num_samples == NUM_SAMPLES {
            return (NUM_SAMPLES, None);
        }
        (self.num_samples, Some(REST - since))
    }

    fn learn(&mut self, seconds: f32) {
        // A pause in the hand's motion is not a slow device.
        if f64::from(seconds) >= REST {
            return;
        }
        if seconds > SLOW {
            self.num_samples = (self.num_samples * 2 / 3).max(1);
            self.num_quick = 0;
        } else if seconds < QUICK {
            self.num_quick += 1;
            // Slowly up, quickly down: no flicker between two shares.
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
        let mut detail = MovingDetail::default();
        let mut now = 0.0;
        let mut drawn = NUM_SAMPLES;
        for _ in 0..6 {
            now += 0.1;
            drawn = detail.frame(true, now).0;
        }
        assert!(drawn < NUM_SAMPLES / 2, "{drawn}");
        let (still, rest_in) = detail.frame(false, now + 0.05);
        assert_eq!(still, drawn, "not yet at rest");
        assert!(rest_in.is_some());
        assert_eq!(detail.frame(false, now + 0.3), (NUM_SAMPLES, None));
    }

    #[test]
    fn a_quick_device_always_draws_everything() {
        let mut detail = MovingDetail::default();
        for i in 0..100 {
            assert_eq!(detail.frame(true, f64::from(i) / 60.0), (NUM_SAMPLES, None));
        }
    }
}
