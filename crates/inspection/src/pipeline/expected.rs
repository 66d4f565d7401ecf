//! What should hang before the camera, and how what hangs there differs from it.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::{Rejection, Unrecognisable, Verdict};
use geometry::error::Advice;
use stages::segment::MAX_PARTS;

/// The parts that should hang there, by name; a name that is given twice stands for two such parts. Empty if nothing is
/// known about it.
///
/// It never turns a refusal for lack of evidence into an acceptance: where the expected part is the best match, it settles
/// ties with parts that are alike and not expected, and it refuses parts that are not expected.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Expected(Vec<String>);

/// Why parts cannot be expected.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ExpectedError {
    /// More than a frame can show.
    #[error("{found} parts are expected, and a frame can show {MAX_PARTS}")]
    TooMany {
        /// Their number.
        found: usize,
    },
    /// The library has no such part.
    #[error("{name} is expected, but not enrolled")]
    NotEnrolled {
        /// The name.
        name: String,
    },
}

impl Advice for ExpectedError {
    fn advice(&self) -> String {
        match self {
            Self::TooMany { .. } => format!("Expect up to {MAX_PARTS} parts"),
            Self::NotEnrolled { .. } => {
                "Give names of parts of the library; partsight library list shows them".into()
            }
        }
    }
}

impl Expected {
    /// Expects these enrolled parts, up to [`MAX_PARTS`].
    pub fn new(
        parts: Vec<String>,
        is_enrolled: impl Fn(&str) -> bool,
    ) -> Result<Self, ExpectedError> {
        let found = parts.len();
        if found > MAX_PARTS {
            return Err(ExpectedError::TooMany { found });
        }
        match parts.iter().find(|name| !is_enrolled(name)) {
            Some(name) => Err(ExpectedError::NotEnrolled { name: name.clone() }),
            None => Ok(Self(parts)),
        }
    }

    /// The names, as they were given.
    pub fn parts(&self) -> &[String] {
        &self.0
    }

    /// True if nothing is known about what should hang there.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// True if the first part is expected, and the other is not.
    pub(super) fn prefers(&self, part: &str, other: &str) -> bool {
        let includes = |name: &str| self.0.iter().any(|expected| expected == name);
        includes(part) && !includes(other)
    }

    /// Refuses the accepted parts that are not expected, each in place of one that is missing, as long as any is.
    pub(super) fn refuse_others(&self, found: &mut [&mut Verdict]) {
        if self.is_empty() {
            return;
        }
        let seen: Vec<&Verdict> = found.iter().map(|verdict| &**verdict).collect();
        let (mut left, surplus) = self.matched(&seen);
        for index in surplus {
            let Verdict::Part { part, rejected, .. } = &mut *found[index] else {
                continue;
            };
            let part = part.clone();
            *rejected = Some(if left.is_empty() {
                Rejection::NotExpected { part }
            } else {
                let expected = left.remove(0).to_owned();
                Rejection::WrongPart { part, expected }
            });
        }
    }

    /// The expected parts that nothing hangs in place of, by the verdicts on a frame. If nothing could be inspected, it is
    /// not known.
    pub fn missing(&self, found: &[&Verdict]) -> Vec<&str> {
        let is_blind = |verdict: &&Verdict| {
            matches!(
                verdict,
                Verdict::NoPart(Unrecognisable::EmptyLibrary | Unrecognisable::Fault(_))
            )
        };
        if found.iter().any(is_blind) {
            return Vec::new();
        }
        let (mut left, _) = self.matched(found);
        for verdict in found {
            if let Some(Rejection::WrongPart { expected, .. }) = verdict.rejected() {
                take_one(&mut left, expected);
            }
        }
        left
    }

    /// True if every expected part is accepted, and nothing else is an enrolled part, by the verdicts on a frame.
    pub fn is_met(&self, found: &[&Verdict]) -> bool {
        let (left, surplus) = self.matched(found);
        let accepted = found.iter().filter(|verdict| verdict.is_accepted());
        let num_refused = found.iter().filter(|verdict| {
            let is_named = name_of(verdict).is_some();
            is_named && !verdict.is_accepted()
        });
        left.is_empty()
            && surplus.is_empty()
            && accepted.count() == self.0.len()
            && num_refused.count() == 0
    }

