//! The parts that hang in front of a followed source one after the other: one inspection of each is kept and published.

use std::{sync::Arc, time::Duration};

use jiff::Timestamp;
use nalgebra::Point3;

use crate::{
    history::{HungId, HungRows, NewEntry},
    pipeline::{
        AcceptParams, Inspection,
        live::{FrameRole, HungFrame, LiveParams, LiveTracker},
    },
    stages::{field_of_view::FieldOfView, scene::SceneCloud},
};

/// Tells successive parts apart.
pub(in crate::cli) struct FollowedParts<E = NewEntry> {
    tracker: LiveTracker,
    rows: HungRows<E>,
}

/// A frame and its own inspection.
pub(in crate::cli) struct FollowedFrame<'a> {
    pub(in crate::cli) scene: &'a Arc<SceneCloud>,
    pub(in crate::cli) taken_at: Timestamp,
    /// Middle of the named part, part space, metres.
    pub(in crate::cli) middle: Option<Point3<f64>>,
    pub(in crate::cli) accept: &'a AcceptParams,
}

impl<E> FollowedParts<E> {
    /// Creates the state before the first frame.
    pub(in crate::cli) fn new() -> Self {
        Self {
            tracker: LiveTracker::new(&LiveParams::default()),
            rows: HungRows::default(),
        }
    }

    /// Returns the camera's field of view as far as the frames have shown it.
    pub(in crate::cli) fn known_view(&self) -> Option<Arc<FieldOfView>> {
        self.tracker.known_view()
    }

    /// Takes in a frame, and returns what to write now. The verdict that counts is formed from several frames; for a
    /// part that leaves before, the frame that shows it best is used with its own verdict.
    pub(in crate::cli) fn take(
        &mut self,
        frame: &FollowedFrame<'_>,
        mut inspection: Inspection,
        entry: impl Fn(&Inspection, HungId) -> E,
    ) -> [Option<E>; 2] {
        let at = Duration::try_from(frame.taken_at.as_duration()).unwrap_or_default();
        self.tracker.look(Arc::clone(frame.scene), at);
        let own = inspection.verdict.clone();
        let verdict = self
            .tracker
            .judge(&mut inspection, frame.middle, frame.accept);
        let (left, role) = self.rows.see(&HungFrame {
            scene: frame.scene,
            at,
            inspection: &inspection,
            verdict: &verdict,
            middle: frame.middle,
            // Recipe and library do not change between frames.
            inputs: "",
        });
        let id = self.rows.id().clone();
        let now = match role {
            FrameRole::Nothing => None,
            FrameRole::Best => {
                inspection.verdict = own;
                self.rows.hold(entry(&inspection, id));
                None
            }
            FrameRole::First | FrameRole::Again => Some(entry(&inspection, id)),
        };
        [left, now]
    }

    /// Ends the source. Returns what is still to be written.
    pub(in crate::cli) fn end(mut self) -> Option<E> {
        self.rows.end()
    }
}
