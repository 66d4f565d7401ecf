//! The reasons against letting a robot act on a result.

use std::{
    path::Path,
    time::{Duration, SystemTime},
};

use files::file_of;
use geometry::error::Advice;
use inspection::pipeline::Inspection;
use robot::{RobotFrame, arm::NotReached, paint::FilmOffPlan, spray::OffThePart};
use stages::pose::{OffScale, PoseEstimate};

/// A part captured longer ago than this may hang elsewhere by now.
const STALE: Duration = Duration::from_mins(10);

/// Least difference between two clocks that counts. File systems round times by up to 2 s.
const CLOCK_TOLERANCE: Duration = Duration::from_secs(5);

/// A capture that is dated later than now by this computer's clock, so that its age is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the capture is dated {} s later than now, so its age is not known", ahead.as_secs())]
pub struct ClockAhead {
    /// The difference between the clocks.
    pub ahead: Duration,
}

/// How a result relates to what hangs there now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Currency {
    /// The source is followed, and what it shows hangs still: the result is that of now.
    Current,
    /// What hangs there moves, or two frames do not agree yet.
    Moving,
    /// The source gives no more frames.
    SourceLost,
    /// Another part may hang there: the result is of the history, out of date, or of a source that is no longer
    /// followed.
    Superseded,
    /// Captured once, at this time; for files, see [`written_at`].
    CapturedAt(SystemTime),
}

/// Why a robot must not act on a result. `Display` states what is wrong, `Advice` what to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Doubt {
    /// A person has reported that the part is another one, or none. Only the window knows that.
    #[error("the part was reported as wrong")]
    ReportedWrong,
    /// The source gives no more frames.
    #[error("the source was lost, so what hangs there now is not known")]
    SourceLost,
    /// What hangs there moves.
    #[error("the part is moving")]
    Moving,
    /// Another part may hang there by now.
    #[error("another part may hang there by now")]
    Superseded,
    /// No part was accepted.
    #[error("the part was not accepted")]
    NotAccepted,
    /// The part has no pose.
    #[error("the part has no pose")]
    NoPose,
    /// The camera's pose in the robot's cell is not known.
    #[error("the cell is not calibrated")]
    NotCalibrated,
    /// The capture is dated later than now.
    #[error(transparent)]
    ClockAhead(ClockAhead),
    /// The capture is old, or its age cannot be read.
    #[error("the capture is more than 10 minutes old, or of unknown age")]
    Old,
    /// Another pose fits nearly as well.
    #[error("another pose of the part fits nearly as well")]
    Ambiguous,
    /// The part is larger or smaller than its reference, so the camera's numbers are probably wrong.
    #[error(transparent)]
    OffScale(OffScale),
    /// The path does not aim at the part.
    #[error(transparent)]
    OffThePart(OffThePart),
    /// The arm does not reach the path, or collides on it.
    #[error(transparent)]
    NotReached(NotReached),
    /// A program would leave another film than planned.
    #[error(transparent)]
    FilmOffPlan(FilmOffPlan),
}

impl Doubt {
    /// A word that stays the same in later versions.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::ReportedWrong => "reported_wrong",
            Self::SourceLost => "source_lost",
            Self::Moving => "moving",
            Self::Superseded => "superseded",
            Self::NotAccepted => "not_accepted",
            Self::NoPose => "no_pose",
            Self::NotCalibrated => "not_calibrated",
            Self::ClockAhead(_) => "clock_ahead",
            Self::Old => "old",
            Self::Ambiguous => "ambiguous_pose",
            Self::OffScale(_) => "off_scale",
            Self::OffThePart(_) => "off_the_part",
            Self::NotReached(_) => "not_reached",
            Self::FilmOffPlan(_) => "film_off_plan",
        }
    }
}

impl Advice for ClockAhead {
    fn advice(&self) -> String {
        "Set the clocks of this computer and of the one that wrote the capture from the same time server, and capture the part again".into()
    }
}

