//! The panel on the right: start and stop, the state in a sentence, the figures, and what is servoed.

use egui::{Button, Frame, Margin, RichText, ScrollArea, Ui, vec2};

use super::{
    setup,
    state::{ServoPageState, ready},
    work::RunView,
};
use crate::workspaces::servo::state::ServoAction;
use servo::ServoState;
use shell::{
    language::{UnitSystem, end_title, shift_and_turn, state_title},
    session::Session,
};
use ui::{
    language::{Message, advised, described, text},
    theme::{Theme, font, space},
    widgets::{Mark, heading, labelled, line_mark, row, sentence, wrapped},
};

/// Height of the button that stops the robot, logical pixels.
const STOP: f32 = 72.0;

/// Draws the panel.
pub(super) fn ui(
    ui: &mut Ui,
    state: &ServoPageState,
    session: &Session,
    actions: &mut Vec<ServoAction>,
) {
    let frame = Frame::new().inner_margin(Margin::symmetric(18, 14));
    frame.show(ui, |ui| {
        let missing = ready(session).err();
        buttons(ui, state, missing.is_none(), actions);
        ui.add_space(space::SMALL);
        ui.spacing_mut().scroll.floating_allocated_width = space::SMALL;
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            let is_idle = !state.is_running();
            match (&state.failed, &missing) {
                (Some(error), _) => status(ui, Mark::Bad, &error.what, &error.advice),
                (None, Some(error)) if is_idle && state.shown.is_none() => {
                    status(ui, Mark::Look, &error.what, &error.advice);
                }
                _ => run(ui, state, session.units),
            }
            if let Some(shown) = &state.shown {
                figures(ui, shown, session.units);
            }
            ui.add_enabled_ui(is_idle, |ui| setup::ui(ui, session, actions));
        });
    });
}

fn buttons(ui: &mut Ui, state: &ServoPageState, is_ready: bool, actions: &mut Vec<ServoAction>) {
    let theme = Theme::of(ui);
    let width = ui.available_width();
    let large = |text: String, fill| {
        let text = RichText::new(text).font(font::title());
        Button::new(text.color(theme.on_accent)).fill(fill)
    };
    if !state.is_running() {
        let label = text!("servoing-start");
        let button = large(label.clone(), theme.accent);
        let start = ui.add_enabled_ui(is_ready, |ui| labelled_large(ui, button, &label));
        if start.inner {
            actions.push(ServoAction::Start);
        }
        return;
    }
    let label = text!("servoing-stop");
    if labelled_large(ui, large(label.clone(), theme.rejected), &label) {
        actions.push(ServoAction::Stop);
    }
    ui.weak(text!("servoing-stop-keys"));
    if state.doing() == Some(ServoState::Waiting) && !state.is_stopping() {
        let label = text!("shell-next");
        let next = Button::new(&label).min_size(vec2(width, space::TARGET));
        if labelled(ui, next, &label).clicked() {
            actions.push(ServoAction::Next);
        }
    }
}

/// Draws a large button; returns whether it was pressed.
fn labelled_large(ui: &mut Ui, button: Button<'_>, label: &str) -> bool {
    let size = vec2(ui.available_width(), STOP);
    let response = ui.add_sized(size, button);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, ui.is_enabled(), label));
    response.clicked()
}

/// Draws a state in a sentence with its mark, and below it what to do.
fn status(ui: &mut Ui, sign: Mark, what: &str, advice: &str) {
    let theme = Theme::of(ui);
    ui.horizontal_top(|ui| {
        line_mark(ui, 24.0, 10.0, sign);
        ui.vertical(|ui| {
            wrapped(ui, &sentence(what), &font::body_strong(), theme.text);
            if !advice.is_empty() {
                wrapped(ui, advice, &font::body(), theme.warning);
            }
        });
    });
}

/// Draws what the run in front is doing, or how it ended.
fn run(ui: &mut Ui, state: &ServoPageState, units: UnitSystem) {
    // Before a run, the view says so.
    let Some(shown) = &state.shown else {
        return;
    };
    if let Some(record) = &shown.record {
        let (sign, title) = end_title(&record.run);
        match &record.run.stopped {
            None => status(ui, sign, &title, ""),
            Some(reason) => status(ui, sign, &described(reason), &advised(reason)),
        }
    } else if state.is_stopping() {
        status(ui, Mark::Look, &text!("servoing-stopping"), "");
    } else {
        goes_on(ui, shown, units);
    }
    if let Some(problem) = &shown.problem {
        status(ui, Mark::Look, &problem.what, &problem.advice);
    }
}

/// Draws what a run that goes on is doing.
fn goes_on(ui: &mut Ui, shown: &RunView, units: UnitSystem) {
    let Some(standing) = &shown.standing else {
        let robot = shown.robot.map(|robot| robot.to_string());
        let what = match robot {
            Some(robot) => described(&Message::new("servo-waits-for-robot").with("robot", &*robot)),
            None => text!("servoing-begins"),
        };
        return status(
            ui,
            Mark::Open,
            &what,
            &text!("servoing-waits-for-robot-advice"),
        );
    };
    let title = state_title(standing.state);
    if let Some(reason) = &shown.held {
        let why = described(reason);
        let what = format!("{}: {why}", text!("servoing-holding"));
        return status(ui, Mark::Look, &what, &advised(reason));
    }
    let last = shown.curve.last();
    let left = last.and_then(|last| shift_and_turn(last.error_m, last.error_rad, units));
    let what = match left {
        Some(left) => text!("servoing-state-left", state = title, left = left),
        None => title,
    };
    status(ui, Mark::Runs, &what, "");
}

fn figures(ui: &mut Ui, shown: &RunView, units: UnitSystem) {
    heading(ui, &shown.title);
    ui.scope(|ui| {
        ui.spacing_mut().interact_size.y = 22.0;
        if let Some(record) = &shown.record {
            let run = &record.run;
            if let Some(left) = shift_and_turn(run.error_m, run.error_rad, units) {
                row(ui, &text!("servoing-error"), &left);
            }
            if let Some(bounds) = shift_and_turn(run.bounds_m, run.bounds_rad, units) {
                row(ui, &text!("servoing-bounds"), &bounds);
            }
            row(ui, &text!("servoing-took"), &format!("{:.1} s", run.took_s));
        }
        let looks = text!(
            "servoing-looks-of",
            accepted = shown.num_accepted,
            count = shown.num_looks
        );
        row(ui, &text!("servoing-looks"), &looks);
        if let Some(delay) = shown.delay {
            let delay = format!("{:.2} s", delay.as_secs_f64());
            row(ui, &text!("servoing-delay"), &delay);
        }
    });
}
