//! Answers as a list of numbers in parentheses, as read by Universal Robots' `socket_read_ascii_float`.
//!
//! ```text
//! (16, 1, 41, 1234567, 215, 1, 5, 3, 0, 0, 0.0, 1.200500, -0.400000, 1.900000, 0.412000, -0.131000, 1.287000)
//! ```
//!
//! The numbers: count of those that follow, verdict, sequence, boot, age in ms (-1: no frame), camera, flags, number of the
//! part, point, points, speed in mm/s; with a pose also x, y, z in metres and the rotation vector, and of a part on a line its
//! number there, the count (signed), the time since then in ms, the bound in mm and the speed in mm/s. Without a pose the list
//! ends earlier and the function returns a smaller count, so that a program cannot take missing numbers for a pose. An answer
//! to `SERVO` that moves, or is at the target, has four more numbers before the pose: the error that is left in mm and degrees,
//! and its bounds (0: none). With a rack that has places, the number of the part's place is the last one: 0 for none.

use super::ascii::figure;
use crate::answer::Answer;
use robot::{Convention, RobotValue};

pub(super) fn write(answer: &Answer) -> String {
    let mut numbers = vec![
        answer.verdict.code().to_string(),
        answer.sequence.to_string(),
        answer.boot.to_string(),
        answer.age_or_none().to_string(),
        answer.camera.code().to_string(),
        answer.flags().to_string(),
        answer.number.to_string(),
        answer.point.to_string(),
        answer.points.to_string(),
        format!("{:.1}", answer.speed_mm_s.unwrap_or(0.0)),
    ];
    if let Some(error) = &answer.servo_error {
        numbers.extend(error.figures().map(figure));
    }
    if let Some(pose) = &answer.pose {
        let written = Convention::UniversalRobots.write(pose);
        numbers.extend(written.values.iter().map(RobotValue::rounded));
        if let Some(on_line) = &answer.on_line {
            numbers.extend([
                on_line.number.to_string(),
                on_line.count.unwrap_or(0).cast_signed().to_string(),
                answer.on_line_since_or_none().to_string(),
                format!("{:.2}", on_line.bound_mm),
                format!("{:.2}", on_line.speed_mm_s),
            ]);
        }
    }
    numbers.extend(answer.place_number().map(|number| number.to_string()));
    format!("({}, {})\n", numbers.len(), numbers.join(", "))
}

#[cfg(test)]
mod tests {
    use nalgebra::Point3;

    use super::*;
    use crate::{
        answer::{RemainingError, VerdictCode},
        protocol::tests::refused,
    };
    use geometry::{
        rigid::{PoseDelta, from_euler_zyx, pose_error},
        units::{Metres, Radians},
    };

    /// Parses as the function does: the numbers between the parentheses.
    fn read(text: &str) -> Vec<f64> {
        let inner = text
            .strip_prefix('(')
            .and_then(|text| text.strip_suffix(")\n"));
        let inner = inner.unwrap_or_else(|| panic!("{text:?}"));
        let numbers = inner.split(", ");
        numbers
            .map(|number| number.parse().expect("a number"))
            .collect()
    }

    #[test]
    fn an_accepted_part_has_sixteen_numbers_and_a_refused_one_ten() {
        let pose = from_euler_zyx([0.4, -0.2, 1.3, 1.2005, -0.4, 1.9]);
        let accepted = Answer {
            verdict: VerdictCode::Accepted,
            pose: Some(pose),
            ..refused()
        };
        let numbers = read(&write(&accepted));
        assert_eq!(numbers.len(), 17);
        let head = vec![
            16.0,
            1.0,
            41.0,
            1_234_567.0,
            215.0,
            1.0,
            5.0,
            3.0,
            0.0,
            0.0,
            0.0,
        ];
        assert_eq!(numbers[..11].to_vec(), head);
        let found = Convention::UniversalRobots
            .read(&numbers[11..])
            .expect("a pose");
        let off = pose_error(&found, &pose, &Point3::origin());
        assert!(off.shift.mm() < 0.01 && off.rotation.degrees() < 0.001);
        let left = PoseDelta {
            shift: Metres(0.0875),
            rotation: Radians::from_degrees(4.25),
        };
        let moves = Answer {
            verdict: VerdictCode::Move,
            servo_error: Some(RemainingError {
                error: left,
                bounds: None,
            }),
            ..accepted
        };
        let numbers = read(&write(&moves));
        assert_eq!((numbers.len(), numbers[0], numbers[1]), (21, 20.0, 8.0));
        let figures = numbers[11..15].iter().zip([87.5, 4.25, 0.0, 0.0]);
        assert!(
            figures.clone().all(|(a, b)| (a - b).abs() < 1e-3),
            "{numbers:?}"
        );
        let there = Convention::UniversalRobots.read(&numbers[15..]);
        assert_eq!(there, Ok(found));
        let numbers = read(&write(&refused()));
        let head = vec![
            10.0,
            2.0,
            41.0,
            1_234_567.0,
            215.0,
            1.0,
            4.0,
            3.0,
            0.0,
            0.0,
            0.0,
        ];
        assert_eq!(numbers, head);
    }
}
