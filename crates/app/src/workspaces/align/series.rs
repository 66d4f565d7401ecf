//! Name, colour and line style by which methods are told apart.

use egui::Color32;
use egui_plot::LineStyle;

use stages::pose::PoseMethod;
use ui::{language::text, theme::Theme};

/// Name of a method, for a person.
pub(super) fn title(method: PoseMethod) -> String {
    match method {
        PoseMethod::Icp => "ICP".into(),
        PoseMethod::IcpGa => "ICP-GA".into(),
        PoseMethod::Global => text!("results-option-global"),
    }
}

/// Colour of a method.
pub(super) fn colour(method: PoseMethod, theme: &Theme) -> Color32 {
    match method {
        PoseMethod::Icp => theme.second_series,
        PoseMethod::IcpGa => theme.first_series,
        PoseMethod::Global => theme.reference_series,
    }
}

/// Line style of a method's curve: solid for ICP, dashed or dotted for the others.
pub(super) fn style(method: PoseMethod) -> LineStyle {
    match method {
        PoseMethod::Icp => LineStyle::Solid,
        PoseMethod::IcpGa => LineStyle::Dashed { length: 9.0 },
        PoseMethod::Global => LineStyle::Dashed { length: 3.0 },
    }
}
