//! What a view shows: point sets, lines and labels, as plain data that is cheap to clone.
//!
//! A [`PointSet`] or [`LineSet`] is made once, off the UI thread if it is large, and never changes; its generation number
//! identifies its copy on the GPU. To show other points, make another set; to move the same points, change `world_from_set`,
//! which uploads nothing.

use std::sync::{
    Arc,
    atomic::{AtomicU64, Ordering},
};

use glam::{Mat4, Vec3};
use nalgebra::Point3;

use super::{
    bounds::PointBounds,
    points::{PackedTable, pack},
    style::{Colouring, Role},
};
use geometry::rigid::RigidTransform;
use stages::segment::PointLabel;

/// A point as the view takes it.
pub fn vec3(p: &Point3<f64>) -> Vec3 {
    Vec3::new(p.x as f32, p.y as f32, p.z as f32)
}

/// Returns a number that no other set of this process has.
fn next_generation() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// Points and the data that they can be coloured by. Cloning shares the data.
#[derive(Clone, Debug)]
pub struct PointSet {
    /// Transform from the set's own frame (camera or part) to the view's world, the camera frame.
    pub world_from_set: Mat4,
    /// Overrides the view's colouring for this set.
    pub colouring: Option<Colouring>,
    positions: Arc<[[f32; 3]]>,
    labels: Labels,
    deviations: Option<Arc<[f32]>>,
    packed: Option<Arc<[PackedTable]>>,
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
    /// Makes a set of points with one role. Points with a non-finite coordinate are never shown.
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

    /// Makes a set from a segmented scene; `positions` and `labels` are in the same order.
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

    /// Adds the signed deviation of each point from the reference, metres, in the order of the positions. Points with NaN have
    /// none and keep the colour of their role, dimmed.
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

    /// Packs the points for the GPU, as the last step of making the set off the UI thread: showing it is then only a copy.
    #[must_use]
    pub fn packed(mut self) -> Self {
        self.packed = Some(pack(&self));
        self
    }

    /// Returns the points packed for the GPU, packing them now if [`Self::packed`] was not called.
    pub(super) fn to_upload(&self) -> Arc<[PackedTable]> {
        self.packed.clone().unwrap_or_else(|| pack(self))
    }

    /// Sets a colouring of its own, whatever the view's.
    #[must_use]
    pub fn coloured(mut self, colouring: Colouring) -> Self {
        self.colouring = Some(colouring);
        self
    }

    /// Makes the view turn about the parts of these sets of the same frame, too.
    #[must_use]
    pub fn focused_on<'a>(mut self, others: impl Iterator<Item = &'a Self>) -> Self {
        let others = others.filter_map(|set| set.focus);
        self.focus = self
            .focus
            .into_iter()
            .chain(others)
            .reduce(PointBounds::union);
        self
    }

    /// The box around the part, in the set's own frame; `None` without a part.
    pub fn focus(&self) -> Option<PointBounds> {
        self.focus
    }

    /// Positions in the set's own frame, metres.
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

    /// Identifies the copy on the GPU.
    pub(super) fn generation(&self) -> u64 {
        self.generation
    }
}

/// Converts a rigid transform for the GPU.
pub fn mat4(transform: &RigidTransform) -> Mat4 {
    let matrix = transform.to_homogeneous().cast::<f32>();
    Mat4::from_cols_slice(matrix.as_slice())
}

/// A polyline.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Vertices, metres, in the set's own frame. A closed line repeats the first.
    pub points: Vec<Vec3>,
    /// Decides the colour.
    pub role: Role,
    /// Width, logical pixels.
    pub width: f32,
    /// True if it is drawn in dashes of about eight logical pixels.
    pub is_dashed: bool,
}

impl Line {
    /// Makes a solid line two pixels wide.
    pub fn new(points: impl Into<Vec<Vec3>>, role: Role) -> Self {
        Self {
            points: points.into(),
            role,
            width: 2.0,
            is_dashed: false,
        }
    }

    /// Makes the line dashed.
    #[must_use]
    pub fn dashed(mut self) -> Self {
        self.is_dashed = true;
        self
    }

    /// Sets the width, logical pixels.
    #[must_use]
    pub fn with_width(mut self, width: f32) -> Self {
        self.width = width;
        self
    }
}

/// Lines that share a frame. Cloning shares the data.
#[derive(Clone, Debug)]
pub struct LineSet {
    /// Transform from the lines' frame to the view's world, the camera frame.
    pub world_from_set: Mat4,
    lines: Arc<[Line]>,
    generation: u64,
}

impl LineSet {
    /// Makes a set of lines in world coordinates.
    pub fn new(lines: impl Into<Arc<[Line]>>) -> Self {
        Self {
            world_from_set: Mat4::IDENTITY,
            lines: lines.into(),
            generation: next_generation(),
        }
    }

    /// Sets the transform from the lines' frame to the world.
    #[must_use]
    pub fn at(mut self, world_from_set: &RigidTransform) -> Self {
        self.world_from_set = mat4(world_from_set);
        self
    }

    /// The polylines of the set.
    pub fn lines(&self) -> &[Line] {
        &self.lines
    }

    /// Identifies the copy on the GPU.
    pub(super) fn generation(&self) -> u64 {
        self.generation
    }
}

/// A text at a point of the world.
#[derive(Clone, Debug, PartialEq)]
pub struct TextLabel {
    /// Position, world, metres.
    pub at: Vec3,
    /// What is written there.
    pub text: String,
}

/// Everything that one view shows.
#[derive(Clone, Debug, Default)]
pub struct ViewScene {
    /// Point sets, each with its own transform.
    pub points: Vec<PointSet>,
    /// Line sets, each with its own transform.
    pub lines: Vec<LineSet>,
    /// Texts, drawn over everything else.
    pub labels: Vec<TextLabel>,
}

impl ViewScene {
    /// Returns the box around all points except outliers; `None` without any.
    pub fn bounds(&self) -> Option<PointBounds> {
        self.union(|set| set.bounds)
    }

    /// Returns the box around the part if there is one, else around everything.
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
