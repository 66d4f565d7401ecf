//! Opens the file: creates a missing one, refuses a newer one and the database of another program, and sets aside a
//! damaged one and one of a development build.
//!
//! Write-ahead logging lets the window and a command write at the same time. With `synchronous = FULL` an inspection
//! that was reported as written survives a power failure, not only a kill; a commit then waits for the disk, which is
//! why a separate thread writes. Every program that has the history open holds a shared lock. A program that gets the
//! exclusive lock at the beginning is alone; only then is the file checked and are strays removed.
//!
//! SQLite locks the file with POSIX locks: a process that closes any descriptor of the file loses all its locks on it. The
//! next program that closes the history would then delete the log that this process still writes to. So while this process
//! may have the history open, only SQLite reads the file.

use std::{
    collections::BTreeSet,
    fs,
    io::{self, Read as _},
    path::{Path, PathBuf},
    time::Duration,
};

use rusqlite::{Connection, OpenFlags, config::DbConfig};

use files::{FileLock, disk, open_regular, refuse_special, user_data};

use super::{
    error::HistoryError,
    schema::{APPLICATION, VERSION, create_tables, version},
    store::History,
};

/// File name of the database in the history's folder.
pub const FILE: &str = "history.sqlite";
/// Name of the folder of frames next to it.
pub(super) const FRAMES: &str = "history-frames";
const LOCK: &str = "history.lock";
/// What follows the name of a file that was set aside in the name of its folder of frames.
const FRAMES_ENDING: &str = "-frames";
/// How long one writer waits for another.
const PATIENCE: Duration = Duration::from_secs(10);
/// Files up to this size, in bytes, are checked whenever they are opened, which takes some milliseconds. Larger ones
/// are checked only if the last program that had them open was killed.
const ALWAYS_CHECKED: u64 = 16 << 20;

/// A damaged file that was set aside.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SetAside {
    /// Description of the damage.
    pub what: String,
    /// New path of the file; its companions are renamed in the same way.
    pub aside: PathBuf,
}

/// An open history.
#[derive(Debug)]
pub struct OpenedHistory {
    /// The history.
    pub history: History,
    /// The damaged file that was set aside first, if any.
    pub set_aside: Option<SetAside>,
    /// Set if the history could only be opened for reading.
    pub only_read: Option<OnlyRead>,
}

/// Why a history can be read but not written.
#[derive(Debug)]
pub struct OnlyRead {
    /// The error that prevents writing.
    pub error: HistoryError,
    /// True if the log of the last writes could not be read, so that the newest inspections are missing.
    pub lacks_newest: bool,
}

/// Returns the folder of the user's own history.
pub fn users_folder() -> Result<PathBuf, HistoryError> {
    Ok(user_data()?)
}

impl History {
    /// Opens the history in this folder; creates folder and file if missing.
    pub fn open(folder: &Path) -> Result<OpenedHistory, HistoryError> {
        disk::create_dir_all(folder).map_err(|error| HistoryError::io(folder, error))?;
        let path = folder.join(FILE);
        refuse_pipes(&path)?;
        refuse_foreign(&path)?;
        let mut set_aside = set_aside_frames(&path)?;
        if let Some(_alone) = lock_alone(folder)? {
            set_aside = set_aside_damaged(&path)?.or(set_aside);
            let history = Self::new(connect(&path)?, folder);
            history.tidy()?;
        }
        let lock = FileLock::shared(&folder.join(LOCK));
        let lock = lock.map_err(|error| HistoryError::io(folder, error))?;
        let mut history = Self::new(connect(&path)?, folder);
        history.hold(lock);
        Ok(OpenedHistory {
            history,
            set_aside,
            only_read: None,
        })
    }

    /// Returns true if the file was moved, deleted or replaced since it was opened: rows written to it now would not be found.
    pub(super) fn is_replaced(&self) -> bool {
        let is_other = |opened| match file_identity(&self.path) {
            Ok(found) => found != opened,
            Err(error) => matches!(
                error.kind(),
                io::ErrorKind::NotFound | io::ErrorKind::NotADirectory
            ),
        };
        self.identity.is_some_and(is_other)
    }

