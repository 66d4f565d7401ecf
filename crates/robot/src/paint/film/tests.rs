use super::*;
use crate::paint::{
    Profile, plan,
    surface::tests::{grid, plate},
};
use geometry::units::Metres;
use stages::reference::Coverage;

/// Straight ways with the gun on, each from a to b.
fn stripes(
    ways: impl Iterator<Item = (Point3<f64>, Point3<f64>, Vector3<f64>, Vector3<f64>)>,
    speed: f64,
) -> SprayPath {
    let points = ways.flat_map(|(a, b, jet, fan)| {
        [(a, true), (b, false)].map(|(nozzle, is_gun_on)| PathPoint {
            nozzle,
            direction: Unit::new_normalize(jet),
            stand_off: Some(Metres(0.15)),
            is_gun_on,
            speed: Some(speed),
            fan: Some(Unit::new_normalize(fan)),
        })
    });
    SprayPath::new(points.collect()).expect("points")
}

fn flat_stripes(levels: impl Iterator<Item = f64>, coat: &Coat) -> SprayPath {
    let way = |y: f64| {
        (
            Point3::new(-1.0, y, 0.15),
            Point3::new(1.0, y, 0.15),
            -Vector3::z(),
            Vector3::y(),
        )
    };
    stripes(levels.map(way), coat.speed)
}

#[test]
fn rows_without_end_leave_the_mean_and_the_ripple_of_the_closed_form() {
    let coat = Coat {
        spacing: 0.15,
        ..Coat::default()
    };
    let surface = plate(0.6, 0.6);
    let path = flat_stripes((-8..=8).map(|k| f64::from(k) * coat.spacing), &coat);
    let film = simulate(&surface, &path, &coat, &[]).expect("simulated");
    // A sum of Gaussians is nearly its mean and one harmonic (Poisson summation).
    let sigma = coat.gun.width / 4.0;
    let mean = coat.flat_thickness();
    for (p, t) in surface.points.iter().zip(&film.thickness) {
        let turn = 2.0 * PI / coat.spacing;
        let ripple = 2.0 * (-0.5 * (turn * sigma).powi(2)).exp() * (turn * p.y).cos();
        assert!(
            (t / mean - 1.0 - ripple).abs() < 2e-3,
            "{p}: {}",
            t / mean - 1.0 - ripple
        );
    }
}

#[test]
fn beyond_the_last_row_the_film_ends_as_the_normal_distribution() {
    let coat = Coat {
        spacing: 0.01,
        ..Coat::default()
    };
    let surface = plate(0.4, 0.4);
    let path = flat_stripes(
        (-50..=0).map(|k| f64::from(k) * coat.spacing - 0.005),
        &coat,
    );
    let film = simulate(&surface, &path, &coat, &[]).expect("simulated");
    let sigma = coat.gun.width / 4.0;
    // Φ by numerical integration, in steps of a thousandth.
    let cumulated = |z: f64| {
        let density = |k: i32| (-0.5 * (z - (f64::from(k) + 0.5) * 1e-3).powi(2)).exp();
        (0..8000).map(density).sum::<f64>() * 1e-3 / (2.0 * PI).sqrt()
    };
    for (p, t) in surface.points.iter().zip(&film.thickness) {
        let expected = cumulated(-p.y / sigma);
        let found = t / coat.flat_thickness();
        assert!((found - expected).abs() < 3e-3, "{p}: {found} {expected}");
    }
}

#[test]
fn around_a_cylinder_all_the_paint_lands_evenly() {
    let (coat, radius, num) = (Coat::default(), 0.5, 60);
    // Half of a cylinder, painted all around, so that no row is missing.
    let surface = grid(60, 150, Coverage::OneSide, |i, j| {
        let (x, angle) = (0.4 * i - 0.2, 2.6 * (j - 0.5));
        let normal = Vector3::new(0.0, angle.sin(), angle.cos());
        (Point3::from(normal * radius + Vector3::x() * x), normal)
    });
    let ways = (0..num).map(|k| {
        let angle = 2.0 * PI * f64::from(k) / f64::from(num);
        let out = Vector3::new(0.0, angle.sin(), angle.cos());
        let mouth = Point3::from(out * (radius + 0.15));
        (
            mouth - Vector3::x(),
            mouth + Vector3::x(),
            -out,
            out.cross(&Vector3::x()),
        )
    });
    let film = simulate(&surface, &stripes(ways, coat.speed), &coat, &[]).expect("simulated");
    let expected = coat.gun.film_rate() / (coat.speed * radius * 2.0 * PI / f64::from(num));
    for t in &film.thickness {
        assert!((t / expected - 1.0).abs() < 5e-3, "{}", t / expected);
    }
}

