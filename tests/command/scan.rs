//! Scans: several frames with poses, fused, enrolled and inspected.

use nalgebra::{Matrix4, Vector4};
use serde_json::{Value, json};

use crate::workplace::{Workplace, matrix};

/// A place with a simulated scan of the fender in `frames`.
fn with_scan(shots: &str) -> Workplace {
    let place = Workplace::new();
    simulate(&place, ["fender", "3", "frames", shots]);
    place
}

fn simulate(place: &Workplace, [part, seed, folder, shots]: [&str; 4]) {
    let part = ["--part", part, "--seed", seed];
    place.simulated(&[&part[..], &["--scan", folder, "--shots", shots]].concat());
}

/// Changes the file of the scan's poses.
fn change_poses(place: &Workplace, change: impl FnOnce(&mut Value)) {
    let mut poses = place.json("frames/poses.json");
    change(&mut poses);
    place.write("frames/poses.json", &poses.to_string());
}

fn pose_of<'a>(poses: &'a mut Value, frame: &str) -> &'a mut Value {
    &mut poses["frames"][frame]["world_from_camera"]
}

#[test]
fn a_scan_is_put_together_and_written() {
    let place = with_scan("4");
    let ran = place.accepted(&["scan", "frames", "--out", "all.ply"]);
    assert!(ran.out.contains("frame-04.png"), "{}", ran.out);
    assert!(ran.out.contains("see the part, they agree"), "{}", ran.out);
    let only = [
        "scan",
        "frames",
        "--out",
        "part.ply",
        "--part-only",
        "--json",
    ];
    let line = place.accepted(&only).json();
    let frames = line["frames"].as_array().expect("frames");
    assert!(
        frames.len() == 4 && frames.iter().all(|f| f["used"] == true),
        "{line}"
    );
    let rms = |which: &str| line[which]["rms_m"].as_f64().expect("a number");
    assert!(rms("after") < rms("before"));
    // The frames agree better on the part's place; an error common to all of them remains.
    let truth = place.json("frames/poses.json");
    let pose = |numbers: Vec<f64>| Matrix4::from_row_slice(&numbers);
    let named = |k: usize, which: &str| {
        pose(matrix(
            &truth["frames"][format!("frame-{:02}.png", k + 1)][which],
        ))
    };
    let refined = |k: usize| pose(matrix(&frames[k]["base_from_camera"]));
    let error = |of: &dyn Fn(usize) -> Matrix4<f64>| {
        let seen_at = |k: usize| {
            let inverse = named(k, "true_world_from_camera")
                .try_inverse()
                .expect("rigid");
            of(k) * inverse * Vector4::new(1.9, 0.0, 1.1, 1.0)
        };
        (1..4)
            .map(|k| (seen_at(k) - seen_at(0)).norm())
            .sum::<f64>()
            / 3.0
    };
    let (after, before) = (error(&refined), error(&|k| named(k, "world_from_camera")));
    assert!(after < 0.002 && after < 0.5 * before, "{after} {before}");
    let num_points = line["num_part_points"].as_u64().expect("a number");
    let written = std::fs::read(place.path("part.ply")).expect("written");
    let head = String::from_utf8_lossy(&written[..600]).into_owned();
    for expected in [
        format!("element vertex {num_points}"),
        "comment simulated".into(),
        "property float nx".into(),
        "property uint num_shots".into(),
        "property uint seen_by".into(),
    ] {
        assert!(head.contains(&expected), "{expected}: {head}");
    }
    // The exported cloud can be read again as a cloud.
    place.accepted(&[
        "enrol",
        "part.ply",
        "--name",
        "copy",
        "--whole",
        "--library",
        "parts",
    ]);
}

#[test]
fn a_frame_with_a_wrong_pose_is_named_and_left_out() {
    let place = with_scan("4");
    change_poses(&place, |poses| {
        let pose = pose_of(poses, "frame-03.png");
        pose[3] = json!(pose[3].as_f64().expect("a number") + 0.05);
    });
    let ran = place.coded(1, &["scan", "frames", "--out", "all.ply"]);
    assert!(ran.err.contains("frame-03.png is left out"), "{}", ran.err);
    assert!(ran.err.contains("to do"), "{}", ran.err);
    let line = place
        .coded(1, &["scan", "frames", "--out", "all.ply", "--json"])
        .json();
    let used = |k: usize| line["frames"][k]["used"].as_bool();
    assert_eq!([0, 1, 2, 3].map(used), [true, true, false, true].map(Some));
}

#[test]
fn two_halves_that_contradict_each_other_are_refused_by_every_command_that_takes_a_scan() {
    let place = with_scan("4");
    change_poses(&place, |poses| {
        for frame in ["frame-02.png", "frame-04.png"] {
            let pose = pose_of(poses, frame);
            pose[3] = json!(pose[3].as_f64().expect("a number") + 0.06);
        }
    });
    let scan = ["--scan", "frames"];
    for args in [
        ["scan", "frames", "--out", "all.ply"].to_vec(),
        [&["inspect"], &scan[..]].concat(),
        [&["enrol", "--name", "two", "--library", "parts"], &scan[..]].concat(),
    ] {
        let ran = place.coded(2, &args);
        assert!(
            ran.err.contains("each pose belongs to its frame"),
            "{}",
            ran.err
        );
    }
}

