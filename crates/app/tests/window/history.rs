//! What is stored beyond an inspection: the history, the report, and the settings of the window.

use std::{
    fs,
    path::Path,
    sync::Arc,
    thread,
    time::{Duration, Instant},
};

use app::{
    WindowOptions,
    workspaces::{
        history::{HistoryAction, HistoryFile, HistoryWorkspace, ListFilter},
        inspect::InspectFile,
    },
};
use egui::Key;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use files::save_cloud;
use inspection::{library::Truth, pipeline::Recipe};
use records::history::{
    History, HungId, KeepFrames, NewEntry, Retention, RobotMarks, SceneTitle, StoredVerdict,
};
use shell::{
    action::Action,
    inspection::source::CellChoice,
    language::UnitSystem,
    roles::RoleAction,
    session::{ThemeChoice, WorkspaceKind},
};
use simulate::{ObjectKind, PartKind, Side};

use records::fixtures::{history_entry, low_score, open_history, refuse};
use stages::fixtures::facing_part;

use super::{
    set_up::{
        SMALL, USUAL, WindowHarness, act, act_in, choose_in_inspect, history_of, let_pass, open,
        open_with, plain_options, press, settle,
    },
    shots::ScanFolder,
};

fn remembering(path: &Path) -> WindowOptions {
    WindowOptions {
        settings: Some(path.to_owned()),
        ..plain_options()
    }
}

/// Options of a window that keeps its history in this folder.
fn keeping(path: &Path) -> WindowOptions {
    WindowOptions {
        history: Some(path.to_owned()),
        ..plain_options()
    }
}

fn go_to_history(harness: &mut WindowHarness) {
    act(harness, Action::GoTo(WorkspaceKind::History));
}

fn act_in_history(harness: &mut WindowHarness, action: HistoryAction) {
    act_in(harness, |workspace: &mut HistoryWorkspace, cx| {
        workspace.apply(action, cx);
    });
}

#[test]
fn a_new_inspection_is_looked_at_whatever_row_was_selected_before() {
    let mut harness = open();
    harness.key_press(Key::Space);
    settle(&mut harness);
    go_to_history(&mut harness);
    settle(&mut harness);
    press(&mut harness, "Inspection 1: Front door, left, Accepted");
    // The number is negative, because nothing is written to disk.
    assert_eq!(history_of(&harness).listed(), Some(-1));
    act(&mut harness, Action::GoTo(WorkspaceKind::Inspect));
    harness.key_press(Key::Space);
    settle(&mut harness);
    go_to_history(&mut harness);
    settle(&mut harness);
    assert_eq!(history_of(&harness).listed(), Some(-3));
}

#[test]
fn an_earlier_inspection_is_found_and_opened_again_with_its_stages() {
    let mut harness = open();
    harness.key_press(Key::Space);
    settle(&mut harness);
    harness.get_by_label("Simulated frame 2");
    harness.get_by_label("History").click();
    settle(&mut harness);
    harness.get_by_label("2 of 2 entries");
    press(&mut harness, "Inspection 1: Front door, left, Accepted");
    harness.get_by_label("Segmentation of inspection 1");
    press(&mut harness, "Open");
    assert_eq!(
        harness.state().state().session.workspace,
        WorkspaceKind::Inspect
    );
    harness.get_by_label("Simulated frame 1");
    harness.get_by_label_contains("From the history");
    harness.get_by_label("Enlarge contour");
    // Looking at it again is not an inspection.
    assert_eq!(history_of(&harness).num_rows(), 2);
}

#[test]
fn the_list_is_filtered_by_what_is_written_and_keys_do_not_switch_meanwhile() {
    let mut harness = open();
    harness.key_press(Key::Space);
    settle(&mut harness);
    go_to_history(&mut harness);
    harness.get_by_label("Find").click();
    harness.run_steps(2);
    harness.get_by_label("Find").type_text("frame 1");
    settle(&mut harness);
    harness.get_by_label("1 of 2 entries");
    assert_eq!(
        harness.state().state().session.workspace,
        WorkspaceKind::History
    );
    // Nor does the Enter that ends the typing, although the field has lost the focus by then.
    harness.key_press(Key::Enter);
    settle(&mut harness);
    harness.get_by_label("1 of 2 entries");
    assert_eq!(
        harness.state().state().session.workspace,
        WorkspaceKind::History
    );
    press(&mut harness, "Verdict · All ▼");
    press(&mut harness, "Verdict: No part");
    harness.get_by_label_contains("No matching inspections");
    press(&mut harness, "Show all");
    harness.get_by_label("2 of 2 entries");
    press(&mut harness, "Days · All days ▼");
    press(&mut harness, "Days: From … to");
    harness.get_by_label("First day").click();
    harness.run_steps(2);
    harness.get_by_label("First day").type_text("2020-01");
    settle(&mut harness);
    harness.get_by_label_contains("Write a day as year-month-day");
    harness.get_by_label("2 of 2 entries");
    harness.get_by_label("Last day").click();
    harness.run_steps(2);
    harness.get_by_label("Last day").type_text("2020-01-31");
    settle(&mut harness);
    harness.get_by_label("0 of 2 entries");
}

