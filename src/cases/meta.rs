//! What is written down of a case.

use jiff::Timestamp;
use serde::{Deserialize, Deserializer, Serialize};

use super::judge::{FoundVerdict, Truth};
use crate::{
    geometry::{depth_frame::Intrinsics, rigid::RigidTransform, sixteen_numbers},
    history::FrameRecord,
    stages::scene::PictureEdge,
};

/// The version of the format that is written; newer ones are refused. The first held every scene as a cloud, this one as
/// the history does.
pub const SCHEMA_VERSION: u32 = 2;

/// What a person and an inspection say of a case that is to be kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseDescription {
    /// Where the scene came from, for people.
    pub origin: String,
    /// True if no camera was read.
    pub simulated: bool,
    /// When it was kept.
    pub kept_at: Timestamp,
    /// A remark for people; may be empty.
    #[serde(default)]
    pub remark: String,
    /// How hard it is, in free words such as `placed` or `hard`; cases with the same words are counted together.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub difficulty: Option<String>,
    /// What it truly is.
    pub truth: Truth,
    /// What was found when it was kept.
    pub found: FoundVerdict,
    /// Where the part truly is, if it is known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pose: Option<TruePose>,
}

/// Where the part truly is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TruePose {
    /// Maps a point of the enrolled part to where it is in the scene; 16 numbers row after row, metres.
    #[serde(with = "sixteen_numbers")]
    pub camera_from_part: RigidTransform,
    /// The checksum of the enrolled part's cloud, as its `part.toml` has it: enrolled from another capture it has
    /// other coordinates, and the pose says nothing of it. Without one it is taken to be of whatever is enrolled.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cloud_crc32: Option<String>,
}

/// `case.toml`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseMeta {
    /// [`SCHEMA_VERSION`] when written.
    pub schema_version: u32,
    /// What is said of it.
    #[serde(flatten)]
    pub about: CaseDescription,
    /// Its scene's file, and what that alone does not tell.
    #[serde(deserialize_with = "scene_of_any_version")]
    pub scene: FrameRecord,
}

/// The scene of a case of the first version: `scene.pcd`, and `empty-cell.pcd` if it has a checksum.
#[derive(Deserialize)]
struct FirstScene {
    bytes: u64,
    crc32: u32,
    picture_edge: PictureEdge,
    camera: Option<Intrinsics>,
    empty_cell_crc32: Option<u32>,
}

impl From<FirstScene> for FrameRecord {
    fn from(first: FirstScene) -> Self {
        Self {
            file: "scene.pcd".into(),
            bytes: first.bytes,
            crc32: first.crc32,
            edge: first.picture_edge,
            camera: first.camera,
            metres_per_unit: None,
            block_side: None,
            is_simulated: false,
            empty_cell: first.empty_cell_crc32.map(|_| "empty-cell.pcd".into()),
            empty_cell_crc32: first.empty_cell_crc32,
            shots: Vec::new(),
        }
    }
}

fn scene_of_any_version<'de, D: Deserializer<'de>>(written: D) -> Result<FrameRecord, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Scene {
        Now(FrameRecord),
        First(FirstScene),
    }
    Ok(match Scene::deserialize(written)? {
        Scene::Now(scene) => scene,
        Scene::First(scene) => scene.into(),
    })
}
