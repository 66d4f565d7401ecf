//! Writes the files that the user asks for, atomically.

use std::{
    io::{self, Cursor},
    path::{Path, PathBuf},
};

use image::{DynamicImage, ImageFormat};
use jiff::Timestamp;

use super::{inspected::Inspected, source::Origin};
use crate::{
    app::{
        language::{robot::convention_title, text},
        ui::viewport::{ViewColours, ViewShot},
        user_error::UserError,
    },
    files::{file_name, write_atomically},
    geometry::{cloud::PointCloud, rigid::RigidTransform},
    history::Traceability,
    library::SprayPath,
    paint::{Coat, FilmOffPlan, WrittenFilm},
    report::{
        InspectionLine, ReportError, ReportFolder,
        pose_report::{PdfPictures, PoseReport, ReportSubject, SeenBy, append_csv, pose_pdf},
        stage_pictures,
    },
    robot::{
        Convention, RobotFrame,
        arm::{PathCheck, PlacedArm},
        program::{
            ClockAhead, Program, ProgramFormat, ProgramSettings, check_reach, clock_ahead,
            clock_ahead_of_file, is_stale, is_stale_file, program_points, remove_previous_program,
        },
        spray::{CarriedPath, OffThePart, SprayExport, remove_previous_export},
    },
    stages::{pose::PoseEstimate, reference::Coverage},
};

/// Writes a picture of a 3-D view as PNG; returns a message about it.
pub(in crate::app) fn picture(path: &Path, shot: &ViewShot) -> Result<String, UserError> {
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

/// Writes a spray path for the robot, as CSV or JSON like `partsight inspect --spray`, or as a program for its controller like
/// `--program`; returns a message about it. Writes nothing if the pose may not be that of the part now.
pub(in crate::app) fn spray_path(
    path: &Path,
    inspected: &Inspected,
    robot: &RobotFrame,
    convention: Convention,
    target: Result<ProgramTarget, UserError>,
) -> Result<String, UserError> {
    let first = inspected.inspection.ranking.entries.first();
    let part = first.and_then(|first| inspected.library.parts.get(first.reference));
    let (Some(carried), Some(part)) = (&inspected.spray, part) else {
        return Err(UserError {
            what: text!("inspect-no-spray-path"),
            advice: text!("inspect-no-spray-path-advice"),
        });
    };
    let is_simulated = inspected.origin.is_simulated() || part.simulated;
    let pose = inspected
        .inspection
        .pose
        .as_ref()
        .and_then(|pose| pose.as_ref().ok());
    let off = inspected.off_the_part;
    let (ahead, is_stale) = match &inspected.origin {
        Origin::File { path, .. } => (clock_ahead_of_file(path), is_stale_file(path)),
        Origin::Simulated { .. } | Origin::Scan { .. } | Origin::Frame { .. } => {
            let at = inspected.at.into();
            (clock_ahead(at), is_stale(at))
        }
    };
    // Another capture does not help a path that does not aim at the part: that is said first.
    let refused = if off.is_some() {
        None
    } else if let Some(ClockAhead { ahead }) = ahead {
        let what = text!("program-clock-ahead", seconds = ahead.as_secs());
        Some((what, text!("program-clock-ahead-advice")))
    } else if is_stale {
        Some((text!("program-stale"), text!("program-stale-advice")))
    } else if pose.is_some_and(PoseEstimate::is_ambiguous) {
        let advice = text!("program-ambiguous-advice");
        Some((text!("program-ambiguous"), advice))
    } else {
        None
    };
    if let Some((what, advice)) = refused {
        // The file of an earlier part must not remain either.
        remove_previous_program(path).map_err(|error| UserError::of(&error))?;
        remove_previous_export(path).map_err(|error| UserError::of(&error))?;
        return Err(UserError { what, advice });
    }
    let stored =
        first.and_then(|first| inspected.library.spray_paths.get(first.reference)?.as_ref());
    let stored = stored.map(|stored| &stored.path);
    if let (Ok(_), Some(pose), Some(stored)) = (ProgramFormat::of(path), pose, stored) {
        let subject = ProgramSubject {
            part: part.name.as_str(),
            part_cloud: &inspected.part_cloud,
            coverage: part.coverage,
            path: stored,
            off,
            scene: Some(&scene_name(&inspected.origin).display().to_string()),
            camera_from_part: pose.camera_from_part(),
            is_simulated,
        };
        return program(path, carried, robot, &target?, &subject);
    }
    let doubts: Vec<String> = off.iter().map(ToString::to_string).collect();
    let export = SprayExport {
        path: carried,
        part: part.name.as_str(),
        scene: &scene_name(&inspected.origin).display().to_string(),
        frame: robot,
        convention,
        params: &inspected.recipe.stand_off,
        is_stored: true,
        is_simulated,
        doubts: &doubts,
        at: inspected.at,
    };
    export.save(path).map_err(|error| UserError::of(&error))?;
    if let Some(off) = off {
        return Ok(text!(
            "inspect-path-written-off-part",
            path = path.display().to_string(),
            aiming = off.num_aiming,
            all = off.num_spraying
        ));
    }
    Ok(text!(
        "inspect-path-written",
        path = path.display().to_string(),
        inside = carried.num_inside(),
        num = carried.num_seen(),
        convention = convention_title(convention)
    ))
}

/// Tool, gun and arm that run a program.
#[derive(Clone, Debug)]
pub(in crate::app) struct ProgramTarget {
    pub settings: ProgramSettings,
    /// `None`: reach is not checked.
    pub arm: Option<PlacedArm>,
}

/// The part that a program is for.
pub(in crate::app) struct ProgramSubject<'a> {
    pub part: &'a str,
    /// Cloud that it was enrolled with, part frame.
    pub part_cloud: &'a PointCloud,
    pub coverage: Coverage,
    /// The path, in part space.
    pub path: &'a SprayPath,
    /// Whether its path does not aim at it.
    pub off: Option<OffThePart>,
    /// Name of the scene; `None` for the standard position.
    pub scene: Option<&'a str>,
    pub camera_from_part: RigidTransform,
    pub is_simulated: bool,
}

