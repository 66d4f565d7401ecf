//! What the window knows of the robot's cell, and what can happen to it.

use std::{path::PathBuf, sync::Arc};

use jiff::Timestamp;
use serde::{Deserialize, Serialize};

use super::work::{CellInUse, RobotAnswer, RobotRequest, SolvedPairs};
use crate::{
    app::{
        action::{Effect, notify},
        job::{Request, Trouble},
        source::file_name,
        state::{Notice, State},
    },
    robot::{
        Convention, WrittenPose, WrittenPoseError,
        calibration::{CalibrationFit, CameraPlace, CellCalibration, Origin},
        hand_eye::Mount,
        parse_written_pose,
    },
};

/// The robot's part of the state.
#[derive(Clone, Debug, Default)]
pub struct RobotState {
    /// The calibration in use, if there is one.
    pub in_use: Option<Arc<CellInUse>>,
    /// Where the user's own calibration is; none: nowhere, and nothing is written.
    pub usual: Option<PathBuf>,
    /// Which calibration the window starts with.
    pub remembered: RememberedCell,
    /// The dialog, while it is open.
    pub dialog: Option<RobotDialog>,
}

/// Which calibration a window starts with.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RememberedCell {
    /// The user's own, if there is one.
    #[default]
    Usual,
    /// None: a person had it forgotten.
    Forgotten,
    /// The one in this file.
    File(PathBuf),
}

/// A page of the dialog.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RobotPage {
    /// What is in use.
    #[default]
    InUse,
    /// Numbers to be typed.
    ByHand,
    /// Hand-eye calibration.
    FromPairs,
}

impl RobotPage {
    /// All of them, in their order.
    pub const ALL: [Self; 3] = [Self::InUse, Self::ByHand, Self::FromPairs];

    /// What a person calls it.
    pub fn title(self) -> &'static str {
        match self {
            Self::InUse => "In use",
            Self::ByHand => "By hand",
            Self::FromPairs => "From pairs of poses",
        }
    }
}

/// What stands in the dialog.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotDialog {
    /// The page in front.
    pub page: RobotPage,
    /// What a new calibration is called.
    pub name: String,
    /// What its camera is fixed to.
    pub mount: Mount,
    /// In which convention numbers are typed.
    pub convention: Convention,
    /// The numbers of the camera's place.
    pub numbers: String,
    /// The numbers of the arm's pose at a capture.
    pub arm: String,
    /// The file of pairs.
    pub pairs: Option<PathBuf>,
    /// Pairs that do not count.
    pub left_out: Vec<String>,
    /// What came of the pairs.
    pub solved: Option<Arc<SolvedPairs>>,
    /// True if a person wants it used although it must not be.
    pub insists: bool,
    /// What went wrong last.
    pub trouble: Option<Trouble>,
}

impl RobotDialog {
    fn new(convention: Convention) -> Self {
        Self {
            page: RobotPage::InUse,
            name: String::new(),
            mount: Mount::EyeToHand,
            convention,
            numbers: String::new(),
            arm: String::new(),
            pairs: None,
            left_out: Vec::new(),
            solved: None,
            insists: false,
            trouble: None,
        }
    }

    /// The numbers typed for the camera's place as a pose.
    pub fn typed(&self) -> Result<WrittenPose, WrittenPoseError> {
        self.read(&self.numbers)
    }

    /// The numbers typed for the arm's pose.
    pub fn typed_arm(&self) -> Result<WrittenPose, WrittenPoseError> {
        self.read(&self.arm)
    }

    /// A convention's name may be typed as well, and counts then.
    fn read(&self, numbers: &str) -> Result<WrittenPose, WrittenPoseError> {
        let is_named = numbers.trim_start().starts_with(char::is_alphabetic);
        if is_named {
            parse_written_pose(numbers)
        } else {
            parse_written_pose(&format!("{}: {numbers}", self.convention.name()))
        }
    }