    /// Closes a history whose file was moved, deleted or replaced.
    pub(super) fn close_replaced(self) -> HistoryError {
        // If the log was left behind, write its rows to the file that was moved and remove the log: SQLite would apply it
        // to the next file of this name.
        let [log, index] = ["-wal", "-shm"].map(|ending| with_ending(&self.path, ending));
        let found = file_identity(&log).ok();
        if found.is_some() && found == self.log {
            let write_back = "PRAGMA wal_checkpoint(TRUNCATE)";
            let is_busy = (self.file).query_row(write_back, [], |row| row.get::<_, i64>(0));
            // If that fails, or somebody still reads the log, there is no other way.
            if is_busy == Ok(0) {
                let _ = disk::remove_file(log);
                let _ = disk::remove_file(index);
            }
        }
        // Closing would delete the log of the next file, which SQLite finds by its name.
        let no_write_back = DbConfig::SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE;
        let _ = self.file.set_db_config(no_write_back, true);
        HistoryError::Replaced { path: self.path }
    }

    /// Opens a history for reading only, even one that cannot be written because its disk is full, fails or is
    /// write-protected. Creates nothing.
    pub fn open_to_read(folder: &Path) -> Result<OpenedHistory, HistoryError> {
        let path = folder.join(FILE);
        refuse_pipes(&path)?;
        if !path.is_file() {
            return Err(HistoryError::NotFound { path });
        }
        Self::open(folder).or_else(|error| match Self::only_read(folder, &error) {
            Some((history, lacks_newest)) => Ok(OpenedHistory {
                history,
                set_aside: None,
                only_read: Some(OnlyRead {
                    error,
                    lacks_newest,
                }),
            }),
            None => Err(error),
        })
    }

    /// If `error` is one that forbids writing, opens the history as far as that works without writing. The flag is true
    /// if the log of the last writes is missing from it.
    pub(super) fn only_read(folder: &Path, error: &HistoryError) -> Option<(Self, bool)> {
        let path = folder.join(FILE);
        if !error.forbids_writing() || refuse_pipes(&path).is_err() {
            return None;
        }
        let read = |how: &str| -> rusqlite::Result<Option<Self>> {
            let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_URI;
            let file = Connection::open_with_flags(address(&path, how), flags)?;
            file.busy_timeout(PATIENCE)?;
            let is_known = is_ours(&file)? && version(&file)? == VERSION;
            Ok(is_known.then(|| Self::new(file, folder)))
        };
        if let Ok(history) = read("mode=ro") {
            return history.map(|history| (history, false));
        }
        let log = fs::metadata(with_ending(&path, "-wal"));
        let has_log = log.is_ok_and(|log| log.len() > 0);
        let history = read("immutable=1").ok()??;
        Some((history, has_log))
    }
}

/// Returns device and inode of a file.
#[cfg(unix)]
pub(super) fn file_identity(path: &Path) -> io::Result<[u64; 2]> {
    use std::os::unix::fs::MetadataExt as _;

    fs::metadata(path).map(|file| [file.dev(), file.ino()])
}

/// Windows keeps an open database from being moved or deleted, so that all files are the same here.
#[cfg(not(unix))]
pub(super) fn file_identity(path: &Path) -> io::Result<[u64; 2]> {
    fs::metadata(path).map(|_| [0; 2])
}

/// Returns the file as a URI with this parameter.
fn address(path: &Path, how: &str) -> String {
    // Byte by byte, because a name need not be text.
    let bytes = path.as_os_str().as_encoded_bytes().iter();
    let escaped: String = bytes
        .map(|byte| match byte {
            b'%' | b'?' | b'#' | 0x80.. => format!("%{byte:02x}"),
            _ => char::from(*byte).to_string(),
        })
        .collect();
    format!("file:{escaped}?{how}")
}

