//! What every program does, in no controller's words.

use nalgebra::Translation3;

use super::{ProgramPoint, ProgramSettings};
use crate::geometry::rigid::RigidTransform;

/// One step of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    /// By the joints, slowly, to the approach point; the gun is off.
    Joints(RigidTransform),
    /// In a straight line.
    Line(Line),
}

/// A straight move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    /// Where to.
    pub(super) to: RigidTransform,
    /// How fast, m/s.
    pub(super) speed: f64,
    /// Radius of the blend there, metres; 0 to reach the point.
    pub(super) blend: f64,
    /// The gun from there on, where it changes.
    pub(super) gun: Option<bool>,
}

impl Line {
    /// The blend of a controller that would switch the gun before a blended point.
    pub(super) fn blend_unless_gun(&self) -> f64 {
        if self.gun.is_some() { 0.0 } else { self.blend }
    }
}

/// A blend may reach this share of the way to the next point: two of them must not touch.
const BLEND_SHARE: f64 = 0.45;

/// The steps over these points, of which there is at least one.
pub(super) fn steps_of(points: &[ProgramPoint], settings: &ProgramSettings) -> Vec<Step> {
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return Vec::new();
    };
    let behind = |point: &ProgramPoint| {
        point.robot_from_nozzle * Translation3::new(0.0, 0.0, -settings.approach.0)
    };
    let place = |point: &ProgramPoint| point.robot_from_nozzle.translation.vector;
    let mut steps = vec![Step::Joints(behind(first))];
    let mut is_on = false;
    // The way to a point goes at the speed of the one before it.
    let mut speed = first.speed.unwrap_or(settings.speed);
    for (i, point) in points.iter().enumerate() {
        let is_last = i + 1 == points.len();
        let wanted = point.is_gun_on && !is_last;
        let neighbours = match (i.checked_sub(1), points.get(i + 1)) {
            (Some(before), Some(next)) => {
                let to = |other: &ProgramPoint| (place(other) - place(point)).norm();
                to(&points[before]).min(to(next))
            }
            // Reached, not blended: the first and the last.
            _ => 0.0,
        };
        steps.push(Step::Line(Line {
            to: point.robot_from_nozzle,
            speed,
            blend: settings.blend.0.min(BLEND_SHARE * neighbours),
            gun: (wanted != is_on).then_some(wanted),
        }));
        is_on = wanted;
        speed = point.speed.unwrap_or(settings.speed);
    }
    steps.push(Step::Line(Line {
        to: behind(last),
        speed,
        blend: 0.0,
        gun: None,
    }));
    steps
}
