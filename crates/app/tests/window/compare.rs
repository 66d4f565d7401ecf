//! The Compare workspace, tested by its labels and controls. Needs no graphics adapter.

use std::path::Path;

use app::{
    WindowOptions,
    workspaces::{
        compare::{CompareAction, CompareState, CompareWorkspace, Front, RecipeAction},
        history::{HistoryAction, HistoryWorkspace},
    },
};
use egui::{Key, Modifiers, Role, Vec2};
use egui_kittest::{
    Node,
    kittest::{NodeT as _, Queryable as _},
};
use inspection::{
    library::PartName,
    pipeline::{Recipe, RecipeFile, RecipeFolder, Replace},
};
use records::cases::{CaseDescription, CaseFolder, FoundVerdict, Truth};
use shell::{action::Action, inspection::source::CellChoice, session::WorkspaceKind};
use simulate::{CellSetup, ObjectKind, PartKind, Side};

use stages::fixtures::scene_of;

use super::set_up::{
    SMALL, USUAL, WindowHarness, act, act_in, history_of, let_pass, open_with, plain_options,
    press, settle, wait_for,
};

fn open_at(size: Vec2, cases: &Path) -> WindowHarness {
    let options = WindowOptions {
        cases: Some(cases.to_owned()),
        ..plain_options()
    };
    open_with(size, options)
}

fn open(cases: &Path) -> WindowHarness {
    open_at(USUAL, cases)
}

fn own(harness: &WindowHarness) -> &CompareState {
    let workspace = harness.state().workspace::<CompareWorkspace>();
    &workspace.expect("the workspace").state
}

fn act_in_compare(harness: &mut WindowHarness, action: CompareAction) {
    act_in(harness, |workspace: &mut CompareWorkspace, cx| {
        workspace.state.apply(action, cx);
    });
}

/// Shows a scene of the simulated cell.
fn show(harness: &mut WindowHarness, choice: CellChoice) {
    act(harness, Action::UseCell(choice));
}

fn keep(harness: &mut WindowHarness, choice: CellChoice, truth: &str) {
    show(harness, choice);
    press(harness, "Choose… ▼");
    press(harness, &format!("Actual part: {truth}"));
    press(harness, "Keep case");
}

fn found(harness: &WindowHarness) -> Option<String> {
    let study = own(harness).study.as_ref();
    study.expect("a study").found.part.clone()
}

const FENDER: CellChoice = CellChoice::Part(PartKind::Fender, Side::Left);
const DOOR: CellChoice = CellChoice::Part(PartKind::FrontDoor, Side::Left);

