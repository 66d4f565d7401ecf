//! The whole inspection: every stage in order, every intermediate result kept, each stage timed.
//!
//! The window, the command line and the tests are three callers of [`run`].
//!
//! If the first surface is not accepted, it tries, one after the other:
//!
//! 1. up to three more surfaces;
//! 2. the mirror image;
//! 3. the first surface as a piece of a larger part, even if its outline looks whole: a clamp changes an outline;
//! 4. the surface without bars that may belong to a stand;
//! 5. where several parts may hang, the surface's pieces, cut where its picture is narrow.
//!
//! It does so only with the default matcher and the pose method `global`; the paper's methods know one surface.

mod ahead;
mod expected;
mod hypothesis;
mod identification;
pub mod live;
mod mirror;
mod misplaced;
mod named_recipe;
pub mod parameters;
mod recipe_error;
mod recipe_folder;
mod refusal;
mod rejection;
pub mod scan;
mod surface;
mod surface_check;
mod unsound;
mod verdict;
mod watch;

use std::{slice, sync::Arc};

use nalgebra::Point3;

use crate::library::Library;
use files::crc32;
use geometry::{
    error::{Fault, guarded},
    units::Metres,
};
use stages::{
    confirm::{ConfirmParams, ConfirmedRanking},
    contour::{Contour, ContourParams},
    paper::{IcpGaParams, IcpParams},
    pose::{PoseError, PoseEstimate, PoseMethod},
    project::{PlaneImage, ProjectParams},
    rack::{Rack, Turn},
    rank::{Query, RankParams},
    reference::{Reference, ReferenceParams},
    scene::SceneCloud,
    segment::{MAX_PARTS, NoPart, PointLabel, SegmentParams, Segmentation, segment_in},
    signature::{FanSignature, SignatureParams},
    stand_off::StandOffParams,
};

use self::{
    ahead::SurfacesAhead, hypothesis::try_hypotheses, surface::InspectionInputs,
    unsound::refuse_unsound, watch::StageClock,
};
pub use self::{
    expected::{Expected, ExpectedError, ExpectedPart, places_of},
    identification::Identification,
    mirror::{MirrorTally, OnlyMirrored},
    named_recipe::{
        AS_IN_THE_PAPER, BUILT_IN, BUILT_IN_RECIPES, MAX_NOTES, NamedRecipe, RecipeBlock,
        RecipeFile, RecipeLabel, built_in_recipe,
    },
    recipe_error::RecipeError,
    recipe_folder::{RecipeFolder, RecipeList, Replace, open_recipe},
    refusal::{Refusal, RefusalKind},
    rejection::{Rejection, Unrecognisable},
    surface_check::{
        CheckedParts, JudgedRegion, NotJudged, SurfaceCheck, SurfaceVerdict, check_surfaces,
        measure_surface,
    },
    verdict::{AcceptParams, Verdict},
    watch::{Cancelled, ProgressObserver, Stage, Timings},
};
pub use stages::scan::Unwatched;

/// All parameters of an inspection.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct Recipe {
    /// Segmentation.
    pub segment: SegmentParams,
    /// Projection.
    pub project: ProjectParams,
    /// Contour.
    pub contour: ContourParams,
    /// Signature.
    pub signature: SignatureParams,
    /// Ranking.
    pub rank: RankParams,
    /// Confirmation of the best few.
    pub confirm: ConfirmParams,
    /// ICP.
    pub icp: IcpParams,
    /// ICP-GA.
    pub icp_ga: IcpGaParams,
    /// Acceptance.
    pub accept: AcceptParams,
    /// Stand-off of the nozzle, computed from the pose where it is shown.
    pub stand_off: StandOffParams,
    /// How the pose is estimated.
    pub pose: PoseChoice,
    /// Where parts may hang. It depends on where the camera is, and is not part of a recipe's file.
    #[serde(skip_serializing_if = "Rack::is_empty")]
    pub rack: Rack,
    /// What the recipe itself expects, as its file has it. An inspection takes it only through
    /// [`expected_or_own`](Self::expected_or_own), which checks it.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub expect: Vec<ExpectedPart>,
    /// What should hang there. It differs from frame to frame, and is neither part of the identity nor of a recipe's file.
    #[serde(skip)]
    pub expected: Expected,
}

impl Recipe {
    /// The parameters to prepare references with. A fair comparison needs scene and references prepared with the same
    /// ones.
    pub fn reference_params(&self) -> ReferenceParams {
        ReferenceParams {
            project: self.project.clone(),
            contour: self.contour.clone(),
            signature: self.signature.clone(),
        }
    }

