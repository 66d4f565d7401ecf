//! Where the parts of a rack hang.
//!
//! In the coordinates of the rack, x is right, y down and z away for a viewer who faces it. Parts hang from the left to
//! the right with their upper edges at y = 0, so each is only moved along x and z.

use std::collections::BTreeMap;

use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::{MANY, RackSetup, Spacing};
use crate::assembly::{Assembly, bounds, middle_of_box};
use crate::cell::{PartPose, SimulatedObject};
use crate::clutter::quartered;
use crate::rasteriser::{Rendering, SurfaceLabel};
use geometry::depth_frame::Intrinsics;
use geometry::mesh::TriangleMesh;
use geometry::rigid::RigidTransform;
use geometry::units::{Metres, Radians};

/// Gap between neighbours that are apart, in metres.
const APART_M: std::ops::Range<f64> = 0.04..0.15;
/// Gap between neighbours that touch, in metres.
const TOUCHING_M: std::ops::Range<f64> = 0.0..0.01;
/// Width of an empty place, in metres.
const EMPTY_M: std::ops::Range<f64> = 0.5..0.9;
/// Share of a part that its neighbour hides.
const HIDDEN: std::ops::Range<f64> = 0.1..0.3;
/// Clear distance of a part in front of the one that it hides, in metres.
const IN_FRONT_M: std::ops::Range<f64> = 0.1..0.3;
/// Parts do not hang in one plane: deviation in either direction, in metres.
const OFF_PLANE_M: f64 = 0.02;
/// The upper edges are not at one height: how far they hang lower, in metres.
const LOWER_M: f64 = 0.06;
/// Largest rotation of a part against the rack about each axis.
const MAX_TURN: Radians = Radians(0.12);
/// Clear depth is kept this far beside the overlap, too, in metres.
const STRIP_MARGIN_M: f64 = 0.05;
/// The rack is moved back no farther than this: at 4 m a Kinect's readings end, in metres.
const LIMIT: Metres = Metres(3.7);

/// Separates these random numbers from others with the same seed.
const STREAM: u64 = 0x4a6_04a6_04a6_04a6;

/// A part or object on the rack.
pub(super) struct Hung {
    pub(super) object: SimulatedObject,
    /// In its own coordinates.
    pub(super) mesh: TriangleMesh,
    pub(super) camera_from_part: RigidTransform,
}

impl Hung {
    /// Returns the vertices in camera space.
    pub(super) fn vertices(&self) -> Vec<Point3<f64>> {
        self.mesh.placed_vertices(|p| self.camera_from_part * p)
    }
}

/// Hangs the parts on the rack and poses the rack in front of the camera.
pub(super) fn hang(setup: &RackSetup) -> Vec<Hung> {
    let bodies = draw_bodies(setup);
    let (mut shifts, mut camera_from_row) = (Vec::new(), None);
    // What a part hides depends on where the camera is, and that on the width of the rack.
    let num_passes = match setup.spacing {
        Spacing::Apart | Spacing::Touching => 1,
        Spacing::Overlapping => 4,
    };
    for _ in 0..num_passes {
        shifts = line_up(&bodies, setup, camera_from_row.as_ref());
        camera_from_row = Some(pose(&bodies, &shifts, setup));
    }
    let camera_from_row = camera_from_row.unwrap_or_default();
    let hung = bodies.into_iter().zip(shifts).map(|(body, shift)| Hung {
        object: body.object,
        camera_from_part: camera_from_row * Translation3::from(shift) * body.row_from_part,
        mesh: body.mesh,
    });
    hung.collect()
}

/// A part as it hangs, before it is moved to its place in the row.
struct Body {
    object: SimulatedObject,
    mesh: TriangleMesh,
    row_from_part: RigidTransform,
    /// Where the edges of its triangles cross the lines of the front view, in the coordinates of the row, line by line.
    crossings: Vec<(i64, Point3<f64>)>,
    /// Gap to what hangs to its left, in metres, with the empty places between.
    gap: f64,
    /// Where its origin is behind the plane of the rack, in metres.
    depth: f64,
    overlap: Option<Overlap>,
}