#[test]
fn the_reason_of_a_refusal_begins_with_a_capital_letter() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut history = open_history(folder.path());
    let mut entry = history_entry(1, StoredVerdict::Rejected, "fender");
    entry.record.summary.title = "Fender, left".into();
    entry.record.summary.score = Some([0.81, 0.97]);
    refuse(&mut entry, low_score("fender", 0.81));
    history.add(&entry, &Retention::default()).expect("written");
    drop(history);
    let mut harness = open_with(USUAL, keeping(folder.path()));
    go_to_history(&mut harness);
    press(
        &mut harness,
        "Inspection 1: Not recognised · nearest Fender, left, Not accepted",
    );
    harness.get_by_label("The best match, Fender, left, scores 0.81, below the threshold of 0.90");
}

#[test]
fn an_inspection_that_the_filter_hides_does_not_stay_beside_the_list() {
    let mut harness = open();
    harness.key_press(Key::Space);
    settle(&mut harness);
    go_to_history(&mut harness);
    press(&mut harness, "Inspection 1: Front door, left, Accepted");
    harness.get_by_label("Segmentation of inspection 1");
    harness.get_by_label("Find").click();
    harness.run_steps(2);
    harness.get_by_label("Find").type_text("frame 2");
    settle(&mut harness);
    harness.get_by_label("1 of 2 entries");
    harness.get_by_label("Segmentation of inspection 2");
    press(&mut harness, "Verdict · All ▼");
    press(&mut harness, "Verdict: No part");
    harness.get_by_label("0 of 2 entries");
    harness.get_by_label("Choose an inspection to see more of it");
    press(&mut harness, "Show all");
    harness.get_by_label("Segmentation of inspection 2");
}

#[test]
fn the_history_outlives_the_window_and_what_a_person_said_of_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, keeping(folder.path()));
    act(
        &mut harness,
        Action::UseCell(CellChoice::Foreign(ObjectKind::Wheel)),
    );
    go_to_history(&mut harness);
    harness.get_by_label("2 of 2 entries");
    press(&mut harness, "Actual part · Not set ▼");
    press(&mut harness, "Actual part: Not enrolled");
    harness.get_by_label("Actual part · Not enrolled ▼");
    let row = harness.get_by_label_contains("Inspection 2: ");
    let marked = row.accesskit_node().value();
    assert_eq!(marked.as_deref(), Some("Actual part: Not enrolled"));
    harness.get_by_label("Your remark").click();
    harness.run_steps(2);
    harness.get_by_label("Your remark").type_text("a wheel");
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    settle(&mut harness);
    // Enter belonged to the field: it does not open the inspection as well.
    let state = harness.state().state();
    assert_eq!(state.session.workspace, WorkspaceKind::History);
    assert!(
        state
            .session
            .shown
            .as_ref()
            .is_some_and(|shown| !shown.is_past)
    );
    drop(harness);

    let mut harness = open_with(USUAL, keeping(folder.path()));
    go_to_history(&mut harness);
    harness.get_by_label("3 of 3 entries");
    harness.get_by_label("Find").click();
    harness.run_steps(2);
    harness.get_by_label("Find").type_text("WHEEL");
    settle(&mut harness);
    harness.get_by_label("1 of 3 entries");
    let row = history_of(&harness).row(0).expect("listed");
    assert_eq!((row.number, row.remark.as_str()), (2, "a wheel"));
    assert_eq!(row.label, Some(Truth::NotEnrolled));
    // Its frame is kept, because it was not accepted; with its own recipe it gives the same result.
    assert!(row.frame_bytes.is_some());
    act_in_history(&mut harness, HistoryAction::Open(2));
    let state = harness.state().state();
    assert_eq!(state.session.workspace, WorkspaceKind::Inspect);
    assert!(
        state
            .session
            .shown
            .as_ref()
            .is_some_and(|shown| shown.is_past)
    );
    assert!(state.notices.is_empty(), "{:?}", state.notices);
    // So is that of the first, which was accepted a short while ago.
    act_in_history(&mut harness, HistoryAction::Open(1));
    harness.get_by_label("Front door, left");
    let state = harness.state().state();
    assert!(state.notices.is_empty(), "{:?}", state.notices);
    assert_eq!(history_of(&harness).num_rows(), 3);
}