    /// The maximum number of accepted parts: [`SegmentParams::max_parts`], or more if the rack has more places; as many as a
    /// frame can show if parts are expected, so that none is overlooked that is not.
    pub fn max_parts(&self) -> usize {
        if self.expected.is_empty() {
            self.segment.max_parts.max(self.rack.places.len())
        } else {
            MAX_PARTS
        }
    }

    /// True if what hangs there, by the inspections of a frame, is as expected; if nothing is expected, if each part is accepted.
    pub fn is_met(&self, found: &[Inspection]) -> bool {
        if self.expected.is_empty() {
            found.iter().all(|one| one.verdict.is_accepted())
        } else {
            self.expected.is_met(&found.iter().collect::<Vec<_>>())
        }
    }

    /// What should hang there: what the caller expects; if that is nothing, what the recipe does, of enrolled parts and in this
    /// rack; without one, as for a scan, wherever they hang.
    pub fn expected_or_own(
        &self,
        given: Expected,
        rack: Option<&Rack>,
        is_enrolled: impl Fn(&str) -> bool,
    ) -> Result<Expected, ExpectedError> {
        if given.is_empty() {
            Expected::new(self.expect.clone(), rack, is_enrolled)
        } else {
            Ok(given)
        }
    }

    /// Names of the rack's places at which nothing of a frame hangs.
    pub fn empty_places(&self, found: &[&Inspection]) -> Vec<&str> {
        let names = self.rack.places.iter().map(|place| &*place.name);
        let hangs_at = |name: &str| found.iter().any(|one| one.place.as_deref() == Some(name));
        names.filter(|name| !hangs_at(name)).collect()
    }

    /// Returns eight hexadecimal digits that depend on all parameters: the CRC-32 of the recipe as JSON, in the order
    /// of its fields. Collisions are unlikely, but nothing prevents forgery. A version of the program that adds a
    /// parameter gives another identity.
    pub fn identity(&self) -> String {
        let json = serde_json::to_vec(self).expect("numbers and names have a JSON form");
        format!("{:08x}", crc32(&json))
    }
}

/// Whether and how an inspection estimates the pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PoseChoice {
    /// Stop after the ranking: the verdict rests on the outline alone.
    Skip,
    /// Estimate it by this method.
    By(PoseMethod),
}

impl Default for PoseChoice {
    fn default() -> Self {
        Self::By(PoseMethod::Global)
    }
}

/// The results of an inspection, stage by stage. If a stage fails, its result and those of the later ones are empty.
#[derive(Clone, Debug)]
pub struct Inspection {
    /// Segmentation.
    pub segmentation: Segmentation,
    /// Binary image.
    pub plane: Option<PlaneImage>,
    /// Outline and openings.
    pub contour: Option<Contour>,
    /// Signature.
    pub signature: Option<FanSignature>,
    /// References, best first; in the order of the confirmed scores once poses were confirmed. For a
    /// mirror image, the part that it mirrors comes first.
    pub ranking: ConfirmedRanking,
    /// Pose of the reference ranked first; `None` if the recipe asks for none, or the reference ranked too low to be aligned.
    pub pose: Option<Result<PoseEstimate, PoseError>>,
    /// The verdict.
    pub verdict: Verdict,
    /// Name of the rack's place where the part, or what is unknown, hangs; `None` if that is none.
    pub place: Option<String>,
    /// How far the part is turned from an orientation that it may have there; `None` if it may have any.
    pub turn_at_place: Option<Turn>,
    /// True if the part continues outside the work volume.
    pub leaves_volume: bool,
    /// Of the first part of a frame in which parts are expected: those that nothing hangs in place of.
    pub missing: Option<Vec<ExpectedPart>>,
    /// The check of an accepted part's surface, if it was checked.
    pub surface: Option<Arc<SurfaceCheck>>,
    /// How long each stage took.
    pub timings: Timings,
}

/// Inspects a scene: which enrolled part hangs there, and where. Of several, it is the likeliest, as [`SegmentParams`]
/// defines it, or, if parts are expected, the first of those that is accepted; [`run_all`] finds the others too.
///
/// If nothing is enrolled or found, the inspection still holds the results of the earlier stages. A panic in a stage
/// becomes the verdict [`Unrecognisable::Fault`].
pub fn run(
    scene: &SceneCloud,
    library: &Library,
    recipe: &Recipe,
    watch: &dyn ProgressObserver,
) -> Result<Inspection, Cancelled> {
    let ahead = SurfacesAhead::new(1);
    let expected = &recipe.expected;
    let mut found = inspect_until(scene, library, recipe, watch, ahead, |found| {
        expected.is_empty() || expected.has_any(found)
    })?;
    let accepted = found.iter().position(|one| one.verdict.is_accepted());
    let mut inspection = found.swap_remove(accepted.unwrap_or(0));
    let checked = slice::from_mut(&mut inspection);
    check_surfaces(checked, &[scene], library, CheckedParts::OfZones);
    Ok(inspection)
}

