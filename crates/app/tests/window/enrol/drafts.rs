//! Drafts outlive the window, and no unsaved one is lost.

use std::fs;

use app::{
    WindowOptions,
    workspaces::enrol::{EnrolAction, EnrolWorkspace, draft::Field},
};
use egui_kittest::kittest::Queryable as _;
use shell::{action::Action, session::WorkspaceKind};
use simulate::{PartKind, Side};

use super::{capture, kept, library, names, notices, open, pass_time, write};
use crate::set_up::{USUAL, WindowHarness, act, act_in, enrol_of, open_with, plain_options, press};

#[test]
fn a_window_with_an_unsaved_draft_asks_before_it_closes() {
    let library = library();
    let mut harness = open(library.path());
    capture(&mut harness, PartKind::Grille, Side::Right);
    act(&mut harness, Action::Close);
    assert!(harness.query_by_label("Close without saving?").is_none());
    write(&mut harness, "Title", "Grille");
    for _ in 0..2 {
        act(&mut harness, Action::Close);
        harness.get_by_label("Close without saving?");
        harness.get_by_label("Grille, the part in Enrol, is not saved");
        press(&mut harness, "Keep the window open");
        assert!(harness.query_by_label("Close without saving?").is_none());
    }
    press(&mut harness, "Save");
    act(&mut harness, Action::Close);
    assert!(harness.query_by_label("Close without saving?").is_none());
}

#[test]
fn a_draft_outlives_a_program_that_is_killed_until_it_is_discarded_or_saved() {
    let (library, folder) = (library(), tempfile::tempdir().expect("a folder"));
    let file = folder.path().join("draft.json");
    let options = || WindowOptions {
        library: Some(library.path().to_owned()),
        settings: Some(folder.path().join("settings.toml")),
        ..plain_options()
    };
    let mut harness = open_with(USUAL, options());
    act(&mut harness, Action::GoTo(WorkspaceKind::Enrol));
    capture(&mut harness, PartKind::Grille, Side::Right);
    pass_time(&mut harness);
    assert!(!file.exists(), "nobody has worked on it");
    press(&mut harness, "Background 1, dropped");
    write(&mut harness, "Title", "Grille");
    pass_time(&mut harness);
    assert!(file.exists());
    let points = kept(&harness);
    // The window is dropped without being closed properly.
    drop(harness);

    let mut harness = open_with(USUAL, options());
    assert_eq!(kept(&harness), points);
    let draft = enrol_of(&harness).draft.as_ref().expect("a draft");
    assert_eq!(draft.form.name, "grille");
    let apply = |harness: &mut WindowHarness, action| {
        act_in(harness, |enrol: &mut EnrolWorkspace, cx| {
            enrol.state.apply(action, cx);
        });
        pass_time(harness);
    };
    apply(&mut harness, EnrolAction::Discard);
    assert!(!file.exists());
    apply(&mut harness, EnrolAction::Undo);
    assert!(file.exists());
    // With the wall it is not a valid part.
    apply(&mut harness, EnrolAction::Reset);
    assert!(file.exists(), "it still has a title");
    apply(&mut harness, EnrolAction::Save);
    assert_eq!(names(library.path()), ["grille"]);
    assert!(!file.exists());
    drop(harness);
    let harness = open_with(USUAL, options());
    assert!(enrol_of(&harness).draft.is_none());
}

#[test]
fn a_draft_is_written_when_the_window_closes_and_a_bad_one_is_set_aside() {
    let (library, folder) = (library(), tempfile::tempdir().expect("a folder"));
    let file = folder.path().join("draft.json");
    let options = || WindowOptions {
        library: Some(library.path().to_owned()),
        settings: Some(folder.path().join("settings.toml")),
        ..plain_options()
    };
    let mut harness = open_with(USUAL, options());
    act(&mut harness, Action::GoTo(WorkspaceKind::Enrol));
    capture(&mut harness, PartKind::Grille, Side::Right);
    act_in(&mut harness, |enrol: &mut EnrolWorkspace, cx| {
        let title = Field::Title("Grille".into());
        enrol.state.apply(EnrolAction::Write(title), cx);
    });
    eframe::App::on_exit(harness.state_mut());
    drop(harness);
    let text = fs::read_to_string(&file).expect("written");
    assert!(text.contains("Grille"), "{text}");

    fs::write(&file, &text[..text.len() / 2]).expect("written");
    let harness = open_with(USUAL, options());
    assert!(enrol_of(&harness).draft.is_none());
    let shown = notices(&harness);
    let is_shown = |what: &String| what.starts_with("The draft is not used: ");
    assert!(shown.iter().any(is_shown), "{shown:?}");
    let aside = folder.path().join("draft.broken-1.json");
    assert_eq!(
        fs::read_to_string(aside).expect("kept"),
        text[..text.len() / 2]
    );
}
