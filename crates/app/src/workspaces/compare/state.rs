//! The state of the workspace, and the actions that change it.

use std::{
    collections::{HashMap, VecDeque},
    path::PathBuf,
    sync::Arc,
};

use crate::workspaces::compare::{
    action::{CompareAction, CompareFile, RecipeAction},
    kept_recipes::KeptRecipes,
    scaling::Scaling,
    schedule::{Job, JobKind, StudyNeed, no_cases},
    study::CaseStudy,
    work::{CaseDone, CaseEdit, CaseRun, CompareResult, RunChanges},
};
use inspection::{
    library::PartName,
    pipeline::{NamedRecipe, Recipe, RecipeFile, parameters::Parameter},
};
use records::{
    cases::{CaseDescription, CaseError, CaseFolder, Cell, KeptCase, Truth},
    history::{HistoryBuffer, HistoryError},
};
use shell::{
    action::Action,
    file_dialog::FileDialog,
    inspection::{folder_watch::FolderWatch, inspected::Inspected},
    notice::{Notice, NoticeTopic},
    session::Shown,
    workspace::ShellContext,
};
use ui::{
    language::text,
    task::{Running, Task, TaskRunner},
    undo_stack::{UndoDirection, UndoStack},
    user_error::UserError,
};

/// The state of the workspace.
#[derive(Debug)]
pub struct CompareState {
    /// The chosen folder of cases; without one the user's own.
    pub folder: Option<PathBuf>,
    /// The case in front.
    pub front: Front,
    /// Its truth, once chosen here or known from the history.
    pub truth: Option<Truth>,
    /// The entry of the reference to compare with, if one was chosen.
    pub against: Option<String>,
    /// The remark that the case is kept with.
    pub remark: String,
    /// The recipe on trial; without one it is the recipe in use.
    pub tried: Option<Arc<NamedRecipe>>,
    /// The study of the case in front; out of date while the next is computed.
    pub study: Option<Arc<CaseStudy>>,
    /// The kept cases, once listed.
    pub cases: Option<Cases>,
    /// The last run over all kept cases.
    pub run: Option<Arc<CaseRun>>,
    /// Number of the cases kept now that the run covers, if these are not the cases that it ran over.
    pub(super) num_covered: Option<usize>,
    /// The cell of the matrix whose cases are listed.
    pub cell: Option<Cell>,
    /// Time of ranking with several workers, once measured.
    pub scaling: Option<Arc<Scaling>>,
    /// Changes since an earlier run, listed instead of the matrix.
    pub changes: Option<Arc<RunChanges>>,
    /// The changes that can be undone and redone.
    pub undo: UndoStack<Undo>,
    /// The kept recipes.
    pub recipes: KeptRecipes,
    /// True if the study is of the newest request.
    pub(super) is_current: bool,
    pub(super) due: StudyNeed,
    /// Waiting jobs with their titles.
    pub(super) queue: VecDeque<(String, Job)>,
    pub(super) task: Task<CompareResult>,
    /// The kind of the task's newest job.
    pub(super) job: Option<JobKind>,
    dialog: FileDialog<CompareFile>,
    /// The newest inspection that was noticed.
    pub(super) followed: Option<Shown>,
    /// False if the kept cases have to be listed: at first, and after a change by another program.
    pub(super) is_listed: bool,
    /// Watches for changes of the kept cases by other programs.
    watch: FolderWatch,
    /// The last notice of something done; the next one replaces it.
    last_notice: Option<Notice>,
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
    /// Errors of the cases that cannot be read.
    pub problems: Arc<[UserError]>,
}

impl Cases {
    pub(super) fn read(folder: CaseFolder) -> Result<Self, CaseError> {
        let list = folder.list()?;
        Ok(Self {
            problems: list.problems.iter().map(UserError::of).collect(),
            list: list.cases.into(),
            folder,
        })
    }
}

