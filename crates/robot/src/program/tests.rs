mod configurations;
mod film;
mod motion;
mod rail;
pub(super) mod read;
mod tracking;

use std::{path::Path, sync::LazyLock};

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};
use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::{
    language::{DRL, JBI, KRL, LS, RAPID, URSCRIPT},
    save::beside,
    *,
};
use crate::arm::{Arm, GUN_RADIUS_M, Joints, Obstacles, PointCheck, Way};
use geometry::{error::Advice as _, rigid::from_euler_zyx};

fn any_rotation(random: &mut Pcg64) -> UnitQuaternion<f64> {
    // One in five is in gimbal lock, or a half turn.
    let lock = random.random_range(0..10);
    let mut angle = || random.random_range(-3.1..3.1);
    match lock {
        0 => UnitQuaternion::from_euler_angles(angle(), std::f64::consts::FRAC_PI_2, angle()),
        1 => UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI),
        _ => UnitQuaternion::from_euler_angles(angle(), angle(), angle()),
    }
}

fn any_path(seed: u64) -> Vec<ProgramPoint> {
    let mut random = Pcg64::seed_from_u64(seed);
    let num = random.random_range(1..60);
    let mut at = Vector3::new(1.2, -0.4, 0.8);
    let mut is_gun_on = false;
    let points = (0..num).map(|i| {
        at += Vector3::from_fn(|_, _| random.random_range(-0.08..0.08));
        is_gun_on ^= random.random_range(0..4) == 0;
        if i % 9 == 8 {
            // Two points may coincide, as where the gun is opened.
            at = at.map(|x| (x * 100.0_f64).round() / 100.0);
        }
        ProgramPoint {
            robot_from_nozzle: Isometry3::from_parts(
                Translation3::from(at),
                any_rotation(&mut random),
            ),
            is_gun_on,
            speed: (random.random_range(0..3) > 0).then(|| random.random_range(0.02..0.9)),
        }
    });
    points.collect()
}

static CALIBRATION: LazyLock<FrameName> = LazyLock::new(|| "Cell 2 (00112233)".into());

fn program<'a>(points: &'a [ProgramPoint], settings: &'a ProgramSettings) -> Program<'a> {
    Program {
        points,
        settings,
        acceleration: None,
        film: None,
        reach: None,
        part: "Tür_links",
        scene: Some("door; \"x\".pcd"),
        robot_from_part: from_euler_zyx([0.1, -0.2, 0.3, 1.5, -0.2, 2.0]),
        calibration: &CALIBRATION,
        is_simulated: true,
        doubts: &[],
        unchecked: &[],
        at: Timestamp::UNIX_EPOCH,
    }
}

/// The text of a program that fits into one.
fn text_of(program: &Program<'_>, language: &'static RobotLanguage) -> String {
    let texts = program.texts(language, "paint").expect("text");
    assert!(texts.parts.is_empty());
    texts.main
}

#[test]
fn every_format_reads_back_to_the_path() {
    for seed in 0..40 {
        let points = any_path(seed);
        let mut settings = ProgramSettings::default();
        settings.params.gun_output = 3;
        let before = Translation3::new(0.0, 0.0, -settings.params.approach.0);
        let speed_of = |i: usize| points[i].speed.unwrap_or(settings.params.speed);
        let last = points.len() - 1;
        for language in RobotLanguage::ALL {
            let text = text_of(&program(&points, &settings), language);
            assert!(text.is_ascii());
            let read = (language.reader.read)(&text);
            assert_eq!(read.output, "3");
            assert!(!read.is_gun_on, "the gun is closed at the end");
            // The approach, every point, and the move away.
            let mut expected = vec![(points[0].robot_from_nozzle * before, None, false)];
            for (i, point) in points.iter().enumerate() {
                let came_from = i.saturating_sub(1);
                let is_on = i > 0 && points[came_from].is_gun_on;
                expected.push((point.robot_from_nozzle, Some(speed_of(came_from)), is_on));
            }
            let back = points[last].robot_from_nozzle * before;
            expected.push((back, Some(speed_of(last)), false));
            assert_eq!(read.moves.len(), expected.len(), "{language:?} {seed}");
            for (found, (to, speed, is_on)) in read.moves.iter().zip(&expected) {
                let off = (found.to.translation.vector - to.translation.vector).norm();
                assert!(off <= 1e-6, "{language:?} {seed}: {off}");
                let turned = found.to.rotation.angle_to(&to.rotation);
                assert!(turned < 5e-6, "{language:?} {seed}: {turned}");
                assert_eq!(found.speed.is_some(), speed.is_some());
                if let (Some(found), Some(speed)) = (found.speed, speed) {
                    assert!((found - speed).abs() <= language.reader.speed_step * 1.001);
                }
                assert_eq!(found.is_gun_on, *is_on, "{language:?} {seed}");
            }
            // Where it is not known when a blended move switches an output, the robot stops before.
            for pair in read.moves.windows(2) {
                let changes = pair[0].is_gun_on != pair[1].is_gun_on;
                assert!(!(changes && language.reader.stops) || pair[0].is_exact);
                assert!(pair[0].switches_before <= 0.005, "{language:?} {seed}");
            }
            assert!(read.moves[0].is_exact && read.moves[read.moves.len() - 1].is_exact);
        }
    }
}

