//! The check of the cell in the window: its baseline, its checks, and what it shows to an operator.

use std::path::Path;

use app::WindowOptions;
use egui::Role;
use egui_kittest::kittest::Queryable as _;
use shell::action::Action;

use stages::fixtures::save_fender_view;

use super::{
    operator::open_operators,
    set_up::{USUAL, WindowHarness, act, open, open_with, plain_options, press},
};

/// Options of a window that stores baseline and checks in this folder.
fn keeping(folder: &Path) -> WindowOptions {
    WindowOptions {
        cell_checks: Some(folder.join("cell-check")),
        ..plain_options()
    }
}

/// Opens the dialog at the page of the check.
fn turn_to_check(harness: &mut WindowHarness) {
    press(harness, "Robot…");
    press(harness, "Check of the cell");
}

fn count(harness: &WindowHarness, label: &str) -> usize {
    harness.query_all_by_label(label).count()
}

const IN_PLACE: &str = "Camera and part are in place, simulated";

#[test]
fn a_baseline_is_taken_compared_with_and_replaced() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, keeping(folder.path()));
    turn_to_check(&mut harness);
    harness.get_by_label("There is no baseline to compare with");
    for label in ["Allowed shift, mm", "Allowed turn, degrees"] {
        harness.get_by_role_and_label(Role::SpinButton, label);
    }
    press(&mut harness, "Take baseline");
    assert_eq!(count(&harness, "There is no baseline to compare with"), 0);
    harness.get_by_label("5.0 mm and 0.50°");
    assert_eq!(count(&harness, IN_PLACE), 0);
    for num in 1..=2 {
        press(&mut harness, "Check now");
        // The label is in the finding, and in each row of the list.
        assert_eq!(count(&harness, IN_PLACE), 1 + num);
        let checks = if num == 1 { "check" } else { "checks" };
        harness.get_by_label(&format!("Last {num} of {num} {checks}"));
    }
    harness.get_by_label("Nothing needs to be done");
    // One for the part, and one for wall and floor.
    let beside_limit = harness.query_all_by_label_contains(" mm, allowed 5.0 mm");
    assert_eq!(beside_limit.count(), 2);
    harness.get_by_label_contains("Shift since the baseline");

    press(&mut harness, "Take a new baseline…");
    harness.get_by_label_contains("Replace the baseline?");
    press(&mut harness, "Keep it");
    assert_eq!(count(&harness, IN_PLACE), 3);
    press(&mut harness, "Take a new baseline…");
    press(&mut harness, "Replace it");
    // Former checks do not count for the new baseline.
    assert_eq!(count(&harness, IN_PLACE), 2);
    assert_eq!(count(&harness, "Last check"), 0);
    drop(harness);

    let mut harness = open_with(USUAL, keeping(folder.path()));
    turn_to_check(&mut harness);
    harness.get_by_label("Last 2 of 2 checks");
}

#[test]
fn an_operator_is_warned_only_while_the_last_check_found_that_something_moved() {
    let folder = tempfile::tempdir().expect("a folder");
    let captures = [0.0, 0.02, 0.0].into_iter().zip(1..);
    let captures = captures.map(|(back, noise)| {
        let path = folder.path().join(format!("{noise}.pcd"));
        save_fender_view(&path, noise, back);
        path
    });
    let captures: Vec<_> = captures.collect();
    let check = |capture: &Path, button: &str, finding: &str| {
        let mut harness = open_with(USUAL, keeping(folder.path()));
        act(&mut harness, Action::Open(capture.to_owned()));
        turn_to_check(&mut harness);
        press(&mut harness, button);
        assert!(count(&harness, finding) > 0, "{finding}");
    };
    let is_warned = || {
        let harness = open_operators(keeping(folder.path()));
        let notices = &harness.state().state().notices;
        let mut words = notices.iter().map(|notice| notice.what.as_str());
        words.any(|what| what.contains("the camera moved, simulated"))
    };
    assert!(!is_warned());
    check(&captures[0], "Take baseline", "baseline");
    assert!(!is_warned());
    check(&captures[1], "Check now", "The camera moved, simulated");
    assert!(is_warned());
    check(&captures[2], "Check now", IN_PLACE);
    assert!(!is_warned());
}

#[test]
fn without_a_folder_of_its_own_the_page_says_so() {
    let mut harness = open();
    turn_to_check(&mut harness);
    harness.get_by_label("There is no folder for the baseline and the checks");
    assert_eq!(count(&harness, "Take baseline"), 0);
}
