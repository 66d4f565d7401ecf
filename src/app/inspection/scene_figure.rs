//! What the 3-D view shows of a result, made once in the task: points, and the lines that stand for things.

use std::sync::Arc;

use glam::Vec3;
use nalgebra::{Isometry3, Point3};

use super::scan_figure::ScanFigure;
use crate::{
    app::ui::viewport::{Line, LineSet, PointSet, Role, furniture},
    geometry::rigid::RigidTransform,
    pipeline::Inspection,
    robot::spray::{BandStatus, CarriedPath},
    stages::{
        contour::lift_border,
        pose::PoseEstimate,
        reference::{Reference, ReferenceView},
        scene::SceneCloud,
        stand_off::{NozzleRay, StandOff},
    },
    units::Metres,
};

/// Points and lines of one result, camera space. What the result does not have is not there.
#[derive(Debug)]
pub struct SceneFigure {
    /// The scene, with what each point was taken for and how far it is off.
    pub points: PointSet,
    /// True when at least one point knows its deviation.
    pub has_deviations: bool,
    /// The axes of the part's middle, where it was found.
    pub axes: Option<LineSet>,
    /// The depth camera and what it sees.
    pub camera: Option<LineSet>,
    /// Outline and openings of the enrolled part at the found pose.
    pub outline: Option<LineSet>,
    /// The taught nozzle over the part's middle, and the one furthest off.
    pub nozzles: Option<[NozzleFigure; 2]>,
    /// The part's stored spray path, where one is stored.
    pub spray: Option<SprayFigure>,
}

/// A spray path as it has to run now.
#[derive(Debug)]
pub struct SprayFigure {
    /// The way from mouth to mouth, and each nozzle's ray: in the band solid to the surface, else dashed with a cross.
    pub lines: LineSet,
    /// The first mouth, metres.
    pub start: Vec3,
    /// Points in the band.
    pub num_inside: usize,
    /// All points.
    pub num_points: usize,
}

/// A nozzle before the part.
#[derive(Debug)]
pub struct NozzleFigure {
    /// Nozzle and ray.
    pub lines: LineSet,
    /// Its mouth, metres.
    pub mouth: Vec3,
    /// From there to the part; below 0 with the nozzle in or behind it.
    pub distance: Metres,
}

/// What a [`SceneFigure`] is made of.
pub(in crate::app) struct SceneFigureInput<'a> {
    pub(in crate::app) scene: &'a SceneCloud,
    /// Of a scan, whose points take the place of the scene's.
    pub(in crate::app) scan: Option<&'a ScanFigure>,
    pub(in crate::app) inspection: &'a Inspection,
    /// The best reference.
    pub(in crate::app) reference: Option<&'a Reference>,
    /// Middle of its extent, part space.
    pub(in crate::app) middle: Option<Point3<f64>>,
    pub(in crate::app) deviations: &'a [f32],
    pub(in crate::app) stand_off: Option<&'a StandOff>,
    pub(in crate::app) spray: Option<&'a CarriedPath>,
}

impl SceneFigure {
    /// Makes it: goes through every point.
    pub(in crate::app) fn of(given: &SceneFigureInput<'_>) -> Self {
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
        let mut points = if let Some(scan) = scan {
            PointSet::segmented(Arc::clone(&scan.positions), &scan.labels)
        } else {
            let points = scene.cloud.points.iter();
            let positions: Vec<[f32; 3]> = points.map(|p| [p.x, p.y, p.z]).collect();
            PointSet::segmented(positions, &inspection.segmentation.labels)
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
        // A scan shows the cameras of all its shots.
        let camera = scene.intrinsics.as_ref().filter(|_| scan.is_none());
        let placed = inspection.ranking.entries.first();
        let view = placed.and_then(|entry| entry.placements.first());
        let view = reference.and_then(|reference| reference.views.get(view?.view));
        Self {
            has_deviations,
            axes,
            camera: camera.map(|camera| furniture::frustum(camera, Metres(0.25))),
            outline: view
                .zip(camera_from_part)
                .and_then(|(view, pose)| outline(view, &pose)),
            nozzles: stand_off.map(|found| [&found.middle, &found.worst].map(NozzleFigure::of)),
            spray: spray.and_then(SprayFigure::of),
            points,
        }
    }
}

impl SprayFigure {
    fn of(path: &CarriedPath) -> Option<Self> {
        /// A ray that meets nothing is drawn to here.
        const UNMET: f32 = 0.15;
        /// Arms of the cross at a mouth that is out of the band.
        const CROSS: f32 = 0.008;
        let mouths: Vec<Vec3> = path.points.iter().map(|p| vec3(&p.mouth())).collect();
        let start = *mouths.first()?;
        let mut lines = vec![Line::new(mouths.clone(), Role::Nozzle).with_width(1.2)];
        for (point, &mouth) in path.points.iter().zip(&mouths) {
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
            num_points: path.points.len(),
        })
    }
}

fn vec3(p: &Point3<f64>) -> Vec3 {
    Vec3::new(p.x as f32, p.y as f32, p.z as f32)
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

/// Neighbours on a border that lie further apart on the surface than this, metres, are not joined.
const GAP: f32 = 0.06;
/// How far before the surface the outline is drawn, metres: noise must not hide it.
const BEFORE: f32 = 0.004;

/// The borders of a view of the reference on its surface, at the pose; `None` for a flat shape.
fn outline(view: &ReferenceView, camera_from_part: &RigidTransform) -> Option<LineSet> {
    let camera_from_plane: Isometry3<f32> =
        (camera_from_part * view.plane_from_part.inverse()).cast();
    let borders = std::iter::once(&view.contour.outline).chain(&view.contour.openings);
    let mut lines = Vec::new();
    for border in borders {
        let lifted = lift_border(border, &view.plane);
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

/// A closed line whose corners are means over their neighbours, without the steps of the image's pixels; its first
/// corner is repeated at the end.
fn smoothed(corners: &[Vec3]) -> Vec<Vec3> {
    /// Neighbours to either side.
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

#[cfg(test)]
mod tests {
    use crate::{
        app::inspection::{
            inspected::{InspectRequest, inspect},
            library_cache::LibraryCache,
            source::{CellChoice, SceneSource},
        },
        geometry::nearest::KdTree,
        pipeline::Unwatched,
    };

    #[test]
    fn the_enrolled_outline_lies_on_the_rim_of_the_part() {
        let request = InspectRequest {
            source: SceneSource::Cell {
                choice: CellChoice::InTurn,
                number: 1,
            },
            recipe: std::sync::Arc::default(),
        };
        let inspected = inspect(&request, &LibraryCache::default(), &Unwatched).expect("inspected");
        let part = &inspected.inspection.segmentation.part;
        let part = &part.as_ref().expect("a part").cloud.points;
        let tree = KdTree::new(part);
        let outline = inspected.view.outline.as_ref().expect("an outline");
        let corners: Vec<_> = outline.lines().iter().flat_map(|l| &l.points).collect();
        // The door's outline and its window.
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
