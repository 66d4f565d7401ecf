use std::sync::OnceLock;

use super::*;
use crate::{
    fixtures::conforms,
    report::{Picture, stage_pictures},
};
use geometry::rigid::{RigidTransform, from_euler_zyx};
use inspection::{
    fixtures::shipped_library,
    library::Library,
    pipeline::{Unwatched, Verdict, run},
};
use simulate::{CellSetup, PartKind, Side, SimulatedObject};
use stages::{fixtures::scene_of, scene::SceneCloud, stand_off::stand_off};

/// An inspected scene with all inputs of a report.
pub(super) struct Inspected {
    library: Library,
    scene: SceneCloud,
    pub(super) inspection: Inspection,
    recipe: NamedRecipe,
    stand_off: Option<Result<StandOff, StandOffError>>,
}

impl Inspected {
    fn of(setup: &CellSetup) -> Self {
        let library = shipped_library();
        let scene = scene_of(setup);
        let recipe = Recipe::default();
        let inspection = run(&scene, &library, &recipe, &Unwatched).expect("run");
        let best = inspection.best_reference(&library);
        let pose = inspection.found_pose();
        let stand_off = best.zip(pose).map(|(reference, pose)| {
            stand_off(reference, &pose.camera_from_part(), &recipe.stand_off)
        });
        Self {
            library,
            scene,
            inspection,
            recipe: recipe.into(),
            stand_off,
        }
    }

    pub(super) fn pictures(&self) -> Vec<Picture> {
        stage_pictures(&self.scene, &self.inspection)
    }

    pub(super) fn report(&self, robot: Option<&RobotFrame>, convention: Convention) -> PoseReport {
        self.report_of(&self.inspection, robot, convention)
    }

    fn report_of(
        &self,
        inspection: &Inspection,
        robot: Option<&RobotFrame>,
        convention: Convention,
    ) -> PoseReport {
        let doubts = robot.map_or(vec![not_calibrated()], |_| Vec::new());
        self.doubted(inspection, [robot, robot], &doubts, convention)
    }

    /// The report about which there are doubts; the second frame is that in which the pose may be given.
    pub(super) fn doubted(
        &self,
        inspection: &Inspection,
        [robot, for_robot]: [Option<&RobotFrame>; 2],
        doubts: &[DoubtBlock],
        convention: Convention,
    ) -> PoseReport {
        PoseReport::of(&ReportSubject {
            inspected_at: "2026-03-04T05:06:07.25Z".parse().expect("a time"),
            scene: "shift 2/door, left.pcd",
            source: None,
            seen_by: SeenBy::Simulation,
            trace: &Traceability::default(),
            inspection,
            middle: self.inspection.middle(&self.library),
            stand_off: self.stand_off.as_ref(),
            recipe: &self.recipe,
            library_identity: "01234567",
            num_references: self.library.references.len(),
            robot,
            for_robot,
            doubts,
            convention,
        })
    }
}

/// The doubt about an old capture.
pub(super) fn old() -> DoubtBlock {
    DoubtBlock {
        kind: "old",
        what: "the capture is more than 10 minutes old".into(),
        advice: "Capture the part again".into(),
    }
}

/// The doubt without a calibration.
pub(super) fn not_calibrated() -> DoubtBlock {
    DoubtBlock {
        kind: "not_calibrated",
        what: "the cell is not calibrated".into(),
        advice: "Calibrate the cell".into(),
    }
}

/// A left front door, which is accepted.
pub(super) fn door() -> &'static Inspected {
    static DOOR: OnceLock<Inspected> = OnceLock::new();
    DOOR.get_or_init(|| Inspected::of(&CellSetup::with_part(PartKind::FrontDoor, Side::Left, 0, 5)))
}

/// A right fender, which is not enrolled.
pub(super) fn refused() -> &'static Inspected {
    static FENDER: OnceLock<Inspected> = OnceLock::new();
    FENDER.get_or_init(|| Inspected::of(&CellSetup::with_part(PartKind::Fender, Side::Right, 0, 5)))
}

/// An empty cell.
pub(super) fn empty() -> &'static Inspected {
    static EMPTY: OnceLock<Inspected> = OnceLock::new();
    EMPTY.get_or_init(|| Inspected::of(&CellSetup::new(SimulatedObject::Nothing, 5)))
}

pub(super) fn robot() -> RobotFrame {
    RobotFrame {
        robot_from_camera: from_euler_zyx([-2.2, 0.1, -1.6, 1.5, -0.2, 2.0]),
        name: "cell 1, March".into(),
    }
}

/// The report of an accepted part that was reported as wrong.
pub(super) fn reported() -> PoseReport {
    let report = door().report(Some(&robot()), Convention::Kuka);
    report.reported_as(Some("back_door"))
}

