//! A verdict in the operator's words: why a part is not accepted, and what an operator can do about it.

use inspection::pipeline::{Rejection, Unrecognisable};
use shell::{language::results::rejection_advice, session::Session};
use stages::segment::NoPart;
use ui::language::text;

/// States why a part is not accepted, without figures, which are for the engineer.
pub(super) fn in_short(why: &Rejection, nearest: &str) -> String {
    match why {
        Rejection::LowScore { .. } => text!("operator-low-score", nearest = nearest),
        Rejection::Piece { .. } => text!("operator-piece", nearest = nearest),
        Rejection::HardlySeen { .. } => text!("operator-hardly-seen"),
        Rejection::AnotherModel { .. } => text!("operator-another-model", nearest = nearest),
        Rejection::AnotherMake { .. } => text!("operator-another-make", nearest = nearest),
        Rejection::AmbiguousPose { .. }
        | Rejection::Unconstrained { .. }
        | Rejection::Uncertain { .. } => text!("operator-uncertain-pose"),
        Rejection::Unknown { .. } => text!("operator-unknown"),
        Rejection::Mirrored { .. } => text!("operator-mirrored", nearest = nearest),
        Rejection::MirroredImage { .. } => text!("operator-mirrored-image"),
        Rejection::SmallMargin { .. } => text!("operator-small-margin"),
        Rejection::Unconfirmed { .. } => text!("operator-unconfirmed"),
        Rejection::OutOfRange { .. } => text!("operator-out-of-range"),
        Rejection::BehindCamera { .. } | Rejection::SurplusBytes { .. } => {
            text!("operator-damaged-file")
        }
        Rejection::NoPose(_) => text!("operator-no-pose", nearest = nearest),
        Rejection::NotSteady { .. } => text!("operator-not-steady"),
        Rejection::FewFrames { .. } => text!("operator-few-frames"),
        Rejection::Undecided { .. } | Rejection::PosesApart { .. } => text!("operator-undecided"),
    }
}

/// States why there is no part, without figures, which are for the engineer.
pub(super) fn no_part_in_short(why: &Unrecognisable) -> String {
    match why {
        Unrecognisable::NoPart(NoPart::OnlyBackground { .. }) => text!("operator-nothing-hangs"),
        Unrecognisable::NoPart(NoPart::TooFewPoints { .. }) => text!("operator-hardly-a-reading"),
        Unrecognisable::NoPart(NoPart::TooWide { .. }) => text!("operator-too-wide"),
        Unrecognisable::Project(_) | Unrecognisable::Contour(_) | Unrecognisable::Signature(_) => {
            text!("operator-hardly-seen")
        }
        Unrecognisable::EmptyLibrary => text!("operator-no-parts-why"),
        Unrecognisable::Fault(_) => text!("operator-fault"),
    }
}

/// States what an operator can do about it, if only to call the engineer.
pub(super) fn next_step(why: &Rejection, nearest: &str, session: &Session) -> String {
    let (step, otherwise) = match why {
        Rejection::LowScore { .. } => (text!("operator-uncover"), text!("operator-if-it-persists")),
        Rejection::HardlySeen { .. } => (text!("operator-all-in-picture"), String::new()),
        Rejection::AmbiguousPose { .. }
        | Rejection::Unconstrained { .. }
        | Rejection::Uncertain { .. }
        | Rejection::NoPose(_) => (text!("operator-turn"), text!("operator-if-it-persists")),
        Rejection::Unknown { .. } => (
            text!("operator-turn"),
            text!("operator-enrol-if-painted-next"),
        ),
        Rejection::SmallMargin { .. } => (text!("operator-turn"), text!("operator-if-two-alike")),
        Rejection::AnotherModel { .. } | Rejection::AnotherMake { .. } => {
            return text!("operator-enrol-if-painted-next");
        }
        Rejection::Mirrored { .. } => return text!("operator-mirrored-next", nearest = nearest),
        Rejection::MirroredImage { .. } => return text!("operator-mirrored-image-next"),
        Rejection::Unconfirmed { .. } => return text!("operator-unconfirmed-next"),
        Rejection::OutOfRange { .. }
        | Rejection::BehindCamera { .. }
        | Rejection::SurplusBytes { .. } => return text!("operator-check-camera-next"),
        Rejection::Piece { .. }
        | Rejection::NotSteady { .. }
        | Rejection::FewFrames { .. }
        | Rejection::Undecided { .. }
        | Rejection::PosesApart { .. } => return rejection_advice(why),
    };
    in_lines(step, session, otherwise)
}

/// States what an operator can do where there is no part.
pub(super) fn next_without_part(why: &Unrecognisable, session: &Session) -> String {
    let (step, otherwise) = match why {
        Unrecognisable::NoPart(NoPart::OnlyBackground { knows_cell, .. }) => {
            let otherwise = if *knows_cell {
                text!("operator-if-it-hangs-there")
            } else {
                String::new()
            };
            (text!("operator-hang"), otherwise)
        }
        Unrecognisable::NoPart(NoPart::TooFewPoints { .. }) => (
            text!("operator-uncover-camera"),
            text!("operator-if-it-persists"),
        ),
        Unrecognisable::Project(_) | Unrecognisable::Contour(_) | Unrecognisable::Signature(_) => {
            (text!("operator-turn"), text!("operator-if-it-persists"))
        }
        Unrecognisable::NoPart(NoPart::TooWide { .. })
        | Unrecognisable::EmptyLibrary
        | Unrecognisable::Fault(_) => return text!("operator-ask"),
    };
    in_lines(step, session, otherwise)
}

/// Puts sentences into lines: a step, how this source is inspected again, and what to do if that does not help.
fn in_lines(step: String, session: &Session, otherwise: String) -> String {
    let again = if session.is_watching() {
        text!("operator-next-file")
    } else if session.is_live() {
        // Live inspects again by itself.
        String::new()
    } else {
        text!("operator-then-capture")
    };
    let mut lines = vec![step, again, otherwise];
    lines.retain(|line| !line.is_empty());
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use shell::session::Source;

    #[test]
    fn the_advice_fits_the_source() {
        let why = Unrecognisable::NoPart(NoPart::TooFewPoints {
            found: 0,
            needed: 100,
        });
        let mut session = Session::default();
        let advice = next_without_part(&why, &session);
        assert!(
            advice.contains("\nThen press Capture\nIf it persists"),
            "{advice}"
        );
        // Capture would end Live, which inspects again by itself.
        session.live.is_on = true;
        let advice = next_without_part(&why, &session);
        assert_eq!(advice.lines().count(), 2, "{advice}");
        session.source = Source::Camera(Box::new("watch:captures".parse().expect("a source")));
        let advice = next_without_part(&why, &session);
        assert!(
            advice.contains("The next file") && !advice.contains("Capture"),
            "{advice}"
        );
    }
}
