//! Where parts may hang: the rack in use, and the window in which it is edited.

mod in_use;

use std::{ops::RangeInclusive, path::PathBuf};

use egui::{
    CollapsingHeader, Context, DragValue, Grid, RichText, Role, ScrollArea, TextEdit, Ui,
    WidgetInfo, pos2, vec2,
};

use crate::{
    action::{Action, DialogRequest},
    inspection::inspected::Inspected,
    notice::Notice,
    rack::in_use::camera,
    session::Session,
    state::{State, notify},
};
use geometry::{
    oriented_box::{MAX_COORDINATE_MM, OrientedBox},
    units::Radians,
};
use inspection::rack::{
    MAX_BOXES, MAX_NAME, MAX_TURN, MaxTurn, Place, RackError, RackFile, RackFrame, RackProblem,
    may_be_taken,
};
use stages::segment::MAX_PARTS;
use ui::{
    language::{described, text, what_and_advice},
    theme::{Theme, space},
    user_error::UserError,
    widgets::{button_if, sentence, text_button},
};

pub use self::in_use::{RackAction, RackEditor, RackInUse, ReadRack};

/// Maximum number of steps that can be undone.
const MAX_UNDO: usize = 50;

impl Session {
    /// Uses this rack from now on; an empty one for none.
    fn use_rack(&mut self, file: RackFile) -> Result<(), RackError> {
        if file.rack.is_empty() {
            self.rack = RackInUse::default();
            return Ok(());
        }
        let in_camera = file.in_camera(camera(self.robot.as_deref()))?;
        self.rack = RackInUse {
            file: Some(file),
            base_from_camera: camera(self.robot.as_deref()).copied(),
            in_camera,
        };
        Ok(())
    }
}

impl RackEditor {
    fn of(session: &Session) -> Self {
        Self {
            draft: session.rack.file.clone().unwrap_or_default(),
            ..Self::default()
        }
    }
}

/// Uses the rack whose file has been read by now, and says whether one was written.
pub fn update(state: &mut State) {
    if let Some(read) = state.rack_reading.poll() {
        apply(state, RackAction::Opened(read));
    }
    if let Some(saved) = state.rack_saving.poll() {
        apply(state, RackAction::Saved(saved));
    }
}

/// Carries out an action on the rack.
pub fn apply(state: &mut State, action: RackAction) {
    if let RackAction::Toggle = action {
        if state.session.rack_editor.is_some() {
            close(state);
        } else {
            state.session.rack_editor = Some(RackEditor::of(&state.session));
            inspect_present(state);
        }
        return;
    }
    if let RackAction::Open(path) = action {
        state.rack_reading.start(text!("rack-reading"), |_| {
            let file = RackFile::read(&path);
            let file = file.map_err(|error| UserError::from(what_and_advice(&error)))?;
            Ok((path, Box::new(file)))
        });
        return;
    }
    if let RackAction::Saved(saved) = action {
        return tell_saved(state, saved);
    }
    // A file may be chosen after the window was closed.
    let open = state.session.rack_editor.clone();
    let mut editor = open.unwrap_or_else(|| RackEditor::of(&state.session));
    let robot = state.session.robot.clone();
    let changed = match action {
        RackAction::Toggle | RackAction::Open(_) | RackAction::Saved(_) => Ok(None),
        RackAction::Opened(read) => read.map(|(path, file)| {
            let title = path.display().to_string();
            notify(state, Notice::done(text!("rack-opened", path = title)));
            Some(*file)
        }),
        RackAction::Save(path) => {
            let file = editor.draft.clone();
            state.rack_saving.start(text!("rack-saving"), move |_| {
                let written = file.write(&path);
                written.map_err(|error| UserError::from(what_and_advice(&error)))?;
                Ok(path)
            });
            Ok(None)
        }
        RackAction::Edit { file, continues } => {
            let was_dragged = std::mem::replace(&mut editor.is_dragged, continues);
            if was_dragged && continues {
                editor.draft = *file;
                set(state, &mut editor);
                Ok(None)
            } else {
                Ok(Some(*file))
            }
        }
        RackAction::Inspect => {
            (editor.is_new, editor.is_dragged) = (false, false);
            inspect_present(state);
            Ok(None)
        }
        RackAction::TakePlace(name) => taken(state, &editor, |file, front| {
            let camera = camera(robot.as_deref());
            file.take_place(&name, &front.inspection, front.middle, camera)
        }),
        RackAction::TakePlaces => taken(state, &editor, |file, _| {
            let camera = camera(robot.as_deref());
            let mut is_changed = false;
            for part in parts_without_place(&state.session) {
                let name = file.new_place_name();
                is_changed |= file.take_place(&name, &part.inspection, part.middle, camera)?;
            }
            Ok(is_changed)
        }),
        RackAction::TakeVolume => taken(state, &editor, |file, front| {
            file.take_volume(&front.inspection, camera(robot.as_deref()))
        }),
        RackAction::Undo => {
            if let Some(file) = editor.past.pop() {
                editor.draft = file;
                set(state, &mut editor);
            }
            Ok(None)
        }
    };
    match changed {
        Ok(Some(file)) => {
            let before = std::mem::replace(&mut editor.draft, file);
            editor.past.push(before);
            let num_over = editor.past.len().saturating_sub(MAX_UNDO);
            editor.past.drain(..num_over);
            set(state, &mut editor);
        }
        Ok(None) => {}
        Err(error) => editor.problem = Some(error),
    }
    state.session.rack_editor = Some(editor);
}

