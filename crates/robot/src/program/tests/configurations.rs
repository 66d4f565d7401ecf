//! Configurations of an arm at each point, in each controller's notation.

use super::*;
use crate::arm::ARM_NAMES;

/// The configurations that the program for the arm's maker gives for these joints, degrees, at each point.
fn words_of(name: &str, language: &'static RobotLanguage, degrees: &[[f64; 6]]) -> Vec<String> {
    let joints: Vec<Joints> = degrees.iter().copied().map(in_radians).collect();
    let points = points_for(&joints);
    let settings = ProgramSettings::default();
    let reach = reached(Arm::named(name).expect("known"), &joints);
    let program = Program {
        reach: Some(&reach),
        ..program(&points, &settings)
    };
    let read = (language.reader.read)(&text_of(&program, language));
    assert_eq!(read.moves.len(), joints.len() + 2);
    let words = read.comments.join(" ");
    assert!(
        words.contains("in the configuration that was checked"),
        "{words}"
    );
    let checked = "collisions with part and arm, without boxes or floor, clearance 20.0 mm, gun radius 50.0 mm";
    assert!(words.contains(checked), "{words}");
    let mut all = read.moves.into_iter().map(|found| found.configuration);
    let first = all.next().expect("a joint move");
    let mut all: Vec<String> = all.collect();
    let last = all.pop().expect("the way back");
    if language == &KRL {
        // Linear moves have none.
        assert!(all.iter().all(String::is_empty) && last.is_empty());
        return vec![first];
    }
    assert_eq!((&first, &last), (&all[0], &all[all.len() - 1]));
    all
}

fn format_of(arm: &str) -> &'static RobotLanguage {
    match arm {
        "kr6-r900" => &KRL,
        "m-20ia" => &LS,
        "gp25" => &JBI,
        _ => &RAPID,
    }
}

/// Whether the wrist is ahead of joint 1, and in front of the line of the upper arm, by the makers' drawings. Lengths:
/// from joint 1 to joint 2, upper arm, forearm, and offset above the forearm, metres.
fn drawn(arm: &str, degrees: &[f64; 6]) -> [bool; 2] {
    let [_, a2, a3, ..] = *degrees;
    // Angles of the upper arm from upright to the front, and of the forearm from level downwards.
    let (lengths, upper, fore) = match arm {
        "kr6-r900" => ([0.025, 0.455, 0.42, 0.025], a2 + 90.0, a2 + a3),
        "m-20ia" => ([0.15, 0.79, 0.835, 0.25], a2, a2 - a3),
        "irb2600" => ([0.15, 0.7, 0.795, 0.115], a2, a2 + a3),
        "irb4600" => ([0.175, 1.095, 1.27, 0.175], a2, a2 + a3),
        "gp25" => ([0.15, 0.76, 0.795, 0.2], a2, a2 - a3),
        _ => panic!("{arm}"),
    };
    let [to_joint_2, upper_arm, forearm, step] = lengths;
    let (upper_sin, upper_cos) = upper.to_radians().sin_cos();
    let (fore_sin, fore_cos) = fore.to_radians().sin_cos();
    // From the elbow to the wrist: ahead and up.
    let wrist = [
        forearm * fore_cos + step * fore_sin,
        step * fore_cos - forearm * fore_sin,
    ];
    let ahead = to_joint_2 + upper_arm * upper_sin + wrist[0];
    let before = wrist[0] * upper_cos - wrist[1] * upper_sin;
    [ahead > 0.0, before > 0.0]
}

