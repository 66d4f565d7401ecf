//! The Servo workspace, tested by its labels and controls. Needs no graphics adapter. The simulated robot moves in real time.

use std::{fs, sync::Arc, time::Duration};

use app::{
    Window, WindowOptions,
    workspaces::servo::{RunView, ServoAction, ServoPageState, ServoWorkspace},
};
use egui::{Key, Vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use geometry::oriented_box::OrientedBox;
use inspection::fixtures::shipped_library;
use nalgebra::Point3;
use records::history::{Filter, HistoryBuffer, ServoRecord, ServoSample};
use robot::calibration::CameraPlace;
use servo::{
    ServoParams, ServoState, Standing, Step, StopReason,
    simulated::{
        ArmDynamics, CellPart, CellSetup, Disturbance, HandEyeError, SimulatedCell,
        SimulatedTarget, StreamProtocol, run,
    },
};
use shell::{
    action::Action,
    cell::ServoSettings,
    session::{PaintTab, WorkspaceKind},
};
use simulate::PartKind;
use ui::{
    language::Language,
    viewport::{PointSet, Role},
};

use super::set_up::{
    SMALL, USUAL, WindowHarness, act, act_in, open_with, plain_options, press, settle, wait_for,
};
use geometry::{
    rigid::RigidTransform,
    units::{Metres, Radians},
};

fn own(window: &Window) -> &ServoPageState {
    let workspace = window.workspace::<ServoWorkspace>();
    &workspace.expect("the workspace").state
}

fn open_at(size: Vec2, options: WindowOptions) -> WindowHarness {
    let mut harness = open_with(size, options);
    press(&mut harness, "Servo");
    harness
}

/// Changes the settings as the controls do.
fn set_up(harness: &mut WindowHarness, change: impl FnOnce(&mut ServoSettings)) {
    let mut settings = harness.state().state().session.servo.clone();
    change(&mut settings);
    act_in(harness, |servo: &mut ServoWorkspace, cx| {
        servo.state.apply(ServoAction::SetUp(settings), cx);
    });
}

/// Presses a button without waiting for the result.
fn press_quickly(harness: &mut WindowHarness, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(3);
}

/// Starts the fender's run.
fn start(harness: &mut WindowHarness, in_steps: bool) {
    set_up(harness, |settings| {
        settings.part = Some("fender".into());
        settings.in_steps = in_steps;
    });
    press_quickly(harness, "Start");
    assert!(own(harness.state()).is_running());
}

fn runs(harness: &WindowHarness) -> Vec<ServoRecord> {
    let history: &HistoryBuffer = harness.state().history();
    let page = history.servo_runs(&Filter::default(), 0, 10);
    let rows = page.expect("read").rows.into_iter();
    let records = rows.map(|run| history.servo_run(run.number).expect("read"));
    records.collect()
}

#[test]
fn a_simulated_robot_is_servoed_and_its_run_is_a_row_of_the_history() {
    let mut harness = open_at(USUAL, plain_options());
    harness.get_by_label("No run yet");
    start(&mut harness, false);
    harness.get_by_label("Stop");
    wait_for(&mut harness, |window| !own(window).is_running());
    settle(&mut harness);
    harness.get_by_label("The target is reached");
    harness.get_by_label("Start");
    let [record] = &runs(&harness)[..] else {
        panic!("one run");
    };
    assert_eq!(record.run.stopped, None);
    assert_eq!(record.curve, own(harness.state()).curve());
    // Inspections are not counted with it.
    act(&mut harness, Action::GoTo(WorkspaceKind::History));
    harness.get_by_label("1 of 1 entry");
    press(&mut harness, "Servo runs");
    harness.get_by_label("1 of 1 run");
    harness.get_by_label("Run 1: Fender, left, The target is reached");
    harness.get_by_label("Shift left, mm");
    harness.get_by_label("Standard position");
    press(&mut harness, "Servo runs");
    harness.get_by_label("1 of 1 entry");
}

#[test]
fn the_space_bar_stops_the_robot_whatever_control_has_the_focus() {
    let mut harness = open_at(SMALL, plain_options());
    start(&mut harness, true);
    let is_waiting = |window: &Window| own(window).doing() == Some(ServoState::Waiting);
    wait_for(&mut harness, is_waiting);
    harness.run_steps(2);
    harness.get_by_label_contains("Waiting for Next");
    let left = |harness: &WindowHarness| {
        let curve = own(harness.state()).curve();
        curve.iter().rev().find_map(|sample| sample.error_m)
    };
    let before = left(&harness).expect("known");
    press_quickly(&mut harness, "Next");
    wait_for(&mut harness, |window| !is_waiting(window));
    wait_for(&mut harness, is_waiting);
    let after = left(&harness).expect("known");
    assert!(after < before - 0.01, "{before} {after}");
    harness.run_steps(2);
    let num_captures = harness.state().state().inspector.num_captures;
    harness.get_by_label("Next").focus();
    harness.run_steps(2);
    harness.key_press(Key::Space);
    harness.run_steps(2);
    assert!(own(harness.state()).is_stopping() || !own(harness.state()).is_running());
    wait_for(&mut harness, |window| !own(window).is_running());
    settle(&mut harness);
    harness.get_by_label("The robot was stopped on request");
    assert_eq!(harness.state().state().inspector.num_captures, num_captures);
    let [record] = &runs(&harness)[..] else {
        panic!("one run");
    };
    assert_eq!(record.run.stopped, Some(StopReason::ByPerson));
}

#[test]
fn escape_and_leaving_the_page_stop_the_robot() {
    let mut harness = open_at(USUAL, plain_options());
    start(&mut harness, true);
    let begins = |window: &Window| own(window).doing().is_some();
    wait_for(&mut harness, begins);
    harness.key_press(Key::Escape);
    wait_for(&mut harness, |window| !own(window).is_running());
    assert_eq!(runs(&harness).len(), 1);
    start(&mut harness, true);
    wait_for(&mut harness, |window| {
        own(window).is_running() && begins(window)
    });
    let context = harness.ctx.clone();
    let elsewhere = Action::GoTo(WorkspaceKind::History);
    harness.state_mut().act(elsewhere, &context);
    wait_for(&mut harness, |window| !own(window).is_running());
    settle(&mut harness);
    harness.get_by_label_contains("because you left the page Servo");
    let all = runs(&harness);
    assert_eq!(all.len(), 2);
    for record in &all {
        assert_eq!(record.run.stopped, Some(StopReason::ByPerson));
    }
}

#[test]
fn closing_the_window_stops_the_robot_and_its_run_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = WindowOptions {
        history: Some(folder.path().to_owned()),
        ..plain_options()
    };
    let mut harness = open_at(USUAL, options);
    start(&mut harness, true);
    wait_for(&mut harness, |window| own(window).doing().is_some());
    drop(harness);
    let history = records::fixtures::open_history(folder.path());
    let record = history.servo_run(1).expect("written");
    assert_eq!(record.run.stopped, Some(StopReason::ByPerson));
}

