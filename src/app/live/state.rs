//! What the window knows of the source that it follows, and what can happen to that.

use std::{path::PathBuf, sync::Arc};

use super::{
    status::frames_word,
    work::{LiveAnswer, LiveRequest, LiveStart, LiveStatus, SourceState},
};
use crate::{
    app::{
        action::{self, DialogRequest, Effect, notify},
        answers,
        job::{Request, Trouble},
        lane::TaskQueue,
        state::{Event, Notice, NoticeKind, ReinspectionPurpose, Shown, Source, State, Workspace},
    },
    capture::{SourceSpec, WatchedSpec},
    pipeline::live::{LiveParams, MAX_AVERAGED},
};

/// What is known of the source that is followed.
#[derive(Debug, Default)]
pub struct LiveState {
    /// Whether a source is followed.
    pub switch: LiveSwitch,
    /// How things stand, once something was told.
    pub status: Option<LiveStatus>,
    /// When a verdict counts, and over how many frames depth is averaged.
    pub params: LiveParams,
    /// The folder that the source is recorded in, while it is.
    pub recording: Option<PathBuf>,
    /// The simulated cell as it is being set up, while its window is open.
    pub setup: Option<crate::capture::SimulatedSpec>,
    /// Counts how often following began with another view: within one the 3-D view keeps its camera.
    session: u64,
    /// The notice that stands while the source is lost.
    lost: Option<Notice>,
}

/// Whether a source is followed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LiveSwitch {
    /// Frames are taken one by one, when a person asks.
    #[default]
    Off,
    /// Frames are taken as they come.
    On,
}

/// Something that can happen.
#[derive(Clone, Debug)]
pub enum LiveAction {
    /// Follow the source, or no longer.
    Toggle,
    /// Take frames from this source from now on.
    Use(SourceSpec),
    /// Average depth over so many frames.
    Average(usize),
    /// Record the source into a folder in this one.
    Record(PathBuf),
    /// Choose where to record it, or record it no longer.
    ToggleRecording,
    /// Record it no longer.
    StopRecording,
    /// Open the window that sets up the simulated cell, or close it.
    SetUp(Option<crate::capture::SimulatedSpec>),
}

impl LiveState {
    /// Before anything is followed; depth will be averaged over so many frames.
    pub fn averaging(num_frames: usize) -> Self {
        let mut own = Self::default();
        own.params.average = num_frames.clamp(1, MAX_AVERAGED);
        own
    }
}

impl State {
    /// True while a source is followed.
    pub fn is_live(&self) -> bool {
        self.live.switch == LiveSwitch::On
    }
}

impl Source {
    /// What can be followed of it; nothing of a single file or a scan.
    pub fn followed(&self) -> Option<SourceSpec> {
        match self {
            Self::Cell(choice) => Some(SourceSpec::Simulated(choice.followed())),
            Self::File(_) | Self::Scan(_) => None,
            Self::Camera(spec) => Some((**spec).clone()),
        }
    }
}

/// Carries out an action.
pub(in crate::app) fn apply(state: &mut State, action: LiveAction) -> Option<Effect> {
    match action {
        LiveAction::Toggle if state.is_live() => Some(stop(state)),
        LiveAction::Toggle => start(state),
        LiveAction::Use(spec) => {
            state.live.setup = None;
            state.source = Source::Camera(Box::new(spec));
            source_changed(state)
        }
        LiveAction::Average(num) => {
            state.live.params.average = num.clamp(1, MAX_AVERAGED);
            restart_consensus(state)
        }
        LiveAction::Record(folder) => {
            state.live.recording = Some(folder);
            if state.is_live() {
                restart_consensus(state)
            } else {
                start(state)
            }
        }
        LiveAction::ToggleRecording if state.live.recording.is_none() => {
            Some(Effect::ShowDialog(DialogRequest::RecordTo))
        }
        LiveAction::StopRecording | LiveAction::ToggleRecording => {
            end_recording(state);
            restart_consensus(state)
        }
        LiveAction::SetUp(spec) => {
            state.live.setup = spec;
            None
        }
    }
}

/// Another source: it is followed if the one before was, else one frame is captured. A watched folder has none yet.
pub(in crate::app) fn source_changed(state: &mut State) -> Option<Effect> {
    let waits = matches!(&state.source, Source::Camera(spec) if matches!(**spec, SourceSpec::Watched(WatchedSpec { .. })));
    if (state.is_live() || waits) && state.source.followed().is_some() {
        return start(state);
    }
    Some(action::capture(state))
}