/// Writes a carried path as a program for the robot's controller, in the language given by the file's ending; returns a
/// message about it. First removes an earlier program of that name; writes nothing if the path does not aim at the part, if the
/// arm cannot run it without a collision, or if the program would leave another film than planned.
pub(in crate::app) fn program(
    path: &Path,
    carried: &CarriedPath,
    robot: &RobotFrame,
    target: &ProgramTarget,
    subject: &ProgramSubject<'_>,
) -> Result<String, UserError> {
    let format = ProgramFormat::of(path).map_err(|error| UserError::of(&error))?;
    remove_previous_program(path).map_err(|error| UserError::of(&error))?;
    if let Some(off) = subject.off {
        return Err(UserError {
            what: text!(
                "program-off-part",
                aiming = off.num_aiming,
                all = off.num_spraying
            ),
            advice: text!("program-off-part-advice"),
        });
    }
    let ProgramTarget { settings, arm } = target;
    let robot_from_part = robot.robot_from_part(&subject.camera_from_part);
    let reach = match arm.clone() {
        Some(arm) => {
            let arm = arm.with_part(&subject.part_cloud.points, &robot_from_part);
            let reach = check_reach(&arm, carried, robot, settings);
            Some((arm, reach.map_err(|error| UserError::of(&error))?))
        }
        None => None,
    };
    let checked = reach.as_ref();
    let refused = checked.and_then(|(arm, check)| not_reached(&arm.arm.name, check));
    if let Some(error) = refused {
        return Err(error);
    }
    let points = program_points(carried, robot, reach.as_ref().map(|(_, reach)| reach));
    let mut program = Program {
        points: &points,
        settings,
        acceleration: Coat::acceleration_of(subject.path),
        film: None,
        reach: reach.as_ref(),
        part: subject.part,
        scene: subject.scene,
        robot_from_part,
        calibration: &robot.name,
        is_simulated: subject.is_simulated,
        doubts: &[],
        at: Timestamp::now(),
    };
    let enrolled = subject.part_cloud;
    let film = WrittenFilm::of(&program, format, subject.path, enrolled, subject.coverage);
    if let Some(off_plan) = film.as_ref().and_then(WrittenFilm::doubt) {
        return Err(film_off_plan(&off_plan));
    }
    let film = film.as_ref().map(WrittenFilm::line);
    program.film = film.as_deref();
    let saved = program.save(path, format);
    let num_parts = saved.map_err(|error| UserError::of(&error))?;
    Ok(if num_parts > 0 {
        text!(
            "program-written-parts",
            path = path.display().to_string(),
            parts = num_parts,
            count = points.len(),
            format = format.title()
        )
    } else {
        text!(
            "program-written",
            path = path.display().to_string(),
            count = points.len(),
            format = format.title()
        )
    })
}

/// The refusal to write a program of a path that the arm of this name does not reach; `None` if it reaches all of it.
pub(in crate::app) fn not_reached(arm: &str, check: &PathCheck) -> Option<UserError> {
    let (num_reached, all) = (check.num_reached(), check.points.len());
    (num_reached < all).then(|| UserError {
        what: text!(
            "program-not-reached",
            arm = arm,
            missed = all - num_reached,
            all = all
        ),
        advice: text!("program-not-reached-advice"),
    })
}

