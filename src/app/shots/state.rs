//! What a person asked for about the shots of a scan, and what changes it.

use std::path::{Path, PathBuf};

use crate::app::{
    inspection::scan_choice::{ScanFiles, ScanOrder, ShotChoice},
    language::text,
    shell::{
        file_dialog::{FileChoice, FileRequest, all_files},
        notice::Notice,
        session::Source,
    },
};

/// What a workspace knows of its scan beside the result.
#[derive(Debug, Default)]
pub struct ShotsState {
    /// What the strip shows.
    pub strip: StripTab,
    /// The shot whose own surface is marked in the view, by its place.
    pub looked_at: Option<usize>,
    /// What the run is for that was started last.
    asked: Option<Asked>,
    /// Choices before the present one, the latest last.
    done: Vec<ShotChoice>,
    /// Choices that were taken back, the latest last.
    undone: Vec<ShotChoice>,
    /// What waits for a person to name the file of the poses.
    wants_poses: Option<ScanOrder>,
}

/// Another choice, until its result is there.
#[derive(Debug)]
pub struct Asked {
    choice: Option<ShotChoice>,
    way: Way,
}

/// Which way to a choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    /// For the first time.
    First,
    /// Taken back.
    Back,
    /// Done again.
    Again,
}

/// What the strip at the bottom shows while a scan is in front.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StripTab {
    /// The list of shots.
    #[default]
    Shots,
    /// What it shows without a scan: the stages, or the enrolled parts.
    Usual,
}

/// Something that happened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ShotsAction {
    /// Drop the shot at this place, or take it back.
    Toggle(usize),
    /// Mark what the shot at this place alone sees, or no longer.
    LookAt(usize),
    /// Show this in the strip.
    Strip(StripTab),
    /// Take the last change of the shots back.
    Undo,
    /// Do it again.
    Redo,
    /// Have a person choose a file.
    Ask(ShotsFile),
    /// A person chose it.
    Chosen(ShotsFile, PathBuf),
}

/// What a person is asked to choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShotsFile {
    /// A frame to add to the scan in front.
    Shot,
    /// The file of the poses that were not found.
    Poses,
}

impl ShotsFile {
    pub(in crate::app) fn request(self) -> FileRequest {
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

/// More steps than this are forgotten, the oldest first.
const MAX_STEPS: usize = 30;
/// With fewer shots nothing can be put together.
const LEAST_SHOTS: usize = 2;

impl Asked {
    /// Shots that no person has chosen from the list.
    pub fn first() -> Self {
        Self {
            choice: None,
            way: Way::First,
        }
    }
}

impl ShotsState {
    /// True if there is something to be taken back.
    pub fn can_undo(&self) -> bool {
        !self.done.is_empty()
    }

    /// True if there is something to be done again.
    pub fn can_redo(&self) -> bool {
        !self.undone.is_empty()
    }

    /// The choice that the run is for that was started last; it counts until that run ends.
    pub fn asked_choice(&self) -> Option<&ShotChoice> {
        self.asked.as_ref()?.choice.as_ref()
    }

    /// True if this is a file of poses, and one is waited for.
    pub fn wants(&self, file: &Path) -> bool {
        let ending = file.extension();
        self.wants_poses.is_some() && ending.is_some_and(|is| is.eq_ignore_ascii_case("json"))
    }

    /// Carries out an action while these shots are used; says what is to be put together for it.
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
            ShotsAction::Toggle(place) => {
                let Some(mut choice) = used.filter(|used| place < used.set.shots.len()) else {
                    return Ok(None);
                };
                if !choice.dropped.remove(&place) {
                    choice.dropped.insert(place);
                }
                if choice.num_taken() < LEAST_SHOTS {
                    return Err(Notice::look(
                        text!("shots-at-least", num = LEAST_SHOTS),
                        text!("shots-take-another"),
                    ));
                }
                Some(choose(choice, Way::First))
            }
            ShotsAction::LookAt(place) => {
                self.looked_at = (self.looked_at != Some(place)).then_some(place);
                None
            }
            ShotsAction::Strip(tab) => {
                self.strip = tab;
                None
            }
            ShotsAction::Undo => {
                let former = self.done.last().cloned();
                former.map(|choice| choose(choice, Way::Back))
            }
            ShotsAction::Redo => {
                let later = self.undone.last().cloned();
                later.map(|choice| choose(choice, Way::Again))
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

    /// Another run has been started, for this if it is about shots.
    pub fn started(&mut self, asked: Option<Asked>) {
        if asked.is_some() {
            self.wants_poses = None;
        }
        self.asked = asked;
    }

    /// The poses of these shots were not found: a person has to name their file.
    pub fn ask_for_poses(&mut self, order: ScanOrder) {
        self.wants_poses = Some(order);
    }

    /// A result has come, of these files if it is a scan, in the place of one with the choice `former`: what was asked
    /// for can be taken back.
    pub fn settle(&mut self, files: Option<&ScanFiles>, former: Option<ShotChoice>) {
        self.looked_at = None;
        self.wants_poses = None;
        let is_same = |former: &ShotChoice| {
            files.is_some_and(|files| files.frames == former.set.files.frames)
        };
        match (self.asked.take(), former.filter(is_same)) {
            (Some(asked), Some(former)) => match asked.way {
                Way::First => {
                    self.undone.clear();
                    self.done.push(former);
                    if self.done.len() > MAX_STEPS {
                        self.done.remove(0);
                    }
                }
                Way::Back => {
                    self.done.pop();
                    self.undone.push(former);
                }
                Way::Again => {
                    self.undone.pop();
                    self.done.push(former);
                }
            },
            // The same again, by another recipe or library.
            (None, Some(_)) => {}
            _ => {
                self.done.clear();
                self.undone.clear();
            }
        }
    }
}

/// The source that opens the same shots at the next start, if that is another than now.
pub(in crate::app) fn source_of(files: &ScanFiles, now: &Source) -> Option<Source> {
    match now {
        Source::Scan(now) if now.frames == files.frames && now != files => {
            Some(Source::Scan(files.clone()))
        }
        _ => None,
    }
}
