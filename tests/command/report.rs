//! `partsight report`.

use std::{
    collections::BTreeSet,
    fs,
    path::Path,
    process::Command,
    time::{Duration, SystemTime},
};

use crate::{
    kit::csv_column,
    workplace::{Ran, Workplace},
};

fn capture(place: &Workplace, part: &str, side: &str, out: &str) {
    let placed = ["--placement", "facing", "--seed", "5", "--out", out];
    place.simulated(&[&["--part", part, "--side", side], &placed[..]].concat());
}

/// The selectable text of the page; `None` if the program that reads it is missing.
#[expect(clippy::print_stderr, reason = "a test that skips must say why")]
fn page_text(path: &Path) -> Option<String> {
    let ran = Command::new("pdftotext")
        .arg("-layout")
        .arg(path)
        .arg("-")
        .output();
    let Ok(ran) = ran else {
        eprintln!("skipped: no pdftotext");
        return None;
    };
    assert!(
        ran.status.success(),
        "{}",
        String::from_utf8_lossy(&ran.stderr)
    );
    Some(String::from_utf8_lossy(&ran.stdout).into_owned())
}

#[test]
fn whoever_unpacks_a_problem_report_sees_the_same() {
    let place = Workplace::new();
    capture(&place, "fender", "left", "fender.pcd");
    let report = ["report", "fender.pcd", "--out", "out", "--format"];
    place.accepted(&[&report[..], &["problem", "--set", "accept.min_score=0.55"]].concat());
    let archive = fs::read(place.path("out/fender.problem.zip")).expect("written");
    for (name, content) in files::read_zip(&archive) {
        let path = place.path("unpacked").join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        fs::write(path, content).expect("written");
    }
    let read_me = place.read("unpacked/read-me.txt");
    let mut commands = read_me
        .lines()
        .filter_map(|line| line.trim().strip_prefix("partsight "));
    let command: Vec<&str> = commands.next().expect("a command").split(' ').collect();
    let mut command = place.command(&[&command[..], &["--json"]].concat());
    let again = command.current_dir(place.path("unpacked")).output();
    let again: Ran = again.expect("starts").into();
    assert_eq!(again.code, 0, "{}", again.err);
    let again: serde_json::Value = serde_json::from_str(&again.out).expect("JSON");
    let before = place.json("unpacked/inspection.json");
    for key in ["part", "accepted"] {
        assert_eq!(again[key], before[key], "{key}");
    }
    assert_eq!(again["recipe"]["identity"], before["recipe"]["identity"]);
    assert_eq!(again["part"], "fender");
}

#[test]
fn each_of_several_parts_has_a_report() {
    let place = Workplace::new();
    let rack = ["--rack", "3", "--rack-kind", "apart", "--seed", "4"];
    place.simulated(&[&rack[..], &["--out", "rack.png"]].concat());
    let report = ["report", "rack.png", "--format", "json,csv", "--out"];
    let ran = place.accepted(&[&report[..], &["all", "--set", "segment.max_parts=3"]].concat());
    assert_eq!(ran.out.lines().count(), 3, "{}", ran.out);
    let parts = (1..=3).map(|number| {
        let text = fs::read_to_string(place.path(format!("all/rack_{number}.pose.json")));
        let report: serde_json::Value =
            serde_json::from_str(&text.expect("written")).expect("JSON");
        report["verdict"]["part"]
            .as_str()
            .expect("a name")
            .to_owned()
    });
    let parts: BTreeSet<String> = parts.collect();
    assert_eq!(parts.len(), 3, "{parts:?}");
    let rows = fs::read_dir(place.path("all")).expect("a folder").flatten();
    let csv = rows
        .map(|file| file.path())
        .find(|path| path.extension() == Some("csv".as_ref()));
    let rows = fs::read_to_string(csv.expect("rows")).expect("text");
    assert_eq!(rows.lines().count(), 4, "{rows}");
    // What does not fit costs neither the row nor what was written before it, and nothing else is said to be written.
    fs::create_dir_all(place.path("some/rack.pose.pdf")).expect("made");
    let report_all = ["report", "rack.png", "--format", "json,csv,pdf", "--out"];
    let ran = place.run(&[&report_all[..], &["some"]].concat());
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(ran.err.contains("rack.pose.pdf"), "{}", ran.err);
    let is_told = |file: &str| ran.out.contains(file);
    assert!(
        is_told("rack.pose.json") && is_told("poses.matrix.csv") && !is_told(".pdf"),
        "{}",
        ran.out
    );
    let rows = place.read("some/poses.matrix.csv");
    assert_eq!(rows.lines().count(), 2, "{rows}");
    fs::create_dir_all(place.path("none/rack.pose.json")).expect("made");
    let report_json = ["report", "rack.png", "--format", "json", "--out"];
    let ran = place.run(&[&report_json[..], &["none"]].concat());
    assert_eq!((ran.code, &*ran.out), (2, ""), "{}", ran.err);
    // Of one part, the report has the name of the file.
    place.accepted(&[&report[..], &["one"]].concat());
    assert!(place.path("one/rack.pose.json").exists());
}

