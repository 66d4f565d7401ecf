//! Above the workspaces: the top bar.

use egui::{
    Align, Button, Frame, Layout, Margin, Panel, Rect, RichText, Stroke, StrokeKind, Ui, Vec2,
};

use super::{
    action::{Action, Ask},
    shelf::LibraryShown,
    source::{CellChoice, file_name},
    state::{Source, StagePanel, State},
    theme::{ROUNDING, Theme, font, space},
};

/// Shows which hand-drawn control has the focus.
pub(super) fn focus_ring(ui: &Ui, rect: Rect, response: &egui::Response, theme: &Theme) {
    if response.has_focus() {
        let stroke = Stroke::new(2.0, theme.accent);
        ui.painter()
            .rect_stroke(rect.shrink(1.0), ROUNDING, stroke, StrokeKind::Inside);
    }
}

/// The bar at the top.
pub(super) fn top_bar(ui: &mut Ui, state: &State, theme: &Theme, actions: &mut Vec<Action>) {
    let frame = Frame::new()
        .fill(theme.panel)
        .inner_margin(Margin::symmetric(14, 0));
    Panel::top("top bar")
        .exact_size(space::TOP_BAR)
        .resizable(false)
        .frame(frame)
        .show(ui, |ui| {
            ui.horizontal_centered(|ui| {
                let name = RichText::new("Partsight").font(font::body_strong());
                ui.label(name);
                ui.add_space(space::LARGE);
                source_menu(ui, state, actions);
                let capture = RichText::new("Capture").font(font::body_strong());
                let key = RichText::new("Space").font(font::small());
                let capture = Button::new(capture.color(theme.on_accent))
                    .shortcut_text(key.color(theme.on_accent))
                    .fill(theme.accent);
                if labelled(ui, capture, "Capture").clicked() {
                    actions.push(Action::Capture);
                }
                let key = RichText::new("Ctrl O").font(font::small());
                let open = Button::new("Open…").shortcut_text(key.color(theme.weak_text));
                if labelled(ui, open, "Open…").clicked() {
                    actions.push(Action::Ask(Ask::Scene));
                }
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    settings(ui, state, theme, actions);
                    ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                        progress(ui, state, theme, actions);
                    });
                });
            });
        });
}

/// A button that is called by its text alone, whatever shortcut it shows.
pub(super) fn labelled(ui: &mut Ui, button: Button<'_>, label: &str) -> egui::Response {
    let response = ui.add(button.min_size(Vec2::splat(space::TARGET)));
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, label));
    response
}

fn source_menu(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    let now = match &state.source {
        Source::Cell(CellChoice::InTurn) => "Simulated cell".to_owned(),
        Source::Cell(choice) => format!("Simulated · {}", choice.title()),
        Source::File(path) => shortened(&file_name(path), 24),
    };
    ui.menu_button(format!("Source · {now} ▼"), |ui| {
        ui.set_min_width(220.0);
        ui.label(RichText::new("Simulated cell").font(font::heading()));
        for choice in CellChoice::all() {
            let is_chosen = state.source == Source::Cell(choice);
            if ui.selectable_label(is_chosen, choice.title()).clicked() {
                actions.push(Action::UseCell(choice));
                ui.close();
            }
        }
        ui.separator();
        if ui.button("Open a file…").clicked() {
            actions.push(Action::Ask(Ask::Scene));
            ui.close();
        }
        ui.separator();
        empty_cell_entries(ui, state, actions);
        if !state.recent.is_empty() {
            ui.label(RichText::new("Recent files").font(font::heading()));
        }
        for path in &state.recent {
            let is_chosen = matches!(&state.source, Source::File(file) if file == path);
            let name = shortened(&file_name(path), 34);
            let entry = ui.selectable_label(is_chosen, name);
            if entry.on_hover_text(path.display().to_string()).clicked() {
                actions.push(Action::Open(path.clone()));
                ui.close();
            }
        }
    })
    .response
    .on_hover_text("Where Capture takes a scene from");
}

