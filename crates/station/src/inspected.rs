//! What is recorded of an inspection: its line of JSON and its entry in the history, the same whichever front end inspected.

use std::{path::Path, sync::Arc, time::SystemTime};

use super::{Doubt, NewFrame, age_doubt};
use image::RgbImage;
use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use capture::{Captured, SourceSpec};
use files::written_at;
use geometry::rigid::row_major;
use inspection::pipeline::{Inspection, NamedRecipe, Recipe};
use records::{
    history::{HungId, InspectionContext, NewEntry, SceneTitle, Traceability},
    report::{CaptureLine, InspectionLine, ScanLine},
};
use robot::{RobotFrame, line::OnLine};
use stages::{
    scan::{self, Scan, Shot},
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
    /// Why another part may hang there by now, or this one elsewhere; `None` if it hangs there as captured.
    pub currency: Option<Doubt>,
    /// True if no other frame of the source shows whether the part hangs still.
    pub is_motion_unchecked: bool,
    /// What really hung there, if a person reported the acceptance as wrong: a part, `not_enrolled` or `nothing`.
    pub reported_as: Option<String>,
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
    /// True if it was recorded earlier and is replayed now.
    #[serde(default)]
    pub is_replayed: bool,
    /// True if it stands for itself: the captures before and after it do not show whether its part hangs still.
    #[serde(default)]
    pub is_alone: bool,
}

/// Frames that were inspected together.
#[derive(Clone, Debug)]
pub struct ScanFacts {
    /// The frame whose camera the pose refers to.
    pub reference_frame: String,
    /// All frames, with their camera poses from the robot.
    pub shots: Vec<Shot>,
    /// Number of frames that were used.
    pub num_used: usize,
    /// Set if those do not agree as well as they should.
    pub doubt: Option<scan::Doubt>,
}

impl CaptureFacts {
    /// A capture of this source.
    pub fn new(captured: &Captured, source: &SourceSpec, num_dropped: u64) -> Self {
        Self {
            source: source.to_string(),
            number: captured.number,
            taken_at: captured.taken_at,
            num_dropped,
            is_replayed: source.is_replayed(),
            is_alone: !NewFrame::of_source(source).shows_motion(),
        }
    }

    /// Returns when the file was written; `None` for a frame that a camera has just delivered or a recording replays: it counts as
    /// captured now.
    pub fn written_at(&self) -> Option<SystemTime> {
        let is_file = self.is_alone && !self.is_replayed;
        is_file.then(|| self.taken_at.into())
    }
}

impl Subject {
    /// A scene of memory or of the simulation.
    pub fn of_scene(scene: String, source: String, is_simulated: bool) -> Self {
        Self {
            title: SceneTitle::of_frame(&scene, is_simulated),
            scene,
            source,
            is_simulated,
            capture: None,
            scan: None,
            currency: None,
            is_motion_unchecked: false,
            reported_as: None,
        }
    }

    /// The scene in this file.
    pub fn of_file(path: &Path, is_simulated: bool) -> Self {
        let name = path.display().to_string();
        let written = written_at(path).unwrap_or(SystemTime::UNIX_EPOCH);
        Self::of_scene(name, "file".into(), is_simulated).captured_at(written)
    }

    /// A capture of this source.
    pub fn of_capture(captured: &Captured, source: &SourceSpec, num_dropped: u64) -> Self {
        let facts = CaptureFacts::new(captured, source, num_dropped);
        let source = facts.source.clone();
        Self::of_scene(captured.name.clone(), source, captured.is_simulated).with_capture(facts)
    }

    /// Adds the capture that delivered the scene.
    #[must_use]
    pub fn with_capture(self, facts: CaptureFacts) -> Self {
        Self {
            currency: facts.written_at().and_then(age_doubt),
            is_motion_unchecked: facts.is_alone,
            capture: Some(facts),
            ..self
        }
    }

    /// Adds when the scene was captured, of a source that is not followed.
    #[must_use]
    pub fn captured_at(self, at: SystemTime) -> Self {
        Self {
            currency: age_doubt(at),
            ..self
        }
    }

    /// Adds the scan that was inspected; `first` is the index of the frame whose camera the pose refers to.
    #[must_use]
    pub fn with_scan(self, scan: &Scan, first: usize) -> Self {
        let reference = scan.shots.get(first);
        let scan = ScanFacts {
            reference_frame: reference.map_or_else(String::new, |shot| shot.name.clone()),
            shots: scan.given(),
            num_used: scan.used().count(),
            doubt: scan.doubt.clone(),
        };
        Self {
            scan: Some(scan),
            ..self
        }
    }

    /// Name of the scene, and that it was recorded earlier.
    pub(crate) fn scene_in_words(&self) -> String {
        let is_replayed = self.is_replayed();
        let replayed = if is_replayed {
            ", recorded earlier"
        } else {
            ""
        };
        format!("{}{replayed}", self.scene)
    }

    /// True if the frame was recorded earlier, and is replayed now.
    pub fn is_replayed(&self) -> bool {
        self.capture.as_ref().is_some_and(|facts| facts.is_replayed)
    }

