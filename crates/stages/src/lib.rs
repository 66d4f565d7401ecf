//! The stages in the order of the flow, each a pure function from one type to the next.
//!
//! ```text
//! DepthFrame ─► SceneCloud ─► SegmentedPart ─► PlaneImage ─► Contour ─► FanSignature ─► MatchRanking ─► ConfirmedRanking
//!           scene        segment         project        contour    signature       rank            confirm, or pose
//! ```
//!
//! - [`mod@reference`] prepares an enrolled part for `rank` and `pose`; [`shape_summary`] rules out most references of a large
//!   library; [`correlation`] is the signal processing of `rank`.
//! - [`paper`] is the paper's own method of matching and pose; [`locate`] estimates the pose of a scene's part with it.
//! - [`confirm`] scores the best references by surface, outline and openings.
//! - [`scan`] combines several frames; [`stand_off`] is the distance of the nozzle, computed where it is shown.
//! - [`deviation`] holds the surface of an accepted part against its reference: dents, bumps, missing surface.
//! - [`descriptors`] are those of other systems, for comparison.

pub mod confirm;
pub mod contour;
pub mod correlation;
pub mod descriptors;
pub mod deviation;
pub mod field_of_view;
#[cfg(any(test, feature = "fixtures"))]
pub mod fixtures;
pub mod locate;
pub mod paper;
pub mod pose;
pub mod project;
pub mod rack;
pub mod rank;
mod reduce;
pub mod reference;
pub mod scan;
pub mod scene;
pub mod segment;
pub mod shape_summary;
pub mod signature;
pub mod stand_off;
