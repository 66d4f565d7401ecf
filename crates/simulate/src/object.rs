//! Objects other than the eight parts, for rejection tests and as clutter.

use nalgebra::{Point3, Vector3};
use serde::{Deserialize, Serialize};

use super::assembly::Assembly;
use super::beam::{Section, block, sweep, turn};
use super::region::{Region, bend};
use super::sheet::Sheet;
use geometry::mesh::TriangleMesh;

/// An object that may hang or stand in the cell without being a known part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ObjectKind {
    /// A bonnet: a part of a car that is not enrolled.
    Hood,
    /// A wheel with five spokes.
    Wheel,
    /// A cardboard box.
    Box,
    /// A chair with four legs and a back.
    Chair,
    /// A flat board.
    Board,
    /// A short ladder.
    Ladder,
    /// A round stool.
    Stool,
    /// A paint bucket.
    Bucket,
}

impl ObjectKind {
    /// All kinds.
    pub const ALL: [Self; 8] = [
        Self::Hood,
        Self::Wheel,
        Self::Box,
        Self::Chair,
        Self::Board,
        Self::Ladder,
        Self::Stool,
        Self::Bucket,
    ];

    /// Returns the name used in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hood => "hood",
            Self::Wheel => "wheel",
            Self::Box => "box",
            Self::Chair => "chair",
            Self::Board => "board",
            Self::Ladder => "ladder",
            Self::Stool => "stool",
            Self::Bucket => "bucket",
        }
    }

    /// Returns the kind of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Returns the surface in metres: the origin is the centre of the bounding box, y is down, the front faces -z.
    pub fn mesh(self) -> TriangleMesh {
        match self {
            Self::Hood => hood(),
            Self::Wheel => wheel(),
            Self::Box => cuboid(0.50, 0.38, 0.34),
            Self::Chair => chair(),
            Self::Board => cuboid(1.00, 0.60, 0.018),
            Self::Ladder => ladder(),
            Self::Stool => stool(),
            Self::Bucket => bucket(),
        }
        .centred()
    }
}

fn hood() -> Assembly {
    let outline = Region::symmetric_outline(&[
        (0.30, -0.42, 0.30),
        (0.60, -0.36, 0.06),
        (0.58, 0.05, 0.40),
        (0.50, 0.36, 0.10),
        (0.25, 0.43, 0.30),
    ]);
    let lift = |x: f64, y: f64| {
        let crease = 0.008 * (1.0 - ((x.abs() - 0.30 + 0.1 * y) / 0.06).abs()).max(0.0);
        Point3::new(
            x,
            y,
            x * x / 2.4 + (y + 0.2).powi(2) / 3.0 + 0.5 * bend(y - 0.34, 0.03) - crease,
        )
    };
    Sheet {
        region: &outline,
        u_range: (-0.65, 0.65),
        v_range: (-0.46, 0.46),
        spacing: 0.010,
        lift: &lift,
        fold: &|_, _| 0.022,
    }
    .pressed()
}

fn wheel() -> Assembly {
    let mut wheel = Assembly::default();
    let axis = -Vector3::z_axis();
    let centre = Point3::origin();
    let tyre = [
        (0.190, -0.075),
        (0.250, -0.090),
        (0.285, -0.075),
        (0.293, 0.0),
        (0.285, 0.075),
        (0.250, 0.090),
        (0.190, 0.075),
        (0.180, 0.0),
    ];
    turn(&mut wheel, centre, axis, &tyre, 48);
    turn(
        &mut wheel,
        centre,
        axis,
        &[(0.055, 0.02), (0.050, 0.06), (0.002, 0.066), (0.002, 0.02)],
        24,
    );
    for spoke in 0..5 {
        let angle = f64::from(spoke) * std::f64::consts::TAU / 5.0;
        let direction = Vector3::new(angle.sin(), -angle.cos(), 0.0);
        let path = [
            centre + direction * 0.03 - Vector3::z() * 0.05,
            centre + direction * 0.20 - Vector3::z() * 0.06,
        ];
        let section = Section::Bar {
            width: 0.055,
            depth: 0.02,
        };
        sweep(&mut wheel, &path, section, -Vector3::z());
    }
    wheel
}

fn cuboid(width: f64, height: f64, depth: f64) -> Assembly {
    let mut cuboid = Assembly::default();
    block(
        &mut cuboid,
        Point3::origin(),
        Vector3::new(width, height, depth),
    );
    cuboid
}

fn chair() -> Assembly {
    let mut chair = Assembly::default();
    block(
        &mut chair,
        Point3::new(0.0, 0.0, 0.0),
        Vector3::new(0.42, 0.03, 0.42),
    );
    block(
        &mut chair,
        Point3::new(0.0, -0.33, 0.20),
        Vector3::new(0.40, 0.20, 0.02),
    );
    let leg = Section::Round { radius: 0.016 };
    for x in [-0.19, 0.19] {
        for (z, top) in [(-0.19, 0.0), (0.20, -0.43)] {
            sweep(
                &mut chair,
                &[Point3::new(x, 0.45, z), Point3::new(x, top, z)],
                leg,
                -Vector3::z(),
            );
        }
    }
    chair
}

fn ladder() -> Assembly {
    let mut ladder = Assembly::default();
    let rail = Section::Bar {
        width: 0.030,
        depth: 0.060,
    };
    for x in [-0.19, 0.19] {
        sweep(
            &mut ladder,
            &[Point3::new(x * 1.1, 0.60, 0.0), Point3::new(x, -0.60, 0.12)],
            rail,
            -Vector3::z(),
        );
    }
    let rung = Section::Round { radius: 0.016 };
    for k in 0..5 {
        let y = 0.46 - 0.23 * f64::from(k);
        let z = 0.06 - 0.1 * y;
        sweep(
            &mut ladder,
            &[Point3::new(-0.2, y, z), Point3::new(0.2, y, z)],
            rung,
            -Vector3::z(),
        );
    }
    ladder
}

fn stool() -> Assembly {
    let mut stool = Assembly::default();
    let up = -Vector3::y_axis();
    turn(
        &mut stool,
        Point3::new(0.0, -0.24, 0.0),
        up,
        &[
            (0.002, -0.015),
            (0.170, -0.015),
            (0.175, 0.0),
            (0.165, 0.02),
            (0.002, 0.02),
        ],
        32,
    );
    let leg = Section::Round { radius: 0.014 };
    for k in 0..4 {
        let angle = (f64::from(k) + 0.5) * std::f64::consts::FRAC_PI_2;
        let (s, c) = angle.sin_cos();
        let path = [
            Point3::new(0.20 * s, 0.25, 0.20 * c),
            Point3::new(0.11 * s, -0.23, 0.11 * c),
        ];
        sweep(&mut stool, &path, leg, -Vector3::z());
    }
    stool
}

fn bucket() -> Assembly {
    let mut bucket = Assembly::default();
    let profile = [
        (0.002, -0.15),
        (0.115, -0.15),
        (0.150, 0.14),
        (0.158, 0.15),
        (0.145, 0.15),
        (0.110, -0.14),
        (0.002, -0.14),
    ];
    turn(
        &mut bucket,
        Point3::origin(),
        -Vector3::y_axis(),
        &profile,
        36,
    );
    bucket
}
