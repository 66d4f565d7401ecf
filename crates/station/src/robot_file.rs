//! Files that a robot acts on: a carried path as poses, or as a program for its controller.
//!
//! [`RobotFile::write`] is the only way to such a file, for the commands and the window alike. A file of an earlier part
//! never remains, a file with doubts is only written if that is forced, and it contains each of them, as well as what
//! was not checked.

use std::{
    iter,
    path::{Path, PathBuf},
};

use nalgebra::Point3;

use super::{Doubt, Inspected};
use files::FileError;
use geometry::{cloud::PointCloud, error::Advice, rigid::RigidTransform};
use inspection::library::{Side, SprayPath};
use robot::{
    Convention, RobotFrame,
    arm::{ArmError, FilmRoom, PathCheck, PlacedArm},
    paint::{Coat, WrittenFilm},
    program::{
        Program, ProgramError, ProgramPoint, ProgramSettings, RobotLanguage, check_reach,
        program_points, remove_previous_program,
    },
    spray::{BandStatus, CarriedPath, OffThePart, SprayExport, remove_previous_export},
};
use stages::{reference::Coverage, segment::MAX_PARTS, stand_off::StandOffParams};
use texts::{Described, Message};

/// A path to be written for a robot.
#[derive(Clone, Debug)]
pub struct RobotFile<'a> {
    /// The file.
    pub file: &'a Path,
    /// What it contains.
    pub content: RobotFileContent<'a>,
    /// The path, carried to the part.
    pub carried: &'a CarriedPath,
    /// The robot's frame.
    pub frame: &'a RobotFrame,
    /// Name of the part.
    pub part: &'a str,
    /// Cloud that the part was enrolled with, part frame.
    pub part_cloud: &'a PointCloud,
    /// The sides of the part that were enrolled.
    pub coverage: Coverage,
    /// The side that the part is painted from; none for its own.
    pub side: Option<Side>,
    /// The path, part frame, of which a program's accelerations and film are computed; none if it is not known.
    pub path: Option<&'a SprayPath>,
    /// Whether the path does not aim at the part.
    pub off: Option<OffThePart>,
    /// The inspection that found the part; none for its standard position.
    pub capture: Option<Inspected<'a>>,
    /// What else hangs in the capture, which the arm must not run into: the readings of each, camera space, metres.
    pub beside: &'a [&'a [Point3<f32>]],
    /// The part's pose.
    pub camera_from_part: RigidTransform,
    /// True for the part's stored path, false for the default point of a part without one.
    pub is_stored: bool,
    /// True if the scene, or the enrolled part, was simulated.
    pub is_simulated: bool,
    /// True to write the file despite doubts.
    pub is_forced: bool,
}

/// What a file for a robot contains.
#[derive(Clone, Copy, Debug)]
pub enum RobotFileContent<'a> {
    /// Poses: JSON if the file's name ends in `.json`, else CSV.
    Poses {
        /// Convention of the poses.
        convention: Convention,
        /// The band with which the path was compared.
        params: &'a StandOffParams,
    },
    /// A program for the robot's controller.
    Program {
        /// The language.
        language: &'static RobotLanguage,
        /// Tool, gun and moves.
        settings: &'a ProgramSettings,
        /// The arm whose reach is checked, without parts among its obstacles; none to check no reach.
        arm: Option<&'a PlacedArm>,
    },
}

/// What was written.
#[derive(Clone, Debug, PartialEq)]
pub struct WrittenRobotFile {
    /// Number of programs that the main program calls, which lie beside it.
    pub num_called: usize,
    /// Doubts despite which it was written.
    pub doubts: Vec<Doubt>,
    /// Figures of a program's film and of the planned one; none for poses, or if the path names no coat.
    pub film: Option<String>,
    /// What was not checked.
    pub unchecked: Vec<Unchecked>,
}

