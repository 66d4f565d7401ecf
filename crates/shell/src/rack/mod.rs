//! Where parts may hang: the rack in use, and the window in which it is edited.

mod window;

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

pub use self::window::{box_numbers, window};
use crate::{
    action::Effect,
    inspection::inspected::Inspected,
    notice::Notice,
    session::Session,
    state::{State, notify},
};
use geometry::rigid::{RigidTransform, from_row_major, row_major};
use inspection::rack::{Rack, RackError, RackFile, RackProblem, may_be_taken};
use robot::RobotFrame;
use ui::{
    language::{described, text, what_and_advice},
    user_error::UserError,
};

/// Maximum number of steps that can be undone.
const MAX_UNDO: usize = 50;

/// The rack in use.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "KeptRack", into = "KeptRack")]
pub struct RackInUse {
    /// Its file; `None` if parts may hang anywhere.
    file: Option<RackFile>,
    /// Where the camera was when that was last known.
    base_from_camera: Option<RigidTransform>,
    /// Its boxes and places in camera space.
    in_camera: Rack,
}

/// The rack in use, as the settings keep it.
#[derive(Serialize, Deserialize)]
struct KeptRack {
    #[serde(default)]
    file: Option<RackFile>,
    /// Row by row.
    #[serde(default)]
    base_from_camera: Option<[f64; 16]>,
}

/// Tolerance of a kept transform: it was written by this program.
const KEPT_TOLERANCE: f64 = 1e-6;

impl TryFrom<KeptRack> for RackInUse {
    type Error = String;

    fn try_from(kept: KeptRack) -> Result<Self, String> {
        let read = |m: [f64; 16]| from_row_major(&m, KEPT_TOLERANCE).ok_or("no transform");
        let base_from_camera = kept.base_from_camera.map(read).transpose()?;
        let in_camera = kept.file.as_ref();
        let in_camera = in_camera.map(|file| file.in_camera(base_from_camera.as_ref()));
        let in_camera = in_camera.transpose().map_err(|error| error.to_string())?;
        Ok(Self {
            file: kept.file,
            base_from_camera,
            in_camera: in_camera.unwrap_or_default(),
        })
    }
}

impl From<RackInUse> for KeptRack {
    fn from(rack: RackInUse) -> Self {
        Self {
            file: rack.file,
            base_from_camera: rack.base_from_camera.as_ref().map(row_major),
        }
    }
}

impl RackInUse {
    /// The rack in camera space; empty without one.
    pub fn in_camera(&self) -> &Rack {
        &self.in_camera
    }

    /// Its name for the user.
    pub fn title(&self) -> String {
        match &self.file {
            None => text!("rack-none"),
            Some(file) if file.rack.name.is_empty() => text!("rack-unnamed"),
            Some(file) => file.rack.name.clone(),
        }
    }

    /// Puts it where the camera is now. While that is not known, the rack stays where it was.
    pub fn follow(&mut self, robot: Option<&RobotFrame>) {
        let moved = self.file.as_ref();
        let moved = moved.and_then(|file| file.in_camera(camera(robot)).ok());
        if let Some(moved) = moved {
            self.base_from_camera = camera(robot).copied();
            self.in_camera = moved;
        }
    }
}

fn camera(robot: Option<&RobotFrame>) -> Option<&RigidTransform> {
    robot.map(|robot| &robot.robot_from_camera)
}

impl Session {
    /// Uses this rack from now on; an empty one for none.
    fn use_rack(&mut self, file: RackFile) -> Result<(), RackError> {
        if file.rack.is_empty() {
            self.rack = RackInUse::default();
            return Ok(());
        }
        let in_camera = file.in_camera(camera(self.robot.as_deref()))?;
        self.rack = RackInUse {
            file: Some(file),
            base_from_camera: camera(self.robot.as_deref()).copied(),
            in_camera,
        };
        Ok(())
    }
}

