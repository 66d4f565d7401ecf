//! Enrolling parts, inspecting scenes, keeping the library.

use std::{fs, path::Path, process::Stdio};

use serde_json::Value;

use crate::workplace::{Ran, Workplace};

/// Enrols a simulated part into `parts` and leaves another capture of it in `NAME.pcd`.
fn with_part(place: &Workplace, name: &str) {
    let reference = format!("{name}-reference.pcd");
    place.accepted(&[
        "simulate",
        "--part",
        name,
        "--pose",
        "0 0 0 0 0 1.4",
        "--out",
        &reference,
    ]);
    place.accepted(&["enrol", &reference, "--name", name, "--library", "parts"]);
    let capture = format!("{name}.pcd");
    let simulate = [
        "simulate",
        "--part",
        name,
        "--placement",
        "facing",
        "--seed",
        "5",
    ];
    place.accepted(&[&simulate[..], &["--out", &capture]].concat());
}

fn matrix(value: &Value) -> Vec<f64> {
    let numbers = value.as_array().expect("16 numbers");
    numbers
        .iter()
        .map(|n| n.as_f64().expect("a number"))
        .collect()
}

#[test]
fn a_simulated_part_is_enrolled_and_recognised_again() {
    let place = Workplace::new();
    with_part(&place, "fender");
    with_part(&place, "grille");
    let ran = place.accepted(&[
        "inspect",
        "grille.pcd",
        "fender.pcd",
        "--json",
        "--library",
        "parts",
    ]);
    let lines = ran.lines();
    let parts: Vec<_> = lines
        .iter()
        .map(|l| l["part"].as_str().expect("a part"))
        .collect();
    assert_eq!(parts, ["grille", "fender"]);
    for line in &lines {
        assert_eq!(line["schema"], 1);
        assert_eq!(line["status"], "ok");
        assert_eq!(line["simulated"], true);
        assert_eq!(line["accepted"], true);
        assert_eq!(line["reason"], Value::Null);
        assert_eq!(line["ranking"].as_array().expect("a list").len(), 2);
        assert!(line["timings_ms"]["total"].as_f64().expect("a time") > 0.0);
        assert_eq!(
            matrix(&line["pose"]["camera_from_part"])[12..],
            [0.0, 0.0, 0.0, 1.0]
        );
    }
    assert_eq!(ran.err, "");
}

#[test]
fn the_pose_is_that_of_the_simulation() {
    let place = Workplace::new();
    with_part(&place, "front_door");
    let moved = [
        "simulate",
        "--part",
        "front_door",
        "--pose",
        "5deg -10deg 20deg 40mm -30mm 1600mm",
    ];
    place.accepted(&[&moved[..], &["--out", "moved.png", "--truth", "truth.json"]].concat());
    let line = &place
        .accepted(&["inspect", "moved.png", "--json", "--library", "parts"])
        .lines()[0];
    let found = matrix(&line["pose"]["camera_from_part"]);
    let truth: Value =
        serde_json::from_slice(&fs::read(place.path("truth.json")).expect("written"))
            .expect("JSON");
    // Part space is that of the enrolment, 1.4 m before the camera: the truth's of the model, in its middle.
    let model = matrix(&truth["camera_from_model"]);
    for row in 0..3 {
        let [c, d] = [2, 3].map(|column| found[row * 4 + column]);
        for column in 0..3 {
            let difference = (found[row * 4 + column] - model[row * 4 + column]).abs();
            assert!(
                difference < 0.02,
                "the turn is off by {difference} in row {row}"
            );
        }
        let difference = (c * 1.4 + d - model[row * 4 + 3]).abs();
        assert!(
            difference < 0.01,
            "the middle is off by {difference} m in row {row}"
        );
    }
}

