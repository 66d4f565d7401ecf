//! The inspections of `partsight serve`: takes, inspects, shows and records frames.

use std::{
    ops::ControlFlow,
    sync::{Arc, mpsc::Receiver},
    time::Duration,
};

#[cfg(feature = "plant")]
use super::{
    show_numbers,
    take::{LibraryTaker, TakenLibrary},
};
#[cfg(feature = "plant")]
use crate::cli::{
    Outcome,
    console::{Console, advised_error},
    input::before,
    interrupt::Interrupt,
    mqtt::{end_link, show_news},
    output::OutputFormat,
    record::{HistoryRecorder, SceneOrigin},
};
use capture::{CaptureWarning, Captured, FeedState, Image};
use geometry::error::{Advice as _, guarded};
use inspection::{
    library::Library,
    pipeline::{self, Inspection, MirrorTally, NamedRecipe, Unwatched},
};
#[cfg(feature = "plant")]
use plant::mqtt::{LibraryMessage, MqttLink};
use records::{
    history::{HungId, Traceability},
    report::{CaptureLine, InspectionLine},
};
use serve::{
    Asked, Camera, ClientEvent, ClientNews, Found, InspectionRecord, Inspector, NoFrame,
    PartFinder, Trouble, VerdictCode,
};
use stages::{
    field_of_view::FieldOfView,
    reference::Reference,
    scene::{EmptyCell, SceneCloud, scene_from_image},
};

/// The inspections of a service, on the thread that runs its server.
pub(super) struct ServeSession<'a> {
    pub(super) camera: Arc<Camera>,
    pub(super) interrupt: Interrupt,
    pub(super) events: Receiver<ClientEvent>,
    pub(super) library: Library,
    pub(super) recipe: NamedRecipe,
    pub(super) finder: PartFinder,
    pub(super) trace: Traceability,
    pub(super) empty_cell: Option<Arc<EmptyCell>>,
    /// The camera's field of view as far as the frames have shown it.
    pub(super) known_view: Option<Arc<FieldOfView>>,
    pub(super) source: String,
    pub(super) frame_timeout: Duration,
    pub(super) format: OutputFormat,
    pub(super) recording: Option<HistoryRecorder>,
    pub(super) mirrored: MirrorTally,
    pub(super) console: &'a mut Console,
    /// The inspection that is being answered.
    pub(super) last: Option<InspectedFrame>,
    /// Warnings about the source that were already shown.
    pub(super) told: Vec<CaptureWarning>,
    /// The error of the camera that was shown last.
    pub(super) trouble: Option<String>,
    /// True once the camera has run.
    pub(super) has_run: bool,
    /// True once the warning about a closed standard output was shown.
    pub(super) has_told_closed: bool,
    /// Why the service must end.
    pub(super) failure: Option<anyhow::Error>,
    pub(super) num_inspected: u64,
    #[cfg(feature = "plant")]
    pub(super) mqtt: Option<MqttLink>,
    #[cfg(feature = "plant")]
    pub(super) taker: Option<LibraryTaker<'a>>,
}

/// An inspection to show and record.
pub(super) struct InspectedFrame {
    name: String,
    is_simulated: bool,
    scene: Arc<SceneCloud>,
    inspection: Inspection,
    /// JSON line of the inspection.
    line: String,
}

