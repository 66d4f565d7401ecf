//! The viewpoints of a reference, and what is visible from them.

use nalgebra::{Point3, Unit, UnitQuaternion, Vector3};

use super::Coverage;
use geometry::{cloud::PointCloud, principal::principal_axes, statistics::even_directions};

/// Rotations of the viewpoint about the part's short and long axis, degrees. The first is the standard view; together
/// they cover ±30° by ±20°, so that no scene is more than about 15° from a view.
const TURNS_DEG: [[f64; 2]; 9] = [
    [0.0, 0.0],
    [25.0, 0.0],
    [-25.0, 0.0],
    [0.0, 20.0],
    [0.0, -20.0],
    [20.0, 16.0],
    [20.0, -16.0],
    [-20.0, 16.0],
    [-20.0, -16.0],
];

/// Distance of a virtual camera from the part's centre, metres; nearly parallel rays, as for a part that fills the picture.
pub(super) const VIEW_DISTANCE_M: f64 = 1.3;

/// Returns the viewpoints for a cloud, part space.
pub(super) fn viewpoints(cloud: &PointCloud, coverage: Coverage) -> Option<Vec<Point3<f64>>> {
    let principal = principal_axes(cloud.finite().map(|(_, p)| (p.cast(), 1.0)))?;
    let (long, short, across) = (
        Unit::new_normalize(principal.axes.column(0).into_owned()),
        Unit::new_normalize(principal.axes.column(1).into_owned()),
        principal.axes.column(2).into_owned(),
    );
    let fronts: Vec<Vector3<f64>> = match coverage {
        Coverage::OneSide => vec![-principal.mean.coords.normalize()],
        Coverage::AllAround => {
            // The standard view is from where most of the surface faces, if it has a front.
            let normals = cloud.normals.iter().flatten();
            let facing: f64 = normals.map(|n| n.cast::<f64>().dot(&across)).sum();
            let front = if facing < 0.0 { -across } else { across };
            vec![front, -front]
        }
        Coverage::SeveralSides => {
            let directions = seen_directions(cloud);
            let places = directions
                .iter()
                .map(|direction| principal.mean + direction * VIEW_DISTANCE_M);
            return Some(places.collect()).filter(|places: &Vec<_>| !places.is_empty());
        }
    };
    let around = |front: &Vector3<f64>| {
        let front = *front;
        TURNS_DEG.map(|[about_short, about_long]| {
            let turn = UnitQuaternion::from_axis_angle(&short, f64::to_radians(about_short))
                * UnitQuaternion::from_axis_angle(&long, f64::to_radians(about_long));
            principal.mean + turn * front * VIEW_DISTANCE_M
        })
    };
    Some(fronts.iter().flat_map(around).collect())
}

/// Number of directions to try, evenly distributed over the sphere: about 7° apart.
const NUM_DIRECTIONS: usize = 800;
/// Number of normals used to rate a direction.
const NUM_NORMALS: usize = 2000;
/// Minimum area visible from a viewpoint, as a share of the largest visible from any direction.
const LEAST_SHOWN: f64 = 0.55;
/// Minimum angle between views, radians: no scene is then more than about 15° from one.
const VIEWS_APART_RAD: f64 = 0.40;
/// Maximum number of views of a scan.
const MAX_VIEWS: usize = 24;

/// Returns the directions that show much of the surface, whose normals point to the cameras that saw it; the first
/// shows the most.
fn seen_directions(cloud: &PointCloud) -> Vec<Vector3<f64>> {
    let normals = cloud.normals.as_deref().unwrap_or_default();
    let step = (normals.len() / NUM_NORMALS).max(1);
    let normals: Vec<Vector3<f32>> = normals.iter().step_by(step).copied().collect();
    let mut shown: Vec<(f32, Vector3<f64>)> = even_directions(NUM_DIRECTIONS)
        .map(|direction| {
            let towards = direction.cast::<f32>();
            let area = normals.iter().map(|n| n.dot(&towards).max(0.0)).sum();
            (area, direction)
        })
        .collect();
    shown.sort_by(|a, b| b.0.total_cmp(&a.0));
    let most = shown.first().map_or(0.0, |first| f64::from(first.0));
    let mut kept: Vec<Vector3<f64>> = Vec::new();
    for (area, direction) in shown {
        if f64::from(area) < LEAST_SHOWN * most || most <= 0.0 || kept.len() == MAX_VIEWS {
            break;
        }
        if kept
            .iter()
            .all(|other| other.angle(&direction) > VIEWS_APART_RAD)
        {
            kept.push(direction);
        }
    }
    kept
}