#[test]
fn a_case_is_kept_run_and_opened_again_from_its_cell() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open(folder.path());
    press(&mut harness, "Compare");
    harness.get_by_label_contains("Contours at the best lag");
    harness.get_by_label_contains("No kept cases in");
    assert!(own(&harness).study.is_some());

    // Without a true label no case is kept.
    harness.key_press(Key::K);
    settle(&mut harness);
    harness.get_by_label("First choose what it is");
    assert!(
        CaseFolder::at(folder.path())
            .list()
            .expect("listed")
            .cases
            .is_empty()
    );

    press(&mut harness, "Choose… ▼");
    press(&mut harness, "Actual part: Fender, left");
    // Once it is chosen, nobody has to be told to choose it.
    assert!(harness.query_by_label("First choose what it is").is_none());
    keep(
        &mut harness,
        CellChoice::Foreign(ObjectKind::Hood),
        "Not enrolled",
    );
    keep(&mut harness, DOOR, "Front door, left");
    // With another part as its label, it is a false accept.
    show(&mut harness, FENDER);
    press(&mut harness, "Choose… ▼");
    press(&mut harness, "Actual part: Back door, left");
    harness.key_press(Key::K);
    settle(&mut harness);
    let list = CaseFolder::at(folder.path()).list().expect("listed");
    let truths: Vec<_> = list
        .cases
        .iter()
        .map(|case| &case.meta.about.truth)
        .collect();
    assert_eq!(
        truths,
        [
            &Truth::NotEnrolled,
            &Truth::Part("front_door".into()),
            &Truth::Part("back_door".into())
        ]
    );
    assert!(list.cases.iter().all(|case| case.meta.about.simulated));

    harness.key_press_modifiers(Modifiers::COMMAND, Key::R);
    settle(&mut harness);
    let run = own(&harness).run.clone().expect("run");
    assert!(run.ended.is_some() && run.results.len() == 3);
    harness.get_by_label("1 false accept");
    harness.get_by_label_contains("of 3 right");
    harness.get_by_label_contains("Calibration: expected error 0.");
    // The same recipe gives the same result as when the case was kept, to the last bit.
    for (result, case) in run.results.iter().zip(&list.cases) {
        assert_eq!(result.found, case.meta.about.found);
    }

    let cell = "Back door, left taken for Fender, left: 1, false accept";
    harness.get_by_label(cell).focus();
    harness.run_steps(1);
    harness.key_press(Key::Enter);
    settle(&mut harness);
    let name = list.cases[2].name.clone();
    press(&mut harness, &format!("Open {name}"));
    let compare = own(&harness);
    assert!(matches!(&compare.front, Front::Kept(case) if case.name == name));
    let study = compare.study.as_ref().expect("a study");
    assert_eq!(study.found, list.cases[2].meta.about.found);
    // It is compared with its label.
    assert_eq!(study.against.as_deref(), Some("back_door"));
    press(&mut harness, "Back to matrix");
    harness.get_by_label(cell);
    // The rows are named in the language of the window, whatever it was during the run.
    harness.get_by_label("Not enrolled, not accepted: 1, right");
    press(&mut harness, "Language: English");
    press(&mut harness, "Deutsch");
    harness.get_by_label("Nicht eingelernt, nicht akzeptiert: 1, richtig");
    press(&mut harness, "Sprache: Deutsch");
    press(&mut harness, "English");

    press(&mut harness, "Remove case");
    let num = || {
        CaseFolder::at(folder.path())
            .list()
            .expect("listed")
            .cases
            .len()
    };
    assert_eq!(num(), 2);
    press(&mut harness, "Put case back");
    assert_eq!(num(), 3);
    // A capture brings the scene to the front again.
    show(&mut harness, DOOR);
    assert!(matches!(own(&harness).front, Front::Scene));
    assert_eq!(found(&harness).as_deref(), Some("front_door"));
}

#[test]
fn keeping_a_case_is_undone_and_what_it_set_in_the_history_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open(folder.path());
    press(&mut harness, "Compare");
    keep(&mut harness, DOOR, "Back door, left");
    let num = || {
        let list = CaseFolder::at(folder.path()).list().expect("listed");
        list.cases.len()
    };
    assert_eq!(num(), 1);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut harness);
    assert_eq!(num(), 0);
    harness.get_by_label_contains("its History entry is unchanged");
    let row = history_of(&harness).row(0).expect("listed");
    assert_eq!(row.label, Some(Truth::Part("back_door".into())));
    press(&mut harness, "Redo");
    assert_eq!(num(), 1);
}

fn act_in_history(harness: &mut WindowHarness, action: HistoryAction) {
    act_in(harness, |workspace: &mut HistoryWorkspace, cx| {
        workspace.apply(action, cx);
    });
}

#[test]
fn a_kept_case_labels_its_inspection_and_a_label_of_the_history_is_the_truth_here() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open(folder.path());
    press(&mut harness, "Compare");
    show(&mut harness, DOOR);
    act_in_compare(&mut harness, CompareAction::Remark(" bent ".into()));
    press(&mut harness, "Choose… ▼");
    press(&mut harness, "Actual part: Back door, left");
    press(&mut harness, "Keep case");
    act(&mut harness, Action::GoTo(WorkspaceKind::History));
    let row = history_of(&harness).row(0).expect("listed");
    assert_eq!(row.label, Some(Truth::Part("back_door".into())));
    assert_eq!(row.remark, "bent");
    let cases = CaseFolder::at(folder.path()).list().expect("listed").cases;
    assert_eq!(cases[0].meta.about.remark, "bent");

    let corrected = HistoryAction::Label(row.number, Some(Truth::NotEnrolled));
    act_in_history(&mut harness, corrected);
    act(&mut harness, Action::GoTo(WorkspaceKind::Compare));
    act_in_compare(&mut harness, CompareAction::FrontScene);
    assert_eq!(own(&harness).truth, Some(Truth::NotEnrolled));
    harness.get_by_label("accepted, but it is");
}

