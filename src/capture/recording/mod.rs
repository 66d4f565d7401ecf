//! Recordings: a folder of frames, written while they come and replayed to the bit.
//!
//! ```text
//! recording.jsonl     a line about the recording, then a line for every frame: file, size, checksum, time, camera, truth
//! frame-000001.png    depth as a 16-bit PNG; a cloud is frame-000001.pcd
//! intrinsics.json     the camera, so that every other program can read the depth images too
//! ```
//!
//! A frame's line is appended after its file is complete and synced, and synced itself: whatever happens, the recording
//! holds all frames up to the last whole one. What follows that is read over.

mod frame_folder;
mod manifest;
mod recorder;
mod replay;
mod rgbd_sequence;
#[cfg(test)]
mod tests;

pub use self::recorder::Recorder;
pub use self::replay::Replay;
pub(super) use self::replay::is_sequence;
