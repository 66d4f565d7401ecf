//! The cell: wall, floor, what holds the part, what else stands about.

use nalgebra::{Point3, Rotation3, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

use super::assembly::Assembly;
use super::beam::{Section, block, sweep};
use super::object::ObjectKind;
use super::part::{PartKind, PartModel, Side};
use super::placement::{Placed, Placement};
use super::rasteriser::{Plane, Rendering, SurfaceLabel};
use super::sensor::SensorNoise;
use crate::capture::frame::Intrinsics;
use crate::geometry::mesh::TriangleMesh;
use crate::geometry::rigid::RigidTransform;
use crate::units::{Metres, Radians};

/// What hangs before the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Subject {
    /// One of the eight parts.
    Part {
        /// Which.
        kind: PartKind,
        /// The side of the car; without meaning for a part that is not sided.
        side: Side,
        /// The car model; 0 is the standard car.
        model_seed: u64,
    },
    /// Something that is no known part.
    Object(ObjectKind),
}

impl Subject {
    /// Its surface in its own coordinates, metres.
    pub fn mesh(&self) -> TriangleMesh {
        match *self {
            Self::Part {
                kind,
                side,
                model_seed,
            } => PartModel::new(kind, side, model_seed).into_mesh(),
            Self::Object(kind) => kind.mesh(),
        }
    }
}

/// Where the part hangs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PartPose {
    /// Exactly here: `camera_from_part`.
    Fixed(RigidTransform),
    /// Drawn from a range by the cell's seed.
    Drawn(Placement),
}

/// What holds the part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stand {
    /// Nothing in sight.
    #[default]
    None,
    /// A post behind the part with a cross bar and two hooks over the part's upper edge.
    Post,
}

/// What else is in the cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Clutter {
    /// Nothing.
    #[default]
    None,
    /// Two or three things on the floor, beside and behind the part.
    OnFloor,
    /// As on the floor, and a plank between camera and part that hides 10 to 25 % of it.
    InFront,
}

/// All that a simulated frame depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellSetup {
    /// What hangs before the camera.
    pub subject: Subject,
    /// Where it hangs.
    pub pose: PartPose,
    /// What holds it.
    pub stand: Stand,
    /// What else is there.
    pub clutter: Clutter,
    /// The sensor's noise, with a seed of its own: the same scene can be captured again.
    pub noise: SensorNoise,
    /// The camera.
    pub intrinsics: Intrinsics,
    /// Distance of the wall on the optical axis, 2.2 to 3.0 m; moved back where the part reaches farther.
    pub wall: Metres,
    /// How far the floor lies below the camera; moved down where the part reaches lower.
    pub floor: Metres,
    /// Draws the pose, the tilt of wall and floor, and the clutter.
    pub seed: u64,
}

impl CellSetup {
    /// A tidy cell: the subject at a drawn pose ([`Placement::placed`]) before wall and floor, a Kinect's noise.
    pub fn new(subject: Subject, seed: u64) -> Self {
        Self {
            subject,
            pose: PartPose::Drawn(Placement::placed()),
            stand: Stand::None,
            clutter: Clutter::None,
            noise: SensorNoise::kinect(seed),
            intrinsics: Intrinsics::KINECT,
            wall: Metres(2.4),
            floor: Metres(1.05),
            seed,
        }
    }

    /// A tidy cell with a part in it.
    pub fn with_part(kind: PartKind, side: Side, model_seed: u64, seed: u64) -> Self {
        Self::new(
            Subject::Part {
                kind,
                side,
                model_seed,
            },
            seed,
        )
    }
}

/// How far the wall stays behind the part, and the floor below it, metres: room for the stand's post.
const CLEARANCE: f64 = 0.12;
/// Wall and floor are out of true by up to this.
const MAX_TILT: Radians = Radians(0.05);

/// Everything in its place, in camera space.
pub(super) struct Cell<'a> {
    part: &'a TriangleMesh,
    pub(super) camera_from_part: RigidTransform,
    /// Whether all of the part lies within the frame.
    pub(super) fits_frame: bool,
    wall: Plane,
    floor: Plane,
    stand: TriangleMesh,
    clutter: TriangleMesh,
}

