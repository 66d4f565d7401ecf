//! Records of inspections whose answers are needed later.

use std::time::{Duration, Instant};

use super::{
    answer::{Answer, CameraStatus, Found, Inspected, Request, Situation},
    inspections::Inspections,
};

/// An inspection, kept for receivers other than the client that triggered it. Its verdict is judged again at each access,
/// so that a pose that has become too old is not sent.
#[derive(Debug)]
pub struct InspectionRecord {
    inspected: Inspected,
    at: Situation,
}

impl InspectionRecord {
    pub(super) fn of(inspected: &Inspected, at: Situation) -> Self {
        // Judge with the path, then leave it out of the record: it may be long.
        let answer = Answer::of(Request::Last, inspected, &at);
        let found = Found {
            verdict: answer.verdict,
            captured: inspected.found.captured,
            part: answer.part,
            number: answer.number,
            marks: answer.marks,
            pose: answer.pose,
            problem: answer.problem,
            ..Found::default()
        };
        Self {
            inspected: Inspected {
                sequence: answer.sequence,
                boot: answer.boot,
                found,
                ..Inspected::default()
            },
            at,
        }
    }

    /// The answer to [`Request::Last`] as of now, except that the path has 0 points and the camera's state is that at the
    /// end of the inspection.
    pub fn answer(&self) -> Answer {
        let now = Situation {
            now: Instant::now(),
            ..self.at.clone()
        };
        Answer::of(Request::Last, &self.inspected, &now)
    }
}

/// Makes records without a server, numbered as a server would.
#[derive(Debug)]
pub struct InspectionRecorder {
    inspections: Inspections,
    max_age: Duration,
}

impl InspectionRecorder {
    /// Starts the numbering. An accepted pose from a frame older than `max_age` is stale.
    pub fn new(max_age: Duration) -> Self {
        Self {
            inspections: Inspections::start(),
            max_age,
        }
    }

    /// The boot number of this start, 1..=[`MAX_COUNT`](super::MAX_COUNT).
    pub fn boot(&self) -> u32 {
        self.inspections.boot()
    }

    /// Records the next inspection with the camera's present status.
    pub fn record(&mut self, found: Found, camera: CameraStatus) -> InspectionRecord {
        let inspected = self.inspections.add(found);
        let at = Situation {
            boot: self.boot(),
            max_age: self.max_age,
            camera,
            now: Instant::now(),
        };
        InspectionRecord::of(&inspected, at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PathStep, VerdictCode};
    use geometry::rigid::RigidTransform;

    fn inspected(pose: RigidTransform, step: RigidTransform) -> Inspected {
        Inspected {
            sequence: 5,
            found: Found {
                verdict: VerdictCode::Accepted,
                captured: Some(Instant::now()),
                part: "fender".into(),
                pose: Some(pose),
                path: vec![PathStep {
                    robot_from_nozzle: step,
                    marks: 0,
                    speed: None,
                }],
                ..Found::default()
            },
            boot: 7,
            ..Inspected::default()
        }
    }

    fn within(max_age: Duration) -> Situation {
        Situation {
            boot: 7,
            max_age,
            camera: CameraStatus::default(),
            now: Instant::now(),
        }
    }

    #[test]
    fn a_record_loses_its_pose_with_age() {
        let inspected = inspected(RigidTransform::identity(), RigidTransform::identity());
        let hour = Duration::from_hours(1);
        let fresh = InspectionRecord::of(&inspected, within(hour)).answer();
        assert_eq!(fresh.verdict, VerdictCode::Accepted);
        assert_eq!((fresh.sequence, fresh.boot), (5, 7));
        assert!(fresh.pose.is_some());
        // Fresh when the inspection ended, too old now.
        let record = InspectionRecord {
            at: within(Duration::ZERO),
            ..InspectionRecord::of(&inspected, within(hour))
        };
        std::thread::sleep(Duration::from_millis(2));
        let late = record.answer();
        assert_eq!((late.verdict, late.pose), (VerdictCode::Stale, None));
        assert_eq!(late.part, "fender");
    }

    #[test]
    fn records_without_a_server_are_numbered_and_judged_as_its_own() {
        let found = || inspected(RigidTransform::identity(), RigidTransform::identity()).found;
        let mut recorder = InspectionRecorder::new(Duration::from_hours(1));
        let answers = [(), ()].map(|()| {
            let record = recorder.record(found(), CameraStatus::default());
            record.answer()
        });
        assert_eq!(answers.each_ref().map(|answer| answer.sequence), [1, 2]);
        for answer in &answers {
            assert_eq!(answer.boot, recorder.boot());
            assert!(answer.boot > 0 && answer.pose.is_some(), "{answer:?}");
        }
        let mut strict = InspectionRecorder::new(Duration::ZERO);
        let old = Found {
            captured: Instant::now().checked_sub(Duration::from_millis(5)),
            ..found()
        };
        let late = strict.record(old, CameraStatus::default()).answer();
        assert_eq!((late.verdict, late.pose), (VerdictCode::Stale, None));
    }

    #[test]
    fn a_path_that_is_not_finite_refuses_the_record_as_it_does_the_answer() {
        let mut endless = RigidTransform::identity();
        endless.translation.vector.x = f64::NAN;
        let inspected = inspected(RigidTransform::identity(), endless);
        let at = within(Duration::from_hours(1));
        let answer = InspectionRecord::of(&inspected, at).answer();
        assert_eq!((answer.verdict, answer.pose), (VerdictCode::Refused, None));
        assert_eq!(answer.problem.reason, "no_pose");
    }
}
