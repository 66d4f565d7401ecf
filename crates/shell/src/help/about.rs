//! The page of Help about the program and this computer.

use std::{env::consts, path::Path};

use egui::{Align, Button, CollapsingHeader, Layout, RichText, Ui};

use crate::{action::Action, state::State};
use ui::{
    language::text,
    theme::font,
    widgets::{heading, labelled, path_row, row},
};

/// Titles and texts of the licences of what is inside the program, other than packages.
const LICENCES: [(&str, &str); 4] = [
    ("Partsight: MIT", include_str!("../../../../LICENSE-MIT")),
    (
        "Partsight: Apache 2.0",
        include_str!("../../../../LICENSE-APACHE"),
    ),
    (
        "Inter: SIL Open Font License 1.1",
        include_str!("../../../../assets/fonts/Inter-LICENSE.txt"),
    ),
    (
        "Noto Sans SC: SIL Open Font License 1.1",
        include_str!("../../../../assets/fonts/NotoSansSC-LICENSE.txt"),
    ),
];

pub(super) fn ui(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    ui.label(RichText::new("Partsight").font(font::title()));
    row(ui, &text!("help-version"), env!("CARGO_PKG_VERSION"));
    let system = format!("{} {}", consts::OS, consts::ARCH);
    row(ui, &text!("help-system"), &system);
    row(ui, &text!("help-graphics"), &state.installation.graphics);
    heading(ui, &text!("help-folders"));
    let installation = &state.installation;
    let library = state.session.library.as_ref();
    let library = library.map(|library| library.path.as_path());
    for (name, path) in [
        (text!("help-library"), library),
        (text!("shell-history"), installation.history.as_deref()),
        (text!("help-cases"), installation.cases.as_deref()),
        (text!("help-recipes"), installation.recipes.as_deref()),
        (text!("help-settings"), installation.settings.as_deref()),
    ] {
        if let Some(path) = path {
            folder(ui, &name, path, actions);
        }
    }
    heading(ui, &text!("help-licences"));
    ui.label(text!("help-licences-say"));
    for (title, licence) in LICENCES {
        CollapsingHeader::new(title).show(ui, |ui| ui.weak(licence));
    }
}

/// Draws a path with a button that copies it.
fn folder(ui: &mut Ui, name: &str, path: &Path, actions: &mut Vec<Action>) {
    let path = path.display().to_string();
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let label = text!("help-copy-path", what = name);
            if labelled(ui, Button::new(text!("help-copy")), &label).clicked() {
                actions.push(Action::CopyText(path.clone()));
            }
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                path_row(ui, name, &path);
            });
        });
    });
}
