//! Inspects scene after scene, and returns those whose verdicts count, with what to record of them.

use std::{
    collections::VecDeque,
    iter, mem,
    path::PathBuf,
    sync::Arc,
    time::{Duration, Instant},
};

use super::{Followed, Inspected, LineTracker, Moment, PartFollower, Subject};
use inspection::{
    library::Library,
    pipeline::{
        CheckedParts, Inspection, NamedRecipe, Unwatched, check_surfaces,
        live::{InspectionRate, SceneMotion, refuse_moving},
        run_all,
    },
};
use records::history::HungId;
use robot::RobotFrame;
use stages::scene::SceneCloud;

/// Inspects files, or what a source delivers. `E` is what is recorded of a part.
pub struct Station<E> {
    setup: StationSetup,
    following: Following<E>,
    /// Scenes of a followed source whose verdicts may still change, in order.
    waiting: VecDeque<InspectedScene>,
    /// Scenes whose verdicts count, in order: kept here in case the program fails at a later one.
    settled: Vec<InspectedScene>,
}

/// What scenes are inspected with.
#[derive(Clone, Debug, Default)]
pub struct StationSetup {
    /// The enrolled parts.
    pub library: Library,
    /// All parameters.
    pub recipe: NamedRecipe,
    /// Position of the camera in the robot's base frame, if the cell is calibrated.
    pub robot: Option<RobotFrame>,
    /// True to give a robot the pose of an accepted part despite doubts.
    pub is_forced: bool,
    /// The parts whose surfaces are checked.
    pub checked: CheckedParts,
}

/// How scenes belong together.
pub enum Following<E> {
    /// Each shows parts of its own.
    Independent,
    /// They show the parts that hang there, one after the other.
    Hanging(Box<PartFollower<E>>),
    /// They show the parts that a line carries past.
    Line(Box<LineTracker<E>>),
}

/// A scene to inspect.
pub struct SceneToInspect {
    /// Its file, or the name of the capture.
    pub path: PathBuf,
    /// The scene.
    pub scene: SceneCloud,
    /// What the history calls it.
    pub subject: Subject,
    /// When a source captured it.
    pub captured_at: Option<Instant>,
    /// Further frames of the same standing part, to average its surface.
    pub more: Vec<SceneCloud>,
    /// What a [`MotionWatch`](super::MotionWatch) knows after it, of a source of which not every frame is inspected.
    pub watched: Option<SceneMotion>,
}

/// An inspected scene.
pub struct InspectedScene {
    /// Its file, or the name of the capture.
    pub path: PathBuf,
    /// What the history calls it.
    pub subject: Subject,
    /// Its parts in the order of [`run_all`], at least one.
    pub parts: Vec<Inspection>,
    /// What is known of each on a line; empty without one.
    pub followed: Vec<Followed>,
    /// The scene that was inspected.
    pub scene: Arc<SceneCloud>,
    /// When a source captured it.
    captured_at: Option<Instant>,
    /// The same by the camera, of a source whose parts hang there.
    at: Duration,
}

/// What counts now.
pub struct Settled<E> {
    /// Scenes to show, in order.
    pub scenes: Vec<InspectedScene>,
    /// What to record.
    pub recorded: Vec<E>,
}

impl StationSetup {
    /// A part of a scene as it is recorded, of this subject.
    fn part<'a>(
        &'a self,
        scene: &'a InspectedScene,
        subject: &'a Subject,
        inspection: &'a Inspection,
    ) -> Inspected<'a> {
        Inspected {
            subject,
            scene: &scene.scene,
            inspection,
            recipe: &self.recipe,
            robot: self.robot.as_ref(),
            is_forced: self.is_forced,
            on_line: None,
        }
    }
}

impl<E> Station<E> {
    /// A station that has inspected nothing.
    pub fn new(setup: StationSetup, following: Following<E>) -> Self {
        Self {
            setup,
            following,
            waiting: VecDeque::new(),
            settled: Vec::new(),
        }
    }

    /// What scenes are inspected with.
    pub fn setup(&self) -> &StationSetup {
        &self.setup
    }

