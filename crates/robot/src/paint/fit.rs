//! Fits the gun to a measured stripe.
//!
//! A straight stripe, sprayed at a known speed v perpendicular to a plate, shows across it the density of the jet
//! summed along the direction of travel. With Q the volume deposited per second and x measured from the middle of the
//! stripe:
//!
//! ```text
//! Gaussian   t(x) = Q/v · exp(-x²/2σ²) / (σ√2π)                     4σ = width of the pattern
//! beta       t(x) = Q/v · β B(½, β)/(π a) · (1 - x²/a²)^(β-½)       2a = width of the pattern
//! ```
//!
//! B is Euler's beta function; the second is the integral of the elliptic density in `gun.rs`. Q, width, middle and β
//! are found by Levenberg's and Marquardt's method (D. W. Marquardt, "An algorithm for least-squares estimation of
//! nonlinear parameters", Journal of the Society for Industrial and Applied Mathematics 11(2), 1963). The profile with
//! the smaller residual is taken, with a penalty for the number of its parameters (G. Schwarz, "Estimating the
//! dimension of a model", The Annals of Statistics 6(2), 1978): a beta profile has one more and follows noise better.
//! Flow and solids are those of the coat, so Q gives the transfer efficiency.
//!
//! Known limits: a stripe does not show the pattern's depth, which is scaled with the distance.

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use nalgebra::{DMatrix, DVector};

use super::coat::{BETA_RANGE, Coat, Gun, Profile, TRANSFER_RANGE_PERCENT, WIDTH_RANGE_MM};
use files::{FileError, read_text, table_rows};
use geometry::error::Advice;

/// Fewest places of a stripe: twice the parameters.
const MIN_SAMPLES: usize = 8;
/// Fewest places thicker than half of the thickest.
const MIN_INSIDE: usize = 3;
/// Most places of a stripe; more are probably something else.
const MAX_SAMPLES: usize = 10_000;
/// Largest offset and thickness of a table, metres: more is in another unit.
const MAX_OFFSET_M: f64 = 10.0;
const MAX_THICKNESS_M: f64 = 0.01;
/// Largest file that is read, bytes.
const MAX_BYTES: u64 = 1 << 20;
/// Noise may be below zero by at most this share of the thickest place.
const MAX_NEGATIVE_SHARE: f64 = 0.1;
/// Largest residual of a stripe, as a share of the thickest place.
const MAX_RESIDUAL_SHARE: f64 = 0.25;
const NUM_ROUNDS: usize = 200;

/// One measurement across a stripe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripeSample {
    /// Position across the stripe, metres, from any origin.
    pub offset: f64,
    /// Thickness of the dry film there, metres.
    pub thickness: f64,
}

/// A gun fitted to a stripe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripeFit {
    /// The gun; its pattern is that at the stripe's distance.
    pub gun: Gun,
    /// Position of the stripe's middle, metres.
    pub middle: f64,
    /// Root mean square residual, metres.
    pub residual: f64,
    /// Root mean square residual of the other profile, metres.
    pub other_residual: f64,
}

