//! Answering robots from the window: requests come over TCP, and the camera repeats one frame.

use std::{
    fs,
    io::{BufRead as _, BufReader, Write as _},
    net::{SocketAddr, TcpListener, TcpStream},
    path::Path,
    sync::mpsc::Sender,
    thread,
    time::{Duration, Instant},
};

use app::{
    Window, WindowOptions,
    workspaces::{
        history::{HistoryAction, HistoryWorkspace},
        servo::{ServoAction, ServoWorkspace},
    },
};
use capture::{CaptureError, Captured, DepthSource, Image, NextCapture};
use egui::{Key, Role};
use egui_kittest::{Harness, kittest::Queryable as _};
use geometry::{depth_frame::DepthFrame, oriented_box::OrientedBox, rigid::RigidTransform};
use inspection::library::{LibraryFolder, PartName, Truth};
use jiff::{SignedDuration, Timestamp};
use records::history::{Filter, HistoryBuffer, StoredVerdict};
use robot::Convention;
use serve::{PoseKind, VerdictCode};
use shell::{
    action::{Action, DialogRequest},
    cell::{AnswerSetup, RobotAction, RobotDialog, RobotPage},
    inspection::camera::Camera,
    roles::RoleAction,
    state::Closing,
};
use simulate::{PartKind, SensorNoise};

use inspection::fixtures::copy_library;
use simulate::fixtures::HangingPart;

use super::{
    live::{Step, sees, toggle, wired_options},
    robot::save_calibration,
    set_up::{
        SMALL, USUAL, WindowHarness, act, history_of, open, open_with, plain_options, press,
        wait_for, wait_until,
    },
};

/// Timeout with room for a busy machine; what is awaited normally comes at once.
const PATIENCE: Duration = Duration::from_mins(3);
/// Time between two frames by the camera's clock, milliseconds.
const APART: i64 = 150;

/// A camera in front of which nothing changes.
struct Steady {
    frame: DepthFrame,
    number: u64,
}

impl DepthSource for Steady {
    fn title(&self) -> String {
        "steady camera".into()
    }

    fn is_simulated(&self) -> bool {
        true
    }

    fn next(&mut self, _: Duration) -> Result<NextCapture, CaptureError> {
        // Leave processor time to other threads, and let few frames be dropped: they are far apart by the camera's clock.
        thread::sleep(Duration::from_millis(20));
        self.number += 1;
        let at = SignedDuration::from_millis(APART * self.number as i64);
        Ok(NextCapture::Captured(Captured {
            number: self.number,
            name: format!("steady frame {}", self.number),
            taken_at: Timestamp::UNIX_EPOCH + at,
            arrived: Instant::now(),
            image: Image::Depth(self.frame.clone()),
            is_simulated: true,
            truth: None,
            robot_from_flange: None,
            warnings: Vec::new(),
        }))
    }
}

/// Options of a calibrated window that stores its data in this folder; a fender hangs in front of its camera.
fn options(folder: &Path) -> WindowOptions {
    let cell = folder.join("cell.toml");
    save_calibration(&cell);
    let fender = HangingPart::new(PartKind::Fender, 3);
    let frame = fender.frame(SensorNoise::kinect(1), &RigidTransform::identity());
    let camera = Camera::opened_by(move |_| {
        Ok(Box::new(Steady {
            frame: frame.clone(),
            number: 0,
        }))
    });
    WindowOptions {
        camera,
        cell: Some(cell),
        settings: Some(folder.join("settings.toml")),
        ..plain_options()
    }
}

/// Performs an action of the user without waiting for the window to become idle, which it never is while it follows
/// its source.
fn cause(harness: &mut WindowHarness, action: Action) {
    let context = harness.ctx.clone();
    harness.state_mut().act(action, &context);
    harness.run_steps(4);
}

fn answer(harness: &mut WindowHarness, setup: AnswerSetup) {
    cause(harness, Action::Robot(RobotAction::Answer(setup)));
}

fn on_at(at: &str) -> AnswerSetup {
    AnswerSetup {
        is_on: true,
        at: at.parse().expect("an address"),
        convention: Convention::Kuka,
        ..AnswerSetup::default()
    }
}

/// Waits until the window listens, and returns the address.
fn listening(harness: &mut WindowHarness) -> SocketAddr {
    wait_for(harness, |window| {
        window.robot().answering().status().is_some()
    });
    let status = harness.state().robot().answering().status();
    status.expect("it listens").at.address
}