/// Takes the exclusive lock, if nobody has the history open.
fn lock_alone(folder: &Path) -> Result<Option<FileLock>, HistoryError> {
    match FileLock::try_exclusive(&folder.join(LOCK)) {
        // Some network file systems have no locks, so others may have it open.
        Err(error) if error.kind() == io::ErrorKind::Unsupported => Ok(None),
        taken => taken.map_err(|error| HistoryError::io(folder, error)),
    }
}

/// Refuses a file of another version; a new file has version 0.
fn refuse_other_version(path: &Path, found: u32) -> Result<(), HistoryError> {
    let path = path.to_owned();
    match found {
        0 | VERSION => Ok(()),
        ..VERSION => Err(HistoryError::Damaged {
            path,
            what: format!("a development build wrote it (format {found})"),
        }),
        _ => Err(HistoryError::Newer {
            path,
            found,
            known: VERSION,
        }),
    }
}

/// Opens the file, and creates the tables in a new one.
fn connect(path: &Path) -> Result<Connection, HistoryError> {
    let of = |error| HistoryError::of(path, error);
    // Check before SQLite opens the file for writing: opening alone may write to it.
    let found = open_without_log(path)?.and_then(|file| version(&file).ok());
    refuse_other_version(path, found.unwrap_or(0))?;
    let flags = OpenFlags::SQLITE_OPEN_READ_WRITE
        | OpenFlags::SQLITE_OPEN_CREATE
        | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let mut file = Connection::open_with_flags(path, flags).map_err(of)?;
    file.busy_timeout(PATIENCE).map_err(of)?;
    let found = version(&file).map_err(of)?;
    // In this order, since another instance of the program may be creating the tables right now.
    let is_foreign = has_tables(&file).map_err(of)? && !is_ours(&file).map_err(of)?;
    if is_foreign || ![0, VERSION].contains(&found) {
        // The newest pages may still be in the log; leave them there.
        file.set_db_config(DbConfig::SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, true)
            .map_err(of)?;
        if is_foreign {
            return Err(foreign(path));
        }
        refuse_other_version(path, found)?;
    }
    let set = || -> rusqlite::Result<()> {
        file.pragma_update(None, "journal_mode", "WAL")?;
        file.pragma_update(None, "synchronous", "FULL")?;
        file.pragma_update(None, "foreign_keys", true)
    };
    set().map_err(of)?;
    create_tables(&mut file).map_err(of)?;
    Ok(file)
}

fn has_tables(file: &Connection) -> rusqlite::Result<bool> {
    file.query_row("SELECT count(*) > 0 FROM sqlite_schema", [], |row| {
        row.get(0)
    })
}

fn is_ours(file: &Connection) -> rusqlite::Result<bool> {
    Ok(application(file)? == APPLICATION)
}

fn application(file: &Connection) -> rusqlite::Result<i32> {
    file.pragma_query_value(None, "application_id", |row| row.get(0))
}

fn foreign(path: &Path) -> HistoryError {
    HistoryError::Foreign {
        path: path.to_owned(),
    }
}

/// Refuses the database of another program before `SQLite` may write to it or create files next to it.
fn refuse_foreign(path: &Path) -> Result<(), HistoryError> {
    let Some(file) = open_without_log(path)? else {
        return Ok(());
    };
    let is_foreign = || -> rusqlite::Result<bool> {
        match (application(&file)?, version(&file)?) {
            (APPLICATION, _) => Ok(false),
            // A history before its first table, or a program that sets no application id.
            (0, 0) => has_tables(&file),
            _ => Ok(true),
        }
    };
    match is_foreign() {
        Ok(true) => Err(foreign(path)),
        // A file that is not a database is treated as a damaged history.
        Ok(false) | Err(_) => Ok(()),
    }
}

