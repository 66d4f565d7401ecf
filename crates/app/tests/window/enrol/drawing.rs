//! Boxes and lassos.

use egui::{Key, Modifiers, Vec2};
use egui_kittest::kittest::Queryable as _;
use simulate::{PartKind, Side};
use ui::viewport::DrawnShape;

use super::{
    capture, drag, draw, draw_in_view, in_view, kept, let_go, library, num_kept, open, press_keys,
};
use crate::set_up::{WindowHarness, enrol_of, press};

#[test]
fn a_box_is_drawn_by_keys_alone() {
    let library = library();
    let mut harness = open(library.path());
    capture(&mut harness, PartKind::BackDoor, Side::Right);
    let before = num_kept(&harness);
    harness.get_by_label("Drop").click();
    harness.get_by_label("Picture of what is kept").focus();
    harness.run_steps(2);
    for _ in 0..4 {
        harness.key_press(Key::ArrowRight);
        harness.run_steps(2);
    }
    harness.key_press_modifiers(Modifiers::SHIFT, Key::ArrowDown);
    harness.run_steps(2);
    press_keys(&mut harness, Modifiers::NONE, Key::Enter);
    let dropped = num_kept(&harness);
    assert!(dropped < before, "{dropped} of {before}");
}

#[test]
fn a_box_drawn_in_the_3d_view_cuts_the_part_and_undo_brings_it_back() {
    let library = library();
    let mut harness = open(library.path());
    capture(&mut harness, PartKind::BackDoor, Side::Right);
    press(&mut harness, "Show 3-d");
    let whole = kept(&harness);
    // Cut the middle of the view from the front, then from the side, where the same box covers fewer points.
    let mut cut_from = |side: &str| {
        press(&mut harness, side);
        press(&mut harness, "Box");
        press(&mut harness, "Drop");
        harness.get_by_label_contains("Draw a box. What lies inside is dropped.");
        let [from, to] = [(0.45, 0.4), (0.55, 0.6)].map(|(x, y)| in_view(&harness, x, y));
        drag(&mut harness, from, to);
        let left = kept(&harness);
        assert!(!left.is_empty() && left.len() < whole.len());
        assert!(left.iter().all(|i| whole.binary_search(i).is_ok()));
        press_keys(&mut harness, Modifiers::COMMAND, Key::Z);
        assert_eq!(kept(&harness), whole);
        press_keys(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
        assert_eq!(kept(&harness), left);
        press(&mut harness, "Reset all corrections");
        assert_eq!(kept(&harness), whole);
        left
    };
    let from_the_front = cut_from("Front");
    assert_ne!(from_the_front, cut_from("Side"));

    // A click or a line is not a box.
    let at = in_view(&harness, 0.5, 0.5);
    for to in [Vec2::new(1.0, 1.0), Vec2::new(200.0, 1.0)] {
        drag(&mut harness, at, at + to);
        let draft = enrol_of(&harness).draft.as_ref().expect("a draft");
        assert!(draft.corrections.edits.is_empty());
    }
}

#[test]
fn a_lasso_keeps_or_adds_what_it_goes_around_in_the_view_and_in_the_picture() {
    let library = library();
    let mut harness = open(library.path());
    capture(&mut harness, PartKind::BackDoor, Side::Right);
    press(&mut harness, "Front");
    let whole = kept(&harness);
    press(&mut harness, "Lasso");
    harness.get_by_label_contains("Draw a lasso. What lies outside is dropped.");
    // Draw a triangle over the right half of the view.
    draw_in_view(&mut harness, &[(0.5, 0.3), (0.95, 0.5), (0.5, 0.7)]);
    let_go(&mut harness);
    let left = kept(&harness);
    assert!(!left.is_empty() && left.len() < whole.len() / 2);

    // Add everything around the part, including the wall.
    press(&mut harness, "Add");
    let about_all = [(0.2, 0.2), (0.8, 0.2), (0.8, 0.8), (0.2, 0.8)];
    draw_in_view(&mut harness, &about_all);
    let_go(&mut harness);
    assert!(
        kept(&harness)
            .iter()
            .any(|i| whole.binary_search(i).is_err())
    );
    assert!(left.iter().all(|i| kept(&harness).binary_search(i).is_ok()));

    press(&mut harness, "Drop");
    let picture = harness.get_by_label("Picture of what is kept").rect();
    let before = kept(&harness);
    let way = [(0.3, 0.3), (0.7, 0.3), (0.5, 0.7)];
    let way = way.map(|(x, y)| picture.min + picture.size() * Vec2::new(x, y));
    draw(&mut harness, &way);
    let_go(&mut harness);
    let after = kept(&harness);
    let is_dropped = |x: u32, y: u32| after.binary_search(&(y * 640 + x)).is_err();
    assert!(after.len() < before.len() && is_dropped(320, 200));
    let beside = |i: &u32| i % 640 < 180 || i % 640 > 460;
    assert!(
        before
            .iter()
            .filter(|i| beside(i))
            .eq(after.iter().filter(|i| beside(i)))
    );
}

#[test]
fn escape_gives_a_lasso_up_and_dragging_turns_the_view_again() {
    let library = library();
    let mut harness = open(library.path());
    capture(&mut harness, PartKind::BackDoor, Side::Right);
    let whole = kept(&harness);
    let shape = |harness: &WindowHarness| enrol_of(harness).shape;
    press_keys(&mut harness, Modifiers::NONE, Key::D);
    assert_eq!(shape(&harness), Some(DrawnShape::Box));
    press_keys(&mut harness, Modifiers::NONE, Key::D);
    assert_eq!(shape(&harness), Some(DrawnShape::Lasso));
    draw_in_view(&mut harness, &[(0.3, 0.3), (0.7, 0.3), (0.5, 0.7)]);
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert_eq!(shape(&harness), None);
    harness.hover_at(in_view(&harness, 0.3, 0.7));
    harness.run_steps(2);
    let_go(&mut harness);
    assert_eq!(kept(&harness), whole);
    // A drag rotates the view and cuts nothing.
    draw_in_view(&mut harness, &[(0.3, 0.3), (0.7, 0.3), (0.5, 0.7)]);
    let_go(&mut harness);
    assert_eq!(kept(&harness), whole);
    assert!(
        enrol_of(&harness)
            .draft
            .as_ref()
            .is_some_and(|draft| draft.corrections.edits.is_empty())
    );
}

#[test]
fn a_lasso_about_everything_drops_it_all_and_the_card_says_what_is_missing() {
    let library = library();
    let mut harness = open(library.path());
    capture(&mut harness, PartKind::Grille, Side::Left);
    let whole = kept(&harness);
    press(&mut harness, "Box");
    press(&mut harness, "Drop");
    let [from, to] = [(0.01, 0.01), (0.99, 0.99)].map(|(x, y)| in_view(&harness, x, y));
    // Start below the controls that lie over the view.
    drag(&mut harness, from + Vec2::new(0.0, 60.0), to);
    assert!(kept(&harness).is_empty());
    harness.get_by_label("Nothing can be saved yet: see above");
    press(&mut harness, "Undo the last step");
    assert_eq!(kept(&harness), whole);
}
