//! A row of tools: buttons in groups, on as many lines as they need.

use egui::{Button, RichText, TextWrapMode, Ui, Vec2, WidgetText};

use super::theme::{font, space};

/// Draws a button that can be the selected one of several.
pub fn choice(
    ui: &mut Ui,
    text: &str,
    label: &str,
    is_chosen: bool,
    is_enabled: bool,
) -> egui::Response {
    let button = Button::new(RichText::new(text).small()).selected(is_chosen);
    let button = button.min_size(Vec2::splat(space::TARGET));
    let response = ui.add_enabled(is_enabled, button);
    response.widget_info(|| {
        egui::WidgetInfo::selected(egui::Role::Button, is_enabled, is_chosen, label)
    });
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

/// Draws sets of groups, with as many sets on a line as fit; a set is never split.
pub fn tool_row<A>(ui: &mut Ui, sets: Vec<Vec<Vec<Tool<A>>>>, actions: &mut Vec<A>) {
    ui.spacing_mut().button_padding.x = 9.0;
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
            let Tool { text, label, .. } = &tool;
            let mut response = choice(ui, text, label, tool.is_chosen, tool.is_enabled);
            if let Some(hint) = tool.hint {
                response = response.on_hover_text(hint);
            }
            if response.clicked() {
                actions.push(tool.action);
            }
        }
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