/// Says where the rack was written, or why it was not.
fn tell_saved(state: &mut State, saved: Result<PathBuf, UserError>) {
    match (saved, &mut state.session.rack_editor) {
        (Ok(path), _) => {
            let title = path.display().to_string();
            notify(state, Notice::done(text!("rack-saved", path = title)));
        }
        (Err(error), Some(editor)) => editor.problem = Some(error),
        (Err(error), None) => notify(state, error.into()),
    }
}

/// Closes the window of the rack, if it is open.
pub(crate) fn close(state: &mut State) {
    if state.session.rack_editor.take().is_some() {
        inspect_present(state);
    }
}

/// The parts of the frame in front of which a place can be made, and that have none.
fn parts_without_place(session: &Session) -> impl Iterator<Item = &Inspected> {
    let parts = session.shown.iter().flat_map(|shown| &shown.parts);
    let parts = parts.map(|part| &**part);
    parts.filter(|part| may_be_taken(&part.inspection) && part.inspection.place.is_none())
}

/// Inspects the frame in front again, unless it is from the history.
fn inspect_present(state: &mut State) {
    let shown = state.session.shown.as_ref();
    if state.session.is_live() || shown.is_some_and(|shown| !shown.is_past) {
        state.inspect_again();
    }
}

/// Uses the draft, unless something in it is wrong.
fn set(state: &mut State, editor: &mut RackEditor) {
    let checked = if editor.draft.rack.is_empty() {
        Ok(())
    } else {
        editor.draft.check()
    };
    let wrong = |problem: RackProblem| UserError {
        what: described(&problem),
        advice: text!("rack-not-used"),
    };
    let library = state.session.library.clone();
    let is_enrolled = |name: &str| {
        let parts = library.iter().flat_map(|library| &library.parts);
        let mut names = parts.flat_map(|part| [part.name.as_str(), part.part_name().as_str()]);
        library.is_none() || names.any(|other| other == name)
    };
    let used = checked.map_err(wrong).and_then(|()| {
        let known = editor.draft.check_parts(is_enrolled);
        let used = known.and_then(|()| state.session.use_rack(editor.draft.clone()));
        used.map_err(|error| what_and_advice(&error).into())
    });
    editor.is_new |= used.is_ok();
    editor.problem = used.err();
}

/// The draft changed by the part in front; `None` if there is no part.
fn taken(
    state: &State,
    editor: &RackEditor,
    take: impl FnOnce(&mut RackFile, &Inspected) -> Result<bool, RackError>,
) -> Result<Option<RackFile>, UserError> {
    let Some(shown) = &state.session.shown else {
        return Ok(None);
    };
    let mut file = editor.draft.clone();
    let taken = take(&mut file, &shown.inspected);
    let taken = taken.map_err(|error| UserError::from(what_and_advice(&error)))?;
    Ok(taken.then_some(file))
}

/// Width of the window, logical pixels.
const WIDTH_PX: f32 = 330.0;
/// Room that the window leaves above and below, logical pixels.
const MARGIN_PX: f32 = 380.0;