    /// True if what was calculated may be used.
    pub fn may_use_solved(&self) -> bool {
        let solved = self.solved.as_ref();
        solved.is_some_and(|found| found.solved.is_usable() || self.insists)
    }
}

/// What can happen.
#[derive(Clone, Debug)]
pub enum RobotAction {
    /// Open or close the dialog.
    Toggle,
    /// Close it.
    Close,
    /// Something in it was changed.
    Edit(Box<RobotDialog>),
    /// Use the typed numbers.
    UseTyped,
    /// Use what was calculated.
    UseSolved,
    /// Store the typed pose of the arm as the one that captures are taken from.
    StoreArm,
    /// Use the calibration in this file.
    Load(PathBuf),
    /// Calculate from this file of pairs.
    Pairs(PathBuf),
    /// Use no calibration.
    Forget,
}

/// Carries out an action.
pub(in crate::app) fn apply(state: &mut State, action: RobotAction) -> Option<Effect> {
    match action {
        RobotAction::Toggle => {
            let open = RobotDialog::new(state.convention);
            state.cell.dialog = state.cell.dialog.is_none().then_some(open);
        }
        RobotAction::Close => state.cell.dialog = None,
        RobotAction::Edit(edited) => return edit(state, *edited),
        RobotAction::UseTyped => {
            let dialog = state.cell.dialog.as_ref()?;
            let pose = dialog.typed().ok()?.pose;
            let camera = CameraPlace::on(dialog.mount, pose);
            return save(state, camera, Origin::ByHand);
        }
        RobotAction::UseSolved => {
            let dialog = state.cell.dialog.as_ref()?;
            let found = dialog.solved.clone().filter(|_| dialog.may_use_solved())?;
            let camera = CameraPlace::on(found.solved.mount, found.solved.mount_from_camera);
            let file = file_name(&found.path);
            let fit = CalibrationFit::of(&found.solved, file, found.left_out.clone());
            return save(state, camera, Origin::HandEye(fit));
        }
        RobotAction::StoreArm => {
            let pose = state.cell.dialog.as_ref()?.typed_arm().ok()?.pose;
            let in_use = state.cell.in_use.as_ref()?;
            let mut calibration = Box::new(in_use.calibration.clone());
            let CameraPlace::OnFlange { capture_pose, .. } = &mut calibration.camera else {
                return None;
            };
            *capture_pose = Some(pose);
            let path = in_use.path.clone();
            return Some(ask(
                state,
                "Saving the calibration",
                RobotRequest::Save { path, calibration },
            ));
        }
        RobotAction::Load(path) => {
            return Some(ask(
                state,
                "Opening the calibration",
                RobotRequest::Load(path),
            ));
        }
        RobotAction::Pairs(path) => {
            let mut dialog = state.cell.dialog.clone();
            let edited = dialog.get_or_insert_with(|| RobotDialog::new(state.convention));
            edited.page = RobotPage::FromPairs;
            edited.pairs = Some(path);
            edited.left_out.clear();
            state.cell.dialog = dialog;
            return solve(state);
        }
        RobotAction::Forget => {
            state.cell.in_use = None;
            state.robot = None;
            state.cell.remembered = RememberedCell::Forgotten;
            let what = "The calibration is not used any more; its file stays where it is";
            notify(state, Notice::done(what));
        }
    }
    None
}

/// What a window asks for that has just been opened.
pub(in crate::app) fn start(state: &mut State) -> Option<Effect> {
    let path = calibration_path(state)?;
    Some(ask(
        state,
        "Opening the calibration",
        RobotRequest::Load(path),
    ))
}

/// The file of the calibration in use, also while it is being loaded.
pub(in crate::app) fn calibration_path(state: &State) -> Option<PathBuf> {
    match &state.cell.remembered {
        RememberedCell::Usual => state.cell.usual.clone().filter(|path| path.exists()),
        RememberedCell::Forgotten => None,
        RememberedCell::File(path) => Some(path.clone()),
    }
}

