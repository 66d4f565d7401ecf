//! The tables in PostgreSQL, and their migrations.

use super::{address::DatabaseAddress, client::Database, error::DatabaseError};

/// All migrations, in order; the version of a database is the number of those applied. Released ones never change.
const STEPS: [&str; 1] = [FIRST];

/// The current version.
const VERSION: i32 = STEPS.len() as i32;

/// Key of the advisory lock under which one program at a time changes the tables; `PsHi`, as in a history's file.
const LOCK: i64 = i64::from_be_bytes(*b"PsHi\0\0\0\x01");

/// The columns have the names they have in a history's file, preceded by cell and history. Those that identify a row (the
/// keys, `at` and `hung`) are not null; all others may be, because a row edited by hand must not stop the sending.
const FIRST: &str = "
    CREATE SCHEMA partsight;
    CREATE TABLE partsight.schema_version (
        version integer PRIMARY KEY,
        made timestamptz NOT NULL DEFAULT now()
    );
    CREATE TABLE partsight.cell (
        cell text PRIMARY KEY,
        history text NOT NULL,                       -- identity of the history that has the name now
        since timestamptz NOT NULL DEFAULT now(),
        sent timestamptz NOT NULL DEFAULT now()      -- when the cell sent something last
    );
    CREATE TABLE partsight.recipe (
        cell text NOT NULL REFERENCES partsight.cell,
        history text NOT NULL,
        identity text NOT NULL,
        json text,
        changed timestamptz NOT NULL DEFAULT now(),
        PRIMARY KEY (cell, history, identity)
    );
    CREATE TABLE partsight.inspection (
        cell text NOT NULL REFERENCES partsight.cell,
        history text NOT NULL,
        number bigint NOT NULL,
        at bigint NOT NULL,                          -- microseconds since 1970, UTC
        scene text,
        simulated_frame bigint,
        num_shots bigint,
        source text,
        simulated boolean,
        verdict text,
        part text,
        title text,
        score double precision,
        margin double precision,
        total_ms double precision,
        remark text,
        label text,
        frame_bytes bigint,                          -- of the frame that the cell keeps
        search text,
        hung text NOT NULL,
        parent bigint,
        serial text,
        job_order text,
        operator text,
        reason_kind text,
        robot_doubts text,
        motion_checked boolean,
        rack text,                                   -- name of the rack that it hung in
        time timestamptz GENERATED ALWAYS AS (to_timestamp(at / 1000000.0::double precision)) STORED,
        received timestamptz NOT NULL DEFAULT now(),
        changed timestamptz NOT NULL DEFAULT now(),
        PRIMARY KEY (cell, history, number)
    );
    CREATE TABLE partsight.detail (
        cell text NOT NULL,
        history text NOT NULL,
        number bigint NOT NULL,
        nearest text,
        refusal text,
        camera_from_part text,
        recipe text,
        recipe_name text,
        recipe_changed boolean,
        library text,
        program text,
        line text,
        thumbnail bytea,
        origin text,
        frame text,
        changed timestamptz NOT NULL DEFAULT now(),
        PRIMARY KEY (cell, history, number),
        FOREIGN KEY (cell, history, number) REFERENCES partsight.inspection ON DELETE CASCADE
    );
    CREATE INDEX listed ON partsight.inspection (at, cell, history, number);
    CREATE INDEX listed_of_cell ON partsight.inspection (cell, at, history, number);
    CREATE INDEX below ON partsight.inspection (cell, history, parent) WHERE parent IS NOT NULL;
    CREATE INDEX heads ON partsight.inspection (cell, verdict) WHERE parent IS NULL;";

/// Refuses tables of a version that this program does not know yet.
fn refuse_newer(found: i32, known: i32, database: &DatabaseAddress) -> Result<(), DatabaseError> {
    if found <= known {
        return Ok(());
    }
    let database = Box::new(database.clone());
    Err(DatabaseError::Newer {
        database,
        found,
        known,
    })
}

/// Refuses tables of any version but the known one. A user who may only read cannot migrate them.
fn refuse_other(found: i32, known: i32, database: &DatabaseAddress) -> Result<(), DatabaseError> {
    refuse_newer(found, known, database)?;
    if found == known {
        return Ok(());
    }
    let database = Box::new(database.clone());
    Err(match found {
        0 => DatabaseError::Empty { database },
        _ => DatabaseError::Older {
            database,
            found,
            known,
        },
    })
}

const MAKE_VERSION: &str = "INSERT INTO partsight.schema_version (version) VALUES ($1)";

impl Database {
    /// Reads the version of the tables; 0 if there are none.
    fn version(&self) -> Result<i32, DatabaseError> {
        // Asked of the tables of the system: to_regclass answers from a cache, which misses what another cell just made.
        let asked = "SELECT EXISTS (SELECT FROM pg_catalog.pg_tables
            WHERE schemaname = 'partsight' AND tablename = 'schema_version')";
        let row = self.link.wait(self.client.query_one(asked, &[]))?;
        if !self.read::<bool>(&row, 0)? {
            return Ok(0);
        }
        let asked = "SELECT coalesce(max(version), 0) FROM partsight.schema_version";
        let row = self.link.wait(self.client.query_one(asked, &[]))?;
        self.read(&row, 0)
    }

    /// Refuses tables that cannot be read as they are: missing, older or newer than this program.
    pub(super) fn check_version(&self) -> Result<(), DatabaseError> {
        refuse_other(self.version()?, VERSION, &self.link.address)
    }

    /// Migrates the tables to the current version in one transaction.
    pub(super) fn migrate(&mut self) -> Result<(), DatabaseError> {
        let found = self.version()?;
        refuse_newer(found, VERSION, &self.link.address)?;
        if found == VERSION {
            return Ok(());
        }
        // An early return ends the connection, which rolls the transaction back.
        self.run("BEGIN")?;
        let lock = "SELECT pg_advisory_xact_lock($1)";
        self.link.wait(self.client.query(lock, &[&LOCK]))?;
        // Another cell may have migrated in the meantime.
        let found = self.version()?;
        refuse_newer(found, VERSION, &self.link.address)?;
        for (version, step) in (1..).zip(STEPS).skip(found as usize) {
            self.run(step)?;
            self.link
                .wait(self.client.execute(MAKE_VERSION, &[&version]))?;
        }
        self.run("COMMIT")
    }

    pub(super) fn run(&self, statements: &str) -> Result<(), DatabaseError> {
        self.link.wait(self.client.batch_execute(statements))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::error::Advice as _;

    #[test]
    fn only_tables_of_the_known_version_are_read_and_older_ones_are_migrated() {
        let address: DatabaseAddress = "postgres://me@localhost/parts".parse().expect("an address");
        let read = |found| refuse_other(found, 3, &address);
        assert_eq!(read(3), Ok(()));
        let database = || Box::new(address.clone());
        let empty = DatabaseError::Empty {
            database: database(),
        };
        assert_eq!(read(0), Err(empty));
        for found in [1, 2] {
            let older = DatabaseError::Older {
                database: database(),
                found,
                known: 3,
            };
            assert!(older.advice().contains("history send"));
            assert_eq!(read(found), Err(older));
        }
        let newer = DatabaseError::Newer {
            database: database(),
            found: 4,
            known: 3,
        };
        assert_eq!(read(4), Err(newer.clone()));
        let migrated = [0, 1, 2, 3, 4].map(|found| refuse_newer(found, 3, &address));
        assert_eq!(migrated, [Ok(()), Ok(()), Ok(()), Ok(()), Err(newer)]);
    }
}
