//! `partsight path plan` and `path simulate`.

use std::fmt::Write as _;

use crate::workplace::Workplace;

#[test]
fn a_path_is_planned_written_read_and_simulated_to_the_same_film() {
    let shop = Workplace::new();
    let plan = [
        "path",
        "plan",
        "fender",
        "--coat",
        "primer",
        "--propose",
        "--json",
    ];
    let planned = shop
        .coded(0, &[&plan[..], &["--output", "path.csv"]].concat())
        .json();
    assert!(planned["within"].as_f64().expect("a share") > 0.95);
    assert_eq!(planned["schema"], 1);
    let speed = format!("speed={}", planned["speed_mm_s"]);
    let spacing = format!("spacing={}", planned["spacing_mm"]);
    let simulate = ["path", "simulate", "fender", "--coat", "primer", "--json"];
    let ran = shop.coded(0, &[&simulate[..], &["--path", "path.csv"]].concat());
    let mean = |line: &serde_json::Value| line["mean_um"].as_f64().expect("a number");
    assert!((mean(&ran.json()) / mean(&planned) - 1.0).abs() < 1e-3);
    // The same values given by `--set`.
    let set = ["--set", &spacing, "--set", &speed, "--store", "--json"];
    let again = shop.coded(0, &[&plan[..5], &set].concat()).json();
    assert!((mean(&again) / mean(&planned) - 1.0).abs() < 1e-6);
    assert_eq!(
        shop.coded(0, &simulate).json()["num_points"],
        planned["num_points"]
    );
}

#[test]
fn a_sphere_is_kept_out_of_the_paint() {
    let shop = Workplace::new();
    let plan = ["path", "plan", "fender", "--coat", "primer", "--json"];
    let paint = |line: &serde_json::Value| line["paint_ml"].as_f64().expect("a number");
    let whole = paint(&shop.run(&plan).json());
    let kept = ["--keep-out", "0 0 1300 250"];
    let less = paint(&shop.run(&[&plan[..], &kept].concat()).json());
    assert!(less < 0.95 * whole, "{less} of {whole}");
    // In metres it would keep nothing out.
    let metres = ["--keep-out", "0 0 1300 250", "--keep-out", "0 0 1.3 0.25"];
    let ran = shop.run(&[&plan[..5], &metres].concat());
    let warning = "warning: --keep-out \"0 0 1.3 0.25\" touches no point of the surface";
    assert!(ran.err.contains(warning), "{}", ran.err);
    assert!(
        ran.err.contains("millimetres") && !ran.err.contains("0 0 1300 250"),
        "{}",
        ran.err
    );
    // The path is neither written nor stored.
    let last = ran.out.lines().last().unwrap_or_default();
    assert!(last.contains("not kept"), "{}", ran.out);
    let no_sphere = ["--keep-out", "0 0 1300"];
    let ran = shop.coded(2, &[&plan[..], &no_sphere].concat());
    assert!(ran.err.contains("four numbers"), "{}", ran.err);
    let no_radius = ["--keep-out", "0 0 1300 -1"];
    let ran = shop.coded(2, &[&plan[..], &no_radius].concat());
    assert!(ran.err.contains("without a radius"), "{}", ran.err);
}

#[test]
fn what_cannot_be_planned_is_refused_with_advice_and_writes_nothing() {
    let shop = Workplace::new();
    let plan = ["path", "plan", "fender", "--output", "path.csv", "--coat"];
    let ran = shop.coded(2, &[&plan[..], &["primr"]].concat());
    assert!(ran.err.contains("nearest name is primer"), "{}", ran.err);
    let ran = shop.coded(2, &[&plan[..], &["zinc"]].concat());
    assert!(ran.err.contains("Give one of primer, "), "{}", ran.err);
    let ran = shop.coded(
        2,
        &[&plan[..], &["primer", "--set", "gun.width=0"]].concat(),
    );
    assert!(ran.err.contains("from 10 to 1000 mm"), "{}", ran.err);
    let simulate = ["path", "simulate", "fender", "--coat", "primer"];
    let ran = shop.coded(2, &simulate);
    assert!(ran.err.contains("path plan fender"), "{}", ran.err);
    assert!(!shop.path("path.csv").exists());
}

