//! Enrol: from a capture or a file to a part that inspections recognise.

mod card;
mod catalogue;
pub mod change;
pub mod draft;
mod fields;
mod form;
mod picture;
pub mod scanned;
pub mod selection;
pub mod state;
pub mod subject;
mod thumbnails;
mod tools;
pub mod undo;
mod view;
pub mod work;

use egui::{
    Align, Button, Frame, Key, Layout, Margin, Modifiers, Panel, Rect, RichText, Ui, UiBuilder,
    vec2,
};

use self::{
    catalogue::Catalogue, draft::Draft, picture::PicturePane, state::DraftPanes,
    thumbnails::Thumbnails, view::DraftView,
};
pub use self::{
    state::{EnrolAction, EnrolState, apply, hear},
    work::{EnrolAnswer, EnrolRequest},
};
pub(super) use self::{
    state::{take, take_scan},
    work::answer,
};
use super::{
    action::{Action, DialogRequest},
    bars::labelled,
    keys::Shortcut,
    lane::TaskQueue,
    shots::{ShotList, StripTab},
    state::State,
    theme::{Theme, font, space},
    viewport::{ViewError, ViewportGpu},
};

/// The keys of the workspace. Those with more modifiers come first: the others would take them too.
pub(in crate::app) const SHORTCUTS: [Shortcut; 3] = [
    Shortcut {
        modifiers: Modifiers::COMMAND.plus(Modifiers::SHIFT),
        key: Key::Z,
        keys: "Ctrl Shift Z",
        does: "Do again what was undone last",
        action: || Action::Enrol(EnrolAction::Redo),
    },
    Shortcut {
        modifiers: Modifiers::COMMAND,
        key: Key::Z,
        keys: "Ctrl Z",
        does: "Undo the last correction or change of the library",
        action: || Action::Enrol(EnrolAction::Undo),
    },
    Shortcut {
        modifiers: Modifiers::COMMAND,
        key: Key::S,
        keys: "Ctrl S",
        does: "Save the part",
        action: || Action::Enrol(EnrolAction::Save),
    },
];

/// Width of the card, logical pixels, and in a narrow window.
const CARD: [f32; 2] = [360.0, 320.0];
/// Height of the strip of enrolled parts, logical pixels.
const STRIP: f32 = 150.0;

/// What the workspace keeps between frames: nothing but what was made of the state, and a box being drawn.
pub(super) struct EnrolPanel {
    view: DraftView,
    picture: PicturePane,
    thumbnails: Thumbnails,
    catalogue: Catalogue,
    shots: ShotList,
}

impl EnrolPanel {
    pub(super) fn new(gpu: Result<ViewportGpu, ViewError>) -> Self {
        Self {
            view: DraftView::new(gpu),
            picture: PicturePane::default(),
            thumbnails: Thumbnails::default(),
            catalogue: Catalogue::default(),
            shots: ShotList::default(),
        }
    }

    /// True while keys go to a 3-D view.
    pub(super) fn view_has_focus(&self) -> bool {
        self.view.has_focus()
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
        self.thumbnails.make(ui.ctx(), state);
        Panel::right("enrol card")
            .exact_size(if size.x > 1100.0 { CARD[0] } else { CARD[1] })
            .resizable(false)
            .frame(panel(Margin::symmetric(16, 12)))
            .show(ui, |ui| match &state.enrol.open {
                Some(open) => card::ui(ui, open, state, &self.thumbnails, theme, actions),
                None => form::ui(ui, state, &self.thumbnails, theme, actions),
            });
        Panel::bottom("enrolled parts")
            .exact_size(strip_height(state))
            .resizable(false)
            .frame(panel(Margin::symmetric(14, 6)))
            .show(ui, |ui| {
                if state.fused().is_some()
                    && ShotList::tabs(ui, state, "Enrolled parts", theme, actions)
                {
                    self.shots.ui(ui, state, theme, actions);
                    return;
                }
                self.catalogue
                    .ui(ui, state, &self.thumbnails, theme, actions);
            });
        match &state.enrol.draft {
            Some(draft) => self.draft(ui, draft, state, theme, actions),
            None => empty(ui, state, theme, actions),
        }
    }

