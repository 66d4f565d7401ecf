//! The answer to a trigger: a frame is inspected, checked for motion, and converted for robots.

use std::{sync::Arc, time::Duration};

use super::{Camera, Inspected, NoFrame, PartFinder, Subject, motion::time_of};
use capture::Captured;
use inspection::{
    library::Library,
    pipeline::{self, Inspection, NamedRecipe, Unwatched},
};
use records::history::Traceability;
use serve::Found;
use stages::{reference::Reference, scene::SceneCloud};

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
    /// The result for the client; its report is the line of JSON.
    pub found: Found,
    /// The scene that was inspected.
    pub scene: Arc<SceneCloud>,
    /// The result of all stages.
    pub inspection: Inspection,
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
            pipeline::run(scene, self.library, self.recipe, &Unwatched).expect("not cancelled")
        };
        let (captured_at, at) = (self.camera.captured_at(&captured), time_of(&captured));
        let scene = scene_of(captured);
        let mut inspection = inspected(&scene);
        let middle = inspection.best_reference(self.library);
        let middle = middle.and_then(Reference::middle);
        let is_checked = self.camera.refuse_if_moving(
            at,
            &mut inspection,
            middle,
            self.at_most,
            self.is_ending,
            |later| inspected(&scene_of(later)),
        )?;
        subject.is_motion_unchecked |= !is_checked;
        let inspected = Inspected {
            subject: &subject,
            scene: &scene,
            inspection: &inspection,
            recipe: self.recipe,
            robot: Some(&self.finder.robot),
            is_forced: false,
        };
        let mut found = self.finder.found(&inspected, captured_at);
        found.report = inspected.line(trace);
        Ok(Answered {
            subject,
            found,
            scene,
            inspection,
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
    use robot::RobotFrame;
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
            inspection,
            subject,
            ..
        } = answered.expect("a second frame");
        assert_eq!(found.verdict, VerdictCode::Accepted, "{:?}", found.problem);
        assert_eq!(num_scenes, 2, "looked for again in a later frame");
        assert_eq!((&*found.part, found.marks), ("fender", Answer::SIMULATED));
        let pose = inspection.found_pose().expect("accepted");
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
