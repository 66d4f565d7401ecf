//! Part, camera, target and nozzle in space, and the way so far.

use std::sync::Arc;

use egui::{Ui, vec2};
use glam::Vec3;
use nalgebra::Point3;

use super::{state::ServoPageState, work::RunView};
use geometry::{
    depth_frame::Intrinsics, oriented_box::OrientedBox, rigid::RigidTransform, units::Metres,
};
use robot::calibration::CameraPlace;
use servo::{Standing, Target, Task};
use shell::session::{Session, ThemeChoice};
use ui::{
    language::{Language, text},
    theme::{Theme, space},
    viewport::{
        FitRequest, Line, LineSet, PointSet, Role, StandardView, TextLabel, ViewCamera,
        ViewColours, ViewDirection, ViewError, ViewScene, ViewStyle, Viewport, ViewportGpu,
        colour_keys,
        furniture::{axes, box_edges, frustum},
        scene::mat4,
        vec3,
    },
    widgets::sentence,
};

/// How deep the drawn picture of a camera is.
const CAMERA_DEPTH: Metres = Metres(0.16);
/// Length of the axes of a frame.
const AXES: Metres = Metres(0.09);
/// The first view is from the side and above, so that the camera's way is seen: angles in radians.
const FROM: [f32; 2] = [-0.9, 0.45];

/// The view.
pub(super) struct RunSceneView {
    viewport: Viewport,
    camera: ViewCamera,
    style: ViewStyle,
    styled: Option<ThemeChoice>,
    /// The run that is shown, and its world: that of the camera at the target.
    world: Option<Anchor>,
    /// The scene as it was drawn last, and what it was made from.
    drawn: Option<(Drawn, ViewScene, Vec<Meaning>)>,
    /// True while it has the key focus.
    pub(super) has_focus: bool,
}

/// What a scene is made from, beside its run.
#[derive(Clone, Copy, PartialEq)]
struct Drawn {
    num_looks: usize,
    is_final: bool,
    language: Language,
}

#[derive(Clone)]
struct Anchor {
    task: Arc<Task>,
    world_from_robot: RigidTransform,
    /// True once the target is known.
    is_final: bool,
}

/// What is drawn with which meaning.
#[derive(Clone, Copy)]
struct Meaning {
    role: Role,
    name: fn() -> String,
}

const PART: Meaning = Meaning {
    role: Role::Part,
    name: || text!("shell-part"),
};
const CAMERA: Meaning = Meaning {
    role: Role::Moving,
    name: || sentence(&text!("robot-camera")),
};
const TARGET: Meaning = Meaning {
    role: Role::SeenOnce,
    name: || text!("servoing-target"),
};
const NOZZLE: Meaning = Meaning {
    role: Role::Nozzle,
    name: || text!("servoing-nozzle"),
};
const FLANGE: Meaning = Meaning {
    role: Role::Measure,
    name: || text!("servoing-flange"),
};
const VOLUME: Meaning = Meaning {
    role: Role::Rest,
    name: || text!("rack-volume"),
};

impl RunSceneView {
    pub(super) fn new(gpu: &Result<ViewportGpu, ViewError>) -> Self {
        Self {
            viewport: Viewport::new(gpu.clone()),
            camera: ViewCamera::default(),
            style: ViewStyle::new(ViewColours::dark()),
            styled: None,
            world: None,
            drawn: None,
            has_focus: false,
        }
    }

