//! State of the workspace, the actions that change it, and the files that it asks for.

use std::{path::PathBuf, sync::Arc, time::Duration};

use crate::workspaces::align::{
    pair::{Pair, PairSource},
    playback::MethodComparison,
    start::{CustomStart, Start},
    table::{self, TableRow, TableShown},
    track::MethodRun,
    work,
};
use inspection::pipeline::Verdict;
use shell::{
    action::Action,
    file_dialog::{FileChoice, FileDialog, FileRequest, all_files, points},
    inspection::source::file_name,
    notice::Notice,
    session::Session,
    workspace::ShellContext,
};
use ui::{
    language::text,
    scrubber::Playback,
    task::{Running, Task, TaskRunner},
    widgets::sentence,
};

/// State of the workspace.
#[derive(Debug)]
pub struct AlignState {
    /// What is aligned to what.
    pub pairing: Pairing,
    /// Name of the chosen enrolled part or reference; `None` means the library's first.
    pub part: Option<String>,
    /// The start of a moved copy.
    pub start: Start,
    /// The form of a custom start.
    pub custom: CustomStart,
    /// The file that is moved onto the target.
    pub source: Option<PathBuf>,
    /// The file that the source is moved onto.
    pub target: Option<PathBuf>,
    /// The last result; methods are added as they finish.
    pub shown: Option<MethodComparison>,
    /// The pair being aligned, until its first method has run and it is shown.
    pub coming: Option<Arc<Pair>>,
    /// Iteration that the scrubber is at.
    pub iteration: f32,
    /// Whether the scrubber advances by itself.
    pub playback: Playback,
    /// Table I as far as computed.
    pub table: TableShown,
    task: Task<AlignResult>,
    /// The current job of the task, or its last.
    job: AlignJob,
    /// Its result describes what was written.
    writing: Task<Notice>,
    dialog: FileDialog<AlignFile>,
}

/// A job of the task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum AlignJob {
    /// Aligns a pair.
    Pair,
    /// Adds rows to Table I.
    Table,
}

/// A result, partial or final, of the task.
#[derive(Clone, Debug)]
pub enum AlignResult {
    /// The pair is ready; the methods follow.
    Prepared(Arc<Pair>),
    /// A method has run.
    Ran(Arc<MethodRun>),
    /// A row of Table I.
    Row {
        /// The new row.
        row: Arc<TableRow>,
        /// Time since this run began its first row.
        elapsed: Duration,
    },
    /// Everything requested has been handed over.
    Finished,
}

/// What is aligned to what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pairing {
    /// A moved copy of an enrolled part to the part itself.
    #[default]
    MovedCopy,
    /// The part of the inspected scene to an enrolled part.
    Scene,
    /// One file to another.
    Files,
}

impl Pairing {
    /// Every pairing, in the order of the buttons.
    pub const ALL: [Self; 3] = [Self::MovedCopy, Self::Scene, Self::Files];

    /// Name for a person.
    pub fn title(self) -> String {
        match self {
            Self::MovedCopy => text!("align-moved-copy"),
            Self::Scene => sentence(&text!("inspect-scene")),
            Self::Files => text!("align-files"),
        }
    }
}

impl AlignState {
    /// Creates the state without a result.
    pub fn new(runner: &TaskRunner) -> Self {
        Self {
            pairing: Pairing::default(),
            part: None,
            start: Start::default(),
            custom: CustomStart::default(),
            source: None,
            target: None,
            shown: None,
            coming: None,
            iteration: 0.0,
            playback: Playback::default(),
            table: TableShown::default(),
            task: Task::new("align", runner),
            job: AlignJob::Pair,
            writing: Task::new("align-write", runner),
            dialog: FileDialog::default(),
        }
    }

    /// The alignment job in progress, if any.
    pub fn running(&self) -> Option<&Running> {
        self.task.running()
    }

    /// True while a file is being written.
    pub fn is_writing(&self) -> bool {
        self.writing.running().is_some()
    }

