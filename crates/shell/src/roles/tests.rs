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
