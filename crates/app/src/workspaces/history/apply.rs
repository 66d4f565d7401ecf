//! Carries out the actions of the workspace, and takes over events and the results of tasks.

use std::{path::PathBuf, sync::Arc};

use super::{
    action::{Direction, HistoryAction, HistoryFile, HistoryJob},
    filter::ListFilter,
    state::HistoryState,
    statistics::StatisticsView,
    work::{self, HistoryResult},
};
use crate::shared::truth_title;
use records::history::{HistoryEvent, NewEntry, PruneResult, SetAside};
use shell::{
    action::{Action, Event},
    inspection::{inspected::Inspected, library_cache::LibraryView, source::file_name},
    notice::{Notice, NoticeTopic},
    session::{ReinspectionPurpose, UserRole, WorkspaceKind},
    workspace::ShellContext,
};
use ui::{language::text, user_error::UserError};

impl HistoryState {
    /// Carries out an action; where the engineer is needed, an operator is first asked for the engineer.
    pub fn apply(&mut self, action: HistoryAction, cx: &mut ShellContext<'_>) {
        if action.needs_engineer() && cx.session.role == UserRole::Operator {
            self.held = Some(action);
            cx.send(Action::AskEngineer(WorkspaceKind::History));
            return;
        }
        match action {
            HistoryAction::Filter(filter) => {
                self.filter = filter;
                self.look(cx);
            }
            HistoryAction::Visible(rows) => {
                if self.sees(rows) {
                    self.look(cx);
                }
            }
            HistoryAction::Select(number) => self.select(number, cx),
            HistoryAction::Step(direction) if self.runs.is_some() => self.step_run(direction, cx),
            HistoryAction::OpenSelected | HistoryAction::AgainSelected if self.runs.is_some() => {}
            HistoryAction::Step(direction) => {
                let at = self.listed().and_then(|number| self.index_of(number));
                let to = match (at, direction) {
                    (None, _) => 0,
                    (Some(at), Direction::Up) => at.saturating_sub(1),
                    (Some(at), Direction::Down) => at + 1,
                };
                if let Some(number) = self.row(to).map(|row| row.number) {
                    self.select(number, cx);
                }
            }
            HistoryAction::OpenSelected => {
                if let Some(number) = self.selected {
                    self.open(number, cx);
                }
            }
            HistoryAction::Open(number) => self.open(number, cx),
            HistoryAction::InspectAgain(number) => self.inspect_again(number, cx),
            HistoryAction::AgainSelected => {
                if let Some(number) = self.selected {
                    self.inspect_again(number, cx);
                }
            }
            HistoryAction::Remark(number, remark) => self.queue(HistoryJob::Remark(number, remark)),
            HistoryAction::Label(number, label) => {
                // What the operator said before may be about the same part.
                if self.former_label.take().is_some() {
                    cx.send(Action::WithdrawUndo(WorkspaceKind::History));
                }
                self.queue(HistoryJob::Label(number, label));
            }
            HistoryAction::Statistics(is_shown) => {
                self.statistics = if is_shown {
                    StatisticsView::Counting
                } else {
                    StatisticsView::Closed
                };
                self.runs = None;
                self.look(cx);
            }
            HistoryAction::ServoRuns(are_shown) => {
                self.statistics = StatisticsView::Closed;
                self.show_runs(are_shown, cx);
            }
            HistoryAction::SelectRun(number) => self.look_at_run(Some(number), cx),
            HistoryAction::Rule(rule) => self.rule = rule,
            HistoryAction::Keep(rule) => {
                self.rule = None;
                self.queue(HistoryJob::Keep(rule.clamped()));
            }
            HistoryAction::Ask(file) => {
                let lock = &cx.services.dialogs;
                self.dialog.open(file, &file.request(), lock, cx.egui);
            }
            HistoryAction::Export(file, path) => self.export(file, path, cx),
        }
    }

    /// Selects this inspection, as the user's choice.
    pub(super) fn select(&mut self, number: i64, cx: &ShellContext<'_>) {
        let is_other = self.selected != Some(number);
        self.selects(number);
        if is_other {
            self.look(cx);
        }
    }

    /// Handles an event of the shell.
    pub fn on_event(&mut self, event: &Event, cx: &mut ShellContext<'_>) {
        match event {
            Event::Inspected { parts, purpose } => match purpose {
                ReinspectionPurpose::New => {
                    // Select the newest: a person coming here from another workspace looks for it.
                    if cx.session.workspace != WorkspaceKind::History {
                        self.select_newest();
                    }
                    for part in parts {
                        self.keep(part.entry.clone(), Some(part));
                    }
                }
                ReinspectionPurpose::Repeated | ReinspectionPurpose::Shots => {}
                ReinspectionPurpose::Past => self.remade(&parts[0], cx),
            },
            Event::Left(entry) => self.keep((**entry).clone(), None),
            Event::TracedLate(hung, change) => {
                let job = HistoryJob::Trace(hung.clone(), change.clone());
                self.jobs.push(job);
            }
            Event::EngineerIn => {
                if let Some(action) = self.held.take() {
                    self.apply(action, cx);
                }
            }
            Event::Labelled {
                part,
                label,
                former,
            } => {
                self.queue(HistoryJob::LabelPart(part.clone(), Some(label.clone())));
                self.former_label = Some((part.clone(), former.clone()));
                let unloaded = LibraryView::default();
                let library = cx.session.library.as_deref().unwrap_or(&unloaded);
                let title = truth_title(Some(label), library);
                let what = text!("history-labelled", part = title);
                cx.notify(Notice::undoable(what, WorkspaceKind::History));
            }
            Event::Drift(part) => {
                self.filter = ListFilter {
                    part: Some(part.clone()),
                    ..ListFilter::default()
                };
                self.apply(HistoryAction::Statistics(true), cx);
                cx.send(Action::GoTo(WorkspaceKind::History));
            }
            Event::Undo(WorkspaceKind::History) => {
                if let Some((part, former)) = self.former_label.take() {
                    self.queue(HistoryJob::LabelPart(part, former));
                    cx.notify(Notice::done(text!("history-label-undone")));
                }
            }
            Event::Escape => {
                let is_in_front = cx.session.workspace == WorkspaceKind::History;
                if is_in_front && self.runs.is_some() {
                    self.show_runs(false, cx);
                } else if is_in_front && cx.session.role == UserRole::Operator {
                    cx.send(Action::GoTo(WorkspaceKind::Inspect));
                }
            }
            Event::PosesWanted(_) | Event::WrongPart(_) | Event::Export | Event::Undo(_) => {}
        }
    }

