//! Tools, which are buttons in groups on as many lines as they need, and tabs.

use egui::{
    Align2, Button, FontId, RichText, Role, Sense, TextWrapMode, Ui, Vec2, WidgetInfo, WidgetText,
    vec2,
};

use super::{
    theme::{Theme, font, space},
    widgets::{focus_ring, heading, text_width},
};

/// Draws a button that can be the selected one of several.
pub fn choice(
    ui: &mut Ui,
    text: &str,
    label: &str,
    is_chosen: bool,
    is_enabled: bool,
) -> egui::Response {
    let button = Button::new(RichText::new(text).small()).selected(is_chosen);
    // In a wrapped row it moves to the next line before its text breaks.
    let button = button.wrap_mode(TextWrapMode::Extend);
    let button = button.min_size(Vec2::splat(space::TARGET));
    let response = ui.add_enabled(is_enabled, button);
    response.widget_info(|| WidgetInfo::selected(Role::Button, is_enabled, is_chosen, label));
    response
}

/// One of the tools.
pub struct Tool<A> {
    /// Text on the button.
    pub text: String,
    /// Name for a screen reader.
    pub label: String,
    /// Tooltip that says what it does.
    pub hint: Option<String>,
    /// True for the selected one of several.
    pub is_chosen: bool,
    /// False if it does nothing now.
    pub is_enabled: bool,
    /// Caused by a press.
    pub action: A,
}

/// Room on either side of a tool's text, logical pixels.
const PADDING: f32 = 9.0;

/// Draws a group of tools below its title.
pub fn tool_group<A>(ui: &mut Ui, title: &str, tools: Vec<Tool<A>>, actions: &mut Vec<A>) {
    heading(ui, title);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().button_padding.x = PADDING;
        for tool in tools {
            tool_button(ui, tool, actions);
        }
    });
}

/// Draws sets of groups, with as many sets on a line as fit; a set is never split.
pub fn tool_row<A>(ui: &mut Ui, sets: Vec<Vec<Vec<Tool<A>>>>, actions: &mut Vec<A>) {
    ui.spacing_mut().button_padding.x = PADDING;
    let room = ui.available_width();
    let gap = space::MEDIUM + ui.spacing().item_spacing.x;
    let is_there = |set: &Vec<Vec<Tool<A>>>| set.iter().any(|group| !group.is_empty());
    let mut sets = sets.into_iter().filter(is_there).peekable();
    while let Some(first) = sets.next() {
        ui.horizontal(|ui| {
            let mut used = width(ui, &first, gap);
            buttons(ui, first, actions);
            while let Some(next) = sets.next_if(|next| used + gap + width(ui, next, gap) <= room) {
                used += gap + width(ui, &next, gap);
                ui.add_space(space::MEDIUM);
                buttons(ui, next, actions);
            }
        });
    }
}

fn buttons<A>(ui: &mut Ui, groups: Vec<Vec<Tool<A>>>, actions: &mut Vec<A>) {
    for (index, group) in groups.into_iter().enumerate() {
        if index > 0 {
            ui.add_space(space::MEDIUM);
        }
        for tool in group {
            tool_button(ui, tool, actions);
        }
    }
}

fn tool_button<A>(ui: &mut Ui, tool: Tool<A>, actions: &mut Vec<A>) {
    let Tool { text, label, .. } = &tool;
    let mut response = choice(ui, text, label, tool.is_chosen, tool.is_enabled);
    if let Some(hint) = tool.hint {
        response = response.on_hover_text(hint);
    }
    if response.clicked() {
        actions.push(tool.action);
    }
}

/// Returns the width of groups side by side, logical pixels.
fn width<A>(ui: &Ui, groups: &[Vec<Tool<A>>], gap: f32) -> f32 {
    let spacing = ui.spacing();
    let of_one = |tool: &Tool<A>| {
        let text = WidgetText::from(RichText::new(&tool.text).small());
        let wrap = Some(TextWrapMode::Extend);
        let galley = text.into_galley(ui, wrap, f32::INFINITY, font::small());
        (galley.size().x + 2.0 * spacing.button_padding.x).max(space::TARGET)
    };
    let of_group = |group: &Vec<Tool<A>>| {
        let gaps = spacing.item_spacing.x * (group.len() - 1) as f32;
        group.iter().map(of_one).sum::<f32>() + gaps
    };
    groups.iter().map(of_group).sum::<f32>() + gap * (groups.len() - 1) as f32
}

/// Draws tabs across all the room, each as wide as its title and an equal share of the rest. Returns the one that was pressed.
pub fn tab_row<T: Copy + PartialEq>(ui: &mut Ui, tabs: &[(T, String)], shown: T) -> Option<T> {
    let theme = Theme::of(ui);
    let room = ui.available_width();
    let widths_in = |font: &FontId| -> Vec<f32> {
        let titles = tabs.iter().map(|(_, title)| title);
        titles
            .map(|title| text_width(ui.painter(), title, font))
            .collect()
    };
    let rest = |widths: &[f32]| (room - widths.iter().sum::<f32>()) / tabs.len() as f32;
    let (mut typeface, mut widths) = (font::body(), widths_in(&font::body()));
    // Long titles would touch each other.
    if rest(&widths) < 2.0 * space::MEDIUM {
        (typeface, widths) = (font::small(), widths_in(&font::small()));
    }
    let rest = rest(&widths);
    let mut pressed = None;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        for ((tab, title), width) in tabs.iter().zip(widths) {
            let size = vec2((width + rest).max(0.0), space::TARGET);
            let (rect, response) = ui.allocate_exact_size(size, Sense::click());
            let is_shown = *tab == shown;
            let colour = if is_shown || response.hovered() {
                theme.text
            } else {
                theme.weak_text
            };
            let painter = ui.painter();
            let middle = rect.center();
            painter.text(
                middle,
                Align2::CENTER_CENTER,
                title,
                typeface.clone(),
                colour,
            );
            if is_shown {
                let bar = rect.with_min_y(rect.bottom() - 3.0);
                painter.rect_filled(bar, 0.0, theme.accent);
            }
            focus_ring(ui, rect, &response);
            response.widget_info(|| WidgetInfo::selected(Role::Tab, true, is_shown, title));
            if response.clicked() {
                pressed = Some(*tab);
            }
        }
    });
    pressed
}