    /// True while rows are being added to Table I.
    pub fn is_table_at_work(&self) -> bool {
        self.running().is_some() && self.job == AlignJob::Table
    }

    /// True while a pair is being aligned.
    pub fn is_pair_at_work(&self) -> bool {
        self.running().is_some() && self.job == AlignJob::Pair
    }

    /// Name of the chosen part, or of the first; `None` without a part in the library.
    pub fn chosen_part<'a>(&'a self, session: &'a Session) -> Option<&'a str> {
        let parts = &session.library.as_ref()?.parts;
        let is_there = |name: &&str| parts.iter().any(|part| part.name.as_str() == *name);
        let chosen = self.part.as_deref().filter(is_there);
        chosen.or_else(|| parts.first().map(|part| part.name.as_str()))
    }

    /// Returns what Run would align, or what is missing, in words.
    pub fn choice(&self, session: &Session) -> Result<PairSource, String> {
        let part = || {
            let Some(library) = &session.library else {
                return Err(text!("shell-library-loading"));
            };
            if let Some(problem) = &library.unloaded {
                return Err(problem.what.clone());
            }
            let part = self.chosen_part(session).map(str::to_owned);
            part.ok_or_else(|| text!("align-library-has-no-part"))
        };
        match self.pairing {
            Pairing::MovedCopy => Ok(PairSource::MovedCopy {
                part: part()?,
                start: self.start,
            }),
            Pairing::Scene => {
                let shown = session.shown.as_ref();
                let inspected = &shown
                    .ok_or_else(|| text!("align-nothing-inspected"))?
                    .inspected;
                if inspected.inspection.segmentation.part.is_err() {
                    return Err(text!("align-no-part-in-scene"));
                }
                Ok(PairSource::Scene {
                    inspected: Arc::clone(inspected),
                    part: part()?,
                })
            }
            Pairing::Files => Ok(PairSource::Files {
                source: self
                    .source
                    .clone()
                    .ok_or_else(|| text!("align-choose-source"))?,
                target: self
                    .target
                    .clone()
                    .ok_or_else(|| text!("align-choose-target"))?,
            }),
        }
    }

    /// Carries out an action.
    pub fn apply(&mut self, action: AlignAction, cx: &mut ShellContext<'_>) {
        match action {
            AlignAction::Choose(pairing) => {
                if pairing == Pairing::Scene
                    && let Some(recognised) = recognised(cx.session)
                {
                    self.part = Some(recognised);
                }
                self.pairing = pairing;
            }
            AlignAction::ChoosePart(part) => self.part = Some(part),
            AlignAction::ChooseStart(start) => self.start = start,
            AlignAction::DrawStart => {
                let seed = match self.start {
                    Start::Random(seed) => seed + 1,
                    Start::Paper(_) | Start::Custom(_) => 1,
                };
                self.start = Start::Random(seed);
            }
            AlignAction::ToggleCustom => self.custom.is_open ^= true,
            AlignAction::WriteCustom(text) => self.custom.write(text),
            AlignAction::UseCustom => {
                if let Some(transform) = self.custom.transform {
                    self.start = Start::Custom(transform);
                    self.custom.is_open = false;
                }
            }
            AlignAction::Ask(file) => {
                let lock = &cx.services.dialogs;
                self.dialog.open(file, &file.request(), lock, cx.egui);
            }
            AlignAction::Chosen(AlignFile::Source, path) => self.source = Some(path),
            AlignAction::Chosen(AlignFile::Target, path) => self.target = Some(path),
            AlignAction::Chosen(AlignFile::TableFile, path) => self.write_table(path),
            AlignAction::Run => self.run(cx),
            AlignAction::Cancel => self.cancel(),
            AlignAction::RunTable => self.run_table(cx),
            AlignAction::RestartTable => {
                self.table.rows.clear();
                self.run_table(cx);
            }
            AlignAction::OpenRow(row) => self.open_row(row, cx),
            AlignAction::Scrub(iteration) => {
                self.playback = Playback::Paused;
                self.go_to(iteration);
            }
            AlignAction::Step(iterations) => {
                self.playback = Playback::Paused;
                self.go_to(self.iteration.round() + iterations);
            }
            AlignAction::TogglePlay => self.toggle_play(),
            AlignAction::Advance(seconds) => self.advance(seconds),
            AlignAction::CopyTable => {
                let text = table::text(&self.table.rows, '\t');
                cx.notify(Notice::done(text!("align-copied")));
                cx.send(Action::CopyText(text));
            }
        }
    }

