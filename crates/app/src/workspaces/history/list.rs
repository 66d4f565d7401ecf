//! The list of past inspections; only the visible rows are fetched and drawn.

use egui::{
    Align2, Color32, FontId, Painter, Rect, RichText, ScrollArea, Sense, Stroke, Ui, pos2,
    text::{LayoutJob, TextWrapping},
    vec2,
};
use jiff::{Timestamp, tz::TimeZone};

use super::{HistoryAction, HistoryState, bar};
use crate::{shared::truth_title, workspaces::history::details::in_one_line};
use records::history::Summary;
use shell::{
    inspection::library_cache::LibraryView,
    language::{inspection_title, scene_title},
    session::{Session, past_mark},
};
use ui::{
    language::{Language, described, text},
    theme::{ROUNDING, Theme, font, space},
    widgets::{fitted_middle, fitted_path, focus_ring, mark, sentence, shortened, text_width},
};

/// Height of a row, logical pixels: a target for a gloved finger.
const ROW_HEIGHT_PX: f32 = 40.0;
/// Gap between two rows, logical pixels.
const ROW_GAP_PX: f32 = 2.0;
/// Below this width, logical pixels, dates are shortened.
const SHORT_DATE_WIDTH_PX: f32 = 700.0;
/// Longest remark in a row, characters: measuring more would take time for every row of every frame.
const MAX_REMARK: usize = 80;

/// State of the list kept between frames.
#[derive(Default)]
pub(super) struct List {
    /// The row that was selected when the list last showed it, and [`HistoryState::num_reselected`] at that time.
    selected: (Option<i64>, u64),
    /// The rows that were visible.
    seen: std::ops::Range<usize>,
}

impl List {
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        history: &HistoryState,
        session: &Session,
        actions: &mut Vec<HistoryAction>,
    ) {
        let theme = Theme::of(ui);
        bar::ui(ui, history, session, actions);
        if let Some(problem) = &history.problem {
            let text = text!("history-in-memory", reason = &problem.what);
            ui.colored_label(theme.warning, text);
            ui.label(
                RichText::new(&problem.advice)
                    .font(font::body_strong())
                    .color(theme.warning),
            );
        }
        ui.add_space(space::SMALL);
        let layout = Layout::across(ui.available_width());
        head(ui, &layout);
        let num_rows = history.page.num_matching;
        if num_rows == 0 {
            ui.add_space(space::LARGE);
            ui.weak(text!("history-none-listed"));
            // Fetches the next inspection together with its neighbours.
            see(history, 0..1, actions);
            return;
        }
        ui.spacing_mut().item_spacing.y = ROW_GAP_PX;
        let mut area = ScrollArea::vertical().auto_shrink(false);
        if let Some(offset) = self.offset_to(history, ui.available_height()) {
            area = area.vertical_scroll_offset(offset);
        }
        let mut seen = 0..0;
        let listed = history.listed();
        area.show_rows(ui, ROW_HEIGHT_PX, num_rows, |ui, visible| {
            seen = visible.clone();
            for index in visible {
                match history.row(index) {
                    Some(past) => row(ui, past, listed, &layout, session, actions),
                    None => {
                        ui.allocate_exact_size(
                            vec2(ui.available_width(), ROW_HEIGHT_PX),
                            Sense::hover(),
                        );
                    }
                }
            }
        });
        self.seen = seen.clone();
        see(history, seen, actions);
    }

    /// Scroll offset that shows the selected row if the keys or the program have selected one out of sight.
    fn offset_to(&mut self, history: &HistoryState, height: f32) -> Option<f32> {
        let selected = (history.listed(), history.num_reselected);
        let index = history.index_of_listed();
        // The index of an old row is known once its inspection is fetched.
        if selected == self.selected || selected.0.is_some() && index.is_none() {
            return None;
        }
        self.selected = selected;
        let index = index?;
        // The last visible row is often cut off.
        let is_in_sight = self.seen.start < index && index + 2 < self.seen.end;
        if is_in_sight {
            return None;
        }
        let top = index as f32 * (ROW_HEIGHT_PX + ROW_GAP_PX);
        let now = self.seen.start as f32 * (ROW_HEIGHT_PX + ROW_GAP_PX);
        Some(if top <= now {
            (top - ROW_HEIGHT_PX).max(0.0)
        } else {
            (top + 2.0 * ROW_HEIGHT_PX - height).max(0.0)
        })
    }
}

