//! One reference's poses, from the placements of its outline to the best refined one.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};

use super::{COST_LIMIT, FIRST, Scene, centre_of, fit_of};
use crate::{
    geometry::rigid::{RigidTransform, pose_error},
    stages::{
        pose::{
            PoseEstimate, PoseMethod, RunnerUp,
            quality::{Fit, Tolerance},
            refine::{Level, Refined, Search, Source, cost, refine},
        },
        rank::Placement,
        reference::Reference,
    },
};

/// The best pose of one reference.
pub(super) struct Candidate {
    pub(super) refined: Refined,
    /// The view whose edges it was refined to.
    pub(super) view: usize,
    pub(super) fit: Fit,
    pub(super) runner_up: Option<RunnerUp>,
}

impl Candidate {
    /// Everything known about it so far.
    pub(super) fn estimate(&self) -> PoseEstimate {
        let Self {
            refined,
            fit,
            runner_up,
            ..
        } = self;
        PoseEstimate {
            target_from_source: refined.target_from_source,
            method: PoseMethod::Global,
            stopped: refined.stopped,
            iterations: refined.iterations.clone(),
            fit: *fit,
            uncertainty: None,
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

/// The poses that the placements of one reference lead to, the cheapest first.
pub(super) fn coarse_trials(
    scene: &Scene<'_>,
    source: &Source,
    reference: &Reference,
    placements: &[Placement],
    centre: &Point3<f64>,
) -> Vec<Trial> {
    let mut trials: Vec<Trial> = distinct_starts(scene, reference, placements, centre)
        .into_iter()
        .filter_map(|(view, start)| attempt(source, reference, view, &start, &FIRST))
        .collect();
    trials.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    trials
}

/// The best of the coarse poses after a finer refinement, with what else fits.
pub(super) fn best_candidate(
    scene: &Scene<'_>,
    source: &Source,
    reference: &Reference,
    trials: &[Trial],
    levels: &[Level],
    tolerance: Tolerance,
) -> Option<Candidate> {
    let centre = centre_of(&source.surface);
    // Too few points decide between the two ways round of a near-symmetric part: both go on.
    let first = trials.first()?;
    let is_other = |t: &&Trial| {
        let (a, b) = (
            &first.refined.target_from_source,
            &t.refined.target_from_source,
        );
        is_apart(a, b, &centre, POSE_APART)
    };
    let finer = |trial: &Trial| -> Option<Trial> {
        let Trial { view, refined, .. } = trial;
        let mut finer = attempt(
            source,
            reference,
            *view,
            &refined.target_from_source,
            levels,
        )?;
        finer
            .refined
            .iterations
            .splice(0..0, refined.iterations.iter().copied());
        Some(finer)
    };
    let other = trials.iter().find(is_other);
    let mut contenders: Vec<Trial> = [Some(first), other]
        .into_iter()
        .flatten()
        .filter_map(finer)
        .collect();
    contenders.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let mut contenders = contenders.into_iter();
    let Trial {
        view,
        refined,
        cost,
    } = contenders.next()?;
    let runner_up = contenders
        .next()
        .map(|t| RunnerUp {
            target_from_source: t.refined.target_from_source,
            ratio: t.cost / cost.max(f64::MIN_POSITIVE),
        })
        .filter(|r| {
            is_apart(
                &refined.target_from_source,
                &r.target_from_source,
                &centre,
                POSE_APART,
            )
        });
    let target = reference.target(view)?;
    let fit = fit_of(
        scene,
        source,
        &target,
        &refined.target_from_source,
        tolerance,
        Search::Field,
    );
    Some(Candidate {
        refined,
        view,
        fit,
        runner_up,
    })
}

/// Neighbouring views lead to nearly the same start: one of them is enough.
fn distinct_starts(
    scene: &Scene<'_>,
    reference: &Reference,
    placements: &[Placement],
    centre: &Point3<f64>,
) -> Vec<(usize, RigidTransform)> {
    let mut starts: Vec<(usize, RigidTransform)> = Vec::new();
    for placement in placements {
        let start = start_of(scene, reference, placement);
        if starts
            .iter()
            .all(|s| is_apart(&s.1, &start, centre, START_APART))
        {
            starts.push((placement.view, start));
        }
    }
    starts
}

fn attempt(
    source: &Source,
    reference: &Reference,
    view: usize,
    start: &RigidTransform,
    levels: &[Level],
) -> Option<Trial> {
    let target = reference.target(view)?;
    let refined = refine(source, &target, start, levels);
    let level = levels.last().unwrap_or(&FIRST[1]);
    let cost = cost(
        source,
        &target,
        &refined.target_from_source,
        level,
        COST_LIMIT,
    );
    Some(Trial {
        view,
        refined,
        cost,
    })
}

/// The pose that a placement in the plane stands for.
fn start_of(scene: &Scene<'_>, reference: &Reference, placement: &Placement) -> RigidTransform {
    let view = &reference.views[placement.view];
    let flat = view.scene_plane_from_view_plane(placement.turn, &scene.query.signature.centroid);
    let scene_plane_from_view_plane = Isometry3::from_parts(
        Translation3::new(flat.translation.x, flat.translation.y, 0.0),
        UnitQuaternion::from_axis_angle(&Vector3::z_axis(), flat.rotation.angle()),
    );
    view.plane_from_part.inverse()
        * scene_plane_from_view_plane.inverse()
        * scene.query.plane.plane_from_camera
}

/// Turn (degrees) and shift (millimetres) below which two starts lead to the same pose.
const START_APART: (f64, f64) = (8.0, 20.0);
/// Turn and shift beyond which a refinement would not close, so that two poses are different ones.
const POSE_APART: (f64, f64) = (10.0, 50.0);

fn is_apart(a: &RigidTransform, b: &RigidTransform, at: &Point3<f64>, limits: (f64, f64)) -> bool {
    // At the same point of the scene: the poses map from there.
    let apart = pose_error(a, b, at);
    apart.rotation.degrees() > limits.0 || apart.shift.mm() > limits.1
}
