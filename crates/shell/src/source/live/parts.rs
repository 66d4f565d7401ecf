//! The parts that hang before the source that is followed. Live sees them; who inspects one of its frames beside Live is
//! told which part that frame shows.

use std::{
    collections::VecDeque,
    mem,
    sync::{
        Arc,
        mpsc::{Receiver, Sender, channel},
    },
    time::Instant,
};

use crate::{inspection::inspected::Inspected, trace::current_trace::CurrentTrace};
use capture::SourceSpec;
use inspection::{library::Truth, pipeline::Inspection};
use records::history::{HungId, HungSpots, SpotIds, StoredVerdict, TraceChange, Traceability};
use stages::segment::MAX_PARTS;

/// The parts before a source, side by side or one after the other.
#[derive(Debug, Default)]
pub(crate) struct FollowedParts {
    source: String,
    pub(super) spots: HungSpots<Arc<Inspected>>,
    /// The parts whose verdicts counted last, the newest first, and their traceability.
    counted: VecDeque<(HungId, Traceability)>,
    /// The last parts with a true label, the newest first.
    labelled: VecDeque<(HungId, Truth)>,
    /// Frames whose part is asked for, until Live has seen one as new.
    asked: Vec<AskedFrame>,
}

#[derive(Debug)]
struct AskedFrame {
    source: String,
    arrived: Instant,
    tell: Sender<SpotIds>,
}

/// Parts that are remembered after their verdict: more than hang there at the same time.
const MAX_REMEMBERED: usize = 2 * MAX_PARTS;

impl FollowedParts {
    /// Starts over if this is not the same source as before. Returns the inspections of the parts that hang before the
    /// former source and whose verdicts do not count yet.
    pub(super) fn begin(&mut self, source: &SourceSpec) -> Vec<Arc<Inspected>> {
        let source = source.to_string();
        if self.source == source {
            return Vec::new();
        }
        // Live sees none of the former source's frames any more.
        let ids = self.spots.ids(Some(false));
        self.asked.retain(|frame| {
            let is_former = frame.source == self.source;
            if is_former {
                // The receiver may be gone.
                let _ = frame.tell.send(ids.clone());
            }
            !is_former
        });
        let left = self.spots.take_best();
        *self = Self {
            source,
            // They may be of this source: whoever asks may be faster than Live.
            asked: mem::take(&mut self.asked),
            ..Self::default()
        };
        left
    }

    /// Asks which parts a frame of this source shows. The answer comes once Live has seen that frame or a later one, or goes
    /// on to another source; none comes, and the sender is dropped, if Live follows another source already.
    pub(crate) fn parts_of_frame(&mut self, source: String, arrived: Instant) -> Receiver<SpotIds> {
        let (tell, parts) = channel();
        self.asked.push(AskedFrame {
            source,
            arrived,
            tell,
        });
        parts
    }

    /// The parts that a frame of this source may show as far as is known now, without waiting for Live; `None` if Live follows
    /// another source.
    pub(crate) fn ids_now(&self, source: &str, shows_part: bool) -> Option<SpotIds> {
        (self.source == source).then(|| self.spots.ids(Some(shows_part)))
    }

    /// The verdict of a part counts, with this traceability.
    pub(super) fn counts(&mut self, part: HungId, trace: Traceability) {
        self.counted.push_front((part, trace));
        self.counted.truncate(MAX_REMEMBERED);
    }

    /// The traceability of a part, if its verdict has counted.
    pub(super) fn trace_of(&self, part: &HungId) -> Option<&Traceability> {
        let mut counted = self.counted.iter();
        let (_, trace) = counted.find(|(counted, _)| counted == part)?;
        Some(trace)
    }

    /// The traceability of the part that hangs at a spot, if its verdict has counted.
    pub(super) fn trace_of_hanging(&mut self, spot: usize) -> Option<&Traceability> {
        let hanging = self.spots.at(spot).id_of_frame(false);
        self.trace_of(&hanging)
    }

    /// The traceability of this part changed after its verdict.
    pub(crate) fn traced(&mut self, part: &HungId, change: &TraceChange) {
        let mut counted = self.counted.iter_mut();
        if let Some((_, known)) = counted.find(|(counted, _)| counted == part) {
            *known = mem::take(known).changed(change);
        }
    }

    /// Takes over the true label of a part, or that it has none.
    pub(crate) fn label(&mut self, part: &HungId, label: Option<&Truth>) {
        self.labelled.retain(|(known, _)| known != part);
        if let Some(label) = label {
            self.labelled.push_front((part.clone(), label.clone()));
            self.labelled.truncate(MAX_REMEMBERED);
        }
    }

