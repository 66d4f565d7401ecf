//! The menu that chooses the source of Capture and Live, and the dialog that sets up the simulated cell.

use std::mem::discriminant;

use egui::{Button, Context, DragValue, Grid, RichText, ScrollArea, Ui, Vec2, WidgetInfo, vec2};

use crate::{
    action::{Action, DialogRequest},
    inspection::source::{CellChoice, file_name},
    language::object,
    rack::RackAction,
    session::{Session, Source},
    source::live::LiveAction,
    state::State,
};
use capture::{
    CellScene, GenicamSpec, KinectSpec, OpenNiSpec, RealsenseSpec, SimulatedPose, SimulatedSpec,
    SourceSpec,
};
use simulate::{Clutter, ObjectKind, PartKind, Side};
use ui::{
    language::text,
    theme::{font, space},
    widgets::{self, drop_down, menu_button, shortened, show_scroll_bar, text_button},
};

/// Width of a column, logical pixels.
const COLUMN_WIDTH_PX: f32 = 230.0;
/// Numbers of frames that depth can be averaged over: the noise falls with the square root.
const AVERAGED: [usize; 4] = [1, 4, 8, 16];
/// Part of the window's height that the menu leaves free, logical pixels.
const MARGIN: f32 = 90.0;

/// Draws the contents of the menu.
pub(crate) fn ui(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    let height = ui.ctx().content_rect().height() - MARGIN;
    // A menu is less high than the window by itself.
    ui.set_max_height(height);
    ui.horizontal_top(|ui| {
        column(ui, height, "sources", |ui| {
            sources(ui, &state.session, actions);
            ui.separator();
            simulated(ui, &state.session, height, actions);
        });
        ui.separator();
        column(ui, height, "others", |ui| others(ui, state, actions));
    });
}

fn column(ui: &mut Ui, height: f32, name: &str, content: impl FnOnce(&mut Ui)) {
    ui.vertical(|ui| {
        ui.set_width(COLUMN_WIDTH_PX);
        show_scroll_bar(ui);
        ScrollArea::vertical()
            .id_salt(name)
            .max_height(height)
            // The bar stands at the end of the column, however short its entries are.
            .auto_shrink([false, true])
            .show(ui, content);
    });
}

/// Returns the name of the source in use.
pub fn now(source: &Source) -> String {
    match source {
        Source::Cell(CellChoice::InTurn) => text!("shell-simulated-cell"),
        Source::Cell(choice) => text!("shell-simulated", what = choice.title()),
        Source::File(path) => shortened(&file_name(path), 24),
        Source::Scan(files) => text!("shell-scan-of", name = shortened(&files.title(), 22)),
        Source::Camera(spec) => match &**spec {
            SourceSpec::Simulated(_) => text!("shell-cell-set-up"),
            SourceSpec::SimulatedRobot(_) | SourceSpec::Genicam(_) => shortened(&spec.title(), 22),
            SourceSpec::Recording(spec) => {
                text!(
                    "shell-recording-of",
                    name = shortened(&file_name(&spec.folder), 18)
                )
            }
            SourceSpec::Watched(spec) => {
                text!(
                    "shell-folder-of",
                    name = shortened(&file_name(&spec.folder), 20)
                )
            }
            SourceSpec::Kinect(_) => "Kinect".to_owned(),
            SourceSpec::OpenNi(_) => "OpenNI".to_owned(),
            SourceSpec::Realsense(_) => "RealSense".to_owned(),
        },
    }
}

fn heading(ui: &mut Ui, text: String) {
    ui.label(RichText::new(text).font(font::heading()));
}

/// The simulated cell to begin with when it is set up: that in use, if it is one.
pub(crate) fn cell_in_use(source: &Source) -> SimulatedSpec {
    match source.followed() {
        Some(SourceSpec::Simulated(spec)) => spec,
        _ => SimulatedSpec::default(),
    }
}

/// Draws the simulated cell: what may hang in it is in a menu of its own.
fn simulated(ui: &mut Ui, session: &Session, height: f32, actions: &mut Vec<Action>) {
    let title = text!("shell-simulated-cell");
    let menu = menu_button(ui, &title, |ui| {
        column(ui, height, "cell", |ui| {
            for choice in CellChoice::all() {
                let is_chosen = session.source == Source::Cell(choice);
                if ui.selectable_label(is_chosen, choice.title()).clicked() {
                    actions.push(Action::UseCell(choice));
                    ui.close();
                }
            }
        });
    });
    let is_chosen = matches!(session.source, Source::Cell(_));
    let button = menu.response;
    button.widget_info(|| WidgetInfo::selected(egui::Role::Button, true, is_chosen, &title));
    let is_set_up = matches!(&session.source, Source::Camera(spec) if matches!(**spec, SourceSpec::Simulated(_)));
    if ui
        .selectable_label(is_set_up, text!("shell-set-up-cell"))
        .clicked()
    {
        let spec = cell_in_use(&session.source);
        actions.push(Action::Live(LiveAction::SetUp(Some(spec))));
        ui.close();
    }
}

