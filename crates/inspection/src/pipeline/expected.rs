//! What should hang before the camera, and how what hangs there differs from it.

use std::{fmt, iter};

use serde::{Deserialize, Serialize};

use super::{Inspection, Rejection, Unrecognisable, Verdict};
use stages::{rack::Rack, segment::MAX_PARTS};
use texts::{Described, Message};

/// A part that should hang there; as text, `PART` or `PLACE=PART`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub struct ExpectedPart {
    /// Its name.
    pub name: String,
    /// Name of the rack's place where it should hang; `None` if it may hang at any.
    pub place: Option<String>,
}

impl From<&str> for ExpectedPart {
    /// Reads `PART` or `PLACE=PART`.
    fn from(text: &str) -> Self {
        let (place, name) = text.rsplit_once('=').unzip();
        Self {
            name: name.unwrap_or(text).trim().to_owned(),
            place: place.map(|place| place.trim().to_owned()),
        }
    }
}

impl From<String> for ExpectedPart {
    fn from(text: String) -> Self {
        (&*text).into()
    }
}

impl From<ExpectedPart> for String {
    fn from(ExpectedPart { name, place }: ExpectedPart) -> Self {
        match place {
            Some(place) => format!("{place}={name}"),
            None => name,
        }
    }
}

impl fmt::Display for ExpectedPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, place } = self;
        match place {
            Some(place) => write!(f, "{name} at {place}"),
            None => f.write_str(name),
        }
    }
}

/// The parts that should hang there; one that is given twice stands for two such parts. Empty if nothing is known about it.
///
/// What hangs at a place for which a part is expected is held against that part; what hangs elsewhere, against the parts that
/// may hang at any place.
///
/// It never turns a refusal for lack of evidence into an acceptance: where the expected part fits about as well as
/// the best match, it settles ties with parts that are alike and not expected, and it refuses parts that are not expected.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Written", into = "Written")]
pub struct Expected(Vec<ExpectedPart>);

/// The fields of a line of JSON.
#[derive(Serialize, Deserialize)]
struct Written {
    #[serde(default)]
    expected: Vec<String>,
    /// The place of each; left out if each may hang anywhere.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    expected_places: Vec<Option<String>>,
}

impl From<Written> for Expected {
    fn from(written: Written) -> Self {
        let places = written.expected_places.into_iter();
        let parts = (written.expected.into_iter()).zip(places.chain(iter::repeat(None)));
        Self(
            parts
                .map(|(name, place)| ExpectedPart { name, place })
                .collect(),
        )
    }
}

impl From<Expected> for Written {
    fn from(Expected(parts): Expected) -> Self {
        Self {
            expected_places: places_of(&parts).unwrap_or_default(),
            expected: parts.into_iter().map(|part| part.name).collect(),
        }
    }
}

/// The place of each part; `None` if each may hang anywhere.
pub fn places_of<'a>(
    parts: impl IntoIterator<Item = &'a ExpectedPart>,
) -> Option<Vec<Option<String>>> {
    let places: Vec<_> = (parts.into_iter()).map(|part| part.place.clone()).collect();
    places.iter().any(Option::is_some).then_some(places)
}

/// Why parts cannot be expected.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum ExpectedError {
    /// More than a frame can show.
    TooMany {
        /// Their number.
        found: usize,
    },
    /// The library has no such part.
    NotEnrolled {
        /// The name.
        name: String,
    },
    /// The rack has no such place.
    NoSuchPlace {
        /// The place.
        place: String,
        /// Names of the places that it has, with commas between them; empty without a rack.
        known: String,
    },
    /// Two parts are expected at a place.
    PlaceTwice {
        /// The place.
        place: String,
    },
}

impl Described for ExpectedError {
    fn message(&self) -> Message {
        let message = Message::tagged("expected", "kind", self).with("limit", MAX_PARTS as f64);
        match self {
            Self::NoSuchPlace { known, .. } => message.with("has_places", !known.is_empty()),
            _ => message,
        }
    }
}

texts::display!(ExpectedError);

impl ExpectedError {
    /// The same, of a recipe that expects these parts.
    pub fn of_recipe(&self, recipe: &str) -> Message {
        let message = Message::new("expected-recipe").with("recipe", recipe);
        message.caused_by(self.message())
    }
}

