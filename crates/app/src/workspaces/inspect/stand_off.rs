//! The card's section on the stand-off against its band: that of the stored path, else of an assumed one.

use egui::{Align2, Rect, RichText, Sense, Ui, pos2, vec2};

use robot::spray::{BandStatus, CarriedPath, MOST_TILT, SurfaceHit};
use shell::{inspection::inspected::Inspected, language::UnitSystem};
use stages::stand_off::{StandOff, StandOffParams};
use ui::{
    language::{described, text},
    theme::{ROUNDING, Theme, font, space},
    widgets::{Scale, heading, row, sentence},
};

/// Draws the section; nothing without a stand-off.
pub(super) fn ui(ui: &mut Ui, inspected: &Inspected, units: UnitSystem) {
    if let Some(path) = &inspected.spray {
        heading(ui, &text!("inspect-stand-off-stored"));
        return stored(ui, path, &inspected.recipe.stand_off, units);
    }
    let Some(found) = &inspected.stand_off else {
        return;
    };
    heading(ui, &text!("inspect-stand-off"));
    match found {
        Ok(found) => figures(ui, found, &inspected.recipe.stand_off, units),
        Err(error) => {
            ui.weak(sentence(&described(error)));
        }
    }
}

/// Draws the figures of the stored path, which has the part's pose, at the points where the camera sees the part.
fn stored(ui: &mut Ui, path: &CarriedPath, params: &StandOffParams, units: UnitSystem) {
    let met: Vec<SurfaceHit> = path.points.iter().filter_map(|point| point.meets).collect();
    let middle = f64::midpoint(params.nearest.0, params.farthest.0);
    let error = |distance: &f64| (distance - middle).abs();
    let distances = met.iter().map(|hit| hit.distance.0);
    let Some(worst) = distances.max_by(|a, b| error(a).total_cmp(&error(b))) else {
        ui.weak(text!("inspect-path-not-seen"));
        return;
    };
    let mean = |of: fn(&SurfaceHit) -> f64| met.iter().map(of).sum::<f64>() / met.len() as f64;
    distance_rows(ui, [mean(|hit| hit.distance.0), worst], params, units);
    let inside = text!(
        "inspect-points-in-band",
        inside = path.num_inside(),
        num = path.num_seen()
    );
    row(ui, &text!("inspect-in-band"), &inside);
    let num_unseen = path.count(BandStatus::NotSeen);
    if num_unseen > 0 {
        let text = text!(
            "inspect-points-not-seen",
            count = num_unseen,
            all = path.points.len()
        );
        ui.label(RichText::new(text).small().color(Theme::of(ui).warning));
    }
    let steepest = met.iter().map(|hit| hit.tilt.0).fold(0.0, f64::max);
    angle_row(ui, [mean(|hit| hit.tilt.0), steepest], units);
    let angle_counts = text!(
        "inspect-angle-counts",
        count = met.iter().filter(|hit| hit.tilt > MOST_TILT).count(),
        limit = units.angle(MOST_TILT.0)
    );
    ui.label(RichText::new(angle_counts).small().weak());
}

fn distance_rows(ui: &mut Ui, [mean, worst]: [f64; 2], params: &StandOffParams, units: UnitSystem) {
    bar(ui, [mean, worst], params, units);
    let pair = text!(
        "inspect-worst-of",
        value = units.length(mean),
        worst = units.length(worst)
    );
    row(ui, &text!("inspect-mean"), &pair);
}

fn angle_row(ui: &mut Ui, [mean, worst]: [f64; 2], units: UnitSystem) {
    let pair = text!(
        "inspect-worst-of",
        value = units.angle(mean),
        worst = units.angle(worst)
    );
    row(ui, &text!("inspect-angle"), &pair);
}

fn figures(ui: &mut Ui, found: &StandOff, params: &StandOffParams, units: UnitSystem) {
    let distances = [found.mean.0, found.worst.distance.0];
    distance_rows(ui, distances, params, units);
    row(
        ui,
        &text!("inspect-in-band"),
        &format!("{:.0} %", found.in_band * 100.0),
    );
    angle_row(ui, [found.mean_angle.0, found.worst_angle.0], units);
    // Parts rarely hang as taught: that the path has to follow the pose is usual, and no fault of the part.
    let text = if found.keeps_the_band() {
        text!("inspect-path-fits")
    } else {
        text!("inspect-path-needs-pose")
    };
    ui.label(RichText::new(text).small().weak());
}

/// Draws a range of distances with the band in its middle third: a full tick for the mean, a short one for the worst.
fn bar(ui: &mut Ui, [mean, worst]: [f64; 2], params: &StandOffParams, units: UnitSystem) {
    const BAR: f32 = 14.0;
    const NUMBERS: f32 = 15.0;
    let theme = Theme::of(ui);
    let (near, far) = (params.nearest.0 as f32, params.farthest.0 as f32);
    let wide = (far - near).max(1e-3);
    let size = vec2(ui.available_width(), BAR + space::SMALL + NUMBERS);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let text = text!(
        "inspect-stand-off-of",
        mean = units.length(mean),
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
    tick(worst, 2.0, -4.0, theme.weak_text);
    tick(mean, 3.0, 5.0, theme.text);
    for end in [near, far] {
        let text = units.length(f64::from(end));
        let at = pos2(across.at(end), bar.bottom() + 4.0);
        painter.text(at, Align2::CENTER_TOP, text, font::small(), theme.weak_text);
    }
}
