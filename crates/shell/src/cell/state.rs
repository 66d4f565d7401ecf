//! State of the robot's cell in the window, and its actions.

use std::{path::PathBuf, sync::Arc};

use super::{
    answering::Answering,
    cell_check::CellChecks,
    dialog_state::{
        CellInUse, CheckAction, RobotAction, RobotDialog, RobotFile, RobotPage, RobotQuestion,
        RobotResult, confirm_calibration, load_calibration, save_calibration, solve_pairs,
    },
};
use crate::{
    action::Action,
    file_dialog::FileDialog,
    inspection::source::file_name,
    notice::Notice,
    session::{RememberedCell, Session},
    workspace::ShellContext,
};
use robot::{
    calibration::{CalibrationFit, CameraPlace, CellCalibration, Origin},
    cell_check::CellCheckFolder,
};
use ui::{
    language::text,
    task::{Task, TaskRunner},
    user_error::UserError,
};

/// The calibration of the robot's cell, the checks of the cell, the server that robots ask, and the dialog for all of them.
#[derive(Debug)]
pub struct RobotCell {
    in_use: Option<Arc<CellInUse>>,
    dialog: Option<RobotDialog>,
    /// The dialog as it was closed last, with what was typed by hand.
    closed: Option<RobotDialog>,
    task: Task<RobotResult>,
    checks: CellChecks,
    answering: Answering,
    files: FileDialog<RobotFile>,
}

/// States that the calibration in use was edited and not confirmed.
pub(super) fn edited() -> UserError {
    UserError {
        what: text!("robot-edited"),
        advice: text!("robot-edited-advice"),
    }
}

impl RobotCell {
    /// Starts without a calibration. Baseline and checks of the cell are kept in `checks`, if given.
    pub fn new(checks: Option<CellCheckFolder>, runner: &TaskRunner) -> Self {
        Self {
            in_use: None,
            dialog: None,
            closed: None,
            task: Task::new("robot", runner),
            checks: CellChecks::new(checks, runner),
            answering: Answering::new(runner),
            files: FileDialog::default(),
        }
    }

    /// The calibration in use, if any.
    pub fn in_use(&self) -> Option<&Arc<CellInUse>> {
        self.in_use.as_ref()
    }

    /// The dialog, while it is open.
    pub fn dialog(&self) -> Option<&RobotDialog> {
        self.dialog.as_ref()
    }

    /// The baseline and the checks of the cell.
    pub fn checks(&self) -> &CellChecks {
        &self.checks
    }

    /// The server that robots ask.
    pub fn answering(&self) -> &Answering {
        &self.answering
    }

    /// True unless a file is read or written, something is calculated or captured, or a server is being started or stopped.
    pub fn is_idle(&self) -> bool {
        self.task.running().is_none()
            && self.checks.running().is_none()
            && self.answering.is_settled()
    }

    /// Loads the calibration that the window starts with.
    pub fn load_remembered(&mut self, cx: &mut ShellContext<'_>) {
        let is_usual = cx.session.cell == RememberedCell::Usual;
        if let Some(path) = cx.session.calibration_path()
            && (!is_usual || path.exists())
        {
            self.load(path);
        }
    }