impl Expected {
    /// Expects these enrolled parts, up to [`MAX_PARTS`], and up to one at each place of the rack; without one, as for a scan,
    /// wherever they hang.
    pub fn new(
        mut parts: Vec<ExpectedPart>,
        rack: Option<&Rack>,
        is_enrolled: impl Fn(&str) -> bool,
    ) -> Result<Self, ExpectedError> {
        let found = parts.len();
        if found > MAX_PARTS {
            return Err(ExpectedError::TooMany { found });
        }
        if let Some(part) = parts.iter().find(|part| !is_enrolled(&part.name)) {
            let name = part.name.clone();
            return Err(ExpectedError::NotEnrolled { name });
        }
        let Some(rack) = rack else {
            return Ok(Self(parts).anywhere());
        };
        let mut taken: Vec<&str> = Vec::new();
        for place in parts.iter_mut().filter_map(|part| part.place.as_mut()) {
            let mut places = rack.places.iter().map(|place| &*place.name);
            let Some(known) = places.find(|name| name.trim() == place.trim()) else {
                let known: Vec<&str> = rack.places.iter().map(|place| &*place.name).collect();
                return Err(ExpectedError::NoSuchPlace {
                    place: place.clone(),
                    known: known.join(", "),
                });
            };
            if taken.contains(&known) {
                let place = known.to_owned();
                return Err(ExpectedError::PlaceTwice { place });
            }
            taken.push(known);
            known.clone_into(place);
        }
        Ok(Self(parts))
    }

    /// The same parts wherever they hang, for an inspection without the rack.
    #[must_use]
    pub fn anywhere(self) -> Self {
        let parts = self.0.into_iter();
        Self(
            parts
                .map(|part| ExpectedPart {
                    place: None,
                    ..part
                })
                .collect(),
        )
    }

    /// The parts, as they were given.
    pub fn parts(&self) -> &[ExpectedPart] {
        &self.0
    }

    /// True if nothing is known about what should hang there.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// True if the first part is expected, and the other is not.
    pub(super) fn prefers(&self, part: &str, other: &str) -> bool {
        let includes = |name: &str| self.0.iter().any(|expected| expected.name == name);
        includes(part) && !includes(other)
    }

    /// Refuses the accepted parts that are not expected where they hang: each in place of one that is missing there, or
    /// because it is missing elsewhere, as long as any is.
    pub(super) fn refuse_others(&self, found: &mut [Inspection]) {
        if self.is_empty() {
            return;
        }
        let (all_left, surplus) = self.matched(&found.iter().collect::<Vec<_>>());
        let mut left = all_left.clone();
        for index in surplus {
            let one = &mut found[index];
            let Verdict::Part { part, rejected, .. } = &mut one.verdict else {
                continue;
            };
            let (part, place) = (part.clone(), &one.place);
            let own = self.at(place.as_deref());
            let own = own.filter(|own| own.name != part && all_left.contains(own));
            let elsewhere =
                |one: &ExpectedPart| one.name == part && one.place.is_some() && one.place != *place;
            *rejected = Some(if let Some(own) = own {
                let expected = own.name.clone();
                Rejection::WrongPart { part, expected }
            } else if let Some(place) = place
                && let Some(expected_at) =
                    take(&mut left, elsewhere).and_then(|one| one.place.clone())
            {
                let place = place.clone();
                Rejection::ExpectedElsewhere {
                    part,
                    place,
                    expected_at,
                }
            } else if let Some(other) = take(&mut left, |one| self.is_for(one, place.as_deref())) {
                let expected = other.name.clone();
                Rejection::WrongPart { part, expected }
            } else {
                Rejection::NotExpected { part }
            });
        }
    }

    /// The expected parts that nothing hangs in place of, and that hang at no other place, by the inspections of a frame. If
    /// nothing could be inspected, it is not known.
    pub fn missing(&self, found: &[&Inspection]) -> Vec<&ExpectedPart> {
        let is_blind = |one: &&Inspection| {
            matches!(
                one.verdict,
                Verdict::NoPart(Unrecognisable::EmptyLibrary | Unrecognisable::Fault(_))
            )
        };
        if found.iter().any(is_blind) {
            return Vec::new();
        }
        let (mut left, _) = self.matched(found);
        for one in found {
            if let Some(Rejection::WrongPart { expected, .. }) = one.verdict.rejected() {
                let place = one.place.as_deref();
                take(&mut left, |part| {
                    part.name == *expected && self.is_for(part, place)
                });
            }
        }
        left
    }

