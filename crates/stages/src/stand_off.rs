//! Stand-off: distance and angle between nozzle and part if the spray path ran as taught.
//!
//! The paper keeps the directed distance d = ‖pₑ - pᵢ‖ (eq. 14) between the nozzle pₑ and the surface point pᵢ in front
//! of it within 10 to 20 cm, with the surface normal pointing at the nozzle. It does not define a path. Ours belongs to
//! the enrolled part: taught over its *standard position*, with the nozzle at the distance d₀ from every surface point
//! sᵢ, on the normal nᵢ. The part now hangs at the pose T = `camera_from_part` = (R, t) instead. In part space, the
//! nozzle position and direction are
//!
//! ```text
//! eᵢ = T⁻¹ (sᵢ + d₀ nᵢ)        aᵢ = -R⁻¹ nᵢ
//! dᵢ = the t nearest to d₀ for which eᵢ + t aᵢ lies on the enrolled surface, at pᵢ
//! φᵢ = the angle between -aᵢ and the normal at pᵢ
//! ```
//!
//! so that at the standard position dᵢ = d₀ and φᵢ = 0 everywhere, and a part that is 30 mm nearer has every dᵢ 30 mm
//! shorter. dᵢ < 0 means that the nozzle would be inside or behind the part. Rays are taught only over surfaces that
//! the camera sees. A ray that misses the part sprays past it, and counts as outside the band.
//!
//! Source: the paper's section V-B, eq. 14 and Fig. 7(d).
//!
//! Known limits: the surface is the reference cloud's, locally flat between its points; it is searched for only within
//! 0.4 m of where it was taught; a surface at more than 80° to the ray counts as missed.

pub mod ray;

use nalgebra::{Isometry3, Point3, Vector3};
use serde::Serialize;

use self::ray::{Ray, ReferenceSurface};
use crate::reference::Reference;
use geometry::{
    rigid::RigidTransform,
    statistics::sample_evenly,
    units::{Metres, Radians},
};

/// Parameters of [`stand_off`].
#[derive(Clone, Debug, PartialEq, Serialize, serde::Deserialize)]
#[serde(default)]
pub struct StandOffParams {
    /// d₀, the distance at which the path was taught, 0.02..1 m.
    pub taught: Metres,
    /// Nearest distance that still coats well, 10..150 mm, always below `farthest`.
    pub nearest: Metres,
    /// Farthest distance that still coats well, 160..1000 mm.
    pub farthest: Metres,
    /// Number of rays of the assumed path, 10..10 000. Each costs about 2 µs; more rays find smaller worst spots.
    pub num_rays: usize,
}

impl Default for StandOffParams {
    /// The paper's band, taught at its middle.
    fn default() -> Self {
        Self {
            taught: Metres(0.15),
            nearest: Metres(0.10),
            farthest: Metres(0.20),
            num_rays: 600,
        }
    }
}

/// An assumed nozzle position relative to the part as it hangs now; camera space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NozzleRay {
    /// Nozzle tip pₑ, metres.
    pub mouth: Point3<f64>,
    /// Direction of the nozzle, unit length.
    pub direction: Vector3<f64>,
    /// Point pᵢ at which the ray meets the part.
    pub surface: Point3<f64>,
    /// dᵢ; below 0 if the nozzle is inside or behind the part.
    pub distance: Metres,
    /// φᵢ, 0..80°.
    pub angle: Radians,
}

/// The stand-off over a part.
#[derive(Clone, Debug, PartialEq)]
pub struct StandOff {
    /// All rays that meet the part.
    pub rays: Vec<NozzleRay>,
    /// Number of taught rays, including those that miss.
    pub num_taught: usize,
    /// Mean of dᵢ.
    pub mean: Metres,
    /// The ray whose dᵢ differs most from d₀.
    pub worst: NozzleRay,
    /// The ray taught nearest to the middle of the part.
    pub middle: NozzleRay,
    /// Share of the taught rays with dᵢ inside the band, 0..1.
    pub in_band: f64,
    /// Mean of φᵢ.
    pub mean_angle: Radians,
    /// Largest φᵢ.
    pub worst_angle: Radians,
}

/// Minimum share inside the band for an even coat; the other 5 % allow for rims and openings.
const LEAST_IN_BAND: f64 = 0.95;

