//! How score, fit and position of an accepted part change from inspection to inspection: their mean, their spread, and the trend
//! that will refuse parts.
//!
//! Only inspections by the recipe and of the source of the newest one are compared: another recipe or camera is a step, not a
//! drift. Scores are compared by their log odds, which fall by steady amounts where scores near 1 hardly change, then collapse.

use std::collections::{BTreeMap, btree_map::Entry};

use jiff::Timestamp;
use nalgebra::Point3;
use rusqlite::{OptionalExtension as _, params_from_iter};
use serde::{Deserialize, Serialize};

use super::{
    entry::{Record, StoredVerdict},
    error::HistoryError,
    filter::Filter,
    store::History,
    trend::{Limit, Trend, trend},
};
use geometry::{
    rigid::{RigidTransform, from_row_major},
    statistics::lower_median,
};
use inspection::pipeline::{AcceptParams, Recipe};

/// Maximum number of poses read; each requires parsing the JSON line of its inspection.
pub const MAX_POSES: usize = 2000;
/// Number of poses from which to predict whether a part will be refused: several times [`TREND_WINDOW`](super::trend::TREND_WINDOW), as some
/// may be of another recipe or source.
pub(super) const POSES_FOR_WARNING: usize = 400;
/// Fewest inspections for which a spread is given.
pub const LEAST_FOR_SPREAD: usize = 3;
/// How near to 0 and 1 a score comes; beyond, its log odds would be those of its last digits.
const SCORE_MARGIN: f64 = 1e-6;

/// Pose and fit of an accepted part.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseRecord {
    /// Time of the inspection.
    pub at: Timestamp,
    /// Score, 0..1.
    pub score: f64,
    /// Name of the reference that the pose refers to.
    pub reference: String,
    /// Pose of the part.
    pub camera_from_part: RigidTransform,
    /// Root mean square distance of the part from the reference, metres.
    pub rms_m: f64,
    /// 95 % bound of the position error, metres; `None` if it was not known.
    pub shift_bound_m: Option<f64>,
    /// The source.
    pub source: String,
    /// Identity of the recipe.
    pub recipe: String,
    /// The limits that it was accepted by; `None` if the recipe cannot be read.
    pub accept: Option<AcceptParams>,
}

/// The fields read from the line that `inspect --json` writes.
#[derive(Deserialize)]
struct Line {
    pose: Option<Pose>,
}

#[derive(Deserialize)]
struct Pose {
    reference: Option<String>,
    camera_from_part: [f64; 16],
    rms_m: f64,
    shift_bound_m: Option<f64>,
}

impl PoseRecord {
    /// Parses a line, without the source and the recipe; `None` without a pose, or if another version of the program wrote it in
    /// another form.
    fn of_line(at: Timestamp, score: f64, line: &str) -> Option<Self> {
        let pose = serde_json::from_str::<Line>(line).ok()?.pose?;
        Some(Self {
            at,
            score,
            reference: pose.reference?,
            camera_from_part: from_row_major(&pose.camera_from_part, 1e-6)?,
            rms_m: pose.rms_m,
            shift_bound_m: pose.shift_bound_m,
            source: String::new(),
            recipe: String::new(),
            accept: None,
        })
    }

    /// Reads an inspection from its record; `None` unless it was accepted with a score and a readable pose.
    pub fn of_record(record: &Record) -> Option<Self> {
        let Record { summary, detail } = record;
        let [score, _] = summary.score?;
        let is_accepted = summary.verdict == StoredVerdict::Accepted;
        let read = Self::of_line(summary.at, score, &detail.line).filter(|_| is_accepted)?;
        Some(Self {
            source: summary.source.clone(),
            recipe: detail.recipe_identity.clone(),
            accept: detail.recipe.as_ref().map(|recipe| recipe.accept.clone()),
            ..read
        })
    }
}

impl History {
    /// Returns the poses of the newest accepted parts that match the filter, `most` at most, the oldest first.
    pub fn poses(&self, filter: &Filter, most: usize) -> Result<Vec<PoseRecord>, HistoryError> {
        self.read_poses(filter, most)
            .map_err(|error| self.error(error))
    }

