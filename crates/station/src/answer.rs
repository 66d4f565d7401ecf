//! The answer to a trigger: a frame is inspected, checked for motion, and converted for robots.

use std::{sync::Arc, time::Duration};

use super::{Camera, Inspected, NoFrame, PartFinder, Subject, motion::time_of};
use capture::Captured;
use inspection::{
    library::Library,
    pipeline::{Inspection, NamedRecipe, Unwatched, run_all},
};
use records::history::Traceability;
use robot::RobotFrame;
use serve::FrameParts;
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
    /// The results of all stages for each part, in the order of `found`.
    pub inspections: Vec<Inspection>,
}

impl Answered {
    /// The parts, to be shown and recorded. `robot` is the frame of the numbers that were sent.
    pub fn parts<'a>(
        &'a self,
        recipe: &'a NamedRecipe,
        robot: &'a RobotFrame,
    ) -> Vec<Inspected<'a>> {
        parts_of(&self.subject, &self.scene, &self.inspections, recipe, robot)
    }
}

fn parts_of<'a>(
    subject: &'a Subject,
    scene: &'a Arc<SceneCloud>,
    inspections: &'a [Inspection],
    recipe: &'a NamedRecipe,
    robot: &'a RobotFrame,
) -> Vec<Inspected<'a>> {
    let part = |inspection| Inspected {
        subject,
        scene,
        inspection,
        recipe,
        robot: Some(robot),
        is_forced: false,
    };
    inspections.iter().map(part).collect()
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
        let inspected = |scene: &SceneCloud| {
            run_all(scene, self.library, self.recipe, &Unwatched).expect("not cancelled")
        };
        let middle_of = |part: &Inspection| part.best_reference(self.library)?.middle();
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
        let parts = parts_of(&subject, &scene, &inspections, self.recipe, robot);
        let mut found = parts
            .iter()
            .map(|part| self.finder.found(part, captured_at));
        let mut found = FrameParts {
            first: found.next().expect("an inspection has a verdict"),
            others: found.collect(),
        };
        found.first.report = Inspected::line_of_all(&parts, trace);
        Ok(Answered {
            subject,
            found,
            scene,
            inspections,
        })
    }
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;
    use crate::NumberedPart;
    use capture::SourceSpec;
    use geometry::rigid::RigidTransform;
    use inspection::fixtures::shipped_library;
    use serve::{Answer, Asked, PoseKind, VerdictCode};
    use stages::scene::scene_from_image;

    /// Long enough for a busy machine; normally what is waited for comes at once.
    const PATIENCE: Duration = Duration::from_mins(10);

    #[test]
    fn a_trigger_is_answered_from_the_inspection_that_its_line_tells_of() {
        let (library, recipe) = (shipped_library(), NamedRecipe::default());
        let parts = (1..).zip(&library.references);
        let finder = PartFinder {
            parts: parts
                .map(|(number, _)| NumberedPart {
                    number,
                    ..NumberedPart::default()
                })
                .collect(),
            robot: RobotFrame {
                robot_from_camera: RigidTransform::translation(1.0, 2.0, 3.0),
                name: "cell 1".into(),
            },
            kind: PoseKind::RobotFromPart,
        };
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
