//! Roles: the operator watches verdicts, the engineer may change what they depend on.
//!
//! The operator's view prevents accidental changes of recipe, thresholds, library and cell: an action that would change them
//! asks for the engineer's view first. If a PIN is set, it is asked for, also for another source, and after some time without
//! input the window returns to the operator's view. This prevents accidents but not sabotage: anybody can edit the files of
//! the settings and the library.

mod question;

use egui::{Button, Context, Event, Key, RichText, Ui, vec2};

use crate::{
    action::{Action, DialogRequest},
    apply::apply as apply_any,
    cell::{CheckAction, RobotAction},
    notice::{Notice, NoticeTopic},
    rack,
    roles::question::{LEAST_DIGITS, MOST_DIGITS},
    session::WorkspaceKind,
    source::live::{self, LiveAction},
    state::{State, notify},
    trace::orders::ExpectAction,
};
use ui::{
    language::text,
    theme::{Theme, font, space},
    widgets::{self, text_button},
};

pub use self::question::{LOCK_AFTER, OpenQuestion, Pin, RoleAction, RoleQuestion, RoleState};
pub use super::session::UserRole;

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
                && asked.digits.len() < MOST_DIGITS
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
        RoleQuestion::NewPin if digits.len() < LEAST_DIGITS => {
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

/// True for workspaces that cannot change anything verdicts depend on.
pub(crate) fn is_operators(workspace: WorkspaceKind) -> bool {
    match workspace {
        WorkspaceKind::Inspect | WorkspaceKind::History => true,
        WorkspaceKind::Enrol
        | WorkspaceKind::Compare
        | WorkspaceKind::Align
        | WorkspaceKind::Paint
        | WorkspaceKind::Servo => false,
    }
}

/// True for actions that change recipe, thresholds, library or cell, and for those of the engineer's workspaces; with a PIN,
/// also for those that change the source.
///
/// Lists every action, so that each new one needs a decision.
fn needs_engineer(action: &Action, has_pin: bool) -> bool {
    match action {
        Action::GoTo(workspace) | Action::Press(workspace, _) => !is_operators(*workspace),
        Action::Ask(ask) | Action::Chosen(ask, _) => asks_for_engineer(*ask, has_pin),
        Action::Role(action) => matches!(
            action,
            RoleAction::SetPin | RoleAction::RemovePin | RoleAction::LockAfter(_)
        ),
        // Choosing another source changes what is captured next; an opened file becomes the source.
        Action::Live(LiveAction::Use(_) | LiveAction::SetUp(Some(_)))
        | Action::UseCell(_)
        | Action::Open(_)
        | Action::Take(..)
        | Action::TakeFile(_) => has_pin,
        Action::Robot(action) => !matches!(
            action,
            RobotAction::Close | RobotAction::Check(CheckAction::Cancel)
        ),
        // The robot's controller expects a certain convention.
        Action::UseConvention(_)
        | Action::Rack(_)
        | Action::TakeEmptyCell
        | Action::ForgetEmptyCell
        | Action::UseFoundLibrary
        | Action::AskEngineer(_)
        // Otherwise an order would not be compared with what hangs there.
        | Action::Expect(ExpectAction::CloseOrders)
        // Verdicts depend on the averaging of depth.
        | Action::Live(LiveAction::Average(_)) => true,
        Action::Live(_)
        | Action::Expect(ExpectAction::Parts(_))
        | Action::Capture
        | Action::CancelInspection
        | Action::SelectPart(_)
        | Action::CancelTask(_)
        | Action::Tell(_)
        | Action::Close
        // What workspaces send: the operator's may, and the others' are the engineer's.
        | Action::Retract(_)
        | Action::RemoveNotices(_)
        | Action::WithdrawUndo(_)
        | Action::CopyText(_)
        | Action::UseSource(_)
        | Action::UseRecipe(_)
        | Action::UseCalibration(..)
        | Action::UseAnswering(_)
        | Action::UseProgramSetup(_)
        | Action::UseServoSettings(_)
        | Action::ShowPaintTab(_)
        | Action::LibraryChanged { .. }
        | Action::Inspect { .. }
        | Action::InspectShown { .. }
        | Action::ShowPast(_)
        | Action::CloseTop
        | Action::SwitchUnits
        | Action::SwitchTheme
        | Action::Speak(_)
        | Action::ToggleHelp
        | Action::EditHelp(_)
        | Action::Dismiss(_)
        | Action::DismissAll
        | Action::Reread(_)
        | Action::Notify(_)
        | Action::CloseAnyway
        | Action::StayOpen
        | Action::WrongPart => false,
    }
}

fn asks_for_engineer(ask: DialogRequest, has_pin: bool) -> bool {
    match ask {
        DialogRequest::Library
        | DialogRequest::Part
        | DialogRequest::Orders
        | DialogRequest::Rack
        | DialogRequest::SaveRack => true,
        DialogRequest::Scene
        | DialogRequest::Scan
        | DialogRequest::Recording
        | DialogRequest::WatchedFolder => has_pin,
        DialogRequest::RecordTo | DialogRequest::ProblemReport => false,
    }
}

/// Width and height of a digit's button, logical pixels.
const DIGIT: [f32; 2] = [76.0, 52.0];

/// Draws the dialog while something is asked.
pub fn dialog(ctx: &Context, state: &State, actions: &mut Vec<Action>) {
    let theme = Theme::of(ctx);
    let Some(asked) = &state.roles.asked else {
        return;
    };
    let asks_pin = match asked.question {
        RoleQuestion::MayI(_) => state.roles.pin.is_some(),
        RoleQuestion::NewPin | RoleQuestion::NewPinAgain(_) => true,
        RoleQuestion::RemovePin => false,
    };
    let (title, says, done) = match asked.question {
        RoleQuestion::MayI(_) if asks_pin => (
            text!("shell-engineers-view"),
            text!("shell-enter-pin"),
            text!("shell-unlock"),
        ),
        RoleQuestion::MayI(_) => (
            text!("shell-engineers-view"),
            text!("shell-may-change"),
            text!("shell-switch"),
        ),
        RoleQuestion::NewPin => (
            text!("shell-new-pin"),
            text!("shell-new-pin-says"),
            text!("shell-next"),
        ),
        RoleQuestion::NewPinAgain(_) => (
            text!("shell-new-pin"),
            text!("shell-same-digits"),
            text!("shell-set-the-pin"),
        ),
        RoleQuestion::RemovePin => (
            text!("shell-engineers-view"),
            text!("shell-remove-pin-asked"),
            text!("shell-remove-pin"),
        ),
    };
    if asks_pin {
        // Before the Enter of the same frame.
        typed(ctx, actions);
    }
    let modal = widgets::dialog(ctx, "role", |ui| {
        ui.set_max_width(3.0 * DIGIT[0] + 2.0 * ui.spacing().item_spacing.x);
        ui.heading(title);
        ui.weak(says);
        if asks_pin {
            pad(ui, &asked.digits, actions);
        }
        ui.add_space(space::SMALL);
        if let Some(wrong) = &asked.wrong {
            let text = RichText::new(wrong).font(font::body_strong());
            ui.label(text.color(theme.warning));
            if matches!(asked.question, RoleQuestion::MayI(_)) {
                let forgotten = text!("shell-pin-forgotten");
                ui.label(RichText::new(forgotten).small().weak());
            }
            ui.add_space(space::SMALL);
        }
        ui.horizontal(|ui| {
            if widgets::default_button(ui, &done, true) {
                actions.push(Action::Role(RoleAction::Enter));
            }
            if text_button(ui, &text!("shell-cancel")).clicked() {
                actions.push(Action::Role(RoleAction::Close));
            }
        });
    });
    if modal.should_close() {
        actions.push(Action::Role(RoleAction::Close));
    }
}

/// Draws the digits typed so far as dots, and the keypad.
fn pad(ui: &mut Ui, digits: &str, actions: &mut Vec<Action>) {
    ui.add_space(space::MEDIUM);
    let dots = "●".repeat(digits.len()) + &"·".repeat(MOST_DIGITS - digits.len());
    let shown = ui.label(RichText::new(dots).font(font::title()));
    shown.widget_info(|| {
        let says = text!("shell-num-digits", num = digits.len());
        egui::WidgetInfo::labeled(egui::Role::Label, true, says)
    });
    for row in ["123", "456", "789", " 0<"] {
        ui.horizontal(|ui| {
            for key in row.chars() {
                let (text, says, action) = match key {
                    ' ' => {
                        ui.add_space(DIGIT[0] + ui.spacing().item_spacing.x);
                        continue;
                    }
                    '<' => (
                        text!("shell-erase"),
                        text!("shell-erase"),
                        RoleAction::Erase,
                    ),
                    digit => (
                        digit.into(),
                        text!("shell-digit", digit = digit.to_string()),
                        RoleAction::Digit(digit),
                    ),
                };
                let button = ui.add_sized(vec2(DIGIT[0], DIGIT[1]), Button::new(text));
                button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &says));
                if button.clicked() {
                    actions.push(Action::Role(action));
                }
            }
        });
    }
}

