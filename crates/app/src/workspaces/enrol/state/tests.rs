use glam::Vec2;
use nalgebra::Point3;

use super::{
    super::{
        draft::Field,
        meshes::{MeshAction, MeshOrder},
        outline::{DrawnOutline, DrawnOver},
        segments::PointAction,
        selection::Edit,
        subject::InitialSelection,
    },
    *,
};
use files::fixtures::obj_of;
use geometry::cloud::PointCloud;
use inspection::library::{LibraryFolder, PartNaming};
use shell::{
    inspection::{
        camera::Camera,
        inspected::inspected_cell,
        library_cache::LibraryCache,
        source::{CellChoice, Origin, SceneOrScan, SceneSource},
    },
    notice::NoticeKind,
    session::{Shown, WorkspaceKind},
    workspace::TestShell,
};
use simulate::{PartKind, PartModel, Side};
use stages::scene::SceneCloud;
use ui::viewport::ViewCamera;

/// The workspace without a window or threads.
struct Bench {
    enrol: EnrolState,
    shell: TestShell,
    notices: Vec<Notice>,
    /// What the last change of the library asks to inspect.
    saved: Option<SceneOrScan>,
    folder: tempfile::TempDir,
    /// Files to open.
    files: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let mut shell = TestShell::default();
        let library = Some(folder.path().to_owned());
        shell.services.library_cache = LibraryCache::new(library, Camera::default());
        Self {
            enrol: EnrolState::new(&TaskRunner::without_threads()),
            shell,
            notices: Vec::new(),
            saved: None,
            folder,
            files: tempfile::tempdir().expect("a folder"),
        }
    }

    /// Carries out an action and all work that follows from it.
    fn act(&mut self, action: EnrolAction) {
        self.begin(action);
        self.work();
    }

    /// Carries out an action; the work that follows from it waits.
    fn begin(&mut self, action: EnrolAction) {
        self.enrol.apply(action, &mut self.shell.context());
        self.deliver();
    }

    fn work(&mut self) {
        while self.enrol.change_task.run_waiting() || self.enrol.draft_task.run_waiting() {
            self.enrol.update(&mut self.shell.context());
            self.deliver();
        }
    }

    /// Carries out the actions sent, as the window would.
    fn deliver(&mut self) {
        for action in std::mem::take(&mut self.shell.sent) {
            match action {
                Action::Notify(notice) => self.notices.push(notice),
                Action::RemoveNotices(topic) => {
                    self.notices.retain(|notice| notice.topic != topic);
                }
                Action::WithdrawUndo(_) => {
                    for notice in &mut self.notices {
                        if matches!(notice.kind, NoticeKind::Undoable(_)) {
                            notice.kind = NoticeKind::Done;
                        }
                    }
                }
                Action::LibraryChanged { library, saved } => {
                    self.shell.session.library = Some(library);
                    self.saved = saved;
                }
                other => panic!("{other:?}"),
            }
        }
    }

    /// Makes an L-shaped plate of this width in points (5 mm apart) the draft.
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
        let scene = SceneOrScan::Scene(source);
        self.enrol
            .take(scene, "Taking".into(), &self.shell.context());
        self.work();
        self.act(EnrolAction::TakeAs(InitialSelection::Whole));
    }

    /// Opens a file.
    fn open(&mut self, path: PathBuf) {
        let scene = SceneOrScan::Scene(SceneSource::File(path));
        self.enrol
            .take(scene, "Opening".into(), &self.shell.context());
        self.deliver();
        self.work();
    }

    /// Opens a file with the meshes of three parts, listed by name, and ticks all. Returns its path.
    fn list_meshes(&mut self) -> PathBuf {
        let path = self.files.path().join("car.obj");
        let kinds = [PartKind::Fender, PartKind::Grille, PartKind::TrunkLid];
        let [fender, grille, lid] = kinds.map(|kind| PartModel::new(kind, Side::Left, 0));
        let objects = [
            ("Fender", fender.mesh()),
            ("Grille", grille.mesh()),
            ("Lid", lid.mesh()),
        ];
        std::fs::write(&path, obj_of(&objects)).expect("written");
        self.open(path.clone());
        self.in_list(MeshAction::Order(MeshOrder::Name));
        self.in_list(MeshAction::Tick(0));
        self.in_list(MeshAction::TickTo(2));
        path
    }

    fn in_list(&mut self, action: MeshAction) {
        self.act(EnrolAction::Meshes(action));
    }

    /// Title of the draft, with its number and that of all chosen meshes.
    fn chosen(&self) -> Option<(&str, [usize; 2])> {
        let draft = self.enrol.draft.as_ref()?;
        Some((&draft.form.title, draft.chosen.as_ref()?.number_of_all()))
    }

    /// Brings back the draft of an earlier start.
    fn bring_back(&mut self, kept: KeptDraft) {
        self.enrol.bring_back(kept, &mut self.shell.context());
        self.deliver();
        self.work();
    }

    fn with_plate_and_sheet() -> (Self, [PartName; 2]) {
        let mut bench = Self::new();
        for (width, title) in [(80, "Plate"), (90, "Sheet")] {
            bench.take(width);
            bench.named(title);
            bench.act(EnrolAction::Save);
        }
        let names = ["plate", "sheet"].map(|name| PartName::new(name).expect("a name"));
        (bench, names)
    }

    fn named(&mut self, title: &str) {
        self.act(EnrolAction::Write(Field::Title(title.into())));
    }

    fn kept(&self) -> Vec<u32> {
        let draft = self.enrol.draft.as_ref().expect("a draft");
        draft.selection.indices.clone()
    }

    fn from(&self) -> Option<String> {
        let draft = self.enrol.draft.as_ref()?;
        Some(draft.subject.origin.title())
    }

    fn names(&self) -> Vec<String> {
        let library = self.shell.session.library.as_ref().expect("loaded");
        library
            .parts
            .iter()
            .map(|part| part.name.to_string())
            .collect()
    }
}

