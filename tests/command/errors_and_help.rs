//! Messages for bad input, and help texts.

use std::{fs, process::Stdio};

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
        (&["enrol", "x.pcd", "--name", "../x"], "is not a valid name"),
        (
            &["enrol", "x.pcd", "--name", "Front Door"],
            "is not a valid name",
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
        // At most the user's library was created.
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
        &["serve"],
    ] {
        let help = place.accepted(&[command, &["--help"]].concat());
        assert!(help.out.contains("Examples:\n  partsight "), "{command:?}");
        // No line that goes on in the next one is broken before it is full.
        let lines: Vec<&str> = help.out.lines().collect();
        for pair in lines.windows(2) {
            let next = pair[1].split(' ').next().unwrap_or_default();
            let goes_on = !pair[0].starts_with(' ') && next.starts_with(char::is_lowercase);
            let is_full = pair[0].chars().count() + next.chars().count() >= 100;
            assert!(!goes_on || is_full, "{command:?}: {}", pair[0]);
        }
    }
    let help = place.accepted(&["serve", "--help"]).out;
    assert_eq!(help.matches("ORDER=4711").count(), 2, "{help}");
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
        // Windows has the message above for it.
        #[cfg(unix)]
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
        #[cfg(unix)]
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

#[cfg(unix)]
#[test]
fn a_name_that_would_steer_the_terminal_is_shown_in_letters() {
    let place = Workplace::new();
    place.with_part("fender");
    let name = "a\u{1b}[2J\u{9b}31m\nfender: accepted.pcd";
    fs::copy(place.path("fender.pcd"), place.path(name)).expect("copied");
    let missing = "no\u{1b}]0;title\u{7}.pcd";
    for arguments in [&[name][..], &[name, "fender.pcd", missing]] {
        let ran = place.run(&[&["inspect", "--library", "parts"], arguments].concat());
        let shown = ran.out + &ran.err;
        let is_plain = |c: char| c == '\n' || !c.is_control();
        assert!(shown.chars().all(is_plain), "{shown:?}");
        assert!(
            shown.contains("a\\u001b[2J\\u009b31m\\u000afender"),
            "{shown}"
        );
    }
    let ran = place.run(&["inspect", "--library", "parts", name, "--json"]);
    let line: serde_json::Value = serde_json::from_str(&ran.out).expect("JSON");
    assert_eq!(line["scene"], name);
}
