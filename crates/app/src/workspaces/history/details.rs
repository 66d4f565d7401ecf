//! The selected inspection: its verdict, its picture, its differences from another inspection of the part, the fields for its true
//! label and for a remark, and what can be done with it.

use std::sync::Arc;

use egui::{Button, Grid, Label, RichText, ScrollArea, Sense, TextureHandle, Ui, WidgetInfo, vec2};

use crate::{
    shared::{truth_entries, truth_title},
    workspaces::history::{
        HistoryAction, HistoryState, OpenedInspection,
        list::{DAY_AND_TIME, local_time},
    },
};
use inspection::{
    library::Truth,
    pipeline::{Recipe, parameters::Parameter},
};
use records::history::{
    Differences, InspectionDetail, InspectionSummary, Record, StoredVerdict, Summary,
};
use shell::{
    inspection::library_cache::LibraryView,
    language::{
        UnitSystem, accepted_or_not, inspection_title, recipe_label, refusal_kind, scene_title,
        source_title,
    },
    session::{Session, past_mark},
};
use ui::{
    language::{Language, advised, described, keys, parameters, text},
    theme::{Theme, font, space},
    widgets::{
        fitted, heading, labelled, line_edit, line_mark, menu_button, path_row, row, sentence,
        shortened, texture,
    },
};

/// State of the details kept between frames.
#[derive(Default)]
pub(super) struct Details {
    /// Picture of an inspection; true if it is the large one of an inspection kept whole in memory.
    picture: Option<(i64, bool, TextureHandle)>,
    pub(super) remark: Remark,
    /// Number of the part's inspection that was drawn last.
    drawn: Option<i64>,
}

impl Details {
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        history: &HistoryState,
        session: &Session,
        actions: &mut Vec<HistoryAction>,
    ) {
        let Some(past) = &history.record else {
            ui.weak(text!("history-choose"));
            return;
        };
        self.make(ui, history, past);
        let record = &past.record;
        // Remark and label belong to the inspection that stands for the part.
        let of_part = past.part.first().unwrap_or(record);
        let number = of_part.summary.number;
        let mut area = ScrollArea::vertical().auto_shrink(false);
        // Another part starts at the top; other inspections of the same part keep the place.
        if self.drawn.replace(number) != Some(number) {
            area = area.vertical_scroll_offset(0.0);
        }
        // The bar is beside the figures, not over them.
        ui.spacing_mut().scroll.floating_allocated_width = space::SMALL;
        area.show(ui, |ui| {
            verdict(ui, record, of_part, session);
            let is_edited = self.remark.ui(ui, &of_part.summary, session, actions);
            // The next inspection must not take the place of one that is being edited.
            if is_edited && !history.is_chosen() {
                actions.push(HistoryAction::Select(record.summary.number));
            }
            self.picture(ui, record);
            ui.add_space(space::MEDIUM);
            buttons(ui, history, record, actions);
            let differences = history.differences.as_ref();
            let number = record.summary.number;
            if let Some((_, found)) = differences.filter(|(of, _)| *of == number) {
                differences_today(ui, found, session.units);
            }
            part(ui, past, session.units, actions);
            let title = text!("history-inspection", number = number.abs());
            heading(ui, &title);
            ui.scope(|ui| {
                // Lines of text need less height than controls.
                ui.spacing_mut().interact_size.y = 22.0;
                figures(ui, record);
                pose(ui, record, session.units);
                times(ui, record);
            });
        });
    }

    /// Uploads a new picture.
    fn make(&mut self, ui: &Ui, history: &HistoryState, past: &Arc<OpenedInspection>) {
        let number = past.record.summary.number;
        let whole = history.whole(number);
        let large = whole.and_then(|whole| whole.figures.segmentation.as_ref());
        let key = (number, large.is_some());
        let made = self.picture.as_ref();
        if made.is_some_and(|(of, is_large, _)| (*of, *is_large) == key) {
            return;
        }
        let image = large.or(past.picture.as_ref());
        let made = texture(ui.ctx(), "past inspection", image);
        self.picture = made.map(|made| (number, large.is_some(), made));
    }

    fn picture(&self, ui: &mut Ui, record: &Record) {
        let number = record.summary.number;
        let made = self.picture.as_ref().filter(|(of, ..)| *of == number);
        let Some((_, _, texture)) = made else {
            let text = text!("history-no-picture");
            ui.label(RichText::new(text).small().weak());
            return;
        };
        ui.add_space(space::MEDIUM);
        let width = ui.available_width();
        let size = vec2(width, width * 0.75);
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        response.widget_info(|| {
            let label = text!("history-picture", number = number.abs());
            egui::WidgetInfo::labeled(egui::Role::Image, true, label)
        });
        let place = fitted(rect, texture.aspect_ratio());
        egui::Image::new(texture).paint_at(ui, place);
    }
}

