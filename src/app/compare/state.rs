//! What the workspace knows, and what changes it.

use std::{collections::VecDeque, path::PathBuf, sync::Arc};

use super::{
    CompareAnswer, CompareRequest,
    errands::{Due, Errand, change_cases, next},
    keeping::keep,
    parameters::Parameter,
    study::Study,
    trial::{change_recipe, undo, use_recipe},
    work::{CaseChange, CaseDone, CaseRun, RunChanges},
};
use crate::{
    app::{
        action::{Effect, notify},
        job::Trouble,
        state::{Notice, NoticeKind, Shown, State},
    },
    bench::scaling::Scaling,
    cases::{CaseFolder, Cell, KeptCase, Truth},
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
    /// What ranking takes by several workers, once measured.
    pub scaling: Option<Arc<Scaling>>,
    /// What changed since an earlier run, listed instead of the matrix.
    pub changes: Option<Arc<RunChanges>>,
    /// What can be taken back.
    pub undo: Option<Undo>,
    /// True while the study is of what was asked for last.
    pub(super) is_current: bool,
    pub(super) due: Due,
    pub(super) errands: VecDeque<(String, CompareRequest)>,
    pub(super) posted: Option<(u64, Errand)>,
    /// The inspected scene that was followed last.
    pub(super) followed: Option<Shown>,
    pub(super) is_listed: bool,
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
    /// Measure from how many references on several workers pay.
    MeasureScaling,
    /// List what changed since the run that has written this file.
    Earlier(PathBuf),
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
            compare.changes = None;
            compare.undo = None;
            if matches!(compare.front, Front::Kept(_)) {
                compare.front = Front::Scene;
                forget(state);
                state.compare.due = Due::WhenFree;
            }
            change_cases(state, "Listing the kept cases", CaseChange::List);
        }
        CompareAction::ShowCell(cell) => {
            state.compare.cell = cell;
            state.compare.changes = None;
        }
        CompareAction::MeasureScaling => {
            let errand = ("Measuring the ranking".to_owned(), CompareRequest::Scaling);
            state.compare.errands.push_back(errand);
        }
        CompareAction::Earlier(path) => earlier(state, path),
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
        Ok(CompareAnswer::Scaled(scaling)) => state.compare.scaling = Some(scaling),
        Ok(CompareAnswer::Changed(changes)) => {
            state.compare.cell = None;
            state.compare.changes = Some(changes);
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
pub(super) fn say(state: &mut State, what: String) {
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
        state.compare.followed.clone_from(&state.session.shown);
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
    state.compare.changes = None;
    state.compare.run = None;
    let errand = ("Running the kept cases".to_owned(), request);
    state.compare.errands.push_back(errand);
}

fn earlier(state: &mut State, path: PathBuf) {
    let run = state.compare.run.clone();
    let Some(run) = run.filter(|run| run.ended.is_some()) else {
        let none = Notice {
            kind: NoticeKind::Look,
            what: "There is no run to compare with an earlier one".into(),
            advice: "Run all cases first".into(),
        };
        return notify(state, none);
    };
    let request = CompareRequest::Earlier { path, run };
    let errand = ("Comparing with an earlier run".to_owned(), request);
    state.compare.errands.push_back(errand);
}

#[cfg(test)]
mod tests;
