//! The inspection that is looked at: its verdict, its picture, and what can be done with it.

use egui::{Button, RichText, ScrollArea, Sense, TextureHandle, Ui, Vec2, vec2};

use super::{HistoryAction, PastInspection, PastVerdict};
use crate::{
    app::{
        action::Action,
        bars::labelled,
        inspect::texture,
        state::State,
        theme::{Theme, font, space},
        widgets::{Mark, fitted, heading, mark, row},
    },
    pipeline::Recipe,
};

/// The picture of the row that is looked at.
#[derive(Default)]
pub(super) struct Details {
    picture: Option<(u64, TextureHandle)>,
}

impl Details {
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        state: &State,
        theme: &Theme,
        actions: &mut Vec<Action>,
    ) {
        let Some(past) = state.history.selected() else {
            let text = "Choose an inspection to see more of it";
            ui.label(RichText::new(text).color(theme.weak_text));
            return;
        };
        self.make(ui, past);
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            verdict(ui, past, theme);
            self.picture(ui, past, theme);
            ui.add_space(space::MEDIUM);
            buttons(ui, past, theme, actions);
            heading(ui, theme, &format!("Inspection {}", past.number));
            ui.scope(|ui| {
                // Text lies closer than controls do.
                ui.spacing_mut().interact_size.y = 22.0;
                figures(ui, past, theme);
            });
        });
    }

    /// Uploads the picture, once.
    fn make(&mut self, ui: &Ui, past: &PastInspection) {
        if self
            .picture
            .as_ref()
            .is_some_and(|(of, _)| *of == past.number)
        {
            return;
        }
        let whole = past.whole.as_ref();
        let image = whole.and_then(|whole| whole.figures.segmentation.as_ref());
        self.picture = texture(ui.ctx(), "past inspection", image).map(|made| (past.number, made));
    }

    fn picture(&self, ui: &mut Ui, past: &PastInspection, theme: &Theme) {
        let Some((of, texture)) = &self.picture else {
            let text = "Its pictures are not kept any more: open it to make them again";
            ui.label(
                RichText::new(text)
                    .font(font::small())
                    .color(theme.weak_text),
            );
            return;
        };
        if *of != past.number {
            return;
        }
        ui.add_space(space::MEDIUM);
        let width = ui.available_width();
        let size = vec2(width, width * 0.75);
        let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
        response.widget_info(|| {
            let label = format!("Segmentation of inspection {}", past.number);
            egui::WidgetInfo::labeled(egui::Role::Image, true, label)
        });
        let place = fitted(rect, texture.aspect_ratio());
        egui::Image::new(texture).paint_at(ui, place);
    }
}

fn verdict(ui: &mut Ui, past: &PastInspection, theme: &Theme) {
    let title = RichText::new(&past.title).font(font::title());
    ui.label(title.color(theme.text));
    let (sign, colour) = match past.verdict {
        PastVerdict::Accepted => (Mark::Good, theme.accepted),
        PastVerdict::NotAccepted | PastVerdict::NoPart => (Mark::Bad, theme.rejected),
    };
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(Vec2::splat(20.0), Sense::hover());
        mark(ui.painter(), rect.center(), 9.0, sign, theme);
        let word = match past.verdict {
            PastVerdict::NoPart => PastVerdict::NotAccepted.title(),
            other => other.title(),
        };
        ui.label(RichText::new(word).font(font::verdict()).color(colour));
    });
    if let Some((reason, advice)) = &past.complaint {
        ui.label(RichText::new(reason).color(theme.text));
        let advice = RichText::new(advice).font(font::body_strong());
        ui.label(advice.color(theme.warning));
    }
}

fn figures(ui: &mut Ui, past: &PastInspection, theme: &Theme) {
    let [day, time] = &past.when;
    row(ui, theme, "scene", &past.scene);
    row(ui, theme, "day", day);
    row(ui, theme, "time of day", time);
    if let Some([score, margin]) = past.score {
        row(ui, theme, "score", &format!("{score:.2}"));
        row(ui, theme, "margin", &format!("{margin:.2}"));
    }
    row(ui, theme, "took", &format!("{} ms", past.time_text));
    let recipe = if *past.recipe == Recipe::default() {
        "the program's own"
    } else {
        "changed"
    };
    row(ui, theme, "recipe", recipe);
}

fn buttons(ui: &mut Ui, past: &PastInspection, theme: &Theme, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        let open = RichText::new("Open").font(font::body_strong());
        let key = RichText::new("Enter").font(font::small());
        let open = Button::new(open.color(theme.on_accent))
            .shortcut_text(key.color(theme.on_accent))
            .fill(theme.accent);
        if labelled(ui, open, "Open").clicked() {
            actions.push(Action::History(HistoryAction::Open(past.number)));
        }
        let again = Button::new("Inspect again");
        if labelled(ui, again, "Inspect again")
            .on_hover_text("With the recipe and the library now in use")
            .clicked()
        {
            actions.push(Action::History(HistoryAction::InspectAgain(past.number)));
        }
    });
}
