//! The view as a widget, in a window without a screen.

use eframe::egui::{Event, Key, Modifiers, PointerButton, Pos2, Theme, Vec2};
use egui_kittest::{Harness, kittest::Queryable as _, wgpu::WgpuTestRenderer};
use ui::viewport::{
    Colouring, DrawnShape, ViewCamera, ViewColours, ViewError, ViewScene, ViewStyle, ViewTool,
    Viewport, ViewportGpu,
};

use crate::{example, keep, render_state};

struct Shown {
    view: Viewport,
    camera: ViewCamera,
    scene: ViewScene,
    style: ViewStyle,
    num_picked: usize,
    drawn: Vec<Vec<glam::Vec2>>,
}

impl Shown {
    fn new(gpu: Result<ViewportGpu, ViewError>, scene: ViewScene) -> Self {
        Self {
            view: Viewport::new(gpu),
            camera: ViewCamera::default(),
            scene,
            style: ViewStyle::new(ViewColours::dark()),
            num_picked: 0,
            drawn: Vec::new(),
        }
    }
}

fn harness<'a>(state: Shown, renderer: Option<WgpuTestRenderer>) -> Harness<'a, Shown> {
    let builder = Harness::builder()
        .with_size(Vec2::new(800.0, 600.0))
        .with_theme(Theme::Dark);
    let builder = match renderer {
        Some(renderer) => builder.renderer(renderer),
        None => builder,
    };
    builder.build_ui_state(
        |ui, state: &mut Shown| {
            let Shown {
                view,
                camera,
                scene,
                style,
                num_picked,
                drawn,
            } = state;
            let shown = view.ui(ui, "Scene", camera, scene, style);
            *num_picked += usize::from(shown.picked.is_some());
            drawn.extend(shown.drawn);
        },
        state,
    )
}

#[test]
fn the_view_shows_a_frame_and_draws_nothing_anew_while_nothing_changes() {
    let Some(render_state) = render_state() else {
        return;
    };
    let gpu = ViewportGpu::of_window(&render_state);
    let renderer = WgpuTestRenderer::from_render_state(render_state);
    let mut harness = harness(Shown::new(Ok(gpu.clone()), example()), Some(renderer));
    harness.state_mut().style.colouring = Colouring::Deviation;
    harness.run();
    let picture = harness.render().expect("a picture");
    keep("widget_deviation", &picture);
    let colours: std::collections::HashSet<_> = picture.pixels().collect();
    assert!(colours.len() > 500, "{}", colours.len());
    let drawn = harness.state().view.num_pictures();
    for _ in 0..5 {
        harness.step();
        harness.render().expect("a picture");
    }
    assert_eq!(
        harness.state().view.num_pictures(),
        drawn,
        "a view at rest stands still"
    );
    harness.state_mut().style.colouring = Colouring::Height;
    harness.step();
    keep("widget_height", &harness.render().expect("a picture"));
    assert_eq!(harness.state().view.num_pictures(), drawn + 1);
    assert_eq!(gpu.problem(), None);
}

#[test]
fn keys_turn_zoom_and_fit_once_the_view_has_the_focus() {
    let mut harness = harness(Shown::new(Err(no_device()), example()), None);
    harness.run();
    let fitted = harness.state().camera;
    harness.get_by_label("Scene").focus();
    harness.run();
    harness.key_press(Key::ArrowRight);
    harness.run();
    let turned = harness.state().camera;
    assert!(turned.forward().x > fitted.forward().x);
    assert_eq!(turned.target(), fitted.target());
    harness.key_press(Key::Plus);
    harness.run();
    assert!(harness.state().camera.distance() < turned.distance());
    harness.key_press(Key::Z);
    harness.run();
    assert!((harness.state().camera.forward() - fitted.forward()).length() < 1e-6);
    assert!((harness.state().camera.distance() - fitted.distance()).abs() < 1e-4);
}

#[test]
fn dragging_turns_and_the_wheel_zooms_to_the_cursor() {
    let mut harness = harness(Shown::new(Err(no_device()), example()), None);
    harness.run();
    let fitted = harness.state().camera;
    harness.hover_at(Pos2::new(300.0, 300.0));
    harness.run();
    harness.drag_at(Pos2::new(300.0, 300.0));
    harness.run();
    harness.hover_at(Pos2::new(420.0, 300.0));
    harness.run();
    harness.drop_at(Pos2::new(420.0, 300.0));
    harness.run();
    let turned = harness.state().camera;
    assert!(turned.forward().x > fitted.forward().x + 0.1, "{turned:?}");
    assert!((turned.distance() - fitted.distance()).abs() < 1e-6);
    harness.hover_at(Pos2::new(420.0, 300.0));
    harness.run();
    harness.event(Event::MouseWheel {
        source: eframe::egui::MouseWheelSource::Wheel,
        unit: eframe::egui::MouseWheelUnit::Point,
        delta: Vec2::new(0.0, 100.0),
        phase: eframe::egui::TouchPhase::Move,
        modifiers: Modifiers::NONE,
    });
    harness.run();
    let zoomed = harness.state().camera;
    assert!(zoomed.distance() < 0.8 * turned.distance(), "{zoomed:?}");
}

