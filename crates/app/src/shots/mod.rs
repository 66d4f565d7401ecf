//! Scans in the window: several shots of one part put together, and the list in which shots are dropped and restored.
//!
//! ```text
//! ShotsAction ─► ShotsState::apply ─► ScanOrder ─► fuse, in the task of Inspect or Enrol ─► FusedShots ─► list, 3-D view,
//!                                                                                          verdict or draft
//! ```
//!
//! Inspect and Enrol each own a [`ShotsState`]; they share the list, the summary and the legend.

mod list;
mod overlay;
mod state;

pub use self::state::{Asked, ShotsAction, ShotsFile, ShotsState, StripTab};
pub(crate) use self::{
    list::{ShotList, ShownShots, summary},
    overlay::{Overlay, POINT_SIZE},
    state::source_of,
};