impl StandOff {
    /// Returns true if the path can run as taught.
    pub fn keeps_the_band(&self) -> bool {
        self.in_band >= LEAST_IN_BAND
    }
}

/// Reason why there is no stand-off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum StandOffError {
    /// The reference is a flat shape, or a cloud without normals.
    NoSurface,
    /// The part is nowhere near where the path was taught.
    NoneMeets {
        /// Number of rays taught.
        num_taught: usize,
    },
}

texts::described!(StandOffError: "stand-off" by "kind");

/// Minimum cosine between normal and line of sight: flatter surfaces are not painted from the camera's side.
const MIN_SEEN_COSINE: f64 = 0.3;

/// Computes the stand-off of the path taught over `reference`, with the part at `camera_from_part`.
pub fn stand_off(
    reference: &Reference,
    camera_from_part: &RigidTransform,
    params: &StandOffParams,
) -> Result<StandOff, StandOffError> {
    let cloud = &reference.cloud;
    let (Some(normals), Some((low, high))) = (&cloud.normals, cloud.bounds()) else {
        return Err(StandOffError::NoSurface);
    };
    let surface = ReferenceSurface::of(reference).ok_or(StandOffError::NoSurface)?;
    let middle = nalgebra::center(&low, &high);
    let sees = |p: &Point3<f32>, normal: &Vector3<f32>| {
        let at = camera_from_part * p.cast::<f64>();
        let facing = -(camera_from_part * normal.cast::<f64>()).dot(&at.coords);
        facing > MIN_SEEN_COSINE * at.coords.norm()
    };
    let seen: Vec<(&Point3<f32>, &Vector3<f32>)> = cloud
        .points
        .iter()
        .zip(normals)
        .filter(|(p, normal)| sees(p, normal))
        .collect();
    let taught = sample_evenly(&seen, params.num_rays);
    let num_taught = taught.len();
    let part_from_camera: Isometry3<f32> = camera_from_part.inverse().cast();
    let met: Vec<(f32, NozzleRay)> = taught
        .filter_map(|(s, n)| {
            // At a metre f32 resolves micrometres, far finer than needed.
            let d0 = params.taught.0 as f32;
            let ray = Ray {
                mouth: part_from_camera * (*s + *n * d0),
                direction: -(part_from_camera * *n),
            };
            let (distance, normal) = ray.intersect(&surface, d0)?;
            let mouth = (**s + *n * d0).cast::<f64>();
            let direction = -n.cast::<f64>();
            let cosine = f64::from(-ray.direction.dot(&normal));
            let found = NozzleRay {
                mouth,
                direction,
                surface: mouth + direction * f64::from(distance),
                distance: Metres(f64::from(distance)),
                angle: Radians(cosine.clamp(-1.0, 1.0).acos()),
            };
            Some(((*s - middle).norm_squared(), found))
        })
        .collect();
    summary(&met, num_taught, params).ok_or(StandOffError::NoneMeets { num_taught })
}

