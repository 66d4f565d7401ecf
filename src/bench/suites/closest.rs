//! Each part's worst confusion: the frame in which another part came nearest to being taken for it.

use serde::Serialize;

use super::{Suite, SuiteCase, SuiteResult};

/// A frame in which another part came near.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NearestMistake {
    /// The part that hung there.
    pub part: String,
    /// The other one.
    pub other: String,
    /// What the other one scored.
    pub other_score: f64,
    /// What the part itself scored; 0 if it was not looked for.
    pub own_score: f64,
    /// The suite.
    pub suite: Suite,
    /// The frame's seed.
    pub seed: u64,
    /// What was named.
    pub found: Option<String>,
    /// Whether that was accepted.
    pub accepted: bool,
}

impl NearestMistake {
    /// Of one frame; `None` if no part that is enrolled hung there, or no other one was looked for.
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

    /// True if this is a worse confusion: what is wrong and accepted first, then by what the other one scored.
    pub fn is_worse_than(&self, known: &Self) -> bool {
        let badness = |c: &Self| {
            (
                c.accepted && c.found.as_ref() == Some(&c.other),
                c.other_score,
            )
        };
        badness(self) > badness(known)
    }

    /// The worst of each part, over all suites in which it is enrolled.
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

    /// What was made of the frame, in words.
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
    use crate::{
        bench::suites::{ReferenceCase, TUNING_SEED},
        pipeline::Timings,
        stages::confirm::Evidence,
    };

    fn case(scores: &[(&str, f64)], accepted: bool) -> SuiteCase {
        let evidence = Evidence {
            off: 0.0,
            missing: 0.0,
            hidden: 0.0,
            beyond: 0.0,
            seen_m2: 0.3,
            edge_m: 2.0,
            rival: 0.0,
            shape: 1.0,
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
            score: scores.first().map_or(0.0, |s| s.1),
            margin: 0.0,
            accepted,
            is_unknown: false,
            reason: None,
            is_approximate: false,
            visible_share: 1.0,
            part_iou: None,
            bounds: None,
            total_ms: 0.0,
            timings: Timings::default(),
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
