//! The robot's cell in the window: its calibration, and the spray path of a part.

use std::{fmt::Write as _, fs, path::Path, sync::Arc};

use app::{
    WindowOptions,
    workspaces::{
        enrol::{EnrolAction, EnrolFile, EnrolWorkspace},
        inspect::{InspectFile, ViewPart},
        paint::{PaintAction, PaintWorkspace},
    },
};
use egui::{Key, Role};
use egui_kittest::kittest::Queryable as _;
use geometry::rigid::{RigidTransform, from_euler_zyx};
use inspection::library::{LibraryFolder, PartName, PathPoint, SprayPath};
use nalgebra::{Point3, Vector3};
use robot::{
    Convention,
    calibration::{CameraPlace, CellCalibration, Origin},
};
use shell::{
    action::Action,
    cell::{ProgramSetup, RobotAction, RobotPage},
    session::{RememberedCell, ThemeChoice, WorkspaceKind},
    state::State,
};

use inspection::fixtures::copy_library;

use super::set_up::{
    USUAL, WindowHarness, act, act_in, choose_in_inspect, inspect_of, open, open_with,
    plain_options, press, settle,
};

fn state(harness: &WindowHarness) -> &State {
    harness.state().state()
}

fn own(folder: &Path) -> WindowOptions {
    WindowOptions {
        cell: Some(folder.join("cell.toml")),
        settings: Some(folder.join("settings.toml")),
        ..plain_options()
    }
}

/// Opens the dialog and types into a field of it.
fn type_into(harness: &mut WindowHarness, label: &str, text: &str) {
    let field = |harness: &WindowHarness| {
        let role = if label.contains("where") {
            Role::MultilineTextInput
        } else {
            Role::TextInput
        };
        let node = harness.get_by_role_and_label(role, label);
        node.focus();
    };
    field(harness);
    harness.run_steps(2);
    harness.event(egui::Event::Text(text.into()));
    harness.run_steps(3);
}

/// Pose of a camera that hangs above the cell and looks down at the part.
pub(crate) fn robot_from_camera() -> RigidTransform {
    from_euler_zyx([-2.2, 0.1, -1.6, 1.5, -0.2, 2.0])
}

/// A table of pairs with the camera in the cell; `turns` are the rotations of the target in front of the camera.
pub(crate) fn pairs(turns: &[[f64; 3]]) -> String {
    let flange_from_target = from_euler_zyx([0.3, 0.2, -0.5, 0.02, -0.03, 0.1]);
    let mut text = String::from("# robot: kuka\n# camera: rotation-vector\n");
    for (i, [rx, ry, rz]) in turns.iter().enumerate() {
        let aside = 0.06 * (i as f64 - 2.0);
        let seen = from_euler_zyx([*rx, *ry, *rz, aside, -aside / 2.0, 1.2 + aside / 3.0]);
        let arm = robot_from_camera() * seen * flange_from_target.inverse();
        let mut numbers = Convention::Kuka.write(&arm).numbers();
        // Rounded as a controller shows them, like the errors of a camera of some tenths of a millimetre.
        for number in &mut numbers {
            *number = (*number * 10.0).round() / 10.0;
        }
        numbers.extend(Convention::RotationVector.write(&seen).numbers());
        let numbers: Vec<String> = numbers.iter().map(ToString::to_string).collect();
        writeln!(text, "p{}, {}", i + 1, numbers.join(", ")).expect("memory");
    }
    text
}

pub(crate) const TURNS: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [0.4, 0.1, 0.2],
    [-0.3, 0.3, -0.4],
    [0.1, -0.4, 0.6],
    [-0.2, -0.3, -0.7],
    [0.3, 0.4, 0.9],
    [0.5, -0.1, -0.2],
    [-0.4, -0.2, 0.3],
];

