//! The scene in three dimensions, the part coloured by its deviation from the reference.

use std::{collections::BTreeSet, sync::Arc};

use egui::{Color32, Key, Modifiers, Painter, Rect, Ui, UiBuilder, Vec2, pos2, vec2};

use super::{
    controls,
    frame_parts::numbered,
    headline::{Headline, HeadlineState},
    state::{InspectState, ViewPart},
    surface::region_words,
};
use crate::{
    shots::{Overlay, POINT_SIZE},
    workspaces::inspect::state::InspectAction,
};
use geometry::{oriented_box::OrientedBox, rigid::RigidTransform, units::Metres};
use inspection::rack::Rack;
use records::history::HungId;
use shell::{
    inspection::{inspected::Inspected, scene_figure::SprayFigure},
    language::UnitSystem,
    session::{Session, Shown},
};
use ui::{
    language::text,
    theme::{ROUNDING, Theme, font, space},
    user_error::UserError,
    viewport::{
        Colouring, FitRequest, Legend, Line, LineSet, Role, StandardView, TextLabel, ViewCamera,
        ViewColours, ViewDirection, ViewError, ViewScene, ViewShot, ViewStyle, Viewport,
        ViewportGpu, colour_keys, furniture, vec3,
    },
    widgets::grouped,
};

/// Work done since the window was opened. A frame in which nothing changes adds none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WorkCounts {
    /// Point and line sets copied to the device.
    pub uploads: u64,
    /// Renderings of the 3-D view.
    pub pictures: u64,
    /// Preparations of textures, or of lines and texts.
    pub made: u64,
}

/// Ends of the deviation scale: a few times a depth camera's noise, so that a dent shows and noise does not.
const DEVIATION_RANGE: Metres = Metres(0.01);
/// Length of the axes of the robot base, longer than others because it is farther away than the part.
const BASE_AXES: Metres = Metres(0.3);
/// How far the colour of a point that the scale does not colour is mixed with the background; `DIMMED` in points.wgsl.
const DIMMED: f32 = 0.4;
/// Width of the colour scale, logical pixels; it is below the controls where they leave less.
const LEGEND_WIDTH_PX: f32 = 212.0;

/// What determines the lines and texts of a scene.
#[derive(PartialEq)]
struct SceneAnnotation {
    parts: BTreeSet<ViewPart>,
    units: UnitSystem,
    camera_from_robot: Option<RigidTransform>,
    looked_at: Option<usize>,
    has_overlay: bool,
    rack: Rack,
}

/// The view of the last result.
pub(super) struct SceneView {
    pub(super) viewport: Viewport,
    pub(super) camera: ViewCamera,
    scene: ViewScene,
    pub(super) style: ViewStyle,
    /// What the present lines and texts were made for.
    placed: Option<SceneAnnotation>,
    num_placed: u64,
    /// True while it has the key focus; the space bar still captures.
    pub(super) has_focus: bool,
    caption: String,
    origin: Option<String>,
    /// The first part of the frame shown.
    first_part: Option<Arc<Inspected>>,
    /// The followed source whose frame is shown.
    session: Option<u64>,
    /// The part that was framed last for the operator, and whether its verdict counted by then.
    framed: Option<(HungId, bool)>,
    /// Number of the result that was framed last for the operator, or needed no framing.
    looked_at: Option<u64>,
    /// For a scan: the camera pose that defines the frame shown.
    space: Option<RigidTransform>,
    /// Size of the view in the last frame, logical pixels.
    size: Vec2,
    /// Width of the controls in the last frame with their left margin, logical pixels.
    controls_width: f32,
}

impl SceneView {
    pub(super) fn new(gpu: Result<ViewportGpu, ViewError>) -> Self {
        let mut camera = ViewCamera::default();
        camera.request_fit(FitRequest::Focus);
        Self {
            viewport: Viewport::new(gpu),
            camera,
            scene: ViewScene::default(),
            style: ViewStyle::new(ViewColours::dark()),
            placed: None,
            num_placed: 0,
            has_focus: false,
            caption: String::new(),
            origin: None,
            first_part: None,
            session: None,
            framed: None,
            looked_at: None,
            space: None,
            size: Vec2::splat(1.0),
            controls_width: 0.0,
        }
    }

