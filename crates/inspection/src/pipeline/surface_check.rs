//! Judges the surface of an accepted part: the deviation from its reference against the tolerances of its zones.
//!
//! What a zone has no tolerance for is judged by the noise: whatever certainly deviates is to be reworked. A deviation within the
//! tolerance is no fault. The rule follows ISO 14253-1: a part is refused only for what the noise cannot explain, and where the
//! noise hides deviations that matter, the surface is not judged rather than called good.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::Inspection;
use crate::library::{Library, SurfaceZone, SurfaceZones};
use geometry::{statistics::median, units::Metres};
use stages::{
    deviation::{
        Deviation, DeviationError, DeviationParams, DeviationRegion, PatchDeviation, RegionKind,
        StandingPart, measure_deviation,
    },
    scene::SceneCloud,
};
use texts::{Described, Message};

/// Whether a part's surface is good.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SurfaceVerdict {
    /// Nothing exceeds its tolerance.
    Ok,
    /// Too little is known to say so.
    NotJudged,
    /// Something is to be repaired.
    Rework,
    /// Something cannot be repaired.
    Scrap,
}

impl SurfaceVerdict {
    /// True if something exceeds its tolerance.
    pub fn is_bad(self) -> bool {
        matches!(self, Self::Rework | Self::Scrap)
    }
}

impl Described for SurfaceVerdict {
    fn message(&self) -> Message {
        Message::new(match self {
            Self::Ok => "surface-ok",
            Self::NotJudged => "surface-not-judged",
            Self::Rework => "surface-rework",
            Self::Scrap => "surface-scrap",
        })
    }
}

texts::display!(SurfaceVerdict);

/// Why a surface is not judged.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "why", rename_all = "snake_case")]
pub enum NotJudged {
    /// Too much of the part's side is out of sight.
    LittleInSight {
        /// Share of it that is judged, 0..1.
        seen: f64,
        /// The share that is needed.
        needed: f64,
    },
    /// From here, only deviations larger than the tolerance are certain.
    TooFar {
        /// What a deviation must exceed to be certain.
        certain_m: f64,
        /// What is to be found.
        needed_m: f64,
        /// Distance of the camera.
        distance_m: f64,
        /// Distance from which it would do.
        nearer_m: f64,
    },
    /// The noise hides deviations that exceed the tolerance.
    TooNoisy {
        /// What a deviation must exceed to be certain.
        certain_m: f64,
        /// What is to be found.
        needed_m: f64,
        /// Number of frames averaged.
        num_frames: usize,
    },
    /// It could not be measured.
    #[serde(untagged)]
    NotMeasured(DeviationError),
}

impl NotJudged {
    /// Its kind in a form for programs.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::LittleInSight { .. } => "little_in_sight",
            Self::TooFar { .. } => "too_far",
            Self::TooNoisy { .. } => "too_noisy",
            Self::NotMeasured(error) => error.kind(),
        }
    }
}

impl Described for NotJudged {
    fn message(&self) -> Message {
        match self {
            Self::NotMeasured(error) => error.message(),
            Self::LittleInSight { .. } | Self::TooFar { .. } | Self::TooNoisy { .. } => {
                Message::tagged("surface", "why", self)
            }
        }
    }
}

texts::display!(NotJudged);

/// A region of the surface, with what its zone says of it.
#[derive(Clone, Debug, PartialEq)]
pub struct JudgedRegion {
    /// The region.
    pub region: DeviationRegion,
    /// Name of its zone; `None` if it is in none.
    pub zone: Option<String>,
    /// The deviation that its zone allows, or that is certain, whichever is more.
    pub limit: Metres,
    /// What follows from it: [`SurfaceVerdict::Ok`] within the tolerance.
    pub verdict: SurfaceVerdict,
}

/// The check of a part's surface.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceCheck {
    /// The verdict.
    pub verdict: SurfaceVerdict,
    /// Why it is not judged, if it is not.
    pub not_judged: Option<NotJudged>,
    /// What was measured; `None` if it could not be.
    pub deviation: Option<Deviation>,
    /// The regions that deviate, the clearest first; those of zones that are ignored are left out.
    pub regions: Vec<JudgedRegion>,
}

/// Share of the side of the part that must be judged to call it good.
const MIN_SEEN: f64 = 0.5;
/// Deviation that must be certain where a zone has no tolerance, metres: a part with larger dents would not be called good.
const DEFAULT_NEEDED_M: f64 = 0.005;
/// Number of the width in [`Deviation::smallest`], 40 mm, whose smallest dent must be within the tolerance.
const JUDGED_WIDTH: usize = 1;
/// Distance up to which moving nearer helps, metres: nearer, a Kinect sees nothing.
const NEAREST_M: f64 = 0.7;

