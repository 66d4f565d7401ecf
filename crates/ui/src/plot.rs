//! Plots: curves over two axes, drawn by `egui_plot` in the window's colours. A plot neither moves nor zooms, so that the
//! wheel scrolls the panel around it.

use egui::{
    Align2, Color32, FontId, Painter, Pos2, Rangef, Rect, Sense, Shape, Stroke, Ui, UiBuilder,
    Vec2, WidgetInfo, pos2,
    text::{LayoutJob, TextFormat},
    vec2,
};
use egui_plot::{
    AxisHints, GridInput, GridMark, HoverPosition, Line, LineStyle, Plot, PlotPoint, PlotPoints,
    PlotTransform, PlotUi,
};
use jiff::Zoned;

use super::theme::{ROUNDING, Theme, font, space};
use crate::language::text;

/// Margin beyond both ends of an axis, as a share of its range: a line at the end stays fully visible.
const MARGIN: f64 = 0.03;
/// With more powers of ten than this, only every second one is marked.
const MANY_POWERS: usize = 8;
/// Height of a plot over time, logical pixels.
const OVER_TIME: f32 = 150.0;

/// The range of an axis and its tick marks.
#[derive(Clone, Debug)]
pub struct Axis {
    range: [f64; 2],
    marks: Vec<(f64, String)>,
}

impl Axis {
    pub fn new(range: [f64; 2], marks: Vec<(f64, String)>) -> Self {
        Self { range, marks }
    }

    /// Makes a logarithmic axis: `range` and curves are base-10 logarithms.
    pub fn powers(range: [f64; 2], name: impl Fn(i32) -> String) -> Self {
        let inside = |power: &i32| (range[0]..=range[1]).contains(&f64::from(*power));
        let powers: Vec<i32> = (-20..=20).filter(inside).collect();
        let step = if powers.len() > MANY_POWERS { 2 } else { 1 };
        let powers = powers.into_iter().filter(|power| power % step == 0);
        let marks = powers.map(|power| (f64::from(power), name(power)));
        Self::new(range, marks.collect())
    }

    fn in_sight(&self) -> [f64; 2] {
        let [low, high] = self.range;
        let margin = ((high - low) * MARGIN).max(1e-6);
        [low - margin, high + margin]
    }

    fn grid(&self) -> impl Fn(GridInput) -> Vec<GridMark> + use<> {
        let [low, high] = self.in_sight();
        let values: Vec<f64> = self.marks.iter().map(|(value, _)| *value).collect();
        move |_| {
            // Report a large spacing, so that every mark is labelled; whoever sets the marks leaves room for them.
            let step_size = high - low;
            let mark = |value: &f64| GridMark {
                value: *value,
                step_size,
            };
            values.iter().map(mark).collect()
        }
    }

    fn hints(self, hints: AxisHints<'_>, thickness: f32) -> AxisHints<'_> {
        hints
            .min_thickness(thickness)
            .label_spacing(Rangef::new(0.0, 1.0))
            .formatter(move |mark, _| {
                let is_it = |(value, _): &&(f64, String)| value.total_cmp(&mark.value).is_eq();
                let found = self.marks.iter().find(is_it);
                found.map_or_else(String::new, |(_, text)| text.clone())
            })
    }
}

/// Returns the space needed for the text of the marks, logical pixels.
fn text_size<'m>(
    ui: &Ui,
    font: &FontId,
    marks: impl IntoIterator<Item = &'m (f64, String)>,
) -> Vec2 {
    let sizes = marks.into_iter().map(|(_, text)| {
        let painter = ui.painter();
        let galley = painter.layout_no_wrap(text.clone(), font.clone(), Color32::WHITE);
        galley.size()
    });
    sizes.fold(Vec2::ZERO, Vec2::max)
}

/// A plot without its curves.
pub struct Axes<'a> {
    /// Title, as pieces of text with a colour each; empty for none.
    pub title: Vec<(String, Color32)>,
    /// Axis from left to right.
    pub across: Axis,
    /// Axis from bottom to top.
    pub up: Axis,
    /// Font of title and marks.
    pub font: FontId,
    /// Makes the text shown beside the pointer from a value of the `across` axis.
    pub read: Option<Box<dyn Fn(f64) -> String + 'a>>,
}

