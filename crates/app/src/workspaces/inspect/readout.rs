//! The scale of the enlarged pictures of stages, and the values under the pointer.

use egui::{Align2, Pos2, Rect, Stroke, Ui, pos2, vec2};

use super::plots::{Pictures, PlotDetail};
use shell::inspection::figures::StagePanel;
use ui::{
    language::text,
    theme::{ROUNDING, font, space},
    widgets::{fitted, plane_in},
};

/// Share of a picture's width that its scale bar takes at most.
const MAX_BAR_SHARE: f32 = 0.25;
/// Height of the marks at the ends of a scale bar, logical pixels.
const END_MARK: f32 = 8.0;

impl Pictures<'_> {
    /// Draws the scale of an enlarged picture in this rectangle, and what is under the pointer.
    pub(super) fn read_out(&self, panel: StagePanel, ui: &Ui, rect: Rect) {
        let at = ui.input(|input| input.pointer.hover_pos());
        let at = at.filter(|at| rect.contains(*at));
        let (per_metre, words) = match panel {
            StagePanel::Segmentation => (None, self.at_reading(rect, at)),
            StagePanel::BinaryImage => self.at_pixel(rect, at).unzip(),
            StagePanel::Contour => self.at_ray(rect, at).unzip(),
            // Their axes have scales.
            StagePanel::Signature | StagePanel::Ranking | StagePanel::Alignment => return,
        };
        if let Some(per_metre) = per_metre {
            self.scale_bar(ui, rect, per_metre);
        }
        if let Some(words) = words.filter(|words| !words.is_empty()) {
            let painter = ui.painter_at(rect);
            let words = painter.layout_no_wrap(words, font::body(), self.theme.text);
            let size = words.size() + vec2(2.0, 1.0) * space::SMALL;
            let corner = rect.left_bottom() + vec2(space::MEDIUM, -space::MEDIUM - size.y);
            let plate = Rect::from_min_size(corner, size);
            painter.rect_filled(plate, ROUNDING, self.theme.panel);
            let at = plate.center() - words.size() / 2.0;
            painter.galley(at, words, self.theme.text);
        }
    }

    /// What the camera read at the pointer.
    fn at_reading(&self, rect: Rect, at: Option<Pos2>) -> Option<String> {
        let cloud = &self.inspected.scene.cloud;
        let grid = cloud.grid?;
        let size = [grid.width, grid.height];
        let [column, row] = pixel_at(rect, self.segmentation?.aspect_ratio(), size, at?)?;
        let depth = cloud.points.get(row * grid.width + column)?.z;
        Some(if depth.is_finite() {
            let depth = self.session.units.length(f64::from(depth));
            text!(
                "inspect-at-reading",
                column = column,
                row = row,
                depth = depth
            )
        } else {
            text!("inspect-at-no-reading", column = column, row = row)
        })
    }

    /// The scale of the binary image, logical pixels per metre, and the place in the plane at the pointer; empty without it.
    fn at_pixel(&self, rect: Rect, at: Option<Pos2>) -> Option<(f32, String)> {
        let plane = self.inspected.inspection.plane.as_ref()?;
        let size = [plane.image.width, plane.image.height];
        let aspect = self.binary?.aspect_ratio();
        let side = fitted(rect, aspect).width() / plane.image.width.max(1) as f32;
        let per_metre = side / plane.pixel.0 as f32;
        let words = at.and_then(|at| {
            let [column, row] = pixel_at(rect, aspect, size, at)?;
            let units = self.session.units;
            let place = plane.plane_point(column as f64, row as f64);
            let (x, y) = (units.length(place.x), units.length(place.y));
            let height = plane.heights.get(row * plane.image.width + column);
            let height = height.filter(|height| height.is_finite());
            Some(match height {
                Some(height) => {
                    let height = units.length(f64::from(*height));
                    text!("inspect-at-surface", x = x, y = y, height = height)
                }
                None => text!("inspect-at-plane", x = x, y = y),
            })
        });
        Some((per_metre, words.unwrap_or_default()))
    }

    /// The scale of the contour, logical pixels per metre, and the ray to the pointer; empty without it.
    fn at_ray(&self, rect: Rect, at: Option<Pos2>) -> Option<(f32, String)> {
        let figure = self.inspected.figures.contour.as_ref()?;
        let rect = Self::inner(rect, PlotDetail::Large);
        let to_screen = plane_in(rect, self.contour_bounds(figure, PlotDetail::Large));
        let zero = to_screen(&[0.0, 0.0]);
        let per_metre = to_screen(&[1.0, 0.0]).x - zero.x;
        let words = at.map(|at| {
            let [x, y] = [at.x - zero.x, zero.y - at.y].map(|offset| f64::from(offset / per_metre));
            let [from_x, from_y] = figure.centroid.map(f64::from);
            let ray = [x - from_x, y - from_y];
            let units = self.session.units;
            text!(
                "inspect-at-ray",
                x = units.length(x),
                y = units.length(y),
                length = units.length(ray[0].hypot(ray[1])),
                angle = units.angle(ray[1].atan2(ray[0]))
            )
        });
        Some((per_metre, words.unwrap_or_default()))
    }

    /// Draws a bar of a round length at the lower right.
    fn scale_bar(&self, ui: &Ui, rect: Rect, per_metre: f32) {
        let Some(length) = bar_length(f64::from(MAX_BAR_SHARE * rect.width() / per_metre)) else {
            return;
        };
        let painter = ui.painter_at(rect);
        let colour = self.theme.text;
        let stroke = Stroke::new(1.5, colour);
        let end = rect.right_bottom() - vec2(space::LARGE, space::LARGE);
        let begin = end - vec2(length as f32 * per_metre, 0.0);
        painter.line_segment([begin, end], stroke);
        for x in [begin.x, end.x] {
            let half = END_MARK / 2.0;
            painter.line_segment([pos2(x, end.y - half), pos2(x, end.y + half)], stroke);
        }
        let (factor, unit, decimals) = self.session.units.length_axis();
        let text = format!("{:.decimals$} {unit}", factor * length);
        let middle = begin + (end - begin) / 2.0 - vec2(0.0, END_MARK);
        painter.text(middle, Align2::CENTER_BOTTOM, text, font::small(), colour);
    }
}

