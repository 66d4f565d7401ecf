//! The stages in the order of the flow, each a pure function from one type to the next.
//!
//! ```text
//! DepthFrame ─► SceneCloud ─► SegmentedPart ─► PlaneImage ─► Contour ─► FanSignature ─► MatchRanking ─► PoseEstimate
//!           scene        segment         project        contour    signature       rank            pose
//! ```
//!
//! `reference` prepares an enrolled part for `rank` and `pose`, `correlation` holds the signal processing of `rank`,
//! `shape_summary` rules out most references of a large library, and `locate` runs `pose` on a scene's part as the paper does. `stand_off` computes the distance of the nozzle from
//! the part; it runs where it is shown.

pub mod confirm;
pub mod contour;
pub mod correlation;
pub mod descriptors;
pub mod field_of_view;
#[cfg(any(test, feature = "fixtures"))]
pub mod fixtures;
pub mod locate;
pub mod pose;
pub mod project;
pub mod rank;
mod reduce;
pub mod reference;
pub mod scan;
pub mod scene;
pub mod segment;
pub mod shape_summary;
pub mod signature;
pub mod stand_off;