#[test]
fn a_gun_is_fitted_to_a_stripe_and_written_as_a_coat_that_plans() {
    let shop = Workplace::new();
    // A pattern 240 mm wide at 180 mm: σ = 60 mm, 40 µm in the middle; sampled every 10 mm.
    let mut table = "offset_mm,thickness_um,remark\n".to_owned();
    for k in -15..=15 {
        let x = 10.0 * f64::from(k);
        let t = 40.0 * (-0.5 * (x / 60.0).powi(2)).exp();
        writeln!(table, "{},{t:.3},", x + 500.0).expect("written");
    }
    shop.write("stripe.csv", &table);
    let fit = [
        "path",
        "fit",
        "stripe.csv",
        "--coat",
        "primer",
        "--distance",
        "180",
        "--speed",
        "200",
    ];
    let write = ["--output", "my_primer.toml"];
    let ran = shop.coded(0, &[&fit[..], &write].concat());
    assert!(
        ran.out.contains("Gaussian, 240.0 mm wide at 180 mm"),
        "{}",
        ran.out
    );
    assert!(
        ran.out.contains("middle of the stripe at 500.0 mm"),
        "{}",
        ran.out
    );
    let written = shop.read("my_primer.toml");
    // 40 µm · √(2π) · 60 mm · 200 mm/s of 180 ml/min · 50 %: 80.2 %.
    assert!(written.contains("gun.transfer = \"80.2"), "{written}");
    // An existing file is only replaced if asked to.
    let ran = shop.coded(2, &[&fit[..], &write].concat());
    assert!(
        ran.err.contains("exists already") && ran.err.contains("--force"),
        "{}",
        ran.err
    );
    assert_eq!(shop.read("my_primer.toml"), written);
    shop.coded(0, &[&fit[..], &write, &["--force"]].concat());
    let plan = [
        "path",
        "plan",
        "fender",
        "--coat",
        "./my_primer.toml",
        "--propose",
        "--json",
    ];
    let planned = shop.coded(0, &plan).json();
    assert!(planned["within"].as_f64().expect("a share") > 0.9);
}

#[test]
fn what_is_no_stripe_is_refused_with_advice() {
    let shop = Workplace::new();
    let fit = ["path", "fit", "stripe.csv", "--coat", "primer"];
    for (text, wanted) in [
        ("x,y\n1,2\n", "offset_mm and thickness_um"),
        ("offset_mm,thickness_um\n1,2\n3\n", "line 3"),
        (
            "offset_mm,thickness_um\n1,2\n3,-0.5\n",
            "line 3: -0.5 is no thickness in µm, expected 0 to 10000",
        ),
        ("offset_mm,thickness_um\n1,2\n3,1e9\n", "is no thickness"),
        ("offset_mm,thickness_um\n1,2\nnan,4\n", "line 3"),
        ("offset_mm,thickness_um\n1,NaN\n3,4\n", "line 2"),
        ("offset_mm,thickness_um\n-20000,2\n3,4\n", "is no offset"),
        ("offset_mm,thickness_um\n1,2\n3,4\n", "2 places"),
    ] {
        shop.write("stripe.csv", text);
        let ran = shop.coded(2, &fit);
        assert!(
            ran.err.contains(wanted) && ran.err.contains("to do:"),
            "{}",
            ran.err
        );
    }
}

#[test]
fn the_stored_path_is_exported_to_each_controller_unless_the_arm_does_not_reach_it() {
    let shop = Workplace::new();
    let ran = shop.coded(
        0,
        &["path", "plan", "fender", "--coat", "primer", "--store"],
    );
    assert!(!ran.out.contains("not kept"), "{}", ran.out);
    let export = ["path", "export", "fender"];
    let ran = shop.coded(2, &[&export[..], &["-o", "paint.src"]].concat());
    assert!(ran.err.contains("where the camera sits"), "{}", ran.err);
    let cell = "kuka 1200 -400 1900 86 -5 120";
    shop.coded(0, &["calibrate", "set", cell, "--mount", "eye-to-hand"]);
    for (format, file, wanted) in [
        ("krl", "paint.src", "DEF paint ( )"),
        ("ls", "paint.ls", "/PROG  PAINT"),
        ("rapid", "paint.mod", "PROC run_paint()"),
        ("urscript", "paint.txt", "def paint():"),
        ("jbi", "paint.jbi", "//NAME PAINT"),
        ("drl", "paint.drl", "movejx(posx("),
    ] {
        shop.coded(0, &[&export[..], &["--as", format, "-o", file]].concat());
        let text = shop.read(file);
        for wanted in [wanted, "part: fender", "gun: output 1"] {
            assert!(text.contains(wanted), "{file} {wanted}: {text:.600}");
        }
        assert!(!text.contains("FORCED"));
    }
    // No controller reads another one's language from the file's ending.
    let ran = shop.coded(
        2,
        &[&export[..], &["--as", "rapid", "-o", "other.src"]].concat(),
    );
    assert!(
        ran.err.contains("that of KUKA KRL") && ran.err.contains("in .mod"),
        "{}",
        ran.err
    );
    assert!(!shop.path("other.src").exists());
    // The part is out of the arm's reach, so the earlier program is removed.
    let arm = [
        "-o",
        "paint.src",
        "--arm",
        "kr6-r900",
        "--nozzle",
        "kuka 0 0 250 0 0 0",
    ];
    let ran = shop.coded(1, &[&export[..], &arm].concat());
    assert!(
        ran.err.contains("misses") && ran.err.contains("--force"),
        "{}",
        ran.err
    );
    assert!(!shop.path("paint.src").exists());
    shop.coded(0, &[&export[..], &arm, &["--force"]].concat());
    assert!(
        shop.read("paint.src")
            .contains("FORCED: KUKA KR 6 R900-2 misses")
    );
    let ran = shop.coded(2, &["path", "export", "grille", "-o", "paint.src"]);
    assert!(ran.err.contains("path plan grille"), "{}", ran.err);
    assert!(!shop.path("paint.src").exists());
}