fn row() -> Vec<ProgramPoint> {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 3.0);
    (0..5)
        .map(|i| ProgramPoint {
            robot_from_nozzle: Isometry3::from_parts(
                Translation3::new(1.0, 0.1 * f64::from(i), 0.7),
                turn,
            ),
            is_gun_on: (1..3).contains(&i),
            speed: None,
        })
        .collect()
}

#[test]
fn a_header_says_part_pose_time_and_that_nothing_was_seen() {
    let points = row();
    let settings = ProgramSettings::default();
    let doubts = ["the part was not accepted".to_owned()];
    let unchecked = ["reach and collisions".to_owned()];
    for language in RobotLanguage::ALL {
        let program = Program {
            doubts: &doubts,
            unchecked: &unchecked,
            ..program(&points, &settings)
        };
        let text = text_of(&program, language);
        let read = (language.reader.read)(&text);
        let words = read.comments.join(" ");
        for wanted in [
            MARK,
            "T_r_links",
            "SIMULATED",
            "FORCED: the part was not",
            "1970-01-01T00:00:00Z",
            "Cell 2 (00112233)",
            "robot_from_part:",
            "5 points, gun: output 1",
            "reach and collisions: not checked",
        ] {
            let wanted = wanted.to_owned();
            assert!(words.contains(&wanted), "{language:?} {wanted}: {words}");
        }
        assert_eq!(read.name, language.reader.program_name);
        assert_eq!(read.tool, language.reader.tool);
    }
}

#[test]
fn corners_are_blended_also_where_the_gun_changes_except_by_doosan() {
    let settings = ProgramSettings::default();
    let points = row();
    for language in RobotLanguage::ALL {
        let text = text_of(&program(&points, &settings), language);
        let exact: Vec<bool> = ((language.reader.read)(&text).moves.iter())
            .map(|found| found.is_exact)
            .collect();
        // Approach, five points, away; the gun opens at the second point and closes at the fourth.
        let stops = language.reader.stops;
        let expected = [true, true, stops, false, stops, true, true];
        assert_eq!(exact, expected, "{language:?}");
        let mut none = settings.clone();
        none.params.blend = Metres(0.0);
        let text = text_of(&program(&points, &none), language);
        assert!(
            (language.reader.read)(&text)
                .moves
                .iter()
                .all(|found| found.is_exact)
        );
    }
}

#[test]
fn a_given_tool_is_set_where_the_controller_can() {
    let points = row();
    let settings = ProgramSettings {
        flange_from_nozzle: Some(from_euler_zyx([0.0, 0.0, 0.0, 0.0, 0.01, 0.25])),
        ..ProgramSettings::default()
    };
    let text = |language| text_of(&program(&points, &settings), language);
    for (language, wanted) in [
        (&KRL, "$TOOL={X 0.000,Y 10.000,Z 250.000,A 0.0000,"),
        (
            &RAPID,
            "tooldata tPartsight:=[TRUE,[[0.000,10.000,250.000],[1.00000000,",
        ),
        (&URSCRIPT, "set_tcp(p[0.000000, 0.010000, 0.250000, "),
        (&LS, "flange_from_nozzle:"),
        (&JBI, "flange_from_nozzle:"),
        (&DRL, "flange_from_nozzle:"),
    ] {
        assert!(
            text(language).contains(wanted),
            "{language:?}: {}",
            text(language)
        );
    }
}

