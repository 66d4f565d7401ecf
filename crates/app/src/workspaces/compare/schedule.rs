//! The order of the task's jobs: a change of the kept cases is never cancelled, a run is cancelled when the recipe
//! changes, and the case in front is studied as soon as possible.

use std::{path::PathBuf, sync::Arc};

use super::{
    state::{CompareState, Front},
    study::{CaseScene, StudyRequest, study},
    work::{self, CaseEdit, CaseRun, CompareResult},
};
use inspection::pipeline::NamedRecipe;
use records::cases::CaseFolder;
use shell::{
    notice::Notice,
    session::{Session, Shown, WorkspaceKind},
    workspace::ShellContext,
};
use ui::{language::text, undo_stack::UndoDirection};

/// Whether the case in front has to be studied.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum StudyNeed {
    #[default]
    No,
    /// Once a run is over.
    WhenFree,
    /// At once: a run with the recipe before is cancelled.
    Now,
}

/// A job of the task besides studying the case in front.
#[derive(Clone, Debug)]
pub(super) enum Job {
    /// Change the kept cases, then list them.
    Cases {
        /// The folder; without one the user's own.
        folder: Option<PathBuf>,
        /// The change.
        change: CaseEdit,
        /// The direction of a change that undoes or redoes another one.
        way: Option<UndoDirection>,
    },
    /// Run all kept cases.
    Run {
        /// The folder.
        folder: CaseFolder,
        /// The recipe on trial.
        recipe: Arc<NamedRecipe>,
    },
    /// Measure from how many references on several workers are faster.
    Scaling,
    /// Compare a run with an earlier one.
    Earlier {
        /// The file of the earlier run.
        path: PathBuf,
        /// The run.
        run: Arc<CaseRun>,
    },
}

/// Kinds of jobs, by what may cancel them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum JobKind {
    /// May be cancelled for any other job; the case is studied again afterwards.
    Study,
    /// Is never cancelled: it is quick, and a person relies on it.
    Cases,
    /// Is cancelled for a queued job, or when the recipe changes.
    Run,
    /// Is cancelled for a queued job, or when the recipe changes.
    Scaling,
}

impl Job {
    pub(super) fn kind(&self) -> JobKind {
        match self {
            Self::Cases { .. } | Self::Earlier { .. } => JobKind::Cases,
            Self::Run { .. } => JobKind::Run,
            Self::Scaling => JobKind::Scaling,
        }
    }
}

impl CompareState {
    /// The kind of the running job, if any.
    fn job_at_work(&self) -> Option<JobKind> {
        self.running().and(self.job)
    }

    /// The recipe on trial.
    pub fn tried_recipe<'a>(&'a self, session: &'a Session) -> &'a Arc<NamedRecipe> {
        self.tried.as_ref().unwrap_or(&session.recipe)
    }

    /// True while the kept cases are run.
    pub fn is_running_cases(&self) -> bool {
        self.job_at_work() == Some(JobKind::Run)
    }

    /// True if the study shown, if any, is not that of the newest request, even if that was cancelled.
    pub fn is_study_old(&self) -> bool {
        !self.is_current || self.due != StudyNeed::No
    }

    /// True while the case in front is studied, or is to be.
    pub fn is_study_pending(&self) -> bool {
        self.due != StudyNeed::No || self.job_at_work() == Some(JobKind::Study)
    }

    /// True if the kept cases have to be listed and nothing is cancelled for it.
    pub(super) fn has_to_list(&self) -> bool {
        !self.is_listed && self.running().is_none()
    }

    /// True if [`CompareAction::Follow`](super::CompareAction::Follow) would do something.
    pub fn is_behind(&self, session: &Session) -> bool {
        let has_more = !self.queue.is_empty() || self.due != StudyNeed::No;
        let is_free = match self.job_at_work() {
            None => true,
            Some(JobKind::Run | JobKind::Scaling) => self.due == StudyNeed::Now,
            Some(JobKind::Study | JobKind::Cases) => false,
        };
        self.has_to_list() || has_more && is_free || self.has_new_scene(session)
    }

