//! The 3-D view rendered on any available graphics device; software Vulkan is enough.
//!
//! Without a device these tests report it and pass, unless `PARTSIGHT_REQUIRE_GPU=1` is set. With
//! `PARTSIGHT_VIEW_PICTURES=DIR` they keep the pictures in that folder.

#![allow(clippy::disallowed_methods, reason = "tests write pictures")]

mod pictures;
mod shown;
mod speed;

use std::path::PathBuf;

use eframe::egui_wgpu::{RenderState, RendererOptions};
use egui_kittest::wgpu::{create_render_state, default_wgpu_setup};
use geometry::{fixtures::skipped, nearest::KdTree, rigid::RigidTransform, units::Metres};
use image::RgbaImage;
use nalgebra::Point3;
use simulate::{self, CellSetup, PartKind, PartPose, PoseRange, Side};
use stages::{
    scene::scene_from_frame,
    segment::{SegmentParams, Segmentation, segment},
};
use ui::viewport::{
    PointSet, TextLabel, ViewCamera, ViewError, ViewScene, ViewShot, ViewStyle, ViewportGpu,
    furniture,
};

/// Opens a device without a window; `None`, with the reason printed, if there is none.
fn device() -> Option<ViewportGpu> {
    match ViewportGpu::headless() {
        Ok(gpu) => Some(gpu),
        Err(ViewError::NoDevice { reason }) => {
            let lacking = format_args!("no graphics device: {reason}");
            skipped("PARTSIGHT_REQUIRE_GPU", lacking);
            None
        }
        Err(error) => panic!("{error}"),
    }
}

/// The render state for egui's test harness; `None` as for [`device`].
fn render_state() -> Option<RenderState> {
    device()?;
    Some(create_render_state(
        default_wgpu_setup(),
        RendererOptions::PREDICTABLE,
    ))
}

/// Draws a scene off screen.
fn screenshot(
    gpu: &ViewportGpu,
    camera: &ViewCamera,
    scene: &ViewScene,
    style: &ViewStyle,
    size: [u32; 2],
    pixels_per_point: f32,
) -> Result<RgbaImage, ViewError> {
    let shot = ViewShot {
        gpu: gpu.clone(),
        camera: *camera,
        scene: scene.clone(),
        style: style.clone(),
        size,
        pixels_per_point,
    };
    shot.take()
}

/// Keeps a picture if the environment asks for it.
fn keep(name: &str, picture: &RgbaImage) {
    if let Some(folder) = std::env::var_os("PARTSIGHT_VIEW_PICTURES") {
        let folder = PathBuf::from(folder);
        std::fs::create_dir_all(&folder).expect("the folder for pictures");
        picture
            .save(folder.join(format!("{name}.png")))
            .expect("a picture written");
    }
}

/// A simulated front door, segmented, with its deviation from the exact part, axes, camera and nozzle.
fn example() -> ViewScene {
    let mut setup = CellSetup::with_part(PartKind::FrontDoor, Side::Left, 1, 7);
    setup.pose = PartPose::Drawn(PoseRange::facing());
    let shot = simulate::frame(&setup);
    let scene = scene_from_frame(&shot.frame);
    let segmentation = segment(&scene, &SegmentParams::default());
    let positions: Vec<[f32; 3]> = scene.cloud.points.iter().map(|p| [p.x, p.y, p.z]).collect();
    let deviations = deviations(
        &scene.cloud.points,
        &segmentation,
        &setup,
        &shot.truth.camera_from_part,
    );
    let points = PointSet::segmented(positions, &segmentation.labels).with_deviations(deviations);
    let part = &segmentation.part.as_ref().expect("a part").cloud;
    let mut view = ViewScene {
        points: vec![points],
        lines: vec![
            furniture::axes(Metres(0.25)).at(&shot.truth.camera_from_part),
            furniture::frustum(&setup.intrinsics, Metres(0.25)),
        ],
        labels: Vec::new(),
    };
    let middle = part.points[part.points.len() / 2];
    let surface = glam::Vec3::new(middle.x, middle.y, middle.z);
    let mouth = surface + glam::Vec3::new(0.03, -0.06, -0.14);
    view.lines
        .push(furniture::nozzle(mouth, surface - mouth, surface));
    view.labels.push(TextLabel {
        at: mouth,
        text: "Stand-off 15.5 cm".into(),
    });
    view
}

/// Nearest distance to the exact part, positive on the camera's side.
fn deviations(
    points: &[Point3<f32>],
    segmentation: &Segmentation,
    setup: &CellSetup,
    camera_from_part: &RigidTransform,
) -> Vec<f32> {
    let camera_from_part = camera_from_part.cast::<f32>();
    let exact: Vec<Point3<f32>> = setup
        .subject
        .mesh()
        .sample_evenly(60_000, 1)
        .expect("a part has a surface")
        .points
        .iter()
        .map(|p| camera_from_part * p)
        .collect();
    let tree = KdTree::new(&exact);
    let mut deviations = vec![f32::NAN; points.len()];
    for &i in &segmentation.part.as_ref().expect("a part").indices {
        let point = points[i as usize];
        if let Some(nearest) = tree.nearest(&point, 0.05 * 0.05) {
            deviations[i as usize] = exact[nearest.index].z - point.z;
        }
    }
    deviations
}
