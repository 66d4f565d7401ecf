//! Cameras without a camera: their libraries with played or recorded devices, and stub libraries.

#![allow(clippy::disallowed_methods, reason = "tests change files")]
#![cfg(target_os = "linux")]

mod errors;
mod genicam;
mod kinect;
mod openni;
mod own_process;
mod realsense;
