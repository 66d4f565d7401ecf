//! The system's file dialogs, polled without blocking. Where the desktop has none, a path is typed or chosen in a list of folders
//! and files.

use std::{
    cell::{Cell, RefCell, RefMut},
    fmt, fs,
    path::{self, Path, PathBuf},
    pin::Pin,
    rc::Rc,
    sync::{Arc, Mutex},
    task::{Context, Poll, Wake, Waker},
    time::{Duration, Instant},
};

use egui::{Key, RichText, ScrollArea, TextEdit, Ui, text_edit::TextEditState};

use crate::notice::Notice;
use files::{POINT_ENDINGS, disk, file_name, file_of, folder_of, in_counting_order, words_of};
use geometry::error::lock;
use robot::program::RobotLanguage;
use ui::{
    language::text,
    theme::{Theme, space},
    widgets::{self, show_scroll_bar, text_button},
};

/// A kind of files: its name and its endings.
pub type FileFilter = (String, &'static [&'static str]);

/// What a file dialog asks for.
#[derive(Clone, Debug)]
pub struct FileRequest {
    /// Title of the dialog.
    pub title: String,
    /// Kinds of files to offer.
    pub filters: Vec<FileFilter>,
    /// Whether a file or a folder is chosen, to read or to write.
    pub choice: FileChoice,
}

/// The choice made in a file dialog.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileChoice {
    /// A file to read.
    File,
    /// A folder to read.
    Folder,
    /// A file to write, with this suggested name.
    NewFile(String),
    /// A folder to write into.
    FolderToWrite,
}

/// A filter that accepts every file.
pub fn all_files() -> FileFilter {
    (text!("shell-all-files"), &["*"])
}

/// A filter for all files that hold points.
pub fn points() -> FileFilter {
    (text!("shell-scenes-clouds-meshes"), POINT_ENDINGS)
}

/// A filter for robot programs.
pub fn program_files() -> FileFilter {
    (text!("program-files"), &RobotLanguage::ENDINGS)
}

/// The file dialog of one owner, who distinguishes its requests by `K`.
pub struct FileDialog<K> {
    open: Option<(K, OpenDialog)>,
}

/// Allows only one dialog at a time, because a second would hide behind the first. Clones share it, and the path being typed
/// where the system has no dialog.
#[derive(Clone, Debug, Default)]
pub struct DialogLock(Rc<SharedDialog>);

#[derive(Debug, Default)]
struct SharedDialog {
    is_open: Cell<bool>,
    typed: RefCell<Option<PathEntry>>,
    /// Folders of the last typed paths: to read, and to write.
    folders: RefCell<[Option<PathBuf>; 2]>,
}

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
            let dialog = OpenDialog::of(request.clone(), answer(request), guard, egui);
            self.open = Some((asked, dialog));
        }
    }

    /// Returns the chosen path, or why none can be chosen; `None` while the dialog is open and after it was cancelled.
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
        self.0.is_open.get()
    }

    /// True while the system's dialog is open or opens, which takes a while on a busy computer: typed letters are meant for it.
    pub fn takes_keys(&self) -> bool {
        self.is_open() && self.typed().is_none()
    }

    /// The path being typed, if any.
    fn typed(&self) -> RefMut<'_, Option<PathEntry>> {
        self.0.typed.borrow_mut()
    }

    /// Folder in which typing a path starts.
    fn folder(&self, choice: &FileChoice) -> PathBuf {
        let known = self.0.folders.borrow()[usize::from(choice.is_written())].clone();
        known.unwrap_or_else(|| usual_folder(choice))
    }

    fn remember(&self, choice: &FileChoice, path: &Path) {
        let folder = match choice {
            FileChoice::FolderToWrite => path,
            _ => folder_of(path),
        };
        self.0.folders.borrow_mut()[usize::from(choice.is_written())] = Some(folder.to_owned());
    }

    fn take(&self) -> Option<DialogGuard> {
        (!self.0.is_open.replace(true)).then(|| DialogGuard(self.clone()))
    }
}

/// Releases the lock when the dialog is closed.
struct DialogGuard(DialogLock);

