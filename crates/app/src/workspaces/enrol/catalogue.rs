//! The enrolled parts side by side; a click opens one.

use std::sync::Arc;

use egui::{
    Align, Color32, FontId, Galley, Painter, Rect, Response, RichText, ScrollArea, Sense, Stroke,
    StrokeKind, Ui, pos2, vec2,
};

use super::{EnrolAction, EnrolState, thumbnails::Thumbnails, undo::LastChangedPart};
use crate::shared::paint_fitted;
use inspection::library::{PartMeta, PartName};
use shell::inspection::library_cache::LibraryView;
use ui::{
    language::text,
    theme::{ROUNDING, Theme, font, space},
    widgets::{Mark, focus_ring, mark, sentence, shortened},
};

/// Size of a part's card, logical pixels.
const CARD: [f32; 2] = [236.0, 84.0];
/// Maximum number of characters beside the picture; fewer if they are wide.
const LETTERS: usize = 18;
/// Number of characters that is never shortened any further.
const FEWEST_LETTERS: usize = 5;

/// The strip of parts, and what it keeps between frames.
#[derive(Default)]
pub(super) struct Catalogue {
    /// The library, and the indices of its parts ordered by title.
    sorted: Option<(Arc<LibraryView>, Vec<usize>)>,
    /// Number of the library change that was scrolled to.
    followed: u64,
}

/// Contents of a card.
struct CardContent<'a> {
    name: &'a str,
    title: &'a str,
    below: [String; 2],
    texture: Option<&'a egui::TextureHandle>,
    is_damaged: bool,
    latest: Option<String>,
    /// Title of the part that it is a reference of.
    reference_of: Option<&'a str>,
}

impl Catalogue {
    /// Sorts the parts if the library has changed.
    fn sort(&mut self, library: &Arc<LibraryView>) {
        let sorted = self.sorted.as_ref();
        if sorted.is_some_and(|(of, _)| Arc::ptr_eq(of, library)) {
            return;
        }
        let mut order: Vec<usize> = (0..library.parts.len()).collect();
        order.sort_by_cached_key(|index| library.title(*index).to_lowercase());
        self.sorted = Some((Arc::clone(library), order));
    }

    /// Draws the strip.
    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        enrol: &EnrolState,
        library: Option<&Arc<LibraryView>>,
        thumbnails: &Thumbnails,
        actions: &mut Vec<EnrolAction>,
    ) {
        let theme = Theme::of(ui);
        let Some(library) = library else {
            ui.weak(text!("enrol-library-loading"));
            return;
        };
        if let Some(problem) = &library.unloaded {
            ui.label(RichText::new(&problem.what).color(theme.warning));
            ui.weak(&problem.advice);
            return;
        }
        self.sort(library);
        let text = text!("enrol-num-parts", count = library.parts.len());
        ui.label(RichText::new(text).font(font::heading()).weak());
        let order = self.sorted.as_ref().map_or(&[][..], |(_, order)| order);
        let wants_more = self.followed == enrol.num_changes;
        // The vertical wheel scrolls it as well.
        ui.style_mut().always_scroll_the_only_direction = true;
        ScrollArea::horizontal().auto_shrink(false).show(ui, |ui| {
            ui.horizontal(|ui| {
                for damaged in &library.damaged {
                    let shown = CardContent {
                        name: &damaged.entry,
                        title: &damaged.entry,
                        below: [text!("enrol-damaged"), String::new()],
                        texture: None,
                        is_damaged: true,
                        latest: None,
                        reference_of: None,
                    };
                    card(ui, &shown, enrol, actions);
                }
                let parts = order
                    .iter()
                    .filter_map(|index| Some((*index, library.parts.get(*index)?)));
                for (index, part) in parts {
                    let latest = enrol.latest.as_ref();
                    let latest = latest.filter(|latest| latest.name == part.name);
                    let reference_of = part.reference_of().map(|of| library.title_of(of.as_str()));
                    let [day, seen] = when(part);
                    let beneath =
                        reference_of.map_or(seen, |of| text!("enrol-tile-reference", part = of));
                    let shown = CardContent {
                        name: part.name.as_str(),
                        title: part.shown_title(),
                        below: [day, beneath],
                        texture: thumbnails.of_part(index),
                        is_damaged: false,
                        latest: latest.map(LastChangedPart::shown),
                        reference_of,
                    };
                    let response = card(ui, &shown, enrol, actions);
                    if latest.is_some() && !wants_more {
                        response.scroll_to_me(Some(Align::Center));
                    }
                }
            });
        });
        self.followed = enrol.num_changes;
    }
}

