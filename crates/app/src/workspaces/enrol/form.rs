//! The card of the draft: what will be stored, its name, and whether it can be told from the other parts.

use egui::{
    Align, Button, Frame, Layout, Margin, Panel, Rect, RichText, ScrollArea, Ui, pos2, vec2,
};

use super::{
    EnrolAction, EnrolState,
    draft::{Draft, Field, Form},
    fields::{self, complaint, remark},
    meshes::ChosenMesh,
    thumbnails::Thumbnails,
    title_of,
};
use crate::{shared::paint_fitted, shots::summary};
use inspection::library::PartName;
use shell::{language::painted_from, session::Session};
use stages::reference::Coverage;
use ui::{
    language::{advised, described, keys, text, what_and_advice},
    theme::{ROUNDING, Theme, font, space},
    widgets::{Mark, grouped, menu_button, menu_list, sentence, shortened, text_button},
};

/// Draws the card.
pub(super) fn ui(
    ui: &mut Ui,
    enrol: &EnrolState,
    session: &Session,
    thumbnails: &Thumbnails,
    actions: &mut Vec<EnrolAction>,
) {
    let theme = Theme::of(ui);
    let Some(draft) = &enrol.draft else {
        let title = what_save_does(enrol, session);
        ui.label(RichText::new(title).font(font::title()));
        let steps = [
            text!("enrol-step-capture"),
            text!("enrol-step-correct"),
            text!("enrol-step-title"),
            text!("enrol-step-save"),
        ];
        ui.add_space(space::SMALL);
        for step in steps {
            ui.weak(step);
        }
        fixed(ui, session);
        return;
    };
    Panel::bottom("save the draft")
        .resizable(false)
        .show_separator_line(false)
        .frame(Frame::new().inner_margin(Margin {
            top: 8,
            ..Margin::ZERO
        }))
        .show(ui, |ui| buttons(ui, draft, enrol, session, actions));
    // The scroll bar is beside the fields, not over them.
    ui.spacing_mut().scroll.floating_allocated_width = space::SMALL;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.heading(what_save_does(enrol, session));
        if enrol.is_taking_another() {
            let text = RichText::new(text!("enrol-previous-draft"));
            ui.label(text.font(font::body_strong()).color(theme.warning));
        }
        place_among_meshes(ui, draft, actions);
        stored(ui, draft, enrol, session, thumbnails, actions);
        if let Some(field) = fields::ui(ui, &draft.form) {
            actions.push(EnrolAction::Write(field));
        }
        reference_menu(ui, draft, session, actions);
        namesake(ui, draft, enrol, session);
        shared_title(ui, &draft.form, &draft.form.name, session);
        if let Some(fused) = draft.subject.scan() {
            summary(ui, fused, session.units);
        }
        likeness(ui, draft, session, actions);
        let warnings = draft.ready().map(|checked| &checked.enrolled.warnings);
        for warning in warnings.into_iter().flatten() {
            let [what, advice] = what_and_advice(warning);
            complaint(ui, &what, &advice);
        }
        fixed(ui, session);
    });
}

/// Heading: a new part, or the replacement of another.
fn what_save_does(enrol: &EnrolState, session: &Session) -> String {
    enrol.replaced_title(session).map_or_else(
        || text!("enrol-new-part"),
        |title| text!("enrol-replaces", part = title),
    )
}

/// Draws which of several chosen meshes the draft is, and the button to enrol none of the others.
fn place_among_meshes(ui: &mut Ui, draft: &Draft, actions: &mut Vec<EnrolAction>) {
    let numbers = draft.chosen.as_ref().map(ChosenMesh::number_of_all);
    let Some([number, count]) = numbers.filter(|[_, count]| *count > 1) else {
        return;
    };
    ui.label(text!("enrol-mesh-number", number = number, count = count));
    if draft.following().is_some() && text_button(ui, &text!("enrol-mesh-leave-out")).clicked() {
        actions.push(EnrolAction::LeaveOutRest);
    }
}

/// Draws the button that stops replacing a part.
pub(super) fn as_new(ui: &mut Ui, actions: &mut Vec<EnrolAction>) {
    if text_button(ui, &text!("enrol-as-new")).clicked() {
        actions.push(EnrolAction::ReplaceNone);
    }
}

/// Returns why the draft cannot be saved now, and what to do.
fn unready(draft: &Draft, session: &Session) -> Option<String> {
    let library = session.library.as_deref();
    let is_fixed = library.is_some_and(|library| library.is_fixed.is_some());
    let has_no_words = draft.form.title.is_empty() && draft.form.name.is_empty();
    match &draft.checked {
        _ if is_fixed => Some(text!("enrol-unready-library")),
        Some(Err(_)) => Some(text!("enrol-unready-problem")),
        _ if has_no_words => Some(text!("enrol-unready-title")),
        _ if draft.form.words().is_err() => Some(text!("enrol-unready-name")),
        None => Some(text!("enrol-unready-unknown")),
        Some(Ok(_)) => None,
    }
}

