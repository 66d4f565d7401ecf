//! The part in three dimensions with its film, the path, and the gun at the time shown.

use std::{f64::consts::TAU, sync::Arc};

use egui::{Rect, Ui, vec2};
use glam::Vec3;
use nalgebra::Vector3;

use super::{
    region::{BRUSH, EditKind, PaintTool, RegionUse, at_depth_of, brushed, corners_of},
    state::PaintState,
    work::{MAGNIFIED, Planned, aim},
};
use crate::workspaces::paint::{state::PaintAction, work::GunState};
use geometry::units::Metres;
use inspection::library::PartName;
use robot::paint::{KeepOut, PathEdit};
use shell::session::{Session, ThemeChoice};
use ui::{
    language::text,
    task::Running,
    theme::space,
    viewport::{
        Colouring, DrawnShape, FitRequest, Legend, Line, LineSet, Role, ScaleWords, StandardView,
        TextLabel, ViewCamera, ViewColours, ViewDirection, ViewError, ViewScene, ViewStyle,
        ViewTool, Viewport, ViewportGpu, drawing, vec3,
    },
};

/// The view of the part.
pub(super) struct PaintView {
    viewport: Viewport,
    camera: ViewCamera,
    style: ViewStyle,
    styled: Option<ThemeChoice>,
    /// The part that the camera was fitted to, and whether its path was there, too.
    fitted: Option<(PartName, bool)>,
    /// The drawn gun, with its path and time.
    gun: Option<(Arc<Planned>, f64, Gun)>,
    /// True while it has the key focus.
    pub(super) has_focus: bool,
}

/// The lines that show the gun.
#[derive(Clone)]
struct Gun {
    lines: LineSet,
    label: TextLabel,
}

/// Largest distance from the pointer at which a point of the path is picked, logical pixels.
const REACH: f32 = 24.0;

/// Size of the marks where the gun is switched on or off, relative to the points of the part.
const MARKS: f32 = 1.2;

/// Width of a view from which controls and scale fit side by side, logical pixels.
const BESIDE_CONTROLS: f32 = 560.0;

/// Range of the film's scale on either side of the target, in tolerances.
const SCALE: f64 = 2.0;