#[test]
fn a_label_and_a_remark_belong_to_the_part_on_which_they_were_begun() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, keeping(folder.path()));
    go_to_history(&mut harness);
    // Nobody selected the only row. The next part comes while the menu is open.
    press(&mut harness, "Actual part · Not set ▼");
    act(&mut harness, Action::Capture);
    harness.get_by_label("2 of 2 entries");
    press(&mut harness, "Actual part: Not enrolled");
    harness.get_by_label("Your remark").click();
    harness.run_steps(2);
    harness.get_by_label("Your remark").type_text("den");
    harness.run_steps(2);
    act(&mut harness, Action::Capture);
    harness.get_by_label("Your remark").type_text("ted");
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    settle(&mut harness);
    let state = history_of(&harness);
    let rows = (0..state.num_rows()).filter_map(|index| state.row(index));
    let rows: Vec<_> = rows
        .map(|row| (row.number, row.remark.as_str(), row.label.clone()))
        .collect();
    assert_eq!(
        rows,
        [
            (3, "", None),
            (2, "", None),
            (1, "dented", Some(Truth::NotEnrolled))
        ]
    );
}

#[test]
fn a_remark_that_is_being_typed_when_the_window_closes_is_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, keeping(folder.path()));
    go_to_history(&mut harness);
    harness.get_by_label("Your remark").click();
    harness.run_steps(2);
    harness.get_by_label("Your remark").type_text("dented");
    harness.run_steps(2);
    // Close the window by the desktop's button, without Enter or a click elsewhere.
    eframe::App::on_exit(harness.state_mut());
    drop(harness);

    let mut harness = open_with(USUAL, keeping(folder.path()));
    go_to_history(&mut harness);
    let state = history_of(&harness);
    let rows = (0..state.num_rows()).filter_map(|index| state.row(index));
    let remarks: Vec<_> = rows.map(|row| (row.number, row.remark.as_str())).collect();
    assert!(remarks.contains(&(1, "dented")), "{remarks:?}");
}

#[test]
fn another_recipe_while_the_part_hangs_there_is_no_other_part_and_what_differs_is_shown() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, keeping(folder.path()));
    let mut recipe = Recipe::default();
    recipe.accept.min_score = 1.0;
    act_in(&mut harness, |_: &mut HistoryWorkspace, cx| {
        cx.send(Action::UseRecipe(Arc::new(recipe.into())));
        let title = "Inspecting with another recipe";
        cx.send(Action::InspectShown {
            title: title.into(),
        });
    });
    harness.get_by_label("Not accepted");
    go_to_history(&mut harness);
    harness.get_by_label("1 of 1 entry");
    // The acceptance still counts: a robot may have acted on it.
    harness.get_by_label("Inspection 1: Front door, left, Accepted, inspected again once");
    harness.get_by_label("Of this part: inspection 1, Accepted · counts");
    press(&mut harness, "Of this part: inspection 2, Not accepted");
    harness.get_by_label("Segmentation of inspection 2");
    harness.get_by_label("Inspection 2 found something else");
    harness.get_by_label("Accept from");
    // The row of the part stays marked.
    assert_eq!(history_of(&harness).listed(), Some(1));
    let export = folder.path().join("parts.csv");
    act_in_history(
        &mut harness,
        HistoryAction::Export(HistoryFile::Csv, export.clone()),
    );
    let table = fs::read_to_string(export).expect("written");
    assert_eq!(table.lines().count(), 2, "a table of parts");
    // Inspecting one from the history again adds no row: the part no longer hangs there.
    act_in_history(&mut harness, HistoryAction::Open(1));
    act_in(&mut harness, |_: &mut HistoryWorkspace, cx| {
        let title = "Inspecting with another recipe";
        cx.send(Action::InspectShown {
            title: title.into(),
        });
    });
    go_to_history(&mut harness);
    harness.get_by_label("1 of 1 entry");
    assert_eq!(
        history_of(&harness).row(0).map(|row| row.num_below),
        Some(1)
    );
}