/// Follows the source; whatever was being inspected is given up.
fn start(state: &mut State) -> Option<Effect> {
    if state.source.followed().is_none() {
        let what = match state.source {
            Source::Scan(_) => "A scan cannot be followed: nothing in it changes",
            _ => "A single file cannot be followed: nothing in it changes",
        };
        let notice = Notice {
            kind: NoticeKind::Look,
            what: what.into(),
            advice: "Choose a camera, a recording or a folder in the source menu".into(),
        };
        notify(state, notice);
        return None;
    }
    state.live.session += 1;
    dismiss_lost_notice(state);
    state.works.remove(&TaskQueue::Inspect);
    let follow = follow(state)?;
    Some(Effect::Several(vec![
        Effect::CancelWork(TaskQueue::Inspect),
        follow,
    ]))
}

/// Has the lane's thread follow the source with what holds now.
fn follow(state: &mut State) -> Option<Effect> {
    let request = LiveStart {
        spec: state.source.followed()?,
        recipe: Arc::clone(&state.recipe),
        params: state.live.params.clone(),
        empty_cell: state.empty_cell.clone(),
        record: state.live.recording.clone(),
    };
    state.live.switch = LiveSwitch::On;
    state.live.status = None;
    let request = LiveRequest::Follow(Box::new(request));
    Some(state.begin("Live", Request::Live(request)))
}

/// Something that verdicts rest on has changed: none of those before counts. Does nothing while nothing is followed.
pub(in crate::app) fn restart_consensus(state: &mut State) -> Option<Effect> {
    if state.is_live() { follow(state) } else { None }
}

/// Ends following, and lets the camera rest.
fn stop(state: &mut State) -> Effect {
    ended(state);
    state.begin("Closing the camera", Request::Live(LiveRequest::Rest))
}

/// Says what was recorded.
fn end_recording(state: &mut State) {
    state.live.recording = None;
    let status = state.live.status.as_mut();
    if let Some(recorded) = status.and_then(|status| status.recorded.take()) {
        let what = format!(
            "Recorded {} {}, {}, to {}",
            recorded.num_frames,
            frames_word(recorded.num_frames),
            megabytes(recorded.num_bytes),
            recorded.folder.display()
        );
        notify(state, Notice::done(what));
    }
}

/// Bytes, for a person.
pub(super) fn megabytes(bytes: u64) -> String {
    format!("{:.1} MB", bytes as f64 / 1e6)
}

fn ended(state: &mut State) {
    end_recording(state);
    state.live.switch = LiveSwitch::Off;
    state.live.status = None;
    dismiss_lost_notice(state);
}

/// Ends following, if anything is followed: something else comes to the front.
pub(in crate::app) fn stop_live(state: &mut State) -> Option<Effect> {
    state.is_live().then(|| stop(state))
}

/// Takes in what the thread tells.
pub(in crate::app) fn hear(
    state: &mut State,
    answer: Result<LiveAnswer, Trouble>,
) -> Option<Effect> {
    match answer {
        Ok(LiveAnswer::Stands(told)) if state.is_live() => {
            watch_source(state, &told.status.source);
            state.live.status = Some(told.status);
            if let Some(inspected) = told.inspected {
                show(state, inspected);
            }
        }
        Ok(LiveAnswer::Counts(inspected)) => {
            for warning in &inspected.warnings {
                notify(state, Trouble::of(warning).into());
            }
            show(state, Arc::clone(&inspected));
            let purpose = ReinspectionPurpose::New;
            return Some(Effect::Tell(Event::Inspected { inspected, purpose }));
        }
        Ok(LiveAnswer::NotRecorded(trouble)) => {
            state.live.recording = None;
            notify(state, trouble.into());
        }
        Ok(LiveAnswer::Skipped(trouble)) => notify(state, trouble.into()),
        Ok(LiveAnswer::AtItsEnd) => {
            ended(state);
            let title = state
                .source
                .followed()
                .map_or_else(String::new, |s| s.title());
            notify(state, Notice::done(format!("{title} has no more frames")));
        }
        // It was said as a notice already.
        Err(_) => ended(state),
        Ok(LiveAnswer::Stands(_) | LiveAnswer::Rests) => {}
    }
    None
}

