//! References of sheet metal as design programs export it: panels of any thickness, closed, inside out, open, with both skins, or
//! as a cloud of them.

use std::f64::consts::PI;

use nalgebra::{Point3, UnitQuaternion, Vector3};

use super::{BoundsLibrary, BoundsPart, hung};
use geometry::{cloud::PointCloud, mesh::TriangleMesh, rigid::RigidTransform, units::Metres};
use inspection::library::{
    EnrolError, EnrolParams, PartDescription, PartName, enrol_mesh, enrol_whole,
};

/// How a panel is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SheetForm {
    /// A closed solid, its triangles facing outwards.
    Closed,
    /// The same, its triangles facing inwards.
    InsideOut,
    /// The same, every second triangle facing inwards.
    MixedWinding,
    /// One surface without thickness.
    Open,
    /// The same, wound for the other side.
    OpenFromBehind,
    /// Points of both skins with normals.
    Cloud,
    /// Points of both skins without normals.
    PlainCloud,
}

impl SheetForm {
    /// All forms.
    pub const ALL: [Self; 7] = [
        Self::Closed,
        Self::InsideOut,
        Self::MixedWinding,
        Self::Open,
        Self::OpenFromBehind,
        Self::Cloud,
        Self::PlainCloud,
    ];

    /// False for a thick panel as one surface: nothing says where its back is.
    pub fn is_possible(self, thickness: Metres) -> bool {
        !matches!(self, Self::Open | Self::OpenFromBehind) || thickness <= Metres(0.0012)
    }

    /// Returns the name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Closed => "closed",
            Self::InsideOut => "inside out",
            Self::MixedWinding => "mixed winding",
            Self::Open => "open",
            Self::OpenFromBehind => "open, from behind",
            Self::Cloud => "cloud",
            Self::PlainCloud => "cloud, no normals",
        }
    }
}

/// The thicknesses that are measured, metres.
pub const THICKNESSES: [Metres; 7] = [
    Metres(0.0005),
    Metres(0.0007),
    Metres(0.0012),
    Metres(0.0032),
    Metres(0.007),
    Metres(0.02),
    Metres(0.03),
];

/// Side of a cell of a panel, metres.
const CELL: f64 = 0.01;
/// Points of a cloud.
const NUM_POINTS: usize = 60_000;

/// A panel: where it has sheet, and how high that is, in metres from its middle.
struct Panel {
    name: &'static str,
    is_sheet: fn(f64, f64) -> bool,
    height: fn(f64, f64) -> f64,
}

/// Panels without a symmetry, with slots, ribs and bulges.
const PANELS: [Panel; 3] = [
    Panel {
        name: "slotted_plate",
        is_sheet: |x, y| {
            let is_slot = (x - 0.12).abs() < 0.025 && (y + 0.03).abs() < 0.14;
            x.abs() < 0.36 && y.abs() < 0.24 && (x > -0.2 || y < 0.12) && !is_slot
        },
        height: |_, _| 0.0,
    },
    Panel {
        name: "bulged_panel",
        is_sheet: |x, y| {
            let is_opening = (x + 0.2).hypot(y - 0.05) < 0.07;
            x.abs() < 0.45 && y > -0.3 && y < 0.3 - 0.3 * x.max(0.0) && !is_opening
        },
        height: |x, y| 0.06 - 0.25 * x * x - 0.35 * y * y,
    },
    Panel {
        name: "ribbed_panel",
        is_sheet: |x, y| x.abs() < 0.4 && y.abs() < 0.2 && (x + y < 0.42),
        height: |x, y| {
            let rib = |at: f64| (1.0 - ((y - at) / 0.03).powi(2)).max(0.0) * 0.012;
            0.03 - 0.15 * x * x + if x < 0.2 { rib(-0.1) + rib(0.05) } else { 0.0 }
        },
    },
];

