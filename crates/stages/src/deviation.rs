//! Deviation of a part's surface from its reference: dents, bumps, and surface that is missing.
//!
//! This is the profile of a surface (ISO 1101), judged where a pose was accepted:
//!
//! 1. Every reading of every frame is held against the surface of the reference, along its normal (`surface`, `readings`).
//! 2. The part is aligned by what most of its surface says, so that a dent stays a dent (`alignment`).
//! 3. The deviations are averaged over the frames and over patches of five sizes: a camera's noise falls with the number of
//!    readings, its rounding and other errors that all frames share do not.
//! 4. The form, all that is larger than a dent, is taken away by a robust local plane, as a robust Gaussian regression filter
//!    does (ISO 16610-31): what a camera bends, and what part and reference differ by as a whole, is no dent. The nesting index is
//!    `DeviationParams::form_radius`: a dent wider than that radius is found less deep than it is, or not at all.
//! 5. The noise of each average is measured on the part itself (`patches`), and with it the limit that hardly ever a part without
//!    a deviation exceeds (`regions`).
//!
//! Surface that the camera looks through is found apart (`missing`).
//!
//! Known limits: within 12 mm of where the reference ends, beyond 60° to the camera, and where a patch is not mostly seen, nothing
//! is judged. An error of the camera or of the reference that is as small and as sharp as a dent is taken for one, unless there
//! are many of them: then the noise is large, and what is found is less.

mod alignment;
mod missing;
mod patches;
mod readings;
mod regions;
mod surface;

use nalgebra::{Point3, Vector3};

pub use self::patches::share_in_average;
use self::{
    alignment::SmallMotion,
    missing::missing,
    patches::{Patches, noise_between},
    readings::{MIN_FACING_COSINE, NodeReadings},
    regions::{limit_factor, regions},
    surface::Surface,
};
use crate::{confirm::facing_view, reference::Reference, scene::SceneCloud};
use geometry::{
    parallel::{map_each, num_cores},
    rigid::RigidTransform,
    statistics::median,
    units::Metres,
};
use texts::{Described, Message};

/// Parameters of [`measure_deviation`].
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct DeviationParams {
    /// Regions that are found on a part without a deviation, in the mean, 0.001..0.2. Raising it finds smaller dents, and more that
    /// are none.
    pub false_alarms: f64,
    /// Least area of a region, square metres, 0..0.01. Raising it overlooks scratches.
    pub min_area_m2: f64,
    /// Radius within which the form is fitted, 60..300 mm. Raising it finds wider dents, and more of the reference's errors.
    pub form_radius: Metres,
}

impl Default for DeviationParams {
    fn default() -> Self {
        Self {
            false_alarms: 0.03,
            min_area_m2: 1e-4,
            form_radius: Metres::from_mm(120.0),
        }
    }
}

/// A part that stood still while one or several frames were taken.
#[derive(Clone, Copy, Debug)]
pub struct StandingPart<'a> {
    /// The frames, of one camera and all of one size; the first is the one that was inspected.
    pub frames: &'a [&'a SceneCloud],
    /// Indices of the part's readings.
    pub indices: &'a [u32],
    /// Its pose.
    pub part_from_camera: RigidTransform,
    /// Standard deviation of a reading's depth at 1 m; it grows with depth².
    pub noise_at_1m: Metres,
}

impl StandingPart<'_> {
    /// Standard deviation of the depth of a reading there, metres.
    fn noise_at(&self, at: &Point3<f64>) -> f64 {
        self.noise_at_1m.0 * at.z * at.z
    }
}

/// Why nothing can be said of a part's surface.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error, serde::Serialize)]
#[serde(tag = "why", rename_all = "snake_case")]
pub enum DeviationError {
    /// The readings are no picture of a camera that is known.
    NoPicture,
    /// The frames are of different sizes or cameras.
    FramesDiffer,
    /// The part stood elsewhere in one of the frames.
    Moved {
        /// By how much its surface lay elsewhere: root mean square, metres.
        by_m: f64,
        /// Up to which it counts as standing still.
        limit_m: f64,
    },
    /// The reference has no surface with normals.
    NoSurface,
    /// Too little of the reference is seen well.
    LittleSeen {
        /// Share of the reference's surface that is judged, 0..1, of what faces the camera.
        seen: f64,
        /// The share that is needed.
        needed: f64,
    },
}

texts::described!(DeviationError: "deviation" by "why");

impl DeviationError {
    /// Its kind in a form for programs.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::NoPicture => "no_picture",
            Self::FramesDiffer => "frames_differ",
            Self::Moved { .. } => "moved",
            Self::NoSurface => "no_surface",
            Self::LittleSeen { .. } => "little_seen",
        }
    }
}

/// What a region of the surface is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RegionKind {
    /// The surface lies further in than the reference.
    Dent,
    /// It lies further out.
    Bump,
    /// It is not there: the camera looks through.
    Missing,
}

