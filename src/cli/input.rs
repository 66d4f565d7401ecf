//! Inputs of the commands: scenes, clouds, and robot poses and conventions as arguments.

use std::{
    ops::RangeInclusive,
    path::{Path, PathBuf},
    sync::{Arc, mpsc},
    thread,
};

use clap::{
    Args,
    builder::{PossibleValue, PossibleValuesParser, TypedValueParser},
};

use super::console::{Advised as _, Console, advised_error, with_advice};
use capture::{CaptureError, CaptureWarning, Captured, read_image};
use files::{
    self, DepthCamera, FileError, FileWarning,
    import::{ImportOptions, LengthUnit, UpAxis},
};
use geometry::{cloud::PointCloud, error::Advice};
use inspection::library::{LibraryFolder, PartName, Side};
use records::cases::CaseFolder;
use robot::{Convention, WrittenPose, parse_nozzle, parse_written_pose};
use stages::scene::{EmptyCell, SceneCloud, cloud_of, scene_from_image};
use station::CameraScenes;
use texts::Message;

/// Why a command cannot use a file.
#[derive(Debug, thiserror::Error, Advice)]
pub enum InputError {
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    #[advice(match _0 {
        CaptureError::CaptureWithFaces { .. } => {
            FileAdvice(&FileWarning::CaptureWithFaces.into()).advice()
        }
        other => other.advice(),
    })]
    Capture(#[from] CaptureError),
    #[error("{}", no_area(path))]
    #[advice(no_area(path).command_advice())]
    EmptyMesh { path: String },
}

fn no_area(path: &str) -> Message {
    Message::new("mesh-no-area").with("path", path)
}

/// A value of an option: its name, its line in `--help`, and what it stands for.
pub type Choice<T> = (&'static str, &'static str, T);

/// Parses the name of one of `choices`.
pub fn choice<T: Copy + Send + Sync + 'static>(
    choices: &'static [Choice<T>],
) -> impl TypedValueParser<Value = T> {
    let names = choices
        .iter()
        .map(|(name, help, _)| PossibleValue::new(*name).help((!help.is_empty()).then_some(*help)));
    PossibleValuesParser::new(names).try_map(|given| {
        let chosen = choices.iter().find(|(name, ..)| *name == given);
        chosen.map(|(.., value)| *value).ok_or("unknown value")
    })
}

/// How the numbers of clouds and meshes are meant.
#[derive(Debug, Args)]
pub(super) struct ImportChoice {
    /// Unit of clouds and meshes; a depth image gives its own
    #[arg(long, value_name = "UNIT", default_value = "m", value_parser = one_of(LengthUnit::ALL.map(LengthUnit::name)))]
    units: String,
    /// Axis of clouds and meshes that points up: -y for cameras, y for OpenGL, z for CAD and robots
    #[arg(long, value_name = "AXIS", default_value = "-y", allow_hyphen_values = true, value_parser = one_of(UpAxis::ALL.map(UpAxis::name)))]
    up: String,
}

fn one_of<const N: usize>(names: [&'static str; N]) -> PossibleValuesParser {
    PossibleValuesParser::new(names)
}

impl ImportChoice {
    /// Appends the options to the paths, where opening a file reads them.
    pub(super) fn write_behind<'a>(&self, paths: impl IntoIterator<Item = &'a mut PathBuf>) {
        let options = ImportOptions {
            unit: LengthUnit::named(&self.units).unwrap_or_default(),
            up: UpAxis::named(&self.up).unwrap_or_default(),
        };
        for path in paths {
            path.as_mut_os_string().push(options.suffix());
        }
    }
}

/// Advice on a file for the command line, which names the option to use.
struct FileAdvice<'a>(&'a CaptureWarning);

impl Advice for FileAdvice<'_> {
    fn advice(&self) -> String {
        let CaptureWarning::File(warning) = self.0 else {
            return self.0.advice();
        };
        match warning {
            FileWarning::TooWideForMetres { extent } if extent.0 < files::ONLY_MILLIMETRES_M => format!(
                "Give the unit that makes its size right: --units mm ({:.1} m), cm ({:.1} m) or in ({:.1} m), or \
                 #units=mm after its path",
                extent.0 * 0.001,
                extent.0 * 0.01,
                extent.0 * 0.0254,
            ),
            FileWarning::TooWideForMetres { .. } => {
                "Read it as millimetres: --units mm, or #units=mm after its path".into()
            }
            FileWarning::TooSmall { .. } => {
                "Give the unit that the file is in, probably metres: --units m, or #units=m after its path".into()
            }
            FileWarning::CaptureWithFaces => {
                "Read it with --up y, or #up=y after its path, or save it again without faces".into()
            }
            other => other.advice(),
        }
    }
}

/// Shows the warnings about a file, and about the camera of a depth image.
pub(super) fn warn_of(path: &Path, warnings: &[CaptureWarning], console: &Console) {
    for warning in warnings {
        console.warn(
            &format_args!("{}: {warning}", path.display()),
            &FileAdvice(warning),
        );
    }
    for field in DepthCamera::misspelt_fields(path) {
        console.warn(&field, &field);
    }
}

/// A captured scene and the warnings about its file.
pub type OpenedScene = Result<(SceneCloud, Vec<CaptureWarning>), InputError>;

