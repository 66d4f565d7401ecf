//! The plant's database of histories, as command line options.

use std::path::PathBuf;

use clap::Args;

use crate::cli::console::{Advised as _, Console, advised_error, with_advice};
use plant::database::{self, CellName, DatabaseAccess, DatabaseAddress, SendNews};
use records::history::HistoryEvent;

/// What lets the program in.
#[derive(Clone, Debug, Args)]
pub(super) struct DatabaseFiles {
    /// File whose first line is the user's password for the database
    #[arg(long, value_name = "FILE")]
    database_password_file: Option<PathBuf>,
    /// PEM file with the certificates of the authority that signed the database server's; default: the system's own
    #[arg(long, value_name = "FILE")]
    database_ca: Option<PathBuf>,
}

impl DatabaseFiles {
    /// Creates the access to a database at this address; reads password and certificates.
    pub(super) fn access(
        &self,
        address: &str,
        console: &Console,
    ) -> anyhow::Result<DatabaseAccess> {
        // Not parsed by clap, whose message would show a password contained in it.
        let address = address.parse::<DatabaseAddress>().advised()?;
        let password = self.database_password_file.as_deref();
        let access = DatabaseAccess::new(address, password, self.database_ca.as_deref());
        let access = access.advised()?;
        if let Some(doubt) = access.doubt() {
            console.warn(&doubt, &doubt);
        }
        Ok(access)
    }

    /// Refuses the files if no database is named.
    pub(super) fn refuse_without(&self, option: &str) -> anyhow::Result<()> {
        if self.database_password_file.is_some() || self.database_ca.is_some() {
            return Err(advised_error(
                "--database-password-file and --database-ca are for a database, but none is given",
                format!("Give it with {option}, or leave them out"),
            ));
        }
        Ok(())
    }
}

/// Parses a cell's name for clap.
pub(super) fn parse_cell(text: &str) -> Result<CellName, String> {
    text.parse::<CellName>()
        .map_err(|error| with_advice(&error))
}

/// Where the history is sent while it is written.
#[derive(Clone, Debug, Args)]
pub(crate) struct HistoryToChoice {
    /// Also send the history to this PostgreSQL database, under the name given by --cell; inspections do not wait for
    /// it
    #[arg(
        long,
        value_name = "postgres://USER@HOST[:PORT]/DATABASE",
        requires = "cell",
        conflicts_with = "no_history"
    )]
    history_to: Option<String>,
    /// The name of this cell in the database
    #[arg(long, value_name = "NAME", requires = "history_to", value_parser = parse_cell)]
    cell: Option<CellName>,
    #[command(flatten)]
    files: DatabaseFiles,
}

/// A database to which the history is sent.
pub(crate) struct ChosenDatabase {
    access: DatabaseAccess,
    cell: CellName,
}

impl HistoryToChoice {
    /// Returns the chosen database; reads password and certificates.
    pub(crate) fn chosen(&self, console: &Console) -> anyhow::Result<Option<ChosenDatabase>> {
        let Some((address, cell)) = self.history_to.as_ref().zip(self.cell.clone()) else {
            self.files.refuse_without("--history-to")?;
            return Ok(None);
        };
        let access = self.files.access(address, console)?;
        Ok(Some(ChosenDatabase { access, cell }))
    }
}

/// Sends the history to a database, on a thread of its own.
pub(crate) struct HistorySender(database::HistorySender);

impl HistorySender {
    /// Starts to send the history in this folder.
    pub(crate) fn start(
        folder: PathBuf,
        ChosenDatabase { access, cell }: ChosenDatabase,
    ) -> anyhow::Result<Self> {
        let sender = database::HistorySender::start(folder, access, cell);
        sender.advised().map(Self)
    }

    /// Shows what happened since the last call; passes the events of the history itself to `tell`.
    pub(crate) fn show_news(&self, console: &Console, tell: impl Fn(HistoryEvent, &Console)) {
        while let Some(news) = self.0.news() {
            match news {
                SendNews::Connected { num_waiting } => console.note(&format_args!(
                    "Database: connected; inspections waiting: {num_waiting}"
                )),
                SendNews::Failed(problem) => {
                    console.warn(&format_args!("Database: {problem}"), &problem);
                }
                SendNews::SetAside(aside) => tell(HistoryEvent::SetAside(aside), console),
            }
        }
    }

    /// Sends unsent rows for a few seconds at most, and shows the events until then.
    pub(crate) fn end(mut self, console: &Console, tell: impl Fn(HistoryEvent, &Console)) {
        let ended = self.0.end();
        self.show_news(console, tell);
        if let Err(unsent) = ended {
            console.warn(&format_args!("Database: {unsent}"), &unsent);
        }
    }
}
