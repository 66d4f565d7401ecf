use std::sync::Mutex;

use nalgebra::Point3;

use super::*;
use crate::{
    app::{
        action::{self, Action},
        camera::Camera,
        enrol::{selection::PixelBox, subject::PointAction},
        job::{TaskOutcome, answer},
        shelf::LibraryCache,
        source::Origin,
        state::{Session, Workspace},
        worker::{JobContext, TaskEvent},
    },
    geometry::cloud::PointCloud,
    pipeline::ProgressObserver,
    stages::scene::SceneCloud,
};

/// Keeps what is handed over on the way.
#[derive(Default)]
struct Tray(Mutex<Vec<TaskOutcome>>);

impl ProgressObserver for Tray {}

impl JobContext<TaskOutcome> for Tray {
    fn stands(&self, outcome: TaskOutcome) {
        self.publish_partial(outcome);
    }

    fn wants_more(&self) -> bool {
        true
    }

    fn progress(&self, _done: usize, _total: usize) {}
    fn publish_partial(&self, outcome: TaskOutcome) {
        self.0.lock().expect("whole").push(outcome);
    }
}

/// A window without its threads: what is posted is done at once.
struct Bench {
    state: State,
    shelf: LibraryCache,
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let session = Session {
            workspace: Workspace::Enrol,
            ..Session::default()
        };
        let state = State {
            session,
            ..State::default()
        };
        Self {
            state,
            shelf: LibraryCache::new(Some(folder.path().to_owned()), Camera::default()),
            folder,
        }
    }

    fn act(&mut self, action: EnrolAction) {
        let effect = apply(&mut self.state, action);
        self.make(effect);
    }

    fn make(&mut self, effect: Option<Effect>) {
        match effect {
            // Nobody writes a history here.
            None | Some(Effect::Tell(_)) => {}
            Some(Effect::Several(effects)) => {
                for effect in effects {
                    self.make(Some(effect));
                }
            }
            Some(Effect::Post {
                generation,
                request,
            }) => {
                let (lane, tray) = (request.lane(), Tray::default());
                let outcome = answer(request, &self.shelf, &tray).expect("not cancelled");
                for outcome in tray.0.into_inner().expect("whole") {
                    self.hear(
                        lane,
                        TaskEvent::Partly {
                            generation,
                            outcome,
                        },
                    );
                }
                self.hear(
                    lane,
                    TaskEvent::Done {
                        generation,
                        outcome,
                    },
                );
            }
            Some(other) => panic!("{other:?}"),
        }
    }

    fn hear(&mut self, lane: TaskQueue, news: TaskEvent<TaskOutcome>) {
        let effect = action::apply(&mut self.state, Action::Hear(lane, news));
        self.make(effect);
    }

    /// Takes an L-shaped plate of this width as the draft.
    fn take(&mut self, width: usize) {
        let points = (0..width * 80).filter_map(|i| {
            let (x, y) = ((i % width) as f32 * 0.005, (i / width) as f32 * 0.005);
            (x < 0.15 || y < 0.2).then(|| Point3::new(x, y, 1.2))
        });
        let scene = SceneCloud {
            cloud: PointCloud::from_points(points),
            ..SceneCloud::default()
        };
        let origin = Origin::File {
            path: format!("{width}.pcd").into(),
            is_simulated: false,
        };
        let source = SceneSource::AtHand(Arc::new(scene), origin);
        let effect = take(&mut self.state, source, "Taking".into());
        self.make(Some(effect));
        self.act(EnrolAction::TakeAs(InitialSelection::Whole));
    }

    fn named(&mut self, title: &str) {
        self.act(EnrolAction::Write(Field::Title(title.into())));
    }

    fn num_kept(&self) -> usize {
        let draft = self.state.enrol.draft.as_ref().expect("a draft");
        draft.selection.indices.len()
    }

    fn from(&self) -> Option<String> {
        let draft = self.state.enrol.draft.as_ref()?;
        Some(draft.subject.origin.title())
    }

    fn names(&self) -> Vec<String> {
        let library = self.state.library.as_ref().expect("loaded");
        library
            .parts
            .iter()
            .map(|part| part.name.to_string())
            .collect()
    }
}

