//! The eight kinds of part, and one model of a part.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::assembly::mirrored;
use super::parts;
use super::variation::Variation;
use geometry::mesh::TriangleMesh;

/// The eight parts of a car body that the cell paints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PartKind {
    /// The skin around the nose of the car, below grille and head lamps.
    FrontBumper,
    /// The lid of the boot: deck and rear face.
    TrunkLid,
    /// The skin around the tail of the car.
    BackBumper,
    /// A rear side door with its window frame.
    BackDoor,
    /// A front side door with its window frame.
    FrontDoor,
    /// The frame behind the grille that carries radiator, fan and head lamps.
    RadiatorSupport,
    /// The slatted air inlet with the maker's badge.
    Grille,
    /// The side panel over the front wheel.
    Fender,
}

impl PartKind {
    /// All kinds, in the order of the paper's Table I.
    pub const ALL: [Self; 8] = [
        Self::FrontBumper,
        Self::TrunkLid,
        Self::BackBumper,
        Self::BackDoor,
        Self::FrontDoor,
        Self::RadiatorSupport,
        Self::Grille,
        Self::Fender,
    ];

    /// Returns the name used in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::FrontBumper => "front_bumper",
            Self::TrunkLid => "trunk_lid",
            Self::BackBumper => "back_bumper",
            Self::BackDoor => "back_door",
            Self::FrontDoor => "front_door",
            Self::RadiatorSupport => "radiator_support",
            Self::Grille => "grille",
            Self::Fender => "fender",
        }
    }

    /// Returns the name to display.
    pub fn title(self) -> &'static str {
        match self {
            Self::FrontBumper => "Front bumper",
            Self::TrunkLid => "Trunk lid",
            Self::BackBumper => "Back bumper",
            Self::BackDoor => "Back door",
            Self::FrontDoor => "Front door",
            Self::RadiatorSupport => "Radiator support",
            Self::Grille => "Grille",
            Self::Fender => "Fender",
        }
    }

    /// Returns the kind of this name, as given by [`PartKind::name`].
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Returns true for parts that a car has once on each side, as mirror images of each other.
    pub fn is_sided(self) -> bool {
        matches!(self, Self::BackDoor | Self::FrontDoor | Self::Fender)
    }
}

impl fmt::Display for PartKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A side of the car, as seen by its driver.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum Side {
    /// The left side. On its parts, the front of the car is on the viewer's left.
    #[default]
    Left,
    /// The right side.
    Right,
}

impl Side {
    /// Both sides.
    pub const ALL: [Self; 2] = [Self::Left, Self::Right];

    /// Returns the name used in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }

    /// Returns the side of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|side| side.name() == name)
    }
}

/// One part of one car model.
///
/// Part space is in metres: the origin is the centre of the bounding box; for a viewer who faces the paint side, x is right,
/// y down and z away. The paint side faces -z.
#[derive(Clone, Debug)]
pub struct PartModel {
    kind: PartKind,
    side: Option<Side>,
    model_seed: u64,
    mesh: TriangleMesh,
}

impl PartModel {
    /// Builds the part of car model `model_seed`: 0 is the standard car, any other seed another car of the same class, and
    /// from [`FIRST_OTHER_MAKE`](crate::FIRST_OTHER_MAKE) on a car of another make.
    ///
    /// `side` is ignored for parts without sides.
    pub fn new(kind: PartKind, side: Side, model_seed: u64) -> Self {
        let left = parts::build(kind, &mut Variation::new(model_seed, kind as u64)).centred();
        let side = kind.is_sided().then_some(side);
        let mesh = match side {
            Some(Side::Right) => mirrored(&left),
            Some(Side::Left) | None => left,
        };
        Self {
            kind,
            side,
            model_seed,
            mesh,
        }
    }

    /// Returns the kind of part.
    pub fn kind(&self) -> PartKind {
        self.kind
    }

    /// Returns the side of the car; `None` for parts without sides.
    pub fn side(&self) -> Option<Side> {
        self.side
    }

    /// Returns the seed of the car model.
    pub fn model_seed(&self) -> u64 {
        self.model_seed
    }

    /// Returns the surface in part space.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// Returns the surface in part space without copying it.
    pub fn into_mesh(self) -> TriangleMesh {
        self.mesh
    }
}

#[cfg(test)]
mod tests;
