use std::cell::Cell;

use rand::RngExt as _;

use super::*;
use crate::pose::{AlignParams, PoseMethod, align, align_with};
use geometry::{cloud::PointCloud, fixtures::moved};

/// A bent sheet with a notch, drawn anew from each seed, with noise of so many metres either way.
fn sheet(seed: u64, noise: f32) -> PointCloud {
    let mut rng = Pcg64::seed_from_u64(seed);
    let points = (0..4000).filter_map(|_| {
        let (u, v) = (rng.random::<f32>(), 0.8 * rng.random::<f32>());
        let off = noise * rng.random_range(-1.0..=1.0);
        let is_notch = u > 0.6 && v > 0.5;
        (!is_notch).then(|| Point3::new(u, v, 0.3 * u * u + 0.1 * (5.0 * v).sin() * u + off))
    });
    PointCloud::from_points(points)
}

/// T4 and T5 of eq. 15.
fn t4_and_t5() -> [RigidTransform; 2] {
    use std::f64::consts::PI;
    [
        [0.6 * PI, 0.3 * PI, 0.4 * PI, 0.3, 0.2, 0.4],
        [0.3 * PI, 0.1 * PI, 0.6 * PI, 0.4, 0.6, 0.3],
    ]
    .map(from_euler_zyx)
}

#[test]
fn t4_and_t5_are_undone_where_icp_alone_is_stuck() {
    let target = sheet(7, 0.0);
    for source_from_target in t4_and_t5() {
        let source = moved(&target, &source_from_target);
        let stuck = align(&source, &target, PoseMethod::Icp, None).expect("a pose");
        assert!(stuck.fit.e_m2 > 1e-4, "{:?}", stuck.fit);
        let found = align(&source, &target, PoseMethod::IcpGa, None).expect("a pose");
        assert_eq!(found.stopped, Stopped::BelowThreshold);
        assert!(found.fit.e_m2 < 1e-6, "{:?}", found.fit);
        let middle = source_from_target * Point3::new(0.5, 0.3, 0.1);
        let error = pose_error(
            &found.target_from_source,
            &source_from_target.inverse(),
            &middle,
        );
        assert!(
            error.rotation.degrees() < 0.01 && error.shift.mm() < 0.1,
            "{error:?}"
        );
        assert!(!found.is_ambiguous());
        let num = |phase| found.iterations.iter().filter(|i| i.phase == phase).count();
        assert!(num(Phase::Icp) > 0 && num(Phase::Genetic) > 0);
        assert_eq!(found.iterations[0].phase, Phase::Icp, "ICP comes first");
    }
}

#[test]
fn noise_that_keeps_e_above_the_target_ends_the_search_at_a_good_pose() {
    let (target, other) = (sheet(7, 0.003), sheet(8, 0.003));
    let [source_from_target, _] = t4_and_t5();
    let source = moved(&other, &source_from_target);
    let found = align(&source, &target, PoseMethod::IcpGa, None).expect("a pose");
    assert_eq!(found.stopped, Stopped::NoProgress);
    assert!(found.fit.e_m2 > 1e-6);
    let middle = source_from_target * Point3::new(0.5, 0.3, 0.1);
    let error = pose_error(
        &found.target_from_source,
        &source_from_target.inverse(),
        &middle,
    );
    assert!(
        error.rotation.degrees() < 1.5 && error.shift.mm() < 15.0,
        "{error:?}"
    );
}

#[test]
fn the_same_seed_gives_the_same_bits_on_any_number_of_threads() {
    let target = sheet(7, 0.001);
    let [_, source_from_target] = t4_and_t5();
    let source = moved(&sheet(8, 0.001), &source_from_target);
    // Some rounds are enough: each takes the same steps.
    let mut params = AlignParams::from(PoseMethod::IcpGa);
    params.icp_ga.max_rounds = 6;
    let run = || align_with(&source, &target, &params, None, &|| false).expect("a pose");
    let alone = run();
    std::thread::scope(|scope| {
        let runs = [(); 4].map(|()| scope.spawn(run));
        for run in runs {
            assert_eq!(run.join().expect("ends"), alone);
        }
    });
}

#[test]
fn a_cancelled_search_ends_soon_whenever_it_is_cancelled() {
    let target = sheet(7, 0.0);
    let [source_from_target, _] = t4_and_t5();
    let source = moved(&target, &source_from_target);
    for method in [PoseMethod::Icp, PoseMethod::IcpGa, PoseMethod::Global] {
        for patience in [0, 3, 8] {
            let num_asked = Cell::new(0);
            let is_cancelled = || {
                num_asked.set(num_asked.get() + 1);
                num_asked.get() > patience
            };
            let ended = align_with(&source, &target, &method.into(), None, &is_cancelled);
            assert_eq!(ended, Err(PoseError::Cancelled), "{method:?}");
            // Asked once to stop, and once more at most on the way out.
            assert!(num_asked.get() <= patience + 2, "{}", num_asked.get());
        }
    }
}

#[test]
fn a_start_given_is_where_the_search_begins() {
    let target = sheet(7, 0.0);
    let [source_from_target, _] = t4_and_t5();
    let source = moved(&target, &source_from_target);
    let start = source_from_target.inverse();
    let found = align(&source, &target, PoseMethod::IcpGa, Some(start)).expect("a pose");
    assert_eq!(found.stopped, Stopped::BelowThreshold);
    assert!(found.iterations.iter().all(|i| i.phase == Phase::Icp));
    assert!(found.iterations.len() < 5, "{}", found.iterations.len());
}

#[test]
fn parameters_survive_a_file_and_what_a_file_leaves_out_is_the_default() {
    let params = AlignParams {
        method: PoseMethod::IcpGa,
        icp_ga: IcpGaParams {
            seed: 7,
            shift_range: 0.25,
            ..IcpGaParams::default()
        },
        ..AlignParams::default()
    };
    let text = serde_json::to_string(&params).expect("written");
    assert!(text.contains("\"icp-ga\""), "{text}");
    assert_eq!(
        serde_json::from_str::<AlignParams>(&text).expect("read"),
        params
    );
    let short: IcpGaParams = serde_json::from_str(r#"{"patience":3}"#).expect("read");
    let expected = IcpGaParams {
        patience: 3,
        ..IcpGaParams::default()
    };
    assert_eq!(short, expected);
}
