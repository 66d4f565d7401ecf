//! A frame of several parts: all of them are listed and recorded, and one is selected.

use std::{fs, path::Path, sync::Arc};

use app::{
    WindowOptions,
    workspaces::{
        history::{HistoryAction, HistoryWorkspace},
        inspect::{InspectAction, InspectFile, InspectWorkspace},
    },
};
use egui::{Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use files::write_depth_png;
use geometry::fixtures::small_frame;
use inspection::{
    fixtures::copy_library,
    library::{LibraryFolder, PartName, Truth},
    pipeline::Recipe,
};
use records::history::{HungId, StoredVerdict, Summary};
use shell::{action::Action, roles::RoleAction, session::Shown};
use simulate::{RackKind, RackSetup, rack_frame};

use super::{
    robot::{door_path, save_calibration},
    set_up::{
        SMALL, USUAL, WindowHarness, act, act_in, choose_in_inspect, history_of, open, open_with,
        plain_options, wait_until,
    },
};

/// Inspects up to three parts of a frame of three things.
pub(crate) fn open_rack(harness: &mut WindowHarness, folder: &Path) {
    use_recipe(harness, 0.9);
    open_three_things(harness, folder);
}

/// Writes a frame of a door, a radiator support and something that is not enrolled, and opens it.
pub(crate) fn open_three_things(harness: &mut WindowHarness, folder: &Path) {
    let setup = RackSetup::drawn(RackKind::Foreign, 3, 0, 4).expect("three places");
    let path = folder.join("rack.png");
    let rack = rack_frame(&setup).expect("a plain cell");
    write_depth_png(&path, &rack.frame).expect("written");
    act(harness, Action::Open(path));
}

fn use_recipe(harness: &mut WindowHarness, min_score: f64) {
    let mut recipe = Recipe::default();
    recipe.segment.max_parts = 3;
    recipe.accept.min_score = min_score;
    act_in(harness, |_: &mut InspectWorkspace, cx| {
        cx.send(Action::UseRecipe(Arc::new(recipe.into())));
    });
}

fn press_key(harness: &mut WindowHarness, key: Key) {
    harness.key_press(key);
    harness.run_steps(4);
}

fn click(harness: &mut WindowHarness, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(4);
}

fn shown(harness: &WindowHarness) -> &Shown {
    let shown = harness.state().state().session.shown.as_ref();
    shown.expect("a result")
}

fn hung(harness: &WindowHarness) -> Vec<HungId> {
    let parts = shown(harness).parts.iter();
    parts.map(|part| part.hung().clone()).collect()
}

/// Titles of the newest rows of the history, the newest first.
fn newest_rows(harness: &WindowHarness, num: usize) -> Vec<String> {
    let history = history_of(harness);
    let rows = (0..num).filter_map(|index| history.row(index));
    rows.map(|row| row.title.clone()).collect()
}

/// The row of the radiator support, or of what resembles it.
fn past(harness: &WindowHarness, verdict: StoredVerdict) -> Summary {
    let history = history_of(harness);
    let mut rows = (0..history.num_rows()).filter_map(|index| history.row(index));
    let row = rows.find(|row| row.title == "Radiator support" && row.verdict == verdict);
    row.expect("recorded").clone()
}

fn inspect_again(harness: &mut WindowHarness) {
    act_in(harness, |_: &mut InspectWorkspace, cx| {
        let title = "Inspecting again".into();
        cx.send(Action::InspectShown { title });
    });
}

fn act_in_history(harness: &mut WindowHarness, action: HistoryAction) {
    act_in(harness, |history: &mut HistoryWorkspace, cx| {
        history.apply(action, cx);
    });
}

fn enter_operators_view(harness: &mut WindowHarness) {
    act(harness, Action::Role(RoleAction::Switch));
}

const DOOR: &str = "1 Front door, left: Recognised";
const SUPPORT: &str = "2 Radiator support: Recognised";
const FOREIGN: &str = "3 Unknown part: Not accepted";

#[test]
fn all_parts_are_listed_and_recorded_and_the_selected_one_is_in_front() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open();
    assert!(harness.query_by_label_contains("accepted").is_none());
    let num_before = history_of(&harness).num_rows();
    open_rack(&mut harness, folder.path());
    harness.get_by_label("2 of 3 accepted");
    for label in [DOOR, SUPPORT, FOREIGN] {
        harness.get_by_label(label);
    }
    harness.get_by_label("Front door, left");
    assert_eq!(history_of(&harness).num_rows(), num_before + 3);
    let rows = newest_rows(&harness, 3);
    assert!(rows.contains(&"Front door, left".to_owned()), "{rows:?}");
    assert!(rows.contains(&"Radiator support".to_owned()), "{rows:?}");

    click(&mut harness, SUPPORT);
    harness.get_by_label("Radiator support");
    assert!(harness.query_by_label("Front door, left").is_none());
    let score = |harness: &WindowHarness| shown(harness).inspected.entry.record.summary.score;
    assert_eq!(
        score(&harness),
        shown(&harness).parts[1].entry.record.summary.score
    );
    let keys = [
        (Key::Period, 2),
        (Key::Period, 0),
        (Key::Comma, 2),
        (Key::Comma, 1),
    ];
    for (key, selected) in keys {
        press_key(&mut harness, key);
        assert_eq!(shown(&harness).selected(), selected);
    }
    press_key(&mut harness, Key::Period);
    harness.get_by_label("Unknown part");
    // What is selected is not accepted, but other parts hang there.
    act(&mut harness, Action::TakeEmptyCell);
    assert!(harness.state().state().session.empty_cell.is_none());
    // Selecting records nothing.
    assert_eq!(history_of(&harness).num_rows(), num_before + 3);
}

