//! What servoing has to know besides the part, and the task and the fence that follow for a part: once for streams of poses and
//! for single moves.

use std::time::Duration;

use nalgebra::Point3;

use capture::SourceSpec;
use geometry::{
    error::Advice,
    oriented_box::OrientedBox,
    rigid::{PoseDelta, RigidTransform},
    units::Metres,
};
use inspection::{
    library::{Library, SprayPath},
    pipeline::{Expected, ExpectedError, NamedRecipe, Unwatched, run as inspect},
};
use robot::{
    arm::{GUN_RADIUS_M, PlacedArm},
    calibration::CameraPlace,
    spray::{OffThePart, off_the_part},
};
use servo::{Fence, Look, ServoParams, StopReason, Target, Task, TaskError, Tool};
use stages::{rack::Rack, reference::Reference, scene::SceneCloud};

/// Where the part should be, for any part.
pub enum ServoTarget {
    /// At its standard position.
    StandardPosition,
    /// Where it is in these scenes, which have names.
    SeenAs(Vec<(String, SceneCloud)>),
    /// The nozzle at the first point of its spray path.
    PathStart,
}

/// What servoing has to know besides the part.
pub struct ServoSetup {
    /// The camera's place.
    pub camera: CameraPlace,
    /// Bounds of the calibration, 95 %, if they are known.
    pub calibration: Option<PoseDelta>,
    /// Where the part should be.
    pub target: ServoTarget,
    /// The nozzle on the flange, if there is one.
    pub flange_from_nozzle: Option<RigidTransform>,
    /// The arm with its obstacles, if it is known.
    pub placed: Option<PlacedArm>,
    /// Work volume in the base frame; anywhere without one.
    pub volume: Option<OrientedBox>,
    /// Limits and tolerances.
    pub params: ServoParams,
}

/// A part that can be servoed to.
pub struct PreparedTask {
    /// What is moved where.
    pub task: Task,
    /// Where the robot may be.
    pub fence: Fence,
    /// The recipe, which expects the part.
    pub recipe: NamedRecipe,
    /// The scenes of the target that show no pose to move by, and why not.
    pub refused: Vec<(String, StopReason)>,
}

/// Why a part cannot be servoed to.
#[derive(Debug, thiserror::Error, Advice)]
pub enum SetupError {
    /// The part is not enrolled.
    #[error("{part} is not enrolled")]
    #[advice = "See the parts with partsight library list"]
    NotEnrolled {
        /// Its name.
        part: String,
    },
    /// The part has several references, or one without points.
    #[error("{part} has several references")]
    #[advice = "Name the one that hangs there: partsight library list"]
    SeveralReferences {
        /// Its name.
        part: String,
    },
    /// The frames were taken earlier.
    #[error("{from} is replayed: its frames do not show what hangs there now")]
    #[advice = "Give a camera as --source; to try it without one: partsight servo --simulated"]
    Replayed {
        /// The source.
        from: String,
    },
    /// The scenes of the target show no common pose.
    #[error(
        "{part} is not accepted in at least half of the frames of the target, in the same place"
    )]
    #[advice = "Take the frames again, with the whole part in the picture and the camera at rest"]
    NotRecorded {
        /// The part.
        part: String,
    },
    /// The part has no spray path.
    #[error("{part} has no spray path")]
    #[advice = "Store one with partsight library path {part} YOUR_PATH.csv, or plan one with partsight path plan {part}"]
    NoPath {
        /// The part.
        part: String,
    },
    /// The path does not aim at the part.
    #[error(transparent)]
    #[advice(transparent)]
    OffThePart(#[from] OffThePart),
    /// There is no nozzle that could go to the start of a path.
    #[error("where the nozzle sits on the flange is not known")]
    #[advice = "Give its pose with --nozzle"]
    NoNozzle,
    /// It is not known how exact the calibration is.
    #[error(
        "how exact the calibration is, is not known: its numbers were entered by hand, or the pairs do not bound them"
    )]
    #[advice = "Calibrate from pairs of poses (partsight calibrate hand-eye), which also tells how exact it is, or servo to the standard position or to --seen-as"]
    NoBounds,
    /// The part cannot be expected.
    #[error(transparent)]
    #[advice(transparent)]
    Expected(#[from] ExpectedError),
    /// The task cannot be done.
    #[error(transparent)]
    #[advice(transparent)]
    Task(#[from] TaskError),
}

impl SetupError {
    /// A name for programs.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::NotEnrolled { .. } => "not_enrolled",
            Self::SeveralReferences { .. } => "several_references",
            Self::Replayed { .. } => "replayed",
            Self::NotRecorded { .. } => "not_recorded",
            Self::NoPath { .. } => "no_path",
            Self::OffThePart(_) => "off_the_part",
            Self::NoNozzle => "no_nozzle",
            Self::NoBounds => "no_calibration_bounds",
            Self::Expected(_) => "not_expected",
            Self::Task(_) => "no_task",
        }
    }
}

