//! Inspect, the operator's workspace: the view, the verdict and the stages.

mod card;
mod controls;
mod plots;
mod ranking;
mod robot_numbers;
pub(super) mod scan;
pub mod scene;
mod stand_off;
pub mod state;
mod strip;
mod view;
pub mod work;

use std::sync::Arc;

use egui::{Align2, Frame, Key, Margin, Modifiers, Panel, TextureHandle, Ui};

pub(super) use self::{
    robot_numbers::{clipboard_text, numbered},
    view::grouped,
};
use self::{
    state::{InspectAction, ViewPart},
    view::SceneView,
    work::Inspected,
};
pub(super) use super::widgets::texture;
use super::{
    action::{Action, DialogRequest},
    headless::WorkCounts,
    keys::Shortcut,
    shots::{FusedShots, ShotList, ShotsAction, ShownShots, StripTab},
    state::{Shown, State},
    theme::{Theme, font, space},
    viewport::{ViewError, ViewportGpu},
};

/// Width of the verdict card, logical pixels, and in a narrow window.
const CARD: [f32; 2] = [340.0, 300.0];
/// Height of the stage strip, logical pixels, and in a low window.
const STRIP: [f32; 2] = [196.0, 164.0];

/// The workspace's own shortcuts.
pub(in crate::app) const SHORTCUTS: [Shortcut; 7] = [
    Shortcut {
        modifiers: Modifiers::COMMAND.plus(Modifiers::SHIFT),
        key: Key::Z,
        keys: "Ctrl Shift Z",
        does: "Do again what was undone last with the shots",
        action: || Action::Shots(ShotsAction::Redo),
    },
    Shortcut {
        modifiers: Modifiers::COMMAND,
        key: Key::Z,
        keys: "Ctrl Z",
        does: "Undo the last change of the shots of a scan",
        action: || Action::Shots(ShotsAction::Undo),
    },
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::P,
        keys: "P",
        does: "Save a picture of the 3-D view",
        action: || Action::Ask(DialogRequest::Picture),
    },
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::C,
        keys: "C",
        does: "Show or hide the enrolled contour",
        action: || Action::Inspect(InspectAction::Toggle(ViewPart::Outline)),
    },
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::N,
        keys: "N",
        does: "Show or hide the nozzle at the worst spot",
        action: || Action::Inspect(InspectAction::Toggle(ViewPart::NozzleWorst)),
    },
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::K,
        keys: "K",
        does: "The pose in the next robot's numbers",
        action: || Action::NextConvention,
    },
    Shortcut {
        modifiers: Modifiers::COMMAND.plus(Modifiers::SHIFT),
        key: Key::C,
        keys: "Ctrl Shift C",
        does: "Copy the pose in those numbers",
        action: || Action::CopyPose,
    },
];

/// What the workspace keeps between frames: nothing but what was made of the last result.
pub(super) struct InspectPanel {
    view: SceneView,
    shots: ShotList,
    made: Option<TextureSet>,
    num_made: u64,
}

/// Textures of one result.
struct TextureSet {
    generation: u64,
    segmentation: Option<TextureHandle>,
    binary: Option<TextureHandle>,
}

impl InspectPanel {
    pub(super) fn new(gpu: Result<ViewportGpu, ViewError>) -> Self {
        Self {
            view: SceneView::new(gpu),
            shots: ShotList::default(),
            made: None,
            num_made: 0,
        }
    }

    /// True while keys go to the 3-D view.
    pub(super) fn view_has_focus(&self) -> bool {
        self.view.has_focus()
    }

    /// What its frames have done so far.
    pub(super) fn counts(&self) -> WorkCounts {
        let mut counts = self.view.counts();
        counts.made += self.num_made;
        counts
    }

