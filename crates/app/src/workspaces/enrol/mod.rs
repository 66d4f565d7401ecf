//! Enrol: from a capture or a file to a part that inspections recognise.
//!
//! ```text
//! subject    what a part is enrolled from        segments, picture_plane, scanned
//! selection  what of it is kept, as corrected     outline, picture, tools, view
//! draft      the part as it would be stored       taking, fields, form, kept
//! meshes     which of a file's meshes are drafts  mesh_list
//! change     a change of the library              undo, catalogue, card
//! ```

mod card;
mod catalogue;
pub mod change;
pub mod draft;
mod fields;
mod form;
mod kept;
mod mesh_list;
pub mod meshes;
pub mod outline;
mod picture;
pub mod picture_plane;
pub mod scanned;
pub mod segments;
pub mod selection;
pub mod state;
pub mod subject;
mod taking;
mod thumbnails;
mod tools;
pub mod undo;
mod view;
pub mod work;

use std::path::{Path, PathBuf};

use egui::{
    Align, Button, Frame, Key, Layout, Margin, Modifiers, Panel, Rect, RichText, Ui, UiBuilder,
    vec2,
};

pub use self::state::{DraftPanes, EnrolAction, EnrolFile, EnrolState};
use self::{
    catalogue::Catalogue, draft::Draft, kept::DraftFile, mesh_list::MeshDialog,
    picture::PicturePane, thumbnails::Thumbnails, view::DraftView,
};
use crate::shots::{ShotList, ShownShots, StripTab};
use shell::{
    action::Event,
    inspection::source::SceneOrScan,
    session::{Session, WorkspaceKind},
    workspace::{ShellContext, Workspace},
};
use ui::{
    key_binding::{CTRL_SHIFT, KeyBinding, Shortcut},
    language::text,
    task::{Running, TaskRunner},
    theme::{Theme, font, space},
    viewport::{ViewError, ViewportGpu},
    widgets::{fixed_panel, side_panel, text_button},
};

/// The shortcuts of this workspace. Those with more modifiers come first, as the others would match them too.
#[rustfmt::skip]
const SHORTCUTS: [Shortcut<EnrolAction>; 5] = [
    Shortcut::new(CTRL_SHIFT, Key::Z, || text!("enrol-key-redo"), || EnrolAction::Redo),
    Shortcut::new(Modifiers::COMMAND, Key::Z, || text!("enrol-key-undo"), || EnrolAction::Undo),
    Shortcut::new(Modifiers::COMMAND, Key::S, || text!("enrol-key-save"), || EnrolAction::Save),
    Shortcut::new(Modifiers::NONE, Key::D, || text!("enrol-key-draw"), || EnrolAction::DrawNext),
    Shortcut::new(Modifiers::NONE, Key::R, || text!("enrol-key-rotate"), || EnrolAction::Draw(None)),
];

/// Width of the card in a wide and in a narrow window, logical pixels.
const CARD: [f32; 2] = [360.0, 320.0];
/// Height of the strip of enrolled parts, logical pixels.
const STRIP: f32 = 150.0;
/// Height of the additional line of a shot that is about to be dropped, logical pixels.
const TO_BE_DROPPED: f32 = 16.0;

/// The workspace.
pub struct EnrolWorkspace {
    /// The state of the workspace.
    pub state: EnrolState,
    file: DraftFile,
    panes: Panes,
}

/// The panes: derived from the state, except for an outline being drawn.
struct Panes {
    view: DraftView,
    picture: PicturePane,
    thumbnails: Thumbnails,
    catalogue: Catalogue,
    shots: ShotList,
    meshes: MeshDialog,
}

impl EnrolWorkspace {
    /// Creates the workspace. The draft of an earlier start is brought back from the file `draft`; without a file, no
    /// draft is kept.
    pub fn new(
        gpu: Result<ViewportGpu, ViewError>,
        draft: Option<PathBuf>,
        runner: &TaskRunner,
    ) -> Self {
        Self {
            state: EnrolState::new(runner),
            file: DraftFile::new(draft, runner),
            panes: Panes {
                view: DraftView::new(gpu),
                picture: PicturePane::default(),
                thumbnails: Thumbnails::default(),
                catalogue: Catalogue::default(),
                shots: ShotList::default(),
                meshes: MeshDialog::default(),
            },
        }
    }
}

impl Workspace for EnrolWorkspace {
    fn kind(&self) -> WorkspaceKind {
        WorkspaceKind::Enrol
    }