#[test]
fn a_lasso_is_drawn_by_a_left_drag_that_turns_nothing_while_others_still_move_the_view() {
    let mut harness = harness(Shown::new(Err(no_device()), example()), None);
    harness.state_mut().view.tool = ViewTool::Draw(DrawnShape::Lasso);
    harness.run();
    let fitted = harness.state().camera;
    let way = [[200.0, 150.0], [600.0, 150.0], [600.0, 450.0]].map(Pos2::from);
    for button in [PointerButton::Primary, PointerButton::Secondary] {
        let press = |harness: &mut Harness<'_, Shown>, pos, pressed| {
            harness.event(Event::PointerButton {
                pos,
                button,
                pressed,
                modifiers: Modifiers::NONE,
            });
            harness.run();
        };
        harness.hover_at(way[0]);
        harness.run();
        press(&mut harness, way[0], true);
        for at in &way[1..] {
            harness.hover_at(*at);
            harness.run();
        }
        press(&mut harness, way[2], false);
        let [drawn] = harness.state().drawn.as_slice() else {
            panic!("{button:?}: {:?}", harness.state().drawn);
        };
        let view = harness.get_by_label("Scene").rect();
        for (corner, at) in drawn.iter().zip(way) {
            let share = (at - view.min) / view.size();
            assert!(corner.distance(glam::Vec2::new(share.x, share.y)) < 1e-4);
        }
        assert_eq!(drawn.len(), way.len());
        let camera = harness.state().camera;
        assert_eq!(camera.forward(), fitted.forward());
        let has_shifted = camera.target().distance(fitted.target()) > 1e-3;
        assert_eq!(has_shifted, button == PointerButton::Secondary);
    }
    // Nor does a click on it pick a point.
    click(&mut harness, way[1]);
    assert_eq!(
        (harness.state().num_picked, harness.state().drawn.len()),
        (0, 1)
    );
}

#[test]
fn two_clicks_measure_a_distance() {
    let mut harness = harness(Shown::new(Err(no_device()), example()), None);
    harness.run();
    harness.get_by_label("Scene").focus();
    harness.key_press(Key::M);
    harness.run();
    assert_eq!(harness.state().view.tool, ViewTool::Measure);
    for x in [300.0, 500.0] {
        click(&mut harness, Pos2::new(x, 400.0));
    }
    assert_eq!(harness.state().num_picked, 2);
    let measured = harness
        .state()
        .view
        .measure
        .distance()
        .expect("two points of the part");
    assert!((100.0..1500.0).contains(&measured.mm()), "{measured}");
    harness.key_press(Key::Escape);
    harness.run();
    assert_eq!(harness.state().view.measure.distance(), None);
}

#[test]
fn a_measured_distance_is_drawn_over_the_view() {
    let Some(render_state) = render_state() else {
        return;
    };
    let gpu = ViewportGpu::of_window(&render_state);
    let renderer = WgpuTestRenderer::from_render_state(render_state);
    let mut harness = harness(Shown::new(Ok(gpu), example()), Some(renderer));
    harness.state_mut().view.tool = ViewTool::Measure;
    harness.run();
    for x in [300.0, 500.0] {
        click(&mut harness, Pos2::new(x, 400.0));
    }
    assert!(harness.state().view.measure.distance().is_some());
    keep("widget_measure", &harness.render().expect("a picture"));
}

#[test]
fn two_views_that_share_a_camera_turn_together_each_with_its_own_picture() {
    let Some(render_state) = render_state() else {
        return;
    };
    let gpu = ViewportGpu::of_window(&render_state);
    let renderer = WgpuTestRenderer::from_render_state(render_state);
    let (left, right) = (
        Viewport::new(Ok(gpu.clone())),
        Viewport::new(Ok(gpu.clone())),
    );
    let (scene, camera) = (example(), ViewCamera::default());
    let styles = [ViewColours::dark(), ViewColours::light()].map(ViewStyle::new);
    let mut harness = Harness::builder()
        .with_size(Vec2::new(1000.0, 400.0))
        .renderer(renderer)
        .build_ui_state(
            |ui, (camera, left, right): &mut (ViewCamera, Viewport, Viewport)| {
                ui.columns(2, |columns| {
                    left.ui(&mut columns[0], "ICP", camera, &scene, &styles[0]);
                    right.ui(&mut columns[1], "ICP-GA", camera, &scene, &styles[1]);
                });
            },
            (camera, left, right),
        );
    harness.run();
    harness.render().expect("a picture");
    harness.get_by_label("ICP-GA").focus();
    harness.key_press(Key::ArrowRight);
    harness.run();
    let before = harness.state().1.num_pictures();
    let picture = harness.render().expect("a picture");
    keep("widget_linked", &picture);
    assert_eq!(
        harness.state().1.num_pictures(),
        before + 1,
        "the other view turned as well"
    );
    let (dark, light) = (picture.get_pixel(20, 390), picture.get_pixel(980, 390));
    assert!(dark[0] < 60 && light[0] > 180, "{dark:?} {light:?}");
    assert_eq!(gpu.problem(), None);
}

#[test]
fn without_a_device_the_view_says_so_in_words() {
    let mut harness = harness(Shown::new(Err(no_device()), ViewScene::default()), None);
    harness.run();
    harness.get_by_label("No 3-D view");
    harness.get_by_label_contains("Vulkan driver");
}

fn no_device() -> ViewError {
    ViewError::NoDevice {
        reason: "none in this test".into(),
    }
}

fn click(harness: &mut Harness<'_, Shown>, at: Pos2) {
    harness.drag_at(at);
    harness.run();
    harness.drop_at(at);
    harness.run();
}
