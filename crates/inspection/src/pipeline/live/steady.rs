//! Detects whether everything in front of the camera is still.
//!
//! Reciprocal depth 1/z is compared over time on a grid of pixels: a structured-light sensor errs in disparity, so
//! the noise of 1/z is the same at all depths. Frames are gathered into spells of a third of the time that the scene
//! must be still. The means of two spells are compared by a t statistic per pixel, whose spread is the picture's
//! noise or the pixel's own, whichever is larger. A pixel at an edge flickers between two surfaces and so has a large
//! spread; it counts as changed only once it settles on the other surface. This detects a part that drifts sideways,
//! which changes the depth only along its outline.
//!
//! Known limit: a sideways vibration of a few millimetres, many times a second, only blurs the outline and is not
//! detected.

use std::{collections::VecDeque, time::Duration};

use geometry::{cloud::Grid, units::Metres};
use stages::{scene::SceneCloud, segment::noise_of_picture};

/// When a scene counts as still.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyParams {
    /// Time for which nothing may have moved, 0.3..5 s. Raising it detects slower motion and makes the user wait
    /// longer.
    pub settle: Duration,
    /// Standard deviations by which a pixel must differ to count as changed, 4..8. Raising it tolerates noise above
    /// that of the picture, and small motion.
    pub deviations: f64,
    /// Share of the pixels that may change from one spell to another, 0.00005..0.01. Raising it tolerates small
    /// moving things, such as a cable, and slow motion. In simulated frames of a still cell, with up to three times a
    /// Kinect's noise, the share is 0.00001; with a part that drifts by 1 cm/s it is at least 0.0009, at three times
    /// the noise 0.0002.
    pub max_changed: f64,
}

impl Default for SteadyParams {
    fn default() -> Self {
        Self {
            settle: Duration::from_millis(900),
            deviations: 5.0,
            max_changed: 0.0002,
        }
    }
}

impl SteadyParams {
    /// Least duration of a spell. Those that agree are compared by their means, so within the first, a part may still come to
    /// rest.
    pub(super) fn spell(&self) -> Duration {
        self.settle / NUM_SPELLS as u32
    }
}

/// Whether the scene moves, judging by the last frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MotionState {
    /// Unknown: too few frames since the first one, or since a gap.
    #[default]
    Watching,
    /// Something moves, or moved less than the settling time ago.
    Moving,
    /// Nothing moves.
    Steady {
        /// Time of the first of the frames that agree.
        since: Duration,
        /// Time from then to the last frame.
        lasting: Duration,
    },
}

impl MotionState {
    /// True if nothing moves.
    pub fn is_steady(self) -> bool {
        matches!(self, Self::Steady { .. })
    }
}

/// What is known of a scene after a frame, by all frames up to it that a [`MotionDetector`] saw.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneMotion {
    /// Whether it moves.
    pub state: MotionState,
    /// Number of restarts so far; frames of different runs do not show one still scene.
    pub run: u64,
}

/// Approximate number of pixels compared: a quarter of a Kinect's, a sixteenth of 1280 × 960.
const NUM_SAMPLES: usize = 76_800;
/// Spells that must agree, each with each.
const NUM_SPELLS: usize = 3;
/// Minimum number of frames in a spell, however far apart: a pixel at an edge, which flickers between two surfaces,
/// must not by chance be on one of them throughout a spell and on the other throughout the next.
const MIN_SPELL_FRAMES: usize = 5;
/// Longest gap between frames; what happens in a longer one is unknown.
const MAX_GAP: Duration = Duration::from_secs(2);
/// Share of the pixels that may be off in a single frame, which is noisier than a spell.
const MAX_OFF_SHARE: f64 = 0.006;
/// Standard deviations by which a pixel of a single frame must differ to be off.
const OFF_MIN_DEVIATIONS: f32 = 6.0;
/// Number of frames from which an incomplete spell is compared with a single frame.
const MIN_JUDGED_FRAMES: usize = 4;
/// Share of the pixels that may be restless, as those at edges are; more is shaking.
const MAX_RESTLESS_SHARE: f64 = 0.06;
/// Multiple of the noise above which a pixel is restless.
const RESTLESS_MIN_NOISE_RATIO: f32 = 3.5;
/// Smaller differences of the mean of 1/z, in 1/m, are ignored: 1 mm at 1 m.
const MIN_INVERSE_DEPTH_CHANGE: f32 = 1e-3;
/// Share of a spell's frames in which a pixel must have a reading in one spell, and none in the other, to count as
/// changed.
const CHANGED_MIN_FRAME_SHARE: f32 = 0.85;
/// Noise assumed if the picture is too empty to measure it, metres at 1 m.
const DEFAULT_NOISE_AT_1M: Metres = Metres(0.0015);

