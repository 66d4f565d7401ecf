//! HTTP, MQTT, PostgreSQL, and one library for many cells.

mod bundle;
mod database;
mod history;
mod http;
mod mqtt;
mod publish;
mod serve;
mod take;

pub(crate) use self::{
    bundle::{LibraryCommand, run as library, taken_version, version_of},
    database::{ChosenDatabase, HistorySender, HistoryToChoice},
    history::{FromChoice, HistoryCommand, overview, run as history},
    http::HttpArgs,
    mqtt::MqttChoice,
    publish::{ChosenPublisher, PublishArgs, Publisher},
    serve::{ChosenServices, Services},
    take::{TakeArgs, TakenLibrary},
};
use crate::cli::report::Schema;

/// Schemas of `report --schema`.
pub(crate) const SCHEMAS: &[Schema] = &[Schema {
    name: "mqtt",
    help: "The messages of serve --mqtt",
    json: plant::mqtt::messages_schema,
}];
