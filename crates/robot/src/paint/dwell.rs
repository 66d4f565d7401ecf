//! Dwell times along a path that make its film even.
//!
//! The film at point i of the surface is Σⱼ aᵢⱼ xⱼ, where aᵢⱼ is what way j of the path leaves there at its planned speed
//! and xⱼ is its dwell, the factor on its duration. A bounded least-squares problem in x is solved by simultaneous
//! iterative reconstruction with momentum: each round spreads the error of every point over the ways that paint it,
//!
//! ```text
//! xⱼ -= Σᵢ aᵢⱼ wᵢ eᵢ / (Σⱼ aᵢⱼ) / Σᵢ aᵢⱼ
//! ```
//!
//! An error counts only beyond the middle of the tolerance, so the speed stays constant where the film is even enough.
//! The weights w fall with the distance from the tolerance, more and more from round to round, so that points that no
//! speed can help do not spoil their neighbours. The result is the round with most points within the tolerance.
//!
//! The acceleration is limited by a bound on the differences of squared speeds, |v₁² - v₂²| ≤ 2 a s. Of all profiles
//! within the bound, the mean of the highest one below and the lowest one above the wanted profile is taken. With the gun
//! off, any speed within the bound will do; the one nearest to the planned speed is taken.
//!
//! Source: P. Gilbert, "Iterative methods for the three-dimensional reconstruction of an object from projections",
//! Journal of Theoretical Biology 36(1), 1972 (simultaneous iterative reconstruction). Bounds, weights and momentum are
//! ours.

use super::film::Deposit;

/// Rounds; twice as many gain nothing on the shipped parts.
const NUM_ROUNDS: usize = 100;
/// Share of the last change of a dwell that is added to the next.
const MOMENTUM: f64 = 0.7;
/// Share of the tolerance within which an error does not count.
const IGNORED_TOLERANCE_SHARE: f64 = 0.3;
/// Distance beyond the tolerance at which the weight of a point has fallen to a quarter, in thicknesses: in the first
/// and in the last round.
const FADING_THICKNESSES: [f64; 2] = [1.0, 0.1];

/// The film that is wanted.
#[derive(Debug)]
pub(super) struct Goal {
    /// True for points of the surface that are to be painted.
    pub(super) is_wanted: Vec<bool>,
    /// Thickness in the middle of the tolerance, metres.
    pub(super) level: f64,
    /// Accepted deviation, as a share of the level.
    pub(super) tolerance: f64,
}

/// A straight way of the gun from one point of the path to the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    /// Metres.
    pub(super) length: f64,
    /// Planned speed, m/s.
    pub(super) speed: f64,
    pub(super) is_gun_on: bool,
    /// Least and greatest dwell with the gun on.
    pub(super) bounds: [f64; 2],
}

impl Goal {
    /// Film of ways with these dwells. A deposit's way is its place in `which`.
    pub(super) fn film(&self, deposits: &[&Deposit], which: &[usize], dwells: &[f64]) -> Vec<f64> {
        let mut film = vec![0.0; self.is_wanted.len()];
        for (deposit, way) in deposits.iter().zip(which) {
            for (point, thickness) in *deposit {
                film[*point as usize] += dwells[*way] * f64::from(*thickness);
            }
        }
        film
    }

    /// Share of the wanted points that are within the tolerance.
    pub(super) fn share(&self, film: &[f64]) -> f64 {
        let wanted = film.iter().zip(&self.is_wanted).filter(|(_, is)| **is);
        let (mut num, mut num_good) = (0.0, 0.0);
        for (thickness, _) in wanted {
            num += 1.0;
            if (thickness / self.level - 1.0).abs() <= self.tolerance {
                num_good += 1.0;
            }
        }
        num_good / f64::max(num, 1.0)
    }

