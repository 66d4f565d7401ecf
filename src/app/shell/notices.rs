//! What a person should know, over the lower edge of the window: nothing moves when a notice comes or goes.

use egui::{
    Align, Align2, Area, Button, Context, Frame, Id, Layout, Margin, Order, RichText, Sense, Ui,
    Vec2,
};

use super::{
    action::Action,
    notice::{Notice, NoticeKind},
    state::State,
    top_bar::labelled,
};
use crate::app::ui::{
    theme::{ROUNDING, Theme, space},
    widgets::{Mark, mark},
};

/// Greatest width, logical pixels.
const WIDTH: f32 = 620.0;
/// Left free on the right, logical pixels: there every workspace has the buttons that matter most.
const RIGHT: f32 = 340.0;
/// Between the notices and the edges of the window, logical pixels.
const EDGE: f32 = 14.0;

/// How long a notice stays, seconds; what deserves a look stays until it was looked at.
fn display_seconds(kind: NoticeKind) -> Option<f64> {
    match kind {
        NoticeKind::Look => None,
        NoticeKind::Done => Some(8.0),
        NoticeKind::Undoable => Some(12.0),
    }
}

/// Draws them, and takes away what has been there long enough.
pub(in crate::app) fn ui(ctx: &Context, state: &State, theme: &Theme, actions: &mut Vec<Action>) {
    expire(ctx, &state.notices, actions);
    if state.notices.is_empty() {
        return;
    }
    let room = ctx.content_rect().width() - space::RAIL - RIGHT - 2.0 * EDGE;
    let width = WIDTH.min(room).max(300.0);
    Area::new(Id::unique("notices"))
        .order(Order::Foreground)
        .anchor(Align2::LEFT_BOTTOM, Vec2::new(space::RAIL + EDGE, -EDGE))
        .show(ctx, |ui| {
            ui.set_width(width);
            for (place, notice) in state.notices.iter().enumerate() {
                Frame::new()
                    .fill(theme.control)
                    .stroke(theme.edge_stroke())
                    .corner_radius(ROUNDING)
                    .inner_margin(Margin::symmetric(14, 4))
                    .show(ui, |ui| line(ui, place, notice, theme, actions));
            }
        });
}

fn line(ui: &mut Ui, place: usize, notice: &Notice, theme: &Theme, actions: &mut Vec<Action>) {
    ui.horizontal(|ui| {
        ui.set_min_height(space::TARGET);
        let (rect, _) = ui.allocate_exact_size(Vec2::splat(20.0), Sense::hover());
        let sign = match notice.kind {
            NoticeKind::Look => Mark::Look,
            NoticeKind::Done | NoticeKind::Undoable => Mark::Good,
        };
        mark(ui.painter(), rect.center(), 9.0, sign, theme);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if labelled(ui, Button::new("Dismiss"), "Dismiss").clicked() {
                actions.push(Action::Dismiss(place));
            }
            let is_undoable = notice.kind == NoticeKind::Undoable;
            if is_undoable && labelled(ui, Button::new("Undo"), "Undo").clicked() {
                actions.push(Action::Undo);
            }
            let words = Layout::left_to_right(Align::Center).with_main_wrap(true);
            ui.with_layout(words, |ui| {
                ui.label(RichText::new(&notice.what).color(theme.text));
                if !notice.advice.is_empty() {
                    ui.label(RichText::new(&notice.advice).color(theme.warning));
                }
            });
        });
    });
}

/// A notice and since when it is there, seconds of egui's clock.
type TimedNotice = Vec<(Notice, f64)>;

fn expire(ctx: &Context, notices: &[Notice], actions: &mut Vec<Action>) {
    let now = ctx.input(|input| input.time);
    let id = Id::unique("notices since");
    let since: TimedNotice = ctx.data_mut(|data| {
        let since = data.get_temp_mut_or_default::<TimedNotice>(id);
        since.retain(|(known, _)| notices.contains(known));
        for notice in notices {
            if !since.iter().any(|(known, _)| known == notice) {
                since.push((notice.clone(), now));
            }
        }
        since.clone()
    });
    // From the last to the first, so that places stay what they are.
    for (place, notice) in notices.iter().enumerate().rev() {
        let begun = since.iter().find(|(known, _)| known == notice);
        let (Some(display_seconds), Some((_, begun))) = (display_seconds(notice.kind), begun)
        else {
            continue;
        };
        let left = begun + display_seconds - now;
        if left <= 0.0 {
            actions.push(Action::Dismiss(place));
        } else {
            ctx.request_repaint_after_secs(left as f32);
        }
    }
}
