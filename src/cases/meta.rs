//! What is written down of a case.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::judge::{FoundVerdict, Truth};
use crate::{
    geometry::{depth_frame::Intrinsics, rigid::RigidTransform, sixteen_numbers},
    stages::scene::PictureEdge,
};

/// The version of the format that is written; newer ones are refused.
pub const SCHEMA_VERSION: u32 = 1;

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
    /// What the cloud alone does not tell of the scene.
    pub scene: SceneRecord,
}

/// What `scene.pcd` alone does not tell.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneRecord {
    /// Size of the file.
    pub bytes: u64,
    /// CRC-32 (IEEE 802.3) of the file.
    pub crc32: u32,
    /// What the edge of the picture is.
    pub picture_edge: Edge,
    /// The camera, if a pinhole camera explains the scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera: Option<Intrinsics>,
    /// CRC-32 of `empty-cell.pcd`, if the empty cell was known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub empty_cell_crc32: Option<u32>,
}

/// [`PictureEdge`], as it is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Edge {
    /// The camera's view ends there.
    View,
    /// The points end there.
    Points,
}

impl From<PictureEdge> for Edge {
    fn from(edge: PictureEdge) -> Self {
        match edge {
            PictureEdge::View => Self::View,
            PictureEdge::Points => Self::Points,
        }
    }
}

impl From<Edge> for PictureEdge {
    fn from(edge: Edge) -> Self {
        match edge {
            Edge::View => Self::View,
            Edge::Points => Self::Points,
        }
    }
}
