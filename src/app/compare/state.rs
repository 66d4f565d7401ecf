//! What the workspace knows, and what changes it.

use std::{collections::VecDeque, path::PathBuf, sync::Arc};

use jiff::Timestamp;

use super::{
    CompareAnswer, CompareRequest,
    parameters::{Parameter, num_changed},
    study::{CameraKind, CaseScene, Study, StudyRequest},
    work::{CaseChange, CaseDone, CaseRun},
};
use crate::{
    app::{
        action::{Effect, notify},
        inspect::work::InspectRequest,
        job::{Request, Trouble},
        lane::Lane,
        source::{Origin, SceneSource},
        state::{Notice, NoticeKind, Shown, State},
    },
    cases::{CaseAbout, CaseFolder, Cell, KeptCase, Truth},
    pipeline::Recipe,
};

/// What the workspace knows.
#[derive(Debug, Default)]
pub struct CompareState {
    /// The folder of cases that was asked for; without one the user's own.
    pub folder: Option<PathBuf>,
    /// The case in front.
    pub front: Front,
    /// What it truly is, once somebody said so.
    pub truth: Option<Truth>,
    /// The part to compare with, if somebody chose one.
    pub against: Option<String>,
    /// The remark that the case is kept with.
    pub remark: String,
    /// The recipe on trial; without one that in use.
    pub tried: Option<Arc<Recipe>>,
    /// The case under the glass; while another is prepared it is old.
    pub study: Option<Arc<Study>>,
    /// The kept cases, once listed.
    pub cases: Option<Cases>,
    /// What came out of them, the last time.
    pub run: Option<Arc<CaseRun>>,
    /// The cell of the matrix whose cases are listed.
    pub cell: Option<Cell>,
    /// What can be taken back.
    pub undo: Option<Undo>,
    /// True while the study is of what was asked for last.
    is_current: bool,
    due: Due,
    errands: VecDeque<(String, CompareRequest)>,
    posted: Option<(u64, Errand)>,
    /// The inspected scene that was followed last.
    followed: Option<Shown>,
    is_listed: bool,
    /// What was said last of something done: the next takes its place.
    said: Option<Notice>,
}

/// The case in front.
#[derive(Clone, Debug, Default)]
pub enum Front {
    /// The scene that was inspected last.
    #[default]
    Scene,
    /// A kept case.
    Kept(Box<KeptCase>),
}

/// The kept cases.
#[derive(Clone, Debug)]
pub struct Cases {
    /// Their folder.
    pub folder: CaseFolder,
    /// The cases in the order of their names.
    pub list: Arc<[KeptCase]>,
}

/// What can be taken back.
#[derive(Clone, Debug)]
pub enum Undo {
    /// The removal of a case.
    Removal {
        /// Its name.
        name: String,
        /// Where it lies.
        trash: PathBuf,
    },
    /// The use of a recipe: the one before.
    Use(Arc<Recipe>),
}

impl Undo {
    /// What the button says.
    pub fn title(&self) -> &'static str {
        match self {
            Self::Removal { .. } => "Put case back",
            Self::Use(_) => "Undo use",
        }
    }
}

/// Whether the case in front has to be studied.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
enum Due {
    #[default]
    No,
    /// Once a run is over.
    WhenFree,
    /// At once: a run with a recipe that nobody wants any more is given up.
    Now,
}

/// What the thread is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Errand {
    Study,
    Cases,
    Run,
}

