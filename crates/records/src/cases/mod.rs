//! Cases: captured scenes with their true label, used to measure recipes and libraries.
//!
//! The history holds scene, verdict and label of every inspection; a case is a copy of these that another computer can
//! read. The history's export and Compare describe it by [`CaseDescription::of`] and write it by [`CaseFolder::keep`].
//! Compare also labels the part in the history, if it has a row there. Each case is a folder:
//!
//! ```text
//! cases/
//!   simulated_frame_7/
//!     case.toml     what it is, what was found, where it came from (see CaseMeta)
//!     scene.png     16-bit depth, written as the history writes frames; a scene without a depth image is
//!                   scene.pcd: binary, metres, camera space, with rows and columns
//!     intrinsics.json  the camera of a depth image, for other programs
//!     empty-cell-….pcd  only if the empty cell was known: its nearest depth around each pixel
//!   .trash/         removed cases; move a folder back to restore it
//! ```
//!
//! ```toml
//! schema_version = 2
//! origin = "Simulated frame 7"      # name of the scene
//! simulated = true                  # not from a camera
//! kept_at = "2026-11-20T14:07:31Z"
//! remark = ""
//! difficulty = "placed"             # free text to group cases by; may be absent
//!
//! [truth]
//! is = "part"                       # part, not_enrolled or nothing
//! part = "back_door"                # the enrolled name, only with is = "part"
//!
//! [found]                           # by the recipe that the scene was inspected with
//! part = "front_door"               # absent if nothing could be recognised
//! score = 0.91
//! margin = 0.2
//! accepted = true
//! reason = "..."                    # only if not accepted
//!
//! [pose]                            # true pose of the part; absent if unknown
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
//! Cases of schema 1 are also read: their scene is always `scene.pcd`, with `picture_edge` and `empty-cell.pcd`.
//!
//! The scene is restored bit for bit, with camera and empty cell, so the same recipe gives the same verdict. A case is written
//! whole or not at all: built in a hidden folder (`.new-…`), synced, renamed. A damaged case is reported while the others
//! load; a newer schema is refused. Listing a folder checks the size of each scene, reading a scene checks its checksum.

mod calibration;
mod changes;
mod confusion;
mod error;
mod evaluation;
mod judge;
mod meta;
mod past;
mod record;
mod stage_times;
mod store;
mod trade_off;

pub use self::{
    calibration::{Calibration, ScoreBin},
    changes::{CaseChange, Changes},
    confusion::{Cell, Confusion, Tally},
    error::CaseError,
    evaluation::{CaseJudge, Evaluation, evaluate},
    judge::{CaseAnswer, CaseOutcome, CaseResult, FoundVerdict, Truth},
    meta::{CaseDescription, CaseMeta, OneOfSeveral, SCHEMA_VERSION, TruePose, inspect_case},
    past::{PastCases, TruthFrom},
    record::{
        CaseRecord, EarlierRun, EvaluationRecord, PoseErrors, PoseOff, RECORD_SCHEMA, RecipeRecord,
        RecordError,
    },
    stage_times::{StageTimes, stage_times},
    store::{CaseFolder, CaseList, KeptCase, PackedCase},
    trade_off::{ThresholdCounts, TradeOff},
};
