//! Numbers of accepted parts by shift, by part, by rack and by reason, among those that match the filter.
//!
//! An empty cell is not a part. A part with several inspections counts once, as in the list.

use std::{cmp::Reverse, collections::BTreeMap};

use egui::{Align2, Grid, RichText, ScrollArea, Sense, TextStyle, Ui, WidgetInfo, vec2};
use egui_plot::{Bar, BarChart, LineStyle};
use jiff::{Zoned, tz::TimeZone};

use super::drift::{self, Drift};
use inspection::pipeline::RefusalKind;
use records::history::{DriftWarning, LEAST_FOR_SPREAD, PartOutcome, StoredVerdict};
use shell::{
    language::{UnitSystem, drift_warning, refusal_kind},
    session::{ShiftStarts, Source},
    source::source_menu,
};
use ui::{
    language::{described, text},
    plot::{Axes, Axis, legend},
    theme::{ROUNDING, Theme, font, space},
    widgets::{Mark, error_row, fitted_middle, heading},
};

/// Number of shifts that fit the plot; the last ones are shown.
const MAX_SHIFTS: usize = 21;
/// Number of shifts that the plot has room for at least, so that the bars of few are no wider.
const MIN_SHIFTS: usize = 7;
/// Height of the plot, logical pixels.
const HEIGHT: f32 = 220.0;
/// Share of the width that a part's title takes at most.
const MAX_TITLE_SHARE: f32 = 0.5;

/// Numbers of parts that are OK and not OK.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Accepted parts, except those that were reported as wrong.
    pub num_ok: usize,
    /// All other parts.
    pub num_not_ok: usize,
}

impl Tally {
    fn add(&mut self, is_ok: bool) {
        if is_ok {
            self.num_ok += 1;
        } else {
            self.num_not_ok += 1;
        }
    }

    fn num(self) -> usize {
        self.num_ok + self.num_not_ok
    }

    /// Percentage that is OK.
    fn share(self) -> String {
        format!(
            "{:.1} %",
            100.0 * self.num_ok as f64 / self.num().max(1) as f64
        )
    }
}

/// Groups of parts that are not OK.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ReasonGroup {
    /// By kind.
    Kind(RefusalKind),
    /// Accepted, but reported as wrong.
    ReportedWrong,
}

impl ReasonGroup {
    fn title(&self) -> String {
        match self {
            Self::Kind(kind) => refusal_kind(kind),
            Self::ReportedWrong => text!("operator-reported-wrong"),
        }
    }
}

/// The counts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Statistics {
    /// By shift, oldest first, each with its start.
    pub shifts: Vec<(Zoned, Tally)>,
    /// By part, the one with the most refusals first; `None` for unknown parts.
    pub parts: Vec<(Option<String>, Tally)>,
    /// By the name of the rack; empty if no part hung in one that has a name.
    pub racks: BTreeMap<String, Tally>,
    /// By reason, the most frequent first.
    pub reasons: Vec<(ReasonGroup, usize)>,
    /// The source that the parts hung in front of, as in the count of the shift; `None` if those of all sources are counted.
    pub source: Option<Source>,
    /// Number of parts of other sources, which are not counted.
    pub num_left_out: usize,
    /// Number of rows without a part, which are not counted.
    pub num_no_part: usize,
    /// Number of parts that left before enough of their frames were inspected, which are not counted.
    pub num_not_judged: usize,
    /// Titles of the parts that a trend will refuse, and when.
    pub warnings: Vec<(String, DriftWarning)>,
    /// Drift of the part that the filter names, or of the one accepted most often.
    pub drift: Option<Drift>,
}

/// State of the statistics.
#[derive(Debug, Default)]
pub enum StatisticsView {
    /// The list is shown.
    #[default]
    Closed,
    /// The statistics are being computed for the first time.
    Counting,
    /// The last statistics; they stay while newer ones are computed.
    Counted(Box<Statistics>),
}

impl StatisticsView {
    /// True unless the list is shown.
    pub fn is_open(&self) -> bool {
        !matches!(self, Self::Closed)
    }
}