#[test]
fn a_past_inspection_that_is_opened_again_is_labelled_where_it_was_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = || WindowOptions {
        cases: Some(folder.path().join("cases")),
        history: Some(folder.path().join("history")),
        ..plain_options()
    };
    // The window stores its first inspection.
    drop(open_with(USUAL, options()));
    let mut harness = open_with(USUAL, options());
    act(&mut harness, Action::GoTo(WorkspaceKind::History));
    act_in_history(&mut harness, HistoryAction::Open(1));
    press(&mut harness, "Compare");
    press(&mut harness, "Choose… ▼");
    press(&mut harness, "Actual part: Not enrolled");
    press(&mut harness, "Keep case");
    act(&mut harness, Action::GoTo(WorkspaceKind::History));
    let history = history_of(&harness);
    let rows = (0..history.num_rows()).filter_map(|index| history.row(index));
    let mut labels: Vec<_> = rows.map(|row| (row.number, row.label.clone())).collect();
    labels.sort_by_key(|(number, _)| *number);
    assert_eq!(labels, [(1, Some(Truth::NotEnrolled)), (2, None)]);
}

#[test]
fn what_is_refused_is_said_to_be_so_and_why_and_only_the_judgement_is_good() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_at(SMALL, folder.path());
    press(&mut harness, "Compare");
    show(&mut harness, DOOR);
    harness.get_by_label("accepted · which part is it actually?");
    show(&mut harness, CellChoice::Foreign(ObjectKind::Hood));
    harness.get_by_label("not accepted · which part is it actually?");
    harness.get_by_label_contains("Not accepted · nearest ");
    harness.get_by_label_contains("The actual part is not set · ");
    harness.get_by_label_contains("Refused: score 0.");
    harness.get_by_label_contains(": unknown; the outlines lie ");
    // The distances of both matchers are shown, in the smallest window too.
    harness.get_by_label("paper: ‖A − C‖₁, px² + rad²");

    press(&mut harness, "Choose… ▼");
    let top_of = |label: &str| harness.get_by_label(label).rect().min.y;
    let none = [
        "Actual part: Not enrolled",
        "Actual part: Nothing (empty cell)",
    ]
    .map(top_of);
    assert!(none[0] < none[1] && none[1] < top_of("Actual part: Front bumper"));
    press(&mut harness, "Actual part: Not enrolled");
    harness.get_by_label("not accepted, and it is");
    harness.get_by_label_contains("Not accepted · nearest ");
    harness.get_by_label_contains("Rightly refused · ");
    press(&mut harness, "Keep case");
    keep(&mut harness, CellChoice::Empty, "Nothing (empty cell)");
    press(&mut harness, "Run all cases");
    harness.get_by_label("no false accepts");
    harness.get_by_label("· 2 of 2 right · none wrongly refused");
    harness.get_by_label("Not enrolled, not accepted: 1, right");
    press(&mut harness, "Empty cell, not accepted: 1, right");
    harness.get_by_label("Empty cell, not accepted: 1");

    show(&mut harness, DOOR);
    press(&mut harness, "Choose… ▼");
    press(&mut harness, "Actual part: Fender, left");
    harness.get_by_label("accepted, but it is");
    // The run does not cover a case that is kept after it.
    press(&mut harness, "Keep case");
    harness.get_by_label("· 2 of 2 right · none wrongly refused");
    harness.get_by_label("· outdated: 2 of 3 kept cases");
    press(&mut harness, "Run all cases");
    assert!(harness.query_by_label_contains("outdated").is_none());
}

