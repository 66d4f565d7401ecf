//! Trends of values from inspection to inspection, and when a trend reaches a limit.
//!
//! The test is that of Mann and Kendall: it counts in how many pairs the later value is the larger one, so that it holds for noise
//! of any distribution, and outliers hardly count. The slope is the median of the slopes of all pairs (Theil and Sen).
//! H. B. Mann, "Nonparametric tests against trend", Econometrica 13, 1945; P. K. Sen, "Estimates of the regression coefficient
//! based on Kendall's tau", Journal of the American Statistical Association 63, 1968. The significance is divided by what the
//! correlation of neighbouring values adds to it, as in S. Yue and C. Wang, "The Mann-Kendall test modified by effective sample
//! size", Water Resources Management 18, 2004, after the trend is taken off.
//!
//! Our deviations: the newer half of the values must rise or fall, too, and the smaller of both slopes counts, so that a camera
//! that warms up and settles has no trend. No trend is followed further ahead than it goes back.
//!
//! False alarms: of 10 000 stationary series of 300 values whose limit lies four standard deviations from the mean, looked at after
//! every 20th, at most one in 1000 ever has a trend that reaches the limit, and one in 100 where neighbours correlate by 0.5;
//! a test counts them. Known limits: a cycle that takes longer than [`TREND_WINDOW`] inspections, such as that of a day's
//! temperature, is a trend while it rises; what changes within a few inspections is over before it is one.

use serde::Serialize;

use geometry::statistics::lower_median;

/// Newest values that a trend is looked for in.
pub(super) const TREND_WINDOW: usize = 100;
/// Fewest values that can have a trend.
pub const LEAST_FOR_TREND: usize = 30;
/// Least significance of a trend, in standard deviations of the count of pairs without a trend.
const MIN_SIGNIFICANCE: f64 = 4.0;
/// The same for the newer half of the values.
const MIN_RECENT_SIGNIFICANCE: f64 = 2.0;
/// A median absolute deviation times this is the standard deviation of normal noise.
const SIGMA_PER_DEVIATION: f64 = 1.4826;
/// Correlation of neighbouring values beyond which too little is left to judge by.
const MAX_CORRELATION: f64 = 0.95;

/// What a value must not pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// Smaller values are refused.
    AtLeast(f64),
    /// Larger values are refused.
    AtMost(f64),
}

impl Limit {
    /// The limit itself.
    pub fn value(self) -> f64 {
        match self {
            Self::AtLeast(value) | Self::AtMost(value) => value,
        }
    }

    /// The same limit of other units. `convert` must not turn an order round.
    #[must_use]
    pub fn map(self, convert: impl FnOnce(f64) -> f64) -> Self {
        match self {
            Self::AtLeast(value) => Self::AtLeast(convert(value)),
            Self::AtMost(value) => Self::AtMost(convert(value)),
        }
    }

    /// Number of further inspections until the first values pass it, those three standard deviations from the trend. `None` for a
    /// trend away from it.
    fn reached_in(self, level: f64, slope: f64, sigma: f64) -> Option<f64> {
        let (gap, approach) = match self {
            Self::AtLeast(least) => (level - 3.0 * sigma - least, -slope),
            Self::AtMost(most) => (most - level - 3.0 * sigma, slope),
        };
        (approach > 0.0).then(|| (gap / approach).max(0.0).ceil())
    }
}

/// A trend that noise does not explain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Trend {
    /// The trend's value at the first of the inspections that it goes over.
    pub from: f64,
    /// Its value at the newest.
    pub to: f64,
    /// Number of inspections that it goes over.
    pub over: usize,
    /// Number of further inspections after which single values pass the limit; `None` if that takes more than `over`.
    pub refuses_in: Option<usize>,
}