/// Waits until the server listens at another address than this one, and returns it.
fn listening_elsewhere(harness: &mut WindowHarness, before: SocketAddr) -> SocketAddr {
    wait_for(harness, |window| {
        let status = window.robot().answering().status();
        status.is_some_and(|status| status.at.address != before)
    });
    listening(harness)
}

/// Turns on answering at any free port.
fn turn_on(harness: &mut WindowHarness) -> SocketAddr {
    answer(harness, on_at("ascii=0"));
    listening(harness)
}

fn turn_off(harness: &mut WindowHarness) {
    let setup = harness.state().state().session.answering;
    answer(
        harness,
        AnswerSetup {
            is_on: false,
            ..setup
        },
    );
    wait_for(harness, |window| {
        window.robot().answering().status().is_none()
    });
}

fn says(harness: &WindowHarness, text: &str) -> bool {
    harness.query_all_by_label_contains(text).next().is_some()
}

/// The pose that the window shows, in the camera frame, if it counts.
fn shown_pose(window: &Window) -> Option<RigidTransform> {
    let shown = window.state().session.shown.as_ref()?;
    let inspection = &shown.inspected.inspection;
    let pose = inspection.pose.as_ref()?.as_ref().ok()?;
    let is_followed = shown.session.is_some();
    let counts = is_followed && inspection.verdict.is_accepted();
    counts.then(|| pose.camera_from_part())
}

/// A robot that uses the protocol `ascii`.
struct Robot(BufReader<TcpStream>);

impl Robot {
    fn connect(at: SocketAddr) -> Self {
        let stream = TcpStream::connect(at).expect("connected");
        stream.set_read_timeout(Some(PATIENCE)).expect("set");
        Self(BufReader::new(stream))
    }

    /// Sends a request and returns the fields of the answer; in KUKA's convention the numbers are 12 to 17, the
    /// reason 18 and the message 19.
    fn ask(&mut self, request: &str) -> Vec<String> {
        let line = format!("{request}\n");
        self.0.get_mut().write_all(line.as_bytes()).expect("sent");
        let mut reply = String::new();
        self.0.read_line(&mut reply).expect("a line");
        reply.trim_end().split(';').map(str::to_owned).collect()
    }
}

#[test]
fn a_robot_is_told_the_pose_that_the_window_shows_and_the_history_keeps_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, options(folder.path()));
    let at = turn_on(&mut harness);
    assert!(at.ip().is_loopback(), "{at}");
    assert!(harness.state().state().session.is_live());
    wait_for(&mut harness, |window| shown_pose(window).is_some());
    let is_settled = |window: &Window| {
        let history = window.workspace::<HistoryWorkspace>();
        history.is_some_and(|history| history.state.is_settled())
    };
    wait_for(&mut harness, is_settled);
    let num_rows = history_of(&harness).num_rows();

    // The window draws no frame meanwhile: a robot does not wait for it.
    let mut robot = Robot::connect(at);
    let reply = robot.ask("TRIGGER");
    assert_eq!(reply[1], "accepted", "{reply:?}");
    let [sequence, camera, part, flags] = [2, 5, 6, 8].map(|field| reply[field].as_str());
    // The flags mean "with a pose" and "simulated".
    assert_eq!(
        [sequence, camera, part, flags],
        ["1", "running", "fender", "5"]
    );
    let session = &harness.state().state().session;
    let library = session.library.as_ref().expect("loaded");
    let index = library.index_of("fender").expect("enrolled");
    assert_eq!(reply[7], (index + 1).to_string());
    let pose = shown_pose(harness.state()).expect("shown");
    let frame = session.robot.as_ref().expect("calibrated");
    let expected = Convention::Kuka.write(&frame.robot_from_part(&pose));
    let numbers = reply[12..18].iter().map(|number| number.parse::<f64>());
    for (reply, expected) in numbers.zip(expected.numbers()) {
        let reply = reply.expect("a number");
        assert!((reply - expected).abs() < 0.01, "{reply} for {expected}");
    }
    assert_eq!(robot.ask("LAST")[2], "1");

    wait_for(&mut harness, |window| {
        let status = window.robot().answering().status();
        status.is_some_and(|status| status.last.is_some() && status.num_clients == 1)
    });
    let status = harness.state().robot().answering().status();
    let last = status.and_then(|status| status.last.clone());
    let answer = last.expect("an answer").answer;
    assert_eq!(
        (answer.verdict, answer.sequence),
        (VerdictCode::Accepted, 1)
    );
    // Below the row that Live has written of the part.
    wait_for_rows(&mut harness, num_rows, 1);
    let newest = history_of(&harness).row(0).expect("kept");
    assert_eq!(newest.part.as_deref(), Some("fender"));
    assert!(newest.is_simulated && newest.scene.to_string().contains("teady frame"));
    assert!(says(&harness, "Answers robots · 127.0.0.1:"));
}

