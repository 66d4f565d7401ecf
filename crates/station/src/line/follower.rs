//! Follows the parts on a line before a camera, and answers triggers about them.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use super::{CountLog, Followed, LineTracker, Moment, set_pose};
use crate::{
    Answered, Answering, Inspected, NoFrame, Subject,
    answer::{inspected_of, parts_of},
    motion::time_of,
};
use capture::Captured;
use inspection::pipeline::{Inspection, NamedRecipe, Rejection, Unwatched, run_all};
use records::history::Traceability;
use robot::line::LineCalibration;
use serve::{Asked, OnLine};
use stages::scene::SceneCloud;

/// The parts on a line and its counts. `E` is what is recorded of a part.
pub struct LineFollower<E> {
    tracker: LineTracker<E>,
    counts: CountLog,
}

/// A frame of a line, whose parts are refused unless they count.
pub struct FollowedFrame {
    subject: Subject,
    scene: Arc<SceneCloud>,
    /// In the order of [`run_all`].
    inspections: Vec<Inspection>,
    followed: Vec<Followed>,
    recipe: NamedRecipe,
    /// When it was taken, by this computer.
    captured_at: Instant,
}

impl<E> LineFollower<E> {
    /// Follows a line from now on.
    pub fn new(line: LineCalibration) -> Self {
        Self {
            counts: CountLog::new(line.counter),
            tracker: LineTracker::new(line),
        }
    }

    /// The line.
    pub fn line(&self) -> &LineCalibration {
        self.tracker.line()
    }

    /// When a frame was taken, with the count if it can be told.
    fn moment(&self, at: Duration) -> Moment {
        let speed = self.tracker.speed_at(&Moment { at, count: None });
        let per_count = self.tracker.line().way_per_count.0;
        self.counts.moment(at, speed.map(|speed| speed / per_count))
    }

    /// Ends the source. Returns what is still to be recorded.
    pub fn end(self) -> Vec<E> {
        self.tracker.end()
    }
}