/// A box at the top left of the picture, 0.3 of its width and height.
fn corner(mode: OutlineMode) -> Edit {
    let corners = [[0.0, 0.0], [0.3, 0.0], [0.3, 0.3], [0.0, 0.3]];
    let outline = DrawnOutline {
        corners: corners.map(Vec2::from).into(),
        over: DrawnOver::Picture,
    };
    Edit::Outline(mode, outline)
}

/// A lasso around the middle of a view turned by this angle.
fn lasso(mode: OutlineMode, right: f32) -> Edit {
    let mut camera = ViewCamera::default();
    camera.turn(right, 0.3);
    let corners = [[0.5, 0.1], [0.8, 0.5], [0.5, 0.9], [0.3, 0.5]];
    let outline = DrawnOutline {
        corners: corners.map(Vec2::from).into(),
        over: DrawnOver::View {
            clip_from_world: camera.clip_from_world(Vec2::new(800.0, 600.0)),
        },
    };
    Edit::Outline(mode, outline)
}

#[test]
fn every_correction_is_taken_back_and_done_again_in_its_order() {
    let mut bench = Bench::new();
    bench.take(80);
    let mut kept = vec![bench.kept()];
    for edit in [
        corner(OutlineMode::Keep),
        Edit::Segment(0, PointAction::Kept),
        corner(OutlineMode::Drop),
        lasso(OutlineMode::Drop, 0.4),
        lasso(OutlineMode::Add, -0.8),
        lasso(OutlineMode::Keep, 0.0),
    ] {
        bench.act(EnrolAction::Correct(edit));
        assert_ne!(Some(&bench.kept()), kept.last());
        kept.push(bench.kept());
    }
    assert_eq!(kept[2], kept[0]);
    assert_eq!(kept[3].len(), kept[0].len() - kept[1].len());
    for before in kept.iter().rev().skip(1) {
        bench.act(EnrolAction::Undo);
        assert_eq!(bench.kept(), *before);
    }
    for after in &kept[1..] {
        bench.act(EnrolAction::Redo);
        assert_eq!(bench.kept(), *after);
    }
    bench.act(EnrolAction::Reset);
    assert_eq!(bench.kept(), kept[0]);
    bench.act(EnrolAction::Undo);
    assert_eq!(Some(&bench.kept()), kept.last());
    bench.act(EnrolAction::Undo);
    bench.act(EnrolAction::Correct(Edit::Segment(0, PointAction::Dropped)));
    bench.act(EnrolAction::Redo);
    assert!(bench.kept().is_empty(), "what was done since counts");
    let draft = bench.enrol.draft.as_ref().expect("a draft");
    assert!(
        matches!(&draft.checked, Some(Err(_))),
        "{:?}",
        draft.checked
    );
}

