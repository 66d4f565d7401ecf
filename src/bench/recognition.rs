//! Recognition and pose on simulated frames with known truth.

use nalgebra::Point3;

use super::suites::{enrol_part, enrolment_pose};
use crate::{
    geometry::rigid::{PoseError, RigidTransform, pose_error},
    library::{EnrolError, EnrolParams, Library},
    pipeline::{Cancelled, Recipe, Timings, Verdict, Watch, run},
    simulate::{CellSetup, PartKind, PartModel, PartPose, Placement, Side, frame_of_mesh},
    stages::scene::scene_from_frame,
    units::{Metres, Radians},
};

/// Which frames are inspected.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecognitionSetup {
    /// Poses of each part.
    pub num_poses: u64,
    /// Seed of the first frame; the following frames have the following seeds.
    pub first_seed: u64,
    /// Car model whose parts are inspected; the enrolled ones are of model 0.
    pub model_seed: u64,
    /// From where the poses are drawn.
    pub placement: Placement,
}

impl Default for RecognitionSetup {
    fn default() -> Self {
        Self {
            num_poses: 25,
            first_seed: 1_000_000,
            model_seed: 0,
            placement: Placement::placed(),
        }
    }
}

/// The eight parts of the standard car, each enrolled from one frontal capture.
#[derive(Clone, Debug)]
pub struct EnrolledStandard {
    /// The references.
    pub library: Library,
    /// For each of [`PartKind::ALL`] where the part hung when it was enrolled.
    pub camera_from_model: [RigidTransform; 8],
}

/// One inspected frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// The part in the frame.
    pub truth: PartKind,
    /// The frame's seed.
    pub seed: u64,
    /// Name of the best match; `None` if no part was found.
    pub found: Option<String>,
    /// The best match's score.
    pub score: f64,
    /// Whether it was accepted.
    pub is_accepted: bool,
    /// For a right match with a pose: how far the pose is off, the shift taken at the part's middle.
    pub pose_error: Option<PoseError>,
    /// How long the stages took.
    pub timings: Timings,
}

impl Case {
    /// True when the best match is the part in the frame.
    pub fn is_right(&self) -> bool {
        self.found.as_deref() == Some(self.truth.name())
    }

    /// True when the pose is within 2° and 10 mm of the truth.
    pub fn is_well_placed(&self) -> bool {
        self.pose_error
            .is_some_and(|e| e.rotation.degrees() <= 2.0 && e.shift.mm() <= 10.0)
    }
}

/// All inspected frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recognition {
    /// One case per frame.
    pub cases: Vec<Case>,
}

impl Recognition {
    /// Right matches.
    pub fn num_right(&self) -> usize {
        self.cases.iter().filter(|c| c.is_right()).count()
    }

    /// Right and accepted.
    pub fn num_right_accepted(&self) -> usize {
        self.cases
            .iter()
            .filter(|c| c.is_right() && c.is_accepted)
            .count()
    }

    /// Wrong and accepted.
    pub fn num_wrong_accepted(&self) -> usize {
        self.cases
            .iter()
            .filter(|c| !c.is_right() && c.is_accepted)
            .count()
    }

    /// Right, with a pose within 2° and 10 mm.
    pub fn num_well_placed(&self) -> usize {
        self.cases.iter().filter(|c| c.is_well_placed()).count()
    }

    /// A quantile (0..1) of the pose errors of right matches: rotation and shift, each by itself.
    pub fn pose_error_quantile(&self, quantile: f64) -> Option<PoseError> {
        let errors = || self.cases.iter().filter_map(|c| c.pose_error);
        Some(PoseError {
            rotation: Radians(super::speed::quantile(
                errors().map(|e| e.rotation.0),
                quantile,
            )?),
            shift: Metres(super::speed::quantile(
                errors().map(|e| e.shift.0),
                quantile,
            )?),
        })
    }