/// A change that undoes or redoes another one.
#[derive(Clone, Debug)]
pub enum Undo {
    /// Change the kept cases of this folder.
    Cases(CaseFolder, CaseEdit),
    /// Save a removed recipe again.
    Recipe {
        /// Its contents.
        file: Box<RecipeFile>,
        /// True if it was the default recipe.
        was_default: bool,
    },
    /// Remove the recipe of this name.
    RemoveRecipe(PartName),
    /// Use this recipe.
    Use(Arc<NamedRecipe>),
    /// Put this recipe on trial.
    Trial(Arc<NamedRecipe>),
}

impl Undo {
    /// Text of the button that undoes.
    pub fn title(&self) -> String {
        match self {
            Self::Cases(_, CaseEdit::Restore { .. }) => text!("compare-undo-removal"),
            Self::Cases(_, CaseEdit::SetTruth { .. }) => text!("compare-undo-truth"),
            Self::Cases(..) => text!("compare-undo-keep"),
            Self::Recipe { .. } | Self::RemoveRecipe(_) => text!("compare-undo-recipe"),
            Self::Use(_) => text!("compare-undo-use"),
            Self::Trial(_) => text!("compare-undo-open"),
        }
    }
}

impl CompareState {
    /// `folder` holds the cases, by default the user's own; without `recipes` no recipe can be saved.
    pub fn new(folder: Option<PathBuf>, recipes: Option<PathBuf>, runner: &TaskRunner) -> Self {
        Self {
            folder,
            front: Front::default(),
            truth: None,
            against: None,
            remark: String::new(),
            tried: None,
            study: None,
            cases: None,
            run: None,
            num_covered: None,
            cell: None,
            scaling: None,
            changes: None,
            undo: UndoStack::default(),
            recipes: KeptRecipes::new(recipes, runner),
            is_current: false,
            due: StudyNeed::No,
            queue: VecDeque::new(),
            task: Task::new("compare", runner),
            job: None,
            dialog: FileDialog::default(),
            followed: None,
            is_listed: false,
            watch: FolderWatch::new("case-watch", runner),
            last_notice: None,
        }
    }

    /// The job that is running, if any.
    pub fn running(&self) -> Option<&Running> {
        self.task.running()
    }

    /// Cancels the running job.
    pub fn cancel(&mut self) {
        self.task.cancel();
        self.compare_run_with_cases();
    }

    /// Carries out an action.
    pub fn apply(&mut self, action: CompareAction, cx: &mut ShellContext<'_>) {
        match action {
            CompareAction::Follow => self.follow(cx),
            CompareAction::FrontScene => {
                self.front_scene();
                self.due = StudyNeed::Now;
            }
            CompareAction::OpenCase(name) => self.open_case(&name, cx),
            CompareAction::SetTruth(truth) => {
                cx.send(Action::RemoveNotices(NoticeTopic::Case));
                self.set_truth(truth);
            }
            CompareAction::Against(part) => {
                self.against = part;
                self.due = StudyNeed::WhenFree;
            }
            CompareAction::Remark(remark) => self.remark = remark,
            CompareAction::Keep => self.keep(cx),
            CompareAction::RunAll => self.run_all(cx),
            CompareAction::Ask(file) => {
                let lock = &cx.services.dialogs;
                self.dialog.open(file, &file.request(), lock, cx.egui);
            }
            CompareAction::Folder(path) => self.use_folder(path),
            CompareAction::ShowCell(cell) => {
                self.cell = cell;
                self.changes = None;
            }
            CompareAction::MeasureScaling => {
                self.ask(text!("compare-measuring"), Job::Scaling);
            }
            CompareAction::Earlier(path) => self.compare_with_earlier(path, cx),
            CompareAction::Remove(name) => self.change_cases(CaseEdit::Remove(name), None),
            CompareAction::Set(key, value) => {
                let mut recipe = Recipe::clone(self.tried_recipe(cx.session));
                let set = Parameter::of_key(key).map(|parameter| parameter.set(&mut recipe, value));
                match set {
                    Some(Err(error)) => cx.notify(UserError::of(&error)),
                    Some(Ok(())) | None => self.change_recipe(recipe, cx),
                }
            }
            CompareAction::Reset(key) => {
                let mut recipe = Recipe::clone(self.tried_recipe(cx.session));
                if let Some(parameter) = Parameter::of_key(key) {
                    parameter.copy(&Recipe::default(), &mut recipe);
                }
                self.change_recipe(recipe, cx);
            }
            CompareAction::ResetAll => {
                let expect = self.tried_recipe(cx.session).expect.clone();
                let recipe = Recipe {
                    expect,
                    ..Recipe::default()
                };
                self.change_recipe(recipe, cx);
            }
            CompareAction::Recipe(action) => self.apply_to_recipes(action, cx),
            // The next job waits until the session has the other recipe.
            CompareAction::Use => return self.use_recipe(cx),
            CompareAction::Undo => return self.undo_or_redo(UndoDirection::Undo, cx),
            CompareAction::Redo => return self.undo_or_redo(UndoDirection::Redo, cx),
        }
        self.start_next(cx);
    }