/// Returns the viewpoints, each with the points visible from there.
pub fn seen_around(cloud: &PointCloud, coverage: Coverage) -> Vec<(Point3<f64>, PointCloud)> {
    let Some(bounds) = cloud.bounds() else {
        return Vec::new();
    };
    let seen_from = |viewpoint: Point3<f64>| {
        let visible = visible_from(cloud, bounds, &viewpoint);
        let normals = cloud.normals.as_ref();
        let seen = PointCloud {
            points: visible.iter().map(|v| cloud.points[v.0]).collect(),
            normals: normals.map(|all| visible.iter().map(|v| all[v.0]).collect()),
            ..PointCloud::default()
        };
        (viewpoint, seen)
    };
    let places = viewpoints(cloud, coverage).unwrap_or_default();
    places.into_iter().map(seen_from).collect()
}

/// Cell size of the view's depth buffer, metres: larger than the spacing of a reference cloud.
const CELL_M: f32 = 0.015;
/// Depth behind the nearest surface of a cell up to which a point is still visible, metres.
const CELL_DEPTH_M: f32 = 0.04;

/// Returns the indices of the points visible to a camera at `viewpoint`, each with the cosine of its viewing angle.
///
/// `bounds` are the bounds of the cloud.
pub(super) fn visible_from(
    cloud: &PointCloud,
    (low, high): (Point3<f32>, Point3<f32>),
    viewpoint: &Point3<f64>,
) -> Vec<(usize, f64)> {
    // In f32: everything is within metres, and a cell is centimetres.
    let viewpoint: Point3<f32> = viewpoint.cast();
    let centre = nalgebra::center(&low, &high);
    let forward = (centre - viewpoint).normalize();
    let helper = if forward.x.abs() < 0.9 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    let right = forward.cross(&helper).normalize();
    let down = forward.cross(&right);
    let radius = (high - low).norm() / 2.0 + CELL_M;
    let side = (2.0 * radius / CELL_M).ceil() as usize + 1;
    let mut nearest = vec![f32::INFINITY; side * side];
    // A depth camera gets almost no readings from surfaces tilted by more than 80°.
    let is_seen = |i: usize, towards: &Vector3<f32>| {
        let facing = cloud
            .normals
            .as_ref()
            .map(|normals| normals[i].dot(towards));
        facing.is_none_or(|f| f > 0.0 && f * f > 0.17 * 0.17 * towards.norm_squared())
    };
    let cell = |along: f32| ((along + radius) * (1.0 / CELL_M)) as i32 as usize;
    let mut candidates: Vec<(u32, u32, f32)> = Vec::with_capacity(cloud.points.len());
    for (i, p) in cloud
        .finite()
        .filter(|(i, p)| is_seen(*i, &(viewpoint - *p)))
    {
        let d = p - centre;
        let cell = cell(d.dot(&down)) * side + cell(d.dot(&right));
        let depth = d.dot(&forward);
        nearest[cell] = nearest[cell].min(depth);
        candidates.push((i as u32, cell as u32, depth));
    }
    let seen = |&(i, cell, depth): &(u32, u32, f32)| {
        let i = i as usize;
        let towards = viewpoint - cloud.points[i];
        let facing = |normals: &Vec<Vector3<f32>>| normals[i].dot(&towards) / towards.norm();
        let facing = cloud.normals.as_ref().map_or(1.0, facing);
        (depth <= nearest[cell as usize] + CELL_DEPTH_M).then_some((i, f64::from(facing)))
    };
    let mut visible = Vec::with_capacity(candidates.len());
    visible.extend(candidates.iter().filter_map(seen));
    visible
}
