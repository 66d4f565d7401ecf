//! The nozzle poses for the part as it hangs now: the part's stored path, carried by the found pose.
//!
//! The path is stored in part space. The pose `camera_from_part` carries it to where the part is now, and the cell's
//! calibration from there into the robot's base frame. Each point is then compared with the part *as the camera sees
//! it*: how far the surface is along the nozzle's ray, and at which angle the ray meets it. This reveals a bent part,
//! another model or a wrong pose; the enrolled surface could not, since carrying a path does not change its distance to
//! it.
//!
//! The tool's frame: the origin is the nozzle's mouth, z the direction of the nozzle (towards the part), x along the
//! long side of the fan or, for a round jet, as close as possible to the part's own x axis, y = z × x. A round jet
//! leaves the rotation about z free, and a fan its sign; this choice turns with the part and does not spin from point to
//! point.
//!
//! Source of the band: the paper's section V-B, eq. 14 (10 to 20 cm, normal at the nozzle). It gives no limit for the
//! angle; ours is [`MOST_TILT`].
//!
//! A path that does not aim at the part is found without the camera, because a part may be half hidden: its nozzle does
//! not meet the enrolled surface, or not near its own stand-off, or is on or behind that surface ([`off_the_part`]). Most
//! paths of another part do, since all parts hang at about the same place.
//!
//! Known limits: where the camera does not see the part, because something is in front of it or it faces away, nothing
//! can be compared; such points are [`BandStatus::NotSeen`]. Reach and collisions of the arm are not checked here.

mod export;
#[cfg(test)]
mod tests;

use std::f64::consts::PI;

use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};

use geometry::{
    cloud::PointCloud,
    rigid::RigidTransform,
    statistics::median,
    units::{Metres, Radians},
};
use inspection::library::{PathPoint, SprayPath};
use stages::{
    reference::Reference,
    stand_off::{
        StandOffParams,
        ray::{Ray, ReferenceSurface, SeenSurface},
    },
};
use texts::{Described, Message};

pub use self::export::{SprayExport, remove_previous_export};

/// Largest angle between ray and surface normal; beyond it a coat is uneven.
pub const MOST_TILT: Radians = Radians(std::f64::consts::FRAC_PI_6);

/// A path that was carried to the part as it hangs now.
#[derive(Clone, Debug, PartialEq)]
pub struct CarriedPath {
    /// The points, in the path's order.
    pub points: Vec<CarriedPoint>,
}

/// One pose of the nozzle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedPoint {
    /// Pose of the tool in camera space: origin at the mouth, z towards the part.
    pub camera_from_nozzle: RigidTransform,
    /// Where the ray meets the surface that the camera saw, if it does.
    pub meets: Option<SurfaceHit>,
    /// The point's status against the band.
    pub band: BandStatus,
    /// True if the gun sprays from here to the next point.
    pub is_gun_on: bool,
    /// Speed from here to the next point, m/s, where the path sets one.
    pub speed: Option<f64>,
    /// True if the jet is round, so that the nozzle may turn about its z axis.
    pub is_round: bool,
}

/// Where a ray meets the part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceHit {
    /// Distance from the nozzle to the surface.
    pub distance: Metres,
    /// Angle between the ray and the surface's normal, 0..80°.
    pub tilt: Radians,
}

/// The status of a nozzle against the band.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BandStatus {
    /// Within the band, and the tilt is small enough.
    Inside,
    /// Nearer than the band, or inside the part.
    TooNear,
    /// Farther than the band.
    TooFar,
    /// Within the band, but the ray meets the surface at too flat an angle.
    TooFlat,
    /// The camera saw no surface in front of the nozzle: it points past the part, or the surface is hidden or faces
    /// away.
    NotSeen,
}

impl BandStatus {
    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Inside => "inside",
            Self::TooNear => "too_near",
            Self::TooFar => "too_far",
            Self::TooFlat => "too_flat",
            Self::NotSeen => "not_seen",
        }
    }
}

impl CarriedPoint {
    /// Position of the nozzle's mouth, camera space, metres.
    pub fn mouth(&self) -> Point3<f64> {
        self.camera_from_nozzle.translation.vector.into()
    }

    /// Direction of the nozzle, camera space, unit length.
    pub fn direction(&self) -> Vector3<f64> {
        self.camera_from_nozzle * Vector3::z()
    }
}

impl CarriedPath {
    /// Number of points that aim at what the camera sees of the part; only they can be checked.
    pub fn num_seen(&self) -> usize {
        self.points.len() - self.count(BandStatus::NotSeen)
    }

    /// Median distance from the nozzle to the surface where the camera sees it; that of the band's middle if nowhere.
    pub fn stand_off(&self) -> f64 {
        let hits = self.points.iter().filter_map(|point| point.meets);
        let middle = median(hits.map(|hit| hit.distance.0));
        middle.unwrap_or(StandOffParams::default().taught.0)
    }

    /// Number of points within the band.
    pub fn num_inside(&self) -> usize {
        self.count(BandStatus::Inside)
    }

