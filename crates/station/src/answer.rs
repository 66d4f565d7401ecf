//! The answer to a trigger: a frame is inspected, checked for motion, and converted for robots.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use super::{
    Camera, Inspected, NoFrame, PartFinder, Subject, finder::numbered_place,
    inspected::inspections_of, motion::time_of,
};
use capture::Captured;
use inspection::{
    library::Library,
    pipeline::{Inspection, NamedRecipe, Recipe, Unwatched, run_all},
};
use records::history::Traceability;
use robot::RobotFrame;
use serve::{AskedOrder, ExpectedNumbers, Found, FrameFacts, FrameParts, VerdictCode};
use stages::scene::SceneCloud;

/// What triggers are answered with.
pub struct Answering<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// Numbers of the parts, and the robot's frame.
    pub finder: &'a PartFinder,
    /// The library, prepared for the recipe.
    pub library: &'a Library,
    /// The recipe.
    pub recipe: &'a NamedRecipe,
    /// Numbers of the parts that should hang there, and zeros; all zero to expect what the recipe does.
    pub expected: ExpectedNumbers,
    /// How long a later frame is waited for.
    pub at_most: Duration,
    /// Returns true once the service is ending.
    pub is_ending: &'a dyn Fn() -> bool,
}

/// An inspection and its answer.
#[derive(Clone, Debug)]
pub struct Answered {
    /// What was inspected, and whether it was checked that the part hung still.
    pub subject: Subject,
    /// The result for the client; the report of the first part is the line of JSON.
    pub found: FrameParts,
    /// The scene that was inspected.
    pub scene: Arc<SceneCloud>,
    /// The results of all stages for each part, in the order of `found`, which has the missing parts behind them.
    pub inspections: Vec<Inspection>,
    /// The recipe, with what was expected.
    pub recipe: NamedRecipe,
}

impl Answered {
    /// The parts, to be shown and recorded. `robot` is the frame of the numbers that were sent.
    pub fn parts<'a>(&'a self, robot: &'a RobotFrame) -> Vec<Inspected<'a>> {
        let (subject, scene) = (&self.subject, &self.scene);
        let mut parts = parts_of(subject, scene, &self.inspections, &self.recipe, robot);
        for (part, found) in parts.iter_mut().zip(self.found.iter()) {
            part.on_line = found.on_line.filter(|_| found.pose.is_some());
        }
        parts
    }
}

/// What a trigger is traced by that names an order: a serial number is of the present order, unless another one is named.
/// Without either, `own`.
pub fn traced(asked: &AskedOrder, own: &Traceability) -> Traceability {
    if !asked.is_given() {
        return own.clone();
    }
    let AskedOrder { order, serial } = asked.clone();
    Traceability {
        order: if order.is_empty() {
            own.order.clone()
        } else {
            order
        },
        serial,
        operator: own.operator.clone(),
    }
}

pub(super) fn parts_of<'a>(
    subject: &'a Subject,
    scene: &'a Arc<SceneCloud>,
    inspections: &'a [Inspection],
    recipe: &'a NamedRecipe,
    robot: &'a RobotFrame,
) -> Vec<Inspected<'a>> {
    let part = |inspection| inspected_of(subject, scene, inspection, recipe, robot);
    inspections.iter().map(part).collect()
}

/// A part as it is shown and recorded.
pub(super) fn inspected_of<'a>(
    subject: &'a Subject,
    scene: &'a Arc<SceneCloud>,
    inspection: &'a Inspection,
    recipe: &'a NamedRecipe,
    robot: &'a RobotFrame,
) -> Inspected<'a> {
    Inspected {
        subject,
        scene,
        inspection,
        recipe,
        robot: Some(robot),
        is_forced: false,
        on_line: None,
    }
}

impl Answering<'_> {
    /// Inspects a frame that was captured after a trigger. `scene_of` makes scenes of its camera's frames. An error has to
    /// be answered instead.
    pub fn answer(
        &self,
        captured: Captured,
        mut subject: Subject,
        trace: &Traceability,
        mut scene_of: impl FnMut(Captured) -> Arc<SceneCloud>,
    ) -> Result<Answered, NoFrame> {
        let expected = (self.finder).expected(&self.expected, &self.recipe.rack, self.library)?;
        let recipe = self.recipe.expecting(expected);
        let inspected = |scene: &SceneCloud| {
            run_all(scene, self.library, &recipe, &Unwatched).expect("not cancelled")
        };
        let middle_of = |part: &Inspection| part.middle(self.library);
        let (captured_at, at) = (self.camera.captured_at(&captured), time_of(&captured));
        let scene = scene_of(captured);
        let mut inspections = inspected(&scene);
        let is_checked = self.camera.refuse_if_moving(
            at,
            &mut inspections,
            middle_of,
            self.at_most,
            self.is_ending,
            |later| inspected(&scene_of(later)),
        )?;
        subject.is_motion_unchecked |= !is_checked;
        let robot = &self.finder.robot;
        let parts = parts_of(&subject, &scene, &inspections, &recipe, robot);
        let mut found = self.found(&parts, captured_at);
        found.first.report = Inspected::line_of_all(&parts, trace);
        Ok(Answered {
            subject,
            found,
            scene,
            inspections,
            recipe,
        })
    }
}

