//! `case.toml`: the description of a case, and the record of its scene.

use jiff::Timestamp;
use nalgebra::Vector3;
use serde::{Deserialize, Deserializer, Serialize};

use super::judge::{FoundVerdict, Truth};
use crate::history::{FrameRecord, Record, index_of_part};
use geometry::{depth_frame::Intrinsics, rigid::RigidTransform, sixteen_numbers};
use inspection::{
    library::Library,
    pipeline::{self, Cancelled, Inspection, ProgressObserver, Recipe},
};
use stages::{
    scene::{PictureEdge, SceneCloud},
    segment::MAX_PARTS,
};

/// The schema that is written; newer ones are refused. Schema 1 stored every scene as a cloud; schema 2 stores scenes as the
/// history stores frames.
pub const SCHEMA_VERSION: u32 = 2;

/// Description of a scene: its origin, its true label, and the verdict of an inspection.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseDescription {
    /// Name of the scene; the folder is named after it.
    pub origin: String,
    /// True if the scene is simulated.
    pub simulated: bool,
    /// When the case was kept; in an export of the history, when the scene was inspected.
    pub kept_at: Timestamp,
    /// Free text; may be empty.
    #[serde(default)]
    pub remark: String,
    /// Free text such as `placed` or `hard`; cases with the same text are counted together.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub difficulty: Option<String>,
    /// The true label.
    pub truth: Truth,
    /// The verdict by the recipe with which the scene was inspected.
    pub found: FoundVerdict,
    /// The true pose, if known.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pose: Option<TruePose>,
    /// Which part of the scene the case is about, if several may hang there.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub one_of_several: Option<OneOfSeveral>,
}

impl CaseDescription {
    /// Describes an inspection with its true label, whether the history stores it or not.
    pub fn of(record: &Record, truth: Truth) -> Self {
        let summary = &record.summary;
        Self {
            origin: summary.scene.to_string(),
            simulated: summary.is_simulated,
            kept_at: summary.at,
            remark: summary.remark.clone(),
            difficulty: None,
            truth,
            found: FoundVerdict::from(record),
            pose: None,
            one_of_several: (record.detail.recipe.as_deref())
                .and_then(|recipe| OneOfSeveral::of(recipe, record.detail.camera_from_part)),
        }
    }
}

/// A part of a scene in which several may hang.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OneOfSeveral {
    /// Number of parts that were looked for.
    pub max_parts: usize,
    /// The origin of the part at the pose that was found, camera space, metres; `None` without a pose.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_m: Option<[f64; 3]>,
}

impl OneOfSeveral {
    /// Describes the part of an inspection with this recipe; `None` if that looks for one part.
    pub fn of(recipe: &Recipe, camera_from_part: Option<RigidTransform>) -> Option<Self> {
        let max_parts = recipe.max_parts();
        (max_parts > 1).then(|| Self {
            max_parts,
            at_m: camera_from_part.map(|pose| pose.translation.vector.into()),
        })
    }
}

/// Inspects the part that a case is about: of several, the one of this name at this place, as
/// [`InspectionSummary::index_in`](crate::history::InspectionSummary::index_in) finds it.
pub fn inspect_case(
    scene: &SceneCloud,
    one_of_several: Option<&OneOfSeveral>,
    name: Option<&str>,
    library: &Library,
    recipe: &Recipe,
    watch: &dyn ProgressObserver,
) -> Result<Inspection, Cancelled> {
    let Some(one) = one_of_several else {
        return pipeline::run(scene, library, recipe, watch);
    };
    let mut recipe = recipe.clone();
    let max_parts = &mut recipe.segment.max_parts;
    *max_parts = (*max_parts).max(one.max_parts.min(MAX_PARTS));
    let mut found = pipeline::run_all(scene, library, &recipe, watch)?;
    let index = index_of_part(name, one.at_m.map(Vector3::from), found.iter());
    Ok(found.swap_remove(index))
}

/// The true pose of a part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TruePose {
    /// 16 numbers in row-major order, in metres.
    #[serde(with = "sixteen_numbers")]
    pub camera_from_part: RigidTransform,
    /// Checksum of the enrolled part's cloud, as in its `part.toml`. A part enrolled from another capture has other
    /// coordinates, for which this pose is meaningless. Without a checksum the pose holds for any enrolled cloud.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cloud_crc32: Option<String>,
}

/// The content of `case.toml`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CaseMeta {
    /// The schema of the file; [`SCHEMA_VERSION`] when written.
    pub schema_version: u32,
    /// Origin, true label and verdict.
    #[serde(flatten)]
    pub about: CaseDescription,
    /// The file of the scene, and properties that the file itself does not hold.
    #[serde(deserialize_with = "scene_of_any_version")]
    pub scene: FrameRecord,
}

/// The scene in schema 1: `scene.pcd`, and `empty-cell.pcd` if its checksum is given.
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
            is_only_recent: false,
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
