//! Above the view: pattern of the rows, effect of a drag, undo, colours.

use egui::Ui;

use super::{
    region::{EditKind, PaintTool, RegionUse},
    state::PaintState,
};
use crate::workspaces::paint::state::PaintAction;
use inspection::pipeline::parameters::Parameter;
use robot::paint::Coat;
use ui::{
    language::{parameters, text},
    parameter_control::ParameterChange,
    tool_row::{Tool, tool_row},
    viewport::DrawnShape,
};

/// Draws the tools.
pub(super) fn ui(ui: &mut Ui, paint: &PaintState, actions: &mut Vec<PaintAction>) {
    let sets = vec![
        vec![patterns(paint)],
        vec![steps(paint), colours(paint)],
        vec![regions(paint)],
        vec![edits(paint)],
    ];
    tool_row(ui, sets, actions);
}

/// Choices of the pattern of the rows, the coat's parameter changed most often.
fn patterns(paint: &PaintState) -> Vec<Tool<PaintAction>> {
    const KEY: &str = "pattern";
    let Some(parameter) = Parameter::<Coat>::of_key(KEY) else {
        return Vec::new();
    };
    let chosen = parameter.value(&paint.design.coat) as usize;
    let options = parameters::options(parameter).into_iter().enumerate();
    let each = options.map(|(index, option)| Tool {
        label: format!("{}: {option}", parameters::name(parameter)),
        text: option,
        hint: Some(parameters::help(parameter)),
        is_chosen: index == chosen,
        is_enabled: true,
        action: PaintAction::Change(KEY, ParameterChange::Set(index as f64)),
    });
    each.collect()
}

/// Tools by which a drag turns the view or draws a region.
fn regions(paint: &PaintState) -> Vec<Tool<PaintAction>> {
    let keep_out = text!("paint-keep-out-hint");
    let only = text!("paint-only-hint");
    let lasso = text!("view-lasso");
    let tools = [
        (
            text!("view-rotate"),
            text!("view-rotate"),
            text!("view-rotate-hint"),
            PaintTool::Look,
        ),
        (
            text!("paint-keep-out-box"),
            text!("paint-keep-out-box"),
            keep_out.clone(),
            PaintTool::Outline(DrawnShape::Box, RegionUse::KeepOut),
        ),
        (
            lasso.clone(),
            text!("paint-keep-out-lasso"),
            keep_out,
            PaintTool::Outline(DrawnShape::Lasso, RegionUse::KeepOut),
        ),
        (
            text!("paint-brush"),
            text!("paint-keep-out-brush"),
            text!("paint-brush-hint"),
            PaintTool::Brush,
        ),
        (
            text!("paint-only-box"),
            text!("paint-only-box"),
            only.clone(),
            PaintTool::Outline(DrawnShape::Box, RegionUse::PaintOnly),
        ),
        (
            lasso,
            text!("paint-only-lasso"),
            only,
            PaintTool::Outline(DrawnShape::Lasso, RegionUse::PaintOnly),
        ),
    ];
    tools.map(|tool| drag_tool(paint, tool)).into()
}

/// Tools by which a drag corrects the path, and the one that clears corrections and regions.
fn edits(paint: &PaintState) -> Vec<Tool<PaintAction>> {
    let tools = [
        (
            text!("paint-move-stroke"),
            text!("paint-move-stroke"),
            text!("paint-move-stroke-hint"),
            PaintTool::Edit(EditKind::Stroke),
        ),
        (
            text!("paint-point"),
            text!("paint-move-point"),
            text!("paint-move-point-hint"),
            PaintTool::Edit(EditKind::Point),
        ),
        (
            text!("paint-turn-gun"),
            text!("paint-turn-gun"),
            text!("paint-turn-gun-hint"),
            PaintTool::Edit(EditKind::Turn),
        ),
    ];
    let mut each: Vec<_> = tools.map(|tool| drag_tool(paint, tool)).into();
    let clear = text!("paint-clear");
    each.push(Tool {
        label: clear.clone(),
        text: clear,
        hint: Some(text!("paint-clear-hint")),
        is_chosen: false,
        is_enabled: paint.design.is_drawn_on(),
        action: PaintAction::Clear,
    });
    each
}

/// Makes a tool of its text, its label, its hint and the effect of a drag.
fn drag_tool(
    paint: &PaintState,
    (text, label, hint, tool): (String, String, String, PaintTool),
) -> Tool<PaintAction> {
    Tool {
        text,
        label,
        hint: Some(hint),
        is_chosen: paint.tool == tool,
        is_enabled: paint.planned.is_some(),
        action: PaintAction::Use(tool),
    }
}

/// Undo and Redo.
fn steps(paint: &PaintState) -> Vec<Tool<PaintAction>> {
    let [can_undo, can_redo] = paint.can_undo();
    [
        (text!("shell-undo"), can_undo, PaintAction::Undo),
        (text!("shell-redo"), can_redo, PaintAction::Redo),
    ]
    .into_iter()
    .map(|(text, is_enabled, action)| Tool {
        label: text.clone(),
        text,
        hint: None,
        is_chosen: false,
        is_enabled,
        action,
    })
    .collect()
}

/// Choice of the colours of the part.
fn colours(paint: &PaintState) -> Vec<Tool<PaintAction>> {
    let text = text!("paint-film-colours");
    vec![Tool {
        label: text.clone(),
        text,
        hint: Some(text!("paint-film-colours-hint")),
        is_chosen: paint.is_film_shown,
        is_enabled: true,
        action: PaintAction::ToggleFilm,
    }]
}
