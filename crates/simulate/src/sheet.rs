//! Pressed sheet: a flat region lifted into space, with its edges folded back.
//!
//! The region is trimmed out of a square grid by marching squares (Lorensen and Cline, "Marching Cubes: A High
//! Resolution 3D Surface Construction Algorithm", SIGGRAPH 1987, in two dimensions). Every edge vertex is bisected onto the
//! true outline, so outlines are smooth at any grid spacing. A web narrower than the spacing may be lost, and a corner
//! sharper than the spacing is cut off: choose the spacing by the narrowest web.

use nalgebra::{Point3, Vector3};

use super::assembly::Assembly;
use super::region::Region;

/// Least distance of edge vertices from the grid's nodes, as a share of the spacing; avoids needle-thin triangles.
const SNAP: f64 = 0.04;
/// Outer radius of a fold in metres: about three times the thickness of body sheet.
const FOLD_RADIUS_M: f64 = 0.003;

/// A sheet to be pressed. `u` runs right and `v` down for a viewer of the paint side.
pub(super) struct Sheet<'a> {
    /// The flat shape.
    pub(super) region: &'a Region,
    /// Smallest and largest u that the region may reach.
    pub(super) u_range: (f64, f64),
    /// Smallest and largest v that the region may reach.
    pub(super) v_range: (f64, f64),
    /// Grid spacing in metres.
    pub(super) spacing: f64,
    /// Maps a flat point to its place in space.
    pub(super) lift: &'a dyn Fn(f64, f64) -> Point3<f64>,
    /// Depth in metres to which the edge at a flat point is folded back; up to [`FOLD_RADIUS_M`] the edge stays raw.
    pub(super) fold: &'a dyn Fn(f64, f64) -> f64,
}

/// A vertex on the outline with its flat coordinates.
#[derive(Clone, Copy)]
struct EdgeVertex {
    index: u32,
    u: f64,
    v: f64,
}

/// One vertex of a trimmed cell.
#[derive(Clone, Copy)]
enum CellVertex {
    Inner(u32),
    Edge(EdgeVertex),
}

impl CellVertex {
    fn index(self) -> u32 {
        match self {
            Self::Inner(index) => index,
            Self::Edge(edge) => edge.index,
        }
    }
}