#[test]
fn a_tool_that_the_program_would_not_use_is_refused() {
    let points = row();
    let settings = ProgramSettings {
        tool: Some("gun".into()),
        ..ProgramSettings::default()
    };
    let with_nozzle = ProgramSettings {
        flange_from_nozzle: Some(from_euler_zyx([0.0, 0.0, 0.0, 0.0, 0.01, 0.25])),
        ..settings.clone()
    };
    for (language, settings, is_refused) in [
        (&URSCRIPT, &settings, true),
        (&URSCRIPT, &with_nozzle, true),
        (&RAPID, &settings, false),
        (&RAPID, &with_nozzle, true),
        (&DRL, &with_nozzle, false),
    ] {
        match program(&points, settings).texts(language, "paint") {
            Ok(texts) => {
                assert!(!is_refused, "{language:?}");
                assert_eq!((language.reader.read)(&texts.main).tool, "gun");
            }
            Err(error) => {
                assert!(is_refused, "{language:?} {error}");
                assert!(
                    error.to_string().contains("does not use the tool \"gun\""),
                    "{error}"
                );
                assert!(error.advice().contains("--tool"), "{}", error.advice());
            }
        }
    }
    let numbered = ProgramSettings {
        tool: Some("3".into()),
        ..with_nozzle
    };
    let text = text_of(&program(&points, &numbered), &KRL);
    assert_eq!((KRL.reader.read)(&text).tool, "3");
}

#[test]
fn the_acceleration_of_the_path_is_that_of_every_program_that_can_state_one() {
    let points = row();
    let settings = ProgramSettings::default();
    for (i, acceleration) in [None, Some(4.0)].into_iter().enumerate() {
        let program = Program {
            acceleration,
            ..program(&points, &settings)
        };
        for language in RobotLanguage::ALL {
            let moves = (language.reader.read)(&text_of(&program, language)).moves;
            let of_lines: Vec<_> = moves[1..].iter().map(|found| found.acceleration).collect();
            let expected = vec![language.reader.accelerations[i]; 6];
            assert_eq!(of_lines, expected, "{language:?}");
        }
    }
}

#[test]
fn what_a_controller_would_not_take_is_refused_with_advice() {
    let points = row();
    let with = |change: &dyn Fn(&mut ProgramSettings)| {
        let mut settings = ProgramSettings::default();
        change(&mut settings);
        settings
    };
    let refused = |points: &[ProgramPoint], settings: &ProgramSettings, language, name: &str| {
        let error = program(points, settings)
            .texts(language, name)
            .expect_err("refused");
        assert!(!error.advice().is_empty());
        error.to_string()
    };
    let usual = ProgramSettings::default();
    for language in RobotLanguage::ALL {
        for name in ["", "1st", "bon jour", "tür", &"x".repeat(65)] {
            assert!(refused(&points, &usual, language, name).contains("named"));
        }
        assert!(refused(&[], &usual, language, "p").contains("no points"));
        for bad in [f64::NAN, f64::INFINITY] {
            let mut broken = points.clone();
            broken[2].robot_from_nozzle.translation.vector.y = bad;
            assert!(refused(&broken, &usual, language, "p").contains("point 3"));
            let tool = with(&|s| {
                s.flange_from_nozzle = Some(from_euler_zyx([0.0, 0.0, 0.0, bad, 0.0, 0.0]));
            });
            assert!(refused(&points, &tool, language, "p").contains("tool, part or frame"));
        }
        for speed in [0.0, -1.0, 6.0, f64::NAN] {
            let settings = with(&|s| s.params.speed = speed);
            assert!(refused(&points, &settings, language, "p").contains("point 1"));
        }
        for length in [-0.1, 1.5, f64::NAN] {
            let settings = with(&|s| s.params.approach = Metres(length));
            assert!(refused(&points, &settings, language, "p").contains("approach"));
            let settings = with(&|s| s.params.blend = Metres(length));
            assert!(refused(&points, &settings, language, "p").contains("blend"));
        }
        let settings = with(&|s| s.params.gun_output = 60_000);
        assert!(refused(&points, &settings, language, "p").contains("output"));
        if language != &URSCRIPT {
            for tool in ["0", "64", "gun 1", ""] {
                let settings = with(&|s| s.tool = Some(tool.into()));
                assert!(refused(&points, &settings, language, "p").contains("not a tool"));
            }
        }
    }
    // The gun never closes between the first and the last point, so there is no place to cut.
    let on = |point: &ProgramPoint| ProgramPoint {
        is_gun_on: true,
        ..*point
    };
    let long: Vec<ProgramPoint> = points.iter().map(on).cycle().take(20_000).collect();
    for language in RobotLanguage::ALL {
        match program(&long, &usual).texts(language, "p") {
            Err(error) => {
                assert!(error.to_string().contains("the gun stays on"), "{error}");
                assert!(error.advice().contains("point_spacing"));
                assert!(language.calls.is_some());
            }
            Ok(texts) => assert_eq!((language.reader.read)(&texts.main).moves.len(), 20_002),
        }
    }
}