fn ask(state: &mut State, what: &str, request: RobotRequest) -> Effect {
    state.begin(what, Request::Robot(request))
}

/// Takes the dialog over as it is now; pairs are calculated anew where something about them changed.
fn edit(state: &mut State, mut edited: RobotDialog) -> Option<Effect> {
    let known = state.cell.dialog.as_ref()?;
    let is_other = known.mount != edited.mount || known.left_out != edited.left_out;
    if is_other {
        edited.insists = false;
    }
    let solves = is_other && edited.pairs.is_some();
    state.cell.dialog = Some(edited);
    if solves { solve(state) } else { None }
}

fn solve(state: &mut State) -> Option<Effect> {
    let dialog = state.cell.dialog.as_mut()?;
    dialog.trouble = None;
    dialog.solved = None;
    let request = RobotRequest::Solve {
        pairs: dialog.pairs.clone()?,
        mount: dialog.mount,
        left_out: dialog.left_out.clone(),
    };
    Some(ask(state, "Calculating where the camera sits", request))
}

/// Writes a new calibration to where the user's own is.
fn save(state: &mut State, camera: CameraPlace, origin: Origin) -> Option<Effect> {
    let Some(path) = state.cell.usual.clone() else {
        let trouble = Trouble {
            what: "There is no folder for your own calibration".into(),
            advice: "Write it with partsight calibrate --out FILE, and load that file here".into(),
        };
        notify(state, trouble.into());
        return None;
    };
    let dialog = state.cell.dialog.as_ref()?;
    let calibration = Box::new(CellCalibration {
        name: dialog.name.trim().to_owned(),
        notes: String::new(),
        camera,
        origin,
        made_at: Timestamp::now(),
    });
    Some(ask(
        state,
        "Saving the calibration",
        RobotRequest::Save { path, calibration },
    ))
}

