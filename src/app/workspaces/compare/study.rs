//! One case under the glass: inspected with the recipe on trial, and compared with one enrolled part.

use std::sync::Arc;

use super::comparison::OutlineComparison;
use crate::{
    app::{
        inspection::{library_cache::LibraryCache, unit_system::UnitSystem},
        language::{results, text},
        task::TaskError,
        user_error::UserError,
    },
    cases::{CaseFolder, FoundVerdict, KeptCase, Truth},
    library::Library,
    pipeline::{self, Inspection, NamedRecipe, ProgressObserver, Rejection, Verdict},
    stages::{
        rank::{MatchRanking, Matcher, Query, RankParams, rank},
        scene::SceneCloud,
        signature::LiteralSignature,
    },
};

/// The scene of a case.
#[derive(Clone, Debug)]
pub enum CaseScene {
    /// At hand.
    AtHand {
        /// The scene.
        scene: Arc<SceneCloud>,
        /// Where it came from, for people.
        title: String,
        /// Whether a camera was read.
        camera: CameraKind,
    },
    /// To be read.
    Kept {
        /// From here.
        folder: CaseFolder,
        /// The case.
        case: Box<KeptCase>,
    },
}

/// Whether a camera was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraKind {
    /// It was.
    Real,
    /// It was simulated.
    Simulated,
}

/// Inspect a case and compare it.
#[derive(Clone, Debug)]
pub struct StudyRequest {
    /// The case.
    pub case: CaseScene,
    /// The recipe on trial.
    pub recipe: Arc<NamedRecipe>,
    /// What it truly is, if somebody said so.
    pub truth: Option<Truth>,
    /// The part to compare with, if somebody chose one.
    pub against: Option<String>,
}

/// What came out.
#[derive(Debug)]
pub struct CaseStudy {
    /// The scene.
    pub scene: Arc<SceneCloud>,
    /// Where it came from, for people.
    pub title: String,
    /// Whether a camera was read.
    pub camera: CameraKind,
    /// The recipe on trial.
    pub recipe: Arc<NamedRecipe>,
    /// What was found with it.
    pub found: FoundVerdict,
    /// The found part's name for people.
    pub found_title: String,
    /// Why it was refused, in figures.
    pub refused: Option<String>,
    /// What to do if it was not accepted.
    pub advice: String,
    /// Time of the inspection, milliseconds.
    pub time_ms: f64,
    /// Every part, the nearest of the matcher in use first.
    pub distances: Vec<PartDistance>,
    /// The part compared with.
    pub against: Option<String>,
    /// The figures; without an outline there are none.
    pub comparison: Option<OutlineComparison>,
}

/// How far a part is off, for both matchers.
#[derive(Clone, Debug, PartialEq)]
pub struct PartDistance {
    /// Its name.
    pub part: String,
    /// Its name for people.
    pub title: String,
    /// Root mean square distance of the outlines, metres: the default matcher's.
    pub outline: Option<f64>,
    /// ‖A − C‖₁: the paper's.
    pub paper: f64,
    /// Both as a share of the furthest part's.
    pub shares: [f32; 2],
    /// Its score in the end, 0..1.
    pub score: f64,
}

impl CaseStudy {
    /// Why it was refused, in one sentence.
    pub fn refusal(&self, units: UnitSystem) -> Option<String> {
        let refused = self.refused.as_ref()?;
        let nearest = self.distances.iter();
        let mut nearest = nearest.filter(|d| self.found.part.as_ref() == Some(&d.part));
        let apart = nearest.find_map(|d| d.outline);
        Some(match apart {
            Some(metres) => text!(
                "compare-refused-apart",
                reason = refused,
                distance = units.length(metres),
            ),
            None => text!("compare-refused", reason = refused),
        })
    }
}

