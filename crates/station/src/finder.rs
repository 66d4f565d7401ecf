//! Converts an inspection into a robot's result: a pose in its base frame, or why there is none.

use std::time::Instant;

use super::{Inspected, NoFrame};
use geometry::rigid::RigidTransform;
use inspection::{
    library::{Library, SprayPath},
    pipeline::{Expected, ExpectedPart, Inspection, Recipe, Refusal, Rejection, Verdict},
};
use robot::{
    RobotFrame,
    spray::{BandStatus, OffThePart, carry},
};
use serve::{
    Answer, ExpectedNumber, ExpectedNumbers, Found, PathStep, PoseKind, Problem, RackPlace,
    VerdictCode,
};
use stages::rack::Rack;

/// Data about a reference of the library that a client gets besides its name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NumberedPart {
    /// Number from 1; 0 if it has none.
    pub number: u32,
    /// Its stored spray path.
    pub path: Option<SprayPath>,
    /// Why robots get no point of that path, if it does not aim at the part.
    pub off: Option<OffThePart>,
    /// True if it was enrolled from a simulation.
    pub is_simulated: bool,
}

/// The reason word of a part that moves: shorter than its kind of refusal, for programs that compare it.
const MOVING: &str = "moving";

/// Converts inspections into results for clients.
#[derive(Clone, Debug)]
pub struct PartFinder {
    /// One entry per reference, in the order of the library.
    pub parts: Vec<NumberedPart>,
    /// Position of the camera in the robot's base frame.
    pub robot: RobotFrame,
    /// Which pose is sent.
    pub kind: PoseKind,
}

impl PartFinder {
    /// Converts an inspection of a frame of this time into its result. An accepted part about which there are doubts is
    /// refused: a robot cannot look into them.
    pub fn found(&self, inspected: &Inspected<'_>, captured: Instant) -> Found {
        let (subject, inspection) = (inspected.subject, inspected.inspection);
        let verdict = &inspection.verdict;
        let best = inspection.ranking.entries.first();
        let numbered = best.and_then(|best| self.parts.get(best.reference));
        let named = verdict.guess().filter(|_| !verdict.is_unknown());
        // An unknown part has no reference, so none that could be simulated.
        let of_named = named.and(numbered);
        let is_staged = subject.is_staged() || of_named.is_some_and(|part| part.is_simulated);
        let mut found = Found {
            captured: Some(captured),
            part: named.unwrap_or_default().to_owned(),
            number: of_named.map_or(0, |part| part.number),
            place: numbered_place(&inspected.recipe.rack, inspection.place.as_deref()),
            marks: if is_staged { Answer::SIMULATED } else { 0 },
            ..Found::default()
        };
        if let (Some(why), Some([what, advice])) = (verdict.refusal(), verdict.complaint()) {
            found.verdict = match verdict {
                Verdict::Part { .. } => VerdictCode::Refused,
                Verdict::NoPart(_) => VerdictCode::NoPart,
            };
            let reason = if matches!(why, Refusal::Rejected(Rejection::NotSteady { .. })) {
                MOVING.to_owned()
            } else {
                why.kind().to_string()
            };
            found.problem = Problem::new(reason, &what, &advice);
            return found;
        }
        if let Some(doubt) = inspected.doubts().first() {
            found.verdict = VerdictCode::Refused;
            found.problem = Problem::of(doubt.kind(), doubt);
            return found;
        }
        found.verdict = VerdictCode::Accepted;
        if verdict.is_approximate() {
            found.marks |= Answer::APPROXIMATE;
        }
        if subject.is_motion_unchecked {
            found.marks |= Answer::MOTION_UNCHECKED;
        }
        if let Some(pose) = inspection.found_pose() {
            let camera_from_part = pose.camera_from_part();
            found.pose = Some(match self.kind {
                PoseKind::RobotFromPart => self.robot.robot_from_part(&camera_from_part),
                PoseKind::RobotOffset => self.robot.robot_offset(&camera_from_part),
            });
            match numbered {
                Some(NumberedPart { off: Some(off), .. }) => {
                    found.no_path = Some(Problem::of("off_the_part", off));
                }
                Some(NumberedPart {
                    path: Some(path), ..
                }) => {
                    found.path =
                        self.carried(path, &camera_from_part, inspection, inspected.recipe);
                }
                _ => {}
            }
        }
        found
    }

