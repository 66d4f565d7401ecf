//! Paint, the engineer's: a spray path over an enrolled part, the film that it leaves, and the gun along it.
//!
//! ```text
//! side      part and results, the tabs: the coat with every parameter of its table, the figures of the film
//! tools     undo, view; pattern, regions
//! view      the part by its film, rows, the gun   region: what is drawn becomes a region
//! timeline  the path over time
//! state     what is shown, asked for and stored   work: plan, simulate, store; when the gun is where
//! robot     the tab: arm and gun of its programs  reach: which points the arm reaches, and the program
//! design    what is painted how, and its undo     its coat: chosen, changed, saved
//! ```

mod design;
mod reach;
mod region;
mod robot;
mod side;
mod state;
mod timeline;
mod tools;
mod view;
mod work;

use std::path::PathBuf;

use egui::{CentralPanel, Frame, Key, Margin, Modifiers, Panel, Rect, Ui};

use self::view::PaintView;
pub use self::{
    design::Design,
    reach::Reach,
    region::{EditKind, PaintTool, RegionUse},
    state::{PaintAction, PaintFile, PaintState, ShownPath},
    work::{GunCourse, GunState, Planned},
};
use shell::{
    action::Event,
    session::{Session, WorkspaceKind},
    workspace::{ShellContext, Workspace},
};
pub use ui::scrubber::Playback;
use ui::{
    key_binding::{CTRL_SHIFT, KeyBinding, Shortcut},
    language::text,
    task::{Running, TaskRunner},
    theme::{Theme, space},
    viewport::{DrawnShape, ViewError, ViewportGpu},
    widgets::{fixed_panel, side_panel},
};

/// Width of the panel on the right in a wide and in a narrow window, logical pixels.
const SIDE: [f32; 2] = [340.0, 300.0];
/// Height of the timeline, logical pixels.
const TIMELINE: f32 = 2.0 * space::TARGET + 46.0;

/// The shortcuts of this workspace. Those with more modifiers come first, as the others would match them too.
#[rustfmt::skip]
const SHORTCUTS: [Shortcut<PaintAction>; 8] = [
    Shortcut::new(CTRL_SHIFT, Key::Z, || text!("shell-redo"), || PaintAction::Redo),
    Shortcut::new(Modifiers::COMMAND, Key::Z, || text!("shell-undo"), || PaintAction::Undo),
    Shortcut::new(Modifiers::COMMAND, Key::S, || text!("paint-store"), || PaintAction::Store),
    Shortcut::new(Modifiers::NONE, Key::P, || text!("paint-key-play"), || PaintAction::TogglePlay),
    Shortcut::new(Modifiers::NONE, Key::Comma, || text!("paint-key-back"), || PaintAction::Step(-1)),
    Shortcut::new(Modifiers::NONE, Key::Period, || text!("paint-key-on"), || PaintAction::Step(1)),
    Shortcut::new(Modifiers::NONE, Key::D, || text!("paint-keep-out-lasso"), || PaintAction::Use(PaintTool::Outline(DrawnShape::Lasso, RegionUse::KeepOut))),
    Shortcut::new(Modifiers::NONE, Key::R, || text!("view-rotate"), || PaintAction::Use(PaintTool::Look)),
];

/// The workspace.
pub struct PaintWorkspace {
    /// The state of the workspace.
    pub state: PaintState,
    view: PaintView,
    is_front: bool,
}

impl PaintWorkspace {
    /// Creates the workspace without a chosen part; `coats` is the folder of the user's coats.
    pub fn new(
        gpu: &Result<ViewportGpu, ViewError>,
        coats: Option<PathBuf>,
        runner: &TaskRunner,
    ) -> Self {
        Self {
            state: PaintState::new(coats, runner),
            view: PaintView::new(gpu),
            is_front: false,
        }
    }
}

impl Workspace for PaintWorkspace {
    fn kind(&self) -> WorkspaceKind {
        WorkspaceKind::Paint
    }

    fn ui(&mut self, ui: &mut Ui, cx: &mut ShellContext<'_>) -> Rect {
        let Self { state, view, .. } = self;
        let (session, theme) = (cx.session, Theme::of(ui));
        let mut actions = Vec::new();
        side_panel(ui, "paint side", SIDE, Margin::ZERO, |ui| {
            side::ui(ui, state, session, &mut actions);
        });
        let top = Panel::top("paint tools");
        fixed_panel(ui, top, Margin::symmetric(12, 8), |ui| {
            tools::ui(ui, state, &mut actions);
        });
        let bottom = Panel::bottom("paint timeline").exact_size(TIMELINE);
        fixed_panel(ui, bottom, Margin::symmetric(14, 8), |ui| {
            timeline::ui(ui, state, &mut actions);
        });
        let room = ui.available_rect_before_wrap();
        CentralPanel::default()
            .frame(Frame::new().fill(theme.canvas))
            .show(ui, |ui| view.ui(ui, state, session, &mut actions));
        for action in actions {
            state.apply(action, cx);
        }
        room
    }

    fn update(&mut self, cx: &mut ShellContext<'_>) {
        let is_front = cx.session.workspace == WorkspaceKind::Paint;
        if is_front && !self.is_front {
            self.state.list_coats(cx);
        }
        self.is_front = is_front;
        self.state.update(cx);
    }

    fn on_event(&mut self, event: &Event, cx: &mut ShellContext<'_>) {
        self.state.on_event(event, cx);
    }

    fn key_bindings(&self) -> Vec<KeyBinding> {
        SHORTCUTS.iter().map(|shortcut| shortcut.binding).collect()
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
        self.state.cancel();
    }

    fn writing(&self) -> Option<&Running> {
        self.state.writing()
    }

    fn unsaved(&self) -> Option<String> {
        self.state.unsaved()
    }

    fn has_key_focus(&self) -> bool {
        self.view.has_focus
    }

    fn is_idle(&self, session: &Session) -> bool {
        self.state.is_idle(session)
    }
}
