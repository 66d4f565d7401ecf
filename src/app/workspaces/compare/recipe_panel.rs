//! The recipe on trial: a control for every parameter, drawn from the table, and what comes of it.

use std::cell::Cell;

use egui::{
    Button, CollapsingHeader, Color32, DragValue, Frame, Margin, Panel, RichText, ScrollArea,
    Sense, Slider, TextStyle, Ui, Vec2, WidgetInfo, vec2,
};

use super::{CompareAction, CompareState, case_bar::judged, recipe_menu, scaling_plot};
use crate::{
    app::{
        language::{parameters, text, within_sentence},
        shell::session::Session,
        ui::{
            theme::{Theme, font, space},
            widgets::{Mark, labelled, mark},
        },
    },
    cases::CaseOutcome,
    pipeline::{
        Recipe,
        parameters::{Group, Kind, Number, PARAMETERS, Parameter, Place},
    },
};

/// Draws the panel.
pub(super) fn ui(
    ui: &mut Ui,
    compare: &CompareState,
    session: &Session,
    theme: &Theme,
    acts: &mut Vec<CompareAction>,
) {
    let frame = |top, bottom| {
        Frame::new().fill(theme.panel).inner_margin(Margin {
            left: 16,
            right: 14,
            top,
            bottom,
        })
    };
    Panel::bottom("recipe verdict")
        .resizable(false)
        .frame(frame(8, 12))
        .show(ui, |ui| outcome(ui, compare, session, theme, acts));
    let (recipe, default) = (compare.tried_recipe(session), Recipe::default());
    Panel::top("recipe head")
        .resizable(false)
        .frame(frame(8, 4))
        .show(ui, |ui| recipe_menu::ui(ui, compare, session, theme, acts));
    egui::CentralPanel::default()
        .frame(frame(0, 4))
        .show(ui, |ui| {
            ScrollArea::vertical()
                .id_salt("recipe")
                .auto_shrink(false)
                .show(ui, |ui| {
                    ui.set_max_width(ui.available_width() - 8.0);
                    for group in Group::ALL {
                        group_ui(ui, group, recipe, &default, theme, acts);
                    }
                    ui.add_space(space::SMALL);
                    fold(ui, text!("compare-scaling"), Color32::PLACEHOLDER)
                        .id_salt("scaling")
                        .show(ui, |ui| scaling_plot::ui(ui, compare, theme, acts));
                });
        });
}

fn group_ui(
    ui: &mut Ui,
    group: Group,
    recipe: &Recipe,
    default: &Recipe,
    theme: &Theme,
    acts: &mut Vec<CompareAction>,
) {
    let of = |place: Place| {
        let all = PARAMETERS.iter();
        all.filter(move |p| p.group == group && p.place == place)
    };
    ui.add_space(space::SMALL);
    ui.label(
        RichText::new(parameters::group(group))
            .font(font::heading())
            .color(theme.weak_text),
    );
    for parameter in of(Place::Front) {
        control(ui, parameter, recipe, default, theme, acts);
    }
    let num = of(Place::Fold).count();
    if num == 0 {
        return;
    }
    let num_changed = of(Place::Fold)
        .filter(|p| p.differs(recipe, default))
        .count();
    let name = within_sentence(&parameters::group(group));
    let title = match num_changed {
        0 => text!("compare-more", group = name, count = num),
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
                control(ui, parameter, recipe, default, theme, acts);
            }
        });
}

/// A fold whose title has more than one line where the panel is too narrow.
fn fold(ui: &Ui, title: String, colour: Color32) -> CollapsingHeader {
    let font = TextStyle::Button.resolve(ui.style());
    let spacing = ui.spacing();
    let width = ui.available_width() - spacing.indent - 2.0 * spacing.button_padding.x;
    CollapsingHeader::new(ui.painter().layout(title, font, colour, width))
}

/// Width of the number beside a slider.
const NUMBER: f32 = 92.0;
/// Least width of the button that resets a parameter.
const RESET: f32 = 58.0;

