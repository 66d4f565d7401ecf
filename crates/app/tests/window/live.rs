//! Following a source, with a camera that gives a frame when the test asks for one, independent of any clock.

use std::{
    path::Path,
    sync::{
        Arc, Mutex,
        mpsc::{Receiver, RecvTimeoutError, Sender, channel},
    },
    time::{Duration, Instant},
};

use app::{Window, WindowOptions, workspaces::history::HistoryWorkspace};
use capture::{CaptureError, Captured, DepthSource, Image, NextCapture};
use egui::Key;
use egui_kittest::{Harness, kittest::Queryable as _};
use files::save_cloud;
use geometry::rigid::RigidTransform;
use jiff::{SignedDuration, Timestamp};
use records::history::StoredVerdict;
use shell::{
    action::{Action, DialogRequest},
    cell::RobotPage,
    inspection::{camera::Camera, source::CellChoice},
    roles::RoleAction,
    session::{Source, WorkspaceKind},
    source::live::{LiveAction, SourceState},
    state::State,
};
use simulate::{PartKind, SensorNoise, Side};

use simulate::fixtures::HangingPart;
use stages::fixtures::facing_part;

use super::{
    operator::{open_operators, pass_time, scan, wait_for_serial},
    robot::save_calibration,
    set_up::{
        SMALL, USUAL, WindowHarness, act, history_of, is_recognised, open, open_with,
        plain_options, press, settle, wait_for, wait_until,
    },
};

/// Time between two frames by the camera's clock, milliseconds: that of a slow camera.
const APART: i64 = 150;

/// The test's end of the channel to the camera.
type Wire = Sender<Step>;

/// The camera's next step.
pub(crate) enum Step {
    /// It sees the fender, this far to the right of its place, metres.
    Fender(f64),
    /// It is unplugged until the next step.
    Unplugged,
    /// It has no more frames.
    End,
}

/// The camera's end of the channel.
struct Cable {
    steps: Receiver<Step>,
    is_unplugged: bool,
    /// The step with which it was plugged in again.
    next: Option<Step>,
}

impl Cable {
    fn gone() -> CaptureError {
        CaptureError::FolderGone {
            path: "wired camera".into(),
            may_come: true,
        }
    }

    fn plug_in(&mut self) -> Result<(), CaptureError> {
        if self.is_unplugged {
            self.next = Some(self.steps.try_recv().or(Err(Self::gone()))?);
            self.is_unplugged = false;
        }
        Ok(())
    }
}

/// The camera.
struct Wired {
    is_simulated: bool,
    cable: Arc<Mutex<Cable>>,
    number: u64,
    fender: HangingPart,
}

impl DepthSource for Wired {
    fn title(&self) -> String {
        "wired camera".into()
    }

    fn is_simulated(&self) -> bool {
        self.is_simulated
    }

    fn next(&mut self, wait: Duration) -> Result<NextCapture, CaptureError> {
        let mut cable = self.cable.lock().expect("no panic");
        let step = match cable.next.take() {
            Some(step) => Ok(step),
            None => cable.steps.recv_timeout(wait),
        };
        match step {
            Err(RecvTimeoutError::Timeout) => Ok(NextCapture::NotYet),
            Err(RecvTimeoutError::Disconnected) | Ok(Step::End) => Ok(NextCapture::End),
            Ok(Step::Unplugged) => {
                cable.is_unplugged = true;
                Err(Cable::gone())
            }
            Ok(Step::Fender(x)) => {
                drop(cable);
                self.number += 1;
                Ok(NextCapture::Captured(self.frame(x)))
            }
        }
    }
}

impl Wired {
    fn frame(&self, x: f64) -> Captured {
        let aside = RigidTransform::translation(x, 0.0, 0.0);
        let noise = SensorNoise::kinect(self.number);
        let at = SignedDuration::from_millis(APART * self.number as i64);
        Captured {
            number: self.number,
            name: format!("wired frame {}", self.number),
            taken_at: Timestamp::UNIX_EPOCH + at,
            arrived: Instant::now(),
            image: Image::Depth(self.fender.frame(noise, &aside)),
            is_simulated: self.is_simulated,
            truth: None,
            robot_from_flange: None,
            warnings: Vec::new(),
        }
    }
}

