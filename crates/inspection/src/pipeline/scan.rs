//! The inspection of a scan: several frames, one verdict, one pose.
//!
//! Each frame is inspected by itself. The poses found are transformed to the base frame, refined to the points and
//! edges of the part from all frames, and checked against all frames: a point of the reference is present if any
//! frame sees it, missing if a frame looks through it and none sees it, hidden or outside only if it is so for all.
//! Score and verdict follow from this evidence as for a single frame. The pose's bounds include how far the robot's poses of
//! the frames disagree, and how far from there the frames put the part that accept it by themselves.

mod placements;

use std::slice;

use nalgebra::{Point3, Vector3};
use rand::{SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;

use self::placements::{Placement, disagreement};
use super::{
    Cancelled, Inspection, ProgressObserver, Recipe, Rejection, Unrecognisable, Verdict, run,
    unsound::refuse_unsound, verdict::verdict,
};
use crate::library::Library;
use geometry::{
    nearest::KdTree,
    rigid::{PoseDelta, RigidTransform},
    units::{Metres, Radians},
};
use stages::{
    confirm::{
        ConfirmedMatch, ConfirmedRanking, Evidence, Scene,
        joint::{JointFit, JointPart, fit_jointly, own_outline},
    },
    pose::{
        PoseError, PoseEstimate, VisibilityShares,
        quality::{MIN_FACING_COSINE, NUM_LOOKED_FOR, VisibilityCounts},
        refine::AlignmentSource,
    },
    rack::Rack,
    rank::Query,
    reference::Reference,
    scan::{
        Scan, ScannedShot,
        visibility::{Visibility, visibility_at},
    },
    segment::NoPart,
};

/// The result of inspecting a scan.
#[derive(Clone, Debug)]
pub struct ScanInspection {
    /// The result as an inspection of the first used frame; ranking, pose and verdict rest on all frames.
    pub inspection: Inspection,
    /// Number of that frame's shot among all shots.
    pub first: usize,
    /// Pose of the part in the robot's base frame.
    pub base_from_part: Option<RigidTransform>,
}

/// What is kept of a frame's own inspection.
struct FrameFinding {
    /// Number of its shot.
    number: usize,
    ranking: ConfirmedRanking,
    is_accepted: bool,
    /// Points of its outline on the part, base frame.
    edges: Vec<Point3<f32>>,
}

/// Points of the part, approximately, that references are refined to.
const NUM_SURFACE_POINTS: usize = 1500;
/// Edge points of each frame, approximately.
const NUM_EDGE_POINTS: usize = 120;
/// An edge point further than this from the fused part belongs to something else, metres.
const EDGE_MAX_DISTANCE_M: f32 = 0.015;
/// First entries of a frame's ranking whose poses the joint fit starts from.
const NUM_START_ENTRIES: usize = 6;

/// Recognises the part of a scan from all its frames together. The rack is ignored: it is known in the space of one camera.
pub fn run_scan(
    scan: &Scan,
    library: &Library,
    recipe: &Recipe,
    watch: &dyn ProgressObserver,
) -> Result<ScanInspection, Cancelled> {
    let part = scan.cloud.part().cloud.points;
    let tree = KdTree::new(&part);
    let anywhere = &Recipe {
        rack: Rack::default(),
        ..recipe.clone()
    };
    let (mut frames, mut of_first) = (Vec::new(), None);
    for (number, shot) in scan.used() {
        let inspection = run(&shot.scene, library, anywhere, watch)?;
        frames.push(FrameFinding {
            number,
            ranking: inspection.ranking.clone(),
            is_accepted: inspection.verdict.is_accepted(),
            edges: edges_on_part(shot, &inspection, &tree),
        });
        of_first.get_or_insert((number, inspection));
    }
    let (first, mut inspection) = of_first.ok_or(Cancelled)?;
    let base_from_first = scan.shots[first].base_from_camera;
    let Some(part) = joint_part(scan, &part, &frames, recipe) else {
        if inspection.segmentation.part.is_ok() {
            inspection.verdict = Verdict::NoPart(Unrecognisable::from(nothing_in_common(recipe)));
            inspection.pose = None;
        }
        return Ok(ScanInspection {
            inspection,
            first,
            base_from_part: None,
        });
    };
    let mut entries: Vec<ConfirmedMatch> = Vec::new();
    for (index, reference) in library.references.iter().enumerate() {
        if watch.is_cancelled() {
            return Err(Cancelled);
        }
        entries.extend(entry_of(scan, &frames, (index, reference), &part, recipe));
    }
    let middle = scan.cloud.middle_of_part();
    // A stable sort: equal scores keep the library's order.
    entries.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut disagree_most = false;
    for (index, entry) in entries.iter_mut().enumerate() {
        if let Some(pose) = &mut entry.pose {
            // The part is no better placed in the base frame than the robot's poses agree.
            let apart = middle.map(|middle| {
                apart(
                    scan,
                    &frames,
                    entry.reference,
                    &pose.target_from_source,
                    &middle,
                )
            });
            let bounds = pose.uncertainty.zip(apart);
            if index == 0 {
                disagree_most = bounds.is_some_and(|(own, apart)| apart.shift > own.shift);
            }
            pose.uncertainty = bounds.map(|(bounds, apart)| bounds.widened(&apart));
            pose.target_from_source *= base_from_first;
            for step in &mut pose.iterations {
                step.target_from_source *= base_from_first;
            }
        }
    }
    let pose = entries.first().and_then(|best| {
        let reference = library.references.get(best.reference);
        let is_flat = reference.is_none_or(|reference| reference.cloud.points.is_empty());
        match &best.pose {
            Some(pose) => Some(Ok(pose.clone())),
            None if is_flat => Some(Err(PoseError::NoReferenceCloud)),
            // Its score was too low for a pose search, or no frame found a pose.
            None => None,
        }
    });
    inspection.ranking = ConfirmedRanking { entries };
    inspection.verdict = verdict(&inspection.ranking, pose.as_ref(), recipe);
    if let Verdict::Part {
        rejected: Some(Rejection::Uncertain {
            frames_disagree, ..
        }),
        ..
    } = &mut inspection.verdict
    {
        *frames_disagree = disagree_most;
    }
    let camera_from_part = pose.as_ref().and_then(|pose| pose.as_ref().ok());
    let base_from_part = camera_from_part.map(|pose| base_from_first * pose.camera_from_part());
    inspection.pose = pose;
    refuse_unsound(&mut inspection, &scan.shots[first].scene);
    recipe
        .expected
        .refuse_others(slice::from_mut(&mut inspection));
    Ok(ScanInspection {
        inspection,
        first,
        base_from_part,
    })
}

/// Returns how far the robot's poses of the frames disagree about where a reference is. `middle` is the middle of the part,
/// base frame.
fn apart(
    scan: &Scan,
    frames: &[FrameFinding],
    reference: usize,
    part_from_base: &RigidTransform,
    middle: &Point3<f64>,
) -> PoseDelta {
    let accepted = frames.iter().filter_map(|frame| {
        let own = frame.ranking.entries.first();
        let own = own.filter(|own| frame.is_accepted && own.reference == reference)?;
        let given = &scan.shots[frame.number].given;
        let pose = own.pose.as_ref()?;
        Placement::of(frame.number, given, pose, part_from_base, middle)
    });
    let placements: Vec<Placement> = accepted.collect();
    let numbers = [frames.first(), frames.last()].map(|frame| frame.map_or(0, |f| f.number));
    let by_poses = scan.disagreement(middle);
    let by_themselves = disagreement(&placements, numbers);
    PoseDelta {
        rotation: Radians(by_poses.rotation.0.max(by_themselves.rotation.0)),
        shift: Metres(by_poses.shift.0.max(by_themselves.shift.0)),
    }
}

fn nothing_in_common(recipe: &Recipe) -> NoPart {
    NoPart::OnlyBackground {
        planes: 0,
        found: 0.0,
        needed: recipe.segment.min_part_area,
        knows_cell: false,
    }
}

/// Points of a frame's outline on the fused part, base frame.
fn edges_on_part(shot: &ScannedShot, inspection: &Inspection, tree: &KdTree) -> Vec<Point3<f32>> {
    let (Ok(part), Some(plane), Some(contour), Some(signature)) = (
        &inspection.segmentation.part,
        &inspection.plane,
        &inspection.contour,
        &inspection.signature,
    ) else {
        return Vec::new();
    };
    let query = Query {
        plane,
        contour,
        signature,
    };
    let own = own_outline(&Scene {
        scene: &shot.scene,
        part,
        query,
        rack: Rack::ANYWHERE,
        expected: &[],
    });
    let in_base = own
        .points
        .iter()
        .map(|p| (shot.base_from_camera * p).cast::<f32>());
    let of_part = in_base.filter(|p| {
        tree.nearest(p, EDGE_MAX_DISTANCE_M * EDGE_MAX_DISTANCE_M)
            .is_some()
    });
    let of_part: Vec<Point3<f32>> = of_part.collect();
    let step = (of_part.len() / NUM_EDGE_POINTS).max(1);
    of_part.into_iter().step_by(step).collect()
}

/// The part as all frames see it; `None` if they see too little of it.
fn joint_part(
    scan: &Scan,
    points: &[Point3<f32>],
    frames: &[FrameFinding],
    recipe: &Recipe,
) -> Option<JointPart> {
    if points.len() < 50 {
        return None;
    }
    let mut random = Pcg64::seed_from_u64(recipe.confirm.seed);
    let mut surface: Vec<Point3<f32>> = points
        .iter()
        .step_by((points.len() / NUM_SURFACE_POINTS).max(1))
        .copied()
        .collect();
    surface.shuffle(&mut random);
    let edges = frames.iter().flat_map(|frame| &frame.edges);
    let mut edges: Vec<Point3<f32>> = edges.copied().collect();
    edges.shuffle(&mut random);
    Some(JointPart {
        source: AlignmentSource { surface, edges },
        cameras: scan
            .used()
            .map(|(_, shot)| Point3::from(shot.base_from_camera.translation.vector))
            .collect(),
        tolerance: recipe.confirm.tolerance,
    })
}

/// Factor on the score of a single frame where no pose fits all frames.
const NO_JOINT_FIT_FACTOR: f64 = 0.3;
/// Largest share of the part that may lie off a reference; with more, the reference fits something else in the frames.
const MAX_OFF_SHARE: f64 = 0.5;

/// Checks one reference against all frames; `None` if no frame ranked it.
fn entry_of(
    scan: &Scan,
    frames: &[FrameFinding],
    (index, reference): (usize, &Reference),
    part: &JointPart,
    recipe: &Recipe,
) -> Option<ConfirmedMatch> {
    let mut best: Option<&ConfirmedMatch> = None;
    let mut starts: Vec<(RigidTransform, &PoseEstimate)> = Vec::new();
    for frame in frames {
        let ranked = frame.ranking.entries.iter().enumerate();
        let Some((rank, entry)) = ranked.into_iter().find(|(_, e)| e.reference == index) else {
            continue;
        };
        if best.is_none_or(|best| entry.score > best.score) {
            best = Some(entry);
        }
        if let Some(pose) = entry.pose.as_ref().filter(|_| rank < NUM_START_ENTRIES) {
            let camera_from_base = scan.shots[frame.number].base_from_camera.inverse();
            starts.push((pose.target_from_source * camera_from_base, pose));
        }
    }
    let best = best?;
    let with_evidence = frames.iter().flat_map(|frame| {
        let entries = frame.ranking.entries.iter();
        entries.filter(|entry| entry.reference == index)
    });
    let of_frame = with_evidence
        .filter_map(|entry| Some((entry.score, entry.evidence?)))
        .reduce(|a, b| if b.0 > a.0 { b } else { a });
    let Some((_, of_frame)) = of_frame else {
        return Some(best.clone());
    };
    let fits = fit_jointly(reference, part, &starts).into_iter();
    let fits = fits.filter(|fit| fit.off <= MAX_OFF_SHARE);
    let weighed = fits.map(|fit| {
        let (evidence, sight) =
            evidence(scan, reference, &fit, (&of_frame, recipe.confirm.tolerance));
        let mut pose = fit.estimate;
        pose.fit.sight = sight;
        (evidence, pose)
    });
    let found = weighed.reduce(|a, b| if b.0.score() > a.0.score() { b } else { a });
    Some(match found {
        Some((evidence, pose)) => ConfirmedMatch {
            score: evidence.score(),
            pose: Some(pose),
            evidence: Some(evidence),
            ..best.clone()
        },
        None => ConfirmedMatch {
            score: best.score
                * if best.pose.is_some() {
                    NO_JOINT_FIT_FACTOR
                } else {
                    1.0
                },
            pose: None,
            evidence: None,
            ..best.clone()
        },
    })
}

/// The used shots, each with the pose of the part in its camera frame.
fn shots_of<'a>(
    scan: &'a Scan,
    base_from_part: &RigidTransform,
) -> Vec<(&'a ScannedShot, RigidTransform)> {
    let used = scan.used();
    used.map(|(_, shot)| (shot, shot.base_from_camera.inverse() * base_from_part))
        .collect()
}