#[test]
fn a_changed_parameter_shows_at_once_and_can_be_used_undone_and_reset() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open(folder.path());
    press(&mut harness, "Compare");
    harness.get_by_label("0 changed from default");
    let study = |harness: &WindowHarness| {
        let study = own(harness).study.clone();
        study.expect("a study")
    };
    assert!(study(&harness).found.accepted);

    // Typed into the field, as a user would.
    let accept_from = |harness: &mut WindowHarness, text: &str| {
        let field = |harness: &mut WindowHarness, act: &dyn Fn(&Node<'_>)| {
            act(&harness.get_by_role_and_label(Role::SpinButton, "Accept from"));
            let_pass(harness, 30);
        };
        field(harness, &|node| node.scroll_to_me());
        field(harness, &|node| node.click());
        field(harness, &|node| node.type_text(text));
        harness.key_press(Key::Enter);
        settle(harness);
    };
    accept_from(&mut harness, "1");
    harness.get_by_label("1 changed from default");
    assert!(!study(&harness).found.accepted);
    assert!((study(&harness).recipe.accept.min_score - 1.0).abs() < 1e-9);
    harness.get_by_label_contains("Not accepted · ");
    // The recipe of Inspect has not changed.
    assert_eq!(**harness.state().state().session.recipe, Recipe::default());

    press(&mut harness, "Use this recipe");
    let state = harness.state().state();
    assert!((state.session.recipe.accept.min_score - 1.0).abs() < 1e-9);
    let shown = state.session.shown.as_ref().expect("a result");
    assert!((shown.inspected.recipe.accept.min_score - 1.0).abs() < 1e-9);
    press(&mut harness, "Undo use");
    assert_eq!(**harness.state().state().session.recipe, Recipe::default());

    press(&mut harness, "Reset accept from");
    harness.get_by_label("0 changed from default");
    assert!(study(&harness).found.accepted);

    // A value out of range gives a message and changes nothing.
    accept_from(&mut harness, "1.5");
    harness.get_by_label_contains("Accept from cannot be 1.5");
    harness.get_by_label("0 changed from default");

    press(&mut harness, "Matcher: Paper");
    harness.get_by_label_contains("Auto- and cross-correlation: paper:");
    press(&mut harness, "Reset all");
    harness.get_by_label_contains("Auto- and cross-correlation: default:");
}

/// The recipe `strict` is in use; results and records go by its name.
fn a_copy_is_on_trial_and_the_recipe_in_use_keeps_its_name(harness: &mut WindowHarness) {
    press(harness, "Recipe strict");
    press(harness, "Duplicate");
    harness.get_by_label("Recipe strict_3");
    let in_use = |harness: &WindowHarness| harness.state().state().session.recipe.label.to_string();
    assert_eq!(in_use(harness), "strict");
    press(harness, "Use this recipe");
    assert_eq!(in_use(harness), "strict_3");
    press(harness, "Recipe strict_3");
    press(harness, "strict");
    press(harness, "Use this recipe");
    assert_eq!(in_use(harness), "strict");
}

