//! Calibration of the cell.

use std::{fmt::Write as _, fs};

use nalgebra::Point3;
use partsight::{
    geometry::rigid::{RigidTransform, from_euler_zyx, from_row_major, pose_error},
    robot::Convention,
};
use serde_json::Value;

use crate::workplace::Workplace;

fn transform(value: &Value) -> RigidTransform {
    let numbers: Vec<f64> = serde_json::from_value(value.clone()).expect("16 numbers");
    let numbers = <[f64; 16]>::try_from(numbers).expect("16 numbers");
    from_row_major(&numbers, 1e-6).expect("a rigid transform")
}

/// The numbers of a pose as a controller shows them.
fn numbers(convention: Convention, pose: &RigidTransform) -> String {
    let numbers = convention.write(pose).numbers();
    let numbers: Vec<String> = numbers.iter().map(|x| format!("{x:.4}")).collect();
    numbers.join(", ")
}

/// Poses of a target in front of the camera, with rotations about all axes.
fn target_poses() -> Vec<RigidTransform> {
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 1.2],
        [0.4, 0.1, 0.2, 0.15, 0.05, 1.1],
        [-0.3, 0.3, -0.4, -0.1, 0.1, 1.3],
        [0.1, -0.4, 0.6, 0.0, -0.1, 1.2],
        [-0.2, -0.3, -0.7, 0.1, 0.0, 1.0],
        [0.3, 0.4, 0.9, -0.15, -0.05, 1.15],
        [0.5, -0.1, -0.2, 0.05, 0.1, 1.25],
    ]
    .into_iter()
    .map(from_euler_zyx)
    .collect()
}

/// A table of pairs, eye to hand, in KUKA's convention.
fn pairs(robot_from_camera: &RigidTransform, seen: &[RigidTransform]) -> String {
    let flange_from_target = from_euler_zyx([0.3, 0.2, -0.5, 0.02, -0.03, 0.1]);
    let mut text = String::from("# robot: kuka\n# camera: quaternion-xyzw\n");
    for (i, pose) in seen.iter().enumerate() {
        let robot_from_flange = robot_from_camera * pose * flange_from_target.inverse();
        let arm = numbers(Convention::Kuka, &robot_from_flange);
        let camera = Convention::QuaternionXyzw.write(pose).numbers();
        let camera: Vec<String> = camera.iter().map(ToString::to_string).collect();
        writeln!(text, "p{}, {arm}, {}", i + 1, camera.join(", ")).expect("memory");
    }
    text
}

fn robot_from_camera() -> RigidTransform {
    from_euler_zyx([-2.2, 0.1, -1.6, 1.5, -0.2, 2.0])
}

#[test]
fn pairs_make_a_calibration_that_inspect_uses() {
    let shop = Workplace::new();
    shop.write("pairs.csv", &pairs(&robot_from_camera(), &target_poses()));
    let arguments = [
        "calibrate",
        "hand-eye",
        "pairs.csv",
        "--mount",
        "eye-to-hand",
    ];
    let made = shop.coded(0, &[&arguments[..], &["--name", "Cell 2"]].concat());
    assert!(
        made.out.contains("worst") && made.out.contains("Written to"),
        "{}",
        made.out
    );
    let shown = shop.coded(0, &["calibrate", "show", "--json"]).json();
    let found = transform(&shown["robot_from_camera"]);
    let off = pose_error(&found, &robot_from_camera(), &Point3::new(0.0, 0.0, 1.2));
    assert!(
        off.shift.mm() < 0.01 && off.rotation.degrees() < 0.001,
        "{off:?}"
    );
    assert_eq!(shown["origin"]["num_pairs"], 7);

    shop.coded(
        0,
        &[
            "simulate",
            "--part",
            "fender",
            "--placement",
            "facing",
            "--out",
            "fender.pcd",
        ],
    );
    let line = shop.coded(0, &["inspect", "fender.pcd", "--json"]).json();
    let pose = transform(&line["pose"]["camera_from_part"]);
    let robot = &line["robot"];
    assert!(
        robot["calibration"]
            .as_str()
            .expect("a name")
            .starts_with("Cell 2 ("),
        "{robot}"
    );
    let is_near = |value: &Value, expected: RigidTransform| {
        (transform(value).to_homogeneous() - expected.to_homogeneous()).amax() < 1e-9
    };
    assert!(is_near(&robot["robot_from_part"], found * pose));
    assert!(is_near(
        &robot["robot_offset"],
        found * pose * found.inverse()
    ));

    // Enter the same by hand, in the robot's convention; the former file is kept.
    let by_hand = format!("kuka {}", numbers(Convention::Kuka, &robot_from_camera()));
    let made = shop.coded(0, &["calibrate", "set", &by_hand, "--mount", "eye-to-hand"]);
    assert!(made.out.contains("cell.former.toml"), "{}", made.out);
    let shown = shop.coded(0, &["calibrate", "show", "--as", "kuka"]);
    assert!(
        shown.out.contains("entered by hand") && shown.out.contains("A "),
        "{}",
        shown.out
    );
}

