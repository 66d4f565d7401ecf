use std::f32::consts::{PI, TAU};

use nalgebra::Point3;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64Mcg;

use super::*;
use geometry::cloud::{Grid, PointCloud};
use inspection::library::EnrolParams;
use shell::inspection::{
    camera::Camera,
    source::{Origin, SceneSource},
};
use stages::scene::SceneCloud;
use ui::viewport::ViewCamera;

/// Size of the view, logical pixels.
const SIZE: Vec2 = Vec2::new(800.0, 600.0);

/// Points around the usual target of the view, before and behind the eye, some without coordinates.
fn cloud() -> EnrolInput {
    let mut rng = Pcg64Mcg::seed_from_u64(7);
    let mut along = |low: f32, high: f32| rng.random_range(low..high);
    let points = (0..6000).map(|i| match i % 50 {
        0 => Point3::new(f32::NAN, 0.0, 1.5),
        1 => Point3::new(0.1, f32::INFINITY, 1.5),
        _ => Point3::new(along(-1.5, 1.5), along(-1.2, 1.2), along(-2.0, 3.0)),
    });
    let cloud = PointCloud {
        points: points.collect(),
        grid: Some(Grid {
            width: 100,
            height: 60,
        }),
        ..PointCloud::default()
    };
    let scene = SceneCloud {
        cloud,
        ..SceneCloud::default()
    };
    let origin = Origin::File {
        path: "random.pcd".into(),
        is_simulated: false,
    };
    let source = SceneSource::AtHand(Arc::new(scene), origin);
    let params = EnrolParams::default();
    let read = EnrolInput::read(&source, &params, &Camera::default(), &|| false);
    read.expect("a scene").expect("a subject")
}

fn in_view(camera: &ViewCamera, corners: &[[f32; 2]]) -> DrawnOutline {
    DrawnOutline {
        corners: corners.iter().map(|at| Vec2::from(*at) / SIZE).collect(),
        over: DrawnOver::View {
            clip_from_world: camera.clip_from_world(SIZE),
        },
    }
}

/// A box from (200, 150) to (560, 400), logical pixels.
const BOX: [[f32; 2]; 4] = [
    [200.0, 150.0],
    [560.0, 150.0],
    [560.0, 400.0],
    [200.0, 400.0],
];

fn turned(right: f32, down: f32) -> ViewCamera {
    let mut camera = ViewCamera::default();
    camera.turn(right, down);
    camera
}

#[test]
fn a_box_encloses_what_the_view_shows_within_it_and_nothing_behind_the_eye() {
    let subject = cloud();
    for camera in [turned(0.0, 0.0), turned(0.7, 0.4), turned(-2.5, -0.9)] {
        let enclosed = in_view(&camera, &BOX).encloses(&subject);
        let (mut num_inside, mut num_behind) = (0, 0);
        for (is_inside, point) in enclosed.iter().zip(&subject.cloud().points) {
            // Computed by angles instead of by the matrix.
            let seen = camera.screen_from_world(Vec3::new(point.x, point.y, point.z), SIZE);
            let Some(seen) = seen.filter(|seen| seen.is_finite()) else {
                num_behind += 1;
                assert!(!is_inside, "{point}");
                continue;
            };
            let beyond = (seen - Vec2::new(380.0, 275.0)).abs() - Vec2::new(180.0, 125.0);
            // Skip points on the border: the two computations differ by rounding.
            if beyond.max_element().abs() > 0.01 {
                assert_eq!(*is_inside, beyond.max_element() < 0.0, "{point} at {seen}");
            }
            num_inside += usize::from(*is_inside);
        }
        assert!(
            num_inside > 100 && num_behind > 300,
            "{num_inside}, {num_behind}"
        );
    }
}

#[test]
fn the_same_box_encloses_other_points_once_the_view_is_turned() {
    let subject = cloud();
    let from_the_front = in_view(&turned(0.0, 0.0), &BOX);
    let from_the_side = in_view(&turned(PI / 2.0, 0.0), &BOX);
    let before = from_the_front.encloses(&subject);
    assert_ne!(before, from_the_side.encloses(&subject));
    assert_eq!(before, from_the_front.clone().encloses(&subject));
}

/// Winding number from the sum of the angles subtended by the edges: slow, but reliable away from the edges.
fn turns_around(corners: &[Vec2], at: Vec2) -> i32 {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let angles = edges.map(|(a, b)| (*a - at).angle_to(*b - at));
    (angles.sum::<f32>() / TAU).round() as i32
}

#[test]
fn any_lasso_encloses_what_it_goes_around_however_often() {
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let mut seen = [0; 4];
    for num_corners in [3, 4, 5, 9, 20, 300] {
        for _ in 0..20 {
            let mut place = || Vec2::new(rng.random_range(0.0..1.0), rng.random_range(0.0..1.0));
            let corners: Vec<Vec2> = (0..num_corners).map(|_| place()).collect();
            let edges = Edges::of(&corners);
            for _ in 0..50 {
                let at = place() * 1.2 - 0.1;
                let turns = turns_around(&corners, at);
                assert_eq!(edges.go_around(at), turns != 0, "{corners:?} about {at}");
                seen[turns.unsigned_abs().min(3) as usize] += 1;
            }
        }
    }
    assert!(seen.iter().all(|num| *num > 100), "{seen:?}");
}

#[test]
fn what_lies_in_the_notch_of_a_lasso_is_outside() {
    let corners = [
        [0.1, 0.1],
        [0.9, 0.1],
        [0.9, 0.9],
        [0.6, 0.9],
        [0.6, 0.3],
        [0.4, 0.3],
        [0.4, 0.9],
        [0.1, 0.9],
    ];
    let edges = Edges::of(&corners.map(Vec2::from));
    for (at, is_inside) in [
        ([0.2, 0.8], true),
        ([0.8, 0.8], true),
        ([0.5, 0.2], true),
        ([0.5, 0.8], false),
        ([0.05, 0.5], false),
        ([0.5, f32::NAN], false),
    ] {
        assert_eq!(edges.go_around(at.into()), is_inside, "{at:?}");
    }
}

#[test]
fn a_place_on_an_edge_that_two_boxes_share_is_in_one_of_them() {
    let of = |left: f32, right: f32| {
        let corners = [[left, 0.0], [right, 0.0], [right, 1.0], [left, 1.0]];
        Edges::of(&corners.map(Vec2::from))
    };
    let at = Vec2::new(0.3, 0.5);
    let both = [of(0.0, 0.3), of(0.3, 1.0)].map(|edges| edges.go_around(at));
    assert_eq!(both, [false, true]);
}

#[test]
fn an_outline_without_an_area_encloses_nothing() {
    let places = (0..1000).map(|i| Vec2::new(i as f32, i as f32) / 1000.0);
    for corners in [
        vec![],
        vec![[0.5; 2]],
        vec![[0.1; 2], [0.9; 2]],
        vec![[0.5; 2]; 4],
    ] {
        let corners: Vec<Vec2> = corners.into_iter().map(Vec2::from).collect();
        let edges = Edges::of(&corners);
        assert!(!places.clone().any(|at| edges.go_around(at)), "{corners:?}");
    }
}
