//! Whether everything before the camera hangs still.
//!
//! Reciprocal depth 1/z is compared over time on a grid of pixels: a structured-light sensor's error is one of the
//! disparity, so the noise of 1/z is the same at all depths. Frames are gathered into spells of a third of the time
//! that the scene has to stand still; the means of two spells are held against each other with a t statistic per
//! pixel, whose spread is the picture's noise or the pixel's own, whichever is larger. A pixel at an edge flickers
//! between two surfaces and has a large spread of its own, so that it only counts as changed once it settles on the
//! other surface. That is how a part is seen to drift sideways, which changes the depth nowhere but along its outline.
//!
//! Known limit: what shakes sideways within a few millimetres, many times a second, only blurs the outline.

use std::{collections::VecDeque, time::Duration};

use crate::{
    geometry::cloud::Grid,
    stages::{scene::SceneCloud, segment::noise_of_picture},
    units::Metres,
};

/// When the scene stands still.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyParams {
    /// How long nothing may have moved, 0.3..5 s. Raising it finds slower motion and makes a person wait longer.
    pub settle: Duration,
    /// Standard deviations by which a pixel has to be off to be changed, 4..8. Raising it forgives noise that is not
    /// what the picture's is, and small motion.
    pub deviations: f64,
    /// Share of the pixels that may be changed from one spell to another, 0.00005..0.01. Raising it forgives small
    /// things that move, such as a cable, and slow motion. In simulated frames of a still cell, up to three times a
    /// Kinect's noise, it is 0.00001; of a part that drifts by 1 cm/s from 0.0009, at three times the noise 0.0002.
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

/// What the last frames say of the scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MotionState {
    /// Too few frames since the first one, or since a gap, to say.
    #[default]
    Watching,
    /// Something moves, or moved less than the settling time ago.
    Moving,
    /// Nothing moves.
    Steady {
        /// Time of the first frame of all that agree.
        since: Duration,
        /// From then to the last frame.
        lasting: Duration,
    },
}

impl MotionState {
    /// True if nothing moves.
    pub fn is_steady(self) -> bool {
        matches!(self, Self::Steady { .. })
    }
}

/// Pixels compared, about: a sixteenth of a camera of today, a quarter of a Kinect's.
const NUM_SAMPLES: usize = 76_800;
/// Spells that must agree, all with all.
const NUM_SPELLS: usize = 3;
/// Frames in a spell at least, however far apart they are: a pixel at an edge that flickers between two surfaces must
/// not be on one of them throughout a spell and on the other throughout the next, by chance.
const LEAST_FRAMES: usize = 5;
/// Frames further apart than this are no motion picture: what happened between them nobody knows.
const MAX_GAP: Duration = Duration::from_secs(2);
/// Share of the pixels that may be off in a single frame: one frame is noisier than a spell.
const MAX_OFF_AT_ONCE: f64 = 0.006;
/// Standard deviations by which a pixel has to be off in a single frame.
const DEVIATIONS_AT_ONCE: f32 = 6.0;
/// Frames of a spell that is not complete, from which on a single frame is held against it.
const FRAMES_TO_JUDGE: usize = 4;
/// Share of the pixels that may scatter by more than their noise, edges among them: more is shaking.
const MAX_RESTLESS: f64 = 0.06;
/// A pixel is restless from this many times the noise on.
const RESTLESS: f32 = 3.5;
/// Differences of the mean of 1/z below this, per metre, are nothing: 1 mm at 1 m.
const LEAST_DIFFERENCE: f32 = 1e-3;
/// Share of a spell's frames in which a reading has to be, or to be missing, to be held against another spell.
const CERTAIN: f32 = 0.85;
/// Noise that is assumed where the picture is too empty to tell it, metres at 1 m.
const USUAL_NOISE: Metres = Metres(0.0015);

/// Follows the frames of one camera.
#[derive(Debug)]
pub struct MotionDetector {
    params: SteadyParams,
    grid: Option<Grid>,
    /// Standard deviation of 1/z, per metre.
    noise: f32,
    /// First reading of every sample since the last start, 1/m: sums are taken of what differs from it, so that
    /// single precision holds them. 0 before there is one.
    pivots: Vec<f32>,
    /// The first spell of all that agree: slow creeping shows against it.
    first: Option<SampleWindow>,
    /// Complete, the newest last.
    spells: VecDeque<SampleWindow>,
    filling: SampleWindow,
    last_at: Duration,
    stillness: MotionState,
    run: u64,
}

