//! Points, depth frames, transforms and spatial searches, units, and the advice that errors give; independent of files,
//! devices and stages.

// The derived code of `Advice` says `::geometry`.
extern crate self as geometry;

pub mod clock;
pub mod cloud;
pub mod depth_frame;
pub mod distortion;
pub mod error;
#[cfg(any(test, feature = "fixtures"))]
pub mod fixtures;
pub mod mesh;
pub mod nearest;
pub mod nearest_field;
pub mod normals;
pub mod oriented_box;
pub mod parallel;
pub mod pinhole_fit;
pub mod plane;
pub mod polygon;
pub mod principal;
pub mod raster;
pub mod rays;
pub mod rigid;
pub mod segment;
pub mod shown_sides;
pub mod sixteen_numbers;
pub mod statistics;
pub mod surface_grid;
pub mod units;
pub mod voxel;
pub mod written_pose;
