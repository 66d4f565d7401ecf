//! A verdict in the operator's words: why a part is not accepted, and what an operator can do about it.

use crate::{
    error::Advice as _,
    pipeline::{Rejection, Unrecognisable},
    stages::segment::NoPart,
};

/// Why a part is not accepted, without the figures that belong to the engineer.
pub(super) fn in_short(why: &Rejection, nearest: &str) -> String {
    match why {
        Rejection::LowScore { .. } => format!("It does not match {nearest} well enough"),
        Rejection::Piece { .. } => format!("Only a piece of {nearest} is in sight"),
        Rejection::HardlySeen { .. } => "Too little of it is in sight".into(),
        Rejection::AnotherModel { .. } => format!("It resembles {nearest}, but its shape differs"),
        Rejection::AnotherMake { .. } => {
            format!("It resembles {nearest}, but its dimensions differ")
        }
        Rejection::AmbiguousPose { .. }
        | Rejection::Unconstrained { .. }
        | Rejection::Uncertain { .. } => format!("It may be {nearest}, but its pose is uncertain"),
        Rejection::Unknown { .. } => "No enrolled part resembles it".into(),
        Rejection::Mirrored { .. } => {
            format!("It looks like {nearest} from the other side of the car")
        }
        Rejection::MirroredImage { .. } => "The camera's picture is mirrored".into(),
        Rejection::SmallMargin { .. } => "Two enrolled parts match almost equally well".into(),
        Rejection::Unconfirmed { .. } => "Only its outline was compared".into(),
        Rejection::OutOfRange { .. } => "It is too near to the camera or too far away".into(),
        Rejection::BehindCamera { .. } | Rejection::SurplusBytes { .. } => {
            "The captured file is damaged".into()
        }
        Rejection::NoPose(_) => format!("It may be {nearest}, but no pose was found"),
        Rejection::NotSteady { .. } => "It does not hang still yet".into(),
        Rejection::FewFrames { .. } => "Too few frames were inspected so far".into(),
        Rejection::Undecided { .. } | Rejection::PosesApart { .. } => {
            "The frames do not agree".into()
        }
    }
}

/// What an operator can do about it. What only the engineer can do is asked of the engineer.
pub(super) fn next_step(why: &Rejection, nearest: &str) -> String {
    let turn = "Turn its face to the camera and press Capture";
    match why {
        Rejection::LowScore { .. } => {
            "Take away what covers the part and press Capture; if it stays so, ask the engineer"
                .into()
        }
        Rejection::HardlySeen { .. } => {
            "Turn its face to the camera, all of it inside the picture, and press Capture".into()
        }
        Rejection::AnotherModel { .. } | Rejection::AnotherMake { .. } => {
            "If it is to be painted, ask the engineer to enrol it".into()
        }
        Rejection::AmbiguousPose { .. }
        | Rejection::Unconstrained { .. }
        | Rejection::Uncertain { .. }
        | Rejection::NoPose(_) => format!("{turn}; if it stays so, ask the engineer"),
        Rejection::Unknown { .. } => {
            format!("{turn}; if it is to be painted, ask the engineer to enrol it")
        }
        Rejection::Mirrored { .. } => {
            format!("Do not paint it as {nearest}: ask the engineer to enrol the part of this side")
        }
        Rejection::MirroredImage { .. } => {
            "Do not start the robot: ask the engineer to set the camera right".into()
        }
        Rejection::SmallMargin { .. } => {
            format!(
                "{turn}; if it stays so, ask the engineer to remove one of the two from the library"
            )
        }
        Rejection::Unconfirmed { .. } => "Ask the engineer to have the pose estimated too".into(),
        Rejection::OutOfRange { .. }
        | Rejection::BehindCamera { .. }
        | Rejection::SurplusBytes { .. } => {
            "Ask the engineer to check the camera and its files".into()
        }
        Rejection::Piece { .. }
        | Rejection::NotSteady { .. }
        | Rejection::FewFrames { .. }
        | Rejection::Undecided { .. }
        | Rejection::PosesApart { .. } => why.advice(),
    }
}

/// The same where there is no part.
pub(super) fn next_without_part(why: &Unrecognisable) -> String {
    match why {
        Unrecognisable::NoPart(NoPart::OnlyBackground { knows_cell, .. }) => {
            let hang = "Hang the part in front of the camera, at least 10 cm away from the wall, and press Capture";
            if *knows_cell {
                format!(
                    "{hang}; if it hangs there, ask the engineer to capture the empty cell anew"
                )
            } else {
                hang.into()
            }
        }
        Unrecognisable::NoPart(NoPart::TooFewPoints { .. }) => {
            "Take away what covers the camera and press Capture; if it stays so, ask the engineer"
                .into()
        }
        Unrecognisable::Project(_) | Unrecognisable::Contour(_) | Unrecognisable::Signature(_) => {
            "Turn the part's face to the camera and press Capture; if it stays so, ask the engineer"
                .into()
        }
        Unrecognisable::NoPart(NoPart::TooWide { .. })
        | Unrecognisable::EmptyLibrary
        | Unrecognisable::Fault(_) => "Ask the engineer".into(),
    }
}
