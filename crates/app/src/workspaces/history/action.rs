//! Actions of the workspace, the files that it asks for, and the jobs of the writer thread.

use std::{ops::Range, path::PathBuf};

use super::filter::ListFilter;
use inspection::library::Truth;
use records::history::{HungId, NewEntry, Retention, TraceChange};
use shell::file_dialog::{FileChoice, FileRequest};
use ui::language::text;

/// An action in the workspace.
#[derive(Debug)]
pub enum HistoryAction {
    /// Set the filter of the list.
    Filter(ListFilter),
    /// Report the rows of the list that are visible.
    Visible(Range<usize>),
    /// Select this inspection.
    Select(i64),
    /// Select the row above (newer) or below.
    Step(Direction),
    /// Show the inspection with all its stages.
    Open(i64),
    /// Show the selected inspection with all its stages.
    OpenSelected,
    /// Inspect its scene again with the recipe and library in use, and show what changed.
    InspectAgain(i64),
    /// Do the same with the selected inspection.
    AgainSelected,
    /// Set the remark on an inspection.
    Remark(i64, String),
    /// Set the true label of an inspection; `None` if unknown.
    Label(i64, Option<Truth>),
    /// Show the statistics (`true`) or the list.
    Statistics(bool),
    /// Show the runs of servoing (`true`) or the inspections.
    ServoRuns(bool),
    /// Select this run of servoing.
    SelectRun(i64),
    /// Open the window of the retention rule or change the rule in it; `None` closes it.
    Rule(Option<Retention>),
    /// Apply this retention rule.
    Keep(Retention),
    /// Ask where to write the listed inspections.
    Ask(HistoryFile),
    /// Write the listed inspections to this path.
    Export(HistoryFile, PathBuf),
}

/// A destination that a person is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HistoryFile {
    /// A table of the listed inspections.
    Csv,
    /// A folder of cases, made of the listed inspections with a kept frame and a true label.
    Cases,
}

impl HistoryFile {
    pub(super) fn request(self) -> FileRequest {
        match self {
            Self::Csv => FileRequest {
                title: text!("history-export-csv-title"),
                filters: vec![(text!("shell-csv-files"), &["csv"])],
                choice: FileChoice::NewFile("inspections.csv".into()),
            },
            Self::Cases => FileRequest {
                title: text!("history-export-cases-title"),
                filters: Vec::new(),
                choice: FileChoice::FolderToWrite,
            },
        }
    }
}

impl HistoryAction {
    /// True if frames may be lost: those that a new rule does not keep are deleted.
    pub(super) fn needs_engineer(&self) -> bool {
        matches!(self, Self::Rule(Some(_)) | Self::Keep(_))
    }
}

/// Direction of a step in the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// To a newer inspection.
    Up,
    /// To an older inspection.
    Down,
}

/// A job for the writer thread.
#[derive(Clone, Debug)]
pub enum HistoryJob {
    /// Write an inspection; the ticket is returned with its number.
    Add(u64, Box<NewEntry>),
    /// Change the traceability in the rows of a part.
    Trace(HungId, TraceChange),
    /// Write a remark.
    Remark(i64, String),
    /// Write a true label.
    Label(i64, Option<Truth>),
    /// Write the true label of a part.
    LabelPart(HungId, Option<Truth>),
    /// Apply a retention rule.
    Keep(Retention),
}
