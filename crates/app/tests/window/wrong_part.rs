//! The operator's page for a part that was recognised wrongly: its tiles, and the label that one of them stores.

use egui::Key;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use inspection::library::Truth;
use shell::{
    action::Action, inspection::source::CellChoice, roles::RoleAction, session::WorkspaceKind,
};

use super::{
    live::{sees, toggle, wired_options},
    operator::{open_operators, write_unknown},
    set_up::{
        SMALL, USUAL, WindowHarness, act, history_of, is_recognised, open_with, plain_options,
        press, settle, wait_until,
    },
};

/// Waits until the window knows this as the true label of the part on the screen.
fn wait_for_label(harness: &mut WindowHarness, label: Option<&Truth>) {
    wait_until(harness, |state| {
        let labelled = state.session.shift.labelled.first();
        labelled.map(|(_, label)| label) == label
    });
    harness.run_steps(2);
}

#[test]
fn a_part_that_is_labelled_as_another_one_is_no_longer_ok() {
    let mut harness = open_operators(plain_options());
    harness.get_by_label("Recognised");
    press(&mut harness, "Wrong part?");
    press(&mut harness, "None of these");
    harness.get_by_label("Stored in the history. Actual part: Not enrolled");
    wait_for_label(&mut harness, Some(&Truth::NotEnrolled));
    let workspace = harness.state().state().session.workspace;
    assert_eq!(workspace, WorkspaceKind::Inspect, "back at work");
    harness.get_by_label("NOK");
    harness.get_by_label("Reported as wrong");
    harness.get_by_label("Do not start the robot: tell the engineer");
    // The engineer's card says it too.
    act(&mut harness, Action::Role(RoleAction::Switch));
    press(&mut harness, "Switch");
    harness.get_by_label("Reported as wrong");
    harness.get_by_label("Actual part: Not enrolled");
    assert!(!is_recognised(&harness));
}

#[test]
fn what_an_operator_said_of_a_part_is_undone_and_corrected() {
    let mut harness = open_operators(plain_options());
    press(&mut harness, "Wrong part?");
    press(&mut harness, "Actual part: Grille");
    let grille = Truth::Part("grille".into());
    wait_for_label(&mut harness, Some(&grille));
    harness.get_by_label("Undo").click();
    harness.run_steps(2);
    wait_for_label(&mut harness, None);
    harness.get_by_label("Recognised");

    press(&mut harness, "Wrong part?");
    press(&mut harness, "Actual part: Grille");
    wait_for_label(&mut harness, Some(&grille));
    press(&mut harness, "Wrong part?");
    let value = |label: &str| {
        let tile = harness.get_by_label(label);
        tile.accesskit_node().value()
    };
    let door = "Actual part: Front door, left";
    assert_eq!(value(door).as_deref(), Some("Recognised as this"));
    let grille = value("Actual part: Grille");
    assert_eq!(grille.as_deref(), Some("Actual part so far"));
    press(&mut harness, door);
    wait_for_label(&mut harness, Some(&Truth::Part("front_door".into())));
    harness.get_by_label("Recognised");
}

#[test]
fn the_tiles_of_the_parts_are_large_and_the_likeliest_is_first() {
    let mut harness = open_operators(plain_options());
    for size in [SMALL, USUAL] {
        harness.set_size(size);
        press(&mut harness, "Wrong part?");
        let tiles = harness.query_all_by_label_contains("Actual part: ");
        let mut tiles: Vec<(String, egui::Rect)> = tiles
            .map(|tile| {
                let label = tile.accesskit_node().label();
                (label.unwrap_or_default(), tile.rect())
            })
            .collect();
        assert_eq!(tiles.len(), 8);
        for (label, rect) in &tiles {
            let is_large = rect.width() >= 160.0 && rect.height() >= 160.0;
            let is_inside = rect.right() <= size.x && rect.bottom() <= size.y;
            assert!(is_large && is_inside, "{label}: {rect:?}");
        }
        let place = |rect: &egui::Rect| [rect.top(), rect.left()];
        tiles.sort_by(|(_, a), (_, b)| place(a).partial_cmp(&place(b)).expect("finite"));
        assert_eq!(tiles[0].0, "Actual part: Front door, left");
        let others = tiles[5..].iter().map(|(label, _)| label);
        assert!(others.is_sorted(), "{tiles:?}");
        // Nothing is changed by leaving.
        press(&mut harness, "Back");
        harness.get_by_label("Recognised");
        press(&mut harness, "Wrong part?");
        harness.key_press(Key::Escape);
        settle(&mut harness);
        harness.get_by_label("Recognised");
        assert_eq!(history_of(&harness).row(0).expect("kept").label, None);
    }
}

#[test]
fn wrong_part_is_about_the_part_on_the_screen_and_waits_for_its_verdict() {
    let (options, wire) = wired_options();
    let mut harness = open_operators(options);
    let is_disabled = |harness: &WindowHarness| {
        let button = harness.get_by_label("Wrong part?");
        button.accesskit_node().is_disabled()
    };
    assert!(!is_disabled(&harness), "the first frame of the window");
    toggle(&mut harness);
    sees(&mut harness, &wire, [0.0; 4]);
    assert!(is_disabled(&harness), "only looked at so far");
    sees(&mut harness, &wire, [0.0; 18]);
    assert!(!is_disabled(&harness));
    sees(&mut harness, &wire, [0.03, 0.06]);
    harness.get_by_label("Moving");
    assert!(is_disabled(&harness), "it may be another part");
}

#[test]
fn what_a_part_really_is_goes_to_it_though_the_next_one_hangs_there_by_now() {
    let mut harness = open_operators(plain_options());
    press(&mut harness, "Wrong part?");
    act(&mut harness, Action::Capture);
    press(&mut harness, "Actual part: Grille");
    let labels = [0, 1].map(|row| history_of(&harness).row(row).expect("kept").label.clone());
    assert_eq!(labels, [None, Some(Truth::Part("grille".into()))]);
}

#[test]
fn a_file_that_is_opened_again_is_the_wrong_part_and_not_what_was_inspected_since() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("again.pcd");
    write_unknown(&path);
    let mut harness = open_with(SMALL, plain_options());
    act(&mut harness, Action::Open(path.clone()));
    settle(&mut harness);
    act(&mut harness, Action::UseCell(CellChoice::InTurn));
    settle(&mut harness);
    act(&mut harness, Action::Open(path));
    settle(&mut harness);
    act(&mut harness, Action::Role(RoleAction::Switch));
    press(&mut harness, "Wrong part?");
    press(&mut harness, "None of these");
    let rows = (0..).map_while(|row| history_of(&harness).row(row));
    let labelled = rows.filter(|row| row.label.is_some());
    let scenes: Vec<String> = labelled.map(|row| row.scene.to_string()).collect();
    assert_eq!(scenes, ["again.pcd"]);
}
