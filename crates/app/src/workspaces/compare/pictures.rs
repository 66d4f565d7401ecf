//! The three pictures of a comparison: overlaid outlines, signatures, correlations.

use egui::{
    Align2, Color32, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, WidgetInfo, pos2,
    vec2,
};
use egui_plot::FilledArea;

use super::{
    CompareState,
    comparison::{AxisQuantity, Correlated, Correlation, OutlineComparison},
};
use shell::{language::UnitSystem, session::Session};
use stages::rank::Matcher;
use ui::{
    language::text,
    plot::{Axes, Axis, RayCurves, curve, range_of},
    theme::{ROUNDING, Theme, font},
    widgets::{fitted_middle, plane_in},
};

/// Height of a picture's title.
const TITLE_HEIGHT_PX: f32 = 19.0;
/// Captions of a picture narrower than this have two lines.
const TWO_LINE_WIDTH_PX: f32 = 270.0;

pub(super) fn ui(ui: &mut Ui, rects: [Rect; 3], compare: &CompareState, session: &Session) {
    let theme = Theme::of(ui);
    ui.scope(|ui| {
        if compare.is_study_old() {
            ui.multiply_opacity(0.55);
        }
        let study = compare.study.as_ref();
        let comparison = study.and_then(|study| study.comparison.as_ref());
        let Some(comparison) = comparison else {
            empty(ui, rects, compare);
            return;
        };
        let units = session.units;
        let outlines = outline_captions(comparison, units);
        let picture = Picture::new(ui, rects[0], &text!("compare-contours"), &outlines);
        picture.overlay(comparison, theme);
        let name = text!("inspect-signatures");
        let caption = match comparison.matcher {
            Matcher::Default => text!("compare-signatures-default"),
            Matcher::Paper => text!("compare-signatures-paper"),
        };
        let picture = Picture::new(ui, rects[1], &name, &caption);
        for (trace, area) in comparison.traces.iter().zip(rows(picture.inner, 2)) {
            let unit = match trace.measure {
                AxisQuantity::Length => units.length_axis(),
                AxisQuantity::Angle => units.angle_axis(),
                AxisQuantity::Pixels => (1.0, "px", 0),
            };
            let curves = RayCurves {
                name: trace.name,
                unit: Some(unit),
                scene: &trace.query,
                part: Some(&trace.reference),
            };
            curves.show(ui, area);
        }
        let name = text!("compare-correlations");
        let share = format!("{:.2}", comparison.relative_l1);
        let caption = match comparison.matcher {
            Matcher::Default => text!("compare-correlations-default", share = share),
            Matcher::Paper => {
                let value = format!("{:.3e}", comparison.l1);
                text!("compare-correlations-paper", value = value, share = share)
            }
        };
        let picture = Picture::new(ui, rects[2], &name, &caption);
        let all = &comparison.correlations;
        if all.is_empty() {
            let (at, text) = (picture.inner.center(), text!("compare-no-lag"));
            picture.text(at, Align2::CENTER_CENTER, &text, theme.weak_text);
        }
        for (one, area) in all.iter().zip(rows(picture.inner, all.len())) {
            correlation(ui, one, area);
        }
    });
}

fn outline_captions(comparison: &OutlineComparison, units: UnitSystem) -> String {
    comparison.overlay.as_ref().map_or_else(
        || text!("compare-no-lag"),
        |overlay| {
            text!(
                "compare-overlay",
                lag = overlay.lag,
                rays = overlay.num_rays,
                angle = angle(overlay.turn, units),
                distance = units.length(overlay.distance),
            )
        },
    )
}

fn angle(radians: f64, units: UnitSystem) -> String {
    match units {
        UnitSystem::MillimetresDegrees => format!("{:.1}°", radians.to_degrees()),
        UnitSystem::MetresRadians => format!("{radians:.3} rad"),
    }
}

/// Draws what to do while there is no comparison.
fn empty(ui: &mut Ui, rects: [Rect; 3], compare: &CompareState) {
    let theme = Theme::of(ui);
    let text = match (&compare.study, compare.running()) {
        (Some(study), _) => {
            let reason = study.reason();
            let reason = reason.unwrap_or_else(|| text!("compare-no-outline-reason"));
            let what = text!("compare-no-outline", reason = reason);
            format!("{what}\n{}", study.advice())
        }
        (None, Some(running)) => format!("{}…", running.title),
        (None, None) => {
            let what = text!("compare-nothing-to-compare");
            format!("{what}\n{}", text!("compare-nothing-to-compare-advice"))
        }
    };
    let rect = rects[0].union(rects[2]);
    let wrap = rect.width() * 0.8;
    let painter = ui.painter();
    let galley = painter.layout(text.clone(), font::verdict(), theme.weak_text, wrap);
    let at = Align2::CENTER_CENTER
        .align_size_within_rect(galley.size(), rect)
        .min;
    painter.galley(at, galley, theme.weak_text);
    let response = ui.interact(rect, ui.scope_id().with("nothing"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, &text));
}

/// A picture with a title and a caption of figures.
struct Picture {
    painter: Painter,
    inner: Rect,
    response: Response,
}

