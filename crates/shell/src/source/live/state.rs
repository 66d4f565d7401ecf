//! Carries out the actions on the followed source, and takes over what its task says.

use std::{mem, sync::Arc, thread, time::Duration};

use super::work::{LiveAnswer, LiveRecord, LiveStart, SourceState, follow, rest};
use crate::{
    action::{Action, DialogRequest, Event},
    inspection::{camera::no_more_frames, inspected::Inspected},
    notice::{Notice, NoticeTopic},
    session::{ReinspectionPurpose, Session, Shown, Source, UserRole, WorkspaceKind},
    source::live::work::LiveAction,
    state::{State, notify, remove_notices},
    trace::{current_trace::CurrentTrace, expecting},
};
use inspection::pipeline::live::MAX_AVERAGED;
use records::history::Traceability;
use ui::{
    language::{described, library_text, text},
    user_error::UserError,
};

/// Time between two looks at whether the camera is closed.
const POLL_INTERVAL: Duration = Duration::from_millis(5);

/// Carries out an action.
pub fn apply(state: &mut State, action: LiveAction) -> Option<Action> {
    match action {
        LiveAction::Toggle if state.session.is_live() => give_way(state),
        LiveAction::Toggle => start(state),
        LiveAction::Use(spec) => {
            state.session.live.setup = None;
            state.inspector.former_source = None;
            state.session.source = Source::Camera(Box::new(spec));
            return source_changed(state);
        }
        LiveAction::Average(num) => {
            state.session.live.params.average = num.clamp(1, MAX_AVERAGED);
            restart_consensus(state);
        }
        LiveAction::Record(folder) => {
            state.session.live.recording = Some(folder);
            if state.session.is_live() {
                follow_source(state);
            } else {
                start(state);
            }
        }
        LiveAction::ToggleRecording if state.session.live.recording.is_none() => {
            return Some(Action::Ask(DialogRequest::RecordTo));
        }
        LiveAction::ToggleRecording => {
            end_recording(state);
            // No verdict depends on it.
            if state.session.is_live() {
                follow_source(state);
            }
        }
        LiveAction::SetUp(spec) => state.session.live.setup = spec,
    }
    None
}

/// Handles a change of the source: follows it if the former one was followed, else captures one frame. A watched folder is
/// followed at once because it has no frame yet.
pub(crate) fn source_changed(state: &mut State) -> Option<Action> {
    let source = &state.session.source;
    if (state.session.is_live() || source.is_watched()) && source.followed().is_some() {
        start(state);
        return None;
    }
    outdate_shown(state);
    state.capture()
}

/// Starts following the source and cancels a running inspection.
fn start(state: &mut State) {
    if state.session.source.followed().is_none() {
        let what = match state.session.source {
            Source::Scan(_) => text!("live-scan-cannot"),
            _ => text!("live-file-cannot"),
        };
        let advice = match state.session.role {
            UserRole::Operator => text!("inspect-hold-choose-camera-operator"),
            UserRole::Engineer => text!("live-cannot-advice"),
        };
        let notice = Notice::look(what, advice);
        notify(state, notice.about(NoticeTopic::Following));
        return;
    }
    if !expecting::may_inspect(state) {
        return;
    }
    state.follower.session += 1;
    state.follower.again.clear();
    state.session.failed = None;
    remove_notices(state, NoticeTopic::Following);
    remove_notices(state, NoticeTopic::LiveEnded);
    remove_notices(state, NoticeTopic::Scene);
    dismiss_lost_notice(state);
    state.cancel_inspection();
    follow_anew(state);
}

/// Follows the source from now on: nothing that came before is current any more.
fn follow_anew(state: &mut State) {
    outdate_shown(state);
    state.follower.run += 1;
    follow_source(state);
}

/// Follows the source with the current settings, replacing a running task.
fn follow_source(state: &mut State) {
    let Some(spec) = state.session.source.followed() else {
        return;
    };
    let expected = expecting::follow_expected(&mut state.session);
    let request = LiveStart {
        spec,
        recipe: (state.session).recipe_to_show(state.session.rack.in_camera(), expected),
        params: state.session.live.params.clone(),
        empty_cell: state.session.empty_cell.clone(),
        record: state.session.live.recording.clone(),
        trace: state.session.trace.clone(),
        parts: Arc::clone(&state.session.live.parts),
        recorder: state.follower.recorder.clone(),
        run: state.follower.run,
        again: state.follower.again.clone(),
    };
    state.session.live.is_on = true;
    state.session.live.status = None;
    let library_cache = state.follower.library_cache.clone();
    let job = move |context: &_| follow(&request, &library_cache, context);
    state.follower.task.start(text!("shell-live"), job);
}

