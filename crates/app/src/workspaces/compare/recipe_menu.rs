//! The name of the recipe on trial with the menu of kept recipes, and the parameters that differ from their defaults.

use egui::{Button, Key, RichText, ScrollArea, Ui, WidgetInfo, vec2};

use super::{
    CompareAction, CompareFile, CompareState,
    action::RecipeAction,
    kept_recipes::{Naming, NamingPurpose},
};
use geometry::error::Advice as _;
use inspection::{
    library::PartName,
    pipeline::{
        AS_IN_THE_PAPER, BUILT_IN, BUILT_IN_RECIPES, Recipe, RecipeLabel,
        parameters::{changed, num_changed},
    },
};
use shell::{
    language::{recipe_label, recipe_name},
    session::Session,
};
use ui::{
    language::{Message, described, library_text, parameters, text},
    theme::{Theme, font, space},
    widgets::{
        self, button_width, labelled, line_edit, menu_button, sentence, shortened, show_scroll_bar,
        text_button, wrapped,
    },
};

/// A longer name is shortened to this many letters.
const MAX_LETTERS: usize = 20;

/// Height of the list of recipes in the menu, logical pixels: the entries below it stay in sight.
const LIST_HEIGHT_PX: f32 = 230.0;

/// Least width of the field for a name, logical pixels.
const MIN_NAME_WIDTH_PX: f32 = 90.0;

pub(super) fn ui(
    ui: &mut Ui,
    compare: &CompareState,
    session: &Session,
    acts: &mut Vec<CompareAction>,
) {
    ui.horizontal(|ui| {
        ui.heading(sentence(&text!("inspect-recipe")));
        menu(ui, compare, session, acts);
    });
    if let Some(naming) = &compare.recipes.naming {
        let current = &compare.tried_recipe(session).label.name;
        name_ui(ui, compare, naming, current, acts);
    }
    if compare.recipes.is_asking {
        question(ui, &compare.tried_recipe(session).label.name, acts);
    }
    let recipe = compare.tried_recipe(session);
    if !recipe.expect.is_empty() {
        let parts = session.titles_of(&recipe.expect);
        wrapped(
            ui,
            &text!("compare-expects", parts = parts),
            &font::small(),
            Theme::of(ui).weak_text,
        );
    }
    changes(ui, compare, recipe, acts);
}

/// Asks whether saving may replace the recipe of another program.
fn question(ui: &Ui, name: &str, acts: &mut Vec<CompareAction>) {
    let modal = widgets::dialog(ui.ctx(), "replace recipe", |ui| {
        ui.set_max_width(420.0);
        ui.heading(text!("compare-replace-title", name = name));
        ui.weak(text!("compare-replace-why"));
        ui.add_space(space::MEDIUM);
        let mut answer = None;
        ui.horizontal(|ui| {
            if widgets::default_button(ui, &text!("shell-cancel"), true) {
                answer = Some(false);
            }
            if text_button(ui, &text!("compare-replace")).clicked() {
                answer = Some(true);
            }
        });
        answer
    });
    let is_closed = modal.should_close();
    if let Some(may_replace) = modal.inner.or(is_closed.then_some(false)) {
        acts.push(CompareAction::Recipe(RecipeAction::Replace(may_replace)));
    }
}