/// Inspects a surface after the other of a scene, until nothing of a part's size is left that is neither background nor
/// explained. Returns an inspection for each, those of accepted parts first, in the order of the rack's places, and from left
/// to right in the picture. At most
/// [`Recipe::max_parts`] are accepted; of one, the inspection is that of [`run`].
///
/// What an accepted part explains are the readings at its reference in its pose, and no other part has them.
pub fn run_all(
    scene: &SceneCloud,
    library: &Library,
    recipe: &Recipe,
    watch: &dyn ProgressObserver,
) -> Result<Vec<Inspection>, Cancelled> {
    let max_parts = recipe.max_parts();
    let ahead = SurfacesAhead::new(max_parts);
    let mut found = inspect_until(scene, library, recipe, watch, ahead, |found| {
        let accepted = found.iter().filter(|one| one.verdict.is_accepted());
        accepted.count() >= max_parts
    })?;
    let place = |one: &Inspection| {
        let mut places = recipe.rack.places.iter();
        let index = places.position(|place| Some(&place.name) == one.place.as_ref());
        index.unwrap_or(recipe.rack.places.len())
    };
    found.sort_by(|a, b| {
        let rank = |one: &Inspection| (!one.verdict.is_accepted(), place(one));
        let from_left = a.direction().total_cmp(&b.direction());
        rank(a).cmp(&rank(b)).then(from_left)
    });
    let expected = &recipe.expected;
    if !expected.is_empty() {
        let missing = expected.missing(&found.iter().collect::<Vec<_>>());
        let missing = missing.into_iter().cloned().collect();
        found[0].missing = Some(missing);
    }
    check_surfaces(&mut found, &[scene], library, CheckedParts::OfZones);
    Ok(found)
}

/// Inspects the likeliest surface of a scene, and the next one until these are enough or none is left, and refuses the accepted
/// parts that are not expected. Returns at least one inspection, in the order in which they were made.
fn inspect_until(
    scene: &SceneCloud,
    library: &Library,
    recipe: &Recipe,
    watch: &dyn ProgressObserver,
    mut ahead: SurfacesAhead,
    is_enough: impl Fn(&[Inspection]) -> bool,
) -> Result<Vec<Inspection>, Cancelled> {
    let max_parts = recipe.max_parts();
    // One other thing may hang between two parts. Of one part, the surface that was inspected is the likeliest. Beside the
    // places of a rack may hang as much as a frame can show.
    let max_surfaces = if recipe.rack.places.is_empty() {
        2 * max_parts - 1
    } else {
        max_parts + MAX_PARTS
    };
    let first = inspect(scene, library, recipe, watch, &mut ahead, || {
        Some(segment_in(scene, &recipe.rack, &recipe.segment))
    })?;
    let mut found = vec![first.expect("a scene has a segmentation")];
    let mut known = Vec::new();
    while found.len() < max_surfaces && !is_enough(&found) {
        let last = &found[found.len() - 1];
        known.extend(explained(last, scene, library));
        let next = inspect(scene, library, recipe, watch, &mut ahead, || {
            let areas = found.iter().map(Inspection::area);
            let largest = areas.fold(0.0, f64::max);
            let first = &found[0].segmentation;
            first.without(scene, &known, largest, &recipe.segment)
        })?;
        let Some(next) = next else { break };
        found.push(next);
    }
    recipe.expected.refuse_others(&mut found);
    Ok(found)
}

/// Distance from a placed reference up to which a reading belongs to the part, metres, beyond the noise: rims that the
/// reference lacks, and the part's deviations from it.
const EXPLAINED_DISTANCE_M: f64 = 0.015;
/// Number of standard deviations of noise by which readings of a part lie off its reference.
const EXPLAINED_DEVIATIONS: f64 = 3.0;

