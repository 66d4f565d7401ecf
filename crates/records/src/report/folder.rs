//! Folder of reports: written by `inspect --report` and by the window's export.

use std::{
    collections::BTreeSet,
    io,
    path::{Path, PathBuf},
};

use super::{
    pictures::{Picture, STAGES, strip, write_png},
    pose_report::{CsvError, PoseReport, append_csv},
    problem::ProblemReport,
};
use crate::history::FrameError;
use files::{FileError, advice_on, disk, words_of, write_atomically, write_text};
use geometry::error::Advice;
use robot::Convention;
use stages::segment::MAX_PARTS;

/// Why a report could not be written.
#[derive(Debug, thiserror::Error, Advice)]
pub enum ReportError {
    /// The folder cannot be created.
    #[error("{}: cannot make the report's folder: {}", path.display(), words_of(source))]
    #[advice(advice_on(source))]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The underlying error.
        source: io::Error,
    },
    /// A file cannot be written.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// A scene cannot be written.
    #[error(transparent)]
    #[advice(transparent)]
    Frame(#[from] FrameError),
    /// A row cannot be appended to the table of pose reports.
    #[error(transparent)]
    #[advice(transparent)]
    Row(#[from] CsvError),
}

/// What was written of a pose report.
#[derive(Debug, Default)]
pub struct WrittenPose {
    /// The pages.
    pub pages: Vec<PathBuf>,
    /// The table, if it has the row.
    pub table: Option<PathBuf>,
    /// Where an incomplete last row of the table is now.
    pub aside: Option<PathBuf>,
    /// Why the others are missing.
    pub errors: Vec<ReportError>,
}

/// Name of the picture of all stages.
const STRIP: &str = "stages";
/// Most parts that a frame lists: those of a rack's places, and beside them as much as a frame can show.
const MAX_LISTED: usize = 2 * MAX_PARTS;

/// A folder for the results of inspections, next to the captures or elsewhere.
///
/// Each inspected file gets `STEM.report.json`, a `STEM.STAGE.png` per stage, and `STEM.stages.png` with all of them; of the
/// other parts of its frame `STEM.NUMBER.STAGE.png`.
/// An earlier report under these names is replaced, and its pictures of stages and parts that the new one lacks are removed; a
/// depth image and its camera never are.
#[derive(Debug)]
pub struct ReportFolder {
    path: PathBuf,
    /// Stems in use, so that files of the same name from different folders do not overwrite each other.
    taken: BTreeSet<String>,
    /// Stems in use by pose reports.
    taken_poses: BTreeSet<String>,
    /// Stems in use by problem reports.
    taken_problems: BTreeSet<String>,
    has_reports: bool,
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
            taken_problems: BTreeSet::new(),
            has_reports: false,
        })
    }

    /// True once [`write`](Self::write) has written one, though perhaps without its pictures.
    pub fn has_reports(&self) -> bool {
        self.has_reports
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
            stage: STRIP,
            image: strip(pictures),
        });
        let strips: Vec<Picture> = strips.collect();
        let pictures: Vec<&Picture> = pictures.iter().chain(&strips).collect();
        let stem = self.free_stem(scene, &pictures);
        let json = self.json(&stem);
        let earlier = if json.exists() {
            self.pictures_of(&stem)
        } else {
            BTreeSet::new()
        };
        write_text(&json, &format!("{line}\n"))?;
        self.has_reports = true;
        let mut written = BTreeSet::new();
        for picture in pictures {
            let path = self.picture(&stem, picture);
            write_png(&path, &picture.image)?;
            written.insert(path);
        }
        for path in earlier.difference(&written) {
            disk::remove_file(path).map_err(|error| FileError::writing(path, error))?;
        }
        Ok(json)
    }

    /// The pictures in the folder of the report of this stem, without those of a report whose own stem is that of a part.
    fn pictures_of(&self, stem: &str) -> BTreeSet<PathBuf> {
        let of_parts = (1..=MAX_LISTED).map(|number| format!("{stem}.{number}"));
        let of_parts = of_parts.filter(|stem| !self.json(stem).exists());
        let stems = of_parts.chain([stem.to_owned()]);
        let paths = stems.flat_map(|stem| {
            let path = move |stage: &&str| self.path.join(format!("{stem}.{stage}.png"));
            STAGES.iter().chain([&STRIP]).map(path).collect::<Vec<_>>()
        });
        let is_picture = |path: &PathBuf| path.exists() && !path.with_extension("json").exists();
        paths.filter(is_picture).collect()
    }

    /// Writes the pose report of a scene: its row in the table of its convention if `has_row`, and `STEM.pose.ENDING` for each
    /// ending. None costs another.
    pub fn write_pose(
        &mut self,
        scene: &Path,
        report: &PoseReport,
        has_row: bool,
        pages: &[(&str, Vec<u8>)],
    ) -> WrittenPose {
        let mut written = WrittenPose::default();
        // The row first: it fits where a page does not.
        if has_row {
            let table = self.csv(report.robot.convention);
            match append_csv(&table, report) {
                Ok(aside) => (written.table, written.aside) = (Some(table), aside),
                Err(error) => written.errors.push(error.into()),
            }
        }
        let path = |stem: &str, ending: &str| self.path.join(format!("{stem}.pose.{ending}"));
        // A depth image of this name would take the report's JSON for its camera.
        let is_free = |stem: &str| !path(stem, "png").exists() && !self.taken_poses.contains(stem);
        let stem = counted(scene)
            .find(|stem| is_free(stem))
            .unwrap_or_default();
        self.taken_poses.insert(stem.clone());
        for (ending, bytes) in pages {
            let path = path(&stem, ending);
            match write_atomically(&path, |writer| writer.write_all(bytes)) {
                Ok(()) => written.pages.push(path),
                Err(error) => written.errors.push(error.into()),
            }
        }
        written
    }

    /// Writes the problem report of a scene as `STEM.problem.zip`, and returns its path; replaces one of an earlier call.
    pub fn write_problem(
        &mut self,
        scene: &Path,
        report: &ProblemReport<'_>,
    ) -> Result<PathBuf, ReportError> {
        let is_free = |stem: &String| !self.taken_problems.contains(stem);
        let stem = counted(scene).find(is_free).unwrap_or_default();
        let path = self.path.join(format!("{stem}.problem.zip"));
        report.write(&path)?;
        self.taken_problems.insert(stem);
        Ok(path)
    }

    /// Returns the CSV file that collects the pose reports in one convention.
    fn csv(&self, convention: Convention) -> PathBuf {
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
    fn a_report_leaves_no_pictures_of_an_earlier_fuller_frame() {
        let folder = tempfile::tempdir().expect("a folder");
        let picture = |part, stage| Picture {
            part,
            stage,
            image: RgbImage::new(1, 1),
        };
        let parts = [None, Some(2), Some(3)];
        let all = parts.map(|part| [picture(part, "binary"), picture(part, "contour")]);
        let all = all.as_flattened();
        let write = |scene: &str, pictures: &[Picture]| {
            let mut out = ReportFolder::make(folder.path()).expect("made");
            out.write(Path::new(scene), "{}", pictures)
                .expect("written");
        };
        let names = || -> BTreeSet<String> {
            let entries = folder.path().read_dir().expect("a folder");
            let names = entries.map(|entry| entry.expect("an entry").file_name());
            names
                .map(|name| name.to_string_lossy().into_owned())
                .collect()
        };
        // Not of a report: a depth image with its camera, a picture of the user.
        for name in [
            "rack.4.contour.png",
            "rack.4.contour.json",
            "rack.2.photo.png",
        ] {
            std::fs::write(folder.path().join(name), "").expect("written");
        }
        write("rack.3.png", &all[..1]);
        let others = names();
        write("rack.png", all);
        write("rack.png", &all[..1]);
        let added: Vec<String> = names().difference(&others).cloned().collect();
        // Pictures with the names of another report's may be its own.
        assert_eq!(
            added,
            [
                "rack.3.contour.png",
                "rack.binary.png",
                "rack.report.json",
                "rack.stages.png"
            ]
        );
        assert!(others.is_subset(&names()), "{:?}", names());
    }

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
