//! The list of past inspections: however many there are, only the rows in sight are fetched and drawn.

use egui::{Align2, Painter, Rect, RichText, ScrollArea, Sense, Ui, pos2, vec2};
use jiff::{Timestamp, tz::TimeZone};

use super::{HistoryAction, HistoryState, bar};
use crate::{
    app::{
        shell::session::Session,
        ui::{
            theme::{ROUNDING, Theme, font, space},
            widgets::{Mark, focus_ring, mark},
        },
    },
    history::{StoredVerdict, Summary},
};

/// Height of a row: a target for a gloved finger.
const ROW: f32 = 40.0;
/// Between two rows.
const GAP: f32 = 2.0;
/// In less width than this moments are shortened.
const NARROW: f32 = 700.0;

/// What the list keeps between frames.
#[derive(Default)]
pub(super) struct List {
    /// The inspection that was looked at in the last frame.
    selected: Option<i64>,
    /// Places of the rows that were in sight.
    seen: std::ops::Range<usize>,
}

impl List {
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        history: &HistoryState,
        session: &Session,
        theme: &Theme,
        actions: &mut Vec<HistoryAction>,
    ) {
        bar::ui(ui, history, session, theme, actions);
        if let Some(trouble) = &history.trouble {
            let text = format!("Kept in memory only: {}", trouble.what);
            ui.label(RichText::new(text).color(theme.warning));
            ui.label(
                RichText::new(&trouble.advice)
                    .font(font::body_strong())
                    .color(theme.warning),
            );
        }
        ui.add_space(space::SMALL);
        let columns = Columns::across(ui.available_width());
        head(ui, &columns, theme);
        let num_rows = history.num_matching();
        if num_rows == 0 {
            ui.add_space(space::LARGE);
            let text = "No matching inspections: change the filter";
            ui.label(RichText::new(text).color(theme.weak_text));
            // What comes next is fetched with its neighbours.
            see(history, 0..1, actions);
            return;
        }
        ui.spacing_mut().item_spacing.y = GAP;
        let mut area = ScrollArea::vertical().auto_shrink(false);
        if let Some(offset) = self.offset_to(history, ui.available_height()) {
            area = area.vertical_scroll_offset(offset);
        }
        let mut seen = 0..0;
        let listed = history.listed();
        area.show_rows(ui, ROW, num_rows, |ui, visible| {
            seen = visible.clone();
            for place in visible {
                match history.row(place) {
                    Some(past) => row(ui, past, listed, &columns, theme, actions),
                    None => {
                        ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::hover());
                    }
                }
            }
        });
        self.seen = seen.clone();
        see(history, seen, actions);
    }

    /// Where to scroll when the keys have led out of sight.
    fn offset_to(&mut self, history: &HistoryState, height: f32) -> Option<f32> {
        let listed = history.listed();
        let before = std::mem::replace(&mut self.selected, listed);
        let place = listed.and_then(|number| history.place_of(number))?;
        // The last row in sight is often cut off.
        let is_in_sight = self.seen.start < place && place + 2 < self.seen.end;
        if before == listed || before.is_none() || is_in_sight {
            return None;
        }
        let top = place as f32 * (ROW + GAP);
        let now = self.seen.start as f32 * (ROW + GAP);
        Some(if top <= now {
            (top - ROW).max(0.0)
        } else {
            (top + 2.0 * ROW - height).max(0.0)
        })
    }
}

/// Says which rows are in sight where that is not known.
fn see(history: &HistoryState, rows: std::ops::Range<usize>, actions: &mut Vec<HistoryAction>) {
    if history.is_news(&rows) {
        actions.push(HistoryAction::Visible(rows));
    }
}

/// Where the columns lie, from the left edge of the list.
struct Columns {
    /// There is no room for a whole moment.
    is_narrow: bool,
    part: f32,
    scene: f32,
    /// Right edges.
    score: f32,
    time: f32,
    when: f32,
}

impl Columns {
    fn across(width: f32) -> Self {
        let when = width - 14.0;
        let is_narrow = width < NARROW;
        let time = when - if is_narrow { 96.0 } else { 170.0 };
        let score = time - if is_narrow { 52.0 } else { 70.0 };
        let part = 40.0;
        Self {
            is_narrow,
            part,
            scene: part + (score - 60.0 - part) * 0.58,
            score,
            time,
            when,
        }
    }
}