/// Inspects and compares.
pub fn study(
    request: &StudyRequest,
    library_cache: &LibraryCache,
    watch: &dyn ProgressObserver,
) -> Result<CaseStudy, TaskError> {
    let shelved = library_cache.get();
    let (scene, title, camera) = opened(&request.case)?;
    if watch.is_cancelled() {
        return Err(TaskError::Cancelled);
    }
    let fitted = shelved.fitting(&request.recipe, watch);
    let fitted = fitted.ok_or(TaskError::Cancelled)?;
    let library: &Library = &fitted;
    let inspection = pipeline::run(&scene, library, &request.recipe, watch)?;
    let found = FoundVerdict::from(&inspection.verdict);
    let shown = &shelved.shown;
    let title_of = |name: &str| {
        let place = shown.place_of(name);
        place.map_or_else(|| name.to_owned(), |place| shown.title(place).to_owned())
    };
    let against = against(request, &found, library);
    let mut study = CaseStudy {
        scene: Arc::clone(&scene),
        title,
        camera,
        recipe: Arc::clone(&request.recipe),
        found_title: found.part.as_deref().map(title_of).unwrap_or_default(),
        refused: refused(&inspection.verdict, &title_of),
        advice: advice(&inspection.verdict),
        time_ms: inspection.timings.total.as_secs_f64() * 1000.0,
        distances: Vec::new(),
        comparison: None,
        found,
        against,
    };
    let Some(query) = query_of(&inspection) else {
        return Ok(study);
    };
    let by_outline = RankParams {
        matcher: Matcher::Default,
        ..request.recipe.rank.clone()
    };
    let placed = rank(&query, &library.references, &by_outline);
    let chosen = request.recipe.rank.matcher;
    study.distances = distances(&query, library, &placed, &inspection, chosen);
    for distance in &mut study.distances {
        distance.title = title_of(&distance.part);
    }
    if let Some(part) = study.against.as_deref()
        && let Some(entry) = placed.entries.iter().find(|entry| entry.part == part)
        && let Some(reference) = library.references.get(entry.reference)
    {
        let placement = entry.placements.first();
        let title = title_of(part);
        study.comparison = Some(OutlineComparison::of(
            &title, &query, reference, placement, chosen,
        ));
    }
    Ok(study)
}

fn opened(case: &CaseScene) -> Result<(Arc<SceneCloud>, String, CameraKind), UserError> {
    match case {
        CaseScene::AtHand {
            scene,
            title,
            camera,
        } => Ok((Arc::clone(scene), title.clone(), *camera)),
        CaseScene::Kept { folder, case } => {
            let scene = folder.read_scene(case).map_err(|e| UserError::of(&e))?;
            let about = &case.meta.about;
            let camera = if about.simulated {
                CameraKind::Simulated
            } else {
                CameraKind::Real
            };
            Ok((Arc::new(scene), about.origin.clone(), camera))
        }
    }
}

/// The part chosen, else what it truly is where that differs from what was found, else what was found.
fn against(request: &StudyRequest, found: &FoundVerdict, library: &Library) -> Option<String> {
    let is_enrolled = |name: &&str| library.references.iter().any(|r| r.name == **name);
    let chosen = request.against.as_deref().filter(is_enrolled);
    let truth = request.truth.as_ref().and_then(Truth::part);
    let part = chosen
        .or(truth.filter(is_enrolled))
        .or(found.part.as_deref());
    part.map(str::to_owned)
}

/// A share or probability, to a hundredth.
fn fixed(value: f64) -> String {
    format!("{value:.2}")
}