const CORNER: PixelBox = PixelBox {
    from: [0, 0],
    to: [100, 100],
};

#[test]
fn every_correction_is_taken_back_and_done_again_in_its_order() {
    let mut bench = Bench::new();
    bench.take(80);
    let mut kept = vec![bench.num_kept()];
    for edit in [
        Edit::Box(BoxMode::Keep, CORNER),
        Edit::Segment(0, PointAction::Kept),
        Edit::Box(BoxMode::Drop, CORNER),
    ] {
        bench.act(EnrolAction::Correct(edit));
        kept.push(bench.num_kept());
    }
    assert!(kept[1] < kept[0] && kept[2] == kept[0] && kept[3] == kept[0] - kept[1]);
    for num in kept.iter().rev().skip(1) {
        bench.act(EnrolAction::Undo);
        assert_eq!(bench.num_kept(), *num);
    }
    for num in &kept[1..] {
        bench.act(EnrolAction::Redo);
        assert_eq!(bench.num_kept(), *num);
    }
    bench.act(EnrolAction::Undo);
    bench.act(EnrolAction::Correct(Edit::Segment(0, PointAction::Dropped)));
    bench.act(EnrolAction::Redo);
    assert_eq!(bench.num_kept(), 0, "what was done since counts");
    let draft = bench.state.enrol.draft.as_ref().expect("a draft");
    assert!(matches!(&draft.checked, Some(Err(trouble)) if !trouble.advice.is_empty()));
}

#[test]
fn another_draft_keeps_the_words_and_can_be_taken_back() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.named("Plate");
    bench.take(90);
    assert_eq!(bench.from().as_deref(), Some("90.pcd"));
    let draft = bench.state.enrol.draft.as_ref().expect("a draft");
    assert_eq!(draft.form.name, "plate");
    // Taken whole, then the draft itself.
    bench.act(EnrolAction::Undo);
    bench.act(EnrolAction::Undo);
    assert_eq!(bench.from().as_deref(), Some("80.pcd"));
    bench.act(EnrolAction::Discard);
    assert_eq!(bench.from(), None);
    bench.act(EnrolAction::Undo);
    assert_eq!(bench.from().as_deref(), Some("80.pcd"));
}

#[test]
fn a_saved_part_replaced_and_taken_back_twice_is_the_first_one_again() {
    let mut bench = Bench::new();
    for width in [80, 90] {
        bench.take(width);
        bench.named("Plate");
        bench.act(EnrolAction::Save);
        assert_eq!(bench.from(), None);
    }
    let enrolled_from = |bench: &Bench| {
        let library = bench.state.library.as_ref().expect("loaded");
        library.parts.first().map(|part| part.enrolled.from.clone())
    };
    assert_eq!(enrolled_from(&bench).as_deref(), Some("90.pcd"));
    assert_eq!(
        bench.state.notices.last().map(|n| n.kind),
        Some(NoticeKind::Undoable)
    );
    bench.act(EnrolAction::Undo);
    assert_eq!(enrolled_from(&bench).as_deref(), Some("80.pcd"));
    assert_eq!(bench.from().as_deref(), Some("90.pcd"), "the draft is back");
    bench.act(EnrolAction::Redo);
    assert_eq!(enrolled_from(&bench).as_deref(), Some("90.pcd"));
    bench.act(EnrolAction::Undo);
    // The draft's own steps, then the first saving.
    while enrolled_from(&bench).is_some() {
        bench.act(EnrolAction::Undo);
    }
    assert_eq!(bench.from().as_deref(), Some("80.pcd"));
}

#[test]
fn an_offer_to_undo_goes_when_something_else_was_done() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.named("Plate");
    bench.act(EnrolAction::Save);
    bench.take(90);
    let kinds = bench.state.notices.iter().map(|notice| notice.kind);
    assert!(kinds.into_iter().all(|kind| kind != NoticeKind::Undoable));
}

