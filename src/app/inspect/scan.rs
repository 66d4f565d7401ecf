//! The scan that Inspect shows: its shots are put together anew and inspected as one.

use std::sync::Arc;

use crate::app::{
    action::{DialogRequest, Effect, notify},
    inspect::work::InspectJob,
    shots::{
        Asked, FusedShots, ScanOrder, ScanRequest, ShotChoice, ShotsAction, ShotsFile,
        state::source_of,
    },
    state::{ReinspectionPurpose, Source, State},
    user_error::UserError,
};

impl State {
    /// The scan that Inspect shows.
    pub fn fused(&self) -> Option<&Arc<FusedShots>> {
        let scan = self.shown.as_ref()?.inspected.scan.as_ref()?;
        Some(&scan.fused)
    }

    /// Which of its shots shall be used: what was asked for last, while that is on its way.
    pub fn shot_choice(&self) -> Option<&ShotChoice> {
        let is_inspecting = self.inspector.running().is_some();
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
            begin(state, order, asked);
        }
        Err(notice) => notify(state, notice),
    }
    None
}

/// Has shots put together and inspected.
pub(in crate::app) fn begin(state: &mut State, order: ScanOrder, asked: Asked) {
    let title = order.title();
    let request = ScanRequest::of(order, &state.session);
    let job = InspectJob::Scan(request);
    state.inspect(title, job, ReinspectionPurpose::New);
    state.inspect.shots.started(Some(asked));
}

/// Asks for the file of the poses that were not found.
pub(in crate::app) fn ask_for_poses(
    state: &mut State,
    order: ScanOrder,
    trouble: UserError,
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
            shell::inspector,
        },
        files::write_depth_png,
        geometry::depth_frame::{DepthFrame, Intrinsics},
    };

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
        apply_any(&mut state, Action::Open(folder.path().to_owned()));
        assert!(state.inspector.run_waiting());
        let effect = inspector::update(&mut state);
        assert!(
            matches!(effect, Some(Effect::ShowDialog(DialogRequest::ScanPoses))),
            "{effect:?}"
        );
        let file = folder.path().join("elsewhere.json");
        assert!(state.inspect.shots.wants(&file) && state.inspector.running().is_none());
        let said = state.notices.last().expect("said");
        assert!(said.what.contains("no poses"), "{said:?}");
        assert!(said.advice.contains("Choose the file"), "{said:?}");

        let chosen = Action::Chosen(DialogRequest::ScanPoses, file.clone());
        apply_any(&mut state, chosen);
        let Source::Scan(files) = &state.source else {
            panic!("{:?}", state.source);
        };
        assert_eq!(files.poses, Some(file.clone()));
        assert!(!state.inspect.shots.wants(&file) && state.inspector.running().is_some());
    }
}
