//! The dialog that sets up the simulated cell.

use egui::{Button, Context, DragValue, Grid, Ui, vec2};

use super::LiveAction;
use crate::{action::Action, language::results::object, state::State};
use capture::{CellScene, SimulatedPose, SimulatedSpec, SourceSpec};
use simulate::{Clutter, ObjectKind, PartKind, Side};
use ui::{
    language::text,
    theme::space,
    widgets::{self, drop_down, text_button},
};

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