    /// Carries out an action.
    pub fn apply(&mut self, action: RobotAction, cx: &mut ShellContext<'_>) {
        match action {
            RobotAction::Toggle if self.dialog.is_none() => {
                self.open(cx.session);
            }
            RobotAction::Show(page) => {
                let dialog = self.open(cx.session).clone();
                self.edit(RobotDialog { page, ..dialog });
            }
            RobotAction::Toggle | RobotAction::Close => {
                self.closed = self.dialog.take();
                // A closed dialog could not show the result.
                self.checks.cancel();
            }
            RobotAction::Edit(edited) => self.edit(*edited),
            RobotAction::UseTyped => {
                if let Some(dialog) = &self.dialog
                    && let Ok(written) = dialog.typed()
                {
                    let camera = CameraPlace::on(dialog.mount, written.pose);
                    self.save_new(camera, Origin::ByHand, cx);
                }
            }
            RobotAction::UseSolved => {
                if let Some(found) = self.dialog.as_ref().and_then(RobotDialog::usable) {
                    let solved = &found.solved;
                    let camera = CameraPlace::on(solved.mount, solved.mount_from_camera);
                    let file = file_name(&found.path);
                    let fit = CalibrationFit::of(solved, file, found.left_out.clone());
                    self.save_new(camera, Origin::HandEye(fit), cx);
                }
            }
            RobotAction::StoreArm => self.store_arm(),
            RobotAction::Ask(file) => {
                let lock = &cx.services.dialogs;
                self.files.open(file, &file.request(), lock, cx.egui);
            }
            RobotAction::Load(path) => self.load(path),
            RobotAction::Pairs(path) => {
                let open = || RobotDialog::new(cx.session);
                let dialog = self.dialog.get_or_insert_with(open);
                dialog.page = RobotPage::FromPairs;
                dialog.pairs = Some(path);
                dialog.left_out.clear();
                self.solve();
            }
            RobotAction::Confirm => self.confirm(),
            RobotAction::Forget => {
                self.in_use = None;
                cx.send(Action::UseCalibration(RememberedCell::Forgotten, None));
                let what = text!("robot-forgotten");
                cx.notify(Notice::done(what));
            }
            RobotAction::Check(action) => {
                let started = self.check(action, cx);
                if let Some(dialog) = &mut self.dialog {
                    dialog.problem = started.err();
                }
            }
            RobotAction::Answer(setup) => cx.send(Action::UseAnswering(setup)),
        }
    }

    /// Opens the dialog, unless it is open.
    fn open(&mut self, session: &Session) -> &RobotDialog {
        let closed = &mut self.closed;
        self.dialog.get_or_insert_with(|| {
            let mut dialog = RobotDialog::new(session);
            if let Some(closed) = closed.take() {
                dialog.take_draft(closed);
            }
            dialog
        })
    }

    /// Carries out an action of the check of the cell; an error if it cannot start.
    fn check(&mut self, action: CheckAction, cx: &ShellContext<'_>) -> Result<(), UserError> {
        match action {
            CheckAction::TakeBaseline => {
                let Some(dialog) = &mut self.dialog else {
                    return Ok(());
                };
                let is_asked = self.checks.content().has_baseline
                    && dialog.question != Some(RobotQuestion::ReplaceBaseline);
                dialog.question = is_asked.then_some(RobotQuestion::ReplaceBaseline);
                if is_asked {
                    return Ok(());
                }
                self.checks.take_baseline(dialog.limits, cx)
            }
            CheckAction::Check => self.checks.check(cx),
            CheckAction::Cancel => {
                self.checks.cancel();
                Ok(())
            }
            CheckAction::Export(path) => {
                self.checks.export(path);
                Ok(())
            }
        }
    }

    fn load(&mut self, path: PathBuf) {
        let job = |_: &_| Ok(load_calibration(path, None)?);
        self.task.start(text!("robot-opening"), job);
    }

    fn save(&mut self, path: PathBuf, calibration: CellCalibration) {
        let job = move |_: &_| Ok(save_calibration(path, &calibration)?);
        self.task.start(text!("robot-saving"), job);
    }

    /// Asks whether the edited numbers are right, then confirms them.
    fn confirm(&mut self) {
        let (Some(dialog), Some(in_use)) = (&mut self.dialog, &self.in_use) else {
            return;
        };
        let is_confirmed = dialog.question == Some(RobotQuestion::ConfirmEdited);
        dialog.question =
            (!is_confirmed && in_use.is_edited).then_some(RobotQuestion::ConfirmEdited);
        if is_confirmed && in_use.is_edited {
            let path = in_use.path.clone();
            let job = |_: &_| Ok(confirm_calibration(path)?);
            self.task.start(text!("robot-saving"), job);
        }
    }

    fn store_arm(&mut self) {
        if let (Some(dialog), Some(in_use)) = (&self.dialog, &self.in_use)
            // Storing writes a checksum, which would confirm edited numbers.
            && !in_use.is_edited
            && let Ok(written) = dialog.typed_arm()
        {
            let mut calibration = in_use.calibration.clone();
            if let CameraPlace::OnFlange { capture_pose, .. } = &mut calibration.camera {
                *capture_pose = Some(written.pose);
                self.save(in_use.path.clone(), calibration);
            }
        }
    }