#[test]
fn a_reserved_word_of_the_language_is_no_name_of_a_program() {
    let points = row();
    let settings = ProgramSettings::default();
    for (language, name, is_reserved) in [
        (&KRL, "if", true),
        (&KRL, "EndWhile", true),
        (&KRL, "if_1", false),
        (&RAPID, "Test", true),
        (&RAPID, "tests", false),
        // The controller starts at a procedure of this name.
        (&RAPID, "main", true),
        (&RAPID, "main_1", false),
        (&KRL, "main", false),
        (&URSCRIPT, "if", true),
        (&URSCRIPT, "movel", true),
        (&URSCRIPT, "IF", false),
        (&LS, "if", false),
        (&JBI, "if", false),
        (&DRL, "if", false),
    ] {
        match program(&points, &settings).texts(language, name) {
            Ok(_) => assert!(!is_reserved, "{language:?} {name}"),
            Err(error) => {
                assert!(is_reserved, "{language:?} {name}: {error}");
                let wanted = format!("{name} is a reserved word of {}", language.title);
                assert!(error.to_string().contains(&wanted), "{error}");
                assert!(error.advice().contains(&format!("paint_{name}")));
            }
        }
    }
}

#[test]
fn a_program_is_saved_by_its_ending_and_only_a_program_is_taken_away() {
    let folder = tempfile::tempdir().expect("a folder");
    let points = row();
    let settings = ProgramSettings::default();
    for language in RobotLanguage::ALL {
        let path = folder.path().join(format!("paint.{}", language.ending));
        assert_eq!(RobotLanguage::from_file(&path).expect("known"), language);
        assert!(!remove_previous_program(&path).expect("nothing there"));
        program(&points, &settings)
            .save(&path, language)
            .expect("saved");
        assert!(remove_previous_program(&path).expect("removed"));
        assert!(!path.exists());
        std::fs::write(&path, "mine").expect("written");
        assert!(!remove_previous_program(&path).expect("not ours"));
        assert!(path.exists());
    }
    let error = RobotLanguage::from_file(Path::new("paint.txt")).expect_err("unknown");
    assert!(
        error
            .advice()
            .contains(".src, .ls, .mod, .script, .jbi, .drl")
    );
    let name = folder.path().join("1 door.src");
    let failed = program(&points, &settings).save(&name, &KRL);
    assert!(failed.is_err() && !name.exists());
}

/// 20 000 points, two in five with the gun on.
fn long_path() -> Vec<ProgramPoint> {
    row().into_iter().cycle().take(20_000).collect()
}

