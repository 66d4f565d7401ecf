//! The recipe on trial: a control for every parameter of the table, and the verdict on the case in front.

use egui::{Button, Color32, Panel, RichText, ScrollArea, Ui, WidgetInfo, vec2};

use super::{CompareAction, CompareState, case_bar, recipe_menu, scaling_plot};
use crate::shared::panel_frame;
use inspection::pipeline::{
    Recipe,
    parameters::{Group, PARAMETERS, Parameter, Place},
};
use records::{cases::CaseOutcome, history::StoredVerdict};
use shell::session::Session;
use ui::{
    language::{described, parameters, text, within_sentence},
    parameter_control::{self, ParameterChange, fold},
    theme::{Theme, font, space},
    widgets::{line_mark, sentence},
};

pub(super) fn ui(
    ui: &mut Ui,
    compare: &CompareState,
    session: &Session,
    acts: &mut Vec<CompareAction>,
) {
    let theme = Theme::of(ui);
    let frame = |top, bottom| panel_frame(theme, top, bottom);
    Panel::bottom("recipe verdict")
        .resizable(false)
        .frame(frame(8, 12))
        .show(ui, |ui| outcome(ui, compare, session, acts));
    let (recipe, default) = (compare.tried_recipe(session), Recipe::default());
    Panel::top("recipe head")
        .resizable(false)
        .frame(frame(8, 4))
        .show(ui, |ui| recipe_menu::ui(ui, compare, session, acts));
    egui::CentralPanel::default()
        .frame(frame(0, 4))
        .show(ui, |ui| {
            ScrollArea::vertical()
                .id_salt("recipe")
                .auto_shrink(false)
                .show(ui, |ui| {
                    ui.set_max_width(ui.available_width() - 8.0);
                    for group in Group::ALL {
                        group_ui(ui, group, recipe, &default, acts);
                    }
                    ui.add_space(space::SMALL);
                    fold(ui, text!("compare-scaling"), Color32::PLACEHOLDER)
                        .id_salt("scaling")
                        .show(ui, |ui| scaling_plot::ui(ui, compare, acts));
                });
        });
}

fn group_ui(
    ui: &mut Ui,
    group: Group,
    recipe: &Recipe,
    default: &Recipe,
    acts: &mut Vec<CompareAction>,
) {
    let theme = Theme::of(ui);
    let of = |place: Place| {
        let all = PARAMETERS.iter();
        all.filter(move |p| p.group == group && p.place == place)
    };
    let num = of(Place::Fold).count();
    if num + of(Place::Front).count() == 0 {
        return;
    }
    ui.add_space(space::SMALL);
    ui.label(
        RichText::new(parameters::group(group))
            .font(font::heading())
            .weak(),
    );
    for parameter in of(Place::Front) {
        control(ui, parameter, recipe, default, acts);
    }
    if num == 0 {
        return;
    }
    let num_changed = of(Place::Fold)
        .filter(|p| p.differs(recipe, default))
        .count();
    let name = within_sentence(&parameters::group(group));
    let title = match num_changed {
        0 => text!("shell-more", group = name, count = num),
        _ => text!(
            "compare-more-changed",
            group = name,
            count = num,
            changed = num_changed
        ),
    };
    fold(ui, title, theme.weak_text)
        .id_salt(group.title())
        .show_unindented(ui, |ui| {
            for parameter in of(Place::Fold) {
                control(ui, parameter, recipe, default, acts);
            }
        });
}

fn control(
    ui: &mut Ui,
    parameter: &Parameter,
    recipe: &Recipe,
    default: &Recipe,
    acts: &mut Vec<CompareAction>,
) {
    let mut changed = |change: ParameterChange| {
        acts.push(match change {
            ParameterChange::Set(value) => CompareAction::Set(parameter.key, value),
            ParameterChange::Reset => CompareAction::Reset(parameter.key),
        });
    };
    parameter_control::control(ui, parameter, recipe, default, &mut changed);
}

/// Draws the verdict on the case in front, and the button that uses the recipe.
fn outcome(ui: &mut Ui, compare: &CompareState, session: &Session, acts: &mut Vec<CompareAction>) {
    let theme = Theme::of(ui);
    ui.scope(|ui| {
        ui.spacing_mut().interact_size.y = 0.0;
        let head = if compare.is_study_old() {
            text!("compare-case-is-pending")
        } else {
            text!("compare-case-is")
        };
        if compare.study.is_some() || compare.is_study_pending() {
            ui.weak(head);
        }
        if compare.is_study_old() {
            ui.multiply_opacity(0.55);
        }
        if let Some(study) = &compare.study {
            let found = &study.found;
            let title = match (&found.part, found.score) {
                (Some(_), Some(score)) if found.accepted => {
                    format!("{} · {score:.2}", study.found_title)
                }
                (Some(_), Some(score)) => {
                    let score = format!("{score:.2}");
                    text!(
                        "compare-verdict-nearest",
                        part = &study.found_title,
                        score = score
                    )
                }
                _ => text!("compare-verdict-nothing"),
            };
            let judgement = case_bar::judged(compare);
            let sign = case_bar::sign(study, judgement);
            ui.horizontal_top(|ui| {
                line_mark(ui, 20.0, 9.0, sign);
                let text = RichText::new(title).font(font::verdict());
                let text = text.color(sign.colour(theme));
                ui.add(egui::Label::new(text).wrap());
            });
            let (word, colour) = match (judgement, found.accepted) {
                (Some(CaseOutcome::Right), true) => {
                    (text!("compare-right-accepted"), theme.accepted)
                }
                (Some(CaseOutcome::Right), false) => {
                    (text!("compare-rightly-refused"), theme.accepted)
                }
                (Some(wrong @ CaseOutcome::WrongAccepted), _) => {
                    (sentence(&described(&wrong)), theme.rejected)
                }
                (Some(CaseOutcome::Refused), _) => {
                    (sentence(&text!("compare-cell-refused")), theme.warning)
                }
                (None, true) => (described(&StoredVerdict::Accepted), theme.text),
                (None, false) => (text!("compare-truth-not-set"), theme.text),
            };
            let word = format!("{word} · {:.0} ms", study.time_ms);
            ui.label(RichText::new(word).color(colour));
            if let Some([what, advice]) = study.complaint(session.units) {
                ui.label(RichText::new(what).small()).on_hover_text(advice);
            }
        }
    });
    ui.add_space(space::SMALL);
    let can_use = compare.tried.is_some();
    let label = text!("compare-use");
    let text = RichText::new(&label).font(font::body_strong());
    let width = ui.available_width();
    let button = if can_use {
        Button::new(text.color(theme.on_accent)).fill(theme.accent)
    } else {
        Button::new(text)
    };
    let button = button.min_size(vec2(width, space::TARGET));
    let response = ui
        .vertical_centered(|ui| ui.add_enabled(can_use, button))
        .inner;
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, can_use, &label));
    let response = response
        .on_hover_text(text!("compare-use-hint"))
        .on_disabled_hover_text(text!("compare-in-use-hint"));
    if response.clicked() {
        acts.push(CompareAction::Use);
    }
}
