//! The Inspect workspace, tested by its labels and controls. Only the last tests need a graphics adapter, and report
//! if there is none.

use std::path::PathBuf;

use app::{
    Window,
    workspaces::inspect::{InspectFile, ViewPart},
};
use egui::{Key, Role, Vec2};
use egui_kittest::{Harness, kittest::Queryable as _};
use shell::{action::Action, inspection::source::CellChoice};
use simulate::ObjectKind;
use ui::viewport::{Colouring, ViewportGpu};

use super::set_up::{
    SMALL, USUAL, WindowHarness, act, choose_in_inspect, inspect_of, plain_options, settle,
};

/// Whether the window renders the 3-D view.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Drawn {
    /// No device: the view shows a message.
    InWords,
    /// Rendered on any available device.
    ForReal,
}

fn open_at(size: Vec2, drawn: Drawn) -> WindowHarness {
    let mut builder = Harness::builder().with_size(size);
    if drawn == Drawn::ForReal {
        builder = builder.wgpu();
    }
    let mut harness = builder.build_eframe(|cc| {
        Window::new(&cc.egui_ctx, cc.wgpu_render_state.as_ref(), plain_options()).expect("a thread")
    });
    settle(&mut harness);
    harness
}

fn open() -> WindowHarness {
    open_at(USUAL, Drawn::InWords)
}

/// True if a device can draw; otherwise reports that there is none.
fn can_draw() -> bool {
    match ViewportGpu::headless() {
        Ok(_) => true,
        Err(error) => {
            geometry::fixtures::skipped("PARTSIGHT_REQUIRE_GPU", error);
            false
        }
    }
}

#[test]
fn the_card_shows_the_stand_off_in_the_chosen_units() {
    let mut harness = open();
    // No path is stored: whoever wants to see the assumed one shows its nozzle.
    assert!(
        harness
            .query_by_label("Stand-off of an assumed path")
            .is_none()
    );
    harness.key_press(Key::N);
    harness.run_steps(2);
    harness.get_by_label("Stand-off of an assumed path");
    harness.get_by_label("inside the band");
    let state = harness.state().state();
    let shown = state.session.shown.as_ref().expect("a result");
    let found = shown.inspected.stand_off.as_ref().expect("a pose");
    let found = found.as_ref().expect("a stand-off").clone();
    // The part does not hang in its standard position, which the assumed path does not consider.
    assert!((found.mean.0 - 0.15).abs() > 0.005, "{}", found.mean);
    harness.get_by_label(&format!(
        "Stand-off {:.1} mm of 100.0 mm to 200.0 mm",
        found.mean.mm()
    ));
    harness.key_press(Key::U);
    harness.run_steps(2);
    harness.get_by_label(&format!(
        "Stand-off {:.4} m of 0.1000 m to 0.2000 m",
        found.mean.0
    ));
}

#[test]
fn another_candidate_shows_its_own_alignment() {
    let mut harness = open();
    harness.get_by_label("Enlarge alignment").click();
    harness.run_steps(2);
    let candidates: Vec<String> = {
        let shown = harness
            .state()
            .state()
            .session
            .shown
            .as_ref()
            .expect("a result");
        let figures = &shown.inspected.figures;
        figures.candidates.iter().map(|c| c.title.clone()).collect()
    };
    harness.get_by_label("Alignment, enlarged");
    harness.get_by_label(&candidates[1]).click();
    harness.run_steps(2);
    assert_eq!(inspect_of(&harness).candidate, 1);
    harness.get_by_label("Alignment, enlarged");
    harness.get_by_label(&candidates[7]).click();
    harness.run_steps(2);
    harness.get_by_label("Alignment, enlarged: not aligned: its score was too low to be tried");
}

#[test]
fn what_the_view_shows_is_chosen_in_one_menu_and_by_keys() {
    let mut harness = open();
    let shows = |harness: &WindowHarness, part| inspect_of(harness).parts.contains(&part);
    assert!(!shows(&harness, ViewPart::Camera));
    harness.get_by_label("Show ▼").click();
    harness.run_steps(2);
    for part in ViewPart::ALL {
        harness.get_by_label(&part.title());
    }
    harness.get_by_label("Depth camera").click();
    harness.run_steps(2);
    assert!(shows(&harness, ViewPart::Camera));
    let before = shows(&harness, ViewPart::Outline);
    harness.key_press(Key::C);
    harness.run_steps(2);
    assert_ne!(shows(&harness, ViewPart::Outline), before);
}

