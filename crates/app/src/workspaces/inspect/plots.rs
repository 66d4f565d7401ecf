//! The pictures of the stages: textures uploaded once; curves and outlines drawn from prepared figures.

use egui::{
    Align, Align2, Color32, Painter, Pos2, Rect, RichText, Shape, Stroke, TextureHandle, Ui, pos2,
    text::LayoutJob, vec2,
};
use egui_plot::{HLine, LineStyle, PlotPoint, Points, Text};

use crate::workspaces::inspect::InspectState;
use shell::{
    inspection::{
        figures::{
            Alignment, ContourFigure, PlaneLine, RankedPartFigure, SignatureCurves, StagePanel,
        },
        inspected::Inspected,
    },
    session::Session,
};
use ui::{
    language::text,
    plot::{Axes, Axis, RayCurves, curve, range_of},
    theme::{ROUNDING, Theme, font},
    widgets::{fitted, plane_in},
};

/// What the pictures are drawn from, and their theme.
pub(super) struct Pictures<'a> {
    pub(super) inspected: &'a Inspected,
    pub(super) state: &'a InspectState,
    pub(super) session: &'a Session,
    pub(super) theme: &'static Theme,
    pub(super) segmentation: Option<&'a TextureHandle>,
    pub(super) binary: Option<&'a TextureHandle>,
}

/// Amount of detail of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlotDetail {
    /// In the strip: only the shape.
    Small,
    /// Enlarged: with scales and labels.
    Large,
}

impl PlotDetail {
    /// Returns n such that drawing every n-th corner suffices: a stroke costs the same at any length, and those of a
    /// small picture need not be shorter than two pixels.
    fn step(self, num_corners: usize, pixels: f32) -> usize {
        match self {
            Self::Large => 1,
            Self::Small => num_corners
                .div_ceil((pixels / 2.0).max(8.0) as usize)
                .max(1),
        }
    }
}

/// The paper's threshold for E, 1e-6 m², as a power of ten.
const THRESHOLD: f64 = -6.0;