/// Opens a window whose cameras all follow this channel.
fn wired() -> (WindowHarness, Wire) {
    let (options, wire) = wired_options();
    (open_with(USUAL, options), wire)
}

/// The options of such a window, and the channel.
pub(crate) fn wired_options() -> (WindowOptions, Wire) {
    options_of(true)
}

/// As [`wired_options`], with the calibration of a cell in this folder, and a camera that passes for a real one: a robot may act
/// on what it sees.
pub(crate) fn robot_options(folder: &Path) -> (WindowOptions, Wire) {
    let (options, wire) = options_of(false);
    let cell = folder.join("cell.toml");
    save_calibration(&cell);
    let options = WindowOptions {
        cell: Some(cell),
        ..options
    };
    (options, wire)
}

fn options_of(is_simulated: bool) -> (WindowOptions, Wire) {
    let (sender, steps) = channel();
    let cable = Arc::new(Mutex::new(Cable {
        steps,
        is_unplugged: false,
        next: None,
    }));
    let camera = Camera::opened_by(move |_| {
        cable.lock().expect("no panic").plug_in()?;
        Ok(Box::new(Wired {
            is_simulated,
            cable: Arc::clone(&cable),
            number: 0,
            fender: HangingPart::new(PartKind::Fender, 3),
        }))
    });
    let options = WindowOptions {
        camera,
        ..plain_options()
    };
    (options, sender)
}

fn num_inspected(state: &State) -> u64 {
    state
        .session
        .live
        .status
        .as_ref()
        .map_or(0, |status| status.num_inspected)
}

fn says(harness: &WindowHarness, text: &str) -> bool {
    harness.query_all_by_label_contains(text).next().is_some()
}

/// Sends one frame after the other, each once the previous one was inspected and is shown.
pub(crate) fn sees(
    harness: &mut WindowHarness,
    wire: &Wire,
    places: impl IntoIterator<Item = f64>,
) {
    for x in places {
        let before = num_inspected(harness.state().state());
        wire.send(Step::Fender(x)).expect("the camera is open");
        wait_until(harness, |state| num_inspected(state) > before);
        harness.step();
    }
}

pub(crate) fn toggle(harness: &mut WindowHarness) {
    harness.get_by_label("Live").click();
    harness.step();
    harness.step();
}

#[test]
fn a_part_counts_once_it_hangs_still_and_no_longer_when_it_moves() {
    let (mut harness, wire) = wired();
    toggle(&mut harness);
    assert!(harness.state().state().session.is_live());
    sees(&mut harness, &wire, [0.0; 4]);
    assert!(says(&harness, "Live · looking") && says(&harness, "Not accepted yet"));
    assert!(!is_recognised(&harness));
    assert!(says(&harness, "Wired frame 4, simulated"));

    sees(&mut harness, &wire, [0.0; 12]);
    assert!(says(&harness, "Live · steady for"), "no longer looked at");
    assert!(says(&harness, "frames agree"));
    harness.get_by_label("Recognised");
    harness.get_by_label("Fender, left");
    // A verdict that counts is one inspection in the history, however many frames it rests on.
    let history = history_of(&harness);
    assert_eq!(
        history.num_rows(),
        2,
        "the first frame of the window, and this one"
    );
    let newest = history.row(0).expect("kept");
    assert_eq!(newest.verdict, StoredVerdict::Accepted);
    assert!(newest.is_simulated);

    sees(&mut harness, &wire, [0.03, 0.06]);
    assert!(says(&harness, "Live · moving") && says(&harness, "Moving"));
    assert!(!is_recognised(&harness));
    // A robot that reads the pose on the clipboard must find none that counts.
    let shown = harness
        .state()
        .state()
        .session
        .shown
        .as_ref()
        .expect("shown");
    assert!(!shown.inspected.inspection.verdict.is_accepted());

    // It hangs still again in another place: another verdict on the same part, which counts once.
    sees(&mut harness, &wire, [0.06; 22]);
    harness.get_by_label("Recognised");
    settle_history(&mut harness);
    let history = history_of(&harness);
    assert_eq!(history.num_rows(), 2);
    assert_eq!(history.row(0).map(|row| row.num_below), Some(1));
    toggle(&mut harness);
    settle(&mut harness);
    assert!(!harness.state().state().session.is_live());
}