/// Refuses a pipe, a device or a folder in place of the database or of a file that `SQLite` opens beside it: it would wait
/// for a writer to the pipe.
fn refuse_pipes(path: &Path) -> Result<(), HistoryError> {
    for ending in ["", "-wal", "-shm", "-journal"] {
        let path = with_ending(path, ending);
        refuse_special(&path).map_err(|error| HistoryError::io(&path, error))?;
    }
    Ok(())
}

/// Opens the file read-only and ignores its log; creates no other file. `None` if the file is missing.
fn open_without_log(path: &Path) -> Result<Option<Connection>, HistoryError> {
    match fs::metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(HistoryError::io(path, error)),
        Ok(_) => {}
    }
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_URI;
    let file = Connection::open_with_flags(address(path, "immutable=1"), flags);
    file.map(Some)
        .map_err(|error| HistoryError::of(path, error))
}

/// Returns the first of our tables and indexes that is missing in the file.
fn lacking(file: &Connection) -> rusqlite::Result<Option<String>> {
    let names = |file: &Connection| -> rusqlite::Result<BTreeSet<String>> {
        let mut asked = file.prepare("SELECT type || ' ' || name FROM sqlite_schema")?;
        let names = asked.query_map([], |row| row.get(0))?;
        names.collect()
    };
    let mut whole = Connection::open_in_memory()?;
    create_tables(&mut whole)?;
    let found = names(file)?;
    // Tables before their indexes.
    let mut expected = names(&whole)?.into_iter().rev();
    Ok(expected.find(|name| !found.contains(name)))
}

/// Fields from the first hundred bytes of a database.
struct Header {
    version: u32,
    num_bytes: u64,
}

/// First bytes of every `SQLite` database.
const MAGIC: &[u8; 16] = b"SQLite format 3\0";
/// First bytes of every log, except the last bit.
const LOG_MAGIC: u32 = 0x377f_0682;

impl Header {
    /// Reads the header; `None` if the file is missing or empty. Call it only while no process has the file open, this one
    /// included.
    fn read(path: &Path) -> Result<Option<Self>, HistoryError> {
        let damaged = |what: &str| HistoryError::Damaged {
            path: path.to_owned(),
            what: what.to_owned(),
        };
        let Some(bytes) = first_bytes(path, 100)? else {
            return Ok(None);
        };
        let word = |at: usize| {
            let bytes = bytes.get(at..at + 4)?;
            Some(u32::from_be_bytes(*bytes.first_chunk()?))
        };
        let (Some(true), Some(version), Some(num_pages)) = (
            bytes.first_chunk().map(|magic| magic == MAGIC),
            word(60),
            word(28),
        ) else {
            return Err(damaged("it is no database"));
        };
        let page = u64::from(bytes[16]) << 8 | u64::from(bytes[17]);
        Ok(Some(Self {
            version,
            // A page size of 65536 bytes is stored as 1.
            num_bytes: u64::from(num_pages) * if page == 1 { 65_536 } else { page },
        }))
    }
}

/// Reads the beginning of a file; `None` if it is missing or empty.
fn first_bytes(path: &Path, most: u64) -> Result<Option<Vec<u8>>, HistoryError> {
    let read = || -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        open_regular(path)?.take(most).read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    match read() {
        Ok(bytes) => Ok(Some(bytes).filter(|bytes| !bytes.is_empty())),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(HistoryError::io(path, error)),
    }
}

/// Sets aside frames without a file. Their rows may be in a file that was moved; a new file has none of them, so that the
/// frames would be removed as strays.
fn set_aside_frames(path: &Path) -> Result<Option<SetAside>, HistoryError> {
    let frames = path.with_file_name(FRAMES);
    let has_frames = fs::read_dir(&frames).is_ok_and(|mut files| files.next().is_some());
    if !has_frames || path.exists() {
        return Ok(None);
    }
    let aside = with_ending(&aside(path)?, FRAMES_ENDING);
    match disk::rename(&frames, &aside) {
        Ok(()) => Ok(Some(SetAside {
            what: format!("{FRAMES} was there without {FILE}"),
            aside,
        })),
        // Another program has just done so.
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(HistoryError::io(path, error)),
    }
}

