//! The operator's view: the part, OK or not, what to do next, and the parts of this shift.

use std::{
    path::{Path, PathBuf},
    sync::mpsc::Sender,
};

use app::{
    WindowOptions,
    workspaces::history::{HistoryAction, HistoryWorkspace},
};
use egui::{Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use files::save_cloud;
use inspection::pipeline::Rejection;
use records::history::{Retention, StoredVerdict};
use shell::{
    action::Action,
    cell::{AnswerSetup, RobotAction},
    inspection::source::CellChoice,
    notice::Notice,
    roles::RoleAction,
    session::{Source, UserRole, WorkspaceKind},
    settings,
};
use simulate::{CellSetup, PartKind, SensorNoise, Side, SimulatedObject};
use ui::language::Language;

use records::fixtures::{history_entry, open_history, refuse};
use stages::fixtures::{facing_part, scene_of};

use super::{
    live::{Step, robot_options, sees, toggle, wired_options},
    robot::save_calibration,
    set_up::{
        SMALL, USUAL, WindowHarness, act, act_in, drop_file, history_of, is_recognised, let_pass,
        open, open_with, plain_options, press, settle, wait_for, wait_until, watch_folder,
    },
};

/// Opens a window in the operator's view.
pub(crate) fn open_operators(options: WindowOptions) -> WindowHarness {
    let mut harness = open_with(SMALL, options);
    act(&mut harness, Action::Role(RoleAction::Switch));
    assert_eq!(harness.state().state().session.role, UserRole::Operator);
    harness
}

fn shows(harness: &WindowHarness, text: &str) -> bool {
    harness.query_all_by_label_contains(text).next().is_some()
}

/// Writes a capture of a part of the other side, which is not enrolled.
pub(crate) fn write_unknown(path: &Path) {
    let scene = facing_part(PartKind::Fender, Side::Right, 5);
    save_cloud(path, &scene.cloud).expect("written");
}

#[test]
fn the_operator_sees_part_verdict_and_next_step_and_no_figures() {
    let mut harness = open();
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::K);
    let_pass(&mut harness, 12);
    // The banner has it large; the list has it smaller.
    let names = harness.query_all_by_label("Front door, left");
    let heights: Vec<f32> = names.map(|node| node.rect().height()).collect();
    assert!(heights.iter().any(|height| *height > 60.0), "{heights:?}");
    assert!(harness.get_by_label("Recognised").rect().height() > 40.0);
    harness.get_by_label("Next");
    harness.get_by_label("Simulated: no camera was read");
    harness.get_by_label("Ask the engineer to choose a camera");
    harness.get_by_label("3-D view of the scene");
    let figures = [
        "rms",
        "overlap",
        "iterations",
        "Score",
        "Convention",
        "Enlarge",
    ];
    for figure in figures {
        assert!(!shows(&harness, figure), "{figure}");
    }
    press(&mut harness, "Engineer's view");
    press(&mut harness, "Switch");
    for figure in figures {
        assert!(shows(&harness, figure), "{figure}");
    }
}

#[test]
fn the_list_of_keys_has_only_those_that_act_in_the_operators_view() {
    let mut harness = open_operators(plain_options());
    act(&mut harness, Action::ToggleHelp);
    for does in [
        "Capture, and inspect or enrol it",
        "Dark or light",
        "History",
    ] {
        assert!(shows(&harness, does), "{does}");
    }
    for does in [
        "Record the source, or stop",
        "The robot's cell: where the camera sits",
        "Millimetres and degrees, or metres and radians",
        "Save a picture of the 3-D view",
        "Compare",
    ] {
        assert!(!shows(&harness, does), "{does}");
    }
    act(&mut harness, Action::ToggleHelp);
    act(&mut harness, Action::Role(RoleAction::Switch));
    press(&mut harness, "Switch");
    act(&mut harness, Action::ToggleHelp);
    harness.get_by_label("Ctrl + − 0");
    harness.get_by_label("Record the source, or stop");
}

