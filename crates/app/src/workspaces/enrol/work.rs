//! Jobs of the draft's task: get the input, and prepare the part.

use std::{path::Path, sync::Arc};

use jiff::Timestamp;

use super::{
    meshes::{ChosenMesh, MeshListing, MeshPicture},
    selection::{Corrections, Selection},
    subject::{EnrolInput, EnrolInputKind, InitialSelection},
};
use capture::CaptureError;
use files::{
    MeshFile, OpenedFile,
    import::{ImportOptions, LengthUnit},
};
use inspection::{
    library::{
        EnrolError, EnrolParams, Enrolled, PartDescription, PartName, Similarity, enrol_mesh,
        enrol_scan, enrol_selected, enrol_whole, likenesses,
    },
    pipeline::{ProgressObserver as _, Recipe},
};
use shell::inspection::{
    library_cache::LibraryCache,
    scan::{Steps, Then, fuse},
    source::{ScanOrder, ScanRequest, SceneError, SceneSource},
};
use stages::segment::SegmentedPart;
use ui::{
    language::what_and_advice,
    task::{TaskContext, TaskError},
    user_error::UserError,
};

/// A result, partial or final, of the task.
#[derive(Clone, Debug)]
pub enum DraftEvent {
    /// The meshes of a file, to choose from.
    Several(Arc<MeshListing>),
    /// A new input and its initial selection, and whether it was chosen among meshes; [`Checked`](Self::Checked) follows.
    Taken(Arc<EnrolInput>, Arc<Selection>, Option<ChosenMesh>),
    /// The selection after the corrections; [`Checked`](Self::Checked) follows.
    Selected(Arc<Selection>),
    /// The part that would be stored, or why none can be.
    Checked(Result<Arc<Checked>, EnrolError>),
    /// The poses of these shots were not found; a person has to name their file.
    PosesWanted(Box<ScanOrder>, UserError),
}

/// A part that would be stored.
#[derive(Debug)]
pub struct Checked {
    /// The part, without its name.
    pub enrolled: Arc<Enrolled>,
    /// Similarity to every enrolled part, the hardest to distinguish first.
    pub likenesses: Vec<Similarity>,
}

/// Opens a file to enrol: its meshes, if it has several, else a part.
pub(super) fn open_file(
    path: &Path,
    recipe: &Recipe,
    library_cache: &LibraryCache,
    context: &TaskContext<DraftEvent>,
) -> Result<DraftEvent, TaskError> {
    let opened = files::open_each(path).map_err(CaptureError::from);
    match opened.map_err(SceneError::from)? {
        OpenedFile::Several(file) => Ok(DraftEvent::Several(Arc::new(MeshListing::of(file)))),
        OpenedFile::One(content) => {
            let params = params_of(recipe);
            let read = EnrolInput::of_file(content, path, &params);
            take_read(read, None, &params, library_cache, context)
        }
    }
}

/// Gets a mesh that was chosen, and prepares the part.
pub(super) fn take_mesh(
    chosen: ChosenMesh,
    recipe: &Recipe,
    library_cache: &LibraryCache,
    context: &TaskContext<DraftEvent>,
) -> Result<DraftEvent, TaskError> {
    let source = SceneSource::File(chosen.path().to_owned());
    read_and_take(&source, Some(chosen), recipe, library_cache, context)
}

/// Draws the small pictures of meshes, read in this unit, and finds out which cannot be enrolled.
pub(super) fn draw_meshes(
    file: &MeshFile,
    unit: LengthUnit,
    wanted: &[usize],
    recipe: &Recipe,
    context: &TaskContext<MeshPicture>,
) -> Result<MeshPicture, TaskError> {
    let params = params_of(recipe);
    let units = ImportOptions {
        unit,
        ..ImportOptions::default()
    };
    let draw = |index: usize| {
        let named = file.meshes.get(index);
        let mesh = named.and_then(|named| named.mesh.as_ref().ok());
        let mut mesh = mesh.cloned().unwrap_or_default();
        units.convert(&mut mesh.vertices);
        let enrolled = enrol_mesh(&mesh, &described(String::new(), false), &params);
        let picture = enrolled.map(|enrolled| Arc::new(enrolled.part.thumbnail));
        MeshPicture { index, picture }
    };
    let Some((last, others)) = wanted.split_last() else {
        return Err(TaskError::Cancelled);
    };
    for index in others {
        context.check()?;
        context.partial(draw(*index));
    }
    context.check()?;
    Ok(draw(*last))
}

/// Gets a scene to enrol, and prepares the part.
pub(super) fn take_scene(
    source: &SceneSource,
    recipe: &Recipe,
    library_cache: &LibraryCache,
    context: &TaskContext<DraftEvent>,
) -> Result<DraftEvent, TaskError> {
    read_and_take(source, None, recipe, library_cache, context)
}

fn read_and_take(
    source: &SceneSource,
    chosen: Option<ChosenMesh>,
    recipe: &Recipe,
    library_cache: &LibraryCache,
    context: &TaskContext<DraftEvent>,
) -> Result<DraftEvent, TaskError> {
    let params = params_of(recipe);
    let is_cancelled = || context.is_cancelled();
    let read = EnrolInput::read(source, &params, library_cache.camera(), &is_cancelled)?;
    take_read(read, chosen, &params, library_cache, context)
}