    /// Improves dwells; returns them with the share within the tolerance. `which` has the way of each deposit; without an
    /// acceleration, speeds may jump.
    pub(super) fn improve(
        &self,
        ways: &[Way],
        deposits: &[&Deposit],
        which: &[usize],
        acceleration: Option<f64>,
        start: Vec<f64>,
    ) -> (Vec<f64>, f64) {
        let mut all = vec![0.0; self.is_wanted.len()];
        let mut sums = Vec::with_capacity(deposits.len());
        for deposit in deposits {
            let mut sum = 0.0;
            for (point, thickness) in *deposit {
                let thickness = f64::from(*thickness) / self.level;
                all[*point as usize] += thickness;
                if self.is_wanted[*point as usize] {
                    sum += thickness;
                }
            }
            sums.push(sum);
        }
        let mut dwells = start;
        if let Some(acceleration) = acceleration {
            limit(&mut dwells, ways, acceleration);
        }
        let mut changes = vec![0.0; ways.len()];
        let mut film = self.film(deposits, which, &dwells);
        let mut best = (dwells.clone(), self.share(&film));
        for round in 0..NUM_ROUNDS {
            let share = round as f64 / NUM_ROUNDS as f64;
            let hopeless =
                FADING_THICKNESSES[0] * (FADING_THICKNESSES[1] / FADING_THICKNESSES[0]).powf(share);
            let errors = self.errors(&film, &all, hopeless);
            for ((deposit, sum), way) in deposits.iter().zip(&sums).zip(which) {
                if *sum <= 0.0 {
                    continue;
                }
                let each = deposit.iter();
                let each = each.map(|(i, thickness)| errors[*i as usize] * f64::from(*thickness));
                let step = each.sum::<f64>() / (self.level * sum);
                let [least, most] = ways[*way].bounds;
                let before = dwells[*way];
                dwells[*way] = (before + MOMENTUM * changes[*way] - step).clamp(least, most);
                changes[*way] = dwells[*way] - before;
            }
            if let Some(acceleration) = acceleration {
                limit(&mut dwells, ways, acceleration);
            }
            film = self.film(deposits, which, &dwells);
            let share = self.share(&film);
            if share > best.1 {
                best = (dwells.clone(), share);
            }
        }
        best
    }

    /// Weighted errors of a film; `all` is the film of all ways at their planned speeds, in levels.
    fn errors(&self, film: &[f64], all: &[f64], hopeless: f64) -> Vec<f64> {
        let even = IGNORED_TOLERANCE_SHARE * self.tolerance;
        let each = film.iter().zip(all).zip(&self.is_wanted);
        let each = each.map(|((thickness, all), is_wanted)| {
            if !is_wanted {
                return 0.0;
            }
            let off = thickness / self.level - 1.0;
            let beyond = (off.abs() - self.tolerance).max(0.0) / hopeless;
            let weight = (1.0 + beyond * beyond).powi(-2);
            weight * (off - off.clamp(-even, even)) / all.max(1.0)
        });
        each.collect()
    }
}