impl Drop for DialogGuard {
    fn drop(&mut self) {
        let shared = &self.0.0;
        shared.is_open.set(false);
        shared.typed.replace(None);
    }
}

/// An open dialog.
struct OpenDialog {
    request: FileRequest,
    answer: Answer<PathBuf>,
    waker: Arc<DialogWaker>,
    /// When it was first polled, which is what opens it.
    opened: Option<Instant>,
    /// True once it has failed to open and a path is typed instead.
    is_typed: bool,
    guard: DialogGuard,
}

/// Resolves to the chosen path.
type Answer<T> = Pin<Box<dyn Future<Output = Option<T>>>>;

/// No user closes a dialog faster than this: it never opened.
const TOO_QUICK: Duration = Duration::from_millis(250);

/// Woken by the dialog's own thread as it closes, however much later the next frame comes.
struct DialogWaker {
    egui: egui::Context,
    closed: Mutex<Option<Instant>>,
}

impl DialogWaker {
    fn closed(&self) -> Option<Instant> {
        *lock(&self.closed)
    }
}

impl Wake for DialogWaker {
    fn wake(self: Arc<Self>) {
        *lock(&self.closed) = Some(Instant::now());
        self.egui.request_repaint();
    }
}

fn answer(request: &FileRequest) -> Answer<PathBuf> {
    let mut dialog = rfd::AsyncFileDialog::new().set_title(&request.title);
    for (name, endings) in &request.filters {
        dialog = dialog.add_filter(name, endings);
    }
    let answer: Answer<rfd::FileHandle> = match &request.choice {
        FileChoice::File => Box::pin(dialog.pick_file()),
        FileChoice::Folder | FileChoice::FolderToWrite => Box::pin(dialog.pick_folder()),
        FileChoice::NewFile(name) => Box::pin(dialog.set_file_name(name).save_file()),
    };
    Box::pin(async move { Some(answer.await?.path().to_owned()) })
}

impl OpenDialog {
    fn of(
        request: FileRequest,
        answer: Answer<PathBuf>,
        guard: DialogGuard,
        egui: &egui::Context,
    ) -> Self {
        Self {
            request,
            answer,
            waker: Arc::new(DialogWaker {
                egui: egui.clone(),
                closed: Mutex::new(None),
            }),
            opened: None,
            is_typed: false,
            guard,
        }
    }

    /// Ready once the dialog was closed, with the result, if any.
    fn poll(&mut self) -> Poll<Option<Result<PathBuf, Notice>>> {
        if !self.is_typed {
            let opened = *self.opened.get_or_insert_with(Instant::now);
            let waker = Waker::from(Arc::clone(&self.waker));
            let answer = self.answer.as_mut();
            let Poll::Ready(path) = answer.poll(&mut Context::from_waker(&waker)) else {
                return Poll::Pending;
            };
            if path.is_some() || self.open_time(opened) >= TOO_QUICK {
                return Poll::Ready(path.map(Ok));
            }
            self.is_typed = true;
            let lock = &self.guard.0;
            let folder = lock.folder(&self.request.choice);
            *lock.typed() = Some(PathEntry::new(self.request.clone(), folder));
            self.waker.egui.request_repaint();
        }
        let typed = self
            .guard
            .0
            .typed()
            .as_ref()
            .map(|typed| typed.outcome.clone());
        typed
            .unwrap_or(Poll::Ready(None))
            .map(|path| path.map(|path| self.made(path)))
    }

    /// Creates the folder to write into for a typed path, because writing a file does not create it.
    fn made(&self, path: PathBuf) -> Result<PathBuf, Notice> {
        let choice = &self.request.choice;
        let folder = match choice {
            FileChoice::File | FileChoice::Folder => None,
            FileChoice::NewFile(_) => Some(folder_of(&path)),
            FileChoice::FolderToWrite => Some(path.as_path()),
        };
        if let Some(folder) = folder {
            disk::create_dir_all(folder).map_err(|error| {
                let what = text!(
                    "shell-cannot-be-made",
                    path = folder.display().to_string(),
                    why = words_of(&error)
                );
                Notice::look(what, text!("shell-choose-another-folder"))
            })?;
        }
        self.guard.0.remember(choice, &path);
        Ok(path)
    }

