//! Playback of the gun along the path.

use super::state::PaintState;
use ui::scrubber::Playback;

impl PaintState {
    /// Duration of the whole path, seconds.
    pub fn duration(&self) -> f64 {
        let planned = self.planned.as_ref();
        planned.map_or(0.0, |planned| planned.course.duration())
    }

    pub(super) fn go_to(&mut self, time: f64) {
        self.time = time.clamp(0.0, self.duration());
    }

    /// Moves by this many strokes, to the beginning of a stroke.
    pub(super) fn go_by(&mut self, strokes: i32) {
        let Some(planned) = &self.planned else { return };
        let course = &planned.course;
        let begins = course.strokes.iter().map(|stroke| course.times(*stroke)[0]);
        let begins: Vec<f64> = begins.collect();
        // At the beginning of a stroke, a step back leads to the stroke before it.
        let now = begins.partition_point(|begin| *begin <= self.time + 1e-6) as i32 - 1;
        let wanted = usize::try_from(now + strokes).unwrap_or(0);
        let time = begins.get(wanted).copied().unwrap_or(course.duration());
        self.go_to(time);
    }

    pub(super) fn toggle_play(&mut self) {
        self.playback = match self.playback {
            Playback::Paused if self.duration() > 0.0 => {
                if self.time >= self.duration() {
                    self.time = 0.0;
                }
                Playback::Playing
            }
            Playback::Playing | Playback::Paused => Playback::Paused,
        };
    }

    /// Advances by the elapsed seconds while playing.
    pub(super) fn advance(&mut self, seconds: f64) {
        if self.playback == Playback::Playing {
            self.go_to(self.time + seconds);
            if self.time >= self.duration() {
                self.playback = Playback::Paused;
            }
        }
    }
}
