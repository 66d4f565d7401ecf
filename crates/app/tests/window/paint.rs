//! The Paint workspace, tested by its labels and controls. Needs no graphics adapter.

use std::{f64::consts::FRAC_PI_2, path::Path};

use ::robot::paint::KeepOut;
use app::{
    WindowOptions,
    workspaces::paint::{
        PaintAction, PaintFile, PaintState, PaintTool, PaintWorkspace, Playback, ShownPath,
    },
};
use egui::{Key, Modifiers, Role, Vec2};
use egui_kittest::{
    Node,
    kittest::{NodeT as _, Queryable as _},
};
use geometry::rigid::from_euler_zyx;
use inspection::library::{LibraryFolder, SprayPath};
use shell::{
    action::Action,
    cell::{ProgramSetup, RobotAction},
    session::{PaintTab, WorkspaceKind},
};

use inspection::fixtures::copy_library;

use super::{
    enrol, robot,
    set_up::{
        SMALL, USUAL, WindowHarness, act, act_in, let_pass, open_with, plain_options, press, settle,
    },
};

/// Opens the Paint workspace with a path over the fender.
fn open_at(size: Vec2, options: WindowOptions) -> WindowHarness {
    let mut harness = open_with(size, options);
    act(&mut harness, Action::GoTo(WorkspaceKind::Paint));
    let menu = format!("Part to paint: {}", part(&harness));
    press(&mut harness, &menu);
    press(&mut harness, "Fender, left");
    harness
}

fn open() -> WindowHarness {
    open_at(USUAL, plain_options())
}

/// Opens a window with a library of its own.
fn open_own(folder: &Path) -> WindowHarness {
    let library = folder.join("parts");
    copy_library(&library);
    let options = WindowOptions {
        library: Some(library),
        recipes: Some(folder.join("recipes")),
        ..plain_options()
    };
    open_at(SMALL, options)
}

fn own(harness: &WindowHarness) -> &PaintState {
    let workspace = harness.state().workspace::<PaintWorkspace>();
    &workspace.expect("the workspace").state
}

/// The title of the part that is painted.
fn part(harness: &WindowHarness) -> String {
    let session = &harness.state().state().session;
    let part = own(harness).part(session).expect("a part");
    let library = session.library.as_ref().expect("a library");
    library.title_of(part.as_str()).to_owned()
}

/// Shows the tab with this title.
pub(crate) fn open_tab(harness: &mut WindowHarness, title: &str) {
    harness.get_by_role_and_label(Role::Tab, title).click();
    settle(harness);
}

/// Points of the path and litres of paint.
fn figures(harness: &WindowHarness) -> (usize, f64) {
    let planned = own(harness).planned.as_ref().expect("planned");
    (planned.path.points().len(), planned.film.path.paint)
}

/// Draws along this path, in shares of the view, and releases the button.
pub(crate) fn draw(harness: &mut WindowHarness, way: &[(f32, f32)]) {
    let view = harness.get_by_label("3-D view of the part and its spray path");
    let view = view.rect();
    let way = way
        .iter()
        .map(|(x, y)| view.min + view.size() * Vec2::new(*x, *y));
    let way: Vec<egui::Pos2> = way.collect();
    enrol::draw(harness, &way);
    enrol::let_go(harness);
}

#[test]
fn a_part_is_planned_when_it_is_chosen_and_its_film_is_told() {
    let mut harness = open();
    assert_eq!(part(&harness), "Fender, left");
    harness.get_by_label_contains("% of the surface within 40 ± 8 µm");
    harness.get_by_label_contains("Of the side that the camera saw");
    harness.get_by_label_contains("stroke 1 of ");
    let (num, _) = figures(&harness);
    press(&mut harness, "Pattern: Cross-hatch");
    assert!(figures(&harness).0 > 3 * num / 2);
    // Twice the film thickness is out of tolerance.
    let before = own(&harness)
        .planned
        .as_ref()
        .expect("planned")
        .film
        .figures
        .within;
    assert!(before < 0.5, "{before}");
    press(&mut harness, "Propose");
    let after = own(&harness)
        .planned
        .as_ref()
        .expect("planned")
        .film
        .figures
        .within;
    assert!(after > 0.9, "{after}");
    harness.get_by_label_contains("Coat: primer, changed");
    press(&mut harness, "Undo");
    press(&mut harness, "Undo");
    assert_eq!(figures(&harness).0, num);
}

