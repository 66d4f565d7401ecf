//! Live: a camera is followed, every frame that can be is inspected, and a verdict counts once the part hangs still.
//!
//! The camera's own thread hands over its newest frame, the task's thread inspects it, and the window shows the latest
//! result. No thread waits for another: frames that come while an inspection runs are dropped.

mod set_up;
pub mod state;
mod status;
mod work;

pub(in crate::app) use self::{
    set_up::set_up,
    state::{apply, give_way, restart_consensus, source_changed, update},
    status::{card, chip, words},
};
pub use self::{
    state::{Follower, LiveAction, LiveState},
    work::{LiveAnswer, LiveStatus, LiveStatusUpdate, SourceState},
};