#[test]
fn a_good_part_carries_no_warning_in_either_view() {
    let mut harness = open();
    harness.get_by_label("Recognised");
    assert!(!shows(&harness, "the pose to the path"));
    harness.key_press(Key::N);
    harness.run_steps(2);
    harness.get_by_label("The robot program must apply the pose to the path");
    assert!(!shows(&harness, "Move the path by the pose first"));
    act(&mut harness, Action::Role(RoleAction::Switch));
    assert!(!shows(&harness, "the pose to the path"));
}

#[test]
fn the_parts_of_this_shift_are_counted_and_what_is_only_tried_is_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("history");
    // One that hung in the cell before the window was opened.
    let mut refused = history_entry(1, StoredVerdict::Rejected, "fender");
    refused.record.summary.at = geometry::clock::now();
    let mut history = open_history(&place);
    history
        .add(&refused, &Retention::default())
        .expect("written");
    drop(history);
    let (options, wire) = wired_options();
    let mut harness = open_operators(WindowOptions {
        history: Some(place.clone()),
        ..options
    });
    let counts = |harness: &WindowHarness, counts: [&str; 3]| {
        for count in counts {
            harness.get_by_label(count);
        }
    };
    let before = ["1 part", "0 OK", "1 NOK"];
    counts(&harness, before);
    assert!(shows(&harness, "Shift since "));
    harness.get_by_label("Not recognised");
    // The start of the window, a capture of the cell and an opened file are no parts of the shift.
    press(&mut harness, "Capture");
    let path = folder.path().join("other.pcd");
    write_unknown(&path);
    drop_file(&mut harness, &path);
    harness.get_by_label("NOK");
    counts(&harness, before);
    assert!(shows(&harness, "\nSimulated cell"), "whose parts these are");
    act(&mut harness, Action::UseCell(CellChoice::InTurn));
    counts(&harness, before);
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0; 22]);
    wait_until(&mut harness, |state| state.session.shift.num_ok == 1);
    harness.run_steps(2);
    counts(&harness, ["2 parts", "1 OK", "1 NOK"]);
    // The banner and the list name it.
    assert_eq!(harness.query_all_by_label("Fender, left").count(), 2);
    toggle(&mut harness);
    settle(&mut harness);
    drop(harness);
    // The parts are read from the history, not kept by the window.
    let mut harness = open_operators(WindowOptions {
        history: Some(place),
        ..plain_options()
    });
    counts(&harness, ["2 parts", "1 OK", "1 NOK"]);
    press(&mut harness, "History");
    harness.get_by_label("7 of 7 entries");
    // The statistics count the same parts.
    press(&mut harness, "Statistics");
    harness.get_by_label_contains(": 1 OK, 1 NOK");
    harness.get_by_label("Source: Simulated cell");
    harness.get_by_label("Inspect").click();
    harness.run_steps(4);
    harness.get_by_label("Recognised");
}

#[test]
fn the_serial_number_of_a_vehicle_is_readable_in_a_small_window() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut history = open_history(folder.path());
    let vehicle = "WVWZZZ1JZXW000017";
    let long = format!("{vehicle}/{vehicle}/{vehicle}");
    for serial in [vehicle, long.as_str()] {
        let mut part = history_entry(1, StoredVerdict::Accepted, "radiator_support");
        part.record.summary.at = geometry::clock::now();
        part.record.summary.trace.serial = serial.into();
        history.add(&part, &Retention::default()).expect("written");
    }
    drop(history);
    let harness = open_operators(WindowOptions {
        history: Some(folder.path().to_owned()),
        ..plain_options()
    });
    harness.get_by_label(vehicle);
    // What does not fit is cut in the middle.
    assert!(harness.query_by_label(&long).is_none());
    let num_shown = harness.query_all_by_label_contains("000017").count();
    assert_eq!(num_shown, 2);
}

