//! The design of a spray path: its undo history, and its coat, chosen by name, changed by parameter and saved under a name.

use std::mem;

use crate::workspaces::paint::state::{PaintState, ShownPath};
use inspection::{
    library::{FileCheck, PartName, SprayPath},
    pipeline::{RecipeFile, Replace, parameters::Parameter},
};
use robot::paint::{Coat, KeepOut, PathEdit, built_in_coat};
use shell::{
    action::Action,
    cell::ProgramSetup,
    inspection::library_cache::LibraryView,
    notice::{Notice, NoticeTopic},
    session::Session,
    workspace::ShellContext,
};
use ui::{
    language::text, parameter_control::ParameterChange, undo_stack::UndoDirection,
    user_error::UserError,
};

/// Everything that Undo restores.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// The part; `None` until chosen or drawn on.
    pub part: Option<PartName>,
    /// Its cloud then: what is drawn is in the coordinates of this cloud.
    pub cloud: Option<FileCheck>,
    /// The saved coat that was chosen.
    pub kept: RecipeFile<Coat>,
    /// Its parameters, with the changes made since.
    pub coat: Coat,
    /// Keep-outs and areas to be painted.
    pub regions: Vec<KeepOut>,
    /// Corrections by hand of the path planned from them.
    pub edits: Vec<PathEdit>,
}

/// An undoable step.
#[derive(Clone, Debug)]
pub(super) enum Step {
    /// Set the design.
    Design(Box<Design>),
    /// Store this path with a part; `None` removes the present one.
    Stored(PartName, Option<SprayPath>),
    /// Set the pose of the arm's base.
    Base([f64; 6]),
}

impl Design {
    /// True if both give the same path over the same part, before corrections by hand.
    pub(super) fn is_same_path(&self, other: &Self) -> bool {
        (&self.coat, &self.regions) == (&other.coat, &other.regions)
    }

    /// True if there are regions or corrections by hand.
    pub fn is_drawn_on(&self) -> bool {
        !self.regions.is_empty() || !self.edits.is_empty()
    }

    /// Removes regions and corrections by hand.
    pub(super) fn clear(&mut self) {
        self.regions.clear();
        self.edits.clear();
    }

    /// True if the part is still enrolled as it was when it was chosen or drawn on.
    fn is_enrolled(&self, library: &LibraryView) -> bool {
        let (part, cloud) = (self.part.as_ref(), self.cloud.as_ref());
        let mut parts = library.parts.iter();
        parts.any(|known| Some(&known.name) == part && Some(&known.cloud) == cloud)
    }

    /// Takes over the part's new name if it was renamed in the library. If it was removed or enrolled anew, removes what is drawn
    /// on it; returns true if there was anything.
    fn follow(&mut self, library: &LibraryView) -> bool {
        let (Some(part), Some(cloud)) = (&self.part, &self.cloud) else {
            return false;
        };
        let mut parts = library.parts.iter();
        let named = parts.find(|known| known.name == *part);
        let renamed = || library.parts.iter().find(|known| known.cloud == *cloud);
        if let Some(known) = named.or_else(renamed) {
            if known.cloud == *cloud {
                self.part = Some(known.name.clone());
                return false;
            }
            self.cloud = Some(known.cloud.clone());
        }
        let was_drawn_on = self.is_drawn_on();
        self.clear();
        was_drawn_on
    }

    /// True if the coat differs from the saved one of its name.
    pub fn is_coat_changed(&self) -> bool {
        self.coat != self.kept.recipe
    }
}

impl PaintState {
    /// Changes the design as an undoable step.
    pub(super) fn change(&mut self, change: impl FnOnce(&mut Design)) {
        let before = self.design.clone();
        change(&mut self.design);
        if self.design == before {
            return;
        }
        self.shown_path = ShownPath::Planned;
        self.steps.push(Step::Design(Box::new(before)));
    }

    /// True if the last step changed this parameter and nothing else.
    fn is_last_change_of(&self, parameter: &Parameter<Coat>) -> bool {
        let (Some(Step::Design(before)), true) =
            (self.steps.done.last(), self.steps.undone.is_empty())
        else {
            return false;
        };
        let mut same = (**before).clone();
        parameter.copy(&self.design.coat, &mut same.coat);
        same == self.design && **before != self.design
    }

