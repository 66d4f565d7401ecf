//! The reasons against letting a robot act on a result.

use std::time::{Duration, SystemTime};

use super::Inspected;
use geometry::error::Advice as _;
use records::{history::RobotMarks, report::pose_report::DoubtBlock};
use robot::{arm::NotReached, paint::FilmOffPlan, spray::OffThePart};
use stages::{
    pose::{OffScale, PoseEstimate},
    scan,
};
use texts::{Described, Message};

/// A part captured longer ago than this may hang elsewhere by now.
const MAX_CAPTURE_AGE: Duration = Duration::from_mins(10);

/// Least difference between two clocks that counts. File systems round times by up to 2 s.
const CLOCK_TOLERANCE: Duration = Duration::from_secs(5);

/// A capture that is dated later than now by this computer's clock, so that its age is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub struct ClockAhead {
    /// The difference between the clocks.
    pub ahead: Duration,
}

/// Why a robot must not act on a result. `Display` states what is wrong, `Advice` what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Doubt {
    /// A person has reported that the part is another one, or none. Only the window knows that.
    ReportedWrong,
    /// The source gives no more frames.
    SourceLost,
    /// What hangs there moves.
    Moving,
    /// Another part may hang there by now.
    Superseded,
    /// The part's order expects other parts than those that it was inspected for. Only the window knows that.
    OtherOrder,
    /// No part was accepted.
    NotAccepted,
    /// The part has no pose.
    NoPose,
    /// The camera's pose in the robot's cell is not known.
    NotCalibrated,
    /// The capture is dated later than now.
    ClockAhead(ClockAhead),
    /// The capture is old, or its age cannot be read.
    Old,
    /// Another pose fits nearly as well.
    Ambiguous,
    /// The surface has a dent, a bump or something missing beyond its limit.
    Surface,
    /// The part is larger or smaller than its reference, so the camera's numbers are probably wrong.
    OffScale(OffScale),
    /// The frames of a scan, or the poses of their cameras, contradict one another.
    Scan(scan::Doubt),
    /// The path does not aim at the part.
    OffThePart(OffThePart),
    /// The arm does not reach the path, or collides on it.
    NotReached(NotReached),
    /// A program would leave another film than planned.
    FilmOffPlan(FilmOffPlan),
}

impl Doubt {
    /// A word that stays the same in later versions.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::ReportedWrong => RobotMarks::REPORTED_WRONG,
            Self::SourceLost => "source_lost",
            Self::Moving => "moving",
            Self::Superseded => "superseded",
            Self::OtherOrder => "other_order",
            Self::NotAccepted => "not_accepted",
            Self::NoPose => "no_pose",
            Self::NotCalibrated => "not_calibrated",
            Self::ClockAhead(_) => "clock_ahead",
            Self::Old => "old",
            Self::Ambiguous => "ambiguous_pose",
            Self::Surface => "surface",
            Self::OffScale(_) => "off_scale",
            Self::Scan(scan::Doubt::PoorAgreement { .. }) => "frames_disagree",
            Self::Scan(scan::Doubt::PosesApart { .. }) => "poses_apart",
            Self::OffThePart(_) => "off_the_part",
            Self::NotReached(_) => "not_reached",
            Self::FilmOffPlan(_) => "film_off_plan",
        }
    }
}

impl Doubt {
    /// False if not even a person who insists may have a file for a robot: without a part there is nothing to paint.
    pub fn may_be_forced(&self) -> bool {
        !matches!(self, Self::NotAccepted | Self::NoPose)
    }
}

impl Described for ClockAhead {
    fn message(&self) -> Message {
        Message::new("doubt-clock-ahead").with("seconds", self.ahead.as_secs_f64().floor())
    }
}

impl Described for Doubt {
    fn message(&self) -> Message {
        match self {
            Self::ClockAhead(ahead) => ahead.message(),
            Self::OffScale(off) => off.message(),
            Self::Scan(doubt) => doubt.message(),
            Self::OffThePart(off) => off.message(),
            Self::NotReached(missed) => missed.message(),
            Self::FilmOffPlan(off_plan) => off_plan.message(),
            _ => Message::new(format!("doubt-{}", self.kind().replace('_', "-"))),
        }
    }
}

texts::display!(ClockAhead, Doubt);

/// Returns the doubt about a capture of this time whose source is not followed: another part may hang there by now.
pub fn age_doubt(captured: SystemTime) -> Option<Doubt> {
    match SystemTime::now().duration_since(captured) {
        Ok(age) => (age > MAX_CAPTURE_AGE).then_some(Doubt::Old),
        Err(error) => {
            let ahead = error.duration();
            (ahead > CLOCK_TOLERANCE).then_some(Doubt::ClockAhead(ClockAhead { ahead }))
        }
    }
}

