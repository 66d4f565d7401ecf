//! Enrolling parts and managing the library.

use std::{fs, path::Path};

use serde_json::Value;

use crate::workplace::{Workplace, matrix};

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
        assert_eq!(line["simulated"], true);
        assert_eq!(line["accepted"], true);
        assert_eq!(line["reason"], Value::Null);
        assert_eq!(line["reason_kind"], Value::Null);
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
    assert!(verify.out.contains("OK       grille"), "{}", verify.out);
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
    if cfg!(windows) {
        // A window would open: there is always a desktop.
        return;
    }
    let first = place.accepted(&[]);
    assert!(
        first.out.contains("Simulated") && first.out.contains("front_door: accepted"),
        "{}",
        first.out
    );
}

#[test]
fn a_bad_name_is_refused_with_the_rule_and_a_name_that_follows_it() {
    let place = Workplace::new();
    for arguments in [
        &["enrol", "door.pcd", "--name", "Front Door"][..],
        &["library", "show", "Front Door"],
        &["path", "export", "Front Door", "-o", "paint.src"],
        &["recipe", "save", "Front Door"],
    ] {
        let ran = place.coded(2, arguments);
        let wanted =
            "to do: Use up to 64 lowercase letters, digits, _ and -, for example front_door";
        assert!(ran.err.contains(wanted), "{}", ran.err);
    }
}

#[test]
fn a_part_is_enrolled_into_the_users_library_wherever_that_is_done() {
    let place = Workplace::new();
    // As in the checkout, where the folder is under version control.
    fs::create_dir(place.path("reference_parts")).expect("made");
    place.accepted(&["simulate", "--part", "grille", "--out", "grille.pcd"]);
    place.accepted(&["enrol", "grille.pcd", "--name", "mine"]);
    let here = fs::read_dir(place.path("reference_parts")).expect("listed");
    assert_eq!(here.count(), 0, "somebody else's library was changed");
    assert!(place.path("data/partsight/library/mine/part.toml").exists());
    let list = place.accepted(&["library", "list"]);
    assert!(list.out.contains("(your own): 9 parts"), "{}", list.out);
    // Whatever is run while it is away, the shipped parts do not take its place.
    let own = place.path("data/partsight/library");
    fs::rename(&own, place.path("away")).expect("moved");
    let refused = place.coded(2, &["inspect", "grille.pcd"]);
    assert!(refused.err.contains("no longer there"), "{}", refused.err);
    assert!(!own.exists());
    fs::rename(place.path("away"), &own).expect("moved back");
    // A folder of one's own in place of the system's.
    let with_data = |folder: &Path, args: &[&str]| {
        let mut command = place.command(args);
        command.env("PARTSIGHT_DATA", folder);
        command.output().expect("starts")
    };
    let elsewhere = |args: &[&str]| with_data(&place.path("stick"), args);
    assert!(elsewhere(&["inspect", "grille.pcd"]).status.success());
    assert!(place.path("stick/library/grille/part.toml").exists());
    assert!(place.path("stick/history.sqlite").exists());
    let list = String::from_utf8(elsewhere(&["library", "list"]).stdout).expect("text");
    assert!(list.contains("(your own): 8 parts"), "{list}");
    // A relative path starts at the working folder.
    let here = with_data(Path::new("here"), &["library", "list"]);
    assert!(here.status.success());
    assert!(place.path("here/library/grille/part.toml").exists());
    // An empty one is none. On Windows the system's folder is not one of these tests.
    if cfg!(not(windows)) {
        let usual = with_data(Path::new(""), &["library", "list"]);
        let list = String::from_utf8(usual.stdout).expect("text");
        assert!(list.contains("(your own): 9 parts"), "{list}");
    }
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
fn without_a_name_the_meshes_of_a_file_are_listed_the_longest_first() {
    let place = Workplace::new();
    let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.5, 0.0]];
    let bytes = corners.as_flattened().iter().flat_map(|x| x.to_le_bytes());
    let bytes: Vec<u8> = bytes.collect();
    fs::write(place.path("car.bin"), bytes).expect("written");
    let text = r#"{"asset":{"version":"2.0"},
        "nodes":[{"name":"Door_FL","mesh":0},{"name":"Hood","mesh":0,"scale":[2,2,2]}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,0.5,0]}],
        "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"car.bin"}]}"#;
    fs::write(place.path("car.gltf"), text).expect("written");
    let ran = place.run(&["enrol", "car.gltf", "--name", "hood", "--library", "parts"]);
    assert_eq!(ran.code, 2);
    let lines: Vec<&str> = ran.err.lines().collect();
    let expected = [
        "mesh Hood: 2000 x 1000 x 0 mm, 1 triangle",
        "mesh Door_FL: 1000 x 500 x 0 mm, 1 triangle",
    ];
    assert_eq!(lines[..2], expected, "{}", ran.err);
    assert!(ran.err.contains("car.gltf#Door_FL"), "{}", ran.err);
    // An OBJ is one part, if it can be one.
    let obj = "o Door\nv 0 0 0\nv 1 0 0\nv 0 0.5 0\nf 1 2 3\no Hood\nv 9 0 0\nv 11 0 0\nv 9 1 0\nf 4 5 6\n";
    fs::write(place.path("car.obj"), obj).expect("written");
    let ran = place.run(&["enrol", "car.obj", "--name", "hood", "--library", "parts"]);
    assert_eq!(ran.code, 2);
    for named in [
        "mesh Hood: 2000 x 1000 x 0 mm",
        "the part spans",
        "such as car.obj#Hood",
    ] {
        assert!(ran.err.contains(named), "{}", ran.err);
    }
    assert!(!place.path("parts").exists());
}