impl Body {
    /// Returns its left and right end in the row before it is moved.
    fn x_range(&self) -> (f64, f64) {
        let x = self.crossings.iter().map(|(_, p)| p.x);
        x.fold((f64::INFINITY, f64::NEG_INFINITY), |(from, to), x| {
            (from.min(x), to.max(x))
        })
    }

    /// Returns the least and the largest depth of every line within `strip` along the row, moved by `shift`.
    fn depths(
        &self,
        shift: Vector3<f64>,
        strip: &std::ops::Range<f64>,
    ) -> BTreeMap<i64, (f64, f64)> {
        let depths = self.lines().filter_map(|(line, points)| {
            let points = points.iter().map(|(_, point)| point + shift);
            let depths = points.filter(|p| strip.contains(&p.x)).map(|p| p.z);
            let (near, far) = depths.fold((f64::INFINITY, f64::NEG_INFINITY), |(near, far), z| {
                (near.min(z), far.max(z))
            });
            (near <= far).then_some((line, (near, far)))
        });
        depths.collect()
    }

    /// Returns the crossings of every line.
    fn lines(&self) -> impl Iterator<Item = (i64, &[(i64, Point3<f64>)])> {
        let lines = self.crossings.chunk_by(|(a, _), (b, _)| a == b);
        lines.map(|line| (line[0].0, line))
    }
}

/// How a part and its left neighbour hide each other.
struct Overlap {
    /// The part is in front of its left neighbour, otherwise behind it.
    is_in_front: bool,
    hidden_share: f64,
    /// In metres.
    clear_depth: f64,
}

fn draw_bodies(setup: &RackSetup) -> Vec<Body> {
    let mut random = Pcg64::seed_from_u64(setup.cell.seed ^ STREAM);
    let num_places = setup.places.len();
    // With an odd number, the first or the last is left over.
    let first_pair = random.random_range(0..=num_places % 2);
    let mut bodies: Vec<Body> = Vec::with_capacity(num_places);
    let mut empty_width = 0.0;
    for (index, &object) in setup.places.iter().enumerate() {
        if object == SimulatedObject::Nothing {
            empty_width += random.random_range(EMPTY_M);
            continue;
        }
        let mesh = object.mesh();
        let mut about = |axis, limit: f64| {
            UnitQuaternion::from_axis_angle(&axis, random.random_range(-limit..limit))
        };
        let yaw = about(Vector3::y_axis(), MAX_TURN.0);
        let pitch = about(Vector3::x_axis(), MAX_TURN.0);
        let roll = about(Vector3::z_axis(), MAX_TURN.0);
        let quarter = if random.random_bool(0.5) { 1.0 } else { -1.0 };
        let extents = mesh.bounds().map(|(low, high)| high - low);
        let is_on_end = num_places >= MANY && extents.is_some_and(|e| e.x > 1.2 * e.y);
        let on_end = if is_on_end {
            quarter * std::f64::consts::FRAC_PI_2
        } else {
            0.0
        };
        let on_end = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), on_end);
        let turn = roll * pitch * yaw * on_end;
        let turned = mesh.placed_vertices(|p| turn * p);
        let top = bounds(&turned).map_or(0.0, |(low, _)| low.y);
        let down = Translation3::new(0.0, random.random_range(0.0..LOWER_M) - top, 0.0);
        let gap = match setup.spacing {
            Spacing::Apart | Spacing::Overlapping => random.random_range(APART_M),
            Spacing::Touching => random.random_range(TOUCHING_M),
        };
        let depth = random.random_range(-OFF_PLANE_M..OFF_PLANE_M);
        let overlap = Overlap {
            is_in_front: random.random_bool(0.5),
            hidden_share: random.random_range(HIDDEN),
            clear_depth: random.random_range(IN_FRONT_M),
        };
        let is_second_of_pair = index > first_pair && (index - first_pair) % 2 == 1;
        let overlaps = setup.spacing == Spacing::Overlapping
            && is_second_of_pair
            && setup.places[index - 1] != SimulatedObject::Nothing;
        let row_from_part = down * turn;
        bodies.push(Body {
            object,
            crossings: crossings(&mesh, &row_from_part),
            mesh,
            row_from_part,
            gap: gap + empty_width,
            depth,
            overlap: overlaps.then_some(overlap),
        });
        empty_width = 0.0;
    }
    bodies
}