    fn ui(&mut self, ui: &mut Ui, cx: &mut ShellContext<'_>) -> Rect {
        let mut actions = Vec::new();
        let room = self.panes.ui(ui, &self.state, cx.session, &mut actions);
        for action in actions {
            self.state.apply(action, cx);
        }
        room
    }

    fn update(&mut self, cx: &mut ShellContext<'_>) {
        match self.file.load() {
            Some(Ok(kept)) => self.state.bring_back(kept, cx),
            Some(Err(error)) => cx.notify(error),
            None => {}
        }
        self.state.update(cx);
        if let Some(error) = self.file.keep(&self.state, cx.egui) {
            cx.notify(error);
        }
    }

    fn close(&mut self) {
        self.file.finish(&self.state);
    }

    fn on_event(&mut self, event: &Event, cx: &mut ShellContext<'_>) {
        self.state.on_event(event, cx);
    }

    fn take_scene(&mut self, scene: SceneOrScan, title: String, cx: &mut ShellContext<'_>) {
        self.state.take(scene, title, cx);
    }

    fn take_file(&mut self, path: &Path, cx: &mut ShellContext<'_>) -> bool {
        self.state.take_file(path, cx)
    }

    fn key_bindings(&self) -> Vec<KeyBinding> {
        SHORTCUTS.iter().map(|shortcut| shortcut.binding).collect()
    }

    fn press(&mut self, index: usize, cx: &mut ShellContext<'_>) {
        if let Some(shortcut) = SHORTCUTS.get(index) {
            self.state.apply((shortcut.action)(), cx);
        }
    }

    fn unsaved(&self) -> Option<String> {
        self.state.unsaved()
    }

    fn running(&self) -> Option<&Running> {
        self.state.running()
    }

    fn cancel(&mut self) {
        self.state.cancel();
    }

    fn has_key_focus(&self) -> bool {
        self.panes.view.has_focus()
    }

    fn is_idle(&self, _session: &Session) -> bool {
        let state = &self.state;
        let is_changing = state.is_changing_library() || state.is_drawing_meshes();
        let is_at_work = self.running().is_some() || is_changing;
        !is_at_work && self.file.is_idle()
    }
}

impl Panes {
    fn ui(
        &mut self,
        ui: &mut Ui,
        enrol: &EnrolState,
        session: &Session,
        actions: &mut Vec<EnrolAction>,
    ) -> Rect {
        let library = session.library.as_ref();
        let checked = enrol.draft.as_ref().and_then(Draft::ready);
        self.thumbnails.make(ui.ctx(), library, checked);
        self.meshes.ui(ui.ctx(), enrol, session, actions);
        side_panel(
            ui,
            "enrol card",
            CARD,
            Margin::symmetric(16, 12),
            |ui| match &enrol.open {
                Some(open) => card::ui(ui, open, enrol, session, &self.thumbnails, actions),
                None => form::ui(ui, enrol, session, &self.thumbnails, actions),
            },
        );
        let scan = shown_scan(enrol, session);
        let bottom = Panel::bottom("enrolled parts").exact_size(strip_height(scan));
        fixed_panel(ui, bottom, Margin::symmetric(14, 6), |ui| {
            if let Some(scan) = scan {
                let mut caused = Vec::new();
                let usual = text!("enrol-enrolled-parts");
                let is_list = ShotList::tabs(ui, scan, &usual, &mut caused);
                if is_list {
                    self.shots.ui(ui, scan, &mut caused);
                }
                actions.extend(caused.into_iter().map(EnrolAction::Shots));
                if is_list {
                    return;
                }
            }
            self.catalogue
                .ui(ui, enrol, library, &self.thumbnails, actions);
        });
        if let Some(draft) = &enrol.draft {
            return self.draft(ui, draft, enrol, session, actions);
        }
        let room = ui.available_rect_before_wrap();
        empty(ui, enrol, session, actions);
        room
    }