    /// Replaces the dialog by its edited state. Solves the pairs again if they changed, and reads the checks of the cell
    /// when their page comes to the front.
    fn edit(&mut self, mut edited: RobotDialog) {
        let Some(known) = &mut self.dialog else {
            return;
        };
        let is_other = known.mount != edited.mount || known.left_out != edited.left_out;
        if is_other {
            edited.insists = false;
        }
        if known.page != edited.page {
            edited.question = None;
            if edited.page == RobotPage::Check {
                self.checks.read();
            }
        }
        *known = edited;
        if is_other {
            self.solve();
        }
    }

    /// Calculates the calibration from the chosen file of pairs, if any.
    fn solve(&mut self) {
        if let Some(dialog) = &mut self.dialog
            && let Some(pairs) = dialog.pairs.clone()
        {
            dialog.problem = None;
            dialog.solved = None;
            let (mount, left_out) = (dialog.mount, dialog.left_out.clone());
            let job = move |_: &_| Ok(solve_pairs(pairs, mount, left_out)?);
            self.task.start(text!("robot-calculating"), job);
        }
    }

    /// Saves a new calibration as the user's own.
    fn save_new(&mut self, camera: CameraPlace, origin: Origin, cx: &mut ShellContext<'_>) {
        let Some(path) = cx.session.usual_cell.clone() else {
            cx.notify(Notice::look(
                text!("robot-no-folder"),
                text!("robot-no-folder-advice"),
            ));
            return;
        };
        let name = self.dialog.as_ref().map(|dialog| dialog.name.trim());
        let calibration = CellCalibration {
            name: name.unwrap_or_default().to_owned(),
            notes: String::new(),
            camera,
            origin,
            made_at: geometry::clock::now(),
        };
        self.save(path, calibration);
    }

    /// Polls the tasks and the file dialog; returns the action for a chosen file.
    pub fn update(&mut self, cx: &mut ShellContext<'_>) -> Option<RobotAction> {
        match self.task.poll() {
            Some(Ok(result)) => self.receive(result, cx),
            Some(Err(error)) => self.report(error, cx),
            None => {}
        }
        if let Some(error) = self.checks.update(cx) {
            self.report(error, cx);
        }
        self.answering.update(cx);
        let (file, path) = cx.chosen(&mut self.files)?;
        Some(match file {
            RobotFile::Calibration => RobotAction::Load(path),
            RobotFile::Pairs => RobotAction::Pairs(path),
            RobotFile::Checks => RobotAction::Check(CheckAction::Export(path)),
        })
    }

    /// Shows an error in the dialog if it is open, else as a notice.
    fn report(&mut self, error: UserError, cx: &mut ShellContext<'_>) {
        match &mut self.dialog {
            Some(dialog) => dialog.problem = Some(error),
            None => cx.notify(error),
        }
    }

