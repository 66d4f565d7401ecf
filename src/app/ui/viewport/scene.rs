//! What a view shows: point sets, lines and labels, as plain data that is cheap to clone.
//!
//! A [`PointSet`] or [`LineSet`] is made once, off the UI thread if it is large, and never changes; each has a number
//! of its own (its generation), by which the GPU's copy is known. To show other points, make another set; to show the
//! same points elsewhere, change `world_from_set` and nothing is uploaded again.

use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

use glam::{Mat4, Vec3};

use super::{
    bounds::PointBounds,
    points::PackedPoints,
    style::{Colouring, Role},
};
use crate::{geometry::rigid::RigidTransform, stages::segment::PointLabel};

/// A number that no other set of this run has.
fn next_generation() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// Points with what they can be coloured by. Cloning shares the data.
#[derive(Clone, Debug)]
pub struct PointSet {
    /// Where the set stands: maps its own coordinates (camera or part) to the view's world, the camera space.
    pub world_from_set: Mat4,
    /// The colouring of this set where it differs from the view's.
    pub colouring: Option<Colouring>,
    positions: Arc<[[f32; 3]]>,
    labels: Labels,
    deviations: Option<Arc<[f32]>>,
    packed: Option<Arc<PackedPoints>>,
    generation: u64,
    bounds: Option<PointBounds>,
    focus: Option<PointBounds>,
}

#[derive(Clone, Debug)]
enum Labels {
    All(Role),
    Each(Arc<[u8]>),
}

impl PointSet {
    /// Points that all play one role. Those with a coordinate that is not finite are never shown.
    pub fn new(positions: impl Into<Arc<[[f32; 3]]>>, role: Role) -> Self {
        let positions = positions.into();
        let bounds = PointBounds::robust(positions.iter().map(|p| Vec3::from(*p)));
        Self {
            world_from_set: Mat4::IDENTITY,
            colouring: None,
            labels: Labels::All(role),
            deviations: None,
            packed: None,
            generation: next_generation(),
            bounds,
            focus: bounds.filter(|_| role == Role::Part),
            positions,
        }
    }

    /// A scene with what segmentation took each point for; both lists are in the same order.
    pub fn segmented(positions: impl Into<Arc<[[f32; 3]]>>, labels: &[PointLabel]) -> Self {
        let mut set = Self::new(positions, Role::Rest);
        assert_eq!(labels.len(), set.positions.len(), "one label per point");
        let roles: Arc<[u8]> = labels.iter().map(|label| Role::of(*label) as u8).collect();
        let is_part = |(_, label): &(&[f32; 3], &u8)| **label == Role::Part as u8;
        let of_part = set.positions.iter().zip(roles.iter()).filter(is_part);
        set.focus = PointBounds::robust(of_part.map(|(p, _)| Vec3::from(*p)));
        set.labels = Labels::Each(roles);
        set
    }

    /// Adds the signed deviation of each point from the reference, metres, in the order of the positions. NaN where
    /// there is none: such a point keeps the colour of its role, dimmed.
    #[must_use]
    pub fn with_deviations(mut self, deviations: impl Into<Arc<[f32]>>) -> Self {
        let deviations = deviations.into();
        assert_eq!(
            deviations.len(),
            self.positions.len(),
            "one deviation per point"
        );
        self.deviations = Some(deviations);
        self.packed = None;
        self.generation = next_generation();
        self
    }

    /// Arranges the points as the GPU takes them, as the last step of making the set off the UI thread: showing it is
    /// then a copy.
    #[must_use]
    pub fn packed(mut self) -> Self {
        self.packed = Some(Arc::new(PackedPoints::of(&self)));
        self
    }

    /// The points as the GPU takes them, arranged now if nobody has yet.
    pub(super) fn to_upload(&self) -> Arc<PackedPoints> {
        match &self.packed {
            Some(packed) => Arc::clone(packed),
            None => Arc::new(PackedPoints::of(self)),
        }
    }

    /// Colours the set in its own way, whatever the view's colouring.
    #[must_use]
    pub fn coloured(mut self, colouring: Colouring) -> Self {
        self.colouring = Some(colouring);
        self
    }

