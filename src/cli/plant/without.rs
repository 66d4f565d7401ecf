//! No interfaces of a plant: no options, no subcommands, and nothing that could run.

use std::{path::PathBuf, time::Instant};

use clap::{ArgMatches, Args, Command, FromArgMatches, Subcommand, error::ErrorKind};

use crate::cli::{
    LibraryChoice, Outcome,
    console::{Console, advised_error},
    history,
    numbers::NumbersChoice,
    report::Schema,
};
use capture::{FeedState, SkippedCapture, SourceSpec};
use geometry::error::Fault;
use inspection::library::{LibraryLoad, LibraryPlace};
use records::history::{History, HistoryEvent, Traceability};
use robot::RobotFrame;
use serve::{CameraStatus, Found, InspectionRecord, Server};
use stages::reference::ReferenceParams;
use station::{Inspected, NumberedPart};

/// Schemas of `report --schema`.
pub(crate) const SCHEMAS: &[Schema] = &[];

/// Subcommands that do not exist.
#[derive(Debug)]
pub(crate) enum NoCommand {}

pub(crate) use NoCommand as LibraryCommand;
pub(crate) use NoCommand as HistoryCommand;

impl FromArgMatches for NoCommand {
    fn from_arg_matches(_: &ArgMatches) -> Result<Self, clap::Error> {
        Err(clap::Error::new(ErrorKind::InvalidSubcommand))
    }

    fn update_from_arg_matches(&mut self, _: &ArgMatches) -> Result<(), clap::Error> {
        match *self {}
    }
}

impl Subcommand for NoCommand {
    fn augment_subcommands(command: Command) -> Command {
        command
    }

    fn augment_subcommands_for_update(command: Command) -> Command {
        command
    }

    fn has_subcommand(_: &str) -> bool {
        false
    }
}

pub(crate) fn library(
    command: &LibraryCommand,
    _: &LibraryChoice,
    _: &mut Console,
) -> anyhow::Result<Outcome> {
    match *command {}
}

pub(crate) fn history(
    command: &HistoryCommand,
    _: &mut History,
    _: &Console,
) -> anyhow::Result<Outcome> {
    match *command {}
}

#[derive(Debug, Args)]
pub(crate) struct FromChoice {}

pub(crate) fn overview(_: &history::Command, _: &mut Console) -> anyhow::Result<Option<Outcome>> {
    Ok(None)
}

pub(crate) fn taken_version(_: &LibraryPlace, _: &Console) -> Option<String> {
    None
}

#[cfg(feature = "window")]
pub(crate) fn version_of(
    _: &LibraryPlace,
) -> Result<Option<inspection::library::TakenVersion>, [String; 2]> {
    Ok(None)
}

#[derive(Clone, Debug, Args)]
pub(crate) struct HistoryToChoice {}

impl HistoryToChoice {
    pub(crate) fn chosen(&self, _: &Console) -> anyhow::Result<Option<ChosenDatabase>> {
        Ok(None)
    }
}

pub(crate) enum ChosenDatabase {}

pub(crate) enum HistorySender {}

impl HistorySender {
    pub(crate) fn start(_: PathBuf, database: ChosenDatabase) -> anyhow::Result<Self> {
        match database {}
    }

    pub(crate) fn show_news(&self, _: &Console, _: impl Fn(HistoryEvent, &Console)) {
        match *self {}
    }

    pub(crate) fn end(self, _: &Console, _: impl Fn(HistoryEvent, &Console)) {
        match self {}
    }
}

#[derive(Debug, Args)]
pub(crate) struct PublishArgs {}

impl PublishArgs {
    pub(crate) fn check(&self, _: Option<&SourceSpec>) -> anyhow::Result<()> {
        Ok(())
    }
}

pub(crate) enum ChosenPublisher {}

impl ChosenPublisher {
    pub(crate) fn new(
        _: &PublishArgs,
        _: &LibraryPlace,
        _: &LibraryLoad,
        _: Option<&RobotFrame>,
        _: &Console,
    ) -> anyhow::Result<Option<Self>> {
        Ok(None)
    }

    pub(crate) fn start(
        self,
        _: &LibraryLoad,
        _: &Traceability,
        _: &Console,
    ) -> anyhow::Result<Publisher> {
        match self {}
    }
}

pub(crate) enum Publisher {}

impl Publisher {
    pub(crate) fn look(&mut self, _: &FeedState, _: &Console) {
        match *self {}
    }

    pub(crate) fn found(&self, _: &Inspected<'_>, _: Instant) -> Found {
        match *self {}
    }

    pub(crate) fn publish(&mut self, _: Found) {
        match *self {}
    }

    pub(crate) fn skipped(&mut self, _: &SkippedCapture) {
        match *self {}
    }

    pub(crate) fn failed(&mut self, _: &Fault) {
        match *self {}
    }

    pub(crate) fn end(self, _: &Console) {
        match self {}
    }
}

#[derive(Debug, Args)]
pub(crate) struct HttpArgs {
    /// Needs a build with the feature plant
    #[arg(long, value_name = "[IP:]PORT", hide = true)]
    http: Option<String>,
}

impl HttpArgs {
    pub(crate) fn is_wanted(&self) -> bool {
        self.http.is_some()
    }
}

#[derive(Clone, Debug, Args)]
pub(crate) struct MqttChoice {}

#[derive(Debug, Args)]
pub(crate) struct TakeArgs {}

pub(crate) struct TakenLibrary {
    pub(crate) load: LibraryLoad,
    pub(crate) parts: Vec<NumberedPart>,
}

pub(crate) struct ChosenServices;

impl ChosenServices {
    pub(crate) fn new(
        _: &NumbersChoice,
        http: &HttpArgs,
        _: &MqttChoice,
        _: &TakeArgs,
    ) -> anyhow::Result<Self> {
        if http.is_wanted() {
            return Err(advised_error(
                "this build has no HTTP",
                "Build it with the feature plant: cargo build --release -p partsight --features plant",
            ));
        }
        Ok(Self)
    }

    pub(crate) fn start<'a>(
        self,
        _: &Server,
        _: &'a LibraryPlace,
        _: &LibraryLoad,
        _: ReferenceParams,
        _: &Console,
    ) -> anyhow::Result<Services<'a>> {
        Ok(Services(std::marker::PhantomData))
    }
}

pub(crate) struct Services<'a>(std::marker::PhantomData<&'a LibraryPlace>);

impl Services<'_> {
    pub(crate) fn inspected(&self, _: InspectionRecord, _: &Traceability) {}

    pub(crate) fn turn(&self, _: CameraStatus, _: &Console) {}

    pub(crate) fn taken_library(&mut self, _: &Console) -> Option<TakenLibrary> {
        None
    }

    pub(crate) fn end(self, _: &Console) {}
}