#[test]
fn one_bad_file_does_not_stop_the_others() {
    let place = Workplace::new();
    with_part(&place, "fender");
    fs::write(place.path("bad.pcd"), "VERSION 0.7\nnothing").expect("written");
    let files = ["bad.pcd", "fender.pcd", "missing.pcd"];
    let ran = place.run(&[&["inspect", "--json", "--library", "parts"], &files[..]].concat());
    assert_eq!(ran.code, 2);
    let lines = ran.lines();
    let of = |key: &str| lines.iter().map(|l| l[key].clone()).collect::<Vec<_>>();
    assert_eq!(of("scene"), files);
    assert_eq!(of("status"), ["unreadable", "ok", "unreadable"]);
    assert_eq!(of("accepted"), [false, true, false]);
    assert!(
        lines[0]["reason"]
            .as_str()
            .expect("words")
            .contains("bad.pcd")
    );
    assert!(ran.err.contains("to do:"), "{}", ran.err);

    let rows = place.run(&[&["inspect", "--library", "parts"], &files[..]].concat());
    assert_eq!(rows.code, 2);
    assert!(
        rows.out.contains("unreadable") && rows.out.contains("accepted"),
        "{}",
        rows.out
    );
}

#[test]
fn an_empty_cell_and_an_unknown_part_are_not_accepted() {
    let place = Workplace::new();
    with_part(&place, "grille");
    // Far too high: only wall and floor are left in the picture.
    let away = [
        "simulate",
        "--part",
        "grille",
        "--pose",
        "0 0 0 0 -5 1.4",
        "--out",
        "empty.pcd",
    ];
    place.accepted(&away);
    let other = [
        "simulate",
        "--part",
        "front_door",
        "--placement",
        "facing",
        "--out",
        "other.pcd",
    ];
    place.accepted(&other);
    let ran = place.run(&[
        "inspect",
        "empty.pcd",
        "other.pcd",
        "--json",
        "--library",
        "parts",
    ]);
    assert_eq!(ran.code, 1, "{}", ran.err);
    let lines = ran.lines();
    assert_eq!(lines[0]["status"], "no_part");
    assert_eq!(lines[0]["part"], Value::Null);
    assert_eq!(lines[1]["status"], "unknown");
    assert_eq!(lines[1]["part"], Value::Null);
    for line in lines {
        assert_eq!(line["accepted"], false);
        assert!(line["reason"].is_string());
    }
    let card = place.run(&["inspect", "other.pcd", "--library", "parts"]);
    assert!(
        card.out.contains("why not") && card.out.contains("to do"),
        "{}",
        card.out
    );
}

#[test]
fn what_stands_in_the_empty_cell_is_no_part_and_a_second_reference_names_its_part() {
    let place = Workplace::new();
    with_part(&place, "fender");
    let seen = |name: &'static str, options: &[&'static str]| {
        let simulate = [
            "simulate",
            "--part",
            "fender",
            "--placement",
            "facing",
            "--out",
            name,
        ];
        place.accepted(&[&simulate, options].concat());
    };
    seen("scene.pcd", &["--seed", "8"]);
    // Known to the cell as it hangs there, the fender is furniture.
    let inspect = ["inspect", "scene.pcd", "--json", "--library", "parts"];
    let empty = place.run(&[&inspect[..], &["--empty-cell", "scene.pcd"]].concat());
    assert_eq!(empty.code, 1, "{}", empty.err);
    assert_eq!(empty.lines()[0]["status"], "no_part");
    seen("other_make.pcd", &["--model", "5"]);
    let enrol = [
        "enrol",
        "other_make.pcd",
        "--name",
        "fender_b",
        "--as",
        "fender",
    ];
    place.accepted(&[&enrol[..], &["--library", "parts"]].concat());
    seen("other_scene.pcd", &["--model", "5", "--seed", "9"]);
    let line = place
        .run(&["inspect", "other_scene.pcd", "--json", "--library", "parts"])
        .lines()
        .remove(0);
    assert_eq!(
        (&line["part"], &line["accepted"]),
        (&"fender".into(), &true.into())
    );
    assert_eq!(line["ranking"].as_array().map(Vec::len), Some(1));
}

