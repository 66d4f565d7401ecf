//! The Inspect workspace, and the shell around every workspace.

use std::{sync::Arc, thread, time::Duration};

use app::WindowOptions;
use egui::{Key, Modifiers, Order, Rect, Role, Shape};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use files::save_cloud;
use inspection::pipeline::{Rejection, Unwatched, Verdict};
use robot::Convention;
use shell::{
    action::Action,
    cell::RobotAction,
    inspection::{
        figures::StagePanel,
        inspected::{InspectRequest, inspect_all},
        library_cache::LibraryCache,
        source::{CellChoice, SceneSource},
    },
    language::UnitSystem,
    notice::Notice,
    session::{ThemeChoice, WorkspaceKind},
};
use simulate::{ObjectKind, PartKind, Side};

use stages::fixtures::facing_part;

use super::robot::save_calibration;
use super::set_up::{
    SMALL, USUAL, WindowHarness, act, drop_file, enrol_of, inspect_of, let_pass, open, open_with,
    plain_options, press, settle,
};

fn generation(harness: &WindowHarness) -> u64 {
    let shown = harness.state().state().session.shown.as_ref();
    shown.expect("a result").generation
}

#[test]
fn it_opens_with_a_first_frame_inspected() {
    let harness = open();
    harness.get_by_label("Front door, left");
    harness.get_by_label("Recognised");
    harness.get_by_label("Simulated frame 1");
    assert!(harness.state().state().notices.is_empty());
}

#[test]
fn a_capture_named_at_the_start_is_shown_with_its_result_whatever_was_in_front() {
    let folder = tempfile::tempdir().expect("a folder");
    let open = |scene| {
        let settings = Some(folder.path().join("settings.toml"));
        let options = WindowOptions {
            scene,
            settings,
            ..plain_options()
        };
        open_with(USUAL, options)
    };
    let front = |harness: &WindowHarness| harness.state().state().session.workspace;
    let mut harness = open(None);
    act(&mut harness, Action::GoTo(WorkspaceKind::Paint));
    eframe::App::on_exit(harness.state_mut());
    drop(harness);
    assert_eq!(front(&open(None)), WorkspaceKind::Paint);
    let path = folder.path().join("fender.pcd");
    save_cloud(&path, &facing_part(PartKind::Fender, Side::Left, 5).cloud).expect("written");
    let harness = open(Some(path));
    assert_eq!(front(&harness), WorkspaceKind::Inspect);
    harness.get_by_label("Recognised");
}

#[test]
fn capture_inspects_the_next_part() {
    let mut harness = open();
    harness.get_by_label("Capture").click();
    settle(&mut harness);
    harness.get_by_label("Simulated frame 2");
    harness.key_press(Key::Space);
    settle(&mut harness);
    // One capture, not two, whether or not the button has the focus.
    assert_eq!(harness.state().state().inspector.num_captures, 3);
}

#[test]
fn a_file_dropped_on_the_window_is_inspected() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("captured.pcd");
    let scene = facing_part(PartKind::Fender, Side::Left, 5);
    save_cloud(&path, &scene.cloud).expect("written");
    let mut harness = open();
    drop_file(&mut harness, &path);
    harness.get_by_label("Fender, left");
    harness.get_by_label("captured.pcd, simulated");
}

#[test]
fn a_broken_file_is_a_notice_and_the_window_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("broken.pcd");
    std::fs::write(&path, "VERSION .7\nFIELDS x y z\nPOINTS 9999999999\n").expect("written");
    let mut harness = open();
    drop_file(&mut harness, &path);
    assert_eq!(harness.state().state().notices.len(), 1);
    harness.get_by_label("Recognised");
    harness.get_by_label("Dismiss").click();
    harness.run_steps(2);
    assert!(harness.query_by_label("Dismiss").is_none());
    harness.get_by_label_contains("Source").click();
    harness.run_steps(4);
    harness.get_by_label("Simulated cell").click();
    harness.run_steps(4);
    harness.get_by_label("Every part in turn").click();
    settle(&mut harness);
    harness.get_by_label("Simulated frame 2");
}

