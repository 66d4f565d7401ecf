//! One reference's poses, from the placements of its outline to the best refined one.

use std::sync::atomic::{AtomicU64, Ordering};

use nalgebra::{Isometry2, Isometry3, Translation3, Unit, UnitQuaternion, Vector3};

use super::{
    FIRST, FIRST_OF_A_PIECE, MAX_COST_RATIO, PLAINLY_OFF_M, PreparedScene, SECOND, THIRD,
    evidence::{Evidence, facing, facing_view},
    odds,
    piece_search::{PieceSample, Start},
};
use crate::{
    pose::{
        AMBIGUOUS_BELOW, PoseEstimate, PoseMethod, RunnerUp, ScaleEstimate, Uncertainty,
        closest::Correspondence,
        quality::FitQuality,
        refine::{Level, Refined, Search, cost, refine},
    },
    rank::{ImagePlacement, MatchEntry},
    reference::Reference,
};
use geometry::{
    parallel::map_in_order,
    principal::principal_axes,
    rigid::{RigidTransform, pose_error},
    statistics::sample_evenly,
};

/// The best pose of one reference.
#[derive(Clone)]
pub(super) struct ReferenceCandidate {
    pub(super) refined: Refined,
    /// The view whose edges it is refined to.
    pub(super) view: usize,
    pub(super) fit: FitQuality,
    pub(super) evidence: Evidence,
    pub(super) cost: f64,
    /// Whether the first of the last levels was run.
    pub(super) is_settled: bool,
    /// `None` until the pose is fully refined.
    pub(super) uncertainty: Option<Uncertainty>,
    pub(super) runner_up: Option<RunnerUp>,
    /// `None` unless it is the best one and refined to the end.
    pub(super) scale: Option<ScaleEstimate>,
    /// The score of the best other pose, 0 if none was weighed.
    pub(super) rival: f64,
}

impl ReferenceCandidate {
    /// Everything known about it so far.
    pub(super) fn estimate(&self) -> PoseEstimate {
        let Self {
            refined,
            fit,
            uncertainty,
            runner_up,
            scale,
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
            scale: *scale,
        }
    }
}

/// A pose of a piece whose odds are this many times those of another one may still be the wrong one: of two that differ by less,
/// the default recipe accepts neither.
pub(super) const MAX_ODDS_OF_RIVALS: f64 = 4.0;

impl ReferenceCandidate {
    fn is_nearly_as_likely_as(&self, other: &Self) -> bool {
        let odds = |one: &Self| odds(one.evidence.score());
        odds(self) * MAX_ODDS_OF_RIVALS >= odds(other)
    }
}

/// A pose of one reference on its way from coarse to fine.
pub(super) struct PoseTrial {
    view: usize,
    refined: Refined,
    /// Square metres of a whole part, without a unit of a piece.
    pub(super) cost: f64,
    /// Whether it is a piece that is laid on.
    pub(super) is_piece: bool,
}

/// Poses of a whole part on one reference that are refined: too few points decide between the two ways round.
const POSES_OF_A_WHOLE: usize = 2;
/// Poses of a piece: it may lie in several places along the part.
const POSES_OF_A_PIECE: usize = 3;
/// Starts of a piece on all references that are refined. Accepted pieces came from the first seven; eight lost a rival that
/// fitted as well, and accepted the wrong door.
const MOST_REFINED: usize = 10;
/// Where the best start costs more than this, nothing enrolled is there: so few are refined, to say how far off it is.
const HOPELESS_START_COST: f64 = 1.3;
const FEW_REFINED: usize = 3;
/// Where there is a score to beat, starts that cost more than this are not refined: of 14 surfaces accepted in that way,
/// the best start of the worst cost 0.73.
const REFINE_MAX_START_COST: f64 = 1.0;
/// A reference on which the first pairs of a piece led to nothing cheaper is not looked at again, nor is one on which they
/// led to something that costs this much more than the best: of 452 accepted pieces that loses three.
const SECOND_LOOK_MAX_COST: f64 = 1.6;
const SECOND_LOOK_MAX_EXTRA_COST: f64 = 0.8;
/// Where there is a score to beat, none is looked at again if the first pairs led to nothing cheaper on any: of 125 surfaces
/// that beat their score, the worst had 1.0.
const SECOND_LOOK_MAX_COST_TO_BEAT: f64 = 1.2;
/// A start of a piece that costs this much more than the best one is not refined; nor is a pose weighed.
pub(super) const START_MAX_EXTRA_COST: f64 = 0.5;
const POSE_MAX_EXTRA_COST: f64 = 0.35;
/// Points of the part and of the reference on which the first figures are taken.
const NUM_MEASURED: usize = 500;
const NUM_LOOKED_FOR: usize = 700;