impl Inspected<'_> {
    /// Returns the doubts about the result, the one to show first; a robot may act on it only if there are none.
    pub fn doubts(&self) -> Vec<Doubt> {
        let Self {
            subject,
            inspection,
            robot,
            ..
        } = *self;
        let is_accepted = inspection.verdict.is_accepted();
        let pose = inspection.found_pose();
        let is_ambiguous = pose.is_some_and(PoseEstimate::is_ambiguous);
        let surface = inspection.surface.as_ref();
        let is_surface_bad = surface.is_some_and(|check| check.verdict.is_bad());
        let of_scan = subject.scan.as_ref().and_then(|scan| scan.doubt.clone());
        let doubts = [
            (subject.reported_as.is_some()).then_some(Doubt::ReportedWrong),
            (!is_accepted).then_some(Doubt::NotAccepted),
            pose.is_none().then_some(Doubt::NoPose),
            subject.currency.clone(),
            is_ambiguous.then_some(Doubt::Ambiguous),
            is_surface_bad.then_some(Doubt::Surface),
            pose.and_then(PoseEstimate::off_scale).map(Doubt::OffScale),
            of_scan.map(Doubt::Scan),
            robot.is_none().then_some(Doubt::NotCalibrated),
        ];
        doubts.into_iter().flatten().collect()
    }

    /// The doubts for someone who has the camera's pose in the robot's cell.
    pub fn doubts_if_calibrated(&self) -> Vec<Doubt> {
        let mut doubts = self.doubts();
        doubts.retain(|doubt| *doubt != Doubt::NotCalibrated);
        doubts
    }

    /// The doubts about the result as a report states them.
    pub fn doubt_blocks(&self) -> Vec<DoubtBlock> {
        let doubts = self.doubts().into_iter();
        let blocks = doubts.map(|doubt| DoubtBlock {
            kind: doubt.kind(),
            what: doubt.to_string(),
            advice: doubt.advice(),
        });
        blocks.collect()
    }
}

#[cfg(test)]
mod tests {
    use std::{path::Path, sync::Arc};

    use super::*;
    use crate::{ScanFacts, Subject};
    use geometry::{rigid::RigidTransform, units::Metres};
    use inspection::{
        fixtures::shipped_library,
        pipeline::{Inspection, NamedRecipe, SurfaceCheck, SurfaceVerdict, Unwatched, run},
    };
    use robot::RobotFrame;
    use simulate::{PartKind, Side};
    use stages::{
        fixtures::facing_part,
        pose::{RunnerUp, ScaleEstimate},
        scene::SceneCloud,
    };

    fn subject() -> Subject {
        Subject::of_scene("fender".into(), "file".into(), false)
    }

    /// The doubts about an inspection of this subject, in a calibrated cell or not.
    fn doubts(inspection: &Inspection, subject: &Subject, is_calibrated: bool) -> Vec<Doubt> {
        let robot = RobotFrame {
            robot_from_camera: RigidTransform::identity(),
            name: "cell 1".into(),
        };
        let inspected = Inspected {
            subject,
            scene: &Arc::default(),
            inspection,
            recipe: &NamedRecipe::default(),
            robot: is_calibrated.then_some(&robot),
            is_forced: false,
            on_line: None,
        };
        inspected.doubts()
    }

