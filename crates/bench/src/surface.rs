//! Dents and bumps in simulated parts: which are found, and what is found where there is none.
//!
//! A dent of 20 to 80 mm width and 1 to 6 mm depth, one in four of them a bump, is pressed into the part where the camera sees a
//! smooth surface. It counts as one that must be found if the average over a patch shows more than three times its own noise of it.
//! The same poses without a dent say how often a region is found where there is none.

use nalgebra::{Point3, Unit, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use serde::Serialize;

use crate::{
    bounds::{BoundsLibrary, BoundsPart},
    suites::{enrolled_name, enrolment_pose},
};
use geometry::{
    cloud::is_finite,
    mesh::TriangleMesh,
    parallel::{map_each, num_cores},
    rigid::RigidTransform,
    units::Metres,
};
use inspection::{
    library::{EnrolError, EnrolParams, PartDescription, PartName, enrol_captured},
    pipeline::{Inspection, Recipe, Unwatched, live::DepthAverage, measure_surface, run},
};
use simulate::{
    CellSetup, Dent, PartKind, PartPose, SensorNoise, Side, SimulatedObject, SurfaceLabel, frame,
    frame_of_mesh,
};
use stages::{
    deviation::{
        Deviation, DeviationParams, DeviationRegion, PATCH_RADIUS_M, RegionKind, share_in_average,
    },
    scene::{SceneCloud, scene_from_frame},
};

/// Number of frames averaged at enrolment, where several are.
pub const NUM_ENROLLED_FRAMES: u64 = 16;
/// How many times its noise the average must show of a dent that counts.
pub const LEAST_TIMES: f64 = 3.0;
/// Widths and depths of dents, metres.
const WIDTHS_M: std::ops::Range<f64> = 0.02..0.08;
const DEPTHS_M: std::ops::Range<f64> = 0.001..0.006;
/// Distance around a dent that must show a smooth surface too, metres.
const AROUND_M: f64 = 0.015;
/// Slope of what is around against the surface in its middle, up to which it is smooth.
const MAX_SLOPE: f64 = 0.3;
/// Cosine to the ray from which a dent is put there.
const MIN_FACING_COSINE: f64 = 0.6;
/// Number of places tried for a dent.
const NUM_TRIES: usize = 2000;
/// Distance from a dent's edge up to which a region's middle is taken for it, metres.
const NEAR_M: f64 = 0.025;

/// How an experiment is run.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceSetup {
    /// Poses of each part, each once with a dent and once without.
    pub num_poses: u64,
    /// Seed of the first.
    pub first_seed: u64,
    /// Frames averaged, 1..=64.
    pub num_frames: u64,
    /// Multiplier of a Kinect's noise.
    pub noise: f64,
}

/// A dent or bump that was pressed into a part.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DentCase {
    /// Its diameter, millimetres.
    pub width_mm: f64,
    /// Its height in the middle, millimetres; below 0 for a dent.
    pub height_mm: f64,
    /// What the average over a patch shows of it, millimetres.
    pub shown_mm: f64,
    /// Noise of that average, millimetres; `None` if nothing is judged there.
    pub noise_mm: Option<f64>,
    /// True if a region of its kind is there.
    pub found: bool,
}

impl DentCase {
    /// True if the average shows more of it than [`LEAST_TIMES`] its noise.
    pub fn must_be_found(&self) -> bool {
        let shown = self.shown_mm.abs();
        self.noise_mm
            .is_some_and(|noise| shown > LEAST_TIMES * noise)
    }
}

/// A region that was found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RegionCase {
    /// What it is.
    pub kind: RegionKind,
    /// Area, square millimetres.
    pub area_mm2: f64,
    /// How far outside of the reference, millimetres.
    pub off_mm: Option<f64>,
    /// What it had to exceed, millimetres.
    pub limit_mm: f64,
    /// Middle, part space, metres.
    pub centre: [f64; 3],
    /// True if it is the dent.
    pub is_dent: bool,
}

