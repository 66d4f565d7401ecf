//! One part after the other in front of a camera: which frames show the same hung part, and which of them represents
//! it.
//!
//! A hung part begins with the first frame that shows one. Before its verdict counts, it has left once frames show
//! none for a while. Afterwards it has left as soon as the camera looks through most of the place where it hung: a
//! person who walks by or a hand that turns the part does not end it, and the same part hung into the same jig again
//! is a new one.
//!
//! Known limits: once a verdict counts, a part that is exchanged for another between two frames is taken for the
//! same, unless the frames are seconds apart and another part is accepted. Captures seconds apart cannot show whether a
//! part hangs still: if two in a row have the same name, they count as one part.
//!
//! This is about one spot; where several parts may hang, each has its own, see [`spots_of`](super::spots_of).

use std::time::Duration;

use nalgebra::{Point3, Vector3};

use super::{ConsensusParams, ConsensusVerdict, LiveVerdict};
use crate::pipeline::{Inspection, Verdict};
use geometry::{
    cloud::Grid,
    rigid::{RigidTransform, pose_error},
};
use stages::{scene::SceneCloud, segment::SegmentedPart};

/// An inspected frame and the live verdict after it.
#[derive(Clone, Copy, Debug)]
pub struct HungFrame<'a> {
    /// The frame.
    pub scene: &'a SceneCloud,
    /// The camera's time, from any origin.
    pub at: Duration,
    /// Its inspection.
    pub inspection: &'a Inspection,
    /// The live verdict after it.
    pub verdict: &'a LiveVerdict,
    /// Middle of the named part, part space, metres.
    pub middle: Option<Point3<f64>>,
    /// Identifies the recipe and the library.
    pub inputs: &'a str,
}

/// The role of a frame for the part that hangs there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameRole {
    /// None: one frame of many.
    Nothing,
    /// The best frame so far of a part whose verdict does not count yet.
    Best,
    /// The frame of the part's first verdict that counts.
    First,
    /// The frame of a further verdict on the same part: a different one, or one with another recipe, library or
    /// place.
    Again,
}

/// What has left without a verdict that counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Left {
    /// Nothing.
    Nothing,
    /// Something that looked like an enrolled part.
    Part,
    /// Something unlike any enrolled part, such as a person walking by.
    Other,
}

/// Tells the parts in front of one camera apart. The same frames at the same times always give the same parts.
#[derive(Clone, Debug, Default)]
pub struct HungParts {
    state: HungState,
    visit: u64,
    departures: u64,
    last_at: Option<Duration>,
    /// Time of the first frame without a part, and the number of such frames in a row.
    absent: Option<(Duration, usize)>,
}

#[derive(Clone, Debug, Default)]
enum HungState {
    #[default]
    Empty,
    /// Something is there, but no verdict on it counts yet.
    Unsettled {
        best_score: f64,
        is_named: bool,
        /// The best frame is one of those after it had come to rest.
        was_still: bool,
        /// The name that the last frame gave it.
        last: String,
        /// Where that frame showed it.
        surface: Surface,
        seen_at: Duration,
    },
    Counted(Box<CountedPart>),
}

/// A part whose verdict counted.
#[derive(Clone, Debug)]
struct CountedPart {
    /// The verdicts on it where it hangs now: name, and whether accepted.
    verdicts: Vec<(String, bool)>,
    inputs: String,
    camera_from_part: Option<RigidTransform>,
    /// Something moved since the last verdict.
    has_scene_moved: bool,
    /// Where it hangs.
    surface: Surface,
    grid: Option<Grid>,
    has_left: bool,
}

/// What a frame showed of a part.
#[derive(Clone, Debug, Default)]
pub(super) struct Surface {
    num_readings: usize,
    /// Some of the readings: index in the picture, and depth, metres.
    points: Vec<(u32, f32)>,
    /// Mean of those, camera space, metres.
    pub(super) middle: Point3<f32>,
}

