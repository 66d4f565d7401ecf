use super::*;

const SIZE: ViewSize = Vec2::new(800.0, 600.0);

fn turned() -> ViewCamera {
    let mut camera = ViewCamera::default();
    camera.turn(0.7, 0.4);
    camera
}

fn see(camera: &ViewCamera, point: Vec3) -> Vec2 {
    camera
        .screen_from_world(point, SIZE)
        .expect("in front of the eye")
}

#[test]
fn the_front_view_is_upright_and_not_mirrored() {
    let camera = ViewCamera::default();
    let centre = see(&camera, Vec3::new(0.0, 0.0, 1.5));
    assert!((centre - SIZE / 2.0).length() < 1e-3);
    assert!(
        see(&camera, Vec3::new(0.0, -0.2, 1.5)).y < centre.y,
        "smaller y is higher"
    );
    assert!(
        see(&camera, Vec3::new(0.2, 0.0, 1.5)).x > centre.x,
        "x right is right"
    );
    let near = see(&camera, Vec3::new(0.2, 0.0, 1.0)).x - centre.x;
    let far = see(&camera, Vec3::new(0.2, 0.0, 3.0)).x - centre.x;
    assert!(near > far, "z forward is away");
}

#[test]
fn the_matrix_and_the_plain_projection_agree() {
    let camera = turned();
    for point in [Vec3::new(0.1, -0.3, 1.4), Vec3::new(-0.4, 0.2, 2.0)] {
        let clip = camera.clip_from_world(SIZE) * point.extend(1.0);
        let ndc = clip.truncate() / clip.w;
        let screen = Vec2::new(ndc.x + 1.0, 1.0 - ndc.y) / 2.0 * SIZE;
        assert!((screen - see(&camera, point)).length() < 0.01);
        let z = (point - camera.eye()).dot(camera.forward());
        assert!(
            (ndc.z - camera.near() / z).abs() < 1e-5,
            "depth is near / z"
        );
    }
}

#[test]
fn orbiting_keeps_target_and_distance() {
    let mut camera = ViewCamera::default();
    let (target, distance) = (camera.target(), camera.distance());
    camera.orbit(Vec2::new(120.0, -45.0), SIZE);
    assert_ne!(camera, ViewCamera::default());
    assert_eq!(camera.target(), target);
    assert!(((camera.eye() - target).length() - distance).abs() < 1e-5);
    assert!((see(&camera, target) - SIZE / 2.0).length() < 1e-2);
}

#[test]
fn the_near_side_follows_the_pointer_when_orbiting() {
    let mut camera = ViewCamera::default();
    let near_side = camera.target() - 0.3 * camera.forward();
    let before = see(&camera, near_side);
    camera.orbit(Vec2::new(40.0, 30.0), SIZE);
    let after = see(&camera, near_side);
    assert!(after.x > before.x && after.y > before.y);
}

#[test]
fn zooming_keeps_the_point_under_the_cursor() {
    for depth in [0.8, 1.5, 4.0] {
        let mut camera = turned();
        let cursor = Vec2::new(613.0, 127.0);
        let under_cursor = camera.eye() + camera.ray(cursor, SIZE) * depth;
        let before = camera.distance();
        camera.zoom_at(1.3, cursor, SIZE);
        assert!(camera.distance() < before);
        assert!(
            (see(&camera, under_cursor) - cursor).length() < 0.05,
            "at {depth} m"
        );
        camera.zoom_at(0.5, cursor, SIZE);
        assert!(camera.distance() > before);
        assert!(
            (see(&camera, under_cursor) - cursor).length() < 0.05,
            "at {depth} m"
        );
    }
}

#[test]
fn panning_moves_the_target_plane_with_the_pointer() {
    let mut camera = turned();
    let target = camera.target();
    camera.pan(Vec2::new(50.0, -20.0), SIZE);
    assert!((see(&camera, target) - (SIZE / 2.0 + Vec2::new(50.0, -20.0))).length() < 0.01);
}

#[test]
fn a_fit_contains_the_bounds_and_fills_the_view() {
    let bounds = PointBounds {
        low: Vec3::new(-0.6, -0.4, 1.0),
        high: Vec3::new(0.5, 0.7, 1.3),
    };
    for view in [StandardView::Front, StandardView::Top, StandardView::Side] {
        for size in [SIZE, Vec2::new(300.0, 900.0)] {
            let mut camera = ViewCamera::default();
            camera.look(view);
            camera.fit(&bounds, size);
            let mut reach = 0.0_f32;
            for corner in bounds.corners() {
                let seen = camera
                    .screen_from_world(corner, size)
                    .expect("in front of the eye");
                let off_centre = ((seen - size / 2.0) / (size / 2.0)).abs();
                reach = reach.max(off_centre.max_element());
            }
            assert!((0.8..=1.0).contains(&reach), "{view:?} {size}: {reach}");
        }
    }
}

#[test]
fn from_above_the_cameras_right_stays_right_and_far_is_up() {
    let mut camera = ViewCamera::default();
    camera.look(StandardView::Top);
    let centre = see(&camera, camera.target());
    assert!(see(&camera, camera.target() + 0.2 * Vec3::X).x > centre.x + 1.0);
    assert!(see(&camera, camera.target() + 0.2 * Vec3::Z).y < centre.y - 1.0);
    assert!(camera.eye().y < camera.target().y, "the eye is above");
}

#[test]
fn poison_leaves_the_camera_as_it_was() {
    let mut camera = turned();
    let before = camera;
    camera.zoom_at(f32::NAN, Vec2::ZERO, SIZE);
    camera.zoom_at(0.0, Vec2::ZERO, SIZE);
    camera.pan(Vec2::new(f32::INFINITY, 0.0), SIZE);
    assert_eq!(camera, before);
    assert!(camera.clip_from_world(Vec2::ZERO).is_finite());
}
