//! An arm as a TOML file.
//!
//! ```toml
//! name = "Cell 3"
//! lengths_mm = [150, -200, 0, 505, 760, 795, 100]   # a1 a2 b c1 c2 c3 c4
//! offsets_deg = [0, 0, -90, 0, 0, 180]
//! signs = [1, 1, -1, -1, -1, -1]
//! limits_deg = [[-180, 180], [-105, 155], [-86, 160], [-200, 200], [-155, 150], [-455, 455]]
//! speeds_deg_s = [210, 210, 265, 420, 420, 885]
//! accelerations_deg_s2 = [600, 600, 700, 1500, 1500, 2500]   # without them accelerations are not checked
//! base_height_mm = 505                              # the controller's base frame above the foot; 0 without it
//! radii_mm = [140, 125, 80]                         # upper arm, forearm, wrist: what they fill around their axes
//! [rail]                                            # if it stands on one
//! direction = [0, 1, 0]
//! from_mm = -2000
//! to_mm = 2000
//! speed_mm_s = 1000                                 # top speed; without it the rail stands still along a path
//! acceleration_mm_s2 = 2000                         # without it the rail's acceleration is neither kept to nor checked
//! ```
//!
//! The default of `radii_mm` is 10, 9 and 6 % of the reach, more than most arms have.

use std::path::Path;

use nalgebra::{Unit, Vector3};
use serde::Deserialize;

use super::{Arm, ArmError, Rail};
use files::read_text;

/// Default radii of upper arm, forearm and wrist, as shares of the reach.
const RADII: [f64; 3] = [0.10, 0.09, 0.06];

/// Largest file that is read, bytes.
const MAX_BYTES: u64 = 1 << 20;

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Text {
    name: String,
    lengths_mm: [f64; 7],
    offsets_deg: [f64; 6],
    signs: [i8; 6],
    limits_deg: [[f64; 2]; 6],
    speeds_deg_s: [f64; 6],
    accelerations_deg_s2: Option<[f64; 6]>,
    #[serde(default)]
    base_height_mm: f64,
    radii_mm: Option<[f64; 3]>,
    rail: Option<RailText>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct RailText {
    direction: [f64; 3],
    from_mm: f64,
    to_mm: f64,
    speed_mm_s: Option<f64>,
    acceleration_mm_s2: Option<f64>,
}

impl Arm {
    /// Reads an arm from a TOML file.
    pub fn read(path: &Path) -> Result<Self, ArmError> {
        let wrong = |message: String| ArmError::Text {
            path: path.to_owned(),
            message,
        };
        let text: Text = toml::from_str(&read_text(path, MAX_BYTES)?)
            .map_err(|error| wrong(error.message().to_owned()))?;
        let rail = text.rail.map(|rail| -> Result<Rail, ArmError> {
            let direction = Unit::try_new(Vector3::from(rail.direction), 1e-6)
                // False if the direction or its length is not finite.
                .filter(|direction| (direction.norm() - 1.0).abs() < 1e-6);
            let direction = direction.ok_or_else(|| wrong("the rail has no direction".into()))?;
            if rail.acceleration_mm_s2.is_some() && rail.speed_mm_s.is_none() {
                return Err(wrong(
                    "the rail has acceleration_mm_s2 but no speed_mm_s".into(),
                ));
            }
            Ok(Rail {
                direction,
                range: [rail.from_mm / 1000.0, rail.to_mm / 1000.0],
                speed: rail.speed_mm_s.map(|speed| speed / 1000.0),
                acceleration: rail.acceleration_mm_s2.map(|limit| limit / 1000.0),
            })
        });
        let mut arm = Self {
            name: text.name,
            lengths: text.lengths_mm.map(|length| length / 1000.0),
            offsets: text.offsets_deg.map(f64::to_radians),
            signs: text.signs,
            limits: text.limits_deg.map(|limits| limits.map(f64::to_radians)),
            speeds: text.speeds_deg_s.map(f64::to_radians),
            accelerations: text
                .accelerations_deg_s2
                .map(|limits| limits.map(f64::to_radians)),
            base_height: text.base_height_mm / 1000.0,
            radii: [0.0; 3],
            maker: None,
            rail: rail.transpose()?,
        };
        arm.radii = match text.radii_mm {
            Some(radii) => radii.map(|radius| radius / 1000.0),
            None => RADII.map(|share| share * arm.reach()),
        };
        arm.checked()
    }
}