/// Draws cameras, recordings, folders and files.
fn sources(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let camera = match &session.source {
        Source::Camera(spec) => Some(&**spec),
        Source::Cell(_) | Source::File(_) | Source::Scan(_) => None,
    };
    heading(ui, text!("shell-cameras-and-folders"));
    cameras(ui, camera, actions);
    let is_recording = matches!(camera, Some(SourceSpec::Recording(_)));
    let is_watched = matches!(camera, Some(SourceSpec::Watched(_)));
    for (is_chosen, text, says, ask) in [
        (
            is_recording,
            text!("shell-play-recording"),
            text!("shell-play-recording-says"),
            DialogRequest::Recording,
        ),
        (
            is_watched,
            text!("shell-watch-folder"),
            text!("shell-watch-folder-says"),
            DialogRequest::WatchedFolder,
        ),
        (
            false,
            text!("shell-open-file"),
            text!("shell-open-file-says"),
            DialogRequest::Scene,
        ),
        (
            matches!(session.source, Source::Scan(_)),
            text!("shell-open-scan"),
            text!("shell-open-scan-says"),
            DialogRequest::Scan,
        ),
    ] {
        if ui
            .selectable_label(is_chosen, text)
            .on_hover_text(says)
            .clicked()
        {
            actions.push(Action::Ask(ask));
            ui.close();
        }
    }
}

/// Draws what goes with a source, and the files that were opened last.
fn others(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    heading(ui, text!("shell-average-depth"));
    ui.horizontal(|ui| {
        for num in AVERAGED {
            let is_chosen = state.session.live.params.average == num;
            let text = match num {
                1 => text!("shell-one-frame"),
                num => num.to_string(),
            };
            let button = Button::selectable(is_chosen, text).min_size(Vec2::splat(space::TARGET));
            if ui.add(button).clicked() {
                actions.push(Action::Live(LiveAction::Average(num)));
            }
        }
    });
    ui.separator();
    empty_cell(ui, state, actions);
    ui.separator();
    rack(ui, state, actions);
    if !state.session.recent.is_empty() {
        ui.separator();
        heading(ui, text!("shell-recent-files"));
    }
    for path in &state.session.recent {
        let is_chosen = match &state.session.source {
            Source::File(file) => file == path,
            Source::Scan(files) => files.folder() == Some(path),
            Source::Cell(_) | Source::Camera(_) => false,
        };
        let name = shortened(&file_name(path), 28);
        let entry = ui.selectable_label(is_chosen, name);
        if entry.on_hover_text(path.display().to_string()).clicked() {
            actions.push(Action::Open(path.clone()));
            ui.close();
        }
    }
}

fn cameras(ui: &mut Ui, chosen: Option<&SourceSpec>, actions: &mut Vec<Action>) {
    for (name, spec) in [
        ("Kinect", SourceSpec::Kinect(KinectSpec::default())),
        ("GenICam", SourceSpec::Genicam(GenicamSpec::default())),
        (
            "Xtion, Astra (OpenNI)",
            SourceSpec::OpenNi(OpenNiSpec::default()),
        ),
        ("RealSense", SourceSpec::Realsense(RealsenseSpec::default())),
    ] {
        let is_chosen = chosen.is_some_and(|chosen| discriminant(chosen) == discriminant(&spec));
        if ui.selectable_label(is_chosen, name).clicked() {
            actions.push(Action::Live(LiveAction::Use(spec)));
            ui.close();
        }
    }
}

/// Draws the entry for the window of the rack.
fn rack(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    heading(ui, text!("rack-heading"));
    let button = Button::selectable(
        state.session.rack_editor.is_some(),
        state.session.rack.title(),
    );
    if ui.add(button).on_hover_text(text!("rack-says")).clicked() {
        actions.push(Action::Rack(RackAction::Toggle));
        ui.close();
    }
}

/// Draws the entries for capturing and discarding the empty cell.
fn empty_cell(ui: &mut Ui, state: &State, actions: &mut Vec<Action>) {
    heading(ui, text!("shell-empty-cell"));
    let take = Button::new(text!("shell-capture-empty-cell"));
    let take = ui
        .add_enabled(state.session.shown.is_some(), take)
        .on_hover_text(text!("shell-capture-empty-cell-says"))
        .on_disabled_hover_text(text!("align-nothing-inspected"));
    if take.clicked() {
        actions.push(Action::TakeEmptyCell);
        ui.close();
    }
    let forget = Button::new(text!("shell-discard-empty-cell"));
    if ui
        .add_enabled(state.session.empty_cell.is_some(), forget)
        .on_disabled_hover_text(text!("shell-no-empty-cell"))
        .clicked()
    {
        actions.push(Action::ForgetEmptyCell);
        ui.close();
    }
}

/// Noise levels to choose from, as multiples of a Kinect's.
fn noises() -> [(String, f64); 3] {
    [
        (text!("live-no-noise"), 0.0),
        (text!("live-kinect-noise"), 1.0),
        (text!("live-three-times"), 3.0),
    ]
}
/// Seconds that each part or rack of the line hangs there.
const EVERY: f64 = 8.0;
/// Largest number of a car model that can be chosen.
const MAX_MODEL: u64 = 999;

