//! Programs for a robot's controller.

use std::{
    fmt::Write as _,
    time::{Duration, SystemTime},
};

use crate::{kit::copy_part, workplace::Workplace};

/// A place with a calibrated cell and a door in front of its camera. The door is its only part: a program reads all of them.
fn shop() -> Workplace {
    shop_at("kuka 1200 -400 1900 86 -5 120")
}

/// The same with a camera that looks along x of the robot's base; the door is 1.7 m in front of the base.
fn shop_ahead() -> Workplace {
    shop_at("kuka 470 0 1350 -90 0 -90")
}

fn shop_at(cell: &str) -> Workplace {
    let shop = Workplace::new();
    shop.with_made(&["shop", cell], |shop| {
        enrol(shop, "front_door");
        shop.coded(0, &["calibrate", "set", cell, "--mount", "eye-to-hand"]);
        hang(shop, "front_door");
    });
    shop
}

/// Adds a shipped part to the library of the place.
fn enrol(shop: &Workplace, part: &str) {
    copy_part(part, &shop.path("data/partsight/library"));
}

fn hang(shop: &Workplace, part: &str) {
    let placed = ["--placement", "facing", "--seed", "5", "--out", "door.pcd"];
    shop.simulated(&[&["--part", part], &placed[..]].concat());
}

/// Captures a rack of three parts, which are enrolled.
fn hang_three(shop: &Workplace) {
    for part in ["radiator_support", "back_door"] {
        enrol(shop, part);
    }
    let rack = ["--rack", "3", "--rack-kind", "apart", "--seed", "4"];
    shop.simulated(&[&rack[..], &["--out", "rack.png"]].concat());
}

/// Stores a path of three points with the door.
fn store_path(shop: &Workplace) {
    shop.with_made(&["door with a path"], |shop| {
        enrol(shop, "front_door");
        shop.write(
            "path.csv",
            "nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z\n\
             -40,150,1130,0,0,1\n0,150,1130,0,0,1\n40,150,1130,0,0,1\n",
        );
        shop.coded(0, &["library", "path", "front_door", "path.csv"]);
    });
}

#[test]
fn an_accepted_part_is_painted_by_a_program_of_each_controller() {
    let shop = shop();
    let ran = shop.coded(2, &["inspect", "door.pcd", "--program", "paint.src"]);
    assert!(ran.err.contains("no spray path"), "{}", ran.err);
    assert!(ran.err.contains("YOUR_PATH.csv"), "{}", ran.err);
    // The part was accepted, whatever became of its program.
    let listed = shop.accepted(&["history", "list", "--json"]).lines();
    assert_eq!(listed.len(), 1);
    assert_eq!(listed[0]["verdict"], "accepted");
    assert_eq!(listed[0]["part"], "front_door");
    store_path(&shop);
    for (file, wanted) in [
        ("paint.src", "DEF paint ( )"),
        ("paint.ls", "/PROG  PAINT"),
        ("paint.mod", "PROC run_paint()"),
        ("paint.script", "def paint():"),
        ("paint.jbi", "//NAME PAINT"),
        ("paint.drl", "movejx(posx("),
    ] {
        shop.coded(0, &["inspect", "door.pcd", "--program", file]);
        let text = shop.read(file);
        for wanted in [
            wanted,
            "SIMULATED",
            "part: front_door",
            "3 points, gun: output 1",
            "at the nozzle mouth, z",
        ] {
            assert!(text.contains(wanted), "{file} {wanted}: {text}");
        }
        assert!(!text.contains("FORCED"));
    }
    let ran = shop.coded(2, &["inspect", "door.pcd", "--program", "paint.txt"]);
    assert!(ran.err.contains("--robot-program-format"), "{}", ran.err);
    let as_drl = ["--program", "paint.txt", "--robot-program-format", "drl"];
    shop.coded(0, &[&["inspect", "door.pcd"][..], &as_drl].concat());
    assert!(shop.read("paint.txt").contains("posx("));
    let ran = shop.coded(2, &["inspect", "door.pcd", "--program", "1 door.src"]);
    assert!(
        ran.err.contains("Name the file with letters"),
        "{}",
        ran.err
    );
}

