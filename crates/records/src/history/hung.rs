//! Identity of a hung part, and which of its inspections are written while a source is followed.

use std::{
    fmt,
    sync::atomic::{AtomicU32, Ordering},
};

use serde::{Deserialize, Serialize};

use super::entry::NewEntry;
use inspection::pipeline::live::{FrameRole, HungFrame, HungParts, Left};

/// Identifies a part while it hangs in the cell; all its inspections share the identifier.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct HungId(pub(super) String);

/// Counts this program's parts, which keeps the identifiers of simultaneous ones distinct.
static COUNT: AtomicU32 = AtomicU32::new(0);

impl HungId {
    /// Creates the identifier of a part that has not been inspected before.
    #[expect(clippy::new_without_default, reason = "each is another")]
    pub fn new() -> Self {
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let at = geometry::clock::now().as_microsecond();
        Self(format!("{at}-{}-{number}", std::process::id()))
    }
}

impl fmt::Display for HungId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Selects the inspections to write of the parts that hang at one spot while a source is followed: one for each.
#[derive(Debug)]
pub struct HungRows<E = NewEntry> {
    parts: HungParts,
    id: HungId,
    /// Identifier of the part that hangs there next.
    next: HungId,
    visit: u64,
    departures: u64,
    /// The best entry of a part whose verdict does not count yet.
    best: Option<E>,
}

impl<E> Default for HungRows<E> {
    fn default() -> Self {
        Self {
            parts: HungParts::default(),
            id: HungId::new(),
            next: HungId::new(),
            visit: 0,
            departures: 0,
            best: None,
        }
    }
}

impl<E> HungRows<E> {
    /// Returns the role that [`see`](Self::see) would give the frame, without taking it in.
    pub fn role_of(&self, frame: &HungFrame<'_>) -> FrameRole {
        self.parts.clone().see(frame).1
    }

    /// Takes in a frame. Returns the best inspection of a part that left before its verdict counted, and the role of
    /// the frame for the present part: pass the best one to [`hold`](Self::hold); write the first and every further one
    /// under [`id`](Self::id).
    pub fn see(&mut self, frame: &HungFrame<'_>) -> (Option<E>, FrameRole) {
        let (left, role) = self.parts.see(frame);
        let best = self.best.take_if(|_| left != Left::Nothing);
        let left = best.filter(|_| left == Left::Part);
        if self.parts.departures() != self.departures {
            self.departures = self.parts.departures();
            self.next = HungId::new();
        }
        if self.parts.visit() != self.visit {
            self.visit = self.parts.visit();
            self.id = std::mem::replace(&mut self.next, HungId::new());
        }
        if role == FrameRole::First {
            self.best = None;
        }
        (left, role)
    }

    /// Returns the identifier of the part that hangs there now, or hung there last.
    pub fn id(&self) -> &HungId {
        &self.id
    }

    /// The part that a frame shows which was inspected beside those of [`see`](Self::see), and taken about when the last of
    /// those was. `shows_part` says whether that last one shows a part: if so, and the part before has left, it is the
    /// next part already. What is inspected while nothing hangs there is of no part, and gets an id of its own.
    pub fn id_of_frame(&self, shows_part: bool) -> HungId {
        if self.parts.is_hanging() {
            self.id.clone()
        } else if shows_part {
            self.next.clone()
        } else {
            HungId::new()
        }
    }

    /// True while nothing hangs there.
    pub(super) fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    pub(super) fn parts(&self) -> &HungParts {
        &self.parts
    }

    /// Keeps the frame that shows the part best, until its verdict counts or it leaves.
    pub fn hold(&mut self, best: E) {
        self.best = Some(best);
    }

    /// True while the inspection of a part is held whose verdict does not count yet.
    pub fn is_holding(&self) -> bool {
        self.best.is_some()
    }

    /// Takes the held inspection of a part whose verdict does not count yet, because nobody may see the part leave. Seen
    /// again, it is the same part.
    pub fn take_best(&mut self) -> Option<E> {
        self.best.take()
    }