/// Why no gun can be fitted.
#[derive(Debug, thiserror::Error, Advice)]
pub enum StripeError {
    /// The file cannot be read.
    #[error(transparent)]
    #[advice(transparent)]
    File(#[from] FileError),
    /// The heading does not name both columns.
    #[error("{}: no heading that names offset_mm and thickness_um", path.display())]
    #[advice = "Begin the file with a line offset_mm,thickness_um, then write one place per line"]
    NoColumns {
        /// The file.
        path: PathBuf,
    },
    /// A line has no offset or no thickness.
    #[error("{}, line {line}: expected an offset and a thickness", path.display())]
    #[advice = "Correct the line; nothing was written"]
    NoNumbers {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
    },
    /// An offset or a thickness of a line is none that can be measured.
    #[error(
        "{}, line {line}: {value} is no {what}, expected {low:.0} to {high:.0}", path.display()
    )]
    #[advice = "Correct the line; if the gauge shows less than 0 on the bare plate, zero it there and measure again"]
    Impossible {
        /// The file.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// Name and unit of the value.
        what: &'static str,
        /// The value.
        value: f64,
        /// Least value.
        low: f64,
        /// Greatest value.
        high: f64,
    },
    /// The stripe has too few or too many places.
    #[error("the stripe has {found} places, expected {MIN_SAMPLES} to {MAX_SAMPLES}")]
    #[advice = "Measure every 5 to 20 mm across the stripe, from bare metal to bare metal"]
    Count {
        /// Number of places.
        found: usize,
    },
    /// Some offsets or thicknesses are not finite.
    #[error("{found} places of the stripe are not finite")]
    #[advice(ZERO_GAUGE)]
    NotFinite {
        /// Number of such places.
        found: usize,
    },
    /// A thickness is below zero by more than noise.
    #[error("a thickness of {micrometres:.1} µm is below 0 by more than noise")]
    #[advice(ZERO_GAUGE)]
    Negative {
        /// The least thickness, µm.
        micrometres: f64,
    },
    /// The places show no paint, an even film, or another shape than a stripe.
    #[error("the places show no stripe: {what}")]
    #[advice = "Spray one straight stripe over a plate and measure across it, from bare metal to bare metal"]
    NoStripe {
        /// What is wrong with them.
        what: &'static str,
    },
    /// The speed or the distance is not above 0.
    #[error("{name} must be above 0 and finite")]
    #[advice = "Give the speed in mm/s and the distance in mm"]
    BadSetting {
        /// Name of the value.
        name: &'static str,
    },
    /// A parameter of the fitted gun is out of a coat's range.
    #[error("the stripe would need {what} of {value:.1} {unit}, expected {low:.0} to {high:.0}")]
    #[advice = "Check --speed and --distance, and flow and solids of the coat, for example --set gun.flow=300"]
    OutOfRange {
        /// Name of the parameter.
        what: &'static str,
        /// Value of the parameter, in `unit`.
        value: f64,
        /// Unit of the value and its limits.
        unit: &'static str,
        /// Least value.
        low: f64,
        /// Greatest value.
        high: f64,
    },
}

const ZERO_GAUGE: &str = "Zero the gauge on the bare plate, and measure these places again";

/// Reads a stripe: a table whose heading names the columns `offset_mm` and `thickness_um`.
pub fn read_stripe(path: &Path) -> Result<Vec<StripeSample>, StripeError> {
    let text = read_text(path, MAX_BYTES)?;
    let mut lines = table_rows(&text, path)?.into_iter();
    let no_columns = || StripeError::NoColumns {
        path: path.to_owned(),
    };
    let (_, heading) = lines.next().ok_or_else(no_columns)?;
    let column = |name: &str| {
        let unquoted = |cell: &str| cell.trim_matches(['"', '\'']).trim().to_lowercase();
        heading.cells().position(|cell| unquoted(cell) == name)
    };
    let columns = column("offset_mm").zip(column("thickness_um"));
    let (offset, thickness) = columns.ok_or_else(no_columns)?;
    let mut samples = Vec::new();
    for (line, row) in lines {
        let number = |column: usize| row.cells().nth(column).and_then(|cell| row.number(cell));
        let both = number(offset).zip(number(thickness));
        let (offset, thickness) = both.ok_or_else(|| StripeError::NoNumbers {
            path: path.to_owned(),
            line,
        })?;
        // NaN is in no range.
        for (what, value, [low, high]) in [
            (
                "offset in mm",
                offset,
                [-1e3 * MAX_OFFSET_M, 1e3 * MAX_OFFSET_M],
            ),
            ("thickness in µm", thickness, [0.0, 1e6 * MAX_THICKNESS_M]),
        ] {
            if !(low..=high).contains(&value) {
                return Err(StripeError::Impossible {
                    path: path.to_owned(),
                    line,
                    what,
                    value,
                    low,
                    high,
                });
            }
        }
        samples.push(StripeSample {
            offset: offset / 1e3,
            thickness: thickness / 1e6,
        });
    }
    Ok(samples)
}

