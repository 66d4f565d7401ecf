//! What a person asked for about the shots of a scan, and what changes it.

use std::{path::PathBuf, sync::Arc};

use super::{
    choice::{ScanFiles, ShotChoice},
    work::{FusedShots, ScanOrder, ScanRequest},
};
use crate::app::{
    action::{DialogRequest, Effect, notify},
    enrol,
    inspect::work::{InspectRequest, Inspected},
    job::{Request, Trouble},
    lane::TaskQueue,
    source::SceneSource,
    state::{Notice, NoticeKind, Source, State, Workspace},
};

/// What a workspace knows of its scan beside the result.
#[derive(Debug, Default)]
pub struct ShotsState {
    /// What the strip shows.
    pub strip: StripTab,
    /// The shot whose own surface is marked in the view, by its place.
    pub looked_at: Option<usize>,
    /// What was asked for last.
    asked: Option<Asked>,
    /// Choices before the present one, the latest last.
    done: Vec<ShotChoice>,
    /// Choices that were taken back, the latest last.
    undone: Vec<ShotChoice>,
    /// What waits for a person to name the file of the poses.
    wants_poses: Option<ScanOrder>,
}

/// Another choice, until its result is there.
#[derive(Debug)]
struct Asked {
    generation: u64,
    choice: Option<ShotChoice>,
    way: Way,
}

/// Which way to a choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// For the first time.
    First,
    /// Taken back.
    Back,
    /// Done again.
    Again,
}

/// What the strip at the bottom shows while a scan is in front.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StripTab {
    /// The list of shots.
    #[default]
    Shots,
    /// What it shows without a scan: the stages, or the enrolled parts.
    Usual,
}

/// Something that happened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ShotsAction {
    /// Drop the shot at this place, or take it back.
    Toggle(usize),
    /// Mark what the shot at this place alone sees, or no longer.
    LookAt(usize),
    /// Show this in the strip.
    Strip(StripTab),
    /// Take the last change of the shots back.
    Undo,
    /// Do it again.
    Redo,
    /// Open these.
    Open(ScanFiles),
    /// Add this frame.
    Add(PathBuf),
    /// The file of the poses that were not found.
    Poses(PathBuf),
}

/// More steps than this are forgotten, the oldest first.
const MAX_STEPS: usize = 30;
/// With fewer shots nothing can be put together.
const LEAST_SHOTS: usize = 2;

impl State {
    /// The scan in front: Enrol's draft, else what Inspect shows.
    pub fn fused(&self) -> Option<&Arc<FusedShots>> {
        if self.workspace == Workspace::Enrol {
            return self.enrol.draft.as_ref()?.subject.scan();
        }
        let scan = self.shown.as_ref()?.inspected.scan.as_ref()?;
        Some(&scan.fused)
    }

    /// What the workspace in front knows of its scan.
    pub fn shots(&self) -> &ShotsState {
        match self.workspace {
            Workspace::Enrol => &self.enrol.shots,
            _ => &self.inspect.shots,
        }
    }

    /// Which shots shall be used: what was asked for last, while that is on its way.
    pub fn shot_choice(&self) -> Option<&ShotChoice> {
        let fused = self.fused()?;
        let asked = self.shots().asked.as_ref();
        let work = self.works.get(&lane(self.workspace));
        let asked = asked.filter(|asked| work.is_some_and(|w| w.generation == asked.generation));
        let asked = asked.and_then(|asked| asked.choice.as_ref());
        Some(asked.unwrap_or(&fused.choice))
    }

    /// True if a file of poses is waited for.
    pub fn wants_poses(&self) -> bool {
        self.shots().wants_poses.is_some()
    }
}

impl ShotsState {
    /// True if there is something to be taken back.
    pub fn can_undo(&self) -> bool {
        !self.done.is_empty()
    }

    /// True if there is something to be done again.
    pub fn can_redo(&self) -> bool {
        !self.undone.is_empty()
    }
}

