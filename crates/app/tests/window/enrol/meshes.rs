//! Choosing among the meshes of a file.

use std::{fmt::Write as _, fs, path::Path};

use app::workspaces::enrol::{EnrolAction, EnrolWorkspace, meshes::MeshAction};
use egui::{Event, Key, Modifiers, PointerButton, Role};
use egui_kittest::{
    Node,
    kittest::{NodeT as _, Queryable as _},
};
use files::fixtures::obj_of;
use geometry::mesh::TriangleMesh;
use nalgebra::Point3;
use simulate::{PartKind, PartModel, Side};

use super::{library, names, notices, open, open_at, press_keys};
use crate::set_up::{SMALL, WindowHarness, act_in, drop_file, enrol_of, press, settle};

/// Writes a car of three parts and a line, which has no area.
pub(crate) fn write_car(path: &Path) {
    let kinds = [PartKind::Fender, PartKind::Grille, PartKind::TrunkLid];
    let [fender, grille, lid] = kinds.map(|kind| PartModel::new(kind, Side::Left, 0));
    let line = TriangleMesh {
        vertices: [0.0, 0.1, 0.2].map(|x| Point3::new(x, 0.0, 0.0)).to_vec(),
        triangles: vec![[0, 1, 2]],
    };
    let text = obj_of(&[
        ("Fender", fender.mesh()),
        ("Grille", grille.mesh()),
        ("Line", &line),
        ("Lid", lid.mesh()),
    ]);
    fs::write(path, text).expect("written");
}

fn find_row<'a>(harness: &'a WindowHarness, name: &str) -> Option<Node<'a>> {
    let mut rows = harness.query_all_by_role(Role::CheckBox);
    rows.find(|row| {
        // The size follows the name.
        let label = row.accesskit_node().label().unwrap_or_default();
        label.split(',').next() == Some(name)
    })
}

fn row<'a>(harness: &'a WindowHarness, name: &str) -> Node<'a> {
    find_row(harness, name).unwrap_or_else(|| panic!("no row of {name}"))
}

fn tick(harness: &mut WindowHarness, name: &str) {
    row(harness, name).click();
    harness.run_steps(4);
}

fn write_search(harness: &mut WindowHarness, words: &str) {
    let field = harness.get_by_role_and_label(Role::TextInput, "Find a mesh");
    assert!(field.is_focused());
    field.type_text(words);
    settle(harness);
}

fn title(harness: &WindowHarness) -> &str {
    let draft = enrol_of(harness).draft.as_ref().expect("a draft");
    &draft.form.title
}

#[test]
fn meshes_of_a_dropped_file_are_chosen_and_enrolled_one_after_the_other() {
    let (library, files) = (library(), tempfile::tempdir().expect("a folder"));
    let path = files.path().join("car.obj");
    write_car(&path);
    let mut harness = open(library.path());
    drop_file(&mut harness, &path);
    harness.get_by_label("Meshes of car.obj");
    harness.get_by_label("4 of 4 meshes");
    assert!(enrol_of(&harness).draft.is_none());
    let line = row(&harness, "Line");
    assert!(line.accesskit_node().is_disabled());
    assert!(
        line.value().expect("a reason").contains("no area"),
        "{line:?}"
    );
    tick(&mut harness, "Line");
    assert!(
        harness
            .get_by_label("Enrol meshes")
            .accesskit_node()
            .is_disabled()
    );

    press(&mut harness, "Sort by Name");
    tick(&mut harness, "Grille");
    tick(&mut harness, "Lid");
    tick(&mut harness, "Fender");
    tick(&mut harness, "Lid");
    press(&mut harness, "Enrol 2 meshes");
    assert!(harness.query_by_label("Meshes of car.obj").is_none());
    harness.get_by_label("Mesh 1 of 2");
    assert_eq!(title(&harness), "Fender");
    press(&mut harness, "Save");
    harness.get_by_label("Mesh 2 of 2");
    assert_eq!(title(&harness), "Grille");
    press(&mut harness, "Save");
    assert!(enrol_of(&harness).draft.is_none());
    assert_eq!(names(library.path()), ["fender", "grille"]);
    let saved = harness.state().state().session.library.as_ref();
    assert_eq!(
        saved.expect("loaded").parts[1].enrolled.from,
        "car.obj#Grille"
    );
}

#[test]
fn a_chosen_mesh_is_skipped_or_the_rest_is_left_out() {
    let (library, files) = (library(), tempfile::tempdir().expect("a folder"));
    let path = files.path().join("car.obj");
    write_car(&path);
    let mut harness = open(library.path());
    drop_file(&mut harness, &path);
    for name in ["Fender", "Grille", "Lid"] {
        tick(&mut harness, name);
    }
    press(&mut harness, "Enrol 3 meshes");
    let first = title(&harness).to_owned();
    press(&mut harness, "Skip");
    harness.get_by_label("Mesh 2 of 3");
    assert_ne!(title(&harness), first);
    press(&mut harness, "Leave out the rest");
    assert!(harness.query_by_label("Mesh 2 of 3").is_none());
    press(&mut harness, "Discard");
    assert!(enrol_of(&harness).draft.is_none());
    assert!(names(library.path()).is_empty());
}

