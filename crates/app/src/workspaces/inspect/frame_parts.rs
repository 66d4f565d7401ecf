//! The parts of a frame, of which one is selected, and what of it is as expected.

use std::sync::Arc;

use egui::{
    Align2, FontId, Frame, Panel, Response, RichText, Role, ScrollArea, Sense, StrokeKind, Ui,
    WidgetInfo, pos2,
    text::{LayoutJob, TextWrapping},
    vec2,
};

use crate::workspaces::inspect::{
    headline::Headline,
    operator_words::{in_short, why_not},
    state::InspectAction,
};
use inspection::pipeline::{Inspection, Rejection, Verdict};
use shell::{
    action::Action,
    inspection::inspected::Inspected,
    session::{Session, Shown},
    trace::expecting,
};
use ui::{
    language::text,
    theme::{ROUNDING, Theme, font, space},
    widgets::{fitted_middle, focus_ring, text_width, wrapped, wrapped_rows},
};

/// Most parts listed at once, and on a card that is low; the others scroll into view.
const MOST_ROWS: [usize; 2] = [4, 3];
/// Height of a card that is low, logical pixels.
const LOW: f32 = 560.0;
/// Above, below and beside the text of a row, logical pixels.
const MARGIN: f32 = 5.0;

/// Name of a part of several, by its number in the list.
pub(super) fn numbered(index: usize, title: &str) -> String {
    format!("{} · {title}", index + 1)
}

/// Draws how many parts are accepted, or as expected, and the list of them, unless there is only one; then the empty places.
pub(super) fn ui(ui: &mut Ui, session: &Session, actions: &mut Vec<InspectAction>) {
    let Some(shown) = session.shown.as_ref() else {
        return;
    };
    let rows = rows(shown, session);
    let empty = empty_places(shown);
    let expectation = FrameExpectation::of(&shown.parts, session);
    let is_low = ui.available_height() < LOW;
    let heading = match &expectation {
        Some(expectation) if is_low => Some((expectation.title.clone(), font::verdict())),
        Some(expectation) => Some((expectation.title.clone(), font::title())),
        None if rows.len() > 1 => {
            let headlines = shown.parts.iter().map(|part| Headline::of(part, session));
            let num = headlines.filter(Headline::is_accepted).count();
            let of_all = text!("inspect-parts-accepted", num = num, all = rows.len());
            Some((of_all, font::heading()))
        }
        None => None,
    };
    if heading.is_none() && empty.is_none() {
        return;
    }
    if let Some((heading, font)) = heading {
        ui.label(RichText::new(heading).font(font));
    }
    let complaint = expectation
        .as_ref()
        .map(|expectation| &expectation.complaint);
    if let Some(complaint) = complaint.filter(|complaint| !complaint.is_empty()) {
        wrapped(ui, complaint, &font::body_strong(), Theme::of(ui).rejected);
    }
    if rows.len() > 1 {
        let fonts = [font::body_strong(), font::small()];
        // Below it, there must be room for the verdict on the selected part.
        let most = MOST_ROWS[usize::from(is_low && expectation.is_some())];
        ui.scope(|ui| {
            ui.set_max_height(height(ui, rows.len().min(most), &fonts));
            list(ui, shown.selected(), &rows, &fonts, actions);
        });
    }
    if let Some(empty) = empty {
        wrapped(ui, &empty, &font::small(), Theme::of(ui).weak_text);
    }
    ui.add_space(space::MEDIUM);
}

