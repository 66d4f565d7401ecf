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
use crate::app::{
    language::text,
    ui::{
        theme::{Theme, font, space},
        widgets::grouped,
    },
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
        let text = text!("enrol-mesh-is-whole");
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
        if choice(ui, &title, &title, is_chosen, is_allowed).clicked() {
            actions.push(EnrolAction::TakeAs(taking));
        }
    }
    if !is_scan {
        ui.add_space(space::MEDIUM);
    }
    for mode in BoxMode::ALL {
        let is_chosen = enrol.box_mode == mode && can_correct;
        let title = mode.title();
        let response = choice(ui, &title, &title, is_chosen, can_correct);
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
            text!("enrol-undo"),
            text!("enrol-undo-step"),
            !steps.done.is_empty(),
            EnrolAction::Undo,
        ),
        (
            text!("enrol-redo"),
            text!("enrol-redo-step"),
            !steps.undone.is_empty(),
            EnrolAction::Redo,
        ),
        (
            text!("enrol-reset"),
            text!("enrol-reset-all"),
            has_edits,
            EnrolAction::Reset,
        ),
    ] {
        if choice(ui, &text, &label, false, is_enabled).clicked() {
            actions.push(action);
        }
    }
    ui.add_space(space::MEDIUM);
    for panes in DraftPanes::ALL {
        let is_chosen = enrol.panes() == panes;
        if choice(ui, &panes.title(), &panes.label(), is_chosen, true).clicked() {
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
                    let (title, all) = (&segment.title, grouped(segment.num_points));
                    let (word, text) = if num_kept == 0 {
                        let word = text!("enrol-dropped");
                        let text = format!("{title} · {all} · {word}");
                        (word, text)
                    } else if num_kept < segment.num_points {
                        let kept = grouped(num_kept);
                        let text = text!(
                            "enrol-segment-partly",
                            segment = title,
                            kept = kept,
                            all = all
                        );
                        (text!("enrol-partly-kept"), text)
                    } else {
                        let word = text!("enrol-kept");
                        let text = format!("{title} · {all} · {word}");
                        (word, text)
                    };
                    let label = format!("{title}, {word}");
                    let response = choice(ui, &text, &label, num_kept > 0, true);
                    if response.gained_focus() {
                        response.scroll_to_me(None);
                    }
                    let (hint, fate) = match num_kept {
                        0 => (text!("enrol-take-it"), PointAction::Kept),
                        _ => (text!("enrol-drop-it"), PointAction::Dropped),
                    };
                    if response.on_hover_text(hint).clicked() {
                        let edit = Edit::Segment(place, fate);
                        actions.push(EnrolAction::Correct(edit));
                    }
                }
            });
        });
}