#[test]
fn a_recipe_is_saved_used_renamed_removed_and_put_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let recipes = RecipeFolder::at(folder.path().join("recipes"));
    let mut harness = open_with(
        USUAL,
        WindowOptions {
            cases: Some(folder.path().join("cases")),
            recipes: Some(recipes.path().to_owned()),
            ..plain_options()
        },
    );
    press(&mut harness, "Compare");
    harness.get_by_label("Recipe built-in");
    act_in_compare(&mut harness, CompareAction::Set("accept.min_score", 0.95));
    press(&mut harness, "Recipe built-in (modified)");
    press(&mut harness, "Save as…");
    let write_name = |harness: &mut WindowHarness, name: &str| {
        let field = harness.get_by_role_and_label(Role::TextInput, "Name of the recipe");
        field.type_text(name);
        settle(harness);
    };
    write_name(&mut harness, "Strict one");
    harness.get_by_label_contains("for example strict_one");
    press(&mut harness, "Cancel the name");
    press(&mut harness, "Recipe built-in (modified)");
    press(&mut harness, "Save as…");
    write_name(&mut harness, "strict");
    press(&mut harness, "Save under this name");
    harness.get_by_label("Recipe strict");
    harness.get_by_label("Saved recipe strict");
    let kept = |name: &str| recipes.read(&PartName::new(name).expect("a name"));
    assert!((kept("strict").expect("kept").recipe.accept.min_score - 0.95).abs() < 1e-12);

    // The recipe is on trial until it is used; then the result and all records of it have its name.
    assert_eq!(
        harness.state().state().session.recipe.label.name,
        "built-in"
    );
    press(&mut harness, "Use this recipe");
    let state = harness.state().state();
    let shown = state.session.shown.as_ref().expect("a result");
    assert_eq!(shown.inspected.recipe.label.to_string(), "strict");
    assert!(
        shown
            .inspected
            .entry
            .record
            .detail
            .line
            .contains("\"name\":\"strict\"")
    );

    // A changed recipe is marked, and its differences from the defaults are listed.
    act_in_compare(&mut harness, CompareAction::Set("accept.min_score", 0.5));
    act_in_compare(&mut harness, CompareAction::Set("project.pixel", 4.0));
    press(&mut harness, "2 changed from default");
    harness.get_by_label("Accept from: 0.50, default 0.90");
    harness.get_by_label("Pixel: 4.0 mm, default 5.0 mm");
    press(&mut harness, "Recipe strict (modified)");
    press(&mut harness, "Duplicate");
    harness.get_by_label("Recipe strict_2");
    let copy = kept("strict_2").expect("kept");
    assert!((copy.recipe.project.pixel.mm() - 4.0).abs() < 1e-9);
    press(&mut harness, "Recipe strict_2");
    press(&mut harness, "strict");
    harness.get_by_label("Recipe strict");
    assert!(own(&harness).tried.is_none());

    a_copy_is_on_trial_and_the_recipe_in_use_keeps_its_name(&mut harness);

    press(&mut harness, "Recipe strict");
    press(&mut harness, "Set as default");
    assert_eq!(recipes.default_name().expect("read"), "strict");
    press(&mut harness, "Recipe strict");
    press(&mut harness, "Rename…");
    write_name(&mut harness, "er");
    press(&mut harness, "Rename under this name");
    harness.get_by_label("Recipe stricter");
    assert_eq!(
        harness.state().state().session.recipe.label.to_string(),
        "stricter"
    );
    assert_eq!(recipes.default_name().expect("read"), "stricter");

    press(&mut harness, "Recipe stricter");
    press(&mut harness, "Delete");
    harness.get_by_label("Recipe stricter (modified)");
    assert!(kept("stricter").is_err());
    press(&mut harness, "Put recipe back");
    harness.get_by_label("Recipe stricter");
    assert_eq!(recipes.default_name().expect("read"), "stricter");

    // Export and import: the name is taken by another recipe.
    let file = folder.path().join("stick.toml");
    let act = |harness: &mut WindowHarness, action| {
        act_in_compare(harness, CompareAction::Recipe(action));
    };
    act(&mut harness, RecipeAction::Export(file.clone()));
    harness.get_by_label_contains("Wrote ");
    act_in_compare(&mut harness, CompareAction::Set("accept.min_score", 0.6));
    act(&mut harness, RecipeAction::Save);
    act(&mut harness, RecipeAction::Import(file.clone()));
    harness.get_by_label("Recipe stricter_2");
    assert!((kept("stricter_2").expect("kept").recipe.accept.min_score - 0.95).abs() < 1e-12);
    std::fs::write(&file, "schema = 1\nname = \"x\"\n[parameters]\nno.such = 1").expect("written");
    act(&mut harness, RecipeAction::Import(file));
    harness.get_by_label_contains("there is no parameter no.such");
}

