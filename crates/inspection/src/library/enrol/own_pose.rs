//! Whether a part can be recognised and its shape fixes its pose, tested by confirming the reference in its own standard
//! view.

use nalgebra::Point3;

use crate::library::EnrolWarning;
use geometry::rigid::RigidTransform;
use stages::{
    confirm::{ConfirmParams, Scene, confirm},
    pose::FreeMotion,
    rack::Rack,
    rank::{Query, RankParams, rank},
    reference::{Coverage, Reference, seen_around},
    scene::SceneCloud,
    segment::SegmentedPart,
};

/// Score that inspections need by default.
const MIN_SCORE: f64 = 0.9;
/// Margin over another pose below which an inspection rejects the pose.
const MIN_LEAD: f64 = 0.05;
/// Turn, degrees: below it, the confirmation distinguishes two poses only by their shift.
const MIN_TURN_DEG: f64 = 10.0;

/// Returns why an inspection of the whole part without noise would not accept it, or what it would find wrong with its pose.
pub(super) fn pose_warning(reference: &Reference, coverage: Coverage) -> Option<EnrolWarning> {
    let view = reference.views.first()?;
    let (_, seen) = seen_around(&reference.cloud, coverage).into_iter().next()?;
    let (plane, contour) = (view.plane(), view.contour());
    let query = Query {
        plane: &plane,
        contour: &contour,
        signature: view.signature(),
    };
    let references = std::slice::from_ref(reference);
    let ranking = rank(&query, references, &RankParams::default());
    let scene = Scene {
        scene: &SceneCloud::default(),
        part: &SegmentedPart::whole(&seen),
        query,
        rack: Rack::ANYWHERE,
        expected: &[],
    };
    let (confirmed, pose) = confirm(&scene, references, &ranking, &ConfirmParams::default(), 0.0);
    let (found, pose) = (confirmed.entries.first()?, pose.ok()?);
    // Only of one capture is it known where the camera was.
    if coverage == Coverage::OneSide && found.score < MIN_SCORE {
        return Some(EnrolWarning::TooLittle {
            score: found.score,
            needed: MIN_SCORE,
        });
    }
    if let Some(freedom) = pose.uncertainty.and_then(|found| found.freedom) {
        return Some(EnrolWarning::Unconstrained(freedom));
    }
    let is_tied = found.rival > 0.0 && found.score - found.rival < MIN_LEAD;
    let other = pose.runner_up.filter(|_| is_tied || pose.is_ambiguous())?;
    let between = pose.target_from_source * other.target_from_source.inverse();
    Some(fits_after(&between, &reference.cloud.points))
}

/// Returns the warning about a part that fits equally well after this motion: it is symmetric if the motion turns it, else
/// its pose is unconstrained.
fn fits_after(motion: &RigidTransform, points: &[Point3<f32>]) -> EnrolWarning {
    let degrees = motion.rotation.angle().to_degrees();
    if degrees < MIN_TURN_DEG {
        EnrolWarning::Unconstrained(FreeMotion::of(motion, points))
    } else {
        EnrolWarning::Symmetric {
            degrees: degrees.round() as u16,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::rigid::from_euler_zyx;
    use stages::pose::Axis;

    #[test]
    fn a_part_that_fits_a_few_degrees_or_a_shift_away_is_unconstrained_and_not_symmetric() {
        // A sheet twice as long as wide, its middle on the z axis.
        let steps = |num: i16| (-num..=num).map(|step| f32::from(step) * 0.01);
        let across = |x: f32| steps(20).map(move |y| Point3::new(x, y, 1.3));
        let points: Vec<Point3<f32>> = steps(40).flat_map(across).collect();
        let fits = |degrees: f64, [x, y]: [f64; 2]| {
            let motion = from_euler_zyx([0.0, 0.0, degrees.to_radians(), x, y, 0.0]);
            fits_after(&motion, &points)
        };
        for (degrees, wanted) in [(180.0, 180), (-90.0, 90), (12.0, 12)] {
            let warning = fits(degrees, [0.06, 0.0]);
            assert_eq!(warning, EnrolWarning::Symmetric { degrees: wanted });
        }
        for (degrees, shift, wanted) in [
            (1.0, [0.06, 0.0], FreeMotion::Slide(Axis::Long)),
            (-1.0, [0.0, -0.06], FreeMotion::Slide(Axis::Short)),
            (8.0, [0.0, 0.0], FreeMotion::Turn(Axis::Normal)),
        ] {
            let warning = fits(degrees, shift);
            assert_eq!(warning, EnrolWarning::Unconstrained(wanted), "{degrees}");
        }
    }
}