/// Why no file was written.
#[derive(Debug, thiserror::Error, Advice)]
pub enum RobotFileError {
    /// There are doubts, the one to show first.
    #[error("{}", .0.first().map_or_else(String::new, ToString::to_string))]
    #[advice(_0.first().map_or_else(String::new, Advice::advice))]
    Doubts(Vec<Doubt>),
    /// A file cannot be removed or written.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// The program cannot be written.
    #[error(transparent)]
    #[advice(transparent)]
    Program(#[from] ProgramError),
    /// The arm cannot be checked.
    #[error(transparent)]
    #[advice(transparent)]
    Arm(#[from] ArmError),
}

/// Something about a path that was not checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unchecked {
    /// No arm is known.
    Arm,
    /// A line moves the part while the program runs.
    MovingPart,
    /// No boxes and no floor of the cell are known.
    Surroundings,
    /// The coat of a program's path is not known.
    Film,
    /// Limits that the arm's file lacks: `joints`, `rail` or `joints and rail`.
    Accelerations(&'static str),
    /// Points in front of which the camera saw no surface.
    NotSeen {
        /// Their number.
        num: usize,
        /// Number of all points.
        num_points: usize,
    },
}

impl Described for Unchecked {
    fn message(&self) -> Message {
        match self {
            Self::Arm => Message::new("unchecked-arm"),
            Self::MovingPart => Message::new("unchecked-moving-part"),
            Self::Surroundings => Message::new("unchecked-surroundings"),
            Self::Film => Message::new("unchecked-film"),
            Self::Accelerations(what) => {
                Message::new("unchecked-accelerations").with("what", *what)
            }
            Self::NotSeen { num, num_points } => Message::new("unchecked-not-seen")
                .with("num", *num as f64)
                .with("num_points", *num_points as f64),
        }
    }
}

texts::display!(Unchecked);

impl Unchecked {
    /// What is not checked about a path that this arm is to follow.
    pub fn of_arm(arm: Option<&PlacedArm>) -> Vec<Self> {
        let Some(arm) = arm else {
            return vec![Self::Arm];
        };
        let is_alone = arm.obstacles.file().is_none();
        let surroundings = is_alone.then_some(Self::Surroundings);
        let accelerations = arm.arm.unchecked_accelerations().map(Self::Accelerations);
        surroundings.into_iter().chain(accelerations).collect()
    }

    /// The points of a path that could not be compared with what the camera saw; `None` if all could.
    pub fn of_points(carried: &CarriedPath) -> Option<Self> {
        let num = carried.count(BandStatus::NotSeen);
        (num > 0).then_some(Self::NotSeen {
            num,
            num_points: carried.points.len(),
        })
    }
}

/// Removes an earlier file for a robot of this name, so that no robot acts on it for the next part. Other files of this
/// name stay.
pub fn remove_previous(file: &Path) -> Result<(), FileError> {
    remove_previous_program(file)?;
    remove_previous_export(file)?;
    Ok(())
}

/// As [`remove_previous`], and the files of several parts too.
pub fn remove_previous_of_parts(file: &Path) -> Result<(), FileError> {
    let of_parts = (1..=MAX_PARTS).map(|number| file_of_part(file, number));
    iter::once(file.to_owned())
        .chain(of_parts)
        .try_for_each(|file| remove_previous(&file))
}

/// The file of one of several parts of a frame, such as `paint_2.src`; the first has number 1.
pub fn file_of_part(file: &Path, number: usize) -> PathBuf {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let mut name = format!("{stem}_{number}");
    if let Some(ending) = file.extension() {
        name = format!("{name}.{}", ending.to_string_lossy());
    }
    file.with_file_name(name)
}

impl RobotFile<'_> {
    /// Removes an earlier file of that name, collects the doubts, and writes the file if there are none or if it is
    /// forced.
    pub fn write(&self) -> Result<WrittenRobotFile, RobotFileError> {
        remove_previous(self.file)?;
        let reach = self.reach()?;
        let points = program_points(
            self.carried,
            self.frame,
            reach.as_ref().map(|(_, check)| check),
        );
        let film = self.film(&points, reach.as_ref());
        let doubts = self.doubts(reach.as_ref(), film.as_ref());
        let may_be_written = self.is_forced && doubts.iter().all(Doubt::may_be_forced);
        if !doubts.is_empty() && !may_be_written {
            return Err(RobotFileError::Doubts(doubts));
        }
        let unchecked = self.unchecked(film.as_ref());
        let film = film.as_ref().map(WrittenFilm::line);
        let num_called = self.save(
            &points,
            reach.as_ref(),
            film.as_deref(),
            &doubts,
            &unchecked,
        )?;
        Ok(WrittenRobotFile {
            num_called,
            doubts,
            film,
            unchecked,
        })
    }

    /// The arm with all parts among its obstacles, and which points it reaches; `None` without an arm.
    fn reach(&self) -> Result<Option<(PlacedArm, PathCheck)>, ArmError> {
        let RobotFileContent::Program {
            settings,
            arm: Some(arm),
            ..
        } = self.content
        else {
            return Ok(None);
        };
        let robot_from_part = self.frame.robot_from_part(&self.camera_from_part);
        let arm = arm
            .clone()
            .with_part(&self.part_cloud.points, &robot_from_part);
        let robot_from_camera = &self.frame.robot_from_camera;
        let arm = (self.beside.iter()).fold(arm, |arm, points| {
            arm.with_other_part(points, robot_from_camera)
        });
        let film = self
            .path
            .and_then(|path| FilmRoom::of_path(path, self.part_cloud, self.coverage, self.side));
        let check = check_reach(&arm, self.carried, self.frame, settings, film.as_ref())?;
        Ok(Some((arm, check)))
    }

    /// The film that a program leaves; `None` for poses, and if the path names no coat.
    fn film(
        &self,
        points: &[ProgramPoint],
        reach: Option<&(PlacedArm, PathCheck)>,
    ) -> Option<WrittenFilm> {
        let RobotFileContent::Program {
            language, settings, ..
        } = self.content
        else {
            return None;
        };
        WrittenFilm::of(
            &self.program(settings, points, reach),
            language,
            self.path?,
            self.part_cloud,
            self.coverage,
            self.side,
        )
    }

    /// The program, without its scene, doubts and figures.
    fn program<'p>(
        &'p self,
        settings: &'p ProgramSettings,
        points: &'p [ProgramPoint],
        reach: Option<&'p (PlacedArm, PathCheck)>,
    ) -> Program<'p> {
        Program {
            points,
            settings,
            acceleration: self.path.and_then(Coat::acceleration_of),
            film: None,
            reach,
            part: self.part,
            scene: None,
            robot_from_part: self.frame.robot_from_part(&self.camera_from_part),
            calibration: &self.frame.name,
            is_simulated: self.is_simulated,
            doubts: &[],
            unchecked: &[],
            at: geometry::clock::now(),
        }
    }

    /// All doubts. That the path does not aim at the part comes first: neither another capture nor another place of the
    /// arm helps against it.
    fn doubts(
        &self,
        reach: Option<&(PlacedArm, PathCheck)>,
        film: Option<&WrittenFilm>,
    ) -> Vec<Doubt> {
        let of_capture = self.capture.iter().flat_map(Inspected::doubts);
        let missed = reach.and_then(|(arm, check)| check.missed(&arm.arm.name));
        let off = self.off.map(Doubt::OffThePart);
        off.into_iter()
            .chain(of_capture)
            .chain(missed.map(Doubt::NotReached))
            .chain(film.and_then(WrittenFilm::doubt).map(Doubt::FilmOffPlan))
            .collect()
    }

    fn unchecked(&self, film: Option<&WrittenFilm>) -> Vec<Unchecked> {
        let mut unchecked = match self.content {
            RobotFileContent::Program { settings, .. } if settings.tracking.is_some() => {
                vec![Unchecked::MovingPart]
            }
            RobotFileContent::Program { arm, .. } => Unchecked::of_arm(arm),
            RobotFileContent::Poses { .. } => Unchecked::of_arm(None),
        };
        let is_program = matches!(self.content, RobotFileContent::Program { .. });
        if is_program && film.is_none() {
            unchecked.push(Unchecked::Film);
        }
        // In the standard position, nothing was to be seen.
        if self.capture.is_some() {
            unchecked.extend(Unchecked::of_points(self.carried));
        }
        unchecked
    }

    /// Writes the file; returns the number of programs that it calls.
    fn save(
        &self,
        points: &[ProgramPoint],
        reach: Option<&(PlacedArm, PathCheck)>,
        film: Option<&str>,
        doubts: &[Doubt],
        unchecked: &[Unchecked],
    ) -> Result<usize, RobotFileError> {
        let doubts: Vec<String> = doubts.iter().map(ToString::to_string).collect();
        let unchecked: Vec<String> = unchecked.iter().map(ToString::to_string).collect();
        let scene = self.capture.map(|capture| capture.subject.scene_in_words());
        let scene = scene.as_deref();
        match self.content {
            RobotFileContent::Poses { convention, params } => {
                let is_accepted = self
                    .capture
                    .is_none_or(|capture| capture.inspection.verdict.is_accepted());
                let export = SprayExport {
                    path: self.carried,
                    part: self.part,
                    scene: scene.unwrap_or("standard position"),
                    frame: self.frame,
                    convention,
                    params,
                    is_stored: self.is_stored,
                    is_accepted,
                    is_simulated: self.is_simulated,
                    doubts: &doubts,
                    unchecked: &unchecked,
                    at: geometry::clock::now(),
                };
                export.save(self.file)?;
                Ok(0)
            }
            RobotFileContent::Program {
                language, settings, ..
            } => {
                let program = Program {
                    scene,
                    film,
                    doubts: &doubts,
                    unchecked: &unchecked,
                    ..self.program(settings, points, reach)
                };
                Ok(program.save(self.file, language)?)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::{fs, sync::Arc};

    use super::*;
    use crate::Subject;
    use capture::fixtures::captured;
    use inspection::{
        fixtures::shipped_library,
        library::Library,
        pipeline::{Inspection, NamedRecipe, Unwatched, live::refuse_moving, run},
    };
    use robot::{
        program::TrackingFrame,
        spray::{carry, default_path},
    };
    use simulate::{PartKind, Side};
    use stages::{fixtures::facing_part, pose::RunnerUp, scene::SceneCloud};

    /// A fender that was found, and the default point of its path.
    struct Bench {
        path: SprayPath,
        library: Library,
        scene: Arc<SceneCloud>,
        recipe: NamedRecipe,
        inspection: Inspection,
        carried: CarriedPath,
        frame: RobotFrame,
        params: StandOffParams,
        settings: ProgramSettings,
    }

    impl Bench {
        fn new() -> Self {
            let library = shipped_library();
            let scene = Arc::new(facing_part(PartKind::Fender, Side::Left, 5));
            let recipe = NamedRecipe::default();
            let inspection = run(&scene, &library, &recipe, &Unwatched).expect("run");
            let params = StandOffParams::default();
            let path = default_path(inspection.best_reference(&library).expect("one"), &params);
            let path = path.expect("a path");
            let pose = inspection.found_pose().expect("a pose");
            let seen = inspection.segmentation.part.as_ref().expect("a part");
            let hangs = pose.camera_from_part();
            Self {
                carried: carry(&path, &hangs, &seen.cloud, &params),
                path,
                library,
                scene,
                recipe,
                inspection,
                frame: RobotFrame {
                    robot_from_camera: RigidTransform::identity(),
                    name: "cell 1".into(),
                },
                params,
                settings: ProgramSettings::default(),
            }
        }

        fn content(&self, file: &Path) -> RobotFileContent<'_> {
            match RobotLanguage::from_file(file) {
                Ok(language) => RobotFileContent::Program {
                    language,
                    settings: &self.settings,
                    arm: None,
                },
                Err(_) => RobotFileContent::Poses {
                    convention: Convention::Matrix,
                    params: &self.params,
                },
            }
        }

        fn file<'a>(&'a self, file: &'a Path, subject: &'a Subject) -> RobotFile<'a> {
            let best = self.inspection.best_reference(&self.library);
            RobotFile {
                file,
                content: self.content(file),
                carried: &self.carried,
                frame: &self.frame,
                part: "fender",
                part_cloud: &best.expect("one").cloud,
                coverage: Coverage::OneSide,
                side: None,
                path: Some(&self.path),
                off: None,
                capture: Some(Inspected {
                    subject,
                    scene: &self.scene,
                    inspection: &self.inspection,
                    recipe: &self.recipe,
                    robot: Some(&self.frame),
                    is_forced: false,
                    on_line: None,
                }),
                beside: &[],
                camera_from_part: self
                    .inspection
                    .found_pose()
                    .expect("a pose")
                    .camera_from_part(),
                is_stored: true,
                is_simulated: true,
                is_forced: false,
            }
        }
    }

    /// A capture of just now.
    fn fresh() -> Subject {
        Subject::of_scene("fender.pcd".into(), "file".into(), true)
    }

    const NAMES: [&str; 3] = ["out.csv", "out.json", "paint.src"];

    /// The letters and digits of a text, which a header may break into lines anywhere.
    fn letters(text: &str) -> String {
        text.chars().filter(char::is_ascii_alphanumeric).collect()
    }

    fn contains(file: &Path, words: &str) -> bool {
        let text = fs::read_to_string(file).expect("read");
        letters(&text).contains(&letters(words))
    }

    #[test]
    fn with_a_doubt_no_file_of_any_kind_remains_and_a_forced_one_names_every_doubt() {
        let mut bench = Bench::new();
        let folder = tempfile::tempdir().expect("a folder");
        let now = fresh();
        let old = Subject {
            currency: Some(Doubt::Old),
            ..fresh()
        };
        for name in NAMES {
            let path = folder.path().join(name);
            let written = bench.file(&path, &now).write().expect("no doubts");
            assert_eq!(written.doubts, []);
            assert!(path.exists());
        }
        let Some(Ok(pose)) = &mut bench.inspection.pose else {
            panic!("a pose");
        };
        pose.runner_up = Some(RunnerUp {
            target_from_source: pose.target_from_source,
            ratio: 1.01,
        });
        let off = OffThePart {
            num_spraying: 5,
            num_aiming: 0,
            num_too_near: 0,
        };
        for name in NAMES {
            let path = folder.path().join(name);
            let mut file = bench.file(&path, &old);
            file.off = Some(off);
            let Err(RobotFileError::Doubts(doubts)) = file.write() else {
                panic!("{name} was written");
            };
            let kinds: Vec<&str> = doubts.iter().map(Doubt::kind).collect();
            assert_eq!(kinds, ["off_the_part", "old", "ambiguous_pose"]);
            assert!(!path.exists(), "{name}: the file of the part before");
            file.is_forced = true;
            let written = file.write().expect("forced");
            assert_eq!(written.doubts, doubts);
            for doubt in &doubts {
                assert!(contains(&path, &doubt.to_string()), "{name}: {doubt}");
            }
            let mut refused = bench.inspection.clone();
            refuse_moving(&mut refused);
            let mut file = bench.file(&path, &old);
            file.is_forced = true;
            if let Some(capture) = &mut file.capture {
                capture.inspection = &refused;
            }
            let error = file.write().expect_err("never of a part that was refused");
            assert!(matches!(error, RobotFileError::Doubts(_)), "{error}");
            assert!(!path.exists());
        }
    }

    #[test]
    fn what_was_not_checked_is_returned_and_in_every_kind_of_file() {
        let mut bench = Bench::new();
        let unseen = CarriedPath {
            points: vec![bench.carried.points[0]; 3],
        };
        bench.carried = unseen;
        bench.carried.points[1].band = BandStatus::NotSeen;
        let folder = tempfile::tempdir().expect("a folder");
        let now = fresh();
        for name in NAMES {
            let path = folder.path().join(name);
            let written = bench.file(&path, &now).write().expect("written");
            let not_seen = Unchecked::NotSeen {
                num: 1,
                num_points: 3,
            };
            let mut expected = vec![Unchecked::Arm, not_seen];
            if RobotLanguage::from_file(&path).is_ok() {
                expected.insert(1, Unchecked::Film);
            }
            assert_eq!(written.unchecked, expected);
            for unchecked in &written.unchecked {
                let words = unchecked.to_string();
                assert!(contains(&path, &words), "{name}: {words}");
            }
        }
    }

    #[test]
    fn of_a_program_for_a_moving_part_no_arm_is_asked_for() {
        let mut bench = Bench::new();
        bench.settings.tracking = Some(TrackingFrame {
            number: 1,
            robot_from_frame: RigidTransform::identity(),
        });
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("paint.mod");
        let written = bench.file(&path, &fresh()).write().expect("written");
        assert_eq!(written.unchecked, [Unchecked::MovingPart, Unchecked::Film]);
        assert!(contains(
            &path,
            "reach and collisions, because the line moves the part"
        ));
        let advice = Unchecked::MovingPart.message().command_advice();
        assert!(!advice.contains("arm"), "{advice}");
    }

    #[test]
    fn a_file_of_a_replayed_frame_says_that_it_was_recorded_earlier() {
        let bench = Bench::new();
        let folder = tempfile::tempdir().expect("a folder");
        let frame = captured(1, geometry::clock::now());
        let recording = "recording:monday".parse().expect("a source");
        let replayed = Subject::of_capture(&frame, &recording, 0);
        for name in NAMES {
            let path = folder.path().join(name);
            bench.file(&path, &fresh()).write().expect("written");
            assert!(!contains(&path, "recorded earlier"), "{name}");
            bench.file(&path, &replayed).write().expect("written");
            assert!(contains(&path, "recorded earlier"), "{name}");
        }
    }
}