#[test]
fn a_program_that_would_leave_a_worse_film_than_planned_is_refused_unless_forced() {
    let shop = Workplace::new();
    let plan = ["path", "plan", "grille", "--coat", "primer"];
    shop.coded(0, &[&plan[..], &["--propose", "--store"]].concat());
    let cell = "kuka 1200 -400 1900 86 -5 120";
    shop.coded(0, &["calibrate", "set", cell, "--mount", "eye-to-hand"]);
    let export = ["path", "export", "grille", "-o"];
    let ran = shop.coded(0, &[&export[..], &["paint.script"]].concat());
    assert!(ran.err.contains("film: "), "{}", ran.err);
    let text = shop.read("paint.script");
    assert!(text.contains("a=4.000") && text.contains("film: "));
    // Doosan's robots stop at every switch of the gun.
    let ran = shop.coded(1, &[&export[..], &["paint.drl"]].concat());
    for wanted in ["the program would bring", "were planned", "--force"] {
        assert!(ran.err.contains(wanted), "{wanted}: {}", ran.err);
    }
    assert!(!shop.path("paint.drl").exists());
    shop.coded(0, &[&export[..], &["paint.drl", "--force"]].concat());
    assert!(
        shop.read("paint.drl")
            .contains("FORCED: the program would bring")
    );
    // A program does not ignore a tool.
    let ran = shop.coded(
        2,
        &[&export[..], &["paint.script", "--tool", "gun"]].concat(),
    );
    assert!(ran.err.contains("does not use the tool"), "{}", ran.err);
}

/// A closed box of 800 by 500 by 20 mm above the origin, z up.
fn plate() -> String {
    let mut text = String::new();
    for [x, y, z] in [0, 1, 2, 3, 4, 5, 6, 7].map(|i| [i & 1, (i >> 1) & 1, i >> 2]) {
        let [x, y, z] = [0.8 * f64::from(x), 0.5 * f64::from(y), 0.02 * f64::from(z)];
        writeln!(text, "v {x} {y} {z}").expect("written");
    }
    // Corners by their binary number, outwards.
    for face in [
        "1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6",
    ] {
        writeln!(text, "f {face}").expect("written");
    }
    text
}

#[test]
fn a_part_whose_outside_is_not_clear_is_planned_from_the_side_that_a_person_gives() {
    let shop = Workplace::new();
    shop.write("plate.obj", &plate());
    let enrol = ["enrol", "plate.obj", "--name", "plate", "--up", "z"];
    let ran = shop.coded(0, &enrol);
    assert!(
        ran.err.contains("not clear which side") && ran.err.contains("--side top"),
        "{}",
        ran.err
    );
    let plan = ["path", "plan", "plate", "--coat", "primer", "--propose"];
    let ran = shop.coded(2, &plan);
    assert!(ran.err.contains("--side top"), "{}", ran.err);
    let json = [&plan[..], &["--json"]].concat();
    // For one plan alone, then for good.
    for (given, stored) in [
        (&["--side", "top"][..], None),
        (&["--side", "bottom", "--store"], Some("bottom")),
    ] {
        let planned = shop.coded(0, &[&json[..], given].concat()).json();
        assert_eq!(planned["side"], given[1]);
        assert_eq!(shop.run(&json).code == 0, stored.is_some());
    }
    assert_eq!(shop.coded(0, &json).json()["side"], "bottom");
    let simulate = ["path", "simulate", "plate", "--coat", "primer", "--json"];
    assert_eq!(shop.run(&simulate).json()["side"], "bottom");
    let ran = shop.coded(0, &["library", "show", "plate"]);
    assert!(ran.out.contains("the bottom"), "{}", ran.out);
    // Given when it is enrolled, nothing is unclear.
    let ran = shop.coded(0, &[&enrol[..], &["--side", "top"]].concat());
    assert!(
        ran.out.contains("the top") && !ran.err.contains("side"),
        "{}",
        ran.err
    );
    assert_eq!(shop.coded(0, &json).json()["side"], "top");
    let ran = shop.coded(2, &[&enrol[..], &["--side", "up"]].concat());
    assert!(ran.err.contains("front, back, left"), "{}", ran.err);
}
