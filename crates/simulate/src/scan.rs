//! A simulated scan: a part that stands still in a cell, seen by a camera that a robot carries around it.
//!
//! Unlike in [`super::cell`], which arranges wall and floor around one camera, everything here is placed in the robot's
//! base frame (z up), so that frames from several sides show the same cell. The poses that the robot reports differ from the
//! true ones by given errors.

use nalgebra::{
    Isometry3, Matrix3, Point3, Rotation3, Translation3, Unit, UnitQuaternion, Vector3,
};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::assembly::Assembly;
use super::cell::SimulatedObject;
use super::rasteriser::{Rendering, SurfaceLabel};
use super::sensor::{Kinect, Sensor as _, SensorNoise};
use geometry::depth_frame::{DepthFrame, Intrinsics};
use geometry::mesh::TriangleMesh;
use geometry::rigid::RigidTransform;
use geometry::units::{Metres, Radians};

/// Everything that determines a simulated scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanSetup {
    /// The object in the cell.
    pub subject: SimulatedObject,
    /// Number of frames.
    pub num_shots: usize,
    /// Distance of the camera from the position that the robot reports.
    pub place_error: Metres,
    /// Angle of the camera from the orientation that the robot reports.
    pub turn_error: Radians,
    /// Scales the camera's noise, 0..5; 1 is a Kinect's.
    pub noise: f64,
    /// Seed of the camera's positions, the robot's errors and the noise.
    pub seed: u64,
}

/// One frame of a simulated scan.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedShot {
    /// The camera's frame.
    pub frame: DepthFrame,
    /// The camera's true pose.
    pub base_from_camera: RigidTransform,
    /// The camera's pose as the robot reports it.
    pub given: RigidTransform,
}

/// A simulated scan.
pub struct SimulatedScan {
    setup: ScanSetup,
    part: TriangleMesh,
    cell: TriangleMesh,
    /// Pose of the part's model in the base frame.
    pub base_from_model: RigidTransform,
}

/// The middle of the part in the base frame, in metres.
const MIDDLE_M: [f64; 3] = [1.9, 0.0, 1.1];
/// Separates these random numbers from others with the same seed.
const STREAM: u64 = 0x5ca9_5ca9_5ca9_5ca9;

impl SimulatedScan {
    /// Builds the part and the cell around it.
    pub fn new(setup: ScanSetup) -> Self {
        let part = setup.subject.mesh();
        Self::of_mesh(setup, part)
    }

    /// Like [`Self::new`], with this surface in place of the subject's: around its middle, x right, y down, and z away from who
    /// looks at it.
    pub fn of_mesh(setup: ScanSetup, part: TriangleMesh) -> Self {
        // The model faces a camera with x right, y down and z away; the part faces back along the base's x axis.
        let axes = Matrix3::new(0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0);
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
        let [x, y, z] = MIDDLE_M;
        Self {
            part,
            cell: cell(),
            setup,
            base_from_model: Isometry3::from_parts(Translation3::new(x, y, z), turn),
        }
    }

    /// Returns the part's surface in its own coordinates.
    pub fn part(&self) -> &TriangleMesh {
        &self.part
    }

    /// Takes all frames, with the part at its own pose.
    pub fn shots(&self) -> Vec<SimulatedShot> {
        let all = (0..self.setup.num_shots).map(|k| self.shot(k, &self.base_from_model));
        all.collect()
    }

    /// Takes frame `k` with the part at the given pose.
    pub fn shot(&self, k: usize, base_from_model: &RigidTransform) -> SimulatedShot {
        let setup = &self.setup;
        let seed = setup.seed.wrapping_mul(1000).wrapping_add(k as u64);
        let mut random = Pcg64::seed_from_u64(seed ^ STREAM);
        let base_from_camera = self.camera(k, &mut random);
        let noise = SensorNoise {
            multiplier: setup.noise,
            seed,
        };
        let frame = self.frame(&base_from_camera, base_from_model, &noise);
        let turn = UnitQuaternion::from_axis_angle(&direction(&mut random), setup.turn_error.0);
        let shift = direction(&mut random).into_inner() * setup.place_error.0;
        SimulatedShot {
            frame,
            base_from_camera,
            given: Isometry3::from_parts(
                Translation3::from(base_from_camera.translation.vector + shift),
                turn * base_from_camera.rotation,
            ),
        }
    }

    /// Takes a frame with camera and part at these poses.
    pub fn frame(
        &self,
        base_from_camera: &RigidTransform,
        base_from_model: &RigidTransform,
        noise: &SensorNoise,
    ) -> DepthFrame {
        let camera_from_base = base_from_camera.inverse();
        let mut rendering = Rendering::new(Intrinsics::KINECT);
        let part = camera_from_base * base_from_model;
        rendering.draw_mesh(&self.part, &part, SurfaceLabel::Part);
        rendering.draw_mesh(&self.cell, &camera_from_base, SurfaceLabel::Clutter);
        Kinect.sense(&rendering, noise)
    }

