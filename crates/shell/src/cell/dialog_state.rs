//! The contents of the dialog of the robot's cell, and its actions.

use std::{path::PathBuf, sync::Arc};

use super::{setup::AnswerSetup, work::SolvedPairs};
use crate::{
    file_dialog::{FileChoice, FileRequest, all_files},
    session::Session,
};
use robot::{
    Convention, WrittenPose, WrittenPoseError, cell_check::CellLimits, hand_eye::Mount,
    parse_written_pose,
};
use serve::{PoseKind, Protocol, parse_address};
use ui::{language::text, user_error::UserError};

/// A page of the dialog.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RobotPage {
    /// The calibration in use.
    InUse,
    /// A calibration typed as numbers.
    ByHand,
    /// Hand-eye calibration.
    FromPairs,
    /// The check of whether camera and cell still stand where they stood.
    Check,
    /// The server that answers robots.
    Answer,
}

impl RobotPage {
    /// All pages, in their order.
    pub const ALL: [Self; 5] = [
        Self::InUse,
        Self::ByHand,
        Self::FromPairs,
        Self::Check,
        Self::Answer,
    ];

    /// Returns the name shown to the user.
    pub fn title(self) -> String {
        match self {
            Self::InUse => text!("robot-in-use"),
            Self::ByHand => text!("robot-by-hand"),
            Self::FromPairs => text!("robot-from-pairs"),
            Self::Check => text!("robot-check"),
            Self::Answer => text!("robot-answer"),
        }
    }
}

/// A question of the dialog to which a second press of the same button says yes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RobotQuestion {
    /// Whether edited numbers are right.
    ConfirmEdited,
    /// Whether to replace the baseline.
    ReplaceBaseline,
    /// Whether robots shall get other numbers from now on.
    ChangeAnswers,
}

/// The contents of the dialog.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotDialog {
    /// The page in front.
    pub page: RobotPage,
    /// Name of a new calibration.
    pub name: String,
    /// What the camera of a new calibration is fixed to.
    pub mount: Mount,
    /// Convention of typed numbers.
    pub convention: Convention,
    /// The camera's pose, as typed.
    pub numbers: String,
    /// The arm's pose at a capture, as typed.
    pub arm: String,
    /// The file of pairs.
    pub pairs: Option<PathBuf>,
    /// Names of the pairs that do not count.
    pub left_out: Vec<String>,
    /// The hand-eye calibration from the pairs.
    pub solved: Option<Arc<SolvedPairs>>,
    /// True if the user wants the result used despite grave doubts.
    pub insists: bool,
    /// Limits for the next baseline of the cell.
    pub limits: CellLimits,
    /// The question that waits for an answer.
    pub question: Option<RobotQuestion>,
    /// Protocol of the server.
    pub protocol: Protocol,
    /// Port, or address and port, of the server, as typed.
    pub address: String,
    /// Which pose the robots get.
    pub pose: PoseKind,
    /// The convention that robots are answered in.
    pub answered_in: Convention,
    /// The last error.
    pub problem: Option<UserError>,
}

impl RobotDialog {
    pub(super) fn new(session: &Session) -> Self {
        let AnswerSetup {
            at,
            pose,
            convention,
            ..
        } = session.answering;
        // Show only the port if the address is the default one on this computer.
        let port = at.address.port().to_string();
        let address = match parse_address(&port) {
            Ok(own) if own == at.address => port,
            _ => at.address.to_string(),
        };
        Self {
            page: RobotPage::InUse,
            name: String::new(),
            mount: Mount::EyeToHand,
            convention: session.convention,
            numbers: String::new(),
            arm: String::new(),
            pairs: None,
            left_out: Vec::new(),
            solved: None,
            insists: false,
            limits: CellLimits::default(),
            question: None,
            protocol: at.protocol,
            address,
            pose,
            answered_in: convention,
            problem: None,
        }
    }

    /// Takes over what was typed for a new calibration.
    pub(super) fn take_draft(&mut self, former: Self) {
        self.name = former.name;
        self.mount = former.mount;
        self.convention = former.convention;
        self.numbers = former.numbers;
    }

    /// Parses the camera's pose.
    pub fn typed(&self) -> Result<WrittenPose, WrittenPoseError> {
        self.read(&self.numbers)
    }

    /// Parses the arm's pose.
    pub fn typed_arm(&self) -> Result<WrittenPose, WrittenPoseError> {
        self.read(&self.arm)
    }

    /// Parses numbers in the dialog's convention, unless they begin with the name of another one.
    fn read(&self, numbers: &str) -> Result<WrittenPose, WrittenPoseError> {
        let is_named = numbers.trim_start().starts_with(char::is_alphabetic);
        if is_named {
            parse_written_pose(numbers)
        } else {
            parse_written_pose(&format!("{}: {numbers}", self.convention.name()))
        }
    }

    /// The calculated calibration, if it may be used.
    pub fn usable(&self) -> Option<Arc<SolvedPairs>> {
        let may_be = |found: &&Arc<SolvedPairs>| found.solved.is_usable() || self.insists;
        self.solved.as_ref().filter(may_be).cloned()
    }
}

/// Actions on the robot's cell.
#[derive(Clone, Debug)]
pub enum RobotAction {
    /// Open or close the dialog.
    Toggle,
    /// Close the dialog.
    Close,
    /// Replace the contents of the dialog by edited ones.
    Edit(Box<RobotDialog>),
    /// Use the typed calibration.
    UseTyped,
    /// Use the calculated calibration.
    UseSolved,
    /// Store the typed pose of the arm as its pose at every capture.
    StoreArm,
    /// Ask the user to choose a file.
    Ask(RobotFile),
    /// Use the calibration in this file.
    Load(PathBuf),
    /// Calculate from this file of pairs.
    Pairs(PathBuf),
    /// Confirm the edited numbers of the calibration in use, after a question.
    Confirm,
    /// Use no calibration.
    Forget,
    /// An action of the check of the cell.
    Check(CheckAction),
    /// Set whether and where robots are answered.
    Answer(AnswerSetup),
}

/// A file that the user is asked to choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RobotFile {
    /// A calibration of the robot's cell.
    Calibration,
    /// A file of robot and camera poses.
    Pairs,
    /// The table that the checks of the cell are exported to.
    Checks,
}

impl RobotFile {
    pub(super) fn request(self) -> FileRequest {
        match self {
            Self::Calibration => FileRequest {
                title: text!("robot-load-title"),
                filters: vec![(text!("robot-calibrations"), &["toml"]), all_files()],
                choice: FileChoice::File,
            },
            Self::Pairs => FileRequest {
                title: text!("robot-pairs-title"),
                filters: vec![
                    (text!("robot-tables"), &["csv", "txt", "json"]),
                    all_files(),
                ],
                choice: FileChoice::File,
            },
            Self::Checks => FileRequest {
                title: text!("robot-export-checks-title"),
                filters: vec![(text!("shell-csv-files"), &["csv"])],
                choice: FileChoice::NewFile("cell-checks.csv".into()),
            },
        }
    }
}

/// Actions of the check of the cell.
#[derive(Clone, Debug)]
pub enum CheckAction {
    /// Take a baseline. If there is one already, the first time asks for confirmation and the second time takes it.
    TakeBaseline,
    /// Compare the current frames with the baseline.
    Check,
    /// Cancel the running work.
    Cancel,
    /// Write the checks to this table.
    Export(PathBuf),
}
