//! How the robot moves along a written program.

use super::*;

/// Points on a line, this far apart, with these speeds to the next; the gun is on from the second to the last but one.
fn straight(apart: f64, speeds: &[f64]) -> Vec<ProgramPoint> {
    let points = speeds.iter().enumerate().map(|(i, speed)| ProgramPoint {
        robot_from_nozzle: Isometry3::translation(1.0, apart * i as f64, 0.7),
        is_gun_on: (1..speeds.len() - 2).contains(&i),
        speed: Some(*speed),
    });
    points.collect()
}

fn motion(
    points: &[ProgramPoint],
    acceleration: f64,
    language: &'static RobotLanguage,
) -> Vec<MotionPiece> {
    let settings = ProgramSettings::default();
    let program = Program {
        acceleration: Some(acceleration),
        ..program(points, &settings)
    };
    program.motion(language).expect("a motion")
}

fn seconds(pieces: &[MotionPiece]) -> f64 {
    pieces.iter().map(|piece| piece.seconds).sum()
}

/// Places along the line at which the gun opens and closes.
fn switches(pieces: &[MotionPiece]) -> [f64; 2] {
    let on = pieces.iter().filter(|piece| piece.is_gun_on);
    let at = |piece: &MotionPiece, end: usize| piece.robot_from_nozzle[end].translation.y;
    let on: Vec<_> = on.collect();
    [at(on[0], 0), at(on[on.len() - 1], 1)]
}

#[test]
fn a_stop_costs_the_time_of_its_ramps() {
    let points = straight(0.1, &[0.25; 5]);
    // From a stop to a stop, braking and accelerating take as long again as half of each ramp at full speed.
    let ramps = 0.25 / 1.25;
    let ways = 6.0 * 0.1 / 0.25;
    for (language, num_runs) in [
        // The approach, the path, and the way back.
        (&KRL, 3.0),
        (&URSCRIPT, 3.0),
        (&JBI, 3.0),
        // It also stops where the gun opens and closes.
        (&DRL, 5.0),
    ] {
        let found = seconds(&motion(&points, 1.25, language));
        let expected = ways + num_runs * ramps;
        assert!(
            (found - expected).abs() < 0.003,
            "{language:?}: {found} {expected}"
        );
    }
}

#[test]
fn the_gun_switches_at_its_points_and_for_universal_robots_where_the_blend_begins() {
    let points = straight(0.1, &[0.25; 5]);
    for language in RobotLanguage::ALL {
        let early = language.reader.switches_before;
        let found = switches(&motion(&points, 4.0, language));
        for (found, point) in found.iter().zip([0.1, 0.3]) {
            assert!((found + early - point).abs() < 1e-9, "{language:?} {found}");
        }
    }
}

#[test]
fn a_corner_is_cut_by_a_parabola_no_faster_than_its_curve_allows() {
    let mut points = straight(0.1, &[0.25; 5]);
    for (i, point) in points.iter_mut().enumerate().skip(3) {
        point.robot_from_nozzle = Isometry3::translation(1.0 + 0.1 * (i - 2) as f64, 0.2, 0.7);
    }
    let pieces = motion(&points, 1.2, &KRL);
    let corner = points[2].robot_from_nozzle.translation.vector;
    let nearest =
        |piece: &&MotionPiece| (piece.robot_from_nozzle[0].translation.vector - corner).norm();
    let apex = pieces
        .iter()
        .min_by(|a, b| nearest(a).total_cmp(&nearest(b)));
    let apex = apex.expect("a piece");
    // 5 mm before and behind a right angle.
    assert!((nearest(&apex) - 0.005 * 2.0_f64.sqrt() / 4.0).abs() < 1e-9);
    // √(1.2 m/s² · 5 mm / √2) there, faster on the way from it.
    let [from, to] = apex.robot_from_nozzle.map(|pose| pose.translation.vector);
    let speed = (to - from).norm() / apex.seconds;
    assert!((0.065..0.085).contains(&speed), "{speed}");
}

#[test]
fn with_a_known_acceleration_ways_take_their_planned_time_although_the_speed_changes() {
    let squared = [
        0.1, 0.1, 0.1, 0.25, 0.4, 0.4, 0.3, 0.16, 0.16, 0.2, 0.2, 0.2,
    ];
    let speeds = squared.map(f64::sqrt);
    let points = straight(0.025, &speeds);
    let pieces = motion(&points, 4.0, &KRL);
    // Three ways together, as a jet paints them.
    for first in 1..7 {
        let ways = first..first + 3;
        let planned: f64 = ways.clone().map(|i| 0.025 / speeds[i]).sum();
        let of_ways = pieces
            .iter()
            .filter(|piece| piece.point.is_some_and(|i| ways.contains(&i)));
        let of_ways: Vec<_> = of_ways.copied().collect();
        let off = seconds(&of_ways) / planned - 1.0;
        assert!(off.abs() < 0.06, "{first}: {off}");
    }
}