#[test]
fn the_list_of_parts_says_of_which_part_something_is_the_mirror_image() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut history = open_history(folder.path());
    let mut part = history_entry(1, StoredVerdict::Unknown, "fender");
    part.record.summary.at = geometry::clock::now();
    part.record.summary.title = "Fender, left".into();
    let mirrored = Rejection::Mirrored {
        part: "fender".into(),
        score: 0.9,
    };
    refuse(&mut part, mirrored);
    part.record.summary.trace.serial = "TL471".into();
    history.add(&part, &Retention::default()).expect("written");
    drop(history);
    for (language, named) in [
        (Language::English, "Mirror image of Fender, left"),
        (Language::German, "Spiegelbild von Fender, left"),
        (Language::Spanish, "Imagen reflejada de Fender, left"),
        (Language::Chinese, "“Fender, left”的镜像"),
    ] {
        let harness = open_operators(WindowOptions {
            history: Some(folder.path().to_owned()),
            language: Some(language),
            ..plain_options()
        });
        harness.get_by_label(named);
        harness.get_by_label("TL471");
    }
}

#[test]
fn the_view_is_remembered_without_a_pin_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("settings.toml");
    let options = || WindowOptions {
        settings: Some(path.clone()),
        ..plain_options()
    };
    let harness = open_operators(options());
    let remembered = settings::Settings::of(harness.state().state(), None);
    settings::save(&path, &remembered).expect("saved");
    drop(harness);
    let harness = open_with(USUAL, options());
    assert_eq!(harness.state().state().session.role, UserRole::Operator);
    harness.get_by_label("Recognised");
}

#[test]
fn without_a_result_the_operator_is_told_what_to_do() {
    let folder = tempfile::tempdir().expect("a folder");
    let empty = WindowOptions {
        library: Some(folder.path().to_owned()),
        ..WindowOptions::default()
    };
    let harness = open_operators(empty);
    harness.get_by_label("Ask the engineer to enrol the parts");
    assert!(!shows(&harness, "NOK") || shows(&harness, "0 NOK"));

    // The last part was accepted; this capture fails.
    let mut harness = open_operators(plain_options());
    harness.get_by_label("Recognised");
    let broken = folder.path().join("broken.pcd");
    std::fs::write(&broken, "no cloud").expect("written");
    drop_file(&mut harness, &broken);
    harness.get_by_label("No result");
    assert!(!is_recognised(&harness));
    harness.key_press(Key::T);
    harness.run_steps(2);
    harness.get_by_label("No result");
}

#[test]
fn what_is_followed_is_good_only_while_its_verdict_counts() {
    let folder = tempfile::tempdir().expect("a folder");
    let (options, wire) = robot_options(folder.path());
    let mut harness = open_operators(options);
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0; 4]);
    harness.get_by_label("Looking");
    assert!(!is_recognised(&harness));
    sees(&mut harness, &wire, [0.0; 12]);
    harness.get_by_label("OK");
    assert!(shows(&harness, "tart the robot"));
    assert!(shows(&harness, "Live · steady"));
    sees(&mut harness, &wire, [0.03, 0.06]);
    harness.get_by_label("Moving");
    assert!(!is_recognised(&harness));
    wire.send(Step::Unplugged).expect("the camera is open");
    wait_until(&mut harness, |state| {
        let status = state.session.live.status.as_ref();
        status.is_some_and(|status| {
            matches!(status.source, shell::source::live::SourceState::Lost(_))
        })
    });
    harness.run_steps(2);
    harness.get_by_label("No camera");
}

