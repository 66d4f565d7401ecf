//! A simulated cell: parametric car parts in front of wall and floor, seen by a depth camera with a Kinect's noise.
//!
//! Everything is derived from seeds: the same [`CellSetup`] gives the same bits on every machine of one architecture.
//!
//! ```text
//! PartModel / ObjectKind ─► TriangleMesh ─┐
//! Placement ─► camera_from_part ──────────┼─► Cell ─► Rendering ─► DepthFrame + Truth
//! Stand, Clutter, wall, floor ────────────┘  cell    rasteriser    sensor
//! ```
//!
//! A rack is several parts that hang side by side: [`rack_frame`] arranges the cell around all of them, with a truth for each.
//! A [`SimulatedLine`] carries parts past the camera, with the truth at every time and the counts of an encoder.
//! [`Surroundings::Booth`] replaces the lower two inputs by a paint booth, seen by a camera on the robot's flange.

mod assembly;
mod beam;
mod booth;
mod cell;
mod clutter;
mod dent;
#[cfg(any(test, feature = "fixtures"))]
pub mod fixtures;
mod line;
mod object;
mod part;
mod parts;
mod placement;
mod plan_curve;
mod rack;
mod rasteriser;
mod region;
mod scan;
mod sensor;
mod sheet;
mod shot;
mod stand;
mod standing_cell;
mod stereo;
mod time_of_flight;
mod variation;

pub use cell::{CellSetup, PartPose, SimulatedObject, Surroundings};
pub use clutter::Clutter;
pub use dent::Dent;
pub use line::{LineEncoder, LinePart, LineSetup, SimulatedLine};
pub use object::ObjectKind;
pub use part::{PartKind, PartModel, Side};
pub use placement::{PoseRange, SampledPose};
pub use rack::{
    RackError, RackFrame, RackKind, RackSetup, RackTruth, Spacing, StandingRack, rack_frame,
};
pub use rasteriser::SurfaceLabel;
pub use scan::{ScanSetup, SimulatedScan, SimulatedShot};
pub use sensor::SensorNoise;
pub use shot::{FrameTruth, SimulatedFrame, frame, frame_of_mesh};
pub use stand::Stand;
pub use standing_cell::StandingCell;
pub use stereo::stereo_frame;
pub use time_of_flight::time_of_flight_frame;
pub use variation::FIRST_OTHER_MAKE;