    /// What was taken for what, and how often, the most frequent first.
    pub fn confusions(&self) -> Vec<(PartKind, String, usize)> {
        let mut confusions: Vec<(PartKind, String, usize)> = Vec::new();
        for case in self.cases.iter().filter(|c| !c.is_right()) {
            let found = case.found.clone().unwrap_or_else(|| "no part".to_owned());
            match confusions
                .iter_mut()
                .find(|c| c.0 == case.truth && c.1 == found)
            {
                Some(known) => known.2 += 1,
                None => confusions.push((case.truth, found, 1)),
            }
        }
        confusions.sort_by_key(|c| std::cmp::Reverse(c.2));
        confusions
    }
}

/// Enrols each part of the standard car from one capture, square-on, 1.3 m before the camera.
pub fn enrol_standard_parts(params: &EnrolParams) -> Result<EnrolledStandard, EnrolError> {
    let references = PartKind::ALL
        .into_iter()
        .map(|kind| enrol_part(kind, Side::Left, 0, params))
        .collect::<Result<_, _>>()?;
    Ok(EnrolledStandard {
        library: Library { references },
        camera_from_model: [enrolment_pose(); 8],
    })
}

/// Inspects the frames of a setup; `after_each` is told how many are done, of how many.
pub fn recognise_all(
    setup: &RecognitionSetup,
    enrolled: &EnrolledStandard,
    recipe: &Recipe,
    watch: &dyn Watch,
    mut after_each: impl FnMut(usize, usize),
) -> Result<Recognition, Cancelled> {
    let mut recognition = Recognition::default();
    let total = setup.num_poses as usize * PartKind::ALL.len();
    for (k, kind) in PartKind::ALL.into_iter().enumerate() {
        let model = PartModel::new(kind, Side::Left, setup.model_seed);
        for pose in 0..setup.num_poses {
            let seed = setup.first_seed + pose * PartKind::ALL.len() as u64 + k as u64;
            let mut cell = CellSetup::with_part(kind, Side::Left, setup.model_seed, seed);
            cell.pose = PartPose::Drawn(setup.placement);
            let shot = frame_of_mesh(&cell, model.mesh());
            let inspection = run(
                &scene_from_frame(&shot.frame),
                &enrolled.library,
                recipe,
                watch,
            )?;
            let (found, score, is_accepted) = match inspection.verdict {
                Verdict::Part {
                    part,
                    score,
                    rejected,
                    ..
                } => (Some(part), score, rejected.is_none()),
                Verdict::NoPart(_) => (None, 0.0, false),
            };
            let is_right = found.as_deref() == Some(kind.name());
            // The reference's space is the camera's when the part was enrolled.
            let model_from_part = enrolled.camera_from_model[k].inverse();
            let camera_from_part = shot.truth.camera_from_part * model_from_part;
            let middle = enrolled.camera_from_model[k] * Point3::origin();
            let pose_error = match inspection.pose {
                Some(Ok(pose)) if is_right => Some(pose_error(
                    &pose.camera_from_part(),
                    &camera_from_part,
                    &middle,
                )),
                _ => None,
            };
            recognition.cases.push(Case {
                truth: kind,
                seed,
                found,
                score,
                is_accepted,
                pose_error,
                timings: inspection.timings,
            });
            after_each(recognition.cases.len(), total);
        }
    }
    Ok(recognition)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline::Unwatched;

    #[test]
    fn the_parts_are_recognised_and_placed() {
        let enrolled = enrol_standard_parts(&EnrolParams::default()).expect("eight parts");
        let setup = RecognitionSetup {
            num_poses: 3,
            first_seed: 2_000_000,
            ..RecognitionSetup::default()
        };
        let result = recognise_all(&setup, &enrolled, &Recipe::default(), &Unwatched, |_, _| ())
            .expect("nobody cancels");
        assert_eq!(result.cases.len(), 24);
        assert!(result.num_right() >= 23, "{:?}", result.confusions());
        assert!(
            result.num_well_placed() >= 22,
            "{:?}",
            result.pose_error_quantile(1.0)
        );
        assert_eq!(result.num_wrong_accepted(), 0);
    }
}