/// Sums over some frames in a row, one of each for every sample.
#[derive(Clone, Debug, Default)]
struct SampleWindow {
    from: Duration,
    num_frames: usize,
    counts: Vec<u16>,
    sums: Vec<f32>,
    squares: Vec<f32>,
}

impl MotionDetector {
    /// Before the first frame.
    pub fn new(params: SteadyParams) -> Self {
        Self {
            params,
            grid: None,
            noise: 0.0,
            pivots: Vec::new(),
            first: None,
            spells: VecDeque::new(),
            filling: SampleWindow::default(),
            last_at: Duration::ZERO,
            stillness: MotionState::Watching,
            run: 0,
        }
    }

    /// Counts how often the watch had to start anew: frames of different runs are not of one still scene.
    pub fn run(&self) -> u64 {
        self.run
    }

    /// What the frames so far say.
    pub fn stillness(&self) -> MotionState {
        self.stillness
    }

    /// Takes in a frame. `at` is its camera's time; a scene without rows and columns is never steady.
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
            let noise = noise_of_picture(scene).unwrap_or(USUAL_NOISE);
            self.noise = noise.0 as f32;
        }
        let samples = samples(scene, grid);
        let last = self.spells.back();
        let last = last.or((self.filling.num_frames >= FRAMES_TO_JUDGE).then_some(&self.filling));
        if last.is_some_and(|spell| self.moved_in_one_frame(spell, &samples)) {
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
            *filling = SampleWindow::of(samples.len(), at);
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
        let is_long = lasting >= self.params.settle / NUM_SPELLS as u32;
        is_long && self.filling.num_frames >= LEAST_FRAMES
    }

    /// Holds the spell that is full against the ones before.
    fn close_spell(&mut self, at: Duration) {
        let spell = std::mem::take(&mut self.filling);
        let earlier = self.spells.iter().chain(&self.first);
        let differs = earlier
            .into_iter()
            .any(|earlier| self.changed_share(earlier, &spell) > self.params.max_changed);
        if differs || self.moving_share(&spell) > MAX_RESTLESS {
            // The newest spell may be the first of a long rest; the motion lies before it, or in it.
            let pivots = std::mem::take(&mut self.pivots);
            self.restart_consensus(MotionState::Moving, at);
            if self.moving_share(&spell) <= MAX_RESTLESS {
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

    /// Share of the samples that went from one value to another between two spells.
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
            let comes_or_goes =
                share_a.max(share_b) >= CERTAIN && share_a.min(share_b) <= 1.0 - CERTAIN;
            let is_changed = if share_a.min(share_b) < 0.5 {
                comes_or_goes
            } else {
                let (mean_a, mean_b) = (a.sums[i] / num_a, b.sums[i] / num_b);
                let scatter =
                    a.squares[i] - num_a * mean_a * mean_a + b.squares[i] - num_b * mean_b * mean_b;
                let own = scatter / (num_a + num_b - 2.0).max(1.0);
                let variance = own.max(noise_sq) * (1.0 / num_a + 1.0 / num_b);
                let difference = mean_a - mean_b;
                difference * difference > limit * variance && difference.abs() > LEAST_DIFFERENCE
            };
            num_changed += u32::from(is_changed);
        }
        f64::from(num_changed) / f64::from(num_read.max(1))
    }

    /// Share of the samples that scatter more than noise does.
    fn moving_share(&self, spell: &SampleWindow) -> f64 {
        let limit = (RESTLESS * self.noise).powi(2);
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

    /// True if so much of one frame is off the last spell that something moved: no need to wait for the next.
    fn moved_in_one_frame(&self, spell: &SampleWindow, samples: &[f32]) -> bool {
        self.off_share(spell, samples) > MAX_OFF_AT_ONCE
    }

    /// Share of the samples that are off a spell in one frame.
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
            num_off += u32::from(off * off > DEVIATIONS_AT_ONCE.powi(2) * own.max(noise_sq));
        }
        f64::from(num_off) / f64::from(num_read.max(1))
    }
}

impl SampleWindow {
    fn of(num_samples: usize, from: Duration) -> Self {
        Self {
            from,
            num_frames: 0,
            counts: vec![0; num_samples],
            sums: vec![0.0; num_samples],
            squares: vec![0.0; num_samples],
        }
    }
}

/// 1/z of every so many pixels both ways, 1/m; 0 without a reading.
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
