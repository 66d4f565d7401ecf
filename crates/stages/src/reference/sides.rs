//! Front and back of a reference that is known from both.
//!
//! The two skins of a sheet are a millimetre or two apart, less than the spacing of a reference's points. A camera sees one of
//! them, so a pose is refined to the points that the views of one side show.

use std::sync::OnceLock;

use nalgebra::Vector3;

use super::{FIELD_BAND_M, FIELD_CELL_M, Reference, ReferenceView, viewpoints::visible_from};
use geometry::{cloud::PointCloud, nearest::KdTree, nearest_field::NearestField};

/// What the views of one side show.
#[derive(Clone, Debug)]
pub(super) struct ReferenceSide {
    pub(super) cloud: PointCloud,
    pub(super) tree: OnceLock<KdTree>,
    field: OnceLock<NearestField>,
}

impl ReferenceSide {
    fn of(cloud: &PointCloud, is_shown: &[bool]) -> Self {
        let indices = || (0..cloud.points.len()).filter(|i| is_shown[*i]);
        let normals = cloud.normals.as_ref();
        Self {
            cloud: PointCloud {
                normals: normals.map(|normals| indices().map(|i| normals[i]).collect()),
                ..PointCloud::from_points(indices().map(|i| cloud.points[i]))
            },
            tree: OnceLock::new(),
            field: OnceLock::new(),
        }
    }

    /// Returns the nearest-point field, which is built on first use.
    pub(super) fn field(&self) -> &NearestField {
        let new = || NearestField::new(&self.cloud.points, FIELD_CELL_M, FIELD_BAND_M);
        self.field.get_or_init(new)
    }
}

impl Reference {
    /// Returns the side that a view shows; `None` if all views are of the front.
    pub(super) fn side_of(&self, view: &ReferenceView) -> Option<&ReferenceSide> {
        let [front, back] = self.sides.get_or_init(|| self.split()).as_ref()?;
        Some(if self.is_of_front(view) { front } else { back })
    }

    /// Returns whether two views show the same side.
    pub(super) fn are_of_one_side(&self, one: usize, other: usize) -> bool {
        self.is_of_front(&self.views[one]) == self.is_of_front(&self.views[other])
    }

    fn is_of_front(&self, view: &ReferenceView) -> bool {
        let front = self.views.first().map_or_else(Vector3::zeros, towards);
        towards(view).dot(&front) > 0.0
    }

    fn split(&self) -> Option<[ReferenceSide; 2]> {
        if self.views.iter().all(|view| self.is_of_front(view)) {
            return None;
        }
        let bounds = self.cloud.bounds()?;
        let normals = self.cloud.normals.as_deref()?;
        let front = towards(self.views.first()?).cast::<f32>();
        let mut is_shown = [true, false].map(|is_front| {
            let mut is_shown = vec![false; self.cloud.points.len()];
            for view in self
                .views
                .iter()
                .filter(|v| self.is_of_front(v) == is_front)
            {
                for (i, _) in visible_from(&self.cloud, bounds, &view.viewpoint) {
                    is_shown[i] = true;
                }
            }
            is_shown
        });
        for (i, normal) in normals.iter().enumerate() {
            if is_shown.iter().all(|shown| !shown[i]) {
                is_shown[usize::from(normal.dot(&front) < 0.0)][i] = true;
            }
        }
        Some(is_shown.map(|is_shown| ReferenceSide::of(&self.cloud, &is_shown)))
    }
}

/// The direction to the camera of a view, part space.
fn towards(view: &ReferenceView) -> Vector3<f64> {
    view.plane_from_part.inverse() * Vector3::z()
}
