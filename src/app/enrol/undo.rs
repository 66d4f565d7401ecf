//! What was done, to be taken back and done again, in its order.

use super::{change::LibraryChange, draft::Draft, selection::Corrections};

/// What can be taken back, and what was taken back and can be done again; the latest last.
#[derive(Debug, Default)]
pub struct Steps {
    /// What was done.
    pub done: Vec<Step>,
    /// What was taken back.
    pub undone: Vec<Step>,
}

/// How to get from here to what was before, or back again.
#[derive(Clone, Debug)]
pub enum Step {
    /// The corrections of the draft of this number as they were.
    Corrections(u64, Corrections),
    /// The draft as it was.
    Draft(Option<Box<Draft>>),
    /// A change of the library.
    Library(LibraryStep),
}

/// A change of the library.
#[derive(Clone, Debug)]
pub struct LibraryStep {
    /// The change to be made.
    pub change: LibraryChange,
    /// What was done first, in words.
    pub what: String,
    /// What becomes of the draft by it.
    pub draft: DraftThen,
}

/// What becomes of the draft when a step is made.
#[derive(Clone, Debug)]
pub enum DraftThen {
    /// It stays.
    Stays,
    /// It makes way for this one: a saved draft goes, and comes back when the saving is taken back.
    MakesWay(Option<Box<Draft>>),
}

/// Which way a step is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// For the first time.
    First,
    /// Taken back.
    Back,
    /// Done again.
    Again,
}

/// More steps than this are forgotten, the oldest first.
const MAX_STEPS: usize = 100;

impl Steps {
    /// Something was done for the first time: what was taken back before can no longer be done again.
    pub fn push(&mut self, back: Step) {
        self.undone.clear();
        self.done.push(back);
        if self.done.len() > MAX_STEPS {
            self.done.remove(0);
        }
    }

    /// The list that the next step that way is taken from.
    pub fn from(&mut self, way: Way) -> &mut Vec<Step> {
        match way {
            Way::First | Way::Back => &mut self.done,
            Way::Again => &mut self.undone,
        }
    }

    /// The list that the way back is put into.
    pub fn to(&mut self, way: Way) -> &mut Vec<Step> {
        match way {
            Way::Back => &mut self.undone,
            Way::First | Way::Again => &mut self.done,
        }
    }
}
