//! Parts that a line carries past the camera: each has a number, is recorded once, and has a pose at every count.
//!
//! A part counts once several frames show it where the line must have carried it in between, as far as they may be off. One
//! that swings is not there, and is refused as moving. Frames that show a part cut off by the edge of the picture are ignored:
//! a part that comes in waits until all of it is seen, and one that leaves is never taken for another.

mod counts;
mod follower;
mod judge;

use std::{collections::VecDeque, time::Duration};

use jiff::Timestamp;
use nalgebra::{Point3, Vector3};

use crate::motion::since_epoch;
use geometry::{rigid::RigidTransform, units::Metres};
use inspection::pipeline::{Inspection, Rejection, Verdict, live::refuse_moving};
use robot::line::{LineCalibration, OnLine};
use stages::pose::Uncertainty;

use self::judge::{Judged, judge};
pub use self::{
    counts::CountLog,
    follower::{FollowedFrame, LineFollower},
    judge::LinePose,
};

/// Follows the parts on a line. `E` is what is recorded of a part.
pub struct LineTracker<E> {
    line: LineCalibration,
    tracks: Vec<Track<E>>,
    num_numbered: u32,
    /// The speed of the last part that counted, m/s, and when.
    speed: Option<(f64, Duration)>,
    last: Option<Moment>,
}

/// When a frame was taken: by the camera, and by the encoder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// The camera's time, from any origin.
    pub at: Duration,
    /// The count, without beginning again, if it is known.
    pub count: Option<f64>,
}

/// What the tracker knows of a part of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Followed {
    /// Number of the part on this line, from 1, once it counts.
    pub number: Option<u32>,
    /// True if it has the number since this frame.
    pub is_new: bool,
    /// Its pose, if this frame's verdict is accepted.
    pub pose: Option<LinePose>,
}

impl Followed {
    /// Where it is on the line, if it has a pose.
    pub fn on_line(&self, line: &LineCalibration) -> Option<OnLine> {
        Some(self.pose.as_ref()?.on_line(self.number?, line))
    }
}

/// Longest exposure, in way of the line: more shears the part by more than a pose may be off.
const MAX_SMEAR_M: f64 = 0.012;
/// Distance from its expected place within which a part is the same, metres: parts do not overlap.
const SAME_PLACE_MAX_DISTANCE_M: f64 = 0.12;
/// The same, as a share of the way since it was seen last.
const SAME_PLACE_MAX_WAY_SHARE: f64 = 0.15;
/// Greatest speed of a line, m/s, where it is not known yet.
const MAX_SPEED_M_S: f64 = 0.5;
/// Way after which a part that was not seen again has left, metres.
const LEFT_AFTER_WAY_M: f64 = 2.5;
/// Time after which it has left where the speed is not known.
const LEFT_AFTER_TIME: Duration = Duration::from_mins(1);
/// Time for which the speed of a line is taken for known.
const MAX_SPEED_AGE: Duration = Duration::from_secs(10);
/// Number of frames in which something that is not accepted must be where the line carried it, to be more than a reflection.
const MIN_REFUSED_FRAMES: usize = 3;
/// Way for which the line must have carried it: what stands beside the line stays near its place for less.
const MIN_CARRIED_M: f64 = 0.3;
/// Most sightings of a part that are kept: more than a fast computer takes while they count.
const MAX_SIGHTINGS: usize = 100;

/// A part on the line.
struct Track<E> {
    sightings: VecDeque<Sighting>,
    /// Number, and the name of the part that has it.
    numbered: Option<(u32, String)>,
    /// What is recorded if it leaves before it counts.
    held: Option<E>,
    /// How many frames have shown it, and whether any accepted it.
    num_seen: usize,
    was_accepted: bool,
    /// The way for which the line has carried it, metres.
    carried: f64,
}

/// A part in one frame.
#[derive(Clone, Debug)]
struct Sighting {
    moment: Moment,
    /// The middle of the part, or of its readings if it has no pose, camera space, metres.
    place: Vector3<f64>,
    /// Set if the frame by itself accepts it.
    accepted: Option<judge::AcceptedSighting>,
    /// True if the place is that of a pose.
    has_pose: bool,
}

