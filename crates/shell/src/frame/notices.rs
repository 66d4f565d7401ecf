//! The strip of notices below the work: the work shrinks to make room, so that nothing is covered. In the operator's view the
//! newest two are over the picture, which has no controls.

use egui::{
    Align, Area, Context, Frame, Id, Layout, Margin, Order, Panel, Rect, RichText, Ui, pos2,
};

use super::operator_bars::column_width;
use crate::{
    action::{Action, Effect},
    message::Event,
    notice::{Notice, NoticeKind},
    state::State,
};
use ui::{
    language::text,
    theme::{ROUNDING, Theme, space},
    widgets::{Mark, line_mark, sentence, text_button},
};

/// Margin around the notices, logical pixels.
const EDGE: f32 = 6.0;
/// Number of notices that are dismissed one by one, and that the operator's view shows.
const FEW: usize = 2;
/// Time without motion after which the pointer is at rest, seconds.
const REST: f32 = 0.6;

/// How long a notice is shown, seconds; `None` for one that stays until it is dismissed.
fn display_seconds(kind: NoticeKind) -> Option<f64> {
    match kind {
        NoticeKind::Look => None,
        NoticeKind::Done => Some(8.0),
        NoticeKind::Undoable => Some(12.0),
    }
}

/// Reserves room at the bottom of the window, or finds it in the operator's view; [`ui()`] draws the notices there.
pub fn room(ui: &mut Ui, state: &State) -> Option<Rect> {
    if state.session.is_operator_view() {
        let view = ui.available_rect_before_wrap();
        let right = view.right() - column_width(view.width());
        let top = view.bottom() - height(ui.ctx());
        let room = view.with_max_x(right).with_min_y(top);
        return (!state.notices.is_empty()).then(|| room.shrink(EDGE));
    }
    let theme = Theme::of(ui);
    let wanted = if state.notices.is_empty() {
        0.0
    } else {
        height(ui.ctx())
    };
    let height = unhurried(ui.ctx(), wanted);
    // The panel exists even without notices, so that later widgets keep their ids, and text fields their focus.
    let room = Panel::bottom("room for notices")
        .exact_size(height)
        .resizable(false)
        .show_separator_line(false)
        .frame(Frame::new().fill(theme.canvas))
        .show(ui, |ui| ui.max_rect());
    (!state.notices.is_empty()).then(|| room.inner.shrink(EDGE))
}

/// Returns the wanted height, but does not shrink while the pointer is in use, so that nothing moves away under it.
fn unhurried(ctx: &Context, wanted: f32) -> f32 {
    let id = Id::unique("room for notices");
    let before: f32 = ctx.data(|data| data.get_temp(id)).unwrap_or_default();
    let is_at_rest = ctx.input(|input| {
        let pointer = &input.pointer;
        !pointer.any_down() && pointer.time_since_last_movement() > REST
    });
    let height = if wanted < before && !is_at_rest {
        ctx.request_repaint_after_secs(REST);
        before
    } else {
        wanted
    };
    ctx.data_mut(|data| data.insert_temp(id, height));
    height
}

/// The height of the notices when they were last drawn.
fn height(ctx: &Context) -> f32 {
    let known = ctx.data(|data| data.get_temp(Id::unique("height of notices")));
    known.unwrap_or(space::TARGET + 2.0 * EDGE)
}

/// Draws the notices in this room and dismisses expired ones.
pub fn ui(ctx: &Context, room: Option<Rect>, state: &State, actions: &mut Vec<Action>) {
    expire(ctx, room, &state.notices, actions);
    let Some(room) = room else {
        return;
    };
    if ctx.memory(|memory| memory.top_modal_layer().is_some()) {
        return over_dialog(ctx, room, state, actions);
    }
    // Below menus.
    let drawn = Area::new(Id::unique("notices"))
        .order(Order::Middle)
        .fixed_pos(room.min)
        .show(ctx, |ui| {
            ui.set_width(room.width());
            ui.spacing_mut().item_spacing.y = EDGE;
            let newest = state.notices.len().saturating_sub(1);
            let num_hidden = if state.session.is_operator_view() {
                state.notices.len().saturating_sub(FEW)
            } else {
                0
            };
            for (index, notice) in state.notices.iter().enumerate().skip(num_hidden) {
                let with_all = index == newest && newest >= FEW;
                plate(ui, index, notice, with_all, actions);
            }
        });
    let wanted = drawn.response.rect.height() + 2.0 * EDGE;
    if (wanted - height(ctx)).abs() > 0.5 {
        ctx.data_mut(|data| data.insert_temp(Id::unique("height of notices"), wanted));
        ctx.request_discard("the notices have another height");
    }
}

