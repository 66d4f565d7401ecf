//! The bars around the work: the top bar, and those above and below the operator's view with the parts of this shift, the running
//! work, and the operator's few controls.

use egui::{
    Align, Button, Color32, Frame, Layout, Margin, Panel, RichText, Ui, Vec2, WidgetInfo, vec2,
};

use crate::{
    action::{Action, DialogRequest},
    cell::RobotAction,
    inspection::{figures::StagePanel, library_cache::LibraryView, source::file_name},
    roles::RoleAction,
    session::{Session, ShiftParts, WorkspaceKind},
    source::{live::LiveAction, source_menu},
    state::State,
};
use ui::{
    language::{Language, keys, text},
    task::Running,
    theme::{ROUNDING, Theme, ThemeChoice, font, space},
    widgets::{
        Mark, NARROW, fixed_panel, labelled, line_mark, menu_button, shortened, status_label,
        text_button,
    },
};

/// Margins of a bar.
const MARGIN: Margin = Margin::symmetric(14, 0);
/// Width below which the running work is not named beside its spinner, logical pixels: most words would be cut.
const MIN_TEXT_WIDTH_PX: f32 = 64.0;

/// How much of the library its menu shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum LibraryForm {
    /// Number of parts and, if there is room, the name.
    Full,
    /// The number alone.
    Short,
    /// Nothing.
    Hidden,
}

impl LibraryForm {
    /// The form for this room, logical pixels. Running work with its cancel button takes precedence; it ends soon.
    fn of(room: f32, is_at_work: bool) -> Self {
        if is_at_work && room <= 250.0 {
            Self::Hidden
        } else if is_at_work && room <= 480.0 {
            Self::Short
        } else {
            Self::Full
        }
    }
}

/// The running work shown in the bar.
pub struct Progress {
    /// The work.
    pub running: Running,
    /// The action that cancels it, if there is one.
    pub cancel: Option<Action>,
}

/// Draws the top bar.
pub fn top(ui: &mut Ui, state: &State, work: Option<Progress>, actions: &mut Vec<Action>) {
    let theme = Theme::of(ui);
    let panel = Panel::top("top bar").exact_size(space::TOP_BAR);
    fixed_panel(ui, panel, MARGIN, |ui| {
        ui.horizontal_centered(|ui| {
            // In a narrow window, the controls need the room of the name.
            if ui.ctx().content_rect().width() >= NARROW {
                let name = RichText::new("Partsight").font(font::body_strong());
                ui.label(name);
                ui.add_space(space::LARGE);
            }
            let name = text!("shell-capture");
            let capture = RichText::new(&name).font(font::body_strong());
            // The accent marks the next button to press; while a source is followed, there is none.
            let capture = if state.session.is_live() {
                with_key(ui, Button::new(capture), "Space", theme.weak_text)
            } else {
                let capture = Button::new(capture.color(theme.on_accent));
                with_key(ui, capture, "Space", theme.on_accent).fill(theme.accent)
            };
            if labelled(ui, capture, &name).clicked() {
                actions.push(Action::Capture);
            }
            live_button(ui, state, actions);
            let name = text!("shell-open");
            let open = with_key(ui, Button::new(&*name), "Ctrl O", theme.weak_text);
            if labelled(ui, open, &name).clicked() {
                actions.push(Action::Ask(DialogRequest::Scene));
            }
            robot_button(ui, actions);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                settings(ui, state, work.is_some(), actions);
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    progress(ui, work, actions);
                });
            });
        });
    });
}

/// Adds the key to a button if there is room.
fn with_key<'a>(ui: &Ui, button: Button<'a>, key: &str, colour: Color32) -> Button<'a> {
    if ui.ctx().content_rect().width() < NARROW {
        return button;
    }
    let key = RichText::new(keys(key)).small();
    button.shortcut_text(key.color(colour))
}

