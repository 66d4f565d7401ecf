//! What outlives an inspection: the history, the report, and the settings of the window.

use std::{
    fs,
    path::Path,
    thread,
    time::{Duration, Instant},
};

use egui::Key;
use egui_kittest::kittest::Queryable as _;
use partsight::app::{
    WindowOptions,
    action::{Action, Ask},
    state::{ThemeChoice, UnitSystem, Workspace},
};

use super::set_up::{USUAL, act, open, open_with, settle};

fn remembering(path: &Path) -> WindowOptions {
    WindowOptions {
        settings: Some(path.to_owned()),
        ..WindowOptions::default()
    }
}

#[test]
fn an_earlier_inspection_is_found_and_opened_again_with_its_stages() {
    let mut harness = open();
    harness.key_press(Key::Space);
    settle(&mut harness);
    harness.get_by_label("Simulated frame 2");
    harness.get_by_label("History").click();
    harness.run_steps(2);
    harness.get_by_label("2 of 2");
    harness
        .get_by_label("Inspection 1: Front door, left, Accepted")
        .click();
    harness.run_steps(2);
    harness.get_by_label("Segmentation of inspection 1");
    harness.get_by_label("Open").click();
    settle(&mut harness);
    assert_eq!(harness.state().state().workspace, Workspace::Inspect);
    harness.get_by_label("Simulated frame 1");
    harness.get_by_label_contains("From the history");
    harness.get_by_label("Enlarge contour");
    // Looking again is no inspection.
    assert_eq!(harness.state().state().history.num_rows(), 2);
}

#[test]
fn the_list_is_filtered_by_what_is_written_and_keys_do_not_switch_meanwhile() {
    let mut harness = open();
    harness.key_press(Key::Space);
    settle(&mut harness);
    harness.get_by_label("History").click();
    harness.run_steps(2);
    harness.get_by_label("Find").click();
    harness.run_steps(2);
    harness.get_by_label("Find").type_text("frame 1");
    harness.run_steps(3);
    harness.get_by_label("1 of 2");
    assert_eq!(harness.state().state().workspace, Workspace::History);
    harness.get_by_label("No part").click();
    harness.run_steps(2);
    harness.get_by_label_contains("No inspection is like this");
}

#[test]
fn the_report_of_an_inspection_is_written_and_a_bad_folder_is_a_notice() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open();
    let out = folder.path().join("report");
    act(&mut harness, Action::Chosen(Ask::ReportFolder, out.clone()));
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
    assert_eq!(report["pose"]["usable"], true);
    let pdf = fs::read(out.join("simulated_1.pose.pdf")).expect("written");
    assert!(pdf.starts_with(b"%PDF-"));
    let table = fs::read_to_string(out.join("poses.matrix.csv")).expect("written");
    assert_eq!(table.lines().count(), 2);

    let taken = folder.path().join("taken");
    fs::write(&taken, "a file").expect("written");
    act(&mut harness, Action::Chosen(Ask::ReportFolder, taken));
    harness.get_by_label_contains("cannot make the report's folder");
    harness.get_by_label("Accepted");
}

#[test]
fn the_listed_history_is_written_as_a_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("inspections.csv");
    let mut harness = open();
    act(&mut harness, Action::Chosen(Ask::HistoryCsv, path.clone()));
    let text = fs::read_to_string(&path).expect("written");
    assert_eq!(text.lines().count(), 2);
    assert!(text.contains(",Accepted,front_door,"));
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
    assert_eq!(state.theme, ThemeChoice::Light);
    assert_eq!(state.units, UnitSystem::MetresRadians);
    assert_eq!(state.workspace, Workspace::History);
}

#[test]
fn broken_settings_are_set_aside_with_a_notice() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("settings.toml");
    fs::write(&path, "theme = \"lig").expect("written");
    let harness = open_with(USUAL, remembering(&path));
    harness.get_by_label_contains("are not used");
    harness.get_by_label_contains("set aside as");
    harness.get_by_label("Accepted");
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
    assert!(harness.state().state().recent.is_empty());
}
