//! Whose window it is: the operator's, who watches verdicts, or the engineer's, who may change what they rest on.
//!
//! In the operator's view recipe, thresholds, library and cell cannot be changed by accident: whatever would change them
//! asks for the engineer's view first. A PIN, if one is set, stands before that, and after a while without a hand on
//! it the window is the operator's again. This prevents accidents. It is no protection against somebody who means to:
//! the settings and the library are files that anybody can edit.

mod chip;
mod dialog;
mod permits;
mod pin;

use self::permits::needs_engineer;
pub use self::pin::Pin;
pub(in crate::app) use self::{chip::chip, dialog::dialog, permits::is_operators};
pub use super::session::UserRole;
use super::{
    action::{Action, Effect, apply as apply_any, notify},
    notice::Notice,
    session::WorkspaceKind,
    state::State,
};
use crate::app::language::text;

/// Minutes without a hand on the window until it is the operator's again, that can be chosen.
pub const LOCK_AFTER: [u32; 4] = [1, 5, 15, 60];

/// Whose window it is, and what stands between the two.
#[derive(Debug)]
pub struct RoleState {
    /// What the engineer's view asks for, if anything.
    pub pin: Option<Pin>,
    /// Minutes without a hand on the window until it is the operator's again; only with a PIN.
    pub lock_after: u32,
    /// What is asked, while it is.
    pub asked: Option<OpenQuestion>,
}

impl Default for RoleState {
    fn default() -> Self {
        Self::starting(None, LOCK_AFTER[1])
    }
}

impl RoleState {
    /// As the window starts.
    pub fn starting(pin: Option<Pin>, lock_after: u32) -> Self {
        Self {
            pin,
            lock_after: lock_after.clamp(LOCK_AFTER[0], LOCK_AFTER[3]),
            asked: None,
        }
    }

    /// Whose the window is when it starts: without a PIN whose it was last.
    pub fn first_role(&self, last: UserRole) -> UserRole {
        match self.pin {
            Some(_) => UserRole::Operator,
            None => last,
        }
    }

    /// Seconds without a hand on this person's window until it locks; `None` if it does not.
    pub fn lock_timeout(&self, role: UserRole) -> Option<f64> {
        let locks = role == UserRole::Engineer && self.pin.is_some();
        locks.then_some(f64::from(self.lock_after) * 60.0)
    }
}

/// A question on top of the window.
#[derive(Debug)]
pub struct OpenQuestion {
    /// What it is about.
    pub question: RoleQuestion,
    /// The digits written so far.
    pub digits: String,
    /// What was wrong with the last ones.
    pub wrong: Option<String>,
}

impl OpenQuestion {
    fn about(question: RoleQuestion) -> Self {
        Self {
            question,
            digits: String::new(),
            wrong: None,
        }
    }
}

/// What is asked.
#[derive(Debug)]
pub enum RoleQuestion {
    /// The PIN, or without one a yes, to come into the engineer's view and do this.
    MayI(Option<Box<Action>>),
    /// A new PIN.
    NewPin,
    /// The same once more.
    NewPinAgain(String),
}

/// Something that can happen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoleAction {
    /// Change to the other view; to the engineer's after its PIN.
    Switch,
    /// Nobody has touched the window for long.
    Lock,
    /// Ask for a new PIN.
    SetPin,
    /// Ask for none any more.
    RemovePin,
    /// Lock after so many minutes.
    LockAfter(u32),
    /// A digit of the PIN.
    Digit(char),
    /// Take the last digit back.
    Erase,
    /// The PIN is written.
    Enter,
    /// Do not ask any more.
    Close,
}

/// The action, unless it needs the engineer's view: that is asked for first.
pub(in crate::app) fn permitted(state: &mut State, action: Action) -> Option<Action> {
    if state.session.role == UserRole::Engineer || !needs_engineer(&action) {
        return Some(action);
    }
    ask_engineer(state, action);
    None
}

/// Asks for the engineer's view, and does this once it is there.
pub(in crate::app) fn ask_engineer(state: &mut State, then: Action) {
    state.roles.asked = Some(OpenQuestion::about(RoleQuestion::MayI(Some(Box::new(
        then,
    )))));
}

/// Carries out an action.
pub(in crate::app) fn apply(state: &mut State, action: RoleAction) -> Option<Effect> {
    let role = state.session.role;
    let own = &mut state.roles;
    match action {
        RoleAction::Switch => match role {
            UserRole::Engineer => switch_to_operator(state),
            UserRole::Operator => own.asked = Some(OpenQuestion::about(RoleQuestion::MayI(None))),
        },
        RoleAction::Lock => {
            switch_to_operator(state);
            let what = text!("shell-locked");
            notify(state, Notice::done(what));
        }
        RoleAction::SetPin => own.asked = Some(OpenQuestion::about(RoleQuestion::NewPin)),
        RoleAction::RemovePin => {
            own.pin = None;
            notify(state, Notice::done(text!("shell-pin-removed")));
        }
        RoleAction::LockAfter(minutes) => own.lock_after = minutes,
        RoleAction::Digit(digit) => {
            if let Some(asked) = &mut own.asked
                && digit.is_ascii_digit()
                && asked.digits.len() < pin::MOST_DIGITS
            {
                asked.digits.push(digit);
                asked.wrong = None;
            }
        }
        RoleAction::Erase => {
            if let Some(asked) = &mut own.asked {
                asked.digits.pop();
            }
        }
        RoleAction::Enter => return enter(state),
        RoleAction::Close => own.asked = None,
    }
    None
}

fn switch_to_operator(state: &mut State) {
    state.session.role = UserRole::Operator;
    state.roles.asked = None;
    // They speak of the engineer's work.
    state.notices.clear();
    if !is_operators(state.session.workspace) {
        state.session.workspace = WorkspaceKind::Inspect;
    }
}

/// What follows from the digits that were written.
fn enter(state: &mut State) -> Option<Effect> {
    let own = &mut state.roles;
    let OpenQuestion {
        question, digits, ..
    } = own.asked.take()?;
    let again = |question, wrong| {
        Some(OpenQuestion {
            wrong: Some(wrong),
            ..OpenQuestion::about(question)
        })
    };
    match question {
        RoleQuestion::MayI(then) => {
            if own.pin.as_ref().is_some_and(|pin| !pin.is(&digits)) {
                own.asked = again(RoleQuestion::MayI(then), text!("shell-wrong-pin"));
                return None;
            }
            state.session.role = UserRole::Engineer;
            state.report_library();
            return apply_any(state, *then?);
        }
        RoleQuestion::NewPin if digits.len() < pin::LEAST_DIGITS => {
            own.asked = again(RoleQuestion::NewPin, text!("shell-four-digits"));
        }
        RoleQuestion::NewPin => {
            own.asked = Some(OpenQuestion::about(RoleQuestion::NewPinAgain(digits)));
        }
        RoleQuestion::NewPinAgain(first) if first != digits => {
            own.asked = again(RoleQuestion::NewPin, text!("shell-pins-differ"));
        }
        RoleQuestion::NewPinAgain(_) => {
            own.pin = Some(Pin::of(&digits));
            let what = text!("shell-pin-set");
            notify(state, Notice::done(what));
        }
    }
    None
}

#[cfg(test)]
mod tests;