/// The day of enrolment, and below it the source, or that the part is simulated.
fn when(part: &PartMeta) -> [String; 2] {
    let at = part.enrolled.at.to_zoned(jiff::tz::TimeZone::system());
    let seen = if part.simulated {
        sentence(&text!("inspect-simulated"))
    } else {
        part.enrolled.from.clone()
    };
    [at.strftime("%Y-%m-%d").to_string(), seen]
}

/// Lays out a text, shortened in its middle until it fits.
fn fitted_text(
    painter: &Painter,
    text: &str,
    font: &FontId,
    room: f32,
    colour: Color32,
) -> Arc<Galley> {
    let mut letters = LETTERS;
    loop {
        let drawn = painter.layout_no_wrap(shortened(text, letters), font.clone(), colour);
        if drawn.size().x <= room || letters <= FEWEST_LETTERS {
            return drawn;
        }
        letters -= 1;
    }
}

fn card(
    ui: &mut Ui,
    shown: &CardContent<'_>,
    enrol: &EnrolState,
    actions: &mut Vec<EnrolAction>,
) -> Response {
    let theme = Theme::of(ui);
    let (rect, response) = ui.allocate_exact_size(CARD.into(), Sense::click());
    let open = enrol.open.as_ref();
    let is_open = open.is_some_and(|open| open.name.as_str() == shown.name);
    let painter = ui.painter_at(rect);
    let fill = if response.hovered() {
        theme.control_hovered
    } else {
        theme.control
    };
    let edge = match &shown.latest {
        _ if is_open => Stroke::new(1.0, theme.accent),
        Some(_) => Stroke::new(2.0, theme.accepted),
        None => Stroke::new(1.0, theme.edge),
    };
    painter.rect(rect, ROUNDING, fill, edge, StrokeKind::Inside);
    let picture = Rect::from_min_size(rect.min + vec2(6.0, 6.0), vec2(92.0, rect.height() - 12.0));
    if let Some(texture) = shown.texture {
        paint_fitted(&painter, texture, picture);
    } else if shown.is_damaged {
        mark(&painter, picture.center(), 14.0, Mark::Look, theme);
    }
    let mut at = pos2(picture.right() + space::SMALL, rect.top() + 9.0);
    // For the part changed last, show the change in place of the day.
    let (day, colour) = match &shown.latest {
        Some(what) => (what.as_str(), theme.accepted),
        None => (shown.below[0].as_str(), theme.weak_text),
    };
    for (text, font, colour) in [
        (shown.title, font::body_strong(), theme.text),
        (shown.name, font::small(), theme.weak_text),
        (day, font::small(), colour),
        (&shown.below[1], font::small(), theme.weak_text),
    ] {
        let room = rect.right() - space::SMALL - at.x;
        let drawn = fitted_text(&painter, text, &font, room, colour);
        let height = drawn.size().y;
        painter.galley(at, drawn, colour);
        at.y += height + 2.0;
    }
    focus_ring(ui, rect, &response);
    let reference = shown.reference_of;
    let reference = reference.map(|of| text!("enrol-reference-choice", part = of));
    let facts = [&shown.latest, &reference].map(Option::as_deref);
    let facts: Vec<&str> = facts.into_iter().flatten().collect();
    response.widget_info(|| {
        let label = text!("enrol-enrolled", part = shown.title);
        let mut info = egui::WidgetInfo::selected(egui::Role::Button, true, is_open, label);
        info.current_text_value = (!facts.is_empty()).then(|| facts.join(" · "));
        info
    });
    let response = match &reference {
        Some(reference) => response.on_hover_text(reference),
        None => response,
    };
    if response.gained_focus() {
        response.scroll_to_me(None);
    }
    if response.clicked()
        && let Ok(name) = PartName::new(shown.name)
    {
        actions.push(if is_open {
            EnrolAction::Close
        } else {
            EnrolAction::Open(name)
        });
    }
    response
}