#[test]
fn what_is_drawn_around_gets_no_paint_and_ctrl_z_brings_it_back() {
    let mut harness = open();
    let (_, whole) = figures(&harness);
    open_tab(&mut harness, "Regions");
    press(&mut harness, "Keep out: box");
    harness.get_by_label_contains("Drag around what gets no paint");
    draw(&mut harness, &[(0.35, 0.3), (0.6, 0.7)]);
    assert!(matches!(
        own(&harness).design.regions[..],
        [KeepOut::Polygon { .. }]
    ));
    let (_, less) = figures(&harness);
    assert!(less < 0.95 * whole, "{less} of {whole}");
    press(&mut harness, "Keep out: brush");
    draw(&mut harness, &[(0.45, 0.35), (0.5, 0.36), (0.55, 0.37)]);
    assert!(own(&harness).design.regions.len() > 2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut harness);
    let (_, again) = figures(&harness);
    assert!((again - whole).abs() < 1e-12);
    // An area to be painted is the opposite: only what lies in the box gets paint.
    press(&mut harness, "Paint only: in a box");
    draw(&mut harness, &[(0.35, 0.3), (0.6, 0.7)]);
    let (_, only) = figures(&harness);
    assert!(only < 0.7 * whole, "{only} of {whole}");
}

#[test]
fn a_path_is_stored_with_its_part_and_shown_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_own(folder.path());
    press(&mut harness, "Store with the part");
    let library = LibraryFolder::open(&folder.path().join("parts")).expect("opened");
    let stored = library.spray_path("fender").expect("read").expect("stored");
    let (num, _) = figures(&harness);
    assert_eq!(stored.points().len(), num);
    press(&mut harness, &format!("Stored, {num} points"));
    assert_eq!(own(&harness).shown_path, ShownPath::Stored);
    let file = folder.path().join("path.csv");
    let to = file.clone();
    act_in(&mut harness, |paint: &mut PaintWorkspace, cx| {
        let chosen = PaintAction::Chosen(PaintFile::Table, to);
        paint.state.apply(chosen, cx);
    });
    assert_eq!(SprayPath::read(&file).expect("read").points().len(), num);
    press(&mut harness, "Undo");
    assert_eq!(library.spray_path("fender").expect("read"), None);
}

#[test]
fn the_timeline_moves_the_gun_by_hand_by_key_and_by_itself() {
    let mut harness = open();
    let end = own(&harness).duration();
    harness
        .get_by_label("Place of the gun on the path, seconds")
        .focus();
    harness.run_steps(2);
    harness.key_press(Key::End);
    harness.run_steps(2);
    assert!((own(&harness).time - end).abs() < 1e-9);
    harness.key_press(Key::Home);
    harness.run_steps(2);
    harness.key_press(Key::ArrowRight);
    harness.run_steps(2);
    assert!((own(&harness).time - 0.5).abs() < 1e-9);
    let num_captures = harness.state().state().inspector.num_captures;
    harness.key_press(Key::Space);
    harness.run_steps(3);
    assert_eq!(own(&harness).playback, Playback::Playing);
    assert!(own(&harness).time > 0.5);
    harness.key_press(Key::P);
    harness.run_steps(2);
    assert_eq!(own(&harness).playback, Playback::Paused);
    harness.key_press(Key::Period);
    harness.run_steps(2);
    harness.get_by_label_contains("· gun on");
    assert_eq!(harness.state().state().inspector.num_captures, num_captures);
}

#[test]
fn a_coat_is_kept_under_a_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_own(folder.path());
    press(&mut harness, "Propose");
    press(&mut harness, "Coat: primer, changed");
    press(&mut harness, "Save as…");
    // The field has the focus already.
    harness
        .get_by_label("Name of the coat")
        .type_text("booth_3");
    harness.run_steps(2);
    press(&mut harness, "Save");
    harness.get_by_label("Coat: booth_3");
    assert!(folder.path().join("coats/booth_3.toml").exists());
}

