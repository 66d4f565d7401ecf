//! Below the views: the plot, which is also the scrubber, and playback.

use egui::{Align, Color32, Id, Label, Layout, RichText, Sense, Ui, vec2};

use super::{playback::MethodComparison, plot, state::AlignState};
use crate::workspaces::align::state::AlignAction;
use ui::{
    language::text,
    scrubber::{Playback, Scrubber, ScrubberInput},
    theme::{font, space},
    widgets::focus_ring,
};

/// Iterations moved by Page Up and Page Down.
const PAGE: f32 = 10.0;

/// Draws heading and plot.
pub(super) fn ui(ui: &mut Ui, align: &AlignState, actions: &mut Vec<AlignAction>) {
    let Some(shown) = align
        .shown
        .as_ref()
        .filter(|shown| shown.last_iteration() > 0)
    else {
        none(ui, align);
        return;
    };
    if align.playback == Playback::Playing {
        let seconds = ui.input(|input| input.stable_dt).min(0.1);
        actions.push(AlignAction::Advance(seconds));
        ui.request_repaint();
    }
    heading(ui, shown, align, actions);
    if align.is_pair_at_work() && align.coming.is_some() {
        ui.multiply_opacity(0.55);
    }
    let rect = ui.available_rect_before_wrap();
    let id = Id::unique("iteration scrubber");
    let sense = Sense::click_and_drag() | Sense::FOCUSABLE;
    let response = ui.interact(rect, id, sense);
    ui.allocate_rect(rect, Sense::hover());
    let drawn = plot::show(ui, rect, shown, align.iteration);
    if response.clicked() || response.drag_started() {
        response.request_focus();
    }
    if (response.clicked() || response.dragged())
        && let Some(at) = response.interact_pointer_pos()
    {
        let iteration = drawn.value_from_position(at).x.round() as f32;
        actions.push(AlignAction::Scrub(iteration));
    }
    let last = align.last_iteration() as f32;
    let scrubber = Scrubber {
        label: text!("align-scrubber"),
        keys: text!("align-scrubber-keys"),
        position: f64::from(align.iteration.round()),
        last: f64::from(last),
    };
    for input in scrubber.input(ui, &response) {
        actions.push(match input {
            ScrubberInput::First => AlignAction::Scrub(0.0),
            ScrubberInput::Last => AlignAction::Scrub(last),
            ScrubberInput::Steps(steps) => AlignAction::Step(steps as f32),
            ScrubberInput::Pages(pages) => AlignAction::Step(PAGE * pages as f32),
            ScrubberInput::TogglePlay => AlignAction::TogglePlay,
        });
    }
    focus_ring(ui, rect, &response);
}

fn heading(
    ui: &mut Ui,
    shown: &MethodComparison,
    align: &AlignState,
    actions: &mut Vec<AlignAction>,
) {
    let name = "E(R, t), m²";
    let title = shown.pair.title();
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if align.playback.button(ui) {
                actions.push(AlignAction::TogglePlay);
            }
            let (iteration, last) = (align.iteration.round() as usize, shown.last_iteration());
            let mut text = text!("align-iteration-hint", iteration = iteration, last = last);
            let width = |text: &str, font| {
                let painter = ui.painter();
                let galley = painter.layout_no_wrap(text.to_owned(), font, Color32::PLACEHOLDER);
                galley.size().x + space::LARGE
            };
            let texts = [
                (name, font::body_strong()),
                (title.as_str(), font::small()),
                (text.as_str(), font::small()),
            ];
            let needed: f32 = texts.map(|(text, font)| width(text, font)).iter().sum();
            if needed > ui.available_width() {
                text = text!("align-iteration", iteration = iteration, last = last);
            }
            ui.label(RichText::new(text).small().weak());
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.label(RichText::new(name).font(font::body_strong()));
                ui.add(Label::new(RichText::new(&title).small().weak()).truncate());
            });
        });
    });
}

/// Draws the panel before there is a curve.
fn none(ui: &mut Ui, align: &AlignState) {
    ui.label(RichText::new("E(R, t), m²").font(font::body_strong()));
    let text = explanation(align);
    let middle = ui.available_height() / 2.0 - space::TARGET;
    ui.add_space(middle.max(0.0));
    ui.vertical_centered(|ui| {
        ui.set_max_width(ui.available_width().min(520.0));
        ui.weak(text);
        ui.allocate_space(vec2(0.0, 0.0));
    });
}

/// Explains why there is no curve.
pub(super) fn explanation(align: &AlignState) -> String {
    match &align.shown {
        // The next method may find a pose.
        Some(_) if align.is_pair_at_work() => text!("align-aligning-now"),
        Some(_) => text!("align-no-way"),
        None => text!("align-way"),
    }
}
