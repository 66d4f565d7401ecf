//! Inspect, the operator's workspace: the view, the verdict and the stages.

mod banner;
mod card;
mod controls;
mod frame_parts;
mod headline;
mod hold;
mod operator;
mod operator_words;
mod plots;
mod ranking;
mod readout;
mod robot_numbers;
mod state;
mod strip;
mod surface;
#[cfg(test)]
mod tests;
mod view;
mod wrong_part;

use std::{path::Path, sync::Arc};

use egui::{Align2, Frame, Key, Margin, Modifiers, Panel, Rect, TextureHandle, Ui};

use self::view::SceneView;
pub use self::{
    state::{InspectAction, InspectFile, InspectState, ViewPart},
    view::WorkCounts,
    wrong_part::WrongPartPage,
};
use crate::{
    shared::Thumbnails,
    shots::{ShotList, ShotsAction, ShotsFile, ShownShots, StripTab},
};
use capture::SourceSpec;
use shell::{
    action::Event,
    inspection::{inspected::Inspected, scan::FusedShots},
    session::{Session, Shown, WorkspaceKind},
    workspace::{ShellContext, Workspace},
};
use ui::{
    key_binding::{CTRL_SHIFT, KeyBinding, Shortcut},
    language::{Language, text},
    task::{Running, TaskRunner},
    theme::{Theme, font, space},
    viewport::{ViewError, ViewportGpu},
    widgets::{by_height, fixed_panel, side_panel, texture},
};

/// Width of the verdict card in a wide and in a narrow window, logical pixels.
const CARD: [f32; 2] = [340.0, 300.0];
const CARD_MARGIN: Margin = Margin::symmetric(18, 14);
/// Height of the stage strip in a high and in a low window, logical pixels.
const STRIP: [f32; 2] = [196.0, 164.0];

/// The shortcuts of this workspace.
#[rustfmt::skip]
const SHORTCUTS: [Shortcut<InspectAction>; 8] = [
    Shortcut::new(CTRL_SHIFT, Key::Z, || text!("inspect-does-redo"), || InspectAction::Shots(ShotsAction::Redo)),
    Shortcut::new(Modifiers::COMMAND, Key::Z, || text!("inspect-does-undo"), || InspectAction::Shots(ShotsAction::Undo)),
    Shortcut::new(Modifiers::NONE, Key::P, || text!("inspect-does-picture"), || InspectAction::Ask(InspectFile::Picture)),
    Shortcut::new(Modifiers::NONE, Key::C, || text!("inspect-does-contour"), || InspectAction::Toggle(ViewPart::Outline)),
    Shortcut::new(Modifiers::NONE, Key::N, || text!("inspect-does-nozzle"), || InspectAction::Toggle(ViewPart::NozzleWorst)),
    Shortcut::new(CTRL_SHIFT, Key::C, || text!("inspect-does-copy"), || InspectAction::CopyPose),
    Shortcut::new(Modifiers::NONE, Key::Comma, || text!("inspect-does-previous-part"), || InspectAction::NextPart(-1)),
    Shortcut::new(Modifiers::NONE, Key::Period, || text!("inspect-does-next-part"), || InspectAction::NextPart(1)),
];

/// The workspace. Between frames it keeps its state and what it prepared of the last result.
pub struct InspectWorkspace {
    /// The state of the workspace.
    pub state: InspectState,
    view: SceneView,
    shots: ShotList,
    thumbnails: Thumbnails,
    made: Option<TextureSet>,
    num_made: u64,
}

/// Textures of one result.
struct TextureSet {
    generation: u64,
    /// Language of the texts in the view.
    language: Language,
    segmentation: Option<TextureHandle>,
    binary: Option<TextureHandle>,
}

impl InspectWorkspace {
    /// Creates the workspace; the view draws with `gpu`.
    pub fn new(gpu: &Result<ViewportGpu, ViewError>, runner: &TaskRunner) -> Self {
        Self {
            state: InspectState::new(runner),
            view: SceneView::new(gpu.clone()),
            shots: ShotList::default(),
            thumbnails: Thumbnails::default(),
            made: None,
            num_made: 0,
        }
    }

    /// Work done by its frames so far.
    pub fn counts(&self) -> WorkCounts {
        let mut counts = self.view.counts();
        counts.made += self.num_made;
        counts
    }