#[test]
fn cancel_gives_up_at_once_and_keeps_the_last_result() {
    let mut harness = open();
    let before = generation(&harness);
    let context = harness.ctx.clone();
    let window = harness.state_mut();
    window.act(shell::action::Action::Capture, &context);
    assert!(window.state().session.is_old());
    harness.step();
    // On a quick machine the result may have arrived, and there is nothing to cancel.
    let mut is_cancelled = false;
    if let Some(cancel) = harness.query_by_label("Cancel") {
        harness.get_by_label_contains("Previous result");
        cancel.click();
        harness.run_steps(2);
        assert_eq!(generation(&harness), before);
        is_cancelled = true;
    }
    assert!(harness.state().state().inspector.running().is_none());
    thread::sleep(Duration::from_millis(300));
    harness.run_steps(2);
    // Another part may hang there now.
    assert_eq!(harness.state().state().session.is_old(), is_cancelled);
}

#[test]
fn a_stage_fills_the_middle_until_escape() {
    let mut harness = open();
    harness.get_by_label("Enlarge contour").click();
    harness.run_steps(2);
    harness.get_by_label("Contour, enlarged");
    harness.get_by_label("Back door, left").click();
    harness.run_steps(2);
    assert_ne!(inspect_of(&harness).candidate, 0);
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert!(harness.query_by_label("Contour, enlarged").is_none());
    for panel in StagePanel::ALL {
        let label = format!("Enlarge {}", panel.title().to_lowercase());
        harness.get_by_label(&label).click();
        harness.run_steps(2);
        harness.get_by_label(&format!("{}, enlarged", panel.title()));
        harness.get_by_label("Close").click();
        harness.run_steps(2);
    }
}

#[test]
fn units_colours_and_shortcuts_have_their_keys() {
    let mut harness = open();
    harness.key_press(Key::U);
    harness.key_press(Key::T);
    harness.run_steps(2);
    assert_eq!(
        harness.state().state().session.units,
        UnitSystem::MetresRadians
    );
    assert_eq!(harness.state().state().session.theme, ThemeChoice::Light);
    harness.get_by_label("m · rad");
    harness.key_press(Key::F1);
    harness.run_steps(2);
    harness.get_by_label("Shortcuts");
    harness.key_press_modifiers(Modifiers::NONE, Key::Escape);
    harness.run_steps(2);
    assert!(harness.query_by_label("Shortcuts").is_none());
}

#[test]
fn the_pose_is_shown_in_the_robots_numbers_that_were_chosen() {
    let mut harness = open();
    harness.get_by_label("The camera's frame: the cell is not calibrated");
    harness
        .get_by_label("Convention: Matrix, 4×4")
        .scroll_to_me();
    let_pass(&mut harness, 12);
    harness.get_by_label("Convention: Matrix, 4×4").click();
    harness.run_steps(4);
    harness.get_by_label("FANUC W P R").click();
    harness.run_steps(4);
    harness.get_by_label("Convention: FANUC W P R");
    let shown = harness
        .state()
        .state()
        .session
        .shown
        .as_ref()
        .expect("a result");
    let pose = shown.inspected.inspection.pose.as_ref();
    let pose = pose.and_then(|pose| pose.as_ref().ok()).expect("a pose");
    for value in Convention::Fanuc.write(&pose.camera_from_part()).values {
        harness.get_by_label(value.name);
        harness.get_by_label_contains(&value.rounded());
    }
    // No key changes it by mistake.
    harness.key_press(Key::K);
    harness.run_steps(4);
    harness.get_by_label("Convention: FANUC W P R");
    // The camera's frame is for reading.
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::C);
    harness.run_steps(4);
    assert!(harness.query_by_label_contains("Copied").is_none());
    harness.get_by_label_contains("Not calibrated: the robot gets no pose");
    let folder = tempfile::tempdir().expect("a folder");
    let cell = folder.path().join("cell.toml");
    save_calibration(&cell);
    act(&mut harness, Action::Robot(RobotAction::Load(cell)));
    harness.get_by_label_contains("The robot's base frame, by Cell 2");
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::C);
    harness.run_steps(4);
    harness.get_by_label("Copied robot_from_part in the convention FANUC W P R");
}