#[test]
fn what_is_missing_is_said_with_what_to_do() {
    let mut harness = open_at(USUAL, plain_options());
    press(&mut harness, "ABB");
    harness.get_by_label("The robot's address is missing or wrong");
    harness.get_by_label_contains("such as 192.168.1.10:6510");
    set_up(&mut harness, |settings| {
        settings.address = "127.0.0.1:0".into();
    });
    // The simulated cell is no camera.
    harness.get_by_label_contains("No camera is the source");
    assert!(harness.get_by_label("Start").accesskit_node().is_disabled());
    press(&mut harness, "Change them in Paint");
    let session = &harness.state().state().session;
    assert_eq!(session.workspace, WorkspaceKind::Paint);
    assert_eq!(session.paint_tab, PaintTab::Robot);
    // A library without a part.
    let empty = tempfile::tempdir().expect("a folder");
    let options = WindowOptions {
        library: Some(empty.path().to_owned()),
        ..WindowOptions::default()
    };
    let harness = open_at(USUAL, options);
    harness.get_by_label("No part is enrolled");
    harness.get_by_label_contains("Enrol a part in the Enrol workspace");
}

#[test]
fn the_settings_are_remembered_and_impossible_limits_are_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("settings.toml");
    let options = || WindowOptions {
        settings: Some(path.clone()),
        ..plain_options()
    };
    let mut harness = open_at(USUAL, options());
    set_up(&mut harness, |settings| {
        settings.robot = Some(StreamProtocol::Rtde);
        settings.address = "192.168.1.20".into();
        settings.speed = 120.0;
        settings.clearance = 80.0;
        settings.volume = Some(OrientedBox {
            centre_m: [1.0, 0.0, 1.5],
            size_m: [2.0, 3.0, 2.5],
            angles_rad: [0.0; 3],
        });
    });
    let expected = harness.state().state().session.servo.clone();
    drop(harness);
    let harness = open_with(USUAL, options());
    assert_eq!(harness.state().state().session.servo, expected);
    drop(harness);
    let text = fs::read_to_string(&path).expect("read");
    fs::write(&path, text.replace("speed = 120.0", "speed = nan")).expect("written");
    let harness = open_with(USUAL, options());
    let expected = ServoSettings {
        speed: ServoSettings::default().speed,
        ..expected
    };
    assert_eq!(harness.state().state().session.servo, expected);
}