#[test]
fn a_scan_is_listed_and_opened_again_with_its_shots_though_its_folder_is_gone() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut history = History::open(folder.path()).expect("opened").history;
    let all = Retention {
        keep: KeepFrames::All,
        ..Retention::default()
    };
    history.set_retention(&all).expect("written");
    drop(history);
    let scan = ScanFolder::new(3);
    let options = WindowOptions {
        scene: Some(scan.scan()),
        ..keeping(folder.path())
    };
    let mut harness = open_with(USUAL, options);
    harness.get_by_label("Fender, left");
    go_to_history(&mut harness);
    harness.get_by_label("1 of 1 entry");
    drop((harness, scan));

    let mut harness = open_with(USUAL, keeping(folder.path()));
    go_to_history(&mut harness);
    harness.get_by_label("2 of 2 entries");
    act_in_history(&mut harness, HistoryAction::Open(1));
    harness.get_by_label("Fender, left");
    harness.get_by_label_contains("3 shots · they agree to");
    harness.get_by_label_contains("From the history");
    let state = harness.state().state();
    // It gives the same result as then, so there is no notice.
    assert!(state.notices.is_empty(), "{:?}", state.notices);
    assert_eq!(history_of(&harness).num_rows(), 2);
}

#[test]
fn inspected_again_it_says_what_changed() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, keeping(folder.path()));
    go_to_history(&mut harness);
    press(&mut harness, "Inspect again");
    harness.get_by_label("Same result today");
    assert_eq!(
        harness.state().state().session.workspace,
        WorkspaceKind::History
    );
    assert_eq!(history_of(&harness).num_rows(), 1);
}

#[test]
fn frames_are_kept_by_the_rule_that_a_person_sets() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(SMALL, keeping(folder.path()));
    go_to_history(&mut harness);
    press(&mut harness, "Frames…");
    // A part that has just been accepted.
    harness.get_by_label_contains("Now: 1 frame, ");
    press(&mut harness, "All");
    press(&mut harness, "Apply");
    assert!(harness.query_by_label("Apply").is_none());
    let rule = |harness: &WindowHarness| history_of(harness).kept.0.keep;
    assert_eq!(rule(&harness), KeepFrames::All);
    act(&mut harness, Action::Capture);
    let kept = history_of(&harness).kept.1;
    assert_eq!(kept.num_frames, 2);
    press(&mut harness, "Frames…");
    harness.get_by_label_contains("Now: 2 frames, ");
    drop(harness);
    // The rule is stored in the history: commands keep frames by the same rule.
    let mut harness = open_with(SMALL, keeping(folder.path()));
    go_to_history(&mut harness);
    assert_eq!(rule(&harness), KeepFrames::All);
}

#[test]
fn a_history_that_cannot_be_written_is_said_and_inspections_go_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let taken = folder.path().join("taken");
    fs::write(&taken, "a file").expect("written");
    let mut harness = open_with(USUAL, keeping(&taken));
    harness.get_by_label("Recognised");
    for _ in 0..2 {
        harness.key_press(Key::Space);
        settle(&mut harness);
    }
    assert_eq!(harness.state().state().notices.len(), 1);
    harness.get_by_label_contains("the history cannot be kept there");
    go_to_history(&mut harness);
    harness.get_by_label("3 of 3 entries");
    harness.get_by_label_contains("Kept in memory only");
    press(&mut harness, "Inspection 1: Front door, left, Accepted");
    press(&mut harness, "Open");
    harness.get_by_label("Simulated frame 1");
}

#[test]
fn inspections_that_cannot_be_written_are_marked_and_the_window_asks_before_it_closes() {
    let folder = tempfile::tempdir().expect("a folder");
    let taken = folder.path().join("taken");
    fs::write(&taken, "a file").expect("written");
    let mut harness = open_with(SMALL, keeping(&taken));
    press(&mut harness, "Dismiss");
    act(&mut harness, Action::Close);
    harness.get_by_label("Close without saving?");
    harness.get_by_label("1 inspection is kept in memory only: the history cannot be written");
    press(&mut harness, "Keep the window open");
    act(&mut harness, Action::Role(RoleAction::Switch));
    harness.get_by_label("Not recorded");
    drop(harness);
    let mut harness = open_with(SMALL, keeping(&folder.path().join("kept")));
    act(&mut harness, Action::Close);
    assert!(harness.query_by_label("Close without saving?").is_none());
    act(&mut harness, Action::Role(RoleAction::Switch));
    assert!(harness.query_by_label("Not recorded").is_none());
}