#[test]
fn a_part_that_was_reported_as_wrong_says_what_it_is() {
    let json = json(&reported());
    assert_eq!(json["verdict"]["accepted"], true);
    assert_eq!(json["verdict"]["reported_as"], "back_door");
    let schema: serde_json::Value = serde_json::from_str(&PoseReport::json_schema()).expect("JSON");
    assert_eq!(conforms(&json, &schema, &schema), Ok(()));
    let other = door().report(Some(&robot()), Convention::Kuka);
    let json = self::json(&other);
    assert_eq!(json["verdict"]["reported_as"], serde_json::Value::Null);
}

fn json(report: &PoseReport) -> serde_json::Value {
    serde_json::from_str(&report.to_json()).expect("JSON")
}

fn transform(block: &serde_json::Value) -> RigidTransform {
    let numbers: Vec<f64> =
        serde_json::from_value(block["matrix"]["values"].clone()).expect("16 numbers");
    Convention::Matrix.read(&numbers).expect("a pose")
}

#[test]
fn an_accepted_part_has_its_pose_in_every_frame_and_each_says_what_it_is() {
    let robot = robot();
    let json = json(&door().report(Some(&robot), Convention::Kuka));
    assert_eq!(json["schema"], 1);
    assert_eq!(json["inspected_at"], "2026-03-04T05:06:07.25Z");
    assert_eq!(json["seen_by"], "simulation");
    assert_eq!(json["verdict"]["part"], "front_door");
    assert_eq!(json["verdict"]["accepted"], true);
    assert_eq!(json["refused_pose"], serde_json::Value::Null);

    let camera_from_part = transform(&json["pose"]["camera_from_part"]);
    let part_from_camera = transform(&json["pose"]["part_from_camera"]);
    let both = (camera_from_part * part_from_camera).to_homogeneous();
    assert!((both - nalgebra::Matrix4::identity()).norm() < 1e-12);
    let robot_from_part = transform(&json["robot"]["robot_from_part"]);
    let expected = robot.robot_from_camera * camera_from_part;
    assert!((robot_from_part.to_homogeneous() - expected.to_homogeneous()).norm() < 1e-12);
    let offset = transform(&json["robot"]["robot_offset"]);
    let expected = robot.robot_from_camera * camera_from_part * robot.robot_from_camera.inverse();
    assert!((offset.to_homogeneous() - expected.to_homogeneous()).norm() < 1e-12);

    // The numbers for the controller have names, units and a meaning.
    let kuka = &json["robot"]["robot_from_part"]["in_convention"];
    let values = kuka["values"].as_array().expect("values");
    let numbers: Vec<f64> = values
        .iter()
        .map(|value| value["value"].as_f64().expect("a number"))
        .collect();
    let read = Convention::Kuka.read(&numbers).expect("a pose");
    assert!((read.to_homogeneous() - robot_from_part.to_homogeneous()).norm() < 1e-9);
    let named: Vec<_> = values
        .iter()
        .map(|value| (&value["name"], &value["unit"]))
        .map(|(a, b)| format!("{a}{b}"))
        .collect();
    assert_eq!(
        named.join(" "),
        r#""X""mm" "Y""mm" "Z""mm" "A""deg" "B""deg" "C""deg""#
    );
    assert!(
        kuka["meaning"]
            .as_str()
            .expect("words")
            .contains("R = Rz(A)·Ry(B)·Rx(C)")
    );
    for block in ["robot_from_part", "robot_offset"] {
        let block = &json["robot"][block];
        for field in ["name", "meaning", "from_frame", "to_frame"] {
            assert!(
                block[field].as_str().is_some_and(|text| text.len() > 3),
                "{block}"
            );
        }
        assert!(
            block["to_frame"]
                .as_str()
                .expect("words")
                .starts_with("robot")
        );
    }
    assert!(
        json["stand_off"]["mean_m"]
            .as_f64()
            .is_some_and(f64::is_finite)
    );
}

#[test]
fn what_is_refused_leaves_no_number_for_a_robot() {
    let json = json(&refused().report(Some(&robot()), Convention::Fanuc));
    assert_eq!(json["verdict"]["accepted"], false);
    assert!(
        json["verdict"]["reason"]
            .as_str()
            .is_some_and(|reason| reason.contains("mirror image"))
    );
    assert!(json["verdict"]["advice"].is_string());
    for null in ["pose", "stand_off"] {
        assert!(json[null].is_null(), "{null}");
    }
    for null in ["robot_from_part", "robot_offset"] {
        assert!(json["robot"][null].is_null(), "{null}");
    }
    assert!(
        json["robot"]["unavailable"]
            .as_str()
            .is_some_and(|why| why.contains("not accepted"))
    );
    assert_eq!(json["refused_pose"]["usable"], false);
    assert_eq!(
        json["refused_pose"]["cautions"][0],
        "not accepted: do not move on this pose"
    );
}

