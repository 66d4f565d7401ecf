//! The way to the robot: where the camera sits in its cell, and what a found pose means there.

pub mod calibration;
pub mod hand_eye;
