//! The case in front: what it was taken for, what it truly is, and what it is compared with.

use egui::{Button, RichText, ScrollArea, Sense, TextEdit, Ui, Vec2, WidgetInfo};

use super::{CompareAction, CompareState, Front, matrix::truth_title};
use crate::{
    app::{
        inspection::library_cache::LibraryView,
        shell::session::Session,
        ui::{
            theme::{Theme, font, space},
            widgets::{Mark, labelled, mark, shortened},
        },
    },
    cases::{CaseAnswer, CaseOutcome, Truth},
};

/// A bar wider than this has room for a long remark.
const WIDE: f32 = 800.0;

/// What is asked while nobody said what the case is.
const ASKED: &str = "which part is it actually?";

/// Draws the bar.
pub(super) fn ui(
    ui: &mut Ui,
    compare: &CompareState,
    session: &Session,
    theme: &Theme,
    acts: &mut Vec<CompareAction>,
) {
    let remark = if ui.available_width() > WIDE {
        220.0
    } else {
        140.0
    };
    ui.horizontal_wrapped(|ui| {
        case_menu(ui, compare, session, acts);
        verdict(ui, compare, session, theme);
        truth_menu(ui, compare, session, acts);
    });
    ui.horizontal_wrapped(|ui| {
        ui.label(RichText::new("against").color(theme.weak_text));
        against_menu(ui, compare, session, acts);
        ui.add_space(space::MEDIUM);
        case_buttons(ui, compare, remark, theme, acts);
    });
}

fn menu(ui: &mut Ui, title: &str, hover: &str, content: &mut dyn FnMut(&mut Ui)) {
    ui.menu_button(title, |ui| {
        ui.set_min_width(220.0);
        ScrollArea::vertical().max_height(420.0).show(ui, content);
    })
    .response
    .on_hover_text(hover);
}

fn case_menu(
    ui: &mut Ui,
    compare: &CompareState,
    session: &Session,
    acts: &mut Vec<CompareAction>,
) {
    let is_scene = matches!(compare.front, Front::Scene);
    let title = match (&compare.front, &session.shown) {
        (Front::Kept(case), _) => case.name.clone(),
        (Front::Scene, Some(shown)) => shown.inspected.origin.title(),
        (Front::Scene, None) => "none".into(),
    };
    let title = format!("Case · {} ▼", shortened(&title, 24));
    menu(ui, &title, "Which scene is looked at", &mut |ui| {
        if let Some(shown) = &session.shown {
            let title = format!("{} (in front)", shown.inspected.origin.title());
            if ui.selectable_label(is_scene, title).clicked() {
                acts.push(CompareAction::FrontScene);
                ui.close();
            }
        }
        ui.label(RichText::new("Kept cases").font(font::heading()));
        let cases = compare.cases.as_ref().map(|cases| &*cases.list);
        for case in cases.unwrap_or_default() {
            let is_front = matches!(&compare.front, Front::Kept(front) if front.name == case.name);
            if ui.selectable_label(is_front, &case.name).clicked() {
                acts.push(CompareAction::OpenCase(case.name.clone()));
                ui.close();
            }
        }
        if cases.is_none_or(<[_]>::is_empty) {
            ui.label("None yet");
        }
    });
}

/// "taken for Front door, left, accepted, and it is": a sentence that the menu beside it ends, or answers.
fn verdict(ui: &mut Ui, compare: &CompareState, session: &Session, theme: &Theme) {
    let weak = |text: &str| RichText::new(text).color(theme.weak_text);
    let Some(study) = &compare.study else {
        ui.label(weak(ASKED));
        return;
    };
    let found = &study.found;
    let strong = |text: &str| {
        RichText::new(text)
            .font(font::body_strong())
            .color(theme.text)
    };
    let (verb, part) = match (&found.part, found.accepted) {
        (Some(_), true) => ("taken for", study.found_title.as_str()),
        (Some(_), false) => ("nearest to", study.found_title.as_str()),
        (None, _) => ("taken for", "nothing"),
    };
    ui.label(weak(verb));
    ui.label(strong(part));
    let judgement = judged(compare);
    // What was refused, rightly or not, does not look accepted.
    let sign = if found.accepted && judgement != Some(CaseOutcome::WrongAccepted) {
        Mark::Good
    } else {
        Mark::Bad
    };
    let (rect, _) = ui.allocate_exact_size(Vec2::splat(18.0), Sense::hover());
    mark(ui.painter(), rect.center(), 8.0, sign, theme);
    let word = if found.accepted {
        "accepted"
    } else {
        "not accepted"
    };
    let asked = match judgement {
        None => format!("{word} · {ASKED}"),
        Some(CaseOutcome::Right) => format!("{word}, and it is"),
        Some(CaseOutcome::WrongAccepted | CaseOutcome::Refused) => format!("{word}, but it is"),
    };
    let word = ui.label(weak(&asked));
    if let Some(refusal) = study.refusal(session.units) {
        word.on_hover_text(format!("{refusal}\n{}", study.advice));
    }
}

/// Whether the verdict of the case in front is right, once its truth is known.
pub(super) fn judged(compare: &CompareState) -> Option<CaseOutcome> {
    let truth = compare.truth.as_ref()?;
    let found = &compare.study.as_ref()?.found;
    let answered: CaseAnswer = found.answered();
    Some(CaseOutcome::of(truth, &answered))
}