/// Starts over after a change of something that verdicts depend on, so that no earlier verdict counts. Does nothing if no
/// source is followed.
pub(crate) fn restart_consensus(state: &mut State) {
    if !state.session.is_live() {
        return;
    }
    // A camera shows its part again; a folder does not.
    if state.session.is_watching() && is_newest_current(&state.session) {
        state.follower.again = state.session.latest_parts().to_vec();
    }
    follow_anew(state);
}

/// Starts over because other parts are expected from now on. What a folder has delivered was inspected for those before.
pub(crate) fn expect_anew(state: &mut State) {
    state.follower.again = Vec::new();
    follow_anew(state);
}

/// True if the newest capture has a result, and may still hang there.
fn is_newest_current(session: &Session) -> bool {
    let newest = session.latest(|shown| !shown.is_past && !shown.is_outdated);
    session.failed.is_none() && newest.is_some()
}

/// Stops following, if a source is followed, and closes the camera, because something else comes to the front.
pub(crate) fn give_way(state: &mut State) {
    if state.session.is_live() {
        // The part still hangs there: its serial number goes with the verdict to come.
        stop(state, |trace| trace.take(false));
    }
}

/// Stops following. A part that hangs there without a verdict that counts is recorded with this traceability.
fn stop(state: &mut State, trace: fn(&CurrentTrace) -> Traceability) {
    ended(state);
    let current = state.session.trace.clone();
    let follower = &mut state.follower;
    let library_cache = follower.library_cache.clone();
    let (parts, recorder) = (
        Arc::clone(&state.session.live.parts),
        follower.recorder.clone(),
    );
    follower.task.start(text!("live-closing"), move |_| {
        Ok(rest(&library_cache, &parts, &recorder, || trace(&current)))
    });
}

/// Stops following because the window closes, and waits until the camera is closed. Returns the events of everything that is
/// still to be recorded.
pub fn close(state: &mut State) -> Vec<Event> {
    if state.session.is_live() {
        stop(state, |trace| trace.take(true));
    }
    let mut events = update(state);
    while !state.follower.is_idle() {
        thread::sleep(POLL_INTERVAL);
        events.extend(update(state));
    }
    events
}

/// Ends the recording and reports what was recorded.
fn end_recording(state: &mut State) {
    state.session.live.recording = None;
    let status = state.session.live.status.as_mut();
    if let Some(recorded) = status.and_then(|status| status.recorded.take()) {
        let what = text!(
            "live-recorded",
            num = recorded.num_frames,
            size = megabytes(recorded.num_bytes),
            folder = recorded.folder.display().to_string()
        );
        notify(state, Notice::done(what));
    }
}

/// Formats a number of bytes.
pub(super) fn megabytes(bytes: u64) -> String {
    format!("{:.1} MB", bytes as f64 / 1e6)
}

fn ended(state: &mut State) {
    end_recording(state);
    state.session.live.is_on = false;
    state.session.live.status = None;
    dismiss_lost_notice(state);
}

/// Polls the task; returns the events for all workspaces.
pub fn update(state: &mut State) -> Vec<Event> {
    // A job sends a record before the status that follows from it: read last, the records are complete.
    let task = &mut state.follower.task;
    let answers: Vec<_> = std::iter::from_fn(|| task.poll()).collect();
    let records: Vec<_> = state.follower.records.try_iter().collect();
    let records = records.into_iter();
    let events = records.filter_map(|record| take_record(state, record));
    let events = events.collect();
    for answer in answers {
        match answer {
            Ok(answer) => receive(state, answer),
            Err(error) => {
                notify(state, error.into());
                ended(state);
            }
        }
    }
    events
}

/// Shows a verdict that counts, or that there is none; returns the event by which an inspection is recorded.
fn take_record(state: &mut State, record: LiveRecord) -> Option<Event> {
    match record {
        LiveRecord::Counts {
            counted,
            parts,
            run,
        } => {
            remove_notices(state, NoticeTopic::Scene);
            for warning in &parts[0].warnings {
                notify(state, Notice::of_scene(&parts[0].origin, warning));
            }
            if run == state.follower.run {
                state.follower.again.clear();
                show(state, parts);
            }
            let (parts, purpose) = (counted, ReinspectionPurpose::New);
            Some(Event::Inspected { parts, purpose })
        }
        LiveRecord::Left(entry) => Some(Event::Left(entry)),
        LiveRecord::Skipped {
            name,
            error,
            is_fault,
            run,
        } => {
            // In a watched folder it was the capture of another part, which has no verdict now. The notice stays until it is
            // dismissed: the next capture may come before anybody has looked.
            if run == state.follower.run && state.session.is_watching() {
                state.follower.again.clear();
                state.session.live.unseen.clear();
                state.session.failed = Some(if is_fault {
                    UserError {
                        what: library_text("short-fault"),
                        advice: library_text("step-ask"),
                    }
                } else {
                    UserError {
                        what: text!("operator-unreadable", file = name),
                        advice: text!("operator-unreadable-next"),
                    }
                });
            }
            notify(state, error.into());
            None
        }
    }
}

