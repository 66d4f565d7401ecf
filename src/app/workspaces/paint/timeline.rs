//! Below the view: the path over time, with the gun on in blocks, to be played and scrubbed.

use egui::{
    Align2, Button, EventFilter, Id, Key, Modifiers, Response, RichText, Sense, Ui,
    accesskit::Action as Asked, pos2, vec2,
};

use super::{
    action::PaintAction,
    state::{PaintState, Playback},
    work::Planned,
};
use crate::app::{
    language::text,
    ui::{
        theme::{ROUNDING, Theme, font, space},
        widgets::{Scale, focus_ring, labelled},
    },
};

/// Height of the blocks, logical pixels.
const BLOCKS: f32 = 14.0;

/// Draws heading and timeline.
pub(super) fn ui(ui: &mut Ui, paint: &PaintState, theme: &Theme, actions: &mut Vec<PaintAction>) {
    let Some(planned) = paint.planned.as_ref().filter(|_| paint.duration() > 0.0) else {
        return;
    };
    if paint.playback == Playback::Playing {
        let seconds = ui.input(|input| input.stable_dt).min(0.1);
        actions.push(PaintAction::Advance(f64::from(seconds)));
        ui.request_repaint();
    }
    heading(ui, paint, planned, theme, actions);
    let size = vec2(ui.available_width(), space::TARGET);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let sense = Sense::click_and_drag() | Sense::FOCUSABLE;
    let response = ui.interact(rect, Id::unique("paint timeline"), sense);
    describe(ui, &response, paint);
    let duration = paint.duration();
    let seconds = Scale::new(
        [0.0, duration as f32],
        [rect.left() + 6.0, rect.right() - 6.0],
    );
    let painter = ui.painter();
    let track = egui::Rect::from_center_size(rect.center(), vec2(rect.width() - 12.0, BLOCKS));
    painter.rect_filled(track, ROUNDING, theme.track);
    for stroke in &planned.course.strokes {
        let [from, to] = planned.course.times(*stroke).map(|t| seconds.at(t as f32));
        let block = egui::Rect::from_x_y_ranges(from..=to.max(from + 1.0), track.y_range());
        painter.rect_filled(block, 2.0, theme.accent);
    }
    let x = seconds.at(paint.time as f32);
    let stroke = egui::Stroke::new(2.0, theme.text);
    painter.vline(x, rect.y_range(), stroke);
    painter.circle_filled(pos2(x, rect.top() + 4.0), 4.0, theme.text);
    if response.clicked() || response.drag_started() {
        response.request_focus();
    }
    if (response.clicked() || response.dragged())
        && let Some(at) = response.interact_pointer_pos()
    {
        let share = (at.x - track.left()) / track.width();
        actions.push(PaintAction::Scrub(f64::from(share) * duration));
    }
    keys(ui, &response, paint, actions);
    focus_ring(ui, rect, &response, theme);
    let (caption, _) = ui.allocate_exact_size(vec2(size.x, 16.0), Sense::hover());
    let write = |at, anchor, text| {
        let painter = ui.painter();
        painter.text(at, anchor, text, font::small(), theme.weak_text);
    };
    let takes = &planned.film.path;
    let takes = text!(
        "paint-path-takes",
        length = format!("{:.1}", takes.length),
        paint = format!("{:.0}", 1e6 * takes.paint)
    );
    let blocks = text!("paint-blocks-are-strokes");
    write(
        caption.left_top(),
        Align2::LEFT_TOP,
        format!("{blocks} · {takes}"),
    );
    write(
        caption.right_top(),
        Align2::RIGHT_TOP,
        text!("paint-drag-to-move"),
    );
}

fn heading(
    ui: &mut Ui,
    paint: &PaintState,
    planned: &Planned,
    theme: &Theme,
    actions: &mut Vec<PaintAction>,
) {
    ui.horizontal(|ui| {
        let text = match paint.playback {
            Playback::Paused => text!("paint-play"),
            Playback::Playing => text!("paint-pause"),
        };
        let key = RichText::new("P").font(font::small());
        let button = Button::new(&text).shortcut_text(key.color(theme.weak_text));
        if labelled(ui, button, &text).clicked() {
            actions.push(PaintAction::TogglePlay);
        }
        ui.label(RichText::new(place_text(paint, planned)).color(theme.text));
    });
}

/// Where the gun is on the path, in words.
fn place_text(paint: &PaintState, planned: &Planned) -> String {
    let course = &planned.course;
    let gun = course.at(&planned.path, planned.coat.speed, paint.time);
    let all = course.strokes.len();
    let (time, end) = (minutes(paint.time), minutes(paint.duration()));
    let number = (gun.stroke + 1).min(all);
    if gun.is_on {
        text!(
            "paint-place-on",
            time = time,
            end = end,
            stroke = number,
            all = all
        )
    } else {
        text!(
            "paint-place-off",
            time = time,
            end = end,
            stroke = number,
            all = all
        )
    }
}

/// "1:05".
fn minutes(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    format!("{}:{:02}", whole / 60, whole % 60)
}

/// Names the timeline for a screen reader.
fn describe(ui: &Ui, response: &Response, paint: &PaintState) {
    ui.accesskit_node_builder(response.id, |node| {
        node.set_role(egui::accesskit::Role::Slider);
        node.set_label(text!("paint-timeline"));
        node.set_description(text!("paint-timeline-keys"));
        node.set_min_numeric_value(0.0);
        node.set_max_numeric_value(paint.duration());
        node.set_numeric_value(paint.time);
        node.add_action(Asked::Increment);
        node.add_action(Asked::Decrement);
    });
}

/// Seconds that an arrow key moves.
const STEP: f64 = 0.5;

/// Keys of the timeline while it has the focus; what a screen reader asks for, always.
fn keys(ui: &Ui, response: &Response, paint: &PaintState, actions: &mut Vec<PaintAction>) {
    let id = response.id;
    let mut steps = ui.input(|input| {
        let times = |asked| input.num_accesskit_action_requests(id, asked) as f64;
        times(Asked::Increment) - times(Asked::Decrement)
    });
    if response.has_focus() {
        // The arrows are ours; Tab still leaves the timeline.
        let arrows = EventFilter {
            tab: false,
            horizontal_arrows: true,
            vertical_arrows: false,
            escape: false,
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(id, arrows));
        let pressed =
            |key| ui.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, key)) as f64;
        steps += pressed(Key::ArrowRight) - pressed(Key::ArrowLeft);
        if pressed(Key::Home) > 0.0 {
            actions.push(PaintAction::Scrub(0.0));
        }
        if pressed(Key::End) > 0.0 {
            actions.push(PaintAction::Scrub(paint.duration()));
        }
        if pressed(Key::Space) > 0.0 {
            actions.push(PaintAction::TogglePlay);
        }
    }
    if steps != 0.0 {
        actions.push(PaintAction::Scrub(paint.time + STEP * steps));
    }
}