/// Scenes as they are opened, with the paths of their files.
pub(super) type Scenes<'a> = mpsc::IntoIter<(&'a Path, OpenedScene)>;

/// Opens scenes one ahead: the first while `work` still prepares, each next one while one is inspected. They come in
/// the order of their files.
pub(super) fn open_ahead<T>(files: &[PathBuf], work: impl FnOnce(Scenes<'_>) -> T) -> T {
    thread::scope(|scope| {
        let (hand_over, opened) = mpsc::sync_channel(0);
        scope.spawn(move || {
            for path in files {
                // Sending fails once the work was given up.
                if hand_over.send((&**path, open_scene(path))).is_err() {
                    return;
                }
            }
        });
        work(opened.into_iter())
    })
}

/// Opens a captured scene.
pub fn open_scene(path: &Path) -> OpenedScene {
    let (image, warnings) = read_image(path)?;
    Ok((scene_from_image(image), warnings))
}

/// Parses the name of a part or a recipe for clap: the error for a bad one states the rule.
pub(super) fn parse_name(name: &str) -> Result<PartName, String> {
    PartName::new(name).map_err(|error| with_advice(&error))
}

/// Parses a pose in a robot's convention for clap.
pub(super) fn parse_robot_pose(text: &str) -> Result<WrittenPose, String> {
    parse_written_pose(text).map_err(|error| with_advice(&error))
}

/// Parses the pose of a nozzle on the flange for clap.
pub(super) fn parse_nozzle_pose(text: &str) -> Result<WrittenPose, String> {
    parse_nozzle(text).map_err(|error| with_advice(&error))
}

/// Parses the name of a part's side for clap.
pub(super) fn parse_side(name: &str) -> Result<Side, String> {
    let names = || Side::ALL.map(Side::name).join(", ");
    Side::named(name).ok_or_else(|| format!("expected one of {}", names()))
}

/// Parses the name of a convention for clap.
pub(super) fn parse_convention(name: &str) -> Result<Convention, String> {
    Convention::by_name(name).ok_or_else(|| {
        let names: Vec<&str> = Convention::ALL
            .iter()
            .map(|convention| convention.name())
            .collect();
        format!("expected one of {}", names.join(", "))
    })
}

#[derive(Debug, Args)]
pub(super) struct EmptyCellChoice {
    /// Capture of the empty cell by the same camera: nothing in it is taken for a part
    #[arg(long, value_name = "FILE")]
    empty_cell: Option<PathBuf>,
}

impl EmptyCellChoice {
    pub(super) fn open(&self, console: &Console) -> anyhow::Result<Option<Arc<EmptyCell>>> {
        let Some(path) = &self.empty_cell else {
            return Ok(None);
        };
        let (scene, warnings) = open_scene(path).advised()?;
        for warning in &warnings {
            console.warn(warning, &FileAdvice(warning));
        }
        Ok(Some(Arc::new(EmptyCell::from_scene(&scene).advised()?)))
    }
}

/// Attaches the empty cell to a scene, with a warning if it is from another camera.
pub(super) fn before(
    scene: &mut SceneCloud,
    cell: Option<&Arc<EmptyCell>>,
    name: &str,
    console: &Console,
) {
    scene.empty_cell = cell.cloned();
    if let Err(other) = scene.fitting_empty_cell() {
        console.warn(&format_args!("{name}: {other}"), &other);
    }
}

/// Makes the scene of a capture from a source, and shows its warnings.
pub(super) fn scene_of(
    captured: Captured,
    scenes: &mut CameraScenes,
    console: &Console,
) -> SceneCloud {
    let name = &captured.name;
    for warning in scenes.warnings(&captured) {
        console.warn(&format_args!("{name}: {warning}"), warning);
    }
    let scene = scenes.next(captured.image);
    if let Some(other) = scenes.misfit(&scene) {
        console.warn(&format_args!("{name}: {other}"), &other);
    }
    scene
}

/// The folder to write cases into; refuses one that holds parts.
pub(super) fn open_case_folder(path: &Path) -> anyhow::Result<CaseFolder> {
    if LibraryFolder::open(path).is_ok_and(|folder| folder.is_in_use()) {
        return Err(advised_error(
            format!("{} holds parts of a library", path.display()),
            "Give another folder for the cases",
        ));
    }
    Ok(CaseFolder::at(path))
}

/// Opens any file with points; a mesh is sampled evenly.
pub(super) fn open_cloud(path: &Path) -> Result<(PointCloud, Vec<CaptureWarning>), InputError> {
    let opened = files::open(path)?;
    let warnings = opened.warnings().into_iter().map(Into::into).collect();
    let cloud = cloud_of(opened).ok_or_else(|| InputError::EmptyMesh {
        path: path.display().to_string(),
    })?;
    Ok((cloud, warnings))
}

/// Parses a number within a range for clap.
pub(super) fn within(text: &str, range: &RangeInclusive<f64>) -> Result<f64, String> {
    let number = text.parse::<f64>().ok();
    number
        .filter(|number| range.contains(number))
        .ok_or_else(|| format!("expected a number from {}", from_to(range)))
}

/// Formats a range.
pub(super) fn from_to(range: &RangeInclusive<f64>) -> String {
    format!("{} to {}", range.start(), range.end())
}
