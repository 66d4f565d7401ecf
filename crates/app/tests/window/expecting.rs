//! What should hang before the camera: chosen in the menu, or by the table of orders.

use std::{fs, path::Path, sync::Arc};

use app::workspaces::inspect::InspectWorkspace;
use egui::{Key, Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use inspection::{pipeline::Recipe, rack::RackFile};
use shell::{
    action::{Action, DialogRequest},
    rack::RackAction,
    roles::RoleAction,
    session::WorkspaceKind,
    settings::{self, Settings},
    state::State,
};

use super::{
    rack_editor::open_place,
    set_up::{
        SMALL, WindowHarness, act, act_in, let_pass, open, open_with, plain_options, press,
        wait_for, wait_until,
    },
    several_parts::{open_rack, open_three_things},
};

const ORDERS: &str = "order;serial;parts
4711;;front_door|radiator_support
4711;S-1;front_door|grille
4712;;front_door|grille
4713;;front_door|radiator_support|grille
4714;;bonnet
";

/// Uses a table of orders.
pub(crate) fn use_orders(harness: &mut WindowHarness, folder: &Path) {
    use_table(harness, folder, ORDERS);
}

/// Uses the table of orders with these lines.
fn use_table(harness: &mut WindowHarness, folder: &Path, orders: &str) {
    let path = folder.join("orders.csv");
    fs::write(&path, orders).expect("written");
    act(harness, Action::Chosen(DialogRequest::Orders, path));
    wait_for(harness, |window| {
        let mut notices = window.state().notices.iter();
        notices.any(|notice| notice.what == "What is expected follows from orders.csv")
    });
}

/// Types into the field of the order.
pub(crate) fn enter_order(harness: &mut WindowHarness, order: &str) {
    harness
        .get_by_role_and_label(Role::TextInput, "Order")
        .click();
    harness.run_steps(2);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    let field = harness.get_by_role_and_label(Role::TextInput, "Order");
    field.type_text(order);
    harness.run_steps(2);
    harness.key_press(Key::Enter);
    harness.run_steps(4);
}

fn notices(harness: &WindowHarness) -> String {
    let notices = harness.state().state().notices.iter();
    notices
        .map(|notice| &*notice.what)
        .collect::<Vec<_>>()
        .join("\n")
}

fn num_shown(state: &State) -> u64 {
    state
        .session
        .shown
        .as_ref()
        .map_or(0, |shown| shown.generation)
}

#[test]
fn the_order_says_what_should_hang_there_and_without_it_nothing_is_captured() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_with(SMALL, plain_options());
    use_orders(&mut harness, folder.path());
    act(&mut harness, Action::Role(RoleAction::Switch));
    let before = num_shown(harness.state().state());
    press(&mut harness, "Capture");
    open_rack(&mut harness, folder.path());
    assert!(
        notices(&harness).contains("No order is given"),
        "{}",
        notices(&harness)
    );
    for (order, why) in [
        ("4710", "Order 4710 is not in the table of orders"),
        ("4714", "bonnet is expected, but not enrolled"),
    ] {
        enter_order(&mut harness, order);
        harness.get_all_by_label_contains(why).next().expect(why);
        press(&mut harness, "Capture");
        assert!(notices(&harness).contains(why), "{}", notices(&harness));
    }
    assert_eq!(
        num_shown(harness.state().state()),
        before,
        "nothing was inspected"
    );

    // The same file again would show the same part, which is of the former order.
    let hang = |number: &str, harness: &mut WindowHarness| {
        let folder = folder.path().join(number);
        fs::create_dir(&folder).expect("made");
        open_rack(harness, &folder);
    };
    enter_order(&mut harness, "4711");
    harness.get_by_label("Expected: Front door, left · Radiator support");
    hang("1", &mut harness);
    assert_eq!(notices(&harness), "");
    harness.get_by_label("2 of 2 as expected");
    assert!(harness.query_by_label("NOK").is_none());
    enter_order(&mut harness, "4712");
    // What is shown is of the former order.
    harness.get_by_label("2 of 2 as expected");
    hang("2", &mut harness);
    harness.get_by_label("1 of 2 as expected");
    harness.get_by_label("NOK");
    harness.get_by_label_contains(
        "3 · Radiator support: Radiator support hangs there instead of Grille",
    );
    harness.get_by_label("3 Radiator support: wrong part");
    enter_order(&mut harness, "4713");
    hang("3", &mut harness);
    harness.get_by_label("2 of 3 as expected");
    harness.get_by_label("NOK");
    harness.get_by_label("Order 4713: Missing: Grille");
    harness.get_by_label("4 Grille: missing");

    // It is read again once it changes.
    let changed = ORDERS.replace(
        "4713;;front_door|radiator_support|grille",
        "4713;;radiator_support|front_door",
    );
    fs::write(folder.path().join("orders.csv"), changed).expect("written");
    wait_until(&mut harness, |state| {
        let expected = state.session.expected();
        expected.is_ok_and(|expected| expected.parts().len() == 2)
    });
    hang("4", &mut harness);
    harness.get_by_label("2 of 2 as expected");
    let remembered = Settings::of(harness.state().state(), None);
    assert_eq!(remembered.orders, Some(folder.path().join("orders.csv")));
    // Only the engineer closes it.
    harness.get_by_label_contains("Expected: ").click();
    harness.run_steps(4);
    assert!(harness.query_by_label("Close the table").is_none());
}

