//! What the workspace's threads do: prepare a part, and change the library.

use std::sync::Arc;

use jiff::Timestamp;

use super::{
    change::{Changed, LibraryChange, change},
    selection::{Corrections, Selection},
    subject::{EnrolInput, EnrolInputKind, InitialSelection},
};
use crate::{
    app::{
        camera::CameraError,
        job::{TaskOutcome, TaskResult, Trouble, not_fused},
        lane::TaskQueue,
        shelf::LibraryCache,
        shots::{ScanRequest, Steps, Then, fuse},
        source::{SceneError, SceneSource},
        worker::JobContext,
    },
    library::{
        EnrolError, EnrolParams, Enrolled, PartDescription, PartName, Similarity, enrol_mesh,
        enrol_scan, enrol_selected, enrol_whole, likenesses,
    },
    pipeline::Recipe,
    stages::segment::SegmentedPart,
};

/// What the workspace asks for.
#[derive(Clone, Debug)]
pub enum EnrolRequest {
    /// Get something to enrol, and see what of it is the part.
    Take {
        /// From where.
        source: SceneSource,
        /// All parameters.
        recipe: Arc<Recipe>,
    },
    /// Put the shots of a scan together, and see what of it is the part.
    TakeScan(ScanRequest),
    /// Go through the corrections, and see what would be stored.
    Select {
        /// Of what.
        subject: Arc<EnrolInput>,
        /// All of them.
        corrections: Corrections,
        /// All parameters.
        recipe: Arc<Recipe>,
    },
    /// Change the library.
    Change(LibraryChange),
}

impl EnrolRequest {
    /// Whose work it is: a change of the library is never given up for a newer correction.
    pub fn lane(&self) -> TaskQueue {
        match self {
            Self::Take { .. } | Self::TakeScan(_) | Self::Select { .. } => TaskQueue::Enrol,
            Self::Change(_) => TaskQueue::Library,
        }
    }
}

/// What comes back.
#[derive(Clone, Debug)]
pub enum EnrolAnswer {
    /// Something to enrol, and what of it is kept. What would be stored follows.
    Taken(Arc<EnrolInput>, Arc<Selection>),
    /// What is kept after the corrections. What would be stored follows.
    Selected(Arc<Selection>),
    /// What would be stored, or why nothing can be.
    Checked(Result<Arc<Checked>, Trouble>),
    /// The library was changed.
    Changed(Box<Changed>),
}

/// What would be stored.
#[derive(Debug)]
pub struct Checked {
    /// The part, but for its name.
    pub enrolled: Arc<Enrolled>,
    /// What is odd about it.
    pub warnings: Vec<Trouble>,
    /// How like every enrolled part it is, the one that it is hardest to tell from first.
    pub likenesses: Vec<Similarity>,
}

/// Does what is asked.
pub(in crate::app) fn answer(
    request: EnrolRequest,
    shelf: &LibraryCache,
    desk: &dyn JobContext<TaskOutcome>,
) -> Option<TaskOutcome> {
    let said = |answer| Some(Ok(TaskResult::Enrol(answer)));
    match request {
        EnrolRequest::Take { source, recipe } => {
            let params = params_of(&recipe);
            let subject =
                match EnrolInput::read(&source, &params, shelf.camera(), &|| desk.is_cancelled()) {
                    Ok(Ok(subject)) => subject,
                    Ok(Err(error)) => return Some(Err(Trouble::of(&error))),
                    Err(SceneError::Camera(CameraError::Cancelled)) => return None,
                    Err(error) => return Some(Err(Trouble::of(&error))),
                };
            said(take(subject, &params, shelf, desk)?)
        }
        EnrolRequest::TakeScan(request) => {
            let report = |done, total| desk.progress(done, total);
            let fused = match fuse(&request, Then::Enrol, &Steps::new(desk, &report)) {
                Ok(fused) => Arc::new(fused?),
                Err(error) => return Some(not_fused(&error, &request)),
            };
            let params = params_of(&request.recipe);
            said(take(EnrolInput::of_scan(fused), &params, shelf, desk)?)
        }
        EnrolRequest::Select {
            subject,
            corrections,
            recipe,
        } => {
            let params = params_of(&recipe);
            let selection = Arc::new(Selection::of(&subject, &corrections));
            if desk.is_cancelled() {
                return None;
            }
            let selected = EnrolAnswer::Selected(Arc::clone(&selection));
            desk.publish_partial(Ok(TaskResult::Enrol(selected)));
            said(check(
                &subject,
                &corrections,
                &selection,
                &params,
                shelf,
                desk,
            )?)
        }
        EnrolRequest::Change(asked) => Some(
            change(&asked, shelf)
                .map(|done| TaskResult::Enrol(EnrolAnswer::Changed(Box::new(done)))),
        ),
    }
}

