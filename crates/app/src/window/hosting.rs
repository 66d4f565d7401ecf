//! The window's access to its workspaces through their trait: lends them the shell and handles their messages.

use std::any::Any;

use super::Window;
use records::history::HistoryBuffer;
use shell::{
    action::{Action, Effect},
    cell::RobotCell,
    context::ShellContext,
    frame::top_bar::Progress,
    message::Message,
    notice::NoticeKind,
    roles,
    session::{ReinspectionPurpose, WorkspaceKind},
    source::live::LiveAction,
    state::remove_notices,
    workspace::Workspace,
};

impl Window {
    /// Returns the workspace of this type.
    pub fn workspace<W: Workspace>(&self) -> Option<&W> {
        let mut all = self.workspaces.iter();
        all.find_map(|workspace| (workspace.as_ref() as &dyn Any).downcast_ref())
    }

    /// Runs `act` on the workspace of this type, with the shell lent to it, as when the user does something in it.
    pub fn with<W: Workspace, R>(
        &mut self,
        ctx: &egui::Context,
        act: impl FnOnce(&mut W, &mut ShellContext<'_>) -> R,
    ) -> Option<R> {
        let kind = self.workspace::<W>()?.kind();
        self.lend(kind, ctx, |workspace, cx| {
            let workspace = (workspace as &mut dyn Any).downcast_mut()?;
            Some(act(workspace, cx))
        })?
    }

    /// The history in use.
    pub fn history(&self) -> &HistoryBuffer {
        self.services.library_cache.history()
    }

    /// The robot's cell, with its dialog.
    pub fn robot(&self) -> &RobotCell {
        &self.robot
    }

    pub(super) fn hosted(&self, kind: WorkspaceKind) -> Option<&dyn Workspace> {
        let mut all = self.workspaces.iter().map(Box::as_ref);
        all.find(|workspace| workspace.kind() == kind)
    }

    /// Lends a workspace the shell, then handles the messages that it sent.
    pub(super) fn lend<R>(
        &mut self,
        kind: WorkspaceKind,
        ctx: &egui::Context,
        act: impl FnOnce(&mut dyn Workspace, &mut ShellContext<'_>) -> R,
    ) -> Option<R> {
        let mut all = self.workspaces.iter_mut();
        let workspace = all.find(|workspace| workspace.kind() == kind)?;
        let (session, services) = (&self.state.session, &self.services);
        let mut cx = ShellContext::new(ctx, session, services, &mut self.messages);
        let done = act(workspace.as_mut(), &mut cx);
        self.deliver_all(kind, ctx);
        Some(done)
    }

    /// Lends the robot's cell the shell, then handles the messages that it sent.
    pub(super) fn with_robot<R>(
        &mut self,
        ctx: &egui::Context,
        act: impl FnOnce(&mut RobotCell, &mut ShellContext<'_>) -> R,
    ) -> R {
        let (session, services) = (&self.state.session, &self.services);
        let mut cx = ShellContext::new(ctx, session, services, &mut self.messages);
        let done = act(&mut self.robot, &mut cx);
        self.deliver_all(self.state.session.workspace, ctx);
        done
    }

    fn deliver_all(&mut self, from: WorkspaceKind, ctx: &egui::Context) {
        for message in std::mem::take(&mut self.messages) {
            self.deliver(message, from, ctx);
        }
    }

    /// Handles a message of a workspace.
    fn deliver(&mut self, message: Message, from: WorkspaceKind, ctx: &egui::Context) {
        match message {
            Message::Notify(notice) => self.act(Action::Notify(notice), ctx),
            Message::Retract(notice) => self.state.notices.retain(|known| *known != notice),
            Message::RemoveNotices(topic) => remove_notices(&mut self.state, topic),
            Message::WithdrawUndo => {
                for notice in &mut self.state.notices {
                    if notice.kind == NoticeKind::Undoable(from) {
                        notice.kind = NoticeKind::Done;
                    }
                }
            }
            Message::CopyText(text) => ctx.copy_text(text),
            Message::UseSource(source) => self.state.session.source = source,
            Message::LibraryChanged { library, saved } => {
                self.state.library_changed(&library, saved);
            }
            Message::UseRecipe(recipe) => self.state.session.recipe = recipe,
            Message::UseCalibration(cell, robot) => {
                self.state.session.cell = cell;
                self.services.library_cache.use_robot(robot.clone());
                let before = self.state.session.rack.clone();
                self.state.session.use_robot(robot);
                let is_moved = self.state.session.rack.in_camera() != before.in_camera();
                if is_moved && self.state.session.shown.is_some() {
                    self.state.inspect_again();
                }
            }
            Message::UseAnswering(setup) => {
                let session = &mut self.state.session;
                let was_on = std::mem::replace(&mut session.answering, setup).is_on;
                let can_follow = !session.is_live() && session.source.followed().is_some();
                if setup.is_on && !was_on && can_follow {
                    // Without frames no trigger could be answered.
                    self.act(Action::Live(LiveAction::Toggle), ctx);
                }
            }
            Message::UseProgramSetup(setup) => self.state.session.program = setup,
            Message::UseServoSettings(setup) => self.state.session.servo = setup,
            Message::Act(action) => self.act(action, ctx),
            Message::ShowPast(inspected) => self.state.show_past(inspected),
            Message::AskEngineer => {
                roles::ask_engineer(&mut self.state, Action::Make(Effect::EngineerIn(from)));
            }
            Message::InspectShown { title } => {
                self.state.inspect_shown(&title, ReinspectionPurpose::New);
            }
            Message::Inspect {
                title,
                job,
                purpose,
                hung,
                trace,
            } => self
                .state
                .inspect_again_as(title, job, purpose, hung, trace),
        }
    }

    /// The work shown in the top bar: that of the workspace in front, else any other.
    pub(super) fn work(&self) -> Option<Progress> {
        let of_hosted = |workspace: &dyn Workspace| {
            let running = workspace.running()?.clone();
            let cancel = Some(Action::Make(Effect::CancelTask(workspace.kind())));
            Some(Progress { running, cancel })
        };
        let own = self
            .hosted(self.state.session.workspace)
            .and_then(of_hosted);
        let inspector = || {
            let running = self.state.inspector.running()?.clone();
            let cancel = Some(Action::CancelInspection);
            Some(Progress { running, cancel })
        };
        own.or_else(inspector).or_else(|| {
            let mut all = self.workspaces.iter().map(Box::as_ref);
            let written = || {
                let mut all = self.workspaces.iter();
                let running = all.find_map(|workspace| workspace.writing())?.clone();
                Some(Progress {
                    running,
                    cancel: None,
                })
            };
            all.find_map(of_hosted).or_else(written)
        })
    }

    /// True while no work is running.
    pub fn is_idle(&self) -> bool {
        let mut all = self.workspaces.iter();
        let session = &self.state.session;
        let is_shell_idle = self.state.inspector.is_idle()
            && self.state.follower.is_idle()
            && self.state.shift_watch.is_idle()
            && self.state.rack_reading.running().is_none()
            && self.state.rack_saving.running().is_none()
            && self.robot.is_idle();
        is_shell_idle && all.all(|workspace| workspace.is_idle(session))
    }
}
