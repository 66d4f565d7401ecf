//! Helpers that open a window, operate it and read it.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
    thread,
    time::{Duration, Instant},
};

use app::{
    Window, WindowOptions,
    workspaces::{
        enrol::{EnrolState, EnrolWorkspace},
        history::{HistoryState, HistoryWorkspace},
        inspect::{InspectAction, InspectFile, InspectState, InspectWorkspace},
    },
};
use egui::{Vec2, ViewportId};
use egui_kittest::{Harness, kittest::Queryable as _};
use shell::{
    action::{Action, DialogRequest},
    inspection::library_cache::LibraryCache,
    source::live::SourceState,
    state::State,
    workspace::{ShellContext, Workspace},
};

/// A window without a screen.
pub(crate) type WindowHarness = Harness<'static, Window>;

/// The usual size of a window, that of the design sketches.
pub(crate) const USUAL: Vec2 = Vec2::new(1440.0, 900.0);
/// The smallest supported screen: nothing may be cut off.
pub(crate) const SMALL: Vec2 = Vec2::new(1024.0, 768.0);

/// Opens a window and waits for its first result.
pub(crate) fn open_with(size: Vec2, options: WindowOptions) -> WindowHarness {
    let mut harness = Harness::builder().with_size(size).build_eframe(|cc| {
        Window::new(&cc.egui_ctx, cc.wgpu_render_state.as_ref(), options).expect("threads")
    });
    settle(&mut harness);
    harness
}

/// Options for a window with the shipped parts, which are loaded once for all, without the user's library and settings.
pub(crate) fn plain_options() -> WindowOptions {
    WindowOptions {
        library: Some(::inspection::fixtures::SHIPPED_PARTS.into()),
        former_library: Some(LibraryCache::default().get()),
        ..WindowOptions::default()
    }
}

/// Opens a window as at the first start.
pub(crate) fn open() -> WindowHarness {
    open_with(USUAL, plain_options())
}

/// Draws until no task is running.
pub(crate) fn settle(harness: &mut WindowHarness) {
    wait_for(harness, Window::is_idle);
    let_pass(harness, 8);
    // Time may have brought about more work.
    if !harness.state().is_idle() {
        wait_for(harness, Window::is_idle);
    }
    // Check everywhere that every control has a name.
    harness.check_accessibility();
}

/// Advances the clock by this many steps. Draws the frames that the window asks for, as a screen would, and the last one.
pub(crate) fn let_pass(harness: &mut WindowHarness, num_steps: u32) {
    // One frame for each event that waits.
    harness.step();
    let step = f64::from(harness.input().predicted_dt);
    let end = now(harness) + step * f64::from(num_steps - 1);
    let is_far = |harness: &WindowHarness| now(harness) + 2.5 * step < end;
    while is_far(harness) && asks_for_frame(harness) {
        harness.step();
    }
    if is_far(harness) {
        // What was to be drawn later is due now, with what follows from it.
        harness.input_mut().time = Some(end - step);
        harness.step();
        for _ in 0..6 {
            if asks_for_frame(harness) {
                harness.input_mut().time = Some(now(harness) + 1e-3);
                harness.step();
            }
        }
        harness.input_mut().time = None;
    }
    while now(harness) + 0.5 * step < end {
        harness.step();
    }
}

/// The window's clock, seconds.
fn now(harness: &WindowHarness) -> f64 {
    harness.ctx.input(|input| input.time)
}

/// True if the window wants to draw another frame at once.
fn asks_for_frame(harness: &WindowHarness) -> bool {
    let viewport = harness.output().viewport_output.get(&ViewportId::ROOT);
    viewport.is_some_and(|viewport| viewport.repaint_delay.is_zero())
}

/// Draws until the state meets the condition.
pub(crate) fn wait_until(harness: &mut WindowHarness, is_so: impl Fn(&State) -> bool) {
    wait_for(harness, |window| is_so(window.state()));
}

