//! The study of a case: its inspection with the recipe on trial, and the comparison with one enrolled part.

use std::sync::Arc;

use super::comparison::OutlineComparison;
use inspection::{
    library::Library,
    pipeline::{Inspection, NamedRecipe, ProgressObserver, Verdict},
};
use records::cases::{CaseFolder, FoundVerdict, KeptCase, OneOfSeveral, Truth, inspect_case};
use shell::{
    inspection::{inspected::Inspected, library_cache::LibraryCache},
    language::UnitSystem,
};
use stages::{
    pose::PoseEstimate,
    rank::{MatchRanking, Matcher, Query, RankParams, rank},
    scene::SceneCloud,
    signature::LiteralSignature,
};
use station::{Doubt, Subject};
use texts::{Described as _, Message};
use ui::{
    language::{Language, advised, described, text, what_and_advice},
    task::TaskError,
    user_error::UserError,
    widgets::sentence,
};

/// The scene of a case.
#[derive(Clone, Debug)]
pub enum CaseScene {
    /// The scene of an inspection.
    Inspected(Arc<Inspected>),
    /// The scene of a kept case, still to be read.
    Kept {
        /// Its folder of cases.
        folder: CaseFolder,
        /// The case.
        case: Box<KeptCase>,
    },
}

/// What a study needs.
#[derive(Clone, Debug)]
pub struct StudyRequest {
    /// The case.
    pub case: CaseScene,
    /// The recipe on trial.
    pub recipe: Arc<NamedRecipe>,
    /// Its truth, if chosen here; otherwise the history is asked.
    pub truth: Option<Truth>,
    /// The enrolled reference to compare with, if one was chosen; the name of its entry.
    pub against: Option<String>,
}

/// What a study found.
#[derive(Debug)]
pub struct CaseStudy {
    /// The inspection whose scene this is; `None` for a kept case.
    pub inspected: Option<Arc<Inspected>>,
    /// Its truth, as chosen here or labelled in the history.
    pub truth: Option<Truth>,
    /// The recipe on trial.
    pub recipe: Arc<NamedRecipe>,
    /// The verdict by that recipe.
    pub found: FoundVerdict,
    /// Title of the found part.
    pub found_title: String,
    /// Why it was refused, with the titles of the parts; named when drawn, because the language may change.
    pub refused: Option<Message>,
    /// Why no robot may act on the pose although the part is accepted, whatever hangs there now; empty if one may.
    pub doubts: Vec<Doubt>,
    /// Time of the inspection, milliseconds.
    pub time_ms: f64,
    /// The distance of every enrolled reference, nearest by the matcher in use first.
    pub distances: Vec<PartDistance>,
    /// The enrolled reference that it is compared with; the name of its entry, which differs from the part's where that has
    /// several.
    pub against: Option<String>,
    /// Title of that reference.
    pub against_title: String,
    /// `None` if the scene has no outline.
    pub comparison: Option<OutlineComparison>,
}

/// The distance of an enrolled reference from the scene, by both matchers.
#[derive(Clone, Debug, PartialEq)]
pub struct PartDistance {
    /// Name of the part.
    pub part: String,
    /// Name of the reference's entry.
    pub enrolled_as: String,
    /// Title of the part, with the reference where the part has several.
    pub title: String,
    /// Default matcher: root mean square distance of the outlines, metres.
    pub outline: Option<f64>,
    /// Paper's matcher: ‖A − C‖₁.
    pub paper: f64,
    /// Both divided by those of the furthest part.
    pub shares: [f32; 2],
    /// Score after the confirmation, 0..1.
    pub score: f64,
}

impl CaseStudy {
    /// The reason of a refusal with the figure that decided.
    pub fn reason(&self) -> Option<String> {
        self.refused.as_ref().map(refused)
    }

    /// What to do about a refusal; empty if it was accepted.
    pub fn advice(&self) -> String {
        self.refused.as_ref().map_or_else(String::new, advised)
    }