#[test]
fn the_paper_can_be_chosen_and_the_pose_left_out() {
    let place = Workplace::new();
    with_part(&place, "fender");
    let inspect = [
        "inspect",
        "fender-reference.pcd",
        "--json",
        "--library",
        "parts",
    ];
    let line = |more: &[&str]| place.run(&[&inspect[..], more].concat()).lines().remove(0);
    let icp = line(&["--matcher", "paper", "--pose", "icp"]);
    assert_eq!(
        (&icp["part"], &icp["pose"]["method"]),
        (&"fender".into(), &"icp".into())
    );
    assert_eq!(line(&["--pose", "none"])["pose"], Value::Null);
}

#[test]
fn a_report_holds_the_line_and_a_picture_of_every_stage() {
    let place = Workplace::new();
    with_part(&place, "fender");
    fs::create_dir(place.path("again")).expect("made");
    fs::copy(place.path("fender.pcd"), place.path("again/fender.pcd")).expect("copied");
    let files = ["fender.pcd", "again/fender.pcd", "missing.pcd"];
    let inspect = [
        "inspect",
        "--json",
        "--library",
        "parts",
        "--report",
        "why/deep",
    ];
    let ran = place.run(&[&inspect[..], &files].concat());
    assert_eq!(ran.code, 2);
    let read = |name: &str| fs::read_to_string(place.path("why/deep").join(name)).expect("there");
    let written = [
        "fender.report.json",
        "fender-2.report.json",
        "missing.report.json",
    ]
    .map(read)
    .concat();
    assert_eq!(written, ran.out);
    for stage in ["segmentation", "binary", "contour", "signature"] {
        let picture = place.path("why/deep").join(format!("fender.{stage}.png"));
        assert!(image::open(picture).is_ok(), "{stage}");
    }
    let nowhere = [
        "inspect",
        "fender.pcd",
        "--library",
        "parts",
        "--report",
        "fender.pcd",
    ];
    assert_eq!(place.run(&nowhere).code, 2);
}

#[test]
fn a_library_is_listed_shown_verified_and_cleared() {
    let place = Workplace::new();
    with_part(&place, "fender");
    with_part(&place, "grille");
    let library = |args: &[&str]| place.run(&[&["library", "--library", "parts"], args].concat());
    let list = library(&["list"]);
    assert!(
        list.out.contains("fender") && list.out.contains("grille"),
        "{}",
        list.out
    );
    let show = library(&["show", "fender"]);
    assert!(show.out.contains("fender-reference.pcd") && show.out.contains("simulated"));
    assert_eq!(library(&["verify"]).code, 0);

    let cloud = place.path("parts/fender/cloud.ply");
    let bytes = fs::read(&cloud).expect("there");
    fs::write(&cloud, &bytes[..bytes.len() / 2]).expect("written");
    let verify = library(&["verify"]);
    assert_eq!(verify.code, 1);
    assert!(
        verify.out.contains("DAMAGED  fender: cloud.ply"),
        "{}",
        verify.out
    );
    assert!(verify.out.contains("sound    grille"), "{}", verify.out);
    let ran = place.accepted(&["inspect", "grille.pcd", "--json", "--library", "parts"]);
    assert!(ran.err.contains("set aside fender"), "{}", ran.err);

    let removed = library(&["remove", "fender"]);
    assert_eq!(removed.code, 0);
    assert!(removed.out.contains(".trash"), "{}", removed.out);
    assert!(!place.path("parts/fender").exists());
    let again = library(&["remove", "fender"]);
    assert_eq!(again.code, 2);
    assert!(again.err.contains("no part named fender"), "{}", again.err);

    assert_eq!(library(&["restore", "fender"]).code, 0);
    assert!(place.path("parts/fender/cloud.ply").exists());
    let nothing = library(&["restore", "hood"]);
    assert_eq!(nothing.code, 2);
    assert!(nothing.err.contains(".trash"), "{}", nothing.err);
    let to = ["--to", "spare_grille", "--title", "Grille, spare"];
    let renamed = library(&[&["rename", "grille"][..], &to].concat());
    assert_eq!(renamed.code, 0, "{}", renamed.err);
    let shown = library(&["show", "spare_grille"]);
    assert!(shown.out.contains("Grille, spare"), "{}", shown.out);
    let taken = library(&["rename", "spare_grille", "--to", "fender"]);
    assert_eq!(taken.code, 2);
    assert!(taken.err.contains("already"), "{}", taken.err);
}

