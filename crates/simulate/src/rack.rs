//! A rack: several parts side by side in one frame, with a truth for each.
//!
//! The cell is that of one part: wall, floor, clutter and camera are arranged around all parts of the rack as if they were
//! one. Only the parts themselves are drawn one by one, each with its own label.

mod layout;

use rand::{RngExt as _, SeedableRng as _, seq::SliceRandom as _};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};

use self::layout::{Hung, hang};
use super::assembly::Assembly;
use super::cell::{Cell, CellSetup, PartPose, SimulatedObject, Surroundings};
use super::object::ObjectKind;
use super::part::{PartKind, Side};
use super::placement::PoseRange;
use super::rasteriser::{Rendering, SurfaceLabel};
use super::sensor::{Sensor, SensorNoise};
use super::shot::{FrameTruth, Unhidden};
use super::stand::{Stand, rack as bar_with_hooks};
use geometry::depth_frame::{DepthFrame, Intrinsics};
use geometry::error::Advice;
use geometry::mesh::TriangleMesh;
use geometry::rigid::RigidTransform;
use geometry::units::{Metres, Radians};

/// How far neighbours on a rack are from each other.
///
/// The gap is measured in the front view of the rack: the clear width between a part and what hangs to its left, at the
/// height where it is least.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Spacing {
    /// Gaps of 40 to 150 mm.
    #[default]
    Apart,
    /// Gaps of 0 to 10 mm, with both parts at one depth where they come nearest.
    Touching,
    /// Neighbours in pairs, of which one hangs 100 to 300 mm clear in front of the other and hides 10 to 30 % of it from the
    /// camera; less if it is much smaller. Gaps of 40 to 150 mm beside the pairs.
    Overlapping,
}

/// What is special about a rack.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RackKind {
    /// Different parts, [apart](Spacing::Apart).
    #[default]
    Apart,
    /// Different parts, [touching](Spacing::Touching).
    Touching,
    /// Different parts, [overlapping](Spacing::Overlapping).
    Overlapping,
    /// Two equal parts among different ones, apart.
    Equal,
    /// Left and right of one kind among different parts, apart.
    Mirrored,
    /// An object that is not a known part in place of one, apart.
    Foreign,
    /// Different parts, apart, with one place empty.
    Empty,
}

impl RackKind {
    /// All kinds.
    pub const ALL: [Self; 7] = [
        Self::Apart,
        Self::Touching,
        Self::Overlapping,
        Self::Equal,
        Self::Mirrored,
        Self::Foreign,
        Self::Empty,
    ];

    /// Returns the name used on the command line and in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Apart => "apart",
            Self::Touching => "touching",
            Self::Overlapping => "overlapping",
            Self::Equal => "equal",
            Self::Mirrored => "mirrored",
            Self::Foreign => "foreign",
            Self::Empty => "empty",
        }
    }
}

/// Everything that determines a simulated frame of a rack.
#[derive(Clone, Debug, PartialEq)]
pub struct RackSetup {
    /// What hangs at each place, from left to right; 2 to 5 places, of which any may be empty.
    pub places: Vec<SimulatedObject>,
    /// How far neighbours are from each other.
    pub spacing: Spacing,
    /// The cell around the rack, which must be a plain one. Its pose is that of the rack, whose origin is the middle of its
    /// bounding box, with the axes of a part that faces the camera. From a drawn pose at which the rack would leave the
    /// picture, it is moved back up to 3.7 m, near the end of a Kinect's range. [`Stand::Post`] is a bar over all parts. Its
    /// seed also draws how each part hangs. Its subject is ignored.
    pub cell: CellSetup,
}

/// Reason why there is no frame of a rack.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error, Advice)]
pub enum RackError {
    /// Too few or too many places.
    #[error("a rack has 2 to 5 places, not {num_places}")]
    #[advice(match num_places {
        0 | 1 => "Ask for 2 to 5 places, or for a frame of a single part",
        _ => "Ask for 2 to 5 places: more parts do not fit into a picture",
    })]
    NumPlaces {
        /// The number asked for.
        num_places: usize,
    },
    /// The cell is a booth.
    #[error("a rack hangs only in a plain cell, not in a booth")]
    #[advice = "Ask for a rack in a plain cell, or for a single part in a booth"]
    Booth,
}

