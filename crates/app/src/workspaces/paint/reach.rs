//! Which points of the path the robot's arm reaches without a collision, and the program for its controller.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
};

use glam::Vec3;
use nalgebra::{Point3, Vector3};

use super::{
    state::PaintState,
    work::{Planned, aim, enrolled},
};
use geometry::{cloud::PointCloud, rigid::RigidTransform};
use inspection::library::Side;
use robot::{
    RobotFrame,
    arm::{
        ArmError, CheckParams, FilmRoom, Obstacles, PathCheck, PlaceSuggestion, check_path,
        suggest_base, suggest_rail,
    },
    program::{RobotLanguage, arm_points},
    spray::{CarriedPath, OffThePart, carry, off_the_part},
};
use shell::{
    cell::ProgramSetup,
    inspection::{
        library_cache::LibraryCache,
        report_files::{self, ProgramTarget, WrittenForRobot, remove_earlier},
        source::file_name,
    },
    notice::Notice,
    session::{Session, WorkspaceKind},
    workspace::ShellContext,
};
use stages::{reference::Coverage, stand_off::StandOffParams};
use station::robot_file::{RobotFile, Unchecked};
use ui::{
    language::text,
    task::{TaskContext, TaskError},
    user_error::UserError,
    viewport::{Line, LineSet, Role, furniture, vec3},
};

/// Input of a reach check.
#[derive(Clone, Debug)]
pub(super) struct ReachRequest {
    planned: Arc<Planned>,
    setup: ProgramSetup,
    robot: Arc<RobotFrame>,
}

impl PartialEq for ReachRequest {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.planned, &other.planned)
            && (&self.setup, &self.robot) == (&other.setup, &other.robot)
    }
}

/// The points of a path that an arm reaches, with the part in its standard position.
#[derive(Clone, Debug)]
pub struct Reach {
    /// Name of the arm.
    pub arm: String,
    /// The result for every point of the path.
    pub check: PathCheck,
    /// A position of its base that reaches more points.
    pub base: Option<PlaceSuggestion>,
    /// A position on its rail that reaches more points.
    pub rail: Option<PlaceSuggestion>,
    /// Direction of its rail in the frame of the calibration.
    pub rail_direction: Option<Vector3<f64>>,
    /// What is not checked.
    pub unchecked: Vec<Unchecked>,
    /// The positions, metres, between which its rail moves along the path; `None` for a rail that stands still.
    pub rail_range: Option<[f64; 2]>,
    /// Lines over the points not reached, and the boxes of the cell.
    pub(super) lines: LineSet,
}

impl Reach {
    /// Reasons why points are not reached with their numbers of points, the most frequent first.
    pub fn reasons(&self) -> Vec<(String, usize)> {
        let mut reasons: Vec<(String, usize)> = Vec::new();
        let problems = self.check.points.iter().map(|point| &point.problem);
        for problem in problems.flatten() {
            let reason = problem.reason();
            match reasons.iter_mut().find(|(known, _)| *known == reason) {
                Some((_, count)) => *count += 1,
                None => reasons.push((reason, 1)),
            }
        }
        reasons.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        reasons
    }
}

impl PaintState {
    /// The reach of the path shown, or why it is unknown; `None` while it is being checked, or without an arm and a
    /// calibrated cell.
    pub fn reach(&self, session: &Session) -> Option<&Result<Arc<Reach>, UserError>> {
        let is_asked = self.reach_request(session) == self.reach_asked;
        self.reach.as_ref().filter(|_| is_asked)
    }

    /// The reach check needed now.
    pub(super) fn reach_request(&self, session: &Session) -> Option<ReachRequest> {
        session.program.arm.as_ref()?;
        Some(ReachRequest {
            planned: Arc::clone(self.planned.as_ref()?),
            setup: session.program.clone(),
            robot: Arc::clone(session.robot.as_ref()?),
        })
    }

