//! The side that parts from meshes are painted on.

use std::path::Path;

use nalgebra::Vector3;
use partsight::{
    files::{FileContent, open},
    library::{EnrolParams, Enrolled, PartDescription, PartName, Side, enrol_mesh},
    paint::{Coat, PaintSurface, plan},
    stages::reference::Coverage,
};

use crate::data_folder;

pub(crate) fn enrolled(file: &Path, options: &str) -> Enrolled {
    let mut path = file.to_owned();
    path.as_mut_os_string().push(options);
    let Ok(FileContent::Mesh(mesh)) = open(&path) else {
        panic!("{}: expected a mesh", path.display());
    };
    let about = PartDescription {
        name: PartName::new("part").expect("a good name"),
        title: String::new(),
        notes: String::new(),
        from: "mesh".into(),
        at: "2026-01-01T00:00:00Z".parse().expect("a time"),
        simulated: true,
    };
    enrol_mesh(&mesh, &about, &EnrolParams::default()).expect("enrolled")
}

/// Mean nozzle and direction of the path planned over it; with `is_old`, as if no side were stored with the part.
fn planned(enrolled: &Enrolled, is_old: bool) -> [Vector3<f64>; 2] {
    let side = enrolled.part.meta.side.filter(|_| !is_old);
    let surface = PaintSurface::of(&enrolled.reference, Coverage::AllAround, side);
    let path = plan(&surface.expect("a surface"), &Coat::default(), &[]).expect("planned");
    let num = path.points().len() as f64;
    let mean = |of: fn(&partsight::library::PathPoint) -> Vector3<f64>| {
        path.points().iter().map(of).sum::<Vector3<f64>>() / num
    };
    [
        mean(|p| p.nozzle.coords),
        mean(|p| p.direction.into_inner()),
    ]
}

#[test]
fn a_hood_is_painted_from_above_however_it_slopes() {
    let Some(data) = data_folder() else { return };
    for slope in ["0", "plus", "minus"] {
        let file = data.join(format!("reported/mesh_side/hood_slope_{slope}.obj"));
        let hood = enrolled(&file, "#up=z");
        assert_eq!(hood.part.meta.side, Some(Side::Top), "{slope}");
        for is_old in [false, true] {
            let [nozzle, direction] = planned(&hood, is_old);
            assert!((nozzle.y + 1.009).abs() < 0.02, "{slope}: {nozzle}");
            assert!(direction.y > 0.9, "{slope}: {direction}");
        }
    }
}

#[test]
fn parts_of_a_car_are_painted_from_outside_whichever_axis_points_up() {
    let Some(data) = data_folder() else { return };
    // The car has y up and x forwards, so z to its right.
    for (name, outside) in [
        ("Door_FL", -Vector3::z()),
        ("Door_FR", Vector3::z()),
        ("Trunk_Lid", Vector3::new(-0.7, 0.7, 0.0)),
    ] {
        let file = data.join(format!("car/vehicle_example.gltf#{name}"));
        for (up, turned) in [("y", -1.0), ("-y", 1.0)] {
            let part = enrolled(&file, &format!("#up={up}"));
            assert!(part.part.meta.side.is_some(), "{name} {up}");
            let [_, direction] = planned(&part, false);
            // With y up, the part is turned about x by half a turn.
            let outside = Vector3::new(outside.x, turned * outside.y, turned * outside.z);
            assert!(direction.dot(&outside) < -0.8, "{name} {up}: {direction}");
        }
    }
}