/// Changes dwells so that the gun accelerates no more than this along the path, m/s².
fn limit(dwells: &mut [f64], ways: &[Way], acceleration: f64) {
    // From the middle of one way to the middle of the next.
    let most = |i: usize| acceleration * (ways[i].length + ways[i + 1].length);
    let highest_below = |mut squared: Vec<f64>| {
        for i in 1..ways.len() {
            squared[i] = squared[i].min(squared[i - 1] + most(i - 1));
        }
        for i in (1..ways.len()).rev() {
            squared[i - 1] = squared[i - 1].min(squared[i] + most(i - 1));
        }
        squared
    };
    let wanted = |sign: f64| {
        let each = ways.iter().zip(dwells.iter()).map(|(way, dwell)| {
            let [least, most] = way.bounds;
            let squared = (way.speed / dwell.clamp(least, most)).powi(2);
            if way.is_gun_on {
                sign * squared
            } else {
                f64::INFINITY
            }
        });
        highest_below(each.collect())
    };
    let low = wanted(1.0);
    let high = wanted(-1.0).into_iter().map(|negative| -negative);
    let each = low.into_iter().zip(high).zip(ways);
    let each = each.map(|((low, high), way)| {
        let middle = f64::midpoint(low, high);
        if way.is_gun_on {
            middle
        } else {
            let planned = way.speed.powi(2);
            planned.max(high.min(middle)).min(low.max(middle))
        }
    });
    let squared = highest_below(each.collect());
    for ((dwell, way), squared) in dwells.iter_mut().zip(ways).zip(squared) {
        *dwell = way.speed / squared.sqrt();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line of points 5 mm apart and ways of 25 mm, whose jet covers them as a Gaussian. Where the surface is steep,
    /// only a share of the film stays.
    fn line(share: impl Fn(f64) -> f64) -> (Goal, Vec<Way>, Vec<Deposit>) {
        let (num_points, num_ways) = (400_u32, 80);
        let deposits = (0..num_ways).map(|way| {
            let each = (0..num_points).map(|point| {
                let at = 0.005 * f64::from(point);
                let off = (at - 0.025 * (f64::from(way) + 0.5)) / 0.02;
                (point, (share(at) * (-0.5 * off * off).exp()) as f32)
            });
            let each = each.filter(|(_, thickness)| *thickness > 1e-3);
            each.collect::<Deposit>()
        });
        let way = Way {
            length: 0.025,
            speed: 0.4,
            is_gun_on: true,
            bounds: [0.2, 2.0],
        };
        let goal = Goal {
            is_wanted: vec![true; num_points as usize],
            // √(2π) · 20 mm / 25 mm.
            level: 2.005,
            tolerance: 0.2,
        };
        (goal, vec![way; num_ways as usize], deposits.collect())
    }

    fn improved(acceleration: f64, share: impl Fn(f64) -> f64) -> (Vec<Way>, Vec<f64>, [f64; 2]) {
        let (goal, ways, deposits) = line(share);
        let deposits: Vec<&Deposit> = deposits.iter().collect();
        let which: Vec<usize> = (0..ways.len()).collect();
        let start = vec![1.0; ways.len()];
        let before = goal.share(&goal.film(&deposits, &which, &start));
        let (dwells, after) = goal.improve(&ways, &deposits, &which, Some(acceleration), start);
        assert!((goal.share(&goal.film(&deposits, &which, &dwells)) - after).abs() < 1e-12);
        (ways, dwells, [before, after])
    }

    #[test]
    fn the_gun_dwells_where_the_film_is_thin_and_accelerates_no_more_than_allowed() {
        let dip = |x: f64| 1.0 - 0.4 * (-0.5 * ((x - 1.0) / 0.15).powi(2)).exp();
        let (ways, dwells, [before, after]) = improved(4.0, dip);
        assert!(before < 0.85 && after > before + 0.1, "{before} {after}");
        assert!(dwells[40] > 1.2 && dwells[20] < 1.1, "{dwells:?}");
        for acceleration in [0.5, 4.0] {
            let (_, dwells, _) = improved(acceleration, dip);
            let squared: Vec<f64> = ways
                .iter()
                .zip(&dwells)
                .map(|(w, x)| (w.speed / x).powi(2))
                .collect();
            for pair in squared.windows(2) {
                let most = 2.0 * acceleration * 0.025 + 1e-9;
                assert!((pair[1] - pair[0]).abs() <= most, "{pair:?}");
            }
        }
    }

    #[test]
    fn with_the_gun_off_the_planned_speed_is_kept_as_far_as_the_acceleration_allows() {
        let way = |is_gun_on, speed| Way {
            length: 0.025,
            speed,
            is_gun_on,
            bounds: [0.2, 2.0],
        };
        let mut ways = vec![way(true, 0.4); 60];
        for i in (20..40).chain(50..52) {
            ways[i] = way(false, 1.0);
        }
        // Slow before the second gap and fast after it.
        let mut dwells = [vec![2.0; 50], vec![0.2; 10]].concat();
        limit(&mut dwells, &ways, 4.0);
        let speeds = ways.iter().zip(&dwells).map(|(way, x)| way.speed / x);
        let squared: Vec<f64> = speeds.map(|speed| speed * speed).collect();
        for pair in squared.windows(2) {
            assert!((pair[1] - pair[0]).abs() <= 0.2 + 1e-9, "{pair:?}");
        }
        assert!((squared[10] - 0.04).abs() < 1e-9, "{squared:?}");
        assert!((squared[30] - 1.0).abs() < 1e-9, "{squared:?}");
    }

    #[test]
    fn the_speed_stays_constant_where_the_film_is_even() {
        // The ends are thin, but far from the middle.
        let (_, dwells, _) = improved(4.0, |_| 1.0);
        assert!(
            dwells[20..60]
                .iter()
                .all(|dwell| (dwell - 1.0).abs() < 1e-6),
            "{dwells:?}"
        );
    }

    #[test]
    fn points_that_no_speed_can_help_do_not_spoil_their_neighbours() {
        let hole = |x: f64| if (x - 1.0).abs() < 0.012 { 0.05 } else { 1.0 };
        let (_, _, [before, after]) = improved(4.0, hole);
        assert!(after >= before, "{before} {after}");
    }
}