impl Advice for Doubt {
    fn advice(&self) -> String {
        match self {
            Self::ReportedWrong => "Check which part hangs there, and capture it again".into(),
            Self::SourceLost => "Connect the source again, and capture the part again".into(),
            Self::Moving => "Wait until the part hangs still".into(),
            Self::Superseded | Self::NotAccepted | Self::Old => {
                "Capture all of the part again".into()
            }
            Self::NoPose => "Choose a recipe that estimates the pose, and inspect the part again".into(),
            Self::NotCalibrated => {
                "Calibrate where the camera stands in the robot's cell: partsight calibrate, or Robot… in the window".into()
            }
            Self::ClockAhead(ahead) => ahead.advice(),
            Self::Ambiguous => {
                "Turn the part's face to the camera, all of it inside the picture".into()
            }
            Self::OffScale(off) => off.advice(),
            Self::OffThePart(off) => off.advice(),
            Self::NotReached(missed) => missed.advice(),
            Self::FilmOffPlan(off_plan) => off_plan.advice(),
        }
    }
}

impl Currency {
    /// The reason against a result of this currency.
    fn doubt(&self) -> Option<Doubt> {
        match self {
            Self::Current => None,
            Self::Moving => Some(Doubt::Moving),
            Self::SourceLost => Some(Doubt::SourceLost),
            Self::Superseded => Some(Doubt::Superseded),
            Self::CapturedAt(captured) => age_doubt(*captured),
        }
    }
}

/// When the capture in these files was made: when they were last written, the earliest if there are several, and the
/// beginning of time if that is not known.
pub fn written_at<'a>(files: impl IntoIterator<Item = &'a Path>) -> SystemTime {
    // The path may name unit, axes or a mesh behind the file.
    let written = |file| file_of(file).metadata().and_then(|meta| meta.modified());
    let times = files.into_iter().map(|file| written(file).ok());
    times.min().flatten().unwrap_or(SystemTime::UNIX_EPOCH)
}

fn age_doubt(captured: SystemTime) -> Option<Doubt> {
    match SystemTime::now().duration_since(captured) {
        Ok(age) => (age > STALE).then_some(Doubt::Old),
        Err(error) => {
            let ahead = error.duration();
            (ahead > CLOCK_TOLERANCE).then_some(Doubt::ClockAhead(ClockAhead { ahead }))
        }
    }
}

/// Returns the doubts about a result, the one to show first; a robot may act on the result only if there are none.
/// `robot` is `None` if the cell is not calibrated.
pub fn doubts(
    inspection: &Inspection,
    currency: &Currency,
    robot: Option<&RobotFrame>,
) -> Vec<Doubt> {
    let of_cell = robot.is_none().then_some(Doubt::NotCalibrated);
    let of_result = doubts_of_result(inspection);
    let all = currency.doubt().into_iter().chain(of_result);
    all.chain(of_cell).collect()
}

/// Returns the doubts that a result has whenever and wherever it was captured.
pub fn doubts_of_result(inspection: &Inspection) -> Vec<Doubt> {
    let pose = inspection.found_pose();
    let of_result = [
        (!inspection.verdict.is_accepted(), Doubt::NotAccepted),
        (pose.is_none(), Doubt::NoPose),
    ];
    let of_result = of_result.into_iter().filter(|(is_doubt, _)| *is_doubt);
    let of_result = of_result.map(|(_, doubt)| doubt);
    of_result
        .chain(pose.into_iter().flat_map(doubts_about))
        .collect()
}

