//! What tests of this crate and of those above it build.

use std::{path::Path, sync::Arc};

use files::save_cloud;
use geometry::{cloud::PointCloud, fixtures::small_frame, rigid::RigidTransform, units::Metres};
use nalgebra::{Point3, Vector3};
use simulate::{CellSetup, PartKind, PartPose, PoseRange, SensorNoise, Side, frame};

use crate::{
    pose::{Axis, CloudRole, FreeMotion, PoseError},
    reference::{Coverage, Reference, ReferenceParams},
    scene::{SceneCloud, scene_from_frame},
};

/// The scene of a simulated frame.
pub fn scene_of(setup: &CellSetup) -> SceneCloud {
    scene_from_frame(&frame(setup).frame)
}

/// The scene of a part that faces the camera.
pub fn facing_part(kind: PartKind, side: Side, seed: u64) -> SceneCloud {
    let mut setup = CellSetup::with_part(kind, side, 0, seed);
    setup.pose = PartPose::Drawn(PoseRange::facing());
    scene_of(&setup)
}

/// Writes the view of a still fender from a camera moved back by `back` metres, with the noise of this seed.
pub fn save_fender_view(path: &Path, noise: u64, back: f64) {
    let mut setup = CellSetup::with_part(PartKind::Fender, Side::Left, 0, 4);
    let standing = frame(&setup).truth.camera_from_part;
    setup.pose = PartPose::Fixed(RigidTransform::translation(0.0, 0.0, back) * standing);
    setup.wall = Metres(setup.wall.0 + back);
    setup.noise = SensorNoise::kinect(noise);
    save_cloud(path, &scene_of(&setup).cloud).expect("written");
}

/// A plate of 0.8 by 0.48 m, square to the camera at a distance of 1.2 m.
pub fn plate() -> Reference {
    let points: Vec<Point3<f32>> = (0..101 * 61)
        .map(|i| {
            let (column, row) = ((i % 101) as f32, (i / 101) as f32);
            Point3::new(column * 0.008 - 0.4, row * 0.008 - 0.24, 1.2)
        })
        .collect();
    let cloud = PointCloud {
        normals: Some(vec![-Vector3::z(); points.len()]),
        points,
        ..PointCloud::default()
    };
    let params = ReferenceParams::default();
    Reference::prepare("plate", cloud, Coverage::OneSide, &params).expect("an outline")
}

/// A scene small enough to be written many times, different for every seed.
pub fn small_scene(seed: u16) -> Arc<SceneCloud> {
    let depth = (0..32 * 24_u32).map(|i| (900 + (i * 7 + u32::from(seed) * 13) % 400) as u16);
    Arc::new(scene_from_frame(&small_frame(32, depth)))
}

/// All free motions of a pose.
pub const FREEDOMS: [FreeMotion; 7] = [
    FreeMotion::Slide(Axis::Long),
    FreeMotion::Slide(Axis::Short),
    FreeMotion::Slide(Axis::Normal),
    FreeMotion::Turn(Axis::Long),
    FreeMotion::Turn(Axis::Short),
    FreeMotion::Turn(Axis::Normal),
    FreeMotion::Anyhow,
];

/// Every kind of pose error.
pub fn pose_errors() -> Vec<PoseError> {
    let [found, needed] = [3, 12];
    let which = CloudRole::Source;
    vec![
        PoseError::TooFewPoints {
            which: CloudRole::Target,
            found,
            needed,
        },
        PoseError::Degenerate {
            which,
            width: 0.000_125,
        },
        PoseError::OneSidedPairs {
            num_pairs: 40,
            rms: Metres(0.0123),
        },
        PoseError::NoOverlap {
            found,
            needed,
            reach: Metres(0.05),
        },
        PoseError::SizesDiffer { ratio: 999.6 },
        PoseError::TooFarOut {
            which,
            distance: Metres(123_456.7),
        },
        PoseError::NoReferenceCloud,
        PoseError::Cancelled,
    ]
}
