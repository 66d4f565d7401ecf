//! Around the workspaces: the rail, the top bar, notices and the list of shortcuts.

use egui::{
    Align, Button, Frame, Id, Key, KeyboardShortcut, Layout, Margin, Modal, Modifiers, Panel, Rect,
    RichText, Sense, Stroke, StrokeKind, Ui, Vec2, vec2,
};

use super::{
    action::Action,
    state::{HelpPage, Source, StagePanel, State, Workspace},
    theme::{ROUNDING, Theme, font, space},
    widgets::{Mark, mark},
    work::{CellChoice, file_name},
};

/// A shortcut, what it causes, and how the list names both.
struct Shortcut {
    modifiers: Modifiers,
    key: Key,
    keys: &'static str,
    does: &'static str,
    action: fn() -> Action,
}

/// The shortcuts of the whole window.
const SHORTCUTS: [Shortcut; 7] = [
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::Space,
        keys: "Space",
        does: "Capture and inspect",
        action: || Action::Capture,
    },
    Shortcut {
        modifiers: Modifiers::COMMAND,
        key: Key::O,
        keys: "Ctrl O",
        does: "Open a captured scene",
        action: || Action::ChooseFile,
    },
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::Num1,
        keys: "1",
        does: "Inspect",
        action: || Action::GoTo(Workspace::Inspect),
    },
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::U,
        keys: "U",
        does: "Millimetres and degrees, or metres and radians",
        action: || Action::SwitchUnits,
    },
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::T,
        keys: "T",
        does: "Dark or light",
        action: || Action::SwitchTheme,
    },
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::F1,
        keys: "F1",
        does: "This list",
        action: || Action::ToggleHelp,
    },
    Shortcut {
        modifiers: Modifiers::NONE,
        key: Key::Escape,
        keys: "Esc",
        does: "Close the enlarged stage",
        action: || Action::CloseTop,
    },
];

/// Keys of the 3-D view and of the focus, for the list alone.
const OTHER_KEYS: [(&str, &str); 7] = [
    ("Tab, Enter", "Go to the next control, press it"),
    ("Arrow keys, left drag", "Turn the 3-D view"),
    ("Shift + those, right drag", "Shift it"),
    ("+ \u{2212}, wheel", "Zoom it"),
    ("F, Shift F", "Fit the part, fit everything"),
    ("Z, Y, X", "Look from the front, the top, the side"),
    ("M", "Measure between two clicked points"),
];

/// What the keys cause. Called after the panels, so that a focused control has its keys first.
///
/// The space bar presses a focused control; `space_is_free` says that what has the focus does not use it.
pub(super) fn shortcuts(ctx: &egui::Context, space_is_free: bool, actions: &mut Vec<Action>) {
    let is_pressing = !space_is_free && ctx.memory(|memory| memory.focused().is_some());
    for shortcut in &SHORTCUTS {
        // Space presses a focused control.
        if shortcut.key == Key::Space && is_pressing {
            continue;
        }
        let keys = KeyboardShortcut::new(shortcut.modifiers, shortcut.key);
        if ctx.input_mut(|input| input.consume_shortcut(&keys)) {
            actions.push((shortcut.action)());
        }
    }
}

/// The rail on the left.
pub(super) fn rail(ui: &mut Ui, state: &State, theme: &Theme, actions: &mut Vec<Action>) {
    let frame = Frame::new().fill(theme.panel);
    Panel::left("rail")
        .exact_size(space::RAIL)
        .resizable(false)
        .frame(frame)
        .show(ui, |ui| {
            for workspace in Workspace::ALL {
                let is_front = state.workspace == workspace;
                let size = vec2(ui.available_width(), space::RAIL);
                let (rect, response) = ui.allocate_exact_size(size, Sense::click());
                let painter = ui.painter();
                if is_front {
                    painter.rect_filled(rect, 0.0, theme.control);
                    let bar = Rect::from_min_size(rect.min, vec2(3.0, rect.height()));
                    painter.rect_filled(bar, 0.0, theme.accent);
                }
                let colour = if is_front {
                    theme.text
                } else {
                    theme.weak_text
                };
                let icon = rect.center() - vec2(0.0, 9.0);
                painter.circle_stroke(icon, 8.0, Stroke::new(1.6, colour));
                painter.circle_filled(icon, 2.4, colour);
                painter.text(
                    rect.center() + vec2(0.0, 14.0),
                    egui::Align2::CENTER_CENTER,
                    workspace.title(),
                    font::small(),
                    colour,
                );
                focus_ring(ui, rect, &response, theme);
                response.widget_info(|| {
                    let label = workspace.title();
                    egui::WidgetInfo::selected(egui::Role::Tab, true, is_front, label)
                });
                if response.clicked() {
                    actions.push(Action::GoTo(workspace));
                }
            }
        });
}

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
                    actions.push(Action::ChooseFile);
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
fn labelled(ui: &mut Ui, button: Button<'_>, label: &str) -> egui::Response {
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
            actions.push(Action::ChooseFile);
            ui.close();
        }
    })
    .response
    .on_hover_text("Where Capture takes a scene from");
}

