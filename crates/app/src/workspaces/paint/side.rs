//! On the right: the part with its two results, the tabs, and what can be done with the path.

use egui::{
    Button, Frame, Id, IntoAtoms, Label, Panel, Popup, Rect, Response, RichText, ScrollArea, Sense,
    Ui, UiBuilder, WidgetInfo, pos2, vec2,
};

use super::{robot, state::PaintState, timeline::minutes, tools, work::Planned};
use crate::{
    shared::panel_frame,
    workspaces::paint::state::{PaintAction, PaintFile, ShownPath},
};
use ::robot::paint::{Coat, CoatGroup, FilmFigures, LEAST_WITHIN};
use inspection::{
    library::Side,
    pipeline::parameters::{Parameters as _, Place},
};
use shell::{
    language::painted_from,
    session::{PaintTab, Session},
};
use stages::reference::Coverage;
use ui::{
    language::{parameters, text, within_sentence},
    parameter_control::{self, fold},
    theme::{Theme, font, space},
    tool_row::{choice, tab_row},
    widgets::{
        Mark, grouped, heading, line_edit, line_mark, menu_button, menu_list, row, shortened,
        text_button,
    },
};

/// Characters of a part's title on its menu.
pub(super) const TITLE: usize = 26;

/// Room above and below the buttons for the path, logical pixels.
const BUTTON_MARGINS: [i8; 2] = [8, 12];

/// Draws the panel, from top to bottom: the key focus moves in the order in which controls are drawn.
pub(super) fn ui(
    ui: &mut Ui,
    paint: &PaintState,
    session: &Session,
    actions: &mut Vec<PaintAction>,
) {
    let theme = Theme::of(ui);
    let frame = |top, bottom| panel_frame(theme, top, bottom);
    Panel::top("paint head")
        .resizable(false)
        .frame(frame(12, 4))
        .show(ui, |ui| head(ui, paint, session, actions));
    // Without margins at the sides: titles are long in some languages.
    let shown = session.paint_tab;
    let tabs = PaintTab::ALL.map(|tab| (tab, tab_title(tab)));
    Panel::top("paint tabs")
        .resizable(false)
        .frame(Frame::new().fill(theme.panel))
        .show(ui, |ui| {
            if let Some(tab) = tab_row(ui, &tabs, shown) {
                actions.push(PaintAction::ShowTab(tab));
            }
        });
    let [above, below] = BUTTON_MARGINS;
    let num_rows = if paint.stored(session).is_some() {
        3.0
    } else {
        2.0
    };
    let height = num_rows * space::TARGET + (num_rows - 1.0) * ui.spacing().item_spacing.y;
    let room = ui.available_rect_before_wrap();
    let bottom = room.bottom() - height - f32::from(above) - f32::from(below);
    let bottom = bottom.max(room.top());
    ui.scope_builder(UiBuilder::new().max_rect(room.with_max_y(bottom)), |ui| {
        frame(0, 4).show(ui, |ui| {
            ScrollArea::vertical()
                .id_salt(shown)
                .auto_shrink(false)
                .show(ui, |ui| {
                    ui.set_max_width(ui.available_width() - 8.0);
                    match shown {
                        PaintTab::Coat => coat(ui, paint, actions),
                        PaintTab::Regions => tools::regions(ui, paint, actions),
                        PaintTab::Robot => robot::ui(ui, paint, session, actions),
                        PaintTab::Film => film(ui, paint, session),
                    }
                });
        });
    });
    ui.scope_builder(UiBuilder::new().max_rect(room.with_min_y(bottom)), |ui| {
        frame(above, below).show(ui, |ui| buttons(ui, paint, session, actions));
    });
    let painter = ui.painter();
    painter.hline(room.x_range(), bottom, theme.edge_stroke());
}

fn tab_title(tab: PaintTab) -> String {
    match tab {
        PaintTab::Coat => text!("paint-coat"),
        PaintTab::Regions => text!("paint-regions"),
        PaintTab::Robot => text!("paint-robot"),
        PaintTab::Film => parameters::coat_group(CoatGroup::Film),
    }
}

