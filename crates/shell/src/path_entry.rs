//! A typed path, in place of the system's file dialog where the desktop has none.

use std::{
    path::{self, Path, PathBuf},
    task::Poll,
};

use egui::{Context, Key, RichText, TextEdit, text_edit::TextEditState};

use super::file_dialog::{DialogLock, FileChoice, FileRequest};
use files::file_of;
use ui::{
    language::text,
    theme::{Theme, space},
    widgets::{self, text_button},
};

/// Width of the dialog, logical pixels.
const WIDTH: f32 = 560.0;

/// A path being typed.
#[derive(Debug)]
pub(super) struct PathEntry {
    request: FileRequest,
    /// The folder in which typing started.
    folder: PathBuf,
    text: String,
    problem: Option<String>,
    /// The existing file that would be replaced, once the user was warned.
    replaced: Option<PathBuf>,
    /// The confirmed path; `None` inside if cancelled.
    pub(super) outcome: Poll<Option<PathBuf>>,
    is_new: bool,
}

impl PathEntry {
    /// Starts in this folder.
    pub(super) fn new(request: FileRequest, folder: PathBuf) -> Self {
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

    /// Accepts the text as a path, or shows what is wrong with it.
    fn confirm(&mut self) {
        let typed = Path::new(self.text.trim());
        let typed = match (typed.strip_prefix("~"), directories::UserDirs::new()) {
            (Ok(rest), Some(user)) => user.home_dir().join(rest),
            _ => typed.to_owned(),
        };
        self.problem = match path::absolute(&typed) {
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
pub fn ui(ctx: &Context, lock: &DialogLock) {
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
    use std::{cell::RefCell, rc::Rc};

    use egui::Role;
    use egui_kittest::{Harness, kittest::Queryable as _};

    use super::*;
    use crate::trace::entry::{self, KeyTarget};

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
