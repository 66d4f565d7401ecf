//! The jobs of the workspace's task: changing the kept cases, running all of them, measuring, comparing runs.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use jiff::Timestamp;

use super::{
    matrix::Matrix,
    scaling::{Scaling, ScalingError, ScalingRow, scaling, sizes},
    schedule::Job,
    state::Cases,
    study::CaseStudy,
};
use crate::workspaces::compare::state::keep_case;
use files::file_name;
use inspection::pipeline::NamedRecipe;
use records::{
    cases::{
        Calibration, CaseDescription, CaseError, CaseFolder, CaseJudge, CaseResult, Changes,
        Confusion, EarlierRun, KeptCase, RecordError, TradeOff, Truth,
    },
    history::{HistoryBuffer, HistoryError},
};
use shell::inspection::{inspected::Inspected, library_cache::LibraryCache};
use stages::rank::Matcher;
use ui::{
    language::text,
    task::{TaskContext, TaskError},
    undo_stack::UndoDirection,
    user_error::UserError,
};

/// A change of the kept cases.
#[derive(Clone, Debug)]
pub enum CaseEdit {
    /// None: only list them.
    List,
    /// Keep a case.
    Keep {
        /// The inspection of its scene.
        inspected: Arc<Inspected>,
        /// Its `case.toml`, but for the record of the scene.
        about: Box<CaseDescription>,
    },
    /// Remove the case of this name.
    Remove(String),
    /// Put a removed case back.
    Restore {
        /// Its name.
        name: String,
        /// Its path in the trash.
        from: PathBuf,
    },
    /// Change the truth of a case.
    SetTruth {
        /// Its name.
        name: String,
        /// Its new truth.
        truth: Truth,
    },
}

impl CaseEdit {
    pub(super) fn title(&self) -> String {
        match self {
            Self::List => text!("compare-listing-cases"),
            Self::Keep { .. } => text!("compare-keeping-case"),
            Self::Remove(_) => text!("compare-removing-case"),
            Self::Restore { .. } => text!("compare-restoring-case"),
            Self::SetTruth { .. } => text!("compare-saving-truth"),
        }
    }
}

/// A change that was made.
#[derive(Clone, Debug)]
pub enum CaseDone {
    /// The cases were listed.
    Listed,
    /// A case was kept.
    Kept(Box<KeptCase>),
    /// A case was removed.
    Removed {
        /// Its name.
        name: String,
        /// Its path in the trash.
        trash: PathBuf,
    },
    /// A removed case was put back.
    Restored(String),
    /// The truth of a case was changed.
    TruthSet {
        /// Its name.
        name: String,
        /// Its truth before.
        before: Truth,
    },
}

/// A result of the task.
#[derive(Clone, Debug)]
pub enum CompareResult {
    /// The study of the case in front.
    Studied(Arc<CaseStudy>),
    /// The kept cases.
    Cases {
        /// The cases and their folder.
        cases: Cases,
        /// A history that does not take the label.
        problem: Option<UserError>,
        /// The change before they were listed.
        done: CaseDone,
        /// The direction of a change that undoes or redoes another one.
        way: Option<UndoDirection>,
    },
    /// The run over all kept cases, so far.
    Ran(Arc<CaseRun>),
    /// Time of ranking with several workers.
    Scaled(Arc<Scaling>),
    /// Changes since an earlier run.
    Changed(Arc<RunChanges>),
}

/// Changes since an earlier run.
#[derive(Debug)]
pub struct RunChanges {
    /// The earlier run's file name.
    pub file: String,
    /// The change of each case.
    pub changes: Changes,
}

/// A run over all kept cases.
#[derive(Debug)]
pub struct CaseRun {
    /// The recipe.
    pub recipe: Arc<NamedRecipe>,
    /// One result per case that could be read.
    pub results: Vec<CaseResult>,
    /// The listed cases whose scenes could not be read.
    pub problems: Vec<UserError>,
    /// The cases in the folder.
    pub cases: Cases,
    /// Truth against answer.
    pub matrix: Matrix,
    /// Scores against the shares of right guesses.
    pub calibration: Calibration,
    /// False accepts and refusals at every threshold on the score.
    pub trade_off: TradeOff,
    /// When the run ended; `None` while it goes on.
    pub ended: Option<Timestamp>,
}

