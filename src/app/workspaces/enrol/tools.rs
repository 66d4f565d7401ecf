//! What corrects the draft: how it is taken, boxes and lassos, segments, undo.

use egui::{Button, RichText, ScrollArea, TextWrapMode, Ui, Vec2, WidgetText};

use super::{
    EnrolAction, EnrolState,
    action::DraftPanes,
    draft::Draft,
    segments::PointAction,
    selection::{Edit, OutlineMode},
    subject::InitialSelection,
};
use crate::app::{
    language::text,
    ui::{
        theme::{Theme, font, space},
        viewport::DrawnShape,
        widgets::grouped,
    },
};

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

/// One of the tools.
struct Tool {
    text: String,
    label: String,
    hint: Option<String>,
    is_chosen: bool,
    is_enabled: bool,
    action: EnrolAction,
}

/// Draws the tools: as many in a row as there is room for, and those together that are used together.
pub(super) fn ui(
    ui: &mut Ui,
    draft: &Draft,
    enrol: &EnrolState,
    theme: &Theme,
    actions: &mut Vec<EnrolAction>,
) {
    let can_correct = draft.subject.can_be_corrected();
    ui.spacing_mut().button_padding.x = 9.0;
    let room = ui.available_width();
    let sets = [
        vec![initial(draft)],
        vec![steps(draft, enrol)],
        vec![drawing(enrol, can_correct), modes(enrol, can_correct)],
        vec![panes(enrol)],
    ];
    let gap = space::MEDIUM + ui.spacing().item_spacing.x;
    let is_there = |set: &Vec<Vec<Tool>>| set.iter().any(|group| !group.is_empty());
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
    if !can_correct {
        let text = text!("enrol-mesh-is-whole");
        ui.label(
            RichText::new(text)
                .font(font::small())
                .color(theme.weak_text),
        );
    }
}

fn buttons(ui: &mut Ui, groups: Vec<Vec<Tool>>, actions: &mut Vec<EnrolAction>) {
    for (place, group) in groups.into_iter().enumerate() {
        if place > 0 {
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

/// How wide groups are side by side, logical pixels.
fn width(ui: &Ui, groups: &[Vec<Tool>], gap: f32) -> f32 {
    let spacing = ui.spacing();
    let of_one = |tool: &Tool| {
        let text = WidgetText::from(RichText::new(&tool.text).font(font::small()));
        let wrap = Some(TextWrapMode::Extend);
        let galley = text.into_galley(ui, wrap, f32::INFINITY, font::small());
        (galley.size().x + 2.0 * spacing.button_padding.x).max(space::TARGET)
    };
    let of_group = |group: &Vec<Tool>| {
        let gaps = spacing.item_spacing.x * (group.len() - 1) as f32;
        group.iter().map(of_one).sum::<f32>() + gaps
    };
    groups.iter().map(of_group).sum::<f32>() + gap * (groups.len() - 1) as f32
}

/// How the draft is taken. The shots have voted what of a scan is the part.
fn initial(draft: &Draft) -> Vec<Tool> {
    let is_scan = draft.subject.scan().is_some();
    let all = InitialSelection::ALL.into_iter().filter(|_| !is_scan);
    all.map(|taking| Tool {
        text: taking.title(),
        label: taking.title(),
        hint: None,
        is_chosen: draft.corrections.taking == taking,
        is_enabled: draft.subject.allows(taking),
        action: EnrolAction::TakeAs(taking),
    })
    .collect()
}

/// What a drag does.
fn drawing(enrol: &EnrolState, can_correct: bool) -> Vec<Tool> {
    [
        (text!("enrol-rotate"), text!("enrol-rotate-hint"), None),
        (
            text!("enrol-box"),
            text!("enrol-box-hint"),
            Some(DrawnShape::Box),
        ),
        (
            text!("enrol-lasso"),
            text!("enrol-lasso-hint"),
            Some(DrawnShape::Lasso),
        ),
    ]
    .into_iter()
    .map(|(text, hint, shape)| Tool {
        text: text.clone(),
        label: text,
        hint: Some(hint),
        is_chosen: enrol.shape == shape && can_correct,
        is_enabled: can_correct,
        action: EnrolAction::Draw(shape),
    })
    .collect()
}

/// What becomes of what is drawn around.
fn modes(enrol: &EnrolState, can_correct: bool) -> Vec<Tool> {
    let all = OutlineMode::ALL.into_iter();
    all.map(|mode| Tool {
        text: mode.title(),
        label: mode.title(),
        hint: Some(mode.explanation()),
        is_chosen: enrol.outline_mode == mode && can_correct,
        is_enabled: can_correct,
        action: EnrolAction::OutlineMode(mode),
    })
    .collect()
}

/// Back and forth.
fn steps(draft: &Draft, enrol: &EnrolState) -> Vec<Tool> {
    let steps = &enrol.steps;
    [
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
            !draft.corrections.edits.is_empty(),
            EnrolAction::Reset,
        ),
    ]
    .into_iter()
    .map(|(text, label, is_enabled, action)| Tool {
        text,
        label,
        hint: None,
        is_chosen: false,
        is_enabled,
        action,
    })
    .collect()
}

/// What is shown.
fn panes(enrol: &EnrolState) -> Vec<Tool> {
    let all = DraftPanes::ALL.into_iter();
    all.map(|panes| Tool {
        text: panes.title(),
        label: panes.label(),
        hint: None,
        is_chosen: enrol.panes() == panes,
        is_enabled: true,
        action: EnrolAction::Panes(panes),
    })
    .collect()
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