#[test]
fn poses_that_do_not_span_are_not_written_without_insisting() {
    let shop = Workplace::new();
    let about_one_axis: Vec<RigidTransform> = (0..6)
        .map(|i| from_euler_zyx([0.0, 0.0, 0.3 * f64::from(i), 0.05 * f64::from(i), 0.0, 1.2]))
        .collect();
    shop.write("pairs.csv", &pairs(&robot_from_camera(), &about_one_axis));
    let arguments = [
        "calibrate",
        "hand-eye",
        "pairs.csv",
        "--mount",
        "eye-to-hand",
        "--out",
        "cell.toml",
    ];
    let ran = shop.coded(1, &arguments);
    assert!(
        ran.err.contains("about one axis") && ran.err.contains("another axis by at least 30°"),
        "{}",
        ran.err
    );
    assert!(!shop.path("cell.toml").exists());
    shop.coded(1, &[&arguments[..], &["--even-if-doubtful"]].concat());
    assert!(shop.read("cell.toml").contains("about one axis"));
}

#[test]
fn a_wrong_pair_is_named_and_can_be_left_out() {
    let shop = Workplace::new();
    let text = pairs(&robot_from_camera(), &target_poses());
    let wrong: Vec<String> = text
        .lines()
        .map(|line| match line.strip_prefix("p3, ") {
            // Off by 40 mm.
            Some(rest) => {
                let (x, rest) = rest.split_once(',').expect("numbers");
                let x: f64 = x.parse().expect("a number");
                format!("p3, {},{rest}", x + 40.0)
            }
            None => line.to_owned(),
        })
        .collect();
    shop.write("pairs.csv", &(wrong.join("\n") + "\n"));
    let arguments = [
        "calibrate",
        "hand-eye",
        "pairs.csv",
        "--mount",
        "eye-to-hand",
        "--dry-run",
        "--json",
    ];
    let line = shop.run(&arguments).json();
    let doubts = line["doubts"].to_string();
    assert!(doubts.contains("p3 (line 5) is suspect"), "{doubts}");
    let line = shop
        .coded(0, &[&arguments[..], &["--without", "p3"]].concat())
        .json();
    assert!(line["rms_m"].as_f64().expect("a number") < 1e-5, "{line}");
    assert_eq!(line["pairs"].as_array().expect("pairs").len(), 6);
    assert!(!shop.path("data/partsight/cell.toml").exists());
}