#[test]
fn another_part_can_be_compared_from_the_list_of_distances() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open(folder.path());
    press(&mut harness, "Compare");
    let against = |harness: &WindowHarness| {
        let study = own(harness).study.clone();
        study.expect("a study").against.clone()
    };
    assert_eq!(against(&harness).as_deref(), Some("front_door"));
    harness
        .get_by_label_contains("Compare with Fender, left")
        .click();
    settle(&mut harness);
    assert_eq!(against(&harness).as_deref(), Some("fender"));
    press(&mut harness, "Fender, left ▼");
    press(&mut harness, "What it is, else the best");
    assert_eq!(against(&harness).as_deref(), Some("front_door"));
}

#[test]
fn every_control_is_large_enough_labelled_and_inside_a_small_window() {
    let folder = tempfile::tempdir().expect("a folder");
    let size = SMALL;
    let mut harness = open_at(size, folder.path());
    press(&mut harness, "Compare");
    keep(&mut harness, DOOR, "Front door, left");
    press(&mut harness, "Run all cases");
    let mut num_controls = 0;
    for role in [Role::Button, Role::Tab, Role::SpinButton, Role::TextInput] {
        for node in harness.query_all_by_role(role) {
            let label = node.accesskit_node().label().unwrap_or_default();
            let rect = node.rect();
            assert!(!label.is_empty(), "a control at {rect:?} has no label");
            assert!(
                rect.width() >= 35.9 && rect.height() >= 35.9,
                "{label}: {rect:?}"
            );
            assert!(
                rect.min.x >= 0.0 && rect.max.x <= size.x,
                "{label}: {rect:?}"
            );
            num_controls += 1;
        }
    }
    assert!(num_controls >= 30, "{num_controls} controls");
    harness.key_press(Key::F1);
    harness.run_steps(2);
    harness.get_by_label("Keep the case in front");
    harness.get_by_label("Run all kept cases");
}

/// Describes a case that another program keeps.
fn about(origin: &str) -> CaseDescription {
    CaseDescription {
        origin: origin.into(),
        simulated: true,
        kept_at: jiff::Timestamp::UNIX_EPOCH,
        remark: String::new(),
        difficulty: None,
        truth: Truth::Part("fender".into()),
        found: FoundVerdict::default(),
        pose: None,
        one_of_several: None,
    }
}

#[test]
fn cases_that_another_program_adds_damages_or_removes_are_listed_as_they_are() {
    let folder = tempfile::tempdir().expect("a folder");
    let cases = CaseFolder::at(folder.path());
    let mut harness = open(folder.path());
    press(&mut harness, "Compare");
    keep(&mut harness, DOOR, "Front door, left");
    let wait_for_cases = |harness: &mut WindowHarness, num: usize| {
        wait_for(harness, |window| {
            let compare = window.workspace::<CompareWorkspace>();
            let cases = compare.and_then(|compare| compare.state.cases.as_ref());
            cases.is_some_and(|cases| cases.list.len() == num)
        });
        settle(harness);
    };
    let scene = scene_of(&CellSetup::with_part(PartKind::Fender, Side::Left, 0, 5));
    cases.keep(&scene, about("Monday")).expect("kept");
    wait_for_cases(&mut harness, 2);
    cases.keep(&scene, about("Tuesday")).expect("kept");
    let file = folder.path().join("tuesday").join("case.toml");
    std::fs::remove_file(file).expect("removed");
    press(&mut harness, "Run all cases");
    harness.get_by_label_contains("· 2 of 2 right · none wrongly refused · 1 cannot be read");
    assert!(harness.query_by_label_contains("outdated").is_none());
    std::fs::remove_dir_all(folder.path().join("monday")).expect("removed");
    wait_for_cases(&mut harness, 1);
    harness.get_by_label("· outdated: a case was removed");
    press(&mut harness, "Run all cases");
    harness.get_by_label_contains("· 1 of 1 right");
    assert!(harness.query_by_label_contains("outdated").is_none());
}

