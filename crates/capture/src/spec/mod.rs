//! Source specifications, as written on the command line, stored in the settings and listed to choose from.
//!
//! `KIND[,OPTION=VALUE...][:WHAT]`: everything after the first colon is taken literally, so that a folder's name may
//! contain anything. In an option's value `%2C`, `%3A` and `%25` stand for comma, colon and per cent sign.
//!
//! ```text
//! simulated   simulated:fender   simulated,side=right,noise=2:fender   simulated,every=6:line
//! simulated-robot:127.0.0.1:30200
//! recording:captures/monday      recording,pace=step:captures/monday
//! watch:/mnt/scanner             watch,from=all:/mnt/scanner
//! kinect      kinect:A00366813142045A
//! genicam     genicam:192.168.5.20              genicam,camera=scanner.json:Vendor-3D-1234
//! openni      openni:1d27/0601@1/5           openni,pace=as-taken:monday.oni
//! realsense   realsense,preset=High Accuracy:843112072752       realsense,pace=10:monday.db3
//! ```

mod genicam;
mod options;
mod realsense;
mod simulated;

use std::{
    fmt,
    net::SocketAddr,
    path::{Path, PathBuf},
    str::FromStr,
};

use serde::{Deserialize, Serialize};

pub use self::genicam::{GenicamFormat, GenicamSpec};
use self::options::{Options, escaped};
pub use self::realsense::RealsenseSpec;
pub use self::simulated::{CellScene, NUM_ON_RACK, SimulatedPose, SimulatedSpec};
use super::camera_error::CameraError;
use super::recording::is_sequence;
use super::robot_camera;
use geometry::error::Advice;

/// Specification of a source that can be opened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum SourceSpec {
    /// The simulated cell.
    Simulated(SimulatedSpec),
    /// The camera of a simulated robot, which is another program.
    SimulatedRobot(SocketAddr),
    /// A folder of frames to replay.
    Recording(RecordingSpec),
    /// A folder to which another program saves captures.
    Watched(WatchedSpec),
    /// A Kinect.
    Kinect(KinectSpec),
    /// A GenICam camera.
    Genicam(GenicamSpec),
    /// An OpenNI camera, or a file that OpenNI recorded.
    OpenNi(OpenNiSpec),
    /// A RealSense camera, or a file that librealsense recorded.
    Realsense(RealsenseSpec),
}

/// A source that can be opened now, or a kind of source and why it cannot.
#[derive(Debug)]
pub struct SourceListing {
    /// Title to show to the operator.
    pub title: String,
    /// The source to open; `None` if a person has to act first.
    pub spec: Option<SourceSpec>,
    /// Why it cannot be opened.
    pub error: Option<CameraError>,
}

impl SourceListing {
    pub(super) fn openable(title: String, spec: SourceSpec) -> Self {
        Self {
            title,
            spec: Some(spec),
            error: None,
        }
    }

    pub(super) fn unusable(error: CameraError) -> Self {
        Self {
            title: error.library.camera.to_owned(),
            spec: None,
            error: Some(error),
        }
    }
}

/// A folder of frames to replay.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordingSpec {
    /// A recording, an RGB-D sequence with a `depth.txt`, or a folder of clouds and depth images.
    pub folder: PathBuf,
    /// Pace of the replay; `None` for the caller's default.
    pub pace: Option<Pace>,
    /// File with the camera of a sequence of depth images, like the JSON beside a depth PNG; `None` for the folder's
    /// `intrinsics.json`.
    pub camera: Option<PathBuf>,
}

/// How fast frames are replayed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// With the original pauses, at most ten seconds each; frames without times come ten per second.
    AsTaken,
    /// Each as soon as it is requested.
    Step,
    /// Frames per second, above 0.
    PerSecond(f64),
}

/// A folder to which another program saves captures.
#[derive(Clone, Debug, PartialEq)]
pub struct WatchedSpec {
    /// The folder; it need not exist yet.
    pub folder: PathBuf,
    /// Which of its files are captured.
    pub from: WatchedFrom,
}

/// Which files of a watched folder are captured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WatchedFrom {
    /// Files that appear or change after the folder was opened.
    #[default]
    Now,
    /// Also files that were there before.
    All,
}

/// A Kinect.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct KinectSpec {
    /// Serial number of the camera; `None` for the first that is found.
    pub serial: Option<String>,
    /// File or folder with the libfreenect library; `None` for the system's.
    pub library: Option<PathBuf>,
}