#[test]
fn the_colour_menu_colours() {
    let mut harness = open();
    harness.get_by_label("Colour · Deviation ▼").click();
    harness.run_steps(2);
    harness.get_by_label("Height").click();
    harness.run_steps(2);
    harness.get_by_label("Colour · Height ▼");
    let state = inspect_of(&harness);
    assert_eq!(state.colouring, Some(Colouring::Height));
}

#[test]
fn without_a_view_a_picture_of_it_is_refused_in_words() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("view.png");
    let mut harness = open();
    choose_in_inspect(&mut harness, InspectFile::Picture, path.clone());
    let notices = &harness.state().state().notices;
    assert_eq!(notices.len(), 1);
    assert!(
        notices[0].what.contains("no graphics device"),
        "{notices:?}"
    );
    assert!(!path.exists());
}

#[test]
fn a_picture_of_the_view_is_saved_on_its_own_thread() {
    if !can_draw() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let mut harness = open_at(SMALL, Drawn::ForReal);
    // Without an ending the file is a PNG.
    let path = folder.path().join("door");
    choose_in_inspect(&mut harness, InspectFile::Picture, path);
    let notices = &harness.state().state().notices;
    assert!(notices[0].what.contains("door.png"), "{notices:?}");
    let picture = image::open(folder.path().join("door.png")).expect("a picture");
    assert!(picture.width() > 500 && picture.height() > 300);
    let colours: std::collections::BTreeSet<_> = picture.to_rgb8().pixels().map(|p| p.0).collect();
    assert!(colours.len() > 100, "an empty picture");
}

#[test]
fn nothing_of_the_workspace_is_cut_off_in_small_windows() {
    for size in [SMALL, Vec2::new(960.0, 600.0)] {
        let mut harness = open_at(size, Drawn::InWords);
        let copy = harness.get_by_label("Copy pose").rect();
        assert!(copy.max.y <= size.y && copy.max.x <= size.x, "{copy:?}");
        let mut row: Vec<_> = [
            "View ▼",
            "Colour · Deviation ▼",
            "Show ▼",
            "Measure",
            "Picture…",
        ]
        .iter()
        .map(|label| harness.get_by_label(label).rect())
        .collect();
        row.sort_by(|a, b| a.min.x.total_cmp(&b.min.x));
        let card = copy.min.x - 18.0;
        for pair in row.windows(2) {
            assert!(pair[0].max.x <= pair[1].min.x, "{row:?}");
        }
        assert!(
            row.iter()
                .all(|rect| rect.max.x < card && rect.height() >= 35.9)
        );
        harness.get_by_label("View ▼").click();
        harness.run_steps(2);
        for label in ["Fit", "Front", "Top", "Side"] {
            assert!(
                harness
                    .get_by_role_and_label(Role::Button, label)
                    .rect()
                    .height()
                    >= 35.9
            );
        }
    }
}

/// Leaves pictures of the workspace in the folder that `PARTSIGHT_WINDOW_PICTURES` names, for visual inspection.
#[test]
fn pictures_of_the_workspace() {
    let Some(folder) = std::env::var_os("PARTSIGHT_WINDOW_PICTURES").map(PathBuf::from) else {
        return;
    };
    if !can_draw() {
        return;
    }
    let sizes = [
        ("1440x900", USUAL, 1.0),
        ("1024x768", SMALL, 1.0),
        ("1440x900_150", USUAL, 1.5),
    ];
    let keep = |harness: &mut WindowHarness, name: &str| {
        harness.run_steps(4);
        let picture = harness.render().expect("a picture");
        let path = folder.join(format!("inspect_{name}.png"));
        picture.save(path).expect("written");
    };
    for (name, size, zoom) in sizes {
        let mut harness = open_at(size, Drawn::ForReal);
        harness.ctx.set_zoom_factor(zoom);
        harness.run_steps(3);
        keep(&mut harness, &format!("{name}_dark"));
        harness.key_press(Key::T);
        keep(&mut harness, &format!("{name}_light"));
        if let Some(side) = harness.query_by_role_and_label(Role::Button, "Side") {
            side.click();
            harness.key_press(Key::N);
            keep(&mut harness, &format!("{name}_side"));
        }
        harness.get_by_label("Show ▼").click();
        harness.run_steps(2);
        keep(&mut harness, &format!("{name}_menu"));
        harness.key_press(Key::Escape);
        harness.key_press(Key::T);
        for stage in ["signatures", "alignment"] {
            harness.get_by_label(&format!("Enlarge {stage}")).click();
            keep(&mut harness, &format!("{name}_{stage}"));
        }
        harness.key_press(Key::Escape);
        act(
            &mut harness,
            Action::UseCell(CellChoice::Foreign(ObjectKind::Hood)),
        );
        keep(&mut harness, &format!("{name}_unknown"));
    }
}