/// Whether and where a part is at a spot.
pub(super) enum Presence<'a> {
    /// None is.
    Empty,
    /// One was seen there and may have gone on.
    Passing(&'a Surface),
    /// It hangs exactly there, even if something hides it.
    Hanging(&'a Surface),
}

/// After a longer gap between frames, it is unknown what hangs there.
const MAX_KNOWN_GAP: Duration = Duration::from_secs(10);
/// After a longer gap between frames, something of another name is another part.
const MAX_SAME_PART_GAP: Duration = Duration::from_secs(2);
/// A part has left once no frame shows one for this time, and in this many frames.
const MIN_ABSENCE: (Duration, usize) = (Duration::from_millis(400), 2);
/// Points of a part, approximately, that are looked for in its place.
const NUM_TRACKED_POINTS: usize = 600;
/// A reading this far behind a part's surface, metres, shows that its place is empty: about ten times a Kinect's
/// noise.
const BEHIND_MIN_DISTANCE_M: f32 = 0.06;
/// Share of a part's points that must be looked through for it to have left; if it swings on its hook, fewer are.
const LEFT_MIN_SEEN_THROUGH_SHARE: f64 = 0.7;
/// A part has also left if no part is seen and fewer than this share of its points are still there: the camera may
/// have no readings of what is behind.
const PRESENT_MIN_SHARE: f64 = 0.1;

impl HungParts {
    /// Number of parts that hung there, including the present one.
    pub fn visit(&self) -> u64 {
        self.visit
    }

    /// Counts how often the place was left, or stayed empty for as long as a part takes to leave.
    pub fn departures(&self) -> u64 {
        self.departures
    }

    /// True while nothing is known to hang there, or to have just left.
    pub fn is_empty(&self) -> bool {
        matches!(self.state, HungState::Empty)
    }

    /// True if one was seen there and may have gone on: its verdict does not count yet, or it has left its place.
    pub fn is_passing(&self) -> bool {
        match &self.state {
            HungState::Empty => false,
            HungState::Unsettled { .. } => true,
            HungState::Counted(part) => part.has_left,
        }
    }

    /// True while a part hangs there, whether its verdict counts or not.
    pub fn is_hanging(&self) -> bool {
        match &self.state {
            HungState::Empty => false,
            HungState::Unsettled { .. } => true,
            HungState::Counted(part) => !part.has_left,
        }
    }

    /// Whether and where a part is when the camera sees this scene, if nothing has moved since then; without a time, something
    /// may move.
    pub(super) fn presence(
        &self,
        scene: &SceneCloud,
        still_since: Option<Duration>,
    ) -> Presence<'_> {
        match &self.state {
            HungState::Empty => Presence::Empty,
            HungState::Unsettled {
                surface, seen_at, ..
            } if still_since.is_some_and(|since| since <= *seen_at) => Presence::Hanging(surface),
            HungState::Unsettled { surface, .. } => Presence::Passing(surface),
            HungState::Counted(part) if part.has_left || part.is_looked_through(scene, false) => {
                Presence::Passing(&part.surface)
            }
            HungState::Counted(part) => Presence::Hanging(&part.surface),
        }
    }

    /// Takes in a frame: what has left before it, and what it is for the part that hangs there now.
    pub fn see(&mut self, frame: &HungFrame<'_>) -> (Left, FrameRole) {
        let before = self.last_at.replace(frame.at);
        let shown = match &frame.inspection.verdict {
            Verdict::Part { part, score, .. } => Some((part.as_str(), *score)),
            Verdict::NoPart(_) => None,
        };
        // A clock that was set back is an unknown gap, too.
        let gap = before.map(|before| frame.at.checked_sub(before).unwrap_or(Duration::MAX));
        let is_accepted = frame.inspection.verdict.is_accepted();
        let is_blind = |gap| {
            gap > MAX_KNOWN_GAP || (gap > MAX_SAME_PART_GAP && self.is_another(shown, is_accepted))
        };
        let mut left = Left::Nothing;
        if gap.is_some_and(is_blind) {
            left = self.leave();
        }
        if let HungState::Counted(part) = &mut self.state {
            part.has_left |= part.is_looked_through(frame.scene, shown.is_none());
        }
        let role = match (frame.verdict.counted(), shown) {
            (Some(agreed), Some(_)) if matches!(agreed.verdict, Verdict::Part { .. }) => {
                self.absent = None;
                self.count(frame, agreed)
            }
            (counted, None) => {
                if self.is_absent(frame.at) || counted.is_some() {
                    left = left.or(self.leave_unless_hidden());
                }
                FrameRole::Nothing
            }
            (_, Some((name, score))) => {
                self.absent = None;
                let is_named = !frame.inspection.verdict.is_unknown();
                self.observe_unsettled(frame, name, score, is_named)
            }
        };
        if let HungState::Counted(part) = &mut self.state {
            part.has_scene_moved |= frame.verdict.counted().is_none();
        }
        (left, role)
    }

    /// True if this part has another name than the one seen last. Once a verdict counts, only an accepted part can be
    /// another one: the best guess of a part that is not accepted changes from frame to frame.
    fn is_another(&self, shown: Option<(&str, f64)>, is_accepted: bool) -> bool {
        match (&self.state, shown) {
            (HungState::Unsettled { last, .. }, Some((name, _))) => last != name,
            (HungState::Counted(part), Some((name, _))) => {
                is_accepted && part.verdicts.iter().all(|(known, _)| known != name)
            }
            _ => false,
        }
    }

    /// True once no part was seen for long enough, this frame included.
    fn is_absent(&mut self, at: Duration) -> bool {
        let (since, num_frames) = self.absent.get_or_insert((at, 0));
        *num_frames += 1;
        at.saturating_sub(*since) >= MIN_ABSENCE.0 && *num_frames >= MIN_ABSENCE.1
    }

    /// Handles a scene without a part. A part whose verdict counted may still hang behind something that hides it.
    fn leave_unless_hidden(&mut self) -> Left {
        match &self.state {
            HungState::Counted(part) if !part.has_left => Left::Nothing,
            _ => self.leave(),
        }
    }

    fn leave(&mut self) -> Left {
        self.departures += 1;
        self.absent = None;
        match std::mem::take(&mut self.state) {
            HungState::Unsettled { is_named: true, .. } => Left::Part,
            HungState::Unsettled { .. } => Left::Other,
            HungState::Empty | HungState::Counted(_) => Left::Nothing,
        }
    }

    /// Handles a frame that shows a part while no verdict counts.
    fn observe_unsettled(
        &mut self,
        frame: &HungFrame<'_>,
        name: &str,
        score: f64,
        is_named: bool,
    ) -> FrameRole {
        let known = match &self.state {
            // It moves away, or something hides it.
            HungState::Counted(_) => return FrameRole::Nothing,
            HungState::Empty => {
                self.visit += 1;
                None
            }
            HungState::Unsettled {
                best_score,
                is_named,
                was_still,
                ..
            } => Some((*is_named, *was_still, *best_score)),
        };
        // A frame that looks like an enrolled part is better than one that looks like none, whatever their scores, and one after
        // the part had come to rest is better than one before: had there been more of them, its verdict would have counted.
        let is_still = matches!(frame.verdict, LiveVerdict::Gathering { .. });
        let shown = (is_named, is_still, score);
        let is_best = known.is_none_or(|known| shown > known);
        let (is_named, was_still, best_score) = known.filter(|_| !is_best).unwrap_or(shown);
        self.state = HungState::Unsettled {
            best_score,
            is_named,
            was_still,
            last: name.to_owned(),
            surface: Surface::of(frame),
            seen_at: frame.at,
        };
        if is_best {
            FrameRole::Best
        } else {
            FrameRole::Nothing
        }
    }

    /// Handles a frame after which a verdict on a part counts.
    fn count(&mut self, frame: &HungFrame<'_>, agreed: &ConsensusVerdict) -> FrameRole {
        let Verdict::Part { part, rejected, .. } = &agreed.verdict else {
            return FrameRole::Nothing;
        };
        let best = frame.inspection.ranking.entries.first();
        let is_in_line = best.is_some_and(|best| best.part == *part)
            && !matches!(frame.inspection.pose, Some(Err(_)));
        if !is_in_line {
            // One of the few frames that see something else: it cannot represent the verdict.
            return FrameRole::Nothing;
        }
        let verdict = (part.clone(), rejected.is_none());
        let pose = agreed.pose.as_ref().map(|pose| pose.camera_from_part);
        if let HungState::Counted(known) = &mut self.state
            && !known.has_left
        {
            let is_elsewhere = known.inputs != frame.inputs
                || (known.has_scene_moved && known.has_moved(pose.as_ref(), frame));
            known.has_scene_moved = false;
            if is_elsewhere {
                known.verdicts.clear();
            }
            if known.verdicts.contains(&verdict) {
                return FrameRole::Nothing;
            }
            let mut all = std::mem::take(&mut known.verdicts);
            all.push(verdict);
            **known = CountedPart::from_frame(frame, all, pose);
            return FrameRole::Again;
        }
        if !matches!(self.state, HungState::Unsettled { .. }) {
            self.visit += 1;
        }
        self.state = HungState::Counted(Box::new(CountedPart::from_frame(
            frame,
            vec![verdict],
            pose,
        )));
        FrameRole::First
    }
}