    /// Shows a new result, as prepared by the task; does not touch its points.
    pub(super) fn show(&mut self, shown: &Shown) {
        let inspected = &shown.inspected;
        let figures = &inspected.figures;
        let parts = shown.parts.iter().map(|part| &part.view.points);
        self.scene.points = vec![inspected.view.points.clone().focused_on(parts)];
        self.placed = None;
        // While a source is followed, keep the view that a person has chosen; else it follows the parts.
        let wants_more = shown.session.is_some() && self.session == shown.session;
        // The same scan with other shots is still at the same place.
        let space = inspected.scan.as_ref().and_then(|scan| scan.fused.space());
        // Another part of the same frame.
        let is_same = self
            .first_part
            .as_ref()
            .is_some_and(|first| shown.includes(first));
        let (former, first) = (self.first_part.as_ref(), &shown.parts[0]);
        let is_other = former.is_some_and(|former| former.hung() != first.hung());
        self.first_part = Some(Arc::clone(first));
        let is_left_behind = wants_more
            && self.camera.is_fitted()
            && inspected.view.points.focus().is_some()
            && (is_other || self.is_cut_off());
        if is_left_behind || !(wants_more || is_same || space.is_some() && space == self.space) {
            self.camera.request_fit(FitRequest::Focus);
        }
        self.space = space;
        self.session = shown.session;
        let (points, part) = (grouped(figures.num_points), grouped(figures.num_part));
        self.caption = match &inspected.scan {
            Some(scan) => text!(
                "inspect-caption-shots",
                points = points,
                part = part,
                shots = scan.fused.num_used()
            ),
            None => text!(
                "inspect-caption-planes",
                points = points,
                part = part,
                planes = inspected.inspection.segmentation.planes.len()
            ),
        };
        let is_simulated = inspected.origin.is_simulated();
        let title = inspected.origin.shown_title();
        self.origin = is_simulated.then(|| text!("inspect-no-camera-read", scene = title));
    }

    pub(super) fn ui(
        &mut self,
        ui: &mut Ui,
        state: &InspectState,
        session: &Session,
        inspected: &Inspected,
        actions: &mut Vec<InspectAction>,
    ) {
        // The engineer turns the view as they like: the operator's is framed anew.
        self.framed = None;
        let overlay = overlay(state, inspected);
        self.place(&state.parts, overlay.as_ref(), session, inspected);
        let headline = Headline::of(inspected, session);
        let theme = Theme::of(ui);
        self.restyle(session, inspected, &headline, colouring(state, inspected));
        let rect = ui.available_rect_before_wrap();
        self.size = rect.size();
        self.style.legend = if self.controls_width > rect.width() - LEGEND_WIDTH_PX {
            Legend::BelowControls
        } else {
            Legend::Shown
        };
        self.paint(ui);
        let bar = Rect::from_min_size(
            rect.min + Vec2::splat(space::MEDIUM),
            vec2(rect.width() - 2.0 * space::MEDIUM, space::TARGET),
        );
        let controls = ui.scope_builder(UiBuilder::new().max_rect(bar), |ui| {
            ui.horizontal(|ui| controls::ui(ui, self, state, session, inspected, actions))
                .response
                .rect
        });
        self.controls_width = controls.inner.right() - rect.left();
        let painter = ui.painter_at(rect);
        let top = self.captions(&painter, rect, theme);
        let mut keys = self.colour_keys(state, session, inspected, &headline);
        keys.extend(overlay.map_or_else(Vec::new, |all| all.colour_keys(&self.style.colours)));
        let corner = pos2(rect.left() + space::MEDIUM, top - 4.0);
        colour_keys(&painter, corner, &keys, theme);
    }

    /// Frames another part for the operator, as the camera sees it, when it comes and when its verdict counts, but not on every
    /// frame of it. Live does not know at once that another part has come: until a verdict counts, a part that is cut off by the
    /// view is framed, too.
    pub(super) fn frame_part(&mut self, shown: &Shown) {
        // Whichever of its parts is selected, the frame is the same.
        let inspected = &shown.parts[0];
        let is_new = self.looked_at.replace(shown.generation) != Some(shown.generation);
        if self.is_to_be_framed(inspected) || is_new && inspected.is_open() && self.is_cut_off() {
            ViewDirection::From(StandardView::Front).apply(&mut self.camera);
        }
    }

