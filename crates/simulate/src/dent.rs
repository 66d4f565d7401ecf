//! A dent or a bump in a part's surface: a smooth displacement along one direction.
//!
//! The displacement falls from its depth at the centre to nothing at half the width as cos²(π·r / width), where r is the
//! distance from the axis through the centre. Coarse triangles are split first, each edge at its middle. Whether an edge is
//! split depends on its two ends alone, so that the triangles on both sides of it agree and the surface stays closed.

use std::collections::BTreeMap;

use nalgebra::{Point3, Unit, Vector3};

use geometry::{mesh::TriangleMesh, units::Metres};

/// A dent or a bump, in the coordinates of the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dent {
    /// Where it is deepest: a point of the undamaged surface.
    pub centre: Point3<f64>,
    /// Direction from the surface's inside to its outside.
    pub outwards: Unit<Vector3<f64>>,
    /// Diameter within which the surface is displaced, above 0.
    pub width: Metres,
    /// Displacement outwards at the centre: below 0 for a dent, above 0 for a bump.
    pub height: Metres,
}

/// Length of an edge that is fine enough, as a share of the width.
const FINE_EDGE_SHARE: f64 = 1.0 / 16.0;
/// Distance along the axis up to which the surface is displaced, metres: both skins of a sheet, and nothing far behind it.
const MAX_ALONG_M: f64 = 0.04;

impl Dent {
    /// Returns the displacement outwards at this distance from the axis, metres.
    pub fn height_at(&self, distance: f64) -> f64 {
        if distance >= 0.5 * self.width.0 {
            return 0.0;
        }
        let cosine = (std::f64::consts::PI * distance / self.width.0).cos();
        self.height.0 * cosine * cosine
    }

    /// Returns the mesh with this dent or bump.
    ///
    /// # Panics
    /// If the split mesh has more vertices than a `u32` index can address.
    pub fn pressed_into(&self, mesh: &TriangleMesh) -> TriangleMesh {
        let mut dented = self.split(mesh);
        for vertex in &mut dented.vertices {
            let from_centre = vertex.cast::<f64>() - self.centre;
            let along = from_centre.dot(&self.outwards);
            if along.abs() > MAX_ALONG_M {
                continue;
            }
            let height = self.height_at((from_centre - *self.outwards * along).norm());
            let moved = vertex.cast::<f64>() + *self.outwards * height;
            *vertex = moved.cast();
        }
        dented
    }

    /// Returns the same surface with short edges wherever it will be displaced.
    fn split(&self, mesh: &TriangleMesh) -> TriangleMesh {
        let mut vertices = mesh.vertices.clone();
        let mut middles: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let mut pending = mesh.triangles.clone();
        let mut triangles = Vec::with_capacity(pending.len());
        while let Some([a, b, c]) = pending.pop() {
            let mut middle = |one: u32, other: u32| {
                let at = [one, other].map(|index| vertices[index as usize]);
                self.is_too_long(at).then(|| {
                    let edge = [one.min(other), one.max(other)];
                    *middles.entry(edge).or_insert_with(|| {
                        vertices.push(nalgebra::center(&at[0], &at[1]));
                        u32::try_from(vertices.len() - 1).expect("fewer vertices than indices")
                    })
                })
            };
            match [middle(a, b), middle(b, c), middle(c, a)] {
                [None, None, None] => triangles.push([a, b, c]),
                [Some(ab), None, None] => pending.extend([[a, ab, c], [ab, b, c]]),
                [None, Some(bc), None] => pending.extend([[a, b, bc], [a, bc, c]]),
                [None, None, Some(ca)] => pending.extend([[a, b, ca], [ca, b, c]]),
                [Some(ab), Some(bc), None] => {
                    pending.extend([[ab, b, bc], [a, ab, bc], [a, bc, c]]);
                }
                [None, Some(bc), Some(ca)] => {
                    pending.extend([[bc, c, ca], [a, b, bc], [a, bc, ca]]);
                }
                [Some(ab), None, Some(ca)] => {
                    pending.extend([[a, ab, ca], [ab, b, c], [ab, c, ca]]);
                }
                [Some(ab), Some(bc), Some(ca)] => {
                    pending.extend([[a, ab, ca], [ab, b, bc], [bc, c, ca], [ab, bc, ca]]);
                }
            }
        }
        TriangleMesh {
            vertices,
            triangles,
        }
    }

