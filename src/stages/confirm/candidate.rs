//! One reference's poses, from the placements of its outline to the best refined one.

use nalgebra::{Isometry2, Isometry3, Translation3, UnitQuaternion, Vector3};

use super::{
    COST_LIMIT, FIRST, FIRST_OF_A_PIECE, HOPELESS, Seen,
    evidence::{Evidence, facing_view},
};
use crate::{
    geometry::rigid::{RigidTransform, pose_error},
    stages::{
        pose::{
            PoseEstimate, PoseMethod, RunnerUp, Uncertainty,
            closest::Closest,
            quality::Fit,
            refine::{Level, Refined, Search, cost, refine},
        },
        rank::Placement,
        reference::Reference,
    },
};

/// The best pose of one reference.
pub(super) struct Candidate {
    pub(super) refined: Refined,
    /// The view whose edges it is refined to.
    pub(super) view: usize,
    pub(super) fit: Fit,
    pub(super) evidence: Evidence,
    pub(super) cost: f64,
    /// `None` as long as it is not refined to the end.
    pub(super) uncertainty: Option<Uncertainty>,
    pub(super) runner_up: Option<RunnerUp>,
}

impl Candidate {
    /// Everything known about it so far.
    pub(super) fn estimate(&self) -> PoseEstimate {
        let Self {
            refined,
            fit,
            uncertainty,
            runner_up,
            ..
        } = self;
        PoseEstimate {
            target_from_source: refined.target_from_source,
            method: PoseMethod::Global,
            stopped: refined.stopped,
            iterations: refined.iterations.clone(),
            fit: *fit,
            uncertainty: *uncertainty,
            runner_up: *runner_up,
        }
    }
}

/// A pose of one reference on its way from coarse to fine.
pub(super) struct Trial {
    view: usize,
    refined: Refined,
    pub(super) cost: f64,
}

/// Poses of a whole part on one reference that are refined: too few points decide between the two ways round.
const POSES_OF_A_WHOLE: usize = 2;
/// Poses of a piece: it may lie in several places along the part.
const POSES_OF_A_PIECE: usize = 8;
/// Starts of a piece that lie this close, turn (degrees) and shift (millimetres), are of one place, seen in
/// neighbouring views.
const SAME_PLACE: (f64, f64) = (35.0, 60.0);
/// Starts of a piece from one place.
const STARTS_OF_A_PLACE: usize = 2;
/// Points of the part and of the reference on which the first figures are taken.
const NUM_MEASURED: usize = 500;
const NUM_LOOKED_FOR: usize = 700;
/// Starts of a piece in all.
const MAX_STARTS: usize = 16;

