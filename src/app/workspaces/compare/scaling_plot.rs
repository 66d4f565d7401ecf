//! What ranking takes over a growing number of references, by one and by several workers: the paper's Fig. 7(a) and (b).

use egui::{Align2, Button, Pos2, RichText, Sense, Shape, Stroke, Ui, WidgetInfo, vec2};

use super::{CompareAction, CompareState};
use crate::{
    app::ui::{
        theme::{Theme, font},
        widgets::{Scale, labelled},
    },
    bench::scaling::Scaling,
};

/// Height of the plot.
const HEIGHT: f32 = 190.0;

/// Draws the fold's inside: a button, then the plot.
pub(super) fn ui(
    ui: &mut Ui,
    compare: &CompareState,
    theme: &Theme,
    acts: &mut Vec<CompareAction>,
) {
    let weak = |text: String| {
        RichText::new(text)
            .font(font::small())
            .color(theme.weak_text)
    };
    let text = "Ranks one query over 8 to 2048 simulated references by 1, 2, 4 and 8 workers; takes some seconds";
    ui.label(weak(text.into()));
    if labelled(ui, Button::new("Measure"), "Measure scaling").clicked() {
        acts.push(CompareAction::MeasureScaling);
    }
    let Some(scaling) = &compare.scaling else {
        return;
    };
    plot(ui, scaling, theme);
    ui.label(weak(words(scaling)));
}

/// The crossover in a sentence.
fn words(scaling: &Scaling) -> String {
    let num_cores = scaling.num_cores;
    let shared = match scaling.workers.iter().filter(|w| **w > num_cores).min() {
        Some(least) => format!("; {least} workers and more share them"),
        None => String::new(),
    };
    let from = match scaling.crossover() {
        Some(from) => format!("several pay from {from} references on"),
        None => "several never paid".into(),
    };
    format!("{num_cores} cores{shared}: {from}")
}

fn plot(ui: &mut Ui, scaling: &Scaling, theme: &Theme) {
    let (all, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let name = format!(
        "Time of a ranking over the number of references; {}",
        words(scaling)
    );
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, &name));
    let painter = ui.painter_at(all);
    let mut area = all;
    area.min += vec2(44.0, 8.0);
    area.max -= vec2(26.0, 24.0);
    painter.rect_filled(area, 0.0, theme.canvas);
    let log = |value: f64| value.max(1e-9).log10() as f32;
    let times = || scaling.rows.iter().flat_map(|row| row.least_ms).map(log);
    let sizes = || {
        scaling
            .rows
            .iter()
            .map(|row| log(row.num_references as f64))
    };
    let least = |values: &mut dyn Iterator<Item = f32>| values.fold(f32::INFINITY, f32::min);
    let most = |values: &mut dyn Iterator<Item = f32>| values.fold(f32::NEG_INFINITY, f32::max);
    let ranges = [
        [least(&mut sizes()), most(&mut sizes())],
        [least(&mut times()) - 0.1, most(&mut times()) + 0.1],
    ];
    if !ranges.iter().flatten().all(|end| end.is_finite()) {
        return;
    }
    let across = Scale::new(ranges[0], [area.left(), area.right()]);
    let up = Scale::new(ranges[1], [area.bottom(), area.top()]);
    let tick = |power: i32| 10.0_f64.powi(power).to_string();
    for power in -3..=6 {
        let value = power as f32;
        let colour = theme.weak_text;
        if (ranges[0][0]..=ranges[0][1]).contains(&value) {
            let at = Pos2::new(across.at(value), area.bottom());
            painter.vline(at.x, area.y_range(), theme.edge_stroke());
            let at = at + vec2(0.0, 4.0);
            painter.text(at, Align2::CENTER_TOP, tick(power), font::scale(), colour);
        }
        if (ranges[1][0]..=ranges[1][1]).contains(&value) {
            let at = Pos2::new(area.left(), up.at(value));
            painter.hline(area.x_range(), at.y, theme.edge_stroke());
            let text = format!("{} ms", tick(power));
            let at = at - vec2(4.0, 0.0);
            painter.text(at, Align2::RIGHT_CENTER, text, font::scale(), colour);
        }
    }
    let colours = [
        theme.text,
        theme.first_series,
        theme.second_series,
        theme.reference_series,
    ];
    for (place, (workers, colour)) in scaling.workers.iter().zip(colours).enumerate() {
        let points: Vec<Pos2> = scaling
            .rows
            .iter()
            .map(|row| {
                let size = log(row.num_references as f64);
                Pos2::new(across.at(size), up.at(log(row.least_ms[place])))
            })
            .collect();
        // A list, since the ends lie over each other where there are fewer cores than workers.
        let name = match workers {
            1 => "1 worker".to_owned(),
            workers => workers.to_string(),
        };
        let at = area.left_top() + vec2(8.0, 13.0 + 15.0 * place as f32);
        let stroke = Stroke::new(1.5, colour);
        painter.extend(line(place, &[at, at + vec2(26.0, 0.0)], stroke));
        let at = at + vec2(32.0, 0.0);
        painter.text(at, Align2::LEFT_CENTER, name, font::scale(), colour);
        painter.extend(line(place, &points, stroke));
    }
}

/// Whole for the serial curve, in ever shorter dashes for the others.
fn line(place: usize, points: &[Pos2], stroke: Stroke) -> Vec<Shape> {
    match place {
        0 => vec![Shape::line(points.to_vec(), stroke)],
        1 => Shape::dashed_line(points, stroke, 10.0, 4.0),
        2 => Shape::dashed_line(points, stroke, 5.0, 3.0),
        _ => Shape::dashed_line(points, stroke, 1.5, 3.0),
    }
}
