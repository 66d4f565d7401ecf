//! Folder of reports: written by `inspect --report` and by the window's export.

use std::{
    collections::BTreeSet,
    io,
    path::{Path, PathBuf},
};

use super::pictures::{Picture, strip, write_png};
use files::{FileError, advice_on, disk, words_of, write_atomically, write_text};
use geometry::error::Advice;
use robot::Convention;

/// Why a report could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The folder cannot be created.
    #[error("{}: cannot make the report's folder: {}", path.display(), words_of(source))]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The underlying error.
        source: io::Error,
    },
    /// A file cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
}

impl Advice for ReportError {
    fn advice(&self) -> String {
        match self {
            Self::Folder { source, .. } => advice_on(source).into(),
            Self::File(error) => error.advice(),
        }
    }
}

/// A folder for the results of inspections, next to the captures or elsewhere.
///
/// Each inspected file gets `STEM.report.json`, a `STEM.STAGE.png` per stage, and `STEM.stages.png` with all of them; of the
/// other parts of its frame `STEM.NUMBER.STAGE.png`.
/// Files of an earlier report under these names are replaced; a depth image and its camera never are.
#[derive(Debug)]
pub struct ReportFolder {
    path: PathBuf,
    /// Stems in use, so that files of the same name from different folders do not overwrite each other.
    taken: BTreeSet<String>,
    /// Stems in use by pose reports.
    taken_poses: BTreeSet<String>,
}

impl ReportFolder {
    /// Creates the folder if it is missing.
    pub fn make(path: &Path) -> Result<Self, ReportError> {
        disk::create_dir_all(path).map_err(|source| ReportError::Folder {
            path: path.to_owned(),
            source,
        })?;
        Ok(Self {
            path: path.to_owned(),
            taken: BTreeSet::new(),
            taken_poses: BTreeSet::new(),
        })
    }

    /// Writes the report of a scene, and returns the path of its JSON; `line` is an
    /// [`InspectionLine`](super::InspectionLine).
    pub fn write(
        &mut self,
        scene: &Path,
        line: &str,
        pictures: &[Picture],
    ) -> Result<PathBuf, ReportError> {
        let of_parts = pictures.chunk_by(|one, next| one.part == next.part);
        let strips = of_parts.map(|pictures| Picture {
            part: pictures[0].part,
            stage: "stages",
            image: strip(pictures),
        });
        let strips: Vec<Picture> = strips.collect();
        let pictures: Vec<&Picture> = pictures.iter().chain(&strips).collect();
        let stem = self.free_stem(scene, &pictures);
        let json = self.json(&stem);
        write_text(&json, &format!("{line}\n"))?;
        for picture in pictures {
            write_png(&self.picture(&stem, picture), &picture.image)?;
        }
        Ok(json)
    }

    /// Writes the pose report of a scene as `STEM.pose.ENDING` for each ending, and returns the paths.
    pub fn write_pose(
        &mut self,
        scene: &Path,
        files: &[(&str, Vec<u8>)],
    ) -> Result<Vec<PathBuf>, ReportError> {
        let path = |stem: &str, ending: &str| self.path.join(format!("{stem}.pose.{ending}"));
        // A depth image of this name would take the report's JSON for its camera.
        let is_free = |stem: &str| !path(stem, "png").exists() && !self.taken_poses.contains(stem);
        let stem = counted(scene)
            .find(|stem| is_free(stem))
            .unwrap_or_default();
        let mut paths = Vec::new();
        for (ending, bytes) in files {
            let path = path(&stem, ending);
            write_atomically(&path, |writer| writer.write_all(bytes))?;
            paths.push(path);
        }
        self.taken_poses.insert(stem);
        Ok(paths)
    }

    /// Returns the CSV file that collects the pose reports in one convention.
    pub fn csv(&self, convention: Convention) -> PathBuf {
        self.path.join(format!("poses.{}.csv", convention.name()))
    }

    fn json(&self, stem: &str) -> PathBuf {
        self.path.join(format!("{stem}.report.json"))
    }

    fn picture(&self, stem: &str, picture: &Picture) -> PathBuf {
        let (stem, stage) = (stem_of_part(stem, picture), picture.stage);
        self.path.join(format!("{stem}.{stage}.png"))
    }

    fn free_stem(&mut self, scene: &Path, pictures: &[&Picture]) -> String {
        // Those of its parts, too: another scene may be called as they are.
        let stems = |stem: &str| -> BTreeSet<String> {
            let of_parts = pictures.iter().map(|picture| stem_of_part(stem, picture));
            of_parts.chain([stem.to_owned()]).collect()
        };
        let is_free = |stem: &String| {
            !self.holds_capture(stem, pictures) && self.taken.is_disjoint(&stems(stem))
        };
        let stem = counted(scene).find(is_free).unwrap_or_default();
        self.taken.extend(stems(&stem));
        stem
    }

    /// Returns whether one of the names belongs to a depth image: a report never writes a PNG next to a JSON of the
    /// same name.
    fn holds_capture(&self, stem: &str, pictures: &[&Picture]) -> bool {
        let mut pictures = pictures.iter().map(|picture| self.picture(stem, picture));
        self.json(stem).with_extension("png").exists()
            || pictures.any(|picture| picture.with_extension("json").exists())
    }
}

/// Returns the stem of the pictures of a part.
fn stem_of_part(stem: &str, picture: &Picture) -> String {
    match picture.part {
        None => stem.to_owned(),
        Some(number) => format!("{stem}.{number}"),
    }
}

/// Returns the stem of a scene's file, then the stem followed by -2, -3 and so on.
fn counted(scene: &Path) -> impl Iterator<Item = String> {
    let stem = scene.file_stem().unwrap_or(scene.as_os_str());
    let stem = stem.to_string_lossy().into_owned();
    let numbered = stem.clone();
    std::iter::once(stem).chain((2..).map(move |number| format!("{numbered}-{number}")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::RgbImage;

    #[test]
    fn pictures_of_a_frames_parts_and_of_another_scene_never_share_a_name() {
        for scenes in [["rack", "rack.2"], ["rack.2", "rack"]] {
            let folder = tempfile::tempdir().expect("a folder");
            let mut out = ReportFolder::make(folder.path()).expect("made");
            let mut num = 0;
            for scene in scenes {
                let of_rack = [None, Some(2)].map(|part| Picture {
                    part,
                    stage: "contour",
                    image: RgbImage::new(1, 1),
                });
                let pictures = &of_rack[..if scene == "rack" { 2 } else { 1 }];
                let file = format!("{scene}.png");
                out.write(Path::new(&file), "{}", pictures)
                    .expect("written");
                // One of the stage, and one of all stages.
                num += 1 + 2 * pictures.len();
            }
            let written = folder.path().read_dir().expect("a folder").count();
            assert_eq!(written, num, "{scenes:?}");
        }
    }
}
