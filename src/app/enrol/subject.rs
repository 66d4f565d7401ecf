//! What a part is enrolled from: a captured scene, a whole cloud or a mesh, cut into segments that a person takes or
//! drops.

use std::sync::Arc;

use nalgebra::Point3;

use super::scanned::ScannedMatter;

use crate::{
    app::{
        camera::Camera,
        shots::FusedShots,
        source::{Origin, SceneError, SceneSource},
    },
    files::{self, FileContent, FileWarning},
    geometry::{
        cloud::{Grid, PointCloud, is_finite},
        mesh::TriangleMesh,
    },
    library::{EnrolError, EnrolParams},
    stages::{
        scene::{SceneCloud, scene_from_cloud, scene_from_frame},
        segment::{PointLabel, SegmentParams, pieces, segment, surfaces},
    },
};

/// Which of the points are the part before anything is corrected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InitialSelection {
    /// The part that stands before the background.
    Segmented,
    /// Everything.
    Whole,
}

impl InitialSelection {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Segmented, Self::Whole];

    /// What a person calls it.
    pub fn title(self) -> &'static str {
        match self {
            Self::Segmented => "Before the background",
            Self::Whole => "Everything",
        }
    }
}

/// What a part is enrolled from. Its points have the same places in every list.
#[derive(Debug)]
pub struct EnrolInput {
    /// Where it came from.
    pub origin: Origin,
    /// What was odd about the file.
    pub warnings: Vec<FileWarning>,
    /// What it is.
    pub matter: EnrolInputKind,
    /// How it is taken at first.
    pub usual: InitialSelection,
    /// The part and what lies about it; a mesh has none.
    pub segmented: Option<Segments>,
    /// The pieces of all of it.
    pub whole: Segments,
    /// Where its points lie in its picture.
    pub picture: PicturePlane,
    /// The points as a view takes them.
    pub positions: Arc<[[f32; 3]]>,
}

/// What a subject is.
#[derive(Debug)]
pub enum EnrolInputKind {
    /// Points.
    Scene(Arc<SceneCloud>),
    /// A surface, with points sampled on it to be looked at.
    Mesh(Arc<TriangleMesh>, Arc<PointCloud>),
    /// Several shots, put together.
    Scan(Box<ScannedMatter>),
}

/// How the points are cut into segments.
#[derive(Debug)]
pub struct Segments {
    /// The segments; what is likely to be wanted first.
    pub list: Vec<Segment>,
    /// For each point the place of its segment in the list, or [`Segments::NONE`].
    pub of_point: Vec<u16>,
}

/// Points that are taken or dropped together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Segment {
    /// What they are.
    pub kind: SegmentKind,
    /// What a person calls it.
    pub title: String,
    /// Its points.
    pub num_points: usize,
    /// What becomes of it unless a person says otherwise.
    pub usual: PointAction,
}

/// What a segment is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SegmentKind {
    /// A connected surface.
    Surface,
    /// A background plane, by its number.
    Plane(u8),
    /// Points too few to be a surface.
    Specks,
}

/// What becomes of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointAction {
    /// They are of the part.
    Kept,
    /// They are not.
    Dropped,
}

impl Segments {
    /// Of a point of no segment: the camera had no reading there.
    pub const NONE: u16 = u16::MAX;
    /// More surfaces than this are counted among the specks.
    const MAX_SURFACES: usize = 24;

    /// Of what stands before the background, the part first.
    fn before_background(scene: &SceneCloud, params: &SegmentParams) -> Self {
        let found = segment(scene, params);
        let mut all = Self::of_num(found.labels.len());
        let part = found.part.as_ref().map(|part| part.indices.clone());
        let part = part.unwrap_or_default();
        all.add(SegmentKind::Surface, "Part", PointAction::Kept, &part);
        let stand = found.part.as_ref().map(|part| part.stand.clone());
        let stand = stand.unwrap_or_default();
        all.add(SegmentKind::Surface, "Stand", PointAction::Dropped, &stand);
        let others = surfaces(scene, &found, params);
        let is_other = |indices: &&Vec<u32>| {
            let first = indices.first();
            first.is_some() && first != part.first().into_iter().chain(stand.first()).min()
        };
        let others = others.iter().filter(is_other);
        for (number, indices) in others.take(Self::MAX_SURFACES).enumerate() {
            let title = format!("Surface {}", number + 1);
            all.add(SegmentKind::Surface, &title, PointAction::Dropped, indices);
        }
        for plane in 0..found.planes.len() as u8 {
            let is_on = |label: &PointLabel| *label == PointLabel::Background(plane);
            let indices = places(found.labels.iter().map(is_on));
            let title = format!("Background {}", plane + 1);
            let kind = SegmentKind::Plane(plane);
            all.add(kind, &title, PointAction::Dropped, &indices);
        }
        all.add_specks(scene, PointAction::Dropped);
        all
    }

