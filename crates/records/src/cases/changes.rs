//! Comparison of two runs over the same cases: which results are worse, which are better, and which scores changed.

use std::collections::{BTreeMap, BTreeSet};

use super::{
    judge::{CaseOutcome, CaseResult, FoundVerdict, Truth},
    record::{CaseRecord, EarlierRun},
};

/// Smaller changes of a score do not show with two decimals.
const LEAST_CHANGE: f64 = 0.005;

/// A case whose result changed.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseChange {
    /// The case's folder name.
    pub name: String,
    /// The true label.
    pub truth: Truth,
    /// The verdict of the earlier run.
    pub before: FoundVerdict,
    /// The verdict of the later run.
    pub now: FoundVerdict,
    /// The outcomes of the earlier and the later run.
    pub judgements: [CaseOutcome; 2],
}

/// The differences between two runs. Each list is in the order of the later run's cases.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Changes {
    /// Worse than before: no longer right, or refused before and a false accept now.
    pub regressions: Vec<CaseChange>,
    /// Better than before.
    pub mends: Vec<CaseChange>,
    /// The same outcome, with another best guess or a score that changed by 0.005 or more.
    pub rescored: Vec<CaseChange>,
    /// Number of cases in both runs.
    pub num_common: usize,
    /// Cases in the later run only.
    pub added: Vec<String>,
    /// Cases in the earlier run only: removed since, or damaged.
    pub gone: Vec<String>,
}

impl Changes {
    /// Compares these results with an earlier run. Both are judged by the present true label of the case.
    pub fn between(earlier: &EarlierRun, results: &[CaseResult]) -> Self {
        let before: BTreeMap<&str, &CaseRecord> = earlier
            .cases
            .iter()
            .map(|case| (case.name.as_str(), case))
            .collect();
        let mut changes = Self::default();
        for result in results {
            let Some(case) = before.get(result.name.as_str()) else {
                changes.added.push(result.name.clone());
                continue;
            };
            changes.num_common += 1;
            let change = CaseChange {
                name: result.name.clone(),
                truth: result.truth.clone(),
                before: case.found.clone(),
                now: result.found.clone(),
                judgements: [
                    CaseOutcome::new(&result.truth, &case.found.answered()),
                    result.judgement(),
                ],
            };
            let [was, is] = change.judgements;
            if is > was {
                changes.regressions.push(change);
            } else if is < was {
                changes.mends.push(change);
            } else if change.is_rescored() {
                changes.rescored.push(change);
            }
        }
        let now: BTreeSet<&str> = results.iter().map(|r| r.name.as_str()).collect();
        let gone = earlier.cases.iter().map(|case| &case.name);
        changes.gone = gone
            .filter(|name| !now.contains(name.as_str()))
            .cloned()
            .collect();
        changes
    }
}

impl CaseChange {
    fn is_rescored(&self) -> bool {
        let Self { before, now, .. } = self;
        before.part != now.part
            || match (before.score, now.score) {
                (Some(before), Some(now)) => !((before - now).abs() < LEAST_CHANGE),
                (before, now) => before.is_some() != now.is_some(),
            }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inspection::pipeline::Timings;

    fn found(part: Option<&str>, score: f64, accepted: bool) -> FoundVerdict {
        FoundVerdict {
            part: part.map(Into::into),
            score: part.map(|_| score),
            accepted,
            ..FoundVerdict::default()
        }
    }

    fn result(name: &str, truth: &Truth, found: FoundVerdict) -> CaseResult {
        CaseResult {
            name: name.into(),
            difficulty: None,
            truth: truth.clone(),
            found,
            pose_error: None,
            timings: Timings::default(),
        }
    }

    fn names(changes: &[CaseChange]) -> Vec<&str> {
        changes.iter().map(|c| c.name.as_str()).collect()
    }

    #[test]
    fn every_case_of_both_runs_is_a_regression_a_mend_rescored_or_unchanged() {
        let door = Truth::Part("door".into());
        let right = || found(Some("door"), 0.9, true);
        let refused = || found(Some("door"), 0.6, false);
        let wrong = || found(Some("hood"), 0.9, true);
        let cases = [
            ("kept", right(), right()),
            ("lost", right(), refused()),
            ("taken_for_another", right(), wrong()),
            ("worse", refused(), wrong()),
            ("mended", wrong(), right()),
            ("safer", wrong(), refused()),
            ("weaker", right(), found(Some("door"), 0.88, true)),
            ("as_weak", right(), found(Some("door"), 0.896, true)),
            ("other_guess", refused(), found(Some("hood"), 0.6, false)),
            ("nothing_found", refused(), found(None, 0.0, false)),
        ];
        let earlier: Vec<CaseResult> = cases
            .iter()
            .map(|(name, before, _)| result(name, &door, before.clone()))
            .collect();
        let mut earlier = EarlierRun {
            cases: earlier.iter().map(CaseRecord::from).collect(),
        };
        let mut results: Vec<CaseResult> = cases
            .iter()
            .map(|(name, _, now)| result(name, &door, now.clone()))
            .collect();
        earlier
            .cases
            .push(CaseRecord::from(&result("removed", &door, right())));
        results.push(result("new", &door, wrong()));

        let changes = Changes::between(&earlier, &results);
        assert_eq!(
            names(&changes.regressions),
            ["lost", "taken_for_another", "worse"]
        );
        assert_eq!(names(&changes.mends), ["mended", "safer"]);
        assert_eq!(
            names(&changes.rescored),
            ["weaker", "other_guess", "nothing_found"]
        );
        assert_eq!(changes.gone, ["removed"]);
        assert_eq!(changes.added, ["new"]);
        assert_eq!(changes.num_common, 10);
    }

    #[test]
    fn a_corrected_truth_is_no_regression() {
        // The label said door, and a door was accepted; then somebody saw that it was a hood.
        let answer = found(Some("door"), 0.9, true);
        let door = Truth::Part("door".into());
        let earlier = EarlierRun {
            cases: vec![CaseRecord::from(&result("a", &door, answer.clone()))],
        };
        let results = [result("a", &Truth::NotEnrolled, answer)];
        assert_eq!(results[0].judgement(), CaseOutcome::WrongAccepted);
        let changes = Changes::between(&earlier, &results);
        assert_eq!(changes.regressions, []);
        assert_eq!(changes.num_common, 1);
    }
}