/// Compares a configuration with the joints as the controllers' manuals define it.
fn fits(
    language: &'static RobotLanguage,
    words: &str,
    degrees: &[f64; 6],
    [ahead, before]: [bool; 2],
) {
    let numbers = |text: &str| -> Vec<i32> {
        let numbers = text.split([',', ' ']).filter_map(|n| n.parse().ok());
        numbers.collect()
    };
    let what = format!("{words}: {degrees:?}");
    match language.name {
        "krl" => {
            let [s, t] = numbers(&words.replace("S ", "").replace("T ", ""))[..] else {
                panic!("{what}");
            };
            assert_eq!(s & 1 == 0, ahead, "{what}");
            assert_eq!(s & 2 != 0, before, "{what}");
            assert_eq!(s & 4 != 0, degrees[4] < 0.0, "{what}");
            for (i, angle) in degrees.iter().enumerate() {
                assert_eq!(t & (1 << i) != 0, *angle < 0.0, "{what}");
            }
            assert!((0..8).contains(&s) && (0..64).contains(&t));
        }
        "ls" => {
            let [letters, turns] = [&words[..5], &words[5..]];
            let wanted = format!(
                "{} {} {}",
                if degrees[4] < 0.0 { 'N' } else { 'F' },
                if before { 'U' } else { 'D' },
                if ahead { 'T' } else { 'B' }
            );
            assert_eq!(letters, wanted, "{what}");
            let turns = numbers(turns);
            assert_eq!(turns.len(), 3);
            for (turn, angle) in turns.iter().zip(&degrees[3..]) {
                // The remainder after whole turns is within half a turn of 0.
                let left = angle - 360.0 * f64::from(*turn);
                assert!(left.abs() <= 180.0, "{what}");
            }
        }
        "rapid" => {
            let [cf1, cf4, cf6, cfx] = numbers(words)[..] else {
                panic!("{what}");
            };
            for (quarter, axis) in [(cf1, 0), (cf4, 3), (cf6, 5)] {
                let low = 90.0 * f64::from(quarter);
                assert!((low..low + 90.0).contains(&degrees[axis]), "{what}");
            }
            let wanted = [!ahead, !before, degrees[4] < 0.0];
            let wanted = wanted.iter().fold(0, |all, bit| 2 * all + i32::from(*bit));
            assert_eq!(cfx, wanted, "{what}");
        }
        _ => {
            let all = numbers(words);
            assert!(
                all.len() == 24 && all[6..].iter().all(|n| *n == 0),
                "{what}"
            );
            let is_beyond = |axis: usize| degrees[axis].abs() >= 180.0;
            let wanted = [
                degrees[4] < 0.0,
                !before,
                !ahead,
                is_beyond(3),
                is_beyond(5),
                is_beyond(0),
            ];
            assert_eq!(all[..6], wanted.map(i32::from), "{what}");
        }
    }
}

#[test]
fn every_controller_is_told_the_configuration_that_was_checked() {
    let mut random = Pcg64::seed_from_u64(11);
    let reach = [170.0, 120.0, 150.0, 350.0, 125.0, 350.0];
    for arm in ARM_NAMES {
        let language = format_of(arm);
        let sets: Vec<[f64; 6]> = (0..400)
            .map(|_| reach.map(|most| random.random_range(-most..most)))
            .collect();
        let mut kinds = std::collections::BTreeSet::new();
        // KRL gives only the first.
        let num = if language == &KRL { 1 } else { 50 };
        for sets in sets.chunks(num) {
            let found = words_of(arm, language, sets);
            assert_eq!(found.len(), sets.len());
            for (words, degrees) in found.iter().zip(sets) {
                fits(language, words, degrees, drawn(arm, degrees));
                let [ahead, before] = drawn(arm, degrees);
                kinds.insert([ahead, before, degrees[4] < 0.0]);
            }
        }
        assert_eq!(kinds.len(), 8, "{arm}: {kinds:?}");
    }
}

#[test]
fn the_borders_of_quarters_and_turns_belong_to_one_side_whatever_the_last_bit_is() {
    let with = |axis: usize, angle: f64| {
        let mut degrees = [10.0, 10.0, 10.0, 10.0, 30.0, 10.0];
        degrees[axis] = angle;
        degrees
    };
    let words = |arm: &str, axis: usize, angle: f64| {
        [angle - 1e-9, angle, angle + 1e-9].map(|angle| {
            let words = words_of(arm, format_of(arm), &[with(axis, angle)]);
            words.into_iter().next().expect("one")
        })
    };
    let part = |words: &str, index: usize| -> i32 {
        let words = words.trim_start_matches(|c: char| !c.is_ascii_digit() && c != '-');
        let part = words.split(',').nth(index).expect("a number");
        part.trim().parse().expect("a number")
    };
    for (angle, quarter) in [
        (0.0, 0),
        (90.0, 1),
        (180.0, 2),
        (270.0, 3),
        (-90.0, -1),
        (-180.0, -2),
    ] {
        for (axis, index) in [(0, 0), (3, 1), (5, 2)] {
            for words in words("irb4600", axis, angle) {
                assert_eq!(part(&words, index), quarter, "{words}: {angle}");
            }
        }
    }
    for (angle, turn) in [(0.0, 0), (179.9, 0), (180.0, 1), (-179.9, 0), (-180.0, -1)] {
        for words in words("m-20ia", 3, angle) {
            // After the letters.
            assert_eq!(part(&words, 0), turn, "{words}: {angle}");
        }
        for words in words("gp25", 3, angle) {
            assert_eq!(part(&words, 3), turn.abs(), "{words}: {angle}");
        }
    }
    // A joint at zero is not negative.
    for axis in 0..6 {
        for words in words("kr6-r900", axis, 0.0) {
            assert!(words.ends_with(",T 0"), "{words}");
        }
    }
}