#[test]
fn a_source_that_has_delivered_nothing_has_no_verdict() {
    let folder = tempfile::tempdir().expect("a folder");
    let (options, wire) = wired_options();
    let mut harness = open_operators(options);
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0; 22]);
    harness.get_by_label("Recognised");
    watch_folder(&mut harness, folder.path());
    harness.run_steps(2);
    harness.get_by_label("Waiting for a new file");
    harness.get_by_label("Save a capture to the folder: it is inspected automatically");
    assert!(!is_recognised(&harness));
    // Nor has it one when nobody waits any longer.
    toggle(&mut harness);
    settle(&mut harness);
    harness.get_by_label("Press Live or Capture for the current part");
    assert!(!is_recognised(&harness));
}

#[test]
fn an_ok_of_live_is_gone_once_live_is_off_until_the_next_capture() {
    let folder = tempfile::tempdir().expect("a folder");
    let (options, wire) = robot_options(folder.path());
    let mut harness = open_operators(options);
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0; 22]);
    harness.get_by_label("OK");
    // The engineer reads the same, and may give it to a robot.
    let switch = |harness: &mut WindowHarness, action| {
        let context = harness.ctx.clone();
        harness.state_mut().act(Action::Role(action), &context);
        harness.run_steps(4);
    };
    switch(&mut harness, RoleAction::Switch);
    harness.get_by_label("Switch").click();
    harness.run_steps(4);
    harness.get_by_label("Accepted");
    harness.get_by_label("robot_from_part");
    let can_copy = |harness: &WindowHarness| {
        let copy = harness.get_by_label("Copy pose");
        !copy.accesskit_node().is_disabled()
    };
    assert!(can_copy(&harness));
    switch(&mut harness, RoleAction::Switch);
    toggle(&mut harness);
    settle(&mut harness);
    assert!(!is_recognised(&harness));
    harness.get_by_label("No verdict");
    harness.get_by_label("The last verdict no longer counts");
    harness.get_by_label("Press Live or Capture for the current part");
    // The engineer still looks at it, but nothing is given to a robot.
    act(&mut harness, Action::Role(RoleAction::Switch));
    press(&mut harness, "Switch");
    assert!(harness.query_by_label("Accepted").is_none());
    harness.get_by_label("Recognised");
    harness.get_by_label("Another part may hang there by now");
    harness.get_by_label("Press Live or Capture for the current part");
    assert!(harness.query_by_label("robot_from_part").is_none());
    harness.get_by_label("camera_from_part");
    assert!(!can_copy(&harness));
    harness.key_press_modifiers(egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, Key::C);
    harness.run_steps(4);
    assert!(!shows(&harness, "Copied"));
    assert!(!shows(&harness, "Previous result"));
    act(&mut harness, Action::Role(RoleAction::Switch));
    let door = CellChoice::Part(PartKind::FrontDoor, Side::Left);
    act(&mut harness, Action::UseCell(door));
    harness.get_by_label("Recognised");
    assert!(!shows(&harness, "no longer counts"));
}

#[test]
fn without_a_calibration_the_operator_is_not_told_to_start_the_robot() {
    let folder = tempfile::tempdir().expect("a folder");
    let (options, wire) = robot_options(folder.path());
    let mut harness = open_operators(WindowOptions {
        cell: None,
        ..options
    });
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0; 22]);
    harness.get_by_label("Recognised");
    harness.get_by_label("Not calibrated: the robot gets no pose");
    harness.get_by_label("Do not start the robot: call the engineer to calibrate the cell");
    assert!(harness.query_by_label("OK").is_none());
}

#[test]
fn a_past_inspection_that_ends_live_says_so_and_live_is_a_way_back() {
    let (options, wire) = wired_options();
    let mut harness = open_operators(options);
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0; 22]);
    let number = history_of(&harness).row(0).expect("listed").number;
    act_in(&mut harness, |history: &mut HistoryWorkspace, cx| {
        history.apply(HistoryAction::InspectAgain(number), cx);
    });
    assert!(!harness.state().state().session.is_live());
    assert!(shows(&harness, "Live stopped: a past inspection"));
    harness.get_by_label("Press Live or Capture for the current part");
}