    /// What this part really is, if a person has reported that it is none of this name.
    pub(crate) fn reported_as(&self, part: &HungId, name: &str) -> Option<Truth> {
        let mut labelled = self.labelled.iter();
        let (_, label) = labelled.find(|(known, _)| known == part)?;
        (label.part() != Some(name)).then(|| label.clone())
    }

    /// Gives the inspections of a capture, which is taken in place of Live, their parts and the traceability of those. A part
    /// whose verdict has counted keeps its own serial number, and beside others also that it has none: the waiting one is of
    /// the next part.
    pub(crate) fn assign_capture(&mut self, found: &mut [Inspected], current: &CurrentTrace) {
        let first = &found[0];
        let hung = if self.source == first.entry.record.summary.source {
            let inspections: Vec<&Inspection> = found.iter().map(|one| &one.inspection).collect();
            (self.spots).ids_of(&inspections, &first.scene, &first.recipe)
        } else {
            found.iter().map(|one| one.hung().clone()).collect()
        };
        let summaries = found.iter().map(|one| &one.entry.record.summary);
        let shows_any = summaries
            .into_iter()
            .any(|one| one.verdict != StoredVerdict::NoPart);
        let is_beside_others = found.len() > 1;
        let mut taken = None;
        for (one, hung) in found.iter_mut().zip(hung) {
            let known = self.trace_of(&hung);
            let known = known.filter(|trace| {
                is_beside_others || !trace.serial.is_empty() || current.is_late_of(&hung)
            });
            let trace = match known {
                Some(trace) => trace.clone(),
                None => taken.get_or_insert_with(|| current.take(shows_any)).clone(),
            };
            one.set_part(hung, trace);
        }
    }

    /// Live has seen a frame that came then, after [`HungSpots::see`] of all its parts.
    pub(super) fn seen(&mut self, arrived: Instant) {
        let ids = self.spots.ids(None);
        self.answer(arrived, |_| Some(ids.clone()));
    }

    /// Live has inspected a capture that stands for itself, with these parts.
    pub(super) fn seen_alone(&mut self, arrived: Instant, parts: &[Arc<Inspected>]) {
        let found = parts.iter().map(|part| (&part.inspection, part.hung()));
        let found: Vec<_> = found.collect();
        let ids = SpotIds::of_frame(&parts[0].scene, &found);
        self.answer(arrived, |frame| {
            (frame.arrived == arrived).then(|| ids.clone())
        });
    }

    /// The source has ended: the inspections of parts that still hang there without a verdict that counts.
    pub(super) fn end(&mut self) -> Vec<Arc<Inspected>> {
        let ids = self.spots.ids(Some(false));
        self.answer(Instant::now(), |_| Some(ids.clone()));
        self.spots.end()
    }

    /// Answers for all frames that came until then.
    fn answer(&mut self, until: Instant, ids_of: impl Fn(&AskedFrame) -> Option<SpotIds>) {
        let source = &self.source;
        self.asked.retain(|frame| {
            let is_due = frame.arrived <= until;
            if is_due
                && frame.source == *source
                && let Some(ids) = ids_of(frame)
            {
                // The receiver may be gone.
                let _ = frame.tell.send(ids);
            }
            !is_due
        });
    }
}