#[test]
fn a_program_follows_a_line_where_the_language_can() {
    let shop = shop();
    store_path(&shop);
    let tracking = [
        "--tracking",
        "1",
        "--tracking-frame",
        "kuka 900 -1200 400 90 0 0",
    ];
    let export = |file: &'static str| {
        [&["path", "export", "front_door", "-o", file], &tracking[..]].concat()
    };
    for (file, wanted, begins) in [
        (
            "paint.mod",
            "WaitWObj wPartsight;",
            "as the part passes its",
        ),
        (
            "paint.ls",
            "LINE_TRACK_SCHEDULE_NUMBER      : 1;",
            "as the part",
        ),
        (
            "paint.script",
            "def paint(count, ticks_per_meter):",
            "as the part passes its",
        ),
    ] {
        let ran = shop.coded(0, &export(file));
        assert!(ran.err.contains("reach and collisions"), "{}", ran.err);
        let text = shop.read(file);
        assert!(text.contains(wanted) && text.contains(begins), "{text}");
    }
    // An earlier program does not stay.
    shop.coded(0, &["path", "export", "front_door", "-o", "paint.src"]);
    let ran = shop.coded(2, &export("paint.src"));
    assert!(
        ran.err.contains("moves with a line") && ran.err.contains("to do"),
        "{}",
        ran.err
    );
    assert!(!shop.path("paint.src").exists());
    let inspect = ["inspect", "door.pcd", "--program", "paint.mod"];
    shop.coded(0, &[&inspect[..], &tracking].concat());
    assert!(
        shop.read("paint.mod")
            .contains("begins with the count at which")
    );
    // An arm whose reach is checked stands still.
    let arm = ["--arm", "irb4600", "--nozzle", "kuka 0 0 250 0 45 0"];
    let ran = shop.coded(2, &[&inspect[..], &tracking, &arm].concat());
    assert!(ran.err.contains("--arm"), "{}", ran.err);
}

#[test]
fn each_of_several_parts_has_a_path_of_its_own_and_none_of_an_earlier_frame_stays() {
    let shop = shop();
    hang_three(&shop);
    let inspect = ["inspect", "rack.png", "--spray", "out.csv", "--json"];
    let several = ["--set", "segment.max_parts=3"];
    let line = shop.coded(0, &[&inspect[..], &several].concat()).json();
    let parts = line["parts"].as_array().expect("parts");
    assert_eq!(parts.len(), 3);
    for (number, part) in (1..).zip(parts) {
        let text = shop.read(format!("out_{number}.csv"));
        assert!(
            text.contains(part["part"].as_str().expect("a name")),
            "{text}"
        );
    }
    assert!(!shop.path("out.csv").exists());
    // The next frame shows one part.
    shop.coded(0, &["inspect", "door.pcd", "--spray", "out.csv"]);
    assert!(shop.path("out.csv").exists());
    for number in 1..=3 {
        assert!(!shop.path(format!("out_{number}.csv")).exists(), "{number}");
    }
}

#[test]
fn a_part_without_a_path_does_not_keep_the_next_one_from_its_program() {
    let shop = shop();
    hang_three(&shop);
    let inspect = ["inspect", "rack.png", "--set", "segment.max_parts=3"];
    let line = shop.coded(0, &[&inspect[..], &["--json"]].concat()).json();
    let name = |index: usize| line["parts"][index]["part"].as_str().expect("a name");
    assert_eq!(name(2), "front_door");
    store_path(&shop);
    let ran = shop.coded(2, &[&inspect[..], &["--program", "paint.src"]].concat());
    for (number, part) in [(1, name(0)), (2, name(1))] {
        let missing = format!("{part} has no spray path");
        assert!(ran.err.contains(&missing), "{}", ran.err);
        assert!(!shop.path(format!("paint_{number}.src")).exists());
    }
    assert!(shop.path("paint_3.src").exists(), "{}", ran.err);
}

#[test]
fn what_cannot_be_inspected_leaves_no_earlier_program_or_path() {
    let shop = shop();
    store_path(&shop);
    shop.write("broken.toml", "no calibration");
    for output in [["--program", "paint.src"], ["--spray", "paint.csv"]] {
        for failing in [
            ["--calibration", "missing.toml"],
            ["--calibration", "broken.toml"],
            ["--library", "missing"],
            ["--recipe", "missing.toml"],
        ] {
            shop.coded(0, &[&["inspect", "door.pcd"][..], &output].concat());
            assert!(shop.path(output[1]).exists());
            shop.coded(
                2,
                &[&["inspect", "door.pcd"][..], &output, &failing].concat(),
            );
            assert!(!shop.path(output[1]).exists(), "{output:?} {failing:?}");
        }
    }
}