/// Draws until the history shows all that was written.
fn settle_history(harness: &mut WindowHarness) {
    let is_settled = |window: &Window| {
        let history = window.workspace::<HistoryWorkspace>();
        history.is_some_and(|history| history.state.is_settled())
    };
    wait_for(harness, is_settled);
}

#[test]
fn two_parts_one_after_the_other_are_two_rows_and_one_that_swings_through_is_one_too() {
    let (mut harness, wire) = wired();
    toggle(&mut harness);
    // Two parts come from the right, rest, and leave to the left; the third does not stop.
    let coming = [2.0, 1.2, 0.5];
    for _ in 0..2 {
        sees(&mut harness, &wire, coming);
        sees(&mut harness, &wire, [0.0; 22]);
        harness.get_by_label("Recognised");
        sees(&mut harness, &wire, [-0.5, -1.2, -2.0, -2.0, -2.0, -2.0]);
    }
    settle_history(&mut harness);
    let history = history_of(&harness);
    assert_eq!(history.num_rows(), 3, "with the first frame of the window");
    assert_eq!(history.row(0).map(|row| row.num_below), Some(0));
    sees(&mut harness, &wire, [2.0, 1.2, 0.3, 0.0, -0.3, -1.2]);
    sees(&mut harness, &wire, [-2.0; 5]);
    settle_history(&mut harness);
    let history = history_of(&harness);
    assert_eq!(history.num_rows(), 4);
    let last = history.row(0).expect("listed");
    assert_eq!(last.verdict, StoredVerdict::Rejected);
    assert_eq!(last.part.as_deref(), Some("fender"));
    wire.send(Step::End).expect("the camera is open");
    settle(&mut harness);
    let state = harness.state().state();
    assert_eq!(
        (state.session.is_live(), history_of(&harness).num_rows()),
        (false, 4)
    );
}

/// Waits for this many rows in the history; returns whether the newest is of the fender, and its serial number.
fn newest_of(harness: &mut WindowHarness, num_rows: usize) -> (bool, String) {
    wait_for(harness, |window| {
        let history = window.workspace::<HistoryWorkspace>();
        history.is_some_and(|history| history.state.num_rows() == num_rows)
    });
    settle_history(harness);
    let newest = history_of(harness).row(0).expect("listed");
    let is_fender = newest.part.as_deref() == Some("fender");
    (is_fender, newest.trace.serial.clone())
}

#[test]
fn a_part_without_a_verdict_that_counts_is_recorded_when_live_stops_or_follows_another_source() {
    let (mut harness, wire) = wired();
    let serial = |harness: &WindowHarness| harness.state().state().session.trace.get().serial;
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0; 4]);
    assert_eq!(history_of(&harness).num_rows(), 1);
    harness.state().state().session.trace.set_serial("4711");
    toggle(&mut harness);
    settle(&mut harness);
    assert_eq!(newest_of(&mut harness, 2), (true, String::new()));
    // The part still hangs there.
    assert_eq!(serial(&harness), "4711");

    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0; 4]);
    let choice = CellChoice::Part(PartKind::Grille, Side::Left);
    act_live(&mut harness, Action::UseCell(choice));
    assert_eq!(newest_of(&mut harness, 3), (true, "4711".to_owned()));
    assert_eq!(serial(&harness), "");
}

/// Captures a frame of the fender in place of Live.
fn capture(harness: &mut WindowHarness, wire: &Wire) {
    act_live(harness, Action::Capture);
    // A frame that comes before could be taken by Live.
    wait_until(harness, |state| state.follower.is_idle());
    wire.send(Step::Fender(0.0)).expect("the camera is open");
    settle(harness);
}

