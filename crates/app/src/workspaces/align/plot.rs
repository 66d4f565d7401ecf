//! E per iteration on a logarithmic scale: one curve per method, the threshold of Algorithm 3, and the genetic searches. Also
//! the name, colour and line style of each method.

use egui::{Align2, Color32, Painter, Pos2, Rect, Stroke, Ui, Vec2, pos2};
use egui_plot::{HLine, Line, LineStyle, PlotPoint, PlotTransform, Points, Span};

use super::{
    playback::MethodComparison,
    track::{MethodRun, Track},
};
use stages::pose::PoseMethod;
use ui::{
    language::{parameters, text},
    plot::{Axes, Axis, curve, range_of},
    theme::{Theme, font},
};

/// The threshold of Algorithm 3, 1e-6 m², as a power of ten.
const THRESHOLD: f64 = -6.0;
/// Opacity of the line that continues a curve beyond its end.
const HELD: f32 = 0.5;

/// Draws axes, threshold, searches, curves and the scrubber at `iteration`.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    shown: &MethodComparison,
    iteration: f32,
) -> PlotTransform {
    let theme = Theme::of(ui);
    let [low, high] = range_of(shown.tracks().flat_map(|(_, track)| &track.log_e));
    let log_e = shown.tracks().flat_map(|(_, track)| &track.log_e);
    let has_threshold = is_threshold_in_reach(shown.pair.truth.is_some(), log_e);
    let (low, high) = if has_threshold {
        (low.min(THRESHOLD).floor(), high.max(THRESHOLD + 1.0).ceil())
    } else {
        (low.floor(), high.ceil().max(low.floor() + 1.0))
    };
    let last = shown.last_iteration();
    let marks = [0, last / 2, last].map(|number| (number as f64, number.to_string()));
    let axes = Axes {
        title: Vec::new(),
        across: Axis::new([0.0, last.max(1) as f64], marks.to_vec()),
        up: Axis::powers([low, high], |power| format!("1e{power}")),
        font: font::small(),
        read: None,
    };
    let rect = rect.with_max_y(rect.bottom() - 2.0);
    let drawn = axes.show(ui, rect, |plot| {
        for search in shown.tracks().flat_map(|(_, track)| &track.searches) {
            let stretch = search.start as f64..=search.end as f64;
            plot.span(Span::new("", stretch).fill(theme.control));
        }
        if has_threshold {
            let threshold = HLine::new("", THRESHOLD).color(theme.accepted).width(1.4);
            plot.hline(threshold.style(LineStyle::Dashed { length: 6.0 }));
        }
        for (run, track) in shown.tracks() {
            let colour = method_colour(run.method, theme);
            let line = curve(&track.log_e, colour).width(2.0);
            plot.line(line.style(method_style(run.method)));
            let [x, y] = end_of(track);
            // Continue at the final level while other methods still iterate.
            let held = Line::new("", vec![[x, y], [last as f64, y]]).width(1.0);
            plot.line(held.color(colour.gamma_multiply(HELD)));
            plot.points(Points::new("", vec![[x, y]]).color(colour).radius(3.5));
        }
    });
    let painter = ui.painter();
    let searches = name_the_searches(painter, &drawn, shown, theme);
    let threshold = has_threshold.then(|| name_the_threshold(painter, &drawn, shown, theme));
    let mut taken: Vec<Rect> = threshold.into_iter().chain(searches).collect();
    let area = *drawn.frame();
    for (run, track) in shown.tracks() {
        let end = drawn.position_from_point(&end_of(track).into());
        taken.push(name(painter, area, end, &taken, run, theme));
    }
    let x = drawn.position_from_point_x(f64::from(iteration));
    let stroke = Stroke::new(1.5, theme.text);
    painter.vline(x, area.y_range(), stroke);
    // The handle is above the curves; the numbers are below them.
    painter.circle_filled(pos2(x, area.top()), 5.0, theme.text);
    drawn
}

/// True if E can fall below the threshold: the clouds are exact copies, or it has. The noise of a camera keeps E above it.
fn is_threshold_in_reach<'a>(are_copies: bool, mut log_e: impl Iterator<Item = &'a f32>) -> bool {
    are_copies || log_e.any(|e| f64::from(*e) < THRESHOLD)
}

/// End of a track's curve, plot coordinates.
fn end_of(track: &Track) -> [f64; 2] {
    let last = track.log_e.len().saturating_sub(1);
    [
        last as f64,
        track.log_e.last().map_or(0.0, |e| f64::from(*e)),
    ]
}

/// Labels the first of the shaded genetic searches, on a plate over the grid.
fn name_the_searches(
    painter: &Painter,
    drawn: &PlotTransform,
    shown: &MethodComparison,
    theme: &Theme,
) -> Option<Rect> {
    let mut searches = shown.tracks().flat_map(|(_, track)| &track.searches);
    let first = searches.next()?;
    let middle = (first.start + first.end) as f64 / 2.0;
    let text = text!("align-genetic-search");
    let galley = painter.layout_no_wrap(text, font::small(), theme.weak_text);
    let x = drawn.position_from_point_x(middle);
    let top = pos2(x, drawn.frame().top() + 2.0);
    let rect = Align2::CENTER_TOP.anchor_size(top, galley.size());
    let rect = moved_inside(rect, *drawn.frame());
    painter.rect_filled(rect.expand(2.0), 0.0, theme.control);
    painter.galley(rect.min, galley, theme.weak_text);
    Some(rect)
}