fn menu(ui: &mut Ui, compare: &CompareState, session: &Session, acts: &mut Vec<CompareAction>) {
    let theme = Theme::of(ui);
    let label = &compare.tried_recipe(session).label;
    let mut text = RichText::new(fitted_name(ui, label));
    if label.is_changed {
        text = text.color(theme.accent);
    }
    let full = text!("compare-recipe-named", recipe = recipe_label(label));
    let list = &compare.recipes.list;
    let response = menu_button(ui, text, |ui| {
        show_scroll_bar(ui);
        ScrollArea::vertical()
            .max_height(LIST_HEIGHT_PX)
            .show(ui, |ui| entries(ui, compare, label, acts));
        ui.separator();
        let is_own = BUILT_IN_RECIPES.contains(&label.name.as_str());
        let is_kept = compare.recipes.has(&label.name);
        let is_default = list.default == label.name;
        // Why an entry is disabled, if it is.
        let built_in = is_own.then(|| text!("compare-built-in-stays"));
        let not_kept = (!is_kept).then(|| text!("compare-not-kept"));
        let unchanged = (!label.is_changed).then(|| text!("compare-nothing-to-save"));
        let is_set = is_default.then(|| text!("compare-default-already"));
        let fixed = built_in.clone().or_else(|| not_kept.clone());
        for (text, why_not, action) in [
            (
                text!("shell-save"),
                built_in.or(unchanged),
                RecipeAction::Save,
            ),
            (
                text!("shell-save-as"),
                None,
                RecipeAction::Name(NamingPurpose::SaveAs),
            ),
            (text!("compare-duplicate"), None, RecipeAction::Duplicate),
            (
                text!("compare-rename"),
                fixed.clone(),
                RecipeAction::Name(NamingPurpose::Rename),
            ),
            (text!("compare-delete"), fixed, RecipeAction::Delete),
            (
                text!("compare-set-default"),
                not_kept.or(is_set),
                RecipeAction::MakeDefault,
            ),
        ] {
            let entry = ui.add_enabled(why_not.is_none(), Button::new(text));
            let entry = entry.on_disabled_hover_text(why_not.unwrap_or_default());
            if entry.clicked() {
                acts.push(CompareAction::Recipe(action));
                ui.close();
            }
        }
        ui.separator();
        for (text, file) in [
            (text!("compare-import"), CompareFile::ImportRecipe),
            (text!("shell-export"), CompareFile::ExportRecipe),
        ] {
            if ui.button(text).clicked() {
                acts.push(CompareAction::Ask(file));
                ui.close();
            }
        }
    })
    .response;
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, &full));
    response.on_hover_text(full);
}

/// The name of a recipe as its button has it, cut off where the button would be wider than the panel.
fn fitted_name(ui: &Ui, label: &RecipeLabel) -> String {
    let with_name_of = |most: usize| {
        let name = shortened(&recipe_name(&label.name), most);
        if label.is_changed {
            format!("{} ▼", text!("results-recipe-modified", name = name))
        } else {
            format!("{name} ▼")
        }
    };
    let mut texts = (2..=MAX_LETTERS).rev().map(with_name_of);
    let fits = |text: &String| button_width(ui, text) <= ui.available_width();
    texts.find(fits).unwrap_or_else(|| with_name_of(2))
}

/// Draws the built-in recipe and the saved ones.
fn entries(
    ui: &mut Ui,
    compare: &CompareState,
    label: &RecipeLabel,
    acts: &mut Vec<CompareAction>,
) {
    let list = &compare.recipes.list;
    let own = [
        (BUILT_IN, text!("compare-built-in-hint")),
        (AS_IN_THE_PAPER, library_text("recipe-as-in-the-paper")),
    ];
    let own = own.iter().map(|(name, hint)| (*name, hint.as_str()));
    let kept = list.recipes.iter();
    for (name, notes) in own.chain(kept.map(|file| (file.name.as_str(), file.notes.as_str()))) {
        let default = if list.default == name {
            format!(" · {}", text!("compare-is-default"))
        } else {
            String::new()
        };
        let text = format!("{}{default}", shortened(&recipe_name(name), 32));
        let entry = ui.selectable_label(label.name == name, text);
        let entry = if notes.is_empty() {
            entry
        } else {
            entry.on_hover_text(notes)
        };
        if entry.clicked() {
            acts.push(CompareAction::Recipe(RecipeAction::Open(name.into())));
            ui.close();
        }
    }
}