#[test]
fn both_outputs_at_once_or_one_for_a_scan_are_refused_and_leave_no_earlier_file() {
    let shop = shop();
    store_path(&shop);
    let program = ["--program", "paint.src"];
    let spray = ["--spray", "paint.csv"];
    for (capture, outputs, wanted) in [
        ("door.pcd", vec![program, spray], "cannot be used together"),
        (
            "--scan",
            vec![program],
            "--program takes a capture's file, not a scan",
        ),
        (
            "--scan",
            vec![spray],
            "--spray takes a capture's file, not a scan",
        ),
    ] {
        for output in &outputs {
            shop.coded(0, &[&["inspect", "door.pcd"][..], output].concat());
        }
        let mut inspect = vec!["inspect", capture];
        if capture == "--scan" {
            inspect.push("frames");
        }
        let ran = shop.coded(2, &[inspect, outputs.concat()].concat());
        assert!(ran.err.contains(wanted), "{}", ran.err);
        for [_, file] in outputs {
            assert!(!shop.path(file).exists(), "{file}");
        }
    }
}

#[test]
fn of_a_refused_part_an_old_capture_or_an_unreached_path_no_program_is_left_unless_forced() {
    let shop = shop();
    store_path(&shop);
    let inspect = ["inspect", "door.pcd", "--program", "paint.src"];
    shop.coded(0, &inspect);
    // A refused part removes the program.
    hang(&shop, "empty");
    shop.coded(1, &inspect);
    assert!(!shop.path("paint.src").exists());
    // The part is out of the arm's reach.
    hang(&shop, "front_door");
    shop.coded(0, &inspect);
    let nozzle = "kuka 0 0 250 0 0 0";
    let arm = ["--arm", "kr6-r900", "--nozzle", nozzle];
    let ran = shop.coded(1, &[&inspect[..], &arm].concat());
    assert!(ran.err.contains("misses"), "{}", ran.err);
    assert!(!shop.path("paint.src").exists());
    let ran = shop.coded(
        2,
        &[&inspect[..], &["--arm", "ur10e", "--nozzle", nozzle]].concat(),
    );
    assert!(ran.err.contains("spherical wrist"), "{}", ran.err);
    shop.coded(0, &[&inspect[..], &arm, &["--force"]].concat());
    assert!(
        shop.read("paint.src")
            .contains("FORCED: KUKA KR 6 R900-2 misses")
    );
    // The capture is too old.
    let hour = Duration::from_hours(1);
    shop.date("door.pcd", SystemTime::now() - hour);
    let ran = shop.coded(1, &inspect);
    assert!(ran.err.contains("10 minutes old"), "{}", ran.err);
    assert!(!shop.path("paint.src").exists());
    shop.coded(0, &[&inspect[..], &["--force"]].concat());
    assert!(shop.read("paint.src").contains("FORCED: the capture"));
    let spray = ["inspect", "door.pcd", "--spray", "out.csv"];
    let ran = shop.coded(1, &spray);
    let wanted = "no spray path was written: the capture is more than 10 minutes old";
    assert!(ran.err.contains(wanted), "{}", ran.err);
    assert!(!shop.path("out.csv").exists());
    shop.coded(0, &[&spray[..], &["--force"]].concat());
    assert!(
        shop.read("out.csv")
            .contains("# DOUBT: the capture is more")
    );
    // The unit behind its name does not make it younger.
    let ran = shop.coded(1, &["inspect", "door.pcd#units=m", "--spray", "out.csv"]);
    assert!(ran.err.contains(wanted), "{}", ran.err);
    assert!(!shop.path("out.csv").exists());
    // A capture dated later than now may be just as old.
    shop.date("door.pcd", SystemTime::now() + hour);
    let ran = shop.coded(1, &inspect);
    assert!(ran.err.contains("later than now"), "{}", ran.err);
    assert!(ran.err.contains("Set the clocks"), "{}", ran.err);
    assert!(!ran.err.contains("10 minutes"), "{}", ran.err);
    assert!(!shop.path("paint.src").exists());
    let ran = shop.coded(1, &spray);
    assert!(ran.err.contains("Set the clocks"), "{}", ran.err);
    shop.coded(0, &[&inspect[..], &["--force"]].concat());
    // A file that is not a program is not removed.
    shop.write("notes.src", "mine");
    shop.coded(1, &["inspect", "door.pcd", "--program", "notes.src"]);
    assert_eq!(shop.read("notes.src"), "mine");
}

