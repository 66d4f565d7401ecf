//! What corrects the draft: how it is taken, boxes, segments, undo.

use egui::{Button, RichText, ScrollArea, Ui, Vec2};

use super::{
    EnrolAction, EnrolState,
    action::DraftPanes,
    draft::Draft,
    segments::PointAction,
    selection::{BoxMode, Edit},
    subject::InitialSelection,
};
use crate::app::ui::{
    theme::{Theme, font, space},
    widgets::grouped,
};

/// From this width on all tools stand in one row, logical pixels.
const ONE_ROW: f32 = 860.0;

/// A button that can be the chosen one of several.
fn choice(
    ui: &mut Ui,
    text: &str,
    label: &str,
    is_chosen: bool,
    is_enabled: bool,
) -> egui::Response {
    let button = Button::new(RichText::new(text).font(font::small())).selected(is_chosen);
    let button = button.min_size(Vec2::splat(space::TARGET));
    let response = ui.add_enabled(is_enabled, button);
    response.widget_info(|| {
        egui::WidgetInfo::selected(egui::Role::Button, is_enabled, is_chosen, label)
    });
    response
}

/// Draws the tools.
pub(super) fn ui(
    ui: &mut Ui,
    draft: &Draft,
    enrol: &EnrolState,
    theme: &Theme,
    actions: &mut Vec<EnrolAction>,
) {
    let can_correct = draft.subject.can_be_corrected();
    ui.spacing_mut().button_padding.x = 9.0;
    let is_wide = ui.available_width() > ONE_ROW;
    ui.horizontal(|ui| {
        boxes(ui, draft, enrol, actions);
        if is_wide {
            ui.add_space(space::MEDIUM);
            steps(ui, draft, enrol, actions);
        }
    });
    if !is_wide {
        ui.horizontal(|ui| steps(ui, draft, enrol, actions));
    }
    if !can_correct {
        let text = "A mesh is enrolled whole: crop it in the program that made it";
        ui.label(
            RichText::new(text)
                .font(font::small())
                .color(theme.weak_text),
        );
    }
}

/// How it is taken, and what a box does.
fn boxes(ui: &mut Ui, draft: &Draft, enrol: &EnrolState, actions: &mut Vec<EnrolAction>) {
    let can_correct = draft.subject.can_be_corrected();
    // The shots have voted what of a scan is the part.
    let is_scan = draft.subject.scan().is_some();
    for taking in InitialSelection::ALL.into_iter().filter(|_| !is_scan) {
        let is_chosen = draft.corrections.taking == taking;
        let is_allowed = draft.subject.allows(taking);
        let title = taking.title();
        if choice(ui, title, title, is_chosen, is_allowed).clicked() {
            actions.push(EnrolAction::TakeAs(taking));
        }
    }
    if !is_scan {
        ui.add_space(space::MEDIUM);
    }
    for mode in BoxMode::ALL {
        let is_chosen = enrol.box_mode == mode && can_correct;
        let response = choice(ui, mode.title(), mode.title(), is_chosen, can_correct);
        if response.on_hover_text(mode.explanation()).clicked() {
            actions.push(EnrolAction::BoxMode(mode));
        }
    }
}

/// Back and forth, and what is shown.
fn steps(ui: &mut Ui, draft: &Draft, enrol: &EnrolState, actions: &mut Vec<EnrolAction>) {
    let steps = &enrol.steps;
    let has_edits = !draft.corrections.edits.is_empty();
    for (text, label, is_enabled, action) in [
        (
            "Undo",
            "Undo the last step",
            !steps.done.is_empty(),
            EnrolAction::Undo,
        ),
        (
            "Redo",
            "Redo the last step",
            !steps.undone.is_empty(),
            EnrolAction::Redo,
        ),
        (
            "Reset",
            "Reset all corrections",
            has_edits,
            EnrolAction::Reset,
        ),
    ] {
        if choice(ui, text, label, false, is_enabled).clicked() {
            actions.push(action);
        }
    }
    ui.add_space(space::MEDIUM);
    for panes in DraftPanes::ALL {
        let is_chosen = enrol.panes() == panes;
        let label = format!("Show {}", panes.title().to_lowercase());
        if choice(ui, panes.title(), &label, is_chosen, true).clicked() {
            actions.push(EnrolAction::Panes(panes));
        }
    }
}

/// The segments, each with its size and what becomes of it; a press takes or drops it.
pub(super) fn segments(ui: &mut Ui, draft: &Draft, actions: &mut Vec<EnrolAction>) {
    if !draft.subject.can_be_corrected() {
        return;
    }
    let segments = draft.subject.segments(draft.corrections.taking);
    // A wheel turns it as well.
    ui.style_mut().always_scroll_the_only_direction = true;
    // While another choice is being gone through, the selection is of the former one.
    let kept_of = |place: usize| draft.selection.kept_of.get(place).copied().unwrap_or(0);
    ScrollArea::horizontal()
        .auto_shrink([false, true])
        .show(ui, |ui| {
            ui.horizontal(|ui| {
                for (place, segment) in segments.list.iter().enumerate() {
                    let num_kept = kept_of(place);
                    let (word, fate) = match num_kept {
                        0 => ("dropped", PointAction::Kept),
                        num if num < segment.num_points => ("partly kept", PointAction::Dropped),
                        _ => ("kept", PointAction::Dropped),
                    };
                    let all = grouped(segment.num_points);
                    let text = if word == "partly kept" {
                        format!("{} · {} of {all} kept", segment.title, grouped(num_kept))
                    } else {
                        format!("{} · {all} · {word}", segment.title)
                    };
                    let label = format!("{}, {word}", segment.title);
                    let response = choice(ui, &text, &label, num_kept > 0, true);
                    if response.gained_focus() {
                        response.scroll_to_me(None);
                    }
                    let hint = match fate {
                        PointAction::Kept => "Take it",
                        PointAction::Dropped => "Drop it",
                    };
                    if response.on_hover_text(hint).clicked() {
                        let edit = Edit::Segment(place, fate);
                        actions.push(EnrolAction::Correct(edit));
                    }
                }
            });
        });
}