/// Reports the visible rows if they have changed.
fn see(history: &HistoryState, rows: std::ops::Range<usize>, actions: &mut Vec<HistoryAction>) {
    if history.visible != rows {
        actions.push(HistoryAction::Visible(rows));
    }
}

/// Width available to the list.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Room {
    Wide,
    Narrow,
}

/// A column of the list.
struct Column {
    name: fn() -> String,
    width: Width,
    /// True for a text that ends in a path, which is elided at its front.
    is_path: bool,
    text: fn(&Summary, Room) -> String,
    look: fn(&Theme) -> (FontId, Color32),
}

/// Width of a column.
enum Width {
    /// A share of the width left by the others; text is aligned left and elided on the right.
    Share(f32),
    /// Logical pixels in a wide and in a narrow list; text is aligned right.
    Pixels([f32; 2]),
}

/// Margin on the left, for the mark, and on the right, logical pixels.
const MARGINS: [f32; 2] = [40.0, 14.0];

/// The columns from left to right.
const COLUMNS: [Column; 5] = [
    Column {
        name: || text!("shell-part"),
        width: Width::Share(0.58),
        is_path: false,
        text: |past, _| match past.num_below {
            0 => inspection_title(past),
            num => text!(
                "history-part-again",
                part = inspection_title(past),
                count = num
            ),
        },
        look: |theme| (font::body_strong(), theme.text),
    },
    Column {
        name: || sentence(&text!("inspect-scene")),
        width: Width::Share(0.42),
        is_path: true,
        // Show a remark first: it is what most people look for.
        text: |past, _| {
            let scene = scene_title(&past.scene, past.is_simulated);
            match past.remark.as_str() {
                "" => scene,
                remark => {
                    let remark = shortened(&in_one_line(remark), MAX_REMARK);
                    format!("{remark} · {scene}")
                }
            }
        },
        look: |theme| (font::body(), theme.weak_text),
    },
    Column {
        name: || text!("history-column-score"),
        width: Width::Pixels([60.0; 2]),
        is_path: false,
        text: |past, _| {
            let score = past.score.map(|[score, _]| format!("{score:.2}"));
            score.unwrap_or_default()
        },
        look: |theme| (font::body(), theme.text),
    },
    Column {
        name: || text!("history-column-ms"),
        width: Width::Pixels([70.0, 52.0]),
        is_path: false,
        text: |past, _| format!("{:.0}", past.total_ms),
        look: |theme| (font::body(), theme.weak_text),
    },
    Column {
        name: || text!("history-column-time"),
        width: Width::Pixels([170.0, 96.0]),
        is_path: false,
        text: |past, room| match room {
            Room::Wide => local_time(past.at, DAY_AND_TIME),
            Room::Narrow => local_time(past.at, "%m-%d %H:%M"),
        },
        look: |theme| (font::body(), theme.weak_text),
    },
];

/// Positions of the columns, from the left edge of the list.
struct Layout {
    room: Room,
    spans: [[f32; 2]; COLUMNS.len()],
}

impl Layout {
    fn across(width: f32) -> Self {
        let room = if width < SHORT_DATE_WIDTH_PX {
            Room::Narrow
        } else {
            Room::Wide
        };
        let pixels = |column: &Column| match column.width {
            Width::Share(_) => 0.0,
            Width::Pixels(pixels) => pixels[usize::from(room == Room::Narrow)],
        };
        let [mut from, right] = MARGINS;
        let free = width - from - right - COLUMNS.iter().map(pixels).sum::<f32>();
        let spans = COLUMNS.each_ref().map(|column| {
            let begin = from;
            from += match column.width {
                Width::Share(share) => share * free,
                Width::Pixels(_) => pixels(column),
            };
            [begin, from]
        });
        Self { room, spans }
    }

    fn columns(&self) -> impl Iterator<Item = (&'static Column, [f32; 2])> {
        COLUMNS.iter().zip(self.spans)
    }
}