#[test]
fn a_path_is_checked_against_an_arm() {
    let shop = shop();
    let check = [
        "path",
        "check",
        "front_door",
        "--nozzle",
        "kuka 0 0 250 0 45 0",
        "--arm",
    ];
    let ran = shop.coded(2, &[&check[..], &["irb4600"]].concat());
    assert!(ran.err.contains("no spray path"), "{}", ran.err);
    store_path(&shop);
    let ran = shop.coded(2, &[&check[..], &["ur10e"]].concat());
    assert!(ran.err.contains("spherical wrist"), "{}", ran.err);
    let far = ["kr6-r900", "--base", "kuka 90000 0 0 0 0 0"];
    let ran = shop.coded(1, &[&check[..], &far].concat());
    let wanted = "points 1–3: out of reach (3 points)";
    assert!(ran.out.contains(wanted), "{}", ran.out);
    // No place nearby is better.
    assert!(!ran.out.contains("--base"), "{}", ran.out);
    let ran = shop.coded(1, &[&check[..], &far, &["--json"]].concat());
    let line = ran.json();
    assert_eq!(line["schema"], 1);
    assert_eq!(line["num_points"], 3);
    assert_eq!(line["num_reached"], 0);
}

#[test]
fn accelerations_are_checked_where_their_limits_are_known() {
    let shop = shop_ahead();
    // Across, then down.
    shop.write(
        "path.csv",
        "nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z\n\
         -40,150,1130,0,0,1\n0,150,1130,0,0,1\n0,190,1130,0,0,1\n",
    );
    shop.coded(0, &["library", "path", "front_door", "path.csv"]);
    let check = |code: i32, arm: &str, more: &[&str]| {
        let check = ["path", "check", "front_door", "--arm", arm];
        let nozzle = ["--nozzle", "kuka 0 0 250 0 -45 0"];
        shop.coded(code, &[&check[..], &nozzle, more].concat())
    };
    let ran = check(0, "irb4600", &[]);
    let unchecked = "not checked: accelerations of the joints";
    assert!(ran.out.contains(unchecked), "{}", ran.out);
    let line = check(0, "irb4600", &["--json"]).json();
    assert_eq!(line["unchecked_accelerations"], "joints");
    // The same arm with acceleration limits.
    let arm = |limit: u32| {
        shop.write(
            "arm.toml",
            &format!(
                "name = \"Cell 3\"\nlengths_mm = [175, -175, 0, 495, 1095, 1270, 135]\n\
                 offsets_deg = [0, 0, -90, 0, 0, 0]\nsigns = [1, 1, 1, 1, 1, 1]\n\
                 limits_deg = [[-180, 180], [-90, 150], [-180, 75], [-400, 400], [-125, 120], [-400, 400]]\n\
                 speeds_deg_s = [175, 175, 175, 250, 250, 360]\nradii_mm = [200, 170, 110]\n\
                 accelerations_deg_s2 = [{limit}, {limit}, {limit}, {limit}, {limit}, {limit}]\n"
            ),
        );
    };
    arm(50_000);
    let ran = check(0, "arm.toml", &[]);
    assert!(!ran.out.contains("not checked: acc"), "{}", ran.out);
    let alone = "collisions with anything but part and arm";
    let unchecked = format!("not checked: {alone}");
    assert!(ran.out.contains(&unchecked), "{}", ran.out);
    let line = check(0, "arm.toml", &["--json"]).json();
    assert!(line["unchecked_accelerations"].is_null(), "{line}");
    let unchecked = line["not_checked"][0].as_str();
    assert!(
        unchecked.is_some_and(|words| words.starts_with(alone)),
        "{line}"
    );
    // At the first and the last point the arm stops: only the corner needs acceleration.
    arm(10);
    let ran = check(1, "arm.toml", &[]);
    assert!(ran.out.contains("°/s² and has 10"), "{}", ran.out);
    assert!(ran.out.contains("to do: lower the speed"), "{}", ran.out);
    let line = check(1, "arm.toml", &["--json"]).json();
    let kinds = [0, 1, 2].map(|i: usize| &line["points"][i]["problem_kind"]);
    assert!(kinds[0].is_null() && kinds[2].is_null(), "{line}");
    assert_eq!(kinds[1], "joint_acceleration");
    let rail = ["--rail", "-y,-1500,2500,1000", "--json"];
    let line = check(1, "arm.toml", &rail).json();
    assert_eq!(line["unchecked_accelerations"], "rail");
}

