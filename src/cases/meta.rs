//! What is written down of a case.

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::judge::{Found, Truth};
use crate::{capture::frame::Intrinsics, stages::scene::PictureEdge};

/// The version of the format that is written; newer ones are refused.
pub const SCHEMA_VERSION: u32 = 1;

/// What a person and an inspection say of a case that is to be kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseAbout {
    /// Where the scene came from, for people.
    pub origin: String,
    /// True if no camera was read.
    pub simulated: bool,
    /// When it was kept.
    pub kept_at: Timestamp,
    /// A remark for people; may be empty.
    #[serde(default)]
    pub remark: String,
    /// What it truly is.
    pub truth: Truth,
    /// What was found when it was kept.
    pub found: Found,
}

/// `case.toml`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseMeta {
    /// [`SCHEMA_VERSION`] when written.
    pub schema_version: u32,
    /// What is said of it.
    #[serde(flatten)]
    pub about: CaseAbout,
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