/// Draws the button that starts and stops following the source.
fn live_button(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    let theme = Theme::of(ui);
    let is_live = state.session.is_live();
    let colour = if is_live { theme.on_accent } else { theme.text };
    let key = if is_live {
        theme.on_accent
    } else {
        theme.weak_text
    };
    let name = text!("shell-live");
    let text = RichText::new(&name).font(font::body_strong()).color(colour);
    let button = Button::selectable(is_live, text)
        .frame_when_inactive(true)
        .min_size(Vec2::splat(space::TARGET));
    let button = with_key(ui, button, "L", key);
    let response = ui.add(button);
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_live, &name));
    let says = if is_live {
        text!("shell-stop-live-says")
    } else {
        text!("shell-live-says")
    };
    if response.on_hover_text(says).clicked() {
        actions.push(Action::Live(LiveAction::Toggle));
    }
}

/// Draws the button of the robot's cell.
fn robot_button(ui: &mut Ui, actions: &mut Vec<Action>) {
    let theme = Theme::of(ui);
    let name = text!("shell-robot");
    let button = with_key(ui, Button::new(&*name), "B", theme.weak_text);
    let says = text!("shell-robot-says");
    if labelled(ui, button, &name).on_hover_text(says).clicked() {
        actions.push(Action::Robot(RobotAction::Toggle));
    }
}

/// Draws help, colours, units and library, from right to left.
fn settings(ui: &mut Ui, state: &State, is_at_work: bool, actions: &mut Vec<Action>) {
    let theme = Theme::of(ui);
    let name = text!("shell-help");
    let help = with_key(ui, Button::new(&*name), "F1", theme.weak_text);
    if labelled(ui, help, &name).clicked() {
        actions.push(Action::ToggleHelp);
    }
    let name = state.session.theme.title();
    let says = match state.session.theme.other() {
        ThemeChoice::Dark => text!("shell-to-dark"),
        ThemeChoice::Light => text!("shell-to-light"),
    };
    let colours = text_button(ui, &name);
    if colours.on_hover_text(says).clicked() {
        actions.push(Action::SwitchTheme);
    }
    let units = labelled(
        ui,
        Button::new(state.session.units.title()),
        state.session.units.title(),
    );
    let other = state.session.units.other().title();
    if units
        .on_hover_text(text!("shell-to-units", units = other))
        .clicked()
    {
        actions.push(Action::SwitchUnits);
    }
    language_menu(ui, state, actions);
    let room = ui.available_width();
    let form = LibraryForm::of(room, is_at_work);
    let library = state.session.library.as_ref();
    if let Some(library) = library.filter(|_| form != LibraryForm::Hidden) {
        library_menu(ui, state, library, form, actions);
    }
}

/// Draws the menu of languages, each by its own name.
fn language_menu(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    let now = state.session.language;
    let menu = menu_button(ui, format!("{} ▼", now.sign()), |ui| {
        for language in Language::ALL {
            let button = Button::selectable(language == now, language.own_name());
            if ui.add(button).clicked() {
                actions.push(Action::Speak(language));
                ui.close();
            }
        }
    });
    let label = text!("shell-language-of", language = now.own_name());
    let button = menu.response;
    button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
    button.on_hover_text(text!("shell-language-says"));
}

/// Draws the menu of the library in use and others.
fn library_menu(
    ui: &mut Ui,
    state: &State,
    library: &LibraryView,
    form: LibraryForm,
    actions: &mut Vec<Action>,
) {
    let num = library.parts.len();
    let opened = |text: String| format!("{text} ▼");
    let text = if library.unloaded.is_some() {
        opened(text!("shell-no-library"))
    } else if ui.available_width() > 300.0 {
        let name = shortened(&file_name(&library.path), 20);
        opened(text!("shell-library-named", num = num, name = name))
    } else {
        opened(text!("shell-num-parts", num = num))
    };
    let shown = match (form, library.unloaded.is_some()) {
        (LibraryForm::Short, true) => opened("!".to_owned()),
        (LibraryForm::Short, false) => opened(num.to_string()),
        (LibraryForm::Full | LibraryForm::Hidden, _) => text.clone(),
    };
    let menu = menu_button(ui, shown, |ui| {
        ui.set_min_width(260.0);
        ui.label(RichText::new(text!("shell-library-in-use")).font(font::heading()));
        ui.label(library.path.display().to_string());
        if let Some(version) = &library.version {
            ui.label(version);
        }
        if let Some(problem) = &library.unloaded {
            ui.label(&problem.what);
        }
        ui.separator();
        if ui.button(text!("shell-use-another-library")).clicked() {
            actions.push(Action::Ask(DialogRequest::Library));
            ui.close();
        }
        let is_other = state.session.chosen_library.is_some() || library.unloaded.is_some();
        if is_other && ui.button(text!("shell-use-usual-library")).clicked() {
            actions.push(Action::UseFoundLibrary);
            ui.close();
        }
    });
    let button = menu.response;
    button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &text));
    if form == LibraryForm::Short {
        let full = text.trim_end_matches(" ▼");
        button.on_hover_text(full);
    }
}