/// Indices of the readings that an inspection explains: those at the placed reference of an accepted part, or of one that only
/// the rack refuses; otherwise the surface that was inspected. What was taken for the stand of an accepted part may be another part.
fn explained(inspection: &Inspection, scene: &SceneCloud, library: &Library) -> Vec<u32> {
    let Ok(part) = &inspection.segmentation.part else {
        return Vec::new();
    };
    let placed = inspection
        .found_pose()
        .zip(inspection.best_reference(library));
    let verdict = &inspection.verdict;
    let is_sure = verdict.is_accepted() || verdict.rejected().is_some_and(Rejection::is_by_rack);
    let Some((pose, reference)) = placed.filter(|_| is_sure) else {
        return part.indices.iter().chain(&part.stand).copied().collect();
    };
    let field = reference.field();
    let noise_at_1m = inspection.segmentation.noise_at_1m.0;
    let labels = &inspection.segmentation.labels;
    let is_explained = |(i, p): &(usize, &Point3<f32>)| {
        if !matches!(labels[*i], PointLabel::Rest | PointLabel::Part) {
            return false;
        }
        let p: Point3<f64> = p.cast();
        let noise = EXPLAINED_DEVIATIONS * noise_at_1m * p.z * p.z;
        let reach = (EXPLAINED_DISTANCE_M + noise) as f32;
        let nearest = field.nearest(&(pose.target_from_source * p).cast());
        nearest.is_some_and(|nearest| nearest.distance_sq < reach * reach)
    };
    let readings = scene.cloud.points.iter().enumerate();
    let explained = readings.filter(is_explained);
    explained.map(|(i, _)| i as u32).collect()
}

/// Inspects the part of a segmentation; `None` if there is no segmentation.
fn inspect(
    scene: &SceneCloud,
    library: &Library,
    recipe: &Recipe,
    watch: &dyn ProgressObserver,
    ahead: &mut SurfacesAhead,
    segment: impl FnOnce() -> Option<Segmentation>,
) -> Result<Option<Inspection>, Cancelled> {
    let ran = match &scene.fault {
        Some(fault) => Err(fault.clone()),
        None => guarded(|| {
            let mut inspection = inspect_part(scene, library, recipe, watch, ahead, segment)?;
            if let Some(inspection) = &mut inspection {
                refuse_unsound(inspection, scene);
                inspection.hang_in(&recipe.rack, scene, library);
            }
            Ok(inspection)
        }),
    };
    ran.unwrap_or_else(|fault| {
        let num_points = scene.cloud.points.len();
        Ok(Some(Inspection::broken_off(fault, num_points)))
    })
}

fn inspect_part(
    scene: &SceneCloud,
    library: &Library,
    recipe: &Recipe,
    watch: &dyn ProgressObserver,
    ahead: &mut SurfacesAhead,
    segment: impl FnOnce() -> Option<Segmentation>,
) -> Result<Option<Inspection>, Cancelled> {
    let clock = &StageClock::start(watch);
    let inputs = &InspectionInputs {
        scene,
        library,
        recipe,
        clock,
        rack: &recipe.rack,
    };
    let Some(segmentation) = clock.time(Stage::Segment, segment)? else {
        return Ok(None);
    };
    let mut inspection = Inspection::unrecognised(segmentation, Unrecognisable::EmptyLibrary);
    let segmentation = &inspection.segmentation;
    let part = segmentation.part.as_ref();
    let first = part.map(|part| ahead.inspect(segmentation, part, inputs));
    match first.map_err(|no_part| *no_part) {
        Ok(first) => {
            first?.keep(&mut inspection);
            try_hypotheses(&mut inspection, inputs)?;
        }
        Err(no_part) => inspection.verdict = Verdict::NoPart(no_part.into()),
    }
    inspection.timings = clock.finish();
    Ok(Some(inspection))
}

impl Inspection {
    /// An inspection without the results of the stages after the segmentation.
    fn unrecognised(segmentation: Segmentation, why: Unrecognisable) -> Self {
        Self {
            segmentation,
            plane: None,
            contour: None,
            signature: None,
            ranking: ConfirmedRanking::default(),
            pose: None,
            verdict: Verdict::NoPart(why),
            place: None,
            turn_at_place: None,
            leaves_volume: false,
            missing: None,
            surface: None,
            timings: Timings::default(),
        }
    }

    /// The empty inspection of a scene during which the program failed.
    fn broken_off(fault: Fault, num_points: usize) -> Self {
        let segmentation = Segmentation {
            labels: vec![PointLabel::NoReading; num_points],
            planes: Vec::new(),
            clusters: Vec::new(),
            surfaces: Vec::new(),
            noise_at_1m: Metres(0.0),
            part: Err(NoPart::TooFewPoints {
                found: 0,
                needed: 0,
            }),
        };
        Self::unrecognised(segmentation, Unrecognisable::Fault(fault))
    }