    /// Why it was refused or why no robot may act on it, in one sentence, and what to do; `None` if nothing is wrong.
    pub fn complaint(&self, units: UnitSystem) -> Option<[String; 2]> {
        let refusal = self.refusal(units);
        let refusal = refusal.map(|refusal| [refusal, self.advice()]);
        let doubted = || {
            let [what, advice] = what_and_advice(self.doubts.first()?);
            Some([sentence(&what), advice])
        };
        refusal.or_else(doubted)
    }

    /// Why it was refused, in one sentence.
    fn refusal(&self, units: UnitSystem) -> Option<String> {
        let refused = self.reason()?;
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

/// Which part of its frame was inspected, and its name.
fn one_of(inspected: &Inspected) -> (Option<OneOfSeveral>, Option<String>) {
    let inspection = &inspected.inspection;
    let pose = inspection.found_pose().map(PoseEstimate::camera_from_part);
    let one = OneOfSeveral::of(&inspected.recipe, pose);
    (one, inspection.verdict.guess().map(str::to_owned))
}

/// Inspects a case and compares it.
pub fn study(
    request: &StudyRequest,
    library_cache: &LibraryCache,
    watch: &dyn ProgressObserver,
) -> Result<CaseStudy, TaskError> {
    let loaded = library_cache.get();
    let (scene, inspected, one_of_several, name) = match &request.case {
        CaseScene::Inspected(inspected) => {
            let (one, name) = one_of(inspected);
            let scene = Arc::clone(&inspected.scene);
            (scene, Some(Arc::clone(inspected)), one, name)
        }
        CaseScene::Kept { folder, case } => {
            let scene = folder.read_scene(case).map_err(|e| UserError::of(&e))?;
            let about = &case.meta.about;
            let (one, name) = (about.one_of_several.clone(), about.found.part.clone());
            (Arc::new(scene), None, one, name)
        }
    };
    if watch.is_cancelled() {
        return Err(TaskError::Cancelled);
    }
    let fitted = loaded.fitting(&request.recipe, watch);
    let fitted = fitted.ok_or(TaskError::Cancelled)?;
    let library: &Library = &fitted;
    let inspection = inspect_case(
        &scene,
        one_of_several.as_ref(),
        name.as_deref(),
        library,
        &request.recipe,
        watch,
    )?;
    let found = FoundVerdict::from(&inspection.verdict);
    let shown = &loaded.shown;
    let title_of = |name: &str| shown.title_of(name).to_owned();
    let known = || {
        // Why the history cannot be read is reported by the History workspace.
        let row = library_cache.history().part(inspected.as_ref()?.hung());
        row.ok()??.label
    };
    let truth = request.truth.clone().or_else(known);
    let against = against(request, truth.as_ref(), &inspection, library);
    let titles = shown.reference_titles();
    let reference_title = |name: &str| {
        let index = shown.index_of(name)?;
        titles.get(index).cloned()
    };
    let mut study = CaseStudy {
        doubts: doubts(&scene, &inspection, inspected.as_deref(), &request.recipe),
        inspected,
        truth,
        recipe: Arc::clone(&request.recipe),
        found_title: found.part.as_deref().map(title_of).unwrap_or_default(),
        refused: inspection
            .verdict
            .refusal()
            .map(|why| why.message().with_titles(title_of)),
        time_ms: inspection.timings.total.as_secs_f64() * 1000.0,
        distances: Vec::new(),
        comparison: None,
        found,
        against_title: against
            .as_deref()
            .and_then(reference_title)
            .unwrap_or_default(),
        against,
    };
    let Some(query) = inspection.query() else {
        return Ok(study);
    };
    let by_outline = RankParams {
        matcher: Matcher::Default,
        ..request.recipe.rank.clone()
    };
    let placed = rank(&query, &library.references, &by_outline);
    let chosen = request.recipe.rank.matcher;
    study.distances = distances(&query, library, &placed, &inspection, &titles, chosen);
    if let Some(name) = study.against.as_deref()
        && let Some(entry) = placed.entries.iter().find(|e| e.enrolled_as == name)
        && let Some(reference) = library.references.get(entry.reference)
    {
        let placement = entry.placements.first();
        study.comparison = Some(OutlineComparison::of(
            &study.against_title,
            &query,
            reference,
            placement,
            chosen,
        ));
    }
    Ok(study)
}

/// Name of the entry to compare with: the one chosen, else the best reference of the true part where that differs from the one
/// found, else of the one found.
fn against(
    request: &StudyRequest,
    truth: Option<&Truth>,
    inspection: &Inspection,
    library: &Library,
) -> Option<String> {
    let references = &library.references;
    let is_enrolled = |name: &&str| references.iter().any(|r| r.enrolled_as == **name);
    let chosen = request.against.as_deref().filter(is_enrolled);
    let best_of = |part: &str| {
        let mut ranked = inspection.ranking.entries.iter();
        let best = ranked.find(|entry| entry.part == part);
        // Without an outline nothing is ranked.
        let any = || references.iter().find(|reference| reference.name == part);
        best.map(|entry| &entry.enrolled_as)
            .or_else(|| any().map(|reference| &reference.enrolled_as))
    };
    let truth = truth.and_then(Truth::part).and_then(best_of);
    let found = || match &inspection.verdict {
        Verdict::Part { part, .. } => best_of(part),
        Verdict::NoPart(_) => None,
    };
    let best = || truth.or_else(found).cloned();
    chosen.map(str::to_owned).or_else(best)
}

/// The doubts about an accepted part that its capture gives, wherever the part hangs by now and whether or not the cell is
/// calibrated.
fn doubts(
    scene: &Arc<SceneCloud>,
    inspection: &Inspection,
    inspected: Option<&Inspected>,
    recipe: &NamedRecipe,
) -> Vec<Doubt> {
    if !inspection.verdict.is_accepted() {
        return Vec::new();
    }
    let subject = Subject {
        scan: inspected.and_then(|inspected| inspected.subject.scan.clone()),
        ..Subject::of_scene(String::new(), String::new(), false)
    };
    let captured = station::Inspected {
        subject: &subject,
        scene,
        inspection,
        recipe,
        robot: None,
        is_forced: false,
        on_line: None,
    };
    captured.doubts_if_calibrated()
}

/// The reason of a refusal with the figure that decided.
fn refused(why: &Message) -> String {
    let reason = why.attribute(Language::current(), "compared");
    reason.unwrap_or_else(|| described(why))
}

/// The distances of the placed references; `titles` are those of the library's.
fn distances(
    query: &Query<'_>,
    library: &Library,
    placed: &MatchRanking,
    inspection: &Inspection,
    titles: &[String],
    matcher: Matcher,
) -> Vec<PartDistance> {
    let score_of = |reference: usize| {
        let mut entries = inspection.ranking.entries.iter();
        let entry = entries.find(|entry| entry.reference == reference);
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
                enrolled_as: entry.enrolled_as.clone(),
                title: titles.get(entry.reference).cloned().unwrap_or_default(),
                outline: Some(entry.distance).filter(|distance| distance.is_finite()),
                paper: reference.literal().distance(&literal),
                shares: [0.0; 2],
                score: score_of(entry.reference),
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
    use std::time::Instant;

    use super::{super::case_bar::sign, *};
    use inspection::{
        fixtures::{add_reference, copy_library, shipped_library},
        pipeline::{Recipe, Unwatched},
    };
    use records::cases::CaseOutcome;
    use shell::inspection::{camera::Camera, inspected::inspected_cell, source::CellChoice};
    use simulate::{PartKind, Side};
    use stages::pose::RunnerUp;
    use ui::{language::Language, widgets::Mark};

    fn request(choice: CellChoice) -> StudyRequest {
        StudyRequest {
            case: CaseScene::Inspected(Arc::new(inspected_cell(choice, 2))),
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
    fn every_reference_of_a_part_has_a_row_of_its_own_and_can_be_chosen() {
        let folder = tempfile::tempdir().expect("a folder");
        copy_library(folder.path());
        add_reference(folder.path(), "fender", "fender_b");
        let library = Some(folder.path().to_owned());
        let library_cache = LibraryCache::new(library, Camera::default());
        let studied = |request: &StudyRequest| study(request, &library_cache, &Unwatched);
        let mut request = request(CellChoice::Part(PartKind::Fender, Side::Left));
        for name in ["fender", "fender_b"] {
            request.against = Some(name.into());
            let study = studied(&request).expect("studied");
            assert_eq!(study.against.as_deref(), Some(name));
            let title = format!("Fender, left · {name}");
            let row = study.distances.iter().find(|d| d.enrolled_as == name);
            let row = row.expect("listed");
            assert_eq!((row.part.as_str(), &row.title), ("fender", &title));
            assert_eq!(study.against_title, title);
            assert_eq!(study.comparison.expect("an outline").title, title);
        }
        // Without a choice it is the best reference of the true part.
        request.against = None;
        for (truth, title) in [("fender", "Fender, left · fender"), ("grille", "Grille")] {
            request.truth = Some(Truth::Part(truth.into()));
            let study = studied(&request).expect("studied");
            assert!(
                study.against_title.starts_with(title),
                "{}",
                study.against_title
            );
        }
    }

    #[test]
    fn what_somebody_said_of_the_part_in_the_history_is_its_truth_until_another_is_chosen() {
        let mut request = request(CellChoice::Part(PartKind::Fender, Side::Left));
        let CaseScene::Inspected(inspected) = &request.case else {
            panic!("not inspected");
        };
        let library_cache = LibraryCache::default();
        let history = library_cache.history();
        history.add(1, inspected.entry.clone(), Instant::now());
        let studied = |request: &StudyRequest| study(request, &library_cache, &Unwatched);
        assert_eq!(studied(&request).expect("studied").truth, None);
        let grille = Truth::Part("grille".into());
        let labelled = history.label_part(inspected.hung(), &grille, "");
        assert!(labelled.expect("labelled").is_some());
        let study = studied(&request).expect("studied");
        assert_eq!(study.truth, Some(grille));
        assert_eq!(study.against.as_deref(), Some("grille"));
        request.truth = Some(Truth::NotEnrolled);
        let study = studied(&request).expect("studied");
        assert_eq!(study.truth, Some(Truth::NotEnrolled));
    }

    #[test]
    fn an_empty_cell_has_a_reason_and_no_figures() {
        let empty = studied(&request(CellChoice::Empty));
        assert!(empty.found.part.is_none() && empty.comparison.is_none());
        assert!(empty.found.reason.is_some() && !empty.advice().is_empty());
        let units = UnitSystem::MillimetresDegrees;
        let refusal = empty.refusal(units);
        assert!(refusal.expect("refused").starts_with("Refused: "));
        // A language chosen since then counts for the reason, too.
        let (reason, advice) = (empty.reason(), empty.advice());
        Language::German.make_current();
        let refusal = empty.refusal(units).expect("refused");
        assert!(refusal.starts_with("Abgewiesen: "), "{refusal}");
        assert!(empty.reason() != reason && empty.advice() != advice);
        Language::English.make_current();
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
    fn an_accepted_part_with_a_doubt_is_amber_and_says_what_to_do() {
        let door = CellChoice::Part(PartKind::FrontDoor, Side::Left);
        let mut inspected = inspected_cell(door, 2);
        let mut study = studied(&request(door));
        let units = UnitSystem::MillimetresDegrees;
        assert!(study.doubts.is_empty() && study.complaint(units).is_none());
        assert_eq!(sign(&study, None), Mark::Good);
        let Some(Ok(pose)) = &mut inspected.inspection.pose else {
            panic!("a pose");
        };
        pose.runner_up = Some(RunnerUp {
            target_from_source: pose.target_from_source,
            ratio: 1.01,
        });
        let (scene, found) = (&inspected.scene, &inspected.inspection);
        study.doubts = doubts(scene, found, Some(&inspected), &study.recipe);
        assert_eq!(study.doubts, [Doubt::Ambiguous]);
        let [what, advice] = study.complaint(units).expect("doubted");
        assert_eq!(what, "Another pose of the part fits nearly as well");
        assert_eq!(advice, advised(&Doubt::Ambiguous));
        for (judgement, expected) in [
            (None, Mark::Look),
            (Some(CaseOutcome::Right), Mark::Look),
            (Some(CaseOutcome::WrongAccepted), Mark::Bad),
        ] {
            assert_eq!(sign(&study, judgement), expected);
        }
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