/// Finds the gun that leaves this stripe at a speed in m/s and a distance in metres; paint and pattern depth are the
/// coat's.
pub fn fit_stripe(
    samples: &[StripeSample],
    coat: &Coat,
    speed: f64,
    distance: f64,
) -> Result<StripeFit, StripeError> {
    for (name, value) in [("the speed", speed), ("the distance", distance)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(StripeError::BadSetting { name });
        }
    }
    let start = first_guess(samples)?;
    let fits = [Profile::Gaussian, Profile::Beta].map(|profile| {
        let with_beta = [start[0], start[1], start[2], coat.gun.beta];
        let num = if profile == Profile::Beta { 4 } else { 3 };
        let fitted = least_squares(samples, profile, &with_beta[..num]);
        let rms =
            (residuals(samples, profile, &fitted).norm_squared() / samples.len() as f64).sqrt();
        (profile, fitted, rms)
    });
    let [gaussian, beta] = fits;
    // Schwarz's criterion: n ln(rms²) + k ln n.
    let num = samples.len() as f64;
    let weighed = |(_, fitted, rms): &(Profile, Vec<f64>, f64)| {
        2.0 * num * rms.max(f64::MIN_POSITIVE).ln() + fitted.len() as f64 * num.ln()
    };
    let (best, other) = if weighed(&beta) < weighed(&gaussian) {
        (beta, gaussian)
    } else {
        (gaussian, beta)
    };
    let (profile, fitted, residual) = best;
    let thickest = samples.iter().map(|s| s.thickness).fold(0.0, f64::max);
    if residual.is_nan() || residual > MAX_RESIDUAL_SHARE * thickest {
        return Err(StripeError::NoStripe {
            what: "neither a Gaussian nor a beta profile is like them",
        });
    }
    let (volume, width) = (fitted[0], fitted[1].abs());
    let transfer = volume * speed / (coat.gun.flow * coat.gun.solids);
    let in_range = |what, unit, value: f64, [low, high]: [f64; 2]| {
        if (low..=high).contains(&value) {
            Ok(())
        } else {
            Err(StripeError::OutOfRange {
                what,
                value,
                unit,
                low,
                high,
            })
        }
    };
    in_range("a pattern width", "mm", width * 1e3, WIDTH_RANGE_MM)?;
    in_range(
        "a transfer efficiency",
        "%",
        transfer * 1e2,
        TRANSFER_RANGE_PERCENT,
    )?;
    let gun = Gun {
        profile,
        width,
        // The jet widens with the distance in both directions.
        depth: coat.gun.depth * distance / coat.gun.distance,
        beta: fitted.get(3).map_or(coat.gun.beta, |beta| *beta),
        distance,
        transfer,
        ..coat.gun
    };
    Ok(StripeFit {
        gun,
        middle: fitted[2],
        residual,
        other_residual: other.2,
    })
}

/// Estimates volume per length, width and middle from the moments of the readings.
fn first_guess(samples: &[StripeSample]) -> Result<[f64; 3], StripeError> {
    let found = samples.len();
    if !(MIN_SAMPLES..=MAX_SAMPLES).contains(&found) {
        return Err(StripeError::Count { found });
    }
    let is_bad = |s: &&StripeSample| !(s.offset.is_finite() && s.thickness.is_finite());
    let found = samples.iter().filter(is_bad).count();
    if found > 0 {
        return Err(StripeError::NotFinite { found });
    }
    let no_stripe = |what| Err(StripeError::NoStripe { what });
    let of = |pick: fn(f64, f64) -> f64| samples.iter().map(|s| s.thickness).fold(0.0, pick);
    let (least, most) = (of(f64::min), of(f64::max));
    if least < -MAX_NEGATIVE_SHARE * most {
        let micrometres = 1e6 * least;
        return Err(StripeError::Negative { micrometres });
    }
    if most <= 0.0 {
        return no_stripe("nothing is thicker than 0");
    }
    let inside = samples.iter().filter(|s| s.thickness > 0.5 * most).count();
    if inside < MIN_INSIDE {
        return no_stripe("less than three places are thicker than half of the thickest");
    }
    if 2 * inside > samples.len() * 3 / 2 {
        return no_stripe("three quarters are thicker than half of the thickest");
    }
    let mut sorted = samples.to_vec();
    sorted.sort_by(|a, b| a.offset.total_cmp(&b.offset));
    let (mut sum, mut first, mut second) = (0.0, 0.0, 0.0);
    for pair in sorted.windows(2) {
        let [a, b] = pair else { continue };
        let volume = 0.5 * (a.thickness + b.thickness).max(0.0) * (b.offset - a.offset);
        let x = 0.5 * (a.offset + b.offset);
        sum += volume;
        first += volume * x;
        second += volume * x * x;
    }
    if sum <= 0.0 {
        return no_stripe("all places are at one offset");
    }
    let middle = first / sum;
    let sigma = (second / sum - middle * middle).max(1e-8).sqrt();
    Ok([sum, 4.0 * sigma, middle])
}