/// Handles an answer of the task.
fn receive(state: &mut State, answer: LiveAnswer) {
    match answer {
        LiveAnswer::Stands(received) if state.session.is_live() => {
            watch_source(state, &received.status.source);
            // The window may have missed the loss itself.
            let is_lost = matches!(received.status.source, SourceState::Lost(_));
            if is_lost || (received.parts.is_empty() && received.status.num_inspected > 0) {
                outdate_shown(state);
            }
            state.session.live.status = Some(received.status);
            // Every capture of a folder is recorded, and a record may be of a later one that has no verdict.
            if !received.parts.is_empty() && !state.session.is_watching() {
                show(state, received.parts);
            }
        }
        LiveAnswer::NotRecorded(error) => {
            state.session.live.recording = None;
            notify(state, error.into());
        }
        LiveAnswer::AtItsEnd => {
            ended(state);
            let spec = state.session.source.followed();
            let title = spec.map_or_else(String::new, |spec| spec.title());
            notify(state, Notice::done(described(&no_more_frames(&title))));
        }
        LiveAnswer::Stands(_) | LiveAnswer::Rests => {}
    }
}

/// Shows the parts of the latest frame, at once if Inspect is in front: other workspaces keep what they show.
fn show(state: &mut State, parts: Vec<Arc<Inspected>>) {
    let shown = state.session.shown.as_ref();
    let is_shown = shown.is_some_and(|shown| shown.includes(&parts[0]));
    if is_shown || !state.session.is_live() {
        return;
    }
    if state.session.workspace == WorkspaceKind::Inspect {
        show_latest(state, parts);
    } else {
        state.session.failed = None;
        state.session.live.unseen = parts;
    }
}

/// Inspect comes to the front: shows what was inspected meanwhile, unless something newer is shown.
pub(crate) fn show_unseen(state: &mut State) {
    let unseen = mem::take(&mut state.session.live.unseen);
    if !unseen.is_empty() {
        show_latest(state, unseen);
    }
}

fn show_latest(state: &mut State, parts: Vec<Arc<Inspected>>) {
    state.session.live.unseen.clear();
    state.use_library(&parts[0].library);
    state.session.failed = None;
    state.generation += 1;
    // The selected part stays selected.
    let former = state.session.shown.as_ref();
    let is_selected =
        |part: &Arc<Inspected>| former.is_some_and(|former| former.inspected.hung() == part.hung());
    let selected = parts.iter().position(is_selected).unwrap_or_default();
    state.session.shown = Some(Shown {
        session: Some(state.follower.session),
        ..Shown::of_parts(state.generation, parts, selected)
    });
}

/// What was inspected so far is of another source, or from before the source was lost, followed anew or captured from.
pub(crate) fn outdate_shown(state: &mut State) {
    state.session.live.unseen.clear();
    if let Some(shown) = &mut state.session.shown {
        shown.is_outdated = true;
    }
}

/// Shows a notice while the source is lost. The operator's view says it in other words.
fn watch_source(state: &mut State, source: &SourceState) {
    match source {
        SourceState::Lost(problem) => {
            let notice = Notice::from(problem.clone());
            if state.follower.lost.as_ref() != Some(&notice) {
                dismiss_lost_notice(state);
                state.follower.lost = Some(notice);
                tell_if_lost(state);
            }
        }
        SourceState::Opening => {}
        SourceState::Running => {
            if dismiss_lost_notice(state) {
                notify(state, Notice::done(text!("live-source-back")));
            }
        }
    }
}

/// Returns whether the source is lost, and shows the engineer why.
pub(crate) fn tell_if_lost(state: &mut State) -> bool {
    let Some(lost) = state.follower.lost.clone() else {
        return false;
    };
    if state.session.role == UserRole::Engineer {
        notify(state, lost);
    }
    true
}

