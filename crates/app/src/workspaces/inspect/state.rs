//! State of the workspace besides the result, the actions that change it, and the files that it asks for.

use std::{collections::BTreeSet, path::PathBuf, sync::Arc};

use crate::{
    shots::{Asked, ShotsAction, ShotsFile, ShotsState, source_of},
    workspaces::inspect::{
        hold::Hold,
        robot_numbers::{clipboard_text, numbered},
        wrong_part::WrongPartPage,
    },
};
use inspection::library::Truth;
use records::history::Traceability;
use shell::{
    action::{Action, Event},
    file_dialog::{FileChoice, FileDialog, FileRequest, program_files},
    inspection::{
        figures::StagePanel,
        inspected::{InspectJob, Inspected},
        report_files,
        scan::FusedShots,
        source::{ScanOrder, ShotChoice},
    },
    notice::Notice,
    session::{ReinspectionPurpose, Session, Source, WorkspaceKind},
    workspace::ShellContext,
};
use ui::{
    language::{described, text},
    task::{Running, Task, TaskRunner},
    user_error::UserError,
    viewport::{Colouring, ViewShot},
};

/// An addition to the points of the view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ViewPart {
    /// The axes at the part's middle.
    Axes,
    /// The depth camera and its field of view.
    Camera,
    /// The enrolled part's outline at the found pose.
    Outline,
    /// The assumed nozzle over the middle of the part.
    NozzleMiddle,
    /// The assumed nozzle with the largest error of stand-off.
    NozzleWorst,
    /// The part's stored spray path, moved to the part's pose.
    SprayPath,
    /// The axes of the robot base.
    RobotBase,
    /// The cameras of a scan's shots.
    ShotCameras,
    /// Surfaces that no shot of a scan shows.
    Unseen,
}

impl ViewPart {
    /// All additions, in the order of the menu.
    pub const ALL: [Self; 9] = [
        Self::Outline,
        Self::NozzleMiddle,
        Self::NozzleWorst,
        Self::SprayPath,
        Self::Axes,
        Self::Camera,
        Self::RobotBase,
        Self::ShotCameras,
        Self::Unseen,
    ];

    /// Name for a person.
    pub fn title(self) -> String {
        match self {
            Self::Axes => text!("inspect-part-axes"),
            Self::Camera => text!("inspect-part-camera"),
            Self::Outline => text!("inspect-part-outline"),
            Self::NozzleMiddle => text!("inspect-part-nozzle-middle"),
            Self::NozzleWorst => text!("inspect-part-nozzle-worst"),
            Self::SprayPath => text!("inspect-part-spray-path"),
            Self::RobotBase => text!("shell-robot-base"),
            Self::ShotCameras => text!("inspect-part-shot-cameras"),
            Self::Unseen => text!("inspect-part-unseen"),
        }
    }
}

/// State of the workspace.
#[derive(Debug)]
pub struct InspectState {
    /// The additions shown in the view.
    pub parts: BTreeSet<ViewPart>,
    /// The chosen colouring; `None` means deviations where there are any, else segments.
    pub colouring: Option<Colouring>,
    /// The stage enlarged to fill the middle, if any.
    pub enlarged: Option<StagePanel>,
    /// Index in the ranking of the part that contour and signature are compared with; 0 is the best.
    pub candidate: usize,
    /// State of the list of shots, if a scan is shown.
    pub shots: ShotsState,
    /// The page on which the operator says what a part really is, while it is open.
    pub wrong_part: Option<WrongPartPage>,
    /// File for a picture of the view, until the picture is taken.
    picture_to: Option<PathBuf>,
    /// Folder for a report, until a picture of the view is taken for it.
    report_to: Option<PathBuf>,
    /// Number of the last result shown.
    seen: Option<u64>,
    /// The scan of that result.
    seen_scan: Option<Arc<FusedShots>>,
    writing: Task<Notice>,
    dialog: FileDialog<InspectFile>,
}