#[test]
fn a_box_then_a_lasso_is_drawn_by_one_key_and_escape_ends_it() {
    let mut bench = Bench::new();
    let mut after = |action| {
        bench.act(action);
        bench.enrol.shape
    };
    let (a_box, lasso) = (Some(DrawnShape::Box), Some(DrawnShape::Lasso));
    let shapes = [(); 3].map(|()| after(EnrolAction::DrawNext));
    assert_eq!(shapes, [a_box, lasso, a_box]);
    assert_eq!(after(EnrolAction::Draw(None)), None);
    bench.act(EnrolAction::DrawNext);
    let mut context = bench.shell.context();
    bench.enrol.on_event(&Event::Escape, &mut context);
    assert_eq!(bench.enrol.shape, None);
}

#[test]
fn another_draft_keeps_the_words_and_can_be_taken_back() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.named("Plate");
    bench.take(90);
    assert_eq!(bench.from().as_deref(), Some("90.pcd"));
    let draft = bench.enrol.draft.as_ref().expect("a draft");
    assert_eq!(draft.form.name, "plate");
    // Undo the choice of the whole cloud, then the new draft.
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
        let library = bench.shell.session.library.as_ref().expect("loaded");
        library.parts.first().map(|part| part.enrolled.from.clone())
    };
    assert_eq!(enrolled_from(&bench).as_deref(), Some("90.pcd"));
    assert_eq!(
        bench.notices.last().map(|n| n.kind),
        Some(NoticeKind::Undoable(WorkspaceKind::Enrol))
    );
    bench.act(EnrolAction::Undo);
    assert_eq!(enrolled_from(&bench).as_deref(), Some("80.pcd"));
    assert_eq!(bench.from().as_deref(), Some("90.pcd"), "the draft is back");
    bench.act(EnrolAction::Redo);
    assert_eq!(enrolled_from(&bench).as_deref(), Some("90.pcd"));
    bench.act(EnrolAction::Undo);
    // Undo the draft's own steps, then the first save.
    while enrolled_from(&bench).is_some() {
        bench.act(EnrolAction::UndoChange);
    }
    assert_eq!(bench.from().as_deref(), Some("80.pcd"));
}

#[test]
fn undo_with_a_draft_takes_back_its_corrections_and_no_change_of_the_library() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.named("Plate");
    bench.act(EnrolAction::Save);
    bench.take(90);
    let whole = bench.kept();
    bench.act(EnrolAction::Undo);
    assert!(
        bench.enrol.next_undo().is_none(),
        "the choice of all points"
    );
    bench.act(EnrolAction::Undo);
    assert_eq!(bench.names(), ["plate"]);
    assert_eq!(bench.from().as_deref(), Some("90.pcd"));

    bench.act(EnrolAction::Redo);
    bench.act(EnrolAction::Correct(corner(OutlineMode::Drop)));
    bench.act(EnrolAction::Remove(PartName::new("plate").expect("a name")));
    bench.act(EnrolAction::Undo);
    assert_eq!(bench.kept(), whole);
    assert!(bench.names().is_empty());
    bench.act(EnrolAction::UndoChange);
    assert_eq!(bench.names(), ["plate"]);
    assert_eq!(bench.from().as_deref(), Some("90.pcd"));
}

#[test]
fn an_offer_to_undo_goes_when_something_else_was_done() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.named("Plate");
    bench.act(EnrolAction::Save);
    bench.take(90);
    let kinds = bench.notices.iter().map(|notice| notice.kind);
    assert!(
        kinds
            .into_iter()
            .all(|kind| kind != NoticeKind::Undoable(WorkspaceKind::Enrol))
    );
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
    let last = bench.notices.last().expect("a notice");
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
fn an_undo_does_not_discard_what_another_program_did_since() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.named("Plate");
    bench.act(EnrolAction::Save);
    let other = LibraryFolder::open(bench.folder.path()).expect("there");
    let plate = PartName::new("plate").expect("a name");
    let names = || other.names().expect("listed");
    let is_refused = |bench: &Bench| {
        let last = bench.notices.last().expect("a notice");
        last.what.contains("left as it is") && !last.advice.is_empty()
    };
    let own = other.words(&plate).expect("saved");
    let theirs = PartNaming {
        notes: "theirs".into(),
        ..own.clone()
    };
    other.rename(&plate, &theirs).expect("changed");
    bench.act(EnrolAction::Undo);
    assert!(is_refused(&bench), "{:?}", bench.notices);
    assert_eq!(names(), ["plate"]);
    // As it was, it may go, and a part that has taken its place since stays.
    other.rename(&plate, &own).expect("changed back");
    bench.act(EnrolAction::Undo);
    assert!(names().is_empty() && !is_refused(&bench));
    let trashed = other.trashed().expect("listed");
    other.restore(&trashed[0].kept).expect("restored");
    bench.act(EnrolAction::Redo);
    assert!(is_refused(&bench), "{:?}", bench.notices);
    assert_eq!(other.trashed().expect("listed").len(), trashed.len() - 1);
}