/// One part, seen in several frames.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurfaceCase {
    /// The part.
    pub part: String,
    /// How it was enrolled.
    pub enrolled: String,
    /// Seed of its pose.
    pub seed: u64,
    /// The dent; `None` of a good part, and of one whose surface was not judged.
    pub dent: Option<DentCase>,
    /// True if the part was recognised and accepted.
    pub accepted: bool,
    /// Why its surface was not judged although it was accepted.
    pub not_judged: Option<String>,
    /// Noise of the average: the median over the part, millimetres.
    pub noise_mm: Option<f64>,
    /// What of it differs between frames, millimetres.
    pub noise_between_mm: Option<f64>,
    /// How many times its noise an average must exceed.
    pub limit_factor: Option<f64>,
    /// Depth of the dents of 20, 40 and 80 mm that are found in 95 of 100 cases, millimetres.
    pub smallest_mm: Option<[f64; 3]>,
    /// Share of the surface that was judged.
    pub seen: Option<f64>,
    /// What was found.
    pub regions: Vec<RegionCase>,
}

impl SurfaceCase {
    /// Number of regions that are not the dent.
    pub fn num_false(&self) -> usize {
        self.regions.iter().filter(|region| !region.is_dent).count()
    }
}

/// The libraries: the same parts enrolled from their meshes, from averaged captures and from single ones.
pub fn libraries() -> Result<[BoundsLibrary; 3], EnrolError> {
    let mut averaged = BoundsLibrary::captured(0)?;
    averaged.title = format!("{NUM_ENROLLED_FRAMES} captures averaged");
    averaged.library.references.clear();
    for kind in PartKind::ALL {
        let mut average = DepthAverage::over(NUM_ENROLLED_FRAMES as usize);
        for seed in 0..NUM_ENROLLED_FRAMES {
            let mut setup = CellSetup::with_part(kind, Side::Left, 0, 1);
            setup.pose = PartPose::Fixed(enrolment_pose());
            setup.noise = SensorNoise::kinect(seed + 1);
            let scene = scene_from_frame(&frame(&setup).frame);
            average.add(&scene.into(), std::time::Duration::from_millis(33 * seed));
        }
        let scene = average.mean().expect("frames were added");
        let name = enrolled_name(kind, Side::Left);
        let about = PartDescription {
            name: PartName::new(&name).expect("our own names are valid"),
            title: kind.title().to_owned(),
            notes: String::new(),
            from: "simulated cell".to_owned(),
            at: jiff::Timestamp::UNIX_EPOCH,
            simulated: true,
        };
        let enrolled = enrol_captured(&scene, &about, &EnrolParams::default())?;
        averaged.library.references.push(enrolled.reference);
    }
    let mut single = BoundsLibrary::captured(0)?;
    "one capture".clone_into(&mut single.title);
    Ok([BoundsLibrary::simulated_meshes(0)?, averaged, single])
}

/// Inspects every part of a library in all poses, with and without a dent, and calls `after_each` after every case.
pub fn surface_cases(
    library: &BoundsLibrary,
    setup: &SurfaceSetup,
    after_each: impl Fn(),
) -> Vec<SurfaceCase> {
    let parts = library.subjects.iter();
    let pieces: Vec<(&BoundsPart, u64, bool)> = parts
        .enumerate()
        .flat_map(|(number, part)| {
            let first = setup.first_seed + number as u64 * setup.num_poses;
            let seeds = first..first + setup.num_poses;
            seeds.flat_map(move |seed| [true, false].map(|is_dented| (part, seed, is_dented)))
        })
        .collect();
    let mut cases = Vec::new();
    let num_workers = num_cores();
    for group in pieces.chunks(num_workers) {
        let found = map_each(group.len(), num_workers, |k| {
            let (part, seed, is_dented) = group[k];
            surface_case(library, part, setup, seed, is_dented)
        });
        cases.extend(found.into_iter().flatten());
        for _ in group {
            after_each();
        }
    }
    cases
}