    /// True if some of the part is outside the picture: of an accepted part, if some of its reference lies beyond the field of
    /// view at the pose found; otherwise, if the segmented part reaches the end of the readings, which may also be its shadow.
    pub fn touches_edge(&self) -> bool {
        // Of 86 accepted simulated frames, all 39 of whole parts had 0, and 43 of the 47 others had 1 % or more.
        const EDGE_MIN_OUTSIDE: f64 = 0.005;
        let accepted = self.found_pose().filter(|_| self.verdict.is_accepted());
        if let Some(sight) = accepted.and_then(|pose| pose.fit.sight) {
            return sight.outside >= EDGE_MIN_OUTSIDE;
        }
        let part = self.segmentation.part.as_ref();
        part.is_ok_and(|part| part.touches_edge)
    }

    /// Area that the inspection explains, square metres: what of an accepted part is seen, or the surface.
    fn area(&self) -> f64 {
        let evidence = self.ranking.entries.first().and_then(|e| e.evidence);
        let accepted = evidence.filter(|_| self.verdict.is_accepted());
        let part = self.segmentation.part.as_ref().ok();
        let surface = || {
            part.and_then(|part| part.surface)
                .map(|surface| surface.area)
        };
        let area = accepted.map(|evidence| evidence.seen_m2).or_else(surface);
        area.unwrap_or(0.0)
    }

    /// The readings of the part, camera space, metres; `None` if there is no part.
    pub fn readings(&self) -> Option<&[Point3<f32>]> {
        let part = self.segmentation.part.as_ref().ok();
        part.map(|part| &*part.cloud.points)
    }

    /// Direction of the part in the picture: the mean of x/z of its readings, camera space, negative on the left.
    fn direction(&self) -> f64 {
        let points = self.readings().unwrap_or_default();
        let sum: f64 = points.iter().map(|p| f64::from(p.x / p.z)).sum();
        sum / points.len().max(1) as f64
    }

    /// The shape to rank by, of a scene whose outline was found.
    pub fn query(&self) -> Option<Query<'_>> {
        Some(Query {
            plane: self.plane.as_ref()?,
            contour: self.contour.as_ref()?,
            signature: self.signature.as_ref()?,
        })
    }

    /// Name of the reference ranked first; the pose is in its coordinates.
    pub fn reference(&self) -> Option<&str> {
        let best = self.ranking.entries.first()?;
        Some(&best.enrolled_as)
    }

    /// Name of the reference ranked first, if it is an additional reference of its part, which has its own
    /// coordinates and so its own standard position.
    pub fn other_reference(&self) -> Option<&str> {
        let best = self.ranking.entries.first()?;
        self.reference().filter(|name| *name != best.part)
    }

    /// The reference ranked first; `library` is the one that was used for the inspection.
    pub fn best_reference<'a>(&self, library: &'a Library) -> Option<&'a Reference> {
        let best = self.ranking.entries.first()?;
        library.references.get(best.reference)
    }

    /// The middle of the reference ranked first, part space, metres; `library` is the one that was used for the inspection.
    pub fn middle(&self, library: &Library) -> Option<Point3<f64>> {
        self.best_reference(library)?.middle()
    }

    fn best_score(&self) -> f64 {
        self.ranking.entries.first().map_or(0.0, |e| e.score)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_recipe_has_the_same_identity_and_another_another() {
        let recipe = Recipe::default();
        assert_eq!(recipe.identity(), Recipe::default().identity());
        assert!(
            recipe.identity().len() == 8
                && recipe.identity().bytes().all(|c| c.is_ascii_hexdigit())
        );
        let mut others: Vec<Recipe> = vec![Recipe::default(); 4];
        others[0].accept.min_score += 1e-15;
        others[1].stand_off.taught = Metres(0.151);
        others[2].pose = PoseChoice::Skip;
        others[3].icp_ga.seed += 1;
        let mut all: Vec<String> = others.iter().map(Recipe::identity).collect();
        all.push(recipe.identity());
        all.sort();
        all.dedup();
        assert_eq!(all.len(), 5);
    }

    #[test]
    fn what_is_expected_is_no_part_of_the_recipes_identity() {
        let expecting = Recipe {
            expected: serde_json::from_str("{\"expected\": [\"fender\"]}").expect("names"),
            ..Recipe::default()
        };
        assert_eq!(expecting.identity(), Recipe::default().identity());
        assert_eq!(expecting.max_parts(), MAX_PARTS);
    }

    #[test]
    fn a_recipe_that_was_saved_and_read_again_keeps_its_identity() {
        let recipe = Recipe::default();
        let json = serde_json::to_string(&recipe).expect("JSON");
        let read: Recipe = serde_json::from_str(&json).expect("a recipe");
        assert_eq!(read.identity(), recipe.identity());
    }
}
