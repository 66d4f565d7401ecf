//! ASCII answers: one line of fields, for PLCs.
//!
//! ```text
//! TRIGGER;accepted;41;1234567;215;running;fender;4;5;0;0;;1200.500;-400.125;1900.000;86.0000;-5.0000;120.0000;;
//! ```
//!
//! The fields: request, verdict, sequence, boot, age in ms (-1: no frame), camera, part, number, flags, point, points,
//! speed in mm/s, the numbers of the convention, reason, message. Every answer has every field; without a pose the numbers
//! are empty. Of a part on a line five more follow: its number there, the count, the time since then in ms, the bound in mm and
//! the speed of the line in mm/s. An answer to `SERVO` has four more: the error that is left in mm and degrees, and its bounds;
//! empty where there are none. With a rack that has places, the number of the part's place is the last field: 0 for none.

use super::{MAX_MESSAGE_CHARS, plain};
use crate::answer::Answer;
use crate::request::Request;
use robot::{Convention, RobotValue};

pub(super) fn write(answer: &Answer, convention: Convention) -> String {
    let request = answer.request.as_ref().map_or("NONE", name_of);
    let speed = answer.speed_mm_s.map(|speed| format!("{speed:.1}"));
    let mut fields = vec![
        request.to_owned(),
        answer.verdict.name().to_owned(),
        answer.sequence.to_string(),
        answer.boot.to_string(),
        answer.age_or_none().to_string(),
        answer.camera.name().to_owned(),
        plain(&answer.part, MAX_MESSAGE_CHARS),
        answer.number.to_string(),
        answer.flags().to_string(),
        answer.point.to_string(),
        answer.points.to_string(),
        speed.unwrap_or_default(),
    ];
    match &answer.pose {
        Some(pose) => {
            let written = convention.write(pose);
            fields.extend(written.values.iter().map(RobotValue::rounded));
        }
        None => fields.extend(convention.names().iter().map(|_| String::new())),
    }
    fields.push(plain(&answer.problem.reason, MAX_MESSAGE_CHARS));
    fields.push(plain(&answer.problem.message, MAX_MESSAGE_CHARS));
    if let Some(on_line) = &answer.on_line {
        let count = on_line.count.map(|count| count.to_string());
        fields.extend([
            on_line.number.to_string(),
            count.unwrap_or_default(),
            answer.on_line_since_or_none().to_string(),
            format!("{:.2}", on_line.bound_mm),
            format!("{:.2}", on_line.speed_mm_s),
        ]);
    }
    if let Some(Request::Servo(_)) = answer.request {
        match &answer.servo_error {
            Some(error) => fields.extend(error.figures().map(figure)),
            None => fields.extend([const { String::new() }; 4]),
        }
    }
    fields.extend(answer.place_number().map(|number| number.to_string()));
    let mut line = fields.join(";");
    line.push('\n');
    line
}

/// A figure of an error: millimetres or degrees.
pub(super) fn figure(figure: f64) -> String {
    format!("{figure:.4}")
}