/// The figure that decided.
fn refused(verdict: &Verdict, title_of: &dyn Fn(&str) -> String) -> Option<String> {
    Some(match verdict {
        Verdict::Part { rejected, .. } => match rejected.as_ref()? {
            Rejection::LowScore {
                score, threshold, ..
            } => text!(
                "compare-low-score",
                score = fixed(*score),
                threshold = fixed(*threshold),
            ),
            Rejection::SmallMargin {
                other,
                margin,
                threshold,
                ..
            } => text!(
                "compare-small-margin",
                part = title_of(other),
                margin = fixed(*margin),
                threshold = fixed(*threshold),
            ),
            Rejection::Unconfirmed { .. } => text!("compare-unconfirmed"),
            Rejection::Piece {
                score, threshold, ..
            } => text!(
                "compare-piece",
                score = fixed(*score),
                threshold = fixed(*threshold),
            ),
            Rejection::AnotherModel {
                relief,
                outline,
                missing,
                ..
            } => text!(
                "compare-another-model",
                relief = relief.to_string(),
                outline = outline.to_string(),
                missing = format!("{:.1}", missing * 100.0),
            ),
            Rejection::AnotherMake { likeness, .. } => {
                text!("compare-another-make", likeness = fixed(*likeness))
            }
            Rejection::AmbiguousPose {
                margin, threshold, ..
            } => text!(
                "compare-ambiguous-pose",
                margin = fixed(*margin),
                threshold = fixed(*threshold),
            ),
            Rejection::HardlySeen { score, .. } => {
                text!("compare-hardly-seen", score = fixed(*score))
            }
            Rejection::Unknown { score, .. } => text!("compare-unknown", score = fixed(*score)),
            Rejection::Mirrored { part, .. } => {
                text!("compare-mirrored", part = title_of(part))
            }
            Rejection::MirroredImage { part, .. } => {
                text!("compare-mirrored-image", part = title_of(part))
            }
            Rejection::Unconstrained { freedom, .. } => {
                text!(
                    "compare-unconstrained",
                    freedom = results::free_motion(*freedom)
                )
            }
            Rejection::Uncertain { shift, limit, .. } => {
                text!(
                    "compare-uncertain",
                    shift = shift.to_string(),
                    limit = limit.to_string()
                )
            }
            other @ (Rejection::NoPose(_)
            | Rejection::OutOfRange { .. }
            | Rejection::BehindCamera { .. }
            | Rejection::SurplusBytes { .. }
            | Rejection::NotSteady { .. }
            | Rejection::FewFrames { .. }
            | Rejection::Undecided { .. }
            | Rejection::PosesApart { .. }) => results::rejection(other),
        },
        Verdict::NoPart(reason) => results::unrecognisable(reason),
    })
}

fn advice(verdict: &Verdict) -> String {
    match verdict {
        Verdict::Part { rejected, .. } => rejected.as_ref().map(results::rejection_advice),
        Verdict::NoPart(reason) => Some(results::unrecognisable_advice(reason)),
    }
    .unwrap_or_default()
}

fn query_of(inspection: &Inspection) -> Option<Query<'_>> {
    Some(Query {
        plane: inspection.plane.as_ref()?,
        contour: inspection.contour.as_ref()?,
        signature: inspection.signature.as_ref()?,
    })
}

