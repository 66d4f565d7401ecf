//! Words for the cause of a failed write, and what to do about it.

use std::io;

/// Returns the cause alone: some libraries wrap it in an error that also names their temporary file.
pub fn words_of(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "the folder does not exist".into(),
        io::ErrorKind::PermissionDenied => "permission denied".into(),
        io::ErrorKind::NotADirectory => "a part of the path is a file, not a folder".into(),
        io::ErrorKind::IsADirectory => "a folder of that name is there".into(),
        io::ErrorKind::AlreadyExists => "a file of that name is there".into(),
        io::ErrorKind::ReadOnlyFilesystem => "the disk is write-protected".into(),
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => "the disk is full".into(),
        io::ErrorKind::FileTooLarge => "the file would be larger than this system allows".into(),
        _ => innermost(error),
    }
}

/// EIO on Unix, `ERROR_IO_DEVICE` on Windows.
const IO_ERROR: i32 = if cfg!(windows) { 1117 } else { 5 };

/// Returns what to do about a failed write.
pub fn advice_on(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::NotFound => "Make the folder first, or correct the path",
        io::ErrorKind::NotADirectory
        | io::ErrorKind::IsADirectory
        | io::ErrorKind::AlreadyExists => "Choose another path",
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "Write to a folder of your own, or ask for access to this one"
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "Make room on the disk, or choose another one"
        }
        io::ErrorKind::FileTooLarge => {
            "Raise the limit on the size of files (`ulimit -f`), or choose another disk"
        }
        io::ErrorKind::InvalidInput => "Move what is there away, or choose another path",
        _ if error.raw_os_error() == Some(IO_ERROR) => {
            "Check the disk and its connection, or write to another disk"
        }
        _ => "Choose a folder on this computer's own disk",
    }
}

fn innermost(error: &io::Error) -> String {
    let wrapped = error.get_ref().and_then(|inner| inner.source());
    let Some(mut deepest) = wrapped else {
        return error.to_string();
    };
    while let Some(source) = deepest.source() {
        deepest = source;
    }
    deepest.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cause_is_named_once_without_the_temporary_file() {
        let missing = tempfile::Builder::new()
            .prefix(".partsight-")
            .tempfile_in("no/such/folder")
            .expect_err("no folder");
        assert_eq!(words_of(&missing), "the folder does not exist");
        let full = io::Error::from(io::ErrorKind::StorageFull);
        assert_eq!(words_of(&full), "the disk is full");
        assert!(advice_on(&full).contains("room"));
        let too_large = io::Error::from(io::ErrorKind::FileTooLarge);
        assert!(words_of(&too_large).contains("larger"));
        assert!(advice_on(&too_large).contains("ulimit"));
        let other = io::Error::other("the stick was pulled out");
        assert_eq!(words_of(&other), "the stick was pulled out");
    }
}