/// Draws the window while it is open.
pub fn window(ctx: &Context, state: &State, actions: &mut Vec<Action>) {
    let Some(editor) = state
        .session
        .rack_editor
        .as_ref()
        .filter(|_| !state.session.is_operator_view())
    else {
        return;
    };
    let mut file = editor.draft.clone();
    let mut act = |action| actions.push(Action::Rack(action));
    let mut is_open = true;
    let mut caused = Vec::new();
    egui::Window::new(text!("rack-heading"))
        .id(egui::Id::unique("rack"))
        .open(&mut is_open)
        .resizable(false)
        .default_width(WIDTH_PX)
        .default_pos(pos2(112.0, 112.0))
        .show(ctx, |ui| {
            ui.set_width(WIDTH_PX);
            top(ui, state, editor, &mut file, &mut caused);
            ui.separator();
            let room = (ctx.content_rect().height() - MARGIN_PX).max(120.0);
            let scrolled = ScrollArea::vertical()
                .max_height(room)
                .min_scrolled_height(room);
            scrolled.show(ui, |ui| {
                volume(ui, state, &mut file, &mut caused);
                ui.add_space(space::MEDIUM);
                places(ui, state, &mut file, &mut caused);
            });
            if let Some(problem) = &editor.problem {
                ui.separator();
                ui.colored_label(Theme::of(ui).rejected, &problem.what);
                ui.weak(&problem.advice);
            }
        });
    if file != editor.draft {
        let continues = ctx.input(|input| input.pointer.is_decidedly_dragging());
        act(RackAction::Edit {
            file: Box::new(file),
            continues,
        });
    } else if editor.is_new && !ctx.input(|input| input.pointer.any_down()) {
        act(RackAction::Inspect);
    }
    if !is_open {
        act(RackAction::Toggle);
    }
    actions.extend(caused);
}

/// Draws name and frame, and the buttons for the whole rack.
fn top(
    ui: &mut Ui,
    state: &State,
    editor: &RackEditor,
    file: &mut RackFile,
    caused: &mut Vec<Action>,
) {
    ui.horizontal(|ui| {
        let label = ui.label(text!("shell-name"));
        let field = TextEdit::singleline(&mut file.rack.name).char_limit(MAX_NAME);
        ui.add(field.desired_width(f32::INFINITY))
            .labelled_by(label.id);
    });
    ui.horizontal(|ui| {
        ui.label(text!("rack-frame"));
        let is_calibrated = state.session.robot.is_some();
        for (frame, text) in [
            (RackFrame::Camera, sentence(&text!("robot-camera"))),
            (RackFrame::Base, text!("shell-robot-base")),
        ] {
            let can = frame == RackFrame::Camera || is_calibrated;
            let button = egui::Button::selectable(file.frame == frame, text);
            let button = ui.add_enabled(can && file.frame != frame, button);
            if button
                .on_disabled_hover_text(text!("rack-needs-calibration"))
                .clicked()
                && let Some(robot) = &state.session.robot
            {
                let base_from_camera = &robot.robot_from_camera;
                file.rack = match frame {
                    RackFrame::Base => file.rack.moved(base_from_camera),
                    RackFrame::Camera => file.rack.moved(&base_from_camera.inverse()),
                };
                file.frame = frame;
            }
        }
    });
    ui.horizontal_wrapped(|ui| {
        if text_button(ui, &text!("shell-open")).clicked() {
            caused.push(Action::Ask(DialogRequest::Rack));
        }
        let can_save = !file.rack.is_empty() && editor.problem.is_none();
        if button_if(ui, can_save, &text!("shell-save-as")).clicked() {
            caused.push(Action::Ask(DialogRequest::SaveRack));
        }
        if button_if(ui, !editor.past.is_empty(), &text!("shell-undo")).clicked() {
            caused.push(Action::Rack(RackAction::Undo));
        }
        if button_if(ui, !file.rack.is_empty(), &text!("rack-clear")).clicked() {
            *file = RackFile::default();
        }
    });
}