/// Runs a job.
pub(super) fn run(
    job: Job,
    library_cache: &LibraryCache,
    context: &TaskContext<CompareResult>,
) -> Result<CompareResult, TaskError> {
    Ok(match job {
        Job::Cases {
            folder,
            change,
            way,
        } => {
            let history = library_cache.history();
            let changed = change_cases(folder.as_deref(), change, history);
            let (cases, problem, done) = changed.map_err(|error| UserError::of(&error))?;
            CompareResult::Cases {
                cases,
                problem: problem.map(|error| UserError::of(&error)),
                done,
                way,
            }
        }
        Job::Run { folder, recipe } => run_cases(&folder, &recipe, library_cache, context)?,
        Job::Scaling => measure_scaling(context)?,
        Job::Earlier { path, run } => {
            let changes = changes(&path, &run).map_err(|error| UserError::of(&error))?;
            CompareResult::Changed(Arc::new(changes))
        }
    })
}

/// Limit of references: with their images, below half a gigabyte.
const MOST_REFERENCES: usize = 2048;

fn measure_scaling(context: &TaskContext<CompareResult>) -> Result<CompareResult, TaskError> {
    let total = sizes(MOST_REFERENCES).len();
    let mut done = 0;
    context.progress(done, total);
    let mut after_row = |_: &ScalingRow| {
        done += 1;
        context.progress(done, total);
    };
    match scaling(Matcher::Default, MOST_REFERENCES, context, &mut after_row) {
        Ok(scaling) => Ok(CompareResult::Scaled(Arc::new(scaling))),
        Err(ScalingError::Cancelled(_)) => Err(TaskError::Cancelled),
        Err(error) => Err(UserError::of(&error).into()),
    }
}

fn changes(path: &Path, run: &CaseRun) -> Result<RunChanges, RecordError> {
    let earlier = EarlierRun::read(path)?;
    Ok(RunChanges {
        file: file_name(path),
        changes: Changes::between(&earlier, &run.results),
    })
}

/// Changes the kept cases and lists them.
fn change_cases(
    folder: Option<&Path>,
    change: CaseEdit,
    history: &HistoryBuffer,
) -> Result<(Cases, Option<HistoryError>, CaseDone), CaseError> {
    let mut problem = None;
    let folder = folder.map_or_else(CaseFolder::of_user, |path| Ok(CaseFolder::at(path)))?;
    let done = match change {
        CaseEdit::List => CaseDone::Listed,
        CaseEdit::Keep { inspected, about } => {
            let (kept, error) = keep_case(&folder, &inspected, *about, history)?;
            problem = error;
            CaseDone::Kept(Box::new(kept))
        }
        CaseEdit::Remove(name) => {
            let trash = folder.remove(&name)?;
            CaseDone::Removed { name, trash }
        }
        CaseEdit::Restore { name, from } => {
            folder.restore(&name, &from)?;
            CaseDone::Restored(name)
        }
        CaseEdit::SetTruth { name, truth } => {
            let before = folder.set_truth(&name, truth)?;
            CaseDone::TruthSet { name, before }
        }
    };
    Ok((Cases::read(folder)?, problem, done))
}

fn run_cases(
    folder: &CaseFolder,
    recipe: &Arc<NamedRecipe>,
    library_cache: &LibraryCache,
    context: &TaskContext<CompareResult>,
) -> Result<CompareResult, TaskError> {
    let loaded = library_cache.get();
    let cases = Cases::read(folder.clone()).map_err(|error| UserError::of(&error))?;
    let library = loaded.fitting(recipe, context);
    let library = library.ok_or(TaskError::Cancelled)?;
    let order = library.references.iter().map(|r| r.name.clone());
    let order: Vec<String> = order.collect();
    let judge = CaseJudge::new(&library, recipe);
    let (mut results, mut problems) = (Vec::new(), Vec::new());
    let so_far = |results: &[CaseResult], problems: &[UserError], ended| {
        let confusion = Confusion::of(results, &order);
        Arc::new(CaseRun {
            recipe: Arc::clone(recipe),
            matrix: Matrix::of(confusion),
            calibration: Calibration::of(results),
            trade_off: TradeOff::of(results),
            results: results.to_vec(),
            problems: problems.to_vec(),
            cases: cases.clone(),
            ended,
        })
    };
    for (done, case) in cases.list.iter().enumerate() {
        context.check()?;
        context.progress(done, cases.list.len());
        match folder.read_scene(case) {
            Ok(scene) => results.push(judge.judge(case, &scene, context)?),
            Err(error) => problems.push(UserError::of(&error)),
        }
        let run = so_far(&results, &problems, None);
        context.partial(CompareResult::Ran(run));
    }
    let run = so_far(&results, &problems, Some(geometry::clock::now()));
    Ok(CompareResult::Ran(run))
}