    /// True if every expected part is accepted, and nothing else is an enrolled part, by the inspections of a frame.
    pub fn is_met(&self, found: &[&Inspection]) -> bool {
        let (left, surplus) = self.matched(found);
        let accepted = found.iter().filter(|one| one.verdict.is_accepted());
        let num_refused = found.iter().filter(|one| {
            let is_named = name_of(&one.verdict).is_some();
            is_named && !one.verdict.is_accepted()
        });
        left.is_empty()
            && surplus.is_empty()
            && accepted.count() == self.0.len()
            && num_refused.count() == 0
    }

    /// The expected parts that were not found, accepted or not, and the indices of the accepted ones that are not expected.
    fn matched(&self, found: &[&Inspection]) -> (Vec<&ExpectedPart>, Vec<usize>) {
        let mut left: Vec<&ExpectedPart> = self.0.iter().collect();
        let mut surplus = Vec::new();
        // What hangs where it may comes before what hangs elsewhere and takes the same name.
        for order in [(true, false), (false, false), (false, true)] {
            for (index, one) in found.iter().enumerate() {
                let verdict = &one.verdict;
                let (is_accepted, is_misplaced) = (verdict.is_accepted(), is_misplaced(verdict));
                if (is_accepted, is_misplaced) != order {
                    continue;
                }
                let place = one.place.as_deref();
                let is_it = |name: &str, part: &ExpectedPart| {
                    let is_here = match verdict.rejected() {
                        Some(Rejection::ExpectedElsewhere { expected_at, .. }) => {
                            part.place.as_ref() == Some(expected_at)
                        }
                        _ => is_misplaced || self.is_for(part, place),
                    };
                    part.name == name && is_here
                };
                let taken =
                    name_of(verdict).and_then(|name| take(&mut left, |part| is_it(name, part)));
                if is_accepted && taken.is_none() {
                    surplus.push(index);
                }
            }
        }
        (left, surplus)
    }

    /// True if any expected part is accepted where it should hang.
    pub(super) fn has_any(&self, found: &[Inspection]) -> bool {
        let (_, surplus) = self.matched(&found.iter().collect::<Vec<_>>());
        let accepted = found.iter().filter(|one| one.verdict.is_accepted());
        accepted.count() > surplus.len()
    }

    /// The part that is expected at a place itself.
    fn at(&self, place: Option<&str>) -> Option<&ExpectedPart> {
        let mut parts = self.0.iter();
        parts.find(|part| part.place.is_some() && part.place.as_deref() == place)
    }

    /// True if what hangs at a place is held against this part.
    fn is_for(&self, part: &ExpectedPart, place: Option<&str>) -> bool {
        match self.at(place) {
            Some(own) => own == part,
            None => part.place.is_none(),
        }
    }
}

/// True if the part is refused because of where it hangs.
fn is_misplaced(verdict: &Verdict) -> bool {
    matches!(
        verdict.rejected(),
        Some(
            Rejection::ExpectedElsewhere { .. }
                | Rejection::WrongPlace { .. }
                | Rejection::BesidePlaces { .. }
        )
    )
}

/// The name of a part that is not unknown.
fn name_of(verdict: &Verdict) -> Option<&str> {
    verdict.guess().filter(|_| !verdict.is_unknown())
}

