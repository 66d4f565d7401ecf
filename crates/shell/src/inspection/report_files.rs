//! Writes the files that the user asks for, atomically.

use std::{
    io::{self, Cursor},
    path::{Path, PathBuf},
    sync::Arc,
};

use image::{DynamicImage, ImageFormat};
use nalgebra::Point3;

use super::{inspected::Inspected, source::Origin};
use crate::language::not_checked;
use files::{file_name, write_atomically};
use inspection::pipeline::Inspection;
use records::{
    history::Traceability,
    report::{
        ReportFolder, WrittenPose, frame_pictures,
        pose_report::{PdfPictures, PoseReport, ReportSubject, SeenBy, pose_pdf},
    },
};
use robot::{
    Convention, RobotFrame,
    arm::{PathCheck, PlacedArm},
    program::{ProgramSettings, RobotLanguage},
};
use station::{
    Doubt, Subject,
    robot_file::{RobotFile, RobotFileContent, RobotFileError, remove_previous},
};
use ui::{
    language::{described, text, what_and_advice},
    user_error::UserError,
    viewport::{ViewColours, ViewShot},
};

/// Writes a picture of a 3-D view as PNG; returns a message about it.
pub fn picture(path: &Path, shot: &ViewShot) -> Result<String, UserError> {
    let picture = shot.take().map_err(|error| UserError::of(&error))?;
    let mut png = Cursor::new(Vec::new());
    let encoded = picture.write_to(&mut png, ImageFormat::Png);
    write_atomically(path, |writer| {
        encoded.map_err(io::Error::other)?;
        writer.write_all(png.get_ref())
    })
    .map_err(|error| UserError::of(&error))?;
    Ok(text!(
        "inspect-picture-saved",
        path = path.display().to_string()
    ))
}

/// A file that was written for a robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenForRobot {
    /// Describes what was written.
    pub what: String,
    /// What was not checked, in words; `None` if everything was.
    pub not_checked: Option<String>,
}

/// Tool, gun and arm that run a program.
#[derive(Clone, Debug)]
pub struct ProgramTarget {
    pub settings: ProgramSettings,
    /// `None`: reach is not checked.
    pub arm: Option<PlacedArm>,
}

