//! The right half of the paper's Table I: the remaining E after ICP and after ICP-GA, from T1..T5 (eq. 15).
//!
//! For each part and each `T_k` the source is `T_k` applied to the part's own points, and the target is the part. So
//! the true pose is the inverse of `T_k`, and E can reach zero. The paper captured its parts anew, which adds noise;
//! [`registration`](super::registration) measures that. Our global method is listed next to the paper's two.

use std::time::{Duration, Instant};

use nalgebra::Point3;

use geometry::{
    cloud::PointCloud,
    principal::principal_axes,
    rigid::{PoseDelta, RigidTransform, pose_error},
};
use inspection::library::Library;
use simulate::PartKind;
use stages::{
    pose::{
        AlignParams, PoseError, PoseMethod, PreparedTarget, Stopped, align_to,
        displacements::displacements,
    },
    reference::Reference,
};

/// One part from one of T1..T5.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Name of the part.
    pub part: String,
    /// Index of the transform: 1 for T1, up to 5.
    pub transform: usize,
    /// Number of points of the part, in source and target alike.
    pub num_points: usize,
    /// Time to prepare the target, once for all rows of the part.
    pub preparation: Duration,
    /// One attempt per [`PoseMethod::ALL`].
    pub attempts: [Attempt; 3],
}

/// Result of one method.
#[derive(Clone, Debug, PartialEq)]
pub struct Attempt {
    /// The method.
    pub method: PoseMethod,
    /// Time of the estimation, without preparing the target.
    pub time: Duration,
    /// The pose found, or why there is none.
    pub found: Result<PoseAgainstTruth, PoseError>,
}

/// A pose compared with the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseAgainstTruth {
    /// E (eq. 12) over all points of the source, square metres.
    pub e_m2: f64,
    /// Pose error, with the shift at the source's centroid.
    pub error: PoseDelta,
    /// Number of iterations, including generations.
    pub num_iterations: usize,
    /// Why the estimation stopped.
    pub stopped: Stopped,
}

impl Attempt {
    /// Returns whether E is below the paper's 1e-6 m².
    pub fn is_below_target(&self) -> bool {
        self.found.as_ref().is_ok_and(|found| found.e_m2 < 1e-6)
    }

    /// Returns whether the pose is within 0.01° and 0.1 mm of the truth.
    pub fn is_exact(&self) -> bool {
        self.found.as_ref().is_ok_and(|found| {
            found.error.rotation.degrees() < 0.01 && found.error.shift.mm() < 0.1
        })
    }
}

/// Returns the parts of a library that have a cloud, in the order of Table I, others last.
fn parts(library: &Library) -> Vec<&Reference> {
    let index = |reference: &&Reference| {
        let known = PartKind::ALL.iter();
        let mut names = known.map(|kind| kind.name());
        names
            .position(|name| name == reference.name)
            .unwrap_or(usize::MAX)
    };
    let mut parts: Vec<&Reference> = library
        .references
        .iter()
        .filter(|reference| !reference.cloud.points.is_empty())
        .collect();
    parts.sort_by_key(index);
    parts
}

/// Computes the table with each method's default parameters, and calls `after_row` after each row.
pub fn table1(library: &Library, after_row: impl Fn()) -> Vec<Row> {
    let mut rows = Vec::new();
    for reference in parts(library) {
        let clock = Instant::now();
        let prepared = PreparedTarget::new(&reference.cloud);
        let preparation = clock.elapsed();
        for (k, transform) in displacements().iter().enumerate() {
            rows.push(Row {
                part: reference.name.clone(),
                transform: k + 1,
                num_points: reference.cloud.num_finite(),
                preparation,
                attempts: attempts(reference, &prepared, transform),
            });
            after_row();
        }
    }
    rows
}

fn attempts(
    reference: &Reference,
    prepared: &Result<PreparedTarget, PoseError>,
    source_from_target: &RigidTransform,
) -> [Attempt; 3] {
    let moved = reference
        .cloud
        .points
        .iter()
        .map(|p| (source_from_target * p.cast::<f64>()).cast());
    let source = PointCloud::from_points(moved);
    let truth = source_from_target.inverse();
    let middle = principal_axes(source.points.iter().map(|p| (p.cast(), 1.0)))
        .map_or(Point3::origin(), |axes| axes.mean);
    PoseMethod::ALL.map(|method| {
        let params = AlignParams::from(method);
        let clock = Instant::now();
        let prepared = prepared.as_ref().map_err(|error| *error);
        let aligned =
            prepared.and_then(|target| align_to(&source, target, &params, None, &|| false));
        let time = clock.elapsed();
        let found = aligned.map(|pose| PoseAgainstTruth {
            e_m2: e_m2(&source, reference, &pose.target_from_source),
            error: pose_error(&pose.target_from_source, &truth, &middle),
            num_iterations: pose.iterations.len(),
            stopped: pose.stopped,
        });
        Attempt {
            method,
            time,
            found,
        }
    })
}

/// Computes E (eq. 12).
fn e_m2(source: &PointCloud, target: &Reference, pose: &RigidTransform) -> f64 {
    let moved = pose.cast::<f32>();
    let sum_sq: f64 = source
        .points
        .iter()
        .filter_map(|p| target.tree().nearest(&(moved * p), f32::INFINITY))
        .map(|nearest| f64::from(nearest.distance_sq))
        .sum();
    sum_sq / source.points.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transforms_are_those_of_the_paper_in_the_order_zyx() {
        let [t1, .., t5] = displacements();
        let down = t1 * Point3::new(0.0, 1.0, 0.0);
        assert!((down - Point3::new(0.8, 0.0, 1.5)).norm() < 1e-12, "{down}");
        let (rx, ry, rz) = t5.rotation.euler_angles();
        for (found, expected) in [rx, ry, rz].iter().zip([0.3, 0.1, 0.6]) {
            assert!((found - expected * std::f64::consts::PI).abs() < 1e-12);
        }
    }
}
