//! Figures about the view's speed, printed for a person; nothing is asserted on a clock.
//!
//! `cargo test --release --test viewport -- --ignored --nocapture`

use std::time::{Duration, Instant};

use eframe::egui::Vec2;
use egui_kittest::{Harness, wgpu::WgpuTestRenderer};
use partsight::app::viewport::{
    PointSet, Role, ViewCamera, ViewColours, ViewScene, ViewStyle, Viewport, ViewportGpu,
    screenshot,
};

use crate::{device, example, render_state};

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times[times.len() / 2]
}

/// A bowl of points, so that they cover the view.
fn bowl(num_points: usize) -> Vec<[f32; 3]> {
    let side = (num_points as f32).sqrt() as usize;
    let at = move |i: usize| i as f32 / side as f32 - 0.5;
    let point = move |i: usize| {
        let (x, y) = (at(i % side), at(i / side));
        [x, y, 1.5 + x * x + y * y]
    };
    (0..side * side).map(point).collect()
}

#[test]
#[ignore = "prints figures, checks nothing"]
#[expect(clippy::print_stderr, reason = "the figures are the point")]
fn time_of_a_picture_on_this_device() {
    let Some(gpu) = device() else { return };
    for num_points in [300_000, 1_000_000, 4_000_000] {
        let scene = ViewScene {
            points: vec![PointSet::new(bowl(num_points), Role::Part)],
            ..ViewScene::default()
        };
        let style = ViewStyle::new(ViewColours::dark());
        let mut camera = ViewCamera::default();
        let take = |camera: &ViewCamera| {
            let start = Instant::now();
            screenshot(&gpu, camera, &scene, &style, [1000, 700], 1.0).expect("a picture");
            start.elapsed()
        };
        let first = take(&camera);
        let times = (0..9).map(|_| {
            camera.turn(0.05, 0.01);
            take(&camera)
        });
        let rest = median(times.collect());
        eprintln!(
            "{num_points} points, with upload and read-back: first {first:.1?}, then {rest:.1?}"
        );
    }
}

#[test]
#[ignore = "prints figures, checks nothing"]
#[expect(clippy::print_stderr, reason = "the figures are the point")]
fn time_of_a_frame_of_the_window() {
    let Some(render_state) = render_state() else {
        return;
    };
    let gpu = ViewportGpu::of_window(&render_state);
    let renderer = WgpuTestRenderer::from_render_state(render_state);
    let (mut view, scene) = (Viewport::new(Ok(gpu)), example().scene);
    let style = ViewStyle::new(ViewColours::dark());
    let mut harness = Harness::builder()
        .with_size(Vec2::new(1000.0, 700.0))
        .renderer(renderer)
        .build_ui_state(
            move |ui, camera: &mut ViewCamera| {
                view.ui(ui, "Scene", camera, &scene, &style);
            },
            ViewCamera::default(),
        );
    harness.run();
    harness.render().expect("a picture");
    for (name, turn) in [("at rest", 0.0), ("turning", 0.02)] {
        let (mut ui_times, mut all_times) = (Vec::new(), Vec::new());
        for _ in 0..60 {
            harness.state_mut().turn(turn, 0.0);
            let start = Instant::now();
            harness.step();
            ui_times.push(start.elapsed());
            harness.render().expect("a picture");
            all_times.push(start.elapsed());
        }
        eprintln!(
            "a frame {name}: {:.2?} on the UI thread, {:.1?} with drawing and read-back",
            median(ui_times),
            median(all_times)
        );
    }
}