    /// How long the dialog was open. Timing by frames would be wrong: with Live running, a frame may take longer than failing
    /// does.
    fn open_time(&self, opened: Instant) -> Duration {
        let closed = self.waker.closed().unwrap_or_else(Instant::now);
        closed.saturating_duration_since(opened)
    }
}

impl FileChoice {
    fn is_written(&self) -> bool {
        matches!(self, Self::NewFile(_) | Self::FolderToWrite)
    }
}

/// Folder for the first typed path: the home folder to read, a folder of its own to write.
fn usual_folder(choice: &FileChoice) -> PathBuf {
    let Some(user) = directories::UserDirs::new() else {
        return PathBuf::from("/");
    };
    if !choice.is_written() {
        return user.home_dir().to_owned();
    }
    let documents = user.document_dir().unwrap_or(user.home_dir());
    documents.join("Partsight")
}

/// Width of the dialog, logical pixels.
const WIDTH: f32 = 560.0;
/// Height of its list, logical pixels.
const LIST_HEIGHT: f32 = 240.0;

/// A path being typed.
#[derive(Debug)]
struct PathEntry {
    request: FileRequest,
    /// The folder in which typing started.
    folder: PathBuf,
    text: String,
    /// The text when the list was made.
    listed_for: Option<String>,
    /// The folder that is listed.
    listed: PathBuf,
    /// What is in it.
    entries: Vec<FolderEntry>,
    problem: Option<String>,
    /// The existing file that would be replaced, once the user was warned.
    replaced: Option<PathBuf>,
    /// The confirmed path; `None` inside if cancelled.
    outcome: Poll<Option<PathBuf>>,
    is_new: bool,
}

/// A folder or file in the list.
#[derive(Debug, PartialEq, Eq)]
struct FolderEntry {
    name: String,
    is_folder: bool,
}

/// Maximum number of entries in the list.
const MAX_ENTRIES: usize = 1000;

impl PathEntry {
    /// Starts in this folder.
    fn new(request: FileRequest, folder: PathBuf) -> Self {
        let begun = match &request.choice {
            // With a separator at the end.
            FileChoice::File | FileChoice::Folder => folder.join(""),
            FileChoice::NewFile(name) => free(&folder, name),
            FileChoice::FolderToWrite => folder.clone(),
        };
        Self {
            text: begun.display().to_string(),
            request,
            folder,
            listed_for: None,
            listed: PathBuf::new(),
            entries: Vec::new(),
            problem: None,
            replaced: None,
            outcome: Poll::Pending,
            is_new: true,
        }
    }

    /// Replaces the text.
    fn write(&mut self, text: &str) {
        text.clone_into(&mut self.text);
        (self.problem, self.replaced) = (None, None);
    }

    /// The text as a path.
    fn path(&self) -> PathBuf {
        let typed = Path::new(self.text.trim());
        match (typed.strip_prefix("~"), directories::UserDirs::new()) {
            (Ok(rest), Some(user)) => user.home_dir().join(rest),
            _ => typed.to_owned(),
        }
    }

    /// Lists the folder that the text names, if it is another one.
    fn list(&mut self) {
        if self.listed_for.as_ref() == Some(&self.text) {
            return;
        }
        self.listed_for = Some(self.text.clone());
        let path = self.path();
        let folder = if path.is_dir() {
            path.as_path()
        } else {
            folder_of(&path)
        };
        if folder == self.listed {
            return;
        }
        folder.clone_into(&mut self.listed);
        self.entries = self.entries_of(folder);
    }

