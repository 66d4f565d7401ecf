//! Drift of score, fit and position of one part over time, a point for each accepted inspection.

use egui::Ui;
use jiff::{Zoned, tz::TimeZone};
use nalgebra::Point3;

use geometry::statistics::lower_median;
use records::history::PoseRecord;
use shell::language::UnitSystem;
use ui::{
    language::text,
    plot::over_time,
    theme::Theme,
    widgets::{heading, sentence},
};

/// Above this number, parts are drawn in groups by their medians.
const MOST_DRAWN: usize = 240;
/// Smallest number of parts for which a drift is shown.
pub(super) const LEAST: usize = 3;
/// Drift compares the first and the last of this many equal shares.
const END: usize = 5;

/// The accepted parts of one kind, or groups of them, oldest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Drift {
    /// The part's title.
    pub title: String,
    /// Number of parts.
    pub num_parts: usize,
    /// Time of the first inspection of each group.
    at: Vec<Zoned>,
    score: Vec<f32>,
    /// Root mean square distance from the reference, metres.
    rms_m: Vec<f32>,
    /// Position of the part's middle relative to its median over all, along x, y and z of the camera, metres. NaN for
    /// groups whose references are no longer enrolled.
    offset_m: [Vec<f32>; 3],
}

impl Drift {
    /// Computes the drift of parts given in order of time; `None` if there are too few.
    pub(super) fn new(
        title: String,
        poses: &[PoseRecord],
        zone: &TimeZone,
        middle_of: impl Fn(&str) -> Option<Point3<f64>>,
    ) -> Option<Self> {
        if poses.len() < LEAST {
            return None;
        }
        let mut drift = Self {
            title,
            num_parts: poses.len(),
            at: Vec::new(),
            score: Vec::new(),
            rms_m: Vec::new(),
            offset_m: Default::default(),
        };
        let middle = |pose: &PoseRecord| Some(pose.camera_from_part * middle_of(&pose.reference)?);
        let middles: Vec<Option<Point3<f64>>> = poses.iter().map(middle).collect();
        let usual: [Option<f64>; 3] =
            std::array::from_fn(|axis| lower_median(middles.iter().flatten().map(|at| at[axis])));
        let size = poses.len().div_ceil(MOST_DRAWN);
        for (group, middles) in poses.chunks(size).zip(middles.chunks(size)) {
            let of = |value: fn(&PoseRecord) -> f64| {
                lower_median(group.iter().map(value)).unwrap_or_default() as f32
            };
            drift.at.push(group[0].at.to_zoned(zone.clone()));
            drift.score.push(of(|pose| pose.score));
            drift.rms_m.push(of(|pose| pose.rms_m));
            for (axis, offsets) in drift.offset_m.iter_mut().enumerate() {
                let here = lower_median(middles.iter().flatten().map(|at| at[axis]));
                let offset = here.zip(usual[axis]).map(|(here, usual)| here - usual);
                offsets.push(offset.map_or(f32::NAN, |offset| offset as f32));
            }
        }
        Some(drift)
    }

    /// Medians of the first and the last fifth of a series.
    fn ends(values: &[f32]) -> Option<[f64; 2]> {
        let known: Vec<f64> = values
            .iter()
            .filter(|x| x.is_finite())
            .map(|x| f64::from(*x))
            .collect();
        let num = known.len().div_ceil(END);
        let first = lower_median(known.iter().take(num).copied())?;
        let last = lower_median(known.iter().rev().take(num).copied())?;
        Some([first, last])
    }
}

/// Draws score, fit and position one below the other.
pub(super) fn ui(ui: &mut Ui, drift: &Drift, units: UnitSystem) {
    let theme = Theme::of(ui);
    heading(ui, &text!("history-drift", part = drift.title.as_str()));
    let score = |value: f64| format!("{value:.2}");
    let length = |value: f64| units.length(value);
    let one_curve =
        |ui: &mut Ui, name: String, values: &[f32], shown: (&dyn Fn(f64) -> String, f64, f64)| {
            let [first, last] = Drift::ends(values).unwrap_or_default().map(shown.0);
            let ends = text!("history-drift-ends", first = first, last = last);
            let curves = [("", values, theme.first_series)];
            let title = format!("{name}: {ends}");
            over_time(ui, &drift.at, &title, &curves, shown, theme);
        };
    let name = sentence(&text!("history-figure-score"));
    one_curve(ui, name, &drift.score, (&score, 0.1, 1.0));
    let name = text!("history-drift-fit");
    one_curve(ui, name, &drift.rms_m, (&length, 0.002, f64::INFINITY));
    let [x, y, z] = &drift.offset_m;
    if x.iter().any(|x| x.is_finite()) {
        let offset = |value: f64| units.signed_length(value);
        let moved = [x, y, z].map(|values| {
            let [first, last] = Drift::ends(values).unwrap_or_default();
            offset(last - first)
        });
        let [dx, dy, dz] = moved;
        let title = text!("history-drift-place", x = dx, y = dy, z = dz);
        let curves = [
            ("x", x, theme.first_series),
            ("y", y, theme.second_series),
            ("z", z, theme.reference_series),
        ];
        let curves = curves.map(|(name, values, colour)| (name, values.as_slice(), colour));
        over_time(
            ui,
            &drift.at,
            &title,
            &curves,
            (&offset, 0.02, f64::INFINITY),
            theme,
        );
    }
}

#[cfg(test)]
mod tests {
    use jiff::{SignedDuration, Timestamp};

    use super::*;
    use geometry::rigid::from_euler_zyx;

    /// Parts that move away by 0.1 mm each, seen by a camera that becomes noisier.
    fn poses(num: usize) -> Vec<PoseRecord> {
        let pose = |i: usize| PoseRecord {
            at: Timestamp::UNIX_EPOCH + SignedDuration::from_mins(i as i64),
            score: 0.99 - 1e-4 * i as f64,
            reference: if i % 7 == 3 { "gone" } else { "door" }.into(),
            camera_from_part: from_euler_zyx([0.0, 0.0, 0.0, 0.0, 0.0, 1e-4 * i as f64]),
            rms_m: 0.001 + 1e-5 * i as f64,
        };
        (0..num).map(pose).collect()
    }

    fn drift(num: usize) -> Option<Drift> {
        let middle_of = |name: &str| (name == "door").then(|| Point3::new(0.1, 0.2, 1.4));
        Drift::new("Door".into(), &poses(num), &TimeZone::UTC, middle_of)
    }

    #[test]
    fn a_part_that_moves_away_and_a_camera_that_becomes_noisier_show() {
        let found = drift(100).expect("a drift");
        assert_eq!((found.num_parts, found.at.len()), (100, 100));
        let [first, last] = Drift::ends(&found.offset_m[2]).expect("known");
        // From the median of the first fifth to that of the last.
        assert!((last - first - 0.008).abs() < 3e-4, "{first} {last}");
        assert_eq!(Drift::ends(&found.offset_m[0]), Some([0.0, 0.0]));
        let [first, last] = Drift::ends(&found.rms_m).expect("known");
        assert!((last - first - 0.0008).abs() < 1e-6, "{first} {last}");
        // The middle of a reference no longer enrolled is unknown.
        assert!(found.offset_m[2][3].is_nan() && found.offset_m[2][4].is_finite());
    }

    #[test]
    fn many_parts_are_drawn_in_groups_and_few_are_no_drift() {
        let found = drift(1000).expect("a drift");
        assert_eq!((found.num_parts, found.at.len()), (1000, 200));
        assert!(found.offset_m[2].iter().all(|z| z.is_finite()));
        assert_eq!(drift(2), None);
    }
}