    /// True if no camera sees the scene now: it is simulated, or was recorded earlier.
    pub fn is_staged(&self) -> bool {
        self.is_simulated || self.is_replayed()
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
    /// True to give the pose of an accepted part in that frame despite doubts.
    pub is_forced: bool,
    /// Where the part is on the line that carries it, if it has its pose there.
    pub on_line: Option<OnLine>,
}

impl<'a> Inspected<'a> {
    /// The robot's frame, if the pose may be given in it: the part was accepted, and there are no doubts, or it is forced.
    pub fn frame_for_robot(&self) -> Option<&'a RobotFrame> {
        let may_be_given = self.is_forced || self.doubts().is_empty();
        (self.robot).filter(|_| may_be_given && self.inspection.verdict.is_accepted())
    }

    /// Returns the line of JSON, without a line end.
    pub fn line(&self, trace: &Traceability) -> String {
        self.inspection_line(trace).to_json()
    }

    /// Returns the line of JSON of a frame, without a line end: that of its first part and, if several may hang there, every
    /// part.
    ///
    /// # Panics
    /// Without a part: an inspection has one at least.
    pub fn line_of_all(parts: &[Self], trace: &Traceability) -> String {
        let first = &parts[0];
        let line = first.inspection_line(trace);
        let Recipe { expected, rack, .. } = &**first.recipe;
        if first.recipe.max_parts() == 1 && expected.is_empty() && rack.is_empty() {
            return line.to_json();
        }
        let all = parts.iter().map(|part| part.inspection_line(trace));
        line.with_parts(all, Self::empty_places(parts))
            .held_against(expected, &inspections_of(parts))
            .to_json()
    }

