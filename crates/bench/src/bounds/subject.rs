//! Enrolled parts with a known surface.

use nalgebra::{Point3, UnitQuaternion, Vector3};

use crate::suites::{enrol_part, enrolled_name, enrolment_pose};
use geometry::{mesh::TriangleMesh, principal::principal_axes, rigid::RigidTransform};
use inspection::library::{
    EnrolError, EnrolParams, Library, PartDescription, PartName, enrol_mesh,
};
use simulate::{PartKind, PartModel, Side};

/// A part to be rendered and inspected.
#[derive(Clone, Debug)]
pub struct BoundsPart {
    /// Name in the library.
    pub name: String,
    /// Surface mesh, centred and facing -z, as the simulated cell hangs parts.
    pub mesh: TriangleMesh,
    /// Transform from reference space to mesh space.
    pub mesh_from_part: RigidTransform,
}

/// Parts that are enrolled together.
#[derive(Clone, Debug)]
pub struct BoundsLibrary {
    /// Short description of how the parts were enrolled.
    pub title: String,
    /// The library to inspect against.
    pub library: Library,
    /// The parts, in the library's order.
    pub subjects: Vec<BoundsPart>,
}

impl BoundsLibrary {
    /// Enrols the eight parts of a car model, each from one capture.
    pub fn captured(model_seed: u64) -> Result<Self, EnrolError> {
        let mut all = Self::empty("captured");
        for kind in PartKind::ALL {
            let reference = enrol_part(kind, Side::Left, model_seed, &EnrolParams::default())?;
            all.library.references.push(reference);
            all.subjects.push(BoundsPart {
                name: enrolled_name(kind, Side::Left),
                mesh: PartModel::new(kind, Side::Left, model_seed).into_mesh(),
                mesh_from_part: enrolment_pose().inverse(),
            });
        }
        Ok(all)
    }

    /// Enrols the same parts from their meshes.
    pub fn simulated_meshes(model_seed: u64) -> Result<Self, EnrolError> {
        let meshes = PartKind::ALL.map(|kind| {
            let mesh = PartModel::new(kind, Side::Left, model_seed).into_mesh();
            (kind.name().to_owned(), mesh)
        });
        Self::of_meshes(meshes)
    }

    /// Enrols any meshes, in metres.
    pub fn of_meshes(
        meshes: impl IntoIterator<Item = (String, TriangleMesh)>,
    ) -> Result<Self, EnrolError> {
        let mut all = Self::empty("mesh");
        for (number, (name, mesh)) in meshes.into_iter().enumerate() {
            let plain = PartName::new(&name.to_lowercase());
            let spare =
                || PartName::new(&format!("part_{number}")).expect("our own names are valid");
            let about = PartDescription {
                name: plain.unwrap_or_else(|_| spare()),
                title: name,
                notes: String::new(),
                from: "mesh".to_owned(),
                at: jiff::Timestamp::UNIX_EPOCH,
                simulated: true,
            };
            let reference = enrol_mesh(&mesh, &about, &EnrolParams::default())?.reference;
            reference.prefetch();
            all.library.references.push(reference);
            let (mesh, mesh_from_part) = hung(mesh);
            all.subjects.push(BoundsPart {
                name: about.name.as_str().to_owned(),
                mesh,
                mesh_from_part,
            });
        }
        Ok(all)
    }

    pub(super) fn empty(title: &str) -> Self {
        Self {
            title: title.to_owned(),
            library: Library::default(),
            subjects: Vec::new(),
        }
    }
}

/// A mesh counts as closed if the norm of its summed area vectors is at most this share of its area.
const LEAST_ONE_SIDED: f64 = 0.2;

/// Hangs a mesh as the simulated cell hangs parts, and returns by which transform.
pub(crate) fn hung(mut mesh: TriangleMesh) -> (TriangleMesh, RigidTransform) {
    let hung_from_mesh = hung_from_mesh(&mesh);
    for p in &mut mesh.vertices {
        *p = (hung_from_mesh * p.cast::<f64>()).cast();
    }
    (mesh, hung_from_mesh)
}

/// Centres a mesh and turns its face, the side that more of its area points to, towards -z: the camera. A closed mesh
/// is turned by its axis of least extent.
fn hung_from_mesh(mesh: &TriangleMesh) -> RigidTransform {
    let corner = |i: u32| mesh.vertices[i as usize].cast::<f64>();
    let facing = mesh.triangles.iter().fold(Vector3::zeros(), |sum, t| {
        let (a, b, c) = (corner(t[0]), corner(t[1]), corner(t[2]));
        sum + (b - a).cross(&(c - a)) / 2.0
    });
    let vertices = mesh.vertices.iter().map(|p| (p.cast::<f64>(), 1.0));
    let flat = || principal_axes(vertices).map(|axes| axes.axes.column(2).into_owned());
    let face = if facing.norm() > LEAST_ONE_SIDED * mesh.area() {
        Some(facing)
    } else {
        flat()
    };
    let turn = face
        .and_then(|face| UnitQuaternion::rotation_between(&face, &-Vector3::z()))
        .unwrap_or_else(|| {
            UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI)
        });
    let middle = mesh.bounds().map_or(Point3::origin(), |(low, high)| {
        nalgebra::center(&low, &high).cast()
    });
    RigidTransform::from_parts((-(turn * middle.coords)).into(), turn)
}