/// From this number of places on, parts that are much wider than high hang on end, and with more places drawn sets have no
/// doors, which are wide either way: otherwise the camera would have to stand so far away that little of each is left.
const MANY: usize = 3;

/// Separates the choice of parts from other random numbers with the same seed.
const STREAM: u64 = 0x5e7_05e7_05e7_05e7;

impl RackSetup {
    /// Draws a rack of this kind with 2 to 5 places: parts of car model `model_seed` for the left side in a tidy cell, about
    /// square to a Kinect (within 10° of yaw and pitch, 3° of roll).
    ///
    /// # Errors
    /// [`RackError::NumPlaces`].
    pub fn drawn(
        kind: RackKind,
        num_places: usize,
        model_seed: u64,
        seed: u64,
    ) -> Result<Self, RackError> {
        check_num_places(num_places)?;
        let mut random = Pcg64::seed_from_u64(seed ^ STREAM);
        let part = |kind, side| SimulatedObject::Part {
            kind,
            side,
            model_seed,
        };
        let mut kinds = PartKind::ALL.to_vec();
        if num_places > MANY {
            kinds.retain(|kind| !matches!(kind, PartKind::FrontDoor | PartKind::BackDoor));
        }
        kinds.shuffle(&mut random);
        if kind == RackKind::Mirrored {
            // A kind with two sides comes first.
            kinds.sort_by_key(|kind| !kind.is_sided());
        }
        let parts = kinds.iter().map(|&kind| part(kind, Side::Left));
        let mut places: Vec<SimulatedObject> = parts.take(num_places).collect();
        let objects = ObjectKind::ALL;
        let last = &mut places[num_places - 1];
        match kind {
            RackKind::Apart | RackKind::Touching | RackKind::Overlapping => {}
            RackKind::Equal => *last = part(kinds[0], Side::Left),
            RackKind::Mirrored => *last = part(kinds[0], Side::Right),
            RackKind::Foreign => {
                *last = SimulatedObject::Object(objects[random.random_range(0..objects.len())]);
            }
            RackKind::Empty => *last = SimulatedObject::Nothing,
        }
        places.shuffle(&mut random);
        Ok(Self {
            places,
            spacing: match kind {
                RackKind::Touching => Spacing::Touching,
                RackKind::Overlapping => Spacing::Overlapping,
                _ => Spacing::Apart,
            },
            cell: CellSetup {
                pose: PartPose::Drawn(PoseRange {
                    nearest: Metres(1.2),
                    farthest: Metres(1.8),
                    roll: Radians::from_degrees(3.0),
                    ..PoseRange::facing()
                }),
                ..CellSetup::new(SimulatedObject::Nothing, seed)
            },
        })
    }
}

fn check_num_places(num_places: usize) -> Result<(), RackError> {
    if (2..=5).contains(&num_places) {
        Ok(())
    } else {
        Err(RackError::NumPlaces { num_places })
    }
}

/// The truth about a frame of a rack.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RackTruth {
    /// The truth about every part and object on the rack, from left to right; empty places are left out. Their labels are
    /// empty: those of the frame are here.
    pub parts: Vec<FrameTruth>,
    /// The surface that each pixel shows, row by row from the top left, before any noise: [`SurfaceLabel::RackPart`] has the
    /// number of the part in `parts`.
    #[serde(skip)]
    pub labels: Vec<SurfaceLabel>,
}

/// A frame of a rack as the sensor delivers it, with its truth.
#[derive(Clone, Debug, PartialEq)]
pub struct RackFrame {
    /// The camera's frame.
    pub frame: DepthFrame,
    /// The truth about the frame.
    pub truth: RackTruth,
}

