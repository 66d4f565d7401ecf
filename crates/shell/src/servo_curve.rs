//! The curve of a run of servoing: what was left of the error over time, as shift and as angle.

use egui::{Rect, Sense, Ui, pos2, vec2};

use geometry::units::{Metres, Radians};
use records::history::ServoSample;
use ui::{
    language::text,
    plot::FallingCurve,
    theme::{Theme, space},
};

/// Draws both halves, side by side in a wide place and one below the other in a narrow one.
pub fn ui(
    ui: &mut Ui,
    curve: &[ServoSample],
    (tolerance_m, tolerance_rad): (f64, f64),
    height: f32,
) {
    let theme = Theme::of(ui);
    let size = vec2(ui.available_width(), height);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let gap = space::SMALL;
    let [first, second] = if size.x > 1.5 * height {
        let middle = rect.center().x;
        [
            Rect::from_min_max(rect.min, pos2(middle - gap / 2.0, rect.bottom())),
            Rect::from_min_max(pos2(middle + gap / 2.0, rect.top()), rect.max),
        ]
    } else {
        let middle = rect.center().y;
        [
            Rect::from_min_max(rect.min, pos2(rect.right(), middle - gap / 2.0)),
            Rect::from_min_max(pos2(rect.left(), middle + gap / 2.0), rect.max),
        ]
    };
    let shifts = points(curve, |sample| Some(Metres(sample.error_m?).mm()));
    let turns = points(curve, |sample| Some(Radians(sample.error_rad?).degrees()));
    let limit_name = text!("servoing-tolerance");
    for (place, title, points, limit, unit, colour) in [
        (
            first,
            text!("servoing-shift-left"),
            shifts,
            Metres(tolerance_m).mm(),
            "mm",
            theme.first_series,
        ),
        (
            second,
            text!("servoing-turn-left"),
            turns,
            Radians(tolerance_rad).degrees(),
            "°",
            theme.second_series,
        ),
    ] {
        let curve = FallingCurve {
            title: &title,
            points: &points,
            limit: (limit, &limit_name),
            unit,
            colour,
        };
        curve.show(ui, place);
    }
}

fn points(curve: &[ServoSample], of: impl Fn(&ServoSample) -> Option<f64>) -> Vec<[f64; 2]> {
    let values = curve
        .iter()
        .filter_map(|sample| Some([sample.at_s, of(sample)?]));
    values.collect()
}
