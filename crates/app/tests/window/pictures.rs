//! Strict pictures of the window, which reveal unintended changes of the drawing.
//!
//! They are valid for software rendering only, which draws the same everywhere; on another device, or without one,
//! these tests report that they are skipped. `UPDATE_SNAPSHOTS=1` redraws the pictures; look at them before you keep
//! them.

use std::{
    cell::RefCell,
    fs,
    path::PathBuf,
    sync::{Arc, LazyLock},
    time::Duration,
};

use ::servo::StopReason;
use app::{
    Window, WindowOptions,
    workspaces::{
        align::{AlignWorkspace, MethodRun},
        paint::{PaintAction, PaintWorkspace},
    },
};
use eframe::{egui_wgpu::RendererOptions, wgpu::DeviceType};
use egui::Vec2;
use egui_kittest::{
    Harness, SnapshotOptions,
    kittest::{AccessKitNode, By, Queryable as _},
    wgpu::{create_render_state, default_wgpu_setup},
};
use image::{Rgba, RgbaImage, imageops};
use inspection::{
    library::{LibraryFolder, PartName},
    pipeline::{Timings, Unwatched},
};
use shell::{
    action::Action,
    cell::{RobotAction, RobotPage},
    inspection::{
        camera::Camera,
        inspected::{InspectRequest, Inspected, inspect_all},
        library_cache::LibraryCache,
        source::{CellChoice, SceneSource},
    },
    notice::Notice,
    roles::RoleAction,
    session::WorkspaceKind,
};
use simulate::ObjectKind;
use tempfile::TempDir;

use inspection::fixtures::copy_library;

use super::{
    enrol, expecting, live, paint, rack_editor, robot, servo,
    set_up::{SMALL, USUAL, WindowHarness, act, act_in, plain_options, press, settle},
    several_parts,
    shots::ScanFolder,
};

/// Pixels that may differ: processors round the edges of points differently, which is not visible.
const MAX_DIFFERENT: usize = 100;

/// True if pictures can be compared with the kept ones; otherwise reports why not.
#[expect(clippy::print_stderr, reason = "a test that skips must say why")]
fn draws_in_software() -> bool {
    /// The name and kind of the adapter, or why there is none.
    static ADAPTER: LazyLock<Result<(String, DeviceType), String>> = LazyLock::new(|| {
        ui::viewport::ViewportGpu::headless().map_err(|error| error.to_string())?;
        let state = create_render_state(default_wgpu_setup(), RendererOptions::PREDICTABLE);
        let adapter = state.adapter.get_info();
        Ok((adapter.name, adapter.device_type))
    });
    match &*ADAPTER {
        Err(error) => geometry::fixtures::skipped("PARTSIGHT_REQUIRE_GPU", error),
        Ok((_, DeviceType::Cpu)) => return true,
        Ok((name, _)) => eprintln!("skipped: {name} is no software renderer"),
    }
    false
}

/// The inspection of the cell's first frame, with fixed times and date.
fn inspected() -> Inspected {
    static INSPECTED: LazyLock<Inspected> = LazyLock::new(|| inspected_of(CellChoice::InTurn));
    INSPECTED.clone()
}

fn inspected_of(choice: CellChoice) -> Inspected {
    inspected_by(choice, &LibraryCache::default())
}

fn inspected_by(choice: CellChoice, library_cache: &LibraryCache) -> Inspected {
    let request = InspectRequest {
        source: SceneSource::Cell { choice, number: 1 },
        recipe: Arc::default(),
    };
    let found = inspect_all(&request, library_cache, &Unwatched);
    let mut found = found.expect("inspected").remove(0);
    let ms = Duration::from_millis;
    found.inspection.timings = Timings {
        segment: ms(3),
        project: ms(1),
        contour: ms(1),
        signature: ms(1),
        rank: ms(1),
        pose: ms(9),
        total: ms(16),
    };
    found.at = jiff::Timestamp::UNIX_EPOCH;
    let record = &mut found.entry.record;
    record.summary.at = found.at;
    record.summary.total_ms = 16.0;
    // The line contains the times of the stages.
    record.detail.line = "{}".into();
    found
}

fn open_drawn(size: Vec2) -> WindowHarness {
    open_with(size, inspected())
}

thread_local! {
    /// The folders of the settings, until the test ends.
    static FOLDERS: RefCell<Vec<TempDir>> = const { RefCell::new(Vec::new()) };
}

