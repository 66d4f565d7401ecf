//! The window as eframe drives it: fetch news, draw the last result, apply what was done.

use std::{io, path::PathBuf, sync::Arc, task::Poll};

use eframe::egui_wgpu::RenderState;
use egui::{CentralPanel, Frame, Ui};

use super::{
    action::{Action, Effect, apply},
    bars,
    dialog::FileDialog,
    inspect::InspectPanel,
    state::{State, ThemeChoice, Workspace},
    theme::Theme,
    viewport::{ViewError, ViewportGpu},
    work::{Inspected, Inspector, Request, Trouble},
    worker::Worker,
};

/// The window.
pub struct Window {
    state: State,
    worker: Worker<Request, Result<Arc<Inspected>, Trouble>>,
    dialog: Option<FileDialog>,
    installed: Option<ThemeChoice>,
    inspect: InspectPanel,
}

impl Window {
    /// Starts the thread and asks for the first frame. Without a `render_state` the 3-D view says so in words.
    pub fn new(
        ctx: &egui::Context,
        render_state: Option<&RenderState>,
        library: Option<PathBuf>,
    ) -> io::Result<Self> {
        Theme::install_fonts(ctx);
        let mut inspector = Inspector::new(library);
        let repaint = ctx.clone();
        let worker = Worker::start(
            move |request, watch| inspector.answer(request, watch),
            move || repaint.request_repaint(),
        )?;
        let gpu = render_state
            .map(ViewportGpu::of_window)
            .ok_or_else(|| ViewError::NoDevice {
                reason: "the window draws without one".into(),
            });
        let mut window = Self {
            state: State::default(),
            worker,
            dialog: None,
            installed: None,
            inspect: InspectPanel::new(gpu),
        };
        window.act(Action::Capture, ctx);
        Ok(window)
    }

    /// What the window knows.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Does what a person could cause.
    pub fn act(&mut self, action: Action, ctx: &egui::Context) {
        match apply(&mut self.state, action) {
            None => {}
            Some(Effect::Post {
                generation,
                request,
            }) => self.worker.request(generation, request),
            Some(Effect::CancelWork) => self.worker.cancel(),
            Some(Effect::ShowFileDialog) => {
                // One at a time: a second would hide behind the first.
                self.dialog.get_or_insert_with(|| FileDialog::open(ctx));
            }
            Some(Effect::CopyText(text)) => ctx.copy_text(text),
        }
    }

    fn install_theme(&mut self, ctx: &egui::Context) {
        if self.installed != Some(self.state.theme) {
            Theme::install(self.state.theme, ctx);
            self.installed = Some(self.state.theme);
        }
    }

    /// Files dropped onto the window: the first is opened.
    fn take_drops(&mut self, ctx: &egui::Context) {
        let dropped = ctx.input(|input| {
            let first = input.raw.dropped_files.first();
            first.map(|file| file.path().to_owned())
        });
        if let Some(path) = dropped {
            self.act(Action::Open(path), ctx);
        }
    }
}

impl eframe::App for Window {
    fn logic(&mut self, ctx: &egui::Context, _frame: &mut eframe::Frame) {
        self.install_theme(ctx);
        while let Some(news) = self.worker.try_next() {
            self.act(Action::Hear(news), ctx);
        }
        if let Some(Poll::Ready(closed)) = self.dialog.as_mut().map(FileDialog::poll) {
            self.dialog = None;
            if let Some(action) = closed {
                self.act(action, ctx);
            }
        }
        self.take_drops(ctx);
    }

    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        let theme = Theme::of(self.state.theme);
        let mut actions = Vec::new();
        bars::top_bar(ui, &self.state, theme, &mut actions);
        bars::notices(ui, &self.state, theme, &mut actions);
        bars::rail(ui, &self.state, theme, &mut actions);
        CentralPanel::default()
            .frame(Frame::new().fill(theme.canvas))
            .show(ui, |ui| match self.state.workspace {
                Workspace::Inspect => self.inspect.ui(ui, &self.state, theme, &mut actions),
            });
        bars::help(&ctx, &self.state, theme, &mut actions);
        bars::shortcuts(&ctx, self.inspect.view_has_focus(), &mut actions);
        for action in actions {
            self.act(action, &ctx);
        }
    }
}