    /// Number of points with this status.
    pub fn count(&self, band: BandStatus) -> usize {
        self.points
            .iter()
            .filter(|point| point.band == band)
            .count()
    }
}

/// Carries a path to a part with this pose; `seen` is what the camera saw of the part, camera space.
pub fn carry(
    path: &SprayPath,
    camera_from_part: &RigidTransform,
    seen: &PointCloud,
    params: &StandOffParams,
) -> CarriedPath {
    let seen = SeenSurface::of(seen);
    let surface = seen.surface();
    let nozzles = nozzle_frames(path);
    let points = path.points().iter().zip(&nozzles);
    let points = points.map(|(point, part_from_nozzle)| {
        let camera_from_nozzle = camera_from_part * part_from_nozzle;
        let expected = point.stand_off.unwrap_or(params.taught);
        let meets = meeting(&camera_from_nozzle, &surface, expected);
        CarriedPoint {
            camera_from_nozzle,
            meets,
            band: band_of(meets, params),
            is_gun_on: point.is_gun_on,
            speed: point.speed,
            is_round: point.fan.is_none(),
        }
    });
    CarriedPath {
        points: points.collect(),
    }
}

/// Returns the tool's frame at each point of a path, `part_from_nozzle`.
pub fn nozzle_frames(path: &SprayPath) -> Vec<RigidTransform> {
    let mut before: Option<Vector3<f64>> = None;
    let frames = path.points().iter().map(|point| {
        let mut part_from_nozzle = tool_frame(point);
        // A fan turned by 180° is the same fan: choose the sign that keeps the nozzle from turning.
        if point.fan.is_some() {
            let x = part_from_nozzle * Vector3::x();
            if before.is_some_and(|before| before.dot(&x) < 0.0) {
                part_from_nozzle *= UnitQuaternion::from_euler_angles(0.0, 0.0, PI);
            }
            before = Some(part_from_nozzle * Vector3::x());
        }
        part_from_nozzle
    });
    frames.collect()
}

/// Compares a path that is about to be stored with the part as it was enrolled.
pub fn against_reference(
    path: &SprayPath,
    reference: &Reference,
    params: &StandOffParams,
) -> Vec<BandStatus> {
    let Some(surface) = ReferenceSurface::of(reference) else {
        return vec![BandStatus::NotSeen; path.points().len()];
    };
    let bands = path.points().iter().map(|point| {
        let expected = point.stand_off.unwrap_or(params.taught);
        band_of(meeting(&tool_frame(point), &surface, expected), params)
    });
    bands.collect()
}

/// A path that does not belong to the part with which it is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error, serde::Serialize)]
pub struct OffThePart {
    /// Number of points with the gun on.
    pub num_spraying: usize,
    /// Number of those that aim at the part.
    pub num_aiming: usize,
    /// Number of those whose nozzle is less than 20 mm in front of the part, or behind its surface, if this is why the
    /// path is refused; otherwise 0.
    pub num_too_near: usize,
}

impl Described for OffThePart {
    fn message(&self) -> Message {
        let message = Message::new("doubt-off-the-part").with_fields(self);
        message.with("least_m", MIN_DISTANCE_M)
    }
}

texts::display!(OffThePart);

/// Minimum share of the points with the gun on that aim at the part. It is low because a gun also sprays beyond edges and
/// over openings: of the points planned over the shipped parts, 40 to 70 % aim at them, and 13 % with an overrun of 400 mm.
const MIN_AIMING_SHARE: f64 = 0.05;
/// Minimum share of the points that meet the part which do so at about their stand-off. Planned paths have 98 % or more.
const MIN_AT_STAND_OFF_SHARE: f64 = 0.5;
/// A stand-off may be off by half of it, or by this, metres, if that is more.
const MIN_STAND_OFF_SLACK_M: f64 = 0.05;
/// Minimum distance of the nozzle from the surface in front of it, metres. Nobody sprays from nearer: such positions are
/// probably those of the surface.
const MIN_DISTANCE_M: f64 = 0.02;
/// Maximum share of the points that meet the part whose nozzle is nearer than that. Of the points planned over the shipped
/// parts with the least stand-off of a coat, 30 mm, up to 4.4 % are, from 40 mm on none.
const MAX_TOO_NEAR_SHARE: f64 = 0.05;

/// Where a path names no stand-off, the surface is looked for as well around this distance: up to 1.15 m.
const FAR_STAND_OFF: Metres = Metres(0.75);

