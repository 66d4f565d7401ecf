//! What the thread is asked for, in which order: cases are kept and removed whatever else happens, a run is given up
//! for another recipe, and the case in front is studied as soon as it may.

use std::sync::Arc;

use super::{
    CompareRequest,
    state::{CompareState, Front},
    study::{CameraKind, CaseScene, StudyRequest},
    work::CaseChange,
};
use crate::{
    app::{
        action::Effect,
        job::Request,
        lane::Lane,
        state::{Shown, State},
    },
    pipeline::Recipe,
};

/// Whether the case in front has to be studied.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Due {
    #[default]
    No,
    /// Once a run is over.
    WhenFree,
    /// At once: a run with a recipe that nobody wants any more is given up.
    Now,
}

/// What the thread is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Errand {
    Study,
    Cases,
    Run,
    Scaling,
}

impl CompareState {
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

    /// True if [`CompareAction::Follow`](super::CompareAction::Follow) would do something.
    pub fn is_compare_behind(&self) -> bool {
        let compare = &self.compare;
        let has_more = !compare.errands.is_empty() || compare.due != Due::No;
        let is_free = match compare.errand(self) {
            None => true,
            Some(Errand::Run | Errand::Scaling) => compare.due == Due::Now,
            Some(Errand::Study | Errand::Cases) => false,
        };
        !compare.is_listed || has_more && is_free || self.has_new_scene()
    }

    /// True if another scene was inspected since.
    pub(super) fn has_new_scene(&self) -> bool {
        let number = |shown: &Option<Shown>| shown.as_ref().map(|shown| shown.generation);
        number(&self.shown) != number(&self.compare.followed)
    }
}

pub(super) fn change_cases(state: &mut State, what: &str, change: CaseChange) {
    let folder = state.compare.folder.clone();
    let request = CompareRequest::Cases { folder, change };
    state.compare.errands.push_back((what.into(), request));
}

/// Posts what is next. Cases are never kept or removed by halves: nothing pushes them out of their thread.
pub(super) fn next(state: &mut State) -> Option<Effect> {
    let errand = state.compare.errand(state);
    match errand {
        Some(Errand::Cases) => return None,
        Some(Errand::Run | Errand::Scaling)
            if state.compare.errands.is_empty() && state.compare.due != Due::Now =>
        {
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
            CompareRequest::Scaling => Errand::Scaling,
            // As with the cases, nothing pushes it out: it is quick.
            CompareRequest::Cases { .. } | CompareRequest::Earlier { .. } => Errand::Cases,
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
                camera: if inspected.origin.is_simulated() {
                    CameraKind::Simulated
                } else {
                    CameraKind::Real
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