/// Column and row of the pixel under a point of a picture with this aspect and this number of columns and rows.
fn pixel_at(rect: Rect, aspect: f32, [width, height]: [usize; 2], at: Pos2) -> Option<[usize; 2]> {
    let place = fitted(rect, aspect);
    if !place.contains(at) || width == 0 || height == 0 {
        return None;
    }
    let share = (at - place.min) / place.size();
    let column = (share.x * width as f32) as usize;
    let row = (share.y * height as f32) as usize;
    Some([column.min(width - 1), row.min(height - 1)])
}

/// The largest of 1, 2 and 5 times a power of ten that is no longer than this; `None` without a length.
fn bar_length(most: f64) -> Option<f64> {
    if !(most.is_finite() && most > 0.0) {
        return None;
    }
    let power = 10.0_f64.powf(most.log10().floor());
    let lengths = [5.0, 2.0, 1.0].map(|times| times * power);
    lengths.into_iter().find(|length| *length <= most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scale_bar_has_a_round_length_that_fits() {
        for (most, length) in [
            (0.37, 0.2),
            (0.5, 0.5),
            (1.0, 1.0),
            (0.099, 0.05),
            (7.3, 5.0),
        ] {
            let found = bar_length(most).expect("a length");
            assert!((found - length).abs() < 1e-9, "{most}: {found}");
        }
        for none in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(bar_length(none), None);
        }
    }

    #[test]
    fn the_pixel_under_the_pointer_is_found_in_a_picture_in_the_middle() {
        let rect = Rect::from_min_size(pos2(100.0, 50.0), vec2(400.0, 100.0));
        // Twice as wide as high: 200 × 100 in the middle.
        let pixel = |x: f32, y: f32| pixel_at(rect, 2.0, [20, 10], pos2(x, y));
        assert_eq!(pixel(200.0, 50.0), Some([0, 0]));
        assert_eq!(pixel(255.0, 75.0), Some([5, 2]));
        assert_eq!(pixel(400.0, 150.0), Some([19, 9]));
        assert_eq!(pixel(199.0, 75.0), None);
    }
}