#[test]
fn an_arm_is_chosen_its_reach_shown_and_the_program_exported() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_own(folder.path());
    open_tab(&mut harness, "Robot");
    harness.get_by_label_contains("Calibrate the cell first");
    let cell = folder.path().join("cell.toml");
    robot::save_calibration(&cell);
    act(&mut harness, Action::Robot(RobotAction::Load(cell)));
    press(&mut harness, "Arm: No arm");
    press(&mut harness, "ABB IRB 4600-40/2.55");
    // Below the field for it, above everything else.
    harness.get_by_label("Arm: not checked");
    let message = harness.get_by_label_contains("cannot be checked without the nozzle's place");
    let below = harness.get_by_label("Obstacles: Only the part");
    assert!(message.rect().bottom() < below.rect().top());
    let nozzle = |harness: &WindowHarness, text: Option<&str>| {
        let field = harness.get_by_role_and_label(Role::TextInput, "Nozzle on the flange");
        match text {
            None => field.focus(),
            Some(text) => field.type_text(text),
        }
    };
    nozzle(&harness, None);
    harness.run_steps(2);
    nozzle(&harness, Some("kuka 0 0 250 0 45 0"));
    settle(&mut harness);
    let session = |harness: &WindowHarness| harness.state().state().session.program.clone();
    assert_eq!(session(&harness).nozzle, "kuka 0 0 250 0 45 0");
    // With the base as calibrated, the arm does not reach all points.
    harness.get_by_label_contains("% of the path reached, all but ");
    harness.get_by_label_contains(
        "Not checked: collisions with anything but part and arm, such as the part's stand; accelerations of the joints",
    );
    press(&mut harness, "Show next");
    // A box around the whole reach of the arm.
    let boxes = folder.path().join("boxes.toml");
    let text = "[[box]]\nname = \"lamp\"\ncentre_mm = [0, 0, 0]\nsize_mm = [9000, 9000, 9000]\n";
    std::fs::write(&boxes, text).expect("written");
    harness.get_by_label("Collisions");
    act_in(&mut harness, |paint: &mut PaintWorkspace, cx| {
        let chosen = PaintAction::Chosen(PaintFile::Obstacles, boxes);
        paint.state.apply(chosen, cx);
    });
    harness.get_by_label_contains("too near to the box lamp");
    press(&mut harness, "Obstacles: boxes.toml");
    press(&mut harness, "Only the part");
    assert_eq!(session(&harness).obstacles, None);
    harness.get_by_label("Obstacles: Only the part");
    let file = folder.path().join("paint.mod");
    let export = |harness: &mut WindowHarness| {
        let to = file.clone();
        act_in(harness, |paint: &mut PaintWorkspace, cx| {
            let chosen = PaintAction::Chosen(PaintFile::Program, to);
            paint.state.apply(chosen, cx);
        });
        settle(harness);
    };
    export(&mut harness);
    assert!(!file.exists());
    // Without an arm, reach is not checked.
    press(&mut harness, "Arm: ABB IRB 4600-40/2.55");
    harness.get_by_label("No arm").click();
    settle(&mut harness);
    export(&mut harness);
    let program = std::fs::read_to_string(&file).expect("written");
    assert!(program.contains("MODULE"), "{program}");
}

#[test]
fn the_base_of_the_arm_is_entered_a_better_one_applied_and_both_are_undone() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_own(folder.path());
    open_tab(&mut harness, "Robot");
    // The camera looks along the x axis of the robot's base.
    let cell = folder.path().join("cell.toml");
    let robot_from_camera = from_euler_zyx([-FRAC_PI_2, 0.0, -FRAC_PI_2, 0.0, 0.0, 1.2]);
    robot::save_calibration_of(&cell, robot_from_camera);
    act(&mut harness, Action::Robot(RobotAction::Load(cell)));
    let set_up = |harness: &mut WindowHarness, nozzle: &str| {
        let setup = ProgramSetup {
            arm: Some("irb4600".into()),
            nozzle: nozzle.into(),
            ..ProgramSetup::default()
        };
        act_in(harness, |paint: &mut PaintWorkspace, cx| {
            paint.state.apply(PaintAction::SetUp(setup), cx);
        });
    };
    // The notice goes as soon as the nozzle is entered.
    let num_notices = |harness: &WindowHarness| {
        let notices = harness.state().state().notices.iter();
        let about_nozzle = notices.filter(|notice| notice.what.contains("nozzle's place"));
        about_nozzle.count()
    };
    set_up(&mut harness, "");
    press(&mut harness, "Program…");
    assert_eq!(num_notices(&harness), 1);
    set_up(&mut harness, "kuka 0 0 250 0 -45 0");
    assert_eq!(num_notices(&harness), 0);
    harness.get_by_label_contains("100 % of the path reached");

    let base = |harness: &WindowHarness| harness.state().state().session.program.base[0];
    let num_reached = |harness: &WindowHarness| {
        let reach = own(harness).reach(&harness.state().state().session);
        let reach = reach.expect("checked").as_ref().expect("an arm");
        reach.check.num_reached()
    };
    let field = |harness: &mut WindowHarness, act: &dyn Fn(&Node<'_>)| {
        act(&harness.get_by_role_and_label(Role::SpinButton, "Base of the arm: X"));
        let_pass(harness, 30);
    };
    field(&mut harness, &|node| node.scroll_to_me());
    field(&mut harness, &|node| node.click());
    field(&mut harness, &|node| node.type_text("-1800"));
    harness.key_press(Key::Enter);
    settle(&mut harness);
    assert!((base(&harness) + 1800.0).abs() < 1e-9);
    let num_far = num_reached(&harness);
    press(&mut harness, "Move the base there");
    assert!(base(&harness) > -1800.0);
    assert!(num_reached(&harness) > num_far);
    press(&mut harness, "Undo");
    assert!((base(&harness) + 1800.0).abs() < 1e-9);
    press(&mut harness, "Undo");
    assert!(base(&harness).abs() < 1e-9);
    harness.get_by_label_contains("100 % of the path reached");

    // Where the arm reaches nothing, no collision is looked for.
    act_in(&mut harness, |paint: &mut PaintWorkspace, cx| {
        let mut setup = cx.session.program.clone();
        setup.base[0] = -8000.0;
        paint.state.apply(PaintAction::SetUp(setup), cx);
    });
    assert_eq!(num_reached(&harness), 0);
    harness.get_by_label("not checked");
}