/// Moves a label sideways until it covers no number beside the plot.
fn moved_inside(label: Rect, area: Rect) -> Rect {
    const PAD: f32 = 4.0;
    let most = area.right() - PAD - label.width();
    let left = label.left().min(most).max(area.left() + PAD);
    label.translate(Vec2::new(left - label.left(), 0.0))
}

/// Labels the threshold where no curve runs through the label: above its line at the right, middle or left, else below it.
fn name_the_threshold(
    painter: &Painter,
    drawn: &PlotTransform,
    shown: &MethodComparison,
    theme: &Theme,
) -> Rect {
    let (area, threshold) = (*drawn.frame(), drawn.position_from_point_y(THRESHOLD));
    let curves = shown.tracks().map(|(_, track)| -> Vec<Pos2> {
        let points = track.log_e.iter().enumerate();
        let at = |(index, e): (usize, &f32)| PlotPoint::new(index as f64, *e);
        points
            .map(|one| drawn.position_from_point(&at(one)))
            .collect()
    });
    let curves: Vec<Vec<Pos2>> = curves.collect();
    let text = text!("align-threshold");
    let galley = painter.layout_no_wrap(text, font::small(), theme.accepted);
    let size = galley.size();
    let free = area.width() - size.x - 12.0;
    let place = |(share, lift): (f32, f32)| {
        let x = area.left() + 6.0 + share * free;
        Rect::from_min_size(pos2(x, threshold + lift), size)
    };
    let (above, below) = (-size.y - 2.0, 3.0);
    let shares = [1.0, 0.5, 0.0];
    let places = shares.map(|share| (share, above));
    let places = places.into_iter().chain(shares.map(|share| (share, below)));
    let is_free = |rect: &Rect| {
        area.contains_rect(*rect) && !curves.iter().any(|points| runs_through(points, *rect))
    };
    let rect = places.map(place).find(is_free);
    let rect = rect.unwrap_or_else(|| place((1.0, above)));
    painter.galley(rect.min, galley, theme.accepted);
    rect
}

/// True if the curve crosses the rectangle, sampled at a few steps per segment.
fn runs_through(points: &[Pos2], rect: Rect) -> bool {
    const STEPS: usize = 8;
    points.windows(2).any(|ends| {
        (0..=STEPS).any(|i| rect.contains(ends[0].lerp(ends[1], i as f32 / STEPS as f32)))
    })
}

/// Draws the method's name beside the end of its curve, moved up or down to a free place.
fn name(
    painter: &Painter,
    area: Rect,
    end: Pos2,
    taken: &[Rect],
    run: &MethodRun,
    theme: &Theme,
) -> Rect {
    let colour = method_colour(run.method, theme);
    let text = method_title(run.method);
    let galley = painter.layout_no_wrap(text, font::body_strong(), colour);
    let size = galley.size();
    let x = if end.x + 10.0 + size.x <= area.right() {
        end.x + 10.0
    } else {
        end.x - 8.0 - size.x
    };
    let place = |lift: f32| Rect::from_min_size(pos2(x, end.y + lift), size);
    let lifts = [
        -size.y - 4.0,
        4.0,
        -2.0 * size.y - 6.0,
        size.y + 6.0,
        -3.0 * size.y,
    ];
    let is_free = |rect: &Rect| {
        let within = area.expand2(Vec2::new(20.0, 4.0));
        within.contains_rect(*rect) && !taken.iter().any(|other| other.intersects(*rect))
    };
    let rect = lifts.into_iter().map(place).find(is_free);
    let rect = rect.unwrap_or_else(|| place(lifts[0]));
    painter.galley(rect.min, galley, colour);
    rect
}

/// Name of a method, for a person.
pub(super) fn method_title(method: PoseMethod) -> String {
    match method {
        PoseMethod::Icp => "ICP".into(),
        PoseMethod::IcpGa => "ICP-GA".into(),
        PoseMethod::Global => parameters::option("Global"),
    }
}

/// Colour of a method.
pub(super) fn method_colour(method: PoseMethod, theme: &Theme) -> Color32 {
    match method {
        PoseMethod::Icp => theme.second_series,
        PoseMethod::IcpGa => theme.first_series,
        PoseMethod::Global => theme.reference_series,
    }
}

/// Line style of a method's curve: solid for ICP, dashed or dotted for the others.
pub(super) fn method_style(method: PoseMethod) -> LineStyle {
    match method {
        PoseMethod::Icp => LineStyle::Solid,
        PoseMethod::IcpGa => LineStyle::Dashed { length: 9.0 },
        PoseMethod::Global => LineStyle::Dashed { length: 3.0 },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_goal_is_shown_where_it_can_be_reached() {
        let noisy = [-1.5, -4.9, -5.2];
        assert!(!is_threshold_in_reach(false, noisy.iter()));
        assert!(is_threshold_in_reach(true, noisy.iter()));
        assert!(is_threshold_in_reach(false, [-3.0, -6.1].iter()));
    }

    #[test]
    fn a_label_stays_beside_the_numbers_of_the_axes() {
        let area = Rect::from_min_max(pos2(60.0, 0.0), pos2(400.0, 200.0));
        let label = |left: f32| Rect::from_min_size(pos2(left, 2.0), Vec2::new(80.0, 14.0));
        for (left, moved) in [(10.0, 64.0), (150.0, 150.0), (390.0, 316.0)] {
            assert_eq!(moved_inside(label(left), area), label(moved));
        }
        // What is wider than the plot begins at its left edge.
        let narrow = area.with_max_x(100.0);
        assert_eq!(moved_inside(label(10.0), narrow), label(64.0));
    }
}
