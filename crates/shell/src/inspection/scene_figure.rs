//! Data of the 3-D view of a result, made once in the task: points with their deviations, and lines for axes, camera, outline,
//! nozzles and spray path.

use std::sync::Arc;

use glam::Vec3;
use nalgebra::{Isometry3, Point3, Vector3};

use crate::inspection::scan::ScanFigure;
use geometry::{rigid::RigidTransform, units::Metres};
use inspection::pipeline::Inspection;
use robot::spray::{BandStatus, CarriedPath};
use stages::{
    contour::lift_border,
    deviation::{Deviation, DeviationRegion, PatchDeviation},
    pose::PoseEstimate,
    reference::{Reference, ReferenceView},
    scene::SceneCloud,
    segment::PointLabel,
    stand_off::{NozzleRay, StandOff},
};
use ui::viewport::{Line, LineSet, PointSet, Role, furniture, vec3};

/// Points and lines of one result, camera frame; `None` for what the result does not have.
#[derive(Clone, Debug)]
pub struct SceneFigure {
    /// The scene, with label and deviation of each point.
    pub points: PointSet,
    /// What its points stand for.
    pub roles: Vec<Role>,
    /// True if at least one point has a deviation.
    pub has_deviations: bool,
    /// Axes at the part's middle, if it was found.
    pub axes: Option<LineSet>,
    /// Frustum of the depth camera.
    pub camera: Option<LineSet>,
    /// Outline and openings of the reference at the found pose.
    pub outline: Option<LineSet>,
    /// The assumed nozzle over the part's middle, and the one with the largest error of its stand-off; none if a path is
    /// stored.
    pub nozzles: Option<[NozzleFigure; 2]>,
    /// The part's stored spray path, if there is one.
    pub spray: Option<SprayFigure>,
    /// The regions of the part's surface that deviate, in the order of its check.
    pub regions: Vec<RegionFigure>,
}

/// A region of the surface that deviates, with a ring around it.
#[derive(Clone, Debug)]
pub struct RegionFigure {
    /// The ring.
    pub lines: LineSet,
    /// Its uppermost point, for the text, metres.
    pub top: Vec3,
}

/// A spray path carried to the found pose.
#[derive(Clone, Debug)]
pub struct SprayFigure {
    /// The path of the nozzle tip, and each nozzle's ray: solid up to the surface if in the band, else dashed and marked by a
    /// cross. A long path, dashed where the gun is off, has rays only where the camera sees that it leaves the band.
    pub lines: LineSet,
    /// The first position of the nozzle tip, metres.
    pub start: Vec3,
    /// Number of points in the band.
    pub num_inside: usize,
    /// Number of points that the camera could check.
    pub num_seen: usize,
}

/// A nozzle in front of the part.
#[derive(Clone, Debug)]
pub struct NozzleFigure {
    /// Nozzle and ray.
    pub lines: LineSet,
    /// Nozzle tip, metres.
    pub mouth: Vec3,
    /// Distance from there to the part; below 0 if the nozzle is in or behind it.
    pub distance: Metres,
}

/// What a [`SceneFigure`] is made from.
pub(crate) struct SceneFigureInput<'a> {
    pub scene: &'a SceneCloud,
    /// The figure of a scan, whose points replace the scene's.
    pub scan: Option<&'a ScanFigure>,
    pub inspection: &'a Inspection,
    /// The best reference, if the part is called by its name.
    pub reference: Option<&'a Reference>,
    /// Middle of its extent, part frame, metres.
    pub middle: Option<Point3<f64>>,
    pub deviations: &'a [f32],
    pub stand_off: Option<&'a StandOff>,
    pub spray: Option<&'a CarriedPath>,
}

