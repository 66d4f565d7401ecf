//! What `inspect --source --mqtt` publishes: the inspection of each part that the history keeps, and the camera's
//! status.

use std::time::Instant;

use clap::Args;

use super::mqtt::{ChosenBroker, MqttChoice, end_link, show_news};
use crate::cli::{
    calibrate::no_calibration,
    console::{Console, advised_error},
    numbers::NumbersChoice,
};
use capture::{FeedState, SkippedCapture, SourceSpec};
use geometry::error::Fault;
use inspection::library::{LibraryLoad, LibraryPlace};
use plant::mqtt::MqttLink;
use records::history::Traceability;
use robot::RobotFrame;
use serve::{CameraStatus, Found, InspectionRecorder, Problem, ServerSettings};
use station::{Inspected, NoFrame, PartFinder, camera_status};

/// Where `inspect` publishes.
#[derive(Debug, Args)]
pub(crate) struct PublishArgs {
    #[command(flatten)]
    mqtt: MqttChoice,
    #[command(flatten)]
    numbers: NumbersChoice,
}

impl PublishArgs {
    /// Refuses options that would be ignored.
    pub(crate) fn check(&self, source: Option<&SourceSpec>) -> anyhow::Result<()> {
        let is_wanted = self.mqtt.is_wanted();
        if is_wanted && source.is_none() {
            return Err(advised_error(
                "--mqtt needs --source",
                "Follow a camera, a recording or a folder, such as --source watch:DIR",
            ));
        }
        if !is_wanted && self.numbers != NumbersChoice::default() {
            return Err(advised_error(
                "--as, --transform and --number need --mqtt",
                "Leave them out, or give a broker with --mqtt",
            ));
        }
        Ok(())
    }
}

/// A broker, and the form of the published results.
pub(crate) struct ChosenPublisher {
    broker: ChosenBroker,
    finder: PartFinder,
}

impl ChosenPublisher {
    /// Returns the chosen publisher, if any.
    pub(crate) fn new(
        args: &PublishArgs,
        place: &LibraryPlace,
        load: &LibraryLoad,
        robot: Option<&RobotFrame>,
        console: &Console,
    ) -> anyhow::Result<Option<Self>> {
        let Some(broker) = args.mqtt.access(args.numbers.convention)? else {
            return Ok(None);
        };
        let Some(robot) = robot else {
            return Err(no_calibration("--mqtt"));
        };
        let finder = PartFinder {
            parts: args.numbers.parts(place, load, console)?,
            robot: robot.clone(),
            kind: args.numbers.kind(),
        };
        Ok(Some(Self { broker, finder }))
    }

    /// Connects without waiting for the broker.
    pub(crate) fn start(
        self,
        load: &LibraryLoad,
        trace: &Traceability,
        console: &Console,
    ) -> anyhow::Result<Publisher> {
        let Self { broker, finder } = self;
        let recorder = InspectionRecorder::new(ServerSettings::default().max_age);
        let link = broker.start(recorder.boot(), finder.kind, load, console)?;
        Ok(Publisher {
            link,
            finder,
            trace: trace.clone(),
            recorder,
            camera: CameraStatus::default(),
        })
    }
}

/// Publishes inspections as a server does.
pub(crate) struct Publisher {
    link: MqttLink,
    finder: PartFinder,
    trace: Traceability,
    recorder: InspectionRecorder,
    camera: CameraStatus,
}

impl Publisher {
    /// Publishes changes of the camera's status, and shows events of the connection.
    pub(crate) fn look(&mut self, state: &FeedState, console: &Console) {
        self.camera = camera_status(state);
        self.link.set_camera(self.camera.clone());
        show_news(&self.link, console);
    }

    /// Returns the result of inspecting a frame of this time.
    pub(crate) fn found(&self, inspected: &Inspected<'_>, captured: Instant) -> Found {
        self.finder.found(inspected, captured)
    }

    /// Publishes an inspection.
    pub(crate) fn publish(&mut self, found: Found) {
        let records = self.recorder.record(found.into(), self.camera.clone());
        for record in records {
            self.link.inspected(record, &self.trace);
        }
    }

    /// Publishes that something could not be read.
    pub(crate) fn skipped(&mut self, skipped: &SkippedCapture) {
        let why = NoFrame::Unreadable(skipped.clone());
        self.publish(Found::error((&why).into()));
    }

    /// Publishes that the program failed at a frame.
    pub(crate) fn failed(&mut self, fault: &Fault) {
        self.publish(Found::error(Problem::of("fault", fault)));
    }

    /// Sends what is queued, for a few seconds at most, and disconnects.
    pub(crate) fn end(self, console: &Console) {
        show_news(&self.link, console);
        end_link(self.link, console);
    }
}
