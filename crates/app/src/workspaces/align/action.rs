//! Actions of the workspace, and the files that it asks for.

use std::path::PathBuf;

use super::{start::Start, state::Pairing};
use shell::file_dialog::{FileChoice, FileRequest, all_files, points};
use ui::language::text;

/// Something that happened in the workspace.
#[derive(Debug)]
pub enum AlignAction {
    /// Choose what is aligned to what.
    Choose(Pairing),
    /// Choose this enrolled part.
    ChoosePart(String),
    /// Choose the start.
    ChooseStart(Start),
    /// Choose the next random start.
    DrawStart,
    /// Open or close the form for a custom start.
    ToggleCustom,
    /// Replace the text of the custom start.
    WriteCustom(String),
    /// Choose the custom start.
    UseCustom,
    /// Ask for a file.
    Ask(AlignFile),
    /// A file was chosen.
    Chosen(AlignFile, PathBuf),
    /// Align.
    Run,
    /// Cancel the running job.
    Cancel,
    /// Continue Table I.
    RunTable,
    /// Compute Table I from its first row.
    RestartTable,
    /// Choose part and start of this row of Table I, and align.
    OpenRow(usize),
    /// Show this iteration.
    Scrub(f32),
    /// Move by this many iterations; negative is backwards.
    Step(f32),
    /// Play or pause.
    TogglePlay,
    /// Advance playback by this many seconds.
    Advance(f32),
    /// Copy Table I to the clipboard.
    CopyTable,
}

/// A file that a person is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AlignFile {
    /// The file that is moved onto the target.
    Source,
    /// The file that the source is moved onto.
    Target,
    /// The file that Table I is written to.
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
                filters: vec![(text!("shell-csv-files"), &["csv"])],
                choice: FileChoice::NewFile("table1.csv".into()),
            },
        }
    }
}