impl Described for RegionKind {
    fn message(&self) -> Message {
        Message::new(match self {
            Self::Dent => "region-dent",
            Self::Bump => "region-bump",
            Self::Missing => "region-missing",
        })
    }
}

texts::display!(RegionKind);

/// A region of the surface that deviates from the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviationRegion {
    /// What it is.
    pub kind: RegionKind,
    /// Its area on the reference, square metres.
    pub area_m2: f64,
    /// How far the surface lies outside of the reference where that is most: the mean over a patch, below 0 for a dent. `None` of
    /// missing surface.
    pub off: Option<Metres>,
    /// Its middle, part space, metres.
    pub centre: Point3<f64>,
    /// The magnitude that such a mean must exceed there.
    pub limit: Metres,
    /// Standard deviation of such a mean there.
    pub noise: Metres,
    /// Points of the reference in it, part space, metres.
    pub points: Vec<Point3<f32>>,
}

/// The mean over a patch of [`PATCH_RADIUS_M`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchDeviation {
    /// Point of the reference in its middle, part space, metres.
    pub at: Point3<f32>,
    /// Unit normal of the reference there, towards the camera.
    pub normal: Vector3<f32>,
    /// How far the surface lies outside of the reference, metres, without the form.
    pub off: f32,
    /// Standard deviation of it, metres.
    pub noise: f32,
}

/// The depth of a dent of a width that is found in 95 of 100 cases.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct SmallestDent {
    /// Its diameter.
    pub width: Metres,
    /// Its depth in the middle.
    pub depth: Metres,
}

/// What is known of a part's surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation {
    /// The pose, aligned by the surface.
    pub part_from_camera: RigidTransform,
    /// Number of frames averaged.
    pub num_frames: usize,
    /// Share of the reference's surface that is judged, 0..1, of what faces the camera and is no margin.
    pub seen: f64,
    /// The means over patches, for pictures.
    pub patches: Vec<PatchDeviation>,
    /// Noise of such a mean: the median over the part.
    pub noise: Metres,
    /// What of it differs from frame to frame, so that more frames would reduce it; `None` of fewer than three frames.
    pub noise_between: Option<Metres>,
    /// How many times its noise a mean must exceed.
    pub limit_factor: f64,
    /// What is certainly found.
    pub smallest: [SmallestDent; 3],
    /// The regions, the clearest first, missing surface last.
    pub regions: Vec<DeviationRegion>,
}

/// Radii of the patches, metres: those of dents of 20 to 84 mm.
const RADII_M: [f64; 5] = [PATCH_RADIUS_M, 0.015, 0.022, 0.031, 0.042];
/// Radius of the patch whose noise is reported, metres: of the smallest dents that are looked for.
pub const PATCH_RADIUS_M: f64 = 0.010;
/// Number of the patches that the form is fitted to: the noise of the smallest ones would hide a dent from a robust fit.
const FORM_SCALE: usize = 2;
/// Widths of dents for which the smallest depth is reported, metres.
const WIDTHS_M: [f64; 3] = [0.02, 0.04, 0.08];
/// Share of the reference's surface that must be judged.
const MIN_SEEN: f64 = 0.15;
/// How far the part's surface may lie elsewhere in a frame than in all, metres: more than the noise of a whole part, less than a
/// dent.
const MAX_MOTION_M: f64 = 0.001;
/// Number of alignments by the first frame: readings come nearer to their places on the surface.
const NUM_ALIGNMENTS: usize = 2;
/// Standard deviations by which a value lies above its limit in 95 of 100 cases.
const FOUND_IN_95: f64 = 1.645;

impl Deviation {
    /// Returns the noise of the mean over the patch whose middle is nearest to a point, part space; `None` if none is within
    /// `reach` metres.
    pub fn noise_at(&self, at: &Point3<f64>, reach: f64) -> Option<Metres> {
        let distance = |patch: &PatchDeviation| (patch.at.cast::<f64>() - at).norm();
        let nearest = (self.patches.iter())
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .filter(|patch| distance(patch) <= reach)?;
        Some(Metres(nearest.noise.into()))
    }
}