    fn read_poses(&self, filter: &Filter, most: usize) -> rusqlite::Result<Vec<PoseRecord>> {
        let (condition, values) = filter.condition();
        let asked = format!(
            "SELECT at, score, line, source, recipe FROM inspection JOIN detail USING (number)
                WHERE {condition} AND verdict = 'accepted' AND score IS NOT NULL
                ORDER BY at DESC, number DESC"
        );
        let mut asked = self.file.prepare(&asked)?;
        let rows = asked.query_map(params_from_iter(values), |row| {
            let at = Timestamp::from_microsecond(row.get(0)?).unwrap_or(Timestamp::UNIX_EPOCH);
            let line: String = row.get(2)?;
            let read = PoseRecord::of_line(at, row.get(1)?, &line);
            let (source, recipe): (String, String) = (row.get(3)?, row.get(4)?);
            Ok(read.map(|read| PoseRecord {
                source,
                recipe,
                ..read
            }))
        })?;
        let mut poses = rows
            .filter_map(Result::transpose)
            .take(most)
            .collect::<rusqlite::Result<Vec<_>>>()?;
        poses.reverse();
        // Most have the same recipe.
        let mut limits: BTreeMap<String, Option<AcceptParams>> = BTreeMap::new();
        for pose in &mut poses {
            pose.accept = match limits.entry(pose.recipe.clone()) {
                Entry::Occupied(known) => known.get().clone(),
                Entry::Vacant(unknown) => unknown.insert(self.limits_of(&pose.recipe)?).clone(),
            };
        }
        Ok(poses)
    }

    /// The limits of a recipe; `None` if it cannot be read.
    fn limits_of(&self, recipe: &str) -> rusqlite::Result<Option<AcceptParams>> {
        let asked = "SELECT json FROM recipe WHERE identity = ?";
        let json: Option<String> = self
            .file
            .query_row(asked, [recipe], |row| row.get(0))
            .optional()?;
        let recipe = json.and_then(|json| serde_json::from_str::<Recipe>(&json).ok());
        Ok(recipe.map(|recipe| recipe.accept))
    }
}

/// What is followed of a part from inspection to inspection.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DriftQuantity {
    /// The score, 0..1.
    Score,
    /// The 95 % bound of the position error, metres.
    ShiftBoundM,
    /// Root mean square distance from the reference, metres.
    RmsM,
    /// Position of the part's middle along x of the camera, from its median, metres.
    XM,
    /// The same along y.
    YM,
    /// The same along z.
    ZM,
}

impl DriftQuantity {
    /// The unit in which noise and trends are looked at, from that of the quantity.
    fn scaled(self, value: f64) -> f64 {
        match self {
            Self::Score => {
                let score = value.clamp(SCORE_MARGIN, 1.0 - SCORE_MARGIN);
                (score / (1.0 - score)).ln()
            }
            Self::ShiftBoundM | Self::RmsM | Self::XM | Self::YM | Self::ZM => value,
        }
    }

    /// The inverse of [`scaled`](Self::scaled).
    fn unscaled(self, value: f64) -> f64 {
        match self {
            Self::Score => 1.0 / (1.0 + (-value).exp()),
            Self::ShiftBoundM | Self::RmsM | Self::XM | Self::YM | Self::ZM => value,
        }
    }
}

/// One quantity of a part over its inspections.
#[derive(Clone, Debug, PartialEq)]
pub struct QuantityDrift {
    /// What it is.
    pub quantity: DriftQuantity,
    /// Its value at each inspection, oldest first; NaN where it is not known.
    pub values: Vec<f64>,
    /// The mean of the known values; of a score, that of its log odds, as a score.
    pub mean: f64,
    /// Three standard deviations below and above the mean.
    pub band: [f64; 2],
    /// Beyond this, the recipe of the newest inspection refuses parts; `None` if it does not for this quantity.
    pub limit: Option<Limit>,
    /// The trend, if noise does not explain it.
    pub trend: Option<Trend>,
}

impl QuantityDrift {
    /// `None` with fewer than [`LEAST_FOR_SPREAD`] known values.
    fn new(quantity: DriftQuantity, values: Vec<f64>, limit: Option<Limit>) -> Option<Self> {
        let scaled: Vec<f64> = values.iter().map(|value| quantity.scaled(*value)).collect();
        let known: Vec<f64> = scaled.iter().copied().filter(|x| x.is_finite()).collect();
        if known.len() < LEAST_FOR_SPREAD {
            return None;
        }
        let num = known.len() as f64;
        let mean = known.iter().sum::<f64>() / num;
        let squares: f64 = known.iter().map(|value| (value - mean).powi(2)).sum();
        let spread = 3.0 * (squares / (num - 1.0)).sqrt();
        let scaled_limit = limit.map(|limit| limit.map(|value| quantity.scaled(value)));
        let trend = trend(&scaled, scaled_limit).map(|trend| Trend {
            from: quantity.unscaled(trend.from),
            to: quantity.unscaled(trend.to),
            ..trend
        });
        Some(Self {
            quantity,
            values,
            mean: quantity.unscaled(mean),
            band: [mean - spread, mean + spread].map(|value| quantity.unscaled(value)),
            limit,
            trend,
        })
    }
}