#[test]
fn numbers_typed_by_hand_are_used_remembered_and_forgotten() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, own(folder.path()));
    assert!(state(&harness).session.robot.is_none());
    harness.key_press(Key::B);
    settle(&mut harness);
    harness.get_by_label_contains("The cell is not calibrated");
    press(&mut harness, "By hand");
    let label = "robot_from_camera: where the camera's frame stands";
    type_into(&mut harness, label, "kuka 1200 -400 1900 86 -5");
    harness.get_by_label_contains("has 6 numbers");
    type_into(&mut harness, label, " 120");
    type_into(&mut harness, "Name of the cell", "Cell 2");
    press(&mut harness, "Use it");
    let frame = state(&harness).session.robot.clone().expect("a frame");
    let name = frame.name.to_string();
    assert!(name.starts_with("Cell 2 ("), "{name}");
    assert!(
        (frame.robot_from_camera.translation.vector - Vector3::new(1.2, -0.4, 1.9)).norm() < 1e-9
    );
    harness.get_by_label("entered by hand");
    press(&mut harness, "Close");
    assert!(harness.state().robot().dialog().is_none());
    // The card now shows the pose in the robot's frame.
    harness.get_by_label_contains("base frame, by Cell 2 (");
    assert!(inspect_of(&harness).parts.contains(&ViewPart::RobotBase));

    drop(harness);
    let mut harness = open_with(USUAL, own(folder.path()));
    assert_eq!(state(&harness).session.robot.as_deref(), Some(&*frame));
    press(&mut harness, "Robot…");
    press(&mut harness, "Forget");
    assert!(state(&harness).session.robot.is_none());
    assert_eq!(state(&harness).session.cell, RememberedCell::Forgotten);
    assert!(folder.path().join("cell.toml").exists());
}

#[test]
fn pairs_are_calculated_shown_corrected_and_used() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("pairs.csv");
    // The fourth pair is off by 60 mm.
    let sound = pairs(&TURNS);
    let text = sound.lines().map(|line| match line.strip_prefix("p4, ") {
        Some(rest) => {
            let (x, rest) = rest.split_once(',').expect("numbers");
            let x: f64 = x.parse().expect("a number");
            format!("p4, {},{rest}\n", x + 60.0)
        }
        None => format!("{line}\n"),
    });
    fs::write(&file, text.collect::<String>()).expect("written");
    let mut harness = open_with(USUAL, own(folder.path()));
    act(&mut harness, Action::Robot(RobotAction::Pairs(file)));
    harness.get_by_label_contains("p4 (line 6) is suspect");
    press(&mut harness, "p4 (line 6)");
    assert!(harness.query_by_label_contains("is suspect").is_none());
    harness.get_by_label("left out");
    press(&mut harness, "Use it");
    let found = &state(&harness)
        .session
        .robot
        .as_ref()
        .expect("a frame")
        .robot_from_camera;
    let off = (found.translation.vector - robot_from_camera().translation.vector).norm();
    assert!(off < 0.002, "{off}");
    harness.get_by_label("7 pairs of pairs.csv");
}

#[test]
fn pairs_that_do_not_span_are_used_only_by_insisting() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("pairs.csv");
    let turns: Vec<[f64; 3]> = (0..6).map(|i| [0.0, 0.0, 0.3 * f64::from(i)]).collect();
    fs::write(&file, pairs(&turns)).expect("written");
    let mut harness = open_with(USUAL, own(folder.path()));
    act(
        &mut harness,
        Action::Robot(RobotAction::Pairs(file.clone())),
    );
    harness.get_by_label_contains("Nearly all turns are about one axis");
    harness.get_by_label_contains("another axis by at least 30°");
    act(&mut harness, Action::Robot(RobotAction::UseSolved));
    assert!(state(&harness).session.robot.is_none());
    press(&mut harness, "Use it anyway");
    press(&mut harness, "Use it");
    assert!(state(&harness).session.robot.is_some());
    // The error of a bad file is shown where it was chosen.
    fs::write(&file, "# robot: kuka\n1 2 3\n").expect("written");
    act(&mut harness, Action::Robot(RobotAction::Pairs(file)));
    harness.get_by_label_contains("line 2: 3 numbers, expected 22");
}

#[test]
fn without_a_folder_of_its_own_a_window_says_so() {
    let mut harness = open();
    press(&mut harness, "Robot…");
    press(&mut harness, "By hand");
    let label = "robot_from_camera: where the camera's frame stands";
    type_into(&mut harness, label, "kuka 1 2 3 4 5 6");
    press(&mut harness, "Use it");
    assert!(state(&harness).session.robot.is_none());
    assert_eq!(state(&harness).notices.len(), 1);
    harness.key_press(Key::Escape);
    settle(&mut harness);
    assert!(harness.state().robot().dialog().is_none());
}

