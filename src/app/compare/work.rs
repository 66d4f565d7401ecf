//! What the workspace's thread does: studies a case, keeps cases, and runs all of them.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use jiff::Timestamp;

use super::{
    matrix::Matrix,
    study::{Study, StudyRequest, study},
};
use crate::{
    app::{
        job::{Answer, Outcome, Trouble},
        shelf::Shelf,
        worker::Desk,
    },
    bench::scaling::{Scaling, ScalingError, ScalingRow, scaling, sizes},
    cases::{
        Calibration, CaseAbout, CaseError, CaseFolder, CaseJudge, CaseResult, Changes, Confusion,
        EarlierRun, KeptCase, RecordError, TradeOff,
    },
    pipeline::Recipe,
    stages::{rank::Matcher, scene::SceneCloud},
};

/// What the workspace asks for.
#[derive(Clone, Debug)]
pub enum CompareRequest {
    /// Inspect a case with the recipe on trial and compare it.
    Study(Box<StudyRequest>),
    /// Change the kept cases, and list them.
    Cases {
        /// The folder; without one the user's own.
        folder: Option<PathBuf>,
        /// What to do first.
        change: CaseChange,
    },
    /// Run all kept cases.
    Run {
        /// The folder.
        folder: CaseFolder,
        /// The recipe on trial.
        recipe: Arc<Recipe>,
    },
    /// Measure from how many references on several workers pay.
    Scaling,
    /// Hold a run against an earlier one.
    Earlier {
        /// What that one has written.
        path: PathBuf,
        /// The run.
        run: Arc<CaseRun>,
    },
}

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
        about: Box<CaseAbout>,
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

/// What comes back.
#[derive(Clone, Debug)]
pub enum CompareAnswer {
    /// A case under the glass.
    Studied(Arc<Study>),
    /// The kept cases.
    Cases {
        /// Their folder.
        folder: CaseFolder,
        /// The cases.
        cases: Arc<[KeptCase]>,
        /// What had to be set aside.
        troubles: Vec<Trouble>,
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
    /// The folder.
    pub folder: CaseFolder,
    /// The recipe.
    pub recipe: Arc<Recipe>,
    /// One result per case that could be read.
    pub results: Vec<CaseResult>,
    /// Those that could not.
    pub troubles: Vec<Trouble>,
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
pub(in crate::app) fn answer(
    request: CompareRequest,
    shelf: &Shelf,
    desk: &dyn Desk<Outcome>,
) -> Option<Outcome> {
    match request {
        CompareRequest::Study(request) => {
            let studied = study(&request, shelf, desk)?;
            Some(studied.map(|study| Answer::Compare(CompareAnswer::Studied(Arc::new(study)))))
        }
        CompareRequest::Cases { folder, change } => {
            let changed = cases(folder.as_deref(), change);
            Some(changed.map(Answer::Compare).map_err(|e| Trouble::of(&e)))
        }
        CompareRequest::Run { folder, recipe } => run(&folder, &recipe, shelf, desk),
        CompareRequest::Scaling => measure_scaling(desk),
        CompareRequest::Earlier { path, run } => {
            let changed =
                changes(&path, &run).map(|changes| CompareAnswer::Changed(Arc::new(changes)));
            Some(changed.map(Answer::Compare).map_err(|e| Trouble::of(&e)))
        }
    }
}

/// References at most: with their images below half a gigabyte.
const MOST_REFERENCES: usize = 2048;

fn measure_scaling(desk: &dyn Desk<Outcome>) -> Option<Outcome> {
    let total = sizes(MOST_REFERENCES).len();
    let mut done = 0;
    desk.progress(done, total);
    let mut after_row = |_: &ScalingRow| {
        done += 1;
        desk.progress(done, total);
    };
    match scaling(Matcher::Default, MOST_REFERENCES, desk, &mut after_row) {
        Ok(scaling) => {
            let answer = CompareAnswer::Scaled(Arc::new(scaling));
            Some(Ok(Answer::Compare(answer)))
        }
        Err(ScalingError::Cancelled(_)) => None,
        Err(error) => Some(Err(Trouble::of(&error))),
    }
}

fn changes(path: &Path, run: &CaseRun) -> Result<RunChanges, RecordError> {
    let earlier = EarlierRun::read(path)?;
    let file = path.file_name().unwrap_or(path.as_os_str());
    Ok(RunChanges {
        file: file.to_string_lossy().into_owned(),
        changes: Changes::between(&earlier, &run.results),
    })
}

fn cases(folder: Option<&Path>, change: CaseChange) -> Result<CompareAnswer, CaseError> {
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
    Ok(CompareAnswer::Cases {
        folder,
        cases: list.cases.into(),
        troubles: list.problems.iter().map(Trouble::of).collect(),
        done,
    })
}

fn run(
    folder: &CaseFolder,
    recipe: &Arc<Recipe>,
    shelf: &Shelf,
    desk: &dyn Desk<Outcome>,
) -> Option<Outcome> {
    let shelved = match shelf.get() {
        Ok(shelved) => shelved,
        Err(error) => return Some(Err(Trouble::of(&error))),
    };
    let list = match folder.list() {
        Ok(list) => list,
        Err(error) => return Some(Err(Trouble::of(&error))),
    };
    let library = shelved.fitting(recipe, desk)?;
    let order = library.references.iter().map(|r| r.name.clone());
    let order: Vec<String> = order.collect();
    let total = list.cases.len();
    let judge = CaseJudge::new(&library, recipe);
    let (mut results, mut troubles) = (Vec::new(), Vec::new());
    let so_far = |results: &[CaseResult], troubles: &[Trouble], ended| {
        let confusion = Confusion::of(results, &order);
        Arc::new(CaseRun {
            folder: folder.clone(),
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
        if desk.is_cancelled() {
            return None;
        }
        desk.progress(done, total);
        match folder.read_scene(case) {
            Ok(scene) => results.push(judge.judge(case, &scene, desk).ok()?),
            Err(error) => troubles.push(Trouble::of(&error)),
        }
        let run = so_far(&results, &troubles, None);
        desk.partly(Ok(Answer::Compare(CompareAnswer::Ran(run))));
    }
    let run = so_far(&results, &troubles, Some(Timestamp::now()));
    Some(Ok(Answer::Compare(CompareAnswer::Ran(run))))
}