#[test]
fn a_better_place_of_the_arm_is_named_as_check_and_export_take_it() {
    let shop = shop_ahead();
    store_path(&shop);
    let arm = ["--arm", "irb4600", "--nozzle", "kuka 0 0 250 0 -45 0"];
    let check = |code: i32, more: &[&str]| {
        let check = ["path", "check", "front_door"];
        shop.coded(code, &[&check[..], &arm, more].concat())
    };
    let export = |code: i32, base: &str| {
        let export = ["path", "export", "front_door", "--output", "paint.mod"];
        shop.coded(code, &[&export[..], &arm, &["--base", base]].concat())
    };
    // Too far from the door, on a rail that stands still.
    let far = "kuka -1800 0 0 0 0 0";
    let rail = ["--rail", "x,0,1500"];
    let ran = check(1, &[&["--base", far], &rail[..]].concat());
    for place in ["with its base moved by", "on its rail"] {
        let line = ran.out.lines().find(|line| line.contains(place));
        let line = line.unwrap_or_else(|| panic!("{place}: {}", ran.out));
        assert!(line.contains("it would reach 3 of 3"), "{line}");
        let base = line.split('"').nth(1).expect("a pose");
        check(0, &["--base", base]);
        check(0, &[&["--base", base], &rail[..]].concat());
        export(0, base);
        let text = shop.read("paint.mod");
        assert!(text.contains("frame: that of the calibration"), "{text}");
    }
    let ran = export(1, far);
    assert!(ran.err.contains("path check front_door"), "{}", ran.err);
    assert!(!shop.path("paint.mod").exists());
    export(0, "kuka 0 0 0 0 0 0");
    assert!(shop.read("paint.mod").contains("frame: robot base"));
    // A placement without an arm is nothing to check.
    let alone = ["path", "export", "front_door", "-o", "paint.mod"];
    shop.coded(2, &[&alone[..], &["--base", far]].concat());
    // The approach points are checked as they will be written.
    shop.coded(
        2,
        &[
            &["path", "check", "front_door"],
            &arm[..],
            &["--approach", "5"],
        ]
        .concat(),
    );
}

#[test]
fn gun_and_arm_are_kept_clear_of_part_boxes_and_floor() {
    let shop = shop_ahead();
    store_path(&shop);
    let arm = ["--arm", "irb4600", "--nozzle", "kuka 0 0 250 0 -45 0"];
    let check = ["path", "check", "front_door", "--json"];
    let with = |code: i32, more: &[&str]| shop.coded(code, &[&check[..], &arm, more].concat());
    let free = with(0, &[]).json();
    assert_eq!(free["num_reached"], 3);
    assert_eq!(free["num_collisions"], 0);
    assert!(free["points"][0]["problem_kind"].is_null(), "{free}");
    // A box around the whole reach of the arm; its place does not depend on the base.
    shop.write(
        "boxes.toml",
        "[[box]]\nname = \"hall\"\ncentre_mm = [0, 0, 0]\nsize_mm = [20000, 20000, 20000]\n",
    );
    let boxes = ["--obstacles", "boxes.toml"];
    let hit = with(1, &boxes).json();
    assert_eq!(hit["num_reached"], 0);
    assert_eq!(hit["num_collisions"], 3);
    assert!(hit["base_shift_mm"].is_null(), "{hit}");
    assert_eq!(hit["points"][0]["problem_kind"], "collision");
    let words = hit["points"][0]["problem"].as_str().expect("a reason");
    assert!(words.ends_with("too near to the box hall"), "{words}");
    // The door itself, with a gun that must keep farther from it than the nozzle is.
    let hit = with(1, &["--gun-radius", "125", "--clearance", "200"]).json();
    let words = hit["points"][0]["problem"].as_str().expect("a reason");
    assert!(words.ends_with("too near to the part"), "{words}");
    // The gun is 250 mm long, and no wider.
    let ran = with(2, &["--gun-radius", "126"]);
    assert!(ran.err.contains("expected 1 to 125 mm"), "{}", ran.err);
    // The foot of the arm is not in the floor; a rail that stands still includes the place of the calibration.
    shop.write("floor.toml", "floor_mm = 300\n");
    let ran = with(2, &["--obstacles", "floor.toml"]);
    assert!(ran.err.contains("above the foot of the arm"), "{}", ran.err);
    let ran = with(2, &["--rail", "y,1000,2000"]);
    assert!(ran.err.contains("but not at 0"), "{}", ran.err);
    // Invalid obstacles are refused.
    for (text, wanted) in [
        ("# nothing\n", "neither a box nor a floor"),
        ("floor_mm = nan\n", "floor_mm is NaN"),
        ("[[box]]\nname = \"a\"\n", "centre_mm"),
        (
            "[[box]]\nname = \"post\"\ncentre_mm = [1.2, 0, 1.9]\nsize_mm = [0.4, 0.4, 1.5]\n",
            "no side of post is 10 mm or longer",
        ),
        ("height_mm = 3\n", "height_mm"),
    ] {
        shop.write("bad.toml", text);
        let ran = with(2, &["--obstacles", "bad.toml"]);
        let is_advised = ran.err.contains("to do: Give each [[box]]");
        assert!(ran.err.contains(wanted) && is_advised, "{}", ran.err);
    }
    for (bad, value, range) in [
        ("--clearance", "nan", "0 to 1000"),
        ("--clearance", "5000", "0 to 1000"),
        ("--gun-radius", "-5", "1 to 1000"),
        // Without a radius the gun's body would not be checked.
        ("--gun-radius", "0", "1 to 1000"),
        ("--speed", "0", "1 to 5000"),
    ] {
        let ran = with(2, &[bad, value]);
        let wanted = format!("expected a number from {range}");
        assert!(ran.err.contains(&wanted), "{bad} {value}: {}", ran.err);
    }
    // Writing a program checks the same obstacles.
    let program = ["inspect", "door.pcd", "--program", "paint.src"];
    shop.coded(2, &[&program[..], &boxes].concat());
    let ran = shop.coded(1, &[&program[..], &arm, &boxes].concat());
    assert!(ran.err.contains("because it would collide"), "{}", ran.err);
    assert!(!shop.path("paint.src").exists());
    shop.coded(0, &[&program[..], &arm, &boxes, &["--force"]].concat());
    let text = shop.read("paint.src").replace("\r\n; ", " ");
    for wanted in [
        "FORCED: ABB IRB 4600",
        "collisions with part, arm and boxes.toml",
        "clearance 20.0 mm, gun radius 50.0 mm",
    ] {
        assert!(text.contains(wanted), "{wanted}: {text:.1500}");
    }
}