    /// The draft, and the tools to correct it.
    fn draft(
        &mut self,
        ui: &mut Ui,
        draft: &Draft,
        state: &State,
        theme: &Theme,
        actions: &mut Vec<Action>,
    ) {
        Panel::top("enrol tools")
            .resizable(false)
            .frame(
                Frame::new()
                    .fill(theme.canvas)
                    .inner_margin(Margin::same(10)),
            )
            .show(ui, |ui| {
                tools::ui(ui, draft, state, theme, actions);
                tools::segments(ui, draft, actions);
            });
        if state.is_taking_another() {
            ui.multiply_opacity(0.55);
        }
        let all = ui.available_rect_before_wrap();
        let [width, height] = draft.subject.picture.size();
        let wanted = all.height() * width as f32 / height.max(1) as f32;
        let share = (wanted / all.width().max(1.0)).clamp(0.5, 0.58);
        let (left, right) = all.split_left_right_at_fraction(share);
        let (picture, view) = match state.enrol.panes() {
            DraftPanes::Both => (Some(left), Some(right)),
            DraftPanes::Picture => (Some(all), None),
            DraftPanes::View => (None, Some(all)),
        };
        let mut inside = |rect: Rect, draw: &mut dyn FnMut(&mut Ui)| {
            ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| draw(ui));
        };
        if let Some(rect) = picture {
            inside(rect.shrink(space::SMALL), &mut |ui| {
                self.picture.ui(ui, draft, state, theme, actions);
            });
        }
        if let Some(rect) = view {
            inside(rect, &mut |ui| self.view.ui(ui, draft, state, actions));
        } else {
            self.view.rest();
        }
    }
}

fn strip_height(state: &State) -> f32 {
    match state.enrol.shots.strip {
        _ if state.fused().is_none() => STRIP,
        StripTab::Shots => ShotList::HEIGHT,
        StripTab::Usual => STRIP + space::TARGET + space::SMALL,
    }
}

/// Without a draft: where one comes from.
fn empty(ui: &mut Ui, state: &State, theme: &Theme, actions: &mut Vec<Action>) {
    let height = ui.available_height();
    let layout = Layout::top_down(Align::Center);
    ui.with_layout(layout, |ui| {
        ui.add_space((height / 2.0 - 110.0).max(space::LARGE));
        if let Some(work) = state.works.get(&TaskQueue::Enrol) {
            ui.add(egui::Spinner::new().size(28.0).color(theme.accent));
            let text = RichText::new(format!("{}…", work.what));
            ui.label(text.font(font::verdict()).color(theme.weak_text));
            return;
        }
        let replaced = state.replaced_title();
        let title = match replaced {
            Some(title) => format!("Show what shall replace {title}"),
            None => "Show the part to enrol".to_owned(),
        };
        ui.label(RichText::new(title).font(font::title()).color(theme.text));
        let how = "Hang it before the camera and press Capture, open a capture, a cloud or a mesh, or drop its file here";
        let how = RichText::new(how).color(theme.weak_text);
        ui.scope(|ui| {
            ui.set_max_width(460.0);
            ui.label(how);
        });
        ui.add_space(space::LARGE);
        if let Some(shown) = &state.shown {
            let origin = shown.inspected.origin.title();
            let text = format!("Take {origin}, which Inspect shows");
            let label = "Take the inspected scene";
            let button = Button::new(RichText::new(text).color(theme.on_accent));
            let button = ui.add(button.fill(theme.accent).min_size(vec2(260.0, 48.0)));
            button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, label));
            if button.clicked() {
                actions.push(Action::Enrol(EnrolAction::TakeShown));
            }
        }
        let open = "Open a scan…";
        if labelled(ui, Button::new(open), open)
            .on_hover_text("Several shots from several sides, each with the pose of its camera (Ctrl Shift O)")
            .clicked()
        {
            actions.push(Action::Ask(DialogRequest::Scan));
        }
        if replaced.is_some() {
            form::as_new(ui, actions);
        }
    });
}

/// The name for people of an enrolled part.
fn title_of<'a>(state: &'a State, name: &'a str) -> &'a str {
    let place = |library: &'a super::shelf::LibraryView| {
        library.place_of(name).map(|place| library.title(place))
    };
    state.library.as_deref().and_then(place).unwrap_or(name)
}