/// Returns how far each body is moved along the row. Without a camera, no part hides another.
fn line_up(
    bodies: &[Body],
    setup: &RackSetup,
    camera_from_row: Option<&RigidTransform>,
) -> Vec<Vector3<f64>> {
    let mut shifts: Vec<Vector3<f64>> = Vec::with_capacity(bodies.len());
    let mut right_edge = Edge::default();
    for (number, body) in bodies.iter().enumerate() {
        let left_edge = Edge::of(body, Vector3::zeros(), -1.0);
        let mut shift = Vector3::new(0.0, 0.0, body.depth);
        if let Some((width, depth)) = right_edge.clear_width(&left_edge) {
            shift.x = body.gap - width;
            if setup.spacing == Spacing::Touching {
                shift.z = -depth;
            }
            if let Some((overlap, camera_from_row)) = body.overlap.as_ref().zip(camera_from_row) {
                let pair = Pair {
                    left: &bodies[number - 1],
                    left_shift: shifts[number - 1],
                    right: body,
                    overlap,
                };
                shift = pair.shift(-width, camera_from_row, &setup.cell.intrinsics);
            }
        }
        right_edge.widen(&Edge::of(body, shift, 1.0));
        shifts.push(shift);
    }
    shifts
}

/// Poses the row in front of the camera: returns `camera_from_row`.
fn pose(bodies: &[Body], shifts: &[Vector3<f64>], setup: &RackSetup) -> RigidTransform {
    let mut row = Assembly::default();
    for (body, shift) in bodies.iter().zip(shifts) {
        row.add(&body.mesh, |p| body.row_from_part * p + shift);
    }
    let row = row.into_mesh();
    let middle = middle_of_box(&row.placed_vertices(|p| p));
    let row = TriangleMesh {
        vertices: row
            .vertices
            .iter()
            .map(|p| p - middle.coords.cast())
            .collect(),
        triangles: row.triangles,
    };
    let cell = &setup.cell;
    let camera_from_rack = match cell.pose {
        PartPose::Fixed(camera_from_rack) => camera_from_rack,
        PartPose::Drawn(range) => {
            let limit = Metres(LIMIT.0.max(range.farthest.0));
            let placed = range.draw_moved_back(&row, &cell.intrinsics, limit, cell.seed);
            placed.camera_from_part
        }
    };
    camera_from_rack * Translation3::from(-middle.coords)
}

/// Distance of the lines of the front view, in metres.
const LINE_M: f64 = 0.005;

/// Returns the points at which the edges of the triangles cross horizontal lines of the front view, with the numbers of the
/// lines, line by line.
fn crossings(mesh: &TriangleMesh, row_from_part: &RigidTransform) -> Vec<(i64, Point3<f64>)> {
    let points = mesh.placed_vertices(|p| row_from_part * p);
    let mut crossings = Vec::new();
    for &[a, b, c] in &mesh.triangles {
        for (a, b) in [(a, b), (b, c), (c, a)] {
            let (a, b) = (points[a as usize], points[b as usize]);
            let (top, bottom) = if a.y <= b.y { (a, b) } else { (b, a) };
            for line in (top.y / LINE_M).ceil() as i64..=(bottom.y / LINE_M).floor() as i64 {
                let along = (line as f64 * LINE_M - top.y) / (bottom.y - top.y).max(1e-12);
                crossings.push((line, top + (bottom - top) * along.min(1.0)));
            }
        }
    }
    crossings.sort_by_key(|(line, _)| *line);
    crossings
}

/// One side of a silhouette in the front view: the outermost point of every line.
#[derive(Default)]
struct Edge(BTreeMap<i64, Point3<f64>>);

impl Edge {
    /// Returns the right (`side` = 1) or left (-1) side of a body that is moved by `shift`.
    fn of(body: &Body, shift: Vector3<f64>, side: f64) -> Self {
        let outermost = |(line, points): (i64, &[(i64, Point3<f64>)])| {
            let points = points.iter().map(|(_, point)| point + shift);
            let outermost = points.reduce(|outermost, point| {
                if side * point.x > side * outermost.x {
                    point
                } else {
                    outermost
                }
            });
            Some((line, outermost?))
        };
        Self(body.lines().filter_map(outermost).collect())
    }

