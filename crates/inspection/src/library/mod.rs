//! The library of enrolled parts.
//!
//! A library is a folder that can be copied to a stick and read by people, with one folder per part:
//!
//! ```text
//! reference_parts/
//!   front_door/
//!     part.toml       schema version, name, notes, checksum of the cloud, how it was enrolled
//!     cloud.ply       the reference cloud with normals: binary, metres, part space
//!     signature.json  outline and fan signature of the standard view
//!     thumbnail.png   for people
//!     spray-CRC.csv   the stored spray path, if any: part space; part.toml has its checksum
//!   numbers.toml      the numbers by which robots know the parts
//!   .trash/           removed and replaced parts; restored, or moved back by hand, they are enrolled again
//! ```
//!
//! An inspection needs only the cloud and `part.toml`; signature and thumbnail can be made again from them.

mod enrol;
mod entry;
mod error;
mod identity;
mod install;
mod load;
mod name;
mod numbers;
mod part;
mod place;
mod problem;
mod references;
mod replace_all;
mod shared_title;
mod shipped;
mod side;
mod similarity;
mod simulated;
mod spray_path;
mod spray_store;
mod store;
mod stored_part;
mod surface_zones;
mod thumbnail;
mod trash;
mod truth;

use std::collections::BTreeMap;

use nalgebra::Point3;

use stages::reference::Reference;

pub use self::{
    enrol::{
        EnrolError, EnrolFinding, EnrolParams, EnrolWarning, Enrolled, PartDescription,
        enrol_captured, enrol_mesh, enrol_scan, enrol_selected, enrol_surface, enrol_whole,
        surfaces_to_enrol,
    },
    entry::is_part_file,
    error::LibraryError,
    load::{LibraryListing, LibraryLoad},
    name::{BadName, PartName},
    numbers::{GivenNumbers, PartNumbers},
    part::{
        EnrolMethod, Enrolment, FileCheck, MAX_TITLE, Part, PartMeta, PartNaming, SCHEMA_VERSION,
        StoredLiteral, StoredSignature,
    },
    place::{LibraryPlace, TakenVersion, open_library},
    problem::{EntryError, EntryIssue, EntryProblem, EntryWarning},
    shared_title::SharedTitle,
    shipped::{EnrolledAt, shipped_enrolled_at, shipped_files},
    side::{Side, outer_side},
    similarity::{Similarity, likenesses, most_similar},
    simulated::{enrol_part, enrol_standard_parts, enrolled_name, enrolment_pose},
    spray_path::{
        MAX_PATH_POINTS, MAX_SPEED_M_S, PathLineProblem, PathPoint, SprayPath, SprayPathError,
    },
    store::{LibraryFolder, Renamed, Restored, Saved},
    stored_part::StoredPart,
    surface_zones::{SurfaceZone, SurfaceZones},
    trash::TrashEntry,
    truth::Truth,
};

/// The enrolled parts, prepared for ranking and pose.
#[derive(Clone, Debug, Default)]
pub struct Library {
    /// The references, sorted by name.
    pub references: Vec<Reference>,
    /// The zones of the references that have some, by the name under which they are enrolled.
    pub surface_zones: BTreeMap<String, SurfaceZones>,
}

impl Library {
    /// True if a part of this name is enrolled.
    pub fn has_part(&self, name: &str) -> bool {
        self.references.iter().any(|part| part.name == name)
    }

    /// True if a part or a reference of this name is enrolled.
    pub fn has_reference(&self, name: &str) -> bool {
        self.has_part(name) || self.references.iter().any(|one| one.enrolled_as == name)
    }

    /// The middle of the extent of the reference that is enrolled under this name, part space, metres.
    pub fn middle_of(&self, name: &str) -> Option<Point3<f64>> {
        let mut references = self.references.iter();
        references.find(|one| one.enrolled_as == name)?.middle()
    }
}