#[test]
fn one_change_of_the_library_at_a_time() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.named("Plate");
    let num_steps = bench.enrol.steps.done.len();
    bench.begin(EnrolAction::Save);
    bench.begin(EnrolAction::Write(Field::Title("Sheet".into())));
    bench.begin(EnrolAction::Save);
    bench.begin(EnrolAction::Undo);
    assert_eq!(
        bench.enrol.steps.done.len(),
        num_steps,
        "nothing is taken back"
    );
    bench.work();
    assert_eq!(bench.names(), ["plate"]);
}

#[test]
fn an_undo_while_the_library_is_changed_leaves_the_order_of_the_steps() {
    let (mut bench, [plate, sheet]) = Bench::with_plate_and_sheet();
    bench.take(100);
    bench.act(EnrolAction::Remove(plate));
    bench.begin(EnrolAction::Remove(sheet));
    // It would undo the draft's own step, which is before that of the library.
    bench.begin(EnrolAction::Undo);
    let last = bench.enrol.steps.done.last();
    assert!(matches!(last, Some(UndoStep::Library(_))), "{last:?}");
}

#[test]
fn what_was_saved_is_known_by_its_scene_not_by_its_name() {
    let mut bench = Bench::new();
    bench.take(80);
    let draft = bench.enrol.draft.as_ref().expect("a draft");
    let (origin, scene) = (draft.subject.origin.clone(), draft.subject.scene().cloned());
    bench.named("Plate");
    bench.act(EnrolAction::Save);
    // Another capture that was saved to the same file.
    let mut inspected = inspected_cell(CellChoice::InTurn, 1);
    inspected.origin = origin;
    let saved = bench.enrol.saved_from.as_ref().expect("saved");
    assert!(!saved.matter.is_inspected_in(&inspected));
    inspected.scene = scene.expect("a scene");
    assert!(saved.matter.is_inspected_in(&inspected));
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
    let open = bench.enrol.open.as_ref().expect("still open");
    assert_eq!(open.name.as_str(), "sheet");
}

#[test]
fn with_a_card_open_save_stores_its_words_and_leaves_the_draft() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.named("Plate");
    bench.act(EnrolAction::Save);
    bench.take(90);
    bench.named("Sheet");
    bench.act(EnrolAction::Open(PartName::new("plate").expect("a name")));
    let title = Field::Title("Plate, bent".into());
    bench.act(EnrolAction::WriteOpen(title));
    bench.act(EnrolAction::Save);
    let library = bench.shell.session.library.as_ref().expect("loaded");
    let titles: Vec<&str> = library.parts.iter().map(|part| &*part.title).collect();
    assert_eq!(titles, ["Plate, bent"]);
    assert!(bench.enrol.draft.is_some());
    // Its words are stored already.
    let num_changes = bench.enrol.num_changes;
    bench.act(EnrolAction::Save);
    assert_eq!(bench.enrol.num_changes, num_changes);
    bench.act(EnrolAction::Close);
    bench.act(EnrolAction::Save);
    assert_eq!(bench.names(), ["plate", "sheet"]);
}

#[test]
fn without_a_name_nothing_is_saved_and_it_is_said() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.act(EnrolAction::Save);
    assert!(!bench.enrol.is_changing_library());
    assert!(bench.notices[0].what.contains("name is empty"));
}

#[test]
fn what_is_checked_names_the_part_that_is_hardest_to_tell_from() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.named("Plate");
    bench.act(EnrolAction::Save);
    bench.take(80);
    bench.named("Twin");
    let draft = bench.enrol.draft.as_ref().expect("a draft");
    let library = bench.shell.session.library.as_deref();
    let hardest = draft.hardest(library).expect("one is enrolled");
    assert!(
        hardest.other == "plate" && !hardest.is_distinguishable(),
        "{hardest}"
    );
    bench.act(EnrolAction::Replace(
        PartName::new("plate").expect("a name"),
    ));
    let draft = bench.enrol.draft.as_ref().expect("a draft");
    let library = bench.shell.session.library.as_deref();
    assert!(draft.hardest(library).is_none(), "it replaces the only one");
}