impl InspectState {
    /// Creates the state before the first result.
    pub fn new(runner: &TaskRunner) -> Self {
        Self {
            parts: [
                ViewPart::Axes,
                ViewPart::Outline,
                ViewPart::SprayPath,
                ViewPart::RobotBase,
                ViewPart::ShotCameras,
                ViewPart::Unseen,
            ]
            .into(),
            colouring: None,
            enlarged: None,
            candidate: 0,
            shots: ShotsState::default(),
            wrong_part: None,
            picture_to: None,
            report_to: None,
            seen: None,
            seen_scan: None,
            writing: Task::new("inspect-write", runner),
            dialog: FileDialog::default(),
        }
    }

    /// The shots used by the scan shown, or those requested while they are being prepared.
    pub fn shot_choice<'a>(&'a self, session: &'a Session) -> Option<&'a ShotChoice> {
        let scan = session.shown.as_ref()?.inspected.scan.as_ref()?;
        let run = session.inspecting.as_ref();
        let is_on_its_way = run.is_some_and(|run| run.purpose == ReinspectionPurpose::Shots);
        let asked = self.shots.asked_choice().filter(|_| is_on_its_way);
        Some(asked.unwrap_or(&scan.fused.choice))
    }

    /// True if an assumed nozzle is shown.
    pub(super) fn shows_nozzle(&self) -> bool {
        let nozzles = [ViewPart::NozzleMiddle, ViewPart::NozzleWorst];
        nozzles.iter().any(|nozzle| self.parts.contains(nozzle))
    }

    /// The file that is being written, if any.
    pub fn writing(&self) -> Option<&Running> {
        self.writing.running()
    }

    /// Runs the writing that waits; false if there is none.
    #[cfg(test)]
    pub(super) fn run_waiting(&mut self) -> bool {
        self.writing.run_waiting()
    }

    /// True if a picture of the view is requested.
    pub fn wants_picture(&self) -> bool {
        self.picture_to.is_some() || self.report_to.is_some()
    }

    /// Carries out an action.
    pub fn apply(&mut self, action: InspectAction, cx: &mut ShellContext<'_>) {
        match action {
            InspectAction::Toggle(part) => {
                if !self.parts.remove(&part) {
                    self.parts.insert(part);
                }
            }
            InspectAction::Colour(colouring) => self.colouring = Some(colouring),
            InspectAction::Enlarge(panel) => self.enlarged = panel,
            InspectAction::Candidate(index) => self.candidate = index,
            InspectAction::NextPart(by) => {
                if let Some(shown) = &cx.session.shown {
                    let index = shown.selected() as isize + by;
                    let index = index.rem_euclid(shown.parts.len() as isize);
                    cx.send(Action::SelectPart(index as usize));
                }
            }
            InspectAction::CopyPose => copy_pose(cx),
            InspectAction::Enrol => enrol_shown(cx),
            InspectAction::Act(action) => cx.send(action),
            InspectAction::Shots(action) => self.change_shots(action, cx),
            InspectAction::Ask(file) => {
                let lock = &cx.services.dialogs;
                self.dialog
                    .open(file, &file.request(cx.session), lock, cx.egui);
            }
            InspectAction::Chosen(file, path) => self.chosen(file, path, cx),
            InspectAction::ActualPart(label) => {
                if let Some(page) = self.wrong_part.take() {
                    cx.send(Action::Tell(page.labelled(label)));
                }
            }
            InspectAction::LeaveWrongPart => self.wrong_part = None,
        }
    }

    fn chosen(&mut self, file: InspectFile, path: PathBuf, cx: &mut ShellContext<'_>) {
        let is_in_sight =
            cx.session.workspace == WorkspaceKind::Inspect && cx.session.shown.is_some();
        match file {
            InspectFile::Picture => self.picture_to = Some(path),
            // The view provides its picture in the next frame.
            InspectFile::Report if is_in_sight => self.report_to = Some(path),
            InspectFile::Report => self.write_report(path, None, cx),
            InspectFile::SprayPath => self.write_spray_path(path, cx),
            InspectFile::Shots(file) => self.change_shots(ShotsAction::Chosen(file, path), cx),
        }
    }