#[test]
fn the_list_is_searched_and_left_by_keys() {
    let (library, files) = (library(), tempfile::tempdir().expect("a folder"));
    let path = files.path().join("car.obj");
    write_car(&path);
    let mut harness = open(library.path());
    drop_file(&mut harness, &path);
    write_search(&mut harness, "wheel");
    harness.get_by_label("No mesh has these words in its name");
    press_keys(&mut harness, Modifiers::NONE, Key::Enter);
    harness.get_by_label("0 of 4 meshes");
    press_keys(&mut harness, Modifiers::NONE, Key::Escape);
    assert!(harness.query_by_label("Meshes of car.obj").is_none());
    assert!(enrol_of(&harness).draft.is_none());

    drop_file(&mut harness, &path);
    write_search(&mut harness, "GRI");
    assert!(find_row(&harness, "Grille").is_some());
    assert!(find_row(&harness, "Fender").is_none());
    press_keys(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(title(&harness), "Grille");
    assert!(harness.query_by_label_contains("Mesh 1 of").is_none());

    drop_file(&mut harness, &path);
    press(&mut harness, "Sort by Name");
    for key in [Key::ArrowDown, Key::ArrowDown, Key::ArrowDown, Key::ArrowUp] {
        press_keys(&mut harness, Modifiers::NONE, key);
    }
    assert!(row(&harness, "Grille").is_focused());
    press_keys(&mut harness, Modifiers::NONE, Key::ArrowUp);
    press_keys(&mut harness, Modifiers::NONE, Key::Space);
    harness.get_by_label("Enrol 1 mesh");
    press_keys(&mut harness, Modifiers::NONE, Key::Enter);
    assert_eq!(title(&harness), "Fender");
}

#[test]
fn a_double_click_enrols_a_mesh_at_once() {
    let (library, files) = (library(), tempfile::tempdir().expect("a folder"));
    let path = files.path().join("car.obj");
    write_car(&path);
    let mut harness = open(library.path());
    drop_file(&mut harness, &path);
    let pos = row(&harness, "Lid").rect().center();
    harness.hover_at(pos);
    harness.run_steps(2);
    let clicks = [true, false, true, false].map(|pressed| Event::PointerButton {
        pos,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    });
    harness.input_mut().events.extend(clicks);
    settle(&mut harness);
    assert_eq!(title(&harness), "Lid");
}

#[test]
fn a_file_is_read_in_another_unit_and_as_one_part() {
    let (library, files) = (library(), tempfile::tempdir().expect("a folder"));
    let path = files.path().join("car.obj");
    write_car(&path);
    let mut harness = open(library.path());
    drop_file(&mut harness, &path);
    harness.get_by_label_contains("Line, 200 × 0 × 0 mm");
    press(&mut harness, "Lengths in cm");
    harness.get_by_label_contains("Line, 2 × 0 × 0 mm");
    press(&mut harness, "Lengths in m");
    press(&mut harness, "All as one part");
    let draft = enrol_of(&harness).draft.as_ref().expect("a draft");
    assert_eq!(draft.subject.origin.title(), "car.obj");
    assert_eq!(draft.chosen, None);
}

#[test]
fn why_a_file_could_not_be_read_leaves_once_meshes_are_listed() {
    let (library, files) = (library(), tempfile::tempdir().expect("a folder"));
    let [broken, path] = ["broken.obj", "car.obj"].map(|name| files.path().join(name));
    fs::write(&broken, "v 0 0\n").expect("written");
    write_car(&path);
    let mut harness = open(library.path());
    drop_file(&mut harness, &broken);
    assert!(notices(&harness)[0].contains("broken.obj"));
    drop_file(&mut harness, &path);
    assert_eq!(notices(&harness), [""; 0]);
    // With another file, the list of this one goes.
    drop_file(&mut harness, &broken);
    assert!(enrol_of(&harness).mesh_list.is_none());
}

#[test]
fn of_ten_thousand_meshes_those_in_sight_are_drawn_in_a_small_window() {
    let (library, files) = (library(), tempfile::tempdir().expect("a folder"));
    let path = files.path().join("car.obj");
    let mut text = String::from("v 0 0 0\nv 0.5 0 0\nv 0 0.5 0\n");
    for number in 0..10_000 {
        writeln!(text, "o bolt_{number}\nf 1 2 3").expect("written");
    }
    fs::write(&path, text).expect("written");
    let mut harness = open_at(library.path(), SMALL);
    press(&mut harness, "Enrol");
    drop_file(&mut harness, &path);
    harness.get_by_label("10000 of 10000 meshes");
    let num_rows = harness.query_all_by_role(Role::CheckBox).count();
    assert!((4..20).contains(&num_rows), "{num_rows}");
    for label in [
        "Find a mesh",
        "Sort by Size",
        "Sort by Name",
        "Lengths in mm",
        "Enrol meshes",
        "All as one part",
        "Cancel",
    ] {
        let rect = harness.get_by_label(label).rect();
        assert!(rect.height() >= 35.9, "{label}: {rect:?}");
        assert!(rect.min.x >= 0.0 && rect.min.y >= 0.0, "{label}: {rect:?}");
        assert!(
            rect.max.x <= SMALL.x && rect.max.y <= SMALL.y,
            "{label}: {rect:?}"
        );
    }
    press(&mut harness, "Sort by Name");
    for _ in 0..12 {
        press_keys(&mut harness, Modifiers::NONE, Key::ArrowDown);
    }
    let reached = row(&harness, "bolt_11");
    assert!(reached.is_focused());
    // The last row is the only one found.
    act_in(&mut harness, |enrol: &mut EnrolWorkspace, cx| {
        let search = MeshAction::Search("9999".into());
        enrol.state.apply(EnrolAction::Meshes(search), cx);
    });
    harness.get_by_label("1 of 10000 meshes");
    assert!(find_row(&harness, "bolt_9999").is_some());
}