    /// True if some of the part is outside the view.
    fn is_cut_off(&self) -> bool {
        let size = glam::Vec2::new(self.size.x, self.size.y);
        let is_inside = |at: glam::Vec2| at.cmpge(glam::Vec2::ZERO).all() && at.cmple(size).all();
        let corners = self.scene.focus().map(|part| part.corners());
        let mut corners = corners.into_iter().flatten();
        corners.any(|corner| {
            let at = self.camera.screen_from_world(corner, size);
            !at.is_some_and(is_inside)
        })
    }

    fn is_to_be_framed(&mut self, inspected: &Inspected) -> bool {
        let followed = inspected.followed.as_ref();
        let counts = followed.is_some_and(|followed| followed.standing.counted().is_some());
        let part = inspected.hung();
        let framed = self.framed.as_ref();
        if framed.is_some_and(|(framed, counted)| framed == part && (*counted || !counts)) {
            return false;
        }
        self.framed = Some((part.clone(), counts));
        true
    }

    /// Draws the part alone for the operator; with its outline if accepted.
    pub(super) fn plain_ui(&mut self, ui: &mut Ui, session: &Session, inspected: &Inspected) {
        let headline = Headline::of(inspected, session);
        let parts = headline.is_accepted().then_some(ViewPart::Outline);
        self.place(&parts.into_iter().collect(), None, session, inspected);
        self.restyle(session, inspected, &headline, Colouring::Segment);
        // Only the engineer measures.
        self.viewport.end_measuring();
        ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::M));
        let rect = ui.available_rect_before_wrap();
        self.size = rect.size();
        self.paint(ui);
        if let Some(origin) = &self.origin {
            let corner = pos2(rect.left() + space::MEDIUM, rect.bottom() - space::MEDIUM);
            let theme = Theme::of(ui);
            let anchor = egui::Align2::LEFT_BOTTOM;
            plate(&ui.painter_at(rect), corner, anchor, origin, theme);
        }
    }

    fn restyle(
        &mut self,
        session: &Session,
        inspected: &Inspected,
        headline: &Headline,
        colouring: Colouring,
    ) {
        self.style = ViewStyle {
            colouring,
            deviation_range: DEVIATION_RANGE,
            length_axis: session.units.length_axis(),
            ..ViewStyle::new(ViewColours::of(session.theme))
        };
        if inspected.scan.is_some() {
            self.style.point_size = POINT_SIZE;
        }
        // Only an accepted part has the colour of one.
        if !headline.is_accepted() && headline.state != HeadlineState::NoPart {
            let (.., colour) = headline.verdict(session.theme.colours());
            self.style.colours.roles[Role::Part as usize].colour = colour;
        }
    }

    /// What the colours mean that no scale and no text in the view explains.
    fn colour_keys(
        &self,
        state: &InspectState,
        session: &Session,
        inspected: &Inspected,
        headline: &Headline,
    ) -> Vec<(Color32, String)> {
        let colours = &self.style.colours;
        let drawn = |role: Role, is_dimmed: bool| {
            let colour = colours.role(role).colour;
            if is_dimmed {
                colour.lerp_to_gamma(colours.background, DIMMED)
            } else {
                colour
            }
        };
        let colouring = self.style.colouring;
        let is_by_role = colouring == Colouring::Segment;
        let figure = &inspected.view;
        let mut keys = Vec::new();
        for role in &figure.roles {
            let planes = [Role::Plane0, Role::Plane1, Role::Plane2, Role::Plane3];
            let index = planes.iter().position(|plane| plane == role);
            let text = match (role, index) {
                (Role::Part, _) if is_by_role => {
                    let (_, verdict, _) = headline.verdict(session.theme.colours());
                    format!("{} · {verdict}", text!("shell-part"))
                }
                (Role::Rest, _) if is_by_role || colouring == Colouring::Deviation => {
                    text!("inspect-other-surface")
                }
                (_, Some(index)) => text!("enrol-segment-background", number = index + 1),
                _ => continue,
            };
            keys.push((drawn(*role, !is_by_role), text));
        }
        let lines = [
            (ViewPart::Outline, figure.outline.is_some(), Role::Contour),
            (ViewPart::Camera, figure.camera.is_some(), Role::Frustum),
        ];
        for (part, is_there, role) in lines {
            if is_there && state.parts.contains(&part) {
                keys.push((drawn(role, false), part.title()));
            }
        }
        if !figure.regions.is_empty() {
            keys.push((drawn(Role::AxisX, false), text!("inspect-surface-region")));
        }
        if !rack_of(session, inspected).volume.is_empty() {
            keys.push((drawn(Role::Rest, false), text!("rack-volume")));
        }
        keys
    }

    fn paint(&mut self, ui: &mut Ui) {
        let label = &text!("inspect-view-of-scene");
        let seen = self
            .viewport
            .ui(ui, label, &mut self.camera, &self.scene, &self.style);
        self.has_focus = seen.response.has_focus();
    }

    /// Work done by its frames so far.
    pub(super) fn counts(&self) -> WorkCounts {
        WorkCounts {
            uploads: self.viewport.num_uploads(),
            pictures: self.viewport.num_pictures(),
            made: self.num_placed,
        }
    }

    /// Renders the present view, or returns why it cannot.
    pub(super) fn shot(&self, pixels_per_point: f32) -> Result<ViewShot, UserError> {
        self.viewport
            .shot(
                &self.camera,
                &self.scene,
                &self.style,
                self.size,
                pixels_per_point,
            )
            .map_err(|error| UserError::of(&error))
    }

    /// Makes lines and texts again if what determines them has changed.
    fn place(
        &mut self,
        parts: &BTreeSet<ViewPart>,
        overlay: Option<&Overlay<'_>>,
        session: &Session,
        inspected: &Inspected,
    ) {
        let figure = &inspected.view;
        let robot = session.robot_of(inspected);
        let by = SceneAnnotation {
            parts: parts.clone(),
            units: session.units,
            camera_from_robot: robot.map(|robot| robot.robot_from_camera.inverse()),
            looked_at: overlay.and_then(|overlay| overlay.looked_at),
            has_overlay: overlay.is_some(),
            rack: rack_of(session, inspected).clone(),
        };
        if self.placed.as_ref() == Some(&by) {
            return;
        }
        let units = by.units;
        let mut lines = Vec::new();
        let mut labels = Vec::new();
        let nozzles = figure.nozzles.as_ref();
        for part in parts {
            match part {
                ViewPart::Axes => lines.extend(figure.axes.clone()),
                ViewPart::Camera => lines.extend(figure.camera.clone()),
                ViewPart::Outline => lines.extend(figure.outline.clone()),
                ViewPart::NozzleMiddle | ViewPart::NozzleWorst => {
                    let (index, name) = match part {
                        ViewPart::NozzleMiddle => (0, text!("inspect-taught-nozzle")),
                        _ => (1, text!("inspect-worst")),
                    };
                    if let Some(nozzle) = nozzles.and_then(|nozzles| nozzles.get(index)) {
                        lines.push(nozzle.lines.clone());
                        labels.push(TextLabel {
                            at: nozzle.mouth,
                            text: format!("{name} · {}", units.length(nozzle.distance.0)),
                        });
                    }
                }
                // The scan's overlay draws these.
                ViewPart::ShotCameras | ViewPart::Unseen => {}
                ViewPart::SprayPath => {
                    if let Some(spray) = &figure.spray {
                        lines.push(spray.lines.clone());
                        labels.push(TextLabel {
                            at: spray.start,
                            text: path_label(spray),
                        });
                    }
                }
                ViewPart::RobotBase => {
                    if let Some(base) = &by.camera_from_robot {
                        lines.push(furniture::axes(BASE_AXES).at(base));
                        let at = base.translation.vector;
                        labels.push(TextLabel {
                            at: glam::Vec3::new(at.x as f32, at.y as f32, at.z as f32),
                            text: text!("shell-robot-base"),
                        });
                    }
                }
            }
        }
        let checked = inspected.inspection.surface.as_ref();
        let regions = checked.iter().flat_map(|check| &check.regions);
        for (region, drawn) in regions.zip(&figure.regions) {
            lines.push(drawn.lines.clone());
            labels.push(TextLabel {
                at: drawn.top,
                text: region_words(region, units),
            });
        }
        let (boxes, places) = rack_lines(&by.rack);
        if !boxes.lines().is_empty() {
            lines.push(boxes);
        }
        labels.extend(places);
        let shown = session.shown.as_ref().filter(|shown| shown.parts.len() > 1);
        for (index, part) in shown
            .iter()
            .flat_map(|shown| shown.parts.iter().enumerate())
        {
            let title = Headline::of(part, session).title;
            labels.extend(part.view.points.focus().map(|part| TextLabel {
                at: part.centre(),
                text: numbered(index, &title),
            }));
        }
        self.scene.lines = lines;
        self.scene.labels = labels;
        self.scene.points.truncate(1);
        if let Some(overlay) = overlay {
            overlay.add_to(&mut self.scene);
        }
        self.placed = Some(by);
        self.num_placed += 1;
    }

    /// Draws at the bottom what is shown, and whether it is simulated, one above the other where both do not fit;
    /// returns the upper end of the captions.
    fn captions(&self, painter: &Painter, rect: Rect, theme: &Theme) -> f32 {
        let mut corner = pos2(rect.left() + space::MEDIUM, rect.bottom() - space::MEDIUM);
        let first = plate(
            painter,
            corner,
            egui::Align2::LEFT_BOTTOM,
            &self.caption,
            theme,
        );
        let Some(origin) = &self.origin else {
            return first.top();
        };
        let width = painter
            .layout_no_wrap(origin.clone(), font::small(), theme.text)
            .size()
            .x;
        if first.right() + width + 4.0 * space::MEDIUM < rect.right() {
            corner.x = rect.right() - space::MEDIUM;
            plate(painter, corner, egui::Align2::RIGHT_BOTTOM, origin, theme);
            first.top()
        } else {
            corner.y = first.top() - 4.0;
            plate(painter, corner, egui::Align2::LEFT_BOTTOM, origin, theme).top()
        }
    }
}