#[test]
fn its_controls_are_large_labelled_and_inside_a_small_window() {
    let mut harness = open_operators(plain_options());
    harness.run_steps(4);
    let mut num_controls = 0;
    for node in harness.get_all_by_role(egui::Role::Button) {
        let label = node.accesskit_node().label().unwrap_or_default();
        let rect = node.rect();
        assert!(!label.is_empty(), "a control at {rect:?} has no label");
        assert!(
            rect.width() >= 35.9 && rect.height() >= 35.9,
            "{label}: {rect:?}"
        );
        let window = egui::Rect::from_min_size(egui::Pos2::ZERO, SMALL);
        assert!(window.expand(0.5).contains_rect(rect), "{label}: {rect:?}");
        num_controls += 1;
    }
    assert!(num_controls >= 5, "{num_controls} controls");
}

#[test]
fn a_file_that_is_opened_again_is_no_other_part_unless_it_was_written_since() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("fender.pcd");
    let write = |seed| {
        let scene = facing_part(PartKind::Fender, Side::Left, seed);
        save_cloud(&path, &scene.cloud).expect("written");
    };
    write(5);
    let start = || {
        open_operators(WindowOptions {
            history: Some(folder.path().join("history")),
            scene: Some(path.clone()),
            ..plain_options()
        })
    };
    let num_parts = |harness: &WindowHarness| history_of(harness).num_rows();
    let mut harness = start();
    assert_eq!(num_parts(&harness), 1);
    press(&mut harness, "Capture");
    assert_eq!(num_parts(&harness), 1);
    drop(harness);
    let harness = start();
    harness.get_by_label("Recognised");
    assert_eq!(num_parts(&harness), 1);
    drop(harness);
    // The rewritten file shows another part, also while the window is open.
    write(6);
    let mut harness = start();
    assert_eq!(num_parts(&harness), 2);
    write(7);
    press(&mut harness, "Capture");
    assert_eq!(num_parts(&harness), 3);
}

#[test]
fn the_operator_is_not_told_to_do_what_only_the_engineer_can() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_operators(plain_options());
    let path = folder.path().join("other.pcd");
    write_unknown(&path);
    drop_file(&mut harness, &path);
    harness.get_by_label("NOK");
    assert!(shows(&harness, "sk the engineer to enrol"));
    assert!(!shows(&harness, "Enrol the part"));
}

/// Types a code as a scanner does, with Enter at its end.
pub(crate) fn scan(harness: &mut WindowHarness, code: &str) {
    for letter in code.chars() {
        let key = Key::from_name(&letter.to_string()).expect("a key");
        harness.input_mut().events.push(egui::Event::Key {
            key,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers: egui::Modifiers::NONE,
        });
        let text = egui::Event::Text(letter.into());
        harness.input_mut().events.push(text);
    }
    harness.key_press(Key::Enter);
    harness.run_steps(4);
}

/// Lets the time pass within which a serial number can be moved to the next part.
pub(crate) fn pass_time(harness: &mut WindowHarness) {
    let time = harness.ctx.input(|input| input.time) + 31.0;
    harness.input_mut().time = Some(time);
    harness.step();
    harness.input_mut().time = None;
}

/// Waits until the row at this index of the history has this serial number.
pub(crate) fn wait_for_serial(harness: &mut WindowHarness, index: usize, serial: &str) {
    wait_for(harness, |window| {
        let history = window.workspace::<HistoryWorkspace>().expect("there");
        let row = history.state.row(index);
        row.is_some_and(|row| row.trace.serial == serial)
    });
}