#[test]
fn a_camera_on_the_flange_needs_the_arms_pose() {
    let shop = Workplace::new();
    shop.coded(
        0,
        &[
            "simulate",
            "--part",
            "grille",
            "--placement",
            "facing",
            "--out",
            "grille.pcd",
        ],
    );
    let set = [
        "calibrate",
        "set",
        "0 -1 0 0.05  1 0 0 0  0 0 1 0.09  0 0 0 1",
        "--mount",
        "eye-in-hand",
        "--out",
        "cell.toml",
    ];
    shop.coded(0, &set);
    let inspect = [
        "inspect",
        "grille.pcd",
        "--json",
        "--calibration",
        "cell.toml",
    ];
    let ran = shop.coded(2, &inspect);
    assert!(ran.err.contains("--robot-pose"), "{}", ran.err);
    let arm = from_euler_zyx([0.0, 1.5, 0.3, 0.9, 0.1, 1.1]);
    let text = format!("fanuc {}", numbers(Convention::Fanuc, &arm));
    let line = shop
        .coded(0, &[&inspect[..], &["--robot-pose", &text]].concat())
        .json();
    let given = transform(&line["robot"]["robot_from_camera"]);
    shop.coded(
        0,
        &[
            "calibrate",
            "capture-pose",
            &text,
            "--calibration",
            "cell.toml",
        ],
    );
    let line = shop.coded(0, &inspect).json();
    let stored = transform(&line["robot"]["robot_from_camera"]);
    assert!((given.to_homogeneous() - stored.to_homogeneous()).amax() < 1e-9);
    assert!((given.translation.vector - (arm * Point3::new(0.05, 0.0, 0.09)).coords).norm() < 1e-5);
}

#[test]
fn bad_input_is_refused_with_its_line() {
    let shop = Workplace::new();
    shop.write("pairs.csv", "# robot: kuka\n1 2 3 4 5 6\n");
    let ran = shop.coded(
        2,
        &[
            "calibrate",
            "hand-eye",
            "pairs.csv",
            "--mount",
            "eye-to-hand",
        ],
    );
    assert!(
        ran.err
            .contains("pairs.csv, line 2: 6 numbers, expected 22"),
        "{}",
        ran.err
    );
    let ran = shop.coded(
        2,
        &["calibrate", "set", "kuka 1 2 3", "--mount", "eye-to-hand"],
    );
    assert!(ran.err.contains("KUKA A B C has 6 numbers"), "{}", ran.err);
    let ran = shop.coded(2, &["calibrate", "show"]);
    assert!(ran.err.contains("partsight calibrate"), "{}", ran.err);
    shop.write("cell.toml", "schema_version = 99\n");
    shop.coded(0, &["simulate", "--part", "grille", "--out", "grille.pcd"]);
    let ran = shop.coded(2, &["inspect", "grille.pcd", "--calibration", "cell.toml"]);
    assert!(ran.err.contains("newer version"), "{}", ran.err);
}

/// The target is a simulated fender that the arm shows to the camera in eight poses, as in a shop without a
/// checkerboard.
#[test]
fn an_enrolled_part_on_the_flange_is_target_enough() {
    let shop = Workplace::new();
    fs::create_dir(shop.path("captures")).expect("a folder");
    let mut text = String::from("# robot: abb\ncapture;x;y;z;q1;q2;q3;q4\n");
    let flange_from_part = from_euler_zyx([0.2, 0.1, 1.0, 0.1, 0.05, 0.3]);
    let turns = [
        [0, 0, 0],
        [22, 0, 10],
        [-20, 8, -15],
        [5, 22, 30],
        [0, -22, -30],
        [15, -15, 55],
        [-14, 14, -50],
        [18, 12, 85],
    ];
    for (i, [rx, ry, rz]) in turns.into_iter().enumerate() {
        let [x, y, z] = [0.04, 0.03, 0.05].map(|step| step * ((i * 7 % 5) as f64 - 2.0));
        let z = 1.35 + z;
        let angles = [rx, ry, rz].map(|degrees| f64::from(degrees).to_radians());
        let camera_from_part = from_euler_zyx([angles[0], angles[1], angles[2], x, y, z]);
        let pose = format!("{rx}deg {ry}deg {rz}deg {x} {y} {z}");
        let (name, seed) = (format!("shot {i}.pcd"), (i + 1).to_string());
        let out = shop.path("captures").join(&name).display().to_string();
        shop.coded(
            0,
            &[
                "simulate", "--part", "fender", "--seed", &seed, "--pose", &pose, "--out", &out,
            ],
        );
        let arm = robot_from_camera() * camera_from_part * flange_from_part.inverse();
        let arm = numbers(Convention::Abb, &arm);
        writeln!(text, "{name};{}", arm.replace(", ", ";")).expect("memory");
    }
    shop.write("poses.csv", &text);
    let ran = shop.run(&[
        "calibrate",
        "hand-eye",
        "poses.csv",
        "--captures",
        "captures",
        "--mount",
        "eye-to-hand",
        "--out",
        "cell.toml",
        "--json",
    ]);
    assert_eq!(ran.code, 0, "{}\n{}", ran.out, ran.err);
    let line = ran.json();
    let num_pairs = line["pairs"].as_array().expect("pairs").len();
    assert!(num_pairs >= 6, "{}", ran.err);
    let found = transform(&line["robot_from_camera"]);
    let off = pose_error(&found, &robot_from_camera(), &Point3::new(0.0, 0.0, 1.35));
    println!("{num_pairs} pairs: off by {off:?}, rms {} m", line["rms_m"]);
    assert!(
        off.shift.mm() < 8.0 && off.rotation.degrees() < 0.6,
        "{off:?}"
    );
    let bound = |name: &str| line[name].as_f64().expect("a bound");
    assert!(
        off.shift.0 < bound("shift_bound_m") && off.rotation.0 < bound("turn_bound_rad"),
        "{off:?}, {line}"
    );
    assert!(bound("shift_bound_m") < 0.008, "{line}");
    assert!(
        shop.read("cell.toml")
            .contains("pairs_file = \"poses.csv\"")
    );
    // The pose of the target on the flange results too, except for the choice of the part's frame.
    let target = transform(&line["flange_from_target"]);
    let off = (target.translation.vector - flange_from_part.translation.vector).norm();
    assert!(off < 0.3, "{target}");
}