/// An OpenNI camera, or a file that OpenNI recorded.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OpenNiSpec {
    /// OpenNI's URI of the camera, or the path of a file that ends in `.oni`; `None` for the first camera that is found.
    pub device: Option<String>,
    /// Pace of a file; `None` for each frame as soon as it is requested.
    pub pace: Option<Pace>,
    /// File or folder with the libOpenNI2 library; `None` for the system's.
    pub library: Option<PathBuf>,
}

impl OpenNiSpec {
    /// The file to play; `None` for a camera.
    pub fn file(&self) -> Option<&Path> {
        recorded_file(self.device.as_deref(), &["oni"])
    }
}

/// Returns `device` as a path if it has one of these file endings.
fn recorded_file<'a>(device: Option<&'a str>, endings: &[&str]) -> Option<&'a Path> {
    let path = Path::new(device?);
    let ending = path.extension()?;
    let mut endings = endings.iter();
    endings
        .any(|known| ending.eq_ignore_ascii_case(known))
        .then_some(path)
}

/// A text is not a valid source specification.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, Advice)]
pub enum SpecError {
    /// The kind of source is unknown.
    #[error(
        "{text:?} is not a source; expected one that begins with simulated, simulated-robot, recording, watch, kinect, \
         genicam, openni or realsense"
    )]
    #[advice(if Path::new(text).is_dir() {
        format!("Say what to do with the folder: recording:{text} to replay it, watch:{text} to wait for new files")
    } else {
        "List the sources: partsight capture --list".into()
    })]
    UnknownKind {
        /// The whole text.
        text: String,
    },
    /// The folder is missing.
    #[error("{text:?} names no folder")]
    #[advice("Put the folder after a colon, for example {}:captures", text.trim_end_matches(':'))]
    NoFolder {
        /// The whole text.
        text: String,
    },
    /// This kind of source has no such option.
    #[error("{kind} has no option {found:?}, expected {expected}")]
    #[advice(SEE_EXAMPLES)]
    UnknownOption {
        /// The kind of source.
        kind: &'static str,
        /// The option as given.
        found: String,
        /// Names of the options of this kind.
        expected: &'static str,
    },
    /// An option, or the part after the colon, has a wrong value.
    #[error("{what} {found:?}: expected {expected}")]
    #[advice(SEE_EXAMPLES)]
    BadValue {
        /// Name of the option.
        what: &'static str,
        /// The value as given.
        found: String,
        /// What values are valid.
        expected: String,
    },
}

const SEE_EXAMPLES: &str = "See partsight capture --help for examples";

const SIMULATED: &str = "simulated";
const SIMULATED_ROBOT: &str = "simulated-robot";
const RECORDING: &str = "recording";
const WATCH: &str = "watch";
const KINECT: &str = "kinect";
const GENICAM: &str = "genicam";
const OPENNI: &str = "openni";
const REALSENSE: &str = "realsense";

impl SourceSpec {
    /// True for the simulated cell or robot itself; whether a recording is simulated is stored in it.
    pub fn is_simulated(&self) -> bool {
        matches!(self, Self::Simulated(_) | Self::SimulatedRobot(_))
    }

    /// True for frames that were captured earlier: a recording, an RGB-D sequence, or a file that OpenNI or librealsense
    /// recorded.
    pub fn is_replayed(&self) -> bool {
        match self {
            Self::Recording(_) => true,
            Self::OpenNi(spec) => spec.file().is_some(),
            Self::Realsense(spec) => spec.file().is_some(),
            Self::Simulated(_)
            | Self::SimulatedRobot(_)
            | Self::Watched(_)
            | Self::Kinect(_)
            | Self::Genicam(_) => false,
        }
    }

    /// True for a camera, or a recording replayed like one, that runs whether its frames are taken or not, so that frames
    /// are dropped rather than queued.
    pub fn is_live(&self) -> bool {
        match self {
            Self::Simulated(_) | Self::SimulatedRobot(_) | Self::Kinect(_) | Self::Genicam(_) => {
                true
            }
            Self::Recording(RecordingSpec { pace, .. }) => is_running(*pace),
            Self::OpenNi(spec) => spec.file().is_none() || is_running(spec.pace),
            Self::Realsense(spec) => spec.file().is_none() || is_running(spec.pace),
            Self::Watched(_) => false,
        }
    }

    /// True if successive captures show the same part over time; false for a folder of independent captures.
    pub fn is_followed(&self) -> bool {
        match self {
            Self::Simulated(_)
            | Self::SimulatedRobot(_)
            | Self::Kinect(_)
            | Self::Genicam(_)
            | Self::OpenNi(_)
            | Self::Realsense(_) => true,
            Self::Recording(recording) => is_sequence(&recording.folder),
            Self::Watched(_) => false,
        }
    }