#[test]
fn a_change_that_fails_can_be_tried_again() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.named("Plate");
    bench.act(EnrolAction::Save);
    bench.act(EnrolAction::Remove(PartName::new("plate").expect("a name")));
    let trash = bench.folder.path().join(".trash");
    let hidden = bench.folder.path().join(".hidden");
    std::fs::rename(&trash, &hidden).expect("moved");
    bench.act(EnrolAction::Undo);
    let last = bench.state.notices.last().expect("a notice");
    assert!(
        last.kind == NoticeKind::Look && !last.advice.is_empty(),
        "{last:?}"
    );
    assert!(bench.names().is_empty());
    std::fs::rename(&hidden, &trash).expect("moved back");
    bench.act(EnrolAction::Undo);
    assert_eq!(bench.names(), ["plate"]);
}

#[test]
fn one_change_of_the_library_at_a_time() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.named("Plate");
    let first = apply(&mut bench.state, EnrolAction::Save);
    assert!(apply(&mut bench.state, EnrolAction::Save).is_none());
    assert!(apply(&mut bench.state, EnrolAction::Undo).is_none());
    bench.make(first);
    assert_eq!(bench.names(), ["plate"]);
}

#[test]
fn a_part_is_renamed_while_it_is_looked_at() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.named("Plate");
    bench.act(EnrolAction::Save);
    bench.act(EnrolAction::Open(PartName::new("plate").expect("a name")));
    bench.act(EnrolAction::WriteOpen(Field::Name("Sheet".into())));
    bench.act(EnrolAction::Rename);
    assert_eq!(bench.names(), ["plate"], "capitals are refused");
    bench.act(EnrolAction::WriteOpen(Field::Name("sheet".into())));
    bench.act(EnrolAction::Rename);
    assert_eq!(bench.names(), ["sheet"]);
    let open = bench.state.enrol.open.as_ref().expect("still open");
    assert_eq!(open.name.as_str(), "sheet");
}

#[test]
fn without_a_name_nothing_is_saved_and_it_is_said() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.act(EnrolAction::Save);
    assert!(!bench.state.is_changing_library());
    assert!(bench.state.notices[0].what.contains("name is empty"));
}

#[test]
fn captures_are_enrolled_while_the_workspace_is_in_front_and_inspected_otherwise() {
    let mut state = State::default();
    for (workspace, lane) in [
        (Workspace::Inspect, TaskQueue::Inspect),
        (Workspace::Enrol, TaskQueue::Enrol),
    ] {
        state.workspace = workspace;
        for action in [Action::Capture, Action::Open("door.pcd".into())] {
            let Some(Effect::Post { request, .. }) = action::apply(&mut state, action) else {
                panic!("nothing was posted");
            };
            assert_eq!(request.lane(), lane);
        }
    }
}

#[test]
fn what_is_checked_names_the_part_that_is_hardest_to_tell_from() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.named("Plate");
    bench.act(EnrolAction::Save);
    bench.take(80);
    bench.named("Twin");
    let draft = bench.state.enrol.draft.as_ref().expect("a draft");
    let hardest = draft.hardest().expect("one is enrolled");
    assert!(
        hardest.other == "plate" && !hardest.is_distinguishable(),
        "{hardest}"
    );
    bench.act(EnrolAction::Replace(
        PartName::new("plate").expect("a name"),
    ));
    let draft = bench.state.enrol.draft.as_ref().expect("a draft");
    assert!(draft.hardest().is_none(), "it replaces the only one");
}

#[test]
fn an_answer_that_comes_when_nothing_is_there_any_more_changes_nothing() {
    let mut bench = Bench::new();
    let answer = EnrolAnswer::Checked(Err(Trouble {
        what: "late".into(),
        advice: String::new(),
    }));
    assert!(hear(&mut bench.state, 1, Ok(answer)).is_none());
    assert!(bench.state.enrol.draft.is_none());
}
