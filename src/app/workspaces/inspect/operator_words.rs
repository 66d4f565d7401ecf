//! A verdict in the operator's words: why a part is not accepted, and what an operator can do about it.

use crate::{
    app::language::{results::rejection_advice, text},
    pipeline::{Rejection, Unrecognisable},
    stages::segment::NoPart,
};

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

/// States what an operator can do about it, if only to call the engineer.
pub(super) fn next_step(why: &Rejection, nearest: &str) -> String {
    match why {
        Rejection::LowScore { .. } => text!("operator-uncover-next"),
        Rejection::HardlySeen { .. } => text!("operator-all-in-picture-next"),
        Rejection::AnotherModel { .. } | Rejection::AnotherMake { .. } => {
            text!("operator-enrol-if-painted-next")
        }
        Rejection::AmbiguousPose { .. }
        | Rejection::Unconstrained { .. }
        | Rejection::Uncertain { .. }
        | Rejection::NoPose(_) => text!("operator-turn-next"),
        Rejection::Unknown { .. } => text!("operator-turn-or-enrol-next"),
        Rejection::Mirrored { .. } => text!("operator-mirrored-next", nearest = nearest),
        Rejection::MirroredImage { .. } => text!("operator-mirrored-image-next"),
        Rejection::SmallMargin { .. } => text!("operator-small-margin-next"),
        Rejection::Unconfirmed { .. } => text!("operator-unconfirmed-next"),
        Rejection::OutOfRange { .. }
        | Rejection::BehindCamera { .. }
        | Rejection::SurplusBytes { .. } => text!("operator-check-camera-next"),
        Rejection::Piece { .. }
        | Rejection::NotSteady { .. }
        | Rejection::FewFrames { .. }
        | Rejection::Undecided { .. }
        | Rejection::PosesApart { .. } => rejection_advice(why),
    }
}

/// States what an operator can do where there is no part.
pub(super) fn next_without_part(why: &Unrecognisable) -> String {
    match why {
        Unrecognisable::NoPart(NoPart::OnlyBackground { knows_cell, .. }) => {
            if *knows_cell {
                text!("operator-hang-or-empty-cell-next")
            } else {
                text!("operator-hang-next")
            }
        }
        Unrecognisable::NoPart(NoPart::TooFewPoints { .. }) => {
            text!("operator-uncover-camera-next")
        }
        Unrecognisable::Project(_) | Unrecognisable::Contour(_) | Unrecognisable::Signature(_) => {
            text!("operator-turn-part-next")
        }
        Unrecognisable::NoPart(NoPart::TooWide { .. })
        | Unrecognisable::EmptyLibrary
        | Unrecognisable::Fault(_) => text!("operator-ask"),
    }
}
