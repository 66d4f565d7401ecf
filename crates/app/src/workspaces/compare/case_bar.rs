//! The bar of the case in front: its verdict, its truth, and the enrolled reference that it is compared with.

use egui::{Button, RichText, Ui, WidgetInfo};

use super::{CompareAction, CompareState, Front, Undo, study::CaseStudy};
use crate::shared::{truth_entries, truth_title};
use records::cases::{CaseOutcome, Truth};
use shell::session::{Session, verdict_mark};
use ui::{
    language::{keys, text},
    theme::{Theme, font, space},
    widgets::{
        Mark, labelled, line_edit, line_mark, menu_button, menu_list, shortened, text_button,
    },
};

/// A bar wider than this has room for a long remark.
const WIDE_BAR_PX: f32 = 800.0;
/// Letters of the reference's title on the menu of references.
const AGAINST: usize = 40;

pub(super) fn ui(
    ui: &mut Ui,
    compare: &CompareState,
    session: &Session,
    acts: &mut Vec<CompareAction>,
) {
    let remark = if ui.available_width() > WIDE_BAR_PX {
        220.0
    } else {
        140.0
    };
    ui.horizontal_wrapped(|ui| {
        case_menu(ui, compare, session, acts);
        let opacity = ui.opacity();
        if compare.is_study_old() {
            ui.multiply_opacity(0.55);
        }
        verdict(ui, compare, session);
        ui.set_opacity(opacity);
        truth_menu(ui, compare, session, acts);
    });
    ui.horizontal_wrapped(|ui| {
        ui.weak(text!("compare-against"));
        against_menu(ui, compare, session, acts);
        ui.add_space(space::MEDIUM);
        case_buttons(ui, compare, remark, acts);
    });
}

