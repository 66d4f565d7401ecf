//! Partsight recognises a car body part in a depth frame and estimates its pose.
//!
//! - A file ([`files`]) or a camera ([`capture`]) gives a [`SceneCloud`](stages::scene::SceneCloud); a
//!   [`Library`](library::Library) holds the enrolled parts.
//! - [`pipeline::run`] takes both through the stages (segment, project, contour, signature, rank, confirm) and returns an
//!   [`Inspection`](pipeline::Inspection): the verdict, the pose and every intermediate result.
//! - Lengths are in metres, angles in radians. In camera space x points right, y down and z forward. A transform
//!   `b_from_a` takes points of `a` to `b`: the pose is `camera_from_part`.
//! - The same scene, library and [`Recipe`](pipeline::Recipe) give the same result, to the bit, on any number of threads.
//!
//! ```
//! use partsight::{library::LibraryFolder, pipeline::{self, Recipe, Unwatched}, simulate, stages::scene::scene_from_frame};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let setup = simulate::CellSetup::with_part(simulate::PartKind::Fender, simulate::Side::Left, 0, 1);
//! let scene = scene_from_frame(&simulate::frame(&setup).frame);
//! let library = LibraryFolder::open("reference_parts".as_ref())?.load(&Default::default())?.library;
//! let inspection = pipeline::run(&scene, &library, &Recipe::default(), &Unwatched)?;
//! let pose = inspection.pose.ok_or("nothing to recognise")??;
//! println!("{:?}: {}", inspection.verdict, pose.camera_from_part());
//! # assert!(inspection.verdict.is_accepted());
//! # Ok(())
//! # }
//! ```
//!
//! Features, both on by default: `cli`, the command line and the reports; `window`, the window. Without them only the
//! algorithms build.

#[cfg(feature = "window")]
pub mod app;
pub mod bench;
pub mod capture;
pub mod cases;
#[cfg(feature = "cli")]
pub mod cli;
pub mod error;
pub mod files;
pub mod geometry;
pub mod history;
pub mod library;
pub mod pipeline;
#[cfg(feature = "cli")]
pub mod report;
pub mod robot;
pub mod scan;
pub mod simulate;
pub mod stages;
pub mod units;
