//! What a person does in the workspace.

use std::path::PathBuf;

use files::SCENE_ENDINGS;
use shell::{
    cell::ServoSettings,
    file_dialog::{FileChoice, FileRequest, all_files},
};
use ui::language::text;

/// An action in the workspace.
#[derive(Clone, Debug)]
pub enum ServoAction {
    /// Use these settings.
    SetUp(ServoSettings),
    /// Ask for a file.
    Ask(ServoFile),
    /// Add a frame of the target.
    SeeAs(PathBuf),
    /// Go where arm, nozzle and least distance are set.
    GoToRobot,
    /// Servo the robot.
    Start,
    /// Stop the robot.
    Stop,
    /// Allow the step that waits.
    Next,
}

/// A file that a person is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ServoFile {
    /// A frame of the part, taken where the camera should stand.
    SeenAs,
}

impl ServoFile {
    pub(super) fn request(self) -> FileRequest {
        match self {
            Self::SeenAs => FileRequest {
                title: text!("servoing-frame-title"),
                filters: vec![(text!("shell-captured-scenes"), SCENE_ENDINGS), all_files()],
                choice: FileChoice::File,
            },
        }
    }
}
