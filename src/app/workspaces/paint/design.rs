//! The design of a spray path, and its undo history.

use std::mem;

use super::{action::ShownPath, state::PaintState};
use crate::{
    app::shell::{
        context::ShellContext, message::Message, notice::NoticeTopic, program_setup::ProgramSetup,
        undo_stack::UndoDirection,
    },
    library::{PartName, SprayPath},
    paint::{Coat, KeepOut, PathEdit},
    pipeline::{RecipeFile, parameters::Parameter},
};

/// Everything that Undo restores.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// The part; `None` until chosen.
    pub part: Option<PartName>,
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
    /// True if both give the same path, before corrections by hand.
    pub(super) fn is_same_path(&self, other: &Self) -> bool {
        (&self.part, &self.coat, &self.regions) == (&other.part, &other.coat, &other.regions)
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
    pub(super) fn is_last_change_of(&self, parameter: &Parameter<Coat>) -> bool {
        let (Some(Step::Design(before)), true) =
            (self.steps.done.last(), self.steps.undone.is_empty())
        else {
            return false;
        };
        let mut same = (**before).clone();
        parameter.copy(&self.design.coat, &mut same.coat);
        same == self.design && **before != self.design
    }

    /// Adds regions. Areas to be painted are merged into one region; keep-outs stay separate.
    pub(super) fn add(&mut self, regions: Vec<KeepOut>) {
        self.change(|design| {
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

/// Sends other settings for robot programs, and removes the notices of why the former ones gave none.
fn use_setup(setup: ProgramSetup, cx: &mut ShellContext<'_>) {
    cx.send(Message::RemoveNotices(NoticeTopic::Program));
    // Inspect shows it, too.
    if let Some(error) = cx.session.program.nozzle_error() {
        cx.send(Message::Retract(error.into()));
    }
    cx.send(Message::UseProgramSetup(setup));
}