fn control(
    ui: &mut Ui,
    parameter: &Parameter,
    recipe: &Recipe,
    default: &Recipe,
    theme: &Theme,
    acts: &mut Vec<CompareAction>,
) {
    let is_changed = parameter.differs(recipe, default);
    let title = parameters::name(parameter);
    let name = if is_changed {
        let name = text!("compare-parameter-changed", parameter = &title);
        RichText::new(name).color(theme.accent)
    } else {
        RichText::new(&title).color(theme.text)
    };
    let hover = hover_text(parameter, default);
    ui.scope(|ui| {
        ui.spacing_mut().interact_size.y = 0.0;
        ui.spacing_mut().item_spacing.y = 0.0;
        ui.label(name).on_hover_text(&hover);
    });
    ui.horizontal(|ui| {
        let reset = text!("compare-reset");
        let reset_width = recipe_menu::button_width(ui, &reset).max(RESET);
        let taken = if is_changed {
            reset_width + space::SMALL
        } else {
            0.0
        };
        let width = ui.available_width() - taken;
        match &parameter.kind {
            Kind::Number(number) => number_ui(ui, parameter, number, recipe, width, &hover, acts),
            Kind::Choice(_) => choice_ui(ui, parameter, recipe, width, acts),
        }
        if is_changed {
            let button = Button::new(reset).min_size(vec2(reset_width, space::TARGET));
            let name = within_sentence(&title);
            let label = text!("compare-reset-named", parameter = name);
            let hover = text!(
                "compare-back-to",
                value = parameters::value(parameter, default)
            );
            if labelled(ui, button, &label).on_hover_text(hover).clicked() {
                acts.push(CompareAction::Reset(parameter.key));
            }
        }
    });
}

fn hover_text(parameter: &Parameter, default: &Recipe) -> String {
    let default = parameters::value(parameter, default);
    let valid = match &parameter.kind {
        Kind::Number(number) => {
            let [least, most] = number.range;
            text!(
                "compare-valid-range",
                least = least.to_string(),
                most = format!("{most}{}", number.unit.sign()),
                default = default,
            )
        }
        Kind::Choice(_) => {
            let options = parameters::options(parameter).join(", ");
            text!(
                "compare-valid-options",
                options = options,
                default = default
            )
        }
    };
    format!("{}\n{valid}", parameters::help(parameter))
}

/// A slider for the hand, and a number that can be dragged or written.
fn number_ui(
    ui: &mut Ui,
    parameter: &Parameter,
    number: &Number,
    recipe: &Recipe,
    width: f32,
    hover: &str,
    acts: &mut Vec<CompareAction>,
) {
    let [least, most] = number.range;
    let before = parameter.value(recipe);
    let (mut slid, mut written) = (before, before);
    ui.spacing_mut().slider_width = (width - NUMBER - space::SMALL).max(40.0);
    let is_wide = most > 500.0 * least.max(1.0);
    let slider = Slider::new(&mut slid, least..=most)
        .show_value(false)
        .logarithmic(is_wide)
        .trailing_fill(true);
    let slider = ui.add(slider);
    slider.widget_info(|| {
        let label = text!("compare-slider", parameter = parameters::name(parameter));
        WidgetInfo::slider(true, before, label)
    });
    slider.on_hover_text(hover);
    // What is out of range is told, not bent.
    let refused = Cell::new(None);
    let parse = |text: &str| {
        let digits = text.trim().trim_end_matches(number.unit.sign().trim());
        let value: f64 = digits.trim().replace(',', ".").parse().ok()?;
        if value >= least && value <= most {
            return Some(value);
        }
        refused.set(Some(value));
        None
    };
    let drag = DragValue::new(&mut written)
        .range(least..=most)
        .speed((most - least).min(before.abs().max(1.0)) / 100.0)
        .fixed_decimals(number.decimals)
        .suffix(number.unit.sign())
        .update_while_editing(false)
        .custom_parser(parse);
    let response = ui.add_sized(vec2(NUMBER, space::TARGET), drag);
    response.widget_info(|| {
        let mut info = WidgetInfo::drag_value(true, before);
        info.label = Some(parameters::name(parameter));
        info
    });
    response.on_hover_text(hover);
    let rounded = |value: f64| {
        let scale = 10_f64.powi(number.decimals as i32);
        (value * scale).round() / scale
    };
    for now in [slid, written] {
        let now = rounded(now).clamp(least, most);
        if (now - rounded(before)).abs() > f64::EPSILON * now.abs() {
            acts.push(CompareAction::Set(parameter.key, now));
        }
    }
    if let Some(value) = refused.get() {
        acts.push(CompareAction::Set(parameter.key, value));
    }
}

