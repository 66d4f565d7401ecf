//! Recording of inspections in the history, after every verdict.

use std::{collections::BTreeMap, path::PathBuf, sync::Arc};

use clap::Args;
use jiff::Timestamp;

use super::console::Console;
#[cfg(feature = "plant")]
use super::{
    console::Advised as _,
    database::{ChosenDatabase, end_sender, show_news},
};
#[cfg(feature = "plant")]
use crate::plant::database::HistorySender;
use crate::{
    history::{
        HistoryBuffer, HistoryError, HistoryEvent, HungId, InspectionContext, NewEntry,
        Traceability, Writer, users_folder,
    },
    library::LibraryLoad,
    pipeline::{Inspection, NamedRecipe},
    report::segmentation_picture,
    stages::scene::SceneCloud,
};

/// Where the history is.
#[derive(Clone, Debug, Args)]
pub(super) struct HistoryChoice {
    /// Folder of the history; default: your own, which the window uses too
    #[arg(long, value_name = "DIR", global = true)]
    pub(super) history: Option<PathBuf>,
}

impl HistoryChoice {
    /// Returns the folder.
    pub(super) fn folder(&self) -> Result<PathBuf, HistoryError> {
        self.history.clone().map_or_else(users_folder, Ok)
    }
}

/// Writes inspections to the history on a separate thread. All failures are only warnings, since the verdict counts.
pub(super) struct HistoryRecorder {
    keeper: Arc<HistoryBuffer>,
    writer: Writer,
    library: String,
    titles: BTreeMap<String, String>,
    recipe: NamedRecipe,
    trace: Traceability,
    num: u64,
    #[cfg(feature = "plant")]
    sender: Option<HistorySender>,
}

impl HistoryRecorder {
    /// Starts recording; returns `None` after a warning if that fails.
    pub(super) fn start(
        choice: &HistoryChoice,
        library: &LibraryLoad,
        recipe: &NamedRecipe,
        trace: &Traceability,
        console: &Console,
    ) -> Option<Self> {
        let folder = match choice.folder() {
            Ok(folder) => folder,
            Err(error) => {
                console.warn(&error, &error);
                return None;
            }
        };
        let keeper = Arc::new(HistoryBuffer::new(Some(folder)));
        let Ok(writer) = Writer::start(Arc::clone(&keeper), || ()) else {
            console.note(
                &"warning: the history is not written: the system cannot start a thread for it",
            );
            return None;
        };
        Some(Self {
            keeper,
            writer,
            library: library.identity(),
            titles: titles_of(library),
            recipe: recipe.clone(),
            trace: trace.clone(),
            num: 0,
            #[cfg(feature = "plant")]
            sender: None,
        })
    }

    /// Also sends the history to this database from now on, on a separate thread.
    #[cfg(feature = "plant")]
    pub(super) fn sent_to(mut self, database: Option<ChosenDatabase>) -> anyhow::Result<Self> {
        if let Some((folder, database)) = self.keeper.folder().zip(database) {
            let ChosenDatabase { access, cell } = database;
            let sender = HistorySender::start(folder.to_owned(), access, cell);
            self.sender = Some(sender.advised()?);
        }
        Ok(self)
    }

    /// Inspections are by this library from now on.
    #[cfg(feature = "plant")]
    pub(super) fn use_library(&mut self, library: &LibraryLoad) {
        self.library = library.identity();
        self.titles = titles_of(library);
    }

    /// Creates the entry of an inspection; `line` is what `--json` writes.
    pub(super) fn entry(
        &self,
        taken: SceneOrigin<'_>,
        scene: &Arc<SceneCloud>,
        inspection: &Inspection,
        line: &str,
        hung: HungId,
    ) -> NewEntry {
        let title_of = |name: &str| {
            let title = self.titles.get(name);
            title.map_or_else(|| name.to_owned(), Clone::clone)
        };
        let picture = segmentation_picture(scene, &inspection.segmentation);
        let about = InspectionContext {
            at: Timestamp::now(),
            scene: taken.scene.to_owned(),
            source: taken.source.to_owned(),
            is_simulated: taken.is_simulated,
            title_of: &title_of,
            line: line.to_owned(),
            library: self.library.clone(),
            origin: None,
            picture: picture.as_ref(),
            hung,
        };
        let mut entry = NewEntry::of(about, scene, inspection, &self.recipe);
        entry.record.summary.trace = self.trace.clone();
        entry
    }

    /// Adds an inspection.
    pub(super) fn add(&mut self, entry: NewEntry, console: &Console) {
        self.num += 1;
        self.writer.add(self.num, entry);
        self.tell(console);
    }

    /// Shows the new events of the history.
    pub(super) fn tell(&self, console: &Console) {
        for news in self.keeper.take_news() {
            tell_of(news, console);
        }
        #[cfg(feature = "plant")]
        if let Some(sender) = &self.sender {
            show_news(sender, console, tell_of);
        }
    }

    /// Waits until everything is written, and reports what could not be.
    pub(super) fn finish(self, console: &Console) {
        self.writer.finish();
        self.tell(console);
        // Everything to be sent has been written by now.
        #[cfg(feature = "plant")]
        if let Some(sender) = self.sender {
            end_sender(sender, console, tell_of);
        }
        let num_waiting = self.keeper.num_waiting();
        let [num_bare, num_lost] = self.writer.take_dropped();
        for (num, what) in [
            (num_waiting, "not in the history"),
            (num_lost, "not in the history: the disk is too slow"),
            (
                num_bare,
                "in the history without frames: the disk is too slow",
            ),
        ] {
            if num > 0 {
                let inspections_are = if num == 1 {
                    "inspection is"
                } else {
                    "inspections are"
                };
                console.note(&format_args!("warning: {num} {inspections_are} {what}"));
            }
        }
    }
}

fn titles_of(library: &LibraryLoad) -> BTreeMap<String, String> {
    let titles = library.parts.iter();
    titles
        .map(|part| (part.name.to_string(), part.shown_title().to_owned()))
        .collect()
}

fn tell_of(news: HistoryEvent, console: &Console) {
    match news {
        HistoryEvent::Failed { what, advice } => {
            console.advise(
                &format_args!("warning: {what}"),
                &format_args!("{advice}; the verdicts are not affected"),
            );
        }
        HistoryEvent::SetAside(aside) => {
            console.note(&format_args!("warning: the history: {}", aside.what));
            let place = aside.aside.display();
            console.note(&format_args!("  it was set aside as {place}"));
        }
        HistoryEvent::Works { numbers, .. } => {
            let num = numbers.len();
            console.note(&format_args!(
                "The history is writable again: {num} waiting inspections were saved"
            ));
        }
        HistoryEvent::Added { .. }
        | HistoryEvent::Changed { .. }
        | HistoryEvent::NotChanged { .. }
        | HistoryEvent::FilesChanged
        | HistoryEvent::RuleChanged
        | HistoryEvent::Swept(_) => {}
    }
}

/// Origin of a scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct SceneOrigin<'a> {
    pub(super) scene: &'a str,
    /// The source in the form that opens it again, or a file.
    pub(super) source: &'a str,
    /// True if the scene does not come from a camera.
    pub(super) is_simulated: bool,
}