impl Sheet<'_> {
    /// Returns the pressed sheet alone.
    pub(super) fn pressed(&self) -> Assembly {
        let mut assembly = Assembly::default();
        self.press_into(&mut assembly);
        assembly
    }

    /// Adds the sheet to the part.
    pub(super) fn press_into(&self, assembly: &mut Assembly) {
        let columns = (((self.u_range.1 - self.u_range.0) / self.spacing).ceil() as usize).max(1);
        let rows = (((self.v_range.1 - self.v_range.0) / self.spacing).ceil() as usize).max(1);
        let step_u = (self.u_range.1 - self.u_range.0) / columns as f64;
        let step_v = (self.v_range.1 - self.v_range.0) / rows as f64;
        let flat = |column: usize, row: usize| {
            (
                self.u_range.0 + column as f64 * step_u,
                self.v_range.0 + row as f64 * step_v,
            )
        };
        let stride = columns + 1;
        let mut nodes = Vec::with_capacity(stride * (rows + 1));
        for row in 0..=rows {
            // The distance changes by at most one metre per metre, so one value classifies a whole run of nodes.
            let (mut is_inside, mut known_up_to) = (false, f64::NEG_INFINITY);
            for column in 0..=columns {
                let (u, v) = flat(column, row);
                if u >= known_up_to {
                    let distance = self.region.distance(u, v);
                    is_inside = distance < 0.0;
                    known_up_to = u + distance.abs();
                }
                nodes.push(is_inside.then(|| assembly.vertex((self.lift)(u, v))));
            }
        }
        // Vertices where the outline crosses a grid edge: to the right of a node, and below it.
        let mut crossings: [Vec<Option<EdgeVertex>>; 2] =
            [vec![None; nodes.len()], vec![None; nodes.len()]];
        let mut edges = Vec::new();
        let mut cell = Vec::with_capacity(8);
        for row in 0..rows {
            for column in 0..columns {
                let corners = [
                    (column, row),
                    (column + 1, row),
                    (column + 1, row + 1),
                    (column, row + 1),
                ];
                cell.clear();
                for k in 0..4 {
                    let (here, next) = (corners[k], corners[(k + 1) % 4]);
                    let (i, j) = (here.1 * stride + here.0, next.1 * stride + next.0);
                    if let Some(index) = nodes[i] {
                        cell.push(CellVertex::Inner(index));
                    }
                    if nodes[i].is_some() != nodes[j].is_some() {
                        let slot = &mut crossings[k % 2][i.min(j)];
                        let crossing = *slot.get_or_insert_with(|| {
                            let (inside, outside) = if nodes[i].is_some() {
                                (here, next)
                            } else {
                                (next, here)
                            };
                            self.outline_vertex(
                                assembly,
                                flat(inside.0, inside.1),
                                flat(outside.0, outside.1),
                            )
                        });
                        cell.push(CellVertex::Edge(crossing));
                    }
                }
                // Reverse the order of the corners: u × v points away from the viewer, the paint side towards the viewer.
                if corners
                    .iter()
                    .all(|&(i, j)| nodes[j * stride + i].is_some())
                {
                    let (u, v) = flat(column, row);
                    let middle = (self.lift)(u + 0.5 * step_u, v + 0.5 * step_v);
                    assembly.quad_through([0, 3, 2, 1].map(|k| cell[k].index()), &middle);
                } else {
                    for k in 1..cell.len().saturating_sub(1) {
                        assembly.triangle([cell[0].index(), cell[k + 1].index(), cell[k].index()]);
                    }
                }
                for k in 0..cell.len() {
                    if let (CellVertex::Edge(a), CellVertex::Edge(b)) =
                        (cell[k], cell[(k + 1) % cell.len()])
                    {
                        // The outline of the cell leaves the region at `a` and enters it again at `b`.
                        edges.push((a, b));
                    }
                }
            }
        }
        self.fold_edges(assembly, &edges);
    }

    /// Adds the point of the outline between two neighbouring nodes as a vertex.
    fn outline_vertex(
        &self,
        assembly: &mut Assembly,
        inside: (f64, f64),
        outside: (f64, f64),
    ) -> EdgeVertex {
        let at = |t: f64| {
            (
                inside.0 + (outside.0 - inside.0) * t,
                inside.1 + (outside.1 - inside.1) * t,
            )
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..9 {
            let middle = 0.5 * (low + high);
            let (u, v) = at(middle);
            if self.region.distance(u, v) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let (u, v) = at((0.5 * (low + high)).clamp(SNAP, 1.0 - SNAP));
        EdgeVertex {
            index: assembly.vertex((self.lift)(u, v)),
            u,
            v,
        }
    }

    /// Folds the outline back: a small radius, then a flange opposite to the paint side's normal.
    fn fold_edges(&self, assembly: &mut Assembly, edges: &[(EdgeVertex, EdgeVertex)]) {
        let mut rings: std::collections::HashMap<u32, Option<[u32; 3]>> =
            std::collections::HashMap::new();
        for (a, b) in edges {
            let mut ring_of = |vertex: &EdgeVertex| {
                *rings
                    .entry(vertex.index)
                    .or_insert_with(|| self.fold_ring(assembly, vertex))
            };
            let (Some(ring_a), Some(ring_b)) = (ring_of(a), ring_of(b)) else {
                continue;
            };
            let strip_a = [a.index, ring_a[0], ring_a[1], ring_a[2]];
            let strip_b = [b.index, ring_b[0], ring_b[1], ring_b[2]];
            for k in 0..3 {
                assembly.quad([strip_a[k], strip_b[k], strip_b[k + 1], strip_a[k + 1]]);
            }
        }
    }

    /// Adds the vertices of the fold behind one vertex of the outline; returns `None` where the edge stays raw.
    fn fold_ring(&self, assembly: &mut Assembly, vertex: &EdgeVertex) -> Option<[u32; 3]> {
        let EdgeVertex { u, v, .. } = *vertex;
        let depth = (self.fold)(u, v);
        if depth <= FOLD_RADIUS_M {
            return None;
        }
        // Half a millimetre is small compared with every radius, and large compared with rounding errors.
        let h = 5e-4;
        let along_u = ((self.lift)(u + h, v) - (self.lift)(u - h, v)) / (2.0 * h);
        let along_v = ((self.lift)(u, v + h) - (self.lift)(u, v - h)) / (2.0 * h);
        let towards_viewer = along_v.cross(&along_u).normalize();
        let slope_u = self.region.distance(u + h, v) - self.region.distance(u - h, v);
        let slope_v = self.region.distance(u, v + h) - self.region.distance(u, v - h);
        let outwards = along_u * slope_u + along_v * slope_v;
        let outwards = outwards.try_normalize(1e-12).unwrap_or_else(Vector3::zeros);
        let edge = (self.lift)(u, v);
        let mut ring =
            |out: f64, back: f64| assembly.vertex(edge + outwards * out - towards_viewer * back);
        Some([
            ring(0.7 * FOLD_RADIUS_M, 0.3 * FOLD_RADIUS_M),
            ring(FOLD_RADIUS_M, FOLD_RADIUS_M),
            ring(FOLD_RADIUS_M, depth),
        ])
    }
}