    /// The parts with these numbers, by name, at places of this rack.
    pub(super) fn expected(
        &self,
        numbers: &ExpectedNumbers,
        rack: &Rack,
        library: &Library,
    ) -> Result<Expected, NoFrame> {
        let numbers = numbers.iter().filter(|one| one.is_given());
        let parts = numbers.map(
            |&ExpectedNumber {
                 part: number,
                 place,
             }| {
                let mut numbered = self.parts.iter().zip(&library.references);
                let part = numbered.find(|(part, _)| part.number == number);
                let (_, reference) = part.ok_or(NoFrame::UnknownNumber { number })?;
                let place = match place {
                    0 => None,
                    number => Some(place_of(rack, number)?),
                };
                let name = reference.name.clone();
                Ok(ExpectedPart { name, place })
            },
        );
        let parts = parts.collect::<Result<_, NoFrame>>()?;
        Ok(Expected::new(parts, Some(rack), |_| true)?)
    }

    /// The result for a part that is expected in this rack, and does not hang there.
    pub(super) fn missing(
        &self,
        part: &ExpectedPart,
        rack: &Rack,
        library: &Library,
        like: &Found,
    ) -> Found {
        let name = &part.name;
        let mut numbered = self.parts.iter().zip(&library.references);
        let numbered = numbered.find(|(_, reference)| reference.name == *name);
        let at = (part.place.as_ref()).map_or_else(String::new, |place| format!(" at {place}"));
        let what = format!("{name} is expected{at}, and does not hang there");
        let advice = "Hang it there, or correct what is expected";
        Found {
            verdict: VerdictCode::NoPart,
            captured: like.captured,
            part: name.clone(),
            number: numbered.map_or(0, |(part, _)| part.number),
            place: numbered_place(rack, part.place.as_deref()),
            marks: like.marks & Answer::SIMULATED,
            problem: Problem::new("missing", &what, advice),
            ..Found::default()
        }
    }

    fn carried(
        &self,
        path: &SprayPath,
        camera_from_part: &RigidTransform,
        inspection: &Inspection,
        recipe: &Recipe,
    ) -> Vec<PathStep> {
        let Ok(part) = &inspection.segmentation.part else {
            return Vec::new();
        };
        let carried = carry(path, camera_from_part, &part.cloud, &recipe.stand_off);
        let steps = carried.points.iter().map(|point| {
            let mark = |holds, mark| if holds { mark } else { 0 };
            PathStep {
                robot_from_nozzle: self.robot.robot_from_camera * point.camera_from_nozzle,
                marks: mark(point.is_gun_on, Answer::GUN_ON)
                    | mark(point.band == BandStatus::Inside, Answer::IN_BAND),
                speed: point.speed,
            }
        });
        steps.collect()
    }
}

/// The place of this name with its number, by its order in the rack.
pub(super) fn numbered_place(rack: &Rack, name: Option<&str>) -> Option<RackPlace> {
    let name = name?.to_owned();
    let number = rack.number_of(&name)?;
    Some(RackPlace { number, name })
}