impl<'a> Axes<'a> {
    /// Draws the axes into a rectangle, then the curves that `draw` adds. Returns the transform from values to the screen.
    pub fn show(
        self,
        ui: &mut Ui,
        rect: Rect,
        draw: impl FnOnce(&mut PlotUi<'a>) + 'a,
    ) -> PlotTransform {
        let theme = Theme::of(ui);
        let Self {
            title,
            across,
            up,
            font,
            read,
        } = self;
        let mut job = LayoutJob::default();
        for (text, colour) in &title {
            job.append(text, 0.0, TextFormat::simple(font.clone(), *colour));
        }
        let title = ui.painter().layout_job(job);
        let below = text_size(ui, &font, &across.marks);
        let beside = text_size(ui, &font, &up.marks);
        // Half of the last mark's text extends beyond the end of its axis.
        let right = text_size(ui, &font, across.marks.last()).x / 2.0;
        let top = title.size().y.max(beside.y / 2.0);
        let bottom = if below.y > 0.0 { 0.0 } else { beside.y / 2.0 };
        let area = Rect::from_min_max(rect.min + vec2(0.0, top), rect.max - vec2(right, bottom));
        let (x, y) = (across.in_sight(), up.in_sight());
        let mut ui = ui.new_child(UiBuilder::new().max_rect(area));
        let hints = |axis: AxisHints<'a>| {
            let axis = axis.tick_label_font(font.clone());
            axis.tick_label_color(theme.weak_text)
        };
        // The plot keeps no lasting state, so its id may change.
        let plot = Plot::new("plot")
            .id(ui.unique_id().with("plot"))
            .min_size(Vec2::ZERO)
            .allow_drag(false)
            .allow_zoom(false)
            .allow_scroll(false)
            .allow_boxed_zoom(false)
            .allow_axis_zoom_drag(false)
            .allow_double_click_reset(false)
            .sense(egui::Sense::hover())
            .show_background(false)
            .show_axes([below.y > 0.0, beside.y > 0.0])
            .x_grid_spacer(across.grid())
            .y_grid_spacer(up.grid())
            .grid_color(theme.edge)
            .grid_fade(0.0)
            .custom_x_axes(vec![hints(across.hints(AxisHints::new_x(), below.y))])
            .custom_y_axes(vec![hints(up.hints(AxisHints::new_y(), beside.x + 8.0))])
            .cursor_color(theme.text)
            .show_x(read.is_some())
            .show_y(false)
            .label_formatter(move |at| {
                let (HoverPosition::NearDataPoint { position, .. }
                | HoverPosition::Elsewhere { position }) = at;
                read.as_ref().map(|read| read(position.x))
            });
        let shown = plot.show(&mut ui, move |plot| {
            plot.set_plot_bounds_x(x[0]..=x[1]);
            plot.set_plot_bounds_y(y[0]..=y[1]);
            draw(plot);
        });
        // Above the curves, or further left if the title is too wide.
        let left = shown.transform.frame().left();
        let left = left.min(rect.right() - title.size().x).max(rect.left());
        let corner = pos2(left, rect.top());
        ui.painter()
            .with_clip_rect(rect)
            .galley(corner, title, theme.text);
        shown.transform
    }
}

/// L or Θ of the rays of a scene and of an enrolled part.
pub struct RayCurves<'a> {
    /// L or Θ.
    pub name: &'static str,
    /// Factor from stored to shown values, unit sign and decimals; `None` in a picture too small for text.
    pub unit: Option<(f64, &'static str, usize)>,
    /// Values of the scene, one per ray.
    pub scene: &'a [f32],
    /// Values of the part, one per ray.
    pub part: Option<&'a [f32]>,
}

impl RayCurves<'_> {
    /// Draws both curves, the part's dashed.
    pub fn show(self, ui: &mut Ui, area: Rect) {
        let theme = Theme::of(ui);
        let Self {
            name,
            unit,
            scene,
            part,
        } = self;
        let colour = match name {
            "L" => theme.first_series,
            _ => theme.second_series,
        };
        let range = range_of(scene.iter().chain(part.into_iter().flatten()));
        let num = scene.len().max(part.map_or(0, <[f32]>::len));
        let last = num.saturating_sub(1).max(1) as f64;
        let mut axes = Axes {
            title: Vec::new(),
            across: Axis::new([0.0, last], Vec::new()),
            up: Axis::new(range, Vec::new()),
            font: font::small(),
            read: None,
        };
        if let Some((per, unit, decimals)) = unit {
            let text = move |value: f64| format!("{:.decimals$}", value * per);
            axes.title.push((format!("{name}, {unit}"), colour));
            axes.up.marks = range.map(|value| (value, text(value))).to_vec();
            axes.read = Some(Box::new(move |x| {
                let index = x.round().clamp(0.0, last) as usize;
                let value = |values: &[f32]| {
                    let value = values.get(index).copied();
                    value.map_or("–".to_owned(), |value| text(f64::from(value)))
                };
                let part = part.map_or("–".to_owned(), value);
                text!(
                    "view-ray",
                    index = index,
                    query = value(scene),
                    part = part,
                    unit = unit
                )
            }));
        }
        axes.show(ui, area, |plot| {
            if let Some(part) = part {
                let dashed = LineStyle::Dashed { length: 6.0 };
                let line = curve(part, theme.reference_series).width(1.3);
                plot.line(line.style(dashed));
            }
            plot.line(curve(scene, colour));
        });
    }
}