/// Hands over what there is to enrol, then looks at what would be stored; `None` when cancelled.
fn take(
    subject: EnrolInput,
    params: &EnrolParams,
    shelf: &LibraryCache,
    desk: &dyn JobContext<TaskOutcome>,
) -> Option<EnrolAnswer> {
    let subject = Arc::new(subject);
    let corrections = Corrections::none(subject.usual);
    let selection = Arc::new(Selection::of(&subject, &corrections));
    if desk.is_cancelled() {
        return None;
    }
    let taken = EnrolAnswer::Taken(Arc::clone(&subject), Arc::clone(&selection));
    desk.publish_partial(Ok(TaskResult::Enrol(taken)));
    check(&subject, &corrections, &selection, params, shelf, desk)
}

/// Segments as scenes are inspected; all else as usual.
fn params_of(recipe: &Recipe) -> EnrolParams {
    EnrolParams {
        segment: recipe.segment.clone(),
        ..EnrolParams::default()
    }
}

/// Makes the part and holds it against every enrolled one; `None` when cancelled.
fn check(
    subject: &EnrolInput,
    corrections: &Corrections,
    selection: &Selection,
    params: &EnrolParams,
    shelf: &LibraryCache,
    desk: &dyn JobContext<TaskOutcome>,
) -> Option<EnrolAnswer> {
    let mut enrolled = match enrol(subject, corrections.taking, selection, params) {
        Ok(enrolled) => enrolled,
        Err(error) => return Some(EnrolAnswer::Checked(Err(Trouble::of(&error)))),
    };
    if desk.is_cancelled() {
        return None;
    }
    // It has no name yet: none of the enrolled ones is left out for bearing the same.
    enrolled.reference.name.clear();
    let shelved = match shelf.get() {
        Ok(shelved) => shelved,
        Err(error) => return Some(EnrolAnswer::Checked(Err(Trouble::of(&error)))),
    };
    let coverage = enrolled.part.meta.coverage;
    let likenesses = likenesses(&enrolled.reference, coverage, &shelved.library);
    Some(EnrolAnswer::Checked(Ok(Arc::new(Checked {
        warnings: enrolled.warnings.iter().map(Trouble::of).collect(),
        enrolled: Arc::new(enrolled),
        likenesses,
    }))))
}

fn enrol(
    subject: &EnrolInput,
    taking: InitialSelection,
    selection: &Selection,
    params: &EnrolParams,
) -> Result<Enrolled, EnrolError> {
    let now = Timestamp::now();
    let about = PartDescription {
        name: PartName::new("part").expect("a name"),
        title: String::new(),
        notes: String::new(),
        from: match subject.scan() {
            Some(fused) => fused.choice.set.files.title(),
            None => subject.origin.title(),
        },
        // Whole seconds are enough for people.
        at: Timestamp::from_second(now.as_second()).unwrap_or(now),
        simulated: subject.origin.is_simulated(),
    };
    match (&subject.matter, taking) {
        (EnrolInputKind::Mesh(mesh, _), _) => enrol_mesh(mesh, &about, params),
        (EnrolInputKind::Scan(scan), _) => {
            enrol_scan(&scan.with_part(&selection.indices), &about, params)
        }
        (EnrolInputKind::Scene(scene), InitialSelection::Segmented) => {
            enrol_selected(scene, &selection.indices, &about, params)
        }
        (EnrolInputKind::Scene(scene), InitialSelection::Whole) => {
            let kept = SegmentedPart::selected(scene, &selection.indices, &params.segment);
            enrol_whole(&kept.cloud, &about, params)
        }
    }
}
