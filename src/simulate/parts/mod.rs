//! The eight parts, one file each: dimensions of a small city car, left side where there are sides.
//!
//! A part is one or two pressed sheets ([`super::sheet`]) and, for the open ones, bars ([`super::beam`]). Dimensions
//! were set by eye against photographs' proportions, not taken from any maker's drawing. The sheet has no thickness.

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

/// Builds a part with the dimensions that `vary` gives out.
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
