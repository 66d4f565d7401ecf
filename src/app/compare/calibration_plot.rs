//! The share of right guesses over their score, beside the confusion matrix.

use egui::{Align2, Rect, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::{
    app::theme::{Theme, font, space},
    cases::Calibration,
};

/// Width of the plot with what is written around it.
pub(super) const WIDTH: f32 = 238.0;
/// Side of the plot itself.
const SIDE: f32 = 176.0;

/// Draws it; on the diagonal a score says how often it is right.
pub(super) fn ui(ui: &mut Ui, calibration: &Calibration, theme: &Theme) {
    let size = vec2(WIDTH, SIDE + 62.0);
    let (all, response) = ui.allocate_exact_size(size, Sense::hover());
    let words = words(calibration);
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, &words));
    response.on_hover_text(
        "The best guesses of all cases, by score: on the line a score of 0.9 is right nine times in ten. Numbers are guesses",
    );
    let painter = ui.painter();
    let area = Rect::from_min_size(all.min + vec2(44.0, 22.0), vec2(SIDE, SIDE));
    let place = |score: f64, share: f64| {
        pos2(
            area.left() + area.width() * score as f32,
            area.bottom() - area.height() * share as f32,
        )
    };
    painter.text(
        all.min,
        Align2::LEFT_TOP,
        "Calibration",
        font::small(),
        theme.text,
    );
    painter.rect_filled(area, 0.0, theme.canvas);
    for half in [0.0, 0.5, 1.0] {
        let (x, y) = (place(half, 0.0), place(0.0, half));
        painter.vline(x.x, area.y_range(), theme.edge_stroke());
        painter.hline(area.x_range(), y.y, theme.edge_stroke());
        let text = format!("{half:.1}");
        let colour = theme.weak_text;
        let at = x + vec2(0.0, 4.0);
        painter.text(at, Align2::CENTER_TOP, &text, font::scale(), colour);
        let at = y - vec2(6.0, 0.0);
        painter.text(at, Align2::RIGHT_CENTER, &text, font::scale(), colour);
    }
    let ends = [place(0.0, 0.0), place(1.0, 1.0)];
    painter.line_segment(ends, Stroke::new(1.0, theme.weak_text));
    let stroke = Stroke::new(1.5, theme.first_series);
    let mut last = None;
    for bin in &calibration.bins {
        let Some(share) = bin.share_right() else {
            continue;
        };
        let at = place(bin.mean_score, share);
        if let Some(last) = last.replace(at) {
            painter.line_segment([last, at], stroke);
        }
        painter.circle_filled(at, 4.0, theme.first_series);
        let at = at - vec2(0.0, 6.0);
        let text = bin.num.to_string();
        painter.text(at, Align2::CENTER_BOTTOM, text, font::scale(), theme.text);
    }
    let at = pos2(area.center().x, area.bottom() + 18.0);
    let text = match calibration.expected_error {
        Some(error) => format!("right over score · error {error:.2}"),
        None => "right over score".into(),
    };
    painter.text(at, Align2::CENTER_TOP, text, font::small(), theme.weak_text);
    ui.add_space(space::SMALL);
}

fn words(calibration: &Calibration) -> String {
    let Some(error) = calibration.expected_error else {
        return "Calibration: nothing was taken for a part".into();
    };
    let bins = calibration.bins.iter().filter(|bin| bin.num > 0);
    let bins = bins.map(|bin| {
        let (from, to) = (bin.from, bin.to);
        format!(
            "{from:.1} to {to:.1}, {} of {} right",
            bin.num_right, bin.num
        )
    });
    let bins: Vec<String> = bins.collect();
    format!(
        "Calibration: expected error {error:.2}; {}",
        bins.join("; ")
    )
}
