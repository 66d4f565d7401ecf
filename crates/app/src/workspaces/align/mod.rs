//! Align, for the engineer: every method on the same two clouds, side by side, and Table I.
//!
//! ```text
//! choosing  what is aligned to what, from where       start, pair
//! views     one 3-D view a method, one camera         track: the poses of a method and E at each
//! scrubber  E per iteration, and the iteration shown   plot, playback
//! side      Table I, the true error                   table
//! ```

mod choosing;
mod pair;
mod playback;
mod plot;
mod scrubber;
mod side;
mod start;
mod state;
mod table;
mod track;
mod views;
mod work;

use egui::{Key, Margin, Modifiers, Panel, Rect, Ui};

pub use self::{
    pair::{Pair, PairSource},
    playback::MethodComparison,
    start::{CustomStart, Start},
    state::{AlignAction, AlignFile, AlignResult, AlignState, Pairing},
    table::{TableCell, TableFigures, TableRow, TableShown},
    track::{MethodRun, Track},
};
use self::{side::SidePanel, views::LinkedViews};
use shell::{
    session::{Session, WorkspaceKind},
    workspace::{ShellContext, Workspace},
};
pub use ui::scrubber::Playback;
use ui::{
    key_binding::{KeyBinding, Shortcut},
    language::text,
    task::{Running, TaskRunner},
    viewport::{ViewError, ViewportGpu},
    widgets::{by_height, fixed_panel, side_panel},
};

/// Width of the panel on the right in a wide and in a narrow window, logical pixels.
const SIDE: [f32; 2] = [340.0, 300.0];
/// Height of the plot in a high and in a low window, logical pixels.
const PLOT: [f32; 2] = [236.0, 200.0];

/// The shortcuts of this workspace.
#[rustfmt::skip]
const SHORTCUTS: [Shortcut<AlignAction>; 4] = [
    Shortcut::new(Modifiers::NONE, Key::R, || text!("align-key-run"), || AlignAction::Run),
    Shortcut::new(Modifiers::NONE, Key::P, || text!("align-key-play"), || AlignAction::TogglePlay).keys_as(|| text!("align-keys-play")),
    Shortcut::new(Modifiers::NONE, Key::Comma, || text!("align-key-back"), || AlignAction::Step(-1.0)).keys_as(|| text!("align-keys-back")),
    Shortcut::new(Modifiers::NONE, Key::Period, || text!("align-key-on"), || AlignAction::Step(1.0)).keys_as(|| text!("align-keys-on")),
];

/// The workspace.
pub struct AlignWorkspace {
    /// The state of the workspace.
    pub state: AlignState,
    views: LinkedViews,
    side: SidePanel,
}

impl AlignWorkspace {
    /// Creates the workspace without a result.
    pub fn new(gpu: &Result<ViewportGpu, ViewError>, runner: &TaskRunner) -> Self {
        Self {
            state: AlignState::new(runner),
            views: LinkedViews::new(gpu),
            side: SidePanel::default(),
        }
    }
}

impl Workspace for AlignWorkspace {
    fn kind(&self) -> WorkspaceKind {
        WorkspaceKind::Align
    }

    fn ui(&mut self, ui: &mut Ui, cx: &mut ShellContext<'_>) -> Rect {
        let Self { state, views, side } = self;
        let session = cx.session;
        let mut actions = Vec::new();
        let height = ui.available_height();
        side_panel(ui, "table one", SIDE, Margin::symmetric(18, 14), |ui| {
            side.ui(ui, state, session, &mut actions);
        });
        let top = Panel::top("alignment").exact_size(choosing::height(state) + 16.0);
        let look = fixed_panel(ui, top, Margin::symmetric(12, 8), |ui| {
            choosing::ui(ui, state, session, &mut actions)
        });
        if let Some(look) = look {
            views.look(look);
        }
        let bottom = Panel::bottom("iterations").exact_size(by_height(height, PLOT));
        fixed_panel(ui, bottom, Margin::symmetric(14, 8), |ui| {
            scrubber::ui(ui, state, &mut actions);
        });
        let room = ui.available_rect_before_wrap();
        views.ui(ui, state, session);
        for action in actions {
            state.apply(action, cx);
        }
        room
    }

    fn update(&mut self, cx: &mut ShellContext<'_>) {
        self.state.update(cx);
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

    fn has_key_focus(&self) -> bool {
        self.views.has_focus()
    }

    fn is_idle(&self, _session: &Session) -> bool {
        self.running().is_none() && !self.state.is_writing()
    }
}
