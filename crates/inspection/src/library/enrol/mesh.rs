//! The surface of a mesh, or of a cloud without normals, as cameras see it from all around.

use nalgebra::{Point3, Vector3};

use super::EnrolFinding;
use geometry::{
    cloud::PointCloud,
    mesh::TriangleMesh,
    shown_sides::{MIN_HIDING_DEPTH, shown_sides},
    units::Metres,
};

/// Seed of the samples.
const SEED: u64 = 1;
/// A smaller share of the surface is a matter of its edges, and not mentioned.
const MIN_SHARE: f64 = 0.02;
/// Largest thickness that is called that of a sheet, metres, and as a share of the side of a square of the sheet's area.
const MAX_SHEET_M: f64 = 0.03;
const MAX_SHEET_SHARE: f64 = 0.06;

/// Half the diagonal of the square that a point of a cloud stands for, and the depth by which one must be nearer to hide another,
/// in spacings of the points.
const HALF_SQUARE: f64 = 1.2;
const CLOUD_MIN_HIDING: f64 = 0.6;

/// Returns a cloud with the normals of every side that can be seen, from normals that may point to either side.
pub(super) fn with_shown_sides(
    cloud: &PointCloud,
    normals: Vec<Vector3<f32>>,
    spacing: Metres,
) -> PointCloud {
    Sampled::of_cloud(cloud, normals, spacing).both_sides()
}

/// A mesh's surface.
pub(super) struct MeshSurface {
    /// Points with the normals of every side that can be seen: where both can, there are two points.
    pub(super) cloud: PointCloud,
    /// The normals of one side each, for the same surface: those of the triangles where both can be seen.
    pub(super) one_layer: PointCloud,
    pub(super) findings: Vec<EnrolFinding>,
}

impl MeshSurface {
    /// Samples at most this many points; `None` if the mesh has no area.
    pub(super) fn of(mesh: &TriangleMesh, max_points: usize) -> Option<Self> {
        let sampled = Sampled::of(mesh, max_points)?;
        let num_shown = sampled.num_shown();
        if num_shown <= max_points {
            return Some(sampled.surface(mesh));
        }
        // Another sample has a few more or less.
        let share = 0.99 * max_points as f64 / num_shown as f64;
        let fewer = (share * max_points as f64) as usize;
        Some(Sampled::of(mesh, fewer)?.surface(mesh))
    }
}

/// Points of a mesh with their triangles' normals, and whether a camera can see the side of the normal and the other side.
struct Sampled {
    points: Vec<Point3<f32>>,
    normals: Vec<Vector3<f32>>,
    shown: Vec<[bool; 2]>,
}

impl Sampled {
    fn of(mesh: &TriangleMesh, num_points: usize) -> Option<Self> {
        let PointCloud {
            points, normals, ..
        } = mesh.sample_evenly(num_points, SEED)?;
        let normals = normals?;
        let shown = shown_sides(mesh, &points, &normals, MIN_HIDING_DEPTH);
        Some(Self {
            points,
            normals,
            shown,
        })
    }

    /// Takes a cloud's points for small squares, in the planes of normals that may point to either side.
    fn of_cloud(cloud: &PointCloud, normals: Vec<Vector3<f32>>, spacing: Metres) -> Self {
        let mut squares = TriangleMesh::default();
        for (p, normal) in cloud.points.iter().zip(&normals) {
            let right = normal.cross(&Vector3::ith(normal.iamin(), 1.0));
            let right = right.normalize() * (HALF_SQUARE * spacing.0) as f32;
            let up = normal.cross(&right);
            let first = squares.vertices.len() as u32;
            squares
                .vertices
                .extend([right, up, -right, -up].map(|out| p + out));
            squares
                .triangles
                .extend([[0, 1, 2], [0, 2, 3]].map(|corners| corners.map(|i| first + i)));
        }
        let min_hiding = Metres(CLOUD_MIN_HIDING * spacing.0);
        Self {
            shown: shown_sides(&squares, &cloud.points, &normals, min_hiding),
            points: cloud.points.clone(),
            normals,
        }
    }

    fn num_shown(&self) -> usize {
        self.shown.iter().flatten().filter(|is| **is).count()
    }

    fn all(&self) -> impl Iterator<Item = ((&Point3<f32>, &Vector3<f32>), &[bool; 2])> {
        (self.points.iter().zip(&self.normals)).zip(&self.shown)
    }

    fn both_sides(&self) -> PointCloud {
        cloud_of(self.all().flat_map(|((p, n), [front, back])| {
            let front = front.then_some((*p, *n));
            front.into_iter().chain(back.then_some((*p, -n)))
        }))
    }

    fn surface(&self, mesh: &TriangleMesh) -> MeshSurface {
        let one_side = self.all().filter_map(|((p, n), shown)| match shown {
            [false, false] => None,
            [false, true] => Some((*p, -n)),
            [true, _] => Some((*p, *n)),
        });
        MeshSurface {
            cloud: self.both_sides(),
            one_layer: cloud_of(one_side),
            findings: self.findings(mesh),
        }
    }

    fn findings(&self, mesh: &TriangleMesh) -> Vec<EnrolFinding> {
        let share = |of: [bool; 2]| {
            let num = self.shown.iter().filter(|shown| **shown == of).count();
            num as f64 / self.shown.len().max(1) as f64
        };
        let [open, turned, hidden] = [[true, true], [false, true], [false, false]].map(share);
        let is_wound_one_way = turned.min(1.0 - turned) < MIN_SHARE;
        let is_closed = open < MIN_SHARE && hidden < MIN_SHARE && is_wound_one_way;
        let area = mesh.area() / 2.0;
        let thickness = mesh.signed_volume().abs() / area;
        let is_sheet = thickness < MAX_SHEET_M.min(MAX_SHEET_SHARE * area.sqrt());
        let percent = |share: f64| (share * 100.0).round() as u8;
        let of_share = |share: f64, finding: fn(u8) -> EnrolFinding| {
            (share >= MIN_SHARE).then(|| finding(percent(share)))
        };
        [
            (is_closed && is_sheet).then_some(EnrolFinding::ClosedSheet {
                thickness_m: Metres(thickness),
            }),
            of_share(open, |percent| EnrolFinding::OpenSurface { percent }),
            of_share(turned, |percent| EnrolFinding::Turned { percent }),
            of_share(hidden, |percent| EnrolFinding::Hidden { percent }),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}

fn cloud_of(oriented: impl Iterator<Item = (Point3<f32>, Vector3<f32>)>) -> PointCloud {
    let (points, normals): (Vec<_>, Vec<_>) = oriented.unzip();
    PointCloud {
        normals: Some(normals),
        ..PointCloud::from_points(points)
    }
}
