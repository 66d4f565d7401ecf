//! The input's points cut into segments that are kept or dropped as a whole.

use serde::{Deserialize, Serialize};

use geometry::cloud::is_finite;
use stages::{
    scene::SceneCloud,
    segment::{PointLabel, SegmentParams, pieces, segment},
};
use ui::language::text;

/// The segmentation of the points.
#[derive(Debug)]
pub struct Segments {
    /// The segments, the likeliest part first.
    pub list: Vec<Segment>,
    /// For each point the index of its segment in the list, or [`Segments::NONE`].
    pub of_point: Vec<u16>,
}

/// Points that are kept or dropped together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Segment {
    /// What kind of segment it is.
    pub kind: SegmentKind,
    /// Title in the list.
    pub title: SegmentTitle,
    /// Number of points.
    pub num_points: usize,
    /// Default action.
    pub usual: PointAction,
}

/// Kind of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SegmentKind {
    /// A connected surface.
    Surface,
    /// A background plane, with its number.
    Plane(u8),
    /// Points of pieces too small for a surface, and of surfaces beyond the limit.
    Specks,
}

/// What a segment is called; numbers count from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SegmentTitle {
    /// The part.
    Part,
    /// The stand that holds the part.
    Stand,
    /// Another surface in front of the background.
    Surface(usize),
    /// A background plane.
    Background(usize),
    /// A connected piece of everything.
    Piece(usize),
    /// Pieces too small for a surface.
    Specks,
    /// A mesh.
    Mesh,
    /// What surrounds the part of a scan.
    Cell,
}

impl SegmentTitle {
    /// Name for a person.
    pub fn shown(self) -> String {
        match self {
            Self::Part => text!("shell-part"),
            Self::Stand => text!("enrol-segment-stand"),
            Self::Surface(number) => text!("enrol-segment-surface", number = number),
            Self::Background(number) => text!("enrol-segment-background", number = number),
            Self::Piece(number) => text!("enrol-segment-piece", number = number),
            Self::Specks => text!("enrol-segment-specks"),
            Self::Mesh => text!("enrol-segment-mesh"),
            Self::Cell => text!("enrol-segment-cell"),
        }
    }
}

/// What is done with points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PointAction {
    /// They belong to the part.
    Kept,
    /// They do not belong to the part.
    Dropped,
}

impl Segments {
    /// Marks a point without a segment, where the camera had no reading.
    pub const NONE: u16 = u16::MAX;
    /// Limit of surfaces; further ones count as specks.
    const MAX_SURFACES: usize = 24;

    /// Segments a scene with background removal, the part first.
    pub(super) fn before_background(scene: &SceneCloud, params: &SegmentParams) -> Self {
        let found = segment(scene, params);
        let mut all = Self::of_num(found.labels.len());
        let (part, stand) = match &found.part {
            Ok(part) => (&part.indices[..], &part.stand[..]),
            Err(_) => (&[][..], &[][..]),
        };
        let title = SegmentTitle::Part;
        all.add(SegmentKind::Surface, title, PointAction::Kept, part);
        let title = SegmentTitle::Stand;
        all.add(SegmentKind::Surface, title, PointAction::Dropped, stand);
        let is_other = |indices: &&Vec<u32>| {
            let first = indices.first();
            first.is_some() && first != part.first().into_iter().chain(stand.first()).min()
        };
        let others = found.surfaces.iter().filter(is_other);
        for (number, indices) in others.take(Self::MAX_SURFACES).enumerate() {
            let title = SegmentTitle::Surface(number + 1);
            all.add(SegmentKind::Surface, title, PointAction::Dropped, indices);
        }
        for plane in 0..found.planes.len() as u8 {
            let is_on = |label: &PointLabel| *label == PointLabel::Background(plane);
            let indices = indices_where(found.labels.iter().map(is_on));
            let title = SegmentTitle::Background(usize::from(plane) + 1);
            let kind = SegmentKind::Plane(plane);
            all.add(kind, title, PointAction::Dropped, &indices);
        }
        all.add_specks(scene, PointAction::Dropped);
        all
    }

    /// Segments everything, the largest piece first.
    pub(super) fn all_of(scene: &SceneCloud, params: &SegmentParams) -> Self {
        let mut all = Self::of_num(scene.cloud.points.len());
        let found = pieces(scene, params);
        for (number, indices) in found.iter().take(Self::MAX_SURFACES).enumerate() {
            let title = SegmentTitle::Piece(number + 1);
            all.add(SegmentKind::Surface, title, PointAction::Kept, indices);
        }
        all.add_specks(scene, PointAction::Kept);
        all
    }

    pub(super) fn of_num(num_points: usize) -> Self {
        Self {
            list: Vec::new(),
            of_point: vec![Self::NONE; num_points],
        }
    }

    pub(super) fn add(
        &mut self,
        kind: SegmentKind,
        title: SegmentTitle,
        usual: PointAction,
        indices: &[u32],
    ) {
        if indices.is_empty() {
            return;
        }
        let segment = self.list.len() as u16;
        for index in indices {
            self.of_point[*index as usize] = segment;
        }
        self.list.push(Segment {
            kind,
            title,
            num_points: indices.len(),
            usual,
        });
    }

    /// Adds the readings that are in no segment yet.
    fn add_specks(&mut self, scene: &SceneCloud, usual: PointAction) {
        let points = scene.cloud.points.iter().zip(&self.of_point);
        let indices = indices_where(points.map(|(p, of)| *of == Self::NONE && is_finite(p)));
        self.add(SegmentKind::Specks, SegmentTitle::Specks, usual, &indices);
    }
}

/// Indices of the `true` items.
fn indices_where(all: impl Iterator<Item = bool>) -> Vec<u32> {
    let there = all.enumerate().filter(|(_, is_there)| *is_there);
    there.map(|(index, _)| index as u32).collect()
}