    /// Draws the draft, and the tools to correct it. Returns the place of the draft.
    fn draft(
        &mut self,
        ui: &mut Ui,
        draft: &Draft,
        enrol: &EnrolState,
        session: &Session,
        actions: &mut Vec<EnrolAction>,
    ) -> Rect {
        let theme = Theme::of(ui);
        Panel::top("enrol tools")
            .resizable(false)
            .frame(
                Frame::new()
                    .fill(theme.canvas)
                    .inner_margin(Margin::same(10)),
            )
            .show(ui, |ui| {
                tools::ui(ui, draft, enrol, actions);
                tools::segments(ui, draft, actions);
            });
        if enrol.is_taking_another() {
            ui.multiply_opacity(0.55);
        }
        let all = ui.available_rect_before_wrap();
        let [width, height] = draft.subject.picture.size();
        let wanted = all.height() * width as f32 / height.max(1) as f32;
        let share = (wanted / all.width().max(1.0)).clamp(0.5, 0.58);
        let (left, right) = all.split_left_right_at_fraction(share);
        let (picture, view) = match enrol.panes() {
            DraftPanes::Both => (Some(left), Some(right)),
            DraftPanes::Picture => (Some(all), None),
            DraftPanes::View => (None, Some(all)),
        };
        let mut inside = |rect: Rect, draw: &mut dyn FnMut(&mut Ui)| {
            ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| draw(ui));
        };
        if let Some(rect) = picture {
            inside(rect.shrink(space::SMALL), &mut |ui| {
                self.picture.ui(ui, draft, enrol, actions);
            });
        }
        if let Some(rect) = view {
            inside(rect, &mut |ui| {
                self.view.ui(ui, draft, enrol, session.theme, actions);
            });
        } else {
            self.view.rest();
        }
        all
    }
}

/// The shots of the draft, if it is a scan.
fn shown_scan<'a>(enrol: &'a EnrolState, session: &'a Session) -> Option<ShownShots<'a>> {
    let fused = enrol.draft.as_ref()?.subject.scan()?;
    Some(ShownShots {
        fused,
        choice: enrol.shot_choice()?,
        shots: &enrol.shots,
        session,
    })
}

fn strip_height(scan: Option<ShownShots<'_>>) -> f32 {
    let Some(scan) = scan else {
        return STRIP;
    };
    match scan.shots.strip {
        StripTab::Shots if !scan.choice.dropped.is_subset(&scan.fused.choice.dropped) => {
            ShotList::HEIGHT + TO_BE_DROPPED
        }
        StripTab::Shots => ShotList::HEIGHT,
        StripTab::Usual => STRIP + space::TARGET + space::SMALL,
    }
}

/// Draws the area without a draft: where one comes from.
fn empty(ui: &mut Ui, enrol: &EnrolState, session: &Session, actions: &mut Vec<EnrolAction>) {
    let theme = Theme::of(ui);
    let height = ui.available_height();
    let layout = Layout::top_down(Align::Center);
    ui.with_layout(layout, |ui| {
        ui.add_space((height / 2.0 - 110.0).max(space::LARGE));
        if let Some(running) = enrol.running() {
            ui.add(egui::Spinner::new().size(28.0).color(theme.accent));
            let text = RichText::new(format!("{}…", running.title));
            ui.label(text.font(font::verdict()).weak());
            return;
        }
        let replaced = enrol.replaced_title(session);
        let title = match replaced {
            Some(title) => text!("enrol-capture-replacement", part = title),
            None => text!("enrol-show-part"),
        };
        ui.label(RichText::new(title).font(font::title()));
        let how = RichText::new(text!("enrol-how")).weak();
        ui.scope(|ui| {
            ui.set_max_width(460.0);
            ui.label(how);
        });
        ui.add_space(space::LARGE);
        if let Some(shown) = &session.shown {
            let inspected = &shown.inspected;
            let saved = enrol.saved_from.as_ref();
            let library = session.library.as_deref();
            // What was just saved is not offered again, unless it was removed.
            let is_saved = saved.is_some_and(|saved| {
                let is_enrolled =
                    library.is_some_and(|all| all.index_of(saved.part.as_str()).is_some());
                is_enrolled && saved.matter.is_inspected_in(inspected)
            });
            let (text, label, action) = if is_saved {
                let text = text!("enrol-see-inspected");
                (text.clone(), text, EnrolAction::SeeInspected)
            } else {
                let text = text!("enrol-take-shown", scene = inspected.origin.shown_title());
                (text, text!("enrol-use-shown"), EnrolAction::TakeShown)
            };
            let button = Button::new(RichText::new(text).color(theme.on_accent));
            let button = ui.add(button.fill(theme.accent).min_size(vec2(260.0, 48.0)));
            button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
            if button.clicked() {
                actions.push(action);
            }
        }
        let open = text_button(ui, &text!("shell-open-scan"));
        if open.on_hover_text(text!("enrol-open-scan-hint")).clicked() {
            actions.push(EnrolAction::OpenScan);
        }
        if replaced.is_some() {
            form::as_new(ui, actions);
        }
    });
}

/// Title of an enrolled part, or its name if it is not in the library.
fn title_of<'a>(session: &'a Session, name: &'a str) -> &'a str {
    let library = session.library.as_deref();
    library.map_or(name, |library| library.title_of(name))
}
