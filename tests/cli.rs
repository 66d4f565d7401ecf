//! The command line from end to end: the built program, run in folders of its own.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
};

use serde_json::Value;

/// A folder to work in, with a library at `parts`, and a data folder of its own.
struct Workplace {
    folder: tempfile::TempDir,
}

impl Workplace {
    fn new() -> Self {
        Self {
            folder: tempfile::tempdir().expect("a folder"),
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_partsight"));
        command
            .args(args)
            .current_dir(self.folder.path())
            // Also on a desktop: these tests read the terminal.
            .env_remove("DISPLAY")
            .env_remove("WAYLAND_DISPLAY")
            .env("XDG_DATA_HOME", self.path("data"))
            .env("HOME", self.folder.path());
        command
    }

    fn run(&self, args: &[&str]) -> Ran {
        Ran::from(self.command(args).output().expect("starts"))
    }

    /// Runs what must succeed.
    fn accepted(&self, args: &[&str]) -> Ran {
        let ran = self.run(args);
        assert_eq!(ran.code, 0, "{args:?}\n{}\n{}", ran.out, ran.err);
        ran
    }

    /// Enrols a simulated part into `parts` and leaves another capture of it in `NAME.pcd`.
    fn with_part(&self, name: &str) {
        let reference = format!("{name}-reference.pcd");
        self.accepted(&[
            "simulate",
            "--part",
            name,
            "--pose",
            "0 0 0 0 0 1.4",
            "--out",
            &reference,
        ]);
        self.accepted(&[
            "enrol",
            &reference,
            "--name",
            name,
            "--library",
            "parts",
            "--simulated",
        ]);
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
        self.accepted(&[&simulate[..], &["--out", &capture]].concat());
    }
}

struct Ran {
    code: i32,
    out: String,
    err: String,
}

impl From<Output> for Ran {
    fn from(output: Output) -> Self {
        Self {
            code: output.status.code().expect("ended by itself"),
            out: String::from_utf8(output.stdout).expect("text"),
            err: String::from_utf8(output.stderr).expect("text"),
        }
    }
}

impl Ran {
    /// Every line of the output as JSON.
    fn lines(&self) -> Vec<Value> {
        let parse = |line| serde_json::from_str(line).expect("a line of JSON");
        self.out.lines().map(parse).collect()
    }
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
    place.with_part("fender");
    place.with_part("grille");
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
    place.with_part("front_door");
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
    let model = matrix(&truth["camera_from_part"]);
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
    place.with_part("fender");
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
    place.with_part("grille");
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
    assert_eq!(lines[1]["status"], "ok");
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
fn the_paper_can_be_chosen_and_the_pose_left_out() {
    let place = Workplace::new();
    place.with_part("fender");
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
    place.with_part("fender");
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
    let written = ["fender.json", "fender-2.json", "missing.json"]
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
    place.with_part("fender");
    place.with_part("grille");
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
    place.with_part("fender");
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
    assert!(place.accepted(&started).out.contains("mm rms"));
}

#[test]
fn a_mesh_is_enrolled_but_is_no_scene() {
    let place = Workplace::new();
    place.with_part("fender");
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
    assert!(fs::read_dir(place.folder.path()).expect("listed").all(|f| {
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
        help.contains("Exit codes") && !help.contains("icp-ga"),
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