#[test]
fn an_empty_cell_of_another_camera_is_not_used_and_the_card_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open();
    let warning =
        "The empty cell is from another camera and is not used; capture it again with this one";
    let empty = folder.path().join("empty.png");
    write_depth_png(&empty, &small_frame(40, vec![2000; 1200])).expect("written");
    act(&mut harness, Action::Open(empty));
    act(&mut harness, Action::TakeEmptyCell);
    assert!(harness.state().state().session.empty_cell.is_some());
    assert!(harness.query_by_label(warning).is_none());
    open_three_things(&mut harness, folder.path());
    harness.get_by_label(warning);
}

#[test]
fn inspected_again_each_part_stays_what_it_was() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open();
    open_rack(&mut harness, folder.path());
    click(&mut harness, SUPPORT);
    let (before, num_before) = (hung(&harness), history_of(&harness).num_rows());
    // The door scores below this, and is listed after the other one.
    use_recipe(&mut harness, 0.99);
    inspect_again(&mut harness);
    harness.get_by_label("1 of 3 accepted");
    harness.get_by_label("1 Radiator support: Recognised");
    harness.get_by_label("Radiator support");
    let after = hung(&harness);
    assert_eq!(after[0], before[1]);
    assert!(before.iter().all(|part| after.contains(part)));
    assert_eq!(history_of(&harness).num_rows(), num_before);
}

#[test]
fn the_operator_sees_how_many_are_accepted_and_why_others_are_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let cell = folder.path().join("cell.toml");
    for is_calibrated in [false, true] {
        if is_calibrated {
            save_calibration(&cell);
        }
        let options = WindowOptions {
            cell: Some(cell.clone()),
            ..plain_options()
        };
        let mut harness = open_with(SMALL, options);
        open_rack(&mut harness, folder.path());
        enter_operators_view(&mut harness);
        harness.get_by_label("NOK");
        harness.get_by_label("2 of 3 recognised");
        harness.get_by_label("3 · Unknown part: No enrolled part resembles it");
        for label in [DOOR, SUPPORT] {
            harness.get_by_label(label);
        }
        click(&mut harness, FOREIGN);
        assert_eq!(shown(&harness).selected(), 2);
        harness.get_by_label("2 of 3 recognised");
    }
}