    /// Returns the source with this pace, if it is a recording without one.
    #[must_use]
    pub fn paced(mut self, pace: Pace) -> Self {
        match &mut self {
            Self::Recording(recording) => recording.pace = recording.pace.or(Some(pace)),
            Self::OpenNi(spec) if spec.file().is_some() => spec.pace = spec.pace.or(Some(pace)),
            Self::Realsense(spec) if spec.file().is_some() => {
                spec.pace = spec.pace.or(Some(pace));
            }
            _ => {}
        }
        self
    }

    /// Title to show to the operator before it is opened.
    pub fn title(&self) -> String {
        match self {
            Self::Simulated(spec) => spec.title(),
            Self::SimulatedRobot(at) => robot_camera::title(*at),
            Self::Recording(spec) => format!("Recording {}", spec.folder.display()),
            Self::Watched(spec) => format!("Folder {}", spec.folder.display()),
            Self::Genicam(spec) => spec.title(),
            Self::Realsense(spec) => spec.title(),
            Self::Kinect(KinectSpec { serial: None, .. }) => "Kinect".into(),
            Self::Kinect(KinectSpec {
                serial: Some(serial),
                ..
            }) => format!("Kinect {serial}"),
            Self::OpenNi(spec) => match (spec.file(), &spec.device) {
                (Some(file), _) => format!("Recording {}", file.display()),
                (None, Some(uri)) => format!("OpenNI camera {uri}"),
                (None, None) => "OpenNI camera".into(),
            },
        }
    }
}

/// True for a replay that runs by itself.
fn is_running(pace: Option<Pace>) -> bool {
    matches!(pace, Some(Pace::AsTaken | Pace::PerSecond(_)))
}

impl FromStr for SourceSpec {
    type Err = SpecError;

    fn from_str(text: &str) -> Result<Self, SpecError> {
        let (head, what) = match text.split_once(':') {
            Some((head, what)) => (head, Some(what).filter(|what| !what.is_empty())),
            None => (text, None),
        };
        let (kind, options) = head.split_once(',').unwrap_or((head, ""));
        let folder = || {
            let text = text.to_owned();
            what.map(PathBuf::from).ok_or(SpecError::NoFolder { text })
        };
        match kind {
            SIMULATED => {
                let options = Options::split(SIMULATED, options, SimulatedSpec::OPTIONS)?;
                SimulatedSpec::read(what, &options).map(Self::Simulated)
            }
            SIMULATED_ROBOT => {
                let at = what.filter(|_| options.is_empty());
                let at = at.and_then(|at| at.parse().ok());
                at.map(Self::SimulatedRobot)
                    .ok_or_else(|| SpecError::BadValue {
                        what: "simulated robot",
                        found: text.to_owned(),
                        expected: "the IP address and port of its camera, as in simulated-robot:127.0.0.1:30200"
                            .to_owned(),
                    })
            }
            RECORDING => {
                let options = Options::split(RECORDING, options, "pace camera")?;
                Ok(Self::Recording(RecordingSpec {
                    folder: folder()?,
                    pace: Pace::of_option(&options)?,
                    camera: options.value("camera", "a file", |path| Some(PathBuf::from(path)))?,
                }))
            }
            WATCH => {
                let options = Options::split(WATCH, options, "from")?;
                let from = options.value("from", "now or all", |word| match word {
                    "now" => Some(WatchedFrom::Now),
                    "all" => Some(WatchedFrom::All),
                    _ => None,
                })?;
                Ok(Self::Watched(WatchedSpec {
                    folder: folder()?,
                    from: from.unwrap_or_default(),
                }))
            }
            KINECT => {
                let options = Options::split(KINECT, options, "library")?;
                Ok(Self::Kinect(KinectSpec {
                    serial: what.map(str::to_owned),
                    library: options
                        .value("library", "a path", |path| Some(PathBuf::from(path)))?,
                }))
            }
            GENICAM => {
                let options = Options::split(GENICAM, options, GenicamSpec::OPTIONS)?;
                GenicamSpec::read(what, &options).map(Self::Genicam)
            }
            OPENNI => {
                let options = Options::split(OPENNI, options, "pace library")?;
                let spec = OpenNiSpec {
                    device: what.map(str::to_owned),
                    pace: Pace::of_option(&options)?,
                    library: options
                        .value("library", "a path", |path| Some(PathBuf::from(path)))?,
                };
                if spec.pace.is_some() && spec.file().is_none() {
                    return Err(SpecError::BadValue {
                        what: "openni with a pace",
                        found: what.unwrap_or_default().to_owned(),
                        expected: "a file that ends in .oni".to_owned(),
                    });
                }
                Ok(Self::OpenNi(spec))
            }
            REALSENSE => {
                let options = Options::split(REALSENSE, options, RealsenseSpec::OPTIONS)?;
                RealsenseSpec::read(what, &options).map(Self::Realsense)
            }
            _ => Err(SpecError::UnknownKind {
                text: text.to_owned(),
            }),
        }
    }
}

