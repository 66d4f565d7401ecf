//! Differences between an inspection and a new inspection of the same scene.

use std::sync::Arc;

use nalgebra::{Point3, Vector3};

use super::entry::{Record, StoredVerdict};
use geometry::rigid::{PoseDelta, RigidTransform, pose_error};
use inspection::pipeline::{Inspection, Recipe, RefusalKind, Verdict, parameters::PARAMETERS};
use stages::pose::PoseEstimate;

/// The results of an inspection that are compared.
#[derive(Clone, Debug, PartialEq)]
pub struct InspectionSummary {
    /// The verdict.
    pub verdict: StoredVerdict,
    /// Name of the best guess.
    pub nearest: Option<String>,
    /// Score and margin of the best guess.
    pub score: Option<[f64; 2]>,
    /// Why it was not accepted, if that is known.
    pub reason: Option<RefusalKind>,
    /// The pose, if there is one.
    pub camera_from_part: Option<RigidTransform>,
    /// How far off the pose may be; `None` if that is not known, or the pose is unconstrained.
    pub bounds: Option<PoseDelta>,
    /// Identity of the recipe.
    pub recipe: String,
    /// All parameters, if this program can read them.
    pub parameters: Option<Arc<Recipe>>,
    /// Identity of the library.
    pub library: String,
    /// Version of the program.
    pub program: String,
}

impl InspectionSummary {
    /// Summarises an inspection by this program with this recipe and library.
    pub fn of(inspection: &Inspection, recipe: &Arc<Recipe>, library: &str) -> Self {
        let (nearest, score) = match &inspection.verdict {
            Verdict::Part {
                part,
                score,
                margin,
                ..
            } => (Some(part.clone()), Some([*score, *margin])),
            Verdict::NoPart(_) => (None, None),
        };
        let pose = inspection.found_pose();
        Self {
            verdict: StoredVerdict::from(&inspection.verdict),
            nearest,
            score,
            reason: inspection.verdict.refusal().map(|why| why.kind()),
            bounds: pose.and_then(bounds_of),
            camera_from_part: pose.map(PoseEstimate::camera_from_part),
            recipe: recipe.identity(),
            parameters: Some(Arc::clone(recipe)),
            library: library.to_owned(),
            program: env!("CARGO_PKG_VERSION").to_owned(),
        }
    }
}

impl InspectionSummary {
    /// The index of the inspection of this part among those of a frame that was inspected again.
    pub fn index_in<'a>(&self, found: impl Iterator<Item = &'a Inspection>) -> usize {
        let at = self.camera_from_part.map(|pose| pose.translation.vector);
        index_of_part(self.nearest.as_deref(), at, found)
    }
}

/// The index of a part among the inspections of a frame: of the parts of its name, or else of all, the one whose pose is nearest
/// to where it was, camera space; 0 if there are none.
pub(crate) fn index_of_part<'a>(
    name: Option<&str>,
    at: Option<Vector3<f64>>,
    found: impl Iterator<Item = &'a Inspection>,
) -> usize {
    let distance = |inspection: &Inspection| {
        let pose = inspection.found_pose().map(PoseEstimate::camera_from_part);
        let both = pose.zip(at);
        both.map_or(f64::INFINITY, |(now, before)| {
            (now.translation.vector - before).norm()
        })
    };
    let rank = |inspection: &Inspection| {
        let best = inspection.ranking.entries.first();
        let is_named = best.is_some_and(|best| Some(&*best.part) == name);
        (!is_named, distance(inspection))
    };
    let nearest = found.enumerate().min_by(|(_, a), (_, b)| {
        let ((a, near), (b, far)) = (rank(a), rank(b));
        a.cmp(&b).then(near.total_cmp(&far))
    });
    nearest.map_or(0, |(index, _)| index)
}

/// Bounds of a pose, unless it is unconstrained.
fn bounds_of(pose: &PoseEstimate) -> Option<PoseDelta> {
    let bounds = pose.bounds()?;
    Some(PoseDelta {
        rotation: bounds.turn,
        shift: bounds.shift,
    })
}

impl From<&Record> for InspectionSummary {
    fn from(Record { summary, detail }: &Record) -> Self {
        Self {
            verdict: summary.verdict,
            nearest: detail.nearest.clone(),
            score: summary.score,
            reason: summary.reason.clone(),
            bounds: detail.pose_bounds(),
            camera_from_part: detail.camera_from_part,
            recipe: detail.recipe_identity.clone(),
            parameters: detail.recipe.clone(),
            library: detail.library_identity.clone(),
            program: detail.program.clone(),
        }
    }
}

