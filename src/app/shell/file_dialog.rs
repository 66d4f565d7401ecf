//! The system's file dialogs, asked without waiting for them.

use std::{
    cell::Cell,
    fmt,
    path::{Path, PathBuf},
    pin::Pin,
    rc::Rc,
    sync::{Arc, Mutex, PoisonError},
    task::{Context, Poll, Wake, Waker},
    time::{Duration, Instant},
};

use super::notice::Notice;
use crate::files::POINT_ENDINGS;

/// What a file dialog asks for.
#[derive(Clone, Copy, Debug)]
pub struct FileRequest {
    /// Its title.
    pub title: &'static str,
    /// Kinds of files: a name, and the endings.
    pub filters: &'static [(&'static str, &'static [&'static str])],
    /// What is chosen.
    pub choice: FileChoice,
}

/// What is chosen in a file dialog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileChoice {
    /// A file to read.
    File,
    /// A folder to read.
    Folder,
    /// A file to write, with this name unless a person writes another.
    NewFile(&'static str),
    /// A folder to write into.
    FolderToWrite,
}

/// A filter that lets every file through.
pub const ALL_FILES: (&str, &[&str]) = ("All files", &["*"]);
/// A filter for whatever holds points.
pub const POINTS: (&str, &[&str]) = ("Scenes, clouds and meshes", POINT_ENDINGS);

/// The file dialog of one owner, who tells its questions apart by `K`.
pub struct FileDialog<K> {
    open: Option<(K, OpenDialog)>,
}

/// Keeps a second dialog from opening: it would hide behind the first. Clones share it.
#[derive(Clone, Debug, Default)]
pub struct DialogLock(Rc<Cell<bool>>);

impl<K> Default for FileDialog<K> {
    fn default() -> Self {
        Self { open: None }
    }
}

impl<K: fmt::Debug> fmt::Debug for FileDialog<K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let asked = self.open.as_ref().map(|(asked, _)| asked);
        f.debug_tuple("FileDialog").field(&asked).finish()
    }
}

impl<K: Copy> FileDialog<K> {
    /// Opens the system's dialog, unless one is open.
    pub fn open(
        &mut self,
        asked: K,
        request: &FileRequest,
        lock: &DialogLock,
        egui: &egui::Context,
    ) {
        if let Some(guard) = lock.take() {
            let dialog = OpenDialog::of(request.choice, answer(request), guard, egui);
            self.open = Some((asked, dialog));
        }
    }

    /// What was chosen, or why nothing can be; `None` while the dialog is open and after it was closed.
    pub fn poll(&mut self) -> Option<(K, Result<PathBuf, Notice>)> {
        let (asked, dialog) = self.open.as_mut()?;
        let asked = *asked;
        let Poll::Ready(closed) = dialog.poll() else {
            return None;
        };
        self.open = None;
        closed.map(|closed| (asked, closed))
    }
}

impl DialogLock {
    /// True while a dialog is open.
    pub fn is_open(&self) -> bool {
        self.0.get()
    }

    fn take(&self) -> Option<DialogGuard> {
        (!self.0.replace(true)).then(|| DialogGuard(self.clone()))
    }
}

/// Gives the lock back when the dialog is closed.
struct DialogGuard(DialogLock);

impl Drop for DialogGuard {
    fn drop(&mut self) {
        self.0.0.set(false);
    }
}

/// A dialog that is open.
struct OpenDialog {
    choice: FileChoice,
    answer: Answer<PathBuf>,
    waker: Arc<DialogWaker>,
    /// When it was polled first: only then does it open.
    opened: Option<Instant>,
    _guard: DialogGuard,
}

/// What a person chose, once they have.
type Answer<T> = Pin<Box<dyn Future<Output = Option<T>>>>;

/// Nobody closes a dialog as quickly as this: it never opened.
const TOO_QUICK: Duration = Duration::from_millis(250);

/// Woken by the dialog's own thread as soon as it has closed, however much later the next frame comes.
struct DialogWaker {
    egui: egui::Context,
    closed: Mutex<Option<Instant>>,
}

