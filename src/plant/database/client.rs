//! The connection to a database. Every call ends within a time, also when the server is silent.

use std::time::Duration;

use tokio::{
    runtime::{Builder, Runtime},
    time::timeout,
};
use tokio_postgres::{Client, NoTls};

use super::{access::DatabaseAccess, address::DatabaseAddress, error::DatabaseError};
use crate::files::words_of;

/// Connecting takes no longer, encryption and password included.
const CONNECT_LIMIT: Duration = Duration::from_secs(20);
/// A statement takes no longer; the server itself gives it up a little earlier.
const STATEMENT_LIMIT: Duration = Duration::from_mins(1);
/// What the server is told. A cell whose network broke in the middle of a transaction holds up another sender of the
/// same cell no longer than that.
const SETTINGS: &str = "SET statement_timeout = '50s'; SET lock_timeout = '20s'; \
    SET idle_in_transaction_session_timeout = '60s'";

/// A database with the tables of histories. Works only while it is called: a runtime of its own runs on the caller's
/// thread.
pub struct Database {
    pub(super) link: Link,
    pub(super) client: Client,
}

/// What waits for the server.
pub(super) struct Link {
    runtime: Runtime,
    pub(super) address: Box<DatabaseAddress>,
}

impl Link {
    /// The result of a statement.
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
            Ok(done) => done.map_err(|error| DatabaseError::of(&error, &self.address)),
            Err(_elapsed) => Err(self.unreachable("it does not answer".into())),
        }
    }

    fn unreachable(&self, cause: String) -> DatabaseError {
        DatabaseError::Unreachable {
            database: self.address.clone(),
            cause,
        }
    }
}

impl Database {
    /// Connects, and makes the tables or brings them to the version of today where they are not.
    pub fn open(access: &DatabaseAccess) -> Result<Self, DatabaseError> {
        let mut database = Self::connect(access)?;
        database.migrate()?;
        Ok(database)
    }

    /// Connects to look at it alone; tables that are not there are an error.
    pub fn open_to_read(access: &DatabaseAccess) -> Result<Self, DatabaseError> {
        let database = Self::connect(access)?;
        database.check_version()?;
        Ok(database)
    }

    fn connect(access: &DatabaseAccess) -> Result<Self, DatabaseError> {
        let address = Box::new(access.address.clone());
        let runtime = match Builder::new_current_thread().enable_all().build() {
            Ok(runtime) => runtime,
            Err(error) => {
                return Err(DatabaseError::Unreachable {
                    database: address,
                    cause: words_of(&error),
                });
            }
        };
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
        database
            .link
            .wait(database.client.batch_execute(SETTINGS))?;
        Ok(database)
    }

    /// A value of a row; another type than it should have is an error.
    pub(super) fn read<'a, T: tokio_postgres::types::FromSql<'a>>(
        &self,
        row: &'a tokio_postgres::Row,
        place: usize,
    ) -> Result<T, DatabaseError> {
        let value = row.try_get(place);
        value.map_err(|error| DatabaseError::Failed {
            database: self.link.address.clone(),
            cause: format!("the tables of the history are not as they were made: {error}"),
        })
    }
}

/// A client, whose connection is a task of the runtime.
async fn connected(access: &DatabaseAccess) -> Result<Client, tokio_postgres::Error> {
    let config = access.config();
    // What ends a connection is an error of the next call as well.
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
