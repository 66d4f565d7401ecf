//! The input of enrolling: a captured scene, a cloud, a mesh or a scan, cut into segments that are kept or dropped.

use std::{path::Path, sync::Arc};

use serde::{Deserialize, Serialize};

use super::{
    picture_plane::PicturePlane,
    scanned::ScannedMatter,
    segments::{PointAction, SegmentKind, SegmentTitle, Segments},
};
use capture::CaptureError;
use files::{self, FileContent, FileWarning};
use geometry::{cloud::PointCloud, mesh::TriangleMesh};
use inspection::library::{EnrolError, EnrolParams};
use shell::inspection::{
    camera::Camera,
    scan::FusedShots,
    source::{Origin, SceneError, SceneSource},
};
use stages::scene::{SceneCloud, scene_from_cloud, scene_from_frame};
use ui::language::text;

/// The points selected before any correction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InitialSelection {
    /// The part segmented from the background.
    Segmented,
    /// Everything.
    Whole,
}

impl InitialSelection {
    /// Both, in the order of the buttons.
    pub const ALL: [Self; 2] = [Self::Segmented, Self::Whole];

    /// Name for a person.
    pub fn title(self) -> String {
        match self {
            Self::Segmented => text!("enrol-in-front"),
            Self::Whole => text!("enrol-everything"),
        }
    }
}

/// The input that a part is enrolled from. All lists of points have the same order.
#[derive(Debug)]
pub struct EnrolInput {
    /// Where it came from.
    pub origin: Origin,
    /// Warnings about the file.
    pub warnings: Vec<FileWarning>,
    /// The input itself.
    pub matter: EnrolInputKind,
    /// The default selection.
    pub usual: InitialSelection,
    /// Segments with background removal; `None` for a mesh.
    pub segmented: Option<Segments>,
    /// Segments of everything.
    pub whole: Segments,
    /// Mapping of the points to the picture.
    pub picture: PicturePlane,
    /// The points as a 3-D view takes them.
    pub positions: Arc<[[f32; 3]]>,
}

/// Kind of an input.
#[derive(Debug)]
pub enum EnrolInputKind {
    /// A scene or cloud.
    Scene(Arc<SceneCloud>),
    /// A surface, and points sampled on it for display.
    Mesh(Arc<TriangleMesh>, Arc<PointCloud>),
    /// Several shots, fused.
    Scan(Box<ScannedMatter>),
}

impl EnrolInput {
    /// Reads the input and segments it.
    pub(super) fn read(
        source: &SceneSource,
        params: &EnrolParams,
        camera: &Camera,
        is_cancelled: &dyn Fn() -> bool,
    ) -> Result<Result<Self, EnrolError>, SceneError> {
        let SceneSource::File(path) = source else {
            let captured = source.take(camera, is_cancelled)?;
            let usual = InitialSelection::Segmented;
            let (scene, origin) = (captured.scene, captured.origin);
            return Ok(Ok(Self::of_scene(scene, origin, usual, params)));
        };
        let content = files::open(path).map_err(CaptureError::from)?;
        Ok(Self::of_file(content, path, params))
    }

    /// Segments the content of a file.
    pub(super) fn of_file(
        content: FileContent,
        path: &Path,
        params: &EnrolParams,
    ) -> Result<Self, EnrolError> {
        let warnings = content.warnings();
        let origin = Origin::File {
            path: path.to_owned(),
            is_simulated: content.is_simulated(),
        };
        let read = match content {
            FileContent::Mesh(mesh) => Self::of_mesh(mesh, origin, params),
            FileContent::Depth(frame) => {
                let scene = Arc::new(scene_from_frame(&frame));
                Ok(Self::of_scene(
                    scene,
                    origin,
                    InitialSelection::Segmented,
                    params,
                ))
            }
            FileContent::Cloud(cloud) => {
                // As on the command line, only an organised cloud is taken as a scene.
                let (usual, scene) = match cloud.grid {
                    Some(_) => (InitialSelection::Segmented, scene_from_cloud(cloud)),
                    // Keep every point; projecting the cloud into a picture would drop some.
                    None => (InitialSelection::Whole, SceneCloud::new(cloud, None)),
                };
                Ok(Self::of_scene(Arc::new(scene), origin, usual, params))
            }
        };
        read.map(|subject| Self {
            warnings,
            ..subject
        })
    }

    fn of_scene(
        scene: Arc<SceneCloud>,
        origin: Origin,
        usual: InitialSelection,
        params: &EnrolParams,
    ) -> Self {
        let positions = scene.cloud.points.iter().map(|p| [p.x, p.y, p.z]);
        Self {
            origin,
            warnings: Vec::new(),
            usual,
            segmented: Some(Segments::before_background(&scene, &params.segment)),
            whole: Segments::all_of(&scene, &params.segment),
            picture: PicturePlane::of(&scene.cloud),
            positions: positions.collect(),
            matter: EnrolInputKind::Scene(scene),
        }
    }