    /// True if scenes wait for a later one, which shows whether their parts hang still.
    pub fn is_waiting(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// True if parts hang before the source, so that it matters whether anything moves between the inspected frames.
    pub fn needs_motion(&self) -> bool {
        matches!(self.following, Following::Hanging(_))
    }

    /// The rate, if a verdict has waited two seconds or longer because fewer than half of the camera's frames are inspected.
    pub fn held_up_by(&self) -> Option<InspectionRate> {
        match &self.following {
            Following::Hanging(follower) => follower.held_up_by(),
            Following::Independent | Following::Line(_) => None,
        }
    }

    /// The parts of a scene as they are recorded.
    pub fn parts<'a>(&'a self, scene: &'a InspectedScene) -> Vec<Inspected<'a>> {
        let parts = scene.parts.iter().enumerate().map(|(index, inspection)| {
            let followed = scene.followed.get(index);
            let on_line = match &self.following {
                Following::Line(line) => followed.and_then(|part| part.on_line(line.line())),
                Following::Independent | Following::Hanging(_) => None,
            };
            Inspected {
                on_line,
                ..self.setup.part(scene, &scene.subject, inspection)
            }
        });
        parts.collect()
    }

    /// Inspects the next scene. Where parts hang one after the other, its verdicts may only count with a later one. `entry`
    /// gets a part to record, which hung part it is, and when it was captured.
    pub fn next(
        &mut self,
        scene: SceneToInspect,
        entry: impl Fn(&Inspected<'_>, HungId, Option<Instant>) -> E,
    ) -> Settled<E> {
        let mut scene = self.inspected(scene);
        let setup = &self.setup;
        let captured_at = scene.captured_at;
        match &mut self.following {
            Following::Independent => {
                let recorded = scene.parts.iter().map(|part| {
                    let part = setup.part(&scene, &scene.subject, part);
                    entry(&part, HungId::new(), captured_at)
                });
                Settled {
                    recorded: recorded.collect(),
                    scenes: vec![scene],
                }
            }
            Following::Line(line) => {
                let capture = scene.subject.capture.as_ref();
                let at = capture.map(|capture| line.exposed_at(capture.taken_at));
                let moment = Moment {
                    at: at.unwrap_or_default(),
                    count: None,
                };
                let mut parts = mem::take(&mut scene.parts);
                let (followed, recorded) = line.see(
                    moment,
                    &mut parts,
                    |part| part.middle(&setup.library),
                    |_, part, on_line| {
                        let part = Inspected {
                            on_line,
                            ..setup.part(&scene, &scene.subject, part)
                        };
                        entry(&part, HungId::new(), captured_at)
                    },
                );
                (scene.parts, scene.followed) = (parts, followed);
                Settled {
                    scenes: vec![scene],
                    recorded,
                }
            }
            Following::Hanging(_) => {
                // Earlier ones first: a part that they show may be recorded now.
                self.settle(&scene.parts, &entry);
                let recorded = self.follow(&scene, &entry);
                let last = scene.parts.clone();
                self.waiting.push_back(scene);
                self.settle(&last, &entry);
                Settled {
                    scenes: mem::take(&mut self.settled),
                    recorded,
                }
            }
        }
    }

    /// Inspects a scene that only shows whether the parts of earlier ones hang still.
    pub fn check(
        &mut self,
        scene: SceneToInspect,
        entry: impl Fn(&Inspected<'_>, HungId, Option<Instant>) -> E,
    ) -> Settled<E> {
        let scene = self.inspected(scene);
        self.settle(&scene.parts, &entry);
        Settled {
            scenes: mem::take(&mut self.settled),
            recorded: Vec::new(),
        }
    }

    /// Ends the source. Before a camera, a part that is not known to hang still is refused; of a recording, it stays unknown.
    pub fn end(
        &mut self,
        is_replayed: bool,
        entry: impl Fn(&Inspected<'_>, HungId, Option<Instant>) -> E,
    ) -> Settled<E> {
        while let Some(mut scene) = self.waiting.pop_front() {
            if is_replayed {
                scene.subject.is_motion_unchecked = true;
            } else {
                for part in &mut scene.parts {
                    refuse_moving(part);
                }
            }
            self.has_settled(scene, &entry);
        }
        let recorded = match mem::replace(&mut self.following, Following::Independent) {
            Following::Independent => Vec::new(),
            Following::Hanging(follower) => follower.end(),
            Following::Line(line) => line.end(),
        };
        Settled {
            scenes: mem::take(&mut self.settled),
            recorded,
        }
    }

    fn inspected(&mut self, scene: SceneToInspect) -> InspectedScene {
        let SceneToInspect {
            path,
            scene,
            subject,
            captured_at,
            more,
            watched,
        } = scene;
        let mut scene = Arc::new(scene);
        if let (Following::Hanging(follower), Some(capture)) =
            (&mut self.following, &subject.capture)
        {
            scene = follower.look(scene, capture.taken_at, capture.number, watched);
        }
        let StationSetup {
            library,
            recipe,
            checked,
            ..
        } = &self.setup;
        let mut parts = run_all(&scene, library, recipe, &Unwatched).expect("not cancelled");
        if *checked != CheckedParts::default() || !more.is_empty() {
            let frames: Vec<&SceneCloud> = iter::once(&*scene).chain(&more).collect();
            check_surfaces(&mut parts, &frames, library, *checked);
        }
        let mut at = Duration::ZERO;
        if let Following::Hanging(follower) = &mut self.following {
            follower.refuse_if_moving(&mut parts);
            at = follower.at();
        }
        InspectedScene {
            path,
            subject,
            parts,
            followed: Vec::new(),
            scene,
            captured_at,
            at,
        }
    }

    /// Settles the waiting scenes whose verdicts count now that the last scene had these inspections.
    fn settle(
        &mut self,
        last: &[Inspection],
        entry: &impl Fn(&Inspected<'_>, HungId, Option<Instant>) -> E,
    ) {
        while let (Some(scene), Following::Hanging(follower)) =
            (self.waiting.front_mut(), &self.following)
        {
            let mut accepted = (scene.parts.iter_mut()).filter(|part| part.verdict.is_accepted());
            let is_settled = accepted.all(|part| {
                let middle = part.middle(&self.setup.library);
                follower.settle(part, scene.at, last, middle)
            });
            if !is_settled {
                break;
            }
            let Some(scene) = self.waiting.pop_front() else {
                break;
            };
            self.has_settled(scene, entry);
        }
    }

    /// Adds a scene to those whose verdicts count. If it is recorded because its part leaves, then with the verdict that it has
    /// now.
    fn has_settled(
        &mut self,
        scene: InspectedScene,
        entry: &impl Fn(&Inspected<'_>, HungId, Option<Instant>) -> E,
    ) {
        // First, in case the program fails below.
        self.settled.push(scene);
        if let (Following::Hanging(follower), Some(scene)) =
            (&mut self.following, self.settled.last())
        {
            let setup = &self.setup;
            follower.settled(scene.at, |index, hung| {
                let part = setup.part(scene, &scene.subject, &scene.parts[index]);
                entry(&part, hung, scene.captured_at)
            });
        }
    }

    /// Returns what to record of the parts that the scenes up to this one show.
    fn follow(
        &mut self,
        scene: &InspectedScene,
        entry: &impl Fn(&Inspected<'_>, HungId, Option<Instant>) -> E,
    ) -> Vec<E> {
        let Following::Hanging(follower) = &mut self.following else {
            return Vec::new();
        };
        let setup = &self.setup;
        follower.take(
            &scene.scene,
            scene.parts.clone(),
            |part| part.middle(&setup.library),
            &setup.recipe,
            |inspection, hung, is_still| {
                let subject = Subject {
                    is_motion_unchecked: !is_still,
                    ..scene.subject.clone()
                };
                let part = setup.part(scene, &subject, inspection);
                entry(&part, hung, scene.captured_at)
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use capture::{Captured, CellScene, SimulatedCell, SimulatedSpec, SourceSpec};
    use geometry::error::guarded;
    use inspection::fixtures::shipped_library;

    #[test]
    fn a_fault_at_one_frame_costs_no_other_one() {
        let spec = SimulatedSpec {
            scene: CellScene::Part(simulate::PartKind::Fender),
            frames_per_second: 10.0,
            ..SimulatedSpec::default()
        };
        let source = SourceSpec::Simulated(spec.clone());
        let mut cell = SimulatedCell::new(spec);
        let mut scenes = crate::CameraScenes::default();
        let mut next = |number: u64| -> SceneToInspect {
            let (image, _) = cell.frame(number);
            let captured = Captured {
                taken_at: jiff::Timestamp::UNIX_EPOCH
                    + jiff::SignedDuration::from_millis(100 * number as i64),
                ..Captured::now(number, number.to_string(), image)
            };
            SceneToInspect {
                path: (&captured.name).into(),
                subject: Subject::of_capture(&captured, &source, 0),
                captured_at: None,
                more: Vec::new(),
                watched: None,
                scene: scenes.next(captured.image),
            }
        };
        let setup = StationSetup {
            library: shipped_library(),
            ..StationSetup::default()
        };
        let following = Following::Hanging(Box::default());
        let mut station = Station::new(setup, following);
        let (mut shown, mut failed) = (Vec::new(), Vec::new());
        let path = |scene: &InspectedScene| scene.path.display().to_string();
        for number in 1..=20 {
            let scene = next(number);
            // From here on, earlier frames settle.
            let is_broken = number >= 10 && failed.is_empty();
            let entry = |_: &Inspected<'_>, _, _| assert!(!is_broken, "a fault of the program");
            match guarded(|| station.next(scene, entry)) {
                Ok(settled) => shown.extend(settled.scenes.iter().map(path)),
                Err(_) => failed.push(number.to_string()),
            }
        }
        let last = station.end(true, |_, _, _| ());
        shown.extend(last.scenes.iter().map(path));
        assert!(!failed.is_empty(), "{shown:?}");
        shown.extend(failed);
        shown.sort_by_key(|name| name.parse::<u64>().expect("a number"));
        let all: Vec<String> = (1..=20).map(|number| u64::to_string(&number)).collect();
        assert_eq!(shown, all);
    }
}
