//! What can happen in the workspace, and what a person is asked to choose.

use std::path::PathBuf;

use super::{start::Start, state::Pairing};
use crate::app::{
    language::text,
    shell::file_dialog::{FileChoice, FileRequest, all_files, points},
};

/// Something that happened in the workspace.
#[derive(Debug)]
pub enum AlignAction {
    /// Align something else.
    Choose(Pairing),
    /// Take this enrolled part.
    ChoosePart(String),
    /// Begin here.
    ChooseStart(Start),
    /// Begin at the next random start.
    DrawStart,
    /// Write a start, or stop writing.
    ToggleCustom,
    /// The custom start now reads so.
    WriteCustom(String),
    /// Begin at the custom start.
    UseCustom,
    /// Have a person choose a file.
    Ask(AlignFile),
    /// A person chose it.
    Chosen(AlignFile, PathBuf),
    /// Align.
    Run,
    /// Stop what is at work.
    Cancel,
    /// Go on with Table I.
    RunTable,
    /// Work out Table I from its first row.
    RestartTable,
    /// Take part and start of this row of Table I, and align.
    OpenRow(usize),
    /// Show this iteration.
    Scrub(f32),
    /// Go forwards by this many iterations, or backwards if negative.
    Step(f32),
    /// Play or pause.
    TogglePlay,
    /// Advance playback by this many seconds.
    Advance(f32),
    /// Put Table I on the clipboard.
    CopyTable,
}

/// What a person is asked to choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AlignFile {
    /// The file that is moved.
    Source,
    /// The file that stays.
    Target,
    /// Where Table I is written to.
    TableFile,
}

impl AlignFile {
    pub(super) fn request(self) -> FileRequest {
        match self {
            Self::Source | Self::Target => FileRequest {
                title: text!("align-open-title"),
                filters: vec![points(), all_files()],
                choice: FileChoice::File,
            },
            Self::TableFile => FileRequest {
                title: text!("align-export-title"),
                filters: vec![(text!("align-csv-files"), &["csv"])],
                choice: FileChoice::NewFile("table1.csv"),
            },
        }
    }
}