/// Draws the running work and its cancel button.
fn progress(ui: &mut Ui, work: Option<Progress>, actions: &mut Vec<Action>) {
    let theme = Theme::of(ui);
    let Some(Progress { running, cancel }) = work else {
        return;
    };
    ui.add_space(space::SMALL);
    if let Some(cancel) = cancel
        && text_button(ui, &text!("shell-cancel")).clicked()
    {
        actions.push(cancel);
    }
    let spinner = ui.add(egui::Spinner::new().size(18.0).color(theme.accent));
    let text = match (running.progress, running.stage.map(StagePanel::of)) {
        (Some((done, total)), _) => {
            text!(
                "shell-progress",
                work = shortened(&running.title, 28),
                done = done,
                total = total
            )
        }
        (None, Some(panel)) => {
            text!(
                "shell-progress",
                work = panel.title(),
                done = panel as usize + 1,
                total = StagePanel::ALL.len()
            )
        }
        (None, None) => shortened(&running.title, 28),
    };
    if ui.available_width() < MIN_TEXT_WIDTH_PX {
        spinner.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, &text));
        spinner.on_hover_text(text);
    } else {
        status_label(ui, &text, font::body(), theme.weak_text);
    }
}

/// Height of the lower bar, logical pixels.
const LOWER: f32 = 68.0;
/// Height of its buttons, logical pixels.
const BUTTON: f32 = 52.0;

/// Draws both bars.
pub fn operators(ui: &mut Ui, state: &State, work: Option<Progress>, actions: &mut Vec<Action>) {
    let panel = Panel::top("operator's upper bar").exact_size(space::TOP_BAR);
    fixed_panel(ui, panel, MARGIN, |ui| {
        ui.horizontal_centered(|ui| upper(ui, state, work, actions));
    });
    let panel = Panel::bottom("operator's lower bar").exact_size(LOWER);
    fixed_panel(ui, panel, MARGIN, |ui| {
        ui.horizontal_centered(|ui| lower(ui, state, actions));
    });
}

fn upper(ui: &mut Ui, state: &State, work: Option<Progress>, actions: &mut Vec<Action>) {
    ui.label(RichText::new("Partsight").font(font::body_strong()));
    ui.add_space(space::LARGE);
    // Otherwise the row would be as high as the bar.
    ui.horizontal(|ui| counts(ui, &state.session.shift));
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        let key = RichText::new(keys("Ctrl K")).small();
        let name = text!("shell-engineers-view");
        let engineer = Button::new(&*name).shortcut_text(key.weak());
        let says = match state.roles.pin {
            Some(_) => text!("operator-locked-says"),
            None => text!("shell-to-engineer"),
        };
        if labelled(ui, engineer, &name).on_hover_text(says).clicked() {
            actions.push(Action::Role(RoleAction::Switch));
        }
        let history = WorkspaceKind::History.title();
        if text_button(ui, &history)
            .on_hover_text(text!("operator-history-says"))
            .clicked()
        {
            actions.push(Action::GoTo(WorkspaceKind::History));
        }
        language_menu(ui, state, actions);
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            not_recorded(ui, &state.session);
            progress(ui, work, actions);
        });
    });
}

/// Draws whether inspections cannot be written.
fn not_recorded(ui: &mut Ui, session: &Session) {
    if session.is_history_failing {
        let theme = Theme::of(ui);
        line_mark(ui, 16.0, 8.0, Mark::Look);
        let text = RichText::new(text!("operator-not-recorded")).color(theme.warning);
        let label = ui.add(egui::Label::new(text).truncate());
        label.on_hover_text(text!("operator-not-recorded-says"));
    }
}