/// Finds the trend of values given oldest first; those that are not finite are left out. `None` if noise explains them.
pub(super) fn trend(values: &[f64], limit: Option<Limit>) -> Option<Trend> {
    let values: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    let values = &values[values.len().saturating_sub(TREND_WINDOW)..];
    let num = values.len();
    let recent = &values[num - num / 2..];
    // The newer half first: it takes a quarter of the time, and usually decides.
    if num < LEAST_FOR_TREND || significance(recent).abs() < MIN_RECENT_SIGNIFICANCE {
        return None;
    }
    let strength = significance(values).abs();
    if strength < MIN_SIGNIFICANCE {
        return None;
    }
    let [slope, recent_slope] = [median_slope(values)?, median_slope(recent)?];
    if slope * recent_slope <= 0.0 {
        return None;
    }
    let slope = slope.abs().min(recent_slope.abs()).copysign(slope);
    let last = num - 1;
    let to_newest = |(index, value): (usize, &f64)| value + slope * (last - index) as f64;
    let mut noise: Vec<f64> = values.iter().enumerate().map(to_newest).collect();
    let level = lower_median(noise.iter().copied())?;
    for value in &mut noise {
        *value -= level;
    }
    // What a computer rounds is not noise.
    let is_line = noise.iter().all(|value| value.abs() < 1e-9 * slope.abs());
    if !is_line && strength < MIN_SIGNIFICANCE * excess_of_correlation(&noise) {
        return None;
    }
    let sigma = SIGMA_PER_DEVIATION * lower_median(noise.iter().map(|value| value.abs()))?;
    let reached = limit.and_then(|limit| limit.reached_in(level, slope, sigma));
    Some(Trend {
        from: level - slope * last as f64,
        to: level,
        over: num,
        refuses_in: reached
            .filter(|steps| *steps <= num as f64)
            .map(|steps| steps as usize),
    })
}

/// By how many standard deviations the pairs whose later value is the larger one outnumber the others. Without a trend it is about
/// normally distributed; equal values make it smaller.
fn significance(values: &[f64]) -> f64 {
    let mut surplus = 0_i64;
    for (index, earlier) in values.iter().enumerate() {
        for later in &values[index + 1..] {
            surplus += i64::from(later > earlier) - i64::from(later < earlier);
        }
    }
    let num = values.len() as f64;
    let variance = num * (num - 1.0) * (2.0 * num + 5.0) / 18.0;
    (surplus - surplus.signum()) as f64 / variance.sqrt()
}

/// Median slope of all pairs, per inspection.
fn median_slope(values: &[f64]) -> Option<f64> {
    let slopes = values.iter().enumerate().flat_map(move |(index, earlier)| {
        let later = values[index + 1..].iter().zip(1_u32..);
        later.map(move |(later, steps)| (later - earlier) / f64::from(steps))
    });
    lower_median(slopes)
}

/// By what factor the significance of a trend is too large because these values, without the trend, resemble their neighbours; 1
/// if they do not.
fn excess_of_correlation(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let product = |[a, b]: [f64; 2]| (a - mean) * (b - mean);
    let alone: f64 = values.iter().map(|value| product([*value; 2])).sum();
    let pairs = values.windows(2);
    let pairs: f64 = pairs.map(|pair| product([pair[0], pair[1]])).sum();
    if alone <= 0.0 {
        return 1.0;
    }
    let correlation = (pairs / alone).clamp(0.0, MAX_CORRELATION);
    ((1.0 + correlation) / (1.0 - correlation)).sqrt()
}

#[cfg(test)]
mod tests {
    use rand::{RngExt as _, SeedableRng as _};
    use rand_pcg::Pcg64;

    use super::*;