/// Thickness at an offset; the parameters are volume per length, width, middle and, for a beta profile, β.
fn thickness(profile: Profile, parameters: &[f64], offset: f64) -> f64 {
    let [volume, width, middle] = [parameters[0], parameters[1].abs(), parameters[2]];
    match profile {
        Profile::Gaussian => {
            let sigma = width / 4.0;
            let x = (offset - middle) / sigma;
            volume * (-0.5 * x * x).exp() / (sigma * (2.0 * PI).sqrt())
        }
        Profile::Beta => {
            let (half, beta) = (width / 2.0, parameters[3]);
            let within = 1.0 - ((offset - middle) / half).powi(2);
            if within <= 0.0 {
                return 0.0;
            }
            volume * beta * beta_half(beta) / (PI * half) * within.powf(beta - 0.5)
        }
    }
}

/// B(½, β), the integral of (1 - s²)^(β-1) over -1..1, by s = sin φ.
fn beta_half(beta: f64) -> f64 {
    /// Number of midpoints; the integrand is smooth, so few are enough.
    const NUM: i32 = 400;
    let step = PI / f64::from(NUM);
    let each = (0..NUM).map(|k| {
        let angle = -0.5 * PI + (f64::from(k) + 0.5) * step;
        angle.cos().powf(2.0 * beta - 1.0)
    });
    each.sum::<f64>() * step
}

fn residuals(samples: &[StripeSample], profile: Profile, parameters: &[f64]) -> DVector<f64> {
    let each = samples
        .iter()
        .map(|s| thickness(profile, parameters, s.offset) - s.thickness);
    DVector::from_iterator(samples.len(), each)
}

