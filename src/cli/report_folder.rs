//! The folder of `inspect --report`.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use anyhow::Context as _;

use super::console::Advised as _;
use crate::{
    files::write_atomically,
    report::{Picture, strip},
};

/// Per inspected file `STEM.json`, a `STEM.STAGE.png` for each stage, and `STEM.stages.png` with all of them.
pub(super) struct ReportFolder {
    path: PathBuf,
    /// Stems that are taken, so that two files of one name in different folders do not overwrite each other.
    taken: BTreeSet<String>,
}

impl ReportFolder {
    pub(super) fn make(path: &Path) -> anyhow::Result<Self> {
        fs::create_dir_all(path)
            .with_context(|| format!("{}: cannot make the report's folder", path.display()))?;
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
        let stem = self.free_stem(scene);
        let json = self.path.join(format!("{stem}.json"));
        write_atomically(&json, |writer| writeln!(writer, "{line}")).advised()?;
        let strip = Picture {
            stage: "stages",
            image: strip(pictures),
        };
        let shown = (!pictures.is_empty()).then_some(&strip);
        for Picture { stage, image } in pictures.iter().chain(shown) {
            let mut png = std::io::Cursor::new(Vec::new());
            image.write_to(&mut png, image::ImageFormat::Png)?;
            let path = self.path.join(format!("{stem}.{stage}.png"));
            write_atomically(&path, |writer| writer.write_all(png.get_ref())).advised()?;
        }
        Ok(())
    }

    fn free_stem(&mut self, scene: &Path) -> String {
        let stem = scene.file_stem().unwrap_or(scene.as_os_str());
        let stem = stem.to_string_lossy().into_owned();
        let mut free = stem.clone();
        let mut number = 2;
        while !self.taken.insert(free.clone()) {
            free = format!("{stem}-{number}");
            number += 1;
        }
        free
    }
}