/// A parameter whose value differs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParameterChange {
    /// Path in the recipe.
    pub key: &'static str,
    /// Name for people.
    pub name: &'static str,
    /// Former value, with its unit.
    pub before: String,
    /// Present value, with its unit.
    pub now: String,
}

/// An inspection and a new inspection of the same scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Differences {
    /// The earlier results.
    pub before: InspectionSummary,
    /// The new results.
    pub now: InspectionSummary,
    /// Pose change at the part's middle, if both results have a pose of the same part.
    pub pose: Option<PoseDelta>,
}

/// Scores closer than this count as equal.
const SAME_SCORE: f64 = 5e-4;
/// Poses closer than this, metres and radians, count as equal.
const SAME_POSE: f64 = 1e-6;

impl Differences {
    /// Compares two results; `middle` is the middle of the part's extent, in part space, metres.
    pub fn between(
        before: InspectionSummary,
        now: InspectionSummary,
        middle: Option<Point3<f64>>,
    ) -> Self {
        let both = before.camera_from_part.zip(now.camera_from_part);
        let both = both.filter(|_| before.nearest == now.nearest);
        let middle = middle.unwrap_or_else(Point3::origin);
        let pose = both.map(|(before, now)| pose_error(&now, &before, &middle));
        Self { before, now, pose }
    }

    /// Returns whether verdict, best guess, score and pose are all the same.
    pub fn is_same(&self) -> bool {
        let Self { before, now, pose } = self;
        let score =
            |finding: &InspectionSummary| finding.score.map_or(f64::NAN, |[score, _]| score);
        let has_score = (before.score.is_none() && now.score.is_none())
            || (score(before) - score(now)).abs() < SAME_SCORE;
        let has_pose = match pose {
            Some(off) => off.shift.0 < SAME_POSE && off.rotation.0 < SAME_POSE,
            None => before.camera_from_part.is_none() && now.camera_from_part.is_none(),
        };
        self.has_same_result() && has_score && has_pose
    }

    /// Returns whether verdict and best guess are the same: what two frames of one part have in common, whose scores and
    /// poses differ by noise.
    pub fn has_same_result(&self) -> bool {
        let Self { before, now, .. } = self;
        before.verdict == now.verdict && before.nearest == now.nearest
    }

    /// Returns whether verdict, best guess and reason are the same, and the poses as far as their bounds tell. The pose of a
    /// part seen in Live is a mean over frames, so that of one of its frames differs from it by noise.
    pub fn has_same_outcome(&self) -> bool {
        let reasons = self.before.reason.as_ref().zip(self.now.reason.as_ref());
        let has_reason = reasons.is_none_or(|(before, now)| before == now);
        self.has_same_result() && has_reason && self.has_same_pose()
    }

    /// Returns whether neither or both have a pose, and the poses do not differ by more than the bounds of both together.
    pub fn has_same_pose(&self) -> bool {
        let Self { before, now, pose } = self;
        let Some(off) = pose else {
            return before.camera_from_part.is_some() == now.camera_from_part.is_some();
        };
        // An earlier version stored no bounds: those of the other pose count for both.
        let (shift, rotation) = match (before.bounds, now.bounds) {
            (Some(a), Some(b)) => (a.shift.0 + b.shift.0, a.rotation.0 + b.rotation.0),
            (Some(one), None) | (None, Some(one)) => (2.0 * one.shift.0, 2.0 * one.rotation.0),
            (None, None) => (SAME_POSE, SAME_POSE),
        };
        off.shift.0 <= shift && off.rotation.0 <= rotation
    }

    /// Returns the parameters whose values differ.
    pub fn changed_parameters(&self) -> Vec<ParameterChange> {
        let (Some(before), Some(now)) = (&self.before.parameters, &self.now.parameters) else {
            return Vec::new();
        };
        let changed = PARAMETERS.iter().filter(|p| p.differs(before, now));
        let change = changed.map(|parameter| ParameterChange {
            key: parameter.key,
            name: parameter.name,
            before: parameter.text(before),
            now: parameter.text(now),
        });
        change.collect()
    }

    /// Names which of recipe, library and program differ.
    pub fn changed_inputs(&self) -> Vec<&'static str> {
        let Self { before, now, .. } = self;
        [
            (before.recipe != now.recipe, "recipe"),
            (before.library != now.library, "library"),
            (before.program != now.program, "program"),
        ]
        .into_iter()
        .filter_map(|(changed, what)| changed.then_some(what))
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inspection::{
        fixtures::shipped_library,
        pipeline::{Unwatched, run},
    };
    use simulate::{PartKind, Side};
    use stages::fixtures::facing_part;