fn choice_ui(
    ui: &mut Ui,
    parameter: &Parameter,
    recipe: &Recipe,
    width: f32,
    acts: &mut Vec<CompareAction>,
) {
    let chosen = parameter.value(recipe) as usize;
    let (name, options) = (parameters::name(parameter), parameters::options(parameter));
    let each = width / options.len() as f32 - space::SMALL;
    let widths = options
        .iter()
        .map(|option| recipe_menu::button_width(ui, option));
    if each < widths.fold(64.0, f32::max) {
        let now = options.get(chosen).cloned().unwrap_or_default();
        ui.menu_button(format!("{now} ▼"), |ui| {
            for (place, option) in options.iter().enumerate() {
                if ui.selectable_label(place == chosen, option).clicked() {
                    acts.push(CompareAction::Set(parameter.key, place as f64));
                    ui.close();
                }
            }
        })
        .response
        .widget_info(|| {
            let label = format!("{name}: {now}");
            WidgetInfo::labeled(egui::Role::Button, true, label)
        });
        return;
    }
    for (place, option) in options.iter().enumerate() {
        let button = Button::selectable(place == chosen, option);
        let response = ui.add(button.min_size(vec2(each, space::TARGET)));
        response.widget_info(|| {
            let label = format!("{name}: {option}");
            WidgetInfo::selected(egui::Role::Button, true, place == chosen, label)
        });
        if response.clicked() && place != chosen {
            acts.push(CompareAction::Set(parameter.key, place as f64));
        }
    }
}

/// What comes of it.
fn outcome(
    ui: &mut Ui,
    compare: &CompareState,
    session: &Session,
    theme: &Theme,
    acts: &mut Vec<CompareAction>,
) {
    ui.scope(|ui| {
        ui.spacing_mut().interact_size.y = 0.0;
        let head = if compare.is_study_old() {
            text!("compare-case-is-pending")
        } else {
            text!("compare-case-is")
        };
        ui.label(RichText::new(head).color(theme.weak_text));
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
            let judgement = judged(compare);
            let (sign, colour) = match (judgement, found.accepted) {
                (Some(CaseOutcome::WrongAccepted), _) | (_, false) => (Mark::Bad, theme.rejected),
                (_, true) => (Mark::Good, theme.accepted),
            };
            ui.horizontal_top(|ui| {
                let (rect, _) = ui.allocate_exact_size(Vec2::splat(20.0), Sense::hover());
                mark(ui.painter(), rect.center(), 9.0, sign, theme);
                let text = RichText::new(title).font(font::verdict()).color(colour);
                ui.add(egui::Label::new(text).wrap());
            });
            let (word, colour) = match (judgement, found.accepted) {
                (Some(CaseOutcome::Right), true) => {
                    (text!("compare-right-accepted"), theme.accepted)
                }
                (Some(CaseOutcome::Right), false) => {
                    (text!("compare-rightly-refused"), theme.accepted)
                }
                (Some(CaseOutcome::WrongAccepted), _) => {
                    (text!("compare-false-accept"), theme.rejected)
                }
                (Some(CaseOutcome::Refused), _) => {
                    (text!("compare-wrongly-refused"), theme.warning)
                }
                (None, true) => (text!("compare-accepted"), theme.text),
                (None, false) => (text!("compare-truth-not-set"), theme.text),
            };
            let word = format!("{word} · {:.0} ms", study.time_ms);
            ui.label(RichText::new(word).color(colour));
            if let Some(refusal) = study.refusal(session.units) {
                let text = RichText::new(refusal).font(font::small()).color(theme.text);
                ui.label(text).on_hover_text(&study.advice);
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