#[test]
fn a_trigger_may_name_an_order_of_the_table_in_use() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, options(folder.path()));
    let at = turn_on(&mut harness);
    wait_for(&mut harness, |window| shown_pose(window).is_some());
    let mut robot = Robot::connect(at);
    let without = robot.ask("TRIGGER ORDER=4711");
    assert_eq!([&without[1], &without[18]], ["error", "not_known"]);
    let path = folder.path().join("orders.csv");
    fs::write(&path, "order;parts\n4711;fender\n4712;grille\n").expect("written");
    cause(&mut harness, Action::Chosen(DialogRequest::Orders, path));
    wait_for(&mut harness, |window| {
        let mut notices = window.state().notices.iter();
        notices.any(|notice| notice.what.contains("orders.csv"))
    });
    harness.run_steps(4);
    for (request, verdict, reason) in [
        ("TRIGGER ORDER=4711 SERIAL=TL-1", "accepted", ""),
        ("TRIGGER ORDER=4712", "refused", "wrong_part"),
        ("TRIGGER ORDER=4713", "error", "not_known"),
        ("TRIGGER", "error", "not_known"),
    ] {
        let reply = robot.ask(request);
        assert_eq!([&reply[1], &reply[18]], [verdict, reason], "{reply:?}");
    }
}

#[test]
fn without_live_a_trigger_is_answered_with_what_to_do_and_with_it_again_with_a_pose() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, options(folder.path()));
    let at = turn_on(&mut harness);
    let mut robot = Robot::connect(at);
    toggle(&mut harness);
    assert!(!harness.state().state().session.is_live());
    harness.run_steps(4);
    let reply = robot.ask("TRIGGER");
    let [verdict, number, reason] = [1, 12, 18].map(|field| reply[field].as_str());
    assert_eq!([verdict, number, reason], ["error", "", "camera_failed"]);
    assert!(reply[19].contains("Press Live"), "{reply:?}");
    assert_eq!(robot.ask("STATUS")[5], "over");
    assert!(says(&harness, "Answers robots, without frames"));

    toggle(&mut harness);
    wait_until(&mut harness, |state| state.session.live.status.is_some());
    let reply = robot.ask("TRIGGER");
    assert_eq!([&*reply[1], &*reply[2]], ["accepted", "2"], "{reply:?}");
    assert!(!says(&harness, "without frames"));
}

#[test]
fn a_robot_that_servoes_is_moved_within_the_limits_of_the_page_servo() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, options(folder.path()));
    let at = turn_on(&mut harness);
    wait_for(&mut harness, |window| shown_pose(window).is_some());
    let library = harness.state().state().session.library.as_ref();
    let index = library.and_then(|library| library.index_of("fender"));
    let number = index.expect("enrolled") + 1;
    let mut robot = Robot::connect(at);
    let mut servo = |start: &str, pose: &str| robot.ask(&format!("SERVO {start}{number} {pose}"));
    let here = "900 0 1100 10 20 30";
    let reply = servo("START ", here);
    let [verdict, part, flags] = [1, 6, 8].map(|field| reply[field].as_str());
    assert_eq!([verdict, part, flags], ["move", "fender", "5"], "{reply:?}");
    let sent = [12, 13, 14].map(|field| reply[field].parse::<f64>().expect("a number"));
    let [x, y, z] = [sent[0] - 900.0, sent[1], sent[2] - 1100.0];
    let way = x.hypot(y).hypot(z);
    assert!(way > 1.0 && way < 100.01, "{reply:?}");

    wait_for(&mut harness, |window| {
        let history = window.workspace::<HistoryWorkspace>();
        history.is_some_and(|history| history.state.is_settled())
    });
    report(&mut harness, &Truth::Part("grille".into()));
    let reply = servo("", &reply[12..18].join(" "));
    let [answer, reason] = [&*reply[1], &*reply[18]];
    assert_eq!([answer, reason], ["stay", "reported_wrong"], "{reply:?}");
    assert_eq!(reply[12], "", "{reply:?}");
    report(&mut harness, &Truth::Part("fender".into()));

    // Another work volume counts at once, and ends the run.
    let mut settings = harness.state().state().session.servo.clone();
    settings.volume = Some(OrientedBox {
        centre_m: [9.0, 0.0, 0.0],
        size_m: [1.0; 3],
        angles_rad: [0.0; 3],
    });
    let context = harness.ctx.clone();
    let set_up = harness
        .state_mut()
        .with(&context, |page: &mut ServoWorkspace, cx| {
            page.state.apply(ServoAction::SetUp(settings), cx);
        });
    set_up.expect("the window has this workspace");
    harness.run_steps(4);
    let reply = servo("", here);
    let reason = [&*reply[1], &*reply[18]];
    assert_eq!(reason, ["stay", "outside_volume"], "{reply:?}");
    let runs = harness
        .state()
        .history()
        .servo_runs(&Filter::default(), 0, 10);
    let rows = runs.expect("read").rows;
    let [run] = &rows[..] else {
        panic!("the first run alone has ended");
    };
    let stopped = run.stopped.as_ref().map(servo::StopReason::kind);
    assert_eq!((&*run.part, stopped), ("fender", Some("another_part")));

    toggle(&mut harness);
    harness.run_steps(4);
    let reply = servo("START ", here);
    assert_eq!(
        [&*reply[1], &*reply[18]],
        ["error", "camera_failed"],
        "{reply:?}"
    );
}