/// Draws the parts of the frame for the operator, unless there is only one, and the empty places, at the bottom.
pub(super) fn operators_panel(
    ui: &mut Ui,
    shown: &Shown,
    session: &Session,
    actions: &mut Vec<InspectAction>,
) {
    let fonts = [font::far_list(), font::body()];
    let margin = space::MEDIUM;
    let weak = Theme::of(ui).weak_text;
    let rows = rows(shown, session);
    let empty = empty_places(shown);
    let mut size = 0.0;
    if rows.len() > 1 {
        size += height(ui, rows.len(), &fonts);
    }
    if let Some(empty) = &empty {
        let width = ui.available_width() - 2.0 * margin;
        let lines = wrapped_rows(ui.painter(), empty, &fonts[1], weak, width);
        size += lines.size().y + ui.spacing().item_spacing.y;
    }
    if size == 0.0 {
        return;
    }
    Panel::bottom("parts of the frame")
        .exact_size(size + 2.0 * margin)
        .resizable(false)
        .frame(Frame::new().fill(Theme::of(ui).panel).inner_margin(margin))
        .show(ui, |ui| {
            if rows.len() > 1 {
                list(ui, shown.selected(), &rows, &fonts, actions);
            }
            if let Some(empty) = &empty {
                wrapped(ui, empty, &fonts[1], weak);
            }
        });
}

/// Names the places at which nothing hangs; `None` if there are none, or if only one part of the frame was opened again.
fn empty_places(shown: &Shown) -> Option<String> {
    let parts = shown.parts.iter();
    let found: Vec<&Inspection> = parts.map(|part| &part.inspection).collect();
    let empty = shown.inspected.recipe.empty_places(&found);
    let is_known = !empty.is_empty() && !shown.is_past;
    is_known.then(|| text!("rack-empty-places", places = empty.join(", ")))
}

/// The parts of the frame, then those that are missing; of a rack with places, one place after the other.
fn rows(shown: &Shown, session: &Session) -> Vec<PartRow> {
    let parts = shown.parts.iter().enumerate();
    let rows = parts.map(|(index, part)| {
        let place = part.inspection.place.clone();
        (place, PartRow::of(index, part, session))
    });
    let expectation = FrameExpectation::of(&shown.parts, session);
    let missing = expectation.into_iter().flat_map(|all| all.missing);
    let missing = (shown.parts.len()..).zip(missing);
    let missing = missing.map(|(index, part)| (part.place, PartRow::of_missing(index, part.title)));
    let mut rows: Vec<(Option<String>, PartRow)> = rows.chain(missing).collect();
    let places = &shown.inspected.recipe.rack.places;
    rows.sort_by_key(|(at, _)| {
        let mut places = places.iter();
        let index = places.position(|place| Some(&place.name) == at.as_ref());
        index.unwrap_or(usize::MAX)
    });
    rows.into_iter().map(|(_, row)| row).collect()
}

/// Height of the list, with titles and lines below in these fonts.
fn height(ui: &Ui, num_rows: usize, fonts: &[FontId; 2]) -> f32 {
    let rows = num_rows.min(MOST_ROWS[0]) as f32;
    rows * (row_height(ui, fonts) + ui.spacing().item_spacing.y)
}

fn row_height(ui: &Ui, fonts: &[FontId; 2]) -> f32 {
    let lines = fonts
        .iter()
        .map(|font| ui.ctx().fonts_mut(|fonts| fonts.row_height(font)));
    (lines.sum::<f32>() + 2.0 * MARGIN).max(space::TARGET)
}

/// Draws the list with titles and lines below in these fonts.
fn list(
    ui: &mut Ui,
    selected: usize,
    rows: &[PartRow],
    fonts: &[FontId; 2],
    actions: &mut Vec<InspectAction>,
) {
    let height = height(ui, rows.len(), fonts);
    ScrollArea::vertical()
        .id_salt("parts of the frame")
        .max_height(height)
        .show(ui, |ui| {
            for row in rows {
                let is_clicked = row.ui(ui, row.index == selected, fonts).clicked();
                if is_clicked && row.headline.is_some() {
                    actions.push(InspectAction::Act(Action::SelectPart(row.index)));
                }
            }
        });
}

/// A part in the list.
struct PartRow {
    /// Its place in the frame; that of a missing part follows.
    index: usize,
    title: String,
    /// `None` for a part that is missing.
    headline: Option<Headline>,
    /// Whether it is as expected, if that is known.
    word: Option<String>,
    /// Its score or size, and why it is not accepted.
    below: String,
}