/// Sets aside a damaged file; afterwards there is an intact one or none. Call it only while nobody else has it open.
fn set_aside_damaged(path: &Path) -> Result<Option<SetAside>, HistoryError> {
    let log = with_ending(path, "-wal");
    if let Some(bytes) = first_bytes(&log, 4)? {
        let magic = bytes.first_chunk().map_or(0, |b| u32::from_be_bytes(*b));
        if magic & !1 != LOG_MAGIC {
            // SQLite would silently ignore this log. Everything written before it is intact.
            let aside = aside(&log)?;
            disk::rename(&log, &aside).map_err(|error| HistoryError::io(path, error))?;
            let what =
                "the log of its last writes is damaged: the newest inspections may be missing";
            return Ok(Some(SetAside {
                what: what.into(),
                aside,
            }));
        }
    }
    let was_left_open = fs::metadata(&log).is_ok_and(|log| log.len() > 0);
    match check(path, was_left_open) {
        Err(HistoryError::Damaged { what, .. }) => {
            let aside = set_aside(path)?;
            Ok(Some(SetAside { what, aside }))
        }
        Err(error) => Err(error),
        Ok(()) => Ok(None),
    }
}

/// Checks whether the file can be used.
fn check(path: &Path, was_left_open: bool) -> Result<(), HistoryError> {
    let damaged = |what: String| HistoryError::Damaged {
        path: path.to_owned(),
        what,
    };
    let Some(header) = Header::read(path)? else {
        return Ok(());
    };
    refuse_other_version(path, header.version)?;
    let size = fs::metadata(path).map_or(0, |file| file.len());
    if size < header.num_bytes && !was_left_open {
        let expected = header.num_bytes;
        return Err(damaged(format!("it ends after {size} of {expected} bytes")));
    }
    let file = connect(path)?;
    let lacks = lacking(&file).map_err(|error| HistoryError::of(path, error))?;
    if let Some(name) = lacks {
        return Err(damaged(format!("its {name} is missing")));
    }
    if was_left_open || size < ALWAYS_CHECKED {
        let of = |error| HistoryError::of(path, error);
        let found: String = file
            .pragma_query_value(None, "quick_check", |row| row.get(0))
            .map_err(of)?;
        if found != "ok" {
            return Err(damaged(found.lines().next().unwrap_or_default().to_owned()));
        }
    }
    Ok(())
}

/// Moves the file, its log and its frames to free names; deletes nothing.
fn set_aside(path: &Path) -> Result<PathBuf, HistoryError> {
    let aside = aside(path)?;
    let frames = path.with_file_name(FRAMES);
    let moves = [
        (path.to_owned(), aside.clone()),
        (with_ending(path, "-wal"), with_ending(&aside, "-wal")),
        (with_ending(path, "-shm"), with_ending(&aside, "-shm")),
        (frames, with_ending(&aside, FRAMES_ENDING)),
    ];
    for (from, to) in moves {
        match disk::rename(&from, &to) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                return Err(HistoryError::io(path, error));
            }
            _ => {}
        }
    }
    Ok(aside)
}

/// Returns a free name next to a file.
fn aside(path: &Path) -> Result<PathBuf, HistoryError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let (stem, ending) = name.rsplit_once('.').unwrap_or((&name, ""));
    let numbered = |number| path.with_file_name(format!("{stem}.damaged-{number}.{ending}"));
    (1..1000)
        .map(numbered)
        .find(|aside| !aside.exists() && !with_ending(aside, FRAMES_ENDING).exists())
        .ok_or_else(|| HistoryError::io(path, io::ErrorKind::AlreadyExists.into()))
}

/// Returns the name of a companion file of `SQLite`.
pub(super) fn with_ending(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(ending);
    name.into()
}

#[cfg(test)]
mod tests;
