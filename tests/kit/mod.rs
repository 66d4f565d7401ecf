//! What several tests build: scenes, frames, clouds, libraries, inspections of a history.
//!
//! One file for the unit tests (`crate::kit`) and for those of this folder.

#![allow(dead_code, reason = "every test program uses some of it")]

use std::{path::Path, sync::Arc};

use image::RgbImage;
use jiff::{SignedDuration, Timestamp};
use nalgebra::{Point3, Vector3};
use partsight::{
    geometry::{
        cloud::PointCloud,
        depth_frame::{DepthFrame, Intrinsics},
        mesh::TriangleMesh,
        rigid::{RigidTransform, from_euler_zyx, row_major},
    },
    history::{
        History, HungId, InspectionDetail, NewEntry, Record, StoredVerdict, Summary, Traceability,
    },
    library::{Library, LibraryFolder},
    pipeline::{Recipe, RecipeLabel},
    simulate::{CellSetup, PartKind, PartPose, PoseRange, SensorNoise, Side, frame, frame_of_mesh},
    stages::{
        reference::{Coverage, Reference, ReferenceParams},
        scene::{SceneCloud, scene_from_frame},
    },
};
use proptest::prelude::*;

/// The eight parts that the program brings along.
pub(crate) fn shipped_library() -> Library {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference_parts");
    let folder = LibraryFolder::open(&path).expect("the shipped parts");
    let load = folder.load(&ReferenceParams::default()).expect("loaded");
    load.library
}

/// The scene that a simulated camera captures.
pub(crate) fn scene_of(setup: &CellSetup) -> SceneCloud {
    scene_from_frame(&frame(setup).frame)
}

/// A part before the camera and square to it.
pub(crate) fn facing_part(kind: PartKind, side: Side, seed: u64) -> SceneCloud {
    let mut setup = CellSetup::with_part(kind, side, 0, seed);
    setup.pose = PartPose::Drawn(PoseRange::facing());
    scene_of(&setup)
}

/// A left part before the camera that moves away from where its seed puts it.
pub(crate) struct HangingPart {
    pub(crate) setup: CellSetup,
    mesh: TriangleMesh,
    rest_pose: RigidTransform,
}

impl HangingPart {
    pub(crate) fn new(kind: PartKind, seed: u64) -> Self {
        let setup = CellSetup::with_part(kind, Side::Left, 0, seed);
        let mesh = setup.subject.mesh();
        let placed = PoseRange::facing().draw(&mesh, &setup.intrinsics, seed);
        Self {
            setup,
            mesh,
            rest_pose: placed.camera_from_part,
        }
    }

    /// A frame of the part, moved by this from its rest.
    pub(crate) fn frame(&self, noise: SensorNoise, moved: &RigidTransform) -> DepthFrame {
        let mut setup = self.setup;
        setup.pose = PartPose::Fixed(moved * self.rest_pose);
        setup.noise = noise;
        frame_of_mesh(&setup, &self.mesh).frame
    }
}

/// A captured frame so small that it can be written down; depths in millimetres.
pub(crate) fn small_frame(width: usize, depth: impl IntoIterator<Item = u16>) -> DepthFrame {
    let depth: Vec<u16> = depth.into_iter().collect();
    DepthFrame {
        intrinsics: Intrinsics {
            width,
            height: depth.len() / width,
            ..Intrinsics::KINECT
        },
        metres_per_unit: 0.001,
        depth,
        is_simulated: false,
    }
}

/// A plate of 0.8 by 0.48 m, square on, 1.2 m before the camera.
pub(crate) fn plate() -> Reference {
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

/// The cloud's points after this movement.
pub(crate) fn moved(cloud: &PointCloud, by: &RigidTransform) -> PointCloud {
    PointCloud::from_points(cloud.points.iter().map(|p| (by * p.cast::<f64>()).cast()))
}

/// A point at most 1 m from the origin along each axis.
pub(crate) fn any_point() -> impl Strategy<Value = Point3<f32>> {
    prop::array::uniform3(-1.0_f32..1.0).prop_map(Point3::from)
}

/// A moment, counted in seconds from the first.
pub(crate) fn moment(seconds: i64) -> Timestamp {
    let first: Timestamp = "2026-03-01T06:00:00Z".parse().expect("a time");
    first + SignedDuration::from_secs(seconds)
}

/// A scene small enough to be written many times, another for every seed.
pub(crate) fn small_scene(seed: u16) -> Arc<SceneCloud> {
    let depth = (0..32 * 24_u32).map(|i| (900 + (i * 7 + u32::from(seed) * 13) % 400) as u16);
    Arc::new(scene_from_frame(&small_frame(32, depth)))
}

/// An inspection of that moment, as it is handed to a history.
pub(crate) fn history_entry(seconds: i64, verdict: StoredVerdict, part: &str) -> NewEntry {
    let is_named = matches!(
        verdict,
        StoredVerdict::Accepted | StoredVerdict::NotAccepted
    );
    let recipe = Recipe::default();
    let camera_from_part = from_euler_zyx([0.1, 0.2, 0.3, 0.01, 0.02, 1.4]);
    let line = format!(
        r#"{{"schema":1,"pose":{{"reference":"{part}","camera_from_part":{:?},"rms_m":{}}},"timings_ms":{{"pose":20.5,"total":31.5,"segment":8.0}}}}"#,
        row_major(&camera_from_part),
        0.001 + 1e-4 * seconds as f64,
    );
    NewEntry {
        record: Record {
            summary: Summary {
                number: 0,
                at: moment(seconds),
                scene: format!("frame {seconds}"),
                source: "simulated".into(),
                is_simulated: true,
                verdict,
                part: is_named.then(|| part.to_owned()),
                title: part.replace('_', " "),
                score: (verdict != StoredVerdict::NoPart).then_some([0.97, 0.25]),
                total_ms: 31.5,
                remark: String::new(),
                label: None,
                frame_bytes: None,
                trace: Traceability::default(),
                hung: HungId::new(),
                parent: None,
                num_below: 0,
            },
            detail: InspectionDetail {
                nearest: Some(part.to_owned()),
                complaint: Some(["too low".into(), "look again".into()])
                    .filter(|_| verdict != StoredVerdict::Accepted),
                camera_from_part: Some(camera_from_part),
                recipe_label: Some(RecipeLabel::default()),
                recipe_identity: recipe.identity(),
                recipe: Some(Arc::new(recipe)),
                library_identity: "0badcafe".into(),
                program: "0.1.0".into(),
                line,
                thumbnail: Vec::new(),
                origin: Some("{}".into()),
                frame: None,
            },
        },
        picture: Some(RgbImage::from_pixel(16, 12, image::Rgb([200, 150, 40]))),
        scene: Some(small_scene(seconds as u16)),
        shots: Vec::new(),
    }
}

/// The history in this folder, which is sound.
pub(crate) fn open_history(folder: &Path) -> History {
    let opened = History::open(folder).expect("opened");
    assert_eq!(opened.set_aside, None);
    opened.history
}

/// A history in a new folder.
pub(crate) fn new_history() -> (tempfile::TempDir, History) {
    let folder = tempfile::tempdir().expect("a folder");
    let history = open_history(folder.path());
    (folder, history)
}