    /// Queues an inspection for writing, and keeps it whole in memory for a while.
    pub(super) fn keep(&mut self, entry: NewEntry, whole: Option<&Arc<Inspected>>) {
        let ticket = self.ticket(&entry.record.summary.hung, whole);
        self.jobs.push(HistoryJob::Add(ticket, Box::new(entry)));
    }

    /// Takes in the results of the tasks and of the file dialog.
    pub fn update(&mut self, cx: &mut ShellContext<'_>) {
        while let Some(event) = self.looking.poll() {
            match event {
                Ok(looked) => self.receive(*looked, cx),
                Err(error) => cx.notify(error),
            }
        }
        match self.counting.poll() {
            Some(Ok(found)) if self.statistics.is_open() => {
                self.statistics = StatisticsView::Counted(found);
            }
            Some(Err(error)) => cx.notify(error),
            Some(_) | None => {}
        }
        match self.finding.poll() {
            Some(Ok(found)) if self.runs.is_some() => self.runs = Some(*found),
            Some(Err(error)) => cx.notify(error),
            Some(_) | None => {}
        }
        cx.notify_written(&mut self.exporting);
        if let Some((file, path)) = cx.chosen(&mut self.dialog) {
            self.apply(HistoryAction::Export(file, path), cx);
        }
    }

    /// Handles inspections lost because the disk is too slow; the oldest are lost first.
    pub(super) fn crowded(&mut self, num_lost: usize, cx: &mut ShellContext<'_>) {
        self.lost(num_lost);
        // Notify only once.
        if !std::mem::replace(&mut self.is_crowded, true) {
            cx.notify(Notice::look(
                text!("history-crowded"),
                text!("history-crowded-advice"),
            ));
        }
        self.refresh_if_stale(cx);
    }

    /// Handles an event of the writer thread.
    pub fn take_news(&mut self, news: HistoryEvent, cx: &mut ShellContext<'_>) {
        match news {
            HistoryEvent::Added { ticket, number } => self.added(ticket, number),
            HistoryEvent::SetAside(SetAside { what, aside }) => {
                let path = aside.display().to_string();
                cx.notify(Notice::look(
                    text!("history-set-aside", what = what),
                    text!("history-set-aside-advice", path = path),
                ));
            }
            HistoryEvent::Failed { what, advice } => {
                let error = UserError { what, advice };
                self.problem = Some(error.clone());
                let mut notice = Notice::from(error);
                notice.advice = text!("history-failed-advice", advice = notice.advice);
                cx.notify(notice);
            }
            HistoryEvent::Works { numbers, num_lost } => {
                self.problem = None;
                self.renumber(&numbers);
                let count = numbers.len();
                cx.notify(Notice::done(if num_lost > 0 {
                    text!("history-works-lost", count = count, lost = num_lost)
                } else {
                    text!("history-works", count = count)
                }));
            }
            HistoryEvent::NotChanged { what, advice } => {
                self.answered();
                cx.notify(UserError { what, advice });
            }
            HistoryEvent::FramesNotKept { what, advice } => {
                let notice = Notice::from(UserError { what, advice });
                cx.notify(notice.about(NoticeTopic::Frames));
            }
            HistoryEvent::FramesKept => cx.send(Action::RemoveNotices(NoticeTopic::Frames)),
            HistoryEvent::Swept(PruneResult {
                num_frames,
                num_bytes,
            }) => {
                let megabytes = format!("{:.1}", num_bytes as f64 / 1e6);
                let what = text!("history-swept", count = num_frames, megabytes = megabytes,);
                cx.notify(Notice::done(what));
                self.is_stale = true;
            }
            HistoryEvent::FilesChanged => self.is_stale = true,
            HistoryEvent::Changed { .. } | HistoryEvent::RuleChanged => self.answered(),
        }
        self.refresh_if_stale(cx);
    }

    /// Takes in the result of a query.
    pub fn receive(&mut self, looked: HistoryResult, cx: &mut ShellContext<'_>) {
        let before = self.selected;
        self.take(looked);
        self.look_at_part();
        if before == self.selected {
            self.go_on(cx);
        } else {
            // The selection has changed: fetch the newly selected inspection.
            self.look(cx);
        }
    }

    /// Writes the listed inspections to the chosen path.
    fn export(&mut self, file: HistoryFile, path: PathBuf, cx: &ShellContext<'_>) {
        let title = text!("shell-writing", file = file_name(&path));
        let filter = self.filter.at(&geometry::clock::zoned_now());
        let keeper = Arc::clone(cx.services.library_cache.history());
        let are_runs = self.runs.is_some();
        self.exporting.start(title, move |_| {
            let written = if are_runs {
                work::write_runs(&filter, &path, &keeper)?
            } else {
                work::write_inspections(&filter, file, &path, &keeper)?
            };
            Ok(Notice::done(written))
        });
    }
}