fn distances(
    query: &Query<'_>,
    library: &Library,
    placed: &MatchRanking,
    inspection: &Inspection,
    matcher: Matcher,
) -> Vec<PartDistance> {
    let score_of = |part: &str| {
        let entry = inspection.ranking.entries.iter().find(|e| e.part == part);
        entry.map_or(0.0, |entry| entry.score)
    };
    let literal = LiteralSignature::of(&query.contour.outline_pixels);
    let mut distances: Vec<PartDistance> = placed
        .entries
        .iter()
        .filter_map(|entry| {
            let reference = library.references.get(entry.reference)?;
            Some(PartDistance {
                part: entry.part.clone(),
                title: String::new(),
                outline: Some(entry.distance).filter(|distance| distance.is_finite()),
                paper: reference.literal().distance(&literal),
                shares: [0.0; 2],
                score: score_of(&entry.part),
            })
        })
        .collect();
    let outline = |d: &PartDistance| d.outline.unwrap_or(f64::INFINITY);
    let most = |of: &dyn Fn(&PartDistance) -> f64| {
        let finite = distances.iter().map(of).filter(|d| d.is_finite());
        finite.fold(f64::MIN_POSITIVE, f64::max)
    };
    let (most_outline, most_paper) = (most(&outline), most(&|d| d.paper));
    for distance in &mut distances {
        distance.shares = [
            (outline(distance) / most_outline).min(1.0) as f32,
            (distance.paper / most_paper) as f32,
        ];
    }
    match matcher {
        Matcher::Default => distances.sort_by(|a, b| outline(a).total_cmp(&outline(b))),
        Matcher::Paper => distances.sort_by(|a, b| a.paper.total_cmp(&b.paper)),
    }
    distances
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        app::inspection::source::{CellChoice, SceneSource},
        kit::shipped_library,
        pipeline::{Recipe, Unwatched},
        simulate::{PartKind, Side},
    };

    fn request(choice: CellChoice) -> StudyRequest {
        let captured = SceneSource::Cell { choice, number: 2 }
            .take(&crate::app::inspection::camera::Camera::default(), &|| {
                false
            })
            .expect("a scene");
        StudyRequest {
            case: CaseScene::AtHand {
                scene: captured.scene,
                title: captured.origin.title(),
                camera: CameraKind::Simulated,
            },
            recipe: Arc::default(),
            truth: None,
            against: None,
        }
    }

    fn studied(request: &StudyRequest) -> CaseStudy {
        let study = study(request, &LibraryCache::default(), &Unwatched);
        study.expect("studied")
    }

    #[test]
    fn without_a_choice_the_truth_is_compared_where_it_differs_else_the_best() {
        let mut request = request(CellChoice::Part(PartKind::Fender, Side::Left));
        let best = studied(&request);
        assert_eq!(best.found.part.as_deref(), Some("fender"));
        assert_eq!(best.against.as_deref(), Some("fender"));
        assert_eq!(best.distances.len(), shipped_library().references.len());
        let comparison = best.comparison.as_ref().expect("an outline");
        let overlay = comparison.overlay.as_ref().expect("placed");
        let fender = best.distances.iter().find(|d| d.part == "fender");
        assert_eq!(fender.expect("listed").outline, Some(overlay.distance));
        request.truth = Some(Truth::Part("grille".into()));
        let other = studied(&request);
        assert_eq!(other.against.as_deref(), Some("grille"));
        assert!(other.comparison.expect("an outline").l1 > comparison.l1);
        request.against = Some("trunk_lid".into());
        assert_eq!(studied(&request).against.as_deref(), Some("trunk_lid"));
    }

    #[test]
    fn an_empty_cell_has_a_reason_and_no_figures() {
        let empty = studied(&request(CellChoice::Empty));
        assert!(empty.found.part.is_none() && empty.comparison.is_none());
        assert!(empty.found.reason.is_some() && !empty.advice.is_empty());
        let refusal = empty.refusal(UnitSystem::MillimetresDegrees);
        assert!(refusal.expect("refused").starts_with("Refused: "));
    }

    #[test]
    fn a_refusal_says_the_figure_that_decided_and_how_far_the_outlines_lie_apart() {
        let door = CellChoice::Part(PartKind::FrontDoor, Side::Left);
        let accepted = studied(&request(door));
        assert_eq!(accepted.refusal(UnitSystem::MillimetresDegrees), None);
        let mut request = request(door);
        let mut recipe = Recipe::default();
        recipe.accept.min_score = 1.0;
        request.recipe = Arc::new(recipe.clone().into());
        let study = studied(&request);
        let apart = study.distances.iter().find(|d| d.part == "front_door");
        let apart = apart.and_then(|d| d.outline).expect("placed");
        let units = UnitSystem::MillimetresDegrees;
        let score = study.found.score.expect("a part");
        let expected = format!(
            "Refused: score {score:.2} is below 1.00; the outlines lie {} apart",
            units.length(apart)
        );
        assert_eq!(study.refusal(units), Some(expected));
        recipe.accept.min_score = 0.0;
        recipe.accept.min_margin = 1.0;
        request.recipe = Arc::new(recipe.into());
        let refusal = studied(&request).refusal(units).expect("refused");
        assert!(
            refusal.starts_with("Refused: its lead over ") && refusal.contains("below 1.00"),
            "{refusal}"
        );
    }

    #[test]
    fn the_chosen_matcher_orders_the_list_and_other_rays_still_compare() {
        let mut request = request(CellChoice::Part(PartKind::FrontDoor, Side::Left));
        let mut recipe = Recipe::default();
        recipe.rank.matcher = Matcher::Paper;
        recipe.signature.num_rays = 128;
        request.recipe = Arc::new(recipe.into());
        let study = studied(&request);
        let paper: Vec<f64> = study.distances.iter().map(|d| d.paper).collect();
        assert!(paper.is_sorted());
        let comparison = study.comparison.expect("an outline");
        assert_eq!(comparison.correlations.len(), 2);
        assert_eq!(comparison.overlay.expect("placed").num_rays, 128);
    }
}