#[test]
fn a_part_that_is_not_accepted_has_no_numbers_for_a_robot() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("other.pcd");
    let scene = facing_part(PartKind::Fender, Side::Right, 5);
    save_cloud(&path, &scene.cloud).expect("written");
    let mut harness = open();
    drop_file(&mut harness, &path);
    harness.get_by_label("Not accepted");
    // The figures below are those of the part that it is the mirror image of.
    harness.get_by_label("As Fender, left (not accepted)");
    assert!(harness.query_by_label("Copy pose").is_none());
    assert!(harness.query_by_label_contains("Convention").is_none());
    harness.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::C);
    harness.run_steps(4);
    harness.get_by_label_contains("There is no pose to copy");
}

#[test]
fn the_figures_of_a_pose_are_shown_only_with_the_name_of_their_part() {
    let mut harness = open();
    for (score, is_named) in [(0.3, true), (0.01, false)] {
        let choice = CellChoice::InTurn;
        let request = InspectRequest {
            source: SceneSource::Cell { choice, number: 1 },
            recipe: Arc::default(),
        };
        let found = inspect_all(&request, &LibraryCache::default(), &Unwatched);
        let mut found = found.expect("inspected").remove(0);
        let unknown = Rejection::Unknown {
            nearest: "front_door".into(),
            score,
        };
        found.inspection.verdict = Verdict::Part {
            part: "front_door".into(),
            score,
            margin: score,
            rejected: Some(unknown),
            is_approximate: false,
        };
        let context = harness.ctx.clone();
        let window = harness.state_mut();
        window.show_result(Arc::new(found), &context);
        settle(&mut harness);
        harness.get_by_label("Unknown part");
        for label in [
            "As Front door, left (not accepted)",
            "Offset from standard position",
        ] {
            let is_shown = harness.query_by_label(label).is_some();
            assert_eq!(is_shown, is_named, "{label} at {score}");
        }
    }
}

#[test]
fn every_control_is_large_enough_labelled_and_inside_a_small_window() {
    let size = SMALL;
    let mut harness = open_with(size, plain_options());
    for panel in [None, Some("Enlarge ranking")] {
        if let Some(label) = panel {
            harness.get_by_label(label).click();
            harness.run_steps(2);
        }
        let mut num_controls = 0;
        for role in [Role::Button, Role::Tab] {
            for node in harness.get_all_by_role(role) {
                let label = node.accesskit_node().label().unwrap_or_default();
                let rect = node.rect();
                assert!(!label.is_empty(), "a control at {rect:?} has no label");
                assert!(
                    rect.width() >= 35.9 && rect.height() >= 35.9,
                    "{label}: {rect:?}"
                );
                assert!(
                    rect.min.x >= 0.0 && rect.max.x <= size.x && rect.min.y >= 0.0,
                    "{label}: {rect:?}"
                );
                num_controls += 1;
            }
        }
        assert!(num_controls >= 14, "{num_controls} controls");
    }
}

#[test]
fn the_bars_of_the_enlarged_ranking_end_before_their_scores() {
    let mut harness = open();
    harness.get_by_label("Enlarge ranking").click();
    harness.run_steps(2);
    let shapes = harness.output().shapes.iter();
    let shapes: Vec<&Shape> = shapes.map(|clipped| &clipped.shape).collect();
    let words = shapes.iter().filter_map(|shape| match shape {
        Shape::Text(text) if text.galley.text() == "not examined" => {
            Some(text.visual_bounding_rect())
        }
        _ => None,
    });
    let words: Vec<Rect> = words.collect();
    assert!(!words.is_empty());
    let bars = shapes.iter().filter_map(|shape| match shape {
        Shape::Rect(bar) if bar.rect.height() < 30.0 => Some(bar.rect),
        _ => None,
    });
    for bar in bars {
        let covered = words.iter().find(|word| bar.intersects(**word));
        assert_eq!(covered, None, "{bar:?}");
    }
}

