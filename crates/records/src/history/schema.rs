//! The tables, and the migration of older files.

use rusqlite::{Connection, Transaction, TransactionBehavior};

/// A step from one version to the next.
type Migration = fn(&Transaction<'_>) -> rusqlite::Result<()>;

/// All steps in order; the version of a file is the number of steps applied to it.
const STEPS: [Migration; 5] = [first, parts, recipe_names, traceability, refusals];

/// The version that this program writes.
pub(super) const VERSION: u32 = STEPS.len() as u32;

/// First version in which inspections of the same hung part belong together; older files are never listed unmigrated.
pub(super) const WITH_PARTS: u32 = 2;

/// First version in which recipes have names.
pub(super) const WITH_RECIPE_NAMES: u32 = 3;

/// First version in which inspections have serial numbers.
pub(super) const WITH_TRACEABILITY: u32 = 4;

/// First version in which refusals have a kind and figures besides the English sentence.
pub(super) const WITH_REFUSALS: u32 = 5;

/// Application id that distinguishes our files from those of other programs: `PsHi`.
pub(super) const APPLICATION: i32 = i32::from_be_bytes(*b"PsHi");

/// `inspection` holds the columns of lists and filters, `detail` the rest: a row of the first takes about 200 bytes, so
/// that scanning a hundred thousand stays fast.
fn first(file: &Transaction<'_>) -> rusqlite::Result<()> {
    file.execute_batch(
        "CREATE TABLE recipe (
            identity TEXT PRIMARY KEY,
            json TEXT NOT NULL
        ) WITHOUT ROWID;
        CREATE TABLE setting (
            name TEXT PRIMARY KEY,
            json TEXT NOT NULL
        ) WITHOUT ROWID;
        CREATE TABLE inspection (
            number INTEGER PRIMARY KEY AUTOINCREMENT, -- never used again
            at INTEGER NOT NULL,                      -- microseconds since 1970, UTC
            scene TEXT NOT NULL,
            source TEXT NOT NULL,
            simulated INTEGER NOT NULL,
            verdict TEXT NOT NULL,                    -- accepted, not_accepted, unknown, no_part
            part TEXT,                                -- what it was recognised as, accepted or not
            title TEXT NOT NULL,                      -- the same for people
            score REAL,
            margin REAL,
            total_ms REAL NOT NULL,
            remark TEXT NOT NULL DEFAULT '',
            label TEXT,                               -- what it truly is, as JSON
            frame_bytes INTEGER,                      -- of the kept frame, if it is kept
            search TEXT NOT NULL                      -- in lower case, what a filter's words are looked for in
        );
        CREATE TABLE detail (
            number INTEGER PRIMARY KEY REFERENCES inspection (number) ON DELETE CASCADE,
            nearest TEXT,                             -- the best guess, named or not
            reason TEXT,
            advice TEXT,
            camera_from_part TEXT,                    -- 16 numbers as JSON, row after row, metres
            recipe TEXT NOT NULL REFERENCES recipe (identity),
            library TEXT NOT NULL,                    -- identity of the library
            program TEXT NOT NULL,                    -- version of the program
            line TEXT NOT NULL,                       -- as inspect --json writes it
            thumbnail BLOB,                           -- PNG
            origin TEXT,                              -- how the window can have the scene again
            frame TEXT                                -- FrameRecord as JSON
        );
        -- Holds every column that a filter asks for, in the order of the list: no filter reads the rows themselves.
        CREATE INDEX listed ON inspection (at, number, verdict, part, simulated, search);
        -- The narrowest: how many there are is counted in it.
        CREATE INDEX counted ON inspection (simulated);
        CREATE INDEX kept ON inspection (at, frame_bytes) WHERE frame_bytes IS NOT NULL;",
    )
}

/// Groups inspections of the same hung part: one stands for the part, the others lie below it. In older files every
/// inspection gets a part of its own.
fn parts(file: &Transaction<'_>) -> rusqlite::Result<()> {
    file.execute_batch(
        "ALTER TABLE inspection ADD COLUMN hung TEXT NOT NULL DEFAULT '';       -- the part as it hung there
        ALTER TABLE inspection ADD COLUMN parent INTEGER REFERENCES inspection; -- the one that stands for the part
        UPDATE inspection SET hung = 'n' || number;
        DROP INDEX listed;
        CREATE INDEX listed ON inspection (parent, at, number, verdict, part, simulated, search);
        DROP INDEX counted;
        CREATE INDEX counted ON inspection (parent, simulated);
        CREATE INDEX hung ON inspection (hung);",
    )
}