#[test]
fn a_serial_number_scanned_after_the_verdict_is_of_the_part_that_hangs_there_and_the_next_is_not() {
    let (options, wire) = wired_options();
    let mut harness = open_operators(options);
    let waiting = |harness: &WindowHarness| harness.state().state().session.trace.get().serial;
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0; 22]);
    harness.get_by_label("Recognised");
    scan(&mut harness, "LATE77");
    assert!(shows(&harness, "Serial number LATE77 → Fender, left, "));
    assert!(shows(&harness, "· LATE77"), "in the banner");
    assert_eq!(waiting(&harness), "");
    // It is written at once.
    wait_for_serial(&mut harness, 0, "LATE77");
    // It can be moved to the next part and back, and its row follows.
    for (button, serial, of_row) in [
        ("Give it to the next part", "LATE77", ""),
        ("Give it to this part", "", "LATE77"),
    ] {
        harness.get_by_label(button).click();
        harness.run_steps(4);
        assert_eq!(waiting(&harness), serial);
        assert_eq!(shows(&harness, "For the next part"), !serial.is_empty());
        wait_for_serial(&mut harness, 0, of_row);
    }
    pass_time(&mut harness);
    assert!(!shows(&harness, "Give it to"), "it stays");
    // It is added to the row of that part: nothing was inspected again.
    let num_below = |harness: &WindowHarness| history_of(harness).row(0).map(|row| row.num_below);
    assert_eq!(num_below(&harness), Some(0));
    sees(&mut harness, &wire, [0.0; 2]);
    assert!(shows(&harness, "· LATE77"), "in the banner");
    // Scanned again, it stays with that part.
    scan(&mut harness, "LATE77");
    assert!(shows(&harness, "LATE77 is already the number of this part"));
    assert_eq!(waiting(&harness), "");
    // That part has one now.
    scan(&mut harness, "NEXT8");
    sees(&mut harness, &wire, [0.0; 2]);
    harness.get_by_label("For the next part that is inspected");
    assert_eq!(waiting(&harness), "NEXT8");
    wait_for_serial(&mut harness, 0, "LATE77");
    assert_eq!(num_below(&harness), Some(0));
    scan(&mut harness, "NEXT9");
    assert!(shows(&harness, "NEXT9 replaces NEXT8"));
    assert_eq!(waiting(&harness), "NEXT9");
}

#[test]
fn a_scanner_is_heard_on_every_page_of_the_operator() {
    let mut harness = open_operators(plain_options());
    press(&mut harness, "History");
    let before = harness.state().state().session.theme;
    scan(&mut harness, "TL471");
    let session = &harness.state().state().session;
    assert_eq!(session.trace.get().serial, "");
    assert_eq!(session.workspace, WorkspaceKind::History);
    assert!(session.theme == before && !session.is_live());
    // This page does not show to which part it goes.
    assert!(shows(&harness, "Serial number TL471 → Front door, left, "));
    scan(&mut harness, "TL472");
    harness.get_by_label("Serial number TL472 is for the next part");
}

#[test]
fn a_scan_answers_no_question_and_its_number_is_not_lost() {
    let mut harness = open_operators(plain_options());
    press(&mut harness, "Engineer's view");
    harness.get_by_label("Switch");
    scan(&mut harness, "99001");
    let role = harness.state().state().session.role;
    assert_eq!(role, UserRole::Operator);
    press(&mut harness, "Cancel");
    assert!(shows(&harness, "· 99001"), "in the banner");
}

#[test]
fn two_notices_show_at_once_and_cover_no_control() {
    let mut harness = open_operators(plain_options());
    for name in ["First", "Second", "Third"] {
        let notice = Notice::look(format!("{name} problem"), format!("{name} advice"));
        act(&mut harness, Action::Notify(notice));
    }
    assert!(!shows(&harness, "First problem"));
    let dismiss = harness.get_all_by_label("Dismiss").map(|node| node.rect());
    let covered = ["Second problem.", "Third problem."]
        .map(|what| harness.get_by_label(what).rect())
        .into_iter()
        .chain(dismiss)
        .reduce(egui::Rect::union)
        .expect("some");
    for role in [Role::Button, Role::TextInput] {
        for node in harness.get_all_by_role(role) {
            let label = node.accesskit_node().label().unwrap_or_default();
            let is_free = label.starts_with("Dismiss") || !node.rect().intersects(covered);
            assert!(is_free, "{label}: {:?}, {covered:?}", node.rect());
        }
    }
    press(&mut harness, "Dismiss all");
    assert!(!shows(&harness, "problem"));
}

