//! The draft file: if the program is killed, only seconds of work on the draft are lost.
//!
//! The file keeps what a person did: the form, the corrections and the origin of the scene, but not the scene itself. A
//! frame of the simulated cell, a file or a scan can be obtained again; of a camera frame, only what a person wrote into the
//! form comes back, because the next frame may show another part.

use std::{
    path::{Path, PathBuf},
    sync::{Arc, Mutex},
};

use serde::{Deserialize, Serialize};

use super::{
    draft::{Draft, Form},
    selection::{Corrections, Selection},
    state::EnrolState,
    subject::InitialSelection,
};
use files::{self, FileError, advice_on, disk, folder_of, write_text};
use geometry::error::{Advice as _, lock};
use inspection::library::MAX_TITLE;
use shell::{inspection::source::Origin, settings::set_aside};
use ui::{
    language::text,
    task::{Task, TaskRunner},
    user_error::UserError,
};

/// Version of the file format.
const SCHEMA: u32 = 1;
/// Size limit of the file, bytes; a lasso takes a few kilobytes.
const MAX_BYTES: u64 = 4 << 20;
/// Limit of corrections; each is applied to all points.
const MAX_EDITS: usize = 1000;
/// Seconds without a change before the draft is written.
const SAVE_DELAY_S: f64 = 3.0;

/// A draft as stored in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct KeptDraft {
    pub(super) schema: u32,
    /// Where the scene came from.
    pub(super) origin: Origin,
    /// The selection that the scene started from.
    pub(super) usual: InitialSelection,
    pub(super) corrections: Corrections,
    /// The form of the part.
    pub(super) form: Form,
    /// Checksum of the selection; `None` if it was not known yet.
    pub(super) checksum: Option<u32>,
}

impl KeptDraft {
    pub(super) fn of(draft: &Draft) -> Self {
        Self {
            schema: SCHEMA,
            origin: draft.subject.origin.clone(),
            usual: draft.subject.usual,
            corrections: draft.corrections.clone(),
            form: draft.form.clone(),
            checksum: None,
        }
    }

    fn is_of(&self, draft: &Draft) -> bool {
        self.origin == draft.subject.origin
            && self.corrections == draft.corrections
            && self.form == draft.form
    }
}

/// Writes the draft on a thread of its own, a few seconds after the last change, and removes the file of a draft that
/// was saved or discarded.
pub(super) struct DraftFile {
    path: Option<PathBuf>,
    has_looked: bool,
    writing: Task<()>,
    /// Prevents an older write from finishing after a newer one.
    turn: Arc<Mutex<()>>,
    /// The draft as seen last.
    seen: Option<KeptDraft>,
    /// The file may be out of date, so it is written once more at the end.
    has_changed: bool,
    /// When to write, seconds on egui's clock; `None` once handed over.
    due: Option<f64>,
}

impl DraftFile {
    /// Without a path, no draft is kept.
    pub(super) fn new(path: Option<PathBuf>, runner: &TaskRunner) -> Self {
        Self {
            path,
            has_looked: false,
            writing: Task::new("draft", runner),
            turn: Arc::default(),
            seen: None,
            has_changed: false,
            due: None,
        }
    }

    /// On the first call, loads the draft of an earlier start. A file that cannot be used is set aside.
    pub(super) fn load(&mut self) -> Option<Result<KeptDraft, UserError>> {
        let path = self.path.as_ref()?;
        if std::mem::replace(&mut self.has_looked, true) {
            return None;
        }
        let loaded = load(path)?;
        self.seen = loaded.as_ref().ok().cloned();
        Some(loaded)
    }

    /// Schedules writing of changes and returns the error of a failed write. Costs one comparison per frame without a
    /// change.
    pub(super) fn keep(&mut self, enrol: &EnrolState, ctx: &egui::Context) -> Option<UserError> {
        self.path.as_ref()?;
        let now = ctx.input(|input| input.time);
        if self.see(enrol) {
            self.has_changed = true;
            // A saved or discarded draft must not come back: remove its file at once.
            let delay = if self.seen.is_some() {
                SAVE_DELAY_S
            } else {
                0.0
            };
            self.due = Some(now + delay);
        }
        match self.due {
            Some(due) if now < due => ctx.request_repaint_after_secs((due - now) as f32),
            // Wait: while the draft is examined, its selection is still the previous one. Another draft may take long.
            Some(_) if self.seen.is_some() && enrol.is_examining() => {}
            Some(_) => {
                self.due = None;
                let path = self.path.clone()?;
                let (draft, selection) = (self.seen.clone(), examined(enrol));
                let turn = Arc::clone(&self.turn);
                self.writing
                    .start(text!("enrol-writing-draft"), move |context| {
                        let _turn = lock(&turn);
                        context.check()?;
                        Ok(save(&path, draft, selection.as_deref())?)
                    });
            }
            None => {}
        }
        self.writing.poll()?.err()
    }