#[test]
fn the_page_speaks_every_language() {
    let mut harness = open_at(SMALL, plain_options());
    for (language, start) in [
        (Language::German, "Start"),
        (Language::Spanish, "Iniciar"),
        (Language::Chinese, "开始"),
    ] {
        act(&mut harness, Action::Speak(language));
        harness.get_by_label(start);
    }
}

/// The fender's cell of a seed.
fn setup() -> CellSetup {
    CellSetup {
        part: CellPart::Simulated(PartKind::Fender),
        target: SimulatedTarget::Standard,
        noise: 1.0,
        start: (Metres(0.25), Radians::from_degrees(25.0)),
        hand_eye: HandEyeError {
            shift: Metres(0.02),
            turn: Radians(0.035),
        },
        frame_period: Duration::from_millis(100),
        delay: Duration::ZERO,
        dynamics: ArmDynamics::default(),
        disturbance: Disturbance::None,
        seed: 1,
    }
}

/// Shows a whole run, without waiting for it.
pub(super) fn show_run(harness: &mut WindowHarness) {
    let library = shipped_library();
    let cell = SimulatedCell::arrange(setup(), &library).expect("a start");
    let result = run(&cell, &ServoParams::default()).expect("sound");
    let Step::Done(arrival) = &result.end else {
        panic!("{:?}", result.end);
    };
    let mut references = library.references.iter();
    let reference = references.find(|one| one.name == "fender");
    let points = reference.expect("enrolled").cloud.points.iter();
    let points: Vec<[f32; 3]> = points.map(|p| [p.x, p.y, p.z]).collect();
    let every = (0.1 / result.period) as usize;
    let looks = || result.samples.iter().step_by(every);
    let curve: Vec<ServoSample> = looks()
        .map(|sample| ServoSample {
            at_s: sample.at.as_secs_f64(),
            error_m: Some(sample.error.shift.0),
            error_rad: Some(sample.error.rotation.0),
            state: ServoState::Moving,
            held: None,
        })
        .collect();
    let CameraPlace::OnFlange {
        flange_from_camera, ..
    } = cell.task.camera
    else {
        panic!("the arm carries the camera");
    };
    let trail = looks().map(|sample| {
        let camera = sample.robot_from_flange * flange_from_camera;
        camera.translation.vector.cast::<f32>().into()
    });
    let goal = arrival.robot_from_flange;
    let here = result.samples[result.samples.len() / 12].robot_from_flange;
    let seen = RigidTransform::identity();
    let mut record = records::fixtures::servo_record(1, "fender", None);
    record.run.title = "Fender, left".into();
    let view = RunView {
        title: "Fender, left".into(),
        task: Some(Arc::new(cell.task.clone())),
        nozzle: Some(Point3::new(0.0, 0.0, 0.2)),
        points: Some(PointSet::new(points, Role::Part)),
        trail: trail.collect(),
        standing: Some(Standing {
            robot_from_flange: here,
            robot_from_goal: Some(goal),
            part_in_place: Some(cell.task.robot_from_part(&goal, &seen)),
            state: ServoState::Checking,
        }),
        num_looks: curve.len(),
        num_accepted: curve.len(),
        delay: Some(Duration::from_millis(80)),
        curve,
        record: Some(record),
        ..RunView::default()
    };
    set_up(harness, |settings| settings.part = Some("fender".into()));
    act_in(harness, |servo: &mut ServoWorkspace, _| {
        servo.state.shown = Some(Box::new(view));
    });
    harness.run_steps(4);
}