    /// Fuses the shots again and inspects them, if the action changes them.
    fn change_shots(&mut self, action: ShotsAction, cx: &mut ShellContext<'_>) {
        if let ShotsAction::Ask(file) = action {
            return self.apply(InspectAction::Ask(InspectFile::Shots(file)), cx);
        }
        let used = self.shot_choice(cx.session).cloned();
        match self.shots.apply(action, used) {
            Ok(None) => {}
            Ok(Some((order, asked))) => {
                self.shots.started(Some(asked));
                let shown = cx.session.shown.as_ref();
                let shown = shown.map(|shown| &*shown.inspected);
                let (purpose, hung, trace) =
                    match shown.filter(|inspected| is_of_scan(&order, inspected)) {
                        Some(inspected) => (
                            ReinspectionPurpose::Shots,
                            Some(inspected.hung().clone()),
                            cx.session.trace.of_part(inspected),
                        ),
                        None => (ReinspectionPurpose::New, None, Traceability::default()),
                    };
                if let ScanOrder::Open(files) = &order {
                    cx.send(Action::UseSource(Source::Scan(files.clone())));
                }
                cx.send(Action::Inspect {
                    title: order.title(),
                    job: InspectJob::Scan(cx.session.scan_request(order)),
                    purpose,
                    hung,
                    trace,
                });
            }
            Err(notice) => cx.notify(notice),
        }
    }

    /// Handles an event of the shell.
    pub fn on_event(&mut self, event: &Event, cx: &mut ShellContext<'_>) {
        match event {
            Event::Inspected { parts, purpose } => {
                self.settle_shots(&parts[0], *purpose, cx);
            }
            Event::PosesWanted(order) => {
                self.shots.ask_for_poses(order.clone());
                let file = InspectFile::Shots(ShotsFile::Poses);
                self.apply(InspectAction::Ask(file), cx);
            }
            Event::Export => self.apply(InspectAction::Ask(InspectFile::Report), cx),
            Event::Escape => {
                self.enlarged = None;
                self.wrong_part = None;
            }
            Event::WrongPart(part) => self.wrong_part = WrongPartPage::about(part, cx.session),
            Event::Left(_)
            | Event::TracedLate(..)
            | Event::EngineerIn
            | Event::Drift(_)
            | Event::Labelled { .. }
            | Event::Undo(_) => {}
        }
    }

    /// Takes in a new result: its choice of shots becomes undoable.
    fn settle_shots(
        &mut self,
        inspected: &Inspected,
        purpose: ReinspectionPurpose,
        cx: &mut ShellContext<'_>,
    ) {
        let former = self.seen_scan.as_ref().map(|scan| scan.choice.clone());
        let now = inspected.scan.as_ref().map(|scan| &scan.fused.choice);
        if purpose != ReinspectionPurpose::Shots {
            let both = former.as_ref().zip(now);
            // The same shots again, by another recipe or library.
            let is_same = both.is_some_and(|(former, now)| Arc::ptr_eq(&former.set, &now.set));
            self.shots.started((!is_same).then(Asked::first));
        }
        let files = now.map(ShotChoice::files);
        // Let the next start of the window open the same shots.
        if let Some(files) = &files
            && let Some(source) = source_of(files, &cx.session.source)
        {
            cx.send(Action::UseSource(source));
        }
        self.shots.settle(files.as_ref(), former);
    }