    /// Positions in the set's own coordinates, metres.
    pub fn positions(&self) -> &[[f32; 3]] {
        &self.positions
    }

    /// The role of point `index`.
    pub fn role(&self, index: usize) -> Role {
        match &self.labels {
            Labels::All(role) => *role,
            Labels::Each(labels) => Role::ALL[usize::from(labels[index])],
        }
    }

    /// Signed deviation of point `index` from the reference, metres, if known.
    pub fn deviation(&self, index: usize) -> Option<f32> {
        self.deviations
            .as_ref()
            .map(|all| all[index])
            .filter(|d| d.is_finite())
    }

    /// The number by which the GPU's copy is known.
    pub(super) fn generation(&self) -> u64 {
        self.generation
    }
}

/// A rigid transform as the GPU takes it.
pub fn mat4(transform: &RigidTransform) -> Mat4 {
    let matrix = transform.to_homogeneous().cast::<f32>();
    Mat4::from_cols_slice(matrix.as_slice())
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// Without gaps.
    Solid,
    /// In dashes of about eight logical pixels.
    Dashed,
}

/// A polyline.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Corners, metres, in the set's own coordinates. A closed line repeats its first corner.
    pub points: Vec<Vec3>,
    /// Decides its colour.
    pub role: Role,
    /// Width, logical pixels.
    pub width: f32,
    /// Solid or dashed.
    pub stroke: Stroke,
}

impl Line {
    /// A solid line of two pixels.
    pub fn new(points: impl Into<Vec<Vec3>>, role: Role) -> Self {
        Self {
            points: points.into(),
            role,
            width: 2.0,
            stroke: Stroke::Solid,
        }
    }

    /// The same, in dashes.
    #[must_use]
    pub fn dashed(mut self) -> Self {
        self.stroke = Stroke::Dashed;
        self
    }

    /// The same, of another width, logical pixels.
    #[must_use]
    pub fn with_width(mut self, width: f32) -> Self {
        self.width = width;
        self
    }
}

/// Lines that stand and move together. Cloning shares the data.
#[derive(Clone, Debug)]
pub struct LineSet {
    /// Maps the lines' coordinates to the view's world, the camera space.
    pub world_from_set: Mat4,
    lines: Arc<[Line]>,
    generation: u64,
}

impl LineSet {
    /// Lines in world coordinates.
    pub fn new(lines: impl Into<Arc<[Line]>>) -> Self {
        Self {
            world_from_set: Mat4::IDENTITY,
            lines: lines.into(),
            generation: next_generation(),
        }
    }

    /// Stands the lines elsewhere.
    #[must_use]
    pub fn at(mut self, world_from_set: &RigidTransform) -> Self {
        self.world_from_set = mat4(world_from_set);
        self
    }

    /// The lines.
    pub fn lines(&self) -> &[Line] {
        &self.lines
    }

    /// The number by which the GPU's copy is known.
    pub(super) fn generation(&self) -> u64 {
        self.generation
    }
}

/// Words at a point of the world.
#[derive(Clone, Debug, PartialEq)]
pub struct TextLabel {
    /// Where, world, metres.
    pub at: Vec3,
    /// The words.
    pub text: String,
}

/// Everything that one view shows.
#[derive(Clone, Debug, Default)]
pub struct ViewScene {
    /// Points.
    pub points: Vec<PointSet>,
    /// Lines.
    pub lines: Vec<LineSet>,
    /// Words, drawn over everything else.
    pub labels: Vec<TextLabel>,
}

impl ViewScene {
    /// The box about all points, stray ones left out; `None` without any.
    pub fn bounds(&self) -> Option<PointBounds> {
        self.union(|set| set.bounds)
    }

    /// The box about the part where there is one, else about everything.
    pub fn focus(&self) -> Option<PointBounds> {
        self.union(|set| set.focus).or_else(|| self.bounds())
    }

    fn union(&self, bounds: impl Fn(&PointSet) -> Option<PointBounds>) -> Option<PointBounds> {
        let boxes = self
            .points
            .iter()
            .filter_map(|set| Some(bounds(set)?.moved(&set.world_from_set)));
        boxes.reduce(PointBounds::union)
    }
}