#[test]
fn what_a_command_inspects_shows_in_an_open_history() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, keeping(folder.path()));
    go_to_history(&mut harness);
    let before = history_of(&harness).page.num_all;
    let mut history = History::open(folder.path()).expect("opened").history;
    let mut record = history.known(1).expect("written");
    record.summary.hung = HungId::new();
    record.summary.noted = RobotMarks {
        robot_doubts: vec!["ambiguous_pose".into(), "poses_apart".into()],
        motion_checked: Some(false),
    };
    let entry = NewEntry {
        record,
        picture: None,
        scene: None,
        shots: Vec::new(),
        stands_for_part: false,
    };
    history.add_all([entry]).expect("written");
    drop(history);
    let until = Instant::now() + Duration::from_mins(1);
    while history_of(&harness).page.num_all == before {
        assert!(Instant::now() < until, "not seen within a minute");
        thread::sleep(Duration::from_millis(50));
        harness.step();
    }
    settle(&mut harness);
    harness.get_by_label("2 of 2 entries");
    press(&mut harness, "Inspection 2: Front door, left, Accepted");
    harness.get_by_label(
        "Not for robots: another pose of the part fitted nearly as well; the poses of the scan contradicted one another",
    );
    harness.get_by_label("Not known whether the part hung still");
    press(&mut harness, "Inspection 1: Front door, left, Accepted");
    assert!(harness.query_by_label_contains("Not for robots").is_none());
}

#[test]
fn of_ten_thousand_inspections_only_those_in_sight_are_fetched() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().to_owned();
    drop(open_with(USUAL, keeping(&path)));
    let mut history = History::open(&path).expect("opened").history;
    let first = history.known(1).expect("written");
    let many = (0..10_000).map(|i| {
        let mut record = first.clone();
        record.summary.scene = SceneTitle::Named(format!("frame {i}"));
        record.summary.hung = HungId::new();
        NewEntry {
            record,
            picture: None,
            scene: None,
            shots: Vec::new(),
            stands_for_part: false,
        }
    });
    history.add_all(many).expect("written");
    drop(history);

    let mut harness = open_with(USUAL, keeping(&path));
    go_to_history(&mut harness);
    harness.get_by_label("10002 of 10002 entries");
    let num_fetched = history_of(&harness).page.rows.len();
    assert!(num_fetched < 400, "{num_fetched}");
    assert_eq!(
        history_of(&harness).row(0).map(|row| row.number),
        Some(10_002)
    );
    act_in_history(&mut harness, HistoryAction::Visible(10_000..10_002));
    // In its next frame the window asks for its own visible rows again, so both ranges are fetched.
    let filter = ListFilter {
        text: "frame 5432".into(),
        ..ListFilter::default()
    };
    act_in_history(&mut harness, HistoryAction::Filter(filter));
    harness.get_by_label("1 of 10002 entries");
    // Once in the list, once in the details: the selected row is not listed any more.
    let rows = harness.get_all_by_label_contains("Inspection 5434");
    assert_eq!(rows.count(), 2);
}

#[test]
fn the_report_of_an_inspection_is_written_and_a_bad_folder_is_a_notice() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open();
    let out = folder.path().join("report");
    choose_in_inspect(&mut harness, InspectFile::Report, out.clone());
    let text = fs::read_to_string(out.join("simulated_1.report.json")).expect("written");
    let line: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(line["part"], "front_door");
    assert_eq!(line["accepted"], true);
    for stage in ["segmentation", "binary", "contour", "stages"] {
        let path = out.join(format!("simulated_1.{stage}.png"));
        let picture = image::open(&path).expect("a picture");
        assert!(picture.width() > 50 && picture.height() > 50);
    }
    harness.get_by_label_contains("Wrote simulated_1.report.json");
    let text = fs::read_to_string(out.join("simulated_1.pose.json")).expect("written");
    let report: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(report["verdict"]["part"], "front_door");
    assert_eq!(report["seen_by"], "simulation");
    // The source is the one that History lists.
    let shown = harness.state().state().session.shown.as_ref();
    let record = &shown.expect("a result").inspected.entry.record;
    assert_eq!(record.summary.source, "simulated cell");
    assert_eq!(report["source"], "simulated cell");
    // Without a calibration no robot may act on it.
    assert_eq!(report["pose"]["usable"], false);
    assert_eq!(report["robot"]["doubts"][0]["kind"], "not_calibrated");
    let pdf = fs::read(out.join("simulated_1.pose.pdf")).expect("written");
    assert!(pdf.starts_with(b"%PDF-"));
    let table = fs::read_to_string(out.join("poses.matrix.csv")).expect("written");
    assert_eq!(table.lines().count(), 2);

    let taken = folder.path().join("taken");
    fs::write(&taken, "a file").expect("written");
    choose_in_inspect(&mut harness, InspectFile::Report, taken);
    harness.get_by_label_contains("cannot make the report's folder");
    harness.get_by_label("Recognised");
}