    /// Takes in the results of the task and of the file dialog, and follows the result shown.
    pub fn update(&mut self, cx: &mut ShellContext<'_>) {
        cx.notify_written(&mut self.writing);
        if !cx.session.is_operator_view() {
            self.wrong_part = None;
        }
        if let Some((file, path)) = cx.chosen(&mut self.dialog) {
            self.chosen(file, path, cx);
        }
        let shown = cx.session.shown.as_ref();
        let number = shown.map(|shown| shown.generation);
        if let Some(shown) = shown.filter(|_| number != self.seen) {
            let num_candidates = shown.inspected.figures.candidates.len();
            // While following a source, keep the chosen candidate from frame to frame.
            self.candidate = match shown.session {
                Some(_) => self.candidate.min(num_candidates.saturating_sub(1)),
                None => 0,
            };
            let scan = shown.inspected.scan.as_ref();
            self.seen_scan = scan.map(|scan| Arc::clone(&scan.fused));
            self.seen = number;
        }
    }

    /// Takes in the requested picture, or why there is none.
    pub fn take_picture(&mut self, shot: Result<ViewShot, UserError>, cx: &mut ShellContext<'_>) {
        if let Some(folder) = self.report_to.take() {
            // A missing picture does not prevent the report.
            return self.write_report(folder, shot.ok(), cx);
        }
        let Some(mut path) = self.picture_to.take() else {
            return;
        };
        match shot {
            Ok(shot) => {
                if path.extension().is_none() {
                    path.set_extension("png");
                }
                self.writing
                    .start(text!("inspect-saving-picture"), move |_| {
                        Ok(Notice::done(report_files::picture(&path, &shot)?))
                    });
            }
            Err(error) => cx.notify(error),
        }
    }

    /// Writes a report of the inspection shown.
    fn write_report(&mut self, folder: PathBuf, shot: Option<ViewShot>, cx: &ShellContext<'_>) {
        let Some(shown) = &cx.session.shown else {
            return;
        };
        let inspected = Arc::clone(&shown.inspected);
        let robot = cx.session.robot_of(&inspected).cloned();
        let convention = cx.session.convention;
        let trace = cx.session.trace.of_part(&inspected);
        let subject = cx.session.subject_now(&inspected);
        let (parts, selected) = (shown.parts.clone(), shown.selected());
        self.writing
            .start(text!("inspect-writing-report"), move |_| {
                let robot = robot.as_deref();
                let line = inspected.as_recorded(&subject, robot).line(&trace);
                let report =
                    report_files::report_of(&inspected, &subject, &trace, robot, convention);
                let shot = shot.as_ref();
                let written =
                    report_files::report(&folder, &parts, selected, &line, &report, shot)?;
                Ok(Notice::done(written))
            });
    }

    /// Writes the spray path of the inspection shown for the robot; nothing without a path or a calibrated cell.
    fn write_spray_path(&mut self, path: PathBuf, cx: &ShellContext<'_>) {
        let Some(shown) = &cx.session.shown else {
            return;
        };
        let inspected = Arc::clone(&shown.inspected);
        let others = shown.parts.iter();
        let others = others.filter(|part| !Arc::ptr_eq(part, &inspected));
        let others: Vec<Arc<Inspected>> = others.map(Arc::clone).collect();
        if inspected.spray.is_none() {
            return;
        }
        let subject = cx.session.subject_now(&inspected);
        // The part may have left while the file was being chosen.
        let robot = Hold::robot_of_files(cx.session, &inspected).map(Arc::clone);
        let (convention, setup) = (cx.session.convention, cx.session.program.clone());
        self.writing.start(text!("inspect-writing-path"), move |_| {
            let robot = match robot {
                Ok(robot) => robot,
                Err(hold) => {
                    // The file of an earlier part must not remain.
                    report_files::remove_earlier(&path)?;
                    return Err(UserError::from(hold).into());
                }
            };
            let target = setup.target();
            let written = report_files::spray_path(
                &path, &inspected, &others, &subject, &robot, convention, target,
            )?;
            Ok(Notice::of_robot_file(written))
        });
    }
}

/// True if this is another choice among the shots of the scan that was inspected.
fn is_of_scan(order: &ScanOrder, inspected: &Inspected) -> bool {
    let scan = inspected.scan.as_ref();
    match order {
        ScanOrder::Known(choice) | ScanOrder::Add(choice, ..) => {
            scan.is_some_and(|scan| scan.fused.choice.set.files.frames == choice.set.files.frames)
        }
        ScanOrder::Open(_) | ScanOrder::Kept(_) => false,
    }
}

