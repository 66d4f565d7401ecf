//! The check of the part's surface on the card: its verdict, the regions, and what would have been found.

use egui::Ui;

use inspection::pipeline::{Inspection, JudgedRegion, SurfaceVerdict};
use shell::language::UnitSystem;
use ui::{
    language::{advised, described, text},
    theme::Theme,
    widgets::{heading, row, sentence},
};

/// Draws the section; nothing if the surface was not checked.
pub(super) fn ui(ui: &mut Ui, inspection: &Inspection, units: UnitSystem) {
    let Some(check) = &inspection.surface else {
        return;
    };
    let theme = Theme::of(ui);
    heading(ui, &text!("inspect-surface"));
    let colour = match check.verdict {
        SurfaceVerdict::Ok => theme.accepted,
        SurfaceVerdict::NotJudged => theme.warning,
        SurfaceVerdict::Rework | SurfaceVerdict::Scrap => theme.rejected,
    };
    ui.colored_label(colour, sentence(&described(&check.verdict)));
    for judged in &check.regions {
        let area = format!("{:.1} cm²", 1e4 * judged.region.area_m2);
        let zone = judged.zone.iter().filter(|zone| !zone.is_empty());
        let mut words = vec![area];
        words.extend(zone.map(ToString::to_string));
        words.push(described(&judged.verdict));
        let value = words.join(" · ");
        row(ui, &region_words(judged, units), &value);
    }
    if let Some(why) = &check.not_judged {
        ui.label(sentence(&described(why)));
        ui.colored_label(theme.warning, advised(why));
    }
    let Some(deviation) = &check.deviation else {
        return;
    };
    row(
        ui,
        &text!("inspect-surface-frames"),
        &deviation.num_frames.to_string(),
    );
    row(
        ui,
        &text!("inspect-surface-seen"),
        &format!("{:.0} %", 100.0 * deviation.seen),
    );
    row(
        ui,
        &text!("inspect-surface-noise"),
        &units.length(deviation.noise.0),
    );
    for dent in &deviation.smallest {
        let width = units.length(dent.width.0);
        let name = text!("inspect-surface-smallest", width = width);
        row(ui, &name, &units.length(dent.depth.0));
    }
}

/// What a region is and how far it deviates.
pub(super) fn region_words(judged: &JudgedRegion, units: UnitSystem) -> String {
    let kind = sentence(&described(&judged.region.kind));
    match judged.region.off {
        None => kind,
        Some(off) => format!("{kind} {}", units.signed_length(off.0)),
    }
}