impl PartRow {
    fn of(index: usize, part: &Inspected, session: &Session) -> Self {
        let inspection = &part.inspection;
        let figure = match &inspection.verdict {
            Verdict::Part { score, .. } if !inspection.verdict.is_unknown() => {
                Some(format!("{score:.2}"))
            }
            _ => {
                let surface = inspection.segmentation.part.as_ref().ok();
                let surface = surface.and_then(|part| part.surface);
                surface.map(|surface| session.units.area(surface.area))
            }
        };
        // Figures are for the engineer.
        let figure = figure.filter(|_| !session.is_operator_view());
        let place = inspection.place.clone();
        let place = place.map(|place| text!("rack-place", place = place));
        let why = why_not(part).map(|why| in_short(&why));
        let below: Vec<String> = place.into_iter().chain(figure).chain(why).collect();
        let headline = Headline::of(part, session);
        Self {
            index,
            title: headline.title.clone(),
            word: word_of(part).filter(|_| headline.actual.is_none()),
            headline: Some(headline),
            below: below.join(" · "),
        }
    }

    fn of_missing(index: usize, title: String) -> Self {
        Self {
            index,
            title,
            headline: None,
            word: Some(text!("expect-is-missing")),
            below: text!("expect-nothing-hangs"),
        }
    }

    fn ui(&self, ui: &mut Ui, is_selected: bool, fonts: &[FontId; 2]) -> Response {
        let theme = Theme::of(ui);
        let [title_font, below_font] = fonts;
        let size = vec2(ui.available_width(), row_height(ui, fonts));
        let (rect, response) = ui.allocate_exact_size(size, Sense::click());
        let (word, colour) = match &self.headline {
            Some(headline) => {
                let (_, word, colour) = headline.verdict(theme);
                (word, colour)
            }
            None => (String::new(), theme.warning),
        };
        let word = self.word.clone().unwrap_or(word);
        let number = (self.index + 1).to_string();
        let name = format!("{number} {}: {word}", self.title);
        response.widget_info(|| {
            WidgetInfo::selected(Role::Button, ui.is_enabled(), is_selected, &name)
        });
        let fill = if response.hovered() {
            theme.control_hovered
        } else if is_selected {
            theme.control
        } else {
            theme.panel
        };
        let edge = if is_selected {
            theme.accent
        } else {
            theme.edge
        };
        let painter = ui.painter_at(rect);
        painter.rect(rect, ROUNDING, fill, (1.0, edge), StrokeKind::Inside);
        focus_ring(ui, rect, &response);
        let radius = title_font.size * 0.8;
        let disc = pos2(rect.left() + 2.0 * MARGIN + radius, rect.center().y);
        painter.circle_filled(disc, radius, colour);
        painter.text(
            disc,
            Align2::CENTER_CENTER,
            &number,
            title_font.clone(),
            theme.panel,
        );
        let (left, right) = (disc.x + radius + 2.0 * MARGIN, rect.right() - 2.0 * MARGIN);
        let word_width = text_width(&painter, &word, below_font);
        let room = right - left - word_width - space::SMALL;
        let title = fitted_middle(&painter, &self.title, title_font, room);
        let (at, anchor) = if self.below.is_empty() {
            (pos2(left, rect.center().y), Align2::LEFT_CENTER)
        } else {
            (pos2(left, rect.top() + MARGIN), Align2::LEFT_TOP)
        };
        let title = painter.text(at, anchor, title, title_font.clone(), theme.text);
        painter.text(
            pos2(right, title.center().y),
            Align2::RIGHT_CENTER,
            word,
            below_font.clone(),
            colour,
        );
        let mut job =
            LayoutJob::simple_singleline(self.below.clone(), below_font.clone(), theme.weak_text);
        job.wrap = TextWrapping::truncate_at_width(right - left);
        let below = painter.layout_job(job);
        let is_cut = below.elided;
        painter.galley(pos2(left, title.bottom()), below, theme.weak_text);
        if is_cut {
            response.on_hover_text(&self.below)
        } else {
            response
        }
    }
}