#[test]
fn an_earlier_run_is_compared_and_what_is_worse_is_listed_first() {
    let folder = tempfile::tempdir().expect("a folder");
    let setup = CellSetup::with_part(PartKind::Fender, Side::Left, 0, 5);
    let about = CaseDescription {
        difficulty: Some("placed anyhow".into()),
        ..about("Monday")
    };
    let cases = CaseFolder::at(folder.path().join("cases"));
    let scene = scene_of(&setup);
    cases.keep(&scene, about).expect("kept");
    let earlier = folder.path().join("earlier.json");
    let text = r#"{"schema":1,"cases":[
        {"name":"monday","truth":{"is":"part","part":"fender"},"judgement":"right",
         "found":{"part":"fender","score":0.93,"accepted":true}},
        {"name":"sold","truth":{"is":"nothing"},"judgement":"right","found":{"accepted":false}}]}"#;
    std::fs::write(&earlier, text).expect("written");

    let mut harness = open(cases.path());
    press(&mut harness, "Compare");
    harness.get_by_label("it is: Fender, left · placed anyhow");
    let compare = |harness: &mut WindowHarness| {
        act_in_compare(harness, CompareAction::Earlier(earlier.clone()));
    };
    // Before a run there is nothing to compare.
    compare(&mut harness);
    harness.get_by_label("There is no run to compare with an earlier one.");
    press(&mut harness, "Run all cases");
    harness.get_by_label("Compare with an earlier run…");
    compare(&mut harness);
    harness.get_by_label("none worse");
    harness.get_by_label_contains("1 case of both · 1 gone or damaged · against earlier.json");

    // With a threshold that nothing reaches, the case is refused now.
    let strict = CompareAction::Set("accept.min_score", 1.0);
    act_in_compare(&mut harness, strict);
    press(&mut harness, "Run all cases");
    compare(&mut harness);
    harness.get_by_label("1 worse");
    harness.get_by_label_contains("worse: refused, was right · Fender, left");
    press(&mut harness, "Open monday");
    let front = &own(&harness).front;
    assert!(matches!(front, Front::Kept(case) if case.name == "monday"));
    press(&mut harness, "Back to matrix");
    harness.get_by_label("Fender, left, not accepted: 1, wrongly refused");

    std::fs::write(&earlier, "no JSON").expect("written");
    compare(&mut harness);
    harness.get_by_label_contains("earlier.json: not an evaluation");
}

