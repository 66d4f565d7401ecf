//! Compare, the process engineer's workspace: why was a part taken for another?
//!
//! The case in front is the scene that was inspected last, or a kept case. It is inspected with the recipe on trial and
//! compared with one enrolled part. All kept cases can be run; a cell of their confusion matrix lists its cases.

mod action;
mod case_bar;
pub mod comparison;
mod distances;
mod kept_cases;
mod kept_recipes;
pub mod matrix;
mod pictures;
mod recipe_menu;
mod recipe_panel;
mod recipes;
pub mod scaling;
mod scaling_plot;
mod schedule;
mod score_plots;
mod state;
pub mod study;
mod work;

use std::path::PathBuf;

use egui::{Key, Margin, Modifiers, Panel, Rect, Ui, UiBuilder, pos2, vec2};

pub use self::{
    action::{CompareAction, CompareFile, RecipeAction},
    kept_recipes::{KeptRecipes, Naming, NamingPurpose},
    state::{Cases, CompareState, Front, Undo},
    work::{CaseDone, CaseEdit, CaseRun, CompareResult, RunChanges},
};
use shell::{
    session::{Session, WorkspaceKind},
    workspace::{ShellContext, Workspace},
};
use ui::{
    key_binding::{CTRL_SHIFT, KeyBinding, Shortcut},
    language::text,
    task::{Running, TaskRunner},
    theme::{Theme, space},
    widgets::{fixed_panel, side_panel},
};

/// The shortcuts of the workspace. The one with more modifiers comes first, as the other would match it too.
#[rustfmt::skip]
const SHORTCUTS: [Shortcut<CompareAction>; 4] = [
    Shortcut::new(CTRL_SHIFT, Key::Z, || text!("shell-redo"), || CompareAction::Redo),
    Shortcut::new(Modifiers::NONE, Key::K, || text!("compare-key-keep"), || CompareAction::Keep),
    Shortcut::new(Modifiers::COMMAND, Key::R, || text!("compare-key-run"), || CompareAction::RunAll),
    Shortcut::new(Modifiers::COMMAND, Key::Z, || text!("compare-key-undo"), || CompareAction::Undo),
];

/// Width of the recipe in a wide and in a narrow window, logical pixels.
const RECIPE: [f32; 2] = [310.0, 284.0];

/// The workspace.
pub struct CompareWorkspace {
    /// The state of the workspace.
    pub state: CompareState,
}

impl CompareWorkspace {
    /// `folder` holds the cases, by default the user's own; without `recipes` no recipe can be saved.
    pub fn new(folder: Option<PathBuf>, recipes: Option<PathBuf>, runner: &TaskRunner) -> Self {
        Self {
            state: CompareState::new(folder, recipes, runner),
        }
    }
}

impl Workspace for CompareWorkspace {
    fn kind(&self) -> WorkspaceKind {
        WorkspaceKind::Compare
    }

    fn ui(&mut self, ui: &mut Ui, cx: &mut ShellContext<'_>) -> Rect {
        let session = cx.session;
        let state = &self.state;
        let mut acts = Vec::new();
        if state.is_behind(session) {
            acts.push(CompareAction::Follow);
        }
        side_panel(ui, "recipe", RECIPE, Margin::ZERO, |ui| {
            recipe_panel::ui(ui, state, session, &mut acts);
        });
        fixed_panel(ui, Panel::top("case"), Margin::symmetric(12, 8), |ui| {
            case_bar::ui(ui, state, session, &mut acts);
        });
        let room = body(ui, state, session, &mut acts);
        for action in acts {
            self.state.apply(action, cx);
        }
        room
    }

    fn update(&mut self, cx: &mut ShellContext<'_>) {
        self.state.update(cx);
    }

    fn close(&mut self) {
        self.state.keep_trial();
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

    fn is_idle(&self, session: &Session) -> bool {
        self.state.is_idle(session)
    }
}

/// Draws three pictures above; the distances and the kept cases below. Returns the place of the pictures.
fn body(
    ui: &mut Ui,
    state: &CompareState,
    session: &Session,
    acts: &mut Vec<CompareAction>,
) -> Rect {
    let theme = Theme::of(ui);
    let all = ui.available_rect_before_wrap();
    ui.painter().rect_filled(all, 0.0, theme.panel);
    let middle = all.top() + (all.height() * 0.46).round();
    let third = |part: f32| (all.left() + all.width() * part).round();
    let left = third(0.32);
    let cell = |from: [f32; 2], to: [f32; 2]| {
        Rect::from_min_max(pos2(from[0], from[1]), pos2(to[0], to[1])).shrink(space::MEDIUM)
    };
    let above = [
        cell([all.left(), all.top()], [left, middle]),
        cell([left, all.top()], [third(0.66), middle]),
        cell([third(0.66), all.top()], [all.right(), middle]),
    ];
    pictures::ui(ui, above, state, session);
    let below = [
        cell([all.left(), middle], [left, all.bottom()]),
        cell([left, middle], [all.right(), all.bottom()]),
    ];
    let within = |ui: &mut Ui, rect: Rect, draw: &mut dyn FnMut(&mut Ui)| {
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| {
            ui.set_clip_rect(rect.expand2(vec2(4.0, 4.0)));
            draw(ui);
        });
    };
    within(ui, below[0], &mut |ui| {
        distances::ui(ui, state, session, acts);
    });
    within(ui, below[1], &mut |ui| {
        kept_cases::ui(ui, state, session, acts);
    });
    let painter = ui.painter();
    painter.hline(all.x_range(), middle, theme.edge_stroke());
    painter.vline(left, all.y_range(), theme.edge_stroke());
    painter.vline(third(0.66), all.top()..=middle, theme.edge_stroke());
    all.with_max_y(middle)
}