impl<'a> Cell<'a> {
    /// Hangs the part and arranges the rest around it.
    pub(super) fn arrange(setup: &CellSetup, part: &'a TriangleMesh) -> Self {
        let mut random = Pcg64::seed_from_u64(setup.seed ^ 0x00ce_11ce_11ce_11ce);
        let Placed {
            camera_from_part,
            fully_visible,
        } = match setup.pose {
            PartPose::Drawn(placement) => placement.draw(part, &setup.intrinsics, setup.seed),
            PartPose::Fixed(camera_from_part) => Placed {
                camera_from_part,
                fully_visible: is_in_frame(part, &camera_from_part, &setup.intrinsics),
            },
        };
        let hung: Vec<Point3<f64>> = part
            .vertices
            .iter()
            .map(|p| camera_from_part * p.cast::<f64>())
            .collect();
        let wall = behind(setup.wall, &hung, &mut random);
        let floor = below(setup.floor, &hung, &mut random);
        let stand = match setup.stand {
            Stand::None => Assembly::default(),
            Stand::Post => post(&hung, &floor),
        };
        let clutter = match setup.clutter {
            Clutter::None => Assembly::default(),
            Clutter::OnFloor => on_floor(&hung, &floor, &wall, &mut random),
            Clutter::InFront => {
                let mut clutter = on_floor(&hung, &floor, &wall, &mut random);
                plank(&mut clutter, &hung, &mut random);
                clutter
            }
        };
        Self {
            part,
            camera_from_part,
            fits_frame: fully_visible,
            wall,
            floor,
            stand: stand.into_mesh(),
            clutter: clutter.into_mesh(),
        }
    }

    /// Draws the part alone.
    pub(super) fn draw_part(&self, rendering: &mut Rendering) {
        rendering.draw_mesh(self.part, &self.camera_from_part, SurfaceLabel::Part);
    }

    /// Draws everything but the part.
    pub(super) fn draw_rest(&self, rendering: &mut Rendering) {
        let camera = RigidTransform::identity();
        rendering.draw_mesh(&self.stand, &camera, SurfaceLabel::Stand);
        rendering.draw_mesh(&self.clutter, &camera, SurfaceLabel::Clutter);
        rendering.draw_plane(&self.wall, SurfaceLabel::Wall);
        rendering.draw_plane(&self.floor, SurfaceLabel::Floor);
    }
}

fn is_in_frame(
    part: &TriangleMesh,
    camera_from_part: &RigidTransform,
    camera: &Intrinsics,
) -> bool {
    let (right, bottom) = (camera.width as f64 - 0.5, camera.height as f64 - 0.5);
    part.vertices.iter().all(|p| {
        camera
            .pixel_of(&(camera_from_part * p.cast::<f64>()))
            .is_some_and(|(u, v)| u >= -0.5 && v >= -0.5 && u < right && v < bottom)
    })
}

/// A plane facing along `normal`, out of true, at the wished offset or as far as the part needs.
fn beyond(normal: Vector3<f64>, wished: f64, hung: &[Point3<f64>], random: &mut Pcg64) -> Plane {
    let mut tilt = || MAX_TILT.0 * (2.0 * random.random::<f64>() - 1.0);
    let normal = Rotation3::from_euler_angles(tilt(), tilt(), 0.0) * normal;
    let reach = hung
        .iter()
        .map(|p| normal.dot(&p.coords))
        .fold(0.0, f64::max);
    Plane {
        normal,
        offset: wished.max(reach + CLEARANCE),
    }
}

fn behind(wall: Metres, hung: &[Point3<f64>], random: &mut Pcg64) -> Plane {
    beyond(Vector3::z(), wall.0.clamp(2.2, 3.0), hung, random)
}

fn below(floor: Metres, hung: &[Point3<f64>], random: &mut Pcg64) -> Plane {
    beyond(Vector3::y(), floor.0, hung, random)
}

/// Height of the floor at (x, z).
fn floor_at(floor: &Plane, x: f64, z: f64) -> f64 {
    (floor.offset - floor.normal.x * x - floor.normal.z * z) / floor.normal.y
}