    fn kinds(inspection: &Inspection, subject: &Subject) -> Vec<&'static str> {
        let doubts = doubts(inspection, subject, true);
        doubts.iter().map(Doubt::kind).collect()
    }

    #[test]
    fn a_capture_counts_for_ten_minutes_and_not_if_its_clock_is_ahead() {
        let now = SystemTime::now();
        let kind = |captured| age_doubt(captured).map(|doubt| doubt.kind());
        for (captured, expected) in [
            (now - Duration::from_mins(11), Some("old")),
            (now - Duration::from_mins(1), None),
            (now + Duration::from_secs(2), None),
            (now + Duration::from_hours(1), Some("clock_ahead")),
        ] {
            assert_eq!(kind(captured), expected);
        }
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("door.pcd");
        let of_file = |path: &Path| Subject::of_file(path, false).currency;
        assert_eq!(of_file(&path), Some(Doubt::Old), "no file, so no age");
        let file = std::fs::File::create(&path).expect("created");
        let in_millimetres = folder.path().join("door.pcd#units=mm");
        for path in [&path, &in_millimetres] {
            assert_eq!(of_file(path), None);
        }
        let hour = Duration::from_hours(1);
        file.set_modified(now - hour).expect("dated");
        for path in [&path, &in_millimetres] {
            assert_eq!(of_file(path), Some(Doubt::Old));
        }
        file.set_modified(now + hour).expect("dated");
        let doubt = of_file(&path).expect("ahead");
        assert!(doubt.to_string().contains("later than now"), "{doubt}");
        assert!(doubt.advice().contains("clocks"), "{}", doubt.advice());
    }

    #[test]
    fn a_robot_may_act_only_on_an_accepted_part_with_one_pose_in_a_calibrated_cell() {
        let library = shipped_library();
        let recipe = NamedRecipe::default();
        let scene = facing_part(PartKind::Fender, Side::Left, 5);
        let mut inspection = run(&scene, &library, &recipe, &Unwatched).expect("run");
        let current = subject();
        assert_eq!(doubts(&inspection, &current, true), []);
        assert_eq!(doubts(&inspection, &current, false), [Doubt::NotCalibrated]);
        for currency in [Doubt::Moving, Doubt::SourceLost, Doubt::Superseded] {
            let subject = Subject {
                currency: Some(currency.clone()),
                ..subject()
            };
            assert_eq!(doubts(&inspection, &subject, true), [currency]);
        }
        let reported = Subject {
            reported_as: Some("nothing".into()),
            ..subject()
        };
        assert_eq!(kinds(&inspection, &reported), ["reported_wrong"]);
        for (verdict, expected) in [
            (SurfaceVerdict::Scrap, &["surface"][..]),
            (SurfaceVerdict::NotJudged, &[]),
        ] {
            inspection.surface = Some(Arc::new(SurfaceCheck {
                verdict,
                not_judged: None,
                deviation: None,
                regions: Vec::new(),
            }));
            assert_eq!(kinds(&inspection, &current), expected);
        }
        let Some(Ok(pose)) = &mut inspection.pose else {
            panic!("a pose");
        };
        assert_eq!(pose.off_scale(), None);
        let own_scale = pose.scale.replace(ScaleEstimate {
            scale: 1.05,
            deviation: 0.005,
        });
        assert_eq!(kinds(&inspection, &current), ["off_scale"]);
        let Some(Ok(pose)) = &mut inspection.pose else {
            panic!("a pose");
        };
        pose.scale = own_scale;
        pose.runner_up = Some(RunnerUp {
            target_from_source: pose.target_from_source,
            ratio: 1.01,
        });
        let moving = Subject {
            currency: Some(Doubt::Moving),
            ..subject()
        };
        assert_eq!(kinds(&inspection, &moving), ["moving", "ambiguous_pose"]);
        inspection.pose = None;
        assert_eq!(kinds(&inspection, &current), ["no_pose"]);
        let nothing = run(&SceneCloud::default(), &library, &recipe, &Unwatched).expect("run");
        // However old it is: another capture of it would not be accepted either.
        let expected = ["not_accepted", "no_pose", "moving"];
        assert_eq!(kinds(&nothing, &moving), expected);
    }

    #[test]
    fn a_robot_may_not_act_on_a_scan_whose_frames_or_poses_contradict_one_another() {
        let library = shipped_library();
        let recipe = NamedRecipe::default();
        let scene = facing_part(PartKind::Fender, Side::Left, 5);
        let inspection = run(&scene, &library, &recipe, &Unwatched).expect("run");
        let of_scan = |doubt| Subject {
            scan: Some(ScanFacts {
                reference_frame: "a.png".into(),
                shots: Vec::new(),
                num_used: 2,
                doubt,
            }),
            ..subject()
        };
        assert_eq!(doubts(&inspection, &of_scan(None), true), []);
        let disagree = scan::Doubt::PoorAgreement {
            name: "a.png".into(),
            share: 0.9,
        };
        let apart = scan::Doubt::PosesApart {
            names: ["a.png".into(), "b.png".into()],
            apart: Metres::from_mm(30.0),
        };
        for (doubt, kind) in [(disagree, "frames_disagree"), (apart, "poses_apart")] {
            let subject = of_scan(Some(doubt.clone()));
            assert_eq!(kinds(&inspection, &subject), [kind]);
            let [found] = &doubts(&inspection, &subject, true)[..] else {
                panic!("one doubt");
            };
            assert_eq!(found.to_string(), doubt.to_string());
            assert_eq!(found.advice(), doubt.advice());
        }
    }
}
