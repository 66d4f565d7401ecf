//! The cell: the part at its pose, wall and floor fitted around it, with or without stand and clutter.

use std::sync::OnceLock;

use nalgebra::{Point3, Rotation3, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

use super::assembly::Assembly;
use super::booth;
use super::clutter::{Clutter, on_floor, plank};
use super::object::ObjectKind;
use super::part::{PartKind, PartModel, Side};
use super::placement::PoseRange;
use super::rasteriser::{Plane, Rendering, SurfaceLabel};
use super::sensor::{Kinect, Sensor, SensorNoise};
use super::stand::{Stand, down_from_above, floor_below, post};
use geometry::depth_frame::Intrinsics;
use geometry::mesh::TriangleMesh;
use geometry::rigid::RigidTransform;
use geometry::units::{Metres, Radians};

/// The meshes of the standard car's parts, for either side, built on first use: nearly every frame is of one of them.
static STANDARD: [[OnceLock<TriangleMesh>; 2]; PartKind::ALL.len()] =
    [const { [const { OnceLock::new() }; 2] }; PartKind::ALL.len()];

/// The object in front of the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SimulatedObject {
    /// One of the eight parts.
    Part {
        /// The kind of part.
        kind: PartKind,
        /// The side of the car; ignored for parts without sides.
        side: Side,
        /// The car model; 0 is the standard car.
        model_seed: u64,
    },
    /// An object that is not a known part.
    Object(ObjectKind),
    /// Nothing: the empty cell.
    Nothing,
}

impl SimulatedObject {
    /// Returns the surface in the object's own coordinates, in metres.
    pub fn mesh(&self) -> TriangleMesh {
        match *self {
            Self::Part {
                kind,
                side,
                model_seed,
            } => {
                let made = || PartModel::new(kind, side, model_seed).into_mesh();
                if model_seed == 0 {
                    let standard = &STANDARD[kind as usize][side as usize];
                    standard.get_or_init(made).clone()
                } else {
                    made()
                }
            }
            Self::Object(kind) => kind.mesh(),
            Self::Nothing => TriangleMesh::default(),
        }
    }
}

/// The pose of the part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PartPose {
    /// This pose, `camera_from_part`.
    Fixed(RigidTransform),
    /// A pose drawn from a range with the cell's seed.
    Drawn(PoseRange),
}

/// The part's surroundings and the kind of camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Surroundings {
    /// A wall and a floor, seen by a Kinect.
    #[default]
    Plain,
    /// A paint booth, seen by a depth camera on the robot's flange. The seed draws the pose, the tubes and clamps that hold
    /// the part, the walls and the field of view. The setup's pose range, stand, clutter, wall and floor are ignored.
    Booth,
}

/// Everything that determines a simulated frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellSetup {
    /// The object in front of the camera.
    pub subject: SimulatedObject,
    /// Its pose.
    pub pose: PartPose,
    /// The stand that holds it.
    pub stand: Stand,
    /// Other things in the cell.
    pub clutter: Clutter,
    /// The sensor's noise, with its own seed, so that the same scene can be captured again.
    pub noise: SensorNoise,
    /// The camera. It is simulated as a pinhole camera: its distortion is ignored.
    pub intrinsics: Intrinsics,
    /// Distance of the wall along the optical axis, 2.2 to 3.0 m; increased if the part reaches further.
    pub wall: Metres,
    /// Depth of the floor below the camera; increased if the part reaches lower. A part standing on the floor determines it.
    pub floor: Metres,
    /// Seed of the pose, the tilt of wall and floor, and the clutter.
    pub seed: u64,
    /// The surroundings and the kind of camera.
    pub surroundings: Surroundings,
}

impl CellSetup {
    /// A tidy cell: the subject at a drawn pose ([`PoseRange::placed`]) in front of wall and floor, with a Kinect's noise.
    pub fn new(subject: SimulatedObject, seed: u64) -> Self {
        Self {
            subject,
            pose: PartPose::Drawn(PoseRange::placed()),
            stand: Stand::None,
            clutter: Clutter::None,
            noise: SensorNoise::kinect(seed),
            intrinsics: Intrinsics::KINECT,
            wall: Metres(2.4),
            floor: Metres(1.05),
            seed,
            surroundings: Surroundings::Plain,
        }
    }

    /// A paint booth with the subject on a stand.
    pub fn booth(subject: SimulatedObject, seed: u64) -> Self {
        Self {
            intrinsics: booth::CAMERA,
            surroundings: Surroundings::Booth,
            ..Self::new(subject, seed)
        }
    }

    /// A tidy cell with a part in it.
    pub fn with_part(kind: PartKind, side: Side, model_seed: u64, seed: u64) -> Self {
        Self::new(
            SimulatedObject::Part {
                kind,
                side,
                model_seed,
            },
            seed,
        )
    }
}