#[test]
fn the_verdict_stays_in_sight_and_large_however_far_the_card_is_scrolled() {
    let mut harness = open_with(SMALL, plain_options());
    harness.get_by_label("Simulated frame 1").scroll_to_me();
    let_pass(&mut harness, 12);
    harness.key_press(Key::Space);
    settle(&mut harness);
    let shown = harness
        .state()
        .state()
        .session
        .shown
        .as_ref()
        .expect("a result");
    let title = shown.inspected.figures.candidates[0].title.clone();
    let name = harness.get_by_label(&title).rect();
    let word = harness.get_by_label("Recognised").rect();
    let scrolled = harness.get_by_label("Offset from standard position").rect();
    assert!(
        scrolled.max.y < word.max.y,
        "not scrolled: {scrolled:?}, {word:?}"
    );
    assert!(52.0 <= name.min.y && name.max.y <= word.min.y, "{name:?}");
    assert!(word.max.y < SMALL.y / 2.0, "{word:?}");
    // Readable from three metres.
    assert!(
        name.height() >= 36.0 && word.height() >= 28.0,
        "{name:?}, {word:?}"
    );
    assert!(name.max.x <= SMALL.x, "{name:?}");
}

#[test]
fn keys_pressed_after_one_that_opens_a_dialog_do_nothing_even_in_the_same_frame() {
    let mut harness = open();
    let press = |harness: &mut WindowHarness, keys: &[Key]| {
        for key in keys {
            harness.input_mut().events.push(egui::Event::Key {
                key: *key,
                physical_key: None,
                pressed: true,
                repeat: false,
                modifiers: Modifiers::NONE,
            });
        }
        harness.step();
        let state = harness.state().state();
        let is_asked = harness.state().robot().dialog().is_some();
        (state.session.theme, state.help.is_some(), is_asked)
    };
    let dark = ThemeChoice::Dark;
    let after_help = press(&mut harness, &[Key::F1, Key::T, Key::B]);
    assert_eq!(after_help, (dark, true, false));
    act(&mut harness, Action::ToggleHelp);
    // In the order of pressing.
    let before_help = press(&mut harness, &[Key::T, Key::B, Key::F1]);
    assert_eq!(before_help, (dark.other(), false, true));
}

/// The controls of the window with their places.
fn controls(harness: &WindowHarness) -> Vec<(String, Rect)> {
    let roles = [Role::Button, Role::Tab, Role::TextInput, Role::Slider];
    let nodes = roles
        .into_iter()
        .flat_map(|role| harness.query_all_by_role(role));
    let named = nodes.map(|node| {
        let label = node.accesskit_node().label().unwrap_or_default();
        // The age of the frame goes on.
        let name = label.split(':').next().unwrap_or_default();
        (name.to_owned(), node.rect())
    });
    named.collect()
}

#[test]
fn notices_move_and_cover_no_control_in_any_workspace() {
    for size in [SMALL, USUAL] {
        let mut harness = open_with(size, plain_options());
        for kind in WorkspaceKind::ALL {
            act(&mut harness, Action::GoTo(kind));
            let before = controls(&harness);
            for what in ["The disk is nearly full", "The camera is warm", "A third"] {
                let notice = Notice::look(what, format!("Do something about it: {what}"));
                act(&mut harness, Action::Notify(notice));
            }
            let dismiss = harness.get_all_by_label("Dismiss");
            let of_notices = dismiss.map(|node| node.rect());
            let first = harness.get_by_label("The disk is nearly full.").rect();
            let covered = of_notices.fold(first, Rect::union);
            let after = controls(&harness);
            for control in &before {
                assert!(after.contains(control), "{kind:?}: {control:?} moved");
                let is_free = !control.1.intersects(covered);
                assert!(is_free, "{kind:?}: {control:?} under {covered:?}");
            }
            assert!(
                harness.ctx.content_rect().contains_rect(covered),
                "{kind:?}"
            );
            let all = harness.get_by_label("Dismiss all");
            let at = all.rect().center();
            all.click();
            harness.run_steps(2);
            assert!(harness.state().state().notices.is_empty());
            assert_eq!(controls(&harness), before, "{kind:?}");
            // A second press there reaches nothing for a while.
            let layer = |harness: &WindowHarness| harness.ctx.layer_id_at(at).map(|at| at.order);
            assert_eq!(layer(&harness), Some(Order::Middle), "{kind:?}");
            let_pass(&mut harness, 60);
            assert_ne!(layer(&harness), Some(Order::Middle), "{kind:?}");
        }
    }
}