#[test]
fn the_listed_history_is_written_as_a_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("inspections.csv");
    let mut harness = open();
    let export = HistoryAction::Export(HistoryFile::Csv, path.clone());
    act_in_history(&mut harness, export);
    let text = fs::read_to_string(&path).expect("written");
    assert_eq!(text.lines().count(), 2);
    assert!(text.contains(",accepted,front_door,"));
}

#[test]
fn the_window_starts_as_it_was_left() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("partsight").join("settings.toml");
    let mut harness = open_with(USUAL, remembering(&path));
    harness.key_press(Key::T);
    harness.key_press(Key::U);
    harness.run_steps(2);
    harness.get_by_label("History").click();
    harness.run_steps(2);
    let until = Instant::now() + Duration::from_secs(20);
    while !fs::read_to_string(&path).is_ok_and(|text| text.contains("history")) {
        assert!(Instant::now() < until, "not written");
        thread::sleep(Duration::from_millis(10));
    }
    drop(harness);
    let harness = open_with(USUAL, remembering(&path));
    let state = harness.state().state();
    assert_eq!(state.session.theme, ThemeChoice::Light);
    assert_eq!(state.session.units, UnitSystem::MetresRadians);
    assert_eq!(state.session.workspace, WorkspaceKind::History);
}

#[test]
fn broken_settings_are_set_aside_with_a_notice() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("settings.toml");
    fs::write(&path, "theme = \"lig").expect("written");
    let harness = open_with(USUAL, remembering(&path));
    harness.get_by_label_contains("are not used");
    harness.get_by_label_contains("were moved to");
    harness.get_by_label("Recognised");
    let aside = folder.path().join("settings.broken-1.toml");
    assert_eq!(fs::read_to_string(aside).expect("kept"), "theme = \"lig");
}

#[test]
fn a_remembered_file_that_is_gone_gives_way_to_the_simulated_cell() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("settings.toml");
    let gone = folder.path().join("gone.pcd");
    let text = format!(
        "recent = [{0:?}]\nsource = {{ file = {0:?} }}\n",
        gone.display().to_string()
    );
    fs::write(&path, text).expect("written");
    let harness = open_with(USUAL, remembering(&path));
    harness.get_by_label_contains("gone.pcd");
    harness.get_by_label("Simulated frame 1");
    assert!(harness.state().state().session.recent.is_empty());
}

#[test]
fn what_has_no_frame_any_more_cannot_be_opened_and_the_newest_row_comes_into_sight() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut history = records::fixtures::open_history(folder.path());
    for seconds in 0..200 {
        let mut entry =
            records::fixtures::history_entry(seconds, StoredVerdict::Accepted, "fender");
        entry.scene = None;
        history.add(&entry, &Retention::default()).expect("written");
    }
    drop(history);
    let mut harness = open_with(USUAL, keeping(folder.path()));
    go_to_history(&mut harness);
    // The one from the start of the window can be simulated again.
    assert!(!harness.get_by_label("Open").accesskit_node().is_disabled());
    press(&mut harness, "Inspection 200: fender, Accepted");
    assert!(harness.get_by_label("Open").accesskit_node().is_disabled());
    harness.get_by_label_contains("The frame of frame 199, simulated is not kept");

    // Scroll far down, then inspect again.
    harness.get_by_label_contains("Inspection 198").hover();
    harness.run_steps(2);
    for _ in 0..30 {
        turn_page(&mut harness, -1.0);
    }
    settle(&mut harness);
    assert!(harness.query_by_label_contains("Inspection 201:").is_none());
    act(&mut harness, Action::GoTo(WorkspaceKind::Inspect));
    harness.key_press(Key::Space);
    settle(&mut harness);
    go_to_history(&mut harness);
    harness.get_by_label_contains("Inspection 202:");

    // At the top the list stays there, whichever row is selected.
    press(&mut harness, "Inspection 199: fender, Accepted");
    harness.key_press(Key::Space);
    settle(&mut harness);
    harness.get_by_label_contains("Inspection 203:");
    assert_eq!(history_of(&harness).listed(), Some(199));
}

