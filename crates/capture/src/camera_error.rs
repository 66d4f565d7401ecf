//! Errors of cameras, of their libraries and of the files that these record, with advice.

use std::{
    fmt::{self, Display, Formatter},
    path::{Path, PathBuf},
};

use super::{camera_library::CameraLibrary, error::Recovery};
use geometry::error::Advice;

/// Why a camera, its library or a file recorded by it cannot be used, or delivers no more.
#[derive(Debug)]
pub struct CameraError {
    /// The library, and by it the kind of camera.
    pub library: &'static CameraLibrary,
    /// What failed.
    pub kind: CameraErrorKind,
    /// The message of the library, or of the system that loads it, if there is one.
    pub message: Option<String>,
}

/// What failed about a camera.
#[derive(Debug, PartialEq, Eq)]
pub enum CameraErrorKind {
    /// The library is not installed.
    LibraryMissing {
        /// The file or folder of a setting, in which case only this place was searched.
        path: Option<PathBuf>,
    },
    /// The library was found, but the system cannot load it.
    LibraryNotLoaded {
        /// Name or path of its file.
        file: String,
    },
    /// The file is another version of the library, or another library.
    LibraryLacks {
        /// Name or path of the file.
        file: String,
        /// The missing function.
        function: &'static str,
    },
    /// The library does not start.
    LibraryNotStarted,
    /// No camera is there, or not the requested one.
    NoDevice {
        /// Serial number, URI or ID of the requested one; `None` for any.
        wanted: Option<String>,
        /// Those that are there.
        found: Vec<String>,
    },
    /// The system does not permit this user to open the camera.
    NoPermission {
        /// The installed udev rule that should permit it, if any.
        rule: Option<&'static str>,
    },
    /// Another program, or a driver of the system, uses the camera.
    Busy,
    /// This program already uses the camera, or another one whose library opens only one.
    InUse,
    /// The camera cannot be opened, or not be read or set while it is opened.
    NotOpened,
    /// The camera opens, but its stream does not start.
    NotStarted,
    /// The camera was unplugged, lost its power, was taken by another program, or reports an error.
    Disconnected,
    /// The camera is there but sends nothing.
    NoFrames {
        /// For how long, seconds.
        seconds: u64,
    },
    /// The RealSense camera has no depth: it is a tracking camera, or waits for its firmware.
    NoDepth {
        /// Model and serial number.
        title: String,
    },
    /// A format, mode, setting or number of the camera, its library or file cannot be used until a person changes it.
    Unsuitable {
        /// What is wrong with it.
        what: String,
        /// What to change.
        advice: String,
    },
    /// A frame is incomplete, or not an image of the expected kind; others may follow.
    BadFrame {
        /// What is wrong with it.
        what: String,
    },
    /// The file is no recording of the library, or is damaged.
    FileUnusable {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
}

use CameraErrorKind as Kind;

impl CameraLibrary {
    /// An error without a message of the library.
    pub(super) fn error(&'static self, kind: CameraErrorKind) -> CameraError {
        CameraError {
            library: self,
            kind,
            message: None,
        }
    }

    /// No camera is there, or `found` but not the one that is `wanted`.
    pub(super) fn no_device(
        &'static self,
        wanted: Option<&str>,
        found: Vec<String>,
    ) -> CameraError {
        let wanted = wanted.map(str::to_owned);
        self.error(Kind::NoDevice { wanted, found })
    }

    pub(super) fn unsuitable(
        &'static self,
        what: impl Into<String>,
        advice: impl Into<String>,
    ) -> CameraError {
        self.error(Kind::Unsuitable {
            what: what.into(),
            advice: advice.into(),
        })
    }

    pub(super) fn file_unusable(
        &'static self,
        path: &Path,
        what: impl Into<String>,
    ) -> CameraError {
        self.error(Kind::FileUnusable {
            path: path.to_path_buf(),
            what: what.into(),
        })
    }
}

impl CameraError {
    /// Adds the first of the library's messages.
    pub(super) fn quoting(self, messages: impl IntoIterator<Item = String>) -> Self {
        Self {
            message: messages.into_iter().next(),
            ..self
        }
    }

    /// True if no camera or file of this library can be used.
    pub fn is_about_library(&self) -> bool {
        matches!(
            self.kind,
            Kind::LibraryMissing { .. }
                | Kind::LibraryNotLoaded { .. }
                | Kind::LibraryLacks { .. }
                | Kind::LibraryNotStarted
        )
    }