/// Copies the pose to the clipboard, if there is one.
fn copy_pose(cx: &mut ShellContext<'_>) {
    let Some(shown) = &cx.session.shown else {
        return;
    };
    if let Err(hold) = Hold::robot_of_files(cx.session, &shown.inspected) {
        return cx.notify(UserError::from(hold));
    }
    let Some(numbered) = numbered(cx.session, &shown.inspected) else {
        return;
    };
    let title = described(&numbered.pose.convention);
    let what = text!(
        "inspect-pose-copied",
        name = numbered.name,
        convention = title
    );
    cx.notify(Notice::done(what));
    cx.send(Action::CopyText(clipboard_text(&numbered)));
}

/// Makes the scene in front the draft of Enrol, and goes there.
fn enrol_shown(cx: &mut ShellContext<'_>) {
    if let Some(shown) = &cx.session.shown {
        let take = Action::Take(shown.inspected.again(), text!("enrol-taking-scene"));
        cx.send(Action::GoTo(WorkspaceKind::Enrol));
        cx.send(take);
    }
}

/// An action in the workspace.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "few are made, and none is kept")]
pub enum InspectAction {
    /// Show or hide this in the view.
    Toggle(ViewPart),
    /// Choose what colours the points.
    Colour(Colouring),
    /// Enlarge a stage to fill the middle; `None` shows the view again.
    Enlarge(Option<StagePanel>),
    /// Show the part that many places further in the frame, in a circle.
    NextPart(isize),
    /// Compare contour and signature with the part at this index of the ranking.
    Candidate(usize),
    /// Copy the pose to the clipboard, in the chosen convention.
    CopyPose,
    /// Make the scene in front the draft of Enrol, and go there.
    Enrol,
    /// An action of the shell.
    Act(Action),
    /// An action on the shots of the scan shown.
    Shots(ShotsAction),
    /// Ask for a file.
    Ask(InspectFile),
    /// A file was chosen.
    Chosen(InspectFile, PathBuf),
    /// The operator says what the part really is.
    ActualPart(Truth),
    /// Back to the operator's view, without a change.
    LeaveWrongPart,
}

/// A file or folder that a person is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InspectFile {
    /// The folder that the report of the inspection is written to.
    Report,
    /// The file that a picture of the view is written to.
    Picture,
    /// The file that the spray path is written to.
    SprayPath,
    /// A file of the scan.
    Shots(ShotsFile),
}