#[test]
fn another_library_is_the_one_that_robots_are_answered_by() {
    let folder = tempfile::tempdir().expect("a folder");
    let parts = folder.path().join("other parts");
    copy_library(&parts);
    fs::remove_dir_all(parts.join("fender")).expect("removed");
    let mut harness = open_with(USUAL, options(folder.path()));
    let at = turn_on(&mut harness);
    let mut robot = Robot::connect(at);
    wait_until(&mut harness, |state| state.session.live.status.is_some());
    assert_eq!(robot.ask("TRIGGER")[6], "fender");
    let choose = Action::Chosen(DialogRequest::Library, parts);
    cause(&mut harness, choose);
    wait_until(&mut harness, |state| {
        let library = state.session.library.as_ref();
        library.is_some_and(|library| library.path.ends_with("other parts"))
    });
    let reply = robot.ask("TRIGGER");
    assert!(reply[1] != "accepted" && reply[6] != "fender", "{reply:?}");
    assert_eq!(reply[2], "2", "the same server");
}

#[test]
fn another_convention_or_another_pose_changes_the_boot_number_and_ends_earlier_poses() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, options(folder.path()));
    let at = turn_on(&mut harness);
    wait_until(&mut harness, |state| state.session.live.status.is_some());
    let mut robot = Robot::connect(at);
    let reply = robot.ask("TRIGGER");
    assert_eq!(reply[1], "accepted", "{reply:?}");

    // The same server and connection.
    let setup = harness.state().state().session.answering;
    let offset = AnswerSetup {
        pose: PoseKind::RobotOffset,
        ..setup
    };
    answer(&mut harness, offset);
    let until = Instant::now() + PATIENCE;
    let mut last = robot.ask("LAST");
    while last[3] == reply[3] && Instant::now() < until {
        harness.run_steps(1);
        last = robot.ask("LAST");
    }
    assert_ne!(last[3], reply[3], "another boot number");
    assert_eq!([&*last[1], &*last[12]], ["none", ""], "{last:?}");
    let again = robot.ask("TRIGGER");
    assert_eq!([&again[1], &again[3]], ["accepted", &last[3]], "{again:?}");

    // Another server, which lets its clients go.
    let fanuc = AnswerSetup {
        convention: Convention::Fanuc,
        ..offset
    };
    answer(&mut harness, fanuc);
    let mut rest = String::new();
    let until = Instant::now() + PATIENCE;
    robot.0.get_ref().set_nonblocking(true).expect("set");
    while robot.0.read_line(&mut rest).is_err() && Instant::now() < until {
        harness.run_steps(1);
    }
    assert_eq!(rest, "");
    let at = listening_elsewhere(&mut harness, at);
    let last = Robot::connect(at).ask("LAST");
    assert!(last[1] == "none" && last[3] != again[3], "{last:?}");
}

#[test]
fn a_port_in_use_is_said_with_what_to_do_and_tried_again_until_it_is_free() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, options(folder.path()));
    let taken = TcpListener::bind("127.0.0.1:0").expect("bound");
    let port = taken.local_addr().expect("an address").port();
    let setup = on_at(&format!("ascii={port}"));
    answer(&mut harness, setup);
    wait_for(&mut harness, |window| {
        window.robot().answering().problem().is_some()
    });
    turn_to_page(&mut harness);
    assert!(says(&harness, "another program listens at this port"));
    assert!(says(&harness, "or choose another port"));
    assert!(says(&harness, "Robots are not answered"));
    drop(taken);
    assert_eq!(listening(&mut harness).port(), port);
    assert!(harness.state().robot().answering().problem().is_none());
    harness.run_steps(4);
    assert!(says(&harness, &format!("ascii=127.0.0.1:{port}")));
}