impl Left {
    fn or(self, other: Self) -> Self {
        if self == Self::Nothing { other } else { self }
    }
}

impl CountedPart {
    fn from_frame(
        frame: &HungFrame<'_>,
        verdicts: Vec<(String, bool)>,
        camera_from_part: Option<RigidTransform>,
    ) -> Self {
        Self {
            verdicts,
            inputs: frame.inputs.to_owned(),
            camera_from_part,
            has_scene_moved: false,
            surface: Surface::of(frame),
            grid: frame.scene.cloud.grid,
            has_left: false,
        }
    }

    /// True if it has moved since the last verdict on it counted.
    fn has_moved(&self, now: Option<&RigidTransform>, frame: &HungFrame<'_>) -> bool {
        let Some((before, now)) = self.camera_from_part.as_ref().zip(now) else {
            return false;
        };
        let middle = frame.middle.unwrap_or_else(Point3::origin);
        let off = pose_error(before, now, &middle);
        // Further apart than poses of frames that agree.
        let tolerance = ConsensusParams::default().tolerance;
        off.shift.0 > tolerance.shift.0 || off.rotation.0 > tolerance.turn.0
    }

    /// True if the camera looks through the place where it hung.
    fn is_looked_through(&self, scene: &SceneCloud, is_empty: bool) -> bool {
        if self.grid.is_none() || scene.cloud.grid != self.grid {
            // A picture with other rows and columns.
            return true;
        }
        let (mut num_behind, mut num_there) = (0_u32, 0_u32);
        for (place, depth) in &self.surface.points {
            let now = scene
                .cloud
                .points
                .get(*place as usize)
                .map_or(f32::NAN, |p| p.z);
            num_behind += u32::from(now > depth + BEHIND_MIN_DISTANCE_M);
            num_there += u32::from((now - depth).abs() <= BEHIND_MIN_DISTANCE_M);
        }
        let share = |num: u32| f64::from(num) / self.surface.points.len().max(1) as f64;
        share(num_behind) > LEFT_MIN_SEEN_THROUGH_SHARE
            || (is_empty && share(num_there) < PRESENT_MIN_SHARE)
    }
}