/// The rack in use, or that of a past inspection; a scan has none.
fn rack_of<'a>(session: &'a Session, inspected: &'a Inspected) -> &'a Rack {
    let shown = session.shown.as_ref();
    if inspected.scan.is_some() {
        Rack::ANYWHERE
    } else if shown.is_some_and(|shown| shown.is_past) {
        &inspected.recipe.rack
    } else {
        session.rack.in_camera()
    }
}

/// The edges of the work volume and of the places, and the places' names.
fn rack_lines(rack: &Rack) -> (LineSet, Vec<TextLabel>) {
    let corners = |region: &OrientedBox| region.corners().map(|corner| vec3(&corner));
    let volume = rack.volume.iter().flat_map(|region| {
        let edges = furniture::box_edges(corners(region), Role::Rest);
        edges.map(|edge| edge.dashed().with_width(1.5))
    });
    let places = rack.places.iter().flat_map(|place| {
        let edges = furniture::box_edges(corners(&place.region), Role::Measure);
        edges.map(|edge| edge.dashed().with_width(1.5))
    });
    let lines: Vec<Line> = volume.chain(places).collect();
    let labels = rack.places.iter().map(|place| TextLabel {
        at: corners(&place.region)[0],
        text: text!("rack-place", place = place.name.clone()),
    });
    (LineSet::new(lines), labels.collect())
}