/// A trend that will refuse parts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriftWarning {
    /// The quantity.
    pub quantity: DriftQuantity,
    /// The value beyond which parts are refused.
    pub limit: f64,
    /// Number of further inspections after which single parts pass it.
    pub refuses_in: usize,
}

/// The drift of one part.
#[derive(Clone, Debug, PartialEq)]
pub struct PartDrift {
    /// Times of the inspections, oldest first.
    pub at: Vec<Timestamp>,
    /// The known quantities, in the order of [`DriftQuantity`].
    pub quantities: Vec<QuantityDrift>,
}

impl PartDrift {
    /// Compares inspections of one part, oldest first, that were made of the source and by the recipe of the newest one; `None` if
    /// these are fewer than [`LEAST_FOR_SPREAD`]. `middle_of` gives the middle of the reference of this name, part space, metres;
    /// without it, the position is not known.
    pub fn of(
        poses: &[PoseRecord],
        middle_of: impl Fn(&str) -> Option<Point3<f64>>,
    ) -> Option<Self> {
        let newest = poses.last()?;
        let is_comparable =
            |pose: &&PoseRecord| pose.source == newest.source && pose.recipe == newest.recipe;
        let poses: Vec<&PoseRecord> = poses.iter().filter(is_comparable).collect();
        if poses.len() < LEAST_FOR_SPREAD {
            return None;
        }
        let accept = newest.accept.as_ref();
        let of = |value: fn(&PoseRecord) -> f64| -> Vec<f64> {
            poses.iter().map(|pose| value(pose)).collect()
        };
        let judged = [
            (
                DriftQuantity::Score,
                of(|pose| pose.score),
                accept.map(|accept| Limit::AtLeast(accept.min_score)),
            ),
            (
                DriftQuantity::ShiftBoundM,
                of(|pose| pose.shift_bound_m.unwrap_or(f64::NAN)),
                accept.map(|accept| Limit::AtMost(accept.max_uncertainty.0)),
            ),
            (DriftQuantity::RmsM, of(|pose| pose.rms_m), None),
        ];
        let [x, y, z] = offsets(&poses, middle_of);
        let place = [
            (DriftQuantity::XM, x, None),
            (DriftQuantity::YM, y, None),
            (DriftQuantity::ZM, z, None),
        ];
        let known = judged.into_iter().chain(place).filter_map(
            |(quantity, values, limit): (_, Vec<f64>, Option<Limit>)| {
                QuantityDrift::new(quantity, values, limit)
            },
        );
        Some(Self {
            at: poses.iter().map(|pose| pose.at).collect(),
            quantities: known.collect(),
        })
    }

    /// The trend that refuses parts first.
    pub fn warning(&self) -> Option<DriftWarning> {
        let warnings = self.quantities.iter().filter_map(|of| {
            Some(DriftWarning {
                quantity: of.quantity,
                limit: of.limit?.value(),
                refuses_in: of.trend?.refuses_in?,
            })
        });
        warnings.min_by_key(|warning| warning.refuses_in)
    }
}

/// Where the middles of the parts are, from their median, along x, y and z of the camera, metres; NaN where the middle of the
/// reference is not known.
fn offsets(
    poses: &[&PoseRecord],
    middle_of: impl Fn(&str) -> Option<Point3<f64>>,
) -> [Vec<f64>; 3] {
    let mut middles: BTreeMap<&str, Option<Point3<f64>>> = BTreeMap::new();
    let places: Vec<Option<Point3<f64>>> = poses
        .iter()
        .map(|pose| {
            let name = pose.reference.as_str();
            let middle = *middles.entry(name).or_insert_with(|| middle_of(name));
            middle.map(|middle| pose.camera_from_part * middle)
        })
        .collect();
    std::array::from_fn(|axis| {
        let usual = lower_median(places.iter().flatten().map(|at| at[axis])).unwrap_or_default();
        let offsets = places
            .iter()
            .map(|at| at.map_or(f64::NAN, |at| at[axis] - usual));
        offsets.collect()
    })
}