/// The text, its middle left out where it is too long.
fn shortened(text: &str, most: usize) -> String {
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
    if let Some(library) = &state.library
        && ui.available_width() > 300.0
    {
        let num = library.titles.len();
        let text = format!("{num} parts · {}", shortened(&file_name(&library.path), 20));
        ui.label(RichText::new(text).color(theme.weak_text))
            .on_hover_text(library.path.display().to_string());
    }
}

/// What is being worked on, and the way out.
fn progress(ui: &mut Ui, state: &State, theme: &Theme, actions: &mut Vec<Action>) {
    let Some(work) = &state.work else {
        return;
    };
    ui.add_space(space::SMALL);
    if labelled(ui, Button::new("Cancel"), "Cancel").clicked() {
        actions.push(Action::Cancel);
    }
    ui.add(egui::Spinner::new().size(18.0).color(theme.accent));
    let text = match work.stage.map(StagePanel::of) {
        Some(panel) => {
            let place = StagePanel::ALL
                .iter()
                .position(|p| *p == panel)
                .unwrap_or(0)
                + 1;
            format!("{} · {place} of {}", panel.title(), StagePanel::ALL.len())
        }
        None => shortened(&work.what, 28),
    };
    ui.label(RichText::new(text).color(theme.weak_text));
}

/// What a person should know, one line each.
pub(super) fn notices(ui: &mut Ui, state: &State, theme: &Theme, actions: &mut Vec<Action>) {
    if state.notices.is_empty() {
        return;
    }
    let frame = Frame::new()
        .fill(theme.control)
        .inner_margin(Margin::symmetric(14, 4));
    Panel::top("notices")
        .resizable(false)
        .frame(frame)
        .show(ui, |ui| {
            for (place, notice) in state.notices.iter().enumerate() {
                ui.horizontal(|ui| {
                    ui.set_min_height(space::TARGET);
                    let (rect, _) = ui.allocate_exact_size(Vec2::splat(20.0), Sense::hover());
                    mark(ui.painter(), rect.center(), 9.0, Mark::Look, theme);
                    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                        if labelled(ui, Button::new("Dismiss"), "Dismiss").clicked() {
                            actions.push(Action::Dismiss(place));
                        }
                        ui.with_layout(
                            Layout::left_to_right(Align::Center).with_main_wrap(true),
                            |ui| {
                                ui.label(RichText::new(&notice.what).color(theme.text));
                                ui.label(RichText::new(&notice.advice).color(theme.warning));
                            },
                        );
                    });
                });
            }
        });
}

/// The list of shortcuts.
pub(super) fn help(ctx: &egui::Context, state: &State, theme: &Theme, actions: &mut Vec<Action>) {
    if state.help == HelpPage::Closed {
        return;
    }
    let modal = Modal::new(Id::unique("help"))
        .frame(Frame::window(&ctx.global_style()).inner_margin(Margin::same(18)))
        .show(ctx, |ui| {
            ui.set_max_width(520.0);
            let height = ui.spacing().interact_size.y;
            ui.spacing_mut().interact_size.y = 24.0;
            ui.label(
                RichText::new("Shortcuts")
                    .font(font::verdict())
                    .color(theme.text),
            );
            ui.add_space(space::SMALL);
            egui::Grid::new("shortcuts")
                .num_columns(2)
                .spacing(vec2(24.0, 6.0))
                .show(ui, |ui| {
                    let of_window = SHORTCUTS.iter().map(|s| (s.keys, s.does));
                    for (keys, does) in of_window.chain(OTHER_KEYS) {
                        ui.label(RichText::new(keys).font(font::body_strong()));
                        ui.label(RichText::new(does).color(theme.weak_text));
                        ui.end_row();
                    }
                });
            ui.spacing_mut().interact_size.y = height;
            ui.add_space(space::MEDIUM);
            labelled(ui, Button::new("Close"), "Close").clicked()
        });
    if modal.inner || modal.backdrop_response.clicked() {
        actions.push(Action::ToggleHelp);
    }
}
