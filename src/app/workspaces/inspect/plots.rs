//! The stage pictures: textures made once, curves and outlines drawn from prepared numbers.

use egui::{
    Align, Align2, Color32, Painter, Pos2, Rect, Shape, Stroke, TextureHandle, pos2,
    text::LayoutJob, vec2,
};

use crate::app::{
    inspection::{
        figures::{
            Alignment, ContourFigure, PlaneLine, RankedPartFigure, SignatureCurves, StagePanel,
        },
        inspected::Inspected,
    },
    shell::session::Session,
    ui::{
        theme::{ROUNDING, Theme, font},
        widgets::{Scale, caption, curve, fitted},
    },
    workspaces::inspect::InspectState,
};

/// What the pictures are drawn from.
pub(super) struct Pictures<'a> {
    pub(super) inspected: &'a Inspected,
    pub(super) state: &'a InspectState,
    pub(super) session: &'a Session,
    pub(super) theme: &'a Theme,
    pub(super) segmentation: Option<&'a TextureHandle>,
    pub(super) binary: Option<&'a TextureHandle>,
}

/// How much a picture tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlotDetail {
    /// In the strip: the shape alone.
    Small,
    /// Enlarged: with scales and names.
    Large,
}

impl PlotDetail {
    /// Of so many corners drawn over so many logical pixels, every how-manieth is worth drawing: a stroke costs the
    /// same however short, and a small picture shows none shorter than two pixels.
    fn step(self, num_corners: usize, pixels: f32) -> usize {
        match self {
            Self::Large => 1,
            Self::Small => num_corners
                .div_ceil((pixels / 2.0).max(8.0) as usize)
                .max(1),
        }
    }
}

/// The paper's goal for E, 1e-6 m², as a power of ten.
const GOAL: f32 = -6.0;

