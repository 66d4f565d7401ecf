//! The colour scale in the corner of a view: the shader's stops, with the values at the ends and the middle.

use egui::{Align2, Color32, FontId, Mesh, Painter, Pos2, Rect, Shape, Vec2};

use super::{
    renderer::height_range,
    scene::ViewScene,
    style::{Colouring, Legend, SCALE_STOPS, ScaleWords, ViewStyle},
};
use crate::{
    language::text,
    theme::{ROUNDING, Theme, font::small},
};

const BAR: Vec2 = Vec2::new(168.0, 8.0);
const MARGIN: f32 = 14.0;
/// Height of a row of controls at the top.
const CONTROLS_HEIGHT_PX: f32 = 48.0;

/// Draws the scale that colours the view's points, if a scale does.
pub(super) fn ui(painter: &Painter, rect: Rect, scene: &ViewScene, style: &ViewStyle) {
    let fits = rect.width() > BAR.x + 4.0 * MARGIN && rect.height() > 100.0;
    if !fits {
        return;
    }
    let rect = match style.legend {
        Legend::BelowControls => rect.with_min_y(rect.top() + CONTROLS_HEIGHT_PX),
        Legend::Shown => rect,
    };
    let colours = &style.colours;
    let (factor, unit, decimals) = style.length_axis;
    match style.colouring {
        Colouring::Height => {
            let [low, high] = height_range(scene).map(|metres| f64::from(metres) * factor);
            let values = [low, f64::midpoint(low, high), high];
            let values = values.map(|height| format!("{height:.decimals$}"));
            bar(
                painter,
                rect,
                &text!("view-height-scale", unit = unit),
                &values,
                &colours.height_scale,
                style,
            );
        }
        Colouring::Deviation => {
            let (title, values) = match style.scale_words {
                ScaleWords::Deviation => {
                    let end = style.deviation_range.0 * factor;
                    let values = [format!("−{end}"), "0".into(), format!("+{end}")];
                    (text!("view-deviation-scale", unit = unit), values)
                }
                ScaleWords::Film { target, range } => {
                    let values = [target.0 - range.0, target.0, target.0 + range.0];
                    let values = values.map(|metres| format!("{:.0}", 1e6 * metres));
                    (text!("view-film-scale"), values)
                }
            };
            let stops = colours.deviations(style.scale_words);
            bar(painter, rect, &title, &values, stops, style);
        }
        Colouring::Segment | Colouring::Plain => {}
    }
}

/// Draws what each of these colours means, one below the other, with the lower left corner here.
pub fn colour_keys(painter: &Painter, corner: Pos2, keys: &[(Color32, String)], theme: &Theme) {
    const LINE: f32 = 20.0;
    const SQUARE: f32 = 11.0;
    if keys.is_empty() {
        return;
    }
    let texts = keys.iter();
    let texts = texts.map(|(_, text)| painter.layout_no_wrap(text.clone(), small(), theme.text));
    let texts: Vec<_> = texts.collect();
    let width = texts.iter().map(|text| text.size().x);
    let width = width.fold(0.0, f32::max) + SQUARE + 24.0;
    let size = Vec2::new(width, LINE * texts.len() as f32 + 6.0);
    let plate = Align2::LEFT_BOTTOM.anchor_size(corner, size);
    painter.rect_filled(plate, ROUNDING, theme.canvas.gamma_multiply(0.82));
    for (index, ((colour, _), text)) in keys.iter().zip(texts).enumerate() {
        let middle = plate.top() + 3.0 + LINE * (index as f32 + 0.5);
        let at = Pos2::new(plate.left() + 8.0, middle);
        let square = Align2::LEFT_CENTER.anchor_size(at, Vec2::splat(SQUARE));
        painter.rect_filled(square, 2.0, *colour);
        let left = Pos2::new(square.right() + 8.0, middle - text.size().y / 2.0);
        painter.galley(left, text, theme.text);
    }
}

fn bar(
    painter: &Painter,
    rect: Rect,
    title: &str,
    values: &[String; 3],
    stops: &[Color32; SCALE_STOPS],
    style: &ViewStyle,
) {
    let font = FontId::proportional(12.0);
    let title_height = 18.0;
    let top_left = Pos2::new(
        rect.right() - MARGIN - BAR.x,
        rect.top() + MARGIN + title_height,
    );
    let bar = Rect::from_min_size(top_left, BAR);
    let plate = Rect::from_min_max(
        bar.min - Vec2::new(10.0, title_height + 6.0),
        bar.max + Vec2::new(10.0, 22.0),
    );
    painter.rect_filled(plate, 6.0, style.colours.background.gamma_multiply(0.8));
    painter.text(
        bar.right_top() - Vec2::new(0.0, 4.0),
        Align2::RIGHT_BOTTOM,
        title,
        font.clone(),
        style.colours.weak_text,
    );
    painter.add(Shape::mesh(gradient(bar, stops)));
    let [low, middle, high] = values;
    let below = Vec2::new(0.0, 4.0);
    for (at, align, value) in [
        (bar.left_bottom(), Align2::LEFT_TOP, low),
        (bar.center_bottom(), Align2::CENTER_TOP, middle),
        (bar.right_bottom(), Align2::RIGHT_TOP, high),
    ] {
        painter.text(at + below, align, value, font.clone(), style.colours.text);
    }
}

fn gradient(bar: Rect, stops: &[Color32; SCALE_STOPS]) -> Mesh {
    let mut mesh = Mesh::default();
    for (i, colour) in (0_u32..).zip(stops) {
        let x = bar.left() + bar.width() * i as f32 / (SCALE_STOPS - 1) as f32;
        mesh.colored_vertex(Pos2::new(x, bar.top()), *colour);
        mesh.colored_vertex(Pos2::new(x, bar.bottom()), *colour);
        if i > 0 {
            let last = 2 * (i - 1);
            mesh.add_triangle(last, last + 1, last + 2);
            mesh.add_triangle(last + 2, last + 1, last + 3);
        }
    }
    mesh
}
