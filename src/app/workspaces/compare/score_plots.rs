//! What scores are worth, beside the confusion matrix: how often they are right, and what a threshold on them costs.

use egui::{Align2, Color32, Pos2, Rect, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2};

use crate::{
    app::ui::theme::{Theme, font, space},
    cases::{Calibration, ThresholdCounts, TradeOff},
};

/// Width of the plot with what is written around it.
pub(super) const WIDTH: f32 = 238.0;
/// Side of the plot itself.
const SIDE: f32 = 176.0;

/// The square from 0 to 1 both ways that a plot is drawn into.
struct PlotArea(Rect);

impl PlotArea {
    fn place(&self, across: f64, up: f64) -> Pos2 {
        let Self(area) = self;
        pos2(
            area.left() + area.width() * across as f32,
            area.bottom() - area.height() * up as f32,
        )
    }
}

/// Title, scales and caption.
fn framed(ui: &mut Ui, said: PlotText<'_>, theme: &Theme) -> PlotArea {
    let size = vec2(WIDTH, SIDE + 62.0);
    let (all, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, &said.words));
    response.on_hover_text(said.help);
    let painter = ui.painter();
    let area = Rect::from_min_size(all.min + vec2(44.0, 22.0), vec2(SIDE, SIDE));
    let square = PlotArea(area);
    let (small, text) = (font::small(), theme.text);
    painter.text(all.min, Align2::LEFT_TOP, said.title, small.clone(), text);
    painter.rect_filled(area, 0.0, theme.canvas);
    for half in [0.0, 0.5, 1.0] {
        let (x, y) = (square.place(half, 0.0), square.place(0.0, half));
        painter.vline(x.x, area.y_range(), theme.edge_stroke());
        painter.hline(area.x_range(), y.y, theme.edge_stroke());
        let text = format!("{half:.1}");
        let colour = theme.weak_text;
        let at = x + vec2(0.0, 4.0);
        painter.text(at, Align2::CENTER_TOP, &text, font::scale(), colour);
        let at = y - vec2(6.0, 0.0);
        painter.text(at, Align2::RIGHT_CENTER, &text, font::scale(), colour);
    }
    let at = pos2(area.center().x, area.bottom() + 18.0);
    painter.text(at, Align2::CENTER_TOP, said.caption, small, theme.weak_text);
    square
}

/// What a plot says in words.
struct PlotText<'a> {
    title: &'a str,
    caption: String,
    /// All of it, for those who do not see it.
    words: String,
    help: &'a str,
}

/// Draws the share of right guesses over their score; on the diagonal a score says how often it is right.
pub(super) fn calibration(ui: &mut Ui, calibration: &Calibration, theme: &Theme) {
    let said = PlotText {
        title: "Calibration",
        caption: match calibration.expected_error {
            Some(error) => format!("right over score · error {error:.2}"),
            None => "right over score".into(),
        },
        words: words(calibration),
        help: "The best guesses of all cases, by score: on the line a score of 0.9 is right nine times in ten. Numbers are guesses",
    };
    let square = framed(ui, said, theme);
    let painter = ui.painter();
    let ends = [square.place(0.0, 0.0), square.place(1.0, 1.0)];
    painter.line_segment(ends, Stroke::new(1.0, theme.weak_text));
    let stroke = Stroke::new(1.5, theme.first_series);
    let mut last = None;
    for bin in &calibration.bins {
        let Some(share) = bin.share_right() else {
            continue;
        };
        let at = square.place(bin.mean_score, share);
        if let Some(last) = last.replace(at) {
            painter.line_segment([last, at], stroke);
        }
        painter.circle_filled(at, 4.0, theme.first_series);
        let at = at - vec2(0.0, 6.0);
        let text = bin.num.to_string();
        painter.text(at, Align2::CENTER_BOTTOM, text, font::scale(), theme.text);
    }
    ui.add_space(space::SMALL);
}

/// Draws what every threshold on the score would accept wrongly, and what it would refuse.
pub(super) fn trade_off(ui: &mut Ui, trade_off: &TradeOff, threshold: f64, theme: &Theme) {
    let TradeOff {
        num_cases,
        num_enrolled,
        steps,
    } = trade_off;
    let words = steps
        .iter()
        .rfind(|step| step.threshold <= threshold)
        .map_or_else(String::new, |step| {
            format!(
                "Threshold: at {threshold:.2} the score alone accepts {} of {num_cases} cases wrongly and refuses {} of {num_enrolled} parts",
                step.num_wrong_accepted, step.num_refused
            )
        });
    let said = PlotText {
        title: "Threshold",
        caption: "share over least score".into(),
        words,
        help: "What every least score would accept wrongly, of all cases, and what it would refuse, of the enrolled parts, \
               by the score alone. The upright line is the recipe's",
    };
    let square = framed(ui, said, theme);
    let painter = ui.painter();
    let share = |num: usize, of: usize| num as f64 / of.max(1) as f64;
    let curve = |height: &dyn Fn(&ThresholdCounts) -> f64| -> Vec<Pos2> {
        let at = |step: &ThresholdCounts| square.place(step.threshold, height(step));
        steps.iter().map(at).collect()
    };
    let wrong = curve(&|step| share(step.num_wrong_accepted, *num_cases));
    let refused = curve(&|step| share(step.num_refused, *num_enrolled));
    painter.extend(refusing(&refused, theme));
    painter.extend(accepting(&wrong, theme));
    let at = square.place(threshold, 0.0).x;
    painter.vline(at, square.0.y_range(), Stroke::new(1.0, theme.text));
    let legend: [(&str, CurveStyle, Color32); 2] = [
        ("wrong and accepted", accepting, theme.rejected),
        ("parts refused", refusing, theme.first_series),
    ];
    for (row, (text, look, colour)) in (0_u8..).zip(legend) {
        let at = square.0.left_top() + vec2(12.0, 14.0 + 14.0 * f32::from(row));
        painter.extend(look(&[at, at + vec2(26.0, 0.0)], theme));
        let at = at + vec2(32.0, 0.0);
        painter.text(at, Align2::LEFT_CENTER, text, font::scale(), colour);
    }
    ui.add_space(space::SMALL);
}

/// How a curve is drawn.
type CurveStyle = fn(&[Pos2], &Theme) -> Vec<Shape>;

/// The curve of what is wrong and accepted: a whole line.
fn accepting(points: &[Pos2], theme: &Theme) -> Vec<Shape> {
    vec![Shape::line(
        points.to_vec(),
        Stroke::new(2.0, theme.rejected),
    )]
}

/// The curve of what is refused: in dashes, since colour must not be the only sign.
fn refusing(points: &[Pos2], theme: &Theme) -> Vec<Shape> {
    Shape::dashed_line(points, Stroke::new(2.0, theme.first_series), 6.0, 4.0)
}

fn words(calibration: &Calibration) -> String {
    let Some(error) = calibration.expected_error else {
        return "Calibration: nothing was taken for a part".into();
    };
    let bins = calibration.bins.iter().filter(|bin| bin.num > 0);
    let bins = bins.map(|bin| {
        let (from, to) = (bin.from, bin.to);
        format!(
            "{from:.1} to {to:.1}, {} of {} right",
            bin.num_right, bin.num
        )
    });
    let bins: Vec<String> = bins.collect();
    format!(
        "Calibration: expected error {error:.2}; {}",
        bins.join("; ")
    )
}
