//! The contents of the dialog of the robot's cell, its actions, and what its task does: it reads and writes calibrations, and
//! calculates them from pairs.

use std::{path::PathBuf, sync::Arc};

use crate::{
    cell::setup::AnswerSetup,
    file_dialog::{FileChoice, FileRequest, all_files},
    session::Session,
};
use robot::{
    Convention, RobotFrame, WrittenPose, WrittenPoseError,
    calibration::{CellCalibration, ReadCalibration},
    cell_check::CellLimits,
    hand_eye::{HandEye, Mount, Target, solve},
    pairs::{PairConventions, read_pairs},
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
    /// Open the dialog at this page.
    Show(RobotPage),
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

/// Result of the task.
#[derive(Clone, Debug)]
pub enum RobotResult {
    /// This calibration is now in use; the second is where the former one was kept, if there was one.
    InUse(Arc<CellInUse>, Option<PathBuf>),
    /// The hand-eye calibration from the pairs.
    Solved(Arc<SolvedPairs>),
}

/// A calibration in use.
#[derive(Clone, Debug, PartialEq)]
pub struct CellInUse {
    /// Its file.
    pub path: PathBuf,
    /// The calibration.
    pub calibration: CellCalibration,
    /// True if the file was edited and not confirmed.
    pub is_edited: bool,
}

impl CellInUse {
    /// The robot's frame; `None` if the file was edited and not confirmed, or if the camera is on the flange and the arm's
    /// pose is unknown.
    pub fn frame(&self) -> Option<Arc<RobotFrame>> {
        if self.is_edited {
            return None;
        }
        self.calibration.frame(None).ok().map(Arc::new)
    }
}

/// A hand-eye calibration that the user can choose to use.
#[derive(Clone, Debug, PartialEq)]
pub struct SolvedPairs {
    /// The file of pairs.
    pub path: PathBuf,
    /// Names of all pairs, in file order.
    pub names: Vec<String>,
    /// Names of the pairs left out.
    pub left_out: Vec<String>,
    /// Conventions in which robot and camera poses were read.
    pub conventions: [Convention; 2],
    /// The calculated calibration.
    pub solved: HandEye,
}

/// Saves a calibration to be used, keeping the former file.
pub(super) fn save_calibration(
    path: PathBuf,
    calibration: &CellCalibration,
) -> Result<RobotResult, UserError> {
    let former = calibration.save_keeping_former(&path);
    let former = former.map_err(|error| UserError::of(&error))?;
    load_calibration(path, former)
}

/// Confirms the edited numbers of a calibration to be used, keeping the former file.
pub(super) fn confirm_calibration(path: PathBuf) -> Result<RobotResult, UserError> {
    let former = CellCalibration::confirm(&path);
    let former = former.map_err(|error| UserError::of(&error))?;
    load_calibration(path, former)
}

/// Calculates the camera's pose from a file of pairs, leaving out the pairs of the given names.
pub(super) fn solve_pairs(
    path: PathBuf,
    mount: Mount,
    left_out: Vec<String>,
) -> Result<RobotResult, UserError> {
    let read = read_pairs(&path, PairConventions::default());
    let read = read.map_err(|error| UserError::of(&error))?;
    let names = read.pairs.iter().map(|pair| pair.name.clone()).collect();
    let mut pairs = read.pairs;
    pairs.retain(|pair| !left_out.contains(&pair.name));
    let solved = solve(&pairs, mount, Target::Marker).map_err(|error| UserError::of(&error))?;
    Ok(RobotResult::Solved(Arc::new(SolvedPairs {
        path,
        names,
        left_out,
        conventions: [read.robot, read.camera],
        solved,
    })))
}

/// Reads a calibration to be used; `former` is where the former one was kept, if there was one.
pub(super) fn load_calibration(
    path: PathBuf,
    former: Option<PathBuf>,
) -> Result<RobotResult, UserError> {
    let ReadCalibration {
        calibration,
        is_edited,
    } = CellCalibration::read(&path).map_err(|error| UserError::of(&error))?;
    let in_use = Arc::new(CellInUse {
        path,
        calibration,
        is_edited,
    });
    Ok(RobotResult::InUse(in_use, former))
}
