//! Arrangement of the booth: camera, part, stand, walls.

use nalgebra::Point3;
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::{
    field_of_view::FieldOfView,
    flange::{Flange, seen_surface},
    gloss::SpecularDropout,
    registered_camera::RegisteredCamera,
    trestle::trestle,
    walls::walls,
};
use crate::{
    cell::{Cell, CellSetup, PartPose, SimulatedObject},
    part::{PartKind, PartModel, Side},
    rasteriser::SurfaceLabel,
};
use geometry::{depth_frame::Intrinsics, distortion::Distortion, mesh::TriangleMesh};

/// A structured-light camera whose depth is registered to a colour picture, reduced from 2560 × 1920 to 640 × 480.
pub(crate) const CAMERA: Intrinsics = Intrinsics {
    width: 640,
    height: 480,
    fx: 468.0,
    fy: 469.0,
    cx: 325.0,
    cy: 232.0,
    distortion: Distortion::NONE,
};

/// Separates the booth's random numbers from others with the same seed.
const STREAM: u64 = 0xb007_b007_b007_b007;

/// Draws the booth from the setup's seed. A fixed pose is kept, and the rest arranged around it.
pub(crate) fn arrange<'a>(setup: &CellSetup, part: &'a TriangleMesh) -> Cell<'a> {
    let mut random = Pcg64::seed_from_u64(setup.seed ^ STREAM);
    let camera = &setup.intrinsics;
    // The stand of an empty booth is built for a part that is not there.
    let held_elsewhere;
    let held = if part.vertices.is_empty() {
        let kind = PartKind::ALL[random.random_range(0..PartKind::ALL.len())];
        held_elsewhere = PartModel::new(kind, Side::Left, 0).into_mesh();
        &held_elsewhere
    } else {
        part
    };
    let field_of_view = FieldOfView::draw(camera, &mut random);
    let flange = Flange::draw(&mut random);
    let seen = seen_surface(held, &flange.camera_from_part);
    let camera_from_part = match setup.pose {
        PartPose::Drawn(_) => flange.place(&seen, &field_of_view, camera, &mut random),
        PartPose::Fixed(camera_from_part) => camera_from_part,
    };
    let held_points: Vec<Point3<f64>> = held.vertices.iter().map(|p| p.cast()).collect();
    let down = flange.camera_from_world * nalgebra::Vector3::y();
    let stand = trestle(&held_points, &camera_from_part, &down, &mut random);
    let in_camera: Vec<Point3<f64>> = held_points.iter().map(|p| camera_from_part * p).collect();
    let walls = walls(
        &in_camera,
        &flange.camera_from_world,
        stand.floor,
        &mut random,
    );
    let camera_seed = random.random();
    let gloss = match setup.subject {
        SimulatedObject::Nothing => SpecularDropout::none(),
        subject => SpecularDropout::draw(subject, &seen, &camera_from_part, camera, &mut random),
    };
    let mut meshes = vec![
        (stand.tubes.into_mesh(), SurfaceLabel::Stand),
        (walls.fixtures.into_mesh(), SurfaceLabel::Wall),
        (walls.clutter.into_mesh(), SurfaceLabel::Clutter),
    ];
    meshes.retain(|(mesh, _)| !mesh.triangles.is_empty());
    let sensor = RegisteredCamera::new(field_of_view, gloss, camera_seed);
    Cell {
        part,
        camera_from_part,
        meshes,
        planes: walls.planes,
        sensor: Box::new(sensor),
    }
}