#[test]
fn a_damaged_cloud_is_set_aside_by_its_checksum() {
    let place = Workplace::new();
    place.with_part("fender");
    place.with_part("grille");
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
    assert_eq!(verify.out.matches("OK  ").count(), 8, "{}", verify.out);
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
    // On Windows a window would open.
    if !cfg!(windows) {
        assert!(place.accepted(&[]).out.contains("front_door: accepted"));
    }
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
    place.with_part("grille");
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
    place.with_part("fender");
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
    // On Windows a window would open: there is always a desktop.
    if !cfg!(windows) {
        let bare = place.accepted(&["--library", "parts"]);
        assert!(bare.out.contains("Simulated"), "{}", bare.out);
    }
    assert_eq!(
        place.run(&["--library", "parts", "library", "list"]).code,
        2
    );
}

#[test]
fn verify_tells_newer_from_damaged_and_names_what_it_skipped() {
    let place = Workplace::new();
    place.with_part("fender");
    fs::create_dir(place.path("parts/next")).expect("made");
    fs::write(place.path("parts/next/part.toml"), "schema_version = 9\n").expect("written");
    fs::create_dir(place.path("parts/My Door")).expect("made");
    let verify = place.run(&["library", "verify", "--library", "parts"]);
    assert_eq!(verify.code, 1);
    assert!(
        verify
            .out
            .contains("NEWER    next: part.toml: made by a newer"),
        "{}",
        verify.out
    );
    assert!(verify.out.contains("skipped  My Door"), "{}", verify.out);
    assert!(!verify.out.contains("DAMAGED"), "{}", verify.out);
}

#[test]
fn one_more_reference_of_a_part_is_named_and_goes_with_it() {
    let place = Workplace::new();
    place.with_part("fender");
    let of = |part: &'static str, name: &'static str, library: &'static str| {
        let enrol = ["enrol", "fender.pcd", "--as", part];
        [&enrol[..], &["--name", name, "--library", library]].concat()
    };
    let unknown = place.coded(2, &of("nothere", "fender_b", "parts"));
    assert!(
        unknown.err.contains("no part named nothere; it has fender"),
        "{}",
        unknown.err
    );
    assert!(!place.path("parts/fender_b").exists());
    let empty = place.coded(2, &of("fender", "fender_b", "none"));
    assert!(empty.err.contains("the library is empty"), "{}", empty.err);
    assert!(!place.path("none").exists());

    let enrolled = place.accepted(&of("fender", "fender_b", "parts"));
    assert!(
        enrolled
            .out
            .contains("Enrolled fender_b as one more reference of fender"),
        "{}",
        enrolled.out
    );
    // The part may be named by any of its references.
    place.accepted(&of("fender_b", "fender_c", "parts"));
    let library = |code: i32, args: &[&str]| {
        place.coded(code, &[&["library", "--library", "parts"], args].concat())
    };
    let list = library(0, &["list"]).out;
    assert!(list.contains("fender_b (reference of fender)"), "{list}");
    assert!(list.contains("fender_c (reference of fender)"), "{list}");
    let shown = library(0, &["show", "fender_b"]).out;
    assert!(shown.contains("reference of  fender\n"), "{shown}");
    let own = library(0, &["show", "fender"]).out;
    assert!(!own.contains("reference of"), "{own}");

    let renamed = library(0, &["rename", "fender", "--to", "wing"]).out;
    assert!(
        renamed.contains("2 more references of it were renamed along"),
        "{renamed}"
    );
    assert!(
        place
            .read("parts/fender_b/part.toml")
            .contains("part = \"wing\"")
    );
    let inspect = ["inspect", "fender.pcd", "--json", "--library", "parts"];
    assert_eq!(place.accepted(&inspect).lines()[0]["part"], "wing");

    let removed = library(0, &["remove", "wing"]).out;
    assert!(
        removed.contains("fender_b is still a reference of wing, and keeps that name"),
        "{removed}"
    );
    assert_eq!(place.accepted(&inspect).lines()[0]["part"], "wing");
    library(0, &["restore", "wing"]);
}