    /// Takes in the results of tasks and the file dialog.
    pub fn update(&mut self, cx: &mut ShellContext<'_>) {
        while let Some(event) = self.task.poll() {
            match event {
                Ok(result) => self.receive(result, cx),
                Err(error) => {
                    cx.notify(error);
                    if self.job == Some(JobKind::Study) {
                        // It is of another case or recipe.
                        self.study = None;
                    }
                    self.compare_run_with_cases();
                }
            }
            self.start_next(cx);
        }
        if let Some((file, path)) = cx.chosen(&mut self.dialog) {
            let action = match file {
                CompareFile::Cases => CompareAction::Folder(path),
                CompareFile::EarlierRun => CompareAction::Earlier(path),
                CompareFile::ImportRecipe => CompareAction::Recipe(RecipeAction::Import(path)),
                CompareFile::ExportRecipe => CompareAction::Recipe(RecipeAction::Export(path)),
            };
            self.apply(action, cx);
        }
        if let Some(cases) = &self.cases {
            self.watch.watch(cases.folder.path());
        }
        if self.watch.has_changed() {
            self.is_listed = false;
        }
        self.update_recipes(cx);
    }

    fn receive(&mut self, result: CompareResult, cx: &mut ShellContext<'_>) {
        match result {
            CompareResult::Studied(study) => {
                if self.truth.is_none() {
                    self.truth.clone_from(&study.truth);
                }
                self.study = Some(study);
                self.is_current = true;
            }
            CompareResult::Ran(run) => {
                // Every run lists the cases anew.
                let known = self.cases.as_ref().map(|cases| &cases.list);
                if known.is_none_or(|known| !Arc::ptr_eq(known, &run.cases.list)) {
                    self.take_cases(run.cases.clone(), cx);
                }
                if run.ended.is_some() {
                    for problem in run.problems.clone() {
                        cx.notify(problem);
                    }
                }
                self.run = Some(run);
                self.compare_run_with_cases();
            }
            CompareResult::Scaled(scaling) => self.scaling = Some(scaling),
            CompareResult::Changed(changes) => {
                self.cell = None;
                self.changes = Some(changes);
            }
            CompareResult::Cases {
                cases,
                problem,
                done,
                way,
            } => {
                if let Some(problem) = problem {
                    cx.notify(problem);
                }
                self.take_done(done, &cases.folder, way, cx);
                self.take_cases(cases, cx);
                self.compare_run_with_cases();
            }
        }
    }