/// Draws the field for a name, with its buttons.
fn name_ui(
    ui: &mut Ui,
    compare: &CompareState,
    naming: &Naming,
    current: &str,
    acts: &mut Vec<CompareAction>,
) {
    let theme = Theme::of(ui);
    let mut act = |action| acts.push(CompareAction::Recipe(action));
    let mut text = naming.text.clone();
    let checked = PartName::new(text.trim());
    let is_taken = checked
        .as_ref()
        .is_ok_and(|name| compare.recipes.has(name.as_str()));
    let is_same = text.trim() == current;
    let can_take = checked.is_ok() && !is_taken;
    ui.horizontal_wrapped(|ui| {
        let (take, take_label) = match naming.purpose {
            NamingPurpose::SaveAs => (text!("shell-save"), text!("compare-save-name")),
            NamingPurpose::Rename => (text!("compare-take-rename"), text!("compare-rename-name")),
        };
        let cancel = text!("shell-cancel");
        let widths = [&take, &cancel].map(|text| button_width(ui, text).max(64.0));
        let whole = ui.available_width() - space::MEDIUM;
        let beside = whole - widths[0] - widths[1] - 2.0 * space::SMALL;
        // If the buttons leave too little room, they are placed below.
        let width = if beside < MIN_NAME_WIDTH_PX {
            whole
        } else {
            beside
        };
        let response = ui.add(line_edit(&mut text, text!("compare-name-hint"), width));
        response.widget_info(|| {
            let mut info =
                WidgetInfo::text_edit(true, &naming.text, &text, text!("compare-name-hint"));
            info.label = Some(text!("compare-name"));
            info
        });
        if naming.is_new {
            response.request_focus();
            act(RecipeAction::Write(text.clone()));
        }
        let is_entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let button = Button::new(take).min_size(vec2(widths[0], space::TARGET));
        let pressed = ui.add_enabled(can_take, button);
        pressed.widget_info(|| WidgetInfo::labeled(egui::Role::Button, can_take, &take_label));
        if can_take && (pressed.clicked() || is_entered) {
            act(RecipeAction::TakeName);
        }
        let button = Button::new(cancel).min_size(vec2(widths[1], space::TARGET));
        if labelled(ui, button, &text!("compare-cancel-name")).clicked() {
            act(RecipeAction::CancelName);
        }
    });
    let complaint = match (&checked, is_taken) {
        (Err(error), _) if !text.trim().is_empty() => Some(error.advice()),
        (Ok(name), true) if !is_same => {
            let taken = Message::new("recipe-exists").with("name", name.as_str());
            Some(sentence(&described(&taken)))
        }
        _ => None,
    };
    if let Some(complaint) = complaint {
        let text = RichText::new(complaint).small().color(theme.warning);
        ui.add(egui::Label::new(text).wrap());
    }
    if text != naming.text {
        act(RecipeAction::Write(text));
    }
}

/// Draws the number of parameters that differ from their defaults and, unfolded, their list.
fn changes(ui: &mut Ui, compare: &CompareState, recipe: &Recipe, acts: &mut Vec<CompareAction>) {
    let theme = Theme::of(ui);
    let num = num_changed(recipe);
    let text = text!("compare-num-changed", count = num);
    if num == 0 {
        ui.weak(text);
        return;
    }
    let is_open = compare.recipes.is_listing_changes;
    ui.horizontal(|ui| {
        let sign = if is_open { "▲" } else { "▼" };
        let shown = RichText::new(format!("{text} {sign}")).color(theme.accent);
        // Both fit a narrow panel.
        ui.spacing_mut().button_padding.x = 4.0;
        let button = Button::new(shown).frame_when_inactive(false);
        let button = button.min_size(vec2(0.0, space::TARGET));
        if labelled(ui, button, &text)
            .on_hover_text(text!("compare-list-changes"))
            .clicked()
        {
            acts.push(CompareAction::Recipe(RecipeAction::ListChanges));
        }
        if text_button(ui, &text!("compare-reset-all"))
            .on_hover_text(text!("compare-reset-all-hint"))
            .clicked()
        {
            acts.push(CompareAction::ResetAll);
        }
    });
    if !is_open {
        return;
    }
    let default = Recipe::default();
    ScrollArea::vertical()
        .id_salt("changes")
        .max_height(132.0)
        .show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 2.0;
            for parameter in changed(recipe) {
                let text = text!(
                    "compare-parameter-change",
                    parameter = parameters::name(parameter),
                    value = parameters::value(parameter, recipe),
                    default = parameters::value(parameter, &default),
                );
                let text = RichText::new(text).small();
                ui.add(egui::Label::new(text).wrap())
                    .on_hover_text(parameter.key);
            }
        });
}