fn take_read(
    read: Result<EnrolInput, EnrolError>,
    chosen: Option<ChosenMesh>,
    params: &EnrolParams,
    library_cache: &LibraryCache,
    context: &TaskContext<DraftEvent>,
) -> Result<DraftEvent, TaskError> {
    let subject = read.map_err(|error| UserError::from(what_and_advice(&error)))?;
    take(subject, chosen, params, library_cache, context)
}

/// Gets a scene that was taken before, read in the same way.
pub(super) fn take_again(
    source: SceneSource,
    usual: InitialSelection,
    recipe: &Recipe,
    library_cache: &LibraryCache,
    context: &TaskContext<DraftEvent>,
) -> Result<DraftEvent, TaskError> {
    let source = match (source, usual) {
        // Read the file as Inspect does; Enrol would take one without rows and columns as a part.
        (file @ SceneSource::File(_), InitialSelection::Segmented) => {
            let captured = file.take(library_cache.camera(), &|| context.is_cancelled())?;
            SceneSource::AtHand(captured.scene, captured.origin)
        }
        (source, _) => source,
    };
    take_scene(&source, recipe, library_cache, context)
}

/// Fuses the shots of a scan, and prepares the part.
pub(super) fn take_scan(
    request: &ScanRequest,
    library_cache: &LibraryCache,
    context: &TaskContext<DraftEvent>,
) -> Result<DraftEvent, TaskError> {
    let report = |done, total| context.progress(done, total);
    match fuse(request, Then::Enrol, &Steps::new(context, &report)) {
        Ok(Some(fused)) => {
            let subject = EnrolInput::of_scan(Arc::new(fused));
            let params = params_of(&request.recipe);
            take(subject, None, &params, library_cache, context)
        }
        Ok(None) => Err(TaskError::Cancelled),
        Err(error) if error.wants_poses() => {
            let order = Box::new(request.order.clone());
            Ok(DraftEvent::PosesWanted(order, UserError::of(&error)))
        }
        Err(error) => Err(UserError::of(&error).into()),
    }
}

/// Applies the corrections, and prepares the part.
pub(super) fn look(
    subject: &EnrolInput,
    corrections: &Corrections,
    recipe: &Recipe,
    library_cache: &LibraryCache,
    context: &TaskContext<DraftEvent>,
) -> Result<DraftEvent, TaskError> {
    let selection = Arc::new(Selection::of(subject, corrections));
    context.check()?;
    context.partial(DraftEvent::Selected(Arc::clone(&selection)));
    let params = params_of(recipe);
    check(
        subject,
        corrections,
        &selection,
        &params,
        library_cache,
        context,
    )
}

/// Hands over the input, then prepares the part.
fn take(
    subject: EnrolInput,
    chosen: Option<ChosenMesh>,
    params: &EnrolParams,
    library_cache: &LibraryCache,
    context: &TaskContext<DraftEvent>,
) -> Result<DraftEvent, TaskError> {
    let subject = Arc::new(subject);
    let corrections = Corrections::none(subject.usual);
    let selection = Arc::new(Selection::of(&subject, &corrections));
    context.check()?;
    let (input, selected) = (Arc::clone(&subject), Arc::clone(&selection));
    context.partial(DraftEvent::Taken(input, selected, chosen));
    check(
        &subject,
        &corrections,
        &selection,
        params,
        library_cache,
        context,
    )
}

/// Segmentation parameters from the recipe, the rest at their defaults.
fn params_of(recipe: &Recipe) -> EnrolParams {
    EnrolParams {
        segment: recipe.segment.clone(),
        ..EnrolParams::default()
    }
}

/// Makes the part and compares it with every enrolled one.
fn check(
    subject: &EnrolInput,
    corrections: &Corrections,
    selection: &Selection,
    params: &EnrolParams,
    library_cache: &LibraryCache,
    context: &TaskContext<DraftEvent>,
) -> Result<DraftEvent, TaskError> {
    let mut enrolled = match enrol(subject, corrections.taking, selection, params) {
        Ok(enrolled) => enrolled,
        Err(error) => return Ok(DraftEvent::Checked(Err(error))),
    };
    context.check()?;
    // Clear the placeholder name, so that no enrolled part is left out of the comparison for having the same.
    enrolled.reference.name.clear();
    let loaded = library_cache.get();
    let scene = subject.scene().map(AsRef::as_ref);
    let likenesses = likenesses(&enrolled, scene, &loaded.library);
    Ok(DraftEvent::Checked(Ok(Arc::new(Checked {
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
    let from = match subject.scan() {
        Some(fused) => fused.choice.set.files.title(),
        None => subject.origin.title(),
    };
    let about = described(from, subject.origin.is_simulated());
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

/// Describes a part that a person has not named yet.
fn described(from: String, simulated: bool) -> PartDescription {
    let now = geometry::clock::now();
    PartDescription {
        name: PartName::new("part").expect("a name"),
        title: String::new(),
        notes: String::new(),
        from,
        // Whole seconds suffice for people.
        at: Timestamp::from_second(now.as_second()).unwrap_or(now),
        simulated,
    }
}