#[test]
fn inverted_poses_are_refused_by_every_command_that_takes_a_scan() {
    let place = with_scan("3");
    change_poses(&place, |poses| {
        let frames = poses["frames"].as_object_mut().expect("frames");
        for entry in frames.values_mut() {
            let pose = &mut entry["world_from_camera"];
            let inverse = Matrix4::from_row_slice(&matrix(pose)).try_inverse();
            // The numbers are stored column by column.
            let numbers = inverse.expect("rigid").transpose();
            *pose = json!(numbers.as_slice());
        }
    });
    let (scan, library) = (["--scan", "frames"], ["--library", "parts"]);
    place.accepted(&[
        "enrol",
        "frames/frame-01.png",
        "--name",
        "one",
        "--library",
        "parts",
    ]);
    for args in [
        ["scan", "frames", "--out", "all.ply"].to_vec(),
        [&["inspect"], &scan[..], &library].concat(),
        [&["enrol", "--name", "two"], &scan[..], &library].concat(),
    ] {
        let ran = place.coded(2, &args);
        assert!(ran.err.contains("the poses look inverted"), "{}", ran.err);
        assert!(ran.err.contains("invert each matrix"), "{}", ran.err);
    }
}

#[test]
fn a_frame_that_is_given_twice_is_refused_as_such() {
    let place = with_scan("2");
    let frame = "frames/frame-01.png";
    let ran = place.coded(2, &["scan", frame, frame, "--out", "all.ply"]);
    assert!(
        ran.err.contains("frame-01.png is given twice"),
        "{}",
        ran.err
    );
    std::fs::create_dir(place.path("other")).expect("made");
    std::fs::copy(place.path(frame), place.path("other/frame-01.png")).expect("copied");
    let ran = place.coded(
        2,
        &["scan", frame, "other/frame-01.png", "--out", "all.ply"],
    );
    assert!(ran.err.contains("have one name"), "{}", ran.err);
}

#[test]
fn a_simulated_scan_is_not_written_among_frames_of_another() {
    let place = with_scan("4");
    let again = [
        "simulate", "--part", "fender", "--scan", "frames", "--shots",
    ];
    let fewer = place.coded(2, &[&again[..], &["3"]].concat());
    assert!(fewer.err.contains("frame-04"), "{}", fewer.err);
    assert!(fewer.err.contains("Give a new folder"), "{}", fewer.err);
    place.accepted(&[&again[..], &["4"]].concat());
    place.accepted(&["scan", "frames", "--out", "all.ply"]);
}

#[test]
fn poses_that_do_not_suffice_are_refused_with_advice() {
    let refused = |place: &Workplace, args: &[&str], expected: &str| {
        let ran = place.coded(2, &[&["scan", "frames"], args].concat());
        assert!(ran.err.contains(expected), "{expected}: {}", ran.err);
        assert!(
            ran.err.contains("to do") || ran.err.contains("--help"),
            "{}",
            ran.err
        );
    };
    let out = ["--out", "all.ply"];
    let place = with_scan("2");
    refused(&place, &["--out", "all.pcd"], "end the name in .ply");
    refused(
        &place,
        &["--out", "all.ply", "--poses", "none.json"],
        "none.json: no such file",
    );
    change_poses(&place, |poses| {
        let pose = pose_of(poses, "frame-02.png");
        pose[0] = json!(3.0);
    });
    refused(&place, &out, "frame-02.png: the matrix is not rigid");
    change_poses(&place, |poses| {
        let frames = poses["frames"].as_object_mut().expect("frames");
        frames.remove("frame-02.png");
    });
    refused(&place, &out, "no pose for frame-02.png (1 of 2 frames)");
    std::fs::remove_file(place.path("frames/frame-02.png")).expect("removed");
    refused(&place, &out, "at least 2 frames, found 1");
    std::fs::remove_file(place.path("frames/poses.json")).expect("removed");
    refused(&place, &out, "no poses");
}

#[test]
fn a_scanned_part_is_enrolled_and_recognised_from_all_frames_together() {
    let place = Workplace::new();
    simulate(&place, ["front_door", "2", "frames", "6"]);
    let enrol = [
        "enrol",
        "--scan",
        "frames",
        "--name",
        "my_door",
        "--library",
        "parts",
    ];
    let ran = place.accepted(&enrol);
    assert!(ran.out.contains("seen from several sides"), "{}", ran.out);
    let toml = place.read("parts/my_door/part.toml");
    for expected in [
        "schema_version = 2",
        "coverage = \"several_sides\"",
        "how = \"scan\"",
        "num_shots = 6",
        "simulated = true",
    ] {
        assert!(toml.contains(expected), "{expected}: {toml}");
    }
    place.accepted(&["library", "verify", "--library", "parts"]);
    // Another scan of the same part in the same place of the cell.
    simulate(&place, ["front_door", "8", "again", "6"]);
    let inspect = ["inspect", "--scan", "again", "--library", "parts", "--json"];
    let line = place.run(&inspect).json();
    assert_eq!(line["part"], "my_door", "{line}");
    assert_eq!(line["scan"]["used"], 6);
    assert_eq!(line["accepted"], true, "{line}");
    // Part space is the camera frame of the first enrolled shot, and the door did not move.
    let found = matrix(&line["scan"]["base_from_part"]);
    let poses = place.json("frames/poses.json");
    let expected = matrix(&poses["frames"]["frame-01.png"]["true_world_from_camera"]);
    for (k, (found, expected)) in found.iter().zip(&expected).enumerate() {
        // The robot's errors in both scans remain, magnified by the distance of 1.4 m.
        assert!(
            (found - expected).abs() < 0.006,
            "number {k}: {found} {expected}"
        );
    }
    assert!(place.run(&inspect[..5]).out.contains("my_door"));
}