/// The overlay of a scan's points.
fn overlay<'a>(state: &'a InspectState, inspected: &'a Inspected) -> Option<Overlay<'a>> {
    let scan = inspected.scan.as_ref()?;
    let unseen = scan.unseen.as_ref();
    Some(Overlay {
        fused: &scan.fused,
        unseen: unseen.map(|(points, share)| (points, *share)),
        looked_at: state.shots.looked_at,
        has_cameras: state.parts.contains(&ViewPart::ShotCameras),
        has_unseen: state.parts.contains(&ViewPart::Unseen),
    })
}

fn colouring(state: &InspectState, inspected: &Inspected) -> Colouring {
    match (state.colouring, inspected.view.has_deviations) {
        (Some(Colouring::Deviation) | None, false) => Colouring::Segment,
        (Some(chosen), _) => chosen,
        (None, true) => Colouring::Deviation,
    }
}

/// Draws text on a backing, so that it is legible over any points.
fn plate(
    painter: &Painter,
    corner: egui::Pos2,
    anchor: egui::Align2,
    text: &str,
    theme: &Theme,
) -> Rect {
    let galley = painter.layout_no_wrap(text.to_owned(), font::small(), theme.text);
    let margin = vec2(8.0, 4.0);
    let rect = anchor.anchor_size(corner, galley.size() + 2.0 * margin);
    painter.rect_filled(rect, ROUNDING, theme.canvas.gamma_multiply(0.82));
    painter.galley(rect.min + margin, galley, theme.text);
    rect
}