/// Radius around the camera that is kept clear.
const CAMERA_RADIUS_M: f64 = 0.06;
/// How far the start of a path may be away: the nozzle is much nearer to the part than the camera.
const MAX_WAY_TO_PATH: Metres = Metres(1.2);

/// Refuses a source whose frames do not show what hangs there now.
pub fn check_source(source: &SourceSpec) -> Result<(), SetupError> {
    if source.is_replayed() {
        let from = source.to_string();
        return Err(SetupError::Replayed { from });
    }
    Ok(())
}

/// The reference with a name, and its middle.
pub fn reference_of<'a>(
    library: &'a Library,
    part: &str,
) -> Result<(&'a Reference, Point3<f64>), SetupError> {
    let part = part.to_owned();
    if !library.has_reference(&part) {
        return Err(SetupError::NotEnrolled { part });
    }
    let mut references = library.references.iter();
    let reference = references.find(|one| one.enrolled_as == part);
    let with_middle = reference.and_then(|one| Some((one, one.middle()?)));
    with_middle.ok_or(SetupError::SeveralReferences { part })
}

impl ServoSetup {
    /// Limits and tolerances for this target.
    pub fn params(&self) -> ServoParams {
        let mut params = self.params.clone();
        if let ServoTarget::PathStart = self.target {
            params.max_error.shift = MAX_WAY_TO_PATH;
        }
        params
    }

    /// What is moved where for this reference of the library; `path` is its stored spray path.
    pub fn prepare(
        &self,
        name: &str,
        path: Option<&SprayPath>,
        library: &Library,
        recipe: &NamedRecipe,
    ) -> Result<PreparedTask, SetupError> {
        let (reference, middle) = reference_of(library, name)?;
        let expected = Expected::new(vec![name.into()], None, |_| true)?;
        // The boxes of a rack are where the camera does not move.
        let recipe = recipe.in_rack(Rack::default()).expecting(expected);
        let mut task = Task {
            part: reference.name.clone(),
            reference: name.to_owned(),
            middle,
            camera: self.camera,
            target: Target::standard_position(),
        };
        let mut refused = Vec::new();
        match &self.target {
            ServoTarget::StandardPosition => {}
            ServoTarget::SeenAs(scenes) => {
                let looks = scenes.iter().filter_map(|(scene_name, scene)| {
                    let inspection = inspect(scene, library, &recipe, &Unwatched).ok()?;
                    let look = Look::new(&task, &inspection, Duration::ZERO);
                    if let Err(reason) = &look.seen {
                        refused.push((scene_name.clone(), reason.clone()));
                    }
                    Some(look)
                });
                // Frames of another part are those of its own target.
                let looks =
                    looks.filter(|look| !matches!(look.seen, Err(StopReason::AnotherPart { .. })));
                let looks: Vec<Look> = looks.collect();
                let target = Target::recorded(&looks, &task.middle);
                let part = name.to_owned();
                task.target = target.ok_or(SetupError::NotRecorded { part })?;
            }
            ServoTarget::PathStart => {
                let part = name.to_owned();
                let path = path.ok_or(SetupError::NoPath { part })?;
                task.target = self.path_start(path, reference, &recipe)?;
            }
        }
        Ok(PreparedTask {
            fence: self.fence(&task, reference),
            task: task.checked()?,
            recipe,
            refused,
        })
    }

    fn path_start(
        &self,
        path: &SprayPath,
        reference: &Reference,
        recipe: &NamedRecipe,
    ) -> Result<Target, SetupError> {
        if let Some(off) = off_the_part(path, reference) {
            return Err(off.into());
        }
        let nozzle = self.flange_from_nozzle.ok_or(SetupError::NoNozzle)?;
        let bounds = self.calibration.ok_or(SetupError::NoBounds)?;
        Ok(Target::path_start(path, nozzle, bounds, &recipe.stand_off)?)
    }

