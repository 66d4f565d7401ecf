//! Pictures of confusions: per suite the first wrong frame of each subject, and for each part the frame in which
//! another part scored highest.

use std::path::Path;

use crate::suites::{NearestMistake, Suite, SuiteCase};
use inspection::{library::Library, pipeline::Inspection};
use partsight::cli::console::Advised as _;
use records::report::{
    InspectionLine, Picture, ReportError, ReportFolder, runner_up_picture, stage_pictures,
};
use stages::scene::SceneCloud;

/// Collects the pictures while the suites run.
pub(super) struct Pictures {
    folder: ReportFolder,
    known: Vec<(Suite, String)>,
    /// The worst frame of each part so far; written at the end.
    closest: Vec<(NearestMistake, ConfusionPicture)>,
    failed: Option<ReportError>,
}

/// One frame, ready to be written.
struct ConfusionPicture {
    name: String,
    line: String,
    pictures: Vec<Picture>,
}

impl ConfusionPicture {
    fn of(name: String, scene: &SceneCloud, inspection: &Inspection, library: &Library) -> Self {
        let line = InspectionLine::of(&name, inspection).to_json();
        let mut pictures = stage_pictures(scene, inspection);
        pictures.extend(runner_up_picture(scene, inspection, library));
        Self {
            name,
            line,
            pictures,
        }
    }

    fn write(&self, folder: &mut ReportFolder) -> Result<(), ReportError> {
        folder.write(Path::new(&self.name), &self.line, &self.pictures)?;
        Ok(())
    }
}

impl Pictures {
    pub(super) fn make(folder: &Path) -> anyhow::Result<Self> {
        Ok(Self {
            folder: ReportFolder::make(folder).advised()?,
            known: Vec::new(),
            closest: Vec::new(),
            failed: None,
        })
    }

    /// Keeps a frame if it went wrong, or is the worst of its part so far.
    pub(super) fn keep(
        &mut self,
        suite: Suite,
        case: &SuiteCase,
        scene: &SceneCloud,
        inspection: &Inspection,
        library: &Library,
    ) {
        self.keep_wrong(suite, case, scene, inspection, library);
        let Some(closest) = NearestMistake::of(suite, case) else {
            return;
        };
        let known = self.closest.iter().position(|k| k.0.part == closest.part);
        if known.is_some_and(|known| !closest.is_worse_than(&self.closest[known].0)) {
            return;
        }
        let name = format!(
            "closest_{}_to_{}_{}_{}",
            closest.part,
            closest.other,
            suite.name(),
            case.seed
        );
        let drawn = ConfusionPicture::of(name, scene, inspection, library);
        match known {
            Some(known) => self.closest[known] = (closest, drawn),
            None => self.closest.push((closest, drawn)),
        }
    }

    fn keep_wrong(
        &mut self,
        suite: Suite,
        case: &SuiteCase,
        scene: &SceneCloud,
        inspection: &Inspection,
        library: &Library,
    ) {
        let key = (suite, case.subject.clone());
        let is_wrong = !case.is_right() || case.is_wrong_accepted();
        if !is_wrong || self.failed.is_some() || self.known.contains(&key) {
            return;
        }
        self.known.push(key);
        let found = case.found.as_deref().unwrap_or("nothing");
        let name = format!("{}_{}_as_{found}_{}", suite.name(), case.subject, case.seed);
        let drawn = ConfusionPicture::of(name, scene, inspection, library);
        self.failed = drawn.write(&mut self.folder).err();
    }

    /// Writes the remaining pictures. Returns the first failure, if any.
    pub(super) fn write(mut self) -> anyhow::Result<()> {
        if let Some(error) = self.failed {
            return Err(error).advised();
        }
        for (_, drawn) in &self.closest {
            drawn.write(&mut self.folder).advised()?;
        }
        Ok(())
    }
}
