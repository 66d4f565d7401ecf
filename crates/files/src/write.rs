//! Writing of files so that each is complete or absent.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Duration;

use super::disk;
use super::error::FileError;
use super::folders::{folder_of, sync_folder};
use super::{write_pcd, write_ply, write_xyz};
use geometry::{cloud::PointCloud, error::lock};

/// Writes a file through `fill`. Even if the power fails, `path` holds either its former content or all of the new one: a
/// temporary file in the same folder is filled, synced and renamed.
///
/// The folder must exist. A link to a file stays, and that file is written. Devices and pipes, such as
/// `/dev/stdout`, are written directly.
pub fn write_atomically(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), FileError> {
    let is_special =
        fs::metadata(path).is_ok_and(|metadata| !metadata.is_file() && !metadata.is_dir());
    let written = if is_special {
        write_directly(path, fill)
    } else {
        let target = path.is_symlink().then(|| path.canonicalize().ok());
        write_beside(target.flatten().as_deref().unwrap_or(path), fill)
    };
    written.map_err(|error| FileError::writing(path, error))
}

/// Writes to a device or a pipe, which a rename would replace by a file.
fn write_directly(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let device = disk::open(File::options().write(true), path)?;
    let mut writer = BufWriter::new(disk::DiskWriter(device));
    fill(&mut writer)?;
    writer.flush()
}

/// Writes a file of one of the program's own folders as [`write_atomically`] does, but replaces a link, pipe or device of
/// that name: nothing else belongs there.
pub fn replace_file(path: &Path, content: &[u8]) -> io::Result<()> {
    write_beside(path, |writer| writer.write_all(content))
}

/// Fills a temporary file in the same folder, syncs it and renames it.
fn write_beside(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let folder = folder_of(path);
    clear_leftovers_once(folder);
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // As for an ordinary new file, less the umask: other users may read results.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut writer = BufWriter::new(disk::DiskWriter(disk::temporary_file(&builder, folder)?));
    fill(&mut writer)?;
    let disk::DiskWriter(file) = writer
        .into_inner()
        .map_err(io::IntoInnerError::into_error)?;
    disk::sync_all(file.as_file())?;
    disk::persist(file, path)?;
    sync_folder(folder)
}

/// Writes a text file as [`write_atomically`] does.
pub fn write_text(path: &Path, text: &str) -> Result<(), FileError> {
    write_atomically(path, |writer| writer.write_all(text.as_bytes()))
}

/// Beginning and end of the names of temporary files.
const PREFIX: &str = ".partsight-";
const SUFFIX: &str = ".part";
/// A temporary file unchanged for this long was left behind by an interrupted write.
const ABANDONED: Duration = Duration::from_mins(10);

/// Removes temporary files left in a folder by killed programs; looks into each folder once per process.
fn clear_leftovers_once(folder: &Path) {
    static CLEARED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    let mut cleared = lock(&CLEARED);
    if cleared.insert(folder.to_owned()) {
        drop(cleared);
        clear_leftovers(folder);
    }
}

/// Ignores files that cannot be removed: new temporary files have other names.
fn clear_leftovers(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let is_ours = name.to_str().is_some_and(|name| {
            let name = name.strip_prefix(PREFIX);
            name.is_some_and(|name| name.ends_with(SUFFIX))
        });
        let changed = || entry.metadata().ok()?.modified().ok()?.elapsed().ok();
        if is_ours && changed().is_some_and(|age| age > ABANDONED) {
            let _ = disk::remove_file(entry.path());
        }
    }
}

