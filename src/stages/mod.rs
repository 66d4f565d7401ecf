//! The stages in the order of the flow, each a pure function from one type to the next.
//!
//! ```text
//! DepthFrame ─► SceneCloud ─► SegmentedPart ─► PlaneImage ─► Contour ─► FanSignature ─► MatchRanking ─► PoseEstimate
//!           scene        segment         project        contour    signature       rank            pose
//! ```
//!
//! `reference` prepares an enrolled part for the last two, `correlation` is the signal processing below `rank`, and `locate`
//! takes a scene's part to `pose` as the paper does. `stand_off` follows the pose where it is shown: how far the nozzle
//! would be from the part.

pub mod confirm;
pub mod contour;
pub mod correlation;
pub mod descriptors;
pub mod field_of_view;
pub mod locate;
pub mod pose;
pub mod project;
pub mod rank;
mod reduce;
pub mod reference;
pub mod scene;
pub mod segment;
pub mod signature;
pub mod stand_off;