    /// Takes in the result, and starts a check if one is needed.
    pub(super) fn update_reach(&mut self, cx: &ShellContext<'_>) {
        while let Some(reach) = self.reach_task.poll() {
            self.reach = Some(reach);
        }
        let wanted = self.reach_request(cx.session);
        if cx.session.workspace != WorkspaceKind::Paint || wanted == self.reach_asked {
            return;
        }
        self.reach_asked.clone_from(&wanted);
        self.reach = None;
        self.reach_task.cancel();
        if let Some(request) = wanted {
            let library_cache = cx.services.library_cache.clone();
            self.reach_task
                .start(text!("paint-checking-reach"), move |context| {
                    found(&request, &library_cache, context)
                });
        }
    }

    /// Moves to the next point not reached, wrapping at the end.
    pub(super) fn show_unreached(&mut self, session: &Session) {
        let (Some(Ok(reach)), Some(planned)) = (self.reach(session), &self.planned) else {
            return;
        };
        let points = reach.check.points.iter().enumerate();
        let times = points.filter(|(_, point)| point.problem.is_some());
        let times: Vec<f64> = times.map(|(i, _)| planned.course.seconds[i]).collect();
        let next = times.iter().find(|time| **time > self.time + 1e-6);
        if let Some(time) = next.or_else(|| times.first()).copied() {
            self.go_to(time);
        }
    }

    /// Why no program of the path shown can be written, as far as known.
    pub(super) fn why_no_program(&self, session: &Session) -> Option<UserError> {
        match self.reach(session) {
            Some(Ok(reach)) => report_files::not_reached(&reach.arm, &reach.check),
            Some(Err(error)) => Some(error.clone()),
            None => session.program.target().err(),
        }
    }

    /// Writes the program of the path shown.
    pub(super) fn export_program(&mut self, file: PathBuf, cx: &ShellContext<'_>) {
        let (Some(planned), Some(robot)) = (self.planned.clone(), cx.session.robot.clone()) else {
            return;
        };
        let setup = cx.session.program.clone();
        let library_cache = cx.services.library_cache.clone();
        let name = file_name(&file);
        self.writing
            .start(text!("shell-writing", file = name), move |_| {
                let written = write_program(&file, &planned, &setup, &robot, &library_cache)?;
                Ok(Notice::of_robot_file(written))
            });
    }
}

/// A path in its part's standard position.
struct StandardPath {
    carried: CarriedPath,
    part_cloud: Arc<PointCloud>,
    coverage: Coverage,
    side: Option<Side>,
    off: Option<OffThePart>,
    is_simulated: bool,
}

fn in_standard_position(
    planned: &Planned,
    library_cache: &LibraryCache,
) -> Result<StandardPath, UserError> {
    let loaded = library_cache.get();
    let (index, reference) = enrolled(&loaded, &planned.part)?;
    let carried = carry(
        &planned.path,
        &RigidTransform::identity(),
        &reference.cloud,
        &StandOffParams::default(),
    );
    let part = &loaded.shown.parts[index];
    Ok(StandardPath {
        carried,
        part_cloud: Arc::clone(&reference.cloud),
        coverage: part.coverage,
        side: part.side,
        off: off_the_part(&planned.path, reference),
        is_simulated: part.simulated,
    })
}

