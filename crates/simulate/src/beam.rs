//! Solid bars and bodies of revolution: a section swept along a path, a profile turned about an axis.

use nalgebra::{Point3, Unit, UnitQuaternion, Vector3};

use super::assembly::Assembly;

/// The cross-section of a bar.
#[derive(Clone, Copy)]
pub(super) enum Section {
    /// A rectangle with bevelled edges: `width` across the facing direction, `depth` along it.
    Bar { width: f64, depth: f64 },
    /// A round rod.
    Round { radius: f64 },
}

impl Section {
    /// Returns the closed outline as (across, towards the facing direction), counter-clockwise.
    fn outline(self) -> Vec<(f64, f64)> {
        match self {
            Self::Bar { width, depth } => {
                let (a, b) = (width / 2.0, depth / 2.0);
                let bevel = 0.2 * a.min(b);
                let (c, d) = (a - bevel, b - bevel);
                vec![
                    (a, -d),
                    (a, d),
                    (c, b),
                    (-c, b),
                    (-a, d),
                    (-a, -d),
                    (-c, -b),
                    (c, -b),
                ]
            }
            Self::Round { radius } => (0..12)
                .map(|k| {
                    let angle = f64::from(k) * std::f64::consts::TAU / 12.0;
                    (radius * angle.cos(), radius * angle.sin())
                })
                .collect(),
        }
    }
}

/// Adds a bar along `path` (two points or more). The front of a [`Section::Bar`] points in the direction `facing`, which must
/// not be parallel to the path.
pub(super) fn sweep(
    assembly: &mut Assembly,
    path: &[Point3<f64>],
    section: Section,
    facing: Vector3<f64>,
) {
    let outline = section.outline();
    let mut last_ring: Option<Vec<u32>> = None;
    for (i, &point) in path.iter().enumerate() {
        let before = path[i.saturating_sub(1)];
        let after = path[(i + 1).min(path.len() - 1)];
        let along = (after - before).normalize();
        let across = facing.cross(&along).normalize();
        let front = along.cross(&across);
        let ring: Vec<u32> = outline
            .iter()
            .map(|&(a, f)| assembly.vertex(point + across * a + front * f))
            .collect();
        if let Some(last) = &last_ring {
            for k in 0..ring.len() {
                let next = (k + 1) % ring.len();
                assembly.quad([last[k], last[next], ring[next], ring[k]]);
            }
        } else {
            for k in 1..ring.len() - 1 {
                assembly.triangle([ring[0], ring[k + 1], ring[k]]);
            }
        }
        last_ring = Some(ring);
    }
    if let Some(ring) = last_ring {
        for k in 1..ring.len() - 1 {
            assembly.triangle([ring[0], ring[k], ring[k + 1]]);
        }
    }
}

/// Adds a box centred at `centre`, edges along the axes.
pub(super) fn block(assembly: &mut Assembly, centre: Point3<f64>, size: Vector3<f64>) {
    let half = Vector3::y() * (size.y / 2.0);
    let section = Section::Bar {
        width: size.x,
        depth: size.z,
    };
    sweep(
        assembly,
        &[centre - half, centre + half],
        section,
        -Vector3::z(),
    );
}

/// Adds the body of revolution of a closed profile about an axis through `centre`.
///
/// The profile lists (radius, height along the axis), radii above 0, up the outside and down the inside.
pub(super) fn turn(
    assembly: &mut Assembly,
    centre: Point3<f64>,
    axis: Unit<Vector3<f64>>,
    profile: &[(f64, f64)],
    num_steps: usize,
) {
    let from_z =
        UnitQuaternion::rotation_between_axis(&Vector3::z_axis(), &axis).unwrap_or_else(|| {
            UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI)
        });
    let rings: Vec<Vec<u32>> = (0..num_steps)
        .map(|step| {
            let angle = step as f64 * std::f64::consts::TAU / num_steps as f64;
            profile
                .iter()
                .map(|&(radius, height)| {
                    let local = Vector3::new(radius * angle.cos(), radius * angle.sin(), height);
                    assembly.vertex(centre + from_z * local)
                })
                .collect()
        })
        .collect();
    for (step, ring) in rings.iter().enumerate() {
        let next_ring = &rings[(step + 1) % num_steps];
        for k in 0..profile.len() {
            let next = (k + 1) % profile.len();
            assembly.quad([ring[k], next_ring[k], next_ring[next], ring[next]]);
        }
    }
}