/// Follows the frames of one camera.
#[derive(Debug, Default)]
pub struct MotionDetector {
    params: SteadyParams,
    grid: Option<Grid>,
    /// Standard deviation of 1/z, per metre.
    noise: f32,
    /// First reading of every sample since the last restart, 1/m; 0 before there is one. Sums are of the differences
    /// from it, so that single precision suffices.
    pivots: Vec<f32>,
    /// The first of the spells that agree: slow creep shows against it.
    first: Option<SampleWindow>,
    /// Complete spells, the newest last.
    spells: VecDeque<SampleWindow>,
    filling: SampleWindow,
    last_at: Duration,
    stillness: MotionState,
    run: u64,
}

/// Sums over consecutive frames, for every sample.
#[derive(Clone, Debug, Default)]
struct SampleWindow {
    from: Duration,
    num_frames: usize,
    counts: Vec<u16>,
    sums: Vec<f32>,
    squares: Vec<f32>,
}

impl MotionDetector {
    /// Creates a detector that has seen no frame.
    pub fn new(params: SteadyParams) -> Self {
        Self {
            params,
            ..Self::default()
        }
    }

    /// Number of restarts so far; frames of different runs do not show one still scene.
    pub fn run(&self) -> u64 {
        self.run
    }

    /// Whether the scene moves, judging by the frames so far.
    pub fn stillness(&self) -> MotionState {
        self.stillness
    }

    /// What is known of the scene after the last frame.
    pub fn motion(&self) -> SceneMotion {
        SceneMotion {
            state: self.stillness,
            run: self.run,
        }
    }

    /// Takes in a frame and returns the new state. `at` is the camera's time. A scene without rows and columns is
    /// never steady.
    pub fn see(&mut self, scene: &SceneCloud, at: Duration) -> MotionState {
        let Some(grid) = scene.cloud.grid else {
            self.restart_consensus(MotionState::Watching, at);
            self.grid = None;
            return self.stillness;
        };
        let gap = at.checked_sub(self.last_at);
        let is_continued = self.grid == Some(grid)
            && gap.is_some_and(|gap| gap <= MAX_GAP && (!gap.is_zero() || self.is_empty()));
        if self.grid != Some(grid) || !is_continued {
            self.grid = Some(grid);
            self.restart_consensus(MotionState::Watching, at);
        }
        self.last_at = at;
        if self.is_empty() {
            let noise = noise_of_picture(scene).unwrap_or(DEFAULT_NOISE_AT_1M);
            self.noise = noise.0 as f32;
        }
        let samples = samples(scene, grid);
        let last = self.spells.back();
        let last = last.or((self.filling.num_frames >= MIN_JUDGED_FRAMES).then_some(&self.filling));
        if last.is_some_and(|spell| self.off_share(spell, &samples) > MAX_OFF_SHARE) {
            self.restart_consensus(MotionState::Moving, at);
        }
        self.gather(&samples, at);
        if self.is_full(at) {
            self.close_spell(at);
        }
        if let MotionState::Steady { since, lasting } = &mut self.stillness {
            *lasting = at.saturating_sub(*since);
        }
        self.stillness
    }

    /// Forgets every frame: those that follow are of another run.
    pub fn restart(&mut self) {
        self.grid = None;
        self.restart_consensus(MotionState::Watching, self.last_at);
    }

    fn is_empty(&self) -> bool {
        self.spells.is_empty() && self.filling.num_frames == 0
    }

    fn restart_consensus(&mut self, stillness: MotionState, at: Duration) {
        self.stillness = stillness;
        self.run += 1;
        self.spells.clear();
        self.first = None;
        self.filling = SampleWindow::default();
        self.pivots.clear();
        self.last_at = at;
    }

    fn gather(&mut self, samples: &[f32], at: Duration) {
        if self.pivots.len() != samples.len() {
            self.pivots = vec![0.0; samples.len()];
        }
        let Self {
            filling, pivots, ..
        } = self;
        if filling.num_frames == 0 {
            *filling = SampleWindow::new(samples.len(), at);
        }
        filling.num_frames += 1;
        let sums = filling.sums.iter_mut().zip(&mut filling.squares);
        let kept = filling.counts.iter_mut().zip(sums).zip(pivots);
        for (&sample, ((count, (sum, square)), pivot)) in samples.iter().zip(kept) {
            if sample > 0.0 {
                if *pivot == 0.0 {
                    *pivot = sample;
                }
                let off = sample - *pivot;
                *count += 1;
                *sum += off;
                *square += off * off;
            }
        }
    }

    fn is_full(&self, at: Duration) -> bool {
        let lasting = at.saturating_sub(self.filling.from);
        let is_long = lasting >= self.params.spell();
        is_long && self.filling.num_frames >= MIN_SPELL_FRAMES
    }