impl SceneFigure {
    /// Makes the figure; goes through every point.
    pub(crate) fn of(given: &SceneFigureInput<'_>) -> Self {
        let SceneFigureInput {
            scene,
            scan,
            inspection,
            reference,
            middle,
            deviations,
            stand_off,
            spray,
        } = given;
        let labels = scan.map_or(&inspection.segmentation.labels, |scan| &scan.labels);
        let mut points = if let Some(scan) = scan {
            PointSet::segmented(Arc::clone(&scan.positions), labels)
        } else {
            let points = scene.cloud.points.iter();
            let positions: Vec<[f32; 3]> = points.map(|p| [p.x, p.y, p.z]).collect();
            PointSet::segmented(positions, labels)
        };
        let has_deviations = !deviations.is_empty();
        if has_deviations {
            points = points.with_deviations(*deviations);
        }
        let points = points.packed();
        let pose = inspection.pose.as_ref().and_then(|pose| pose.as_ref().ok());
        let camera_from_part = pose.map(PoseEstimate::camera_from_part);
        let axes = camera_from_part.zip(*middle).map(|(pose, middle)| {
            let shift = nalgebra::Translation3::from(middle.coords);
            furniture::axes(Metres(0.15)).at(&(pose * shift))
        });
        // A scan shows the cameras of all its shots instead.
        let camera = scene.intrinsics.as_ref().filter(|_| scan.is_none());
        let placed = inspection.ranking.entries.first();
        let view = placed.and_then(|entry| entry.placements.first());
        let view = reference.and_then(|reference| reference.views.get(view?.view));
        Self {
            roles: roles_of(labels),
            has_deviations,
            axes,
            camera: camera.map(|camera| furniture::frustum(camera, Metres(0.25))),
            outline: view
                .zip(camera_from_part)
                .and_then(|(view, pose)| outline(view, &pose)),
            nozzles: stand_off
                .filter(|_| spray.is_none())
                .map(|found| [&found.middle, &found.worst].map(NozzleFigure::of)),
            spray: spray.and_then(SprayFigure::of),
            regions: regions(inspection),
            points,
        }
    }
}

fn regions(inspection: &Inspection) -> Vec<RegionFigure> {
    let check = inspection.surface.as_ref();
    let measured = check.and_then(|check| Some((check, check.deviation.as_ref()?)));
    let Some((check, deviation)) = measured else {
        return Vec::new();
    };
    let regions = check.regions.iter();
    let figures = regions.map(|judged| RegionFigure::of(deviation, &judged.region));
    figures.collect()
}

impl RegionFigure {
    fn of(deviation: &Deviation, region: &DeviationRegion) -> Self {
        /// The ring is larger than the region by this factor, and has at least this radius, metres.
        const AROUND: f64 = 1.3;
        const LEAST_RADIUS: f64 = 0.012;
        /// Before the surface, so that its points do not cover it, metres.
        const BEFORE: f64 = 0.003;
        const NUM_CORNERS: usize = 32;
        let camera_from_part = deviation.part_from_camera.inverse();
        let centre = camera_from_part * region.centre;
        let distance =
            |patch: &&PatchDeviation| (patch.at.cast::<f64>() - region.centre).norm_squared();
        let nearest = (deviation.patches.iter())
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .map_or_else(Vector3::zeros, |patch| patch.normal.cast::<f64>());
        let normal = (camera_from_part * nearest)
            .try_normalize(0.5)
            .unwrap_or_else(|| -Vector3::z());
        let radius = (AROUND * (region.area_m2 / std::f64::consts::PI).sqrt()).max(LEAST_RADIUS);
        let axis = vec3(&normal.into());
        let (across, up) = axis.any_orthonormal_pair();
        let middle = vec3(&(centre + normal * BEFORE));
        let corners = (0..=NUM_CORNERS).map(|corner| {
            let turn = std::f32::consts::TAU * corner as f32 / NUM_CORNERS as f32;
            middle + (across * turn.cos() + up * turn.sin()) * radius as f32
        });
        let corners: Vec<Vec3> = corners.collect();
        // The camera's y points down.
        let top = corners.iter().copied().min_by(|a, b| a.y.total_cmp(&b.y));
        Self {
            top: top.unwrap_or(middle),
            lines: LineSet::new(vec![Line::new(corners, Role::AxisX).with_width(2.5)]),
        }
    }
}

/// The roles of these points, without those that are not drawn.
fn roles_of(labels: &[PointLabel]) -> Vec<Role> {
    let mut occurs = [false; Role::ALL.len()];
    let drawn = labels.iter();
    for label in drawn.filter(|label| **label != PointLabel::NoReading) {
        occurs[Role::of(*label) as usize] = true;
    }
    let all = Role::ALL.into_iter().zip(occurs);
    all.filter_map(|(role, occurs)| occurs.then_some(role))
        .collect()
}

