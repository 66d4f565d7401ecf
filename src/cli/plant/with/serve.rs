//! What runs beside a server: HTTP, MQTT, and new versions of the library.

use super::{
    http::{self, HttpArgs},
    mqtt::{ChosenBroker, MqttChoice, end_link, show_news},
    take::{ChosenStore, LibraryTaker, TakeArgs, TakenLibrary},
};
use crate::cli::{console::Console, numbers::NumbersChoice};
use inspection::library::{LibraryLoad, LibraryPlace};
use plant::{
    http::{HttpServer, HttpSettings},
    mqtt::{LibraryMessage, MqttLink},
};
use records::history::Traceability;
use serve::{CameraStatus, InspectionRecord, Server};
use stages::reference::ReferenceParams;

/// What is to run beside a server.
pub(crate) struct ChosenServices<'a> {
    numbers: &'a NumbersChoice,
    http: Option<HttpSettings>,
    mqtt: Option<ChosenBroker>,
    store: Option<ChosenStore>,
}

impl<'a> ChosenServices<'a> {
    /// Checks the options, and reads the files that they name.
    pub(crate) fn new(
        numbers: &'a NumbersChoice,
        http: &HttpArgs,
        mqtt: &MqttChoice,
        take: &TakeArgs,
    ) -> anyhow::Result<Self> {
        Ok(Self {
            numbers,
            http: http.settings(numbers.convention)?,
            mqtt: mqtt.access(numbers.convention)?,
            store: take.chosen()?,
        })
    }

    /// Starts all of it beside a server with this library.
    pub(crate) fn start(
        self,
        server: &Server,
        place: &'a LibraryPlace,
        load: &LibraryLoad,
        params: ReferenceParams,
        console: &Console,
    ) -> anyhow::Result<Services<'a>> {
        let Self {
            numbers,
            http,
            mqtt,
            store,
        } = self;
        let kind = numbers.kind();
        let mqtt = mqtt.map(|mqtt| mqtt.start(server.boot(), kind, load, console));
        let taker =
            store.map(|store| LibraryTaker::start(store, place, params, numbers, server.handle()));
        Ok(Services {
            mqtt: mqtt.transpose()?,
            taker: taker.transpose()?,
            _http: http::start(http, server.handle(), console)?,
        })
    }
}

/// What runs beside a server.
pub(crate) struct Services<'a> {
    mqtt: Option<MqttLink>,
    taker: Option<LibraryTaker<'a>>,
    _http: Option<HttpServer>,
}

impl Services<'_> {
    /// Publishes an inspection with what it is traced by.
    pub(crate) fn inspected(&self, record: InspectionRecord, trace: &Traceability) {
        if let Some(mqtt) = &self.mqtt {
            mqtt.inspected(record, trace);
        }
    }

    /// Publishes the camera's status, and shows what happened since the last call.
    pub(crate) fn turn(&self, camera: CameraStatus, console: &Console) {
        if let Some(mqtt) = &self.mqtt {
            mqtt.set_camera(camera);
            show_news(mqtt, console);
        }
    }

    /// Returns a library to use from now on, if a new version was taken.
    pub(crate) fn taken_library(&mut self, console: &Console) -> Option<TakenLibrary> {
        let taken = self.taker.as_mut()?.taken(console)?;
        if let Some(mqtt) = &self.mqtt {
            mqtt.set_library(LibraryMessage::of(&taken.load));
        }
        Some(taken)
    }

    /// Sends what is queued, for a few seconds at most.
    pub(crate) fn end(self, console: &Console) {
        if let Some(mqtt) = self.mqtt {
            end_link(mqtt, console);
        }
    }
}