    /// Names of the rack's places at which none of the parts of a frame hangs.
    pub fn empty_places(parts: &[Self]) -> Vec<&'a str> {
        let recipe = parts.first().map(|part| part.recipe);
        recipe.map_or_else(Vec::new, |recipe| {
            recipe.empty_places(&inspections_of(parts))
        })
    }

    fn inspection_line<'b>(&self, trace: &'b Traceability) -> InspectionLine<'b>
    where
        'a: 'b,
    {
        let Self {
            subject,
            inspection,
            recipe,
            ..
        } = *self;
        let is_accepted = inspection.verdict.is_accepted();
        let robot = self.frame_for_robot();
        let doubts = if self.robot.is_some() && is_accepted {
            self.doubts().iter().map(Doubt::kind).collect()
        } else {
            Vec::new()
        };
        let mut line = InspectionLine::of(&subject.scene, inspection)
            .in_robot(robot, inspection, doubts)
            .on_line(self.on_line)
            .expecting(&recipe.expected, inspection.missing.as_ref());
        line.recipe = Some(recipe.into());
        line.rack = Some(&*recipe.rack.name).filter(|name| !name.is_empty());
        line.trace = Some(trace);
        line.reported_as = subject.reported_as.as_deref();
        line.capture = subject.capture.as_ref().map(|capture| CaptureLine {
            source: &capture.source,
            number: capture.number,
            taken_at: capture.taken_at,
            simulated: subject.is_simulated,
            dropped: capture.num_dropped,
        });
        line.simulated = (subject.is_simulated && subject.capture.is_none()).then_some(true);
        line.motion_checked = (subject.is_motion_unchecked && is_accepted).then_some(false);
        line.replayed = subject.is_replayed().then_some(true);
        line.scan = subject.scan.as_ref().map(|scan| ScanLine {
            frames: scan.shots.len(),
            used: scan.num_used,
            reference_frame: &scan.reference_frame,
            base_from_part: robot
                .zip(inspection.found_pose())
                .map(|(robot, pose)| row_major(&robot.robot_from_part(&pose.camera_from_part()))),
        });
        line
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

/// The verdicts on the parts of a frame.
pub(super) fn inspections_of<'a>(parts: &[Inspected<'a>]) -> Vec<&'a Inspection> {
    parts.iter().map(|part| part.inspection).collect()
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;
    use capture::fixtures::captured;
    use geometry::{rigid::RigidTransform, units::Metres};
    use inspection::{
        fixtures::shipped_library,
        pipeline::{Unwatched, live::refuse_moving, run},
    };
    use records::history::{RobotMarks, StoredVerdict};
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
                is_forced: false,
                on_line: None,
            }
        }

        fn line(&self, subject: &Subject) -> Value {
            let line = self.inspected(subject).line(&self.trace);
            serde_json::from_str(&line).expect("JSON")
        }

        /// What the history notes about letting a robot act on it.
        fn noted(&self, subject: &Subject) -> RobotMarks {
            let names = LibraryNames {
                identity: "",
                title_of: &|name| name.to_owned(),
            };
            let entry =
                self.inspected(subject)
                    .entry(HungId::new(), self.trace.clone(), names, None);
            entry.record.summary.noted
        }
    }

    fn capture() -> Subject {
        let captured = capture::Captured {
            name: "kinect frame 12".into(),
            ..captured(12, Timestamp::UNIX_EPOCH)
        };
        let kinect = "kinect".parse().expect("a source");
        Subject::of_capture(&captured, &kinect, 3)
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
        for absent in ["robot_doubts", "motion_checked", "replayed"] {
            assert!(line.get(absent).is_none(), "{absent}");
        }
        let reported = found.line(&Subject {
            reported_as: Some("nothing".into()),
            ..capture()
        });
        assert_eq!(reported["reported_as"], "nothing");
        assert_eq!(reported["robot_doubts"][0], "reported_wrong");
        assert!(reported.get("robot").is_none());
    }

    #[test]
    fn a_doubt_keeps_the_robots_pose_out_of_the_line_unless_it_is_forced_and_the_cameras_in_it() {
        let mut found = Found::new();
        let old = Subject {
            currency: Some(Doubt::Old),
            ..Subject::of_scene("fender.pcd".into(), "file".into(), false)
        };
        let line = found.line(&old);
        assert_eq!(line["robot_doubts"], serde_json::json!(["old"]));
        // The list of the history knows it too.
        assert_eq!(found.noted(&old).robot_doubts, ["old"]);
        assert!(line.get("robot").is_none());
        assert!(line["pose"]["camera_from_part"].is_array());
        let forced = |found: &Found, robot| {
            let inspected = Inspected {
                is_forced: true,
                on_line: None,
                robot,
                ..found.inspected(&old)
            };
            let line = inspected.line(&found.trace);
            serde_json::from_str::<Value>(&line).expect("JSON")
        };
        let line = forced(&found, Some(&found.robot));
        assert_eq!(line["robot_doubts"], serde_json::json!(["old"]));
        assert!(line["robot"]["robot_from_part"].is_array());
        // Without a calibration there is nothing to force.
        let line = forced(&found, None);
        assert!(line.get("robot").is_none() && line.get("robot_doubts").is_none());
        refuse_moving(&mut found.inspection);
        let line = forced(&found, Some(&found.robot));
        assert!(line.get("robot").is_none(), "never if it is not accepted");
    }

    #[test]
    fn a_capture_is_marked_if_it_is_replayed_and_if_no_other_frame_shows_motion() {
        for (source, is_replayed, is_unchecked) in [
            ("recording:monday", true, true),
            ("openni,pace=as-taken:monday.oni", true, false),
            ("realsense,pace=10:monday.db3", true, false),
            ("realsense,pace=10:monday.bag", true, false),
            ("openni", false, false),
            ("realsense:843112072752", false, false),
            ("kinect", false, false),
            ("genicam", false, false),
            ("simulated", false, false),
            ("watch:scans", false, true),
        ] {
            let spec: SourceSpec = source.parse().expect("a source");
            let mut frame = captured(1, geometry::clock::now());
            let subject = Subject::of_capture(&frame, &spec, 0);
            let marks = (subject.is_staged(), subject.is_motion_unchecked);
            assert_eq!(marks, (is_replayed, is_unchecked), "{source}");
            assert_eq!(subject.currency, None, "{source}");
            frame.is_simulated = true;
            assert!(Subject::of_capture(&frame, &spec, 0).is_staged());
            // Only a file is as old as it is dated: cameras have clocks of their own, and recordings are replayed.
            let dated = captured(1, Timestamp::UNIX_EPOCH);
            let expected = (source == "watch:scans").then_some(Doubt::Old);
            assert_eq!(Subject::of_capture(&dated, &spec, 0).currency, expected);
        }
        let mut found = Found::new();
        let frame = captured(1, geometry::clock::now());
        let replayed = Subject::of_capture(&frame, &"recording:monday".parse().expect("one"), 0);
        let line = found.line(&replayed);
        assert_eq!(
            (&line["replayed"], &line["motion_checked"]),
            (&true.into(), &false.into())
        );
        refuse_moving(&mut found.inspection);
        assert!(found.line(&replayed).get("motion_checked").is_none());
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
        let of_scan = |doubt| Subject {
            scan: Some(ScanFacts {
                reference_frame: "left".into(),
                shots: vec![shot.clone(), shot.clone()],
                num_used: 1,
                doubt,
            }),
            ..Subject::of_scene("frames".into(), "scan".into(), false)
        };
        let subject = of_scan(None);
        let line = found.line(&subject);
        assert_eq!(line["scan"]["frames"], 2);
        assert_eq!(line["scan"]["used"], 1);
        assert_eq!(line["scan"]["reference_frame"], "left");
        assert_eq!(
            line["scan"]["base_from_part"],
            line["robot"]["robot_from_part"]
        );
        let apart = scan::Doubt::PosesApart {
            names: ["left".into(), "right".into()],
            apart: Metres::from_mm(30.0),
        };
        let doubted = found.line(&of_scan(Some(apart)));
        assert_eq!(doubted["robot_doubts"][0], "poses_apart");
        assert!(doubted["scan"]["base_from_part"].is_null());
        assert!(doubted.get("robot").is_none());
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