#[test]
fn a_stored_spray_path_is_carried_into_the_robots_frame() {
    let shop = Workplace::new();
    let set = format!("kuka {}", numbers(Convention::Kuka, &robot_from_camera()));
    shop.coded(0, &["calibrate", "set", &set, "--mount", "eye-to-hand"]);
    shop.coded(
        0,
        &[
            "simulate",
            "--part",
            "front_door",
            "--placement",
            "facing",
            "--seed",
            "5",
            "--out",
            "door.pcd",
        ],
    );
    let inspect = [
        "inspect",
        "door.pcd",
        "--json",
        "--spray",
        "out.csv",
        "--spray-as",
        "kuka",
    ];
    // Without a stored path there is one start, in front of the middle.
    let ran = shop.coded(0, &inspect);
    assert!(ran.err.contains("no spray path"), "{}", ran.err);
    let start = shop.read("out.csv");
    assert!(
        start.contains("no path is stored") && start.contains("1 of 1 inside"),
        "{start}"
    );
    let row = start.lines().last().expect("a line");
    // The shipped parts were enrolled square to the camera, 1.3 m away: the nozzle is 15 cm in front of that start's
    // only point.
    let cells: Vec<f64> = row
        .split(',')
        .take(7)
        .map(|cell| cell.parse().expect("a number"))
        .collect();
    let nozzle = Convention::Kuka.read(&cells[1..7]).expect("a pose");
    let line = ran.json();
    let robot_from_part = transform(&line["robot"]["robot_from_part"]);
    let in_part = robot_from_part.inverse() * nozzle;
    assert!(in_part.translation.vector.xy().norm() < 0.15, "{in_part}");
    assert!(
        (1.0..1.3).contains(&in_part.translation.vector.z),
        "{in_part}"
    );

    let mut path =
        String::from("nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z\n");
    let at = in_part.translation.vector * 1000.0;
    let along = in_part * nalgebra::Vector3::z();
    for x in [-40.0, 0.0, 40.0, 4000.0] {
        writeln!(
            path,
            "{},{},{},{},{},{}",
            at.x + x,
            at.y,
            at.z,
            along.x,
            along.y,
            along.z
        )
        .expect("memory");
    }
    shop.write("path.csv", &path);
    let stored = shop.coded(0, &["library", "path", "front_door", "path.csv"]);
    assert!(
        stored.out.contains("4 points") && stored.out.contains("1 with no surface"),
        "{}",
        stored.out
    );
    shop.coded(0, &["library", "rename", "front_door", "--to", "door"]);
    shop.coded(0, &inspect);
    let carried = shop.read("out.csv");
    assert!(
        carried.contains("stored spray path") && carried.contains("SIMULATED"),
        "{carried}"
    );
    let rows: Vec<&str> = carried
        .lines()
        .filter(|l| l.starts_with(char::is_numeric))
        .collect();
    assert_eq!(rows.len(), 4);
    assert!(
        rows[1].ends_with(",inside,1,") && rows[3].ends_with(",,not_seen,1,"),
        "{carried}"
    );
    shop.coded(0, &["inspect", "door.pcd", "--spray", "out.json"]);
    let json: Value = serde_json::from_str(&shop.read("out.json")).expect("JSON");
    assert_eq!(
        (json["num_points"].as_u64(), json["simulated"].as_bool()),
        (Some(4), Some(true))
    );
}