/// Draws until the window meets the condition.
///
/// The window's clock advances normally for animations, then hardly at all: the time that the work takes must not
/// decide which notices are still shown. The longer the work takes, the rarer the frames are, which take processor time
/// from it.
pub(crate) fn wait_for(harness: &mut WindowHarness, is_so: impl Fn(&Window) -> bool) {
    let until = Instant::now() + Duration::from_mins(3);
    let moving = (0..20).map(|_| 0.1);
    let mut ticks = moving.chain(std::iter::repeat(1e-3));
    let mut pauses_ms = [5, 10, 20, 30].into_iter().chain(std::iter::repeat(40));
    harness.step();
    while !is_so(harness.state()) {
        assert!(Instant::now() < until, "still working after three minutes");
        thread::sleep(Duration::from_millis(pauses_ms.next().unwrap_or_default()));
        let time = now(harness) + ticks.next().unwrap_or_default();
        harness.input_mut().time = Some(time);
        harness.step();
    }
    harness.input_mut().time = None;
}

/// Scrolls the control of this label into view, presses it, and waits for the result.
pub(crate) fn press(harness: &mut WindowHarness, label: &str) {
    harness.get_by_label(label).scroll_to_me();
    let_pass(harness, 12);
    harness.get_by_label(label).click();
    settle(harness);
}

/// Performs an action of the user, and waits for the result.
pub(crate) fn act(harness: &mut WindowHarness, action: Action) {
    let context = harness.ctx.clone();
    harness.state_mut().act(action, &context);
    settle(harness);
}

/// Follows a folder, and waits until it is watched. From then on, nothing settles.
pub(crate) fn watch_folder(harness: &mut WindowHarness, folder: &Path) {
    let context = harness.ctx.clone();
    let watched = Action::Chosen(DialogRequest::WatchedFolder, folder.to_owned());
    harness.state_mut().act(watched, &context);
    wait_until(harness, |state| {
        let status = state.session.live.status.as_ref();
        status.is_some_and(|status| status.source == SourceState::Running)
    });
}

/// Runs a closure on the workspace of this type, and waits for the result.
pub(crate) fn act_in<W: Workspace>(
    harness: &mut WindowHarness,
    act: impl FnOnce(&mut W, &mut ShellContext<'_>),
) {
    let context = harness.ctx.clone();
    let done = harness.state_mut().with(&context, act);
    done.expect("the window has this workspace");
    settle(harness);
}

/// State of the History workspace.
pub(crate) fn history_of(harness: &WindowHarness) -> &HistoryState {
    let workspace = harness.state().workspace::<HistoryWorkspace>();
    &workspace.expect("the workspace").state
}

/// State of the Inspect workspace.
pub(crate) fn inspect_of(harness: &WindowHarness) -> &InspectState {
    let workspace = harness.state().workspace::<InspectWorkspace>();
    &workspace.expect("the workspace").state
}

/// Chooses a file in Inspect, as the user does in a file dialog.
pub(crate) fn choose_in_inspect(harness: &mut WindowHarness, file: InspectFile, path: PathBuf) {
    let chosen = InspectAction::Chosen(file, path);
    act_in(harness, |inspect: &mut InspectWorkspace, cx| {
        inspect.state.apply(chosen, cx);
    });
}

/// State of the Enrol workspace.
pub(crate) fn enrol_of(harness: &WindowHarness) -> &EnrolState {
    let workspace = harness.state().workspace::<EnrolWorkspace>();
    &workspace.expect("the workspace").state
}

#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        Err("the window opens files itself".into())
    }
}

/// True if either view calls the part recognised, whether or not a robot may act on it.
pub(crate) fn is_recognised(harness: &WindowHarness) -> bool {
    let words = ["OK", "Accepted", "Recognised"];
    words
        .iter()
        .any(|word| harness.query_by_label(word).is_some())
}

/// Drops a file onto the window.
pub(crate) fn drop_file(harness: &mut WindowHarness, path: &Path) {
    let dropped = Arc::new(Dropped(path.to_owned()));
    harness.input_mut().dropped_files.push(dropped);
    settle(harness);
}
