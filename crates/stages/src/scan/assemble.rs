//! Assembles shots into a scan.

use std::sync::Arc;

use nalgebra::Point3;

use super::{
    FusedCloud, Scan, ScanError, ScanObserver, ScanParams, ScanStep, ScannedShot, Shot,
    ShotSurface,
    error::MAX_SHOTS,
    fuse::fuse,
    overlap::{Agreement, overlap},
    part::{keep_best_piece, voters},
    register::{middle_of, register},
    suspects::{Doubt, Excluded, Finding, check},
};
use crate::{field_of_view::FieldOfView, segment::segment};
use geometry::{
    parallel::map_each,
    rigid::{PoseDelta, RigidTransform, pose_error},
    units::{Metres, Radians},
};

/// The fewest readings on a surface from which a pose is determined.
const LEAST_READINGS: usize = 500;

/// Assembles shots: refines their poses, excludes those that do not fit, fuses the rest and finds the part.
pub fn assemble(
    shots: &[Shot],
    params: &ScanParams,
    watch: &dyn ScanObserver,
) -> Result<Scan, ScanError> {
    assemble_all(shots.to_vec(), params, watch)
}

/// As [`assemble`], of shots that the caller does not keep: their readings are not copied.
pub fn assemble_all(
    shots: Vec<Shot>,
    params: &ScanParams,
    watch: &dyn ScanObserver,
) -> Result<Scan, ScanError> {
    let found = shots.len();
    if found < 2 {
        return Err(ScanError::TooFewShots { found });
    }
    if found > MAX_SHOTS {
        return Err(ScanError::TooManyShots { found });
    }
    let shots = with_common_view(shots);
    let is_simulated = shots.iter().any(|shot| shot.scene.cloud.is_simulated);
    let num_workers = params.register.num_workers;
    let prepared = map_each(found, num_workers, |i| {
        if watch.is_cancelled() {
            return Err(ScanError::Cancelled);
        }
        watch.begins(ScanStep::Shot(i));
        prepare(&shots[i], params)
    });
    let mut scanned = prepared.into_iter().collect::<Result<Vec<_>, _>>()?;
    go_on(watch, ScanStep::Align)?;
    let doubt = align(&mut scanned, params, watch)?;
    go_on(watch, ScanStep::Fuse)?;
    let mut cloud = fused(&mut scanned, params);
    cloud.cloud.is_simulated = is_simulated;
    count_new(&cloud, &mut scanned);
    let (before, after) = agreement(&mut scanned, &cloud, num_workers);
    for shot in &mut scanned {
        Arc::make_mut(&mut shot.surface).drop_normals();
    }
    let mut scan = Scan {
        shots: scanned,
        cloud,
        before,
        after,
        doubt,
    };
    scan.doubt = poses_apart(&scan).or(scan.doubt);
    Ok(scan)
}

/// Distance between the places at which two poses put the part that deserves a warning: a robot's typical errors, 3 mm and
/// 0.3°, put it less far apart in 99 of 100 scans of 8 shots.
const MOST_APART: Metres = Metres(0.023);

/// Returns the two shots whose poses disagree most about where the part is, if they disagree more than a robot's do.
fn poses_apart(scan: &Scan) -> Option<Doubt> {
    let middle = scan.cloud.middle_of_part()?;
    let placed: Vec<(&ScannedShot, Point3<f64>)> = scan
        .used()
        .map(|(_, shot)| (shot, shot.given_from_refined() * middle))
        .collect();
    let pairs = placed
        .iter()
        .enumerate()
        .flat_map(|(i, a)| placed[..i].iter().map(move |b| (b, a)));
    let (a, b) = pairs.max_by(|(a, b), (c, d)| {
        let (first, second) = (a.1 - b.1, c.1 - d.1);
        first.norm().total_cmp(&second.norm())
    })?;
    let apart = Metres((a.1 - b.1).norm());
    (apart > MOST_APART).then(|| Doubt::PosesApart {
        names: [a.0.name.clone(), b.0.name.clone()],
        apart,
    })
}

/// Gives every shot the field of view that all of them together show, because one camera took them.
fn with_common_view(mut shots: Vec<Shot>) -> Vec<Shot> {
    let views = shots.iter().map(|shot| shot.scene.field_of_view());
    let common = views.fold(None, FieldOfView::remembered);
    if common.is_some() {
        for shot in &mut shots {
            Arc::make_mut(&mut shot.scene).set_known_view(common.clone());
        }
    }
    shots
}

