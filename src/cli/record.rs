//! Recording of inspections in the history, after every verdict.

use std::{collections::BTreeMap, path::PathBuf};

use clap::Args;

use super::{
    console::Console,
    plant::{ChosenDatabase, HistorySender, HistoryToChoice},
};
use inspection::library::LibraryLoad;
use records::{
    history::{
        HistoryError, HistoryEvent, HungId, NewEntry, ServoRecord, TraceChange, Traceability,
        users_folder,
    },
    report::segmentation_picture,
};
use station::{Inspected, LibraryNames, Losses, Recorder};

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

/// Whether and where inspections are recorded.
#[derive(Debug, Args)]
pub(super) struct RecordingChoice {
    #[command(flatten)]
    history: HistoryChoice,
    /// Do not write to the history
    #[arg(long, conflicts_with = "history")]
    no_history: bool,
    #[command(flatten)]
    history_to: HistoryToChoice,
}

impl RecordingChoice {
    /// Returns the database that the history is sent to, if one is given.
    pub(super) fn database(&self, console: &Console) -> anyhow::Result<Option<ChosenDatabase>> {
        self.history_to.chosen(console)
    }

    /// Starts recording, as [`HistoryRecorder::start`] does; returns `None` if it is not wanted.
    pub(super) fn start(
        &self,
        library: &LibraryLoad,
        trace: &Traceability,
        database: Option<ChosenDatabase>,
        console: &Console,
    ) -> anyhow::Result<Option<HistoryRecorder>> {
        if self.no_history {
            return Ok(None);
        }
        HistoryRecorder::start(&self.history, library, trace, database, console)
    }
}

/// Writes inspections to the history. All failures are only warnings, since the verdict counts.
pub(super) struct HistoryRecorder {
    recorder: Recorder,
    library: String,
    titles: BTreeMap<String, String>,
    trace: Traceability,
    /// Sends the history to a database.
    sender: Option<HistorySender>,
}

impl HistoryRecorder {
    /// Starts recording, and sending the history to a database if one is given; returns `None` after a warning if there is
    /// no history.
    pub(super) fn start(
        choice: &HistoryChoice,
        library: &LibraryLoad,
        trace: &Traceability,
        database: Option<ChosenDatabase>,
        console: &Console,
    ) -> anyhow::Result<Option<Self>> {
        let folder = match choice.folder() {
            Ok(folder) => folder,
            Err(error) => {
                console.warn(&error, &error);
                return Ok(None);
            }
        };
        let Ok(recorder) = Recorder::start(folder.clone()) else {
            console.note(
                &"warning: the history is not written: the system cannot start a thread for it",
            );
            return Ok(None);
        };
        let sender = database.map(|database| HistorySender::start(folder, database));
        Ok(Some(Self {
            recorder,
            library: library.identity(),
            titles: titles_of(library),
            trace: trace.clone(),
            sender: sender.transpose()?,
        }))
    }

    /// Inspections are by this library from now on.
    pub(super) fn use_library(&mut self, library: &LibraryLoad) {
        self.library = library.identity();
        self.titles = titles_of(library);
    }

    /// The title of a part of the library.
    pub(super) fn title_of(&self, name: &str) -> String {
        let title = self.titles.get(name);
        title.map_or_else(|| name.to_owned(), Clone::clone)
    }

    /// Creates the entry of an inspection.
    pub(super) fn entry(&self, inspected: &Inspected<'_>, hung: HungId) -> NewEntry {
        self.traced_entry(inspected, hung, &self.trace)
    }

    /// Creates the entry of an inspection that is traced by something else.
    pub(super) fn traced_entry(
        &self,
        inspected: &Inspected<'_>,
        hung: HungId,
        trace: &Traceability,
    ) -> NewEntry {
        let names = LibraryNames {
            identity: &self.library,
            title_of: &|name: &str| self.title_of(name),
        };
        let segmentation = &inspected.inspection.segmentation;
        let picture = segmentation_picture(inspected.scene, segmentation);
        inspected.entry(hung, trace.clone(), names, picture.as_ref())
    }

    /// Adds an inspection.
    pub(super) fn add(&mut self, entry: NewEntry, console: &Console) {
        self.recorder.add(entry);
        self.tell(console);
    }

    /// Sets the traceability of a part that was recorded before it was known.
    pub(super) fn trace(&self, hung: HungId, trace: Traceability) {
        self.recorder.trace(hung, TraceChange::Set(trace));
    }

    /// Adds a run of servoing.
    pub(super) fn add_servo_run(&self, record: ServoRecord) {
        self.recorder.add_servo_run(record);
    }