/// With `PARTSIGHT_VIEW_PICTURES=DIR` it keeps the pictures in that folder; without, it does nothing.
#[test]
fn it_is_drawn_in_both_sizes_and_colours() {
    let Some(pictures) = std::env::var_os("PARTSIGHT_VIEW_PICTURES") else {
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    for (width, height) in [(1440, 900), (1024, 768)] {
        let size = Vec2::new(width as f32, height as f32);
        let mut harness = open_at(size, folder.path());
        let shot = |harness: &mut WindowHarness, name: &str| {
            harness.run_steps(2);
            let path = Path::new(&pictures).join(format!("compare_{name}_{width}.png"));
            harness.render().expect("drawn").save(path).expect("saved");
        };
        press(&mut harness, "Compare");
        shot(&mut harness, "empty");
        if width == 1440 {
            let mut choices = CellChoice::all().skip(1);
            let titles = [
                "Front bumper",
                "Trunk lid",
                "Back bumper",
                "Back door, left",
            ];
            for title in titles {
                let choice = choices.find(|c| c.title().starts_with(title));
                if let Some(choice) = choice {
                    keep(&mut harness, choice, title);
                }
            }
            keep(
                &mut harness,
                CellChoice::Foreign(ObjectKind::Hood),
                "Not enrolled",
            );
            keep(
                &mut harness,
                CellChoice::Part(PartKind::FrontDoor, Side::Right),
                "Not enrolled",
            );
            keep(&mut harness, DOOR, "Front door, left");
            keep(&mut harness, FENDER, "Back door, left");
        }
        shot(&mut harness, "case");
        press(&mut harness, "Run all cases");
        shot(&mut harness, "run");
        let cell = "Back door, left taken for Fender, left: 1, false accept";
        press(&mut harness, cell);
        harness.get_by_label_contains("Open simulated").click();
        settle(&mut harness);
        shot(&mut harness, "cell");
        press(&mut harness, "Matcher: Paper");
        press(&mut harness, "Back to matrix");
        if width == 1440 {
            press(&mut harness, "Scaling: one core against several");
            press(&mut harness, "Measure scaling");
            harness.get_by_label("Measure scaling").scroll_to_me();
            let_pass(&mut harness, 30);
            shot(&mut harness, "scaling");
        }
        act(&mut harness, Action::SwitchTheme);
        shot(&mut harness, "light");
    }
}

#[test]
fn the_button_of_a_changed_recipe_with_a_long_name_stays_in_the_window() {
    let folder = tempfile::tempdir().expect("a folder");
    let recipes = RecipeFolder::at(folder.path().join("recipes"));
    let name = "clear_coat_of_the_third_booth_in_the_afternoon";
    let file = RecipeFile {
        name: PartName::new(name).expect("a name"),
        ..RecipeFile::built_in()
    };
    recipes.save(&file, Replace::No).expect("saved");
    for size in [USUAL, SMALL] {
        let options = WindowOptions {
            cases: Some(folder.path().join("cases")),
            recipes: Some(recipes.path().to_owned()),
            ..plain_options()
        };
        let mut harness = open_with(size, options);
        press(&mut harness, "Compare");
        let opened = CompareAction::Recipe(RecipeAction::Open(name.into()));
        act_in_compare(&mut harness, opened);
        act_in_compare(&mut harness, CompareAction::Set("accept.min_score", 0.95));
        let label = format!("Recipe {name} (modified)");
        let button = harness.get_by_label(&label);
        assert!(button.rect().right() < size.x, "{:?}", button.rect());
    }
}

#[test]
fn recipes_that_a_command_saves_are_listed_and_what_is_on_trial_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let recipes = RecipeFolder::at(folder.path().join("recipes"));
    let mut harness = open_with(
        USUAL,
        WindowOptions {
            cases: Some(folder.path().join("cases")),
            recipes: Some(recipes.path().to_owned()),
            ..plain_options()
        },
    );
    press(&mut harness, "Compare");
    act_in_compare(&mut harness, CompareAction::Set("accept.min_score", 0.95));
    let mut strict = RecipeFile {
        name: PartName::new("strict").expect("a name"),
        ..RecipeFile::built_in()
    };
    strict.recipe.accept.min_score = 0.97;
    recipes.save(&strict, Replace::No).expect("saved");
    wait_for(&mut harness, |window| {
        let compare = window.workspace::<CompareWorkspace>();
        let list = compare.map(|compare| &compare.state.recipes.list);
        list.is_some_and(|list| list.recipes.len() == 1)
    });
    settle(&mut harness);
    press(&mut harness, "Recipe built-in (modified)");
    harness.get_by_label("strict").click();
    settle(&mut harness);
    harness.get_by_label("Recipe strict");
    let tried = own(&harness).tried.as_ref().expect("on trial");
    assert!((tried.accept.min_score - 0.97).abs() < 1e-12);

    // Save another value under the name of the recipe on trial, which does not change.
    strict.recipe.accept.min_score = 0.99;
    recipes.save(&strict, Replace::Yes).expect("saved");
    wait_for(&mut harness, |window| {
        let compare = window.workspace::<CompareWorkspace>();
        let tried = compare.and_then(|compare| compare.state.tried.clone());
        tried.is_some_and(|tried| tried.label.is_changed)
    });
    let tried = own(&harness).tried.as_ref().expect("on trial");
    assert!((tried.accept.min_score - 0.97).abs() < 1e-12);
    // Saving asks before it replaces that value.
    press(&mut harness, "Recipe strict (modified)");
    press(&mut harness, "Save");
    let saved = || recipes.read(&strict.name).expect("kept").recipe;
    assert!((saved().accept.min_score - 0.99).abs() < 1e-12);
    harness.get_by_label("Replace recipe strict?");
    press(&mut harness, "Replace it");
    assert!((saved().accept.min_score - 0.97).abs() < 1e-12);
}