#[test]
fn a_part_that_was_reported_as_wrong_is_not_counted_while_another_is_selected() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open();
    open_rack(&mut harness, folder.path());
    let number = past(&harness, StoredVerdict::Accepted).number;
    act_in_history(
        &mut harness,
        HistoryAction::Label(number, Some(Truth::NotEnrolled)),
    );
    wait_until(&mut harness, |state| {
        !state.session.shift.labelled.is_empty()
    });
    harness.run_steps(4);
    assert_eq!(shown(&harness).selected(), 0);
    harness.get_by_label("1 of 3 accepted");
    harness.get_by_label("2 Radiator support: Reported as wrong");
    enter_operators_view(&mut harness);
    harness.get_by_label("1 of 3 recognised");
}

#[test]
fn a_past_part_is_opened_again_among_those_of_its_frame() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = || WindowOptions {
        history: Some(folder.path().join("history")),
        ..plain_options()
    };
    let mut harness = open_with(USUAL, options());
    open_rack(&mut harness, folder.path());
    drop(harness);
    let mut harness = open_with(USUAL, options());
    for (verdict, title) in [
        (StoredVerdict::Accepted, "Radiator support"),
        // What it resembles most.
        (StoredVerdict::Unknown, "Unknown part"),
    ] {
        let row = past(&harness, verdict);
        act_in_history(&mut harness, HistoryAction::Open(row.number));
        harness.get_by_label(title);
        assert_eq!(hung(&harness), [row.hung]);
    }
}

#[test]
fn a_robot_gets_files_of_the_selected_part_and_none_of_one_that_is_not_accepted() {
    let folder = tempfile::tempdir().expect("a folder");
    let (parts, cell) = (folder.path().join("parts"), folder.path().join("cell.toml"));
    copy_library(&parts);
    save_calibration(&cell);
    let library = LibraryFolder::open(&parts).expect("a library");
    for name in ["front_door", "radiator_support"] {
        let name = PartName::new(name).expect("a name");
        library
            .set_spray_path(&name, Some(&door_path()))
            .expect("stored");
    }
    let options = WindowOptions {
        library: Some(parts),
        cell: Some(cell),
        ..plain_options()
    };
    let mut harness = open_with(USUAL, options);
    open_rack(&mut harness, folder.path());
    let mut written = Vec::new();
    for (label, is_accepted) in [(DOOR, true), (SUPPORT, true), (FOREIGN, false)] {
        click(&mut harness, label);
        let path = folder.path().join(format!("{}.csv", written.len()));
        choose_in_inspect(&mut harness, InspectFile::SprayPath, path.clone());
        assert_eq!(path.exists(), is_accepted, "{label}");
        written.extend(fs::read_to_string(path).ok());
        let copy = harness.query_by_label("Copy pose");
        assert_eq!(copy.is_some(), is_accepted, "{label}");
        act(&mut harness, Action::DismissAll);
        act_in(&mut harness, |inspect: &mut InspectWorkspace, cx| {
            inspect.state.apply(InspectAction::CopyPose, cx);
        });
        let notices = &harness.state().state().notices;
        let is_copied = notices
            .iter()
            .any(|notice| notice.what.starts_with("Copied"));
        assert_eq!(is_copied, is_accepted, "{label}: {notices:?}");
    }
    assert_ne!(written[0], written[1]);
}

#[test]
fn the_list_fits_into_a_small_window_in_both_views() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(SMALL, plain_options());
    open_rack(&mut harness, folder.path());
    for _ in 0..2 {
        let mut num_rows = 0;
        for node in harness.get_all_by_role(Role::Button) {
            let label = node.accesskit_node().label().unwrap_or_default();
            let rect = node.rect();
            assert!(
                rect.width() >= 35.9 && rect.height() >= 35.9,
                "{label}: {rect:?}"
            );
            assert!(
                rect.max.x <= SMALL.x && rect.max.y <= SMALL.y,
                "{label}: {rect:?}"
            );
            num_rows += usize::from([DOOR, SUPPORT, FOREIGN].contains(&&*label));
        }
        assert_eq!(num_rows, 3);
        enter_operators_view(&mut harness);
    }
}