#[test]
fn a_path_that_is_too_long_for_one_program_is_called_in_parts() {
    let points = long_path();
    let settings = ProgramSettings::default();
    for language in [&LS, &JBI] {
        let texts = program(&points, &settings)
            .texts(language, "paint")
            .expect("texts");
        let main = (language.reader.read)(&texts.main);
        assert_eq!(main.name, "PAINT");
        assert!(main.moves.is_empty());
        assert!(main.comments.join(" ").contains(MARK));
        let names: Vec<String> = (texts.parts.iter())
            .map(|(name, _)| name.to_uppercase())
            .collect();
        assert_eq!(main.calls, names);
        let mut moves = Vec::new();
        for (i, (name, text)) in texts.parts.iter().enumerate() {
            let read = (language.reader.read)(text);
            assert_eq!(read.name, name.to_uppercase());
            assert!(name.len() <= language.max_name, "{name}");
            assert!(read.calls.is_empty());
            let wanted = format!("part {} of {}", i + 1, texts.parts.len());
            assert!(read.comments.join(" ").contains(&wanted), "{wanted}");
            let (begin, end) = if language == &LS {
                ("/MN", "/POS")
            } else {
                ("///GROUP1 RB1", "never")
            };
            let lines = text.lines().skip_while(|line| *line != begin).skip(1);
            let num = lines.take_while(|line| *line != end).count();
            assert!(num <= 9999, "{name}: {num}");
            // The last one has the rest; the others are full up to one stroke.
            assert!(num > 9900 || i + 1 == texts.parts.len(), "{name}: {num}");
            // The robot stands still, with the gun off, where one part ends and the next begins.
            assert!(!read.is_gun_on);
            assert!(!read.moves[0].is_gun_on || i == 0);
            assert!(read.moves[read.moves.len() - 1].is_exact);
            moves.extend(read.moves);
        }
        assert_eq!(moves.len(), 20_002, "{language:?}");
        let middle = &moves[1..20_001];
        for (i, (found, wanted)) in middle.iter().zip(&points).enumerate() {
            let wanted_at = wanted.robot_from_nozzle.translation.vector;
            let off = (found.to.translation.vector - wanted_at).norm();
            assert!(off <= 1e-6, "{language:?} {i}: {off}");
            assert_eq!(found.is_gun_on, i > 0 && points[i - 1].is_gun_on);
        }
        // The parts of another path have other names.
        let other = program(&points[5..], &settings)
            .texts(language, "paint")
            .expect("texts");
        assert_ne!(other.parts[0].0, texts.parts[0].0);
        // The names of the parts are longer.
        let name = "p".repeat(language.max_name);
        let error = program(&points, &settings)
            .texts(language, &name)
            .expect_err("too long");
        let most = language.max_name - "_12345678_1".len();
        assert!(
            error.advice().contains(&format!("at most {most} ")),
            "{}",
            error.advice()
        );
        let fits = program(&points, &settings).texts(language, &name[..most]);
        assert!(fits.is_ok());
    }
}

#[test]
fn a_set_of_programs_is_written_whole_or_not_at_all_and_removed_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let listed = || {
        let entries = std::fs::read_dir(folder.path()).expect("listed");
        let mut names: Vec<String> = entries
            .map(|entry| entry.expect("one").file_name().into_string().expect("text"))
            .collect();
        names.sort();
        names
    };
    let points = long_path();
    let settings = ProgramSettings::default();
    for language in [&LS, &JBI] {
        let path = folder.path().join(format!("paint.{}", language.ending));
        let long = program(&points, &settings);
        let parts = long.texts(language, "paint").expect("texts").parts;
        let num = long.save(&path, language).expect("saved");
        assert_eq!((num, listed().len()), (parts.len(), parts.len() + 1));
        // The next program replaces all of them, even if it is short.
        let next = program(&points[5..], &settings);
        let num = next.save(&path, language).expect("saved");
        assert_eq!(listed().len(), num + 1);
        assert!(remove_previous_program(&path).expect("removed"));
        assert_eq!(listed(), Vec::<String>::new());
        let num = program(&points[..5], &settings)
            .save(&path, language)
            .expect("saved");
        assert_eq!((num, listed().len()), (0, 1));
        assert!(remove_previous_program(&path).expect("removed"));

        // Parts left by an interruption are removed too; files that are not ours, or parts of another program, stay.
        let left = beside(&path, &parts[0].0);
        std::fs::write(&left, &parts[0].1).expect("written");
        let others = [
            "paint_12345678_1",
            "paint_1",
            "door_12345678_1",
            "paint_x_1",
        ];
        let others = others.map(|name| beside(&path, name));
        std::fs::write(&others[0], "mine").expect("written");
        for other in &others[1..] {
            std::fs::write(other, &parts[0].1).expect("written");
        }
        assert!(remove_previous_program(&path).expect("removed"));
        assert!(!left.exists());
        for other in others {
            assert!(other.exists(), "{}", other.display());
            std::fs::remove_file(other).expect("removed");
        }

        // If a part or the main program cannot be written, nothing remains that a robot could run.
        for in_the_way in [beside(&path, &parts[1].0), path.clone()] {
            std::fs::create_dir(&in_the_way).expect("a folder");
            assert!(long.save(&path, language).is_err());
            assert_eq!(listed().len(), 1, "{:?}", listed());
            std::fs::remove_dir(&in_the_way).expect("removed");
        }
    }
}

/// A check's result with these joints at the points, and the first and the last of them also at its ends.
fn reached(arm: Arm, joints: &[Joints]) -> (PlacedArm, PathCheck) {
    let stands = |joints: &Joints| PointCheck {
        joints: Some(*joints),
        ..PointCheck::default()
    };
    let placed = PlacedArm {
        arm,
        robot_from_base: RigidTransform::identity(),
        flange_from_nozzle: RigidTransform::translation(0.0, 0.0, 0.25),
        gun_radius: GUN_RADIUS_M,
        obstacles: Obstacles::default(),
    };
    let points: Vec<PointCheck> = joints.iter().map(stands).collect();
    let ends = [points[0].clone(), points[points.len() - 1].clone()];
    let check = PathCheck {
        points,
        ends: Some(ends),
    };
    (placed, check)
}

