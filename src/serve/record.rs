//! An inspection whose answer is wanted later.

use std::time::Instant;

use super::answer::{Answer, Found, Inspected, Request, Situation};

/// An inspection for others than the client that asked for it. It is judged anew whenever it is looked at, so that a
/// pose that has become too old by then does not go out.
#[derive(Debug)]
pub struct InspectionRecord {
    inspected: Inspected,
    at: Situation,
}

impl InspectionRecord {
    pub(super) fn of(inspected: &Inspected, at: Situation) -> Self {
        // The path counts for this verdict; a record is kept without it, because it may be long.
        let answer = Answer::of(Request::Last, inspected, &at);
        let found = Found {
            verdict: answer.verdict,
            captured: inspected.found.captured,
            part: answer.part,
            number: answer.number,
            marks: answer.marks,
            pose: answer.pose,
            trouble: answer.trouble,
            ..Found::default()
        };
        Self {
            inspected: Inspected {
                sequence: answer.sequence,
                found,
            },
            at,
        }
    }

    /// The answer to [`Request::Last`] if it came now, but for the number of points of the path, which is 0. The camera
    /// is as it was when the inspection ended.
    pub fn answer(&self) -> Answer {
        let now = Situation {
            now: Instant::now(),
            ..self.at.clone()
        };
        Answer::of(Request::Last, &self.inspected, &now)
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::{
        geometry::rigid::RigidTransform,
        serve::{CameraStatus, PathStep, VerdictCode},
    };

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
    fn a_path_that_is_not_finite_refuses_the_record_as_it_does_the_answer() {
        let mut endless = RigidTransform::identity();
        endless.translation.vector.x = f64::NAN;
        let inspected = inspected(RigidTransform::identity(), endless);
        let at = within(Duration::from_hours(1));
        let answer = InspectionRecord::of(&inspected, at).answer();
        assert_eq!((answer.verdict, answer.pose), (VerdictCode::Refused, None));
        assert_eq!(answer.trouble.reason, "no_pose");
    }
}