impl<E> LineTracker<E> {
    /// A tracker that has seen no frame.
    pub fn new(line: LineCalibration) -> Self {
        Self {
            line,
            tracks: Vec::new(),
            num_numbered: 0,
            speed: None,
            last: None,
        }
    }

    /// The line.
    pub fn line(&self) -> &LineCalibration {
        &self.line
    }

    /// When a frame was exposed that has this time, by the same clock.
    pub fn exposed_at(&self, taken_at: Timestamp) -> Duration {
        since_epoch(taken_at).saturating_sub(Duration::from_secs_f64(self.line.delay))
    }

    /// The speed of the line, m/s, if it is known: by the counts since the last frame, or by the parts that passed.
    pub fn speed_at(&self, moment: &Moment) -> Option<f64> {
        let counted = self.last.and_then(|last| {
            let seconds = moment.at.checked_sub(last.at)?.as_secs_f64();
            let counts = moment.count? - last.count?;
            (seconds > 0.0).then(|| counts * self.line.way_per_count.0 / seconds)
        });
        let seen = self
            .speed
            .filter(|(_, at)| moment.at <= *at + MAX_SPEED_AGE);
        counted.or(seen.map(|(speed, _)| speed))
    }

    /// Takes in the parts of a frame by its own verdicts, and refuses those that do not count: that swing, that are smeared, or
    /// that too few frames have shown so far. `middle_of` is the middle of a part, part space, metres. Returns what is known of
    /// each, and what to record now; `entry` gets the index of the part in the frame and, if it has a number, where it is.
    pub fn see(
        &mut self,
        moment: Moment,
        found: &mut [Inspection],
        middle_of: impl Fn(&Inspection) -> Option<Point3<f64>>,
        mut entry: impl FnMut(usize, &Inspection, Option<OnLine>) -> E,
    ) -> (Vec<Followed>, Vec<E>) {
        let speed = self.speed_at(&moment);
        let mut recorded = self.end_those_gone(&moment, speed);
        let sightings: Vec<Option<Sighting>> = (found.iter())
            .map(|one| Sighting::of(one, moment, middle_of(one)))
            .collect();
        let tracks = self.assigned(&sightings, &moment, speed);
        let mut followed = vec![Followed::default(); found.len()];
        for (index, (sighting, track)) in sightings.into_iter().zip(tracks).enumerate() {
            let inspection = &mut found[index];
            let Some(sighting) = sighting else {
                // It is cut off by the edge of the picture, or there is nothing.
                refuse(inspection, |part| passing(part, 0));
                continue;
            };
            let track = track.unwrap_or_else(|| {
                self.tracks.push(Track::default());
                self.tracks.len() - 1
            });
            followed[index] = self.add(
                track,
                sighting,
                inspection,
                index,
                &mut entry,
                &mut recorded,
            );
        }
        self.last = Some(moment);
        (followed, recorded)
    }