/// Measures the deviation of an accepted part from its reference, in one or several frames of one camera in which it stands still;
/// the first is the one that was inspected. `None` if the part is not accepted.
pub fn measure_surface(
    inspection: &Inspection,
    library: &Library,
    frames: &[&SceneCloud],
    params: &DeviationParams,
) -> Option<Result<Deviation, DeviationError>> {
    let part = inspection.segmentation.part.as_ref().ok()?;
    let pose = inspection
        .found_pose()
        .filter(|_| inspection.verdict.is_accepted())?;
    let standing = StandingPart {
        frames,
        indices: &part.indices,
        part_from_camera: pose.target_from_source,
        noise_at_1m: part.noise_at_1m,
    };
    let reference = inspection.best_reference(library)?;
    Some(measure_deviation(&standing, reference, params))
}

/// The parts whose surfaces are checked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CheckedParts {
    /// Those that are to be checked in every inspection, by [`SurfaceZones::check`].
    #[default]
    OfZones,
    /// Every accepted part.
    All,
}

/// Checks the surfaces of accepted parts, in one or several frames of one camera in which they stand still; the first is the one
/// that was inspected.
pub fn check_surfaces(
    found: &mut [Inspection],
    frames: &[&SceneCloud],
    library: &Library,
    which: CheckedParts,
) {
    for inspection in found {
        let is_checked = which == CheckedParts::All
            || zones_of(inspection, library).is_some_and(|zones| zones.check);
        if is_checked {
            inspection.surface = check_surface(inspection, library, frames).map(Arc::new);
        }
    }
}

/// The zones of the reference that was found.
fn zones_of<'a>(inspection: &Inspection, library: &'a Library) -> Option<&'a SurfaceZones> {
    library.surface_zones.get(inspection.reference()?)
}

/// Checks the surface of an accepted part, as [`measure_surface`] measures it; `None` if the part is not accepted.
fn check_surface(
    inspection: &Inspection,
    library: &Library,
    frames: &[&SceneCloud],
) -> Option<SurfaceCheck> {
    let params = DeviationParams::default();
    let measured = measure_surface(inspection, library, frames, &params)?;
    let zones = zones_of(inspection, library).cloned().unwrap_or_default();
    Some(match measured {
        Ok(deviation) => SurfaceCheck::of(deviation, &zones),
        Err(error) => SurfaceCheck {
            verdict: SurfaceVerdict::NotJudged,
            not_judged: Some(NotJudged::NotMeasured(error)),
            deviation: None,
            regions: Vec::new(),
        },
    })
}

impl SurfaceCheck {
    /// Judges a measured deviation by the zones of the part.
    pub fn of(deviation: Deviation, zones: &SurfaceZones) -> Self {
        let regions = deviation.regions.iter();
        let regions: Vec<JudgedRegion> = regions
            .filter_map(|region| JudgedRegion::new(region, zones.zone_at(&region.centre)))
            .collect();
        let worst = regions.iter().map(|region| region.verdict).max();
        let worst = worst.unwrap_or(SurfaceVerdict::Ok);
        let not_judged = not_judged(&deviation, zones).filter(|_| worst == SurfaceVerdict::Ok);
        Self {
            verdict: worst.max(match not_judged {
                Some(_) => SurfaceVerdict::NotJudged,
                None => SurfaceVerdict::Ok,
            }),
            not_judged,
            deviation: Some(deviation),
            regions,
        }
    }
}

impl JudgedRegion {
    /// `None` where nothing is judged.
    fn new(region: &DeviationRegion, zone: Option<&SurfaceZone>) -> Option<Self> {
        if zone.is_some_and(|zone| zone.is_ignored) {
            return None;
        }
        let exceeds = |limit: Option<Metres>| {
            let off = region.off.map(|off| off.0.abs());
            limit.is_some_and(|limit| off.is_some_and(|off| off > limit.0))
        };
        let tolerance = zone.and_then(SurfaceZone::tolerance);
        let is_tolerated =
            region.kind != RegionKind::Missing && tolerance.is_some() && !exceeds(tolerance);
        let verdict = if is_tolerated {
            SurfaceVerdict::Ok
        } else if exceeds(zone.and_then(SurfaceZone::scrap)) {
            SurfaceVerdict::Scrap
        } else {
            SurfaceVerdict::Rework
        };
        let tolerance = tolerance.map_or(0.0, |tolerance| tolerance.0);
        Some(Self {
            zone: zone.map(|zone| zone.name.clone()),
            limit: Metres(region.limit.0.max(tolerance)),
            region: region.clone(),
            verdict,
        })
    }
}

