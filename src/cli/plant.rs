//! The interfaces of a plant: options, subcommands and what runs beside an inspection. Only this module asks for the
//! feature `plant`; without it, the same items take no options and do nothing.

#[cfg(feature = "plant")]
mod with;
#[cfg(feature = "plant")]
pub(super) use self::with::*;

#[cfg(not(feature = "plant"))]
mod without;
#[cfg(not(feature = "plant"))]
pub(super) use self::without::*;
