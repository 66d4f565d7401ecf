//! Time of ranking over the number of references, with one and with several workers: the paper's Fig. 7(a) and (b).

use egui::{Button, RichText, Sense, Ui, WidgetInfo, vec2};
use egui_plot::{Line, LineStyle};

use super::{CompareAction, CompareState, scaling::Scaling};
use ui::{
    language::text,
    plot::{Axes, Axis, legend, range_of},
    theme::{ROUNDING, Theme, font},
    widgets::labelled,
};

/// Height of the plot.
const HEIGHT: f32 = 190.0;
/// Solid for one worker, with shorter dashes for more.
const STYLES: [LineStyle; 4] = [
    LineStyle::Solid,
    LineStyle::Dashed { length: 10.0 },
    LineStyle::Dashed { length: 5.0 },
    LineStyle::Dashed { length: 2.0 },
];

pub(super) fn ui(ui: &mut Ui, compare: &CompareState, acts: &mut Vec<CompareAction>) {
    let weak = |text: String| RichText::new(text).small().weak();
    ui.label(weak(text!("compare-scaling-says")));
    let label = text!("compare-measure-label");
    if labelled(ui, Button::new(text!("compare-measure")), &label).clicked() {
        acts.push(CompareAction::MeasureScaling);
    }
    let Some(scaling) = &compare.scaling else {
        return;
    };
    plot(ui, scaling);
    ui.label(weak(words(scaling)));
}

/// States from how many references on several workers are faster.
fn words(scaling: &Scaling) -> String {
    let num_cores = scaling.num_cores;
    let cores = match scaling.workers.iter().filter(|w| **w > num_cores).min() {
        Some(least) => text!(
            "compare-scaling-cores-shared",
            cores = num_cores,
            workers = *least
        ),
        None => text!("compare-scaling-cores", cores = num_cores),
    };
    match scaling.crossover() {
        Some(from) => text!("compare-scaling-from", cores = cores, count = from),
        None => text!("compare-scaling-never", cores = cores),
    }
}

fn plot(ui: &mut Ui, scaling: &Scaling) {
    let theme = Theme::of(ui);
    let (all, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let name = text!("compare-scaling-plot", words = words(scaling));
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, &name));
    ui.painter().rect_filled(all, ROUNDING, theme.canvas);
    let log = |value: f64| value.max(1e-9).log10() as f32;
    let rows = &scaling.rows;
    let sizes: Vec<f32> = rows
        .iter()
        .map(|row| log(row.num_references as f64))
        .collect();
    let times: Vec<f32> = rows.iter().flat_map(|row| row.least_ms).map(log).collect();
    let [least, most] = range_of(&times);
    let tick = |power: i32| 10.0_f64.powi(power).to_string();
    let axes = Axes {
        title: Vec::new(),
        across: Axis::powers(range_of(&sizes), tick),
        up: Axis::powers([least - 0.1, most + 0.1], |power| {
            format!("{} ms", tick(power))
        }),
        font: font::small(),
        read: None,
    };
    let colours = [
        theme.text,
        theme.first_series,
        theme.second_series,
        theme.reference_series,
    ];
    let shown = axes.show(ui, all.shrink(8.0), |plot| {
        for (index, (colour, style)) in colours.into_iter().zip(STYLES).enumerate() {
            let times = rows.iter().map(|row| log(row.least_ms[index]));
            let points = sizes.iter().zip(times);
            let points = points.map(|(size, time)| [f64::from(*size), f64::from(time)]);
            let points: Vec<[f64; 2]> = points.collect();
            plot.line(Line::new("", points).color(colour).width(1.5).style(style));
        }
    });
    // List the names: with fewer cores than workers, the ends of the curves coincide.
    let names = scaling.workers.map(|workers| match workers {
        1 => text!("compare-one-worker"),
        workers => workers.to_string(),
    });
    let names = names.iter().map(String::as_str);
    let curves = names.zip(colours).zip(STYLES);
    legend(
        ui.painter(),
        &shown,
        curves.map(|((name, colour), style)| (name, colour, style)),
    );
}