impl Pace {
    fn of_option(options: &Options) -> Result<Option<Self>, SpecError> {
        options.value("pace", "as-taken, step, or frames a second", Self::of_name)
    }

    fn of_name(word: &str) -> Option<Self> {
        match word {
            "as-taken" => Some(Self::AsTaken),
            "step" => Some(Self::Step),
            number => {
                let rate = number.parse::<f64>().ok()?;
                (rate > 0.0 && rate.is_finite()).then_some(Self::PerSecond(rate))
            }
        }
    }
}

/// Writes the form that [`SourceSpec::from_str`] reads, without default values.
impl fmt::Display for SourceSpec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Simulated(spec) => spec.write(f),
            Self::SimulatedRobot(at) => write!(f, "{SIMULATED_ROBOT}:{at}"),
            Self::Recording(RecordingSpec {
                folder,
                pace,
                camera,
            }) => {
                f.write_str(RECORDING)?;
                write_pace(f, *pace)?;
                if let Some(camera) = camera {
                    write!(f, ",camera={}", escaped(&camera.to_string_lossy()))?;
                }
                write!(f, ":{}", folder.display())
            }
            Self::Watched(WatchedSpec { folder, from }) => {
                f.write_str(WATCH)?;
                if *from == WatchedFrom::All {
                    f.write_str(",from=all")?;
                }
                write!(f, ":{}", folder.display())
            }
            Self::Genicam(spec) => spec.write(f),
            Self::Realsense(spec) => spec.write(f),
            Self::Kinect(KinectSpec { serial, library }) => {
                f.write_str(KINECT)?;
                write_camera(f, library.as_deref(), serial.as_deref())
            }
            Self::OpenNi(OpenNiSpec {
                device,
                pace,
                library,
            }) => {
                f.write_str(OPENNI)?;
                write_pace(f, *pace)?;
                write_camera(f, library.as_deref(), device.as_deref())
            }
        }
    }
}

fn write_pace(f: &mut fmt::Formatter<'_>, pace: Option<Pace>) -> fmt::Result {
    match pace {
        None => Ok(()),
        Some(Pace::AsTaken) => f.write_str(",pace=as-taken"),
        Some(Pace::Step) => f.write_str(",pace=step"),
        Some(Pace::PerSecond(rate)) => write!(f, ",pace={rate}"),
    }
}

/// Writes the library option of a camera, and which camera it is.
fn write_camera(
    f: &mut fmt::Formatter<'_>,
    library: Option<&Path>,
    device: Option<&str>,
) -> fmt::Result {
    if let Some(library) = library {
        write!(f, ",library={}", escaped(&library.to_string_lossy()))?;
    }
    device.map_or(Ok(()), |device| write!(f, ":{device}"))
}

impl TryFrom<String> for SourceSpec {
    type Error = SpecError;

    fn try_from(text: String) -> Result<Self, SpecError> {
        text.parse()
    }
}