    /// Shows the new events of the history.
    pub(super) fn tell(&self, console: &Console) {
        for news in self.recorder.take_news() {
            tell_of(news, console);
        }
        if let Some(sender) = &self.sender {
            sender.show_news(console, tell_of);
        }
    }

    /// Waits until everything is written, and reports what could not be.
    pub(super) fn finish(self, console: &Console) {
        self.recorder.finish();
        self.tell(console);
        // Everything to be sent has been written by now.
        if let Some(sender) = self.sender {
            sender.end(console, tell_of);
        }
        for warning in warnings_of(self.recorder.losses()) {
            console.note(&warning);
        }
    }
}

/// Returns a warning for each reason why inspections, frames or a run of servoing are not in the history.
fn warnings_of(losses: Losses) -> Vec<String> {
    let run = losses.lacks_servo_run;
    let run = run.then(|| "warning: the run is not in the history".to_owned());
    let losses = [
        (losses.num_unwritten, "not in the history"),
        (losses.num_slow, "not in the history: the disk is too slow"),
        (
            losses.num_bare,
            "in the history without frames: the disk is too slow",
        ),
    ];
    let losses = losses.into_iter().filter(|(num, _)| *num > 0);
    losses
        .map(|(num, what)| format!("warning: {} {what}", inspections_are(num)))
        .chain(run)
        .collect()
}

fn inspections_are(num: usize) -> String {
    let inspections_are = if num == 1 {
        "inspection is"
    } else {
        "inspections are"
    };
    format!("{num} {inspections_are}")
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
        HistoryEvent::Works { numbers, num_lost } => {
            for line in writable_again(numbers.len(), num_lost) {
                console.note(&line);
            }
        }
        HistoryEvent::NotChanged { what, advice }
        | HistoryEvent::FramesNotKept { what, advice } => {
            console.advise(&format_args!("warning: {what}"), &advice);
        }
        HistoryEvent::FramesKept => console.note(&"Frames are kept in the history again"),
        HistoryEvent::Swept(swept) if swept.num_frames > USUALLY_SWEPT => {
            console.note(&format_args!(
                "The retention rule removed {} frames, {:.1} MB, from the history",
                swept.num_frames,
                swept.num_bytes as f64 / 1e6
            ));
        }
        HistoryEvent::Added { .. }
        | HistoryEvent::Changed { .. }
        | HistoryEvent::FilesChanged
        | HistoryEvent::RuleChanged
        | HistoryEvent::Swept(_) => {}
    }
}

/// Frames up to this number are removed without a message. In the long run as many go as come, and they are removed after
/// every 25 inspections.
const USUALLY_SWEPT: usize = 25;

fn writable_again(num_saved: usize, num_lost: usize) -> Vec<String> {
    let mut lines = vec![format!(
        "The history is writable again: {num_saved} waiting inspections were saved"
    )];
    if num_lost > 0 {
        let inspections_are = inspections_are(num_lost);
        lines.push(format!(
            "warning: {inspections_are} not in the history: too many waited"
        ));
    }
    lines
}

#[cfg(test)]
mod tests {
    use std::{fs, time::Instant};

    use super::*;
    use records::{
        fixtures::history_entry,
        history::{HistoryBuffer, StoredVerdict},
    };

    #[test]
    fn inspections_that_were_dropped_because_too_many_waited_are_counted() {
        let home = tempfile::tempdir().expect("a folder");
        let place = home.path().join("taken");
        fs::write(&place, "a file").expect("written");
        let keeper = HistoryBuffer::new(Some(place.clone()));
        for ticket in 0..2100 {
            let mut entry = history_entry(1, StoredVerdict::Rejected, "fender");
            (entry.scene, entry.picture) = (None, None);
            keeper.add(ticket, entry, Instant::now());
        }
        let expected = "warning: 2100 inspections are not in the history";
        let losses = |dropped| warnings_of(Losses::new(&keeper, dropped));
        assert_eq!(losses([0; 2]), [expected]);

        keeper.take_news();
        fs::remove_file(&place).expect("removed");
        keeper.retry_now();
        let news = keeper.take_news();
        let Some(HistoryEvent::Works { numbers, num_lost }) = news.last() else {
            panic!("{news:?}");
        };
        let notes = writable_again(numbers.len(), *num_lost);
        assert!(notes[0].ends_with("2000 waiting inspections were saved"));
        let expected = "warning: 100 inspections are not in the history: too many waited";
        assert_eq!(notes[1..], [expected]);
        assert_eq!(losses([0; 2]), [""; 0]);
        assert_eq!(writable_again(1, 0).len(), 1);
        let slow = "warning: 1 inspection is not in the history: the disk is too slow";
        assert_eq!(losses([0, 1]), [slow]);
    }
}
