//! The history: a database of past inspections, and their kept frames.
//!
//! ```text
//! history.sqlite        every inspection: verdict, pose, times, recipe, library, a small picture, remark, true label;
//!                       every run of servoing: target, end, curve
//! history-frames/       frames that the retention rule keeps: depth PNGs as in recordings, other clouds as PCD
//! history.lock          held by every program that has the history open
//! ```
//!
//! ```text
//! NewEntry ─► Writer ─► HistoryBuffer ─► History ─► history.sqlite
//!             a thread  keeps in memory what cannot be written
//! ```
//!
//! Killing the program loses at most the inspection that was being written. A file that cannot be opened is never
//! deleted: a damaged one and one of a development build are renamed and set aside, one of a newer version is refused and
//! left as it is.

mod buffer;
mod differences;
mod drift;
mod entry;
mod error;
mod event;
mod filter;
mod frames;
mod hung;
mod hung_spots;
mod open;
mod outcomes;
mod retention;
mod rows;
mod scene_title;
mod schema;
mod sending;
mod servo_run;
mod shots;
mod store;
mod table;
#[cfg(test)]
mod tests;
mod traceability;
mod trend;
mod waiting;
mod writer;

pub(crate) use self::differences::index_of_part;
pub use self::{
    buffer::HistoryBuffer,
    differences::{Differences, InspectionSummary, ParameterChange},
    drift::{
        DriftQuantity, DriftWarning, LEAST_FOR_SPREAD, MAX_POSES, PartDrift, PoseRecord,
        QuantityDrift,
    },
    entry::{
        InspectionContext, InspectionDetail, NewEntry, Record, RobotMarks, StoredVerdict, Summary,
    },
    error::HistoryError,
    event::HistoryEvent,
    filter::{Filter, VerdictFilter},
    frames::{
        FrameError, FrameLoss, FrameRecord, read as read_frame, read_by as read_frame_by,
        write_as as write_frame,
    },
    hung::{HungId, HungRows},
    hung_spots::{HungSpots, SpotIds},
    open::{FILE, OnlyRead, OpenedHistory, SetAside, users_folder},
    outcomes::{PartOutcome, accepted_parts},
    retention::{ACCEPTED_KEPT, KeepFrames, PruneResult, Retention, Usage},
    scene_title::SceneTitle,
    servo_run::{ServoRecord, ServoRun, ServoSample, ServoTargetKind, write_servo_table},
    shots::{ShotRecord, read_shots},
    store::{History, Page},
    table::write_table,
    traceability::{TraceChange, Traceability},
    trend::{LEAST_FOR_TREND, Limit, Trend},
    writer::Writer,
};
pub use self::{
    sending::{
        Column, ColumnKind, DETAIL_COLUMNS, INSPECTION_COLUMNS, RECIPE_COLUMNS, RowReader,
        UnsentRows,
    },
    table::write_cells_table,
};
