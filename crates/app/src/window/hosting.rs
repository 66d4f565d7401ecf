//! The window's access to its workspaces through their trait: lends them the shell and carries out the actions that they send.

use std::any::Any;

use super::Window;
use records::history::HistoryBuffer;
use shell::{
    action::Action,
    cell::RobotCell,
    frame::bars::Progress,
    session::WorkspaceKind,
    workspace::{ShellContext, Workspace},
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

    /// Lends a workspace the shell, then carries out the actions that it sent.
    pub(super) fn lend<R>(
        &mut self,
        kind: WorkspaceKind,
        ctx: &egui::Context,
        act: impl FnOnce(&mut dyn Workspace, &mut ShellContext<'_>) -> R,
    ) -> Option<R> {
        let mut all = self.workspaces.iter_mut();
        let workspace = all.find(|workspace| workspace.kind() == kind)?;
        let (session, services) = (&self.state.session, &self.services);
        let mut cx = ShellContext::new(ctx, session, services, &mut self.sent);
        let done = act(workspace.as_mut(), &mut cx);
        self.carry_out_sent(ctx);
        Some(done)
    }

    /// Lends the robot's cell the shell, then carries out the actions that it sent.
    pub(super) fn with_robot<R>(
        &mut self,
        ctx: &egui::Context,
        act: impl FnOnce(&mut RobotCell, &mut ShellContext<'_>) -> R,
    ) -> R {
        let (session, services) = (&self.state.session, &self.services);
        let mut cx = ShellContext::new(ctx, session, services, &mut self.sent);
        let done = act(&mut self.robot, &mut cx);
        self.carry_out_sent(ctx);
        done
    }

    fn carry_out_sent(&mut self, ctx: &egui::Context) {
        for action in std::mem::take(&mut self.sent) {
            self.act(action, ctx);
        }
    }

    /// The work shown in the top bar: that of the workspace in front, else any other.
    pub(super) fn work(&self) -> Option<Progress> {
        let of_hosted = |workspace: &dyn Workspace| {
            let running = workspace.running()?.clone();
            let cancel = Some(Action::CancelTask(workspace.kind()));
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
            && self.state.report_writing.running().is_none()
            && self.robot.is_idle();
        is_shell_idle && all.all(|workspace| workspace.is_idle(session))
    }
}