/// A value that a plot marks by a line across: its name, value, colour and style.
pub type Level<'a> = (&'a str, f64, Color32, LineStyle);

/// Curves over moments in time order, with dates along the axis.
pub struct OverTime<'a> {
    /// What is shown.
    pub title: &'a str,
    /// The moments.
    pub at: &'a [Zoned],
    /// Name, values and colour of each curve; values that are not finite leave a gap.
    pub curves: &'a [(&'a str, &'a [f32], Color32)],
    /// Values marked by lines across.
    pub levels: &'a [Level<'a>],
    /// Formats a value.
    pub written: &'a dyn Fn(f64) -> String,
    /// The values that the axis spans at least.
    pub least_span: f64,
    /// The value at which the axis ends at most.
    pub most: f64,
}

impl OverTime<'_> {
    /// Draws it over the width of the panel.
    pub fn show(self, ui: &mut Ui) {
        let theme = Theme::of(ui);
        let Self {
            title,
            at,
            curves,
            levels,
            written,
            least_span,
            most,
        } = self;
        let size = vec2(ui.available_width(), OVER_TIME);
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, title));
        ui.painter().rect_filled(rect, ROUNDING, theme.panel);
        ui.add_space(space::SMALL);
        let last = at.len().saturating_sub(1).max(1);
        let room = (size.x / 110.0).max(1.0) as usize;
        let step = at.len().div_ceil(room).max(1);
        let known = curves.iter().flat_map(|(_, values, _)| *values);
        let marked: Vec<f32> = levels.iter().map(|(_, value, ..)| *value as f32).collect();
        let known = known.filter(|value| value.is_finite()).chain(&marked);
        let [low, high] = range_around(range_of(known), least_span, most);
        let axes = Axes {
            title: vec![(title.to_owned(), theme.text)],
            across: Axis::new([0.0, last as f64], dates(at, step)),
            up: Axis::new(
                [low, high],
                [low, high].map(|value| (value, written(value))).to_vec(),
            ),
            font: font::small(),
            read: Some(Box::new(|across| {
                let index = (across.round().max(0.0) as usize).min(at.len() - 1);
                let at = at[index].strftime("%Y-%m-%d %H:%M:%S");
                let values = curves.iter().map(|(name, values, _)| {
                    let value = f64::from(values[index]);
                    let value = if value.is_finite() {
                        written(value)
                    } else {
                        "–".into()
                    };
                    format!("{name} {value}").trim_start().to_owned()
                });
                let values: Vec<String> = values.collect();
                format!("{at}: {}", values.join(", "))
            })),
        };
        let shown = axes.show(ui, rect.shrink(space::MEDIUM), |plot| {
            for (_, value, colour, style) in levels {
                let ends = PlotPoints::from(vec![[0.0, *value], [last as f64, *value]]);
                let line = Line::new("", ends).color(*colour).width(1.0);
                plot.line(line.style(*style));
            }
            for (_, values, colour) in curves {
                let points = values
                    .iter()
                    .enumerate()
                    .filter(|(_, value)| value.is_finite());
                let points: PlotPoints<'_> = points
                    .map(|(index, value)| [index as f64, f64::from(*value)])
                    .collect();
                plot.line(Line::new("", points).color(*colour).width(1.4));
            }
        });
        let curves = curves
            .iter()
            .map(|(name, _, colour)| (*name, *colour, LineStyle::Solid));
        let levels = levels
            .iter()
            .map(|(name, _, colour, style)| (*name, *colour, *style));
        let names = curves.chain(levels).filter(|(name, ..)| !name.is_empty());
        legend(ui.painter(), &shown, names);
    }
}