#[test]
fn a_part_with_references_of_its_own_becomes_none_of_another_part() {
    let place = Workplace::new();
    place.with_part("fender");
    place.with_part("grille");
    let more = |name, of| {
        let enrol = ["enrol", "grille.pcd", "--name", name, "--as", of];
        [&enrol[..], &["--library", "parts"]].concat()
    };
    place.accepted(&more("grille_b", "grille"));
    let before = place.read("parts/grille/part.toml");
    let refused = place.coded(2, &more("grille", "fender"));
    assert!(
        refused.err.contains("references of its own, grille_b"),
        "{}",
        refused.err
    );
    assert!(refused.err.contains("library rename grille"));
    assert_eq!(place.read("parts/grille/part.toml"), before);
}

#[test]
fn a_damaged_part_is_not_restored_over_a_sound_one() {
    let place = Workplace::new();
    place.with_part("fender");
    let cloud = place.path("parts/fender/cloud.ply");
    fs::write(&cloud, "x").expect("written");
    let library = |code: i32, args: &[&str]| {
        place.coded(code, &[&["library", "--library", "parts"], args].concat())
    };
    library(0, &["remove", "fender"]);
    place.accepted(&[
        "enrol",
        "fender-reference.pcd",
        "--name",
        "fender",
        "--library",
        "parts",
    ]);
    let sound = fs::read(&cloud).expect("there");
    let refused = library(2, &["restore", "fender"]);
    assert!(
        refused.err.contains("the removed part is damaged"),
        "{}",
        refused.err
    );
    assert_eq!(fs::read(&cloud).expect("there"), sound);
}

#[test]
fn a_rename_without_a_new_name_says_what_it_changed() {
    let place = Workplace::new();
    place.with_part("fender");
    let rename = ["library", "rename", "fender", "--library", "parts"];
    let nothing = place.coded(2, &rename);
    assert!(
        nothing.err.contains("nothing to change") && nothing.err.contains("--to NAME"),
        "{}",
        nothing.err
    );
    let titled = place.accepted(&[&rename[..], &["--title", "Left wing"]].concat());
    assert_eq!(titled.out, "The title of fender is now: Left wing\n");
}

#[test]
fn a_title_that_another_part_has_is_warned_about() {
    let place = Workplace::new();
    place.with_part("fender");
    place.with_part("grille");
    let rename = ["library", "rename", "--library", "parts", "--title"];
    let titled = |title: &str, name: &str| {
        let ran = place.accepted(&[&rename[..], &[title, name]].concat());
        ran.err.contains("fender has the title")
    };
    assert!(!titled("Left wing", "fender"), "its own");
    assert!(titled("left wing", "grille"));
    assert!(!titled("Grille", "grille"));
    let enrol = ["enrol", "grille-reference.pcd", "--library", "parts"];
    let more = ["--name", "grille_b", "--title", "Left wing"];
    let enrolled = place.accepted(&[&enrol[..], &more].concat());
    assert!(
        enrolled
            .err
            .contains("fender has the title \"Left wing\" too"),
        "{}",
        enrolled.err
    );
    // References of one part may share a title.
    let of = ["--as", "fender"];
    let again = place.accepted(&[&enrol[..], &more, &of].concat());
    assert!(!again.err.contains("has the title"), "{}", again.err);
}

#[test]
fn what_cannot_be_told_apart_is_named_as_it_can_be_removed() {
    let place = Workplace::new();
    place.with_part("fender");
    place.with_part("grille");
    let more = ["--name", "grille_b", "--as", "grille", "--library", "parts"];
    let alike = place.accepted(&[&["enrol", "fender-reference.pcd"], &more[..]].concat());
    assert!(
        alike
            .err
            .contains("partsight library remove grille_b` or `partsight library remove fender`"),
        "{}",
        alike.err
    );
}