    /// Updates `seen`; returns true if the draft has changed. While a kept draft is being brought back, the file has
    /// it.
    fn see(&mut self, enrol: &EnrolState) -> bool {
        if enrol.coming.is_some() {
            return false;
        }
        let draft = enrol.worked_on();
        let is_same = match (&self.seen, draft) {
            (Some(seen), Some(draft)) => seen.is_of(draft),
            (seen, draft) => seen.is_none() && draft.is_none(),
        };
        if !is_same {
            self.seen = draft.map(KeptDraft::of);
        }
        !is_same
    }

    /// Writes a change that is still pending or could not be written.
    pub(super) fn finish(&mut self, enrol: &EnrolState) {
        self.has_changed |= self.see(enrol);
        if let Some(path) = &self.path
            && self.has_changed
        {
            self.writing.cancel();
            let _turn = lock(&self.turn);
            // The window is closing, so an error could not be shown.
            let _ = save(path, self.seen.clone(), examined(enrol).as_deref());
        }
    }

    /// True while nothing is being written.
    pub(super) fn is_idle(&self) -> bool {
        self.writing.running().is_none()
    }
}

/// The selection of the draft, once it matches the corrections.
fn examined(enrol: &EnrolState) -> Option<Arc<Selection>> {
    let draft = enrol.draft.as_ref()?;
    draft
        .checked
        .is_some()
        .then(|| Arc::clone(&draft.selection))
}

/// Reads the file, if present; sets a bad one aside.
fn load(path: &Path) -> Option<Result<KeptDraft, UserError>> {
    if !path.exists() {
        return None;
    }
    Some(read(path).map_err(|bad| UserError {
        what: text!("enrol-draft-not-used", why = bad.to_string()),
        advice: match set_aside(path) {
            Ok(aside) => text!("enrol-draft-set-aside", path = aside.display().to_string()),
            Err(error) => text!("shell-settings-move-away", why = files::words_of(&error)),
        },
    }))
}

fn read(path: &Path) -> Result<KeptDraft, FileError> {
    let text = files::read_text(path, MAX_BYTES)?;
    let damaged = |what: String| FileError::Damaged {
        path: path.to_owned(),
        what,
    };
    let garbled = |error: serde_json::Error| damaged(error.to_string());
    let draft: KeptDraft = files::parse_json(path, text.as_bytes(), SCHEMA, garbled)?;
    if draft.corrections.edits.len() > MAX_EDITS {
        let what = format!("more than {MAX_EDITS} corrections");
        return Err(damaged(what));
    }
    if draft.form.title.chars().count() > MAX_TITLE {
        let what = format!("a title of more than {MAX_TITLE} characters");
        return Err(damaged(what));
    }
    Ok(draft)
}