/// Compares a path with the part as it was enrolled; `None` if it belongs to it, or if the part has no normals. Where the
/// path names no stand-off, any distance from 20 mm on will do.
pub fn off_the_part(path: &SprayPath, reference: &Reference) -> Option<OffThePart> {
    let surface = ReferenceSurface::of(reference)?;
    let taught = StandOffParams::default().taught;
    let points = path.points();
    // A path that never sprays is judged by all of its points.
    let sprays = points.iter().any(|point| point.is_gun_on);
    let (mut num_spraying, mut num_met) = (0_usize, 0_usize);
    let (mut num_aiming, mut num_too_near) = (0_usize, 0_usize);
    for point in points.iter().filter(|point| point.is_gun_on || !sprays) {
        num_spraying += 1;
        let nozzle = tool_frame(point);
        let met = match point.stand_off {
            Some(expected) => meeting(&nozzle, &surface, expected),
            None => meeting(&nozzle, &surface, taught)
                .or_else(|| meeting(&nozzle, &surface, FAR_STAND_OFF)),
        };
        let Some(met) = met else {
            continue;
        };
        num_met += 1;
        if met.distance.0 < MIN_DISTANCE_M {
            num_too_near += 1;
            continue;
        }
        let is_at_stand_off = point.stand_off.is_none_or(|taught| {
            (met.distance.0 - taught.0).abs() <= MIN_STAND_OFF_SLACK_M.max(0.5 * taught.0)
        });
        num_aiming += usize::from(is_at_stand_off);
    }
    if num_too_near as f64 <= MAX_TOO_NEAR_SHARE * num_met as f64 {
        num_too_near = 0;
    }
    let is_off = num_too_near > 0
        || (num_aiming as f64) < MIN_AIMING_SHARE * num_spraying as f64
        || (num_aiming as f64) < MIN_AT_STAND_OFF_SHARE * num_met as f64;
    is_off.then_some(OffThePart {
        num_spraying,
        num_aiming,
        num_too_near,
    })
}

/// The default for a part without a stored path: one nozzle at the taught distance, on the normal of the point nearest
/// to the part's middle. `None` if the part has no normals.
pub fn default_path(reference: &Reference, params: &StandOffParams) -> Option<SprayPath> {
    let cloud = &reference.cloud;
    let (low, high) = cloud.bounds()?;
    let middle = nalgebra::center(&low, &high);
    let (at, normal) = cloud
        .points
        .iter()
        .zip(cloud.normals.as_ref()?)
        .min_by(|a, b| {
            (a.0 - middle)
                .norm_squared()
                .total_cmp(&(b.0 - middle).norm_squared())
        })?;
    let normal = nalgebra::Unit::try_new(normal.cast::<f64>(), 1e-6)?;
    SprayPath::new(vec![PathPoint {
        nozzle: at.cast::<f64>() + normal.into_inner() * params.taught.0,
        direction: -normal,
        stand_off: Some(params.taught),
        is_gun_on: true,
        speed: None,
        fan: None,
    }])
}

/// Returns the tool's frame: z along the direction; x along the fan's long side, on the side of the part's x, or for a
/// round jet as close as possible to the part's x. If that x is along the nozzle or across the fan, the part's y takes
/// its place.
fn tool_frame(point: &PathPoint) -> RigidTransform {
    /// Cosine of 20°.
    const ALONG_MIN_COSINE: f64 = 0.94;
    let z = point.direction.into_inner();
    if let Some(fan) = point.fan {
        /// Cosine of 80°: nearer to 90°, the sign could change from point to point.
        const ACROSS_MAX_COSINE: f64 = 0.17;
        let sign = if fan.x.abs() > ACROSS_MAX_COSINE {
            fan.x
        } else {
            fan.y
        };
        let x = fan.into_inner() * sign.signum();
        return framed(point, z, x);
    }
    let near = if z.x.abs() < ALONG_MIN_COSINE {
        Vector3::x()
    } else {
        Vector3::y()
    };
    framed(point, z, (near - z * z.dot(&near)).normalize())
}

/// The frame at the nozzle with these perpendicular axes.
fn framed(point: &PathPoint, z: Vector3<f64>, x: Vector3<f64>) -> RigidTransform {
    let axes = Matrix3::from_columns(&[x, z.cross(&x), z]);
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    Isometry3::from_parts(Translation3::from(point.nozzle.coords), rotation)
}

/// Returns where the ray of a nozzle meets a surface; both in the same space.
fn meeting(
    nozzle: &RigidTransform,
    surface: &ReferenceSurface<'_>,
    expected: Metres,
) -> Option<SurfaceHit> {
    let mouth: Point3<f64> = nozzle.translation.vector.into();
    let ray = Ray {
        // f32 resolves a metre to micrometres, far finer than a nozzle needs.
        mouth: mouth.cast(),
        direction: (nozzle * Vector3::z()).cast(),
    };
    let (distance, normal) = ray.intersect(surface, expected.0 as f32)?;
    let cosine = f64::from(-ray.direction.dot(&normal));
    Some(SurfaceHit {
        distance: Metres(f64::from(distance)),
        tilt: Radians(cosine.clamp(-1.0, 1.0).acos()),
    })
}

fn band_of(meets: Option<SurfaceHit>, params: &StandOffParams) -> BandStatus {
    match meets {
        None => BandStatus::NotSeen,
        Some(met) if met.distance < params.nearest => BandStatus::TooNear,
        Some(met) if met.distance > params.farthest => BandStatus::TooFar,
        Some(met) if met.tilt > MOST_TILT => BandStatus::TooFlat,
        Some(_) => BandStatus::Inside,
    }
}
