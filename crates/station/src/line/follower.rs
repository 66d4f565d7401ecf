//! Follows the parts on a line before a camera, and answers triggers about them.

use std::{
    collections::BTreeMap,
    iter,
    sync::Arc,
    time::{Duration, Instant},
};

use super::{CountLog, Followed, LineTracker, Moment, set_pose};
use crate::{
    Answered, Answering, Inspected, NoFrame, Subject,
    answer::{inspected_of, parts_of},
    motion::{since_epoch, timestamp},
};
use capture::Captured;
use inspection::pipeline::{Inspection, NamedRecipe, Rejection, Unwatched, run_all};
use records::history::{HungId, Traceability};
use robot::line::{LineCalibration, OnLine};
use serve::Asked;
use stages::scene::SceneCloud;

/// The parts on a line and its counts. `E` is what is recorded of a part.
pub struct LineFollower<E> {
    tracker: LineTracker<E>,
    counts: CountLog,
    /// The ids of the numbered parts for which no trigger has named an order yet.
    unnamed: BTreeMap<u32, HungId>,
}

/// Most parts that wait for a trigger to name their order: more than a camera sees at once.
const MAX_UNNAMED: usize = 100;

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
            unnamed: BTreeMap::new(),
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

    /// Takes the id of the part that an answer begins with, unless a trigger has named an order for it before.
    fn take_unnamed(&mut self, followed: &[Followed]) -> Option<HungId> {
        self.unnamed.remove(&followed.first()?.number?)
    }

    /// Ends the source. Returns what is still to be recorded.
    pub fn end(self) -> Vec<E> {
        self.tracker.end()
    }
}