/// Why a surface without a fault cannot be called good; `None` if it can.
fn not_judged(deviation: &Deviation, zones: &SurfaceZones) -> Option<NotJudged> {
    if deviation.seen < MIN_SEEN {
        return Some(NotJudged::LittleInSight {
            seen: deviation.seen,
            needed: MIN_SEEN,
        });
    }
    let camera_from_part = deviation.part_from_camera.inverse();
    let of_zone = |zone: Option<&SurfaceZone>| {
        if zone.is_some_and(|zone| zone.is_ignored) {
            return None;
        }
        let is_in = |patch: &&PatchDeviation| {
            zones.zone_at(&patch.at.cast()).map(std::ptr::from_ref) == zone.map(std::ptr::from_ref)
        };
        let patches: Vec<&PatchDeviation> = deviation.patches.iter().filter(is_in).collect();
        let noise = median(patches.iter().map(|patch| f64::from(patch.noise)))?;
        let tolerance = zone.and_then(SurfaceZone::tolerance);
        let needed_m = tolerance.map_or(DEFAULT_NEEDED_M, |tolerance| tolerance.0);
        let certain_m = deviation.smallest[JUDGED_WIDTH].depth.0 * noise / deviation.noise.0;
        if certain_m <= needed_m {
            return None;
        }
        let depth = |patch: &&PatchDeviation| (camera_from_part * patch.at.cast::<f64>()).z;
        let distance_m = median(patches.iter().map(depth))?;
        // The noise grows with the square of the distance.
        let nearer_m = distance_m * (needed_m / certain_m).sqrt();
        Some(if nearer_m >= NEAREST_M {
            NotJudged::TooFar {
                certain_m,
                needed_m,
                distance_m,
                nearer_m,
            }
        } else {
            NotJudged::TooNoisy {
                certain_m,
                needed_m,
                num_frames: deviation.num_frames,
            }
        })
    };
    let named = zones.zones.iter().map(Some);
    named.chain([None]).find_map(of_zone)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point3, Vector3};

    use super::*;
    use geometry::rigid::RigidTransform;
    use stages::deviation::SmallestDent;

    /// A surface of 1 m² at 1 m from the camera with one dent.
    fn measured(dent_mm: f64, noise_mm: f64) -> Deviation {
        let noise = Metres::from_mm(noise_mm);
        let patches = (0..400).map(|i| PatchDeviation {
            at: Point3::new((i % 20) as f32 * 0.05, (i / 20) as f32 * 0.05, 1.0),
            normal: -Vector3::z(),
            off: 0.0,
            noise: noise.0 as f32,
        });
        Deviation {
            part_from_camera: RigidTransform::identity(),
            num_frames: 8,
            seen: 0.9,
            patches: patches.collect(),
            noise,
            noise_between: None,
            limit_factor: 4.5,
            smallest: [SmallestDent {
                width: Metres(0.04),
                depth: Metres(6.0 * noise.0),
            }; 3],
            regions: vec![DeviationRegion {
                kind: RegionKind::Dent,
                area_m2: 1e-3,
                off: Some(Metres::from_mm(-dent_mm)),
                centre: Point3::new(0.5, 0.5, 1.0),
                limit: Metres(4.5 * noise.0),
                noise,
                points: Vec::new(),
            }],
        }
    }

    fn zone(tolerance_mm: f64, scrap_mm: f64) -> SurfaceZones {
        SurfaceZones {
            check: true,
            zones: vec![SurfaceZone {
                name: "skin".to_owned(),
                tolerance_mm: Some(tolerance_mm),
                scrap_mm: Some(scrap_mm),
                ..SurfaceZone::default()
            }],
        }
    }

    #[test]
    fn a_deviation_is_judged_by_the_tolerances_of_its_zone() {
        let verdict =
            |dent_mm, zones: &SurfaceZones| SurfaceCheck::of(measured(dent_mm, 0.2), zones).verdict;
        assert_eq!(
            verdict(3.0, &SurfaceZones::default()),
            SurfaceVerdict::Rework
        );
        assert_eq!(verdict(3.0, &zone(4.0, 6.0)), SurfaceVerdict::Ok);
        assert_eq!(verdict(5.0, &zone(4.0, 6.0)), SurfaceVerdict::Rework);
        assert_eq!(verdict(7.0, &zone(4.0, 6.0)), SurfaceVerdict::Scrap);
        let mut ignored = zone(1.0, 2.0);
        ignored.zones[0].is_ignored = true;
        assert_eq!(verdict(7.0, &ignored), SurfaceVerdict::Ok);
    }

    #[test]
    fn a_surface_whose_noise_hides_what_matters_is_not_called_good() {
        let mut noisy = measured(3.0, 1.5);
        noisy.regions.clear();
        let check = SurfaceCheck::of(noisy.clone(), &zone(6.0, 9.0));
        assert!(
            matches!(check.not_judged, Some(NotJudged::TooFar { nearer_m, .. }) if nearer_m < 1.0),
            "{check:?}"
        );
        let check = SurfaceCheck::of(noisy.clone(), &zone(1.0, 9.0));
        assert_eq!(check.verdict, SurfaceVerdict::NotJudged);
        assert!(matches!(check.not_judged, Some(NotJudged::TooNoisy { .. })));
        let check = SurfaceCheck::of(noisy.clone(), &zone(10.0, 12.0));
        assert_eq!(
            (check.verdict, check.not_judged),
            (SurfaceVerdict::Ok, None)
        );
        noisy.seen = 0.4;
        let check = SurfaceCheck::of(noisy, &zone(10.0, 12.0));
        assert!(matches!(
            check.not_judged,
            Some(NotJudged::LittleInSight { .. })
        ));
        // A fault that is certain stays one.
        let faulty = SurfaceCheck::of(measured(8.0, 1.5), &zone(1.0, 9.0));
        assert_eq!(
            (faulty.verdict, faulty.not_judged),
            (SurfaceVerdict::Rework, None)
        );
    }
}