/// Counts outcomes given in order of time.
pub(super) fn count(
    outcomes: &[PartOutcome],
    starts: &ShiftStarts,
    zone: &TimeZone,
    title_of: impl Fn(&str) -> String,
) -> Statistics {
    let mut found = Statistics::default();
    let mut parts: BTreeMap<Option<String>, Tally> = BTreeMap::new();
    let mut reasons: BTreeMap<ReasonGroup, usize> = BTreeMap::new();
    let mut end: Option<Zoned> = None;
    for outcome in outcomes {
        if outcome.verdict == StoredVerdict::NoPart {
            found.num_no_part += 1;
            continue;
        }
        if !outcome.is_judged() {
            found.num_not_judged += 1;
            continue;
        }
        let is_in_last = end.as_ref().is_some_and(|end| outcome.at < end.timestamp());
        if !is_in_last
            && let [Some(start), next] = starts.around(&outcome.at.to_zoned(zone.clone()))
        {
            end = next;
            found.shifts.push((start, Tally::default()));
        }
        if let Some((_, tally)) = found.shifts.last_mut() {
            tally.add(outcome.is_ok);
        }
        let title = match outcome.verdict {
            StoredVerdict::Unknown => None,
            _ => Some(title_of(outcome.part.as_deref().unwrap_or_default())),
        };
        let reason = match &outcome.reason {
            Some(reason) => Some(ReasonGroup::Kind(reason.clone())),
            None if outcome.verdict == StoredVerdict::Accepted && !outcome.is_ok => {
                Some(ReasonGroup::ReportedWrong)
            }
            None => None,
        };
        if let Some(reason) = reason {
            *reasons.entry(reason).or_default() += 1;
        }
        parts.entry(title).or_default().add(outcome.is_ok);
        if let Some(rack) = &outcome.rack {
            let tally = found.racks.entry(rack.clone()).or_default();
            tally.add(outcome.is_ok);
        }
    }
    found.parts = parts.into_iter().collect();
    found
        .parts
        .sort_by_key(|(_, tally)| Reverse((tally.num_not_ok, tally.num())));
    found.reasons = reasons.into_iter().collect();
    found.reasons.sort_by_key(|(_, num)| Reverse(*num));
    found
}

/// Draws the statistics.
pub(super) fn ui(ui: &mut Ui, view: &StatisticsView, units: UnitSystem) {
    let StatisticsView::Counted(found) = view else {
        ui.weak(text!("operator-counting"));
        return;
    };
    if found.shifts.is_empty() {
        ui.weak(text!("history-none-counted"));
        return;
    }
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        // Lines of text need less height than controls.
        ui.spacing_mut().interact_size.y = 22.0;
        for (part, warning) in &found.warnings {
            error_row(ui, Mark::Look, &drift_warning(part, warning, units));
        }
        shifts(ui, &found.shifts);
        if let Some(source) = &found.source {
            let name = source_menu::now(source);
            let source = ui.weak(text!("operator-source", source = name));
            source.on_hover_text(text!("operator-shift-says"));
        }
        if found.num_left_out > 0 {
            let count = found.num_left_out;
            ui.weak(text!("history-others-left-out", count = count));
        }
        if found.num_no_part > 0 {
            let count = found.num_no_part;
            ui.weak(text!("history-no-part-left-out", count = count));
        }
        if found.num_not_judged > 0 {
            let count = found.num_not_judged;
            ui.add(egui::Label::new(text!("history-not-judged-left-out", count = count)).wrap());
        }
        heading(ui, &text!("history-by-part"));
        by_part(ui, &found.parts);
        if !found.racks.is_empty() {
            heading(ui, &text!("history-by-rack"));
            let racks = found.racks.iter();
            by_name(
                ui,
                &text!("rack-heading"),
                racks.map(|(name, tally)| (name.clone(), tally)),
            );
        }
        if !found.reasons.is_empty() {
            heading(ui, &text!("history-by-reason"));
        }
        for (reason, num) in &found.reasons {
            let text = format!("{num} × {}", reason.title());
            ui.add(egui::Label::new(text).wrap());
        }
        if let Some(drift) = &found.drift {
            drift::ui(ui, drift, units);
        } else {
            let needed = text!("history-drift-needs", count = LEAST_FOR_SPREAD);
            ui.add(egui::Label::new(needed).wrap());
        }
    });
}