#[test]
fn an_empty_cell_is_said_in_plain_words_without_figures() {
    let mut harness = open_operators(plain_options());
    act(&mut harness, Action::UseCell(CellChoice::Empty));
    harness.get_by_label("No part hangs in front of the camera");
    assert!(shows(&harness, "Then press Capture") && !shows(&harness, "m²"));
}

#[test]
fn a_file_of_a_watched_folder_that_cannot_be_read_is_named_and_advice_fits_the_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_operators(plain_options());
    // What lies there before is no capture.
    watch_folder(&mut harness, folder.path());
    std::fs::write(folder.path().join("text.png"), "no picture").expect("written");
    wait_until(&mut harness, |state| state.session.failed.is_some());
    harness.run_steps(2);
    harness.get_by_label("No result");
    harness.get_by_label("text.png cannot be read");
    assert!(shows(&harness, "Save the capture to the folder again"));
    let mut empty = CellSetup::new(SimulatedObject::Nothing, 3);
    empty.noise = SensorNoise::kinect(5);
    let empty = scene_of(&empty);
    save_cloud(&folder.path().join("empty.pcd"), &empty.cloud).expect("written");
    wait_until(&mut harness, |state| state.session.failed.is_none());
    harness.run_steps(2);
    harness.get_by_label("No part hangs in front of the camera");
    assert!(shows(&harness, "The next file is inspected automatically"));
    assert!(!shows(&harness, "press Capture"));
    // The part of the other file still has no verdict.
    assert!(shows(&harness, "text.png: found"));
}

#[test]
fn a_capture_of_a_watched_folder_without_a_new_file_says_what_it_waits_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_operators(plain_options());
    watch_folder(&mut harness, folder.path());
    write_unknown(&folder.path().join("1.pcd"));
    wait_until(&mut harness, |state| {
        let status = state.session.live.status.as_ref();
        status.is_some_and(|status| status.num_inspected > 0)
    });
    toggle(&mut harness);
    settle(&mut harness);
    // Live has taken the only file.
    let context = harness.ctx.clone();
    harness.state_mut().act(Action::Capture, &context);
    harness.run_steps(4);
    harness.get_by_label("No new file in the folder yet");
    harness.get_by_label("Save a capture to the folder: it is inspected automatically");
    assert!(!shows(&harness, "Inspecting") && !shows(&harness, "Wait a moment"));
    write_unknown(&folder.path().join("2.pcd"));
    wait_until(&mut harness, |state| state.session.inspecting.is_none());
    settle(&mut harness);
    harness.get_by_label("NOK");
}

#[test]
fn a_file_that_was_opened_in_enrol_is_not_the_source_of_the_verdict_on_the_screen() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("other.pcd");
    write_unknown(&path);
    let mut harness = open_with(SMALL, plain_options());
    act(&mut harness, Action::GoTo(WorkspaceKind::Enrol));
    act(&mut harness, Action::Open(path));
    // This one cannot be read.
    act(&mut harness, Action::Open(folder.path().join("gone.pcd")));
    let source = harness.state().state().session.source.clone();
    assert_eq!(source, Source::default());
    act(&mut harness, Action::Role(RoleAction::Switch));
    harness.get_by_label("Recognised");
    assert!(!shows(&harness, "other.pcd") && !shows(&harness, "gone.pcd"));
}

