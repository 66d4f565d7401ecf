//! The name of the recipe on trial, what can be done with kept recipes, and what differs from the defaults.

use egui::{Button, Key, RichText, ScrollArea, TextEdit, Ui, WidgetInfo, vec2};

use super::{
    CompareAction, CompareFile, CompareState,
    action::RecipeAction,
    kept_recipes::{Naming, NamingPurpose},
};
use crate::{
    app::{
        shell::session::Session,
        ui::{
            theme::{Theme, font, space},
            widgets::{labelled, shortened},
        },
    },
    error::Advice as _,
    library::PartName,
    pipeline::{
        BUILT_IN, Recipe,
        parameters::{changed, num_changed},
    },
};

/// Letters of a name that the panel has room for.
const MAX_LETTERS: usize = 20;

/// Draws all of it.
pub(super) fn ui(
    ui: &mut Ui,
    compare: &CompareState,
    session: &Session,
    theme: &Theme,
    acts: &mut Vec<CompareAction>,
) {
    ui.horizontal(|ui| {
        ui.label(
            RichText::new("Recipe")
                .font(font::verdict())
                .color(theme.text),
        );
        menu(ui, compare, session, theme, acts);
    });
    if let Some(naming) = &compare.recipes.naming {
        let current = &compare.tried_recipe(session).label.name;
        name_ui(ui, compare, naming, current, theme, acts);
    }
    changes(ui, compare, compare.tried_recipe(session), theme, acts);
}

fn menu(
    ui: &mut Ui,
    compare: &CompareState,
    session: &Session,
    theme: &Theme,
    acts: &mut Vec<CompareAction>,
) {
    let label = &compare.tried_recipe(session).label;
    let name = shortened(&label.name, MAX_LETTERS);
    let mut text = RichText::new(format!("{name} ▼"));
    if label.is_changed {
        text = RichText::new(format!("{name} (modified) ▼")).color(theme.accent);
    }
    let full = format!("Recipe {label}");
    let list = &compare.recipes.list;
    let response = ui
        .menu_button(text, |ui| {
            let names = std::iter::once((BUILT_IN, "Every parameter at its default"));
            let kept = list.recipes.iter();
            for (name, notes) in
                names.chain(kept.map(|file| (file.name.as_str(), file.notes.as_str())))
            {
                let default = if list.default == name {
                    " · default"
                } else {
                    ""
                };
                let text = format!("{}{default}", shortened(name, 32));
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
            ui.separator();
            let is_own = label.name == BUILT_IN;
            let is_kept = compare.recipes.has(&label.name);
            let is_default = list.default == label.name;
            for (text, can, action) in [
                ("Save", label.is_changed && !is_own, RecipeAction::Save),
                ("Save as…", true, RecipeAction::Name(NamingPurpose::SaveAs)),
                ("Duplicate", true, RecipeAction::Duplicate),
                (
                    "Rename…",
                    is_kept && !is_own,
                    RecipeAction::Name(NamingPurpose::Rename),
                ),
                ("Delete", is_kept && !is_own, RecipeAction::Delete),
                (
                    "Set as default",
                    is_kept && !is_default,
                    RecipeAction::MakeDefault,
                ),
            ] {
                if ui.add_enabled(can, Button::new(text)).clicked() {
                    acts.push(CompareAction::Recipe(action));
                    ui.close();
                }
            }
            ui.separator();
            for (text, file) in [
                ("Import…", CompareFile::ImportRecipe),
                ("Export…", CompareFile::ExportRecipe),
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

/// The line in which a name is written.
fn name_ui(
    ui: &mut Ui,
    compare: &CompareState,
    naming: &Naming,
    current: &str,
    theme: &Theme,
    acts: &mut Vec<CompareAction>,
) {
    let mut act = |action| acts.push(CompareAction::Recipe(action));
    let mut text = naming.text.clone();
    let checked = PartName::new(text.trim());
    let is_taken = checked
        .as_ref()
        .is_ok_and(|name| compare.recipes.has(name.as_str()));
    let is_same = text.trim() == current;
    let can_take = checked.is_ok() && !is_taken;
    ui.horizontal(|ui| {
        let take = match naming.purpose {
            NamingPurpose::SaveAs => "Save",
            NamingPurpose::Rename => "Rename",
        };
        let buttons = 2.0 * (64.0 + space::SMALL);
        let edit = TextEdit::singleline(&mut text)
            .hint_text("name")
            .align(egui::Align2::LEFT_CENTER)
            .desired_width(ui.available_width() - buttons - space::MEDIUM)
            .min_size(vec2(0.0, space::TARGET));
        let response = ui.add(edit);
        response.widget_info(|| {
            let mut info = WidgetInfo::text_edit(true, &naming.text, &text, "name");
            info.label = Some("Name of the recipe".into());
            info
        });
        if naming.is_new {
            response.request_focus();
            act(RecipeAction::Write(text.clone()));
        }
        let is_entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let button = Button::new(take).min_size(vec2(64.0, space::TARGET));
        let label = format!("{take} under this name");
        let pressed = ui.add_enabled(can_take, button);
        pressed.widget_info(|| WidgetInfo::labeled(egui::Role::Button, can_take, &label));
        if can_take && (pressed.clicked() || is_entered) {
            act(RecipeAction::TakeName);
        }
        let button = Button::new("Cancel").min_size(vec2(64.0, space::TARGET));
        if labelled(ui, button, "Cancel the name").clicked() {
            act(RecipeAction::CancelName);
        }
    });
    let complaint = match (&checked, is_taken) {
        (Err(error), _) if !text.trim().is_empty() => Some(error.advice()),
        (Ok(name), true) if !is_same => Some(format!("There is a recipe named {name} already")),
        _ => None,
    };
    if let Some(complaint) = complaint {
        let text = RichText::new(complaint)
            .font(font::small())
            .color(theme.warning);
        ui.add(egui::Label::new(text).wrap());
    }
    if text != naming.text {
        act(RecipeAction::Write(text));
    }
}

/// How many parameters differ from their defaults and, if asked for, which.
fn changes(
    ui: &mut Ui,
    compare: &CompareState,
    recipe: &Recipe,
    theme: &Theme,
    acts: &mut Vec<CompareAction>,
) {
    let num = num_changed(recipe);
    let text = format!("{num} changed from default");
    if num == 0 {
        ui.label(RichText::new(text).color(theme.weak_text));
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
            .on_hover_text("List them")
            .clicked()
        {
            acts.push(CompareAction::Recipe(RecipeAction::ListChanges));
        }
        let reset = labelled(ui, Button::new("Reset all"), "Reset all");
        if reset
            .on_hover_text("Every parameter back to its default")
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
                let text = format!(
                    "{}: {}, default {}",
                    parameter.name,
                    parameter.text(recipe),
                    parameter.text(&default)
                );
                let text = RichText::new(text).font(font::small()).color(theme.text);
                ui.add(egui::Label::new(text).wrap())
                    .on_hover_text(parameter.key);
            }
        });
}