/// `None` if no place was found for a dent.
fn surface_case(
    library: &BoundsLibrary,
    part: &BoundsPart,
    setup: &SurfaceSetup,
    seed: u64,
    is_dented: bool,
) -> Option<SurfaceCase> {
    let mut cell = CellSetup::new(SimulatedObject::Nothing, seed);
    cell.noise = SensorNoise::none();
    let bare = frame_of_mesh(&cell, &part.mesh);
    let camera_from_mesh = bare.truth.camera_from_part;
    // A dent must not move the part.
    cell.pose = PartPose::Fixed(camera_from_mesh);
    let dent = if is_dented {
        let scene = scene_from_frame(&bare.frame);
        let drawn = drawn_dent(&scene, &bare.truth.labels, seed)?;
        Some(carried(drawn, &camera_from_mesh.inverse()))
    } else {
        None
    };
    let dented: Option<TriangleMesh> = dent.map(|dent| dent.pressed_into(&part.mesh));
    let mesh = dented.as_ref().unwrap_or(&part.mesh);
    let scenes: Vec<SceneCloud> = (0..setup.num_frames)
        .map(|number| {
            cell.noise = SensorNoise {
                multiplier: setup.noise,
                seed: seed * 64 + number,
            };
            scene_from_frame(&frame_of_mesh(&cell, mesh).frame)
        })
        .collect();
    let frames: Vec<&SceneCloud> = scenes.iter().collect();
    let recipe = Recipe::default();
    let inspection = run(frames[0], &library.library, &recipe, &Unwatched).expect("not cancelled");
    let accepted = inspection.verdict.is_accepted() && is_of(&inspection, part);
    let mut case = SurfaceCase {
        part: part.name.clone(),
        enrolled: library.title.clone(),
        seed,
        dent: None,
        accepted,
        not_judged: None,
        noise_mm: None,
        noise_between_mm: None,
        limit_factor: None,
        smallest_mm: None,
        seen: None,
        regions: Vec::new(),
    };
    let params = DeviationParams::default();
    let measured = measure_surface(&inspection, &library.library, &frames, &params);
    match measured.filter(|_| accepted) {
        None => {}
        Some(Err(error)) => case.not_judged = Some(error.to_string()),
        Some(Ok(found)) => case.judge(&found, dent, &camera_from_mesh),
    }
    Some(case)
}

fn is_of(inspection: &Inspection, part: &BoundsPart) -> bool {
    let first = inspection.ranking.entries.first();
    first.is_some_and(|entry| entry.part == part.name)
}

impl SurfaceCase {
    /// Takes what was found of a part with this dent, in the coordinates of the mesh.
    fn judge(&mut self, found: &Deviation, dent: Option<Dent>, camera_from_mesh: &RigidTransform) {
        let centre = |dent: &Dent| found.part_from_camera * camera_from_mesh * dent.centre;
        let is_dent = |region: &DeviationRegion| {
            let of_kind = |dent: &Dent| match region.kind {
                RegionKind::Dent => dent.height.0 < 0.0,
                RegionKind::Bump => dent.height.0 > 0.0,
                RegionKind::Missing => false,
            };
            dent.as_ref().is_some_and(|dent| {
                let reach = 0.5 * dent.width.0 + NEAR_M;
                of_kind(dent) && (region.centre - centre(dent)).norm() <= reach
            })
        };
        self.noise_mm = Some(found.noise.mm());
        self.noise_between_mm = found.noise_between.map(Metres::mm);
        self.limit_factor = Some(found.limit_factor);
        self.smallest_mm = Some(found.smallest.map(|dent| dent.depth.mm()));
        self.seen = Some(found.seen);
        let case_of = |region: &DeviationRegion| RegionCase {
            kind: region.kind,
            area_mm2: 1e6 * region.area_m2,
            off_mm: region.off.map(Metres::mm),
            limit_mm: region.limit.mm(),
            centre: region.centre.coords.into(),
            is_dent: is_dent(region),
        };
        self.regions = found.regions.iter().map(case_of).collect();
        self.dent = dent.map(|dent| {
            let shown = dent.height.mm() * share_in_average(dent.width.0, PATCH_RADIUS_M);
            let noise = found.noise_at(&centre(&dent), PATCH_RADIUS_M);
            DentCase {
                width_mm: dent.width.mm(),
                height_mm: dent.height.mm(),
                shown_mm: shown,
                noise_mm: noise.map(Metres::mm),
                found: self.regions.iter().any(|region| region.is_dent),
            }
        });
    }
}

/// The same dent in other coordinates.
fn carried(dent: Dent, to: &RigidTransform) -> Dent {
    Dent {
        centre: to * dent.centre,
        outwards: Unit::new_normalize(to * *dent.outwards),
        ..dent
    }
}

