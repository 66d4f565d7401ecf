//! Simulating, and what is said of bad input, help and errors.

use std::{fs, path::Path, process::Stdio};

use crate::workplace::{Ran, Workplace};

#[test]
fn bad_arguments_and_folders_end_with_two_and_say_why() {
    let place = Workplace::new();
    for (args, expected) in [
        (&["inspect"][..], "required"),
        (
            &["inspect", "x.pcd", "--library", "nowhere"],
            "no such library folder",
        ),
        (&["enrol", "x.pcd", "--name", "../x"], "cannot stand there"),
        (
            &["enrol", "x.pcd", "--name", "Front Door"],
            "cannot stand there",
        ),
        (
            &["simulate", "--part", "boat", "--out", "x.pcd"],
            "front_bumper",
        ),
        (&["simulate", "--part", "fender", "--out", "x.doc"], ".pcd"),
        (
            &["simulate", "--part", "fender", "--out", "nowhere/x.pcd"],
            "nowhere",
        ),
        (
            &[
                "simulate", "--part", "fender", "--out", "x.pcd", "--pose", "1 2",
            ],
            "six",
        ),
        (&["align", "a.ply", "b.ply"], "a.ply: no such file"),
        (
            &["library", "show", "x", "--library", "nowhere"],
            "no such library folder",
        ),
    ] {
        let ran = place.run(args);
        assert_eq!(ran.code, 2, "{args:?}");
        assert!(ran.err.contains(expected), "{args:?}: {}", ran.err);
        assert_eq!(ran.out, "", "{args:?}");
    }
    assert!(fs::read_dir(place.path("")).expect("listed").all(|f| {
        // Nothing was made but, at most, the user's library.
        f.expect("an entry").file_name() == "data"
    }));
}

#[test]
fn help_shows_examples_and_exit_codes() {
    let place = Workplace::new();
    for command in [
        &[][..],
        &["inspect"],
        &["enrol"],
        &["library"],
        &["align"],
        &["simulate"],
    ] {
        let help = place.accepted(&[command, &["--help"]].concat());
        assert!(help.out.contains("Examples:\n  partsight "), "{command:?}");
    }
    let help = place.accepted(&["inspect", "--help"]).out;
    assert!(
        help.contains("Exit codes") && help.contains("icp-ga"),
        "{help}"
    );
}

#[test]
fn a_reader_that_goes_away_changes_nothing_about_the_verdict() {
    let place = Workplace::new();
    place.with_part("fender");
    let mut child = place
        .command(&[
            "inspect",
            "--json",
            "--library",
            "parts",
            "fender.pcd",
            "fender.pcd",
        ])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("starts");
    drop(child.stdout.take());
    let ran = Ran::from(child.wait_with_output().expect("ends"));
    assert_eq!((ran.code, ran.err.as_str()), (0, ""));
}

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
fn causes_are_said_once_in_words_with_advice_that_fits() {
    let place = Workplace::new();
    place.with_part("fender");
    fs::write(place.path("cut.pcd"), "VERSION 0.7\nFIELDS x y z\n").expect("written");
    let simulate = ["simulate", "--part", "grille", "--out"];
    for (args, expected) in [
        (
            &["inspect", "cut.pcd", "--library", "parts"][..],
            "expected the end of the header",
        ),
        (
            &[&simulate[..], &["no/such/x.pcd"]].concat()[..],
            "the folder does not exist",
        ),
        (
            &[&simulate[..], &["x.foo"]].concat(),
            ".png for a depth image",
        ),
        (
            &[
                "inspect",
                "fender.pcd",
                "--library",
                "parts",
                "--report",
                "fender.pcd",
            ],
            "a file of that name is there",
        ),
        (
            &[
                "inspect",
                "fender.pcd",
                "--library",
                "parts",
                "--report",
                "fender.pcd/why",
            ],
            "a part of the path is a file",
        ),
        (
            &["inspect", "parts", "--library", "parts"],
            "a folder, expected a file",
        ),
        (
            &["inspect", "/dev/null", "--library", "parts"],
            "not a regular file",
        ),
    ] {
        let ran = place.run(args);
        assert_eq!(ran.code, 2, "{args:?}");
        let message = ran.err.lines().next().unwrap_or_default();
        assert_eq!(
            message.matches(expected).count(),
            1,
            "{args:?}: {}",
            ran.err
        );
        assert!(ran.err.contains("to do: "), "{args:?}: {}", ran.err);
        assert!(
            !ran.err.contains("os error") && !ran.err.contains(".partsight"),
            "{}",
            ran.err
        );
    }
}