impl Picture {
    fn new(ui: &Ui, rect: Rect, title: &str, caption: &str) -> Self {
        let theme = Theme::of(ui);
        let painter = ui.painter_at(rect);
        painter.text(
            rect.min,
            Align2::LEFT_TOP,
            title,
            font::body_strong(),
            theme.text,
        );
        let at = rect.min + vec2(0.0, TITLE_HEIGHT_PX);
        let lines = painter.layout(
            caption.to_owned(),
            font::small(),
            theme.weak_text,
            rect.width(),
        );
        // Side by side, the pictures begin at the same height.
        let least = if rect.width() < TWO_LINE_WIDTH_PX {
            30.0
        } else {
            15.0
        };
        let top = TITLE_HEIGHT_PX + lines.size().y.max(least) + 5.0;
        painter.galley(at, lines, theme.weak_text);
        let canvas = Rect::from_min_max(rect.min + vec2(0.0, top), rect.max);
        painter.rect_filled(canvas, ROUNDING, theme.canvas);
        let response = ui.interact(canvas, ui.scope_id().with(title), Sense::hover());
        response.widget_info(|| {
            WidgetInfo::labeled(egui::Role::Image, true, format!("{title}: {caption}"))
        });
        Self {
            painter,
            inner: canvas.shrink(8.0),
            response,
        }
    }

    fn text(&self, at: Pos2, anchor: Align2, text: &str, colour: Color32) {
        self.painter.text(at, anchor, text, font::small(), colour);
    }

    /// Draws names in the colours of their curves, one below the other.
    fn legend(&self, names: &[(&str, Color32)]) {
        for (index, (name, colour)) in names.iter().enumerate() {
            let at = self.inner.min + vec2(0.0, 14.0 * index as f32);
            self.text(at, Align2::LEFT_TOP, name, *colour);
        }
    }

    fn overlay(&self, comparison: &OutlineComparison, theme: &Theme) {
        let part = format!("- - {}", comparison.title);
        let room = self.inner.width();
        let shown = fitted_middle(&self.painter, &part, &font::small(), room);
        if shown != part {
            self.response.clone().on_hover_text(&comparison.title);
        }
        self.legend(&[
            (&text!("compare-legend-query"), theme.first_series),
            (&shown, theme.reference_series),
        ]);
        let Some(overlay) = &comparison.overlay else {
            return;
        };
        let mut room = self.inner;
        room.min.y += 30.0;
        let at = plane_in(room, overlay.bounds);
        let join = Stroke::new(1.0, theme.rejected.gamma_multiply(0.7));
        for [from, to] in &overlay.joins {
            self.painter.line_segment([at(from), at(to)], join);
        }
        let outline: Vec<Pos2> = overlay.reference.iter().map(&at).collect();
        let stroke = Stroke::new(1.4, theme.reference_series);
        self.painter
            .extend(Shape::dashed_line(&outline, stroke, 6.0, 3.0));
        let outline = overlay.query.iter().map(&at).collect();
        self.painter
            .line(outline, Stroke::new(1.6, theme.first_series));
        self.painter
            .circle_filled(at(&overlay.centroid), 3.5, theme.second_series);
    }
}

/// Splits the rectangle into equal rows.
fn rows(rect: Rect, num: usize) -> impl Iterator<Item = Rect> {
    let height = rect.height() / num as f32;
    (0..num).map(move |index| {
        let top = rect.top() + height * index as f32;
        Rect::from_min_size(pos2(rect.left(), top), vec2(rect.width(), height - 4.0))
    })
}

fn correlation(ui: &mut Ui, correlation: &Correlation, area: Rect) {
    let theme = Theme::of(ui);
    let Correlation { auto, cross, .. } = correlation;
    let range = range_of(auto.iter().chain(cross));
    let decimals = if range[1] < 10.0 { 3 } else { 0 };
    let text = |value: f64| {
        if value.abs() >= 1e5 {
            format!("{value:.1e}")
        } else {
            format!("{value:.decimals$}")
        }
    };
    let last = auto.len().max(cross.len()).saturating_sub(1).max(1) as f64;
    // Lags are further apart where the curve was thinned.
    let first = correlation.first_lag as f64;
    let per_value = -2.0 * first / last;
    let lag_of = move |index: f64| (first + index * per_value).round();
    let (name, middle) = match correlation.of {
        Correlated::Rays => (text!("compare-rays"), text!("compare-lag-zero-rays")),
        Correlated::Lengths => ("L, px²".to_owned(), text!("compare-lag-zero-pixels")),
        Correlated::Angles => ("Θ, rad²".to_owned(), text!("compare-lag-zero-pixels")),
    };
    let marks = vec![
        (0.0, first.to_string()),
        (last / 2.0, middle),
        (last, lag_of(last).to_string()),
    ];
    let read = move |x: f64| {
        let index = x.round().clamp(0.0, last);
        let value = |values: &[f32]| values.get(index as usize).copied().unwrap_or_default();
        let [auto, cross] = [auto, cross].map(|values| format!("{:.decimals$}", value(values)));
        let lag = lag_of(index).to_string();
        text!("compare-lag-read", lag = lag, auto = auto, cross = cross)
    };
    let axes = Axes {
        title: vec![
            (format!("{name}:  "), theme.weak_text),
            (text!("compare-auto") + "  ", theme.reference_series),
            (text!("compare-cross"), theme.first_series),
        ],
        across: Axis::new([0.0, last], marks),
        up: Axis::new(range, range.map(|value| (value, text(value))).to_vec()),
        font: font::small(),
        read: Some(Box::new(read)),
    };
    axes.show(ui, area, |plot| {
        let ends = auto.iter().zip(cross).enumerate();
        let ends: Vec<[f64; 3]> = ends
            .map(|(index, (a, c))| [index as f64, f64::from(*a), f64::from(*c)])
            .collect();
        let column = |which: usize| -> Vec<f64> { ends.iter().map(|row| row[which]).collect() };
        let between = FilledArea::new("", &column(0), &column(1), &column(2));
        plot.add(between.fill_color(theme.rejected.gamma_multiply(0.4)));
        plot.line(curve(auto, theme.reference_series).width(1.4));
        plot.line(curve(cross, theme.first_series));
    });
}