/// Draws the boxes of the work volume.
fn volume(ui: &mut Ui, state: &State, file: &mut RackFile, caused: &mut Vec<Action>) {
    ui.strong(text!("rack-volume"));
    ui.weak(text!("rack-volume-says"));
    let mut removed = None;
    for (index, region) in file.rack.volume.iter_mut().enumerate() {
        let title = text!("rack-box", number = index + 1);
        CollapsingHeader::new(title)
            .id_salt(("box", index))
            .show(ui, |ui| {
                box_numbers(ui, region);
                if text_button(ui, &text!("rack-remove")).clicked() {
                    removed = Some(index);
                }
            });
    }
    if let Some(index) = removed {
        file.rack.volume.remove(index);
    }
    let has_part = has_part(state) && file.rack.volume.len() < MAX_BOXES;
    let add = button_if(ui, has_part, &text!("rack-add-box"));
    if add.on_disabled_hover_text(text!("rack-no-part")).clicked() {
        caused.push(Action::Rack(RackAction::TakeVolume));
    }
}

/// True if a part is in front of which a place or a box can be made.
fn has_part(state: &State) -> bool {
    let shown = state.session.shown.as_ref();
    shown.is_some_and(|shown| may_be_taken(&shown.inspected.inspection))
}

/// Draws the places.
fn places(ui: &mut Ui, state: &State, file: &mut RackFile, caused: &mut Vec<Action>) {
    ui.strong(text!("rack-places"));
    ui.weak(text!("rack-places-says"));
    let has_part = has_part(state);
    let mut removed = None;
    for (index, place) in file.rack.places.iter_mut().enumerate() {
        let parts: Vec<&str> = place.parts.iter().map(|part| &*part.name).collect();
        let title = match &parts[..] {
            [] => place.name.clone(),
            parts => format!("{} · {}", place.name, parts.join(", ")),
        };
        CollapsingHeader::new(title)
            .id_salt(("place", index))
            .show(ui, |ui| {
                place_ui(ui, place);
                ui.horizontal_wrapped(|ui| {
                    let take = button_if(ui, has_part, &text!("rack-take-place"));
                    let take = take.on_hover_text(text!("rack-take-place-says"));
                    if take.on_disabled_hover_text(text!("rack-no-part")).clicked() {
                        let name = place.name.clone();
                        caused.push(Action::Rack(RackAction::TakePlace(name)));
                    }
                    if text_button(ui, &text!("rack-remove")).clicked() {
                        removed = Some(index);
                    }
                });
            });
    }
    if let Some(index) = removed {
        file.rack.places.remove(index);
    }
    let why_not = why_no_new_place(state, file);
    let add = button_if(ui, why_not.is_none(), &text!("rack-add-place"));
    if add
        .on_disabled_hover_text(why_not.unwrap_or_default())
        .clicked()
    {
        let name = file.new_place_name();
        caused.push(Action::Rack(RackAction::TakePlace(name)));
    }
    let num_new = parts_without_place(&state.session).count();
    let num_free = MAX_PARTS.saturating_sub(file.rack.places.len());
    if (2..=num_free).contains(&num_new) && text_button(ui, &text!("rack-add-places")).clicked() {
        caused.push(Action::Rack(RackAction::TakePlaces));
    }
}

/// Why no new place can be made of the part in front.
fn why_no_new_place(state: &State, file: &RackFile) -> Option<String> {
    if !has_part(state) {
        return Some(text!("rack-no-part"));
    }
    if file.rack.places.len() >= MAX_PARTS {
        return Some(text!("rack-full", limit = MAX_PARTS));
    }
    let shown = state.session.shown.as_ref();
    let place = shown.and_then(|shown| shown.inspected.inspection.place.as_ref());
    place.map(|place| text!("rack-has-place", place = place))
}

fn place_ui(ui: &mut Ui, place: &mut Place) {
    ui.horizontal(|ui| {
        let label = ui.label(text!("shell-name"));
        let field = TextEdit::singleline(&mut place.name).char_limit(MAX_NAME);
        ui.add(field.desired_width(180.0)).labelled_by(label.id);
    });
    box_numbers(ui, &mut place.region);
    max_turn(ui, &mut place.max_turn);
    let mut removed = None;
    for (index, part) in place.parts.iter_mut().enumerate() {
        ui.horizontal(|ui| {
            ui.label(&part.name);
            let mut is_oriented = part.angles_rad.is_some();
            let checkbox = ui.add_enabled(
                is_oriented,
                egui::Checkbox::new(&mut is_oriented, text!("rack-oriented")),
            );
            if checkbox
                .on_hover_text(text!("rack-oriented-says"))
                .changed()
            {
                part.angles_rad = None;
            }
            if text_button(ui, &text!("rack-remove")).clicked() {
                removed = Some(index);
            }
        });
    }
    if let Some(index) = removed {
        place.parts.remove(index);
    }
    if place.parts.is_empty() {
        ui.weak(text!("rack-any-part"));
    }
}