fn go_on(watch: &dyn ScanObserver, next: ScanStep) -> Result<(), ScanError> {
    if watch.is_cancelled() {
        return Err(ScanError::Cancelled);
    }
    watch.begins(next);
    Ok(())
}

/// Returns a shot with its surface and segmentation.
fn prepare(shot: &Shot, params: &ScanParams) -> Result<ScannedShot, ScanError> {
    let name = || shot.name.clone();
    let num_finite = shot.scene.cloud.finite().take(LEAST_READINGS).count();
    let surface = ShotSurface::from_scene(&shot.scene);
    let too_few = |found| ScanError::TooFewReadings {
        name: name(),
        found,
        needed: LEAST_READINGS,
    };
    let surface = match surface {
        Some(surface) => surface,
        None if num_finite < LEAST_READINGS => return Err(too_few(num_finite)),
        None => return Err(ScanError::NoPicture { name: name() }),
    };
    if surface.num_surface < LEAST_READINGS {
        return Err(too_few(surface.num_surface));
    }
    Ok(ScannedShot {
        name: name(),
        scene: Arc::clone(&shot.scene),
        surface: Arc::new(surface),
        segmentation: Arc::new(segment(&shot.scene, &params.segment).into()),
        finds_part: false,
        given: shot.base_from_camera,
        base_from_camera: shot.base_from_camera,
        moved: PoseDelta {
            rotation: Radians(0.0),
            shift: Metres(0.0),
        },
        before: None,
        after: None,
        after_on_part: None,
        num_new: 0,
        excluded: None,
    })
}

/// Refines the poses and excludes shots until all that remain agree. Returns a doubt about those.
fn align(
    scanned: &mut [ScannedShot],
    params: &ScanParams,
    watch: &dyn ScanObserver,
) -> Result<Option<Doubt>, ScanError> {
    let found = align_as_given(scanned, params, watch);
    if found == Err(ScanError::Cancelled) {
        return found;
    }
    let all_agree = found == Ok(None) && scanned.iter().all(|shot| shot.excluded.is_none());
    let most = largest_shift(scanned);
    // Of a camera that moved in parallel, inverted poses nearly agree, too.
    if (!all_agree || most > params.suspect.max_shift.0 / 2.0)
        && let Some(shift) = shift_of_inverted(scanned, params)
        && (!all_agree || shift < most / 2.0)
    {
        return Err(ScanError::PosesInverted);
    }
    found
}

/// Refines the poses and excludes the shot that fits worst, until all remaining shots agree. They must be a clear majority:
/// otherwise the excluded ones may be the right ones.
fn align_as_given(
    scanned: &mut [ScannedShot],
    params: &ScanParams,
    watch: &dyn ScanObserver,
) -> Result<Option<Doubt>, ScanError> {
    let mut used: Vec<usize> = (0..scanned.len()).collect();
    loop {
        if watch.is_cancelled() {
            return Err(ScanError::Cancelled);
        }
        refine(scanned, &used, params);
        let candidates: Vec<&ScannedShot> = used.iter().map(|&i| &scanned[i]).collect();
        let (which, why) = match check(&candidates, params)? {
            Finding::Fit(doubt) => return require_majority(scanned).map(|()| doubt),
            Finding::Misfit(which, why) => (which, why),
        };
        let number = used.remove(which);
        scanned[number].excluded = Some(why);
        if used.len() < 2 {
            let found = scanned.len();
            let names = scanned.iter().map(|shot| shot.name.clone()).collect();
            let mut reasons = scanned.iter().filter_map(|shot| shot.excluded);
            return Err(if reasons.all(|why| why == Excluded::OverlapsNone) {
                ScanError::NothingOverlaps { found, names }
            } else {
                ScanError::NothingAgrees { found, names }
            });
        }
    }
}

/// Refuses shots of which fewer than two thirds agree.
fn require_majority(scanned: &[ScannedShot]) -> Result<(), ScanError> {
    let (agree, others): (Vec<&ScannedShot>, Vec<&ScannedShot>) =
        scanned.iter().partition(|shot| shot.excluded.is_none());
    if 3 * agree.len() >= 2 * scanned.len() {
        return Ok(());
    }
    let names = |shots: &[&ScannedShot]| shots.iter().map(|shot| shot.name.clone()).collect();
    let mut reasons = others.iter().filter_map(|shot| shot.excluded);
    let (agree, others) = (names(&agree), names(&others));
    Err(if reasons.all(|why| why == Excluded::OverlapsNone) {
        ScanError::Apart {
            these: agree,
            others,
        }
    } else {
        ScanError::NoMajority { agree, others }
    })
}