    fn of_mesh(
        mesh: TriangleMesh,
        origin: Origin,
        params: &EnrolParams,
    ) -> Result<Self, EnrolError> {
        let no_area = EnrolError::NoArea {
            num_triangles: mesh.triangles.len(),
        };
        let cloud = mesh.sample_evenly(params.max_points, 1).ok_or(no_area)?;
        let mut whole = Segments::of_num(cloud.points.len());
        let all: Vec<u32> = (0..cloud.points.len() as u32).collect();
        let title = SegmentTitle::Mesh;
        whole.add(SegmentKind::Surface, title, PointAction::Kept, &all);
        Ok(Self {
            origin,
            warnings: Vec::new(),
            usual: InitialSelection::Whole,
            segmented: None,
            whole,
            picture: PicturePlane::of(&cloud),
            positions: cloud.points.iter().map(|p| [p.x, p.y, p.z]).collect(),
            matter: EnrolInputKind::Mesh(Arc::new(mesh), Arc::new(cloud)),
        })
    }

    /// Makes the input of fused shots.
    pub(super) fn of_scan(fused: Arc<FusedShots>) -> Self {
        let matter = ScannedMatter::of(fused);
        let num_points = matter.cloud.points.len();
        let mut segments = Segments::of_num(num_points);
        let (part, rest) = (matter.voted(true), matter.voted(false));
        let title = SegmentTitle::Part;
        segments.add(SegmentKind::Surface, title, PointAction::Kept, &part);
        segments.add(
            SegmentKind::Plane(0),
            SegmentTitle::Cell,
            PointAction::Dropped,
            &rest,
        );
        let positions = matter.cloud.points.iter().map(|p| [p.x, p.y, p.z]);
        Self {
            origin: matter.fused.origin(),
            warnings: Vec::new(),
            usual: InitialSelection::Segmented,
            segmented: Some(segments),
            whole: Segments::of_num(num_points),
            picture: PicturePlane::of(&matter.cloud),
            positions: positions.collect(),
            matter: EnrolInputKind::Scan(Box::new(matter)),
        }
    }

    /// True if the selection is possible for this input.
    pub fn allows(&self, taking: InitialSelection) -> bool {
        match taking {
            InitialSelection::Whole => self.scan().is_none(),
            InitialSelection::Segmented => self.segmented.is_some(),
        }
    }

    /// The segments to which the selection refers.
    pub fn segments(&self, taking: InitialSelection) -> &Segments {
        match (taking, &self.segmented) {
            (InitialSelection::Segmented, Some(segmented)) => segmented,
            _ => &self.whole,
        }
    }

    /// The input's points.
    pub fn cloud(&self) -> &PointCloud {
        match &self.matter {
            EnrolInputKind::Scene(scene) => &scene.cloud,
            EnrolInputKind::Mesh(_, cloud) => cloud,
            EnrolInputKind::Scan(scan) => &scan.cloud,
        }
    }

    /// The scene, if the input is one.
    pub fn scene(&self) -> Option<&Arc<SceneCloud>> {
        match &self.matter {
            EnrolInputKind::Scene(scene) => Some(scene),
            EnrolInputKind::Mesh(..) | EnrolInputKind::Scan(_) => None,
        }
    }

    /// The fused shots, if the input is a scan.
    pub fn scan(&self) -> Option<&Arc<FusedShots>> {
        match &self.matter {
            EnrolInputKind::Scan(scan) => Some(&scan.fused),
            EnrolInputKind::Scene(_) | EnrolInputKind::Mesh(..) => None,
        }
    }

    /// False for a mesh, which is enrolled as a whole.
    pub fn can_be_corrected(&self) -> bool {
        !matches!(self.matter, EnrolInputKind::Mesh(..))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shell::inspection::source::CellChoice;
    use simulate::PartKind;

    fn captured() -> EnrolInput {
        let source = SceneSource::Cell {
            choice: CellChoice::Part(PartKind::Fender, simulate::Side::Left),
            number: 3,
        };
        let read = EnrolInput::read(
            &source,
            &EnrolParams::default(),
            &Camera::default(),
            &|| false,
        )
        .expect("a frame");
        read.expect("a subject")
    }

    #[test]
    fn every_reading_of_a_scene_is_in_one_segment() {
        let subject = captured();
        for taking in InitialSelection::ALL {
            let segments = subject.segments(taking);
            let in_lists: usize = segments.list.iter().map(|s| s.num_points).sum();
            assert_eq!(in_lists, subject.cloud().num_finite(), "{taking:?}");
            for (index, segment) in segments.list.iter().enumerate() {
                let of_it = segments.of_point.iter().filter(|of| **of == index as u16);
                assert_eq!(of_it.count(), segment.num_points, "{:?}", segment.title);
            }
        }
        let segmented = subject.segments(InitialSelection::Segmented);
        let kept = segmented
            .list
            .iter()
            .filter(|s| s.usual == PointAction::Kept);
        let kept: Vec<SegmentTitle> = kept.map(|s| s.title).collect();
        assert_eq!(kept, [SegmentTitle::Part]);
        assert!(
            segmented
                .list
                .iter()
                .any(|s| s.kind == SegmentKind::Plane(0))
        );
    }
}