    /// How to recover: a camera may be plugged in, released, permitted or updated at any time; a library, a setting or a file
    /// does not change by itself.
    pub fn recovery(&self) -> Recovery {
        match self.kind {
            Kind::NoDevice { .. }
            | Kind::NoPermission { .. }
            | Kind::Busy
            | Kind::InUse
            | Kind::NotOpened
            | Kind::NotStarted
            | Kind::Disconnected
            | Kind::NoFrames { .. }
            | Kind::NoDepth { .. } => Recovery::Reopen,
            Kind::BadFrame { .. } => Recovery::AskAgain,
            Kind::LibraryMissing { .. }
            | Kind::LibraryNotLoaded { .. }
            | Kind::LibraryLacks { .. }
            | Kind::LibraryNotStarted
            | Kind::Unsuitable { .. }
            | Kind::FileUnusable { .. } => Recovery::None,
        }
    }
}

impl std::error::Error for CameraError {}

impl Display for CameraError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let CameraLibrary {
            name,
            camera,
            cameras,
            presence,
            versions,
            file_names,
            ..
        } = self.library;
        let quoted = quoted(self.message.as_deref());
        match &self.kind {
            Kind::LibraryMissing { path: None } => {
                let files = first_names(file_names);
                write!(
                    f,
                    "{name}, the library for {cameras}, is not installed (looked for {files})"
                )
            }
            Kind::LibraryMissing { path: Some(path) } => {
                write!(f, "{}: {name} was not found there", path.display())
            }
            Kind::LibraryNotLoaded { file } => write!(f, "{file} cannot be loaded{quoted}"),
            Kind::LibraryLacks { file, function } => {
                write!(f, "{file} has no function {function}: not {versions}")
            }
            Kind::LibraryNotStarted => write!(f, "{name} cannot be started{quoted}"),
            Kind::NoDevice { wanted: None, .. } => write!(f, "no {camera} {presence}"),
            Kind::NoDevice {
                wanted: Some(wanted),
                found,
            } => write!(f, "no {camera} {wanted} {presence}{}", only(found)),
            Kind::NoPermission { .. } => write!(
                f,
                "the {camera} {presence}, but the system does not allow it to be opened"
            ),
            Kind::Busy => write!(f, "the {camera} is in use by another program"),
            Kind::InUse => write!(f, "the {camera} is in use by Partsight itself"),
            Kind::NotOpened => write!(f, "the {camera} cannot be opened{quoted}"),
            Kind::NotStarted => write!(f, "the {camera} cannot be started{quoted}"),
            Kind::Disconnected => write!(f, "the connection to the {camera} was lost{quoted}"),
            Kind::NoFrames { seconds } => write!(f, "the {camera} sent nothing for {seconds} s"),
            Kind::NoDepth { title } => write!(f, "{title} has no depth"),
            Kind::Unsuitable { what, .. } => f.write_str(what),
            Kind::BadFrame { what } => write!(f, "a frame of the {camera} cannot be used: {what}"),
            Kind::FileUnusable { path, what } => write!(f, "{}: {what}", path.display()),
        }
    }
}

impl Advice for CameraError {
    fn advice(&self) -> String {
        let CameraLibrary {
            name,
            camera,
            versions,
            install,
            variable,
            advice,
            ..
        } = self.library;
        let of_camera = match &self.kind {
            Kind::LibraryMissing { path: None } => {
                return format!(
                    "Install it ({install}), or set {variable} to the folder that holds it"
                );
            }
            Kind::LibraryMissing { path: Some(_) } => {
                return format!(
                    "Correct the source's library option or {variable}, or leave both out to use the system's {name}"
                );
            }
            Kind::LibraryNotLoaded { .. } => {
                return format!(
                    "Install the {name} of this system with all its dependencies ({install})"
                );
            }
            Kind::LibraryLacks { .. } => return format!("Install {versions} ({install})"),
            Kind::NoPermission { rule: Some(rule) } => {
                return format!(
                    "Add your user to the group plugdev, log in again and plug the {camera} in again, so that {rule} applies to it"
                );
            }
            Kind::NoPermission { rule: None } => {
                return format!(
                    "Install the udev rule that permits it ({install}), then plug the {camera} in again"
                );
            }
            Kind::Busy => {
                return format!("Close the other program that uses the {camera}, then try again");
            }
            Kind::Unsuitable { advice, .. } => return advice.clone(),
            Kind::InUse => "Use it where it is open already, or close it or its file there first",
            Kind::NoDepth { .. } => {
                "Use a depth camera, and update its firmware with its maker's RealSense Viewer"
            }
            Kind::BadFrame { .. } => {
                "Connect the camera to a port of its own; for a GigE camera, use jumbo frames (MTU 9000)"
            }
            Kind::FileUnusable { .. } => "Check the name, or copy or record the file again",
            Kind::LibraryNotStarted => advice.library_not_started,
            Kind::NoDevice { wanted: None, .. } => advice.no_device,
            Kind::NoDevice {
                wanted: Some(_), ..
            } => advice.other_devices,
            Kind::NotOpened => advice.not_opened,
            Kind::NotStarted => advice.not_started,
            Kind::Disconnected => advice.disconnected,
            Kind::NoFrames { .. } => advice.no_frames,
        };
        of_camera.replace("{install}", install)
    }
}