fn menu(ui: &mut Ui, title: &str, hover: String, content: &mut dyn FnMut(&mut Ui)) {
    menu_button(ui, title, |ui| {
        ui.set_min_width(220.0);
        menu_list(ui, content);
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
        (Front::Scene, Some(shown)) => shown.inspected.origin.shown_title(),
        (Front::Scene, None) => text!("compare-no-case"),
    };
    let title = format!("{} · {} ▼", text!("compare-case"), shortened(&title, 24));
    menu(ui, &title, text!("compare-case-hint"), &mut |ui| {
        if let Some(shown) = &session.shown {
            let title = text!(
                "compare-in-front",
                scene = shown.inspected.origin.shown_title()
            );
            if ui.selectable_label(is_scene, title).clicked() {
                acts.push(CompareAction::FrontScene);
                ui.close();
            }
        }
        ui.label(RichText::new(text!("compare-kept-cases")).font(font::heading()));
        let cases = compare.cases.as_ref().map(|cases| &*cases.list);
        for case in cases.unwrap_or_default() {
            let is_front = matches!(&compare.front, Front::Kept(front) if front.name == case.name);
            if ui.selectable_label(is_front, &case.name).clicked() {
                acts.push(CompareAction::OpenCase(case.name.clone()));
                ui.close();
            }
        }
        if cases.is_none_or(<[_]>::is_empty) {
            ui.label(text!("compare-no-cases-listed"));
        }
    });
}

/// Draws a verdict such as "taken for Front door, left, accepted, and it is"; the menu of truths beside it ends the
/// sentence.
fn verdict(ui: &mut Ui, compare: &CompareState, session: &Session) {
    let weak = |text: &str| RichText::new(text).weak();
    let Some(study) = &compare.study else {
        ui.label(weak(&text!("compare-asked")));
        return;
    };
    let found = &study.found;
    let strong = |text: &str| RichText::new(text).font(font::body_strong());
    let (verb, part) = match (&found.part, found.accepted) {
        (Some(_), true) => (text!("compare-taken-for"), study.found_title.clone()),
        (Some(_), false) => (text!("compare-nearest-to"), study.found_title.clone()),
        (None, _) => (text!("compare-taken-for"), text!("compare-nothing")),
    };
    ui.label(weak(&verb));
    ui.label(strong(&part));
    let judgement = judged(compare);
    line_mark(ui, 18.0, 8.0, sign(study, judgement));
    let is_wrong = |outcome| matches!(outcome, CaseOutcome::WrongAccepted | CaseOutcome::Refused);
    let asked = match (found.accepted, judgement.map(is_wrong)) {
        (true, None) => text!("compare-accepted-asked"),
        (false, None) => text!("compare-not-accepted-asked"),
        (true, Some(false)) => text!("compare-accepted-right"),
        (false, Some(false)) => text!("compare-not-accepted-right"),
        (true, Some(true)) => text!("compare-accepted-wrong"),
        (false, Some(true)) => text!("compare-not-accepted-wrong"),
    };
    let word = ui.label(weak(&asked));
    if let Some([what, advice]) = study.complaint(session.units) {
        word.on_hover_text(format!("{what}\n{advice}"));
    }
}

/// Whether the verdict of the case in front is right, once its truth is known.
pub(super) fn judged(compare: &CompareState) -> Option<CaseOutcome> {
    let truth = compare.truth.as_ref()?;
    let found = &compare.study.as_ref()?.found;
    Some(CaseOutcome::new(truth, &found.answered()))
}

/// The sign of a verdict. A refusal never gets the mark of an accepted part, even if it is right.
pub(super) fn sign(study: &CaseStudy, judgement: Option<CaseOutcome>) -> Mark {
    let found = &study.found;
    let is_nothing = found.part.is_none() && judgement != Some(CaseOutcome::Refused);
    let is_ok = found.accepted && judgement != Some(CaseOutcome::WrongAccepted);
    verdict_mark((!is_nothing).then_some(is_ok), !study.doubts.is_empty())
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
    let title = match chosen {
        Some(_) => truth_title(chosen, library),
        None => text!("compare-choose-truth"),
    };
    let menu = menu_button(ui, format!("{title} ▼"), |ui| {
        let first = [Some(Truth::NotEnrolled), Some(Truth::Nothing)];
        truth_entries(ui, chosen, &first, library, |truth| {
            acts.extend(truth.map(CompareAction::SetTruth));
        });
    });
    menu.response.on_hover_text(text!("compare-truth-hint"));
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
    let shown = study.filter(|study| study.against.is_some());
    let now = shown.map_or_else(
        || text!("compare-against-none"),
        |study| study.against_title.clone(),
    );
    let chosen = compare.against.as_deref();
    let fitting = shortened(&now, AGAINST);
    let hint = text!("compare-against-hint");
    let hover = if fitting == now {
        hint
    } else {
        format!("{now}\n{hint}")
    };
    menu(ui, &format!("{fitting} ▼"), hover, &mut |ui| {
        let follows = ui.selectable_label(chosen.is_none(), text!("compare-against-follows"));
        if follows.clicked() {
            acts.push(CompareAction::Against(None));
            ui.close();
        }
        for (part, title) in library.parts.iter().zip(library.reference_titles()) {
            let name = part.name.as_str();
            let response = ui.selectable_label(chosen == Some(name), &title);
            response.widget_info(|| {
                let label = text!("compare-against-choice", part = &title);
                WidgetInfo::labeled(egui::Role::Button, true, label)
            });
            if response.clicked() {
                acts.push(CompareAction::Against(Some(name.to_owned())));
                ui.close();
            }
        }
    });
}

/// Draws the remark and the buttons: keep, remove, run all, undo, redo.
fn case_buttons(
    ui: &mut Ui,
    compare: &CompareState,
    remark_width: f32,
    acts: &mut Vec<CompareAction>,
) {
    let theme = Theme::of(ui);
    let key = |text: &str| RichText::new(text).small();
    match &compare.front {
        Front::Scene => {
            let mut remark = compare.remark.clone();
            let label = text!("history-remark");
            let response = ui.add(line_edit(&mut remark, label.clone(), remark_width));
            response.widget_info(|| {
                let mut info = WidgetInfo::text_edit(true, &compare.remark, &remark, &label);
                info.label = Some(label.clone());
                info
            });
            if response.changed() {
                acts.push(CompareAction::Remark(remark));
            }
            let label = text!("compare-keep-case");
            let keep = Button::new(&label).shortcut_text(key("K").weak());
            let hover = if compare.truth.is_some() {
                text!("compare-keep-case-hint")
            } else {
                text!("compare-keep-case-first")
            };
            if labelled(ui, keep, &label).on_hover_text(hover).clicked() {
                acts.push(CompareAction::Keep);
            }
        }
        Front::Kept(case) => {
            let remark = match case.meta.about.remark.as_str() {
                "" => text!("compare-kept-case"),
                remark => shortened(remark, 40),
            };
            ui.weak(remark);
            if text_button(ui, &text!("compare-remove-case")).clicked() {
                acts.push(CompareAction::Remove(case.name.clone()));
            }
        }
    }
    let label = text!("compare-run-all");
    let run = RichText::new(&label).font(font::body_strong());
    let run = Button::new(run.color(theme.on_accent))
        .shortcut_text(key(&keys("Ctrl R")).color(theme.on_accent))
        .fill(theme.accent);
    let run = labelled(ui, run, &label);
    if run.on_hover_text(text!("compare-run-all-hint")).clicked() {
        acts.push(CompareAction::RunAll);
    }
    let undo = compare.undo.done.last();
    let redo = compare.undo.undone.last().map(|_| text!("shell-redo"));
    for (title, shortcut, action) in [
        (undo.map(Undo::title), "Ctrl Z", CompareAction::Undo),
        (redo, "Ctrl Shift Z", CompareAction::Redo),
    ] {
        let Some(title) = title else {
            continue;
        };
        let button = Button::new(&title).shortcut_text(key(&keys(shortcut)).weak());
        if labelled(ui, button, &title).clicked() {
            acts.push(action);
        }
    }
}
