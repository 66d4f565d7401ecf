//! Tests of the list, the selection and the inspections in memory, without a writer thread.

use super::*;
use crate::workspaces::history::Direction;
use records::{
    fixtures::history_entry,
    history::{HistoryEvent, HungId, SceneTitle, StoredVerdict},
};
use shell::{
    action::{Action, Event},
    inspection::{inspected::inspected_cell, source::CellChoice},
    notice::{NoticeKind, NoticeTopic},
    session::{ReinspectionPurpose, UserRole, WorkspaceKind},
    workspace::TestShell,
};
use ui::language::Language;

fn inspected(number: u64) -> Arc<Inspected> {
    Arc::new(inspected_cell(CellChoice::Empty, number))
}

fn row(inspected: &Inspected, number: i64) -> Summary {
    Summary {
        number,
        ..inspected.entry.record.summary.clone()
    }
}

/// The workspace without a window; nothing is fetched or written.
struct Bench {
    history: HistoryState,
    shell: TestShell,
}

impl Bench {
    fn new() -> Self {
        Self {
            history: HistoryState::new(&TaskRunner::without_threads()),
            shell: TestShell::default(),
        }
    }

    /// With these rows listed, newest first.
    fn listing(inspected: &Inspected, numbers: &[i64]) -> Self {
        let mut bench = Self::new();
        let rows: Vec<Summary> = numbers.iter().map(|n| row(inspected, *n)).collect();
        let looked = HistoryResult {
            asked: bench.history.wanted(),
            page: Page {
                num_matching: rows.len(),
                num_all: rows.len(),
                rows,
            },
            far_row: None,
            record: None,
            is_listed: true,
            kept: Default::default(),
            frames: None,
            parts: None,
            num_servo_runs: 0,
        };
        bench.history.receive(looked, &mut bench.shell.context());
        let looking = bench.history.looking.running();
        assert!(looking.is_some(), "the newest is looked up");
        bench.history.looking.cancel();
        bench
    }

    fn act(&mut self, action: HistoryAction) {
        self.history.apply(action, &mut self.shell.context());
    }

    fn take_news(&mut self, news: HistoryEvent) {
        self.history.take_news(news, &mut self.shell.context());
    }

    fn inspected(&mut self, inspected: &Arc<Inspected>, purpose: ReinspectionPurpose) {
        let parts = vec![Arc::clone(inspected)];
        let event = Event::Inspected { parts, purpose };
        self.history.on_event(&event, &mut self.shell.context());
    }
}

#[test]
fn a_new_result_is_handed_over_and_the_newest_few_stay_whole() {
    let found = inspected(1);
    let mut bench = Bench::new();
    for number in 1..=7_i64 {
        bench.inspected(&found, ReinspectionPurpose::New);
        let job = bench.history.jobs.pop();
        let Some(HistoryJob::Add(ticket, entry)) = job else {
            panic!("not handed over: {job:?}");
        };
        assert_eq!(entry.record.summary.verdict, StoredVerdict::NoPart);
        assert!(!bench.history.is_settled());
        // Every inspection is of the same part.
        assert_eq!(bench.history.num_rows(), 1);
        bench.take_news(HistoryEvent::Added { ticket, number });
    }
    let whole = |number| bench.history.whole(number).is_some();
    assert!(whole(7) && whole(4) && !whole(3) && !whole(1));
    // Repeating the present scene with another setting is not an inspection of its own.
    bench.inspected(&found, ReinspectionPurpose::Repeated);
    assert!(bench.history.jobs.is_empty());
}

#[test]
fn who_looks_at_the_newest_goes_on_looking_at_the_newest() {
    let found = inspected(1);
    let mut bench = Bench::listing(&found, &[3, 2, 1]);
    assert_eq!(bench.history.selected, Some(3));
    let add = |bench: &mut Bench, number| {
        let ticket = bench.history.ticket(&HungId::new(), Some(&found));
        bench.take_news(HistoryEvent::Added { ticket, number });
    };
    add(&mut bench, 4);
    assert_eq!(bench.history.selected, Some(4));
    let mut bench = Bench::listing(&found, &[3, 2, 1]);
    bench.act(HistoryAction::Select(1));
    add(&mut bench, 4);
    assert_eq!(bench.history.selected, Some(1));
}

#[test]
fn a_row_that_was_chosen_stays_selected_though_it_was_the_newest() {
    let found = inspected(1);
    let add = |bench: &mut Bench, number| {
        let ticket = bench.history.ticket(&HungId::new(), Some(&found));
        bench.take_news(HistoryEvent::Added { ticket, number });
    };
    let mut bench = Bench::listing(&found, &[3, 2, 1]);
    bench.act(HistoryAction::Select(3));
    add(&mut bench, 4);
    add(&mut bench, 5);
    assert_eq!(bench.history.selected, Some(3));
}