    /// Of everything, the largest piece first.
    fn all_of(scene: &SceneCloud, params: &SegmentParams) -> Self {
        let mut all = Self::of_num(scene.cloud.points.len());
        let found = pieces(scene, params);
        for (number, indices) in found.iter().take(Self::MAX_SURFACES).enumerate() {
            let title = format!("Piece {}", number + 1);
            all.add(SegmentKind::Surface, &title, PointAction::Kept, indices);
        }
        all.add_specks(scene, PointAction::Kept);
        all
    }

    fn of_num(num_points: usize) -> Self {
        Self {
            list: Vec::new(),
            of_point: vec![Self::NONE; num_points],
        }
    }

    fn add(&mut self, kind: SegmentKind, title: &str, usual: PointAction, indices: &[u32]) {
        if indices.is_empty() {
            return;
        }
        let place = self.list.len() as u16;
        for index in indices {
            self.of_point[*index as usize] = place;
        }
        self.list.push(Segment {
            kind,
            title: title.to_owned(),
            num_points: indices.len(),
            usual,
        });
    }

    /// The readings that are in no segment yet.
    fn add_specks(&mut self, scene: &SceneCloud, usual: PointAction) {
        let points = scene.cloud.points.iter().zip(&self.of_point);
        let indices = places(points.map(|(p, of)| *of == Self::NONE && is_finite(p)));
        self.add(SegmentKind::Specks, "Specks", usual, &indices);
    }
}

/// The places at which it is true.
fn places(all: impl Iterator<Item = bool>) -> Vec<u32> {
    let there = all.enumerate().filter(|(_, is_there)| *is_there);
    there.map(|(place, _)| place as u32).collect()
}

/// Where points lie in a picture of so many pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PicturePlane {
    /// As the camera read them, a pixel each.
    Camera(Grid),
    /// Seen from the front, the z axis away from the viewer, without perspective.
    Front {
        /// Pixels.
        size: [usize; 2],
        /// Smallest x and y, metres.
        low: [f32; 2],
        /// Pixels per metre.
        per_metre: f32,
    },
}

impl PicturePlane {
    /// The longer side of a picture from the front, pixels: points of a reference cloud then lie about side by side.
    const LONGER: f32 = 320.0;

    /// Empty pixels around what is seen from the front.
    const MARGIN: f32 = 8.0;

    fn of(cloud: &PointCloud) -> Self {
        if let Some(grid) = cloud.grid {
            return Self::Camera(grid);
        }
        let (low, high) = cloud
            .bounds()
            .unwrap_or((Point3::origin(), Point3::origin()));
        let extent = [0, 1].map(|axis| high[axis] - low[axis]);
        let room = Self::LONGER - 2.0 * Self::MARGIN - 1.0;
        let per_metre = room / extent[0].max(extent[1]).max(1e-6);
        let margin = Self::MARGIN / per_metre;
        Self::Front {
            size: extent.map(|length| ((length + 2.0 * margin) * per_metre).round() as usize + 1),
            low: [low.x - margin, low.y - margin],
            per_metre,
        }
    }

    /// Width and height, pixels.
    pub fn size(&self) -> [usize; 2] {
        match self {
            Self::Camera(grid) => [grid.width, grid.height],
            Self::Front { size, .. } => *size,
        }
    }

    /// How far a point spreads, pixels: what no camera read side by side has gaps otherwise.
    pub fn spread(&self) -> usize {
        match self {
            Self::Camera(_) => 0,
            Self::Front { .. } => 1,
        }
    }

    /// Column and row of a point, by its place and its coordinates.
    pub fn pixel(&self, place: usize, point: &Point3<f32>) -> [usize; 2] {
        match self {
            Self::Camera(grid) => [place % grid.width, place / grid.width],
            Self::Front {
                size,
                low,
                per_metre,
            } => [0, 1].map(|axis| {
                let at = ((point[axis] - low[axis]) * per_metre).round() as usize;
                at.min(size[axis] - 1)
            }),
        }
    }
}

