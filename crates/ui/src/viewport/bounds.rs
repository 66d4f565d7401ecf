//! The box that a view is fitted to: robust, so that one stray reading does not shrink the part to a dot.

use glam::{DVec3, Vec3};

/// Points further than this many standard deviations from the mean are left out of the second mean.
const TRIM_SIGMAS: f64 = 2.0;
/// The box reaches this far around the trimmed mean, but never past the points. An evenly covered surface spans ±1.73 σ; a
/// part with a heavy body and a thin frame, such as a door, spans more.
const BOX_SIGMAS: f64 = 4.0;

/// An axis-aligned box, world, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointBounds {
    /// Smallest coordinates.
    pub low: Vec3,
    /// Largest coordinates.
    pub high: Vec3,
}

impl PointBounds {
    /// The centre of the box.
    pub fn centre(&self) -> Vec3 {
        self.low.midpoint(self.high)
    }

    /// The eight corners.
    pub fn corners(&self) -> impl Iterator<Item = Vec3> + use<> {
        let Self { low, high } = *self;
        (0..8).map(move |i| {
            let pick = |bit: usize, low: f32, high: f32| if i & bit == 0 { low } else { high };
            Vec3::new(
                pick(1, low.x, high.x),
                pick(2, low.y, high.y),
                pick(4, low.z, high.z),
            )
        })
    }

    /// Returns the box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// Returns the axis-aligned box around the transformed corners.
    #[must_use]
    pub fn moved(&self, to_from: &glam::Mat4) -> Self {
        let start = Self {
            low: Vec3::INFINITY,
            high: Vec3::NEG_INFINITY,
        };
        self.corners().fold(start, |bounds, corner| {
            let corner = to_from.transform_point3(corner);
            bounds.union(Self {
                low: corner,
                high: corner,
            })
        })
    }

    /// Returns the box around the bulk of the points: mean and standard deviation, computed again without points beyond 2 σ,
    /// then ±4 σ, clipped to the outermost points. Ignores non-finite points; `None` without any.
    pub fn robust(points: impl Iterator<Item = Vec3> + Clone) -> Option<Self> {
        let finite = points.filter(|p| p.is_finite());
        let first = RobustExtent::of(finite.clone())?;
        let trimmed =
            RobustExtent::of(finite.filter(|p| first.contains(*p, TRIM_SIGMAS))).unwrap_or(first);
        let reach = trimmed.sigma * BOX_SIGMAS;
        Some(Self {
            low: (trimmed.mean - reach).as_vec3().max(first.low),
            high: (trimmed.mean + reach).as_vec3().min(first.high),
        })
    }
}

#[derive(Clone, Copy)]
struct RobustExtent {
    mean: DVec3,
    sigma: DVec3,
    low: Vec3,
    high: Vec3,
}

impl RobustExtent {
    fn of(points: impl Iterator<Item = Vec3>) -> Option<Self> {
        let (mut count, mut sum, mut sum_sq) = (0.0, DVec3::ZERO, DVec3::ZERO);
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for point in points {
            // In f32, sums over hundreds of thousands of points would lose digits.
            let p = point.as_dvec3();
            count += 1.0;
            sum += p;
            sum_sq += p * p;
            low = low.min(point);
            high = high.max(point);
        }
        (count > 0.0).then(|| {
            let mean = sum / count;
            Self {
                mean,
                sigma: (sum_sq / count - mean * mean)
                    .max(DVec3::ZERO)
                    .map(f64::sqrt),
                low,
                high,
            }
        })
    }

    fn contains(&self, point: Vec3, sigmas: f64) -> bool {
        ((point.as_dvec3() - self.mean)
            .abs()
            .cmple(self.sigma * sigmas + 1e-9))
        .all()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Vec<Vec3> {
        (0..10_000)
            .map(|i| Vec3::new((i % 100) as f32 / 100.0, (i / 100) as f32 / 100.0, 1.0))
            .collect()
    }

    #[test]
    fn an_even_surface_is_held_whole() {
        let bounds = PointBounds::robust(square().into_iter()).expect("points");
        assert_eq!(bounds.low, Vec3::new(0.0, 0.0, 1.0));
        assert_eq!(bounds.high, Vec3::new(0.99, 0.99, 1.0));
    }

    #[test]
    fn stray_points_and_nan_do_not_widen_the_box_much() {
        let mut points = square();
        points.extend([
            Vec3::splat(60.0),
            Vec3::NAN,
            Vec3::new(f32::INFINITY, 0.0, 0.0),
        ]);
        let bounds = PointBounds::robust(points.into_iter()).expect("points");
        assert!((bounds.high - bounds.low).max_element() < 2.5, "{bounds:?}");
    }

    #[test]
    fn no_points_have_no_box_and_one_point_has_an_empty_one() {
        assert_eq!(PointBounds::robust(std::iter::empty()), None);
        assert_eq!(PointBounds::robust(std::iter::once(Vec3::NAN)), None);
        let bounds = PointBounds::robust(std::iter::once(Vec3::ONE)).expect("a point");
        assert_eq!(bounds.low, bounds.high);
    }
}