    /// Share of the points drawn in the last frame, 0..1.
    pub fn detail(&self) -> f32 {
        self.view.viewport.detail()
    }

    /// Hands over a picture of the current view, if one was requested.
    fn hand_over_picture(&mut self, ui: &Ui, cx: &mut ShellContext<'_>) {
        if self.state.wants_picture() {
            let shot = self.view.shot(ui.pixels_per_point());
            self.state.take_picture(shot, cx);
        }
    }

    /// Draws the operator's view, or the page on what a part really is.
    fn operators_ui(&mut self, ui: &mut Ui, cx: &mut ShellContext<'_>) -> Rect {
        let session = cx.session;
        let mut actions = Vec::new();
        let room = if let Some(page) = &mut self.state.wrong_part {
            self.thumbnails.make(ui.ctx(), page.library());
            page.ui(ui, &self.thumbnails, &mut actions)
        } else {
            if let Some(shown) = &session.shown {
                self.make(ui.ctx(), shown);
                self.view.frame_part(shown);
            }
            operator::ui(ui, session, &mut actions, |ui| {
                if let Some(shown) = &session.shown {
                    self.view.plain_ui(ui, session, &shown.inspected);
                }
            })
        };
        self.hand_over_picture(ui, cx);
        for action in actions {
            self.state.apply(action, cx);
        }
        room
    }

    /// Draws the strip: the stages, or the list of shots of a scan.
    fn strip(
        &mut self,
        ui: &mut Ui,
        inspected: &Inspected,
        session: &Session,
        actions: &mut Vec<InspectAction>,
    ) {
        if let Some(scan) = &inspected.scan
            && self.shots_ui(ui, &scan.fused, session, actions)
        {
            return;
        }
        let pictures = self.pictures(inspected, session, Theme::of(ui));
        strip::ui(ui, &pictures, actions);
    }

    /// Draws the strip of a scan: a row of tabs, and the list unless the stages are chosen; returns whether it drew the
    /// list.
    fn shots_ui(
        &mut self,
        ui: &mut Ui,
        fused: &Arc<FusedShots>,
        session: &Session,
        actions: &mut Vec<InspectAction>,
    ) -> bool {
        let scan = ShownShots {
            fused,
            choice: self.state.shot_choice(session).unwrap_or(&fused.choice),
            shots: &self.state.shots,
            session,
        };
        let mut caused = Vec::new();
        let margin = Frame::new().inner_margin(Margin::symmetric(12, 6));
        let shown = margin.show(ui, |ui| {
            let is_list = ShotList::tabs(ui, scan, &text!("inspect-stages"), &mut caused);
            if is_list {
                if session.is_old() {
                    ui.multiply_opacity(0.75);
                }
                self.shots.ui(ui, scan, &mut caused);
            }
            is_list
        });
        actions.extend(caused.into_iter().map(InspectAction::Shots));
        shown.inner
    }

    fn pictures<'a>(
        &'a self,
        inspected: &'a Inspected,
        session: &'a Session,
        theme: &'static Theme,
    ) -> plots::Pictures<'a> {
        let made = self.made.as_ref();
        plots::Pictures {
            inspected,
            state: &self.state,
            session,
            theme,
            segmentation: made.and_then(|made| made.segmentation.as_ref()),
            binary: made.and_then(|made| made.binary.as_ref()),
        }
    }

    /// Uploads what a new result shows; the texts in the view also change with the language.
    fn make(&mut self, ctx: &egui::Context, shown: &Shown) {
        let language = Language::current();
        if self
            .made
            .as_ref()
            .is_some_and(|made| (made.generation, made.language) == (shown.generation, language))
        {
            return;
        }
        self.num_made += 1;
        let figures = &shown.inspected.figures;
        self.made = Some(TextureSet {
            generation: shown.generation,
            language,
            segmentation: texture(ctx, "segmentation", figures.segmentation.as_ref()),
            binary: texture(ctx, "binary image", figures.binary.as_ref()),
        });
        self.view.show(shown);
    }
}

impl Workspace for InspectWorkspace {
    fn kind(&self) -> WorkspaceKind {
        WorkspaceKind::Inspect
    }