/// Draws a row for each part.
fn by_part(ui: &mut Ui, parts: &[(Option<String>, Tally)]) {
    // Translate when drawing: the language may have changed since counting.
    let unknown = || described(&StoredVerdict::Unknown);
    let titled = |part: &Option<String>| part.clone().unwrap_or_else(unknown);
    let parts = parts.iter().map(|(part, tally)| (titled(part), tally));
    by_name(ui, &text!("shell-part"), parts);
}

/// Draws a row for each title, below the name of their column. A long title is shortened, so that the figures beside it stay in
/// sight.
fn by_name<'a>(ui: &mut Ui, column: &str, rows: impl Iterator<Item = (String, &'a Tally)>) {
    let room = ui.available_width() * MAX_TITLE_SHARE;
    let font = TextStyle::Body.resolve(ui.style());
    Grid::new(("by name", column))
        .num_columns(4)
        .spacing(vec2(24.0, 4.0))
        .show(ui, |ui| {
            for name in [
                column.to_owned(),
                text!("operator-ok"),
                text!("operator-not-ok"),
                text!("history-ok-share"),
            ] {
                ui.label(RichText::new(name).small().weak());
            }
            ui.end_row();
            for (title, tally) in rows {
                let shown = fitted_middle(ui.painter(), &title, &font, room);
                let is_whole = shown == title;
                let label = ui.label(shown);
                label.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, &title));
                if !is_whole {
                    label.on_hover_text(title);
                }
                for figure in [
                    tally.num_ok.to_string(),
                    tally.num_not_ok.to_string(),
                    tally.share(),
                ] {
                    ui.label(figure);
                }
                ui.end_row();
            }
        });
}

/// A bar for each of the last shifts: accepted parts below, refused ones on top of them.
fn shifts(ui: &mut Ui, all: &[(Zoned, Tally)]) {
    let theme = Theme::of(ui);
    let last = &all[all.len().saturating_sub(MAX_SHIFTS)..];
    let size = vec2(ui.available_width(), HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    let in_words = |(start, tally): &(Zoned, Tally)| {
        let at = start.strftime("%Y-%m-%d %H:%M").to_string();
        let Tally { num_ok, num_not_ok } = *tally;
        text!("history-shift", start = at, ok = num_ok, nok = num_not_ok)
    };
    let words: Vec<String> = last.iter().map(in_words).collect();
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, words.join("; ")));
    ui.painter().rect_filled(rect, ROUNDING, theme.panel);
    let most = last.iter().map(|(_, tally)| tally.num()).max().unwrap_or(0);
    let num_places = last.len().max(MIN_SHIFTS);
    // As many marks as fit.
    let room = (size.x / 90.0).max(1.0) as usize;
    let step = num_places.div_ceil(room).max(1);
    let marks = last.iter().enumerate().step_by(step);
    let marks =
        marks.map(|(index, (start, _))| (index as f64, start.strftime("%m-%d %H:%M").to_string()));
    let bars = |height: fn(&Tally) -> usize, offset: fn(&Tally) -> usize| -> Vec<Bar> {
        let shifts = last.iter().enumerate();
        shifts
            .map(|(index, (_, tally))| {
                Bar::new(index as f64, height(tally) as f64)
                    .base_offset(offset(tally) as f64)
                    .width(0.7)
            })
            .collect()
    };
    let (ok, not_ok) = (
        bars(|tally| tally.num_ok, |_| 0),
        bars(|tally| tally.num_not_ok, |tally| tally.num_ok),
    );
    let axes = Axes {
        title: vec![(text!("history-by-shift"), theme.text)],
        across: Axis::new([-0.6, num_places as f64 - 0.4], marks.collect()),
        up: Axis::new(
            // Leave room for the names above the bars.
            [0.0, 1.25 * most as f64],
            [0, most].map(|num| (num as f64, num.to_string())).to_vec(),
        ),
        font: font::small(),
        read: Some(Box::new(move |x| {
            let index = x.round().max(0.0) as usize;
            words.get(index).cloned().unwrap_or_default()
        })),
    };
    let colours = [theme.accepted, theme.rejected];
    let shown = axes.show(ui, rect.shrink(space::MEDIUM), move |plot| {
        for (bars, colour) in [ok, not_ok].into_iter().zip(colours) {
            plot.bar_chart(BarChart::new("", bars).color(colour).allow_hover(false));
        }
    });
    // The order, refused on top, tells them apart without colour.
    let names = [text!("history-not-ok-on-top"), text!("operator-ok")];
    let names = names.iter().map(String::as_str);
    let curves = names.zip([theme.rejected, theme.accepted]);
    legend(
        ui.painter(),
        &shown,
        curves.map(|(name, colour)| (name, colour, LineStyle::Solid)),
    );
    let text = total_in_words(all);
    let corner = rect.right_top() + vec2(-space::MEDIUM, space::MEDIUM);
    ui.painter().text(
        corner,
        Align2::RIGHT_TOP,
        text,
        font::small(),
        theme.weak_text,
    );
}

