//! The distance of every enrolled reference by both matchers; pressing a row compares with it.

use egui::{Align2, Rect, RichText, ScrollArea, Sense, Ui, WidgetInfo, pos2, vec2};

use super::{CompareAction, CompareState, study::PartDistance};
use shell::{language::UnitSystem, session::Session};
use stages::rank::Matcher;
use ui::{
    language::text,
    theme::{ROUNDING, Theme, font, space},
    widgets::{fitted_middle, focus_ring},
};

/// Height of a row.
const ROW_HEIGHT_PX: f32 = 40.0;
/// Height of the line of figures below a name.
const FIGURES_HEIGHT_PX: f32 = 16.0;
/// A row wider than this has room for the figures beside the name.
const WIDE_ROW_PX: f32 = 270.0;

pub(super) fn ui(
    ui: &mut Ui,
    compare: &CompareState,
    session: &Session,
    acts: &mut Vec<CompareAction>,
) {
    let theme = Theme::of(ui);
    if compare.is_study_old() {
        ui.multiply_opacity(0.55);
    }
    ui.spacing_mut().item_spacing.y = 2.0;
    ui.label(RichText::new(text!("compare-distances")).font(font::body_strong()));
    let Some(study) = compare
        .study
        .as_ref()
        .filter(|study| !study.distances.is_empty())
    else {
        ui.weak(text!("compare-distances-none"));
        return;
    };
    ui.spacing_mut().interact_size.y = 0.0;
    ui.vertical(|ui| {
        let chosen = study.recipe.rank.matcher;
        let small = |text: &str, colour| RichText::new(text).small().color(colour);
        let with_sign = |name: String, matcher| {
            if matcher == chosen {
                text!("compare-distance-in-use", name = name)
            } else {
                name
            }
        };
        let default = with_sign(text!("compare-distance-default"), Matcher::Default);
        ui.label(small(&default, theme.first_series));
        let paper = with_sign(text!("compare-distance-paper"), Matcher::Paper);
        let paper = ui.label(small(&paper, theme.second_series));
        paper.on_hover_text(text!("compare-distance-paper-hint"));
    });
    ScrollArea::vertical()
        .id_salt("distances")
        .auto_shrink(false)
        .show(ui, |ui| {
            for distance in &study.distances {
                let is_against = study.against.as_ref() == Some(&distance.enrolled_as);
                if row(ui, distance, is_against, session.units) {
                    let chosen = distance.enrolled_as.clone();
                    acts.push(CompareAction::Against(Some(chosen)));
                }
            }
        });
}

/// Draws a row; returns true if it was clicked.
fn row(ui: &mut Ui, distance: &PartDistance, is_against: bool, units: UnitSystem) -> bool {
    let theme = Theme::of(ui);
    let width = ui.available_width() - space::MEDIUM;
    // In a narrow row the figures are below the name.
    let is_wide = width > WIDE_ROW_PX;
    let below = if is_wide { 0.0 } else { FIGURES_HEIGHT_PX };
    let size = vec2(width, ROW_HEIGHT_PX + below);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let outline = distance
        .outline
        .map_or("–".to_owned(), |metres| units.length(metres));
    let figures = format!("{outline} · {:.2e}", distance.paper);
    response.widget_info(|| {
        let label = text!(
            "compare-compare-with",
            part = &distance.title,
            figures = &figures
        );
        WidgetInfo::selected(egui::Role::Button, true, is_against, label)
    });
    let painter = ui.painter_at(rect);
    if is_against || response.hovered() {
        painter.rect_filled(rect, ROUNDING, theme.control);
    }
    if is_against {
        let bar = Rect::from_min_size(rect.min, vec2(3.0, rect.height()));
        painter.rect_filled(bar, 0.0, theme.accent);
    }
    let inner = rect.shrink2(vec2(8.0, 3.0));
    let (at, anchor) = if is_wide {
        (inner.right_top(), Align2::RIGHT_TOP)
    } else {
        (inner.left_top() + vec2(0.0, 18.0), Align2::LEFT_TOP)
    };
    let value = painter.text(at, anchor, &figures, font::small(), theme.text);
    let end = if is_wide {
        value.left() - 4.0
    } else {
        inner.right()
    };
    let name = if is_against {
        font::body_strong()
    } else {
        font::body()
    };
    let title = fitted_middle(&painter, &distance.title, &name, end - inner.left());
    painter.text(inner.left_top(), Align2::LEFT_TOP, title, name, theme.text);
    let colours = [theme.first_series, theme.second_series];
    for (index, (share, colour)) in distance.shares.iter().zip(colours).enumerate() {
        let top = inner.top() + 20.0 + below + 7.0 * index as f32;
        let track = Rect::from_min_size(pos2(inner.left(), top), vec2(inner.width(), 5.0));
        painter.rect_filled(track, 2.0, theme.track);
        let filled = vec2(inner.width() * share.clamp(0.0, 1.0), 5.0);
        painter.rect_filled(Rect::from_min_size(track.min, filled), 2.0, colour);
    }
    focus_ring(ui, rect, &response);
    let hover = text!(
        "compare-distance-hint",
        outline = outline,
        paper = format!("{:.4e}", distance.paper),
        score = format!("{:.2}", distance.score),
    );
    let hover = format!("{}\n{hover}", distance.title);
    response.on_hover_text(hover).clicked()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_title_keeps_its_end_and_stays_in_its_row() {
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        let distance = PartDistance {
            part: "fender".into(),
            enrolled_as: "fender_b".into(),
            title: "Front fender of the red delivery van, left · fender_b".into(),
            outline: Some(0.012),
            paper: 1.5e6,
            shares: [0.5; 2],
            score: 0.97,
        };
        for width in [200.0, 350.0] {
            let output = ctx.run_ui(egui::RawInput::default(), |ui| {
                ui.set_max_width(width);
                row(ui, &distance, false, UnitSystem::MillimetresDegrees);
            });
            let texts = output.shapes.iter().filter_map(|drawn| match &drawn.shape {
                egui::Shape::Text(text) => {
                    let text_and_right = (
                        text.galley.text().to_owned(),
                        text.visual_bounding_rect().right(),
                    );
                    Some(text_and_right)
                }
                _ => None,
            });
            let texts: Vec<(String, f32)> = texts.collect();
            output.drop_without_applying_deltas();
            let title = texts.iter().find(|(text, _)| text.contains('…'));
            let (title, right) = title.expect("shortened");
            assert!(title.ends_with("fender_b"), "{title}");
            assert!(*right < width, "{title} ends at {right}");
        }
    }
}