fn lane(workspace: Workspace) -> TaskQueue {
    match workspace {
        Workspace::Enrol => TaskQueue::Enrol,
        _ => TaskQueue::Inspect,
    }
}

fn own(state: &mut State) -> &mut ShotsState {
    of_lane(state, lane(state.workspace))
}

fn of_lane(state: &mut State, lane: TaskQueue) -> &mut ShotsState {
    match lane {
        TaskQueue::Enrol => &mut state.enrol.shots,
        _ => &mut state.inspect.shots,
    }
}

/// Carries out an action.
pub(in crate::app) fn apply(state: &mut State, action: ShotsAction) -> Option<Effect> {
    match action {
        ShotsAction::Toggle(place) => {
            let mut choice = state.shot_choice()?.clone();
            if place >= choice.set.shots.len() {
                return None;
            }
            if !choice.dropped.remove(&place) {
                choice.dropped.insert(place);
            }
            if choice.num_taken() < LEAST_SHOTS {
                let too_few = Notice {
                    kind: NoticeKind::Look,
                    what: format!("A scan needs at least {LEAST_SHOTS} shots"),
                    advice: "Take another shot back first".into(),
                };
                notify(state, too_few);
                return None;
            }
            return Some(choose(state, choice, Way::First));
        }
        ShotsAction::LookAt(place) => {
            let own = own(state);
            own.looked_at = if own.looked_at == Some(place) {
                None
            } else {
                Some(place)
            };
        }
        ShotsAction::Strip(tab) => own(state).strip = tab,
        ShotsAction::Undo => {
            let former = own(state).done.last()?.clone();
            return Some(choose(state, former, Way::Back));
        }
        ShotsAction::Redo => {
            let later = own(state).undone.last()?.clone();
            return Some(choose(state, later, Way::Again));
        }
        ShotsAction::Open(files) => {
            state.source = Source::Scan(files);
            return Some(crate::app::action::capture(state));
        }
        ShotsAction::Add(frame) => {
            let choice = state.shot_choice()?.clone();
            let order = ScanOrder::Add(choice, frame, None);
            return Some(begin(state, order, Way::First, None));
        }
        ShotsAction::Poses(file) => {
            let order = own(state).wants_poses.take()?.with_poses(file);
            if let ScanOrder::Open(files) = &order {
                state.source = Source::Scan(files.clone());
            }
            return Some(begin(state, order, Way::First, None));
        }
    }
    None
}

/// Opens the scan that the source names.
pub(in crate::app) fn open(state: &mut State, files: ScanFiles) -> Effect {
    begin(state, ScanOrder::Open(files), Way::First, None)
}

fn choose(state: &mut State, choice: ShotChoice, way: Way) -> Effect {
    begin(state, ScanOrder::Known(choice.clone()), way, Some(choice))
}

/// Has shots put together for the workspace in front.
fn begin(state: &mut State, order: ScanOrder, way: Way, choice: Option<ShotChoice>) -> Effect {
    let what = match &order {
        ScanOrder::Open(files) => format!("Opening {}", files.title()),
        ScanOrder::Known(_) => "Putting the shots together".to_owned(),
        ScanOrder::Add(_, frame, _) => {
            format!("Adding {}", crate::app::source::file_name(frame))
        }
    };
    let request = request(state, order);
    let effect = if state.workspace == Workspace::Enrol {
        enrol::take_scan(state, request, what)
    } else {
        state.begin(what, Request::InspectScan(request))
    };
    let generation = state.generation;
    let own = own(state);
    own.wants_poses = None;
    own.asked = Some(Asked {
        generation,
        choice,
        way,
    });
    effect
}

fn request(state: &State, order: ScanOrder) -> ScanRequest {
    ScanRequest {
        order,
        calibration: state.calibration_path(),
        recipe: state.recipe.clone(),
    }
}