/// The name of the place with this number from 1, by its order in the rack.
fn place_of(rack: &Rack, number: u32) -> Result<String, NoFrame> {
    let place = (rack.places.iter())
        .zip(1..)
        .find(|(_, known)| *known == number);
    let (place, _) = place.ok_or(NoFrame::UnknownPlace {
        number,
        num_places: rack.places.len(),
    })?;
    Ok(place.name.clone())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use nalgebra::{Point3, Unit, Vector3};

    use super::*;
    use crate::{Doubt, Subject};
    use geometry::{rigid::from_euler_zyx, units::Metres};
    use inspection::{
        fixtures::shipped_library,
        library::{Library, PathPoint},
        pipeline::{NamedRecipe, Unwatched, live::refuse_moving, run},
    };
    use simulate::{PartKind, Side};
    use stages::{
        fixtures::facing_part,
        pose::{PoseEstimate, RunnerUp, ScaleEstimate},
        scene::SceneCloud,
    };

    fn finder(library: &Library, kind: PoseKind) -> PartFinder {
        let point = |x| PathPoint {
            nozzle: Point3::new(x, 0.0, 1.0),
            direction: Unit::new_normalize(Vector3::z()),
            stand_off: Some(Metres::from_mm(150.0)),
            is_gun_on: x > 0.0,
            speed: Some(0.25),
            fan: None,
        };
        let path = SprayPath::new(vec![point(-0.1), point(0.1)]);
        let parts = (1..).take(library.references.len());
        let parts = parts.map(|number| NumberedPart {
            number,
            path: path.clone(),
            off: None,
            is_simulated: false,
        });
        PartFinder {
            parts: parts.collect(),
            robot: RobotFrame {
                robot_from_camera: from_euler_zyx([-2.2, 0.1, -1.6, 1.5, -0.2, 2.0]),
                name: "cell 1".into(),
            },
            kind,
        }
    }

    fn simulated() -> Subject {
        Subject::of_scene("frame".into(), "simulated".into(), true)
    }

    /// The result of an inspection of this subject, just captured.
    fn found(finder: &PartFinder, inspection: &Inspection, subject: &Subject) -> Found {
        let inspected = Inspected {
            subject,
            scene: &Arc::default(),
            inspection,
            recipe: &NamedRecipe::default(),
            robot: Some(&finder.robot),
            is_forced: false,
            on_line: None,
        };
        finder.found(&inspected, Instant::now())
    }

    #[test]
    fn an_accepted_part_has_its_pose_in_the_base_frame_and_its_path() {
        let library = shipped_library();
        let recipe = Recipe::default();
        let scene = facing_part(PartKind::Fender, Side::Left, 5);
        let inspection = run(&scene, &library, &recipe, &Unwatched).expect("not cancelled");
        let pose = inspection.found_pose();
        let pose = pose.expect("found").camera_from_part();
        let best = inspection
            .ranking
            .entries
            .first()
            .expect("ranked")
            .reference;
        for kind in [PoseKind::RobotFromPart, PoseKind::RobotOffset] {
            let finder = finder(&library, kind);
            let expected = match kind {
                PoseKind::RobotFromPart => finder.robot.robot_from_part(&pose),
                PoseKind::RobotOffset => finder.robot.robot_offset(&pose),
            };
            let found = found(&finder, &inspection, &simulated());
            assert_eq!(
                found.verdict,
                VerdictCode::Accepted,
                "{}",
                found.problem.message
            );
            assert_eq!(found.part, "fender");
            assert_eq!(found.number as usize, best + 1);
            assert_eq!(found.marks & Answer::SIMULATED, Answer::SIMULATED);
            assert_eq!(found.pose, Some(expected));
            assert_eq!(found.path.len(), 2);
            let guns = found.path.iter().map(|step| step.marks & Answer::GUN_ON);
            assert_eq!(guns.collect::<Vec<_>>(), [0, Answer::GUN_ON]);
            // The path follows the part, whichever pose is sent.
            let mouth = found.path[0].robot_from_nozzle.translation.vector;
            let taught = Point3::new(-0.1, 0.0, 1.0);
            let carried = finder.robot.robot_from_camera * (pose * taught);
            assert!((mouth - carried.coords).norm() < 1e-9);
        }
    }

    #[test]
    fn of_a_path_that_does_not_aim_at_the_part_no_point_is_given() {
        let library = shipped_library();
        let mut finder = finder(&library, PoseKind::default());
        let off = OffThePart {
            num_spraying: 12,
            num_aiming: 1,
            num_too_near: 0,
        };
        for part in &mut finder.parts {
            part.off = Some(off);
        }
        let scene = facing_part(PartKind::Fender, Side::Left, 5);
        let inspection = run(&scene, &library, &Recipe::default(), &Unwatched).expect("run");
        let found = found(&finder, &inspection, &simulated());
        assert!(found.pose.is_some() && found.path.is_empty());
        assert_eq!(found.no_path, Some(Problem::of("off_the_part", &off)));
    }

    #[test]
    fn what_is_not_accepted_has_a_reason_and_no_pose() {
        let recipe = Recipe::default();
        let library = shipped_library();
        let finder = finder(&library, PoseKind::default());
        let of = |inspection: &Inspection| {
            let found = found(&finder, inspection, &simulated());
            assert_eq!((found.pose, found.path.len()), (None, 0));
            assert!(found.problem.message.contains("to do"));
            (found.verdict, found.problem.reason)
        };
        let nothing = run(&SceneCloud::default(), &library, &recipe, &Unwatched).expect("run");
        assert_eq!(of(&nothing).0, VerdictCode::NoPart);
        let strict = Recipe {
            accept: inspection::pipeline::AcceptParams {
                min_score: 1.1,
                ..Default::default()
            },
            ..Recipe::default()
        };
        let scene = facing_part(PartKind::Fender, Side::Left, 5);
        let refused = run(&scene, &library, &strict, &Unwatched).expect("run");
        let (verdict, reason) = of(&refused);
        assert_eq!(verdict, VerdictCode::Refused);
        assert!(!reason.is_empty() && reason != "ambiguous_pose");
    }

    #[test]
    fn a_part_that_moves_is_refused_and_one_that_may_move_is_marked() {
        let library = shipped_library();
        let recipe = Recipe::default();
        let scene = facing_part(PartKind::Fender, Side::Left, 5);
        let mut inspection = run(&scene, &library, &recipe, &Unwatched).expect("run");
        let finder = finder(&library, PoseKind::default());
        let unknown = Subject {
            is_motion_unchecked: true,
            ..simulated()
        };
        let may_move = found(&finder, &inspection, &unknown);
        assert_eq!(may_move.verdict, VerdictCode::Accepted);
        assert_eq!(may_move.marks, Answer::SIMULATED | Answer::MOTION_UNCHECKED);
        refuse_moving(&mut inspection);
        let found = found(&finder, &inspection, &unknown);
        assert_eq!(found.verdict, VerdictCode::Refused);
        assert_eq!((found.pose, found.path.len()), (None, 0));
        assert_eq!(found.problem.reason, "moving");
        assert_eq!((&*found.part, found.marks), ("fender", Answer::SIMULATED));
    }

    #[test]
    fn a_simulated_part_marks_the_answer_only_if_it_is_named() {
        let library = shipped_library();
        let mut finder = finder(&library, PoseKind::default());
        for part in &mut finder.parts {
            part.is_simulated = true;
        }
        let seen = Subject {
            is_simulated: false,
            ..simulated()
        };
        let scene = facing_part(PartKind::Fender, Side::Left, 5);
        for (unknown_below, marks) in [(0.0, Answer::SIMULATED), (1.1, 0)] {
            let recipe = Recipe {
                accept: inspection::pipeline::AcceptParams {
                    min_score: 1.1,
                    min_likeness: 1.1,
                    unknown_below,
                    ..Default::default()
                },
                ..Recipe::default()
            };
            let inspection = run(&scene, &library, &recipe, &Unwatched).expect("run");
            assert_eq!(inspection.verdict.is_unknown(), marks == 0);
            assert_eq!(found(&finder, &inspection, &seen).marks, marks);
        }
    }

    #[test]
    fn an_accepted_part_about_which_there_are_doubts_is_refused_by_the_first() {
        let library = shipped_library();
        let recipe = Recipe::default();
        let scene = facing_part(PartKind::Fender, Side::Left, 5);
        let mut inspection = run(&scene, &library, &recipe, &Unwatched).expect("run");
        assert!(inspection.verdict.is_accepted());
        let finder = finder(&library, PoseKind::default());
        let is_refused_as = |reason: &str, inspection: &Inspection, subject: &Subject| {
            let found = found(&finder, inspection, subject);
            assert_eq!(found.verdict, VerdictCode::Refused);
            assert_eq!(found.problem.reason, reason);
            assert_eq!((found.pose, found.path.len()), (None, 0));
        };
        let old = Subject {
            currency: Some(Doubt::Old),
            ..simulated()
        };
        is_refused_as("old", &inspection, &old);
        let mut is_changed_to = |reason: &str, change: fn(&mut PoseEstimate)| {
            let Some(Ok(pose)) = &mut inspection.pose else {
                panic!("a pose");
            };
            change(pose);
            is_refused_as(reason, &inspection, &simulated());
        };
        is_changed_to("off_scale", |pose| {
            pose.scale = Some(ScaleEstimate {
                scale: 1.05,
                deviation: 0.005,
            });
        });
        is_changed_to("ambiguous_pose", |pose| {
            pose.runner_up = Some(RunnerUp {
                target_from_source: pose.target_from_source,
                ratio: 1.01,
            });
        });
        inspection.pose = None;
        is_refused_as("no_pose", &inspection, &simulated());
    }
}
