//! Recorded scenes without a car part, and a car's meshes seen by the simulated camera.

use std::path::Path;

use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, UnitQuaternion};
use partsight::{
    files::{FileContent, open},
    geometry::{
        mesh::TriangleMesh,
        rigid::{RigidTransform, pose_error},
    },
    library::{EnrolParams, Library, PartDescription, PartName, enrol_mesh},
    pipeline::{Inspection, Recipe, Unwatched, Verdict, run},
    simulate::{CellSetup, PoseRange, SimulatedObject, frame_of_mesh},
    stages::scene::{SceneCloud, scene_from_cloud, scene_from_frame},
};

use crate::{data_folder, kit::shipped_library};

fn inspected(scene: &SceneCloud, library: &Library) -> Inspection {
    run(scene, library, &Recipe::default(), &Unwatched).expect("not cancelled")
}

#[test]
fn no_recorded_scene_is_accepted_as_a_car_part() {
    let Some(data) = data_folder() else { return };
    let library = shipped_library();
    assert_eq!(library.references.len(), 8);
    let mut num_scenes = 0;
    for folder in ["frames", "frames_labelled"] {
        let mut paths: Vec<_> = std::fs::read_dir(data.join(folder))
            .expect("a folder of frames")
            .filter_map(|entry| Some(entry.ok()?.path()))
            .collect();
        paths.sort();
        for path in paths {
            let Ok(FileContent::Cloud(cloud)) = open(&path) else {
                panic!("{} does not load", path.display())
            };
            let inspection = inspected(&scene_from_cloud(cloud), &library);
            let name = path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            let took = inspection.timings.total.as_secs_f64() * 1e3;
            match &inspection.verdict {
                Verdict::Part {
                    part,
                    score,
                    rejected,
                    ..
                } => {
                    eprintln!("{name}: nearest {part}, score {score:.2}, {took:.0} ms");
                    assert!(
                        rejected.is_some(),
                        "{name} was accepted as {part} with {score:.2}"
                    );
                }
                Verdict::NoPart(reason) => eprintln!("{name}: {reason}, {took:.0} ms"),
            }
            num_scenes += 1;
        }
    }
    assert!(num_scenes >= 8);
}

/// A mesh of the car, and the rotation that makes its outside face the camera, upright: `paint_from_car`.
struct CarPart {
    mesh_name: &'static str,
    name: &'static str,
    paint_from_car: Rotation3<f64>,
}

/// The car's frame has x along the car, y up and z across; a painted side faces -z with y down.
fn car_parts() -> [CarPart; 3] {
    [
        CarPart {
            mesh_name: "Door_FL",
            name: "door_left",
            paint_from_car: Rotation3::from_matrix_unchecked(Matrix3::new(
                -1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0,
            )),
        },
        CarPart {
            mesh_name: "Door_FR",
            name: "door_right",
            paint_from_car: Rotation3::from_matrix_unchecked(Matrix3::new(
                1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0,
            )),
        },
        // The lid faces backwards (-x) and upwards alike, so it is seen from between the two.
        CarPart {
            mesh_name: "Trunk_Lid",
            name: "trunk_lid",
            paint_from_car: Rotation3::from_euler_angles(0.8, 0.0, 0.0)
                * Rotation3::from_matrix_unchecked(Matrix3::new(
                    0.0, 0.0, 1.0, 0.0, -1.0, 0.0, 1.0, 0.0, 0.0,
                )),
        },
    ]
}

fn car_mesh(data: &Path, name: &str) -> TriangleMesh {
    let path = data
        .join("car")
        .join(format!("vehicle_example.gltf#{name}"));
    match open(&path) {
        Ok(FileContent::Mesh(mesh)) => mesh,
        other => panic!("{name}: expected a mesh, got {other:?}"),
    }
}

/// Rotates and centres the mesh as the simulated cell hangs its parts; returns `paint_from_car` and the mesh.
fn hung(mesh: &TriangleMesh, turn: &Rotation3<f64>) -> (RigidTransform, TriangleMesh) {
    let (low, high) = mesh.bounds().expect("vertices");
    let centre: Point3<f64> = nalgebra::center(&low, &high).cast();
    let turn = UnitQuaternion::from_rotation_matrix(turn);
    let paint_from_car = Isometry3::from_parts((-(turn * centre.coords)).into(), turn);
    let vertices = mesh
        .vertices
        .iter()
        .map(|p| (paint_from_car * p.cast::<f64>()).cast())
        .collect();
    (
        paint_from_car,
        TriangleMesh {
            vertices,
            triangles: mesh.triangles.clone(),
        },
    )
}

#[test]
fn doors_and_lid_of_a_car_are_told_apart_and_left_is_never_right() {
    let Some(data) = data_folder() else { return };
    let mut library = Library::default();
    for part in car_parts() {
        let about = PartDescription {
            name: PartName::new(part.name).expect("a good name"),
            title: String::new(),
            notes: String::new(),
            from: part.mesh_name.to_owned(),
            at: "2026-01-01T00:00:00Z".parse().expect("a time"),
            simulated: true,
        };
        let enrolled = enrol_mesh(
            &car_mesh(&data, part.mesh_name),
            &about,
            &EnrolParams::default(),
        );
        library
            .references
            .push(enrolled.expect("a reference").reference);
    }
    let (mut num_right, mut num_accepted, mut num_posed) = (0, 0, 0);
    let parts = car_parts();
    for part in &parts {
        let (paint_from_car, mesh) = hung(&car_mesh(&data, part.mesh_name), &part.paint_from_car);
        for seed in 0..20 {
            let mut setup = CellSetup::new(SimulatedObject::Nothing, 900 + seed);
            setup.pose = partsight::simulate::PartPose::Drawn(PoseRange::placed());
            let shot = frame_of_mesh(&setup, &mesh);
            let inspection = inspected(&scene_from_frame(&shot.frame), &library);
            let Verdict::Part {
                part: found,
                score,
                margin,
                rejected,
                ..
            } = &inspection.verdict
            else {
                panic!("{} at seed {seed}: {:?}", part.name, inspection.verdict);
            };
            num_right += usize::from(found == part.name);
            num_accepted += usize::from(rejected.is_none());
            if found != part.name {
                eprintln!(
                    "{} at seed {seed} taken for {found}: score {score:.2}, margin {margin:.2}",
                    part.name
                );
            }
            let is_door = |name: &str| name.starts_with("door");
            assert!(
                found == part.name || !(is_door(found) && is_door(part.name)),
                "{} at seed {seed} swapped for {found}",
                part.name
            );
            if let Some(Ok(pose)) = &inspection.pose {
                let truth = shot.truth.camera_from_part * paint_from_car;
                let centre = paint_from_car.inverse() * Point3::origin();
                let error = pose_error(&pose.camera_from_part(), &truth, &centre);
                num_posed += usize::from(error.rotation.degrees() < 2.0 && error.shift.mm() < 10.0);
            }
        }
    }
    eprintln!(
        "right {num_right}/60, accepted {num_accepted}/60, pose within 2° and 10 mm {num_posed}/60"
    );
    assert_eq!(num_right, 60);
}