impl From<SourceSpec> for String {
    fn from(spec: SourceSpec) -> Self {
        spec.to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> SourceSpec {
        text.parse()
            .unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    #[test]
    fn what_is_written_is_read_again() {
        for text in [
            "simulated",
            "simulated:fender",
            "simulated:empty",
            "simulated:hood",
            "simulated,every=6:line",
            "simulated:rack",
            "simulated,every=12:rack",
            "simulated:conveyor",
            "simulated,speed=250:conveyor",
            "simulated,side=right,model=3,pose=hard,noise=0.5,clutter=in-front,seed=9,fps=12:front_door",
            "simulated,pose=0 0 15deg 0 0 1.2:grille",
            "simulated-robot:127.0.0.1:30200",
            "simulated-robot:[::1]:30200",
            "recording:captures/monday",
            "recording,pace=step:C:\\captures, old",
            "recording,pace=2.5:a",
            "recording,pace=as-taken,camera=my.json:a",
            "watch:/mnt/scanner",
            "watch,from=all:/mnt/scanner",
            "kinect",
            "kinect:A00366813142045A",
            "kinect,library=/opt/a%2Cb%3Ac%25/lib:A0",
            "genicam",
            "genicam:192.168.5.20",
            "genicam,format=Mono16,camera=my camera.json,library=/opt/a%2Cb:Vendor, 3D:1",
            "openni",
            "openni:1d27/0601@1/5",
            "openni,library=/opt/ni2:C:\\monday, 1.oni",
            "openni,pace=2.5:monday.ONI",
            "realsense",
            "realsense:843112072752",
            "realsense,preset=High Accuracy,library=/opt/rs:843112072752",
            "realsense,pace=step:C:\\monday, 1.bag",
            "realsense,pace=2.5:monday.DB3",
        ] {
            assert_eq!(read(text).to_string(), text);
            let json = serde_json::to_string(&read(text)).unwrap();
            assert_eq!(
                serde_json::from_str::<SourceSpec>(&json).unwrap(),
                read(text)
            );
        }
    }

    #[test]
    fn what_is_meant_is_understood() {
        assert_eq!(
            read("kinect,library=/opt/a%2Cb%3Ac%25/lib:A0"),
            SourceSpec::Kinect(KinectSpec {
                serial: Some("A0".into()),
                library: Some("/opt/a,b:c%/lib".into()),
            })
        );
        let paced = read("recording:x").paced(Pace::Step);
        assert_eq!(paced, read("recording,pace=step:x"));
        assert_eq!(
            read("recording,pace=3:x").paced(Pace::Step),
            read("recording,pace=3:x")
        );
        assert!(!paced.is_live() && read("recording,pace=3:x").is_live());
        assert!(read("simulated").is_live() && !read("watch:x").is_live());
        let camera = read("openni:1d27/0601@1/5");
        assert!(camera.is_live() && camera.clone().paced(Pace::Step) == camera);
        let file = read("openni:a.oni");
        assert!(!file.is_live() && file.is_followed());
        assert!(file.paced(Pace::AsTaken).is_live());
        let camera = read("realsense:843112072752");
        assert!(camera.is_live() && camera.clone().paced(Pace::Step) == camera);
        for text in ["realsense:a.bag", "realsense:a.db3"] {
            let file = read(text);
            assert!(!file.is_live() && file.is_followed());
            assert_eq!(file.title(), text.replace("realsense:", "Recording "));
            assert!(file.paced(Pace::AsTaken).is_live());
        }
    }

    #[test]
    fn nonsense_is_refused_in_words() {
        for (text, words) in [
            ("camera", "is not a source"),
            ("", "is not a source"),
            ("watch", "names no folder"),
            ("recording:", "names no folder"),
            ("recording,pace=0:x", "frames a second"),
            ("recording,pace=-1:x", "frames a second"),
            ("recording,pace=inf:x", "frames a second"),
            ("genicam,format=Mono8", "Mono16 if it is depth"),
            ("genicam,camera=:x", "expected a file"),
            ("genicam,scale=1", "format camera library"),
            ("watch,speed=3:x", "has no option \"speed\""),
            ("simulated:bonnet", "expected"),
            ("simulated,noise=9", "from 0 to 5"),
            ("simulated,speed=2:conveyor", "from 5 to 1000"),
            ("simulated,noise=NaN", "from 0 to 5"),
            ("simulated,fps=0", "frames a second"),
            ("simulated,pose=1 2 3", "six"),
            ("simulated-robot:30200", "127.0.0.1:30200"),
            ("simulated-robot,fps=3:127.0.0.1:1", "127.0.0.1:30200"),
            ("openni,pace=step", "ends in .oni"),
            ("openni,pace=step:1d27/0601@1/5", "ends in .oni"),
            ("openni,pace=0:a.oni", "frames a second"),
            ("realsense,pace=step:843112072752", "ends in .bag or .db3"),
            ("realsense,preset=Default:a.bag", "a camera and no file"),
            ("realsense,preset=", "expected a name"),
            ("realsense,format=Z16", "preset pace library"),
        ] {
            let error = text.parse::<SourceSpec>().expect_err(text);
            assert!(error.to_string().contains(words), "{text}: {error}");
            assert!(!error.advice().is_empty());
        }
        let here = ".".parse::<SourceSpec>().expect_err("a folder");
        assert!(here.advice().contains("recording:."), "{}", here.advice());
    }
}