/// Adds the name of the recipe, and whether it was changed since it was saved under that name.
fn recipe_names(file: &Transaction<'_>) -> rusqlite::Result<()> {
    file.execute_batch(
        "ALTER TABLE detail ADD COLUMN recipe_name TEXT;                           -- NULL: not written down
        ALTER TABLE detail ADD COLUMN recipe_changed INTEGER NOT NULL DEFAULT 0;",
    )
}

/// Adds serial number, order and operator; empty if unknown.
fn traceability(file: &Transaction<'_>) -> rusqlite::Result<()> {
    file.execute_batch(
        "ALTER TABLE inspection ADD COLUMN serial TEXT NOT NULL DEFAULT '';
        ALTER TABLE inspection ADD COLUMN job_order TEXT NOT NULL DEFAULT ''; -- ORDER is a word of SQL
        ALTER TABLE inspection ADD COLUMN operator TEXT NOT NULL DEFAULT '';",
    )
}

/// Adds the refusal in a form for programs; `reason` and `advice` are the same in English. The kind is in `inspection`,
/// so that statistics need not read the long rows of `detail`.
fn refusals(file: &Transaction<'_>) -> rusqlite::Result<()> {
    file.execute_batch(
        "ALTER TABLE inspection ADD COLUMN reason_kind TEXT; -- the kind of refusal; NULL: accepted, or not written down
        ALTER TABLE detail ADD COLUMN refusal TEXT;         -- Refusal as JSON, parts by their enrolled names",
    )
}

/// Returns the version of a file; 0 before it has a table.
pub(super) fn version(file: &Connection) -> rusqlite::Result<u32> {
    file.pragma_query_value(None, "user_version", |row| row.get(0))
}

/// Migrates a file to the current version, completely or not at all; a newer one is left as it is.
pub(super) fn migrate(file: &mut Connection) -> rusqlite::Result<()> {
    migrate_by(file, &STEPS)
}