    /// Compares the full spell with the ones before.
    fn close_spell(&mut self, at: Duration) {
        let spell = std::mem::take(&mut self.filling);
        let earlier = self.spells.iter().chain(&self.first);
        let differs = earlier
            .into_iter()
            .any(|earlier| self.changed_share(earlier, &spell) > self.params.max_changed);
        if differs || self.moving_share(&spell) > MAX_RESTLESS_SHARE {
            // The motion lies before the newest spell or in it; if before, the spell may be the first of a long rest.
            let pivots = std::mem::take(&mut self.pivots);
            self.restart_consensus(MotionState::Moving, at);
            if self.moving_share(&spell) <= MAX_RESTLESS_SHARE {
                self.pivots = pivots;
                self.spells.push_back(spell);
            }
            return;
        }
        self.spells.push_back(spell);
        if self.spells.len() >= NUM_SPELLS && !self.stillness.is_steady() {
            self.first = self.spells.pop_front();
            let since = self.first.as_ref().map_or(at, |first| first.from);
            let lasting = Duration::ZERO;
            self.stillness = MotionState::Steady { since, lasting };
        }
        if self.spells.len() > NUM_SPELLS {
            self.spells.pop_front();
        }
    }

    /// Share of the samples that changed between two spells.
    fn changed_share(&self, a: &SampleWindow, b: &SampleWindow) -> f64 {
        let limit = (self.params.deviations * self.params.deviations) as f32;
        let noise_sq = self.noise * self.noise;
        let (mut num_changed, mut num_read) = (0_u32, 0_u32);
        for i in 0..a.counts.len().min(b.counts.len()) {
            let (num_a, num_b) = (f32::from(a.counts[i]), f32::from(b.counts[i]));
            let (share_a, share_b) = (num_a / a.num_frames as f32, num_b / b.num_frames as f32);
            if share_a < 0.5 && share_b < 0.5 {
                continue;
            }
            num_read += 1;
            let comes_or_goes = share_a.max(share_b) >= CHANGED_MIN_FRAME_SHARE
                && share_a.min(share_b) <= 1.0 - CHANGED_MIN_FRAME_SHARE;
            let is_changed = if share_a.min(share_b) < 0.5 {
                comes_or_goes
            } else {
                let (mean_a, mean_b) = (a.sums[i] / num_a, b.sums[i] / num_b);
                let scatter =
                    a.squares[i] - num_a * mean_a * mean_a + b.squares[i] - num_b * mean_b * mean_b;
                let own = scatter / (num_a + num_b - 2.0).max(1.0);
                let variance = own.max(noise_sq) * (1.0 / num_a + 1.0 / num_b);
                let difference = mean_a - mean_b;
                difference * difference > limit * variance
                    && difference.abs() > MIN_INVERSE_DEPTH_CHANGE
            };
            num_changed += u32::from(is_changed);
        }
        f64::from(num_changed) / f64::from(num_read.max(1))
    }

    /// Share of the samples that scatter more than the noise.
    fn moving_share(&self, spell: &SampleWindow) -> f64 {
        let limit = (RESTLESS_MIN_NOISE_RATIO * self.noise).powi(2);
        let (mut num_restless, mut num_read) = (0_u32, 0_u32);
        let sums = spell.sums.iter().zip(&spell.squares);
        for (count, (sum, square)) in spell.counts.iter().zip(sums) {
            if *count >= 2 {
                let num = f32::from(*count);
                num_read += 1;
                num_restless += u32::from((square - sum * sum / num) / (num - 1.0) > limit);
            }
        }
        f64::from(num_restless) / f64::from(num_read.max(1))
    }

    /// Share of the samples of one frame that differ from a spell.
    fn off_share(&self, spell: &SampleWindow, samples: &[f32]) -> f64 {
        let noise_sq = self.noise * self.noise;
        let (mut num_off, mut num_read) = (0_u32, 0_u32);
        for (i, &sample) in samples.iter().enumerate().take(spell.counts.len()) {
            let num = f32::from(spell.counts[i]);
            if sample <= 0.0 || num < 2.0 {
                continue;
            }
            num_read += 1;
            let mean = spell.sums[i] / num;
            let own = (spell.squares[i] - num * mean * mean) / (num - 1.0);
            let off = sample - self.pivots[i] - mean;
            num_off += u32::from(off * off > OFF_MIN_DEVIATIONS.powi(2) * own.max(noise_sq));
        }
        f64::from(num_off) / f64::from(num_read.max(1))
    }
}

impl SampleWindow {
    fn new(num_samples: usize, from: Duration) -> Self {
        Self {
            from,
            num_frames: 0,
            counts: vec![0; num_samples],
            sums: vec![0.0; num_samples],
            squares: vec![0.0; num_samples],
        }
    }
}

/// 1/z of every n-th pixel of every n-th row, 1/m; 0 without a reading.
fn samples(scene: &SceneCloud, grid: Grid) -> Vec<f32> {
    let step = ((grid.num_cells() as f64 / NUM_SAMPLES as f64)
        .sqrt()
        .round() as usize)
        .max(1);
    let rows = scene.cloud.points.chunks_exact(grid.width).step_by(step);
    rows.flat_map(|row| row.iter().step_by(step))
        .map(|p| if p.z > 0.0 { 1.0 / p.z } else { 0.0 })
        .collect()
}

#[cfg(test)]
mod tests;