impl Inspector for ServeSession<'_> {
    fn inspect(&mut self, asked: &Asked) -> Found {
        let interrupt = &self.interrupt;
        let captured = (self.camera).frame_after(asked, self.frame_timeout, || interrupt.came());
        let captured = match captured {
            Ok(captured) => captured,
            Err(why) => return self.without_frame(&why),
        };
        self.warn_of(&captured);
        let mut origin = self.camera.origin_of(&captured);
        let num_dropped = self.camera.feed_status().num_dropped;
        let source = self.source.clone();
        let line = CaptureLine::of(&source, &captured, num_dropped);
        let name = captured.name;
        let scene = self.scene_of(captured.image, &name);
        let mut inspection =
            pipeline::run(&scene, &self.library, &self.recipe, &Unwatched).expect("not cancelled");
        let middle = inspection.best_reference(&self.library);
        let middle = middle.and_then(Reference::middle);
        let (camera, interrupt) = (Arc::clone(&self.camera), self.interrupt.clone());
        let frame_timeout = self.frame_timeout;
        let is_ending = || interrupt.came();
        let again = |later: Captured| {
            let scene = self.scene_of(later.image, &later.name);
            pipeline::run(&scene, &self.library, &self.recipe, &Unwatched).expect("not cancelled")
        };
        if let Err(why) = camera.refuse_if_moving(
            &mut origin,
            &mut inspection,
            middle,
            frame_timeout,
            is_ending,
            again,
        ) {
            return self.without_frame(&why);
        }
        let mut found = self.finder.found(&inspection, &self.recipe, origin);
        let line = InspectionLine::of(&name, &inspection)
            .by(&self.recipe)
            .traced(&self.trace)
            .captured(Some(line))
            .in_robot(Some(&self.finder.robot), &inspection)
            .to_json();
        found.report.clone_from(&line);
        self.last = Some(InspectedFrame {
            name,
            // Only the answer marks a replayed frame as well.
            is_simulated: captured.is_simulated,
            scene,
            inspection,
            line,
        });
        found
    }

    fn recorded(&mut self, record: InspectionRecord) {
        let answer = record.answer();
        if answer.verdict == VerdictCode::Error && matches!(self.format, OutputFormat::Json) {
            let Trouble { reason, message } = &answer.trouble;
            let line = InspectionLine::failed(&self.source, reason, message).traced(&self.trace);
            self.console.line(&line.to_json());
        }
        #[cfg(feature = "plant")]
        if let Some(mqtt) = &self.mqtt {
            mqtt.inspected(record);
        }
    }

    fn answered(&mut self) {
        let Some(last) = self.last.take() else {
            return;
        };
        if let Err(fault) = guarded(|| self.show(&last)) {
            self.console
                .warn(&format_args!("{}: {fault}", last.name), &fault);
        }
    }

    fn turn(&mut self) -> ControlFlow<()> {
        for event in self.events.try_iter() {
            show_event(&event, self.console);
        }
        self.look_at_camera();
        self.look_at_output();
        if let Some(recording) = &self.recording {
            recording.tell(self.console);
        }
        #[cfg(feature = "plant")]
        if let Some(mqtt) = &self.mqtt {
            mqtt.set_camera(self.camera.status());
            show_news(mqtt, self.console);
        }
        #[cfg(feature = "plant")]
        self.use_taken_library();
        if self.interrupt.came() || self.failure.is_some() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

impl ServeSession<'_> {
    /// The result of a trigger after which nothing can be inspected; shows why.
    fn without_frame(&self, why: &NoFrame) -> Found {
        self.console
            .advise(&format_args!("error: {why}"), &why.advice());
        Found::error(Trouble::of(why.reason(), why))
    }

    /// The scene to inspect of an image.
    fn scene_of(&mut self, image: Image, name: &str) -> Arc<SceneCloud> {
        let mut scene = scene_from_image(image);
        before(&mut scene, self.empty_cell.as_ref(), name, self.console);
        scene.set_known_view(self.known_view.clone());
        self.known_view = FieldOfView::remembered(self.known_view.take(), scene.field_of_view());
        Arc::new(scene)
    }

    fn warn_of(&mut self, captured: &Captured) {
        for warning in &captured.warnings {
            if warning.is_about_source() {
                if self.told.contains(warning) {
                    continue;
                }
                self.told.push(warning.clone());
            }
            self.console
                .warn(&format_args!("{}: {warning}", captured.name), warning);
        }
    }

    /// Shows an inspection and adds it to the history.
    fn show(&mut self, last: &InspectedFrame) {
        let InspectedFrame {
            name,
            is_simulated,
            scene,
            inspection,
            line,
        } = last;
        if self.num_inspected == 0 && *is_simulated {
            self.console.note(&"Simulated: no camera is read.");
        }
        self.num_inspected += 1;
        self.mirrored.add(&inspection.verdict);
        self.format
            .inspected(name, line, inspection, &self.library, self.console);
        if let Some(recording) = &mut self.recording {
            let taken = SceneOrigin {
                scene: name,
                source: &self.source,
                is_simulated: *is_simulated,
            };
            // Only the client knows whether it is the same part again.
            let entry = recording.entry(taken, scene, inspection, line, HungId::new());
            recording.add(entry, self.console);
        }
    }

    /// Uses a version of the library that was taken meanwhile.
    #[cfg(feature = "plant")]
    fn use_taken_library(&mut self) {
        let taker = self.taker.as_mut();
        let Some(taken) = taker.and_then(|taker| taker.taken(self.console)) else {
            return;
        };
        let TakenLibrary { load, parts } = taken;
        show_numbers(&parts, &load, self.console);
        if let Some(recording) = &mut self.recording {
            recording.use_library(&load);
        }
        if let Some(mqtt) = &self.mqtt {
            mqtt.set_library(LibraryMessage::of(&load));
        }
        self.finder.parts = parts;
        self.library = load.library;
    }

    /// Reports each cause of a missing camera once, and when the camera is back. A camera that fails before it ever ran
    /// ends the service.
    fn look_at_camera(&mut self) {
        let (error, is_failed) = match self.camera.feed_status().state {
            FeedState::Running => {
                self.has_run = true;
                if self.trouble.take().is_some() {
                    self.console.note(&"The camera is back");
                }
                return;
            }
            FeedState::Lost { error } => (error, false),
            FeedState::Failed(error) => (error, true),
            FeedState::Opening | FeedState::Ended | FeedState::Stopped => return,
        };
        let words = error.to_string();
        if is_failed && !self.has_run {
            self.failure = Some(advised_error(words, error.advice()));
            return;
        }
        if self.trouble.as_ref() != Some(&words) {
            self.console.warn(&words, &*error);
            self.trouble = Some(words);
        }
    }

    /// Warns once that standard output was closed. A closed pipe cannot be reopened, so no line is tried again.
    fn look_at_output(&mut self) {
        if !self.has_told_closed && !self.console.is_read() {
            self.has_told_closed = true;
            self.console.advise(
                &"warning: the reader of the standard output has closed it; the service goes on without it",
                &"Check the program that reads it, then start the service again together with it",
            );
        }
    }

    /// Writes what is left. Returns why the service had to end, if it had to.
    pub(super) fn finish(self) -> anyhow::Result<Outcome> {
        let console = self.console;
        if let Some(suspicion) = self.mirrored.suspicion() {
            console.warn(&suspicion, &suspicion);
        }
        // Before the MQTT link, which may wait for the broker.
        if let Some(recording) = self.recording {
            recording.finish(console);
        }
        #[cfg(feature = "plant")]
        if let Some(mqtt) = self.mqtt {
            end_link(mqtt, console);
        }
        if let Some(error) = self.failure {
            return Err(error);
        }
        console.note(&format_args!("{} inspected", self.num_inspected));
        Ok(Outcome::Accepted)
    }
}

fn show_event(event: &ClientEvent, console: &Console) {
    let (peer, protocol) = (event.peer, event.protocol);
    match &event.news {
        ClientNews::Connected => console.note(&format_args!("{peer} connected: {protocol}")),
        ClientNews::Left => console.note(&format_args!("{peer} left")),
        ClientNews::TurnedAway => console.advise(
            &format_args!(
                "warning: {peer} was refused: the maximum number of clients is connected"
            ),
            &"Close a connection that is not used, or raise --max-clients",
        ),
        ClientNews::BadRequest(why) => {
            console.warn(
                &format_args!("{peer}: {why}; the connection was closed"),
                why,
            );
        }
        ClientNews::WrongToken => console.advise(
            &format_args!("warning: {peer} sent no token or a wrong one: {protocol}"),
            &"Give the client a token of --http-token-file; if you do not know the client, find out who it is",
        ),
    }
}