    /// Share of the points that the view drew last, 0..1.
    pub(super) fn detail(&self) -> f32 {
        self.view.viewport.detail()
    }

    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        state: &State,
        theme: &Theme,
        actions: &mut Vec<Action>,
    ) {
        let Some(shown) = &state.shown else {
            ui.painter().rect_filled(ui.max_rect(), 0.0, theme.canvas);
            empty(ui, state, theme);
            return;
        };
        self.make(ui.ctx(), shown);
        let inspected: &Inspected = &shown.inspected;
        let size = ui.available_size();
        let panel = |margin| Frame::new().fill(theme.panel).inner_margin(margin);

        Panel::right("verdict")
            .exact_size(if size.x > 1100.0 { CARD[0] } else { CARD[1] })
            .resizable(false)
            .frame(panel(Margin::symmetric(18, 14)))
            .show(ui, |ui| card::ui(ui, inspected, state, theme, actions));
        Panel::bottom("stages")
            .exact_size(strip_height(state, size.y))
            .resizable(false)
            .frame(panel(Margin::ZERO))
            .show(ui, |ui| {
                if let Some(scan) = &inspected.scan
                    && self.shots_ui(ui, state, &scan.fused, theme, actions)
                {
                    return;
                }
                let pictures = self.pictures(inspected, state, theme);
                strip::ui(ui, &pictures, actions);
            });
        if state.enlarged.is_some() {
            let rest = ui.available_rect_before_wrap();
            ui.painter().rect_filled(rest, 0.0, theme.canvas);
            let pictures = self.pictures(inspected, state, theme);
            strip::enlarged_ui(ui, &pictures, actions);
        } else {
            self.view.ui(ui, state, inspected, actions);
        }
        self.view.picture(ui, state, actions);
    }

    /// The strip of a scan: the row above it, and the list unless the stages are to be shown.
    fn shots_ui(
        &mut self,
        ui: &mut Ui,
        state: &State,
        fused: &Arc<FusedShots>,
        theme: &Theme,
        actions: &mut Vec<Action>,
    ) -> bool {
        let scan = ShownShots {
            fused,
            choice: state.shot_choice().unwrap_or(&fused.choice),
            shots: &state.inspect.shots,
            session: &state.session,
            theme,
        };
        let mut caused = Vec::new();
        let margin = Frame::new().inner_margin(Margin::symmetric(12, 6));
        let shown = margin.show(ui, |ui| {
            let is_list = ShotList::tabs(ui, scan, "Stages", &mut caused);
            if is_list {
                if state.is_old() {
                    ui.multiply_opacity(0.75);
                }
                self.shots.ui(ui, scan, &mut caused);
            }
            is_list
        });
        actions.extend(caused.into_iter().map(Action::Shots));
        shown.inner
    }

    fn pictures<'a>(
        &'a self,
        inspected: &'a Inspected,
        state: &'a State,
        theme: &'a Theme,
    ) -> plots::Pictures<'a> {
        let made = self.made.as_ref();
        plots::Pictures {
            inspected,
            state,
            theme,
            segmentation: made.and_then(|made| made.segmentation.as_ref()),
            binary: made.and_then(|made| made.binary.as_ref()),
        }
    }

    /// Uploads what a new result shows, once.
    fn make(&mut self, ctx: &egui::Context, shown: &Shown) {
        if self
            .made
            .as_ref()
            .is_some_and(|made| made.generation == shown.generation)
        {
            return;
        }
        self.num_made += 1;
        let figures = &shown.inspected.figures;
        self.made = Some(TextureSet {
            generation: shown.generation,
            segmentation: texture(ctx, "segmentation", figures.segmentation.as_ref()),
            binary: texture(ctx, "binary image", figures.binary.as_ref()),
        });
        self.view.show(shown);
    }
}

fn strip_height(state: &State, height: f32) -> f32 {
    let usual = if height > 760.0 { STRIP[0] } else { STRIP[1] };
    let is_scan = state
        .shown
        .as_ref()
        .is_some_and(|shown| shown.inspected.scan.is_some());
    match state.inspect.shots.strip {
        StripTab::Shots if is_scan => ShotList::HEIGHT,
        StripTab::Usual if is_scan => usual + space::TARGET + 12.0,
        _ => usual,
    }
}

/// Before the first result.
fn empty(ui: &Ui, state: &State, theme: &Theme) {
    let text = match state.inspector.running() {
        Some(running) => format!("{}…", running.title),
        None => "Nothing inspected yet\nPress Capture for a frame of the simulated cell, or drop a captured scene here"
            .into(),
    };
    let rect = ui.max_rect();
    let galley = ui.painter().layout(
        text.clone(),
        font::verdict(),
        theme.weak_text,
        rect.width() * 0.8,
    );
    let at = Align2::CENTER_CENTER
        .align_size_within_rect(galley.size(), rect)
        .min;
    ui.painter().galley(at, galley, theme.weak_text);
    let response = ui.interact(rect, ui.scope_id().with("empty"), egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &text));
}
