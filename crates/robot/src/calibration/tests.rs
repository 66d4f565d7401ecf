use std::{fs, path::Path};

use super::*;
use crate::hand_eye::{PosePair, Target, solve};
use geometry::rigid::from_euler_zyx;

fn at() -> Timestamp {
    "2026-03-04T05:06:07Z".parse().expect("a moment")
}

fn fixed() -> CellCalibration {
    CellCalibration {
        name: "Cell 2 \"north\"".into(),
        notes: "after the crash\nof Monday".into(),
        camera: CameraPlace::Fixed {
            robot_from_camera: from_euler_zyx([2.1, -0.1, 1.5, 1.2, -0.4, 1.9]),
        },
        origin: Origin::ByHand,
        made_at: at(),
    }
}

fn on_flange(capture_pose: Option<RigidTransform>) -> CellCalibration {
    CellCalibration {
        camera: CameraPlace::OnFlange {
            flange_from_camera: from_euler_zyx([0.01, 0.02, 1.5, 0.05, 0.0, 0.09]),
            capture_pose,
        },
        ..fixed()
    }
}

fn saved(calibration: &CellCalibration) -> ReadCalibration {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("deep").join("cell.toml");
    calibration.save(&path).expect("written");
    CellCalibration::read(&path).expect("read")
}

fn load_text(text: &str) -> Result<ReadCalibration, CalibrationError> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("cell.toml");
    std::fs::write(&path, text).expect("written");
    CellCalibration::read(&path)
}

fn is_near(a: &RigidTransform, b: &RigidTransform) -> bool {
    (a.to_homogeneous() - b.to_homogeneous()).amax() < 1e-8
}

#[test]
fn what_is_written_is_read_again() {
    let pose = from_euler_zyx([0.4, 0.5, 0.6, 0.7, 0.8, 0.9]);
    for written in [fixed(), on_flange(None), on_flange(Some(pose))] {
        let ReadCalibration {
            calibration: read,
            is_edited,
        } = saved(&written);
        assert!(!is_edited);
        assert_eq!((&read.name, &read.notes), (&written.name, &written.notes));
        assert_eq!((&read.origin, read.made_at), (&written.origin, at()));
        assert_eq!(read.identity(), written.identity());
        assert!(is_near(
            read.camera.mount_from_camera(),
            written.camera.mount_from_camera()
        ));
        assert!(!saved(&read).is_edited);
    }
}

#[test]
fn a_camera_on_the_flange_needs_the_arms_pose() {
    let pose = from_euler_zyx([0.4, 0.5, 0.6, 0.7, 0.8, 0.9]);
    let other = from_euler_zyx([0.0, 0.5, 0.0, 1.0, 0.0, 0.9]);
    let x = *on_flange(None).camera.mount_from_camera();
    assert_eq!(on_flange(None).robot_from_camera(None), Err(NoRobotPose));
    assert_eq!(on_flange(Some(pose)).robot_from_camera(None), Ok(pose * x));
    // The pose given for this capture takes precedence.
    assert_eq!(
        on_flange(Some(pose)).robot_from_camera(Some(&other)),
        Ok(other * x)
    );
    let in_cell = fixed();
    assert_eq!(
        in_cell.robot_from_camera(None),
        Ok(*in_cell.camera.mount_from_camera())
    );
}

#[test]
fn the_identity_is_that_of_the_numbers() {
    let renamed = CellCalibration {
        name: "other".into(),
        ..fixed()
    };
    assert_eq!(renamed.identity(), fixed().identity());
    let mut moved = fixed();
    if let CameraPlace::Fixed { robot_from_camera } = &mut moved.camera {
        robot_from_camera.translation.vector.x += 1e-6;
    }
    assert_ne!(moved.identity(), fixed().identity());
    assert_ne!(
        on_flange(None).identity(),
        on_flange(Some(RigidTransform::identity())).identity()
    );
}