/// Draws the newest notice on top of the bar and a dialog: dialogs are tall, and the notice that one causes must be readable
/// and dismissible.
fn over_dialog(ctx: &Context, room: Rect, state: &State, actions: &mut Vec<Action>) {
    let Some((index, notice)) = state.notices.iter().enumerate().next_back() else {
        return;
    };
    Area::new(Id::unique("notice over a dialog"))
        .order(Order::Tooltip)
        .fixed_pos(pos2(room.left(), ctx.content_rect().top() + 2.0))
        .show(ctx, |ui| {
            ui.set_width(room.width());
            plate(ui, index, notice, false, actions);
        });
}

/// Draws a notice; `with_all` adds a button that dismisses all of them.
fn plate(ui: &mut Ui, index: usize, notice: &Notice, with_all: bool, actions: &mut Vec<Action>) {
    let theme = Theme::of(ui);
    Frame::new()
        .fill(theme.control)
        .stroke(theme.edge_stroke())
        .corner_radius(ROUNDING)
        .inner_margin(Margin::symmetric(14, 4))
        .show(ui, |ui| line(ui, index, notice, with_all, actions));
}

fn line(ui: &mut Ui, index: usize, notice: &Notice, with_all: bool, actions: &mut Vec<Action>) {
    let theme = Theme::of(ui);
    ui.horizontal(|ui| {
        ui.set_min_height(space::TARGET);
        let sign = match notice.kind {
            NoticeKind::Look => Mark::Look,
            NoticeKind::Done | NoticeKind::Undoable => Mark::Good,
        };
        line_mark(ui, 20.0, 9.0, sign);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if text_button(ui, &text!("shell-dismiss")).clicked() {
                actions.push(Action::Dismiss(index));
            }
            if with_all && text_button(ui, &text!("shell-dismiss-all")).clicked() {
                actions.push(Action::DismissAll);
            }
            let is_offered = notice.in_millimetres.is_some();
            if is_offered && text_button(ui, &text!("shell-read-in-millimetres")).clicked() {
                actions.push(Action::Reread(index));
            }
            let is_undoable = notice.kind == NoticeKind::Undoable;
            if is_undoable && text_button(ui, &text!("shell-undo")).clicked() {
                actions.push(Action::Make(Effect::Tell(Event::Undo)));
            }
            let words = Layout::left_to_right(Align::Center).with_main_wrap(true);
            ui.with_layout(words, |ui| {
                if notice.advice.is_empty() {
                    ui.label(sentence(&notice.what));
                } else {
                    let what = sentence(notice.what.trim_end_matches(['.', '。']));
                    let what = text!("shell-sentence", text = what);
                    ui.label(what);
                    ui.label(RichText::new(&notice.advice).color(theme.warning));
                }
                if notice.num_more > 0 {
                    ui.weak(text!("shell-more-like-it", num = notice.num_more));
                }
            });
        });
    });
}

/// Notices with the time when they appeared, seconds of egui's clock.
type TimedNotice = Vec<(Notice, f64)>;

fn expire(ctx: &Context, room: Option<Rect>, notices: &[Notice], actions: &mut Vec<Action>) {
    let now = ctx.input(|input| input.time);
    // No notice disappears under the pointer.
    let pointer = ctx.pointer_latest_pos();
    let is_pointed_at = room
        .zip(pointer)
        .is_some_and(|(room, at)| room.contains(at));
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
    // From last to first, so that the indices stay valid.
    for (index, notice) in notices.iter().enumerate().rev() {
        let begun = since.iter().find(|(known, _)| known == notice);
        let (Some(display_seconds), Some((_, begun))) = (display_seconds(notice.kind), begun)
        else {
            continue;
        };
        let left = begun + display_seconds - now;
        if left <= 0.0 && is_pointed_at {
            ctx.request_repaint_after_secs(REST);
        } else if left <= 0.0 {
            actions.push(Action::Dismiss(index));
        } else {
            ctx.request_repaint_after_secs(left as f32);
        }
    }
}