/// `None` without a ray. Each ray comes with the squared distance of its taught point from the part's middle.
fn summary(
    met: &[(f32, NozzleRay)],
    num_taught: usize,
    params: &StandOffParams,
) -> Option<StandOff> {
    let off = |ray: &NozzleRay| (ray.distance.0 - params.taught.0).abs();
    let (_, worst) = met.iter().max_by(|a, b| off(&a.1).total_cmp(&off(&b.1)))?;
    let (_, middle) = met.iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    let rays: Vec<NozzleRay> = met.iter().map(|met| met.1).collect();
    let num = rays.len() as f64;
    let band = params.nearest..=params.farthest;
    let num_inside = rays
        .iter()
        .filter(|ray| band.contains(&ray.distance))
        .count();
    let angles = rays.iter().map(|ray| ray.angle.0);
    Some(StandOff {
        mean: Metres(rays.iter().map(|ray| ray.distance.0).sum::<f64>() / num),
        worst: *worst,
        middle: *middle,
        in_band: num_inside as f64 / num_taught as f64,
        mean_angle: Radians(angles.clone().sum::<f64>() / num),
        worst_angle: Radians(angles.fold(0.0, f64::max)),
        num_taught,
        rays,
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::{Translation3, UnitQuaternion};

    use super::*;
    use crate::fixtures::plate;

    fn at(pose: &RigidTransform) -> StandOff {
        stand_off(&plate(), pose, &StandOffParams::default()).expect("a stand-off")
    }

    /// Rotation about the vertical axis through the plate's middle.
    fn turned(angle: f64) -> RigidTransform {
        let middle = Translation3::new(0.0, 0.0, 1.2);
        middle * UnitQuaternion::from_axis_angle(&Vector3::y_axis(), angle) * middle.inverse()
    }

    #[test]
    fn at_the_standard_position_every_distance_is_the_taught_one() {
        let found = at(&RigidTransform::identity());
        assert_eq!(found.rays.len(), found.num_taught);
        assert!((found.mean.mm() - 150.0).abs() < 0.01, "{}", found.mean);
        assert!((found.worst.distance.mm() - 150.0).abs() < 0.01);
        assert!(found.worst_angle.degrees() < 0.1);
        assert!(found.keeps_the_band() && (found.in_band - 1.0).abs() < 1e-12);
        // The middle ray is in front of the plate's middle.
        assert!(found.middle.surface.coords.xy().norm() < 0.03);
        assert!((found.middle.mouth.z - 1.05).abs() < 1e-4);
    }

    #[test]
    fn a_shift_along_the_normal_changes_every_distance_by_as_much() {
        for (z, expected) in [(0.03, 180.0), (-0.03, 120.0), (-0.16, -10.0)] {
            let found = at(&RigidTransform::translation(0.0, 0.0, z));
            assert!((found.mean.mm() - expected).abs() < 0.05, "{}", found.mean);
            assert!((found.worst.distance.mm() - expected).abs() < 0.05);
            // In camera space the nozzle stays and the surface moves.
            assert!((found.worst.mouth.z - 1.05).abs() < 1e-4);
            assert!((found.worst.surface.z - 1.2 - z).abs() < 1e-4);
        }
    }

    #[test]
    fn the_band_decides_what_is_inside() {
        assert!((at(&RigidTransform::translation(0.0, 0.0, 0.049)).in_band - 1.0).abs() < 1e-12);
        let outside = at(&RigidTransform::translation(0.0, 0.0, 0.051));
        assert!(outside.in_band < 1e-12 && !outside.keeps_the_band());
        let wider = StandOffParams {
            farthest: Metres(0.21),
            ..StandOffParams::default()
        };
        let found = stand_off(
            &plate(),
            &RigidTransform::translation(0.0, 0.0, 0.051),
            &wider,
        )
        .expect("a stand-off");
        assert!(found.keeps_the_band());
    }

    #[test]
    fn a_turn_about_the_middle_keeps_the_mean_and_tilts_every_normal() {
        let angle = 6.0_f64.to_radians();
        let found = at(&turned(angle));
        assert!((found.mean.mm() - 150.0).abs() < 2.0, "{}", found.mean);
        assert!((found.mean_angle.degrees() - 6.0).abs() < 0.05);
        assert!((found.worst_angle.degrees() - 6.0).abs() < 0.05);
        for ray in &found.rays {
            // Distance to the turned plane through the middle, at the nozzle's x.
            let expected = 0.15 - ray.mouth.x * angle.tan();
            assert!((ray.distance.0 - expected).abs() < 2e-4);
        }
        let most = 0.4 * angle.tan();
        assert!((found.worst.distance.0 - 0.15).abs() > 0.95 * most);
    }

    #[test]
    fn a_ray_past_the_part_is_outside_the_band() {
        // Shifted by a quarter of the plate's width: a quarter of the rays miss.
        let found = at(&RigidTransform::translation(0.2, 0.0, 0.0));
        let met = found.rays.len() as f64 / found.num_taught as f64;
        assert!((met - 0.75).abs() < 0.03, "{met}");
        assert!((found.in_band - met).abs() < 1e-12);
        assert!(!found.keeps_the_band());
        let pose = RigidTransform::translation(2.0, 0.0, 0.0);
        let error = stand_off(&plate(), &pose, &StandOffParams::default());
        assert!(matches!(error, Err(StandOffError::NoneMeets { num_taught }) if num_taught > 0));
    }

    #[test]
    fn a_flat_shape_has_no_stand_off() {
        let mut flat = plate();
        std::sync::Arc::make_mut(&mut flat.cloud).normals = None;
        let pose = RigidTransform::identity();
        let found = stand_off(&flat, &pose, &StandOffParams::default());
        assert_eq!(found, Err(StandOffError::NoSurface));
    }
}