/// Gives the parts of a frame that is inspected again the hung parts that they were before.
pub(crate) fn assign_as_before(parts: &mut [Inspected], mut former: Vec<Arc<Inspected>>) {
    let is_one = parts.len() == 1 && former.len() == 1;
    let order = former[0].trace().clone();
    for part in parts {
        let shared = former.iter().map(|former| former.num_shared(part));
        let most = shared.enumerate().max_by_key(|(_, num)| *num);
        match most.filter(|(_, num)| is_one || *num > 0) {
            Some((index, _)) => {
                let former = former.remove(index);
                part.set_part(former.hung().clone(), former.trace().clone());
            }
            // The serial number is that of another part.
            None => part.set_part(
                part.hung().clone(),
                Traceability {
                    serial: String::new(),
                    ..order.clone()
                },
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::{sync::mpsc::TryRecvError, time::Duration};

    use super::*;
    use crate::inspection::{
        inspected::{InspectRequest, inspect_all, inspected_cell},
        library_cache::LibraryCache,
        source::{CellChoice, Origin, SceneSource},
    };
    use geometry::rigid::RigidTransform;
    use inspection::pipeline::{
        NamedRecipe, Recipe, Unwatched,
        live::{FrameRole, HungFrame, LiveVerdict, MotionState},
    };
    use simulate::{RackKind, RackSetup, SensorNoise, StandingRack};
    use stages::scene::{SceneCloud, scene_from_frame};

    /// A frame after which no verdict counts.
    fn frame_of<'a>(scene: &'a SceneCloud, inspection: &'a Inspection) -> HungFrame<'a> {
        HungFrame {
            scene,
            at: Duration::from_secs(1),
            inspection,
            verdict: &LiveVerdict::Open,
            middle: None,
            inputs: "",
        }
    }

    fn sources() -> [SourceSpec; 2] {
        ["simulated", "simulated:empty"].map(|text| text.parse().expect("a source"))
    }

    /// The only part whose id was sent.
    fn received(part: &Receiver<SpotIds>) -> Result<HungId, TryRecvError> {
        let ids = part.try_recv()?;
        let all: Vec<&HungId> = ids.all().collect();
        assert_eq!(all.len(), 1);
        Ok(all[0].clone())
    }

    fn next_part(parts: &mut FollowedParts) -> HungId {
        parts.spots.at(0).id_of_frame(true)
    }

    #[test]
    fn the_part_of_a_frame_is_told_once_a_frame_of_the_same_source_is_as_new() {
        let [one, other] = sources();
        let begun = Instant::now();
        let later = begun + Duration::from_secs(1);
        let mut parts = FollowedParts::default();
        // Before Live has seen anything.
        let part = parts.parts_of_frame(one.to_string(), later);
        let of_other = parts.parts_of_frame(other.to_string(), later);
        assert!(parts.begin(&one).is_empty());
        let seen = inspected_cell(CellChoice::InTurn, 1);
        parts.spots.see(0, &frame_of(&seen.scene, &seen.inspection));
        parts.seen(begun);
        assert_eq!(received(&part), Err(TryRecvError::Empty));
        parts.seen(later);
        assert_eq!(received(&part), Ok(next_part(&mut parts)));
        assert_eq!(received(&of_other), Err(TryRecvError::Disconnected));

        // Live goes on to another source before it has seen a frame as new, and whoever asks is still at the one before.
        let last = parts.parts_of_frame(one.to_string(), later);
        assert!(parts.begin(&other).is_empty());
        received(&last).expect("sent at the change");
        let late = parts.parts_of_frame(one.to_string(), later);
        parts.seen(later);
        assert_eq!(received(&late), Err(TryRecvError::Disconnected));
    }

    #[test]
    fn of_captures_that_stand_for_themselves_each_is_a_part() {
        let [one, _] = sources();
        let first = Instant::now();
        let second = first + Duration::from_secs(1);
        let mut parts = FollowedParts::default();
        let [of_first, of_second] =
            [first, second].map(|arrived| parts.parts_of_frame(one.to_string(), arrived));
        let inspected = || Arc::new(inspected_cell(CellChoice::InTurn, 1));
        let capture = inspected();
        assert!(parts.begin(&one).is_empty());
        parts.seen_alone(first, &[Arc::clone(&capture)]);
        assert_eq!(received(&of_first), Ok(capture.hung().clone()));
        assert_eq!(received(&of_second), Err(TryRecvError::Empty));
        // One that Live could not inspect.
        let after = second + Duration::from_secs(1);
        parts.seen_alone(after, &[inspected()]);
        assert_eq!(received(&of_second), Err(TryRecvError::Disconnected));
    }

    #[test]
    fn without_waiting_an_inspection_is_of_no_part_before_another_source() {
        let [one, other] = sources();
        let mut parts = FollowedParts::default();
        let part = parts.parts_of_frame(one.to_string(), Instant::now());
        assert!(parts.begin(&one).is_empty() && parts.end().is_empty());
        received(&part).expect("told at the end");
        let now = [&one, &other, &one].map(|source| {
            let ids = parts.ids_now(&source.to_string(), false);
            ids.and_then(|ids| ids.all().next().cloned())
        });
        assert!(now[1].is_none());
        assert_ne!(now[0], now[2], "nothing hangs there");
    }

    #[test]
    fn a_part_is_reported_as_wrong_while_its_label_names_another_part_or_none() {
        let mut parts = FollowedParts::default();
        let [part, next] = [HungId::new(), HungId::new()];
        for (label, is_reported) in [
            (Some(Truth::NotEnrolled), true),
            (Some(Truth::Part("fender".into())), false),
            (Some(Truth::Part("grille".into())), true),
            (None, false),
            (Some(Truth::Nothing), true),
        ] {
            parts.label(&part, label.as_ref());
            let expected = label.filter(|_| is_reported);
            assert_eq!(parts.reported_as(&part, "fender"), expected);
            assert_eq!(parts.reported_as(&next, "fender"), None);
        }
        // The next part has no label.
        parts.label(&next, None);
        assert!(parts.reported_as(&part, "fender").is_some());
    }

    #[test]
    fn a_capture_in_place_of_live_takes_the_serial_number_unless_its_part_has_one() {
        let [one, other] = sources();
        let mut parts = FollowedParts::default();
        assert!(parts.begin(&one).is_empty());
        let current = CurrentTrace::default();
        let capture = |parts: &mut FollowedParts, source: &SourceSpec| {
            current.set_serial("4712");
            let mut found = [inspected_cell(CellChoice::InTurn, 1)];
            found[0].entry.record.summary.source = source.to_string();
            parts.assign_capture(&mut found, &current);
            let serial = found[0].trace().serial.clone();
            (found[0].hung().clone(), serial, current.get().serial)
        };
        let (part, taken, left) = capture(&mut parts, &one);
        assert_eq!((part, &*taken, &*left), (next_part(&mut parts), "4712", ""));
        let its_own = Traceability {
            serial: "4711".into(),
            ..Traceability::default()
        };
        let next = next_part(&mut parts);
        parts.counts(next.clone(), its_own);
        let (_, taken, left) = capture(&mut parts, &one);
        assert_eq!((&*taken, &*left), ("4711", "4712"));
        let (part, taken, left) = capture(&mut parts, &other);
        assert_ne!(part, next);
        assert_eq!((&*taken, &*left), ("4712", ""));
    }

    #[test]
    fn a_capture_of_several_parts_is_of_the_parts_that_live_saw() {
        let setup = RackSetup::drawn(RackKind::Apart, 3, 0, 1).expect("in range");
        let rack = StandingRack::arrange(&setup).expect("in range");
        let mut recipe = Recipe::default();
        recipe.segment.max_parts = 3;
        let recipe = Arc::new(NamedRecipe::from(recipe));
        let taken = |seed, away: Option<usize>| {
            let here = |part| (Some(part) != away).then(RigidTransform::identity);
            let frame = rack.frame(here, &SensorNoise::kinect(seed));
            let request = InspectRequest {
                source: SceneSource::AtHand(
                    Arc::new(scene_from_frame(&frame)),
                    Origin::File {
                        path: "rack.png".into(),
                        is_simulated: true,
                    },
                ),
                recipe: Arc::clone(&recipe),
            };
            let parts = inspect_all(&request, &LibraryCache::default(), &Unwatched);
            let mut parts = parts.expect("inspected");
            for part in &mut parts {
                part.entry.record.summary.source = "rack".into();
            }
            parts
        };
        let mut parts = FollowedParts {
            source: "rack".into(),
            ..FollowedParts::default()
        };
        // Live sees two of them.
        let seen = taken(1, Some(1));
        let found: Vec<Inspection> = seen.iter().map(|one| one.inspection.clone()).collect();
        let scene = &seen[0].scene;
        let at_spots = (parts.spots).of_frame(&found, scene, MotionState::Watching, &recipe);
        assert_eq!(at_spots, [Some(0), Some(1)]);
        for (spot, inspection) in found.iter().enumerate() {
            let frame = frame_of(scene, inspection);
            assert_eq!(parts.spots.see(spot, &frame).1, FrameRole::Best);
        }
        let [left, right] = [0, 1].map(|spot| parts.spots.at(spot).id().clone());
        assert_ne!(left, right);
        // Their verdicts count, and the first took the serial number.
        let its_own = Traceability {
            serial: "4711".into(),
            ..Traceability::default()
        };
        parts.counts(left.clone(), its_own);
        parts.counts(right.clone(), Traceability::default());
        // The capture has one more, between them, which takes the next number.
        let current = CurrentTrace::default();
        current.set_serial("4712");
        let mut capture = taken(2, None);
        parts.assign_capture(&mut capture, &current);
        let serials: Vec<&str> = capture.iter().map(|one| &*one.trace().serial).collect();
        assert_eq!(serials, ["4711", "4712", ""]);
        assert_eq!(current.get().serial, "");
        let hung: Vec<&HungId> = capture.iter().map(Inspected::hung).collect();
        let names: Vec<_> = capture.iter().map(Inspected::part_title).collect();
        assert_eq!(hung.len(), 3, "{names:?}");
        assert_eq!([hung[0], hung[2]], [&left, &right], "{names:?}");
        assert!(![&left, &right].contains(&hung[1]));
        // Live sees that one next, and whoever asks about a frame is told the same.
        let ids = parts.spots.ids(Some(true));
        assert!(ids.all().any(|id| id == hung[1]));
        let again = taken(3, None);
        let found: Vec<Inspection> = again.iter().map(|one| one.inspection.clone()).collect();
        let ids = ids.of(&found, &again[0].scene, &recipe);
        assert_eq!(ids.iter().collect::<Vec<_>>(), hung);
    }
}