#[test]
fn behind_a_dialog_no_key_is_a_shortcut_and_escape_closes_its_list_first() {
    let typed = |harness: &mut WindowHarness| {
        let keys = [
            Key::Num2,
            Key::Space,
            Key::Num5,
            Key::T,
            Key::U,
            Key::L,
            Key::F1,
            Key::C,
            Key::B,
        ];
        for key in keys {
            harness.key_press(key);
            harness.run_steps(2);
        }
        let state = state(harness);
        assert_eq!(state.inspector.num_captures, 1);
        assert_eq!(state.session.theme, ThemeChoice::Dark);
        assert!(!state.session.is_live());
        assert!(harness.query_by_label("Shortcuts").is_none());
        state.session.workspace
    };
    let mut harness = open();
    let parts = inspect_of(&harness).parts.clone();
    press(&mut harness, "Robot…");
    press(&mut harness, "By hand");
    assert_eq!(typed(&mut harness), WorkspaceKind::Inspect);
    assert_eq!(inspect_of(&harness).parts, parts);
    assert!(harness.state().robot().dialog().is_some());
    harness.get_by_label_contains("Numbers of: ").click();
    harness.run_steps(4);
    harness.get_by_label("FANUC W P R");
    harness.key_press(Key::Escape);
    harness.run_steps(4);
    assert!(harness.query_by_label("FANUC W P R").is_none());
    assert!(harness.state().robot().dialog().is_some());
    harness.key_press(Key::Escape);
    harness.run_steps(4);
    assert!(harness.state().robot().dialog().is_none());

    harness.get_by_label_contains("Source").click();
    harness.run_steps(4);
    press(&mut harness, "Set up the cell…");
    assert_eq!(typed(&mut harness), WorkspaceKind::Inspect);
    harness.get_by_label_contains("Hangs there: ").click();
    harness.run_steps(4);
    harness.get_by_label("Nothing");
    harness.key_press(Key::Escape);
    harness.run_steps(4);
    assert!(harness.query_by_label("Nothing").is_none());
    assert!(state(&harness).session.live.setup.is_some());
    harness.key_press(Key::Escape);
    harness.run_steps(4);
    assert!(state(&harness).session.live.setup.is_none());

    act(&mut harness, Action::GoTo(WorkspaceKind::History));
    press(&mut harness, "Frames…");
    harness.get_by_label("Frames to keep");
    assert_eq!(typed(&mut harness), WorkspaceKind::History);
    harness.key_press(Key::Escape);
    harness.run_steps(4);
    assert!(harness.query_by_label("Frames to keep").is_none());
    // With no dialog open, keys are shortcuts again.
    harness.key_press(Key::Num1);
    harness.run_steps(4);
    assert_eq!(state(&harness).session.workspace, WorkspaceKind::Inspect);
}

#[test]
fn a_dialog_that_grows_or_shrinks_is_in_its_place_at_once() {
    let mut harness = open();
    press(&mut harness, "Robot…");
    let mut height = 0.0;
    for page in [RobotPage::ByHand, RobotPage::InUse] {
        let mut dialog = harness.state().robot().dialog().expect("open").clone();
        dialog.page = page;
        let context = harness.ctx.clone();
        let edit = Action::Robot(RobotAction::Edit(Box::new(dialog)));
        harness.state_mut().act(edit, &context);
        harness.step();
        let ends = |harness: &WindowHarness| {
            let top = harness.get_by_label("By hand").rect().min;
            (top, harness.get_by_label("Close").rect().max)
        };
        let at_once = ends(&harness);
        harness.run_steps(8);
        assert_eq!(at_once, ends(&harness), "{page:?}");
        let (before, now) = (height, at_once.1.y - at_once.0.y);
        assert!(f32::abs(now - before) > 20.0, "{before} {now}");
        height = now;
    }
}

/// Writes a calibration that was entered by hand.
pub(crate) fn save_calibration(path: &Path) {
    save_calibration_of(path, robot_from_camera());
}

/// As [`save_calibration`], of a camera with this pose.
pub(crate) fn save_calibration_of(path: &Path, robot_from_camera: RigidTransform) {
    let calibration = CellCalibration {
        name: "Cell 2".into(),
        notes: String::new(),
        camera: CameraPlace::Fixed { robot_from_camera },
        origin: Origin::ByHand,
        made_at: jiff::Timestamp::UNIX_EPOCH,
    };
    calibration.save(path).expect("written");
}

