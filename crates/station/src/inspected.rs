//! What is recorded of an inspection: its line of JSON and its entry in the history, the same whichever front end inspected.

use std::sync::Arc;

use super::{Doubt, doubts_of_result};
use image::RgbImage;
use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use capture::Captured;
use geometry::rigid::{RigidTransform, row_major};
use inspection::pipeline::{Inspection, NamedRecipe};
use records::{
    history::{HungId, InspectionContext, NewEntry, SceneTitle, Traceability},
    report::{CaptureLine, InspectionLine, ScanLine},
};
use robot::RobotFrame;
use stages::{
    scan::{Scan, Shot},
    scene::SceneCloud,
};

/// What is inspected, as the history and the line of JSON name it.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Name of the scene in the line: its file, or the name of the capture.
    pub scene: String,
    /// What the scene is called in the history.
    pub title: SceneTitle,
    /// The source in the form that opens it again, a file, or a description.
    pub source: String,
    /// True if the scene does not come from a camera.
    pub is_simulated: bool,
    /// The capture, if a source delivered the scene.
    pub capture: Option<CaptureFacts>,
    /// The scan, if several frames were inspected together.
    pub scan: Option<ScanFacts>,
    /// True if the part was accepted in a frame of a source and no other frame shows whether it hangs still.
    pub is_motion_unchecked: bool,
}

/// A capture from a source.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CaptureFacts {
    /// The source in the form that opens it again.
    pub source: String,
    /// Its number, counted by the source.
    pub number: u64,
    /// Time of the capture.
    pub taken_at: Timestamp,
    /// Captures dropped since the source was opened, because others were being inspected.
    pub num_dropped: u64,
}

/// Frames that were inspected together.
#[derive(Clone, Debug)]
pub struct ScanFacts {
    /// The frame whose camera the pose refers to.
    pub reference_frame: String,
    /// Pose of the part in the robot's base frame.
    pub base_from_part: Option<RigidTransform>,
    /// All frames, with their camera poses from the robot.
    pub shots: Vec<Shot>,
    /// Number of frames that were used.
    pub num_used: usize,
}

impl CaptureFacts {
    /// A capture of this source.
    pub fn new(captured: &Captured, source: &str, num_dropped: u64) -> Self {
        Self {
            source: source.to_owned(),
            number: captured.number,
            taken_at: captured.taken_at,
            num_dropped,
        }
    }
}

impl Subject {
    /// A scene of a file, of memory or of the simulation.
    pub fn of_scene(scene: String, source: String, is_simulated: bool) -> Self {
        Self {
            title: SceneTitle::of_frame(&scene, is_simulated),
            scene,
            source,
            is_simulated,
            capture: None,
            scan: None,
            is_motion_unchecked: false,
        }
    }

    /// A capture of this source.
    pub fn of_capture(captured: &Captured, source: &str, num_dropped: u64) -> Self {
        let name = captured.name.clone();
        Self {
            capture: Some(CaptureFacts::new(captured, source, num_dropped)),
            ..Self::of_scene(name, source.to_owned(), captured.is_simulated)
        }
    }

    /// Adds the scan that was inspected; `first` is the index of the frame whose camera the pose refers to.
    #[must_use]
    pub fn with_scan(
        self,
        scan: &Scan,
        first: usize,
        base_from_part: Option<RigidTransform>,
    ) -> Self {
        let reference = scan.shots.get(first);
        let scan = ScanFacts {
            reference_frame: reference.map_or_else(String::new, |shot| shot.name.clone()),
            base_from_part,
            shots: scan.given(),
            num_used: scan.used().count(),
        };
        Self {
            scan: Some(scan),
            ..self
        }
    }
}

/// Names in the library that an inspection was made with.
#[derive(Clone, Copy)]
pub struct LibraryNames<'a> {
    /// Identity of the library.
    pub identity: &'a str,
    /// Returns the title of the part enrolled under a name.
    pub title_of: &'a dyn Fn(&str) -> String,
}

/// An inspected scene, to be recorded.
#[derive(Clone, Copy, Debug)]
pub struct Inspected<'a> {
    /// What was inspected.
    pub subject: &'a Subject,
    /// The scene; the first frame of a scan.
    pub scene: &'a Arc<SceneCloud>,
    /// The result.
    pub inspection: &'a Inspection,
    /// The recipe used.
    pub recipe: &'a NamedRecipe,
    /// Position of the camera in the robot's base frame, if the cell is calibrated.
    pub robot: Option<&'a RobotFrame>,
}