/// An expected part that nothing hangs in place of.
pub(super) struct MissingPart {
    /// Its title, with its place.
    pub(super) title: String,
    /// The place of the rack where it should hang.
    pub(super) place: Option<String>,
}

/// How a frame compares with what is expected.
pub(super) struct FrameExpectation {
    /// How many of the expected parts are accepted.
    pub(super) title: String,
    /// Each difference; empty if there is none that is not said of a part by itself.
    pub(super) complaint: String,
    /// The parts that nothing hangs in place of.
    pub(super) missing: Vec<MissingPart>,
    /// Number of expected parts.
    pub(super) num_expected: usize,
    /// True if all of them are accepted, and nothing else is an enrolled part.
    pub(super) is_met: bool,
}

impl FrameExpectation {
    /// `None` if nothing is expected, it is too early for a verdict on one of the parts, or the other parts of the frame are not known.
    pub(super) fn of(parts: &[Arc<Inspected>], session: &Session) -> Option<Self> {
        let first = parts.first()?;
        let expected = &first.recipe.expected;
        if expected.is_empty() || parts.iter().any(|part| part.is_open()) {
            return None;
        }
        let title_of = |name: &str| first.library.title_of(name).to_owned();
        let all: Vec<&Inspection> = parts.iter().map(|part| &part.inspection).collect();
        let num_expected = expected.parts().len();
        let is_past = session.shown.as_ref().is_some_and(|shown| shown.is_past);
        if is_past && num_expected > 1 {
            // One part of the frame is opened again, without the others.
            return None;
        }
        let missing = expected.missing(&all).into_iter();
        let missing: Vec<MissingPart> = missing
            .map(|part| MissingPart {
                title: expecting::title_of(part, title_of),
                place: part.place.clone(),
            })
            .collect();
        let differences = all.iter().filter_map(|one| match one.verdict.rejected()? {
            Rejection::WrongPart { part, expected } => Some(text!(
                "expect-wrong",
                part = title_of(part),
                expected = title_of(expected)
            )),
            Rejection::ExpectedElsewhere {
                part, expected_at, ..
            } => Some(text!(
                "expect-elsewhere",
                part = title_of(part),
                place = expected_at
            )),
            Rejection::NotExpected { part } => Some(text!("expect-surplus", part = title_of(part))),
            _ => None,
        });
        let titles: Vec<&str> = missing.iter().map(|part| &*part.title).collect();
        let absent =
            (!titles.is_empty()).then(|| text!("expect-missing", parts = titles.join(" · ")));
        let differences: Vec<String> = differences.chain(absent).collect();
        let mut complaint = differences.join("; ");
        let order = session.trace.of_part(first).order;
        if !complaint.is_empty() && !order.is_empty() && session.expecting.orders().is_some() {
            complaint = text!("expect-of-order", order = order, says = complaint);
        }
        let accepted = parts.iter().map(|part| Headline::of(part, session));
        let num_met = accepted.filter(Headline::is_accepted).count();
        Some(Self {
            title: text!("expect-num-met", num = num_met, all = num_expected),
            complaint,
            missing,
            num_expected,
            is_met: expected.is_met(&all) && num_met == num_expected,
        })
    }
}

/// The word for a part that is as expected, or is not; `None` if the verdict has another reason, or nothing is expected.
pub(super) fn word_of(inspected: &Inspected) -> Option<String> {
    if inspected.recipe.expected.is_empty() {
        return None;
    }
    match inspected.inspection.verdict.rejected() {
        Some(Rejection::WrongPart { .. }) => Some(text!("expect-wrong-part")),
        Some(Rejection::ExpectedElsewhere { .. }) => Some(text!("expect-wrong-place")),
        Some(Rejection::NotExpected { .. }) => Some(text!("expect-not-expected")),
        None if inspected.inspection.verdict.is_accepted() => Some(text!("expect-as-expected")),
        _ => None,
    }
}