/// The count of all listed shifts: that of one shift alone is on its bar and in the operator's header.
fn total_in_words(all: &[(Zoned, Tally)]) -> String {
    let mut total = Tally::default();
    for (_, tally) in all {
        total.num_ok += tally.num_ok;
        total.num_not_ok += tally.num_not_ok;
    }
    let (count, share) = (total.num(), total.share());
    match all.len() {
        0 | 1 => text!("history-total", count = count, share = share),
        num => text!(
            "history-total-of-shifts",
            shifts = num,
            count = count,
            share = share
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An outcome at this moment of 21 November 2026.
    fn outcome(
        time: &str,
        verdict: StoredVerdict,
        part: &str,
        reason: Option<RefusalKind>,
    ) -> PartOutcome {
        PartOutcome {
            at: format!("2026-11-21T{time}Z").parse().expect("a moment"),
            verdict,
            is_ok: verdict == StoredVerdict::Accepted,
            part: Some(part.to_owned()),
            reason,
            rack: None,
        }
    }

    fn counted(outcomes: &[PartOutcome]) -> Statistics {
        let title_of = |name: &str| match name {
            "door" => "Door, left".to_owned(),
            name => name.to_owned(),
        };
        count(outcomes, &ShiftStarts::default(), &TimeZone::UTC, title_of)
    }

    #[test]
    fn parts_are_counted_by_shift_and_by_part() {
        let refused = || Some(RefusalKind::named("low_score"));
        let (ok, not_ok) = (StoredVerdict::Accepted, StoredVerdict::Rejected);
        let found = counted(&[
            outcome("05:59:00", ok, "door", None),
            outcome("06:00:00", not_ok, "door", refused()),
            outcome("07:00:00", not_ok, "fender", refused()),
            outcome("08:00:00", StoredVerdict::NoPart, "", None),
            outcome("15:00:00", ok, "door", None),
        ]);
        assert_eq!(found.num_no_part, 1);
        let shifts: Vec<_> = found
            .shifts
            .iter()
            .map(|(start, tally)| (start.hour(), tally.num_ok, tally.num_not_ok))
            .collect();
        assert_eq!(shifts, [(22, 1, 0), (6, 0, 2), (14, 1, 0)]);
        // The total of several shifts is not taken for that of the last.
        let total = total_in_words(&found.shifts);
        assert!(total.starts_with("3 shifts: 4 parts, 50"), "{total}");
        let total = total_in_words(&found.shifts[1..2]);
        assert!(total.starts_with("2 parts, 0"), "{total}");
        let door = Tally {
            num_ok: 2,
            num_not_ok: 1,
        };
        let fender = Tally {
            num_ok: 0,
            num_not_ok: 1,
        };
        assert_eq!(
            found.parts,
            [
                (Some("Door, left".into()), door),
                (Some("fender".into()), fender)
            ]
        );
    }

    #[test]
    fn parts_of_racks_that_have_a_name_are_counted_by_rack() {
        let (ok, not_ok) = (StoredVerdict::Accepted, StoredVerdict::Rejected);
        let in_rack = |rack: &str, verdict| PartOutcome {
            rack: Some(rack.into()),
            ..outcome("07:00:00", verdict, "door", None)
        };
        let found = counted(&[
            in_rack("B", ok),
            in_rack("A", ok),
            outcome("07:00:00", ok, "door", None),
            in_rack("A", not_ok),
            in_rack("C", StoredVerdict::NoPart),
        ]);
        let tally = |num_ok, num_not_ok| Tally { num_ok, num_not_ok };
        let racks = [("A".into(), tally(1, 1)), ("B".into(), tally(1, 0))];
        assert_eq!(found.racks, BTreeMap::from(racks));
        assert!(
            counted(&[outcome("07:00:00", ok, "door", None)])
                .racks
                .is_empty()
        );
    }

    #[test]
    fn a_long_title_leaves_the_figures_in_sight() {
        const WIDTH: f32 = 500.0;
        let parts = [
            "Front fender of the red delivery van, left. ".repeat(2),
            "左前翼子板".repeat(16),
        ];
        let tally = Tally {
            num_ok: 3,
            num_not_ok: 1,
        };
        let parts = parts.map(|title| (Some(title), tally));
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        let mut output = ctx.run_ui(egui::RawInput::default(), |_| {});
        // The size of the columns is known from the second frame on.
        for _ in 0..2 {
            output.drop_without_applying_deltas();
            output = ctx.run_ui(egui::RawInput::default(), |ui| {
                ui.set_max_width(WIDTH);
                by_part(ui, &parts);
            });
        }
        let texts = output.shapes.iter().filter_map(|drawn| match &drawn.shape {
            egui::Shape::Text(text) => {
                let right = text.visual_bounding_rect().right();
                Some((text.galley.text().to_owned(), right))
            }
            _ => None,
        });
        let texts: Vec<(String, f32)> = texts.collect();
        output.drop_without_applying_deltas();
        let shares = texts.iter().filter(|(text, _)| text == "75.0 %");
        assert_eq!(shares.count(), 2, "{texts:?}");
        for (text, right) in &texts {
            assert!(*right <= WIDTH, "{text} ends at {right}");
        }
    }

    #[test]
    fn an_accepted_part_that_was_reported_as_wrong_is_counted_as_not_ok() {
        let accepted = outcome("07:00:00", StoredVerdict::Accepted, "door", None);
        let wrong = PartOutcome {
            is_ok: false,
            ..accepted.clone()
        };
        let found = counted(&[accepted, wrong]);
        let tally = Tally {
            num_ok: 1,
            num_not_ok: 1,
        };
        assert_eq!(found.parts, [(Some("Door, left".into()), tally)]);
        assert_eq!(found.reasons, [(ReasonGroup::ReportedWrong, 1)]);
    }

    #[test]
    fn a_part_of_which_too_few_frames_were_inspected_is_neither_ok_nor_not_ok() {
        let refused = |kind: &str| {
            let reason = Some(RefusalKind::named(kind));
            outcome("06:00:00", StoredVerdict::Rejected, "door", reason)
        };
        let found = counted(&[refused("piece"), refused("too_slow"), refused("few_frames")]);
        let tally = Tally {
            num_ok: 0,
            num_not_ok: 1,
        };
        assert_eq!(found.parts, [(Some("Door, left".into()), tally)]);
        assert_eq!(found.num_not_judged, 2);
    }

    #[test]
    fn refusals_are_counted_by_kind() {
        let refused = |kind: &str| {
            let reason = Some(RefusalKind::named(kind));
            outcome("06:00:00", StoredVerdict::Rejected, "door", reason)
        };
        let found = counted(&[refused("piece"), refused("low_score"), refused("low_score")]);
        let group = |kind: &str| ReasonGroup::Kind(RefusalKind::named(kind));
        assert_eq!(
            found.reasons,
            [(group("low_score"), 2), (group("piece"), 1)]
        );
    }
}