    /// Adds another right side.
    fn widen(&mut self, other: &Self) {
        for (&line, &point) in &other.0 {
            let outermost = self.0.entry(line).or_insert(point);
            if point.x > outermost.x {
                *outermost = point;
            }
        }
    }

    /// Returns how far a left side is right of this right side, where that is least, and how far it is behind it there; in
    /// metres. `None` if no line has both.
    fn clear_width(&self, left: &Self) -> Option<(f64, f64)> {
        let both = self.0.iter().filter_map(|(line, right)| {
            let left = left.0.get(line)?;
            Some((left.x - right.x, left.z - right.z))
        });
        both.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// Two neighbours of which one hides the other.
struct Pair<'a> {
    left: &'a Body,
    left_shift: Vector3<f64>,
    right: &'a Body,
    overlap: &'a Overlap,
}

impl Pair<'_> {
    /// Returns the shift of the right part with which the camera sees as much hidden as was drawn, or a little less.
    ///
    /// `beside` is the shift along x with which the two would touch in the front view.
    fn shift(
        &self,
        beside: f64,
        camera_from_row: &RigidTransform,
        camera: &Intrinsics,
    ) -> Vector3<f64> {
        // A part in front, off the camera's axis, may hide a neighbour beside it.
        let mut high = beside + 0.5;
        // The one must not get past the other.
        let widths = [self.left, self.right].map(|body| {
            let (from, to) = body.x_range();
            to - from
        });
        let mut low = beside - 0.5 * widths[0].min(widths[1]);
        for _ in 0..12 {
            let middle = f64::midpoint(low, high);
            let shift = self.at(middle);
            if self.hidden_share(shift, camera_from_row, camera) > self.overlap.hidden_share {
                low = middle;
            } else {
                high = middle;
            }
        }
        self.at(high)
    }

    /// Returns the shift of the right part to `x` along the row, at the drawn clear depth from the left part.
    fn at(&self, x: f64) -> Vector3<f64> {
        // Only where they overlap, or come nearest: a part's far end may reach well forward.
        let end = self.left.x_range().1 + self.left_shift.x;
        let start = self.right.x_range().0 + x;
        let strip = start.min(end) - STRIP_MARGIN_M..start.max(end) + STRIP_MARGIN_M;
        let left = self.left.depths(self.left_shift, &strip);
        let right = self.right.depths(Vector3::new(x, 0.0, 0.0), &strip);
        let (front, behind) = if self.overlap.is_in_front {
            (right, left)
        } else {
            (left, right)
        };
        let both = front.iter().filter_map(|(line, (_, far))| {
            let (near, _) = behind.get(line)?;
            Some(near - far)
        });
        let clear_depth = both.fold(f64::INFINITY, f64::min);
        // Where they do not meet at any height, their origins count.
        let clear_depth = if clear_depth.is_finite() {
            clear_depth
        } else {
            0.0
        };
        let missing = self.overlap.clear_depth - clear_depth;
        let towards_camera = if self.overlap.is_in_front { -1.0 } else { 1.0 };
        Vector3::new(x, 0.0, towards_camera * missing)
    }

    /// Returns the share of the part behind that the part in front hides from the camera, if it is shifted so.
    fn hidden_share(
        &self,
        shift: Vector3<f64>,
        camera_from_row: &RigidTransform,
        camera: &Intrinsics,
    ) -> f64 {
        let pose = |body: &Body, shift: Vector3<f64>| {
            camera_from_row * Translation3::from(shift) * body.row_from_part
        };
        let left = (&self.left.mesh, pose(self.left, self.left_shift));
        let right = (&self.right.mesh, pose(self.right, shift));
        let (front, behind) = if self.overlap.is_in_front {
            (right, left)
        } else {
            (left, right)
        };
        let mut rendering = Rendering::new(quartered(camera));
        rendering.draw_mesh(behind.0, &behind.1, SurfaceLabel::Part);
        let num_unhidden = rendering.num_pixels(SurfaceLabel::Part);
        rendering.draw_mesh(front.0, &front.1, SurfaceLabel::Clutter);
        let num_seen = rendering.num_pixels(SurfaceLabel::Part);
        1.0 - num_seen as f64 / num_unhidden.max(1) as f64
    }
}
