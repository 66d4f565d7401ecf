//! Servo, the engineer's: moves a robot until the part stands where it should in front of the camera.
//!
//! ```text
//! side   start and stop, the state in a sentence, figures   setup: part, target, robot, limits
//! view   part, camera and target in space
//! state  what is shown, asked for and running                work: the run, on a thread of its own
//! ```
//!
//! While a robot is servoed, the space bar and Esc stop it before any control gets them.

mod setup;
mod side;
mod state;
mod view;
mod work;

use egui::{CentralPanel, Event as InputEvent, Frame, Key, Margin, Modifiers, Panel, Rect, Ui};

use self::view::RunSceneView;
pub use self::{
    state::{ServoAction, ServoFile, ServoPageState},
    work::RunView,
};
use crate::shared::servo_curve;
use shell::{
    session::{Session, WorkspaceKind},
    workspace::{ShellContext, Workspace},
};
use ui::{
    key_binding::{KeyBinding, Shortcut},
    language::text,
    task::{Running, TaskRunner},
    theme::Theme,
    viewport::{ViewError, ViewportGpu},
    widgets::{by_height, fixed_panel, side_panel},
};

/// Width of the panel on the right in a wide and in a narrow window, logical pixels.
const SIDE: [f32; 2] = [340.0, 300.0];
/// Height of the curve in a high and in a low window, logical pixels.
const CURVE: [f32; 2] = [220.0, 170.0];

/// The shortcuts of this workspace while a robot is servoed. The first two are seen before any control gets them.
#[rustfmt::skip]
const SHORTCUTS: [Shortcut<ServoAction>; 3] = [
    Shortcut::new(Modifiers::NONE, Key::Space, || text!("servoing-key-stop"), || ServoAction::Stop),
    Shortcut::new(Modifiers::NONE, Key::Escape, || text!("servoing-key-stop"), || ServoAction::Stop),
    Shortcut::new(Modifiers::NONE, Key::N, || text!("servoing-key-next"), || ServoAction::Next),
];

/// The workspace.
pub struct ServoWorkspace {
    /// The state of the workspace.
    pub state: ServoPageState,
    view: RunSceneView,
}

impl ServoWorkspace {
    /// Creates the workspace without a run.
    pub fn new(gpu: &Result<ViewportGpu, ViewError>, runner: &TaskRunner) -> Self {
        Self {
            state: ServoPageState::new(runner),
            view: RunSceneView::new(gpu),
        }
    }
}

impl Workspace for ServoWorkspace {
    fn kind(&self) -> WorkspaceKind {
        WorkspaceKind::Servo
    }

    fn ui(&mut self, ui: &mut Ui, cx: &mut ShellContext<'_>) -> Rect {
        let Self { state, view } = self;
        let (session, theme) = (cx.session, Theme::of(ui));
        let mut actions = Vec::new();
        if state.is_running() && takes_stop_key(ui) {
            actions.push(ServoAction::Stop);
        }
        let height = ui.available_height();
        side_panel(ui, "servo side", SIDE, Margin::ZERO, |ui| {
            side::ui(ui, state, session, &mut actions);
        });
        let curve_height = by_height(height, CURVE);
        let bottom = Panel::bottom("servo curve").exact_size(curve_height + 16.0);
        fixed_panel(ui, bottom, Margin::symmetric(8, 8), |ui| {
            let tolerance = state.tolerance(session);
            servo_curve(ui, state.curve(), tolerance, curve_height);
        });
        let room = ui.available_rect_before_wrap();
        CentralPanel::default()
            .frame(Frame::new().fill(theme.canvas))
            .show(ui, |ui| view.ui(ui, state, session));
        for action in actions {
            state.apply(action, cx);
        }
        room
    }

    fn update(&mut self, cx: &mut ShellContext<'_>) {
        self.state.update(cx);
    }

    fn close(&mut self) {
        // Dropping the task waits until the robot stands, and its run is in the history.
        self.state.stop();
    }

    fn key_bindings(&self) -> Vec<KeyBinding> {
        let bindings = SHORTCUTS.iter().map(|shortcut| shortcut.binding);
        let is_running = self.state.is_running();
        bindings.filter(|_| is_running).collect()
    }

    fn press(&mut self, index: usize, cx: &mut ShellContext<'_>) {
        if let Some(shortcut) = SHORTCUTS.get(index) {
            self.state.apply((shortcut.action)(), cx);
        }
    }

    fn running(&self) -> Option<&Running> {
        self.state.running()
    }

    fn cancel(&mut self) {
        self.state.stop();
    }

    fn has_key_focus(&self) -> bool {
        self.view.has_focus
    }

    fn is_idle(&self, _session: &Session) -> bool {
        !self.state.is_running()
    }
}

/// Takes the keys that stop the robot, whatever control has the focus.
fn takes_stop_key(ui: &Ui) -> bool {
    ui.input_mut(|input| {
        let num = input.events.len();
        input.events.retain(|event| {
            !matches!(
                event,
                InputEvent::Key {
                    key: Key::Space | Key::Escape,
                    pressed: true,
                    ..
                }
            )
        });
        input.events.len() < num
    })
}