impl PaintView {
    pub(super) fn new(gpu: &Result<ViewportGpu, ViewError>) -> Self {
        Self {
            viewport: Viewport::new(gpu.clone()),
            camera: ViewCamera::default(),
            style: ViewStyle::new(ViewColours::dark()),
            styled: None,
            fitted: None,
            gun: None,
            has_focus: false,
        }
    }

    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        paint: &PaintState,
        session: &Session,
        actions: &mut Vec<PaintAction>,
    ) {
        self.style_as(paint, session.theme);
        self.style.legend = if ui.available_width() < BESIDE_CONTROLS {
            Legend::BelowControls
        } else {
            Legend::Shown
        };
        let scene = self.scene(paint, session);
        self.fit(paint);
        self.viewport.tool = match (paint.tool, self.viewport.tool) {
            (PaintTool::Outline(shape, _), _) => ViewTool::Draw(shape),
            (PaintTool::Brush | PaintTool::Edit(_), _) => ViewTool::Draw(DrawnShape::Way),
            (PaintTool::Look, ViewTool::Draw(_)) => ViewTool::Look,
            (PaintTool::Look, tool) => tool,
        };
        // The path extends beyond the part.
        if self.camera.pending_fit() == Some(FitRequest::Focus) {
            self.camera.request_fit(FitRequest::Everything);
        }
        let rect = ui.available_rect_before_wrap();
        let label = text!("paint-view");
        let seen = self
            .viewport
            .ui(ui, &label, &mut self.camera, &scene, &self.style);
        self.has_focus = seen.response.has_focus();
        // A click with the brush is a trail of one point.
        let clicked = seen.response.interact_pointer_pos();
        let clicked = clicked.filter(|_| seen.response.clicked());
        let clicked = clicked.map(|at| vec![share_of(at, rect)]);
        if let (Some(way), Some(planned)) = (seen.drawn.or(clicked), &paint.planned) {
            actions.extend(self.drawn(&way, planned, paint.tool, rect));
        }
        ViewDirection::buttons(ui, rect, &mut self.camera);
        match paint.planning().filter(|_| paint.planned.is_none()) {
            Some(planning) => self.hint(ui, rect, in_progress(planning)),
            None => self.tool_overlay(ui, rect, paint),
        }
    }

    /// Turns to the front of another part and has all of it in view, also once its path is there, which extends beyond it.
    fn fit(&mut self, paint: &PaintState) {
        let (part, has_path) = match (&paint.planned, &paint.unpainted) {
            (Some(planned), _) => (&planned.part, true),
            (None, Some(unpainted)) => (&unpainted.part, false),
            (None, None) => return,
        };
        let former = self.fitted.as_ref().filter(|(fitted, _)| fitted == part);
        match former.map(|(_, had_path)| *had_path) {
            None => ViewDirection::From(StandardView::Front).apply(&mut self.camera),
            Some(false) if has_path => self.camera.request_fit(FitRequest::Everything),
            Some(_) => return,
        }
        self.fitted = Some((part.clone(), has_path));
    }

    /// Returns the action for what was drawn; corners are fractions of the view.
    fn drawn(
        &self,
        way: &[glam::Vec2],
        planned: &Planned,
        tool: PaintTool,
        rect: Rect,
    ) -> Option<PaintAction> {
        let surface = &planned.surface;
        let clip_from_part = self.camera.clip_from_world(size_of(rect));
        let regions = match tool {
            PaintTool::Look => return None,
            PaintTool::Edit(kind) => {
                let edit = self.edit(kind, *way.first()?, *way.last()?, planned, rect)?;
                return Some(PaintAction::Edit(edit));
            }
            PaintTool::Brush => brushed(way, surface, &clip_from_part),
            // Ignore a click.
            PaintTool::Outline(..) if way.len() < 3 => return None,
            PaintTool::Outline(_, RegionUse::KeepOut) => vec![KeepOut::Polygon {
                corners: corners_of(way, surface, &clip_from_part),
            }],
            PaintTool::Outline(_, RegionUse::PaintOnly) => vec![KeepOut::Outside {
                areas: vec![corners_of(way, surface, &clip_from_part)],
            }],
        };
        (!regions.is_empty()).then_some(PaintAction::Add(regions))
    }

    /// Returns the correction made by a drag from a point of a stroke.
    fn edit(
        &self,
        kind: EditKind,
        from: glam::Vec2,
        to: glam::Vec2,
        planned: &Planned,
        rect: Rect,
    ) -> Option<PathEdit> {
        let (stroke, point) = self.nearest_point(from, planned, rect)?;
        let handle = aim(&planned.path, point, &planned.coat);
        let handle = nalgebra::Point3::new(handle.x, handle.y, handle.z).cast();
        let clip_from_part = self.camera.clip_from_world(size_of(rect));
        let [from, to] = [from, to].map(|place| at_depth_of(&handle, place, &clip_from_part));
        let by = to - from;
        Some(match kind {
            EditKind::Stroke => PathEdit::Stroke { stroke, by },
            EditKind::Point => PathEdit::Point { point, by },
            EditKind::Turn => PathEdit::Turn { point, by },
        })
    }

    /// Finds the stroke point seen nearest to a place, and its stroke; `None` if none is within reach.
    fn nearest_point(
        &self,
        place: glam::Vec2,
        planned: &Planned,
        rect: Rect,
    ) -> Option<(usize, usize)> {
        let size = size_of(rect);
        let strokes = planned.course.strokes.iter().enumerate();
        let points = strokes
            .flat_map(|(stroke, [first, last])| (*first..=*last).map(move |point| (stroke, point)));
        let seen = points.filter_map(|(stroke, point)| {
            let at = aim(&planned.path, point, &planned.coat);
            let at = self.camera.screen_from_world(at, size)?;
            Some((stroke, point, at.distance(place * size)))
        });
        let nearest = seen.min_by(|a, b| a.2.total_cmp(&b.2));
        let nearest = nearest.filter(|(_, _, off)| *off <= REACH);
        nearest.map(|(stroke, point, _)| (stroke, point))
    }

    /// Draws the shape being drawn, or a hint on how to draw.
    fn tool_overlay(&self, ui: &mut Ui, rect: Rect, paint: &PaintState) {
        let painter = ui.painter_at(rect);
        let colours = &self.style.colours;
        let (title, hint) = match paint.tool {
            PaintTool::Look => return,
            PaintTool::Brush => (text!("paint-keep-out"), text!("paint-brush-hint")),
            PaintTool::Outline(_, RegionUse::KeepOut) => {
                (text!("paint-keep-out"), text!("paint-keep-out-hint"))
            }
            PaintTool::Outline(_, RegionUse::PaintOnly) => {
                (text!("paint-only"), text!("paint-only-hint"))
            }
            PaintTool::Edit(EditKind::Stroke) => (String::new(), text!("paint-move-stroke-hint")),
            PaintTool::Edit(EditKind::Point) => (String::new(), text!("paint-move-point-hint")),
            PaintTool::Edit(EditKind::Turn) => (String::new(), text!("paint-turn-gun-hint")),
        };
        let shape = match paint.tool {
            PaintTool::Outline(shape, _) => shape,
            PaintTool::Look | PaintTool::Brush | PaintTool::Edit(_) => DrawnShape::Way,
        };
        let corners = self.viewport.drawing.corners(shape);
        let bright = colours.role(Role::Measure).colour;
        let stroke = egui::Stroke::new(2.0, bright);
        let pointer = ui.input(|input| input.pointer.hover_pos());
        let pointer = pointer.filter(|at| rect.contains(*at));
        match paint.tool {
            PaintTool::Brush => {
                let radius = self.pixels(BRUSH, rect);
                for at in &corners {
                    painter.circle_filled(*at, radius, bright.gamma_multiply(0.35));
                }
                if let Some(at) = pointer {
                    painter.circle_stroke(at, radius, stroke);
                }
            }
            PaintTool::Edit(_) => {
                let from = corners.first().copied().or(pointer);
                let handle = from.zip(paint.planned.as_ref()).and_then(|(at, planned)| {
                    let (_, point) = self.nearest_point(share_of(at, rect), planned, rect)?;
                    let at = aim(&planned.path, point, &planned.coat);
                    self.camera.screen_from_world(at, size_of(rect))
                });
                if let Some(handle) = handle {
                    let handle = rect.min + vec2(handle.x, handle.y);
                    painter.circle_stroke(handle, 7.0, stroke);
                    if let (Some(first), Some(last)) = (corners.first(), corners.last()) {
                        painter.arrow(handle, *last - *first, stroke);
                    }
                }
            }
            PaintTool::Look | PaintTool::Outline(..) => {
                drawing::outline(&painter, &corners, &title, colours);
            }
        }
        // The hint would cover the part while a person draws.
        if corners.is_empty() {
            self.hint(ui, rect, hint);
        }
    }

    /// Draws a hint at the bottom of the view.
    fn hint(&self, ui: &mut Ui, rect: Rect, hint: String) {
        let place = rect.with_min_y(rect.bottom() - 2.0 * space::TARGET);
        drawing::hint(ui, place.shrink(space::SMALL), hint, &self.style.colours);
    }

    /// Approximate size of a length in logical pixels at the camera's target.
    fn pixels(&self, metres: f64, rect: Rect) -> f32 {
        let size = size_of(rect);
        let target = self.camera.target();
        let beside = target + self.camera.right() * metres as f32;
        let [a, b] = [target, beside].map(|at| self.camera.screen_from_world(at, size));
        a.zip(b).map_or(8.0, |(a, b)| a.distance(b))
    }

    fn style_as(&mut self, paint: &PaintState, theme: ThemeChoice) {
        if self.styled != Some(theme) {
            self.style = ViewStyle::new(ViewColours::of(theme));
            // Make the marks of the gun going on and off visible from afar.
            for role in [Role::AxisX, Role::AxisY] {
                self.style.colours.roles[role as usize].weight = MARKS;
            }
            self.styled = Some(theme);
        }
        // Enrolled parts are thinned; points of this size look closed from afar.
        let look_closed = |spacing: f64| Metres(1.9 * spacing);
        let Some(planned) = &paint.planned else {
            if let Some(unpainted) = &paint.unpainted {
                self.style.point_size = look_closed(unpainted.spacing);
            }
            self.style.colouring = Colouring::Plain;
            return;
        };
        let coat = &planned.coat;
        self.style.point_size = look_closed(planned.surface.spacing);
        let range = SCALE * coat.tolerance * coat.target;
        self.style.deviation_range = Metres(range * MAGNIFIED);
        self.style.scale_words = ScaleWords::Film {
            target: Metres(coat.target),
            range: Metres(range),
        };
        self.style.colouring = if paint.is_film_shown {
            Colouring::Deviation
        } else {
            Colouring::Plain
        };
    }

    fn scene(&mut self, paint: &PaintState, session: &Session) -> ViewScene {
        let Some(planned) = &paint.planned else {
            let unpainted = paint.unpainted.iter();
            return ViewScene {
                points: unpainted.map(|part| part.points.clone()).collect(),
                ..ViewScene::default()
            };
        };
        let [on, off] = planned.marks.clone();
        let gun = self.gun(planned, paint.time, session);
        let mut lines = vec![planned.lines.clone(), gun.lines];
        if let Some(Ok(reach)) = paint.reach(session) {
            lines.push(reach.lines.clone());
        }
        ViewScene {
            points: vec![planned.points.clone(), on, off],
            lines,
            labels: vec![gun.label],
        }
    }

    /// Returns the drawn gun, made again only if it has moved.
    fn gun(&mut self, planned: &Arc<Planned>, time: f64, session: &Session) -> Gun {
        if let Some((of, at, gun)) = &self.gun
            && Arc::ptr_eq(of, planned)
            && (*at - time).abs() < 1e-9
        {
            return gun.clone();
        }
        let state = planned.course.at(&planned.path, planned.coat.speed, time);
        let gun = drawn_gun(planned, &state, session);
        self.gun = Some((Arc::clone(planned), time, gun.clone()));
        gun
    }
}

