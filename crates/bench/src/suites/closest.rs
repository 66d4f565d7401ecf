//! The worst confusion of each part: the frame in which another part came nearest to being taken for it.

use serde::Serialize;

use super::{Suite, SuiteCase, SuiteResult};

/// A frame in which another part scored high.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NearestMistake {
    /// The part that hung there.
    pub part: String,
    /// The other part.
    pub other: String,
    /// Score of the other part.
    pub other_score: f64,
    /// Score of the part itself; 0 if it was not examined.
    pub own_score: f64,
    /// Suite of the frame.
    pub suite: Suite,
    /// Seed of the frame.
    pub seed: u64,
    /// The name found.
    pub found: Option<String>,
    /// True if the verdict was accepted.
    pub accepted: bool,
}

impl NearestMistake {
    /// Reads one frame; `None` if no enrolled part hung there, or no other one was examined.
    pub fn of(suite: Suite, case: &SuiteCase) -> Option<Self> {
        let part = case.expected.clone()?;
        let contenders = || case.contenders.iter();
        let other = contenders()
            .filter(|c| c.part != part)
            .max_by(|a, b| a.score.total_cmp(&b.score))?;
        let own = contenders().find(|c| c.part == part);
        Some(Self {
            other: other.part.clone(),
            other_score: other.score,
            own_score: own.map_or(0.0, |c| c.score),
            part,
            suite,
            seed: case.seed,
            found: case.found.clone(),
            accepted: case.accepted,
        })
    }

    /// Returns whether this is the worse confusion: false accepts first, then by the other part's score.
    pub fn is_worse_than(&self, known: &Self) -> bool {
        let badness = |c: &Self| {
            (
                c.accepted && c.found.as_ref() == Some(&c.other),
                c.other_score,
            )
        };
        badness(self) > badness(known)
    }

    /// Returns the worst confusion of each part over all suites.
    pub fn per_part(results: &[SuiteResult]) -> Vec<Self> {
        let mut worst: Vec<Self> = Vec::new();
        for result in results {
            let of_frames = result.cases.iter();
            for closest in of_frames.filter_map(|case| Self::of(result.suite, case)) {
                match worst.iter_mut().find(|known| known.part == closest.part) {
                    Some(known) if closest.is_worse_than(known) => *known = closest,
                    Some(_) => {}
                    None => worst.push(closest),
                }
            }
        }
        worst
    }

    /// Describes the verdict on the frame.
    pub fn verdict(&self) -> String {
        let found = self.found.as_deref().unwrap_or("nothing");
        let accepted = if self.accepted {
            "accepted"
        } else {
            "not accepted"
        };
        format!("{found}, {accepted}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::suites::{ReferenceCase, TUNING_SEED};
    use stages::confirm::Evidence;

    fn case(scores: &[(&str, f64)], accepted: bool) -> SuiteCase {
        let evidence = Evidence {
            off: 0.0,
            missing: 0.0,
            hidden: 0.0,
            beyond: 0.0,
            seen_m2: 0.3,
            edge_m: 2.0,
            shape: 1.0,
            close: None,
            outside: 0.0,
            relief_m: 0.0,
            outline_m: 0.0,
            outline_shift_m: None,
            outline_median_m: None,
            cut: 0.0,
            facing: 1.0,
        };
        let contender = |(part, score): &(&str, f64)| ReferenceCase {
            part: (*part).to_owned(),
            score: *score,
            evidence,
            pose_off: None,
        };
        SuiteCase {
            subject: "fender".into(),
            expected: Some("fender".into()),
            seed: TUNING_SEED,
            found: scores.first().map(|s| s.0.to_owned()),
            surplus: None,
            score: scores.first().map_or(0.0, |s| s.1),
            margin: 0.0,
            accepted,
            is_unknown: false,
            reason: None,
            is_approximate: false,
            visible_share: 1.0,
            part_iou: None,
            bounds: None,
            total_ms: None,
            timings: None,
            contenders: scores.iter().map(contender).collect(),
        }
    }

    #[test]
    fn the_frame_with_the_best_other_part_is_the_worst_unless_one_was_accepted() {
        let near = case(&[("fender", 0.99), ("grille", 0.4)], true);
        let far = case(&[("fender", 0.6), ("grille", 0.1)], false);
        let wrong = case(&[("trunk_lid", 0.3), ("fender", 0.2)], true);
        let alone = case(&[("fender", 0.9)], true);
        let worst = |cases: Vec<SuiteCase>| {
            let suite = Suite::Hard;
            NearestMistake::per_part(&[SuiteResult { suite, cases }])
        };
        let [of_near] = &worst(vec![far.clone(), near.clone(), alone.clone()])[..] else {
            panic!("one part");
        };
        assert_eq!(
            (of_near.other.as_str(), of_near.other_score),
            ("grille", 0.4)
        );
        assert_eq!(of_near.verdict(), "fender, accepted");
        let [of_wrong] = &worst(vec![near, far, wrong])[..] else {
            panic!("one part");
        };
        assert_eq!(
            (of_wrong.other.as_str(), of_wrong.own_score),
            ("trunk_lid", 0.2)
        );
        assert!(worst(vec![alone]).is_empty());
    }
}
