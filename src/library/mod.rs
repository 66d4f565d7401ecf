//! The library of enrolled parts.
//!
//! A library is a folder that can be copied on a stick and read by a person, one folder per part:
//!
//! ```text
//! reference_parts/
//!   front_door/
//!     part.toml       schema version, name, notes, checksum of the cloud, how it was enrolled
//!     cloud.ply       the reference cloud with normals: binary, metres, part space
//!     signature.json  outline and fan signature of the standard view
//!     thumbnail.png   for people
//!   .trash/           what was removed or replaced; moved back by hand it is enrolled again
//! ```
//!
//! Cloud and `part.toml` are all that an inspection needs; the other two can be made again from them.

mod enrol;
mod likeness;
mod load;
mod name;
mod part;
mod place;
mod problem;
mod shipped;
mod store;
mod thumbnail;

use crate::stages::reference::Reference;

pub use self::{
    enrol::{
        About, EnrolError, EnrolParams, EnrolWarning, Enrolled, enrol_captured, enrol_mesh,
        enrol_whole,
    },
    likeness::{Likeness, most_alike},
    load::{LibraryLoad, StoredPart},
    name::{BadName, PartName},
    part::{
        CloudCheck, Enrolment, How, Part, PartMeta, SCHEMA_VERSION, StoredLiteral, StoredSignature,
    },
    place::{LibraryPlace, open_library},
    problem::{EntryError, EntryProblem, EntryWarning, Trouble},
    store::{LibraryError, LibraryFolder, Saved},
};

/// The enrolled parts, prepared for ranking and pose.
#[derive(Clone, Debug, Default)]
pub struct Library {
    /// The references in the order of their names.
    pub references: Vec<Reference>,
}