#[test]
fn no_reference_of_its_own_part_is_hard_to_tell_from_the_draft() {
    let mut bench = Bench::new();
    let plate = PartName::new("plate").expect("a name");
    let of_plate = || EnrolAction::Write(Field::ReferenceOf(Some(plate.clone())));
    for title in ["Plate", "Plate, bent"] {
        bench.take(80);
        bench.named(title);
        if title != "Plate" {
            bench.act(of_plate());
        }
        bench.act(EnrolAction::Save);
    }
    assert_eq!(bench.names(), ["plate", "plate_bent"]);
    let hardest = |bench: &Bench| {
        let draft = bench.enrol.draft.as_ref().expect("a draft");
        let library = bench.shell.session.library.as_deref();
        draft.hardest(library).map(|hardest| hardest.other.clone())
    };
    bench.take(80);
    bench.named("Third");
    assert!(hardest(&bench).is_some(), "a part of its own");
    bench.act(of_plate());
    assert_eq!(hardest(&bench), None);
    bench.act(EnrolAction::Write(Field::ReferenceOf(None)));
    bench.act(EnrolAction::Replace(plate));
    assert_eq!(hardest(&bench), None);
}

#[test]
fn what_was_written_comes_back_if_no_part_is_replaced_after_all() {
    let (mut bench, [plate, sheet]) = Bench::with_plate_and_sheet();
    let form = |bench: &Bench| {
        let draft = bench.enrol.draft.as_ref().expect("a draft");
        draft.form.clone()
    };
    bench.take(100);
    bench.named("My plate");
    bench.act(EnrolAction::Write(Field::Notes("Batch 7".into())));
    let written = form(&bench);
    // Another part to replace, and another draft for it, change nothing of what was written.
    bench.act(EnrolAction::Replace(plate.clone()));
    bench.act(EnrolAction::Replace(sheet));
    assert_eq!(form(&bench).title, "Sheet");
    bench.take(110);
    assert_eq!(form(&bench).title, "Sheet");
    bench.act(EnrolAction::ReplaceNone);
    assert_eq!(form(&bench), written);
    assert!(bench.enrol.replacing.is_none());
    // Without a draft, the replacement is chosen before anything is written.
    bench.act(EnrolAction::Discard);
    bench.act(EnrolAction::Replace(plate));
    bench.take(120);
    assert_eq!(form(&bench).title, "Plate");
    bench.act(EnrolAction::ReplaceNone);
    assert_eq!(form(&bench), Form::default());
}

#[test]
fn a_result_that_comes_when_the_draft_is_gone_changes_nothing() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.begin(EnrolAction::LookAgain);
    assert!(bench.enrol.draft_task.run_waiting());
    bench.begin(EnrolAction::Discard);
    bench.enrol.update(&mut bench.shell.context());
    assert!(bench.enrol.draft.is_none() && bench.enrol.running().is_none());
}

/// A corrected draft of a simulated frame as it would be written, and the indices that it keeps.
fn corrected() -> (KeptDraft, Vec<u32>) {
    let mut bench = Bench::new();
    let choice = CellChoice::Part(PartKind::Grille, Side::Left);
    let source = SceneSource::Cell { choice, number: 3 };
    let (scene, title) = (SceneOrScan::Scene(source), "Taking".to_owned());
    bench.enrol.take(scene, title, &bench.shell.context());
    bench.work();
    for edit in [corner(OutlineMode::Drop), lasso(OutlineMode::Drop, 0.4)] {
        bench.act(EnrolAction::Correct(edit));
    }
    bench.named("Plate");
    bench.act(EnrolAction::Write(Field::Notes("bent".into())));
    let draft = bench.enrol.worked_on().expect("a draft");
    let kept = KeptDraft {
        checksum: Some(draft.selection.checksum()),
        ..KeptDraft::of(draft)
    };
    (kept, bench.kept())
}

