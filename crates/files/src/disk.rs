//! Every system call by which the program changes a disk, except those of the history's database. Tests can make each of
//! them fail, or end the program there (`faults`). Clippy denies such calls elsewhere (`clippy.toml`).

#![allow(
    clippy::disallowed_methods,
    reason = "the one place that changes files"
)]

use std::{
    fs::{self, File, OpenOptions},
    io::{self, Write},
    path::Path,
};

use tempfile::{NamedTempFile, TempDir};

#[cfg(any(test, feature = "fixtures"))]
pub mod faults;

/// Runs before every call. `partial_call` does the part of the call that a failing system may have completed.
#[cfg(any(test, feature = "fixtures"))]
fn inject_fault(partial_call: impl FnOnce()) -> io::Result<()> {
    faults::inject(partial_call)
}

#[cfg(not(any(test, feature = "fixtures")))]
#[expect(
    clippy::unnecessary_wraps,
    reason = "it is a test that makes calls fail"
)]
#[inline]
fn inject_fault(_partial_call: impl FnOnce()) -> io::Result<()> {
    Ok(())
}

pub fn create_dir(path: impl AsRef<Path>) -> io::Result<()> {
    inject_fault(|| ())?;
    fs::create_dir(path)
}

pub fn create_dir_all(path: impl AsRef<Path>) -> io::Result<()> {
    inject_fault(|| ())?;
    fs::create_dir_all(path)
}

pub fn rename(from: impl AsRef<Path>, to: impl AsRef<Path>) -> io::Result<()> {
    inject_fault(|| ())?;
    fs::rename(from, to)
}

pub fn remove_file(path: impl AsRef<Path>) -> io::Result<()> {
    inject_fault(|| ())?;
    fs::remove_file(path)
}

/// Removes an empty folder.
pub fn remove_dir(path: impl AsRef<Path>) -> io::Result<()> {
    inject_fault(|| ())?;
    fs::remove_dir(path)
}

pub fn remove_dir_all(path: impl AsRef<Path>) -> io::Result<()> {
    inject_fault(|| ())?;
    fs::remove_dir_all(path)
}

/// Opens a file for writing.
pub fn open(options: &OpenOptions, path: &Path) -> io::Result<File> {
    inject_fault(|| ())?;
    options.open(path)
}

/// Creates a file; fails if there is one.
pub fn create_new(path: &Path) -> io::Result<File> {
    open(File::options().write(true).create_new(true), path)
}

pub fn write_all(file: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    inject_fault(|| drop(file.write_all(&bytes[..bytes.len() / 2])))?;
    file.write_all(bytes)
}

pub fn set_len(file: &File, length: u64) -> io::Result<()> {
    inject_fault(|| ())?;
    file.set_len(length)
}

/// Flushes content and metadata to the disk.
pub fn sync_all(file: &File) -> io::Result<()> {
    inject_fault(|| ())?;
    file.sync_all()
}

/// Flushes the content to the disk.
pub fn sync_data(file: &File) -> io::Result<()> {
    inject_fault(|| ())?;
    file.sync_data()
}

pub fn temporary_file(
    builder: &tempfile::Builder<'_, '_>,
    folder: &Path,
) -> io::Result<NamedTempFile> {
    inject_fault(|| ())?;
    builder.tempfile_in(folder)
}

pub fn temporary_folder(builder: &tempfile::Builder<'_, '_>, folder: &Path) -> io::Result<TempDir> {
    inject_fault(|| ())?;
    builder.tempdir_in(folder)
}

/// Renames a temporary file to its final name.
pub fn persist(file: NamedTempFile, path: &Path) -> io::Result<File> {
    inject_fault(|| ())?;
    file.persist(path).map_err(|error| error.error)
}

/// Writes everything through [`write_all`].
#[derive(Debug)]
pub struct DiskWriter<W>(pub W);

impl<W: Write> Write for DiskWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        write_all(&mut self.0, bytes)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}
