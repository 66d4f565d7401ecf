//! The three pictures of a comparison: outlines over each other, signatures, correlations.

use egui::{
    Align2, Color32, Mesh, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, WidgetInfo,
    pos2, vec2,
};

use super::{
    CompareState,
    comparison::{AxisQuantity, Correlation, OutlineComparison, Overlay, Trace},
};
use crate::{
    app::{
        inspection::unit_system::UnitSystem,
        shell::session::Session,
        ui::{
            theme::{ROUNDING, Theme, font},
            widgets::{Scale, curve, fitted},
        },
    },
    stages::rank::Matcher,
};

/// Height of a picture's title.
const TITLE: f32 = 19.0;
/// Captions of a picture narrower than this have two lines.
const NARROW: f32 = 270.0;

/// Draws all three, each into its rectangle.
pub(super) fn ui(
    ui: &mut Ui,
    rects: [Rect; 3],
    compare: &CompareState,
    session: &Session,
    theme: &Theme,
) {
    ui.scope(|ui| {
        if compare.is_study_old() {
            ui.multiply_opacity(0.55);
        }
        let study = compare.study.as_ref();
        let comparison = study.and_then(|study| study.comparison.as_ref());
        let Some(comparison) = comparison else {
            empty(ui, rects, compare, theme);
            return;
        };
        let units = session.units;
        let outlines = outline_captions(comparison, units);
        let picture = Picture::new(ui, rects[0], theme, "Contours at the best lag", &outlines);
        picture.overlay(comparison, theme);
        let name = "Signatures";
        let caption = match comparison.matcher {
            Matcher::Default => "query and part, part shifted by the lag",
            Matcher::Paper => "as the paper writes them: no lag, Θ folded",
        };
        Picture::new(ui, rects[1], theme, name, caption).traces(comparison, units, theme);
        let name = "Auto- and cross-correlation";
        let caption = match comparison.matcher {
            Matcher::Default => {
                let share = comparison.relative_l1;
                format!("default: finds the lag · ‖A − C‖₁ {share:.2} of ‖A‖₁ · axis not from 0")
            }
            Matcher::Paper => {
                let (l1, share) = (comparison.l1, comparison.relative_l1);
                format!("paper: ‖A − C‖₁ {l1:.3e} px² + rad² · {share:.2} of ‖A‖₁")
            }
        };
        Picture::new(ui, rects[2], theme, name, &caption).correlations(comparison, theme);
    });
}