fn path_label(spray: &SprayFigure) -> String {
    match spray.num_seen {
        0 => text!("inspect-path-not-seen"),
        num => text!("inspect-path-in-band", inside = spray.num_inside, num = num),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use inspection::pipeline::live::{LiveVerdict, MotionState};
    use shell::inspection::{
        inspected::{LiveFrameContext, inspected_cell},
        source::CellChoice,
    };
    use shell::session::ThemeChoice;
    use simulate::{ObjectKind, PartKind, Side};
    use ui::{
        task::TaskRunner,
        viewport::{LineSet, Measurement, ViewTool},
    };

    fn view() -> SceneView {
        let reason = String::new();
        SceneView::new(Err(ViewError::NoDevice { reason }))
    }

    #[test]
    fn a_path_that_the_camera_does_not_see_has_no_share_in_the_band() {
        let label = |num_inside, num_seen| {
            path_label(&SprayFigure {
                lines: LineSet::new(Vec::new()),
                start: glam::Vec3::ZERO,
                num_inside,
                num_seen,
            })
        };
        assert_eq!(label(3, 5), "Spray path · 3 of 5 in the band");
        assert_eq!(
            label(0, 0),
            "The camera sees the part at no point of the path"
        );
    }

    #[test]
    fn only_an_accepted_part_has_its_colour_and_only_a_named_one_is_compared() {
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        let state = InspectState::new(&TaskRunner::without_threads());
        let hood = CellChoice::Foreign(ObjectKind::Hood);
        for (choice, is_accepted) in [(CellChoice::InTurn, true), (hood, false)] {
            let inspected = inspected_cell(choice, 1);
            let figure = &inspected.view;
            let compared = [
                figure.has_deviations,
                figure.outline.is_some(),
                figure.axes.is_some(),
            ];
            assert_eq!(compared, [is_accepted; 3], "{choice:?}");
            for theme in [ThemeChoice::Dark, ThemeChoice::Light] {
                let session = Session {
                    theme,
                    ..Session::default()
                };
                for is_operator in [true, false] {
                    let mut view = view();
                    let output = ctx.run_ui(egui::RawInput::default(), |ui| {
                        if is_operator {
                            view.plain_ui(ui, &session, &inspected);
                        } else {
                            view.ui(ui, &state, &session, &inspected, &mut Vec::new());
                        }
                    });
                    output.drop_without_applying_deltas();
                    let drawn = view.style.colours.role(Role::Part).colour;
                    let accepted = ViewColours::of(theme).role(Role::Part).colour;
                    assert_eq!(drawn == accepted, is_accepted, "{choice:?}, {theme:?}");
                }
            }
        }
    }

    #[test]
    fn the_keys_name_every_colour_of_the_surfaces() {
        let session = Session::default();
        let state = InspectState::new(&TaskRunner::without_threads());
        let keys = |choice, colouring| {
            let inspected = inspected_cell(choice, 1);
            let headline = Headline::of(&inspected, &session);
            let mut view = view();
            view.restyle(&session, &inspected, &headline, colouring);
            let keys = view.colour_keys(&state, &session, &inspected, &headline);
            let texts = keys.into_iter().map(|(_, text)| text);
            texts.collect::<Vec<_>>().join(", ")
        };
        let hood = CellChoice::Foreign(ObjectKind::Hood);
        let refused = keys(hood, Colouring::Segment);
        assert!(refused.contains("Part · Not accepted"), "{refused}");
        assert!(refused.contains("Background 1"), "{refused}");
        assert!(!refused.contains("Enrolled contour"), "{refused}");
        let accepted = keys(CellChoice::InTurn, Colouring::Deviation);
        assert!(!accepted.contains("Part"), "the scale tells: {accepted}");
        assert!(accepted.contains("Background 1") && accepted.contains("Enrolled contour"));
    }

    #[test]
    fn measuring_ends_in_the_operators_view() {
        let mut view = view();
        view.viewport.tool = ViewTool::Measure;
        view.viewport.measure.add(glam::Vec3::ZERO);
        let inspected = inspected_cell(CellChoice::InTurn, 1);
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        let output = ctx.run_ui(egui::RawInput::default(), |ui| {
            view.plain_ui(ui, &Session::default(), &inspected);
        });
        output.drop_without_applying_deltas();
        assert_eq!(view.viewport.tool, ViewTool::Look);
        assert_eq!(view.viewport.measure, Measurement::default());
    }

    #[test]
    fn a_larger_part_that_moves_in_is_not_cut_off_for_the_operator() {
        let hung = HungId::new();
        let frame = |generation, kind| {
            let mut inspected = inspected_cell(CellChoice::Part(kind, Side::Left), 1);
            inspected.followed = Some(LiveFrameContext {
                stillness: MotionState::Moving,
                standing: LiveVerdict::Open,
            });
            // Live does not know yet that another part has come.
            inspected.entry.record.summary.hung = hung.clone();
            Shown {
                session: Some(1),
                ..Shown::new(generation, Arc::new(inspected))
            }
        };
        let mut view = view();
        view.size = vec2(640.0, 480.0);
        let mut is_framed = |shown: &Shown| {
            view.show(shown);
            view.frame_part(shown);
            let is_framed = view.camera.pending_fit().is_some();
            if let Some(part) = view.scene.focus().filter(|_| is_framed) {
                let size = glam::Vec2::new(view.size.x, view.size.y);
                view.camera.fit(&part, size);
            }
            is_framed
        };
        let [small, large, again] = [
            (1, PartKind::Grille),
            (2, PartKind::FrontBumper),
            (3, PartKind::FrontBumper),
        ]
        .map(|(generation, kind)| frame(generation, kind));
        assert!(is_framed(&small), "the first");
        assert!(is_framed(&large));
        assert!(!is_framed(&again), "all of it is in the view");
    }

    #[test]
    fn while_a_source_is_followed_the_view_follows_the_parts_until_a_person_turns_it() {
        let mut view = view();
        view.size = vec2(640.0, 480.0);
        let is_fitted_to = |view: &mut SceneView, generation, kind| {
            let inspected = inspected_cell(CellChoice::Part(kind, Side::Left), 1);
            view.show(&Shown {
                session: Some(1),
                ..Shown::new(generation, Arc::new(inspected))
            });
            let is_fitted = view.camera.pending_fit().is_some();
            if let Some(part) = view.scene.focus().filter(|_| is_fitted) {
                view.camera.fit(&part, glam::Vec2::new(640.0, 480.0));
            }
            is_fitted
        };
        assert!(is_fitted_to(&mut view, 1, PartKind::FrontBumper));
        assert!(is_fitted_to(&mut view, 2, PartKind::Grille), "another part");
        view.camera.turn(0.3, 0.0);
        assert!(!is_fitted_to(&mut view, 3, PartKind::FrontBumper));
        view.camera.request_fit(FitRequest::Focus);
        assert!(is_fitted_to(&mut view, 4, PartKind::Grille), "pressed");
        assert!(is_fitted_to(&mut view, 5, PartKind::FrontBumper));
    }

    #[test]
    fn the_operator_sees_the_part_as_the_camera_does_wherever_the_engineer_looked_from() {
        let [part, next] = [1, 2].map(|generation| {
            Shown::new(
                generation,
                Arc::new(inspected_cell(CellChoice::InTurn, generation)),
            )
        });
        let mut view = view();
        let is_from_front = |view: &SceneView| view.camera.forward() == glam::Vec3::Z;
        view.frame_part(&part);
        // The engineer looks at it from above.
        let state = InspectState::new(&TaskRunner::without_threads());
        let ctx = egui::Context::default();
        Theme::install_fonts(&ctx);
        let output = ctx.run_ui(egui::RawInput::default(), |ui| {
            let session = Session::default();
            view.ui(ui, &state, &session, &part.inspected, &mut Vec::new());
        });
        output.drop_without_applying_deltas();
        view.camera.look(StandardView::Top);
        view.frame_part(&part);
        assert!(is_from_front(&view));
        assert_eq!(view.camera.pending_fit(), Some(FitRequest::Focus));
        // What the operator turns stays until the next part.
        view.camera.look(StandardView::Side);
        view.frame_part(&part);
        assert!(!is_from_front(&view));
        view.frame_part(&next);
        assert!(is_from_front(&view));
    }

    #[test]
    fn each_part_is_framed_once_for_the_operator() {
        let mut view = view();
        let mut inspected = inspected_cell(CellChoice::InTurn, 1);
        assert!(view.is_to_be_framed(&inspected));
        assert!(!view.is_to_be_framed(&inspected));
        inspected.entry.record.summary.hung = HungId::new();
        assert!(view.is_to_be_framed(&inspected));
    }
}
