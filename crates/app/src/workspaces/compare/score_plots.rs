//! Plots of the score beside the confusion matrix: its calibration, and false accepts against refusals by threshold.

use egui::{Align2, Sense, Ui, WidgetInfo, pos2, vec2};
use egui_plot::{Line, LineStyle, PlotTransform, PlotUi, Points, VLine};

use records::cases::{Calibration, ThresholdCounts, TradeOff};
use ui::{
    language::{library_text, text},
    plot::{Axes, Axis, legend},
    theme::{ROUNDING, Theme, font, space},
};

/// Width of a plot with its labels.
pub(super) const WIDTH: f32 = 238.0;
const HEIGHT: f32 = 238.0;
/// Room for the number above a point, logical pixels.
const NUMBER_HEIGHT_PX: f32 = 20.0;
/// The curve of refusals is dashed: colour must not be the only difference.
const REFUSED: LineStyle = LineStyle::Dashed { length: 6.0 };

/// Draws a plot of shares, 0 to 1 on both axes, with its caption.
fn square<'a>(
    ui: &mut Ui,
    texts: PlotText,
    draw: impl FnOnce(&mut PlotUi<'a>) + 'a,
) -> PlotTransform {
    let theme = Theme::of(ui);
    let (all, response) = ui.allocate_exact_size(vec2(WIDTH, HEIGHT), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, &texts.words));
    response.on_hover_text(texts.help);
    let canvas = all.with_max_y(all.bottom() - 18.0);
    ui.painter().rect_filled(canvas, ROUNDING, theme.canvas);
    let at = pos2(canvas.center().x, canvas.bottom() + 4.0);
    let (anchor, colour) = (Align2::CENTER_TOP, theme.weak_text);
    ui.painter()
        .text(at, anchor, texts.caption, font::small(), colour);
    let axis = || {
        let marks = [0.0, 0.5, 1.0].map(|value| (value, format!("{value:.1}")));
        Axis::new([0.0, 1.0], marks.to_vec())
    };
    let axes = Axes {
        title: vec![(texts.title, theme.text)],
        across: axis(),
        up: axis(),
        font: font::small(),
        read: None,
    };
    let shown = axes.show(ui, canvas.shrink(6.0), draw);
    ui.add_space(space::SMALL);
    shown
}

/// The texts of a plot.
struct PlotText {
    title: String,
    caption: String,
    /// The plot in words, for screen readers.
    words: String,
    help: String,
}

/// Draws the share of right guesses over the score. On the diagonal the score is the probability that a guess is right.
pub(super) fn calibration(ui: &mut Ui, calibration: &Calibration) {
    let theme = Theme::of(ui);
    let texts = PlotText {
        title: text!("compare-calibration"),
        caption: match calibration.expected_error {
            Some(error) => {
                let error = format!("{error:.2}");
                text!("compare-calibration-caption", error = error)
            }
            None => text!("compare-calibration-caption-none"),
        },
        words: words(calibration),
        help: text!("compare-calibration-hint"),
    };
    let bins = calibration.bins.iter();
    let bins = bins.filter_map(|bin| Some((bin.num, [bin.mean_score, bin.share_right()?])));
    let bins: Vec<(usize, [f64; 2])> = bins.collect();
    let places: Vec<[f64; 2]> = bins.iter().map(|(_, at)| *at).collect();
    let shown = square(ui, texts, |plot| {
        let diagonal = Line::new("", vec![[0.0, 0.0], [1.0, 1.0]]);
        plot.line(diagonal.color(theme.weak_text).width(1.0));
        let colour = theme.first_series;
        plot.line(Line::new("", places.clone()).color(colour).width(1.5));
        plot.points(Points::new("", places).color(colour).radius(4.0));
    });
    for (num, at) in bins {
        let at = shown.position_from_point(&at.into());
        // Above the plot is its title.
        let (offset, anchor) = if at.y - NUMBER_HEIGHT_PX < shown.frame().top() {
            (6.0, Align2::CENTER_TOP)
        } else {
            (-6.0, Align2::CENTER_BOTTOM)
        };
        let at = at + vec2(0.0, offset);
        ui.painter()
            .text(at, anchor, num.to_string(), font::small(), theme.text);
    }
}

/// Draws the shares of false accepts and of refusals over the threshold on the score.
pub(super) fn trade_off(ui: &mut Ui, trade_off: &TradeOff, threshold: f64) {
    let theme = Theme::of(ui);
    let TradeOff {
        num_cases,
        num_enrolled,
        steps,
    } = trade_off;
    let words = steps
        .iter()
        .rfind(|step| step.threshold <= threshold)
        .map_or_else(String::new, |step| {
            text!(
                "compare-threshold-words",
                threshold = format!("{threshold:.2}"),
                wrong = step.num_wrong_accepted,
                cases = *num_cases,
                refused = step.num_refused,
                enrolled = *num_enrolled,
            )
        });
    let texts = PlotText {
        title: text!("compare-threshold"),
        caption: text!("compare-threshold-caption"),
        words,
        help: text!("compare-threshold-hint"),
    };
    let share = |num: usize, of: usize| num as f64 / of.max(1) as f64;
    let curve = |height: &dyn Fn(&ThresholdCounts) -> f64| {
        let places = steps.iter().map(|step| [step.threshold, height(step)]);
        Line::new("", places.collect::<Vec<_>>()).width(2.0)
    };
    let wrong = curve(&|step| share(step.num_wrong_accepted, *num_cases));
    let refused = curve(&|step| share(step.num_refused, *num_enrolled));
    let shown = square(ui, texts, |plot| {
        plot.line(refused.color(theme.first_series).style(REFUSED));
        plot.line(wrong.color(theme.rejected));
        plot.vline(VLine::new("", threshold).color(theme.text));
    });
    let wrong_name = text!("compare-plot-false-accepts");
    let refused_name = text!("compare-plot-refused");
    let curves = [
        (&*wrong_name, theme.rejected, LineStyle::Solid),
        (&*refused_name, theme.first_series, REFUSED),
    ];
    legend(ui.painter(), &shown, curves);
}

fn words(calibration: &Calibration) -> String {
    let Some(error) = calibration.expected_error else {
        return library_text("no-calibration");
    };
    let bins = calibration.bins.iter().filter(|bin| bin.num > 0);
    let bins = bins.map(|bin| {
        let (from, to) = (bin.from, bin.to);
        text!(
            "compare-calibration-bin",
            from = format!("{from:.1}"),
            to = format!("{to:.1}"),
            right = bin.num_right,
            count = bin.num,
        )
    });
    let bins: Vec<String> = bins.collect();
    text!(
        "compare-calibration-words",
        error = format!("{error:.2}"),
        bins = bins.join("; "),
    )
}
