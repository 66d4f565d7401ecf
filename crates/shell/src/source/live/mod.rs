//! Live: follows a camera and inspects as many of its frames as possible; a verdict counts once the part hangs still.
//!
//! The camera's thread hands over its newest frame, the task's thread inspects it, and the window shows the latest result.
//! Frames that arrive during an inspection are dropped. An inspection waits only until the watch for motion has seen its frame,
//! 3 s at most.

mod parts;
pub mod state;
mod status;
mod work;

pub(crate) use self::{
    parts::{FollowedParts, assign_as_before},
    state::{
        apply, expect_anew, give_way, outdate_shown, restart_consensus, show_unseen,
        source_changed, tell_if_lost,
    },
    status::{figures, motion, name, source_state},
};
pub use self::{
    state::{close, update},
    status::card,
    work::{
        Follower, LiveAction, LiveAnswer, LiveState, LiveStatus, LiveStatusUpdate, SourceState,
    },
};
