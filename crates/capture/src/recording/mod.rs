//! Recordings: folders of frames, written as they arrive, that replay bit by bit.
//!
//! ```text
//! recording.jsonl     a line about the recording, then a line for every frame: file, size, checksum, time, camera, truth
//! frame-000001.png    depth as a 16-bit PNG; a cloud is frame-000001.pcd
//! intrinsics.json     the camera, so that every other program can read the depth images too
//! ```
//!
//! A frame's line is appended and synced only after its file is complete and synced: whatever happens, the recording has
//! all frames up to the last complete one. Anything after that is ignored.

mod manifest;
mod recorder;
mod replay;
mod rgbd_sequence;
#[cfg(test)]
mod tests;

pub use self::recorder::Recorder;
pub use self::replay::Replay;
pub(super) use self::replay::is_sequence;