/// Hangs the parts, arranges the cell around them, and takes one frame.
///
/// # Errors
/// [`RackError`] if the setup is out of range.
pub fn rack_frame(setup: &RackSetup) -> Result<RackFrame, RackError> {
    let hung = checked(setup)?;
    let all = assembled(&hung);
    let cell = cell_around(setup, &hung, &all);
    let mut rendering = Rendering::new(setup.cell.intrinsics);
    let mut unhidden = Vec::with_capacity(hung.len());
    for (part, number) in hung.iter().zip(0..) {
        let label = SurfaceLabel::RackPart(number);
        let mut alone = Rendering::new(setup.cell.intrinsics);
        alone.draw_mesh(&part.mesh, &part.camera_from_part, label);
        let pose = &part.camera_from_part;
        unhidden.push(Unhidden::count(&alone, &cell, &part.mesh, pose, label));
        rendering.draw_behind(&alone);
    }
    cell.draw_rest(&mut rendering);
    let parts = hung.iter().zip(&unhidden);
    let parts = parts
        .map(|(part, unhidden)| unhidden.truth(part.object, &cell, &rendering))
        .collect();
    Ok(RackFrame {
        frame: cell.sensor.sense(&rendering, &setup.cell.noise),
        truth: RackTruth {
            parts,
            labels: rendering.labels,
        },
    })
}

/// Hangs the parts.
fn checked(setup: &RackSetup) -> Result<Vec<Hung>, RackError> {
    check_num_places(setup.places.len())?;
    if setup.cell.surroundings == Surroundings::Booth {
        return Err(RackError::Booth);
    }
    Ok(hang(setup))
}

/// All parts as one, in camera space.
fn assembled(hung: &[Hung]) -> TriangleMesh {
    let mut all = Assembly::default();
    for part in hung {
        all.add(&part.mesh, |p| part.camera_from_part * p);
    }
    all.into_mesh()
}

/// Arranges the cell around the parts, of which `all` is assembled.
fn cell_around<'a>(setup: &RackSetup, hung: &[Hung], all: &'a TriangleMesh) -> Cell<'a> {
    let stand = match setup.cell.stand {
        Stand::Post => Stand::None,
        other => other,
    };
    let around = CellSetup {
        pose: PartPose::Fixed(RigidTransform::identity()),
        stand,
        ..setup.cell
    };
    let mut cell = Cell::arrange(&around, all);
    if setup.cell.stand == Stand::Post {
        let parts: Vec<_> = hung.iter().map(Hung::vertices).collect();
        let floor = cell
            .planes
            .iter()
            .find(|(_, label)| *label == SurfaceLabel::Floor);
        let bar = floor.map(|(floor, _)| bar_with_hooks(&parts, floor));
        cell.meshes
            .extend(bar.map(|bar| (bar.into_mesh(), SurfaceLabel::Stand)));
    }
    cell
}

/// A fixed cell for many frames of a rack, of which each part is there or not and may move.
pub struct StandingRack {
    hung: Vec<Hung>,
    intrinsics: Intrinsics,
    /// Everything but the parts.
    backdrop: Rendering,
    sensor: Box<dyn Sensor>,
}

impl StandingRack {
    /// Hangs the parts, and arranges the cell around them.
    ///
    /// # Errors
    /// [`RackError`] if the setup is out of range.
    pub fn arrange(setup: &RackSetup) -> Result<Self, RackError> {
        let hung = checked(setup)?;
        let all = assembled(&hung);
        let cell = cell_around(setup, &hung, &all);
        let mut backdrop = Rendering::new(setup.cell.intrinsics);
        cell.draw_rest(&mut backdrop);
        let sensor = cell.sensor;
        Ok(Self {
            hung,
            intrinsics: setup.cell.intrinsics,
            backdrop,
            sensor,
        })
    }

    /// Takes a frame. `moved` gives how each part, numbered from the left, has moved from its place on the rack, in camera
    /// space; `None` if it is not there.
    pub fn frame(
        &self,
        moved: impl Fn(usize) -> Option<RigidTransform>,
        noise: &SensorNoise,
    ) -> DepthFrame {
        let mut rendering = Rendering::new(self.intrinsics);
        for ((number, part), label) in self.hung.iter().enumerate().zip(0..) {
            if let Some(moved) = moved(number) {
                let pose = moved * part.camera_from_part;
                rendering.draw_mesh(&part.mesh, &pose, SurfaceLabel::RackPart(label));
            }
        }
        rendering.draw_behind(&self.backdrop);
        self.sensor.sense(&rendering, noise)
    }
}

#[cfg(test)]
mod tests;