#[test]
fn a_serial_number_of_other_parts_withdraws_the_verdict() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open();
    use_orders(&mut harness, folder.path());
    enter_order(&mut harness, "4711");
    open_rack(&mut harness, folder.path());
    harness.get_by_label("2 of 2 as expected");
    let doubts = |harness: &WindowHarness| {
        let session = &harness.state().state().session;
        let shown = session.shown.as_ref().expect("a result");
        let doubts = session.robot_doubts(&shown.parts[0]);
        doubts.iter().map(station::Doubt::kind).collect::<Vec<_>>()
    };
    assert!(!doubts(&harness).contains(&"other_order"));
    harness.state().state().session.enter_scanned("S-1", 0.0);
    harness.run_steps(4);
    assert_eq!(doubts(&harness)[0], "other_order");
    harness.get_by_label_contains("Its order expects other parts");
}

/// Uses a rack with a place of the door in the frame of three things, and another beside the frame.
fn use_two_places(harness: &mut WindowHarness, folder: &Path) {
    open_place(harness, folder);
    let path = folder.join("rack.toml");
    act(harness, Action::Rack(RackAction::Save(path.clone())));
    let mut file = RackFile::read(&path).expect("saved");
    let mut far = file.rack.places[0].clone();
    far.name = "left hook".into();
    far.region.centre_m[0] += 5.0;
    file.rack.places.push(far);
    file.write(&path).expect("written");
    act(harness, Action::Chosen(DialogRequest::Rack, path));
    wait_until(harness, |state| {
        state.session.rack.in_camera().places.len() == 2
    });
    act(harness, Action::Rack(RackAction::Toggle));
}

/// The numbers of the parts in the list, from top to bottom.
fn numbers_of_rows(harness: &WindowHarness) -> Vec<u8> {
    let buttons = harness.get_all_by_role(Role::Button);
    let rows = buttons.filter_map(|button| {
        let label = button.accesskit_node().label()?;
        let (number, title) = label.split_once(' ')?;
        let number = number.parse().ok().filter(|_| title.contains(": "))?;
        Some((button.rect().top(), number))
    });
    let mut rows: Vec<(f32, u8)> = rows.collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    rows.into_iter().map(|(_, number)| number).collect()
}

/// Presses these controls of the menu of expected parts one after the other.
fn choose(harness: &mut WindowHarness, labels: &[&str]) {
    harness.get_by_label_contains("Expected: ").click();
    harness.run_steps(4);
    for label in labels {
        harness.get_by_label(label).click();
        let_pass(harness, 12);
    }
    harness.key_press(Key::Escape);
    harness.run_steps(4);
}

#[test]
fn a_part_is_chosen_for_each_place_of_the_rack() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open();
    use_two_places(&mut harness, folder.path());
    let at_left = ["left hook: Any part", "Front door, left (left hook)"];
    choose(&mut harness, &at_left);
    harness.get_by_label("Expected: Front door, left (left hook)");
    open_rack(&mut harness, folder.path());
    harness.get_by_label("Wrong place: Front door, left, expected at left hook");
    // The list of that place is still unfolded.
    let moved = [
        "Any part (left hook)",
        "1: Any part",
        "Front door, left (1)",
    ];
    choose(&mut harness, &moved);
    harness.get_by_label("Expected: Front door, left (1)");
    open_rack(&mut harness, folder.path());
    harness.get_by_label("1 Front door, left: as expected");
    choose(&mut harness, &["One more: Grille"]);
    harness.get_by_label("Expected: Front door, left (1) · Grille");
    // A part that is chosen for a place is not dropped with the rack.
    act(&mut harness, Action::Rack(RackAction::Toggle));
    press(&mut harness, "No rack");
    act(&mut harness, Action::Rack(RackAction::Toggle));
    harness.get_by_label_contains("place \"1\", which the rack does not have");
    choose(&mut harness, &["Any part"]);
    harness.get_by_label("Expected: Any part");
}

