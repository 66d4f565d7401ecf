//! The scan that Inspect shows: its shots are put together anew and inspected as one.

use std::sync::Arc;

use crate::app::{
    action::{DialogRequest, Effect, notify},
    inspect::work::{InspectRequest, Inspected},
    job::{Request, Trouble},
    lane::TaskQueue,
    shots::{
        Asked, FusedShots, ScanOrder, ScanRequest, ShotChoice, ShotsAction, ShotsFile,
        state::source_of,
    },
    source::SceneSource,
    state::{Session, Source, State},
};

impl State {
    /// The scan that Inspect shows.
    pub fn fused(&self) -> Option<&Arc<FusedShots>> {
        let scan = self.shown.as_ref()?.inspected.scan.as_ref()?;
        Some(&scan.fused)
    }

    /// Which of its shots shall be used: what was asked for last, while that is on its way.
    pub fn shot_choice(&self) -> Option<&ShotChoice> {
        let is_inspecting = self.works.contains_key(&TaskQueue::Inspect);
        let asked = self.inspect.shots.asked_choice();
        let asked = asked.filter(|_| is_inspecting);
        Some(asked.unwrap_or(&self.fused()?.choice))
    }
}

/// Carries out an action.
pub(in crate::app) fn apply(state: &mut State, action: ShotsAction) -> Option<Effect> {
    if let ShotsAction::Ask(file) = action {
        return Some(Effect::ShowDialog(match file {
            ShotsFile::Shot => DialogRequest::Shot,
            ShotsFile::Poses => DialogRequest::ScanPoses,
        }));
    }
    let used = state.shot_choice().cloned();
    match state.inspect.shots.apply(action, used) {
        Ok(start) => {
            let (order, asked) = start?;
            if let ScanOrder::Open(files) = &order {
                state.source = Source::Scan(files.clone());
            }
            Some(begin(state, order, asked))
        }
        Err(notice) => {
            notify(state, notice);
            None
        }
    }
}

/// Has shots put together and inspected.
pub(in crate::app) fn begin(state: &mut State, order: ScanOrder, asked: Asked) -> Effect {
    let title = order.title();
    let request = ScanRequest::of(order, &state.session);
    let effect = state.begin(title, Request::InspectScan(request));
    state.inspect.shots.started(Some(asked));
    effect
}

/// The request that inspects what is shown once more: all shots of a scan, else the scene.
pub(in crate::app) fn inspection_again(session: &Session, inspected: &Inspected) -> Request {
    match &inspected.scan {
        Some(scan) => {
            let order = ScanOrder::Known(scan.fused.choice.clone());
            Request::InspectScan(ScanRequest::of(order, session))
        }
        None => Request::Inspect(InspectRequest {
            source: SceneSource::AtHand(inspected.scene.clone(), inspected.origin.clone()),
            recipe: session.recipe.clone(),
        }),
    }
}

/// Asks for the file of the poses that were not found.
pub(in crate::app) fn ask_for_poses(
    state: &mut State,
    order: ScanOrder,
    trouble: Trouble,
) -> Effect {
    notify(state, trouble.into());
    state.inspect.shots.ask_for_poses(order);
    Effect::ShowDialog(DialogRequest::ScanPoses)
}

/// A result has come, in the place of one with the choice `former`: what was asked for can be taken back.
pub(in crate::app) fn settle(state: &mut State, former: Option<ShotChoice>) {
    let files = state.fused().map(|fused| fused.choice.files());
    // The next start opens the same shots.
    if let Some(files) = &files
        && let Some(source) = source_of(files, &state.source)
    {
        state.source = source;
    }
    state.inspect.shots.settle(files.as_ref(), former);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        app::{
            action::{Action, apply as apply_any},
            job::{TaskOutcome, answer},
            shelf::LibraryCache,
            worker::{JobContext, TaskEvent},
        },
        files::write_depth_png,
        geometry::depth_frame::{DepthFrame, Intrinsics},
        pipeline::ProgressObserver,
    };

    struct NobodysDesk;

    impl ProgressObserver for NobodysDesk {}

    impl JobContext<TaskOutcome> for NobodysDesk {
        fn progress(&self, _done: usize, _total: usize) {}
        fn publish_partial(&self, _outcome: TaskOutcome) {}
        fn stands(&self, _outcome: TaskOutcome) {}
        fn wants_more(&self) -> bool {
            true
        }
    }

    fn posted(effect: Option<Effect>) -> (u64, ScanRequest) {
        match effect {
            Some(Effect::Post {
                generation,
                request: Request::InspectScan(request),
            }) => (generation, request),
            other => panic!("expected a scan, found {other:?}"),
        }
    }

    #[test]
    fn poses_that_are_not_found_are_asked_for_and_the_scan_is_opened_with_them() {
        let folder = tempfile::tempdir().expect("a folder");
        let frame = DepthFrame {
            intrinsics: Intrinsics {
                width: 8,
                height: 6,
                ..Intrinsics::KINECT
            },
            metres_per_unit: 0.001,
            depth: vec![900; 48],
            is_simulated: true,
        };
        for name in ["a.png", "b.png"] {
            write_depth_png(&folder.path().join(name), &frame).expect("written");
        }
        let mut state = State::default();
        let opened = apply_any(&mut state, Action::Open(folder.path().to_owned()));
        let (generation, request) = posted(opened);
        let request = Request::InspectScan(request);
        let outcome = answer(request, &LibraryCache::default(), &NobodysDesk).expect("answered");
        let done = TaskEvent::Done {
            generation,
            outcome,
        };
        let effect = apply_any(&mut state, Action::Hear(TaskQueue::Inspect, done));
        assert!(
            matches!(effect, Some(Effect::ShowDialog(DialogRequest::ScanPoses))),
            "{effect:?}"
        );
        let file = folder.path().join("elsewhere.json");
        assert!(state.inspect.shots.wants(&file) && state.works.is_empty());
        let said = state.notices.last().expect("said");
        assert!(said.what.contains("no poses"), "{said:?}");
        assert!(said.advice.contains("Choose the file"), "{said:?}");

        let chosen = Action::Chosen(DialogRequest::ScanPoses, file.clone());
        let (_, request) = posted(apply_any(&mut state, chosen));
        let ScanOrder::Open(files) = request.order else {
            panic!("{:?}", request.order);
        };
        assert_eq!(files.poses, Some(file.clone()));
        assert_eq!(state.source, Source::Scan(files));
        assert!(!state.inspect.shots.wants(&file));
    }
}
