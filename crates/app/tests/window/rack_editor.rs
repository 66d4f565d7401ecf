//! Where parts may hang: the window of the rack.

use egui_kittest::kittest::{NodeT as _, Queryable as _};
use inspection::rack::RackFile;
use nalgebra::Point3;
use shell::{
    action::Action,
    rack::{RackAction, RackInUse},
    roles::RoleAction,
    session::Shown,
    settings::{self, Settings},
};

use super::{
    set_up::{WindowHarness, act, let_pass, open, settle},
    several_parts::{open_rack, open_three_things},
};

/// Opens the window of the rack before a frame of three things, and makes a place of the door.
pub(crate) fn open_place(harness: &mut WindowHarness, folder: &std::path::Path) {
    open_rack(harness, folder);
    act(harness, Action::Rack(RackAction::Toggle));
    click(harness, "Add a place for this part");
}

fn click(harness: &mut WindowHarness, label: &str) {
    harness.get_by_label(label).click();
    harness.run_steps(4);
    settle(harness);
}

/// The place and the reason of each part.
fn shown(harness: &WindowHarness) -> Vec<String> {
    let shown: &Shown = harness
        .state()
        .state()
        .session
        .shown
        .as_ref()
        .expect("a result");
    let parts = shown.parts.iter().map(|part| {
        let inspection = &part.inspection;
        let kind = inspection
            .verdict
            .refusal()
            .map(|why| why.kind().to_string());
        let place = inspection.place.as_deref().unwrap_or("none");
        format!("{place} {}", kind.unwrap_or_default())
    });
    parts.collect()
}

fn edit(harness: &mut WindowHarness, file: &RackFile) {
    let action = RackAction::Edit {
        file: Box::new(file.clone()),
        continues: false,
    };
    act(harness, Action::Rack(action));
    harness.run_steps(4);
    settle(harness);
}

#[test]
fn a_place_is_made_of_the_part_in_front_and_a_turned_part_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open();
    open_place(&mut harness, folder.path());
    // It is inspected again at once: nothing may hang beside the place.
    assert_eq!(
        shown(&harness),
        ["1 ", "none unknown", "none beside_places"]
    );
    let add = harness.get_by_label("Add a place for this part");
    assert!(add.accesskit_node().is_disabled());
    add.hover();
    let_pass(&mut harness, 30);
    harness.get_by_label_contains("It hangs at place 1; “Take the part in front”");
    let path = folder.path().join("rack.toml");
    act(&mut harness, Action::Rack(RackAction::Save(path.clone())));
    let saved = RackFile::read(&path).expect("saved");
    let mut turned = saved.clone();
    let angles = turned.rack.places[0].parts[0].angles_rad.as_mut();
    angles.expect("an orientation")[2] += 0.5;
    edit(&mut harness, &turned);
    assert_eq!(
        shown(&harness),
        ["1 turned", "none unknown", "none beside_places"]
    );
    click(&mut harness, "Undo");
    assert_eq!(shown(&harness)[0], "1 ");
    // What is wrong is said, and the rack before it stays in use.
    let mut wrong = saved.clone();
    wrong.rack.places[0].parts[0].name = "gril".into();
    edit(&mut harness, &wrong);
    harness.get_by_label_contains("which is not enrolled");
    assert_eq!(shown(&harness)[0], "1 ");
    // It is kept from one start to the next.
    let kept = folder.path().join("settings.toml");
    let state = harness.state().state();
    settings::save(&kept, &Settings::of(state, None)).expect("saved");
    let (read, problem) = settings::load(&kept);
    assert_eq!(problem, None);
    // The file keeps hundredths of a millimetre.
    let centre = |rack: &RackInUse| Point3::from(rack.in_camera().places[0].region.centre_m);
    let off = (centre(&read.rack) - centre(&state.session.rack)).norm();
    assert!(
        off < 1e-5 && read.rack.title() == state.session.rack.title(),
        "{off}"
    );
    click(&mut harness, "No rack");
    assert_eq!(shown(&harness), ["none ", "none ", "none unknown"]);
}

#[test]
fn while_a_rack_is_edited_every_part_of_a_frame_is_found_and_can_get_a_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open();
    open_three_things(&mut harness, folder.path());
    assert_eq!(shown(&harness), ["none "]);
    act(&mut harness, Action::Rack(RackAction::Toggle));
    settle(&mut harness);
    assert_eq!(shown(&harness), ["none ", "none ", "none unknown"]);
    click(&mut harness, "Add a place for each part");
    assert_eq!(shown(&harness), ["1 ", "2 ", "none unknown"]);
    assert!(
        harness
            .query_by_label("Add a place for each part")
            .is_none()
    );
    click(&mut harness, "Undo");
    assert_eq!(shown(&harness), ["none ", "none ", "none unknown"]);
    click(&mut harness, "Add a place for this part");
    assert_eq!(shown(&harness)[0], "1 ");
    act(&mut harness, Action::Rack(RackAction::Toggle));
    settle(&mut harness);
    assert_eq!(shown(&harness), ["1 "]);
    // Nor does the operator edit it.
    act(&mut harness, Action::Rack(RackAction::Toggle));
    settle(&mut harness);
    assert_eq!(shown(&harness).len(), 3);
    act(&mut harness, Action::Role(RoleAction::Switch));
    settle(&mut harness);
    assert_eq!(shown(&harness), ["1 "]);
    assert!(harness.state().state().session.rack_editor.is_none());
}

#[test]
fn both_views_name_the_empty_places() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open();
    open_place(&mut harness, folder.path());
    assert!(harness.query_by_label_contains("Empty: ").is_none());
    let path = folder.path().join("rack.toml");
    act(&mut harness, Action::Rack(RackAction::Save(path.clone())));
    let mut file = RackFile::read(&path).expect("saved");
    for (name, aside_m) in [("left hook", 5.0), ("3", -5.0)] {
        let mut place = file.rack.places[0].clone();
        place.name = name.into();
        place.region.centre_m[0] += aside_m;
        file.rack.places.push(place);
    }
    edit(&mut harness, &file);
    harness.get_by_label("Empty: left hook, 3");
    act(&mut harness, Action::Role(RoleAction::Switch));
    harness.get_by_label("Empty: left hook, 3");
}
