//! History: find, reopen and label past inspections.

mod action;
mod apply;
mod bar;
mod details;
mod drift;
mod filter;
mod list;
mod reopen;
mod servo_runs;
mod state;
mod statistics;
mod work;

use std::sync::Arc;

use egui::{CentralPanel, Frame, Key, Margin, Modifiers, Rect, Ui};

pub use self::{
    action::{Direction, HistoryAction, HistoryFile, HistoryJob},
    filter::{DateRange, ListFilter},
    state::HistoryState,
    statistics::{ReasonGroup, Statistics, StatisticsView, Tally},
    work::{HistoryQuery, HistoryResult, OpenedInspection, RunsView},
};
use self::{details::Details, list::List};

use records::history::{HistoryBuffer, Writer};
use shell::{
    action::Event,
    inspection::folder_watch::FolderWatch,
    session::{Session, WorkspaceKind},
    workspace::{ShellContext, Workspace},
};
use ui::{
    key_binding::{KeyBinding, Shortcut},
    language::text,
    task::{Running, TaskRunner},
    theme::space,
    widgets::side_panel,
};

/// Width of the details in a wide and in a narrow window, logical pixels.
const DETAILS: [f32; 2] = [340.0, 300.0];

/// The shortcuts of this workspace.
#[rustfmt::skip]
const SHORTCUTS: [Shortcut<HistoryAction>; 4] = [
    Shortcut::new(Modifiers::NONE, Key::ArrowUp, || text!("history-key-newer"), || HistoryAction::Step(Direction::Up)),
    Shortcut::new(Modifiers::NONE, Key::ArrowDown, || text!("history-key-older"), || HistoryAction::Step(Direction::Down)),
    Shortcut::new(Modifiers::NONE, Key::Enter, || text!("history-key-open"), || HistoryAction::OpenSelected),
    Shortcut::new(Modifiers::NONE, Key::A, || text!("history-key-again"), || HistoryAction::AgainSelected),
];

/// The workspace.
pub struct HistoryWorkspace {
    /// The state of the workspace.
    pub state: HistoryState,
    details: Details,
    list: List,
    writer: Writer,
    keeper: Arc<HistoryBuffer>,
    /// Watches for what commands write.
    watch: FolderWatch,
    /// True once inspections written before the start have been looked for.
    has_looked: bool,
}

impl HistoryWorkspace {
    /// Creates the workspace; `writer` writes what `keeper` buffers.
    pub fn new(writer: Writer, keeper: Arc<HistoryBuffer>, runner: &TaskRunner) -> Self {
        Self {
            state: HistoryState::new(runner),
            details: Details::default(),
            list: List::default(),
            writer,
            keeper,
            watch: FolderWatch::new("history-watch", runner),
            has_looked: false,
        }
    }

    /// Carries out an action and hands its jobs to the writer.
    pub fn apply(&mut self, action: HistoryAction, cx: &mut ShellContext<'_>) {
        self.state.apply(action, cx);
        self.write();
    }

    /// Hands queued jobs to the writer.
    fn write(&mut self) {
        for job in self.state.jobs.drain(..) {
            match job {
                HistoryJob::Add(ticket, entry) => self.writer.add(ticket, *entry),
                HistoryJob::Trace(hung, change) => self.writer.trace(hung, change),
                HistoryJob::Remark(number, remark) => self.writer.remark(number, remark),
                HistoryJob::Label(number, label) => self.writer.label(number, label),
                HistoryJob::LabelPart(part, label) => self.writer.set_part_label(part, label),
                HistoryJob::Keep(rule) => self.writer.retention(rule),
            }
        }
    }
}

impl Workspace for HistoryWorkspace {
    fn kind(&self) -> WorkspaceKind {
        WorkspaceKind::History
    }

    fn ui(&mut self, ui: &mut Ui, cx: &mut ShellContext<'_>) -> Rect {
        let Self {
            state,
            details,
            list,
            ..
        } = self;
        let session = cx.session;
        if state.num_rows() == 0 && state.num_servo_runs == 0 && state.problem.is_none() {
            empty(ui);
            return ui.max_rect();
        }
        let mut actions = Vec::new();
        side_panel(
            ui,
            "details",
            DETAILS,
            Margin::same(16),
            |ui| match &state.runs {
                Some(runs) => servo_runs::details(ui, runs, session.units),
                None => details.ui(ui, state, session, &mut actions),
            },
        );
        let room = ui.available_rect_before_wrap();
        CentralPanel::default()
            .frame(Frame::new().inner_margin(Margin::same(16)))
            .show(ui, |ui| {
                if let Some(runs) = &state.runs {
                    bar::ui(ui, state, session, &mut actions);
                    ui.add_space(space::SMALL);
                    servo_runs::list(ui, runs, session.units, &mut actions);
                } else if state.statistics.is_open() {
                    bar::ui(ui, state, session, &mut actions);
                    ui.add_space(space::SMALL);
                    statistics::ui(ui, &state.statistics, session.units);
                } else {
                    list.ui(ui, state, session, &mut actions);
                }
            });
        bar::retention_rule(ui.ctx(), state, &mut actions);
        for action in actions {
            self.apply(action, cx);
        }
        room
    }

    fn update(&mut self, cx: &mut ShellContext<'_>) {
        if !std::mem::replace(&mut self.has_looked, true) {
            self.state.look(cx);
        }
        let crowded = self.writer.take_dropped();
        if crowded != [0; 2] {
            self.state.crowded(crowded[1], cx);
        }
        if let Some(folder) = self.keeper.folder() {
            self.watch.watch(folder);
        }
        if self.watch.has_changed() {
            self.keeper.files_changed();
        }
        for news in self.keeper.take_news() {
            self.state.take_news(news, cx);
        }
        self.state.update(cx);
        self.write();
    }

    fn on_event(&mut self, event: &Event, cx: &mut ShellContext<'_>) {
        self.state.on_event(event, cx);
        self.write();
    }

    fn close(&mut self) {
        if let Some((number, remark)) = self.details.remark.take_edited(None) {
            self.state.queue(HistoryJob::Remark(number, remark));
        }
        self.write();
    }

    fn key_bindings(&self) -> Vec<KeyBinding> {
        SHORTCUTS.iter().map(|shortcut| shortcut.binding).collect()
    }

    fn press(&mut self, index: usize, cx: &mut ShellContext<'_>) {
        if let Some(shortcut) = SHORTCUTS.get(index) {
            self.apply((shortcut.action)(), cx);
        }
    }

    fn writing(&self) -> Option<&Running> {
        self.state.exporting.running()
    }

    fn is_idle(&self, _session: &Session) -> bool {
        self.state.is_settled()
    }
}

/// Draws the area before the first inspection.
fn empty(ui: &mut Ui) {
    ui.vertical_centered(|ui| {
        ui.add_space(ui.available_height() * 0.4);
        ui.heading(text!("shell-nothing-inspected"));
        ui.add_space(space::SMALL);
        ui.weak(text!("history-empty-advice"));
    });
}
