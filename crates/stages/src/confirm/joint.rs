//! Several frames together: a reference is refined to what all of them see of a part, and held against it.
//!
//! The part's points and edges are in one space, the base; the cameras stand around it. The refinement is that of a
//! single frame, with the edges of every view of the reference that a camera looks at.

use nalgebra::{Isometry3, Point3};

use super::{
    JOINT_NOISE_M, POSES_APART_DEG_MM, SECOND, Scene, THIRD,
    evidence::{PATCH_M, facing, facing_view, outline_distance, relief},
    outline_ends::outline_of,
    prepared_scene::centre_of,
};
use crate::{
    pose::{
        PoseEstimate,
        closest::Correspondence,
        edge_points::EdgePoints,
        quality::{FitQuality, Tolerance, measure_fit},
        refine::{AlignmentSource, Level, Search, cost, refine},
        uncertainty::uncertainty,
    },
    reference::Reference,
};
use geometry::{
    rigid::{RigidTransform, pose_error},
    units::Metres,
};

/// Where the part of a frame ends, and what share of its outline is only where the view ends.
#[derive(Clone, Debug)]
pub struct OwnOutline {
    /// Points where the part itself ends, openings included; camera space.
    pub points: Vec<Point3<f64>>,
    /// Share of the outline where only the view ends, 0..1.
    pub cut: f64,
}

/// The outline of a frame's part, less where only the view ends.
pub fn own_outline(scene: &Scene<'_>) -> OwnOutline {
    let outline = outline_of(scene);
    let camera_from_plane = scene.query.plane.plane_from_camera.inverse();
    OwnOutline {
        points: outline.own.iter().map(|p| camera_from_plane * p).collect(),
        cut: outline.cut_share,
    }
}

/// What several frames see of a part, in the base space.
#[derive(Clone, Debug)]
pub struct JointPart {
    /// Its points and edges, each in an order such that any first n are spread over it.
    pub source: AlignmentSource,
    /// Where the cameras are.
    pub cameras: Vec<Point3<f64>>,
    /// Distance at which a point still lies on a reference.
    pub tolerance: Metres,
}

/// A reference at a pose, refined to what several frames see.
#[derive(Clone, Debug)]
pub struct JointFit {
    /// The pose: takes the base space into part space.
    pub estimate: PoseEstimate,
    /// Share of the part's points that lie off the reference, 0..1.
    pub off: f64,
    /// As [`super::Evidence::relief_m`].
    pub relief_m: f64,
    /// As [`super::Evidence::outline_m`].
    pub outline_m: f64,
    /// Cosine of the angle that the reference's face is seen at by the camera that sees it most squarely.
    pub facing: f64,
}

/// Coarse poses that are refined to the end.
const NUM_REFINED: usize = 3;
/// Distance at which a point counts as plainly off, metres.
const PLAINLY_OFF_M: f64 = 0.04;

/// The reference at the different poses that these starts lead to, the cheapest first; starts take the base space into
/// part space. `estimate` gives what a single frame says of the pose besides.
pub fn fit_jointly(
    reference: &Reference,
    part: &JointPart,
    starts: &[(RigidTransform, &PoseEstimate)],
) -> Vec<JointFit> {
    let middle = centre_of(&part.source.surface);
    let mut coarse: Vec<(f64, RigidTransform, &PoseEstimate)> = Vec::new();
    for (start, estimate) in starts {
        let (views, edges) = views_and_edges(reference, part, start);
        let Some(target) = reference.joint_target(&views, &edges) else {
            return Vec::new();
        };
        let refined = refine(&part.source, &target, start, &SECOND);
        let pose = refined.target_from_source;
        let level: &Level = &SECOND[0];
        let cost = cost(&part.source, &target, &pose, level, PLAINLY_OFF_M);
        coarse.push((cost, pose, estimate));
    }
    coarse.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut kept: Vec<(RigidTransform, &PoseEstimate)> = Vec::new();
    for (_, pose, estimate) in coarse {
        let is_apart = |(other, _): &(RigidTransform, &PoseEstimate)| {
            let apart = pose_error(other, &pose, &middle);
            apart.rotation.degrees() > POSES_APART_DEG_MM.0
                || apart.shift.mm() > POSES_APART_DEG_MM.1
        };
        if kept.len() < NUM_REFINED && kept.iter().all(is_apart) {
            kept.push((pose, estimate));
        }
    }
    let fits = kept
        .iter()
        .filter_map(|(pose, estimate)| finished(reference, part, pose, estimate));
    fits.collect()
}

fn finished(
    reference: &Reference,
    part: &JointPart,
    start: &RigidTransform,
    estimate: &PoseEstimate,
) -> Option<JointFit> {
    let (views, edges) = views_and_edges(reference, part, start);
    let target = reference.joint_target(&views, &edges)?;
    let refined = refine(&part.source, &target, start, &THIRD);
    let pose = refined.target_from_source;
    let closest = Correspondence::of_each(&part.source.surface, &target, &pose, Search::Tree);
    let tolerance = Tolerance {
        base: part.tolerance,
        noise_at_1m: Metres(0.0),
    };
    let fit: FitQuality = measure_fit(&part.source.surface, &closest, &target, tolerance);
    let relief_sq = relief(&closest, &target, PATCH_M).powi(2) - JOINT_NOISE_M * JOINT_NOISE_M;
    let num_views = part.cameras.len();
    let bounds = uncertainty(&part.source, &closest, &target, &pose, &THIRD[2], num_views);
    let squarest = part.cameras.iter().map(|camera| {
        let part_from_camera = seen_from(&pose, camera);
        let view = facing_view(reference, &part_from_camera);
        facing(reference, view, &part_from_camera)
    });
    Some(JointFit {
        off: 1.0 - fit.overlap,
        relief_m: relief_sq.max(0.0).sqrt(),
        outline_m: outline_distance(&part.source, &target, &pose, &|_| false).0,
        facing: squarest.fold(0.0, f64::max),
        estimate: PoseEstimate {
            target_from_source: pose,
            stopped: refined.stopped,
            iterations: refined.iterations,
            fit,
            uncertainty: Some(bounds),
            runner_up: None,
            scale: None,
            ..estimate.clone()
        },
    })
}

/// The base space as a camera at this place has its origin: only the place matters.
fn seen_from(part_from_base: &RigidTransform, camera: &Point3<f64>) -> RigidTransform {
    part_from_base * Isometry3::translation(camera.x, camera.y, camera.z)
}

/// The views of a reference that the cameras look at, and their outlines and openings.
fn views_and_edges(
    reference: &Reference,
    part: &JointPart,
    part_from_base: &RigidTransform,
) -> (Vec<usize>, EdgePoints) {
    let mut views: Vec<usize> = part
        .cameras
        .iter()
        .map(|camera| facing_view(reference, &seen_from(part_from_base, camera)))
        .collect();
    views.sort_unstable();
    views.dedup();
    let targets = views.iter().filter_map(|view| reference.target(*view));
    let edges: Vec<Point3<f32>> = targets.flat_map(|target| target.edges.iter()).collect();
    let num_edges = edges.len();
    (views, EdgePoints::new(&edges, num_edges))
}
