//! The roles of the window: operator and engineer.

use app::WindowOptions;
use egui::{Event, Key, Role};
use egui_kittest::kittest::Queryable as _;
use shell::{
    action::Action,
    notice::Notice,
    roles::{RoleAction, UserRole},
    session::{Source, WorkspaceKind},
    settings,
};

use super::operator::scan;
use super::set_up::{
    SMALL, USUAL, WindowHarness, act, open, open_with, plain_options, press, settle,
};

fn role(harness: &WindowHarness) -> UserRole {
    harness.state().state().session.role
}

/// Presses the buttons of these digits, then the one labelled `then`.
fn write(harness: &mut WindowHarness, digits: &str, then: &str) {
    for digit in digits.chars() {
        press(harness, &format!("Digit {digit}"));
    }
    press(harness, then);
}

fn set_pin(harness: &mut WindowHarness, digits: &str) {
    press(harness, "Engineer's view");
    press(harness, "Set a PIN…");
    write(harness, digits, "Next");
    write(harness, digits, "Set the PIN");
}

#[test]
fn the_operators_view_is_locked_and_unlocked_with_the_pin() {
    let mut harness = open_with(SMALL, plain_options());
    set_pin(&mut harness, "2580");
    press(&mut harness, "Engineer's view");
    press(&mut harness, "Operator's view");
    assert_eq!(role(&harness), UserRole::Operator);
    // By a key, as well as by the rail.
    harness.key_press(Key::Num3);
    harness.run_steps(4);
    assert_eq!(
        harness.state().state().session.workspace,
        WorkspaceKind::Inspect
    );
    write(&mut harness, "2589", "Unlock");
    assert!(harness.query_by_label("Wrong PIN").is_some());
    for digit in "2580".chars() {
        harness.event(Event::Text(digit.into()));
        harness.run_steps(2);
    }
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    // The digits were not shortcuts, and the requested action is done.
    assert_eq!(role(&harness), UserRole::Engineer);
    assert_eq!(
        harness.state().state().session.workspace,
        WorkspaceKind::Compare
    );
}

#[test]
fn a_pin_may_be_typed_as_quickly_as_a_scan_and_a_longer_code_is_none() {
    let mut harness = open();
    set_pin(&mut harness, "2580");
    act(&mut harness, Action::Role(RoleAction::Lock));
    press(&mut harness, "Engineer's view");
    scan(&mut harness, "9900123456");
    assert!(harness.query_by_label("Wrong PIN").is_none());
    assert_eq!(role(&harness), UserRole::Operator);
    scan(&mut harness, "2580");
    assert_eq!(role(&harness), UserRole::Engineer);
}

#[test]
fn without_a_pin_a_yes_is_enough() {
    let mut harness = open();
    act(&mut harness, Action::Role(RoleAction::Switch));
    harness.key_press(Key::Num2);
    harness.run_steps(4);
    assert_eq!(
        harness.state().state().session.workspace,
        WorkspaceKind::Inspect
    );
    press(&mut harness, "Cancel");
    press(&mut harness, "Engineer's view");
    press(&mut harness, "Switch");
    assert_eq!(role(&harness), UserRole::Engineer);
}

#[test]
fn the_rail_leads_the_operator_where_they_may_go_and_keys_still_ask() {
    let mut harness = open();
    let tabs = |harness: &WindowHarness| {
        let kinds = WorkspaceKind::ALL.into_iter();
        let listed = kinds.filter(|kind| {
            let title = kind.title();
            harness.query_by_role_and_label(Role::Tab, &title).is_some()
        });
        listed.collect::<Vec<_>>()
    };
    assert_eq!(tabs(&harness), WorkspaceKind::ALL);
    act(&mut harness, Action::Role(RoleAction::Switch));
    press(&mut harness, "History");
    let operators = [WorkspaceKind::Inspect, WorkspaceKind::History];
    assert_eq!(tabs(&harness), operators);
    harness.key_press(Key::Num2);
    harness.run_steps(4);
    press(&mut harness, "Cancel");
    let front = harness.state().state().session.workspace;
    assert_eq!(front, WorkspaceKind::History);
    // At the foot of the rail.
    press(&mut harness, "Operator's view");
    press(&mut harness, "Switch");
    assert_eq!(role(&harness), UserRole::Engineer);
    assert_eq!(tabs(&harness), WorkspaceKind::ALL);
}