/// The window in which the rack is edited.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RackEditor {
    /// The rack being edited; it is in use unless it has an error.
    draft: RackFile,
    /// Former drafts, the newest last.
    past: Vec<RackFile>,
    /// What is wrong.
    problem: Option<UserError>,
    /// True if nothing was inspected with the draft yet.
    is_new: bool,
    /// True while a number is being dragged: all its changes are undone at once.
    is_dragged: bool,
}

impl RackEditor {
    fn of(session: &Session) -> Self {
        Self {
            draft: session.rack.file.clone().unwrap_or_default(),
            ..Self::default()
        }
    }
}

/// A rack that was read, and its file.
pub type ReadRack = (PathBuf, Box<RackFile>);

/// An action on the rack.
#[derive(Clone, Debug)]
pub enum RackAction {
    /// Open or close the window.
    Toggle,
    /// Read this file, and use its rack.
    Open(PathBuf),
    /// Use the rack that was read, or say why it cannot be read.
    Opened(Result<ReadRack, UserError>),
    /// Write the rack in use to this file.
    Save(PathBuf),
    /// Say that it was written to this file, or why it was not.
    Saved(Result<PathBuf, UserError>),
    /// Change the rack to this one.
    Edit {
        /// The changed rack.
        file: Box<RackFile>,
        /// True if it continues the last change.
        continues: bool,
    },
    /// Inspect with the changed rack.
    Inspect,
    /// Make a place, or change the one of this name, from the part in front.
    TakePlace(String),
    /// Make a place of each part of the frame in front that has none.
    TakePlaces,
    /// Add a box around the part in front to the work volume.
    TakeVolume,
    /// Undo the last change.
    Undo,
}

/// Uses the rack whose file has been read by now, and says whether one was written.
pub fn update(state: &mut State) {
    if let Some(read) = state.rack_reading.poll() {
        apply(state, RackAction::Opened(read));
    }
    if let Some(saved) = state.rack_saving.poll() {
        apply(state, RackAction::Saved(saved));
    }
}

/// Carries out an action on the rack.
pub fn apply(state: &mut State, action: RackAction) -> Option<Effect> {
    if let RackAction::Toggle = action {
        if state.session.rack_editor.is_some() {
            close(state);
        } else {
            state.session.rack_editor = Some(RackEditor::of(&state.session));
            inspect_present(state);
        }
        return None;
    }
    if let RackAction::Open(path) = action {
        state.rack_reading.start(text!("rack-reading"), |_| {
            let file = RackFile::read(&path);
            let file = file.map_err(|error| UserError::from(what_and_advice(&error)))?;
            Ok((path, Box::new(file)))
        });
        return None;
    }
    if let RackAction::Saved(saved) = action {
        tell_saved(state, saved);
        return None;
    }
    // A file may be chosen after the window was closed.
    let open = state.session.rack_editor.clone();
    let mut editor = open.unwrap_or_else(|| RackEditor::of(&state.session));
    let robot = state.session.robot.clone();
    let changed = match action {
        RackAction::Toggle | RackAction::Open(_) | RackAction::Saved(_) => Ok(None),
        RackAction::Opened(read) => read.map(|(path, file)| {
            let title = path.display().to_string();
            notify(state, Notice::done(text!("rack-opened", path = title)));
            Some(*file)
        }),
        RackAction::Save(path) => {
            let file = editor.draft.clone();
            state.rack_saving.start(text!("rack-saving"), move |_| {
                let written = file.write(&path);
                written.map_err(|error| UserError::from(what_and_advice(&error)))?;
                Ok(path)
            });
            Ok(None)
        }
        RackAction::Edit { file, continues } => {
            let was_dragged = std::mem::replace(&mut editor.is_dragged, continues);
            if was_dragged && continues {
                editor.draft = *file;
                set(state, &mut editor);
                Ok(None)
            } else {
                Ok(Some(*file))
            }
        }
        RackAction::Inspect => {
            (editor.is_new, editor.is_dragged) = (false, false);
            inspect_present(state);
            Ok(None)
        }
        RackAction::TakePlace(name) => taken(state, &editor, |file, front| {
            let camera = camera(robot.as_deref());
            file.take_place(&name, &front.inspection, front.middle, camera)
        }),
        RackAction::TakePlaces => taken(state, &editor, |file, _| {
            let camera = camera(robot.as_deref());
            let mut is_changed = false;
            for part in parts_without_place(&state.session) {
                let name = file.new_place_name();
                is_changed |= file.take_place(&name, &part.inspection, part.middle, camera)?;
            }
            Ok(is_changed)
        }),
        RackAction::TakeVolume => taken(state, &editor, |file, front| {
            file.take_volume(&front.inspection, camera(robot.as_deref()))
        }),
        RackAction::Undo => {
            if let Some(file) = editor.past.pop() {
                editor.draft = file;
                set(state, &mut editor);
            }
            Ok(None)
        }
    };
    match changed {
        Ok(Some(file)) => {
            let before = std::mem::replace(&mut editor.draft, file);
            editor.past.push(before);
            let num_over = editor.past.len().saturating_sub(MAX_UNDO);
            editor.past.drain(..num_over);
            set(state, &mut editor);
        }
        Ok(None) => {}
        Err(error) => editor.problem = Some(error),
    }
    state.session.rack_editor = Some(editor);
    None
}

