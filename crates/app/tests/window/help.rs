//! Help: its search, the guide in it, and problem reports.

use egui::Role;
use egui_kittest::kittest::Queryable as _;
use files::{read_bytes, read_zip};
use shell::{
    action::{Action, DialogRequest},
    cell::ServoSettings,
    notice::Notice,
    session::ThemeChoice,
};

use crate::set_up::{SMALL, WindowHarness, act, open, open_with, plain_options, settle};

/// Opens Help and searches for this.
fn search(harness: &mut WindowHarness, text: &str) {
    act(harness, Action::ToggleHelp);
    let field = harness.get_by_role_and_label(Role::TextInput, "Search keys and guide");
    field.type_text(text);
    settle(harness);
}

#[test]
fn an_action_that_was_searched_for_is_done_and_closes_help() {
    let mut harness = open();
    search(&mut harness, "light DARK");
    harness.get_by_label("Dark or light").click();
    settle(&mut harness);
    let state = harness.state().state();
    assert_eq!(state.session.theme, ThemeChoice::Light);
    assert!(state.help.is_none());
    search(&mut harness, "xyzzy");
    harness.get_by_label_contains("Nothing found");
}

#[test]
fn a_section_of_the_guide_that_was_searched_for_is_in_sight() {
    let mut harness = open_with(SMALL, plain_options());
    search(&mut harness, "where your data is");
    harness
        .get_by_label("Quick start › Where your data is")
        .click();
    settle(&mut harness);
    // Scrolling takes a moment.
    harness.run_steps(60);
    let heading = harness.get_by_label("Where your data is").rect();
    let close = harness.get_by_label("Close").rect();
    assert!(
        heading.top() > 80.0 && heading.bottom() < close.top(),
        "{heading}"
    );
    // So is a page by its title.
    act(&mut harness, Action::ToggleHelp);
    search(&mut harness, "poses for a robot");
    harness.get_by_label("Poses for a robot").click();
    settle(&mut harness);
    let place = harness.state().state().help.as_ref().map(|help| help.place);
    assert!(place.is_some_and(|place| place.page != 0), "{place:?}");
}

#[test]
fn a_problem_report_holds_scene_and_library_entry_and_no_address() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("problem.zip");
    let mut harness = open();
    let servo = ServoSettings {
        address: "192.168.7.9".into(),
        ..ServoSettings::default()
    };
    act(&mut harness, Action::UseServoSettings(servo));
    let silent = Notice::look("192.168.7.9:30100 is silent", "Look at its cable");
    act(&mut harness, Action::Notify(silent));
    act(
        &mut harness,
        Action::Chosen(DialogRequest::ProblemReport, path.clone()),
    );
    harness.get_by_label_contains("Wrote ");
    let files = read_zip(&read_bytes(&path).expect("written"));
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    for name in [
        "scene/scene.png",
        "scene/intrinsics.json",
        "library/front_door/cloud.ply",
        "recipe.toml",
        "inspection.json",
        "settings.toml",
        "log.txt",
    ] {
        assert!(names.contains(&name), "{name} in {names:?}");
    }
    let (_, log) = files
        .iter()
        .find(|(name, _)| name == "log.txt")
        .expect("there");
    let log = String::from_utf8_lossy(log);
    assert!(
        log.ends_with("(address):30100 is silent Look at its cable"),
        "{log}"
    );
    for (name, content) in &files {
        let content = String::from_utf8_lossy(content);
        assert!(!content.contains("192.168.7.9"), "{name}");
    }
}