#[test]
fn numbers_of_a_program_are_refused_with_their_range_or_unit() {
    let shop = shop();
    store_path(&shop);
    let export = ["path", "export", "front_door", "-o", "paint.src"];
    for (option, value, wanted) in [
        ("--blend", "-5", "expected a number from 0 to 100"),
        ("--speed", "-5", "expected a number from 1 to 5000"),
        ("--approach", "5", "expected a number from 10 to 1000"),
        ("--gun-output", "-5", "expected a number from 0 to 9999"),
        ("--gun-output", "1.5", "expected a whole number, 0 to 9999"),
        ("--nozzle", "kuka 0 0 0.25 0 45 0", "the unit of kuka"),
        (
            "--nozzle",
            "universal-robots 0 0 250 0 0 0",
            "the unit of universal-robots",
        ),
    ] {
        let ran = shop.coded(2, &[&export[..], &[option, value]].concat());
        assert!(ran.err.contains(wanted), "{option}: {}", ran.err);
        assert!(!ran.err.contains("tip:"), "{}", ran.err);
    }
    let check = ["path", "check", "front_door", "--arm", "irb4600"];
    let nozzle = ["--nozzle", "kuka 0 0 0.25 0 45 0"];
    let ran = shop.coded(2, &[&check[..], &nozzle].concat());
    assert!(ran.err.contains("0.250 mm from the flange"), "{}", ran.err);
    assert!(!shop.path("paint.src").exists());
}

