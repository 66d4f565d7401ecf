//! `partsight path plan` and `path simulate`.

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
    let speed = format!("speed={}", planned["speed_mm_s"]);
    let spacing = format!("spacing={}", planned["spacing_mm"]);
    let simulate = ["path", "simulate", "fender", "--coat", "primer", "--json"];
    let ran = shop.coded(0, &[&simulate[..], &["--path", "path.csv"]].concat());
    let mean = |line: &serde_json::Value| line["mean_um"].as_f64().expect("a number");
    assert!((mean(&ran.json()) / mean(&planned) - 1.0).abs() < 1e-3);
    // The same by settings.
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