fn verdict(ui: &mut Ui, record: &Record, of_part: &Record, session: &Session) {
    let theme = Theme::of(ui);
    let summary = Summary {
        label: of_part.summary.label.clone(),
        ..record.summary.clone()
    };
    let summary = &summary;
    let title = RichText::new(inspection_title(summary)).font(font::title());
    ui.label(title);
    // The title of an empty cell says all.
    if summary.verdict != StoredVerdict::NoPart {
        let sign = past_mark(summary);
        ui.horizontal(|ui| {
            line_mark(ui, 20.0, 9.0, sign);
            let word = if summary.is_wrongly_accepted() {
                text!("operator-reported-wrong")
            } else {
                accepted_or_not(summary.is_ok())
            };
            let word = RichText::new(word).font(font::verdict());
            ui.label(word.color(sign.colour(theme)));
        });
    }
    if summary.is_simulated {
        ui.colored_label(
            Theme::of(ui).warning,
            sentence(&text!("enrol-origin-simulated")),
        );
    }
    let title_of = |name: &str| match &session.library {
        Some(library) => library.title_of(name).to_owned(),
        None => name.to_owned(),
    };
    if let Some(why) = record.titled_refusal(title_of) {
        ui.label(sentence(&described(&why)));
        let advice = RichText::new(advised(&why)).font(font::body_strong());
        ui.label(advice.color(Theme::of(ui).warning));
    } else if let Some(kind) = &summary.reason {
        ui.label(refusal_kind(kind));
    }
    if let Some(doubts) = summary.noted.past_doubts(Language::current()) {
        ui.colored_label(theme.warning, doubts);
    }
    if summary.noted.motion_checked == Some(false) {
        ui.weak(text!("robot-motion-unknown"));
    }
}

/// Draws the inspections of the part if there are several, and the differences between the one that stands for the part
/// and the selected one (the last, if the selected one stands for the part).
fn part(ui: &mut Ui, past: &OpenedInspection, units: UnitSystem, actions: &mut Vec<HistoryAction>) {
    let theme = Theme::of(ui);
    let (Some(head), Some(last)) = (past.part.first(), past.part.last()) else {
        return;
    };
    heading(ui, &text!("history-of-part"));
    let number = past.record.summary.number;
    for record in &past.part {
        let row = &record.summary;
        let word = described(&row.verdict);
        let counts = if row.number == head.summary.number {
            format!(" · {}", text!("history-counts"))
        } else {
            String::new()
        };
        let text = format!(
            "{} · {word} · {}{counts}",
            row.number.abs(),
            local_time(row.at, "%H:%M:%S")
        );
        let button = Button::selectable(row.number == number, text)
            .frame_when_inactive(true)
            .min_size(vec2(ui.available_width(), space::TARGET));
        let number = row.number.abs();
        let label = text!("history-of-this-part", number = number, verdict = word) + &counts;
        if labelled(ui, button, &label).clicked() {
            actions.push(HistoryAction::Select(row.number));
        }
    }
    let other = if number == head.summary.number {
        last
    } else {
        &past.record
    };
    let found = Differences::between(head.into(), other.into(), None);
    let names = [head, other].map(|record| record.summary.number.abs().to_string());
    let is_same = found.has_same_result();
    let sentence = if is_same {
        text!("history-found-same", number = &names[1])
    } else {
        text!("history-found-other", number = &names[1])
    };
    let names = [&*names[0], &*names[1]];
    table(ui, &found, (&sentence, is_same), names, units, theme);
}

