//! Below the view: the path over time, with the gun on in blocks, to be played and scrubbed; and its playback.

use egui::{Align2, Id, Sense, Ui, pos2, vec2};

use super::{state::PaintState, work::Planned};
use crate::workspaces::paint::state::PaintAction;
use ui::{
    language::text,
    scrubber::{Playback, Scrubber, ScrubberInput},
    theme::{ROUNDING, Theme, font, space},
    widgets::{Scale, focus_ring},
};

/// Height of the blocks, logical pixels.
const BLOCKS: f32 = 14.0;
/// Distance that an arrow key moves, seconds.
const STEP: f64 = 0.5;

/// Draws heading and timeline.
pub(super) fn ui(ui: &mut Ui, paint: &PaintState, actions: &mut Vec<PaintAction>) {
    let theme = Theme::of(ui);
    let Some(planned) = paint.planned.as_ref().filter(|_| paint.duration() > 0.0) else {
        return;
    };
    if paint.playback == Playback::Playing {
        let seconds = ui.input(|input| input.stable_dt).min(0.1);
        actions.push(PaintAction::Advance(f64::from(seconds)));
        ui.request_repaint();
    }
    heading(ui, paint, planned, actions);
    let size = vec2(ui.available_width(), space::TARGET);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let sense = Sense::click_and_drag() | Sense::FOCUSABLE;
    let response = ui.interact(rect, Id::unique("paint timeline"), sense);
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
    let scrubber = Scrubber {
        label: text!("paint-timeline"),
        keys: text!("paint-timeline-keys"),
        position: paint.time,
        last: duration,
    };
    for input in scrubber.input(ui, &response) {
        actions.push(match input {
            ScrubberInput::First => PaintAction::Scrub(0.0),
            ScrubberInput::Last => PaintAction::Scrub(duration),
            ScrubberInput::Steps(steps) => PaintAction::Scrub(paint.time + STEP * f64::from(steps)),
            ScrubberInput::Pages(strokes) => PaintAction::Step(strokes),
            ScrubberInput::TogglePlay => PaintAction::TogglePlay,
        });
    }
    focus_ring(ui, rect, &response);
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

fn heading(ui: &mut Ui, paint: &PaintState, planned: &Planned, actions: &mut Vec<PaintAction>) {
    ui.horizontal(|ui| {
        if paint.playback.button(ui) {
            actions.push(PaintAction::TogglePlay);
        }
        ui.label(place_text(paint, planned));
    });
}

/// Describes where the gun is on the path.
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

/// Formats a duration as "1:05".
pub(super) fn minutes(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    format!("{}:{:02}", whole / 60, whole % 60)
}

impl PaintState {
    /// Duration of the whole path, seconds.
    pub fn duration(&self) -> f64 {
        let planned = self.planned.as_ref();
        planned.map_or(0.0, |planned| planned.course.duration())
    }

    pub(super) fn go_to(&mut self, time: f64) {
        self.time = time.clamp(0.0, self.duration());
    }

    /// Moves by this many strokes, to the beginning of a stroke.
    pub(super) fn go_by(&mut self, strokes: i32) {
        let Some(planned) = &self.planned else { return };
        let course = &planned.course;
        let begins = course.strokes.iter().map(|stroke| course.times(*stroke)[0]);
        let begins: Vec<f64> = begins.collect();
        // At the beginning of a stroke, a step back leads to the stroke before it.
        let now = begins.partition_point(|begin| *begin <= self.time + 1e-6) as i32 - 1;
        let wanted = usize::try_from(now + strokes).unwrap_or(0);
        let time = begins.get(wanted).copied().unwrap_or(course.duration());
        self.go_to(time);
    }

    pub(super) fn toggle_play(&mut self) {
        self.playback = match self.playback {
            Playback::Paused if self.duration() > 0.0 => {
                if self.time >= self.duration() {
                    self.time = 0.0;
                }
                Playback::Playing
            }
            Playback::Playing | Playback::Paused => Playback::Paused,
        };
    }

    /// Advances by the elapsed seconds while playing.
    pub(super) fn advance(&mut self, seconds: f64) {
        if self.playback == Playback::Playing {
            self.go_to(self.time + seconds);
            if self.time >= self.duration() {
                self.playback = Playback::Paused;
            }
        }
    }
}
