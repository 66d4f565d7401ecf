//! How a method is told from the others: by its name, its colour, and the dashes of its curve.

use egui::Color32;
use egui_plot::LineStyle;

use crate::{
    app::{language::text, ui::theme::Theme},
    stages::pose::PoseMethod,
};

/// What a person calls a method.
pub(super) fn title(method: PoseMethod) -> String {
    match method {
        PoseMethod::Icp => "ICP".into(),
        PoseMethod::IcpGa => "ICP-GA".into(),
        PoseMethod::Global => text!("align-global"),
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
pub(super) fn style(method: PoseMethod) -> LineStyle {
    match method {
        PoseMethod::Icp => LineStyle::Solid,
        PoseMethod::IcpGa => LineStyle::Dashed { length: 9.0 },
        PoseMethod::Global => LineStyle::Dashed { length: 3.0 },
    }
}