impl Panel {
    /// The panel as a closed solid of this thickness, its triangles facing outwards, its paint side towards -z; with no thickness,
    /// the paint side alone.
    fn mesh(&self, thickness: f64) -> TriangleMesh {
        const NUM: i32 = 100;
        let at = |i: i32| f64::from(i - NUM / 2) * CELL;
        let is_cell = |i: i32, j: i32| {
            (0..NUM).contains(&i)
                && (0..NUM).contains(&j)
                && (self.is_sheet)(at(i) + CELL / 2.0, at(j) + CELL / 2.0)
        };
        let corner = |i: i32, j: i32, below: f64| {
            let (x, y) = (at(i), at(j));
            Point3::new(x, y, below - (self.height)(x, y)).cast::<f32>()
        };
        let mut mesh = TriangleMesh::default();
        let mut quad = |corners: [Point3<f32>; 4]| {
            let first = mesh.vertices.len() as u32;
            mesh.vertices.extend(corners);
            let triangles = [[0, 1, 2], [0, 2, 3]];
            mesh.triangles
                .extend(triangles.map(|t| t.map(|corner| first + corner)));
        };
        for (i, j) in (0..NUM).flat_map(|i| (0..NUM).map(move |j| (i, j))) {
            if !is_cell(i, j) {
                continue;
            }
            let ring = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)];
            quad(ring.map(|(i, j)| corner(i, j, 0.0)));
            if thickness <= 0.0 {
                continue;
            }
            let [a, b, c, d] = ring.map(|(i, j)| corner(i, j, thickness));
            quad([a, d, c, b]);
            let beside = [(i - 1, j), (i, j + 1), (i + 1, j), (i, j - 1)];
            for (side, (k, l)) in beside.into_iter().enumerate() {
                if !is_cell(k, l) {
                    let [p, q] = [ring[side], ring[(side + 1) % 4]];
                    let [front, back] =
                        [0.0, thickness].map(|below| [p, q].map(|(i, j)| corner(i, j, below)));
                    quad([front[1], front[0], back[0], back[1]]);
                }
            }
        }
        mesh
    }

    /// Enrols the panel in one of the forms.
    fn enrolled(
        &self,
        thickness: f64,
        form: SheetForm,
    ) -> Result<stages::reference::Reference, EnrolError> {
        let params = EnrolParams::default();
        let about = PartDescription {
            name: PartName::new(self.name).expect("our own names are valid"),
            title: String::new(),
            notes: String::new(),
            from: "mesh".to_owned(),
            at: jiff::Timestamp::UNIX_EPOCH,
            simulated: true,
        };
        let turn_every = |step: usize, mut mesh: TriangleMesh| {
            let turned = mesh.triangles.iter_mut().step_by(step);
            turned.for_each(|corners| corners.swap(1, 2));
            mesh
        };
        let closed = self.mesh(thickness);
        let cloud = |mesh: &TriangleMesh| {
            let cloud = mesh.sample_evenly(NUM_POINTS, 2);
            cloud.ok_or(EnrolError::NoArea { num_triangles: 0 })
        };
        let mesh = match form {
            SheetForm::Closed => closed,
            SheetForm::InsideOut => turn_every(1, closed),
            SheetForm::MixedWinding => turn_every(2, closed),
            SheetForm::Open => self.mesh(0.0),
            SheetForm::OpenFromBehind => turn_every(1, self.mesh(0.0)),
            SheetForm::Cloud => {
                return Ok(enrol_whole(&cloud(&closed)?, &about, &params)?.reference);
            }
            SheetForm::PlainCloud => {
                let plain = PointCloud {
                    normals: None,
                    ..cloud(&closed)?
                };
                return Ok(enrol_whole(&plain, &about, &params)?.reference);
            }
        };
        Ok(enrol_mesh(&mesh, &about, &params)?.reference)
    }
}

impl BoundsLibrary {
    /// Enrols panels of a thickness in a form; each hangs with its paint side and with its back to the camera.
    pub fn sheets(thickness: Metres, form: SheetForm) -> Result<Self, EnrolError> {
        let title = format!("{:.1} mm, {}", thickness.mm(), form.name());
        let mut all = Self::empty(&title);
        for panel in PANELS {
            let reference = panel.enrolled(thickness.0, form)?;
            let name = reference.name.clone();
            all.library.references.push(reference);
            let (front, front_from_part) = hung(panel.mesh(thickness.0));
            let about = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), PI);
            let turn = RigidTransform::from_parts(Vector3::zeros().into(), about);
            let mut back = front.clone();
            back.vertices
                .iter_mut()
                .for_each(|p| *p = turn.cast::<f32>() * *p);
            for (mesh, mesh_from_part) in [(front, front_from_part), (back, turn * front_from_part)]
            {
                all.subjects.push(BoundsPart {
                    name: name.clone(),
                    mesh,
                    mesh_from_part,
                });
            }
        }
        Ok(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_are_closed_and_as_thick_as_they_should_be() {
        for panel in PANELS {
            let open = panel.mesh(0.0);
            for thickness in [0.0005, 0.02] {
                let mesh = panel.mesh(thickness);
                // The skins are apart along z.
                let flat: f64 = open.area();
                let volume = mesh.signed_volume();
                assert!(
                    volume > 0.8 * thickness * flat && volume <= 1.0001 * thickness * flat,
                    "{}",
                    panel.name
                );
            }
        }
    }
}