#[test]
fn what_was_taught_over_a_part_is_not_sprayed_over_another_reference_of_it() {
    let shop = Workplace::new();
    let set = format!("kuka {}", numbers(Convention::Kuka, &robot_from_camera()));
    shop.coded(0, &["calibrate", "set", &set, "--mount", "eye-to-hand"]);
    let hang = |seed: &str, file: &str| {
        let door = ["simulate", "--part", "front_door", "--model", "5"];
        let placed = ["--placement", "facing", "--seed", seed, "--out", file];
        shop.coded(0, &[&door[..], &placed].concat());
    };
    hang("1", "make.pcd");
    shop.coded(
        0,
        &[
            "enrol",
            "make.pcd",
            "--name",
            "door_b",
            "--as",
            "front_door",
        ],
    );
    hang("9", "door.pcd");
    let ran = shop.coded(2, &["inspect", "door.pcd", "--spray", "out.csv"]);
    let output = "door_b, one more reference of front_door, has no spray path";
    assert!(ran.err.contains(output), "{}", ran.err);
    assert!(!shop.path("out.csv").exists());
}

#[test]
fn of_what_is_not_accepted_no_spray_path_is_left() {
    let shop = Workplace::new();
    let set = format!("kuka {}", numbers(Convention::Kuka, &robot_from_camera()));
    shop.coded(0, &["calibrate", "set", &set, "--mount", "eye-to-hand"]);
    let inspect = ["inspect", "door.pcd", "--spray", "out.csv"];
    let hang = |part: &str| {
        let arguments = ["simulate", "--part", part, "--placement", "facing", "--out"];
        shop.coded(0, &[&arguments[..], &["door.pcd"]].concat());
    };
    // First not accepted, then not even readable.
    for is_readable in [true, false] {
        hang("front_door");
        shop.coded(0, &inspect);
        assert!(shop.path("out.csv").exists());
        if is_readable {
            hang("empty");
            let ran = shop.coded(1, &inspect);
            assert!(ran.err.contains("no spray path was written"), "{}", ran.err);
        } else {
            shop.write("door.pcd", "VERSION .7\nFIELDS x");
            shop.coded(2, &inspect);
        }
        assert!(!shop.path("out.csv").exists());
    }
    // A file that is not a spray path is not removed.
    shop.write("notes.csv", "mine");
    shop.coded(2, &["inspect", "door.pcd", "--spray", "notes.csv"]);
    assert_eq!(shop.read("notes.csv"), "mine");
    shop.coded(
        2,
        &[
            "inspect",
            "door.pcd",
            "--spray",
            "out.csv",
            "--calibration",
            "none.toml",
        ],
    );
}