/// Draws how far a part may be turned: in all, or about each axis.
fn max_turn(ui: &mut Ui, turn: &mut MaxTurn) {
    let name = text!("rack-max-turn");
    ui.horizontal_wrapped(|ui| {
        ui.label(&name);
        let mut limit = |limit: &mut Radians, label: &str| {
            let mut degrees = limit.degrees();
            let field = DragValue::new(&mut degrees)
                .range(1.0..=MAX_TURN.degrees())
                .speed(0.5)
                .max_decimals(1);
            if number(ui, field.suffix("°"), label) {
                *limit = Radians::from_degrees(degrees);
            }
        };
        match turn {
            MaxTurn::Total(total) => limit(total, &name),
            MaxTurn::EachAxis(each) => {
                for (one, axis) in each.iter_mut().zip(AXES) {
                    limit(one, &format!("{name} {axis}"));
                }
            }
        }
        let mut is_each = matches!(turn, MaxTurn::EachAxis(_));
        let checkbox = ui.checkbox(&mut is_each, text!("rack-each-axis"));
        if checkbox
            .on_hover_text(text!("rack-each-axis-says"))
            .changed()
        {
            *turn = match *turn {
                MaxTurn::Total(total) => MaxTurn::EachAxis([total; 3]),
                MaxTurn::EachAxis([x, y, z]) => MaxTurn::Total(Radians(x.0.min(y.0).min(z.0))),
            };
        }
    });
}

/// Names of the axes.
const AXES: [&str; 3] = ["x", "y", "z"];
/// Width in which the numbers of a box are a table, logical pixels.
const TABLE_WIDTH_PX: f32 = 280.0;

/// Draws the numbers of a box: a table, or in a narrow place each name above its numbers.
pub fn box_numbers(ui: &mut Ui, region: &mut OrientedBox) {
    let limit = MAX_COORDINATE_MM;
    let rows = [
        (
            text!("rack-centre"),
            &mut region.centre_m,
            -limit..=limit,
            1e3,
            5.0,
        ),
        (
            text!("rack-size"),
            &mut region.size_m,
            10.0..=limit,
            1e3,
            5.0,
        ),
        (
            text!("rack-angles"),
            &mut region.angles_rad,
            -180.0..=180.0,
            1.0_f64.to_degrees(),
            0.5,
        ),
    ];
    let fields = |ui: &mut Ui,
                  name: &str,
                  values: &mut [f64; 3],
                  range: RangeInclusive<f64>,
                  unit: f64,
                  speed: f64| {
        for (value, axis) in values.iter_mut().zip(AXES) {
            let mut shown = *value * unit;
            let field = DragValue::new(&mut shown)
                .range(range.clone())
                .clamp_existing_to_range(false)
                .speed(speed)
                .max_decimals(1)
                // Or a box would count that has the first figures of a number.
                .update_while_editing(false);
            if number(ui, field, &format!("{name} {axis}")) {
                *value = shown / unit;
            }
        }
    };
    if ui.available_width() < TABLE_WIDTH_PX {
        for (name, values, range, unit, speed) in rows {
            ui.label(format!("{name}: {}", AXES.join(", ")));
            ui.horizontal(|ui| fields(ui, &name, values, range, unit, speed));
        }
        return;
    }
    Grid::new("numbers").num_columns(4).show(ui, |ui| {
        ui.label("");
        for axis in AXES {
            ui.label(RichText::new(axis).weak());
        }
        ui.end_row();
        for (name, values, range, unit, speed) in rows {
            ui.label(&name);
            fields(ui, &name, values, range, unit, speed);
            ui.end_row();
        }
    });
}

/// Draws a number that can be dragged or typed; true if the user changed it.
fn number(ui: &mut Ui, field: DragValue<'_>, label: &str) -> bool {
    let response = ui.add_sized(vec2(72.0, space::TARGET), field);
    response.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, label));
    response.changed()
}
