//! E per iteration on a logarithmic scale: one curve per method, the goal of Algorithm 3, the genetic searches.

use std::ops::RangeInclusive;

use egui::{Align2, Painter, Pos2, Rect, Shape, Stroke, Vec2, pos2, vec2};

use super::{
    playback::MethodComparison,
    series,
    track::{MethodRun, Track},
};
use crate::app::ui::{
    theme::{Theme, font},
    widgets::{Scale, curve},
};

/// The goal of Algorithm 3, 1e-6 m², as a power of ten.
const GOAL: f32 = -6.0;
/// Room for the scale on the left, logical pixels.
const LEFT: f32 = 48.0;
/// Opacity of a method's level after its end.
const HELD: f32 = 0.5;
/// More powers of ten than this are named every second one only.
const MANY_POWERS: i32 = 7;

/// Where things are on the plot.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    area: Rect,
    across: Scale,
    up: Scale,
    powers: [i32; 2],
    last: usize,
}

impl Axes {
    /// The axes of a comparison in a rectangle.
    pub(super) fn of(shown: &MethodComparison, rect: Rect) -> Self {
        let range = shown.tracks().map(|(_, track)| track.log_range);
        let [low, high] = range.fold([GOAL, GOAL + 1.0], |[low, high], range| {
            [low.min(range[0]), high.max(range[1])]
        });
        let (low, high) = (low.floor(), high.ceil());
        let area = Rect::from_min_max(rect.min + vec2(LEFT, 6.0), rect.max - vec2(14.0, 16.0));
        let last = shown.last_place();
        Self {
            area,
            across: Scale::new([0.0, last.max(1) as f32], [area.left(), area.right()]),
            up: Scale::new([low, high], [area.bottom(), area.top()]),
            powers: [low as i32, high as i32],
            last,
        }
    }

    /// The place under the pointer, iterations.
    pub(super) fn place_at(&self, x: f32) -> f32 {
        let share = (x - self.area.left()) / self.area.width().max(1.0);
        (share * self.last as f32)
            .round()
            .clamp(0.0, self.last as f32)
    }

    fn powers(&self) -> RangeInclusive<i32> {
        self.powers[0]..=self.powers[1]
    }
}

/// Draws scale, goal, searches, curves and the scrubber at `place`.
pub(super) fn paint(
    painter: &Painter,
    axes: &Axes,
    shown: &MethodComparison,
    place: f32,
    theme: &Theme,
) {
    let Axes {
        area, across, up, ..
    } = *axes;
    for (_, track) in shown.tracks() {
        shade(painter, axes, track, theme);
    }
    let is_tall = axes.powers[1] - axes.powers[0] <= MANY_POWERS;
    for power in axes.powers().filter(|power| is_tall || power % 2 == 0) {
        let y = up.at(power as f32);
        painter.hline(area.x_range(), y, theme.edge_stroke());
        let at = pos2(area.left() - 8.0, y);
        let text = format!("1e{power}");
        painter.text(
            at,
            Align2::RIGHT_CENTER,
            text,
            font::small(),
            theme.weak_text,
        );
    }
    for share in [0, 1, 2] {
        let number = axes.last * share / 2;
        let at = pos2(across.at(number as f32), area.bottom() + 3.0);
        let anchor = [Align2::LEFT_TOP, Align2::CENTER_TOP, Align2::RIGHT_TOP][share];
        painter.text(
            at,
            anchor,
            number.to_string(),
            font::scale(),
            theme.weak_text,
        );
    }
    let goal = up.at(GOAL);
    let ends = [pos2(area.left(), goal), pos2(area.right(), goal)];
    let stroke = Stroke::new(1.4, theme.accepted);
    painter.extend(Shape::dashed_line(&ends, stroke, 6.0, 5.0));
    let searches = name_the_searches(painter, axes, shown, theme);
    let curves: Vec<Vec<Pos2>> = shown
        .tracks()
        .map(|(_, track)| curve(&track.log_e, &across, &up))
        .collect();
    for ((run, _), points) in shown.tracks().zip(&curves) {
        painter.extend(series::line(run.method, points, theme));
        if let Some(end) = points.last() {
            // Where it ended it stays, while others go on.
            let colour = series::colour(run.method, theme).gamma_multiply(HELD);
            painter.hline(end.x..=area.right(), end.y, Stroke::new(1.0, colour));
        }
    }
    let mut taken = vec![name_the_goal(painter, area, goal, &curves, theme)];
    taken.extend(searches);
    for ((run, _), points) in shown.tracks().zip(&curves) {
        if let Some(end) = points.last() {
            painter.circle_filled(*end, 3.5, series::colour(run.method, theme));
            taken.push(name(painter, area, *end, &taken, run, theme));
        }
    }

    let x = across.at(place);
    let stroke = Stroke::new(1.5, theme.text);
    painter.vline(x, area.top()..=area.bottom() + 6.0, stroke);
    painter.circle_filled(pos2(x, area.bottom() + 6.0), 5.0, theme.text);
}

/// The stretches in which the genetic algorithm searched.
fn shade(painter: &Painter, axes: &Axes, track: &Track, theme: &Theme) {
    for search in &track.searches {
        let x = [search.start, search.end].map(|place| axes.across.at(place as f32));
        let stretch = Rect::from_x_y_ranges(x[0]..=x[1], axes.area.y_range());
        painter.rect_filled(stretch, 0.0, theme.control);
    }
}

/// What the shaded stretches are, once, in the first of them, on a plate over the grid.
fn name_the_searches(
    painter: &Painter,
    axes: &Axes,
    shown: &MethodComparison,
    theme: &Theme,
) -> Option<Rect> {
    let mut searches = shown.tracks().flat_map(|(_, track)| &track.searches);
    let first = searches.next()?;
    let middle = (first.start + first.end) as f32 / 2.0;
    let text = "genetic search".to_owned();
    let galley = painter.layout_no_wrap(text, font::small(), theme.weak_text);
    let top = pos2(axes.across.at(middle), axes.area.top() + 2.0);
    let rect = Align2::CENTER_TOP.anchor_size(top, galley.size());
    painter.rect_filled(rect.expand(2.0), 0.0, theme.control);
    painter.galley(rect.min, galley, theme.weak_text);
    Some(rect)
}

/// The goal's name above its line, where no curve runs through it: at the right end, in the middle or at the left.
fn name_the_goal(
    painter: &Painter,
    area: Rect,
    goal: f32,
    curves: &[Vec<Pos2>],
    theme: &Theme,
) -> Rect {
    let text = "accepted below 1e-6 (Algorithm 3)".to_owned();
    let galley = painter.layout_no_wrap(text, font::small(), theme.accepted);
    let size = galley.size();
    let free = area.width() - size.x - 12.0;
    let place = |(share, lift): (f32, f32)| {
        let x = area.left() + 6.0 + share * free;
        Rect::from_min_size(pos2(x, goal + lift), size)
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

/// True if the curve crosses the rectangle, nearly enough: its pieces are looked at in small steps.
fn runs_through(points: &[Pos2], rect: Rect) -> bool {
    const STEPS: usize = 8;
    points.windows(2).any(|ends| {
        (0..=STEPS).any(|i| rect.contains(ends[0].lerp(ends[1], i as f32 / STEPS as f32)))
    })
}

/// The method's name beside the end of its curve, moved up or down to where it is free.
fn name(
    painter: &Painter,
    area: Rect,
    end: Pos2,
    taken: &[Rect],
    run: &MethodRun,
    theme: &Theme,
) -> Rect {
    let colour = series::colour(run.method, theme);
    let text = series::title(run.method).to_owned();
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
