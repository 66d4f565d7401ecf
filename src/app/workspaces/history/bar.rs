//! Above the list: what it shows, and what can be done with it.

use egui::{Align, Button, Layout, RichText, ScrollArea, TextEdit, Ui, WidgetInfo, vec2};

use super::{
    HistoryAction, HistoryFile, HistoryState,
    filter::{DateRange, ListFilter, day_of},
};
use crate::{
    app::{
        shell::session::Session,
        ui::{
            theme::{Theme, space},
            widgets::{labelled, shortened},
        },
    },
    history::StoredVerdict,
};

/// Draws the bar.
pub(super) fn ui(
    ui: &mut Ui,
    history: &HistoryState,
    session: &Session,
    theme: &Theme,
    actions: &mut Vec<HistoryAction>,
) {
    let known = &history.filter;
    let mut filter = known.clone();
    ui.horizontal_wrapped(|ui| {
        find(ui, &mut filter);
        days(ui, &mut filter);
        verdicts(ui, &mut filter);
        parts(ui, session, &mut filter);
        if *known != ListFilter::default()
            && labelled(ui, Button::new("Show all"), "Show all").clicked()
        {
            filter = ListFilter::default();
        }
    });
    if filter.days == DateRange::Typed {
        ui.horizontal(|ui| typed(ui, &mut filter, theme));
    }
    ui.horizontal(|ui| {
        let counted = format!("{} of {} parts", history.num_matching(), history.num_rows());
        ui.label(RichText::new(&counted).color(theme.weak_text))
            .widget_info(|| WidgetInfo::labeled(egui::Role::Label, true, &counted));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            action_buttons(ui, history, actions);
        });
    });
    if filter != *known {
        actions.push(HistoryAction::Filter(filter));
    }
}

fn action_buttons(ui: &mut Ui, history: &HistoryState, actions: &mut Vec<HistoryAction>) {
    let ways = [
        (
            "Export CSV…",
            "Write the listed inspections to a table",
            HistoryFile::Csv,
        ),
        (
            "Export cases…",
            "Save the listed inspections that have a frame and an actual part as cases, for Compare and partsight evaluate",
            HistoryFile::Cases,
        ),
    ];
    for (label, says, file) in ways {
        if labelled(ui, Button::new(label), label)
            .on_hover_text(says)
            .clicked()
        {
            actions.push(HistoryAction::Ask(file));
        }
    }
    let is_shown = history.statistics.is_open();
    let button = Button::selectable(is_shown, "Statistics").frame_when_inactive(true);
    let shown = labelled(ui, button, "Statistics");
    shown.widget_info(|| WidgetInfo::selected(egui::Role::Button, true, is_shown, "Statistics"));
    let says = "OK and NOK by shift, by part and by reason, of what is listed";
    if shown.on_hover_text(says).clicked() {
        actions.push(HistoryAction::Statistics(!is_shown));
    }
    let frames = labelled(ui, Button::new("Frames…"), "Frames…");
    if frames
        .on_hover_text("Which frames are kept, and how long")
        .clicked()
    {
        let rule = history.kept.0;
        actions.push(HistoryAction::Rule(Some(rule)));
    }
}

fn find(ui: &mut Ui, filter: &mut ListFilter) {
    let field = TextEdit::singleline(&mut filter.text)
        .hint_text("Part, scene or remark")
        .desired_width(170.0)
        .min_size(vec2(170.0, space::TARGET))
        .align(egui::Align2::LEFT_CENTER);
    ui.add(field)
        .widget_info(|| WidgetInfo::labeled(egui::Role::TextInput, true, "Find"));
}

/// A menu in which one of some is chosen; `label` tells it from other menus with the same choices.
fn menu<T: PartialEq + Clone>(
    ui: &mut Ui,
    label: &str,
    chosen: &mut T,
    choices: impl Iterator<Item = (T, String)>,
) {
    let choices: Vec<_> = choices.collect();
    let now = choices.iter().find(|(choice, _)| choice == chosen);
    let now = now.map_or("", |(_, title)| title);
    let title = format!("{label} · {} ▼", shortened(now, 20));
    ui.menu_button(&title, |ui| {
        ui.set_min_width(160.0);
        ScrollArea::vertical().max_height(420.0).show(ui, |ui| {
            for (choice, title) in choices {
                let response = ui.selectable_label(*chosen == choice, &title);
                response.widget_info(|| {
                    let label = format!("{label}: {title}");
                    WidgetInfo::labeled(egui::Role::Button, true, label)
                });
                if response.clicked() {
                    *chosen = choice;
                    ui.close();
                }
            }
        });
    });
}

fn days(ui: &mut Ui, filter: &mut ListFilter) {
    let choices = DateRange::ALL.map(|days| (days, days.title().to_owned()));
    menu(ui, "Days", &mut filter.days, choices.into_iter());
}

fn verdicts(ui: &mut Ui, filter: &mut ListFilter) {
    let all = std::iter::once((None, "All".to_owned()));
    let each = StoredVerdict::ALL.map(|verdict| (Some(verdict), verdict.title().to_owned()));
    menu(ui, "Verdict", &mut filter.verdict, all.chain(each));
}

fn parts(ui: &mut Ui, session: &Session, filter: &mut ListFilter) {
    let enrolled = session.library.iter().flat_map(|library| &library.parts);
    let enrolled = enrolled.map(|part| {
        let name = part.name.as_str().to_owned();
        (Some(name), part.shown_title().to_owned())
    });
    let all = std::iter::once((None, "All".to_owned()));
    menu(ui, "Part", &mut filter.part, all.chain(enrolled));
}

/// The first and the last day, as a person types them.
fn typed(ui: &mut Ui, filter: &mut ListFilter, theme: &Theme) {
    let fields = [("from", "First day"), ("to", "Last day")];
    for (text, (word, label)) in filter.typed.iter_mut().zip(fields) {
        ui.label(RichText::new(word).color(theme.weak_text));
        let field = TextEdit::singleline(text)
            .hint_text("2026-11-20")
            .desired_width(110.0)
            .min_size(vec2(110.0, space::TARGET))
            .align(egui::Align2::LEFT_CENTER);
        ui.add(field)
            .widget_info(|| WidgetInfo::labeled(egui::Role::TextInput, true, label));
    }
    if filter.typed.iter().any(|text| day_of(text).is_err()) {
        let text = "Write a day as year-month-day: 2026-11-20";
        ui.label(RichText::new(text).color(theme.warning));
    }
}