#[test]
fn one_bad_file_does_not_stop_the_reports_of_the_others() {
    let place = Workplace::new();
    capture(&place, "fender", "left", "fender.pcd");
    capture(&place, "fender", "right", "other.pcd");
    fs::write(place.path("broken.pcd"), "VERSION .7\nFIELDS x y z\n").expect("written");
    let ran = place.run(&[
        "report",
        "broken.pcd",
        "other.pcd",
        "fender.pcd",
        "--out",
        "out",
        "--format",
        "json,csv,pdf",
        "--convention",
        "fanuc",
    ]);
    assert_eq!(ran.code, 2, "{}", ran.err);
    assert!(
        ran.err.contains("error: broken.pcd") && ran.err.contains("to do:"),
        "{}",
        ran.err
    );
    assert_eq!(ran.out.lines().count(), 2, "{}", ran.out);

    let accepted = place.json("out/fender.pose.json");
    assert_eq!(accepted["schema"], 1);
    assert_eq!(accepted["scene"], "fender.pcd");
    assert_eq!(accepted["seen_by"], "simulation");
    assert_eq!(accepted["verdict"]["part"], "fender");
    assert_eq!(accepted["verdict"]["accepted"], true);
    assert_eq!(accepted["robot"]["convention"], "fanuc");
    assert!(
        accepted["robot"]["unavailable"]
            .as_str()
            .is_some_and(|why| why.contains("not calibrated"))
    );
    assert_eq!(
        accepted["pose"]["camera_from_part"]["in_convention"]["values"][3]["name"],
        "W"
    );
    let refused = place.json("out/other.pose.json");
    assert_eq!(refused["verdict"]["accepted"], false);
    assert!(refused["pose"].is_null());
    assert!(!place.path("out/broken.pose.json").exists());

    // The same identities as any other inspection with the same recipe and library.
    for identity in ["recipe", "library"] {
        assert_eq!(
            accepted[identity]["identity"],
            refused[identity]["identity"]
        );
    }
    let table = fs::read_to_string(place.path("out/poses.fanuc.csv")).expect("a table");
    assert_eq!(table.lines().count(), 3, "{table}");
    let again = place.run(&[
        "report",
        "fender.pcd",
        "--out",
        "out",
        "--format",
        "csv",
        "--convention",
        "fanuc",
    ]);
    assert_eq!(again.code, 0, "{}", again.err);
    let longer = fs::read_to_string(place.path("out/poses.fanuc.csv")).expect("a table");
    assert!(longer.starts_with(&table) && longer.lines().count() == 4);

    if let Some(text) = page_text(&place.path("out/fender.pose.pdf")) {
        for words in [
            "Fender, left",
            "RECOGNISED: do not move on this pose",
            "FANUC W P R",
            "camera_from_part",
            "SIMULATED",
            "not calibrated",
            "fender.pcd",
        ] {
            assert!(text.contains(words), "{words}\n{text}");
        }
        let values = accepted["pose"]["camera_from_part"]["in_convention"]["values"]
            .as_array()
            .expect("values");
        let x = format!("{:.3}", values[0]["value"].as_f64().expect("a number"));
        let x = x.replace('-', "\u{2212}");
        assert!(text.contains(&x), "{x}\n{text}");
    }
    if let Some(text) = page_text(&place.path("out/other.pose.pdf")) {
        assert!(
            text.contains("NOT ACCEPTED: do not move on this pose"),
            "{text}"
        );
        assert!(!text.contains("camera_from_part"), "{text}");
    }
}