#[test]
fn with_a_doubt_the_report_has_no_pose_for_a_robot_unless_it_is_forced() {
    let frame = robot();
    let inspection = &door().inspection;
    let report = |frames| {
        let report = door().doubted(inspection, frames, &[old()], Convention::Abb);
        json(&report)
    };
    let sound = json(&door().report(Some(&frame), Convention::Abb));
    assert!(sound["robot"]["robot_from_part"].is_object());
    assert_eq!(sound["pose"]["usable"], true);
    assert_eq!(sound["robot"]["doubts"], serde_json::json!([]));
    let withheld = report([Some(&frame), None]);
    assert_eq!(withheld["robot"]["unavailable"], old().what);
    for null in ["robot_from_part", "robot_offset"] {
        assert!(withheld["robot"][null].is_null(), "{null}");
    }
    assert!(withheld["pose"]["camera_from_part"].is_object());
    let forced = report([Some(&frame), Some(&frame)]);
    assert!(forced["robot"]["unavailable"].is_null());
    assert_eq!(
        forced["robot"]["robot_from_part"],
        sound["robot"]["robot_from_part"]
    );
    for doubted in [&withheld, &forced] {
        assert_eq!(doubted["robot"]["doubts"][0]["kind"], "old");
        assert_eq!(doubted["robot"]["doubts"][0]["advice"], old().advice);
        assert_eq!(doubted["pose"]["usable"], false);
    }
}

#[test]
fn without_a_calibration_or_a_part_the_report_says_so() {
    let uncalibrated = json(&door().report(None, Convention::Abb));
    assert!(uncalibrated["pose"].is_object());
    assert!(
        uncalibrated["robot"]["calibration"].is_null()
            && uncalibrated["robot"]["robot_from_part"].is_null()
    );
    assert_eq!(uncalibrated["pose"]["usable"], false);
    let doubts = [old(), not_calibrated()];
    let inspection = &door().inspection;
    let old = json(&door().doubted(inspection, [None; 2], &doubts, Convention::Abb));
    for (report, why) in [
        (&uncalibrated, not_calibrated().what),
        (&old, doubts.map(|doubt| doubt.what).join("; ")),
    ] {
        assert_eq!(report["robot"]["unavailable"], why);
    }
    let empty = json(&empty().report(Some(&robot()), Convention::Abb));
    assert_eq!(empty["verdict"]["status"], "no_part");
    assert!(
        empty["pose"].is_null()
            && empty["refused_pose"].is_null()
            && empty["verdict"]["part"].is_null()
    );
    assert!(empty["robot"]["unavailable"].is_string());
}

#[test]
fn the_published_schema_is_that_of_the_types() {
    let path = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
        .join("assets/pose-report.schema.json");
    let made = PoseReport::json_schema();
    if std::env::var_os("UPDATE_SNAPSHOTS").is_some() {
        std::fs::write(&path, &made).expect("written");
    }
    let published = std::fs::read_to_string(&path).expect("the schema");
    assert!(
        published == made,
        "assets/pose-report.schema.json is not what the types give: UPDATE_SNAPSHOTS=1 rewrites it"
    );
}

#[test]
fn reports_conform_to_the_schema() {
    let schema: serde_json::Value = serde_json::from_str(&PoseReport::json_schema()).expect("JSON");
    let robot = robot();
    for inspected in [door(), refused(), empty()] {
        for robot in [None, Some(&robot)] {
            for convention in Convention::ALL {
                let report = json(&inspected.report(robot, convention));
                assert_eq!(conforms(&report, &schema, &schema), Ok(()));
            }
        }
    }
    // The check must be able to fail.
    let mut broken = json(&door().report(None, Convention::Matrix));
    broken["verdict"]["accepted"] = "yes".into();
    assert!(conforms(&broken, &schema, &schema).is_err());
    let mut broken = json(&door().report(None, Convention::Matrix));
    broken.as_object_mut().expect("fields").remove("robot");
    assert!(conforms(&broken, &schema, &schema).is_err());
}

#[test]
fn an_unknown_part_has_no_cautions_about_using_its_pose() {
    let mut inspection = refused().inspection.clone();
    inspection.verdict = match inspection.verdict {
        Verdict::Part {
            part,
            score,
            margin,
            rejected,
            ..
        } => Verdict::Part {
            part,
            score,
            margin,
            rejected,
            is_approximate: true,
        },
        none @ Verdict::NoPart(_) => none,
    };
    assert!(inspection.verdict.is_unknown());
    let report = refused().report_of(&inspection, None, Convention::Kuka);
    let pose = report.refused_pose.expect("a pose");
    assert_eq!(
        pose.cautions,
        [
            "not accepted: do not move on this pose",
            "simulated: no camera was read"
        ]
    );
}
