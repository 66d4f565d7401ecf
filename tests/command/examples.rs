//! The examples run and find what their texts say.

use std::{path::PathBuf, process::Command};

/// Runs an example, which `cargo test` builds beside the tests, and returns its output.
fn output_of(example: &str) -> String {
    let own = std::env::current_exe().expect("the path of this test");
    let built = own.ancestors().nth(2).expect("target/PROFILE/deps/TEST");
    let program: PathBuf = built.join("examples").join(example);
    let program = program.with_extension(std::env::consts::EXE_EXTENSION);
    let output = Command::new(&program)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap_or_else(|error| panic!("{}: {error}; cargo build --examples", program.display()));
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{example}: {errors}");
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn a_frame_is_inspected() {
    let words = output_of("inspect");
    assert!(
        words.contains("fender") && words.contains("accepted"),
        "{words}"
    );
    assert!(!words.contains("not accepted"), "{words}");
    assert!(words.contains("camera_from_part"), "{words}");
}

#[test]
fn an_enrolled_part_is_recognised_in_another_capture() {
    let words = output_of("enrol");
    assert!(
        words.contains("part: \"door_right\"") && words.contains("rejected: None"),
        "{words}"
    );
}

#[test]
fn clouds_that_share_no_point_are_aligned() {
    let words = output_of("align");
    let rms: f64 = words
        .split_whitespace()
        .next()
        .and_then(|number| number.parse().ok())
        .expect("millimetres first");
    assert!(rms < 5.0, "{words}");
    assert!(!words.contains("warning"), "{words}");
}

#[test]
fn a_source_is_followed() {
    let words = output_of("follow");
    assert_eq!(words.matches("rejected: None").count(), 3, "{words}");
}
