//! Measures the cost of a frame at rest, while the view is rotated, and while a source is followed.

use std::{
    thread,
    time::{Duration, Instant},
};

use egui::{Event, Modifiers, PointerButton, Pos2, Vec2};
use serde::Serialize;

use crate::processor_time::{ProcessorWatch, process_seconds};
use app::{
    WindowOptions,
    headless::HeadlessWindow,
    workspaces::{
        align::{AlignAction, AlignWorkspace},
        enrol::{EnrolAction, EnrolWorkspace},
    },
};
use geometry::statistics::quantile;
use shell::{action::Action, session::WorkspaceKind, source::live::LiveAction};
use ui::viewport::ViewError;

/// Size of the measured windows, logical pixels.
pub(crate) const SIZE: [u32; 2] = [1440, 900];

/// Whether the next frame may begin while the device still draws this one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pace {
    /// The next frame may begin, so that the cost of the processor is measured apart from that of the device.
    Ahead,
    /// The next frame waits, as with a display that takes one picture after the other.
    InStep,
}

/// How long a frame took.
#[derive(Clone, Copy, Debug, PartialEq)]
struct FrameTime {
    /// Processor time of the window's thread, seconds; elapsed time if the system does not report it.
    busy: f64,
    /// Time from its start until the next frame may start, seconds.
    whole: f64,
}

/// Times over many frames, milliseconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FrameCost {
    /// What happens during the frames.
    pub what: &'static str,
    /// Number of measured frames.
    pub num_frames: usize,
    /// Median processor time of the window's thread.
    pub busy_p50_ms: f64,
    /// 95th percentile of the same.
    pub busy_p95_ms: f64,
    /// Mean processor time of all threads, which includes the drawing of a software driver. `None` if the system does not
    /// report it.
    pub all_threads_mean_ms: Option<f64>,
    /// Median time from frame to frame, waiting for the device; `None` if frames do not wait.
    pub paced_p50_ms: Option<f64>,
    /// Share of the points that the view of Inspect drew in the last frame, 0..1; `None` if Inspect is not in front.
    pub detail: Option<f64>,
}

/// Costs of the frames of a window.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WindowCost {
    /// Number of points of the scene shown.
    pub num_points: usize,
    /// Size of the window, logical pixels.
    pub size: [u32; 2],
    /// One entry per kind of frame.
    pub frames: Vec<FrameCost>,
}

