//! Files of pairs with the mistakes that people make.

use std::path::Path;

use nalgebra::Point3;
use partsight::{
    geometry::rigid::{from_row_major, pose_error},
    robot::{
        hand_eye::{HandEye, HandEyeDoubt, LikelyMistake, Mount, Target, solve},
        pairs::{PairConventions, read_pairs},
    },
};

use crate::data_folder;

fn solved(path: &Path) -> HandEye {
    let read = read_pairs(path, PairConventions::default()).expect("pairs");
    solve(&read.pairs, Mount::EyeInHand, Target::Marker).expect("solved")
}

#[test]
fn lines_that_repeat_others_change_nothing() {
    let Some(data) = data_folder() else { return };
    let folder = data.join("reported/hand_eye_repeated_lines");
    let once = solved(&folder.join("three.csv"));
    let thrice = solved(&folder.join("three_times_three.csv"));
    assert!((once.bounds.shift.mm() - 13.7).abs() < 0.1);
    assert!((thrice.bounds.shift.0 - once.bounds.shift.0).abs() < 1e-9);
    let in_words = |solved: &HandEye| -> Vec<String> {
        solved.doubts.iter().map(ToString::to_string).collect()
    };
    assert_eq!(in_words(&thrice), in_words(&once));
    let is_few = |doubt: &HandEyeDoubt| matches!(doubt, HandEyeDoubt::FewPairs { found: 3 });
    assert!(thrice.doubts.iter().any(is_few), "{:?}", thrice.doubts);
    let truth = std::fs::read_to_string(folder.join("truth.json")).expect("the truth");
    let truth: serde_json::Value = serde_json::from_str(&truth).expect("JSON");
    let truth: [f64; 16] =
        serde_json::from_value(truth["flange_from_camera"].clone()).expect("16 numbers");
    let truth = from_row_major(&truth, 1e-6).expect("a rigid transform");
    let off = pose_error(
        &thrice.mount_from_camera,
        &truth,
        &Point3::new(-0.14, -0.02, 0.43),
    );
    assert!(off.shift < thrice.bounds.shift, "{off:?}");
}

#[test]
fn a_quaternion_with_its_scalar_at_the_other_end_is_named() {
    let Some(data) = data_folder() else { return };
    let folder = data.join("reported/hand_eye_quaternion_order");
    assert!(solved(&folder.join("right.csv")).is_usable());
    let wrong = solved(&folder.join("scalar_last.csv"));
    assert!(
        matches!(
            wrong.doubts.first(),
            Some(HandEyeDoubt::Mistaken {
                mistake: LikelyMistake::RobotScalarMoved,
                ..
            })
        ),
        "{:?}",
        wrong.doubts
    );
    assert!(wrong.doubts[0].to_string().contains("at the other end"));
}