#[test]
fn without_a_library_the_shipped_parts_are_there() {
    let place = Workplace::new();
    let list = place.accepted(&["library", "list"]);
    assert!(list.out.contains("8 parts"), "{}{}", list.out, list.err);
    let first = place.accepted(&[]);
    assert!(
        first.out.contains("Simulated") && first.out.contains("front_door: accepted"),
        "{}",
        first.out
    );
    // A folder here goes before the user's own.
    fs::create_dir(place.path("reference_parts")).expect("made");
    let list = place.accepted(&["library", "list"]);
    assert!(list.out.contains("0 parts"), "{}", list.out);
    assert_eq!(place.run(&["inspect", "x.pcd"]).code, 2);
}

#[test]
fn a_cloud_is_aligned_with_itself_moved() {
    let place = Workplace::new();
    with_part(&place, "fender");
    let cloud = place.path("parts/fender/cloud.ply");
    let partsight::files::Opened::Cloud(target) = partsight::files::open(&cloud).expect("a cloud")
    else {
        panic!("a cloud");
    };
    let target_from_source =
        partsight::geometry::rigid::from_euler_zyx([0.1, -0.2, 0.4, 0.05, 0.02, -0.1]);
    let source_from_target = target_from_source.inverse().cast::<f32>();
    let source = partsight::geometry::cloud::PointCloud::from_points(
        target.points.iter().map(|p| source_from_target * p),
    );
    partsight::files::save_cloud(&place.path("moved.ply"), &source).expect("written");
    let target = cloud.display().to_string();
    let ran = place.accepted(&["align", "moved.ply", &target, "--json"]);
    let line = &ran.lines()[0];
    let expected = partsight::geometry::rigid::row_major(&target_from_source);
    for (found, expected) in matrix(&line["target_from_source"]).iter().zip(expected) {
        assert!(
            (found - expected).abs() < 1e-3,
            "{found} instead of {expected}"
        );
    }
    assert_eq!(
        (&line["method"], &line["schema"]),
        (&"global".into(), &1.into())
    );
    let started = [
        "align",
        "moved.ply",
        &target,
        "--pose",
        "icp",
        "--initial",
        "5deg -11deg 22deg 50mm 20mm -100mm",
    ];
    // The nearest valley of E is some centimetres off, and nothing holds the fender there: that is said.
    let slid = place.run(&started);
    assert_eq!(slid.code, 1);
    assert!(slid.out.contains("mm rms") && slid.err.contains("slide"));
    let by_icp_ga = ["align", "moved.ply", &target, "--pose", "icp-ga", "--json"];
    let line = &place.accepted(&by_icp_ga).lines()[0];
    assert_eq!(
        (&line["method"], &line["stopped"]),
        (&"icp-ga".into(), &"below_target".into())
    );
    assert!(line["e_m2"].as_f64().expect("a number") < 1e-6, "{line}");
}

#[test]
fn table_1_is_shown_and_written_for_the_parts_asked_for() {
    let place = Workplace::new();
    let ran = place.accepted(&[
        "bench", "table1", "--part", "grille", "--json", "t.json", "--csv", "t.csv",
    ]);
    assert!(ran.out.contains("icp-ga  5/5"), "{}", ran.out);
    let text = fs::read_to_string(place.path("t.json")).expect("written");
    let file: Value = serde_json::from_str(&text).expect("JSON");
    let attempts = file["attempts"].as_array().expect("a list");
    assert_eq!(attempts.len(), 15);
    for attempt in attempts.iter().filter(|a| a["method"] != "icp") {
        assert!(
            attempt["e_m2"].as_f64().expect("a number") < 1e-6,
            "{attempt}"
        );
        assert_eq!(attempt["part"], "grille");
    }
    let rows = fs::read_to_string(place.path("t.csv")).expect("written");
    assert_eq!(rows.lines().count(), 16);
    let unknown = place.run(&["bench", "table1", "--part", "wing"]);
    assert_eq!(unknown.code, 2);
    assert!(unknown.err.contains("no part wing"), "{}", unknown.err);
}

