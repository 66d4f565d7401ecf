//! Visual servoing: moves a robot until the part stands where it should relative to camera or nozzle.
//!
//! Position-based visual servoing: each accepted inspection gives the pose of the part; its difference from the target is an
//! error in space, which the robot is moved to reduce. F. Chaumette, S. Hutchinson, "Visual Servo Control, Part I: Basic
//! Approaches", IEEE Robotics & Automation Magazine 13(4), 2006, its section on position-based visual servo.
//!
//! ```text
//!                        camera on the flange            camera in the cell
//!
//!   robot base ──F──► flange                      robot base ──F──► flange
//!                       │ X                           │ Z             │
//!                       ▼                             ▼               ▼
//!                     camera ──C──► part            camera ──C──► part (in the gripper, or hung)
//!
//!   F robot_from_flange    X flange_from_camera    Z robot_from_camera    C camera_from_part, as inspected
//! ```
//!
//! A [`Task`] has the camera's place and a [`Target`]. A *control frame* is fixed to the flange; when the target is reached it
//! coincides with a *goal frame*. With K its pose in the base frame and G that of the goal, the error is K⁻¹·G, as a
//! [`Twist`]: the shift t and the rotation vector θu, both along the axes of the control frame.
//!
//! | camera | target | control frame K | goal frame G | K⁻¹·G depends on |
//! | --- | --- | --- | --- | --- |
//! | on the flange | part at C* | camera's axes, at the part's middle m as the target has it: F·X·(1, C*m) | F·X·C·C*⁻¹·(1, C*m) | C, C* |
//! | in the cell, the arm holds the part | part at C* | camera's axes, at the part's middle: Z·(1, Cm) | Z·C*·C⁻¹·(1, Cm) | C, C* |
//! | on the flange | nozzle at N = `part_from_nozzle` | nozzle: F·T, T = `flange_from_nozzle` | F·X·C·N | C, N, X, T |
//! | in the cell, the part hangs | nozzle at N | nozzle: F·T | Z·C·N | C, N, Z, T, F |
//!
//! Of the first two the error does not contain the calibration X or Z. A wrong one bends the way and slows it down, but the
//! end is right, as long as the error of its rotation is well below 90°. The nozzle has no such luck: the camera does not see
//! it, so it ends as far from its goal as the calibration is wrong. Such a task therefore needs the calibration's bounds, and
//! adds them to those of the pose. To place the nozzle as well as the camera can see, servo to a recorded camera pose and teach
//! the path from there.
//!
//! The control law is v = λt, ω = λθu in the control frame (the choice s = (ᶜ*t, θu) of the paper, for a control point of our
//! own): the control point moves straight towards its goal, and the rotation about it decays independently. About the camera, a
//! rotation would move the part out of the picture; so the control point is the part's middle.
//!
//! The goal is kept in the base frame, where it stands still while the part does. It is computed with the arm's pose at the
//! moment at which the frame was taken, so that a delayed frame is not an error; the arm then follows a smooth motion from
//! its last commanded pose to the goal, see [`Servo`].

mod arm_states;
mod end_look;
mod fence;
mod look;
mod mover;
mod one_pose;
mod params;
mod servo;
pub mod simulated;
mod stop;
pub mod stream;
mod task;
mod twist;

pub use self::{
    arm_states::ArmState,
    end_look::Arrival,
    fence::{Fence, Tool},
    look::{Look, SeenPart},
    one_pose::{OnePose, OnePoseAnswer},
    params::{Limits, ServoError, ServoParams},
    servo::{Servo, ServoState, Standing, Step},
    stop::StopReason,
    task::{Goal, Target, Task, TaskError},
    twist::Twist,
};
