//! Where the robot may be: inside the work volume, and clear of the part and of obstacles.

use nalgebra::Point3;

use crate::StopReason;
use geometry::{
    oriented_box::OrientedBox,
    rigid::{RigidTransform, pose_error},
    segment::Segment,
    units::Metres,
};
use robot::arm::{Joints, Obstacles, PlacedArm};

/// Something on the flange: all points within a radius of the line from the flange to its end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tool {
    /// Its end on the flange, metres: the nozzle's mouth, or the front of the camera.
    pub end: Point3<f64>,
    /// Its radius, metres.
    pub radius: f64,
}

/// The bounds of every commanded pose.
///
/// Known limits: a part that the arm holds is not compared with obstacles, unless tools stand for it. Without the arm's model,
/// only flange and tools are kept clear.
#[derive(Clone, Debug)]
pub struct Fence {
    /// Flange and the ends of the tools stay in this box of the base frame; anywhere without one.
    pub volume: Option<OrientedBox>,
    /// What is on the flange.
    pub tools: Vec<Tool>,
    /// Boxes and floor of the cell, and the least distance from them and from the part. The distance must exceed the bounds of
    /// the calibration: the part is where the calibrated camera sees it.
    pub obstacles: Obstacles,
    /// The arm, if its model is known: it must reach every pose, and stay clear itself. Its own obstacles are not used.
    pub arm: Option<PlacedArm>,
    /// Points of the part's surface, part space, metres; none for a part that the arm holds.
    pub part: Vec<Point3<f32>>,
    /// Where the part was last placed among the obstacles.
    placed: Option<RigidTransform>,
}

/// A part that moves by less than this is not placed anew: metres and radians.
const MIN_MOVE_M_RAD: (f64, f64) = (0.002, 0.002);

impl Fence {
    /// A fence without bounds.
    pub fn none() -> Self {
        Self {
            volume: None,
            tools: Vec::new(),
            obstacles: Obstacles::default(),
            arm: None,
            part: Vec::new(),
            placed: None,
        }
    }

    /// The fence with tools and arm kept this far from the same obstacles.
    pub(crate) fn with_clearance(mut self, clearance: Metres) -> Self {
        self.obstacles.clearance = clearance.0;
        self.completed()
    }

    /// The fence with the arm kept clear of the same obstacles as the tools.
    fn completed(mut self) -> Self {
        if let Some(arm) = &mut self.arm {
            arm.obstacles.clone_from(&self.obstacles);
        }
        self
    }

    /// Points on the flange whose speeds count: the ends of the tools.
    pub(crate) fn ends(&self) -> impl Iterator<Item = Point3<f64>> {
        self.tools.iter().map(|tool| tool.end)
    }

    /// Puts the part where it was seen.
    pub(crate) fn place_part(&mut self, robot_from_part: &RigidTransform, middle: &Point3<f64>) {
        let is_there = self.placed.is_some_and(|placed| {
            let off = pose_error(&placed, robot_from_part, middle);
            off.shift.0 <= MIN_MOVE_M_RAD.0 && off.rotation.0 <= MIN_MOVE_M_RAD.1
        });
        if is_there || self.part.is_empty() {
            return;
        }
        self.placed = Some(*robot_from_part);
        self.obstacles = (self.obstacles.clone()).with_part(&self.part, robot_from_part);
        *self = std::mem::replace(self, Self::none()).completed();
    }

    /// Whether the flange may be here, with the arm's joints near these; returns the joints if the arm is known.
    pub(crate) fn check(
        &self,
        robot_from_flange: &RigidTransform,
        near: Option<&Joints>,
    ) -> Result<Option<Joints>, StopReason> {
        let flange = Point3::from(robot_from_flange.translation.vector);
        if let Some(volume) = &self.volume {
            let ends = self.ends().map(|end| robot_from_flange * end);
            let beyond = ends.chain([flange]).map(|point| volume.distance(&point));
            let beyond_m = beyond.fold(0.0, f64::max);
            if beyond_m > 0.0 {
                return Err(StopReason::OutsideVolume { beyond_m });
            }
        }
        for tool in &self.tools {
            // The round end reaches as far as the tool does.
            let length = tool.end.coords.norm();
            let share = 1.0 - (tool.radius / length.max(tool.radius)).min(1.0);
            let axis = Segment {
                from: flange,
                to: robot_from_flange * Point3::from(tool.end.coords * share),
            };
            if let Some(obstacle) = self.obstacles.nearest_to_tool(&axis, tool.radius) {
                return Err(StopReason::too_near("tool", obstacle));
            }
        }
        let (Some(arm), Some(near)) = (&self.arm, near) else {
            return Ok(None);
        };
        let robot_from_nozzle = robot_from_flange * arm.flange_from_nozzle;
        Ok(Some(arm.joints_near(&robot_from_nozzle, near)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        ServoParams,
        stream::tests::{START, placed},
    };

    #[test]
    fn the_arm_keeps_clear_of_the_boxes_of_the_fence_before_any_part_is_placed() {
        let placed = placed();
        let nozzle = placed.nozzle_pose(&START).expect("finite");
        let robot_from_flange = nozzle * placed.flange_from_nozzle.inverse();
        let mut fence = Fence::none();
        fence.arm = Some(placed);
        let fence = fence.with_clearance(ServoParams::default().clearance);
        let check = |fence: &Fence| fence.check(&robot_from_flange, Some(&START));
        assert!(check(&fence).is_ok());
        // Something all over the arm's room; no tool is compared with it.
        let points = (0..10_i16).flat_map(|x| (-5..5_i16).map(move |y| (x, y)));
        let points = points.flat_map(|(x, y)| (0..20_i16).map(move |z| [x, y, z]));
        let points: Vec<Point3<f32>> = points
            .map(|indices| Point3::from(indices.map(|index| f32::from(index) / 10.0)))
            .collect();
        let mut fence = fence;
        let here = RigidTransform::identity();
        fence.obstacles = Obstacles::default().with_other_part(&points, &here);
        let reason = check(&fence.completed()).expect_err("too near");
        assert_eq!(reason.kind(), "too_near");
    }
}
