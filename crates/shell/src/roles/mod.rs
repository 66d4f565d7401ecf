//! Roles: the operator watches verdicts, the engineer may change what they depend on.
//!
//! The operator's view prevents accidental changes of recipe, thresholds, library and cell: an action that would change them
//! asks for the engineer's view first. If a PIN is set, it is asked for, also for another source, and after some time without
//! input the window returns to the operator's view. This prevents accidents but not sabotage: anybody can edit the files of
//! the settings and the library.

mod chip;
mod dialog;
mod permits;
mod question;

use self::permits::needs_engineer;
pub(crate) use self::{chip::chip, permits::is_operators};
pub use self::{
    dialog::dialog,
    question::{LOCK_AFTER, OpenQuestion, Pin, RoleAction, RoleQuestion, RoleState},
};
pub use super::session::UserRole;
use super::{
    action::Action,
    notice::{Notice, NoticeTopic},
    session::WorkspaceKind,
    state::State,
};
use crate::{apply::apply as apply_any, rack, source::live, state::notify};
use ui::language::text;

/// Returns the action, unless it needs the engineer's view: then asks for that, and carries the action out once it is granted.
pub(crate) fn permitted(state: &mut State, action: Action) -> Option<Action> {
    // The window starts with the source of the former session.
    let is_free = state.session.role == UserRole::Engineer || state.inspector.is_start;
    if is_free || !needs_engineer(&action, state.roles.pin.is_some()) {
        return Some(action);
    }
    let question = RoleQuestion::MayI(Some(Box::new(action)));
    state.roles.asked = Some(OpenQuestion::about(question));
    None
}

/// Carries out an action.
pub fn apply(state: &mut State, action: RoleAction) -> Option<Action> {
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
                && asked.digits.len() < question::MOST_DIGITS
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
    rack::close(state);
    // The others are about the engineer's work.
    let is_everyones = |notice: &Notice| notice.topic == NoticeTopic::SecondWindow;
    state.notices.retain(is_everyones);
    if !is_operators(state.session.workspace) {
        state.session.workspace = WorkspaceKind::Inspect;
        live::show_unseen(state);
    }
}

/// Handles the confirmed digits.
fn enter(state: &mut State) -> Option<Action> {
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
        RoleQuestion::NewPin if digits.len() < question::LEAST_DIGITS => {
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