#[test]
fn a_part_that_runs_out_of_the_picture_is_found_and_that_is_said() {
    let place = Workplace::new();
    with_part(&place, "front_door");
    for (x, is_cut) in [("0", false), ("600mm", true)] {
        let pose = format!("0 0 0 {x} 0 1500mm");
        let door = ["simulate", "--part", "front_door", "--out", "door.pcd"];
        place.accepted(&[&door[..], &["--pose", &pose]].concat());
        let ran = place.run(&["inspect", "door.pcd", "--json", "--library", "parts"]);
        let line = &ran.lines()[0];
        assert_eq!(line["touches_edge"], is_cut, "{line}");
        assert_eq!(line["part"], "front_door", "{line}");
        let card = place.run(&["inspect", "door.pcd", "--library", "parts"]);
        let is_said = card.out.contains("reaches the picture's edge");
        assert_eq!(is_said, is_cut, "{}", card.out);
    }
}

#[test]
fn recognition_is_measured_beside_the_other_systems_and_its_worst_confusions_are_drawn() {
    let place = Workplace::new();
    let ran = place.accepted(&[
        "bench",
        "recognition",
        "--suite",
        "standard",
        "--poses",
        "1",
        "--json",
        "r.json",
        "--pictures",
        "why",
    ]);
    for said in [
        "standard",
        "SHOT",
        "paper's sources for its four are not known",
    ] {
        assert!(ran.out.contains(said), "{said}: {}", ran.out);
    }
    let text = fs::read_to_string(place.path("r.json")).expect("written");
    let file: Value = serde_json::from_str(&text).expect("JSON");
    let list = |value: &Value| value.as_array().expect("a list").len();
    assert_eq!(list(&file["suites"][0]["cases"]), 8);
    assert_eq!(list(&file["table1"]["frames"]), 8);
    let systems = file["table1"]["systems"].as_array().expect("a list");
    let names: Vec<&str> = systems
        .iter()
        .filter_map(|s| s["system"].as_str())
        .collect();
    let known = [
        "paper",
        "rank",
        "confirmed",
        "vfh",
        "spin_images",
        "fpfh",
        "shot",
    ];
    assert_eq!(names, known);
    for system in systems {
        assert!(system["median_ms"].as_f64().is_some_and(|ms| ms > 0.0));
        assert_eq!(system["by_suite"][0]["num_frames"], 8);
    }
    assert_eq!(list(&file["closest"]), 8);
    let drawn = fs::read_dir(place.path("why")).expect("a folder");
    let drawn = drawn.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let num_contenders = drawn.filter(|name| name.ends_with(".contenders.png"));
    assert_eq!(num_contenders.count(), 8);

    let gone = place.run(&["bench", "speed", "--only-ours"]);
    assert_eq!(gone.code, 2);
    assert!(gone.err.contains("go with recognition"), "{}", gone.err);
}