    /// Adds a sighting to its track, and decides about the part.
    fn add(
        &mut self,
        track: usize,
        sighting: Sighting,
        inspection: &mut Inspection,
        index: usize,
        entry: &mut impl FnMut(usize, &Inspection, Option<OnLine>) -> E,
        recorded: &mut Vec<E>,
    ) -> Followed {
        let line_speed = self
            .speed
            .filter(|(_, at)| sighting.moment.at <= *at + MAX_SPEED_AGE);
        let track = &mut self.tracks[track];
        let is_accepted = sighting.accepted.is_some();
        if let Some(last) = track.sightings.back() {
            let moved = (sighting.place - last.place).dot(&self.line.direction);
            track.carried += moved;
        }
        track.sightings.push_back(sighting);
        if track.sightings.len() > MAX_SIGHTINGS {
            track.sightings.pop_front();
        }
        track.num_seen += 1;
        let mut pose = None;
        let accepted: Vec<_> = (track.sightings.iter())
            .filter_map(|one| Some((one.moment, one.accepted.as_ref()?)))
            .collect();
        // Of a sighting that is not accepted, those before it say nothing.
        let judged = if is_accepted {
            judge(&self.line, &accepted, line_speed.map(|(speed, _)| speed))
        } else {
            Judged::TooFew(0)
        };
        match judged {
            Judged::Carried(carried) => {
                let smear = carried.speed.abs() * self.line.exposure;
                if smear > MAX_SMEAR_M {
                    refuse(inspection, |part| Rejection::Smeared {
                        part,
                        smear: Metres(smear),
                        limit: Metres(MAX_SMEAR_M),
                    });
                } else {
                    let carried = carried.smeared(smear);
                    set_pose(inspection, &carried.camera_from_part, carried.bounds);
                    pose = Some(carried);
                }
            }
            Judged::TooFew(num) => refuse(inspection, |part| passing(part, num)),
            Judged::Swings => refuse_moving(inspection),
        }
        let part = inspection.verdict.guess().unwrap_or_default().to_owned();
        let mut is_new = false;
        if let Some(pose) = &pose {
            self.speed = Some((pose.speed, pose.moment.at));
            if track
                .numbered
                .as_ref()
                .is_none_or(|(_, named)| *named != part)
            {
                self.num_numbered += 1;
                is_new = true;
                track.numbered = Some((self.num_numbered, part));
                track.held = None;
                let here = pose.on_line(self.num_numbered, &self.line);
                recorded.push(entry(index, inspection, Some(here)));
            }
        } else if track.numbered.is_none() && (is_accepted || !track.was_accepted) {
            track.held = Some(entry(index, inspection, None));
        }
        track.was_accepted |= is_accepted;
        Followed {
            number: track.numbered.as_ref().map(|(number, _)| *number),
            is_new,
            pose,
        }
    }

