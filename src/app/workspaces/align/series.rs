//! How a method is told from the others: by its name, its colour, and the dashes of its curve.

use egui::{Color32, Pos2, Shape, Stroke};

use crate::{app::ui::theme::Theme, stages::pose::PoseMethod};

/// What a person calls a method.
pub(super) fn title(method: PoseMethod) -> &'static str {
    match method {
        PoseMethod::Icp => "ICP",
        PoseMethod::IcpGa => "ICP-GA",
        PoseMethod::Global => "Global",
    }
}

/// Its colour.
pub(super) fn colour(method: PoseMethod, theme: &Theme) -> Color32 {
    match method {
        PoseMethod::Icp => theme.second_series,
        PoseMethod::IcpGa => theme.first_series,
        PoseMethod::Global => theme.reference_series,
    }
}

/// Its curve: whole for ICP, in dashes or dots for the others.
pub(super) fn line(method: PoseMethod, points: &[Pos2], theme: &Theme) -> Vec<Shape> {
    let stroke = Stroke::new(2.0, colour(method, theme));
    match method {
        PoseMethod::Icp => vec![Shape::line(points.to_vec(), stroke)],
        PoseMethod::IcpGa => Shape::dashed_line(points, stroke, 9.0, 4.0),
        PoseMethod::Global => Shape::dashed_line(points, stroke, 2.5, 3.5),
    }
}
