//! Aligning clouds, and what is measured.

use std::fs;

use serde_json::Value;

use crate::workplace::{Workplace, matrix};

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
