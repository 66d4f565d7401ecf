//! Help: keys and actions, the guide, what this program and computer are, problem reports, and a search over keys, actions and the
//! guide.

mod about;
mod guide;
mod markdown;
pub mod report;
mod state;

use egui::{
    Align, Context, Grid, Key, Layout, Modifiers, RichText, ScrollArea, Ui, Vec2, WidgetInfo, vec2,
};

pub use self::state::{GuidePlace, Help, HelpPage, Installation};
use crate::{
    action::Action,
    frame::keys::{self, KeyLine},
    state::State,
};
use ui::{
    key_binding::KeyBinding,
    language::text,
    theme::{font, space},
    widgets::{self, line_edit, value_button},
};

/// Width of the dialog, logical pixels.
const WIDTH: f32 = 940.0;
/// Part of the window's width and height that the pages leave free: for tabs, button, edges, and a notice above them, logical pixels.
const MARGINS: [f32; 2] = [80.0, 250.0];
/// Width of the search field, logical pixels.
const SEARCH_WIDTH: f32 = 290.0;

/// Draws Help while it is open; `own` are the keys of the workspace in front.
pub fn ui(ctx: &Context, state: &State, own: &[KeyBinding], actions: &mut Vec<Action>) {
    let Some(known) = &state.help else {
        return;
    };
    let mut help = known.clone();
    let window = ctx.content_rect().size();
    let size = vec2(WIDTH.min(window.x - MARGINS[0]), window.y - MARGINS[1]);
    // A window may have no size, and egui takes no negative one.
    let size = size.max(Vec2::ZERO);
    let modal = widgets::dialog(ctx, "help", |ui| {
        ui.set_width(size.x);
        top(ui, &mut help);
        ui.separator();
        let drawn = ui.allocate_ui_with_layout(size, Layout::top_down(Align::Min), |ui| {
            ui.set_min_size(size);
            // The scroll bar is beside what it scrolls, not over it.
            ui.spacing_mut().scroll.floating_allocated_width = space::MEDIUM;
            if help.is_searching() {
                let lines = keys::lines(state, own).into_iter();
                let lines = lines.chain(keys::without_keys(state)).collect();
                return results(ui, lines, &mut help);
            }
            page(ui, state, own, &mut help, actions);
            None
        });
        ui.separator();
        let is_closed = widgets::default_button(ui, &text!("shell-close"), true);
        (is_closed, drawn.inner)
    });
    let is_closing = modal.should_close();
    let (is_closed, action) = modal.inner;
    let is_pressed_again = || ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::F1));
    let is_over = is_closed || is_closing || action.is_some() || is_pressed_again();
    help.is_drawn = true;
    if help != *known {
        actions.push(Action::EditHelp(help));
    }
    if is_over {
        actions.push(Action::ToggleHelp);
    }
    actions.extend(action);
}

/// Draws the names of the pages, and the search.
fn top(ui: &mut Ui, help: &mut Help) {
    ui.horizontal(|ui| {
        let mut front = (!help.is_searching()).then_some(help.page);
        for page in HelpPage::ALL {
            value_button(ui, &mut front, Some(page), page.title());
        }
        if let Some(page) = front {
            help.page = page;
            help.search.clear();
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let width = SEARCH_WIDTH.min(ui.available_width());
            let label = text!("help-search");
            let field = ui.add(line_edit(&mut help.search, label.clone(), width));
            field.widget_info(|| WidgetInfo::labeled(egui::Role::TextInput, true, &label));
            if !help.is_drawn {
                field.request_focus();
            }
        });
    });
}

/// Draws the page in front.
fn page(
    ui: &mut Ui,
    state: &State,
    own: &[KeyBinding],
    help: &mut Help,
    actions: &mut Vec<Action>,
) {
    match help.page {
        HelpPage::Shortcuts => scrolled(ui, "shortcuts", |ui| {
            shortcuts(ui, &keys::lines(state, own));
        }),
        HelpPage::Guide => guide::ui(ui, &mut help.place),
        HelpPage::About => scrolled(ui, "about", |ui| about::ui(ui, state, actions)),
        HelpPage::Report => scrolled(ui, "report", |ui| report::ui(ui, state, actions)),
    }
}

/// Draws what scrolls in all the room that there is.
fn scrolled<R>(ui: &mut Ui, name: &str, content: impl FnOnce(&mut Ui) -> R) -> R {
    let height = ui.available_height();
    let area = ScrollArea::vertical().id_salt(name).max_height(height);
    let area = area.min_scrolled_height(height).auto_shrink([false, true]);
    area.show(ui, content).inner
}

fn shortcuts(ui: &mut Ui, lines: &[KeyLine]) {
    ui.spacing_mut().interact_size.y = 24.0;
    let grid = Grid::new("shortcuts").num_columns(2);
    grid.spacing(vec2(24.0, 6.0)).show(ui, |ui| {
        for KeyLine { keys, does, .. } in lines {
            ui.label(RichText::new(keys).font(font::body_strong()));
            ui.weak(does);
            ui.end_row();
        }
    });
}

/// Draws the keys, actions and sections of the guide that were found; returns the action that was pressed.
fn results(ui: &mut Ui, lines: Vec<KeyLine>, help: &mut Help) -> Option<Action> {
    let folded = help.search.to_lowercase();
    let words: Vec<&str> = folded.split_whitespace().collect();
    let is_found = |line: &KeyLine| {
        let text = format!("{} {}", line.keys, line.does).to_lowercase();
        words.iter().all(|word| text.contains(word))
    };
    let lines: Vec<KeyLine> = lines.into_iter().filter(is_found).collect();
    let of_guide = guide::found(ui, &help.search);
    let mut done = None;
    scrolled(ui, "found", |ui| {
        if lines.is_empty() && of_guide.is_empty() {
            ui.weak(text!("help-nothing-found"));
        }
        if !lines.is_empty() {
            widgets::heading(ui, &text!("help-keys-and-actions"));
        }
        for KeyLine { keys, does, action } in lines {
            ui.horizontal(|ui| {
                ui.spacing_mut().interact_size.y = 24.0;
                if !keys.is_empty() {
                    ui.label(RichText::new(keys).font(font::body_strong()));
                }
                match action {
                    None => {
                        ui.label(does);
                    }
                    Some(action) => {
                        if ui.link(does).clicked() {
                            done = Some(action);
                        }
                    }
                }
            });
        }
        if !of_guide.is_empty() {
            widgets::heading(ui, &text!("help-guide"));
        }
        if let Some(place) = guide::results(ui, &of_guide) {
            *help = Help {
                page: HelpPage::Guide,
                place,
                ..Help::default()
            };
        }
    });
    done
}