#[test]
fn a_part_that_is_not_accepted_is_code_one_and_an_empty_cell_is_reported() {
    let place = Workplace::new();
    let ran = place.run(&["simulate", "--part", "empty", "--out", "empty.pcd"]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    let ran = place.run(&["report", "empty.pcd", "--out", "out"]);
    assert_eq!(ran.code, 1, "{}", ran.err);
    assert!(
        ran.out.starts_with("empty.pcd: none, NOT ACCEPTED: "),
        "{}",
        ran.out
    );
    let report = place.json("out/empty.pose.json");
    assert_eq!(report["verdict"]["status"], "no_part");
    assert!(
        report["verdict"]["advice"]
            .as_str()
            .is_some_and(|advice| !advice.is_empty())
    );
    assert!(
        fs::read(place.path("out/empty.pose.pdf"))
            .expect("a page")
            .starts_with(b"%PDF")
    );
}

#[test]
fn a_mirror_image_is_not_named_as_the_part_itself() {
    let place = Workplace::new();
    capture(&place, "front_door", "right", "right.pcd");
    let ran = place.run(&["report", "right.pcd", "--out", "out"]);
    assert_eq!(ran.code, 1, "{}", ran.err);
    let named = "right.pcd: mirror image of front_door, NOT ACCEPTED: ";
    assert!(ran.out.starts_with(named), "{}", ran.out);
}

#[test]
fn schema_and_conventions_are_printed_without_a_scene() {
    let place = Workplace::new();
    let schema = place.run(&["report", "--schema"]);
    assert_eq!(schema.code, 0, "{}", schema.err);
    assert_eq!(
        schema.out,
        include_str!("../../assets/pose-report.schema.json")
    );
    let conventions = place.run(&["report", "--conventions"]);
    assert_eq!(conventions.code, 0, "{}", conventions.err);
    let document = include_str!("../../assets/conventions.md");
    for line in conventions.out.lines().skip(1) {
        let (name, rest) = line.split_once(' ').expect("two columns");
        let (_, meaning) = rest.split_once(": ").expect("a title and a meaning");
        assert!(
            document.contains(&format!("`{name}`")) && document.contains(meaning),
            "{line}"
        );
    }
    let unknown = place.run(&["report", "a.pcd", "--out", "out", "--convention", "comau"]);
    assert_eq!(unknown.code, 2);
    assert!(unknown.err.contains("universal-robots"), "{}", unknown.err);
    let nothing = place.run(&["report"]);
    assert_eq!(nothing.code, 2);
}

#[test]
fn a_report_beside_its_captures_leaves_them_as_they_were() {
    let place = Workplace::new();
    capture(&place, "grille", "left", "grille.png");
    let before = (
        fs::read(place.path("grille.png")),
        fs::read(place.path("grille.json")),
    );
    let ran = place.run(&["report", "grille.png", "--out", "."]);
    assert_eq!(ran.code, 0, "{}", ran.err);
    assert_eq!(
        before.0.expect("an image"),
        fs::read(place.path("grille.png")).expect("an image")
    );
    assert_eq!(
        before.1.expect("a camera"),
        fs::read(place.path("grille.json")).expect("a camera")
    );
    assert!(place.path("grille.pose.json").exists() && place.path("grille.pose.pdf").exists());
}

#[test]
fn a_folder_that_cannot_be_written_is_said_in_words() {
    let place = Workplace::new();
    capture(&place, "grille", "left", "grille.pcd");
    fs::write(place.path("taken"), "a file").expect("written");
    let ran = place.run(&["report", "grille.pcd", "--out", "taken"]);
    assert_eq!(ran.code, 2);
    assert!(
        ran.err.contains("cannot make the report's folder") && ran.err.contains("to do:"),
        "{}",
        ran.err
    );
    // A foreign table is not changed; the other formats are written.
    fs::create_dir(place.path("out")).expect("made");
    fs::write(place.path("out/poses.matrix.csv"), "mine\n").expect("written");
    fs::create_dir(place.path("out/grille.pose.pdf")).expect("made");
    let ran = place.run(&[
        "report",
        "grille.pcd",
        "--out",
        "out",
        "--format",
        "json,csv,pdf",
    ]);
    assert_eq!(ran.code, 2, "{}", ran.out);
    for part_of_error in [
        "its columns are not those of a pose report",
        "grille.pose.pdf",
    ] {
        assert!(ran.err.contains(part_of_error), "{}", ran.err);
    }
    assert_eq!(
        fs::read(place.path("out/poses.matrix.csv")).expect("kept"),
        b"mine\n"
    );
    assert!(place.path("out/grille.pose.json").exists());
}

/// A limit of the file size acts like a full disk: the system refuses the same write.
#[cfg(target_os = "linux")]
#[test]
fn a_disk_that_is_full_leaves_whole_rows_and_the_next_report_is_written() {
    let place = Workplace::new();
    capture(&place, "grille", "left", "grille.pcd");
    let whole = |path: &Path| {
        let text = fs::read_to_string(path).expect("a table");
        assert!(text.ends_with('\n'));
        let columns = text.lines().next().expect("names").split(',').count();
        assert!(
            text.lines()
                .skip(1)
                .all(|line| line.split(',').count() >= columns),
            "{text}"
        );
        text.lines().count()
    };
    let report = ["report", "grille.pcd", "--out", "out", "--format", "csv"];
    assert_eq!(place.run(&report).code, 0);
    let table = place.path("out/poses.matrix.csv");
    assert_eq!(whole(&table), 2);
    let program = env!("CARGO_BIN_EXE_partsight");
    // The limit counts blocks of 512 bytes, so part of the next row still fits.
    let blocks = fs::metadata(&table).expect("a table").len().div_ceil(512);
    let limited = format!("ulimit -f {blocks}; exec {program} {}", report.join(" "));
    let full = Ran::from(
        place
            .command_of("sh", &["-c", &limited])
            .output()
            .expect("starts"),
    );
    assert_eq!(full.code, 2, "{}", full.err);
    assert!(
        full.err.contains("cannot append a row") && full.err.contains("to do:"),
        "{}",
        full.err
    );
    assert_eq!(whole(&table), 2);
    assert_eq!(place.run(&report).code, 0);
    assert_eq!(whole(&table), 3);
}

const CALIBRATE: [&str; 5] = [
    "calibrate",
    "set",
    "kuka 470 0 1350 -90 0 -90",
    "--mount",
    "eye-to-hand",
];

fn force<'a>(args: &[&'a str]) -> Vec<&'a str> {
    [args, &["--force"]].concat()
}