impl SprayFigure {
    fn of(path: &CarriedPath) -> Option<Self> {
        /// Drawn length of a ray that meets nothing, metres.
        const UNMET: f32 = 0.15;
        /// Half size of the cross at a nozzle out of the band, metres.
        const CROSS: f32 = 0.008;
        /// The rays of more points would hide the part.
        const MOST_RAYS: usize = 150;
        let mouths: Vec<Vec3> = path.points.iter().map(|p| vec3(&p.mouth())).collect();
        let start = *mouths.first()?;
        let is_long = path.points.len() > MOST_RAYS;
        let mut lines = if is_long {
            strokes(path, &mouths)
        } else {
            vec![Line::new(mouths.clone(), Role::Nozzle).with_width(1.2)]
        };
        for (point, &mouth) in path.points.iter().zip(&mouths) {
            if is_long && matches!(point.band, BandStatus::Inside | BandStatus::NotSeen) {
                continue;
            }
            let along = vec3(&point.direction().into());
            let length = point.meets.map_or(UNMET, |met| met.distance.0 as f32);
            let ray = Line::new([mouth, mouth + along * length], Role::Nozzle);
            if point.band == BandStatus::Inside {
                lines.push(ray);
                continue;
            }
            lines.push(ray.dashed());
            let (across, up) = along.any_orthonormal_pair();
            for arm in [across + up, across - up] {
                let ends = [mouth - arm * CROSS, mouth + arm * CROSS];
                lines.push(Line::new(ends, Role::AxisX).with_width(2.5));
            }
        }
        Some(Self {
            lines: LineSet::new(lines),
            start,
            num_inside: path.num_inside(),
            num_seen: path.num_seen(),
        })
    }
}

/// Draws the path of the nozzle tip, dashed where the gun is off.
fn strokes(path: &CarriedPath, mouths: &[Vec3]) -> Vec<Line> {
    let mut lines = Vec::new();
    let mut from = 0;
    for points in path.points.chunk_by(|a, b| a.is_gun_on == b.is_gun_on) {
        let end = from + points.len();
        // A point's gun state lasts until the next point.
        let line =
            Line::new(&mouths[from..mouths.len().min(end + 1)], Role::Nozzle).with_width(1.2);
        lines.push(if points[0].is_gun_on {
            line
        } else {
            line.dashed()
        });
        from = end;
    }
    lines
}

impl NozzleFigure {
    fn of(ray: &NozzleRay) -> Self {
        let mouth = vec3(&ray.mouth);
        let direction = vec3(&Point3::from(ray.direction));
        Self {
            lines: furniture::nozzle(mouth, direction, vec3(&ray.surface)),
            mouth,
            distance: ray.distance,
        }
    }
}

/// Neighbours on a border further apart on the surface than this, metres, are not joined.
const GAP: f32 = 0.06;
/// Offset of the outline in front of the surface, metres, so that noise does not hide it.
const BEFORE: f32 = 0.004;

/// Lifts the borders of a reference view onto its surface, at the pose; `None` for a flat shape.
fn outline(view: &ReferenceView, camera_from_part: &RigidTransform) -> Option<LineSet> {
    let camera_from_plane: Isometry3<f32> =
        (camera_from_part * view.plane_from_part.inverse()).cast();
    let contour = view.contour();
    let mut lines = Vec::new();
    for border in contour.borders() {
        let lifted = lift_border(border);
        let corners = lifted.iter().map(|p| {
            let p = camera_from_plane * p.cast::<f32>();
            let p = Vec3::new(p.x, p.y, p.z);
            p - p.normalize_or_zero() * BEFORE
        });
        let corners = smoothed(&corners.collect::<Vec<_>>());
        let runs = corners.chunk_by(|a, b| a.distance(*b) < GAP);
        let runs = runs.filter(|run| run.len() > 1);
        lines.extend(runs.map(|run| Line::new(run, Role::Contour).with_width(1.8)));
    }
    (!lines.is_empty()).then(|| LineSet::new(lines))
}

/// Smooths a closed line by means over neighbours, which removes the steps of the image's pixels, and repeats its first corner
/// at the end.
fn smoothed(corners: &[Vec3]) -> Vec<Vec3> {
    /// Number of neighbours on either side.
    const REACH: usize = 2;
    let num = corners.len();
    let mean = |i: usize| {
        let around = (0..=2 * REACH).map(|k| corners[(i + num * REACH + k - REACH) % num]);
        // A neighbour beyond a gap is on another part of the surface.
        let near = around.filter(|p| p.distance(corners[i]) < GAP);
        let (sum, count) = near.fold((Vec3::ZERO, 0.0), |(sum, n), p| (sum + p, n + 1.0));
        sum / count
    };
    let smooth: Vec<Vec3> = (0..num).map(mean).collect();
    let first = smooth.first().copied();
    smooth.into_iter().chain(first).collect()
}