/// The file names, shortened: librealsense has one for each minor version.
fn first_names(names: &[&str]) -> String {
    match names {
        [first, second, third, _, ..] => format!("{first}, {second}, {third}, …"),
        names => names.join(", "),
    }
}

/// The rest of a message that names what was found instead: `, only A, B`; empty if nothing was found.
pub(super) fn only(found: &[String]) -> String {
    if found.is_empty() {
        String::new()
    } else {
        format!(", only {}", found.join(", "))
    }
}

/// The rest of a message that quotes a camera's library: `: no such device`; empty if the library gave no message.
pub(super) fn quoted(message: Option<&str>) -> String {
    message.map_or_else(String::new, |message| format!(": {message}"))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::camera_library::{ARAVIS, FREENECT, OPENNI, REALSENSE};

    fn one_of_each_kind() -> Vec<CameraErrorKind> {
        let file = || String::from("a.so");
        let what = || String::from("cut off");
        vec![
            Kind::LibraryMissing { path: None },
            Kind::LibraryMissing {
                path: Some("lib".into()),
            },
            Kind::LibraryNotLoaded { file: file() },
            Kind::LibraryLacks {
                file: file(),
                function: "start",
            },
            Kind::LibraryNotStarted,
            Kind::NoDevice {
                wanted: None,
                found: Vec::new(),
            },
            Kind::NoDevice {
                wanted: Some("A".into()),
                found: vec!["B".into()],
            },
            Kind::NoPermission { rule: None },
            Kind::NoPermission {
                rule: Some("/lib/udev/rules.d/60.rules"),
            },
            Kind::Busy,
            Kind::InUse,
            Kind::NotOpened,
            Kind::NotStarted,
            Kind::Disconnected,
            Kind::NoFrames { seconds: 5 },
            Kind::NoDepth { title: "It".into() },
            Kind::Unsuitable {
                what: what(),
                advice: "Record it again".into(),
            },
            Kind::BadFrame { what: what() },
            Kind::FileUnusable {
                path: "a.oni".into(),
                what: what(),
            },
        ]
    }

    #[test]
    fn of_each_library_every_error_has_a_sentence_and_an_advice_of_its_own() {
        for library in [&FREENECT, &ARAVIS, &OPENNI, &REALSENSE] {
            let errors = one_of_each_kind().into_iter().map(|kind| {
                let error = library.error(kind);
                let text = format!("{error}. {}", error.advice());
                assert!(!text.contains(['\n', '{']), "{text}");
                assert!(!error.advice().ends_with('.'), "{text}");
                error.advice()
            });
            let advice: Vec<String> = errors.collect();
            let distinct: BTreeSet<&String> = advice.iter().collect();
            assert_eq!(distinct.len(), advice.len(), "{distinct:?}");
        }
    }

    #[test]
    fn only_a_camera_may_come_back_by_itself() {
        for kind in one_of_each_kind() {
            let error = OPENNI.error(kind);
            let can_change = !error.is_about_library()
                && !matches!(
                    error.kind,
                    Kind::Unsuitable { .. } | Kind::FileUnusable { .. }
                );
            assert_eq!(error.recovery() != Recovery::None, can_change, "{error}");
        }
    }

    #[test]
    fn a_message_quotes_the_library_and_names_what_is_there_instead() {
        let error = OPENNI
            .error(Kind::NotOpened)
            .quoting(["no access".into(), "-3".into()]);
        assert_eq!(
            error.to_string(),
            "the OpenNI camera cannot be opened: no access"
        );
        assert!(
            error.advice().contains(OPENNI.install),
            "{}",
            error.advice()
        );
        let error = ARAVIS.error(Kind::NoDevice {
            wanted: Some("A".into()),
            found: vec!["B".into(), "C".into()],
        });
        assert_eq!(
            error.to_string(),
            "no GenICam camera A answers on any network interface or USB port, only B, C"
        );
    }
}
