//! The connection to a database. Every call has a time limit, even if the server is silent.

use std::time::Duration;

use tokio::{
    runtime::{Builder, Runtime},
    time::timeout,
};
use tokio_postgres::{Client, NoTls};

use super::{access::DatabaseAccess, address::DatabaseAddress, error::DatabaseError};
use files::words_of;

/// Limit for connecting, including encryption and authentication.
const CONNECT_LIMIT: Duration = Duration::from_secs(20);
/// Limit for a statement; the server itself aborts it a little earlier.
const STATEMENT_LIMIT: Duration = Duration::from_mins(1);
/// Settings of the session. If a cell loses its network within a transaction, another sender of the same cell is blocked no
/// longer than this.
const SETTINGS: &str = "SET statement_timeout = '50s'; SET lock_timeout = '20s'; \
    SET idle_in_transaction_session_timeout = '60s'";

/// A database with the tables of histories. Works only during calls: its own runtime runs on the caller's thread.
pub struct Database {
    pub(super) link: Link,
    pub(super) client: Client,
}

/// Runs the client's futures with a time limit.
pub(super) struct Link {
    runtime: Runtime,
    pub(super) address: Box<DatabaseAddress>,
}

impl Link {
    /// Waits for the result of a statement.
    pub(super) fn wait<T>(
        &self,
        work: impl Future<Output = Result<T, tokio_postgres::Error>>,
    ) -> Result<T, DatabaseError> {
        self.wait_for(STATEMENT_LIMIT, work)
    }

    fn wait_for<T>(
        &self,
        limit: Duration,
        work: impl Future<Output = Result<T, tokio_postgres::Error>>,
    ) -> Result<T, DatabaseError> {
        match self.runtime.block_on(async { timeout(limit, work).await }) {
            Ok(done) => done.map_err(|error| DatabaseError::from_postgres(&error, &self.address)),
            Err(_elapsed) => Err(DatabaseError::Unreachable {
                database: self.address.clone(),
                cause: "it does not answer".into(),
            }),
        }
    }
}

impl Database {
    /// Connects, and creates the tables or migrates them to the current version where necessary.
    pub fn open(access: &DatabaseAccess) -> Result<Self, DatabaseError> {
        let mut database = Self::connect(access)?;
        database.migrate()?;
        Ok(database)
    }

    /// Connects for reading only; missing tables are an error.
    pub fn open_to_read(access: &DatabaseAccess) -> Result<Self, DatabaseError> {
        let database = Self::connect(access)?;
        database.check_version()?;
        Ok(database)
    }

    fn connect(access: &DatabaseAccess) -> Result<Self, DatabaseError> {
        let address = Box::new(access.address.clone());
        let runtime = Builder::new_current_thread().enable_all().build();
        let runtime = runtime.map_err(|error| DatabaseError::Unreachable {
            database: address.clone(),
            cause: words_of(&error),
        })?;
        let link = Link { runtime, address };
        let client = link.wait_for(CONNECT_LIMIT, Box::pin(connected(access)))?;
        let database = Self { link, client };
        let row = database
            .link
            .wait(database.client.query_one("SHOW server_encoding", &[]))?;
        let encoding: String = database.read(&row, 0)?;
        if encoding != "UTF8" {
            return Err(DatabaseError::Encoding {
                database: database.link.address.clone(),
                encoding,
            });
        }
        database.run(SETTINGS)?;
        Ok(database)
    }

    /// Reads a value of a row; a wrong type is an error.
    pub(super) fn read<'a, T: tokio_postgres::types::FromSql<'a>>(
        &self,
        row: &'a tokio_postgres::Row,
        index: usize,
    ) -> Result<T, DatabaseError> {
        let value = row.try_get(index);
        value.map_err(|error| DatabaseError::Failed {
            database: self.link.address.clone(),
            cause: format!("the tables of the history are not as they were made: {error}"),
        })
    }
}

/// Connects; the connection itself runs as a task of the runtime.
async fn connected(access: &DatabaseAccess) -> Result<Client, tokio_postgres::Error> {
    let config = access.config();
    // The connection's result is dropped: the next call fails with the same error.
    if let Some(tls) = &access.tls {
        let (client, connection) = config.connect(tls.clone()).await?;
        tokio::spawn(async move { drop(connection.await) });
        Ok(client)
    } else {
        let (client, connection) = config.connect(NoTls).await?;
        tokio::spawn(async move { drop(connection.await) });
        Ok(client)
    }
}
