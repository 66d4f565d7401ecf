//! State of the choice of shots in a workspace, and its actions.

use std::path::{Path, PathBuf};

use shell::{
    file_dialog::{FileChoice, FileRequest, all_files},
    inspection::source::{ScanFiles, ScanOrder, ShotChoice},
    notice::Notice,
    session::Source,
};
use ui::{
    language::text,
    undo_stack::{UndoDirection, UndoStack},
};

/// State that a workspace keeps for its scan, besides the result.
#[derive(Debug, Default)]
pub struct ShotsState {
    /// Content of the strip.
    pub strip: StripTab,
    /// Index of the shot whose own surface is marked in the view.
    pub looked_at: Option<usize>,
    /// What the last started run was asked for.
    asked: Option<Asked>,
    /// Former choices.
    steps: UndoStack<ShotChoice, 30>,
    /// The request that waits for the user to choose the file of the poses.
    wants_poses: Option<ScanOrder>,
}

/// A choice whose result is pending.
#[derive(Debug)]
pub struct Asked {
    choice: Option<ShotChoice>,
    /// `None` if the choice is a new one.
    way: Option<UndoDirection>,
}

/// Content of the strip at the bottom while a scan is in front.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StripTab {
    /// The list of shots.
    #[default]
    Shots,
    /// The content without a scan: the stages, or the enrolled parts.
    Usual,
}

/// Actions on the shots.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ShotsAction {
    /// Drop the shot at this index, or restore it.
    Toggle(usize),
    /// Mark what only the shot at this index sees, or remove the mark.
    LookAt(usize),
    /// Show this in the strip.
    Strip(StripTab),
    /// Undo the last change of the shots.
    Undo,
    /// Redo it.
    Redo,
    /// Ask the user to choose a file.
    Ask(ShotsFile),
    /// The user chose this file.
    Chosen(ShotsFile, PathBuf),
}

/// A file that the user is asked to choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShotsFile {
    /// A frame to add to the scan in front.
    Shot,
    /// The file of the poses that were not found.
    Poses,
}

impl ShotsFile {
    pub(crate) fn request(self) -> FileRequest {
        match self {
            Self::Shot => FileRequest {
                title: text!("shots-add-a-frame"),
                filters: vec![
                    (text!("shell-captured-scenes"), &["png", "pcd", "ply"]),
                    all_files(),
                ],
                choice: FileChoice::File,
            },
            Self::Poses => FileRequest {
                title: text!("shots-poses-file"),
                filters: vec![(text!("shots-poses"), &["json"]), all_files()],
                choice: FileChoice::File,
            },
        }
    }
}

/// Minimum number of shots that can be put together.
const LEAST_SHOTS: usize = 2;

impl Asked {
    /// A request for shots that were not chosen from the list.
    pub fn first() -> Self {
        Self {
            choice: None,
            way: None,
        }
    }
}

impl ShotsState {
    /// True if a change can be undone.
    pub fn can_undo(&self) -> bool {
        !self.steps.done.is_empty()
    }

    /// True if a change can be redone.
    pub fn can_redo(&self) -> bool {
        !self.steps.undone.is_empty()
    }

    /// The choice that the last started run was asked for, until that run ends.
    pub fn asked_choice(&self) -> Option<&ShotChoice> {
        self.asked.as_ref()?.choice.as_ref()
    }

    /// True if a file of poses is awaited and this may be one.
    pub fn wants(&self, file: &Path) -> bool {
        let ending = file.extension();
        self.wants_poses.is_some() && ending.is_some_and(|is| is.eq_ignore_ascii_case("json"))
    }

    /// Carries out an action; `used` are the shots in use. Returns what is to be put together for it.
    pub fn apply(
        &mut self,
        action: ShotsAction,
        used: Option<ShotChoice>,
    ) -> Result<Option<(ScanOrder, Asked)>, Notice> {
        let choose = |choice: ShotChoice, way| {
            let asked = Asked {
                choice: Some(choice.clone()),
                way,
            };
            (ScanOrder::Known(choice), asked)
        };
        Ok(match action {
            ShotsAction::Toggle(index) => {
                let Some(mut choice) = used.filter(|used| index < used.set.shots.len()) else {
                    return Ok(None);
                };
                if !choice.dropped.remove(&index) {
                    choice.dropped.insert(index);
                }
                if choice.num_taken() < LEAST_SHOTS {
                    return Err(Notice::look(
                        text!("shots-at-least", num = LEAST_SHOTS),
                        text!("shots-take-another"),
                    ));
                }
                Some(choose(choice, None))
            }
            ShotsAction::LookAt(index) => {
                self.looked_at = (self.looked_at != Some(index)).then_some(index);
                None
            }
            ShotsAction::Strip(tab) => {
                self.strip = tab;
                None
            }
            ShotsAction::Undo => {
                let former = self.steps.done.last().cloned();
                former.map(|choice| choose(choice, Some(UndoDirection::Undo)))
            }
            ShotsAction::Redo => {
                let later = self.steps.undone.last().cloned();
                later.map(|choice| choose(choice, Some(UndoDirection::Redo)))
            }
            // The owner of the dialog opens it.
            ShotsAction::Ask(_) => None,
            ShotsAction::Chosen(ShotsFile::Shot, frame) => {
                used.map(|choice| (ScanOrder::Add(choice, frame, None), Asked::first()))
            }
            ShotsAction::Chosen(ShotsFile::Poses, file) => {
                let order = self.wants_poses.take();
                order.map(|order| (order.with_poses(file), Asked::first()))
            }
        })
    }

    /// Notes that another run was started; `asked` if it is about shots.
    pub fn started(&mut self, asked: Option<Asked>) {
        if asked.is_some() {
            self.wants_poses = None;
        }
        self.asked = asked;
    }

    /// Notes that the poses of these shots were not found and the user has to choose their file.
    pub fn ask_for_poses(&mut self, order: ScanOrder) {
        self.wants_poses = Some(order);
    }

    /// Handles a result, of these files if it is a scan, which replaces one with the choice `former`. A requested change can
    /// then be undone.
    pub fn settle(&mut self, files: Option<&ScanFiles>, former: Option<ShotChoice>) {
        self.looked_at = None;
        self.wants_poses = None;
        let is_same = |former: &ShotChoice| {
            files.is_some_and(|files| files.frames == former.set.files.frames)
        };
        match (self.asked.take(), former.filter(is_same)) {
            (Some(asked), Some(former)) => {
                if let Some(way) = asked.way {
                    self.steps.from(way).pop();
                }
                self.steps.add_inverse(asked.way, former);
            }
            // The same shots again, with another recipe or library.
            (None, Some(_)) => {}
            _ => self.steps = UndoStack::default(),
        }
    }
}

/// Returns the source that opens the same shots at the next start, if it differs from the current one.
pub(crate) fn source_of(files: &ScanFiles, now: &Source) -> Option<Source> {
    match now {
        Source::Scan(now) if now.frames == files.frames && now != files => {
            Some(Source::Scan(files.clone()))
        }
        _ => None,
    }
}