    pub(super) fn ui(&mut self, ui: &mut Ui, state: &ServoPageState, session: &Session) {
        if self.styled != Some(session.theme) {
            self.style = ViewStyle {
                // The cloud of a reference is thinned.
                point_size: Metres(0.0075),
                ..ViewStyle::new(ViewColours::of(session.theme))
            };
            self.styled = Some(session.theme);
        }
        let shown = state.shown.as_deref();
        let drawn = shown.and_then(|shown| Some((shown, shown.task.clone()?, shown.standing?)));
        let Some((shown, task, standing)) = drawn else {
            self.has_focus = false;
            empty(ui, state);
            return;
        };
        let world = self.world_of(&task, &standing);
        let key = Drawn {
            num_looks: shown.num_looks,
            is_final: world.is_final,
            language: Language::current(),
        };
        // Sets made anew would be uploaded anew.
        let known = self.drawn.take().filter(|(known, ..)| *known == key);
        let (_, scene, meanings) = known.unwrap_or_else(|| {
            let (scene, meanings) = scene_of(shown, &task, &standing, &world.world_from_robot);
            (key, scene, meanings)
        });
        if self.camera.pending_fit() == Some(FitRequest::Focus) {
            self.camera.request_fit(FitRequest::Everything);
        }
        let rect = ui.available_rect_before_wrap();
        let label = text!("servoing-view");
        let seen = self
            .viewport
            .ui(ui, &label, &mut self.camera, &scene, &self.style);
        self.has_focus = seen.response.has_focus();
        ViewDirection::buttons(ui, rect, &mut self.camera);
        let keys = meanings.iter().map(|meaning| {
            let colour = self.style.colours.role(meaning.role).colour;
            (colour, (meaning.name)())
        });
        let keys: Vec<_> = keys.collect();
        let corner = rect.left_bottom() + vec2(space::SMALL, -space::SMALL);
        colour_keys(&ui.painter_at(rect), corner, &keys, Theme::of(ui));
        self.drawn = Some((key, scene, meanings));
    }

    /// The world of a run: that of the camera at the target, once it is known; before, where the camera is.
    fn world_of(&mut self, task: &Arc<Task>, standing: &Standing) -> Anchor {
        let known = self.world.as_ref();
        if let Some(known) = known.filter(|known| Arc::ptr_eq(&known.task, task))
            && (known.is_final || standing.robot_from_goal.is_none())
        {
            return known.clone();
        }
        let flange = standing
            .robot_from_goal
            .unwrap_or(standing.robot_from_flange);
        let world = Anchor {
            task: Arc::clone(task),
            world_from_robot: camera_at(task, &flange).inverse(),
            is_final: standing.robot_from_goal.is_some(),
        };
        ViewDirection::From(StandardView::Front).apply(&mut self.camera);
        self.camera.turn(FROM[0], FROM[1]);
        self.camera.request_fit(FitRequest::Everything);
        self.world = Some(world.clone());
        self.drawn = None;
        world
    }
}

/// The camera's pose with the flange here.
fn camera_at(task: &Task, robot_from_flange: &RigidTransform) -> RigidTransform {
    match &task.camera {
        CameraPlace::Fixed { robot_from_camera } => *robot_from_camera,
        CameraPlace::OnFlange {
            flange_from_camera, ..
        } => robot_from_flange * flange_from_camera,
    }
}

/// The scene of a run, and what its colours mean.
fn scene_of(
    shown: &RunView,
    task: &Task,
    standing: &Standing,
    world_from_robot: &RigidTransform,
) -> (ViewScene, Vec<Meaning>) {
    let mut scene = ViewScene::default();
    let mut meanings = Vec::new();
    let flange = standing.robot_from_flange;
    let on = |flange: &RigidTransform, pose: &RigidTransform| {
        let robot_from_it = if task.is_part_held() {
            flange * pose
        } else {
            *pose
        };
        world_from_robot * robot_from_it
    };
    let label = |scene: &mut ViewScene, pose: &RigidTransform, meaning: Meaning| {
        scene.labels.push(TextLabel {
            at: vec3(&(pose * Point3::origin())),
            text: (meaning.name)(),
        });
    };
    if let (Some(points), Some(in_place)) = (&shown.points, &standing.part_in_place) {
        let pose = on(&flange, in_place);
        let mut set = points.clone();
        set.world_from_set = mat4(&pose);
        scene.points.push(set);
        scene.labels.push(TextLabel {
            at: vec3(&(pose * task.middle)),
            text: (PART.name)(),
        });
        meanings.push(PART);
    }
    let mut trail = PointSet::new(shown.trail.clone(), CAMERA.role);
    trail.world_from_set = mat4(world_from_robot);
    scene.points.push(trail);
    let camera = world_from_robot * camera_at(task, &flange);
    draw_camera(&mut scene, &camera, CAMERA.role, false);
    label(&mut scene, &camera, CAMERA);
    meanings.push(CAMERA);
    let flange_pose = world_from_robot * flange;
    scene.lines.push(axes(AXES).at(&flange_pose));
    let to = |point: Vec3| Line::new([Vec3::ZERO, point], FLANGE.role);
    let flange_from_camera = flange_pose.inverse() * camera;
    if matches!(task.camera, CameraPlace::OnFlange { .. }) {
        let at = vec3(&Point3::from(flange_from_camera.translation.vector));
        scene.lines.push(LineSet::new([to(at)]).at(&flange_pose));
    }
    label(&mut scene, &flange_pose, FLANGE);
    meanings.push(FLANGE);
    if let Some(nozzle) = &shown.nozzle {
        let mouth = vec3(nozzle);
        let line = Line::new([Vec3::ZERO, mouth], NOZZLE.role).with_width(3.0);
        scene.lines.push(LineSet::new([line]).at(&flange_pose));
        scene.labels.push(TextLabel {
            at: vec3(&(flange_pose * nozzle)),
            text: (NOZZLE.name)(),
        });
        meanings.push(NOZZLE);
    }
    if let Some(volume) = &shown.volume {
        scene.lines.push(volume_edges(volume).at(world_from_robot));
        meanings.push(VOLUME);
    }
    if let Some(goal) = &standing.robot_from_goal {
        draw_target(&mut scene, shown, task, standing, goal, world_from_robot);
        meanings.push(TARGET);
    }
    (scene, meanings)
}

