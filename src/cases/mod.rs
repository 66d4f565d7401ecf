//! Kept cases: captured scenes with the actual part, to find out why one was taken for another.
//!
//! A folder of cases can be copied on a stick and read by a person, one folder per case:
//!
//! ```text
//! cases/
//!   simulated_frame_7/
//!     case.toml     what it truly is, what was found, where it came from (see CaseMeta)
//!     scene.png     the scene as its camera gave it, as the history keeps frames: 16-bit depth; what is none is a
//!                   scene.pcd: binary, metres, camera space, rows and columns kept
//!     intrinsics.json  the camera of a depth image, for other programs
//!     empty-cell-….pcd  only if the empty cell was known: its nearest depth around each pixel
//!   .trash/         what was removed; moved back by hand it is a case again
//! ```
//!
//! ```toml
//! schema_version = 2
//! origin = "Simulated frame 7"      # for people
//! simulated = true                  # no camera was read
//! kept_at = "2026-11-20T14:07:31Z"
//! remark = ""
//! difficulty = "placed"             # free words to be sorted by; may be absent
//!
//! [truth]
//! is = "part"                       # part, not_enrolled or nothing
//! part = "back_door"                # the enrolled name, only with is = "part"
//!
//! [found]                           # by the recipe in use when the case was kept
//! part = "front_door"               # absent if nothing could be recognised
//! score = 0.91
//! margin = 0.2
//! accepted = true
//! reason = "..."                    # only if not accepted
//!
//! [pose]                            # where the part truly is; absent if nobody knows
//! camera_from_part = [16 numbers]   # row after row, metres
//! cloud_crc32 = "4d355f87"          # the cloud of the enrolled part whose coordinates these are
//!
//! [scene]                           # a FrameRecord
//! file = "scene.png"
//! bytes = 246310                    # size and CRC-32 of the file
//! crc32 = 305419896
//! edge = "view"                     # view or points, see PictureEdge
//! metres_per_unit = 0.001           # of a depth image
//! empty_cell = "empty-cell-01234567.pcd"  # absent without one
//! empty_cell_crc32 = 19088743
//!
//! [scene.camera]                    # pixels; absent if no pinhole camera explains the scene
//! width = 640
//! height = 480
//! fx = 525.0
//! fy = 525.0
//! cx = 319.5
//! cy = 239.5
//! ```
//!
//! Cases of the first version are read as well: their scene is always `scene.pcd`, with `picture_edge` and
//! `empty-cell.pcd`.
//!
//! The scene opens again bit for bit, camera and empty cell included, so that the same recipe gives the same verdict. A case is
//! written whole or not at all: built in a hidden folder (`.new-…`), synced, renamed. A damaged case is named and set
//! aside, the others load; a newer schema is refused in words. The size is held against `case.toml` when a folder is
//! listed, the checksum when a scene is read.

mod calibration;
mod changes;
mod confusion;
mod error;
mod evaluation;
mod judge;
mod meta;
mod past;
mod record;
mod store;
mod trade_off;

pub use self::{
    calibration::{Calibration, ScoreBin},
    changes::{CaseChange, Changes},
    confusion::{Cell, Confusion, Tally},
    error::CaseError,
    evaluation::{CaseJudge, Evaluation, evaluate},
    judge::{CaseAnswer, CaseOutcome, CaseResult, FoundVerdict, Truth},
    meta::{CaseDescription, CaseMeta, SCHEMA_VERSION, TruePose},
    past::{PastCases, TruthFrom},
    record::{
        CaseRecord, EarlierRun, EvaluationRecord, PoseErrors, PoseOff, RECORD_SCHEMA, RecipeRecord,
        RecordError,
    },
    store::{CaseFolder, CaseList, KeptCase},
    trade_off::{ThresholdCounts, TradeOff},
};