impl EnrolInput {
    /// Gets it and cuts it into segments.
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
        let opened = files::open(path)?;
        let warnings = opened.warnings();
        let origin = Origin::File {
            path: path.clone(),
            is_simulated: opened.is_simulated(),
        };
        let read = match opened {
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
                // As on the command line: only what the camera read as a picture is taken for a scene.
                let (usual, scene) = match cloud.grid {
                    Some(_) => (InitialSelection::Segmented, scene_from_cloud(cloud)),
                    None => (InitialSelection::Whole, scene_of_whole(cloud)),
                };
                Ok(Self::of_scene(Arc::new(scene), origin, usual, params))
            }
        };
        Ok(read.map(|subject| Self {
            warnings,
            ..subject
        }))
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
        whole.add(SegmentKind::Surface, "Mesh", PointAction::Kept, &all);
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

    /// Of shots that were put together.
    pub(super) fn of_scan(fused: Arc<FusedShots>) -> Self {
        let matter = ScannedMatter::of(fused);
        let num_points = matter.cloud.points.len();
        let mut segments = Segments::of_num(num_points);
        let (part, rest) = (matter.voted(true), matter.voted(false));
        segments.add(SegmentKind::Surface, "Part", PointAction::Kept, &part);
        segments.add(
            SegmentKind::Plane(0),
            "Cell around it",
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

    /// True if it can be taken so.
    pub fn allows(&self, taking: InitialSelection) -> bool {
        match taking {
            InitialSelection::Whole => self.scan().is_none(),
            InitialSelection::Segmented => self.segmented.is_some(),
        }
    }

    /// Its segments when it is taken so.
    pub fn segments(&self, taking: InitialSelection) -> &Segments {
        match (taking, &self.segmented) {
            (InitialSelection::Segmented, Some(segmented)) => segmented,
            _ => &self.whole,
        }
    }

    /// Its points.
    pub fn cloud(&self) -> &PointCloud {
        match &self.matter {
            EnrolInputKind::Scene(scene) => &scene.cloud,
            EnrolInputKind::Mesh(_, cloud) => cloud,
            EnrolInputKind::Scan(scan) => &scan.cloud,
        }
    }

    /// The scene, if it is one.
    pub fn scene(&self) -> Option<&Arc<SceneCloud>> {
        match &self.matter {
            EnrolInputKind::Scene(scene) => Some(scene),
            EnrolInputKind::Mesh(..) | EnrolInputKind::Scan(_) => None,
        }
    }

    /// The shots, if it is a scan.
    pub fn scan(&self) -> Option<&Arc<FusedShots>> {
        match &self.matter {
            EnrolInputKind::Scan(scan) => Some(&scan.fused),
            EnrolInputKind::Scene(_) | EnrolInputKind::Mesh(..) => None,
        }
    }

    /// True if parts of it can be dropped: a mesh is enrolled by its surface, whole.
    pub fn can_be_corrected(&self) -> bool {
        !matches!(self.matter, EnrolInputKind::Mesh(..))
    }
}

/// A cloud as it came, every point of it: putting it back onto a picture would drop some.
fn scene_of_whole(cloud: PointCloud) -> SceneCloud {
    SceneCloud::new(cloud, None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{app::source::CellChoice, simulate::PartKind};

    fn captured() -> EnrolInput {
        let source = SceneSource::Cell {
            choice: CellChoice::Part(PartKind::Fender, crate::simulate::Side::Left),
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
            for (place, segment) in segments.list.iter().enumerate() {
                let of_it = segments.of_point.iter().filter(|of| **of == place as u16);
                assert_eq!(of_it.count(), segment.num_points, "{}", segment.title);
            }
        }
        let segmented = subject.segments(InitialSelection::Segmented);
        let kept = segmented
            .list
            .iter()
            .filter(|s| s.usual == PointAction::Kept);
        assert_eq!(kept.map(|s| s.title.as_str()).collect::<Vec<_>>(), ["Part"]);
        assert!(
            segmented
                .list
                .iter()
                .any(|s| s.kind == SegmentKind::Plane(0))
        );
    }

    #[test]
    fn points_of_a_picture_from_the_front_lie_where_they_are_seen() {
        let points = [[0.0, 0.0], [3.0, 0.0], [0.0, 1.0], [3.0, 1.0]];
        let points = points.map(|[x, y]| Point3::new(x, y, 3.0));
        let plane = PicturePlane::of(&PointCloud::from_points(points));
        assert_eq!(plane.size(), [320, 118]);
        let pixels = [0, 1, 2, 3].map(|i| plane.pixel(i, &points[i]));
        assert_eq!(pixels, [[8, 8], [311, 8], [8, 109], [311, 109]]);
    }
}