    /// The folders in this one and, if a file is wanted, its files of the wanted kinds; none if it cannot be read.
    fn entries_of(&self, folder: &Path) -> Vec<FolderEntry> {
        let is_file_wanted = matches!(
            self.request.choice,
            FileChoice::File | FileChoice::NewFile(_)
        );
        let mut endings = self
            .request
            .filters
            .iter()
            .flat_map(|(_, endings)| *endings);
        let takes_all = self.request.filters.is_empty() || endings.any(|ending| *ending == "*");
        let is_wanted = |entry: &FolderEntry| {
            let ending = Path::new(&entry.name).extension().unwrap_or_default();
            let kinds = self.request.filters.iter();
            let mut endings = kinds.flat_map(|(_, endings)| *endings);
            let is_kind = takes_all || endings.any(|known| ending.eq_ignore_ascii_case(known));
            entry.is_folder || is_file_wanted && is_kind
        };
        let found = fs::read_dir(folder).into_iter().flatten().flatten();
        let found = found.map(|entry| {
            let path = entry.path();
            // Of a folder with many captures, only links are followed.
            let is_folder = entry
                .file_type()
                .is_ok_and(|kind| kind.is_dir() || kind.is_symlink() && path.is_dir());
            FolderEntry {
                name: file_name(&path),
                is_folder,
            }
        });
        let shown = found.filter(|entry| !entry.name.starts_with('.') && is_wanted(entry));
        let mut shown: Vec<FolderEntry> = shown.take(MAX_ENTRIES).collect();
        shown.sort_by_cached_key(|entry| (!entry.is_folder, in_counting_order(&entry.name)));
        shown
    }

    /// Goes into a folder of the list, or to the one around it; a name of a file to write stays.
    fn enter(&mut self, folder: &Path) {
        let text = match &self.request.choice {
            FileChoice::NewFile(_) => folder.join(file_name(&self.path())),
            FileChoice::File | FileChoice::Folder | FileChoice::FolderToWrite => folder.join(""),
        };
        self.write(&text.display().to_string());
        self.is_new = true;
    }

    /// Draws the folder around the listed one, and what is in that.
    fn entries_ui(&mut self, ui: &mut Ui) {
        self.list();
        show_scroll_bar(ui);
        let (mut entered, mut chosen) = (None, None);
        let area = ScrollArea::vertical().id_salt(&self.listed);
        let area = area
            .max_height(LIST_HEIGHT)
            .min_scrolled_height(LIST_HEIGHT);
        area.auto_shrink(false).show(ui, |ui| {
            if let Some(above) = self.listed.parent()
                && ui.selectable_label(false, "../").clicked()
            {
                entered = Some(above.to_owned());
            }
            for entry in &self.entries {
                let path = self.listed.join(&entry.name);
                if entry.is_folder {
                    let name = format!("{}/", entry.name);
                    if ui.selectable_label(false, name).clicked() {
                        entered = Some(path);
                    }
                } else if ui.selectable_label(false, &entry.name).clicked() {
                    chosen = Some(path);
                }
            }
        });
        if let Some(folder) = entered {
            self.enter(&folder);
        }
        if let Some(file) = chosen {
            self.write(&file.display().to_string());
            self.is_new = true;
        }
    }

    /// Accepts the text as a path, or shows what is wrong with it.
    fn confirm(&mut self) {
        self.problem = match path::absolute(self.path()) {
            Err(_) => Some(text!("shell-type-a-path")),
            Ok(path) => {
                let problem = self.problem_with(&path);
                if problem.is_none() {
                    self.outcome = Poll::Ready(Some(path));
                }
                problem
            }
        };
    }

    fn problem_with(&mut self, path: &Path) -> Option<String> {
        let problem = match &self.request.choice {
            FileChoice::File | FileChoice::NewFile(_) if path.is_dir() => {
                text!("shell-add-a-name")
            }
            FileChoice::File if !file_of(path).is_file() => text!("shell-no-such-file"),
            FileChoice::Folder if !path.is_dir() => text!("shell-no-such-folder"),
            FileChoice::FolderToWrite if path.is_file() => text!("shell-not-a-folder"),
            FileChoice::NewFile(_) if path.exists() && self.replaced.as_deref() != Some(path) => {
                self.replaced = Some(path.to_owned());
                text!("shell-confirm-replace")
            }
            FileChoice::NewFile(_)
                if path
                    .parent()
                    .is_none_or(|folder| folder != self.folder && !folder.is_dir()) =>
            {
                text!("shell-no-parent-folder")
            }
            _ => return None,
        };
        Some(problem)
    }
}

