//! The control of one parameter, used by every panel.

use std::cell::Cell;

use egui::{
    Button, CollapsingHeader, Color32, DragValue, RichText, Slider, TextStyle, Ui, WidgetInfo, vec2,
};

use super::{
    theme::{Theme, space},
    widgets::{button_width, labelled, menu_button},
};
use crate::language::{
    parameters::{self, TranslatedParameters},
    text, within_sentence,
};
use inspection::pipeline::parameters::{Kind, Number, Parameter};

/// A change of a parameter by the user.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParameterChange {
    /// A number in the unit shown, or the index of an option.
    Set(f64),
    /// Back to the default.
    Reset,
}

/// Makes a collapsible section whose title wraps where the panel is too narrow.
pub fn fold(ui: &Ui, title: String, colour: Color32) -> CollapsingHeader {
    let font = TextStyle::Button.resolve(ui.style());
    let spacing = ui.spacing();
    let width = ui.available_width() - spacing.indent - 2.0 * spacing.button_padding.x;
    CollapsingHeader::new(ui.painter().layout(title, font, colour, width))
}

/// Width of the number beside a slider, logical pixels.
const NUMBER_WIDTH_PX: f32 = 92.0;
/// Minimum width of the button that resets a parameter, logical pixels.
const MIN_RESET_WIDTH_PX: f32 = 58.0;

/// Draws the name of a parameter, its slider or options and, if it differs from the default, a reset button. Passes changes to
/// `changed`; a typed number may be out of range.
pub fn control<R: TranslatedParameters>(
    ui: &mut Ui,
    parameter: &Parameter<R>,
    recipe: &R,
    default: &R,
    changed: &mut dyn FnMut(ParameterChange),
) {
    let theme = Theme::of(ui);
    let is_changed = parameter.differs(recipe, default);
    let title = parameters::name(parameter);
    let name = if is_changed {
        let name = text!("view-parameter-changed", parameter = &title);
        RichText::new(name).color(theme.accent)
    } else {
        RichText::new(&title)
    };
    let hover = hover_text(parameter, default);
    ui.scope(|ui| {
        ui.spacing_mut().interact_size.y = 0.0;
        ui.spacing_mut().item_spacing.y = 0.0;
        ui.label(name).on_hover_text(&hover);
    });
    ui.horizontal(|ui| {
        let reset = text!("view-parameter-reset");
        let reset_width = button_width(ui, &reset).max(MIN_RESET_WIDTH_PX);
        let taken = if is_changed {
            reset_width + space::SMALL
        } else {
            0.0
        };
        let width = ui.available_width() - taken;
        match &parameter.kind {
            Kind::Number(number) => {
                number_ui(ui, parameter, number, recipe, width, &hover, changed);
            }
            Kind::Choice(_) => choice_ui(ui, parameter, recipe, width, changed),
        }
        if is_changed {
            let button = Button::new(reset).min_size(vec2(reset_width, space::TARGET));
            let name = within_sentence(&title);
            let label = text!("view-parameter-reset-named", parameter = name);
            let hover = text!(
                "view-parameter-back-to",
                value = parameters::value(parameter, default)
            );
            if labelled(ui, button, &label).on_hover_text(hover).clicked() {
                changed(ParameterChange::Reset);
            }
        }
    });
}

fn hover_text<R: TranslatedParameters>(parameter: &Parameter<R>, default: &R) -> String {
    let default = parameters::value(parameter, default);
    let valid = match &parameter.kind {
        Kind::Number(number) => {
            let [least, most] = number.range;
            text!(
                "view-parameter-valid-range",
                least = least.to_string(),
                most = format!("{most}{}", number.unit.sign()),
                default = default,
            )
        }
        Kind::Choice(_) => {
            let options = parameters::options(parameter).join(", ");
            text!(
                "view-parameter-valid-options",
                options = options,
                default = default
            )
        }
    };
    format!("{}\n{valid}", parameters::help(parameter))
}

/// Draws a slider, and a number that can be dragged or typed.
fn number_ui<R: TranslatedParameters>(
    ui: &mut Ui,
    parameter: &Parameter<R>,
    number: &Number<R>,
    recipe: &R,
    width: f32,
    hover: &str,
    changed: &mut dyn FnMut(ParameterChange),
) {
    let [least, most] = number.range;
    let before = parameter.value(recipe);
    let (mut slid, mut written) = (before, before);
    ui.spacing_mut().slider_width = (width - NUMBER_WIDTH_PX - space::SMALL).max(40.0);
    let is_wide = most > 500.0 * least.max(1.0);
    let slider = Slider::new(&mut slid, least..=most)
        .show_value(false)
        .logarithmic(is_wide)
        .trailing_fill(true);
    let slider = ui.add(slider);
    slider.widget_info(|| {
        let label = text!(
            "view-parameter-slider",
            parameter = parameters::name(parameter)
        );
        WidgetInfo::slider(true, before, label)
    });
    slider.on_hover_text(hover);
    // A typed value out of range is reported, not clamped.
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
    let response = ui.add_sized(vec2(NUMBER_WIDTH_PX, space::TARGET), drag);
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
            changed(ParameterChange::Set(now));
        }
    }
    if let Some(value) = refused.get() {
        changed(ParameterChange::Set(value));
    }
}

fn choice_ui<R: TranslatedParameters>(
    ui: &mut Ui,
    parameter: &Parameter<R>,
    recipe: &R,
    width: f32,
    changed: &mut dyn FnMut(ParameterChange),
) {
    let chosen = parameter.value(recipe) as usize;
    let (name, options) = (parameters::name(parameter), parameters::options(parameter));
    let each = width / options.len() as f32 - space::SMALL;
    let widths = options.iter().map(|option| button_width(ui, option));
    if each < widths.fold(64.0, f32::max) {
        let now = options.get(chosen).cloned().unwrap_or_default();
        menu_button(ui, format!("{now} ▼"), |ui| {
            for (index, option) in options.iter().enumerate() {
                if ui.selectable_label(index == chosen, option).clicked() {
                    changed(ParameterChange::Set(index as f64));
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
    for (index, option) in options.iter().enumerate() {
        let button = Button::selectable(index == chosen, option);
        let response = ui.add(button.min_size(vec2(each, space::TARGET)));
        response.widget_info(|| {
            let label = format!("{name}: {option}");
            WidgetInfo::selected(egui::Role::Button, true, index == chosen, label)
        });
        if response.clicked() && index != chosen {
            changed(ParameterChange::Set(index as f64));
        }
    }
}