/// Describes a running job and how far it is.
fn in_progress(job: &Running) -> String {
    let work = job.title.clone();
    match job.progress {
        Some((done, total)) => {
            text!("shell-progress", work = work, done = done, total = total)
        }
        None => work,
    }
}

fn size_of(rect: Rect) -> glam::Vec2 {
    glam::Vec2::new(rect.width(), rect.height())
}

/// Converts a position on the screen to fractions of the view.
fn share_of(at: egui::Pos2, rect: Rect) -> glam::Vec2 {
    let share = (at - rect.min) / rect.size();
    glam::Vec2::new(share.x, share.y)
}

/// Draws the jet's axis, its pattern on the surface, and a label with stand-off, speed and angle.
fn drawn_gun(planned: &Planned, gun: &GunState, session: &Session) -> Gun {
    let surface = &planned.surface;
    let coat = &planned.coat;
    let jet = gun.direction.into_inner();
    let aim = gun.nozzle + jet * coat.stand_off;
    let off = |p: &nalgebra::Point3<f64>| (p - aim).norm_squared();
    let nearest = surface.points.iter().enumerate();
    let nearest = nearest.min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
    // Beside the part there is no stand-off to show.
    let near = nearest.filter(|(_, p)| off(p).sqrt() < 3.0 * surface.spacing);
    let mut words = Vec::new();
    if let Some((index, p)) = near {
        words.push(session.units.length((p - gun.nozzle).dot(&jet)));
        words.push(speed_text(gun.speed));
        let facing = -surface.normals[index].dot(&jet);
        words.push(session.units.angle(facing.clamp(-1.0, 1.0).acos()));
    } else {
        words.push(speed_text(gun.speed));
    }
    if !gun.is_on {
        words.push(text!("paint-gun-off"));
    }
    let across = if jet.x.abs() < 0.9 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    let u = (across - jet * jet.dot(&across)).normalize();
    let v = jet.cross(&u);
    let radius = coat.gun.depth * coat.stand_off / coat.gun.distance / 2.0;
    let ring = |centre: nalgebra::Point3<f64>, radius: f64| -> Vec<Vec3> {
        let angles = (0..=32).map(|i| TAU * f64::from(i) / 32.0);
        let each = angles.map(|a| vec3(&(centre + (u * a.cos() + v * a.sin()) * radius)));
        each.collect()
    };
    let role = if gun.is_on {
        Role::Measure
    } else {
        Role::Nozzle
    };
    let lines = vec![
        Line::new(vec![vec3(&gun.nozzle), vec3(&aim)], role),
        Line::new(ring(gun.nozzle, 0.012), role),
        Line::new(ring(aim - jet * 0.01, radius), role).with_width(1.5),
    ];
    Gun {
        lines: LineSet::new(lines),
        label: TextLabel {
            at: vec3(&aim),
            text: words.join(" · "),
        },
    }
}

/// Formats a speed in mm/s, as paint shops write it.
pub(super) fn speed_text(speed: f64) -> String {
    format!("{:.0} mm/s", 1000.0 * speed)
}