/// Takes in what the thread tells.
pub(in crate::app) fn hear(
    state: &mut State,
    outcome: Result<RobotAnswer, Trouble>,
) -> Option<Effect> {
    match outcome {
        Ok(RobotAnswer::InUse(in_use, former)) => {
            if let Some(former) = former {
                let what = format!(
                    "Saved; the former calibration is kept in {}",
                    former.display()
                );
                notify(state, Notice::done(what));
            }
            state.cell.remembered = if Some(&in_use.path) == state.cell.usual.as_ref() {
                RememberedCell::Usual
            } else {
                RememberedCell::File(in_use.path.clone())
            };
            state.robot = in_use.frame();
            state.cell.in_use = Some(in_use);
            if let Some(dialog) = &mut state.cell.dialog {
                dialog.page = RobotPage::InUse;
                dialog.trouble = None;
            }
        }
        Ok(RobotAnswer::Solved(solved)) => {
            let dialog = state.cell.dialog.as_mut()?;
            dialog.solved = Some(solved);
            dialog.trouble = None;
        }
        Err(trouble) => {
            // Where the dialog is open, it says so itself.
            if let Some(dialog) = &mut state.cell.dialog {
                dialog.trouble = Some(trouble);
            } else {
                notify(state, trouble.into());
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::action::{Action, apply as apply_any};

    fn open() -> State {
        let mut state = State::default();
        apply(&mut state, RobotAction::Toggle);
        state
    }

    fn edited(state: &mut State, change: impl FnOnce(&mut RobotDialog)) -> Option<Effect> {
        let mut dialog = state.cell.dialog.clone().expect("open");
        change(&mut dialog);
        apply(state, RobotAction::Edit(Box::new(dialog)))
    }

    fn request(effect: Option<Effect>) -> RobotRequest {
        match effect {
            Some(Effect::Post {
                request: Request::Robot(request),
                ..
            }) => request,
            other => panic!("expected a request, found {other:?}"),
        }
    }

    #[test]
    fn typed_numbers_become_the_calibration_in_use() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut state = open();
        state.cell.usual = Some(folder.path().join("cell.toml"));
        edited(&mut state, |dialog| {
            dialog.name = " Cell 2 ".into();
            dialog.convention = Convention::Kuka;
            dialog.numbers = "1200 -400 1900 10 20 three".into();
        });
        assert!(
            apply(&mut state, RobotAction::UseTyped).is_none(),
            "no pose"
        );
        edited(&mut state, |dialog| {
            dialog.numbers = "1200 -400 1900 10 20 30".into();
        });
        let saved = super::super::work::answer(request(apply(&mut state, RobotAction::UseTyped)));
        let Ok(crate::app::job::TaskResult::Robot(answer)) = saved else {
            panic!("{saved:?}");
        };
        hear(&mut state, Ok(answer));
        let frame = state.robot.clone().expect("a frame");
        assert!(frame.name.starts_with("Cell 2 ("), "{}", frame.name);
        assert!((frame.robot_from_camera.translation.vector.x - 1.2).abs() < 1e-9);
        assert_eq!(state.cell.remembered, RememberedCell::Usual);

        apply(&mut state, RobotAction::Forget);
        assert!(state.robot.is_none() && state.cell.in_use.is_none());
        assert!(folder.path().join("cell.toml").exists());
        assert!(start(&mut state).is_none(), "it stays forgotten");
        state.cell.remembered = RememberedCell::Usual;
        assert!(matches!(request(start(&mut state)), RobotRequest::Load(_)));
    }

    #[test]
    fn a_camera_on_the_flange_has_a_frame_once_the_arm_is_known() {
        let mut state = open();
        let calibration = CellCalibration {
            name: String::new(),
            notes: String::new(),
            camera: CameraPlace::on(
                Mount::EyeInHand,
                crate::geometry::rigid::RigidTransform::identity(),
            ),
            origin: Origin::ByHand,
            made_at: Timestamp::UNIX_EPOCH,
        };
        let in_use = CellInUse {
            path: "cell.toml".into(),
            calibration,
            is_edited: false,
        };
        hear(&mut state, Ok(RobotAnswer::InUse(Arc::new(in_use), None)));
        assert!(state.robot.is_none() && state.cell.in_use.is_some());
        assert_eq!(
            state.cell.remembered,
            RememberedCell::File("cell.toml".into())
        );
        edited(&mut state, |dialog| {
            dialog.arm = "fanuc 900 0 1100 0 90 0".into();
        });
        let RobotRequest::Save { calibration, .. } =
            request(apply(&mut state, RobotAction::StoreArm))
        else {
            panic!("not saved");
        };
        assert!(calibration.frame(None).is_ok());
    }

    #[test]
    fn pairs_are_calculated_anew_when_the_mount_or_what_counts_changes() {
        let mut state = State::default();
        let asked = request(apply(&mut state, RobotAction::Pairs("pairs.csv".into())));
        assert!(matches!(
            asked,
            RobotRequest::Solve {
                mount: Mount::EyeToHand,
                ..
            }
        ));
        assert!(edited(&mut state, |dialog| dialog.name = "x".into()).is_none());
        let asked = request(edited(&mut state, |dialog| dialog.mount = Mount::EyeInHand));
        assert!(matches!(
            asked,
            RobotRequest::Solve {
                mount: Mount::EyeInHand,
                ..
            }
        ));
        let asked = request(edited(&mut state, |dialog| {
            dialog.left_out = vec!["line 3".into()];
        }));
        assert!(matches!(asked, RobotRequest::Solve { left_out, .. } if left_out == ["line 3"]));
        // What was calculated for something else is not there to be used.
        assert!(apply(&mut state, RobotAction::UseSolved).is_none());
        apply_any(&mut state, Action::CloseTop);
        assert!(state.cell.dialog.is_none());
    }
}