/// A path over the shipped front door, which hung square to the camera, 1.3 m away; its fifth point is too near, its
/// sixth beside the door.
pub(crate) fn door_path() -> SprayPath {
    let at = [
        [-0.3, -0.05, 1.05],
        [-0.15, 0.0, 1.05],
        [0.0, 0.1, 1.05],
        [0.15, 0.1, 1.05],
        [0.3, 0.1, 1.14],
        [0.75, 0.1, 1.05],
    ];
    let points = at.map(|[x, y, z]| PathPoint {
        nozzle: Point3::new(x, y, z),
        direction: Vector3::z_axis(),
        stand_off: None,
        is_gun_on: true,
        speed: None,
        fan: None,
    });
    SprayPath::new(points.into()).expect("points")
}

/// Applies an action in the Enrol workspace.
fn in_enrol(harness: &mut WindowHarness, action: EnrolAction) {
    act_in(harness, |enrol: &mut EnrolWorkspace, cx| {
        enrol.state.apply(action, cx);
    });
}

/// Whatever the arm; leaves the stored path as it was.
fn nothing_is_written_of_a_path_off_the_part(
    harness: &mut WindowHarness,
    folder: &Path,
    program: &Path,
) {
    act_in(harness, |paint: &mut PaintWorkspace, cx| {
        let setup = PaintAction::SetUp(ProgramSetup::default());
        paint.state.apply(setup, cx);
    });
    let far = folder.join("far.csv");
    let text = "x_mm,y_mm,z_mm,normal_x,normal_y,normal_z\n5000,5000,9000,0,0,-1\n";
    fs::write(&far, text).expect("written");
    act(harness, Action::GoTo(WorkspaceKind::Enrol));
    in_enrol(harness, EnrolAction::Chosen(EnrolFile::SprayPath, far));
    act(harness, Action::GoTo(WorkspaceKind::Inspect));
    choose_in_inspect(harness, InspectFile::SprayPath, program.to_owned());
    assert!(!program.exists());
    harness.get_by_label_contains("No program was written: the spray path does not aim");
    let export = folder.join("out.csv");
    assert!(export.exists(), "that of the path before");
    choose_in_inspect(harness, InspectFile::SprayPath, export.clone());
    assert!(!export.exists());
    harness.get_by_label_contains("No spray path was written: the spray path does not aim");
    in_enrol(harness, EnrolAction::Undo);
}