#[test]
fn the_key_focus_walks_the_tabs_and_the_shown_one_is_remembered() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = || WindowOptions {
        settings: Some(folder.path().join("settings.toml")),
        ..plain_options()
    };
    let tab = |harness: &WindowHarness| harness.state().state().session.paint_tab;
    let mut harness = open_at(SMALL, options());
    let menu = "Part to paint: Fender, left";
    harness.get_by_role_and_label(Role::Button, menu).focus();
    harness.run_steps(2);
    let titles = ["Coat", "Regions", "Robot", "Film"];
    let walked = titles.map(|title| (Role::Tab, title));
    for (role, label) in walked.into_iter().chain([(Role::Button, "Coat: primer")]) {
        harness.key_press(Key::Tab);
        harness.run_steps(2);
        let node = harness.get_by_role_and_label(role, label);
        assert!(node.accesskit_node().is_focused(), "{label}");
    }
    // The key of a tool shows its tab; in another tab a drag turns the view.
    harness.key_press(Key::D);
    settle(&mut harness);
    assert_eq!(tab(&harness), PaintTab::Regions);
    harness.get_by_label_contains("Drag around what gets no paint");
    open_tab(&mut harness, "Film");
    assert_eq!(own(&harness).tool, PaintTool::Look);
    harness.get_by_label("Paintable surface");
    eframe::App::on_exit(harness.state_mut());
    drop(harness);
    let harness = open_with(SMALL, options());
    assert_eq!(tab(&harness), PaintTab::Film);
    harness.get_by_label("Paintable surface");
}

#[test]
fn a_menu_stays_below_its_button_and_closes_once_that_is_scrolled_away() {
    let mut harness = open();
    press(&mut harness, "Coat: primer");
    let button = |harness: &WindowHarness| harness.get_by_label("Coat: primer").rect();
    let entry = |harness: &WindowHarness| harness.get_by_label("Save as…").rect();
    let scroll = |harness: &mut WindowHarness, unit: egui::MouseWheelUnit, by: f32| {
        harness.event(egui::Event::MouseWheel {
            source: egui::MouseWheelSource::Wheel,
            unit,
            delta: Vec2::new(0.0, -by),
            phase: egui::TouchPhase::Move,
            modifiers: Modifiers::NONE,
        });
        let_pass(harness, 30);
    };
    harness.get_by_label("Coat: primer").hover();
    harness.run_steps(2);
    let (button_before, entry_before) = (button(&harness), entry(&harness));
    scroll(&mut harness, egui::MouseWheelUnit::Point, 10.0);
    let moved = button(&harness).top() - button_before.top();
    assert!(moved < -5.0, "{moved}");
    let followed = entry(&harness).top() - entry_before.top();
    assert!((followed - moved).abs() < 1.0, "{followed} {moved}");
    scroll(&mut harness, egui::MouseWheelUnit::Page, 1.0);
    assert!(harness.query_by_label("Save as…").is_none());
    press(&mut harness, "Coat: primer");
    entry(&harness);
}