/// Measures the deviation of a part, at its pose, from its reference.
pub fn measure_deviation(
    part: &StandingPart<'_>,
    reference: &Reference,
    params: &DeviationParams,
) -> Result<Deviation, DeviationError> {
    let first = part.frames.first().ok_or(DeviationError::NoPicture)?;
    let (Some(grid), Some(camera)) = (first.cloud.grid, first.intrinsics) else {
        return Err(DeviationError::NoPicture);
    };
    let is_alike = |frame: &&&SceneCloud| {
        frame.cloud.grid == Some(grid) && frame.intrinsics == first.intrinsics
    };
    if part.frames.iter().filter(is_alike).count() < part.frames.len() {
        return Err(DeviationError::FramesDiffer);
    }
    let view = facing_view(reference, &part.part_from_camera);
    let target = reference.target(view).ok_or(DeviationError::NoSurface)?;
    let surface = Surface::new(&target).ok_or(DeviationError::NoSurface)?;
    let mut part_from_camera = part.part_from_camera;
    for _ in 0..NUM_ALIGNMENTS {
        let readings = NodeReadings::of(&surface, first, part, &part_from_camera, camera.fx);
        part_from_camera = SmallMotion::onto(&surface, &readings).applied(&part_from_camera);
    }
    let frames = map_each(part.frames.len(), num_cores(), |number| {
        let frame = part.frames[number];
        NodeReadings::of(&surface, frame, part, &part_from_camera, camera.fx)
    });
    let mut readings = NodeReadings::joined(&frames);
    let motion = SmallMotion::onto(&surface, &readings);
    stands_still(&surface, &frames, &motion)?;
    for node in 0..surface.points.len() {
        readings.shift(node, motion.off_by(&surface, node));
    }
    let scales = RADII_M.map(|radius| Patches::of(&surface, &readings, radius));
    let form = scales[FORM_SCALE].form(&surface, params.form_radius.0);
    let num_facing = num_facing(&surface, &part_from_camera);
    let num_seen = form.iter().filter(|form| form.is_finite()).count();
    let seen = num_seen as f64 / num_facing.max(1) as f64;
    if seen < MIN_SEEN {
        return Err(DeviationError::LittleSeen {
            seen,
            needed: MIN_SEEN,
        });
    }
    let mut scales = scales.map(|patches| patches.without(&form));
    for patches in &mut scales {
        patches.scale_noises(&surface);
    }
    let limit_factor = limit_factor(&surface, &scales, params.false_alarms);
    let mut found = regions(&surface, &scales, limit_factor, params.min_area_m2);
    let part_from_camera = motion.applied(&part_from_camera);
    found.extend(missing(&surface, part, &camera, &part_from_camera));
    Ok(Deviation {
        part_from_camera,
        num_frames: part.frames.len(),
        seen,
        patches: for_pictures(&surface, &scales[0]),
        noise: Metres(typical_noise(&scales[0])),
        noise_between: noise_between(&surface, &frames, PATCH_RADIUS_M).map(Metres),
        limit_factor,
        smallest: WIDTHS_M.map(|width| smallest_dent(width, &scales, limit_factor)),
        regions: found,
    })
}

/// Refuses frames between which the part has moved.
fn stands_still(
    surface: &Surface<'_>,
    frames: &[NodeReadings],
    all: &SmallMotion,
) -> Result<(), DeviationError> {
    for frame in frames {
        let own = SmallMotion::onto(surface, frame);
        let apart = |node: &usize| own.off_by(surface, *node) - all.off_by(surface, *node);
        let nodes = (0..surface.points.len()).filter(|node| frame.num(*node) > 0.0);
        let (num, sum) = nodes.fold((0.0_f64, 0.0), |(num, sum), node| {
            (num + 1.0, sum + apart(&node).powi(2))
        });
        let by_m = (sum / num.max(1.0)).sqrt();
        if by_m > MAX_MOTION_M {
            return Err(DeviationError::Moved {
                by_m,
                limit_m: MAX_MOTION_M,
            });
        }
    }
    Ok(())
}

/// Number of nodes, without the margins, that face the camera.
fn num_facing(surface: &Surface<'_>, part_from_camera: &RigidTransform) -> usize {
    let camera = part_from_camera * Point3::origin();
    let is_facing = |node: &usize| {
        let towards = camera - surface.points[*node].cast::<f64>();
        let cosine = surface.normals[*node]
            .cast::<f64>()
            .dot(&towards.normalize());
        !surface.is_margin[*node] && cosine >= MIN_FACING_COSINE
    };
    (0..surface.points.len()).filter(is_facing).count()
}

fn for_pictures(surface: &Surface<'_>, patches: &Patches) -> Vec<PatchDeviation> {
    let seen = (0..surface.points.len()).filter(|node| patches.is_seen(*node));
    seen.map(|node| PatchDeviation {
        at: surface.points[node],
        normal: surface.normals[node],
        off: patches.offs[node] as f32,
        noise: patches.noises[node] as f32,
    })
    .collect()
}

/// Median of the noises of the averages, metres; infinite if there are none.
fn typical_noise(patches: &Patches) -> f64 {
    let noises = patches.noises.iter().copied();
    median(noises.filter(|noise| noise.is_finite())).unwrap_or(f64::INFINITY)
}

/// The smallest dent of a width that is found in 95 of 100 cases where the noise is as in most places.
fn smallest_dent(width: f64, scales: &[Patches], limit_factor: f64) -> SmallestDent {
    let depths = scales.iter().map(|patches| {
        (limit_factor + FOUND_IN_95) * typical_noise(patches)
            / share_in_average(width, patches.radius)
    });
    SmallestDent {
        width: Metres(width),
        depth: Metres(depths.fold(f64::INFINITY, f64::min)),
    }
}

#[cfg(test)]
mod tests;
