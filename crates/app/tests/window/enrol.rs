//! The Enrol workspace, tested by its labels and controls. Needs no graphics adapter.

mod drafts;
mod drawing;
pub(crate) mod meshes;

use std::{fs, path::Path};

use app::{
    WindowOptions,
    workspaces::{
        enrol::{EnrolAction, EnrolWorkspace, draft::Field},
        history::HistoryWorkspace,
    },
};
use egui::{Key, Modifiers, Pos2, Role, Vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use files::{fixtures::obj_of, save_cloud};
use inspection::{
    library::{LibraryFolder, PartName},
    pipeline::Verdict,
};
use shell::{
    action::Action, inspection::source::CellChoice, session::WorkspaceKind,
    source::live::SourceState, state::State,
};
use simulate::{PartKind, PartModel, Side};

use inspection::fixtures::copy_library;
use stages::fixtures::facing_part;

use super::set_up::{
    SMALL, USUAL, WindowHarness, act, drop_file, enrol_of, history_of, let_pass, open_with,
    plain_options, press, settle, wait_for, wait_until, watch_folder,
};

fn open_at(library: &Path, size: Vec2) -> WindowHarness {
    let options = WindowOptions {
        library: Some(library.to_owned()),
        ..plain_options()
    };
    open_with(size, options)
}

/// Opens a window at the Enrol workspace, with the simulated right-hand front door in front of the camera.
fn open(library: &Path) -> WindowHarness {
    let mut harness = open_at(library, USUAL);
    harness.get_by_label("Enrol").click();
    settle(&mut harness);
    harness
}

fn state(harness: &WindowHarness) -> &State {
    harness.state().state()
}

fn capture(harness: &mut WindowHarness, kind: PartKind, side: Side) {
    act(harness, Action::UseCell(CellChoice::Part(kind, side)));
}

/// Presses a key while a source is followed, when nothing settles.
fn press_key(harness: &mut WindowHarness, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(4);
}

fn press_keys(harness: &mut WindowHarness, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    settle(harness);
}

fn write(harness: &mut WindowHarness, label: &str, text: &str) {
    let field = harness.get_by_role_and_label(Role::TextInput, label);
    field.focus();
    harness.run_steps(2);
    press_keys(harness, Modifiers::COMMAND, Key::A);
    harness
        .get_by_role_and_label(Role::TextInput, label)
        .type_text(text);
    harness.run_steps(3);
    // Remove the focus, so that keys are shortcuts again.
    let field = harness.ctx.memory(egui::Memory::focused);
    let context = harness.ctx.clone();
    context.memory_mut(|memory| field.into_iter().for_each(|id| memory.surrender_focus(id)));
    harness.run_steps(2);
}

fn drag(harness: &mut WindowHarness, from: Pos2, to: Pos2) {
    draw(harness, &[from, from + (to - from) * 0.3, to]);
    let_go(harness);
}

/// Releases the left button at the pointer's position.
pub(crate) fn let_go(harness: &mut WindowHarness) {
    let at = harness.ctx.input(|input| input.pointer.latest_pos());
    harness.drop_at(at.expect("a pointer"));
    settle(harness);
}

/// Moves the pointer along this path with the left button held, without releasing it.
pub(crate) fn draw(harness: &mut WindowHarness, way: &[Pos2]) {
    harness.hover_at(way[0]);
    harness.run_steps(2);
    harness.drag_at(way[0]);
    harness.run_steps(2);
    for at in &way[1..] {
        harness.hover_at(*at);
        harness.run_steps(1);
    }
}

/// A position in the 3-D view, given in shares of its sides.
fn in_view(harness: &WindowHarness, x: f32, y: f32) -> Pos2 {
    let view = harness.get_by_label("3-D view of the draft").rect();
    view.min + view.size() * Vec2::new(x, y)
}

/// Begins to draw along this path over the 3-D view, given in shares of its sides.
pub(crate) fn draw_in_view(harness: &mut WindowHarness, way: &[(f32, f32)]) {
    let way: Vec<Pos2> = way.iter().map(|(x, y)| in_view(harness, *x, *y)).collect();
    draw(harness, &way);
}

/// Indices of the points that are kept.
fn kept(harness: &WindowHarness) -> Vec<u32> {
    let draft = enrol_of(harness).draft.as_ref().expect("a draft");
    draft.selection.indices.clone()
}

fn num_kept(harness: &WindowHarness) -> usize {
    let draft = enrol_of(harness).draft.as_ref().expect("a draft");
    draft.selection.indices.len()
}

fn notices(harness: &WindowHarness) -> Vec<String> {
    let notices = state(harness).notices.iter();
    notices.map(|notice| notice.what.clone()).collect()
}

/// A new folder for a library.
fn library() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

fn names(library: &Path) -> Vec<String> {
    let folder = LibraryFolder::open(library).expect("there");
    folder.names().expect("listed")
}

/// Captures this part and enrols it under this title.
fn enrol(harness: &mut WindowHarness, kind: PartKind, title: &str) {
    capture(harness, kind, Side::Right);
    write(harness, "Title", title);
    press(harness, "Save");
}

/// Lets the time pass after which a changed draft is saved, and waits for that.
fn pass_time(harness: &mut WindowHarness) {
    let_pass(harness, 20);
    settle(harness);
}

fn write_mesh(path: &Path, kind: PartKind) {
    let model = PartModel::new(kind, Side::Left, 0);
    let text = obj_of(&[("part", model.mesh())]);
    std::fs::write(path, text).expect("written");
}

#[test]
fn a_captured_part_is_corrected_named_saved_and_recognised_by_its_new_name() {
    let library = library();
    let mut harness = open(library.path());
    harness.get_by_label("Show the part to enrol");
    capture(&mut harness, PartKind::FrontDoor, Side::Right);
    assert!(harness.query_by_label("New part").is_some());
    let before = num_kept(&harness);

    // Cut off a strip at the right of the picture by a box, and bring it back.
    let picture = harness.get_by_label("Picture of what is kept").rect();
    press(&mut harness, "Keep");
    let from = picture.min + Vec2::new(2.0, 2.0);
    let to = picture.center() + Vec2::new(0.0, picture.height() / 2.0 - 2.0);
    drag(&mut harness, from, to);
    let cut = num_kept(&harness);
    assert!(0 < cut && cut < before, "{cut} of {before}");
    press_keys(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(num_kept(&harness), before);
    press_keys(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(num_kept(&harness), cut);
    press(&mut harness, "Reset all corrections");
    assert_eq!(num_kept(&harness), before);
    // Keep the wall by mistake, and drop it again.
    press(&mut harness, "Background 1, dropped");
    assert!(num_kept(&harness) > before);
    press(&mut harness, "Background 1, kept");
    assert_eq!(num_kept(&harness), before);

    write(&mut harness, "Title", "Front door, right");
    press_keys(&mut harness, Modifiers::COMMAND, Key::S);
    assert_eq!(names(library.path()), ["front_door_right"]);
    harness.get_by_label_contains("Saved Front door, right");
    harness.get_by_label("Enrolled: Front door, right");
    harness.get_by_label("Show the part to enrol");

    // What was just saved is not offered to be enrolled again.
    assert!(harness.query_by_label("Use the inspected scene").is_none());
    press(&mut harness, "Saved: see it in Inspect");
    harness.get_by_label("Front door, right");
    harness.get_by_label("Recognised");
}

#[test]
fn a_saved_part_goes_again_by_undo_and_the_draft_comes_back() {
    let library = library();
    let mut harness = open(library.path());
    enrol(&mut harness, PartKind::Fender, "Fender, right");
    assert_eq!(names(library.path()), ["fender_right"]);
    press(&mut harness, "Undo");
    assert!(names(library.path()).is_empty());
    let draft = enrol_of(&harness).draft.as_ref().expect("back");
    assert_eq!(draft.form.title, "Fender, right");
    press_keys(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(names(library.path()), ["fender_right"]);
    assert!(enrol_of(&harness).draft.is_none());
}

#[test]
fn the_next_draft_does_not_give_way_to_the_part_that_was_saved_before_it() {
    let library = library();
    let mut harness = open(library.path());
    enrol(&mut harness, PartKind::Fender, "Fender, right");
    capture(&mut harness, PartKind::Grille, Side::Right);
    let undo = harness.get_by_label("Undo the last step");
    assert!(undo.accesskit_node().is_disabled());
    press_keys(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(names(library.path()), ["fender_right"]);
    assert_eq!(enrol_of(&harness).num_drafts, 2);
    assert!(enrol_of(&harness).draft.is_some());
}

#[test]
fn a_capture_of_a_followed_folder_is_enrolled_and_not_inspected() {
    let (library, folder) = (library(), tempfile::tempdir().expect("a folder"));
    let mut harness = open(library.path());
    let before = history_of(&harness).num_rows();
    watch_folder(&mut harness, folder.path());
    state(&harness).session.trace.set_serial("4711");
    let context = harness.ctx.clone();
    harness.state_mut().act(Action::Capture, &context);
    wait_until(&mut harness, |state| state.follower.is_idle());
    let mut shown = notices(&harness).into_iter();
    assert!(shown.any(|what| what.contains("Live stopped")));
    let scene = facing_part(PartKind::Fender, Side::Left, 5);
    save_cloud(&folder.path().join("fender.pcd"), &scene.cloud).expect("written");
    settle(&mut harness);
    assert!(num_kept(&harness) > 1000);
    let session = &state(&harness).session;
    assert_eq!(
        (session.is_live(), &*session.trace.get().serial),
        (false, "4711")
    );
    assert_eq!(history_of(&harness).num_rows(), before);
}

#[test]
fn after_a_save_the_newest_file_of_a_followed_folder_is_the_current_part_and_live_goes_on() {
    let (library, folder) = (library(), tempfile::tempdir().expect("a folder"));
    copy_library(library.path());
    let mut harness = open_at(library.path(), USUAL);
    watch_folder(&mut harness, folder.path());
    let context = harness.ctx.clone();
    let num_inspected = |state: &State| {
        let status = state.session.live.status.as_ref();
        let running = status.filter(|status| status.source == SourceState::Running);
        running.map(|status| status.num_inspected)
    };
    let arrives = |harness: &mut WindowHarness, name: &str, kind, side, number| {
        let scene = facing_part(kind, side, 5);
        save_cloud(&folder.path().join(name), &scene.cloud).expect("written");
        wait_until(harness, |state| num_inspected(state) == Some(number));
        harness.run_steps(2);
    };
    let apply = |harness: &mut WindowHarness, action| {
        let window = harness.state_mut();
        let done = window.with(&context, |enrol: &mut EnrolWorkspace, cx| {
            enrol.state.apply(action, cx);
        });
        done.expect("Enrol is there");
    };
    arrives(&mut harness, "a.pcd", PartKind::Fender, Side::Right, 1);
    let to_enrol = Action::GoTo(WorkspaceKind::Enrol);
    harness.state_mut().act(to_enrol, &context);
    apply(&mut harness, EnrolAction::TakeShown);
    wait_for(&mut harness, |window| {
        let enrol = window.workspace::<EnrolWorkspace>().expect("there");
        let draft = enrol.state.draft.as_ref();
        draft.is_some_and(|draft| draft.ready().is_some())
    });
    let title = Field::Title("Wing".into());
    apply(&mut harness, EnrolAction::Write(title));
    arrives(&mut harness, "b.pcd", PartKind::Grille, Side::Left, 2);
    state(&harness).session.trace.set_serial("4711");
    apply(&mut harness, EnrolAction::Save);
    wait_until(&mut harness, |state| num_inspected(state) == Some(1));
    assert!(names(library.path()).contains(&"wing".to_owned()));
    // In the operator's view hangs what arrived last, and not what was enrolled.
    press_key(&mut harness, Modifiers::COMMAND, Key::K);
    let session = &state(&harness).session;
    let shown = session.shown.as_ref().expect("inspected");
    let verdict = &shown.inspected.inspection.verdict;
    assert!(
        matches!(verdict, Verdict::Part { part, .. } if part == "grille"),
        "{verdict:?}"
    );
    assert!(session.is_live() && !shown.is_outdated);
    assert_eq!(shown.inspected.library.parts.len(), 9);
    assert_eq!(session.trace.get().serial, "4711");
    // It is another inspection of the same part.
    wait_for(&mut harness, |window| {
        let history = window.workspace::<HistoryWorkspace>().expect("there");
        let newest = history.state.row(0);
        newest.is_some_and(|row| row.num_below == 1)
    });
    let num_rows = history_of(&harness).num_rows();
    assert_eq!(num_rows, 3, "with the first frame of the window");
    arrives(&mut harness, "c.pcd", PartKind::Grille, Side::Left, 2);
    let shown = state(&harness).session.shown.as_ref().expect("inspected");
    assert_eq!(shown.inspected.trace().serial, "4711");
}

#[test]
fn a_capture_that_was_enrolled_from_is_not_current_once_another_was_inspected() {
    let library = library();
    let mut harness = open(library.path());
    press(&mut harness, "Use the inspected scene");
    write(&mut harness, "Title", "Door");
    act(&mut harness, Action::GoTo(WorkspaceKind::Inspect));
    capture(&mut harness, PartKind::Grille, Side::Left);
    let scene = |harness: &WindowHarness| {
        let shown = state(harness).session.shown.as_ref().expect("inspected");
        shown.inspected.origin.title()
    };
    let newest = scene(&harness);
    act(&mut harness, Action::GoTo(WorkspaceKind::Enrol));
    press(&mut harness, "Save");
    assert_eq!(names(library.path()), ["door"]);
    assert_eq!(scene(&harness), newest);
    // A newer capture for Enrol leaves no verdict on what hung there before.
    press_keys(&mut harness, Modifiers::NONE, Key::Space);
    assert!(state(&harness).session.is_old());
}

#[test]
fn a_removed_part_comes_back_by_undo() {
    let library = library();
    let mut harness = open(library.path());
    enrol(&mut harness, PartKind::Grille, "Grille");
    harness.get_by_label("Saved: see it in Inspect");
    press(&mut harness, "Enrolled: Grille");
    press(&mut harness, "Remove");
    assert!(names(library.path()).is_empty());
    assert!(harness.query_by_label("Enrolled: Grille").is_none());
    let saved = harness.query_by_label("Saved: see it in Inspect");
    assert!(saved.is_none());
    press(&mut harness, "Undo");
    assert_eq!(names(library.path()), ["grille"]);
    harness.get_by_label("Enrolled: Grille");
}

#[test]
fn a_part_is_renamed_and_gets_its_old_name_back() {
    let library = library();
    let mut harness = open(library.path());
    enrol(&mut harness, PartKind::Grille, "Grille");
    press(&mut harness, "Enrolled: Grille");
    write(&mut harness, "Name", "radiator_grille");
    // Until it is renamed, the library has this title under the former name.
    assert!(harness.query_by_label_contains("has the title").is_none());
    write(&mut harness, "Title", "Radiator grille");
    press(&mut harness, "Rename");
    assert_eq!(names(library.path()), ["radiator_grille"]);
    harness.get_by_label("Enrolled: Radiator grille");
    press(&mut harness, "Undo");
    assert_eq!(names(library.path()), ["grille"]);
    harness.get_by_label("Enrolled: Grille");
}

#[test]
fn a_part_enrolled_anew_replaces_the_former_one_and_undo_brings_that_back() {
    let library = library();
    let mut harness = open(library.path());
    enrol(&mut harness, PartKind::TrunkLid, "Trunk lid");
    let folder = LibraryFolder::open(library.path()).expect("there");
    let from = |harness: &WindowHarness| {
        let library = state(harness).session.library.as_ref().expect("loaded");
        library.parts[0].enrolled.from.clone()
    };
    let first = from(&harness);
    press(&mut harness, "Enrolled: Trunk lid");
    press(&mut harness, "Enrol anew");
    harness.get_by_label("Capture the replacement for Trunk lid");
    press_keys(&mut harness, Modifiers::NONE, Key::Space);
    harness.get_by_label("Replaces Trunk lid");
    press(&mut harness, "Save and replace");
    assert_ne!(from(&harness), first);
    assert_eq!(folder.trashed().expect("listed").len(), 1);
    press(&mut harness, "Undo");
    assert_eq!(from(&harness), first);
    assert_eq!(names(library.path()), ["trunk_lid"]);
}

#[test]
fn a_part_that_another_program_saved_meanwhile_is_not_replaced_unasked() {
    let library = library();
    let mut harness = open(library.path());
    let mut other = open(library.path());
    // The other window saves while this draft is open; before that, this window would have noticed.
    capture(&mut harness, PartKind::Grille, Side::Right);
    write(&mut harness, "Title", "Grille");
    enrol(&mut other, PartKind::Grille, "Grille");
    press(&mut harness, "Save");
    let trash = || {
        library
            .path()
            .join(".trash")
            .read_dir()
            .map_or(0, Iterator::count)
    };
    assert!(
        notices(&harness)[0].contains("Another program has saved a part named grille"),
        "{:?}",
        notices(&harness)
    );
    assert_eq!(trash(), 0);
    press(&mut harness, "Save");
    assert_eq!(trash(), 1);
}

#[test]
fn what_shall_be_replaced_is_followed_when_renamed_and_forgotten_when_removed() {
    let library = library();
    let mut harness = open(library.path());
    enrol(&mut harness, PartKind::Grille, "Grille");
    press(&mut harness, "Enrolled: Grille");
    press(&mut harness, "Enrol anew");
    harness.get_by_label("Capture the replacement for Grille");
    harness.get_by_label("Replaces Grille");
    press(&mut harness, "Enrolled: Grille");
    write(&mut harness, "Title", "Radiator grille");
    write(&mut harness, "Name", "radiator_grille");
    press(&mut harness, "Rename");
    press(&mut harness, "Close");
    harness.get_by_label("Capture the replacement for Radiator grille");
    press(&mut harness, "Enrolled: Radiator grille");
    press(&mut harness, "Remove");
    harness.get_by_label("Show the part to enrol");
    harness.get_by_label("New part");
    assert!(enrol_of(&harness).replacing.is_none());
    press(&mut harness, "Undo");
    press(&mut harness, "Enrolled: Radiator grille");
    press(&mut harness, "Enrol anew");
    press(&mut harness, "Enrol as a new part instead");
    harness.get_by_label("Show the part to enrol");
    harness.get_by_label("New part");
}

#[test]
fn why_a_part_cannot_be_saved_yet_is_said_beside_the_button() {
    let library = library();
    let mut harness = open(library.path());
    capture(&mut harness, PartKind::Grille, Side::Left);
    harness.get_by_label("Give it a title first");
    assert!(harness.get_by_label("Save").accesskit_node().is_disabled());
    write(&mut harness, "Title", "Grille");
    assert!(harness.query_by_label("Give it a title first").is_none());
    assert!(!harness.get_by_label("Save").accesskit_node().is_disabled());
    write(&mut harness, "Name", "Grille 7");
    harness.get_by_label("Fix the name first");
}

#[test]
fn a_saved_part_is_brought_into_sight_and_marked_among_the_others_by_title() {
    let library = library();
    let mut harness = open_at(library.path(), SMALL);
    press(&mut harness, "Enrol");
    // Sorted by name, the first would be the last.
    let parts = [
        (PartKind::Grille, "Zed"),
        (PartKind::Fender, "Bend"),
        (PartKind::TrunkLid, "Cover"),
        (PartKind::FrontDoor, "Door"),
        (PartKind::BackDoor, "Entry"),
        (PartKind::RadiatorSupport, "Yard"),
    ];
    for (kind, title) in parts {
        enrol(&mut harness, kind, title);
    }
    capture(&mut harness, PartKind::FrontBumper, Side::Left);
    write(&mut harness, "Title", "apron");
    write(&mut harness, "Name", "zzz_apron");
    press(&mut harness, "Save");
    let_pass(&mut harness, 60);
    let left_of = |title: &str| {
        let label = format!("Enrolled: {title}");
        harness.get_by_label(&label).rect().min.x
    };
    let sorted = ["apron", "Bend", "Cover", "Door", "Entry", "Yard", "Zed"].map(left_of);
    assert!(sorted.is_sorted(), "{sorted:?}");
    assert!(sorted[0] >= 0.0, "out of sight: {sorted:?}");
    let marked = harness.get_by_label("Enrolled: apron");
    let value = marked.accesskit_node().value();
    assert!(value.is_some_and(|value| value.starts_with("Saved, ")));
    let other = harness.get_by_label("Enrolled: Zed");
    assert_eq!(other.accesskit_node().value(), None);
    press(&mut harness, "Enrolled: Zed");
    write(&mut harness, "Title", "Zebra");
    press(&mut harness, "Rename");
    let_pass(&mut harness, 60);
    let marked = harness.get_by_label("Enrolled: Zebra");
    let value = marked.accesskit_node().value();
    assert!(value.is_some_and(|value| value.starts_with("Renamed, ")));
    assert!(marked.rect().max.x <= SMALL.x);
}

#[test]
fn a_part_that_is_enrolled_already_is_named_as_hard_to_tell_from() {
    let library = library();
    let mut harness = open(library.path());
    enrol(&mut harness, PartKind::FrontDoor, "Door");
    capture(&mut harness, PartKind::FrontDoor, Side::Right);
    harness.get_by_label("The two cannot be told apart");
    harness.get_by_label("Replace Door");
    harness.get_by_label("One more reference of Door");
    capture(&mut harness, PartKind::Fender, Side::Right);
    harness.get_by_label("The two can be told apart");
    harness.get_by_label_contains("Most similar: Door (");
    harness.get_by_label_contains("\u{a0}% alike)");
}

#[test]
fn a_bad_name_is_said_while_typing_and_when_saving() {
    let library = library();
    let mut harness = open(library.path());
    capture(&mut harness, PartKind::Grille, Side::Left);
    write(&mut harness, "Name", "Grille 7");
    harness.get_by_label_contains("is not a valid name:");
    harness.get_by_label_contains("for example grille_7");
    press_keys(&mut harness, Modifiers::COMMAND, Key::S);
    assert!(names(library.path()).is_empty());
    assert!(notices(&harness)[0].contains("is not a valid name:"));
    press(&mut harness, "Dismiss");
    write(&mut harness, "Name", "grille_7");
    assert!(harness.query_by_label_contains("for example").is_none());
    press_keys(&mut harness, Modifiers::COMMAND, Key::S);
    assert_eq!(names(library.path()), ["grille_7"]);
}

#[test]
fn a_dropped_mesh_is_enrolled_whole() {
    let library = library();
    let files = tempfile::tempdir().expect("a folder");
    let path = files.path().join("grille.obj");
    write_mesh(&path, PartKind::Grille);
    let mut harness = open(library.path());
    drop_file(&mut harness, &path);
    harness.get_by_label("A mesh is enrolled whole: crop it in the program that made it");
    harness.get_by_label("Seen from all around");
    write(&mut harness, "Title", "Grille of the maker");
    press(&mut harness, "Save");
    assert_eq!(names(library.path()), ["grille_of_the_maker"]);
    let saved = state(&harness).session.library.as_ref().expect("loaded");
    assert_eq!(saved.parts[0].enrolled.from, "grille.obj");
    assert!(!saved.parts[0].simulated);
}

#[test]
fn why_a_file_could_not_be_read_leaves_once_another_is() {
    let library = library();
    let files = tempfile::tempdir().expect("a folder");
    let [broken, path] = ["broken.obj", "grille.obj"].map(|name| files.path().join(name));
    fs::write(&broken, "v 0 0\n").expect("written");
    write_mesh(&path, PartKind::Grille);
    let mut harness = open(library.path());
    drop_file(&mut harness, &broken);
    assert!(notices(&harness)[0].contains("broken.obj"));
    drop_file(&mut harness, &path);
    assert_eq!(notices(&harness), [""; 0]);
}

#[test]
fn a_mesh_in_millimetres_is_read_again_as_the_notice_offers() {
    let library = library();
    let files = tempfile::tempdir().expect("a folder");
    let path = files.path().join("grille.obj");
    write_mesh(&path, PartKind::Grille);
    let in_metres = fs::read_to_string(&path).expect("written");
    let thousandfold = |line: &str| match line.strip_prefix("v ") {
        Some(numbers) => {
            let numbers = numbers
                .split_whitespace()
                .map(|x| x.parse::<f64>().expect("a number"));
            let numbers: Vec<String> = numbers.map(|x| (1000.0 * x).to_string()).collect();
            format!("v {}\n", numbers.join(" "))
        }
        None => format!("{line}\n"),
    };
    let in_millimetres: String = in_metres.lines().map(thousandfold).collect();
    fs::write(&path, in_millimetres).expect("written");
    let mut harness = open(library.path());
    drop_file(&mut harness, &path);
    assert!(notices(&harness)[0].contains("may be in millimetres"));
    press(&mut harness, "Read as millimetres");
    assert!(
        notices(&harness)
            .iter()
            .all(|notice| !notice.contains("millimetres"))
    );
    harness.get_by_label("Seen from all around");
    write(&mut harness, "Title", "Grille of the maker");
    press(&mut harness, "Save");
    let saved = state(&harness).session.library.as_ref().expect("loaded");
    assert_eq!(saved.parts[0].enrolled.from, "grille.obj#units=mm");
}

#[cfg(target_os = "linux")]
#[test]
fn a_library_that_cannot_be_written_is_a_notice_and_the_window_goes_on() {
    // Not even root can create files there.
    let mut harness = open(Path::new("/proc/self/fdinfo"));
    capture(&mut harness, PartKind::Grille, Side::Left);
    write(&mut harness, "Title", "Grille");
    press(&mut harness, "Save");
    // The folder holds other files.
    assert!(notices(&harness)[0].contains("holds no library"));
    assert!(notices(&harness)[1].contains("cannot write to the library"));
    assert!(!state(&harness).notices[1].advice.is_empty());
    assert!(enrol_of(&harness).draft.is_some());
    press_keys(&mut harness, Modifiers::NONE, Key::Space);
    assert_eq!(enrol_of(&harness).num_drafts, 2);
}

#[test]
fn the_inspected_scene_is_taken_at_one_press_and_captures_stay_with_the_workspace() {
    let library = library();
    let mut harness = open(library.path());
    let shown = state(&harness)
        .session
        .shown
        .as_ref()
        .expect("a result")
        .generation;
    press(&mut harness, "Use the inspected scene");
    assert!(num_kept(&harness) > 1000);
    press_keys(&mut harness, Modifiers::NONE, Key::Space);
    assert_eq!(enrol_of(&harness).num_drafts, 2);
    let still = state(&harness)
        .session
        .shown
        .as_ref()
        .expect("a result")
        .generation;
    assert_eq!(
        (still, state(&harness).session.workspace),
        (shown, WorkspaceKind::Enrol)
    );
    press(&mut harness, "Everything");
    assert!(num_kept(&harness) > 200_000);
    press(&mut harness, "Undo the last step");
    assert!(num_kept(&harness) < 200_000);
}

#[test]
fn a_damaged_part_is_shown_and_can_be_removed() {
    let library = library();
    let mut harness = open(library.path());
    enrol(&mut harness, PartKind::Grille, "Grille");
    std::fs::write(library.path().join("grille").join("part.toml"), "x").expect("written");
    enrol(&mut harness, PartKind::Fender, "Fender");
    press(&mut harness, "Enrolled: grille");
    press(&mut harness, "Remove");
    assert_eq!(names(library.path()), ["fender"]);
    let folder = LibraryFolder::open(library.path()).expect("there");
    let grille = PartName::new("grille").expect("a name");
    assert_eq!(folder.trashed().expect("listed")[0].name, grille);
}

#[test]
fn every_control_is_large_enough_labelled_and_inside_a_small_window() {
    let size = SMALL;
    let library = library();
    let mut harness = open_at(library.path(), size);
    press(&mut harness, "Enrol");
    enrol(&mut harness, PartKind::Grille, "Grille");
    for step in ["empty", "open", "draft"] {
        match step {
            "open" => press(&mut harness, "Enrolled: Grille"),
            "draft" => capture(&mut harness, PartKind::FrontDoor, Side::Right),
            _ => {}
        }
        let mut num_controls = 0;
        for role in [Role::Button, Role::Tab, Role::TextInput] {
            for node in harness.query_all_by_role(role) {
                let label = node.accesskit_node().label().unwrap_or_default();
                let rect = node.rect();
                assert!(
                    !label.is_empty(),
                    "{step}: a control at {rect:?} has no label"
                );
                assert!(
                    rect.width() >= 35.9 && rect.height() >= 35.9,
                    "{step}: {label}: {rect:?}"
                );
                // Long lists scroll, so their controls may lie further to the right or below.
                assert!(rect.min.x >= 0.0 && rect.min.y >= 0.0, "{label}: {rect:?}");
                num_controls += 1;
            }
        }
        assert!(num_controls >= 10, "{step}: {num_controls} controls");
        let save = harness.query_by_label("Save");
        assert!(save.is_none_or(|save| save.rect().max.y <= size.y));
    }
}

#[test]
fn without_a_library_the_window_says_so_everywhere_and_still_captures() {
    let folder = tempfile::tempdir().expect("a folder");
    let missing = folder.path().join("WRONG");
    let mut harness = open_at(&missing, USUAL);
    let shown = &state(&harness).notices[0];
    assert!(shown.what.contains("could not be loaded"), "{shown:?}");
    assert!(shown.what.contains("no such library folder"), "{shown:?}");
    assert!(shown.advice.contains("create the folder"), "{shown:?}");
    assert_eq!(notices(&harness).len(), 1);
    // The scene is shown, and no part is named.
    let shown = state(&harness).session.shown.as_ref().expect("captured");
    assert!(!shown.inspected.inspection.verdict.is_accepted());
    press_keys(&mut harness, Modifiers::NONE, Key::Space);
    settle(&mut harness);
    assert_eq!(notices(&harness).len(), 1, "said once");
    for workspace in [WorkspaceKind::Enrol, WorkspaceKind::Align] {
        act(&mut harness, Action::GoTo(workspace));
        settle(&mut harness);
        assert!(harness.query_by_label_contains("being loaded").is_none());
        assert!(
            harness
                .query_all_by_label_contains("could not be loaded")
                .count()
                > 1
        );
    }
    // Create the folder; the next capture finds it.
    std::fs::create_dir(&missing).expect("made");
    act(&mut harness, Action::GoTo(WorkspaceKind::Inspect));
    act(&mut harness, Action::Capture);
    settle(&mut harness);
    let library = state(&harness).session.library.as_ref().expect("loaded");
    assert!(library.unloaded.is_none());
}

#[test]
fn without_a_library_the_button_says_why_nothing_can_be_saved() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open(&folder.path().join("missing"));
    capture(&mut harness, PartKind::Grille, Side::Left);
    write(&mut harness, "Title", "Grille");
    harness.get_by_label("This library cannot be changed: see above");
    assert!(harness.get_by_label("Save").accesskit_node().is_disabled());
}

#[test]
fn a_window_that_starts_in_enrol_has_its_library_an_inspection_and_its_history() {
    let folder = tempfile::tempdir().expect("a folder");
    let settings = folder.path().join("settings.toml");
    let options = |scene| WindowOptions {
        settings: Some(settings.clone()),
        history: Some(folder.path().join("history")),
        scene,
        ..plain_options()
    };
    drop(open_with(USUAL, options(None)));
    let left_in_enrol = "workspace = \"enrol\"\n";
    std::fs::write(&settings, left_in_enrol).expect("written");

    let harness = open_with(USUAL, options(None));
    assert_eq!(state(&harness).session.workspace, WorkspaceKind::Enrol);
    harness.get_by_label("Enrolled: Front door, left");
    harness.get_by_label("Use the inspected scene");
    assert_eq!(history_of(&harness).num_rows(), 2);
    drop(harness);

    // The same holds if the given scene cannot be read.
    let broken = folder.path().join("broken.pcd");
    std::fs::write(&broken, "VERSION .7\nFIELDS x y z\nPOINTS 9999999999\n").expect("written");
    std::fs::write(&settings, left_in_enrol).expect("written");
    let mut harness = open_with(USUAL, options(Some(broken)));
    assert_eq!(state(&harness).session.workspace, WorkspaceKind::Inspect);
    assert_eq!(notices(&harness).len(), 1);
    act(&mut harness, Action::GoTo(WorkspaceKind::Enrol));
    harness.get_by_label("Enrolled: Front door, left");
    assert_eq!(history_of(&harness).num_rows(), 2);
}

#[test]
fn a_title_that_another_part_has_is_warned_about_unless_it_is_one_more_reference() {
    let library = library();
    let mut harness = open(library.path());
    enrol(&mut harness, PartKind::Fender, "Wing");
    capture(&mut harness, PartKind::Fender, Side::Right);
    write(&mut harness, "Title", " wing");
    write(&mut harness, "Name", "wing_b");
    let warning = "Wing has the title \"wing\" too";
    harness.get_by_label(warning);
    press(&mut harness, "One more reference of: No other part");
    press(&mut harness, "Reference of: Wing");
    assert!(harness.query_by_label(warning).is_none());
    assert!(
        harness
            .query_by_label("The two cannot be told apart")
            .is_none()
    );
    press(&mut harness, "Save");
    let folder = LibraryFolder::open(library.path()).expect("there");
    let name = |name: &str| PartName::new(name).expect("a name");
    let references = folder.references_of(&name("wing")).expect("listed");
    assert_eq!(references, [name("wing_b")]);
    // The inspection gives the part's name.
    let shown = state(&harness).session.shown.as_ref().expect("inspected");
    let verdict = &shown.inspected.inspection.verdict;
    assert!(
        matches!(verdict, Verdict::Part { part, .. } if part == "wing"),
        "{verdict:?}"
    );
    press(&mut harness, "Undo");
    assert_eq!(folder.references_of(&name("wing")).expect("listed"), []);
}

#[test]
fn one_more_reference_needs_no_title_and_is_unsaved_work_without_one() {
    let (library, folder) = (library(), tempfile::tempdir().expect("a folder"));
    let options = WindowOptions {
        library: Some(library.path().to_owned()),
        settings: Some(folder.path().join("settings.toml")),
        ..plain_options()
    };
    let mut harness = open_with(USUAL, options);
    act(&mut harness, Action::GoTo(WorkspaceKind::Enrol));
    enrol(&mut harness, PartKind::Fender, "Wing");
    capture(&mut harness, PartKind::Grille, Side::Right);
    press(&mut harness, "One more reference of: No other part");
    press(&mut harness, "Reference of: Wing");
    act(&mut harness, Action::Close);
    harness.get_by_label("The part in Enrol is not saved");
    press(&mut harness, "Keep the window open");
    pass_time(&mut harness);
    let kept = fs::read_to_string(folder.path().join("draft.json")).expect("written");
    assert!(kept.contains("\"reference_of\":\"wing\""), "{kept}");
    press(&mut harness, "Save");
    assert_eq!(names(library.path()), ["wing", "wing_2"]);
    let tile = harness.get_by_label("Enrolled: wing_2");
    let value = tile.accesskit_node().value().unwrap_or_default();
    assert!(
        value.starts_with("Saved, ") && value.ends_with(" · Reference of: Wing"),
        "{value}"
    );
}

#[test]
fn what_another_program_does_to_the_library_is_noticed_and_a_draft_is_left_alone() {
    let library = library();
    let mut harness = open(library.path());
    let mut other = open(library.path());
    capture(&mut harness, PartKind::Fender, Side::Right);
    write(&mut harness, "Title", "Fender");
    enrol(&mut other, PartKind::Grille, "Grille");
    press(&mut harness, "Inspect");
    wait_until(&mut harness, |state| {
        let library = state.session.library.as_ref();
        library.is_some_and(|library| library.parts.len() == 1)
    });
    settle(&mut harness);
    assert!(
        notices(&harness)
            .contains(&"Library reloaded, another program has changed it: 1 part".to_owned()),
        "{:?}",
        notices(&harness)
    );
    press(&mut harness, "Enrol");
    let draft = enrol_of(&harness).draft.as_ref().expect("the draft");
    assert_eq!(draft.form.title, "Fender");
    harness.get_by_label("Enrolled: Grille");
    let folder = LibraryFolder::open(library.path()).expect("there");
    folder
        .remove(&"grille".parse().expect("a name"))
        .expect("removed");
    press(&mut harness, "Inspect");
    wait_until(&mut harness, |state| {
        let library = state.session.library.as_ref();
        library.is_some_and(|library| library.parts.is_empty())
    });
}