#[test]
fn a_planned_path_covers_a_plate_to_its_edges_and_figures_add_up() {
    let surface = plate(1.0, 0.7);
    let coat = Coat {
        target: Coat::default().flat_thickness(),
        acceleration: 0.0,
        ..Coat::default()
    };
    let path = plan(&surface, &coat, &[]).expect("planned");
    let film = simulate(&surface, &path, &coat, &[]).expect("simulated");
    let figures = &film.figures;
    assert!(figures.within > 0.97, "{figures:?}");
    assert_eq!((figures.missed, figures.double), (0.0, 0.0));
    assert!((figures.histogram.iter().sum::<f64>() - 1.0).abs() < 1e-9);
    assert!((figures.paintable - 1.0).abs() < 1e-9);
    assert!(figures.min <= figures.mean && figures.mean <= figures.max);
    // The share that lands is the mean times the area, divided by what was sprayed.
    let area = surface.point_area * surface.points.len() as f64;
    let expected = figures.mean * area / (film.path.paint * coat.gun.solids);
    assert!((film.path.landed / expected - 1.0).abs() < 1e-9);
    assert!(film.path.landed < coat.gun.transfer && film.path.landed > 0.3);
    assert!((film.path.length / film.path.time / coat.speed - 1.0).abs() < 0.02);
    let again = simulate(&surface, &path, &coat, &[]).expect("simulated");
    assert_eq!(again.thickness, film.thickness);
}

#[test]
fn half_the_speed_is_twice_the_film_and_a_gun_that_is_off_paints_nothing() {
    let surface = plate(0.4, 0.4);
    let coat = Coat::default();
    let film = |path: &SprayPath| simulate(&surface, path, &coat, &[]);
    let path = flat_stripes([0.0].into_iter(), &coat);
    let slow = path.points().iter().map(|p| PathPoint {
        speed: Some(coat.speed / 2.0),
        ..*p
    });
    let slow = SprayPath::new(slow.collect()).expect("points");
    let (fast, slow) = (
        film(&path).expect("simulated"),
        film(&slow).expect("simulated"),
    );
    for (one, two) in fast.thickness.iter().zip(&slow.thickness) {
        assert!((2.0 * one - two).abs() < 1e-12);
    }
    let off = path.points().iter().map(|p| PathPoint {
        is_gun_on: false,
        ..*p
    });
    let off = SprayPath::new(off.collect()).expect("points");
    assert_eq!(film(&off).expect_err("off"), PaintError::NeverSprays);
}

#[test]
fn a_part_that_hangs_elsewhere_gets_the_same_film_from_its_carried_path() {
    // Shelves of several heights, so that there are many edges of shadows.
    let surface = {
        let mut points = Vec::new();
        for i in -40_i32..=40 {
            for j in -30_i32..=30 {
                points.push(Point3::new(0.01 * f64::from(i), 0.01 * f64::from(j), 0.0));
                if i.rem_euclid(20) < 7 && j.rem_euclid(15) < 6 {
                    let height = 0.03 + 0.0013 * f64::from((i + 2 * j).rem_euclid(11));
                    points.push(points[points.len() - 1] + Vector3::z() * height);
                }
            }
        }
        let normals = vec![Vector3::z(); points.len()];
        PaintSurface::new(&points, &normals, Coverage::OneSide, None).expect("a surface")
    };
    let coat = Coat::default();
    let path = flat_stripes((-4..=4).map(|k| 0.0731 * f64::from(k)), &coat);
    let standard = simulate(&surface, &path, &coat, &[]).expect("simulated");
    let turn = nalgebra::UnitQuaternion::from_euler_angles(0.21, -0.13, 0.08);
    let pose = nalgebra::Isometry3::from_parts(Vector3::new(0.06, -0.05, 0.062).into(), turn);
    let hung = PaintSurface {
        points: surface.points.iter().map(|p| pose * p).collect(),
        normals: surface.normals.iter().map(|n| pose * n).collect(),
        side: pose * surface.side,
        longest: pose * surface.longest,
        middle: pose * surface.middle,
        ..surface.clone()
    };
    // The sign of a fan is arbitrary.
    for sign in [1.0, -1.0] {
        let carried = path.points().iter().map(|point| PathPoint {
            nozzle: pose * point.nozzle,
            direction: pose * point.direction,
            fan: point.fan.map(|fan| Unit::new_normalize(pose * *fan * sign)),
            ..*point
        });
        let carried = SprayPath::new(carried.collect()).expect("points");
        let film = simulate(&hung, &carried, &coat, &[]).expect("simulated");
        for (a, b) in standard.thickness.iter().zip(&film.thickness) {
            assert!((a - b).abs() < 1e-4 * coat.target, "{a} {b}");
        }
    }
}