/// Something that happened in the workspace.
#[derive(Clone, Debug)]
pub enum CompareAction {
    /// Look whether there is something to do: the workspace came to the front, or another scene did.
    Follow,
    /// The case in front is the scene that was inspected last.
    FrontScene,
    /// The kept case of this name comes to the front.
    OpenCase(String),
    /// This is what it truly is.
    SetTruth(Truth),
    /// Compare with this part; without one the part follows from truth and verdict.
    Against(Option<String>),
    /// The remark that the case is kept with.
    Remark(String),
    /// Keep the case in front.
    Keep,
    /// Run all kept cases with the recipe on trial.
    RunAll,
    /// Use this folder of cases.
    Folder(PathBuf),
    /// List the cases of this cell of the matrix, or show the matrix.
    ShowCell(Option<Cell>),
    /// Remove the kept case of this name.
    Remove(String),
    /// Give the parameter of this key a value, as [`Parameter::set`] takes it.
    Set(&'static str, f64),
    /// Give the parameter of this key its default.
    Reset(&'static str),
    /// Give every parameter its default.
    ResetAll,
    /// Inspect with the recipe on trial from now on.
    Use,
    /// Take back what was done last.
    Undo,
}

impl CompareState {
    /// With this folder of cases; without one the user's own.
    pub fn with_folder(folder: Option<PathBuf>) -> Self {
        Self {
            folder,
            ..Self::default()
        }
    }

    /// What the thread is at, if anything.
    fn errand(&self, state: &State) -> Option<Errand> {
        let (generation, errand) = self.posted?;
        let work = state.works.get(&Lane::Compare)?;
        (work.generation == generation).then_some(errand)
    }
}

impl State {
    /// The recipe on trial.
    pub fn tried_recipe(&self) -> &Arc<Recipe> {
        self.compare.tried.as_ref().unwrap_or(&self.recipe)
    }

    /// True while all kept cases are run.
    pub fn is_running_cases(&self) -> bool {
        self.compare.errand(self) == Some(Errand::Run)
    }

    /// True while the study shown, if any, is not of what was asked for last; also after that was cancelled.
    pub fn is_study_old(&self) -> bool {
        !self.compare.is_current || self.compare.due != Due::No
    }

    /// True if [`CompareAction::Follow`] would do something.
    pub fn is_compare_behind(&self) -> bool {
        let compare = &self.compare;
        let has_more = !compare.errands.is_empty() || compare.due != Due::No;
        let is_free = match compare.errand(self) {
            None => true,
            Some(Errand::Run) => compare.due == Due::Now,
            Some(Errand::Study | Errand::Cases) => false,
        };
        !compare.is_listed || has_more && is_free || self.has_new_scene()
    }

    /// True if another scene was inspected since.
    fn has_new_scene(&self) -> bool {
        let number = |shown: &Option<Shown>| shown.as_ref().map(|shown| shown.generation);
        number(&self.shown) != number(&self.compare.followed)
    }
}

/// Makes it so.
pub fn apply(state: &mut State, action: CompareAction) -> Option<Effect> {
    match action {
        CompareAction::Follow => follow(state),
        CompareAction::FrontScene => {
            state.compare.front = Front::Scene;
            forget(state);
            state.compare.due = Due::Now;
        }
        CompareAction::OpenCase(name) => open_case(state, &name),
        CompareAction::SetTruth(truth) => {
            state.compare.truth = Some(truth);
            state.compare.due = Due::WhenFree;
        }
        CompareAction::Against(part) => {
            state.compare.against = part;
            state.compare.due = Due::WhenFree;
        }
        CompareAction::Remark(remark) => state.compare.remark = remark,
        CompareAction::Keep => keep(state),
        CompareAction::RunAll => run_all(state),
        CompareAction::Folder(path) => {
            let compare = &mut state.compare;
            compare.folder = Some(path);
            compare.cases = None;
            compare.run = None;
            compare.cell = None;
            compare.undo = None;
            if matches!(compare.front, Front::Kept(_)) {
                compare.front = Front::Scene;
                forget(state);
                state.compare.due = Due::WhenFree;
            }
            change_cases(state, "Listing the kept cases", CaseChange::List);
        }
        CompareAction::ShowCell(cell) => state.compare.cell = cell,
        CompareAction::Remove(name) => {
            change_cases(state, "Removing a case", CaseChange::Remove(name));
        }
        CompareAction::Set(key, value) => {
            change_recipe(state, |recipe| match Parameter::of_key(key) {
                Some(parameter) => parameter.set(recipe, value).map_err(|e| Trouble::of(&e)),
                None => Ok(()),
            });
        }
        CompareAction::Reset(key) => change_recipe(state, |recipe| {
            if let Some(parameter) = Parameter::of_key(key) {
                parameter.copy(&Recipe::default(), recipe);
            }
            Ok(())
        }),
        CompareAction::ResetAll => change_recipe(state, |recipe| {
            *recipe = Recipe::default();
            Ok(())
        }),
        CompareAction::Use => return use_recipe(state),
        CompareAction::Undo => return undo(state),
    }
    next(state)
}

/// Takes in what the thread answers.
pub fn hear(state: &mut State, outcome: Result<CompareAnswer, Trouble>) -> Option<Effect> {
    match outcome {
        Ok(CompareAnswer::Studied(study)) => {
            state.compare.study = Some(study);
            state.compare.is_current = true;
        }
        Ok(CompareAnswer::Ran(run)) => {
            if run.ended.is_some() {
                for trouble in run.troubles.clone() {
                    notify(state, trouble.into());
                }
            }
            state.compare.run = Some(run);
        }
        Ok(CompareAnswer::Cases {
            folder,
            cases,
            troubles,
            done,
        }) => {
            for trouble in troubles {
                notify(state, trouble.into());
            }
            hear_done(state, done);
            state.compare.cases = Some(Cases {
                folder,
                list: cases,
            });
        }
        // It was shown.
        Err(_) => {}
    }
    next(state)
}

fn hear_done(state: &mut State, done: CaseDone) {
    match done {
        CaseDone::Listed => {}
        CaseDone::Kept(case) => {
            say(state, format!("Kept as {}", case.name));
            state.compare.remark.clear();
        }
        CaseDone::Removed { name, trash } => {
            say(state, format!("Removed {name}"));
            let is_front = matches!(&state.compare.front, Front::Kept(case) if case.name == name);
            if is_front {
                state.compare.front = Front::Scene;
                forget(state);
                state.compare.due = Due::WhenFree;
            }
            state.compare.undo = Some(Undo::Removal { name, trash });
        }
        CaseDone::Restored(name) => {
            say(state, format!("{name} is back"));
            state.compare.undo = None;
        }
    }
}

/// Says that something was done, in the place of what was said before.
fn say(state: &mut State, what: String) {
    let notice = Notice::done(what);
    let before = state.compare.said.replace(notice.clone());
    state.notices.retain(|known| Some(known) != before.as_ref());
    notify(state, notice);
}

/// Another case has another truth.
fn forget(state: &mut State) {
    state.compare.truth = None;
    state.compare.against = None;
    state.compare.remark.clear();
}

fn follow(state: &mut State) {
    if !state.compare.is_listed {
        state.compare.is_listed = true;
        change_cases(state, "Listing the kept cases", CaseChange::List);
    }
    if state.has_new_scene() {
        let scene_of = |shown: &Option<Shown>| {
            let shown = shown.as_ref();
            shown.map(|shown| Arc::clone(&shown.inspected.scene))
        };
        let (before, now) = (scene_of(&state.compare.followed), scene_of(&state.shown));
        let is_other = before
            .zip(now)
            .is_none_or(|(before, now)| !Arc::ptr_eq(&before, &now));
        state.compare.followed.clone_from(&state.shown);
        if is_other {
            // What was captured or opened now is what a person wants to see.
            state.compare.front = Front::Scene;
            forget(state);
        }
        state.compare.due = state.compare.due.max(Due::WhenFree);
    }
}

fn open_case(state: &mut State, name: &str) {
    let cases = state.compare.cases.as_ref();
    let case = cases.and_then(|cases| cases.list.iter().find(|case| case.name == name));
    let Some(case) = case.cloned() else {
        let gone = Notice {
            kind: NoticeKind::Look,
            what: format!("There is no kept case named {name} any more"),
            advice: "Run all cases again".into(),
        };
        return notify(state, gone);
    };
    forget(state);
    state.compare.truth = Some(case.meta.about.truth.clone());
    state.compare.front = Front::Kept(Box::new(case));
    state.compare.due = Due::Now;
}

fn keep(state: &mut State) {
    let refuse = |state: &mut State, what: &str, advice: &str| {
        let notice = Notice {
            kind: NoticeKind::Look,
            what: what.into(),
            advice: advice.into(),
        };
        notify(state, notice);
    };
    let Some(study) = state
        .compare
        .study
        .clone()
        .filter(|_| !state.is_study_old())
    else {
        return refuse(
            state,
            "There is no case to keep yet",
            "Capture or open a scene, and wait until it was inspected",
        );
    };
    if matches!(state.compare.front, Front::Kept(_)) {
        return refuse(
            state,
            "This case is kept already",
            "Capture or open another scene",
        );
    }
    let Some(truth) = state.compare.truth.clone() else {
        return refuse(
            state,
            "A case without a truth teaches nothing",
            "Choose first what it is",
        );
    };
    let about = CaseAbout {
        origin: study.title.clone(),
        simulated: study.camera == CameraKind::Simulated,
        kept_at: Timestamp::now(),
        remark: state.compare.remark.trim().to_owned(),
        truth,
        found: study.found.clone(),
    };
    let change = CaseChange::Keep {
        scene: Arc::clone(&study.scene),
        about: Box::new(about),
    };
    change_cases(state, "Keeping the case", change);
}

fn run_all(state: &mut State) {
    let Some(cases) = state.compare.cases.clone().filter(|c| !c.list.is_empty()) else {
        let none = Notice {
            kind: NoticeKind::Look,
            what: "There are no kept cases to run".into(),
            advice: "Keep a case first, or choose a folder of cases".into(),
        };
        return notify(state, none);
    };
    let request = CompareRequest::Run {
        folder: cases.folder,
        recipe: Arc::clone(state.tried_recipe()),
    };
    state.compare.cell = None;
    state.compare.run = None;
    let errand = ("Running the kept cases".to_owned(), request);
    state.compare.errands.push_back(errand);
}

/// Tries another recipe on the case in front at once.
fn change_recipe(state: &mut State, change: impl FnOnce(&mut Recipe) -> Result<(), Trouble>) {
    let mut recipe = Recipe::clone(state.tried_recipe());
    match change(&mut recipe) {
        Ok(()) if recipe == **state.tried_recipe() => {}
        Ok(()) => {
            let is_in_use = recipe == *state.recipe;
            state.compare.tried = (!is_in_use).then(|| Arc::new(recipe));
            state.compare.due = Due::Now;
        }
        Err(trouble) => notify(state, trouble.into()),
    }
}

fn use_recipe(state: &mut State) -> Option<Effect> {
    let tried = state.compare.tried.take()?;
    let num = num_changed(&tried);
    let text = match num {
        0 => "Scenes are inspected with the default recipe now".to_owned(),
        1 => "Scenes are inspected with this recipe now: 1 changed from default".to_owned(),
        _ => format!("Scenes are inspected with this recipe now: {num} changed from default"),
    };
    say(state, text);
    let before = std::mem::replace(&mut state.recipe, tried);
    state.compare.undo = Some(Undo::Use(before));
    inspect_again(state)
}

fn undo(state: &mut State) -> Option<Effect> {
    match state.compare.undo.take()? {
        Undo::Removal { name, trash } => {
            let change = CaseChange::Restore { name, from: trash };
            change_cases(state, "Putting the case back", change);
            next(state)
        }
        Undo::Use(before) => {
            // What was in use stays on trial.
            let tried = std::mem::replace(&mut state.recipe, before);
            state.compare.tried.get_or_insert(tried);
            say(
                state,
                "Scenes are inspected with the recipe before again".into(),
            );
            inspect_again(state)
        }
    }
}

/// The scene in front of the Inspect workspace, with the recipe now in use.
fn inspect_again(state: &mut State) -> Option<Effect> {
    let Some(shown) = &state.shown else {
        return next(state);
    };
    let inspected = &shown.inspected;
    let source = SceneSource::AtHand(Arc::clone(&inspected.scene), inspected.origin.clone());
    let recipe = Arc::clone(&state.recipe);
    let request = Request::Inspect(InspectRequest { source, recipe });
    Some(state.begin("Inspecting with another recipe", request))
}

fn change_cases(state: &mut State, what: &str, change: CaseChange) {
    let folder = state.compare.folder.clone();
    let request = CompareRequest::Cases { folder, change };
    state.compare.errands.push_back((what.into(), request));
}

/// Posts what is next. Cases are never kept or removed by halves: nothing pushes them out of their thread.
fn next(state: &mut State) -> Option<Effect> {
    let errand = state.compare.errand(state);
    match errand {
        Some(Errand::Cases) => return None,
        Some(Errand::Run) if state.compare.errands.is_empty() && state.compare.due != Due::Now => {
            return None;
        }
        _ => {}
    }
    if let Some((what, request)) = state.compare.errands.pop_front() {
        if errand == Some(Errand::Study) {
            // It is pushed out, and has its turn again.
            state.compare.due = state.compare.due.max(Due::WhenFree);
        }
        let kind = match &request {
            CompareRequest::Run { .. } => Errand::Run,
            CompareRequest::Cases { .. } => Errand::Cases,
            CompareRequest::Study(_) => Errand::Study,
        };
        return Some(post(state, what, request, kind));
    }
    if state.compare.due == Due::No {
        return None;
    }
    state.compare.due = Due::No;
    let request = study_request(state)?;
    state.compare.is_current = false;
    let what = "Comparing".to_owned();
    let request = CompareRequest::Study(Box::new(request));
    Some(post(state, what, request, Errand::Study))
}

fn post(state: &mut State, what: String, request: CompareRequest, kind: Errand) -> Effect {
    let effect = state.begin(what, Request::Compare(request));
    state.compare.posted = Some((state.generation, kind));
    effect
}

fn study_request(state: &State) -> Option<StudyRequest> {
    let compare = &state.compare;
    let case = match &compare.front {
        Front::Kept(case) => CaseScene::Kept {
            folder: compare.cases.as_ref()?.folder.clone(),
            case: case.clone(),
        },
        Front::Scene => {
            let inspected = &state.shown.as_ref()?.inspected;
            CaseScene::AtHand {
                scene: Arc::clone(&inspected.scene),
                title: inspected.origin.title(),
                camera: match inspected.origin {
                    Origin::Simulated { .. } => CameraKind::Simulated,
                    Origin::File(_) => CameraKind::Real,
                },
            }
        }
    };
    Some(StudyRequest {
        case,
        recipe: Arc::clone(state.tried_recipe()),
        truth: compare.truth.clone(),
        against: compare.against.clone(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        app::{action, job::Answer, worker::News},
        cases::{CaseMeta, Edge, Found, SCHEMA_VERSION, SceneRecord},
    };

    fn kept(name: &str) -> KeptCase {
        let about = CaseAbout {
            origin: name.into(),
            simulated: true,
            kept_at: Timestamp::UNIX_EPOCH,
            remark: String::new(),
            truth: Truth::Part("fender".into()),
            found: Found::default(),
        };
        let scene = SceneRecord {
            bytes: 0,
            crc32: 0,
            picture_edge: Edge::View,
            camera: None,
        };
        KeptCase {
            name: name.into(),
            meta: CaseMeta {
                schema_version: SCHEMA_VERSION,
                about,
                scene,
            },
        }
    }

    fn listed(done: CaseDone) -> CompareAnswer {
        CompareAnswer::Cases {
            folder: CaseFolder::at("cases"),
            cases: [kept("a"), kept("b")].into(),
            troubles: Vec::new(),
            done,
        }
    }

    fn posted(effect: Option<Effect>) -> Option<(u64, CompareRequest)> {
        match effect? {
            Effect::Post {
                generation,
                request: Request::Compare(request),
            } => Some((generation, request)),
            other => panic!("expected a request of the workspace, found {other:?}"),
        }
    }

    fn act(state: &mut State, action: CompareAction) -> Option<(u64, CompareRequest)> {
        posted(apply(state, action))
    }

    fn done(
        state: &mut State,
        generation: u64,
        answer: CompareAnswer,
    ) -> Option<(u64, CompareRequest)> {
        let news = News::Done {
            generation,
            outcome: Ok(Answer::Compare(answer)),
        };
        posted(action::apply(
            state,
            action::Action::Hear(Lane::Compare, news),
        ))
    }

    /// Two kept cases, the first in front and under study.
    fn with_a_case() -> (State, u64) {
        let mut state = State::default();
        let (generation, request) = act(&mut state, CompareAction::Follow).expect("posted");
        assert!(matches!(
            request,
            CompareRequest::Cases {
                change: CaseChange::List,
                ..
            }
        ));
        assert!(done(&mut state, generation, listed(CaseDone::Listed)).is_none());
        let opened = act(&mut state, CompareAction::OpenCase("a".into()));
        let (generation, request) = opened.expect("posted");
        let CompareRequest::Study(request) = request else {
            panic!("studied");
        };
        assert_eq!(request.truth, Some(Truth::Part("fender".into())));
        (state, generation)
    }

    #[test]
    fn a_change_of_the_kept_cases_is_never_pushed_out() {
        let (mut state, _) = with_a_case();
        let (removing, _) = act(&mut state, CompareAction::Remove("b".into())).expect("posted");
        // The study that it pushed out, and whatever comes meanwhile, waits.
        let set = CompareAction::Set("accept.min_score", 0.5);
        assert!(act(&mut state, set).is_none());
        assert!(act(&mut state, CompareAction::RunAll).is_none());
        assert!(!state.is_compare_behind());
        let removed = CaseDone::Removed {
            name: "b".into(),
            trash: "trash/b".into(),
        };
        let (running, request) = done(&mut state, removing, listed(removed)).expect("posted");
        assert!(matches!(request, CompareRequest::Run { .. }));
        assert!(state.is_running_cases());
        assert!(matches!(state.compare.undo, Some(Undo::Removal { .. })));
        // The recipe was changed before the run began: the case in front still comes, as soon as it may.
        assert!(state.is_compare_behind());
        let (studying, request) = act(&mut state, CompareAction::Follow).expect("posted");
        assert!(matches!(request, CompareRequest::Study(_)) && studying > running);
    }

    #[test]
    fn another_recipe_gives_a_run_up_and_another_part_waits_for_its_end() {
        let (mut state, _) = with_a_case();
        let (_, request) = act(&mut state, CompareAction::RunAll).expect("posted");
        assert!(matches!(request, CompareRequest::Run { .. }));
        let against = CompareAction::Against(Some("grille".into()));
        assert!(act(&mut state, against).is_none());
        assert!(state.is_running_cases() && state.is_study_old());
        let set = CompareAction::Set("project.pixel", 4.0);
        let (_, request) = act(&mut state, set).expect("posted");
        let CompareRequest::Study(request) = request else {
            panic!("studied");
        };
        assert_eq!(request.recipe.project.pixel, crate::units::Metres(0.004));
        assert_eq!(request.against.as_deref(), Some("grille"));
        assert!(!state.is_running_cases());
    }

    #[test]
    fn a_study_that_was_cancelled_stays_marked_old_and_is_not_kept() {
        let (mut state, _) = with_a_case();
        assert!(state.is_study_old());
        action::apply(&mut state, action::Action::Cancel(Lane::Compare));
        assert!(state.is_study_old() && !state.is_compare_behind());
        assert!(act(&mut state, CompareAction::Keep).is_none());
        assert!(state.notices[0].what.contains("no case to keep"));
    }

    #[test]
    fn a_recipe_that_is_the_one_in_use_again_is_no_longer_on_trial() {
        let (mut state, _) = with_a_case();
        act(&mut state, CompareAction::Set("project.pixel", 4.0)).expect("posted");
        assert!(state.compare.tried.is_some());
        act(&mut state, CompareAction::Reset("project.pixel")).expect("posted");
        assert!(state.compare.tried.is_none());
        // Nothing is inspected anew for what changes nothing or cannot be.
        assert!(act(&mut state, CompareAction::ResetAll).is_none());
        assert!(act(&mut state, CompareAction::Set("project.pixel", 400.0)).is_none());
        assert!(state.notices[0].what.contains("Pixel cannot be 400 mm"));
        assert!(state.compare.tried.is_none());
    }

    #[test]
    fn what_is_said_of_something_done_takes_the_place_of_what_was_said_before() {
        let mut state = State::default();
        for name in ["a", "b"] {
            hear_done(&mut state, CaseDone::Kept(Box::new(kept(name))));
        }
        let said: Vec<_> = state.notices.iter().map(|n| n.what.as_str()).collect();
        assert_eq!(said, ["Kept as b"]);
    }
}