#[test]
fn no_program_is_written_for_a_pose_that_another_one_fits_as_well_unless_forced() {
    let shop = Workplace::new();
    let cell = "kuka 1200 -400 1900 86 -5 120";
    shop.coded(0, &["calibrate", "set", cell, "--mount", "eye-to-hand"]);
    // A square bowl looks the same after a quarter turn.
    let mut bowl = String::new();
    for (i, k) in (0..101).flat_map(|i| (0..101).map(move |k| (i, k))) {
        let [x, y] = [i, k].map(|n| 0.005 * f64::from(n) - 0.25);
        let z = 1.2 + 0.5 * (x * x + y * y);
        writeln!(bowl, "{x:.4} {y:.4} {z:.5}").expect("memory");
    }
    shop.write("bowl.xyz", &bowl);
    let library = ["--library", "parts"];
    let run = |code: i32, args: &[&str]| shop.coded(code, &[args, &library[..]].concat());
    run(0, &["enrol", "bowl.xyz", "--name", "bowl"]);
    shop.write(
        "path.csv",
        "nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z\n\
         -40,0,1050,0,0,1\n0,0,1050,0,0,1\n40,0,1050,0,0,1\n",
    );
    run(0, &["library", "path", "bowl", "path.csv"]);
    let inspect = ["inspect", "bowl.xyz", "--program", "paint.src"];
    let ran = run(1, &inspect);
    assert!(ran.out.contains("accepted"), "{}", ran.out);
    let doubt = "another pose of the part fits nearly as well";
    assert!(ran.err.contains(doubt), "{}", ran.err);
    assert!(ran.err.contains("--force"), "{}", ran.err);
    assert!(!shop.path("paint.src").exists());
    let ran = run(0, &[&inspect[..], &["--force"]].concat());
    let warning = format!("warning: written by --force: {doubt}");
    assert!(ran.err.contains(&warning), "{}", ran.err);
    let header = shop.read("paint.src");
    assert!(header.contains(&format!("FORCED: {doubt}")), "{header}");
    let spray = ["inspect", "bowl.xyz", "--spray", "out.json"];
    let ran = run(1, &spray);
    let wanted = format!("no spray path was written: {doubt}");
    assert!(ran.err.contains(&wanted), "{}", ran.err);
    assert!(!shop.path("out.json").exists());
    run(0, &[&spray[..], &["--force"]].concat());
    let written: serde_json::Value = serde_json::from_str(&shop.read("out.json")).expect("JSON");
    assert_eq!(written["doubts"], serde_json::json!([doubt]));
    let unchecked = &written["not_checked"];
    assert_eq!(unchecked[0], "reach and collisions");
}

#[test]
fn no_program_is_written_of_a_path_that_does_not_aim_at_the_part_unless_forced() {
    let shop = shop();
    enrol(&shop, "grille");
    let plan = ["path", "plan", "grille", "--coat", "primer"];
    shop.run(&[&plan[..], &["--output", "grille.csv"]].concat());
    shop.write(
        "far.csv",
        "x_mm,y_mm,z_mm,normal_x,normal_y,normal_z,stand_off_mm\n\
         5000,5000,9000,0,0,-1,150\n5100,5000,9000,0,0,-1,150\n",
    );
    let ran = shop.coded(2, &["library", "path", "front_door", "grille.csv"]);
    assert!(
        ran.err.contains("a path of grille, not of front_door"),
        "{}",
        ran.err
    );
    let named = shop.read("grille.csv");
    let (_, unnamed) = named
        .split_once('\n')
        .expect("the line that names the part");
    shop.write("grille.csv", unnamed);
    // The surface in place of the nozzle.
    let path = ["path", "plan", "front_door", "--coat", "primer"];
    shop.run(&[&path[..], &["--output", "door.csv"]].concat());
    let mut on_door =
        "nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z,gun_on\n"
            .to_owned();
    let planned = shop.read("door.csv");
    for line in planned.lines().filter(|line| !line.starts_with(['#', 'n'])) {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |i: usize| cells[i].parse::<f64>().expect("a number");
        let [x, y, z] = [0, 1, 2].map(|i| number(i) + 150.0 * number(i + 3));
        writeln!(
            on_door,
            "{x},{y},{z},{},{}",
            cells[3..6].join(","),
            cells[7]
        )
        .expect("memory");
    }
    shop.write("on_door.csv", &on_door);
    for path in ["grille.csv", "far.csv", "on_door.csv"] {
        let ran = shop.coded(1, &["library", "path", "front_door", path]);
        let doubt = "the spray path does not aim at the part (";
        assert!(ran.err.contains(doubt), "{}", ran.err);
        for write in [
            ["path", "export", "front_door", "--output", "paint.src"].as_slice(),
            ["inspect", "door.pcd", "--program", "paint.src"].as_slice(),
        ] {
            let ran = shop.coded(1, write);
            let wanted = format!("no program was written: {doubt}");
            assert!(ran.err.contains(&wanted), "{}", ran.err);
            let wanted = "partsight library path front_door";
            assert!(ran.err.contains(wanted), "{}", ran.err);
            assert!(ran.err.contains("--force"), "{}", ran.err);
            assert!(!shop.path("paint.src").exists());
            shop.coded(0, &[write, &["--force"]].concat());
            let text = shop.read("paint.src").replace("\r\n; ", " ");
            assert!(text.contains(&format!("FORCED: {doubt}")), "{text:.1500}");
        }
    }
}