fn head(ui: &mut Ui, columns: &Columns, theme: &Theme) {
    let size = vec2(ui.available_width(), 22.0);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let painter = ui.painter();
    let text = |x: f32, anchor: Align2, text: &str| {
        let at = pos2(rect.left() + x, rect.center().y);
        painter.text(at, anchor, text, font::heading(), theme.weak_text);
    };
    text(columns.part, Align2::LEFT_CENTER, "Part");
    text(columns.scene, Align2::LEFT_CENTER, "Scene");
    text(columns.score, Align2::RIGHT_CENTER, "Score");
    text(columns.time, Align2::RIGHT_CENTER, "ms");
    text(columns.when, Align2::RIGHT_CENTER, "Time");
}

fn row(
    ui: &mut Ui,
    past: &Summary,
    selected: Option<i64>,
    columns: &Columns,
    theme: &Theme,
    actions: &mut Vec<HistoryAction>,
) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
    let is_selected = selected == Some(past.number);
    response.widget_info(|| {
        let verdict = past.verdict.title();
        let again = match past.num_below {
            0 => String::new(),
            1 => ", inspected again once".to_owned(),
            num => format!(", inspected again {num} times"),
        };
        let label = format!(
            "Inspection {}: {}, {verdict}{again}",
            past.number.abs(),
            past.title
        );
        egui::WidgetInfo::selected(egui::Role::Button, true, is_selected, label)
    });
    if ui.is_rect_visible(rect) {
        let painter = ui.painter();
        if is_selected || response.hovered() {
            painter.rect_filled(rect, ROUNDING, theme.control);
        }
        paint(painter, rect, past, columns, theme);
        focus_ring(ui, rect, &response, theme);
    }
    if response.clicked() {
        actions.push(HistoryAction::Select(past.number));
    }
    if response.double_clicked() {
        actions.push(HistoryAction::Open(past.number));
    }
}

fn paint(painter: &Painter, rect: Rect, past: &Summary, columns: &Columns, theme: &Theme) {
    let y = rect.center().y;
    // What a person said of it is what others look for first.
    let scene = if past.remark.is_empty() {
        past.scene.clone()
    } else {
        format!("{} · {}", past.remark, past.scene)
    };
    let sign = match past.verdict {
        StoredVerdict::Accepted => Mark::Good,
        StoredVerdict::NotAccepted | StoredVerdict::Unknown | StoredVerdict::NoPart => Mark::Bad,
    };
    mark(painter, pos2(rect.left() + 20.0, y), 9.0, sign, theme);
    let left = |from: f32, to: f32, text: &str, font, colour| {
        let clip = Rect::from_x_y_ranges(
            rect.left() + from..=rect.left() + to - space::SMALL,
            rect.y_range(),
        );
        painter
            .with_clip_rect(clip.intersect(painter.clip_rect()))
            .text(
                pos2(rect.left() + from, y),
                Align2::LEFT_CENTER,
                text,
                font,
                colour,
            );
    };
    // How often it was inspected again.
    let title = match past.num_below {
        0 => past.title.clone(),
        num => format!("{} · again {num}×", past.title),
    };
    left(
        columns.part,
        columns.scene,
        &title,
        font::body_strong(),
        theme.text,
    );
    left(
        columns.scene,
        columns.score - 50.0,
        &scene,
        font::body(),
        theme.weak_text,
    );
    let right = |x: f32, text: &str, colour| {
        let at = pos2(rect.left() + x, y);
        painter.text(at, Align2::RIGHT_CENTER, text, font::body(), colour);
    };
    let score = past
        .score
        .map_or_else(String::new, |[score, _]| format!("{score:.2}"));
    right(columns.score, &score, theme.text);
    right(
        columns.time,
        &format!("{:.0}", past.total_ms),
        theme.weak_text,
    );
    let at = if columns.is_narrow {
        shortly(past.at)
    } else {
        when(past.at)
    };
    right(columns.when, &at, theme.weak_text);
}

/// The same without year and seconds.
fn shortly(at: Timestamp) -> String {
    let here = at.to_zoned(TimeZone::system());
    here.strftime("%m-%d %H:%M").to_string()
}

/// The time of day alone.
pub(super) fn time_of_day(at: Timestamp) -> String {
    let here = at.to_zoned(TimeZone::system());
    here.strftime("%H:%M:%S").to_string()
}

/// Day and time of day, as the clocks here go.
pub(super) fn when(at: Timestamp) -> String {
    let here = at.to_zoned(TimeZone::system());
    here.strftime("%Y-%m-%d %H:%M:%S").to_string()
}