fn volume_edges(volume: &OrientedBox) -> LineSet {
    let corners = volume.corners().map(|corner| vec3(&corner));
    let edges = box_edges(corners, VOLUME.role);
    let dashed: Vec<Line> = edges.map(Line::dashed).collect();
    LineSet::new(dashed)
}

/// Draws where it should be: the camera, the part that the arm holds, or the nozzle.
fn draw_target(
    scene: &mut ViewScene,
    shown: &RunView,
    task: &Task,
    standing: &Standing,
    goal: &RigidTransform,
    world_from_robot: &RigidTransform,
) {
    let pose = match &task.target {
        Target::Nozzle {
            flange_from_nozzle, ..
        } => {
            let pose = world_from_robot * goal * flange_from_nozzle;
            scene.lines.push(axes(AXES).at(&pose));
            pose
        }
        Target::SeenAt { .. } if task.is_part_held() => {
            let Some(in_place) = &standing.part_in_place else {
                return;
            };
            let pose = world_from_robot * goal * in_place;
            if let Some(points) = &shown.points {
                let mut set = PointSet::new(points.positions().to_vec(), TARGET.role);
                set.world_from_set = mat4(&pose);
                scene.points.push(set);
            }
            pose
        }
        Target::SeenAt { .. } => {
            let pose = world_from_robot * camera_at(task, goal);
            draw_camera(scene, &pose, TARGET.role, true);
            pose
        }
    };
    scene.labels.push(TextLabel {
        at: vec3(&(pose * Point3::origin())),
        text: (TARGET.name)(),
    });
}

/// Draws a camera with its axes.
fn draw_camera(scene: &mut ViewScene, pose: &RigidTransform, role: Role, is_dashed: bool) {
    let outline = frustum(&Intrinsics::KINECT, CAMERA_DEPTH);
    let lines = outline.lines().iter().map(|line| Line {
        role,
        width: 2.5,
        is_dashed,
        ..line.clone()
    });
    let lines: Vec<Line> = lines.collect();
    scene.lines.push(LineSet::new(lines).at(pose));
    scene.lines.push(axes(AXES).at(pose));
}

/// Draws the area before a run has something to show.
fn empty(ui: &mut Ui, state: &ServoPageState) {
    let (what, advice) = if state.is_running() {
        (text!("servoing-begins"), String::new())
    } else {
        (
            text!("servoing-nothing-yet"),
            text!("servoing-nothing-yet-advice"),
        )
    };
    ui.vertical_centered(|ui| {
        ui.add_space(ui.available_height() * 0.4);
        ui.heading(what);
        ui.add_space(space::SMALL);
        ui.weak(advice);
    });
}