#[test]
fn both_exports_say_how_much_of_the_path_was_checked_against_what_was_seen() {
    let shop = shop();
    let mut path =
        "nozzle_x_mm,nozzle_y_mm,nozzle_z_mm,direction_x,direction_y,direction_z\n".to_owned();
    let mut store = |places: &[f64]| {
        for x in places {
            writeln!(path, "{x},150,1130,0,0,1").expect("memory");
        }
        shop.write("path.csv", &path);
        shop.run(&["library", "path", "front_door", "path.csv"]);
        ["--program", "--spray"].map(|option| {
            let file = if option == "--spray" {
                "out.csv"
            } else {
                "paint.src"
            };
            shop.coded(0, &["inspect", "door.pcd", option, file]).err
        })
    };
    for err in store(&[0.0, 4000.0, 4040.0, 4080.0]) {
        for wanted in [
            "of 1 that aims at what was seen of the part",
            "warning: not checked: reach and collisions\n",
            "warning: not checked: the stand-off at 3 of 4 points",
        ] {
            assert!(err.contains(wanted), "{err}");
        }
    }
    let program = shop.read("paint.src").replace("\r\n; ", " ");
    let table = shop.read("out.csv");
    for wanted in ["reach and collisions", "the stand-off at 3 of 4 points"] {
        assert!(program.contains(wanted), "{program:.1500}");
        assert!(
            table.contains(&format!("# NOT CHECKED: {wanted}")),
            "{table}"
        );
    }
}

#[test]
fn a_program_without_obstacles_names_the_collisions_that_were_not_checked() {
    let shop = shop();
    store_path(&shop);
    let inspect = ["inspect", "door.pcd", "--program", "paint.mod", "--force"];
    let arm = ["--arm", "irb4600", "--nozzle", "kuka 0 0 250 0 45 0"];
    let wanted = "not checked: collisions with anything but part and arm";
    let ran = shop.coded(0, &[&inspect[..], &arm].concat());
    assert!(ran.err.contains(wanted), "{}", ran.err);
    shop.write("boxes.toml", "floor_mm = -5000\n");
    let boxes = ["--obstacles", "boxes.toml"];
    let ran = shop.coded(0, &[&inspect[..], &arm, &boxes].concat());
    assert!(!ran.err.contains(wanted), "{}", ran.err);
}

#[test]
fn a_source_is_no_file_to_write_a_program_for() {
    let shop = shop();
    let source = ["--source", "simulated:fender", "--frames", "1"];
    let program = ["--program", "paint.src"];
    let ran = shop.coded(2, &[&["inspect"], &source[..], &program].concat());
    let wanted = "--program takes a capture's file, not a source";
    assert!(ran.err.contains(wanted), "{}", ran.err);
    assert!(ran.err.contains("partsight capture"), "{}", ran.err);
}

#[test]
fn a_rail_that_moves_along_the_path_is_an_axis_of_the_program() {
    let shop = shop_ahead();
    store_path(&shop);
    let arm = ["--arm", "irb4600", "--nozzle", "kuka 0 0 250 0 -45 0"];
    let rail = ["--rail", "-y,-1500,2500,1000"];
    let check = ["path", "check", "front_door", "--json"];
    let line = shop.coded(0, &[&check[..], &arm, &rail].concat()).json();
    assert_eq!(line["num_reached"], 3);
    let [low, high] = [0_usize, 1].map(|i| line["rail_range_mm"][i].as_f64().expect("mm"));
    assert!(-1500.0 <= low && low <= high && high <= 2500.0, "{line}");
    let at = line["points"][1]["rail_mm"].as_f64().expect("mm");
    assert!((low..=high).contains(&at), "{line}");
    let line = shop.coded(0, &[&check[..], &arm].concat()).json();
    assert!(line["rail_range_mm"].is_null() && line["points"][1]["rail_mm"].is_null());

    let export = |file: &str, code: i32| {
        let export = ["path", "export", "front_door", "--output", file];
        shop.coded(code, &[&export[..], &arm, &rail].concat())
    };
    export("paint.mod", 0);
    let text = shop.read("paint.mod");
    assert!(text.contains("! rail: eax_a, mm"), "{text}");
    let ran = export("paint.script", 2);
    assert!(
        ran.err.contains("no axis for the arm's rail"),
        "{}",
        ran.err
    );
    assert!(!shop.path("paint.script").exists());

    for bad in ["sideways", "y,0", "y,5,-5", "y,0,5,0"] {
        let ran = shop.coded(2, &[&check[..], &arm, &["--rail", bad]].concat());
        assert!(ran.err.contains("to do: "), "{}", ran.err);
        assert!(ran.err.contains("rail"), "{}", ran.err);
    }
}