#[test]
fn a_mesh_is_enrolled_but_is_no_scene() {
    let place = Workplace::new();
    with_part(&place, "fender");
    let obj = "v 0 0 0\nv 1 0 0\nv 1 0.6 0\nv 0 0.4 0\nf 1 2 3\nf 1 3 4\n";
    fs::write(place.path("plate.obj"), obj).expect("written");
    let enrolled = place.accepted(&[
        "enrol",
        "plate.obj",
        "--name",
        "plate",
        "--library",
        "parts",
    ]);
    assert!(enrolled.out.contains("from a mesh"), "{}", enrolled.out);
    let ran = place.run(&["inspect", "plate.obj", "--library", "parts"]);
    assert_eq!(ran.code, 2);
    assert!(ran.err.contains("partsight enrol"), "{}", ran.err);
    let segment = [
        "enrol",
        "plate.obj",
        "--name",
        "p",
        "--library",
        "parts",
        "--segment",
    ];
    assert_eq!(place.run(&segment).code, 2);
}

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
    with_part(&place, "fender");
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
fn a_report_beside_its_captures_leaves_them_as_they_were() {
    let place = Workplace::new();
    with_part(&place, "fender");
    fs::create_dir(place.path("cap")).expect("made");
    // The second and third are captures by whose names a report of the first would write.
    let files = ["cap/g1.png", "cap/g1.contour.png", "cap/g1.report.png"];
    for file in files {
        place.accepted(&["simulate", "--part", "fender", "--out", file]);
    }
    let contents = || {
        let json = files.map(|f| f.replace(".png", ".json"));
        let all = files.iter().map(|f| (*f).to_owned()).chain(json);
        all.map(|f| fs::read(place.path(&f)).expect("there"))
            .collect::<Vec<_>>()
    };
    let before = contents();
    let inspect = ["inspect", "--library", "parts", "--report", "cap"];
    for _ in 0..2 {
        place.run(&[&inspect[..], &files].concat());
        assert!(contents() == before, "a capture was overwritten");
    }
    assert!(place.path("cap/g1.contour.report.json").exists());
    let num_files = fs::read_dir(place.path("cap")).expect("listed").count();
    place.run(&[&inspect[..], &files].concat());
    let again = fs::read_dir(place.path("cap")).expect("listed").count();
    assert_eq!(num_files, again, "an earlier report is replaced");
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
fn a_damaged_cloud_is_set_aside_by_its_checksum() {
    let place = Workplace::new();
    with_part(&place, "fender");
    with_part(&place, "grille");
    let cloud = place.path("parts/fender/cloud.ply");
    let mut bytes = fs::read(&cloud).expect("there");
    let middle = bytes.len() / 2;
    for byte in &mut bytes[middle..middle + 4] {
        *byte ^= 0x10;
    }
    fs::write(&cloud, bytes).expect("written");
    let ran = place.accepted(&["inspect", "grille.pcd", "--library", "parts"]);
    assert!(
        ran.err.contains("set aside fender: cloud.ply is damaged") && ran.err.contains("to do"),
        "{}",
        ran.err
    );
    let verify = place.run(&["library", "verify", "--library", "parts"]);
    assert_eq!(verify.code, 1);
    assert!(
        verify.out.contains("DAMAGED  fender: cloud.ply"),
        "{}",
        verify.out
    );
}

#[test]
fn the_shipped_parts_are_sound() {
    let shipped = concat!(env!("CARGO_MANIFEST_DIR"), "/reference_parts");
    let verify = Workplace::new().accepted(&["library", "verify", "--library", shipped]);
    assert_eq!(verify.out.matches("sound ").count(), 8, "{}", verify.out);
}

#[test]
fn without_a_writable_data_folder_the_shipped_parts_are_used_from_the_program() {
    let place = Workplace::new();
    fs::write(place.path("data"), "a file where the data folder should be").expect("written");
    let list = place.accepted(&["library", "list"]);
    assert!(
        list.out.contains("inside the program") && list.out.contains("8 parts"),
        "{}",
        list.out
    );
    assert!(
        list.err.contains("warning") && list.err.contains("to do"),
        "{}",
        list.err
    );
    assert!(place.accepted(&[]).out.contains("front_door: accepted"));
    place.accepted(&["library", "show", "fender"]);
    place.accepted(&["library", "verify"]);
    place.accepted(&[
        "simulate",
        "--part",
        "fender",
        "--placement",
        "facing",
        "--out",
        "f.pcd",
    ]);
    let line = &place.accepted(&["inspect", "f.pcd", "--json"]).lines()[0];
    assert_eq!(line["part"], "fender");
    for change in [
        &["enrol", "f.pcd", "--name", "mine"][..],
        &["library", "remove", "fender"],
    ] {
        let ran = place.run(change);
        assert_eq!(ran.code, 2, "{change:?}");
        assert!(
            ran.err.contains("cannot write") && ran.err.contains("--library"),
            "{}",
            ran.err
        );
    }
}

#[test]
fn a_part_enrolled_twice_is_told_from_itself_by_nobody_and_said_so() {
    let place = Workplace::new();
    with_part(&place, "grille");
    let enrol = |file: &str, name: &str| {
        place.accepted(&["enrol", file, "--name", name, "--library", "parts"])
    };
    place.accepted(&[
        "simulate",
        "--part",
        "fender",
        "--placement",
        "facing",
        "--out",
        "f.pcd",
    ]);
    let first = enrol("f.pcd", "wing");
    assert_eq!(first.err, "", "a fender is no grille");
    assert_eq!(
        enrol("f.pcd", "wing").err,
        "",
        "what it replaces does not count"
    );
    let again = enrol("f.pcd", "copy");
    assert!(
        again.err.contains("copy cannot be told from wing"),
        "{}",
        again.err
    );
    assert!(again.err.contains("--name wing"), "{}", again.err);
    let other = enrol("grille.pcd", "grille_again");
    assert!(
        other
            .err
            .contains("grille_again cannot be told from grille"),
        "{}",
        other.err
    );
}

#[test]
fn an_empty_library_is_one_error_and_no_line() {
    let place = Workplace::new();
    with_part(&place, "fender");
    fs::create_dir(place.path("empty")).expect("made");
    let ran = place.run(&[
        "inspect",
        "fender.pcd",
        "fender.pcd",
        "--json",
        "--library",
        "empty",
    ]);
    assert_eq!((ran.code, ran.out.as_str()), (2, ""));
    assert!(
        ran.err.contains("no part to recognise") && ran.err.contains("to do"),
        "{}",
        ran.err
    );
    assert_eq!(ran.err.lines().count(), 2, "{}", ran.err);
    let inside = ["parts/fender", "."].map(|dir| {
        let list = place.run(&["library", "list", "--library", dir]);
        assert_eq!(list.code, 0);
        list.err
    });
    assert!(
        inside[0].contains("is a part, not a library"),
        "{}",
        inside[0]
    );
    let bare = place.accepted(&["--library", "parts"]);
    assert!(bare.out.contains("Simulated"), "{}", bare.out);
    assert_eq!(
        place.run(&["--library", "parts", "library", "list"]).code,
        2
    );
}

#[test]
fn verify_tells_newer_from_damaged_and_names_what_it_skipped() {
    let place = Workplace::new();
    with_part(&place, "fender");
    fs::create_dir(place.path("parts/next")).expect("made");
    fs::write(place.path("parts/next/part.toml"), "schema_version = 9\n").expect("written");
    fs::create_dir(place.path("parts/My Door")).expect("made");
    let verify = place.run(&["library", "verify", "--library", "parts"]);
    assert_eq!(verify.code, 1);
    assert!(
        verify.out.contains("NEWER    next: made by a newer"),
        "{}",
        verify.out
    );
    assert!(verify.out.contains("skipped  My Door"), "{}", verify.out);
    assert!(!verify.out.contains("DAMAGED"), "{}", verify.out);
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
fn a_pose_that_is_not_found_is_a_line_with_its_reason_and_names_the_file() {
    let place = Workplace::new();
    with_part(&place, "fender");
    fs::write(place.path("few.xyz"), "0 0 1\n1 0 1\n0 1 1\n").expect("written");
    let ran = place.run(&["align", "few.xyz", "parts/fender/cloud.ply", "--json"]);
    assert_eq!(ran.code, 1, "{}", ran.err);
    let line = &ran.lines()[0];
    assert_eq!(line["target_from_source"], Value::Null);
    assert!(line["reason"].as_str().expect("words").contains("3 points"));
    assert!(
        ran.err.contains("few.xyz: ") && !ran.err.contains("cloud.ply: "),
        "{}",
        ran.err
    );
    let enrol = place.run(&["enrol", "few.xyz", "--name", "few", "--library", "parts"]);
    assert!(
        enrol.err.contains("few.xyz: the cloud has 3 points"),
        "{}",
        enrol.err
    );
    let title = "t".repeat(81);
    let long = ["enrol", "few.xyz", "--name", "few", "--title", &title];
    assert!(place.run(&long).err.contains("at most 80"));
}

#[test]
fn causes_are_said_once_in_words_with_advice_that_fits() {
    let place = Workplace::new();
    with_part(&place, "fender");
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