    fn receive(&mut self, result: RobotResult, cx: &mut ShellContext<'_>) {
        match result {
            RobotResult::InUse(in_use, former) => {
                if let Some(former) = former {
                    let what = text!("robot-saved", path = former.display().to_string());
                    cx.notify(Notice::done(what));
                }
                let cell = if Some(&in_use.path) == cx.session.usual_cell.as_ref() {
                    RememberedCell::Usual
                } else {
                    RememberedCell::File(in_use.path.clone())
                };
                cx.send(Action::UseCalibration(cell, in_use.frame()));
                let is_edited = in_use.is_edited;
                self.in_use = Some(in_use);
                match &mut self.dialog {
                    Some(dialog) => {
                        dialog.page = RobotPage::InUse;
                        dialog.question = None;
                        dialog.problem = None;
                    }
                    None if is_edited => cx.notify(edited()),
                    None => {}
                }
            }
            RobotResult::Solved(solved) => {
                if let Some(dialog) = &mut self.dialog {
                    dialog.solved = Some(solved);
                    dialog.problem = None;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::{fmt::Write as _, fs, path::Path};

    use jiff::Timestamp;

    use super::*;
    use crate::workspace::TestShell;
    use geometry::rigid::{RigidTransform, from_euler_zyx};
    use robot::{Convention, hand_eye::Mount};

    /// The robot's cell without a window or threads.
    struct Bench {
        robot: RobotCell,
        shell: TestShell,
        folder: tempfile::TempDir,
    }

    impl Bench {
        fn new() -> Self {
            Self {
                robot: RobotCell::new(None, &TaskRunner::without_threads()),
                shell: TestShell::default(),
                folder: tempfile::tempdir().expect("a folder"),
            }
        }

        fn apply(&mut self, action: RobotAction) {
            self.robot.apply(action, &mut self.shell.context());
            self.deliver();
        }

        fn edit(&mut self, change: impl FnOnce(&mut RobotDialog)) {
            let mut dialog = self.robot.dialog.clone().expect("open");
            change(&mut dialog);
            self.apply(RobotAction::Edit(Box::new(dialog)));
        }

        /// Runs the waiting work; false if there is none.
        fn work(&mut self) -> bool {
            let has_worked = self.robot.task.run_waiting();
            self.robot.update(&mut self.shell.context());
            self.deliver();
            has_worked
        }

        /// Applies the calibrations that were sent.
        fn deliver(&mut self) {
            for message in std::mem::take(&mut self.shell.sent) {
                if let Action::UseCalibration(cell, robot) = message {
                    self.shell.session.cell = cell;
                    self.shell.session.robot = robot;
                }
            }
        }

        fn dialog(&self) -> &RobotDialog {
            self.robot.dialog.as_ref().expect("open")
        }
    }

    #[test]
    fn typed_numbers_become_the_calibration_in_use() {
        let mut bench = Bench::new();
        let own = bench.folder.path().join("cell.toml");
        bench.shell.session.usual_cell = Some(own.clone());
        bench.apply(RobotAction::Toggle);
        bench.edit(|dialog| {
            dialog.name = " Cell 2 ".into();
            dialog.convention = Convention::Kuka;
            dialog.numbers = "1200 -400 1900 10 20 three".into();
        });
        bench.apply(RobotAction::UseTyped);
        assert!(!bench.work(), "no pose");
        // What was typed is still there after the dialog was closed, and on another page.
        let before = bench.dialog().clone();
        bench.apply(RobotAction::Close);
        bench.apply(RobotAction::Show(RobotPage::Answer));
        assert_eq!(bench.dialog().page, RobotPage::Answer);
        bench.apply(RobotAction::Show(before.page));
        assert_eq!(*bench.dialog(), before);
        bench.edit(|dialog| dialog.numbers = "1200 -400 1900 10 20 30".into());
        bench.apply(RobotAction::UseTyped);
        assert!(bench.work());
        let frame = bench.shell.session.robot.clone().expect("a frame");
        let name = frame.name.to_string();
        assert!(name.starts_with("Cell 2 ("), "{name}");
        assert!((frame.robot_from_camera.translation.vector.x - 1.2).abs() < 1e-9);
        assert_eq!(bench.shell.session.cell, RememberedCell::Usual);

        bench.apply(RobotAction::Forget);
        assert!(bench.shell.session.robot.is_none() && bench.robot.in_use.is_none());
        assert!(own.exists());
        bench.robot.load_remembered(&mut bench.shell.context());
        assert!(!bench.work(), "it stays forgotten");
        bench.shell.session.cell = RememberedCell::Usual;
        bench.robot.load_remembered(&mut bench.shell.context());
        assert!(bench.work());
        assert_eq!(bench.shell.session.robot, Some(frame));
    }

    #[test]
    fn a_camera_on_the_flange_has_a_frame_once_the_arm_is_known() {
        let mut bench = Bench::new();
        let path = bench.folder.path().join("other.toml");
        let calibration = CellCalibration {
            name: String::new(),
            notes: String::new(),
            camera: CameraPlace::on(Mount::EyeInHand, RigidTransform::identity()),
            origin: Origin::ByHand,
            made_at: Timestamp::UNIX_EPOCH,
        };
        calibration.save(&path).expect("written");
        bench.apply(RobotAction::Toggle);
        bench.apply(RobotAction::Load(path.clone()));
        assert!(bench.work());
        assert!(bench.shell.session.robot.is_none() && bench.robot.in_use.is_some());
        assert_eq!(bench.shell.session.cell, RememberedCell::File(path.clone()));
        bench.edit(|dialog| dialog.arm = "fanuc 900 0 1100 0 90 0".into());
        bench.apply(RobotAction::StoreArm);
        assert!(bench.work());
        assert!(bench.shell.session.robot.is_some());
        let stored = CellCalibration::load(&path).expect("read");
        assert!(stored.frame(None).is_ok());
    }

    #[test]
    fn edited_numbers_give_no_frame_until_they_are_confirmed_twice() {
        let mut bench = Bench::new();
        let path = bench.folder.path().join("cell.toml");
        let calibration = CellCalibration {
            name: String::new(),
            notes: String::new(),
            camera: CameraPlace::on(
                Mount::EyeToHand,
                from_euler_zyx([0.1, 0.2, 0.3, 1.2, 0.0, 2.0]),
            ),
            origin: Origin::ByHand,
            made_at: Timestamp::UNIX_EPOCH,
        };
        let text = calibration.to_text();
        let digit = text.replace("1.200000000000", "7.200000000000");
        assert_ne!(digit, text);
        fs::write(&path, &digit).expect("written");
        // When the window starts, and later in the dialog.
        bench
            .robot
            .apply(RobotAction::Load(path.clone()), &mut bench.shell.context());
        assert!(bench.robot.task.run_waiting());
        bench.robot.update(&mut bench.shell.context());
        let notified = bench.shell.sent.iter().any(
            |message| matches!(message, Action::Notify(notice) if notice.what == edited().what),
        );
        assert!(notified, "{:?}", bench.shell.sent);
        bench.deliver();
        assert!(bench.shell.session.robot.is_none() && bench.robot.in_use.is_some());
        bench.apply(RobotAction::Toggle);
        bench.apply(RobotAction::Confirm);
        assert!(
            bench.dialog().question.is_some() && !bench.work(),
            "asked first"
        );
        assert_eq!(fs::read_to_string(&path).expect("read"), digit);
        bench.apply(RobotAction::Confirm);
        assert!(bench.work());
        let frame = bench.shell.session.robot.clone().expect("a frame");
        assert!((frame.robot_from_camera.translation.vector.x - 7.2).abs() < 1e-9);
        assert!(CellCalibration::load(&path).is_ok());
        // Nothing is left to confirm.
        bench.apply(RobotAction::Confirm);
        assert!(!bench.work() && bench.dialog().question.is_none());
    }

    /// Writes pairs of a fixed camera that sees a target on the flange.
    fn write_pairs(path: &Path) {
        let robot_from_camera = from_euler_zyx([-2.2, 0.1, -1.6, 1.5, -0.2, 2.0]);
        let flange_from_target = from_euler_zyx([0.3, 0.2, -0.5, 0.02, -0.03, 0.1]);
        let mut text = String::from("# robot: kuka\n# camera: rotation-vector\n");
        for (i, turn) in [0.0, 0.4, -0.3, 0.1, -0.2, 0.5].into_iter().enumerate() {
            let aside = 0.06 * i as f64;
            let seen = from_euler_zyx([turn, 0.8 * aside, -turn, aside, -aside, 1.2]);
            let arm = robot_from_camera * seen * flange_from_target.inverse();
            let mut numbers = Convention::Kuka.write(&arm).numbers();
            numbers.extend(Convention::RotationVector.write(&seen).numbers());
            let numbers: Vec<String> = numbers.iter().map(ToString::to_string).collect();
            writeln!(text, "p{i}, {}", numbers.join(", ")).expect("memory");
        }
        fs::write(path, text).expect("written");
    }

    #[test]
    fn pairs_are_calculated_anew_when_the_mount_or_what_counts_changes() {
        let mut bench = Bench::new();
        let pairs = bench.folder.path().join("pairs.csv");
        write_pairs(&pairs);
        bench.apply(RobotAction::Pairs(pairs));
        assert!(bench.work());
        let first = bench.dialog().solved.clone().expect("calculated");
        assert_eq!(first.solved.mount, Mount::EyeToHand);
        bench.edit(|dialog| dialog.name = "x".into());
        assert!(!bench.work() && bench.dialog().solved.is_some());
        bench.edit(|dialog| dialog.mount = Mount::EyeInHand);
        // The result for the other mount cannot be used any more.
        bench.apply(RobotAction::UseSolved);
        assert!(bench.dialog().solved.is_none());
        assert!(bench.work());
        let other = bench.dialog().solved.clone().expect("calculated");
        assert_eq!(other.solved.mount, Mount::EyeInHand);
        let left_out = vec![first.names[2].clone()];
        bench.edit(|dialog| dialog.left_out.clone_from(&left_out));
        assert!(bench.work());
        let fewer = bench.dialog().solved.clone().expect("calculated");
        assert_eq!(fewer.left_out, left_out);
        assert_eq!(fewer.solved.residuals.pairs.len(), first.names.len() - 1);
        bench.apply(RobotAction::Close);
        assert!(bench.robot.dialog.is_none());
    }
}