    /// Takes over a new list of the kept cases, also for the case in front; reports the problems that it did not have
    /// before.
    fn take_cases(&mut self, cases: Cases, cx: &mut ShellContext<'_>) {
        let before = self.cases.take();
        let known = before.as_ref().map_or(&[][..], |before| &*before.problems);
        for problem in cases.problems.iter().filter(|&new| !known.contains(new)) {
            cx.notify(problem.clone());
        }
        if !cases.list.is_empty() && before.is_none_or(|before| before.list.is_empty()) {
            cx.send(Action::Retract(no_cases()));
        }
        if let Front::Kept(front) = &self.front {
            let mut all = cases.list.iter();
            match all.find(|case| case.name == front.name) {
                None => {
                    cx.notify(Notice::look(
                        text!("compare-front-gone", name = &front.name),
                        text!("compare-front-gone-advice"),
                    ));
                    self.front_scene();
                }
                Some(now) if *now != **front => {
                    self.truth = Some(now.meta.about.truth.clone());
                    self.front = Front::Kept(Box::new(now.clone()));
                    self.due = self.due.max(StudyNeed::WhenFree);
                }
                Some(_) => {}
            }
        }
        self.cases = Some(cases);
    }

    /// Finds out whether the run that has ended, or was stopped, is about the cases kept now.
    pub(super) fn compare_run_with_cases(&mut self) {
        let is_running = self.is_running_cases();
        let both = self.run.as_ref().zip(self.cases.as_ref());
        let differing = both.filter(|(run, cases)| !is_running && run.cases.list != cases.list);
        self.num_covered = differing.map(|(run, cases)| {
            let ran = run.cases.list.iter().map(|case| (case.name.as_str(), case));
            let ran: HashMap<&str, &KeptCase> = ran.collect();
            let is_covered = |case: &&KeptCase| ran.get(case.name.as_str()) == Some(case);
            cases.list.iter().filter(is_covered).count()
        });
    }

    fn take_done(
        &mut self,
        done: CaseDone,
        folder: &CaseFolder,
        way: Option<UndoDirection>,
        cx: &mut ShellContext<'_>,
    ) {
        let (what, inverse) = match done {
            CaseDone::Listed => return,
            CaseDone::Kept(case) => {
                self.remark.clear();
                let what = text!("compare-kept-as", name = &case.name);
                (what, CaseEdit::Remove(case.name))
            }
            CaseDone::Removed { name, trash } => {
                if matches!(&self.front, Front::Kept(case) if case.name == name) {
                    self.front_scene();
                }
                let what = text!("compare-removed-case", name = &name);
                (what, CaseEdit::Restore { name, from: trash })
            }
            CaseDone::Restored(name) => {
                let what = text!("compare-restored-case", name = &name);
                (what, CaseEdit::Remove(name))
            }
            CaseDone::TruthSet { name, before } => {
                let what = text!("compare-truth-saved", name = &name);
                let truth = before;
                (what, CaseEdit::SetTruth { name, truth })
            }
        };
        self.say(what, cx);
        let inverse = Undo::Cases(folder.clone(), inverse);
        self.undo.add_inverse(way, inverse);
    }

    /// Shows a notice of something done, in place of the one before.
    pub(super) fn say(&mut self, what: String, cx: &mut ShellContext<'_>) {
        let notice = Notice::done(what);
        if let Some(before) = self.last_notice.replace(notice.clone()) {
            cx.send(Action::Retract(before));
        }
        cx.notify(notice);
    }

    /// Brings the scene that was inspected last to the front.
    fn front_scene(&mut self) {
        self.front = Front::Scene;
        self.forget();
        self.due = self.due.max(StudyNeed::WhenFree);
    }

    /// Clears what was chosen for the case before.
    fn forget(&mut self) {
        self.truth = None;
        self.against = None;
        self.remark.clear();
    }

    fn follow(&mut self, cx: &mut ShellContext<'_>) {
        if self.has_to_list() {
            self.is_listed = true;
            self.change_cases(CaseEdit::List, None);
        }
        if self.has_new_scene(cx.session) {
            let scene_of = |shown: &Option<Shown>| {
                let shown = shown.as_ref();
                shown.map(|shown| Arc::clone(&shown.inspected.scene))
            };
            let (before, now) = (scene_of(&self.followed), scene_of(&cx.session.shown));
            let is_other = before
                .zip(now)
                .is_none_or(|(before, now)| !Arc::ptr_eq(&before, &now));
            self.followed.clone_from(&cx.session.shown);
            if is_other {
                // A person wants to see what was captured or opened now.
                self.front_scene();
                cx.send(Action::RemoveNotices(NoticeTopic::Case));
            }
            self.due = self.due.max(StudyNeed::WhenFree);
        }
    }