/// The request that inspects what is shown once more: all shots of a scan, else the scene.
pub(in crate::app) fn inspection_again(state: &State, inspected: &Inspected) -> Request {
    match &inspected.scan {
        Some(scan) => {
            let order = ScanOrder::Known(scan.fused.choice.clone());
            Request::InspectScan(request(state, order))
        }
        None => Request::Inspect(InspectRequest {
            source: SceneSource::AtHand(inspected.scene.clone(), inspected.origin.clone()),
            recipe: state.recipe.clone(),
        }),
    }
}

/// The request that inspects these shots.
pub(in crate::app) fn inspection_of(state: &State, fused: &FusedShots) -> Request {
    Request::InspectScan(request(state, ScanOrder::Known(fused.choice.clone())))
}

/// Takes the shots that Inspect shows as Enrol's draft.
pub(in crate::app) fn enrol_shown(state: &mut State) -> Option<Effect> {
    let scan = state.shown.as_ref()?.inspected.scan.as_ref()?;
    let order = ScanOrder::Known(scan.fused.choice.clone());
    let request = request(state, order);
    Some(enrol::take_scan(
        state,
        request,
        "Taking the scan in front".into(),
    ))
}

/// Asks for the file of the poses that were not found.
pub(in crate::app) fn ask_for_poses(
    state: &mut State,
    lane: TaskQueue,
    order: ScanOrder,
    trouble: Trouble,
) -> Effect {
    notify(state, trouble.into());
    of_lane(state, lane).wants_poses = Some(order);
    Effect::ShowDialog(DialogRequest::ScanPoses)
}

/// A result has come, in the place of one with the choice `former`: what was asked for can be taken back.
pub(in crate::app) fn settle(
    state: &mut State,
    lane: TaskQueue,
    generation: u64,
    former: Option<ShotChoice>,
) {
    let files = match lane {
        TaskQueue::Enrol => state.enrol.draft.as_ref().and_then(|draft| {
            let fused = draft.subject.scan()?;
            Some(fused.choice.files())
        }),
        _ => state.shown.as_ref().and_then(|shown| {
            let scan = shown.inspected.scan.as_ref()?;
            Some(scan.fused.choice.files())
        }),
    };
    // The next start opens the same shots.
    if let (Some(files), Source::Scan(source)) = (&files, &mut state.source)
        && source.frames == files.frames
    {
        source.clone_from(files);
    }
    let own = of_lane(state, lane);
    let asked = own.asked.take_if(|asked| asked.generation == generation);
    own.looked_at = None;
    own.wants_poses = None;
    let of_same = former.filter(|former| {
        files
            .as_ref()
            .is_some_and(|files| files.frames == former.set.files.frames)
    });
    match (asked, of_same) {
        (Some(asked), Some(former)) => match asked.way {
            Way::First => {
                own.undone.clear();
                own.done.push(former);
                if own.done.len() > MAX_STEPS {
                    own.done.remove(0);
                }
            }
            Way::Back => {
                own.done.pop();
                own.undone.push(former);
            }
            Way::Again => {
                own.undone.pop();
                own.done.push(former);
            }
        },
        // The same again, by another recipe or library.
        (None, Some(_)) => {}
        _ => {
            own.done.clear();
            own.undone.clear();
        }
    }
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
        assert!(state.wants_poses() && state.works.is_empty());
        let said = state.notices.last().expect("said");
        assert!(said.what.contains("no poses"), "{said:?}");
        assert!(said.advice.contains("Choose the file"), "{said:?}");

        let file = folder.path().join("elsewhere.json");
        let chosen = Action::Chosen(DialogRequest::ScanPoses, file.clone());
        let (_, request) = posted(apply_any(&mut state, chosen));
        let ScanOrder::Open(files) = request.order else {
            panic!("{:?}", request.order);
        };
        assert_eq!(files.poses, Some(file));
        assert_eq!(state.source, Source::Scan(files));
        assert!(!state.wants_poses());
    }
}