    /// True if no job runs, and none is due while the workspace is in front.
    pub(super) fn is_idle(&self, session: &Session) -> bool {
        let is_front = session.workspace == WorkspaceKind::Compare;
        self.running().is_none() && self.recipes.is_idle() && !(is_front && self.is_behind(session))
    }

    /// True if there is a newer inspection.
    pub(super) fn has_new_scene(&self, session: &Session) -> bool {
        let number = |shown: &Option<Shown>| shown.as_ref().map(|shown| shown.generation);
        number(&session.shown) != number(&self.followed)
    }

    pub(super) fn ask(&mut self, title: String, job: Job) {
        self.queue.push_back((title, job));
    }

    /// `way` is the direction of a change that undoes or redoes another one.
    pub(super) fn change_cases(&mut self, change: CaseEdit, way: Option<UndoDirection>) {
        let (title, folder) = (change.title(), self.folder.clone());
        self.ask(
            title,
            Job::Cases {
                folder,
                change,
                way,
            },
        );
    }

    /// Starts the next job, if the running one may be cancelled for it.
    pub(super) fn start_next(&mut self, cx: &ShellContext<'_>) {
        let at_work = self.job_at_work();
        match at_work {
            Some(JobKind::Cases) => return,
            Some(JobKind::Run | JobKind::Scaling)
                if self.queue.is_empty() && self.due != StudyNeed::Now =>
            {
                return;
            }
            _ => {}
        }
        let library_cache = cx.services.library_cache.clone();
        if let Some((title, job)) = self.queue.pop_front() {
            if at_work == Some(JobKind::Study) {
                self.due = self.due.max(StudyNeed::WhenFree);
            }
            self.job = Some(job.kind());
            self.task.start(title, move |context| {
                work::run(job, &library_cache, context)
            });
            self.compare_run_with_cases();
            return;
        }
        if self.due == StudyNeed::No {
            return;
        }
        self.due = StudyNeed::No;
        if let Some(request) = self.study_request(cx.session) {
            self.is_current = false;
            self.job = Some(JobKind::Study);
            self.task.start(text!("compare-comparing"), move |context| {
                let study = study(&request, &library_cache, context)?;
                Ok(CompareResult::Studied(Arc::new(study)))
            });
            self.compare_run_with_cases();
        }
    }

    pub(super) fn study_request(&self, session: &Session) -> Option<StudyRequest> {
        let case = match &self.front {
            Front::Kept(case) => CaseScene::Kept {
                folder: self.cases.as_ref()?.folder.clone(),
                case: case.clone(),
            },
            Front::Scene => CaseScene::Inspected(Arc::clone(&session.shown.as_ref()?.inspected)),
        };
        Some(StudyRequest {
            case,
            recipe: Arc::clone(self.tried_recipe(session)),
            truth: self.truth.clone(),
            against: self.against.clone(),
        })
    }

    pub(super) fn run_all(&mut self, cx: &mut ShellContext<'_>) {
        let cases = self.cases.as_ref().filter(|cases| !cases.list.is_empty());
        let Some(cases) = cases else {
            return cx.notify(no_cases());
        };
        let job = Job::Run {
            folder: cases.folder.clone(),
            recipe: Arc::clone(self.tried_recipe(cx.session)),
        };
        self.cell = None;
        self.changes = None;
        self.run = None;
        self.ask(text!("compare-running-cases"), job);
    }

    pub(super) fn compare_with_earlier(&mut self, path: PathBuf, cx: &mut ShellContext<'_>) {
        let run = self.run.clone().filter(|run| run.ended.is_some());
        let Some(run) = run else {
            return cx.notify(Notice::look(
                text!("compare-no-run"),
                text!("compare-no-run-advice"),
            ));
        };
        self.ask(
            text!("compare-comparing-earlier"),
            Job::Earlier { path, run },
        );
    }
}

/// Why no run begins; retracted once there are cases.
pub(super) fn no_cases() -> Notice {
    Notice::look(
        text!("compare-no-cases-to-run"),
        text!("compare-no-cases-to-run-advice"),
    )
}