#[test]
fn an_untouched_window_is_the_operators_again() {
    let mut harness = open();
    set_pin(&mut harness, "1111");
    act(&mut harness, Action::GoTo(WorkspaceKind::Enrol));
    act(&mut harness, Action::Role(RoleAction::LockAfter(1)));
    let now = harness.ctx.input(|input| input.time);
    let mut at = |seconds: f64| {
        harness.input_mut().time = Some(now + seconds);
        harness.step();
        role(&harness)
    };
    assert_eq!(at(30.0), UserRole::Engineer);
    assert_eq!(at(80.0), UserRole::Operator);
    assert_eq!(
        harness.state().state().session.workspace,
        WorkspaceKind::Inspect
    );
}

#[test]
fn with_a_pin_the_next_start_is_the_operators() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("settings.toml");
    let options = || WindowOptions {
        settings: Some(path.clone()),
        ..plain_options()
    };
    let mut harness = open_with(USUAL, options());
    act(&mut harness, Action::GoTo(WorkspaceKind::Compare));
    set_pin(&mut harness, "9753");
    let remembered = settings::Settings::of(harness.state().state(), None);
    settings::save(&path, &remembered).expect("saved");
    drop(harness);
    assert!(
        !std::fs::read_to_string(&path)
            .expect("read")
            .contains("9753")
    );
    let harness = open_with(USUAL, options());
    assert_eq!(role(&harness), UserRole::Operator);
    assert_eq!(
        harness.state().state().session.workspace,
        WorkspaceKind::Inspect
    );
}

#[test]
fn enter_presses_the_button_that_a_dialog_proposes() {
    let mut harness = open();
    act(&mut harness, Action::Role(RoleAction::Switch));
    press(&mut harness, "Engineer's view");
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    assert_eq!(role(&harness), UserRole::Engineer);
    harness.key_press(Key::F1);
    harness.run_steps(4);
    harness.get_by_label("Shortcuts");
    harness.key_press(Key::Escape);
    harness.run_steps(4);
    assert!(harness.query_by_label("Shortcuts").is_none());
    act(&mut harness, Action::GoTo(WorkspaceKind::History));
    press(&mut harness, "Frames…");
    // The Enter that ends the typing of a number belongs to its field.
    harness
        .get_by_role_and_label(egui::Role::SpinButton, "At most, days")
        .click();
    harness.run_steps(4);
    harness.event(Event::Text("9".into()));
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(4);
    harness.get_by_label("Apply");
    harness.key_press(Key::Enter);
    settle(&mut harness);
    assert!(harness.query_by_label("Apply").is_none());
}

#[test]
fn another_source_is_the_engineers_to_choose() {
    let mut harness = open();
    set_pin(&mut harness, "2580");
    act(&mut harness, Action::Role(RoleAction::Lock));
    act(&mut harness, Action::GoTo(WorkspaceKind::History));
    harness.get_by_label_contains("Source · ").click();
    harness.run_steps(8);
    // The list names where its entries came from.
    let mut cells = harness.get_all_by_label("Simulated cell");
    cells.next().expect("the entry of the menu").click();
    drop(cells);
    harness.run_steps(4);
    harness.get_by_label("Radiator support").click();
    settle(&mut harness);
    let source = |harness: &WindowHarness| harness.state().state().session.source.clone();
    assert_eq!(source(&harness), Source::default());
    write(&mut harness, "2580", "Unlock");
    assert_ne!(source(&harness), Source::default());
}

#[test]
fn whoever_forgot_the_pin_is_sent_to_the_engineer() {
    let mut harness = open();
    set_pin(&mut harness, "2580");
    act(&mut harness, Action::Role(RoleAction::Lock));
    act(&mut harness, Action::Role(RoleAction::Switch));
    write(&mut harness, "2589", "Unlock");
    harness.get_by_label("Forgotten? Ask the engineer");
}

#[test]
fn notices_of_the_engineer_do_not_stay_in_the_operators_view() {
    let mut harness = open();
    act(
        &mut harness,
        Action::Notify(Notice::look("The recipe is odd", "Change the threshold")),
    );
    harness.get_by_label("Change the threshold");
    act(&mut harness, Action::Role(RoleAction::Switch));
    assert!(harness.query_by_label("Change the threshold").is_none());
}