/// Removes the notice about the lost source; true if there was one.
fn dismiss_lost_notice(state: &mut State) -> bool {
    let Some(lost) = state.follower.lost.take() else {
        return false;
    };
    state.notices.retain(|notice| *notice != lost);
    true
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use jiff::{SignedDuration, Timestamp};

    use super::*;
    use crate::{
        apply::apply as apply_any,
        inspection::{
            camera::Camera, inspected::inspected_cell, library_cache::LibraryCache,
            source::CellChoice,
        },
        roles::RoleAction,
        source::{
            inspect,
            live::{LiveStatus, LiveStatusUpdate},
        },
        trace::entry,
    };
    use capture::{
        CaptureError, CaptureWarning, Captured, DepthSource, Image, NextCapture, SourceSpec,
    };
    use files::FileWarning;
    use geometry::{depth_frame::DepthFrame, rigid::RigidTransform};
    use inspection::pipeline::{Recipe, live::LiveVerdict};
    use records::history::{HungId, StoredVerdict};
    use simulate::{
        PartKind, RackKind, RackSetup, SensorNoise, Side, StandingRack, fixtures::HangingPart,
    };
    use ui::task::TaskRunner;

    /// A camera before which something hangs still, for a few seconds of its clock.
    struct Hanging {
        frame: Box<dyn Fn(SensorNoise) -> DepthFrame + Send>,
        number: u64,
    }

    impl DepthSource for Hanging {
        fn title(&self) -> String {
            "short camera".into()
        }

        fn is_simulated(&self) -> bool {
            true
        }

        fn next(&mut self, _: Duration) -> Result<NextCapture, CaptureError> {
            self.number += 1;
            if self.number > 22 {
                return Ok(NextCapture::End);
            }
            let noise = SensorNoise::kinect(self.number);
            let at = SignedDuration::from_millis(150 * self.number as i64);
            Ok(NextCapture::Captured(Captured {
                number: self.number,
                name: format!("short frame {}", self.number),
                taken_at: Timestamp::UNIX_EPOCH + at,
                arrived: Instant::now(),
                image: Image::Depth((self.frame)(noise)),
                is_simulated: true,
                truth: None,
                robot_from_flange: None,
                warnings: Vec::new(),
            }))
        }
    }

    #[test]
    fn a_verdict_that_the_window_has_not_read_is_recorded_when_live_stops_or_starts_over() {
        for action in [LiveAction::Average(4), LiveAction::Toggle] {
            // Its frames wait for each other, so that none is dropped.
            let mut state = in_front_of("recording,pace=step:short");
            toggle(&mut state);
            assert!(state.follower.task.run_waiting());
            apply_any(&mut state, Action::Live(action.clone()));
            let events = update(&mut state);
            let [Event::Inspected { parts, purpose }] = events.as_slice() else {
                panic!("{action:?}: {} events", events.len());
            };
            assert_eq!(*purpose, ReinspectionPurpose::New);
            let summary = &parts[0].entry.record.summary;
            assert_eq!(summary.verdict, StoredVerdict::Accepted);
            assert!(state.session.shown.is_none(), "{action:?}: only recorded");
        }
    }

    #[test]
    fn live_records_every_part_of_a_rack_once_and_shows_all_of_them() {
        let setup = RackSetup::drawn(RackKind::Apart, 3, 0, 1).expect("in range");
        let mut state = before("recording,pace=step:short", move || {
            let rack = StandingRack::arrange(&setup).expect("in range");
            Box::new(move |noise| rack.frame(|_| Some(RigidTransform::identity()), &noise))
        });
        let mut recipe = Recipe::default();
        recipe.segment.max_parts = 3;
        state.session.recipe = Arc::new(recipe.into());
        state.session.trace.set_serial("4711");
        toggle(&mut state);
        assert!(state.follower.task.run_waiting());
        let events = update(&mut state);
        let parts: Vec<&Arc<Inspected>> = events
            .iter()
            .flat_map(|event| match event {
                Event::Inspected { parts, .. } => parts.as_slice(),
                other => panic!("{other:?}"),
            })
            .collect();
        let summaries = parts.iter().map(|part| &part.entry.record.summary);
        let accepted = summaries.filter(|one| one.verdict == StoredVerdict::Accepted);
        assert_eq!((accepted.count(), parts.len()), (3, 3));
        let serials = parts.iter().map(|part| part.trace().serial.as_str());
        assert_eq!(serials.collect::<Vec<_>>(), ["4711", "", ""]);
        let shown = state.session.shown.as_ref().expect("shown");
        let hung = |part: &Arc<Inspected>| part.hung().clone();
        let shown: Vec<HungId> = shown.parts.iter().map(hung).collect();
        let recorded: Vec<HungId> = parts.into_iter().map(hung).collect();
        assert_eq!(shown, recorded);
        assert!(recorded[0] != recorded[1] && recorded[1] != recorded[2]);
    }

    /// A fender hangs before the camera of this source.
    fn in_front_of(spec: &str) -> State {
        before(spec, || {
            let fender = HangingPart::new(PartKind::Fender, 3);
            Box::new(move |noise| fender.frame(noise, &RigidTransform::identity()))
        })
    }

    /// The camera of this source takes these frames.
    fn before(
        spec: &str,
        frame: impl Fn() -> Box<dyn Fn(SensorNoise) -> DepthFrame + Send> + Send + Sync + 'static,
    ) -> State {
        let camera = Camera::opened_by(move |_| {
            Ok(Box::new(Hanging {
                frame: frame(),
                number: 0,
            }))
        });
        let shipped = ::inspection::fixtures::SHIPPED_PARTS;
        let library_cache = LibraryCache::new(Some(shipped.into()), camera);
        let library_cache = library_cache.with_former(Some(LibraryCache::default().get()));
        let mut state = State::new(&TaskRunner::without_threads(), &library_cache);
        let spec: SourceSpec = spec.parse().expect("a source");
        state.session.source = Source::Camera(Box::new(spec));
        state
    }

    fn watching() -> State {
        in_front_of("watch:captures")
    }

    #[test]
    fn each_capture_of_a_watched_folder_is_a_part_of_its_own() {
        let mut state = watching();
        let parts = [(); 2].map(|()| {
            apply_any(&mut state, Action::Capture);
            assert!(state.inspector.run_waiting());
            inspect::update(&mut state);
            let shown = state.session.shown.as_ref().expect("inspected");
            shown.inspected.hung().clone()
        });
        assert_ne!(parts[0], parts[1]);
    }

    #[test]
    fn a_capture_does_not_end_the_watch_of_a_folder() {
        let mut state = watching();
        toggle(&mut state);
        apply_any(&mut state, Action::Capture);
        assert!(state.session.is_live() && state.inspector.running().is_none());
        assert_eq!(state.notices.len(), 1, "it says that each is inspected");
    }

    #[test]
    fn a_capture_of_a_watched_folder_that_cannot_be_read_leaves_no_result() {
        let mut state = watching();
        toggle(&mut state);
        let record = skipped(&state, false);
        assert!(take_record(&mut state, record).is_none());
        let failed = state.session.failed.take().expect("no result");
        assert!(failed.what.contains("door.png"), "{failed:?}");
        assert!(failed.advice.contains("Save the capture"), "{failed:?}");
        // Saving it again would not help where the program has failed.
        let record = skipped(&state, true);
        take_record(&mut state, record);
        let failed = state.session.failed.take().expect("no result");
        assert!(failed.what.contains("The program failed"), "{failed:?}");
        assert_eq!(failed.advice, "Ask the engineer");
        // The next capture may arrive before anyone has looked.
        assert!(state.follower.task.run_waiting());
        update(&mut state);
        assert!(state.session.shown.is_some());
        let mut notices = state.notices.iter();
        assert!(notices.any(|notice| notice.what == "the file ends early"));
        // The last frame of a camera stands for the part that hangs there.
        state.session.source = Source::Cell(CellChoice::default());
        toggle(&mut state);
        let record = skipped(&state, false);
        take_record(&mut state, record);
        assert!(state.session.failed.is_none() && state.session.is_live());
    }

    #[test]
    fn a_warning_about_a_capture_goes_when_the_next_one_is_inspected() {
        let mut state = watching();
        toggle(&mut state);
        let odd = CaptureWarning::File(FileWarning::SurplusBytes { num: 7 });
        for warnings in [vec![odd], Vec::new()] {
            let num = warnings.len();
            let inspected = Arc::new(Inspected {
                warnings,
                ..inspected_cell(CellChoice::InTurn, 1)
            });
            let record = counts_of(&state, &inspected);
            take_record(&mut state, record);
            let mut notices = state.notices.clone();
            notices.retain(|notice| notice.topic == NoticeTopic::Scene);
            assert_eq!(notices.len(), num, "{notices:?}");
        }
    }

    /// A capture without an inspection.
    fn skipped(state: &State, is_fault: bool) -> LiveRecord {
        LiveRecord::Skipped {
            name: "door.png".into(),
            error: UserError {
                what: "the file ends early".into(),
                advice: "Copy it again".into(),
            },
            is_fault,
            run: state.follower.run,
        }
    }

    /// A capture that was inspected.
    fn counts(state: &State, number: u64) -> (Arc<Inspected>, LiveRecord) {
        let inspected = Arc::new(inspected_cell(CellChoice::InTurn, number));
        let record = counts_of(state, &inspected);
        (inspected, record)
    }

    fn counts_of(state: &State, inspected: &Arc<Inspected>) -> LiveRecord {
        let parts = vec![Arc::clone(inspected)];
        LiveRecord::Counts {
            counted: parts.clone(),
            parts,
            run: state.follower.run,
        }
    }

    /// The records that a job has sent, and then the status with its last inspection, as the window reads them.
    fn read(state: &mut State, records: Vec<LiveRecord>, inspected: &Arc<Inspected>) {
        for record in records {
            state.follower.recorder.send(record).expect("room");
        }
        update(state);
        let received = LiveStatusUpdate {
            status: running(),
            parts: vec![Arc::clone(inspected)],
        };
        receive(state, LiveAnswer::Stands(Box::new(received)));
    }

    #[test]
    fn of_captures_that_the_window_reads_at_once_the_last_one_has_the_say() {
        let mut state = watching();
        toggle(&mut state);
        let (good, record) = counts(&state, 1);
        let records = vec![skipped(&state, false), record];
        read(&mut state, records, &good);
        assert!(state.session.failed.is_none());
        assert!(state.session.current_result().is_some());

        for is_read_at_once in [true, false] {
            let mut state = watching();
            toggle(&mut state);
            apply_any(&mut state, Action::GoTo(WorkspaceKind::History));
            let (good, record) = counts(&state, 1);
            let bad = skipped(&state, false);
            if is_read_at_once {
                read(&mut state, vec![record, bad], &good);
            } else {
                read(&mut state, vec![record], &good);
                assert!(state.session.current_result().is_some());
                read(&mut state, vec![bad], &good);
            }
            assert!(state.session.current_result().is_none());
            apply_any(&mut state, Action::GoTo(WorkspaceKind::Inspect));
            assert!(state.session.failed.is_some() && state.session.shown.is_none());
        }
    }

    #[test]
    fn after_a_save_the_newest_capture_of_a_folder_is_inspected_again_and_live_goes_on() {
        let mut state = watching();
        toggle(&mut state);
        let (enrolled, record) = counts(&state, 1);
        read(&mut state, vec![record], &enrolled);
        apply_any(&mut state, Action::GoTo(WorkspaceKind::Enrol));
        let (newest, record) = counts(&state, 2);
        read(&mut state, vec![record], &newest);
        state.session.trace.set_serial("4711");
        // The second change comes before the first inspection is there.
        for _ in 0..2 {
            let saved = Some(enrolled.again());
            state.library_changed(&enrolled.library, saved);
            assert!(state.session.is_live() && state.notices.is_empty());
            assert!(state.session.current_result().is_none());
        }
        let source = state.session.source.followed().expect("a folder");
        assert!(state.follower.task.run_waiting());
        let events = update(&mut state);
        let mut events = events.iter().filter_map(|event| match event {
            Event::Inspected { parts, .. } => parts.first(),
            _ => None,
        });
        let again = events.next().expect("inspected");
        assert!(Arc::ptr_eq(&again.scene, &newest.scene));
        let summary = &again.entry.record.summary;
        assert_eq!(
            (&summary.hung, &summary.trace),
            (newest.hung(), newest.trace())
        );
        assert_eq!(summary.source, source.to_string());
        // The serial number is of the capture after it.
        let next = events.next().expect("another capture");
        assert_eq!(next.trace().serial, "4711");
        assert!(events.all(|other| !Arc::ptr_eq(&other.scene, &enrolled.scene)));
    }

    #[test]
    fn a_serial_number_scanned_behind_another_workspace_is_of_the_part_inspected_last() {
        let mut state = watching();
        toggle(&mut state);
        let hung = |state: &mut State, number| {
            let (inspected, record) = counts(state, number);
            read(state, vec![record], &inspected);
            inspected.hung().clone()
        };
        let first = hung(&mut state, 1);
        state.session.enter_scanned("4711", 0.0);
        apply_any(&mut state, Action::GoTo(WorkspaceKind::History));
        let second = hung(&mut state, 2);
        let events = entry::settle(&state.session, 1.0);
        let [Event::TracedLate(part, _)] = events.as_slice() else {
            panic!("not written: {events:?}");
        };
        assert_eq!(*part, first);
        state.session.enter_scanned("4712", 2.0);
        assert!(state.session.trace.is_late_of(&second));
        assert_eq!(state.session.trace.get().serial, "");
        assert_eq!(entry::settle(&state.session, 3.0).len(), 1);
        let known = state.session.enter_scanned("4712", 4.0).expect("said");
        assert!(known.what.contains("already"), "{known:?}");
    }

    #[test]
    fn what_live_inspects_behind_another_workspace_is_shown_when_inspect_is_back() {
        let mut state = watching();
        toggle(&mut state);
        apply_any(&mut state, Action::GoTo(WorkspaceKind::History));
        assert!(state.follower.task.run_waiting());
        let events = update(&mut state);
        assert!(!events.is_empty() && state.session.shown.is_none());
        assert!(!state.session.is_live(), "it has ended");
        apply_any(&mut state, Action::GoTo(WorkspaceKind::Inspect));
        assert!(state.session.shown.is_some());
    }

    #[test]
    fn what_live_inspects_behind_another_workspace_is_shown_when_the_window_locks() {
        let mut state = watching();
        toggle(&mut state);
        apply_any(&mut state, Action::GoTo(WorkspaceKind::Compare));
        assert!(state.follower.task.run_waiting());
        update(&mut state);
        assert!(state.session.shown.is_none());
        apply_any(&mut state, Action::Role(RoleAction::Lock));
        assert_eq!(state.session.workspace, WorkspaceKind::Inspect);
        assert!(state.session.shown.is_some());
    }

    #[test]
    fn a_verdict_from_before_a_change_that_verdicts_depend_on_is_not_current() {
        let mut state = watching();
        toggle(&mut state);
        let (good, record) = counts(&state, 1);
        read(&mut state, vec![record], &good);
        assert!(state.session.current_result().is_some());
        // None depends on a recording.
        state.session.live.recording = Some("recorded".into());
        apply_any(&mut state, Action::Live(LiveAction::ToggleRecording));
        state.session.live.status = Some(running());
        assert!(state.session.current_result().is_some());
        apply_any(&mut state, Action::Live(LiveAction::Average(4)));
        state.session.live.status = Some(running());
        assert!(state.session.current_result().is_none() && state.session.is_old());
    }

    #[test]
    fn what_was_inspected_before_another_source_is_chosen_is_not_current_any_more() {
        let other = || -> SourceSpec { "watch:others".parse().expect("a source") };
        for choose in [
            Action::Live(LiveAction::Use(other())),
            Action::UseCell(CellChoice::Empty),
        ] {
            let mut state = watching();
            toggle(&mut state);
            assert!(state.follower.task.run_waiting());
            update(&mut state);
            assert!(state.session.shown.is_some() && !state.session.is_old());
            apply_any(&mut state, choose);
            // Neither while the source has given nothing, nor when the user gives up waiting for it.
            state.session.live.status = Some(running());
            assert!(state.session.current_result().is_none() && state.session.is_old());
            if state.session.is_live() {
                toggle(&mut state);
            }
            apply_any(&mut state, Action::CancelInspection);
            assert!(state.session.current_result().is_none() && state.session.is_old());
        }
        // What was inspected behind another workspace is not current either.
        let mut state = watching();
        toggle(&mut state);
        apply_any(&mut state, Action::GoTo(WorkspaceKind::History));
        assert!(state.follower.task.run_waiting());
        update(&mut state);
        apply_any(&mut state, Action::Live(LiveAction::Use(other())));
        apply_any(&mut state, Action::GoTo(WorkspaceKind::Inspect));
        assert!(state.session.shown.is_none());
    }

    #[test]
    fn what_live_saw_last_does_not_count_once_live_has_ended_until_the_next_capture() {
        let mut state = watching();
        toggle(&mut state);
        assert!(state.follower.task.run_waiting());
        update(&mut state);
        let check = |state: &State| {
            let session = &state.session;
            assert!(!session.is_live() && session.shown.is_some());
            assert!(session.current_result().is_none());
            // Nothing newer is awaited: the engineer may look at it.
            assert!(!session.is_old());
        };
        check(&state);
        // With another library, the same frame has no newer verdict.
        state.inspect_again();
        assert!(state.inspector.run_waiting());
        inspect::update(&mut state);
        check(&state);
        apply_any(&mut state, Action::UseCell(CellChoice::InTurn));
        assert!(state.inspector.run_waiting());
        inspect::update(&mut state);
        assert!(!state.session.is_live() && state.session.current_result().is_some());
    }

    #[test]
    fn a_part_inspected_behind_another_workspace_does_not_count_once_live_has_ended() {
        let mut state = watching();
        toggle(&mut state);
        apply_any(&mut state, Action::GoTo(WorkspaceKind::History));
        assert!(state.follower.task.run_waiting());
        update(&mut state);
        assert!(!state.session.is_live() && !state.session.live.unseen.is_empty());
        assert!(state.session.current_result().is_none());
        apply_any(&mut state, Action::GoTo(WorkspaceKind::Inspect));
        assert!(state.session.shown.is_some() && state.session.current_result().is_none());
    }

    #[test]
    fn a_past_inspection_that_ends_live_says_so_until_it_is_on_again() {
        let mut state = watching();
        toggle(&mut state);
        assert!(state.follower.task.run_waiting());
        update(&mut state);
        let shown = state.session.shown.as_ref().expect("inspected");
        let inspected = Arc::clone(&shown.inspected);
        state.notices.clear();
        toggle(&mut state);
        state.show_past(inspected);
        assert!(!state.session.is_live());
        let notice = state.notices.last().expect("said");
        assert!(notice.what.starts_with("Live stopped"), "{notice:?}");
        assert!(notice.advice.contains("start Live again"), "{notice:?}");
        toggle(&mut state);
        assert!(state.notices.is_empty(), "{:?}", state.notices);
    }

    /// Title of the running or waiting job.
    fn at_work(state: &State) -> Option<&str> {
        let running = state.follower.task.running();
        running.map(|running| running.title.as_str())
    }

    fn toggle(state: &mut State) {
        apply_any(state, Action::Live(LiveAction::Toggle));
    }

    #[test]
    fn the_cell_is_followed_as_it_was_chosen_and_rests_afterwards() {
        let mut state = State::default();
        toggle(&mut state);
        let followed = |state: &State| state.session.source.followed().map(|spec| spec.to_string());
        assert_eq!(followed(&state).as_deref(), Some("simulated"));
        assert_eq!(at_work(&state), Some("Live"));
        let choice = CellChoice::Part(PartKind::Fender, Side::Right);
        apply_any(&mut state, Action::UseCell(choice));
        let other = followed(&state);
        assert_eq!(other.as_deref(), Some("simulated,side=right:fender"));
        assert_eq!(at_work(&state), Some("Live"));
        toggle(&mut state);
        assert_eq!(at_work(&state), Some("Closing the camera"));
        assert!(!state.session.is_live() && state.follower.task.run_waiting());
        update(&mut state);
        assert!(state.follower.is_idle());
    }

    #[test]
    fn a_single_capture_ends_following_and_a_library_does_not() {
        let mut state = State::default();
        toggle(&mut state);
        apply_any(&mut state, Action::UseFoundLibrary);
        assert!(state.session.is_live() && at_work(&state) == Some("Live"));
        apply_any(&mut state, Action::Capture);
        assert!(!state.session.is_live() && at_work(&state) == Some("Closing the camera"));
        let running = state.inspector.running().expect("at work");
        assert_eq!(running.title, "Capturing");
    }

    #[test]
    fn a_watched_folder_is_followed_as_soon_as_it_is_chosen() {
        let mut state = State::default();
        let watched = "watch:captures".parse().expect("a source");
        apply_any(&mut state, Action::Live(LiveAction::Use(watched)));
        assert!(state.session.is_live() && at_work(&state) == Some("Live"));
        let recording = "recording:monday".parse().expect("a source");
        toggle(&mut state);
        apply_any(&mut state, Action::Live(LiveAction::Use(recording)));
        assert!(
            !state.session.is_live() && state.inspector.running().is_some(),
            "its first frame is captured"
        );
    }

    #[test]
    fn changed_parameters_follow_anew_and_nothing_is_followed_for_them_alone() {
        let mut state = State::default();
        restart_consensus(&mut state);
        assert!(state.follower.is_idle());
        toggle(&mut state);
        let before = state.follower.session;
        state.session.live.status = Some(running());
        apply_any(&mut state, Action::Live(LiveAction::Average(99)));
        assert!(
            state.session.live.status.is_none() && at_work(&state) == Some("Live"),
            "anew"
        );
        // The 3-D view keeps its camera.
        assert_eq!(
            (state.follower.session, state.session.live.params.average),
            (before, MAX_AVERAGED)
        );
    }

    #[test]
    fn what_was_inspected_before_the_source_was_lost_is_not_current_when_it_is_back() {
        let mut state = watching();
        toggle(&mut state);
        assert!(state.follower.task.run_waiting());
        update(&mut state);
        toggle(&mut state);
        state.session.shown.as_mut().expect("inspected").is_outdated = false;
        let lost = SourceState::Lost(UserError {
            what: "the folder does not exist".into(),
            advice: "Check it".into(),
        });
        for source in [lost, SourceState::Running] {
            let status = LiveStatus {
                source,
                ..running()
            };
            let parts = Vec::new();
            let received = LiveStatusUpdate { status, parts };
            receive(&mut state, LiveAnswer::Stands(Box::new(received)));
            let shown = state.session.shown.as_ref().expect("kept");
            assert!(shown.is_outdated);
        }
    }

    fn running() -> LiveStatus {
        LiveStatus {
            source: SourceState::Running,
            stillness: None,
            standing: LiveVerdict::Open,
            rates: [None; 2],
            inspection_rate: None,
            latency: None,
            held_up_by: None,
            num_inspected: 1,
            num_dropped: 0,
            num_averaged: 1,
            recorded: None,
        }
    }
}