/// Finds which points are reached, then positions that reach more.
fn found(
    request: &ReachRequest,
    library_cache: &LibraryCache,
    context: &TaskContext<Arc<Reach>>,
) -> Result<Arc<Reach>, TaskError> {
    let planned = &request.planned;
    if request.setup.nozzle.trim().is_empty() {
        return Err(TaskError::Failed(UserError {
            what: text!("program-no-nozzle"),
            // The field for it is in this workspace.
            advice: text!("paint-no-nozzle-advice"),
        }));
    }
    let ProgramTarget { settings, arm } = request.setup.target()?;
    let Some(arm) = arm else {
        return Err(TaskError::Cancelled);
    };
    let path = in_standard_position(planned, library_cache)?;
    context.check()?;
    let robot_from_part = request.robot.robot_from_part(&RigidTransform::identity());
    let arm = arm.with_part(&path.part_cloud.points, &robot_from_part);
    let points = arm_points(&path.carried, &request.robot, settings.params.speed);
    let film = FilmRoom::of_path(&planned.path, &path.part_cloud, path.coverage, path.side);
    let params = CheckParams {
        film: film.as_ref(),
        ..settings.params.check_params()
    };
    let failed = |error: ArmError| match error {
        ArmError::Cancelled => TaskError::Cancelled,
        error => TaskError::Failed(UserError::of(&error)),
    };
    let check = check_path(&arm, &points, &params).map_err(failed)?;
    let num = check.num_reached();
    let mut lines = unreached(planned, &check);
    lines.extend(outlines(&arm.obstacles, &robot_from_part));
    let moving = arm.arm.moving_rail();
    let mut reach = Reach {
        arm: arm.arm.name.clone(),
        unchecked: Unchecked::of_arm(Some(&arm)),
        rail_range: moving.map(|_| check.rail_range()),
        rail_direction: arm.arm.rail.map(|rail| rail.direction.into_inner()),
        lines: LineSet::new(lines),
        check,
        base: None,
        rail: None,
    };
    if num < points.len() {
        // Finding positions takes longer than the check.
        context.partial(Arc::new(reach.clone()));
        let progress = |done, total| context.progress(done, total);
        let is_cancelled = || context.check().is_err();
        reach.rail =
            suggest_rail(&arm, &points, &params, num, &progress, &is_cancelled).map_err(failed)?;
        reach.base =
            suggest_base(&arm, &points, &params, num, &progress, &is_cancelled).map_err(failed)?;
    }
    Ok(Arc::new(reach))
}

/// Half the length of the line over a single point not reached, metres.
const HALF: f32 = 0.01;

/// Returns a line from each unreached point to the next, or a short one if the next is reached.
fn unreached(planned: &Planned, check: &PathCheck) -> Vec<Line> {
    let is_bad = |i: usize| check.points.get(i).is_some_and(|p| p.problem.is_some());
    let at = |i: usize| aim(&planned.path, i, &planned.coat);
    let bad = (0..check.points.len()).filter(|i| is_bad(*i));
    let lines = bad.map(|i| {
        let stretch = if is_bad(i + 1) {
            vec![at(i), at(i + 1)]
        } else {
            vec![at(i) - Vec3::Y * HALF, at(i) + Vec3::Y * HALF]
        };
        Line::new(stretch, Role::AxisX).with_width(4.0)
    });
    lines.collect()
}

/// The edges of the boxes of the cell, in the part's frame.
fn outlines(obstacles: &Obstacles, robot_from_part: &RigidTransform) -> Vec<Line> {
    let part_from_robot = robot_from_part.inverse();
    let in_part = |corner: Point3<f64>| vec3(&(part_from_robot * corner));
    let boxes = obstacles.boxes();
    boxes
        .flat_map(|corners| furniture::box_edges(corners.map(in_part), Role::Rest))
        .collect()
}

/// Writes the program of a path in the part's standard position.
pub(super) fn write_program(
    file: &Path,
    planned: &Planned,
    setup: &ProgramSetup,
    robot: &RobotFrame,
    library_cache: &LibraryCache,
) -> Result<WrittenForRobot, UserError> {
    remove_earlier(file)?;
    let language = RobotLanguage::from_file(file).map_err(|error| UserError::of(&error))?;
    let path = in_standard_position(planned, library_cache)?;
    let target = setup.target()?;
    report_files::robot_file(&RobotFile {
        file,
        content: target.content(language),
        carried: &path.carried,
        frame: robot,
        part: planned.part.as_str(),
        part_cloud: &path.part_cloud,
        coverage: path.coverage,
        side: path.side,
        path: Some(&planned.path),
        off: path.off,
        capture: None,
        beside: &[],
        camera_from_part: RigidTransform::identity(),
        is_stored: true,
        is_simulated: path.is_simulated,
        is_forced: false,
    })
}