/// The refusal to write a program that leaves another film than planned.
fn film_off_plan(off_plan: &FilmOffPlan) -> UserError {
    let [planned, written] = off_plan.within.map(|share| format!("{:.1}", 100.0 * share));
    let [planned_um, written_um] = off_plan.mean.map(|mean| format!("{:.1}", 1e6 * mean));
    UserError {
        what: text!(
            "program-film-off-plan",
            written = written,
            written_um = written_um,
            planned = planned,
            planned_um = planned_um,
            tolerance = format!("{:.0}", 100.0 * off_plan.tolerance),
            stops = off_plan.num_stops
        ),
        advice: text!("program-film-off-plan-advice"),
    }
}

/// Makes the pose report of the shown inspection.
pub(in crate::app) fn report_of(
    inspected: &Inspected,
    trace: &Traceability,
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
        convention,
    })
}

/// Returns the name of the scene, which names the files of a report.
fn scene_name(origin: &Origin) -> PathBuf {
    match origin {
        Origin::File { path, .. } => path.clone(),
        Origin::Simulated { number, .. } => format!("simulated_{number}").into(),
        Origin::Scan { name, .. } | Origin::Frame { name, .. } => name.replace(' ', "_").into(),
    }
}

/// Writes an inspection like `partsight inspect --report` and `partsight report`: a line of JSON, the pictures of its stages,
/// and the pose report as JSON, PDF and a row of CSV; returns a message about it. Because the user did not choose the file
/// names, an earlier report in the folder is kept.
pub(in crate::app) fn report(
    folder: &Path,
    inspected: &Inspected,
    report: &PoseReport,
    shot: Option<&ViewShot>,
) -> Result<String, UserError> {
    let trouble = |error: ReportError| UserError::of(&error);
    let name = scene_name(&inspected.origin);
    let scene = name.display().to_string();
    let name = unused_name(folder, &name);
    let line = InspectionLine::of(&scene, &inspected.inspection)
        .reported_as(report.verdict.reported_as.as_deref())
        .to_json();
    let stages = stage_pictures(&inspected.scene, &inspected.inspection);
    let mut out = ReportFolder::make(folder).map_err(trouble)?;
    let path = out.write(&name, &line, &stages).map_err(trouble)?;
    let view = shot.and_then(|shot| on_paper(shot).take().ok());
    let view = view.map(|view| DynamicImage::from(view).into_rgb8());
    let pictures = PdfPictures {
        view: view.as_ref(),
        stages: &stages,
        title: inspected.part_title(),
    };
    let pdf = pose_pdf(report, &pictures);
    let files = [("json", report.to_json().into_bytes()), ("pdf", pdf)];
    let written = out.write_pose(&name, &files).map_err(trouble)?;
    let table = out.csv(report.robot.convention);
    let aside = append_csv(&table, report).map_err(|error| UserError::of(&error))?;
    let names: Vec<String> = [&path]
        .into_iter()
        .chain(&written)
        .map(|path| file_name(path))
        .collect();
    let (files, table) = (names.join(", "), file_name(&table));
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
    use crate::{
        app::inspection::{
            inspected::{InspectRequest, inspect, inspected_cell},
            library_cache::LibraryCache,
            source::{CellChoice, SceneSource},
        },
        kit::scene_of,
        pipeline::Unwatched,
        simulate::{CellSetup, PartKind, Side},
    };

    #[test]
    fn a_report_names_the_source_that_the_history_lists() {
        let setup = CellSetup::with_part(PartKind::Fender, Side::Left, 0, 3);
        let scene = Arc::new(scene_of(&setup));
        let frame = |is_simulated| Origin::Frame {
            name: "kinect frame 12".into(),
            is_simulated,
        };
        let file = Origin::File {
            path: "/data/door.pcd".into(),
            is_simulated: true,
        };
        for (origin, source) in [
            (frame(false), "Kinect frame 12"),
            (frame(true), "Kinect frame 12, simulated"),
            (file, "door.pcd, simulated"),
        ] {
            let request = InspectRequest {
                source: SceneSource::AtHand(Arc::clone(&scene), origin),
                recipe: Arc::default(),
            };
            let library = LibraryCache::default();
            let inspected = inspect(&request, &library, &Unwatched).expect("inspected");
            assert_eq!(inspected.entry.record.summary.source, source);
            let report = report_of(&inspected, inspected.trace(), None, Convention::Kuka);
            assert_eq!(report.source.as_deref(), Some(source));
        }
    }

    #[test]
    fn a_report_names_the_part_not_the_reference_that_was_found() {
        let mut inspected = inspected_cell(CellChoice::InTurn, 1);
        "front_door_b".clone_into(&mut inspected.figures.candidates[0].title);
        let pose = report_of(&inspected, inspected.trace(), None, Convention::Kuka);
        let folder = tempfile::tempdir().expect("a folder");
        report(folder.path(), &inspected, &pose, None).expect("written");
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