/// Opens the window without a display and measures `num_frames` frames of each kind: Inspect at rest, while its view is
/// rotated, and live, then every other workspace with that scene while the pointer moves over it.
pub fn window_cost(num_frames: usize, options: WindowOptions) -> Result<WindowCost, ViewError> {
    let mut window = HeadlessWindow::open(SIZE, options)?;
    window.settle();
    let shown = window.window().state().session.shown.as_ref();
    let num_points = shown.map_or(0, |shown| shown.inspected.figures.num_points);
    let mut costs = vec![frames(
        "Inspect, at rest",
        &mut window,
        num_frames,
        Pace::Ahead,
        |_| Vec::new(),
    )];

    let middle = Pos2::new(SIZE[0] as f32 * 0.4, SIZE[1] as f32 * 0.45);
    let button = |pressed| Event::PointerButton {
        pos: middle,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    for (what, pace) in [
        ("Inspect, turning", Pace::Ahead),
        ("Inspect, turning, each frame waited for", Pace::InStep),
    ] {
        window.frame(vec![Event::PointerMoved(middle), button(true)]);
        // The pointer swings back and forth.
        let hand = |i: usize| {
            let swing = (i as f32 * 0.12).sin() * 260.0;
            vec![Event::PointerMoved(middle + Vec2::new(swing, swing * 0.3))]
        };
        costs.push(frames(what, &mut window, num_frames, pace, hand));
        window.frame(vec![button(false)]);
    }
    costs.push(live(&mut window, num_frames));
    costs.extend(other_workspaces(&mut window, num_frames));
    Ok(WindowCost {
        num_points,
        size: SIZE,
        frames: costs,
    })
}

/// Measures frames that show a new result while the simulated cell is followed; those in between cost as much as at rest.
fn live(window: &mut HeadlessWindow, num_frames: usize) -> FrameCost {
    window.act(Action::Live(LiveAction::Toggle));
    let cost = measured(
        "Inspect, live",
        window,
        num_frames,
        Pace::Ahead,
        |window, _| {
            let (before, began) = (window.generation(), Instant::now());
            loop {
                let time = timed(window, Vec::new(), Pace::Ahead);
                if window.generation() != before || began.elapsed().as_secs() > 10 {
                    return time;
                }
                thread::sleep(Duration::from_millis(2));
            }
        },
    );
    window.act(Action::Live(LiveAction::Toggle));
    window.settle();
    cost
}

/// Fills a workspace before it is measured.
type Prepare = fn(&mut HeadlessWindow);

/// Measures the other workspaces with typical content: in Enrol a part to enrol, in Align an alignment.
fn other_workspaces(window: &mut HeadlessWindow, num_frames: usize) -> Vec<FrameCost> {
    let prepared: [(&str, WorkspaceKind, Prepare); 5] = [
        ("Enrol, pointer moving", WorkspaceKind::Enrol, |window| {
            window.with(|enrol: &mut EnrolWorkspace, cx| {
                enrol.state.apply(EnrolAction::TakeShown, cx);
            });
        }),
        ("Compare, pointer moving", WorkspaceKind::Compare, |_| {}),
        ("Align, pointer moving", WorkspaceKind::Align, |window| {
            window.with(|align: &mut AlignWorkspace, cx| {
                align.state.apply(AlignAction::Run, cx);
            });
        }),
        ("Paint, pointer moving", WorkspaceKind::Paint, |_| {}),
        ("History, pointer moving", WorkspaceKind::History, |_| {}),
    ];
    let over = |i: usize| {
        let across = (i as f32 * 0.07).sin() * 0.4 + 0.5;
        let down = (i as f32 * 0.11).cos() * 0.4 + 0.5;
        let at = Pos2::new(SIZE[0] as f32 * across, SIZE[1] as f32 * down);
        vec![Event::PointerMoved(at)]
    };
    let measured = prepared.into_iter().map(|(what, workspace, prepare)| {
        window.act(Action::GoTo(workspace));
        window.settle();
        prepare(window);
        window.settle();
        frames(what, window, num_frames, Pace::Ahead, over)
    });
    measured.collect()
}

/// Draws a frame and measures it.
fn timed(window: &mut HeadlessWindow, events: Vec<Event>, pace: Pace) -> FrameTime {
    let (begun, watch) = (Instant::now(), ProcessorWatch::start());
    window.draw(events);
    let busy = watch.elapsed().as_secs_f64();
    if pace == Pace::InStep {
        window.wait();
    }
    FrameTime {
        busy,
        whole: begun.elapsed().as_secs_f64(),
    }
}

fn frames(
    what: &'static str,
    window: &mut HeadlessWindow,
    num_frames: usize,
    pace: Pace,
    events: impl Fn(usize) -> Vec<Event>,
) -> FrameCost {
    measured(what, window, num_frames, pace, |window, i| {
        timed(window, events(i), pace)
    })
}

/// Like [`frames`], but each frame is drawn by `frame`.
fn measured(
    what: &'static str,
    window: &mut HeadlessWindow,
    num_frames: usize,
    pace: Pace,
    frame: impl Fn(&mut HeadlessWindow, usize) -> FrameTime,
) -> FrameCost {
    /// Number of unmeasured first frames, in which caches fill and the view adapts to the speed of the device.
    const NUM_FIRST: usize = 12;
    let mut draw = |i| {
        let time = frame(window, i);
        // Not measured: keeps the queue of a slow device from filling the memory.
        window.wait();
        time
    };
    for i in 1..=NUM_FIRST {
        draw(i);
    }
    let before = process_seconds();
    let times: Vec<FrameTime> = (1..=num_frames).map(|i| draw(i + NUM_FIRST)).collect();
    let spent = process_seconds().zip(before).map(|(now, then)| now - then);
    let busy = |share| quantile(times.iter().map(|t| t.busy * 1e3), share).unwrap_or(0.0);
    let whole = quantile(times.iter().map(|t| t.whole * 1e3), 0.5);
    FrameCost {
        what,
        num_frames: times.len(),
        busy_p50_ms: busy(0.5),
        busy_p95_ms: busy(0.95),
        all_threads_mean_ms: spent.map(|s| s * 1e3 / num_frames.max(1) as f64),
        paced_p50_ms: whole.filter(|_| pace == Pace::InStep),
        detail: (window.window().state().session.workspace == WorkspaceKind::Inspect)
            .then(|| f64::from(window.window().detail_of_view())),
    }
}