/// Removes and returns the first that is it.
fn take<'a>(
    parts: &mut Vec<&'a ExpectedPart>,
    is_it: impl Fn(&ExpectedPart) -> bool,
) -> Option<&'a ExpectedPart> {
    let index = parts.iter().position(|part| is_it(part));
    index.map(|index| parts.remove(index))
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{error::Advice as _, oriented_box::OrientedBox, units::Radians};
    use stages::rack::{MaxTurn, Place};

    fn found(part: &str, rejected: Option<Rejection>) -> Inspection {
        let fault = serde_json::from_str(r#"{"message": ""}"#);
        let mut one = Inspection::broken_off(fault.expect("a fault"), 0);
        one.verdict = Verdict::Part {
            part: part.into(),
            score: 0.95,
            margin: 0.95,
            rejected,
            is_approximate: false,
        };
        one
    }

    fn accepted(part: &str) -> Inspection {
        found(part, None)
    }

    fn refused(part: &str) -> Inspection {
        let part_name = part.to_owned();
        let rejected = Rejection::Unconfirmed { part: part_name };
        found(part, Some(rejected))
    }

    /// At its place in the rack: `PLACE=PART`.
    fn hung(text: &str, hang: impl Fn(&str) -> Inspection) -> Inspection {
        let ExpectedPart { name, place } = text.into();
        Inspection {
            place,
            ..hang(&name)
        }
    }

    fn unknown() -> Inspection {
        let nearest = "hood".to_owned();
        let rejected = Rejection::Unknown {
            nearest,
            score: 0.2,
        };
        found("hood", Some(rejected))
    }

    /// What the expectation makes of a frame: what is wrong with each part, what is missing, and whether it is as expected.
    fn judged(expected: &[&str], mut found: Vec<Inspection>) -> (Vec<String>, Vec<String>, bool) {
        let expected = Expected(expected.iter().map(|&text| text.into()).collect());
        expected.refuse_others(&mut found);
        let seen: Vec<&Inspection> = found.iter().collect();
        let wrong = found.iter().map(|one| match one.verdict.rejected() {
            Some(Rejection::WrongPart { part, expected }) => format!("{part} for {expected}"),
            Some(Rejection::NotExpected { part }) => format!("not {part}"),
            Some(Rejection::ExpectedElsewhere { expected_at, .. }) => format!("to {expected_at}"),
            Some(_) => "refused".into(),
            None => "accepted".into(),
        });
        let missing = expected.missing(&seen).into_iter().map(ToString::to_string);
        (wrong.collect(), missing.collect(), expected.is_met(&seen))
    }

    /// Expected parts, verdicts, what is wrong with each, what is missing, and whether it is as expected.
    type Case<'a> = (
        &'a [&'a str],
        Vec<Inspection>,
        &'a [&'a str],
        &'a [&'a str],
        bool,
    );

    fn assert_judged<'a>(cases: impl IntoIterator<Item = Case<'a>>) {
        for (expected, hung, wrong, missing, is_met) in cases {
            let shown = format!("{expected:?}: {hung:?}");
            let (found_wrong, found_missing, found_met) = judged(expected, hung);
            assert_eq!(found_wrong, wrong, "{shown}");
            assert_eq!(found_missing, missing, "{shown}");
            assert_eq!(found_met, is_met, "{shown}");
        }
    }

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
        assert_judged(cases);
        let nothing = judged(&[], vec![accepted(door)]);
        assert_eq!(nothing.0, ["accepted"]);
    }

    #[test]
    fn what_hangs_at_a_place_is_held_against_what_is_expected_there() {
        let a = |text: &str| hung(text, accepted);
        let swapped = || vec![a("l=grille"), a("r=fender")];
        let both: &[&str] = &["l=fender", "r=grille"];
        let cases: [Case<'_>; 7] = [
            (
                both,
                vec![a("l=fender"), a("r=grille")],
                &["accepted", "accepted"],
                &[],
                true,
            ),
            (
                both,
                swapped(),
                &["grille for fender", "fender for grille"],
                &[],
                false,
            ),
            (
                both,
                vec![a("l=fender")],
                &["accepted"],
                &["grille at r"],
                false,
            ),
            // The place where it hangs expects another part.
            (
                both,
                vec![a("r=fender")],
                &["fender for grille"],
                &["fender at l"],
                false,
            ),
            // The place where it hangs expects none.
            (
                both,
                vec![a("m=fender")],
                &["to l"],
                &["grille at r"],
                false,
            ),
            (
                both,
                vec![a("m=fender"), a("l=door")],
                &["to l", "door for fender"],
                &["grille at r"],
                false,
            ),
            // Only one of two is missing elsewhere.
            (
                &["l=fender"],
                vec![a("m=fender"), a("r=fender")],
                &["to l", "not fender"],
                &[],
                false,
            ),
        ];
        assert_judged(cases);
    }

    #[test]
    fn what_may_hang_anywhere_may_not_hang_where_another_part_is_expected() {
        let a = |text: &str| hung(text, accepted);
        let cases: [Case<'_>; 6] = [
            (
                &["l=fender", "grille"],
                vec![a("l=grille")],
                &["grille for fender"],
                &["grille"],
                false,
            ),
            (
                &["l=fender", "grille"],
                vec![a("l=fender"), a("m=grille")],
                &["accepted", "accepted"],
                &[],
                true,
            ),
            (
                &["l=fender", "grille"],
                vec![a("m=door")],
                &["door for grille"],
                &["fender at l"],
                false,
            ),
            (
                &["fender", "l=fender"],
                vec![a("m=fender"), a("l=fender")],
                &["accepted", "accepted"],
                &[],
                true,
            ),
            // It hangs at its place, and is not accepted.
            (
                &["l=fender"],
                vec![hung("l=fender", refused)],
                &["refused"],
                &[],
                false,
            ),
            // What is unknown stays unknown.
            (
                &["l=fender"],
                vec![Inspection {
                    place: Some("l".into()),
                    ..unknown()
                }],
                &["refused"],
                &["fender at l"],
                false,
            ),
        ];
        assert_judged(cases);
    }

    #[test]
    fn a_part_that_hangs_elsewhere_takes_no_place_from_one_that_is_refused_at_its_own() {
        assert_judged([(
            &["l=fender", "r=fender"][..],
            vec![hung("m=fender", accepted), hung("l=fender", refused)],
            &["to r", "refused"][..],
            &[][..],
            false,
        )]);
    }

    #[test]
    fn what_the_rack_refuses_at_another_place_is_not_missing() {
        let part = || "fender".to_owned();
        let rejected = Rejection::WrongPlace {
            part: part(),
            place: "r".into(),
        };
        let mut wrong_place = found("fender", Some(rejected));
        wrong_place.place = Some("r".into());
        let (_, missing, _) = judged(&["l=fender"], vec![wrong_place]);
        assert!(missing.is_empty(), "{missing:?}");
    }

    #[test]
    fn only_places_of_the_rack_are_expected_and_each_once() {
        let place = |name: &str| Place {
            name: name.into(),
            region: OrientedBox {
                centre_m: [0.0; 3],
                size_m: [1.0; 3],
                angles_rad: [0.0; 3],
            },
            max_turn: MaxTurn::Total(Radians(1.0)),
            parts: Vec::new(),
        };
        let rack = Rack {
            places: vec![place("left hook"), place("a=b"), place("r ")],
            ..Rack::default()
        };
        let of_scan = Expected::new(vec!["hook=fender".into()], None, |_| true);
        let of_scan = of_scan.expect("a scan has no places");
        assert_eq!(of_scan.parts(), ["fender".into()]);
        let expected = |texts: &[&str], rack: &Rack| {
            let parts = texts.iter().map(|&text| text.into()).collect();
            Expected::new(parts, Some(rack), |name| name == "fender")
                .map_err(|error| format!("{error}: {}", error.advice()))
        };
        let blank = expected(&["r=fender"], &rack).expect("a place of the rack");
        assert_eq!(blank.parts()[0].place.as_deref(), Some("r "));
        let good = expected(&["left hook = fender", "a=b=fender", "fender"], &rack);
        let good = good.expect("places of the rack");
        let json = serde_json::to_value(&good).expect("JSON");
        let both = serde_json::json!({
            "expected": ["fender", "fender", "fender"],
            "expected_places": ["left hook", "a=b", null],
        });
        assert_eq!(json, both);
        assert_eq!(
            serde_json::from_value::<Expected>(json).expect("read"),
            good
        );
        let old = serde_json::json!({ "expected": ["fender"] });
        let read: Expected = serde_json::from_value(old.clone()).expect("of an older version");
        assert_eq!(serde_json::to_value(&read).expect("JSON"), old);
        for (texts, rack, why) in [
            (
                &["hook=fender"][..],
                &rack,
                "Give a place of the rack: left hook, a=b, r",
            ),
            (&["left hook=fender"], Rack::ANYWHERE, "--rack"),
            (
                &["a=b=fender", "a=b=fender"],
                &rack,
                "two parts are expected at place \"a=b\"",
            ),
            (
                &["left hook=door"],
                &rack,
                "door is expected, but not enrolled",
            ),
            (&["fender"; MAX_PARTS + 1], &rack, "9 parts are expected"),
        ] {
            let error = expected(texts, rack).expect_err(why);
            assert!(error.contains(why), "{error}");
        }
    }
}
