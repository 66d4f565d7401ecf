//! Unit and axes of a cloud or a mesh, written behind its path: `part.stl#units=mm#up=z`.
//!
//! Like the name of a mesh they are part of the path, so that they are kept wherever the path is: in lists of recent files,
//! the history, reports and settings.

use std::path::{Path, PathBuf};

use nalgebra::{Point3, Vector3};

use super::content::FileContent;
use geometry::error::Advice;

/// The unit of a file's lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LengthUnit {
    /// Metres, as inside the program.
    #[default]
    Metres,
    /// Centimetres.
    Centimetres,
    /// Millimetres.
    Millimetres,
    /// Inches of 25.4 mm.
    Inches,
}

impl LengthUnit {
    /// Every unit.
    pub const ALL: [Self; 4] = [
        Self::Metres,
        Self::Centimetres,
        Self::Millimetres,
        Self::Inches,
    ];

    /// Returns the name used behind a path and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Metres => "m",
            Self::Centimetres => "cm",
            Self::Millimetres => "mm",
            Self::Inches => "in",
        }
    }

    /// Returns the unit of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| unit.name() == name)
    }

    /// Returns its length in metres.
    pub fn metres(self) -> f32 {
        match self {
            Self::Metres => 1.0,
            Self::Centimetres => 0.01,
            Self::Millimetres => 0.001,
            Self::Inches => 0.0254,
        }
    }
}

/// The axis of a file that points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum UpAxis {
    /// y points down, z away from the camera: camera space.
    #[default]
    MinusY,
    /// y points up, z towards the viewer: OpenGL, glTF.
    PlusY,
    /// z points up, y away from the viewer: CAD and robots.
    PlusZ,
}

impl UpAxis {
    /// Every axis.
    pub const ALL: [Self; 3] = [Self::MinusY, Self::PlusY, Self::PlusZ];

    /// Returns the name used behind a path and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::MinusY => "-y",
            Self::PlusY => "y",
            Self::PlusZ => "z",
        }
    }

    /// Returns the axis of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|up| up.name() == name)
    }

    /// Rotates into camera space: x right, y down, z away. Being a rotation, it keeps the sides of a surface.
    fn to_camera(self, v: Vector3<f32>) -> Vector3<f32> {
        match self {
            Self::MinusY => v,
            Self::PlusY => Vector3::new(v.x, -v.y, -v.z),
            Self::PlusZ => Vector3::new(v.x, -v.z, v.y),
        }
    }
}

/// Unit and axes of a cloud or a mesh. Depth images state their own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ImportOptions {
    /// The unit of its lengths.
    pub unit: LengthUnit,
    /// The axis that points up.
    pub up: UpAxis,
}

/// An import option behind a path has an unknown value.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, Advice)]
#[error("not an import option: {0:?}")]
#[advice = "Write #units=m, cm, mm or in, and #up=-y, y or z after the path"]
pub struct BadImportOption(pub String);

impl ImportOptions {
    /// Lengths in millimetres, axes as in camera space.
    pub const MILLIMETRES: Self = Self {
        unit: LengthUnit::Millimetres,
        up: UpAxis::MinusY,
    };

