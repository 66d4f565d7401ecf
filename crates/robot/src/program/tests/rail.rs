//! An arm that a rail moves along the path.

use super::*;
use crate::arm::Rail;

/// An arm on a rail along y with this top speed, and the rail's position at each point, metres.
fn on_rail(name: &str, rails: &[f64], speed: Option<f64>) -> (PlacedArm, PathCheck) {
    let joints = vec![in_radians([20.0, 10.0, 5.0, 30.0, 40.0, -20.0]); rails.len()];
    let (mut placed, mut check) = reached(Arm::named(name).expect("known"), &joints);
    placed.arm.rail = Some(Rail {
        direction: Vector3::y_axis(),
        range: [-20.0, 20.0],
        speed,
        acceleration: None,
    });
    for (point, rail) in check.points.iter_mut().zip(rails) {
        point.rail = *rail;
    }
    let ends = check.ends.as_mut().expect("ends");
    ends[0].rail = -12.345_678;
    ends[1].rail = 0.0;
    (placed, check)
}

const RAILS: [f64; 5] = [-1.5, -0.000_1, 0.25, 0.25, 19.999];

#[test]
fn a_rail_that_moves_is_the_external_axis_of_every_position() {
    let points = row();
    let settings = ProgramSettings::default();
    for (arm, language, axis) in [
        ("kr6-r900", &KRL, "rail: E1, mm"),
        ("m-20ia", &LS, "rail: E1, mm"),
        ("irb4600", &RAPID, "rail: eax_a, mm"),
        ("gp25", &JBI, "rail: BC, base axis 1, mm"),
        // The configuration is not known, but the rail is.
        ("gp25", &KRL, "rail: E1, mm"),
    ] {
        let text = |speed: Option<f64>| {
            let reach = on_rail(arm, &RAILS, speed);
            let program = Program {
                reach: Some(&reach),
                ..program(&points, &settings)
            };
            text_of(&program, language)
        };
        let read = (language.reader.read)(&text(Some(1.0)));
        let found: Vec<f64> = (read.moves.iter())
            .map(|found| found.rail.expect("written"))
            .collect();
        let wanted = [-12.345_678, -1.5, -0.000_1, 0.25, 0.25, 19.999, 0.0];
        assert_eq!(found.len(), wanted.len());
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() <= 0.51e-6, "{language:?}: {found}");
        }
        let words = read.comments.join(" ");
        assert!(words.contains(axis), "{words}");
        assert!(words.contains("0 where the cell was calibrated"), "{words}");
        // Everything else is as without a rail.
        let still = (language.reader.read)(&text(None));
        assert!(!still.comments.join(" ").contains("rail:"));
        for (moved, still) in read.moves.iter().zip(&still.moves) {
            assert_eq!(still.rail, None);
            assert_eq!(moved.to, still.to);
            assert_eq!(moved.configuration, still.configuration);
            assert_eq!(moved.is_exact, still.is_exact);
        }
    }
}

#[test]
fn linear_moves_may_use_the_whole_speed_of_the_rail_and_the_first_move_a_tenth() {
    let points = row();
    let settings = ProgramSettings::default();
    let text = |arm: &str, language: &'static RobotLanguage, speed: Option<f64>| {
        let reach = on_rail(arm, &RAILS, speed);
        let program = Program {
            reach: Some(&reach),
            ..program(&points, &settings)
        };
        text_of(&program, language)
    };
    let rapid = text("irb4600", &RAPID, Some(0.8));
    let of = |text: &str, verb: &str, speed: &str| {
        let moves = text.lines().filter(|line| line.trim().starts_with(verb));
        let moves: Vec<&str> = moves.collect();
        assert!(!moves.is_empty(), "{text}");
        assert!(moves.iter().all(|line| line.contains(speed)), "{moves:?}");
    };
    of(&rapid, "MoveJ ", ",[100,50,80.000,100],");
    of(&rapid, "MoveL", ",500,800.000,1000],");
    let krl = |speed| text("kr6-r900", &KRL, speed);
    let moving = krl(Some(0.8));
    let (_, behind) = moving.split_once("\r\nPTP ").expect("a first move");
    let first = behind.lines().nth(1).expect("a line behind it");
    assert_eq!(first, "$VEL_EXTAX[1]=100");
    assert!(!krl(None).contains("$VEL_EXTAX"));
}

#[test]
fn a_language_without_external_axes_is_refused_where_a_rail_moves() {
    let points = row();
    let settings = ProgramSettings::default();
    for language in [&URSCRIPT, &DRL] {
        let with = |speed: Option<f64>| {
            let reach = on_rail("gp25", &RAILS, speed);
            let program = Program {
                reach: Some(&reach),
                ..program(&points, &settings)
            };
            program.texts(language, "paint")
        };
        assert!(with(None).is_ok());
        let error = with(Some(1.0)).expect_err("no axis");
        assert!(error.to_string().contains("rail"), "{error}");
        assert!(error.advice().contains("stands still"));
    }
}

#[test]
fn a_path_in_several_programs_keeps_its_rail() {
    let points = long_path();
    let settings = ProgramSettings::default();
    let rails: Vec<f64> = (0..points.len())
        .map(|i| 1e-3 * (i % 4000) as f64)
        .collect();
    let reach = on_rail("gp25", &rails, Some(1.0));
    let program = Program {
        reach: Some(&reach),
        ..program(&points, &settings)
    };
    for language in [&LS, &JBI] {
        let texts = program.texts(language, "paint").expect("texts");
        // The main program has the same axes as the programs that it calls.
        let main = (language.reader.read)(&texts.main);
        assert_eq!(main.calls.len(), texts.parts.len());
        let is_of_rail = texts.main.contains("///GROUP1 RB1,BS1");
        assert_eq!(is_of_rail, language == &JBI);
        let parts = texts
            .parts
            .iter()
            .map(|(_, text)| (language.reader.read)(text));
        let moves: Vec<read::Move> = parts.flat_map(|read| read.moves).collect();
        for (found, wanted) in moves[1..].iter().zip(&rails) {
            let rail = found.rail.expect("written");
            assert!(
                (rail - wanted).abs() < 1e-6,
                "{language:?}: {rail} {wanted}"
            );
        }
    }
}
