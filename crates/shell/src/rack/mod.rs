//! Where parts may hang: the rack in use, and the window in which it is edited.

mod window;

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

pub use self::window::window;
use crate::{
    action::Effect,
    inspection::inspected::Inspected,
    notice::Notice,
    session::{ReinspectionPurpose, Session},
    source::live,
    state::{State, notify},
};
use geometry::rigid::RigidTransform;
use inspection::rack::{Rack, RackError, RackFile};
use robot::RobotFrame;
use ui::{language::text, user_error::UserError};

/// Maximum number of steps that can be undone.
const MAX_UNDO: usize = 50;

/// The rack in use.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct RackInUse {
    /// Its file; `None` if parts may hang anywhere.
    file: Option<RackFile>,
    /// Its boxes and places in camera space.
    in_camera: Rack,
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
            Some(file) if file.name.is_empty() => text!("rack-unnamed"),
            Some(file) => file.name.clone(),
        }
    }

    /// Puts it where the camera is now. While that is not known, the rack stays where it was.
    pub fn follow(&mut self, robot: Option<&RobotFrame>) {
        let moved = self.file.as_ref();
        let moved = moved.and_then(|file| file.in_camera(camera(robot)).ok());
        if let Some(moved) = moved {
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
            in_camera,
        };
        Ok(())
    }
}

/// The window in which the rack is edited.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RackEditor {
    /// The rack as it is edited; it is in use unless something in it is wrong.
    draft: RackFile,
    /// Former drafts, the newest last.
    past: Vec<RackFile>,
    /// What is wrong.
    problem: Option<UserError>,
    /// True if nothing was inspected with the draft yet.
    is_new: bool,
}

/// An action on the rack.
#[derive(Clone, Debug)]
pub enum RackAction {
    /// Open or close the window.
    Toggle,
    /// Use the rack of this file.
    Open(PathBuf),
    /// Write the rack in use to this file.
    Save(PathBuf),
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
    /// Add a box around the part in front to the work volume.
    TakeVolume,
    /// Undo the last change.
    Undo,
}

/// Carries out an action on the rack.
pub fn apply(state: &mut State, action: RackAction) -> Option<Effect> {
    if let RackAction::Toggle = action {
        state.rack_editor = match state.rack_editor.take() {
            Some(_) => None,
            None => Some(RackEditor {
                draft: state.session.rack.file.clone().unwrap_or_default(),
                ..RackEditor::default()
            }),
        };
        return None;
    }
    let mut editor = state.rack_editor.take().unwrap_or_default();
    let robot = state.session.robot.clone();
    let changed = match action {
        RackAction::Toggle => Ok(None),
        RackAction::Open(path) => RackFile::read(&path).map(|file| {
            let title = path.display().to_string();
            notify(state, Notice::done(text!("rack-opened", path = title)));
            Some(file)
        }),
        RackAction::Save(path) => editor.draft.write(&path).map(|_| {
            let title = path.display().to_string();
            notify(state, Notice::done(text!("rack-saved", path = title)));
            None
        }),
        RackAction::Edit { file, continues } => {
            if continues {
                editor.draft = *file;
                set(state, &mut editor);
                Ok(None)
            } else {
                Ok(Some(*file))
            }
        }
        RackAction::Inspect => {
            editor.is_new = false;
            if state.session.is_live() {
                live::restart_consensus(state);
            } else if state
                .session
                .shown
                .as_ref()
                .is_some_and(|shown| !shown.is_past)
            {
                state.inspect_shown(&text!("rack-heading"), ReinspectionPurpose::Repeated);
            }
            Ok(None)
        }
        RackAction::TakePlace(name) => taken(state, &editor, |file, front| {
            let camera = camera(robot.as_deref());
            file.take_place(&name, &front.inspection, front.middle, camera)
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
        Err(error) => editor.problem = Some(UserError::of(&error)),
    }
    state.rack_editor = Some(editor);
    None
}

/// Uses the draft, unless something in it is wrong.
fn set(state: &mut State, editor: &mut RackEditor) {
    let checked = if editor.draft.rack.is_empty() {
        Ok(())
    } else {
        editor.draft.check()
    };
    let wrong = |what| UserError {
        what,
        advice: text!("rack-not-used"),
    };
    let library = state.session.library.clone();
    let is_enrolled = |name: &str| {
        let parts = library.iter().flat_map(|library| &library.parts);
        library.is_none() || parts.into_iter().any(|part| part.name.as_str() == name)
    };
    let used = checked.map_err(wrong).and_then(|()| {
        let known = editor.draft.check_parts(is_enrolled);
        let used = known.and_then(|()| state.session.use_rack(editor.draft.clone()));
        used.map_err(|error| UserError::of(&error))
    });
    editor.is_new |= used.is_ok();
    editor.problem = used.err();
}

/// The draft changed by the part in front; `None` if there is no part.
fn taken(
    state: &State,
    editor: &RackEditor,
    take: impl FnOnce(&mut RackFile, &Inspected) -> Result<bool, RackError>,
) -> Result<Option<RackFile>, RackError> {
    let Some(shown) = &state.session.shown else {
        return Ok(None);
    };
    let mut file = editor.draft.clone();
    Ok(take(&mut file, &shown.inspected)?.then_some(file))
}