    /// How stationary noise is distributed.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    enum Noise {
        Normal,
        /// With outliers: Student's t with three degrees of freedom.
        HeavyTailed,
        /// Neighbours correlate by 0.5.
        Correlated,
    }

    /// Noise of standard deviation 1.
    struct Series {
        random: Pcg64,
        noise: Noise,
        last: f64,
    }

    impl Series {
        fn new(seed: u64, noise: Noise) -> Self {
            Self {
                random: Pcg64::seed_from_u64(seed),
                noise,
                last: 0.0,
            }
        }

        /// Box and Muller's transform.
        fn normal(&mut self) -> f64 {
            let [radius, turn] = [(); 2].map(|()| self.random.random::<f64>());
            let radius = (-2.0 * (1.0 - radius).ln()).sqrt();
            radius * (std::f64::consts::TAU * turn).cos()
        }

        fn draw(&mut self) -> f64 {
            let value = self.normal();
            match self.noise {
                Noise::Normal => value,
                Noise::HeavyTailed => {
                    let squares: f64 = [(); 3].map(|()| self.normal().powi(2)).iter().sum();
                    value / squares.max(1e-12).sqrt()
                }
                Noise::Correlated => {
                    self.last = 0.5 * self.last + 0.75_f64.sqrt() * value;
                    self.last
                }
            }
        }
    }

    #[test]
    fn of_10_000_stationary_series_next_to_none_is_warned_about() {
        let all = [Noise::Normal, Noise::HeavyTailed, Noise::Correlated];
        let mut counts = all.map(|noise| (noise, 0, 0));
        for seed in 0..10_000 {
            let (noise, num, num_warned) = &mut counts[seed as usize % 3];
            let mut series = Series::new(seed, *noise);
            let values: Vec<f64> = (0..300).map(|_| series.draw()).collect();
            let limit = Some(Limit::AtMost(4.0));
            let is_warned = |end: usize| {
                let found = trend(&values[..end], limit);
                found.is_some_and(|trend| trend.refuses_in.is_some())
            };
            *num += 1;
            *num_warned += usize::from((40..=300).step_by(20).any(is_warned));
        }
        for (noise, num, num_warned) in counts {
            let most = match noise {
                Noise::Normal | Noise::HeavyTailed => num / 1000,
                Noise::Correlated => num / 100,
            };
            assert!(num_warned <= most, "{noise:?}: {num_warned} of {num}");
        }
    }

    #[test]
    fn a_drift_is_warned_about_before_the_first_value_passes_the_limit() {
        let mut ahead = 0;
        for (sign, seed) in [1.0, -1.0].into_iter().cycle().zip(0..60) {
            let mut series = Series::new(seed, Noise::Normal);
            // Six standard deviations away; from the 100th on it moves by a standard deviation in 20 inspections.
            let limit = if sign > 0.0 {
                Limit::AtMost(6.0)
            } else {
                Limit::AtLeast(-6.0)
            };
            let mut values: Vec<f64> = Vec::new();
            let mut warned_at = None;
            while values.iter().all(|value| value.abs() <= 6.0) {
                let drift = 0.05 * values.len().saturating_sub(100) as f64;
                values.push(sign * drift + series.draw());
                if warned_at.is_none() {
                    let found = trend(&values, Some(limit));
                    let refuses_in = found.and_then(|trend| trend.refuses_in);
                    warned_at = refuses_in.map(|_| values.len());
                }
            }
            let warned_at = warned_at.expect("a warning");
            let refused_at = values.len();
            assert!(100 < warned_at && warned_at < refused_at, "series {seed}");
            ahead += refused_at - warned_at;
        }
        assert!(ahead >= 30 * 60, "{ahead} ahead of 60 refusals");
    }

    #[test]
    fn what_settles_moves_away_or_is_short_is_not_warned_about() {
        let warned = |values: &[f64], limit| {
            trend(values, Some(limit)).is_some_and(|trend| trend.refuses_in.is_some())
        };
        let mut series = Series::new(1, Noise::Normal);
        let mut noise = || 0.2 * series.draw();
        let settling: Vec<f64> = (0..100_u8)
            .map(|at| noise() + 3.0 * (1.0 - (-f64::from(at) / 15.0).exp()))
            .collect();
        assert!(!warned(&settling, Limit::AtMost(5.0)));
        let rising: Vec<f64> = (0..100_u8)
            .map(|at| noise() + 0.05 * f64::from(at))
            .collect();
        assert!(warned(&rising, Limit::AtMost(7.0)));
        assert!(!warned(&rising, Limit::AtLeast(-7.0)));
        assert!(
            !warned(&rising, Limit::AtMost(50.0)),
            "further ahead than it goes back"
        );
        assert!(!warned(&rising[..LEAST_FOR_TREND - 1], Limit::AtMost(2.0)));
        assert_eq!(trend(&[1.0; 100], Some(Limit::AtMost(1.0))), None);
        assert_eq!(trend(&[f64::NAN; 100], None), None);
    }

    #[test]
    fn a_line_is_found_as_it_is_and_reaches_its_limit_where_it_crosses_it() {
        let values: Vec<f64> = (0..150_u8)
            .map(|at| 10.0 - 0.1 * f64::from(at))
            .chain([f64::NAN])
            .collect();
        let found = trend(&values, Some(Limit::AtLeast(-8.05))).expect("a trend");
        // From the 50th value on, 10 - 5 = 5, to the 149th, 10 - 14.9 = -4.9.
        assert!((found.from - 5.0).abs() < 1e-9 && (found.to + 4.9).abs() < 1e-9);
        assert_eq!((found.over, found.refuses_in), (TREND_WINDOW, Some(32)));
    }
}