impl DialogWaker {
    fn closed(&self) -> Option<Instant> {
        *self.closed.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Wake for DialogWaker {
    fn wake(self: Arc<Self>) {
        *self.closed.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
        self.egui.request_repaint();
    }
}

fn answer(request: &FileRequest) -> Answer<PathBuf> {
    let mut dialog = rfd::AsyncFileDialog::new().set_title(request.title);
    for (name, endings) in request.filters {
        dialog = dialog.add_filter(*name, endings);
    }
    let answer: Answer<rfd::FileHandle> = match request.choice {
        FileChoice::File => Box::pin(dialog.pick_file()),
        FileChoice::Folder | FileChoice::FolderToWrite => Box::pin(dialog.pick_folder()),
        FileChoice::NewFile(name) => Box::pin(dialog.set_file_name(name).save_file()),
    };
    Box::pin(async move { Some(answer.await?.path().to_owned()) })
}

impl OpenDialog {
    fn of(
        choice: FileChoice,
        answer: Answer<PathBuf>,
        guard: DialogGuard,
        egui: &egui::Context,
    ) -> Self {
        Self {
            choice,
            answer,
            waker: Arc::new(DialogWaker {
                egui: egui.clone(),
                closed: Mutex::new(None),
            }),
            opened: None,
            _guard: guard,
        }
    }

    /// Ready once it was closed, with what follows from it, if anything.
    fn poll(&mut self) -> Poll<Option<Result<PathBuf, Notice>>> {
        let opened = *self.opened.get_or_insert_with(Instant::now);
        let waker = Waker::from(Arc::clone(&self.waker));
        let answer = self.answer.as_mut();
        answer
            .poll(&mut Context::from_waker(&waker))
            .map(|path| match path {
                Some(path) => Some(Ok(path)),
                None if self.open_time(opened) < TOO_QUICK => Some(without_dialog(self.choice)),
                None => None,
            })
    }

    /// How long it was open. The clock of frames would not tell: behind Live, one may take longer than failing does.
    fn open_time(&self, opened: Instant) -> Duration {
        let closed = self.waker.closed().unwrap_or_else(Instant::now);
        closed.saturating_duration_since(opened)
    }
}

/// Where nothing can be asked: files to write go to a folder of their own, files to read can be dropped.
fn without_dialog(choice: FileChoice) -> Result<PathBuf, Notice> {
    let name = match choice {
        FileChoice::FolderToWrite => "",
        FileChoice::NewFile(name) => name,
        FileChoice::File | FileChoice::Folder => return Err(never_opened()),
    };
    let folders = directories::UserDirs::new().ok_or_else(never_opened)?;
    let documents = folders.document_dir();
    let folder = documents.unwrap_or(folders.home_dir()).join("Partsight");
    // The folder is made here: what writes a file does not.
    std::fs::create_dir_all(&folder)
        .ok()
        .ok_or_else(never_opened)?;
    Ok(if name.is_empty() {
        folder
    } else {
        free(&folder, name)
    })
}

/// A path of this name in the folder that nothing has yet.
fn free(folder: &Path, name: &str) -> PathBuf {
    let (stem, ending) = name.rsplit_once('.').unwrap_or((name, ""));
    let numbered = (2..1000).map(|number| folder.join(format!("{stem}-{number}.{ending}")));
    std::iter::once(folder.join(name))
        .chain(numbered)
        .find(|path| !path.exists())
        .unwrap_or_else(|| folder.join(name))
}

fn never_opened() -> Notice {
    Notice::look(
        "The desktop offers no file dialog",
        "Drop the file onto the window, or install the package xdg-desktop-portal-gtk or zenity",
    )
}

#[cfg(test)]
mod tests {
    use std::{future::poll_fn, thread};

    use super::*;

    /// A dialog that closes by itself after this time, with nothing chosen.
    fn closing_after(time: Duration) -> OpenDialog {
        let mut thread = None;
        let answer = poll_fn(move |context| {
            if thread.is_some() {
                return Poll::Ready(None);
            }
            let waker = context.waker().clone();
            thread = Some(thread::spawn(move || {
                thread::sleep(time);
                waker.wake();
            }));
            Poll::Pending
        });
        let guard = DialogLock::default().take().expect("no other dialog");
        let egui = egui::Context::default();
        OpenDialog::of(FileChoice::File, Box::pin(answer), guard, &egui)
    }

    /// What follows where the next frame comes only once the dialog has long closed.
    fn after_a_slow_frame(mut dialog: OpenDialog) -> Poll<Option<Result<PathBuf, Notice>>> {
        thread::sleep(TOO_QUICK);
        assert!(dialog.poll().is_pending());
        while dialog.waker.closed().is_none() {
            thread::sleep(Duration::from_millis(1));
        }
        thread::sleep(2 * TOO_QUICK);
        dialog.poll()
    }

    #[test]
    fn a_dialog_that_never_opened_is_told_from_a_cancelled_one_in_slow_frames_too() {
        let failed = after_a_slow_frame(closing_after(Duration::ZERO));
        assert!(matches!(failed, Poll::Ready(Some(Err(_)))));
        let cancelled = after_a_slow_frame(closing_after(2 * TOO_QUICK));
        assert!(matches!(cancelled, Poll::Ready(None)));
    }

    #[test]
    fn one_dialog_is_open_at_a_time() {
        let lock = DialogLock::default();
        let first = lock.take().expect("free");
        assert!(lock.take().is_none() && lock.is_open());
        drop(first);
        assert!(!lock.is_open());
        assert!(lock.take().is_some());
    }
}