/// The word for a request.
pub(super) fn name_of(request: &Request) -> &'static str {
    request.name().0
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::{
        answer::{Problem, RemainingError, VerdictCode},
        protocol::tests::refused,
        request::ServoRequest,
    };
    use geometry::{
        rigid::{PoseDelta, RigidTransform, from_euler_zyx, pose_error},
        units::{Metres, Radians},
    };
    use robot::line::OnLine;

    fn accepted() -> (Answer, RigidTransform) {
        let pose = from_euler_zyx([0.4, -0.2, 1.3, 1.2005, -0.4, 1.9]);
        let answer = Answer {
            verdict: VerdictCode::Accepted,
            pose: Some(pose),
            problem: Problem::default(),
            ..refused()
        };
        (answer, pose)
    }

    #[test]
    fn an_accepted_part_has_the_numbers_of_the_convention_in_their_order() {
        let (answer, pose) = accepted();
        for convention in Convention::ALL {
            let line = write(&answer, convention);
            let line = line.strip_suffix('\n').expect("a line");
            let fields: Vec<&str> = line.split(';').collect();
            let count = convention.names().len();
            assert_eq!(fields.len(), 14 + count, "{line}");
            assert_eq!(
                fields[..12],
                [
                    "TRIGGER",
                    "accepted",
                    "41",
                    "1234567",
                    "215",
                    "running",
                    "front_door",
                    "3",
                    "5",
                    "0",
                    "0",
                    ""
                ]
            );
            assert_eq!(fields[12 + count..], ["", ""]);
            let numbers: Vec<f64> = fields[12..12 + count]
                .iter()
                .map(|field| field.parse().expect("a number"))
                .collect();
            let read = convention.read(&numbers).expect("a pose");
            let off = pose_error(&read, &pose, &Point3::origin());
            assert!(
                off.shift.mm() < 0.01 && off.rotation.degrees() < 0.001,
                "{line}"
            );
        }
    }

    #[test]
    fn a_part_on_a_line_has_its_number_count_time_and_bound_behind_the_other_fields() {
        let (answer, _) = accepted();
        let plain = write(&answer, Convention::Kuka);
        let on_line = Answer {
            on_line: Some(OnLine {
                number: 12,
                count: Some(4_294_967_290),
                at: jiff::Timestamp::default(),
                bound_mm: 3.456,
                speed_mm_s: -99.5,
            }),
            on_line_since_ms: Some(215),
            ..answer
        };
        let line = write(&on_line, Convention::Kuka);
        let behind = line.strip_prefix(plain.trim_end_matches('\n'));
        assert_eq!(behind, Some(";12;4294967290;215;3.46;-99.50\n"));
    }

    #[test]
    fn a_refused_part_has_empty_numbers_and_a_reason() {
        let line = write(&refused(), Convention::Abb);
        assert_eq!(line.matches('\n').count(), 1);
        assert!(line.is_ascii() && line.ends_with('\n'), "{line}");
        let fields: Vec<&str> = line.trim_end().split(';').collect();
        assert_eq!(fields.len(), 21, "{line}");
        assert_eq!(fields[1], "refused");
        assert_eq!(fields[12..19], [""; 7]);
        assert_eq!(fields[19], "low_score");
        assert!(fields[20].starts_with("it scores, <0.5>"));
    }

    #[test]
    fn a_robot_that_servoes_gets_four_more_fields() {
        let request = Some(Request::Servo(ServoRequest {
            part: 3,
            is_start: false,
            robot_from_flange: RigidTransform::identity(),
        }));
        let stay = Answer {
            request,
            verdict: VerdictCode::Stay,
            ..refused()
        };
        let line = write(&stay, Convention::Kuka);
        let fields: Vec<&str> = line.trim_end().split(';').collect();
        assert_eq!((fields.len(), fields[0], fields[1]), (24, "SERVO", "stay"));
        assert_eq!(
            (&fields[12..18], &fields[20..]),
            (&[""; 6][..], &[""; 4][..])
        );
        let left = PoseDelta {
            shift: Metres(0.0005),
            rotation: Radians::from_degrees(0.02),
        };
        let done = Answer {
            verdict: VerdictCode::Done,
            servo_error: Some(RemainingError {
                error: left,
                bounds: Some(left),
            }),
            ..stay
        };
        let line = write(&done, Convention::Kuka);
        assert!(line.ends_with(";0.5000;0.0200;0.5000;0.0200\n"), "{line}");
    }

    #[test]
    fn a_point_of_the_path_has_its_number_and_its_speed() {
        let (answer, _) = accepted();
        let answer = Answer {
            request: Some(Request::Path {
                point: 2,
                sequence: None,
            }),
            point: 2,
            points: 9,
            speed_mm_s: Some(250.0),
            marks: Answer::GUN_ON,
            ..answer
        };
        let line = write(&answer, Convention::Kuka);
        let fields: Vec<&str> = line.split(';').collect();
        assert_eq!(fields[0], "PATH");
        assert_eq!(fields[8..12], ["9", "2", "9", "250.0"]);
    }
}
