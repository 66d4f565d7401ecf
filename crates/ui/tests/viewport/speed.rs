//! Prints figures on the view's speed; asserts no times.
//!
//! `cargo test --release --test viewport -- --ignored --nocapture`; without eye-dome lighting if `PARTSIGHT_VIEW_FLAT`
//! is set.

use std::time::{Duration, Instant};

use eframe::egui::Vec2;
use egui_kittest::{Harness, wgpu::WgpuTestRenderer};
use ui::viewport::{
    PointSet, Role, ViewCamera, ViewColours, ViewScene, ViewStyle, Viewport, ViewportGpu,
};

use crate::{device, example, render_state, screenshot};

/// Processor time of all threads of this process so far, seconds: it does not depend on the load of the machine, as
/// wall time does. 0 if there is no /proc.
fn processor_seconds() -> f64 {
    const TICKS_PER_SECOND: f64 = 100.0;
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The name, in brackets, may hold spaces; user and system time are the 12th and 13th fields after it.
    let fields = stat
        .rsplit(')')
        .next()
        .unwrap_or_default()
        .split_whitespace();
    fields
        .skip(11)
        .take(2)
        .filter_map(|ticks| ticks.parse::<f64>().ok())
        .sum::<f64>()
        / TICKS_PER_SECOND
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times[times.len() / 2]
}

/// A bowl of points that covers the view.
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
fn time_of_a_picture_on_this_device() {
    let Some(gpu) = device() else { return };
    for (num_points, eye_dome) in [(0, 0.0), (300_000, 0.0), (300_000, 1.0), (1_000_000, 1.0)] {
        let scene = ViewScene {
            points: vec![PointSet::new(bowl(num_points), Role::Part)],
            ..ViewScene::default()
        };
        let mut style = ViewStyle::new(ViewColours::dark());
        style.eye_dome = eye_dome;
        let mut camera = ViewCamera::default();
        let take = |camera: &ViewCamera| {
            let start = Instant::now();
            screenshot(&gpu, camera, &scene, &style, [1000, 700], 1.0).expect("a picture");
            start.elapsed()
        };
        let first = take(&camera);
        let before = processor_seconds();
        let times = (0..20).map(|_| {
            camera.turn(0.02, 0.01);
            take(&camera)
        });
        let rest = median(times.collect());
        let busy = (processor_seconds() - before) / 20.0 * 1e3;
        eprintln!(
            "{num_points} points, eye dome {eye_dome}, with upload and read-back: {first:.1?}, then {rest:.1?}, \
             {busy:.0} ms of processor time"
        );
    }
}

#[test]
#[ignore = "prints figures, checks nothing"]
fn time_of_a_frame_of_the_window() {
    let Some(render_state) = render_state() else {
        return;
    };
    let gpu = ViewportGpu::of_window(&render_state);
    let renderer = WgpuTestRenderer::from_render_state(render_state);
    let (mut view, scene) = (Viewport::new(Ok(gpu)), example());
    let mut style = ViewStyle::new(ViewColours::dark());
    if std::env::var_os("PARTSIGHT_VIEW_FLAT").is_some() {
        style.eye_dome = 0.0;
    }
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
        let before = processor_seconds();
        for _ in 0..60 {
            harness.state_mut().turn(turn, 0.0);
            let start = Instant::now();
            harness.step();
            ui_times.push(start.elapsed());
            harness.render().expect("a picture");
            all_times.push(start.elapsed());
        }
        let busy = (processor_seconds() - before) / 60.0 * 1e3;
        eprintln!(
            "a frame {name}: {:.2?} on the UI thread, {:.1?} with drawing and read-back, {busy:.0} ms of processor time",
            median(ui_times),
            median(all_times)
        );
    }
}