impl Answering<'_> {
    /// Inspects a frame of a line. Also returns what to record now; `entry` gets a part as it is recorded.
    pub fn follow<E>(
        &self,
        captured: Captured,
        subject: Subject,
        line: &mut LineFollower<E>,
        scene_of: impl FnOnce(Captured) -> Arc<SceneCloud>,
        entry: impl Fn(&Inspected<'_>) -> E,
    ) -> Result<(FollowedFrame, Vec<E>), NoFrame> {
        let expected = (self.finder).expected(&self.expected, &self.recipe.rack, self.library)?;
        let recipe = self.recipe.expecting(expected);
        let (captured_at, at) = (self.camera.captured_at(&captured), time_of(&captured));
        let scene = scene_of(captured);
        let mut inspections =
            run_all(&scene, self.library, &recipe, &Unwatched).expect("not cancelled");
        let robot = &self.finder.robot;
        let moment = line.moment(at);
        let (followed, recorded) = line.tracker.see(
            moment,
            &mut inspections,
            |part| part.best_reference(self.library)?.middle(),
            |_, part, _| entry(&inspected_of(&subject, &scene, part, &recipe, robot)),
        );
        let frame = FollowedFrame {
            subject,
            scene,
            inspections,
            followed,
            recipe,
            captured_at,
        };
        Ok((frame.in_order(line.tracker.line()), recorded))
    }

    /// Answers a trigger with the poses of the parts on a line when it came, at the count that was sent with it. It takes
    /// frames until a part counts, nothing hangs there, or the time is over. Also returns what to record. `next` captures a
    /// frame after the trigger.
    pub fn answer_on_line<E>(
        &self,
        asked: &Asked,
        line: &mut LineFollower<E>,
        trace: &Traceability,
        next: impl Fn() -> Result<(Captured, Subject), NoFrame>,
        mut scene_of: impl FnMut(Captured) -> Arc<SceneCloud>,
        entry: impl Fn(&Inspected<'_>) -> E,
    ) -> (Result<Answered, NoFrame>, Vec<E>) {
        let until = Instant::now() + self.at_most;
        let mut recorded = Vec::new();
        let mut count = None;
        loop {
            let seen = next().and_then(|(captured, subject)| {
                // The trigger came before the frame, by the camera's clock as well.
                let before = captured.arrived.saturating_duration_since(asked.at);
                let at = time_of(&captured).saturating_sub(before);
                count = count.or_else(|| Some(line.counts.read(at, asked.count?.into())));
                self.follow(captured, subject, line, &mut scene_of, &entry)
            });
            let (frame, records) = match seen {
                Ok(seen) => seen,
                Err(why) => return (Err(why), recorded),
            };
            recorded.extend(records);
            if frame.is_settled() || Instant::now() >= until || (self.is_ending)() {
                let answered = self.answered_at(asked, count, frame, line, trace);
                return (Ok(answered), recorded);
            }
        }
    }

    /// The answer about a frame, with the poses carried back to when the trigger came.
    pub(super) fn answered_at<E>(
        &self,
        asked: &Asked,
        count: Option<i64>,
        frame: FollowedFrame,
        line: &LineFollower<E>,
        trace: &Traceability,
    ) -> Answered {
        let FollowedFrame {
            subject,
            scene,
            mut inspections,
            followed,
            recipe,
            captured_at,
        } = frame;
        let calibration = line.tracker.line();
        let since = captured_at
            .saturating_duration_since(asked.at)
            .as_secs_f64();
        let mut on_line = vec![OnLine::default(); inspections.len()];
        for ((inspection, followed), on_line) in
            inspections.iter_mut().zip(&followed).zip(&mut on_line)
        {
            let Some((pose, number)) = followed.pose.as_ref().zip(followed.number) else {
                continue;
            };
            let at_trigger = asked.count.is_some();
            let (carried, bounds) = match count {
                _ if !at_trigger => (pose.camera_from_part, pose.bounds),
                Some(count) => (pose.at_count(count as f64, calibration))
                    .unwrap_or_else(|| pose.after(-since, calibration)),
                None => pose.after(-since, calibration),
            };
            set_pose(inspection, &carried, bounds);
            let moved = carried.translation.vector - pose.camera_from_part.translation.vector;
            if let Ok(part) = &mut inspection.segmentation.part {
                // What the camera saw, where it is at the count.
                for point in &mut part.cloud.points {
                    *point += moved.cast::<f32>();
                }
            }
            *on_line = OnLine {
                number,
                count: asked.count,
                at: Some(if at_trigger { asked.at } else { captured_at }),
                bound_mm: bounds.shift.mm(),
                speed_mm_s: 1000.0 * pose.speed,
            };
        }
        let robot = &self.finder.robot;
        let parts = parts_of(&subject, &scene, &inspections, &recipe, robot);
        let mut found = self.found(&parts, captured_at);
        // Missing parts stand behind those of the frame.
        for (index, found) in found.iter_mut().enumerate() {
            let here = on_line.get(index).copied().unwrap_or_default();
            found.on_line = Some(if found.pose.is_some() {
                here
            } else {
                OnLine::default()
            });
        }
        found.first.report = Inspected::line_of_all(&parts, trace);
        Answered {
            subject,
            found,
            scene,
            inspections,
            recipe,
        }
    }
}

#[cfg(test)]
impl FollowedFrame {
    /// The frame of one part.
    pub(super) fn of(
        subject: Subject,
        scene: Arc<SceneCloud>,
        inspection: Inspection,
        followed: Followed,
        captured_at: Instant,
    ) -> Self {
        Self {
            subject,
            scene,
            inspections: vec![inspection],
            followed: vec![followed],
            recipe: NamedRecipe::default(),
            captured_at,
        }
    }

    /// Refuses its part because it moves.
    pub(super) fn refuse_first(&mut self) {
        inspection::pipeline::live::refuse_moving(&mut self.inspections[0]);
        self.followed[0].pose = None;
    }
}

impl FollowedFrame {
    /// Those that count first, of these the one that has come furthest, since it leaves first.
    fn in_order(mut self, line: &LineCalibration) -> Self {
        let mut all: Vec<(Inspection, Followed)> = self
            .inspections
            .drain(..)
            .zip(self.followed.drain(..))
            .collect();
        let ahead = |followed: &Followed| {
            followed.pose.as_ref().map_or(f64::NEG_INFINITY, |pose| {
                let along = pose
                    .camera_from_part
                    .translation
                    .vector
                    .dot(&line.direction);
                along * pose.speed.signum()
            })
        };
        all.sort_by(|a, b| ahead(&b.1).total_cmp(&ahead(&a.1)));
        (self.inspections, self.followed) = all.into_iter().unzip();
        self
    }

    /// False while a part may still come to count.
    fn is_settled(&self) -> bool {
        let waits =
            |one: &Inspection| matches!(one.verdict.rejected(), Some(Rejection::Passing { .. }));
        let counts = self.followed.iter().any(|one| one.pose.is_some());
        counts || !self.inspections.iter().any(waits)
    }
}