/// Settings without starts of shifts: then every shift is "since 00:00", at any time of day.
fn timeless_settings() -> PathBuf {
    let folder = tempfile::tempdir().expect("a folder");
    let settings = folder.path().join("settings.toml");
    fs::write(&settings, "shifts = []").expect("written");
    FOLDERS.with_borrow_mut(|folders| folders.push(folder));
    settings
}

fn open_with(size: Vec2, inspected: Inspected) -> WindowHarness {
    let inspected = Arc::new(inspected);
    let mut harness = Harness::builder()
        .with_size(size)
        .wgpu()
        .build_eframe(move |cc| {
            let options = WindowOptions {
                // A neutral name, because it is in the picture.
                cases: Some("cases of the pictures".into()),
                settings: Some(timeless_settings()),
                ..plain_options()
            };
            let mut window =
                Window::new(&cc.egui_ctx, cc.wgpu_render_state.as_ref(), options).expect("threads");
            // Shown before the thread's own result, which is then dropped.
            window.show_result(Arc::clone(&inspected), &cc.egui_ctx);
            window
        });
    settle(&mut harness);
    harness
}

/// Shows the same alignments with fixed times.
fn run_again_in_no_time(harness: &mut WindowHarness) {
    let context = harness.ctx.clone();
    let window = harness.state_mut();
    window.with(&context, |workspace: &mut AlignWorkspace, _| {
        let align = &mut workspace.state;
        let shown = align.shown.as_ref().expect("aligned");
        let (pair, runs) = (Arc::clone(&shown.pair), shown.runs.clone());
        let runs = runs.iter().map(|run| {
            let mut run = MethodRun::clone(run);
            run.time = Duration::from_millis(100);
            Arc::new(run)
        });
        align.show(pair, runs);
    });
    settle(harness);
}

/// Compares the window with the kept picture; times and the speed of this computer are painted over.
fn compare(harness: &mut WindowHarness, name: &str) {
    // The pointer is not part of the picture.
    harness.remove_cursor();
    settle(harness);
    compare_as_it_is(harness, name);
}

/// The same for a window that does not become idle.
fn compare_as_it_is(harness: &mut WindowHarness, name: &str) {
    harness.remove_cursor();
    harness.run_steps(4);
    let mut picture = harness.render().expect("drawn");
    let timed = harness.query_all_by_label_contains(" ms");
    for mut rect in timed.map(|node| node.rect()) {
        // The same width for any number of digits.
        rect.max.x = rect.max.x.max(rect.min.x + 200.0);
        paint_over(&mut picture, rect);
    }
    for node in harness.query_all(By::new().predicate(is_time_of_day)) {
        // The same width for all digits.
        let mut rect = node.rect();
        rect.min.x = rect.min.x.min(rect.max.x - 64.0);
        paint_over(&mut picture, rect);
    }
    // The age of the calibration, too.
    for real in [
        "Age of the frame on the screen",
        "This computer inspects",
        "Calibrated by",
    ] {
        for node in harness.query_all_by_label_contains(real) {
            paint_over(&mut picture, node.rect());
        }
    }
    let session = &harness.state().state().session;
    let shown = session.shown.as_ref();
    if session.is_live() || shown.is_some_and(|shown| shown.parts.len() > 1) {
        // The times in the strip are real, too; other tests replace them by fixed ones.
        for cell in harness.query_all_by_label_contains("Enlarge ") {
            paint_over(&mut picture, time_of_stage(cell.rect()));
        }
    }
    // At half the size, a line that moved by a pixel still shows, in a quarter of the bytes.
    let half = imageops::thumbnail(&picture, picture.width() / 2, picture.height() / 2);
    let options = SnapshotOptions::new().max_failed_pixels(MAX_DIFFERENT);
    egui_kittest::image_snapshot_options(&half, name, &options);
}

/// True for a short text that ends in hours and minutes.
fn is_time_of_day(node: &AccessKitNode<'_>) -> bool {
    let label = node.value().or_else(|| node.label()).unwrap_or_default();
    let last = label.rsplit(' ').next().unwrap_or_default();
    label.len() < 20 && last.len() == 5 && jiff::civil::Time::strptime("%H:%M", last).is_ok()
}

