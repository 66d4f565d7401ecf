//! What is painted how, and its history: every step is taken back and done again in its order.

use std::mem;

use super::{action::ShownPath, state::PaintState};
use crate::{
    app::shell::context::ShellContext,
    library::{PartName, SprayPath},
    paint::{Coat, KeepOut, PathEdit},
    pipeline::{RecipeFile, parameters::Parameter},
};

/// What is painted how: what Undo brings back.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// The part; none before one was chosen.
    pub part: Option<PartName>,
    /// The saved coat that was chosen.
    pub kept: RecipeFile<Coat>,
    /// Its parameters, with the changes made since.
    pub coat: Coat,
    /// Where paint goes and where not.
    pub regions: Vec<KeepOut>,
    /// What was corrected by hand in the path that they give.
    pub edits: Vec<PathEdit>,
}

/// A step that can be taken back.
#[derive(Clone, Debug)]
pub(super) enum Step {
    /// The design as it was.
    Design(Box<Design>),
    /// The path that was stored with a part.
    Stored(PartName, Option<SprayPath>),
}

/// More steps than this are forgotten, the oldest first.
const MAX_STEPS: usize = 100;

/// Which way a step is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum UndoDirection {
    /// For the first time.
    First,
    /// Taken back.
    Back,
    /// Done again.
    Again,
}

/// What can be taken back, and what was taken back and can be done again; the latest last.
#[derive(Debug, Default)]
pub(super) struct UndoStack {
    pub(super) done: Vec<Step>,
    pub(super) undone: Vec<Step>,
}

impl UndoStack {
    /// Something was done for the first time.
    pub(super) fn push(&mut self, step: Step) {
        self.undone.clear();
        self.done.push(step);
        if self.done.len() > MAX_STEPS {
            self.done.remove(0);
        }
    }

    /// The list that the next step that way is taken from.
    pub(super) fn from(&mut self, way: UndoDirection) -> &mut Vec<Step> {
        match way {
            UndoDirection::First | UndoDirection::Back => &mut self.done,
            UndoDirection::Again => &mut self.undone,
        }
    }

    /// The list that the way back is put into.
    pub(super) fn to(&mut self, way: UndoDirection) -> &mut Vec<Step> {
        match way {
            UndoDirection::Back => &mut self.undone,
            UndoDirection::First | UndoDirection::Again => &mut self.done,
        }
    }
}

impl Design {
    /// True if the same path is planned of both, before corrections by hand.
    pub(super) fn is_same_path(&self, other: &Self) -> bool {
        (&self.part, &self.coat, &self.regions) == (&other.part, &other.coat, &other.regions)
    }

    /// True if the coat differs from what is kept under its name.
    pub fn is_coat_changed(&self) -> bool {
        self.coat != self.kept.recipe
    }
}

impl PaintState {
    /// Changes the design; Undo brings back what it was.
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

    /// Areas to be painted are one region together; others stand for themselves.
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

    /// Takes the last step back, or does it again.
    pub(super) fn step(&mut self, way: UndoDirection, cx: &ShellContext<'_>) {
        if self.is_storing() {
            return;
        }
        match self.steps.from(way).pop() {
            None => {}
            Some(Step::Design(other)) => {
                let now = mem::replace(&mut self.design, *other);
                self.steps.to(way).push(Step::Design(Box::new(now)));
                self.shown_path = ShownPath::Planned;
            }
            Some(Step::Stored(part, path)) => self.store(way, part, path, cx),
        }
    }
}