/// Waits until the server reports a problem, or none.
fn wait_for_problem(harness: &mut WindowHarness, is_expected: bool) {
    wait_for(harness, |window| {
        let status = window.robot().answering().status();
        status.is_some_and(|status| status.problem.is_some() == is_expected)
    });
}

#[test]
fn parts_are_numbered_once_robots_are_answered_and_keep_their_numbers() {
    let folder = tempfile::tempdir().expect("a folder");
    let parts = folder.path().join("other parts");
    copy_library(&parts);
    let options = WindowOptions {
        library: Some(parts.clone()),
        ..options(folder.path())
    };
    let mut harness = open_with(USUAL, options);
    let at = turn_on(&mut harness);
    // Without a trigger.
    let stored = LibraryFolder::open(&parts).expect("there");
    let fender = PartName::new("fender").expect("a name");
    wait_until(&mut harness, |_| {
        let numbers = stored.numbers();
        numbers.is_ok_and(|numbers| numbers.number_of(&fender) == Some(3))
    });
    // The window shows them, and does not take its own change for that of another program.
    wait_until(&mut harness, |state| {
        let library = state.session.library.as_ref();
        library.is_some_and(|library| library.numbers.number_of(&fender) == Some(3))
    });
    assert!(!says(&harness, "another program has changed it"));
    fs::remove_dir_all(parts.join("back_door")).expect("removed");
    wait_until(&mut harness, |state| {
        let library = state.session.library.as_ref();
        library.is_some_and(|library| library.index_of("fender") == Some(1))
    });
    wait_until(&mut harness, |state| state.session.live.status.is_some());
    let reply = Robot::connect(at).ask("TRIGGER");
    assert_eq!([&*reply[6], &*reply[7]], ["fender", "3"], "{reply:?}");

    let numbers = parts.join("numbers.toml");
    let sound = fs::read(&numbers).expect("there");
    fs::write(&numbers, "[parts").expect("written");
    wait_for_problem(&mut harness, true);
    let reply = Robot::connect(at).ask("TRIGGER");
    assert_eq!([&*reply[6], &*reply[7]], ["fender", "0"], "{reply:?}");
    fs::write(&numbers, sound).expect("written");
    wait_for_problem(&mut harness, false);
}

/// Opens the dialog at the page on answering.
fn turn_to_page(harness: &mut WindowHarness) {
    cause(harness, Action::Robot(RobotAction::Toggle));
    let mut dialog = harness.state().robot().dialog().expect("open").clone();
    dialog.page = RobotPage::Answer;
    let turned = RobotAction::Edit(Box::new(dialog));
    cause(harness, Action::Robot(turned));
}

#[test]
fn what_robots_are_answered_in_changes_on_its_page_alone_after_a_question_and_with_another_boot() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, options(folder.path()));
    let at = turn_on(&mut harness);
    wait_until(&mut harness, |state| state.session.live.status.is_some());
    let mut robot = Robot::connect(at);
    let before = robot.ask("TRIGGER");
    assert_eq!([&*before[1], &*before[2]], ["accepted", "1"], "{before:?}");

    // What the card shows is another matter, and K is no key.
    cause(&mut harness, Action::UseConvention(Convention::Fanuc));
    harness.key_press(Key::K);
    harness.run_steps(4);
    let session = &harness.state().state().session;
    let conventions = [session.convention, session.answering.convention];
    assert_eq!(conventions, [Convention::Fanuc, Convention::Kuka]);
    let last = robot.ask("LAST");
    assert_eq!(
        [&last[2..4], &last[12..18]],
        [&before[2..4], &before[12..18]]
    );

    turn_to_page(&mut harness);
    let choose = |harness: &mut WindowHarness| {
        let dialog = harness.state().robot().dialog().expect("open").clone();
        let chosen = RobotDialog {
            answered_in: Convention::Fanuc,
            address: "0".into(),
            ..dialog
        };
        cause(harness, Action::Robot(RobotAction::Edit(Box::new(chosen))));
        harness.get_by_label("Use it").click();
        harness.run_steps(4);
        assert!(says(harness, "Robots are being answered"));
    };
    let answered_in =
        |harness: &WindowHarness| harness.state().state().session.answering.convention;
    choose(&mut harness);
    harness.get_by_label("Leave them as they are").click();
    harness.run_steps(4);
    assert!(!says(&harness, "Robots are being answered"));
    assert_eq!(answered_in(&harness), Convention::Kuka);
    assert_eq!(robot.ask("LAST")[3], before[3], "the same server");
    choose(&mut harness);
    harness.get_by_label("Change them").click();
    harness.run_steps(4);
    assert_eq!(answered_in(&harness), Convention::Fanuc);
    let at = listening_elsewhere(&mut harness, at);
    let mut rest = String::new();
    assert_eq!(robot.0.read_line(&mut rest).expect("closed"), 0);
    let mut robot = Robot::connect(at);
    let last = robot.ask("LAST");
    assert_eq!([&*last[1], &*last[2]], ["none", "0"], "{last:?}");
    assert_ne!(last[3], before[3], "another boot");
}