/// Writes the file atomically; without a draft, removes it.
fn save(
    path: &Path,
    draft: Option<KeptDraft>,
    selection: Option<&Selection>,
) -> Result<(), UserError> {
    let not_kept = |why: String, advice: &str| UserError {
        what: text!("enrol-draft-not-kept", why = why),
        advice: advice.to_owned(),
    };
    let failed = |place: &Path, error: &std::io::Error| {
        let words = files::words_of(error);
        not_kept(format!("{}: {words}", place.display()), advice_on(error))
    };
    let Some(draft) = draft else {
        return match disk::remove_file(path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(failed(path, &error)),
            Ok(()) | Err(_) => Ok(()),
        };
    };
    let draft = KeptDraft {
        checksum: selection.map(Selection::checksum),
        ..draft
    };
    let too_large = text!("enrol-draft-too-large-advice");
    let text =
        serde_json::to_string(&draft).map_err(|error| not_kept(error.to_string(), &too_large))?;
    if text.len() as u64 > MAX_BYTES || draft.corrections.edits.len() > MAX_EDITS {
        let why = format!("over {MAX_BYTES} bytes or {MAX_EDITS} corrections");
        return Err(not_kept(why, &too_large));
    }
    let folder = folder_of(path);
    disk::create_dir_all(folder).map_err(|error| failed(folder, &error))?;
    write_text(path, &text).map_err(|error| not_kept(error.to_string(), &error.advice()))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use glam::{Mat4, Vec2};

    use super::*;
    use crate::workspaces::enrol::{
        draft::Field,
        outline::{DrawnOutline, DrawnOver},
        segments::PointAction,
        selection::{Edit, OutlineMode},
        state::EnrolAction,
    };
    use shell::{
        inspection::source::{CellChoice, SceneOrScan, SceneSource},
        workspace::TestShell,
    };

    fn outline(over: DrawnOver) -> DrawnOutline {
        let corners = [[0.1, 0.2], [0.7, 0.2], [0.4, 1.0 / 3.0]];
        DrawnOutline {
            corners: corners.map(Vec2::from).into(),
            over,
        }
    }

    fn draft(title: &str) -> KeptDraft {
        let view = DrawnOver::View {
            clip_from_world: Mat4::from_rotation_x(0.3),
        };
        KeptDraft {
            schema: SCHEMA,
            origin: Origin::Simulated {
                choice: CellChoice::InTurn,
                number: 7,
            },
            usual: InitialSelection::Segmented,
            corrections: Corrections {
                taking: InitialSelection::Whole,
                edits: vec![
                    Edit::Segment(2, PointAction::Dropped),
                    Edit::Outline(OutlineMode::Keep, outline(DrawnOver::Picture)),
                    Edit::Outline(OutlineMode::Add, outline(view)),
                ],
            },
            form: Form {
                title: title.into(),
                name: "plate".into(),
                notes: "two\nlines".into(),
                reference_of: Some("door".parse().expect("a name")),
                ..Form::default()
            },
            checksum: None,
        }
    }

    #[test]
    fn what_is_kept_comes_back_and_goes_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("new").join("draft.json");
        assert_eq!(load(&path), None);
        save(&path, Some(draft("Plate")), None).expect("written");
        assert_eq!(load(&path), Some(Ok(draft("Plate"))));
        for _ in 0..2 {
            save(&path, None, None).expect("removed");
            assert_eq!(load(&path), None);
        }
    }

    #[test]
    fn a_title_is_written_while_another_draft_is_being_taken() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("draft.json");
        let runner = TaskRunner::without_threads();
        let (mut enrol, mut shell) = (EnrolState::new(&runner), TestShell::default());
        let scene = |number| {
            let choice = CellChoice::InTurn;
            SceneOrScan::Scene(SceneSource::Cell { choice, number })
        };
        enrol.take(scene(1), "Taking".into(), &shell.context());
        while enrol.draft_task.run_waiting() {
            enrol.update(&mut shell.context());
        }
        let title = EnrolAction::Write(Field::Title("Plate".into()));
        enrol.apply(title, &mut shell.context());
        enrol.take(scene(2), "Taking".into(), &shell.context());
        let mut file = DraftFile::new(Some(path.clone()), &runner);
        let context = egui::Context::default();
        for time in [0.0, 2.0 * SAVE_DELAY_S] {
            let input = egui::RawInput {
                time: Some(time),
                ..egui::RawInput::default()
            };
            context.run_ui(input, |_| {}).drop_without_applying_deltas();
            assert_eq!(file.keep(&enrol, &context), None);
        }
        assert!(enrol.is_taking_another() && file.writing.run_waiting());
        let kept = load(&path).expect("written").expect("whole");
        assert_eq!(kept.form.title, "Plate");
        assert!(kept.checksum.is_some());
    }

    #[test]
    fn a_bad_file_is_set_aside_and_never_lost() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("draft.json");
        let good = serde_json::to_string(&draft("Plate")).expect("JSON");
        let many = vec![r#"{"segment":[0,"kept"]}"#; MAX_EDITS + 1].join(",");
        let bad: [Vec<u8>; 9] = [
            Vec::new(),
            b"{".to_vec(),
            b"{\"schema\":99}".to_vec(),
            b"\xff\xfe\x00".to_vec(),
            good.replace("0.1,", "1e999,").into(),
            // Infinite as `f32`.
            good.replace("0.1,", "1e39,").into(),
            good.replace("Plate", &"x".repeat(MAX_TITLE + 1)).into(),
            good.replace(r#""edits":["#, &format!(r#""edits":[{many},"#))
                .into(),
            vec![b' '; MAX_BYTES as usize + 1],
        ];
        for (number, contents) in (1..).zip(bad) {
            fs::write(&path, &contents).expect("written");
            let error = load(&path).expect("there").expect_err("bad");
            let aside = folder.path().join(format!("draft.broken-{number}.json"));
            let named = aside.display().to_string();
            assert!(error.advice.contains(&named), "{number}: {error:?}");
            assert_eq!(fs::read(&aside).expect("kept"), contents);
            assert!(!path.exists());
        }
        fs::write(&path, &good).expect("written");
        assert_eq!(load(&path), Some(Ok(draft("Plate"))));
    }

    #[test]
    fn a_draft_that_would_not_be_read_again_is_not_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("draft.json");
        save(&path, Some(draft("Plate")), None).expect("written");
        let mut large = draft("Large");
        large.form.notes = "x".repeat(MAX_BYTES as usize);
        let mut long = draft("Long");
        long.corrections.edits = vec![Edit::Segment(0, PointAction::Kept); MAX_EDITS + 1];
        for draft in [large, long] {
            let error = save(&path, Some(draft), None).expect_err("too much");
            assert!(error.advice.contains("Save the part"), "{error:?}");
        }
        assert_eq!(load(&path), Some(Ok(draft("Plate"))));
    }

    #[cfg(unix)]
    #[test]
    fn whichever_call_fails_the_draft_is_the_old_one_or_the_new() {
        let place = |folder: &Path| folder.join("deep").join("draft.json");
        files::disk::faults::Writer {
            test: "workspaces::enrol::kept::tests::whichever_call_fails_the_draft_is_the_old_one_or_the_new",
            prepare: &|folder| save(&place(folder), Some(draft("Old")), None).expect("written"),
            write: &|folder| {
                let saved = save(&place(folder), Some(draft("New")), None);
                saved.map_err(|error| format!("{}; {}", error.what, error.advice))
            },
            state: &|folder| {
                let loaded = load(&place(folder)).expect("there");
                loaded.expect("whole").form.title
            },
            between: &[],
        }
        .fails_at_every_call();
    }
}