fn figures(ui: &mut Ui, record: &Record) {
    let Record { summary, detail } = record;
    let (source, is_simulated) = (&summary.source, summary.is_simulated);
    let scene = scene_title(&summary.scene, is_simulated);
    path_row(ui, &text!("inspect-scene"), &scene);
    if *source != summary.scene.to_string() {
        let source = source_title(source, is_simulated);
        path_row(ui, &text!("history-figure-source"), &source);
    }
    let mut row = |name: String, value: &str| row(ui, &name, &shortened(value, 32));
    let time = local_time(summary.at, DAY_AND_TIME);
    row(text!("history-figure-time"), &time);
    let trace = &summary.trace;
    for (name, text) in [
        (text!("history-figure-serial"), &trace.serial),
        (text!("inspect-order"), &trace.order),
        (text!("inspect-operator"), &trace.operator),
    ] {
        if !text.is_empty() {
            row(name, text);
        }
    }
    if let Some([score, margin]) = summary.score {
        row(text!("history-figure-score"), &format!("{score:.2}"));
        row(text!("history-figure-margin"), &format!("{margin:.2}"));
    }
    row(text!("inspect-recipe"), &recipe_text(detail));
    row(text!("history-figure-library"), &detail.library_identity);
    row(text!("history-figure-program"), &detail.program);
    let frame = match (summary.frame_bytes, &detail.frame_loss) {
        (Some(bytes), _) => {
            let megabytes = format!("{:.1}", bytes as f64 / 1e6);
            text!("history-frame-kept", megabytes = megabytes)
        }
        (None, Some(why)) => text!("history-frame-lost", why = described(why)),
        (None, None) => text!("history-frame-not-kept"),
    };
    row(text!("history-figure-frame"), &frame);
}

fn pose(ui: &mut Ui, record: &Record, units: UnitSystem) {
    let Some(pose) = &record.detail.camera_from_part else {
        return;
    };
    heading(ui, "camera_from_part");
    let shift = pose.translation.vector;
    let (rx, ry, rz) = pose.rotation.euler_angles();
    for (name, metres) in ["x", "y", "z"].into_iter().zip(shift.iter()) {
        row(ui, name, &units.signed_length(*metres));
    }
    let last = text!("history-rz");
    for (name, radians) in [("rx", rx), ("ry", ry), (last.as_str(), rz)] {
        row(ui, name, &units.signed_angle(radians));
    }
}

fn times(ui: &mut Ui, record: &Record) {
    let times = record.timings();
    if times.is_empty() {
        return;
    }
    heading(ui, &text!("history-times"));
    for (stage, ms) in times {
        row(ui, &stage_title(stage), &format!("{ms:.1} ms"));
    }
}

/// Title of a stage of the report.
fn stage_title(stage: String) -> String {
    match stage.as_str() {
        "segment" => text!("history-stage-segment"),
        "project" => text!("history-stage-project"),
        "contour" => text!("history-stage-contour"),
        "signature" => text!("history-stage-signature"),
        "rank" => text!("history-stage-rank"),
        "pose" => text!("history-stage-pose"),
        "total" => text!("history-stage-total"),
        _ => stage,
    }
}

/// Name of the recipe and its identity.
fn recipe_text(detail: &InspectionDetail) -> String {
    format!(
        "{}, {}",
        recipe_label(&detail.recipe_label),
        detail.recipe_identity
    )
}

fn buttons(ui: &mut Ui, history: &HistoryState, record: &Record, actions: &mut Vec<HistoryAction>) {
    let theme = Theme::of(ui);
    let number = record.summary.number;
    let no_frame = history
        .why_no_scene(record)
        .map(|[what, advice]| format!("{what}. {advice}"));
    ui.horizontal(|ui| {
        let label = text!("history-open");
        let open = RichText::new(&label).font(font::body_strong());
        let key = RichText::new(keys("Enter")).small();
        let open = Button::new(open.color(theme.on_accent))
            .shortcut_text(key.color(theme.on_accent))
            .fill(theme.accent);
        let mut press = |button, label: &str, says: String| {
            let can = no_frame.is_none();
            let pressed = ui
                .add_enabled_ui(can, |ui| labelled(ui, button, label))
                .inner;
            // `labelled` describes every button as enabled.
            pressed.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, can, label));
            pressed.on_hover_text(says).clicked()
        };
        if press(open, &label, text!("history-open-hint")) {
            actions.push(HistoryAction::Open(number));
        }
        let key = RichText::new("A").small();
        let label = text!("history-again");
        let again = Button::new(&label).shortcut_text(key.weak());
        if press(again, &label, text!("history-again-hint")) {
            actions.push(HistoryAction::InspectAgain(number));
        }
    });
    // Not as a hover text: a touch screen has none.
    if let Some(why) = no_frame {
        ui.label(RichText::new(why).small().weak());
    }
}