/// Refines the poses of the shots of these indices together.
fn refine(scanned: &mut [ScannedShot], used: &[usize], params: &ScanParams) {
    let surfaces: Vec<&ShotSurface> = used.iter().map(|&i| &*scanned[i].surface).collect();
    let given: Vec<RigidTransform> = used.iter().map(|&i| scanned[i].given).collect();
    let poses = register(&surfaces, &given, &params.register);
    for (&i, pose) in used.iter().zip(&poses) {
        let shot = &mut scanned[i];
        shot.base_from_camera = *pose;
        shot.moved = pose_error(pose, &shot.given, &middle_of(&shot.surface));
    }
}

/// Returns how far the refinement moved a shot at most, in metres.
fn largest_shift(scanned: &[ScannedShot]) -> f64 {
    let shifts = scanned.iter().map(|shot| shot.moved.shift.0);
    shifts.fold(0.0, f64::max)
}

/// Returns how far the refinement moves a shot at most if each pose is inverted, a common mistake in the file of the poses;
/// `None` if the shots do not agree then.
fn shift_of_inverted(scanned: &[ScannedShot], params: &ScanParams) -> Option<f64> {
    let inverted = |shot: &ScannedShot| ScannedShot {
        given: shot.given.inverse(),
        ..shot.clone()
    };
    let mut inverted: Vec<ScannedShot> = scanned.iter().map(inverted).collect();
    let all: Vec<usize> = (0..inverted.len()).collect();
    refine(&mut inverted, &all, params);
    let found = check(&inverted.iter().collect::<Vec<_>>(), params);
    matches!(found, Ok(Finding::Fit(None))).then(|| largest_shift(&inverted))
}

/// Returns how the used shots agree at the robot's poses and at the refined ones.
fn agreement(
    scanned: &mut [ScannedShot],
    cloud: &FusedCloud,
    num_workers: usize,
) -> (Agreement, Agreement) {
    let is_used = |shot: &&mut ScannedShot| shot.excluded.is_none();
    let mut used: Vec<&mut ScannedShot> = scanned.iter_mut().filter(is_used).collect();
    let surfaces: Vec<Arc<ShotSurface>> = used.iter().map(|s| Arc::clone(&s.surface)).collect();
    let surfaces: Vec<&ShotSurface> = surfaces.iter().map(|s| &**s).collect();
    let given: Vec<RigidTransform> = used.iter().map(|s| s.given).collect();
    let refined: Vec<RigidTransform> = used.iter().map(|s| s.base_from_camera).collect();
    let part = cloud.part_cells();
    let is_part = |point: &Point3<f64>| part.holds(point);
    let before = overlap(&surfaces, &given, is_part, num_workers);
    let after = overlap(&surfaces, &refined, is_part, num_workers);
    for (i, shot) in used.iter_mut().enumerate() {
        shot.before = before.shots[i];
        shot.after = after.shots[i];
        shot.after_on_part = after.shots_on_part[i];
    }
    (before, after)
}

fn fused(scanned: &mut [ScannedShot], params: &ScanParams) -> FusedCloud {
    for number in voters(scanned) {
        scanned[number].finds_part = true;
    }
    for shot in &mut *scanned {
        Arc::make_mut(&mut shot.surface).keep_cosines();
    }
    let all = scanned.iter().enumerate();
    let used = all.filter(|(_, shot)| shot.excluded.is_none());
    let used: Vec<(usize, &ScannedShot)> = used.collect();
    let mut cloud = fuse(&used, params.voxel, params.register.num_workers);
    keep_best_piece(&mut cloud);
    cloud
}

/// Counts for each shot the points that no earlier shot saw.
fn count_new(cloud: &FusedCloud, scanned: &mut [ScannedShot]) {
    for seen_by in &cloud.seen_by {
        if let Some(shot) = scanned.get_mut(seen_by.trailing_zeros() as usize) {
            shot.num_new += 1;
        }
    }
}