fn outline_captions(comparison: &OutlineComparison, units: UnitSystem) -> String {
    comparison.overlay.as_ref().map_or_else(
        || "no lag found".into(),
        |overlay| {
            format!(
                "lag {} of {} · turned {} · {} apart",
                overlay.lag,
                overlay.num_rays,
                angle(overlay.turn, units),
                units.length(overlay.distance)
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

/// Without a comparison: what to do.
fn empty(ui: &mut Ui, rects: [Rect; 3], compare: &CompareState, theme: &Theme) {
    let text = match (&compare.study, compare.running()) {
        (Some(study), _) => {
            let reason = study.found.reason.as_deref().unwrap_or("no outline");
            format!("There is no outline to compare: {reason}\n{}", study.advice)
        }
        (None, Some(running)) => format!("{}…", running.title),
        (None, None) => {
            "Nothing to compare yet\nCapture a scene (Space), open one, or open a kept case".into()
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

/// A picture with its title and what it says in figures.
struct Picture {
    painter: Painter,
    response: Response,
    inner: Rect,
}

impl Picture {
    fn new(ui: &Ui, rect: Rect, theme: &Theme, title: &str, caption: &str) -> Self {
        let painter = ui.painter_at(rect);
        painter.text(
            rect.min,
            Align2::LEFT_TOP,
            title,
            font::body_strong(),
            theme.text,
        );
        let at = rect.min + vec2(0.0, TITLE);
        let lines = painter.layout(
            caption.to_owned(),
            font::small(),
            theme.weak_text,
            rect.width(),
        );
        // Side by side the pictures begin at the same height.
        let least = if rect.width() < NARROW { 30.0 } else { 15.0 };
        let top = TITLE + lines.size().y.max(least) + 5.0;
        painter.galley(at, lines, theme.weak_text);
        let canvas = Rect::from_min_max(rect.min + vec2(0.0, top), rect.max);
        painter.rect_filled(canvas, ROUNDING, theme.canvas);
        let response = ui.interact(canvas, ui.scope_id().with(title), Sense::hover());
        response.widget_info(|| {
            WidgetInfo::labeled(egui::Role::Image, true, format!("{title}: {caption}"))
        });
        Self {
            painter,
            response,
            inner: canvas.shrink(8.0),
        }
    }

    fn text(&self, at: Pos2, anchor: Align2, text: &str, colour: Color32) {
        self.painter.text(at, anchor, text, font::small(), colour);
    }

    /// Names in the colours of their curves, one below the other.
    fn legend(&self, names: &[(&str, Color32)]) {
        for (place, (name, colour)) in names.iter().enumerate() {
            let at = self.inner.min + vec2(0.0, 14.0 * place as f32);
            self.text(at, Align2::LEFT_TOP, name, *colour);
        }
    }

    fn overlay(&self, comparison: &OutlineComparison, theme: &Theme) {
        let part = format!("- - {}", comparison.title);
        self.legend(&[
            ("— query", theme.first_series),
            (&part, theme.reference_series),
        ]);
        let Some(overlay) = &comparison.overlay else {
            return;
        };
        let Overlay { bounds, .. } = overlay;
        let [low, high] = *bounds;
        let (wide, tall) = ((high[0] - low[0]).max(1e-3), (high[1] - low[1]).max(1e-3));
        let mut room = self.inner;
        room.min.y += 30.0;
        let place = fitted(room, wide / tall);
        let (across, up) = (
            Scale::new([low[0], high[0]], [place.left(), place.right()]),
            Scale::new([low[1], high[1]], [place.bottom(), place.top()]),
        );
        let at = |p: &[f32; 2]| pos2(across.at(p[0]), up.at(p[1]));
        let join = Stroke::new(1.0, theme.rejected.gamma_multiply(0.7));
        for [from, to] in &overlay.joins {
            self.painter.line_segment([at(from), at(to)], join);
        }
        let outline: Vec<Pos2> = overlay.reference.iter().map(at).collect();
        let stroke = Stroke::new(1.4, theme.reference_series);
        self.painter
            .extend(Shape::dashed_line(&outline, stroke, 6.0, 3.0));
        let outline = overlay.query.iter().map(at).collect();
        self.painter
            .line(outline, Stroke::new(1.6, theme.first_series));
        self.painter
            .circle_filled(at(&overlay.centroid), 3.5, theme.second_series);
    }

    fn traces(&self, comparison: &OutlineComparison, units: UnitSystem, theme: &Theme) {
        for (trace, area) in comparison.traces.iter().zip(halves(self.inner, 2)) {
            self.trace(trace, area, units, theme);
        }
    }

    fn trace(&self, trace: &Trace, area: Rect, units: UnitSystem, theme: &Theme) {
        let (per, unit, decimals) = shown_in(trace.measure, units);
        let title = format!("{}, {unit}", trace.name);
        let colour = match trace.name {
            "L" => theme.first_series,
            _ => theme.second_series,
        };
        let plot = self.axes(area, trace.range, per, decimals, theme);
        let num = trace.query.len().max(trace.reference.len());
        let across = Scale::new(
            [0.0, num.saturating_sub(1).max(1) as f32],
            [plot.left(), plot.right()],
        );
        let up = Scale::new(trace.range, [plot.bottom(), plot.top()]);
        let reference = curve(&trace.reference, &across, &up);
        let stroke = Stroke::new(1.3, theme.reference_series);
        self.painter
            .extend(Shape::dashed_line(&reference, stroke, 6.0, 3.0));
        self.painter
            .line(curve(&trace.query, &across, &up), Stroke::new(1.6, colour));
        let at = pos2(plot.left(), area.top());
        self.text(at, Align2::LEFT_TOP, &title, colour);
        let read = |place: usize| {
            let value = |values: &[f32]| {
                values
                    .get(place)
                    .map_or("–".to_owned(), |v| format!("{:.decimals$}", v * per))
            };
            let (query, part) = (value(&trace.query), value(&trace.reference));
            format!("ray {place}: query {query}, part {part} {unit}")
        };
        self.readout(area, plot, num, theme, &read);
    }

    fn correlations(&self, comparison: &OutlineComparison, theme: &Theme) {
        let correlations = &comparison.correlations;
        if correlations.is_empty() {
            let at = self.inner.center();
            self.text(at, Align2::CENTER_CENTER, "no lag found", theme.weak_text);
            return;
        }
        for (correlation, area) in correlations
            .iter()
            .zip(halves(self.inner, correlations.len()))
        {
            self.correlation(correlation, area, theme);
        }
    }

    fn correlation(&self, correlation: &Correlation, area: Rect, theme: &Theme) {
        let Correlation {
            auto,
            cross,
            range,
            name,
            ..
        } = correlation;
        let range = *range;
        let decimals = if range[1] < 10.0 { 3 } else { 0 };
        let mut below = area;
        below.max.y -= 14.0;
        let plot = self.axes(below, range, 1.0, decimals, theme);
        let num = auto.len().max(cross.len());
        let last = num.saturating_sub(1).max(1) as f32;
        let across = Scale::new([0.0, last], [plot.left(), plot.right()]);
        let up = Scale::new(range, [plot.bottom(), plot.top()]);
        let (a, c) = (curve(auto, &across, &up), curve(cross, &across, &up));
        self.painter
            .add(between(&a, &c, theme.rejected.gamma_multiply(0.4)));
        self.painter
            .line(a, Stroke::new(1.4, theme.reference_series));
        self.painter.line(c, Stroke::new(1.6, theme.first_series));
        let legend = [
            (format!("{name}:"), theme.weak_text),
            ("A: itself".to_owned(), theme.reference_series),
            ("C: query".to_owned(), theme.first_series),
        ];
        let mut at = pos2(plot.left(), below.top());
        for (text, colour) in legend {
            let drawn = self
                .painter
                .text(at, Align2::LEFT_TOP, text, font::small(), colour);
            at.x = drawn.right() + 6.0;
        }
        // Lags stand further apart where the curve was thinned.
        let (first, whole) = (correlation.first_lag, -2 * correlation.first_lag);
        let per_value = whole as f32 / last;
        let lag_of = |place: usize| first + (place as f32 * per_value).round() as i64;
        let zero = across.at(-first as f32 / per_value.max(f32::MIN_POSITIVE));
        self.painter
            .vline(zero, plot.y_range(), theme.edge_stroke());
        let zero_text = format!("lag 0, in {}", correlation.steps);
        let at = pos2(zero, plot.bottom() + 1.0);
        self.text(at, Align2::CENTER_TOP, &zero_text, theme.weak_text);
        let at = pos2(plot.left(), plot.bottom() + 1.0);
        self.text(at, Align2::LEFT_TOP, &first.to_string(), theme.weak_text);
        let at = pos2(plot.right(), plot.bottom() + 1.0);
        let last_lag = lag_of(num.saturating_sub(1)).to_string();
        self.text(at, Align2::RIGHT_TOP, &last_lag, theme.weak_text);
        let read = |place: usize| {
            let value = |values: &[f32]| values.get(place).copied().unwrap_or_default();
            let (a, c) = (value(auto), value(cross));
            let lag = lag_of(place);
            format!("lag {lag}: A {a:.decimals$}, C {c:.decimals$}")
        };
        self.readout(below, plot, num, theme, &read);
    }

    /// Least and greatest value on the left; what remains is for the curves.
    fn axes(&self, area: Rect, range: [f32; 2], per: f32, decimals: usize, theme: &Theme) -> Rect {
        let texts = range.map(|value| {
            let value = value * per;
            if value.abs() >= 1e5 {
                format!("{value:.1e}")
            } else {
                format!("{value:.decimals$}")
            }
        });
        let width = texts.iter().map(String::len).max().unwrap_or(0) as f32 * 6.6 + 6.0;
        let plot = Rect::from_min_max(area.min + vec2(width, 16.0), area.max - vec2(2.0, 6.0));
        for (y, text) in [plot.bottom(), plot.top()].into_iter().zip(&texts) {
            self.painter.hline(plot.x_range(), y, theme.edge_stroke());
            let at = pos2(plot.left() - 5.0, y);
            self.painter.text(
                at,
                Align2::RIGHT_CENTER,
                text,
                font::scale(),
                theme.weak_text,
            );
        }
        plot
    }

    /// Where the pointer is, in figures.
    fn readout(
        &self,
        area: Rect,
        plot: Rect,
        num: usize,
        theme: &Theme,
        read: &dyn Fn(usize) -> String,
    ) {
        let pointer = self.response.hover_pos();
        let Some(pointer) = pointer.filter(|at| area.contains(*at) && num > 0) else {
            return;
        };
        let share = ((pointer.x - plot.left()) / plot.width()).clamp(0.0, 1.0);
        let place = (share * (num - 1) as f32).round() as usize;
        let x = plot.left() + plot.width() * place as f32 / (num - 1).max(1) as f32;
        self.painter
            .vline(x, plot.y_range(), Stroke::new(1.0, theme.text));
        let galley = self
            .painter
            .layout_no_wrap(read(place), font::small(), theme.text);
        let at = pos2(plot.right() - galley.size().x - 4.0, plot.bottom() - 18.0);
        let back = Rect::from_min_size(at, galley.size()).expand(3.0);
        self.painter.rect_filled(back, ROUNDING, theme.control);
        self.painter.galley(at, galley, theme.text);
    }
}

/// Factor, sign and digits in which a measure is shown.
fn shown_in(measure: AxisQuantity, units: UnitSystem) -> (f32, &'static str, usize) {
    match (measure, units) {
        (AxisQuantity::Length, UnitSystem::MillimetresDegrees) => (1000.0, "mm", 0),
        (AxisQuantity::Length, UnitSystem::MetresRadians) => (1.0, "m", 3),
        (AxisQuantity::Angle, UnitSystem::MillimetresDegrees) => {
            (180.0 / std::f32::consts::PI, "°", 0)
        }
        (AxisQuantity::Angle, UnitSystem::MetresRadians) => (1.0, "rad", 2),
        (AxisQuantity::Pixels, _) => (1.0, "px", 0),
    }
}

/// The rectangle in as many equal rows.
fn halves(rect: Rect, num: usize) -> impl Iterator<Item = Rect> {
    let height = rect.height() / num as f32;
    (0..num).map(move |place| {
        let top = rect.top() + height * place as f32;
        Rect::from_min_size(pos2(rect.left(), top), vec2(rect.width(), height - 4.0))
    })
}

/// The area between two curves over the same places.
fn between(a: &[Pos2], c: &[Pos2], colour: Color32) -> Shape {
    let mut mesh = Mesh::default();
    for (a, c) in a.iter().zip(c) {
        mesh.colored_vertex(*a, colour);
        mesh.colored_vertex(*c, colour);
    }
    for corner in (0..mesh.vertices.len().saturating_sub(2) as u32).step_by(2) {
        mesh.add_triangle(corner, corner + 1, corner + 2);
        mesh.add_triangle(corner + 1, corner + 2, corner + 3);
    }
    Shape::mesh(mesh)
}