    /// Chooses the part to paint as an undoable step; what is drawn on another one is dropped.
    pub(super) fn choose_part(&mut self, part: PartName, cx: &mut ShellContext<'_>) {
        let session = cx.session;
        let former = self.part(session);
        let is_other = former != Some(&part);
        if let Some(former) = former.filter(|_| is_other && self.design.is_drawn_on()) {
            cx.notify(drawn_dropped(
                former,
                session,
                text!("paint-drawn-dropped-undo"),
            ));
        }
        if !is_other && !self.is_planning() && self.is_old(session) {
            // Choosing it again repeats what was cancelled or has failed.
            self.asked = None;
        }
        let mut parts = session.library.iter().flat_map(|library| &library.parts);
        let enrolled = parts.find(|known| known.name == part);
        self.change(|design| {
            design.part = Some(part);
            design.cloud = enrolled.map(|part| part.cloud.clone());
            if is_other {
                design.clear();
            }
        });
    }

    /// Changes what is drawn on the part as an undoable step. The part stays the one to paint, whichever is recognised next.
    pub(super) fn draw(&mut self, session: &Session, draw: impl FnOnce(&mut Design)) {
        let enrolled = self.enrolled(session);
        self.change(|design| {
            if let Some(part) = enrolled {
                design.part = Some(part.name.clone());
                design.cloud = Some(part.cloud.clone());
            }
            draw(design);
        });
    }

    /// Follows the part through a change of the library. Dropping what is drawn on it is an undoable step.
    pub(super) fn follow_part(&mut self, cx: &mut ShellContext<'_>) {
        let library = cx.session.library.as_ref();
        if self.design.part.is_none()
            || library.is_none_or(|library| self.design.is_enrolled(library))
        {
            return;
        }
        let mut design = self.design.clone();
        if follow(&mut design, cx) {
            self.change(|now| *now = design);
        } else {
            self.design = design;
        }
    }

    /// Adds regions. Areas to be painted are merged into one region; keep-outs stay separate.
    pub(super) fn add(&mut self, regions: Vec<KeepOut>, session: &Session) {
        self.draw(session, |design| {
            for region in regions {
                let former = design.regions.iter_mut().find_map(|former| match former {
                    KeepOut::Outside { areas } => Some(areas),
                    KeepOut::Sphere { .. } | KeepOut::Polygon { .. } => None,
                });
                match (region, former) {
                    (KeepOut::Outside { areas }, Some(former)) => former.extend(areas),
                    (region, _) => design.regions.push(region),
                }
            }
        });
    }

    /// Uses other settings for robot programs. Another base is an undoable step; dragging its numbers is one step.
    pub(super) fn set_up(&mut self, setup: ProgramSetup, cx: &mut ShellContext<'_>) {
        let former = cx.session.program.base;
        let is_dragged = cx.egui.input(|input| input.pointer.any_down());
        let is_last = matches!(self.steps.done.last(), Some(Step::Base(_)));
        let is_same_step = is_dragged && is_last && self.steps.undone.is_empty();
        if setup.base.iter().ne(&former) && !is_same_step {
            self.steps.push(Step::Base(former));
        }
        use_setup(setup, cx);
    }

    /// Restores the path that the last *Store* replaced; what was drawn since stays.
    pub(super) fn undo_storing(&mut self, cx: &mut ShellContext<'_>) {
        if self.is_storing() {
            return;
        }
        let done = &mut self.steps.done;
        let mut steps = done.iter();
        if let Some(last) = steps.rposition(|step| matches!(step, Step::Stored(..))) {
            let step = done.remove(last);
            done.push(step);
            self.step(UndoDirection::Undo, cx);
        }
    }

    /// Undoes or redoes one step.
    pub(super) fn step(&mut self, way: UndoDirection, cx: &mut ShellContext<'_>) {
        if self.is_storing() {
            return;
        }
        match self.steps.from(way).pop() {
            None => {}
            Some(Step::Design(other)) => {
                let now = mem::replace(&mut self.design, *other);
                let back = Step::Design(Box::new(now));
                self.steps.add_inverse(Some(way), back);
                self.shown_path = ShownPath::Planned;
                // The part may have changed in the library since.
                follow(&mut self.design, cx);
            }
            Some(Step::Stored(part, path)) => self.store(Some(way), part, path, cx),
            Some(Step::Base(base)) => {
                let former = cx.session.program.clone();
                let back = Step::Base(former.base);
                self.steps.add_inverse(Some(way), back);
                use_setup(ProgramSetup { base, ..former }, cx);
            }
        }
    }
}

