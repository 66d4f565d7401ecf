//! Differences between two inspections of one part.

use egui::{Grid, Label, RichText, Ui, vec2};

use inspection::pipeline::{Recipe, parameters::Parameter};
use records::history::{Differences, InspectionSummary};
use shell::language::UnitSystem;
use ui::{
    language::{described, parameters, text},
    theme::{Theme, font},
    widgets::{heading, shortened},
};

/// Gap between two columns, logical pixels.
const GAP: f32 = 10.0;

/// Text of a finding in a row of the table.
type FindingText<'a> = &'a dyn Fn(&InspectionSummary) -> String;

/// Draws the differences from another inspection of the same scene made today.
pub(super) fn today(ui: &mut Ui, found: &Differences, units: UnitSystem) {
    let theme = Theme::of(ui);
    heading(ui, &text!("history-differences"));
    let is_same = found.has_same_outcome();
    let sentence = if is_same {
        text!("history-same-today")
    } else {
        text!("history-other-today")
    };
    let names = [text!("history-then"), text!("history-today")];
    let names = [names[0].as_str(), names[1].as_str()];
    table(ui, found, (&sentence, is_same), names, units, theme);
}

/// Draws the table, with the names of its columns, below a sentence that says whether the inspections are the same.
pub(super) fn table(
    ui: &mut Ui,
    found: &Differences,
    (sentence, is_same): (&str, bool),
    names: [&str; 2],
    units: UnitSystem,
    theme: &Theme,
) {
    let strong = RichText::new(sentence).font(font::body_strong());
    // Only another result is a warning: scores differ by noise, too.
    let colour = if is_same { theme.text } else { theme.warning };
    ui.label(strong.color(colour));
    let Differences { before, now, pose } = found;
    let none = || "-".to_owned();
    let rows: [(String, FindingText<'_>); 5] = [
        (text!("history-figure-verdict"), &|of| {
            described(&of.verdict)
        }),
        (text!("history-figure-nearest"), &|of| {
            of.nearest.clone().unwrap_or_else(none)
        }),
        (text!("history-figure-score"), &|of| {
            of.score
                .map_or_else(none, |[score, _]| format!("{score:.3}"))
        }),
        (text!("inspect-recipe"), &|of| of.recipe.clone()),
        (text!("history-figure-library"), &|of| of.library.clone()),
    ];
    // The names of parts and recipes must not widen the panel.
    let width = ((ui.available_width() - 2.0 * GAP) / 3.0).floor();
    // Words wrap; a name is cut, and whole in its tooltip.
    let cell = |ui: &mut Ui, text: RichText| {
        let is_name = !text.text().contains(' ');
        let label = Label::new(text);
        ui.add(if is_name { label.truncate() } else { label });
    };
    Grid::new(("differences", names))
        .num_columns(3)
        .max_col_width(width)
        .spacing(vec2(GAP, 2.0))
        // Lines of text need less height than controls.
        .min_row_height(22.0)
        .show(ui, |ui| {
            for title in ["", names[0], names[1]] {
                ui.weak(title);
            }
            ui.end_row();
            let both =
                |(what, of): (String, FindingText<'_>)| (shortened(&what, 14), of(before), of(now));
            let changed = found.changed_parameters().into_iter();
            let parameters = changed.map(|change| {
                let name = Parameter::<Recipe>::of_key(change.key).map(parameters::name);
                let name = name.unwrap_or_else(|| change.name.to_owned());
                (shortened(&name, 14), change.before, change.now)
            });
            for (what, then, today) in rows.into_iter().map(both).chain(parameters) {
                // Bold as well as colour marks a change.
                let text = RichText::new(&today);
                let is_same = then == today;
                ui.weak(what);
                cell(ui, RichText::new(then));
                let text = if is_same {
                    text
                } else {
                    text.font(font::body_strong()).color(colour)
                };
                cell(ui, text);
                ui.end_row();
            }
        });
    if let Some(off) = pose {
        let text = text!(
            "history-pose-differs",
            shift = units.length(off.shift.0),
            rotation = units.angle(off.rotation.0),
        );
        let text = RichText::new(text);
        let is_plain = is_same || found.has_same_pose();
        ui.label(if is_plain { text } else { text.color(colour) });
    }
}
