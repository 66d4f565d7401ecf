//! Which iteration of a comparison is shown, and playback.

use std::sync::Arc;

use super::{
    pair::Pair,
    state::AlignState,
    track::{MethodRun, Track},
};
use ui::scrubber::Playback;

/// A pair and the results of the methods on it.
#[derive(Debug)]
pub struct MethodComparison {
    /// The pair of clouds.
    pub pair: Arc<Pair>,
    /// One per method that has run, in the order of the methods.
    pub runs: Vec<Arc<MethodRun>>,
}

impl MethodComparison {
    /// Last iteration of the longest track.
    pub fn last_iteration(&self) -> usize {
        let tracks = self.tracks().map(|(_, track)| track.poses.len());
        tracks.max().unwrap_or(1).saturating_sub(1)
    }

    /// The tracks of the methods that found a pose.
    pub fn tracks(&self) -> impl Iterator<Item = (&MethodRun, &Track)> {
        let runs = self.runs.iter();
        runs.filter_map(|run| Some((&**run, run.track.as_ref().ok()?)))
    }
}

/// Duration of a playback, seconds; short tracks take less.
const PLAY_SECONDS: f32 = 6.0;
/// Slowest playback, iterations per second.
const LEAST_PACE: f32 = 10.0;

impl AlignState {
    /// Last iteration of the scrubber.
    pub fn last_iteration(&self) -> usize {
        self.shown
            .as_ref()
            .map_or(0, MethodComparison::last_iteration)
    }

    pub(super) fn go_to(&mut self, iteration: f32) {
        self.iteration = iteration.clamp(0.0, self.last_iteration() as f32);
    }

    pub(super) fn toggle_play(&mut self) {
        self.playback = match self.playback {
            Playback::Playing => Playback::Paused,
            Playback::Paused if self.last_iteration() == 0 => Playback::Paused,
            Playback::Paused => {
                if self.iteration >= self.last_iteration() as f32 {
                    self.iteration = 0.0;
                }
                Playback::Playing
            }
        };
    }

    pub(super) fn advance(&mut self, seconds: f32) {
        if self.playback == Playback::Paused {
            return;
        }
        let last = self.last_iteration() as f32;
        self.go_to(self.iteration + seconds * (last / PLAY_SECONDS).max(LEAST_PACE));
        if self.iteration >= last {
            self.playback = Playback::Paused;
        }
    }

    /// Adds a method's run; the first run of a pair shows that pair.
    pub(super) fn add_run(&mut self, run: Arc<MethodRun>) {
        match (self.coming.take(), &mut self.shown) {
            (Some(pair), shown) => {
                let runs = vec![run];
                *shown = Some(MethodComparison { pair, runs });
                self.playback = Playback::Paused;
            }
            (None, Some(shown)) => shown.runs.push(run),
            (None, None) => return,
        }
        // Show the end first.
        if self.playback == Playback::Paused {
            self.iteration = self.last_iteration() as f32;
        }
    }
}