/// Says where the rack was written, or why it was not.
fn tell_saved(state: &mut State, saved: Result<PathBuf, UserError>) {
    match (saved, &mut state.session.rack_editor) {
        (Ok(path), _) => {
            let title = path.display().to_string();
            notify(state, Notice::done(text!("rack-saved", path = title)));
        }
        (Err(error), Some(editor)) => editor.problem = Some(error),
        (Err(error), None) => notify(state, error.into()),
    }
}

/// Closes the window of the rack, if it is open.
pub(crate) fn close(state: &mut State) {
    if state.session.rack_editor.take().is_some() {
        inspect_present(state);
    }
}

/// The parts of the frame in front of which a place can be made, and that have none.
fn parts_without_place(session: &Session) -> impl Iterator<Item = &Inspected> {
    let parts = session.shown.iter().flat_map(|shown| &shown.parts);
    let parts = parts.map(|part| &**part);
    parts.filter(|part| may_be_taken(&part.inspection) && part.inspection.place.is_none())
}

/// Inspects the frame in front again, unless it is from the history.
fn inspect_present(state: &mut State) {
    let shown = state.session.shown.as_ref();
    if state.session.is_live() || shown.is_some_and(|shown| !shown.is_past) {
        state.inspect_again();
    }
}

/// Uses the draft, unless something in it is wrong.
fn set(state: &mut State, editor: &mut RackEditor) {
    let checked = if editor.draft.rack.is_empty() {
        Ok(())
    } else {
        editor.draft.check()
    };
    let wrong = |problem: RackProblem| UserError {
        what: described(&problem),
        advice: text!("rack-not-used"),
    };
    let library = state.session.library.clone();
    let is_enrolled = |name: &str| {
        let parts = library.iter().flat_map(|library| &library.parts);
        let mut names = parts.flat_map(|part| [part.name.as_str(), part.part_name().as_str()]);
        library.is_none() || names.any(|other| other == name)
    };
    let used = checked.map_err(wrong).and_then(|()| {
        let known = editor.draft.check_parts(is_enrolled);
        let used = known.and_then(|()| state.session.use_rack(editor.draft.clone()));
        used.map_err(|error| what_and_advice(&error).into())
    });
    editor.is_new |= used.is_ok();
    editor.problem = used.err();
}

/// The draft changed by the part in front; `None` if there is no part.
fn taken(
    state: &State,
    editor: &RackEditor,
    take: impl FnOnce(&mut RackFile, &Inspected) -> Result<bool, RackError>,
) -> Result<Option<RackFile>, UserError> {
    let Some(shown) = &state.session.shown else {
        return Ok(None);
    };
    let mut file = editor.draft.clone();
    let taken = take(&mut file, &shown.inspected);
    let taken = taken.map_err(|error| UserError::from(what_and_advice(&error)))?;
    Ok(taken.then_some(file))
}
