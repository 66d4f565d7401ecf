//! The card's section on the stand-off: that of an assumed path, against its band.

use egui::{Align2, Rect, RichText, Sense, Ui, pos2, vec2};

use crate::{
    app::{
        inspection::{inspected::Inspected, unit_system::UnitSystem},
        language::{results::stand_off_error, text},
        ui::{
            theme::{ROUNDING, Theme, font, space},
            widgets::{Scale, heading, row, sentence},
        },
    },
    stages::stand_off::{StandOff, StandOffParams},
};

/// Draws the section; nothing without a stand-off.
pub(super) fn ui(ui: &mut Ui, inspected: &Inspected, units: UnitSystem) {
    let Some(found) = &inspected.stand_off else {
        return;
    };
    heading(ui, &text!("inspect-stand-off"));
    match found {
        Ok(found) => figures(ui, found, &inspected.recipe.stand_off, units),
        Err(error) => {
            let text = sentence(&stand_off_error(error));
            ui.weak(text);
        }
    }
}

fn figures(ui: &mut Ui, found: &StandOff, params: &StandOffParams, units: UnitSystem) {
    bar(ui, found, params, units);
    let pair = text!(
        "inspect-worst-of",
        value = units.length(found.mean.0),
        worst = units.length(found.worst.distance.0)
    );
    row(ui, &text!("inspect-mean"), &pair);
    row(
        ui,
        &text!("inspect-in-band"),
        &format!("{:.0} %", found.in_band * 100.0),
    );
    let pair = text!(
        "inspect-worst-of",
        value = units.angle(found.mean_angle.0),
        worst = units.angle(found.worst_angle.0)
    );
    row(ui, &text!("inspect-angle"), &pair);
    // Parts rarely hang as taught: that the path has to follow the pose is usual, and no fault of the part.
    let text = if found.keeps_the_band() {
        text!("inspect-path-fits")
    } else {
        text!("inspect-path-needs-pose")
    };
    ui.label(RichText::new(text).small().weak());
}

/// Draws a range of distances with the band in its middle third: a full tick for the mean, a short one for the worst.
fn bar(ui: &mut Ui, found: &StandOff, params: &StandOffParams, units: UnitSystem) {
    const BAR: f32 = 14.0;
    const NUMBERS: f32 = 15.0;
    let theme = Theme::of(ui);
    let (near, far) = (params.nearest.0 as f32, params.farthest.0 as f32);
    let wide = (far - near).max(1e-3);
    let size = vec2(ui.available_width(), BAR + space::SMALL + NUMBERS);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let text = text!(
        "inspect-stand-off-of",
        mean = units.length(found.mean.0),
        nearest = units.length(params.nearest.0),
        farthest = units.length(params.farthest.0)
    );
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &text));
    let painter = ui.painter();
    let bar = Rect::from_min_size(rect.min + vec2(0.0, 3.0), vec2(rect.width(), BAR));
    let across = Scale::new([near - wide, far + wide], [bar.left(), bar.right()]);
    painter.rect_filled(bar, ROUNDING, theme.track);
    let band = Rect::from_x_y_ranges(across.at(near)..=across.at(far), bar.y_range());
    painter.rect_filled(band, 0.0, theme.accepted.gamma_multiply(0.45));
    // Clamp distances beyond the bar to its end.
    let tick = |distance: f64, width: f32, over: f32, colour| {
        let x = across.at(distance as f32);
        let x = x.clamp(bar.left() + width, bar.right() - width);
        let line = Rect::from_center_size(pos2(x, bar.center().y), vec2(width, BAR + over));
        painter.rect_filled(line, 0.0, colour);
    };
    tick(found.worst.distance.0, 2.0, -4.0, theme.weak_text);
    tick(found.mean.0, 3.0, 5.0, theme.text);
    for (at, align) in [(near, Align2::CENTER_TOP), (far, Align2::CENTER_TOP)] {
        let text = units.length(f64::from(at));
        let at = pos2(across.at(at), bar.bottom() + 4.0);
        painter.text(at, align, text, font::small(), theme.weak_text);
    }
}