impl Pictures<'_> {
    /// Draws the picture of a stage into a rectangle.
    pub(super) fn paint(
        &self,
        panel: StagePanel,
        painter: &Painter,
        rect: Rect,
        detail: PlotDetail,
    ) {
        painter.rect_filled(rect, ROUNDING, self.theme.canvas);
        let figures = &self.inspected.figures;
        let inner = rect.shrink(if detail == PlotDetail::Large {
            12.0
        } else {
            5.0
        });
        let is_there = match panel {
            StagePanel::Segmentation => self.texture(self.segmentation, painter, rect),
            StagePanel::BinaryImage => self.texture(self.binary, painter, rect),
            StagePanel::Contour => figures
                .contour
                .as_ref()
                .map(|contour| self.contour(contour, painter, inner, detail)),
            StagePanel::Signature => figures
                .signature
                .as_ref()
                .map(|curves| self.signature(curves, painter, inner, detail)),
            StagePanel::Ranking => (!figures.candidates.is_empty())
                .then(|| self.ranking(&figures.candidates, painter, inner, detail)),
            StagePanel::Alignment => self
                .candidate()
                .map(|candidate| self.alignment(candidate, painter, inner, detail)),
        };
        if is_there.is_none() {
            self.says(painter, inner, "not reached");
        }
    }

    /// Words in place of a picture.
    fn says(&self, painter: &Painter, rect: Rect, text: &str) {
        let mut job = LayoutJob::simple(
            text.to_owned(),
            font::small(),
            self.theme.weak_text,
            rect.width() - 8.0,
        );
        job.halign = Align::Center;
        let galley = painter.layout_job(job);
        let top = rect.center() - vec2(0.0, galley.size().y / 2.0);
        painter.galley(top, galley, self.theme.weak_text);
    }

    fn candidate(&self) -> Option<&RankedPartFigure> {
        self.inspected.figures.candidates.get(self.state.candidate)
    }

    /// Why the chosen candidate was not aligned, where it was not.
    pub(super) fn not_aligned(&self) -> Option<&'static str> {
        match self.candidate()?.alignment {
            Alignment::Done { .. } => None,
            Alignment::None(why) => Some(why),
        }
    }

    fn texture(
        &self,
        texture: Option<&TextureHandle>,
        painter: &Painter,
        rect: Rect,
    ) -> Option<()> {
        let texture = texture?;
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let place = fitted(rect, texture.aspect_ratio());
        // What is old is dimmed by the painter, pictures too.
        let tint = Color32::WHITE.gamma_multiply(painter.opacity());
        let _ = self;
        painter.image(texture.id(), place, whole, tint);
        Some(())
    }

    fn contour(&self, figure: &ContourFigure, painter: &Painter, rect: Rect, detail: PlotDetail) {
        let [low, high] = figure.bounds;
        let (wide, tall) = ((high[0] - low[0]).max(1e-3), (high[1] - low[1]).max(1e-3));
        let place = fitted(rect, wide / tall);
        let (across, up) = (
            Scale::new([low[0], high[0]], [place.left(), place.right()]),
            Scale::new([low[1], high[1]], [place.bottom(), place.top()]),
        );
        let at = |p: &[f32; 2]| pos2(across.at(p[0]), up.at(p[1]));
        let centroid = at(&figure.centroid);
        let corners = |border: &PlaneLine| -> Vec<Pos2> {
            let step = detail.step(border.len(), rect.width());
            let last = border.last().into_iter();
            border.iter().step_by(step).chain(last).map(at).collect()
        };
        let ray = Stroke::new(1.0, self.theme.weak_text.gamma_multiply(0.45));
        let step = detail.step(figure.ray_ends.len(), rect.width());
        for end in figure.ray_ends.iter().step_by(step) {
            painter.line_segment([centroid, at(end)], ray);
        }
        for (place, border) in figure.borders.iter().enumerate() {
            let colour = if place == 0 {
                self.theme.first_series
            } else {
                self.theme.second_series
            };
            painter.line(corners(border), Stroke::new(1.6, colour));
        }
        if let Some(candidate) = self.candidate() {
            let outline = corners(&candidate.outline);
            let stroke = Stroke::new(1.2, self.theme.reference_series);
            painter.extend(Shape::dashed_line(&outline, stroke, 5.0, 4.0));
        }
        painter.circle_filled(centroid, 3.5, self.theme.second_series);
    }

    fn signature(
        &self,
        scene: &SignatureCurves,
        painter: &Painter,
        rect: Rect,
        detail: PlotDetail,
    ) {
        let reference = self.candidate().and_then(|c| c.curves.as_ref());
        let half = rect.height() / 2.0;
        let halves = [
            (
                "L, m",
                1,
                &scene.lengths,
                reference.map(|r| &r.lengths),
                self.theme.first_series,
            ),
            (
                "Θ, rad",
                2,
                &scene.angles,
                reference.map(|r| &r.angles),
                self.theme.second_series,
            ),
        ];
        for (name, number, values, other, colour) in halves {
            let top = rect.top() + half * (number - 1) as f32;
            let area =
                Rect::from_min_size(pos2(rect.left(), top), vec2(rect.width(), half)).shrink(4.0);
            let range = range_of(values.iter().chain(other.into_iter().flatten()));
            let up = Scale::new(range, [area.bottom(), area.top()]);
            let step = detail.step(values.len(), rect.width());
            let thin =
                |values: &[f32]| -> Vec<f32> { values.iter().step_by(step).copied().collect() };
            let last = (values.len().saturating_sub(1) / step).max(1) as f32;
            let across = Scale::new([0.0, last], [area.left(), area.right()]);
            if detail == PlotDetail::Large {
                self.level(painter, area, &up, range[0], &format!("{:.2}", range[0]));
                self.level(painter, area, &up, range[1], &format!("{:.2}", range[1]));
            }
            if let Some(other) = other {
                let stroke = Stroke::new(1.0, self.theme.reference_series);
                painter.line(curve(&thin(other), &across, &up), stroke);
            }
            painter.line(curve(&thin(values), &across, &up), Stroke::new(1.6, colour));
            if detail == PlotDetail::Large {
                let at = area.left_center();
                painter.text(at, Align2::LEFT_CENTER, name, font::body_strong(), colour);
            }
        }
    }

    fn alignment(
        &self,
        candidate: &RankedPartFigure,
        painter: &Painter,
        rect: Rect,
        detail: PlotDetail,
    ) {
        let (log_e, rms_m) = match &candidate.alignment {
            Alignment::Done { log_e, rms_m } if !log_e.is_empty() => (log_e, *rms_m),
            Alignment::Done { .. } => return self.says(painter, rect, "E stayed at 0"),
            Alignment::None(why) => return self.says(painter, rect, why),
        };
        let [low, high] = range_of(log_e.iter());
        let (low, high) = (low.min(GOAL).floor(), high.max(GOAL + 1.0).ceil());
        let mut area = rect;
        area.min.x += if detail == PlotDetail::Large {
            44.0
        } else {
            26.0
        };
        // Room for a line of text over the curve.
        area.min.y += if detail == PlotDetail::Large {
            22.0
        } else {
            0.0
        };
        let up = Scale::new([low, high], [area.bottom() - 4.0, area.top() + 6.0]);
        let last = (log_e.len() - 1).max(1) as f32;
        let across = Scale::new([0.0, last], [area.left() + 4.0, area.right() - 6.0]);
        for power in low as i32..=high as i32 {
            let y = up.at(power as f32);
            painter.hline(area.x_range(), y, self.theme.edge_stroke());
            let at = pos2(area.left() - 4.0, y);
            caption(
                painter,
                at,
                Align2::RIGHT_CENTER,
                &format!("1e{power}"),
                self.theme.weak_text,
            );
        }
        let y = up.at(GOAL);
        let goal = [pos2(area.left(), y), pos2(area.right(), y)];
        let stroke = Stroke::new(1.4, self.theme.second_series);
        painter.extend(Shape::dashed_line(&goal, stroke, 5.0, 4.0));
        let points = curve(log_e, &across, &up);
        if let Some(end) = points.last() {
            painter.circle_filled(*end, 3.0, self.theme.first_series);
        }
        painter.line(points, Stroke::new(1.8, self.theme.first_series));
        if detail == PlotDetail::Large {
            let rms = self.session.units.length(rms_m);
            let text = format!("{} ended at rms {rms}", candidate.title);
            let at = rect.right_top();
            painter.text(at, Align2::RIGHT_TOP, text, font::body(), self.theme.text);
            let at = pos2(area.right(), y - 4.0);
            let text = "the paper's goal, 1e\u{2212}6 m²";
            painter.text(
                at,
                Align2::RIGHT_BOTTOM,
                text,
                font::small(),
                self.theme.second_series,
            );
        }
    }

    /// A faint line across, with its value.
    fn level(&self, painter: &Painter, area: Rect, up: &Scale, value: f32, text: &str) {
        let y = up.at(value);
        painter.hline(area.x_range(), y, self.theme.edge_stroke());
        let at = pos2(area.right(), y);
        caption(
            painter,
            at,
            Align2::RIGHT_BOTTOM,
            text,
            self.theme.weak_text,
        );
    }
}

/// Smallest and largest.
fn range_of<'a>(values: impl Iterator<Item = &'a f32>) -> [f32; 2] {
    values.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], value| {
        [low.min(*value), high.max(*value)]
    })
}

#[cfg(test)]
mod tests {
    use super::PlotDetail;

    #[test]
    fn a_small_picture_draws_no_more_strokes_than_show() {
        assert_eq!(PlotDetail::Large.step(512, 146.0), 1);
        assert_eq!(PlotDetail::Small.step(512, 146.0), 8);
        assert_eq!(PlotDetail::Small.step(40, 146.0), 1);
        assert_eq!(PlotDetail::Small.step(0, 0.0), 1);
    }
}