#[test]
fn turned_off_the_port_is_closed_and_robots_are_let_go() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, options(folder.path()));
    let at = turn_on(&mut harness);
    let mut robot = Robot::connect(at);
    assert_eq!(robot.ask("STATUS")[0], "STATUS");
    turn_off(&mut harness);
    let mut rest = String::new();
    assert_eq!(robot.0.read_line(&mut rest).expect("closed"), 0);
    TcpListener::bind(at).expect("nobody listens there any more");
    assert!(!says(&harness, "Answers robots"));
}

#[test]
fn a_window_that_answers_robots_asks_before_it_closes() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, options(folder.path()));
    let at = turn_on(&mut harness);
    let is_asking = |harness: &WindowHarness| says(harness, "Stop answering robots?");
    let click = |harness: &mut WindowHarness, label: &str| {
        harness.get_by_label(label).click();
        harness.run_steps(4);
    };
    cause(&mut harness, Action::Close);
    assert!(is_asking(&harness));
    assert!(says(
        &harness,
        &format!("Robots that ask at {at} get no answer")
    ));
    click(&mut harness, "Keep the window open");
    assert!(!is_asking(&harness));
    assert_eq!(Robot::connect(at).ask("TRIGGER")[1], "accepted");
    // The button of the window's frame.
    let root = harness.input_mut().viewports.entry(egui::ViewportId::ROOT);
    root.or_default().events.push(egui::ViewportEvent::Close);
    harness.run_steps(4);
    assert!(is_asking(&harness));
    click(&mut harness, "Close and stop answering");
    assert_eq!(harness.state().state().closing, Closing::Confirmed);
    drop(harness);

    let options = options(folder.path());
    let mut harness: WindowHarness = Harness::builder().with_size(SMALL).build_eframe(|cc| {
        Window::new(&cc.egui_ctx, cc.wgpu_render_state.as_ref(), options).expect("threads")
    });
    listening(&mut harness);
    turn_off(&mut harness);
    cause(&mut harness, Action::Close);
    assert!(!is_asking(&harness));
}

#[test]
fn a_window_that_answered_robots_answers_again_when_it_is_opened_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(USUAL, options(folder.path()));
    turn_on(&mut harness);
    let settings = folder.path().join("settings.toml");
    wait_for(&mut harness, |_| {
        fs::read_to_string(&settings).is_ok_and(|text| text.contains("is_on = true"))
    });
    drop(harness);

    let options = options(folder.path());
    let mut harness: WindowHarness = Harness::builder().with_size(SMALL).build_eframe(|cc| {
        Window::new(&cc.egui_ctx, cc.wgpu_render_state.as_ref(), options).expect("threads")
    });
    let at = listening(&mut harness);
    wait_until(&mut harness, |state| state.session.live.status.is_some());
    let reply = Robot::connect(at).ask("TRIGGER");
    assert_eq!(reply[1], "accepted", "{reply:?}");
    assert!(says(&harness, "Answers robots · 127.0.0.1:"));
    // The operator's view shows it, too.
    cause(&mut harness, Action::Role(RoleAction::Switch));
    assert!(says(&harness, "Answers robots · 127.0.0.1:"));
}