/// The doubts about a pose by itself.
pub(crate) fn doubts_about(pose: &PoseEstimate) -> impl Iterator<Item = Doubt> {
    let ambiguous = pose.is_ambiguous().then_some(Doubt::Ambiguous);
    let off_scale = pose.off_scale().map(Doubt::OffScale);
    ambiguous.into_iter().chain(off_scale)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::rigid::RigidTransform;
    use inspection::{
        fixtures::shipped_library,
        pipeline::{Recipe, Unwatched, run},
    };
    use simulate::{PartKind, Side};
    use stages::{
        fixtures::facing_part,
        pose::{RunnerUp, ScaleEstimate},
        scene::SceneCloud,
    };

    fn frame() -> RobotFrame {
        RobotFrame {
            robot_from_camera: RigidTransform::identity(),
            name: "cell 1".into(),
        }
    }

    fn kinds(doubts: &[Doubt]) -> Vec<&'static str> {
        doubts.iter().map(Doubt::kind).collect()
    }

    #[test]
    fn a_capture_counts_for_ten_minutes_and_not_if_its_clock_is_ahead() {
        let now = SystemTime::now();
        let kind = |currency: &Currency| currency.doubt().map(|doubt| doubt.kind());
        for (captured, expected) in [
            (now - Duration::from_mins(11), Some("old")),
            (now - Duration::from_mins(1), None),
            (now + Duration::from_secs(2), None),
            (now + Duration::from_hours(1), Some("clock_ahead")),
        ] {
            assert_eq!(kind(&Currency::CapturedAt(captured)), expected);
        }
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("door.pcd");
        let of_files = |files: &[&Path]| Currency::CapturedAt(written_at(files.iter().copied()));
        assert_eq!(kind(&of_files(&[&path])), Some("old"), "no file, so no age");
        let file = std::fs::File::create(&path).expect("created");
        assert_eq!(kind(&of_files(&[&path])), None);
        let in_millimetres = folder.path().join("door.pcd#units=mm");
        assert_eq!(kind(&of_files(&[&in_millimetres])), None);
        let older = folder.path().join("older.pcd");
        assert_eq!(kind(&of_files(&[&path, &older])), Some("old"), "one of two");
        let written = std::fs::File::create(&older).expect("created");
        let hour = Duration::from_hours(1);
        written.set_modified(now - hour).expect("dated");
        assert_eq!(kind(&of_files(&[&path, &older])), Some("old"));
        file.set_modified(now + hour).expect("dated");
        let doubt = of_files(&[&path]).doubt().expect("ahead");
        assert!(doubt.to_string().contains("later than now"), "{doubt}");
        assert!(doubt.advice().contains("clocks"), "{}", doubt.advice());
    }

    #[test]
    fn a_robot_may_act_only_on_an_accepted_part_with_one_pose_in_a_calibrated_cell() {
        let library = shipped_library();
        let recipe = Recipe::default();
        let scene = facing_part(PartKind::Fender, Side::Left, 5);
        let mut inspection = run(&scene, &library, &recipe, &Unwatched).expect("run");
        let robot = frame();
        let found =
            |inspection: &Inspection, currency, robot| kinds(&doubts(inspection, &currency, robot));
        assert!(found(&inspection, Currency::Current, Some(&robot)).is_empty());
        for (currency, kind) in [
            (Currency::Moving, "moving"),
            (Currency::SourceLost, "source_lost"),
            (Currency::Superseded, "superseded"),
        ] {
            assert_eq!(found(&inspection, currency, Some(&robot)), [kind]);
        }
        assert_eq!(
            found(&inspection, Currency::Current, None),
            ["not_calibrated"]
        );
        let Some(Ok(pose)) = &mut inspection.pose else {
            panic!("a pose");
        };
        assert_eq!(pose.off_scale(), None);
        let own_scale = pose.scale.replace(ScaleEstimate {
            scale: 1.05,
            deviation: 0.005,
        });
        assert_eq!(
            found(&inspection, Currency::Current, Some(&robot)),
            ["off_scale"]
        );
        let Some(Ok(pose)) = &mut inspection.pose else {
            panic!("a pose");
        };
        pose.scale = own_scale;
        pose.runner_up = Some(RunnerUp {
            target_from_source: pose.target_from_source,
            ratio: 1.01,
        });
        assert_eq!(
            found(&inspection, Currency::Moving, Some(&robot)),
            ["moving", "ambiguous_pose"]
        );
        inspection.pose = None;
        assert_eq!(
            found(&inspection, Currency::Current, Some(&robot)),
            ["no_pose"]
        );
        let nothing = run(&SceneCloud::default(), &library, &recipe, &Unwatched).expect("run");
        assert_eq!(
            found(&nothing, Currency::Current, Some(&robot)),
            ["not_accepted", "no_pose"]
        );
    }
}