/// Draws the dialog while it is open.
pub fn set_up(ctx: &Context, state: &State, actions: &mut Vec<Action>) {
    let Some(known) = &state.session.live.setup else {
        return;
    };
    let mut spec = known.clone();
    let modal = widgets::dialog(ctx, "set up the cell", |ui| {
        ui.set_max_width(560.0);
        ui.heading(text!("shell-simulated-cell"));
        ui.add_space(space::SMALL);
        Grid::new("cell")
            .num_columns(2)
            .spacing(vec2(20.0, 8.0))
            .show(ui, |ui| rows(ui, &mut spec));
        ui.add_space(space::MEDIUM);
        let mut closing = None;
        ui.horizontal(|ui| {
            if widgets::default_button(ui, &text!("robot-use-it"), true) {
                closing = Some(true);
            }
            if text_button(ui, &text!("shell-close")).clicked() {
                closing = Some(false);
            }
        });
        closing
    });
    let is_closed = modal.should_close();
    match modal.inner {
        Some(true) => {
            let source = SourceSpec::Simulated(spec);
            actions.push(Action::Live(LiveAction::Use(source)));
        }
        Some(false) => actions.push(Action::Live(LiveAction::SetUp(None))),
        None if is_closed => actions.push(Action::Live(LiveAction::SetUp(None))),
        None if spec != *known => actions.push(Action::Live(LiveAction::SetUp(Some(spec)))),
        None => {}
    }
}

fn rows(ui: &mut Ui, spec: &mut SimulatedSpec) {
    row(ui, text!("live-what-hangs"), |ui| {
        let chosen = scene_title(spec.scene);
        let label = text!("live-hangs", what = &chosen);
        drop_down(ui, &label, &chosen, 240.0, |ui| {
            for scene in scenes(spec.scene) {
                ui.selectable_value(&mut spec.scene, scene, scene_title(scene));
            }
        });
    });
    row(ui, text!("live-side"), |ui| {
        for side in Side::ALL {
            let name = match side {
                Side::Left => text!("live-side-left"),
                Side::Right => text!("live-side-right"),
            };
            choice(ui, &mut spec.side, side, name);
        }
    });
    row(ui, text!("live-model"), |ui| {
        let model = DragValue::new(&mut spec.model).range(0..=MAX_MODEL);
        ui.add_sized([80.0, space::TARGET], model).widget_info(|| {
            egui::WidgetInfo::labeled(egui::Role::SpinButton, true, text!("live-model"))
        });
        ui.label(text!("live-model-says"));
    });
    row(ui, text!("live-hung"), |ui| {
        for (text, pose) in [
            (text!("live-with-care"), SimulatedPose::Facing),
            (text!("live-anyhow"), SimulatedPose::Placed),
            (text!("live-turned-away"), SimulatedPose::Hard),
        ] {
            choice(ui, &mut spec.pose, pose, text);
        }
    });
    row(ui, text!("live-noise"), |ui| {
        for (text, noise) in noises() {
            choice(ui, &mut spec.noise, noise, text);
        }
    });
    row(ui, text!("live-clutter"), |ui| {
        for (text, clutter) in [
            (text!("live-no-clutter"), Clutter::None),
            (text!("live-on-floor"), Clutter::OnFloor),
            (text!("live-plank"), Clutter::InFront),
        ] {
            choice(ui, &mut spec.clutter, clutter, text);
        }
    });
}

fn row(ui: &mut Ui, name: String, controls: impl FnOnce(&mut Ui)) {
    ui.label(name);
    ui.horizontal(|ui| controls(ui));
    ui.end_row();
}

fn choice<T: PartialEq>(ui: &mut Ui, value: &mut T, this: T, text: String) {
    let is_chosen = *value == this;
    let button = Button::selectable(is_chosen, text).min_size(vec2(space::TARGET, space::TARGET));
    if ui.add(button).clicked() {
        *value = this;
    }
}

/// Returns everything that can hang in the cell; the line keeps its pace if it is running.
fn scenes(now: CellScene) -> impl Iterator<Item = CellScene> {
    let every = match now {
        CellScene::Line { every } | CellScene::Rack { every } => every,
        _ => EVERY,
    };
    [CellScene::Line { every }, CellScene::Rack { every }]
        .into_iter()
        .chain(PartKind::ALL.into_iter().map(CellScene::Part))
        .chain(ObjectKind::ALL.into_iter().map(CellScene::Object))
        .chain([CellScene::Empty])
}

fn scene_title(scene: CellScene) -> String {
    match scene {
        CellScene::Line { every } => text!("live-line-runs", seconds = format!("{every:.0}")),
        CellScene::Rack { every } => text!("live-racks-run", seconds = format!("{every:.0}")),
        CellScene::Conveyor { speed } => {
            text!(
                "live-conveyor-runs",
                speed = format!("{:.0}", 1000.0 * speed)
            )
        }
        CellScene::Part(kind) => kind.title().to_owned(),
        CellScene::Object(kind) => text!("shell-not-enrolled", what = object(kind)),
        CellScene::Empty => text!("live-nothing"),
    }
}
