//! Simulated captures.

use std::{fs, path::Path};

use crate::workplace::Workplace;

#[test]
fn the_same_seed_gives_the_same_file() {
    let place = Workplace::new();
    let make = |out: &str| {
        place.accepted(&["simulate", "--part", "grille", "--seed", "9", "--out", out]);
        fs::read(place.path(out)).expect("written")
    };
    assert!(make("a.pcd") == make("b.pcd"));
    let has = |name: &str| Path::new(&place.path(name)).exists();
    make("c.png");
    assert!(has("c.json"), "the camera lies beside the image");
}

#[test]
fn the_origin_of_the_model_is_not_called_its_middle() {
    let place = Workplace::new();
    let simulate = ["simulate", "--part", "fender", "--out", "fender.pcd"];
    let reply = place.accepted(&simulate).out;
    assert!(
        reply.contains("the origin of its model") && !reply.contains("its middle"),
        "{reply}"
    );
}

#[test]
fn a_booth_draws_its_own_stand_and_pose() {
    let place = Workplace::new();
    let simulate = ["simulate", "--part", "fender", "--booth", "--seed", "3"];
    let make = |out: &str| {
        let more = ["--out", out, "--truth", "truth.json"];
        place.accepted(&[&simulate[..], &more[..]].concat());
        (
            fs::read(place.path(out)).expect("written"),
            place.json("truth.json"),
        )
    };
    let (first, truth) = make("a.png");
    assert!((first, &truth) == (make("b.png").0, &truth));
    let share = truth["visible_share"].as_f64().expect("a number");
    assert!((0.2..=1.0).contains(&share), "{share}");
    let camera = place.json("a.json");
    assert_eq!(camera["metres_per_unit"], 0.001);
    for mine in [
        ["--stand", "post"],
        ["--clutter", "on-floor"],
        ["--placement", "hard"],
    ] {
        let ran = place.run(&[&simulate[..], &mine[..], &["--out", "c.png"]].concat());
        assert_eq!(ran.code, 2, "{mine:?}");
        assert!(ran.err.contains("--booth"), "{}", ran.err);
    }
    let cases = ["simulate", "--cases", "kept", "--booth", "--num", "2"];
    place.accepted(&cases);
    let kept = fs::read_dir(place.path("kept")).expect("a folder");
    assert!(kept.count() >= 2);
}

#[test]
fn simulate_overwrites_neither_its_own_camera_nor_another_json() {
    let place = Workplace::new();
    let simulate = ["simulate", "--part", "grille", "--out"];
    let run = |more: &[&str]| place.run(&[&simulate[..], more].concat());
    for (more, expected) in [
        (
            &["tt.png", "--truth", "tt.json"][..],
            "the camera of the depth image",
        ),
        (
            &["tt.png", "--truth", "./tt.json"],
            "the camera of the depth image",
        ),
        (&["tt.pcd", "--truth", "./tt.pcd"], "the same file"),
    ] {
        let ran = run(more);
        assert_eq!(ran.code, 2, "{more:?}");
        assert!(
            ran.err.contains(expected) && ran.err.contains("to do"),
            "{}",
            ran.err
        );
    }
    fs::write(place.path("keep.json"), "{\"shift\": 3}").expect("written");
    let ran = run(&["keep.png"]);
    assert_eq!(ran.code, 2);
    assert!(
        ran.err.contains("keep.json") && ran.err.contains("to do"),
        "{}",
        ran.err
    );
    let kept = fs::read_to_string(place.path("keep.json")).expect("there");
    assert_eq!(kept, "{\"shift\": 3}");
    assert!(!place.path("keep.png").exists());
    for _ in 0..2 {
        assert_eq!(run(&["tt.png", "--truth", "tt.truth.json"]).code, 0);
    }
    let camera = place.run(&["enrol", "tt.json", "--name", "x", "--library", "parts"]);
    assert!(
        camera.err.contains("this is the camera of tt.png"),
        "{}",
        camera.err
    );
}

#[test]
fn a_pose_in_the_wrong_unit_is_doubted_and_an_unseen_part_is_said() {
    let place = Workplace::new();
    let simulate = ["simulate", "--part", "grille", "--out", "g.pcd", "--pose"];
    let run = |pose: &str| place.accepted(&[&simulate[..], &[pose]].concat()).err;
    assert_eq!(run("0 0 15° 0 0 130cm"), "");
    assert!(run("0 0 15 0 0 1.2").contains("did you mean 15deg?"));
    let far = run("0 0 0 0 0 1200");
    assert!(far.contains("did you mean 1200mm?"), "{far}");
    assert!(far.contains("does not see the part"), "{far}");
}

#[test]
fn a_rack_lists_its_parts_from_left_to_right() {
    let place = Workplace::new();
    let simulate = ["simulate", "--rack", "3", "--seed", "4"];
    let make = |kind: &str, out: &str| {
        let more = [
            "--rack-kind",
            kind,
            "--out",
            out,
            "--truth",
            "rack.truth.json",
        ];
        let reply = place.accepted(&[&simulate[..], &more[..]].concat()).out;
        let file = fs::read(place.path(out)).expect("written");
        (reply, file, place.json("rack.truth.json"))
    };
    let (reply, file, truth) = make("mirrored", "a.png");
    let (_, file_again, truth_again) = make("mirrored", "b.png");
    assert!(file == file_again && truth == truth_again);
    let parts = truth["parts"].as_array().expect("a list");
    assert_eq!(parts.len(), 3);
    let x_of = |part: &serde_json::Value| part["camera_from_model"][3].as_f64().expect("a number");
    assert!(parts.is_sorted_by_key(x_of), "{truth}");
    for part in parts {
        let share = part["visible_share"].as_f64().expect("a number");
        assert!((0.6..=1.0).contains(&share), "{share}");
    }
    let sides = |side: &str| {
        let of_side = parts
            .iter()
            .filter(|p| p["subject"]["part"]["side"] == side);
        of_side.count()
    };
    assert_eq!(sides("right"), 1);
    assert!(reply.contains("3 of them taken") && reply.contains("  right "));
    assert!(make("empty", "c.pcd").0.contains("2 of them taken"));
    for (wrong, expected) in [
        (&["--rack", "6"][..], "2 to 5 places"),
        (&["--rack", "1"], "a single part"),
        (&["--rack", "3", "--booth"], "--booth"),
        (&["--rack", "3", "--part", "fender"], "--part"),
        (&["--part", "fender", "--rack-kind", "equal"], "--rack"),
    ] {
        let ran = place.run(&[&["simulate", "--out", "d.pcd"], wrong].concat());
        assert_eq!(ran.code, 2, "{wrong:?}");
        assert!(ran.err.contains(expected), "{}", ran.err);
        assert!(!place.path("d.pcd").exists());
    }
}