    /// Applies one word behind a path; returns false if it is not an option but the name of a mesh.
    pub(super) fn take(&mut self, word: &str) -> Result<bool, BadImportOption> {
        let bad = || BadImportOption(word.to_owned());
        match word.split_once('=') {
            Some(("units", name)) => self.unit = LengthUnit::named(name).ok_or_else(bad)?,
            Some(("up", name)) => self.up = UpAxis::named(name).ok_or_else(bad)?,
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// Returns the text to write behind a path; empty for the defaults.
    pub fn suffix(self) -> String {
        let unit = (self.unit != LengthUnit::default()).then(|| ["#units=", self.unit.name()]);
        let up = (self.up != UpAxis::default()).then(|| ["#up=", self.up.name()]);
        [unit, up].into_iter().flatten().flatten().collect()
    }

    /// Converts points to metres and camera space.
    pub fn convert(self, points: &mut [Point3<f32>]) {
        let scale = self.unit.metres();
        for point in points {
            point.coords = self.up.to_camera(point.coords * scale);
        }
    }

    /// Converts the content to metres and camera space. A depth image already is.
    pub(super) fn applied(self, mut content: FileContent) -> FileContent {
        if self == Self::default() {
            return content;
        }
        let (points, normals) = match &mut content {
            FileContent::Cloud(cloud) => (&mut cloud.points, cloud.normals.as_mut()),
            FileContent::Mesh(mesh) => (&mut mesh.vertices, None),
            FileContent::Depth(_) => return content,
        };
        self.convert(points);
        for normal in normals.into_iter().flatten() {
            *normal = self.up.to_camera(*normal);
        }
        content
    }
}

/// Returns the file that [`open`](super::open()) reads at `path`, without the words behind it.
pub fn file_of(path: &Path) -> PathBuf {
    split_words(path).0
}

/// Splits a path into the file and the words behind it: the longest part before a `#` that is a file.
pub(super) fn split_words(path: &Path) -> (PathBuf, Option<String>) {
    let whole = (path.to_owned(), None);
    if path.exists() {
        return whole;
    }
    // A path that is not Unicode cannot be split, but works as a whole.
    let Some(text) = path.to_str() else {
        return whole;
    };
    let mut splits = text.rmatch_indices('#').map(|(at, _)| text.split_at(at));
    splits
        .find(|(file, _)| Path::new(file).is_file())
        .map_or(whole, |(file, name)| {
            (file.into(), Some(name.trim_start_matches('#').to_owned()))
        })
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::{FileError, FileWarning, open};

    /// Opens a file of points with the options in `suffix`.
    fn opened(text: &str, suffix: &str) -> Result<FileContent, FileError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.xyz");
        fs::write(&path, text).unwrap();
        open(&PathBuf::from(format!("{}{suffix}", path.display())))
    }

    fn first(text: &str, suffix: &str) -> Point3<f32> {
        let Ok(FileContent::Cloud(cloud)) = opened(text, suffix) else {
            panic!("a cloud");
        };
        cloud.points[0]
    }

    #[test]
    fn lengths_come_in_metres_and_axes_as_a_camera_has_them() {
        let text = "100 200 1500\n0 0 1\n0 1 1\n";
        let expected = [
            ("#units=mm", [0.1, 0.2, 1.5]),
            ("#units=cm", [1.0, 2.0, 15.0]),
            ("#units=in", [2.54, 5.08, 38.1]),
            ("#up=y", [100.0, -200.0, -1500.0]),
            ("#up=z", [100.0, -1500.0, 200.0]),
            ("#units=mm#up=z", [0.1, -1.5, 0.2]),
        ];
        for (suffix, at) in expected {
            let off = (first(text, suffix) - Point3::from(at)).norm();
            assert!(off < 1e-5, "{suffix}: {off}");
        }
        assert_eq!(first(text, "#up=-y#units=m"), first(text, ""));
    }

    #[test]
    fn the_file_is_the_path_without_the_words() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("part#2.xyz");
        fs::write(&path, "0 0 1\n").unwrap();
        let with_words = PathBuf::from(format!("{}#units=mm#up=z", path.display()));
        assert_eq!(file_of(&with_words), path);
        assert_eq!(file_of(&path), path);
    }

    #[test]
    fn read_as_millimetres_a_wide_file_is_not_warned_about_any_more() {
        let text = "0 0 1000\n900 0 1000\n0 500 1000\n";
        let warnings = |suffix| opened(text, suffix).unwrap().warnings();
        assert!(matches!(
            warnings("")[..],
            [FileWarning::TooWideForMetres { .. }]
        ));
        assert_eq!(warnings("#units=mm"), []);
    }

    #[test]
    fn a_word_that_is_no_option_is_named_with_those_there_are() {
        for word in ["#units=furlong", "#up=x", "#units="] {
            let error = opened("0 0 1\n", word).expect_err(word);
            assert!(error.to_string().contains(&word[1..]), "{error}");
            assert!(
                error.advice().contains("#units=m, cm, mm or in"),
                "{}",
                error.advice()
            );
        }
    }

    #[test]
    fn a_suffix_says_what_is_unusual() {
        let options = ImportOptions {
            unit: LengthUnit::Millimetres,
            up: UpAxis::PlusZ,
        };
        assert_eq!(options.suffix(), "#units=mm#up=z");
        assert_eq!(ImportOptions::default().suffix(), "");
        let mut read = ImportOptions::default();
        for word in options.suffix().split('#').skip(1) {
            assert_eq!(read.take(word), Ok(true));
        }
        assert_eq!(read, options);
        assert_eq!(read.take("Door_FL"), Ok(false));
    }
}