impl ProgramTarget {
    /// The content of a program in this language.
    pub fn content(&self, language: &'static RobotLanguage) -> RobotFileContent<'_> {
        RobotFileContent::Program {
            language,
            settings: &self.settings,
            arm: self.arm.as_ref(),
        }
    }
}

/// Writes the spray path of an inspection for the robot, as CSV or JSON like `partsight inspect --spray`, or as a program for
/// its controller like `--program`. `others` are the other parts of the frame, and `subject` is what was inspected as it stands
/// now. First removes an earlier file of that name; writes nothing if there are doubts.
pub fn spray_path(
    path: &Path,
    inspected: &Inspected,
    others: &[Arc<Inspected>],
    subject: &Subject,
    robot: &RobotFrame,
    convention: Convention,
    target: Result<ProgramTarget, UserError>,
) -> Result<WrittenForRobot, UserError> {
    remove_earlier(path)?;
    let first = inspected.inspection.ranking.entries.first();
    let part = first.and_then(|first| inspected.library.parts.get(first.reference));
    let pose = inspected.inspection.found_pose();
    let stored =
        first.and_then(|first| inspected.library.spray_paths.get(first.reference)?.as_ref());
    let (Some(carried), Some(part), Some(pose)) = (&inspected.spray, part, pose) else {
        return Err(UserError {
            what: text!("inspect-no-spray-path"),
            advice: text!("inspect-no-spray-path-advice"),
        });
    };
    let program = match RobotLanguage::from_file(path) {
        Ok(language) => Some((language, target?)),
        Err(_) => None,
    };
    let content = match &program {
        Some((language, target)) => target.content(language),
        None => RobotFileContent::Poses {
            convention,
            params: &inspected.recipe.stand_off,
        },
    };
    let others = others.iter().map(|other| &other.inspection);
    let beside: Vec<&[Point3<f32>]> = others.filter_map(Inspection::readings).collect();
    robot_file(&RobotFile {
        file: path,
        content,
        carried,
        frame: robot,
        part: part.name.as_str(),
        part_cloud: &inspected.part_cloud,
        coverage: part.coverage,
        side: part.side,
        path: stored.map(|stored| &stored.path),
        off: inspected.off_the_part,
        capture: Some(inspected.as_recorded(subject, Some(robot))),
        beside: &beside,
        camera_from_part: pose.camera_from_part(),
        is_stored: true,
        is_simulated: inspected.origin.is_simulated() || part.simulated,
        is_forced: false,
    })
}

/// Removes an earlier file of this name, so that no robot acts on it, whatever follows.
pub fn remove_earlier(path: &Path) -> Result<(), UserError> {
    remove_previous(path).map_err(|error| UserError::of(&error))
}

/// Writes a file for a robot, unless there are doubts.
pub fn robot_file(file: &RobotFile<'_>) -> Result<WrittenForRobot, UserError> {
    let written = file.write().map_err(|error| match error {
        RobotFileError::Doubts(doubts) => not_written(file.content, &doubts),
        error => UserError::of(&error),
    })?;
    let path = file.file.display().to_string();
    let count = file.carried.points.len();
    let what = match file.content {
        RobotFileContent::Poses { convention, .. } => text!(
            "inspect-path-written",
            path = path,
            inside = file.carried.num_inside(),
            num = file.carried.num_seen(),
            convention = described(&convention)
        ),
        RobotFileContent::Program { language, .. } if written.num_called > 0 => text!(
            "program-written-parts",
            path = path,
            parts = written.num_called,
            count = count,
            format = language.title
        ),
        RobotFileContent::Program { language, .. } => text!(
            "program-written",
            path = path,
            count = count,
            format = language.title
        ),
    };
    Ok(WrittenForRobot {
        what,
        not_checked: not_checked(&written.unchecked),
    })
}

/// The refusal to write a file because of doubts, of which the first is shown.
fn not_written(content: RobotFileContent<'_>, doubts: &[Doubt]) -> UserError {
    let [why, advice] = doubts.first().map(what_and_advice).unwrap_or_default();
    let what = match content {
        RobotFileContent::Poses { .. } => text!("inspect-path-not-written", why = why),
        RobotFileContent::Program { .. } => text!("program-not-written", why = why),
    };
    UserError { what, advice }
}

/// The refusal to write a program of a path that the arm of this name does not reach; `None` if it reaches all of it.
pub fn not_reached(arm: &str, check: &PathCheck) -> Option<UserError> {
    let [why, advice] = what_and_advice(&check.missed(arm)?);
    let what = text!("program-not-written", why = why);
    Some(UserError { what, advice })
}

/// Makes the pose report of the shown inspection of this subject, as it stands now.
pub fn report_of(
    inspected: &Inspected,
    subject: &Subject,
    trace: &Traceability,
    robot: Option<&RobotFrame>,
    convention: Convention,
) -> PoseReport {
    let seen_by = match &inspected.origin {
        origin if origin.is_simulated() => SeenBy::Simulation,
        Origin::File { .. } => SeenBy::NotKnown,
        Origin::Simulated { .. } | Origin::Scan { .. } | Origin::Frame { .. } => SeenBy::Camera,
    };
    let recorded = inspected.as_recorded(subject, robot);
    let report = PoseReport::of(&ReportSubject {
        inspected_at: inspected.at,
        scene: &scene_name(&inspected.origin).display().to_string(),
        source: Some(&inspected.entry.record.summary.source),
        seen_by,
        trace,
        inspection: &inspected.inspection,
        middle: inspected.middle,
        stand_off: inspected.stand_off.as_ref(),
        recipe: &inspected.recipe,
        library_identity: &inspected.library.identity,
        num_references: inspected.library.parts.len(),
        robot,
        for_robot: recorded.frame_for_robot(),
        doubts: &recorded.doubt_blocks(),
        convention,
    });
    report.reported_as(subject.reported_as.as_deref())
}

/// Returns the name of the scene, which names the files of a report.
fn scene_name(origin: &Origin) -> PathBuf {
    match origin {
        Origin::File { path, .. } => path.clone(),
        Origin::Simulated { number, .. } => format!("simulated_{number}").into(),
        Origin::Scan { .. } => {
            let title = origin.scene_title().to_string();
            title.replace(' ', "_").into()
        }
        Origin::Frame { name, .. } => name.replace(' ', "_").into(),
    }
}

/// Writes the selected part of a frame like `partsight inspect --report` and `partsight report`: its line of JSON as of now, the pictures of
/// its stages and of those of the other parts of its frame, and the pose report as JSON, PDF and a row of CSV; returns a message about it. What cannot be written costs none of the
/// others. Because the user did not choose the file names, an earlier report in the folder is kept.
pub fn report(
    folder: &Path,
    parts: &[Arc<Inspected>],
    selected: usize,
    line: &str,
    report: &PoseReport,
    shot: Option<&ViewShot>,
) -> Result<String, UserError> {
    let inspected = &parts[selected];
    let name = scene_name(&inspected.origin);
    let name = unused_name(folder, &name);
    let all: Vec<&Inspection> = parts.iter().map(|part| &part.inspection).collect();
    let stages = frame_pictures(&inspected.scene, &all, selected);
    let mut out = ReportFolder::make(folder).map_err(|error| UserError::of(&error))?;
    let view = shot.and_then(|shot| on_paper(shot).take().ok());
    let view = view.map(|view| DynamicImage::from(view).into_rgb8());
    let pictures = PdfPictures {
        view: view.as_ref(),
        stages: &stages[..stages.partition_point(|picture| picture.part.is_none())],
        title: inspected.part_title(),
    };
    let pdf = pose_pdf(report, &pictures);
    let pages = [("json", report.to_json().into_bytes()), ("pdf", pdf)];
    // The pose report first: it fits where pictures do not.
    let WrittenPose {
        pages,
        table,
        aside,
        mut errors,
    } = out.write_pose(&name, report, true, &pages);
    let mut written = Vec::new();
    match out.write(&name, line, &stages) {
        Ok(path) => written.push(path),
        Err(error) => errors.push(error),
    }
    if !errors.is_empty() {
        return Err(UserError::of_all(&errors));
    }
    written.extend(pages);
    let names: Vec<String> = written.iter().map(|path| file_name(path)).collect();
    let table = table.as_deref().map(file_name).unwrap_or_default();
    let files = names.join(", ");
    let folder = folder.display().to_string();
    Ok(match aside {
        Some(aside) => text!(
            "inspect-report-set-aside",
            files = files,
            table = table,
            folder = folder,
            aside = file_name(&aside)
        ),
        None => text!(
            "inspect-report-written",
            files = files,
            table = table,
            folder = folder
        ),
    })
}

/// Returns the name of the scene, numbered if the folder has a report of that name.
fn unused_name(folder: &Path, scene: &Path) -> PathBuf {
    let stem = scene.file_stem().unwrap_or(scene.as_os_str());
    let stem = stem.to_string_lossy();
    let is_taken = |stem: &str| {
        let mut endings = ["report.json", "pose.json", "pose.pdf"].iter();
        endings.any(|ending| folder.join(format!("{stem}.{ending}")).exists())
    };
    if !is_taken(&stem) {
        return scene.to_owned();
    }
    let mut numbered = (2..10_000).map(|number| format!("{stem}-{number}"));
    let free = numbered.find(|stem| !is_taken(stem));
    // The ending is removed again when the files are named.
    free.map_or_else(|| scene.to_owned(), |free| format!("{free}.scene").into())
}

/// Returns the same view with light colours for paper.
fn on_paper(shot: &ViewShot) -> ViewShot {
    let mut shot = shot.clone();
    shot.style.colours = ViewColours::light();
    shot
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::inspection::{
        inspected::{InspectRequest, inspect_all, inspected_cell},
        library_cache::LibraryCache,
        source::{CellChoice, SceneSource},
    };
    use inspection::pipeline::Unwatched;
    use simulate::{CellSetup, PartKind, Side};
    use stages::fixtures::scene_of;

    #[test]
    fn a_report_names_the_source_that_the_history_lists() {
        let setup = CellSetup::with_part(PartKind::Fender, Side::Left, 0, 3);
        let scene = Arc::new(scene_of(&setup));
        let frame = |is_simulated| Origin::Frame {
            name: "kinect frame 12".into(),
            is_simulated,
            capture: None,
        };
        let file = Origin::File {
            path: "/data/door.pcd".into(),
            is_simulated: true,
        };
        for (origin, source) in [
            (frame(false), "Kinect frame 12"),
            (frame(true), "Kinect frame 12"),
            (file, "door.pcd"),
        ] {
            let request = InspectRequest {
                source: SceneSource::AtHand(Arc::clone(&scene), origin),
                recipe: Arc::default(),
            };
            let library = LibraryCache::default();
            let inspected = inspect_all(&request, &library, &Unwatched).expect("inspected");
            let inspected = &inspected[0];
            assert_eq!(inspected.entry.record.summary.source, source);
            let subject = &inspected.subject;
            let report = report_of(
                inspected,
                subject,
                inspected.trace(),
                None,
                Convention::Kuka,
            );
            assert_eq!(report.source.as_deref(), Some(source));
        }
    }

    #[test]
    fn a_report_names_the_part_not_the_reference_that_was_found() {
        let mut inspected = inspected_cell(CellChoice::InTurn, 1);
        "front_door_b".clone_into(&mut inspected.figures.candidates[0].title);
        let subject = &inspected.subject;
        let pose = report_of(
            &inspected,
            subject,
            inspected.trace(),
            None,
            Convention::Kuka,
        );
        let folder = tempfile::tempdir().expect("a folder");
        let other = inspected_cell(CellChoice::InTurn, 2);
        let parts = [Arc::new(other), Arc::new(inspected)];
        report(folder.path(), &parts, 1, "{}", &pose, None).expect("written");
        let name = scene_name(&parts[1].origin).display().to_string();
        for of_part in ["contour", "stages", "1.contour", "1.stages"] {
            let picture = folder.path().join(format!("{name}.{of_part}.png"));
            assert!(picture.exists(), "{}", picture.display());
        }
        let mut files = std::fs::read_dir(folder.path()).expect("listed");
        let pdf = files.find_map(|file| {
            let path = file.expect("a file").path();
            path.extension()
                .is_some_and(|is| is == "pdf")
                .then_some(path)
        });
        let pdf = std::fs::read(pdf.expect("a report")).expect("read");
        let title = b"Pose report: Front door, left, ";
        assert!(pdf.windows(title.len()).any(|text| text == title));
    }

    #[test]
    fn a_table_that_takes_no_row_costs_nothing_else_of_a_report() {
        let inspected = inspected_cell(CellChoice::InTurn, 1);
        let subject = &inspected.subject;
        let pose = report_of(
            &inspected,
            subject,
            inspected.trace(),
            None,
            Convention::Kuka,
        );
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("poses.kuka.csv"), "mine\n").expect("written");
        let name = scene_name(&inspected.origin).display().to_string();
        std::fs::create_dir(at(&format!("{name}.contour.png"))).expect("made");
        let parts = [Arc::new(inspected)];
        let error = report(folder.path(), &parts, 0, "{}", &pose, None).expect_err("no table");
        for named in ["poses.kuka.csv", "contour.png"] {
            assert!(error.what.contains(named), "{error:?}");
        }
        for written in ["report.json", "pose.json", "pose.pdf"] {
            assert!(at(&format!("{name}.{written}")).exists(), "{written}");
        }
    }

    #[test]
    fn an_earlier_report_is_never_written_over() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        let named = |scene: &str| unused_name(folder.path(), Path::new(scene));
        assert_eq!(named("/captures/door.pcd"), Path::new("/captures/door.pcd"));
        std::fs::write(at("door.pose.pdf"), "mine").expect("written");
        assert_eq!(named("/captures/door.pcd"), Path::new("door-2.scene"));
        std::fs::write(at("door-2.report.json"), "mine").expect("written");
        assert_eq!(named("door"), Path::new("door-3.scene"));
        let mut out = ReportFolder::make(folder.path()).expect("there");
        let written = out.write(&named("door.pcd"), "{}", &[]).expect("written");
        assert_eq!(written, at("door-3.report.json"));
    }
}