/// Levenberg's and Marquardt's method from a first guess; derivatives are finite differences.
fn least_squares(samples: &[StripeSample], profile: Profile, start: &[f64]) -> Vec<f64> {
    let mut best = start.to_vec();
    if profile == Profile::Beta {
        // Its variance is half²/(2β + 2), a Gaussian's (width/4)².
        best[1] *= 0.5 * (2.0 * best[3] + 2.0).sqrt();
    }
    let scales = [best[0], best[1], best[1], 1.0];
    let mut left = residuals(samples, profile, &best);
    let mut damping = 1e-3;
    for _ in 0..NUM_ROUNDS {
        let num = best.len();
        let mut slopes = DMatrix::zeros(samples.len(), num);
        for i in 0..num {
            let mut moved = best.clone();
            moved[i] += 1e-6 * scales[i];
            let column = (residuals(samples, profile, &moved) - &left) / 1e-6;
            slopes.set_column(i, &column);
        }
        let mut normal = slopes.transpose() * &slopes;
        let gradient = slopes.transpose() * &left;
        for i in 0..num {
            normal[(i, i)] *= 1.0 + damping;
        }
        let Some(step) = normal.lu().solve(&gradient) else {
            break;
        };
        let mut tried: Vec<f64> = (0..num).map(|i| best[i] - step[i] * scales[i]).collect();
        if let Some(beta) = tried.get_mut(3) {
            *beta = beta.clamp(BETA_RANGE[0], BETA_RANGE[1]);
        }
        let now = residuals(samples, profile, &tried);
        if now.norm_squared() < left.norm_squared() {
            let gain = 1.0 - now.norm_squared() / left.norm_squared();
            (best, left) = (tried, now);
            damping = (0.3 * damping).max(1e-12);
            if gain < 1e-12 {
                break;
            }
        } else {
            damping *= 10.0;
            if damping > 1e12 {
                break;
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use rand::{RngExt as _, SeedableRng as _};
    use rand_pcg::Pcg64;

    use super::*;
    use crate::paint::{PaintSurface, simulate, surface::tests::grid};
    use geometry::units::Metres;
    use inspection::library::{PathPoint, SprayPath};
    use nalgebra::{Point3, Unit, Vector3};
    use stages::reference::Coverage;

    /// The film that `simulate` gives across one stripe along y, every 5 mm, and the greatest thickness anywhere.
    fn stripe(coat: &Coat) -> (Vec<StripeSample>, f64) {
        let surface: PaintSurface = grid(101, 61, Coverage::OneSide, |i, j| {
            (
                Point3::new(0.5 * i - 0.25, 0.3 * j - 0.15, 0.0),
                Vector3::z(),
            )
        });
        let point = |y: f64, is_gun_on| PathPoint {
            nozzle: Point3::new(0.012, y, coat.stand_off),
            direction: -Vector3::z_axis(),
            stand_off: Some(Metres(coat.stand_off)),
            is_gun_on,
            speed: Some(coat.speed),
            fan: Some(Unit::new_normalize(Vector3::x())),
        };
        let path = SprayPath::new(vec![point(-1.0, true), point(1.0, false)]).expect("a path");
        let film = simulate(&surface, &path, coat, &[]).expect("simulated");
        let most = film.thickness.iter().copied().fold(0.0, f64::max);
        let across = surface.points.iter().zip(&film.thickness);
        let across = across.filter(|(p, _)| p.y.abs() < 1e-6);
        let samples = across.map(|(p, t)| StripeSample {
            offset: p.x,
            thickness: *t,
        });
        (samples.collect(), most)
    }

    fn with_noise(stripe: &[StripeSample], noise: f64, seed: u64) -> Vec<StripeSample> {
        let mut random = Pcg64::seed_from_u64(seed);
        let noisy = stripe.iter().map(|s| StripeSample {
            offset: s.offset,
            thickness: s.thickness + noise * (random.random::<f64>() - 0.5) * 12_f64.sqrt(),
        });
        noisy.collect()
    }

    #[test]
    fn a_noisy_stripe_gives_back_the_gun_that_sprayed_it() {
        for profile in [Profile::Gaussian, Profile::Beta] {
            let mut coat = Coat::default();
            coat.gun.profile = profile;
            coat.gun.beta = 1.8;
            // The jet of 0.2 m at 0.15 m is 0.24 m wide here.
            coat.stand_off = 0.18;
            let (stripe, most) = stripe(&coat);
            let fit = |noise, seed| {
                let samples = with_noise(&stripe, noise * most, seed);
                fit_stripe(&samples, &Coat::default(), coat.speed, 0.18).expect("fitted")
            };
            let exact = fit(0.0, 1);
            assert_eq!(exact.gun.profile, profile);
            // The steps of the simulation blur the edge of a beta profile.
            assert!((exact.gun.width / 0.24 - 1.0).abs() < 0.012, "{exact:?}");
            assert!((exact.gun.transfer / 0.65 - 1.0).abs() < 0.01, "{exact:?}");
            assert!((exact.gun.depth / 0.072 - 1.0).abs() < 1e-9);
            assert!((exact.middle - 0.012).abs() < 1e-4, "{exact:?}");
            let bound = if profile == Profile::Gaussian {
                0.02
            } else {
                0.03
            };
            for seed in 1..4 {
                let noisy = fit(0.05, seed);
                // Width and β of a beta profile compensate each other; its volume is well determined.
                if profile == Profile::Gaussian {
                    assert_eq!(noisy.gun.profile, profile);
                    assert!((noisy.gun.width / 0.24 - 1.0).abs() < 0.02, "{noisy:?}");
                }
                assert!((noisy.gun.transfer / 0.65 - 1.0).abs() < bound, "{noisy:?}");
                assert!(noisy.residual < 1.1 * noisy.other_residual);
            }
        }
    }

    #[test]
    fn what_is_no_stripe_is_refused_by_name() {
        let coat = Coat::default();
        let refused =
            |samples: &[StripeSample]| fit_stripe(samples, &coat, 0.4, 0.15).expect_err("refused");
        let (good, _) = stripe(&coat);
        assert!(matches!(
            refused(&good[..5]),
            StripeError::Count { found: 5 }
        ));
        let changed = |change: fn(usize, &mut StripeSample)| {
            let mut bad = good.clone();
            bad.iter_mut().enumerate().for_each(|(i, s)| change(i, s));
            refused(&bad)
        };
        let nan = changed(|i, s| s.thickness = if i == 3 { f64::NAN } else { s.thickness });
        assert!(matches!(nan, StripeError::NotFinite { found: 1 }));
        let negative = changed(|i, s| s.thickness = if i == 3 { -9e-6 } else { s.thickness });
        assert!(
            matches!(negative, StripeError::Negative { .. }),
            "{negative}"
        );
        let nothing = changed(|_, s| s.thickness = 0.0);
        assert!(matches!(nothing, StripeError::NoStripe { .. }));
        let even = changed(|_, s| s.thickness = 4e-5);
        assert!(matches!(even, StripeError::NoStripe { .. }));
        let spread = changed(|i, s| s.thickness = if i % 3 == 0 { 4e-5 } else { 0.0 });
        assert!(matches!(spread, StripeError::NoStripe { .. }), "{spread}");
        let thick = changed(|_, s| s.thickness *= 100.0);
        assert!(matches!(thick, StripeError::OutOfRange { .. }), "{thick}");
        assert!(thick.advice().contains("--speed"));
        let stopped = fit_stripe(&good, &coat, 0.0, 0.15).expect_err("no speed");
        assert!(matches!(stopped, StripeError::BadSetting { .. }));
    }
}