#[test]
fn a_capture_during_live_is_an_inspection_of_the_part_that_hangs_there() {
    let (mut harness, wire) = wired();
    let set_serial = |harness: &WindowHarness, serial| {
        harness.state().state().session.trace.set_serial(serial);
    };
    let serial = |harness: &WindowHarness| harness.state().state().session.trace.get().serial;
    let num_below = |harness: &WindowHarness| history_of(harness).row(0).map(|row| row.num_below);
    toggle(&mut harness);
    // Captures of a cell that is chosen from the list show another part each.
    let spec = "simulated:fender".parse().expect("a source");
    act_live(&mut harness, Action::Live(LiveAction::Use(spec)));
    wait_until(&mut harness, |state| state.session.live.status.is_some());
    sees(&mut harness, &wire, [0.0; 4]);
    set_serial(&harness, "4711");
    capture(&mut harness, &wire);
    assert_eq!(newest_of(&mut harness, 2), (true, "4711".to_owned()));
    assert_eq!(num_below(&harness), Some(1), "what Live saw");
    assert_eq!(serial(&harness), "");

    // A serial number that comes after the verdict is of the part that hangs there; the one after it is of the next part.
    act_live(&mut harness, Action::Role(RoleAction::Switch));
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0; 22]);
    harness.get_by_label("Recognised");
    scan(&mut harness, "4712");
    scan(&mut harness, "4713");
    capture(&mut harness, &wire);
    pass_time(&mut harness);
    wait_for_serial(&mut harness, 0, "4712");
    assert_eq!(newest_of(&mut harness, 3), (true, "4712".to_owned()));
    assert_eq!(num_below(&harness), Some(1), "the capture");
    assert_eq!(serial(&harness), "4713");
}

#[test]
fn a_part_without_a_verdict_that_counts_is_recorded_when_the_window_closes() {
    let folder = tempfile::tempdir().expect("a folder");
    let history = Some(folder.path().join("history"));
    let (options, wire) = wired_options();
    let options = WindowOptions {
        history: history.clone(),
        ..options
    };
    let mut harness = open_with(USUAL, options);
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0; 4]);
    harness.state().state().session.trace.set_serial("4711");
    eframe::App::on_exit(harness.state_mut());
    drop(harness);
    let options = WindowOptions {
        history,
        ..plain_options()
    };
    let harness = open_with(USUAL, options);
    let history = history_of(&harness);
    let rows = (0..history.num_rows()).filter_map(|index| history.row(index));
    let fenders: Vec<_> = rows
        .filter(|row| row.part.as_deref() == Some("fender"))
        .map(|row| row.trace.serial.as_str())
        .collect();
    assert_eq!(fenders, ["4711"]);
}

#[test]
fn the_view_stays_where_a_person_has_turned_it_and_each_frame_is_shown() {
    let (mut harness, wire) = wired();
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0]);
    let first = harness
        .state()
        .state()
        .session
        .shown
        .clone()
        .expect("shown");
    sees(&mut harness, &wire, [0.0]);
    let second = harness
        .state()
        .state()
        .session
        .shown
        .clone()
        .expect("shown");
    assert!(!Arc::ptr_eq(&first.inspected, &second.inspected));
    assert!(first.generation != second.generation && first.session == second.session);
    // Another workspace keeps its result and shows the live status.
    act_live(&mut harness, Action::GoTo(WorkspaceKind::History));
    sees(&mut harness, &wire, [0.0]);
    let third = harness
        .state()
        .state()
        .session
        .shown
        .clone()
        .expect("shown");
    assert!(Arc::ptr_eq(&second.inspected, &third.inspected));
    assert!(says(&harness, "Live · looking"));
}

/// Like [`act`], but without settling, which never happens while a source is followed.
fn act_live(harness: &mut WindowHarness, action: Action) {
    let context = harness.ctx.clone();
    harness.state_mut().act(action, &context);
    harness.run_steps(2);
}

#[test]
fn a_lost_source_is_a_notice_until_it_comes_back_by_itself() {
    let (mut harness, wire) = wired();
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0; 16]);
    harness.get_by_label("Recognised");
    wire.send(Step::Unplugged).expect("the camera is open");
    let is_lost = |state: &State| {
        let status = state.session.live.status.as_ref();
        status.is_some_and(|status| matches!(status.source, SourceState::Lost(_)))
    };
    wait_until(&mut harness, is_lost);
    harness.run_steps(2);
    assert_eq!(harness.state().state().notices.len(), 1);
    assert!(says(&harness, "lost, reconnecting"));
    assert!(says(&harness, "the folder does not exist"));

    sees(&mut harness, &wire, [0.0]);
    assert!(says(&harness, "The source is back"));
    assert!(!says(&harness, "the folder does not exist"));
    assert!(harness.state().state().session.is_live());
}