/// Returns an unused path with this name in the folder.
fn free(folder: &Path, name: &str) -> PathBuf {
    let (stem, ending) = name.rsplit_once('.').unwrap_or((name, ""));
    let numbered = (2..1000).map(|number| folder.join(format!("{stem}-{number}.{ending}")));
    std::iter::once(folder.join(name))
        .chain(numbered)
        .find(|path| !path.exists())
        .unwrap_or_else(|| folder.join(name))
}

/// Draws the dialog while a path is being typed.
pub fn ui(ctx: &egui::Context, lock: &DialogLock) {
    let theme = Theme::of(ctx);
    let mut typed = lock.typed();
    let Some(entry) = typed.as_mut() else {
        return;
    };
    let modal = widgets::dialog(ctx, "typed path", |ui| {
        ui.set_max_width(WIDTH);
        ui.heading(&entry.request.title);
        let says = text!("shell-no-file-dialog");
        ui.weak(says);
        let name = ui.label(text!("shell-path"));
        let mut text = entry.text.clone();
        let field = ui.add(TextEdit::singleline(&mut text).desired_width(WIDTH));
        let field = field.labelled_by(name.id);
        if field.changed() {
            entry.write(&text);
        }
        if std::mem::take(&mut entry.is_new) {
            // The cursor of the former path; without one, it is at the end.
            TextEditState::default().store(ui.ctx(), field.id);
            field.request_focus();
        }
        let is_entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        ui.scope(|ui| entry.entries_ui(ui));
        if let Some(problem) = &entry.problem {
            ui.label(RichText::new(problem).color(theme.warning));
        }
        ui.add_space(space::SMALL);
        ui.horizontal(|ui| {
            if text_button(ui, &text!("shell-ok")).clicked() || is_entered {
                entry.confirm();
                field.request_focus();
                ui.ctx().request_repaint();
            }
            if text_button(ui, &text!("shell-cancel")).clicked() {
                entry.outcome = Poll::Ready(None);
                ui.ctx().request_repaint();
            }
        });
    });
    if modal.should_close() && entry.outcome.is_pending() {
        entry.outcome = Poll::Ready(None);
        ctx.request_repaint();
    }
}

#[cfg(test)]
mod tests {
    use std::{cell::RefCell, future::poll_fn, rc::Rc, thread};

    use egui::Role;
    use egui_kittest::{Harness, kittest::Queryable as _};

    use super::*;
    use crate::trace::entry::{self, KeyTarget};