impl Answering<'_> {
    /// Inspects a frame of a line. Also returns what to record now; `entry` gets a part as it is recorded, and its id.
    pub fn follow<E>(
        &self,
        captured: Captured,
        subject: Subject,
        line: &mut LineFollower<E>,
        scene_of: impl FnOnce(Captured) -> Arc<SceneCloud>,
        entry: impl Fn(&Inspected<'_>, HungId) -> E,
    ) -> Result<(FollowedFrame, Vec<E>), NoFrame> {
        let expected = (self.finder).expected(&self.expected, &self.recipe.rack, self.library)?;
        let recipe = self.recipe.expecting(expected);
        let captured_at = self.camera.captured_at(&captured);
        let at = line.tracker.exposed_at(captured.taken_at);
        let scene = scene_of(captured);
        let mut inspections =
            run_all(&scene, self.library, &recipe, &Unwatched).expect("not cancelled");
        let robot = &self.finder.robot;
        let moment = line.moment(at);
        let (followed, recorded) = line.tracker.see(
            moment,
            &mut inspections,
            |part| part.middle(self.library),
            |_, part, on_line| {
                let hung = HungId::new();
                if let Some(here) = &on_line {
                    line.unnamed.insert(here.number, hung.clone());
                }
                let part = Inspected {
                    on_line,
                    ..inspected_of(&subject, &scene, part, &recipe, robot)
                };
                entry(&part, hung)
            },
        );
        while line.unnamed.len() > MAX_UNNAMED {
            line.unnamed.pop_first();
        }
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

    /// Answers a trigger with the poses of the parts on a line at the count that was sent with it, when that was read; without a
    /// count, with those of the frame. It takes frames until a part counts, nothing hangs there, or the time is over. Also
    /// returns what to record, and the ids of the parts for which the trigger, as the first one, named an order or a serial
    /// number. `next` captures a frame after the trigger.
    pub fn answer_on_line<E>(
        &self,
        asked: &Asked,
        line: &mut LineFollower<E>,
        trace: &Traceability,
        next: impl Fn() -> Result<(Captured, Subject), NoFrame>,
        mut scene_of: impl FnMut(Captured) -> Arc<SceneCloud>,
        entry: impl Fn(&Inspected<'_>, HungId) -> E,
    ) -> (Result<Answered, NoFrame>, Vec<E>, Option<HungId>) {
        let until = Instant::now() + self.at_most;
        let mut recorded = Vec::new();
        let mut sent = None;
        loop {
            let seen = next().and_then(|(captured, subject)| {
                let sent = *sent.get_or_insert_with(|| {
                    let at = self.camera.asked_at(asked, &captured);
                    let at = at.saturating_sub(asked.count_age);
                    let count = asked.count.map(|count| line.counts.read(at, count.into()));
                    let count = count.map(|count| count as f64);
                    Moment { at, count }
                });
                let followed = self.follow(captured, subject, line, &mut scene_of, &entry)?;
                Ok((sent, followed))
            });
            let (sent, (frame, records)) = match seen {
                Ok(seen) => seen,
                Err(why) => return (Err(why), recorded, None),
            };
            recorded.extend(records);
            if frame.is_settled() || Instant::now() >= until || (self.is_ending)() {
                let named = if asked.order.is_given() {
                    line.take_unnamed(&frame.followed)
                } else {
                    None
                };
                let answered = self.answered_at(asked, &sent, frame, line, trace);
                return (Ok(answered), recorded, named);
            }
        }
    }

    /// The answer about a frame, with the poses carried to the moment of the trigger if it sent a count.
    pub(super) fn answered_at<E>(
        &self,
        asked: &Asked,
        sent: &Moment,
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
        let mut on_line = vec![None; inspections.len()];
        for ((inspection, followed), on_line) in
            inspections.iter_mut().zip(&followed).zip(&mut on_line)
        {
            let here = followed.on_line(calibration);
            let Some((here, pose)) = here.zip(followed.pose.as_ref()) else {
                continue;
            };
            let since = sent.at.as_secs_f64() - pose.moment.at.as_secs_f64();
            let (carried, bounds) = match sent.count {
                None => (pose.camera_from_part, pose.bounds),
                Some(count) => pose.at_count(count, calibration).unwrap_or_else(|| {
                    let (carried, bounds) = pose.after(since, calibration);
                    (carried, pose.counted(bounds, calibration))
                }),
            };
            set_pose(inspection, &carried, bounds);
            let moved = carried.translation.vector - pose.camera_from_part.translation.vector;
            if let Ok(part) = &mut inspection.segmentation.part {
                // What the camera saw, where it is at the count.
                for point in &mut part.cloud.points {
                    *point += moved.cast::<f32>();
                }
            }
            *on_line = Some(if sent.count.is_some() {
                OnLine {
                    count: asked.count,
                    at: timestamp(sent.at),
                    bound_mm: bounds.shift.mm(),
                    ..here
                }
            } else {
                OnLine {
                    count: None,
                    bound_mm: bounds.shift.mm(),
                    ..here
                }
            });
        }
        let robot = &self.finder.robot;
        let mut parts = parts_of(&subject, &scene, &inspections, &recipe, robot);
        for (part, on_line) in parts.iter_mut().zip(on_line) {
            part.on_line = on_line;
        }
        let mut found = self.found(&parts, captured_at);
        // Missing parts stand behind those of the frame.
        let of_frame = parts.iter().map(|part| part.on_line);
        for (found, on_line) in found.iter_mut().zip(of_frame.chain(iter::repeat(None))) {
            let here = on_line.filter(|_| found.pose.is_some());
            found.on_line_since = here.map(|here| instant_of(since_epoch(here.at), asked, sent));
            found.on_line = Some(here.unwrap_or_default());
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

/// The moment of a time by the camera's clock, which showed that of `sent` when the count of the trigger was read.
fn instant_of(at: Duration, asked: &Asked, sent: &Moment) -> Instant {
    let (after, before) = (at.saturating_sub(sent.at), sent.at.saturating_sub(at));
    let counted_at = asked.counted_at();
    (counted_at + after)
        .checked_sub(before)
        .unwrap_or(counted_at)
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
