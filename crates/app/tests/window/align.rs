//! The Align workspace, tested by its labels and controls. Needs no graphics adapter.

use app::workspaces::align::{
    AlignAction, AlignFile, AlignState, AlignWorkspace, Pairing, Playback, Start,
};
use egui::{Key, Role, Vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use shell::{
    action::Action, inspection::source::CellChoice, notice::NoticeKind, session::WorkspaceKind,
};
use simulate::{PartKind, Side};
use stages::pose::PoseMethod;
use ui::language::Language;

use super::set_up::{
    SMALL, USUAL, WindowHarness, act, act_in, open_with, plain_options, settle, wait_for,
};

fn open_at(size: Vec2) -> WindowHarness {
    let mut harness = open_with(size, plain_options());
    press_quickly(&mut harness, "Align");
    assert_eq!(
        harness.state().state().session.workspace,
        WorkspaceKind::Align
    );
    harness
}

fn open() -> WindowHarness {
    open_at(USUAL)
}

fn own(harness: &WindowHarness) -> &AlignState {
    let workspace = harness.state().workspace::<AlignWorkspace>();
    &workspace.expect("the workspace").state
}

/// Presses a button without waiting for the result.
fn press_quickly(harness: &mut WindowHarness, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(2);
}

/// The iteration shown.
fn iteration(harness: &WindowHarness) -> usize {
    own(harness).iteration.round() as usize
}

#[test]
fn a_scene_is_aligned_to_the_part_that_it_was_recognised_as() {
    let mut harness = open_with(USUAL, plain_options());
    act(
        &mut harness,
        Action::UseCell(CellChoice::Part(PartKind::Fender, Side::Left)),
    );
    press_quickly(&mut harness, "Align");
    harness.get_by_label_contains("Part · Back bumper");
    press_quickly(&mut harness, "Scene");
    harness.get_by_label_contains("Part · Fender, left");
}

#[test]
fn a_part_from_t4_is_aligned_by_every_method_and_scrubbed() {
    let mut harness = open();
    harness.get_by_label("Nothing aligned yet");
    harness.get_by_label_contains("Part · ").click();
    harness.run_steps(2);
    press_quickly(&mut harness, "Fender, left");
    press_quickly(&mut harness, "T4");
    press_quickly(&mut harness, "Run");
    settle(&mut harness);
    let num_methods = PoseMethod::ALL.len();
    let align = own(&harness);
    let shown = align.shown.as_ref().expect("a result");
    assert_eq!(shown.pair.title(), "Fender, left from T4");
    assert_eq!(shown.runs.len(), num_methods);
    harness.get_by_label("Fender, left from T4");
    assert_eq!(
        harness.get_all_by_label_contains("3-D view, ").count(),
        num_methods
    );
    let figures = harness.get_all_by_label_contains(" · rms ");
    assert_eq!(figures.count(), num_methods);
    harness.get_by_label("True error at this start");
    assert!(harness.get_all_by_label("0.00°").count() >= 1);
    assert!(harness.get_all_by_label("0.0 mm").count() >= 1);

    let last = iteration(&harness);
    assert!(last > 3);
    harness.get_by_label("Iteration shown").focus();
    harness.run_steps(2);
    harness.key_press(Key::ArrowLeft);
    harness.run_steps(2);
    assert_eq!(iteration(&harness), last - 1);
    harness.get_by_label_contains(&format!("iteration {} of {last}", last - 1));
    harness.key_press(Key::Home);
    harness.run_steps(2);
    assert_eq!(iteration(&harness), 0);
    // The label names P, which plays wherever the focus is; Space plays on the plot only, and captures elsewhere.
    harness.get_by_label_contains("drag to scrub, P to play");
    // While the plot has the focus, Space plays and does not capture.
    let num_captures = harness.state().state().inspector.num_captures;
    harness.key_press(Key::Space);
    harness.run_steps(3);
    assert_eq!(own(&harness).playback, Playback::Playing);
    assert!(iteration(&harness) > 0);
    press_quickly(&mut harness, "Pause");
    let paused = iteration(&harness);
    harness.run_steps(3);
    assert_eq!(iteration(&harness), paused);
    harness.key_press(Key::Period);
    harness.run_steps(2);
    assert_eq!(iteration(&harness), paused + 1);
    assert_eq!(harness.state().state().inspector.num_captures, num_captures);

    // In a small window, the longest words leave room for the title, which follows the language.
    harness.set_size(SMALL);
    act(&mut harness, Action::Speak(Language::German));
    let title = harness.get_by_label("Fender, left · T4").rect();
    let iteration = harness.get_by_label_contains("Iteration ").rect();
    assert!(title.right() < iteration.left(), "{title} {iteration}");
}

#[test]
fn a_drag_on_the_plot_scrubs() {
    let mut harness = open();
    press_quickly(&mut harness, "Run");
    settle(&mut harness);
    let last = iteration(&harness);
    let plot = harness.get_by_label("Iteration shown").rect();
    let (from, to) = (plot.right_center() - Vec2::new(20.0, 0.0), plot.center());
    harness.drag_at(from);
    harness.run_steps(2);
    harness.hover_at(to);
    harness.run_steps(2);
    harness.drop_at(to);
    harness.run_steps(2);
    assert!((last / 5..last * 4 / 5).contains(&iteration(&harness)));
}

#[test]
fn a_cancelled_table_keeps_its_rows_and_a_row_opens() {
    let mut harness = open();
    press_quickly(&mut harness, "Run Table I");
    wait_for(&mut harness, |window| {
        let workspace = window.workspace::<AlignWorkspace>();
        workspace.is_some_and(|align| !align.state.table.rows.is_empty())
    });
    harness.get_by_label_contains(" of 40 done");
    press_quickly(&mut harness, "Cancel Table I");
    assert!(harness.state().is_idle());
    let num = own(&harness).table.rows.len();
    assert!((1..40).contains(&num), "{num} rows");
    harness.get_by_label(&format!("Stopped at {num} of 40"));
    harness.run_steps(5);
    assert_eq!(own(&harness).table.rows.len(), num);

    let row = &own(&harness).table.rows[0];
    let label = format!("{}, T1", row.title);
    let title = format!("{} from T1", row.title);
    harness.get_by_label_contains(&label).click();
    settle(&mut harness);
    harness.get_by_label(&title);

    press_quickly(&mut harness, "Copy");
    let notices = &harness.state().state().notices;
    assert!(
        notices
            .iter()
            .any(|n| n.kind == NoticeKind::Done && n.what == "Copied Table I")
    );
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("table1.csv");
    let chosen = AlignAction::Chosen(AlignFile::TableFile, path.clone());
    act_in(&mut harness, |workspace: &mut AlignWorkspace, cx| {
        workspace.state.apply(chosen, cx);
    });
    let text = std::fs::read_to_string(&path).expect("written");
    assert_eq!(text.lines().count(), 1 + num);
    harness.get_by_label(&format!("Wrote {}", path.display()));
}

#[test]
fn the_part_of_the_scene_in_front_is_aligned_to_the_reference() {
    let mut harness = open();
    press_quickly(&mut harness, "Scene");
    harness.get_by_label_contains("Simulated frame 1: the part found");
    harness.get_by_label_contains("Part · ").click();
    harness.run_steps(2);
    press_quickly(&mut harness, "Front door, left");
    harness.key_press(Key::R);
    settle(&mut harness);
    harness.get_by_label("Simulated frame 1 onto Front door, left");
    // Inspect bounds another pose, which the outline in the picture holds too.
    harness.get_by_label("Uncertainty of the alignment (95 %)");
    assert!(harness.query_by_label("Uncertainty (95 %)").is_none());
    let align = own(&harness);
    let shown = align.shown.as_ref().expect("a result");
    let global = shown
        .tracks()
        .find(|(run, _)| run.method == PoseMethod::Global);
    let (_, track) = global.expect("a pose");
    assert!(
        track.fit.overlap > 0.9 && track.fit.rms_m < 0.005,
        "{:?}",
        track.fit
    );
}

#[test]
fn a_custom_start_is_written_and_a_random_one_comes_again() {
    let mut harness = open();
    press_quickly(&mut harness, "Custom…");
    let field = harness.get_by_label("Custom start, six numbers");
    field.focus();
    harness.run_steps(2);
    harness
        .get_by_label("Custom start, six numbers")
        .type_text("0 0 3");
    harness.run_steps(2);
    harness.get_by_label_contains("expected six");
    harness
        .get_by_label("Custom start, six numbers")
        .type_text("0deg 10mm 0 0");
    harness.run_steps(2);
    press_quickly(&mut harness, "Use this start");
    assert!(matches!(own(&harness).start, Start::Custom(_)));
    assert!(harness.query_by_label("Use this start").is_none());

    press_quickly(&mut harness, "Random");
    harness.get_by_label("Random start number 1");
    let ends = |harness: &mut WindowHarness| {
        press_quickly(harness, "Run");
        settle(harness);
        let align = own(harness);
        let shown = align.shown.as_ref().expect("a result");
        let poses = shown.tracks().map(|(_, track)| track.poses.clone());
        poses.collect::<Vec<_>>()
    };
    let first = ends(&mut harness);
    assert_eq!(ends(&mut harness), first);
    press_quickly(&mut harness, "Random");
    harness.get_by_label("Random start number 2");
    assert_ne!(ends(&mut harness), first);
}

#[test]
fn a_run_is_cancelled_at_once() {
    let mut harness = open();
    press_quickly(&mut harness, "Run Table I");
    if let Some(cancel) = harness.query_by_label("Cancel") {
        cancel.click();
    }
    harness.run_steps(2);
    assert!(own(&harness).running().is_none());
}

#[test]
fn every_control_is_large_enough_labelled_and_inside_a_small_window() {
    let size = SMALL;
    let mut harness = open_at(size);
    press_quickly(&mut harness, "Run");
    settle(&mut harness);
    press_quickly(&mut harness, "Random");
    press_quickly(&mut harness, "Custom…");
    for pairing in Pairing::ALL {
        press_quickly(&mut harness, &pairing.title());
        let mut num_controls = 0;
        for role in [Role::Button, Role::Tab, Role::Slider, Role::TextInput] {
            for node in harness.query_all_by_role(role) {
                let label = node.accesskit_node().label().unwrap_or_default();
                let rect = node.rect();
                assert!(!label.is_empty(), "a control at {rect:?} has no label");
                assert!(
                    rect.width() >= 35.9 && rect.height() >= 35.9,
                    "{label}: {rect:?}"
                );
                assert!(
                    rect.min.x >= 0.0
                        && rect.max.x <= size.x
                        && rect.min.y >= 0.0
                        && rect.max.y <= size.y,
                    "{label}: {rect:?}"
                );
                num_controls += 1;
            }
        }
        assert!(num_controls >= 12, "{num_controls} controls");
    }
}