/// Has a design follow its part in the library; returns true, and tells the user, if what is drawn on it was dropped.
fn follow(design: &mut Design, cx: &mut ShellContext<'_>) -> bool {
    let session = cx.session;
    let Some((library, part)) = session.library.as_ref().zip(design.part.clone()) else {
        return false;
    };
    let was_dropped = design.follow(library);
    if was_dropped {
        let advice = text!("paint-drawn-dropped-again");
        cx.notify(drawn_dropped(&part, session, advice));
    }
    was_dropped
}

/// The notice that what is drawn on this part was dropped.
fn drawn_dropped(part: &PartName, session: &Session, advice: String) -> Notice {
    let library = session.library.as_ref();
    let title = library.map_or(part.as_str(), |library| library.title_of(part.as_str()));
    Notice::look(text!("paint-drawn-dropped", part = title), advice)
}

/// Sends other settings for robot programs, and removes the notices of why the former ones gave none.
fn use_setup(setup: ProgramSetup, cx: &mut ShellContext<'_>) {
    cx.send(Action::RemoveNotices(NoticeTopic::Program));
    // Inspect shows it, too.
    if let Some(error) = cx.session.program.nozzle_error() {
        cx.send(Action::Retract(error.into()));
    }
    cx.send(Action::UseProgramSetup(setup));
}

impl PaintState {
    pub(super) fn change_parameter(
        &mut self,
        key: &'static str,
        change: ParameterChange,
        cx: &mut ShellContext<'_>,
    ) {
        let Some(parameter) = Parameter::<Coat>::of_key(key) else {
            return;
        };
        let mut coat = self.design.coat;
        match change {
            ParameterChange::Reset => parameter.copy(&self.design.kept.recipe, &mut coat),
            ParameterChange::Set(value) => {
                if let Err(error) = parameter.set(&mut coat, value) {
                    cx.notify(UserError::of(&error));
                    return;
                }
            }
        }
        // Dragging a slider is one step.
        let is_dragged = cx.egui.input(|input| input.pointer.any_down());
        if is_dragged && self.is_last_change_of(parameter) {
            self.design.coat = coat;
        } else {
            self.change(|design| design.coat = coat);
        }
    }

    pub(super) fn choose_coat(&mut self, name: &str, cx: &mut ShellContext<'_>) {
        let found = match (built_in_coat(name), &self.coat_folder) {
            (Some(own), _) => Ok(own),
            (None, Some(folder)) => folder.open(name),
            (None, None) => return,
        };
        match found {
            Ok(kept) => self.change(|design| {
                design.coat = kept.recipe;
                design.kept = kept;
            }),
            Err(error) => cx.notify(UserError::of(&error)),
        }
    }

    /// Lists the coats again, as files may have been added.
    pub(super) fn list_coats(&mut self, cx: &mut ShellContext<'_>) {
        let Some(folder) = &self.coat_folder else {
            return;
        };
        match folder.names() {
            Ok(names) => self.coats = names,
            Err(error) => cx.notify(UserError::of(&error)),
        }
    }

    pub(super) fn save_coat(&mut self, cx: &mut ShellContext<'_>) {
        let Some(written) = &self.naming else { return };
        let Some(folder) = &self.coat_folder else {
            cx.notify(Notice::look(
                text!("paint-no-coat-folder"),
                text!("paint-no-coat-folder-advice"),
            ));
            return;
        };
        let about_name = |error: UserError| Notice::from(error).about(NoticeTopic::CoatName);
        let name = match PartName::new(written.trim()) {
            Ok(name) => name,
            Err(error) => return cx.notify(about_name(UserError::of(&error))),
        };
        let coat = RecipeFile {
            name,
            notes: self.design.kept.notes.clone(),
            recipe: self.design.coat,
        };
        // Saving under the coat's own name replaces it.
        let replace = if coat.name == self.design.kept.name {
            Replace::Yes
        } else {
            Replace::No
        };
        match folder.save(&coat, replace) {
            Ok(()) => {
                cx.send(Action::RemoveNotices(NoticeTopic::CoatName));
                let name = coat.name.to_string();
                cx.notify(Notice::done(text!("paint-saved-coat", coat = name)));
                self.naming = None;
                self.change(|design| design.kept = coat);
                self.list_coats(cx);
            }
            Err(error) => cx.notify(about_name(UserError::of(&error))),
        }
    }
}