/// Draws the part, and whether its film is good and the arm reaches its path.
fn head(ui: &mut Ui, paint: &PaintState, session: &Session, actions: &mut Vec<PaintAction>) {
    let theme = Theme::of(ui);
    let Some(library) = &session.library else {
        ui.label(text!("shell-library-loading"));
        return;
    };
    if library.parts.is_empty() {
        ui.label(text!("paint-no-part"));
        return;
    }
    let chosen = paint.part(session);
    let none = text!("shell-no-part");
    let title = chosen.map_or(none.as_str(), |part| library.title_of(part.as_str()));
    let text = RichText::new(format!("{} ▼", shortened(title, TITLE))).font(font::verdict());
    let label = text!("paint-part", part = title);
    menu(ui, text, &label, text!("paint-part-hint"), |ui| {
        menu_list(ui, |ui| {
            for meta in &library.parts {
                let is_chosen = chosen == Some(&meta.name);
                if ui
                    .selectable_label(is_chosen, library.title_of(meta.name.as_str()))
                    .clicked()
                {
                    actions.push(PaintAction::ChoosePart(meta.name.clone()));
                    ui.close();
                }
            }
        });
    });
    ui.spacing_mut().interact_size.y = 0.0;
    if chosen.is_none() {
        let text = RichText::new(text!("paint-recognised-gone")).color(theme.warning);
        ui.add(Label::new(text).wrap());
        return;
    }
    if let Some(part) = paint.enrolled(session)
        && part.coverage == Coverage::AllAround
    {
        side_menu(ui, part.side, paint, actions);
    }
    if let Some(failed) = &paint.failed {
        let text = RichText::new(&failed.what).color(theme.rejected);
        ui.add(Label::new(text).wrap());
        let advice = RichText::new(&failed.advice);
        ui.add(Label::new(advice).wrap());
        return;
    }
    let Some(planned) = &paint.planned else {
        let text = if paint.is_planning() {
            text!("paint-planning")
        } else {
            text!("paint-not-planned")
        };
        ui.add(Label::new(RichText::new(text).weak()).wrap());
        return;
    };
    let is_old = paint.is_old(session);
    dimmed(ui, is_old, |ui| film_verdict(ui, planned));
    // In place of the scope, so that nothing below moves while a parameter is changed.
    let note = if is_old {
        RichText::new(text!("paint-previous-path")).color(theme.warning)
    } else {
        let scope = match planned.surface.coverage {
            Coverage::OneSide => text!("paint-scope-one-side"),
            Coverage::AllAround => text!("paint-scope-all-around"),
            Coverage::SeveralSides => text!("paint-scope-several-sides"),
        };
        RichText::new(scope).weak()
    };
    ui.add(Label::new(note.small()).wrap());
    dimmed(ui, is_old, |ui| robot::verdict(ui, paint, session));
}

/// Draws what belongs to a former path dimmed.
fn dimmed(ui: &mut Ui, is_old: bool, content: impl FnOnce(&mut Ui)) {
    ui.scope(|ui| {
        if is_old {
            ui.multiply_opacity(0.55);
        }
        content(ui);
    });
}

/// Draws the share of the surface whose film is within the coat's tolerance.
fn film_verdict(ui: &mut Ui, planned: &Planned) {
    let (film, coat) = (&planned.film.figures, &planned.coat);
    let sign = if film.within >= LEAST_WITHIN {
        Mark::Good
    } else {
        Mark::Bad
    };
    let micrometres = |metres: f64| format!("{:.0}", 1e6 * metres);
    let words = text!(
        "paint-film-within",
        share = percent(film.within),
        target = micrometres(coat.target),
        tolerance = micrometres(coat.target * coat.tolerance)
    );
    let least = format!("{:.0}", 100.0 * LEAST_WITHIN);
    verdict(ui, sign, &words).on_hover_text(text!("paint-film-within-hint", least = least));
}

/// Draws a result with a mark that shows whether it keeps to its limit.
pub(super) fn verdict(ui: &mut Ui, sign: Mark, words: &str) -> Response {
    let colour = sign.colour(Theme::of(ui));
    let shown = ui.horizontal_top(|ui| {
        line_mark(ui, 18.0, 7.0, sign);
        ui.vertical(|ui| {
            let text = RichText::new(words).font(font::body_strong()).color(colour);
            ui.add(Label::new(text).wrap())
        })
        .inner
    });
    shown.inner
}