#[test]
fn a_capture_from_a_lost_camera_leaves_live_trying_and_one_that_is_taken_ends_it() {
    let (options, wire) = wired_options();
    let mut harness = open_operators(options);
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0]);
    wire.send(Step::Unplugged).expect("the camera is open");
    wait_until(&mut harness, |state| {
        let status = state.session.live.status.as_ref();
        status.is_some_and(|status| matches!(status.source, SourceState::Lost(_)))
    });
    harness.key_press(Key::Space);
    harness.run_steps(4);
    assert!(harness.state().state().session.is_live());
    assert!(!says(&harness, "Live stopped"));
    // The operator reads what to do, and the engineer why.
    assert!(says(&harness, "No camera") && says(&harness, "call maintenance"));
    assert!(!says(&harness, "the folder does not exist"));
    act_live(&mut harness, Action::Role(RoleAction::Switch));
    act_live(&mut harness, Action::Role(RoleAction::Enter));
    harness.run_steps(2);
    assert!(says(&harness, "the folder does not exist"));
    act_live(&mut harness, Action::Role(RoleAction::Switch));

    sees(&mut harness, &wire, [0.0]);
    harness.key_press(Key::Space);
    settle(&mut harness);
    assert!(!harness.state().state().session.is_live());
    assert!(says(&harness, "Live stopped: one frame was captured"));
}

#[test]
fn a_second_window_on_the_same_data_says_so_and_does_not_start_live_by_itself() {
    let folder = tempfile::tempdir().expect("a folder");
    let start = || {
        let options = WindowOptions {
            settings: Some(folder.path().join("settings.toml")),
            history: Some(folder.path().join("history")),
            ..plain_options()
        };
        let mut harness: WindowHarness = Harness::builder().with_size(USUAL).build_eframe(|cc| {
            let render_state = cc.wgpu_render_state.as_ref();
            Window::new(&cc.egui_ctx, render_state, options).expect("threads")
        });
        harness.run_steps(4);
        harness
    };
    let says_so = |harness: &WindowHarness| says(harness, "already open with this data folder");
    let mut first = start();
    let captures = folder.path().join("captures");
    std::fs::create_dir(&captures).expect("made");
    let watched = Action::Chosen(DialogRequest::WatchedFolder, captures);
    act_live(&mut first, watched);
    eframe::App::on_exit(first.state_mut());
    drop(first);
    // The lock's file is still there.
    let first = start();
    assert!(first.state().state().session.is_live() && !says_so(&first));
    let mut second = start();
    assert!(!second.state().state().session.is_live() && says_so(&second));
    act_live(&mut second, Action::Role(RoleAction::Switch));
    assert!(says_so(&second), "in the operator's view, too");
    // A person may start it.
    act_live(&mut second, Action::Live(LiveAction::Toggle));
    assert!(second.state().state().session.is_live() && says_so(&second));
    act_live(&mut second, Action::Live(LiveAction::Toggle));
    eframe::App::on_exit(second.state_mut());
    drop((first, second));
    let next = start();
    assert!(next.state().state().session.is_live() && !says_so(&next));
}

#[test]
fn a_watched_folder_is_followed_from_the_next_start_on_unless_live_was_off() {
    for was_live in [true, false] {
        let folder = tempfile::tempdir().expect("a folder");
        let start = || {
            let options = WindowOptions {
                settings: Some(folder.path().join("settings.toml")),
                ..plain_options()
            };
            let mut harness: WindowHarness =
                Harness::builder().with_size(USUAL).build_eframe(|cc| {
                    let render_state = cc.wgpu_render_state.as_ref();
                    Window::new(&cc.egui_ctx, render_state, options).expect("threads")
                });
            // It does not settle while the folder is followed.
            harness.run_steps(4);
            harness
        };
        let mut harness = start();
        let watched = Action::Chosen(DialogRequest::WatchedFolder, folder.path().to_owned());
        act_live(&mut harness, watched);
        assert!(harness.state().state().session.is_live());
        if !was_live {
            act_live(&mut harness, Action::Live(LiveAction::Toggle));
        }
        eframe::App::on_exit(harness.state_mut());
        drop(harness);
        let harness = start();
        assert_eq!(harness.state().state().session.is_live(), was_live);
    }
}