/// A post behind the part, a cross bar at its upper edge, two hooks over that edge.
fn post(hung: &[Point3<f64>], floor: &Plane) -> Assembly {
    let mut stand = Assembly::default();
    let Some(&first) = hung.first() else {
        return stand;
    };
    let (low, high) = hung
        .iter()
        .fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
    let x = 0.5 * (low.x + high.x);
    let z = high.z + 0.05;
    let reach = 0.2 * (high.x - low.x);
    // The upper edge where a hook takes hold: the highest point within 2 cm to either side.
    let edge_above = |x: f64| {
        hung.iter()
            .filter(|p| (p.x - x).abs() < 0.02)
            .min_by(|a, b| a.y.total_cmp(&b.y))
            .copied()
    };
    let hooks: Vec<Point3<f64>> = [x - reach, x + reach]
        .into_iter()
        .filter_map(edge_above)
        .collect();
    let bar_y = hooks.iter().map(|p| p.y).fold(low.y + 0.1, f64::min);
    let facing = -Vector3::z();
    let rod = Section::Round { radius: 0.012 };
    let bar = [
        Point3::new(x - reach - 0.05, bar_y, z),
        Point3::new(x + reach + 0.05, bar_y, z),
    ];
    sweep(&mut stand, &bar, rod, facing);
    let upright = [
        Point3::new(x, floor_at(floor, x, z), z),
        Point3::new(x, bar_y, z),
    ];
    let square = Section::Bar {
        width: 0.04,
        depth: 0.04,
    };
    sweep(&mut stand, &upright, square, facing);
    let wire = Section::Round { radius: 0.006 };
    for edge in hooks {
        let over = Point3::new(edge.x, edge.y - 0.008, edge.z - 0.01);
        let path = [
            Point3::new(edge.x, bar_y, z),
            over,
            over + Vector3::new(0.0, 0.025, -0.012),
        ];
        sweep(&mut stand, &path, wire, Vector3::x());
    }
    stand
}

/// Two or three things on the floor that leave the part alone.
fn on_floor(hung: &[Point3<f64>], floor: &Plane, wall: &Plane, random: &mut Pcg64) -> Assembly {
    const KINDS: [ObjectKind; 4] = [
        ObjectKind::Box,
        ObjectKind::Stool,
        ObjectKind::Chair,
        ObjectKind::Bucket,
    ];
    let mut clutter = Assembly::default();
    let num_things = random.random_range(2..=3);
    let mut num_placed = 0;
    for _ in 0..20 {
        let mesh = KINDS[random.random_range(0..KINDS.len())].mesh();
        let turn = Rotation3::from_axis_angle(&Vector3::y_axis(), random.random_range(-1.5..1.5));
        let (x, z) = (
            random.random_range(-1.1..1.1),
            random.random_range(1.5..2.2),
        );
        let turned: Vec<Point3<f64>> = mesh
            .vertices
            .iter()
            .map(|p| turn * p.cast::<f64>())
            .collect();
        let foot = turned.iter().map(|p| p.y).fold(0.0, f64::max);
        let shift = Vector3::new(x, floor_at(floor, x, z) - foot, z);
        let is_before_wall = turned
            .iter()
            .all(|p| wall.normal.dot(&(p + shift).coords) < wall.offset);
        let radius = turned.iter().map(|p| p.coords.norm()).fold(0.0, f64::max);
        let is_clear = hung
            .iter()
            .all(|p| (p.coords - shift).norm() > radius + 0.08);
        if is_before_wall && is_clear {
            clutter.add(&mesh, |p| turn * p + shift);
            num_placed += 1;
        }
        if num_placed == num_things {
            break;
        }
    }
    clutter
}

/// An upright or level plank that hides a share of the part from one side.
fn plank(clutter: &mut Assembly, hung: &[Point3<f64>], random: &mut Pcg64) {
    let nearest = hung.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    let z = (nearest - 0.20).max(0.55);
    let axis = random.random_range(0..2);
    let side = if random.random_range(0..2) == 0 {
        1.0
    } else {
        -1.0
    };
    // The part's vertices lie about evenly on it, so a share of them is about that share of its area.
    let mut sights: Vec<f64> = hung.iter().map(|p| side * p[axis] / p.z).collect();
    sights.sort_by(f64::total_cmp);
    let hidden = random.random_range(0.12..0.22);
    let Some(&edge) = sights.get((hidden * sights.len() as f64) as usize) else {
        return;
    };
    let width = 1.5;
    let middle = side * (edge * z - width / 2.0);
    let (centre, size) = if axis == 0 {
        (Point3::new(middle, 0.0, z), Vector3::new(width, 3.0, 0.02))
    } else {
        (Point3::new(0.0, middle, z), Vector3::new(3.0, width, 0.02))
    };
    block(clutter, centre, size);
}