#[test]
fn nobody_is_answered_without_a_calibration_or_at_no_address() {
    let mut harness = open();
    press(&mut harness, "Robot…");
    press(&mut harness, "Answer robots");
    harness.get_by_label("Calibrate it first, or no pose can be given");
    press(&mut harness, "Turn on");
    assert!(!harness.state().state().session.answering.is_on);
    let port = harness.get_by_role_and_label(Role::TextInput, "Port, or IP address and port");
    port.focus();
    harness.run_steps(2);
    harness.event(egui::Event::Text("x".into()));
    harness.run_steps(3);
    harness.get_by_label_contains("is neither a port nor an IP address with a port");
    let dialog = harness.state().robot().dialog().expect("open").clone();
    let open_to_all = RobotDialog {
        address: "0.0.0.0:30100".into(),
        ..dialog
    };
    let edit = RobotAction::Edit(Box::new(open_to_all));
    act(&mut harness, Action::Robot(edit));
    harness.get_by_label_contains("is open to the network without encryption");
}

/// Where a part that swings is seen, metres beside its place: no verdict on it counts, and robots get no pose of it.
const SWINGING: [f64; 2] = [0.0, 0.06];
/// Where one is seen that comes, and one that goes.
const COMING: [f64; 3] = [2.0, 1.2, 0.5];
const GOING: [f64; 6] = [-0.5, -1.2, -2.0, -2.0, -2.0, -2.0];

/// A calibrated window whose every camera is this wire, with a history in this folder.
fn wired(folder: &Path) -> (WindowHarness, Sender<Step>) {
    let cell = folder.join("cell.toml");
    save_calibration(&cell);
    let (options, wire) = wired_options();
    let options = WindowOptions {
        cell: Some(cell),
        history: Some(folder.join("history")),
        ..options
    };
    (open_with(USUAL, options), wire)
}

/// A robot triggers; until it is answered the camera sees the part at these places, again and again.
fn told_while(
    harness: &mut WindowHarness,
    wire: &Sender<Step>,
    at: SocketAddr,
    places: [f64; 2],
) -> Vec<String> {
    let asking = thread::spawn(move || Robot::connect(at).ask("TRIGGER"));
    while !asking.is_finished() {
        sees(harness, wire, places);
    }
    asking.join().expect("no panic")
}

/// The same; the part is accepted, unless it swings.
fn ask_while(harness: &mut WindowHarness, wire: &Sender<Step>, at: SocketAddr, places: [f64; 2]) {
    let reply = told_while(harness, wire, at, places);
    let expected = if places[1] > places[0] {
        ["refused", "moving"]
    } else {
        ["accepted", ""]
    };
    let reason = reply.len().checked_sub(2).map_or("", |index| &reply[index]);
    assert_eq!([&*reply[1], reason], expected, "{reply:?}");
    assert_eq!(reply[6], "fender", "{reply:?}");
}

/// The same; then Live has seen what the robot was answered by.
fn trigger(harness: &mut WindowHarness, wire: &Sender<Step>, at: SocketAddr, places: [f64; 2]) {
    ask_while(harness, wire, at, places);
    sees(harness, wire, places);
}

/// Waits until the history shows so many parts, and so many inspections below the newest.
fn wait_for_rows(harness: &mut WindowHarness, num_parts: usize, num_below: usize) {
    wait_for(harness, |window| {
        let history = window.workspace::<HistoryWorkspace>();
        let history = history.map(|history| &history.state);
        history.is_some_and(|history| {
            let below = history.row(0).map(|row| row.num_below);
            history.is_settled() && (history.num_rows(), below) == (num_parts, Some(num_below))
        })
    });
}

#[test]
fn a_trigger_before_or_after_the_verdict_counts_is_no_other_part() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut harness, wire) = wired(folder.path());
    let at = turn_on(&mut harness);
    trigger(&mut harness, &wire, at, SWINGING);
    // With the first frame of the window.
    wait_for_rows(&mut harness, 2, 0);
    let of_trigger = history_of(&harness).row(0).map(|row| row.number);

    sees(&mut harness, &wire, [0.0; 22]);
    harness.get_by_label("Recognised");
    wait_for_rows(&mut harness, 2, 1);
    let of_live = history_of(&harness).row(0).map(|row| row.number);
    assert!(of_live > of_trigger, "the verdict of many frames stands");

    trigger(&mut harness, &wire, at, [0.0; 2]);
    wait_for_rows(&mut harness, 2, 2);
    let now = history_of(&harness).row(0).map(|row| row.number);
    assert_eq!(now, of_live);

    cause(&mut harness, Action::Role(RoleAction::Switch));
    wait_until(&mut harness, |state| state.session.shift.since.is_some());
    let shift = &harness.state().state().session.shift;
    // The window's first frame is of another source.
    assert_eq!((shift.num_ok, shift.num_not_ok), (1, 0));
}

