//! The row of controls over the 3-D view: view direction, colouring, and what else is shown.

use egui::{Button, Response, RichText, Ui, Vec2};

use super::{
    hold::Hold,
    state::{InspectState, ViewPart},
    view::SceneView,
};
use crate::workspaces::inspect::state::{InspectAction, InspectFile};
use shell::{inspection::inspected::Inspected, session::Session};
use ui::{
    language::text,
    theme::space,
    viewport::{Colouring, FitRequest, StandardView, ViewTool},
    widgets::menu_button,
};

/// Below this width of the view, logical pixels, the view directions are in a menu.
const MENU_WIDTH_PX: f32 = 800.0;

/// Draws the row.
pub(super) fn ui(
    ui: &mut Ui,
    view: &mut SceneView,
    state: &InspectState,
    session: &Session,
    inspected: &Inspected,
    actions: &mut Vec<InspectAction>,
) {
    let figure = &inspected.view;
    if ui.available_width() < MENU_WIDTH_PX {
        let title = small(opened(&text!("shell-view")));
        menu_button(ui, title, |ui| sides(ui, view));
    } else {
        sides(ui, view);
    }
    let now = opened(&text!(
        "inspect-colour",
        colouring = view.style.colouring.title()
    ));
    menu_button(ui, small(now), |ui| {
        for colouring in Colouring::ALL {
            let is_chosen = view.style.colouring == colouring;
            let is_there = colouring != Colouring::Deviation || figure.has_deviations;
            let choice = Button::selectable(is_chosen, colouring.title());
            let choice = ui.add_enabled(is_there, choice);
            let choice = choice.on_disabled_hover_text(text!("inspect-needs-pose"));
            if choice.clicked() {
                actions.push(InspectAction::Colour(colouring));
                ui.close();
            }
        }
    });
    menu_button(ui, small(opened(&text!("inspect-show"))), |ui| {
        for part in ViewPart::ALL {
            let mut is_shown = state.parts.contains(&part);
            let choice = egui::Checkbox::new(&mut is_shown, part.title());
            let choice = ui.add_enabled(is_there(session, inspected, part), choice);
            if choice.on_disabled_hover_text(needed(part)).clicked() {
                actions.push(InspectAction::Toggle(part));
            }
        }
        ui.separator();
        let export = Button::new(text!("inspect-export-path"));
        let why_not = if figure.spray.is_some() {
            let hold = Hold::robot_of_files(session, inspected).err();
            hold.map(|hold| hold.in_words())
        } else {
            Some(text!("inspect-export-path-says"))
        };
        let export = ui.add_enabled(why_not.is_none(), export);
        let export = export.on_disabled_hover_text(why_not.unwrap_or_default());
        if export.clicked() {
            actions.push(InspectAction::Ask(InspectFile::SprayPath));
            ui.close();
        }
    });
    let is_measuring = view.viewport.tool == ViewTool::Measure;
    let measure = Button::new(small(text!("inspect-measure"))).selected(is_measuring);
    if press(ui, measure)
        .on_hover_text(text!("inspect-measure-says"))
        .clicked()
    {
        view.viewport.tool = if is_measuring {
            ViewTool::Look
        } else {
            ViewTool::Measure
        };
    }
    if press(ui, Button::new(small(text!("inspect-picture"))))
        .on_hover_text(text!("inspect-picture-says"))
        .clicked()
    {
        actions.push(InspectAction::Ask(InspectFile::Picture));
    }
}

/// Label of a button that opens a menu.
fn opened(name: &str) -> String {
    format!("{name} ▼")
}

fn sides(ui: &mut Ui, view: &mut SceneView) {
    if press(ui, Button::new(small(text!("inspect-fit-view"))))
        .on_hover_text(text!("inspect-fit-view-says"))
        .clicked()
    {
        view.camera.request_fit(FitRequest::Focus);
    }
    for (text, side) in [
        (text!("inspect-front"), StandardView::Front),
        (text!("inspect-top"), StandardView::Top),
        (text!("inspect-side"), StandardView::Side),
    ] {
        if press(ui, Button::new(small(text))).clicked() {
            view.camera.look(side);
            view.camera.request_fit(FitRequest::Focus);
        }
    }
}

/// True if the result or the cell contains this.
fn is_there(session: &Session, inspected: &Inspected, part: ViewPart) -> bool {
    let figure = &inspected.view;
    match part {
        ViewPart::Axes => figure.axes.is_some(),
        ViewPart::Camera => figure.camera.is_some(),
        ViewPart::Outline => figure.outline.is_some(),
        ViewPart::NozzleMiddle | ViewPart::NozzleWorst => figure.nozzles.is_some(),
        ViewPart::SprayPath => figure.spray.is_some(),
        ViewPart::RobotBase => session.robot_of(inspected).is_some(),
        ViewPart::ShotCameras | ViewPart::Unseen => inspected.scan.is_some(),
    }
}

/// Explains what this needs before it can be shown.
fn needed(part: ViewPart) -> String {
    match part {
        ViewPart::Axes | ViewPart::Outline => text!("inspect-needs-pose"),
        ViewPart::Camera => text!("inspect-needs-camera"),
        ViewPart::NozzleMiddle | ViewPart::NozzleWorst => text!("inspect-needs-no-path"),
        ViewPart::SprayPath => text!("inspect-needs-path"),
        ViewPart::RobotBase => text!("inspect-needs-calibration"),
        ViewPart::ShotCameras | ViewPart::Unseen => text!("inspect-needs-scan"),
    }
}

fn small(text: impl Into<String>) -> RichText {
    RichText::new(text).small()
}

fn press(ui: &mut Ui, button: Button<'_>) -> Response {
    ui.add(button.min_size(Vec2::splat(space::TARGET)))
}