/// Least distance of the wall behind the part, and of the floor below it, in metres: room for the stand's post.
const CLEARANCE_M: f64 = 0.15;
/// Largest tilt of wall and floor about each axis.
const MAX_TILT: Radians = Radians(0.05);

/// Separates the cell's random numbers from others with the same seed.
const STREAM: u64 = 0x00ce_11ce_11ce_11ce;

/// The arranged cell, in camera space.
pub(super) struct Cell<'a> {
    pub(super) part: &'a TriangleMesh,
    pub(super) camera_from_part: RigidTransform,
    /// Everything else, drawn in this order.
    pub(super) meshes: Vec<(TriangleMesh, SurfaceLabel)>,
    pub(super) planes: Vec<(Plane, SurfaceLabel)>,
    pub(super) sensor: Box<dyn Sensor>,
}

impl<'a> Cell<'a> {
    /// Places the part and arranges the rest around it.
    pub(super) fn arrange(setup: &CellSetup, part: &'a TriangleMesh) -> Self {
        match setup.surroundings {
            Surroundings::Plain => Self::plain(setup, part),
            Surroundings::Booth => booth::arrange(setup, part),
        }
    }

    fn plain(setup: &CellSetup, part: &'a TriangleMesh) -> Self {
        let mut random = Pcg64::seed_from_u64(setup.seed ^ STREAM);
        let camera_from_part = match setup.pose {
            PartPose::Drawn(range) => {
                let placed = range.draw(part, &setup.intrinsics, setup.seed);
                placed.camera_from_part
            }
            PartPose::Fixed(camera_from_part) => camera_from_part,
        };
        let hung = part.placed_vertices(|p| camera_from_part * p);
        let mut wall = beyond(
            Vector3::z(),
            setup.wall.0.clamp(2.2, 3.0),
            &hung,
            &mut random,
        );
        let mut floor = beyond(Vector3::y(), setup.floor.0, &hung, &mut random);
        if setup.stand == Stand::Floor {
            let down = down_from_above(&mut random);
            // The wall stays upright.
            let away = Vector3::new(0.0, -down.z, down.y);
            wall = beyond(away, setup.wall.0, &hung, &mut random);
            floor = floor_below(&hung, &down).unwrap_or(floor);
        }
        let stand = match setup.stand {
            Stand::None | Stand::Floor => Assembly::default(),
            Stand::Post => post(&hung, &floor),
        };
        let mut clutter = match setup.clutter {
            Clutter::None => Assembly::default(),
            Clutter::OnFloor | Clutter::InFront => on_floor(&hung, &floor, &wall, &mut random),
        };
        if setup.clutter == Clutter::InFront {
            let draw_part = |picture: &mut Rendering| {
                picture.draw_mesh(part, &camera_from_part, SurfaceLabel::Part);
            };
            plank(
                &mut clutter,
                &hung,
                &setup.intrinsics,
                draw_part,
                &mut random,
            );
        }
        Self {
            part,
            camera_from_part,
            meshes: vec![
                (stand.into_mesh(), SurfaceLabel::Stand),
                (clutter.into_mesh(), SurfaceLabel::Clutter),
            ],
            planes: vec![(wall, SurfaceLabel::Wall), (floor, SurfaceLabel::Floor)],
            sensor: Box::new(Kinect),
        }
    }

    /// Draws the part alone.
    pub(super) fn draw_part(&self, rendering: &mut Rendering) {
        rendering.draw_mesh(self.part, &self.camera_from_part, SurfaceLabel::Part);
    }

    /// Draws everything but the part.
    pub(super) fn draw_rest(&self, rendering: &mut Rendering) {
        let camera = RigidTransform::identity();
        for (mesh, label) in &self.meshes {
            rendering.draw_mesh(mesh, &camera, *label);
        }
        for (plane, label) in &self.planes {
            rendering.draw_plane(plane, *label);
        }
    }
}

/// Returns true if the whole mesh lies within the picture.
pub(super) fn is_in_frame(
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

/// Returns a slightly tilted plane with this normal, at the offset `wished` or further if the part needs it.
fn beyond(normal: Vector3<f64>, wished: f64, hung: &[Point3<f64>], random: &mut Pcg64) -> Plane {
    let mut tilt = || MAX_TILT.0 * (2.0 * random.random::<f64>() - 1.0);
    let normal = Rotation3::from_euler_angles(tilt(), tilt(), 0.0) * normal;
    let reach = hung
        .iter()
        .map(|p| normal.dot(&p.coords))
        .fold(0.0, f64::max);
    Plane {
        normal,
        offset: wished.max(reach + CLEARANCE_M),
    }
}
