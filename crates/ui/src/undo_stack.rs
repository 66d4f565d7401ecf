//! Steps to undo and redo.

/// Whether a step is undone or redone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UndoDirection {
    /// It is undone.
    Undo,
    /// It is redone.
    Redo,
}

/// The steps that can be undone and redone; the latest last. Of more than `LIMIT` steps the oldest are dropped.
#[derive(Debug)]
pub struct UndoStack<S, const LIMIT: usize = 100> {
    /// Steps to undo.
    pub done: Vec<S>,
    /// Steps to redo.
    pub undone: Vec<S>,
}

impl<S, const LIMIT: usize> Default for UndoStack<S, LIMIT> {
    fn default() -> Self {
        Self {
            done: Vec::new(),
            undone: Vec::new(),
        }
    }
}

impl<S, const LIMIT: usize> UndoStack<S, LIMIT> {
    /// Adds the step that undoes a new one; steps undone before can no longer be redone.
    pub fn push(&mut self, inverse: S) {
        self.undone.clear();
        self.done.push(inverse);
        if self.done.len() > LIMIT {
            self.done.remove(0);
        }
    }

    /// The list from which the next step in this direction is taken.
    pub fn from(&mut self, way: UndoDirection) -> &mut Vec<S> {
        match way {
            UndoDirection::Undo => &mut self.done,
            UndoDirection::Redo => &mut self.undone,
        }
    }

    /// Adds the inverse of a step made in this direction, or of a new one.
    pub fn add_inverse(&mut self, way: Option<UndoDirection>, inverse: S) {
        match way {
            None => self.push(inverse),
            Some(UndoDirection::Undo) => self.undone.push(inverse),
            Some(UndoDirection::Redo) => self.done.push(inverse),
        }
    }
}