/// Position of the time in a picture of the strip: below in a narrow one, else to the right of the title.
fn time_of_stage(cell: egui::Rect) -> egui::Rect {
    let height = 32.0;
    if cell.width() < 150.0 {
        cell.with_min_y(cell.max.y - height).shrink(1.0)
    } else {
        cell.with_max_y(cell.min.y + height)
            .with_min_x(cell.max.x - 70.0)
            .shrink(1.0)
    }
}

fn paint_over(picture: &mut RgbaImage, rect: egui::Rect) {
    let (width, height) = picture.dimensions();
    let columns = rect.left().floor() as u32..(rect.right().ceil() as u32).min(width);
    for x in columns {
        for y in rect.top().floor() as u32..(rect.bottom().ceil() as u32).min(height) {
            picture.put_pixel(x, y, Rgba([128, 128, 128, 255]));
        }
    }
}

#[test]
fn inspect_looks_as_it_did() {
    if !draws_in_software() {
        return;
    }
    compare(&mut open_drawn(USUAL), "inspect");
    let mut harness = open_drawn(SMALL);
    act(&mut harness, Action::SwitchTheme);
    compare(&mut harness, "inspect_small_light");
}

#[test]
fn a_refused_part_and_notices_look_as_they_did() {
    if !draws_in_software() {
        return;
    }
    let hood = CellChoice::Foreign(ObjectKind::Hood);
    for (size, is_light, name) in [
        (USUAL, false, "refused"),
        (SMALL, true, "refused_small_light"),
    ] {
        let mut harness = open_with(size, inspected_of(hood));
        if is_light {
            act(&mut harness, Action::SwitchTheme);
        }
        for what in [
            "The disk is nearly full",
            "No camera is plugged in",
            "Robots get no pose",
        ] {
            let notice = Notice::look(what, format!("{what}: do something about it"));
            act(&mut harness, Action::Notify(notice));
        }
        compare(&mut harness, name);
        act(&mut harness, Action::DismissAll);
        act(&mut harness, Action::Role(RoleAction::Switch));
        compare(&mut harness, &format!("{name}_operator"));
    }
}

#[test]
fn the_operators_view_looks_as_it_did() {
    if !draws_in_software() {
        return;
    }
    for (size, is_light, name) in [
        (USUAL, false, "operator"),
        (SMALL, true, "operator_small_light"),
    ] {
        let mut found = inspected();
        // In the present shift.
        found.entry.record.summary.at = geometry::clock::now();
        // As if the cell was followed: only then its parts are counted.
        found.entry.record.summary.source = "simulated".into();
        let mut harness = open_with(size, found);
        if is_light {
            act(&mut harness, Action::SwitchTheme);
        }
        act(&mut harness, Action::Role(RoleAction::Switch));
        compare(&mut harness, name);
    }
}

#[test]
fn several_parts_look_as_they_did() {
    if !draws_in_software() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_drawn(USUAL);
    several_parts::open_rack(&mut harness, folder.path());
    compare(&mut harness, "rack");
    let mut harness = open_drawn(SMALL);
    act(&mut harness, Action::SwitchTheme);
    several_parts::open_rack(&mut harness, folder.path());
    harness.get_by_label_contains("2 Radiator support").click();
    compare(&mut harness, "rack_small_light");
    act(&mut harness, Action::Role(RoleAction::Switch));
    compare(&mut harness, "rack_operator_small_light");
}

#[test]
fn the_window_of_the_rack_looks_as_it_did() {
    if !draws_in_software() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    for (size, is_light, name) in [
        (USUAL, false, "places"),
        (SMALL, true, "places_small_light"),
    ] {
        let mut harness = open_drawn(size);
        if is_light {
            act(&mut harness, Action::SwitchTheme);
        }
        rack_editor::open_place(&mut harness, folder.path());
        harness.get_by_label_contains("1 · front_door").click();
        compare(&mut harness, name);
    }
}

#[test]
fn a_rack_that_is_not_as_its_order_expects_looks_as_it_did() {
    if !draws_in_software() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    for (size, is_light, name) in [(USUAL, false, "order"), (SMALL, true, "order_small_light")] {
        let mut harness = open_drawn(size);
        if is_light {
            act(&mut harness, Action::SwitchTheme);
        }
        expecting::use_orders(&mut harness, folder.path());
        expecting::enter_order(&mut harness, "4713");
        // The view is fitted when the frame arrives, and a notice, which leaves by itself, takes some of its height.
        act(&mut harness, Action::DismissAll);
        several_parts::open_rack(&mut harness, folder.path());
        act(&mut harness, Action::DismissAll);
        compare(&mut harness, name);
        act(&mut harness, Action::Role(RoleAction::Switch));
        compare(&mut harness, &name.replace("order", "order_operator"));
    }
}

