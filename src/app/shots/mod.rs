//! Scans in the window: several shots of one part, put together, and the list in which shots are dropped and taken back.
//!
//! ```text
//! ScanOrder ─► fuse, on the thread of Inspect or Enrol ─► FusedShots ─► list, 3-D view, verdict or draft
//! ```
//!
//! `choice` says which shots are used, [`work`] reads them and puts them together, [`figure`] prepares what is drawn, [`state`] holds what a person
//! asked for. The list, the summary and the legend are the same in both workspaces.

mod choice;
pub mod figure;
mod list;
mod overlay;
pub mod state;
mod summary;
pub mod work;

pub use self::{
    choice::{ScanFiles, ShotChoice},
    figure::ShotFate,
    state::{ShotsAction, ShotsState, StripTab},
    work::{FuseError, FusedShots, ScanOrder, ScanRequest},
};
pub(super) use self::{
    figure::marked,
    list::ShotList,
    overlay::{Overlay, POINT_SIZE},
    state::{apply, ask_for_poses, enrol_shown, inspection_again, inspection_of, open, settle},
    summary::summary,
    work::{Steps, Then, fuse},
};