#[test]
fn a_hand_eye_calibration_keeps_its_figures_until_its_numbers_are_edited() {
    let x = from_euler_zyx([2.1, -0.1, 1.5, 1.2, -0.4, 1.9]);
    let pairs: Vec<PosePair> = [
        [0.0, 0.0, 0.0, 0.0, 0.0, 1.2],
        [0.6, 0.1, 0.0, 0.2, 0.0, 1.1],
        [0.0, -0.6, 0.3, 0.0, 0.2, 1.3],
        [-0.5, 0.3, 0.6, -0.2, 0.0, 1.2],
    ]
    .into_iter()
    .map(|numbers| PosePair {
        name: format!("{numbers:?}"),
        robot_from_flange: x * from_euler_zyx(numbers),
        camera_from_target: from_euler_zyx(numbers),
    })
    .collect();
    let solved = solve(&pairs, Mount::EyeToHand, Target::Marker).expect("solved");
    let written = CellCalibration {
        camera: CameraPlace::on(Mount::EyeToHand, solved.mount_from_camera),
        origin: Origin::HandEye(CalibrationFit::of(
            &solved,
            "pairs.csv".into(),
            vec!["line 7".into()],
        )),
        ..fixed()
    };
    let ReadCalibration {
        calibration,
        is_edited,
    } = saved(&written);
    assert!(!is_edited);
    assert_eq!(calibration.origin, written.origin);
    assert!(
        calibration
            .origin
            .describe()
            .contains("4 pairs from pairs.csv")
    );

    let x_shift = written.camera.mount_from_camera().translation.vector.x;
    let (from, to) = (format!("{x_shift:.12}"), format!("{:.12}", x_shift + 0.01));
    let text = written.to_text();
    assert!(text.contains(&from), "{text}");
    let edited = load_text(&text.replace(&from, &to)).expect("read");
    assert!(edited.is_edited);
    assert_eq!(edited.calibration.origin, Origin::ByHand);
}

#[test]
fn edited_numbers_are_refused_until_they_are_confirmed() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("cell.toml");
    let text = on_flange(Some(RigidTransform::identity())).to_text();
    let digit = text.replacen("0.050000000000", "0.150000000000", 1);
    let line = text.lines().find(|line| line.starts_with("checksum"));
    let without = text.replace(line.expect("a checksum"), "");
    for (content, is_edited) in [(&text, false), (&digit, true), (&without, false)] {
        std::fs::write(&path, content).expect("written");
        let loaded = CellCalibration::load(&path);
        assert_eq!(loaded.is_err(), is_edited, "{content}");
        let Err(error) = loaded else {
            assert_eq!(CellCalibration::confirm(&path).expect("read"), None);
            continue;
        };
        assert!(error.to_string().contains("were changed"), "{error}");
        assert!(error.advice().contains("calibrate confirm"), "{error}");
        assert!(CellCalibration::load_if_there(&path).is_err());
        let former = CellCalibration::confirm(&path).expect("confirmed");
        let former = former.expect("the former file is kept");
        assert_eq!(std::fs::read_to_string(former).expect("read"), *content);
        let confirmed = CellCalibration::load(&path).expect("confirmed");
        let read = load_text(content).expect("read").calibration;
        assert_eq!(confirmed.origin, Origin::ByHand);
        let [a, b] = [&confirmed, &read].map(|c| c.camera.mount_from_camera());
        assert!(is_near(a, b), "{a} {b}");
    }
}

#[test]
fn numbers_with_four_digits_are_taken_and_others_refused() {
    let rows = |rows: &str| {
        format!(
            "schema_version = 1\nmount = \"eye_to_hand\"\nmade_at = \"2026-03-04T05:06:07Z\"\nrobot_from_camera = [{rows}]\n[origin]\nkind = \"by_hand\"\n"
        )
    };
    let rounded = load_text(&rows(
        "[0.7071, -0.7071, 0, 1], [0.7071, 0.7071, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]",
    ));
    let loaded = rounded.expect("four digits are enough");
    let turn = loaded.calibration.camera.mount_from_camera().rotation;
    assert!((turn.angle() - std::f64::consts::FRAC_PI_4).abs() < 1e-9);
    for text in [
        "[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]",
        "[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]",
        "[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [5, 6, 7, 1]",
        "[1, 0, 0, nan], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]",
    ] {
        let error = load_text(&rows(text)).expect_err(text);
        assert!(
            matches!(error, CalibrationError::NotRigid { .. }),
            "{error}"
        );
        assert!(error.to_string().contains("robot_from_camera"), "{error}");
    }
}

#[test]
fn a_shift_in_millimetres_is_refused_in_every_matrix() {
    let at = |x: &str| format!("[[1, 0, 0, {x}], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]");
    let load = |mount: &str, matrices: &[(&str, &str)]| {
        let matrices = matrices
            .iter()
            .map(|(key, x)| format!("{key} = {}\n", at(x)));
        load_text(&format!(
            "schema_version = 1\nmount = \"{mount}\"\nmade_at = \"2026-03-04T05:06:07Z\"\n{}[origin]\nkind = \"by_hand\"\n",
            matrices.collect::<String>()
        ))
    };
    load("eye_to_hand", &[("robot_from_camera", "100")]).expect("a large cell");
    for (mount, matrices, key) in [
        (
            "eye_to_hand",
            &[("robot_from_camera", "1200")][..],
            "robot_from_camera",
        ),
        (
            "eye_in_hand",
            &[("flange_from_camera", "-1200")],
            "flange_from_camera",
        ),
        (
            "eye_in_hand",
            &[("flange_from_camera", "0.1"), ("robot_from_flange", "1200")],
            "robot_from_flange",
        ),
    ] {
        let error = load(mount, matrices).expect_err(key);
        let wanted = format!("cell.toml: {key} shifts by 1200 m, expected at most 100 m");
        assert!(error.to_string().ends_with(&wanted), "{error}");
        assert!(error.advice().contains("in metres"), "{}", error.advice());
    }
}