#[test]
fn following_ends_from_any_state() {
    let (mut harness, wire) = wired();
    // While the source is being opened.
    toggle(&mut harness);
    toggle(&mut harness);
    settle(&mut harness);
    assert!(!harness.state().state().session.is_live());
    // While frames come: Space captures one frame instead.
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0; 2]);
    harness.key_press(Key::Space);
    settle(&mut harness);
    assert!(!harness.state().state().session.is_live());
    harness.get_by_label("Simulated frame 2");
    // While the source is lost; the notice disappears, too.
    harness.key_press(Key::L);
    harness.run_steps(2);
    sees(&mut harness, &wire, [0.0]);
    wire.send(Step::Unplugged).expect("the camera is open");
    wait_until(&mut harness, |state| !state.notices.is_empty());
    harness.key_press(Key::L);
    settle(&mut harness);
    assert!(!harness.state().state().session.is_live());
    assert!(harness.state().state().notices.is_empty());
    // At the source's own end.
    toggle(&mut harness);
    wire.send(Step::End).expect("the camera is open");
    wait_until(&mut harness, |state| !state.session.is_live());
    settle(&mut harness);
    assert!(says(&harness, "has no more frames"));
    // The window can be closed while the source is followed.
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0]);
    drop(harness);
}

#[test]
fn another_source_is_followed_at_once_and_changed_parameters_count_anew() {
    let (mut harness, wire) = wired();
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0; 16]);
    harness.get_by_label("Recognised");
    act_live(&mut harness, Action::Live(LiveAction::Average(4)));
    // Wait, because the former follower would take an earlier frame.
    wait_until(&mut harness, |state| state.session.live.status.is_some());
    sees(&mut harness, &wire, [0.0]);
    assert!(!is_recognised(&harness));
    assert_eq!(num_inspected(harness.state().state()), 1);
    sees(&mut harness, &wire, [0.0; 15]);
    assert!(says(&harness, "depth of 4"));
    harness.get_by_label("Recognised");

    let choice = CellChoice::Part(PartKind::Grille, Side::Left);
    act_live(&mut harness, Action::UseCell(choice));
    assert!(harness.state().state().session.is_live());
    assert_eq!(harness.state().state().session.source, Source::Cell(choice));
}

#[test]
fn a_recording_is_made_and_plays_as_what_it_was() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut harness, wire) = wired();
    toggle(&mut harness);
    let parent = folder.path().to_owned();
    act_live(&mut harness, Action::Live(LiveAction::Record(parent)));
    wait_until(&mut harness, |state| state.session.live.status.is_some());
    sees(&mut harness, &wire, [0.0; 22]);
    assert!(says(&harness, "Stop recording · 22 frames"));
    harness.get_by_label("Recognised");
    harness.get_by_label_contains("Stop recording").click();
    harness.run_steps(4);
    assert!(harness.state().state().session.live.recording.is_none());
    assert!(says(&harness, "Recorded 22 frames"));
    // Frames from now on are not recorded.
    wait_until(&mut harness, |state| state.session.live.status.is_some());
    sees(&mut harness, &wire, [0.0]);
    toggle(&mut harness);
    settle(&mut harness);
    drop(harness);

    let recording = std::fs::read_dir(folder.path()).expect("read");
    let recording = recording.map(|entry| entry.expect("read").path());
    let recording: Vec<_> = recording.collect();
    assert_eq!(recording.len(), 1, "{recording:?}");
    let mut harness = open();
    let spec = format!("recording,pace=step:{}", recording[0].display());
    let spec = spec.parse().expect("a source");
    // Step by step: each capture is the next frame.
    act(&mut harness, Action::Live(LiveAction::Use(spec)));
    assert!(says(&harness, "wired frame 1") || says(&harness, "Wired frame 1"));
    harness.get_by_label("Recognised");
    harness.get_by_label("Capture").click();
    settle(&mut harness);
    assert!(says(&harness, "Wired frame 2, simulated"));
    // Played to the end, frame after frame; the part that hung still counts.
    toggle(&mut harness);
    wait_until(&mut harness, |state| !state.session.is_live());
    settle(&mut harness);
    assert!(says(&harness, "has no more frames"));
    let history = history_of(&harness);
    assert_eq!(
        history.num_rows(),
        4,
        "the first frame, two captures, and this"
    );
    let newest = history.row(0).expect("kept");
    assert_eq!(newest.verdict, StoredVerdict::Accepted);
    assert!(newest.is_simulated);
}