#[test]
fn a_draft_of_an_earlier_start_comes_back_as_it_was() {
    let (kept, points) = corrected();
    let mut bench = Bench::new();
    bench.bring_back(kept.clone());
    assert_eq!(bench.kept(), points);
    let draft = bench.enrol.draft.as_ref().expect("a draft");
    assert_eq!(
        (&draft.form, &draft.corrections),
        (&kept.form, &kept.corrections)
    );
    let kinds: Vec<_> = bench.notices.iter().map(|notice| notice.kind).collect();
    assert_eq!(kinds, [NoticeKind::Done], "{:?}", bench.notices);
    // As with another recipe, or another file of the same name.
    let mut bench = Bench::new();
    bench.bring_back(KeptDraft {
        checksum: Some(7),
        ..kept
    });
    let last = bench.notices.last().expect("a notice");
    assert!(last.what.contains("other points"), "{last:?}");
}

#[test]
fn of_a_draft_whose_scene_is_gone_the_words_come_back_with_the_next() {
    let (kept, _) = corrected();
    let camera = Origin::Frame {
        name: "Kinect frame 12".into(),
        is_simulated: false,
        capture: None,
    };
    let gone = Origin::File {
        path: "no such folder/door.pcd".into(),
        is_simulated: false,
    };
    // A file that cannot be read also reports its own error first.
    for (origin, num_notices) in [(camera, 1), (gone, 2)] {
        let mut bench = Bench::new();
        bench.bring_back(KeptDraft {
            origin,
            ..kept.clone()
        });
        assert!(bench.enrol.draft.is_none() && bench.enrol.coming.is_some());
        assert_eq!(bench.notices.len(), num_notices, "{:?}", bench.notices);
        let last = bench.notices.last().expect("a notice");
        assert!(last.advice.contains("Take the part again"), "{last:?}");
        bench.take(80);
        let draft = bench.enrol.draft.as_ref().expect("a draft");
        assert_eq!(draft.form, kept.form);
        assert!(draft.corrections.edits.is_empty() && bench.enrol.coming.is_none());
    }
}

#[test]
fn without_its_scene_a_draft_is_no_reference_of_another_part_any_more() {
    let (kept, _) = corrected();
    let mut bench = Bench::new();
    let mut form = kept.form.clone();
    form.title.clear();
    let fender = PartName::new("fender").expect("a name");
    form.write(Field::ReferenceOf(Some(fender)), None);
    assert_eq!(form.name, "fender_2");
    bench.bring_back(KeptDraft {
        origin: Origin::Frame {
            name: "Kinect frame 12".into(),
            is_simulated: false,
            capture: None,
        },
        form,
        ..kept
    });
    bench.take(80);
    let form = &bench.enrol.draft.as_ref().expect("a draft").form;
    assert_eq!(
        (&*form.name, &*form.notes, &form.reference_of),
        ("", "bent", &None)
    );
}

#[test]
fn what_is_saved_is_inspected_only_if_nothing_newer_was_captured() {
    let inspected = |generation| {
        Some(Shown::new(
            generation,
            Arc::new(inspected_cell(CellChoice::InTurn, generation)),
        ))
    };
    // In Inspect, in Enrol, nowhere.
    for step in 0..3 {
        let mut bench = Bench::new();
        bench.shell.session.shown = inspected(1);
        bench.take(80);
        match step {
            0 => bench.shell.session.shown = inspected(2),
            1 => {
                bench.take(60);
                bench.act(EnrolAction::Undo);
                bench.act(EnrolAction::Undo);
            }
            _ => {}
        }
        assert_eq!(bench.from().as_deref(), Some("80.pcd"));
        bench.named("Plate");
        bench.act(EnrolAction::Save);
        assert_eq!(bench.names(), ["plate"]);
        assert_eq!(bench.saved.is_some(), step == 2, "{step}");
    }
}

#[test]
fn an_operator_is_asked_for_the_engineer_before_anything_changes() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.shell.session.role = UserRole::Operator;
    let discard = EnrolAction::Discard;
    bench.enrol.apply(discard, &mut bench.shell.context());
    assert!(matches!(
        bench.shell.sent[..],
        [Action::AskEngineer(WorkspaceKind::Enrol)]
    ));
    bench.shell.sent.clear();
    assert!(bench.enrol.draft.is_some());
    bench.shell.session.role = UserRole::Engineer;
    let event = Event::EngineerIn;
    bench.enrol.on_event(&event, &mut bench.shell.context());
    assert!(bench.enrol.draft.is_none());
}

