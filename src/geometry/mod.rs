//! Points, transforms and the searches over them, free of any file, camera or stage.

pub mod cloud;
pub mod mesh;
pub mod rigid;
