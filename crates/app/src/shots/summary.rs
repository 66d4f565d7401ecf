//! The section about the scan on the card of a workspace.

use egui::{RichText, Ui};

use shell::{
    inspection::scan::{FusedShots, ShotFate},
    language::UnitSystem,
};
use ui::{
    language::{self, described, text, what_and_advice},
    theme::{Theme, font, space},
    widgets::{grouped, heading, row, sentence},
};

/// Draws the section.
pub(crate) fn summary(ui: &mut Ui, fused: &FusedShots, units: UnitSystem) {
    heading(ui, &text!("shots-scan"));
    // Rows of text may be closer together than controls.
    ui.scope(|ui| {
        ui.spacing_mut().interact_size.y = 20.0;
        ui.spacing_mut().item_spacing.y = 3.0;
        figures(ui, fused, units);
    });
}

fn figures(ui: &mut Ui, fused: &FusedShots, units: UnitSystem) {
    let theme = Theme::of(ui);
    let num_all = fused.rows.len();
    row(
        ui,
        &text!("shots-used"),
        &text!("shots-num-used", used = fused.num_used(), num = num_all),
    );
    let moved = fused.rows.iter().filter_map(|row| match row.fate {
        ShotFate::Used { moved, .. } => Some([moved.shift.0, moved.rotation.0]),
        _ => None,
    });
    let [shift, turn] = moved.fold([0.0_f64; 2], |most, one| {
        [most[0].max(one[0]), most[1].max(one[1])]
    });
    let moved = format!("{} · {}", units.length(shift), units.angle(turn));
    row(ui, &text!("shots-refined-by"), &moved);
    if let Some(overlap) = fused.scan.after.part.or(fused.scan.after.all) {
        row(ui, &text!("shots-agree-to"), &units.length(overlap.rms.0));
    }
    let num_part = fused.scan.cloud.is_part.iter().filter(|is| **is).count();
    row(ui, &text!("shots-points"), &grouped(num_part));
    let open = format!("{:.0} %", fused.figure.open_share * 100.0);
    row(ui, &text!("shots-outline-open"), &open);
    let advised = |ui: &mut Ui, text: &str, advice: String| {
        ui.add_space(space::SMALL);
        ui.label(sentence(text));
        ui.label(
            RichText::new(advice)
                .font(font::body_strong())
                .color(theme.warning),
        );
    };
    for (index, shot) in fused.rows.iter().enumerate() {
        if let ShotFate::Excluded(why) = shot.fate {
            let text = text!(
                "shots-shot-left-out",
                shot = index + 1,
                why = described(&why)
            );
            advised(ui, &text, language::advised(&why));
        }
    }
    if let Some(found) = &fused.scan.doubt {
        let [what, advice] = what_and_advice(found);
        advised(ui, &sentence(&what), advice);
    }
}
