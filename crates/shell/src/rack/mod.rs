//! Where parts may hang: the rack in use, and the window in which it is edited.

mod in_use;
mod window;

use std::path::PathBuf;

use self::in_use::camera;
pub use self::{
    in_use::{RackAction, RackEditor, RackInUse, ReadRack},
    window::{box_numbers, window},
};
use crate::{
    inspection::inspected::Inspected,
    notice::Notice,
    session::Session,
    state::{State, notify},
};
use inspection::rack::{RackError, RackFile, RackProblem, may_be_taken};
use ui::{
    language::{described, text, what_and_advice},
    user_error::UserError,
};

/// Maximum number of steps that can be undone.
const MAX_UNDO: usize = 50;

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

impl RackEditor {
    fn of(session: &Session) -> Self {
        Self {
            draft: session.rack.file.clone().unwrap_or_default(),
            ..Self::default()
        }
    }
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
pub fn apply(state: &mut State, action: RackAction) {
    if let RackAction::Toggle = action {
        if state.session.rack_editor.is_some() {
            close(state);
        } else {
            state.session.rack_editor = Some(RackEditor::of(&state.session));
            inspect_present(state);
        }
        return;
    }
    if let RackAction::Open(path) = action {
        state.rack_reading.start(text!("rack-reading"), |_| {
            let file = RackFile::read(&path);
            let file = file.map_err(|error| UserError::from(what_and_advice(&error)))?;
            Ok((path, Box::new(file)))
        });
        return;
    }
    if let RackAction::Saved(saved) = action {
        return tell_saved(state, saved);
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
