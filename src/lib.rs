//! Partsight recognises a car body part in a depth frame and estimates its pose.
//!
//! - A file ([`read_image`]) or a camera ([`open_source`]) gives an [`Image`], and [`scene_from_image`] makes it a
//!   [`SceneCloud`]. A [`Library`] holds the enrolled parts.
//! - [`run`] takes scene and library through the stages (segment, project, contour, signature, rank, confirm) and returns
//!   an [`Inspection`]: the verdict, the pose and every intermediate result.
//! - Lengths are in metres, angles in radians. In camera space x points right, y down and z forward. A transform
//!   `b_from_a` takes points of `a` to `b`: the pose is `camera_from_part`.
//! - The same scene, library and [`Recipe`] give the same result, to the bit, on any number of threads.
//!
//! ```
//! use partsight::{
//!     CellSetup, Image, LibraryFolder, PartKind, Recipe, Side, Unwatched, run, scene_from_image, simulated_frame,
//! };
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let setup = CellSetup::with_part(PartKind::Fender, Side::Left, 0, 1);
//! let scene = scene_from_image(Image::Depth(simulated_frame(&setup).frame));
//! let library = LibraryFolder::open("reference_parts".as_ref())?.load(&Default::default())?.library;
//! let inspection = run(&scene, &library, &Recipe::default(), &Unwatched)?;
//! let pose = inspection.pose.ok_or("nothing to recognise")??;
//! println!("{:?}: {}", inspection.verdict, pose.camera_from_part());
//! # assert!(inspection.verdict.is_accepted());
//! # Ok(())
//! # }
//! ```
//!
//! The items on this page are the library. The modules behind it are public for the program, the Python package and the
//! tests only, and change without notice.
//!
//! Features, both on by default: `cli`, the command line, pictures and reports; `window`, the window. Without them only
//! the algorithms build. Off by default: `plant`, HTTP and MQTT beside the protocols of the server, the history in PostgreSQL,
//! and one library for many cells.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests change files"))]

#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;

#[cfg(feature = "window")]
#[doc(hidden)]
pub use app;
#[doc(hidden)]
pub use capture;
#[doc(hidden)]
pub use files;
#[doc(hidden)]
pub use geometry::{self, clock, error, units};
#[doc(hidden)]
pub use inspection::{library, pipeline, rack};
#[cfg(feature = "plant")]
#[doc(hidden)]
pub use plant;
#[doc(hidden)]
pub use records::{cases, history, orders, report};
#[doc(hidden)]
pub use robot::{self, paint};
#[cfg(feature = "cli")]
#[doc(hidden)]
pub use serve;
#[doc(hidden)]
pub use simulate;
#[doc(hidden)]
pub use stages::{self, scan};
#[cfg(feature = "cli")]
#[doc(hidden)]
pub use station;

pub use self::{
    capture::{
        CaptureError, Captured, DepthSource, Image, NextCapture, SourceSpec, open as open_source,
        read_image,
    },
    error::Advice,
    files::{FileContent, FileError, open as open_file},
    geometry::{
        cloud::{Grid, PointCloud},
        depth_frame::{DepthFrame, Intrinsics},
        distortion::Distortion,
        mesh::TriangleMesh,
        rigid::RigidTransform,
    },
    library::{
        EnrolError, EnrolParams, Enrolled, Library, LibraryError, LibraryFolder, LibraryLoad, Part,
        PartDescription, PartName, enrol_captured, enrol_mesh,
    },
    pipeline::{
        AcceptParams, Cancelled, Inspection, PoseChoice, ProgressObserver, Recipe, RecipeError,
        RecipeFile, Rejection, Stage, Timings, Unwatched, Verdict, run,
    },
    simulate::{CellSetup, PartKind, PartModel, Side, SimulatedFrame, frame as simulated_frame},
    stages::{
        confirm::{ConfirmParams, ConfirmedMatch, ConfirmedRanking, Evidence},
        contour::{Contour, ContourParams},
        paper::{IcpGaParams, IcpParams},
        pose::{PoseError, PoseEstimate, PoseMethod, PoseWarning, align},
        project::{PlaneImage, ProjectParams},
        rank::RankParams,
        reference::{Reference, ReferenceParams},
        scene::{SceneCloud, scene_from_image},
        segment::{NoPart, PointLabel, SegmentParams, Segmentation, SegmentedPart},
        signature::{FanSignature, SignatureParams},
    },
    units::{Metres, Radians},
};