    /// Ends the source. Returns the held inspection of a part whose verdict does not count yet.
    pub fn end(&mut self) -> Option<E> {
        self.parts = HungParts::default();
        self.next = HungId::new();
        (self.visit, self.departures) = (0, 0);
        self.best.take()
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use inspection::{
        fixtures::shipped_library,
        library::Library,
        pipeline::{
            Inspection, Recipe, Unwatched,
            live::{ConsensusVerdict, LiveVerdict},
            run,
        },
    };
    use simulate::{CellSetup, PartKind, PartPose, PoseRange, SensorNoise, Side, SimulatedObject};
    use stages::{fixtures::scene_of, scene::SceneCloud};

    const FENDER: SimulatedObject = SimulatedObject::Part {
        kind: PartKind::Fender,
        side: Side::Left,
        model_seed: 0,
    };

    /// A frame of the same cell, as it was inspected by itself.
    struct Seen {
        scene: SceneCloud,
        inspection: Inspection,
    }

    impl Seen {
        fn of(library: &Library, subject: SimulatedObject) -> Self {
            let mut setup = CellSetup::new(subject, 3);
            setup.noise = SensorNoise::kinect(5);
            if subject != SimulatedObject::Nothing {
                let placed = PoseRange::facing().draw(&subject.mesh(), &setup.intrinsics, 3);
                setup.pose = PartPose::Fixed(placed.camera_from_part);
            }
            let scene = scene_of(&setup);
            let inspection = run(&scene, library, &Recipe::default(), &Unwatched);
            Self {
                inspection: inspection.expect("not cancelled"),
                scene,
            }
        }

        /// Its own verdict, once that counts.
        fn counted(&self) -> LiveVerdict {
            LiveVerdict::Counted(Box::new(ConsensusVerdict {
                verdict: self.inspection.verdict.clone(),
                num_frames: 5,
                num_agreeing: 5,
                pose: None,
            }))
        }
    }

    /// Follows such frames, four a second.
    #[derive(Default)]
    struct Line {
        rows: HungRows<()>,
        num_frames: u32,
    }

    impl Line {
        fn open(&mut self, seen: &Seen) -> FrameRole {
            self.see(seen, &LiveVerdict::Open)
        }

        /// A frame after which its own verdict counts.
        fn counted(&mut self, seen: &Seen) -> FrameRole {
            self.see(seen, &seen.counted())
        }

        fn see(&mut self, seen: &Seen, verdict: &LiveVerdict) -> FrameRole {
            self.num_frames += 1;
            let (_, role) = self.rows.see(&HungFrame {
                scene: &seen.scene,
                at: Duration::from_millis(250) * self.num_frames,
                inspection: &seen.inspection,
                verdict,
                middle: None,
                inputs: "",
            });
            role
        }
    }

    #[test]
    fn an_inspection_beside_those_that_are_followed_is_of_the_part_that_hangs_there() {
        let library = shipped_library();
        let fender = Seen::of(&library, FENDER);
        let empty = Seen::of(&library, SimulatedObject::Nothing);
        let mut line = Line::default();
        // Before and after its verdict counts.
        line.open(&fender);
        let first = line.rows.id_of_frame(true);
        assert_eq!(line.counted(&fender), FrameRole::First);
        assert_eq!(*line.rows.id(), first);
        assert_eq!(line.rows.id_of_frame(true), first);
        // A frame that misses it.
        assert_eq!(line.rows.id_of_frame(false), first);

        // It was exchanged, and the other one is still moving.
        line.open(&empty);
        assert_ne!(line.rows.id_of_frame(false), first, "nothing hangs there");
        line.open(&fender);
        let second = line.rows.id_of_frame(true);
        assert_ne!(second, first);
        assert_eq!(line.rows.id_of_frame(true), second);
        assert_eq!(line.counted(&fender), FrameRole::First);
        assert_eq!(*line.rows.id(), second);

        // Something that hangs there only for a moment is not the part that comes after it.
        line.open(&empty);
        line.open(&fender);
        let passing = line.rows.id_of_frame(true);
        for _ in 0..4 {
            line.open(&empty);
        }
        assert_eq!(line.open(&fender), FrameRole::Best);
        let third = line.rows.id().clone();
        assert!(![first, second, passing].contains(&third));

        // The source has ended: nothing hangs there any more.
        assert!(line.rows.end().is_none());
        assert_ne!(line.rows.id_of_frame(false), third);
        line.open(&fender);
        assert_ne!(*line.rows.id(), third);
    }

    #[test]
    fn a_frame_that_is_only_asked_about_is_not_taken_for_recorded() {
        let fender = Seen::of(&shipped_library(), FENDER);
        let open = HungFrame {
            scene: &fender.scene,
            at: Duration::ZERO,
            inspection: &fender.inspection,
            verdict: &LiveVerdict::Open,
            middle: None,
            inputs: "",
        };
        let counted = fender.counted();
        let settled = HungFrame {
            at: Duration::from_millis(150),
            verdict: &counted,
            ..open
        };
        let mut rows = HungRows::<&str>::default();
        assert_eq!(rows.role_of(&open), FrameRole::Best);
        assert_eq!(rows.see(&open), (None, FrameRole::Best));
        rows.hold("refused");
        // Following stops here, and goes on: it is the same part.
        let id = rows.id().clone();
        assert_eq!(rows.take_best(), Some("refused"));
        assert_eq!(rows.take_best(), None);
        for _ in 0..2 {
            assert_eq!(rows.role_of(&settled), FrameRole::First);
        }
        assert_eq!(rows.see(&settled), (None, FrameRole::First));
        assert_eq!(rows.role_of(&settled), FrameRole::Nothing);
        assert_eq!(*rows.id(), id);
    }
}