/// Draws a dent in camera space, at a place of the part that shows a smooth surface all around; `None` if there is none.
fn drawn_dent(scene: &SceneCloud, labels: &[SurfaceLabel], seed: u64) -> Option<Dent> {
    let mut random = Pcg64::seed_from_u64(seed ^ STREAM);
    let width = random.random_range(WIDTHS_M);
    let depth = random.random_range(DEPTHS_M);
    let is_bump = random.random_range(0..4) == 0;
    for _ in 0..NUM_TRIES {
        let index = random.random_range(0..labels.len());
        if labels[index] != SurfaceLabel::Part {
            continue;
        }
        if let Some((centre, outwards)) = smooth_place(scene, labels, index, 0.5 * width + AROUND_M)
        {
            return Some(Dent {
                centre,
                outwards,
                width: Metres(width),
                height: Metres(if is_bump { depth } else { -depth }),
            });
        }
    }
    None
}

/// Separates the dent's random numbers from others with the same seed.
const STREAM: u64 = 0xde27_de27_de27_de27;

/// Point and normal of a pixel, camera space, if the part is smooth within `radius` metres of it.
fn smooth_place(
    scene: &SceneCloud,
    labels: &[SurfaceLabel],
    index: usize,
    radius: f64,
) -> Option<(Point3<f64>, Unit<Vector3<f64>>)> {
    /// Pixels over which the normal is taken.
    const STEP: f64 = 4.0;
    const NUM_DIRECTIONS: usize = 16;
    let camera = scene.intrinsics?;
    let (u, v) = ((index % camera.width) as f64, (index / camera.width) as f64);
    let point = |u: f64, v: f64| -> Option<Point3<f64>> {
        let (u, v) = ((u + 0.5).floor(), (v + 0.5).floor());
        let is_in_picture =
            u >= 0.0 && v >= 0.0 && u < camera.width as f64 && v < camera.height as f64;
        let pixel = is_in_picture.then(|| v as usize * camera.width + u as usize)?;
        let point = &scene.cloud.points[pixel];
        (labels[pixel] == SurfaceLabel::Part && is_finite(point)).then(|| point.cast())
    };
    let centre = point(u, v)?;
    let across = point(u + STEP, v)? - point(u - STEP, v)?;
    let down = point(u, v + STEP)? - point(u, v - STEP)?;
    // Right × down is away from the camera.
    let outwards = Unit::try_new(down.cross(&across), f64::MIN_POSITIVE)?;
    if -outwards.dot(&centre.coords.normalize()) < MIN_FACING_COSINE {
        return None;
    }
    let pixels = radius * camera.fx / centre.z;
    for ring in [0.25, 0.5, 0.75, 1.0] {
        for number in 0..NUM_DIRECTIONS {
            let turn = std::f64::consts::TAU * number as f64 / NUM_DIRECTIONS as f64;
            let (sine, cosine) = turn.sin_cos();
            let near = point(u + ring * pixels * cosine, v + ring * pixels * sine)?;
            let away = near - centre;
            if away.dot(&outwards).abs() > MAX_SLOPE * away.norm() {
                return None;
            }
        }
    }
    Some((centre, outwards))
}

#[cfg(test)]
mod tests {
    use super::*;
    use simulate::PartModel;

    #[test]
    fn a_dent_is_drawn_where_the_part_is_smooth_and_faces_the_camera() {
        let mesh = PartModel::new(PartKind::Fender, Side::Left, 0).into_mesh();
        let mut cell = CellSetup::new(SimulatedObject::Nothing, 5);
        cell.noise = SensorNoise::none();
        let bare = frame_of_mesh(&cell, &mesh);
        let scene = scene_from_frame(&bare.frame);
        let mut num_bumps = 0;
        for seed in 0..40 {
            let dent = drawn_dent(&scene, &bare.truth.labels, seed).expect("a place");
            let ray = dent.centre.coords.normalize();
            assert!(-dent.outwards.dot(&ray) >= MIN_FACING_COSINE, "{seed}");
            assert!(WIDTHS_M.contains(&dent.width.0) && DEPTHS_M.contains(&dent.height.0.abs()));
            num_bumps += usize::from(dent.height.0 > 0.0);
        }
        assert!((4..20).contains(&num_bumps), "{num_bumps} bumps");
    }
}
