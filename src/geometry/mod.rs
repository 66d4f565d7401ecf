//! Points, transforms and the searches over them, free of any file, camera or stage.

pub mod cloud;
pub mod mesh;
pub mod nearest;
pub mod nearest_field;
pub mod normals;
pub mod parallel;
pub mod plane;
pub mod polygon;
pub mod principal;
pub mod raster;
pub mod rigid;
pub mod sixteen_numbers;
pub mod voxel;
pub mod written_pose;