/// Reads digits and keys from the keyboard.
fn typed(ctx: &Context, actions: &mut Vec<Action>) {
    ctx.input(|input| {
        for event in &input.events {
            match event {
                Event::Text(text) => {
                    let digits = text.chars().filter(char::is_ascii_digit);
                    actions.extend(digits.map(|d| Action::Role(RoleAction::Digit(d))));
                }
                Event::Key {
                    key: Key::Backspace,
                    pressed: true,
                    ..
                } => actions.push(Action::Role(RoleAction::Erase)),
                _ => {}
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        action::{DialogRequest, Event},
        apply::apply as apply_any,
        cell::{CheckAction, RobotAction},
        inspection::source::CellChoice,
        source::live::LiveAction,
    };
    use capture::{KinectSpec, SimulatedSpec, SourceSpec};

    fn write(state: &mut State, digits: &str) {
        for digit in digits.chars() {
            apply(state, RoleAction::Digit(digit));
        }
        apply(state, RoleAction::Enter);
    }

    fn with_pin(digits: &str) -> State {
        let mut state = State::default();
        apply(&mut state, RoleAction::SetPin);
        write(&mut state, digits);
        write(&mut state, digits);
        assert!(state.roles.pin.is_some());
        state
    }

    #[test]
    fn the_operators_view_changes_nothing_that_a_verdict_rests_on() {
        let mut state = State::default();
        apply(&mut state, RoleAction::Switch);
        let held_back = [
            Action::Robot(RobotAction::Forget),
            Action::Robot(RobotAction::Check(CheckAction::TakeBaseline)),
            Action::Robot(RobotAction::Check(CheckAction::Check)),
            Action::Press(WorkspaceKind::Compare, 0),
            Action::Ask(DialogRequest::Library),
            Action::Chosen(DialogRequest::Library, "other".into()),
            Action::TakeEmptyCell,
            Action::GoTo(WorkspaceKind::Enrol),
            Action::AskEngineer(WorkspaceKind::History),
        ];
        for action in held_back {
            state.roles.asked = None;
            let what = format!("{action:?}");
            assert!(apply_any(&mut state, action).is_none(), "{what}");
            assert!(state.roles.asked.is_some(), "{what}");
        }
        assert_eq!(
            (&state.session.chosen_library, state.session.workspace),
            (&None, WorkspaceKind::Inspect)
        );
        apply_any(&mut state, Action::Capture);
        assert!(state.inspector.running().is_some());
        assert!(apply_any(&mut state, Action::Tell(Event::Export)).is_some());
    }

    #[test]
    fn another_source_takes_the_engineer_if_there_is_a_pin() {
        let others = || {
            [
                Action::UseCell(CellChoice::InTurn),
                Action::Open("door.pcd".into()),
                Action::Ask(DialogRequest::Scene),
                Action::Chosen(DialogRequest::Recording, "recorded".into()),
                Action::Live(LiveAction::Use(SourceSpec::Kinect(KinectSpec::default()))),
                Action::Live(LiveAction::SetUp(Some(SimulatedSpec::default()))),
            ]
        };
        for has_pin in [false, true] {
            for action in others() {
                let mut state = if has_pin {
                    with_pin("2468")
                } else {
                    State::default()
                };
                state.session.role = UserRole::Operator;
                let what = format!("{action:?}");
                apply_any(&mut state, action);
                assert_eq!(state.roles.asked.is_some(), has_pin, "{what}");
            }
        }
    }

    #[test]
    fn the_pin_lets_in_and_what_was_asked_for_is_done_then() {
        let mut state = with_pin("2468");
        apply(&mut state, RoleAction::Lock);
        assert_eq!(state.session.role, UserRole::Operator);
        apply_any(&mut state, Action::GoTo(WorkspaceKind::Compare));
        write(&mut state, "2467");
        assert_eq!(state.session.role, UserRole::Operator);
        assert!(
            state
                .roles
                .asked
                .as_ref()
                .is_some_and(|a| a.wrong.is_some())
        );
        write(&mut state, "2468");
        assert_eq!(state.session.role, UserRole::Engineer);
        assert_eq!(state.session.workspace, WorkspaceKind::Compare);
        // Nothing is asked any more.
        let granted = apply_any(&mut state, Action::AskEngineer(WorkspaceKind::History));
        assert!(matches!(granted, Some(Action::AskEngineer(_))));
        // Compare is not for the operator.
        apply(&mut state, RoleAction::Lock);
        assert_eq!(state.session.workspace, WorkspaceKind::Inspect);
    }

    #[test]
    fn a_pin_is_written_twice_and_has_four_digits() {
        let mut state = State::default();
        apply(&mut state, RoleAction::SetPin);
        write(&mut state, "12");
        assert!(
            state
                .roles
                .asked
                .as_ref()
                .is_some_and(|a| a.wrong.is_some())
        );
        write(&mut state, "1234");
        write(&mut state, "1235");
        assert!(state.roles.pin.is_none());
        write(&mut state, "123456789");
        assert!(matches!(
            state.roles.asked.as_ref().map(|asked| &asked.question),
            Some(RoleQuestion::NewPinAgain(digits)) if digits == "12345678"
        ));
    }

    #[test]
    fn with_a_pin_the_window_starts_as_the_operators_and_locks_again() {
        let state = with_pin("1357");
        assert_eq!(state.roles.lock_timeout(state.session.role), Some(300.0));
        let mut state = State {
            roles: RoleState::starting(state.roles.pin, 15),
            ..State::default()
        };
        state.session.role = state.roles.first_role(UserRole::Engineer);
        assert_eq!(state.session.role, UserRole::Operator);
        assert_eq!(state.roles.lock_timeout(state.session.role), None);
        apply(&mut state, RoleAction::Switch);
        write(&mut state, "1357");
        assert_eq!(state.roles.lock_timeout(state.session.role), Some(900.0));
        apply(&mut state, RoleAction::RemovePin);
        assert!(state.roles.pin.is_some(), "it is asked");
        apply(&mut state, RoleAction::Enter);
        assert!(state.roles.pin.is_none());
        assert_eq!(state.roles.lock_timeout(state.session.role), None);
    }
}