impl PreparedScene<'_> {
    /// Of each entry the poses that its placements lead to, the cheapest first; of a piece only those that are worth a
    /// refinement where a score below `least_score` is of no use.
    pub(super) fn trials(
        &self,
        entries: &[&MatchEntry],
        references: &[Reference],
        least_score: f64,
    ) -> Vec<Vec<PoseTrial>> {
        // What fits badly is of use only to say how far off it is.
        let (most_first, most_cost) = if least_score > 0.0 {
            (SECOND_LOOK_MAX_COST, REFINE_MAX_START_COST)
        } else {
            (f64::INFINITY, f64::INFINITY)
        };
        // The least cost so far saves work on the other references, in whatever order they come: what it prunes would be
        // dropped below anyway. Costs are not negative, so their bits sort as they do.
        let least = AtomicU64::new(f64::INFINITY.to_bits());
        let known = || f64::from_bits(least.load(Ordering::Relaxed));
        let first_looks = self.in_parallel(entries.len(), |number| {
            let entry = entries[number];
            let reference = &references[entry.reference];
            let piece = self.piece_for(reference)?;
            let placed = self.distinct_starts(reference, &entry.placements);
            let placed = placed.into_iter().map(|start| start.1);
            let limit = f64::min(known() + SECOND_LOOK_MAX_EXTRA_COST, most_first);
            let first = self.first_look(piece, reference, placed, limit);
            least.fetch_min(first.cost().to_bits(), Ordering::Relaxed);
            Some(first)
        });
        let least_of_first = known();
        let cannot_beat_it = least_score > 0.0 && least_of_first >= SECOND_LOOK_MAX_COST_TO_BEAT;
        let of_references = self.in_parallel(entries.len(), |number| {
            let first = first_looks[number].as_ref();
            let worth_it = first.filter(|first| {
                !cannot_beat_it && first.cost() < least_of_first + SECOND_LOOK_MAX_EXTRA_COST
            });
            let Some(first) = worth_it else {
                return Vec::new();
            };
            if first.cost() >= SECOND_LOOK_MAX_COST {
                return first.starts.clone();
            }
            let reference = &references[entries[number].reference];
            let Some(piece) = self.piece_for(reference) else {
                return Vec::new();
            };
            let limit = f64::min(known() + START_MAX_EXTRA_COST, most_cost);
            let starts = self.second_look(piece, reference, first, limit);
            if let Some(best) = starts.first() {
                least.fetch_min(best.cost.to_bits(), Ordering::Relaxed);
            }
            starts
        });
        let mut starts: Vec<(usize, Start)> = of_references
            .into_iter()
            .enumerate()
            .flat_map(|(number, starts)| starts.into_iter().map(move |start| (number, start)))
            .collect();
        let least = f64::from_bits(least.into_inner());
        starts.sort_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
        starts.truncate(if least < HOPELESS_START_COST {
            MOST_REFINED
        } else {
            FEW_REFINED
        });
        starts.retain(|start| start.1.cost < f64::min(least + START_MAX_EXTRA_COST, most_cost));
        let of_pieces = self.in_parallel(starts.len(), |i| {
            let (number, start) = &starts[i];
            let reference = &references[entries[*number].reference];
            self.attempt_piece(self.piece_for(reference)?, reference, start)
        });
        let mut trials = self.in_parallel(entries.len(), |number| {
            let entry = entries[number];
            let reference = &references[entry.reference];
            if self.piece_for(reference).is_some() {
                return Vec::new();
            }
            let starts = self.distinct_starts(reference, &entry.placements);
            let attempt = |(view, start)| self.attempt(reference, view, &start, &FIRST, None);
            starts.into_iter().filter_map(attempt).collect()
        });
        for ((number, _), trial) in starts.iter().zip(of_pieces) {
            trials[*number].extend(trial);
        }
        for trials in &mut trials {
            trials.sort_by(|a: &PoseTrial, b| a.cost.total_cmp(&b.cost));
        }
        let least = least_piece_cost(&trials);
        let elsewhere = self.in_parallel(entries.len(), |number| {
            let reference = &references[entries[number].reference];
            let piece = self.piece_for(reference)?;
            let best = trials[number].first()?;
            (best.cost < least + POSE_MAX_EXTRA_COST).then(|| {
                let pose = best.refined.target_from_source;
                let slides = self.slides(piece, reference, &pose, best.cost);
                let attempt = |start| self.attempt_piece(piece, reference, start);
                slides.iter().filter_map(attempt).collect::<Vec<_>>()
            })
        });
        for (trials, elsewhere) in trials.iter_mut().zip(elsewhere) {
            if let Some(elsewhere) = elsewhere {
                trials.extend(elsewhere);
                trials.sort_by(|a, b| a.cost.total_cmp(&b.cost));
            }
        }
        let least = least_piece_cost(&trials);
        for trials in &mut trials {
            trials.retain(|trial| !trial.is_piece || trial.cost < least + POSE_MAX_EXTRA_COST);
        }
        trials
    }

    /// Runs `work` on each of `0..num_pieces` and returns the results in order.
    pub(super) fn in_parallel<T: Send>(
        &self,
        num_pieces: usize,
        work: impl Fn(usize) -> T + Sync,
    ) -> Vec<T> {
        map_in_order(num_pieces, self.num_workers, || (), |(), i| work(i))
    }

    /// The best of the coarse poses after a finer refinement, with what else fits.
    pub(super) fn best_candidate(
        &self,
        reference: &Reference,
        trials: &[PoseTrial],
        levels: &[Level],
    ) -> Option<ReferenceCandidate> {
        let piece = self.piece_for(reference);
        let num_poses = match piece {
            Some(_) => POSES_OF_A_PIECE,
            None => POSES_OF_A_WHOLE,
        };
        let least = trials.first()?.cost;
        let mut different: Vec<&PoseTrial> = Vec::new();
        for trial in trials {
            let pose = &trial.refined.target_from_source;
            let is_apart = |known: &&PoseTrial| {
                self.is_apart(&known.refined.target_from_source, pose, POSE_APART_DEG_MM)
            };
            if different.iter().all(is_apart) {
                different.push(trial);
            }
        }
        let mut finer: Vec<PoseTrial> = different
            .into_iter()
            .take(num_poses)
            .filter_map(|trial| {
                let may_win = trial.is_piece || trial.cost < MAX_COST_RATIO * least;
                self.finer(reference, trial, if may_win { levels } else { &[] }, piece)
            })
            .collect();
        finer.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        // For a whole part the cost is enough.
        let may_be_another = piece.is_some() || !self.scene.rack.places.is_empty();
        let num_weighed = if may_be_another { finer.len() } else { 1 };
        let mut weighed: Vec<ReferenceCandidate> = finer
            .iter()
            .take(num_weighed)
            .filter_map(|trial| self.weighed(reference, trial))
            .collect();
        if piece.is_some() {
            weighed.sort_by(|a, b| b.evidence.score().total_cmp(&a.evidence.score()));
        }
        self.put_allowed_first(reference, &mut weighed, piece.is_some());
        let mut weighed = weighed.into_iter();
        let mut best = weighed.next()?;
        let pose = best.refined.target_from_source;
        let is_other = |pose_of_other: &RigidTransform| {
            self.is_apart(&pose, pose_of_other, POSE_APART_DEG_MM)
                && self.competes(reference, pose_of_other, &pose)
        };
        // Of a whole part the runner-up says more.
        best.rival = weighed
            .find(|other| piece.is_some() && is_other(&other.refined.target_from_source))
            .map_or(0.0, |other| other.evidence.score());
        let other = finer
            .iter()
            .find(|trial| is_other(&trial.refined.target_from_source));
        best.runner_up = other.map(|other| RunnerUp {
            target_from_source: other.refined.target_from_source,
            ratio: (other.cost / best.cost.max(f64::MIN_POSITIVE)).max(1.0),
        });
        Some(best)
    }

    /// True if a pose may be the right one in place of `best`: the rack allows it, or does not allow either.
    pub(super) fn competes(
        &self,
        reference: &Reference,
        other: &RigidTransform,
        best: &RigidTransform,
    ) -> bool {
        let rack = self.scene.rack;
        rack.allows_turn(reference, other) || !rack.allows_turn(reference, best)
    }

    /// Moves the first pose that the rack allows to the front, unless the readings alone tell it from the first of all.
    fn put_allowed_first(
        &self,
        reference: &Reference,
        weighed: &mut [ReferenceCandidate],
        is_piece: bool,
    ) {
        let Some(first) = weighed.first() else { return };
        let is_likely = |other: &ReferenceCandidate| {
            if is_piece {
                other.is_nearly_as_likely_as(first)
            } else {
                other.cost < AMBIGUOUS_BELOW * first.cost
            }
        };
        let is_allowed = |one: &ReferenceCandidate| {
            let pose = &one.refined.target_from_source;
            self.scene.rack.allows_turn(reference, pose)
        };
        let mut allowed = weighed.iter();
        if let Some(index) = allowed.position(|one| is_likely(one) && is_allowed(one)) {
            weighed[..=index].rotate_right(1);
        }
    }

    /// Weighs the best pose after half a turn about a principal axis of the reference: a piece of a nearly symmetric part may
    /// fit both ways. If the rack allows only the turned one and it is about as likely, it replaces the candidate's.
    pub(super) fn weigh_turned(&self, reference: &Reference, candidate: &mut ReferenceCandidate) {
        let pose = candidate.refined.target_from_source;
        let Some(turned) = self.turned(reference, &pose) else {
            return;
        };
        let pose_of_turned = turned.refined.target_from_source;
        let is_preferred = !self.competes(reference, &pose, &pose_of_turned);
        if is_preferred
            && turned.is_nearly_as_likely_as(candidate)
            && let Some(finished) = self.finished(reference, &turned)
        {
            *candidate = finished;
            return;
        }
        candidate.rival = candidate.rival.max(turned.evidence.score());
    }

    /// The likeliest pose that competes after half a turn about a principal axis of the reference; `None` of a whole part, and if
    /// every turn leads back to the same pose.
    fn turned(&self, reference: &Reference, pose: &RigidTransform) -> Option<ReferenceCandidate> {
        let piece = self.piece_for(reference)?;
        let points = sample_evenly(&reference.cloud.points, NUM_FOR_AXES);
        let principal = principal_axes(points.map(|p| (p.cast::<f64>(), 1.0)))?;
        let mean = Translation3::from(principal.mean);
        let turned = self.in_parallel(3, |axis| {
            let axis = Unit::new_normalize(principal.axes.column(axis).into_owned());
            let turn = UnitQuaternion::from_axis_angle(&axis, std::f64::consts::PI);
            let start = mean * turn * mean.inverse() * pose;
            let view = facing_view(reference, &start);
            if facing(reference, view, &start) < TURNED_MIN_FACING_COSINE {
                return None;
            }
            let levels = &FIRST_OF_A_PIECE;
            let trial = self.attempt(reference, view, &start, levels, Some(piece))?;
            let trial = self.finer(reference, &trial, &SECOND, Some(piece))?;
            let other = &trial.refined.target_from_source;
            let is_other = self.is_apart(pose, other, POSE_APART_DEG_MM)
                && self.competes(reference, other, pose);
            self.weighed(reference, &trial).filter(|_| is_other)
        });
        let turned = turned.into_iter().flatten();
        turned.max_by(|a, b| a.evidence.score().total_cmp(&b.evidence.score()))
    }

    fn finer(
        &self,
        reference: &Reference,
        trial: &PoseTrial,
        levels: &[Level],
        piece: Option<&PieceSample>,
    ) -> Option<PoseTrial> {
        let start = &trial.refined.target_from_source;
        let finer = self.attempt(reference, trial.view, start, levels, piece)?;
        let mut refined = trial.refined.clone();
        refined.append(finer.refined);
        Some(PoseTrial { refined, ..finer })
    }

    fn weighed(&self, reference: &Reference, trial: &PoseTrial) -> Option<ReferenceCandidate> {
        let pose = &trial.refined.target_from_source;
        let view = facing_view(reference, pose);
        let (fit, evidence) = self.measured(reference, view, pose)?;
        Some(ReferenceCandidate {
            refined: trial.refined.clone(),
            cost: trial.cost,
            view,
            fit,
            evidence,
            runner_up: None,
            scale: None,
            rival: 0.0,
            is_settled: false,
            uncertainty: None,
        })
    }

    /// The first figures of a pose.
    fn measured(
        &self,
        reference: &Reference,
        view: usize,
        pose: &RigidTransform,
    ) -> Option<(FitQuality, Evidence)> {
        let surface = &self.source.surface;
        let measured = &surface[..NUM_MEASURED.min(surface.len())];
        let target = reference.target(view)?;
        let closest = Correspondence::of_each(measured, &target, pose, Search::Field);
        Some(self.evaluate(reference, view, pose, &closest, NUM_LOOKED_FOR))
    }

    /// The candidate after the first of the last levels, measured anew.
    pub(super) fn settled(
        &self,
        reference: &Reference,
        candidate: &ReferenceCandidate,
    ) -> Option<ReferenceCandidate> {
        let mut settled = candidate.clone();
        let target = reference.target(candidate.view)?;
        let start = &candidate.refined.target_from_source;
        settled
            .refined
            .append(refine(&self.source, &target, start, &THIRD[..1]));
        let pose = &settled.refined.target_from_source;
        (settled.fit, settled.evidence) = self.measured(reference, candidate.view, pose)?;
        settled.is_settled = true;
        Some(settled)
    }

    /// Neighbouring views lead to nearly the same start: one or two of them are enough.
    fn distinct_starts(
        &self,
        reference: &Reference,
        placements: &[ImagePlacement],
    ) -> Vec<(usize, RigidTransform)> {
        let mut starts: Vec<(usize, RigidTransform)> = Vec::new();
        for placement in placements {
            let view = &reference.views[placement.view];
            let centroid = &self.scene.query.signature.centroid;
            let flat = view.scene_plane_from_view_plane(placement.turn, centroid);
            let start = self.start_of(reference, placement.view, &flat.inverse());
            let is_apart =
                |s: &(usize, RigidTransform)| self.is_apart(&s.1, &start, START_APART_DEG_MM);
            if starts.iter().all(is_apart) {
                starts.push((placement.view, start));
            }
        }
        starts
    }

    fn attempt_piece(
        &self,
        piece: &PieceSample,
        reference: &Reference,
        start: &Start,
    ) -> Option<PoseTrial> {
        let pose = &start.target_from_source;
        let view = facing_view(reference, pose);
        self.attempt(reference, view, pose, &FIRST_OF_A_PIECE, Some(piece))
    }

    fn attempt(
        &self,
        reference: &Reference,
        view: usize,
        start: &RigidTransform,
        levels: &[Level],
        piece: Option<&PieceSample>,
    ) -> Option<PoseTrial> {
        let target = reference.target(view)?;
        let refined = refine(&self.source, &target, start, levels);
        let level = levels.last().unwrap_or(&FIRST[1]);
        let pose = &refined.target_from_source;
        let cost = match piece {
            Some(piece) => self
                .coarse_cost(piece, reference, pose, f64::INFINITY)
                .unwrap_or(f64::INFINITY),
            None => cost(&self.source, &target, pose, level, PLAINLY_OFF_M),
        };
        Some(PoseTrial {
            view,
            is_piece: piece.is_some(),
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
    pub(super) fn is_apart(
        &self,
        a: &RigidTransform,
        b: &RigidTransform,
        limits: (f64, f64),
    ) -> bool {
        let apart = pose_error(a, b, &self.centre);
        apart.rotation.degrees() > limits.0 || apart.shift.mm() > limits.1
    }
}

fn least_piece_cost(trials: &[Vec<PoseTrial>]) -> f64 {
    let of_pieces = trials.iter().flatten().filter(|trial| trial.is_piece);
    of_pieces
        .map(|trial| trial.cost)
        .fold(f64::INFINITY, f64::min)
}

/// Points of a reference from which its principal axes are taken.
const NUM_FOR_AXES: usize = 1000;
/// A half turn is not tried if its views face the camera less than this (cosine).
const TURNED_MIN_FACING_COSINE: f64 = 0.3;
/// Turn (degrees) and shift (millimetres) below which two starts lead to the same pose.
const START_APART_DEG_MM: (f64, f64) = (8.0, 20.0);
/// Turn and shift beyond which a refinement would not close, so that two poses are different ones.
const POSE_APART_DEG_MM: (f64, f64) = (10.0, 50.0);