#[test]
fn chosen_meshes_follow_each_other_as_they_are_saved_or_skipped() {
    let mut bench = Bench::new();
    bench.list_meshes();
    assert!(bench.enrol.draft.is_none());
    bench.in_list(MeshAction::Enrol(None));
    assert!(bench.enrol.mesh_list.is_none());
    assert_eq!(bench.chosen(), Some(("Fender", [1, 3])));
    bench.act(EnrolAction::Save);
    assert_eq!(bench.chosen(), Some(("Grille", [2, 3])));
    bench.act(EnrolAction::Discard);
    assert_eq!(bench.chosen(), Some(("Lid", [3, 3])));
    // The skipped one is taken back, and the last one follows it again.
    bench.act(EnrolAction::Undo);
    assert_eq!(bench.chosen(), Some(("Grille", [2, 3])));
    bench.act(EnrolAction::Save);
    assert_eq!(bench.chosen(), Some(("Lid", [3, 3])));
    bench.act(EnrolAction::Save);
    assert!(bench.enrol.draft.is_none());
    assert_eq!(bench.names(), ["fender", "grille", "lid"]);
}

#[test]
fn the_rest_of_the_chosen_meshes_is_left_out_or_gives_way_to_another_scene() {
    let mut bench = Bench::new();
    for leaves_out in [true, false] {
        bench.list_meshes();
        bench.in_list(MeshAction::Enrol(None));
        if leaves_out {
            bench.act(EnrolAction::LeaveOutRest);
        } else {
            bench.take(80);
            bench.named("Plate");
        }
        bench.act(EnrolAction::Save);
        assert_eq!(bench.from(), None);
    }
    assert_eq!(bench.names(), ["fender", "plate"]);
}

#[test]
fn a_chosen_mesh_has_no_words_of_the_draft_before_it() {
    let mut bench = Bench::new();
    bench.take(80);
    bench.named("Plate");
    bench.list_meshes();
    assert_eq!(bench.from().as_deref(), Some("80.pcd"));
    bench.in_list(MeshAction::Enrol(None));
    assert_eq!(bench.chosen(), Some(("Fender", [1, 3])));
    assert_eq!(bench.from().as_deref(), Some("car.obj#Fender"));
    bench.act(EnrolAction::Undo);
    let draft = bench.enrol.draft.as_ref().expect("the former one");
    assert_eq!((&*draft.form.title, &draft.chosen), ("Plate", &None));
}

#[test]
fn a_file_of_several_meshes_is_one_part_if_so_chosen_and_after_a_restart() {
    let mut bench = Bench::new();
    bench.list_meshes();
    bench.in_list(MeshAction::EnrolWhole);
    bench.named("Car");
    let kept = KeptDraft::of(bench.enrol.draft.as_ref().expect("a draft"));
    let mut after = Bench::new();
    after.bring_back(kept);
    assert!(after.enrol.mesh_list.is_none());
    assert_eq!(after.from().as_deref(), Some("car.obj"));
    let draft = after.enrol.draft.as_ref().expect("back");
    assert_eq!(draft.form.title, "Car");
}

#[test]
fn pictures_are_drawn_of_visible_meshes_until_the_list_is_closed() {
    let mut bench = Bench::new();
    let path = bench.list_meshes();
    let draw = |bench: &mut Bench| {
        bench.in_list(MeshAction::Visible(0..2));
        assert!(bench.enrol.is_drawing_meshes());
    };
    let waiting = |bench: &Bench| {
        let list = bench.enrol.mesh_list.as_ref().expect("a list");
        list.without_picture().len()
    };
    draw(&mut bench);
    assert!(bench.enrol.picture_task.run_waiting());
    bench.enrol.update(&mut bench.shell.context());
    assert_eq!(
        (waiting(&bench), bench.enrol.is_drawing_meshes()),
        (0, false)
    );
    let list = bench.enrol.mesh_list.as_ref().expect("a list");
    let drawn = [0, 1, 2].map(|index| list.picture(index).is_some());
    assert_eq!(drawn, [true, true, false]);

    bench.open(path);
    draw(&mut bench);
    bench.in_list(MeshAction::Close);
    assert!(!bench.enrol.is_drawing_meshes());
    bench.enrol.picture_task.run_waiting();
    bench.enrol.update(&mut bench.shell.context());
    assert!(bench.enrol.mesh_list.is_none() && bench.enrol.draft.is_none());
}