impl Column {
    /// Writes a text in a column of a row.
    fn write(
        &self,
        painter: &Painter,
        row: Rect,
        [from, to]: [f32; 2],
        text: &str,
        (font, colour): (FontId, Color32),
    ) {
        let [from, to] = [from, to].map(|x| row.left() + x);
        let y = row.center().y;
        match self.width {
            Width::Share(_) => {
                let room = to - space::SMALL - from;
                let text = if self.is_path {
                    fitted_scene(painter, text, &font, room)
                } else {
                    text.to_owned()
                };
                let mut job = LayoutJob::simple_singleline(text, font, colour);
                job.wrap = TextWrapping::truncate_at_width(room);
                let galley = painter.layout_job(job);
                let top = y - galley.size().y / 2.0;
                painter.galley(pos2(from, top), galley, colour);
            }
            Width::Pixels(_) => {
                painter.text(pos2(to, y), Align2::RIGHT_CENTER, text, font, colour);
            }
        }
    }
}

/// Fits a scene with the remark before it: folders are left out first, then the middle of the remark, down to half of the
/// room.
fn fitted_scene(painter: &Painter, text: &str, font: &FontId, room: f32) -> String {
    let text = fitted_path(painter, text, font, room);
    match text.rsplit_once(" · ") {
        Some((remark, scene)) if text_width(painter, &text, font) > room => {
            let scene = format!(" · {scene}");
            let rest = (room - text_width(painter, &scene, font)).max(room / 2.0);
            fitted_middle(painter, remark, font, rest) + &scene
        }
        _ => text,
    }
}

fn head(ui: &mut Ui, layout: &Layout) {
    let theme = Theme::of(ui);
    let size = vec2(ui.available_width(), 22.0);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    for (column, span) in layout.columns() {
        let look = (font::heading(), theme.weak_text);
        column.write(ui.painter(), rect, span, &(column.name)(), look);
    }
}

fn row(
    ui: &mut Ui,
    past: &Summary,
    selected: Option<i64>,
    layout: &Layout,
    session: &Session,
    actions: &mut Vec<HistoryAction>,
) {
    let theme = Theme::of(ui);
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), ROW_HEIGHT_PX), Sense::click());
    let is_selected = selected == Some(past.number);
    let actual = past.label.as_ref().map(|truth| {
        let unloaded = LibraryView::default();
        let library = session.library.as_deref().unwrap_or(&unloaded);
        text!(
            "shell-actual-part",
            part = truth_title(Some(truth), library)
        )
    });
    response.widget_info(|| {
        let verdict = described(&past.verdict);
        let label = text!(
            "history-row",
            count = past.num_below,
            number = past.number.abs(),
            part = inspection_title(past),
            verdict = verdict,
        );
        let mut info = egui::WidgetInfo::selected(egui::Role::Button, true, is_selected, label);
        info.current_text_value.clone_from(&actual);
        info
    });
    let scene = scene_title(&past.scene, past.is_simulated);
    let path = scene.contains(['/', '\\']).then_some(scene);
    let says = [actual, past.noted.past_doubts(Language::current()), path];
    let says: Vec<String> = says.into_iter().flatten().collect();
    let response = if says.is_empty() {
        response
    } else {
        response.on_hover_text(says.join("\n"))
    };
    if ui.is_rect_visible(rect) {
        let painter = ui.painter();
        if is_selected || response.hovered() {
            painter.rect_filled(rect, ROUNDING, theme.control);
        }
        paint(painter, rect, past, layout, theme);
        focus_ring(ui, rect, &response);
    }
    if response.clicked() {
        actions.push(HistoryAction::Select(past.number));
    }
    if response.double_clicked() {
        actions.push(HistoryAction::Open(past.number));
    }
}

fn paint(painter: &Painter, rect: Rect, past: &Summary, layout: &Layout, theme: &Theme) {
    let at = pos2(rect.left() + 20.0, rect.center().y);
    mark(painter, at, 9.0, past_mark(past), theme);
    // A person has said what really hung there.
    if past.label.is_some() {
        let edge = Stroke::new(1.5, theme.canvas);
        painter.circle(at + vec2(8.0, 7.0), 4.5, theme.accent, edge);
    }
    let serial = &past.trace.serial;
    for (index, (column, span)) in layout.columns().enumerate() {
        let mut line = rect;
        if index == 0 && !serial.is_empty() {
            // Below the part, where there is room for the 17 letters of a vehicle's number.
            let below;
            (line, below) = rect.split_top_bottom_at_fraction(0.5);
            let [from, to] = span;
            let font = font::small();
            let serial = fitted_middle(painter, serial, &font, to - space::SMALL - from);
            column.write(painter, below, span, &serial, (font, theme.weak_text));
        }
        let text = (column.text)(past, layout.room);
        column.write(painter, line, span, &text, (column.look)(theme));
    }
}

