//! The folder of `inspect --report`.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use super::console::{Advised as _, advised_error};
use crate::{
    files::{advice_on, words_of, write_atomically},
    report::{Picture, strip},
};

/// The results of an inspection, beside the captures or anywhere else.
///
/// Per inspected file `STEM.report.json`, a `STEM.STAGE.png` for each stage, and `STEM.stages.png` with all of them. What an
/// earlier report left under these names is replaced; a depth image and its camera never are.
pub(super) struct ReportFolder {
    path: PathBuf,
    /// Stems that are taken, so that two files of one name in different folders do not overwrite each other.
    taken: BTreeSet<String>,
}

impl ReportFolder {
    pub(super) fn make(path: &Path) -> anyhow::Result<Self> {
        fs::create_dir_all(path).map_err(|error| {
            let folder = path.display();
            let cause = words_of(&error);
            advised_error(
                format!("{folder}: cannot make the report's folder: {cause}"),
                advice_on(&error),
            )
        })?;
        Ok(Self {
            path: path.to_owned(),
            taken: BTreeSet::new(),
        })
    }

    pub(super) fn write(
        &mut self,
        scene: &Path,
        line: &str,
        pictures: &[Picture],
    ) -> anyhow::Result<()> {
        let strip = Picture {
            stage: "stages",
            image: strip(pictures),
        };
        let shown = (!pictures.is_empty()).then_some(&strip);
        let pictures: Vec<&Picture> = pictures.iter().chain(shown).collect();
        let stem = self.free_stem(scene, &pictures);
        let json = self.json(&stem);
        write_atomically(&json, |writer| writeln!(writer, "{line}")).advised()?;
        for picture in pictures {
            let mut png = std::io::Cursor::new(Vec::new());
            picture.image.write_to(&mut png, image::ImageFormat::Png)?;
            let path = self.picture(&stem, picture);
            write_atomically(&path, |writer| writer.write_all(png.get_ref())).advised()?;
        }
        Ok(())
    }

    fn json(&self, stem: &str) -> PathBuf {
        self.path.join(format!("{stem}.report.json"))
    }

    fn picture(&self, stem: &str, picture: &Picture) -> PathBuf {
        self.path.join(format!("{stem}.{}.png", picture.stage))
    }

    fn free_stem(&mut self, scene: &Path, pictures: &[&Picture]) -> String {
        let stem = scene.file_stem().unwrap_or(scene.as_os_str());
        let stem = stem.to_string_lossy().into_owned();
        let mut free = stem.clone();
        let mut number = 2;
        while self.holds_capture(&free, pictures) || !self.taken.insert(free.clone()) {
            free = format!("{stem}-{number}");
            number += 1;
        }
        free
    }

    /// True if one of the names belongs to a depth image: a report never makes a PNG and a JSON of one name.
    fn holds_capture(&self, stem: &str, pictures: &[&Picture]) -> bool {
        let mut pictures = pictures.iter().map(|picture| self.picture(stem, picture));
        self.json(stem).with_extension("png").exists()
            || pictures.any(|picture| picture.with_extension("json").exists())
    }
}