/// A quantity that should fall below a limit, over seconds.
pub struct FallingCurve<'a> {
    /// What is shown, with its unit.
    pub title: &'a str,
    /// Seconds and values; those that are not above 0 leave a gap.
    pub points: &'a [[f64; 2]],
    /// The limit, and its name.
    pub limit: (f64, &'a str),
    /// Sign of the unit.
    pub unit: &'static str,
    /// Colour of the curve.
    pub colour: Color32,
}

/// The values that the axis of a falling curve spans at least, powers of ten around its limit.
const LEAST_POWERS: [f64; 2] = [1.5, 1.0];

impl FallingCurve<'_> {
    /// Draws it on a logarithmic axis, with a dashed line at the limit.
    pub fn show(self, ui: &mut Ui, rect: Rect) {
        let theme = Theme::of(ui);
        let Self {
            title,
            points,
            limit: (limit, limit_name),
            unit,
            colour,
        } = self;
        let label = ui.interact(rect, ui.unique_id().with(title), Sense::hover());
        label.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, title));
        ui.painter().rect_filled(rect, ROUNDING, theme.panel);
        let known = move || points.iter().filter(|[_, value]| *value > 0.0);
        let middle = limit.log10();
        let [below, above] = LEAST_POWERS;
        let range = known().fold(
            [middle - below, middle + above],
            |[low, high], [_, value]| [low.min(value.log10()), high.max(value.log10())],
        );
        let last = points.last().map_or(0.0, |[at, _]| *at).max(1.0);
        let axes = Axes {
            title: vec![(title.to_owned(), colour)],
            across: Axis::new([0.0, last], seconds(last)),
            up: Axis::powers(range, power_of_ten),
            font: font::small(),
            read: Some(Box::new(move |at| {
                let near = known().min_by(|a, b| (a[0] - at).abs().total_cmp(&(b[0] - at).abs()));
                near.map_or_else(String::new, |[at, value]| {
                    format!("{at:.1} s: {value:.2} {unit}")
                })
            })),
        };
        let shown = axes.show(ui, rect.shrink(space::MEDIUM), move |plot| {
            let line = PlotPoints::from(vec![[0.0, middle], [last, middle]]);
            let dashed = LineStyle::Dashed { length: 6.0 };
            plot.line(
                Line::new("", line)
                    .color(theme.reference_series)
                    .width(1.4)
                    .style(dashed),
            );
            let values = points.iter().map(|[at, value]| [*at, value.log10()]);
            let values: Vec<[f64; 2]> = values.filter(|[_, value]| value.is_finite()).collect();
            plot.line(Line::new("", values).color(colour).width(1.6));
        });
        // Above the right end of the limit, where the curve has fallen below it.
        let at = shown.position_from_point(&PlotPoint::new(last, middle));
        let colour = theme.reference_series;
        ui.painter().text(
            at - vec2(4.0, 2.0),
            Align2::RIGHT_BOTTOM,
            limit_name,
            font::small(),
            colour,
        );
    }
}

/// Writes a power of ten as a plain number.
fn power_of_ten(power: i32) -> String {
    let decimals = power.min(0).unsigned_abs() as usize;
    format!("{:.decimals$}", 10_f64.powi(power))
}

/// Marks up to about six whole seconds.
fn seconds(last: f64) -> Vec<(f64, String)> {
    let steps = [1.0, 2.0, 5.0, 10.0, 20.0, 60.0, 120.0];
    let step = steps.into_iter().find(|step| last / step <= 6.0);
    let step = step.unwrap_or(600.0);
    let marks = (0..=6_u8).map(|k| f64::from(k) * step);
    let marks = marks.take_while(|at| *at <= last);
    marks.map(|at| (at, format!("{at:.0} s"))).collect()
}

/// Marks every `step`th moment by its date and time: with seconds if two marks in a row would read the same, and only once
/// if they still do.
fn dates(at: &[Zoned], step: usize) -> Vec<(f64, String)> {
    let written = |format: &str| -> Vec<(f64, String)> {
        let marked = at.iter().enumerate().step_by(step);
        marked
            .map(|(index, at)| (index as f64, at.strftime(format).to_string()))
            .collect()
    };
    let mut dates = written("%m-%d %H:%M");
    if dates.windows(2).any(|pair| pair[0].1 == pair[1].1) {
        dates = written("%m-%d %H:%M:%S");
        dates.dedup_by(|next, date| next.1 == date.1);
    }
    dates
}

