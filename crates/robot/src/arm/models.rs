//! Five arms that are common in paint shops, with their published parameters.
//!
//! Lengths, signs and offsets are those of ROS-Industrial's `opw_parameters_*.yaml` (Apache 2.0 and BSD):
//! `kuka_kr6_support`, `fanuc_m20ia_support`, `abb_irb2600_support`, `abb_irb4600_support`, `motoman_gp25_support`.
//! Limits and speeds are those of the URDF beside them; for the IRB 2600 those of ABB's *Product specification IRB
//! 2600*, because its URDF has the limits of joint 2 the other way round. The radii of upper arm, forearm and wrist are
//! not published: they are generous estimates from the proportions of the makers' drawings.

use std::path::Path;

use super::{Arm, ArmError};
use crate::Convention;

/// Names of the arms that are built in.
pub const ARM_NAMES: [&str; 5] = ["kr6-r900", "m-20ia", "irb2600", "irb4600", "gp25"];

struct Numbers {
    lengths: [f64; 7],
    offsets_deg: [f64; 6],
    signs: [i8; 6],
    limits_deg: [[f64; 2]; 6],
    speeds_deg: [f64; 6],
    radii_mm: [f64; 3],
}

const KR6_R900: Numbers = Numbers {
    lengths: [0.025, -0.025, 0.0, 0.4, 0.455, 0.42, 0.09],
    offsets_deg: [0.0, -90.0, 0.0, 0.0, 0.0, 0.0],
    signs: [-1, 1, 1, -1, 1, -1],
    limits_deg: [
        [-170.0, 170.0],
        [-190.0, 45.0],
        [-120.0, 156.0],
        [-185.0, 185.0],
        [-120.0, 120.0],
        [-350.0, 350.0],
    ],
    speeds_deg: [360.0, 300.0, 360.0, 450.0, 450.0, 540.0],
    radii_mm: [90.0, 80.0, 55.0],
};

const M_20IA: Numbers = Numbers {
    lengths: [0.15, -0.25, 0.0, 0.525, 0.79, 0.835, 0.1],
    offsets_deg: [0.0, 0.0, -90.0, 0.0, 0.0, 180.0],
    signs: [1, 1, -1, -1, -1, -1],
    limits_deg: [
        [-170.0, 170.0],
        [-100.0, 160.0],
        [-185.0, 273.1],
        [-200.0, 200.0],
        [-140.0, 140.0],
        [-270.0, 270.0],
    ],
    speeds_deg: [195.0, 175.0, 180.0, 360.0, 360.0, 550.0],
    radii_mm: [140.0, 130.0, 85.0],
};

const IRB2600: Numbers = Numbers {
    lengths: [0.15, -0.115, 0.0, 0.445, 0.7, 0.795, 0.085],
    offsets_deg: [0.0, 0.0, -90.0, 0.0, 0.0, 0.0],
    signs: [1; 6],
    limits_deg: [
        [-180.0, 180.0],
        [-95.0, 155.0],
        [-180.0, 75.0],
        [-400.0, 400.0],
        [-120.0, 120.0],
        [-400.0, 400.0],
    ],
    speeds_deg: [175.0, 175.0, 175.0, 360.0, 360.0, 500.0],
    radii_mm: [140.0, 125.0, 80.0],
};

const IRB4600: Numbers = Numbers {
    lengths: [0.175, -0.175, 0.0, 0.495, 1.095, 1.27, 0.135],
    offsets_deg: [0.0, 0.0, -90.0, 0.0, 0.0, 0.0],
    signs: [1; 6],
    limits_deg: [
        [-180.0, 180.0],
        [-90.0, 150.0],
        [-180.0, 75.0],
        [-400.0, 400.0],
        [-125.0, 120.0],
        [-400.0, 400.0],
    ],
    speeds_deg: [175.0, 175.0, 175.0, 250.0, 250.0, 360.0],
    radii_mm: [200.0, 170.0, 110.0],
};

const GP25: Numbers = Numbers {
    lengths: [0.15, -0.2, 0.0, 0.505, 0.76, 0.795, 0.1],
    offsets_deg: [0.0, 0.0, -90.0, 0.0, 0.0, 180.0],
    signs: [1, 1, -1, -1, -1, -1],
    limits_deg: [
        [-180.0, 180.0],
        [-105.0, 155.0],
        [-86.0, 160.0],
        [-200.0, 200.0],
        [-155.0, 150.0],
        [-455.0, 455.0],
    ],
    speeds_deg: [210.0, 210.0, 265.0, 420.0, 420.0, 885.0],
    radii_mm: [140.0, 125.0, 80.0],
};

impl Arm {
    /// Returns the arm of one of the [`ARM_NAMES`], or reads that of a TOML file.
    pub fn named(name: &str) -> Result<Self, ArmError> {
        let (title, numbers, base_height, maker) = match name {
            "kr6-r900" => ("KUKA KR 6 R900-2", KR6_R900, 0.0, Convention::Kuka),
            // FANUC's and Yaskawa's base frames are at the height of joint 2.
            "m-20ia" => ("FANUC M-20iA", M_20IA, 0.525, Convention::Fanuc),
            "irb2600" => ("ABB IRB 2600-12/1.65", IRB2600, 0.0, Convention::Abb),
            "irb4600" => ("ABB IRB 4600-40/2.55", IRB4600, 0.0, Convention::Abb),
            "gp25" => ("Yaskawa GP25", GP25, 0.505, Convention::Yaskawa),
            _ => return Self::unlisted(name),
        };
        Self {
            name: title.into(),
            lengths: numbers.lengths,
            offsets: numbers.offsets_deg.map(f64::to_radians),
            signs: numbers.signs,
            limits: numbers.limits_deg.map(|limits| limits.map(f64::to_radians)),
            speeds: numbers.speeds_deg.map(f64::to_radians),
            // The makers publish none.
            accelerations: None,
            base_height,
            radii: numbers.radii_mm.map(|radius| radius / 1000.0),
            maker: Some(maker),
            rail: None,
        }
        .checked()
    }

    fn unlisted(name: &str) -> Result<Self, ArmError> {
        let path = Path::new(name);
        let is_toml = path
            .extension()
            .is_some_and(|e| e.eq_ignore_ascii_case("toml"));
        if is_toml {
            return Self::read(path);
        }
        let lower = name.to_lowercase();
        let is_universal = (lower.strip_prefix("ur"))
            .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
        Err(if is_universal {
            ArmError::NoSphericalWrist { name: name.into() }
        } else {
            ArmError::Unknown { name: name.into() }
        })
    }
}
