//! What hangs in a simulated cell: a simulated part, or the surface of one that a camera has seen.

use std::sync::Arc;

use nalgebra::{Point3, center};
use rand::{Rng, RngExt as _};

use super::Disturbance;
use geometry::{
    mesh::TriangleMesh,
    rigid::RigidTransform,
    units::{Metres, Radians},
};
use inspection::library::{enrolled_name, enrolment_pose};
use simulate::{PartKind, ScanSetup, Side, SimulatedObject, SimulatedScan};

/// What hangs in a simulated cell.
#[derive(Clone, Debug, PartialEq)]
pub enum CellPart {
    /// A simulated part; of two sides the left one.
    Simulated(PartKind),
    /// The surface of a part that a camera has seen.
    Scanned(Arc<ScannedPart>),
}

/// The surface of a part that a camera has seen.
#[derive(Clone, Debug, PartialEq)]
pub struct ScannedPart {
    /// Name of its reference.
    reference: String,
    /// Around its middle, with the axes of the part.
    mesh: TriangleMesh,
    middle: Point3<f64>,
}

impl ScannedPart {
    /// The part of this reference, from its surface in part space; `None` if that has no points.
    pub fn new(reference: String, mut surface: TriangleMesh) -> Option<Self> {
        let (low, high) = surface.bounds()?;
        let middle = center(&low, &high);
        for vertex in &mut surface.vertices {
            *vertex -= middle.coords;
        }
        Some(Self {
            reference,
            mesh: surface,
            middle: middle.cast(),
        })
    }

    fn mirrored(&self) -> TriangleMesh {
        let mut mesh = self.mesh.clone();
        for vertex in &mut mesh.vertices {
            vertex.x = -vertex.x;
        }
        for triangle in &mut mesh.triangles {
            triangle.swap(1, 2);
        }
        mesh
    }
}

impl CellPart {
    /// Name of its reference.
    pub fn name(&self) -> String {
        match self {
            Self::Simulated(kind) => enrolled_name(*kind, Side::Left),
            Self::Scanned(part) => part.reference.clone(),
        }
    }

    /// The model of the simulated cell in part space.
    pub(super) fn part_from_model(&self) -> RigidTransform {
        match self {
            Self::Simulated(_) => enrolment_pose(),
            Self::Scanned(part) => {
                let middle = &part.middle;
                RigidTransform::translation(middle.x, middle.y, middle.z)
            }
        }
    }

    pub(super) fn scan(&self, seed: u64) -> SimulatedScan {
        match self {
            Self::Simulated(kind) => scan_of(*kind, Side::Left, seed),
            Self::Scanned(part) => scan_of_mesh(part.mesh.clone(), seed),
        }
    }

    /// What hangs there after something went wrong, if it is something else.
    pub(super) fn exchanged(
        &self,
        by: Disturbance,
        seed: u64,
        random: &mut impl Rng,
    ) -> Option<SimulatedScan> {
        let others = PartKind::ALL.into_iter();
        let others = others.filter(|kind| *self != Self::Simulated(*kind));
        let others: Vec<PartKind> = others.collect();
        let other = others[random.random_range(0..others.len())];
        match by {
            Disturbance::Mirrored => Some(match self {
                Self::Simulated(kind) if kind.is_sided() => scan_of(*kind, Side::Right, seed),
                Self::Simulated(_) => scan_of(other, Side::Left, seed),
                Self::Scanned(part) => scan_of_mesh(part.mirrored(), seed),
            }),
            Disturbance::Exchanged => Some(scan_of(other, Side::Left, seed)),
            Disturbance::None
            | Disturbance::Removed
            | Disturbance::Pushed
            | Disturbance::Covered
            | Disturbance::FramesLost
            | Disturbance::ClockJump => None,
        }
    }
}

fn scan_of(kind: PartKind, side: Side, seed: u64) -> SimulatedScan {
    let part = SimulatedObject::Part {
        kind,
        side,
        model_seed: 0,
    };
    SimulatedScan::new(setup(part, seed))
}

fn scan_of_mesh(mesh: TriangleMesh, seed: u64) -> SimulatedScan {
    SimulatedScan::of_mesh(setup(SimulatedObject::Nothing, seed), mesh)
}

fn setup(subject: SimulatedObject, seed: u64) -> ScanSetup {
    ScanSetup {
        subject,
        num_shots: 1,
        place_error: Metres(0.0),
        turn_error: Radians(0.0),
        noise: 1.0,
        seed,
    }
}