impl Surface {
    fn of(frame: &HungFrame<'_>) -> Self {
        let indices = match &frame.inspection.segmentation.part {
            Ok(part) => part.indices.as_slice(),
            Err(_) => &[],
        };
        let readings = &frame.scene.cloud.points;
        let seen = indices
            .iter()
            .step_by((indices.len() / NUM_TRACKED_POINTS).max(1))
            .filter_map(|i| Some((*i, readings.get(*i as usize)?)));
        let (mut points, mut sum) = (Vec::new(), Vector3::zeros());
        for (i, point) in seen {
            points.push((i, point.z));
            sum += point.coords;
        }
        Self {
            num_readings: indices.len(),
            middle: Point3::from(sum / points.len().max(1) as f32),
            points,
        }
    }

    /// Readings that both have, of those that either has, 0..1.
    pub(super) fn overlap(&self, part: &SegmentedPart) -> f64 {
        let is_shared = |(i, _): &&(u32, f32)| part.indices.binary_search(i).is_ok();
        let num_shared = self.points.iter().filter(is_shared).count();
        let share = num_shared as f64 / self.points.len().max(1) as f64;
        let shared = share * self.num_readings as f64;
        let all = (self.num_readings + part.indices.len()) as f64 - shared;
        shared / all.max(1.0)
    }
}

#[cfg(test)]
mod tests;
