//! Records of inspections whose answers are needed later.

use std::time::{Duration, Instant};

use super::{
    answer::{Answer, CameraStatus, Found, FrameParts, Inspected, Situation},
    inspections::Inspections,
    request::Request,
};

/// An inspected part, kept for receivers other than the client that triggered it. Its verdict is judged again at each access,
/// so that a pose that has become too old is not sent.
#[derive(Debug)]
pub struct InspectionRecord {
    /// Of this part alone.
    inspected: Inspected,
    index: u32,
    num_parts: u32,
    at: Situation,
}

impl InspectionRecord {
    /// A record of each part of a frame.
    pub(super) fn of_all(inspected: &Inspected, at: &Situation) -> Vec<Self> {
        let indices = 0..inspected.found.iter().count();
        indices
            .map(|index| Self::of(inspected, index, at.clone()))
            .collect()
    }

    fn of(inspected: &Inspected, index: usize, at: Situation) -> Self {
        // Judge with the path, then leave it out of the record: it may be long.
        let answer = Answer::of(&Request::Last, inspected, index, &at);
        let found = Found {
            verdict: answer.verdict,
            captured: inspected.found.first.captured,
            part: answer.part,
            number: answer.number,
            place: answer.place,
            marks: answer.marks,
            pose: answer.pose,
            on_line: answer.on_line,
            on_line_since: inspected
                .found
                .get(index)
                .and_then(|part| part.on_line_since),
            problem: answer.problem,
            ..Found::default()
        };
        Self {
            inspected: Inspected {
                sequence: answer.sequence,
                boot: answer.boot,
                found: FrameParts {
                    facts: answer.facts,
                    ..found.into()
                },
                ..Inspected::default()
            },
            index: answer.index,
            num_parts: answer.num_parts,
            at,
        }
    }

    /// The answer to [`Request::Last`] about this part as of now, except that the path has 0 points and the camera's state is that at the
    /// end of the inspection.
    pub fn answer(&self) -> Answer {
        let now = Situation {
            now: Instant::now(),
            ..self.at.clone()
        };
        Answer {
            index: self.index,
            num_parts: self.num_parts,
            ..Answer::of(&Request::Last, &self.inspected, 0, &now)
        }
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

    /// Records the parts of the next frame with the camera's present status.
    pub fn record(&mut self, found: FrameParts, camera: CameraStatus) -> Vec<InspectionRecord> {
        let inspected = self.inspections.add(found);
        let at = Situation {
            boot: self.boot(),
            max_age: self.max_age,
            camera,
            now: Instant::now(),
        };
        InspectionRecord::of_all(&inspected, &at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FrameFacts, PathStep, RackPlace, VerdictCode};
    use geometry::rigid::RigidTransform;
    use robot::line::OnLine;

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
            }
            .into(),
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
        let fresh = InspectionRecord::of(&inspected, 0, within(hour)).answer();
        assert_eq!(fresh.verdict, VerdictCode::Accepted);
        assert_eq!((fresh.sequence, fresh.boot), (5, 7));
        assert!(fresh.pose.is_some());
        // Fresh when the inspection ended, too old now.
        let record = InspectionRecord {
            at: within(Duration::ZERO),
            ..InspectionRecord::of(&inspected, 0, within(hour))
        };
        std::thread::sleep(Duration::from_millis(2));
        let late = record.answer();
        assert_eq!((late.verdict, late.pose), (VerdictCode::Stale, None));
        assert_eq!(late.part, "fender");
    }

    #[test]
    fn records_without_a_server_are_numbered_and_judged_as_its_own() {
        let found = || {
            inspected(RigidTransform::identity(), RigidTransform::identity())
                .found
                .first
        };
        let mut recorder = InspectionRecorder::new(Duration::from_hours(1));
        let answers = [(), ()].map(|()| {
            let record = recorder.record(found().into(), CameraStatus::default());
            record[0].answer()
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
        let late = strict.record(old.into(), CameraStatus::default())[0].answer();
        assert_eq!((late.verdict, late.pose), (VerdictCode::Stale, None));
    }

    #[test]
    fn a_record_keeps_the_place_what_the_frame_shows_and_where_a_part_is_on_the_line() {
        let mut inspected = inspected(RigidTransform::identity(), RigidTransform::identity());
        let place = RackPlace {
            number: 2,
            name: "right hook".into(),
        };
        let facts = FrameFacts {
            empty_places: Some(vec![place.clone()]),
            ..FrameFacts::default()
        };
        let found = &mut inspected.found;
        found.facts = facts.clone().into();
        found.first.place = Some(place.clone());
        let on_line = OnLine {
            number: 12,
            ..OnLine::default()
        };
        found.first.on_line = Some(on_line);
        found.first.on_line_since = Some(Instant::now());
        let record = InspectionRecord::of(&inspected, 0, within(Duration::from_hours(1)));
        let answer = record.answer();
        assert_eq!((&answer.place, &*answer.facts), (&Some(place), &facts));
        assert_eq!(answer.on_line, Some(on_line));
        assert!(answer.on_line_now().is_some());
        // Without a pose, it is nowhere on the line.
        inspected.found.first.verdict = VerdictCode::Refused;
        let record = InspectionRecord::of(&inspected, 0, within(Duration::from_hours(1)));
        let answer = record.answer();
        assert_eq!(answer.on_line, Some(OnLine::default()));
        assert!(answer.on_line_now().is_none() && answer.place.is_some());
    }

    #[test]
    fn a_path_that_is_not_finite_refuses_the_record_as_it_does_the_answer() {
        let mut endless = RigidTransform::identity();
        endless.translation.vector.x = f64::NAN;
        let inspected = inspected(RigidTransform::identity(), endless);
        let at = within(Duration::from_hours(1));
        let answer = InspectionRecord::of(&inspected, 0, at).answer();
        assert_eq!((answer.verdict, answer.pose), (VerdictCode::Refused, None));
        assert_eq!(answer.problem.reason, "no_pose");
    }
}