#[test]
fn poses_that_controllers_showed_have_their_configuration() {
    // KUKA's home position.
    let home = [0.0, -90.0, 90.0, 0.0, 0.0, 0.0];
    assert_eq!(words_of("kr6-r900", &KRL, &[home]), ["S 2,T 2"]);
    // ABB's, with the wrist bent down.
    let home = [0.0, 0.0, 0.0, 0.0, 30.0, 0.0];
    let found = words_of("irb2600", &RAPID, &[home]);
    assert_eq!(found, ["0,0,0,0"]);
    // FANUC: J3 is -10.99° on the controller, where it is counted against the horizontal.
    let shown = [86.75, -45.63, -56.62, 56.19, -81.55, -94.01];
    let found = words_of("m-20ia", &LS, &[shown]);
    assert_eq!(found, ["N U T, 0, 0, 0"]);
    // A YRC1000 with a larger arm of the same shape: home, B upwards, leaning back, T on either side.
    let home = [0.15, -39.5, 0.75, 0.0, -130.3, 0.0];
    let with = |axis: usize, angle: f64| {
        let mut degrees = home;
        degrees[axis] = angle;
        degrees
    };
    let shown = [
        home,
        with(4, 5.8),
        with(1, -87.3),
        with(5, 241.8),
        with(5, -241.8),
    ];
    let wanted = [
        "1,0,0,0,0,0",
        "0,0,0,0,0,0",
        "1,0,1,0,0,0",
        "1,0,0,0,1,0",
        "1,0,0,0,1,0",
    ];
    let found = words_of("gp25", &JBI, &shown);
    let wanted = wanted.map(|wanted| format!("{wanted}{}", ",0".repeat(18)));
    assert_eq!(found, wanted);
}

#[test]
fn an_arm_of_another_maker_or_of_none_leaves_the_configuration_as_it_was() {
    let joints = vec![in_radians([20.0, 10.0, 5.0, 200.0, 40.0, -200.0]); 5];
    let points = points_for(&joints);
    let settings = ProgramSettings::default();
    let words = |arm: Option<Arm>, language: &'static RobotLanguage| -> Vec<String> {
        let reach = arm.map(|arm| reached(arm, &joints));
        let program = Program {
            reach: reach.as_ref(),
            ..program(&points, &settings)
        };
        let text = text_of(&program, language);
        assert!(!text.contains("ConfJ\\On"), "{text}");
        let read = (language.reader.read)(&text);
        let says = read.comments.join(" ").contains("is not named here");
        assert_eq!(says, program.reach.is_some());
        let moves = read.moves.into_iter();
        moves.map(|found| found.configuration).collect()
    };
    for language in RobotLanguage::ALL {
        let bare = words(None, language);
        for arm in ARM_NAMES {
            if format_of(arm) != language {
                let arm = Arm::named(arm).expect("known");
                assert_eq!(words(Some(arm), language), bare, "{language:?}");
            }
        }
    }
    // An arm from a file, with the numbers of a GP25.
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("arm.toml");
    let text = "name = \"Cell 3\"\n\
        lengths_mm = [150, -200, 0, 505, 760, 795, 100]\n\
        offsets_deg = [0, 0, -90, 0, 0, 180]\n\
        signs = [1, 1, -1, -1, -1, -1]\n\
        limits_deg = [[-180, 180], [-105, 155], [-86, 160], [-200, 200], [-155, 150], [-455, 455]]\n\
        speeds_deg_s = [210, 210, 265, 420, 420, 885]\n";
    std::fs::write(&path, text).expect("written");
    for language in RobotLanguage::ALL {
        let arm = Arm::named(path.to_str().expect("a path")).expect("an arm");
        assert_eq!(
            words(Some(arm), language),
            words(None, language),
            "{language:?}"
        );
    }
    // A point that was not reached has the usual configuration; if RCONF cannot express the turns at one point, all have.
    let mut reach = reached(Arm::named("gp25").expect("known"), &joints);
    reach.1.points[2].joints = None;
    let is_usual = |found: &read::Move| found.configuration.starts_with("1,0,0,0,0,0,");
    for (joint_6, wanted, is_named) in [
        (0.0, [false, false, false, true, false, false, false], true),
        (400.0, [true; 7], false),
    ] {
        reach.1.points[3].joints = Some(in_radians([20.0, 10.0, 5.0, 0.0, 40.0, joint_6]));
        let program = Program {
            reach: Some(&reach),
            ..program(&points, &settings)
        };
        let read = (JBI.reader.read)(&text_of(&program, &JBI));
        let usual: Vec<bool> = read.moves.iter().map(is_usual).collect();
        // The first one is the approach.
        assert_eq!(usual, wanted);
        let says = read
            .comments
            .join(" ")
            .contains("its configuration is not named here");
        assert_eq!(says, !is_named);
    }
}