/// Draws the picture of what will be stored, and its figures.
fn stored(
    ui: &mut Ui,
    draft: &Draft,
    enrol: &EnrolState,
    session: &Session,
    thumbnails: &Thumbnails,
    actions: &mut Vec<EnrolAction>,
) {
    let theme = Theme::of(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 116.0), egui::Sense::hover());
    let picture = Rect::from_min_size(rect.min, vec2(150.0, rect.height()));
    ui.painter().rect_filled(picture, ROUNDING, theme.canvas);
    let beside = Rect::from_min_max(pos2(picture.right() + space::MEDIUM, rect.top()), rect.max);
    let is_working = enrol.running().is_some();
    if draft.ready().is_some()
        && let Some(texture) = thumbnails.of_draft()
    {
        paint_fitted(ui.painter(), texture, picture.shrink(2.0));
    } else if is_working {
        let spinner = egui::Spinner::new().size(24.0).color(theme.accent);
        ui.put(picture, spinner);
    }
    {
        let ui = &mut ui.new_child(egui::UiBuilder::new().max_rect(beside));
        ui.spacing_mut().item_spacing.y = 2.0;
        let small = |ui: &mut Ui, text: String| {
            let text = RichText::new(text).small().weak();
            ui.add(egui::Label::new(text).wrap());
        };
        small(ui, shortened(&draft.subject.origin.shown_title(), 40));
        if draft.subject.origin.is_simulated() {
            small(ui, sentence(&text!("inspect-simulated")));
        }
        let num_kept = draft.selection.indices.len();
        small(ui, text!("enrol-points-kept", points = grouped(num_kept)));
        if let Some(checked) = draft.ready() {
            let part = &checked.enrolled.part;
            let outline = session.units.length(part.signature.perimeter_m);
            small(ui, text!("enrol-outline", length = outline));
            let openings = part.signature.openings_m.len();
            small(ui, text!("enrol-openings", count = openings));
            small(ui, seen_from(part.meta.coverage));
            for finding in &checked.enrolled.findings {
                small(ui, described(finding));
            }
            if let Some(side) = part.meta.side {
                small(ui, painted_from(side));
            }
        } else if is_working {
            small(ui, text!("enrol-examining"));
        }
    }
    match &draft.checked {
        Some(Err(error)) => {
            let [what, advice] = what_and_advice(error);
            complaint(ui, &what, &advice);
        }
        None if !is_working => {
            remark(ui, Mark::Look, &text!("enrol-stored-unknown"));
            if text_button(ui, &text!("enrol-look-again")).clicked() {
                actions.push(EnrolAction::LookAgain);
            }
        }
        _ => {}
    }
}

fn seen_from(coverage: Coverage) -> String {
    match coverage {
        Coverage::OneSide => text!("enrol-seen-one-side"),
        Coverage::AllAround => text!("enrol-seen-all-around"),
        Coverage::SeveralSides => text!("enrol-seen-several-sides"),
    }
}

/// Draws the menu of parts of which the draft may become another reference; default is a part of its own.
fn reference_menu(ui: &mut Ui, draft: &Draft, session: &Session, actions: &mut Vec<EnrolAction>) {
    let Some(library) = session.library.as_ref().filter(|all| !all.parts.is_empty()) else {
        return;
    };
    let chosen = draft.form.reference_of.as_ref();
    let name = RichText::new(text!("enrol-reference-of")).small();
    ui.label(name.weak());
    let title = |of: Option<&PartName>| match of {
        Some(of) => library.title_of(of.as_str()).to_owned(),
        None => text!("enrol-reference-of-none"),
    };
    let menu = menu_button(ui, format!("{} ▼", shortened(&title(chosen), 30)), |ui| {
        let own = library
            .parts
            .iter()
            .filter(|part| part.reference_of().is_none() && part.name.as_str() != draft.form.name);
        let choices = std::iter::once(None).chain(own.map(|part| Some(&part.name)));
        menu_list(ui, |ui| {
            for of in choices {
                let title = title(of);
                let response = ui.selectable_label(of == chosen, &title);
                response.widget_info(|| {
                    let label = text!("enrol-reference-choice", part = &title);
                    egui::WidgetInfo::labeled(egui::Role::Button, true, label)
                });
                if response.clicked() {
                    let field = Field::ReferenceOf(of.cloned());
                    actions.push(EnrolAction::Write(field));
                    ui.close();
                }
            }
        });
    });
    let label = text!("enrol-reference-of-chosen", part = title(chosen));
    let button = menu.response;
    button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &label));
    button.on_hover_text(text!("enrol-reference-of-hint"));
}