#[test]
fn servoing_looks_as_it_did() {
    if !draws_in_software() {
        return;
    }
    for (size, is_light, name) in [(USUAL, false, "servo"), (SMALL, true, "servo_small_light")] {
        let mut harness = open_drawn(size);
        if is_light {
            act(&mut harness, Action::SwitchTheme);
        }
        act(&mut harness, Action::GoTo(WorkspaceKind::Servo));
        if is_light {
            // Before the first run, with what a real robot needs.
            press(&mut harness, "KUKA");
        } else {
            servo::show_run(&mut harness);
        }
        compare(&mut harness, name);
    }
}

#[test]
fn runs_in_the_history_look_as_they_did() {
    if !draws_in_software() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let mut history = records::fixtures::open_history(folder.path());
    let moved = StopReason::Moved {
        shift_m: 0.05,
        turn_rad: 0.02,
    };
    for (seconds, stopped) in [(0, None), (86_400, Some(moved)), (90_000, None)] {
        let record = records::fixtures::servo_record(seconds, "fender", stopped);
        history.add_servo_run(&record).expect("written");
    }
    drop(history);
    for (size, is_light, name) in [
        (USUAL, false, "servo_runs"),
        (SMALL, true, "servo_runs_small_light"),
    ] {
        let options = WindowOptions {
            history: Some(folder.path().to_owned()),
            settings: Some(timeless_settings()),
            ..plain_options()
        };
        let mut harness = super::set_up::open_with(size, options);
        if is_light {
            act(&mut harness, Action::SwitchTheme);
        }
        act(&mut harness, Action::GoTo(WorkspaceKind::History));
        press(&mut harness, "Servo runs");
        harness.get_by_label_contains("Run 2: fender").click();
        compare(&mut harness, name);
    }
}

#[test]
fn a_scan_looks_as_it_did() {
    if !draws_in_software() {
        return;
    }
    let scan = ScanFolder::new(3);
    let mut harness = open_drawn(SMALL);
    act(&mut harness, Action::GoTo(WorkspaceKind::Enrol));
    act(&mut harness, Action::Open(scan.scan()));
    compare(&mut harness, "scan");
}

#[test]
fn live_looks_as_it_did() {
    if !draws_in_software() {
        return;
    }
    let open = |size| {
        let (options, wire) = live::wired_options();
        let mut harness = Harness::builder()
            .with_size(size)
            .wgpu()
            .build_eframe(move |cc| {
                Window::new(&cc.egui_ctx, cc.wgpu_render_state.as_ref(), options).expect("threads")
            });
        settle(&mut harness);
        live::toggle(&mut harness);
        (harness, wire)
    };
    let (mut harness, wire) = open(USUAL);
    live::sees(&mut harness, &wire, [0.0; 16]);
    compare_as_it_is(&mut harness, "live_steady");
    let (mut harness, wire) = open(SMALL);
    let context = harness.ctx.clone();
    harness.state_mut().act(Action::SwitchTheme, &context);
    live::sees(
        &mut harness,
        &wire,
        [0.0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.12],
    );
    compare_as_it_is(&mut harness, "live_moving_small_light");
}

#[test]
fn choosing_a_source_looks_as_it_did() {
    if !draws_in_software() {
        return;
    }
    let mut harness = open_drawn(SMALL);
    harness.get_by_label_contains("Source").click();
    harness.run_steps(6);
    compare_as_it_is(&mut harness, "source_menu");
    harness.get_by_label("Set up the cell…").click();
    harness.run_steps(6);
    compare_as_it_is(&mut harness, "cell_set_up");
}

