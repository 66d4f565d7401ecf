//! Makes the steps of a program, which its language writes.

use std::ops::Range;

use nalgebra::Translation3;

use super::{
    Program, ProgramPoint, ProgramSettings, RobotLanguage,
    language::{Calls, Line, Motion, Step},
};
use crate::arm::{PointCheck, Way};

/// Limit of a blend as a share of the way to the next point, so that two blends do not touch.
const MAX_BLEND_SHARE: f64 = 0.45;

/// Speed of the first move of a program that follows a line, m/s.
const TRACKED_APPROACH_SPEED_M_S: f64 = 0.1;

/// The move to the approach point. Of a program that follows a line, it is linear too.
fn first_motion(settings: &ProgramSettings) -> Motion {
    if settings.tracking.is_none() {
        return Motion::Joints(None);
    }
    Motion::Line(Line {
        speed: TRACKED_APPROACH_SPEED_M_S,
        blend: 0.0,
        gun: None,
    })
}

/// Returns the steps of a program with at least one point.
pub(super) fn steps_of(program: &Program<'_>, language: &RobotLanguage) -> Vec<Step> {
    let Program {
        points, settings, ..
    } = program;
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return Vec::new();
    };
    let checked = program.reach.map(|(arm, check)| (&arm.arm, check));
    let ends = checked.and_then(|(_, check)| check.ends.as_ref());
    let is_named = program.names_configurations(language);
    let stands = |point: Option<&PointCheck>| {
        let (arm, _) = checked.filter(|_| is_named)?;
        language.configuration_of(arm, &point?.joints?)
    };
    let rail = |point: Option<&PointCheck>| {
        let (arm, _) = checked?;
        arm.moving_rail()?;
        Some(point?.rail)
    };
    let at = |index: usize| checked.and_then(|(_, check)| check.points.get(index));
    // The pose behind a point, turned and tilted as in the check.
    let behind = |point: &ProgramPoint, end: Option<&PointCheck>| {
        let away = Translation3::new(0.0, 0.0, -settings.params.approach.0);
        end.map_or(point.robot_from_nozzle * away, |end| end.robot_from_nozzle)
    };
    let position = |point: &ProgramPoint| point.robot_from_nozzle.translation.vector;
    let begin = ends.map(|[begin, _]| begin);
    let mut steps = vec![Step {
        to: behind(first, begin),
        configuration: stands(begin),
        rail: rail(begin),
        motion: first_motion(settings),
    }];
    let way = |point: Option<&PointCheck>| point.map_or(Way::Planned, |point| point.way);
    let mut is_on = false;
    // The way to a point has the speed of the point before it.
    let mut speed = first.speed.unwrap_or(settings.params.speed);
    for (i, point) in points.iter().enumerate() {
        let is_last = i + 1 == points.len();
        let wanted = point.is_gun_on && !is_last;
        let neighbours = match (i.checked_sub(1), points.get(i + 1)) {
            (Some(before), Some(next)) => {
                let to = |other: &ProgramPoint| (position(other) - position(point)).norm();
                to(&points[before]).min(to(next))
            }
            // The first and the last point are not blended.
            _ => 0.0,
        };
        let is_joint_move_next = way(at(i + 1)) == Way::Joints;
        let gun = (wanted != is_on).then_some(wanted);
        let most = if gun.is_some() {
            language.max_switching_blend
        } else {
            f64::INFINITY
        };
        let line = Line {
            speed,
            blend: if is_joint_move_next {
                0.0
            } else {
                settings
                    .params
                    .blend
                    .0
                    .min(MAX_BLEND_SHARE * neighbours)
                    .min(most)
            },
            gun,
        };
        steps.push(Step {
            to: point.robot_from_nozzle,
            configuration: stands(at(i)),
            rail: rail(at(i)),
            motion: match way(at(i)) {
                Way::Planned => Motion::Line(line),
                Way::Slower(speed) | Way::SlowerSpraying(speed) => {
                    Motion::Line(Line { speed, ..line })
                }
                Way::Joints => Motion::Joints(gun),
            },
        });
        is_on = wanted;
        speed = point.speed.unwrap_or(settings.params.speed);
    }
    let end = ends.map(|[_, end]| end);
    steps.push(Step {
        to: behind(last, end),
        configuration: stands(end),
        rail: rail(end),
        motion: Motion::Line(Line {
            speed: match way(end) {
                Way::Slower(slower) => slower,
                _ => speed,
            },
            blend: 0.0,
            gun: None,
        }),
    });
    steps
}

/// Cuts the steps where the gun is off into parts of at most `most` instructions; the robot stops there. Fails with the
/// number of instructions if there are more between two such places.
pub(super) fn split(
    steps: &mut [Step],
    calls: &Calls,
    most: usize,
) -> Result<Vec<Range<usize>>, usize> {
    let mut parts: Vec<Range<usize>> = Vec::new();
    let (mut used, mut is_on) = (0, false);
    let strokes = steps.split_inclusive(|step| {
        is_on = step.gun().unwrap_or(is_on);
        !is_on
    });
    for stroke in strokes {
        let needed: usize = stroke.iter().map(|step| step.num_instructions(calls)).sum();
        if needed > most {
            return Err(needed);
        }
        let begin = parts.last().map_or(0, |part| part.end);
        match parts.last_mut() {
            Some(part) if used + needed <= most => {
                part.end += stroke.len();
                used += needed;
            }
            _ => {
                parts.push(begin..begin + stroke.len());
                used = needed;
            }
        }
    }
    for part in &parts {
        if let Motion::Line(line) = &mut steps[part.end - 1].motion {
            line.blend = 0.0;
        }
    }
    Ok(parts)
}