/// What a truth is called where it is chosen.
fn chosen_title(truth: &Truth, library: &LibraryView) -> String {
    match truth {
        Truth::Nothing => "Nothing (empty cell)".into(),
        Truth::Part(_) | Truth::NotEnrolled => truth_title(truth, library),
    }
}

fn truth_menu(
    ui: &mut Ui,
    compare: &CompareState,
    session: &Session,
    acts: &mut Vec<CompareAction>,
) {
    let Some(library) = &session.library else {
        return;
    };
    let chosen = compare.truth.as_ref();
    let title = chosen.map_or_else(
        || "Choose… ▼".to_owned(),
        |truth| format!("{} ▼", chosen_title(truth, library)),
    );
    menu(
        ui,
        &title,
        "What actually hung in front of the camera",
        &mut |ui| {
            let parts = library.parts.iter();
            let parts = parts.map(|part| Truth::Part(part.name.as_str().to_owned()));
            // However many parts there are, what is none of them comes in sight first.
            let others = [Truth::NotEnrolled, Truth::Nothing];
            let num_others = others.len();
            for (place, truth) in others.into_iter().chain(parts).enumerate() {
                if place == num_others {
                    ui.separator();
                }
                let title = chosen_title(&truth, library);
                let response = ui.selectable_label(chosen == Some(&truth), &title);
                // Other lists name the same parts.
                response.widget_info(|| {
                    let label = format!("Actual part: {title}");
                    WidgetInfo::labeled(egui::Role::Button, true, label)
                });
                if response.clicked() {
                    acts.push(CompareAction::SetTruth(truth));
                    ui.close();
                }
            }
        },
    );
}

fn against_menu(
    ui: &mut Ui,
    compare: &CompareState,
    session: &Session,
    acts: &mut Vec<CompareAction>,
) {
    let Some(library) = &session.library else {
        return;
    };
    let study = compare.study.as_ref();
    let shown = study.and_then(|study| study.against.as_deref());
    let now = shown.and_then(|part| library.place_of(part));
    let now = now.map_or("no part", |place| library.title(place));
    let chosen = compare.against.as_deref();
    let hover = "The enrolled part that the case is compared with";
    menu(ui, &format!("{now} ▼"), hover, &mut |ui| {
        let follows = ui.selectable_label(chosen.is_none(), "What it is, else the best");
        if follows.clicked() {
            acts.push(CompareAction::Against(None));
            ui.close();
        }
        for part in &library.parts {
            let name = part.name.as_str();
            let title = part.shown_title();
            let response = ui.selectable_label(chosen == Some(name), title);
            response.widget_info(|| {
                let label = format!("Against: {title}");
                WidgetInfo::labeled(egui::Role::Button, true, label)
            });
            if response.clicked() {
                acts.push(CompareAction::Against(Some(name.to_owned())));
                ui.close();
            }
        }
    });
}

/// What can be done with the case, and with all of them.
fn case_buttons(
    ui: &mut Ui,
    compare: &CompareState,
    remark_width: f32,
    theme: &Theme,
    acts: &mut Vec<CompareAction>,
) {
    let key = |text: &str| RichText::new(text).font(font::small());
    match &compare.front {
        Front::Scene => {
            let mut remark = compare.remark.clone();
            let edit = TextEdit::singleline(&mut remark)
                .hint_text("Remark")
                .desired_width(remark_width)
                .align(egui::Align2::LEFT_CENTER)
                .min_size(Vec2::new(0.0, space::TARGET));
            let response = ui.add(edit);
            response.widget_info(|| {
                let mut info = WidgetInfo::text_edit(true, &compare.remark, &remark, "Remark");
                info.label = Some("Remark".into());
                info
            });
            if response.changed() {
                acts.push(CompareAction::Remark(remark));
            }
            let keep = Button::new("Keep case").shortcut_text(key("K").color(theme.weak_text));
            let hover = if compare.truth.is_some() {
                "Keep this scene with its actual part"
            } else {
                "Choose first what it is"
            };
            if labelled(ui, keep, "Keep case")
                .on_hover_text(hover)
                .clicked()
            {
                acts.push(CompareAction::Keep);
            }
        }
        Front::Kept(case) => {
            let remark = match case.meta.about.remark.as_str() {
                "" => "Kept case".to_owned(),
                remark => shortened(remark, 40),
            };
            ui.label(RichText::new(remark).color(theme.weak_text));
            if labelled(ui, Button::new("Remove case"), "Remove case").clicked() {
                acts.push(CompareAction::Remove(case.name.clone()));
            }
        }
    }
    let run = RichText::new("Run all cases").font(font::body_strong());
    let run = Button::new(run.color(theme.on_accent))
        .shortcut_text(key("Ctrl R").color(theme.on_accent))
        .fill(theme.accent);
    let run = labelled(ui, run, "Run all cases");
    if run
        .on_hover_text("Inspect every kept case with the recipe on the right")
        .clicked()
    {
        acts.push(CompareAction::RunAll);
    }
    if let Some(undo) = &compare.undo {
        let button = Button::new(undo.title()).shortcut_text(key("Ctrl Z").color(theme.weak_text));
        if labelled(ui, button, undo.title()).clicked() {
            acts.push(CompareAction::Undo);
        }
    }
}
