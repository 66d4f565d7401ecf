//! Publishing verdicts and states over MQTT, as command line options.

use std::path::PathBuf;

use clap::Args;

use crate::cli::console::{Advised as _, Console, advised_error};
use inspection::library::LibraryLoad;
use plant::mqtt::{
    BrokerAccess, BrokerAddress, LibraryMessage, LinkNews, LinkSubject, MqttLink, PoseFormat,
};
use robot::Convention;
use serve::PoseKind;

/// Where verdicts and states are published.
#[derive(Clone, Debug, Args)]
pub(crate) struct MqttChoice {
    /// Publish every verdict and the state of the cell to this MQTT broker; poses in the convention of --as
    #[arg(long, value_name = "mqtt[s]://[USER@]HOST[:PORT]/PREFIX")]
    mqtt: Option<String>,
    /// File whose first line is the user's password for the broker
    #[arg(long, value_name = "FILE", requires = "mqtt")]
    mqtt_password_file: Option<PathBuf>,
    /// PEM file with the certificates of the authority that signed the broker's; default: the system's own
    #[arg(long, value_name = "FILE", requires = "mqtt")]
    mqtt_ca: Option<PathBuf>,
}

/// A broker to connect to.
pub(super) struct ChosenBroker {
    access: BrokerAccess,
    convention: Convention,
}

impl MqttChoice {
    /// Returns whether a broker is given.
    pub(super) fn is_wanted(&self) -> bool {
        self.mqtt.is_some()
    }

    /// Returns the broker, if given; reads password and certificates.
    pub(super) fn access(
        &self,
        convention: Option<Convention>,
    ) -> anyhow::Result<Option<ChosenBroker>> {
        let Some(address) = &self.mqtt else {
            return Ok(None);
        };
        // Not parsed by clap, whose message would show a password contained in it.
        let broker = address.parse::<BrokerAddress>().advised()?;
        let Some(convention) = convention else {
            return Err(advised_error(
                "--mqtt publishes poses, but no convention is chosen",
                "Choose one with --as; partsight report --conventions explains all of them",
            ));
        };
        let password = self.mqtt_password_file.as_deref();
        let access = BrokerAccess::new(broker, password, self.mqtt_ca.as_deref());
        Ok(Some(ChosenBroker {
            access: access.advised()?,
            convention,
        }))
    }
}

impl ChosenBroker {
    /// Starts the connection without waiting for the broker; `boot` is the boot number of this start.
    pub(super) fn start(
        &self,
        boot: u32,
        kind: PoseKind,
        load: &LibraryLoad,
        console: &Console,
    ) -> anyhow::Result<MqttLink> {
        if let Some(doubt) = self.access.doubt() {
            console.warn(&doubt, &doubt);
        }
        let subject = LinkSubject {
            boot,
            library: LibraryMessage::of(load),
            pose: PoseFormat {
                kind,
                convention: self.convention,
            },
        };
        MqttLink::start(&self.access, subject).advised()
    }
}

/// Shows the events of the connection.
pub(super) fn show_news(link: &MqttLink, console: &Console) {
    while let Some(news) = link.news() {
        match news {
            LinkNews::Connected {
                num_waiting,
                num_dropped,
            } => console.note(&format_args!(
                "MQTT: connected; inspections waiting: {num_waiting}, dropped since the start: {num_dropped}"
            )),
            LinkNews::Lost(problem) => console.warn(&format_args!("MQTT: {problem}"), &problem),
        }
    }
}

/// Sends what is queued, for a few seconds at most, and ends the connection.
pub(super) fn end_link(link: MqttLink, console: &Console) {
    if let Err(unsent) = link.end() {
        console.warn(&format_args!("MQTT: {unsent}"), &unsent);
    }
}