impl InspectFile {
    /// The dialog to open; a new file is named after the part that was inspected last.
    fn request(self, session: &Session) -> FileRequest {
        let shown = session.shown.as_ref();
        let verdict = shown.map(|shown| &shown.inspected.inspection.verdict);
        let verdict = verdict.filter(|verdict| !verdict.is_unknown());
        let part = verdict.and_then(|verdict| verdict.guess());
        let part = part.unwrap_or("scene");
        match self {
            Self::Report => FileRequest {
                title: text!("inspect-report-folder"),
                filters: Vec::new(),
                choice: FileChoice::FolderToWrite,
            },
            Self::Picture => FileRequest {
                title: text!("inspect-save-picture"),
                filters: vec![(text!("inspect-pictures"), &["png"])],
                choice: FileChoice::NewFile(format!("{part}.png")),
            },
            Self::SprayPath => FileRequest {
                title: text!("inspect-export-path-title"),
                filters: vec![
                    (text!("shell-csv-files"), &["csv"]),
                    ("JSON".into(), &["json"]),
                    program_files(),
                ],
                choice: FileChoice::NewFile(format!("{part}-path.csv")),
            },
            Self::Shots(file) => file.request(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::rigid::RigidTransform;
    use robot::RobotFrame;
    use shell::{
        inspection::{
            inspected::inspected_cell,
            source::{CellChoice, ScanFiles},
        },
        session::Shown,
        workspace::TestShell,
    };

    #[test]
    fn what_is_shown_is_hidden_and_shown_again() {
        let mut shell = TestShell::default();
        let mut state = InspectState::new(&TaskRunner::without_threads());
        for is_shown in [false, true] {
            state.apply(InspectAction::Toggle(ViewPart::Axes), &mut shell.context());
            assert_eq!(state.parts.contains(&ViewPart::Axes), is_shown);
        }
    }

    #[test]
    fn a_picture_waits_for_its_place_and_a_view_that_is_not_there_is_said_once() {
        let mut shell = TestShell::default();
        let mut state = InspectState::new(&TaskRunner::without_threads());
        let none = || {
            Err(UserError {
                what: "no view".into(),
                advice: "mend it".into(),
            })
        };
        // No picture was requested.
        state.take_picture(none(), &mut shell.context());
        assert!(shell.notices().is_empty());
        let chosen = InspectAction::Chosen(InspectFile::Picture, "view".into());
        state.apply(chosen, &mut shell.context());
        assert_eq!(state.picture_to, Some("view".into()));
        state.take_picture(none(), &mut shell.context());
        assert_eq!(
            (shell.notices(), state.wants_picture()),
            (vec!["no view"], false)
        );
        assert!(state.writing().is_none());
    }

    #[test]
    fn escape_shows_the_view_again() {
        let mut shell = TestShell::default();
        let mut state = InspectState::new(&TaskRunner::without_threads());
        state.apply(
            InspectAction::Enlarge(Some(StagePanel::Contour)),
            &mut shell.context(),
        );
        state.on_event(&Event::Escape, &mut shell.context());
        assert_eq!(state.enlarged, None);
    }

    #[test]
    fn the_scan_whose_poses_were_not_found_is_opened_with_the_chosen_file() {
        let mut shell = TestShell::default();
        let mut state = InspectState::new(&TaskRunner::without_threads());
        let scan = ScanFiles::of_folder("scan".into());
        state.shots.ask_for_poses(ScanOrder::Open(scan.clone()));
        let file = PathBuf::from("elsewhere.json");
        assert!(state.shots.wants(&file));
        let chosen = InspectAction::Chosen(InspectFile::Shots(ShotsFile::Poses), file.clone());
        state.apply(chosen, &mut shell.context());
        assert!(!state.shots.wants(&file));
        let with_poses = ScanFiles {
            poses: Some(file),
            ..scan
        };
        assert!(matches!(
            &shell.sent[..],
            [
                Action::UseSource(Source::Scan(files)),
                Action::Inspect {
                    job: InspectJob::Scan(request),
                    purpose: ReinspectionPurpose::New,
                    hung: None,
                    ..
                }
            ] if *files == with_poses
                && matches!(&request.order, ScanOrder::Open(files) if *files == with_poses)
        ));
    }

    #[test]
    fn the_pose_of_an_accepted_part_is_copied_once_the_cell_is_calibrated() {
        let mut shell = TestShell::default();
        let mut state = InspectState::new(&TaskRunner::without_threads());
        state.apply(InspectAction::CopyPose, &mut shell.context());
        assert!(shell.sent.is_empty(), "nothing is shown");
        let found = inspected_cell(CellChoice::InTurn, 1);
        shell.session.shown = Some(Shown::new(1, Arc::new(found)));
        state.apply(InspectAction::CopyPose, &mut shell.context());
        assert_eq!(shell.notices(), ["Not calibrated: the robot gets no pose"]);
        shell.sent.clear();
        shell.session.robot = Some(Arc::new(RobotFrame {
            robot_from_camera: RigidTransform::identity(),
            name: "cell 1".into(),
        }));
        state.apply(InspectAction::CopyPose, &mut shell.context());
        assert!(matches!(
            &shell.sent[..],
            [Action::Notify(_), Action::CopyText(_)]
        ));
    }
}