    /// Makes a dialog that closes by itself after this time with nothing chosen.
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
        let request = FileRequest {
            title: "Open".into(),
            filters: Vec::new(),
            choice: FileChoice::File,
        };
        OpenDialog::of(request, Box::pin(answer), guard, &egui)
    }

    /// Polls the dialog again only long after it has closed.
    fn after_a_slow_frame(dialog: &mut OpenDialog) -> Poll<Option<Result<PathBuf, Notice>>> {
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
        let mut failed = closing_after(Duration::ZERO);
        assert!(after_a_slow_frame(&mut failed).is_pending());
        let lock = failed.guard.0.clone();
        assert!(lock.typed().is_some(), "a path can be typed");
        let typed = PathBuf::from("/captures/door.pcd");
        if let Some(entry) = lock.typed().as_mut() {
            entry.outcome = Poll::Ready(Some(typed.clone()));
        }
        let answer = failed.poll();
        assert!(matches!(answer, Poll::Ready(Some(Ok(path))) if path == typed));
        drop(failed);
        assert!(lock.typed().is_none() && !lock.is_open());
        // The next path starts there.
        assert_eq!(lock.folder(&FileChoice::File), Path::new("/captures"));
        let mut cancelled = closing_after(2 * TOO_QUICK);
        assert!(matches!(
            after_a_slow_frame(&mut cancelled),
            Poll::Ready(None)
        ));
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

    #[test]
    fn folders_are_entered_and_files_of_the_wanted_kinds_chosen() {
        let folder = tempfile::tempdir().expect("a folder");
        let inner = folder.path().join("captures");
        for (name, is_shown) in [
            ("door10.pcd", true),
            ("door9.PCD", true),
            ("note.md", false),
        ] {
            std::fs::create_dir_all(inner.join("deep")).expect("made");
            std::fs::write(inner.join(name), "x").expect("written");
            let mut opened = entry(FileChoice::File, &inner);
            opened.request.filters = vec![points()];
            opened.list();
            let is_listed = opened.entries.iter().any(|entry| entry.name == name);
            assert_eq!(is_listed, is_shown, "{name}");
        }
        let mut opened = entry(FileChoice::File, folder.path());
        opened.list();
        let names = |entry: &PathEntry| -> Vec<String> {
            entry
                .entries
                .iter()
                .map(|entry| entry.name.clone())
                .collect()
        };
        assert_eq!(names(&opened), ["captures"]);
        opened.enter(&inner);
        opened.list();
        assert_eq!(
            names(&opened),
            ["deep", "door9.PCD", "door10.pcd", "note.md"]
        );
        let mut written = entry(FileChoice::NewFile("view.png".into()), folder.path());
        written.enter(&inner);
        assert_eq!(Path::new(&written.text), inner.join("view.png"));
        let mut chosen = entry(FileChoice::Folder, folder.path());
        chosen.enter(&inner);
        chosen.list();
        assert_eq!(names(&chosen), ["deep"]);
        chosen.confirm();
        assert_eq!(chosen.outcome, Poll::Ready(Some(inner.join(""))));
    }

    #[test]
    fn letters_typed_while_the_systems_dialog_opens_are_meant_for_it() {
        let lock = DialogLock::default();
        assert!(!lock.takes_keys());
        let guard = lock.take().expect("free");
        assert!(lock.takes_keys());
        *lock.typed() = Some(entry(FileChoice::File, Path::new("/")));
        assert!(!lock.takes_keys(), "a path is typed");
        drop(guard);
        assert!(!lock.takes_keys());
    }

    fn entry(choice: FileChoice, folder: &Path) -> PathEntry {
        let request = FileRequest {
            title: "Open".into(),
            filters: Vec::new(),
            choice,
        };
        PathEntry::new(request, folder.to_owned())
    }

    fn confirmed(entry: &mut PathEntry, text: &Path) -> Poll<Option<PathBuf>> {
        entry.write(&text.display().to_string());
        entry.confirm();
        entry.outcome.clone()
    }

    #[test]
    fn what_does_not_exist_is_not_taken_and_said_under_the_field() {
        let folder = tempfile::tempdir().expect("a folder");
        let (file, missing) = (folder.path().join("door.pcd"), folder.path().join("x"));
        std::fs::write(&file, "x").expect("written");
        let mut opened = entry(FileChoice::File, folder.path());
        for (wrong, says) in [
            (missing.as_path(), "no such file"),
            (folder.path(), "a folder"),
            (Path::new(""), "Type a path"),
        ] {
            assert!(confirmed(&mut opened, wrong).is_pending());
            let problem = opened.problem.as_deref().unwrap_or_default();
            assert!(problem.contains(says), "{problem}");
        }
        // A suffix after the path may say how to read the file.
        let with_words = PathBuf::from(format!("{}#units=mm", file.display()));
        let mut in_millimetres = entry(FileChoice::File, folder.path());
        let taken = confirmed(&mut in_millimetres, &with_words);
        assert_eq!(taken, Poll::Ready(Some(with_words)));
        assert_eq!(confirmed(&mut opened, &file), Poll::Ready(Some(file)));
        let mut opened = entry(FileChoice::Folder, folder.path());
        assert!(confirmed(&mut opened, &missing).is_pending());
        let whole = Poll::Ready(Some(folder.path().to_owned()));
        assert_eq!(confirmed(&mut opened, folder.path()), whole);
    }

    #[test]
    fn a_path_is_typed_and_taken_with_enter() {
        let folder = tempfile::tempdir().expect("a folder");
        let lock = DialogLock::default();
        *lock.typed() = Some(entry(FileChoice::File, folder.path()));
        let shared = lock.clone();
        let mut has_fonts = false;
        let mut harness = Harness::builder().build_ui(move |ui| {
            // The fonts are available from the next frame on.
            if !std::mem::replace(&mut has_fonts, true) {
                Theme::install_fonts(ui.ctx());
                return;
            }
            super::ui(ui.ctx(), &shared);
        });
        harness.run_steps(4);
        let field = |harness: &Harness<'_>| {
            let field = harness.get_by_role_and_label(Role::TextInput, "Path");
            field.value().unwrap_or_default()
        };
        assert!(field(&harness).starts_with(&folder.path().display().to_string()));
        harness.key_press(Key::Enter);
        harness.run_steps(4);
        harness.get_by_label_contains("This is a folder");
        let path = folder.path().join("door.pcd");
        std::fs::write(&path, "x").expect("written");
        // The cursor is behind the existing text.
        let input = harness.get_by_role_and_label(Role::TextInput, "Path");
        input.type_text("door.pcd");
        harness.run_steps(4);
        assert_eq!(field(&harness), path.display().to_string());
        harness.key_press(Key::Enter);
        harness.run_steps(4);
        let outcome = lock.typed().as_ref().map(|entry| entry.outcome.clone());
        assert_eq!(outcome, Some(Poll::Ready(Some(path.clone()))));
        // The same from the list.
        *lock.typed() = Some(entry(FileChoice::File, folder.path()));
        harness.run_steps(4);
        harness.get_by_label("door.pcd").click();
        harness.run_steps(4);
        assert_eq!(field(&harness), path.display().to_string());
        harness.get_by_label("OK").click();
        harness.run_steps(4);
        let outcome = lock.typed().as_ref().map(|entry| entry.outcome.clone());
        assert_eq!(outcome, Some(Poll::Ready(Some(path))));
        // A longer path in the next dialog: the cursor is at its end, not where it was.
        let choice = FileChoice::NewFile("a-much-longer-name-of-a-path".into());
        *lock.typed() = Some(entry(choice, folder.path()));
        harness.run_steps(4);
        let input = harness.get_by_role_and_label(Role::TextInput, "Path");
        input.type_text(".csv");
        harness.run_steps(4);
        assert!(field(&harness).ends_with("a-much-longer-name-of-a-path.csv"));
    }

    #[test]
    fn what_is_typed_into_the_path_is_no_scan_if_it_comes_in_one_frame() {
        let folder = tempfile::tempdir().expect("a folder");
        let lock = DialogLock::default();
        let choice = FileChoice::NewFile("inspections.csv".into());
        *lock.typed() = Some(entry(choice, folder.path()));
        let (shared, codes) = (lock.clone(), Rc::new(RefCell::new(Vec::new())));
        let heard = Rc::clone(&codes);
        let mut has_fonts = false;
        let mut harness = Harness::builder().build_ui(move |ui| {
            if !std::mem::replace(&mut has_fonts, true) {
                Theme::install_fonts(ui.ctx());
                return;
            }
            let code = entry::listen(ui.ctx(), KeyTarget::Dialog);
            heard.borrow_mut().extend(code);
            super::ui(ui.ctx(), &shared);
        });
        harness.run_steps(4);
        for letter in ".1515".chars() {
            let text = egui::Event::Text(letter.into());
            harness.input_mut().events.push(text);
        }
        harness.key_press(Key::Enter);
        harness.run_steps(4);
        assert!(codes.borrow().is_empty(), "{codes:?}");
        let outcome = lock.typed().as_ref().map(|entry| entry.outcome.clone());
        let path = folder.path().join("inspections.csv.1515");
        assert_eq!(outcome, Some(Poll::Ready(Some(path))));
    }

    #[test]
    fn a_file_that_is_there_is_replaced_only_when_confirmed_twice() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("view.png");
        std::fs::write(&file, "mine").expect("written");
        let mut saved = entry(FileChoice::NewFile("view.png".into()), folder.path());
        let free = folder.path().join("view-2.png");
        assert_eq!(saved.text, free.display().to_string());
        assert!(confirmed(&mut saved, &file).is_pending());
        assert!(saved.problem.is_some());
        saved.confirm();
        assert_eq!(saved.outcome, Poll::Ready(Some(file)));
    }
}