#[test]
fn triggers_of_two_parts_one_after_the_other_and_of_one_that_swings_through_are_three_parts() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut harness, wire) = wired(folder.path());
    let at = turn_on(&mut harness);
    for num_parts in 2..=3 {
        sees(&mut harness, &wire, COMING);
        trigger(&mut harness, &wire, at, SWINGING);
        sees(&mut harness, &wire, [0.0; 22]);
        harness.get_by_label("Recognised");
        wait_for_rows(&mut harness, num_parts, 1);
        sees(&mut harness, &wire, GOING);
    }
    sees(&mut harness, &wire, COMING);
    trigger(&mut harness, &wire, at, SWINGING);
    sees(&mut harness, &wire, GOING);
    sees(&mut harness, &wire, [-2.0; 2]);
    // Neither Live nor a robot's trigger has accepted it.
    wait_for_rows(&mut harness, 4, 1);
    let newest = history_of(&harness).row(0).expect("kept");
    assert_eq!(newest.verdict, StoredVerdict::Rejected);
}

#[test]
fn what_robots_were_answered_is_kept_when_the_server_ends_or_the_window_before_live_is_done() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut harness, wire) = wired(folder.path());
    let at = turn_on(&mut harness);
    ask_while(&mut harness, &wire, at, SWINGING);
    turn_off(&mut harness);
    sees(&mut harness, &wire, [0.0; 22]);
    harness.get_by_label("Recognised");
    wait_for_rows(&mut harness, 2, 1);

    sees(&mut harness, &wire, GOING);
    let at = turn_on(&mut harness);
    sees(&mut harness, &wire, COMING);
    ask_while(&mut harness, &wire, at, SWINGING);
    drop(harness);
    let history = HistoryBuffer::new(Some(folder.path().join("history")));
    let page = history.page(&Filter::default(), 0, 10).expect("readable");
    assert_eq!((page.num_all, page.rows.len()), (3, 3));
    let newest = &page.rows[0];
    assert_eq!(newest.verdict, StoredVerdict::Rejected);
    assert_eq!(newest.part.as_deref(), Some("fender"));
}

/// Says what the newest part really is, and waits until the window knows it.
fn report(harness: &mut WindowHarness, truth: &Truth) {
    let number = history_of(harness).row(0).expect("kept").number;
    let action = HistoryAction::Label(number, Some(truth.clone()));
    let context = harness.ctx.clone();
    let applied = harness
        .state_mut()
        .with(&context, |history: &mut HistoryWorkspace, cx| {
            history.apply(action, cx);
        });
    applied.expect("the window has this workspace");
    wait_until(harness, |state| {
        let mut labelled = state.session.shift.labelled.iter();
        labelled.any(|(_, label)| label == truth)
    });
}

/// True if this answer refuses the fender because it was reported as wrong; the flags mean "simulated", without a pose.
fn is_reported(reply: &[String]) -> bool {
    let has_reason = reply.iter().any(|field| field == "reported_wrong");
    has_reason && [&*reply[1], &*reply[6], &*reply[8]] == ["refused", "fender", "4"]
}

#[test]
fn a_part_that_was_reported_as_wrong_has_no_pose_until_it_has_left_or_the_report_is_corrected() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut harness, wire) = wired(folder.path());
    let at = turn_on(&mut harness);
    sees(&mut harness, &wire, [0.0; 22]);
    harness.get_by_label("Recognised");
    trigger(&mut harness, &wire, at, [0.0; 2]);
    // With the first frame of the window.
    wait_for_rows(&mut harness, 2, 1);
    report(&mut harness, &Truth::NotEnrolled);
    // What was answered before is withheld too, as soon as the server looks.
    let mut robot = Robot::connect(at);
    let until = Instant::now() + PATIENCE;
    let mut last = robot.ask("LAST");
    while last[1] != "refused" && Instant::now() < until {
        thread::sleep(Duration::from_millis(20));
        last = robot.ask("LAST");
    }
    assert!(is_reported(&last), "{last:?}");
    let reply = told_while(&mut harness, &wire, at, [0.0; 2]);
    assert!(is_reported(&reply), "{reply:?}");

    report(&mut harness, &Truth::Part("fender".into()));
    trigger(&mut harness, &wire, at, [0.0; 2]);
    report(&mut harness, &Truth::Part("grille".into()));
    let reply = told_while(&mut harness, &wire, at, [0.0; 2]);
    assert!(is_reported(&reply), "{reply:?}");

    sees(&mut harness, &wire, GOING);
    sees(&mut harness, &wire, COMING);
    sees(&mut harness, &wire, [0.0; 22]);
    trigger(&mut harness, &wire, at, [0.0; 2]);
}