    /// The expected parts that were not found, accepted or not, and the indices of the accepted ones that are not expected.
    fn matched(&self, found: &[&Verdict]) -> (Vec<&str>, Vec<usize>) {
        let mut left: Vec<&str> = self.0.iter().map(String::as_str).collect();
        let mut surplus = Vec::new();
        for is_accepted in [true, false] {
            for (index, verdict) in found.iter().enumerate() {
                if verdict.is_accepted() != is_accepted {
                    continue;
                }
                let is_left = name_of(verdict).is_some_and(|name| take_one(&mut left, name));
                if is_accepted && !is_left {
                    surplus.push(index);
                }
            }
        }
        (left, surplus)
    }
}

/// The name of a part that is not unknown.
fn name_of(verdict: &Verdict) -> Option<&str> {
    verdict.guess().filter(|_| !verdict.is_unknown())
}

/// Removes one such name. Returns false if there is none.
fn take_one(names: &mut Vec<&str>, name: &str) -> bool {
    let place = names.iter().position(|other| *other == name);
    place.map(|place| names.remove(place)).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(part: &str, rejected: Option<Rejection>) -> Verdict {
        Verdict::Part {
            part: part.into(),
            score: 0.95,
            margin: 0.95,
            rejected,
            is_approximate: false,
        }
    }

    fn accepted(part: &str) -> Verdict {
        found(part, None)
    }

    fn refused(part: &str) -> Verdict {
        let part_name = part.to_owned();
        let rejected = Rejection::Unconfirmed { part: part_name };
        found(part, Some(rejected))
    }

    fn unknown() -> Verdict {
        let nearest = "hood".to_owned();
        let rejected = Rejection::Unknown {
            nearest,
            score: 0.2,
        };
        found("hood", Some(rejected))
    }

    /// What the expectation makes of a frame: what is wrong with each part, what is missing, and whether it is as expected.
    fn judged(expected: &[&str], mut verdicts: Vec<Verdict>) -> (Vec<String>, Vec<String>, bool) {
        let expected = Expected(expected.iter().map(|&name| name.to_owned()).collect());
        expected.refuse_others(&mut verdicts.iter_mut().collect::<Vec<_>>());
        let seen: Vec<&Verdict> = verdicts.iter().collect();
        let wrong = verdicts.iter().map(|verdict| match verdict.rejected() {
            Some(Rejection::WrongPart { part, expected }) => format!("{part} for {expected}"),
            Some(Rejection::NotExpected { part }) => format!("not {part}"),
            Some(_) => "refused".into(),
            None => "accepted".into(),
        });
        let missing = expected.missing(&seen).into_iter().map(str::to_owned);
        (wrong.collect(), missing.collect(), expected.is_met(&seen))
    }

    /// Expected parts, verdicts, what is wrong with each, what is missing, and whether it is as expected.
    type Case<'a> = (
        &'a [&'a str],
        Vec<Verdict>,
        &'a [&'a str],
        &'a [&'a str],
        bool,
    );

    #[test]
    fn each_part_is_expected_wrong_missing_or_too_many() {
        let (door, fender, hood) = ("door", "fender", "hood");
        let cases: [Case<'_>; 9] = [
            (
                &[fender, door],
                vec![accepted(door), accepted(fender)],
                &["accepted", "accepted"],
                &[],
                true,
            ),
            (
                &[fender],
                vec![accepted(door)],
                &["door for fender"],
                &[],
                false,
            ),
            (
                &[fender, hood],
                vec![accepted(door)],
                &["door for fender"],
                &[hood],
                false,
            ),
            (
                &[fender],
                vec![accepted(door), accepted(fender)],
                &["not door", "accepted"],
                &[],
                false,
            ),
            (
                &[door, door],
                vec![accepted(door)],
                &["accepted"],
                &[door],
                false,
            ),
            (
                &[door],
                vec![accepted(door), accepted(door)],
                &["accepted", "not door"],
                &[],
                false,
            ),
            // It hangs there, and is not accepted.
            (&[fender], vec![refused(fender)], &["refused"], &[], false),
            (
                &[fender, hood],
                vec![accepted(fender), unknown()],
                &["accepted", "refused"],
                &[hood],
                false,
            ),
            // What is not enrolled may hang beside it.
            (
                &[fender],
                vec![accepted(fender), unknown()],
                &["accepted", "refused"],
                &[],
                true,
            ),
        ];
        for (expected, verdicts, wrong, missing, is_met) in cases {
            let shown = format!("{expected:?}: {verdicts:?}");
            let found = judged(expected, verdicts);
            let (found_wrong, found_missing, found_met) = &found;
            assert_eq!(found_wrong, wrong, "{shown}");
            assert_eq!(found_missing, missing, "{shown}");
            assert_eq!(*found_met, is_met, "{shown}");
        }
        let nothing = judged(&[], vec![accepted(door)]);
        assert_eq!(nothing.0, ["accepted"]);
    }
}