/// Signed distance of every point of the part from the enrolled surface, for colouring the view.
///
/// Returns one deviation per point of the scene, metres, above 0 on the side of the surface's normals; NaN for points without
/// one. Empty without a pose.
pub(super) fn deviations(
    scene: &SceneCloud,
    inspection: &Inspection,
    reference: &Reference,
) -> Vec<f32> {
    let Ok(part) = &inspection.segmentation.part else {
        return Vec::new();
    };
    let points = &scene.cloud.points;
    let part = part.indices.iter().map(|index| *index as usize);
    let of_part = part.map(|index| (index, points[index]));
    deviations_at(points.len(), of_part, inspection, reference)
}

/// Does the same for any points in the camera frame: returns `num_points` deviations, NaN for points that are not in `part`.
pub(super) fn deviations_at(
    num_points: usize,
    part: impl Iterator<Item = (usize, Point3<f32>)>,
    inspection: &Inspection,
    reference: &Reference,
) -> Vec<f32> {
    let Some(Ok(pose)) = &inspection.pose else {
        return Vec::new();
    };
    let Some(normals) = &reference.cloud.normals else {
        return Vec::new();
    };
    // In f32, coordinates of about a metre keep micrometres: enough for a colour.
    let part_from_camera: Isometry3<f32> = pose.target_from_source.cast();
    let field = reference.field();
    let deviation = |point: &Point3<f32>| {
        let point = part_from_camera * point;
        let nearest = field.nearest(&point)?;
        let surface = reference.cloud.points.get(nearest.index)?;
        Some((point - surface).dot(normals.get(nearest.index)?))
    };
    let mut all = vec![f32::NAN; num_points];
    for (index, point) in part {
        all[index] = deviation(&point).unwrap_or(f32::NAN);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inspection::{inspected::inspected_cell, source::CellChoice};
    use geometry::{nearest::KdTree, rigid::from_euler_zyx};
    use robot::spray::CarriedPoint;

    #[test]
    fn a_long_path_has_rays_only_where_it_is_known_to_leave_the_band() {
        let num_lines = |num: usize| {
            let point = |i: usize| CarriedPoint {
                camera_from_nozzle: from_euler_zyx([0.0, 0.0, 0.0, 0.01 * i as f64, 0.0, 1.0]),
                meets: None,
                band: match i {
                    50 => BandStatus::TooFar,
                    51 => BandStatus::Inside,
                    _ => BandStatus::NotSeen,
                },
                is_gun_on: !(60..70).contains(&i),
                speed: None,
                is_round: true,
            };
            let points = (0..num).map(point).collect();
            let figure = SprayFigure::of(&CarriedPath { points }).expect("points");
            figure.lines.lines().len()
        };
        // The path, a ray at each point, and a cross of two lines at each but one.
        assert_eq!(num_lines(100), 1 + 100 + 2 * 99);
        // Two strokes and the move between them, and one point with ray and cross.
        assert_eq!(num_lines(746), 3 + 3);
    }

    #[test]
    fn the_enrolled_outline_lies_on_the_rim_of_the_part() {
        let inspected = inspected_cell(CellChoice::InTurn, 1);
        let part = &inspected.inspection.segmentation.part;
        let part = &part.as_ref().expect("a part").cloud.points;
        let tree = KdTree::new(part);
        let outline = inspected.view.outline.as_ref().expect("an outline");
        let corners: Vec<_> = outline.lines().iter().flat_map(|l| &l.points).collect();
        // The outline of the door and of its window.
        assert!(outline.lines().len() >= 2 && corners.len() > 200);
        let near = corners.iter().filter(|p| {
            let p = nalgebra::Point3::new(p.x, p.y, p.z);
            tree.nearest(&p, 0.02 * 0.02).is_some()
        });
        let share = near.count() as f32 / corners.len() as f32;
        assert!(share > 0.9, "{share}");
        assert!(inspected.view.has_deviations && inspected.view.axes.is_some());
        let [middle, _] = inspected.view.nozzles.as_ref().expect("nozzles");
        let found = inspected.stand_off.as_ref().expect("found").as_ref();
        let found = found.expect("a stand-off");
        assert_eq!(middle.distance, found.middle.distance);
        assert!(2 * found.rays.len() > found.num_taught);
    }
}