/// What all shots together see in the place of a reference point; `None` if it faces away from all cameras.
fn seen_together(
    shots: &[(&ScannedShot, RigidTransform)],
    point: &Point3<f32>,
    normal: &Vector3<f32>,
    tolerance: Metres,
) -> Option<Visibility> {
    // The most informative first.
    let rank = |look: &Visibility| match look {
        Visibility::Here(_) => 0,
        Visibility::Through => 1,
        Visibility::NoReading => 2,
        Visibility::Hidden => 3,
        Visibility::Outside => 4,
    };
    let looks = shots.iter().filter_map(|(shot, camera_from_part)| {
        let at = camera_from_part * point.cast::<f64>();
        let normal = camera_from_part.rotation * normal.cast::<f64>();
        if -normal.dot(&at.coords) < MIN_FACING_COSINE * at.coords.norm() {
            return None;
        }
        let noise = 3.0 * shot.surface.noise_at_1m.0 * at.z * at.z;
        Some(visibility_at(
            &shot.surface,
            &at,
            &normal,
            tolerance.0 + noise,
        ))
    });
    looks.min_by_key(rank)
}

/// Indices of the reference points that no shot shows at this pose: hidden, outside every picture, without a reading,
/// or facing away from all cameras.
pub fn unseen_points(
    scan: &Scan,
    reference: &Reference,
    base_from_part: &RigidTransform,
    tolerance: Metres,
) -> Vec<usize> {
    let shots = shots_of(scan, base_from_part);
    let cloud = &reference.cloud;
    let normals = cloud.normals.as_deref().unwrap_or_default();
    let is_unseen = |(point, normal): (&Point3<f32>, &Vector3<f32>)| {
        let seen = seen_together(&shots, point, normal, tolerance);
        !matches!(seen, Some(Visibility::Here(_) | Visibility::Through))
    };
    let all = cloud.points.iter().zip(normals).enumerate();
    all.filter(|(_, both)| is_unseen(*both))
        .map(|(index, _)| index)
        .collect()
}

