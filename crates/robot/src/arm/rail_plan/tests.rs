use std::ops::RangeInclusive;

use rand::{RngExt as _, SeedableRng as _};
use rand_pcg::Pcg64;

use super::*;

/// Points 0.1 s apart, positions 0.1 m apart; each point is reached from these positions, by the first configuration.
fn plan(reached: Vec<RangeInclusive<usize>>, speed: f64) -> Plan {
    let positions = (0..11).map(|i| 0.1 * f64::from(i)).collect();
    let reached = reached.into_iter().map(|within| {
        let bits = (0..11).map(|position| u8::from(within.contains(&position)));
        bits.collect()
    });
    let reached: Vec<Vec<u8>> = reached.collect();
    Plan {
        times: (0..reached.len()).map(|i| 0.1 * i as f64).collect(),
        is_gun_on: vec![true; reached.len()],
        reached,
        positions,
        speed,
        acceleration: None,
    }
}

/// Greatest speed of the rail from one point to the next, m/s.
fn fastest(run: &[f64]) -> f64 {
    let speeds = run.windows(2).map(|pair| (pair[1] - pair[0]).abs() / 0.1);
    speeds.fold(0.0, f64::max)
}

fn num_moves(run: &[f64]) -> usize {
    run.windows(2)
        .filter(|pair| (pair[1] - pair[0]).abs() > 0.0)
        .count()
}

#[test]
fn it_stands_still_in_the_middle_of_what_reaches_every_point() {
    let run = plan(vec![2..=6; 30], 1.0).run(&|| false).expect("goes on");
    assert_eq!(run, vec![0.4; 30]);
    let mut all = vec![0..=6; 15];
    all.extend(vec![3..=10; 15]);
    let run = plan(all, 1.0).run(&|| false).expect("goes on");
    assert_eq!(num_moves(&run), 0, "{run:?}");
    assert!((0.3..=0.6 + 1e-9).contains(&run[0]), "{run:?}");
}

#[test]
fn it_moves_in_time_within_its_speed_and_while_the_gun_is_off() {
    let mut all = vec![0..=2; 20];
    all.extend(vec![0..=10; 20]);
    all.extend(vec![8..=10; 20]);
    let run = plan(all, 1.0).run(&|| false).expect("goes on");
    assert!(run[..20].iter().all(|at| *at <= 0.2 + 1e-9), "{run:?}");
    assert!(run[40..].iter().all(|at| *at >= 0.8 - 1e-9), "{run:?}");
    assert!(fastest(&run) <= 1.0 + 1e-6, "{run:?}");
    // It has two seconds for 0.6 m.
    assert!(fastest(&run) <= 0.5 + 1e-6, "{run:?}");
    // Half a second without paint is enough for 0.4 m at 1 m/s.
    let mut all = vec![1..=3; 30];
    all.extend(vec![5..=9; 30]);
    for point in &mut all[20..40] {
        *point = 1..=9;
    }
    let mut plan = plan(all, 1.0);
    plan.is_gun_on[27..32].fill(false);
    let run = plan.run(&|| false).expect("goes on");
    assert_eq!(num_moves(&run[..28]), 0, "{run:?}");
    assert_eq!(num_moves(&run[32..]), 0, "{run:?}");
    assert!(num_moves(&run[27..33]) > 0, "{run:?}");
}

#[test]
fn it_speeds_up_and_slows_down_within_its_acceleration() {
    let mut all = vec![0..=2; 20];
    all.extend(vec![0..=10; 20]);
    all.extend(vec![8..=10; 20]);
    let run = |acceleration: Option<f64>| {
        let plan = Plan {
            acceleration,
            ..plan(all.clone(), 1.0)
        };
        plan.run(&|| false).expect("goes on")
    };
    let hardest = |run: &[f64]| {
        let changes = run.windows(3).map(|at| at[2] - 2.0 * at[1] + at[0]);
        changes
            .map(|change| change.abs() / 0.01)
            .fold(0.0, f64::max)
    };
    let ramped = run(Some(1.0));
    assert!(hardest(&ramped) <= 1.0 + 1e-6, "{ramped:?}");
    assert!(ramped[..20].iter().all(|at| *at <= 0.2 + 1e-9));
    assert!(ramped[40..].iter().all(|at| *at >= 0.8 - 1e-9));
    // Without a limit the rail is at full speed at once.
    assert!(hardest(&run(None)) > 1.0);
    // From one end to the other, accelerating over the first half, it is between 0.2 and 0.8 m for 2.1 s at 0.12 m/s².
    let is_too_hard = |limit: f64| hardest(&run(Some(limit))) > limit + 1e-6;
    assert!(is_too_hard(0.1) && !is_too_hard(0.2));
}

