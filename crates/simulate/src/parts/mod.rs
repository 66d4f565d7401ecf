//! The eight parts, one file each, with the dimensions of a small city car; parts with sides are modelled for the left.
//!
//! A part is one or two pressed sheets ([`super::sheet`]) and, for the grille, bars ([`super::beam`]). Dimensions were set
//! by eye from the proportions in photographs, not from any maker's drawing. The sheet has no thickness.

mod back_bumper;
mod back_door;
mod fender;
mod front_bumper;
mod front_door;
mod grille;
mod radiator_support;
mod side_panel;
mod trunk_lid;

use super::assembly::Assembly;
use super::part::PartKind;
use super::variation::Variation;

/// Builds a part with the dimensions that `vary` supplies.
pub(super) fn build(kind: PartKind, vary: &mut Variation) -> Assembly {
    match kind {
        PartKind::FrontBumper => front_bumper::build(vary),
        PartKind::TrunkLid => trunk_lid::build(vary),
        PartKind::BackBumper => back_bumper::build(vary),
        PartKind::BackDoor => back_door::build(vary),
        PartKind::FrontDoor => front_door::build(vary),
        PartKind::RadiatorSupport => radiator_support::build(vary),
        PartKind::Grille => grille::build(vary),
        PartKind::Fender => fender::build(vary),
    }
}
