//! Errors of a database, with advice.

use std::{error::Error as _, io};

use thiserror::Error;
use tokio_postgres::error::SqlState;

use super::{address::DatabaseAddress, cell::CellName};
use files::words_of;
use geometry::error::{Advice, Fault};
use records::history::HistoryError;

/// Why the plant's database cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Error, Advice)]
pub enum DatabaseError {
    /// The server does not answer, or the connection was lost.
    #[error("{database} cannot be reached: {cause}")]
    #[advice = "Check the server and the network. Cells go on inspecting; what is not sent yet stays in their own histories"]
    Unreachable {
        /// The database.
        database: Box<DatabaseAddress>,
        /// The system's or the server's message.
        cause: String,
    },
    /// The server refuses the login.
    #[error("{database} refuses the connection: {cause}")]
    #[advice = "Check the user in the address, --database-password-file, and what the server's pg_hba.conf allows"]
    Refused {
        /// The database.
        database: Box<DatabaseAddress>,
        /// The server's message.
        cause: String,
    },
    /// The server has no such database.
    #[error("{database}: there is no such database")]
    #[advice("Create it once: CREATE DATABASE \"{}\" ENCODING 'UTF8' TEMPLATE template0", database.name)]
    NotFound {
        /// The database.
        database: Box<DatabaseAddress>,
    },
    /// The encrypted connection cannot be established.
    #[error("no encrypted connection to {database}: {cause}")]
    #[advice(if cause.contains("does not support TLS") {
        "Turn on ssl at the server, or end the address in ?sslmode=disable if nobody else can listen on this network"
    } else {
        "Check that the address names the host in the server's certificate, and --database-ca the authority that signed it"
    })]
    Tls {
        /// The database.
        database: Box<DatabaseAddress>,
        /// The TLS library's message.
        cause: String,
    },
    /// The user lacks a privilege.
    #[error("{database}: the user may not read or write the history there: {cause}")]
    #[advice("Have the database's owner send once, or grant this user what it needs: GRANT CREATE ON DATABASE \"{}\", or USAGE on the schema partsight and SELECT, INSERT, UPDATE on its tables", database.name)]
    Forbidden {
        /// The database.
        database: Box<DatabaseAddress>,
        /// The server's message.
        cause: String,
    },
    /// The database's encoding cannot store every text.
    #[error("{database} stores text as {encoding}, which cannot represent every name")]
    #[advice = "Use a database that was created with ENCODING 'UTF8'"]
    Encoding {
        /// The database.
        database: Box<DatabaseAddress>,
        /// The encoding, as the server names it.
        encoding: String,
    },
    /// A newer version of the program created the tables; they were not touched.
    #[error(
        "{database}: the history there is kept by a newer version of Partsight (format {found}, this one knows {known})"
    )]
    #[advice = "Update Partsight on this computer"]
    Newer {
        /// The database.
        database: Box<DatabaseAddress>,
        /// Version of its tables.
        found: i32,
        /// Newest version known to this program.
        known: i32,
    },
    /// An older version of the program created the tables, and nothing has migrated them yet.
    #[error(
        "{database}: the tables there are of an older version of Partsight (format {found}; this version needs {known})"
    )]
    #[advice = "Let a cell with this version send once as the user who owns the tables, which upgrades them: partsight history send --to \
               ADDRESS --cell NAME. Older versions cannot use them from then on"]
    Older {
        /// The database.
        database: Box<DatabaseAddress>,
        /// Version of its tables.
        found: i32,
        /// Version that this program reads.
        known: i32,
    },
    /// No cell has sent anything yet.
    #[error("{database}: there is no history yet")]
    #[advice = "Send a history there first: partsight history send --to ADDRESS --cell NAME"]
    Empty {
        /// The database.
        database: Box<DatabaseAddress>,
    },
    /// There is no cell of that name.
    #[error("{database}: there is no cell {:?}", cell.as_str())]
    #[advice("Give one of {}", known.join(", "))]
    NoSuchCell {
        /// The database.
        database: Box<DatabaseAddress>,
        /// The name.
        cell: CellName,
        /// Names of the existing cells.
        known: Vec<String>,
    },
    /// The cell's name belongs to another history.
    #[error("{database}: the cell {:?} belongs to another history", cell.as_str())]
    #[advice = "Give each cell a name of its own with --cell; if this history replaces the other one, whose computer or disk is gone, send it once with --take-over"]
    Taken {
        /// The database.
        database: Box<DatabaseAddress>,
        /// The name.
        cell: CellName,
    },
    /// The history was copied or restored from a backup, and both copies went on independently.
    #[error(
        "{database}: the cell {:?} has other inspections under the numbers of this history: one is a copy of the other",
        cell.as_str()
    )]
    #[advice = "Send this history under another name with --cell; each keeps its own inspections"]
    Copied {
        /// The database.
        database: Box<DatabaseAddress>,
        /// The cell's name.
        cell: CellName,
    },
    /// The server reports any other error.
    #[error("{database}: {cause}")]
    #[advice = "Check the log of the database's server; what is not sent stays in the history here"]
    Failed {
        /// The database.
        database: Box<DatabaseAddress>,
        /// The server's message.
        cause: String,
    },
}

impl DatabaseError {
    pub(super) fn from_postgres(error: &tokio_postgres::Error, database: &DatabaseAddress) -> Self {
        let database = Box::new(database.clone());
        let Some(reported) = error.as_db_error() else {
            return Self::of_connection(error, database);
        };
        let cause = reported.message().to_owned();
        match *reported.code() {
            SqlState::INVALID_PASSWORD | SqlState::INVALID_AUTHORIZATION_SPECIFICATION => {
                Self::Refused { database, cause }
            }
            SqlState::INVALID_CATALOG_NAME => Self::NotFound { database },
            SqlState::INSUFFICIENT_PRIVILEGE | SqlState::READ_ONLY_SQL_TRANSACTION => {
                Self::Forbidden { database, cause }
            }
            SqlState::ADMIN_SHUTDOWN
            | SqlState::CRASH_SHUTDOWN
            | SqlState::CANNOT_CONNECT_NOW
            | SqlState::TOO_MANY_CONNECTIONS => Self::Unreachable { database, cause },
            _ => Self::Failed { database, cause },
        }
    }

    /// Classifies an error that does not come from the server.
    fn of_connection(error: &tokio_postgres::Error, database: Box<DatabaseAddress>) -> Self {
        let what = error.to_string();
        let cause = match error.source() {
            Some(source) => source
                .downcast_ref::<io::Error>()
                .map_or_else(|| source.to_string(), words_of),
            None => what.clone(),
        };
        if what.contains("TLS") {
            Self::Tls { database, cause }
        } else if cause == "password missing" {
            let cause = "it asks for a password".into();
            Self::Refused { database, cause }
        } else if what.contains("authentication") {
            Self::Refused { database, cause }
        } else {
            Self::Unreachable { database, cause }
        }
    }
}

/// Why rows could not be sent or read.
#[derive(Debug, Error, Advice)]
pub enum TransferError {
    /// The database failed.
    #[error(transparent)]
    #[advice(transparent)]
    Database(#[from] DatabaseError),
    /// The local history could not be read or written.
    #[error(transparent)]
    #[advice(transparent)]
    History(#[from] HistoryError),
    /// The program itself failed.
    #[error(transparent)]
    #[advice(transparent)]
    Fault(#[from] Fault),
}