#[test]
fn what_cannot_be_reached_in_time_is_one_jump_and_not_a_row_of_missed_points() {
    let mut all = vec![0..=2; 20];
    all.extend(vec![8..=10; 20]);
    let run = plan(all.clone(), 0.5).run(&|| false).expect("goes on");
    assert!(run[..20].iter().all(|at| *at <= 0.2 + 1e-9), "{run:?}");
    assert!(run[20..].iter().all(|at| *at >= 0.8 - 1e-9), "{run:?}");
    assert_eq!(run, plan(all, 0.5).run(&|| false).expect("goes on"));
    // A point that no position reaches does not matter.
    let mut all = vec![2..=6; 30];
    all[12] = 12..=12;
    assert_eq!(
        plan(all, 1.0).run(&|| false).expect("goes on"),
        vec![0.4; 30]
    );
}

#[test]
fn a_slow_rail_passes_more_points_than_are_looked_at() {
    // At 4 mm/s, 0.6 m take 1500 points.
    let mut all = vec![0..=2; 500];
    all.extend(vec![0..=10; 1600]);
    all.extend(vec![8..=10; 500]);
    let run = plan(all, 0.004).run(&|| false).expect("goes on");
    assert!(run[..500].iter().all(|at| *at <= 0.2 + 1e-9), "{run:?}");
    assert!(run[2100..].iter().all(|at| *at >= 0.8 - 1e-9), "{run:?}");
    assert!(fastest(&run) <= 0.004 + 1e-9, "{run:?}");
}

#[test]
fn wherever_a_run_reaches_every_point_one_is_found() {
    let mut random = Pcg64::seed_from_u64(6);
    for _ in 0..200 {
        // A run at 1 m/s between any positions, and around it the positions that reach each point.
        let mut hidden = vec![random.random_range(0..11)];
        let mut within = vec![hidden[0]..=hidden[0]];
        while within.len() < 60 {
            let at: usize = hidden[hidden.len() - 1];
            let to: usize = random.random_range(0..11);
            let way = at.abs_diff(to);
            for step in 1..=way {
                let at = if to > at { at + step } else { at - step };
                within.push(at..=at);
            }
            let stands = random.random_range(1..6);
            within.extend(std::iter::repeat_n(to..=to, stands));
            hidden.push(to);
        }
        let wider = within.iter().map(|range| {
            let more = random.random_range(0..3);
            range.start().saturating_sub(more)..=range.end() + more
        });
        let wider: Vec<RangeInclusive<usize>> = wider.collect();
        let run = plan(wider.clone(), 1.0).run(&|| false).expect("goes on");
        assert!(fastest(&run) <= 1.0 + 1e-6, "{run:?}");
        for (at, within) in run.iter().zip(&wider) {
            let (low, high) = (*within.start() as f64, *within.end() as f64);
            let at = at / 0.1;
            assert!(
                at > low - 1e-6 && at < high + 1e-6,
                "{at} {within:?}: {run:?}"
            );
        }
    }
}

#[test]
fn one_configuration_along_the_path_is_better_than_less_way() {
    // The first configuration reaches from the left and then from the right, the second alternates but never reaches
    // all along.
    let mut plan = plan(vec![0..=10; 40], 1.0);
    for (i, here) in plan.reached.iter_mut().enumerate() {
        for (position, found) in here.iter_mut().enumerate() {
            let first = if i < 20 { position <= 5 } else { position >= 5 };
            let second = position == 1 && i < 30;
            *found = u8::from(first) | (u8::from(second) << 1);
        }
    }
    assert_eq!(plan.run(&|| false).expect("goes on"), vec![0.5; 40]);
}