#[test]
fn an_old_capture_is_in_no_output_a_pose_for_the_robot_unless_it_is_forced() {
    let place = Workplace::new();
    capture(&place, "grille", "left", "grille.pcd");
    let inspect = ["inspect", "grille.pcd", "--json"];
    let ran = place.coded(2, &force(&inspect));
    assert!(ran.err.contains("partsight calibrate"), "{}", ran.err);
    place.accepted(&CALIBRATE);
    let ran = place.coded(2, &["inspect", "--source", "simulated", "--force"]);
    assert!(ran.err.contains("not a source"), "{}", ran.err);
    let fresh = place.accepted(&inspect).json();
    assert!(fresh["robot"]["robot_from_part"].is_array(), "{fresh}");
    assert!(fresh.get("robot_doubts").is_none(), "{fresh}");

    let hour = Duration::from_hours(1);
    place.date("grille.pcd", SystemTime::now() - hour);
    let line = place.accepted(&inspect).json();
    assert_eq!(line["robot_doubts"], serde_json::json!(["old"]));
    assert!(line.get("robot").is_none(), "{line}");
    assert_eq!(line["pose"], fresh["pose"]);
    let forced = place.accepted(&force(&inspect)).json();
    assert_eq!(forced["robot"], fresh["robot"]);
    assert_eq!(forced["robot_doubts"], line["robot_doubts"]);
    let rows = place.accepted(&["history", "list", "--json"]).lines();
    let number = rows[1]["number"].to_string();
    assert_eq!(rows[1]["robot_doubts"], line["robot_doubts"]);
    assert!(rows[2].get("robot_doubts").is_none(), "{}", rows[2]);
    let table = place.accepted(&["history", "list"]).out;
    let columns: Vec<&str> = table.lines().map(str::trim_end).collect();
    assert!(columns[0].ends_with("NOT FOR ROBOTS"), "{table}");
    assert!(columns[2].ends_with("old"), "{table}");
    assert!(columns[3].ends_with('-'), "{table}");
    let record = place.accepted(&["history", "show", &number, "--json"]);
    assert_eq!(record.json()["line"], line);
    let shown = place.accepted(&["history", "show", &number]).out;
    assert!(
        shown.contains("Not for robots: the capture was more than 10 minutes old"),
        "{shown}"
    );
    place.accepted(&["history", "export", "--csv", "all.csv"]);
    let table = place.read("all.csv");
    let doubts = csv_column(&table, "robot_doubts");
    assert_eq!(doubts, ["", "old", "old"], "{table}");

    let why = "the capture is more than 10 minutes old";
    let card = place.accepted(&["inspect", "grille.pcd"]).out;
    assert!(card.contains(&format!("no pose: {why}")), "{card}");
    let card = place.accepted(&force(&["inspect", "grille.pcd"])).out;
    assert!(card.contains("in the robot's base frame"), "{card}");
    assert!(card.contains(&format!("given by --force: {why}")), "{card}");
    let rows = place.accepted(&["inspect", "grille.pcd", "grille.pcd"]).out;
    assert_eq!(
        rows.matches(&format!("no pose: {why}")).count(),
        2,
        "{rows}"
    );

    let report = [
        "report",
        "grille.pcd",
        "--out",
        "reports",
        "--format",
        "json,csv",
    ];
    let report_of = |args: &[&str]| {
        place.accepted(args);
        place.json("reports/grille.pose.json")
    };
    let withheld = report_of(&report);
    let unavailable = withheld["robot"]["unavailable"].as_str();
    assert!(
        unavailable.is_some_and(|text| text.contains(why)),
        "{withheld}"
    );
    assert!(withheld["robot"]["robot_from_part"].is_null(), "{withheld}");
    let given = report_of(&force(&report));
    assert!(given["robot"]["robot_from_part"].is_object(), "{given}");
    for report in [&withheld, &given] {
        assert_eq!(report["robot"]["doubts"][0]["kind"], "old");
        assert_eq!(report["pose"]["usable"], false);
    }
    let table = place.read("reports/poses.matrix.csv");
    assert!(
        table.lines().skip(1).all(|row| row.ends_with(",old")),
        "{table}"
    );
}

