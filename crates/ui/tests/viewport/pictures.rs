//! Pictures of the view, rendered off screen.

use std::collections::HashSet;

use eframe::egui::Color32;
use geometry::units::Metres;
use image::RgbaImage;
use ui::viewport::{
    Colouring, PointSet, Role, StandardView, ViewCamera, ViewColours, ViewError, ViewScene,
    ViewStyle,
};

use crate::{device, example, keep, screenshot};

const SIZE: [u32; 2] = [800, 600];

/// Number of pixels within a few steps of a colour in each channel, at any shade down to a third of it.
fn num_pixels_of(picture: &RgbaImage, colour: Color32) -> usize {
    let wanted = [colour.r(), colour.g(), colour.b()].map(f32::from);
    let is_shade = |pixel: &[u8; 3]| {
        let shade = f32::from(pixel[1]) / wanted[1];
        (0.33..=1.02).contains(&shade)
            && pixel
                .iter()
                .zip(wanted)
                .all(|(value, wanted)| (f32::from(*value) - wanted * shade).abs() < 4.0)
    };
    picture
        .pixels()
        .filter(|p| is_shade(&[p[0], p[1], p[2]]))
        .count()
}

fn num_colours(picture: &RgbaImage) -> usize {
    picture.pixels().collect::<HashSet<_>>().len()
}

#[test]
fn a_segmented_frame_shows_the_part_in_its_colour_in_every_colouring_and_theme() {
    let Some(gpu) = device() else { return };
    let example = example();
    for (theme, colours) in [
        ("dark", ViewColours::dark()),
        ("light", ViewColours::light()),
    ] {
        for colouring in Colouring::ALL {
            let mut style = ViewStyle::new(colours.clone());
            style.colouring = colouring;
            style.deviation_range = Metres::from_mm(12.0);
            let picture = screenshot(&gpu, &ViewCamera::default(), &example, &style, SIZE, 1.0)
                .expect("a picture");
            keep(
                &format!("{}_{theme}", colouring.title().to_lowercase()),
                &picture,
            );
            assert!(
                num_colours(&picture) > 200,
                "{colouring:?} {theme}: {}",
                num_colours(&picture)
            );
            let num_part = num_pixels_of(&picture, colours.role(Role::Part).colour);
            if colouring == Colouring::Segment {
                assert!(num_part > 20_000, "{theme}: {num_part}");
            }
        }
    }
    assert_eq!(gpu.problem(), None);
}

#[test]
fn other_directions_and_sizes_draw_as_well() {
    let Some(gpu) = device() else { return };
    let example = example();
    let mut style = ViewStyle::new(ViewColours::dark());
    for (name, view, mm) in [
        ("top", StandardView::Top, 2.0),
        ("side", StandardView::Side, 4.0),
    ] {
        let mut camera = ViewCamera::default();
        camera.look(view);
        style.point_size = Metres::from_mm(mm);
        let picture = screenshot(&gpu, &camera, &example, &style, SIZE, 1.0).expect("a picture");
        keep(name, &picture);
        assert!(num_colours(&picture) > 100);
    }
    let mut camera = ViewCamera::default();
    camera.turn(0.6, 0.35);
    style.colouring = Colouring::Plain;
    for (name, eye_dome) in [("turned_flat", 0.0), ("turned_shaded", 1.0)] {
        style.eye_dome = eye_dome;
        let picture =
            screenshot(&gpu, &camera, &example, &style, [1600, 1200], 2.0).expect("a picture");
        keep(name, &picture);
    }
}

#[test]
fn nearer_points_hide_farther_ones() {
    let Some(gpu) = device() else { return };
    let square = |z: f32| -> Vec<[f32; 3]> {
        (0..100)
            .flat_map(|y| {
                (0..100).map(move |x| [x as f32 * 0.004 - 0.2, y as f32 * 0.004 - 0.2, z])
            })
            .collect()
    };
    let mut style = ViewStyle::new(ViewColours::dark());
    style.eye_dome = 0.0;
    style.point_size = Metres::from_mm(9.0);
    let (near, far) = (
        PointSet::new(square(1.0), Role::Part),
        PointSet::new(square(1.2), Role::Moving),
    );
    for points in [vec![near.clone(), far.clone()], vec![far, near]] {
        let scene = ViewScene {
            points,
            ..ViewScene::default()
        };
        let picture = screenshot(
            &gpu,
            &ViewCamera::default(),
            &scene,
            &style,
            [200, 200],
            1.0,
        )
        .expect("a picture");
        let [red, green, blue, _] = style.colours.role(Role::Part).colour.to_array();
        assert_eq!(picture.get_pixel(100, 100).0, [red, green, blue, 255]);
    }
}

#[test]
fn an_empty_scene_is_the_background_and_an_impossible_size_an_error() {
    let Some(gpu) = device() else { return };
    let style = ViewStyle::new(ViewColours::light());
    let scene = ViewScene {
        points: vec![
            PointSet::new(vec![[f32::NAN; 3]; 5], Role::Part),
            PointSet::new(Vec::new(), Role::Part),
        ],
        ..ViewScene::default()
    };
    let picture =
        screenshot(&gpu, &ViewCamera::default(), &scene, &style, [64, 64], 1.0).expect("a picture");
    let [red, green, blue, _] = style.colours.background.to_array();
    assert!(picture.pixels().all(|p| p.0 == [red, green, blue, 255]));
    let refused = screenshot(&gpu, &ViewCamera::default(), &scene, &style, [0, 64], 1.0);
    assert!(
        matches!(refused, Err(ViewError::PictureSize { .. })),
        "{refused:?}"
    );
    assert_eq!(gpu.problem(), None);
}