/// Widens a range a little, or to `least_span`, but not beyond `most`.
fn range_around([low, high]: [f64; 2], least_span: f64, most: f64) -> [f64; 2] {
    // Noise must not look as large as a drift.
    let spare = 0.5 * (least_span - (high - low)).max(0.1 * (high - low));
    [low - spare, (high + spare).min(most)]
}

/// Makes a curve of values at 0, 1, 2…
pub fn curve(values: &[f32], colour: Color32) -> Line<'static> {
    let points = PlotPoints::from_ys_f32(values);
    Line::new("", points).color(colour).width(1.6)
}

/// Returns smallest and largest; 0 and 1 if there are none.
pub fn range_of<'v>(values: impl IntoIterator<Item = &'v f32>) -> [f64; 2] {
    let values = values.into_iter().map(|value| f64::from(*value));
    let ends = values.fold(None, |ends: Option<[f64; 2]>, value| {
        let [low, high] = ends.unwrap_or([value; 2]);
        Some([low.min(value), high.max(value)])
    });
    ends.unwrap_or([0.0, 1.0])
}

/// Draws the names of the curves from the top left corner of a plot down, each after a sample of its line: colour alone must
/// not distinguish them.
pub fn legend<'n>(
    painter: &Painter,
    plot: &PlotTransform,
    curves: impl IntoIterator<Item = (&'n str, Color32, LineStyle)>,
) {
    for (row, (name, colour, style)) in (0_u8..).zip(curves) {
        let start = plot.frame().left_top() + vec2(8.0, 10.0 + 15.0 * f32::from(row));
        let ends = [start, start + vec2(26.0, 0.0)];
        painter.extend(line(&ends, Stroke::new(2.0, colour), style));
        let at = ends[1] + vec2(6.0, 0.0);
        painter.text(at, Align2::LEFT_CENTER, name, font::small(), colour);
    }
}

/// Draws a line in a style as `egui_plot` does.
fn line(points: &[Pos2], stroke: Stroke, style: LineStyle) -> Vec<Shape> {
    match style {
        LineStyle::Solid => vec![Shape::line(points.to_vec(), stroke)],
        LineStyle::Dashed { length } => Shape::dashed_line(points, stroke, length, length * 0.618),
        LineStyle::Dotted { spacing } => {
            Shape::dotted_line(points, stroke.color, spacing, stroke.width)
        }
    }
}

#[cfg(test)]
mod tests {
    use jiff::{Timestamp, tz::TimeZone};

    use super::*;

    #[test]
    fn powers_of_ten_are_plain_numbers_and_seconds_are_marked_up_to_six_times() {
        let powers: Vec<String> = (-2..=2).map(power_of_ten).collect();
        assert_eq!(powers, ["0.01", "0.1", "1", "10", "100"]);
        for (last, expected) in [
            (1.0, &["0 s", "1 s"][..]),
            (7.4, &["0 s", "2 s", "4 s", "6 s"]),
            (61.0, &["0 s", "20 s", "40 s", "60 s"]),
        ] {
            let marks: Vec<String> = seconds(last).into_iter().map(|(_, text)| text).collect();
            assert_eq!(marks, expected);
        }
    }

    #[test]
    fn moments_within_a_minute_are_marked_with_seconds_and_each_mark_reads_once() {
        let marks = |seconds: &[i64], step| {
            let at = seconds.iter().map(|seconds| {
                let at = Timestamp::from_second(*seconds).expect("a moment");
                at.to_zoned(TimeZone::UTC)
            });
            dates(&at.collect::<Vec<Zoned>>(), step)
        };
        let mark = |place: f64, text: &str| (place, text.to_owned());
        assert_eq!(
            marks(&[0, 30, 90, 7200], 2),
            [mark(0.0, "01-01 00:00"), mark(2.0, "01-01 00:01")]
        );
        assert_eq!(
            marks(&[0, 5, 5, 90], 1),
            [
                mark(0.0, "01-01 00:00:00"),
                mark(1.0, "01-01 00:00:05"),
                mark(3.0, "01-01 00:01:30")
            ]
        );
    }

    #[test]
    fn an_axis_of_scores_ends_at_one() {
        let [low, high] = range_around([0.92, 0.99], 0.1, 1.0);
        assert!(low < 0.92 && high.total_cmp(&1.0).is_eq(), "{low} {high}");
        let [low, high] = range_around([0.5, 0.75], 0.1, f64::INFINITY);
        assert!(low < 0.5 && high > 0.75, "{low} {high}");
    }
}