fn migrate_by(file: &mut Connection, steps: &[Migration]) -> rusqlite::Result<()> {
    if version(file)? as usize >= steps.len() {
        return Ok(());
    }
    let file = file.transaction_with_behavior(TransactionBehavior::Immediate)?;
    // Another program may have migrated it meanwhile.
    let found = version(&file)? as usize;
    for (number, step) in steps.iter().enumerate().skip(found) {
        step(&file)?;
        file.pragma_update(None, "user_version", number as u32 + 1)?;
    }
    file.pragma_update(None, "application_id", APPLICATION)?;
    file.commit()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tables(file: &Connection) -> Vec<String> {
        let mut names = file
            .prepare("SELECT name FROM sqlite_schema WHERE type = 'table' ORDER BY name")
            .expect("asked");
        let names = names.query_map([], |row| row.get(0)).expect("asked");
        names.map(|name| name.expect("text")).collect()
    }

    #[test]
    fn every_inspection_of_a_file_of_the_first_version_is_one_of_a_part_of_its_own() {
        let mut file = Connection::open_in_memory().expect("a file");
        file.pragma_update(None, "foreign_keys", true).expect("set");
        migrate_by(&mut file, &[first]).expect("made");
        let row = "INSERT INTO inspection (at, scene, source, simulated, verdict, title, total_ms, remark, search)
            VALUES (?, 'a', 'b', 1, 'accepted', 'Fender', 20.0, 'a dent', 'fender a dent')";
        for at in 0..5 {
            file.execute(row, [at]).expect("written");
        }
        migrate(&mut file).expect("made");
        assert_eq!(version(&file).expect("asked"), VERSION);
        let mut rows = file
            .prepare(
                "SELECT number, remark, hung FROM inspection WHERE parent IS NULL ORDER BY number",
            )
            .expect("asked");
        let rows = rows.query_map([], |row| Ok((row.get(0)?, row.get(1)?, row.get(2)?)));
        let rows: Vec<(i64, String, String)> =
            rows.expect("asked").map(|row| row.expect("read")).collect();
        assert_eq!(rows.len(), 5);
        for (number, (of, remark, hung)) in (1..).zip(&rows) {
            assert_eq!((*of, remark.as_str()), (number, "a dent"));
            assert_eq!(*hung, format!("n{number}"));
        }
    }

    #[test]
    fn an_inspection_of_a_file_of_the_third_version_has_no_serial_number_and_stays_as_it_is() {
        let mut file = Connection::open_in_memory().expect("a file");
        migrate_by(&mut file, &[first, parts, recipe_names]).expect("made");
        file.execute(
            "INSERT INTO inspection (at, scene, source, simulated, verdict, title, total_ms, remark, search, hung)
                VALUES (7, 'a', 'b', 1, 'accepted', 'Fender', 20.0, 'a dent', 'fender a dent', 'n1')",
            [],
        )
        .expect("written");
        migrate(&mut file).expect("made");
        assert_eq!(version(&file).expect("asked"), VERSION);
        let asked = "SELECT at, remark, serial, job_order, operator FROM inspection";
        let row = file.query_row(asked, [], |row| {
            let texts = [1, 2, 3, 4].map(|place| row.get::<_, String>(place));
            Ok((row.get::<_, i64>(0)?, texts.map(|text| text.expect("text"))))
        });
        let empty = String::new;
        let texts = ["a dent".to_owned(), empty(), empty(), empty()];
        assert_eq!(row.expect("there"), (7, texts));
    }

    #[test]
    fn a_refusal_of_a_file_of_the_fourth_version_keeps_its_text_and_has_no_kind() {
        let mut file = Connection::open_in_memory().expect("a file");
        migrate_by(&mut file, &[first, parts, recipe_names, traceability]).expect("made");
        file.execute_batch(
            "INSERT INTO recipe VALUES ('0badcafe', '{}');
            INSERT INTO inspection (at, scene, source, simulated, verdict, title, total_ms, remark, search, hung)
                VALUES (7, 'a', 'b', 1, 'not_accepted', 'Fender', 20.0, 'a dent', 'fender a dent', 'n1');
            INSERT INTO detail (number, nearest, reason, advice, recipe, library, program, line)
                VALUES (1, 'fender', 'too low', 'look again', '0badcafe', '0', '0.1.0', '{}');",
        )
        .expect("written");
        migrate(&mut file).expect("made");
        assert_eq!(version(&file).expect("asked"), VERSION);
        let asked = "SELECT remark, reason, advice, reason_kind, refusal FROM inspection JOIN detail USING (number)";
        let row = file.query_row(asked, [], |row| {
            let texts = [0, 1, 2, 3, 4].map(|place| row.get::<_, Option<String>>(place));
            Ok(texts.map(|text| text.expect("text or nothing")))
        });
        let row = row.expect("there");
        let row = row.each_ref().map(Option::as_deref);
        let expected = [
            Some("a dent"),
            Some("too low"),
            Some("look again"),
            None,
            None,
        ];
        assert_eq!(row, expected);
    }

    fn second(file: &Transaction<'_>) -> rusqlite::Result<()> {
        file.execute_batch("CREATE TABLE later (number INTEGER)")
    }

    fn failing(file: &Transaction<'_>) -> rusqlite::Result<()> {
        file.execute_batch("CREATE TABLE half (number INTEGER); CREATE TABLE inspection (x)")
    }

    #[test]
    fn a_file_of_an_earlier_version_takes_the_steps_that_it_has_not_seen() {
        let mut file = Connection::open_in_memory().expect("a file");
        migrate_by(&mut file, &[first]).expect("made");
        assert_eq!(version(&file).expect("asked"), 1);
        migrate_by(&mut file, &[first, second]).expect("made");
        assert_eq!(version(&file).expect("asked"), 2);
        assert!(tables(&file).contains(&"later".to_owned()));
        // Steps already applied are not repeated, and a newer file is left as it is.
        migrate_by(&mut file, &[first, second]).expect("nothing to do");
        migrate_by(&mut file, &[first]).expect("nothing to do");
        assert_eq!(version(&file).expect("asked"), 2);
    }

    #[test]
    fn a_step_that_fails_leaves_the_file_as_it_was() {
        let mut file = Connection::open_in_memory().expect("a file");
        migrate_by(&mut file, &[first]).expect("made");
        let before = tables(&file);
        migrate_by(&mut file, &[first, second, failing]).expect_err("the table is there");
        assert_eq!(tables(&file), before);
        assert_eq!(version(&file).expect("asked"), 1);
    }
}
