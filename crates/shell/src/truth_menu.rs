//! Menu entries for choosing the true label of a scene.

use std::collections::BTreeSet;

use egui::{Ui, WidgetInfo};

use crate::inspection::library_cache::LibraryView;
use inspection::library::{PartMeta, Truth};
use ui::{language::text, widgets::menu_list};

/// Returns the title of a true label; `None` if it is not set.
pub fn truth_title(truth: Option<&Truth>, library: &LibraryView) -> String {
    match truth {
        None => text!("shell-truth-not-set"),
        Some(Truth::NotEnrolled) => text!("shell-truth-not-enrolled"),
        Some(Truth::Nothing) => text!("shell-truth-nothing"),
        Some(Truth::Part(name)) => library.title_of(name).to_owned(),
    }
}

/// Draws the entries: `first` at the top, so that they are visible however many parts there are, then every enrolled part.
/// Calls `choose` with the pressed one.
pub fn truth_entries(
    ui: &mut Ui,
    chosen: Option<&Truth>,
    first: &[Option<Truth>],
    library: &LibraryView,
    mut choose: impl FnMut(Option<Truth>),
) {
    let mut entry = |ui: &mut Ui, truth: Option<Truth>| {
        let title = truth_title(truth.as_ref(), library);
        let response = ui.selectable_label(chosen == truth.as_ref(), &title);
        // Other lists contain the same part names.
        response.widget_info(|| {
            let label = text!("shell-actual-part", part = &title);
            WidgetInfo::labeled(egui::Role::Button, true, label)
        });
        if response.clicked() {
            choose(truth);
            ui.close();
        }
    };
    ui.set_min_width(220.0);
    menu_list(ui, |ui| {
        for truth in first {
            entry(ui, truth.clone());
        }
        ui.separator();
        // A part may have several references, of which a verdict names the part.
        let mut seen = BTreeSet::new();
        for part in library.parts.iter().map(PartMeta::part_name) {
            if seen.insert(part) {
                entry(ui, Some(Truth::Part(part.as_str().to_owned())));
            }
        }
    });
}