    fn ui(&mut self, ui: &mut Ui, cx: &mut ShellContext<'_>) -> Rect {
        let (session, theme) = (cx.session, Theme::of(ui));
        if session.is_operator_view() {
            return self.operators_ui(ui, cx);
        }
        let Some(shown) = &session.shown else {
            ui.painter().rect_filled(ui.max_rect(), 0.0, theme.canvas);
            let mut actions = Vec::new();
            if session.expecting.orders().is_some() {
                // Without an order, there may never be a result.
                side_panel(ui, "order", CARD, CARD_MARGIN, |ui| {
                    card::expecting(ui, session, &mut actions);
                });
            }
            empty(ui, session);
            let room = ui.available_rect_before_wrap();
            for action in actions {
                self.state.apply(action, cx);
            }
            return room;
        };
        self.make(ui.ctx(), shown);
        let inspected: &Inspected = &shown.inspected;
        let mut actions = Vec::new();
        side_panel(ui, "verdict", CARD, CARD_MARGIN, |ui| {
            let shows_nozzle = self.state.shows_nozzle();
            card::ui(ui, inspected, session, shows_nozzle, &mut actions);
        });
        let height = strip_height(&self.state, inspected, ui.available_height());
        let bottom = Panel::bottom("stages").exact_size(height);
        fixed_panel(ui, bottom, Margin::ZERO, |ui| {
            self.strip(ui, inspected, session, &mut actions);
        });
        let room = ui.available_rect_before_wrap();
        if self.state.enlarged.is_some() {
            ui.painter().rect_filled(room, 0.0, theme.canvas);
            let pictures = self.pictures(inspected, session, theme);
            strip::enlarged_ui(ui, &pictures, &mut actions);
        } else {
            let Self { state, view, .. } = self;
            view.ui(ui, state, session, inspected, &mut actions);
        }
        self.hand_over_picture(ui, cx);
        for action in actions {
            self.state.apply(action, cx);
        }
        room
    }

    fn update(&mut self, cx: &mut ShellContext<'_>) {
        self.state.update(cx);
    }

    fn on_event(&mut self, event: &Event, cx: &mut ShellContext<'_>) {
        self.state.on_event(event, cx);
    }

    fn take_file(&mut self, path: &Path, cx: &mut ShellContext<'_>) -> bool {
        let is_wanted = self.state.shots.wants(path);
        if is_wanted {
            let file = InspectFile::Shots(ShotsFile::Poses);
            let chosen = InspectAction::Chosen(file, path.to_owned());
            self.state.apply(chosen, cx);
        }
        is_wanted
    }

    fn key_bindings(&self) -> Vec<KeyBinding> {
        SHORTCUTS.iter().map(|shortcut| shortcut.binding).collect()
    }

    fn press(&mut self, index: usize, cx: &mut ShellContext<'_>) {
        if let Some(shortcut) = SHORTCUTS.get(index) {
            self.state.apply((shortcut.action)(), cx);
        }
    }

    /// The space bar captures even while the view has the key focus.
    fn has_key_focus(&self) -> bool {
        self.view.has_focus
    }

    fn writing(&self) -> Option<&Running> {
        self.state.writing()
    }

    fn is_idle(&self, _session: &Session) -> bool {
        self.state.writing().is_none()
    }
}

fn strip_height(state: &InspectState, inspected: &Inspected, height: f32) -> f32 {
    let usual = by_height(height, STRIP);
    match state.shots.strip {
        _ if inspected.scan.is_none() => usual,
        StripTab::Shots => ShotList::HEIGHT,
        StripTab::Usual => usual + space::TARGET + 12.0,
    }
}

/// Says how the source is inspected for the first time.
fn first_step(session: &Session) -> String {
    match session.source.followed() {
        _ if session.is_watching() => text!("operator-save-capture"),
        _ if session.is_live() => text!("shell-wait"),
        Some(SourceSpec::Simulated(_)) => text!("inspect-capture-cell"),
        _ => text!("inspect-capture-or-drop"),
    }
}

/// Draws the area before the first result.
fn empty(ui: &Ui, session: &Session) {
    let theme = Theme::of(ui);
    let text = match &session.inspecting {
        Some(run) => format!("{}…", run.title),
        None => format!(
            "{}\n{}",
            text!("shell-nothing-inspected"),
            first_step(session)
        ),
    };
    let rect = ui.available_rect_before_wrap();
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
