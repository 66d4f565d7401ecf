//! Poses one after the other, for a robot that moves on before its whole path is known.

use super::{
    PlacedArm, PointProblem,
    kinematics::{Joints, Solver},
};
use geometry::rigid::RigidTransform;

impl PlacedArm {
    /// Pose of the nozzle for these joints, with a rail at its zero; `None` if they are not finite.
    pub fn nozzle_pose(&self, joints: &Joints) -> Option<RigidTransform> {
        Solver::new(self, 0.0).forward(joints)
    }

    /// All joints within their limits that bring the nozzle to a pose, with a rail at its zero.
    pub fn joints_at(&self, robot_from_nozzle: &RigidTransform) -> Vec<Joints> {
        let solver = Solver::new(self, 0.0);
        let solutions = solver.solutions(robot_from_nozzle, None);
        let within = solutions.iter();
        within
            .flat_map(|joints| solver.within_limits(joints))
            .collect()
    }

    /// The joints nearest to `near` that bring the nozzle to a pose in the same configuration, with a rail at its zero, or why
    /// the arm must not go there. The way to it is not checked: give poses that follow each other closely.
    pub fn joints_near(
        &self,
        robot_from_nozzle: &RigidTransform,
        near: &Joints,
    ) -> Result<Joints, PointProblem> {
        let solver = Solver::new(self, 0.0);
        let turned = |joints: &Joints| {
            let turns = joints.iter().zip(near).map(|(to, from)| (to - from).abs());
            turns.fold(0.0, f64::max)
        };
        let solutions = solver.solutions(robot_from_nozzle, Some(near));
        let nearest = |all: &[Joints]| {
            let nearest = all.iter().min_by(|a, b| turned(a).total_cmp(&turned(b)));
            nearest.copied()
        };
        let Some(unlimited) = nearest(&solutions) else {
            return Err(PointProblem::OutOfReach);
        };
        let within: Vec<Joints> = (solutions.iter())
            .flat_map(|joints| solver.within_limits(joints))
            .collect();
        let Some(joints) = nearest(&within) else {
            let (joint, angle) = solver.beyond_limit(&unlimited).unwrap_or_default();
            return Err(PointProblem::JointLimit {
                joint: joint + 1,
                angle,
            });
        };
        // It would have to pass a singularity on the way.
        if self.arm.configuration(&joints) != self.arm.configuration(near) {
            return Err(PointProblem::ConfigurationChange);
        }
        if let Some(singularity) = solver.singularity(&joints) {
            return Err(PointProblem::NearSingularity { singularity });
        }
        match solver.collision(&joints) {
            Some(collision) => Err(collision),
            None => Ok(joints),
        }
    }
}