/// Writes a cloud in the format of the name's ending: `.pcd` (everything), `.ply` (all but the grid), `.xyz` (positions only).
pub fn save_cloud(path: &Path, cloud: &PointCloud) -> Result<(), FileError> {
    let ending = path
        .extension()
        .map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("pcd") => write_atomically(path, |writer| write_pcd(writer, cloud)),
        Some("ply") => write_atomically(path, |writer| write_ply(writer, cloud)),
        Some("xyz") => write_atomically(path, |writer| write_xyz(writer, cloud)),
        _ => Err(FileError::UnknownEnding {
            path: path.to_owned(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_content_and_no_other_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("kept.txt");
        write_atomically(&path, |writer| writer.write_all(b"old")).unwrap();
        let failed = write_atomically(&path, |writer| {
            writer.write_all(b"half of the ne")?;
            Err(io::Error::other("the stick was pulled out"))
        });
        assert!(matches!(failed, Err(FileError::Write { .. })));
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn what_a_killed_program_left_is_removed_and_what_another_writes_now_stays() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let long_ago = std::time::SystemTime::now() - 2 * ABANDONED;
        for (name, is_old) in [
            (".partsight-old.part", true),
            (".partsight-new.part", false),
            ("cell.part", true),
        ] {
            let file = File::create(at(name)).unwrap();
            if is_old {
                file.set_modified(long_ago).unwrap();
            }
        }
        write_atomically(&at("cell.toml"), |writer| writer.write_all(b"x")).unwrap();
        let left = [".partsight-old.part", ".partsight-new.part", "cell.part"];
        assert_eq!(left.map(|name| at(name).exists()), [false, true, true]);
    }

    #[test]
    fn a_folder_that_does_not_exist_is_a_named_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("missing").join("file.txt");
        let failed = write_atomically(&path, |writer| writer.write_all(b"x"));
        assert!(matches!(failed, Err(FileError::Write { path: named, .. }) if named == path));
    }

    #[cfg(unix)]
    #[test]
    fn others_may_read_what_was_written() {
        use std::os::unix::fs::PermissionsExt as _;

        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("result.txt");
        write_atomically(&path, |writer| writer.write_all(b"x")).unwrap();
        let plain = folder.path().join("plain.txt");
        std::fs::write(&plain, b"x").unwrap();
        let mode = |path: &Path| std::fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&path), mode(&plain));
    }

    #[cfg(unix)]
    #[test]
    fn a_link_or_a_pipe_stays_and_its_target_is_written() {
        use std::{
            os::unix::fs::{FileTypeExt as _, symlink},
            process::Command,
            thread,
        };

        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("kept.txt"), "old").unwrap();
        symlink("kept.txt", at("link.txt")).unwrap();
        write_text(&at("link.txt"), "new").unwrap();
        assert_eq!(fs::read_to_string(at("kept.txt")).unwrap(), "new");
        assert!(at("link.txt").is_symlink());

        let made = Command::new("mkfifo").arg(at("pipe")).status().unwrap();
        assert!(made.success());
        symlink("pipe", at("link to the pipe")).unwrap();
        for name in ["pipe", "link to the pipe"] {
            let pipe = at("pipe");
            let reader = thread::spawn(move || fs::read_to_string(pipe).unwrap());
            write_text(&at(name), "through the pipe").unwrap();
            assert_eq!(reader.join().unwrap(), "through the pipe");
        }
        let metadata = fs::symlink_metadata(at("pipe")).unwrap();
        assert!(metadata.file_type().is_fifo());
    }

    #[test]
    fn a_cloud_is_saved_only_under_a_known_ending() {
        let folder = tempfile::tempdir().unwrap();
        let mut cloud = PointCloud::from_points([nalgebra::Point3::new(1.0, 2.0, 3.0)]);
        for is_simulated in [false, true] {
            cloud.is_simulated = is_simulated;
            for ending in ["pcd", "PLY", "xyz"] {
                let path = folder.path().join(format!("cloud.{ending}"));
                save_cloud(&path, &cloud).unwrap();
                let opened = crate::open(&path).unwrap();
                assert_eq!(opened.is_simulated(), is_simulated, "{ending}");
                assert_eq!(opened, crate::FileContent::Cloud(cloud.clone()));
            }
        }
        let unknown = save_cloud(&folder.path().join("cloud"), &cloud);
        assert!(matches!(unknown, Err(FileError::UnknownEnding { .. })));
    }

    #[cfg(unix)]
    #[test]
    fn whichever_call_fails_a_file_holds_its_old_content_or_the_new() {
        use crate::disk::faults::{Writer, with_advice};

        Writer {
            test: "write::tests::whichever_call_fails_a_file_holds_its_old_content_or_the_new",
            prepare: &|folder| fs::write(folder.join("kept.txt"), "old").unwrap(),
            write: &|folder| {
                let written = write_atomically(&folder.join("kept.txt"), |writer| {
                    writer.write_all(b"new")?;
                    // More than the buffer holds.
                    writer.write_all(&vec![b'x'; 20_000])
                });
                written.map_err(|error| with_advice(&error))
            },
            state: &|folder| {
                let text = fs::read_to_string(folder.join("kept.txt")).unwrap();
                format!("{} bytes, {}", text.len(), &text[..3])
            },
            between: &[],
        }
        .fails_at_every_call();
    }
}