/// Format of day and time of day.
pub(super) const DAY_AND_TIME: &str = "%Y-%m-%d %H:%M:%S";

/// Formats a time in the local time zone.
pub(super) fn local_time(at: Timestamp, format: &str) -> String {
    let here = at.to_zoned(TimeZone::system());
    here.strftime(format).to_string()
}

#[cfg(test)]
mod tests {
    use egui::{RawInput, Shape};

    use super::*;
    use inspection::library::Truth;
    use records::fixtures::history_entry;
    use records::history::{SceneTitle, StoredVerdict};

    /// What is drawn of a row of a narrow list, in this theme.
    fn drawn(past: &Summary) -> (Vec<Shape>, Theme) {
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        let mut theme = None;
        let output = ctx.run_ui(RawInput::default(), |ui| {
            let rect = Rect::from_min_size(pos2(0.0, 0.0), vec2(600.0, ROW_HEIGHT_PX));
            theme = Some(Theme::of(ui));
            let layout = Layout::across(600.0);
            paint(ui.painter(), rect, past, &layout, Theme::of(ui));
        });
        let shapes = output.shapes.iter().map(|drawn| drawn.shape.clone());
        let shapes = shapes.collect();
        output.drop_without_applying_deltas();
        (shapes, theme.expect("drawn").clone())
    }

    /// The texts of a row of a narrow list that are not cut off.
    fn written(past: &Summary) -> Vec<String> {
        let written = drawn(past).0.into_iter().filter_map(|shape| match shape {
            Shape::Text(text) if !text.galley.elided => Some(text.galley.text().to_owned()),
            _ => None,
        });
        written.collect()
    }

    fn accepted() -> Summary {
        let entry = history_entry(1, StoredVerdict::Accepted, "front_door");
        entry.record.summary
    }

    #[test]
    fn only_an_accepted_part_without_doubts_has_a_green_mark() {
        let mark = |past: &Summary| {
            let (shapes, theme) = drawn(past);
            let disc = shapes.iter().find_map(|shape| match shape {
                Shape::Circle(disc) => Some(disc.fill),
                _ => None,
            });
            (disc.expect("a mark"), theme)
        };
        let mut past = accepted();
        let (fill, theme) = mark(&past);
        assert_eq!(fill, theme.accepted);
        past.noted.robot_doubts = vec!["ambiguous_pose".into()];
        assert_eq!(mark(&past).0, theme.warning);
        past.label = Some(Truth::NotEnrolled);
        assert_eq!(mark(&past).0, theme.rejected);
    }

    #[test]
    fn a_serial_number_is_readable_to_its_end_in_a_narrow_list() {
        let texts = |serial: &str| {
            let mut past = accepted();
            past.trace.serial = serial.into();
            written(&past)
        };
        let vehicle = "WVWZZZ1JZXW000017";
        let written = texts(vehicle);
        assert!(written.iter().any(|text| text == vehicle), "{written:?}");
        let written = texts(&format!("{vehicle}/{vehicle}/{vehicle}"));
        let is_cut = |text: &String| text.contains('…') && text.ends_with("000017");
        assert!(written.iter().any(is_cut), "{written:?}");
    }

    #[test]
    fn a_remark_of_any_length_leaves_room_for_the_scene_and_has_no_line_breaks() {
        let texts = |remark: &str| {
            let past = Summary {
                scene: SceneTitle::Named("a.pcd".into()),
                is_simulated: false,
                remark: remark.into(),
                ..accepted()
            };
            written(&past)
        };
        let written = texts("a\nb");
        assert!(
            written.iter().any(|text| text == "a b · a.pcd"),
            "{written:?}"
        );
        let written = texts(&"the hook was in front of it ".repeat(200));
        let is_cut = |text: &String| text.starts_with("the") && text.ends_with(" · a.pcd");
        assert!(written.iter().any(is_cut), "{written:?}");
    }
}