#[test]
fn the_robots_cell_looks_as_it_did() {
    if !draws_in_software() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let pairs = folder.path().join("pairs.csv");
    std::fs::write(&pairs, robot::pairs(&robot::TURNS)).expect("written");
    let mut harness = open_drawn(USUAL);
    act(
        &mut harness,
        Action::Robot(RobotAction::Pairs(pairs.clone())),
    );
    compare(&mut harness, "robot_pairs");

    let parts = folder.path().join("parts");
    copy_library(&parts);
    let name = PartName::new("front_door").expect("a name");
    let library = LibraryFolder::open(&parts).expect("a library");
    library
        .set_spray_path(&name, Some(&robot::door_path()))
        .expect("stored");
    let cell = folder.path().join("cell.toml");
    robot::save_calibration(&cell);
    let library_cache = LibraryCache::new(Some(parts), Camera::default());
    for (size, is_light, name) in [
        (USUAL, false, "spray_path"),
        (SMALL, true, "spray_path_small_light"),
    ] {
        let mut harness = open_with(size, inspected_by(CellChoice::InTurn, &library_cache));
        if is_light {
            act(&mut harness, Action::SwitchTheme);
        }
        act(&mut harness, Action::Robot(RobotAction::Load(cell.clone())));
        if !is_light {
            // From the top the rays can be told apart.
            press(&mut harness, "Top");
        }
        compare(&mut harness, name);
    }
    let mut harness = open_drawn(SMALL);
    act(&mut harness, Action::Robot(RobotAction::Load(cell)));
    act(&mut harness, Action::Robot(RobotAction::Toggle));
    let mut dialog = harness.state().robot().dialog().expect("open").clone();
    dialog.page = RobotPage::Answer;
    let turned = RobotAction::Edit(Box::new(dialog));
    act(&mut harness, Action::Robot(turned));
    compare(&mut harness, "robot_answers");
    let turns: Vec<[f64; 3]> = (0..6).map(|i| [0.0, 0.0, 0.3 * f64::from(i)]).collect();
    std::fs::write(&pairs, robot::pairs(&turns)).expect("written");
    let mut harness = open_drawn(SMALL);
    act(&mut harness, Action::SwitchTheme);
    act(&mut harness, Action::Robot(RobotAction::Pairs(pairs)));
    compare(&mut harness, "robot_doubts_small_light");
}

#[test]
fn the_other_workspaces_look_as_they_did() {
    if !draws_in_software() {
        return;
    }
    let mut harness = open_drawn(SMALL);
    act(&mut harness, Action::GoTo(WorkspaceKind::Enrol));
    compare(&mut harness, "enrol");
    act(&mut harness, Action::GoTo(WorkspaceKind::Compare));
    compare(&mut harness, "compare");
    act(&mut harness, Action::GoTo(WorkspaceKind::Align));
    press(&mut harness, "T4");
    press(&mut harness, "Run");
    run_again_in_no_time(&mut harness);
    compare(&mut harness, "align");
    act(&mut harness, Action::GoTo(WorkspaceKind::Paint));
    compare(&mut harness, "paint");
    // The time of day depends on the time zone of the machine.
    if jiff::tz::TimeZone::system().to_offset(jiff::Timestamp::UNIX_EPOCH) == jiff::tz::Offset::UTC
    {
        act(&mut harness, Action::GoTo(WorkspaceKind::History));
        compare(&mut harness, "history");
    }
}

#[test]
fn a_path_with_a_keep_out_looks_as_it_did() {
    if !draws_in_software() {
        return;
    }
    let mut harness = open_drawn(SMALL);
    act(&mut harness, Action::GoTo(WorkspaceKind::Paint));
    act(&mut harness, Action::SwitchTheme);
    act_in(&mut harness, |paint: &mut PaintWorkspace, cx| {
        paint.state.apply(PaintAction::Step(5), cx);
    });
    paint::open_tab(&mut harness, "Regions");
    press(&mut harness, "Keep out: box");
    paint::draw(&mut harness, &[(0.4, 0.4), (0.55, 0.6)]);
    compare(&mut harness, "paint_keep_out_small_light");
}

#[test]
fn a_lasso_over_a_draft_looks_as_it_did() {
    if !draws_in_software() {
        return;
    }
    let mut harness = open_drawn(SMALL);
    act(&mut harness, Action::GoTo(WorkspaceKind::Enrol));
    act(&mut harness, Action::SwitchTheme);
    press(&mut harness, "Use the inspected scene");
    press(&mut harness, "Side");
    press(&mut harness, "Lasso");
    press(&mut harness, "Drop");
    enrol::draw_in_view(&mut harness, &LASSO);
    compare(&mut harness, "enrol_lasso_small_light");
}

/// A lasso around what stands out to the left of a part seen from the side, in shares of the view.
const LASSO: [(f32, f32); 5] = [
    (0.2, 0.4),
    (0.35, 0.3),
    (0.6, 0.45),
    (0.5, 0.75),
    (0.3, 0.7),
];