impl Seen<'_> {
    /// The poses that the placements of one reference lead to, the cheapest first.
    pub(super) fn coarse_trials(
        &self,
        reference: &Reference,
        placements: &[Placement],
    ) -> Vec<Trial> {
        let first = match &self.piece {
            Some(_) => &FIRST_OF_A_PIECE,
            None => &FIRST,
        };
        let mut trials: Vec<Trial> = self
            .distinct_starts(reference, placements)
            .into_iter()
            .filter_map(|(view, start)| self.attempt(reference, view, &start, first))
            .collect();
        trials.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        trials
    }

    /// The best of the coarse poses after a finer refinement, with what else fits.
    pub(super) fn best_candidate(
        &self,
        reference: &Reference,
        trials: &[Trial],
        levels: &[Level],
    ) -> Option<Candidate> {
        let num_poses = match &self.piece {
            Some(_) => POSES_OF_A_PIECE,
            None => POSES_OF_A_WHOLE,
        };
        let least = trials.first()?.cost;
        let mut different: Vec<&Trial> = Vec::new();
        for trial in trials {
            let pose = &trial.refined.target_from_source;
            let is_apart =
                |known: &&Trial| self.is_apart(&known.refined.target_from_source, pose, POSE_APART);
            if different.iter().all(is_apart) {
                different.push(trial);
            }
        }
        let mut finer: Vec<Trial> = different
            .into_iter()
            .take(num_poses)
            .filter_map(|trial| {
                let may_win = trial.cost < HOPELESS * least;
                self.finer(reference, trial, if may_win { levels } else { &[] })
            })
            .collect();
        finer.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        // The cost does not know what hides a piece, the evidence does; for a whole part the cost is enough.
        let num_weighed = match &self.piece {
            Some(_) => finer.len(),
            None => 1,
        };
        let mut weighed: Vec<Candidate> = finer
            .iter()
            .take(num_weighed)
            .filter_map(|trial| self.weighed(reference, trial))
            .collect();
        weighed.sort_by(|a, b| b.evidence.score().total_cmp(&a.evidence.score()));
        let mut best = weighed.into_iter().next()?;
        let pose = best.refined.target_from_source;
        let is_other =
            |trial: &&Trial| self.is_apart(&pose, &trial.refined.target_from_source, POSE_APART);
        best.runner_up = finer.iter().find(is_other).map(|other| RunnerUp {
            target_from_source: other.refined.target_from_source,
            ratio: (other.cost / best.cost.max(f64::MIN_POSITIVE)).max(1.0),
        });
        Some(best)
    }

    fn finer(&self, reference: &Reference, trial: &Trial, levels: &[Level]) -> Option<Trial> {
        let start = &trial.refined.target_from_source;
        let mut finer = self.attempt(reference, trial.view, start, levels)?;
        let before = trial.refined.iterations.iter().copied();
        finer.refined.iterations.splice(0..0, before);
        Some(finer)
    }

    fn weighed(&self, reference: &Reference, trial: &Trial) -> Option<Candidate> {
        let pose = &trial.refined.target_from_source;
        let view = facing_view(reference, pose);
        let surface = &self.source.surface;
        let measured = &surface[..NUM_MEASURED.min(surface.len())];
        let target = reference.target(view)?;
        let closest = Closest::of_each(measured, &target, pose, Search::Field);
        let (fit, evidence) = self.weigh(reference, view, pose, &closest, NUM_LOOKED_FOR);
        Some(Candidate {
            refined: trial.refined.clone(),
            cost: trial.cost,
            view,
            fit,
            evidence,
            runner_up: None,
            uncertainty: None,
        })
    }

    /// Neighbouring views lead to nearly the same start: one or two of them are enough.
    fn distinct_starts(
        &self,
        reference: &Reference,
        placements: &[Placement],
    ) -> Vec<(usize, RigidTransform)> {
        let mut starts: Vec<(usize, RigidTransform)> = Vec::new();
        let of_piece = self.piece.as_ref().map(|piece| piece.starts(reference));
        for (view, flat) in of_piece.unwrap_or_default() {
            let start = self.start_of(reference, view, &flat);
            let is_near = |s: &&(usize, RigidTransform)| !self.is_apart(&s.1, &start, SAME_PLACE);
            if starts.iter().filter(is_near).count() < STARTS_OF_A_PLACE {
                starts.push((view, start));
            }
            if starts.len() == MAX_STARTS {
                break;
            }
        }
        for placement in placements {
            let view = &reference.views[placement.view];
            let centroid = &self.scene.query.signature.centroid;
            let flat = view.scene_plane_from_view_plane(placement.turn, centroid);
            let start = self.start_of(reference, placement.view, &flat.inverse());
            let is_apart = |s: &(usize, RigidTransform)| self.is_apart(&s.1, &start, START_APART);
            if starts.iter().all(is_apart) {
                starts.push((placement.view, start));
            }
        }
        starts
    }

    fn attempt(
        &self,
        reference: &Reference,
        view: usize,
        start: &RigidTransform,
        levels: &[Level],
    ) -> Option<Trial> {
        let target = reference.target(view)?;
        let refined = refine(&self.source, &target, start, levels);
        let level = levels.last().unwrap_or(&FIRST[1]);
        let pose = &refined.target_from_source;
        let cost = cost(&self.source, &target, pose, level, COST_LIMIT);
        Some(Trial {
            view,
            refined,
            cost,
        })
    }

    /// The pose that laying the scene's plane onto that of a view stands for.
    fn start_of(
        &self,
        reference: &Reference,
        view: usize,
        view_plane_from_scene_plane: &Isometry2<f64>,
    ) -> RigidTransform {
        let flat = view_plane_from_scene_plane;
        let lifted = Isometry3::from_parts(
            Translation3::new(flat.translation.x, flat.translation.y, 0.0),
            UnitQuaternion::from_axis_angle(&Vector3::z_axis(), flat.rotation.angle()),
        );
        let part_from_plane = reference.views[view].plane_from_part.inverse();
        part_from_plane * lifted * self.scene.query.plane.plane_from_camera
    }

    /// True if two poses, which map from the scene, are apart there by more than a turn and a shift.
    fn is_apart(&self, a: &RigidTransform, b: &RigidTransform, limits: (f64, f64)) -> bool {
        let apart = pose_error(a, b, &self.centre);
        apart.rotation.degrees() > limits.0 || apart.shift.mm() > limits.1
    }
}

/// Turn (degrees) and shift (millimetres) below which two starts lead to the same pose.
const START_APART: (f64, f64) = (8.0, 20.0);
/// Turn and shift beyond which a refinement would not close, so that two poses are different ones.
const POSE_APART: (f64, f64) = (10.0, 50.0);