#[test]
fn numbers_that_the_file_cannot_hold_are_not_reported_as_written_and_a_wrong_unit_is_questioned() {
    let place = Workplace::new();
    let set = |code: i32, pose: &str| {
        let arguments = ["calibrate", "set", pose, "--mount", "eye-to-hand", "--out"];
        place.coded(code, &[&arguments[..], &["cell.toml"]].concat())
    };
    let right = set(0, "kuka 1200 -400 1900 86 -5 120");
    assert!(!right.err.contains("warning"), "{}", right.err);
    for pose in [
        "kuka 1e300 -400 1900 86 -5 120",
        "kuka nan -400 1900 86 -5 120",
        "kuka 1200 -400 inf 86 -5 120",
        "quaternion-xyzw 1e300 0 0 0 0 0 1",
    ] {
        let ran = set(2, pose);
        assert!(!ran.out.contains("Written"), "{pose}: {}", ran.out);
        assert!(ran.err.contains("to do"), "{pose}: {}", ran.err);
    }
    let shown = place.accepted(&["calibrate", "show", "--calibration", "cell.toml"]);
    assert!(
        shown.out.contains("1.2"),
        "the first one stays: {}",
        shown.out
    );
    let near = set(0, "kuka 1.2 -0.4 1.9 86 -5 120").err;
    assert!(near.contains("metres given as millimetres"), "{near}");
    let far = set(0, "quaternion-xyzw 30 -10 20 0 0 0 1").err;
    assert!(far.contains("millimetres given as metres"), "{far}");
    // No cell is this large, so nothing is written.
    let written = place.read("cell.toml");
    let ran = set(2, "universal-robots 1200 -400 1900 0 0 0");
    assert!(ran.err.contains("2283 m away"), "{}", ran.err);
    let advice = "to do: Write its position in m, the unit of universal-robots";
    assert!(ran.err.contains(advice), "{}", ran.err);
    assert_eq!(place.read("cell.toml"), written);
}

#[test]
fn a_calibration_with_a_changed_digit_gives_no_pose_until_it_is_confirmed() {
    let place = Workplace::new();
    let at = |x: &str| format!("kuka {x} -400 1900 86 -5 120");
    let own = ["calibrate", "set", "--mount", "eye-to-hand"];
    place.coded(0, &[&own[..], &[&at("1200")]].concat());
    let folder = place.coded(0, &["calibrate", "show", "--json"]).json();
    let path = folder["calibration"].as_str().expect("a path").to_owned();
    assert_eq!(folder["edited"], false);
    let digit = place
        .read(&path)
        .replace("1.200000000000", "7.200000000000");
    place.write(&path, &digit);
    let fender = ["simulate", "--part", "fender", "--placement", "facing"];
    place.coded(0, &[&fender[..], &["--out", "fender.pcd"]].concat());

    let wanted = "the numbers were changed after the calibration";
    let inspect = ["inspect", "fender.pcd", "--json"];
    let named = ["--calibration", path.as_str()];
    let spray = ["--spray", "out.csv"];
    for args in [&named[..], &spray, &[&named[..], &spray].concat()] {
        let ran = place.coded(2, &[&inspect[..], args].concat());
        assert!(ran.err.contains(wanted), "{args:?}: {}", ran.err);
        assert!(ran.out.is_empty(), "{}", ran.out);
    }
    assert!(!place.path("out.csv").exists());
    let serve = ["serve", "--source", "simulated:fender", "--as", "kuka"];
    for args in [&[][..], &named] {
        let ran = place.coded(2, &[&serve[..], args].concat());
        assert!(ran.err.contains(wanted), "{}", ran.err);
    }
    // The part is recognised, but nothing is in the robot's frame.
    let ran = place.accepted(&inspect);
    assert!(ran.err.contains(wanted), "{}", ran.err);
    assert!(ran.json()["robot"].is_null(), "{}", ran.out);
    // A pose of the arm would write a checksum.
    let ran = place.coded(2, &["calibrate", "capture-pose", &at("900")]);
    assert!(ran.err.contains(wanted), "{}", ran.err);
    assert_eq!(place.read(&path), digit);
    let shown = place.coded(0, &["calibrate", "show", "--json"]).json();
    assert_eq!(shown["edited"], true);

    let ran = place.coded(0, &["calibrate", "confirm"]);
    assert!(ran.out.contains("Confirmed"), "{}", ran.out);
    assert!(ran.out.contains("cell.former.toml"), "{}", ran.out);
    let ran = place.accepted(&inspect);
    assert!(!ran.err.contains(wanted), "{}", ran.err);
    assert!(!ran.json()["robot"].is_null(), "{}", ran.out);
    let ran = place.coded(0, &["calibrate", "confirm"]);
    assert!(ran.out.contains("nothing to confirm"), "{}", ran.out);
}
