//! What of a frame is as expected, and what is not.

use std::sync::Arc;

use super::headline::Headline;
use inspection::pipeline::{Inspection, Rejection};
use shell::{inspection::inspected::Inspected, session::Session, trace::expecting};
use ui::language::text;

/// An expected part that nothing hangs in place of.
pub(super) struct MissingPart {
    /// Its title, with its place.
    pub(super) title: String,
    /// The place of the rack where it should hang.
    pub(super) place: Option<String>,
}

/// How a frame compares with what is expected.
pub(super) struct FrameExpectation {
    /// How many of the expected parts are accepted.
    pub(super) title: String,
    /// Each difference; empty if there is none that is not said of a part by itself.
    pub(super) complaint: String,
    /// The parts that nothing hangs in place of.
    pub(super) missing: Vec<MissingPart>,
    /// Number of expected parts.
    pub(super) num_expected: usize,
    /// True if all of them are accepted, and nothing else is an enrolled part.
    pub(super) is_met: bool,
}

impl FrameExpectation {
    /// `None` if nothing is expected, it is too early for a verdict on one of the parts, or the other parts of the frame are not known.
    pub(super) fn of(parts: &[Arc<Inspected>], session: &Session) -> Option<Self> {
        let first = parts.first()?;
        let expected = &first.recipe.expected;
        if expected.is_empty() || parts.iter().any(|part| part.is_open()) {
            return None;
        }
        let title_of = |name: &str| first.library.title_of(name).to_owned();
        let all: Vec<&Inspection> = parts.iter().map(|part| &part.inspection).collect();
        let num_expected = expected.parts().len();
        let is_past = session.shown.as_ref().is_some_and(|shown| shown.is_past);
        if is_past && num_expected > 1 {
            // One part of the frame is opened again, without the others.
            return None;
        }
        let missing = expected.missing(&all).into_iter();
        let missing: Vec<MissingPart> = missing
            .map(|part| MissingPart {
                title: expecting::title_of(part, title_of),
                place: part.place.clone(),
            })
            .collect();
        let differences = all.iter().filter_map(|one| match one.verdict.rejected()? {
            Rejection::WrongPart { part, expected } => Some(text!(
                "expect-wrong",
                part = title_of(part),
                expected = title_of(expected)
            )),
            Rejection::ExpectedElsewhere {
                part, expected_at, ..
            } => Some(text!(
                "expect-elsewhere",
                part = title_of(part),
                place = expected_at
            )),
            Rejection::NotExpected { part } => Some(text!("expect-surplus", part = title_of(part))),
            _ => None,
        });
        let titles: Vec<&str> = missing.iter().map(|part| &*part.title).collect();
        let absent =
            (!titles.is_empty()).then(|| text!("expect-missing", parts = titles.join(" · ")));
        let differences: Vec<String> = differences.chain(absent).collect();
        let mut complaint = differences.join("; ");
        let order = session.trace.of_part(first).order;
        if !complaint.is_empty() && !order.is_empty() && session.expecting.orders().is_some() {
            complaint = text!("expect-of-order", order = order, says = complaint);
        }
        let accepted = parts.iter().map(|part| Headline::of(part, session));
        let num_met = accepted.filter(Headline::is_accepted).count();
        Some(Self {
            title: text!("expect-num-met", num = num_met, all = num_expected),
            complaint,
            missing,
            num_expected,
            is_met: expected.is_met(&all) && num_met == num_expected,
        })
    }
}

/// The word for a part that is as expected, or is not; `None` if the verdict has another reason, or nothing is expected.
pub(super) fn word_of(inspected: &Inspected) -> Option<String> {
    if inspected.recipe.expected.is_empty() {
        return None;
    }
    match inspected.inspection.verdict.rejected() {
        Some(Rejection::WrongPart { .. }) => Some(text!("expect-wrong-part")),
        Some(Rejection::ExpectedElsewhere { .. }) => Some(text!("expect-wrong-place")),
        Some(Rejection::NotExpected { .. }) => Some(text!("expect-not-expected")),
        None if inspected.inspection.verdict.is_accepted() => Some(text!("expect-as-expected")),
        _ => None,
    }
}
