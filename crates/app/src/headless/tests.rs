//! Tests with frames that are really drawn. Without a graphics device they print a message and pass, unless
//! `PARTSIGHT_REQUIRE_GPU=1` is set.

use egui::{Key, Modifiers, PointerButton, Pos2};

use super::*;
use shell::inspection::library_cache::LibraryCache;

fn open() -> Option<HeadlessWindow> {
    let options = WindowOptions {
        library: Some(::inspection::fixtures::SHIPPED_PARTS.into()),
        former_library: Some(LibraryCache::default().get()),
        ..WindowOptions::default()
    };
    match HeadlessWindow::open([1440, 900], options) {
        Ok(mut window) => {
            assert!(window.settle(), "still working after a minute");
            Some(window)
        }
        Err(ViewError::NoDevice { reason }) => {
            let lacking = format_args!("no graphics device: {reason}");
            geometry::fixtures::skipped("PARTSIGHT_REQUIRE_GPU", lacking);
            None
        }
        Err(error) => panic!("{error}"),
    }
}

fn press(key: Key) -> Vec<Event> {
    [true, false]
        .map(|pressed| Event::Key {
            key,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers: Modifiers::NONE,
        })
        .into()
}

#[test]
fn a_frame_in_which_nothing_changed_uploads_prepares_and_draws_nothing() {
    let Some(mut window) = open() else { return };
    let before = window.counts();
    assert!(before.uploads > 0 && before.pictures > 0 && before.made > 0);
    for _ in 0..20 {
        window.frame(Vec::new());
    }
    assert_eq!(window.counts(), before);

    // With the pointer over it, the view takes keys.
    let over = Pos2::new(500.0, 400.0);
    window.frame(vec![Event::PointerMoved(over)]);
    window.frame(press(Key::ArrowLeft));
    window.frame(Vec::new());
    let turned = window.counts();
    assert!(turned.pictures > before.pictures, "the view did not turn");
    // Rotating redraws without uploading anything.
    assert_eq!((turned.uploads, turned.made), (before.uploads, before.made));
}

#[test]
fn another_choice_of_lines_uploads_lines_alone_and_once() {
    let Some(mut window) = open() else { return };
    let before = window.counts();
    window.frame(press(Key::N));
    window.frame(Vec::new());
    let after = window.counts();
    assert_eq!(after.made, before.made + 1);
    assert_eq!(after.uploads, before.uploads + 1, "the nozzle alone");
    for _ in 0..5 {
        window.frame(Vec::new());
    }
    assert_eq!(window.counts(), after);
}

/// Collects the texts for a screen reader, and notes whether the window asks to be closed.
pub(super) fn read_output(window: &mut HeadlessWindow, output: &FullOutput) {
    let commands = output.viewport_output.values().flat_map(|v| &v.commands);
    window.closes |= commands
        .into_iter()
        .any(|command| *command == egui::ViewportCommand::Close);
    let says = &mut window.says;
    let Some(update) = &output.platform_output.accesskit_update else {
        return;
    };
    says.clear();
    for (_, node) in &update.nodes {
        says.extend(
            [node.value(), node.label()]
                .into_iter()
                .flatten()
                .map(str::to_owned),
        );
    }
}

fn says(window: &HeadlessWindow, text: &str) -> bool {
    window.says.iter().any(|words| words.contains(text))
}

#[test]
fn a_device_that_refuses_something_is_said_in_words_and_the_rest_works() {
    let Some(mut window) = open() else { return };
    window.ctx.enable_accesskit();
    window.frame(Vec::new());
    assert!(!says(&window, "No 3-D view") && says(&window, "Front door, left"));
    // More than any device has.
    let _refused = window.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("too large"),
        size: 1 << 60,
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    });
    window.frame(Vec::new());
    assert!(says(&window, "No 3-D view") && says(&window, "reported an error"));
    assert!(says(&window, "Front door, left") && !window.closes);
    // The next part is still captured and inspected.
    window.frame(press(Key::Space));
    assert!(window.settle());
    assert!(says(&window, "Simulated frame 2"), "{:?}", window.says);
}

#[test]
fn a_window_whose_device_is_gone_closes_instead_of_breaking_off() {
    let Some(mut window) = open() else { return };
    window.device.destroy();
    for _ in 0..3 {
        window.frame(Vec::new());
    }
    assert!(window.closes);
    let gpu = window.window().gpu().as_ref().expect("a device once");
    assert!(matches!(gpu.problem(), Some(ViewError::DeviceLost { .. })));
}

#[test]
fn turning_draws_less_on_a_slow_device_and_everything_at_rest() {
    let Some(mut window) = open() else { return };
    let from = Pos2::new(500.0, 400.0);
    let button = |pressed| Event::PointerButton {
        pos: from,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    window.frame(vec![Event::PointerMoved(from), button(true)]);
    for i in 1..=12 {
        let to = from + Vec2::new(8.0 * i as f32, 0.0);
        window.frame(vec![Event::PointerMoved(to)]);
        // Slow on any machine, so that the test does not depend on this one's speed.
        thread::sleep(std::time::Duration::from_millis(70));
    }
    assert!(window.window().detail_of_view() < 1.0, "all of it is drawn");
    // On a busy machine the view may have come to rest by the time of the release.
    let before = window.counts().pictures;
    window.frame(vec![button(false)]);
    thread::sleep(std::time::Duration::from_millis(300));
    window.frame(Vec::new());
    assert!((window.window().detail_of_view() - 1.0).abs() < 1e-6);
    assert!(window.counts().pictures > before, "drawn in full");
}