#[test]
fn a_shelf_before_a_wall_takes_the_paint_that_the_wall_does_not_get() {
    // Rows over a wall whose middle is hidden by a shelf 60 mm in front of it; the paint is the same with and without
    // it.
    let coat = Coat::default();
    let wall = |with_shelf: bool| {
        let mut points = Vec::new();
        for i in -80..=80 {
            for j in -60..=60 {
                points.push(Point3::new(0.01 * f64::from(i), 0.01 * f64::from(j), 0.0));
                if with_shelf && f64::hypot(f64::from(i), f64::from(j)) < 15.0 {
                    points.push(Point3::new(0.01 * f64::from(i), 0.01 * f64::from(j), 0.06));
                }
            }
        }
        let normals = vec![Vector3::z(); points.len()];
        PaintSurface::new(&points, &normals, Coverage::OneSide, None).expect("a surface")
    };
    let levels = (-3..=3).map(|k| f64::from(k) * coat.spacing);
    let path = flat_stripes(levels, &Coat { speed: 0.4, ..coat });
    let landed = |surface: &PaintSurface| {
        let film = simulate(surface, &path, &coat, &[]).expect("simulated");
        let volume = film.thickness.iter().sum::<f64>() * 1e-4;
        (film, volume)
    };
    let (surface, shelved) = (wall(false), wall(true));
    let ((plain, all), (shadowed, split)) = (landed(&surface), landed(&shelved));
    assert!((split / all - 1.0).abs() < 0.02, "{}", split / all);
    // Nothing lands behind the shelf; on it, nearer to the gun, as much as rows leave at this distance.
    let middle = |film: &Film, surface: &PaintSurface, z: f64| {
        let at = Point3::new(0.0, 0.0, z);
        let near = |p: &Point3<f64>| (p - at).norm() < 0.025;
        let each = surface.points.iter().zip(&film.thickness);
        let each: Vec<f64> = each.filter(|(p, _)| near(p)).map(|(_, t)| *t).collect();
        each.iter().sum::<f64>() / each.len() as f64
    };
    assert!(middle(&plain, &surface, 0.0) > 0.9 * coat.flat_thickness());
    assert!(middle(&shadowed, &shelved, 0.0) < 1e-9);
    assert!(middle(&shadowed, &shelved, 0.06) > 0.8 * coat.flat_thickness());
    // A gun that faces the wall within 30° sees 35 mm behind the edge of the shelf, and one that fits in between all.
    let nearer = Coat {
        stand_off: 0.05,
        ..coat
    };
    let in_between = are_paintable(&shelved, &nearer, &[]);
    for (i, p) in shelved.points.iter().enumerate() {
        let from_middle = p.x.hypot(p.y);
        if p.z > 0.0 || !(0.1..0.135).contains(&from_middle) {
            let expected = p.z > 0.0 || from_middle > 0.12;
            assert_eq!(shadowed.is_paintable[i], expected, "{p}");
        }
        assert!(in_between[i], "{p}");
    }
}

#[test]
fn paint_that_flies_farther_than_the_coat_plans_still_lands() {
    for profile in [Profile::Gaussian, Profile::Beta] {
        let mut coat = Coat::default();
        coat.gun.profile = profile;
        let surface = plate(0.4, 0.4);
        let rows = flat_stripes((-16..=16).map(|k| f64::from(k) * coat.spacing), &coat);
        for (distance, is_known) in [(0.15, true), (0.25, true), (0.275, true), (0.3, false)] {
            let mut points = rows.points().to_vec();
            for point in &mut points {
                point.nozzle.z = distance;
                point.stand_off = is_known.then_some(Metres(distance));
            }
            let path = SprayPath::new(points).expect("points");
            let film = simulate(&surface, &path, &coat, &[]).expect("simulated");
            // The rows reach beyond the plate, so that volume is preserved; wider jets leave no more ripple.
            let mean = film.figures.mean / coat.flat_thickness();
            assert!((mean - 1.0).abs() < 0.02, "{profile:?} {distance}: {mean}");
            let least = film.figures.min / coat.flat_thickness();
            assert!(least > 0.9, "{profile:?} {distance}: {least}");
        }
        // One stripe over a plate at twice the stand-off: its middle, from the integral of the jet's density.
        let mut points = flat_stripes(std::iter::once(0.0), &coat).points().to_vec();
        for point in &mut points {
            point.nozzle.z = 0.3;
        }
        let path = SprayPath::new(points).expect("points");
        let film = simulate(&surface, &path, &coat, &[]).expect("simulated");
        let step = 1e-5;
        let density = (-40_000..40_000).map(|k| coat.gun.density(0.0, f64::from(k) * step) * step);
        let middle = coat.gun.film_rate() / coat.speed * density.sum::<f64>() / 2.0;
        let found = film.thickness.iter().copied().fold(0.0, f64::max);
        assert!(
            (found / middle - 1.0).abs() < 0.01,
            "{profile:?}: {found} {middle}"
        );
    }
}