/// Taking and forgetting the empty cell.
fn empty_cell_entries(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    ui.label(RichText::new("Empty cell").font(font::heading()));
    let take = Button::new("Take the empty cell");
    let take = ui.add_enabled(state.shown.is_some(), take).on_hover_text(
        "The scene in front shows the cell without a part: what stands in it is not taken for a part from now on",
    );
    if take.clicked() {
        actions.push(Action::TakeEmptyCell);
        ui.close();
    }
    let forget = Button::new("Forget the empty cell");
    if ui.add_enabled(state.empty_cell.is_some(), forget).clicked() {
        actions.push(Action::ForgetEmptyCell);
        ui.close();
    }
}

/// The text, its middle left out where it is too long.
pub(super) fn shortened(text: &str, most: usize) -> String {
    let letters: Vec<char> = text.chars().collect();
    if letters.len() <= most {
        return text.to_owned();
    }
    let half = most / 2;
    let (head, tail) = (&letters[..half], &letters[letters.len() - half..]);
    format!(
        "{}…{}",
        head.iter().collect::<String>(),
        tail.iter().collect::<String>()
    )
}

/// From right to left: help, colours, units, library.
fn settings(ui: &mut Ui, state: &State, theme: &Theme, actions: &mut Vec<Action>) {
    let key = RichText::new("F1").font(font::small());
    let help = Button::new("Help").shortcut_text(key.color(theme.weak_text));
    if labelled(ui, help, "Help").clicked() {
        actions.push(Action::ToggleHelp);
    }
    let other = state.theme.other().title().to_lowercase();
    let colours = labelled(ui, Button::new(state.theme.title()), state.theme.title());
    if colours
        .on_hover_text(format!("Change to {other} (T)"))
        .clicked()
    {
        actions.push(Action::SwitchTheme);
    }
    let units = labelled(ui, Button::new(state.units.title()), state.units.title());
    let other = state.units.other().title();
    if units
        .on_hover_text(format!("Change to {other} (U)"))
        .clicked()
    {
        actions.push(Action::SwitchUnits);
    }
    // What is at work, and the way out of it, come first.
    let has_room = state.work().is_none() || ui.available_width() > 480.0;
    if let Some(library) = state.library.as_ref().filter(|_| has_room) {
        library_menu(ui, state, library, actions);
    }
}

fn parts_word(num: usize) -> &'static str {
    if num == 1 { "part" } else { "parts" }
}

/// Which library is in use, and others to use.
fn library_menu(ui: &mut Ui, state: &State, library: &LibraryShown, actions: &mut Vec<Action>) {
    let num = library.parts.len();
    let text = if ui.available_width() > 300.0 {
        let name = shortened(&file_name(&library.path), 20);
        format!("{num} {} · {name} ▼", parts_word(num))
    } else {
        format!("{num} {} ▼", parts_word(num))
    };
    ui.menu_button(text, |ui| {
        ui.set_min_width(260.0);
        ui.label(RichText::new("Library in use").font(font::heading()));
        ui.label(library.path.display().to_string());
        ui.separator();
        if ui.button("Use another library…").clicked() {
            actions.push(Action::Ask(Ask::Library));
            ui.close();
        }
        if state.chosen_library.is_some() && ui.button("Use the usual library").clicked() {
            actions.push(Action::UseFoundLibrary);
            ui.close();
        }
    });
}

/// What is being worked on, and the way out.
fn progress(ui: &mut Ui, state: &State, theme: &Theme, actions: &mut Vec<Action>) {
    let Some((lane, work)) = state.work() else {
        return;
    };
    ui.add_space(space::SMALL);
    if labelled(ui, Button::new("Cancel"), "Cancel").clicked() {
        actions.push(Action::Cancel(lane));
    }
    ui.add(egui::Spinner::new().size(18.0).color(theme.accent));
    let text = match (work.progress, work.stage.map(StagePanel::of)) {
        (Some((done, total)), _) => format!("{} · {done} of {total}", shortened(&work.what, 28)),
        (None, Some(panel)) => {
            let place = StagePanel::ALL
                .iter()
                .position(|p| *p == panel)
                .unwrap_or(0)
                + 1;
            format!("{} · {place} of {}", panel.title(), StagePanel::ALL.len())
        }
        (None, None) => shortened(&work.what, 28),
    };
    ui.add(egui::Label::new(RichText::new(text).color(theme.weak_text)).truncate());
}
