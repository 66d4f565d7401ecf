//! Align, the engineer's: every method on the same two clouds, side by side, and Table I.
//!
//! ```text
//! choosing  what is aligned to what, from where       start, custom, pair
//! views     one 3-D view a method, one camera         track: the poses of a method and E at each
//! scrubber  E per iteration, and the iteration shown   plot, playback
//! side      Table I, the true error                   table
//! ```

mod choosing;
mod custom;
mod pair;
mod playback;
mod plot;
mod scrubber;
mod series;
mod side;
mod start;
mod state;
mod table;
mod track;
mod views;
mod work;

use egui::{Frame, Key, Margin, Modifiers, Panel, Ui};

pub(super) use self::work::answer;
pub use self::{
    custom::{CustomStart, Form},
    pair::{Pair, PairSource},
    playback::{Comparison, Playback},
    start::Start,
    state::{AlignAction, AlignAsk, AlignState, Pairing, apply, hear},
    table::{TableCell, TableFigures, TableRow, TableShown},
    track::{MethodRun, Track},
    work::{AlignAnswer, AlignRequest},
};
use self::{side::SidePanel, views::LinkedViews};
use super::{
    action::Action,
    keys::Shortcut,
    state::State,
    theme::Theme,
    viewport::{ViewError, ViewportGpu},
};

/// Width of the panel on the right, logical pixels, and in a narrow window.
const SIDE: [f32; 2] = [340.0, 300.0];
/// Height of the plot, logical pixels, and in a low window.
const PLOT: [f32; 2] = [236.0, 200.0];

/// The shortcuts of this workspace.
pub(in crate::app) const SHORTCUTS: [Shortcut; 4] = [
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::R,
        keys: "R",
        does: "Run every method",
        action: || Action::Align(AlignAction::Run),
    },
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::P,
        keys: "P, or Space on the plot",
        does: "Play or pause the iterations",
        action: || Action::Align(AlignAction::TogglePlay),
    },
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::Comma,
        keys: ", or \u{2190} on the plot",
        does: "One iteration back",
        action: || Action::Align(AlignAction::Step(-1.0)),
    },
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::Period,
        keys: ". or \u{2192} on the plot",
        does: "One iteration on",
        action: || Action::Align(AlignAction::Step(1.0)),
    },
];

/// What the workspace keeps between frames.
pub(super) struct AlignPanel {
    views: LinkedViews,
    side: SidePanel,
}

impl AlignPanel {
    pub(super) fn new(gpu: &Result<ViewportGpu, ViewError>) -> Self {
        Self {
            views: LinkedViews::new(gpu),
            side: SidePanel::default(),
        }
    }

    /// True while keys go to a 3-D view.
    pub(super) fn view_has_focus(&self) -> bool {
        self.views.has_focus()
    }

    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        state: &State,
        theme: &Theme,
        actions: &mut Vec<Action>,
    ) {
        let size = ui.available_size();
        let panel = |margin| Frame::new().fill(theme.panel).inner_margin(margin);
        Panel::right("table one")
            .exact_size(if size.x > 1100.0 { SIDE[0] } else { SIDE[1] })
            .resizable(false)
            .frame(panel(Margin::symmetric(18, 14)))
            .show(ui, |ui| self.side.ui(ui, state, theme, actions));
        let look = Panel::top("alignment")
            .exact_size(choosing::height(state) + 16.0)
            .resizable(false)
            .frame(panel(Margin::symmetric(12, 8)))
            .show(ui, |ui| choosing::ui(ui, state, theme, actions));
        if let Some(look) = look.inner {
            self.views.look(look);
        }
        Panel::bottom("iterations")
            .exact_size(if size.y > 760.0 { PLOT[0] } else { PLOT[1] })
            .resizable(false)
            .frame(panel(Margin::symmetric(14, 8)))
            .show(ui, |ui| scrubber::ui(ui, state, theme, actions));
        self.views.ui(ui, state, theme);
    }
}
