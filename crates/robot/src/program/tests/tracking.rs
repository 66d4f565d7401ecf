//! Programs in a frame that moves with a line.

use super::*;

/// A path, and the settings of a program in the frame of a line.
fn tracked(number: u8) -> ProgramSettings {
    let robot_from_frame = from_euler_zyx([0.2, -0.1, 1.1, 0.4, -1.5, 0.9]);
    ProgramSettings {
        tracking: Some(TrackingFrame {
            number,
            robot_from_frame,
        }),
        ..ProgramSettings::default()
    }
}

#[test]
fn a_program_that_follows_a_line_has_the_path_in_the_frame_of_the_line_and_no_joint_moves() {
    for seed in 0..20 {
        let points = any_path(seed);
        let settings = tracked(1);
        let standing = ProgramSettings::default();
        let frame = settings.tracking.expect("one").robot_from_frame;
        for language in [&RAPID, &LS, &URSCRIPT] {
            let read = |settings| {
                let text = text_of(&program(&points, settings), language);
                assert!(text.is_ascii());
                (language.reader.read)(&text)
            };
            let (found, still) = (read(&settings), read(&standing));
            assert_eq!((&*found.tracking, found.has_left), ("1", true));
            assert_eq!((&*still.tracking, still.has_left), ("", false));
            assert_eq!(found.moves.len(), still.moves.len());
            for (found, still) in found.moves.iter().zip(&still.moves) {
                let to = frame * found.to;
                let off = (to.translation.vector - still.to.translation.vector).norm();
                assert!(off < 2e-5, "{language:?} {seed}: {off}");
                assert!(to.rotation.angle_to(&still.to.rotation) < 1e-5, "{seed}");
                // The first move of a program for a part that stands still turns the joints.
                let speed = still.speed.unwrap_or(0.1);
                assert!((found.speed.expect("linear") - speed).abs() < 1e-3);
                assert_eq!(found.is_gun_on, still.is_gun_on);
                assert_eq!(found.is_exact, still.is_exact);
            }
            if let Some(direction) = found.direction {
                assert!((direction - frame * Vector3::x()).norm() < 1e-5);
            }
            let words = found.comments.join(" ");
            let wanted = "begins with the count at which the part was seen";
            assert!(words.contains(wanted), "{words}");
            assert!(!words.contains("robot base"), "{words}");
        }
    }
}

#[test]
fn languages_that_follow_no_line_and_wrong_numbers_are_refused_with_advice() {
    let points = row();
    let refused = |number: u8, language| {
        let settings = tracked(number);
        let error = program(&points, &settings).texts(language, "paint");
        let error = error.expect_err("refused");
        (error.to_string(), error.advice())
    };
    for language in [&KRL, &JBI, &DRL] {
        let (error, advice) = refused(1, language);
        assert!(error.contains("moves with a line"), "{error}");
        let wanted = "FANUC, ABB or Universal Robots";
        assert!(advice.contains(wanted), "{advice}");
    }
    for (language, number, range) in [
        (&RAPID, 0, "1 to 6"),
        (&LS, 7, "1 to 6"),
        (&URSCRIPT, 2, "0 to 1"),
    ] {
        let (error, advice) = refused(number, language);
        assert!(error.contains(&number.to_string()), "{error}");
        assert!(advice.contains(range), "{advice}");
    }
}

#[test]
fn what_a_program_that_follows_a_line_cannot_do_is_refused() {
    let mut long = row();
    let more = long[3];
    long.extend(std::iter::repeat_n(more, 10_000));
    let settings = tracked(1);
    let error = program(&long, &settings)
        .texts(&LS, "paint")
        .expect_err("too long");
    assert!(
        matches!(error, ProgramError::TrackedTooMany { .. }),
        "{error}"
    );
    let joints = vec![[0.1, 0.2, 0.3, 0.4, 0.5, 0.6]; 5];
    let reach = reached(Arm::named("irb4600").expect("known"), &joints);
    let points = row();
    let checked = Program {
        reach: Some(&reach),
        ..program(&points, &settings)
    };
    let error = checked.texts(&RAPID, "paint").expect_err("reach");
    assert!(matches!(error, ProgramError::TrackedReach) && error.advice().contains("--arm"));
    let mut broken = tracked(1);
    if let Some(frame) = &mut broken.tracking {
        frame.robot_from_frame.translation.vector.x = f64::NAN;
    }
    let error = program(&points, &broken)
        .texts(&RAPID, "paint")
        .expect_err("no number");
    assert!(
        matches!(error, ProgramError::NotFinite { point: 0 }),
        "{error}"
    );
}
