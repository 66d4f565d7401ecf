//! Writing what a person asked to have as a file.

use std::{
    io::{self, Cursor},
    path::{Path, PathBuf},
    sync::Arc,
};

use image::ImageFormat;

use super::{
    inspect::work::Inspected,
    job::Trouble,
    source::{Origin, file_name},
    viewport::ViewShot,
};
use crate::{
    files::write_atomically,
    report::{InspectionLine, ReportError, ReportFolder, stage_pictures},
};

/// What is to be written.
#[derive(Clone, Debug)]
pub enum WriteRequest {
    /// A text file.
    Text {
        /// Where to.
        path: PathBuf,
        /// Its contents.
        text: String,
    },
    /// An inspection: a line of JSON and the pictures of its stages.
    Report {
        /// Where to.
        folder: PathBuf,
        /// The inspection.
        inspected: Arc<Inspected>,
    },
    /// A picture of a 3-D view, as a PNG.
    Picture {
        /// Where to.
        path: PathBuf,
        /// What is on it.
        shot: Box<ViewShot>,
    },
}

/// What was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// In words, for a notice.
    pub what: String,
    /// The file, or the folder of the files.
    pub path: PathBuf,
}

/// Writes it: whole, or not at all.
pub(super) fn answer(request: &WriteRequest) -> Result<Written, Trouble> {
    match request {
        WriteRequest::Text { path, text } => {
            write_atomically(path, |writer| writer.write_all(text.as_bytes()))
                .map_err(|error| Trouble::of(&error))?;
            Ok(Written {
                what: format!("Wrote {}", path.display()),
                path: path.clone(),
            })
        }
        WriteRequest::Report { folder, inspected } => {
            write_report(folder, inspected).map_err(|error| Trouble::of(&error))
        }
        WriteRequest::Picture { path, shot } => {
            let picture = shot.take().map_err(|error| Trouble::of(&error))?;
            let mut png = Cursor::new(Vec::new());
            let encoded = picture.write_to(&mut png, ImageFormat::Png);
            write_atomically(path, |writer| {
                encoded.map_err(io::Error::other)?;
                writer.write_all(png.get_ref())
            })
            .map_err(|error| Trouble::of(&error))?;
            Ok(Written {
                what: format!("Saved the picture {}", path.display()),
                path: path.clone(),
            })
        }
    }
}

/// As `partsight inspect --report` does.
fn write_report(folder: &Path, inspected: &Inspected) -> Result<Written, ReportError> {
    let name = match &inspected.origin {
        Origin::File(path) => path.clone(),
        Origin::Simulated { number, .. } => format!("simulated_{number}").into(),
        Origin::Frame { name, .. } => name.replace(' ', "_").into(),
    };
    let scene = name.display().to_string();
    let line = InspectionLine::of(&scene, &inspected.inspection).to_json();
    let pictures = stage_pictures(&inspected.scene, &inspected.inspection);
    let path = ReportFolder::make(folder)?.write(&name, &line, &pictures)?;
    Ok(Written {
        what: format!(
            "Wrote {} and the pictures of its stages to {}",
            file_name(&path),
            folder.display()
        ),
        path,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_written_whole_and_a_missing_folder_is_said_in_words() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("table.csv");
        let text = "part,e_m2\nfender,1e-7\n".to_owned();
        let written = answer(&WriteRequest::Text {
            path: path.clone(),
            text: text.clone(),
        });
        let what = written.expect("written").what;
        assert_eq!(what, format!("Wrote {}", path.display()));
        assert_eq!(std::fs::read_to_string(&path).expect("read"), text);
        let path = folder.path().join("missing").join("table.csv");
        let trouble = answer(&WriteRequest::Text { path, text }).expect_err("refused");
        assert!(!trouble.what.is_empty() && !trouble.advice.is_empty());
    }
}