/// What was told last, where it is looked at; other workspaces keep what they have in hand.
fn show(state: &mut State, inspected: Arc<crate::app::inspect::work::Inspected>) {
    let is_shown = state
        .shown
        .as_ref()
        .is_some_and(|shown| Arc::ptr_eq(&shown.inspected, &inspected));
    if is_shown || state.workspace != Workspace::Inspect || !state.is_live() {
        return;
    }
    answers::use_library(state, &inspected.library);
    state.generation += 1;
    let (generation, session) = (state.generation, Some(state.live.session));
    let num_candidates = inspected.figures.candidates.len();
    state.candidate = state.candidate.min(num_candidates.saturating_sub(1));
    state.shown = Some(Shown {
        generation,
        inspected,
        is_past: false,
        session,
    });
}

/// Says that the source is lost as long as it is.
fn watch_source(state: &mut State, source: &SourceState) {
    match source {
        SourceState::Lost(trouble) => {
            let notice = Notice::from(trouble.clone());
            if state.live.lost.as_ref() != Some(&notice) {
                dismiss_lost_notice(state);
                notify(state, notice.clone());
                state.live.lost = Some(notice);
            }
        }
        SourceState::Opening => {}
        SourceState::Running => {
            if dismiss_lost_notice(state) {
                notify(state, Notice::done("The source is there again"));
            }
        }
    }
}

/// Takes the notice away; true if there was one.
fn dismiss_lost_notice(state: &mut State) -> bool {
    let Some(lost) = state.live.lost.take() else {
        return false;
    };
    state.notices.retain(|notice| *notice != lost);
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        app::{action::Action, source::CellChoice},
        simulate::{PartKind, Side},
    };

    fn posted(effect: Option<Effect>) -> Vec<Request> {
        match effect {
            Some(Effect::Post { request, .. }) => vec![request],
            Some(Effect::Several(effects)) => {
                effects.into_iter().flat_map(|e| posted(Some(e))).collect()
            }
            _ => Vec::new(),
        }
    }

    fn followed(requests: &[Request]) -> Option<String> {
        requests.iter().find_map(|request| match request {
            Request::Live(LiveRequest::Follow(request)) => Some(request.spec.to_string()),
            _ => None,
        })
    }

    fn rests(requests: &[Request]) -> bool {
        let rests = |request: &Request| matches!(request, Request::Live(LiveRequest::Rest));
        requests.iter().any(rests)
    }

    fn toggled(state: &mut State) -> Vec<Request> {
        posted(action::apply(state, Action::Live(LiveAction::Toggle)))
    }

    #[test]
    fn the_cell_is_followed_as_it_was_chosen_and_rests_afterwards() {
        let mut state = State::default();
        assert_eq!(followed(&toggled(&mut state)).as_deref(), Some("simulated"));
        let choice = CellChoice::Part(PartKind::Fender, Side::Right);
        let other = posted(action::apply(&mut state, Action::UseCell(choice)));
        assert_eq!(
            followed(&other).as_deref(),
            Some("simulated,side=right:fender")
        );
        assert!(rests(&toggled(&mut state)) && !state.is_live());
    }

    #[test]
    fn a_single_capture_ends_following_and_a_library_does_not() {
        let mut state = State::default();
        toggled(&mut state);
        let library = posted(action::apply(&mut state, Action::UseFoundLibrary));
        assert!(state.is_live() && !rests(&library));
        let captured = posted(action::apply(&mut state, Action::Capture));
        assert!(!state.is_live() && rests(&captured));
        assert!(captured.iter().any(|r| matches!(r, Request::Inspect(_))));
        // The capture is the newest request of its lane, whatever was posted along with it.
        assert!(state.works.contains_key(&TaskQueue::Inspect));
    }

    #[test]
    fn a_watched_folder_is_followed_as_soon_as_it_is_chosen() {
        let mut state = State::default();
        let watched = "watch:captures".parse().expect("a source");
        let requests = posted(action::apply(
            &mut state,
            Action::Live(LiveAction::Use(watched)),
        ));
        assert_eq!(followed(&requests).as_deref(), Some("watch:captures"));
        let recording = "recording:monday".parse().expect("a source");
        toggled(&mut state);
        let requests = posted(action::apply(
            &mut state,
            Action::Live(LiveAction::Use(recording)),
        ));
        assert_eq!(followed(&requests), None, "its first frame is captured");
    }

    #[test]
    fn changed_parameters_follow_anew_and_nothing_is_followed_for_them_alone() {
        let mut state = State::default();
        assert!(restart_consensus(&mut state).is_none());
        toggled(&mut state);
        let before = state.live.session;
        let requests = posted(action::apply(
            &mut state,
            Action::Live(LiveAction::Average(99)),
        ));
        assert!(followed(&requests).is_some());
        // The view keeps its camera.
        assert_eq!(
            (state.live.session, state.live.params.average),
            (before, MAX_AVERAGED)
        );
    }
}
