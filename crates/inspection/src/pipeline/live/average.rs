//! Depth averaged over the last frames, pixel by pixel: it reduces noise and creates no points between two surfaces.
//!
//! The readings of a pixel are averaged as 1/z, in which a structured-light sensor's noise is the same at all depths.
//! The median of the valid ones selects the surface; the mean is over those that lie on it. If no more than half do,
//! the pixel flickers between surfaces and gets no reading rather than one in mid-air.

use std::{collections::VecDeque, sync::Arc, time::Duration};

use geometry::{
    parallel::{map_in_order, num_cores},
    rays::Rays,
};
use stages::{scene::SceneCloud, segment::noise_of_picture};

/// Maximum number of frames averaged.
pub const MAX_AVERAGED: usize = 16;
/// Standard deviations of the noise within which readings belong to one surface.
const SAME_SURFACE_MAX_DEVIATIONS: f32 = 5.0;
/// Noise assumed if the picture is too empty to measure it, metres at 1 m.
const DEFAULT_NOISE_AT_1M: f32 = 0.0015;
/// A pixel with readings in a smaller share of the frames is a flying pixel.
const MIN_FRAME_SHARE: f32 = 0.25;

/// The last frames of one camera while its scene is still.
#[derive(Debug, Default)]
pub struct DepthAverage {
    num_frames: usize,
    /// With their times.
    frames: VecDeque<(Duration, Arc<SceneCloud>)>,
}

impl DepthAverage {
    /// Averages over up to `num_frames` frames, 1..=[`MAX_AVERAGED`]; 1 turns averaging off.
    pub fn over(num_frames: usize) -> Self {
        Self {
            num_frames: num_frames.clamp(1, MAX_AVERAGED),
            frames: VecDeque::new(),
        }
    }

    /// Forgets every frame, because the scene has moved.
    pub fn clear(&mut self) {
        self.frames.clear();
    }

    /// Forgets the frames from before this time, because the scene was not still then.
    pub fn forget_before(&mut self, since: Duration) {
        self.frames.retain(|(at, _)| *at >= since);
    }

    /// Frames that the next mean is taken over.
    pub fn num_frames(&self) -> usize {
        self.frames.len()
    }

    /// Adds the frame taken at `at`; if its camera or its size differs, the earlier frames are forgotten.
    pub fn add(&mut self, scene: &Arc<SceneCloud>, at: Duration) {
        let is_same = |(_, known): &(Duration, Arc<SceneCloud>)| {
            known.cloud.grid == scene.cloud.grid && known.intrinsics == scene.intrinsics
        };
        if !self.frames.back().is_some_and(is_same) {
            self.frames.clear();
        }
        self.frames.push_back((at, Arc::clone(scene)));
        while self.frames.len() > self.num_frames.max(1) {
            self.frames.pop_front();
        }
    }

    /// The last scene with every depth averaged; `None` before the first frame. A scene without a pinhole camera, or
    /// a single one, is returned unchanged.
    pub fn mean(&self) -> Option<Arc<SceneCloud>> {
        let (_, last) = self.frames.back()?;
        let (Some(grid), Some(camera), true) =
            (last.cloud.grid, last.intrinsics, self.frames.len() > 1)
        else {
            return Some(Arc::clone(last));
        };
        let noise = noise_of_picture(last).map_or(DEFAULT_NOISE_AT_1M, |noise| noise.0 as f32);
        let gate = SAME_SURFACE_MAX_DEVIATIONS * noise;
        let rays = Rays::of(&camera);
        let rows = map_in_order(
            grid.height,
            num_cores(),
            || Vec::with_capacity(self.frames.len()),
            |readings: &mut Vec<f32>, v| {
                let pixels = v * grid.width..(v + 1) * grid.width;
                let depth = |pixel: usize| {
                    readings.clear();
                    let depths = self
                        .frames
                        .iter()
                        .map(|(_, scene)| scene.cloud.points[pixel].z);
                    readings.extend(depths.filter(|z| *z > 0.0).map(f32::recip));
                    settled(readings, self.frames.len(), gate).map_or(f32::NAN, f32::recip)
                };
                let mut points = Vec::with_capacity(grid.width);
                rays.append_row(v, pixels.map(depth), &mut points);
                points
            },
        );
        let mut scene = SceneCloud {
            empty_cell: last.empty_cell.clone(),
            known_view: last.known_view.clone(),
            intrinsics: last.intrinsics,
            edge: last.edge,
            ..SceneCloud::default()
        };
        scene.cloud.grid = Some(grid);
        scene.cloud.points = rows.into_iter().flatten().collect();
        Some(Arc::new(scene))
    }
}

/// The mean of the readings on the surface of the median; `None` if they are too few.
fn settled(readings: &mut [f32], num_frames: usize, gate: f32) -> Option<f32> {
    let num = readings.len();
    if num == 0 || (num as f32) < MIN_FRAME_SHARE * num_frames as f32 {
        return None;
    }
    readings.sort_unstable_by(f32::total_cmp);
    // Of an even number the upper middle value, which is on the nearer surface: a reading, not a value between two.
    let median = readings[num / 2];
    let on_surface = readings.iter().filter(|x| (**x - median).abs() <= gate);
    let (sum, count) = on_surface.fold((0.0, 0_usize), |(sum, n), x| (sum + x, n + 1));
    (2 * count > num || num == 1).then(|| sum / count as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_of_two_surfaces_are_never_blended() {
        let (near, far, gate) = (1.0, 0.5, 0.0075);
        // The majority's surface, else none.
        let mean = settled(&mut [near, near + 0.002, far, near], 4, gate).expect("near");
        assert!((mean - (near + 0.002 / 3.0)).abs() < 1e-6);
        assert_eq!(settled(&mut [near, far, far, far], 4, gate), Some(far));
        assert_eq!(settled(&mut [near, near, far, far], 4, gate), None);
        // A stray reading where the others have none.
        assert_eq!(settled(&mut [near], 8, gate), None);
        assert_eq!(settled(&mut [near, near], 8, gate), Some(near));
        assert_eq!(settled(&mut [], 8, gate), None);
    }
}