#[test]
fn a_recording_keeps_the_poses_of_the_arm() {
    let place = with_scan("3");
    let poses = place.json("frames/poses.json");
    let line = |k: usize| {
        let pose = matrix(&poses["frames"][format!("frame-{:02}.png", k + 1)]["world_from_camera"]);
        pose.iter()
            .map(ToString::to_string)
            .collect::<Vec<_>>()
            .join(" ")
    };
    let lines = [0, 1, 2].map(line).join("\n");
    place.write("poses.csv", &format!("# robot: matrix\n{lines}\n"));
    std::fs::remove_file(place.path("frames/poses.json")).expect("removed");
    let capture = [
        "capture",
        "--source",
        "recording:frames",
        "--robot-poses",
        "poses.csv",
    ];
    place.accepted(&[&capture[..], &["--out", "recorded"]].concat());
    let missing = place.coded(2, &["scan", "recorded", "--out", "a.ply"]);
    assert!(missing.err.contains("no calibration"), "{}", missing.err);
    let identity = "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1";
    let set = [
        "calibrate",
        "set",
        identity,
        "--mount",
        "eye-in-hand",
        "--out",
        "cell.toml",
    ];
    place.accepted(&set);
    let scan = [
        "scan",
        "recorded",
        "--scan-calibration",
        "cell.toml",
        "--out",
        "a.ply",
        "--json",
    ];
    let recorded = place.accepted(&scan).json();
    assert_eq!(recorded["frames"].as_array().map(Vec::len), Some(3));
    assert!(recorded["after"]["rms_m"].as_f64() < recorded["before"]["rms_m"].as_f64());
}

#[test]
fn the_inspection_of_a_scan_is_in_the_history_with_its_shots() {
    let place = with_scan("3");
    place.accepted(&["inspect", "frames/frame-01.png"]);
    place.accepted(&["history", "keep", "all"]);
    let line = place
        .accepted(&["inspect", "--scan", "frames", "--json"])
        .json();
    let rows = place.accepted(&["history", "list", "--json"]).lines();
    assert_eq!((rows.len(), &rows[0]["number"]), (2, &2.into()));
    let shown = ["history", "show", "2", "--again", "--json"];
    let shown = place.accepted(&shown).lines().remove(0);
    assert_eq!(shown["line"], line);
    assert_eq!(shown["shots"].as_array().map(Vec::len), Some(3));
    assert_eq!(shown["again"]["same"], true);
    // A case has a single frame, so a scan cannot become one.
    place.accepted(&["history", "label", "2", "fender"]);
    let err = place
        .coded(2, &["history", "export", "--cases", "cases"])
        .err;
    assert!(err.contains("no inspection could be kept"), "{err}");
    let ran = place.accepted(&["inspect", "--scan", "frames", "--json", "--no-history"]);
    assert_eq!(ran.json()["part"], "fender");
    assert_eq!(
        place.accepted(&["history", "list", "--json"]).lines().len(),
        2
    );
}

#[test]
fn a_calibration_that_cannot_be_read_is_an_error_of_a_scan_that_needs_it_and_of_no_other() {
    let place = with_scan("3");
    std::fs::create_dir_all(place.path("data/partsight")).expect("made");
    place.write("data/partsight/cell.toml", "schema_version = 1\nmount = \n");
    place.accepted(&["scan", "frames", "--out", "fused.ply"]);
    change_poses(&place, |poses| {
        let frames = poses["frames"].as_object_mut().expect("frames");
        for pose in frames.values_mut() {
            let numbers = pose["world_from_camera"].take();
            *pose = json!({ "base_from_flange": numbers });
        }
    });
    let ran = place.coded(2, &["scan", "frames", "--out", "fused.ply"]);
    assert!(
        ran.err.contains("cell.toml: not a calibration: line 2"),
        "{}",
        ran.err
    );
    assert!(ran.err.contains("to do: Correct the file"), "{}", ran.err);
    std::fs::remove_file(place.path("data/partsight/cell.toml")).expect("there");
    let ran = place.coded(2, &["scan", "frames", "--out", "fused.ply"]);
    assert!(ran.err.contains("no calibration says where"), "{}", ran.err);
}
