//! Roles: the operator watches verdicts, the engineer may change what they depend on.
//!
//! The operator's view prevents accidental changes of recipe, thresholds, library and cell: an action that would change them
//! asks for the engineer's view first. If a PIN is set, it is asked for, also for another source, and after some time without
//! input the window returns to the operator's view. This prevents accidents but not sabotage: anybody can edit the files of
//! the settings and the library.

mod chip;
mod dialog;
mod permits;
mod pin;

use self::permits::needs_engineer;
pub(crate) use self::{chip::chip, permits::is_operators};
pub use self::{dialog::dialog, pin::Pin};
pub use super::session::UserRole;
use super::{
    action::{Action, Effect, apply as apply_any, notify},
    notice::{Notice, NoticeTopic},
    session::WorkspaceKind,
    state::State,
};
use crate::source::live;
use ui::language::text;

/// Choices for the minutes without input until the window locks.
pub const LOCK_AFTER: [u32; 4] = [1, 5, 15, 60];

/// PIN, lock and open question of the roles.
#[derive(Debug)]
pub struct RoleState {
    /// PIN of the engineer's view, if one is set.
    pub pin: Option<Pin>,
    /// Minutes without input until the window returns to the operator's view; only with a PIN.
    pub lock_after: u32,
    /// The open question, if any.
    pub asked: Option<OpenQuestion>,
}

impl Default for RoleState {
    fn default() -> Self {
        Self::starting(None, LOCK_AFTER[1])
    }
}

impl RoleState {
    /// Makes the state at the start of the window.
    pub fn starting(pin: Option<Pin>, lock_after: u32) -> Self {
        Self {
            pin,
            lock_after: lock_after.clamp(LOCK_AFTER[0], LOCK_AFTER[3]),
            asked: None,
        }
    }

    /// Role at the start: the operator with a PIN, else the last role.
    pub fn first_role(&self, last: UserRole) -> UserRole {
        match self.pin {
            Some(_) => UserRole::Operator,
            None => last,
        }
    }

    /// Seconds without input until the window locks in this role; `None` if it does not.
    pub fn lock_timeout(&self, role: UserRole) -> Option<f64> {
        let locks = role == UserRole::Engineer && self.pin.is_some();
        locks.then_some(f64::from(self.lock_after) * 60.0)
    }

    /// True if the PIN is asked for and what was typed as quickly as by a scanner can be one.
    pub fn may_be_pin(&self, code: &str) -> bool {
        let is_short = code.len() <= pin::MOST_DIGITS;
        let is_asked = self.asked.is_some() && self.pin.is_some();
        is_asked && is_short && code.bytes().all(|letter| letter.is_ascii_digit())
    }
}

/// A question on top of the window.
#[derive(Debug)]
pub struct OpenQuestion {
    /// What is asked for.
    pub question: RoleQuestion,
    /// The digits typed so far.
    pub digits: String,
    /// What was wrong with the previous digits.
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

/// Kind of a question.
#[derive(Debug)]
pub enum RoleQuestion {
    /// The PIN, or a confirmation if none is set, to enter the engineer's view and then carry out this action.
    MayI(Option<Box<Action>>),
    /// A new PIN.
    NewPin,
    /// The new PIN again, to confirm it.
    NewPinAgain(String),
    /// Whether to remove the PIN.
    RemovePin,
}

/// Actions on the roles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoleAction {
    /// Switch to the other role; to the engineer's only after the PIN.
    Switch,
    /// Lock the window after a long time without input.
    Lock,
    /// Ask for a new PIN.
    SetPin,
    /// Ask whether to remove the PIN.
    RemovePin,
    /// Lock after this many minutes.
    LockAfter(u32),
    /// Add a digit to the PIN.
    Digit(char),
    /// Erase the last digit.
    Erase,
    /// Confirm the digits.
    Enter,
    /// Close the dialog.
    Close,
}

/// Returns the action, unless it needs the engineer's view, which is then asked for first.
pub(crate) fn permitted(state: &mut State, action: Action) -> Option<Action> {
    // The window starts with the source of the former session.
    let is_free = state.session.role == UserRole::Engineer || state.inspector.is_start;
    if is_free || !needs_engineer(&action, state.roles.pin.is_some()) {
        return Some(action);
    }
    ask_engineer(state, action);
    None
}

/// Asks for the engineer's view; once granted, carries out `then`.
pub fn ask_engineer(state: &mut State, then: Action) {
    state.roles.asked = Some(OpenQuestion::about(RoleQuestion::MayI(Some(Box::new(
        then,
    )))));
}

/// Carries out an action.
pub fn apply(state: &mut State, action: RoleAction) -> Option<Effect> {
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
        RoleAction::RemovePin => own.asked = Some(OpenQuestion::about(RoleQuestion::RemovePin)),
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
    // The others are about the engineer's work.
    let is_everyones = |notice: &Notice| notice.topic == NoticeTopic::SecondWindow;
    state.notices.retain(is_everyones);
    if !is_operators(state.session.workspace) {
        state.session.workspace = WorkspaceKind::Inspect;
        live::show_unseen(state);
    }
}

/// Handles the confirmed digits.
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
            live::tell_if_lost(state);
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
        RoleQuestion::RemovePin => {
            own.pin = None;
            notify(state, Notice::done(text!("shell-pin-removed")));
        }
    }
    None
}

#[cfg(test)]
mod tests;