#[test]
fn a_notice_leaves_the_focus_alone_and_is_dismissed_over_a_dialog() {
    let mut harness = open();
    // A full stop stands between the two sentences.
    let notice = Notice::look("The disk is nearly full", "Keep fewer frames");
    act(&mut harness, Action::Notify(notice));
    harness.get_by_label("The disk is nearly full.");
    harness.get_by_label("Keep fewer frames");
    let focused = |harness: &WindowHarness| harness.ctx.memory(egui::Memory::focused);
    harness.get_by_label("Enlarge contour").focus();
    harness.run_steps(2);
    let stage = focused(&harness);
    assert!(stage.is_some());
    act(&mut harness, Action::Dismiss(0));
    assert_eq!(focused(&harness), stage, "without a notice");
    act(
        &mut harness,
        Action::Notify(Notice::look("Another", "Look")),
    );
    assert_eq!(focused(&harness), stage, "with one");
    act(&mut harness, Action::ToggleHelp);
    harness.get_by_label("Shortcuts");
    harness.get_by_label("Dismiss").click();
    harness.run_steps(4);
    assert!(harness.state().state().notices.is_empty());
    harness.get_by_label("Shortcuts");
}

#[test]
fn the_next_step_is_a_button_on_the_card() {
    let mut harness = open();
    let shows = |harness: &WindowHarness, label| harness.query_by_label(label).is_some();
    for label in ["Enrol this part", "Calibrate the cell", "Why?"] {
        assert!(!shows(&harness, label), "{label}");
    }
    let hood = CellChoice::Foreign(ObjectKind::Hood);
    act(&mut harness, Action::UseCell(hood));
    press(&mut harness, "Enrol this part");
    let front = |harness: &WindowHarness| harness.state().state().session.workspace;
    assert_eq!(front(&harness), WorkspaceKind::Enrol);
    assert!(enrol_of(&harness).draft.is_some());
    act(&mut harness, Action::GoTo(WorkspaceKind::Inspect));
    press(&mut harness, "Why?");
    assert_eq!(front(&harness), WorkspaceKind::Compare);
    act(&mut harness, Action::GoTo(WorkspaceKind::Inspect));
    // A part from a camera's file that only lacks the calibration.
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("captured.pcd");
    let mut cloud = facing_part(PartKind::Fender, Side::Left, 5).cloud;
    cloud.is_simulated = false;
    save_cloud(&path, &cloud).expect("written");
    drop_file(&mut harness, &path);
    press(&mut harness, "Calibrate the cell");
    assert!(harness.state().robot().dialog().is_some());
}

#[test]
fn a_part_is_called_by_its_title_where_it_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("other.pcd");
    let scene = facing_part(PartKind::Fender, Side::Right, 5);
    save_cloud(&path, &scene.cloud).expect("written");
    let mut harness = open();
    drop_file(&mut harness, &path);
    let shown = harness
        .state()
        .state()
        .session
        .shown
        .as_ref()
        .expect("a result");
    let Verdict::Part {
        rejected: Some(why),
        ..
    } = &shown.inspected.inspection.verdict
    else {
        panic!("it is not enrolled");
    };
    assert!(why.to_string().contains("fender"), "{why}");
    let reason = why.to_string().replace("fender", "Fender, left");
    let reason = reason[..1].to_uppercase() + &reason[1..];
    harness.get_by_label(&reason);
}
