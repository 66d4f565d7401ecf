//! Writing what a person asked to have as a file.

use std::{
    io::{self, Cursor},
    path::{Path, PathBuf},
    sync::Arc,
};

use image::{DynamicImage, ImageFormat};

use super::{
    inspect::work::Inspected,
    source::{Origin, file_name},
    user_error::UserError,
    viewport::{ViewColours, ViewShot},
};
use crate::{
    files::write_atomically,
    report::{
        InspectionLine, ReportError, ReportFolder,
        pose_report::{
            CsvAppended, PdfPictures, PoseReport, ReportSubject, SeenBy, append_csv, pose_pdf,
        },
        stage_pictures,
    },
    robot::{Convention, RobotFrame, spray::SprayExport},
};

/// What is to be written.
#[derive(Clone, Debug)]
pub enum WriteRequest {
    /// An inspection: a line of JSON, the pictures of its stages, and the pose report as JSON, PDF and a row of CSV.
    Report {
        /// Where to.
        folder: PathBuf,
        /// The inspection.
        inspected: Arc<Inspected>,
        /// Where the camera stands, if the cell is calibrated.
        robot: Option<Arc<RobotFrame>>,
        /// In which numbers the robot is told the pose.
        convention: Convention,
        /// The 3-D view, if it was in sight.
        shot: Option<Box<ViewShot>>,
    },
    /// A spray path for the robot, as CSV or JSON.
    SprayPath {
        /// Where to.
        path: PathBuf,
        /// The inspection with the path.
        inspected: Arc<Inspected>,
        /// Where the camera stands.
        robot: Arc<RobotFrame>,
        /// In which numbers the robot is told the nozzle's poses.
        convention: Convention,
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
pub struct WriteResult {
    /// In words, for a notice.
    pub what: String,
    /// The file, or the folder of the files.
    pub path: PathBuf,
}

/// Writes it: whole, or not at all.
pub(super) fn answer(request: &WriteRequest) -> Result<WriteResult, UserError> {
    match request {
        WriteRequest::Report {
            folder,
            inspected,
            robot,
            convention,
            shot,
        } => {
            let report = report_of(inspected, robot.as_deref(), *convention);
            write_report(folder, inspected, &report, shot.as_deref())
        }
        WriteRequest::SprayPath {
            path,
            inspected,
            robot,
            convention,
        } => write_spray_path(path, inspected, robot, *convention),
        WriteRequest::Picture { path, shot } => {
            let picture = shot.take().map_err(|error| UserError::of(&error))?;
            let mut png = Cursor::new(Vec::new());
            let encoded = picture.write_to(&mut png, ImageFormat::Png);
            write_atomically(path, |writer| {
                encoded.map_err(io::Error::other)?;
                writer.write_all(png.get_ref())
            })
            .map_err(|error| UserError::of(&error))?;
            Ok(WriteResult {
                what: format!("Saved the picture {}", path.display()),
                path: path.clone(),
            })
        }
    }
}

/// As `partsight inspect --spray` does.
fn write_spray_path(
    path: &Path,
    inspected: &Inspected,
    robot: &RobotFrame,
    convention: Convention,
) -> Result<WriteResult, UserError> {
    let first = inspected.inspection.ranking.entries.first();
    let part = first.and_then(|first| inspected.library.parts.get(first.reference));
    let (Some(carried), Some(part)) = (&inspected.spray, part) else {
        return Err(UserError {
            what: "There is no spray path over what is in front".into(),
            advice: "Store one with the part, and capture a part that is accepted".into(),
        });
    };
    let export = SprayExport {
        path: carried,
        part: part.name.as_str(),
        scene: &scene_name(&inspected.origin).display().to_string(),
        frame: robot,
        convention,
        params: &inspected.recipe.stand_off,
        is_stored: true,
        is_simulated: inspected.origin.is_simulated() || part.simulated,
        at: inspected.at,
    };
    export.save(path).map_err(|error| UserError::of(&error))?;
    Ok(WriteResult {
        what: format!(
            "Wrote {}: {} of {} points within the band, as {}",
            path.display(),
            carried.num_inside(),
            carried.points.len(),
            convention.title()
        ),
        path: path.to_owned(),
    })
}

/// The pose report of what the window shows.
fn report_of(
    inspected: &Inspected,
    robot: Option<&RobotFrame>,
    convention: Convention,
) -> PoseReport {
    let seen_by = match &inspected.origin {
        origin if origin.is_simulated() => SeenBy::Simulation,
        Origin::File { .. } => SeenBy::NotKnown,
        Origin::Simulated { .. } | Origin::Scan { .. } | Origin::Frame { .. } => SeenBy::Camera,
    };
    PoseReport::of(&ReportSubject {
        inspected_at: inspected.at,
        scene: &scene_name(&inspected.origin).display().to_string(),
        source: match inspected.origin {
            Origin::Simulated { .. } => Some("the window's simulated cell"),
            Origin::File { .. } | Origin::Scan { .. } | Origin::Frame { .. } => None,
        },
        seen_by,
        inspection: &inspected.inspection,
        middle: inspected.middle,
        stand_off: inspected.stand_off.as_ref(),
        recipe: &inspected.recipe,
        library_identity: &inspected.library.identity,
        num_references: inspected.library.parts.len(),
        robot,
        convention,
    })
}

/// By what the files of a report are named.
fn scene_name(origin: &Origin) -> PathBuf {
    match origin {
        Origin::File { path, .. } => path.clone(),
        Origin::Simulated { number, .. } => format!("simulated_{number}").into(),
        Origin::Scan { name, .. } | Origin::Frame { name, .. } => name.replace(' ', "_").into(),
    }
}

/// As `partsight inspect --report` and `partsight report` do.
fn write_report(
    folder: &Path,
    inspected: &Inspected,
    report: &PoseReport,
    shot: Option<&ViewShot>,
) -> Result<WriteResult, UserError> {
    let trouble = |error: ReportError| UserError::of(&error);
    let name = scene_name(&inspected.origin);
    let scene = name.display().to_string();
    let line = InspectionLine::of(&scene, &inspected.inspection).to_json();
    let stages = stage_pictures(&inspected.scene, &inspected.inspection);
    let mut out = ReportFolder::make(folder).map_err(trouble)?;
    let path = out.write(&name, &line, &stages).map_err(trouble)?;
    let view = shot.and_then(|shot| on_paper(shot).take().ok());
    let view = view.map(|view| DynamicImage::from(view).into_rgb8());
    let title = inspected.figures.candidates.first();
    let pictures = PdfPictures {
        view: view.as_ref(),
        stages: &stages,
        title: title.map(|best| best.title.as_str()),
    };
    let pdf = pose_pdf(report, &pictures).map_err(|error| UserError::of(&error))?;
    let files = [("json", report.to_json().into_bytes()), ("pdf", pdf)];
    let written = out.write_pose(&name, &files).map_err(trouble)?;
    let table = out.csv(report.robot.convention);
    let appended = append_csv(&table, report).map_err(|error| UserError::of(&error))?;
    let names: Vec<String> = [&path]
        .into_iter()
        .chain(&written)
        .map(|path| file_name(path))
        .collect();
    let what = format!(
        "Wrote {}, the pictures of its stages and a row of {} to {}",
        names.join(", "),
        file_name(&table),
        folder.display()
    );
    if let CsvAppended::SetAside(aside) = appended {
        let aside = file_name(&aside);
        let what = format!("{what}; its last row had no end and was set aside in {aside}");
        return Ok(WriteResult { what, path });
    }
    Ok(WriteResult { what, path })
}

/// The same view in the colours of paper.
fn on_paper(shot: &ViewShot) -> ViewShot {
    let mut shot = shot.clone();
    shot.style.colours = ViewColours::light();
    shot
}