/// Draws the side that a part known all around is painted from, as a menu of all sides.
fn side_menu(
    ui: &mut Ui,
    stored: Option<Side>,
    paint: &PaintState,
    actions: &mut Vec<PaintAction>,
) {
    let planned = paint.planned.as_ref();
    let shown = stored.or_else(|| Some(planned?.surface.painted_side()));
    let label = shown.map_or_else(|| text!("paint-side-none"), painted_from);
    let text = RichText::new(format!("{label} ▼"));
    menu(ui, text, &label, text!("paint-side-hint"), |ui| {
        for side in Side::ALL {
            let is_chosen = Some(side) == shown;
            if ui.selectable_label(is_chosen, painted_from(side)).clicked() {
                actions.push(PaintAction::ChooseSide(side));
                ui.close();
            }
        }
    });
}

/// Draws the tab of the coat: its name and every parameter.
fn coat(ui: &mut Ui, paint: &PaintState, actions: &mut Vec<PaintAction>) {
    let design = &paint.design;
    ui.add_space(space::SMALL);
    ui.horizontal(|ui| {
        let kept = design.kept.name.as_str();
        let title = parameters::coat_title(kept);
        let name = if design.is_coat_changed() {
            text!("paint-coat-changed", coat = title)
        } else {
            title
        };
        let text = format!("{} ▼", shortened(&name, TITLE));
        let label = text!("paint-coat-named", coat = name);
        let notes = parameters::coat_notes(&design.kept.notes);
        menu(ui, text, &label, notes, |ui| {
            for coat in &paint.coats {
                let title = parameters::coat_title(coat);
                if ui.selectable_label(coat == kept, title).clicked() {
                    actions.push(PaintAction::ChooseCoat(coat.clone()));
                    ui.close();
                }
            }
            ui.separator();
            if ui.button(text!("shell-save-as")).clicked() {
                actions.push(PaintAction::Name(Some(String::new())));
                ui.close();
            }
        });
        if design.is_coat_changed() && text_button(ui, &text!("shell-reset")).clicked() {
            actions.push(PaintAction::ResetCoat);
        }
    });
    if let Some(naming) = &paint.naming {
        name_ui(ui, naming, actions);
    }
    tools::pattern(ui, paint, actions);
    // Most frequently changed first.
    for group in [CoatGroup::Path, CoatGroup::Film, CoatGroup::Gun] {
        parameters_of(ui, group, paint, actions);
    }
}

/// Draws a button with a menu, which closes once the button is scrolled out of view: it would stay elsewhere in the window.
pub(super) fn menu(
    ui: &mut Ui,
    text: impl IntoAtoms<'static>,
    label: &str,
    hint: String,
    entries: impl FnOnce(&mut Ui),
) {
    let button = menu_button(ui, text, entries).response;
    if !ui.is_rect_visible(button.rect) {
        Popup::close_id(ui.ctx(), Popup::default_response_id(&button));
    }
    button.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, label));
    button.on_hover_text(hint);
}

/// Draws the field for the coat's name.
fn name_ui(ui: &mut Ui, naming: &str, actions: &mut Vec<PaintAction>) {
    let mut written = naming.to_owned();
    let id = Id::unique("name of the coat");
    let is_new = ui.ctx().read_response(id).is_none();
    ui.horizontal_wrapped(|ui| {
        let edit = line_edit(&mut written, text!("paint-coat-name"), 150.0);
        let response = ui.add(edit.id(id));
        // Without the focus, typed keys would act as shortcuts.
        if is_new {
            response.request_focus();
        }
        response.widget_info(|| {
            let mut info = WidgetInfo::text_edit(true, naming, &written, text!("paint-coat-name"));
            info.label = Some(text!("paint-coat-name"));
            info
        });
        let is_entered =
            response.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
        if written != naming {
            actions.push(PaintAction::Name(Some(written.clone())));
        }
        if text_button(ui, &text!("shell-save")).clicked() || is_entered {
            actions.push(PaintAction::SaveCoat);
        }
        if text_button(ui, &text!("shell-cancel")).clicked() {
            actions.push(PaintAction::Name(None));
        }
    });
}

