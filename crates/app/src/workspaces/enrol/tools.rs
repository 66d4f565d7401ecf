//! The tools that correct the draft: initial selection, boxes and lassos, segments, undo.

use egui::{RichText, ScrollArea, Ui};

use super::{
    EnrolAction, EnrolState,
    draft::Draft,
    segments::PointAction,
    selection::{Edit, OutlineMode},
    subject::InitialSelection,
};
use crate::workspaces::enrol::state::DraftPanes;
use ui::{
    language::text,
    tool_row::{Tool, choice, tool_row},
    viewport::DrawnShape,
    widgets::grouped,
};

/// Draws the tools.
pub(super) fn ui(ui: &mut Ui, draft: &Draft, enrol: &EnrolState, actions: &mut Vec<EnrolAction>) {
    let can_correct = draft.subject.can_be_corrected();
    let sets = vec![
        vec![initial(draft)],
        vec![steps(draft, enrol)],
        vec![drawing(enrol, can_correct), modes(enrol, can_correct)],
        vec![panes(enrol)],
    ];
    tool_row(ui, sets, actions);
    if !can_correct {
        ui.label(RichText::new(text!("enrol-mesh-is-whole")).small().weak());
    }
}

/// Choices of the initial selection; none for a scan, as the shots vote on what is the part.
fn initial(draft: &Draft) -> Vec<Tool<EnrolAction>> {
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

/// Choices of what a drag does.
fn drawing(enrol: &EnrolState, can_correct: bool) -> Vec<Tool<EnrolAction>> {
    [
        (text!("view-rotate"), text!("view-rotate-hint"), None),
        (
            text!("enrol-box"),
            text!("enrol-box-hint"),
            Some(DrawnShape::Box),
        ),
        (
            text!("view-lasso"),
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

/// Choices of what a drawn outline does.
fn modes(enrol: &EnrolState, can_correct: bool) -> Vec<Tool<EnrolAction>> {
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

/// Undo, Redo and Reset.
fn steps(draft: &Draft, enrol: &EnrolState) -> Vec<Tool<EnrolAction>> {
    [
        (
            text!("shell-undo"),
            text!("enrol-undo-step"),
            enrol.next_undo().is_some(),
            EnrolAction::Undo,
        ),
        (
            text!("shell-redo"),
            text!("enrol-redo-step"),
            !enrol.steps.undone.is_empty(),
            EnrolAction::Redo,
        ),
        (
            text!("shell-reset"),
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

/// Choices of the panes.
fn panes(enrol: &EnrolState) -> Vec<Tool<EnrolAction>> {
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

/// Draws the segments, each with its size and state; a click keeps or drops it.
pub(super) fn segments(ui: &mut Ui, draft: &Draft, actions: &mut Vec<EnrolAction>) {
    if !draft.subject.can_be_corrected() {
        return;
    }
    let segments = draft.subject.segments(draft.corrections.taking);
    // The vertical wheel scrolls it as well.
    ui.style_mut().always_scroll_the_only_direction = true;
    // Until another choice has been applied, the selection is that of the former one.
    let kept_of = |index: usize| draft.selection.kept_of.get(index).copied().unwrap_or(0);
    ScrollArea::horizontal()
        .auto_shrink([false, true])
        .show(ui, |ui| {
            ui.horizontal(|ui| {
                for (index, segment) in segments.list.iter().enumerate() {
                    let num_kept = kept_of(index);
                    let (title, all) = (segment.title.shown(), grouped(segment.num_points));
                    let (word, text) = if num_kept == 0 {
                        let word = text!("enrol-dropped");
                        let text = format!("{title} · {all} · {word}");
                        (word, text)
                    } else if num_kept < segment.num_points {
                        let kept = grouped(num_kept);
                        let text = text!(
                            "enrol-segment-partly",
                            segment = &title,
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
                        let edit = Edit::Segment(index, fate);
                        actions.push(EnrolAction::Correct(edit));
                    }
                }
            });
        });
}
