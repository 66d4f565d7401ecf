//! What the workspace's thread does: studies a case, keeps cases, and runs all of them.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use jiff::Timestamp;

use super::{matrix::Matrix, schedule::Job, study::CaseStudy};
use crate::{
    app::{
        inspection::library_cache::LibraryCache,
        task::{TaskContext, TaskError},
        user_error::UserError,
    },
    bench::scaling::{Scaling, ScalingError, ScalingRow, scaling, sizes},
    cases::{
        Calibration, CaseDescription, CaseError, CaseFolder, CaseJudge, CaseResult, Changes,
        Confusion, EarlierRun, KeptCase, RecordError, TradeOff,
    },
    files::file_name,
    pipeline::NamedRecipe,
    stages::{rank::Matcher, scene::SceneCloud},
};

/// What is done with the kept cases.
#[derive(Clone, Debug)]
pub enum CaseChange {
    /// Nothing: only list them.
    List,
    /// Keep a case.
    Keep {
        /// Its scene.
        scene: Arc<SceneCloud>,
        /// What is said of it.
        about: Box<CaseDescription>,
    },
    /// Remove the case of this name.
    Remove(String),
    /// Put a removed case back.
    Restore {
        /// Its name.
        name: String,
        /// Where it lies in the trash.
        from: PathBuf,
    },
}

/// What was done with the kept cases.
#[derive(Clone, Debug)]
pub enum CaseDone {
    /// They were listed.
    Listed,
    /// This one was kept.
    Kept(Box<KeptCase>),
    /// One was removed.
    Removed {
        /// Its name.
        name: String,
        /// Where it lies now.
        trash: PathBuf,
    },
    /// One was put back.
    Restored(String),
}

/// What the task hands over.
#[derive(Clone, Debug)]
pub enum CompareResult {
    /// A case under the glass.
    Studied(Arc<CaseStudy>),
    /// The kept cases.
    Cases {
        /// Their folder.
        folder: CaseFolder,
        /// The cases.
        cases: Arc<[KeptCase]>,
        /// What had to be set aside.
        troubles: Vec<UserError>,
        /// What was done before.
        done: CaseDone,
    },
    /// What came out of the kept cases so far.
    Ran(Arc<CaseRun>),
    /// What ranking takes by several workers.
    Scaled(Arc<Scaling>),
    /// What changed since an earlier run.
    Changed(Arc<RunChanges>),
}

/// What changed since an earlier run.
#[derive(Debug)]
pub struct RunChanges {
    /// The earlier run's file name.
    pub file: String,
    /// The changes.
    pub changes: Changes,
}

/// What came out of all kept cases.
#[derive(Debug)]
pub struct CaseRun {
    /// The recipe.
    pub recipe: Arc<NamedRecipe>,
    /// One result per case that could be read.
    pub results: Vec<CaseResult>,
    /// Those that could not.
    pub troubles: Vec<UserError>,
    /// Cases there are.
    pub total: usize,
    /// The matrix.
    pub matrix: Matrix,
    /// Scores against shares of right guesses.
    pub calibration: Calibration,
    /// What a threshold on the score costs.
    pub trade_off: TradeOff,
    /// When the run ended; `None` while it goes on.
    pub ended: Option<Timestamp>,
}

/// Does what is asked.
pub(super) fn run(
    job: Job,
    library_cache: &LibraryCache,
    context: &TaskContext<CompareResult>,
) -> Result<CompareResult, TaskError> {
    Ok(match job {
        Job::Cases { folder, change } => {
            cases(folder.as_deref(), change).map_err(|error| UserError::of(&error))?
        }
        Job::Run { folder, recipe } => run_cases(&folder, &recipe, library_cache, context)?,
        Job::Scaling => measure_scaling(context)?,
        Job::Earlier { path, run } => {
            let changes = changes(&path, &run).map_err(|error| UserError::of(&error))?;
            CompareResult::Changed(Arc::new(changes))
        }
    })
}

/// References at most: with their images below half a gigabyte.
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

fn cases(folder: Option<&Path>, change: CaseChange) -> Result<CompareResult, CaseError> {
    let folder = folder.map_or_else(CaseFolder::of_user, |path| Ok(CaseFolder::at(path)))?;
    let done = match change {
        CaseChange::List => CaseDone::Listed,
        CaseChange::Keep { scene, about } => CaseDone::Kept(Box::new(folder.keep(&scene, *about)?)),
        CaseChange::Remove(name) => {
            let trash = folder.remove(&name)?;
            CaseDone::Removed { name, trash }
        }
        CaseChange::Restore { name, from } => {
            folder.restore(&name, &from)?;
            CaseDone::Restored(name)
        }
    };
    let list = folder.list()?;
    Ok(CompareResult::Cases {
        folder,
        cases: list.cases.into(),
        troubles: list.problems.iter().map(UserError::of).collect(),
        done,
    })
}

fn run_cases(
    folder: &CaseFolder,
    recipe: &Arc<NamedRecipe>,
    library_cache: &LibraryCache,
    context: &TaskContext<CompareResult>,
) -> Result<CompareResult, TaskError> {
    let shelved = library_cache.get();
    let list = folder.list().map_err(|error| UserError::of(&error))?;
    let library = shelved.fitting(recipe, context);
    let library = library.ok_or(TaskError::Cancelled)?;
    let order = library.references.iter().map(|r| r.name.clone());
    let order: Vec<String> = order.collect();
    let total = list.cases.len();
    let judge = CaseJudge::new(&library, recipe);
    let (mut results, mut troubles) = (Vec::new(), Vec::new());
    let so_far = |results: &[CaseResult], troubles: &[UserError], ended| {
        let confusion = Confusion::of(results, &order);
        Arc::new(CaseRun {
            recipe: Arc::clone(recipe),
            matrix: Matrix::of(confusion, &shelved.shown),
            calibration: Calibration::of(results),
            trade_off: TradeOff::of(results),
            results: results.to_vec(),
            troubles: troubles.to_vec(),
            total,
            ended,
        })
    };
    for (done, case) in list.cases.iter().enumerate() {
        context.check()?;
        context.progress(done, total);
        match folder.read_scene(case) {
            Ok(scene) => results.push(judge.judge(case, &scene, context)?),
            Err(error) => troubles.push(UserError::of(&error)),
        }
        let run = so_far(&results, &troubles, None);
        context.partial(CompareResult::Ran(run));
    }
    let run = so_far(&results, &troubles, Some(Timestamp::now()));
    Ok(CompareResult::Ran(run))
}