#[test]
fn what_is_no_calibration_is_refused_in_words() {
    let sound = fixed().to_text();
    for (text, expected) in [
        (
            sound.replace("schema_version = 1", "schema_version = 9"),
            "newer version",
        ),
        (sound.replace("eye_to_hand", "eye_on_foot"), "eye_on_foot"),
        (
            sound.replace("eye_to_hand", "eye_in_hand"),
            "flange_from_camera is missing",
        ),
        (sound.replace("schema_version = 1", ""), "schema_version"),
        ("[[[".into(), "line 1"),
        ("a\u{0}b".into(), "not a calibration"),
    ] {
        let error = load_text(&text).expect_err(expected);
        assert!(error.to_string().contains(expected), "{error}");
        assert!(!error.advice().is_empty());
    }
    let missing = CellCalibration::load(Path::new("no/such/cell.toml")).expect_err("missing");
    assert!(
        missing.advice().contains("partsight calibrate"),
        "{}",
        missing.advice()
    );
}

#[test]
fn numbers_that_would_not_come_back_are_not_written_and_the_former_file_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("cell.toml");
    let sound = fixed();
    sound.save(&path).expect("written");
    let before = fs::read_to_string(&path).expect("there");
    for wrong in [1e300, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut calibration = sound.clone();
        let CameraPlace::Fixed { robot_from_camera } = &mut calibration.camera else {
            panic!("fixed");
        };
        robot_from_camera.translation.vector.x = wrong;
        let error = calibration
            .save_keeping_former(&path)
            .expect_err("no number of a cell");
        assert!(!error.advice().is_empty(), "{error}");
        assert!(calibration.save(&path).is_err());
    }
    assert_eq!(fs::read_to_string(&path).expect("there"), before);
    assert_eq!(fs::read_dir(folder.path()).expect("listed").count(), 1);
}

#[test]
fn lengths_in_the_wrong_unit_are_questioned() {
    let at = |metres: f64| RigidTransform::translation(0.0, 0.6 * metres, 0.8 * metres);
    let doubt = |place: CameraPlace| match place.unit_doubt() {
        None => "none",
        Some(UnitDoubt::TooFar { .. }) => "far",
        Some(UnitDoubt::TooNear { .. }) => "near",
    };
    for (metres, in_cell, on_flange) in [
        (0.0, "none", "none"),
        (0.000_05, "near", "near"),
        (0.002_5, "near", "none"),
        (0.05, "none", "none"),
        (2.5, "none", "none"),
        (50.0, "far", "far"),
        (2500.0, "far", "far"),
    ] {
        assert_eq!(
            doubt(CameraPlace::on(Mount::EyeToHand, at(metres))),
            in_cell,
            "{metres}"
        );
        assert_eq!(
            doubt(CameraPlace::on(Mount::EyeInHand, at(metres))),
            on_flange,
            "{metres}"
        );
    }
    let arm = CameraPlace::OnFlange {
        flange_from_camera: at(0.1),
        capture_pose: Some(at(0.001)),
    };
    assert_eq!(doubt(arm), "near");
}

#[cfg(unix)]
#[test]
fn whichever_call_fails_a_calibration_is_the_old_one_or_the_new() {
    use files::disk::faults::{Writer, with_advice};

    let called = |name: &str| CellCalibration {
        name: name.into(),
        ..fixed()
    };
    let place = |folder: &Path| folder.join("deep").join("cell.toml");
    Writer {
        test: "calibration::tests::whichever_call_fails_a_calibration_is_the_old_one_or_the_new",
        prepare: &|folder| called("old").save(&place(folder)).expect("written"),
        write: &|folder| {
            let saved = called("new").save_keeping_former(&place(folder));
            saved.map(|_| ()).map_err(|error| with_advice(&error))
        },
        state: &|folder| {
            let loaded = CellCalibration::load(&place(folder)).expect("read");
            loaded.name
        },
        between: &[],
    }
    .fails_at_every_call();
}