    fn set_truth(&mut self, truth: Truth) {
        match &self.front {
            Front::Scene => {
                self.truth = Some(truth);
                self.due = StudyNeed::WhenFree;
            }
            Front::Kept(case) if case.meta.about.truth == truth => {}
            Front::Kept(case) => {
                let name = case.name.clone();
                self.change_cases(CaseEdit::SetTruth { name, truth }, None);
            }
        }
    }

    pub(super) fn use_folder(&mut self, path: PathBuf) {
        self.folder = Some(path);
        self.cases = None;
        self.run = None;
        self.cell = None;
        self.changes = None;
        if matches!(self.front, Front::Kept(_)) {
            self.front_scene();
        }
        self.change_cases(CaseEdit::List, None);
    }

    fn open_case(&mut self, name: &str, cx: &mut ShellContext<'_>) {
        let cases = self.cases.as_ref();
        let case = cases.and_then(|cases| cases.list.iter().find(|case| case.name == name));
        let Some(case) = case.cloned() else {
            return cx.notify(Notice::look(
                text!("compare-case-gone", name = name),
                text!("compare-case-gone-advice"),
            ));
        };
        self.forget();
        cx.send(Action::RemoveNotices(NoticeTopic::Case));
        self.truth = Some(case.meta.about.truth.clone());
        self.front = Front::Kept(Box::new(case));
        self.due = StudyNeed::Now;
    }
}

impl CompareState {
    /// Keeps the scene in front, or says why not.
    pub(super) fn keep(&mut self, cx: &mut ShellContext<'_>) {
        let look =
            |what: String, advice: String| Notice::look(what, advice).about(NoticeTopic::Case);
        let study = self.study.as_ref().filter(|_| !self.is_study_old());
        let Some(study) = study else {
            return cx.notify(look(
                text!("compare-nothing-to-keep"),
                text!("compare-nothing-to-keep-advice"),
            ));
        };
        let Some(inspected) = &study.inspected else {
            return cx.notify(look(
                text!("compare-kept-already"),
                text!("compare-kept-already-advice"),
            ));
        };
        let Some(truth) = self.truth.clone() else {
            return cx.notify(look(
                text!("compare-no-truth"),
                text!("compare-keep-case-first"),
            ));
        };
        cx.send(Action::RemoveNotices(NoticeTopic::Case));
        let about = CaseDescription {
            kept_at: geometry::clock::now(),
            remark: self.remark.trim().to_owned(),
            // Found by the recipe on trial, which may not be that of the inspection.
            found: study.found.clone(),
            ..CaseDescription::of(&inspected.entry.record, truth)
        };
        let change = CaseEdit::Keep {
            inspected: Arc::clone(inspected),
            about: Box::new(about),
        };
        self.change_cases(change, None);
    }
}

/// Labels the part in the history, then keeps the scene of this inspection as a case, also where the part has no row there
/// or the history cannot be written. Without a remark of its own the case gets that of the row.
pub(super) fn keep_case(
    folder: &CaseFolder,
    inspected: &Inspected,
    mut about: CaseDescription,
    history: &HistoryBuffer,
) -> Result<(KeptCase, Option<HistoryError>), CaseError> {
    let labelled = history.label_part(inspected.hung(), &about.truth, &about.remark);
    let (row, problem) = match labelled {
        Ok(row) => (row, None),
        Err(error) => (None, Some(error)),
    };
    if let Some(row) = row.filter(|_| about.remark.is_empty()) {
        about.remark = row.remark;
    }
    let kept = folder.keep(&inspected.scene, about)?;
    Ok((kept, problem))
}

#[cfg(test)]
mod tests;