/// Draws the parameters of a group, the less used ones folded.
fn parameters_of(
    ui: &mut Ui,
    group: CoatGroup,
    paint: &PaintState,
    actions: &mut Vec<PaintAction>,
) {
    let theme = Theme::of(ui);
    let is_here = |key: &str| key != tools::PATTERN;
    let of = |place: Place| {
        let all = Coat::ALL.iter();
        all.filter(move |p| p.group == group && p.place == place && is_here(p.key))
    };
    let design = &paint.design;
    let mut control = |ui: &mut Ui, parameter| {
        let (coat, kept) = (&design.coat, &design.kept.recipe);
        parameter_control::control(ui, parameter, coat, kept, &mut |change| {
            actions.push(PaintAction::Change(parameter.key, change));
        });
    };
    let title = parameters::coat_group(group);
    heading(ui, &title);
    for parameter in of(Place::Front) {
        control(ui, parameter);
    }
    let num = of(Place::Fold).count();
    if num == 0 {
        return;
    }
    let more = text!("shell-more", group = within_sentence(&title), count = num);
    fold(ui, more, theme.weak_text)
        .id_salt(group.title())
        .show_unindented(ui, |ui| {
            for parameter in of(Place::Fold) {
                control(ui, parameter);
            }
        });
}

/// Draws the tab of the film: its figures, and those of the path that leaves it.
fn film(ui: &mut Ui, paint: &PaintState, session: &Session) {
    let Some(planned) = &paint.planned else {
        return;
    };
    let (film, takes) = (&planned.film.figures, &planned.film.path);
    let micrometres = |metres: f64| format!("{:.1}", 1e6 * metres);
    let share = |share: f64| format!("{} %", percent(share));
    let of_film = [
        (
            text!("paint-thinnest-thickest"),
            format!("{} · {} µm", micrometres(film.min), micrometres(film.max)),
        ),
        (
            text!("paint-mean"),
            format!("{} µm", micrometres(film.mean)),
        ),
        (text!("paint-missed"), share(film.missed)),
        (text!("paint-double"), share(film.double)),
        (text!("paint-paintable"), share(film.paintable)),
    ];
    let of_path = [
        (text!("paint-landed"), share(takes.landed)),
        (text!("paint-time"), minutes(takes.time)),
        (text!("paint-points"), grouped(planned.path.points().len())),
    ];
    dimmed(ui, paint.is_old(session), |ui| {
        heading(ui, &text!("paint-histogram"));
        histogram(ui, film, planned.coat.tolerance);
        for (name, value) in of_film {
            row(ui, &name, &value);
        }
        heading(ui, &parameters::coat_group(CoatGroup::Path));
        for (name, value) in of_path {
            row(ui, &name, &value);
        }
    });
}

/// Draws the shares of the surface by thickness; those within tolerance are highlighted.
fn histogram(ui: &mut Ui, film: &FilmFigures, tolerance: f64) {
    let theme = Theme::of(ui);
    let size = vec2(ui.available_width(), 52.0);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, text!("paint-histogram")));
    let response = response.on_hover_text(text!("paint-histogram-hint"));
    let painter = ui.painter_at(response.rect);
    let most = film.histogram.iter().copied().fold(1e-9, f64::max);
    let plot = rect.with_max_y(rect.bottom() - 14.0);
    let num = film.histogram.len();
    let width = plot.width() / num as f32;
    for (i, share) in film.histogram.iter().enumerate() {
        let left = plot.left() + i as f32 * width;
        let height = (share / most) as f32 * plot.height();
        let bar = Rect::from_min_max(
            pos2(left + 0.5, plot.bottom() - height),
            pos2(left + width - 0.5, plot.bottom()),
        );
        // Bars are a tenth of the target each.
        let middle = (i as f64 + 0.5) / 10.0;
        let is_within = (middle - 1.0).abs() <= tolerance;
        let colour = if is_within {
            theme.accepted
        } else {
            theme.weak_text
        };
        painter.rect_filled(bar, 0.0, colour);
    }
    painter.hline(plot.x_range(), plot.bottom(), theme.edge_stroke());
    for (share, text, anchor) in [
        (0.0, "0", egui::Align2::LEFT_TOP),
        (1.0, "100 %", egui::Align2::CENTER_TOP),
        (2.0, "200 %", egui::Align2::RIGHT_TOP),
    ] {
        let x = plot.left() + plot.width() * share / (num as f32 / 10.0);
        let at = pos2(x, plot.bottom() + 1.0);
        painter.text(at, anchor, text, font::scale(), theme.weak_text);
    }
}

