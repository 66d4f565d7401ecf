//! The stages in the order of the flow, each a pure function from one type to the next.
//!
//! ```text
//! DepthFrame ─► SceneCloud ─► SegmentedPart ─► PlaneImage ─► Contour ─► FanSignature ─► MatchRanking ─► PoseEstimate
//!           scene        segment         project        contour    signature       rank            pose
//! ```

pub mod contour;
pub mod project;
pub mod scene;
pub mod segment;
pub mod signature;