#[test]
fn what_the_recipe_expects_counts_until_parts_are_chosen() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open();
    let use_recipe = |harness: &mut WindowHarness, expect: &str| {
        let mut recipe = Recipe::default();
        recipe.segment.max_parts = 3;
        recipe.expect = vec![expect.into()];
        act_in(harness, |_: &mut InspectWorkspace, cx| {
            cx.send(Action::UseRecipe(Arc::new(recipe.into())));
        });
    };
    use_recipe(&mut harness, "grille");
    harness.get_by_label("Expected: Grille");
    open_three_things(&mut harness, folder.path());
    harness.get_by_label(
        "Wrong part: Front door, left instead of Grille; Not expected: Radiator support",
    );
    choose(&mut harness, &["One more: Front door, left"]);
    harness.get_by_label("Expected: Front door, left");
    choose(&mut harness, &["As in recipe built-in"]);
    harness.get_by_label("Expected: Grille");
    act(&mut harness, Action::GoTo(WorkspaceKind::Compare));
    harness.get_by_label("Expects Grille");
    act(&mut harness, Action::GoTo(WorkspaceKind::Inspect));
    // It is kept from one start to the next.
    let kept = folder.path().join("settings.toml");
    let settings = Settings::of(harness.state().state(), None);
    settings::save(&kept, &settings).expect("saved");
    let (read, problem) = settings::load(&kept);
    assert_eq!((read == settings, problem), (true, None));
    let before = num_shown(harness.state().state());
    use_recipe(&mut harness, "left hook=grille");
    press(&mut harness, "Capture");
    let why =
        "Recipe built-in: a part is expected at place \"left hook\", which the rack does not have";
    assert!(notices(&harness).contains(why), "{}", notices(&harness));
    assert_eq!(
        num_shown(harness.state().state()),
        before,
        "nothing was inspected"
    );
}

#[test]
fn each_place_of_the_rack_expects_a_part_of_its_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open();
    use_two_places(&mut harness, folder.path());
    let orders = "order;parts
4711;1=front_door|left hook=grille
4712;1=grille
4713;left hook=front_door
4714;hook=grille
";
    use_table(&mut harness, folder.path(), orders);
    for (order, labels) in [
        (
            "4711",
            [
                "Expected: Front door, left (1) · Grille (left hook)",
                "Order 4711: Missing: Grille (left hook)",
                "4 Grille (left hook): missing",
            ],
        ),
        (
            "4712",
            [
                "Expected: Grille (1)",
                "Order 4712: Wrong part: Front door, left instead of Grille",
                "1 Front door, left: wrong part",
            ],
        ),
        (
            "4713",
            [
                "Expected: Front door, left (left hook)",
                "Order 4713: Wrong place: Front door, left, expected at left hook",
                "1 Front door, left: wrong place",
            ],
        ),
    ] {
        enter_order(&mut harness, order);
        // The same file again would show the same part, which is of the former order.
        let folder = folder.path().join(order);
        fs::create_dir(&folder).expect("made");
        open_rack(&mut harness, &folder);
        for label in labels {
            harness.get_by_label(label);
        }
        if order == "4711" {
            assert_eq!(numbers_of_rows(&harness), [1, 4, 2, 3], "place by place");
        }
    }
    enter_order(&mut harness, "4714");
    harness.get_by_label_contains("place \"hook\", which the rack does not have");
}

#[test]
fn parts_are_chosen_with_their_number_and_cleared() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open();
    let more = [
        "One more: Front door, left",
        "One more: Front door, left",
        "One more: Grille",
    ];
    choose(&mut harness, &more);
    harness.get_by_label("Expected: 2 × Front door, left · Grille");
    choose(&mut harness, &["One less: Front door, left"]);
    harness.get_by_label("Expected: Front door, left · Grille");
    open_rack(&mut harness, folder.path());
    harness.get_by_label("1 of 2 as expected");
    harness.get_by_label("1 Front door, left: as expected");
    harness.get_by_label("3 Radiator support: wrong part");
    harness.get_by_label("Wrong part: Radiator support instead of Grille");
    choose(&mut harness, &["Any part"]);
    harness.get_by_label("Expected: Any part");
    open_rack(&mut harness, folder.path());
    harness.get_by_label("2 of 3 accepted");
}