fn percent(share: f64) -> String {
    format!("{:.1}", 100.0 * share)
}

/// Draws the buttons for the path.
fn buttons(ui: &mut Ui, paint: &PaintState, session: &Session, actions: &mut Vec<PaintAction>) {
    let theme = Theme::of(ui);
    if let Some(stored) = paint.stored(session) {
        ui.horizontal(|ui| {
            let count = stored.points().len();
            for (text, path) in [
                (text!("paint-planned-path"), ShownPath::Planned),
                (text!("paint-stored-path", count = count), ShownPath::Stored),
            ] {
                let is_chosen = paint.shown_path == path;
                if choice(ui, &text, &text, is_chosen, true).clicked() {
                    actions.push(PaintAction::Show(path));
                }
            }
        });
    }
    let is_ready = paint.planned.is_some() && !paint.is_old(session);
    let unready = (!is_ready).then(|| match &paint.failed {
        Some(failed) => failed.what.clone(),
        None if paint.is_planning() => text!("paint-planning"),
        None => text!("paint-not-planned"),
    });
    let half = (ui.available_width() - space::SMALL) / 2.0;
    ui.horizontal(|ui| {
        let export = button(ui, &text!("shell-export"), is_ready, half, None);
        let export = export
            .on_hover_text(text!("paint-export-hint"))
            .on_disabled_hover_text(unready.clone().unwrap_or_default());
        if export.clicked() {
            actions.push(PaintAction::Ask(PaintFile::Table));
        }
        let can = is_ready && session.robot.is_some();
        let program = button(ui, &text!("paint-export-program"), can, half, None);
        let why_not = unready.clone();
        let program = program
            .on_hover_text(text!("paint-export-program-hint"))
            .on_disabled_hover_text(why_not.unwrap_or_else(|| text!("paint-not-calibrated")));
        if program.clicked() {
            actions.push(PaintAction::Ask(PaintFile::Program));
        }
    });
    let store = text!("shell-store");
    let library = session.library.as_ref();
    let fixed = library.and_then(|library| library.is_fixed.as_ref());
    let is_stored = paint.is_stored();
    let can = is_ready && fixed.is_none() && !paint.is_storing() && !is_stored;
    let can_propose = paint.planned.is_some() || paint.failed.is_some() || !paint.is_planning();
    let response = ui.horizontal(|ui| {
        let propose = button(ui, &text!("paint-propose"), can_propose, half, None);
        let propose = propose
            .on_hover_text(text!("paint-propose-hint"))
            .on_disabled_hover_text(text!("paint-planning"));
        if propose.clicked() {
            actions.push(PaintAction::Propose);
        }
        button(ui, &store, can, half, Some(theme))
    });
    let response = response.inner;
    // The button shows a shorter text.
    let whole = text!("paint-store");
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, can, &whole));
    let reason = match (fixed, is_stored) {
        (Some(fixed), _) => format!("{}\n{}", fixed.what, fixed.advice),
        (None, true) => text!("paint-is-stored"),
        (None, false) if paint.is_storing() => text!("paint-storing"),
        (None, false) => unready.unwrap_or_default(),
    };
    let response = response
        .on_hover_text(text!("paint-store-hint"))
        .on_disabled_hover_text(reason);
    if response.clicked() {
        actions.push(PaintAction::Store);
    }
}

/// Draws a button of this width, in the theme's accent colour if a theme is given.
fn button(ui: &mut Ui, label: &str, can: bool, width: f32, accent: Option<&Theme>) -> Response {
    let text = RichText::new(label).font(font::body_strong());
    let button = match accent.filter(|_| can) {
        Some(theme) => Button::new(text.color(theme.on_accent)).fill(theme.accent),
        None => Button::new(text),
    };
    let response = ui.add_enabled(can, button.min_size(vec2(width, space::TARGET)));
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, can, label));
    response
}