#[test]
fn what_the_operator_says_of_a_part_is_written_and_undone_once() {
    let found = inspected(1);
    let mut bench = Bench::new();
    let part = found.hung().clone();
    let label = Truth::Part("grille".into());
    let labelled = Event::Labelled {
        part: part.clone(),
        label: label.clone(),
        former: Some(Truth::Nothing),
    };
    let undo = Event::Undo(WorkspaceKind::History);
    // What another workspace offers to undo is not meant.
    let other = Event::Undo(WorkspaceKind::Enrol);
    for event in [&labelled, &other, &undo, &undo] {
        bench.history.on_event(event, &mut bench.shell.context());
    }
    let jobs = std::mem::take(&mut bench.history.jobs);
    let written: Vec<_> = jobs
        .into_iter()
        .map(|job| match job {
            HistoryJob::LabelPart(of, label) => (of, label),
            job => panic!("{job:?}"),
        })
        .collect();
    let expected = [(part.clone(), Some(label)), (part, Some(Truth::Nothing))];
    assert_eq!(written, expected);
    let offers = bench.shell.sent.iter().filter(|action| match action {
        Action::Notify(notice) => notice.kind == NoticeKind::Undoable(WorkspaceKind::History),
        _ => false,
    });
    assert_eq!((offers.count(), bench.shell.notices().len()), (1, 2));
    assert!(!bench.history.is_settled());

    // Labelled in History since: the offer goes.
    bench
        .history
        .on_event(&labelled, &mut bench.shell.context());
    bench.act(HistoryAction::Label(1, None));
    let is_withdrawn =
        |action: &Action| matches!(action, Action::WithdrawUndo(WorkspaceKind::History));
    assert!(bench.shell.sent.iter().any(is_withdrawn));
    bench.history.jobs.clear();
    bench.history.on_event(&undo, &mut bench.shell.context());
    assert!(bench.history.jobs.is_empty());
}

#[test]
fn the_arrows_stop_at_the_ends() {
    let mut bench = Bench::listing(&inspected(1), &[3, 2, 1]);
    for (direction, expected) in [
        (Direction::Up, 3),
        (Direction::Down, 2),
        (Direction::Down, 1),
        (Direction::Down, 1),
        (Direction::Up, 2),
    ] {
        bench.act(HistoryAction::Step(direction));
        assert_eq!(bench.history.selected, Some(expected));
    }
}

#[test]
fn what_waited_keeps_its_place_under_its_new_number() {
    let found = inspected(1);
    let mut bench = Bench::new();
    let ticket = bench.history.ticket(&HungId::new(), Some(&found));
    let problem = HistoryEvent::Failed {
        what: "the disk is full".into(),
        advice: "Make room".into(),
    };
    bench.take_news(problem);
    bench.take_news(HistoryEvent::Added { ticket, number: -1 });
    assert_eq!(bench.history.selected, Some(-1));
    assert_eq!(bench.shell.notices().len(), 1);
    let works = HistoryEvent::Works {
        numbers: vec![(-1, 58)],
        num_lost: 0,
    };
    bench.take_news(works);
    assert_eq!(bench.history.selected, Some(58));
    assert!(bench.history.whole(58).is_some() && bench.history.problem.is_none());
    assert!(bench.shell.notices()[1].contains("one inspection that waited"));
}

#[test]
fn the_notice_that_frames_are_not_kept_goes_once_one_is() {
    let mut bench = Bench::new();
    bench.take_news(HistoryEvent::FramesNotKept {
        what: "the disk is full".into(),
        advice: "Make room".into(),
    });
    bench.take_news(HistoryEvent::FramesKept);
    let [
        Action::Notify(notice),
        Action::RemoveNotices(NoticeTopic::Frames),
    ] = &bench.shell.sent[..]
    else {
        panic!("{:?}", bench.shell.sent);
    };
    assert_eq!(notice.topic, NoticeTopic::Frames);
}

#[test]
fn rows_out_of_sight_are_asked_for_once() {
    let mut bench = Bench::listing(&inspected(1), &[3, 2, 1]);
    bench.history.page.num_matching = 5000;
    let see = |bench: &mut Bench, rows| {
        bench.act(HistoryAction::Visible(rows));
        bench.history.looking.running().is_some()
    };
    assert!(!see(&mut bench, 0..3));
    assert!(see(&mut bench, 2000..2020));
    assert_eq!(bench.history.wanted().rows, 1900..2120);
}

#[test]
fn a_frame_that_is_gone_is_called_as_the_list_calls_it() {
    let mut record = history_entry(1, StoredVerdict::Accepted, "fender").record;
    record.summary.scene = SceneTitle::SimulatedFrame(7);
    let bench = Bench::new();
    Language::German.make_current();
    let why = bench.history.why_no_scene(&record);
    Language::English.make_current();
    let [what, _] = why.expect("nobody has the frame");
    assert!(what.contains("„Simuliertes Bild 7“"), "{what}");
}

#[test]
fn another_rule_for_frames_waits_for_the_engineer() {
    let mut bench = Bench::new();
    bench.shell.session.role = UserRole::Operator;
    bench.act(HistoryAction::Rule(Some(Retention::default())));
    assert!(bench.history.rule.is_none());
    assert!(matches!(
        bench.shell.sent[..],
        [Action::AskEngineer(WorkspaceKind::History)]
    ));
    bench.shell.session.role = UserRole::Engineer;
    bench
        .history
        .on_event(&Event::EngineerIn, &mut bench.shell.context());
    assert_eq!(bench.history.rule, Some(Retention::default()));
}
