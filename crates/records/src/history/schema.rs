//! The tables of the file.

use rusqlite::{Connection, TransactionBehavior};

/// The version that this program writes and reads. Files of development builds have lower ones and are set aside.
pub(super) const VERSION: u32 = 10;

/// Application id that distinguishes our files from those of other programs: `PsHi`.
pub(super) const APPLICATION: i32 = i32::from_be_bytes(*b"PsHi");

/// `inspection` holds the columns of lists and filters, `detail` the rest: a row of the first takes about 200 bytes, so
/// that scanning a hundred thousand stays fast. Neither holds sentences: who shows a row writes them in their language.
const TABLES: &str = "
    CREATE TABLE recipe (
        identity TEXT PRIMARY KEY,
        json TEXT NOT NULL
    ) WITHOUT ROWID;
    CREATE TABLE setting (
        name TEXT PRIMARY KEY,
        json TEXT NOT NULL
    ) WITHOUT ROWID;
    CREATE TABLE inspection (
        number INTEGER PRIMARY KEY AUTOINCREMENT,   -- never used again
        at INTEGER NOT NULL,                        -- microseconds since 1970, UTC
        scene TEXT NOT NULL,                        -- name of the file, the camera's frame or the scan; empty: simulated_frame
        simulated_frame INTEGER,                    -- number of a frame of the simulated cell
        num_shots INTEGER,                          -- of a scan
        source TEXT NOT NULL,
        simulated INTEGER NOT NULL,
        verdict TEXT NOT NULL,                      -- accepted, not_accepted, unknown, no_part
        part TEXT,                                  -- what it was recognised as, accepted or not
        title TEXT NOT NULL,                        -- title that the best match, named or not, had then; empty: none
        score REAL,
        margin REAL,
        total_ms REAL NOT NULL,
        remark TEXT NOT NULL DEFAULT '',
        label TEXT,                                 -- what it truly is, as JSON
        frame_bytes INTEGER,                        -- of the kept frame, if it is kept
        search TEXT NOT NULL,                       -- in lower case, what a filter's words are looked for in
        hung TEXT NOT NULL,                         -- the part as it hung there
        parent INTEGER REFERENCES inspection,       -- the one that stands for the part
        serial TEXT NOT NULL DEFAULT '',
        job_order TEXT NOT NULL DEFAULT '',         -- ORDER is a word of SQL
        operator TEXT NOT NULL DEFAULT '',
        reason_kind TEXT,                           -- the kind of refusal, here too so that statistics need not read detail
        robot_doubts TEXT NOT NULL DEFAULT '',      -- why no robot might act on the pose, words separated by blanks
        motion_checked INTEGER,                     -- 0: no other frame showed whether the part hung still
        rack TEXT                                   -- name of the rack that it hung in
    );
    CREATE TABLE detail (
        number INTEGER PRIMARY KEY REFERENCES inspection (number) ON DELETE CASCADE,
        nearest TEXT,                               -- the best guess, named or not
        refusal TEXT,                               -- Refusal as JSON, parts by their enrolled names
        camera_from_part TEXT,                      -- 16 numbers as JSON, row after row, metres
        recipe TEXT NOT NULL REFERENCES recipe (identity),
        recipe_name TEXT NOT NULL,
        recipe_changed INTEGER NOT NULL,            -- since it was saved under that name
        library TEXT NOT NULL,                      -- identity of the library
        program TEXT NOT NULL,                      -- version of the program
        line TEXT NOT NULL,                         -- as inspect --json writes it
        thumbnail BLOB,                             -- PNG
        origin TEXT,                                -- how the window can have the scene again
        frame TEXT                                  -- FrameRecord as JSON; LostFrame if it could not be written
    );
    CREATE TABLE servo_run (
        number INTEGER PRIMARY KEY AUTOINCREMENT,   -- never used again
        at INTEGER NOT NULL,                        -- microseconds since 1970, UTC
        part TEXT NOT NULL,
        title TEXT NOT NULL,                        -- of the part, then
        target TEXT NOT NULL,                       -- standard_position, camera_pose, path_start
        robot TEXT NOT NULL,                        -- protocol and address
        source TEXT NOT NULL,
        simulated INTEGER NOT NULL,
        stopped TEXT,                               -- StopReason as JSON; none: the target was reached
        error_m REAL,
        error_rad REAL,
        bounds_m REAL,
        bounds_rad REAL,
        approximate INTEGER NOT NULL,
        took_s REAL NOT NULL,
        num_looks INTEGER NOT NULL,
        speed_m_s REAL,                             -- none: the robot chose it
        tolerance_m REAL NOT NULL,
        tolerance_rad REAL NOT NULL,
        program TEXT NOT NULL,                      -- version of the program
        search TEXT NOT NULL                        -- in lower case, what a filter's words are looked for in
    );
    CREATE TABLE servo_curve (
        number INTEGER PRIMARY KEY REFERENCES servo_run (number) ON DELETE CASCADE,
        json TEXT NOT NULL                          -- list of ServoSample
    );
    -- Holds every column that a filter asks for, in the order of the list: no filter reads the rows themselves.
    CREATE INDEX listed ON inspection (parent, at, number, verdict, part, simulated, rack, search);
    -- The narrowest: how many there are is counted in it.
    CREATE INDEX counted ON inspection (parent, simulated);
    CREATE INDEX hung ON inspection (hung);
    CREATE INDEX kept ON inspection (at, frame_bytes) WHERE frame_bytes IS NOT NULL;";

/// Returns the version of a file; 0 before it has a table.
pub(super) fn version(file: &Connection) -> rusqlite::Result<u32> {
    file.pragma_query_value(None, "user_version", |row| row.get(0))
}

/// Creates the tables in a new file, completely or not at all; any other file is left as it is.
pub(super) fn create_tables(file: &mut Connection) -> rusqlite::Result<()> {
    if version(file)? > 0 {
        return Ok(());
    }
    let file = file.transaction_with_behavior(TransactionBehavior::Immediate)?;
    // Another program may have created them meanwhile.
    if version(&file)? == 0 {
        file.execute_batch(TABLES)?;
        file.pragma_update(None, "user_version", VERSION)?;
        file.pragma_update(None, "application_id", APPLICATION)?;
    }
    file.commit()
}