/// The evidence of all frames for a reference at its pose. Figures that need a single frame are those of the frame
/// with the best score.
fn evidence(
    scan: &Scan,
    reference: &Reference,
    fit: &JointFit,
    (of_frame, tolerance): (&Evidence, Metres),
) -> (Evidence, Option<VisibilityShares>) {
    let base_from_part = fit.estimate.camera_from_part();
    let shots = shots_of(scan, &base_from_part);
    let cloud = &reference.cloud;
    let normals = cloud.normals.as_deref().unwrap_or_default();
    let step = (cloud.points.len() / NUM_LOOKED_FOR).max(1);
    let mut sights = VisibilityCounts::default();
    for (point, normal) in cloud.points.iter().zip(normals).step_by(step) {
        let count = match seen_together(&shots, point, normal, tolerance) {
            Some(Visibility::Here(_)) => &mut sights.confirmed,
            Some(Visibility::Through) => &mut sights.missing,
            Some(Visibility::NoReading) => &mut sights.unknown,
            Some(Visibility::Hidden) => &mut sights.hidden,
            Some(Visibility::Outside) => &mut sights.outside,
            // It faces away from all cameras.
            None => continue,
        };
        *count += 1.0;
    }
    let sight = sights.shares();
    let evidence = Evidence {
        off: fit.off,
        beyond: 0.0,
        missing: sights.missing / (sights.confirmed + sights.missing).max(f64::MIN_POSITIVE),
        hidden: sight.map_or(0.0, |s| s.hidden),
        outside: sight.map_or(1.0, |s| s.outside),
        relief_m: fit.relief_m,
        outline_m: fit.outline_m,
        outline_shift_m: None,
        outline_median_m: None,
        // A single frame may cut the part off; for all frames together, `outside` covers it.
        cut: 0.0,
        facing: fit.facing,
        close: None,
        ..*of_frame
    };
    (evidence, sight)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use nalgebra::Translation3;

    use super::*;
    use crate::{fixtures::shipped_library, pipeline::Unwatched};
    use geometry::{error::Advice as _, rigid::pose_error};
    use simulate::{PartKind, ScanSetup, Side, SimulatedObject, SimulatedScan};
    use stages::{
        scan::{ScanParams, Shot, Unwatched as UnwatchedScan, assemble},
        scene::scene_from_frame,
    };

    /// Inspects a scan of a front door at the true poses, and at poses that drift by this many millimetres per frame.
    fn inspected(num_shots: usize, seed: u64, drift_mm: [f64; 3]) -> [ScanInspection; 2] {
        let simulated = SimulatedScan::new(ScanSetup {
            subject: SimulatedObject::Part {
                kind: PartKind::FrontDoor,
                side: Side::Left,
                model_seed: 0,
            },
            num_shots,
            place_error: Metres(0.0),
            turn_error: Radians(0.0),
            noise: 1.0,
            seed,
        });
        let frames = simulated.shots();
        let library = shipped_library();
        [0.0, 1e-3].map(|metres| {
            let shots = frames.iter().enumerate().map(|(k, shot)| Shot {
                name: format!("shot {k}"),
                scene: Arc::new(scene_from_frame(&shot.frame)),
                base_from_camera: Translation3::from(Vector3::from(drift_mm) * (metres * k as f64))
                    * shot.base_from_camera,
            });
            let shots: Vec<Shot> = shots.collect();
            let scan = assemble(&shots, &ScanParams::default(), &UnwatchedScan).expect("a scan");
            run_scan(&scan, &library, &Recipe::default(), &Unwatched).expect("not cancelled")
        })
    }

    fn bound_mm(found: &ScanInspection) -> f64 {
        let pose = found.inspection.found_pose().expect("a pose");
        pose.bounds().expect("bounds").shift.mm()
    }

    fn apart_mm(found: &[ScanInspection; 2]) -> f64 {
        let [a, b] = found
            .each_ref()
            .map(|found| found.base_from_part.expect("a pose"));
        pose_error(&a, &b, &Point3::new(0.0, 0.0, 1.3)).shift.mm()
    }

    #[test]
    fn a_drift_of_the_poses_is_in_the_bounds() {
        let found = inspected(3, 4, [0.0, 0.0, 12.0]);
        let ([right, drifted], off) = (&found, apart_mm(&found));
        assert!(right.inspection.verdict.is_accepted());
        assert!(bound_mm(right) < 5.0, "{}", bound_mm(right));
        // The refined poses are the mean of 0, 12 and 24 mm.
        assert!((10.0..14.0).contains(&off), "{off}");
        // Beside the poses, noise moves the result by half a millimetre.
        let bound = bound_mm(drifted);
        assert!(bound + 0.5 >= off, "{bound} {off}");
        let why = drifted.inspection.verdict.rejected();
        let disagree = matches!(
            why,
            Some(Rejection::Uncertain {
                frames_disagree: true,
                ..
            })
        );
        assert!(disagree, "{why:?}");
        let advice = drifted
            .inspection
            .verdict
            .refusal()
            .expect("refused")
            .advice();
        assert!(advice.starts_with("Check the robot's pose"), "{advice}");
    }

    #[test]
    fn a_drift_along_the_part_is_in_the_bounds_though_the_refinement_absorbs_it() {
        let found = inspected(4, 2, [0.0, 6.0, 0.0]);
        let ([right, drifted], off) = (&found, apart_mm(&found));
        assert!(right.inspection.verdict.is_accepted());
        // The mean of 0, 6, 12 and 18 mm. The farthest frame by itself explains 8.3 mm.
        assert!((8.4..10.5).contains(&off), "{off}");
        let bound = bound_mm(drifted);
        assert!(bound >= off, "{bound} {off}");
    }
}