#[test]
fn an_ambiguous_pose_is_in_no_output_a_pose_for_the_robot() {
    let place = Workplace::new();
    place.accepted(&CALIBRATE);
    for (seed, out) in [("3", "enrolled.pcd"), ("8", "turned.pcd")] {
        let simulate = ["simulate", "--part", "wheel", "--seed", seed];
        place.accepted(&[&simulate[..], &["--out", out]].concat());
    }
    place.accepted(&["enrol", "enrolled.pcd", "--name", "wheel"]);
    let line = place.accepted(&["inspect", "turned.pcd", "--json"]).json();
    assert_eq!(line["pose"]["ambiguous"], true, "{line}");
    assert_eq!(line["robot_doubts"][0], "ambiguous_pose", "{line}");
    assert!(line.get("robot").is_none(), "{line}");
    let why = "another pose of the part fits nearly as well";
    let card = place.accepted(&["inspect", "turned.pcd"]).out;
    assert!(card.contains(&format!("no pose: {why}")), "{card}");
    place.accepted(&[
        "report",
        "turned.pcd",
        "--out",
        "reports",
        "--format",
        "json",
    ]);
    let report = fs::read_to_string(place.path("reports/turned.pose.json")).expect("written");
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    let robot = &report["robot"];
    assert_eq!(robot["unavailable"], why, "{robot}");
    assert!(robot["robot_from_part"].is_null(), "{robot}");
    assert!(robot["robot_offset"].is_null(), "{robot}");
}
