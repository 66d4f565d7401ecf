-- A history as the first version of the format was written.
CREATE TABLE recipe (
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
CREATE INDEX kept ON inspection (at, frame_bytes) WHERE frame_bytes IS NOT NULL;
INSERT INTO recipe VALUES ('0123abcd', '{}');
INSERT INTO inspection VALUES
    (1, 1772344800000000, 'a', 'file', 0, 'accepted', 'grille', 'Grille', 0.97, 0.4, 31.5, '', NULL, NULL, 'grille'),
    (2, 1772344801000000, 'b', 'simulated', 1, 'accepted', 'fender', 'Fender, left', 0.98, 0.5, 30.5, 'a dent',
        '{"is":"part","part":"fender"}', NULL, 'fender, left a dent'),
    (3, 1772344802000000, 'c', 'file', 0, 'no_part', NULL, 'No part', NULL, NULL, 5.0, '', NULL, NULL, 'no part');
INSERT INTO detail VALUES
    (1, 'grille', NULL, NULL, NULL, '0123abcd', '0badcafe', '0.1.0', '{"scene":"a"}', NULL, NULL, NULL),
    (2, 'fender', NULL, NULL, NULL, '0123abcd', '0badcafe', '0.1.0', '{"scene":"b"}', NULL, NULL, NULL),
    (3, NULL, 'nothing', 'look', NULL, '0123abcd', '0badcafe', '0.1.0', '{"scene":"c"}', NULL, NULL, NULL);
PRAGMA application_id = 1349732457;
PRAGMA user_version = 1;
PRAGMA journal_mode = WAL;