    /// Poses the camera: from left to right around the part, alternately from above and below, 1.2 to 1.5 m away.
    fn camera(&self, k: usize, random: &mut Pcg64) -> RigidTransform {
        let mut jitter = |range: f64| range * (2.0 * random.random::<f64>() - 1.0);
        let along = k as f64 / (self.setup.num_shots.max(2) - 1) as f64;
        let yaw = f64::to_radians(-35.0 + 70.0 * along + jitter(4.0));
        let up = if k.is_multiple_of(2) { 25.0 } else { -8.0 };
        let pitch = f64::to_radians(up + jitter(4.0));
        let distance = 1.35 + jitter(0.15);
        let target = Point3::from(MIDDLE_M) + Vector3::new(0.0, jitter(0.1), jitter(0.1));
        let back = Vector3::new(
            -yaw.cos() * pitch.cos(),
            yaw.sin() * pitch.cos(),
            pitch.sin(),
        );
        let place = target + back * distance;
        let forward = -back;
        let down = -Vector3::z();
        let down = (down - forward * forward.dot(&down)).normalize();
        let axes = Matrix3::from_columns(&[down.cross(&forward), down, forward]);
        let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
        Isometry3::from_parts(Translation3::from(place.coords), turn)
    }
}

/// Draws a direction uniformly from the sphere.
fn direction(random: &mut Pcg64) -> Unit<Vector3<f64>> {
    let z = 2.0 * random.random::<f64>() - 1.0;
    let turn = std::f64::consts::TAU * random.random::<f64>();
    let r = (1.0 - z * z).sqrt();
    Unit::new_normalize(Vector3::new(r * turn.cos(), r * turn.sin(), z))
}

/// Builds floor, two walls and three boxes in the base frame.
fn cell() -> TriangleMesh {
    let mut cell = Assembly::default();
    let mut face = |corner: [f64; 3], along: [f64; 3], up: [f64; 3]| {
        let corner = Point3::from(corner);
        let (along, up) = (Vector3::from(along), Vector3::from(up));
        let corners = [corner, corner + along, corner + along + up, corner + up];
        let corners = corners.map(|p| cell.vertex(p));
        cell.quad(corners);
    };
    face([-8.0, -8.0, 0.0], [16.0, 0.0, 0.0], [0.0, 16.0, 0.0]);
    face([2.9, -8.0, 0.0], [0.0, 16.0, 0.0], [0.0, 0.0, 5.0]);
    face([-8.0, 2.2, 0.0], [16.0, 0.0, 0.0], [0.0, 0.0, 5.0]);
    for ([x, y], [length, width, height]) in [
        ([2.2, 0.8], [0.5, 0.6, 0.6]),
        ([2.4, -1.5], [0.4, 0.5, 0.7]),
        ([1.7, -0.8], [0.5, 0.4, 0.35]),
    ] {
        face([x, y, 0.0], [0.0, width, 0.0], [0.0, 0.0, height]);
        face([x + length, y, 0.0], [0.0, width, 0.0], [0.0, 0.0, height]);
        face([x, y, 0.0], [length, 0.0, 0.0], [0.0, 0.0, height]);
        face([x, y + width, 0.0], [length, 0.0, 0.0], [0.0, 0.0, height]);
        face([x, y, height], [length, 0.0, 0.0], [0.0, width, 0.0]);
    }
    cell.into_mesh()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PartKind, Side};
    use geometry::rigid::pose_error;

    #[test]
    fn the_camera_looks_at_the_part_and_the_robot_errs_by_what_was_asked_for() {
        let scan = SimulatedScan::new(ScanSetup {
            subject: SimulatedObject::Part {
                kind: PartKind::Fender,
                side: Side::Left,
                model_seed: 0,
            },
            num_shots: 3,
            place_error: Metres::from_mm(3.0),
            turn_error: Radians::from_degrees(0.3),
            noise: 0.0,
            seed: 4,
        });
        let shots = scan.shots();
        assert_eq!(shots, scan.shots(), "the same seed gives the same frames");
        for shot in &shots {
            let error = pose_error(&shot.given, &shot.base_from_camera, &Point3::origin());
            assert!((error.shift.mm() - 3.0).abs() < 1e-6);
            assert!((error.rotation.degrees() - 0.3).abs() < 1e-6);
            let middle = shot.base_from_camera.inverse() * Point3::from(MIDDLE_M);
            assert!((1.0..1.7).contains(&middle.z), "{middle}");
            // Floor and walls fill the rest of the picture.
            let num_readings = shot.frame.depth.iter().filter(|d| **d > 0).count();
            assert!(num_readings as f64 > 0.95 * shot.frame.depth.len() as f64);
        }
    }
}
