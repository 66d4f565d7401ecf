//! The U-shaped plan of a bumper, seen from above.

use nalgebra::Vector2;

/// The shape from the middle of the car to the bumper's end; lengths in metres.
pub(super) struct PlanShape {
    /// Half of the overall width.
    pub(super) half_width: f64,
    /// Radius of the gentle bow across the front.
    pub(super) front_radius: f64,
    /// Radius of the corner.
    pub(super) corner_radius: f64,
    /// Direction of the end relative to the front, in radians: a little under a right angle.
    pub(super) end_heading: f64,
    /// How far the ends lie behind the middle.
    pub(super) wrap: f64,
}

/// The right half of the curve, sampled by arc length.
pub(super) struct PlanCurve {
    /// Position (x, z) and heading every [`STEP`] metres.
    samples: Vec<(Vector2<f64>, f64)>,
}

const STEP: f64 = 0.001;

impl PlanCurve {
    /// Draws the curve: bow, corner, straight end.
    pub(super) fn new(shape: &PlanShape) -> Self {
        // Find the start of the corner for which the end has the required half width. A later start moves the end out by
        // nearly as much, so a few corrections suffice.
        let mut corner_start = shape.half_width - shape.corner_radius;
        let mut samples = Vec::new();
        for _ in 0..6 {
            samples = draw(shape, corner_start);
            let reached = samples.last().map_or(0.0, |(p, _)| p.x);
            corner_start += shape.half_width - reached;
        }
        Self { samples }
    }

    /// Returns the arc length from the middle to the end.
    pub(super) fn half_length(&self) -> f64 {
        (self.samples.len() - 1) as f64 * STEP
    }

    /// Returns the point at arc length `u` (negative to the left), moved outwards by `bulge`, as (x, z).
    pub(super) fn at(&self, u: f64, bulge: f64) -> (f64, f64) {
        let place = u.abs() / STEP;
        let index = (place as usize).min(self.samples.len() - 2);
        let ((a, heading_a), (b, heading_b)) = (self.samples[index], self.samples[index + 1]);
        let t = place - index as f64;
        let position = a + (b - a) * t;
        let heading = heading_a + (heading_b - heading_a) * t;
        let x = position.x + heading.sin() * bulge;
        let z = position.y - heading.cos() * bulge;
        (if u < 0.0 { -x } else { x }, z)
    }
}

fn draw(shape: &PlanShape, corner_start: f64) -> Vec<(Vector2<f64>, f64)> {
    let (mut position, mut heading) = (Vector2::zeros(), 0.0_f64);
    let mut samples = vec![(position, heading)];
    // A bumper measures under 2 m from the middle to the end; the bound only guards against a shape without an end.
    while position.y < shape.wrap && samples.len() < 2000 {
        let bending = if position.x < corner_start {
            1.0 / shape.front_radius
        } else if heading < shape.end_heading {
            1.0 / shape.corner_radius
        } else {
            0.0
        };
        heading += bending * STEP;
        position += Vector2::new(heading.cos(), heading.sin()) * STEP;
        samples.push((position, heading));
    }
    samples
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_ends_at_the_asked_width_and_depth() {
        let curve = PlanCurve::new(&PlanShape {
            half_width: 0.72,
            front_radius: 1.6,
            corner_radius: 0.25,
            end_heading: 1.4,
            wrap: 0.32,
        });
        let (x, z) = curve.at(-curve.half_length(), 0.0);
        assert!((x + 0.72).abs() < 0.003, "{x}");
        assert!((z - 0.32).abs() < 0.003, "{z}");
    }
}
