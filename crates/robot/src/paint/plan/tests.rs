use super::*;
use crate::paint::surface::tests::{grid, plate};
use stages::reference::Coverage;

#[test]
fn rows_over_a_plate_are_straight_even_and_at_stand_off() {
    let surface = plate(1.0, 0.6);
    let coat = Coat {
        acceleration: 0.0,
        ..Coat::default()
    };
    let path = plan(&surface, &coat, &[]).expect("planned");
    let mut levels: Vec<f64> = Vec::new();
    for pair in path.points().windows(2) {
        let [a, b] = pair else { continue };
        assert!((a.nozzle.z - coat.stand_off).abs() < 1e-6);
        assert!((a.direction.z + 1.0).abs() < 1e-9);
        if a.is_gun_on {
            assert!((a.speed.expect("set") - coat.speed).abs() < 1e-6);
            assert!((a.nozzle.y - b.nozzle.y).abs() < 1e-9);
            assert!(a.fan.expect("set").y.abs() > 1.0 - 1e-9);
            if levels
                .last()
                .is_none_or(|last| (last - a.nozzle.y).abs() > 1e-6)
            {
                levels.push(a.nozzle.y);
            }
            assert!(a.nozzle.x.abs().max(b.nozzle.x.abs()) < 0.5 + coat.overrun + 0.015);
        }
    }
    for pair in levels.windows(2) {
        assert!(
            ((pair[1] - pair[0]).abs() - coat.spacing).abs() < 1e-6,
            "{levels:?}"
        );
    }
    let outermost = levels.iter().fold(0.0_f64, |most, y| most.max(y.abs()));
    assert!(outermost > 0.3 && outermost <= 0.3 + coat.overrun + 0.01);
    // There and back.
    let starts: Vec<f64> = path
        .points()
        .windows(2)
        .filter(|p| p[0].is_gun_on)
        .map(|p| (p[1].nozzle.x - p[0].nozzle.x).signum())
        .collect();
    assert!(starts.contains(&1.0) && starts.contains(&-1.0));
    assert_eq!(path, plan(&surface, &coat, &[]).expect("again"));
}

#[test]
fn rows_around_a_cylinder_are_even_along_the_surface() {
    let radius = 0.4;
    let surface = grid(101, 101, Coverage::OneSide, |i, j| {
        let (x, angle) = (1.0 * i - 0.5, 2.0 * (j - 0.5));
        let normal = Vector3::new(0.0, angle.sin(), angle.cos());
        (Point3::from(normal * radius + Vector3::x() * x), normal)
    });
    let coat = Coat {
        direction: RowDirection::Angle,
        tilt_limit: 1.2,
        flank_lean: 0.0,
        ..Coat::default()
    };
    let path = plan(&surface, &coat, &[]).expect("planned");
    let on: Vec<&PathPoint> = path.points().iter().filter(|p| p.is_gun_on).collect();
    // The angles about the axis at which the rows have their middle.
    let mut angles: Vec<f64> = on
        .iter()
        .filter(|p| p.nozzle.x.abs() < 0.02)
        .map(|p| (p.nozzle.y).atan2(p.nozzle.z))
        .filter(|angle| angle.abs() < 0.85)
        .collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|a, b| (*a - *b).abs() < 0.02);
    assert!(angles.len() > 6);
    for pair in angles.windows(2) {
        let along = (pair[1] - pair[0]) * radius;
        assert!(
            (along / coat.spacing - 1.0).abs() < 0.05,
            "{along} {angles:?}"
        );
    }
}

#[test]
fn wide_openings_and_keep_outs_are_left_out_and_narrow_openings_crossed() {
    let with_hole = |radius: f64| {
        grid(101, 61, Coverage::OneSide, |i, j| {
            let p = Point3::new(i - 0.5, 0.6 * j - 0.3, 0.0);
            // Points of the hole are moved to its edge.
            let out = p.coords.norm();
            let p = if out > radius {
                p
            } else if out < 1e-6 {
                Point3::new(radius, 0.0, 0.0)
            } else {
                Point3::from(p.coords * (radius / out))
            };
            (p, Vector3::z())
        })
    };
    let coat = Coat {
        overrun: 0.02,
        ..Coat::default()
    };
    let sprays_at_middle = |surface: &PaintSurface, regions: &[KeepOut]| {
        let path = plan(surface, &coat, regions).expect("planned");
        let near = |p: &PathPoint| p.nozzle.x.hypot(p.nozzle.y) < 0.06 && p.is_gun_on;
        path.points().iter().any(near)
    };
    assert!(sprays_at_middle(&with_hole(0.0), &[]));
    assert!(sprays_at_middle(&with_hole(0.05), &[]));
    assert!(!sprays_at_middle(&with_hole(0.15), &[]));
    let keep_out = KeepOut::Sphere {
        centre: Point3::origin(),
        radius: 0.12,
    };
    assert!(!sprays_at_middle(&with_hole(0.0), &[keep_out]));
}

#[test]
fn a_coat_without_a_gun_and_regions_without_extent_are_refused() {
    let surface = plate(0.5, 0.5);
    let mut coat = Coat::default();
    coat.gun.width = 0.0;
    let refused = plan(&surface, &coat, &[]).expect_err("no width");
    assert!(matches!(
        refused,
        PaintError::BadCoat {
            name: "gun.width",
            ..
        }
    ));
    let nothing = KeepOut::Polygon {
        corners: Vec::new(),
    };
    let refused = plan(&surface, &Coat::default(), &[nothing]).expect_err("empty");
    assert!(matches!(refused, PaintError::BadRegion { .. }));
    let everything = KeepOut::Sphere {
        centre: Point3::origin(),
        radius: 5.0,
    };
    let refused = plan(&surface, &Coat::default(), &[everything]).expect_err("nothing left");
    assert_eq!(refused, PaintError::NoRows);
}