#[test]
fn a_single_file_is_not_followed_and_that_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("fender.pcd");
    let scene = facing_part(PartKind::Fender, Side::Left, 5);
    save_cloud(&file, &scene.cloud).expect("written");
    let mut harness = open();
    act(&mut harness, Action::Open(file));
    settle(&mut harness);
    let before = harness.state().state().notices.len();
    toggle(&mut harness);
    assert!(!harness.state().state().session.is_live());
    assert_eq!(harness.state().state().notices.len(), before + 1);
    assert!(says(&harness, "A single file cannot be followed"));
}

#[test]
fn the_cell_can_be_set_up_and_is_captured_as_it_is() {
    let mut harness = open();
    harness.get_by_label_contains("Source").click();
    harness.run_steps(4);
    harness.get_by_label("Set up the cell…").click();
    harness.run_steps(4);
    harness.get_by_label("A plank in front").click();
    harness.run_steps(2);
    harness.get_by_label("Use it").click();
    settle(&mut harness);
    let Source::Camera(spec) = &harness.state().state().session.source else {
        panic!("not set up");
    };
    assert_eq!(spec.to_string(), "simulated,clutter=in-front");
    assert!(says(&harness, "simulated frame 1") || says(&harness, "Simulated frame 1"));
}

#[test]
fn a_click_on_the_status_bar_leads_to_where_it_is_set_right() {
    let mut harness = open_with(SMALL, plain_options());
    let longest = CellChoice::all().max_by_key(|choice| choice.title().len());
    let longest = longest.expect("there are choices");
    act(&mut harness, Action::UseCell(longest));
    let calibration = "Where the camera sits in the robot's cell: not calibrated";
    let labels = [
        "Source · ",
        calibration,
        "No robot is answered",
        "Live is off",
        "Age of the frame on the screen",
        "The speed of this computer",
    ];
    let rects = labels.map(|label| harness.get_by_label_contains(label).rect());
    for pair in rects.windows(2) {
        assert!(pair[0].right() <= pair[1].left() + 0.5, "{rects:?}");
    }
    assert!(rects[0].left() >= 0.0 && rects[5].right() <= SMALL.x && rects[5].bottom() <= SMALL.y);
    press(&mut harness, calibration);
    let page = |harness: &WindowHarness| harness.state().robot().dialog().map(|of| of.page);
    assert_eq!(page(&harness), Some(RobotPage::InUse));
    press(&mut harness, "Close");
    press(&mut harness, "No robot is answered: answering is off");
    assert_eq!(page(&harness), Some(RobotPage::Answer));
    press(&mut harness, "Close");
    harness.get_by_label_contains("Live is off").click();
    harness.run_steps(4);
    assert!(harness.state().state().session.is_live());
}

#[test]
fn live_that_stops_while_something_moves_leaves_no_such_card() {
    let (mut harness, wire) = wired();
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0, 0.03, 0.06]);
    sees(&mut harness, &wire, [0.2, 0.4, 0.6, 0.8]);
    harness.get_by_label("Moving");
    toggle(&mut harness);
    settle(&mut harness);
    assert!(!says(&harness, "Moving") && !says(&harness, "is moving"));
    harness.get_by_label("No verdict");
    harness.get_by_label("Press Capture");
    act(&mut harness, Action::Role(RoleAction::Switch));
    harness.get_by_label("No verdict");
}