/// Gap between two columns, logical pixels.
const GAP: f32 = 10.0;

/// Text of a finding in a row of the table.
type FindingText<'a> = &'a dyn Fn(&InspectionSummary) -> String;

/// Draws the differences from another inspection of the same scene made today.
fn differences_today(ui: &mut Ui, found: &Differences, units: UnitSystem) {
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

/// The remark and the true label being edited.
#[derive(Default)]
pub(super) struct Remark {
    /// The inspection, its stored remark, and the text being edited.
    draft: Option<(i64, String, String)>,
    /// The inspection for which the menu of true labels was opened, while it is open.
    labelled: Option<i64>,
}

impl Remark {
    /// Draws both; returns true while the remark or the label is being edited.
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        row: &Summary,
        session: &Session,
        actions: &mut Vec<HistoryAction>,
    ) -> bool {
        heading(ui, &text!("history-actual-part"));
        let is_labelled = truth_menu(ui, row, &mut self.labelled, session, actions);
        heading(ui, &text!("history-remark"));
        // Start anew for another inspection, or if the stored remark was changed elsewhere.
        let is_of_it = self
            .draft
            .as_ref()
            .is_some_and(|(number, known, _)| *number == row.number && *known == row.remark);
        if !is_of_it {
            if let Some((number, remark)) = self.take_edited(Some(row.number)) {
                actions.push(HistoryAction::Remark(number, remark));
            }
            self.draft = Some((row.number, row.remark.clone(), in_one_line(&row.remark)));
        }
        let Some((_, known, text)) = &mut self.draft else {
            return is_labelled;
        };
        let field = line_edit(text, text!("shell-notes-hint"), f32::INFINITY);
        let response = ui.add(field);
        let label = text!("history-your-remark");
        response.widget_info(|| WidgetInfo::labeled(egui::Role::TextInput, true, &label));
        if response.lost_focus() && is_edited(text, known) {
            // Until the stored remark comes back.
            known.clone_from(text);
            let remark = text.trim().to_owned();
            actions.push(HistoryAction::Remark(row.number, remark));
        }
        is_labelled || response.has_focus()
    }

    /// Takes a remark that was edited before another inspection came to the front or the window closes.
    pub(super) fn take_edited(&mut self, front: Option<i64>) -> Option<(i64, String)> {
        let (number, known, text) = self.draft.take()?;
        let is_edited = Some(number) != front && is_edited(&text, &known);
        is_edited.then(|| (number, text.trim().to_owned()))
    }
}

/// True if the text in the field is no longer that of the stored remark.
fn is_edited(text: &str, known: &str) -> bool {
    text.trim() != in_one_line(known).trim()
}

/// Returns a remark without line breaks, which commands may store: in one line they are drawn as boxes.
pub(super) fn in_one_line(remark: &str) -> String {
    remark.replace(char::is_control, " ")
}

/// Draws the menu of true labels; returns true while it is open. What is chosen in it is the label of the inspection for
/// which it was opened.
fn truth_menu(
    ui: &mut Ui,
    row: &Summary,
    labelled: &mut Option<i64>,
    session: &Session,
    actions: &mut Vec<HistoryAction>,
) -> bool {
    let number = labelled.unwrap_or(row.number);
    let unloaded = LibraryView::default();
    let library = session.library.as_deref().unwrap_or(&unloaded);
    let chosen = row.label.as_ref();
    let title = shortened(&truth_title(chosen, library), 24);
    let title = format!("{} · {title} ▼", text!("history-actual-part"));
    let menu = menu_button(ui, &title, |ui| {
        let first = [None, Some(Truth::NotEnrolled), Some(Truth::Nothing)];
        truth_entries(ui, chosen, &first, library, |truth| {
            actions.push(HistoryAction::Label(number, truth));
        });
    });
    let is_open = menu.inner.is_some();
    *labelled = is_open.then_some(number);
    is_open || menu.response.clicked()
}