    /// What every commanded pose is kept clear of.
    fn fence(&self, task: &Task, reference: &Reference) -> Fence {
        let mut fence = Fence::none();
        fence.volume = self.volume;
        if let Some(placed) = &self.placed {
            fence.obstacles = placed.obstacles.clone();
        }
        let mut keep_clear = |pose: &RigidTransform, radius| {
            fence.tools.push(Tool {
                end: Point3::from(pose.translation.vector),
                radius,
            });
        };
        if let Some(nozzle) = &self.flange_from_nozzle {
            keep_clear(nozzle, GUN_RADIUS_M);
        }
        if let CameraPlace::OnFlange {
            flange_from_camera, ..
        } = &task.camera
        {
            keep_clear(flange_from_camera, CAMERA_RADIUS_M);
        }
        fence.arm.clone_from(&self.placed);
        if !task.is_part_held() {
            fence.part.clone_from(&reference.cloud.points);
        }
        fence
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{rigid::pose_error, units::Radians};
    use inspection::fixtures::shipped_library;
    use robot::spray::default_path;
    use simulate::{CellSetup, PartKind, Side, frame};
    use stages::{
        rack::{MaxTurn, Place},
        scene::scene_from_frame,
        stand_off::StandOffParams,
    };

    fn setup(target: ServoTarget) -> ServoSetup {
        ServoSetup {
            camera: CameraPlace::OnFlange {
                flange_from_camera: RigidTransform::translation(0.1, 0.0, 0.1),
                capture_pose: None,
            },
            calibration: Some(PoseDelta {
                shift: Metres(0.001),
                rotation: Radians(0.002),
            }),
            target,
            flange_from_nozzle: Some(RigidTransform::translation(0.0, 0.0, 0.3)),
            placed: None,
            volume: None,
            params: ServoParams::default(),
        }
    }

    fn scene(kind: PartKind, seed: u64) -> (String, SceneCloud) {
        let simulated = frame(&CellSetup::with_part(kind, Side::Left, 0, seed));
        (format!("{kind:?}"), scene_from_frame(&simulated.frame))
    }

    #[test]
    fn frames_of_several_parts_are_each_the_target_of_their_own() {
        let (library, recipe) = (shipped_library(), NamedRecipe::default());
        let scenes = [PartKind::Fender, PartKind::Grille].map(|kind| scene(kind, 1));
        let seen_as = setup(ServoTarget::SeenAs(scenes.into()));
        let prepare = |part| seen_as.prepare(part, None, &library, &recipe);
        let fender = prepare("fender").expect("seen");
        let Target::SeenAt { camera_from_part } = fender.task.target else {
            panic!("{:?}", fender.task.target);
        };
        let here = RigidTransform::identity();
        let off = pose_error(&camera_from_part, &here, &fender.task.middle);
        assert!(off.shift.mm() > 1.0, "where it was seen: {off:?}");
        assert_eq!(fender.refused.len(), 1, "the grille");
        // The camera and the nozzle.
        assert_eq!(fender.fence.tools.len(), 2);
        assert!(!fender.fence.part.is_empty());
        assert!(prepare("grille").is_ok());
        let error = prepare("front_door").err().expect("not seen");
        assert_eq!(error.kind(), "not_recorded");
        let error = prepare("boat").err().expect("not enrolled");
        assert_eq!(error.kind(), "not_enrolled");
    }

    #[test]
    fn a_rack_says_nothing_to_a_camera_that_moves() {
        let library = shipped_library();
        let far = Place {
            name: "far".into(),
            region: OrientedBox {
                centre_m: [9.0, 0.0, 2.0],
                size_m: [0.1; 3],
                angles_rad: [0.0; 3],
            },
            max_turn: MaxTurn::Total(Radians(0.1)),
            parts: Vec::new(),
        };
        let rack = Rack {
            places: vec![far],
            ..Rack::default()
        };
        let recipe = NamedRecipe::default().in_rack(rack);
        let seen_as = setup(ServoTarget::SeenAs(vec![scene(PartKind::Fender, 1)]));
        let prepared = seen_as.prepare("fender", None, &library, &recipe);
        assert!(prepared.is_ok(), "{:?}", prepared.err());
    }

    #[test]
    fn the_start_of_a_path_needs_the_path_the_nozzle_and_the_bounds_of_the_calibration() {
        let (library, recipe) = (shipped_library(), NamedRecipe::default());
        let path_of = |part| {
            let (reference, _) = reference_of(&library, part).expect("enrolled");
            default_path(reference, &StandOffParams::default()).expect("a surface")
        };
        let path = path_of("fender");
        let start = || setup(ServoTarget::PathStart);
        let kind = |setup: ServoSetup, path| {
            let prepared = setup.prepare("fender", path, &library, &recipe);
            prepared.err().map(|error| {
                assert!(!error.advice().is_empty());
                error.kind()
            })
        };
        assert_eq!(kind(start(), Some(&path)), None);
        assert_eq!(kind(start(), None), Some("no_path"));
        let beside = path.points().iter().map(|point| {
            let mut point = *point;
            point.nozzle.x += 3.0;
            point
        });
        let far = SprayPath::new(beside.collect()).expect("a point");
        assert_eq!(kind(start(), Some(&far)), Some("off_the_part"));
        let mut without = start();
        without.flange_from_nozzle = None;
        assert_eq!(kind(without, Some(&path)), Some("no_nozzle"));
        let mut without = start();
        without.calibration = None;
        assert_eq!(kind(without, Some(&path)), Some("no_calibration_bounds"));
        assert!(
            start().params().max_error.shift
                > setup(ServoTarget::StandardPosition)
                    .params()
                    .max_error
                    .shift
        );
    }
}