impl Pictures<'_> {
    /// Draws the picture of a stage into a rectangle.
    pub(super) fn paint(&self, panel: StagePanel, ui: &mut Ui, rect: Rect, detail: PlotDetail) {
        let painter = &ui.painter_at(rect);
        painter.rect_filled(rect, ROUNDING, self.theme.canvas);
        let figures = &self.inspected.figures;
        let inner = Self::inner(rect, detail);
        let is_there = match panel {
            StagePanel::Segmentation => self.segmentation.map(|made| paint(made, painter, rect)),
            StagePanel::BinaryImage => self.binary.map(|made| paint(made, painter, rect)),
            StagePanel::Contour => figures
                .contour
                .as_ref()
                .map(|contour| self.contour(contour, painter, inner, detail)),
            StagePanel::Signature => figures
                .signature
                .as_ref()
                .map(|curves| self.signature(curves, ui, inner, detail)),
            StagePanel::Ranking => (!figures.candidates.is_empty())
                .then(|| self.ranking(&figures.candidates, painter, inner, detail)),
            StagePanel::Alignment => self
                .candidate()
                .map(|candidate| self.alignment(candidate, ui, inner, detail)),
        };
        if is_there.is_none() {
            let says = match panel {
                // This stage always runs.
                StagePanel::Segmentation => text!("inspect-no-picture"),
                _ => text!("inspect-not-reached"),
            };
            self.says(painter, inner, &says);
        }
    }

    /// The rectangle without the edge of its picture.
    pub(super) fn inner(rect: Rect, detail: PlotDetail) -> Rect {
        rect.shrink(match detail {
            PlotDetail::Large => 12.0,
            PlotDetail::Small => 5.0,
        })
    }

    /// Smallest and largest coordinates of the contour; enlarged, also of the enrolled outline over it.
    pub(super) fn contour_bounds(
        &self,
        figure: &ContourFigure,
        detail: PlotDetail,
    ) -> [[f32; 2]; 2] {
        let enlarged = self.candidate().filter(|_| detail == PlotDetail::Large);
        let outline = enlarged.map_or(&[][..], |candidate| &candidate.outline[..]);
        outline.iter().fold(figure.bounds, |[low, high], [x, y]| {
            [
                [low[0].min(*x), low[1].min(*y)],
                [high[0].max(*x), high[1].max(*y)],
            ]
        })
    }

    /// Draws a text in place of a picture.
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

    /// Returns why the chosen candidate was not aligned, if it was not.
    pub(super) fn not_aligned(&self) -> Option<String> {
        match self.candidate()?.alignment {
            Alignment::Done { .. } => None,
            Alignment::None(why) => Some(why.title()),
        }
    }

    fn contour(&self, figure: &ContourFigure, painter: &Painter, rect: Rect, detail: PlotDetail) {
        let at = plane_in(rect, self.contour_bounds(figure, detail));
        let centroid = at(&figure.centroid);
        let corners = |border: &PlaneLine| -> Vec<Pos2> {
            let step = detail.step(border.len(), rect.width());
            let last = border.last().into_iter();
            border.iter().step_by(step).chain(last).map(&at).collect()
        };
        let ray = Stroke::new(1.0, self.theme.weak_text.gamma_multiply(0.45));
        let step = detail.step(figure.ray_ends.len(), rect.width());
        for end in figure.ray_ends.iter().step_by(step) {
            painter.line_segment([centroid, at(end)], ray);
        }
        for (index, border) in figure.borders.iter().enumerate() {
            let colour = if index == 0 {
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

    fn signature(&self, scene: &SignatureCurves, ui: &mut Ui, rect: Rect, detail: PlotDetail) {
        let reference = self.candidate().and_then(|c| c.curves.as_ref());
        let units = self.session.units;
        let (lengths, angles) = (reference.map(|r| &r.lengths), reference.map(|r| &r.angles));
        let halves = [
            ("L", units.length_axis(), &scene.lengths, lengths),
            ("Θ", units.angle_axis(), &scene.angles, angles),
        ];
        let middle = rect.center().y;
        let rows = [rect.with_max_y(middle - 4.0), rect.with_min_y(middle + 4.0)];
        for ((name, unit, values, other), area) in halves.into_iter().zip(rows) {
            let step = detail.step(values.len(), rect.width());
            let thin =
                |values: &Vec<f32>| -> Vec<f32> { values.iter().step_by(step).copied().collect() };
            let (scene, part) = (thin(values), other.map(thin));
            let curves = RayCurves {
                name,
                unit: (detail == PlotDetail::Large).then_some(unit),
                scene: &scene,
                part: part.as_deref(),
            };
            curves.show(ui, area);
        }
    }

    fn alignment(&self, candidate: &RankedPartFigure, ui: &mut Ui, rect: Rect, detail: PlotDetail) {
        let (log_e, rms_m) = match &candidate.alignment {
            Alignment::Done { log_e, rms_m } if !log_e.is_empty() => (log_e, *rms_m),
            Alignment::Done { .. } => {
                return self.says(ui.painter(), rect, &text!("inspect-e-stayed-zero"));
            }
            Alignment::None(why) => return self.says(ui.painter(), rect, &why.title()),
        };
        let theme = self.theme;
        let [low, high] = range_of(log_e);
        let up = [low.min(THRESHOLD).floor(), high.max(THRESHOLD + 1.0).ceil()];
        let is_large = detail == PlotDetail::Large;
        let rms = self.session.units.length(rms_m);
        let title = text!("inspect-ended-at", part = &candidate.title, rms = rms);
        let last = (log_e.len() - 1) as f64;
        let mut iterations = Vec::new();
        let mut read: Option<Box<dyn Fn(f64) -> String + '_>> = None;
        if is_large {
            iterations.extend([0.0, last.max(1.0)].map(|at| (at, format!("{at:.0}"))));
            read = Some(Box::new(move |at| {
                let index = at.round().clamp(0.0, last) as usize;
                let e = format!("{:.2e}", 10.0_f32.powf(log_e[index]));
                text!("inspect-at-iteration", iteration = index, e = e)
            }));
        }
        let axes = Axes {
            title: is_large
                .then_some((title, theme.text))
                .into_iter()
                .collect(),
            across: Axis::new([0.0, last.max(1.0)], iterations),
            up: Axis::powers(up, |power| format!("1e{power}")),
            font: if is_large {
                font::body()
            } else {
                font::scale()
            },
            read,
        };
        axes.show(ui, rect, |plot| {
            let colour = theme.second_series;
            let threshold = HLine::new("", THRESHOLD).color(colour).width(1.4);
            plot.hline(threshold.style(LineStyle::Dashed { length: 5.0 }));
            plot.line(curve(log_e, theme.first_series));
            let end = log_e.last().map(|e| vec![[last, f64::from(*e)]]);
            let end = Points::new("", end.unwrap_or_default()).radius(3.0);
            plot.points(end.color(theme.first_series));
            if is_large {
                let text = RichText::new(text!("inspect-papers-threshold")).small();
                let above = THRESHOLD + 0.01 * (up[1] - up[0]);
                let at = PlotPoint::new(last.max(1.0), above);
                let text = Text::new("", at, text).color(colour);
                plot.text(text.anchor(Align2::RIGHT_BOTTOM));
            }
        });
    }
}

/// Draws a texture in the middle of a rectangle.
fn paint(texture: &TextureHandle, painter: &Painter, rect: Rect) {
    let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
    let place = fitted(rect, texture.aspect_ratio());
    // Dim textures of an old result as the painter dims the rest.
    let tint = Color32::WHITE.gamma_multiply(painter.opacity());
    painter.image(texture.id(), place, whole, tint);
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