#[test]
fn the_list_opens_at_the_row_that_the_program_has_selected_however_old_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("history");
    let scene = folder.path().join("door.pcd");
    let door = facing_part(PartKind::FrontDoor, Side::Left, 5);
    save_cloud(&scene, &door.cloud).expect("written");
    let inspect = |harness: &mut WindowHarness| {
        act(harness, Action::GoTo(WorkspaceKind::Inspect));
        act(harness, Action::Open(scene.clone()));
        go_to_history(harness);
    };
    let mut harness = open_with(USUAL, keeping(&place));
    inspect(&mut harness);
    let old = history_of(&harness).listed().expect("selected");
    drop(harness);
    let mut history = open_history(&place);
    for _ in 0..300 {
        let mut entry = history_entry(1, StoredVerdict::Accepted, "fender");
        entry.record.summary.at = geometry::clock::now();
        entry.scene = None;
        history.add(&entry, &Retention::default()).expect("written");
    }
    drop(history);

    // The same file is another inspection of the same part.
    let mut harness = open_with(USUAL, keeping(&place));
    inspect(&mut harness);
    assert_eq!(history_of(&harness).listed(), Some(old));
    let row = format!("Inspection {old}:");
    harness.get_by_label_contains(&row).hover();
    harness.run_steps(2);
    for _ in 0..30 {
        turn_page(&mut harness, 1.0);
    }
    settle(&mut harness);
    assert!(harness.query_by_label_contains(&row).is_none());
    // Also if it was selected before.
    inspect(&mut harness);
    harness.get_by_label_contains(&row);
}

/// Scrolls by this number of pages where the pointer is, up if above 0.
fn turn_page(harness: &mut WindowHarness, pages: f32) {
    harness.event(egui::Event::MouseWheel {
        source: egui::MouseWheelSource::Wheel,
        unit: egui::MouseWheelUnit::Page,
        delta: egui::vec2(0.0, pages),
        phase: egui::TouchPhase::Move,
        modifiers: egui::Modifiers::NONE,
    });
    let_pass(harness, 12);
}

#[test]
fn a_part_with_a_long_name_does_not_widen_the_details_over_the_list() {
    let folder = tempfile::tempdir().expect("a folder");
    let name = "tuer_vorn_rechts_grau";
    let first = history_entry(1, StoredVerdict::Accepted, name);
    let mut again = history_entry(2, StoredVerdict::Rejected, name);
    again.record.summary.hung = first.record.summary.hung.clone();
    let mut history = open_history(folder.path());
    for entry in [first, again] {
        history.add(&entry, &Retention::default()).expect("written");
    }
    drop(history);
    let mut harness = open_with(SMALL, keeping(folder.path()));
    go_to_history(&mut harness);
    press(
        &mut harness,
        "Inspection 1: tuer vorn rechts grau, Accepted, inspected again once",
    );
    let list = harness.get_by_label("Export CSV…").rect();
    let details = harness.get_by_label("Your remark").rect();
    assert!(list.right() < details.left(), "{list:?} {details:?}");
    for shown in harness.get_all_by_label(name) {
        let rect = shown.rect();
        assert!(rect.right() <= SMALL.x, "{rect:?}");
    }
}

#[test]
fn the_details_of_another_part_begin_at_the_top() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut history = records::fixtures::open_history(folder.path());
    for (seconds, part) in [(1, "fender"), (2, "grille")] {
        let entry = records::fixtures::history_entry(seconds, StoredVerdict::Accepted, part);
        history.add(&entry, &Retention::default()).expect("written");
    }
    drop(history);
    let low = egui::vec2(SMALL.x, 480.0);
    let mut harness = open_with(low, keeping(folder.path()));
    go_to_history(&mut harness);
    press(&mut harness, "Inspection 1: fender, Accepted");
    let top_of_verdict = |harness: &WindowHarness| harness.get_by_label("Accepted").rect().top();
    let top = top_of_verdict(&harness);
    harness.get_by_label("Accepted").hover();
    harness.run_steps(2);
    turn_page(&mut harness, -1.0);
    assert!(top_of_verdict(&harness) < top - 1.0);
    press(&mut harness, "Inspection 2: grille, Accepted");
    let again = top_of_verdict(&harness);
    assert!((again - top).abs() < 1.0, "{again} {top}");
}