    /// True for an edge that is to be split: longer than is fine enough, and no further from the dent than its own length. Of
    /// a triangle that the dent touches, at least the longest edge is that near.
    fn is_too_long(&self, [a, b]: [Point3<f32>; 2]) -> bool {
        let [a, b] = [a, b].map(Point3::cast::<f64>);
        let length = (b - a).norm();
        let distance = (nalgebra::center(&a, &b) - self.centre).norm();
        length > FINE_EDGE_SHARE * self.width.0
            && distance < length + (0.5 * self.width.0).hypot(MAX_ALONG_M)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PartKind, PartModel, Side};

    /// A square of 1 m of two triangles, which faces -z.
    fn sheet() -> TriangleMesh {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let vertices = corners.map(|[x, y]| Point3::new(x, y, 0.0)).to_vec();
        TriangleMesh::new(vertices, vec![[0, 2, 1], [0, 3, 2]]).expect("a mesh")
    }

    fn dent() -> Dent {
        Dent {
            centre: Point3::new(0.3, 0.6, 0.0),
            outwards: -Vector3::z_axis(),
            width: Metres(0.04),
            height: Metres(-0.003),
        }
    }

    #[test]
    fn a_dent_is_as_deep_and_as_wide_as_asked_for() {
        let dent = dent();
        let dented = dent.pressed_into(&sheet());
        let deepest = dented.vertices.iter().map(|p| p.z).fold(0.0, f32::max);
        assert!((deepest - 0.003).abs() < 1e-4, "{deepest} m");
        for p in dented.vertices.iter().map(|p| p.cast::<f64>()) {
            let distance = (p.xy() - dent.centre.xy()).norm();
            assert!((p.z + dent.height_at(distance)).abs() < 1e-6, "{p}");
        }
        // The volume under cos² over a disc is (1/2 - 2/π²) of the cylinder's.
        let volume: f64 = (dented.triangles.iter())
            .map(|corners| {
                let [a, b, c] = corners.map(|i| dented.vertices[i as usize].cast::<f64>());
                let area = (b.xy() - a.xy()).perp(&(c.xy() - a.xy())).abs() / 2.0;
                area * (a.z + b.z + c.z) / 3.0
            })
            .sum();
        let pi = std::f64::consts::PI;
        let expected = 0.003 * pi * 0.02 * 0.02 * (0.5 - 2.0 / (pi * pi));
        assert!((volume / expected - 1.0).abs() < 0.03, "{volume} m³");
    }

    #[test]
    fn the_surface_of_a_part_stays_as_closed_as_it_was() {
        let mesh = PartModel::new(PartKind::Fender, Side::Left, 0).into_mesh();
        let centre = mesh.vertices[mesh.vertices.len() / 2].cast();
        let split = Dent { centre, ..dent() }.split(&mesh);
        assert!((split.area() / mesh.area() - 1.0).abs() < 1e-4);
        // Length of the edges at which the surface ends: a crack would add to it.
        let open_length = |mesh: &TriangleMesh| -> f64 {
            let at = |i: u32| mesh.vertices[i as usize];
            let bits = |i: u32| -> [u32; 3] { at(i).coords.map(f32::to_bits).into() };
            let mut edges: BTreeMap<[[u32; 3]; 2], (i32, f32)> = BTreeMap::new();
            for [a, b, c] in &mesh.triangles {
                for [from, to] in [[*a, *b], [*b, *c], [*c, *a]] {
                    let (is_forwards, ends) = if bits(from) < bits(to) {
                        (true, [bits(from), bits(to)])
                    } else {
                        (false, [bits(to), bits(from)])
                    };
                    let (sum, length) = edges.entry(ends).or_default();
                    *sum += if is_forwards { 1 } else { -1 };
                    *length = (at(from) - at(to)).norm();
                }
            }
            let open = edges.values().filter(|(sum, _)| *sum != 0);
            open.map(|(_, length)| f64::from(*length)).sum()
        };
        let (before, after) = (open_length(&mesh), open_length(&split));
        assert!(
            after <= before * 1.001 + 1e-6,
            "{before} m became {after} m"
        );
        let fine_edge = FINE_EDGE_SHARE * 0.04;
        let near = split.triangles.iter().filter(|corners| {
            let at = corners.map(|i| split.vertices[i as usize].cast::<f64>());
            at.iter().any(|p| (p - centre).norm() < 0.02)
        });
        for corners in near {
            let [a, b, c] = corners.map(|i| split.vertices[i as usize].cast::<f64>());
            for edge in [b - a, c - b, a - c] {
                assert!(edge.norm() <= fine_edge * 1.0001, "{}", edge.norm());
            }
        }
    }
}