impl Answering<'_> {
    /// The results for the parts of a frame of this time, and for the expected ones that are missing.
    pub(super) fn found(&self, parts: &[Inspected<'_>], captured_at: Instant) -> FrameParts {
        let Recipe { expected, rack, .. } = &**parts[0].recipe;
        let all = parts.iter();
        let mut all: Vec<Found> = all
            .map(|part| self.finder.found(part, captured_at))
            .collect();
        let missing = expected.missing(&inspections_of(parts)).into_iter();
        let missing = missing.map(|part| self.finder.missing(part, rack, self.library, &all[0]));
        let missing: Vec<Found> = missing.collect();
        let empty_places = Inspected::empty_places(parts).into_iter();
        let empty_places = empty_places.filter_map(|name| numbered_place(rack, Some(name)));
        let facts = FrameFacts {
            rack: Some(rack.name.clone()).filter(|name| !name.is_empty()),
            empty_places: (!rack.places.is_empty()).then(|| empty_places.collect()),
            missing: (!expected.is_empty()).then(|| missing.iter().map(Into::into).collect()),
        };
        if !missing.is_empty() {
            // Where nothing can be recognised, this is what is missing.
            all.retain(|found| found.verdict != VerdictCode::NoPart);
        }
        let mut all = all.into_iter().chain(missing);
        FrameParts {
            first: all.next().expect("an inspection has a verdict"),
            others: all.collect(),
            facts: Arc::new(facts),
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;
    use crate::NumberedPart;
    use capture::SourceSpec;
    use geometry::{oriented_box::OrientedBox, rigid::RigidTransform, units::Radians};
    use inspection::fixtures::shipped_library;
    use serve::{Answer, Asked, MissingPart, PoseKind, RackPlace};
    use stages::{
        rack::{MaxTurn, Place, Rack},
        scene::scene_from_image,
    };

    /// Long enough for a busy machine; normally what is waited for comes at once.
    const PATIENCE: Duration = Duration::from_mins(10);

    /// Numbers the parts of a library from 1.
    fn finder(library: &Library) -> PartFinder {
        let parts = (1..).zip(&library.references);
        let parts = parts.map(|(number, _)| NumberedPart {
            number,
            ..NumberedPart::default()
        });
        PartFinder {
            parts: parts.collect(),
            robot: RobotFrame {
                robot_from_camera: RigidTransform::translation(1.0, 2.0, 3.0),
                name: "cell 1".into(),
            },
            kind: PoseKind::RobotFromPart,
        }
    }

    #[test]
    fn a_trigger_is_traced_by_what_it_names_and_by_nothing_of_another_part() {
        let trace = |serial: &str, order: &str| Traceability {
            serial: serial.into(),
            order: order.into(),
            operator: "Ada".into(),
        };
        let own = trace("TL-1", "4711");
        for (order, serial, expected) in [
            ("", "", trace("TL-1", "4711")),
            ("4712", "", trace("", "4712")),
            ("", "TL-2", trace("TL-2", "4711")),
            ("4712", "TL-2", trace("TL-2", "4712")),
        ] {
            let asked = AskedOrder::new(order, serial).expect("plain");
            assert_eq!(traced(&asked, &own), expected, "{asked:?}");
        }
    }

    #[test]
    fn a_trigger_is_answered_from_the_inspection_that_its_line_tells_of() {
        let (library, recipe) = (shipped_library(), NamedRecipe::default());
        let finder = finder(&library);
        let source: SourceSpec = "simulated:fender".parse().expect("a source");
        let camera = Camera::start(&source).expect("started");
        let frame = camera.frame_after(&Asked::now(), PATIENCE, || false);
        let frame = frame.expect("a frame");
        let subject = Subject::of_capture(&frame, &source, 0);
        let answering = Answering {
            camera: &camera,
            finder: &finder,
            library: &library,
            recipe: &recipe,
            expected: ExpectedNumbers::default(),
            at_most: PATIENCE,
            is_ending: &|| false,
        };
        let mut num_scenes = 0;
        let trace = Traceability::default();
        let answered = answering.answer(frame, subject, &trace, |captured| {
            num_scenes += 1;
            Arc::new(scene_from_image(captured.image))
        });
        let Answered {
            found,
            inspections,
            subject,
            ..
        } = answered.expect("a second frame");
        let found = found.first;
        assert_eq!(found.verdict, VerdictCode::Accepted, "{:?}", found.problem);
        assert_eq!(num_scenes, 2, "looked for again in a later frame");
        assert_eq!((&*found.part, found.marks), ("fender", Answer::SIMULATED));
        let pose = inspections[0].found_pose().expect("accepted");
        let pose = finder.robot.robot_from_part(&pose.camera_from_part());
        assert_eq!(found.pose, Some(pose));
        let line: Value = serde_json::from_str(&found.report).expect("JSON");
        assert_eq!(line["scene"], Value::from(subject.scene));
        assert_eq!(line["source"], source.to_string());
        assert_eq!(line["robot"]["calibration"], "cell 1");
        let cancelled = answering_at_the_end(&answering);
        assert_eq!(cancelled.reason(), "stopping");
    }

    /// A rack with a hook at which everything hangs, and one far away.
    fn two_hooks() -> Rack {
        let place = |name: &str, x: f64| Place {
            name: name.into(),
            region: OrientedBox {
                centre_m: [x, 0.0, 2.0],
                size_m: [4.0; 3],
                angles_rad: [0.0; 3],
            },
            max_turn: MaxTurn::Total(Radians(1.0)),
            parts: Vec::new(),
        };
        Rack {
            name: "rack A".into(),
            places: vec![place("left hook", 0.0), place("right hook", 9.0)],
            ..Rack::default()
        }
    }

    /// A camera before a simulated fender.
    struct FenderStation {
        library: Library,
        finder: PartFinder,
        source: SourceSpec,
        camera: Camera,
    }

    impl FenderStation {
        fn new() -> Self {
            let library = shipped_library();
            let source: SourceSpec = "simulated:fender".parse().expect("a source");
            Self {
                finder: finder(&library),
                camera: Camera::start(&source).expect("started"),
                library,
                source,
            }
        }

        fn number_of(&self, name: &str) -> u32 {
            let mut numbered = self.finder.parts.iter().zip(&self.library.references);
            let part = numbered.find(|(_, reference)| reference.name == name);
            part.expect("enrolled").0.number
        }

        /// The answer to a trigger that expects these parts, each with its place.
        fn answered(
            &self,
            recipe: &NamedRecipe,
            numbers: &[[u32; 2]],
        ) -> Result<FrameParts, NoFrame> {
            let frame = self.camera.frame_after(&Asked::now(), PATIENCE, || false);
            let frame = frame.expect("a frame");
            let subject = Subject::of_capture(&frame, &self.source, 0);
            let mut expected = ExpectedNumbers::default();
            for (one, [place, part]) in expected.iter_mut().zip(numbers) {
                (one.place, one.part) = (*place, *part);
            }
            let answering = Answering {
                camera: &self.camera,
                finder: &self.finder,
                library: &self.library,
                recipe,
                expected,
                at_most: PATIENCE,
                is_ending: &|| false,
            };
            let trace = Traceability::default();
            let answered = answering.answer(frame, subject, &trace, |captured| {
                Arc::new(scene_from_image(captured.image))
            });
            answered.map(|answered| answered.found)
        }
    }

    fn shown(found: &FrameParts) -> Vec<(VerdictCode, String, String)> {
        let parts = found.iter().map(|part| {
            assert_eq!(part.pose.is_some(), part.verdict == VerdictCode::Accepted);
            let reason = part.problem.reason.clone();
            (part.verdict, part.part.clone(), reason)
        });
        parts.collect()
    }

    #[test]
    fn a_part_that_is_not_expected_is_refused_and_what_is_missing_is_said() {
        let (station, recipe) = (FenderStation::new(), NamedRecipe::default());
        let answered = |numbers: &[u32]| {
            let numbers: Vec<[u32; 2]> = numbers.iter().map(|&number| [0, number]).collect();
            station.answered(&recipe, &numbers)
        };
        let (fender, grille) = (station.number_of("fender"), station.number_of("grille"));
        let part = |verdict, name: &str, reason: &str| (verdict, name.into(), reason.into());
        let accepted = part(VerdictCode::Accepted, "fender", "");
        let found = answered(&[]).expect("inspected");
        assert_eq!(shown(&found), std::slice::from_ref(&accepted));
        assert_eq!(
            (&found.first.place, &*found.facts),
            (&None, &FrameFacts::default())
        );
        let found = answered(&[fender]).expect("inspected");
        assert_eq!(shown(&found), std::slice::from_ref(&accepted));
        let line: Value = serde_json::from_str(&found.first.report).expect("JSON");
        assert_eq!(line["as_expected"], true);
        let found = answered(&[grille, fender]).expect("inspected");
        let missing = part(VerdictCode::NoPart, "grille", "missing");
        assert_eq!(shown(&found), [accepted.clone(), missing]);
        assert_eq!(found.others[0].number, grille);
        let line: Value = serde_json::from_str(&found.first.report).expect("JSON");
        assert_eq!(line["missing"], serde_json::json!(["grille"]));
        let found = answered(&[grille]).expect("inspected");
        let wrong = part(VerdictCode::Refused, "fender", "wrong_part");
        assert_eq!(shown(&found), [wrong]);
        let unknown = answered(&[99]).expect_err("no such part");
        assert_eq!(unknown.reason(), "unknown_number");
    }

    #[test]
    fn a_part_hangs_at_its_place_of_the_rack_and_what_is_missing_at_another() {
        let station = FenderStation::new();
        let in_rack = NamedRecipe::default().in_rack(two_hooks());
        let (fender, grille) = (station.number_of("fender"), station.number_of("grille"));
        let accepted = (VerdictCode::Accepted, "fender".into(), String::new());
        let answered = |numbers: &[[u32; 2]]| station.answered(&in_rack, numbers);
        let found = answered(&[[1, fender]]).expect("inspected");
        assert_eq!(shown(&found), std::slice::from_ref(&accepted));
        let hook = |number, name: &str| RackPlace {
            number,
            name: name.into(),
        };
        assert_eq!(found.first.place, Some(hook(1, "left hook")));
        let mut facts = FrameFacts {
            rack: Some("rack A".into()),
            empty_places: Some(vec![hook(2, "right hook")]),
            missing: Some(Vec::new()),
        };
        assert_eq!(*found.facts, facts);
        let found = answered(&[[1, grille]]).expect("inspected");
        assert_eq!(shown(&found)[0].2, "wrong_part");
        let found = answered(&[[2, fender]]).expect("inspected");
        assert_eq!(shown(&found)[0].2, "expected_elsewhere");
        let found = answered(&[[1, fender], [2, grille]]).expect("inspected");
        assert_eq!(shown(&found)[1].2, "missing");
        let what = "grille is expected at right hook, and does not hang there";
        assert!(found.others[0].problem.message.contains(what));
        assert_eq!(found.others[0].place, Some(hook(2, "right hook")));
        facts.missing = Some(vec![MissingPart {
            part: "grille".into(),
            number: Some(grille),
            place: Some(hook(2, "right hook")),
        }]);
        assert_eq!(*found.facts, facts);
        let line: Value = serde_json::from_str(&found.first.report).expect("JSON");
        assert_eq!(line["expected"], serde_json::json!(["fender", "grille"]));
        let places = serde_json::json!(["left hook", "right hook"]);
        assert_eq!(line["expected_places"], places);
        assert_eq!(line["missing"], serde_json::json!(["grille"]));
        assert_eq!(line["missing_places"], serde_json::json!(["right hook"]));
        for (numbers, why) in [
            (&[[3, fender]][..], "unknown_place"),
            (&[[2, fender], [2, grille]], "place_twice"),
        ] {
            let error = answered(numbers).expect_err(why);
            assert_eq!(error.reason(), why);
        }
    }

    /// An accepted part that cannot be looked for again, because the service ends, is not answered.
    fn answering_at_the_end(answering: &Answering<'_>) -> NoFrame {
        let frame = answering
            .camera
            .frame_after(&Asked::now(), PATIENCE, || false)
            .expect("a frame");
        let source = "simulated:fender".parse().expect("a source");
        let subject = Subject::of_capture(&frame, &source, 0);
        let ending = Answering {
            is_ending: &|| true,
            ..*answering
        };
        let answered = ending.answer(frame, subject, &Traceability::default(), |captured| {
            Arc::new(scene_from_image(captured.image))
        });
        answered.expect_err("nothing to compare with")
    }
}