/// Opens a window in the operator's view that follows its camera to answer robots, calibrated by this file, if any.
fn open_answering(cell: Option<PathBuf>) -> (WindowHarness, Sender<Step>) {
    let (options, wire) = wired_options();
    let mut harness = open_with(SMALL, WindowOptions { cell, ..options });
    let context = harness.ctx.clone();
    let setup = AnswerSetup {
        is_on: true,
        at: "ascii=0".parse().expect("any free port"),
        ..AnswerSetup::default()
    };
    harness
        .state_mut()
        .act(Action::Robot(RobotAction::Answer(setup)), &context);
    // Live has started with it.
    sees(&mut harness, &wire, [0.0; 2]);
    harness
        .state_mut()
        .act(Action::Role(RoleAction::Switch), &context);
    harness.run_steps(2);
    (harness, wire)
}

#[test]
fn an_operator_sees_that_robots_get_no_pose_or_after_live_no_frames() {
    let warning = "Robots get no pose: ask the engineer to calibrate the cell";
    let (harness, _wire) = open_answering(None);
    // In large letters; the status bar says the same.
    harness.get_by_role_and_label(Role::Label, warning);
    harness.get_by_role_and_label(Role::Button, warning);
    drop(harness);

    let folder = tempfile::tempdir().expect("a folder");
    let cell = folder.path().join("cell.toml");
    save_calibration(&cell);
    let (mut harness, _wire) = open_answering(Some(cell));
    assert!(!shows(&harness, "Robots get no"));
    toggle(&mut harness);
    harness.run_steps(4);
    harness.get_by_role_and_label(Role::Label, "Robots get no frames: press Live");
}

#[test]
fn a_scanned_serial_number_goes_with_one_part_and_order_and_operator_with_the_next_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = || WindowOptions {
        history: Some(folder.path().join("history")),
        settings: Some(folder.path().join("settings.toml")),
        ..plain_options()
    };
    let mut harness = open_operators(options());
    for (field, text) in [("Order", "A 17"), ("Operator", "Kim")] {
        harness
            .get_by_role_and_label(Role::TextInput, field)
            .click();
        harness.run_steps(2);
        harness
            .get_by_role_and_label(Role::TextInput, field)
            .type_text(text);
        harness.run_steps(2);
        harness.key_press(Key::Enter);
        harness.run_steps(4);
    }
    press(&mut harness, "Capture");
    // No field has the focus. T, L and the digits are shortcuts, but the scanner's input must trigger none.
    let before = harness.state().state().session.theme;
    scan(&mut harness, "TL471");
    let state = harness.state().state();
    assert_eq!(state.session.trace.get().serial, "");
    assert!(state.session.theme == before && !state.session.is_live());
    assert_eq!(state.session.workspace, WorkspaceKind::Inspect);
    // The operator sees the serial number that the part was traced by.
    assert!(shows(&harness, "· TL471"));
    press(&mut harness, "Capture");
    wait_for_serial(&mut harness, 1, "TL471");
    settle(&mut harness);
    let traces: Vec<_> = (0..2)
        .map(|index| {
            history_of(&harness)
                .row(index)
                .expect("listed")
                .trace
                .clone()
        })
        .collect();
    let [newest, before] = traces.as_slice() else {
        panic!("{traces:?}");
    };
    assert_eq!(
        (&*before.serial, &*before.order, &*before.operator),
        ("TL471", "A 17", "Kim")
    );
    assert_eq!(
        (&*newest.serial, &*newest.order, &*newest.operator),
        ("", "A 17", "Kim")
    );
    press(&mut harness, "History");
    harness.get_by_label("Find").click();
    harness.run_steps(2);
    harness.get_by_label("Find").type_text("tl471");
    settle(&mut harness);
    harness.get_by_label("1 of 3 entries");
    // The fields of the session are kept, the part's serial number is not.
    let remembered = settings::Settings::of(harness.state().state(), None);
    assert_eq!(&*remembered.traceability.order, "A 17");
    assert_eq!(&*remembered.traceability.serial, "");
}