    use geometry::{
        rigid::from_euler_zyx,
        units::{Metres, Radians},
    };

    fn finding(shift: f64) -> InspectionSummary {
        InspectionSummary {
            verdict: StoredVerdict::Accepted,
            nearest: Some("fender".into()),
            score: Some([0.97, 0.4]),
            reason: None,
            bounds: None,
            camera_from_part: Some(from_euler_zyx([0.0, 0.0, 0.0, shift, 0.0, 1.4])),
            recipe: "a".into(),
            parameters: Some(Arc::default()),
            library: "b".into(),
            program: "0.1.0".into(),
        }
    }

    #[test]
    fn of_equal_parts_in_a_frame_the_nearest_is_the_one_that_it_was() {
        let library = shipped_library();
        let seen = |kind, seed| {
            let scene = facing_part(kind, Side::Left, seed);
            run(&scene, &library, &Recipe::default(), &Unwatched).expect("not cancelled")
        };
        let [here, there] = [5, 6].map(|seed| seen(PartKind::Fender, seed));
        let other = seen(PartKind::Grille, 5);
        let recipe = Arc::default();
        for (of, order, expected) in [
            (&here, [&there, &here, &other], 1),
            (&there, [&other, &there, &here], 1),
            (&other, [&here, &there, &other], 2),
        ] {
            let summary = InspectionSummary::of(of, &recipe, "");
            assert_eq!(summary.index_in(order.into_iter()), expected);
        }
        let none = InspectionSummary::of(&here, &recipe, "");
        assert_eq!(none.index_in(std::iter::empty()), 0);
    }

    #[test]
    fn a_pose_that_moved_says_by_how_much() {
        let same = Differences::between(finding(0.0), finding(0.0), None);
        assert!(same.is_same() && same.changed_inputs().is_empty());
        let moved = Differences::between(finding(0.0), finding(0.003), None);
        assert!(!moved.is_same() && moved.has_same_result());
        let off = moved.pose.expect("both have one");
        assert!((off.shift.0 - 0.003).abs() < 1e-12 && off.rotation.0 < 1e-9);
    }

    #[test]
    fn a_pose_within_its_bounds_is_the_same_outcome_and_another_reason_is_not() {
        let bounded = |shift| InspectionSummary {
            bounds: Some(PoseDelta {
                rotation: Radians(0.002),
                shift: Metres(0.0004),
            }),
            ..finding(shift)
        };
        let near = Differences::between(bounded(0.0), bounded(0.0005), None);
        assert!(near.has_same_outcome() && !near.is_same());
        let far = Differences::between(bounded(0.0), bounded(0.001), None);
        assert!(!far.has_same_outcome() && far.has_same_result());
        let unbounded = Differences::between(finding(0.0), bounded(0.0005), None);
        assert!(unbounded.has_same_outcome());
        let refused = |reason: Option<&str>| InspectionSummary {
            verdict: StoredVerdict::Rejected,
            reason: reason.map(RefusalKind::named),
            ..bounded(0.0)
        };
        let low = Some("low_score");
        for (now, is_same) in [(low, true), (Some("piece"), false), (None, true)] {
            let found = Differences::between(refused(low), refused(now), None);
            assert_eq!(found.has_same_outcome(), is_same, "{now:?}");
        }
    }

    #[test]
    fn poses_of_two_parts_are_not_compared_and_causes_are_named() {
        let other = InspectionSummary {
            nearest: Some("grille".into()),
            library: "c".into(),
            ..finding(0.0)
        };
        let found = Differences::between(finding(0.0), other, None);
        assert_eq!((found.pose, found.is_same()), (None, false));
        assert_eq!(found.changed_inputs(), ["library"]);
        assert_eq!(found.changed_parameters(), []);
    }

    #[test]
    fn a_parameter_that_was_changed_is_named_with_both_values() {
        let mut recipe = Recipe::default();
        recipe.accept.min_score = 0.75;
        let other = InspectionSummary {
            parameters: Some(Arc::new(recipe)),
            ..finding(0.0)
        };
        let changed = Differences::between(finding(0.0), other, None).changed_parameters();
        let [change] = changed.as_slice() else {
            panic!("{changed:?}");
        };
        assert_eq!(change.key, "accept.min_score");
        assert_eq!(
            [&change.before, &change.now].map(String::as_str),
            ["0.90", "0.75"]
        );
    }
}