    /// Cancels the alignment job in progress.
    pub fn cancel(&mut self) {
        self.task.cancel();
    }

    fn run(&mut self, cx: &ShellContext<'_>) {
        let Ok(source) = self.choice(cx.session) else {
            return;
        };
        self.coming = None;
        self.job = AlignJob::Pair;
        let library_cache = cx.services.library_cache.clone();
        self.task.start(text!("align-aligning"), move |context| {
            work::pair(&source, &library_cache, context)
        });
    }

    fn run_table(&mut self, cx: &ShellContext<'_>) {
        let rows = self.table.rows.iter();
        let done: Vec<_> = rows.map(|row| (row.part.clone(), row.start)).collect();
        self.table.num_before = done.len();
        self.table.elapsed = Duration::ZERO;
        self.job = AlignJob::Table;
        let library_cache = cx.services.library_cache.clone();
        self.task.start(text!("align-table"), move |context| {
            work::table(&done, &library_cache, context)
        });
    }

    /// Chooses part and start of a row of Table I, and aligns them.
    fn open_row(&mut self, row: usize, cx: &ShellContext<'_>) {
        let Some(row) = self.table.rows.get(row).cloned() else {
            return;
        };
        self.pairing = Pairing::MovedCopy;
        self.part = Some(row.part.clone());
        self.start = Start::Paper(row.start);
        // Do not cancel Table I to look at one of its rows.
        if !self.is_table_at_work() {
            self.run(cx);
        }
    }

    fn write_table(&mut self, path: PathBuf) {
        let title = text!("shell-writing", file = file_name(&path));
        let text = table::text(&self.table.rows, ',');
        self.writing
            .start(title, move |_| Ok(Notice::done(work::write(&path, &text)?)));
    }

    /// Takes in the results of the tasks and of the file dialog.
    pub fn update(&mut self, cx: &mut ShellContext<'_>) {
        while let Some(event) = self.task.poll() {
            match event {
                Ok(result) => self.receive(result, cx),
                Err(error) => {
                    self.coming = None;
                    cx.notify(error);
                }
            }
        }
        cx.notify_written(&mut self.writing);
        if let Some((file, path)) = cx.chosen(&mut self.dialog) {
            self.apply(AlignAction::Chosen(file, path), cx);
        }
    }

    fn receive(&mut self, result: AlignResult, cx: &mut ShellContext<'_>) {
        match result {
            AlignResult::Prepared(pair) => {
                for warning in &pair.warnings {
                    cx.notify(warning.clone());
                }
                self.coming = Some(pair);
            }
            AlignResult::Ran(run) => self.add_run(run),
            AlignResult::Row { row, elapsed } => {
                self.table.rows.push(row);
                self.table.elapsed = elapsed;
            }
            AlignResult::Finished => {}
        }
    }

    /// Shows runs made elsewhere; cancels the job in progress.
    pub fn show(&mut self, pair: Arc<Pair>, runs: impl IntoIterator<Item = Arc<MethodRun>>) {
        self.task.cancel();
        self.coming = Some(pair);
        runs.into_iter().for_each(|run| self.add_run(run));
    }
}

/// Name of the reference that the current scene was recognised by, accepted or not.
fn recognised(session: &Session) -> Option<String> {
    let inspection = &session.shown.as_ref()?.inspected.inspection;
    match &inspection.verdict {
        Verdict::Part { .. } => inspection.reference().map(str::to_owned),
        Verdict::NoPart(_) => None,
    }
}

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
    fn request(self) -> FileRequest {
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

#[cfg(test)]
mod tests;