#[test]
fn statistics_count_the_listed_parts_by_shift_by_part_and_by_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut history = records::fixtures::open_history(folder.path());
    for seconds in 0..12 {
        let verdict = if seconds % 4 == 0 {
            StoredVerdict::Rejected
        } else {
            StoredVerdict::Accepted
        };
        let mut entry = records::fixtures::history_entry(seconds, verdict, "fender");
        entry.record.summary.rack = (seconds < 2).then(|| "rack A".into());
        history.add(&entry, &Retention::default()).expect("written");
    }
    drop(history);
    let mut harness = open_with(SMALL, keeping(folder.path()));
    go_to_history(&mut harness);
    press(&mut harness, "Statistics");
    harness.get_by_label("By rack");
    harness.get_by_label("rack A");
    harness.get_by_label_contains(": 9 OK, 3 NOK");
    harness.get_by_label("Fender, left");
    harness.get_by_label("75.0 %");
    harness.get_by_label("3 × Score below the threshold");
    harness.get_by_label("Drift: Fender, left");
    harness.get_by_label("Score: mean 0.970, 3σ from 0.970 to 0.970, limit 0.900");
    harness.get_by_label("Fit to the reference, rms: mean 1.6 mm, 3σ from 0.5 mm to 2.7 mm");
    harness.get_by_label_contains("mean ± 3σ: x 0.0 mm ± 0.0 mm, y 0.0 mm ± 0.0 mm, z 0.0 mm");
    // The statistics cover the listed parts only.
    press(&mut harness, "Verdict · All ▼");
    press(&mut harness, "Verdict: Accepted");
    harness.get_by_label_contains(": 9 OK, 0 NOK");
    assert!(
        harness
            .query_by_label("3 × Score below the threshold")
            .is_none()
    );
    press(&mut harness, "Statistics");
    harness.get_by_label_contains("Inspection 13: ");
}

#[test]
fn a_part_that_a_trend_will_refuse_is_warned_of_in_the_status_bar_which_leads_to_its_statistics() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut history = records::fixtures::open_history(folder.path());
    for seconds in 0..60_u8 {
        let mut entry =
            records::fixtures::history_entry(i64::from(seconds), StoredVerdict::Accepted, "fender");
        // The log odds of a score fall from 4 by 0.02 each; those of 0.9 are 2.197.
        let score = 1.0 / (1.0 + (0.02 * f64::from(seconds) - 4.0).exp());
        entry.record.summary.score = Some([score, 0.8]);
        entry.scene = None;
        entry.picture = None;
        history.add(&entry, &Retention::default()).expect("written");
    }
    drop(history);
    let mut harness = open_with(SMALL, keeping(folder.path()));
    // By the title that the part had then.
    let warning = harness.get_by_label_contains("fender drifts: ");
    warning.click();
    settle(&mut harness);
    let session = &harness.state().state().session;
    assert_eq!(session.workspace, WorkspaceKind::History);
    harness.get_by_label(
        "Fender, left drifts: at this trend, single parts are refused after 32 more inspections (Score, limit 0.900)",
    );
    harness.get_by_label("Score: trend from 0.982 to 0.944 over the newest 60 inspections");
}

#[test]
fn statistics_say_how_many_parts_a_drift_needs() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut history = records::fixtures::open_history(folder.path());
    for seconds in 0..2 {
        let entry = records::fixtures::history_entry(seconds, StoredVerdict::Accepted, "fender");
        history.add(&entry, &Retention::default()).expect("written");
    }
    drop(history);
    let mut harness = open_with(SMALL, keeping(folder.path()));
    go_to_history(&mut harness);
    press(&mut harness, "Statistics");
    harness.get_by_label("Drift is shown for a part that was accepted at least 3 times");
}

#[test]
fn the_filter_offers_parts_of_the_history_that_are_not_in_the_library() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut history = records::fixtures::open_history(folder.path());
    for (seconds, part) in [(1, "real_door"), (2, "fender"), (3, "real_door")] {
        let entry = records::fixtures::history_entry(seconds, StoredVerdict::Accepted, part);
        history.add(&entry, &Retention::default()).expect("written");
    }
    drop(history);
    let mut harness = open_with(SMALL, keeping(folder.path()));
    go_to_history(&mut harness);
    press(&mut harness, "Part · All ▼");
    press(&mut harness, "Part: real door");
    harness.get_by_label("2 of 4 entries");
}

#[test]
fn refusals_with_other_figures_count_as_one_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut history = records::fixtures::open_history(folder.path());
    for (seconds, part, score) in [
        (1, "fender", 0.81),
        (2, "grille", 0.75),
        (3, "fender", 0.62),
    ] {
        let mut entry = records::fixtures::history_entry(seconds, StoredVerdict::Rejected, part);
        refuse(&mut entry, low_score(part, score));
        history.add(&entry, &Retention::default()).expect("written");
    }
    drop(history);
    let mut harness = open_with(SMALL, keeping(folder.path()));
    go_to_history(&mut harness);
    press(&mut harness, "Statistics");
    harness.get_by_label("3 × Score below the threshold");
}