#[cfg(test)]
mod tests {
    use jiff::SignedDuration;

    use super::*;
    use geometry::{rigid::from_euler_zyx, units::Metres};

    /// Parts that move away by 0.1 mm each, whose score falls, seen by a camera that becomes noisier.
    fn poses(num: usize) -> Vec<PoseRecord> {
        let pose = |index: usize| {
            let at = index as f64;
            PoseRecord {
                at: Timestamp::UNIX_EPOCH + SignedDuration::from_mins(index as i64),
                score: 1.0 / (1.0 + (0.01 * at - 4.0).exp()),
                reference: if index % 7 == 3 { "gone" } else { "door" }.into(),
                camera_from_part: from_euler_zyx([0.0, 0.0, 0.0, 0.0, 0.0, 1e-4 * at]),
                rms_m: 0.001 + 1e-5 * at,
                shift_bound_m: Some(0.004),
                source: "kinect".into(),
                recipe: "usual".into(),
                accept: Some(AcceptParams {
                    min_score: 0.9,
                    max_uncertainty: Metres::from_mm(11.0),
                    ..AcceptParams::default()
                }),
            }
        };
        (0..num).map(pose).collect()
    }

    fn middle_of(name: &str) -> Option<Point3<f64>> {
        (name == "door").then(|| Point3::new(0.1, 0.2, 1.4))
    }

    fn quantity(found: &PartDrift, quantity: DriftQuantity) -> &QuantityDrift {
        let mut all = found.quantities.iter();
        all.find(|of| of.quantity == quantity).expect("known")
    }

    #[test]
    fn mean_band_trend_and_limit_are_those_of_the_values() {
        let found = PartDrift::of(&poses(100), middle_of).expect("a drift");
        assert_eq!((found.at.len(), found.quantities.len()), (100, 6));
        let rms = quantity(&found, DriftQuantity::RmsM);
        assert!((rms.mean - 0.001_495).abs() < 1e-9, "{}", rms.mean);
        // The variance of 0, 1, … 99 is 100 · 101 / 12.
        let spread = 3e-5 * (100.0_f64 * 101.0 / 12.0).sqrt();
        assert!((rms.band[1] - rms.mean - spread).abs() < 1e-9);
        assert_eq!(rms.limit, None);
        let trend = rms.trend.expect("a trend");
        assert!((trend.to - trend.from - 99e-5).abs() < 1e-9, "{trend:?}");
        // A part that moves away and whose reference is known.
        let z = quantity(&found, DriftQuantity::ZM);
        assert!(z.values[3].is_nan() && (z.values[99] - z.values[0] - 0.0099).abs() < 1e-9);
        assert!(z.trend.is_some());
        assert_eq!(quantity(&found, DriftQuantity::XM).trend, None);
        let bound = quantity(&found, DriftQuantity::ShiftBoundM);
        assert_eq!(
            (bound.limit, bound.trend),
            (Some(Limit::AtMost(Metres::from_mm(11.0).0)), None)
        );
    }

    #[test]
    fn a_score_that_hardly_falls_yet_is_warned_about_with_the_inspections_that_are_left() {
        // The log odds of 0.9 are 2.197, which the part after the 180th has.
        for (num, expected) in [(100, Some(82)), (60, None), (170, Some(12))] {
            let found = PartDrift::of(&poses(num), middle_of).expect("a drift");
            let warning = found.warning();
            assert_eq!(warning.map(|warning| warning.refuses_in), expected, "{num}");
            if let Some(warning) = warning {
                assert_eq!(warning.quantity, DriftQuantity::Score);
                assert!((warning.limit - 0.9).abs() < 1e-12);
            }
        }
        let score = |num: usize| poses(num).pop().expect("a pose").score;
        assert!(score(1) - score(100) < 0.03, "hardly to be seen");
    }

    #[test]
    fn only_inspections_by_the_newest_recipe_and_of_its_source_are_compared() {
        let mut all = poses(100);
        for pose in &mut all[..60] {
            pose.recipe = "former".into();
        }
        all[70].source = "a file".into();
        let found = PartDrift::of(&all, |_| None).expect("a drift");
        assert_eq!(found.at.len(), 39);
        assert_eq!(found.quantities.len(), 3, "no middle, no position");
        all[99].source = "a file".into();
        assert_eq!(PartDrift::of(&all, |_| None), None, "one alone");
        assert_eq!(PartDrift::of(&[], |_| None), None);
    }
}