#[test]
fn a_spray_path_is_stored_carried_shown_and_exported() {
    let folder = tempfile::tempdir().expect("a folder");
    let parts = folder.path().join("parts");
    copy_library(&parts);
    let library = LibraryFolder::open(&parts).expect("a library");
    let door = PartName::new("front_door").expect("a name");
    let options = WindowOptions {
        library: Some(parts.clone()),
        ..own(folder.path())
    };
    let mut harness = open_with(USUAL, options);
    let shown = |harness: &WindowHarness| {
        let shown = state(harness).session.shown.as_ref().expect("a result");
        Arc::clone(&shown.inspected)
    };
    assert!(shown(&harness).spray.is_none());

    // Store it in the library as a file from elsewhere.
    let file = folder.path().join("path.csv");
    let mut text =
        String::from("nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z\n");
    for point in door_path().points() {
        let mm = point.nozzle.coords * 1000.0;
        writeln!(text, "{},{},{},0,0,1", mm.x, mm.y, mm.z).expect("memory");
    }
    fs::write(&file, text).expect("written");
    act(&mut harness, Action::GoTo(WorkspaceKind::Enrol));
    in_enrol(&mut harness, EnrolAction::Open(door));
    in_enrol(
        &mut harness,
        EnrolAction::Chosen(EnrolFile::SprayPath, file),
    );
    harness.get_by_label_contains("· spray path of 6 points");
    assert_eq!(
        library
            .spray_path("front_door")
            .expect("read")
            .map(|p| p.points().len()),
        Some(6)
    );

    act(&mut harness, Action::GoTo(WorkspaceKind::Inspect));
    let inspected = shown(&harness);
    let carried = inspected.spray.as_ref().expect("carried");
    assert_eq!(carried.points.len(), 6);
    assert!(carried.points[5].meets.is_none());
    let figure = inspected.view.spray.as_ref().expect("drawn");
    assert_eq!(
        (figure.num_seen, figure.num_inside),
        (5, carried.num_inside())
    );
    // The fifth point is too near, and the sixth is beside the door.
    assert_eq!(carried.num_inside(), 4, "{carried:?}");

    // The angle counts as well as the distance.
    harness.get_by_label_contains("Inside the band also means an angle of at most 30.00°");

    // Without a calibrated cell there is nothing to export.
    let out = folder.path().join("out.csv");
    choose_in_inspect(&mut harness, InspectFile::SprayPath, out.clone());
    assert!(!out.exists());
    let cell = folder.path().join("cell.toml");
    save_calibration(&cell);
    act(&mut harness, Action::Robot(RobotAction::Load(cell)));
    act(&mut harness, Action::UseConvention(Convention::Fanuc));
    choose_in_inspect(&mut harness, InspectFile::SprayPath, out.clone());
    let text = fs::read_to_string(&out).expect("written");
    assert!(text.contains("FANUC") || text.contains("fanuc"), "{text}");
    assert!(
        text.contains("SIMULATED") && text.contains("Cell 2 ("),
        "{text}"
    );
    assert_eq!(
        text.lines()
            .filter(|line| line.starts_with(char::is_numeric))
            .count(),
        6
    );
    // Beside the result, and in the file.
    harness.get_by_label_contains("Not checked at 1 of 6 points");
    harness.get_by_label_contains("Not checked: reach and collisions; the stand-off at 1 of 6");
    assert!(
        text.contains("# NOT CHECKED: reach and collisions"),
        "{text}"
    );
    // The ending of the file's name selects a program.
    let program = folder.path().join("paint.ls");
    choose_in_inspect(&mut harness, InspectFile::SprayPath, program.clone());
    let text = fs::read_to_string(&program).expect("written");
    assert!(
        text.starts_with("/PROG") && text.contains("SIMULATED"),
        "{text}"
    );
    // With an arm that does not reach all points no program is written, and the earlier one is removed.
    act_in(&mut harness, |paint: &mut PaintWorkspace, cx| {
        let setup = ProgramSetup {
            arm: Some("kr6-r900".into()),
            nozzle: "kuka 0 0 250 0 45 0".into(),
            ..ProgramSetup::default()
        };
        paint.state.apply(PaintAction::SetUp(setup), cx);
    });
    choose_in_inspect(&mut harness, InspectFile::SprayPath, program.clone());
    assert!(!program.exists());
    harness.get_by_label_contains("No program was written: KUKA KR 6 R900-2 misses");

    nothing_is_written_of_a_path_off_the_part(&mut harness, folder.path(), &program);

    // Undo works as for any change of the library.
    in_enrol(&mut harness, EnrolAction::Undo);
    assert_eq!(library.spray_path("front_door").expect("read"), None);
}

#[test]
fn the_list_of_conventions_opens_again_however_it_was_closed() {
    let mut harness = open();
    harness.key_press(Key::B);
    harness.run_steps(4);
    press(&mut harness, "By hand");
    let entry = "KUKA A B C";
    let is_open = |harness: &WindowHarness| harness.query_by_label(entry).is_some();
    // Pressed and released within one frame, as a slow computer sees it.
    let toggle = |harness: &mut WindowHarness| {
        let pos = harness.get_by_label_contains("Numbers of:").rect().center();
        let events = &mut harness.input_mut().events;
        events.push(egui::Event::PointerMoved(pos));
        events.extend([true, false].map(|pressed| egui::Event::PointerButton {
            pos,
            button: egui::PointerButton::Primary,
            pressed,
            modifiers: egui::Modifiers::NONE,
        }));
        harness.run_steps(6);
    };
    for close in ["Esc", "outside", "list"] {
        toggle(&mut harness);
        assert!(is_open(&harness), "before {close}");
        match close {
            "Esc" => harness.key_press(Key::Escape),
            "outside" => harness.get_by_label("Robot").click(),
            _ => toggle(&mut harness),
        }
        harness.run_steps(6);
        assert!(!is_open(&harness), "after {close}");
        harness.get_by_label("By hand");
    }
    toggle(&mut harness);
    press(&mut harness, entry);
    harness.get_by_label("Numbers of: KUKA A B C");
}