/// Draws the number of parts of this shift before its source, and how many were accepted.
fn counts(ui: &mut Ui, shift: &ShiftParts) {
    let theme = Theme::of(ui);
    let (Some(since), Some(source)) = (&shift.since, &shift.source) else {
        return;
    };
    let since = text!(
        "operator-shift-since",
        time = since.strftime("%H:%M").to_string()
    );
    let source = shortened(&source_menu::now(source), 20);
    let label = RichText::new(format!("{since}\n{source}")).small().weak();
    ui.label(label).on_hover_text(text!("operator-shift-says"));
    let num = shift.num_ok + shift.num_not_ok;
    let chips = [
        (None, text!("operator-num-parts", num = num)),
        (
            Some(Mark::Good),
            text!("operator-num-ok", num = shift.num_ok),
        ),
        (
            Some(Mark::Bad),
            text!("operator-num-not-ok", num = shift.num_not_ok),
        ),
    ];
    let not_judged = (shift.num_not_judged > 0).then(|| {
        let text = text!("operator-num-not-judged", num = shift.num_not_judged);
        (Some(Mark::Open), text)
    });
    for (sign, text) in chips.into_iter().chain(not_judged) {
        let chip = Frame::new()
            .fill(theme.control)
            .stroke(theme.edge_stroke())
            .corner_radius(ROUNDING)
            .inner_margin(Margin::symmetric(10, 5))
            .show(ui, |ui| {
                ui.spacing_mut().interact_size.y = 0.0;
                if let Some(sign) = sign {
                    line_mark(ui, 16.0, 8.0, sign);
                }
                ui.label(RichText::new(text).font(font::body_strong()));
            });
        chip.response.on_hover_text(text!("operator-shift-says"));
    }
}

fn lower(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    let theme = Theme::of(ui);
    let text = |text: &str| RichText::new(text).font(font::verdict());
    let key = |text: &str| RichText::new(text).small();
    let is_live = state.session.is_live();
    let (name, space) = (text!("shell-capture"), keys("Space"));
    // The accent marks the next button to press; while a source is followed, there is none.
    let capture = if is_live {
        Button::new(text(&name)).shortcut_text(key(&space).weak())
    } else {
        Button::new(text(&name).color(theme.on_accent))
            .shortcut_text(key(&space).color(theme.on_accent))
            .fill(theme.accent)
    };
    let capture = ui.add(capture.min_size(vec2(200.0, BUTTON)));
    capture.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, &name));
    if capture.clicked() {
        actions.push(Action::Capture);
    }
    let [strong, weak] = if is_live {
        [theme.on_accent; 2]
    } else {
        [theme.text, theme.weak_text]
    };
    let follow = text!("shell-live");
    let live = Button::selectable(is_live, text(&follow).color(strong))
        .frame_when_inactive(true)
        .shortcut_text(key("L").color(weak))
        .min_size(vec2(110.0, BUTTON));
    let live = ui.add(live);
    live.widget_info(|| WidgetInfo::selected(egui::Role::Button, true, is_live, &follow));
    let says = if is_live {
        text!("operator-stop-live-says")
    } else {
        text!("operator-live-says")
    };
    if live.on_hover_text(says).clicked() {
        actions.push(Action::Live(LiveAction::Toggle));
    }
    let name = text!("operator-wrong-part");
    let wrong = Button::new(text(&name)).min_size(vec2(150.0, BUTTON));
    // While the part moves, it may be another one.
    let is_current = state.session.current_result().is_some();
    let wrong = ui.add_enabled(is_current, wrong);
    wrong.widget_info(|| WidgetInfo::labeled(egui::Role::Button, is_current, &name));
    if wrong
        .on_hover_text(text!("operator-wrong-part-says"))
        .on_disabled_hover_text(text!("operator-wrong-part-not-now"))
        .clicked()
    {
        actions.push(Action::WrongPart);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_library_gives_way_to_running_work_alone() {
        let forms = [60.0, 251.0, 481.0].map(|room| LibraryForm::of(room, true));
        let expected = [LibraryForm::Hidden, LibraryForm::Short, LibraryForm::Full];
        assert_eq!(forms, expected);
        assert_eq!(LibraryForm::of(60.0, false), LibraryForm::Full);
    }
}
