//! The stage strip: a picture per stage, each of which can be enlarged.

use egui::{
    Align, Button, Frame, Label, Layout, Margin, Rect, RichText, Sense, Ui, Vec2, pos2, vec2,
};

use super::plots::{Pictures, PlotDetail};
use crate::workspaces::inspect::state::InspectAction;
use inspection::pipeline::Timings;
use shell::inspection::figures::StagePanel;
use ui::{
    language::text,
    theme::{font, space},
    widgets::focus_ring,
};

/// Below this width, logical pixels, a picture's time is below its title instead of beside it.
const TWO_LINE_WIDTH_PX: f32 = 150.0;

/// Time of the stage that a picture shows.
fn time_of(panel: StagePanel, timings: &Timings) -> String {
    let time = match panel {
        StagePanel::Segmentation => timings.segment,
        StagePanel::BinaryImage => timings.project,
        StagePanel::Contour => timings.contour,
        StagePanel::Signature => timings.signature,
        StagePanel::Ranking => timings.rank,
        StagePanel::Alignment => timings.pose,
    };
    format!("{:.1} ms", time.as_secs_f64() * 1000.0)
}

/// Draws the strip.
pub(super) fn ui(ui: &mut Ui, pictures: &Pictures<'_>, actions: &mut Vec<InspectAction>) {
    let theme = pictures.theme;
    if pictures.session.is_old() {
        ui.multiply_opacity(0.55);
    }
    let all = ui.available_rect_before_wrap();
    let width = all.width() / StagePanel::ALL.len() as f32;
    for (index, panel) in StagePanel::ALL.into_iter().enumerate() {
        let left = all.left() + index as f32 * width;
        let cell = Rect::from_min_size(pos2(left, all.top()), vec2(width, all.height()));
        let response = ui.interact(cell, ui.scope_id().with(index), Sense::click());
        let is_enlarged = pictures.state.enlarged == Some(panel);
        response.widget_info(|| {
            let label = enlarge(panel);
            egui::WidgetInfo::selected(egui::Role::Button, true, is_enlarged, label)
        });
        let painter = ui.painter_at(cell);
        if response.hovered() || is_enlarged {
            painter.rect_filled(cell, 0.0, theme.control);
        }
        if index > 0 {
            painter.vline(cell.left(), cell.y_range(), theme.edge_stroke());
        }
        let inner = cell.shrink(space::MEDIUM);
        let title = format!("{} {}", index + 1, panel.title());
        painter.text(
            inner.min,
            egui::Align2::LEFT_TOP,
            title,
            font::small(),
            theme.text,
        );
        let time = time_of(panel, &pictures.inspected.inspection.timings);
        let mut picture = inner;
        picture.min.y += 22.0;
        let (at, anchor) = if width < TWO_LINE_WIDTH_PX {
            picture.max.y -= 18.0;
            (inner.left_bottom(), egui::Align2::LEFT_BOTTOM)
        } else {
            (inner.right_top(), egui::Align2::RIGHT_TOP)
        };
        painter.text(at, anchor, time, font::small(), theme.weak_text);
        pictures.paint(panel, ui, picture, PlotDetail::Small);
        focus_ring(ui, cell, &response);
        if response.clicked() {
            let enlarged = (!is_enlarged).then_some(panel);
            actions.push(InspectAction::Enlarge(enlarged));
        }
    }
}

/// Draws the enlarged stage over the middle.
pub(super) fn enlarged_ui(ui: &mut Ui, pictures: &Pictures<'_>, actions: &mut Vec<InspectAction>) {
    let Some(panel) = pictures.state.enlarged else {
        return;
    };
    if pictures.session.is_old() {
        ui.multiply_opacity(0.55);
    }
    Frame::new().inner_margin(Margin::same(14)).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.set_min_height(space::TARGET);
            ui.heading(panel.title());
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let name = text!("shell-close");
                let close = Button::new(&*name).shortcut_text(RichText::new("Esc").small());
                let close = ui.add(close.min_size(Vec2::splat(space::TARGET)));
                close.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
                if close.clicked() {
                    actions.push(InspectAction::Enlarge(None));
                }
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    let text = RichText::new(explanation(panel)).weak();
                    ui.add(Label::new(text).truncate());
                });
            });
        });
        if !matches!(panel, StagePanel::Segmentation | StagePanel::BinaryImage) {
            candidates(ui, pictures, actions);
        }
        ui.add_space(space::SMALL);
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, Sense::hover());
        response.widget_info(|| {
            let stage = panel.title();
            let label = match (panel, pictures.not_aligned()) {
                (StagePanel::Alignment, Some(why)) => {
                    text!("inspect-enlarged-without", stage = stage, why = why)
                }
                _ => text!("inspect-enlarged", stage = stage),
            };
            egui::WidgetInfo::labeled(egui::Role::Image, true, label)
        });
        pictures.paint(panel, ui, rect, PlotDetail::Large);
        pictures.read_out(panel, ui, rect);
    });
}

/// Draws the enrolled parts to compare with, best first.
fn candidates(ui: &mut Ui, pictures: &Pictures<'_>, actions: &mut Vec<InspectAction>) {
    ui.horizontal_wrapped(|ui| {
        for (index, candidate) in pictures.inspected.figures.candidates.iter().enumerate() {
            let is_chosen = pictures.state.candidate == index;
            let button = Button::selectable(is_chosen, &candidate.title);
            if ui
                .add(button.min_size(Vec2::splat(space::TARGET)))
                .clicked()
            {
                actions.push(InspectAction::Candidate(index));
            }
        }
    });
}

fn enlarge(panel: StagePanel) -> String {
    match panel {
        StagePanel::Segmentation => text!("inspect-enlarge-segmentation"),
        StagePanel::BinaryImage => text!("inspect-enlarge-binary-image"),
        StagePanel::Contour => text!("inspect-enlarge-contour"),
        StagePanel::Signature => text!("inspect-enlarge-signatures"),
        StagePanel::Ranking => text!("inspect-enlarge-ranking"),
        StagePanel::Alignment => text!("inspect-enlarge-alignment"),
    }
}

fn explanation(panel: StagePanel) -> String {
    match panel {
        StagePanel::Segmentation => text!("inspect-says-segmentation"),
        StagePanel::BinaryImage => text!("inspect-says-binary-image"),
        StagePanel::Contour => text!("inspect-says-contour"),
        StagePanel::Signature => text!("inspect-says-signatures"),
        StagePanel::Ranking => text!("inspect-says-ranking"),
        StagePanel::Alignment => text!("inspect-says-alignment"),
    }
}
