//! The tools: steps and view above the view, the pattern and the regions in their tabs.

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
    theme::space,
    tool_row::{Tool, tool_group, tool_row},
    viewport::DrawnShape,
    widgets::button_if,
};

/// Key of the pattern, the parameter that is a group of tools.
pub(super) const PATTERN: &str = "pattern";

/// Draws the tools above the view.
pub(super) fn ui(ui: &mut Ui, paint: &PaintState, actions: &mut Vec<PaintAction>) {
    let sets = vec![vec![steps(paint)], vec![view_tools(paint)]];
    tool_row(ui, sets, actions);
}

/// Draws the choices of the pattern of the rows, the coat's parameter changed most often.
pub(super) fn pattern(ui: &mut Ui, paint: &PaintState, actions: &mut Vec<PaintAction>) {
    let Some(parameter) = Parameter::<Coat>::of_key(PATTERN) else {
        return;
    };
    let name = parameters::name(parameter);
    let chosen = parameter.value(&paint.design.coat) as usize;
    let options = parameters::options(parameter).into_iter().enumerate();
    let each = options.map(|(index, option)| Tool {
        label: format!("{name}: {option}"),
        text: option,
        hint: Some(parameters::help(parameter)),
        is_chosen: index == chosen,
        is_enabled: true,
        action: PaintAction::Change(PATTERN, ParameterChange::Set(index as f64)),
    });
    tool_group(ui, &name, each.collect(), actions);
}

/// Draws the tab of the regions: tools by which a drag draws a region or corrects the path, and the button that removes both.
pub(super) fn regions(ui: &mut Ui, paint: &PaintState, actions: &mut Vec<PaintAction>) {
    tool_group(ui, &text!("paint-keep-out"), keep_outs(paint), actions);
    tool_group(ui, &text!("paint-only"), areas(paint), actions);
    tool_group(ui, &text!("paint-by-hand"), edits(paint), actions);
    ui.add_space(space::LARGE);
    let clear = button_if(ui, paint.design.is_drawn_on(), &text!("paint-clear"));
    if clear.on_hover_text(text!("paint-clear-hint")).clicked() {
        actions.push(PaintAction::Clear);
    }
}

/// Tools by which a drag draws what gets no paint.
fn keep_outs(paint: &PaintState) -> Vec<Tool<PaintAction>> {
    let outline = |shape| PaintTool::Outline(shape, RegionUse::KeepOut);
    let around = text!("paint-keep-out-hint");
    let tools = [
        (
            text!("paint-box"),
            text!("paint-keep-out-box"),
            around.clone(),
            outline(DrawnShape::Box),
        ),
        (
            text!("view-lasso"),
            text!("paint-keep-out-lasso"),
            around,
            outline(DrawnShape::Lasso),
        ),
        (
            text!("paint-brush"),
            text!("paint-keep-out-brush"),
            text!("paint-brush-hint"),
            PaintTool::Brush,
        ),
    ];
    tools.map(|tool| drag_tool(paint, tool)).into()
}

/// Tools by which a drag draws the only areas to be painted.
fn areas(paint: &PaintState) -> Vec<Tool<PaintAction>> {
    let tools = [
        (
            text!("paint-in-box"),
            text!("paint-only-box"),
            DrawnShape::Box,
        ),
        (
            text!("paint-in-lasso"),
            text!("paint-only-lasso"),
            DrawnShape::Lasso,
        ),
    ];
    tools
        .map(|(text, label, shape)| {
            let tool = PaintTool::Outline(shape, RegionUse::PaintOnly);
            drag_tool(paint, (text, label, text!("paint-only-hint"), tool))
        })
        .into()
}

/// Tools by which a drag corrects the path.
fn edits(paint: &PaintState) -> Vec<Tool<PaintAction>> {
    let tools = [
        (
            text!("paint-move-stroke"),
            text!("paint-move-stroke-hint"),
            EditKind::Stroke,
        ),
        (
            text!("paint-move-point"),
            text!("paint-move-point-hint"),
            EditKind::Point,
        ),
        (
            text!("paint-turn-gun"),
            text!("paint-turn-gun-hint"),
            EditKind::Turn,
        ),
    ];
    tools
        .map(|(text, hint, kind)| {
            drag_tool(paint, (text.clone(), text, hint, PaintTool::Edit(kind)))
        })
        .into()
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

/// The tool by which a drag turns the view, and the choice of the colours of the part.
fn view_tools(paint: &PaintState) -> Vec<Tool<PaintAction>> {
    let rotate = text!("view-rotate");
    let rotate = (
        rotate.clone(),
        rotate,
        text!("view-rotate-hint"),
        PaintTool::Look,
    );
    let colours = text!("paint-film-colours");
    let colours = Tool {
        label: colours.clone(),
        text: colours,
        hint: Some(text!("paint-film-colours-hint")),
        is_chosen: paint.is_film_shown,
        is_enabled: true,
        action: PaintAction::ToggleFilm,
    };
    vec![drag_tool(paint, rotate), colours]
}