/// Warns if a part other than the one enrolled as `name` has this title.
pub(super) fn shared_title(ui: &mut Ui, form: &Form, name: &str, session: &Session) {
    let library = session.library.as_deref();
    if let Some(shared) = library.and_then(|library| form.shared_title(name, library)) {
        complaint(ui, &described(&shared), &advised(&shared));
    }
}

/// Warns if a part of this name exists already.
fn namesake(ui: &mut Ui, draft: &Draft, enrol: &EnrolState, session: &Session) {
    let library = session.library.as_deref();
    let namesake = library.and_then(|library| draft.form.namesake(library));
    let is_chosen = enrol.replacing.as_ref().map(PartName::as_str) == Some(&draft.form.name);
    if let Some(title) = namesake.filter(|_| !is_chosen) {
        let what = text!("enrol-namesake", part = title);
        complaint(ui, &what, &text!("enrol-namesake-advice"));
    }
}

/// Draws which enrolled part is hardest to tell from the draft.
fn likeness(ui: &mut Ui, draft: &Draft, session: &Session, actions: &mut Vec<EnrolAction>) {
    let library = session.library.as_deref();
    let Some(likeness) = draft.hardest(library) else {
        return;
    };
    let title = title_of(session, &likeness.other);
    let percent = match likeness.score * 100.0 {
        // The score never reaches zero.
        little if little < 1.0 => "< 1".to_owned(),
        percent => format!("{percent:.0}"),
    };
    let text = if likeness.is_mirrored {
        text!(
            "enrol-most-similar-mirrored",
            part = title,
            percent = percent
        )
    } else {
        text!("enrol-most-similar", part = title, percent = percent)
    };
    ui.add_space(space::MEDIUM);
    ui.label(text);
    if likeness.is_distinguishable() {
        remark(ui, Mark::Good, &text!("enrol-distinguishable"));
        return;
    }
    let what = text!("enrol-indistinguishable");
    complaint(ui, &what, &text!("enrol-indistinguishable-advice"));
    if let Ok(name) = PartName::new(&likeness.other) {
        let text = text!("enrol-replace", part = shortened(title, 26));
        if text_button(ui, &text).clicked() {
            actions.push(EnrolAction::Replace(name.clone()));
        }
        let other = library.and_then(|all| all.parts.iter().find(|part| part.name == name));
        let of = other.and_then(|part| part.reference_of()).unwrap_or(&name);
        let title = title_of(session, of.as_str());
        let text = text!("enrol-add-reference", part = shortened(title, 26));
        let is_chosen = draft.form.reference_of.as_ref() == Some(of);
        if !is_chosen && text_button(ui, &text).clicked() {
            actions.push(EnrolAction::Write(Field::ReferenceOf(Some(of.clone()))));
        }
    }
}

/// Warns if nothing can be saved in this library.
pub(super) fn fixed(ui: &mut Ui, session: &Session) {
    let fixed = session
        .library
        .as_ref()
        .and_then(|library| library.is_fixed.as_ref());
    if let Some(problem) = fixed {
        ui.add_space(space::MEDIUM);
        complaint(ui, &problem.what, &problem.advice);
    }
}

fn buttons(
    ui: &mut Ui,
    draft: &Draft,
    enrol: &EnrolState,
    session: &Session,
    actions: &mut Vec<EnrolAction>,
) {
    let theme = Theme::of(ui);
    let unready = unready(draft, session);
    let is_replacing = enrol.replaced_title(session).is_some();
    if is_replacing && enrol.replacing.is_some() {
        as_new(ui, actions);
    }
    let size = vec2(ui.available_width(), 44.0);
    ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
        ui.set_min_height(44.0);
        let discard = match draft.following() {
            Some(_) => text!("enrol-mesh-skip"),
            None => text!("enrol-discard"),
        };
        if text_button(ui, &discard).clicked() {
            actions.push(EnrolAction::Discard);
        }
        let text = match (enrol.is_changing_library(), is_replacing) {
            (true, _) => text!("enrol-saving"),
            (false, true) => text!("enrol-save-and-replace"),
            (false, false) => text!("shell-save"),
        };
        ui.add_enabled_ui(unready.is_none() && !enrol.is_changing_library(), |ui| {
            let key = RichText::new(keys("Ctrl S")).small();
            let save = RichText::new(&text).font(font::body_strong());
            let button = Button::new(save.color(theme.on_accent))
                .shortcut_text(key.color(theme.on_accent))
                .fill(theme.accent)
                .min_size(vec2(ui.available_width(), 44.0));
            let response = ui.add(button);
            let is_enabled = ui.is_enabled();
            response
                .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, is_enabled, &text));
            if response.clicked() {
                actions.push(EnrolAction::Save);
            }
        });
    });
    if let Some(reason) = unready {
        ui.label(RichText::new(reason).color(theme.warning));
    }
}
