//! Scans in the window: several shots of one part, put together, and the list in which shots are dropped and taken back.
//!
//! ```text
//! ShotsAction ─► ShotsState::apply ─► ScanOrder ─► fuse, in the task of Inspect or Enrol ─► FusedShots ─► list, 3-D view,
//!                                                                                          verdict or draft
//! ```
//!
//! [`choice`] says which shots are used, [`work`] reads them and puts them together, [`figure`] prepares what is drawn,
//! [`state`] holds what a person asked for. Inspect and Enrol each own a [`ShotsState`]; the list, the summary and the
//! legend are the same in both.

pub mod choice;
pub mod figure;
mod list;
mod overlay;
pub mod state;
mod summary;
pub mod work;

pub use self::{
    choice::{ScanFiles, ScanOrder, ScanRequest, ShotChoice},
    figure::ShotFate,
    state::{Asked, ShotsAction, ShotsFile, ShotsState, StripTab},
    work::{FuseError, FusedShots},
};
pub(super) use self::{
    figure::marked,
    list::{ShotList, ShownShots},
    overlay::{Overlay, POINT_SIZE},
    summary::summary,
    work::{Steps, Then, fuse},
};