/// One point per set of joints.
fn points_for(joints: &[Joints]) -> Vec<ProgramPoint> {
    row().into_iter().cycle().take(joints.len()).collect()
}

fn in_radians(degrees: [f64; 6]) -> Joints {
    degrees.map(f64::to_radians)
}

#[test]
fn moves_with_the_gun_off_are_slower_or_by_joints_as_they_were_checked() {
    let joints = vec![in_radians([20.0, 10.0, 5.0, 0.0, 40.0, 0.0]); 5];
    let points = points_for(&joints);
    let settings = ProgramSettings::default();
    let mut reach = reached(Arm::named("irb4600").expect("known"), &joints);
    reach.1.points[1].way = Way::Slower(0.04);
    reach.1.points[4].way = Way::Joints;
    let program = Program {
        reach: Some(&reach),
        ..program(&points, &settings)
    };
    let read = (RAPID.reader.read)(&text_of(&program, &RAPID));
    let speeds: Vec<Option<f64>> = read.moves.iter().map(|step| step.speed).collect();
    let usual = Some(settings.params.speed);
    assert_eq!(speeds, [None, usual, Some(0.04), usual, usual, None, usual]);
    // The robot stops before and after a joint move.
    let exact: Vec<bool> = read.moves.iter().map(|step| step.is_exact).collect();
    assert_eq!(exact, [true, true, false, false, true, true, true]);
    let words = "moves with the gun off: 1 slower than in the path, 1 by joints";
    assert!(
        read.comments.join(" ").contains(words),
        "{:?}",
        read.comments
    );
    // The gun also switches where a joint move ends.
    let mut by_joints = reach.clone();
    by_joints.1.points[1].way = Way::Joints;
    let by_joints = Program {
        reach: Some(&by_joints),
        ..program.clone()
    };
    let text = text_of(&by_joints, &RAPID);
    let moves = (RAPID.reader.read)(&text).moves;
    let found = moves
        .iter()
        .map(|step| (step.speed.is_none(), step.is_gun_on));
    let found: Vec<(bool, bool)> = found.collect();
    let (joint, line) = (true, false);
    assert_eq!(
        found[1..5],
        [(line, false), (joint, false), (line, true), (line, true)]
    );
    let on = by_joints.motion(&RAPID).expect("a motion");
    let on: f64 = on
        .iter()
        .filter(|piece| piece.is_gun_on)
        .map(MotionPiece::length)
        .sum();
    assert!((on - 0.2).abs() < 1e-9, "{on}");
    // Another maker's controller does not know the configuration.
    let error = program.texts(&KRL, "paint").expect_err("no name");
    assert!(
        matches!(error, ProgramError::Configuration { point: 5, .. }),
        "{error}"
    );
}

#[test]
fn a_program_begins_and_ends_with_the_nozzle_turned_as_it_was_checked() {
    let joints = vec![in_radians([20.0, 10.0, 5.0, 0.0, 40.0, 0.0]); 5];
    let points = points_for(&joints);
    let settings = ProgramSettings::default();
    let mut reach = reached(Arm::named("irb4600").expect("known"), &joints);
    let before = Translation3::new(0.0, 0.0, -settings.params.approach.0);
    let ends = reach.1.ends.as_mut().expect("ends");
    for ((end, point), turn) in ends.iter_mut().zip([0, 4]).zip([-0.2, 0.5]) {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn);
        end.robot_from_nozzle = points[point].robot_from_nozzle * before * turn;
    }
    let program = Program {
        reach: Some(&reach),
        ..program(&points, &settings)
    };
    for language in RobotLanguage::ALL {
        let moves = (language.reader.read)(&text_of(&program, language)).moves;
        for (found, point, turn) in [(0, 0, -0.2), (6, 4, 0.5)] {
            let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn);
            let wanted = points[point].robot_from_nozzle * before * turn;
            let off = (moves[found].to.translation.vector - wanted.translation.vector).norm();
            let turned = moves[found].to.rotation.angle_to(&wanted.rotation);
            assert!(off <= 1e-6 && turned < 5e-6, "{language:?}: {off} {turned}");
        }
    }
}