impl Inspected<'_> {
    /// Returns the line of JSON, without a line end.
    pub fn line(&self, trace: &Traceability) -> String {
        self.reported_line(trace, None)
    }

    /// Returns the line of JSON with what really hung there, if a person reported the acceptance as wrong: a part,
    /// `not_enrolled` or `nothing`.
    pub fn reported_line(&self, trace: &Traceability, reported_as: Option<&str>) -> String {
        let Self {
            subject,
            inspection,
            recipe,
            robot,
            ..
        } = *self;
        let doubts = doubts_of_result(inspection);
        let mut line = InspectionLine::of(&subject.scene, inspection)
            .by(recipe)
            .traced(trace)
            .in_robot(robot.filter(|_| doubts.is_empty()), inspection)
            .reported_as(reported_as);
        if robot.is_some() && inspection.verdict.is_accepted() {
            line = line.doubted(doubts.iter().map(Doubt::kind).collect());
        }
        match &subject.capture {
            Some(capture) => {
                line = line.captured(CaptureLine {
                    source: &capture.source,
                    number: capture.number,
                    taken_at: capture.taken_at,
                    simulated: subject.is_simulated,
                    dropped: capture.num_dropped,
                });
            }
            None if subject.is_simulated => line = line.of_simulation(),
            None => {}
        }
        if subject.is_motion_unchecked {
            line = line.motion_unchecked();
        }
        if let Some(scan) = &subject.scan {
            let base_from_part = scan.base_from_part.as_ref();
            line = line.of_scan(ScanLine {
                frames: scan.shots.len(),
                used: scan.num_used,
                reference_frame: &scan.reference_frame,
                base_from_part: base_from_part.filter(|_| doubts.is_empty()).map(row_major),
            });
        }
        line.to_json()
    }

    /// Returns the entry for the history. `picture` is that of the segmentation, if there is one.
    pub fn entry(
        &self,
        hung: HungId,
        trace: Traceability,
        library: LibraryNames<'_>,
        picture: Option<&RgbImage>,
    ) -> NewEntry {
        let Self { subject, .. } = *self;
        let about = InspectionContext {
            at: geometry::clock::now(),
            scene: subject.title.clone(),
            source: subject.source.clone(),
            is_simulated: subject.is_simulated,
            title_of: library.title_of,
            line: self.line(&trace),
            library: library.identity.to_owned(),
            origin: None,
            picture,
            hung,
        };
        let mut entry = NewEntry::of(about, self.scene, self.inspection, self.recipe);
        entry.record.summary.trace = trace;
        match &subject.scan {
            Some(scan) => entry.of_scan(scan.shots.clone()),
            None => entry,
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;
    use capture::fixtures::captured;
    use inspection::{
        fixtures::shipped_library,
        pipeline::{Unwatched, live::refuse_moving, run},
    };
    use jiff::Timestamp;
    use records::history::StoredVerdict;
    use simulate::{PartKind, Side};
    use stages::{fixtures::facing_part, scan::Shot};

    struct Found {
        scene: Arc<SceneCloud>,
        inspection: Inspection,
        recipe: NamedRecipe,
        robot: RobotFrame,
        trace: Traceability,
    }

    impl Found {
        fn new() -> Self {
            let recipe = NamedRecipe::default();
            let scene = Arc::new(facing_part(PartKind::Fender, Side::Left, 5));
            let inspection = run(&scene, &shipped_library(), &recipe, &Unwatched);
            Self {
                scene,
                inspection: inspection.expect("not cancelled"),
                recipe,
                robot: RobotFrame {
                    robot_from_camera: RigidTransform::translation(1.0, 2.0, 3.0),
                    name: "cell 1".into(),
                },
                trace: Traceability {
                    serial: "4711".into(),
                    ..Traceability::default()
                },
            }
        }

        fn inspected<'a>(&'a self, subject: &'a Subject) -> Inspected<'a> {
            Inspected {
                subject,
                scene: &self.scene,
                inspection: &self.inspection,
                recipe: &self.recipe,
                robot: Some(&self.robot),
            }
        }

        fn line(&self, subject: &Subject) -> Value {
            let line = self.inspected(subject).line(&self.trace);
            serde_json::from_str(&line).expect("JSON")
        }
    }

    fn capture() -> Subject {
        let captured = capture::Captured {
            name: "kinect frame 12".into(),
            ..captured(12, Timestamp::UNIX_EPOCH)
        };
        Subject::of_capture(&captured, "kinect", 3)
    }

    #[test]
    fn the_line_of_a_capture_names_source_recipe_part_and_the_pose_for_the_robot() {
        let found = Found::new();
        let line = found.line(&capture());
        for (field, expected) in [
            ("scene", Value::from("kinect frame 12")),
            ("source", "kinect".into()),
            ("number", 12.into()),
            ("taken_at", "1970-01-01T00:00:00Z".into()),
            ("dropped", 3.into()),
            ("simulated", false.into()),
            ("part", "fender".into()),
            ("accepted", true.into()),
            ("serial", "4711".into()),
        ] {
            assert_eq!(line[field], expected, "{field}");
        }
        assert_eq!(line["recipe"]["identity"], *found.recipe.identity());
        let pose = found.inspection.found_pose().expect("accepted");
        let pose = found.robot.robot_from_part(&pose.camera_from_part());
        let numbers = line["robot"]["robot_from_part"].as_array().expect("a pose");
        for (number, expected) in numbers.iter().zip(row_major(&pose)) {
            assert_eq!(number.as_f64(), Some(expected));
        }
        assert_eq!(line["robot"]["calibration"], "cell 1");
        assert!(line.get("scan").is_none() && line.get("reported_as").is_none());
        let subject = capture();
        let reported = found.inspected(&subject);
        let reported = reported.reported_line(&found.trace, Some("nothing"));
        assert!(
            reported.contains(r#""reported_as":"nothing""#),
            "{reported}"
        );
    }

    #[test]
    fn a_scene_without_a_source_is_marked_only_if_it_is_known_to_be_simulated() {
        let found = Found::new();
        for (is_simulated, expected) in [(false, None), (true, Some(&Value::Bool(true)))] {
            let subject = Subject::of_scene("door.pcd".into(), "file".into(), is_simulated);
            let line = found.line(&subject);
            assert_eq!(line.get("simulated"), expected);
            assert!(line.get("source").is_none() && line.get("taken_at").is_none());
        }
    }

    #[test]
    fn an_entry_has_the_same_line_and_what_a_list_shows() {
        let found = Found::new();
        let subject = Subject {
            title: SceneTitle::Named("Kinect frame 12".into()),
            ..capture()
        };
        let hung = HungId::new();
        let names = LibraryNames {
            identity: "1a2b",
            title_of: &|name| format!("The {name}"),
        };
        let inspected = found.inspected(&subject);
        let entry = inspected.entry(hung.clone(), found.trace.clone(), names, None);
        let (summary, detail) = (&entry.record.summary, &entry.record.detail);
        assert_eq!(detail.line, inspected.line(&found.trace));
        assert_eq!(detail.library_identity, "1a2b");
        assert_eq!(summary.verdict, StoredVerdict::Accepted);
        assert_eq!(summary.scene, subject.title);
        assert_eq!(
            (&*summary.source, &*summary.title),
            ("kinect", "The fender")
        );
        assert_eq!((&summary.hung, &summary.trace), (&hung, &found.trace));
        assert!(entry.shots.is_empty());
    }

    #[test]
    fn the_line_of_a_scan_counts_its_frames_and_its_entry_keeps_them() {
        let mut found = Found::new();
        let shot = Shot {
            name: "left".into(),
            scene: Arc::clone(&found.scene),
            base_from_camera: RigidTransform::identity(),
        };
        let subject = Subject {
            scan: Some(ScanFacts {
                reference_frame: "left".into(),
                base_from_part: Some(RigidTransform::identity()),
                shots: vec![shot.clone(), shot],
                num_used: 1,
            }),
            ..Subject::of_scene("frames".into(), "scan".into(), false)
        };
        let line = found.line(&subject);
        assert_eq!(line["scan"]["frames"], 2);
        assert_eq!(line["scan"]["used"], 1);
        assert_eq!(line["scan"]["reference_frame"], "left");
        assert!(line["scan"]["base_from_part"].is_array());
        let names = LibraryNames {
            identity: "",
            title_of: &str::to_owned,
        };
        let entry = found.inspected(&subject);
        let entry = entry.entry(HungId::new(), Traceability::default(), names, None);
        assert_eq!(entry.shots.len(), 2);
        refuse_moving(&mut found.inspection);
        let line = found.line(&subject);
        assert!(
            line["scan"]["base_from_part"].is_null(),
            "no pose to move by"
        );
        assert!(line.get("robot").is_none());
    }
}
