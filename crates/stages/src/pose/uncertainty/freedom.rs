//! The direction in which a pose is unconstrained, in words.

use nalgebra::{Matrix3, Matrix6, Point3, Vector3, Vector6};

use geometry::rigid::RigidTransform;

/// How a part could move and still lie on the reference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(tag = "motion", content = "axis", rename_all = "snake_case")]
pub enum FreeMotion {
    /// Along an axis.
    Slide(Axis),
    /// About an axis.
    Turn(Axis),
    /// Too little of the part lies on the reference to tell.
    Anyhow,
}

impl texts::Described for FreeMotion {
    fn message(&self) -> texts::Message {
        texts::Message::new("free-motion").with_fields(self)
    }
}

texts::display!(FreeMotion);

impl FreeMotion {
    /// Describes a transform of some points as its main component: a turn about their middle, or a shift.
    pub fn of(transform: &RigidTransform, points: &[Point3<f32>]) -> Self {
        let num = points.len().max(1) as f64;
        let sum: Vector3<f64> = points.iter().map(|p| p.coords.cast::<f64>()).sum();
        let middle = Point3::from(sum / num);
        let squares = points.iter().map(|p| {
            let out = p.cast::<f64>() - middle;
            out * out.transpose()
        });
        let frame = LocalFrame::of(&(squares.sum::<Matrix3<f64>>() / num));
        let (turn, shift) = (
            transform.rotation.scaled_axis(),
            transform * middle - middle,
        );
        frame.freedom(&Vector6::new(
            turn.x, turn.y, turn.z, shift.x, shift.y, shift.z,
        ))
    }
}

/// An axis of what was seen of the part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// Its largest extent.
    Long,
    /// Across that, along its surface.
    Short,
    /// Square to its surface.
    Normal,
}

impl Axis {
    const ALL: [Self; 3] = [Self::Long, Self::Short, Self::Normal];
}

/// The principal axes of what was seen, and its size.
pub(super) struct LocalFrame {
    /// Unit vectors as columns, in the order of [`Axis::ALL`].
    axes: Matrix3<f64>,
    /// Root mean square distance from the middle, metres: what a turn by one radian moves a point by.
    pub(super) radius: f64,
}

impl LocalFrame {
    /// From the covariance of the points.
    pub(super) fn of(covariance: &Matrix3<f64>) -> Self {
        let eigen = covariance.symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
        Self {
            axes: Matrix3::from_columns(&order.map(|i| eigen.eigenvectors.column(i).into_owned())),
            radius: covariance.trace().max(0.0).sqrt(),
        }
    }

    /// The freedom that a motion stands for: turn in radians, then shift in metres, about the middle.
    pub(super) fn freedom(&self, motion: &Vector6<f64>) -> FreeMotion {
        let (turn, shift) = (motion.fixed_rows::<3>(0), motion.fixed_rows::<3>(3));
        if turn.norm() * self.radius > shift.norm() {
            FreeMotion::Turn(self.nearest(&turn.into_owned()))
        } else {
            FreeMotion::Slide(self.nearest(&shift.into_owned()))
        }
    }

    /// The motion that a covariance allows most of.
    pub(super) fn widest(&self, covariance: &Matrix6<f64>) -> FreeMotion {
        let units = self.units();
        let per_unit = Matrix6::from_diagonal(&units.diagonal().map(f64::recip));
        let in_units = per_unit * covariance * per_unit;
        if !in_units.iter().all(|x| x.is_finite()) {
            return FreeMotion::Anyhow;
        }
        let eigen = in_units.symmetric_eigen();
        let widest = eigen.eigenvectors.column(eigen.eigenvalues.imax());
        self.freedom(&(units * widest))
    }

    /// Carries motions whose turns are counted by what they move a point by, metres, into radians.
    pub(super) fn units(&self) -> Matrix6<f64> {
        let per_turn = 1.0 / self.radius.max(1e-9);
        Matrix6::from_diagonal(&Vector6::new(per_turn, per_turn, per_turn, 1.0, 1.0, 1.0))
    }

    /// The axis nearest to a direction.
    fn nearest(&self, direction: &Vector3<f64>) -> Axis {
        Axis::ALL[self.axes.tr_mul(direction).iamax()]
    }
}