    /// The track of each sighting, nearest pairs first; `None` where no part was expected.
    fn assigned(
        &self,
        sightings: &[Option<Sighting>],
        moment: &Moment,
        speed: Option<f64>,
    ) -> Vec<Option<usize>> {
        let mut pairs = Vec::new();
        for (k, sighting) in sightings.iter().enumerate() {
            let Some(sighting) = sighting else { continue };
            for (t, track) in self.tracks.iter().enumerate() {
                let apart = track.distance(sighting, &self.line, moment, speed);
                pairs.extend(apart.map(|apart| (apart, k, t)));
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut tracks = vec![None; sightings.len()];
        for (_, k, t) in pairs {
            if tracks[k].is_none() && !tracks.contains(&Some(t)) {
                tracks[k] = Some(t);
            }
        }
        tracks
    }

    /// Ends the tracks of the parts that have left. Returns what is recorded of those that never counted.
    fn end_those_gone(&mut self, moment: &Moment, speed: Option<f64>) -> Vec<E> {
        let line = &self.line;
        let gone = self.tracks.extract_if(.., |track| {
            let last = track.last().moment;
            match way_between(line, &last, moment, speed) {
                Some(way) => way.abs() > LEFT_AFTER_WAY_M,
                None => moment.at > last.at + LEFT_AFTER_TIME,
            }
        });
        gone.filter_map(Track::unrecorded).collect()
    }

    /// Ends the source. Returns what is still to be recorded.
    pub fn end(self) -> Vec<E> {
        let tracks = self.tracks.into_iter();
        tracks.filter_map(Track::unrecorded).collect()
    }
}

/// The way of the line between two moments, metres, by the counts or by its speed.
fn way_between(
    line: &LineCalibration,
    from: &Moment,
    to: &Moment,
    speed: Option<f64>,
) -> Option<f64> {
    if let (Some(from), Some(to)) = (from.count, to.count) {
        return Some((to - from) * line.way_per_count.0);
    }
    let seconds = to.at.as_secs_f64() - from.at.as_secs_f64();
    speed.map(|speed| speed * seconds)
}

fn refuse(inspection: &mut Inspection, why: impl FnOnce(String) -> Rejection) {
    if let Verdict::Part {
        part,
        rejected: rejected @ None,
        ..
    } = &mut inspection.verdict
    {
        *rejected = Some(why(part.clone()));
    }
}

/// Puts a pose that several frames gave in place of that of one.
fn set_pose(inspection: &mut Inspection, camera_from_part: &RigidTransform, bounds: Uncertainty) {
    if let Some(Ok(pose)) = &mut inspection.pose {
        pose.target_from_source = camera_from_part.inverse();
        pose.uncertainty = Some(bounds);
    }
}

/// The refusal of a part that too few frames have shown so far.
fn passing(part: String, num_frames: usize) -> Rejection {
    Rejection::Passing {
        part,
        num_frames,
        needed: judge::MIN_SIGHTINGS,
    }
}

impl Sighting {
    /// `None` if nothing can be said of it: it is cut off, or nothing hangs there.
    fn of(inspection: &Inspection, moment: Moment, middle: Option<Point3<f64>>) -> Option<Self> {
        if matches!(inspection.verdict, Verdict::NoPart(_)) || inspection.touches_edge() {
            return None;
        }
        let pose = inspection.found_pose();
        let seen = pose.zip(middle).map(|(pose, middle)| {
            let place = (pose.camera_from_part() * middle).coords;
            (place, judge::AcceptedSighting::of(inspection, pose, middle))
        });
        let readings = inspection.readings().unwrap_or_default();
        let sum: Vector3<f64> = readings.iter().map(|p| p.coords.cast::<f64>()).sum();
        let has_pose = seen.is_some();
        let (place, accepted) = match seen {
            Some((place, accepted)) => (place, accepted),
            None if readings.is_empty() => return None,
            None => (sum / readings.len() as f64, None),
        };
        Some(Self {
            moment,
            place,
            accepted,
            has_pose,
        })
    }
}

impl<E> Default for Track<E> {
    fn default() -> Self {
        Self {
            sightings: VecDeque::new(),
            numbered: None,
            held: None,
            num_seen: 0,
            was_accepted: false,
            carried: 0.0,
        }
    }
}

impl<E> Track<E> {
    fn last(&self) -> &Sighting {
        self.sightings.back().expect("begun by a sighting")
    }

    /// Distance of a sighting from where the line must have carried this part; `None` if it is another one.
    fn distance(
        &self,
        sighting: &Sighting,
        line: &LineCalibration,
        moment: &Moment,
        speed: Option<f64>,
    ) -> Option<f64> {
        // Places by poses and by readings differ.
        let last = self.sightings.iter().rev();
        let alike = last.clone().find(|one| one.has_pose == sighting.has_pose);
        let last = alike.or(last.clone().next())?;
        let moved = sighting.place - last.place;
        let along = moved.dot(&line.direction);
        let across = (moved - line.direction.into_inner() * along).norm();
        let off = if let Some(way) = way_between(line, &last.moment, moment, speed) {
            let reach = SAME_PLACE_MAX_DISTANCE_M + SAME_PLACE_MAX_WAY_SHARE * way.abs();
            let off = (along - way).abs();
            (off <= reach).then_some(off)?
        } else {
            let seconds = (moment.at.saturating_sub(last.moment.at)).as_secs_f64();
            (along.abs() <= SAME_PLACE_MAX_DISTANCE_M + MAX_SPEED_M_S * seconds)
                .then_some(along.abs())?
        };
        (across <= SAME_PLACE_MAX_DISTANCE_M).then(|| off.hypot(across))
    }

    /// What is recorded of a part that leaves.
    fn unrecorded(self) -> Option<E> {
        let is_carried = self.num_seen >= MIN_REFUSED_FRAMES && self.carried.abs() >= MIN_CARRIED_M;
        let is_real = self.was_accepted || is_carried;
        self.held.filter(|_| is_real)
    }
}

#[cfg(test)]
mod tests;
