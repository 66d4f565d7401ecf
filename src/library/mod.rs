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
//!     spray-CRC.csv   the nozzle's path over it, if one was stored: part space; part.toml names its checksum
//!   .trash/           what was removed or replaced; restored, or moved back by hand, it is enrolled again
//! ```
//!
//! Cloud and `part.toml` are all that an inspection needs; the other two can be made again from them.

mod enrol;
mod entry;
mod error;
mod identity;
mod install;
mod load;
mod name;
mod part;
mod place;
mod problem;
mod references;
mod replace_all;
mod shared_title;
mod shipped;
mod similarity;
mod spray_path;
mod spray_store;
mod store;
mod thumbnail;
mod trash;
mod truth;

use crate::stages::reference::Reference;

pub use self::{
    enrol::{
        EnrolError, EnrolParams, EnrolWarning, Enrolled, PartDescription, enrol_captured,
        enrol_mesh, enrol_scan, enrol_selected, enrol_surface, enrol_whole, surfaces_to_enrol,
    },
    entry::is_part_file,
    error::LibraryError,
    load::{LibraryLoad, StoredPart},
    name::{BadName, PartName},
    part::{
        CloudCheck, EnrolMethod, Enrolment, MAX_TITLE, Part, PartMeta, PartNaming, SCHEMA_VERSION,
        SprayCheck, StoredLiteral, StoredSignature,
    },
    place::{LibraryPlace, open_library},
    problem::{EntryError, EntryIssue, EntryProblem, EntryWarning},
    shared_title::SharedTitle,
    shipped::{EnrolledAt, shipped_enrolled_at, shipped_files},
    similarity::{Similarity, likenesses, most_similar},
    spray_path::{
        MAX_PATH_POINTS, MAX_SPEED, PathLineProblem, PathPoint, SprayPath, SprayPathError,
    },
    store::{LibraryFolder, Renamed, Restored, Saved},
    trash::TrashEntry,
    truth::Truth,
};

/// The enrolled parts, prepared for ranking and pose.
#[derive(Clone, Debug, Default)]
pub struct Library {
    /// The references in the order of their names.
    pub references: Vec<Reference>,
}
