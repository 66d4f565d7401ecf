//! What tests of this crate and of those above it build.

use geometry::{depth_frame::DepthFrame, mesh::TriangleMesh, rigid::RigidTransform};

use crate::{CellSetup, PartKind, PartPose, PoseRange, SensorNoise, Side, frame_of_mesh};

/// A left part in front of the camera, which moves from the rest pose that its seed draws.
pub struct HangingPart {
    pub setup: CellSetup,
    mesh: TriangleMesh,
    rest_pose: RigidTransform,
}

impl HangingPart {
    pub fn new(kind: PartKind, seed: u64) -> Self {
        let setup = CellSetup::with_part(kind, Side::Left, 0, seed);
        let mesh = setup.subject.mesh();
        let placed = PoseRange::facing().draw(&mesh, &setup.intrinsics, seed);
        Self {
            setup,
            mesh,
            rest_pose: placed.camera_from_part,
        }
    }

    /// A frame of the part, moved by this from its rest pose.
    pub fn frame(&self, noise: SensorNoise, moved: &RigidTransform) -> DepthFrame {
        let mut setup = self.setup;
        setup.pose = PartPose::Fixed(moved * self.rest_pose);
        setup.noise = noise;
        frame_of_mesh(&setup, &self.mesh).frame
    }
}
